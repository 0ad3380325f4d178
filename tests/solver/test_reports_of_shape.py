"""What --report and the terminal say of a blend's shape."""

import json
from contextlib import redirect_stdout
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.cases import CASES
from helpers.shapes import arc, extruded, line, revolved, sheets
from semispline import Base, blend, measure_shape, read_surface, transform
from semispline.papers.cli import app
from semispline.solver.io.json_text import to_text
from semispline.solver.reports import meets_record, print_result, report_record, shape_record

KEYS = {
    "turn_degrees",
    "turn_at",
    "fairness",
    "fairness_jumps",
    "fairness_settled",
    "principal_curvatures",
    "principal_curvatures_at",
    "waist",
    "waist_of_rulings",
    "loop_degrees",
    "loop_at",
    "exits",
    "meets",
}


def test_keys_and_figures():
    shape = measure_shape(revolved(line((5, 0), (5, 10))))
    record = shape_record(shape)
    assert set(record) == KEYS
    assert (record["waist"], record["waist_of_rulings"]) == (pytest.approx(10), pytest.approx(10))
    assert sorted(map(abs, record["principal_curvatures"])) == pytest.approx([0, 1 / 5], abs=1e-12)
    assert record["turn_degrees"] == shape.turn.degrees
    assert record["turn_at"]["section"] == "u"
    assert record["fairness"] == shape.fairness.value
    assert record["loop_degrees"] == pytest.approx(0, abs=1e-6)
    assert record["exits"] == {"degrees": pytest.approx([0, 0], abs=1e-6), "u_turn": False, "sides": None}
    open_one = shape_record(measure_shape(sheets(7, 1)[0]))
    assert (open_one["waist"], open_one["waist_of_rulings"]) == (None, None)


@pytest.mark.long
def test_not_searched_is_null_and_never_no():
    pipe, wall = revolved(line((5, 0), (5, 10))), revolved(line((5, -4), (5, 0)))
    record = json.loads(to_text(shape_record(measure_shape(pipe, Base(wall, "u1")))))["meets"]
    assert (record["itself"], record["a"], record["searched"]) == (None, None, [])
    assert "b" not in record
    # A mesh that was searched in vain is no proof either.
    record = meets_record(measure_shape(pipe, Base(wall, "u1"), search_meets=True).meets)
    assert (record["itself"], record["a"], record["searched"]) == (None, None, ["itself", "a"])
    assert record["deflection"] > 0
    assert meets_record(measure_shape(sheets(7, 1)[0]).meets)["itself"] is False


def test_a_place_that_is_found_is_true():
    way = [*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, 180), *line((-1, 1), (-1, -2))]
    record = meets_record(measure_shape(extruded(way, 1.0), search_meets=True).meets)
    assert record["itself"] is True
    assert record["places"][0]["point"][:2] == pytest.approx([-1, 0], abs=1e-9)


def test_what_cannot_be_told_is_null():
    shape = measure_shape(sheets(7, 1)[0])
    endless = replace(shape, fairness=replace(shape.fairness, value=np.inf, jumps=np.nan))
    record = json.loads(to_text(shape_record(endless)))
    assert (record["fairness"], record["fairness_jumps"]) == (None, None)


def run(folder, *options):
    files = [str(CASES / name) for name in ("pipe_poly.json", "dome_poly.json")]
    outputs = ["-o", str(folder / "out.json"), "--report", str(folder / "report.json")]
    result = CliRunner().invoke(app, ["blend", *files, "--edge-a", "v1", "--edge-b", "v0", *outputs, *options])
    assert result.exit_code == 0, result.output
    return result.output, json.loads((folder / "report.json").read_text())


@pytest.mark.long
def test_pipe_and_cap_on_the_command_line(tmp_path):
    energy = "--alpha", "energy"
    output, report = run(tmp_path, *energy)
    assert set(report) >= KEYS
    assert report["waist"] < 0.5 * report["waist_of_rulings"]
    assert report["meets"]["searched"] == []
    for row in ("turn  ", "fairness  ", "principal curvatures  ", "waist  ", "exits off the straight way  ", "meets  "):
        assert f"\n{row}" in output
    assert "not known whether it meets itself or base a or base b" in output
    assert "warning: the blend is pinched between its rims" in output
    output, report = run(tmp_path, *energy, "--search-meets")
    assert report["meets"]["searched"] == ["itself", "a", "b"]
    assert "may be missed" in output
    assert "not known whether" not in output


def test_the_error_of_quadrature_is_one_number_everywhere():
    """In the unit of the energy, as its rounding is: in the result, in the report, on the terminal."""
    big = [read_surface(CASES / f"{name}_rational.json") for name in ("pipe", "dome")]
    big = [transform(surface, 100 * np.eye(3)) for surface in big]
    result = blend(Base(big[0], "v1"), Base(big[1], "v0"), alpha="natural")
    # A rule of half the nodes, beside the energy of a model of 1000: neither rounding nor a fraction.
    assert 1e-9 * result.energy < result.quadrature_error < 1e-3 * result.energy
    assert report_record(result)["quadrature_error"] == result.quadrature_error
    with redirect_stdout(StringIO()) as printed:
        print_result(result)
    assert f", by quadrature, error {result.quadrature_error:.1e}\n" in printed.getvalue()
