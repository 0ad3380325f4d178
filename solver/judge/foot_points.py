"""Two curves that are one as sets, with different parameters: each point of one belongs to its foot on the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import merge_breakpoints

# Points of either curve between which a first match is sought; the least in each span, and the most in all.
_MATCHED, _LEAST, _MOST = 96, 4, 1024
# Steps towards a foot, each halved where it leads away.
_STEPS = 40
# Parameters closer than this part of the range are one: feet of knots are known to some roundings of the curve.
_ONE = 1e-9


@dataclass(frozen=True, eq=False)
class Run:
    """A curve over a range of a parameter that two curves share, about.

    Attributes
    ----------
    at : callable
        Returns points and tangents at parameters, each of shape (K, 3).
    breaks : ndarray
        Where its spans end; the first and the last are the ends of the range.
    """

    at: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    breaks: FloatArray

    @property
    def ends(self) -> tuple[float, float]:
        """The range."""
        return float(self.breaks[0]), float(self.breaks[-1])

    def wrapped(self, x: FloatArray) -> FloatArray:
        """Return parameters of a closed curve in its range."""
        start, end = self.ends
        inside = (x >= start) & (x <= end)
        return np.where(inside, x, start + np.mod(x - start, end - start))

    def feet(self, points: FloatArray, guess: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray]:
        """Return the parameters of the feet of points, near a guess, and how far away they are.

        Those of a closed curve may leave the range: they run on over the seam.
        """
        start, end = self.ends

        def at(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            return self.at(self.wrapped(x) if closed else x)

        x = guess if closed else np.clip(guess, start, end)
        here, slope = at(x)
        away = points - here
        distance = _lengths(away)
        share = np.ones(len(x))
        least = 2 * np.finfo(np.float64).eps * max(abs(start), abs(end), end - start)
        active = np.arange(len(x))
        for _ in range(_STEPS):
            speed = np.sum(slope[active] ** 2, axis=1)
            step = np.divide(
                np.sum(away[active] * slope[active], axis=1), speed, out=np.zeros(len(active)), where=speed > 0
            )
            trial = x[active] + share[active] * step
            trial = trial if closed else np.clip(trial, start, end)
            moves = np.abs(trial - x[active]) > least
            active, trial = active[moves], trial[moves]
            if not len(active):
                break
            there, steeper = at(trial)
            apart = points[active] - there
            found = _lengths(apart)
            # Past a knot the slope may change.
            closer = found < distance[active]
            better = active[closer]
            x[better], away[better], slope[better] = trial[closer], apart[closer], steeper[closer]
            distance[better] = found[closer]
            share[active] = np.where(closer, 1.0, share[active] / 2)
        return x, distance


@dataclass(frozen=True, eq=False)
class FootMap:
    """Which parameters along b belong to those along a; both curves run one way.

    Attributes
    ----------
    a, b : Run
    closed : bool
    nodes, values : ndarray
        Some parameters along a, and those along b; of closed curves these may leave the range.
    breaks : ndarray
        Where spans of a or of b end, along a.
    """

    a: Run
    b: Run
    closed: bool
    nodes: FloatArray
    values: FloatArray
    breaks: FloatArray

    def along_b(self, s: FloatArray) -> FloatArray:
        """Return the parameters along b of the feet of a's points."""
        guess = np.interp(s, self.nodes, self.values)
        x = self.b.feet(self.a.at(s)[0], guess, self.closed)[0]
        # Ends of one are ends of the other.
        start, end = self.b.ends
        for place in (start, end):
            x = np.where(np.abs(x - place) <= _ONE * (end - start), np.where(_is_end(s, self.a), place, x), x)
        return self.b.wrapped(x) if self.closed else x

    def pace(self, s: FloatArray, along_b: FloatArray) -> FloatArray:
        """Return how fast the foot on b moves as the point on a does."""
        along, other = self.a.at(s)[1], self.b.at(along_b)[1]
        return np.asarray(np.sum(along * other, axis=1) / np.sum(other**2, axis=1))


