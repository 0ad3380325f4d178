import json
import subprocess
import sys

import numpy as np
import pytest
from typer.testing import CliRunner

from semispline import BSplineSurface
from semispline.solver.cli import app
from semispline.solver.io.json_files import surface_record
from semispline.solver.io.surface_files import write_surface

K = [0.0, 0.0, 1.0, 1.0]
FLOOR = BSplineSurface(1, 1, K, K, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
SHELF = BSplineSurface(1, 1, K, K, [[[2, 0, 1], [2, 1, 1]], [[3, 0, 1], [3, 1, 1]]])
CUBIC = [0, 0, 0, 0, 0.5, 1, 1, 1, 1]


def record(**changes):
    net = np.random.default_rng(0).normal(size=(5, 2, 3)).tolist()
    base = {"format": "semispline/1", "kind": "bspline_surface", "degree_u": 3, "degree_v": 1}
    return json.dumps(base | {"knots_u": CUBIC, "knots_v": K, "control_points": net} | changes)


NET = json.loads(record())["control_points"]
# What is wrong with the file of A, and words that the message must hold beside the name of the file.
BAD_FILES = {
    "not there": (None, ["no such file"]),
    "empty": ("", ["not JSON"]),
    "broken": ('{"format": "semispline/1", ', ["not JSON", "line 1"]),
    "a number": ("5", ["5", "object"]),
    "of another kind": (record(kind="ledger"), ["kind", "'ledger'", "bspline_surface"]),
    "of another version": (record(format="semispline/9"), ["format", "semispline/1"]),
    "knots that decrease": (record(knots_u=[0, 0, 0, 0, -0.5, 1, 1, 1, 1]), ["knots_u[4]", "-0.5", "non-decreasing"]),
    "knots of too high multiplicity": (
        record(knots_u=[0] * 4 + [0.5] * 4 + [1] * 4, control_points=NET + NET[:3]),
        ["knots_u[4]", "multiplicity 4", "at most 3"],
    ),
    "knots without a domain": (record(knots_u=[0, 0, 0, 1, 1, 1, 1, 2, 3]), ["domain", "empty"]),
    "too few knots": (record(knots_u=CUBIC[1:]), ["knots_u", "8 knots", "expected 9"]),
    "too few points": (record(control_points=NET[:4]), ["knots_u", "9 knots", "expected 8"]),
    "ragged rows": (record(control_points=[*NET[:4], NET[4][:1]]), ["control_points[4]", "1 points", "expected 2"]),
    "NaN": (record(control_points=[*NET[:4], [[0, 0, np.nan]] * 2]), ["control_points[4][0][2]", "nan", "finite"]),
    "infinity": (record(knots_v=[0, 0, np.inf, np.inf]), ["knots_v[2]", "inf", "finite"]),
    "too large a number": (record().replace("0.5", "1e999"), ["knots_u[4]", "inf"]),
    "an unknown key": (record(color="red"), ["color", "no such key"]),
    "a text for a number": (record(degree_u="3"), ["degree_u", "'3'"]),
}
EDGES = ("--edge-a", "u1", "--edge-b", "u0")


def blend_words(folder, *more, a="a.json", b="b.json", edges=EDGES, out="out.json"):
    return ["blend", str(folder / a), str(folder / b), *edges, "-o", str(folder / out), *map(str, more)]


def assert_refused(done, words):
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    # One line, no traceback.
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    for word in words:
        assert word in done.stderr


@pytest.fixture
def folder(tmp_path):
    write_surface(tmp_path / "a.json", FLOOR)
    write_surface(tmp_path / "b.json", SHELF)
    (tmp_path / "out.json").write_text("old")
    (tmp_path / "report.json").write_text("old report")
    return tmp_path


def untouched(folder):
    leftovers = {p.name for p in folder.iterdir()} - {"a.json", "b.json", "out.json", "report.json"}
    return (
        not leftovers
        and (folder / "out.json").read_text() == "old"
        and (folder / "report.json").read_text() == "old report"
    )


@pytest.mark.long
def test_what_the_others_are_measured_against_works(folder):
    (folder / "a.json").write_text(record())
    done = CliRunner().invoke(app, blend_words(folder, "--report", folder / "report.json"))
    assert done.exit_code == 0, done.output
    assert not untouched(folder)


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_file(folder, name):
    text, words = BAD_FILES[name]
    if text is None:
        (folder / "a.json").unlink()
    else:
        (folder / "a.json").write_text(text)
    done = CliRunner().invoke(app, blend_words(folder, "--report", folder / "report.json"))
    assert_refused(done, ["a.json", *words])
    assert untouched(folder)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"edges": ("--edge-a", "w1", "--edge-b", "u0")}, ["--edge-a", "'w1'", "u0, u1, v0, v1"]),
        ({"edges": ("--edge-a", "u1", "--edge-b", "U0")}, ["--edge-b", "'U0'", "u0, u1, v0, v1"]),
        ({"a": "a.json#1"}, ["a.json#1", "holds 1"]),
        ({"a": "a.json#-1"}, ["'-1'", "number"]),
        ({"a": "a.json#one"}, ["'one'", "number"]),
        ({"a": ""}, ["not a regular file"]),
        ({"out": "out.xyz"}, ["out.xyz", ".xyz", ".json"]),
        ({"out": "none/out.json"}, ["none", "does not exist"]),
        ({"out": ""}, ["suffix"]),
    ],
)
def test_bad_call(folder, options, words):
    done = CliRunner().invoke(app, blend_words(folder, **options))
    assert_refused(done, words)
    assert untouched(folder)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--middle-curves", "-1"), ["middle", "-1"]),
        (("--continuity", "G7"), ["G7", "G2"]),
        (("--continuity-b", "x"), ["'x'", "G2"]),
        (("--flip", "maybe"), ["flip", "'maybe'", "auto"]),
        (("--method", "magic"), ["method", "'magic'", "casadi"]),
    ],
)
def test_bad_option(folder, more, words):
    done = CliRunner().invoke(app, blend_words(folder, *more))
    assert_refused(done, words)
    assert untouched(folder)


