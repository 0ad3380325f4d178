"""How two faces meet along each edge: angle, convexity, curvature of the neighbour; and who lies along unsewn edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import NONE, SAMPLES, EdgeGraph, Flags, Integers, Uses

# Ends of an edge are left out of what is said of angles: poles, and corners that are pinched.
INNER = slice(1, -1)
# Smooth: what CAD systems call tangent, with what loose files make of it. Of 8624 uses none lies between 5 and 8.
_SMOOTH_MEDIAN, _SMOOTH_MOST = 4.0, 8.0
SHARP = 10.0
# Samples of both uses further apart than this fraction of the length are not at the same places of the edge.
_SAME_PLACE = 1e-3
# Edges of unsewn faces are one if their ends agree to this fraction of the size, and all of them to that of the length.
_SAME_ENDS, _SAME_LINE = 3e-5, 0.02


@dataclass(frozen=True, eq=False)
class Relations:
    """What each use and its neighbour have to do with each other; NaN where there is no neighbour.

    Attributes
    ----------
    partner : ndarray of int, shape (U,)
        `other`, or the use that lies along this one in a file whose faces are not sewn; -1 where there is none.
    matched : ndarray of bool, shape (U,)
        The partner was found by its place.
    naked : ndarray of bool, shape (U,)
        Still no other face.
    length : ndarray, shape (U,)
        Of the polyline through the samples.
    angle : ndarray, shape (U, N)
        Between the outward normals of both faces, in degrees.
    median, most : ndarray, shape (U,)
        Of the angle, over inner samples.
    smooth, sharp : ndarray of bool, shape (U,)
    convex : ndarray of bool, shape (U,)
        The material lies inside of the angle; says something where the edge is sharp.
    bend : ndarray, shape (U, N)
        Curvature of the neighbour across the edge, with the sign of this face's normal.
    """

    partner: Integers
    matched: Flags
    naked: Flags
    length: FloatArray
    angle: FloatArray
    median: FloatArray
    most: FloatArray
    smooth: Flags
    sharp: Flags
    convex: Flags
    bend: FloatArray


def relate(graph: EdgeGraph) -> Relations:
    """Return how the faces of a file meet."""
    uses = graph.uses
    length = np.linalg.norm(np.diff(uses.points, axis=1), axis=2).sum(axis=1)
    found = _matched(uses, length, graph.size)
    partner = np.where(uses.other != NONE, uses.other, found)
    has = partner != NONE
    angle, bend = np.full((2, len(uses), SAMPLES), np.nan)
    convex = np.zeros(len(uses), dtype=bool)
    mine, yours = np.flatnonzero(has), partner[has]
    at = _same_samples(uses.points[mine], uses.points[yours], length[mine])
    normal, tangent = (np.take_along_axis(x[yours], at[..., None], axis=1) for x in (uses.normal, uses.tangent))
    # Two faces that agree on what is outside walk their edge against each other.
    agree = np.where(np.sum(uses.tangent[mine] * tangent, axis=2)[:, INNER].mean(axis=1) > 0, -1.0, 1.0)[:, None]
    normal = normal * agree[..., None]
    sine = np.linalg.norm(np.cross(uses.normal[mine], normal), axis=2)
    angle[mine] = np.degrees(np.arctan2(sine, np.sum(uses.normal[mine] * normal, axis=2)))
    bend[mine] = np.take_along_axis(uses.across[yours], at, axis=1) * agree
    convex[mine] = np.sum(uses.inward[mine] * normal, axis=2)[:, INNER].mean(axis=1) < 0
    median, most = np.full((2, len(uses)), np.nan)
    median[mine], most[mine] = np.median(angle[mine, INNER], axis=1), angle[mine, INNER].max(axis=1)
    return Relations(
        partner=partner,
        matched=found != NONE,
        naked=uses.naked & (found == NONE) & (uses.pcurve != "none"),
        length=length,
        angle=angle,
        median=median,
        most=most,
        smooth=(median <= _SMOOTH_MEDIAN) & (most <= _SMOOTH_MOST),
        sharp=median >= SHARP,
        convex=convex,
        bend=bend,
    )


def by_arc_length(points: FloatArray, count: int) -> FloatArray:
    """Return points at equal arc lengths of a polyline, shape (count, 3), ends included."""
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.r_[0.0, np.cumsum(step)]
    at = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(at, along, x) for x in points.T], axis=1)


def _middles(lines: FloatArray) -> FloatArray:
    """Return the points at half the length of polylines, shape (K, N, 3); shape (K, 3)."""
    step = np.linalg.norm(np.diff(lines, axis=1), axis=2)
    ends = np.cumsum(step, axis=1)
    half = ends[:, -1:] / 2
    at = np.argmax(ends >= half, axis=1)
    rows = np.arange(len(lines))
    part = 1 - (ends[rows, at] - half[:, 0]) / step[rows, at]
    return np.asarray(lines[rows, at] + part[:, None] * (lines[rows, at + 1] - lines[rows, at]))


def to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Return distances of points, shape (K, 3), to a polyline, shape (S, 3); shape (K,)."""
    start, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    offset = points[:, None] - start
    t = np.clip(np.einsum("ksd,sd->ks", offset, step) / square, 0, 1)
    away = offset - t[..., None] * step
    return np.asarray(np.sqrt(np.einsum("ksd,ksd->ks", away, away).min(axis=1)))


def _same_samples(mine: FloatArray, yours: FloatArray, length: FloatArray) -> Integers:
    """Return, for each sample, the one of the partner at the same place, shape (K, N)."""
    count = mine.shape[1]
    at = np.tile(np.arange(count), (len(mine), 1))
    apart = np.linalg.norm(mine - yours, axis=2).max(axis=1)
    for row in np.flatnonzero(~(apart <= _SAME_PLACE * length)):
        at[row] = np.argmin(np.linalg.norm(mine[row][:, None] - yours[row], axis=2), axis=1)
    return at


def _matched(uses: Uses, length: FloatArray, size: float) -> Integers:
    """Return, for naked uses, the one that lies along it; -1 where there is none, or it is not the only one."""
    found = np.full(len(uses), NONE)
    rows = np.flatnonzero(uses.naked & (uses.pcurve != "none") & (length > 0))
    if len(rows) < 2:
        return found
    middle = _middles(uses.points[rows])
    ends = uses.points[rows][:, [0, -1]]
    # SciPy waits: a process that only reads a file has no use for it.
    from scipy.spatial import cKDTree

    tree = cKDTree(middle)
    best: dict[int, int] = {}
    for i, row in enumerate(rows.tolist()):
        allowed = _SAME_LINE * length[row]
        near = [j for j in tree.query_ball_point(middle[i], allowed) if uses.face[rows[j]] != uses.face[row]]
        near = [
            j
            for j in near
            if min(np.abs(ends[i] - ends[j]).max(), np.abs(ends[i] - ends[j][::-1]).max()) <= _SAME_ENDS * size
            and to_polyline(uses.points[row], uses.points[rows[j]]).max() <= allowed
            and abs(length[row] - length[rows[j]]) <= allowed
        ]
        if near:
            best[i] = min(near, key=lambda j: float(np.linalg.norm(middle[i] - middle[j])))
    for i, j in best.items():
        if best.get(j) == i:
            found[rows[i]] = rows[j]
    return found
