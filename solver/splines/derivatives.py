"""Derivatives of surfaces as surfaces: exact, over the fewest knots, refused where they do not exist.

A u-derivative of a semi-structured surface takes differences of neighbouring rows, so it is semi-structured again:
row i of the du-th derivative combines the rows i .. i + du and needs the union of their knots, no others. Knots of
different rows that are closer than 1e-12 of the v-domain become one there (`merge_knots` reports such a change).

Orders are taken one by one, and each must be continuous: where the first derivative jumps there is no second one, even
if its two sides agree. A mixed derivative may be taken v first or u first; it is refused if neither way exists.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Generic, TypeVar

import numpy as np

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import InputError
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.curves import combined_curves
from semispline.solver.splines.evaluation import check_orders
from semispline.solver.splines.knots import derivative_matrix, derivative_points
from semispline.solver.splines.operations import swap_directions
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

# One-sided derivatives closer than this fraction of themselves are one: what rounding leaves of a removable knot.
# Rounding of the input, as far as the differences at that knot enlarge it, is allowed on top.
JUMP_TOLERANCE = 1e-10
# Eight roundings of the largest coordinate: what a control point may carry.
ROUNDING = 8 * float(np.finfo(float).eps)

S = TypeVar("S", BSplineSurface, SemiStructuredSurface)
Row = TypeVar("Row")
Spline = TypeVar("Spline")
Rounding = TypeVar("Rounding")
# One order of differentiation: the spline and the rounding that each of its control points carries (for the rows of a
# semi-structured surface: one such array each), before and after.
Step = Callable[[Spline, Rounding], tuple[Spline, Rounding]]


def derivative_curve(curve: BSplineCurve, order: int = 1) -> BSplineCurve:
    """Return the derivative of a curve as a curve of degree q - order, but at least 1.

    Raises
    ------
    InputError
        A rational curve (its derivative has other weights and twice the degree), or a derivative that jumps at a knot,
        or one of lower order that does.

    Examples
    --------
    >>> parabola = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [0.5, 0, 0], [1, 1, 0]])
    >>> derivative_curve(parabola).control_points
    array([[1., 0., 0.],
           [1., 2., 0.]])
    """
    require(curve, "curve", BSplineCurve)
    check_orders(order=order)
    if curve.weights is not None:
        raise InputError("curve: rational; its derivative is not a spline of lower degree, use evaluate(v, order)")
    step = partial(_curve_step, name=f"derivative of order {order}")
    slack = np.full(len(curve.control_points), ROUNDING * _largest(curve.control_points))
    return _repeated(curve, slack, [step] * order)


def derivative_surface(surface: S, du: int = 0, dv: int = 0) -> S:
    """Return a mixed derivative of a polynomial surface as a surface of its kind, exactly, over the fewest knots.

    Degrees fall to 1 at the least. Row i of the derivative of a semi-structured surface has the knots of the rows
    i .. i + du of the surface, and the highest of their degrees less dv; a v-derivative alone leaves every curve with
    its own knots.

    Raises
    ------
    InputError
        A rational surface (its derivative has other weights and twice the degree), or a derivative that jumps at a
        knot.

    Examples
    --------
    >>> low = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
    >>> high = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 1], [1, 1, 0]])
    >>> surface = SemiStructuredSurface(1, [0, 0, 1, 1], (low, high))
    >>> derivative_surface(surface, du=1).evaluate([0.5], [0.5])
    array([[1., 0., 1.]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    check_orders(du=du, dv=dv)
    if surface.is_rational:
        raise InputError(
            "surface: rational; its derivative is not a spline of lower degree, use evaluate(u, v, du, dv)"
        )
    name = f"derivative ({du}, {dv})"
    if isinstance(surface, SemiStructuredSurface):
        rounding = ROUNDING * max(_largest(c.control_points) for c in surface.control_curves)
        rows = [np.full(len(c.control_points), rounding) for c in surface.control_curves]
        return _mixed(surface, rows, [partial(_rows_step_u, name=name)] * du, [partial(_rows_step_v, name=name)] * dv)
    slack = np.full(surface.control_points.shape[:2], ROUNDING * _largest(surface.control_points))
    return _mixed(surface, slack, [partial(_net_step_u, name=name)] * du, [partial(_net_step_v, name=name)] * dv)


def _mixed(
    surface: Spline, slack: Rounding, steps_u: list[Step[Spline, Rounding]], steps_v: list[Step[Spline, Rounding]]
) -> Spline:
    try:
        return _repeated(surface, slack, steps_v + steps_u)
    except InputError:
        if not (steps_u and steps_v):
            raise
        return _repeated(surface, slack, steps_u + steps_v)


def _repeated(spline: Spline, slack: Rounding, steps: list[Step[Spline, Rounding]]) -> Spline:
    for step in steps:
        spline, slack = step(spline, slack)
    return spline


def _curve_step(
    curve: BSplineCurve, slack: FloatArray, name: str, cure: str = "split_curve the curve"
) -> tuple[BSplineCurve, FloatArray]:
    points = derivative_points(curve.degree, curve.knots, curve.control_points)
    spread = _spread(curve.degree, curve.knots, slack)
    jumps = _Jumps(_distances, np.linalg.norm(points, axis=-1), spread, name, "v", cure)
    degree, knots, rows, slack = _continuous(curve.degree - 1, curve.knots[1:-1], list(points), jumps)
    return BSplineCurve(degree, knots, np.stack(rows)), slack


def _net_step_u(
    surface: BSplineSurface, slack: FloatArray, name: str, letter: str = "u"
) -> tuple[BSplineSurface, FloatArray]:
    p, knots = surface.degree_u, surface.knots_u
    points = derivative_points(p, knots, surface.control_points)
    sizes, spread = np.linalg.norm(points, axis=-1), _spread(p, knots, slack)
    jumps = _Jumps(_distances, sizes, spread, name, letter, f"split_{letter} the surface")
    degree, knots, rows, slack = _continuous(p - 1, knots[1:-1], list(points), jumps)
    return replace(surface, degree_u=degree, knots_u=knots, control_points=np.stack(rows)), slack


def _net_step_v(surface: BSplineSurface, slack: FloatArray, name: str) -> tuple[BSplineSurface, FloatArray]:
    derivative, turned = _net_step_u(swap_directions(surface), slack.T, name, "v")
    return swap_directions(derivative), turned.T


def _rows_step_u(
    surface: SemiStructuredSurface, slack: list[FloatArray], name: str
) -> tuple[SemiStructuredSurface, list[FloatArray]]:
    p, knots = surface.degree_u, surface.knots_u
    curves = list(combined_curves(surface.control_curves, derivative_matrix(p, knots, 1)))
    sizes = np.array([_largest(c.control_points) for c in curves])
    # Rows are combined over common knots, so that of a row only the largest rounding is known.
    spread = _spread(p, knots, np.array([row.max() for row in slack]))
    jumps = _Jumps(_curve_distance, sizes, spread, name, "u", "split_u the surface")
    p, knots, curves, rounding = _continuous(p - 1, knots[1:-1], curves, jumps)
    each = [np.full(len(c.control_points), x) for c, x in zip(curves, rounding, strict=True)]
    return SemiStructuredSurface(p, knots, tuple(curves)), each


def _rows_step_v(
    surface: SemiStructuredSurface, slack: list[FloatArray], name: str
) -> tuple[SemiStructuredSurface, list[FloatArray]]:
    rows = [
        _curve_step(curve, own, f"{name}, row {i}", "split_v the surface")
        for i, (curve, own) in enumerate(zip(surface.control_curves, slack, strict=True))
    ]
    return replace(surface, control_curves=tuple(curve for curve, _ in rows)), [own for _, own in rows]


@dataclass(frozen=True, eq=False)
class _Jumps(Generic[Row]):
    """What decides whether rows on either side of a knot are one.

    `distance` takes two rows; `size` and `slack` hold the size and the rounding of each row (axis 0), or of each
    control point of each row. All is local: a narrow span elsewhere, with its large numbers, allows nothing here.
    `cure` says how the spline that was given can be cut at the knot.
    """

    distance: Callable[[Row, Row], FloatArray]
    size: FloatArray
    slack: FloatArray
    name: str
    letter: str
    cure: str

    def check(self, left: int, right: int, value: float, one: Row, other: Row) -> None:
        jump = self.distance(one, other)
        limit = JUMP_TOLERANCE * np.maximum(self.size[left], self.size[right]) + self.slack[left] + self.slack[right]
        if np.any(jump > limit):
            raise InputError(
                f"{self.name}: it, or one of lower order, jumps by {np.max(jump):.3g} at {self.letter} = {value}; "
                f"{self.cure} there and differentiate the pieces"
            )


def _continuous(
    degree: int, knots: FloatArray, rows: list[Row], jumps: _Jumps[Row]
) -> tuple[int, FloatArray, list[Row], FloatArray]:
    """Return the same spline with inner multiplicities of at most the degree, and a degree of at least 1.

    At a knot of higher multiplicity two rows are the limits from either side; where they agree one of them goes, with
    the rows between, whose basis functions have no support. The last array is the rounding of the rows that stay.

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
        jumps.check(left, right, value, rows[left], rows[right])
        keep_rows[left + 1 : right + 1] = False
        keep_knots[start : start + count - degree] = False
    rows, slack = [row for row, kept in zip(rows, keep_rows, strict=True) if kept], jumps.slack[keep_rows]
    knots = knots[keep_knots]
    if degree == 0:
        return 1, np.repeat(knots, 2), rows * 2, np.repeat(slack, 2, axis=0)
    return degree, knots, rows, slack


def _spread(degree: int, knots: FloatArray, slack: FloatArray) -> FloatArray:
    """Return the rounding of the control points of the derivative, from that of the spline along axis 0."""
    return np.asarray(np.abs(derivative_matrix(degree, knots, 1)) @ slack)


def _largest(points: FloatArray) -> float:
    return float(np.linalg.norm(points, axis=-1).max())


def _distances(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(a - b, axis=-1))


def _curve_distance(a: BSplineCurve, b: BSplineCurve) -> FloatArray:
    """Bound the distance between two curves by that of their control points over common knots."""
    return np.zeros(1) if a is b else _distances(*compatible_curves([a, b]).homogeneous)
