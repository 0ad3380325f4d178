import pickle

import numpy as np
import pytest
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)

from helpers.parts import graph_of, written
from semispline.solver.errors import FileError
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.reading import read_edges


def box():
    return BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape()


def cylinder():
    return BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape()


def sphere():
    return BRepPrimAPI_MakeSphere(2.0).Shape()


def cone():
    return BRepPrimAPI_MakeCone(2.0, 0.0, 5.0).Shape()


def torus():
    return BRepPrimAPI_MakeTorus(5.0, 1.0).Shape()


SHAPES = (box, cylinder, sphere, cone, torus)
TWICE = [(make, turned) for make in SHAPES for turned in (False, True)]


def graph(make, turned=False):
    return graph_of(make().Reversed() if turned else make())


def test_a_box_has_24_uses_of_12_edges():
    g = graph(box)
    uses = g.uses
    assert (len(g.faces), len(uses), len(set(uses.edge.tolist()))) == (6, 24, 12)
    assert uses.number.tolist() == [0, 1, 2, 3] * 6
    assert [uses.name(i) for i in range(*uses.of_face(3).indices(99))] == ["e0", "e1", "e2", "e3"]
    assert not (uses.seam | uses.degenerate | uses.naked).any()
    assert (uses.edge[uses.other] == uses.edge).all()
    assert (uses.face[uses.other] != uses.face).all()
    assert (uses.other[uses.other] == np.arange(24)).all()
    assert (uses.twin == NONE).all()
    assert set(uses.pcurve.tolist()) == {"line"}
    assert uses.proven.all()
    lengths = np.linalg.norm(uses.points[:, -1] - uses.points[:, 0], axis=1)
    assert sorted(lengths.round(9).tolist()) == [2.0] * 8 + [3.0] * 8 + [5.0] * 8
    assert g.size == pytest.approx(5.0)
    assert set(g.faces.kind) == {"plane"}


def test_a_cylinder_has_its_seam_twice():
    g = graph(cylinder)
    uses = g.uses
    (side,) = (n for n, kind in enumerate(g.faces.kind) if kind == "cylinder")
    rows = range(*uses.of_face(side).indices(len(uses)))
    seams = [i for i in rows if uses.seam[i]]
    rims = [i for i in rows if not uses.seam[i]]
    assert (len(seams), len(rims)) == (2, 2)
    assert [uses.twin[i] for i in seams] == seams[::-1]
    assert (uses.other[seams] == NONE).all()
    assert not uses.naked.any()
    # One of its curves in the parameters lies at the start of the turn and one at its end.
    assert sorted(uses.uv[seams, 4, 0].tolist()) == pytest.approx([0.0, 2 * np.pi])
    assert {g.faces.kind[uses.face[uses.other[i]]] for i in rims} == {"plane"}
    assert g.faces.ends[side].tolist() == pytest.approx([0.0, 2 * np.pi, 0.0, 5.0])


def test_a_sphere_has_poles():
    uses = graph(sphere).uses
    assert uses.degenerate.sum() == 2
    assert uses.seam.sum() == 2
    assert not uses.naked[uses.degenerate].any()
    assert (uses.other == NONE).all()
    # Normals in a pole are those of the next sample, and no number is missing.
    assert np.isfinite(uses.across).all()
    assert np.isfinite(uses.inward).all()


@pytest.mark.parametrize(("make", "turned"), TWICE)
def test_ends_of_walked_edges_meet(make, turned):
    uses = graph(make, turned).uses
    walked = np.array([uses.walked_points(i) for i in range(len(uses))])
    assert np.abs(walked[:, -1] - walked[uses.following, 0]).max() < 1e-12
    assert (uses.following[uses.previous] == np.arange(len(uses))).all()


