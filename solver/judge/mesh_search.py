"""Triangles on a grid of samples, and which of them cross: equal points are welded by index, never by distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.box_tree import BoxTree, IndexArray, box_tree, overlapping
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import CLOSED, extent

# What touches counts: barycentric coordinates may be off by this.
_TOUCH = 1e-9
# Triangles in one plane: how far corners may be off it, as a fraction of their size.
_COPLANAR = 1e-9
# More pairs than this tell nothing more.
_MOST_HITS = 20000


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles of a surface.

    Attributes
    ----------
    u, v : ndarray
        Samples.
    vertex : ndarray of int, shape (len(u), len(v))
        Index of the vertex at each sample; the same where samples are one point by construction.
    points : ndarray, shape (len(u) * len(v), 3)
    triangles : ndarray of int, shape (T, 3)
        Indices of vertices.
    corners : ndarray, shape (T, 3, 2)
        Their parameters.
    closed : (bool, bool)
        Whether the last samples in u and in v are the first.
    poles : (bool, bool, bool, bool)
        Whether the edges u0, u1, v0, v1 are one point each.
    deflection : float
        How far the surface is from the middles of cells.
    """

    u: FloatArray
    v: FloatArray
    vertex: IndexArray
    points: FloatArray
    triangles: IndexArray
    corners: FloatArray
    closed: tuple[bool, bool]
    poles: tuple[bool, bool, bool, bool]
    deflection: float


@dataclass(frozen=True, eq=False)
class Hits:
    """Pairs of triangles that cross: parameters on the first and on the second surface, each of shape (K, 2)."""

    first: FloatArray
    second: FloatArray


def grid_mesh(surface: ParametricSurface, u: FloatArray, v: FloatArray, closed: tuple[bool, bool]) -> Mesh:
    """Return the mesh of a surface on the grid u x v; `closed` says where its last samples are its first."""
    p = surface.evaluate_grid(u, v)
    n_u, n_v = p.shape[:2]
    vertex = np.arange(n_u * n_v).reshape(n_u, n_v)
    if closed[0]:
        vertex[-1] = vertex[0]
    if closed[1]:
        vertex[:, -1] = vertex[:, 0]
    limit = CLOSED * extent(p)
    poles = tuple(extent(edge) <= limit for edge in (p[0], p[-1], p[:, 0], p[:, -1]))
    for is_pole, edge in zip(poles, (vertex[0], vertex[-1], vertex[:, 0], vertex[:, -1]), strict=True):
        if is_pole:
            edge[:] = edge[0]
    triangles, corners = _triangles(vertex, u, v)
    centres = surface.evaluate_grid((u[:-1] + u[1:]) / 2, (v[:-1] + v[1:]) / 2)
    off = centres - (p[:-1, :-1] + p[1:, :-1] + p[:-1, 1:] + p[1:, 1:]) / 4
    deflection = float(np.linalg.norm(off, axis=-1).max())
    return Mesh(u, v, vertex, p.reshape(-1, 3), triangles, corners, closed, poles, deflection)  # type: ignore[arg-type]


def joined_along(mesh: Mesh, own: IndexArray, other: Mesh, theirs: IndexArray) -> Mesh:
    """Return the mesh over the points of both, its vertices `own` being `theirs` of the other."""
    rename = np.arange(len(mesh.points)) + len(other.points)
    # Both run over all samples of the line, so what is welded on one is given the vertex of the other.
    rename[own] = theirs
    vertex = rename[mesh.vertex]
    triangles, corners = _triangles(vertex, mesh.u, mesh.v)
    points = np.concatenate([other.points, mesh.points])
    return Mesh(mesh.u, mesh.v, vertex, points, triangles, corners, mesh.closed, mesh.poles, mesh.deflection)


def crossings(a: Mesh, b: Mesh) -> Hits:
    """Return where triangles of a cross those of b, which has the points of a among its own; a may be b.

    Triangles with a common edge never count, and those with a common corner only where they cross elsewhere.
    """
    # Around zero and of size 1: products neither overflow nor lose what is far from the origin.
    centre, size = b.points.mean(axis=0), extent(b.points)
    points = (b.points - centre) / (size if size > 0 else 1.0)
    columns = np.ascontiguousarray(points.T)

    def tree(mesh: Mesh) -> BoxTree:
        corners = points[mesh.triangles]
        return box_tree(corners.min(axis=1), corners.max(axis=1))

    first_tree = tree(a)
    second_tree = first_tree if a is b else tree(b)
    first: list[FloatArray] = []
    second: list[FloatArray] = []
    count = 0
    for i, j in overlapping(first_tree, second_tree):
        hit, where = _crossing(columns, a.triangles[i], b.triangles[j])
        for mesh, index, found in ((a, i[hit], first), (b, j[hit], second)):
            found.append(_parameters(_corners(columns, mesh.triangles[index]), mesh.corners[index], where))
        count += int(hit.sum())
        if count >= _MOST_HITS:
            break
    nothing = np.zeros((0, 2))
    return Hits(np.concatenate([nothing, *first]), np.concatenate([nothing, *second]))


