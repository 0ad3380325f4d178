"""Naked edges that face each other: parts of which one face was taken out, sheets, and files that are not sewn."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.IGESControl import IGESControl_Writer

from helpers.parts import compound, graph_of, rounded_box, unsewn, without
from helpers.random_parts import known_part
from helpers.sweeps import examples, first_ones
from semispline import BSplineSurface
from semispline.solver.io.occ import _faces
from semispline.solver.io.occ_writing import occ_surface
from semispline.solver.topology.fillets import fillet_ends, find_fillets
from semispline.solver.topology.gaps import find_gaps, gap_parts, holes
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.places import places_of
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.relations import by_arc_length, relate
from semispline.solver.topology.sides import cut_ring


def gaps_of(graph):
    relations = relate(graph)
    accepted = find_fillets(graph, relations).accepted
    return find_gaps(graph, relations, fillet_ends(graph, relations, accepted.values()))


def rank(shape, between, whole):
    """The place in the list of the gap that a fillet leaves; edges are known by their middle points."""
    graph = graph_of(without(shape, between.face))
    for number, gap in enumerate(gaps_of(graph), start=1):
        found = [{tuple(graph.uses.points[use, 4].round(6)) for use in side.uses} for side in (gap.a, gap.b)]
        wanted = [{tuple(whole.uses.points[use, 4].round(6)) for use in side.uses} for side in (between.a, between.b)]
        if any(wanted[0] & one and wanted[1] & two for one, two in (found, found[::-1])):
            return number
    return None


@pytest.mark.parametrize("seed", first_ones(4, list(range(40))))
def test_a_fillet_that_was_taken_out_is_found_as_a_gap(seed):
    shape = known_part(seed).shape
    graph = graph_of(shape)
    accepted = find_fillets(graph, relate(graph)).accepted
    assert accepted
    assert [rank(shape, between, graph) for between in accepted.values()] == [1] * len(accepted)


@pytest.mark.long
def test_of_a_chain_one_taken_out_is_found_too():
    shape = rounded_box()
    graph = graph_of(shape)
    accepted = find_fillets(graph, relate(graph)).accepted
    ranks = [rank(shape, between, graph) for between in accepted.values()]
    assert max(ranks) <= 2
    assert ranks.count(1) >= 0.9 * len(ranks)


def sheet(*corners):
    return BRepBuilderAPI_MakeFace(
        occ_surface(BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], np.reshape(corners, (2, 2, 3)))), 1e-7
    ).Face()


def two_sheets(gap=4.0, turned=False):
    left = sheet([0, 0, 0], [0, 30, 0], [10, 0, 0], [10, 30, 0])
    a, b = 10 + gap, 20 + gap
    corners = [[a, 0, 0], [a, 30, 0], [b, 0, 0], [b, 30, 0]]
    if turned:
        corners = [corners[k] for k in (1, 0, 3, 2)]
    return compound([left, sheet(*corners)])


@pytest.mark.parametrize("turned", [False, True])
def test_two_sheets_face_each_other(turned):
    graph = graph_of(two_sheets(turned=turned))
    best, *_ = gaps_of(graph)
    assert best.width == pytest.approx(4.0)
    assert best.length == pytest.approx(30.0)
    assert (best.even, best.facing_a, best.facing_b) == pytest.approx((1.0, 1.0, 1.0))
    assert not best.same_hole
    assert gap_parts(best) == pytest.approx(
        {"facing": 1.0, "even": 1.0, "lengths": 1.0, "near": 30 / 34, "on_end": 1.0, "hole": 0.8}
    )
    assert {graph.uses.face[side.uses[0]] for side in (best.a, best.b)} == {0, 1}


@pytest.mark.parametrize(("gap", "count"), [(89.0, 1), (91.0, 0)])
def test_sheets_further_apart_than_three_lengths_are_no_gap(gap, count):
    graph = graph_of(two_sheets(gap))
    assert sum(found.length > 29 for found in gaps_of(graph)) == count


def test_what_has_no_hole_has_no_gap():
    for shape in (BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape(), sheet([0, 0, 0], [0, 3, 0], [1, 0, 0], [1, 3, 0])):
        assert gaps_of(graph_of(shape)) == []


def test_a_hole_is_walked_round_from_face_to_face():
    graph = graph_of(without(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape(), 0))
    (loop,) = holes(graph, relate(graph))
    assert len({graph.uses.face[use] for use in loop}) == 4
    ends = [(graph.uses.walked_points(use)[-1], graph.uses.walked_points(use)[0]) for use in loop]
    # The hole runs against the faces: where one edge ends in it, the next begins.
    assert all(np.allclose(ends[k - 1][1], ends[k][0]) for k in range(4))
    assert len(gaps_of(graph)) == 2


def test_faces_with_edges_of_their_own_are_matched():
    graph = graph_of(unsewn(rounded_box()))
    relations = relate(graph)
    assert graph.uses.naked.all()
    assert not relations.naked.any()
    assert (relations.partner[relations.partner] == np.arange(len(graph.uses))).all()
    assert gaps_of(graph) == []


def test_faces_that_disagree_on_what_is_outside_are_matched_and_measured():
    faces = list(_faces(unsewn(rounded_box())))
    graph = graph_of(compound(face.Reversed() if n % 2 else face for n, face in enumerate(faces)))
    relations = relate(graph)
    assert np.nanmax(relations.median[relations.smooth]) < 0.1
    assert len(find_fillets(graph, relations).accepted) == 12


@pytest.mark.long
def test_a_file_that_is_not_sewn_gives_what_its_solid_gives(tmp_path):
    path = tmp_path / "part.igs"
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(rounded_box())
    writer.ComputeModel()
    writer.Write(str(path))
    graph = read_edges(path)
    assert graph.unit == "mm"
    assert graph.uses.naked.all()
    found = places_of(graph)
    of_solid = places_of(graph_of(rounded_box()))
    for kind in ("fillet", "chain", "gap", "chamfer", "sharp edge"):
        pairs = [(len(x.faces), 1 + len(x.repeats), round(x.score, 3)) for x in found.of_kind(kind)]
        assert pairs == [(len(x.faces), 1 + len(x.repeats), round(x.score, 3)) for x in of_solid.of_kind(kind)], kind


def test_edges_that_only_cross_are_not_matched():
    crossing = compound(
        [sheet([-5, 0, 0], [-5, 9, 0], [5, 0, 0], [5, 9, 0]), sheet([0, 0, -5], [0, 9, -5], [0, 0, 5], [0, 9, 5])]
    )
    relations = relate(graph_of(crossing))
    assert (relations.partner == NONE).all()


@examples()
@given(st.lists(st.booleans(), min_size=1, max_size=9))
def test_a_ring_is_cut_into_runs(cuts):
    ring = list(range(len(cuts)))
    runs, whole = cut_ring(ring, lambda _, two: cuts[two])
    assert whole == (not any(cuts))
    flat = [x for run in runs for x in run]
    assert sorted(flat) == ring
    assert all((flat[k] + 1) % len(ring) == flat[(k + 1) % len(ring)] for k in range(len(flat)))
    if not whole:
        assert all(cuts[run[0]] and not any(cuts[x] for x in run[1:]) for run in runs)


@examples()
@given(st.lists(st.floats(0.01, 10), min_size=1, max_size=8), st.integers(2, 20))
def test_places_by_arc_length_are_equally_far(steps, count):
    line = np.stack([np.r_[0, np.cumsum(steps)], np.zeros(len(steps) + 1), np.zeros(len(steps) + 1)], axis=1)
    found = by_arc_length(line, count)
    # One rounding of a sum of at most eight steps in each of two differences.
    assert np.diff(found[:, 0]) == pytest.approx(sum(steps) / (count - 1), rel=1e-9)
