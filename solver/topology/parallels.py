"""Curves at a distance from an edge, along the surface and square to the edge: geodesics that start in it.

The acceleration of such a path is normal to the surface, x'' = II(x', x') N, and along it lengths are true distances.
It is followed in space, where nothing jumps at knots at which only the parameters are no smoother than C1.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Jet
from semispline.solver.topology.face_jets import Face, dot, parameters_of, unit

# Steps of Runge and Kutta's method to the distance: errors of some 1e-8 of it where the surface bends by a right angle.
_STEPS = 40
# Steps to a foot from one that is a step away. Feet foreseen by the speed would save half of them, and lose their way
# over a seam with a crease.
_NEWTON = 3
# Of the range of a parameter: Newton's next step would be no longer than rounding.
_NEXT_IS_NONE = 1e-9
# Of the domain: so far an edge may lie outside. Chords of steps are shorter by some of the second part where it bends.
_OUTSIDE, _UNEVEN = 1e-3, 0.1
# Of a turn: what only touches a box counts as in it. Paths that have lost their way may be any number of turns away.
_TOUCHED, _MOST_TURNS = 1e-6, 8
_OPEN = np.zeros(2)


@dataclass(frozen=True, eq=False)
class Paths:
    """Geodesics from points of an edge into a face; K of them, N steps.

    Attributes
    ----------
    at : ndarray, shape (N + 1, K, 2)
        Parameters.
    point, ahead, beside : ndarray, shape (N + 1, K, 3)
        Points, unit directions of the paths, and those square to them in the surface, as the edge runs.
    distance : float
        At the last step.
    """

    at: FloatArray
    point: FloatArray
    ahead: FloatArray
    beside: FloatArray
    distance: float

    @property
    def step(self) -> float:
        """Distance between two steps."""
        return self.distance / (len(self.at) - 1)

    def between(self, first: int, last: int) -> Paths:
        """Return some of the paths, numbered as for a slice."""
        at, point, ahead, beside = (x[:, first:last] for x in (self.at, self.point, self.ahead, self.beside))
        return Paths(at, point, ahead, beside, self.distance)


@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def paths_from(face: Face, at: FloatArray, slope: FloatArray, sign: float, distance: float) -> Paths:
    """Return the geodesics that leave a curve squarely.

    Parameters
    ----------
    face : Face
    at, slope : ndarray, shape (K, 2)
        Points of the curve in the parameters, and its derivatives.
    sign : {1.0, -1.0}
        1 to the left of the curve in the plane of the parameters.
    distance : float
    """
    jet = face.jet(at, 2, face.beside(at, slope, sign))
    along = unit(jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:])
    normal = _normal(jet)
    ahead = sign * np.cross(normal, along)
    if face.is_affine:
        steps = np.linspace(0, distance, _STEPS + 1)[:, None, None]
        places, points = at + steps * parameters_of(jet, ahead), jet[0, 0] + steps * ahead
        directions, normals = (np.broadcast_to(x, points.shape) for x in (ahead, normal))
    else:
        at_steps = [at], [jet[0, 0]], [ahead], [normal]
        for _ in range(_STEPS):
            at, jet, ahead = _a_step_on(face, at, jet, ahead, distance / _STEPS)
            for kept, value in zip(at_steps, (at, jet[0, 0], ahead, _normal(jet)), strict=True):
                kept.append(value)
        places, points, directions, normals = (np.array(x) for x in at_steps)
    return Paths(places, points, directions, sign * np.cross(directions, normals), distance)


def _a_step_on(face: Face, at: FloatArray, jet: Jet, ahead: FloatArray, h: float) -> tuple[FloatArray, Jet, FloatArray]:
    """Return where geodesics come to by one step of Runge and Kutta's method: parameters, jets, directions."""
    turned, bend = [ahead], [_bend(jet, ahead)]
    for share in (h / 2, h / 2, h):
        _, there = _foot(face, at, jet[0, 0] + share * turned[-1])
        turned.append(ahead + share * bend[-1])
        bend.append(_bend(there, turned[-1]))
    point, ahead = (
        start + h / 6 * (x[0] + 2 * x[1] + 2 * x[2] + x[3]) for start, x in ((jet[0, 0], turned), (ahead, bend))
    )
    at, jet = _foot(face, at, point)
    normal = _normal(jet)
    return at, jet, unit(ahead - dot(ahead, normal)[:, None] * normal)


def _bend(jet: Jet, ahead: FloatArray) -> FloatArray:
    """Return the acceleration of geodesics in a direction, shape (K, 3)."""
    normal, (a, b) = _normal(jet), parameters_of(jet, ahead).T[:, :, None]
    return dot(jet[2, 0] * a**2 + 2 * jet[1, 1] * a * b + jet[0, 2] * b**2, normal)[:, None] * normal


