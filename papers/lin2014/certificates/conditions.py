"""Records on what the conditions together give: sufficiency, parametric continuity, figures of section 5."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from semispline.derivations.contact import A, contact_rows
from semispline.derivations.splines import span_symbols
from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.appendix import FORMS, PLANES, shape_parameters, special_contact
from semispline.papers.lin2014.certificates.contact import (
    INDUCTION,
    Pairs,
    closed_derivative,
    induction,
    letters,
    row_cases,
    rows_before,
)
from semispline.papers.lin2014.checks.contact_rows import (
    BASE_ROWS,
    ROWS,
    Mode,
    Side,
    base_order,
    t_ks1,
    u_before,
    u_last,
)
from semispline.papers.lin2014.claims.section_3_conditions import TRUE_2_2, TRUE_3_1, TRUE_3_2
from semispline.papers.lin2014.printed import CUBIC
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    Text,
    as_text,
    curve_jet,
    derivative,
    end_jets,
    identity,
    positive,
    text,
)


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
    """Return that the rows of a C2 blend satisfy the G2 conditions with alpha = beta = 1."""
    shape = claim.formulas[0].relation.rhs
    conditions = {"start": (pr.COND_1_1, pr.COND_2_1, TRUE_3_1), "end": (pr.COND_1_2, TRUE_2_2, TRUE_3_2)}
    cases: list[Statement] = [*induction()]
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
            cases.append(
                identity(
                    f"row {row} from the {side}: derivative {row} is that of the base run backwards",
                    closed_derivative(side, "blend", row),
                    sign * closed_derivative(side, "base", row),
                    where=where,
                )
            )
    return Draft([cases], believed=(INDUCTION,))


def undisturbed(claim: Claim) -> Draft:
    """Return that the contact curve is the first row, and that rows of the blend are made of three of the base."""
    return Draft([[*contact_curve(), *three_rows()]], believed=(INDUCTION,))


def contact_curve() -> Iterator[Statement]:
    """Yield that at a clamped end the first function is 1 and the others are 0, at both ends."""
    yield from (case for case in induction() if "derivative 0" in case.label)
    ends: tuple[Side, Side] = ("start", "end")
    for end in ends:
        for degree in range(1, 6):
            unrolled = Lets("c")
            jets = end_jets(unrolled, degree, span_symbols(degree), 0, end)
            for i, jet in enumerate(jets):
                yield identity(
                    f"degree {degree}, by the recursion, at the {end}: function {i}",
                    jet[0] if jet[0] is not None else 0,
                    int(i == 0),
                    where=unrolled.pairs,
                    own=degree == 3,
                )


def three_rows() -> Iterator[Statement]:
    """Yield that R_2 has a factor in row 2, which is a^2 times a positive number, for every order from 3 on."""
    every = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"))
    over = {pr.k: sp.Symbol("r") + 3, pr.k_r: sp.Symbol("s") + 3}
    yield positive(
        "every order from 3 on: R_2 has a factor in row 2",
        every[2, 2].subs(over),
        positive=(A, *span_symbols(2), *span_symbols(2, "H")),
        nonnegative=("r", "s"),
    )
    for row in range(3):
        for j in range(row + 1, 3):
            yield identity(f"R_{j} has none in row {row}", every[row, j], 0)
    for row in range(3):
        total = as_text(every[row, 0])
        for j in range(1, row + 1):
            total = total + as_text(every[row, j])
        yield identity(f"row {row} is a combination whose factors sum to 1", total, 1)


def figure_row(
    formula: Formula | None,
    side: Side,
    m: int,
    mode: Mode = "all",
    extra: Pairs = (),
    *,
    equal: bool = True,
    **flags: Any,
) -> Iterator[Statement]:
    """Yield row 2 of a figure: k = k_r = 4, uniform u_i, by closed form and by the recursion."""
    relation = given(formula).relation
    h = sp.Rational(1, m - 2), sp.Rational(2, m - 2)
    knots = (
        {pr.u_1: h[0], pr.u_2: h[1]} if side == "start" else {u_last: 1 - h[0], u_before: 1 - h[1], pr.u_m3: 1 - h[0]}
    )
    where = (
        (text(pr.k), str(CUBIC)),
        (text(base_order(side)), str(CUBIC)),
        *((text(s), text(x)) for s, x in knots.items()),
        *extra,
        *letters(side, mode),
        *rows_before(side, 2),
        (text(relation.lhs), text(relation.rhs)),
    )
    sign = Text("a^2", 3)
    if equal:
        yield from induction()
    yield identity(
        f"any rows, {m + 1} curves",
        closed_derivative(side, "blend", 2),
        sign * closed_derivative(side, "base", 2),
        equal=equal,
        where=where,
        **flags,
    )
    unrolled, base_lets = Lets("c"), Lets("d")
    blend = curve_jet(end_jets(unrolled, 3, [Text("h1"), Text("h2")], 2, side), [as_text(x) for x in ROWS[side]])
    base = curve_jet(end_jets(base_lets, 3, [Text("H1"), Text("H2")], 2), [as_text(x) for x in BASE_ROWS[side]])
    yield identity(
        f"any rows, {m + 1} curves, by the recursion",
        derivative(blend, 2),
        sign * derivative(base, 2),
        equal=equal,
        where=(*where, *unrolled.pairs, *base_lets.pairs),
        **flags,
    )


def c2_figure(claim: Claim) -> Draft:
    """Return a figure whose blend is said to be C2, with one middle curve."""
    printed, squared, corrected = (given(reading.parts[0].formula) for reading in claim.readings)
    readings = [
        figure_row(formula, "start", 6, "parametric", equal=equal)
        for formula, equal in ((printed, False), (squared, False), (corrected, True))
    ]
    return Draft(readings, figure_row(claim.corrected_formulas[0], "start", 6, "parametric"), (INDUCTION,))


_EQUAL = ((text(t_ks1), text(pr.t_s + 2 * (pr.t_ks - pr.t_s))),)


def g2_figure(m: int) -> Any:
    """Return the draft of a figure whose blend is said to be G2, with a curved base S."""

    def draft(claim: Claim) -> Draft:
        printed, squared, corrected = (given(reading.parts[0].formula) for reading in claim.readings)
        spans = [
            *figure_row(squared, "end", m, "normal", _EQUAL),
            *figure_row(squared, "end", m, "normal", equal=False, own=False, meets=False),
        ]
        readings = [figure_row(printed, "end", m, "normal", equal=False), spans, figure_row(corrected, "end", m)]
        return Draft(readings, figure_row(claim.corrected_formulas[0], "end", m), (INDUCTION,))

    return draft


def straight_figure(claim: Claim) -> Draft:
    """Return Fig. 10: by accident on a base that is straight across, not on a curved one."""
    printed, corrected = (given(reading.parts[0].formula) for reading in claim.readings)
    straight = ((text(pr.R_2), text(pr.R_0)),)
    cases = [
        *figure_row(printed, "start", 5, "normal", straight),
        *figure_row(printed, "start", 5, "normal", equal=False, own=False, meets=False),
    ]
    return Draft([cases, figure_row(corrected, "start", 5)], believed=(INDUCTION,))


DRAFTS = {
    "sec-0.undisturbed": undisturbed,
    "sec-0.reaches": reaches,
    "sec-3.u-numbering": numbering,
    "sec-3.contact-knots": lambda _: Draft([contact_curve()], believed=(INDUCTION,)),
    "sec-3.parametric-c1": parametric_c1,
    "sec-3.parametric-c2": parametric_c2,
    "sec-3.sufficient-g1": sufficient_g1,
    "sec-3.sufficient-g2": sufficient_g2,
    "sec-4.initial-value": initial_value,
    "fig-5.c2": c2_figure,
    "fig-8.c2": c2_figure,
    "fig-9.c2": c2_figure,
    "fig-6.g2": g2_figure(6),
    "fig-11.g2": g2_figure(5),
    "fig-10.g2": straight_figure,
}
