"""Section 4: the linear system (14), solvability, degrees, the search for alpha and beta."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import sympy as sp
from sympy import Eq

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.ledger import (
    Case,
    Check,
    Claim,
    Correction,
    Counterexample,
    Formula,
    Meaning,
    Part,
    Reading,
    Strength,
    ambiguous,
    difference_case,
    fails,
    given,
    holds,
    holds_if,
    indexed,
    not_checkable,
    part,
    proved,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import construction, energy, objective
from semispline.papers.lin2014.checks import facing_bases as facing
from semispline.papers.lin2014.checks.contact_counterexamples import row_counterexample
from semispline.papers.lin2014.checks.contact_rows import BASE_ROWS, ROWS, Side, knots_as_spans, row_check
from semispline.papers.lin2014.checks.measured_energy import single_integrals, third_term, vector_lengths, zero_system
from semispline.papers.lin2014.claims.section_3_conditions import (
    PARAMETRIC_2_1,
    PARAMETRIC_3_1,
    PARAMETRIC_3_1_SQUARES,
    TRUE_2_2,
    TRUE_3_1,
    TRUE_3_2,
)

_WHERE = "Section 4"
_GRAM = objective.GRAM_CHECK

TRUE_14 = Formula(
    Eq(pr.K, pr.A_2 * pr.G_0 + 2 * pr.A_1 * pr.G_1 + pr.A_0 * pr.G_2),
    (pr.K, pr.A_0, pr.A_1, pr.A_2, pr.G_0, pr.G_1, pr.G_2),
)
TRUE_CVV = (Formula(Eq(pr.last, pr.N(3)), (pr.last,)), Formula(Eq(pr.last, pr.N(pr.m - 3)), (pr.last, pr.m)))
_TRUE_GRAM = Correction(
    "Each entry of A and B is a sum of integrals of products: those of two u-functions times those of two v-functions, "
    "both differentiated alike, A_2 G_0 + 2 A_1 G_1 + A_0 G_2.",
    (Part(_GRAM, TRUE_14),),
)


def _gram_counterexample(formula: Formula) -> Callable[[], Counterexample | None]:
    """Return a search over pairs of control points of the free curve, in ascending order."""

    def search() -> Counterexample | None:
        for case in energy.gram_entry_cases(formula):
            if not case.true:
                label = case.label.removeprefix("control points ")
                true = next(iter(_true_entry(label)))
                values = (("U", "0, 1/4, 1/2, 3/4, 1"), ("V_3", "5/12 inside"), ("entry", label))
                return Counterexample(values, str(true + case.residual), str(true))
        return None

    return search


def _true_entry(label: str) -> Iterator[sp.Rational]:
    for case in energy.gram_entry_cases(Formula(Eq(pr.K, 0, evaluate=False), (pr.K,))):
        if case.label.endswith(label):
            yield -case.residual


def _no_middle_cases() -> Iterator[Case]:
    """Yield m = 5: contact of order 2 at both ends sets all six rows; the end derivatives determine each of them."""
    at_start, at_end = construction.set_rows(2)
    between = (at_end - at_start - 1).subs(pr.m, 5)
    yield Case("no row between those that R and S set, for every order and knots", between == 0)
    matrix = construction.contact_matrix(4, 5, 2)
    yield Case("k = 4: the six conditions have one solution", matrix.rows == matrix.cols == matrix.rank())


def _cvv_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the last index of rows 3 and m-3 in C_vv, for rows of different lengths."""
    formula = given(formula)
    # In (1) the inner sum of row i ends with j = n_i.
    inner = pr.EQ_1.relation.rhs.atoms(sp.Sum) - {pr.EQ_1.relation.rhs}
    ends = [total.limits[0][2] for total in inner]
    row = pr.m - 3 if formula.relation.rhs.has(pr.m) else sp.Integer(3)
    residual = formula.relation.rhs - ends[0].subs(pr.i, row)
    yield Case(f"rows of any lengths, row {row}", bool(residual == 0), residual=residual)
    # All lengths differ, so that no two indices are confused.
    for m, sizes in ((6, (4, 5, 6, 7, 8, 9, 10)), (7, (4, 5, 6, 7, 8, 9, 10, 11))):
        row = m - 3 if formula.relation.rhs.has(pr.m) else 3
        last = indexed("n", {(r,): size - 1 for r, size in enumerate(sizes)})
        meaning = Meaning({pr.last: sizes[row] - 1, pr.m: m}, {"n": last})
        yield difference_case(formula, f"m = {m}, rows of {', '.join(map(str, sizes))} points", meaning)


