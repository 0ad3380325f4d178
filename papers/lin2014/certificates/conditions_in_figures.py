"""The conditions in the figures of section 5: k = k_r = 4, uniform u_i, and for which bases a printed row is right."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Claim, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.certificates.contact import (
    INDUCTION,
    Pairs,
    closed_derivative,
    excess_cases,
    induction,
    letters,
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
    text,
)


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


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "fig-5.c2": c2_figure,
    "fig-8.c2": c2_figure,
    "fig-9.c2": c2_figure,
    "fig-6.g2": g2_figure(6),
    "fig-11.g2": g2_figure(5),
    "fig-10.g2": g2_figure(5, "start"),
}
