"""Curves brought to one degree and one knot vector, and what that costs: the way from semi-structured to classical."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray, SparseMatrix, require
from semispline.solver.errors import OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.curves import restrict_curve
from semispline.solver.splines.knots import MERGE_TOLERANCE, clamped, inner_knots
from semispline.solver.splines.refinement import elevated_knots, elevation_matrix, refinement_matrix
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface


@dataclass(frozen=True, eq=False)
class CompatibleCurves:
    """Curves over one knot vector.

    Attributes
    ----------
    degree : int
    knots : ndarray, shape (n + degree + 1,)
    control_points : ndarray, shape (number of curves, n, 3)
    knot_shift : float
        The farthest that merging moved a knot, in units of v.
    change : float
        The farthest that merging moved a point of any curve, in model units: a proven bound, not a sample.
    """

    degree: int
    knots: FloatArray
    control_points: FloatArray
    knot_shift: float
    change: float


@dataclass(frozen=True, eq=False)
class Conversion:
    """A semi-structured surface as a classical one, and what the conversion cost.

    Attributes
    ----------
    surface : BSplineSurface
    control_points_before, control_points_after : int
        Counts; their difference is what exact knot insertion and degree elevation add.
    knot_shift, change : float
        What merging knots moved, as in `CompatibleCurves`; both zero where no two knots were merged.
    """

    surface: BSplineSurface
    control_points_before: int
    control_points_after: int
    knot_shift: float
    change: float

    @property
    def control_points_added(self) -> int:
        """How many control points the conversion adds."""
        return self.control_points_after - self.control_points_before


def convert_to_bspline(surface: SemiStructuredSurface, tolerance: float = MERGE_TOLERANCE) -> Conversion:
    """Return the same surface with one v-knot vector for all rows, by exact degree elevation and knot insertion.

    Parameters
    ----------
    surface : SemiStructuredSurface
    tolerance : float
        Knots of different curves closer than this fraction of the v-domain become one; two inner knots of one curve
        never do. An inner knot becomes an end of the domain where it is that close to it, and within 1e-12. 0 merges
        only equal knots, and then the conversion changes nothing.

    Examples
    --------
    >>> low = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
    >>> high = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 1], [1, 1, 0]])
    >>> conversion = convert_to_bspline(SemiStructuredSurface(1, [0, 0, 1, 1], (low, high)))
    >>> conversion.surface.knots_v, conversion.control_points_added, conversion.change
    (array([0. , 0. , 0.5, 1. , 1. ]), 1, 0.0)
    """
    require(surface, "surface", SemiStructuredSurface)
    same = compatible_curves(surface.control_curves, tolerance)
    result = BSplineSurface(surface.degree_u, same.degree, surface.knots_u, same.knots, same.control_points)
    return Conversion(result, surface.n_control_points, result.n_control_points, same.knot_shift, same.change)


def compatible_curves(curves: Sequence[BSplineCurve], tolerance: float = MERGE_TOLERANCE) -> CompatibleCurves:
    """Bring curves over one domain to the highest degree and the union of their knots.

    Raises
    ------
    OptionError
        A tolerance outside [0, 1).
    """
    if not 0 <= real_number(tolerance, "tolerance", OptionError) < 1:
        raise OptionError(f"tolerance: found {tolerance}, expected a fraction of the domain in [0, 1)")
    degree = max(curve.degree for curve in curves)
    whole = [_without_slivers(curve, min(tolerance, MERGE_TOLERANCE)) for curve in curves]
    merged = _merged_knots(whole, tolerance)
    raised = [elevated_knots(v, degree - c.degree) for c, v in zip(curves, merged, strict=True)]
    counts: dict[float, int] = {}
    for vector in raised:
        values, count = np.unique(inner_knots(vector, degree), return_counts=True)
        for value, times in zip(values.tolist(), count.tolist(), strict=True):
            counts[value] = max(times, counts.get(value, 0))
    order = sorted(counts)
    start, end = float(curves[0].knots[0]), float(curves[0].knots[-1])
    knots = clamped(np.repeat(np.array(order), [counts[x] for x in order]), degree, start, end)
    rows, shift, change = [], 0.0, 0.0
    for curve, near, vector, high in zip(curves, whole, merged, raised, strict=True):
        if len(vector) != len(curve.knots) or (vector != curve.knots).any():
            shift = max(shift, _end_shift(curve, near), float(np.abs(vector - near.knots).max()))
            change = max(change, _change(curve, replace(near, knots=vector)))
        points = elevation_matrix(curve.degree, vector, degree) @ near.control_points
        rows.append(refinement_matrix(degree, high, knots) @ points if len(high) != len(knots) else points)
    return CompatibleCurves(degree, knots, np.stack(rows), shift, change)


def _merged_knots(curves: Sequence[BSplineCurve], tolerance: float) -> list[FloatArray]:
    """Return each curve's knots with those of different curves that nearly agree replaced by the first of them."""
    width = tolerance * float(curves[0].knots[-1] - curves[0].knots[0])
    inner = [np.unique(inner_knots(curve.knots, curve.degree)) for curve in curves]
    values = np.unique(np.concatenate(inner))
    if len(values) < 2 or np.diff(values).min() > width:
        return [curve.knots for curve in curves]
    owners: dict[float, set[int]] = {}
    for i, own in enumerate(inner):
        for value in own.tolist():
            owners.setdefault(value, set()).add(i)
    meaning: dict[float, float] = {}
    first, members = -np.inf, set[int]()
    for value in values.tolist():
        # Two knots of one curve never become one: that would change its smoothness, not its rounding.
        if value - first > width or members & owners[value]:
            first, members = value, set()
        meaning[value] = first
        members |= owners[value]
    return [np.array([meaning.get(x, x) for x in curve.knots.tolist()]) for curve in curves]


