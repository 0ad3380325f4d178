"""What the gate measures of shapes: volumes, areas, and where parts of faces cross each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.gate_report import Point
from semispline.solver.topology.occ_shapes import forward, parts, point_of

# Of the volume under each face.
_VOLUME_ERROR = 1e-6


def crossings(faces: list[Any]) -> list[list[tuple[Any, Point]]]:
    """Return pairs of parts of some faces that cross where they share nothing, each with a place."""
    from OCP.BOPAlgo import BOPAlgo_ArgumentAnalyzer
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for face in faces:
        builder.Add(compound, face)
    analyzer = BOPAlgo_ArgumentAnalyzer()
    analyzer.SetShape1(compound)
    analyzer.ArgumentTypeMode = True
    analyzer.SelfInterMode = True
    for mode in (
        "SmallEdgeMode",
        "RebuildFaceMode",
        "TangentMode",
        "MergeVertexMode",
        "MergeEdgeMode",
        "ContinuityMode",
    ):
        setattr(analyzer, mode, False)
    analyzer.Perform()
    if not analyzer.HasFaulty():
        return []
    found = []
    for result in analyzer.GetCheckResult():
        shapes = list(result.GetFaultyShapes1())
        found.append([(shape, triple(middle_of(shape))) for shape in shapes] or [(compound, (0.0, 0.0, 0.0))])
    return found


def volume_of(shape: Any, about: FloatArray) -> float:
    """Return the volume that the faces of a shape enclose; of an open one what lies between them and a point."""
    from OCP.BRepGProp import BRepGProp_Domain, BRepGProp_Face, BRepGProp_Vinert
    from OCP.gp import gp_Pnt

    point, found = gp_Pnt(*about.tolist()), 0.0
    for face in parts(shape, "FACE"):
        # For a whole shape the kernel takes a point of its own, and another one after a vertex has moved.
        one = BRepGProp_Vinert()
        one.SetLocation(point)
        # Without a bound of the error it takes a fixed number of places in each face, whatever knots that has.
        one.Perform(BRepGProp_Face(face), BRepGProp_Domain(face), _VOLUME_ERROR)
        found += float(one.Mass())
    return found


def area_of(face: Any) -> tuple[float, FloatArray]:
    """Return the area of a face and its centre."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties)
    return float(properties.Mass()), np.array(properties.CentreOfMass().Coord())


def middle_of(shape: Any) -> FloatArray:
    """Return the mean of the vertices of a shape; NaN where it has none."""
    vertices = parts(forward(shape), "VERTEX")
    return np.mean([point_of(x) for x in vertices], axis=0) if vertices else np.full(3, np.nan)


def triple(point: FloatArray) -> Point:
    """Return a point as three numbers."""
    x, y, z = np.asarray(point, dtype=np.float64).tolist()
    return x, y, z
