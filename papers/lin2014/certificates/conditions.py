"""Records on what the conditions together give: sufficiency, parametric continuity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import (
    INDUCTION,
    closed_derivative,
    induction,
    letters,
    row_cases,
    rows_before,
)
from semispline.papers.lin2014.certificates.general_contact import FORMS, PLANES
from semispline.papers.lin2014.certificates.special_choice import shape_parameters, special_contact
from semispline.papers.lin2014.checks.contact_rows import Side, u_before
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_2_2, TRUE_3_1, TRUE_3_2
from semispline.papers.recheck import Draft, Statement, Text, identity, positive, text


def reaches(claim: Claim) -> Draft:
    """Return the three readings of what continuity is reached."""
    first, *printed = (given(reading.parts[0].formula) for reading in claim.readings)
    wrong = [row_cases(formula, "start", 2, "normal", equal=False) for formula in printed]
    return Draft([row_cases(first, "start", 2), *wrong], believed=(INDUCTION,))


def numbering(claim: Claim) -> Draft:
    """Return (2.1) with u_1 the first inner knot, and with u_1 = 0."""
    first, other = (given(reading.parts[0].formula) for reading in claim.readings)
    return Draft([row_cases(first, "start", 1), row_cases(other, "start", 1, equal=False)], believed=(INDUCTION,))


def parametric_c1(claim: Claim) -> Draft:
    """Return row 1 with alpha = 1 against P_u = R_w and against P_u = -R_w."""
    readings = []
    for sign, reading in zip((1, -1), claim.readings, strict=True):
        formula = given(reading.parts[0].formula)
        row = ((text(formula.relation.lhs), text(formula.relation.rhs)),)
        where = (*letters("start", "parametric"), *rows_before("start", 1), *row)
        right = sign * closed_derivative("start", "base", 1)
        case = identity(
            "every order and knots", closed_derivative("start", "blend", 1), right, equal=sign < 0, where=where
        )
        readings.append([case] if sign > 0 else [*induction(), case])
    return Draft(readings, believed=(INDUCTION,))


def parametric_c2(claim: Claim) -> Draft:
    """Return (3.1) with alpha = 1, in all coordinates."""
    readings = [
        row_cases(reading.parts[0].formula, "start", 2, "parametric", equal=False) for reading in claim.readings
    ]
    return Draft(readings, row_cases(claim.corrected_formulas[0], "start", 2, "parametric"), (INDUCTION,))


def sufficient_g1(claim: Claim) -> Draft:
    """Return the conditions for G1, and by which factor P_u is a multiple of S_t for other k than 4."""
    first, end, second, slope = claim.formulas[:4]
    cases: list[Statement] = [*row_cases(first, "start", 0), *row_cases(end, "end", 0), *row_cases(second, "start", 1)]
    cases += [case for case in row_cases(slope, "end", 1) if case.meets]
    cases += multiples(slope)
    cases += shape_parameters()
    return Draft([cases], believed=(INDUCTION, PLANES))


def multiples(formula: Formula) -> Iterator[Statement]:
    """Yield (2.2) with u_{m-3} counted: for k < 4 P_u is a positive multiple of S_t, for k > 4 row m-1 is row m."""
    relation = formula.relation
    far = sp.Symbol("u_first")
    for k, place, distance in ((3, u_before, "1 - u_m_less_k"), (2, far, "1 - u_first")):
        where = (
            (text(pr.k), str(k)),
            *letters("end"),
            (text(pr.u_m3), text(place)),
            *rows_before("end", 1),
            (text(relation.lhs), text(relation.rhs)),
        )
        factor = Text(f"a*({distance})/h1", 2)
        yield identity(
            f"k = {k}: P_u is a multiple of S_t",
            closed_derivative("end", "blend", 1),
            -factor * closed_derivative("end", "base", 1),
            where=where,
            own=False,
        )
    yield positive("k < 4: the factor is positive", Text("b^2*g/h1", 2), positive=("b", "g", "h1"), own=False)
    for k in (5, 6):
        where = ((text(pr.k), str(k)), (text(pr.u_m3), "1"))
        yield identity(
            f"k = {k}: row m-1 is row m", relation.rhs, pr.P_m, where=where, wanted=False, own=False, meets=False
        )


def sufficient_g2(claim: Claim) -> Draft:
    """Return all six conditions, as printed and corrected."""
    rows: tuple[tuple[Side, int], ...] = (("start", 0), ("end", 0), ("start", 1), ("end", 1), ("start", 2), ("end", 2))
    readings = []
    for reading in claim.readings:
        cases: list[Statement] = []
        for (side, row), part in zip(rows, reading.parts, strict=True):
            cases += row_cases(part.formula, side, row, "normal" if row == 2 else "all", equal=row < 2)
        readings.append(cases)
    correction: list[Statement] = []
    for (side, row), formula in zip(rows, claim.corrected_formulas, strict=True):
        correction += row_cases(formula, side, row)
    return Draft(readings, [*correction, *special_contact(2)], (INDUCTION, PLANES, FORMS))


def initial_value(claim: Claim) -> Draft:
    """Return whether a C2 blend satisfies the G2 conditions with alpha = beta = 1: printed, with squares, corrected."""
    readings: list[list[Statement]] = []
    for reading in claim.readings[:2]:
        first, second = (part.formula for part in reading.parts)
        printed = row_cases(second, "start", 2, "parametric", equal=False)
        readings.append([*row_cases(first, "start", 1, "parametric"), *printed])
    shape = given(claim.readings[2].parts[0].formula).relation.rhs
    return Draft([*readings, [*c2_rows(shape)]], believed=(INDUCTION,))


def c2_rows(shape: Any) -> Iterator[Statement]:
    """Yield that the rows of a C2 blend satisfy the corrected G2 conditions with a value of alpha and beta."""
    conditions = {"start": (pr.COND_1_1, pr.COND_2_1, TRUE_3_1), "end": (pr.COND_1_2, TRUE_2_2, TRUE_3_2)}
    yield from induction()
    sides: tuple[Side, Side] = ("start", "end")
    for side in sides:
        for row, condition in enumerate(conditions[side]):
            where = (
                ("alpha", text(shape)),
                ("beta", text(shape)),
                *letters(side),
                *rows_before(side, row),
                (text(condition.relation.lhs), text(condition.relation.rhs)),
            )
            sign = Text(f"(-1)^{row}", 3)
            yield identity(
                f"row {row} from the {side}: derivative {row} is that of the base run backwards",
                closed_derivative(side, "blend", row),
                sign * closed_derivative(side, "base", row),
                where=where,
            )


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-0.reaches": reaches,
    "sec-3.u-numbering": numbering,
    "sec-3.parametric-c1": parametric_c1,
    "sec-3.parametric-c2": parametric_c2,
    "sec-3.sufficient-g1": sufficient_g1,
    "sec-3.sufficient-g2": sufficient_g2,
    "sec-4.initial-value": initial_value,
}
