"""Sharp edges of solids rounded by a blend: known volumes, edges at any angle, closed rims, and what is refused."""

import math

import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from typer.testing import CliRunner

from helpers.parts import graph_of, written
from helpers.solids import box, box_with_fillet, cut, cylinder, half_space, volume
from helpers.sweeps import first_ones, first_rows
from semispline import EdgeError, SolidError, round_edge
from semispline.solver.cli import app
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import parts
from semispline.solver.topology.relations import relate

pytestmark = pytest.mark.usefixtures("read_here")
# The shape is fixed: alpha is found in closed form, and the section takes away 559/4096 of the square of the distance.
FIXED = {"degree_u": 3, "middle_curves": 0, "v_scale": "length", "alpha": "energy", "p2": "zero"}


def sharp_edges(shape):
    """Face, name, length and whether it is convex, of each edge once."""
    graph = graph_of(shape)
    relations = relate(graph)
    for row in range(len(graph.uses)):
        if relations.sharp[row] and row < relations.partner[row]:
            yield (
                int(graph.uses.face[row]),
                graph.uses.name(row),
                float(relations.length[row]),
                bool(relations.convex[row]),
            )


BOX = list(sharp_edges(box(20, 30, 40)))


@pytest.mark.parametrize(("face", "edge", "length", "convex"), first_rows(2, BOX))
def test_each_edge_of_a_box_takes_away_what_it_should(face, edge, length, convex, tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    found = round_edge(path, face, edge, 4.0, tmp_path / "out.step")
    assert convex
    back = open_parts(tmp_path / "out.step").root
    assert BRepCheck_Analyzer(back, True).IsValid()
    assert (len(parts(back, "SOLID")), len(parts(back, "FACE"))) == (1, 7)
    assert found.gate.largest_tolerance <= 1.1e-7
    # Between nothing and the chamfer; the fairest shape is much the same for all lengths.
    assert volume(back) == pytest.approx(24000 - 0.1395 * 16 * length, abs=1e-4 * 16 * length)


@pytest.mark.parametrize("distance", first_ones(1, [0.5, 2.0, 10.0, 18.0]))
def test_a_fixed_shape_takes_away_c_d_squared_s(distance, tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    for face, edge, length, _ in (BOX[0], next(x for x in BOX if x[2] != BOX[0][2])):
        found = round_edge(path, face, edge, distance, tmp_path / "out.step", **FIXED)
        taken = 24000 - volume(open_parts(tmp_path / "out.step").root)
        # Volumes have 1e-16 of the whole for each of some hundred terms.
        assert taken == pytest.approx(559 / 4096 * distance**2 * length, abs=1e-9)
        assert found.gate.volume[1] == pytest.approx(24000 - taken, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.005, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9])
@pytest.mark.parametrize(("face", "edge", "length", "convex"), BOX)
def test_each_edge_of_a_box_by_shares_of_its_narrower_face(share, face, edge, length, convex, tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    distance = share * min(x for x in (20.0, 30.0, 40.0) if abs(x - length) > 1)
    assert convex
    found = round_edge(path, face, edge, distance, tmp_path / "out.step")
    assert found.gate.faces == (6, 7)
    assert found.gate.largest_tolerance <= 1.1e-7
    found = round_edge(path, face, edge, distance, tmp_path / "out.step", **FIXED)
    taken = 24000 - volume(open_parts(tmp_path / "out.step").root)
    assert taken == pytest.approx(559 / 4096 * distance**2 * length, abs=1e-9)


@pytest.mark.parametrize("face", [0, pytest.param(4, marks=pytest.mark.slow)])
def test_edges_of_a_face_that_do_not_meet_one_after_the_other(face, tmp_path):
    """Faces keep their numbers, and so do edges that are far from what was done."""
    path, taken, shape = written(box(20, 30, 40), tmp_path / "0.brep"), 0.0, box(20, 30, 40)
    lengths = {name: length for f, name, length, _ in _all_edges(shape) if f == face}
    for k, name in enumerate(("e0", "e2")):
        found = round_edge(path, face, name, 4.0 + k, tmp_path / f"{k + 1}.brep", **FIXED)
        path, taken = tmp_path / f"{k + 1}.brep", taken + 559 / 4096 * (4.0 + k) ** 2 * lengths[name]
    assert found.gate.faces == (7, 8)
    assert 24000 - volume(open_parts(path).root) == pytest.approx(taken, abs=1e-9)


def _all_edges(shape):
    """The same as `sharp_edges`, as each of its two faces names them."""
    graph = graph_of(shape)
    relations = relate(graph)
    for row in range(len(graph.uses)):
        yield int(graph.uses.face[row]), graph.uses.name(row), float(relations.length[row]), True


@pytest.mark.long
def test_cuts_may_differ(tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    face, edge, length, _ = BOX[0]
    found = round_edge(path, face, edge, (3.0, 6.0), tmp_path / "out.step")
    assert 0 < 24000 - found.gate.volume[1] < 0.5 * 18 * length


@pytest.mark.slow
def test_a_cut_as_long_as_the_face_is_refused(tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    face, edge = BOX[0][:2]
    with pytest.raises(EdgeError):
        round_edge(path, face, edge, 45.0, tmp_path / "out.step")
    assert not (tmp_path / "out.step").exists()


@pytest.mark.slow
def test_edges_of_a_slanted_box(tmp_path):
    shape = cut(box(20, 30, 40), half_space([0, 0, 32], [0.3, 0.5, 1]))
    path = written(shape, tmp_path / "part.brep")
    for face, edge, _, _ in sharp_edges(shape):
        found = round_edge(path, face, edge, 2.0, tmp_path / "out.step")
        assert found.gate.volume[1] < found.gate.volume[0]
        assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.long
def test_an_inner_edge_adds(tmp_path):
    shape = cut(box(20, 30, 40), box(12, 18, 40))
    path = written(shape, tmp_path / "part.brep")
    (inner,) = (x for x in sharp_edges(shape) if not x[3])
    found = round_edge(path, *inner[:2], 2.0, tmp_path / "out.step")
    assert found.gate.volume[1] > found.gate.volume[0]


@pytest.mark.slow
def test_an_edge_whose_end_face_would_have_to_grow_is_refused(tmp_path):
    """At an inner corner the contact runs beside the end face, which ends there."""
    shape = cut(box(20, 30, 40), box(12, 18, 40))
    path = written(shape, tmp_path / "part.brep")
    said = []
    for face, edge, _, _ in sharp_edges(shape):
        try:
            round_edge(path, face, edge, 2.0, tmp_path / "out.step")
        except (EdgeError, SolidError) as error:
            said.append(str(error))
    assert len(said) == 4
    assert all("would have to grow" in x for x in said)


@pytest.mark.parametrize("radius", [8.0])
def test_closed_rims(radius, tmp_path):
    shape = cylinder(radius, 20)
    path = written(shape, tmp_path / "part.brep")
    edges = list(sharp_edges(shape))
    assert len(edges) == 2
    for face, edge, length, _ in edges:
        found = round_edge(path, face, edge, 3.0, tmp_path / "out.step")
        assert found.gate.faces == (3, 4)
        taken = math.pi * radius**2 * 20 - found.gate.volume[1]
        assert 0.1 * 9 * length < taken < 0.15 * 9 * length


@pytest.mark.slow
def test_an_edge_that_goes_on_over_a_round_is_rounded_with_it(tmp_path):
    shape = box_with_fillet(5.0)
    path = written(shape, tmp_path / "part.brep")
    graph = graph_of(shape)
    number = graph.faces.kind.index("cylinder")
    row = graph.uses.of_face(number).start
    arcs = [k for k in range(4) if abs(graph.uses.points[row + k, 0, 2] - graph.uses.points[row + k, -1, 2]) < 1e-9]
    found = round_edge(path, number, f"e{arcs[0]}", 1.0, tmp_path / "out.step")
    assert found.said.startswith("3 edges that go on in each other, ")
    assert found.gate.faces == (7, 10)


@pytest.mark.long
def test_the_command_rounds_an_edge(tmp_path):
    path, out = written(box(20, 30, 40), tmp_path / "part.brep"), tmp_path / "out.step"
    done = CliRunner().invoke(app, ["blend", str(path), "--round", "0:e1", "--distance", "4", "-o", str(out)])
    assert done.exit_code == 0, done.output
    assert "one sound solid of 7 faces: 6 is the blend" in done.output


@pytest.mark.long
def test_what_was_said_is_what_is_refused(tmp_path):
    path, out = written(box(20, 30, 40), tmp_path / "part.brep"), tmp_path / "out.step"
    words = ["blend", f"{path}#0", f"{path}#2", "--cut-a", "50", "--cut-b", "3", "-o", str(out)]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert "--cut-a 50 --cut-b 3 from edge e0 of face 0: face 0: 50 reaches beyond the face" in done.output
    done = CliRunner().invoke(app, ["blend", str(path), "--round", "0:e0", "--distance", "50", "-o", str(out)])
    assert "--round 0:e0: face 0: 50 reaches beyond the face" in done.output


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--round", "0:e1"], "--distance: missing"),
        (["--distance", "4"], "--round: missing"),
        (["--round", "e1", "--distance", "4"], "--round: found 'e1', expected a face and its edge, as 12:e3"),
        (["--round", "0:e1", "--distance", "-1"], "--distance: found -1.0, expected a finite number above 0"),
        (["--round", "0:e1", "--distance", "4", "--replace", "2"], "--round: found together with"),
    ],
)
def test_wrong_calls(words, said, tmp_path):
    path = written(box(20, 30, 40), tmp_path / "part.brep")
    done = CliRunner().invoke(app, ["blend", str(path), *words, "-o", str(tmp_path / "out.step")])
    assert done.exit_code == 2
    assert said in done.output
