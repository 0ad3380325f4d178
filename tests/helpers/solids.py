"""Solids with fillets made by Open CASCADE, for tests of what takes their fillets out."""

import math

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.GeomAbs import GeomAbs_CurveType
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain

from helpers.parts import edges_of_shape, fillet


def volume(shape):
    found = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, found, 1e-9)
    return found.Mass()


def box(*sizes, at=(0.0, 0.0, 0.0)):
    return BRepPrimAPI_MakeBox(gp_Pnt(*at), *sizes).Shape()


def cylinder(radius, height, at=(0.0, 0.0, 0.0), along=(0.0, 0.0, 1.0)):
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(*at), gp_Dir(*along)), radius, height).Shape()


def fused(a, b):
    found = ShapeUpgrade_UnifySameDomain(BRepAlgoAPI_Fuse(a, b).Shape())
    found.Build()
    return found.Shape()


def cut(a, b):
    return BRepAlgoAPI_Cut(a, b).Shape()


def prism(corners, vector):
    """A polygon of points in space, swept."""
    wire = BRepBuilderAPI_MakePolygon()
    for corner in corners:
        wire.Add(gp_Pnt(*corner))
    wire.Close()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(*vector)).Shape()


def half_space(point, normal, size=200.0):
    """A cube that holds all that lies beyond a plane."""
    normal = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
    aside = np.cross(normal, [0.3, 0.5, 0.8])
    aside /= np.linalg.norm(aside)
    other = np.cross(normal, aside)
    corners = [np.asarray(point) + size * (a * aside + b * other) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return prism(corners, size * normal)


def edge_at(x, y):
    """The upright edge at a place."""
    return lambda point, along: (
        abs(along[2]) > 0.5 * np.linalg.norm(along) and math.hypot(point[0] - x, point[1] - y) < 1e-6
    )


def circles_at(z, radius):
    """Which edges of a shape are circles of a radius at a height."""

    def wanted(edge):
        curve = BRepAdaptor_Curve(edge)
        return (
            curve.GetType() == GeomAbs_CurveType.GeomAbs_Circle
            and abs(curve.Circle().Radius() - radius) < 1e-9
            and abs(curve.Circle().Location().Z() - z) < 1e-9
        )

    return wanted


def rounded(shape, radius, wanted):
    """Round the edges that `wanted` accepts."""
    from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet

    maker = BRepFilletAPI_MakeFillet(shape)
    for edge in edges_of_shape(shape):
        if wanted(edge):
            maker.Add(radius, edge)
    maker.Build()
    return maker.Shape()


def box_with_fillet(radius, sizes=(20.0, 30.0, 40.0)):
    return fillet(box(*sizes), radius, edge_at(0, 0))


def box_with_four(radius):
    return fillet(box(20, 30, 40), radius, lambda _, along: abs(along[2]) > 0.5)


def slanted(radius, *planes):
    """A box cut off by planes above, its upright edge rounded."""
    shape = box(20, 30, 40)
    for normal in planes:
        shape = cut(shape, half_space([0, 0, 32], normal))
    return fillet(shape, radius, edge_at(0, 0))


def inner_corner(radius):
    shape = cut(box(20, 30, 40), box(12, 18, 40))
    return fillet(shape, radius, edge_at(12, 18))


def round_end(radius, across=30.0):
    """A box of which a cylinder took the upper end."""
    shape = cut(box(20, 30, 60), cylinder(across, 80, at=(-30, -5, 40 + across), along=(1, 0.0, 0)))
    return fillet(shape, radius, edge_at(0, 0))


def rib(radius):
    """A half-round rib on a plate."""
    shape = fused(box(60, 40, 5), cut(cylinder(8, 60, at=(0, 20, 5), along=(1, 0, 0)), box(60, 40, 5)))
    return fillet(
        shape, radius, lambda p, d: abs(p[2] - 5) < 1e-6 and abs(abs(p[1] - 20) - 8) < 1e-6 and abs(d[0]) > 0.5
    )


def boss(radius, across=8.0):
    """A boss on a plate, the corner between them rounded."""
    return rounded(fused(box(40, 40, 5), cylinder(across, 20, at=(20, 20, 0))), radius, circles_at(5, across))


def pin(radius):
    return rounded(cylinder(8, 20), radius, circles_at(20, 8))


def rim_of_hole(radius):
    return rounded(cut(box(40, 40, 10), cylinder(8, 10, at=(20, 20, 0))), radius, circles_at(10, 8))


def quarter_disc(radius):
    shape = cut(cut(cylinder(20, 10), half_space([0, 0, 0], [-1, 0, 0])), half_space([0, 0, 0], [0, -1, 0]))
    return fillet(shape, radius, edge_at(0, 0))


def pocket(radius):
    """A rectangular hole, its inner corners rounded."""
    shape = cut(box(40, 30, 10), box(20, 10, 10, at=(10, 10, 0)))
    return fillet(shape, radius, lambda p, d: abs(d[2]) > 0.5 and 5 < p[0] < 35 and 5 < p[1] < 25)


def stair(radius, high):
    """A step, its inner edge or the one above rounded, from side to side."""
    shape = cut(box(40, 30, 20), box(20, 30, 10, at=(20, 0, 10)))
    return fillet(shape, radius, lambda p, _: abs(p[0] - 20) < 1e-6 and abs(p[2] - high) < 1e-6)


def blind_hole(radius):
    """The edge round its bottom is rounded."""
    return rounded(cut(box(40, 40, 20), cylinder(8, 10, at=(20, 20, 10))), radius, circles_at(10, 8))


def blunt_wedge(radius):
    """An edge of 117 degrees."""
    shape = prism([(0, 0, 0), (30, 0, 0), (40, 0, 15), (0, 0, 15)], (0, 40, 0))
    return fillet(shape, radius, lambda p, _: abs(p[0] - 30) < 1e-6 and abs(p[2]) < 1e-6)


def pipe(radius):
    """The outer rim of a thick pipe."""
    return rounded(cut(cylinder(8, 20), cylinder(5, 20)), radius, circles_at(20, 8))


MODELS = {
    **{f"box r={r}": (lambda r=r: box_with_fillet(r)) for r in (0.1, 1.0, 3.0, 5.0, 9.0)},
    **{f"box four r={r}": (lambda r=r: box_with_four(r)) for r in (2.0, 7.0)},
    **{
        f"slanted {a}": (lambda a=a: slanted(4.0, [math.sin(math.radians(a)), 0, math.cos(math.radians(a))]))
        for a in (10, 30, 45)
    },
    "skew": lambda: slanted(4.0, [0.3, 0.5, 1.0]),
    "skew back": lambda: slanted(4.0, [-0.3, 0.4, 1.0]),
    **{f"inner corner r={r}": (lambda r=r: inner_corner(r)) for r in (1.0, 5.0)},
    **{f"round end r={r}": (lambda r=r: round_end(r)) for r in (1.0, 3.0)},
    **{f"rib r={r}": (lambda r=r: rib(r)) for r in (1.0, 3.0)},
    **{f"boss r={r}": (lambda r=r: boss(r)) for r in (0.5, 2.0, 4.0)},
    **{f"pin r={r}": (lambda r=r: pin(r)) for r in (1.0, 4.0)},
    **{f"rim of a hole r={r}": (lambda r=r: rim_of_hole(r)) for r in (1.0, 3.0)},
    **{f"quarter disc r={r}": (lambda r=r: quarter_disc(r)) for r in (2.0, 5.0)},
    **{f"pocket, inner corner r={r}": (lambda r=r: pocket(r)) for r in (1.0, 4.0)},
    **{f"stair, inner edge r={r}": (lambda r=r: stair(r, 10)) for r in (1.0, 5.0)},
    **{f"stair r={r}": (lambda r=r: stair(r, 20)) for r in (2.0, 8.0)},
    **{f"blind hole, inner rim r={r}": (lambda r=r: blind_hole(r)) for r in (1.0, 3.0)},
    "blunt wedge r=2": lambda: blunt_wedge(2.0),
    "pipe r=1": lambda: pipe(1.0),
}
