"""3dm files through rhino3dm (the extra `cad`).

openNURBS stores knots without the first and the last, and control points multiplied by their weights; periodic and
unclamped surfaces are common. Coordinates stay in the unit of the file.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
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
from semispline.solver.io.foreign import read_apart
from semispline.solver.splines import BSplineSurface, basis_matrix, derivative_points

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
    """A surface of a 3dm file.

    `net` and `trims` as `rhino_worker` has them; `curves` lie along the edges that bound the face, None where it has no
    face.
    """

    kind: str
    net: tuple[Any, ...] | None
    curves: Sequence[tuple[int, FloatArray, FloatArray]] | None
    where: str
    trims: tuple[bool, Sequence[Sequence[tuple[int, int, bool]]]] | None = None

    def trimmed(self) -> bool | None:
        """Whether curves cut the face out of its surface."""
        if self.curves is None:
            return False
        try:
            edges, natural = self._edges, natural_boundary(self.surface())
        except SemisplineError:
            return None
        return bool((distances(points_on(edges), natural)[0] > edges.tolerance.max(initial=0.0)).any())

    def boundary(self) -> FaceBoundary | None:
        """Return the edges of the face, as `Face` says."""
        return self._edges if self.trimmed() else None

    def deviation(self) -> None:
        """Say nothing: openNURBS approximates nothing."""

    @cached_property
    def _edges(self) -> FaceBoundary:
        size = float(np.ptp(self.surface().control_points.reshape(-1, 3), axis=0).max())
        parts = []
        for degree, knots, net in self.curves or ():
            breaks = np.unique(knots[degree : len(knots) - degree])
            parts.append((*cubic_pieces(curve_evaluator(degree, knots, net), breaks, _ON_EDGE * size), ""))
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
        if self.net is None:
            raise FileError("openNURBS knows no B-spline form of it; convert it to NURBS where it was drawn")
        degree_u, degree_v, knots_u, knots_v, net, rational = self.net
        weights: FloatArray | None = None
        if rational:
            weights = without_equal_weights(net[..., 3])
            net = net[..., :3] / net[..., 3:]
        return surface_from_net(degree_u, degree_v, knots_u, knots_v, net[..., :3], weights)


def open_3dm(path: str | Path, bounded: Collection[int] = ()) -> Model:
    """Open a 3dm file, read by a process of its own: objects in file order, inside a Brep its surfaces.

    Boundaries are read when they are asked for, whichever faces are `bounded`.

    Raises
    ------
    FileError
        As `foreign.read_apart`, or the extra `cad` is not installed.
    ComputationError
        As `foreign.read_apart`.
    """
    require_file(path)
    _library(path)
    return _model(path, read_apart(path, "semispline.solver.io.rhino_worker", "openNURBS"))


def read_3dm(path: str | Path) -> Model:
    """Read a 3dm file in this process, as `open_3dm`, which survives what is damaged.

    Raises
    ------
    FileError
        Missing, not readable by openNURBS, or the extra `cad` is not installed.
    """
    require_file(path)
    _library(path)
    # rhino3dm waits until a 3dm file is read in this process.
    from semispline.solver.io.rhino_worker import work

    return _model(path, work(str(path)))


def _model(path: str | Path, found: tuple[str, Sequence[Any], Mapping[str, int]]) -> Model:
    unit, surfaces, others = found
    faces = [
        RhinoFace(kind, net, curves, f"{path}#{k}", trims) for k, (kind, net, curves, trims) in enumerate(surfaces)
    ]
    return Model(str(path), _UNITS.get(unit), faces, others)


def write_3dm(path: Path, surfaces: Sequence[BSplineSurface], unit: str) -> None:
    """Write a 3dm file with some surfaces to a path of that suffix.

    Raises
    ------
    FileError
        openNURBS refuses, or the extra `cad` is not installed.
    """
    rhino3dm = _library(path.suffix)
    file = rhino3dm.File3dm()
    name = next(name for name, known in _UNITS.items() if known == unit)
    file.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, name)
    for surface in surfaces:
        file.Objects.AddSurface(nurbs_surface(rhino3dm, surface))
    if not file.Write(str(path), 0):
        raise FileError("3dm: openNURBS could not write the file; check the disk, or try .json or .step")


def nurbs_surface(rhino3dm: Any, surface: BSplineSurface) -> Any:
    """Return a surface as openNURBS has it."""
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
    return spline


def _library(what: str | Path) -> Any:
    try:
        import rhino3dm
    except ImportError:
        raise FileError(f"{what}: 3dm needs rhino3dm; run: pip install 'semispline[cad]'") from None
    return rhino3dm


def curve_evaluator(
    degree: int, knots: FloatArray, net: FloatArray
) -> Callable[[FloatArray], tuple[FloatArray, FloatArray]]:
    """Return a function to points and derivatives of a rational curve with control points (w x, w y, w z, w)."""
    slopes = derivative_points(degree, knots, net)

    def evaluate(parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        value = basis_matrix(degree, knots, parameters) @ net
        slope = basis_matrix(degree - 1, knots[1:-1], parameters) @ slopes
        points = value[:, :3] / value[:, 3:]
        return points, (slope[:, :3] - points * slope[:, 3:]) / value[:, 3:]

    return evaluate
