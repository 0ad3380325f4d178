"""Surfaces made from what users have: points, curves, planes, and an axis to turn a curve about."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, cos, pi, sin
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, finite_array, require
from semispline.solver.errors import ControlPointError, InputError, KnotError, OptionError
from semispline.solver.scalars import is_whole, real_number, whole_number
from semispline.solver.splines.knots import clamped, uniform_knots
from semispline.solver.splines.operations import elevate_degree
from semispline.solver.splines.refinement import clamp_knots
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

S = TypeVar("S", BSplineSurface, SemiStructuredSurface)


def plane(
    origin: ArrayLike, edge_u: ArrayLike, edge_v: ArrayLike, degree_u: int = 1, degree_v: int = 1
) -> BSplineSurface:
    """Return the parallelogram origin + u edge_u + v edge_v over the unit square.

    Parameters
    ----------
    origin, edge_u, edge_v : array_like, shape (3,)
    degree_u, degree_v : int

    Raises
    ------
    ControlPointError
        Edges that are parallel, or of length zero.

    Examples
    --------
    >>> plane([0, 0, 0], [2, 0, 0], [0, 1, 0], degree_v=3).evaluate([0.5], [0.25])
    array([[1.  , 0.25, 0.  ]])
    """
    o, a, b = (_vector(x, name) for x, name in ((origin, "origin"), (edge_u, "edge_u"), (edge_v, "edge_v")))
    # Scaled first: products of very long or short edges would overflow.
    x, y = (e / (np.abs(e).max() or 1.0) for e in (a, b))
    if not np.linalg.norm(np.cross(x, y)) > 1e-12 * np.linalg.norm(x) * np.linalg.norm(y):
        raise ControlPointError(f"edge_v: found {b.tolist()}, expected a vector not parallel to edge_u {a.tolist()}")
    knots = clamped([], 1, 0.0, 1.0)
    corners = BSplineSurface(1, 1, knots, knots, np.array([[o, o + b], [o + a, o + a + b]]))
    return elevate_degree(corners, degree_u, degree_v)


def interpolate_curve(points: ArrayLike, degree: int = 3, parameters: ArrayLike | None = None) -> BSplineCurve:
    """Return the curve through points, in SciPy's not-a-knot form where the degree is 3.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    degree : int
    parameters : array_like, shape (n,), optional
        Increasing; chord length scaled to [0, 1] unless given.

    Examples
    --------
    >>> curve = interpolate_curve([[0, 0, 0], [1, 1, 0], [2, 0, 0]], degree=2)
    >>> curve.evaluate([0.5]).round(12)
    array([[1., 1., 0.]])
    """
    data = _points(points, 2, "points")
    t = _chord_parameters(data[:, None], "points") if parameters is None else parameters
    knots, coefficients = _interpolate(data, degree, t, "parameters")
    return BSplineCurve(degree, knots, coefficients)


def interpolate_grid(
    points: ArrayLike,
    degree_u: int = 3,
    degree_v: int = 3,
    u: ArrayLike | None = None,
    v: ArrayLike | None = None,
) -> BSplineSurface:
    """Return the surface through a grid of points.

    Parameters
    ----------
    points : array_like, shape (n_u, n_v, 3)
    degree_u, degree_v : int
    u, v : array_like, shapes (n_u,) and (n_v,), optional
        Increasing parameters of the grid lines; mean chord length scaled to [0, 1] unless given.

    Raises
    ------
    ControlPointError
        Too few points for a degree, or neighbouring grid lines that coincide.

    Examples
    --------
    >>> x, y = np.mgrid[0:1:4j, 0:1:5j]
    >>> surface = interpolate_grid(np.stack([x, y, x * y], axis=2))
    >>> surface.evaluate([0.5], [0.5]).round(12)
    array([[0.5 , 0.5 , 0.25]])
    """
    grid = _points(points, 3, "points")
    along_u = _chord_parameters(grid, "points") if u is None else u
    along_v = _chord_parameters(grid.transpose(1, 0, 2), "points (axis 1)") if v is None else v
    knots_u, net = _interpolate(grid, degree_u, along_u, "u")
    knots_v, turned = _interpolate(np.ascontiguousarray(net.transpose(1, 0, 2)), degree_v, along_v, "v")
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, turned.transpose(1, 0, 2))


def skin(curves: Sequence[BSplineCurve], degree_u: int = 3, knots_u: ArrayLike | None = None) -> SemiStructuredSurface:
    """Return the semi-structured surface with these v-control curves, over uniform u-knots on [0, 1] unless given.

    Examples
    --------
    >>> curves = [BSplineCurve(1, [0, 0, 1, 1], [[x, 0, 0], [x, 1, 0]]) for x in range(4)]
    >>> skin(curves).evaluate([0.5], [0.5])
    array([[1.5, 0.5, 0. ]])
    """
    require(curves, "curves", Iterable)
    rows = tuple(curves)
    whole_number(degree_u, "degree_u", 1, OptionError)
    if knots_u is None:
        if len(rows) < degree_u + 1:
            raise ControlPointError(f"curves: {len(rows)} for degree {degree_u}, expected at least {degree_u + 1}")
        knots_u = uniform_knots(degree_u, len(rows) - degree_u)
    return SemiStructuredSurface(degree_u, finite_array(knots_u, 1, "knots_u", KnotError), rows)


def ruled(a: BSplineCurve, b: BSplineCurve) -> BSplineSurface:
    """Return the surface of straight lines from a(v) at u = 0 to b(v) at u = 1.

    Curves with other knots or degrees are brought together exactly; `skin([a, b], 1)` leaves each as it is.

    Examples
    --------
    >>> a = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
    >>> b = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 1], [1, 1, 0]])
    >>> ruled(a, b).evaluate([0.5], [0.5])
    array([[0.5, 0.5, 0.5]])
    """
    return skin([a, b], 1).to_bspline()


def extrude(curve: BSplineCurve, vector: ArrayLike, degree_u: int = 1) -> BSplineSurface:
    """Return the surface curve(v) + u vector, u in [0, 1].

    Examples
    --------
    >>> extrude(BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]]), [2, 0, 0]).evaluate([0.5], [0.5])
    array([[1. , 0.5, 0. ]])
    """
    require(curve, "curve", BSplineCurve)
    by = _vector(vector, "vector")
    if not by.any():
        raise ControlPointError(f"vector: found {by.tolist()}, expected one that is not zero")
    net = np.stack([curve.control_points, curve.control_points + by])
    weights = _rows_of_weights(curve, 2)
    knots_u = clamped([], 1, 0.0, 1.0)
    return elevate_degree(BSplineSurface(1, curve.degree, knots_u, curve.knots, net, weights), degree_u)


@dataclass(frozen=True, eq=False)
class Approximation(Generic[S]):
    """A surface that stands for another.

    Attributes
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    error : float
        No point is farther than this from the point of the exact surface with the same parameters; in model units.
    """

    surface: S
    error: float


def revolve(
    curve: BSplineCurve, axis_point: ArrayLike, axis_direction: ArrayLike, angle: float = 360.0
) -> BSplineSurface:
    """Return the surface of revolution of a curve: exact, rational, degree 2 in u.

    v runs along the curve; u in [0, 1] turns it about the axis by `angle`, right-handed, in arcs of at most 90
    degrees whose joints are C1. u is not proportional to the angle within an arc.

    Parameters
    ----------
    curve : BSplineCurve
    axis_point, axis_direction : array_like, shape (3,)
    angle : float
        Degrees, above 0 and at most 360.

    Raises
    ------
    OptionError
        An angle outside (0, 360].
    ControlPointError
        An axis of no direction.

    Examples
    --------
    >>> line = BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [2, 0, 5]])
    >>> cylinder = revolve(line, [0, 0, 0], [0, 0, 1], 90)
    >>> cylinder.evaluate([0.5], [0.0]).round(12)
    array([[1.41421356, 1.41421356, 0.        ]])
    """
    require(curve, "curve", BSplineCurve)
    turn = _radians(angle)
    arcs = ceil(angle / 90.0)
    half = turn / (2 * arcs)
    on_axis, radial, across = _axis_frame(curve.control_points, axis_point, axis_direction)
    rows, weights = [], []
    for i in range(2 * arcs + 1):
        weight = cos(half) if i % 2 else 1.0
        at = 0.0 if i * half == 2 * pi else i * half
        rows.append(on_axis + (cos(at) * radial + sin(at) * across) / weight)
        weights.append(weight * (np.ones(len(radial)) if curve.weights is None else curve.weights))
    joints = np.repeat(np.arange(1, arcs) / arcs, 2)
    return BSplineSurface(2, curve.degree, clamped(joints, 2, 0.0, 1.0), curve.knots, np.stack(rows), np.stack(weights))


def revolve_polynomial(
    curve: BSplineCurve,
    axis_point: ArrayLike,
    axis_direction: ArrayLike,
    angle: float = 360.0,
    tolerance: float = 1e-6,
) -> Approximation[BSplineSurface]:
    """Return a surface of revolution that is polynomial in u, of degree 3 and C2, with the bound on its error.

    v runs along the curve, and the surface is rational in v where the curve is; u in [0, 1] is proportional to the
    angle. Cosine and sine are replaced by cubic splines
    over n equal spans that interpolate them (with the end derivatives of an arc, periodic for a whole turn); those are
    off by at most 5/384 h^4, h = angle / n in radians, and the surface by that times the largest radius of a control
    point. Rounding is added to the stated error: 32 eps times the largest coordinate.

    Parameters
    ----------
    curve : BSplineCurve
    axis_point, axis_direction : array_like, shape (3,)
    angle : float
        Degrees, above 0 and at most 360.
    tolerance : float
        Largest error but for rounding, in model units; decides n.

    Raises
    ------
    OptionError
        An angle outside (0, 360], or a tolerance that is not positive.

    Source: C. Hall, W. Meyer, Optimal error bounds for cubic spline interpolation, 1976.

    Examples
    --------
    >>> line = BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [2, 0, 5]])
    >>> result = revolve_polynomial(line, [0, 0, 0], [0, 0, 1], 90, tolerance=1e-4)
    >>> result.surface.control_points.shape, result.error < 1e-4
    ((10, 2, 3), True)
    """
    # Waits: scipy.interpolate is slow to load.
    from scipy.interpolate import make_interp_spline

    require(curve, "curve", BSplineCurve)
    turn = _radians(angle)
    if not 0 < real_number(tolerance, "tolerance", OptionError) < np.inf:
        raise OptionError(f"tolerance: found {tolerance}, expected a positive length")
    on_axis, radial, across = _axis_frame(curve.control_points, axis_point, axis_direction)
    radius = float(np.linalg.norm(radial, axis=1).max())
    needed = turn * (5 * radius / (384 * tolerance)) ** 0.25
    if not needed <= 10_000:
        raise OptionError(f"tolerance: found {tolerance}, would need {needed:.3g} spans; expected a larger one")
    spans = max(4, ceil(needed))
    u = np.arange(spans + 1) / spans
    angles = u * turn
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    if angle == 360.0:
        circle[-1] = circle[0]
        spline = make_interp_spline(u, circle, k=3, bc_type="periodic")
    else:
        slopes = turn * np.stack([-circle[[0, -1], 1], circle[[0, -1], 0]], axis=1)
        spline = make_interp_spline(u, circle, k=3, bc_type=([(1, slopes[0])], [(1, slopes[1])]))
    knots_u, factors = clamp_knots(3, spline.t, spline.c)
    if angle == 360.0:
        factors[-1] = factors[0]
    net = on_axis + factors[:, 0, None, None] * radial + factors[:, 1, None, None] * across
    surface = BSplineSurface(3, curve.degree, knots_u, curve.knots, net, _rows_of_weights(curve, len(net)))
    # Some roundings each for the foot on the axis, the turned vector, the spline's coefficients and their sum.
    largest = max(
        float(np.abs(points).max()) for points in (curve.control_points, net, _vector(axis_point, "axis_point"))
    )
    return Approximation(surface, radius * 5 / 384 * (turn / spans) ** 4 + 32 * float(np.finfo(float).eps) * largest)


def _rows_of_weights(curve: BSplineCurve, count: int) -> FloatArray | None:
    """Return the weights of so many rows that all have those of the curve; None where it has none."""
    return None if curve.weights is None else np.tile(curve.weights, (count, 1))


def _vector(values: ArrayLike, name: str) -> FloatArray:
    vector = finite_array(values, 1, name, ControlPointError)
    if vector.shape != (3,):
        raise ControlPointError(f"{name}: {len(vector)} coordinate(s), expected 3")
    return vector


def _points(values: ArrayLike, ndim: int, name: str) -> FloatArray:
    points = finite_array(values, ndim, name, ControlPointError)
    if points.shape[-1] != 3:
        raise ControlPointError(f"{name}: points have {points.shape[-1]} coordinate(s), expected 3")
    return points


def _chord_parameters(grid: FloatArray, name: str) -> FloatArray:
    """Return parameters in [0, 1] of the grid lines along axis 0: mean chord lengths between neighbours."""
    steps = np.linalg.norm(np.diff(grid, axis=0), axis=2).mean(axis=1)
    if (steps == 0).any() or not len(steps):
        i = int(np.argmax(steps == 0)) + 1 if len(steps) else 0
        raise ControlPointError(f"{name}[{i}]: expected at least two, each away from the one before")
    t = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(t / t[-1])


def _interpolate(data: FloatArray, degree: int, parameters: ArrayLike, name: str) -> tuple[FloatArray, FloatArray]:
    # Waits: scipy.interpolate is slow to load.
    from scipy.interpolate import make_interp_spline

    t = finite_array(parameters, 1, name, InputError)
    if not is_whole(degree) or degree < 1 or len(data) < degree + 1:
        raise ControlPointError(
            f"points: {len(data)} along {name} for degree {degree!r}, expected a degree of at least 1, whole, and more "
            "points than that"
        )
    if len(t) != len(data):
        raise InputError(f"{name}: {len(t)} parameters, expected {len(data)}")
    if (np.diff(t) <= 0).any():
        i = int(np.argmax(np.diff(t) <= 0)) + 1
        raise InputError(f"{name}[{i}]: {t[i]} after {t[i - 1]}, expected increasing parameters")
    spline = make_interp_spline(t, data, k=degree)
    return spline.t, spline.c


def _radians(angle: float) -> float:
    if not 0 < real_number(angle, "angle", OptionError) <= 360:
        raise OptionError(f"angle: found {angle}, expected degrees above 0 and at most 360")
    return angle * pi / 180.0


def _axis_frame(
    points: FloatArray, axis_point: ArrayLike, axis_direction: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return for each point its foot on the axis, the vector from there, and that vector turned by 90 degrees."""
    origin, direction = _vector(axis_point, "axis_point"), _vector(axis_direction, "axis_direction")
    longest = float(np.abs(direction).max())
    # Below, numbers lose digits.
    if longest < np.finfo(float).tiny:
        raise ControlPointError(f"axis_direction: found {direction.tolist()}, expected a vector that is not zero")
    # Scaled first: squares of very long or short vectors would overflow or vanish.
    unit = direction / longest
    unit = unit / np.linalg.norm(unit)
    along = (points - origin) @ unit
    on_axis = origin + along[:, None] * unit
    radial = points - on_axis
    return on_axis, radial, np.cross(unit, radial)
