"""Fillets of parts whose maker says which faces it made, and controls that must find nothing."""

from functools import cache

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon, BRepBuilderAPI_Sewing
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

from helpers.parts import compound, fillet, graph_of, moved, reordered, rounded_box, unsewn
from helpers.random_parts import known_part
from helpers.sweeps import first_ones
from semispline import Base, BSplineSurface, blend
from semispline.solver.io.occ import read_occ
from semispline.solver.io.occ_writing import occ_surface
from semispline.solver.topology.chamfers import find_chamfers, sharp_edges
from semispline.solver.topology.fillets import (
    BENT_NEIGHBOUR,
    ONE_HULL,
    PINCHED,
    ROUND_END,
    chains,
    find_fillets,
)
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.occ_edges import edge_tables
from semispline.solver.topology.relations import relate

SEEDS = first_ones(5, list(range(40)))


def decided(shape):
    graph = graph_of(shape)
    relations = relate(graph)
    return graph, relations, find_fillets(graph, relations)


@cache
def real(path):
    model = read_occ(path)
    graph = EdgeGraph(str(path), model.unit, *edge_tables(model.faces), {})
    relations = relate(graph)
    return graph, relations, find_fillets(graph, relations)


@pytest.mark.parametrize("seed", SEEDS)
def test_fillets_of_a_known_part_are_found_and_nothing_else(seed):
    part = known_part(seed)
    assert set(decided(part.shape)[2].accepted) == set(part.made)


def test_chamfers_of_known_parts_are_found(whole):
    # 154 of 160: those as wide as the face beside them are left out.
    made = missed = wrong = 0
    for seed in range(40 if whole else 6):
        part = known_part(seed, chamfer=True)
        graph, relations, fillets = decided(part.shape)
        assert fillets.accepted == {}
        found = {chamfer.between.face for chamfer in find_chamfers(graph, relations, fillets.accepted)}
        made, missed, wrong = made + len(part.made), missed + len(part.made - found), wrong + len(found - part.made)
    assert missed <= 0.06 * made
    assert wrong == 0


def test_what_is_measured_of_a_round():
    graph, _, fillets = decided(rounded_box())
    upright = [b for face, b in fillets.accepted.items() if graph.faces.kind[face] == "cylinder" and b.radius > 2]
    assert len(upright) == 4
    for between in upright:
        assert between.radius == pytest.approx(3.0)
        assert between.turn == pytest.approx(90.0)
        assert between.width == pytest.approx(3.0 * np.sqrt(2))
        assert between.length == pytest.approx(18.5)
        assert (between.sign, between.jump, between.smooth) == (-1.0, pytest.approx(1.0), 1.0)


def test_rounds_round_the_top_are_one_chain_and_the_upright_ones_are_not_in_it():
    graph, relations, fillets = decided(rounded_box())
    assert len(fillets.accepted) == 12
    (chain,) = chains(graph, relations, fillets.accepted)
    assert sorted(graph.faces.kind[face] for face in chain) == ["cylinder"] * 4 + ["torus"] * 4
    # The width of a torus is measured to the chords of a rim: off by 1 - cos(90/16 degrees) of its radius.
    assert [fillets.accepted[face].radius for face in chain] == pytest.approx([1.5] * 8, rel=0.02)
    # A torus has one of its contacts on the end of an upright round.
    assert sorted(fillets.on_ends[face] for face in fillets.accepted) == [0] * 8 + [1] * 4


def rotated():
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(3, 4, 5), gp_Dir(1, 2, 3)), 0.7)
    return turn


def scaled(factor):
    trsf = gp_Trsf()
    trsf.SetScale(gp_Pnt(1, 0, 0), factor)
    return trsf


def mirrored():
    trsf = gp_Trsf()
    trsf.SetMirror(gp_Ax2(gp_Pnt(1, 1, 1), gp_Dir(1, 2, 2)))
    return trsf


CHANGES = {
    "turned": lambda shape: moved(shape, rotated()),
    "small": lambda shape: moved(shape, scaled(1e-3)),
    "large": lambda shape: moved(shape, scaled(1e3)),
    "mirrored": lambda shape: moved(shape, mirrored()),
    "inside out": lambda shape: shape.Reversed(),
    "unsewn": unsewn,
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("seed", first_ones(2, list(range(10))))
def test_the_same_faces_are_found_however_the_part_lies(seed, change):
    part = known_part(seed)
    assert set(decided(CHANGES[change](part.shape))[2].accepted) == set(part.made)


@pytest.mark.parametrize("seed", first_ones(2, list(range(10))))
def test_the_order_of_faces_says_nothing(seed):
    part = known_part(seed)
    order = np.random.default_rng(seed).permutation(graph_size(part.shape)).tolist()
    found = decided(reordered(part.shape, order))[2].accepted
    assert {order[face] for face in found} == set(part.made)


def graph_size(shape):
    return len(graph_of(shape).faces)


def rectangle(a, b, c, d):
    return BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[a, b], [c, d]])


