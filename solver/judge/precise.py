"""Derivatives along an edge to many digits: the referee's second opinion where rounding hides what it reads.

Decimal numbers hold each double exactly, and 60 digits of what is done with them; so what comes is that of the surfaces
as they are stored, rounded once. Plain de Boor, point by point, and slow: for a handful of points.
"""

from __future__ import annotations

from bisect import bisect_right
from decimal import Decimal, localcontext
from functools import cached_property
from itertools import pairwise
from math import comb
from typing import TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.base import Base
from semispline.solver.splines import BSplineCurve, BSplineSurface, NaturalEdge

_DIGITS = 60
_Vector: TypeAlias = list[Decimal]


def precise_derivatives(base: Base, origin: FloatArray, s: FloatArray, order: int) -> dict[tuple[int, int], FloatArray]:
    """Return derivatives at parameters along an edge, points counted from an origin, each of shape (K, 3).

    The keys are (order across, order along), of all that add up to at most `order`.

    Examples
    --------
    >>> k = [0, 0, 1, 1]
    >>> roof = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[2, 0, 1], [2, 1, 1]]])
    >>> precise_derivatives(Base(roof, "u0"), np.zeros(3), np.array([0.5]), 1)[1, 0]
    array([[2., 0., 1.]])
    """
    with localcontext() as context:
        context.prec = _DIGITS
        net = _Net.of(base, origin)
        points = [net.derivatives(Decimal(x), order) for x in s.tolist()]
        keys = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
        return {key: np.array([[float(x) for x in at[key]] for at in points]) for key in keys}


class _Curve:
    """A control curve, four numbers in a point; made of Decimal numbers where it is read."""

    def __init__(self, curve: BSplineCurve, origin: FloatArray) -> None:
        self.curve, self.degree, self.origin = curve, curve.degree, origin

    @cached_property
    def knots(self) -> list[Decimal]:
        return _decimals(self.curve.knots)

    @cached_property
    def points(self) -> list[_Vector]:
        points, weights = self.curve.control_points, self.curve.weights
        return _homogeneous(points, np.ones(len(points)) if weights is None else weights, self.origin)


class _Net:
    """The control curves of a surface, and how they are joined across."""

    def __init__(self, curves: list[_Curve], degree: int, knots: FloatArray, edge: NaturalEdge) -> None:
        self.curves, self.degree, self.knots, self.edge = curves, degree, _decimals(knots), edge

    @staticmethod
    def of(base: Base, origin: FloatArray) -> _Net:
        surface = base.surface
        rows = surface.to_semistructured() if isinstance(surface, BSplineSurface) else surface
        curves = [_Curve(curve, origin) for curve in rows.control_curves]
        return _Net(curves, rows.degree_u, rows.knots_u, base.side)

    def derivatives(self, x: Decimal, order: int) -> dict[tuple[int, int], _Vector]:
        """Return derivatives of the quotient by (across, along), up to an order, inwards and along as the edge runs."""
        at_end = self.edge[1] == "1"
        found: dict[tuple[int, int], _Vector] = {}
        for i in range(order + 1):
            for j in range(order + 1 - i):
                if self.edge[0] == "u":
                    found[i, j] = self._at(self.knots[-1] if at_end else self.knots[0], x, i, j)
                else:
                    found[i, j] = self._at(x, self.curves[0].knots[-1 if at_end else 0], j, i)
        return _quotient(found)

    def _at(self, u: Decimal, v: Decimal, du: int, dv: int) -> _Vector:
        first = _span(self.degree, self.knots, u) - self.degree
        # Only the rows that act at u.
        points = [[Decimal(0)] * 4] * len(self.curves)
        for i in range(first, first + self.degree + 1):
            curve = self.curves[i]
            points[i] = _derivative(curve.degree, curve.knots, curve.points, v, dv)
        return _derivative(self.degree, self.knots, points, u, du)


def _decimals(knots: FloatArray) -> list[Decimal]:
    return [Decimal(x) for x in knots.tolist()]


def _homogeneous(points: FloatArray, weights: FloatArray, origin: FloatArray) -> list[_Vector]:
    result = []
    for point, weight in zip(points.tolist(), weights.tolist(), strict=True):
        w = Decimal(weight)
        result.append([w * (Decimal(x) - Decimal(o)) for x, o in zip(point, origin.tolist(), strict=True)] + [w])
    return result


def _span(degree: int, knots: list[Decimal], x: Decimal) -> int:
    """Return k with t_k <= x < t_(k+1); the end of the domain belongs to the last span."""
    return max(degree, min(bisect_right(knots, x) - 1, len(knots) - degree - 2))


def _derivative(degree: int, knots: list[Decimal], points: list[_Vector], x: Decimal, order: int) -> _Vector:
    """Return a derivative of a curve: differences of the control points of the span, then the triangle."""
    if order > degree:
        return [Decimal(0)] * len(points[0])
    k = _span(degree, knots, x)
    local = points[k - degree : k + 1]
    for s in range(1, order + 1):
        p = degree - s + 1
        widths = [knots[i + p] - knots[i] for i in range(k - p + 1, k + 1)]
        local = [
            [p * (b - a) / width for a, b in zip(one, two, strict=True)]
            for (one, two), width in zip(pairwise(local), widths, strict=True)
        ]
    p = degree - order
    for level in range(p, 0, -1):
        starts = range(k - level + 1, k + 1)
        shares = [(x - knots[i]) / (knots[i + level] - knots[i]) for i in starts]
        local = [
            [a + share * (b - a) for a, b in zip(one, two, strict=True)]
            for (one, two), share in zip(pairwise(local), shares, strict=True)
        ]
    return local[0]


def _quotient(values: dict[tuple[int, int], _Vector]) -> dict[tuple[int, int], _Vector]:
    """Return derivatives of X / w from those of (X, w), by the product rule on X = w S."""
    known: dict[tuple[int, int], _Vector] = {}
    weight = values[0, 0][3]
    for a, b in sorted(values):
        total = values[a, b][:3]
        for i in range(a + 1):
            for j in range(b + 1):
                if i or j:
                    factor, lower = comb(a, i) * comb(b, j) * values[i, j][3], known[a - i, b - j]
                    total = [x - factor * y for x, y in zip(total, lower, strict=True)]
        known[a, b] = [x / weight for x in total]
    return known
