"""Edges of faces in files: listed, and resolved to a surface and a name before a base is made."""

import json

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Trsf, gp_Vec
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from typer.testing import CliRunner

from helpers.parts import compound, moved, polygon, rounded_box, unsewn, without, written
from semispline import Base, BSplineSurface, EdgeError, FileError, blend, list_edges, resolve_edge, write_surface
from semispline.solver.cli import app
from semispline.solver.io.json_files import read_problem
from semispline.solver.io.occ import _faces, read_occ
from semispline.solver.io.occ_writing import occ_surface
from semispline.solver.io.surface_files import LoadedSurface, face_warnings, read_surfaces
from semispline.solver.topology.face_edges import _edges_of
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.near import point_of
from semispline.solver.topology.resolving import resolve_edges


def sheet(start=0.0, height=0.0):
    """One of 40 mm x 30 mm, x = start + 40 u, y = 30 v, z = height u^2."""
    net = [[[start + 40.0 * u, 30.0 * v, height * (u == 1)] for v in (0.0, 1.0)] for u in (0.0, 0.5, 1.0)]
    return BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], net)


def rectangle(surface, u0, u1, v0, v1):
    return BRepBuilderAPI_MakeFace(occ_surface(surface), u0, u1, v0, v1, 1e-7).Face()


def step(path, *faces):
    writer = STEPControl_Writer()
    writer.Transfer(compound(faces) if len(faces) > 1 else faces[0], STEPControl_StepModelType.STEPControl_AsIs)
    writer.Write(str(path))
    return path


def listed(path):
    """What `list_edges` says of every face, of one reading of the file."""
    faces = read_occ(path).faces
    measured = measured_edges(path, range(len(faces)))
    return {n: _edges_of(measured, n, LoadedSurface(face.surface(), None)) for n, face in enumerate(faces)}


@pytest.fixture
def cut(tmp_path, read_here):
    """A file with a sheet cut at u = 0.7 of 40 mm."""
    return step(tmp_path / "cut.step", rectangle(sheet(height=5.0), 0.0, 0.7, 0.0, 1.0))


@pytest.fixture
def far(tmp_path):
    path = tmp_path / "far.json"
    write_surface(path, sheet(start=60.0))
    return path


def own_end(path):
    (edge,) = (edge for edge in list_edges(path, 0).edges if edge.kind == "inner")
    return edge


def test_a_trimmed_face_is_blended_at_its_own_edge(cut, far):
    """Before, the blend began 12 mm off the part, at the end of the surface."""
    edge = own_end(cut)
    assert edge.edge == "u=0.7-"
    assert edge.length == pytest.approx(30.0, abs=1e-9)
    resolved = resolve_edge(cut, edge.name)
    assert (resolved.edge, resolved.asked, resolved.spec) == ("u=0.7-", edge.name, f"{cut}#0")
    other = resolve_edge(far, "u0")
    result = blend(Base(resolved.surface, resolved.edge), Base(other.surface, other.edge), continuity="G2")
    start = result.surface.evaluate(np.zeros(5), np.linspace(0, 1, 5))
    # The sheet at u = 0.7: x = 28, z = 5 u^2.
    assert np.abs(start[:, 0] - 28.0).max() <= 1e-12
    assert np.abs(start[:, 2] - 5 * 0.49).max() <= 1e-12
    assert result.edges == ("u=0.7-", "u0")
    assert result.contact_a.gap <= 1e-13
    assert result.contact_a.angle_degrees <= 1e-9
    # The whole surface ends 12 mm further on.
    assert np.abs(Base(resolved.surface, "u1").derivative(np.array([0.0]), 0, 0)[0, 0] - 40.0) <= 1e-12


