"""STEP, IGES and BREP files written through Open CASCADE (the extra `cad`).

Numbers are written with 17 significant digits, where the kernel's own writers stop at 12 (STEP) and 10 (IGES): a G2
contact would be lost with the rest.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np

from semispline.solver.errors import FileError, SemisplineError
from semispline.solver.io.faces import MILLIMETRES
from semispline.solver.io.occ_kernel import UNIT_NAMES, first_line, require_kernel, system_unit
from semispline.solver.io.silence import silenced
from semispline.solver.splines import BSplineSurface

# 17 significant digits; the point that both formats ask for comes with the exponent.
_REAL = "%.16E"
# Geom_BSplineSurface::MaxDegree().
_HIGHEST = 25


def occ_bytes(surfaces: Sequence[BSplineSurface], suffix: str, unit: str) -> bytes:
    """Return the content of a STEP, IGES or BREP file with a face for each surface, untrimmed, in that unit.

    Raises
    ------
    FileError
        Open CASCADE refuses a surface, or the extra `cad` is not installed.
    """
    require_kernel(suffix)
    for surface, name in product(surfaces, ("u", "v")):
        degree = surface.degree_u if name == "u" else surface.degree_v
        if degree > _HIGHEST:
            raise FileError(
                f"{suffix}: the surface has degree {degree} in {name}, and Open CASCADE takes at most {_HIGHEST}; "
                "write .json or .3dm, or ask for a lower continuity"
            )
    write = _step_bytes if suffix in (".step", ".stp") else _iges_bytes if suffix in (".iges", ".igs") else _brep_bytes
    try:
        with silenced(1, 2):
            return write([_face(surface) for surface in surfaces], unit)
    except SemisplineError:
        raise
    except Exception as error:
        raise FileError(
            f"{suffix}: Open CASCADE cannot write the surface ({first_line(error)}); try .json or .3dm"
        ) from None


def occ_surface(surface: BSplineSurface) -> Any:
    """Return the `Geom_BSplineSurface` with the same net, knots and weights."""
    from OCP.collections import Array1_double, Array1_int, Array2_double, Array2_gp_Pnt
    from OCP.Geom import Geom_BSplineSurface
    from OCP.gp import gp_Pnt

    n_u, n_v = surface.control_points.shape[:2]
    poles, weights = Array2_gp_Pnt(1, n_u, 1, n_v), Array2_double(1, n_u, 1, n_v)
    for i in range(n_u):
        for j in range(n_v):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, surface.control_points[i, j])))
            weights.SetValue(i + 1, j + 1, 1.0 if surface.weights is None else float(surface.weights[i, j]))

    def filled(array: Any, values: Sequence[Any]) -> Any:
        for i, value in enumerate(values):
            array.SetValue(i + 1, value)
        return array

    arguments = []
    for knots in (surface.knots_u, surface.knots_v):
        values, counts = np.unique(knots, return_counts=True)
        arguments.append(filled(Array1_double(1, len(values)), values.tolist()))
        arguments.append(filled(Array1_int(1, len(counts)), counts.tolist()))
    knots_u, counts_u, knots_v, counts_v = arguments
    degrees = (surface.degree_u, surface.degree_v)
    if surface.weights is None:
        return Geom_BSplineSurface(poles, knots_u, knots_v, counts_u, counts_v, *degrees)
    return Geom_BSplineSurface(poles, weights, knots_u, knots_v, counts_u, counts_v, *degrees)


def _face(surface: BSplineSurface) -> Any:
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace

    size = float(np.ptp(surface.control_points.reshape(-1, 3), axis=0).max())
    # An edge shorter than the tolerance counts as a point; the kernel's default suits sizes from 1 on.
    maker = BRepBuilderAPI_MakeFace(occ_surface(surface), min(1e-7, 1e-7 * size))
    if not maker.IsDone():
        raise FileError("Open CASCADE cannot make a face of the surface; try .json or .3dm")
    return maker.Face()


def _step_bytes(faces: Sequence[Any], unit: str) -> bytes:
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    with system_unit(unit):
        writer = STEPControl_Writer()
        for face in faces:
            writer.Transfer(face, STEPControl_StepModelType.STEPControl_AsIs)
        return step_text(writer.Model())


def step_text(model: Any) -> bytes:
    """Return a translated STEP model as text, with 17 digits."""
    from OCP.StepData import StepData_StepWriter
    from OCP.STEPEdit import STEPEdit

    text = StepData_StepWriter(model)
    text.FloatWriter().SetFormat(_REAL)
    text.SendModel(STEPEdit.Protocol_s())
    return _printed(text)


def _iges_bytes(faces: Sequence[Any], unit: str) -> bytes:
    from OCP.IGESControl import IGESControl_Writer
    from OCP.IGESData import IGESData_IGESWriter
    from OCP.IGESSelect import IGESSelect_WorkLibrary
    from OCP.TCollection import TCollection_HAsciiString

    writer = IGESControl_Writer(UNIT_NAMES[unit], 0)
    model = writer.Model()
    header = model.GlobalSection()
    # This translator asks the model for the system's unit, and not the static that the one for STEP asks.
    header.SetCascadeUnit(MILLIMETRES[unit])
    # The kernel would enter the login name of whoever runs this.
    header.SetAuthorName(TCollection_HAsciiString("semispline"))
    model.SetGlobalSection(header)
    if not all(writer.AddShape(face) for face in faces):
        raise FileError("Open CASCADE cannot translate the surface to IGES; try .step, .json or .3dm")
    writer.ComputeModel()
    text = IGESData_IGESWriter(model)
    text.FloatWriter().SetFormat(_REAL)
    text.SendModel(IGESSelect_WorkLibrary.DefineProtocol_s())
    return _printed(text)


def _brep_bytes(faces: Sequence[Any], unit: str) -> bytes:
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    shape = faces[0]
    if len(faces) > 1:
        shape, builder = TopoDS_Compound(), BRep_Builder()
        builder.MakeCompound(shape)
        for face in faces:
            builder.Add(shape, face)
    return brep_bytes(shape)


def brep_bytes(shape: Any) -> bytes:
    """Return a shape as the content of a BREP file."""
    from OCP.BRepTools import BRepTools

    stream = io.BytesIO()
    BRepTools.Write_s(shape, stream)
    return stream.getvalue()


def _printed(text: Any) -> bytes:
    stream = io.BytesIO()
    if not text.Print(stream) or not stream.getvalue():
        raise FileError("Open CASCADE wrote nothing; try .json or .3dm")
    return stream.getvalue()
