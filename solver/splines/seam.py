"""Closed curves and surfaces that start elsewhere: split there, put together the other way round.

In homogeneous coordinates the two ends may differ by a factor, which one of the parts is multiplied with. Of the knots
at the old seam as many are taken away as the smoothness of the spline allows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import InputError, KnotError, OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.coarsening import coarsening_matrix
from semispline.solver.splines.deviation import deviation_bound
from semispline.solver.splines.evaluation import euclidean
from semispline.solver.splines.operations import from_homogeneous
from semispline.solver.splines.refinement import combined, piece_matrix, refinement_matrix, snapped
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, named_row

S = TypeVar("S", BSplineSurface, SemiStructuredSurface)
# Roundings of the largest coordinate that are allowed on top of a tolerance.
ROUNDING = 16 * float(np.finfo(float).eps)


def move_curve_seam(curve: BSplineCurve, v: float, tolerance: float = 1e-12) -> BSplineCurve:
    """Return a closed curve that starts and ends at v.

    Its domain is [v, v + length of the old one]: points keep their parameters, or have them one length later.

    Parameters
    ----------
    curve : BSplineCurve
        Rational too: in homogeneous coordinates its ends may differ by a factor.
    v : float
        Inside the domain.
    tolerance : float
        How far the ends may be apart, and how far points may move where knots of the old seam are taken away, as a
        fraction of the largest extent; rounding of coordinates is allowed on top.

    Raises
    ------
    InputError
        The ends are not one point.
    KnotError
        v not inside the domain.
    OptionError
        A tolerance that is negative or not finite.

    Examples
    --------
    >>> triangle = BSplineCurve(1, [0, 0, 1, 2, 3, 3], [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]])
    >>> moved = move_curve_seam(triangle, 1)
    >>> moved.knots, moved.control_points[:, 0]
    (array([1., 1., 2., 3., 4., 4.]), array([1., 0., 0., 1.]))
    """
    require(curve, "curve", BSplineCurve)
    at = _inside(v, "v", curve.knots)
    points = curve.homogeneous
    limit = _limit([points], tolerance)
    knots, moved = _moved([curve.degree], curve.knots, points, at, limit, _factor(points, limit, "curve"))
    points, weights = euclidean(moved)
    return replace(curve, knots=knots, control_points=points, weights=weights)


def move_seam(surface: S, u: float | None = None, v: float | None = None, tolerance: float = 1e-12) -> S:
    """Return a closed surface that starts and ends at u, at v, or both; as `move_curve_seam`.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Rational too: in homogeneous coordinates its two edges may differ by a factor.
    u, v : float, optional
        Inside the domain, of a direction in which the surface is closed.
    tolerance : float
        As a fraction of the largest extent.

    Raises
    ------
    InputError
        The surface is not closed in that direction, or its weights there do not differ by one factor, or u of a
        semi-structured surface: its v-control curves are rows of one sheet.
    KnotError
        A parameter not inside the domain.
    OptionError
        A tolerance that is negative or not finite.

    Examples
    --------
    >>> pipe = [[[0, 0, z], [1, 0, z], [0, 1, z], [0, 0, z]] for z in (0, 1)]
    >>> moved = move_seam(BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 2, 3, 3], pipe), v=2)
    >>> moved.domain, moved.control_points[0, :, 1]
    (((0.0, 1.0), (2.0, 5.0)), array([1., 0., 0., 1.]))
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if isinstance(surface, SemiStructuredSurface):
        if u is not None:
            raise InputError(
                "u: the v-control curves of a semi-structured surface are rows of one sheet; convert it first: "
                "move_seam(surface.to_bspline(), u)"
            )
        return surface if v is None else _moved_rows(surface, v, tolerance)
    limit = _limit([surface.homogeneous], tolerance)
    if u is not None:
        at, net = _inside(u, "u", surface.knots_u), surface.homogeneous
        factor = _factor(net, limit, "surface in u")
        degrees = [surface.degree_u, surface.degree_v]
        knots, net = _moved(degrees, surface.knots_u, net, at, limit, factor)
        surface = from_homogeneous(surface.degree_u, surface.degree_v, knots, surface.knots_v, net)
    if v is not None:
        at, net = _inside(v, "v", surface.knots_v), surface.homogeneous.transpose(1, 0, 2)
        factor = _factor(net, limit, "surface in v")
        degrees = [surface.degree_v, surface.degree_u]
        knots, net = _moved(degrees, surface.knots_v, net, at, limit, factor)
        net = net.transpose(1, 0, 2)
        surface = from_homogeneous(surface.degree_u, surface.degree_v, surface.knots_u, knots, net)
    return surface


