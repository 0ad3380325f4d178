"""Section 2, the Bezier example: (4) to (6), Q_j^s, blossoms, counts, Figs. 2 and 3."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sympy import Eq, Ge, Sum, Symbol

from semispline.papers.checks import casteljau_cases, elevation_cases
from semispline.papers.ledger import (
    Case,
    Check,
    Claim,
    Correction,
    Counterexample,
    Formula,
    Part,
    Reading,
    Strength,
    ambiguous,
    fails,
    given,
    holds,
    not_checkable,
    of_data,
    part,
    proved,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014 import printed_figures as figures
from semispline.papers.lin2014.checks import bezier_division as division
from semispline.papers.lin2014.checks import bezier_patch as bezier
from semispline.papers.lin2014.checks import trimming
from semispline.papers.lin2014.checks.measured_section_2 import missing_first_row, top_last_row

_WHERE = "Section 2, Bezier example"
_TRIANGLE = "what multiplies one control point in de Casteljau's triangle, every degree; run for degrees 1 to 5 as well"
_POLAR = "the sum over all choices of arguments, split by the last one, every s and n; run for degrees up to 4 as well"
_EXPANSION = (
    "what multiplies one control point, by the binomial theorem, every m, n, k; and rows found by substituting v(u) "
    "and changing the basis, degrees up to (3, 3, 2)"
)
_ROWS = "what multiplies one blossom, every m, n, k; run at v(u) up to degrees (3, 3, 2) as well"
_LEMMAS = "the identities behind the closed form, for every m, n, k"
_COUNTING = "degrees of the rows, every m, n, k; rows found by substitution up to degrees (3, 3, 2) as well"


def _identity(cases: Any, method: str) -> Check:
    """Return a check that decides an identity for all degrees, parameters and control points, then at some degrees."""
    return Check(cases, Strength.GENERAL, method, proof=True)


_DECIMALS = "the printed decimals, exactly"
TRUE_TOP_LAST = Formula(Eq(pr.F(pr.n, 0), pr.m + 1), (pr.m, pr.n))
_LEMMA_PART = part(_identity(division.lemma_cases, _LEMMAS))
_TRIANGLE_PART = part(proved(casteljau_cases, "a step of de Casteljau's triangle on Bernstein polynomials, "
                             "by induction over the degree"))  # fmt: skip
_STEP_PART = part(proved(division.row_step_cases, "one more argument, by induction over s"))


def _top_last_counterexample() -> Counterexample:
    m, n, k = min(bezier.DEGREES, key=sum)
    case = next(c for c in division.last_row_cases(pr.COUNT_TOP_LAST) if not c.true and c.residual.is_Integer)
    values = (("m", str(m)), ("n", str(n)), ("k", str(k)))
    return Counterexample(values, f"{m + 1} control points for Q_0^{n}", f"{m + 1 - int(case.residual)}")


def _range_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield the rows of (6) for every n: s runs over the printed limits in Q_0^s, the other way in Q_j^{n-j}."""
    relation = given(formula).relation
    ((_, first, last),) = pr.EQ_6_BOTTOM.relation.rhs.limits
    inside = Symbol("a", integer=True, positive=True)
    for label, index, used in (
        ("Q_0^0 and Q_n^0", first, True),
        ("Q_0^n, every n", last, True),
        ("Q_0^s and Q_{n-s}^s, s = 1, .., n - 1", inside, True),
        ("no row of degree m - k", first - 1, False),
    ):
        admitted = relation.subs(pr.s, index) == True  # noqa: E712  # a relation may stay undecided
        short = relation.lhs.subs(pr.s, index) - relation.rhs
        yield Case(label, admitted == used, residual=short if used and not admitted else None)


ROW_0 = Formula(
    Eq(pr.Q(pr.j, 0, pr.u), Sum(pr.F(pr.i, pr.j) * pr.B(pr.i, pr.m, pr.u), (pr.i, 0, pr.m))),
    (pr.j, pr.u, pr.m),
)