def test_report_must_not_be_the_surface(folder):
    done = CliRunner().invoke(app, blend_words(folder, "--report", folder / "." / "out.json"))
    assert_refused(done, ["--report", "another name"])
    assert untouched(folder)


def test_report_that_cannot_be_written_leaves_the_surface_alone(folder):
    done = CliRunner().invoke(app, blend_words(folder, "--report", folder / "none" / "r.json"))
    assert_refused(done, ["none", "does not exist"])
    assert untouched(folder)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["check", "a.json", "b.json", *EDGES, "--require", "G9"], ["--require", "'G9'"]),
        (["check", "a.json", "none.json", *EDGES], ["none.json", "no such file"]),
        (["check", "a.json", "b.json", *EDGES, "--json", "none/x.json"], ["does not exist"]),
        (["list", "none.step"], ["none.step", "no such file"]),
        (["list", "."], ["regular"]),
        (["convert", "a.json", "a.xyz"], ["suffix '.xyz'"]),
        (["convert", "none.igs", "c.json"], ["no such file"]),
        (["convert", "a.json#3", "c.json"], ["no such surface"]),
        (["show", "a.json", "-o", "a.jpg"], [".png"]),
        (["show", "a.json", "-o", "a.png", "--color", "blue"], ["'blue'", "zebra"]),
        (["show", "none.json", "-o", "a.png"], ["no such file"]),
    ],
)
def test_other_commands(folder, monkeypatch, words, said):
    monkeypatch.chdir(folder)
    done = CliRunner().invoke(app, words)
    assert_refused(done, said)
    assert untouched(folder)


@pytest.mark.parametrize(
    "words",
    [["blend"], ["blend", "a.json"], ["nonsense"], ["blend", "a", "b", *EDGES, "-o", "c", "--middle-curves", "x"]],
)
def test_usage_errors_are_status_2(words):
    assert CliRunner().invoke(app, words).exit_code == 2


@pytest.mark.long
def test_the_installed_command_ends_the_same_way(folder):
    """In a process of its own, through the entry point that `semispline` runs."""
    (folder / "a.json").write_text(BAD_FILES["knots that decrease"][0])
    command = [sys.executable, "-c", "from semispline.papers.cli import main; main()"]
    for words, said in (
        (blend_words(folder), "knots_u[4]"),
        (blend_words(folder, a="none.json"), "no such file"),
        (blend_words(folder, edges=("--edge-a", "left", "--edge-b", "u0")), "'left'"),
    ):
        done = subprocess.run([*command, *words], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert done.stdout == ""
        assert done.stderr.startswith("error: ")
        assert done.stderr.count("\n") == 1
        assert said in done.stderr
        assert untouched(folder)


def test_a_base_without_a_normal_is_refused(folder):
    """A surface of no extent has nothing to blend with."""
    point = surface_record(BSplineSurface(1, 1, K, K, np.zeros((2, 2, 3))))
    (folder / "a.json").write_text(json.dumps(point))
    done = CliRunner().invoke(app, blend_words(folder))
    assert_refused(done, [])
    assert untouched(folder)