def foot_map(a: Run, b: Run, most: float, closed: bool) -> FootMap | None:
    """Return which points belong together by feet; None where either curve leaves the other by more than `most`.

    None also where the feet do not run along with the points.
    """
    nodes, values = _matched(a, b, closed)
    points, _ = a.at(nodes)
    values, distance = b.feet(points, values, closed)
    # Points may share a foot but for rounding, nothing more.
    slack = _ONE * (b.ends[1] - b.ends[0])
    if (
        distance.max() > most
        or np.diff(values).min() < -slack
        or values[-1] - values[0] > b.ends[1] - b.ends[0] + slack
    ):
        return None
    values = np.maximum.accumulate(values)
    halfway = (b.breaks[:-1] + b.breaks[1:]) / 2
    feet = []
    for x in (b.breaks, halfway):
        shifted = _beside(x, values, b) if closed else x
        foot, distance = a.feet(b.at(x)[0], np.interp(shifted, values, nodes), closed)
        if distance.max() > most:
            return None
        feet.append(a.wrapped(foot) if closed else foot)
    return FootMap(a, b, closed, nodes, values, _merged(a, feet[0]))


def _merged(a: Run, feet: FloatArray) -> FloatArray:
    """Return the ends of spans of a with the feet of those of b, which are one where they are close."""
    start, end = a.ends
    away = np.abs(feet[:, None] - a.breaks).min(axis=1)
    feet = np.sort(feet[away > _ONE * (end - start)])
    feet = feet[np.diff(feet, prepend=-np.inf) > _ONE * (end - start)]
    return merge_breakpoints(a.breaks, np.concatenate([[start], feet, [end]]))


def _beside(x: FloatArray, values: FloatArray, b: Run) -> FloatArray:
    """Return parameters of a closed curve as many turns on that they lie between the first and the last value."""
    start, end = b.ends
    return np.asarray(values[0] + np.mod(x - values[0], end - start))


def _matched(a: Run, b: Run, closed: bool) -> tuple[FloatArray, FloatArray]:
    """Return parameters along a, and along b near those of the feet: the monotone match of least squared distance.

    A closed b is run through from half a turn before to half a turn after, and entered within a quarter of a turn.

    Source: dynamic time warping; H. Sakoe and S. Chiba, 1978, without limits on the slope.
    """
    s, x = _spread(a.breaks, _MATCHED), _spread(b.breaks, 2 * _MATCHED)
    start, end = b.ends
    if closed:
        length = end - start
        # The seam is one sample, not two.
        x = np.concatenate([x[:-1] - length, x[:-1], x + length])
        x = x[(x >= start - length / 2) & (x <= end + length / 2)]
    on_a, on_b = a.at(s)[0], b.at(b.wrapped(x) if closed else x)[0]
    squared = np.sum((on_a[:, None] - on_b) ** 2, axis=2)
    if closed:
        squared[0, np.abs(x - start) > (end - start) / 4] = np.inf
    total = np.empty_like(squared)
    total[0] = squared[0]
    for i in range(1, len(s)):
        total[i] = squared[i] + np.minimum.accumulate(total[i - 1])
    chosen = np.empty(len(s), dtype=np.intp)
    last = len(x)
    for i in range(len(s) - 1, -1, -1):
        chosen[i] = int(total[i, :last].argmin())
        last = chosen[i] + 1
    return s, x[chosen]


def _spread(breaks: FloatArray, total: int) -> FloatArray:
    """Return parameters in every span, or of a curve with very many in some of them."""
    steps = max(_LEAST, -(-total // (len(breaks) - 1)))
    if steps * (len(breaks) - 1) > _MOST:
        places = np.linspace(0, len(breaks) - 1, _MOST + 1)
        return np.asarray(np.interp(places, np.arange(len(breaks)), breaks))
    inside = breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(steps) / steps)
    return np.append(inside.ravel(), breaks[-1])


def _is_end(s: FloatArray, run: Run) -> NDArray[np.bool_]:
    return np.isin(s, run.ends)


def _lengths(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))
