"""Surfaces and trimmed faces as they are drawn: triangles whose corners have exact points, normals and curvatures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import OptionError
from semispline.solver.io import INSIDE, grid_triangles, sampled, triangle_mesh, with_normals
from semispline.solver.judge import LocalGeometry, local_geometry
from semispline.solver.splines import Surface
from semispline.solver.topology import FaceMesh

# Samples along each parameter, for one surface and at the least; and over all surfaces.
_FINEST, _COARSEST, _TOTAL = 240, 24, 600_000
# Sides of the triangles of trimmed faces, of the extent of all; triangles over all of them.
_LONGEST, _TRIANGLES = 1 / 120, 400_000


@dataclass(frozen=True, eq=False)
class Sampled:
    """A surface in triangles.

    Attributes
    ----------
    geometry : LocalGeometry
        Arrays lead with (n_u, n_v) on a grid, with (K,) elsewhere.
    normal : ndarray, shape (n_u, n_v, 3) or (K, 3)
        Unit normals, everywhere.
    own : ndarray of int, shape (T, 3), optional
        The triangles where there is no grid.
    """

    geometry: LocalGeometry
    normal: FloatArray
    own: NDArray[np.int64] | None = None

    @cached_property
    def points(self) -> FloatArray:
        """All of them, shape (K, 3)."""
        return self.geometry.point.reshape(-1, 3)

    @cached_property
    def triangles(self) -> NDArray[np.int64]:
        """Their corners, shape (T, 3)."""
        return grid_triangles(*self.geometry.point.shape[:2]) if self.own is None else self.own

    @cached_property
    def area(self) -> FloatArray:
        """What each point stands for: a third of the triangles around it, shape (K,)."""
        triangles, times = self.triangles, 1
        if self.own is None:
            # By both diagonals of each cell: the same whichever way a surface runs.
            turned = np.arange(len(self.points)).reshape(self.geometry.point.shape[:2])[::-1].ravel()
            triangles, times = np.concatenate([triangles, turned[triangles]]), 2
        a, b, c = (self.points[corner] for corner in triangles.T)
        third = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6 / times
        return np.bincount(triangles.ravel(), np.repeat(third, 3), len(self.points)).astype(np.float64)

    @property
    def borders(self) -> list[FloatArray]:
        """The four sides of a grid."""
        p = self.geometry.point
        return [p[0], p[-1], p[:, 0], p[:, -1]] if self.own is None else []

    def polydata(self) -> Any:
        """Return it for pyvista, with its normals."""
        return triangle_mesh(self.points, self.normal.reshape(-1, 3), self.triangles)


def sample(surfaces: Sequence[Surface], meshes: Sequence[FaceMesh | None]) -> list[Sampled]:
    """Sample surfaces, whole where there is no mesh.

    Raises
    ------
    OptionError
        All points coincide.
    """
    count = int(np.clip(np.sqrt(_TOTAL / len(surfaces)), _COARSEST, _FINEST))
    coarse = [
        surface.evaluate(*mesh.within(surface))
        if mesh is not None
        else surface.evaluate_grid(*surface.breakpoints).reshape(-1, 3)
        for surface, mesh in zip(surfaces, meshes, strict=True)
    ]
    extent = float(np.ptp(np.concatenate(coarse), axis=0).max())
    most = _TRIANGLES // len(surfaces)
    found = []
    for surface, mesh in zip(surfaces, meshes, strict=True):
        if mesh is None:
            found.append(Sampled(*sampled(surface, count)))
            continue
        fine = mesh.finer(surface, _LONGEST * extent, most)
        u, v = fine.within(surface)
        geometry = local_geometry(surface, u, v)
        normal, missing = geometry.normal, ~geometry.regular
        if missing.any():
            nearby = local_geometry(surface, *_towards_middle(surface, u, v)).normal
            normal = with_normals(normal, missing, nearby)
        found.append(Sampled(geometry, normal, fine.triangles))
    if extent_of(found) == 0:
        raise OptionError("surfaces: all points coincide, so there is nothing to draw; give a surface with an extent")
    return found


def _towards_middle(surface: Surface, u: FloatArray, v: FloatArray) -> list[FloatArray]:
    middles = [(low + high) / 2 for low, high in surface.domain]
    return [x + INSIDE * (middle - x) for x, middle in zip((u, v), middles, strict=True)]


def all_points(samples: Sequence[Sampled]) -> FloatArray:
    """Return the points of all surfaces, shape (K, 3)."""
    return np.concatenate([item.points for item in samples])


def extent_of(samples: Sequence[Sampled]) -> float:
    """Return the largest extent of all surfaces along an axis."""
    return float(np.ptp(all_points(samples), axis=0).max())
