"""Edges of 3dm files, whose curves in the parameters are found by projection."""

import numpy as np
import pytest
import rhino3dm

from helpers.sweeps import first_ones, first_rows
from semispline import list_edges, resolve_edge
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.listing import place_lines
from semispline.solver.topology.places import find_places, places_of
from semispline.solver.topology.reading import read_edges


def written(path, *breps):
    file = rhino3dm.File3dm()
    for brep in breps:
        file.Objects.AddBrep(brep)
    assert file.Write(str(path), 7)
    return path


def box():
    return rhino3dm.Brep.CreateFromBox(rhino3dm.Box(rhino3dm.BoundingBox(0, 0, 0, 2, 3, 5)))


def cylinder():
    circle = rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 2.0)
    return rhino3dm.Cylinder(circle, 5.0).ToBrep(True, True)


def sphere():
    return rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0).ToBrep()


@pytest.fixture
def graph(tmp_path):
    return lambda *breps: read_edges(written(tmp_path / "part.3dm", *breps))


def test_a_box(graph):
    g = graph(box())
    uses = g.uses
    assert (len(g.faces), len(uses), len(set(uses.edge.tolist()))) == (6, 24, 12)
    assert (uses.edge[uses.other] == uses.edge).all()
    assert not (uses.naked | uses.seam | uses.degenerate).any()
    centre = np.array([1, 1.5, 2.5])
    assert (np.sum(uses.normal[:, 4] * (uses.points[:, 4] - centre), axis=1) > 0).all()
    middles = np.stack([uses.points[uses.of_face(face), [0]].mean(axis=0) for face in uses.face])
    assert (np.sum(uses.inward[:, 4] * (middles - uses.points[:, 4]), axis=1) > 0).all()
    assert len(places_of(g).of_kind("sharp edge")) == 3


def test_two_parts_share_no_edge(graph):
    uses = graph(box(), sphere(), box()).uses
    counts = np.unique(uses.edge[~uses.degenerate], return_counts=True)[1]
    assert sorted(counts.tolist()) == [2] * 25


def test_a_cylinder_and_a_ball_have_seams(graph):
    g = graph(cylinder(), sphere())
    uses = g.uses
    assert uses.seam.sum() == 4
    assert (uses.twin[uses.twin[uses.seam]] == np.flatnonzero(uses.seam)).all()
    assert (uses.other[uses.seam] == NONE).all()
    # The poles of the ball.
    assert uses.degenerate.sum() == 2
    assert set(uses.pcurve[uses.degenerate].tolist()) == {"none"}
    assert (uses.pcurve[~uses.degenerate] == "projected").all()


@pytest.mark.parametrize(
    "name", first_ones(1, ["v3_T-Joint2.3dm", "v4_DinerMug.3dm", "v4_MechPartA.3dm", "v4_SolidHandle.3dm"])
)
def test_edges_of_real_files_lie_on_their_faces_and_are_walked(shared, name):
    g = read_edges(shared / "data/cad" / name)
    uses, known = g.uses, g.uses.pcurve != "none"
    assert (known | uses.degenerate).all()
    # Edges of these files are off their faces by up to 8.2e-4 of the size.
    assert uses.tolerance.max() < 1e-3 * g.size
    walked = np.array([uses.walked_points(use) for use in range(len(uses))])
    meets = known & known[uses.following]
    assert np.linalg.norm(walked[:, -1] - walked[uses.following, 0], axis=1)[meets].max() < 2e-3 * g.size
    shared_uses = np.flatnonzero(uses.other != NONE)
    assert len(shared_uses)
    # Two faces of a body walk an edge against each other.
    tangents = np.sum(uses.tangent[shared_uses, 4] * uses.tangent[uses.other[shared_uses], 4], axis=1)
    assert (tangents < -0.9).all()


@pytest.mark.parametrize(("name", "edges"), first_rows(1, [("v4_MechPartA.3dm", 94), ("v4_SolidHandle.3dm", 93)]))
def test_every_edge_of_a_closed_body_has_two_uses(shared, name, edges):
    uses = read_edges(shared / "data/cad" / name).uses
    assert np.unique(uses.edge, return_counts=True)[1].tolist() == [2] * edges
    assert not uses.naked.any()


@pytest.mark.long
def test_fillets_of_a_real_file(shared):
    places = find_places(shared / "data/cad/v4_MechPartA.3dm")
    assert [(len(x.faces), 1 + len(x.repeats)) for x in places.of_kind("fillet")] == [(1, 4)] * 4
    assert places.unit is not None


def test_a_file_without_surfaces_says_what_it_holds(shared):
    (line,) = place_lines(find_places(shared / "data/cad/v6_rhino_subd_logo.3dm"))
    assert line.startswith("no surfaces: 6 meshes, 6 SubD")


def test_edges_of_3dm_files_are_named(tmp_path):
    """A cylinder with its caps: a seam with a side each, rims; the caps' rims are free curves."""
    path = written(tmp_path / "part.3dm", cylinder(), box())
    kinds = [(edge.kind, edge.edge, edge.seam) for edge in list_edges(path, 0).edges]
    assert sorted((kind, edge) for kind, edge, seam in kinds if seam) == [("whole", "u0"), ("whole", "u1")]
    assert sorted((kind, edge) for kind, edge, seam in kinds if not seam) == [("whole", "v0"), ("whole", "v1")]
    cap = list_edges(path, 1)
    assert {edge.kind for edge in cap.edges} == {"free"}
    assert sum(edge.length for edge in cap.edges) == pytest.approx(4 * np.pi, rel=1e-9)
    assert {edge.neighbour for edge in cap.edges} == {0}
    wall = list_edges(path, 3)
    assert sorted(edge.edge for edge in wall.edges) == ["u0", "u1", "v0", "v1"]
    named = next(edge for edge in wall.edges if edge.edge == "u1")
    word = "near=" + ",".join(map(str, named.middle))
    assert resolve_edge(f"{path}#3", word).entry.name == named.name
    assert wall.tolerance == pytest.approx(1e-4 * read_edges(path).size)


@pytest.mark.long
def test_a_pole_of_a_3dm_file_is_a_point(tmp_path):
    face = list_edges(written(tmp_path / "ball.3dm", sphere()), 0)
    assert sorted(edge.kind for edge in face.edges) == ["point", "point", "whole", "whole"]
    assert sorted(edge.edge for edge in face.edges if edge.edge) == ["u0", "u1"]
