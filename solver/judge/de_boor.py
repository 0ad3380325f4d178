"""The numeric referee: the textbook triangular algorithm, plain, over arrays of points.

It shares no code with the evaluation in `surfaces`: it finds spans, differences control points and runs the
triangle itself.

Source: C. de Boor, A Practical Guide to Splines, ch. X; Piegl and Tiller, The NURBS Book, ch. 3 and 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import comb

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineCurve, BSplineSurface, NaturalEdge, SemiStructuredSurface

# Numbers that are worked on at once: what a processor's nearest memory holds.
_AT_ONCE = 2**15


def curve_points(
    degree: int, knots: FloatArray, control_points: FloatArray, x: FloatArray, derivative: int = 0
) -> FloatArray:
    """Evaluate a B-spline curve or one of its derivatives.

    Parameters
    ----------
    degree : int
    knots : ndarray, shape (n + degree + 1,)
    control_points : ndarray, shape (n, d) for one curve, or (K, n, d) for a curve of its own at each parameter
    x : ndarray, shape (K,)
        Parameters in the domain.
    derivative : int
        Order of the derivative; zero above the degree.

    Returns
    -------
    ndarray, shape (K, d)

    Examples
    --------
    >>> curve_points(1, np.array([0, 0, 2.0, 2]), np.array([[0.0], [6]]), np.array([0.5]), 1)
    array([[3.]])
    """
    n, d = control_points.shape[-2:]
    if derivative > degree or not len(x):
        return np.zeros((len(x), d))
    if len(x) > (most := max(1, _AT_ONCE // (d * (degree + 1)))):
        parts = [slice(i, i + most) for i in range(0, len(x), most)]
        own = control_points.ndim == 3
        return np.concatenate(
            [curve_points(degree, knots, control_points[i] if own else control_points, x[i], derivative) for i in parts]
        )
    # The span k has t_k <= x < t_(k+1); the end of the domain belongs to the last span, which ends at t_n.
    k = np.clip(np.searchsorted(knots, x, side="right") - 1, degree, n - 1)
    # Only the control points that some parameter reads. Parameters are the last axis: there are many of them.
    low, high = int(k.min()) - degree, int(k.max()) + 1
    local = np.ascontiguousarray(np.moveaxis(control_points[..., low:high, :], -1, 0))
    read = k - degree - low + np.arange(degree + 1)[:, None]
    # All points of a level at once, shape (d, points, K).
    points = np.take(local, read, axis=1) if local.ndim == 2 else local[:, np.arange(len(x)), read]
    # Row i holds t_(k + i + 1 - degree): the first `degree` rows begin spans, the others end them.
    t = knots[k + np.arange(1 - degree, degree + 1)[:, None]]
    for s in range(1, derivative + 1):
        widths = t[degree : 2 * degree + 1 - s] - t[s - 1 : degree]
        points = (degree + 1 - s) * (points[:, 1:] - points[:, :-1]) / widths
    for level in range(derivative + 1, degree + 1):
        left, right = t[level - 1 : degree], t[degree : 2 * degree + 1 - level]
        a = (x - left) / (right - left)
        above = a * points[:, 1:]
        points = (1 - a) * points[:, :-1]
        points += above
    return np.asarray(points[:, 0].T)


def _homogeneous(surface: BSplineSurface, u: FloatArray, v: FloatArray, du: int, dv: int) -> FloatArray:
    net = _net(surface)
    n_u, n_v, d = net.shape
    # All rows are curves over the same knots: one curve in n_u d dimensions.
    rows = curve_points(surface.degree_v, surface.knots_v, net.transpose(1, 0, 2).reshape(n_v, n_u * d), v, dv)
    return curve_points(surface.degree_u, surface.knots_u, rows.reshape(len(v), n_u, d), u, du)


def _net(surface: BSplineSurface, origin: FloatArray | None = None) -> FloatArray:
    """Return control points counted from `origin`; (w x, w y, w z, w) in place of each of a rational surface."""
    return _weighted(surface.control_points, surface.weights, origin)


def _weighted(points: FloatArray, weights: FloatArray | None, origin: FloatArray | None = None) -> FloatArray:
    """Return points counted from `origin`, shape (..., 3); with weights (w x, w y, w z, w), shape (..., 4)."""
    points = points if origin is None else points - origin
    return points if weights is None else np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)


def _rows(curves: Sequence[BSplineCurve], origin: FloatArray | None = None) -> list[_Row]:
    """Return rows counted from `origin`, all with four numbers where one is rational: what has no weights has 1."""
    rational = any(c.weights is not None for c in curves)
    rows = []
    for c in curves:
        weights = np.ones(len(c.control_points)) if rational and c.weights is None else c.weights
        rows.append(_Row(c.degree, c.knots, _weighted(c.control_points, weights, origin)))
    return rows


def surface_points(
    surface: BSplineSurface | SemiStructuredSurface, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0
) -> FloatArray:
    """Evaluate a surface or one of its mixed derivatives at the points (u[k], v[k]).

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    u, v : array_like, shape (K,)
    du, dv : int
        Orders of the derivative.

    Returns
    -------
    ndarray, shape (K, 3)
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    orders = [(a, b) for a in range(du + 1) for b in range(dv + 1)] if surface.is_rational else [(du, dv)]
    if isinstance(surface, SemiStructuredSurface):
        rows = _rows(surface.control_curves)
        along = {
            b: np.stack([curve_points(row.degree, row.knots, row.control_points, v, b) for row in rows], axis=1)
            for b in {b for _, b in orders}
        }
        found = {(a, b): curve_points(surface.degree_u, surface.knots_u, along[b], u, a) for a, b in orders}
    else:
        found = {order: _homogeneous(surface, u, v, *order) for order in orders}
    return _euclidean(found)[du, dv]


