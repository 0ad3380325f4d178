"""Printed code with its call."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

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


def weights_of(count: int, name: str = "w") -> list[Any]:
    """Return as many weights, each a letter.

    Examples
    --------
    >>> weights_of(2)
    [w0, w1]
    """
    return [sp.Symbol(f"{name}{i}", real=True) for i in range(count)]


def by_powers(weights: Sequence[Any], t: Any) -> Any:
    """Return the value of a curve as the sum of its terms, and not by the construction that code of it may follow.

    Examples
    --------
    >>> by_powers([0, 0, 1], sp.Symbol("t"))
    t**2
    """
    n = len(weights) - 1
    return sp.Add(*(sp.binomial(n, i) * (1 - t) ** (n - i) * t**i * weight for i, weight in enumerate(weights)))


def decided_elsewhere(printed: Formula, where: str, mark: str = ", line ") -> Formula:
    """Return a formula of code whose changes do not show here, but in another run of the same lines.

    Parameters
    ----------
    printed : Formula
    where : str
        Which run that is.
    mark : str
        What the texts of those changes contain; as it stands, all of the code.
    """
    return replace(printed, equivalent_if=lambda mutant: f"decided by {where}" if mark in mutant.text else "")


def open_is_false(check: Check) -> Check:
    """Return a check of a run for any letters that counts it as false where a condition depends on them."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        try:
            yield from check.cases(formula)
        except CheckFailedError as error:
            yield Case("all letters", False, residual=sp.Symbol(f"open: {error}"))

    return replace(check, cases=cases)
