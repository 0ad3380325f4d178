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
    excess_cases,
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
    w_kr1,
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
    """Return a figure whose blend is said to be C2, with one middle curve: on which bases (3.1) is right, and others.

    Rows that step as the condition says; what is left for any rows is a sum over R_1 - R_0 and R_2 - R_1, and the
    condition says where it is zero.
    """
    readings = []
    for squares, reading in enumerate(claim.readings[:2]):
        printed, excess = (given(part.formula) for part in reading.parts)
        step = "H2*(1/4 + H1)/(1/4*(2*H1 - H2))" if squares else "1/2*H2/(H1*(1/2 - H2))"
        knots = dict(letters("start"))
        distances = tuple((name, knots[name]) for name in ("H1", "H2"))

        def stepping(factor: str, distances: Pairs = distances) -> Pairs:
            return (*distances, (text(pr.R_2), f"{text(pr.R_1)} + {factor}*({text(pr.R_1)} - {text(pr.R_0)})"))

        left = excess_of_rows(excess, printed)
        readings.append(
            [
                *figure_row(printed, "start", 6, "parametric", stepping(step)),
                left,
                *figure_row(printed, "start", 6, "parametric", equal=False, own=False, meets=False),
                *figure_row(
                    printed, "start", 6, "parametric", stepping("H2/H1 - 1"), equal=False, own=False, meets=False
                ),
            ]
        )
    corrected = given(claim.readings[2].parts[0].formula)
    return Draft(
        [*readings, [*figure_row(corrected, "start", 6, "parametric")]],
        figure_row(claim.corrected_formulas[0], "start", 6, "parametric"),
        (INDUCTION,),
    )


def excess_of_rows(excess: Formula, printed: Formula) -> Statement:
    """Return what a printed row 2 leaves of C2 for any rows and knots, k = k_r = 4, u_1 = 1/4, u_2 = 1/2."""
    relation = printed.relation
    where = (
        (text(pr.k), str(CUBIC)),
        (text(pr.k_r), str(CUBIC)),
        (text(pr.u_1), "1/4"),
        (text(pr.u_2), "1/2"),
        *letters("start", "parametric"),
        *rows_before("start", 2),
        (text(relation.lhs), text(relation.rhs)),
        (text(pr.P_uu), str(closed_derivative("start", "blend", 2))),
        (text(pr.R_ww), str(closed_derivative("start", "base", 2))),
    )
    return identity("any rows and knots: P_uu - R_ww", *excess.relation.args, where=where)


def g2_figure(m: int, side: Side = "end") -> Any:
    """Return the draft of a figure whose blend is said to be G2, with a base that may be curved across."""

    def draft(claim: Claim) -> Draft:
        base = BASE_ROWS[side]
        start, first, second = (pr.w_s, pr.w_kr, w_kr1) if side == "start" else (pr.t_s, pr.t_ks, t_ks1)
        straight = ((text(base[2]), text(base[0])),)
        spans = (
            ((text(second), text(start + sp.Rational(2, m - 2))),),
            ((text(second), text(start + 2 * (first - start))),),
        )
        readings = []
        for reading, right in zip(claim.readings[:2], spans, strict=True):
            printed, excess = (given(part.formula) for part in reading.parts)
            readings.append(
                [
                    *figure_row(printed, side, m, "normal", right),
                    *figure_row(printed, side, m, "normal", straight),
                    *excess_cases(excess, side, printed_row(side, squares=right is spans[1])),
                    *figure_row(printed, side, m, "normal", equal=False, own=False, meets=False),
                ]
            )
        corrected = given(claim.readings[2].parts[0].formula)
        return Draft(
            [*readings, [*figure_row(corrected, side, m)]],
            figure_row(claim.corrected_formulas[0], side, m),
            (INDUCTION,),
        )

    return draft


def printed_row(side: Side, *, squares: bool) -> Formula:
    """Return (3.1) or (3.2) as printed, or with both distances squared."""
    rows = {"start": (pr.COND_3_1, pr.COND_3_1_SQUARES), "end": (pr.COND_3_2, pr.COND_3_2_SQUARES)}
    return rows[side][squares]


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
    "fig-10.g2": g2_figure(5, "start"),
}
