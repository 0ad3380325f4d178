"""What edges of trimmed faces are called: the name's curve is the edge, and what it keeps is the side of the face."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.collections import Array1_double, Array1_gp_Pnt2d, Array1_int
from OCP.Geom import (
    Geom_Circle,
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Plane,
    Geom_SphericalSurface,
    Geom_SurfaceOfRevolution,
    Geom_ToroidalSurface,
)
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Circle, Geom2d_Line
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax2d, gp_Ax3, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.TopoDS import TopoDS

from helpers.bases import patch, ring
from helpers.parts import graph_of, polygon
from helpers.sweeps import examples
from semispline import BSplineSurface, cut_to_edge, map_domain, parse_edge
from semispline.solver.io.occ import OccFace, _faces
from semispline.solver.io.occ_writing import occ_surface
from semispline.solver.judge import surface_points
from semispline.solver.topology.edge_names import named_edge

TURN = 2 * math.pi
# Of the size of the model: within it an edge is a line of constant parameter.
LINE = 1e-6
PLACE = gp_Ax3(gp_Pnt(1.0, -2.0, 3.0), gp_Dir(0.36, 0.48, 0.8))
MERIDIAN = Geom_Circle(gp_Ax2(gp_Pnt(4.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 0.0)), 1.0)
UPRIGHT = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
# Surfaces, and ranges within which faces are cut out.
SURFACES = {
    "B-spline": (occ_surface(patch(np.random.default_rng(3), degrees=(3, 3), counts=(6, 7))), (0, 1), (0, 1)),
    "plane": (Geom_Plane(PLACE), (-3, 4), (-2, 5)),
    "cylinder": (Geom_CylindricalSurface(PLACE, 2.0), (-3.0, 3.2), (-2, 5)),
    "cone": (Geom_ConicalSurface(PLACE, 0.3, 2.0), (-1.0, 5.2), (-2, 5)),
    "sphere": (Geom_SphericalSurface(PLACE, 2.0), (0.5, 6.5), (-1.5, 1.5)),
    "torus": (Geom_ToroidalSurface(PLACE, 5.0, 2.0), (-1.0, 5.2), (1.0, 7.2)),
    "revolution": (Geom_SurfaceOfRevolution(MERIDIAN, UPRIGHT), (0.1, 6.0), (0.5, 6.5)),
}


def names(face):
    """Graph, surface, and what each edge is."""
    graph = graph_of(face)
    surface = OccFace(face, "f").surface()
    return graph, surface, [named_edge(graph, row, surface) for row in range(len(graph.uses))]


def assert_names_are_the_edges(graph, surface, named, limit):
    for row, found in enumerate(named):
        if found.name is None:
            continue
        part, natural = cut_to_edge(surface, found.name)
        start, end = part.domain["uv".index(found.name.along)]
        line = np.full(257, part.domain["uv".index(natural[0])][int(natural[1])])
        along = np.linspace(start, end, 257)
        curve = surface_points(part, *((line, along) if natural[0] == "u" else (along, line)))
        points = graph.uses.points[row]
        # Ends are ends, to the last digits, and every sample lies on it: 256 chords of a circle sag by 1e-4 of it.
        ends = [np.abs(curve[[0, -1]] - points[[i, j]]).max() for i, j in ((0, -1), (-1, 0))]
        assert min(ends) <= limit
        away = np.linalg.norm(points[:, None] - curve, axis=2).min(axis=1)
        assert away.max() <= 0.01 * np.ptp(curve, axis=0).max() + limit


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("turned", [False, True])
@examples(30)
@given(
    st.tuples(st.floats(0.01, 0.4), st.floats(0.6, 0.99)),
    st.tuples(st.floats(0.01, 0.4), st.floats(0.6, 0.99)),
    st.booleans(),
)
def test_an_l_of_lines(name, turned, part_u, part_v, whole):
    """A rectangle without a corner: two of its six edges are lines inside even of a surface that is cut to it."""
    geometry, (first_u, last_u), (first_v, last_v) = SURFACES[name]
    if whole:
        part_u = part_v = (0.0, 1.0)
    u0, u1 = (first_u + x * (last_u - first_u) for x in part_u)
    v0, v1 = (first_v + x * (last_v - first_v) for x in part_v)
    u, v = u0 + 0.55 * (u1 - u0), v0 + 0.45 * (v1 - v0)
    face = polygon(geometry, [(u0, v0), (u1, v0), (u1, v), (u, v), (u, v1), (u0, v1)])
    face = TopoDS.Face(face.Reversed()) if turned else face
    graph, surface, named = names(face)
    # By the sides of the L; the surface of an elementary face ends where the face does.
    kept = {}
    for row, found in enumerate(named):
        assert found.off <= 1e-12 * graph.size + 1e-13
        middle = graph.uses.uv[row, 4]
        sides = [("v0", middle[1] - v0), ("u1", middle[0] - u1), ("v", middle[1] - v), ("u", middle[0] - u)]
        sides += [("v1", middle[1] - v1), ("u0", middle[0] - u0)]
        side = min(sides, key=lambda item: abs(item[1]))[0]
        kept[side] = found
    assert len(kept) == 6
    for side, found in kept.items():
        assert (found.name.direction, found.name.end) == (side[0], int(side[1:] or 1)), side
    assert kept["u"].kind == kept["v"].kind == "inner"
    is_cut = name == "B-spline" and not whole
    if not is_cut:
        assert (kept["u0"].kind, kept["v0"].kind, kept["u1"].kind, kept["v1"].kind) == (
            "whole",
            "whole",
            "part",
            "part",
        )
        assert str(kept["u0"].name) == "u0"
    assert kept["u1"].name.part is not None
    # Coordinates of 10 at most, some twenty operations.
    assert_names_are_the_edges(graph, surface, named, 1e-12)


def test_the_parameter_of_a_circle_is_converted():
    geometry, _, _ = SURFACES["cylinder"]
    face = polygon(geometry, [(0, 0), (2.0, 0), (2.0, 1.0), (1.2, 1.0), (1.2, 2.0), (0, 2.0)])
    _, surface, named = names(face)
    inner = next(str(x.name) for x in named if x.kind == "inner" and x.name.direction == "u")
    x = math.tan(0.6)
    assert surface.domain[0] == (0.0, 2.0)
    # The formula, by hand: one piece of 2 radians.
    expected = 2 * x / (math.sin(1.0) + x * (1 - math.cos(1.0)))
    assert parse_edge(inner).at == pytest.approx(expected, abs=4e-15)
    assert abs(expected - 1.2) > 0.01


@pytest.mark.parametrize("turned", [False, True])
def test_seams_and_poles_of_whole_bodies(turned):
    found = {}
    for key, maker in {
        "cylinder": BRepPrimAPI_MakeCylinder(2.0, 5.0),
        "ball": BRepPrimAPI_MakeSphere(2.0),
        "cone": BRepPrimAPI_MakeCone(2.0, 0.0, 5.0),
        "ring": BRepPrimAPI_MakeTorus(5.0, 1.0),
    }.items():
        shape = maker.Shape()
        graph = graph_of(shape.Reversed() if turned else shape)
        face = next(n for n, kind in enumerate(graph.faces.kind) if kind != "plane")
        rows = range(*graph.uses.of_face(face).indices(len(graph.uses)))
        surface = OccFace(list(_faces(shape))[face], "f").surface()
        named = [named_edge(graph, row, surface) for row in rows]
        found[key] = sorted(f"{x.kind} {x.name}" for x in named)
    assert found["cylinder"] == ["whole u0", "whole u1", "whole v0", "whole v1"]
    assert found["ball"] == ["point None", "point None", "whole u0", "whole u1"]
    assert found["cone"] == ["point None", "whole u0", "whole u1", "whole v0"]
    assert found["ring"] == ["whole u0", "whole u1", "whole v0", "whole v1"]


def slanted(tilt, side=1.0):
    """A square of side 1 in the parameters of a flat surface, one side tilted by a length in space."""
    k = [0, 0, 1, 1]
    flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, side, 0]], [[2 * side, 0, 0], [2 * side, side, 0]]])
    # To the middle of the range of u: an inner line.
    return polygon(occ_surface(flat), [(0.0, 0.0), (0.5, 0.0), (0.5 + tilt / (2 * side), 1.0), (0.0, 1.0)])


@pytest.mark.parametrize("side", [1e-3, 1.0, 1e3])
def test_the_tolerance_is_a_length(side):
    """The parameters run from 0 to 1 however large the part is."""
    graph, _, named = names(slanted(0.0, side))
    assert graph.size == pytest.approx(side)
    assert sorted(x.kind for x in named) == ["inner", "part", "part", "whole"]
    for tilt, kinds in ((0.9, ["inner", "part", "part", "whole"]), (1.1, ["free", "part", "part", "whole"])):
        _, _, named = names(slanted(tilt * LINE * side, side))
        assert sorted(x.kind for x in named) == kinds, tilt
    _, _, named = names(slanted(0.9 * LINE * side, side))
    # The line is in the middle.
    assert max(x.off for x in named) == pytest.approx(0.45 * LINE * side, rel=1e-6)


def bulged(height):
    """A square whose right side is a curve of degree 2 that leaves the line by half of `height`."""
    geometry = Geom_Plane(PLACE)
    poles, knots, times = Array1_gp_Pnt2d(1, 3), Array1_double(1, 2), Array1_int(1, 2)
    for i, (u, v) in enumerate([(1.0, 0.0), (1.0 + height, 0.5), (1.0, 1.0)]):
        poles.SetValue(i + 1, gp_Pnt2d(u, v))
    for i in (1, 2):
        knots.SetValue(i, i - 1.0)
        times.SetValue(i, 3)
    wire = BRepBuilderAPI_MakeWire()
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    for k, (a, b) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        curve = Geom2d_Line(gp_Pnt2d(*a), gp_Dir2d(b[0] - a[0], b[1] - a[1]))
        curve = Geom2d_BSplineCurve(poles, knots, times, 2) if k == 1 else curve
        edge = BRepBuilderAPI_MakeEdge(curve, geometry, 0.0, 1.0).Edge()
        BRepLib.BuildCurves3d_s(edge)
        wire.Add(edge)
    return BRepBuilderAPI_MakeFace(geometry, wire.Wire()).Face()


def test_poles_decide():
    """Hull property: a curve whose poles are within the tolerance is a line; one whose poles are not may be none."""
    size = names(bulged(0.0))[0].size
    assert [x.kind for x in names(bulged(0.8 * LINE * size))[2]] == ["whole"] * 4
    assert sorted(x.kind for x in names(bulged(1.5 * LINE * size))[2])[0] == "free"
    assert sorted(x.kind for x in names(bulged(0.1))[2])[0] == "free"


def test_a_circle_in_the_parameters_is_free_however_small():
    geometry = Geom_Plane(PLACE)
    for radius in (1.0, 1e-3):
        circle = Geom2d_Circle(gp_Ax2d(gp_Pnt2d(0.5, 0.5), gp_Dir2d(1.0, 0.0)), radius)
        edge = BRepBuilderAPI_MakeEdge(circle, geometry).Edge()
        BRepLib.BuildCurves3d_s(edge)
        face = BRepBuilderAPI_MakeFace(geometry, BRepBuilderAPI_MakeWire(edge).Wire()).Face()
        assert [x.kind for x in names(face)[2]] == ["free"]


def test_an_arc_in_the_parameters_is_free_however_flat():
    """Samples prove nothing of what lies between them; of a circle no poles are known."""
    geometry, radius = Geom_Plane(PLACE), 1e6
    circle = Geom2d_Circle(gp_Ax2d(gp_Pnt2d(-radius, 0.0), gp_Dir2d(1.0, 0.0)), radius)
    arc = BRepBuilderAPI_MakeEdge(circle, geometry, -0.5 / radius, 0.5 / radius).Edge()
    wire = BRepBuilderAPI_MakeWire()
    BRepLib.BuildCurves3d_s(arc)
    wire.Add(arc)
    end = radius * (math.cos(0.5 / radius) - 1)
    for a, b in (((end, 0.5), (-1.0, 0.5)), ((-1.0, 0.5), (-1.0, -0.5)), ((-1.0, -0.5), (end, -0.5))):
        step = b[0] - a[0], b[1] - a[1]
        line = Geom2d_Line(gp_Pnt2d(*a), gp_Dir2d(*step))
        edge = BRepBuilderAPI_MakeEdge(line, geometry, 0.0, math.hypot(*step)).Edge()
        BRepLib.BuildCurves3d_s(edge)
        wire.Add(edge)
    _, _, named = names(BRepBuilderAPI_MakeFace(geometry, wire.Wire()).Face())
    assert sorted(x.kind for x in named) == ["free", "whole", "whole", "whole"]


def test_a_part_across_the_seam_of_a_periodic_surface():
    """A B-spline pipe; the face lies over its seam, where no seam edge divides it."""
    pipe = occ_surface(map_domain(ring(8, 1.0, (0.0, 1.0, 2.0)), (0, 1), (0, 1)))
    pipe.SetVPeriodic()
    face = polygon(pipe, [(0.0, 0.8), (1.0, 0.8), (1.0, 1.2), (0.0, 1.2)])
    graph, surface, named = names(face)
    assert sorted(str(x.name) for x in named if x.name.direction == "u") == ["u0[0.8,1.2]", "u1[0.8,1.2]"]
    words = sorted(str(x.name) for x in named if x.name.direction == "v")
    low, high = map(parse_edge, words)
    # 1.2 less a turn.
    assert (low.at, low.end, high.at, high.end) == (pytest.approx(0.2, abs=1e-15), 1, 0.8, 0)
    assert_names_are_the_edges(graph, surface, named, 1e-12)


def test_nothing_is_named_that_does_not_lie_there():
    """Control: the surface of another face. What is named is measured against the edge."""
    graph, surface, named = names(slanted(0.0))
    assert all(x.name for x in named)
    shifted = replace(surface, control_points=surface.control_points + 3e-5)
    assert {named_edge(graph, row, shifted).kind for row in range(4)} == {"not classified"}
    assert "not classified" not in {named_edge(graph, row, shifted, deviation=3e-5).kind for row in range(4)}
