"""The smallest numbers at which two expressions have different values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.papers.checks.enclosures import differ_at, value_at
from semispline.papers.checks.instances import as_letters, holds_at, letters_of
from semispline.papers.ledger import Counterexample, UndefinedError, smallest_assignment

# Assignments that are tried; at the first ones a false formula of the usual kind shows already.
_TRIES = 20_000


def smallest_difference(
    one: Any, other: Any, assumptions: Iterable[Any] = (), instance: Mapping[Any, Any] | None = None
) -> Counterexample | None:
    """Return the smallest numbers at which two carried out expressions differ, under assumptions.

    Parameters
    ----------
    one : sympy.Expr
        What is true.
    other : sympy.Expr
        What is printed.
    assumptions : iterable of sympy.Rel
    instance : mapping, optional
        Letter -> the number that it already has in both.

    Returns
    -------
    Counterexample or None
        None where a bounded search finds none.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> str(smallest_difference(x**2, 2 * x))
    'x = 1: printed 2, true 1'
    """
    known = dict(instance or {})
    assumptions = list(assumptions)
    sides = as_letters(one), as_letters(other)
    letters = letters_of(*sides, *(a for a in assumptions if not a.free_symbols <= set(known)))
    letters = [letter for letter in letters if letter not in known]
    left = _TRIES

    def differs(at: Mapping[Any, Fraction]) -> bool:
        nonlocal left
        left -= 1
        if left < 0:
            raise _EnoughError
        if not holds_at(assumptions, {**known, **at}):
            return False
        try:
            return differ_at(*sides, at) is True
        except (UndefinedError, ZeroDivisionError):
            return False

    try:
        found = smallest_assignment(letters, differs)
    except _EnoughError:
        found = None
    if found is None:
        return None
    at = {letter: Fraction(int(value.p), int(value.q)) for letter, value in found.items()}
    values = tuple((str(letter), str(value)) for letter, value in {**known, **found}.items())
    true, printed = (shown_value(value_at(side, at)) for side in sides)
    return Counterexample(values, printed, true)


class _EnoughError(Exception):
    """So many assignments were tried as may be."""


def shown_value(value: Any) -> str:
    """Return a value as text: exact, or the digits that are certain.

    Examples
    --------
    >>> shown_value(Fraction(1, 3))
    '1/3'
    """
    if isinstance(value, Fraction | int | sp.Basic):
        return str(value)
    return f"{value.str(12, radius=False)}..."
