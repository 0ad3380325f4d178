"""From triangles that cross to places where the true surfaces do: by least steps on P(u, v) = Q(s, t)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.box_tree import IndexArray
from semispline.solver.judge.continuation import Continuation
from semispline.solver.judge.mesh_search import Hits, Mesh, crossings, grid_mesh, joined_along
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, extent, unit_normals

# Hits in boxes of so many cells that touch are one place; so many of each are tried on the true surfaces, and in all.
_TOGETHER, _TRIED, _TRIED_IN_ALL = 3.0, 12, 2000
# Steps on the true surfaces; no step is longer than this part of the domain; what may remain, as a fraction of the
# extent, and how many roundings of the coordinates; how many cells apart the parameters of a real place are.
_STEPS, _LONGEST, _REACHED, _ROUNDINGS, _APART = 20, 0.1, 1e-11, 64, 0.5
# Directions of the four steps that change nothing: below this fraction of the largest.
_SINGULAR = 1e-9

What: TypeAlias = Literal["itself", "a", "b"]
_IsReal: TypeAlias = Callable[[FloatArray, FloatArray], NDArray[np.bool_]]


@dataclass(frozen=True)
class Meeting:
    """A place where a surface meets itself or a base, confirmed on the true surfaces.

    Attributes
    ----------
    what : {"itself", "a", "b"}
    uv : tuple of float
        Parameters on the surface.
    other : tuple of float
        Parameters of the same point once more on the surface, or on the base, as the base has them.
    point : tuple of float
    angle_degrees : float
        Between the two tangent planes; 0 where they touch.
    """

    what: What
    uv: tuple[float, float]
    other: tuple[float, float]
    point: tuple[float, float, float]
    angle_degrees: float

    def __str__(self) -> str:
        name = "meets itself" if self.what == "itself" else f"passes through base {self.what}"
        at = ", ".join(f"{x:.6g}" for x in self.point)
        (u, v), (s, t) = self.uv, self.other
        return (
            f"{name} at ({at}): (u, v) = ({u:.6g}, {v:.6g}) and ({s:.6g}, {t:.6g}), at {self.angle_degrees:.3g} degrees"
        )


@dataclass(frozen=True)
class Places:
    """Confirmed places, one for each crowd of hits, and how many crowds had none."""

    found: tuple[Meeting, ...]
    unconfirmed: int


def search_itself(surface: ParametricSurface, mesh: Mesh) -> Places:
    """Return where a surface meets itself."""
    hits = crossings(mesh, mesh)
    # The two may come in either order.
    both = Hits(np.concatenate([hits.first, hits.second]), np.concatenate([hits.second, hits.first]))
    place = np.min(_crowds(mesh, mesh, both).reshape(2, -1), axis=0)
    meeting = _Meeting(surface, mesh, surface, mesh)

    def is_real(first: FloatArray, second: FloatArray) -> NDArray[np.bool_]:
        at, other = _cells(mesh, first), _cells(mesh, second)
        apart = np.abs(at - other)
        for k, closed in enumerate(mesh.closed):
            if closed:
                apart[:, k] = np.minimum(apart[:, k], len((mesh.u, mesh.v)[k]) - 1 - apart[:, k])
        # Steps may end at one and the same point; a pole is one, whatever its parameters.
        return np.asarray(
            (apart.max(axis=1, initial=0) > _APART) & ~(_at_poles(mesh, at) & _at_poles(mesh, other)).any(1)
        )

    return meeting.places(hits, place, "itself", is_real)


def search_base(
    surface: ParametricSurface, mesh: Mesh, base: Continuation, w: FloatArray, what: Literal["a", "b"]
) -> tuple[Places, float]:
    """Return where a surface meets a base away from the contact, and the deflection of the base's mesh.

    The base is sampled at `w` and at the same v as the surface, and shares its vertices on the contact.
    """
    end = 0 if what == "a" else -1
    own = grid_mesh(base, w, mesh.v, closed_directions(base))
    other = joined_along(own, own.vertex[0], mesh, mesh.vertex[end])
    hits = crossings(mesh, other)
    contact = 0 if what == "a" else len(mesh.u) - 1

    def is_real(first: FloatArray, second: FloatArray) -> NDArray[np.bool_]:
        on_contact = np.abs(_cells(mesh, first)[:, 0] - contact) <= _APART
        return np.asarray(~(on_contact & (_cells(other, second)[:, 0] <= _APART)))

    meeting = _Meeting(surface, mesh, base, other)
    return meeting.places(hits, _crowds(mesh, other, hits), what, is_real), own.deflection


@dataclass(frozen=True, eq=False)
class _Meeting:
    """Two surfaces, or one with itself, and their meshes."""

    surface: ParametricSurface
    mesh: Mesh
    other: ParametricSurface
    other_mesh: Mesh

    def places(self, hits: Hits, place: IndexArray, what: What, is_real: _IsReal) -> Places:
        """Confirm some hits of each place."""
        names, place = np.unique(place, return_inverse=True)
        if not len(names):
            return Places((), 0)
        tried = max(1, min(_TRIED, _TRIED_IN_ALL // len(names)))
        chosen = np.concatenate([_some(np.flatnonzero(place == k), tried) for k in range(len(names))])[:_TRIED_IN_ALL]
        place = place[chosen]
        first, second, reached = self._steps(hits.first[chosen], hits.second[chosen])
        real = reached & is_real(first, second)
        points, angle = self.surface.evaluate(*first.T), self._angles(first, second)
        found = []
        for k in range(len(names)):
            confirmed = np.flatnonzero(real & (place == k))
            if len(confirmed):
                i = confirmed[len(confirmed) // 2]
                (u, v), (s, t), (x, y, z) = first[i].tolist(), self._own(second[i]), points[i].tolist()
                found.append(Meeting(what, (u, v), (s, t), (x, y, z), float(angle[i])))
        return Places(tuple(found), len(names) - len(found))

    def _own(self, at: FloatArray) -> tuple[float, float]:
        """Return parameters as a base has them."""
        s, t = self.other.parameters(*at) if isinstance(self.other, Continuation) else at
        return float(s), float(t)

    def _steps(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray, NDArray[np.bool_]]:
        """Take Gauss-Newton steps of least norm, and tell where both points are then one."""
        sides = ((self.surface, self.mesh), (self.other, self.other_mesh))
        widths = np.array([[end - start for start, end in s.domain] for s, _ in sides])
        points = np.concatenate([mesh.points for _, mesh in sides])
        limit = _REACHED * extent(self.mesh.points) + _ROUNDINGS * np.finfo(np.float64).eps * np.abs(points).max()
        at = [first, second]
        for step in range(_STEPS + 1):
            apart = self.surface.evaluate(*at[0].T) - self.other.evaluate(*at[1].T)
            reached = np.linalg.norm(apart, axis=-1) <= limit
            if step == _STEPS or reached.all():
                break
            slopes = [
                sign * width[k] * s.evaluate(x[:, 0], x[:, 1], 1 - k, k)
                for (s, _), x, width, sign in zip(sides, at, widths, (1, -1), strict=True)
                for k in range(2)
            ]
            inverse = np.linalg.pinv(np.stack(slopes, axis=-1), rcond=_SINGULAR)
            move = np.clip(-np.einsum("kij,kj->ki", inverse, apart), -_LONGEST, _LONGEST)
            move[reached] = 0.0
            at = [
                _within(x + width * move[:, 2 * k : 2 * k + 2], s.domain, mesh.closed)
                for k, ((s, mesh), x, width) in enumerate(zip(sides, at, widths, strict=True))
            ]
        return at[0], at[1], reached

    def _angles(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """Return the angles between the tangent planes, in degrees."""
        n, m = (
            unit_normals(s.evaluate(x[:, 0], x[:, 1], 1, 0), s.evaluate(x[:, 0], x[:, 1], 0, 1))
            for s, x in ((self.surface, first), (self.other, second))
        )
        return np.asarray(
            np.degrees(np.arctan2(np.linalg.norm(np.cross(n, m), axis=-1), np.abs(np.sum(n * m, axis=-1))))
        )


def _within(
    x: FloatArray, domain: tuple[tuple[float, float], tuple[float, float]], closed: tuple[bool, bool]
) -> FloatArray:
    """Return parameters in the domain: round again where it is closed, else at its end."""
    columns = [
        start + (column - start) % (end - start) if is_closed else np.clip(column, start, end)
        for column, (start, end), is_closed in zip(x.T, domain, closed, strict=True)
    ]
    return np.stack(columns, axis=-1)


def _cells(mesh: Mesh, x: FloatArray) -> FloatArray:
    """Return parameters counted in cells."""
    return np.stack(
        [np.interp(column, nodes, np.arange(len(nodes))) for column, nodes in zip(x.T, (mesh.u, mesh.v), strict=True)],
        axis=-1,
    )


def _at_poles(mesh: Mesh, cells: FloatArray) -> NDArray[np.bool_]:
    """Tell at which edges that are one point each place lies, shape (K, 4)."""
    (u, v), (n_u, n_v) = cells.T, (len(mesh.u) - 1, len(mesh.v) - 1)
    return np.stack([u, n_u - u, v, n_v - v], axis=-1) <= np.where(mesh.poles, _APART, -1.0)


def _crowds(mesh: Mesh, other: Mesh, hits: Hits) -> IndexArray:
    """Return for each hit which crowd it belongs to: those a few cells apart in all four parameters are in one."""
    # Sheets on each other have thousands of hits: boxes of some cells stand for what is in them.
    boxes = np.floor(np.concatenate([_cells(mesh, hits.first), _cells(other, hits.second)], axis=1) / _TOGETHER)
    boxes, box = np.unique(boxes, axis=0, return_inverse=True)
    pairs = cKDTree(boxes).query_pairs(1.5, p=np.inf, output_type="ndarray")
    near = sp.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(boxes), len(boxes)))
    return np.asarray(connected_components(near, directed=False)[1][box.ravel()], dtype=np.intp)


def _some(indices: IndexArray, count: int) -> IndexArray:
    """Return at most so many, evenly chosen."""
    return indices[np.unique(np.linspace(0, len(indices) - 1, min(count, len(indices))).round().astype(np.intp))]
