"""Operations on single v-control curves of a semi-structured surface: knots, smoothness, nearly equal knots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from semispline.solver.arrays import require
from semispline.solver.errors import InputError, KnotError, OptionError
from semispline.solver.scalars import is_whole, real_number, whole_number
from semispline.solver.splines.compatible import merged_curves
from semispline.solver.splines.curves import insert_curve_knots, set_curve_continuity
from semispline.solver.splines.evaluation import euclidean
from semispline.solver.splines.knots import MERGE_TOLERANCE
from semispline.solver.splines.surfaces import BSplineCurve, SemiStructuredSurface, named_row


def insert_row_knot(surface: SemiStructuredSurface, i: int, v: float, times: int = 1) -> SemiStructuredSurface:
    """Return the same surface with a knot inserted in v-control curve i alone.

    Examples
    --------
    >>> row = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
    >>> surface = insert_row_knot(SemiStructuredSurface(1, [0, 0, 1, 1], (row, row)), 1, 0.5)
    >>> [len(curve.control_points) for curve in surface.control_curves]
    [2, 3]
    """
    at = [real_number(v, "v", KnotError)] * whole_number(times, "times", 0, OptionError)
    return _with_row(surface, i, lambda curve: insert_curve_knots(curve, at))


def set_row_continuity(
    surface: SemiStructuredSurface, i: int, v: float, continuity: int, tolerance: float = 1e-12
) -> SemiStructuredSurface:
    """Return the surface with v-control curve i in a form that is C^continuity at v, and no more.

    Less continuity inserts knots, which is exact; more takes knots away, and is refused unless the curve is that smooth
    already, within `tolerance` of its extent (see `set_curve_continuity`).
    """
    return _with_row(surface, i, lambda curve: set_curve_continuity(curve, v, continuity, tolerance))


def _with_row(
    surface: SemiStructuredSurface, i: int, change: Callable[[BSplineCurve], BSplineCurve]
) -> SemiStructuredSurface:
    require(surface, "surface", SemiStructuredSurface)
    n = len(surface.control_curves)
    if not is_whole(i) or not 0 <= i < n:
        raise InputError(f"i: found {i!r}, expected the index of a v-control curve, 0 to {n - 1}")
    curves = list(surface.control_curves)
    with named_row(i):
        curves[i] = change(curves[i])
    return replace(surface, control_curves=tuple(curves))


@dataclass(frozen=True, eq=False)
class MergedKnots:
    """A semi-structured surface whose nearly equal knots were made equal, and what that changed.

    Attributes
    ----------
    surface : SemiStructuredSurface
    knot_shift : float
        The farthest that a knot moved, in units of v.
    change : float
        The farthest that a point of any v-control curve moved, in model units: a proven bound, not a sample.
    """

    surface: SemiStructuredSurface
    knot_shift: float
    change: float


def merge_knots(surface: SemiStructuredSurface, tolerance: float = MERGE_TOLERANCE) -> MergedKnots:
    """Make knots of different v-control curves equal that differ by less than a fraction of the v-domain.

    Two inner knots of one curve never become one. An inner knot becomes an end of the domain where it is that close to
    it, and within 1e-12.

    Raises
    ------
    OptionError
        A tolerance outside [0, 1).

    Examples
    --------
    >>> rows = [BSplineCurve(1, [0, 0, v, 1, 1], [[0, 0, 0], [0, 1, 0], [0, 2, 0]]) for v in (0.5, 0.501)]
    >>> merged = merge_knots(SemiStructuredSurface(1, [0, 0, 1, 1], rows), 0.01)
    >>> merged.surface.to_bspline().knots_v, 0 < merged.change < 0.01
    (array([0. , 0. , 0.5, 1. , 1. ]), True)
    """
    require(surface, "surface", SemiStructuredSurface)
    merged = merged_curves(surface.control_curves, tolerance)
    rows = (BSplineCurve(row.degree, row.knots, *euclidean(row.homogeneous)) for row in merged.curves)
    return MergedKnots(replace(surface, control_curves=tuple(rows)), merged.knot_shift, merged.change)