def _moved_rows(surface: SemiStructuredSurface, v: float, tolerance: float) -> SemiStructuredSurface:
    at = _inside(v, "v", np.unique(np.concatenate([curve.knots for curve in surface.control_curves])))
    limit = _limit([curve.homogeneous for curve in surface.control_curves], tolerance)
    ends = np.stack([_with_weight(curve.homogeneous[[0, -1]]) for curve in surface.control_curves], axis=1)
    factor = _factor(ends, limit, "surface in v")
    curves = []
    for i, curve in enumerate(surface.control_curves):
        with named_row(i):
            knots, moved = _moved([curve.degree], curve.knots, curve.homogeneous, at, limit, factor)
            points, weights = euclidean(moved)
            curves.append(replace(curve, knots=knots, control_points=points, weights=weights))
    return replace(surface, control_curves=tuple(curves))


def _with_weight(points: FloatArray) -> FloatArray:
    return points if points.shape[-1] == 4 else np.append(points, np.ones((len(points), 1)), axis=1)


def _inside(value: float, name: str, knots: FloatArray) -> float:
    at = snapped(real_number(value, name, KnotError), knots)
    if not knots[0] < at < knots[-1]:
        raise KnotError(f"{name}: found {value}, expected a value inside ({knots[0]}, {knots[-1]})")
    return at


def _limit(nets: Sequence[FloatArray], tolerance: float) -> float:
    """Return how far points may be apart or move: the tolerance, and rounding."""
    if not 0 <= real_number(tolerance, "tolerance", OptionError) < np.inf:
        raise OptionError(f"tolerance: found {tolerance}, expected a finite number of at least 0")
    parts = [euclidean(net) for net in nets]
    points = np.concatenate([x.reshape(-1, 3) for x, _ in parts])
    spread = max(1.0 if w is None else float(w.max() / w.min()) for _, w in parts)
    return tolerance * float(np.ptp(points, axis=0).max()) + ROUNDING * float(np.abs(points).max()) * spread


def _factor(net: FloatArray, limit: float, name: str) -> float:
    """Return by what the homogeneous points at the end differ from those at the start, along axis 0."""
    points, weights = euclidean(net[[0, -1]])
    gap = float(np.linalg.norm(points[0] - points[1], axis=-1).max())
    if not gap <= limit:
        raise InputError(f"{name}: its ends are {gap:.3g} apart, expected a closed one (at most {limit:.3g})")
    if weights is None:
        return 1.0
    ratio = np.atleast_1d(weights[1] / weights[0])
    if not np.ptp(ratio) <= 1e-9 * ratio.max():
        raise InputError(
            f"{name}: the weights at its end are {ratio.min():.6g} to {ratio.max():.6g} times those at its start, "
            "expected one factor"
        )
    return float(np.median(ratio))


def _moved(
    degrees: Sequence[int], knots: FloatArray, net: FloatArray, at: float, limit: float, factor: float
) -> tuple[FloatArray, FloatArray]:
    """Return the knots and the homogeneous net that start at `at` along axis 0, of degree `degrees[0]`."""
    p, start, end = degrees[0], float(knots[0]), float(knots[-1])
    (to_first, first), (to_second, second) = piece_matrix(p, knots, start, at), piece_matrix(p, knots, at, end)
    later = factor * combined(to_first, net)
    earlier = combined(to_second, net)
    joint = (earlier[-1:] + later[:1]) / 2
    # Closed to the last digit.
    last = factor * earlier[:1]
    moved = np.concatenate([earlier[:-1], joint, later[1:-1], last])
    before, after = second[: -p - 1], first[p + 1 :] + (end - start)
    for copies in range(p):
        fewer = np.concatenate([before, np.full(copies, end), after])
        refining = refinement_matrix(p, fewer, np.concatenate([before, np.full(p, end), after]))
        coarse = combined(coarsening_matrix(refining), moved)
        if (coarse[..., 3:] > 0).all() and deviation_bound(degrees, combined(refining, coarse), moved) <= limit:
            return fewer, coarse
    return np.concatenate([before, np.full(p, end), after]), moved
