"""Options of `semispline blend` beyond the first: shape, box, scale, strictness."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.bases import facing_pair
from semispline.papers.cli import app
from semispline.solver.io.surface_files import write_surface


@pytest.fixture
def pair(tmp_path):
    a, b = facing_pair(np.random.default_rng(3), edges=("u0", "u0"), backwards=(False, False))
    for name, base in (("a.json", a), ("b.json", b)):
        write_surface(str(tmp_path / name), base.surface)
    return tmp_path


def run(folder, *options):
    files = [str(folder / name) for name in ("a.json", "b.json")]
    outputs = ["-o", str(folder / "out.json"), "--report", str(folder / "report.json")]
    result = CliRunner().invoke(app, ["blend", *files, "--edge-a", "u0", "--edge-b", "u0", *outputs, *options])
    report = folder / "report.json"
    return result, json.loads(report.read_text()) if report.exists() else None


def test_least_energy_is_proved(pair):
    result, report = run(pair, "--alpha", "energy")
    assert result.exit_code == 0, result.output
    assert report["method"] == "reduced"
    assert report["proven_gap"] <= 1e-10
    assert report["objective"]["name"] == "thin plate"
    assert "proved least over the box" in result.output


@pytest.mark.long
def test_the_fairest_shape_is_the_default_and_never_called_proved(pair):
    result, report = run(pair)
    assert result.exit_code == 0, result.output
    assert report["objective"]["name"] == "fairness"
    assert report["objective"]["value"] == pytest.approx(report["fairness"], rel=0.01)
    assert report["proven_gap"] is None
    assert "not proved" in report["objective"]["known"]
    assert (report["candidates"][0]["degree_u"], report["candidates"][0]["middle_curves"]) == (5, 0)
    assert [c["verdict"] for c in report["candidates"]].count("chosen") == 1
    assert report["rows_converted"] >= report["rows_stored"] == report["control_points"]


@pytest.mark.long
def test_alpha_and_box(pair):
    _, natural = run(pair, "--alpha", "natural")
    assert "alpha2_bounds" not in natural
    _, one_set = run(pair, "--alpha", "0.9", "--alpha-b", "energy")
    assert one_set["alpha2"] == pytest.approx(0.81)
    assert "beta2_bounds" in one_set
    _, narrow = run(pair, "--box", "0.5", "2")
    assert narrow["alpha2_bounds"][1] == pytest.approx(4 * narrow["alpha2_bounds"][0])


@pytest.mark.long
def test_scale_changes_the_blend(pair):
    energy = ("--alpha", "energy")
    (_, paper), (_, unit) = run(pair, *energy), run(pair, *energy, "--v-scale", "unit")
    assert paper["alpha2"] != unit["alpha2"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--alpha", "wild"), "alpha: found 'wild'"),
        (("--box", "2", "1"), "box: found (2, 1), expected 1e-20"),
        (("--v-scale", "metric"), "v_scale: found 'metric'"),
        (("--method", "magic"), "method: found 'magic'"),
    ],
)
def test_bad_options_leave_no_file(pair, options, message):
    result, report = run(pair, *options)
    assert result.exit_code == 2
    assert message in result.output
    assert report is None
    assert not (pair / "out.json").exists()


def test_strict_refuses_a_fold(pair):
    result, report = run(pair, "--alpha", "12")
    assert result.exit_code == 0
    assert any("folds" in warning for warning in report["warnings"])
    assert "warning: the blend folds" in result.output
    (pair / "out.json").unlink()
    strict, _ = run(pair, "--alpha", "12", "--strict")
    assert strict.exit_code == 3
    assert not (pair / "out.json").exists()
