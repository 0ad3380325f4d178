"""Parts made by Open CASCADE for tests of edges and places, and their tables without a file."""

import math
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_Copy,
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.BRepTools import BRepTools
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Dir2d, gp_Pnt, gp_Pnt2d, gp_Vec
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Shell

from semispline.solver.io.occ import OccFace, _faces
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.occ_edges import edge_tables


def graph_of(shape, path="part.brep"):
    """The edges of a shape that stands in memory."""
    faces = [OccFace(face, f"{path}#{n}") for n, face in enumerate(_faces(shape))]
    return EdgeGraph(path, None, *edge_tables(faces), {})


def written(shape, path: Path):
    BRepTools.Write_s(shape, str(path))
    return path


def compound(faces):
    shape, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(shape)
    for face in faces:
        builder.Add(shape, face)
    return shape


def without(shape, number):
    """The other faces, which still share their edges: an open shell."""
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    for n, face in enumerate(_faces(shape)):
        if n != number:
            builder.Add(shell, face)
    return shell


def unsewn(shape):
    """Each face with edges of its own."""
    return compound(BRepBuilderAPI_Copy(face).Shape() for face in _faces(shape))


def with_moved_face(shape, number, trsf):
    """Each face with edges of its own, one of them elsewhere."""
    copies = [BRepBuilderAPI_Copy(face).Shape() for face in _faces(shape)]
    copies[number] = moved(copies[number], trsf)
    return compound(copies)


def reordered(shape, order):
    faces = list(_faces(shape))
    return compound(faces[n] for n in order)


def moved(shape, trsf):
    return BRepBuilderAPI_Transform(shape, trsf, True).Shape()


def fillet(shape, radius, wanted):
    """Round the edges whose middle point and direction `wanted` accepts."""
    maker = BRepFilletAPI_MakeFillet(shape)
    for edge in edges_of_shape(shape):
        curve, point, along = BRepAdaptor_Curve(edge), gp_Pnt(), gp_Vec()
        curve.D1((curve.FirstParameter() + curve.LastParameter()) / 2, point, along)
        if wanted(np.array([point.X(), point.Y(), point.Z()]), np.array([along.X(), along.Y(), along.Z()])):
            maker.Add(radius, edge)
    maker.Build()
    return maker.Shape()


def rounded_box(upright=3.0, top=1.5):
    """A box of 40 x 30 x 20 with its upright edges rounded, then those round its top."""
    box = BRepPrimAPI_MakeBox(40.0, 30.0, 20.0).Shape()
    box = fillet(box, upright, lambda _, along: abs(along[2]) > 0.5)
    return fillet(box, top, lambda point, _: point[2] > 19.99)


def edges_of_shape(shape):
    found = IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
    TopExp.MapShapes_s(shape, TopAbs_ShapeEnum.TopAbs_EDGE, found)
    return [TopoDS.Edge(found.FindKey(i + 1)) for i in range(found.Extent())]


def polygon(geometry, corners):
    """A face bounded by straight lines in the parameters, anticlockwise, of a length of 1 each in their own."""
    wire = BRepBuilderAPI_MakeWire()
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        step = b[0] - a[0], b[1] - a[1]
        line = Geom2d_Line(gp_Pnt2d(*a), gp_Dir2d(*step))
        edge = BRepBuilderAPI_MakeEdge(line, geometry, 0.0, math.hypot(*step)).Edge()
        BRepLib.BuildCurves3d_s(edge)
        wire.Add(edge)
    return BRepBuilderAPI_MakeFace(geometry, wire.Wire()).Face()
