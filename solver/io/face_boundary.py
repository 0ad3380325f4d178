"""How far a natural edge of a surface lies outside of the face that a CAD file cuts out of the surface.

The boundary of a face comes as cubic pieces: few numbers, close to circles and splines of every kind, that one process
can hand to another.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Surface

# A piece keeps to its curve within this fraction of the curve's extent: below what a user could care for.
_CLOSE = 1e-6
_HALVINGS = 10
# Derivatives at a corner are taken a little inside of the piece.
_INSIDE = 1e-9
_OPPOSITE = {"u0": "u1", "u1": "u0", "v0": "v1", "v1": "v0"}
# Points on a natural edge; foot points of the corners of the boundary are found between more of them.
_POINTS, _CHORDS = 65, 512
_NODES = np.linspace(0, 1, 5)
# Distances held at a time.
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
    # On the other side of a seam the same curve in space is another edge of the surface.
    counted = boundary.side != _OPPOSITE[edge]
    pieces, tolerance = boundary.pieces[counted], boundary.tolerance[counted]
    low, high = surface.domain[1 if edge[0] == "u" else 0]
    corners = _feet(surface, edge, _on_pieces(pieces, np.array([0.0, 1.0])).reshape(-1, 3))
    # The middles between corners besides: no gap between two of them is passed by, however short it is.
    between = np.unique(np.concatenate([[low], corners, [high]]))
    at = np.unique(np.concatenate([np.linspace(low, high, _POINTS), (between[1:] + between[:-1]) / 2]))
    distance, is_own = _distance(natural_edge(surface, edge, at), pieces, tolerance)
    # The ends touch the boundary where a neighbouring edge is the face's own.
    return EdgeOffset(float(distance[~is_own].max(initial=0.0)), bool(is_own[1:-1].any()))


def natural_edge(surface: Surface, edge: str, at: FloatArray) -> FloatArray:
    """Return points on an edge of the surface at parameters along it, shape (K, 3)."""
    ends = surface.domain[0 if edge[0] == "u" else 1]
    across = np.full_like(at, ends[int(edge[1])])
    return surface.evaluate(across, at) if edge[0] == "u" else surface.evaluate(at, across)


def points_on(boundary: FaceBoundary) -> FloatArray:
    """Return points on the edges of a face, shape (K, 3)."""
    return _on_pieces(boundary.pieces, _NODES).reshape(-1, 3)


def distance_to_polygon(points: FloatArray, polygon: FloatArray) -> FloatArray:
    """Return the distance of each point to a polygon of vertices, shapes (K, 3) and (S + 1, 3)."""
    return np.asarray(_to_polygon(points, polygon)[0].min(axis=1))


def _to_polygon(points: FloatArray, polygon: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return, of points and chords, the distance and the place on the chord from 0 to 1; both of shape (K, S)."""
    start, step = polygon[:-1], np.diff(polygon, axis=0)
    length = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    t = np.clip(np.einsum("ksd,sd->ks", points[:, None] - start, step) / length, 0, 1)
    return np.asarray(np.linalg.norm(points[:, None] - start - t[..., None] * step, axis=2)), t


def _feet(surface: Surface, edge: str, points: FloatArray) -> FloatArray:
    """Return parameters of the edge nearest to points, to well within a chord."""
    low, high = surface.domain[1 if edge[0] == "u" else 0]
    at = np.linspace(low, high, _CHORDS + 1)
    polygon = natural_edge(surface, edge, at)
    feet = []
    for block in np.array_split(points, 1 + 3 * len(points) * _CHORDS // _BLOCK):
        distance, t = _to_polygon(block, polygon)
        chord = distance.argmin(axis=1)
        feet.append(at[chord] + t[np.arange(len(block)), chord] * (high - low) / _CHORDS)
    return np.asarray(np.clip(np.concatenate(feet), low, high))


def _on_pieces(pieces: FloatArray, t: FloatArray) -> FloatArray:
    """Return points on cubic pieces, shape (..., len(t), 3)."""
    basis = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=-1)
    return np.asarray(np.einsum("ta,...ad->...td", basis, pieces))


def _distance(points: FloatArray, pieces: FloatArray, tolerance: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return the distance of each point to the pieces, and whether it is within the tolerance of one."""
    nodes = _on_pieces(pieces, _NODES).reshape(-1, 3)
    # The tolerance of a piece, once for each of its nodes.
    allowed = np.repeat(tolerance, len(_NODES))
    distances, inside = [], []
    for block in np.array_split(points, 1 + len(points) * len(nodes) // _BLOCK):
        # Two pieces share a node: the four nearest, so that the right one is among them.
        near = np.argpartition(cdist(block, nodes) - allowed, 3, axis=1)[:, :4]
        piece = near // len(_NODES)
        found = _polished(block, pieces[piece], _NODES[near % len(_NODES)])
        distances.append(found.min(axis=1))
        inside.append((found <= tolerance[piece]).any(axis=1))
    return np.concatenate(distances), np.concatenate(inside)


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
