"""The appendix: equations (15) to (18) and the end derivatives."""

from __future__ import annotations

from functools import partial

from sympy import Eq

from semispline.papers.ledger import (
    Check,
    Claim,
    Correction,
    Formula,
    Part,
    Reading,
    Strength,
    Verdict,
    ambiguous,
    fails,
    holds,
    holds_if,
    part,
    proved,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import special_choice as special
from semispline.papers.lin2014.checks.contact_counterexamples import derivative_counterexample, row_counterexample
from semispline.papers.lin2014.checks.contact_rows import derivative_check, mirror_check, w_kr1
from semispline.papers.lin2014.checks.geometric_continuity import (
    derived_row_cases,
    derived_row_probe,
    general_check,
    join_cases,
    special_check,
    special_contact_cases,
    special_counterexample,
    substitution_cases,
    tangent_plane_cases,
)
from semispline.papers.lin2014.checks.measured_rows import measured_rows

_CHAINS = (*pr.COND_3_1.neighbours, (pr.w_kr, w_kr1))

TRUE_17 = Formula(Eq(pr.P_u, -(pr.alpha**2) * pr.R_w), pr.EQ_17.variables, (), pr.EQ_17.neighbours)
# What (17) makes of row 1, with the end derivatives of the appendix: (2.1) with the opposite sign.
ROW_1_BY_17 = Formula(
    Eq(pr.P_1, pr.alpha**2 * pr.u_1 * (pr.k_r - 1) / ((pr.w_kr - pr.w_s) * (pr.k - 1)) * (pr.R_1 - pr.R_0) + pr.P_0),
    pr.COND_2_1.variables,
    pr.COND_2_1.assumptions,
    pr.COND_2_1.neighbours,
)
TRUE_D2_P = Formula(
    Eq(
        pr.P_uu,
        (pr.k - 1) * (pr.k - 2) / pr.u_1 * ((pr.P_2 - pr.P_1) / pr.u_2 - (pr.P_1 - pr.P_0) / pr.u_1),
    ),
    (pr.P_uu, pr.P_0, pr.P_1, pr.P_2, pr.u_1, pr.u_2, pr.k),
    (pr.u_1 > 0, pr.u_2 >= pr.u_1, pr.k >= 2),
    _CHAINS,
)
TRUE_D2_R = Formula(
    Eq(
        pr.R_ww,
        (pr.k_r - 1)
        * (pr.k_r - 2)
        / (pr.w_kr - pr.w_s)
        * ((pr.R_2 - pr.R_1) / (w_kr1 - pr.w_s) - (pr.R_1 - pr.R_0) / (pr.w_kr - pr.w_s)),
    ),
    (pr.R_ww, pr.R_0, pr.R_1, pr.R_2, pr.w_kr, w_kr1, pr.w_s, pr.k_r),
    (pr.w_kr > pr.w_s, w_kr1 >= pr.w_kr, pr.k_r >= 2),
    _CHAINS,
)

_REGULAR = "R is regular along the contact and p_1 has no zero (and p_1 < 0, if the join shall not fold back)"
_WHERE = "Appendix"


_TANGENT_PLANES = Check(
    tangent_plane_cases,
    Strength.GENERAL,
    "(15) with p_1 = alpha^2; tangent planes for any regular base; for alpha = 0 and a singular base an example is "
    "enough",
    proof=True,
)
_JOIN = Check(
    join_cases,
    Strength.GENERAL,
    "on which side of the contact P_u points, any base and p_1, q_1; where a blend of a bent base lies",
    proof=True,
)


def _derived(order: int) -> Check:
    cases, probe = partial(derived_row_cases, order), partial(derived_row_probe, order)
    return Check(cases, Strength.GENERAL, "solving for the row", proof=True, probe=probe)


CLAIMS = (
    Claim(
        "eq-15",
        _WHERE,
        "Two surfaces with a common curve have one tangent plane along it exactly if P_u = p_1 R_w + q_1 R_v for some "
        "functions p_1, q_1 of v.",
        Verdict.HOLDS_IF,
        (Reading((Part(general_check(1), pr.EQ_15),), condition=_REGULAR),),
        remark="Where p_1 vanishes P_u and P_v are parallel and give P no tangent plane, although the equation holds; "
        "where R_w vanishes smooth continuations exist that satisfy no such equation. The equation does not see the "
        "sign of p_1: a fold (p_1 > 0 when both surfaces lie on the positive side of their parameters) satisfies it "
        "too, as tangent planes alone are compared; eq-17 is decided both ways.",
    ),
    Claim(
        "eq-16",
        _WHERE,
        "In addition to (15), curvatures agree exactly if P_uu = p_2 R_w + q_2 R_v + p_1^2 R_ww + 2 p_1 q_1 R_wv + "
        "q_1^2 R_vv for some functions p_2, q_2 of v.",
        Verdict.HOLDS_IF,
        (Reading((Part(general_check(2), pr.EQ_16),), condition=_REGULAR),),
        remark="No term is missing: mixed derivatives of P need no condition, they follow from (15), differentiated "
        "along v.",
    ),
    Claim(
        "eq-17",
        _WHERE,
        "With p_1 = alpha^2 the surfaces are joined by P_u = +alpha^2 R_w at u = 0, w = w_s.",
        Verdict.AMBIGUOUS,
        (
            Reading(
                (Part(_TANGENT_PLANES, pr.EQ_17),),
                label="one tangent plane along the contact, which is all that (15) asks",
                condition="alpha is not zero and R is regular along the contact",
            ),
            Reading((Part(_JOIN, pr.EQ_17),), label="a blend that goes on from R on the other side of the contact"),
        ),
        Correction("The blend leaves R backwards, as (2.1) does: p_1 = -alpha^2.", (Part(_JOIN, TRUE_17),)),
        partial(special_counterexample, 1, pr.EQ_17),
        partial(
            measured_rows,
            "start",
            {1: ROW_1_BY_17},
            "The made pair with row 1 by (17) and the first derivatives of the appendix",
        ),
        cause="sign-of-p1",
        remark="By (15) alone nothing is wrong: tangent planes do not see the sign. But the paper contradicts itself: "
        "(2.1), said to follow from (17), has the opposite sign, the right one (sec-A.17-gives-2.1). R lies on "
        "w >= w_s and P on u >= 0: with the sign of (17) the blend runs back over the base, a fold. Open CASCADE "
        "compares tangent planes and curvatures with normals up to sign: it does not see a fold, so that its verdict "
        "stands beside a normal that turns by 180 degrees. The scan loses minus signs elsewhere, in (2.1) to (3.2). "
        "Here it would have to lose one in (17) and another in p_1 = alpha^2, which agree as they stand; with both, "
        "the formula is the corrected one.",
    ),
    Claim(
        "eq-18",
        _WHERE,
        "The second derivatives then satisfy P_uu = alpha^4 R_ww at u = 0, w = w_s.",
        Verdict.HOLDS,
        (Reading((Part(special_check(2), pr.EQ_18),)),),
        remark="p_1 enters squared, so that the sign of (17) does not matter.",
    ),
    Claim(
        "app-d1",
        _WHERE,
        "First derivatives at the clamped end: (k-1)/u_1 times the first difference of rows of P, "
        "(k_r-1)/(w_{k_r}-w_s) times that of R.",
        Verdict.HOLDS,
        (Reading((Part(derivative_check("P", 1), pr.APP_D1_P), Part(derivative_check("R", 1), pr.APP_D1_R))),),
    ),
    Claim(
        "app-d2",
        _WHERE,
        "Second derivatives at the clamped end: (k-1)(k-2)/u_1 times the plain second difference of rows of P, "
        "(k_r-1)(k_r-2)/(w_{k_r}-w_s) times that of R.",
        Verdict.FAILS,
        (
            Reading(
                (Part(derivative_check("P", 2), pr.APP_D2_P), Part(derivative_check("R", 2), pr.APP_D2_R)),
                label="denominators as printed",
            ),
            Reading(
                (
                    Part(derivative_check("P", 2), pr.APP_D2_P_SQUARES),
                    Part(derivative_check("R", 2), pr.APP_D2_R_SQUARES),
                ),
                label="squared denominators, if the scan lost the squares",
            ),
        ),
        Correction(
            "Second derivatives are differences of first ones, each over its own span: u_1 for P_1 - P_0, u_2 for "
            "P_2 - P_1, and once more u_1; the same for R.",
            (Part(derivative_check("P", 2), TRUE_D2_P), Part(derivative_check("R", 2), TRUE_D2_R)),
        ),
        partial(derivative_counterexample, "P", 2, pr.APP_D2_P),
        partial(
            measured_rows,
            "start",
            {2: pr.COND_3_1},
            "The made pair with row 2 by (3.1), which is (18) with these derivatives",
        ),
        cause="second-derivative",
        remark="Right for order 2, where both sides vanish, and where u_1 = u_2 = 1, as without inner knots over "
        "[0, 1]. With squares it holds where u_1 = u_2, that is where the first inner knot is double or there is none.",
    ),
    ambiguous("sec-A.special-choice", _WHERE,
              "(15) and (16) come to (17) and (18), with p_1 = -alpha^2, alpha constant and q_1 = p_2 = q_2 = 0.",
              Reading((part(proved(partial(special_contact_cases, 2), "tangent planes and second fundamental forms for "
                                   "any regular base, alpha not zero")),),
                      label="one choice that suffices"),
              Reading((part(proved(special.only_special_cases, "blends with contact of order 2, judged by the implicit "
                                   "equation of the base: one counterexample is enough", Strength.RATIONAL)),),
                      label="all that they allow"),
              consequence=special.special_choice_cost,
              remark="The paper calls its conditions sufficient, and says no more. What the choice leaves out: a p_1 "
              "that varies along the contact, where alpha, beta are two numbers, and functions p_2, q_2, which move "
              "row 2 along R_w and R_v; q_1 is not free where cubic bases have inner knots along the contact, since "
              "P_uu then holds R_vv, which has kinks there. Numbers alone, or alpha^2 and beta^2 linear in v, save "
              "little of (11); functions save up to a fifth, for rows of higher degree with more knots."),
    holds("sec-A.substitution", _WHERE, "p_1 = alpha^2, q_1 = p_2 = q_2 = 0 turn (15), (16) into (17), (18).",
          part(Check(partial(substitution_cases, 1), Strength.GENERAL, "substitution", proof=True), pr.EQ_17),
          part(Check(partial(substitution_cases, 2), Strength.GENERAL, "substitution", proof=True), pr.EQ_18),
          remark="The algebra is right; the choice of p_1, unless a minus is lost in it and in (17), is not: see "
          "eq-17."),
    fails("sec-A.17-gives-2.1", _WHERE, "(17) and the first end derivatives give (2.1).",
          part(_derived(1), pr.COND_2_1),
          correction=Correction("They give (2.1) with the opposite sign of alpha^2; p_1 = -alpha^2 gives (2.1).",
                                (Part(_derived(1), ROW_1_BY_17), Part(special_check(1), TRUE_17))),
          counterexample=partial(row_counterexample, "start", 1, ROW_1_BY_17),
          consequence=partial(measured_rows, "start", {1: ROW_1_BY_17},
                              "The made pair with the row that (17) gives"),
          cause="sign-of-p1",
          remark="With a minus in (17), which the scan may have lost there and in p_1 = alpha^2, they do: that is the "
          "correction. As printed a fold, as for eq-17: Open CASCADE compares normals up to sign and does not see it; "
          "the normal, followed across the contact, turns by 180 degrees."),
    holds("sec-A.18-gives-3.1", _WHERE, "(18) and the second end derivatives, as printed, give (3.1).",
          part(_derived(2), pr.COND_3_1),
          remark="The step is right; its premise app-d2 is not, and so (3.1) is wrong."),
    holds_if("sec-A.similarly", _WHERE, "(1.2), (2.2), (3.2) follow like the others, at the other end.", "k = 4",
             *(part(mirror_check(row), formula) for row, formula in enumerate((pr.COND_1_2, pr.COND_2_2, pr.COND_3_2))),
             cause="indices-for-cubics",
             remark="The last inner knot is u_{m-k+1}; u_{m-3} is that one for k = 4 only. The error of (3.1) is "
             "mirrored too."),
)  # fmt: skip
