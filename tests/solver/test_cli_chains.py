"""Edges that run end to end on the command line: blend, files, reports, check, problem, and proposed commands."""

import json
import shlex

import pytest
from typer.testing import CliRunner

from helpers.parts import compound, rounded_box, written
from helpers.profiles import oval_edges, polygon_edges, round_edges, tube
from semispline import list_surfaces, read_surface, resolve_edge
from semispline.solver.c_export import write_c
from semispline.solver.cli import app
from semispline.solver.errors import EdgeError
from semispline.solver.io.json_files import read_problem

pytestmark = pytest.mark.usefixtures("reads_here")

# Shapes are looked at elsewhere.
QUICK = ("--alpha", "natural")


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(scope="module")
def tubes(tmp_path_factory):
    """An oval tube, faces 0 to 3, whose rims above are e1; a round one in three arcs, 4 to 6, e3; a square one, e1."""
    square = polygon_edges([(-8, -8), (8, -8), (8, 8), (-8, 8)], 60)
    shapes = [tube(oval_edges(30, 10, 0), 10), tube(round_edges(8, 25, [0, 100, 190]), 10), tube(square, 10)]
    return str(written(compound(shapes), tmp_path_factory.mktemp("tubes") / "my tubes.brep"))


@pytest.mark.parametrize(("split", "count"), [("corners", 1), ("joints", 7)])
def test_a_blend_of_chains_its_file_and_report(tubes, tmp_path, split, count):
    out, report = tmp_path / "out.step", tmp_path / "report.json"
    words = ("--edge-a", "0:e1*", "--edge-b", "4:e3*", *QUICK, "--split", split, "-o", out, "--report", report)
    done = run("blend", tubes, tubes, *words)
    assert done.exit_code == 0, done.output
    assert len(list_surfaces(out)) == count
    record = json.loads(report.read_text())
    assert (record["asked_a"], record["edge_a"]) == ("0:e1*", "e1+1:e1+2:e1+3:e1")
    chain = record["chain_a"]
    assert chain["edges"] == ["e1", "1:e1", "2:e1", "3:e1"]
    assert (chain["closed"], chain["corners_fade"], chain["limits"]) == (True, False, "exact")
    assert {face["edge"] for face in chain["faces"]} == set(chain["edges"])
    assert all(face["contact"]["gap"] <= 1e-12 for face in chain["faces"])
    assert {joint["kind"] for joint in chain["joints"]} == {"smooth"}
    assert sum(joint["curvature_jumps"] for joint in chain["joints"]) == 4
    assert f"edge of A: e1+1:e1+2:e1+3:e1 of {tubes}#0, 4 edges of 4 faces" in done.stdout
    assert "chain of 4 edges, closed" in done.stdout
    assert "curvature along the contact jumps from 0 to 0.1, the blend inherits it" in done.stdout
    assert "3:e1, v in [" in done.stdout


@pytest.mark.long
def test_json_keeps_a_blend_with_corners_whole(tubes, tmp_path):
    words = ("--edge-a", "7:e3+8:e3+9:e3+10:e3", "--edge-b", "4:e1*", *QUICK)
    for suffix, count in (("json", 1), ("step", 4), ("iges", 4), ("brep", 4), ("3dm", 4)):
        out = tmp_path / f"out.{suffix}"
        done = run("blend", tubes, tubes, *words, "-o", out)
        assert done.exit_code == 0, done.output
        if suffix == "json":
            assert read_surface(out).degree_u == 5
        else:
            assert len(list_surfaces(out)) == count
    assert "corner of 90 degrees, the blend is split there, the other side has none there: it fades out" in done.stdout


