"""Derivatives of surfaces as surfaces: exact, over the fewest knots, refused where they do not exist.

A u-derivative of a semi-structured surface takes differences of neighbouring rows, so it is semi-structured again:
row i of the du-th derivative combines the rows i .. i + du and needs the union of their knots, no others.

Orders are taken one by one, and each must be continuous: where the first derivative jumps there is no second one, even
if its two sides agree. A mixed derivative may be taken v first or u first; it is refused if neither way exists.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np

from solver.arrays import FloatArray
from solver.compatible import combined_curves, compatible_curves
from solver.errors import InputError
from solver.evaluation import check_orders
from solver.knots import derivative_matrix, derivative_points
from solver.operations import swap_directions
from solver.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

# One-sided derivatives closer than this fraction of the largest control point of the derivative are one: what is left
# of a removable knot after rounding. Rounding of the input itself is allowed on top.
JUMP_TOLERANCE = 1e-10
# Eight roundings of a coordinate: what the differences of one stencil may collect.
ROUNDING = 8 * float(np.finfo(float).eps)

Row = TypeVar("Row")
Spline = TypeVar("Spline")
# One order of differentiation: the spline and the rounding that its control points carry, before and after.
Step = Callable[[Spline, float], tuple[Spline, float]]


def derivative_curve(curve: BSplineCurve, order: int = 1) -> BSplineCurve:
    """Return the derivative of a curve as a curve of degree q - order, but at least 1.

    Raises
    ------
    InputError
        The derivative, or one of lower order, jumps at a knot.

    Examples
    --------
    >>> parabola = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [0.5, 0, 0], [1, 1, 0]])
    >>> derivative_curve(parabola).control_points
    array([[1., 0., 0.],
           [1., 2., 0.]])
    """
    check_orders(order=order)
    step = partial(_curve_step, name=f"derivative of order {order}")
    return _repeated(curve, ROUNDING * _largest(curve.control_points), [step] * order)


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
    slack = ROUNDING * _largest(surface.control_points)
    return _mixed(surface, slack, [partial(_net_step_u, name=name)] * du, [partial(_net_step_v, name=name)] * dv)


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
    slack = ROUNDING * max(_largest(c.control_points) for c in surface.control_curves)
    return _mixed(surface, slack, [partial(_rows_step_u, name=name)] * du, [partial(_rows_step_v, name=name)] * dv)


def _mixed(surface: Spline, slack: float, steps_u: list[Step[Spline]], steps_v: list[Step[Spline]]) -> Spline:
    try:
        return _repeated(surface, slack, steps_v + steps_u)
    except InputError:
        if not (steps_u and steps_v):
            raise
        return _repeated(surface, slack, steps_u + steps_v)


def _repeated(spline: Spline, slack: float, steps: list[Step[Spline]]) -> Spline:
    for step in steps:
        spline, slack = step(spline, slack)
    return spline


def _curve_step(curve: BSplineCurve, slack: float, name: str) -> tuple[BSplineCurve, float]:
    points = derivative_points(curve.degree, curve.knots, curve.control_points)
    slack *= _gain(curve.degree, curve.knots)
    limit = JUMP_TOLERANCE * _largest(points) + slack
    degree, knots, rows = _continuous(
        curve.degree - 1, curve.knots[1:-1], list(points), _distance, limit=limit, name=name, letter="v"
    )
    return BSplineCurve(degree, knots, np.stack(rows)), slack


def _net_step_u(surface: BSplineSurface, slack: float, name: str, letter: str = "u") -> tuple[BSplineSurface, float]:
    points = derivative_points(surface.degree_u, surface.knots_u, surface.control_points)
    slack *= _gain(surface.degree_u, surface.knots_u)
    limit = JUMP_TOLERANCE * _largest(points) + slack
    degree, knots, rows = _continuous(
        surface.degree_u - 1, surface.knots_u[1:-1], list(points), _distance, limit=limit, name=name, letter=letter
    )
    return replace(surface, degree_u=degree, knots_u=knots, control_points=np.stack(rows)), slack


def _net_step_v(surface: BSplineSurface, slack: float, name: str) -> tuple[BSplineSurface, float]:
    derivative, slack = _net_step_u(swap_directions(surface), slack, name, "v")
    return swap_directions(derivative), slack


def _rows_step_u(surface: SemiStructuredSurface, slack: float, name: str) -> tuple[SemiStructuredSurface, float]:
    p, knots = surface.degree_u, surface.knots_u
    curves = list(combined_curves(surface.control_curves, derivative_matrix(p, knots, 1)))
    slack *= _gain(p, knots)
    limit = JUMP_TOLERANCE * max(_largest(c.control_points) for c in curves) + slack
    p, knots, curves = _continuous(p - 1, knots[1:-1], curves, _curve_distance, limit=limit, name=name, letter="u")
    return SemiStructuredSurface(p, knots, tuple(curves)), slack


def _rows_step_v(surface: SemiStructuredSurface, slack: float, name: str) -> tuple[SemiStructuredSurface, float]:
    rows = [_curve_step(c, slack, f"{name}, row {i}") for i, c in enumerate(surface.control_curves)]
    return replace(surface, control_curves=tuple(curve for curve, _ in rows)), max(slack for _, slack in rows)


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
                f"{name}: it, or one of lower order, jumps by {jump:.3g} at {letter} = {value}; "
                f"split_{letter} the surface there and differentiate the pieces"
            )
        keep_rows[left + 1 : right + 1] = False
        keep_knots[start : start + count - degree] = False
    rows = [row for row, kept in zip(rows, keep_rows, strict=True) if kept]
    knots = knots[keep_knots]
    if degree == 0:
        return 1, np.repeat(knots, 2), rows * 2
    return degree, knots, rows


def _gain(degree: int, knots: FloatArray) -> float:
    """Return the most by which control points of the derivative can exceed those of the spline."""
    return float(np.abs(derivative_matrix(degree, knots, 1)).sum(axis=1).max())


def _largest(points: FloatArray) -> float:
    return float(np.linalg.norm(points, axis=-1).max())


def _distance(a: FloatArray, b: FloatArray) -> float:
    return _largest(a - b)


def _curve_distance(a: BSplineCurve, b: BSplineCurve) -> float:
    """Bound the distance between two curves by that of their control points over common knots."""
    return 0.0 if a is b else _distance(*compatible_curves([a, b]).control_points)
