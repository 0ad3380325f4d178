"""The smallest instances at which a printed contact row or end derivative is not the true one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, Literal

import sympy as sp

from semispline.derivations.splines import end_derivatives_from_pieces
from semispline.papers.ledger import Counterexample, Formula, given, smallest_assignment
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import (
    BASE_H,
    BASE_ROWS,
    BLEND_H,
    ONES,
    ORDERS,
    ROWS,
    Side,
    base_order,
    letter_values,
    rows_from_pieces,
    w_kr1,
)
from semispline.papers.lin2014.printed import CUBIC


def row_counterexample(
    side: Side, row: int, *formulas: Formula, parametric: bool = False, least_order: int = 0
) -> Counterexample | None:
    """Search for the smallest instance at which no reading of a row is the true one: orders first, then heights.

    The base is regular: its first two rows differ. The blend has `least_order` or more, and not less than the row
    needs. The one in the paper's own orders and knots (k = 4, no middle curve, so that u is 1/3, 2/3) is found
    beside it.
    """
    lowest = max(row + 1, least_order)
    for total in range(lowest + 2, 2 * ORDERS[-1] + 1):
        for k in range(lowest, total - 1):
            k_b = total - k
            fixed = ONES if parametric else {}
            found = _counterexample_at(side, row, formulas, (k, k_b), fixed)
            if found is not None:
                own = _counterexample_at(side, row, formulas, (CUBIC, CUBIC), _OWN_KNOTS | fixed)
                return found if own is None else replace(found, own=str(own))
    return None


_OWN_KNOTS = {BLEND_H[0]: sp.Rational(1, 3), BLEND_H[1]: sp.Rational(2, 3), BLEND_H[2]: sp.Integer(1)}


def _counterexample_at(
    side: Side, row: int, formulas: Sequence[Formula], orders: tuple[int, int], fixed: dict[Any, Any]
) -> Counterexample | None:
    degree = orders[0] - 1
    values = letter_values(side, *orders, rows_from_pieces(row, degree, orders[1] - 1, side))
    readings = [given(formula).relation.rhs.subs(values, simultaneous=True).subs(fixed) for formula in formulas]
    true = values[ROWS[side][row]].subs(fixed)
    found = _smallest_difference(readings, true, BASE_ROWS[side][:2])
    if found is None:
        return None
    names = zip(("k", str(base_order(side))), map(str, orders), strict=True)
    wrong = " or ".join(dict.fromkeys(str(reading.subs(found)) for reading in readings))
    at = named(side, {h: x for h, x in fixed.items() if h != BLEND_H[2] and h not in ONES} | found)
    return Counterexample((*names, *at), wrong, str(true.subs(found)))


def _smallest_difference(readings: Sequence[Any], true: Any, apart: tuple[Any, ...] = ()) -> dict[Any, Any] | None:
    """Return the smallest instance at which all readings miss, with the two letters `apart` different."""
    differences = [reading - true for reading in readings]
    residuals = [sp.numer(sp.together(difference)) for difference in differences]
    if any(sp.expand(residual) == 0 for residual in residuals):
        return None
    h = [x for x in BLEND_H if any(expression.has(x) for expression in (*readings, true))]
    b = [x for x in BASE_H if any(expression.has(x) for expression in (*readings, true))]
    letters = set().union(*(difference.free_symbols for difference in differences))
    symbols = [*h, *b, *sorted(letters - set(h) - set(b), key=str)]
    evaluate = [sp.lambdify(symbols, residual, "math") for residual in residuals]

    def counts(at: dict[Any, Any]) -> bool:
        # Inner knots of U lie strictly inside [0, 1] and increase; so do those of the base.
        inside = all(at[x] < 1 for x in h)
        increase = all(at[x] < at[y] for chain in (h, b) for x, y in pairwise(chain))
        regular = not apart or at.get(apart[0], 0) != at.get(apart[1], 0)
        return inside and increase and regular and all(f(*(at[s] for s in symbols)) != 0 for f in evaluate)

    return smallest_assignment(symbols, counts)


def named(side: Side, at: dict[Any, Any]) -> tuple[tuple[str, str], ...]:
    """Return an instance in the paper's letters."""
    if side == "start":
        names = {BLEND_H[0]: "u_1", BLEND_H[1]: "u_2", BASE_H[0]: "w_{k_r} - w_s", BASE_H[1]: "w_{k_r+1} - w_s"}
    else:
        names = dict(zip(BLEND_H, ("1 - u_{m-k+1}", "1 - u_{m-k}", "1 - u_{m-k-1}"), strict=True))
        names |= {BASE_H[0]: "t_{k_s} - t_s", BASE_H[1]: "t_{k_s+1} - t_s"}
    return tuple((names.get(symbol, str(symbol)), str(value)) for symbol, value in at.items())


def derivative_counterexample(surface: Literal["P", "R"], order: int, formula: Formula) -> Counterexample | None:
    """Search for the smallest instance at which a printed end derivative is not the true one: orders first."""
    is_blend = surface == "P"
    rows = (pr.P_0, pr.P_1, pr.P_2) if is_blend else (pr.R_0, pr.R_1, pr.R_2)
    for k in range(2, ORDERS[-1] + 1):
        true = (end_derivatives_from_pieces(2, k - 1)[order, :] * sp.Matrix(rows))[0]
        h1, h2, _ = BLEND_H
        knots = {pr.u_1: h1, pr.u_2: h2, pr.w_kr: pr.w_s + h1, w_kr1: pr.w_s + h2, pr.k: k, pr.k_r: k}
        wrong = formula.relation.rhs.subs(knots, simultaneous=True)
        found = _smallest_difference([wrong], true)
        if found is not None:
            values = (("k" if is_blend else "k_r", str(k)), *named("start", found))
            return Counterexample(values, str(wrong.subs(found)), str(true.subs(found)))
    return None
