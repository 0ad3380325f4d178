"""Surfaces made from what users have: points, curves, planes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, finite_array, require, space_points
from semispline.solver.errors import ControlPointError, InputError, KnotError, OptionError
from semispline.solver.scalars import is_whole, whole_number
from semispline.solver.splines.knots import clamped, uniform_knots
from semispline.solver.splines.operations import elevate_degree
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface


def plane(
    origin: ArrayLike, edge_u: ArrayLike, edge_v: ArrayLike, degree_u: int = 1, degree_v: int = 1
) -> BSplineSurface:
    """Return the parallelogram origin + u edge_u + v edge_v over the unit square.

    Parameters
    ----------
    origin, edge_u, edge_v : array_like, shape (3,) or (2,)
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
    o, a, b = (
        space_points(x, 1, name, ControlPointError)
        for x, name in ((origin, "origin"), (edge_u, "edge_u"), (edge_v, "edge_v"))
    )
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
    points : array_like, shape (n, 3) or (n, 2)
    degree : int
    parameters : array_like, shape (n,), optional
        Increasing; chord length scaled to [0, 1] unless given.

    Examples
    --------
    >>> curve = interpolate_curve([[0, 0, 0], [1, 1, 0], [2, 0, 0]], degree=2)
    >>> curve.evaluate([0.5]).round(12)
    array([[1., 1., 0.]])
    """
    data = space_points(points, 2, "points", ControlPointError)
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
    points : array_like, shape (n_u, n_v, 3) or (n_u, n_v, 2)
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
    grid = space_points(points, 3, "points", ControlPointError)
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
    by = space_points(vector, 1, "vector", ControlPointError)
    if not by.any():
        raise ControlPointError(f"vector: found {by.tolist()}, expected one that is not zero")
    net = np.stack([curve.control_points, curve.control_points + by])
    weights = rows_of_weights(curve, 2)
    knots_u = clamped([], 1, 0.0, 1.0)
    return elevate_degree(BSplineSurface(1, curve.degree, knots_u, curve.knots, net, weights), degree_u)


def rows_of_weights(curve: BSplineCurve, count: int) -> FloatArray | None:
    """Return the weights of so many rows that all have those of the curve; None where it has none."""
    return None if curve.weights is None else np.tile(curve.weights, (count, 1))


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