def _euclidean(values: dict[tuple[int, int], FloatArray]) -> dict[tuple[int, int], FloatArray]:
    """Return derivatives of S from those of (w S, w), of all orders below each too; those of three numbers are S's.

    Quotient rule, order by order: (w S)^(a,b) = sum of binomials w^(i,j) S^(a-i,b-j).
    """
    if all(value.shape[1] == 3 for value in values.values()):
        return values
    known: dict[tuple[int, int], FloatArray] = {}
    for a, b in sorted(values):
        total = values[a, b][:, :3]
        for i in range(a + 1):
            for j in range(b + 1):
                if (i, j) != (0, 0):
                    total = total - comb(a, i) * comb(b, j) * values[i, j][:, 3:] * known[a - i, b - j]
        known[a, b] = total / values[0, 0][:, 3:]
    return known


@dataclass(frozen=True, eq=False)
class _Row:
    """A B-spline curve: one that runs along an edge."""

    degree: int
    knots: FloatArray
    control_points: FloatArray


@dataclass(frozen=True, eq=False)
class EdgeCurves:
    """Cross derivatives of a surface along one edge, ready to be evaluated at many parameters.

    A clamped spline ends at its first (last) control point, and its derivatives do at theirs: of order d, by
    differences of the d + 1 control points at that end. So only the rows next to the edge are read.

    Attributes
    ----------
    rows : tuple of _Row
        The rows next to the edge, the nearest first; those over the same knots are one row in more dimensions.
    dimension : int
        Numbers that each row has in one parameter: 3, or 4 for a rational surface.
    steps : tuple of tuples of float
        What the differences across the edge are divided by, for each order. Where there are none, the rows are those of
        the cross derivatives themselves.
    """

    rows: tuple[_Row, ...]
    dimension: int
    steps: tuple[tuple[float, ...], ...]

    def points(self, s: FloatArray, order: int = 2) -> dict[tuple[int, int], FloatArray]:
        """Return derivatives at parameters along the edge, each of shape (K, 3).

        The keys are (order across, order along), of all that add up to at most `order`.
        """
        values = {}
        for along in range(order + 1):
            for across, value in enumerate(self._across(s, along, order - along)):
                values[across, along] = value
        return _euclidean(values)

    def _across(self, s: FloatArray, along: int, order: int) -> list[FloatArray]:
        """Return cross derivatives up to `order` of the derivative along the edge, each of shape (K, d)."""
        points: list[FloatArray] = []
        for row in self.rows:
            more = self.dimension * (order + 1 - len(points))
            if more > 0:
                found = curve_points(row.degree, row.knots, row.control_points[:, :more], s, along)
                points += np.split(found, found.shape[1] // self.dimension, axis=1)
        values = _ends(points, self.steps) if self.steps else points
        return values + [np.zeros_like(values[0])] * (order + 1 - len(values))


def edge_curves(
    surface: BSplineSurface | SemiStructuredSurface,
    edge: NaturalEdge,
    order: int = 2,
    origin: ArrayLike = (0.0, 0.0, 0.0),
) -> EdgeCurves:
    """Prepare what `EdgeCurves` evaluates along edge u0, u1, v0 or v1: derivatives up to `order`.

    Points are counted from `origin`, shape (3,).

    Examples
    --------
    >>> k = [0, 0, 1, 1]
    >>> roof = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[2, 0, 1], [2, 1, 1]]])
    >>> edge_curves(roof, "u0").points(np.array([0.5]))[1, 0]
    array([[2., 0., 1.]])
    """
    at_end = edge[1] == "1"
    centre = np.asarray(origin, dtype=np.float64)
    if isinstance(surface, BSplineSurface):
        net = _net(surface, centre)
        across, along = (surface.degree_u, surface.knots_u), (surface.degree_v, surface.knots_v)
        if edge[0] == "v":
            net, across, along = net.transpose(1, 0, 2), along, across
        rows = [_Row(*along, net[i]) for i in _nearest(len(net), across[0], at_end, order)]
        return EdgeCurves(_stacked(rows), net.shape[2], _steps(*across, at_end, order))
    if edge[0] == "u":
        nearest = _nearest(len(surface.control_curves), surface.degree_u, at_end, order)
        curves = [surface.control_curves[i] for i in nearest]
        rows = _rows(curves, centre)
        dimension = rows[0].control_points.shape[1]
        return EdgeCurves(_stacked(rows), dimension, _steps(surface.degree_u, surface.knots_u, at_end, order))
    # Each curve ends with derivatives of its own; those of one order are control points of a curve in u.
    rows = _rows(surface.control_curves, centre)
    dimension = rows[0].control_points.shape[1]
    ends = np.zeros((len(rows), order + 1, dimension))
    for end, row in zip(ends, rows, strict=True):
        points = [row.control_points[i] for i in _nearest(len(row.control_points), row.degree, at_end, order)]
        values = _ends(points, _steps(row.degree, row.knots, at_end, order))
        end[: len(values)] = values
    line = _Row(surface.degree_u, surface.knots_u, ends.reshape(len(ends), -1))
    return EdgeCurves((line,), dimension, ())


def end_differences(degree: int, knots: FloatArray, at_end: bool, order: int) -> FloatArray:
    """Return by how much each of the points at an end enters each derivative there, shape (order + 1, order + 1).

    Orders in rows; the nearest point first. Zeros above the degree.

    Examples
    --------
    >>> end_differences(2, np.array([0.0, 0, 0, 1, 2, 2, 2]), False, 2)
    array([[ 1.,  0.,  0.],
           [-2.,  2.,  0.],
           [ 2., -3.,  1.]])
    """
    result = np.zeros((order + 1, order + 1))
    values = _ends(list(np.eye(order + 1)[: min(order, degree) + 1]), _steps(degree, knots, at_end, order))
    result[: len(values)] = values
    return result


def _nearest(n: int, degree: int, at_end: bool, order: int) -> list[int]:
    """Return which of n points derivatives up to `order` read at an end, the nearest first."""
    return [n - 1 - i if at_end else i for i in range(min(order, degree) + 1)]


def _steps(degree: int, knots: FloatArray, at_end: bool, order: int) -> tuple[tuple[float, ...], ...]:
    """Return what differences of the points that `_nearest` returns are divided by, for each order up to `order`."""
    n = len(knots) - degree - 1
    result = []
    for s in range(1, min(order, degree) + 1):
        places = range(min(order, degree) + 1 - s)
        indices = [n - 1 - s - j for j in places] if at_end else list(places)
        # Points that run away from the end have differences of the other sign.
        sign = -1.0 if at_end else 1.0
        result.append(tuple(sign * float(knots[i + degree + 1] - knots[i + s]) / (degree + 1 - s) for i in indices))
    return tuple(result)


def _ends(points: list[FloatArray], steps: tuple[tuple[float, ...], ...]) -> list[FloatArray]:
    """Return the ends of a spline and of its derivatives, as far as the points, the nearest to the end first, go."""
    values = [points[0]]
    for widths in steps[: len(points) - 1]:
        points = [(b - a) / width for (a, b), width in zip(pairwise(points), widths, strict=False)]
        values.append(points[0])
    return values


def _stacked(rows: list[_Row]) -> tuple[_Row, ...]:
    """Return the rows, neighbours over the same knots as one row in more dimensions."""
    result = rows[:1]
    for row in rows[1:]:
        last = result[-1]
        if row.degree == last.degree and np.array_equal(row.knots, last.knots):
            result[-1] = replace(last, control_points=np.concatenate([last.control_points, row.control_points], axis=1))
        else:
            result.append(row)
    return tuple(result)
