"""The commands `derive` and `generate`, in a process of their own where their exit status matters."""

import os
import re
import shutil
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from sympy import Matrix, Rational, diag
from typer.testing import CliRunner

from semispline.derivations.cli import NAMES, app, derived
from semispline.derivations.codegen.files import THEORY, differences, expected_files, refreshed, write_files
from semispline.derivations.contact import contact_jets, contact_rows
from semispline.derivations.results import FORMS, RESULTS, Request, show
from semispline.derivations.splines import end_derivatives

ROOT = Path(__file__).parents[2]
FORMULAS = (
    "energy", "fairness", "homogeneous-conditions", "homogeneous-last", "joint-slopes", "joint-values", "linear-power",
    "linear-product", "shape-conditions", "special-conditions", "stationarity", "strip-derivatives",
)  # fmt: skip


def run(arguments, folder=ROOT):
    # PYTHONPATH puts the copy before the installed package.
    return subprocess.run(
        [sys.executable, "-m", "semispline.derivations.cli", *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(folder), "COLUMNS": "200"},
        capture_output=True,
        text=True,
        check=False,
    )


def link_package(folder):
    """The public name over the copied folders, as in a checkout."""
    shutil.copytree(ROOT / "semispline", folder / "semispline", symlinks=True)


@pytest.fixture
def checkout(tmp_path):
    """A copy of what `generate` reads and writes."""
    for name in ("derivations", "solver/generated"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "solver" / "__init__.py").write_text("")
    link_package(tmp_path)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    (tmp_path / "docs").mkdir()
    shutil.copy(ROOT / THEORY, tmp_path / THEORY)
    return tmp_path


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", NAMES)
def test_every_result_has_every_form_that_it_can_have(name, form):
    if name in FORMULAS and form not in ("text", "latex"):
        with pytest.raises(ValueError, match="expected form text or latex"):
            show(name, Request(), form)
        return
    text = show(name, Request(degree=2), form)
    assert text.endswith("\n")
    if form in ("numpy", "casadi"):
        compile(text, name, "exec")
    elif form == "latex":
        assert text.count("{") == text.count("}")


def test_help_lists_what_there_is():
    assert sorted(RESULTS) == list(NAMES) == list(RESULTS)


def test_derived_rows_are_what_they_say():
    text = derived("contact-rows --order 2 --degree 3 --base-degree 3")
    rows = dict(line.split(" = ") for line in text.splitlines())
    names = {"a": 1.5, "h1": 0.25, "h2": 0.5, "H1": 1.0, "H2": 2.0, "R_0": 1.0, "R_1": 2.0, "R_2": 4.0}
    found = [eval(rows[f"P_{i}"], {}, names) for i in range(3)]
    # By hand: P_0 = 1; P_1 = 1 - 0.375; P_2 = 1 - 1.125 + 0.28125 * ((4 - 2)/2 - (2 - 1)/1).
    assert found == pytest.approx([1.0, 0.625, -0.125], rel=1e-15)


def equations(call, names):
    """The right sides that `derive` prints for a call, with numbers put in."""
    lines = (line.split(" = ") for line in derived(call).splitlines())
    return {left: eval(right, {"sqrt": np.sqrt}, names) for left, right in lines}


def test_conditions_with_p2_are_those_of_a_base_run_through_unevenly():
    # P(u) = R(w), w = -a u + p2 u^2 / 2: of R = w^2 and R = w^4, by hand.
    a, p2 = 1.5, 0.4
    names = {"a": a, "p2": p2, "R": 0.0, "R_w": 0.0, "R_www": 0.0, "R_wwww": 0.0, "R_ww": 2.0}
    found = equations("shape-conditions --order 4", names)
    # w^2 = a^2 u^2 - a p2 u^3 + p2^2 u^4 / 4.
    assert list(found.values()) == pytest.approx([0.0, 0.0, 2 * a**2, -6 * a * p2, 6 * p2**2], rel=1e-15)
    found = equations("shape-conditions --order 4", names | {"R_ww": 0.0, "R_wwww": 24.0})
    assert list(found.values()) == pytest.approx([0.0, 0.0, 0.0, 0.0, 24 * a**4], rel=1e-15)
    found = equations("shape-conditions --order 2", names | {"R_w": 3.0, "R_ww": 0.0})
    assert list(found.values()) == pytest.approx([0.0, -3 * a, 3 * p2], rel=1e-15)


def test_rows_from_derivatives_are_those_of_a_power():
    # u^3 of degree 3 over knots 0 (four times), 1/4, 1/2, 1: its control points are products of three knots.
    names = {"h1": 0.25, "h2": 0.5, "h3": 1.0, "p": 3, "P": 0.0, "P_u": 0.0, "P_uu": 0.0, "P_uuu": 6.0}
    found = equations("derivative-rows --order 3 --degree 3", names)
    assert list(found.values()) == pytest.approx([0.0, 0.0, 0.0, 0.25 * 0.5 * 1.0], rel=1e-15)
    # u itself: the means of three knots.
    found = equations("derivative-rows --order 3 --degree 3", names | {"P_u": 1.0, "P_uuu": 0.0})
    assert list(found.values()) == pytest.approx([0.0, 0.25 / 3, 0.25, 1.75 / 3], rel=1e-15)


