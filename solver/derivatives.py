"""Derivatives of surfaces as surfaces: exact, over the fewest knots, refused where they are not continuous.

A u-derivative of a semi-structured surface takes differences of neighbouring rows, so it is semi-structured again:
row i of the du-th derivative combines the rows i .. i + du and needs the union of their knots, no others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from solver.arrays import FloatArray
from solver.compatible import combined_curves, compatible_curves
from solver.errors import InputError
from solver.knots import derivative_matrix, derivative_points
from solver.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, check_orders

# One-sided derivatives closer than this fraction of the largest control point of the derivative are one: what is left
# of a removable knot after rounding. Rounding of the input itself is allowed on top.
JUMP_TOLERANCE = 1e-10
# Eight roundings of a coordinate: what the differences of one stencil may collect.
ROUNDING = 8 * float(np.finfo(float).eps)

Row = TypeVar("Row")


def derivative_curve(curve: BSplineCurve, order: int = 1) -> BSplineCurve:
    """Return the derivative of a curve as a curve of degree q - order, but at least 1.

    Raises
    ------
    InputError
        The derivative jumps at a knot.

    Examples
    --------
    >>> parabola = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [0.5, 0, 0], [1, 1, 0]])
    >>> derivative_curve(parabola).control_points
    array([[1., 0., 0.],
           [1., 2., 0.]])
    """
    check_orders(order=order)
    slack = ROUNDING * float(np.abs(curve.control_points).max())
    return _derivative_curve(curve, order, slack, f"derivative of order {order}")


def surface_derivative(surface: BSplineSurface, du: int, dv: int) -> BSplineSurface:
    """Return a mixed derivative of a polynomial surface as a surface; degrees fall to 1 at the least.

    Raises
    ------
    InputError
        A rational surface (its derivative has other weights and twice the degree), or a derivative that jumps at a
        knot.
    """
    check_orders(du=du, dv=dv)
    if surface.weights is not None:
        raise InputError(
            "surface: rational; its derivative is not a spline of lower degree, use evaluate(u, v, du, dv)"
        )
    name = f"derivative ({du}, {dv})"
    slack = ROUNDING * float(np.abs(surface.control_points).max())
    slack *= _gain(surface.degree_u, surface.knots_u, du) * _gain(surface.degree_v, surface.knots_v, dv)
    p, q, ku, kv, net = surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, surface.control_points
    p, ku, net = _derivative_rows(p, ku, net, du)
    q, kv, turned = _derivative_rows(q, kv, net.transpose(1, 0, 2), dv)
    limit = JUMP_TOLERANCE * _largest(turned) + slack
    q, kv, columns = _continuous(q, kv, list(turned), _distance, limit=limit, name=name, letter="v")
    p, ku, rows = _continuous(p, ku, list(np.stack(columns, axis=1)), _distance, limit=limit, name=name, letter="u")
    return BSplineSurface(p, q, ku, kv, np.stack(rows))


def semistructured_derivative(surface: SemiStructuredSurface, du: int, dv: int) -> SemiStructuredSurface:
    """Return a mixed derivative of a semi-structured surface as a semi-structured surface.

    Row i has the knots of the rows i .. i + du of the surface, and the highest of their degrees less dv (but at least
    1), so a v-derivative alone leaves every curve with its own knots.

    Raises
    ------
    InputError
        A derivative that jumps at a knot of u, or of a row.
    """
    check_orders(du=du, dv=dv)
    name = f"derivative ({du}, {dv})"
    p, knots = surface.degree_u, surface.knots_u
    largest = max(float(np.abs(c.control_points).max()) for c in surface.control_curves)
    slack = ROUNDING * largest * _gain(p, knots, du)
    curves = surface.control_curves
    if du > p:
        p, knots, curves = 1, np.repeat(knots[[0, -1]], 2), (_zero(curves[0]), _zero(curves[0]))
    elif du:
        curves = combined_curves(curves, derivative_matrix(p, knots, du))
        p, knots = p - du, knots[du : len(knots) - du]
    rows = [_derivative_curve(c, dv, slack, f"{name}, row {i}") for i, c in enumerate(curves)]
    factor = max(_gain(c.degree, c.knots, dv) for c in curves)
    limit = JUMP_TOLERANCE * max(_largest(c.control_points) for c in rows) + slack * factor
    p, knots, rows = _continuous(p, knots, rows, _curve_distance, limit=limit, name=name, letter="u")
    return SemiStructuredSurface(p, knots, tuple(rows))


def _derivative_curve(curve: BSplineCurve, order: int, slack: float, name: str) -> BSplineCurve:
    if order == 0:
        return curve
    q, knots, points = _derivative_rows(curve.degree, curve.knots, curve.control_points, order)
    limit = JUMP_TOLERANCE * _largest(points) + slack * _gain(curve.degree, curve.knots, order)
    q, knots, rows = _continuous(q, knots, list(points), _distance, limit=limit, name=name, letter="v")
    return BSplineCurve(q, knots, np.stack(rows))


def _derivative_rows(
    degree: int, knots: FloatArray, rows: FloatArray, order: int
) -> tuple[int, FloatArray, FloatArray]:
    """Return degree, knots and rows of the derivative along axis 0, the degree possibly 0."""
    if order > degree:
        return 0, knots[[0, -1]], np.zeros((1, *rows.shape[1:]))
    return degree - order, knots[order : len(knots) - order], derivative_points(degree, knots, rows, order)


def _continuous(
    degree: int,
    knots: FloatArray,
    rows: list[Row],
    distance: Callable[[Row, Row], float],
    *,
    limit: float,
    name: str,
    letter: str,
) -> tuple[int, FloatArray, list[Row]]:
    """Return the same spline with inner multiplicities of at most the degree, and a degree of at least 1.

    At a knot of higher multiplicity two rows are the limits from either side; where they agree one of them goes, with
    the rows between, whose basis functions have no support.

    Raises
    ------
    InputError
        Where they do not agree: the spline jumps there.
    """
    inner, first, counts = np.unique(knots[degree + 1 : -degree - 1], return_index=True, return_counts=True)
    keep_rows, keep_knots = np.ones(len(rows), dtype=bool), np.ones(len(knots), dtype=bool)
    for value, start, count in zip(inner.tolist(), (first + degree + 1).tolist(), counts.tolist(), strict=True):
        if count <= degree:
            continue
        left, right = start - 1, start + count - degree - 1
        jump = distance(rows[left], rows[right])
        if jump > limit:
            raise InputError(
                f"{name}: jumps by {jump:.3g} at {letter} = {value}, expected a continuous derivative; "
                f"split_{letter} the surface there and differentiate the pieces"
            )
        keep_rows[left + 1 : right + 1] = False
        keep_knots[start : start + count - degree] = False
    rows = [row for row, kept in zip(rows, keep_rows, strict=True) if kept]
    knots = knots[keep_knots]
    if degree == 0:
        return 1, np.repeat(knots, 2), rows * 2
    return degree, knots, rows


def _gain(degree: int, knots: FloatArray, order: int) -> float:
    """Return the most by which the derivative's control points exceed those of the spline (infinity norm)."""
    if order == 0 or order > degree:
        return 1.0
    return float(np.abs(derivative_matrix(degree, knots, order)).sum(axis=1).max())


def _largest(points: FloatArray) -> float:
    return float(np.linalg.norm(points, axis=-1).max())


def _distance(a: FloatArray, b: FloatArray) -> float:
    return _largest(a - b)


def _curve_distance(a: BSplineCurve, b: BSplineCurve) -> float:
    """Bound the distance between two curves by that of their control points over common knots."""
    return 0.0 if a is b else _distance(*compatible_curves([a, b]).control_points)


def _zero(curve: BSplineCurve) -> BSplineCurve:
    return BSplineCurve(1, np.repeat(curve.knots[[0, -1]], 2), np.zeros((2, 3)))
