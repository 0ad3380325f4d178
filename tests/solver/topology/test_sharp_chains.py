"""Sharp edges that go on in each other, rounded together: known volumes, joints, ends, rims, and what is refused."""

import math
from itertools import pairwise

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer

from helpers.parts import graph_of, written
from helpers.solids import (
    box,
    box_with_fillet,
    box_with_four,
    cut,
    cylinder,
    fused,
    half_space,
    rounded,
    volume,
)
from semispline import EdgeError, SolidError, round_edge
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import children, ends, forward, parts
from semispline.solver.topology.relations import relate
from semispline.solver.topology.sharp_chains import sharp_chain
from semispline.solver.topology.solid_contacts import contacts_in_solid

pytestmark = pytest.mark.usefixtures("read_here")
# The shape is fixed: the section takes away 559/4096 of the square of the distance.
FIXED = {"degree_u": 3, "middle_curves": 0, "v_scale": "length", "alpha": "energy", "p2": "zero"}


def edges_at(shape, wanted):
    """Face and name of the sharp edges of which all samples are wanted."""
    graph = graph_of(shape)
    relations = relate(graph)
    return [
        (int(graph.uses.face[row]), graph.uses.name(row))
        for row in range(len(graph.uses))
        if relations.sharp[row] and row < relations.partner[row] and wanted(graph.uses.points[row])
    ]


def at_top(points):
    return bool((points[:, 2] > points[:, 2].max() - 1e-9).all() and points[0, 2] > 39.9)


def slot():
    """A plate with a slot that has round ends."""
    tool = fused(fused(box(20, 10, 10, at=(20, 15, 0)), cylinder(5, 10, at=(20, 20, 0))), cylinder(5, 10, (40, 20, 0)))
    return cut(box(60, 40, 10), tool)


def in_slot(points):
    return bool((points[:, 2] > 9.9).all() and (np.abs(points[:, 1] - 20) < 6).all() and np.ptp(points[:, 0]) < 25)


def rounded_there(shape, wanted, distance, folder, **named):
    path = written(shape, folder / "part.brep")
    face, edge = edges_at(shape, wanted)[0]
    return round_edge(path, face, edge, distance, folder / "out.step", **named)


def check(found, folder, faces):
    back = open_parts(folder / "out.step").root
    assert BRepCheck_Analyzer(back, True).IsValid()
    assert len(parts(back, "SOLID")) == 1
    assert len(parts(back, "FACE")) == faces
    assert volume(back) == pytest.approx(found.gate.volume[1], rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("distance", [1.0, pytest.param(2.0, marks=pytest.mark.slow)])
def test_the_top_of_a_box_with_rounded_walls(distance, tmp_path):
    shape = box_with_four(4.0)
    found = rounded_there(shape, at_top, distance, tmp_path)
    check(found, tmp_path, 18)
    assert "8 edges that go on in each other" in found.said
    assert found.gate.largest_tolerance <= 1.1e-7
    assert len(found.faces) == 8


@pytest.mark.slow
def test_the_same_whichever_edge_is_named(tmp_path):
    shape = box_with_four(4.0)
    path = written(shape, tmp_path / "part.brep")
    graph = graph_of(shape)
    (top,) = {face for face in range(10) if (graph.uses.points[graph.uses.of_face(face)][..., 2] > 39.9).all()}
    volumes = [round_edge(path, top, name, 1.0, tmp_path / "out.step", **FIXED).gate.volume[1] for name in ("e0", "e3")]
    # Volumes of the kernel are measured to 1e-6 of that under each face, the same for both.
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-9)


@pytest.mark.slow
def test_straight_and_revolved_stretches_take_away_what_they_should(tmp_path):
    """Pappus: what an arc takes away is the section's area times the way of its centroid."""
    shape, d, r = box_with_four(4.0), 1.0, 4.0
    found = rounded_there(shape, at_top, d, tmp_path, **FIXED)
    straight = 2 * (12 + 22)
    area = 559 / 4096 * d**2
    taken = found.gate.volume[0] - found.gate.volume[1] - area * straight
    # The centroid lies between the sharp corner, at r, and a third of the distance inwards.
    assert area * 2 * math.pi * (r - d / 3) < taken < area * 2 * math.pi * r


