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
# Points of a grid each way over the box of a face; it holds the breakpoints too.
_GRID = 64
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
        """Return the face with each triangle cut in four until no side is longer, or `most` triangles are reached."""
        mesh = self
        while 4 * len(mesh.triangles) <= most:
            points = surface.evaluate(*mesh.within(surface))
            sides = points[mesh.triangles] - points[np.roll(mesh.triangles, 1, axis=1)]
            if np.linalg.norm(sides, axis=2).max(initial=0.0) <= length:
                break
            mesh = mesh._halved()
        return mesh

    def _halved(self) -> FaceMesh:
        a, b, c = self.triangles.T
        sides = np.sort(np.concatenate([np.stack(pair, axis=1) for pair in ((a, b), (b, c), (c, a))]), axis=1)
        edges, of = np.unique(sides, axis=0, return_inverse=True)
        ab, bc, ca = (of.ravel() + len(self.parameters)).reshape(3, -1)
        middles = self.parameters[edges].mean(axis=1)
        cut = [np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        return FaceMesh(np.concatenate([self.parameters, middles]), np.concatenate(cut))


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
    low, high = corners.min(axis=0), corners.max(axis=0)
    width = high - low
    if not (width > 0).all():
        return None
    turns = [np.diff(ends)[0] for ends in surface.domain]
    lines = []
    for axis, breaks in enumerate(surface.breakpoints):
        more = [breaks + k * turns[axis] for k in ((-1, 0, 1) if closed[axis] else (0,))]
        x = np.unique(np.concatenate([np.linspace(low[axis], high[axis], _GRID), *more]))
        lines.append(x[(x >= low[axis]) & (x <= high[axis])])
    n_u, n_v = len(lines[0]), len(lines[1])
    at = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)
    shifts = list(product(*((-1, 0, 1) if is_closed else (0,) for is_closed in closed)))
    every = [(loop + np.array(shift) * turns - low) / width for loop in loops for shift in shifts]
    every = [loop for loop in every if ((loop.max(axis=0) > -_ON_BORDER) & (loop.min(axis=0) < 1 + _ON_BORDER)).all()]
    inside = _signed_distance((at - low) / width, every)
    corner = np.arange(n_u * n_v).reshape(n_u, n_v)
    a, b, c, d = (x.ravel() for x in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = _cut(at, triangles, inside)
    return mesh if len(mesh.triangles) else None


def _signed_distance(points: FloatArray, loops: Sequence[FloatArray]) -> FloatArray:
    """Return the distance of each point to the loops, positive inside; shape (K,)."""
    start = np.concatenate(loops)
    step = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops]) - start
    squared = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    found = []
    for block in np.array_split(points, 1 + 2 * len(points) * len(start) // _BLOCK):
        offset = block[:, None] - start
        t = np.clip(np.einsum("ksd,sd->ks", offset, step) / squared, 0, 1)
        distance = np.linalg.norm(offset - t[..., None] * step, axis=2).min(axis=1)
        # Segments that cross the level of the point right of it.
        crosses = (offset[..., 1] < 0) != (offset[..., 1] < step[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            right = offset[..., 0] < step[:, 0] * offset[..., 1] / step[:, 1]
        odd = np.count_nonzero(crosses & right, axis=1) % 2 == 1
        found.append(np.where(distance <= _ON_BORDER, 0.0, np.where(odd, distance, -distance)))
    return np.concatenate(found)


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