@pytest.mark.parametrize("kind", ["e", "near"])
def test_the_command_line_takes_it_and_says_nothing_of_trimming(cut, far, tmp_path, kind):
    word = own_end(cut).name if kind == "e" else "near=28,13,2.45"
    out, report = tmp_path / "out.json", tmp_path / "report.json"
    call = ["blend", str(cut), str(far), "--edge-a", word, "--edge-b", "u0", "--strict", "-o", str(out)]
    done = CliRunner().invoke(app, [*call, "--report", str(report)])
    assert done.exit_code == 0, done.output
    assert done.stderr == ""
    record = json.loads(report.read_text())
    assert (record["edge_a"], record["asked_a"], record["edge_b"]) == ("u=0.7-", word, "u0")
    assert "asked_b" not in record
    assert f"edge of A: {own_end(cut).name} of {cut}#0 is u=0.7-" in done.stdout
    check = ["check", str(cut), str(out), "--edge-a", word, "--edge-b", "u0", "--require", "G2", "--json", "-"]
    done = CliRunner().invoke(app, check)
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["asked_a"] == word
    # The end of the surface is never taken without a word.
    done = CliRunner().invoke(app, [x if x != word else "u1" for x in call])
    assert done.exit_code == 3
    assert "lies outside of the face" in done.stderr
    assert f"semispline list {cut} --edges 0" in done.stderr


def test_a_problem_file_keeps_both_words(cut, far, tmp_path):
    folder = tmp_path / "problems"
    folder.mkdir()
    word, path = own_end(cut).name, folder / "p.json"
    call = ["problem", str(cut), str(far), "--edge-a", word, "--edge-b", "u0", "--continuity", "G1", "-o", str(path)]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.output
    stored = read_problem(path)
    assert (stored.edge_a, stored.asked_a, stored.edge_b, stored.asked_b) == ("u=0.7-", word, "u0", None)
    assert json.loads(path.read_text())["a"] == "../cut.step#0"
    assert stored.options.continuities == ("G1", "G1")
    # As it is read the bases are found again.
    resolved = resolve_edges([(str(stored.a), stored.edge_a), (str(stored.b), stored.edge_b)])
    assert [one.edge for one in resolved] == ["u=0.7-", "u0"]


def test_two_files_in_two_units(tmp_path, cut):
    """What is told by lengths is told in the unit of the file, and then both are brought to one."""
    metres = tmp_path / "metres.json"
    write_surface(metres, sheet(start=60.0))
    inches = tmp_path / "inches.3dm"
    write_surface(inches, sheet(start=60.0), "in")
    a, b = resolve_edges([(str(inches), "u0"), (str(cut), own_end(cut).name)])
    assert (a.loaded.unit, b.loaded.unit, b.edge) == ("in", "in", "u=0.7-")
    assert b.surface.evaluate([1.0], [1.0])[0, 0] == pytest.approx(40.0 / 25.4)


@pytest.mark.usefixtures("read_here")
def test_the_list_of_a_rounded_box(tmp_path):
    shape = rounded_box()
    path = written(shape, tmp_path / "box.brep")
    every = listed(path)
    for n, face in every.items():
        assert face.walked
        assert [edge.name for edge in face.edges] == [f"e{k}" for k in range(len(face.edges))]
        for edge, following in zip(face.edges, [*face.edges[1:], face.edges[0]], strict=True):
            # One wire each: they follow each other.
            assert np.abs(np.subtract(edge.end, following.start)).max() <= 1e-6
            other = every[edge.neighbour].edges[int(edge.neighbour_edge[1:])]
            assert (other.neighbour, other.neighbour_edge) == (n, edge.name)
            assert other.length == pytest.approx(edge.length, abs=1e-9)
            assert np.abs(np.subtract(other.start, edge.end)).max() <= 1e-6
    kinds = {face.kind for face in every.values()}
    assert kinds >= {"plane", "cylinder", "torus"}
    # Quarters of the round corners of the floor, of radius 3, and of the roof, of 3 less 1.5.
    arcs = [e for face in every.values() if face.kind == "plane" for e in face.edges if e.kind == "free"]
    assert {round(edge.length, 9) for edge in arcs} == {round(r * np.pi / 2, 9) for r in (1.5, 3.0)}


@pytest.mark.usefixtures("read_here")
def test_unsewn_neighbours_are_found_by_their_place(tmp_path):
    path = written(unsewn(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape()), tmp_path / "box.brep")
    face = list_edges(path, 0)
    assert sorted(edge.neighbour for edge in face.edges) == [2, 3, 4, 5]
    assert not any(edge.sewn for edge in face.edges)
    done = CliRunner().invoke(app, ["list", str(path), "--edges", "0"])
    assert done.stdout.count("not sewn") == 4


