"""Conditions (1.1) to (3.2) of section 3."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from sympy import Eq

from semispline.papers.ledger import (
    Case,
    Claim,
    Correction,
    Counterexample,
    Formula,
    Part,
    Reading,
    Verdict,
    ambiguous,
    holds_if,
    part,
    proved,
    unconditional,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_counterexamples import row_counterexample
from semispline.papers.lin2014.checks.contact_rows import (
    ROWS,
    Side,
    row_check,
    t_ks1,
    tangent_check,
    u_before,
    u_last,
    w_kr1,
)
from semispline.papers.lin2014.checks.geometric_continuity import shape_parameter_cases, special_contact_cases
from semispline.papers.lin2014.checks.measured_rows import measured_rows, rewritten_base
from semispline.papers.lin2014.checks.objective import direction_check
from semispline.papers.lin2014.checks.one_surface import one_surface_check, one_surface_counterexample
from semispline.papers.lin2014.checks.rows_along_normal import (
    EXCESS_3_1,
    EXCESS_3_1_SQUARES,
    EXCESS_3_2,
    EXCESS_3_2_SQUARES,
    along_normal,
    excess_check,
    normal_counterexample,
)

_START_CHAINS = (*pr.COND_3_1.neighbours, (pr.w_kr, w_kr1))
_END_CHAINS = (*pr.COND_3_2.neighbours, (pr.t_ks, t_ks1), (u_last, u_before))

TRUE_2_2 = Formula(
    Eq(
        pr.P_m1,
        pr.beta**2 * (1 - u_last) * (pr.k_s - 1) / ((pr.t_ks - pr.t_s) * (pr.k - 1)) * (pr.S_0 - pr.S_1) + pr.P_m,
    ),
    (pr.P_m, pr.P_m1, pr.S_0, pr.S_1, pr.beta, u_last, pr.t_ks, pr.t_s, pr.k, pr.k_s),
    (u_last > 0, u_last < 1, pr.t_ks > pr.t_s, pr.k >= 2, pr.k_s >= 2),
    _END_CHAINS,
)
TRUE_3_1 = Formula(
    Eq(
        pr.P_2,
        pr.P_1
        + pr.u_2 / pr.u_1 * (pr.P_1 - pr.P_0)
        + pr.alpha**4
        * (pr.u_1 * pr.u_2 * (pr.k_r - 1) * (pr.k_r - 2))
        / ((pr.w_kr - pr.w_s) * (pr.k - 1) * (pr.k - 2))
        * ((pr.R_2 - pr.R_1) / (w_kr1 - pr.w_s) - (pr.R_1 - pr.R_0) / (pr.w_kr - pr.w_s)),
    ),
    (*pr.COND_3_1.variables, pr.u_2, w_kr1),
    (*pr.COND_3_1.assumptions, pr.u_2 >= pr.u_1, w_kr1 >= pr.w_kr),
    _START_CHAINS,
)
TRUE_3_2 = Formula(
    Eq(
        pr.P_m2,
        pr.P_m1
        + (1 - u_before) / (1 - u_last) * (pr.P_m1 - pr.P_m)
        + pr.beta**4
        * ((1 - u_last) * (1 - u_before) * (pr.k_s - 1) * (pr.k_s - 2))
        / ((pr.t_ks - pr.t_s) * (pr.k - 1) * (pr.k - 2))
        * ((pr.S_2 - pr.S_1) / (t_ks1 - pr.t_s) - (pr.S_1 - pr.S_0) / (pr.t_ks - pr.t_s)),
    ),
    (
        *(pr.P_m, pr.P_m1, pr.P_m2, pr.S_0, pr.S_1, pr.S_2),
        *(pr.beta, u_last, u_before, pr.t_ks, t_ks1, pr.t_s, pr.k, pr.k_s),
    ),
    (u_before > 0, u_before <= u_last, u_last < 1, pr.t_ks > pr.t_s, t_ks1 >= pr.t_ks, pr.k >= 3, pr.k_s >= 2),
    _END_CHAINS,
)

# The conditions with alpha = beta = 1, printed and true.
PARAMETRIC_2_1 = Formula(
    pr.COND_2_1.relation.subs(pr.alpha, 1),
    tuple(x for x in pr.COND_2_1.variables if x != pr.alpha),
    pr.COND_2_1.assumptions,
    pr.COND_2_1.neighbours,
)
PARAMETRIC_3_1 = Formula(
    pr.COND_3_1.relation.subs(pr.alpha, 1),
    tuple(x for x in pr.COND_3_1.variables if x != pr.alpha),
    pr.COND_3_1.assumptions,
    pr.COND_3_1.neighbours,
)
PARAMETRIC_3_1_SQUARES = replace(PARAMETRIC_3_1, relation=pr.COND_3_1_SQUARES.relation.subs(pr.alpha, 1))
TRUE_PARAMETRIC_3_1 = Formula(
    TRUE_3_1.relation.subs(pr.alpha, 1),
    tuple(x for x in TRUE_3_1.variables if x != pr.alpha),
    TRUE_3_1.assumptions,
    TRUE_3_1.neighbours,
)

_WHERE = "Section 3, continuity conditions"
_SECOND_ORDER_TEXT = (
    "The made pair (bicubic, non-uniform knots, one middle curve) with the third row set as printed, "
    "everything else as in the checked G2 blend"
)

# What the scan shows of signs and indices, said wherever it matters.
_MINUS = (
    "The scan has lost minus signs in (2.1) to (3.2), as in (w_{k_r} - w_s), (1 - u_{m-3}) and R_0j - R_1j; they are "
    "supplied where no other sign gives a knot distance or a difference."
)
_MISREAD = (
    "u_{m-3} may be a misread u_{m-k+1}, the last inner knot, which is the same for k = 4; then the index is right."
)


def _normal_part(side: Side, formula: Formula) -> Part:
    return Part(row_check(side, 2, "normal"), along_normal(formula, side))


_FIRST_TWO_ROWS = (
    Part(row_check("start", 0), pr.COND_1_1),
    Part(row_check("end", 0), pr.COND_1_2),
    Part(row_check("start", 1), pr.COND_2_1),
)
_PRINTED_FIRST_ROWS = (*_FIRST_TWO_ROWS, part(row_check("end", 1), pr.COND_2_2))


def _no_g2() -> Counterexample | None:
    """Return a base that (3.1) does not join with G2, in either reading, and beside it one for (2.2) and k = 5."""
    found = normal_counterexample("start", (pr.COND_3_1, pr.COND_3_1_SQUARES))
    tangent = row_counterexample("end", 1, pr.COND_2_2, least_order=5)
    return found and replace(found, also=f"by (2.2), row m-1 at {tangent}")


def all_rows(*parts: Part) -> tuple[Part, ...]:
    """Return parts, and one more that finds all six rows next to the contacts set by the formulas of these."""
    cases = partial(set_rows_cases, tuple(p.formula for p in parts))
    return (*parts, Part(proved(cases, "left sides of the formulas, all six rows next to the contacts")))


def set_rows_cases(formulas: tuple[Formula | None, ...]) -> Iterator[Case]:
    """Yield the six rows next to the contacts: each one is set by one formula."""
    left = [formula.relation.lhs for formula in formulas if formula is not None]
    for row in ROWS["start"] + ROWS["end"]:
        yield Case(f"{row} is set", left.count(row) == 1)


CLAIMS = (
    Claim(
        "cond-1.1",
        _WHERE,
        "The first v-control curve has the control points of the contact curve on R; then the surfaces touch (G0).",
        Verdict.HOLDS,
        (Reading((Part(row_check("start", 0), pr.COND_1_1),)),),
    ),
    Claim(
        "cond-1.2",
        _WHERE,
        "The last v-control curve has the control points of the contact curve on S; then the surfaces touch (G0).",
        Verdict.HOLDS,
        (Reading((Part(row_check("end", 0), pr.COND_1_2),)),),
    ),
    Claim(
        "cond-2.1",
        _WHERE,
        "Row 1 that makes the contact with R tangent-continuous, P_u = -alpha^2 R_w, for every order k and k_r.",
        Verdict.HOLDS,
        (Reading((Part(row_check("start", 1), pr.COND_2_1),)),),
        remark="The sign is that of a blend which leaves the base backwards: right here, wrong in (17). Reading u_1 by "
        "the numbering of Definition 1 instead of (13) would make it 0; see sec-3.u-numbering. " + _MINUS,
    ),
    Claim(
        "cond-2.2",
        _WHERE,
        "Row m-1 that makes the contact with S tangent-continuous, P_u = beta^2 S_t, for every order k and k_s.",
        Verdict.HOLDS_IF,
        (Reading((Part(row_check("end", 1), pr.COND_2_2),), condition="k = 4 (the last inner knot is u_{m-k+1})"),),
        Correction("The last inner knot of U has the index m-k+1.", (Part(row_check("end", 1), TRUE_2_2),)),
        partial(row_counterexample, "end", 1, pr.COND_2_2),
        cause="indices-for-cubics",
        remark="For k < 4 the printed u_{m-3} is an earlier inner knot; for k > 4 it is past the inner knots, where U "
        "is 1 and row m-1 would fall on row m. " + _MISREAD + " " + _MINUS,
    ),
    Claim(
        "cond-3.1",
        _WHERE,
        "Row 2 that makes the contact with R curvature-continuous (G2) after (1.1) and (2.1), for every order k and "
        "k_r, all knots and regular bases.",
        Verdict.FAILS,
        (
            Reading((_normal_part("start", pr.COND_3_1),), label="u_1 and w_{k_r} - w_s as printed"),
            Reading((_normal_part("start", pr.COND_3_1_SQUARES),), label="both squared, if the scan lost that"),
        ),
        Correction(
            "Each second difference must be one of divided differences: over u_1 and u_2 on the blend, over the first "
            "two spans of the base on R. Along the normal the printed row, and the squared one, miss alpha^4 R_ww by "
            "what the other two formulas say.",
            (
                Part(row_check("start", 2), TRUE_3_1),
                Part(excess_check("start", pr.COND_3_1), EXCESS_3_1),
                Part(excess_check("start", pr.COND_3_1_SQUARES), EXCESS_3_1_SQUARES),
            ),
        ),
        partial(normal_counterexample, "start", (pr.COND_3_1, pr.COND_3_1_SQUARES)),
        partial(measured_rows, "start", {2: pr.COND_3_1}, _SECOND_ORDER_TEXT),
        cause="second-derivative",
        remark="Not even a condition on the surfaces: it depends on the units of w, and with squares on knots inserted "
        "into the base (sec-3.one-surface). G2 leaves the part of P_uu within the tangent plane free, by (16), so the "
        "part along the normal alone is judged. As printed it is that of the base times (w_{k_r+1} - w_s) / u_2: "
        "right for every base exactly where w_{k_r+1} - w_s = u_2. With squares it is right exactly where "
        "(w_{k_r} - w_s) / (w_{k_r+1} - w_s) = u_1 / u_2: with the paper's uniform u_i, where the first two spans of "
        "the base across the contact have one length. Either reading is right, too, where R_ww has no part along the "
        "normal, as for k_r = 2 or a base that is straight across. Why both fail: W is given, the paper asks neither "
        "equation of it, and in its own setting a base with inner knots across may meet neither: with w_{k_r} - w_s "
        "= 1, w_{k_r+1} - w_s = 3 and uniform u_i the blend has 3 / u_2 times, with squares 3/2 times, what the base "
        "has along the normal. "
        + _MINUS,
    ),
    Claim(
        "cond-3.2",
        _WHERE,
        "Row m-2 that makes the contact with S curvature-continuous (G2) after (1.2) and a right row m-1, for every "
        "order k and k_s, all knots and regular bases.",
        Verdict.FAILS,
        (
            Reading((_normal_part("end", pr.COND_3_2),), label="1 - u_{m-3} and t_{k_s} - t_s as printed"),
            Reading((_normal_part("end", pr.COND_3_2_SQUARES),), label="both squared, if the scan lost that"),
        ),
        Correction(
            "As for (3.1), with the distances of the last two inner knots of U from 1.",
            (
                Part(row_check("end", 2), TRUE_3_2),
                Part(excess_check("end", pr.COND_3_2), EXCESS_3_2),
                Part(excess_check("end", pr.COND_3_2_SQUARES), EXCESS_3_2_SQUARES),
            ),
        ),
        partial(normal_counterexample, "end", (pr.COND_3_2, pr.COND_3_2_SQUARES)),
        partial(measured_rows, "end", {2: pr.COND_3_2}, _SECOND_ORDER_TEXT),
        cause="second-derivative",
        remark="Two errors in one formula: that of (3.1), and for k other than 4 the index of (2.2). For k = 4 it is "
        "right for every base exactly where t_{k_s+1} - t_s = 1 - u_{m-k}; with squares exactly where (t_{k_s} - "
        "t_s) / (t_{k_s+1} - t_s) = (1 - u_{m-k+1}) / (1 - u_{m-k}), with uniform u_i where the first two spans "
        "of S have one length. Why both fail: see cond-3.1. "
        + _MISREAD
        + " "
        + _MINUS,
    ),
    holds_if("sec-3.sufficient-g1", _WHERE, "For all alpha, beta, (1.1), (1.2), (2.1), (2.2) suffice for G1.",
             "k is at most 4, alpha and beta are not zero, and the bases are regular along their contacts",
             part(unconditional(row_check("start", 0)), pr.COND_1_1),
             part(unconditional(row_check("end", 0)), pr.COND_1_2),
             part(unconditional(row_check("start", 1)), pr.COND_2_1),
             part(tangent_check(), pr.COND_2_2),
             part(proved(partial(shape_parameter_cases, 1),
                         "tangent planes for any regular base and alpha; the implicit equation of a base; for "
                         "alpha = 0 and a singular base an example is enough")),
             counterexample=partial(row_counterexample, "end", 1, pr.COND_2_2, least_order=5),
             cause="indices-for-cubics",
             remark="For k > 4 (2.2) puts row m-1 on row m, so that P_u = 0 at S; for k < 4 P_u is a multiple of S_t, "
             "by another factor than beta^2. At alpha = 0 rows 0 and 1 of the blend are one, and P_u = 0: it leaves "
             "the base at an angle, in general; nothing in the method keeps the search away from there (see "
             "sec-4.unconstrained)."),
    Claim("sec-3.one-surface", _WHERE,
          "(3.1) is a condition on two surfaces: it gives one row 2, up to the tangent plane, however the base is "
          "written.", Verdict.FAILS,
          (Reading((part(one_surface_check(flat=True), along_normal(pr.COND_3_1, "start")),),
                   label="u_1 and w_{k_r} - w_s as printed"),
           Reading((part(one_surface_check(flat=True), along_normal(pr.COND_3_1_SQUARES, "start")),),
                   label="both squared, if the scan lost that"),
           Reading((part(one_surface_check(flat=True, any_powers=True),
                         along_normal(pr.COND_3_1_ANY_POWERS, "start")),),
                   label="any powers of u_1 and w_{k_r} - w_s, if the scan lost others")),
          correction=Correction("With each second difference one of divided differences it does.",
                                (Part(one_surface_check(flat=False), TRUE_3_1),)),
          counterexample=one_surface_counterexample,
          consequence=partial(rewritten_base, {1: pr.COND_2_1, 2: pr.COND_3_1}),
          cause="second-derivative",
          remark="From the text alone, in three lines. Count w in units in which it is c times as large: R, as a "
          "surface, and by (2.1) row 1 stay if alpha^2 is c times as large too; row 2 by (3.1) then moves by c - 1 "
          "times its part in R_0 - 2 R_1 + R_2, since alpha^4 is c^2 times as large and w_{k_r} - w_s just c times; "
          "but rows 0 and 1 and the surface R fix what G2 asks of row 2 along the normal. Squares, if the scan lost "
          "them, pass this. They do not pass a knot inserted into the first span across, which leaves R as it is too, "
          "as the paper says of knot insertion: w_{k_r} - w_s becomes smaller, and row 2 moves. Nor do other powers "
          "pass a knot inserted into the second span, at w_s + y: w_{k_r} and R_1 stay, R_2 - R_1 becomes "
          "y / (w_{k_r+1} - w_s) times as large, and row 2 moves by what the printed factor makes of that: a "
          "right formula has to know w_{k_r+1}."),
    Claim("sec-3.sufficient-g2", _WHERE, "(1.1) to (3.2) together suffice for G2.", Verdict.FAILS,
          (Reading((*_PRINTED_FIRST_ROWS, _normal_part("start", pr.COND_3_1), _normal_part("end", pr.COND_3_2)),
                   label="all six as they are printed"),
           Reading((*_PRINTED_FIRST_ROWS, _normal_part("start", pr.COND_3_1_SQUARES),
                    _normal_part("end", pr.COND_3_2_SQUARES)),
                   label="(3.1) and (3.2) with both distances squared, if the scan lost that")),
          correction=Correction(
              "For regular bases, alpha and beta not zero: (1.1), (1.2), (2.1), with (2.2), (3.1) and (3.2) corrected.",
              (*all_rows(*_FIRST_TWO_ROWS, Part(row_check("end", 1), TRUE_2_2),
                         Part(row_check("start", 2), TRUE_3_1), Part(row_check("end", 2), TRUE_3_2)),
               part(proved(partial(special_contact_cases, 2),
                           "second fundamental forms for any regular base, alpha not zero")))),
          counterexample=_no_g2,
          consequence=partial(measured_rows, "start", {1: pr.COND_2_1, 2: pr.COND_3_1},
                              "The made pair with rows 1 and 2 as printed, the rest as in the checked G2 blend"),
          cause="second-derivative",
          remark="Three of the six fail, each alone: (3.1), and (3.2) likewise, as printed and with squares, and "
          "(2.2) for k other than 4; for k > 4 it puts row m-1 on row m, so that P_u = 0 at S. When they "
          "suffice: k = 4 for (2.2), and what cond-3.1 and cond-3.2 say for (3.1) and (3.2)."),
    ambiguous("sec-3.parametric-c1", "Section 3, parametric continuity",
              "With alpha = beta = 1 the G1 conditions become C1 conditions.",
              Reading((part(direction_check(1), PARAMETRIC_2_1),),
                      label="in the parameters w of R and u of P as they are, P_u = R_w"),
              Reading((part(direction_check(-1), PARAMETRIC_2_1),),
                      label="with R run backwards, P_u = -R_w"),
              cause="sign-of-p1",
              remark="At S the parameters run the same way and P_u = S_t."),
    Claim("sec-3.parametric-c2", "Section 3, parametric continuity",
          "With alpha = beta = 1 the G2 conditions become C2 conditions.", Verdict.FAILS,
          (Reading((part(row_check("start", 2, "parametric"), PARAMETRIC_3_1),), label="(3.1) as printed"),
           Reading((part(row_check("start", 2, "parametric"), PARAMETRIC_3_1_SQUARES),),
                   label="(3.1) with both distances squared, if the scan lost that")),
          correction=Correction("With (3.1) corrected they do.",
                                (Part(row_check("start", 2, "parametric"), TRUE_PARAMETRIC_3_1),)),
          counterexample=partial(row_counterexample, "start", 2, PARAMETRIC_3_1, PARAMETRIC_3_1_SQUARES,
                                 parametric=True),
          consequence=partial(measured_rows, "start", {2: pr.COND_3_1}, "The made pair's C2 blend, row 2 as printed",
                              "C2"),
          cause="second-derivative",
          remark="With squares it fails too where they give G2, on a base whose first two spans across have one "
          "length: in the direction of R_w."),
)  # fmt: skip
