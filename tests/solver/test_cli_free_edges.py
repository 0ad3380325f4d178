"""Free edges of faces on the command line: blend, check and problem, with their limits."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.angular import angular_face
from helpers.drilled import WHOLE, beyond, drilled_part, hole
from helpers.free_curves import seen_by_open_cascade
from helpers.parts import written
from semispline import Base, EdgeError, list_edges, list_surfaces, plane, read_surface, write_surface
from semispline.solver.c_export import write_c
from semispline.solver.cli import app
from semispline.solver.io.json_files import StoredProblem, read_problem
from semispline.solver.io.occ import OccFace, _faces
from semispline.solver.judge import in_cad_limits, measure_contact, measure_creases
from semispline.solver.options import BlendOptions

pytestmark = pytest.mark.usefixtures("reads_here")

# Shapes are looked at elsewhere.
QUICK = ("--alpha", "natural")


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(scope="module")
def low_and_high(tmp_path_factory):
    """Two flat faces above each other with one edge each that has a corner: specs and words."""
    folder = tmp_path_factory.mktemp("angular")
    found = []
    for name, height, grown in (("low", 0.0, 0.0), ("high", 3.0, 1.0)):
        path = written(angular_face(height, grown), folder / f"{name}.brep")
        (word,) = (e.name for e in list_edges(path, 0).edges if e.kind == "free")
        found.append((f"{path}#0", word))
    return found


@pytest.mark.long
@pytest.mark.parametrize("kind", WHOLE)
def test_each_kind_of_face_is_blended_at_its_free_edge(kind, tmp_path):
    path = written(drilled_part(kind), tmp_path / "part.brep")
    face, entry = hole(path, kind)
    other, out, report = beyond(tmp_path / "other.json", entry, kind), tmp_path / "out.json", tmp_path / "report.json"
    ends = (f"{path}#{face}", "--edge-a", entry.name)
    done = run("blend", ends[0], other, *ends[1:], "--edge-b", "v0", *QUICK, "-o", out, "--report", report)
    assert done.exit_code == 0, done.output
    assert f"edge of A: {entry.name} of {path}#{face} is a free curve" in done.stdout
    record = json.loads(report.read_text())
    assert (record["edge_a"], record["asked_a"], record["edge_b"]) == (entry.name, entry.name, "v0")
    band, flat = record["band_a"], kind == "plane"
    assert "band_b" not in record
    assert band["limits"] == record["options"]["limits"] == ("exact" if flat else "cad")
    assert f"{band['limits']} limits" in done.stdout
    assert (band["source"], band["left_out"], band["smoothed_by"]) == ("foot", 0, 0)
    # By Open CASCADE's own surface; its evaluator rounds as ours does, and projects within 1e-7 of the parameters.
    item = OccFace(list(_faces(drilled_part(kind)))[face], "part")
    surface = read_surface(out)
    seen = seen_by_open_cascade(surface.to_bspline(), item._geometry)
    length = entry.length
    assert seen.gap <= (1e-9 if flat else 1e-5 * length)
    assert seen.angle_degrees <= (1e-6 if flat else 0.01)
    assert seen.curvature <= (1e-6 if flat else 0.02)
    assert max((x.angle_degrees for x in measure_creases(surface)), default=0.0) < 2e-4
    check = ("check", ends[0], out, *ends[1:], "--edge-b", "u0", "--require", "G2")
    done = run(*check, "--json", "-")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["meets"] is True
    assert (found["limits"], found["measured_along"], found["face"]) == (band["limits"], "b", band["edge"])
    assert (found["gap"], found["off"]) == (band["gap"], band["off"])
    assert found["mean"]["off"] <= found["off"]
    # Held to the other limits.
    done = run(*check, "--limits", "cad" if flat else "exact")
    assert done.exit_code == (0 if flat else 1)
    assert ("G2: yes" if flat else "G2: no: gap is") in done.stdout
    assert "off the trim curve" in done.stdout


@pytest.mark.long
@pytest.mark.parametrize("suffix", [".step", ".json"])
def test_parts_are_written_into_one_file_or_numbered(low_and_high, tmp_path, suffix):
    (a, edge_a), (b, edge_b) = low_and_high
    out, report = tmp_path / f"out{suffix}", tmp_path / "report.json"
    call = ("blend", a, b, "--edge-a", edge_a, "--edge-b", edge_b, "-o", out, "--report", report)
    done = run(*call)
    assert done.exit_code == 0, done.output
    files = [out] if suffix == ".step" else [tmp_path / "out-0.json", tmp_path / "out-1.json"]
    assert sorted(x for x in tmp_path.iterdir() if x != report) == sorted(files)
    assert sum(len(list_surfaces(file)) for file in files) == 2
    for k in range(2):
        assert f"part {k + 1} of 2, in {files[k % len(files)]}:" in done.stdout
    record = json.loads(report.read_text())
    assert (record["kind"], record["asked_a"]) == ("blend_reports", edge_a)
    assert [part["edge_a"] for part in record["parts"]] == [f"{edge_a}[0]", f"{edge_a}[1]"]
    assert all(part["band_a"]["limits"] == part["band_b"]["limits"] == "exact" for part in record["parts"])


@pytest.mark.long
def test_a_part_alone_with_the_bases(low_and_high, tmp_path):
    (a, edge_a), (b, edge_b) = low_and_high
    out = tmp_path / "out.step"
    done = run("blend", a, b, "--edge-a", f"{edge_a}[0]", "--edge-b", f"{edge_b}[0]", "--with-bases", "-o", out)
    if done.exit_code:
        # The kernel runs the other edge the other way.
        done = run("blend", a, b, "--edge-a", f"{edge_a}[0]", "--edge-b", f"{edge_b}[1]", "--with-bases", "-o", out)
    assert done.exit_code == 0, done.output
    assert len(list_surfaces(out)) == 3


@pytest.mark.long
def test_nothing_is_written_where_something_is_refused(low_and_high, tmp_path):
    (a, edge_a), (b, edge_b) = low_and_high
    out = tmp_path / "out.json"
    first = tmp_path / "out-1.json"
    write_surface(first, plane([6, 0, 3], [2, 0, 0], [0, 4, 0]))
    before = first.read_bytes()
    for words, status, text in (
        ((a, first, "--edge-a", edge_a, "--edge-b", "u0"), 2, "has 2 parts (a corner of 90 degrees)"),
        ((a, first, "--edge-a", f"{edge_a}[2]", "--edge-b", "u0"), 2, "part: found 2"),
        ((a, first, "--edge-a", f"{edge_a}[x]", "--edge-b", "u0"), 2, "--edge-a"),
        ((a, b, "--edge-a", edge_a, "--edge-b", edge_b, "--limits", "loose"), 2, "limits: found 'loose'"),
        ((a, b, "--edge-a", edge_a, "--edge-b", edge_b, "--report", first), 2, "out-1.json"),
    ):
        done = run("blend", *words, "-o", out)
        assert done.exit_code == status, (words, done.output)
        assert text in done.stderr.replace("\n", " ")
        assert [x.name for x in tmp_path.iterdir()] == ["out-1.json"]
        assert first.read_bytes() == before
    done = run("check", a, b, "--edge-a", edge_a, "--edge-b", edge_b, "--limits", "loose")
    assert (done.exit_code, "--limits: found 'loose'" in done.stderr) == (2, True)
    done = run("check", a, b, "--edge-a", f"{edge_a}[0]", "--edge-b", edge_b)
    assert (done.exit_code, f"name {edge_a}" in done.stderr) == (2, True)


@pytest.mark.long
def test_exact_limits_refuse_a_band_of_a_curved_face(tmp_path):
    path = written(drilled_part("sphere"), tmp_path / "part.brep")
    face, entry = hole(path, "sphere")
    other, out = beyond(tmp_path / "other.json", entry, "sphere"), tmp_path / "out.json"
    words = ("--edge-a", entry.name, "--edge-b", "v0", *QUICK, "--limits", "exact")
    done = run("blend", f"{path}#{face}", other, *words, "-o", out)
    assert done.exit_code == 3
    assert "within exact limits" in done.stderr
    assert "leave out exact" in done.stderr
    assert not out.exists()


def test_natural_edges_are_held_to_what_is_asked_for(tmp_path):
    """Two sheets at an angle of 0.005 degrees: smooth for a checker, not exactly."""
    a, b = tmp_path / "a.json", tmp_path / "b.json"
    lift = 2 * np.tan(np.radians(0.005))
    write_surface(a, plane([0, 0, 0], [2, 0, 0], [0, 3, 0]))
    write_surface(b, plane([2, 0, 0], [2, 0, lift], [0, 3, 0]))
    words = ("check", a, b, "--edge-a", "u1", "--edge-b", "u0", "--require", "G1")
    for said, status, limits in (
        ((), 1, "exact"),
        (("--limits", "exact"), 1, "exact"),
        (("--limits", "cad"), 0, "cad"),
    ):
        done = run(*words, *said, "--json", "-")
        assert done.exit_code == status, done.output
        assert json.loads(done.stdout)["limits"] == limits
    contact = measure_contact(Base(read_surface(a), "u1"), Base(read_surface(b), "u0"))
    cad = in_cad_limits(contact, 3.0, 25.4).allowed
    assert cad["gap"] == pytest.approx(3e-5)
    assert (cad["angle_degrees"], cad["curvature_jump_relative"]) == (0.01, 0.02)
    assert in_cad_limits(contact, 3e3, 25.4).allowed["gap"] == pytest.approx(1e-3 / 25.4)
    assert cad["c1_residual"] == contact.allowed["c1_residual"]


@pytest.mark.long
def test_a_problem_keeps_both_words_and_becomes_c_where_it_is_one(low_and_high, tmp_path):
    (a, edge_a), (b, _) = low_and_high
    sheet, path = tmp_path / "sheet.json", tmp_path / "p.json"
    write_surface(sheet, plane([6, 0, 3], [2, 0, 0], [0, 4, 0]))
    near = "near=4,2.2,0"
    words = ("problem", a, sheet, "--edge-a", near, "--edge-b", "u0", "--limits", "cad", "-o", path)
    done = run(*words)
    assert done.exit_code == 0, done.output
    stored = read_problem(path)
    assert (stored.edge_a, stored.asked_a, stored.edge_b, stored.asked_b) == (edge_a, near, "u0", None)
    assert stored.options.limits == "cad"
    with pytest.raises(EdgeError, match=rf"found 2 parts, {edge_a}\[0\] to {edge_a}\[1\]"):
        write_c(tmp_path / "c", path)
    assert not (tmp_path / "c").exists()
    done = run(*(f"{edge_a}[1]" if word == near else word for word in words))
    assert (done.exit_code, read_problem(path).edge_a) == (0, f"{edge_a}[1]")
    assert write_c(tmp_path / "c", path)[1] == ()
    assert sorted(x.name for x in (tmp_path / "c").iterdir()) == ["README.md", "blend.c", "blend.h"]
    surface = plane([0, 0, 0], [1, 0, 0], [0, 1, 0])
    # Of a surface that is no face of a file there are no such edges.
    with pytest.raises(EdgeError, match="edge_a: found 'e3'"):
        StoredProblem(surface, "e3", str(b), "e2", BlendOptions())
    with pytest.raises(EdgeError, match=r"edge_b: found 'e3\.2'"):
        StoredProblem(surface, "u0", str(b), "e3.2", BlendOptions())
    assert StoredProblem(surface, "u0", str(b), "e3[1]", BlendOptions()).edge_b == "e3[1]"
    text = json.loads(path.read_text()) | {"edge_a": "e"}
    path.write_text(json.dumps(text))
    with pytest.raises(EdgeError, match=r"p\.json: edge_a: found 'e'"):
        read_problem(path)


def test_words_of_free_edges_need_a_file_with_faces(tmp_path):
    sheet = tmp_path / "sheet.json"
    write_surface(sheet, plane([6, 0, 3], [2, 0, 0], [0, 4, 0]))
    done = run("blend", sheet, sheet, "--edge-a", "e0[0]", "--edge-b", "u0", "-o", tmp_path / "out.json")
    assert done.exit_code == 2
    assert "cannot be read from '.json'" in done.stderr
    assert not (tmp_path / "out.json").exists()


@pytest.mark.long
def test_continuity_of_parameters_along_a_free_edge_is_said_to_be_geometric(tmp_path):
    path = written(drilled_part("cylinder"), tmp_path / "part.brep")
    face, entry = hole(path, "cylinder")
    spec, other = f"{path}#{face}", beyond(tmp_path / "other.json", entry, "cylinder")
    out, report = tmp_path / "out.json", tmp_path / "report.json"
    words = ("--edge-a", entry.name, "--edge-b", "v0", "--continuity", "C1", "-o", out, "--report", report)
    done = run("blend", spec, other, *words)
    assert done.exit_code == 0, done.output
    assert "C1, which is of parameters, counts as G1" in done.stdout
    # Which faces were blended stands in the report, as in that of check.
    record = json.loads(report.read_text())
    assert (record["a"], record["b"]) == (spec, str(other))
    for required, said in (("C1", True), ("G1", False)):
        checked = run("check", spec, out, "--edge-a", entry.name, "--edge-b", "u0", "--require", required)
        assert checked.exit_code == 0, checked.output
        assert ("counts as G1: a free curve has none across it" in checked.stdout) == said
