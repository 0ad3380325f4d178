"""Where a contact that moves away from an edge meets itself: round a closed surface, or where a face has a neck."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.sparse.csgraph import connected_components

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.parallels import Paths, turns_over

# Steps past the last one that are told from it: between their places fronts that bulge meet a little earlier.
_BEYOND = 6
# Places where two stretches meet, looked at closely; neighbours at both sides belong to each; bisections of a step.
_CLOSELY, _BESIDE, _BISECTIONS = 96, 1, 30
_ROUNDS = 2
Pairs: TypeAlias = NDArray[np.int64]
# Stretches that are nearer along the curve cross where it turns too sharply: `focal_distance` tells of that.
_APART, _TOGETHER = 2 * _BESIDE + 2, 8


def meeting_distance(
    paths: Paths,
    x: FloatArray,
    paths_at: Callable[[FloatArray, float], Paths],
    periods: FloatArray,
    round_: int | None,
    kept: FloatArray,
) -> float:
    """Return the distance at which the curve through the ends of paths first meets itself; infinite where it does not.

    Parameters
    ----------
    paths : Paths
    x : ndarray, shape (K,)
        Places of the edge at which they start, rising.
    paths_at : callable
        Returns paths from other places to a distance.
    periods : ndarray, shape (2,)
        Of the parameters, where the surface goes on over its seam; else 0.
    round_ : int or None
        After how many places a closed curve comes again.
    kept : ndarray, shape (K,)
        Where each path ends at an edge of the face: what goes on from there is no part of the curve.
    """
    steps, fronts = _with_beyond(paths)
    alive = kept > (steps * paths.step)[:, None]
    alive = alive[:, 1:] & alive[:, :-1]
    met = _first_meeting(fronts, periods, alive, round_)
    if met is None:
        return np.inf
    pairs, turn = met
    pairs = _in_one_place(pairs)
    distance, found = float(steps[-1]) * paths.step, np.inf
    near = np.concatenate([_near(x, rows) for rows in pairs.T])
    for _ in range(_ROUNDS):
        close = paths_at(near, distance)
        found = _crossed(close.at[:, :_CLOSELY], close.at[:, _CLOSELY:] + turn, close.step)
        if not np.isfinite(found):
            break
        # Once more, with steps that end there.
        distance = found * (1 + 2 / len(close.at))
    return found


def _with_beyond(paths: Paths) -> tuple[FloatArray, FloatArray]:
    """Return the numbers of steps, and the parameters after each, shape (N, K, 2), some of them guessed."""
    count = len(paths.at) - 1
    further = paths.at[-1] + np.arange(1, _BEYOND + 1)[:, None, None] * (paths.at[-1] - paths.at[-2])
    return np.arange(1.0, count + _BEYOND + 1), np.concatenate([paths.at[1:], further])


def _first_meeting(
    fronts: FloatArray, periods: FloatArray, alive: NDArray[np.bool_], round_: int | None
) -> tuple[Pairs, FloatArray] | None:
    """Return which stretches of a curve cross each other first as it moves, and how far the second is turned."""
    known = np.where(np.isfinite(fronts), fronts, 0.0)
    low, high = known.min(axis=(0, 1)), known.max(axis=(0, 1))
    apart = _apart(fronts.shape[1] - 1, round_)
    best: tuple[int, tuple[Pairs, FloatArray]] | None = None
    for turn in turns_over(np.stack([low, high]), periods, low, high):
        if tuple(turn) < (0.0, 0.0):
            # What crosses a turn before crosses a turn later.
            continue
        found = _cross_each_other(fronts, fronts + turn)
        found &= apart & alive[:, :, None] & alive[:, None, :]
        step = np.flatnonzero(found.any(axis=(1, 2)))
        if len(step) and (best is None or step[0] < best[0]):
            best = int(step[0]), (np.argwhere(found[step[0]]), turn)
    return None if best is None else best[1]


def _apart(count: int, round_: int | None) -> NDArray[np.bool_]:
    """Tell which stretches of a curve are no neighbours."""
    between = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    if round_ is not None:
        between = np.minimum(between % round_, -between % round_)
    found = np.asarray(between > _APART)
    if round_ is not None:
        # What comes again counts where it has neighbours at both sides.
        found[: count - round_] = found[:, : count - round_] = False
    return found


def _cross_each_other(one: FloatArray, other: FloatArray) -> NDArray[np.bool_]:
    """Tell which stretches of two polylines cross at each of N steps, shape (N, K - 1, K - 1)."""
    p, d = one[:, :-1, None], np.diff(one, axis=1)[:, :, None]
    q, e = other[:, None, :-1], np.diff(other, axis=1)[:, None]
    with np.errstate(all="ignore"):
        cross = _cross(d, e)
        s, t = _cross(q - p, e) / cross, _cross(q - p, d) / cross
    return np.asarray((s >= 0) & (s <= 1) & (t >= 0) & (t <= 1))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _in_one_place(pairs: Pairs) -> Pairs:
    """Return pairs that lie near each other, as many as there are together.

    Two fronts that have crossed do so twice, before and behind where they met.
    """
    apart = np.abs(pairs[:, None] - pairs).max(axis=2)
    _, label = connected_components(apart <= _TOGETHER)
    return np.asarray(pairs[label == np.bincount(label).argmax()])


def _near(x: FloatArray, stretches: NDArray[np.int64]) -> FloatArray:
    """Return places around stretches."""
    first, last = int(stretches.min()) - _BESIDE, int(stretches.max()) + 1 + _BESIDE
    return np.linspace(x[max(first, 0)], x[min(last, len(x) - 1)], _CLOSELY)


def _crossed(one: FloatArray, other: FloatArray, step: float) -> float:
    """Return the distance at which two fronts, known at equal steps, first cross each other."""
    steps = np.flatnonzero(_cross_each_other(one, other).any(axis=(1, 2)))
    steps = steps[steps > 0]
    if not len(steps):
        return np.inf
    numbers = np.arange(len(one))
    fronts = [CubicSpline(numbers, front) for front in (one, other)]
    low, high = float(steps[0] - 1), float(steps[0])
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        at = [front(middle)[None] for front in fronts]
        low, high = (low, middle) if _cross_each_other(*at).any() else (middle, high)
    return high * step