def test_a_linear_alpha_is_a_mean_of_its_ends_and_multiplies_splines():
    a0, a1, s = 2.0, 5.0, 0.25
    (power,) = equations("linear-power --order 3", {"a0": a0, "a1": a1, "s": s}).values()
    assert power == pytest.approx((0.75 * a0 + 0.25 * a1) ** 3, rel=1e-15)
    # v times v over two spans: knots 0, t, 1; products of two knots of the raised vector.
    t = 0.4
    names = {"g0": 0.0, "g1": 1.0, "t": t, "P_0": 0.0, "P_1": t, "P_2": 1.0}
    found = equations("linear-product --degree 1 --knots 0,0,t,1,1", names)
    assert list(found.values()) == pytest.approx([0.0, 0.0, t * t, t, 1.0], rel=1e-15)


def test_the_fairness_of_a_sphere_and_of_a_slope():
    # At a point of a sphere of radius 2 in an orthonormal frame, and with E = 4, G = 9 and H rising by 3 along v.
    flat = {"E": 1.0, "F": 0.0, "G": 1.0, "L": 0.5, "M": 0.0, "N": 0.5, "H_u": 0.0, "H_v": 0.0}
    found = equations("fairness", flat)
    assert (found["H"], found["g_H"]) == (0.5, 0.0)
    found = equations("fairness", flat | {"E": 4.0, "G": 9.0, "H_v": 3.0})
    # |grad H|^2 = (3 / 3)^2, dA = 6 du dv.
    assert found["g_H"] == pytest.approx(6.0)
    # Skew coordinates: x = u + v, y = v, H = x: |grad H| = 1, dA = du dv.
    skew = {"E": 1.0, "F": 1.0, "G": 2.0, "H_u": 1.0, "H_v": 1.0}
    assert equations("fairness", flat | skew)["g_H"] == pytest.approx(1.0)


@pytest.mark.long
@pytest.mark.parametrize("order", range(4))
def test_text_and_matrices_of_contact_agree(order):
    # The equations are rearranged for reading; with exact numbers put in they must give what the matrices give.
    h, H, p, q, a = (
        [Fraction(1, 3), Fraction(1, 2), Fraction(3, 4)],
        [Fraction(2, 5), 1, Fraction(6, 5)],
        5,
        4,
        Fraction(3, 2),
    )
    rows = [Fraction(k, 3) for k in (7, -2, 5, 1)][: order + 1]
    numbers = {f"h{r + 1}": h[r] for r in range(3)} | {f"H{r + 1}": H[r] for r in range(3)} | {"p": p, "q": q, "a": a}
    exact = [list(map(Rational, values[:order])) for values in (h, H)]
    at_start = end_derivatives(order, p, exact[0])
    matrices = {
        ("end-derivatives", "start", "P_{}"): at_start,
        ("end-derivatives", "end", "P_{{m-{}}}"): diag(*((-1) ** d for d in range(order + 1))) * at_start,
        ("contact-rows", "start", "R_{}"): contact_rows(order, p, exact[0], q, exact[1], Rational(a)),
        ("contact-jets", "start", "R_{}"): contact_jets(order, p, exact[0], Rational(a)),
    }
    for (name, end, point), matrix in matrices.items():
        places = [point.format(i) for i in range(order + 1)]
        if end == "end":
            places[0] = "P_m"
        if name == "contact-jets":
            places = ["R", "R_w", "R_ww", "R_www"][: order + 1]
        text = show(name, Request(order=order, end=end))
        for i, place in sorted(enumerate(places), key=lambda pair: -len(pair[1])):
            text = re.sub(rf"(?<![\w]){re.escape(place)}(?!\w)", f"rows[{i}]", text)
        right_sides = [line.split(" = ")[1] for line in text.splitlines()]
        found = [eval(side, {"rows": rows}, numbers) for side in right_sides]
        expected = matrix * Matrix(list(map(Rational, rows)))
        assert [Rational(value) for value in found] == list(expected), name