@pytest.mark.long
def test_check_measures_each_face(tubes, tmp_path):
    out, figures = tmp_path / "out.json", tmp_path / "figures.json"
    assert run("blend", tubes, tubes, "--edge-a", "0:e1*", "--edge-b", "4:e3*", *QUICK, "-o", out).exit_code == 0
    check = ("check", tubes, out, "--edge-a", "0:e1*", "--edge-b", "u0", "--require", "G2")
    done = run(*check, "--json", figures)
    assert done.exit_code == 0, done.output
    record = json.loads(figures.read_text())
    assert record["meets"] is True
    assert {face["edge"] for face in record["faces"]} == {"e1", "1:e1", "2:e1", "3:e1"}
    assert record["gap"] == max(face["contact"]["gap"] for face in record["faces"]) <= 1e-12
    # The other way round, and against the wrong chain.
    assert run("check", out, tubes, "--edge-a", "u1", "--edge-b", "4:e3*", "--require", "G2").exit_code == 0
    done = run("check", out, tubes, "--edge-a", "u1", "--edge-b", "4:e1*", "--require", "G0")
    assert done.exit_code == 2
    assert "it runs on beyond e1+5:e1+6:e1" in " ".join(done.output.split())
    done = run(*check, "--plots", tmp_path / "plots")
    assert done.exit_code == 2
    assert "--plots: found it with several edges at once" in done.output


def test_a_problem_file_keeps_what_was_said(tubes, tmp_path):
    path = tmp_path / "p.json"
    done = run("problem", tubes, tubes, "--edge-a", "0:e1*", "--edge-b", "4:e3+6:e3", "-o", path)
    assert done.exit_code == 0, done.output
    stored = read_problem(path)
    assert (stored.edge_a, stored.asked_a) == ("e1+1:e1+2:e1+3:e1", "0:e1*")
    assert (stored.edge_b, stored.asked_b) == ("e3+6:e3", "4:e3+6:e3")
    assert stored.a.endswith("#0")
    # What is stored names the same edges.
    assert resolve_edge(stored.a, stored.edge_a).edge == stored.edge_a
    with pytest.raises(EdgeError, match="found a chain, expected one edge for generated C"):
        write_c(tmp_path / "c", path)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--edge-a", "e3+u1"), "expected edges of faces that run end to end"),
        (("--edge-a", "0:e1+2:e1"), "does not begin where"),
        (("--edge-a", "0:e1*", "--split", "all"), "--split: found 'all', expected corners or joints"),
        (("--edge-a", "0:e1*", "--continuity", "C2"), "found C2 at a, which is a chain"),
        (("--edge-a", "0:e1*", "--cut-a", "1"), "together with --cut-a or --cut-b, expected one edge"),
    ],
)
def test_what_is_refused(tubes, tmp_path, words, said):
    out = tmp_path / "out.step"
    done = run("blend", tubes, tubes, *words, "--edge-b", "4:e3*", "-o", out)
    assert done.exit_code == 2
    assert said in " ".join(done.output.split())
    assert not out.exists()


def commands(path, sign):
    """What `list --pairs` proposes, as printed: commands with a sign in them."""
    lines = run("list", path, "--pairs").stdout.splitlines()
    return [shlex.split(line) for line in lines if "semispline blend" in line and sign in line]


@pytest.mark.long
def test_a_proposed_gap_of_chains_runs_as_printed(tubes, tmp_path, monkeypatch):
    """Between two rims of four and three edges."""
    monkeypatch.chdir(tmp_path)
    (words,) = [words for words in commands(tubes, "*") if {words[5], words[7]} == {"0:e1*", "4:e3*"}]
    done = run(*words[1:], *QUICK)
    assert done.exit_code == 0, done.output
    assert (tmp_path / words[-1]).exists()


@pytest.mark.long
def test_a_proposed_ring_of_rounds_runs_as_printed(tmp_path, monkeypatch):
    """Eight faces that go on into each other: all of them at once, and one solid comes back."""
    monkeypatch.chdir(tmp_path)
    rounded = written(rounded_box(), tmp_path / "rounded.brep")
    rings = [words for words in commands(rounded, "--replace") if words[4].count(",") == 7]
    # The command of the chain and of each fillet in it.
    assert len({words[4] for words in rings}) == 1
    done = run(*rings[0][1:], *QUICK)
    assert done.exit_code == 0, done.output
    assert "one sound" in done.output
    assert (tmp_path / rings[0][-1]).exists()
