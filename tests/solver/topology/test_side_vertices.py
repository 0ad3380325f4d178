"""Vertices inside sides of faces as fillets have them: classed, counted in real files, blended as chains."""

from collections import Counter
from functools import cache

import pytest

from helpers.parts import compound, graph_of, rounded_box
from helpers.profiles import oval_edges, tube
from semispline import blend_edges
from semispline.solver.topology.contact_words import beyond, contact_word, linked
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.relations import relate
from semispline.solver.topology.resolving import resolve_edges
from semispline.solver.topology.side_vertices import side_vertices

pytestmark = pytest.mark.usefixtures("reads_here")

NAMES = [
    "build123d_M6-1x12-countersunk-screw.step",
    "cadquery_red_cube_blue_cylinder.step",
    "demos_as1_pe_203.stp",
    "demos_face_recognition_sample_part.stp",
    "demos_splinecage.stp",
    "occt_bottle.brep",
    "occt_screw.step",
    "occt_shell1.brep",
    "tigl_bug815_cell_upper.brep",
    "tigl_face.stp",
    "tigl_resultShape.brep",
    "tigl_simplewing.brep",
]


@cache
def classed(path):
    graph = read_edges(path)
    relations = relate(graph)
    return graph, relations, side_vertices(graph, relations)


def test_faces_of_a_part_without_such_vertices_have_none():
    graph = graph_of(rounded_box())
    assert side_vertices(graph, relate(graph)) == []
    graph = graph_of(compound([tube(oval_edges(30, 10, 0), 10)]))
    assert side_vertices(graph, relate(graph)) == []


@pytest.mark.long
def test_vertices_of_real_files_are_classed(shared):
    """Seven lie between two faces beyond, as counted in another way; three of these go on smoothly."""
    counts = Counter()
    for name in NAMES:
        counts.update(x.kind for x in classed(shared / "data/cad" / name)[2])
    assert counts == {"smooth": 3, "creased": 2, "corner": 2, "same face": 2}


@pytest.mark.long
def test_all_that_go_on_blend_in_contact_with_each_face(shared):
    """The file has gaps of 1e-5 and side edges as far apart: limits of checkers, and said by how much was moved."""
    path = shared / "data/cad/occt_shell1.brep"
    graph, relations, vertices = classed(path)
    blended = 0
    for vertex in vertices:
        if vertex.kind not in ("smooth", "creased"):
            continue
        side, opposite = vertex.sides[0], vertex.sides[2]
        words = []
        for uses in (side, opposite):
            # Where nothing lies beyond the face itself is met.
            runs = linked(graph, relations, beyond(relations, uses) or uses)
            assert len(runs) == 1
            words.append(contact_word(graph, relations, runs[0]))
        a, b = resolve_edges([(str(path), word) for word in words])
        assert len(a.edges) == 2
        (result,) = blend_edges(a, b, alpha="natural")
        assert result.chain_a.limits == "cad"
        # The limits: a micrometre and a hundredth of a degree; curvature 2 %.
        assert result.chain_a.worst("gap") <= 1e-3
        assert result.chain_a.worst("angle_degrees") <= 0.01
        assert result.chain_a.worst("curvature_jump_relative") <= 0.02
        assert {face.edge for face in result.chain_a.faces} == set(a.names)
        assert any("the edges meet within" in note for note in result.chain_a.notes())
        blended += 1
    assert blended == 5