@pytest.mark.long
def test_an_open_chain_ends_on_faces(tmp_path):
    shape = box_with_fillet(4.0)
    found = rounded_there(shape, at_top, (1.0, 2.0), tmp_path)
    check(found, tmp_path, 10)
    assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.slow
def test_a_slot_is_rounded_all_round(tmp_path):
    """Lines are extruded and arcs revolved, a face each."""
    found = rounded_there(slot(), in_slot, 2.0, tmp_path)
    check(found, tmp_path, 10 + len(found.faces))
    assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.slow
@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0])
def test_blends_put_there_before_go_on(distance, tmp_path):
    shape = box(20, 30, 40)
    for k in range(4):
        up = edges_at(shape, lambda points: np.ptp(points[:, 2]) > 39)
        round_edge(written(shape, tmp_path / "part.brep"), *up[0], 4.0, tmp_path / f"{k}.step")
        shape = open_parts(tmp_path / f"{k}.step").root
    found = rounded_there(shape, at_top, distance, tmp_path)
    # One smooth face all round, or one for each edge.
    check(found, tmp_path, 10 + len(found.faces))
    assert found.gate.largest_tolerance <= 1e-6 * 40


@pytest.mark.slow
@pytest.mark.parametrize("distance", [0.5, 2.0, 5.0])
def test_closed_rims_of_bosses_holes_and_cones(distance, tmp_path):
    plate = box(40, 40, 10)
    shapes = [
        fused(plate, cylinder(8, 30, at=(20, 20, 0))),
        cut(plate, cylinder(8, 10, at=(20, 20, 0))),
        cylinder(8, 20),
    ]
    for shape in shapes:
        for face, edge in edges_at(shape, lambda points: np.linalg.norm(points[0] - points[-1]) < 1e-6):
            found = round_edge(written(shape, tmp_path / "part.brep"), face, edge, distance, tmp_path / "out.step")
            # Bands of no circle: contacts are exact, and no tolerance grows.
            assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.slow
def test_an_oblique_rim_is_rounded_too(tmp_path):
    """The seam of the cylinder and that of the blend meet the contact at different places."""
    shape = cut(cylinder(8, 30), half_space([0, 0, 20], [0.3, 0.2, 1]))
    found = rounded_there(shape, lambda points: points[:, 2].max() > 5, 1.0, tmp_path)
    check(found, tmp_path, 4)


def wires_in_order(faces):
    """Tell whether in all wires each edge begins where the one before it ends."""
    walks = [children(forward(wire)) for face in faces for wire in parts(face, "WIRE")]
    return all(
        ends(one)[1].IsSame(ends(other)[0])
        for walk in walks
        for one, other in zip(walk, [*walk[1:], walk[0]], strict=True)
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "wanted"),
    [
        (lambda: cut(cylinder(8, 30), half_space([0, 0, 20], [0.3, 0.2, 1])), lambda p: p[:, 2].max() > 5),
        (lambda: box_with_fillet(4.0), at_top),
        (lambda: box_with_four(4.0), at_top),
    ],
)
def test_wires_are_walked_in_their_order(make, wanted, tmp_path):
    shape = make()
    face, edge = edges_at(shape, wanted)[0]
    found = round_edge(written(shape, tmp_path / "part.brep"), face, edge, 1.0, tmp_path / "out.brep", **FIXED)
    faces = parts(open_parts(tmp_path / "out.brep").root, "FACE")
    assert wires_in_order([faces[n] for n in (*found.touched, *found.faces)])


@pytest.mark.slow
def test_an_edge_with_both_ends_on_one_face(tmp_path):
    """A half moon: its flat side ends the arcs above and below, and these end the upright edges."""
    shape = cut(cylinder(10, 20), half_space([4, 0, 0], [1, 0, 0]))
    path = written(shape, tmp_path / "part.brep")
    named = edges_at(shape, lambda _: True)
    assert len(named) == 6
    for face, edge in named[:2]:
        found = round_edge(path, face, edge, 1.0, tmp_path / "out.step")
        check(found, tmp_path, 5)
        assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.slow