def _triangles(vertex: IndexArray, u: FloatArray, v: FloatArray) -> tuple[IndexArray, FloatArray]:
    """Return two triangles for each cell, without those that have lost a corner."""
    n_u, n_v = vertex.shape
    at = np.arange(n_u * n_v).reshape(n_u, n_v)
    low, right, up, far = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel()
    index = np.concatenate([np.stack([low, right, far], axis=1), np.stack([low, far, up], axis=1)])
    triangles = vertex.ravel()[index]
    whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    index, triangles = index[whole], triangles[whole]
    return triangles, np.stack([u[index // n_v], v[index % n_v]], axis=-1)


# From here on the pairs are the last axis: points have shape (3, K), triangles (corner, coordinate, K). There are many
# pairs, and an inner loop of length 3 would cost more than the arithmetic.


def _corners(columns: FloatArray, triangles: IndexArray) -> FloatArray:
    return columns[:, triangles.T].transpose(1, 0, 2)


def _parameters(corners: FloatArray, parameters: FloatArray, points: FloatArray) -> FloatArray:
    """Return the parameters of points in triangles, by barycentric coordinates, shape (K, 2)."""
    weights = _barycentric(points, corners)
    return np.asarray(np.einsum("ck,kcd->kd", weights, parameters))


def _inside(points: FloatArray, corners: FloatArray, margin: float) -> NDArray[np.bool_]:
    return np.asarray((_barycentric(points, corners) > margin).all(axis=0))


def _barycentric(points: FloatArray, corners: FloatArray) -> FloatArray:
    a, b, c = corners
    normal = _normal(corners)
    square = _dot(normal, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = [_dot(_cross(q - points, r - points), normal) / square for q, r in ((b, c), (c, a), (a, b))]
    return np.stack(weights)


def _normal(corners: FloatArray) -> FloatArray:
    a, b, c = corners
    return _cross(b - a, c - a)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _crossing(columns: FloatArray, first: IndexArray, second: IndexArray) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which pairs of triangles cross, and a point of each that does."""
    same = first.T[:, None] == second.T[None]
    common = same.reshape(9, -1).sum(axis=0)
    hit = np.zeros(len(first), dtype=bool)
    where = np.zeros((3, len(first)))
    candidates = np.flatnonzero(common <= 1)
    p, q = _corners(columns, first[candidates]), _corners(columns, second[candidates])
    # Both have corners on either side of the other's plane, or on it.
    for swapped in (False, True):
        near = np.flatnonzero(_reaches(q, p) if swapped else _reaches(p, q))
        candidates, p, q = candidates[near], p[..., near], q[..., near]
    # Of triangles with a common corner only the edges opposite to it.
    shared_first, shared_second = same[..., candidates].any(axis=1), same[..., candidates].any(axis=0)
    for edges, corners, shared in ((p, q, shared_first), (q, p, shared_second)):
        for k in range(3):
            m = (k + 1) % 3
            allowed = np.flatnonzero(~(shared[k] | shared[m] | hit[candidates]))
            crossed, at = _pierces(edges[k][:, allowed], edges[m][:, allowed], corners[..., allowed])
            new = candidates[allowed[crossed]]
            hit[new] = True
            where[:, new] = at
    rest = np.flatnonzero(~hit[candidates] & (common[candidates] == 0))
    flat, at = _overlap_in_plane(p[..., rest], q[..., rest])
    hit[candidates[rest[flat]]] = True
    where[:, candidates[rest[flat]]] = at[:, flat]
    return hit, where[:, hit]


def _heights(triangles: FloatArray, others: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far the corners of others are from the planes of triangles, times the area; and the size of that."""
    normal, away = _normal(triangles), others - triangles[0]
    heights = np.stack([_dot(normal, corner) for corner in away])
    return heights, np.sqrt(_dot(normal, normal)) * np.abs(away).max(axis=(0, 1))


def _reaches(triangles: FloatArray, others: FloatArray) -> NDArray[np.bool_]:
    heights, scale = _heights(triangles, others)
    touch = _TOUCH * scale
    return np.asarray((heights.min(axis=0) <= touch) & (heights.max(axis=0) >= -touch))


def _pierces(start: FloatArray, end: FloatArray, corners: FloatArray) -> tuple[IndexArray, FloatArray]:
    """Return which segments cross their triangle, and where; those within its plane do not."""
    normal, a = _normal(corners), corners[0]
    at_start, at_end = _dot(normal, start - a), _dot(normal, end - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = at_start / (at_start - at_end)
        reached = np.flatnonzero((share >= -_TOUCH) & (share <= 1 + _TOUCH))
    start = start[:, reached]
    where = start + share[reached] * (end[:, reached] - start)
    inside = _inside(where, corners[..., reached], -_TOUCH)
    return reached[inside], where[:, inside]


def _overlap_in_plane(p: FloatArray, q: FloatArray) -> tuple[NDArray[np.bool_], FloatArray]:
    """Tell which triangles that lie in one plane overlap, and a point of both: a crossing of edges or a corner."""
    heights, scale = _heights(p, q)
    hit = np.zeros(len(scale), dtype=bool)
    where = np.zeros((3, len(scale)))
    flat = np.flatnonzero(np.abs(heights).max(axis=0) <= _COPLANAR * scale)
    if not len(flat):
        return hit, where
    p, q = p[..., flat], q[..., flat]
    normal = _normal(p)

    def found(which: NDArray[np.bool_], at: FloatArray) -> None:
        new = which & ~hit[flat]
        where[:, flat[new]] = at[:, new]
        hit[flat[new]] = True

    for corners, others in ((p, q), (q, p)):
        for k in range(3):
            found(_inside(others[k], corners, _TOUCH), others[k])
    for k in range(3):
        for m in range(3):
            start, along = p[k], p[(k + 1) % 3] - p[k]
            other, across = q[m], q[(m + 1) % 3] - q[m]
            base = _dot(_cross(along, across), normal)
            with np.errstate(divide="ignore", invalid="ignore"):
                s, t = (_dot(_cross(other - start, x), normal) / base for x in (across, along))
            inside = (s > _TOUCH) & (s < 1 - _TOUCH) & (t > _TOUCH) & (t < 1 - _TOUCH)
            found(inside, start + np.where(inside, s, 0.0) * along)
    return hit, where
