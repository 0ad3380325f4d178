"""`semispline generate --c`: what it writes, what it refuses; a folder is left whole or untouched."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.bases import facing_pair
from semispline import BSplineSurface
from semispline.papers.cli import app
from semispline.solver.io import disk
from semispline.solver.io.json_files import StoredProblem, write_json_surface, write_problem

K = [0.0, 0.0, 1.0, 1.0]
FLOOR = BSplineSurface(1, 1, K, K, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
RATIONAL = BSplineSurface(1, 1, K, K, FLOOR.control_points, [[1, 2], [1, 1]])
FILES = ["README.md", "blend.c", "blend.h"]


def stored(folder, a=None, b=None, **options):
    one, other = facing_pair(np.random.default_rng(0), edges=("u0", "u0"))
    path = folder / "problem.json"
    write_problem(path, StoredProblem(a or one.surface, one.edge, b or other.surface, other.edge))
    record = json.loads(path.read_text())
    path.write_text(json.dumps(record | {"options": options}))
    return path


def generate(*words):
    return CliRunner().invoke(app, ["generate", *map(str, words)])


@pytest.mark.parametrize(("continuity", "has_solve"), [("G2", False), (("C2", "C2"), True), (("C2", "G0"), True)])
def test_three_files_are_written(tmp_path, continuity, has_solve):
    done = generate("--c", tmp_path / "out", "--problem", stored(tmp_path, continuity=continuity))
    assert done.exit_code == 0, done.output
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == FILES
    source, readme = ((tmp_path / "out" / name).read_text() for name in ("blend.c", "README.md"))
    for name in ("objective", "gradient", "constraints", "jacobian", "hessian"):
        assert f"int blend_{name}(" in source
        assert f"`blend_{name}`" in readme
    assert ("int blend_solve(" in source) == has_solve
    assert ("`blend_solve`" in readme) == has_solve


def test_the_same_problem_gives_the_same_text(tmp_path):
    problem = stored(tmp_path)
    for name in ("one", "two"):
        assert generate("--c", tmp_path / name, "--problem", problem).exit_code == 0
    for name in FILES:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_surfaces_may_lie_in_files_of_their_own(tmp_path):
    one, other = facing_pair(np.random.default_rng(0), edges=("u0", "u0"))
    write_json_surface(tmp_path / "b.json", other.surface)
    split, whole = tmp_path / "split.json", stored(tmp_path)
    write_problem(split, StoredProblem(one.surface, one.edge, "b.json", other.edge))
    for name, problem in (("one", split), ("two", whole)):
        assert generate("--c", tmp_path / name, "--problem", problem).exit_code == 0
    assert (tmp_path / "one" / "blend.c").read_text() == (tmp_path / "two" / "blend.c").read_text()


@pytest.mark.parametrize("weights", [[[3, 3], [3, 3]], [[1, 1], [1, 1]]])
def test_weights_that_are_all_equal_are_none(tmp_path, weights):
    weighted = BSplineSurface(1, 1, K, K, FLOOR.control_points, weights)
    for name, a in (("one", FLOOR), ("two", weighted)):
        problem = stored(tmp_path, a=a)
        done = generate("--c", tmp_path / name, "--problem", problem)
        assert done.exit_code == 0, done.stderr
    assert (tmp_path / "one" / "blend.c").read_text() == (tmp_path / "two" / "blend.c").read_text()


def test_other_files_of_the_folder_stay(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "main.c").write_text("mine")
    (tmp_path / "out" / "blend.c").write_text("old")
    assert generate("--c", tmp_path / "out", "--problem", stored(tmp_path)).exit_code == 0
    assert (tmp_path / "out" / "main.c").read_text() == "mine"
    assert (tmp_path / "out" / "blend.c").read_text() != "old"
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted([*FILES, "main.c"])


def refused(done, *words):
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    for word in words:
        assert word in done.stderr


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"a": RATIONAL}, ["rational"]),
        ({"continuity": "C7"}, ["continuity", "'C7'"]),
        ({"middle_curves": -1}, ["middle_curves", "-1"]),
        ({"a": FLOOR, "b": FLOOR}, ["contact curves coincide"]),
    ],
)
def test_a_problem_that_cannot_be_stated_is_refused(tmp_path, changes, words):
    problem = stored(tmp_path, **changes)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "blend.c").write_text("old")
    refused(generate("--c", tmp_path / "out", "--problem", problem), *words)
    refused(generate("--c", tmp_path / "new", "--problem", problem), *words)
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["blend.c"]
    assert (tmp_path / "out" / "blend.c").read_text() == "old"
    assert not (tmp_path / "new").exists()


def test_files_and_calls_are_refused(tmp_path):
    problem = stored(tmp_path)
    out = tmp_path / "out"
    refused(generate("--c", out, "--problem", tmp_path / "none.json"), "none.json", "no such file")
    refused(generate("--c", out), "--problem")
    refused(generate("--problem", problem), "--c")
    refused(generate("--check", "--c", out, "--problem", problem), "--check")
    refused(generate("--c", problem, "--problem", problem), "not a folder")
    refused(generate("--c", tmp_path / "no" / "out", "--problem", problem), "does not exist")
    broken = tmp_path / "broken.json"
    broken.write_text(json.dumps(json.loads(problem.read_text()) | {"edge_a": "w0"}))
    refused(generate("--c", out, "--problem", broken), "edge_a", "'w0'")
    surface = tmp_path / "surface.json"
    write_json_surface(surface, FLOOR)
    refused(generate("--c", out, "--problem", surface), "kind", "blend_problem")
    assert not out.exists()


@pytest.mark.parametrize("is_new", [True, False])
def test_a_full_disk_leaves_nothing_half_done(tmp_path, monkeypatch, is_new):
    problem, out = stored(tmp_path), tmp_path / "out"
    if not is_new:
        out.mkdir()
        (out / "blend.c").write_text("old")
    right = disk.atomic_path

    def full(path):
        if path.name == "README.md":
            raise disk.FileError(f"{path}: cannot be written: No space left on device")
        return right(path)

    monkeypatch.setattr(disk, "atomic_path", full)
    refused(generate("--c", out, "--problem", problem), "No space left")
    if is_new:
        assert not out.exists()
    else:
        assert [(path.name, path.read_text()) for path in out.iterdir()] == [("blend.c", "old")]
