"""Deciding (3.1) and (3.2) as G2 asks: along the normal, since (16) leaves the rest of P_uu free.

With rows 0 and 1 right, P_uu - alpha^4 R_ww is x (R_2 - R_1) + y (R_1 - R_0) for numbers x, y that depend on orders,
knots and alpha alone. R_w is a multiple of R_1 - R_0 at each v, so the second term is tangent: contact is G2 for every
regular base exactly if x = 0, and for one base exactly if x (R_2 - R_1) is tangent too, that is, if x = 0 or R_ww has
no normal component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives
from semispline.papers.ledger import (
    Case,
    Check,
    Counterexample,
    Formula,
    Strength,
    explained,
    given,
    smallest_assignment,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_counterexamples import named
from semispline.papers.lin2014.checks.contact_rows import (
    BASE_H,
    BASE_ROWS,
    BLEND_H,
    ORDERS,
    ROWS,
    Side,
    base_order,
    knots_as_spans,
    letter_values,
    rows_from_pieces,
    t_ks1,
    u_before,
    u_last,
    w_kr1,
)
from semispline.papers.lin2014.printed import CUBIC

S_tt = sp.Symbol("S_tt", real=True)
# What the printed rows give along the normal, less what G2 asks: zero exactly where the bracket is.
EXCESS_3_1 = Formula(
    sp.Eq(pr.P_uu - pr.alpha**4 * pr.R_ww, pr.alpha**4 * pr.R_ww * (w_kr1 - pr.w_s - pr.u_2) / pr.u_2),
    (pr.P_uu, pr.R_ww, pr.alpha, w_kr1, pr.w_s, pr.u_2),
    (pr.u_2 > 0, w_kr1 > pr.w_s),
    ((pr.u_1, pr.u_2), (pr.w_kr, w_kr1)),
)
EXCESS_3_1_SQUARES = Formula(
    sp.Eq(
        pr.P_uu - pr.alpha**4 * pr.R_ww,
        pr.alpha**4
        * pr.R_ww
        * (pr.u_1 * (w_kr1 - pr.w_s) - pr.u_2 * (pr.w_kr - pr.w_s))
        / (pr.u_2 * (pr.w_kr - pr.w_s)),
    ),
    (pr.P_uu, pr.R_ww, pr.alpha, w_kr1, pr.w_kr, pr.w_s, pr.u_1, pr.u_2),
    (pr.u_1 > 0, pr.u_2 >= pr.u_1, pr.w_kr > pr.w_s, w_kr1 >= pr.w_kr),
    ((pr.u_1, pr.u_2), (pr.w_kr, w_kr1)),
)
EXCESS_3_2 = Formula(
    sp.Eq(pr.P_uu - pr.beta**4 * S_tt, pr.beta**4 * S_tt * (t_ks1 - pr.t_s - (1 - u_before)) / (1 - u_before)),
    (pr.P_uu, S_tt, pr.beta, t_ks1, pr.t_s, u_before),
    (u_before > 0, u_before < 1, t_ks1 > pr.t_s),
    ((u_last, u_before), (pr.t_ks, t_ks1)),
)
EXCESS_3_2_SQUARES = Formula(
    sp.Eq(
        pr.P_uu - pr.beta**4 * S_tt,
        pr.beta**4
        * S_tt
        * ((1 - u_last) * (t_ks1 - pr.t_s) - (1 - u_before) * (pr.t_ks - pr.t_s))
        / ((1 - u_before) * (pr.t_ks - pr.t_s)),
    ),
    (pr.P_uu, S_tt, pr.beta, t_ks1, pr.t_ks, pr.t_s, u_last, u_before),
    (u_before > 0, u_last < 1, u_last >= u_before, pr.t_ks > pr.t_s, t_ks1 >= pr.t_ks),
    ((u_last, u_before), (pr.t_ks, t_ks1)),
)

_TANGENT = "differs from the formula within the tangent plane alone, where (16) leaves P_uu free"
_UNSEEN = (
    "with R_2 in the tangent plane too, as on a base that is straight across, every such row is in it: this record "
    "does not see the formula; fig-6.g2, with a curved base, and cond-3.1 do"
)


@cache
def along_normal(formula: Formula, side: Side, *, straight: bool = False) -> Formula:
    """Return a condition for row 2 with the mutants explained that change P_uu within the tangent plane only.

    These give the same where R_0 and R_1, so that P_0 and P_1 as well, have one coordinate x along the normal, and R_2
    too if the base is straight across.
    """
    flat = dict.fromkeys((*BASE_ROWS[side][: 3 if straight else 2], *ROWS[side][:2]), sp.Symbol("x"))
    return explained(formula, flat, _UNSEEN if straight else _TANGENT)


def excess_check(side: Side, printed: Formula) -> Check:
    """Return the check of what a printed row 2 gives along the normal less what G2 asks, for symbolic orders."""
    return Check(
        partial(_excess_cases, side, printed),
        Strength.GENERAL,
        "second end derivatives of rows along the normal, the blend's by the printed row, for symbolic orders and knots"
        + ("; u_{m-3} is the last inner knot, as for k = 4" if side == "end" else ""),
        proof=True,
    )


def _excess_cases(side: Side, printed: Formula, formula: Formula | None) -> Iterator[Case]:
    relation = given(formula).relation
    second, base = _second_derivatives(side, printed)
    values = knots_as_spans(side) | {pr.P_uu: second, (pr.R_ww if side == "start" else S_tt): base}
    residual = sp.cancel((relation.rhs - relation.lhs).subs(values, simultaneous=True))
    yield Case("every order, knots and base, along the normal", bool(residual == 0), residual=residual)


@cache
def _second_derivatives(side: Side, printed: Formula) -> tuple[Any, Any]:
    """Return P_uu by the printed row and the base's second derivative, along the normal: R_0 = R_1 = P_0 = P_1."""
    first, _, last = BASE_ROWS[side]
    flat = dict.fromkeys((*BASE_ROWS[side][:2], *ROWS[side][:2]), first)
    row = printed.relation.rhs.xreplace(flat).xreplace({pr.u_m3: u_last}).subs(knots_as_spans(side), simultaneous=True)
    ends = end_derivatives(2, pr.k - 1, BLEND_H[:2]), end_derivatives(2, base_order(side) - 1, BASE_H)
    rows = sp.Matrix([first, first, row]), sp.Matrix([first, first, last])
    second, base = (sp.factor((end[2, :] * column)[0]) for end, column in zip(ends, rows, strict=True))
    return second, base