def _cvv_counterexample() -> Counterexample | None:
    case = next((c for c in _cvv_cases(pr.CVV_LAST[0]) if not c.true and c.residual.is_number), None)
    if case is None:
        return None
    return Counterexample((("rows", case.label),), f"last index off by {case.residual}", "n_3")


def _initial_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide alpha = beta = 1: the rows of a C2 blend satisfy the G2 conditions with it, for every order and knots.

    The C2 rows are solved from P_u = -R_w and P_uu = R_ww; the conditions are (1.1), (2.1) as printed and (3.1)
    corrected, and those at S corrected.
    """
    shape = given(formula).relation.rhs
    h, H = span_symbols(2), span_symbols(2, "H")
    sides: dict[Side, tuple[Formula, ...]] = {
        "start": (pr.COND_1_1, pr.COND_2_1, TRUE_3_1),
        "end": (pr.COND_1_2, TRUE_2_2, TRUE_3_2),
    }
    for side, conditions in sides.items():
        base = sp.Matrix(BASE_ROWS[side])
        backwards = sp.diag(1, -1, 1) * end_derivatives(2, (pr.k_r if side == "start" else pr.k_s) - 1, H)
        rows = end_derivatives(2, pr.k - 1, h).lower_triangular_solve(backwards * base)
        values = knots_as_spans(side) | dict(zip(ROWS[side], rows, strict=True)) | {pr.alpha: shape, pr.beta: shape}
        for row, condition in enumerate(conditions):
            difference = condition.relation.rhs - condition.relation.lhs
            residual = sp.cancel(difference.subs(values, simultaneous=True))
            label = f"row {row} from the {side}, every order and knots"
            yield Case(label, bool(residual == 0), residual=residual)


# alpha = beta = 1; one of them stands for both.
SHAPE_ONE = Formula(
    Eq(pr.alpha, 1), (pr.alpha,), equivalent={"Eq(alpha, -1)": "alpha stands in the conditions by its square alone"}
)
_CVV = Check(_cvv_cases, Strength.GENERAL, "lengths of rows, of any numbers of control points", proof=True)
# Unknown rows of X, 3 .. m-3.
FIRST_UNKNOWN, LAST_UNKNOWN = Formula(Eq(pr.first, 3), (pr.first,)), Formula(Eq(pr.last, pr.m - 3), (pr.last, pr.m))
_A, _B, _X, _N = objective.A_BLOCK, objective.B_BLOCK, objective.X_FREE, objective.N_KNOWN
_COLUMN = sp.Symbol("s", integer=True)
# Row r of A X = -B N.
NORMAL_EQUATION = Formula(
    Eq(
        sp.Sum(_A[objective.ROW, _COLUMN] * _X[_COLUMN], (_COLUMN, 0, objective.LAST_FREE)),
        -sp.Sum(_B[objective.ROW, _COLUMN] * _N[_COLUMN], (_COLUMN, 0, objective.LAST_KNOWN)),
    ),
    (*(x.label for x in (_A, _B, _X, _N)), objective.ROW, objective.LAST_FREE, objective.LAST_KNOWN),
)


CLAIMS: tuple[Claim, ...] = (
    holds("sec-4.no-middle-curve", _WHERE, "Without a middle curve C2 contact determines all control points directly.",
          part(proved(_no_middle_cases, "rows set by the derived contact conditions")),
          remark="By the corrected conditions; nothing is left to minimise."),
    holds("sec-4.quadratic", _WHERE, "After the C1 or C2 conditions are put in, the objective is quadratic.",
          part(objective.degree_check(2, False), pr.DEGREE_C), part(objective.degree_check(1, False), pr.DEGREE_C)),
    holds("sec-4.normal-equation", _WHERE, "Its minimum is found by one linear system, the normal equation.",
          part(objective.NORMAL_EQUATION_CHECK, NORMAL_EQUATION), part(objective.minimum_check(2)),
          remark="The matrix is positive definite, so that there is exactly one solution."),
    holds("sec-4.c1-similarly", _WHERE, "The linear system for C1 conditions is like that for C2.",
          part(objective.NORMAL_EQUATION_CHECK, NORMAL_EQUATION), part(objective.minimum_check(1)),
          remark="Rows 2 and m-2 are unknown too."),
    holds("sec-4.unknowns", _WHERE, "X holds the rows 3, .., m-3, N the rows 0, 1, 2, m-2, m-1, m.",
          part(construction.row_check_of(lambda at_start, _: at_start + 1), FIRST_UNKNOWN),
          part(construction.row_check_of(lambda _, at_end: at_end - 1), LAST_UNKNOWN)),
    fails("eq-14", _WHERE, "A X^T = -B N^T, with A, B and a, b, c as printed, gives the least energy.",
          part(_GRAM, pr.EQ_14),
          part(proved(objective.zero_system_cases, "entries of A as printed where a_ij = c_ij = 0; its rank")),
          part(proved(objective.integrals_vanish_cases,
                      "end values of inner rows, every order and knots; integrals of B_i' and B_i'', orders 3 to 6")),
          correction=_TRUE_GRAM, counterexample=_gram_counterexample(pr.EQ_14), consequence=zero_system,
          cause="linear-system",
          remark="B_i' and B_i'' of a row away from the ends integrate to zero, so that a_ij = c_ij = 0 for every "
          "unknown control point, whatever the knots: as printed, (14) says 0 = 0."),
    fails("sec-4.single-integrals", _WHERE,
          "The energy's matrix is built from integrals of one basis product each, a_ij, b_ij, c_ij.",
          part(_GRAM, pr.EQ_14_THIRD_TERM),
          correction=_TRUE_GRAM, counterexample=_gram_counterexample(pr.EQ_14_THIRD_TERM),
          consequence=single_integrals,
          cause="linear-system",
          remark="Decided with C_vv^T C_vv as third term. A sum of three products of a column and a row has rank 3 at "
          "most; the rank needed is the number of unknown control points."),
    fails("sec-4.third-term", _WHERE, "The third term of A is C_uv^T C_vv, that of B is C_uv^T D_vv.",
          part(_GRAM, pr.EQ_14_PRODUCTS),
          correction=_TRUE_GRAM, counterexample=_gram_counterexample(pr.EQ_14_PRODUCTS), consequence=third_term,
          cause="misprints",
          remark="Decided with products integrated last. C_vv^T C_vv and C_vv^T D_vv are right, as (11) shows: P_uv "
          "and P_vv do not meet there. With the printed term A is not symmetric. One letter of an index: it may be a "
          "misprint, or a misread of the scan."),
    fails("sec-4.cvv-indices", _WHERE, "In C_vv row 3 ends with b_{3,n_2} and row m-3 with b_{m-3,n_{m-2}}.",
          *(part(_CVV, formula) for formula in pr.CVV_LAST),
          correction=Correction("b_{3,n_3} and b_{m-3,n_{m-3}}, as in C_uu and C_uv.",
                                tuple(Part(_CVV, formula)
                                      for formula in TRUE_CVV)),
          counterexample=_cvv_counterexample, consequence=vector_lengths,
          cause="misprints",
          remark="Misprints, or misreads by the scan: C_uu and C_uv beside it have the right indices."),
    holds("sec-4.g1-degree", _WHERE, "With the G1 conditions put in, the objective is of degree four.",
          part(objective.degree_check(1, True), pr.DEGREE_G1),
          remark="In the free control points, alpha and beta together; for regular bases, whose R_w is not zero."),
    holds_if("sec-4.g2-degree", _WHERE, "With the G2 conditions put in, the objective is of degree eight.",
             "R_0 - 2 R_1 + R_2 or S_0 - 2 S_1 + S_2 is not zero (with the conditions corrected: R_ww or S_tt), and "
             "that base has order 3 or more across the contact",
             part(objective.degree_check(2, True), pr.DEGREE_G2),
             remark="Of degree four in alpha^2 and beta^2, and quadratic in the free control points: once these are "
             "eliminated, a polynomial in two numbers is left. With the printed conditions the degree is four "
             "between bases whose rows run evenly across both contacts; with the corrected ones between bases "
             "without second derivative there, such as planes of constant speed."),
    holds_if("sec-4.unconstrained", _WHERE, "With the G1 or G2 conditions put in, the problem has no constraint left.",
             "the energy over alpha^2, beta^2 is not least at zero",
             part(objective.SHAPE_CHECK),
             cause="energy-for-quality",
             remark="A least energy over alpha, beta exists for any regular bases. alpha, beta = 0 must be kept out: "
             "there rows 0 and 1 are one, and P_u = 0. For two parallel plates, joined by a turn of 180 degrees, the "
             "least energy lies there, and the blend stands at right angles on both. It may lie there between bases "
             "that face each other too: sec-4.facing."),
    holds_if("sec-4.facing", _WHERE,
             "Between bases that face each other the search ends at a blend with their tangent planes, alpha and beta "
             "not zero.",
             "39 cos theta > 25 cos phi cos(theta - phi), and the same with theta and phi exchanged, these being the "
             "angles that the ways out of R and into S make with the chord (straight bases of unit speed)",
             part(facing.FACING_CHECK, facing.BEST_ALPHA),
             counterexample=facing.facing_counterexample, consequence=facing.facing_shares, cause="energy-for-quality",
             remark="Facing: both angles are acute. With equal angles, in an arch or an S, the condition always holds; "
             "it fails first where one angle is half of the other, from the cosine 25/53 on, 62 degrees. There (11), "
             "over all alpha^2, is least where the blend would leave a base backwards, so that over alpha it is least "
             "at alpha = 0, where rows 0 to 2 are one and the blend leaves the base at an angle."),
    ambiguous("sec-4.initial-value", _WHERE, "The C2 solution is a blend among which the G2 search may start.",
              Reading((part(row_check("start", 1, "parametric"), PARAMETRIC_2_1),
                       part(row_check("start", 2, "parametric"), PARAMETRIC_3_1)),
                      label="a surface that is C2, and the G2 conditions as printed, alpha = beta = 1"),
              Reading((part(row_check("start", 1, "parametric"), PARAMETRIC_2_1),
                       part(row_check("start", 2, "parametric"), PARAMETRIC_3_1_SQUARES)),
                      label="the same with both distances in (3.1) squared, if the scan lost that"),
              Reading((part(Check(_initial_cases, Strength.GENERAL,
                                  "C2 rows solved from end derivatives, put into the corrected G2 conditions, every "
                                  "order and knots", proof=True), SHAPE_ONE),),
                      label="a surface that is C2, and the corrected conditions, alpha = beta = 1"),
              counterexample=partial(row_counterexample, "start", 2, PARAMETRIC_3_1, PARAMETRIC_3_1_SQUARES,
                                     parametric=True),
              cause="second-derivative",
              remark="The paper's own program does start within its problem: its C2 solution is by definition what its "
              "G2 conditions give with alpha = beta = 1. How good that start is depends on the units of w and t, which "
              "(2.1) multiplies by alpha^2; from there the search found the least energy wherever the study ran it."),
    not_checkable("sec-4.fminunc", _WHERE, "fminunc is a BFGS quasi-Newton method with a cubic line search.",
                  "a statement on a version of another program, which is not here"),
    not_checkable("sec-4.few-steps", _WHERE, "Started there, fminunc needs several steps to reach a local minimum.",
                  "the control points of the examples are not printed, nor the version of the program"),
)  # fmt: skip
