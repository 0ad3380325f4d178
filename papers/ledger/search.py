"""Exhaustive search for the smallest rational assignment, by increasing height."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

# Numerator and denominator of all variables together; beyond it the search gives up.
HEIGHT_LIMIT = 16


def height(value: Any) -> int:
    """Return |p| + q - 1 for p/q: 0 for 0, 1 for 1 and -1, 2 for 2 and 1/2.

    Examples
    --------
    >>> [height(Fraction(*pq)) for pq in ((0, 1), (-1, 1), (1, 2), (2, 3))]
    [0, 1, 2, 4]
    """
    return abs(int(value.numerator)) + int(value.denominator) - 1


@cache
def rationals_of_height(h: int) -> tuple[Fraction, ...]:
    """Return all rationals of one height, positive before negative.

    Examples
    --------
    >>> [str(r) for r in rationals_of_height(2)]
    ['2', '-2', '1/2', '-1/2']
    """
    if h == 0:
        return (Fraction(0),)
    numbers = [Fraction(p, h + 1 - p) for p in range(h, 0, -1)]
    distinct = [number for number in numbers if height(number) == h]
    return tuple(signed for number in distinct for signed in (number, -number))


def assignments(symbols: Sequence[sp.Symbol], total: int) -> Iterator[dict[sp.Symbol, Fraction]]:
    """Yield all assignments whose heights add up to `total`; each symbol's own assumptions limit its values."""
    if not symbols:
        if total == 0:
            yield {}
        return
    first, rest = symbols[0], symbols[1:]
    heights = range(total + 1) if rest else (total,)
    for h in heights:
        values = [value for value in rationals_of_height(h) if _admits(first, value)]
        if not values:
            continue
        for tail in assignments(rest, total - h):
            for value in values:
                yield {first: value, **tail}


def _admits(symbol: sp.Symbol, value: Fraction) -> bool:
    refused = (
        (symbol.is_integer and value.denominator != 1)
        or (symbol.is_positive and not value > 0)
        or (symbol.is_nonnegative and value < 0)
        or (symbol.is_nonzero and value == 0)
    )
    return not refused


def smallest_assignment(
    symbols: Sequence[sp.Symbol], predicate: Callable[[dict[sp.Symbol, Fraction]], bool], limit: int = HEIGHT_LIMIT
) -> dict[sp.Symbol, Any] | None:
    """Return the first assignment, by increasing total height, at which `predicate` is true.

    Parameters
    ----------
    symbols : sequence of sympy.Symbol
    predicate : callable
        Assignment (symbol -> Fraction) -> bool.
    limit : int
        Largest total height.

    Returns
    -------
    dict or None
        Symbol -> sympy.Rational; None where nothing up to `limit` was found.

    Examples
    --------
    >>> x, y = sp.symbols("x y", positive=True)
    >>> smallest_assignment([x, y], lambda at: at[x] * at[y] == Fraction(2, 3))
    {x: 1, y: 2/3}
    """
    for total in range(limit + 1):
        for at in assignments(symbols, total):
            if predicate(at):
                return {symbol: sp.Rational(value.numerator, value.denominator) for symbol, value in at.items()}
    return None
