"""Printed code with its call."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import sympy as sp

from semispline.papers.checks import Code
from semispline.papers.ledger import Case, Check, CheckFailedError, Formula
from semispline.papers.primer.printed import blocks, replaced


def code_of(identifier: str, call: str, instead: Mapping[str, str] | None = None) -> Code:
    """Return printed code with what calls it, and with what is put right in it.

    Examples
    --------
    >>> code_of("bsplines.8", "s").call
    's'
    """
    return Code(blocks()[identifier].text, call, {**replaced(identifier), **(instead or {})})


def open_is_false(check: Check) -> Check:
    """Return a check of a run for any letters that counts it as false where a condition depends on them."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        try:
            yield from check.cases(formula)
        except CheckFailedError as error:
            yield Case("all letters", False, residual=sp.Symbol(f"open: {error}"))

    return replace(check, cases=cases)
