"""The evidence behind the verdicts, judged by something else: exact splines at the counterexamples, measured blends."""

import ast
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import semispline.papers.lin2014
from semispline.papers.checks.spline_values import clamped, de_boor
from semispline.papers.ledger.exact import Meaning, UndefinedError, interpret
from semispline.papers.ledger.loading import load_paper
from semispline.papers.ledger.search import smallest_assignment
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.conditions_in_figures import (
    _base_derivatives,
    _printed_derivatives,
    _rows_across,
    at_figure,
    for_which_bases,
    row_2_check,
    straight_counterexample,
)
from semispline.papers.lin2014.checks.conditions_in_figures import row_counterexample as figure_counterexample
from semispline.papers.lin2014.checks.contact_counterexamples import row_counterexample
from semispline.papers.lin2014.checks.contact_rows import row_check, t_ks1, u_before, u_last, w_kr1
from semispline.papers.lin2014.checks.measured_energy import COMMON_TERMS, with_normal_equation
from semispline.papers.lin2014.checks.measured_rows import made_blend, measured_rows, with_printed_rows
from semispline.papers.lin2014.checks.other_methods import quartic_cases
from semispline.papers.lin2014.checks.rows_along_normal import (
    EXCESS_3_1,
    EXCESS_3_1_SQUARES,
    excess_check,
    normal_counterexample,
)
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_2_2, TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.examples.made_pair import made_pair

ROOT = Path(__file__).parents[3]


@pytest.mark.long
def test_printed_formulas_run_in_the_papers_folder_only():
    for path in (*ROOT.glob("solver/**/*.py"), *ROOT.glob("derivations/**/*.py"), *ROOT.glob("papers/**/*.py")):
        if {"lin2014", "primer", "new_paper"} & set(path.parts):
            continue
        names = [
            name
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for name in (getattr(node, "module", None) or "", *(alias.name for alias in node.names))
        ]
        assert not [name for name in names if any(part.startswith("printed") for part in name.split("."))], path


def derivative(order, knots, points, d):
    """Derivative at the start, by differences of exact values on the first span: no formula of ours."""
    first = next(t for t in knots if t > knots[0]) - knots[0]
    count = max(order, 3)
    x = [Fraction(knots[0]) + first * Fraction(i, 2 * count) for i in range(count)]
    values = [de_boor(order, knots, points, t) for t in x]
    t = sp.Symbol("t")
    polynomial = sp.interpolate(
        list(zip(map(sp.Rational, map(str, x)), map(sp.Rational, map(str, values)), strict=True)), t
    )
    return sp.diff(polynomial, t, d).subs(t, sp.Rational(str(knots[0])))


def second_derivative(order, knots, points):
    return derivative(order, knots, points, 2)


ROW_2 = [("printed", pr.COND_3_1), ("corrected", TRUE_3_1)]


@pytest.mark.parametrize("k", [3, 4, 5])
@pytest.mark.parametrize("k_r", [2, 3, 4, 6])
def test_row_2_at_numbers_judged_by_exact_splines(k, k_r):
    """P_uu(0) = alpha^4 R_ww(0): true of the corrected row, false of the printed one."""
    W = clamped(k_r, Fraction(1, 5), Fraction(1, 2), start=0, end=1)
    U = clamped(k, Fraction(1, 4), Fraction(2, 5), Fraction(3, 4))
    R = [Fraction(x) for x in (2, -1, 5)] + [Fraction(0)] * (len(W) - k_r - 3)
    numbers = {
        pr.k: k, pr.k_r: k_r, pr.alpha: Fraction(3, 2), pr.u_1: U[k], pr.u_2: U[k + 1],
        pr.w_kr: W[k_r], w_kr1: W[k_r + 1], pr.w_s: Fraction(0), pr.R_0: R[0], pr.R_1: R[1], pr.R_2: R[2], pr.P_0: R[0],
    }  # fmt: skip
    numbers[pr.P_1] = interpret(pr.COND_2_1.relation.rhs, Meaning(numbers))
    wanted = Fraction(3, 2) ** 4 * Fraction(str(second_derivative(k_r, W, R)))
    found = {}
    for name, formula in ROW_2:
        row = interpret(formula.relation.rhs, Meaning(numbers))
        points = [R[0], numbers[pr.P_1], row] + [Fraction(0)] * (len(U) - k - 3)
        found[name] = Fraction(str(second_derivative(k, U, points)))
    assert found["corrected"] == wanted
    assert found["printed"] != wanted