def test_derived_numpy_code_runs():
    space = {}
    exec(derived("gram-entries --degree 1 --knots 0,0,t,t --derivative 1 --form numpy"), space)
    np.testing.assert_allclose(space["gram_entries"](0.5), [[2, -2], [-2, 2]])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nonsense"], "nonsense: no such result; there are basis-pieces, contact-conditions"),
        (["contact-rows", "--order", "7"], "order: found 7, expected 0..4"),
        (["contact-rows", "--order", "2", "--degree", "1"], "degree: found 1, expected at least 2"),
        (["contact-rows", "--base-degree", "0"], "base_degree: found 0"),
        (["gram-entries", "--knots", "0,0,q!,1"], "knots[2]: found 'q!'"),
        (["gram-entries", "--derivative", "-1"], "derivative: found -1"),
        (["basis-pieces", "--knots", "0,1"], "2 knots for degree 3"),
        (["energy", "--form", "c"], "expected form text or latex"),
    ],
)
def test_bad_requests_end_with_status_two_and_one_line(arguments, words):
    result = CliRunner().invoke(app, ["derive", *arguments])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert words in result.stderr
    assert result.stderr.count("\n") == 1


# That files and formulas are fresh is tested here and in test_codegen.py without the command; `make fresh` runs it too.
@pytest.mark.slow
def test_check_is_quiet_in_this_checkout():
    found = run(["generate", "--check"])
    assert (found.returncode, found.stdout) == (0, ""), found.stdout + found.stderr


@pytest.fixture
def spoilt(checkout):
    """A checkout with a file edited, one missing, one too many, and a formula of the theory changed."""
    folder = checkout / "solver" / "generated"
    edited = folder / "contact_numpy.py"
    edited.write_text(edited.read_text().replace("+ 1", "- 1", 1))
    (folder / "energy_casadi.py").unlink()
    (folder / "old_numpy.py").write_text("x = 1\n")
    theory = checkout / THEORY
    theory.write_text(theory.read_text().replace("P_{0}", "P_{1}", 1))
    return checkout


def says_what_differs(text):
    for line in (
        "--- solver/generated/contact_numpy.py (found)",
        "+++ solver/generated/energy_casadi.py (generated)",
        "+++ solver/generated/old_numpy.py (stale: nothing generates it)",
        "--- docs/theory.md (found)",
    ):
        assert line in text
    assert [line[0] for line in text.splitlines() if "x = 1" in line] == ["-"]


def is_as_committed(checkout):
    """That what is committed is what is generated is tested in test_codegen.py, and below for the theory."""
    assert (checkout / THEORY).read_text() == (ROOT / THEORY).read_text()
    here, there = ({p.name: p.read_text() for p in (f / "solver/generated").glob("*.py")} for f in (checkout, ROOT))
    assert here == there


@pytest.mark.long
def test_whatever_differs_is_seen_and_repaired(spoilt, generated, monkeypatch):
    monkeypatch.setattr("semispline.derivations.codegen.files.generated_files", lambda: generated)
    expected = expected_files(spoilt, derived)
    says_what_differs(differences(spoilt, expected))
    assert {path.name for path in write_files(spoilt, expected)} == {
        "contact_numpy.py", "energy_casadi.py", "old_numpy.py", "theory.md",
    }  # fmt: skip
    is_as_committed(spoilt)
    assert differences(spoilt, expected) == ""


@pytest.mark.slow
def test_the_command_sees_and_repairs_whatever_differs(spoilt):
    found = run(["generate", "--check"], spoilt)
    assert found.returncode == 1, found.stderr
    says_what_differs(found.stdout)
    # Nothing was touched.
    assert (spoilt / "solver/generated/old_numpy.py").exists()
    assert not (spoilt / "solver/generated/energy_casadi.py").exists()
    assert run(["generate"], spoilt).returncode == 0
    is_as_committed(spoilt)


@pytest.mark.long
def test_generate_outside_a_checkout_says_so(tmp_path):
    shutil.copytree(ROOT / "derivations", tmp_path / "derivations", ignore=shutil.ignore_patterns("__pycache__"))
    link_package(tmp_path)
    found = run(["generate"], tmp_path)
    assert found.returncode == 2
    assert "not a checkout of semispline" in found.stderr
    assert found.stderr.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["derivations", "semispline"]


@pytest.mark.slow
def test_a_folder_that_cannot_be_written_is_one_line(checkout):
    target = checkout / "solver" / "generated" / "contact_numpy.py"
    target.unlink()
    # A folder in its place: the finished file cannot be moved there, whoever runs the test.
    target.mkdir()
    (target / "keep").write_text("")
    found = run(["generate"], checkout)
    assert found.returncode == 2
    assert found.stderr.count("\n") == 1
    assert "contact_numpy.py" in found.stderr
    assert (target / "keep").exists()


@pytest.mark.long
def test_formulas_of_the_theory_are_printed_by_derive():
    text = (ROOT / THEORY).read_text(encoding="utf-8")
    assert text.count("<!-- derive ") >= 8
    assert refreshed(text, derived) == text
    # Each formula in the page is such a block: none was typed in by hand.
    assert text.count("```math") == text.count("<!-- derive ")


def test_a_refused_call_in_the_theory_is_an_error():
    with pytest.raises(ValueError, match="derive nonsense"):
        refreshed("<!-- derive nonsense -->\n```math\n\n```\n", derived)
