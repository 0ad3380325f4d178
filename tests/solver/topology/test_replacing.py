"""The two bases beside a face: which pair of edges is taken, what is refused, and the blend of them."""

import numpy as np
import pytest
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere

from helpers.parts import edges_of_shape, fillet, graph_of, reordered, rounded_box, unsewn, without, written
from semispline import EdgeError, FileError, blend_edges, replaced_pair
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.relations import relate
from semispline.solver.topology.replacing import opposite_pairs, pair_of, rows_beyond

pytestmark = pytest.mark.usefixtures("read_here")


def rounded_pin():
    """A cylinder whose upper rim is rounded: the torus between has two rims and a seam."""
    return fillet(BRepPrimAPI_MakeCylinder(5.0, 8.0).Shape(), 1.5, lambda point, _: point[2] > 7.9)


def chamfered_box():
    box = BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape()
    maker = BRepFilletAPI_MakeChamfer(box)
    maker.Add(2.0, edges_of_shape(box)[0])
    return maker.Shape()


def ball():
    return BRepPrimAPI_MakeSphere(2.0).Shape()


def kinds_beyond(graph, between):
    return sorted(graph.faces.kind[graph.uses.face[row]] for row in rows_beyond(graph, between))


@pytest.mark.parametrize(
    "make", [rounded_box, lambda: unsewn(rounded_box()), lambda: reordered(rounded_box(), range(17, -1, -1))]
)
def test_a_fillet_is_taken_from_the_base_to_the_base(make):
    """Along the upright and the upper edges of the box, whatever the order of faces and whether they are sewn."""
    graph = graph_of(make())
    relations = relate(graph)
    fillets = find_fillets(graph, relations).accepted
    assert len(fillets) == 12
    for face, between in fillets.items():
        taken = pair_of(graph, relations, face)
        assert {taken.a.uses, taken.b.uses} == {between.a.uses, between.b.uses}
        assert taken.turn == pytest.approx(90, abs=1e-6)
        # Rounds of 3 upright, of 1.5 above; the radius of those round the corners is that across.
        assert min(abs(taken.radius - 3), abs(taken.radius - 1.5)) < 0.01
    straight = [pair_of(graph, relations, face) for face in fillets if graph.faces.kind[face] == "cylinder"]
    assert all(kinds_beyond(graph, taken) == ["plane", "plane"] for taken in straight)


def test_both_pairs_of_a_face_with_four_edges_are_known():
    graph = graph_of(rounded_box())
    relations = relate(graph)
    face = next(
        face for face, x in find_fillets(graph, relations).accepted.items() if graph.faces.kind[face] == "cylinder"
    )
    one, other = opposite_pairs(graph, relations, face)
    names = [{graph.uses.name(x.uses[0]) for x in (pair.a, pair.b)} for pair in (one, other)]
    assert names == [{"e0", "e2"}, {"e1", "e3"}]
    # A cylinder does not turn along itself.
    assert min(one.turn, other.turn) == pytest.approx(0, abs=1e-6)
    assert pair_of(graph, relations, face).turn == max(one.turn, other.turn)
    assert pair_of(graph, relations, face, "e3", "e1").a.uses == other.b.uses


def test_two_rims_and_a_seam():
    graph = graph_of(rounded_pin())
    relations = relate(graph)
    face = graph.faces.kind.index("torus")
    taken = pair_of(graph, relations, face)
    assert taken.a.closed
    assert taken.b.closed
    assert kinds_beyond(graph, taken) == ["cylinder", "plane"]


def test_a_chamfer_is_taken_between_its_long_edges():
    graph = graph_of(chamfered_box())
    relations = relate(graph)
    chamfers = [face for face in range(7) if len(list(opposite_pairs(graph, relations, face))) == 2]
    widths = {face: pair_of(graph, relations, face).width for face in chamfers}
    # The face that was cut off is 2 sqrt(2) wide; all others are at least 8.
    assert sorted(widths.values())[0] == pytest.approx(2 * np.sqrt(2))


@pytest.mark.parametrize(
    ("make", "face", "edges", "words"),
    [
        (rounded_box, 0, ("e0", None), "found one of them, expected none or two edges of face #0"),
        (rounded_box, 0, ("e1", "e1"), "--edge-b: found 'e1' as at A, expected another edge of face #0"),
        (rounded_box, 0, ("e0", "e9"), "--edge-b: found 'e9', but face #0 .* its edges are e0 to e"),
        (rounded_box, 0, ("u0", "e1"), "--edge-a: found 'u0', expected an edge of face #0 .*, as e0"),
        (ball, 0, (None, None), "no two opposite edges with .*: e0 .* is a point"),
        (ball, 0, ("e0", "e1"), "is a point|is a seam: this face lies on both its sides"),
        (lambda: without(rounded_pin(), 0), 0, (None, None), "no other face lies beyond it"),
    ],
)  # fmt: skip
def test_what_is_refused_says_why(make, face, edges, words):
    graph = graph_of(make())
    if words.startswith("no other face"):
        face = graph.faces.kind.index("torus")
    with pytest.raises(EdgeError, match=words):
        pair_of(graph, relate(graph), face, *edges)


def test_the_blend_lies_between_the_planes_of_the_box(tmp_path):
    path = written(rounded_box(), tmp_path / "part.brep")
    graph = graph_of(rounded_box())
    face = next(face for face in find_fillets(graph, relate(graph)).accepted if graph.faces.kind[face] == "cylinder")
    pair = replaced_pair(path, face)
    assert pair.face == face
    assert pair.said.startswith(f"face #{face} replaced from {pair.contacts[0]} to {pair.contacts[1]}: ")
    assert pair.angles == pytest.approx((0, 0), abs=1e-6)
    (result,) = blend_edges(pair.a, pair.b)
    assert result.warnings == ()
    at = np.linspace(0, 1, 5)
    surface = result.surface.to_bspline()
    v = surface.domain[1]
    points = surface.evaluate_grid(at, np.linspace(*v, 5)).reshape(-1, 3)
    low, high = np.array([0.0, 0, 0]), np.array([40.0, 30, 20])
    # It stays in the box, touches it along both contacts, and cuts its edge off.
    assert (points >= low - 1e-9).all()
    assert (points <= high + 1e-9).all()
    inside = np.minimum(points - low, high - points).reshape(5, 5, 3)
    assert np.sort(inside[[0, -1]], axis=2)[..., 0] == pytest.approx(np.zeros((2, 5)), abs=1e-9)
    # But where it begins, at the bottom.
    assert (np.sort(inside[1:-1, 1:], axis=2)[..., 0] > 1e-3).all()


def test_no_such_face(tmp_path):
    path = written(rounded_box(), tmp_path / "part.brep")
    with pytest.raises(FileError, match="#99: no such surface; the file holds 18"):
        replaced_pair(path, 99)
