"""Spline spaces, exactly: which one contains another, the common one, how smooth its splines are."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise

from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix

from semispline.derivations.properties import contact_orders
from semispline.papers.checks.spline_values import clamped, spline_basis


@cache
def contact_at_knot(order: int, multiplicity: int) -> int:
    """Return how smooth all splines of an order are at a knot h, 0 < h < 1, of a multiplicity, but no smoother."""
    knots = [0] * order + ["h"] * multiplicity + [1] * order
    return min(x for x in contact_orders(order - 1, knots, "h") if x is not None)


def contained(order: int, inner: Sequence[Fraction], outer: Sequence[Fraction]) -> bool:
    """Tell whether every spline over one knot vector is one over another, by exact linear algebra.

    Splines of one order over the same domain that agree at more points in every span than a polynomial of that order
    has coefficients are the same.
    """
    spans = sorted(set(inner) | set(outer))
    points = [a + (b - a) * Fraction(r, order + 1) for a, b in pairwise(spans) for r in range(order + 1)]
    values = [_collocation(order, vector, points) for vector in (outer, inner)]
    return bool(values[0].rank() == values[0].hstack(values[1]).rank())


def _collocation(order: int, vector: Sequence[Fraction], points: Sequence[Fraction]) -> DomainMatrix:
    basis = spline_basis({"V": vector})
    count = len(vector) - order
    rows = [[QQ(*basis(i, order, x, "V").as_integer_ratio()) for i in range(count)] for x in points]
    return DomainMatrix(rows, (len(points), count), QQ)


def union(order: int, *vectors: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """Return the smallest knot vector that holds the inner knots of all, each with its largest multiplicity."""
    inner: list[Fraction] = []
    for knot in sorted({x for vector in vectors for x in vector[order:-order]}):
        inner += [knot] * max(list(vector).count(knot) for vector in vectors)
    return clamped(order, *inner, start=vectors[0][0], end=vectors[0][-1])
