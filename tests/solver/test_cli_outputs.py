"""Outputs: no input is overwritten, no two outputs are one file, and a path that cannot be is one line."""

import os
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from semispline import BSplineSurface, FileError
from semispline.papers.cli import app
from semispline.solver.io.disk import check_folder, check_output, check_outputs, require_file
from semispline.solver.io.json_files import StoredProblem, write_problem
from semispline.solver.io.surface_files import write_surface

K = [0.0, 0.0, 1.0, 1.0]
FLOOR = BSplineSurface(1, 1, K, K, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
SHELF = BSplineSurface(1, 1, K, K, [[[2, 0, 1], [2, 1, 1]], [[3, 0, 1], [3, 1, 1]]])
EDGES = ("--edge-a", "u1", "--edge-b", "u0")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_surface("a.json", FLOOR)
    write_surface("b.json", SHELF)
    write_surface("a.step", FLOOR)
    (tmp_path / "sub").mkdir()
    os.symlink("a.json", "link.json")
    os.symlink("a.json", "link.png")
    os.symlink("later.json", "dangling.json")
    os.link("a.json", "hard.json")
    return tmp_path


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


BLEND = ("blend", "a.json", "b.json#0", *EDGES)
CALLS = {
    "blend onto A": (*BLEND, "-o", "a.json"),
    "blend onto B": (*BLEND, "-o", "b.json"),
    "blend onto A, written otherwise": (*BLEND, "-o", "./sub/../a.json"),
    "blend through a symbolic link": (*BLEND, "-o", "link.json"),
    "blend through a hard link": (*BLEND, "-o", "hard.json"),
    "report onto A": (*BLEND, "-o", "c.json", "--report", "a.json"),
    "report onto B": (*BLEND, "-o", "c.json", "--report", "b.json"),
    "report onto the blend": (*BLEND, "-o", "c.json", "--report", "./c.json"),
    "report onto the blend, by a link": (*BLEND, "-o", "later.json", "--report", "dangling.json"),
    "check onto A": ("check", "a.json", "b.json", *EDGES, "--json", "hard.json"),
    "check onto B": ("check", "a.json", "b.json", *EDGES, "--json", "b.json"),
    "list": ("list", "a.step", "--json", "a.step"),
    "convert": ("convert", "a.json", "a.json"),
    "convert a numbered surface": ("convert", "a.json#0", "./a.json"),
    "show": ("show", "b.json", "a.json", "-o", "link.png"),
}


@pytest.mark.parametrize("name", CALLS)
def test_no_file_is_both(folder, name):
    before = contents(folder)
    done = CliRunner().invoke(app, list(CALLS[name]))
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    assert done.stderr.startswith("error: ")
    assert "give another name" in done.stderr
    assert done.stderr.count("\n") == 1
    assert contents(folder) == before


def test_a_copy_of_an_input_is_another_file(folder):
    (folder / "copy.json").write_bytes((folder / "a.json").read_bytes())
    assert CliRunner().invoke(app, ["convert", "a.json", "copy.json"]).exit_code == 0
    done = CliRunner().invoke(app, ["check", "a.json", "b.json", *EDGES, "--json", "-"])
    assert done.exit_code == 0
    assert done.stdout.startswith("{")


@pytest.mark.parametrize("where", ["problem", "surface"])
def test_generated_c_replaces_no_input(folder, where):
    """The file of the problem, or of a surface that it names, has the name of a file that is written."""
    (folder / "c").mkdir()
    if where == "problem":
        write_problem("problem.json", StoredProblem(FLOOR, "u1", SHELF, "u0"))
        os.symlink("../problem.json", "c/README.md")
    else:
        write_problem("problem.json", StoredProblem("a.json", "u1", "b.json#0", "u0"))
        os.link("b.json", "c/blend.h")
    before = contents(folder)
    done = CliRunner().invoke(app, ["generate", "--c", "c", "--problem", "problem.json"])
    assert done.exit_code == 2, done.output
    assert "give another name" in done.stderr
    assert contents(folder) == before


LONG, LONG_NAME = "x/" * 2500 + "x", "x" * 300
BAD_PATHS = {"too long": LONG, "a name too long": LONG_NAME, "a NUL byte": "a\0b", "below a file": "a.json/x"}


@pytest.mark.parametrize("kind", BAD_PATHS)
@pytest.mark.parametrize("call", ["-o", "--report", "--json", "list --json", "OUT", "PNG", "A", "FILE", "--c", "DIR"])
def test_a_path_that_cannot_be_is_one_line(folder, kind, call):
    bad = BAD_PATHS[kind]
    words = {
        "-o": (*BLEND, "-o", f"{bad}.json"),
        "--report": (*BLEND, "-o", "c.json", "--report", f"{bad}.json"),
        "--json": ("check", "a.json", "b.json", *EDGES, "--json", bad),
        "list --json": ("list", "a.step", "--json", bad),
        "OUT": ("convert", "a.json", f"{bad}.json"),
        "PNG": ("show", "a.json", "-o", f"{bad}.png"),
        "A": ("blend", f"{bad}.json", "b.json", *EDGES, "-o", "c.json"),
        "FILE": ("list", f"{bad}.step"),
        "--c": ("generate", "--c", bad, "--problem", "a.json"),
        "DIR": ("reproduce", "lin2014", "--out", bad),
    }[call]
    before = contents(folder)
    done = CliRunner().invoke(app, list(words))
    assert done.exit_code == 2, done.output
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    assert len(done.stderr) < 1000
    assert contents(folder) == before


@given(st.text(max_size=400))
def test_any_text_as_a_path_is_taken_or_refused(text):
    for check in (check_output, check_folder, require_file):
        with suppress(FileError):
            check(text)


def test_each_refusal_names_its_reason(folder):
    for path, words in (
        ("sub", "is a folder"),
        ("a.json/x.json", "a.json is not a folder"),
        ("none/x.json", "does not exist"),
        (LONG, "too long"),
        ("a\0b", "null"),
    ):
        with pytest.raises(FileError, match=words):
            check_output(path)
    os.symlink("round", "round")
    for check in (check_output, require_file):
        with pytest.raises(FileError, match="symbolic links"):
            check("round")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read_is_not_called_broken(folder):
    for name in ("a.json", "a.step"):
        (folder / name).chmod(0)
        done = CliRunner().invoke(app, ["list", name])
        assert done.exit_code == 2
        assert "may not be read" in done.stderr


def test_what_is_not_given_is_not_checked(folder):
    check_outputs({"--report": None, "--out": "c.json"}, ["a.json", "none.json"])
    with pytest.raises(FileError, match=r"--out: none\.json is the input none\.json"):
        check_outputs({"--out": "none.json"}, ["none.json"])