@pytest.mark.long
def test_what_list_prints(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written(BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape().Reversed(), tmp_path / "c.brep")
    done = CliRunner().invoke(app, ["list", "c.brep", "--edges", "0", "--json", "edges.json"])
    assert done.exit_code == 0, done.output
    lines = done.stdout.splitlines()
    assert lines[0].startswith("#0 (cylinder, looks against its surface's normal); lengths in model units")
    assert "within 5e-06 model units" in lines[1]
    assert [line.split()[0] for line in lines[2:]] == ["edge", "e0", "e1", "e2", "e3"]
    assert sum("a seam" in line and "itself" in line for line in lines) == 2
    record = json.loads((tmp_path / "edges.json").read_text())
    assert (record["kind"], record["face"], record["walked"], len(record["edges"])) == ("cylinder", 0, True, 4)
    rims = [edge for edge in record["edges"] if not edge["seam"]]
    assert [edge["edge"] for edge in rims] in (["v0", "v1"], ["v1", "v0"])
    assert [edge["length"] for edge in rims] == [pytest.approx(4 * np.pi, rel=1e-9)] * 2


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["--edges", "9"], ["#9: no such surface; the file holds 1, numbered 0 to 0"]),
        (["--edges", "-1"], ["--edges"]),
        (["--edges", "0", "--pairs"], ["--pairs", "--edges"]),
    ],
)
def test_bad_calls_of_list(cut, words, parts):
    done = CliRunner().invoke(app, ["list", str(cut), *words])
    assert done.exit_code == 2
    assert all(part in done.stderr for part in parts)


def test_bad_words_say_what_would_be_right(cut, far, tmp_path):
    box = written(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape(), tmp_path / "box.brep")
    disc = written(list(_faces(BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape()))[1], tmp_path / "disc.brep")
    for spec, word, kind, parts in (
        (cut, "e4", EdgeError, ["'e4'", "its edges are e0 to e3"]),
        (f"{cut}#0", "e99", EdgeError, ["face #0", "e0 to e3"]),
        (f"{cut}#1", "e0", FileError, ["#1: no such surface"]),
        (box, "e0", FileError, ["holds 6 surfaces", "#N"]),
        (disc, "e0[0,1]", EdgeError, ["'e0[0,1]'", "u0, u1, v0, v1"]),
        (cut, "e0[0]", EdgeError, ["e0 of", "only free curves are cut into parts; name e0"]),
        (far, "e0", FileError, ["cannot be read from '.json'"]),
        (cut, "near=1,2", EdgeError, ["'near=1,2'", "near=x,y,z"]),
        (cut, "near=1,2,nan", EdgeError, ["near=x,y,z"]),
        (cut, "near=10,15,0", EdgeError, ["the nearest edge", "mm away", "a twentieth of its length"]),
        (cut, "near=0,0,0", EdgeError, ["2 edges", "equally near", "middle of one edge"]),
        (f"{box}#0", "near=0,0,0", EdgeError, ["2 edges of", "#0 e"]),
        (cut, "w1", EdgeError, ["'w1'", "u0, u1, v0, v1"]),
    ):
        with pytest.raises(kind) as error:
            resolve_edge(spec, word, "--edge-a")
        for part in parts:
            assert part in str(error.value), (word, str(error.value))


@pytest.mark.usefixtures("read_here")
def test_a_seam_is_named_by_its_side(tmp_path):
    path = written(BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape(), tmp_path / "c.brep")
    seams = [edge for edge in list_edges(path, 0).edges if edge.seam]
    assert sorted(edge.edge for edge in seams) == ["u0", "u1"]
    assert all(edge.neighbour == 0 for edge in seams)
    assert [edge.neighbour_edge for edge in seams] == [edge.name for edge in seams[::-1]]
    assert resolve_edge(f"{path}#0", seams[0].name).edge == seams[0].edge
    with pytest.raises(EdgeError, match="is a seam: both its sides are of this face"):
        resolve_edge(f"{path}#0", "near=2,0,2.5")


@pytest.mark.long
@pytest.mark.usefixtures("read_here")
def test_points_in_the_middle_of_edges_find_them(tmp_path):
    """Every edge of every face of a rounded box by its middle, and by a point a hundredth of its length beside it."""
    shape = rounded_box()
    path = written(shape, tmp_path / "box.brep")
    rng = np.random.default_rng(0)
    for n, face in list(listed(path).items())[::6]:
        for edge in face.edges[:2]:
            beside = np.array(edge.middle) + 0.01 * edge.length * rng.uniform(-0.5, 0.5, 3)
            for point in (edge.middle, beside):
                word = "near=" + ",".join(map(repr, map(float, point)))
                found = resolve_edge(f"{path}#{n}", word)
                assert found.entry.name == edge.name
                assert found.is_free == (edge.edge is None)
                assert f"{edge.name}, " in found.said