def _without_slivers(curve: BSplineCurve, tolerance: float) -> BSplineCurve:
    """Return the curve without the knots that close to an end: the end is where the last of them was."""
    start, end = float(curve.knots[0]), float(curve.knots[-1])
    inner = inner_knots(curve.knots, curve.degree)
    width = tolerance * (end - start)
    if not len(inner) or (inner[0] - start > width and end - inner[-1] > width):
        return curve
    return restrict_curve(curve, start, end)


def _end_shift(curve: BSplineCurve, whole: BSplineCurve) -> float:
    """Return how far the knots of `curve` that `whole` lacks are from the nearer end."""
    gone = np.setdiff1d(curve.knots, whole.knots)
    return float(np.minimum(gone - curve.knots[0], curve.knots[-1] - gone).max(initial=0.0))


def _change(curve: BSplineCurve, other: BSplineCurve) -> float:
    """Bound the distance between two curves of one degree.

    Both are refined to all knots of both; the difference lies in the convex hull of the differences of their control
    points.
    """
    counts: dict[float, int] = {}
    for vector in (curve.knots, other.knots):
        values, count = np.unique(vector, return_counts=True)
        for value, times in zip(values.tolist(), count.tolist(), strict=True):
            counts[value] = max(times, counts.get(value, 0))
    both = np.repeat(np.array(sorted(counts)), [counts[x] for x in sorted(counts)])
    one, two = (refinement_matrix(c.degree, c.knots, both) @ c.control_points for c in (curve, other))
    return float(np.linalg.norm(one - two, axis=1).max())


def combined_curves(curves: Sequence[BSplineCurve], matrix: SparseMatrix) -> tuple[BSplineCurve, ...]:
    """Return one curve for each row of a sparse matrix: the linear combination of the curves with its weights.

    Each result has the knots of the curves that take part in it, and no others; those of different curves within 1e-12
    of the domain are one.
    """
    result = []
    for i in range(matrix.shape[0]):
        part = slice(matrix.indptr[i], matrix.indptr[i + 1])
        used = [curves[j] for j in matrix.indices[part]]
        weights = np.asarray(matrix.data[part])
        if not used:
            first = curves[0].knots
            result.append(BSplineCurve(1, np.repeat(first[[0, -1]], 2), np.zeros((2, 3))))
        elif len(used) == 1:
            points = used[0].control_points * weights[0]
            result.append(used[0] if weights[0] == 1.0 else BSplineCurve(used[0].degree, used[0].knots, points))
        else:
            same = compatible_curves(used)
            points = np.einsum("i,ijd->jd", weights, same.control_points)
            result.append(BSplineCurve(same.degree, same.knots, points))
    return tuple(result)
