"""End derivatives as the appendix prints them, and what it makes of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import INDUCTION, closed_derivative, induction, letters
from semispline.papers.lin2014.certificates.special_choice import special
from semispline.papers.lin2014.checks.contact_rows import BASE_H, BASE_ROWS, BLEND_H, ROWS, Side, u_last
from semispline.papers.recheck import (
    Draft,
    Lets,
    Statement,
    as_text,
    curve_jet,
    derivative,
    end_jets,
    identity,
    lets,
    text,
)


def derivative_cases(formula: Formula, *, equal: bool = True) -> Iterator[Statement]:
    """Yield what decides a printed end derivative of the blend or the base."""
    yield from induction()
    relation = formula.relation
    blend = relation.lhs in (pr.P_u, pr.P_uu)
    d = 1 if relation.lhs in (pr.P_u, pr.R_w) else 2
    of, order, rows, h = (
        ("blend", pr.k, ROWS["start"], BLEND_H[:2]) if blend else ("base", pr.k_r, BASE_ROWS["start"], BASE_H)
    )
    where = tuple(pair for pair in letters("start") if pair[0] != "a")
    closed = closed_derivative("start", of, d)
    yield identity(f"every order: {relation.lhs}", relation.rhs, closed, equal=equal, where=where)
    for number in (4, 3, 5):
        unrolled = Lets("c")
        jets = end_jets(unrolled, number - 1, [text(x) for x in h], d)
        true = derivative(curve_jet(jets, [as_text(row) for row in rows]), d)
        yield identity(
            f"order {number}, by the recursion: {relation.lhs}",
            relation.rhs,
            true,
            equal=equal,
            where=((text(order), str(number)), *where, *unrolled.pairs),
            own=number == 4,
        )


def first_derivatives(claim: Claim) -> Draft:
    """Return the first end derivatives of the appendix."""
    return Draft([[case for formula in claim.formulas for case in derivative_cases(formula)]], believed=(INDUCTION,))


def second_derivatives(claim: Claim) -> Draft:
    """Return the second end derivatives, which fail in both readings."""
    readings = [
        [case for part in reading.parts for case in derivative_cases(given(part.formula), equal=False)]
        for reading in claim.readings
    ]
    correction = [case for formula in claim.corrected_formulas for case in derivative_cases(formula)]
    return Draft(readings, correction, (INDUCTION,))


def solved_row(formula: Formula, order: int, *, equal: bool = True) -> Statement:
    """Return whether a row satisfies (17) or (18) with the end derivatives, all as printed."""
    condition, of_p, of_r = (pr.EQ_17, pr.APP_D1_P, pr.APP_D1_R) if order == 1 else (pr.EQ_18, pr.APP_D2_P, pr.APP_D2_R)
    where = (lets({formula.relation.lhs: formula.relation.rhs})[0], lets({of_r.relation.lhs: of_r.relation.rhs})[0])
    return identity(f"put into ({16 + order})", of_p.relation.rhs, condition.relation.rhs, where=where, equal=equal)


def gives_2_1(claim: Claim) -> Draft:
    """Return whether (17) gives (2.1)."""
    row, slope = claim.corrected_formulas
    return Draft([[solved_row(claim.formulas[0], 1, equal=False)]], [solved_row(row, 1), *special(slope, 1)])


def similarly(claim: Claim) -> Draft:
    """Return the conditions at S as those at R, mirrored."""
    sides: tuple[Side, Side] = ("start", "end")
    names = dict(zip(ROWS[sides[0]] + BASE_ROWS[sides[0]], ROWS[sides[1]] + BASE_ROWS[sides[1]], strict=True))
    names |= {pr.alpha: pr.beta, pr.k_r: pr.k_s, pr.w_kr: pr.t_ks, pr.w_s: pr.t_s, pr.u_1: 1 - u_last}
    cases: list[Statement] = []
    for row, (at_r, at_s) in enumerate(zip((pr.COND_1_1, pr.COND_2_1, pr.COND_3_1), claim.formulas, strict=True)):
        left, right = at_s.relation.rhs, at_r.relation.rhs
        last = ((text(pr.u_m3), text(u_last)),) if row else ()
        mirrored = lets(names)
        cases.append(
            identity(f"row {row}, k = 4, where u_{{m-3}} is the last inner knot", left, right, where=(*last, *mirrored))
        )
        if row:
            cases += [
                identity(
                    f"row {row}, k = {k}, where it is another knot",
                    left,
                    right,
                    equal=False,
                    own=False,
                    meets=False,
                    where=((text(pr.k), str(k)), *mirrored),
                    conditions=("u_m_less_3 != u_m_less_k_plus_1",),
                )
                for k in (3, 5, 6)
            ]
    return Draft([cases])


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "app-d1": first_derivatives,
    "app-d2": second_derivatives,
    "sec-A.17-gives-2.1": gives_2_1,
    "sec-A.18-gives-3.1": lambda claim: Draft([[solved_row(claim.formulas[0], 2)]]),
    "sec-A.similarly": similarly,
}