def vector_derivative(order, knots, rows, d):
    """Derivative of a profile at its start, with as many rows at the origin as the knots ask for."""
    count = len(knots) - order
    padded = [*rows, *[(0, 0, 0)] * (count - len(rows))][:count]
    return sp.Matrix([derivative(order, knots, [Fraction(row[c]) for row in padded], d) for c in range(3)])


def normal_excess(orders, h, H, shape, base, row_2):
    """(P_uu - alpha^4 R_ww) . N for N = R_w x R_v, R_v = (0, 1, 0); rows counted from the contact."""
    k, k_b = orders
    W, U = clamped(k_b, *H[:-1], end=H[-1]), clamped(k, *h)
    first, second = (vector_derivative(k_b, W, base, d) for d in (1, 2))
    normal = first.cross(sp.Matrix([0, 1, 0]))
    assert any(normal)
    step = shape**2 * h[0] * (k_b - 1) / (H[0] * (k - 1))
    row_1 = tuple(Fraction(x) + step * (Fraction(x) - Fraction(y)) for x, y in zip(*base[:2], strict=True))
    blend = [base[0], row_1, row_2]
    # The first order is right: it is the second one that is judged.
    slope = vector_derivative(k, U, blend, 1)
    assert slope == -(sp.Rational(str(shape)) ** 2) * first
    return (vector_derivative(k, U, blend, 2) - sp.Rational(str(shape)) ** 4 * second).dot(normal)


@pytest.mark.parametrize(
    ("side", "formulas"),
    [("start", (pr.COND_3_1, pr.COND_3_1_SQUARES)), ("end", (pr.COND_3_2, pr.COND_3_2_SQUARES))],
)
def test_the_counterexample_to_row_2_is_no_g2_contact(side, formulas):
    found = normal_counterexample(side, formulas)
    values = list(dict(found.values).values())
    assert values == ["3", "3", "1/3", "1/2", "1", "1", "1", "(0, 0, 0)", "(1, 0, 0)", "(0, 0, 1)", "(0, 1, 0)"]
    base = [(0, 0, 0), (1, 0, 0), (0, 0, 1)]
    h, H, one = (Fraction(1, 3), Fraction(1, 2)), (Fraction(1),), Fraction(1)
    for reading in found.printed.split(" or "):
        row = tuple(map(Fraction, re.findall(r"-?\d+(?:/\d+)?", reading.split("= ")[1])))
        assert normal_excess((3, 3), h, H, one, base, row) != 0
    # The third coordinate is 1/6, whatever the others are.
    assert found.true.startswith("third coordinate 1/6,")
    assert normal_excess((3, 3), h, H, one, base, (7, 0, Fraction(1, 6))) == 0
    # In the paper's own orders and knots, on a base with inner knots across.
    assert "k = 4" in found.own
    assert "+1} - t_s = 3" in found.own or "+1} - w_s = 3" in found.own
    own, H = (Fraction(1, 3), Fraction(2, 3)), (Fraction(1), Fraction(3), Fraction(4))
    for wrong in (Fraction(1, 3), Fraction(1, 9)):
        assert f", 0, {wrong})" in found.own
        assert normal_excess((4, 4), own, H, one, base, (0, 0, wrong)) != 0
    assert "third coordinate 2/27" in found.own
    assert normal_excess((4, 4), own, H, one, base, (0, 0, Fraction(2, 27))) == 0


@pytest.mark.long
def test_the_counterexample_to_c2_is_a_regular_base_on_which_both_readings_miss():
    found = load_paper("lin2014").claim("sec-3.parametric-c2").counterexample()
    assert found.own.endswith("R_{0j} = 1, R_{1j} = 0, R_{2j} = 0: printed 2 or 16/9, true 20/9")
    W, U = clamped(4, Fraction(1), Fraction(2), end=3), clamped(4, Fraction(1, 3), Fraction(2, 3))
    R = [Fraction(1)] + [Fraction(0)] * 5
    assert derivative(4, W, R, 1) != 0
    for row_2, c2 in ((2, False), (Fraction(16, 9), False), (Fraction(20, 9), True)):
        P = [Fraction(1), Fraction(4, 3), Fraction(row_2), *[Fraction(0)] * 3]
        # With alpha = 1 the blend leaves the base backwards.
        assert derivative(4, U, P, 1) == -derivative(4, W, R, 1)
        assert (derivative(4, U, P, 2) == derivative(4, W, R, 2)) == c2


# The claim itself is decided in test_lin2014_ledger.py.
@pytest.mark.slow
def test_g2_is_reached_by_the_right_conditions_and_by_neither_reading_of_the_printed_ones():
    parts = [part for reading in load_paper("lin2014").claim("sec-0.reaches").readings for part in reading.parts]
    assert [all(case.true for case in part.check.cases(part.formula)) for part in parts] == [True, False, False]