def normal_counterexample(side: Side, formulas: Sequence[Formula]) -> Counterexample | None:
    """Search for the smallest base and blend that no reading of the condition for row 2 joins with G2.

    Orders first, then heights. R_v is the second unit vector along the contact and in all three rows, R_0 the origin,
    R_1 on the first axis and not the origin: so R_w x R_v points along the third axis. The smallest one in the paper's
    own orders and knots (no middle curve, so that u is 1/3, 2/3) is found beside it, on a base with inner knots across.
    """
    for total in range(6, 2 * ORDERS[-1] + 1):
        for k in range(3, total - 2):
            found = _counterexample_at(side, formulas, (k, total - k), {})
            if found is not None:
                own = dict(zip(BLEND_H[:2], (sp.Rational(1, 3), sp.Rational(2, 3)), strict=True))
                mine = _counterexample_at(side, formulas, (CUBIC, CUBIC), own)
                return found if mine is None else replace(found, own=str(mine))
    return None


_X1, _Z2 = sp.symbols("x_1 z_2", real=True)


def _counterexample_at(
    side: Side, formulas: Sequence[Formula], orders: tuple[int, int], fixed: dict[Any, Any]
) -> Counterexample | None:
    values = letter_values(side, *orders, rows_from_pieces(2, orders[0] - 1, orders[1] - 1, side))
    true = values[ROWS[side][2]]
    rows = [formula.relation.rhs.subs(values, simultaneous=True) for formula in formulas]
    heights = dict(zip(BASE_ROWS[side], (0, 0, _Z2), strict=True))
    shape = pr.alpha if side == "start" else pr.beta
    symbols = [*BLEND_H[: 3 if any(row.has(BLEND_H[2]) for row in rows) else 2], *BASE_H, shape, _X1, _Z2]
    misses = [sp.numer(sp.together((row - true).subs(heights).subs(fixed))) for row in rows]
    searched = [s for s in symbols if s not in fixed]
    evaluate = [sp.lambdify(searched, miss, "math") for miss in misses]
    inside = [x for x in symbols if x in BLEND_H]

    def counts(at: dict[Any, Any]) -> bool:
        h = [at[x] if x in at else fixed[x] for x in inside]
        # Inner knots of U differ and lie inside [0, 1]; a base without inner knots has one length for both spans, and
        # is not taken where the search is in the own setting of the paper.
        first, second = (at[x] for x in BASE_H)
        inner = first < second if fixed else first <= second
        knots = all(a < b for a, b in zip(h, (*h[1:], 1), strict=True)) and inner
        return knots and at[_X1] != 0 and all(f(*(at[s] for s in searched)) != 0 for f in evaluate)

    found = smallest_assignment(searched, counts)
    if found is None:
        return None
    at = fixed | found
    base = [(0, 0, 0), (at[_X1], 0, 0), (0, 0, at[_Z2])]
    names = zip(("k", str(base_order(side))), map(str, orders), strict=True)
    numbers = named(side, {s: at[s] for s in symbols if s not in (_X1, _Z2)})
    letter = "R" if side == "start" else "S"
    vectors = [(f"{letter}_{i}", str(point)) for i, point in enumerate(base)]
    vectors.append((f"{letter}_v", "(0, 1, 0)"))
    vector = [_vector(row, side, base, at) for row in (*rows, true)]
    printed = " or ".join(f"{ROWS[side][2]} = {wrong}" for wrong in vector[:-1])
    true_text = f"third coordinate {vector[-1][2]}, the one along the normal"
    return Counterexample((*names, *numbers, *vectors), printed, true_text)


def _vector(row: Any, side: Side, base: Sequence[tuple[Any, ...]], at: dict[Any, Any]) -> tuple[Any, ...]:
    """Return a row of the blend, coordinate by coordinate."""
    return tuple(
        sp.sympify(row).subs({symbol: point[c] for symbol, point in zip(BASE_ROWS[side], base, strict=True)}).subs(at)
        for c in range(3)
    )
