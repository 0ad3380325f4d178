"""Curves at a distance from an edge, along the surface and square to the edge: geodesics that start in it.

A point moves by its acceleration being normal to the surface, u'' = -(J^T J)^-1 J^T (S_uu u'^2 + 2 S_uv u' v' +
S_vv v'^2); along it lengths are true distances.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.face_jets import Face, parameters_of, unit

# Steps of Runge and Kutta's method to the distance: errors of some 1e-9 of it where the surface bends by a right angle.
_STEPS = 96


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
    jet = face.jet(at, 1, face.beside(at, slope, sign))
    along = unit(jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:])
    normal = unit(np.cross(jet[1, 0], jet[0, 1]))
    velocity = parameters_of(jet, sign * np.cross(normal, along))
    h = distance / _STEPS
    places, points, ahead, beside = [], [], [], []

    def kept() -> None:
        found = face.jet(at, 1)
        forward = unit(found[1, 0] * velocity[:, :1] + found[0, 1] * velocity[:, 1:])
        places.append(at)
        points.append(found[0, 0])
        ahead.append(forward)
        beside.append(sign * np.cross(forward, unit(np.cross(found[1, 0], found[0, 1]))))

    kept()
    for _ in range(_STEPS):
        k1 = _acceleration(face, at, velocity)
        k2 = _acceleration(face, at + h / 2 * velocity, velocity + h / 2 * k1)
        k3 = _acceleration(face, at + h / 2 * velocity + h**2 / 4 * k1, velocity + h / 2 * k2)
        k4 = _acceleration(face, at + h * velocity + h**2 / 2 * k2, velocity + h * k3)
        at = at + h * velocity + h**2 / 6 * (k1 + k2 + k3)
        velocity = velocity + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        kept()
    return Paths(np.array(places), np.array(points), np.array(ahead), np.array(beside), distance)


def _acceleration(face: Face, at: FloatArray, velocity: FloatArray) -> FloatArray:
    jet = face.jet(at, 2)
    a, b = velocity[:, :1], velocity[:, 1:]
    return -parameters_of(jet, jet[2, 0] * a**2 + 2 * jet[1, 1] * a * b + jet[0, 2] * b**2)


def crossings(paths: Paths, lines: list[FloatArray]) -> FloatArray:
    """Return, for each polyline in the parameters, where each path first crosses it; infinite where it does not.

    Returns
    -------
    ndarray, shape (len(lines), K)
        Distances along the paths.
    """
    start, move = paths.at[:-1], np.diff(paths.at, axis=0)
    found = np.full((len(lines), start.shape[1]), np.inf)
    for number, line in enumerate(lines):
        for p, q in zip(line[:-1], np.diff(line, axis=0), strict=True):
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


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
