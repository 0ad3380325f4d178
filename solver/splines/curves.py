"""Operations on one v-control curve: reversal, degree, knots, splitting, continuity at a knot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, SparseMatrix, finite_array, require
from semispline.solver.errors import KnotError, OptionError
from semispline.solver.scalars import is_whole, real_number
from semispline.solver.splines.coarsening import coarser_points
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.deviation import deviation_bound
from semispline.solver.splines.evaluation import euclidean
from semispline.solver.splines.knots import reversed_knots
from semispline.solver.splines.refinement import (
    combined,
    elevated_knots,
    elevation_matrix,
    piece_matrix,
    refinement_matrix,
    snapped,
    with_knots,
)
from semispline.solver.splines.surfaces import BSplineCurve


def reverse_curve(curve: BSplineCurve) -> BSplineCurve:
    """Return the curve run backwards over the same domain.

    Examples
    --------
    >>> reverse_curve(BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [2, 0, 0]])).evaluate([0.25])
    array([[1.5, 0. , 0. ]])
    """
    require(curve, "curve", BSplineCurve)
    weights = None if curve.weights is None else curve.weights[::-1]
    points = curve.control_points[::-1]
    return replace(curve, knots=reversed_knots(curve.knots), control_points=points, weights=weights)


def elevate_curve(curve: BSplineCurve, degree: int) -> BSplineCurve:
    """Return the same curve with a higher degree; exact for inner knots of any multiplicity.

    Examples
    --------
    >>> elevate_curve(BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [2, 0, 0]]), 2).control_points[:, 0]
    array([0., 1., 2.])
    """
    require(curve, "curve", BSplineCurve)
    if degree == curve.degree:
        return curve
    points = combined(elevation_matrix(curve.degree, curve.knots, degree), curve.homogeneous)
    return _with_points(curve, degree, elevated_knots(curve.knots, degree - curve.degree), points)


def insert_curve_knots(curve: BSplineCurve, knots: ArrayLike) -> BSplineCurve:
    """Return the same curve with knots inserted; a knot is repeated to insert it several times.

    A value within 1e-12 of the domain of a knot means that knot.

    Examples
    --------
    >>> insert_curve_knots(BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [2, 0, 0]]), [0.25]).control_points[:, 0]
    array([0. , 0.5, 2. ])
    """
    return insert_named(curve, finite_array(knots, 1, "knots", KnotError), "knots")


def insert_named(curve: BSplineCurve, more: FloatArray, name: str) -> BSplineCurve:
    """Return what `insert_curve_knots` does, with the caller's name for the knots in messages."""
    require(curve, "curve", BSplineCurve)
    refined = with_knots(curve.degree, curve.knots, more, name)
    points = combined(refinement_matrix(curve.degree, curve.knots, refined), curve.homogeneous)
    return _with_points(curve, curve.degree, refined, points)


def restrict_curve(curve: BSplineCurve, start: float, end: float) -> BSplineCurve:
    """Return the piece of the curve over [start, end].

    An end within 1e-12 of the domain of a knot means that knot: the piece takes no sliver of the neighbouring span.
    """
    matrix, knots = piece_matrix(curve.degree, curve.knots, start, end)
    return _with_points(curve, curve.degree, knots, combined(matrix, curve.homogeneous))


def _with_points(curve: BSplineCurve, degree: int, knots: FloatArray, homogeneous: FloatArray) -> BSplineCurve:
    points, weights = euclidean(homogeneous)
    return replace(curve, degree=degree, knots=knots, control_points=points, weights=weights)


def split_curve(curve: BSplineCurve, v: float) -> tuple[BSplineCurve, BSplineCurve]:
    """Return the two pieces below and above v, each over its own part of the domain."""
    require(curve, "curve", BSplineCurve)
    at = snapped(real_number(v, "v", KnotError), curve.knots)
    return restrict_curve(curve, float(curve.knots[0]), at), restrict_curve(curve, at, float(curve.knots[-1]))


