"""A flat face with an edge that has a corner: kernels allow it, and bands have to be cut there."""

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.collections import Array1_double, Array1_gp_Pnt, Array1_int
from OCP.Geom import Geom_BSplineCurve
from OCP.gp import gp_Pnt


def angular_face(height=0.0, grown=0.0):
    """A square of size 4 at a height, whose sides y = -grown and x = 4 + grown are one edge; both move outwards."""
    far = 4.0 + grown
    points = [(0.0, -grown), (far, -grown), (far, 4.0)]
    poles, knots, counts = Array1_gp_Pnt(1, 3), Array1_double(1, 3), Array1_int(1, 3)
    for k, (x, y) in enumerate(points):
        poles.SetValue(k + 1, gp_Pnt(x, y, height))
        knots.SetValue(k + 1, float(k))
        counts.SetValue(k + 1, 1 if k == 1 else 2)
    corner = Geom_BSplineCurve(poles, knots, counts, 1)
    wire = BRepBuilderAPI_MakeWire()
    wire.Add(BRepBuilderAPI_MakeEdge(corner).Edge())
    for a, b in ((points[2], (0.0, 4.0)), ((0.0, 4.0), points[0])):
        wire.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(*a, height), gp_Pnt(*b, height)).Edge())
    return BRepBuilderAPI_MakeFace(wire.Wire(), True).Face()
