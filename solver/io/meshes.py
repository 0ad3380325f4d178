"""Triangle meshes of surfaces through pyvista (the extra `view`): samples on a grid with exact normals."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError
from semispline.solver.io.silence import silenced
from semispline.solver.judge import LocalGeometry, local_geometry_grid
from semispline.solver.splines import Surface

# Samples along each parameter of an exported mesh: a quarter circle is met to 1e-5 of its radius.
_SAMPLES = 160
# Twice the area of a triangle, over the square of the extent, that is rounding of three points in a line.
_NO_AREA = 1e-15
# Where there is no normal, that so far towards the middle of the domain is taken.
INSIDE = 1e-3


def write_mesh(path: Path, surfaces: Sequence[Surface]) -> None:
    """Write one triangle mesh of all surfaces; the suffix is .obj, .stl, .ply, .gltf or .glb.

    Raises
    ------
    FileError
        pyvista is not installed, or VTK could not write the file.
    """
    pyvista = pyvista_module(path.suffix)
    meshes = []
    for surface in surfaces:
        geometry, normal = sampled(surface, _SAMPLES)
        triangles = grid_triangles(*normal.shape[:2])
        meshes.append(triangle_mesh(geometry.point.reshape(-1, 3), normal.reshape(-1, 3), triangles))
    mesh = meshes[0] if len(meshes) == 1 else pyvista.merge(meshes, merge_points=False)
    with silenced(1, 2):
        if path.suffix.lower() in (".gltf", ".glb"):
            _write_gltf(path, pyvista.MultiBlock([pyvista.MultiBlock([mesh])]))
        else:
            mesh.save(str(path))


def pyvista_module(what: str | Path) -> Any:
    """Return pyvista.

    Raises
    ------
    FileError
        Not installed; the message says how to install it and opens with `what` needs it.
    """
    try:
        import pyvista
    except ImportError:
        raise FileError(f"{what}: pictures and meshes need pyvista; run: pip install 'semispline[view]'") from None
    return pyvista


def sampled(surface: Surface, count: int) -> tuple[LocalGeometry, FloatArray]:
    """Return the local geometry on a grid that holds every breakpoint and about `count` samples each way, and normals.

    Returns
    -------
    LocalGeometry
        Arrays lead with (len(u), len(v)).
    ndarray, shape (len(u), len(v), 3)
        Unit normals; where the surface is degenerate, those a little towards the middle of the domain.
    """
    u, v = (_samples(breaks, count) for breaks in surface.breakpoints)
    geometry = local_geometry_grid(surface, u, v)
    normal = geometry.normal
    missing = ~geometry.regular
    if missing.any():
        inside = [x + INSIDE * ((x[0] + x[-1]) / 2 - x) for x in (u, v)]
        normal = with_normals(normal, missing, local_geometry_grid(surface, *inside).normal)
    return geometry, normal


def with_normals(normal: FloatArray, missing: NDArray[np.bool_], nearby: FloatArray) -> FloatArray:
    """Return normals, where they are missing those nearby; up where there is none either."""
    filled = np.where(np.isfinite(nearby), nearby, (0.0, 0.0, 1.0))
    return np.where(missing[..., None], filled, normal)


def grid_triangles(n_u: int, n_v: int) -> NDArray[np.int64]:
    """Return the triangles of a grid, shape (T, 3)."""
    corner = np.arange(n_u * n_v).reshape(n_u, n_v)
    a, b, c, d = (x.ravel() for x in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def triangle_mesh(points: FloatArray, normals: FloatArray, triangles: NDArray[np.int64]) -> Any:
    """Return the `pyvista.PolyData` of triangles, without those of no area."""
    pyvista = pyvista_module("mesh")
    sides = points[triangles[:, 1:]] - points[triangles[:, :1]]
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    triangles = triangles[area > _NO_AREA * np.ptp(points, axis=0).max() ** 2]
    if not len(triangles):
        raise FileError("surface: has no area, so there is no mesh of it; write .json, .step or .3dm")
    faces = np.hstack([np.full((len(triangles), 1), 3), triangles])
    mesh = pyvista.PolyData(points, faces.ravel())
    mesh.point_data["Normals"] = normals
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def _samples(breaks: FloatArray, count: int) -> FloatArray:
    each = max(2, -(-count // (len(breaks) - 1)))
    inner = np.linspace(0, 1, each, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def _write_gltf(path: Path, blocks: Any) -> None:
    from vtkmodules.vtkIOGeometry import vtkGLTFWriter

    writer = vtkGLTFWriter()
    writer.SetFileName(str(path))
    writer.SetInputDataObject(blocks)
    # One file: a .gltf would otherwise leave its numbers in another one beside it.
    writer.InlineDataOn()
    writer.SaveNormalOn()
    writer.Write()