def test_contacts_are_exact_on_the_faces_of_the_solid(tmp_path):
    found = rounded_there(box_with_four(4.0), at_top, 1.0, tmp_path)
    contacts = contacts_in_solid(tmp_path / "out.step", found.faces)
    assert len(contacts) == 16
    for x in contacts:
        assert x.contact.gap <= 1e-11
        assert x.contact.angle_degrees <= 1e-8
        assert x.contact.curvature_jump_relative <= 1e-7


def test_a_chain_is_found_from_each_of_its_edges():
    shape = box_with_four(4.0)
    graph = graph_of(shape)
    relations = relate(graph)
    for face, edge in edges_at(shape, at_top):
        row = graph.uses.of_face(face).start + int(edge[1:])
        chain = sharp_chain(graph, relations, row, "x")
        assert chain.closed
        assert chain.convex
        assert len(chain.rows) == 8
        ends = [graph.uses.walked_points(row)[[0, -1]] for row in chain.rows]
        assert all(np.linalg.norm(a[1] - b[0]) < 1e-9 for a, b in pairwise([*ends, ends[0]]))


def test_edges_that_meet_at_a_corner_are_no_chain():
    graph = graph_of(box(20, 30, 40))
    assert len(sharp_chain(graph, relate(graph), 0, "x").rows) == 1


def test_joints_with_slanted_edges_are_refused(tmp_path):
    shape = cut(box_with_four(4.0), half_space([10, 15, 32], [0.3, 0.2, 1]))
    with pytest.raises(EdgeError, match=r"goes on from .* slants by .* degrees .* contacts at one distance"):
        rounded_there(shape, lambda points: points[:, 2].min() > 10, 1.0, tmp_path)
    assert not (tmp_path / "out.step").exists()


def test_a_chain_that_runs_into_a_round_is_refused(tmp_path):
    """Two of the edges round the top are rounded before: the others end there."""
    shape = box_with_four(4.0)

    def there(edge):
        from OCP.BRepAdaptor import BRepAdaptor_Curve

        point = BRepAdaptor_Curve(edge).Value(0.5).Coord()
        return abs(point[2] - 40) < 1e-6

    shape = rounded(shape, 1.0, there)
    for face, edge in edges_at(shape, lambda points: points[:, 2].min() > 30)[:1]:
        with pytest.raises((EdgeError, SolidError)):
            round_edge(written(shape, tmp_path / "part.brep"), face, edge, 1.0, tmp_path / "out.step")


@pytest.mark.slow
def test_a_distance_that_is_too_large_says_how_far_both_faces_reach(tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    with pytest.raises(EdgeError, match=r"face 0: 50 reaches .* below 30; face 2: 50 reaches .* below 20$"):
        round_edge(path, 0, "e0", 50.0, tmp_path / "out.step")


@pytest.mark.slow
def test_an_arc_is_moved_as_far_as_its_radius(tmp_path):
    shape = box_with_four(4.0)
    with pytest.raises(EdgeError, match=r"below 4$|below 4;"):
        rounded_there(shape, at_top, 4.5, tmp_path)


def test_an_arc_fillet_is_told_from_a_smooth_one(tmp_path):
    """What is measured in the solid: a round fillet meets flat faces at no angle, and its whole curvature jumps."""
    shape = box_with_fillet(5.0)
    written(shape, tmp_path / "part.brep")
    number = graph_of(shape).faces.kind.index("cylinder")
    contacts = contacts_in_solid(tmp_path / "part.brep", [number])
    assert len(contacts) == 2
    for x in contacts:
        assert x.contact.angle_degrees <= 1e-6
        # Of a plane curvatures are compared with 1e-3 of its size: 1 / 5 with 1e-3 / 40.
        assert x.contact.curvature_jump_relative == pytest.approx(8000)
        assert x.contact.gap <= 1e-9


@pytest.mark.long
@pytest.mark.parametrize("make", [lambda: cylinder(8, 20), lambda: cut(box(40, 40, 10), cylinder(8, 10, (20, 20, 0)))])
def test_contacts_along_circles_of_flat_faces_are_no_bands(make, tmp_path):
    found = rounded_there(make(), lambda points: np.linalg.norm(points[0] - points[-1]) < 1e-6, 2.0, tmp_path)
    assert found.blend.band_a is None
    assert found.blend.band_b is None
    # Rounding of points of size 40 alone.
    assert max(edge.gap for edge in found.gate.border) <= 1e-12