Q_RANGE_FROM_0 = Formula(Ge(pr.s, 0, evaluate=False), (pr.s,))


def _range_counterexample() -> Counterexample:
    case = next(c for c in _range_cases(pr.Q_RANGE) if not c.true)
    return Counterexample((("n", "1"), ("rows", case.label)), "undefined", "Q_0^0 = sum of P_i0 B_i^m")


_RANGE = of_data(_range_cases, "each row of (6) against the range, every n")

CLAIMS: tuple[Claim, ...] = (
    holds("eq-4", _WHERE, "A Bezier patch as a double sum over Bernstein polynomials.",
          part(_identity(bezier.patch_cases, _TRIANGLE), pr.EQ_4), _TRIANGLE_PART),
    holds("eq-5", _WHERE,
          "A Bezier function v(t) with control points (i/k, v_i); with v_i in [0, 1] it stays in [0, 1].",
          part(_identity(bezier.function_cases, _TRIANGLE), pr.EQ_5),
          part(_identity(bezier.function_cases, _TRIANGLE), pr.EQ_5_ABSCISSA),
          _TRIANGLE_PART,
          remark="v(t) is a mean of the v_i: the weights are not negative and sum to 1, by the steps of the triangle."),
    holds("eq-6", _WHERE,
          "The sub-patches below and above v(u) are P_1 = sum of Q_0^s B_s^n and P_2 = sum of Q_s^{n-s} B_s^n.",
          part(_identity(division.division_cases("bottom"), _EXPANSION), pr.EQ_6_BOTTOM),
          part(_identity(division.division_cases("top"), _EXPANSION), pr.EQ_6_TOP), _LEMMA_PART,
          remark="v runs over [0, 1] across each sub-patch: P_1(u, v) = P(u, v v(u)), P_2(u, v) = P(u, v(u) + (1 - "
          "v(u)) v); the text does not say so. The letters k and l stand for an order elsewhere."),
    holds("sec-2.q-formula", _WHERE,
          "Q_j^s has the Bezier points that the formula under (6) gives: products of binomials and blossoms.",
          *(part(_identity(division.row_formula_cases(depth), _ROWS), formula)
            for depth, formula in enumerate(pr.Q_ROWS, start=1)), _STEP_PART, _LEMMA_PART,
          remark="The formula itself is run for s = 1, 2, 3; each further argument multiplies its terms by one more "
          "Bernstein polynomial, as it does in the product. Several (i, j_1, .., j_s) share one Bernstein polynomial; "
          "the sum over l only groups them."),
    fails("sec-2.q-range", _WHERE,
          "The formula for Q_j^s with s = 1, .., n and j = 0, .., n-s defines every row that (6) uses.",
          part(_RANGE, pr.Q_RANGE),
          correction=Correction("s = 0, .., n with P_ij^0 = P_ij.",
                                (Part(_RANGE, Q_RANGE_FROM_0),
                                 Part(_identity(division.row_formula_cases(0), "the row of the patch itself"), ROW_0))),
          counterexample=_range_counterexample, consequence=missing_first_row,
          cause="misprints",
          remark="The counts in the text do include Q_0^0 with its m + 1 points."),
    holds("sec-2.blossom-1", _WHERE, "First step of the blossom recursion.",
          part(_identity(bezier.blossom_cases(True), _POLAR), pr.BLOSSOM_1), _TRIANGLE_PART),
    holds("sec-2.blossom-2", _WHERE, "Further steps of the blossom recursion, s = 2, .., n.",
          part(_identity(bezier.blossom_cases(False), _POLAR), pr.BLOSSOM_2), _TRIANGLE_PART,
          remark="The order of the arguments does not matter, so that the order of the printed steps does not either."),
    holds("sec-2.bottom-counts", _WHERE,
          "The rows of the bottom sub-patch have m+1, m+k+1, .., m+nk+1 control points; there are n+1 of them.",
          part(_identity(division.count_cases("bottom"), _COUNTING), pr.COUNT_BOTTOM)),
    holds("sec-2.top-counts", _WHERE,
          "The rows of the top sub-patch have m+nk+1, m+(n-1)k+1, .., m+1 control points; there are n+1 of them.",
          part(_identity(division.count_cases("top"), _COUNTING), pr.COUNT_TOP)),
    fails("sec-2.top-last-row", _WHERE, "The last row of the top sub-patch, with m+1 control points, is Q_0^n.",
          part(_identity(division.last_row_cases, _COUNTING), pr.COUNT_TOP_LAST),
          correction=Correction("The last row is Q_n^0, the edge v = 1 of the patch.",
                                (Part(_identity(division.last_row_cases, _COUNTING), TRUE_TOP_LAST),)),
          counterexample=_top_last_counterexample, consequence=top_last_row,
          cause="misprints",
          remark="Indices exchanged, or misread by the scan: with Q_n^0 it is right. Q_0^n is the row on the dividing "
          "curve, which the same sentence names first, with m+nk+1 points."),
    ambiguous("sec-2.subpatch-kind", _WHERE, "Therefore both sub-patches are semi-structured patches.",
              Reading((part(Check(division.same_order_cases, Strength.RATIONAL, "orders of the rows, every m, n, k")),),
                      label="(6) with its counts is of the form (1), whose control curves all have one order"),
              Reading((part(proved(elevation_cases, "raising a row by one degree, every degree")), _LEMMA_PART),
                      label="they can be written in the form (1)"),
              Reading((part(_identity(division.division_cases("bottom"), _EXPANSION), pr.EQ_6_BOTTOM),
                       part(_identity(division.division_cases("top"), _EXPANSION), pr.EQ_6_TOP),
                       part(_identity(division.count_cases("bottom"), _COUNTING), pr.COUNT_BOTTOM),
                       part(_identity(division.count_cases("top"), _COUNTING), pr.COUNT_TOP)),
                      label="skins of curves, each of an order of its own"),
              remark="Definition 1 gives all curves one order and lets knots differ; here there are no inner knots and "
              "the orders differ. With all rows raised to the highest degree a sub-patch is an ordinary Bezier patch, "
              "which is semi-structured (sec-1.generalisation), but no longer has the counts of the text."),
    not_checkable("fig-2.rows", "Fig. 2", "Numbers of control points in each row, as the figure shows them.",
                  "the figure is not part of the text that we have; the counts in the text are decided on their own"),
    holds("fig-3.curves", "Fig. 3", "c1, .., c4 enclose a region inside the unit square.",
          *(part(of_data(trimming.curve_cases(name), "exact corners and exact roots of all common points"), formula)
            for name, formula in figures.SIDE_CURVES.items())),
    holds("fig-3.parameters", "Fig. 3", "The arguments of the Bernstein polynomials run over [0, 1] on the intervals.",
          *(part(of_data(trimming.parameter_cases(name), _DECIMALS), formula)
            for name, formula in figures.SIDE_PARAMETERS.items()),
          *(part(of_data(trimming.interval_cases(name), _DECIMALS), formula)
            for name, formula in figures.SIDE_INTERVALS.items())),
    holds("fig-3.pieces", "Fig. 3",
          "The trimmed patch is made of four semi-structured patches and four ordinary Bezier patches, exactly.",
          part(of_data(trimming.tiling_cases, "sum of oriented boundaries, areas, lengths of exact rows"),
               figures.PIECES), _LEMMA_PART),
    holds("fig-3.first-split", "Fig. 3", "The strip between v = 0.4 and v = 0.6 contains c1, which then divides it.",
          part(of_data(trimming.first_split_cases, _DECIMALS), figures.FIRST_SPLIT)),
)  # fmt: skip
