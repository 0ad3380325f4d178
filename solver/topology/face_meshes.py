"""Trimmed faces as triangles in the parameters of their surfaces, so that all that is drawn on them is exact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Surface

Triangles = NDArray[np.int64]
# Lines of a grid each way over the box of a face, equally far apart in space; it holds the breakpoints too. And over
# the box of each further loop: the most, the least, and of all of them together.
_GRID, _MOST, _LEAST, _OF_LOOPS = 64, 24, 4, 200
# Where their distances in space are sampled: along a direction, and across it.
_ALONG, _ACROSS = 400, 7
# A point this near to the border, of the box, is on it.
_ON_BORDER = 1e-9
# Numbers held at a time.
_BLOCK = 4_000_000


@dataclass(frozen=True, eq=False)
class FaceMesh:
    """A trimmed face in triangles.

    Attributes
    ----------
    parameters : ndarray, shape (K, 2)
        (u, v) of the surface; over a seam of a closed one they run on.
    triangles : ndarray of int, shape (T, 3)
    """

    parameters: FloatArray
    triangles: Triangles

    def within(self, surface: Surface) -> tuple[FloatArray, FloatArray]:
        """Return u and v of the points in the domain of the surface."""
        found = []
        for axis, (low, high) in enumerate(surface.domain):
            x = self.parameters[:, axis]
            # What is a rounding beyond an end has not gone round.
            over = (x < low - _ON_BORDER * (high - low)) | (x > high + _ON_BORDER * (high - low))
            found.append(np.clip(np.where(over, low + np.mod(x - low, high - low), x), low, high))
        return found[0], found[1]

    def finer(self, surface: Surface, length: float, most: int) -> FaceMesh:
        """Return the face with longer sides halved until there are none, or before there are `most` triangles."""
        mesh = self
        while True:
            points = surface.evaluate(*mesh.within(surface))
            sides = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
            edges, of = np.unique(sides, axis=0, return_inverse=True)
            is_long = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1) > length
            cuts = is_long[of.reshape(-1, 3)]
            if not cuts.any() or len(cuts) + np.count_nonzero(cuts) > most:
                return mesh
            middles = np.full(len(edges), -1)
            middles[is_long] = len(mesh.parameters) + np.arange(np.count_nonzero(is_long))
            parameters = np.concatenate([mesh.parameters, mesh.parameters[edges[is_long]].mean(axis=1)])
            mesh = FaceMesh(parameters, _with_middles(mesh.triangles, middles[of.reshape(-1, 3)]))


def _with_middles(triangles: Triangles, middles: Triangles) -> Triangles:
    """Return triangles cut in two, three or four where the sides ab, bc, ca have middles; -1 where they have none."""
    count = np.count_nonzero(middles >= 0, axis=1)
    found = [triangles[count == 0]]
    for sides in (1, 2, 3):
        corners, cut = triangles[count == sides], middles[count == sides]
        # Turned so that the sides that are cut come first.
        first = np.argmax((cut >= 0) & (np.roll(cut, 1, axis=1) < 0), axis=1) if sides < 3 else np.zeros(len(cut), int)
        turn = (first[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(corners, turn, axis=1).T
        ab, bc, ca = np.take_along_axis(cut, turn, axis=1).T
        parts = {
            1: [(a, ab, c), (ab, b, c)],
            2: [(ab, b, bc), (a, ab, bc), (a, bc, c)],
            3: [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)],
        }[sides]
        found += [np.stack(part, axis=1) for part in parts]
    return np.concatenate(found)


@dataclass(frozen=True, eq=False)
class EdgeLine:
    """An edge as points to draw.

    Attributes
    ----------
    name : str
        As `semispline list PATH --edges N` has it.
    points : ndarray, shape (K, 3)
    """

    name: str
    points: FloatArray

    def scaled(self, factor: float) -> EdgeLine:
        """Return the edge in another unit of length."""
        return replace(self, points=self.points * factor)


def grid_within(surface: Surface, loops: Sequence[FloatArray], closed: Sequence[bool]) -> FaceMesh | None:
    """Return triangles of the part of a surface that loops bound: a grid, cut along them; None where nothing is left.

    Parameters
    ----------
    surface : Surface
    loops : sequence of ndarray, shape (n, 2)
        Closed polygons in the parameters, which run on over a seam.
    closed : (bool, bool)
        Whether the surface is closed in u, in v: a loop then bounds the same part a whole turn further on.

    Source: even-odd rule; the grid's triangles are cut where the distance to the loops, linear on each side, vanishes.
    """
    corners = np.concatenate(loops)
    turns = np.array([end - start for start, end in surface.domain])
    low, high = corners.min(axis=0), corners.max(axis=0)
    # What a loop bounds beyond a whole turn, it bounds before.
    high = np.where(closed, np.minimum(high, low + turns), high)
    width = high - low
    if not (width > 0).all():
        return None
    lines = []
    of_each = int(np.clip(_OF_LOOPS // len(loops), _LEAST, _MOST))
    for axis, breaks in enumerate(surface.breakpoints):
        more = [breaks + k * turns[axis] for k in ((-1, 0, 1) if closed[axis] else (0,))]
        more += [np.linspace(loop[:, axis].min(), loop[:, axis].max(), of_each) for loop in loops[1:]]
        x = np.unique(np.concatenate([_evenly(surface, axis, low, high), *more]))
        lines.append(x[(x >= low[axis]) & (x <= high[axis])])
    n_u, n_v = len(lines[0]), len(lines[1])
    at = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)
    shifts = list(product(*((-1, 0, 1) if is_closed else (0,) for is_closed in closed)))
    every = [(loop + np.array(shift) * turns - low) / width for loop in loops for shift in shifts]
    every = [loop for loop in every if ((loop.max(axis=0) > -_ON_BORDER) & (loop.min(axis=0) < 1 + _ON_BORDER)).all()]
    corner = np.arange(n_u * n_v).reshape(n_u, n_v)
    a, b, c, d = (x.ravel() for x in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = _cut(at, triangles, _signed_distance((at - low) / width, every, triangles))
    return mesh if len(mesh.triangles) else None


def _evenly(surface: Surface, axis: int, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return parameters along an axis that are equally far apart in space, in the mean."""
    along = np.linspace(low[axis], high[axis], _ALONG)
    across = np.linspace(low[1 - axis], high[1 - axis], _ACROSS)
    at = np.stack(np.meshgrid(along, across, indexing="ij"), axis=-1).reshape(-1, 2)
    at = at if axis == 0 else at[:, ::-1]
    inside = FaceMesh(at, np.zeros((0, 3), dtype=np.int64)).within(surface)
    points = surface.evaluate(*inside).reshape(_ALONG, _ACROSS, 3)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(axis=1)
    # No step is nothing, as in a fold.
    length = np.append(0.0, np.cumsum(steps + 1e-3 * steps.mean() + np.finfo(np.float64).tiny))
    return np.interp(np.linspace(0, length[-1], _GRID), length, along)


