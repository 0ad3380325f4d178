"""How far a natural edge of a surface lies outside of the face that a CAD file cuts out of the surface.

The boundary of a face comes as cubic pieces: few numbers, close to circles and splines of every kind, that one process
can hand to another.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Surface

# A piece keeps to its curve within this fraction of the curve's extent: below what a user could care for.
_CLOSE = 1e-6
_HALVINGS = 10
# Derivatives at a corner are taken a little inside of the piece.
_INSIDE = 1e-9
_OPPOSITE = {"u0": "u1", "u1": "u0", "v0": "v1", "v1": "v0"}
# Points on a natural edge; corners of the boundary are found from the nearest of more of them.
_POINTS, _CHORDS = 65, 512
# Closer looks at the largest distance, each between the neighbours of the place where the last one found it.
_CLOSER = 2
_NODES = np.linspace(0, 1, 5)
# Numbers held at a time.
_BLOCK = 4_000_000


@dataclass(frozen=True, eq=False)
class FaceBoundary:
    """The edges that bound a face, holes included.

    Attributes
    ----------
    pieces : ndarray, shape (K, 4, 3)
        Bezier points of cubic pieces, in no order; a vertex is a piece of length zero. None at all (K = 0) where the
        reader could not tell.
    tolerance : ndarray, shape (K,)
        How far the edge may be from the piece: the tolerance in the file, and what the piece leaves out.
    side : ndarray of str, shape (K,)
        The natural edge that the piece runs along in the parameters of the surface, "" where it runs along none or
        where that is not known. Both sides of a seam are one curve in space, and two natural edges.
    """

    pieces: FloatArray
    tolerance: FloatArray
    side: NDArray[np.str_]

    def scaled(self, factor: float) -> FaceBoundary:
        """Return the boundary in another unit of length."""
        return replace(self, pieces=self.pieces * factor, tolerance=self.tolerance * factor)


@dataclass(frozen=True)
class EdgeOffset:
    """Where a natural edge lies beside the boundary of its face.

    Attributes
    ----------
    distance : float
        The largest, from a point of the natural edge to the boundary, in model units; 0 where the natural edge is the
        face's own.
    in_part : bool
        A part of the natural edge is the face's own.
    """

    distance: float
    in_part: bool


def joined(parts: list[tuple[FloatArray, FloatArray, str]]) -> FaceBoundary:
    """Return a boundary from pieces, their tolerances, and the natural edge along which they run."""
    if not parts:
        return FaceBoundary(np.zeros((0, 4, 3)), np.zeros(0), np.zeros(0, dtype="<U2"))
    side = np.repeat(np.array([part[2] for part in parts], dtype="<U2"), [len(part[0]) for part in parts])
    return FaceBoundary(np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts]), side)


def cubic_pieces(
    curve: Callable[[FloatArray], tuple[FloatArray, FloatArray]], breaks: FloatArray, tolerance: float
) -> tuple[FloatArray, FloatArray]:
    """Return pieces close to a curve, and the tolerance of each; between two breaks the curve is smooth.

    Parameters
    ----------
    curve : callable
        Points and derivatives, each of shape (K, 3), at K parameters.
    breaks : ndarray, shape (B,)
    tolerance : float
        Of the edge itself.
    """
    start, end = breaks[:-1], breaks[1:]
    allowed: float | None = None
    pieces, errors = [], []
    for halving in range(_HALVINGS + 1):
        first, last = start + _INSIDE * (end - start), end - _INSIDE * (end - start)
        # The middle is where the error is largest; a second place, because a symmetric curve may meet it by chance.
        at = np.concatenate([first, last, (first + last) / 2, first + 0.3 * (last - first)])
        points, derivatives = (x.reshape(4, -1, 3) for x in curve(at))
        if allowed is None:
            allowed = _CLOSE * float(np.ptp(points.reshape(-1, 3), axis=0).max())
        step = (last - first)[:, None] / 3
        tried = np.stack(
            [points[0], points[0] + step * derivatives[0], points[1] - step * derivatives[1], points[1]], axis=1
        )
        shown = _on_pieces(tried, np.array([0.5, 0.3]))
        error = np.linalg.norm(shown - points[2:].transpose(1, 0, 2), axis=2).max(axis=1)
        kept = (error <= allowed) | (halving == _HALVINGS)
        pieces.append(tried[kept])
        errors.append(np.maximum(error[kept], allowed))
        middle = (start + end)[~kept] / 2
        start, end = np.concatenate([start[~kept], middle]), np.concatenate([middle, end[~kept]])
        if kept.all():
            break
    return np.concatenate(pieces), tolerance + np.concatenate(errors)


def vertex_piece(point: FloatArray) -> FloatArray:
    """Return the piece of length zero at a point."""
    return np.broadcast_to(point, (1, 4, 3))


def edge_offset(surface: Surface, edge: str, boundary: FaceBoundary) -> EdgeOffset:
    """Return how far the natural edge u0, u1, v0 or v1 lies from a boundary that has pieces.

    Source: distance to a cubic piece by Gauss-Newton steps from the nearest of sampled points.
    """
    boundary = _this_side(surface, edge, boundary)
    low, high = surface.domain[1 if edge[0] == "u" else 0]
    # The middles between corners besides: no gap between two of them is passed by, however short it is.
    between = np.unique(np.concatenate([[low], _corners_on(surface, edge, boundary), [high]]))
    at = np.unique(np.concatenate([np.linspace(low, high, _POINTS), (between[1:] + between[:-1]) / 2]))
    distance, is_own = distances(_along(surface, edge, at), boundary)
    # The ends touch the boundary where a neighbouring edge is the face's own.
    in_part = bool(is_own[1:-1].any())
    off = np.where(is_own, 0.0, distance)
    for _ in range(_CLOSER if off.any() else 0):
        k = int(off.argmax())
        # The place itself is looked at again: what was found is never lost.
        at = np.unique(np.append(np.linspace(at[max(k - 1, 0)], at[min(k + 1, len(at) - 1)], _POINTS), at[k]))
        distance, is_own = distances(_along(surface, edge, at), boundary)
        off = np.where(is_own, 0.0, distance)
    return EdgeOffset(float(off.max()), in_part)


def natural_boundary(surface: Surface) -> FaceBoundary:
    """Return the four natural edges of a surface."""
    parts = []
    for edge in _OPPOSITE:

        def curve(at: FloatArray, edge: str = edge) -> tuple[FloatArray, FloatArray]:
            return _along(surface, edge, at), _along(surface, edge, at, 1)

        parts.append((*cubic_pieces(curve, surface.breakpoints[1 if edge[0] == "u" else 0], 0.0), edge))
    return joined(parts)


def distances(points: FloatArray, boundary: FaceBoundary) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return the distance of each point to the boundary, and whether that is within a tolerance; shapes (K,)."""
    nodes = _on_pieces(boundary.pieces, _NODES)
    start, step = nodes[:, :-1].reshape(-1, 3), np.diff(nodes, axis=1).reshape(-1, 3)
    each = len(_NODES) - 1
    found, inside = [], []
    for block in np.array_split(points, 1 + 3 * len(points) * len(start) // _BLOCK):
        to_chords, t = _to_chords(block, start, step)
        # A few of the nearest chords: of two that are nearly as near, either may belong to the nearer piece. Those
        # nearest against their tolerance may be others.
        near = np.concatenate(
            [
                np.argpartition(to_chords - lower, 3, axis=1)[:, :4]
                for lower in (0.0, np.repeat(boundary.tolerance, each))
            ],
            axis=1,
        )
        piece = near // each
        first_guess = (near % each + np.take_along_axis(t, near, axis=1)) / each
        distance = _polished(block, boundary.pieces[piece], first_guess)
        found.append(distance.min(axis=1))
        inside.append((distance <= boundary.tolerance[piece]).any(axis=1))
    return np.concatenate(found), np.concatenate(inside)


def _along(surface: Surface, edge: str, at: FloatArray, derivative: int = 0) -> FloatArray:
    """Return points of an edge, or derivatives along it, at its parameters; shape (K, 3)."""
    ends = surface.domain[0 if edge[0] == "u" else 1]
    across = np.full_like(at, ends[int(edge[1])])
    if edge[0] == "u":
        return surface.evaluate(across, at, 0, derivative)
    return surface.evaluate(at, across, derivative, 0)


def points_on(boundary: FaceBoundary) -> FloatArray:
    """Return points on the edges of a face, shape (K, 3)."""
    return _on_pieces(boundary.pieces, _NODES).reshape(-1, 3)


def _to_chords(points: FloatArray, start: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return, of K points and S chords, the distance and the place on the chord from 0 to 1; both of shape (K, S)."""
    length = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    offset = points[:, None] - start
    t = np.clip(np.einsum("ksd,sd->ks", offset, step) / length, 0, 1)
    return np.asarray(np.linalg.norm(offset - t[..., None] * step, axis=2)), t


def _this_side(surface: Surface, edge: str, boundary: FaceBoundary) -> FaceBoundary:
    """Return the boundary without what lies along the other side of a seam, the same curve in space."""
    at = np.linspace(*surface.domain[1 if edge[0] == "u" else 0], _POINTS)
    here, there = _along(surface, edge, at), _along(surface, _OPPOSITE[edge], at)
    counted = boundary.side != _OPPOSITE[edge]
    if np.abs(here - there).max() > _CLOSE * np.ptp(here, axis=0).max() or not counted.any():
        return boundary
    return FaceBoundary(boundary.pieces[counted], boundary.tolerance[counted], boundary.side[counted])


def _corners_on(surface: Surface, edge: str, boundary: FaceBoundary) -> FloatArray:
    """Return parameters of the natural edge at which pieces of the boundary end on it."""
    ends = _on_pieces(boundary.pieces, np.array([0.0, 1.0])).reshape(-1, 3)
    low, high = surface.domain[1 if edge[0] == "u" else 0]
    at = np.linspace(low, high, _CHORDS + 1)
    points, tangents = _along(surface, edge, at), _along(surface, edge, at, 1)
    # SciPy waits, as in the functions of `splines.knots`: most readers ask for no corner.
    from scipy.spatial import cKDTree

    nearest = cKDTree(points).query(ends)[1]
    speed = np.maximum(np.sum(tangents**2, axis=1), np.finfo(np.float64).tiny)
    feet = at[nearest] + np.sum((ends - points[nearest]) * tangents[nearest], axis=1) / speed[nearest]
    feet = np.clip(feet, low, high)
    # A corner found a little off only moves a place where the distance is measured.
    allowed = np.repeat(boundary.tolerance, 2) + float(np.ptp(points, axis=0).max()) / _CHORDS
    return np.asarray(feet[np.linalg.norm(ends - _along(surface, edge, feet), axis=1) <= allowed])


def _on_pieces(pieces: FloatArray, t: FloatArray) -> FloatArray:
    """Return points on cubic pieces, shape (..., len(t), 3)."""
    basis = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-1)
    return np.asarray(np.einsum("ta,...ad->...td", basis, pieces))


def _polished(points: FloatArray, pieces: FloatArray, t: FloatArray) -> FloatArray:
    """Return distances of K points to C pieces each, shapes (K, 3), (K, C, 4, 3); t is where to start."""
    best = np.full(t.shape, np.inf)
    legs = np.diff(pieces, axis=2)
    for _ in range(8):
        s = t[..., None]
        offset = (
            (1 - s) ** 3 * pieces[..., 0, :]
            + 3 * s * (1 - s) ** 2 * pieces[..., 1, :]
            + 3 * s**2 * (1 - s) * pieces[..., 2, :]
            + s**3 * pieces[..., 3, :]
            - points[:, None]
        )
        tangent = 3 * ((1 - s) ** 2 * legs[..., 0, :] + 2 * s * (1 - s) * legs[..., 1, :] + s**2 * legs[..., 2, :])
        best = np.minimum(best, np.linalg.norm(offset, axis=2))
        speed = np.maximum(np.sum(tangent**2, axis=2), np.finfo(np.float64).tiny)
        t = np.clip(t - np.sum(offset * tangent, axis=2) / speed, 0, 1)
    return best
