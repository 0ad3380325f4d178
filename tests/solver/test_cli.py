import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyiges
import pytest
from typer.testing import CliRunner

from helpers.bases import facing_pair
from semispline import BSplineSurface, ComputationError, SemiStructuredSurface
from semispline.solver.cli import app
from semispline.solver.io.surface_files import read_surface, write_surface
from semispline.solver.topology import edge_blends

IMPELLER = Path(pyiges.__file__).parent / "examples" / "impeller.igs"
K = [0.0, 0.0, 1.0, 1.0]
ENTRY = "from semispline.papers.cli import main; main()"


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def in_process_of_its_own(*words, **options):
    command = [sys.executable, "-c", ENTRY, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def plane(height=0.0, start=0.0):
    return BSplineSurface(1, 1, K, K, [[[x + start, y, height] for y in (0, 1)] for x in (0, 1)])


@pytest.fixture
def pair(tmp_path):
    """A floor and a shelf; their edges u1 and u0 face each other."""
    write_surface(tmp_path / "a.json", plane())
    write_surface(tmp_path / "b.json", plane(height=0.5, start=2.0))
    return tmp_path


def edges(a="u1", b="u0"):
    return "--edge-a", a, "--edge-b", b


def test_blend_writes_surface_and_report(pair):
    done = run("blend", pair / "a.json", pair / "b.json", *edges(), "-o", pair / "c.json", "--report", pair / "r.json")
    assert done.exit_code == 0, done.output
    surface = read_surface(pair / "c.json")
    assert isinstance(surface, SemiStructuredSurface)
    report = json.loads((pair / "r.json").read_text())
    assert report["continuity"] == ["G2", "G2"]
    assert report["control_points"] == surface.n_control_points
    assert report["flipped"] is False
    assert report["energy"] > 0
    assert report["seconds"] > 0
    for name in ("alpha2", "beta2"):
        low, high = report[f"{name}_bounds"]
        assert 0 < low <= report[name] <= high < np.inf
    assert isinstance(report["active_bounds"], list)
    for name in ("contact_a", "contact_b"):
        contact = report[name]
        assert 0 <= contact["angle_degrees"] < 1e-9
        assert 0 <= contact["curvature_jump_relative"] < 1e-9
        assert {"gap", "curvature_jump"} <= set(contact)
        assert len(contact["gap_at"]["point"]) == 3
    assert "energy" in done.stdout
    assert sorted(p.name for p in pair.iterdir()) == ["a.json", "b.json", "c.json", "r.json"]


def test_bounds_are_absent_where_nothing_is_unknown(pair):
    options = ("--continuity", "C2", "--continuity-b", "C0", "--middle-curves", 0)
    files = ("-o", pair / "c.json", "--report", pair / "r.json")
    done = run("blend", pair / "a.json", pair / "b.json", *edges(), *options, *files)
    assert done.exit_code == 0, done.output
    report = json.loads((pair / "r.json").read_text())
    assert report["continuity"] == ["C2", "C0"]
    assert report["beta2"] is None
    assert not {"alpha2_bounds", "beta2_bounds"} & set(report)


def test_check_measures_and_decides(pair):
    run("blend", pair / "a.json", pair / "b.json", *edges(), "--continuity", "G1", "-o", pair / "c.json")
    good = run("check", pair / "a.json", pair / "c.json", *edges(), "--require", "G1", "--json", pair / "k.json")
    assert good.exit_code == 0, good.output
    assert "G1: yes" in good.stdout
    assert "degrees" in good.stdout
    record = json.loads((pair / "k.json").read_text())
    assert record["meets"] is True
    assert record["angle_degrees"] < 1e-9
    bad = run("check", pair / "a.json", pair / "b.json", *edges(), "--require", "G1", "--json", "-")
    assert bad.exit_code == 1
    record = json.loads(bad.stdout)
    assert record["meets"] is False
    # Edges at x = 1, z = 0 and at x = 2, z = 1/2.
    assert record["gap"] == pytest.approx(np.hypot(1, 0.5), rel=1e-14)
    assert run("check", pair / "a.json", pair / "b.json", *edges()).exit_code == 0


def test_check_names_measure_value_and_limit(tmp_path):
    write_surface(tmp_path / "a.json", plane())
    write_surface(tmp_path / "b.json", BSplineSurface(1, 1, K, K, [[[1, 0, 0], [1, 1, 0]], [[2, 0, 1], [2, 1, 1]]]))
    done = run("check", tmp_path / "a.json", tmp_path / "b.json", *edges(), "--require", "G2")
    assert done.exit_code == 1
    assert "G2: no: angle degrees is 45, at most" in done.stdout


@pytest.mark.long
@pytest.mark.parametrize("suffix", [".json", ".3dm"])
def test_units_of_a_stay(tmp_path, suffix):
    a, b = facing_pair(np.random.default_rng(0))
    write_surface(tmp_path / "a.3dm", a.surface, "in")
    write_surface(tmp_path / "b.3dm", BSplineSurface(*_scaled(b.surface, 25.4)), "mm")
    out = tmp_path / f"c{suffix}"
    done = run("blend", tmp_path / "a.3dm", tmp_path / "b.3dm", *edges(a.edge, b.edge), "-o", out)
    assert done.exit_code == 0, done.output
    done = run("check", tmp_path / "a.3dm", out, *edges(a.edge, "u0"), "--require", "G2", "--json", "-")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["unit"] == "in"


def _scaled(surface, factor):
    knots = (surface.knots_u, surface.knots_v)
    return surface.degree_u, surface.degree_v, *knots, surface.control_points * factor


def test_list_prints_one_line_a_surface(pair):
    done = run("list", pair / "a.json")
    assert done.exit_code == 0
    header, line = done.stdout.splitlines()
    assert header.split()[:3] == ["#", "kind", "degrees"]
    assert line.split() == ["0", "B-spline", "1,", "1", "2", "x", "2", "-", "-", "-"]


@pytest.mark.long
def test_list_json_of_iges_is_clean():
    done = in_process_of_its_own("list", IMPELLER, "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    surfaces = json.loads(done.stdout)["surfaces"]
    assert len(surfaces) == 277
    assert {surfaces[i]["n_u"] for i in (102, 131)} == {17}


@pytest.mark.long
def test_convert_keeps_the_surface(pair):
    for name in ("a.3dm", "a2.json"):
        assert run("convert", pair / "a.json", pair / name).exit_code == 0
    assert run("convert", pair / "a.3dm", pair / "back.json").exit_code == 0
    np.testing.assert_array_equal(read_surface(pair / "back.json").control_points, plane().control_points)
    assert (pair / "a.json").read_text() == (pair / "a2.json").read_text()


@pytest.mark.long
def test_convert_and_blend_of_semistructured_files(pair):
    run("blend", pair / "a.json", pair / "b.json", *edges(), "-o", pair / "c.json")
    assert run("convert", pair / "c.json", pair / "c.3dm").exit_code == 0
    # Its exact B-spline form still meets the base.
    done = run("check", pair / "a.json", pair / "c.3dm", *edges(), "--require", "G2")
    assert done.exit_code == 0, done.output
    assert run("convert", pair / "c.json", pair / "c.stl").exit_code == 0


def test_failed_computation_is_status_3(pair, monkeypatch):
    def fail(*_, **__):
        raise ComputationError("the solver gave up\nafter a while; try fewer middle curves")

    monkeypatch.setattr(edge_blends, "blend", fail)
    (pair / "c.json").write_text("old")
    done = run("blend", pair / "a.json", pair / "b.json", *edges(), "-o", pair / "c.json")
    assert done.exit_code == 3
    assert done.stderr == "error: the solver gave up after a while; try fewer middle curves\n"
    assert (pair / "c.json").read_text() == "old"


def test_help_imports_nothing_heavy():
    heavy = {"numpy", "scipy", "casadi", "sympy", "OCP", "pydantic"}
    code = f"import sys, semispline.solver.cli; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_every_command_has_help():
    for command in ("blend", "check", "list", "show", "convert"):
        done = run(command, "--help")
        assert done.exit_code == 0
        assert "Usage" in done.stdout


@pytest.mark.long
def test_real_pair_end_to_end(tmp_path):
    specs = (f"{IMPELLER}#102", f"{IMPELLER}#131")
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    out, report = tmp_path / "c.step", tmp_path / "r.json"
    words = ("blend", *specs, *edges("u0", "u0"), "-o", out, "--report", report)
    done = in_process_of_its_own(*words, env=environment)
    assert done.returncode == 0, done.stderr
    # Both faces are trimmed far inside of their surfaces; distances as the kernel's own extrema give them.
    for spec, distance in zip(specs, ("12.8", "9.11"), strict=True):
        assert f"the edge u0 of {spec} lies outside of the face, up to {distance} mm from" in done.stderr
    assert done.stderr.count("\n") == 2
    assert json.loads(report.read_text())["continuity"] == ["G2", "G2"]
    # What came through STEP still meets with G2.
    done = in_process_of_its_own("check", specs[0], out, *edges("u0", "u0"), "--require", "G2", env=environment)
    assert done.returncode == 0
    assert done.stderr.count("\n") == done.stderr.count("warning: ") == 1
    assert "mm" in done.stdout