def combined_curves(curves: Sequence[BSplineCurve], matrix: SparseMatrix) -> tuple[BSplineCurve, ...]:
    """Return one curve for each row of a sparse matrix: the linear combination of the (homogeneous) curves.

    Each result has the knots of the curves that take part in it, and no others; those of different curves within 1e-12
    of the domain are one.
    """
    result = []
    for i in range(matrix.shape[0]):
        part = slice(matrix.indptr[i], matrix.indptr[i + 1])
        used = [curves[j] for j in matrix.indices[part]]
        factors = np.asarray(matrix.data[part])
        if not used:
            first = curves[0].knots
            result.append(BSplineCurve(1, np.repeat(first[[0, -1]], 2), np.zeros((2, 3))))
        elif len(used) == 1:
            points = euclidean(used[0].homogeneous * factors[0])
            result.append(used[0] if factors[0] == 1.0 else BSplineCurve(used[0].degree, used[0].knots, *points))
        else:
            same = compatible_curves(used)
            points = euclidean(np.einsum("i,ijd->jd", factors, same.homogeneous))
            result.append(BSplineCurve(same.degree, same.knots, *points))
    return tuple(result)


def set_curve_continuity(curve: BSplineCurve, v: float, continuity: int, tolerance: float = 1e-12) -> BSplineCurve:
    """Return the curve with a knot at v of multiplicity degree - continuity.

    More continuity takes knots away, which only a curve that already has it allows; less inserts knots, which is exact
    and leaves the shape as it is, free to be bent at v.

    Parameters
    ----------
    curve : BSplineCurve
    v : float
        Inside the domain.
    continuity : int
        The number of continuous derivatives that the form of the curve guarantees at v, from 0 to the degree; the
        degree itself means no knot at v.
    tolerance : float
        The farthest that a control point may move for it, or a point of a rational curve by a proven bound, as a
        fraction of the largest extent of the control points; rounding of their coordinates is allowed on top.

    Raises
    ------
    OptionError
        A continuity outside 0 .. degree, or a tolerance that is negative or not finite.
    KnotError
        v not inside the domain, or the curve is not as smooth as asked.

    Source: the blossom formulation of knot removal; T. Lyche and K. Mørken, Knot removal for parametric B-spline
    curves and surfaces, 1987.

    Examples
    --------
    >>> line = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    >>> creased = set_curve_continuity(line, 0.5, 0)
    >>> creased.knots
    array([0. , 0. , 0. , 0.5, 0.5, 1. , 1. , 1. ])
    >>> set_curve_continuity(creased, 0.5, 2).knots
    array([0., 0., 0., 1., 1., 1.])
    """
    require(curve, "curve", BSplineCurve)
    if not is_whole(continuity) or not 0 <= continuity <= curve.degree:
        raise OptionError(
            f"continuity: found {continuity!r}, expected a whole number from 0 to the degree {curve.degree}"
        )
    if not 0 <= real_number(tolerance, "tolerance", OptionError) < np.inf:
        raise OptionError(f"tolerance: found {tolerance}, expected a finite number of at least 0")
    at = snapped(real_number(v, "v", KnotError), curve.knots)
    if not curve.knots[0] < at < curve.knots[-1]:
        raise KnotError(f"v: found {v}, expected a value inside ({curve.knots[0]}, {curve.knots[-1]})")
    present = int(np.count_nonzero(curve.knots == at))
    wanted = curve.degree - continuity
    if wanted >= present:
        return insert_curve_knots(curve, np.full(wanted - present, at)) if wanted > present else curve
    first = int(np.searchsorted(curve.knots, at))
    knots = np.delete(curve.knots, slice(first, first + present - wanted))
    points, moved = _coarser_points(curve, knots)
    extent = float(np.ptp(curve.control_points, axis=0).max())
    spread = 1.0 if curve.weights is None else float(curve.weights.max() / curve.weights.min())
    limit = tolerance * extent + 16 * np.finfo(float).eps * float(np.abs(curve.control_points).max()) * spread
    if not moved <= limit:
        what = "its control points" if curve.weights is None else "its points"
        raise KnotError(
            f"continuity: the curve cannot be C{continuity} at v = {at}: {what} would move by "
            f"{moved:.3g}, at most {limit:.3g} is allowed"
        )
    return _with_points(curve, curve.degree, knots, points)


def _coarser_points(curve: BSplineCurve, knots: FloatArray) -> tuple[FloatArray, float]:
    """Return homogeneous points over fewer knots, and how far the curve is from the old one.

    The distance is infinite where a weight would not be positive.
    """
    refining = refinement_matrix(curve.degree, knots, curve.knots)
    points = coarser_points(refining, curve.homogeneous)
    if not (points[:, 3:] > 0).all():
        return points, np.inf
    return points, deviation_bound([curve.degree], refining @ points, curve.homogeneous)
