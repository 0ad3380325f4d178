"""Edges of several faces as one contact: their words, how they go on in each other, and their blends."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Trsf, gp_Vec

from helpers.free_curves import bent_face, cubic
from helpers.parts import compound, graph_of, rounded_box, unsewn, with_moved_face, written
from helpers.profiles import oval_edges, polygon_edges, round_edges, tube
from semispline import Base, EdgeError, FileError, blend_edges, faces_of_blend, list_edges, plane, resolve_edge
from semispline.solver.judge import measure_contact
from semispline.solver.options import BlendOptions
from semispline.solver.topology.bands import band_along
from semispline.solver.topology.bases import EdgeBase, edge_bases, paired_bases
from semispline.solver.topology.chain_measuring import measure_chain_contact
from semispline.solver.topology.chain_names import ChainWord, names_several, parse_chain
from semispline.solver.topology.contact_walk import passage_between, smooth_run
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.joined_bases import in_order
from semispline.solver.topology.relations import relate
from semispline.solver.topology.resolving import resolve_edges

pytestmark = pytest.mark.usefixtures("reads_here")

# Shapes are looked at elsewhere.
QUICK = {"alpha": "natural"}
SQUARE = [(-8, -8), (8, -8), (8, 8), (-8, 8)]
SMALL = [(-5, -6), (5, -6), (5, 6), (-5, 6)]


@pytest.fixture(scope="module")
def ovals(tmp_path_factory):
    """Walls of an oval, faces 0 to 3 with rims e1 above, and of a round tube in four arcs, 4 to 7 with e3 below."""
    shapes = [tube(oval_edges(30, 10, 0), 10), tube(round_edges(8, 25, [0, 100, 190, 280]), 10)]
    return str(written(compound(shapes), tmp_path_factory.mktemp("ovals") / "ovals.brep"))


@pytest.fixture(scope="module")
def boxes(tmp_path_factory):
    """Walls of a box, faces 0 to 3 with e1 above, of a smaller one, 4 to 7 with e3 below; a tube of arcs, 8 to 10 with
    e3 below; and a whole box: walls 11 to 14, top 16."""
    shapes = [
        tube(polygon_edges(SQUARE, 0), 10),
        tube(polygon_edges(SMALL, 25), 10),
        tube(round_edges(6, 25, [0, 120, 240]), 10),
        tube(polygon_edges(SQUARE, 0), 10, solid=True),
    ]
    return str(written(compound(shapes), tmp_path_factory.mktemp("boxes") / "boxes.brep"))


@pytest.fixture(scope="module")
def rounded(tmp_path_factory):
    """A box with eight rounds about its top, face 7; the walls below begin with face 0, whose rim is e1."""
    return str(written(rounded_box(), tmp_path_factory.mktemp("rounded") / "rounded.brep"))


@given(
    st.lists(
        st.tuples(st.none() | st.integers(0, 99), st.integers(0, 99), st.sampled_from(["", "..e7", "*", "[2]"])),
        min_size=1,
        max_size=4,
    )
)
def test_words_are_read_as_they_are_put_together(members):
    words = [f"{'' if face is None else f'{face}:'}e{number}{rest}" for face, number, rest in members]
    found = parse_chain(" + ".join(words))
    assert found == tuple(
        ChainWord(f"e{number}" + rest * rest.startswith("["), face, "e7" if rest == "..e7" else None, rest == "*")
        for face, number, rest in members
    )
    is_one_edge = len(members) == 1 and members[0][0] is None and members[0][2] in ("", "[2]")
    assert names_several("+".join(words)) is not is_one_edge


@pytest.mark.parametrize("word", ["e3+u1", "e3+", "12:", "e3..", "e3..u1", "12:u1", "e3**", "e3[0]*", "e3+near=1,2,3"])
def test_what_is_no_word_is_refused_before_a_file_is_read(word):
    with pytest.raises(EdgeError, match=r"edge: found .*, expected edges of faces that run end to end, as e3\+e4"):
        resolve_edge("no file.step", word)


def test_a_smooth_rim_goes_on_over_all_faces(ovals):
    graph = graph_of(compound([tube(oval_edges(30, 10, 0), 10)]))
    relations = relate(graph)
    (first,) = (row for row in range(4) if graph.uses.name(row) == "e1")
    run = smooth_run(graph, relations, first)
    assert run.closed
    assert [int(graph.uses.face[row]) for row in run.uses] == [0, 1, 2, 3]
    passage = passage_between(graph, relations, *run.uses[:2])
    assert (passage.kind, passage.side is None) == ("smooth", False)
    assert passage_between(graph, relations, run.uses[0], run.uses[2]) is None
    found = resolve_edge(ovals, "0:e1*")
    assert (found.edge, found.spec, found.asked) == ("e1+1:e1+2:e1+3:e1", f"{ovals}#0", "0:e1*")
    assert found.said == f"e1+1:e1+2:e1+3:e1 of {ovals}#0, 4 edges of 4 faces"
    # A point on a rim says the same.
    assert resolve_edge(ovals, "near=0,-10,10*").edge == found.edge
    assert resolve_edge(f"{ovals}#2", "2:e1+3:e1").edge == "e1+3:e1"


def test_unsewn_faces_go_on_in_each_other():
    graph = graph_of(unsewn(tube(oval_edges(30, 10, 0), 10)))
    assert len(smooth_run(graph, relate(graph), 1).uses) == 4


@pytest.mark.long
@pytest.mark.parametrize("apart", [1e-6, 1e-5])
def test_unsewn_faces_that_meet_within_a_gap_are_one_contact(tmp_path, apart):
    """Edges of 1e-7 tolerance that end further apart: who finds that they go on in each other blends them too."""
    step = gp_Trsf()
    step.SetTranslation(gp_Vec(0.6 * apart, 0, 0.8 * apart))
    walls = with_moved_face(tube(oval_edges(30, 10, 0), 10), 0, step)
    path = written(compound([walls, tube(round_edges(8, 25, [0, 100, 190, 280]), 10)]), tmp_path / "gap.brep")
    a, b = resolve_edges([(f"{path}#0", "e1*"), (f"{path}#4", "e3*")])
    assert len(a.edges) == 4
    (result,) = blend_edges(a, b, **QUICK)
    # Half of the gap at both ends of the face that was moved, and that is said.
    assert sorted(joint.moved for joint in result.chain_a.joints)[-2:] == pytest.approx([apart, apart], rel=1e-6)
    assert result.chain_a.limits == "cad"
    assert apart / 4 < result.chain_a.worst("gap") < apart


def test_a_cut_rim_of_one_face_is_one_edge_of_it(tmp_path):
    """Of a cylinder with a seam: nothing to chain; e1* is the closed edge."""
    path = written(BRepPrimAPI_MakeCylinder(5.0, 8.0).Shape(), tmp_path / "pin.brep")
    rims = [e for e in list_edges(path, 0).edges if e.kind == "whole" and not e.seam]
    assert len(rims) == 2
    for rim in rims:
        found = resolve_edge(f"{path}#0", f"{rim.name}*")
        assert (found.edge, found.asked) == (rim.edge, f"{rim.name}*")


def test_runs_stop_at_corners_and_say_so(boxes):
    found = resolve_edge(boxes, "0:e1*")
    assert found.edge == "v0"
    assert "it ends before 0:e1 at a corner of 90 degrees; it ends after 0:e1 at a corner of 90 degrees" in found.said
    # In walking order of the wire, beyond its end too.
    assert resolve_edge(boxes, "16:e2..e0").edge == "e2+e3+e0"
    assert resolve_edge(f"{boxes}#16", "e0..e3").edge == "e0+e1+e2+e3"


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("0:e1+2:e1", "e1 of face #2 does not begin where e1 of face #0 ends"),
        ("0:e1+1:e1+0:e1", "e1 of face #0 is there twice"),
        ("0:e1+99:e1", r"boxes.brep#99: no such surface"),
        ("0:e9+1:e1", "found 'e9', but face #0 .* its edges are e0 to e3"),
        ("e1+1:e1", "holds 17 surfaces"),
        ("0:e1+1:e2", "does not begin where|have no common side edge|touch"),
    ],
)
def test_edges_that_are_no_chain_are_refused(boxes, word, said):
    with pytest.raises((EdgeError, FileError), match=said):
        resolve_edge(boxes, word)


def is_exact(chain):
    """Whether a blend meets each face, with ten times of what rounding leaves here."""
    limits = {"gap": 1e-12, "angle_degrees": 1e-9, "curvature_jump_relative": 1e-7}
    return all(chain.worst(name) <= limit for name, limit in limits.items())


def creases(result):
    """The angles between the pieces of a blend, cut at all joints, and across its seam."""
    pieces = faces_of_blend(result, "joints")
    pairs = pairwise([*pieces, pieces[0]] if result.chain_a.closed else pieces)
    return [measure_contact(Base(one, "v1"), Base(other, "v0"), order=2).angle_degrees for one, other in pairs]


def test_an_oval_to_a_round_tube(ovals):
    """Contact with each of the eight faces, no crease inside; what its profile jumps by is said."""
    a, b = resolve_edges([(ovals, "0:e1*"), (ovals, "4:e3*")])
    (result,) = blend_edges(a, b, **QUICK)
    assert result.edges == ("e1+1:e1+2:e1+3:e1", "e3+7:e3+6:e3+5:e3")
    assert is_exact(result.chain_a)
    assert is_exact(result.chain_b)
    assert len(creases(result)) == 8
    for one, other in pairwise(faces_of_blend(result, "joints")):
        assert (one.control_points[:, -1] == other.control_points[:, 0]).all()
        assert (one.weights[:, -1] == other.weights[:, 0]).all()
    assert max(creases(result)) <= 1e-9
    assert {face.edge for face in result.chain_a.faces} == {"e1", "1:e1", "2:e1", "3:e1"}
    jumps = [note for note in result.chain_a.notes() if "curvature along the contact jumps" in note]
    assert len(jumps) == 4
    assert result.chain_b.notes() == ()
    assert len(faces_of_blend(result)) == 1


@pytest.mark.long
def test_pieces_have_the_same_control_points_along_their_edge(boxes):
    a, b = resolve_edges([(boxes, "0:e1+1:e1+2:e1+3:e1"), (boxes, "4:e3+5:e3+6:e3+7:e3")])
    (result,) = blend_edges(a, b, **QUICK)
    pieces = faces_of_blend(result)
    assert len(pieces) == 4
    for one, other in pairwise(pieces):
        assert (one.control_points[:, -1] == other.control_points[:, 0]).all()
    notes = result.chain_a.notes()
    assert len(notes) == 4
    assert all("corner of 90 degrees, the blend is split there" in note for note in notes)
    assert "fades" not in "".join(notes)


@pytest.mark.long
def test_corners_of_one_side_fade_out_and_are_said(boxes):
    a, b = resolve_edges([(boxes, "0:e1+1:e1+2:e1+3:e1"), (boxes, "8:e3*")])
    (result,) = blend_edges(a, b, **QUICK)
    assert all("the other side has none there: it fades out" in note for note in result.chain_a.notes())
    assert len(faces_of_blend(result)) == 4


@pytest.mark.long
def test_the_rim_of_a_plane_with_corners(boxes):
    """No line of its parameters leads into the face from a corner: strips of the plane do, half way between."""
    a, b = resolve_edges([(boxes, "16:e0..e3"), (boxes, "4:e3+5:e3+6:e3+7:e3")])
    (result,) = blend_edges(a, b, **QUICK)
    assert result.chain_a.corners == result.chain_b.corners == 4
    assert max(face.band.gap for face in result.chain_a.faces) <= 1e-12
    assert max(face.band.angle_degrees for face in result.chain_a.faces) <= 1e-9


@pytest.mark.long
def test_a_ring_of_rounds_becomes_one_blend(rounded):
    """Eight lines and arcs of the top, eight walls below: extruded and revolved, with as few points as can be."""
    a, b = resolve_edges([(rounded, "7:e0*"), (rounded, "0:e1*")])
    (result,) = blend_edges(a, b, **QUICK)
    # Six rows of 17 points: degree 2 along, four lines and four arcs.
    assert (result.rows_stored, result.rows_converted) == (102, 102)
    assert [face.band is not None for face in result.chain_a.faces] == [True] * 8
    assert max(face.band.gap for face in result.chain_a.faces) <= 1e-12
    assert is_exact(result.chain_b)
    assert max(creases(result)) <= 1e-9
    # Its rows are only continuous there: a face of a file may not be.
    assert len(faces_of_blend(result)) == 8
    with pytest.raises(EdgeError, match="expected an edge on it"):
        measure_chain_contact(a, b)


def test_edges_on_one_line_of_a_face_are_one_base(tmp_path):
    path = written(tube(round_edges(8, 0, [0, 120, 240]), 10), tmp_path / "arcs.brep")
    (side,) = edge_bases([resolve_edge(path, "0:e1+1:e1")])
    assert [base.edge for base in side[0].bases] == ["v0", "v0"]


@pytest.mark.long
def test_a_curve_that_is_cut_where_its_face_bends_is_one_chain():
    """Of a free curve with two bands, whose face's curvature jumps: one blend to an edge of one piece."""
    bands = band_along(bent_face(0.07), cubic((-0.8, 0.2), (-0.3, 0.8), (0.3, 0.3), (0.8, 0.7)))
    parts = [EdgeBase(f"e0[{k}]", band.base, band) for k, band in enumerate(bands)]
    sheet = EdgeBase("u0", Base(plane([-2.4, -1, 2], [0, 0, 1], [4.8, 2, 0]), "u0"))
    ((one, other),) = paired_bases(parts, [sheet])
    assert (one.name, other.name, len(one.members)) == ("e0", "u0", 2)
    without_faces = [EdgeBase(part.name, part.base) for part in parts]
    ((one, other),) = paired_bases(without_faces, [sheet])
    result = blend_bases(one, other, BlendOptions(alpha="natural", limits="cad"))
    assert result.chain_a.worst("angle_degrees") <= 0.01
    assert [joint.kind for joint in result.chain_a.joints] == ["creased"]


def test_parts_of_edges_follow_each_other_whichever_way_their_edges_run():
    def part(x, to):
        return EdgeBase(f"{x}{to}", Base(plane([x, 0, 0], [0, 1, 0], [to - x, 0, 0]), "u0"))

    first, second, third = [part(0, 1), part(1, 2)], [part(2, 3)], [part(3, 4), part(4, 5)]
    back = [[part(2, 1), part(1, 0)], [part(3, 2)], [part(5, 4), part(4, 3)]]
    assert [x.name for x in in_order([first, second, third])] == ["01", "12", "23", "34", "45"]
    assert [x.name for x in in_order(back)] == ["10", "21", "32", "43", "54"]
    assert [x.name for x in in_order([back[0], second, back[2]])] == ["10", "21", "23", "43", "54"]
    assert [x.name for x in in_order([back[0]])] == ["21", "10"]


def test_generated_words_of_other_faces_have_their_number(ovals):
    a, b = resolve_edges([(f"{ovals}#1", "e1+2:e1"), (f"{ovals}#4", "e3")])
    (result,) = blend_edges(a, b, **QUICK)
    assert result.edges == ("e1+2:e1", "v1")
    assert np.isfinite(result.surface.control_curves[0].control_points).all()