@pytest.mark.parametrize(("make", "turned"), TWICE)
def test_normals_look_out_and_the_inward_direction_stays_in_the_face(make, turned):
    g = graph(make, turned)
    uses = g.uses
    inner = ~uses.degenerate
    centre = {box: [1, 1.5, 2.5], cylinder: [0, 0, 2.5], sphere: [0, 0, 0], cone: [0, 0, 1]}.get(make)
    middle = uses.points[:, 4]
    if make is torus:
        centre = middle * np.array([1, 1, 0]) * 5 / np.linalg.norm(middle * [1, 1, 0], axis=1)[:, None]
    out = np.sum(uses.normal[:, 4] * (middle - centre), axis=1)
    assert (np.sign(out[inner]) == (-1 if turned else 1)).all()
    # A step to the inside changes the parameters towards the middle of the face, and away from its curve.
    low, high = g.faces.ends[uses.face, ::2], g.faces.ends[uses.face, 1::2]
    if make is not box:
        # A seam shows whether both uses point to their own side.
        uv, ends = uses.uv[:, 4], (low + high) / 2
        for i in np.flatnonzero(inner & uses.seam):
            across = np.argmax(np.ptp(uses.box[i], axis=0) == 0)
            step = uses.inward[i, 4] @ slope_of(make, uv[i], across)
            assert np.sign(step) == np.sign(ends[i, across] - uv[i, across])
    else:
        assert (np.sum(uses.inward[:, 4] * (centre_of_face(uses) - middle), axis=1) > 0).all()


def centre_of_face(uses):
    return np.stack([uses.points[uses.of_face(f), [0]].mean(axis=0) for f in uses.face])


def slope_of(make, uv, across):
    """The direction in which the parameter `across` grows, of shapes of revolution about z, and of a torus."""
    u, v = uv
    if across == 0:
        return np.array([-np.sin(u), np.cos(u), 0])
    assert make is torus
    return np.array([-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v)])


@pytest.mark.parametrize(("make", "turned"), TWICE)
def test_two_faces_walk_an_edge_against_each_other(make, turned):
    uses = graph(make, turned).uses
    partner = np.where(uses.other != NONE, uses.other, uses.twin)
    both = (partner != NONE) & ~uses.degenerate
    assert both.sum() == len(uses) - uses.degenerate.sum()
    assert np.sum(uses.tangent[both, 4] * uses.tangent[partner[both], 4], axis=1) == pytest.approx(-1.0)
    assert np.abs(uses.points[both] - uses.points[partner[both]]).max() < 1e-12


def test_curvature_across_is_negative_where_the_face_bends_away():
    g = graph(torus)
    for i in range(len(g.uses)):
        k = g.uses.across[i], g.uses.along[i]
        if np.ptp(g.uses.box[i], axis=0)[0] > 1:  # round the axis on the outside, radius 6; across the tube
            assert k[0] == pytest.approx(-1.0)
            assert k[1] == pytest.approx(-1 / 6)
        else:
            assert k[1] == pytest.approx(-1.0)
    hollow = graph(cylinder, turned=True).uses
    rim = np.flatnonzero((hollow.pcurve == "line") & ~hollow.seam & (np.abs(hollow.along[:, 4]) > 0.1))
    assert hollow.along[rim] == pytest.approx(0.5)
    assert hollow.across[rim] == pytest.approx(0.0)


@pytest.mark.long
def test_the_table_passes_from_one_process_to_another(tmp_path):
    path = written(cylinder(), tmp_path / "cylinder.brep")
    found, here = read_edges(path), graph(cylinder)
    again = pickle.loads(pickle.dumps(found))
    for g in (found, again):
        assert g.path == str(path)
        assert g.faces.kind == here.faces.kind
        assert g.uses.points == pytest.approx(here.uses.points)
        assert g.uses.other.tolist() == here.uses.other.tolist()


def test_other_formats_are_refused(tmp_path):
    path = tmp_path / "part.obj"
    path.write_text("")
    with pytest.raises(FileError, match=r"\.obj.*expected one of \.step"):
        read_edges(path)
