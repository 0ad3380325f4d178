"""Conditions (1.1) to (3.2) of section 3."""

from __future__ import annotations

from functools import partial

from sympy import Eq

from papers.ledger import Claim, Correction, Formula, Part, Reading, Verdict
from papers.lin2014 import printed as pr
from papers.lin2014.consequences import measured_rows
from papers.lin2014.contact_checks import (
    row_check,
    row_counterexample,
    t_ks1,
    u_before,
    u_last,
    unconditional,
    w_kr1,
)
from papers.lin2014.objective_checks import direction_check, shape_parameter_cases
from papers.lin2014.property_checks import proved
from papers.lin2014.records import ambiguous, fails, holds_if, part

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
        "the numbering of Definition 1 instead of (13) would make it 0; see sec-3.u-numbering.",
    ),
    Claim(
        "cond-2.2",
        _WHERE,
        "Row m-1 that makes the contact with S tangent-continuous, P_u = beta^2 S_t, for every order k and k_s.",
        Verdict.HOLDS_IF,
        (Reading((Part(row_check("end", 1), pr.COND_2_2),), condition="k = 4 (the last inner knot is u_{m-k+1})"),),
        Correction("The last inner knot of U has the index m-k+1.", (Part(row_check("end", 1), TRUE_2_2),)),
        partial(row_counterexample, "end", 1, pr.COND_2_2),
        remark="For k < 4 the printed u_{m-3} is an earlier inner knot; for k > 4 it is past the inner knots, where U "
        "is 1 and row m-1 would fall on row m.",
    ),
    Claim(
        "cond-3.1",
        _WHERE,
        "Row 2 that makes the contact with R curvature-continuous, P_uu = alpha^4 R_ww, for every order k and k_r.",
        Verdict.FAILS,
        (
            Reading((Part(row_check("start", 2), pr.COND_3_1),), label="u_1 and w_{k_r} - w_s as printed"),
            Reading((Part(row_check("start", 2), pr.COND_3_1_SQUARES),), label="both squared, if the scan lost that"),
        ),
        Correction(
            "Each second difference must be one of divided differences: over u_1 and u_2 on the blend, over the first "
            "two spans of the base on R.",
            (Part(row_check("start", 2), TRUE_3_1),),
        ),
        partial(row_counterexample, "start", 2, pr.COND_3_1),
        partial(measured_rows, "start", {2: pr.COND_3_1}, _SECOND_ORDER_TEXT),
        remark="The blend gets the base's second derivative along the normal times (w_{k_r+1} - w_s) / u_2. It happens "
        "to hold where u_1 = u_2 = w_{k_r} - w_s = w_{k_r+1} - w_s, for instance between Bezier "
        "surfaces over [0, 1]; but (13) asks for m >= k+1, so that U has inner knots and u_1 < u_2 unless they "
        "coincide. With the paper's uniform u_i, u_2 = 2 u_1, and it never holds.",
    ),
    Claim(
        "cond-3.2",
        _WHERE,
        "Row m-2 that makes the contact with S curvature-continuous, P_uu = beta^4 S_tt, for every order k and k_s.",
        Verdict.FAILS,
        (
            Reading((Part(row_check("end", 2), pr.COND_3_2),), label="1 - u_{m-3} and t_{k_s} - t_s as printed"),
            Reading((Part(row_check("end", 2), pr.COND_3_2_SQUARES),), label="both squared, if the scan lost that"),
        ),
        Correction(
            "As for (3.1), with the distances of the last two inner knots of U from 1.",
            (Part(row_check("end", 2), TRUE_3_2),),
        ),
        partial(row_counterexample, "end", 2, pr.COND_3_2),
        partial(measured_rows, "end", {2: pr.COND_3_2}, _SECOND_ORDER_TEXT),
        remark="Two errors in one formula: that of (3.1), and for k other than 4 the index of (2.2).",
    ),
    holds_if("sec-3.sufficient-g1", _WHERE, "For all alpha, beta, (1.1), (1.2), (2.1), (2.2) suffice for G1.",
             "k = 4 (as (2.2) needs), alpha and beta are not zero, and the bases are regular along their contacts",
             part(unconditional(row_check("start", 0)), pr.COND_1_1),
             part(unconditional(row_check("end", 0)), pr.COND_1_2),
             part(unconditional(row_check("start", 1)), pr.COND_2_1),
             part(row_check("end", 1), pr.COND_2_2),
             part(proved(shape_parameter_cases,
                         "the normal of the blend for any regular base and alpha; the implicit equation of a base; for "
                         "alpha = 0 and a singular base an example is enough")),
             counterexample=partial(row_counterexample, "end", 1, pr.COND_2_2),
             remark="At alpha = 0 rows 0 and 1 of the blend coincide and it has no tangent plane at the contact; "
             "nothing in the method keeps the search away from there (see sec-4.unconstrained)."),
    fails("sec-3.sufficient-g2", _WHERE, "(1.1) to (3.2) together suffice for G2.",
          *(part(row_check("start", row), getattr(pr, f"COND_{row + 1}_1")) for row in range(3)),
          correction=Correction(
              "With (3.1) and (3.2) corrected they do, for alpha and beta not zero.",
              (Part(row_check("start", 0), pr.COND_1_1), Part(row_check("start", 1), pr.COND_2_1),
               Part(row_check("start", 2), TRUE_3_1), Part(row_check("end", 2), TRUE_3_2))),
          counterexample=partial(row_counterexample, "start", 2, pr.COND_3_1),
          consequence=partial(measured_rows, "start", {1: pr.COND_2_1, 2: pr.COND_3_1},
                              "The made pair with rows 1 and 2 as printed, the rest as in the checked G2 blend")),
    ambiguous("sec-3.parametric-c1", "Section 3, parametric continuity",
              "With alpha = beta = 1 the G1 conditions become C1 conditions.",
              Reading((part(direction_check(1), PARAMETRIC_2_1),),
                      label="in the parameters w of R and u of P as they are, P_u = R_w"),
              Reading((part(direction_check(-1), PARAMETRIC_2_1),),
                      label="with R run backwards, P_u = -R_w"),
              remark="At S the parameters run the same way and P_u = S_t."),
    fails("sec-3.parametric-c2", "Section 3, parametric continuity",
          "With alpha = beta = 1 the G2 conditions become C2 conditions.",
          part(row_check("start", 2, parametric=True), PARAMETRIC_3_1),
          correction=Correction("With (3.1) corrected they do.",
                                (Part(row_check("start", 2, parametric=True), TRUE_PARAMETRIC_3_1),)),
          counterexample=partial(row_counterexample, "start", 2, PARAMETRIC_3_1, parametric=True),
          consequence=partial(measured_rows, "start", {2: pr.COND_3_1}, "The made pair's C2 blend, row 2 as printed",
                              "C2")),
)  # fmt: skip
