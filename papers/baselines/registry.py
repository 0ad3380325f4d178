"""All rival methods: whatever the modules of this folder list in a tuple METHODS."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from semispline.papers.baselines.interface import Method


def methods(own: Sequence[Method] = ()) -> tuple[Method, ...]:
    """Return every rival method, and a paper's own ones with them, in the order of tables.

    Raises
    ------
    ValueError
        Two methods have one name.

    Examples
    --------
    >>> [m.name for m in methods()][:2]
    ['paper-corrected', 'semistructured-fair']
    """
    found = (*own, *_rivals())
    names = [method.name for method in found]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"methods: found {name!r} twice, expected every name once")
    return tuple(sorted(found, key=lambda method: (method.place, method.name)))


@cache
def _rivals() -> tuple[Method, ...]:
    found: list[Method] = []
    for module in pkgutil.iter_modules([str(Path(__file__).parent)]):
        found += getattr(importlib.import_module(f"semispline.papers.baselines.{module.name}"), "METHODS", ())
    return tuple(found)


def method(name: str) -> Method:
    """Return the rival method of a name.

    Raises
    ------
    KeyError
        There is none.
    """
    return {m.name: m for m in methods()}[name]
