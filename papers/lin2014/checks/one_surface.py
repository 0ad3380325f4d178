"""Deciding whether (3.1) is a condition on two surfaces: it may not depend on how the base is written.

Three changes leave the base R as it is, and row 1 of the blend with it. Its parameter w may be counted in other units,
alpha^2 in the same ones, which (2.1) shows: w becomes c w, alpha^2 becomes c alpha^2. And a knot may be inserted across
the contact, which the paper itself calls a change of the representation alone: into the first span, or into the second,
where w_{k_r} stays and R_2 alone moves, so that no power of the first span can make up for it. As rows 0 and 1 stay,
and G2 fixes what row 2 has along the normal, a condition for G2 must give one row 2 before and after.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives
from semispline.papers.ledger import Case, Check, Counterexample, Formula, Strength, given, premises
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import BASE_H, BLEND_H, knots_as_spans, row_check

_H1, _H2 = BASE_H
# The scale of w is the square of this; places after w_s of a knot inserted into the first span, and into the second.
_ROOT, _PLACE, _PLACE_2 = sp.symbols("d x y", positive=True)
_SCALED = {
    **{pr.alpha: _ROOT * pr.alpha, pr.w_s: _ROOT**2 * pr.w_s},
    **{knot: _ROOT**2 * value for knot, value in knots_as_spans("start").items() if knot not in (pr.u_1, pr.u_2)},
}
_W_KR, _W_KR1 = (knot for knot in knots_as_spans("start") if knot not in (pr.u_1, pr.u_2))
# By Boehm's rule, in the first span: R_0 stays, the next two are on the first two legs of the polygon.
_INSERTED = {
    pr.R_1: pr.R_0 + _PLACE / _H1 * (pr.R_1 - pr.R_0),
    pr.R_2: pr.R_1 + _PLACE / _H2 * (pr.R_2 - pr.R_1),
    _W_KR: pr.w_s + _PLACE,
    _W_KR1: pr.w_s + _H1,
}
# In the second span: R_0 and R_1 stay.
_INSERTED_2 = {pr.R_2: pr.R_1 + _PLACE_2 / _H2 * (pr.R_2 - pr.R_1), _W_KR1: pr.w_s + _PLACE_2}
_BEYOND = "a knot inserted at w_s + y, H_1 < y < H_2"
_CHANGES = {
    "w in other units, w' = d^2 w": _SCALED,
    "a knot inserted at w_s + x, x < H_1": _INSERTED,
    _BEYOND: _INSERTED_2,
}
_POINT = sp.Symbol("q")
_ONE_POINT = dict.fromkeys((pr.R_0, pr.R_1, pr.R_2, pr.P_0, pr.P_1), _POINT)
_LETTERS = (
    *(*BLEND_H, *BASE_H, pr.alpha, pr.k, pr.k_r, pr.w_s, _ROOT, _PLACE, _PLACE_2, _POINT),
    *(pr.R_0, pr.R_1, pr.R_2, pr.P_0, pr.P_1, pr.P_2),
)


def one_surface_check(*, flat: bool, any_powers: bool = False) -> Check:
    """Return the check of row 2 under the changes.

    Parameters
    ----------
    flat : bool
        Along the normal alone, where R_0 = R_1 and P_0 = P_1.
    any_powers : bool
        The formula has a letter for powers of the first span: only the change that leaves it as it is.
    """
    what = "along the normal" if flat else "all coordinates, and P_uu against the base"
    units = "" if any_powers else "w is counted in other units, and "
    where = "the second span" if any_powers else "the first or second span"
    return Check(
        partial(_cases, flat, any_powers),
        Strength.GENERAL,
        f"row 2 before and after {units}a knot is inserted into {where} by Boehm's rule; {what}, every order, knots "
        "and base",
        proof=True,
        probe=partial(_probe, flat),
    )


def _probe(flat: bool, formula: Formula) -> tuple[Any, ...]:
    """Return the differences, the row of one point and the row itself at one rational point."""
    row = formula.relation
    right = (row.rhs - row.lhs + pr.P_2).subs({pr.P_0: pr.P_1} if flat else {})
    texts = [*(_written(right, change, flat) for change in ({}, *_CHANGES.values())), right.subs(_ONE_POINT)]
    texts += [] if flat else [_written(right, {}, flat)]
    symbols = sorted(set().union(*(text.free_symbols for text in texts)), key=str)
    at = {s: sp.Rational(sp.prime(n + 3), 101) for n, s in enumerate(_LETTERS)}
    at |= {s: sp.Rational(n + 2, 103) for n, s in enumerate(symbols) if s not in at}
    as_it_is, scaled, inserted, beyond, *others = (text.xreplace(at) for text in texts)
    return (scaled - as_it_is, inserted - as_it_is, beyond - as_it_is, *others)


def _cases(flat: bool, any_powers: bool, formula: Formula | None) -> Iterator[Case]:
    yield from premises(same_base_cases())
    row = given(formula).relation
    right = (row.rhs - row.lhs + pr.P_2).subs({pr.P_0: pr.P_1} if flat else {})
    for label in [_BEYOND] if any_powers else _CHANGES:
        residual = sp.cancel(_written(right, _CHANGES[label], flat) - _written(right, {}, flat))
        yield Case(label, bool(residual == 0), residual=sp.factor(residual))
    residual = sp.cancel(right.subs(_ONE_POINT) - _POINT)
    yield Case("all rows one point: row 2 is that point", bool(residual == 0), residual=residual)
    if not flat:
        yield next(iter(row_check("start", 2).cases(formula)))


def _written(expression: Any, change: dict[Any, Any], flat: bool) -> Any:
    """Return an expression for a base that is written anew, in the letters of how it was written before."""
    changed = expression.subs(change, simultaneous=True).subs(knots_as_spans("start"), simultaneous=True)
    return changed.subs(pr.R_1, pr.R_0) if flat else changed


@cache
def same_base_cases() -> tuple[Case, ...]:
    """Decide that the changes leave R_w times alpha^2, R_ww times alpha^4 and row 1 of the blend as they are."""
    found = []
    rows = sp.Matrix([pr.R_0, pr.R_1, pr.R_2])
    ends = end_derivatives(2, pr.k_r - 1, (_W_KR - pr.w_s, _W_KR1 - pr.w_s)) * rows
    for name, change in _CHANGES.items():
        for label, expression in (
            ("alpha^2 R_w", pr.alpha**2 * ends[1]),
            ("alpha^4 R_ww", pr.alpha**4 * ends[2]),
            ("row 1", pr.COND_2_1.relation.rhs),
        ):
            residual = sp.cancel(_written(expression, change, False) - _written(expression, {}, False))
            found.append(Case(f"{name}: {label} stays", bool(residual == 0), residual=residual))
    return tuple(found)


def one_surface_counterexample() -> Counterexample:
    """Return one base in two units, and with a knot inserted: row 2 along the normal, in each reading.

    The base has its first inner knots at 1 and 3 and R_2 at height 1 over the tangent plane; k = k_r = 4, u_1 = 1/4.
    """
    numbers = {pr.k: 4, pr.k_r: 4, BLEND_H[0]: sp.Rational(1, 4), pr.alpha: 1, pr.w_s: 0, _H1: 1, _H2: 3}
    numbers |= {pr.R_0: 0, pr.R_2: 1, pr.P_0: 0, pr.P_1: 0, _ROOT: 2, _PLACE: sp.Rational(1, 2), _PLACE_2: 2}
    told = []
    for formula in (pr.COND_3_1, pr.COND_3_1_SQUARES, pr.COND_3_1_ANY_POWERS):
        changes = [{}, _INSERTED_2] if pr.powers in formula.variables else [{}, *_CHANGES.values()]
        told.append(", ".join(str(_written(formula.relation.rhs, change, True).subs(numbers)) for change in changes))
    values = (
        *(("k = k_r", "4"), ("u_1", "1/4"), ("knots of R after w_s", "1, 3"), ("alpha", "1")),
        *(
            ("R_2 over the tangent plane", "1"),
            ("then", "w four times as large; or a knot inserted at 1/2; or one at 2"),
        ),
    )
    return Counterexample(
        values,
        f"height of P_2 {told[0]}; with squares {told[1]}; with any powers, as it is and with the knot at 2, {told[2]}",
        "one height for one base, written in four ways",
    )