@pytest.mark.parametrize("sewn", [True, False])
@pytest.mark.parametrize("continuity", ["G1", "G2"])
def test_a_g2_blend_is_found_as_a_g1_blend_is(continuity, sewn):
    floor = rectangle([0, 0, 0], [0, 30, 0], [10, 0, 0], [10, 30, 0])
    wall = rectangle([14, 0, 4], [14, 30, 4], [14, 0, 12], [14, 30, 12])
    strip = blend(Base(floor, "u1"), Base(wall, "u0"), continuity=continuity).surface.to_bspline()
    faces = [BRepBuilderAPI_MakeFace(occ_surface(x), 1e-7).Face() for x in (floor, strip, wall)]
    shape = compound(faces)
    if sewn:
        sewing = BRepBuilderAPI_Sewing(1e-6)
        sewing.Add(shape)
        sewing.Perform()
        shape = sewing.SewedShape()
    _, relations, fillets = decided(shape)
    assert list(fillets.accepted) == [1]
    between = fillets.accepted[1]
    assert (between.jump > 0.4) == (continuity == "G1")
    # Where the curvature begins at zero, the way the face turns says on which side it bends.
    assert between.sign == decided(shape)[2].accepted[1].sign
    assert between.turn == pytest.approx(90.0)
    assert relations.matched.sum() == (0 if sewn else 4)


def test_a_convex_neighbour_that_bends_as_much_speaks_not_against_a_concave_round():
    # A ball of radius 5 on a floor, and a round of radius 4 between them.
    floor = BRepPrimAPI_MakeBox(gp_Pnt(-30, -30, -10), 60.0, 60.0, 10.0).Shape()
    ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 3), 5.0).Shape()
    both = BRepAlgoAPI_Fuse(floor, ball).Shape()
    shape = fillet(both, 4.0, lambda point, _: abs(point[2]) < 1e-6 and np.hypot(*point[:2]) < 10)
    (between,) = decided(shape)[2].accepted.values()
    assert between.sign == 1.0
    assert between.neighbour == pytest.approx(0.0, abs=1e-9)
    assert between.curvature < 1.5 / 5


def test_ends_at_45_degrees_are_corners():
    corners = [(0, 0), (40, 0), (30, 10), (10, 10)]
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in corners:
        polygon.Add(gp_Pnt(x, y, 0))
    polygon.Close()
    prism = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 0, 12)).Shape()
    shape = fillet(prism, 2.0, lambda point, _: abs(point[1]) < 1e-6 and point[2] > 11.9)
    graph, _, fillets = decided(shape)
    (between,) = fillets.accepted.values()
    assert graph.faces.kind[between.face] == "cylinder"
    assert between.turn == pytest.approx(90.0)


def test_a_box_has_sharp_edges_only():
    graph, relations, fillets = decided(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape())
    assert (fillets.accepted, fillets.refused) == ({}, {})
    assert find_chamfers(graph, relations, ()) == []
    assert len(sharp_edges(graph, relations)) == 12
    assert relations.convex.all()
    assert relations.median == pytest.approx(90.0)


def test_a_ball_has_nothing():
    graph, relations, fillets = decided(BRepPrimAPI_MakeSphere(2.0).Shape())
    assert fillets.accepted == {}
    assert sharp_edges(graph, relations) == []


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("build123d_M6-1x12-countersunk-screw.step", 2),
        ("demos_face_recognition_sample_part.stp", 5),
        ("occt_bottle.brep", 33),
        ("occt_screw.step", 0),
        ("occt_shell1.brep", 0),
        ("demos_as1_pe_203.stp", 0),
        ("tigl_simplewing.brep", 0),
    ],
)
def test_fillets_of_real_files(shared, name, count):
    assert len(real(shared / "data/cad" / name)[2].accepted) == count


@pytest.mark.long
def test_why_faces_of_real_files_are_no_fillets(shared):
    def rules(name):
        return [refusal.rule for refusal in real(shared / "data/cad" / name)[2].refused.values()]

    assert rules("demos_as1_pe_203.stp") == [ROUND_END] * 70
    assert rules("occt_bottle.brep").count(PINCHED) == 16
    assert {ONE_HULL, BENT_NEIGHBOUR} <= set(rules("occt_shell1.brep"))
