"""3dm files through rhino3dm (the extra `cad`).

openNURBS stores knots without the first and the last, and control points multiplied by their weights; periodic and
unclamped surfaces are common. Coordinates stay in the unit of the file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError, SemisplineError
from semispline.solver.io.disk import require_file
from semispline.solver.io.faces import Model, surface_from_net, without_equal_weights
from semispline.solver.io.foreign import read_apart
from semispline.solver.splines import BSplineSurface

_UNITS = {
    "Inches": "in",
    "Millimeters": "mm",
    "Feet": "ft",
    "Miles": "mi",
    "Meters": "m",
    "Kilometers": "km",
    "Mils": "mil",
    "Microns": "um",
    "Centimeters": "cm",
    "Microinches": "uin",
}
# An edge of a face follows the edge of its surface if it stays within this fraction of the size: rhino3dm shows no
# curves in parameter space, so points in space are compared with a polygon of _CHORDS chords.
_ON_EDGE = 1e-4
_CHORDS = 256


@dataclass(frozen=True, eq=False)
class RhinoFace:
    """A surface of a 3dm file.

    `net` as `rhino_worker` has it; `loops` are points on the edges that bound the face, None where it has no face.
    """

    kind: str
    net: tuple[Any, ...] | None
    loops: FloatArray | None
    where: str

    def trimmed(self) -> bool | None:
        """Whether curves cut the face out of its surface."""
        if self.loops is None:
            return False
        try:
            surface = self.surface()
        except SemisplineError:
            return None
        (u0, u1), (v0, v1) = surface.domain
        size = float(np.ptp(surface.control_points.reshape(-1, 3), axis=0).max())
        u, v = np.linspace(u0, u1, _CHORDS + 1), np.linspace(v0, v1, _CHORDS + 1)
        sides = [surface.evaluate(u, np.full_like(u, v_end)) for v_end in (v0, v1)]
        sides += [surface.evaluate(np.full_like(v, u_end), v) for u_end in (u0, u1)]
        distance = np.min([_distance_to_polygon(self.loops, side) for side in sides], axis=0)
        return bool(distance.max() > _ON_EDGE * size)

    def surface(self) -> BSplineSurface:
        """Return the exact, clamped (rational) B-spline surface, without trimming.

        Raises
        ------
        FileError
            A surface that has no B-spline form.
        KnotError
            Knots that the surface class refuses.
        """
        try:
            return self._surface
        except SemisplineError as error:
            raise type(error)(f"{self.where}: {error}") from None

    @cached_property
    def _surface(self) -> BSplineSurface:
        if self.net is None:
            raise FileError("openNURBS knows no B-spline form of it; convert it to NURBS where it was drawn")
        degree_u, degree_v, knots_u, knots_v, net, rational = self.net
        weights: FloatArray | None = None
        if rational:
            weights = without_equal_weights(net[..., 3])
            net = net[..., :3] / net[..., 3:]
        return surface_from_net(degree_u, degree_v, knots_u, knots_v, net[..., :3], weights)


def open_3dm(path: str | Path) -> Model:
    """Open a 3dm file, read by a process of its own: objects in file order, inside a Brep its surfaces.

    Raises
    ------
    FileError
        As `foreign.read_apart`, or the extra `cad` is not installed.
    ComputationError
        As `foreign.read_apart`.
    """
    require_file(path)
    _library(path)
    return _model(path, read_apart(path, "rhino_worker", "openNURBS"))


def read_3dm(path: str | Path) -> Model:
    """Read a 3dm file in this process, as `open_3dm`, which survives what is damaged.

    Raises
    ------
    FileError
        Missing, not readable by openNURBS, or the extra `cad` is not installed.
    """
    require_file(path)
    _library(path)
    from semispline.solver.io.rhino_worker import work

    return _model(path, work(str(path)))


def _model(path: str | Path, found: tuple[str, Sequence[Any], Mapping[str, int]]) -> Model:
    unit, found_faces, others = found
    faces = [RhinoFace(kind, net, loops, f"{path}#{k}") for k, (kind, net, loops) in enumerate(found_faces)]
    return Model(str(path), _UNITS.get(unit), faces, others)


def write_3dm(path: Path, surface: BSplineSurface, unit: str) -> None:
    """Write a 3dm file with one surface to a path of that suffix.

    Raises
    ------
    FileError
        openNURBS refuses, or the extra `cad` is not installed.
    """
    rhino3dm = _library(path.suffix)
    n_u, n_v = surface.control_points.shape[:2]
    rational = surface.weights is not None
    spline = rhino3dm.NurbsSurface.Create(3, rational, surface.degree_u + 1, surface.degree_v + 1, n_u, n_v)
    if spline is None:
        raise FileError(f"3dm: openNURBS cannot make a surface of degrees {surface.degree_u}, {surface.degree_v}")
    for target, knots in ((spline.KnotsU, surface.knots_u), (spline.KnotsV, surface.knots_v)):
        for i, knot in enumerate(knots[1:-1]):
            target[i] = float(knot)
    weights = np.ones((n_u, n_v)) if surface.weights is None else surface.weights
    for i in range(n_u):
        for j in range(n_v):
            w = float(weights[i, j])
            x, y, z = (float(c) * w for c in surface.control_points[i, j])
            spline.Points[(i, j)] = rhino3dm.Point4d(x, y, z, w)
    file = rhino3dm.File3dm()
    name = next(name for name, known in _UNITS.items() if known == unit)
    file.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, name)
    file.Objects.AddSurface(spline)
    if not file.Write(str(path), 0):
        raise FileError("3dm: openNURBS could not write the file; check the disk, or try .json or .step")


def _library(what: str | Path) -> Any:
    try:
        import rhino3dm
    except ImportError:
        raise FileError(f"{what}: 3dm needs rhino3dm; run: pip install 'semispline[cad]'") from None
    return rhino3dm


def _distance_to_polygon(points: FloatArray, polygon: FloatArray) -> FloatArray:
    start, step = polygon[:-1], np.diff(polygon, axis=0)
    length = np.maximum(np.sum(step**2, axis=1), np.finfo(np.float64).tiny)
    t = np.clip(np.einsum("ksd,sd->ks", points[:, None] - start, step) / length, 0, 1)
    return np.asarray(np.linalg.norm(points[:, None] - start - t[..., None] * step, axis=2).min(axis=1))