@pytest.mark.long
def test_the_tangent_condition_at_s_fails_beside_those_of_second_order():
    """For k = 5 the printed row m-1 is row m."""
    found = load_paper("lin2014").claim("sec-3.sufficient-g2").counterexample()
    assert "k = 5" in found.also
    assert "S_{0j} = 0" in found.also
    assert "printed 0, true -" in found.also


@pytest.mark.parametrize("m", [5, 6])
def test_the_squared_condition_of_a_figure_needs_equal_spans(m):
    """P_mm along the normal at numbers, by exact splines; S mirrored, so that its contact is at the start."""
    at = at_figure(pr.COND_3_2_SQUARES, m, parametric=False)
    squared = for_which_bases("end", m, parametric=False, squares=True)
    assert [(case.true, case.meets) for case in squared.cases(at)] == [(True, True), (True, True), (False, False)]
    # As printed not there unless the base is straight across, and the corrected one everywhere.
    printed, true = (at_figure(formula, m, parametric=False) for formula in (pr.COND_3_2, TRUE_3_2))
    assert [case.true for case in squared.cases(printed)] == [False, True, False]
    assert all(case.true for case in squared.cases(true))
    U = clamped(4, *(Fraction(i, m - 2) for i in range(1, m - 2)))
    S = [Fraction(0), Fraction(0), Fraction(1)]
    for second, g2 in ((2, True), (3, False)):
        T = clamped(4, Fraction(1), Fraction(second), end=second + 1)
        numbers = {pr.t_s: Fraction(0), pr.t_ks: T[4], pr.beta: Fraction(1), pr.P_m: S[0], pr.P_m1: S[0]}
        numbers |= dict(zip((pr.S_0, pr.S_1, pr.S_2), S, strict=True))
        P = [S[0], S[0], interpret(at.relation.rhs, Meaning(numbers))] + [Fraction(0)] * (m - 2)
        assert (second_derivative(4, U, P) == second_derivative(4, T, S + [Fraction(0)] * 3)) == g2


@pytest.mark.parametrize("m", [5, 6])
def test_the_counterexample_of_a_figure_refutes_both_readings_along_the_normal(m):
    found = figure_counterexample("end", "curved", m)()
    printed, squared, true = (
        tuple(map(Fraction, re.findall(r"-?\d+(?:/\d+)?", text)))
        for text in (*found.printed.split(", with squares "), found.true)
    )
    # Five rows over [0, 1]; the last two have no part in it.
    T = clamped(4, Fraction(1, 3))
    base = [(0, 0, 0), (1, 0, 0), (0, 0, 1)]
    assert tuple(vector_derivative(4, T, base, 2)) == true
    # By hand: H_2 / h_2 and H_2 h_1 / (h_2 H_1) times the base's third coordinate.
    assert (printed[2], squared[2]) == (true[2] * Fraction(m - 2, 2), true[2] * Fraction(3, 2))


@pytest.mark.long
def test_no_smaller_orders_are_a_counterexample_to_g2(whole):
    """Where R has order 2 the row differs from alpha^4 R_ww within the tangent plane alone, which G2 leaves free."""
    for formula in (pr.COND_3_1, pr.COND_3_1_SQUARES) if whole else (pr.COND_3_1,):
        cases = {case.label: case for case in row_check("start", 2, "normal").cases(formula)}
        assert {label for label, case in cases.items() if case.true} == {f"orders {k}, 2" for k in range(3, 9)}
    # Not smaller, though false in all coordinates.
    assert dict(row_counterexample("start", 2, pr.COND_3_1).values)["k_r"] == "2"
    assert row_counterexample("start", 1, pr.COND_2_1) is None


