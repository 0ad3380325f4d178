"""Tubes over profiles of lines and arcs, as files hold them: one face for each line and arc."""

import math

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Pnt, gp_Vec


def oval_edges(length, radius, z):
    """Two lines and two half circles, anticlockwise seen from above: the centres lie on the x-axis."""
    h, r = length / 2, radius
    point = [gp_Pnt(*x, z) for x in ((-h, -r), (h, -r), (h, r), (-h, r))]
    ends = [gp_Pnt(h + r, 0, z), gp_Pnt(-h - r, 0, z)]
    return [
        BRepBuilderAPI_MakeEdge(point[0], point[1]).Edge(),
        BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(point[1], ends[0], point[2]).Value()).Edge(),
        BRepBuilderAPI_MakeEdge(point[2], point[3]).Edge(),
        BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(point[3], ends[1], point[0]).Value()).Edge(),
    ]


def round_edges(radius, z, angles):
    """Arcs of one circle from each angle, in degrees, to the next."""

    def at(degrees):
        t = math.radians(degrees)
        return gp_Pnt(radius * math.cos(t), radius * math.sin(t), z)

    following = [*angles[1:], angles[0] + 360]
    return [
        BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(at(a), at((a + b) / 2), at(b)).Value()).Edge()
        for a, b in zip(angles, following, strict=True)
    ]


def polygon_edges(corners, z):
    points = [gp_Pnt(*x, z) for x in corners]
    return [BRepBuilderAPI_MakeEdge(*two).Edge() for two in zip(points, [*points[1:], points[0]], strict=True)]


def tube(edges, height, *, solid=False):
    """What a closed profile makes when it is moved along z: its walls, or all of the body."""
    maker = BRepBuilderAPI_MakeWire()
    for edge in edges:
        maker.Add(edge)
    base = BRepBuilderAPI_MakeFace(maker.Wire()).Face() if solid else maker.Wire()
    return BRepPrimAPI_MakePrism(base, gp_Vec(0, 0, height)).Shape()
