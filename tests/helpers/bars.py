"""Bars made by Open CASCADE, whose ends are joined."""

from math import cos, pi, sin

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import Geom_Ellipse
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec

from helpers.parts import graph_of


def oval_wire(x, y, radius, z):
    """Four lines and four arcs around (+-x, +-y)."""
    wire = BRepBuilderAPI_MakeWire()
    centres = [(x, y), (-x, y), (-x, -y), (x, -y)]
    for k, centre in enumerate(centres):
        start, after = k * pi / 2, centres[(k + 1) % 4]
        wire.Add(_arc(centre, radius, start, start + pi / 2, z))
        ends = [(c[0] + radius * cos(start + pi / 2), c[1] + radius * sin(start + pi / 2)) for c in (centre, after)]
        wire.Add(BRepBuilderAPI_MakeEdge(*(gp_Pnt(*end, z) for end in ends)).Edge())
    return wire.Wire()


def round_wire(radius, z, arcs, turn=0.3):
    """A circle in equal arcs."""
    wire = BRepBuilderAPI_MakeWire()
    for k in range(arcs):
        start = turn + 2 * pi * k / arcs
        wire.Add(_arc((0.0, 0.0), radius, start, start + 2 * pi / arcs, z))
    return wire.Wire()


def ellipse_wire(a, b, z, arcs, turn=0.0):
    """An ellipse in arcs of equal ranges of its angle."""
    wire, curve = BRepBuilderAPI_MakeWire(), Geom_Ellipse(gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), a, b)
    for k in range(arcs):
        start = turn + 2 * pi * k / arcs
        wire.Add(BRepBuilderAPI_MakeEdge(curve, start, start + 2 * pi / arcs).Edge())
    return wire.Wire()


def _arc(centre, radius, start, end, z):
    places = [(centre[0] + radius * cos(t), centre[1] + radius * sin(t)) for t in (start, (start + end) / 2, end)]
    return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(*(gp_Pnt(*p, z) for p in places)).Value()).Edge()


def bar(wire, depth):
    """What a wire encloses, swept along z."""
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire).Face(), gp_Vec(0, 0, depth)).Shape()


def oval(z=0.0, depth=-4.0):
    return bar(oval_wire(3.0, 1.0, 1.0, z), depth)


def tube(arcs, z=6.0, depth=3.0, radius=1.5):
    return bar(round_wire(radius, z, arcs), depth)


def drafted():
    """An oval that narrows upwards to z = 0."""
    maker = BRepOffsetAPI_ThruSections(True, True)
    for radius, z in ((1.6, -4.0), (1.0, 0.0)):
        maker.AddWire(oval_wire(3.0, 1.0, radius, z))
    return maker.Shape()


def end_at(shape, z):
    """The number of the planar face at a height that looks up or down."""
    graph = graph_of(shape)
    for number, kind in enumerate(graph.faces.kind):
        points = graph.uses.points[graph.uses.of_face(number)]
        if kind == "plane" and abs(points[..., 2] - z).max() < 1e-9:
            return number
    raise AssertionError
