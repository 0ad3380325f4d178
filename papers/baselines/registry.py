"""All methods: whatever the modules of this folder list in a tuple METHODS."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from pathlib import Path

from papers.baselines.interface import Method


@cache
def methods() -> tuple[Method, ...]:
    """Return every method, in the order of tables.

    Raises
    ------
    ValueError
        Two methods have one name.

    Examples
    --------
    >>> [m.name for m in methods()][:2]
    ['paper-as-printed', 'paper-corrected']
    """
    found: list[Method] = []
    for module in pkgutil.iter_modules([str(Path(__file__).parent)]):
        found += getattr(importlib.import_module(f"papers.baselines.{module.name}"), "METHODS", ())
    names = [method.name for method in found]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"methods: found {name!r} twice, expected every name once")
    return tuple(sorted(found, key=lambda method: (method.place, method.name)))


def method(name: str) -> Method:
    """Return the method of a name.

    Raises
    ------
    KeyError
        There is none.
    """
    return {m.name: m for m in methods()}[name]
