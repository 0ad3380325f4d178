"""Surfaces of revolution: exact with standard arcs, exact and smooth, or polynomial."""

from __future__ import annotations

from math import ceil, cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, require, space_points
from semispline.solver.errors import ControlPointError, OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.approximation import Approximation
from semispline.solver.splines.construction import rows_of_weights
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.products import smooth_arc
from semispline.solver.splines.refinement import clamp_knots
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface


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


def revolve_smooth(
    curve: BSplineCurve, axis_point: ArrayLike, axis_direction: ArrayLike, angle: float = 360.0
) -> BSplineSurface:
    """Return the surface of revolution of a curve: exact, rational, degree 6 and C2 in u, at the seam of 360 too.

    v runs along the curve; u in [0, 1] turns it about the axis by `angle`, right-handed. The circle is the square of a
    uniform complex spline of degree 3, of 11 points for a whole turn; it is C2 in homogeneous coordinates, as blends
    with other surfaces need it, where that of `revolve` is C0. u is nearly proportional to the angle: off by at most
    1.23 degrees, over a half or a whole turn.

    Parameters
    ----------
    curve : BSplineCurve
        Rational too.
    axis_point, axis_direction : array_like, shape (3,)
    angle : float
        Degrees, above 0 and at most 360.

    Raises
    ------
    OptionError
        An angle outside (0, 360].
    ControlPointError
        An axis of no direction.

    Source: `semispline.derivations.circles`.

    Examples
    --------
    >>> line = BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [2, 0, 5]])
    >>> cylinder = revolve_smooth(line, [0, 0, 0], [0, 0, 1])
    >>> cylinder.control_points.shape, cylinder.evaluate([0.25], [0.0]).round(12) + 0.0
    ((11, 2, 3), array([[0., 2., 0.]]))
    """
    require(curve, "curve", BSplineCurve)
    turn = 2 * pi if angle == 360 else _radians(angle)
    on_axis, radial, across = _axis_frame(curve.control_points, axis_point, axis_direction)
    basis, circle = smooth_arc(turn, 2, ceil(turn / pi))
    x, y, w = circle.T[:, :, None]
    net = on_axis + (x / w)[..., None] * radial + (y / w)[..., None] * across
    weights = w * (np.ones(len(radial)) if curve.weights is None else curve.weights)
    return BSplineSurface(basis.degree, curve.degree, basis.knots, curve.knots, net, weights)


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
    surface = BSplineSurface(3, curve.degree, knots_u, curve.knots, net, rows_of_weights(curve, len(net)))
    # Some roundings each for the foot on the axis, the turned vector, the spline's coefficients and their sum.
    largest = max(
        float(np.abs(points).max())
        for points in (curve.control_points, net, space_points(axis_point, 1, "axis_point", ControlPointError))
    )
    return Approximation(surface, radius * 5 / 384 * (turn / spans) ** 4 + 32 * float(np.finfo(float).eps) * largest)


def _radians(angle: float) -> float:
    if not 0 < real_number(angle, "angle", OptionError) <= 360:
        raise OptionError(f"angle: found {angle}, expected degrees above 0 and at most 360")
    return angle * pi / 180.0


def _axis_frame(
    points: FloatArray, axis_point: ArrayLike, axis_direction: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return for each point its foot on the axis, the vector from there, and that vector turned by 90 degrees."""
    origin, direction = (
        space_points(axis_point, 1, "axis_point", ControlPointError),
        space_points(axis_direction, 1, "axis_direction", ControlPointError),
    )
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
