"""Samples of two edges that belong together, and where between samples values are largest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.base import Base
from semispline.solver.judge.correspondence import (
    Correspondence,
    b_breaks_along_a,
    corresponding,
    is_closed,
    merged_spans,
    samples_in_spans,
)
from semispline.solver.judge.de_boor import EdgeCurves
from semispline.solver.judge.foot_points import Run, foot_map
from semispline.solver.judge.sections import just_inside
from semispline.solver.splines import merge_breakpoints

# The largest value is sought beside so many samples, on so many parts of what lies around them, so often.
_BESIDE, _PARTS, _ZOOMS = 3, 32, 2

# Parameters along a and along b: how fast the latter runs.
Pace: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class Pairs:
    """Parameters along two edges that belong together, in every span of both.

    Attributes
    ----------
    s_a, s_b : ndarray, shape (K,)
        In order along edge a.
    breaks : ndarray
        Where spans of a or of b end, along a.
    along_b : callable
        Returns the parameters along b that belong to some along a.
    pace : callable or None
        How fast those along b run; None where they correspond affinely.
    corresponds : {"affine", "foot points"}
    """

    s_a: FloatArray
    s_b: FloatArray
    breaks: FloatArray
    along_b: Callable[[FloatArray], FloatArray]
    pace: Pace | None
    corresponds: Literal["affine", "foot points"]


def affine_pairs(a: Base, b: Base, matched: Correspondence) -> Pairs:
    """Return parameters that correspond affinely, in every span of both and at the ends.

    Where one edge is closed and starts inside the other the ends are left out: the other may have a crease there.
    """
    breaks = merged_spans(a, b, matched)
    s_a = samples_in_spans(breaks, ends=not matched.shift)

    def along_b(s: FloatArray) -> FloatArray:
        return corresponding(a, b, matched, s)

    return Pairs(s_a, along_b(s_a), breaks, along_b, None, "affine")


def foot_pairs(
    a: Base, b: Base, matched: Correspondence, curves: tuple[EdgeCurves, EdgeCurves], most: float
) -> Pairs | None:
    """Return parameters of points on a and of their feet on b; None where an edge leaves the other by more than `most`.

    The curves are those of the edges, counted from one origin; `matched` says how b runs, and about where.
    """
    (start, end), (b_start, b_end) = a.range_along, b.range_along
    pace = (b_end - b_start) / (end - start) * (-1.0 if matched.flipped else 1.0)

    def on_a(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        at = curves[0].points(s, 1)
        return at[0, 0], at[0, 1]

    def on_b(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        at = curves[1].points(corresponding(a, b, matched, s), 1)
        return at[0, 0], pace * at[0, 1]

    # Both in the parameter along a, so that feet are near equal parameters.
    runs = Run(on_a, a.breakpoints_along()), Run(on_b, merge_breakpoints(b_breaks_along_a(a, b, matched)))
    closed = is_closed(a) and is_closed(b)
    found = foot_map(*runs, most, closed=closed)
    if found is None:
        return None

    def along_b(s: FloatArray) -> FloatArray:
        return corresponding(a, b, matched, found.along_b(s))

    def pace_at(s_a: FloatArray, s_b: FloatArray) -> FloatArray:
        along, other = curves[0].points(s_a, 1)[0, 1], curves[1].points(s_b, 1)[0, 1]
        return np.asarray(np.sum(along * other, axis=1) / np.sum(other**2, axis=1))

    # Of closed edges only where both begin in one place, as affinely.
    meets = bool(np.isin(found.along_b(np.array([start, end])), [start, end]).all())
    s_a = samples_in_spans(found.breaks, ends=meets)
    return Pairs(s_a, along_b(s_a), found.breaks, along_b, pace_at, "foot points")


def places_between(
    values: Callable[[FloatArray], FloatArray], s: FloatArray, sampled: FloatArray, breaks: FloatArray
) -> FloatArray:
    """Return where between samples values may be larger: beside the three largest local maxima of each kind.

    Parameters
    ----------
    values : callable
        Returns values of each kind at parameters, shape (kinds, K).
    s : ndarray, shape (K,)
        Where they were sampled: sorted.
    sampled : ndarray, shape (kinds, K)
    breaks : ndarray
        Where spans end: what lies around a sample ends there, too.
    """
    span = np.clip(np.searchsorted(breaks, s, side="right") - 1, 0, len(breaks) - 2)
    after, before = just_inside(breaks)
    after[0], before[-1] = min(after[0], s[0]), max(before[-1], s[-1])
    same = span[1:] == span[:-1]
    low = np.where(np.append(False, same), np.append(s[0], s[:-1]), after[span])
    high = np.where(np.append(same, False), np.append(s[1:], s[-1]), before[span])
    kinds, chosen = [], []
    for kind, row in enumerate(sampled):
        left = np.where(np.append(False, same), np.append(-np.inf, row[:-1]), -np.inf)
        right = np.where(np.append(same, False), np.append(row[1:], -np.inf), -np.inf)
        # None of a kind of which one value is not a number.
        maxima = np.flatnonzero((row >= left) & (row >= right) & np.isfinite(row).all())
        best = maxima[np.argsort(-row[maxima], kind="stable")][:_BESIDE].tolist()
        kinds += [kind] * len(best)
        chosen += best
    if not chosen:
        return np.zeros(0)
    rows = np.arange(len(chosen))
    left, right = low[chosen], high[chosen]
    for _ in range(_ZOOMS):
        x = left[:, None] + (right - left)[:, None] * np.linspace(0, 1, _PARTS + 1)
        y = values(x.ravel())[np.array(kinds)[:, None], np.arange(x.size).reshape(x.shape)]
        at = np.nan_to_num(y, nan=-np.inf).argmax(axis=1)
        left, right = x[rows, np.maximum(at - 1, 0)], x[rows, np.minimum(at + 1, _PARTS)]
    return np.unique(np.concatenate([x[rows, at], _vertices(x, y, at)]))


def _vertices(x: FloatArray, y: FloatArray, at: FloatArray) -> FloatArray:
    """Return where parabolas through the largest values and their neighbours are highest; those at ends are left."""
    inside = np.flatnonzero((at > 0) & (at < x.shape[1] - 1))
    i = at[inside]
    step = x[inside, i + 1] - x[inside, i]
    below, top, above = (y[inside, i + k] for k in (-1, 0, 1))
    bend = below - 2 * top + above
    move = np.divide((below - above) / 2, bend, out=np.zeros_like(bend), where=bend < 0)
    return np.asarray(x[inside, i] + np.clip(move, -1, 1) * step)
