"""What lies in the region that paths from an edge sweep over: how far they can go before they meet it.

Few paths tell where to look: by where they cross a line, and by its points in the quads between neighbours, so that
nothing slips between two of them. More paths near there tell how far it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.parallels import Paths, crossings, turns_over

# Paths of a closer look, and by how much they go on beyond what was found before: steps that end there are exact there.
_CLOSELY, _BEYOND = 33, (0.05, 0.02, 2e-3, 1e-4, 1e-5)
# What was seen from afar may be as much nearer as this, of itself; so many places are looked at more closely.
_NEARLY, _MOST = 0.1, 24
# Points of a line beside the nearest one through which a curve goes, and points of that; sines: more is a corner.
_BESIDE, _FINER, _DEGREE, _CORNER = 3, 97, 5, 0.3
# Of a distance: what goes up by less is level.
_LEVEL = 1e-6
# Of a distance: what is as near to the edges that end the paths lies on them.
_ON_END = 1e-6
# Of the larger extent of a line in the parameters: no extent.
_STRAIGHT = 1e-9


@dataclass(frozen=True, eq=False)
class _Seen:
    """Where a line is met: how far from an edge, from which place of it, and where in the parameters.

    The number is 2 k on path k, and 2 k + 1 between it and the next one.
    """

    number: int
    distance: float
    place: float
    at: FloatArray


def distance_to(
    paths: Paths,
    x: FloatArray,
    paths_at: Callable[[FloatArray, float], Paths],
    lines: Sequence[FloatArray],
    ends: Sequence[FloatArray],
    periods: FloatArray,
) -> float:
    """Return the least distance at which lines are met, by paths or between them; infinite where none is.

    Parameters
    ----------
    paths : Paths
    x : ndarray, shape (K,)
        Places of the edge at which they start, rising.
    paths_at : callable
        Returns paths from other places to a distance.
    lines, ends : sequence of ndarray, shape (S, 2)
        In the parameters: what may be met, and what ends the paths before.
    periods : ndarray, shape (2,)
        After which the lines come again on a closed surface; 0 where they do not.
    """
    first = _first(paths, ends, periods)
    range_, width, nearest = (float(x[0]), float(x[-1])), 2 * float(np.diff(x).max()), np.inf
    seen = [_seen(paths, x, line, first, periods) for line in lines]
    known: dict[_Seen, float] = {}
    for _ in range(_MOST):
        lows = [(each, line) for line, of in zip(lines, seen, strict=True) for each in _lows(of, len(x))]
        new = [(each, line) for each, line in lows if each not in known]
        each, line = min(new, key=lambda pair: pair[0].distance, default=(None, None))
        if each is None or line is None or each.distance * (1 - _NEARLY) > nearest:
            break
        known[each] = _closely(each, line, range_, width, paths_at, ends, periods)
        nearest = min(nearest, known[each])
        # What was nothing hides no other.
        seen = [[one for one in of if known.get(one) != np.inf] for of in seen]
    else:
        # Too many for a closer look: as far as they seem to be.
        nearest = min(nearest, *(each.distance for each, _ in new))
    return nearest


def _lows(seen: list[_Seen], count: int) -> list[_Seen]:
    """Return the lowest of what was seen of a line on each stretch: those between which it goes up, or is not met."""
    profile = np.full(2 * count - 1, np.inf)
    # Between two paths there need be no point of the line.
    profile[1::2] = -np.inf
    for each in seen:
        profile[each.number] = each.distance if each.number % 2 == 0 else max(profile[each.number], each.distance)
    found: list[_Seen] = []
    for each in sorted(seen, key=lambda each: each.distance):
        between = (profile[min(each.number, x.number) : max(each.number, x.number) + 1].max() for x in found)
        if not any(highest <= each.distance * (1 + _LEVEL) for highest in between):
            found.append(each)
    return found


def _first(paths: Paths, ends: Sequence[FloatArray], periods: FloatArray) -> FloatArray:
    """Return where each path comes to an end."""
    return np.asarray(crossings(paths, list(ends), periods).min(axis=0, initial=np.inf))


def _closely(
    seen: _Seen,
    line: FloatArray,
    range_: tuple[float, float],
    width: float,
    paths_at: Callable[[FloatArray, float], Paths],
    ends: Sequence[FloatArray],
    periods: FloatArray,
) -> float:
    """Return the distance of what was seen, by ever closer paths; infinite where nothing is there."""
    part, found = finer(line, seen.at, periods), np.inf
    for beyond in _BEYOND:
        x = np.linspace(max(seen.place - width, range_[0]), min(seen.place + width, range_[1]), _CLOSELY)
        paths = paths_at(x, seen.distance * (1 + beyond))
        first = _first(paths, ends, periods)
        # The whole line, where the part was the wrong one.
        again = _seen(paths, x, part, first, periods) or _seen(paths, x, line, first, periods)
        if not again:
            break
        seen = min(again, key=lambda each: each.distance)
        found, width = seen.distance, 2 * float(x[1] - x[0])
    return found


def finer(line: FloatArray, at: FloatArray, periods: FloatArray) -> FloatArray:
    """Return the part of a line beside a point of it, as a curve through its points where they are no corners."""
    away = line - at
    away -= np.where(periods > 0, np.round(away / np.where(periods > 0, periods, 1.0)) * periods, 0.0)
    closed, extent = bool((line[0] == line[-1]).all()), np.ptp(line, axis=0)
    # Along a line of constant parameter the other one says nothing.
    size = np.where(extent > _STRAIGHT * extent.max(), extent, np.inf)
    count, nearest = len(line) - closed, int(np.sum((away / size) ** 2, axis=1).argmin())
    rows = nearest + np.arange(-_BESIDE, _BESIDE + 1)
    rows = rows % count if closed and count > len(rows) else np.unique(np.clip(rows, 0, len(line) - 1))
    points = line[rows]
    steps = np.diff(points, axis=0) / size
    lengths = np.linalg.norm(steps, axis=1)
    turned = np.abs(steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0])
    smooth = (np.sum(steps[:-1] * steps[1:], axis=1) > 0) & (turned <= _CORNER * lengths[:-1] * lengths[1:])
    if len(points) <= _DEGREE or not smooth.all():
        return points
    along = np.append(0.0, np.cumsum(lengths))
    return np.asarray(make_interp_spline(along, points, _DEGREE)(np.linspace(0.0, along[-1], _FINER)))


def _seen(paths: Paths, x: FloatArray, line: FloatArray, first: FloatArray, periods: FloatArray) -> list[_Seen]:
    """Return where paths cross a line before they end, and the nearest points of it between each two of them."""
    crossed = crossings(paths, [line], periods)[0]
    found = []
    for k in np.flatnonzero(crossed < first * (1 - _ON_END)).tolist():
        share = crossed[k] / paths.step
        step = min(int(share), len(paths.at) - 2)
        at = paths.at[step, k] + (share - step) * (paths.at[step + 1, k] - paths.at[step, k])
        found.append(_Seen(2 * k, float(crossed[k]), float(x[k]), at))
    known = paths.at[np.isfinite(paths.at).all(axis=2)]
    for turn in turns_over(line, periods, known.min(axis=0), known.max(axis=0)):
        for k in range(len(x) - 1):
            share, steps, rows = _between(paths.at[:, k], paths.at[:, k + 1], line + turn)
            inside = steps * paths.step < max(first[k], first[k + 1]) * (1 - _ON_END)
            if inside.any():
                i = int(np.where(inside, steps, np.inf).argmin())
                place = float(x[k] + share[i] * (x[k + 1] - x[k]))
                found.append(_Seen(2 * k + 1, float(steps[i]) * paths.step, place, line[rows[i]] + turn))
    return found


def _between(
    one: FloatArray, other: FloatArray, points: FloatArray
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return where points lie between two paths: the share of the second, the number of steps, and which points.

    Each quad is two triangles.
    """
    corners = np.concatenate([one, other])
    corners = corners[np.isfinite(corners).all(axis=1)]
    if not len(corners):
        return np.empty(0), np.empty(0), np.empty(0, dtype=np.int64)
    near = np.flatnonzero(((points >= corners.min(axis=0)) & (points <= corners.max(axis=0))).all(axis=1))
    p = points[near][:, None]
    shares, steps, rows = [], [], []
    # The corner from which a triangle is seen, and the neighbours of it along the step and across.
    for corner, ahead, across, back in ((one[:-1], one[1:], other[:-1], False), (other[1:], other[:-1], one[1:], True)):
        a, b = ahead - corner, across - corner
        with np.errstate(all="ignore"):
            area = _cross(a, b)
            t, s = _cross(p - corner, b) / area, _cross(a, p - corner) / area
        inside = (t >= 0) & (s >= 0) & (t + s <= 1)
        row, step = np.nonzero(inside)
        t, s = t[row, step], s[row, step]
        shares.append(1 - s if back else s)
        steps.append(step + (1 - t if back else t))
        rows.append(near[row])
    return np.concatenate(shares), np.concatenate(steps), np.concatenate(rows)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