@pytest.mark.long
@pytest.mark.usefixtures("read_here")
def test_two_points_decide_which_face_lies_between(tmp_path):
    """An upright round of a box: its straight sides belong to it and to the walls."""
    shape = rounded_box(top=1.0)
    path = written(shape, tmp_path / "box.brep")
    rounds = (face for face in listed(path).values() if face.kind == "cylinder")
    round_ = next(face for face in rounds if any(edge.length > 15 for edge in face.edges))
    sides = [edge for edge in round_.edges if edge.length > 15]
    words = ["near=" + ",".join(map(str, edge.middle)) for edge in sides]
    found = resolve_edges([(str(path), word) for word in words])
    assert [one.spec for one in found] == [f"{path}#{edge.neighbour}" for edge in sides]
    assert [one.entry.name for one in found] == [edge.neighbour_edge for edge in sides]
    assert all(one.loaded.kind == "plane" for one in found)
    # One point alone does not say it.
    with pytest.raises(EdgeError, match="lies between faces; say which is meant"):
        resolve_edge(path, words[0])
    # With the face it does.
    assert resolve_edge(f"{path}#{round_.face}", words[0]).entry.name == sides[0].name
    # The same edge twice is a sharp edge with its two faces.
    twice = resolve_edges([(str(path), words[0])] * 2)
    assert {one.spec for one in twice} == {f"{path}#{round_.face}", f"{path}#{sides[0].neighbour}"}
    # A free edge has one face.
    open_ = written(without(shape, round_.face), tmp_path / "open.brep")
    found = resolve_edges([(str(open_), word) for word in words])
    assert all(one.loaded.kind == "plane" for one in found)


@pytest.mark.usefixtures("read_here")
def test_edges_that_lie_on_each_other_are_a_tie(tmp_path):
    """Two boxes side by side in an assembly: the point does not say of which the edge is, the number of a face does."""
    box = BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape()
    shift = gp_Trsf()
    shift.SetTranslation(gp_Vec(2.0, 0.0, 0.0))
    path = written(compound([box, moved(box, shift)]), tmp_path / "two.brep")
    with pytest.raises(EdgeError, match=r"2 edges of .* are equally near, 0"):
        resolve_edge(path, "near=2,0,2.5")
    middles = {(2.0, 0.0, 2.5), (2.0, 3.0, 2.5)}
    face = next(n for n, found in listed(path).items() if {edge.middle for edge in found.edges} >= middles)
    assert resolve_edge(f"{path}#{face}", "near=2,0,2.5").entry.middle == (2.0, 0.0, 2.5)


def test_points_are_numbers():
    assert point_of("near=1,-2.5,1e-3").tolist() == [1.0, -2.5, 1e-3]
    # Before a file is read, and with the option that was wrong.
    with pytest.raises(EdgeError, match=r"^--edge-b: found 'near=1,2', expected near=x,y,z"):
        resolve_edges([("a.step", "u0"), ("b.step", "near=1,2")])


@pytest.mark.usefixtures("read_here")
def test_a_small_edge_of_a_large_model_is_the_faces_own(tmp_path):
    """Within the tolerance of lines, which goes by the model, but not within those of the edge."""
    geometry = occ_surface(sheet())
    tilted = polygon(geometry, [(0.0, 0.0), (0.7, 0.0), (0.7 + 0.002 / 40, 1.0), (0.0, 1.0)])
    path = written(compound([tilted, rectangle(sheet(start=4000.0), 0.0, 1.0, 0.0, 1.0)]), tmp_path / "two.brep")
    name = next(edge.name for edge in list_edges(path, 0).edges if edge.kind == "inner")
    found = resolve_edge(f"{path}#0", name)
    assert found.entry.off == pytest.approx(0.001, rel=1e-6)
    assert face_warnings((found.spec, found.edge, found.loaded)) == ()
    # The same line, asked for as a line of the surface, is told to be off.
    (loaded,) = read_surfaces([f"{path}#0"])
    assert "is no edge of the face" in face_warnings((found.spec, found.edge, loaded))[0]
