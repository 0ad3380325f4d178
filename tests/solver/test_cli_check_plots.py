"""The table of `semispline check`, its plots, and what its JSON holds of how measures run along the edge."""

import json

import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

from semispline import BSplineSurface, write_surface
from semispline.solver.cli import app
from semispline.solver.judge.profile import Profile
from semispline.solver.pictures.profiles import profile_plots

K = [0.0, 0, 1, 1]
PLOTS = ["angle.png", "curvature.png", "gap.png", "rate.png", "second-rate.png"]


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def call(tmp_path):
    """Two strips whose edges are apart by 0 at one end and by 0.5 at the other."""
    left = [[[x, y, 0.0] for y in (0.0, 4.0)] for x in (-1.0, 0.0)]
    right = [[[x, y, y / 8] for y in (0.0, 4.0)] for x in (0.0, 1.0)]
    for name, net in (("a", left), ("b", right)):
        write_surface(tmp_path / f"{name}.json", BSplineSurface(1, 1, K, K, net))
    return "check", tmp_path / "a.json", tmp_path / "b.json", "--edge-a", "u1", "--edge-b", "u0"


def cells(line):
    return [cell for cell in line.split("  ") if cell]


def test_the_table_says_maximum_mean_limit_and_where(call):
    done = run(*call)
    assert done.exit_code == 0
    head, gap = (cells(line) for line in done.stdout.splitlines()[:2])
    assert [word.strip() for word in head] == [
        "measure",
        "maximum",
        "mean",
        "limit",
        "unit",
        "at parameter",
        "at point",
    ]
    # The size of the model is 4.
    assert [word.strip() for word in gap] == ["gap", "0.5", "0.25", "4e-11", "model units", "1", "(0, 4, 0)"]


def test_what_was_asked_for_is_answered_row_by_row(call):
    done = run(*call, "--require", "G1")
    assert done.exit_code == 1
    lines = [[word.strip() for word in cells(line)] for line in done.stdout.splitlines()]
    assert lines[0][4] == "met"
    assert [line[4] for line in lines[1:5]] == ["no", "no", "-", "-"]
    assert "counts only with G2" in lines[6]


def test_json_holds_means_and_the_run_along_the_edge(call):
    record = json.loads(run(*call, "--json", "-").stdout)
    assert record["mean"]["gap"] == pytest.approx(0.25)
    profile = record["profile"]
    assert set(profile) == {"parameter", "length"} | set(record["mean"])
    assert {len(values) for values in profile.values()} == {len(profile["length"])}
    np.testing.assert_allclose(profile["gap"], np.array(profile["length"]) / 8, atol=1e-6)
    assert max(profile["gap"]) == record["gap"]


@pytest.mark.long
def test_plots_are_written_all_or_none(call, tmp_path):
    folder = tmp_path / "plots"
    assert run(*call, "--plots", folder).exit_code == 0
    assert sorted(path.name for path in folder.iterdir()) == PLOTS
    assert all(imread(path).shape == (540, 1200, 4) for path in folder.iterdir())
    for wrong, said in ((tmp_path / "a.json", "is not a folder"), (tmp_path / "no" / "p", "does not exist")):
        done = run(*call, "--plots", wrong, "--json", tmp_path / "r.json")
        assert (done.exit_code, done.stdout) == (2, "")
        assert said in done.stderr
    assert not (tmp_path / "r.json").exists()


def orange(data, tmp_path):
    """How many pixels of a plot are those of the line of the limit."""
    (tmp_path / "p.png").write_bytes(data)
    r, g, b = np.moveaxis(np.rint(imread(tmp_path / "p.png")[..., :3] * 255), -1, 0)
    return int(((abs(r - 213) < 20) & (abs(g - 94) < 20) & (b < 20)).sum())


@pytest.mark.long
@pytest.mark.parametrize("most", [0.0, 1e-13, 0.5, 80.0, np.nan])
def test_the_limit_is_a_line_where_there_is_one(tmp_path, most):
    length = np.linspace(0, 2, 9)
    points = np.stack([length, 0 * length, 0 * length], axis=1)
    profile = Profile(length, points, length, {"gap": most * length / 2, "rate_jump_relative": 0 * length})
    plots = profile_plots(profile, {"gap": 0.8}, "mm")
    assert list(plots) == ["gap.png", "rate.png"]
    # Longer than in the legend.
    assert orange(plots["gap.png"], tmp_path) > 500
    assert orange(plots["rate.png"], tmp_path) == 0
    assert orange(profile_plots(profile, {"gap": np.nan}, None)["gap.png"], tmp_path) == 0
