"""How far a contact can move from an edge into the faces on both its sides, told from samples."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import NONE, EdgeGraph

# Of a turn: an edge that leaves no more runs all round. Radians: a face goes on smoothly.
_ALL_ROUND, _SMOOTH = 1e-6, 1e-6


def clearance(graph: EdgeGraph, *rows: int) -> float:
    """Return how far the contact of an edge can move into either of its faces; its length where nothing ends them.

    As far as the nearest edge that does not touch it, as far as the edges that do leave anything between them, and
    less than where ways from an edge that curves into its face cross. Over a seam at which the face goes on smoothly
    the contact goes on, half way round to the edge itself. It is exact in planes, else an estimate.
    """
    length = float(np.linalg.norm(np.diff(graph.uses.points[rows[0]], axis=0), axis=1).sum())
    least = min(_within(graph, row) for row in rows)
    return least if np.isfinite(least) else length


def _within(graph: EdgeGraph, row: int) -> float:
    """Return the same for the face of one use; infinite where nothing is known to end it."""
    uses = graph.uses
    at = np.arange(*uses.of_face(int(uses.face[row])).indices(len(uses)))
    over = np.array([_goes_on(graph, int(x)) for x in at], dtype=np.bool_)
    seams = at[over]
    at = at[(uses.edge[at] != uses.edge[row]) & (uses.pcurve[at] != "none") & ~over]
    ends = uses.points[at][:, [0, -1], None] - uses.points[row, [0, -1]]
    touches = np.einsum("kabd,kabd->kab", ends, ends).min(axis=(1, 2)) <= (1e-6 * graph.size) ** 2
    beside, beyond = uses.points[at[touches]], uses.points[at[~touches]].reshape(-1, 3)
    nearest = float(cKDTree(beyond).query(uses.points[row])[0].min()) if len(beyond) else np.inf
    itself = min((_half_round(graph, row, int(x)) for x in seams), default=np.inf)
    return min(nearest, itself, _between_ends(graph, row, beside), _focal(graph, row))


def _goes_on(graph: EdgeGraph, row: int) -> bool:
    """Tell whether a use is a seam at which its face is smooth."""
    uses = graph.uses
    if not uses.seam[row] or uses.twin[row] == NONE:
        return False
    one, other = uses.normal[row], uses.normal[uses.twin[row]]
    return bool(np.linalg.norm(one - other, axis=1).max() <= _SMOOTH)


def _half_round(graph: EdgeGraph, row: int, seam: int) -> float:
    """Return half of what lies between an edge and itself a turn later; infinite where it runs all round."""
    uses = graph.uses
    axis = int(np.ptp(uses.uv[seam], axis=0).argmin())
    start, end = graph.faces.ends[uses.face[row]][2 * axis : 2 * axis + 2]
    rest = end - start - float(np.ptp(uses.uv[row][:, axis]))
    if rest <= _ALL_ROUND * (end - start):
        return np.inf
    return float(rest / 2 * (uses.speed_u, uses.speed_v)[axis][row].min())


def _between_ends(graph: EdgeGraph, row: int, lines: FloatArray) -> float:
    """Return how far into the face edges that touch an edge come together, looking squarely from each sample."""
    uses = graph.uses
    reach = np.full(uses.points.shape[1], np.inf)
    for line in lines:
        offset = line - uses.points[row][:, None]
        along, away = (np.einsum("nkd,nd->nk", offset, way[row]) for way in (uses.tangent, uses.inward))
        a, b = along[:, :-1], along[:, 1:]
        crossed = (a <= 0) != (b <= 0)
        share = np.where(crossed, a / np.where(crossed, a - b, 1.0), 0.0)
        met = away[:, :-1] + share * np.diff(away, axis=1)
        reach = np.minimum(reach, np.where(crossed & (met > 0), met, np.inf).min(axis=1))
    # At its ends an edge touches the others.
    return float(reach[1:-1].max(initial=0.0)) or np.inf


def _focal(graph: EdgeGraph, row: int) -> float:
    """Return how far from an edge ways that leave two samples squarely cross: the radius of an arc that they go in."""
    points, tangent, inward = (x[row] for x in (graph.uses.points, graph.uses.tangent, graph.uses.inward))
    middle = tangent[1:] + tangent[:-1]
    apart, closing = _along(np.diff(points, axis=0), middle), -_along(np.diff(inward, axis=0), middle)
    # Of an edge that runs against the way in which its face is walked round both have the other sign.
    sign = np.sign(apart)
    crossed = closing * sign > 1e-9 * np.linalg.norm(middle, axis=1)
    return float((apart[crossed] / closing[crossed]).min(initial=np.inf))


def _along(vectors: FloatArray, way: FloatArray) -> FloatArray:
    return np.asarray(np.sum(vectors * way, axis=1))
