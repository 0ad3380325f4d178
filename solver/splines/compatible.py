"""Curves over one domain brought to one degree and one knot vector: plain arrays, below the classes.

Points are homogeneous, (w x, w y, w z, w), where a curve is rational. Where one of several curves is, all are made so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.deviation import deviation_bound
from semispline.solver.splines.evaluation import same_width
from semispline.solver.splines.knots import MERGE_TOLERANCE, clamped, inner_knots
from semispline.solver.splines.refinement import (
    combined,
    elevated_knots,
    elevation_matrix,
    piece_matrix,
    refinement_matrix,
)


class Curve(Protocol):
    """What is needed of a curve: its degree, knots and homogeneous control points."""

    @property
    def degree(self) -> int:
        """Degree."""

    @property
    def knots(self) -> FloatArray:
        """Clamped knots."""

    @property
    def homogeneous(self) -> FloatArray:
        """Control points, shape (n, 3), or (n, 4) where rational."""


@dataclass(frozen=True, eq=False)
class PlainCurve:
    """A curve as its arrays."""

    degree: int
    knots: FloatArray
    homogeneous: FloatArray


@dataclass(frozen=True, eq=False)
class MergedCurves:
    """Curves whose nearly equal knots were made equal.

    Attributes
    ----------
    curves : tuple of PlainCurve
    knot_shift : float
        The farthest that merging moved a knot, in units of v.
    change : float
        The farthest that merging moved a point of any curve, in model units: a proven bound, not a sample.
    """

    curves: tuple[PlainCurve, ...]
    knot_shift: float
    change: float


@dataclass(frozen=True, eq=False)
class CompatibleCurves:
    """Curves over one knot vector.

    Attributes
    ----------
    degree : int
    knots : ndarray, shape (n + degree + 1,)
    homogeneous : ndarray, shape (number of curves, n, 3), or (number of curves, n, 4) where any is rational
    """

    degree: int
    knots: FloatArray
    homogeneous: FloatArray


def compatible_curves(curves: Sequence[Curve], tolerance: float = MERGE_TOLERANCE) -> CompatibleCurves:
    """Bring curves over one domain to the highest degree and the union of their knots, nearly equal ones merged.

    Raises
    ------
    OptionError
        As `merged_curves`.
    """
    merged = merged_curves(curves, tolerance).curves
    degree = max(curve.degree for curve in merged)
    raised = [elevated_knots(curve.knots, degree - curve.degree) for curve in merged]
    counts: dict[float, int] = {}
    for vector in raised:
        values, count = np.unique(inner_knots(vector, degree), return_counts=True)
        for value, times in zip(values.tolist(), count.tolist(), strict=True):
            counts[value] = max(times, counts.get(value, 0))
    order = sorted(counts)
    start, end = float(curves[0].knots[0]), float(curves[0].knots[-1])
    knots = clamped(np.repeat(np.array(order), [counts[x] for x in order]), degree, start, end)
    rows = []
    for curve, high, points in zip(merged, raised, same_width(*(c.homogeneous for c in merged)), strict=True):
        matrix = elevation_matrix(curve.degree, curve.knots, degree)
        if len(high) != len(knots):
            matrix = refinement_matrix(degree, high, knots) @ matrix
        rows.append(combined(matrix, points))
    return CompatibleCurves(degree, knots, np.stack(rows))


def merged_curves(curves: Sequence[Curve], tolerance: float = MERGE_TOLERANCE) -> MergedCurves:
    """Make nearly equal knots of different curves equal.

    Knots of different curves closer than `tolerance` times the domain become one; two inner knots of one curve never
    do. An inner knot becomes an end of the domain where it is that close to it, and within 1e-12. 0 merges nothing.

    Raises
    ------
    OptionError
        A tolerance outside [0, 1).
    """
    if not 0 <= real_number(tolerance, "tolerance", OptionError) < 1:
        raise OptionError(f"tolerance: found {tolerance}, expected a fraction of the domain in [0, 1)")
    whole = [_without_slivers(curve, min(tolerance, MERGE_TOLERANCE)) for curve in curves]
    merged = _merged_knots(whole, tolerance)
    result, shift, change = [], 0.0, 0.0
    for curve, near, vector in zip(curves, whole, merged, strict=True):
        moved = replace(near, knots=vector)
        if len(vector) != len(curve.knots) or (vector != curve.knots).any():
            shift = max(shift, _end_shift(curve, near), float(np.abs(vector - near.knots).max()))
            change = max(change, _change(curve, moved))
        result.append(moved)
    return MergedCurves(tuple(result), shift, change)


def _merged_knots(curves: Sequence[Curve], tolerance: float) -> list[FloatArray]:
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


def _without_slivers(curve: Curve, tolerance: float) -> PlainCurve:
    """Return the curve without the knots that close to an end: the end is where the last of them was."""
    start, end = float(curve.knots[0]), float(curve.knots[-1])
    inner = inner_knots(curve.knots, curve.degree)
    width = tolerance * (end - start)
    if not len(inner) or (inner[0] - start > width and end - inner[-1] > width):
        return PlainCurve(curve.degree, curve.knots, curve.homogeneous)
    matrix, knots = piece_matrix(curve.degree, curve.knots, start, end)
    return PlainCurve(curve.degree, knots, combined(matrix, curve.homogeneous))


def _end_shift(curve: Curve, whole: Curve) -> float:
    """Return how far the knots of `curve` that `whole` lacks are from the nearer end."""
    gone = np.setdiff1d(curve.knots, whole.knots)
    return float(np.minimum(gone - curve.knots[0], curve.knots[-1] - gone).max(initial=0.0))


def _change(curve: Curve, other: Curve) -> float:
    """Bound the distance between two curves of one degree: both are refined to all knots of both."""
    counts: dict[float, int] = {}
    for vector in (curve.knots, other.knots):
        values, count = np.unique(vector, return_counts=True)
        for value, times in zip(values.tolist(), count.tolist(), strict=True):
            counts[value] = max(times, counts.get(value, 0))
    both = np.repeat(np.array(sorted(counts)), [counts[x] for x in sorted(counts)])
    one, two = (refinement_matrix(c.degree, c.knots, both) @ c.homogeneous for c in (curve, other))
    return deviation_bound([curve.degree], two, one)