def _signed_distance(points: FloatArray, loops: Sequence[FloatArray], triangles: Triangles) -> FloatArray:
    """Return how far each point is inside of the loops, less than zero outside; just 1 or -1 far from them, shape (K,).

    Far is what belongs to no triangle with corners on both sides.
    """
    start = np.concatenate(loops)
    step = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops]) - start
    blocks = 1 + 2 * len(points) * len(start) // _BLOCK
    sign = np.concatenate([np.where(_is_inside(x, start, step), 1.0, -1.0) for x in np.array_split(points, blocks)])
    mixed = triangles[np.ptp(sign[triangles], axis=1) > 0]
    near = np.unique(mixed)
    if len(near):
        blocks = 1 + 2 * len(near) * len(start) // _BLOCK
        distance = np.concatenate([_distance(x, start, step) for x in np.array_split(points[near], blocks)])
        sign[near] *= np.where(distance <= _ON_BORDER, 0.0, distance)
    return sign


def _is_inside(points: FloatArray, start: FloatArray, step: FloatArray) -> NDArray[np.bool_]:
    offset = points[:, None] - start
    # Segments that cross the level of the point right of it.
    crosses = (offset[..., 1] < 0) != (offset[..., 1] < step[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        right = offset[..., 0] < step[:, 0] * offset[..., 1] / step[:, 1]
    return np.asarray(np.count_nonzero(crosses & right, axis=1) % 2 == 1)


def _distance(points: FloatArray, start: FloatArray, step: FloatArray) -> FloatArray:
    squared = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    offset = points[:, None] - start
    t = np.clip(np.einsum("ksd,sd->ks", offset, step) / squared, 0, 1)
    return np.asarray(np.linalg.norm(offset - t[..., None] * step, axis=2).min(axis=1))


def _cut(at: FloatArray, triangles: Triangles, value: FloatArray) -> FaceMesh:
    """Return the part of a triangulation where a value, linear along each side, is not negative."""
    kept = value >= 0
    count = kept[triangles].sum(axis=1)
    parts, points = [triangles[count == 3]], [at]
    total = len(at)
    for one_is_kept in (True, False):
        # The corner that differs from the other two comes first.
        some = triangles[count == (1 if one_is_kept else 2)]
        lone = np.argmax(kept[some] == one_is_kept, axis=1)
        a, b, c = (some[np.arange(len(some)), (lone + k) % 3] for k in range(3))
        crossings = []
        for other in (b, c):
            share = value[a] / (value[a] - value[other])
            points.append(at[a] + share[:, None] * (at[other] - at[a]))
            crossings.append(np.arange(total, total + len(some)))
            total += len(some)
        ab, ac = crossings
        if one_is_kept:
            parts.append(np.stack([a, ab, ac], axis=1))
        else:
            parts += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return FaceMesh(np.concatenate(points), np.concatenate(parts))