@pytest.mark.parametrize(
    ("formula", "H", "g2"),
    [
        # As printed exactly where the second distances agree, H_2 = u_2.
        (pr.COND_3_1, (Fraction(1, 4), Fraction(2, 3)), True),
        (pr.COND_3_1, (Fraction(1, 3), Fraction(5, 6)), False),
        (pr.COND_3_1, (Fraction(1, 2), Fraction(1)), False),
        # With squares exactly where the ratios agree: here, with uniform u_i, where both spans have one length.
        (pr.COND_3_1_SQUARES, (Fraction(1, 2), Fraction(1)), True),
        (pr.COND_3_1_SQUARES, (Fraction(1, 4), Fraction(2, 3)), False),
        (pr.COND_3_1_SQUARES, (Fraction(1),), False),
    ],
)
def test_when_a_reading_of_row_2_gives_g2(formula, H, g2):
    h, shape = (Fraction(1, 3), Fraction(2, 3)), Fraction(3, 2)
    base = [(2, 0, 1), (3, 0, 4), (5, 0, -2)]
    numbers = {pr.k: 4, pr.k_r: 4, pr.alpha: shape, pr.u_1: h[0], pr.w_kr: H[0], pr.w_s: Fraction(0)}
    row = []
    for c in range(3):
        at = numbers | {s: Fraction(point[c]) for s, point in zip((pr.R_0, pr.R_1, pr.R_2), base, strict=True)}
        at[pr.P_0] = at[pr.R_0]
        at[pr.P_1] = interpret(pr.COND_2_1.relation.rhs, Meaning(at))
        row.append(interpret(formula.relation.rhs, Meaning(at)))
    excess = normal_excess((4, 4), h, H, shape, base, tuple(row))
    assert (excess == 0) == g2


def test_what_a_reading_misses_is_zero_exactly_there():
    """The excess formulas of the records, against the normal part of an exact blend."""
    for formula, excess in ((pr.COND_3_1, EXCESS_3_1), (pr.COND_3_1_SQUARES, EXCESS_3_1_SQUARES)):
        (case,) = excess_check("start", formula).cases(excess)
        assert case.true
        numerator = sp.numer(sp.together(excess.relation.rhs))
        (zero,) = sp.solve(numerator.subs(pr.w_s, 0), w_kr1)
        assert sp.simplify(zero - (pr.u_2 if formula is pr.COND_3_1 else pr.u_2 / pr.u_1 * pr.w_kr)) == 0
        other = EXCESS_3_1_SQUARES if excess is EXCESS_3_1 else EXCESS_3_1
        assert not any(case.true for case in excess_check("start", formula).cases(other))


def test_search_goes_by_height():
    x, y = sp.symbols("x y", positive=True)
    assert smallest_assignment([x, y], lambda at: at[x] * at[y] == 6) == {x: 2, y: 3}
    assert smallest_assignment([x], lambda at: False) is None
    n = sp.Symbol("n", integer=True, positive=True)
    assert smallest_assignment([n], lambda at: at[n] > Fraction(3, 2)) == {n: 2}


@pytest.mark.parametrize(
    ("side", "formulas"),
    [("start", {1: pr.COND_2_1, 2: TRUE_3_1}), ("end", {1: TRUE_2_2, 2: TRUE_3_2})],
)
def test_corrected_rows_give_back_the_solvers_blend(side, formulas):
    """The solver's rows come from generated code, these from the formulas of the ledger."""
    result = made_blend()
    surface = with_printed_rows(made_pair(), result, side, formulas)
    for ours, theirs in zip(surface.control_curves, result.surface.control_curves, strict=True):
        # Extent 8, a few dozen roundings.
        np.testing.assert_allclose(ours.control_points, theirs.control_points, rtol=0, atol=1e-12)


def test_the_printed_row_leaves_a_curvature_jump_that_both_judges_see():
    consequence = measured_rows("start", {2: pr.COND_3_1}, "made pair")
    assert consequence.measured["relative curvature jump"] > 0.1
    assert consequence.measured["angle between tangent planes [degrees]"] < 1e-9
    assert consequence.corrected["relative curvature jump"] < 1e-9
    assert consequence.judges["Open CASCADE"] == "touches at 5, G1 at 5, G2 at 0 of 5 points"
    right = measured_rows("start", {2: TRUE_3_1}, "made pair")
    assert right.measured["relative curvature jump"] < 1e-9
    assert right.judges["Open CASCADE"] == "touches at 5, G1 at 5, G2 at 5 of 5 points"


def test_the_right_normal_equation_gives_the_solvers_middle_curve():
    result = made_blend("C2")
    surface = with_normal_equation(result, (*COMMON_TERMS, (1, (0, 2), (0, 2))))
    ours, theirs = (s.control_curves[3].control_points for s in (surface, result.surface))
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)


def test_an_undefined_letter_is_not_zero():
    with pytest.raises(UndefinedError, match="x is not defined"):
        interpret(sp.Symbol("x") + 1, Meaning({}))


def test_a_wrong_knot_makes_a_row_check_red():
    """u_1 for u_2 in the corrected row."""
    right = [case.true for case in row_check("start", 2).cases(TRUE_3_1)]
    assert all(right)
    wrong = pr.Formula(TRUE_3_1.relation.xreplace({pr.u_2: pr.u_1}), TRUE_3_1.variables)
    assert not any(case.true for case in row_check("start", 2).cases(wrong))


