"""Exact values of Bernstein polynomials, B-splines and splines: what printed formulas are run with."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from math import comb
from typing import Any

import sympy as sp

from semispline.derivations.splines import Span, X, basis_pieces
from semispline.papers.ledger import UndefinedError, as_expression, as_fraction


def spline_basis(knots: Mapping[Any, Sequence[Any]]) -> Callable[..., Any]:
    """Return B(i, order, x, name) over knot vectors known by name; Cox-de Boor, exact; a fifth argument differentiates.

    Raises
    ------
    UndefinedError
        When called with an index that the knot vector of that order does not have.
    """
    # A vector is hashed once here, and not again at each value: its fractions make that slow.
    values = {name: (len(vector), _basis_values(tuple(vector))) for name, vector in knots.items()}

    def basis(i: Any, order: Any, x: Any, name: Any, derivative: Any = 0) -> Fraction:
        length, value = values[name]
        count = length - int(order)
        if not 0 <= i < count or count < order:
            raise UndefinedError(f"B[{i}] of {count} functions of order {order}")
        return value(int(i), int(order), Fraction(x), int(derivative))

    return basis


@cache
def _basis_values(vector: tuple[Any, ...]) -> Callable[[int, int, Fraction, int], Fraction]:
    """Return the basis functions over one knot vector, which remember their values."""

    @cache
    def spans(order: int) -> tuple[Span, ...]:
        return basis_pieces(order - 1, [as_expression(t) for t in vector])

    @cache
    def value(i: int, order: int, x: Fraction, derivative: int) -> Fraction:
        point = sp.Rational(x.numerator, x.denominator)
        span = next((s for s in spans(order) if s.start <= point < s.end), spans(order)[-1])
        if not span.first <= i < span.first + len(span.pieces):
            return Fraction(0)
        piece = span.pieces[i - span.first]
        return as_fraction((piece.diff((X, derivative)) if derivative else piece).eval(point))

    return value


def bernstein(i: Any, degree: Any, x: Any) -> Any:
    """Return B_i^n(x) for a fraction or a ring element x."""
    n, r = int(degree), int(i)
    if not 0 <= r <= n:
        raise UndefinedError(f"B[{r}] of degree {n}")
    return comb(n, r) * x**r * (1 - x) ** (n - r)


def de_boor(order: int, knots: Sequence[Any], points: Sequence[Any], x: Fraction) -> Any:
    """Return a spline at x by de Boor's triangle, which knows no basis functions; points may be ring elements."""
    degree = order - 1
    last = len(points) - 1
    k = max(i for i in range(degree, last + 1) if knots[i] <= x and knots[i] < knots[i + 1])
    level = list(points[k - degree : k + 1])
    for step in range(1, degree + 1):
        for j in range(degree, step - 1, -1):
            left = k - degree + j
            weight = Fraction(x - knots[left]) / Fraction(knots[left + degree - step + 1] - knots[left])
            level[j] = level[j - 1] * (1 - weight) + level[j] * weight
    return level[degree]


def clamped(order: int, *inner: Any, start: Any = 0, end: Any = 1) -> tuple[Fraction, ...]:
    """Return a knot vector with `order`-fold ends.

    Examples
    --------
    >>> [str(t) for t in clamped(2, Fraction(1, 3))]
    ['0', '0', '1/3', '1', '1']
    """
    return tuple(Fraction(t) for t in (*[start] * order, *inner, *[end] * order))


def net_ring(*sizes: int, letter: str = "P") -> dict[tuple[int, int], Any]:
    """Return ring generators P_i_j for rows of the given lengths."""
    names = [(i, j) for i, size in enumerate(sizes) for j in range(size)]
    _, *generators = sp.ring([f"{letter}_{i}_{j}" for i, j in names], sp.QQ)
    return dict(zip(names, generators, strict=True))


def rational_points(start: Any, end: Any, count: int) -> Iterator[Fraction]:
    """Yield rational parameters from start to end, none of them regular fractions of the range but the ends."""
    for n in range(count):
        share = Fraction(n, count - 1)
        yield Fraction(start) + (Fraction(end) - Fraction(start)) * share * (1 + share) / 2
