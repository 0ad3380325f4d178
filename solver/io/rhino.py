"""3dm files through rhino3dm (the extra `cad`).

openNURBS stores knots without the first and the last, and control points multiplied by their weights; periodic and
unclamped surfaces are common. Coordinates stay in the unit of the file.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError, SemisplineError
from semispline.solver.io.disk import require_file
from semispline.solver.io.face_boundary import (
    FaceBoundary,
    cubic_pieces,
    distances,
    joined,
    natural_boundary,
    points_on,
)
from semispline.solver.io.faces import Model, surface_from_net, without_equal_weights
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
# An edge of a face follows the edge of its surface if it stays within this fraction of the size. rhino3dm shows no
# tolerances of edges, which other programs leave far above that of the file; nor curves in parameter space, so that
# nothing tells on which side of a seam the face lies.
_ON_EDGE = 3e-4


@dataclass(frozen=True, eq=False)
class RhinoFace:
    """A surface of a 3dm file, and the face of a Brep that lies on it; None where there is none."""

    source: Any
    where: str
    brep: Any = None
    face: Any = None

    @property
    def kind(self) -> str:
        """What the file holds; rhino3dm tells no more of the surfaces of a Brep."""
        return {"NurbsSurface": "B-spline", "Extrusion": "extrusion", "Surface": "surface"}.get(
            type(self.source).__name__, type(self.source).__name__
        )

    def trimmed(self) -> bool | None:
        """Whether curves cut the face out of its surface."""
        if self.face is None:
            return False
        try:
            edges, natural = self._edges, natural_boundary(self.surface())
        except SemisplineError:
            return None
        return bool((distances(points_on(edges), natural)[0] > edges.tolerance.max(initial=0.0)).any())

    def boundary(self) -> FaceBoundary | None:
        """Return the edges of the face, as `Face` says."""
        return self._edges if self.trimmed() else None

    @cached_property
    def _edges(self) -> FaceBoundary:
        size = float(np.ptp(self.surface().control_points.reshape(-1, 3), axis=0).max())
        # A trim along a singular side has no edge; a seam has two trims.
        trims = [self.face.Loops[i].Trims for i in range(len(self.face.Loops))]
        numbers = {loop[k].EdgeIndex for loop in trims for k in range(len(loop))} - {-1}
        parts = []
        for number in sorted(numbers):
            curve = self.brep.Edges[number].ToNurbsCurve()
            knots = np.array([curve.Knots[i] for i in range(len(curve.Knots))])
            breaks = np.unique(np.clip(knots, curve.Domain.T0, curve.Domain.T1))
            parts.append((*cubic_pieces(_evaluator(curve), breaks, _ON_EDGE * size), ""))
        return joined(parts)

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
        spline = self.source.ToNurbsSurface()
        if spline is None:
            raise FileError("openNURBS knows no B-spline form of it; convert it to NURBS where it was drawn")
        n_u, n_v = spline.Points.CountU, spline.Points.CountV
        points = [spline.Points[(i, j)] for i in range(n_u) for j in range(n_v)]
        net = np.array([(p.X, p.Y, p.Z, p.W) for p in points]).reshape(n_u, n_v, 4)
        weights: FloatArray | None = None
        if spline.IsRational:
            weights = without_equal_weights(net[..., 3])
            net = net[..., :3] / net[..., 3:]
        knots_u, knots_v = _with_ends(spline.KnotsU), _with_ends(spline.KnotsV)
        return surface_from_net(spline.Degree(0), spline.Degree(1), knots_u, knots_v, net[..., :3], weights)


def open_3dm(path: str | Path, bounded: Collection[int] = ()) -> Model:
    """Open a 3dm file: objects in file order, inside a Brep its surfaces; other objects are left out.

    Boundaries are read when they are asked for, whichever faces are `bounded`.

    Raises
    ------
    FileError
        Missing, not a 3dm file, or the extra `cad` is not installed.
    """
    require_file(path)
    rhino3dm = _library(path)
    file = rhino3dm.File3dm.Read(str(path))
    if file is None:
        raise FileError(f"{path}: not a 3dm file that openNURBS can read")
    found: list[tuple[Any, Any, Any]] = []
    for item in file.Objects:
        geometry = item.Geometry
        if isinstance(geometry, rhino3dm.Brep):
            found += _brep_surfaces(geometry)
        elif isinstance(geometry, rhino3dm.Surface):
            found.append((geometry, None, None))
    faces = [RhinoFace(source, f"{path}#{number}", *face) for number, (source, *face) in enumerate(found)]
    return Model(str(path), _UNITS.get(file.Settings.ModelUnitSystem.name), faces)


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


def _with_ends(knots: Sequence[float]) -> FloatArray:
    """Return the full vector; the two knots that openNURBS leaves out take part in no span of the domain."""
    inner = [knots[i] for i in range(len(knots))]
    return np.array([inner[0], *inner, inner[-1]])


def _brep_surfaces(brep: Any) -> list[tuple[Any, Any, Any]]:
    """Return surfaces of a Brep, itself, and the face that lies on each.

    rhino3dm does not say which face lies on which surface: they are matched by domain and by a few points.
    """
    faces = [brep.Faces[i] for i in range(len(brep.Faces))]
    waiting = {i: _fingerprint(face.UnderlyingSurface()) for i, face in enumerate(faces)}
    found: list[tuple[Any, Any, Any]] = []
    for k in range(len(brep.Surfaces)):
        surface = brep.Surfaces[k]
        wanted = _fingerprint(surface)
        match = next((i for i, other in waiting.items() if other == wanted), None)
        if match is not None:
            del waiting[match]
        found.append((surface, brep, None if match is None else faces[match]))
    return found


def _fingerprint(surface: Any) -> tuple[float, ...]:
    u, v = surface.Domain(0), surface.Domain(1)
    points = [surface.PointAt(u.T0 + s * (u.T1 - u.T0), v.T0 + t * (v.T1 - v.T0)) for s, t in ((0.2, 0.3), (0.7, 0.6))]
    return (u.T0, u.T1, v.T0, v.T1, *(c for p in points for c in (p.X, p.Y, p.Z)))


def _evaluator(curve: Any) -> Callable[[FloatArray], tuple[FloatArray, FloatArray]]:
    def evaluate(parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        found = [(curve.PointAt(t), curve.DerivativeAt(t, 1)[1]) for t in parameters.tolist()]
        values = np.array([(p.X, p.Y, p.Z, d.X, d.Y, d.Z) for p, d in found]).reshape(-1, 6)
        return values[:, :3], values[:, 3:]

    return evaluate