@pytest.mark.long
def test_every_letter_of_corrected_end_formulas_matters():
    for letter in (u_last, u_before, t_ks1):
        moved = pr.Formula(TRUE_3_2.relation.xreplace({letter: letter + sp.Rational(1, 7)}), TRUE_3_2.variables)
        assert not all(case.true for case in row_check("end", 2).cases(moved)), letter


@pytest.mark.long
def test_the_curvature_that_the_printed_row_gives():
    """Along the normal: the base's second derivative times (w_{k_r+1} - w_s) / u_2, the remark of cond-3.1."""
    assert "times (w_{k_r+1} - w_s) / u_2" in load_paper("lin2014").claim("cond-3.1").remark
    H = sp.symbols("H1 H2", positive=True)
    alpha = sp.Symbol("alpha", positive=True)
    rows, along = _rows_across("curved")
    for m in (5, 6, 8):
        _, second = _printed_derivatives(rows, m, H, alpha)
        first, base = _base_derivatives(rows, H)
        normal = first.cross(along)
        ratio = sp.cancel(second.dot(normal) / (alpha**4 * base.dot(normal)))
        assert sp.simplify(ratio - H[1] / sp.Rational(2, m - 2)) == 0


@pytest.mark.long
def test_the_paper_has_a_title_and_a_legend():
    paper = load_paper("lin2014")
    assert paper.title.startswith("Semi-structured B-spline")
    assert "h_r" in paper.legend
    assert Path(semispline.papers.lin2014.__file__).parent.joinpath("printed.py").is_file()


@pytest.mark.parametrize(("m", "u_1"), [(5, Fraction(1, 3)), (6, Fraction(1, 4))])
def test_the_condition_of_a_figure_at_numbers_judged_by_exact_splines(m, u_1):
    """P_uu(0) = R_ww(0) for a cubic blend with m + 1 rows: true of the corrected row, false of the printed one."""
    U = clamped(4, *(u_1 * i for i in range(1, m - 2)))
    W = clamped(4, Fraction(2, 7), Fraction(3, 5))
    R = [Fraction(x) for x in (2, -1, 5)] + [Fraction(0)] * 3
    numbers = {pr.w_s: Fraction(0), pr.w_kr: W[4], w_kr1: W[5], pr.R_0: R[0], pr.R_1: R[1], pr.R_2: R[2], pr.P_0: R[0]}
    numbers[pr.P_1] = interpret(at_figure(pr.COND_2_1, m, parametric=True).relation.rhs, Meaning(numbers))
    for formula, right in ((pr.COND_3_1, False), (TRUE_3_1, True)):
        at = at_figure(formula, m, parametric=True)
        points = [R[0], numbers[pr.P_1], interpret(at.relation.rhs, Meaning(numbers))] + [Fraction(0)] * (m - 2)
        assert (second_derivative(4, U, points) == second_derivative(4, W, R)) == right
        (case,) = row_2_check("start", m, "any", parametric=True).cases(at)
        assert case.true == right


def test_a_base_that_is_straight_across_hides_the_error_from_its_normal():
    at = at_figure(pr.COND_3_1, 5, parametric=False)
    found = {
        kind: next(iter(row_2_check("start", 5, kind, parametric=False).cases(at))) for kind in ("straight", "curved")
    }
    assert found["straight"].true
    assert not found["curved"].true
    # Printed minus true: H_2 / h_2 - 1 times the base's second derivative along the normal, 6 (R_2 - R_0) / (H_1 H_2).
    H1, H2 = sp.symbols("H1 H2", positive=True)
    wanted = (H2 / sp.Rational(2, 3) - 1) * 6 * (pr.R_2 - pr.R_0) * pr.alpha**4 / (H1 * H2)
    assert sp.simplify(found["curved"].residual - wanted) == 0


def test_the_quartic_and_rows_on_a_line_at_numbers():
    """Known answers, worked out by hand: the quartic meets G2 data; rows give 8 and 36, squared 7, 36, for 0, -27."""
    assert [case.true for case in quartic_cases()] == [False]
    found = straight_counterexample(6)()
    assert (found.printed, found.true) == ("P_uu = 8, with squares 7", "R_ww = 0")
    assert found.also.endswith("printed 36, with squares 36, true -27")
    # The base's second derivative once more, from values of exact splines.
    W = clamped(4, Fraction(1, 3), Fraction(2, 3))
    for rows, wanted in (((0, Fraction(1, 9), Fraction(1, 3)), 0), ((0, 1, 2), -27)):
        points = [Fraction(x) for x in rows] + [Fraction(0)] * (len(W) - 7)
        assert second_derivative(4, W, points) == wanted
