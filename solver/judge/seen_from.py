"""A direction from which a surface covers itself nowhere: a proof, on samples, that it does not meet itself.

If n . d > 0 on a whole disc for one direction d, and the border's projection along d is a curve that does not meet
itself, then the projection is one to one, and so is the disc. A surface together with the bases that it joins is such
a disc, too; what lies on the contact is inside it.

Closed surfaces, normals that turn by 180 degrees, borders that cross in projection: no answer, which is not a "no".
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.box_tree import box_tree, overlapping
from semispline.solver.judge.continuation import Continuation
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, cross, lengths, spread, unit_normals

# Samples of the normal in u and v altogether, and the least in each span; of each side of the border.
_TOTAL, _LEAST, _BORDER = (80, 30), (4, 3), 60
# The normal must be this far from square to the direction, besides what it turns by within a cell.
_MARGIN = 0.02
# The search for a direction takes no more normals than this; what rounding leaves where there is none.
_MOST_NORMALS, _NO_DIRECTION = 1500, 1e-9
# Between samples the border may be this many times as far from its chord as half-way.
_BETWEEN = 2.0
# Edges that are no farther apart along the border than this many times what both may be off are neighbours.
_NEXT = 4.0

Direction: TypeAlias = tuple[float, float, float]
_Side: TypeAlias = tuple[FloatArray, FloatArray]


def seen_from(
    surface: ParametricSurface, a: Continuation | None = None, b: Continuation | None = None
) -> Direction | None:
    """Return a unit direction from which the surface, with the bases that it joins, covers itself nowhere; or None.

    Parameters
    ----------
    surface : ParametricSurface
    a, b : Continuation, optional
        Of the start and of the end of u.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> seen_from(BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]))
    (0.0, 0.0, 1.0)
    """
    parts: list[tuple[ParametricSurface, int]] = [(surface, 1)]
    # w of a runs against u.
    parts += [(base, sign) for base, sign in ((a, -1), (b, 1)) if base is not None]
    if any(any(closed_directions(part)) for part, _ in parts):
        return None
    normals = [sign * _normals(part) for part, sign in parts]
    if any(np.isnan(grid).any() for grid in normals):
        return None
    every = np.concatenate([grid.reshape(-1, 3) for grid in normals])
    border = _Border.of(_sides(surface, a, b))
    for direction in _candidates(every):
        if all(_faces(grid, direction) for grid in normals) and border.is_simple_along(direction):
            x, y, z = (direction + 0.0).tolist()
            return x, y, z
    return None


def _normals(part: ParametricSurface) -> FloatArray:
    u, v = (spread(breaks, total, least) for breaks, total, least in zip(part.breakpoints, _TOTAL, _LEAST, strict=True))
    return unit_normals(part.evaluate_grid(u, v, 1, 0), part.evaluate_grid(u, v, 0, 1))


def _candidates(normals: FloatArray) -> Iterator[FloatArray]:
    """Yield unit directions with n . d > 0: the mean normal, then one with a large least n . d, if there is any."""
    mean = normals.mean(axis=0)
    length = float(np.linalg.norm(mean))
    if length > 0 and (normals @ mean).min() > 0:
        yield mean / length
    found = _towards_all(normals[:: max(1, len(normals) // _MOST_NORMALS)])
    if found is not None:
        yield found


def _towards_all(normals: FloatArray) -> FloatArray | None:
    """Return the unit direction with the largest least n . d; None if there is none with a positive one.

    It is that of the shortest x with n . x >= 1 for all normals.

    Source: least distance programming; C. L. Lawson and R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23.
    """
    system, right = np.vstack([normals.T, np.ones(len(normals))]), np.array([0.0, 0.0, 0.0, 1.0])
    left = right - system @ nnls(system, right)[0]
    length = float(np.linalg.norm(left[:3]))
    return left[:3] / -length if length > _NO_DIRECTION else None


def _faces(grid: FloatArray, direction: FloatArray) -> bool:
    """Tell whether n . d > 0 at the corners of every cell, and stays so if n turns as far again as between them."""
    heights = grid @ direction
    corners = grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:]
    least = np.min([heights[:-1, :-1], heights[1:, :-1], heights[:-1, 1:], heights[1:, 1:]], axis=0)
    if not least.min() > _MARGIN:
        return False
    diagonals = [lengths(cross(corners[i], corners[j])) for i, j in ((0, 3), (1, 2), (0, 1), (0, 2))]
    return bool((least > np.max(diagonals, axis=0)).all())


def _sides(surface: ParametricSurface, a: Continuation | None, b: Continuation | None) -> list[_Side]:
    """Return the sides of the border, one after the other: samples, and the points half-way between them."""
    (u0, u1), (v0, v1) = surface.domain

    def side(part: ParametricSurface, v: float, *, back: bool) -> _Side:
        return _polyline(part.breakpoints[0], back, lambda u: part.evaluate_grid(u, np.array([v]))[:, 0])

    def across(part: ParametricSurface, u: float, *, back: bool) -> _Side:
        return _polyline(part.breakpoints[1], back, lambda v: part.evaluate_grid(np.array([u]), v)[0])

    def around(base: Continuation | None, end: float, first: float, last: float, *, back: bool) -> list[_Side]:
        if base is None:
            return [across(surface, end, back=back)]
        far = base.domain[0][1]
        return [side(base, first, back=False), across(base, far, back=back), side(base, last, back=True)]

    return [
        side(surface, v1, back=False),
        *around(b, u1, v1, v0, back=True),
        side(surface, v0, back=True),
        *around(a, u0, v0, v1, back=False),
    ]


def _polyline(breaks: FloatArray, back: bool, points: Callable[[FloatArray], FloatArray]) -> _Side:
    t = spread(breaks, _BORDER)
    t = t[::-1] if back else t
    return points(t), points((t[:-1] + t[1:]) / 2)


@dataclass(frozen=True, eq=False)
class _Border:
    """A closed polygon in space, and the points of the true curve half-way along its edges."""

    corners: FloatArray
    halfway: FloatArray

    @staticmethod
    def of(sides: Sequence[_Side]) -> _Border:
        # The last corner of a side is the first of the next.
        return _Border(np.concatenate([c[:-1] for c, _ in sides]), np.concatenate([h for _, h in sides]))

    def is_simple_along(self, direction: FloatArray) -> bool:
        """Tell whether the projection along a direction nowhere meets itself, allowing for what the samples miss."""
        flat = np.linalg.svd(direction[None])[2][1:].T
        corners, halfway = self.corners @ flat, self.halfway @ flat
        start, end = corners, np.roll(corners, -1, axis=0)
        off = _BETWEEN * np.linalg.norm(halfway - (start + end) / 2, axis=-1)
        # A side that is one point has edges without length.
        kept = np.linalg.norm(end - start, axis=-1) > 1e-12 * np.ptp(corners)
        start, end, off = start[kept], end[kept], off[kept]
        along = end - start
        ahead = np.roll(along, -1, axis=0)
        turned = np.abs(along[:, 0] * ahead[:, 1] - along[:, 1] * ahead[:, 0])
        if ((turned <= 1e-9 * np.abs(np.sum(along * ahead, axis=1))) & (np.sum(along * ahead, axis=1) < 0)).any():
            return False
        tree = box_tree(np.minimum(start, end) - off[:, None], np.maximum(start, end) + off[:, None])
        n, length = len(start), np.concatenate([[0.0], np.cumsum(np.linalg.norm(along, axis=-1))])
        for first, second in overlapping(tree, tree):
            apart = (second - first > 1) & (second - first < n - 1)
            i, j = first[apart], second[apart]
            between = length[j] - length[i + 1]
            between = np.minimum(between, length[-1] - (length[j + 1] - length[i]))
            # Next to a long edge short ones are close to it.
            allowed = np.where(between > _NEXT * (off[i] + off[j]), off[i] + off[j], 0.0)
            if _close(start[i], end[i], start[j], end[j], allowed).any():
                return False
        return True


def _close(p: FloatArray, q: FloatArray, r: FloatArray, s: FloatArray, allowed: FloatArray) -> NDArray[np.bool_]:
    """Tell which edges p q and r s cross, or come no farther apart than that."""

    def side(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
        return np.asarray((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))

    def distance(c: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
        along = b - a
        share = np.clip(np.sum((c - a) * along, axis=1) / np.sum(along**2, axis=1), 0, 1)
        return np.asarray(np.linalg.norm(c - a - share[:, None] * along, axis=1))

    crossing = (side(p, q, r) * side(p, q, s) <= 0) & (side(r, s, p) * side(r, s, q) <= 0)
    apart = np.min([distance(p, r, s), distance(q, r, s), distance(r, p, q), distance(s, p, q)], axis=0)
    collinear = (side(p, q, r) == 0) & (side(p, q, s) == 0)
    return np.asarray((crossing & ~collinear) | (apart <= allowed))