def _foot(face: Face, at: FloatArray, point: FloatArray) -> tuple[FloatArray, Jet]:
    """Return the parameters of feet and the jets there; beyond its ends the surface goes on by its last spans."""
    jet = face.jet(at, 2)
    for _ in range(_NEWTON):
        away = point - jet[0, 0]
        step = parameters_of(jet, away, away)
        at = at + step
        jet = face.jet(at, 2)
        if (np.abs(step) <= _NEXT_IS_NONE * face.widths).all():
            break
    return at, jet


def _normal(jet: Jet) -> FloatArray:
    return unit(np.cross(jet[1, 0], jet[0, 1]))


def turns_over(line: FloatArray, periods: FloatArray, low: FloatArray, high: FloatArray) -> list[FloatArray]:
    """Return by how much a polyline in the parameters of a closed surface has to move to come into a box.

    Parameters
    ----------
    line : ndarray, shape (S, 2)
    periods : ndarray, shape (2,)
        0 where the surface is not closed.
    low, high : ndarray, shape (2,)
    """
    per = np.where(periods > 0, periods, 1.0)
    first = np.where(periods > 0, np.ceil((low - line.max(axis=0)) / per - _TOUCHED), 0.0)
    last = np.where(periods > 0, np.floor((high - line.min(axis=0)) / per + _TOUCHED), 0.0)
    last = np.minimum(last, first + _MOST_TURNS)
    ranges = (np.arange(a, b + 1) for a, b in zip(first, last, strict=True))
    return [np.array(turn) * periods for turn in product(*ranges)]


def crossings(paths: Paths, lines: list[FloatArray], periods: FloatArray = _OPEN, *, again: bool = False) -> FloatArray:
    """Return, for each polyline in the parameters, where each path first crosses it; infinite where it does not.

    Parameters
    ----------
    paths : Paths
    lines : list of ndarray, shape (S, 2)
    periods : ndarray, shape (2,)
        After which the lines come again on a closed surface; 0 where they do not.
    again : bool
        Only their other turns count.

    Returns
    -------
    ndarray, shape (len(lines), K)
        Distances along the paths.
    """
    start, move = paths.at[:-1], np.diff(paths.at, axis=0)
    known = paths.at[np.isfinite(paths.at).all(axis=2)]
    found = np.full((len(lines), start.shape[1]), np.inf)
    for number, line in enumerate(lines):
        for turn in turns_over(line, periods, known.min(axis=0), known.max(axis=0)):
            if again and not turn.any():
                continue
            for p, q in zip(line[:-1] + turn, np.diff(line, axis=0), strict=True):
                cross = _cross(move, q)
                with np.errstate(divide="ignore", invalid="ignore"):
                    t, s = _cross(p - start, q) / cross, _cross(p - start, move) / cross
                hit = (t >= 0) & (t < 1) & (s >= 0) & (s <= 1)
                steps = np.where(hit, np.arange(len(start))[:, None] + t, np.inf)
                found[number] = np.minimum(found[number], steps.min(axis=0) * paths.step)
    return found


def focal_distance(paths: Paths) -> float:
    """Return the distance at which neighbouring paths begin to cross each other; infinite where they do not."""
    apart = np.sum(np.diff(paths.point, axis=1) * (paths.beside[:, 1:] + paths.beside[:, :-1]), axis=2)
    crossed = apart <= 0
    if not crossed.any():
        return np.inf
    last = int(np.argmax(crossed.any(axis=1))) - 1
    before, after = apart[last], apart[last + 1]
    share = np.where(crossed[last + 1], before / np.where(before > after, before - after, 1.0), 1.0)
    return (last + float(share.min())) * paths.step


def lost_distances(face: Face, paths: Paths) -> FloatArray:
    """Return the distances at which paths lose their way, shape (K,): infinite where they do not.

    Where they run over a pole: it lies on an end of the surface, or between two neighbours, which go round it at both
    sides; or where a step is none.
    """
    beyond = np.maximum(face.low - paths.at, paths.at - face.low - face.widths) / face.widths
    outside = np.asarray(((beyond > _OUTSIDE) & ~face.closed).any(axis=2))
    lost: NDArray[np.bool_] = np.asarray(outside | ~np.isfinite(paths.at).all(axis=2))
    steps = np.linalg.norm(np.diff(paths.point, axis=0), axis=2)
    lost[1:] |= ~(np.abs(steps / paths.step - 1) <= _UNEVEN)
    jumps = np.asarray((np.abs(np.diff(paths.at, axis=1)) > face.widths / 2) & face.closed)
    apart: NDArray[np.bool_] = np.asarray(jumps.any(axis=2))
    # An edge itself may pass that near.
    apart &= ~apart[0]
    lost[:, 1:] |= apart
    lost[:, :-1] |= apart
    return np.where(lost.any(axis=0), np.argmax(lost, axis=0) * paths.step, np.inf)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
