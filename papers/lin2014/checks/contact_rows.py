"""Deciding the contact conditions: a printed row against the row that Cox-de Boor and the chain rule give.

The oracle is `derivations.contact`; nothing printed enters it. Letters of the residuals: h_r is the distance from the
contact to the r-th knot of U after it, H_r the same of the base across the contact, a = alpha^2 or beta^2; for a
contact at u = 0, h_r = u_r, and for one at u = 1, h_r = 1 - u_(m-k+2-r).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial
from typing import Any, Literal

import sympy as sp

from semispline.derivations.contact import A, contact_rows, contact_rows_from_pieces
from semispline.derivations.splines import (
    end_derivative_step,
    end_derivatives,
    end_derivatives_from_pieces,
    span_symbols,
)
from semispline.papers.ledger import Case, Check, Formula, Meaning, Strength, given, interpret
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.printed import CUBIC

ORDERS = range(2, 9)

Side = Literal["start", "end"]
# What a row is compared in: all coordinates; these with alpha = beta = 1; or, as (16) asks, the one along the normal.
# There R_0 and R_1 are the same, since R_w, a multiple of R_1 - R_0, is tangent, and so are P_0 and P_1.
Mode = Literal["all", "parametric", "normal"]

# Symbols of corrected formulas that the paper does not print there.
u_last, u_before = sp.symbols("u_{m-k+1} u_{m-k}", positive=True)
w_kr1, t_ks1 = sp.symbols("w_{k_r+1} t_{k_s+1}", real=True)

# For which k the printed index m - 3 is that of the last inner knot, m - k + 1.
SAME_INDEX = sp.solve(pr.m - 3 - (pr.m - pr.k + 1), pr.k)

BLEND_H, BASE_H = span_symbols(3), span_symbols(2, "H")
ROWS = {"start": (pr.P_0, pr.P_1, pr.P_2), "end": (pr.P_m, pr.P_m1, pr.P_m2)}
BASE_ROWS = {"start": (pr.R_0, pr.R_1, pr.R_2), "end": (pr.S_0, pr.S_1, pr.S_2)}


@cache
def row_check(side: Side, row: int, mode: Mode = "all") -> Check:
    """Return the check of the condition for row 0, 1 or 2 counted from the contact at `side`."""
    return Check(
        partial(_row_cases, side, row, mode),
        Strength.GENERAL,
        ("what the row gives along the normal, against the one " if mode == "normal" else "the row ")
        + "from end derivatives and the chain rule for symbolic orders and knots, and from the Cox-de Boor "
        "pieces for each pair of orders from 2 to 8"
        + (", in each of which u_{m-3} is counted from the end" if side == "end" and row else ""),
        proof=True,
        probe=partial(_row_probe, side, mode),
    )


@cache
def tangent_check() -> Check:
    """Return the check that row m-1 joins S with G1: P_u a positive multiple of S_t, whichever; k at most 4."""
    exact = row_check("end", 1)

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield from (case for case in exact.cases(formula) if case.meets)
        for k in ORDERS:
            if k not in SAME_INDEX:
                yield _tangent_case(given(formula).relation, k)

    method = f"{exact.method}, k = 4; for other k the factor by which P_u is a multiple of S_t"
    return replace(exact, cases=cases, method=method)


def _tangent_case(relation: Any, k: int) -> Case:
    positive, whole = sp.Symbol("b", positive=True), sp.Symbol("n", integer=True, nonnegative=True)
    values = {pr.k: k, pr.k_s: whole + 2, pr.beta: positive, pr.t_ks: pr.t_s + BASE_H[0], pr.u_m3: _u_m3(k)}
    step = sp.expand(relation.rhs.subs(values) - pr.P_m)
    factor = step.coeff(pr.S_0)
    along = sp.simplify(step - factor * (pr.S_0 - pr.S_1)) == 0
    return Case(f"k = {k}", bool(along and sp.simplify(factor).is_positive), own=False, meets=k < CUBIC)


def derivative_check(surface: Literal["P", "R"], order: int) -> Check:
    """Return the check of an end derivative of the blend or of the base."""
    return Check(
        partial(_derivative_cases, surface, order),
        Strength.GENERAL,
        "end derivatives for a symbolic order (by induction from the recurrence), and those of the Cox-de Boor pieces "
        "for each order from 2 to 8, over symbolic knots",
        proof=True,
        probe=_derivative_probe,
    )


ONES = {pr.alpha: sp.Integer(1), pr.beta: sp.Integer(1)}
# Rational values without any relation between them, at which mutants are told apart.
_PROBE = {
    **dict(zip(BLEND_H, (sp.Rational(2, 17), sp.Rational(5, 19), sp.Rational(11, 23)), strict=True)),
    **dict(zip(BASE_H, (sp.Rational(7, 3), sp.Rational(31, 7)), strict=True)),
    **{pr.alpha: sp.Rational(13, 11), pr.beta: sp.Rational(13, 11)},
    **dict(zip(BASE_ROWS["start"] + BASE_ROWS["end"], map(sp.Integer, (3, 10, 29, 3, 10, 29)), strict=True)),
    **{pr.w_s: sp.Rational(5, 7), pr.t_s: sp.Rational(5, 7)},
}


def _row_probe(side: Side, mode: Mode, formula: Formula) -> tuple[Any, ...]:
    difference = formula.relation.lhs - formula.relation.rhs
    orders = ((4, 4), (5, 3), (3, 5))
    return tuple(difference.xreplace(_probe_values(side, mode, *pair)) for pair in orders)


@cache
def _probe_values(side: Side, mode: Mode, k: int, k_b: int) -> dict[Any, Any]:
    values = letter_values(side, k, k_b, rows_from_pieces(2, k - 1, k_b - 1, side), mode)
    probe = _PROBE | ONES if mode == "parametric" else _PROBE
    return probe | {symbol: sp.sympify(value).subs(probe) for symbol, value in values.items()}


def _row_cases(side: Side, row: int, mode: Mode, formula: Formula | None) -> Iterator[Case]:
    relation = given(formula).relation
    _require_induction(side)
    every, flat = _field_values(side, mode, 0, 0), mode == "normal"
    if not relation.has(pr.u_m3):
        yield _row_case(relation, side, "every order", every, own=True, meets=True, flat=flat)
    else:
        label = "every order of the base, and of the blend as if u_{m-3} were the last inner knot, as for k = 4 alone"
        yield _row_case(relation.xreplace({pr.u_m3: u_last}), side, label, every, own=False, meets=True, flat=flat)
    for k in ORDERS:
        for k_b in ORDERS:
            if k > row:
                values = _field_values(side, mode, k, k_b)
                own = k == CUBIC and k_b == CUBIC
                meets = k in SAME_INDEX
                yield _row_case(relation, side, f"orders {k}, {k_b}", values, own=own, meets=meets, flat=flat)


@cache
def _require_induction(side: Side) -> None:
    """Raise `ValueError` unless the closed form of end derivatives passes from every order to the next one."""
    step = end_derivative_step(2, side)
    if not step.is_zero_matrix:
        raise ValueError(f"end derivatives at the {side}: found the step {step}, expected zero")


def _row_case(
    relation: Any, side: Side, label: str, values: dict[Any, Any], *, own: bool, meets: bool, flat: bool
) -> Case:
    left, right = (interpret(x, Meaning(values)) for x in relation.args)
    difference = right - left
    if difference == 0:
        return Case(label, True, own, meets, sp.Integer(0))
    # In the paper's own setting the residual is shown, and should be readable.
    over, under = difference.numer.as_expr(), difference.denom.as_expr()
    shown = _by_differences(over, under, BASE_ROWS[side], flat=flat) if own else difference.as_expr()
    return Case(label, False, own, meets, shown)


@cache
def _field_values(side: Side, mode: Mode, k: int, k_b: int) -> dict[Any, Any]:
    """Return what each printed letter stands for, in a field of rational functions; order 0 means every order."""
    orders = (pr.k, base_order(side)) if not k else (k, k_b)
    matrix = (
        rows_from_pieces(min(2, k - 1), k - 1, k_b - 1, side)
        if k
        else contact_rows(2, pr.k - 1, BLEND_H, base_order(side) - 1, BASE_H)
    )
    values = letter_values(side, orders[0], orders[1], matrix, mode)
    letters = [*BLEND_H, *BASE_H, *BASE_ROWS[side], pr.alpha, pr.beta, pr.w_s, pr.t_s, pr.k, pr.k_r, pr.k_s]
    field = sp.QQ.frac_field(*letters)
    return {s: field.from_sympy(sp.sympify(x)) for s, x in ({s: s for s in letters} | values).items()}


def base_order(side: Side) -> Any:
    """Return k_r or k_s."""
    return pr.k_r if side == "start" else pr.k_s


@cache
def rows_from_pieces(order: int, degree: int, base_degree: int, side: Side) -> sp.Matrix:
    """Return the matrix of contact rows from the Cox-de Boor pieces, once."""
    return contact_rows_from_pieces(order, degree, base_degree, side)


def letter_values(side: Side, k: Any, k_b: Any, matrix: sp.Matrix, mode: Mode = "all") -> dict[Any, Any]:
    """Return what each printed letter stands for: knots as distances from the contact, blend rows by the oracle."""
    shape = sp.Integer(1) if mode == "parametric" else pr.alpha if side == "start" else pr.beta
    base = BASE_ROWS[side]
    rows = matrix.subs(A, shape**2) * sp.Matrix(base[: matrix.cols])
    values = dict(zip(ROWS[side], rows, strict=False)) | {base_order(side): sp.sympify(k_b), pr.k: sp.sympify(k)}
    if mode == "normal":
        flat = {base[1]: base[0]}
        values = {s: sp.expand(x.subs(flat)) for s, x in values.items()} | flat
    values |= knots_as_spans(side)
    if side == "end" and isinstance(k, int):
        values[pr.u_m3] = _u_m3(k)
    return values


def _u_m3(k: int) -> Any:
    """Return u_(m-3) from the end of the inner knots u_1 .. u_(m-k+1); past them the vector goes on with ones."""
    from_end = 5 - k
    return 1 - BLEND_H[from_end - 1] if from_end > 0 else sp.Integer(1)


def knots_as_spans(side: Side) -> dict[Any, Any]:
    """Return the knots next to a contact by their distances from it."""
    h, b = BLEND_H, BASE_H
    if side == "start":
        return {pr.u_1: h[0], pr.u_2: h[1], pr.w_kr: pr.w_s + b[0], w_kr1: pr.w_s + b[1]}
    return {u_last: 1 - h[0], u_before: 1 - h[1], pr.t_ks: pr.t_s + b[0], t_ks1: pr.t_s + b[1]}


def _derivative_cases(surface: Literal["P", "R"], order: int, formula: Formula | None) -> Iterator[Case]:
    relation = given(formula).relation
    is_blend = surface == "P"
    rows = (pr.P_0, pr.P_1, pr.P_2) if is_blend else (pr.R_0, pr.R_1, pr.R_2)
    k = pr.k if is_blend else pr.k_r
    h = span_symbols(2, "h" if is_blend else "H")
    knots = {pr.u_1: h[0], pr.u_2: h[1], pr.w_kr: pr.w_s + h[0], w_kr1: pr.w_s + h[1]}
    _require_induction("start")
    for number in (k, *ORDERS):
        if number is k:
            true = end_derivatives(2, k - 1, h)[order, :]
        else:
            pieces = end_derivatives_from_pieces(2, number - 1)[order, :]
            true = pieces.subs(dict(zip(span_symbols(2), h, strict=True)), simultaneous=True)
        right = relation.rhs.xreplace({k: sp.sympify(number), **knots})
        residual = difference_form(right - (true * sp.Matrix(rows))[0], rows)
        label = f"every order {k}" if number is k else f"order {number}"
        yield Case(label, residual == 0, number in (k, CUBIC), residual=residual)


def _derivative_probe(formula: Formula) -> tuple[Any, ...]:
    relation = formula.relation
    found = []
    for number in (3, 4, 5):
        values = _PROBE | {pr.u_1: _PROBE[BLEND_H[0]], pr.u_2: _PROBE[BLEND_H[1]], pr.k: number, pr.k_r: number}
        values |= {pr.w_kr: pr.w_s + _PROBE[BLEND_H[0]], w_kr1: pr.w_s + _PROBE[BLEND_H[1]]}
        values |= dict(zip(ROWS["start"], map(sp.Integer, (2, 7, 31)), strict=True))
        numbers = {s: sp.sympify(x).xreplace(_PROBE) for s, x in values.items()}
        # The derivative itself, on the left, stays a letter.
        found.append((relation.lhs - relation.rhs).xreplace(numbers))
    return tuple(found)


def difference_form(expression: Any, rows: tuple[Any, ...], *, flat: bool = False) -> Any:
    """Return an expression, linear in control rows, by differences of neighbouring rows and powers of alpha, beta.

    Each coefficient is factored, so that equal things look the same and zero is literally 0. With `flat` the first two
    rows are the same, and the second one does not occur.
    """
    numerator, denominator = sp.fraction(sp.together(expression))
    return _by_differences(numerator, denominator, rows, flat=flat)


def _by_differences(numerator: Any, denominator: Any, rows: tuple[Any, ...], *, flat: bool) -> Any:
    first, second, third = rows
    d1, d2 = sp.Symbol(f"({second}-{first})"), sp.Symbol(f"({third}-{second})")
    moved = {second: first + d1, third: first + d2 + (0 if flat else d1)}
    numerator, denominator = (part.subs(moved, simultaneous=True) for part in (numerator, denominator))
    generators = (first, d1, d2, pr.alpha, pr.beta)
    polynomial = sp.Poly(numerator, *generators)
    return sum(
        (sp.factor(coefficient / denominator) * sp.prod(x**n for x, n in zip(generators, powers, strict=True)))
        for powers, coefficient in polynomial.terms()
    )


def mirror_check(row: int) -> Check:
    """Return the check of (1.2), (2.2) or (3.2): the printed row at R, mirrored at u = 1/2 and with S for R."""
    at_r = (pr.COND_1_1, pr.COND_2_1, pr.COND_3_1)[row].relation
    names = dict(zip(ROWS["start"] + BASE_ROWS["start"], ROWS["end"] + BASE_ROWS["end"], strict=True))
    names |= {pr.alpha: pr.beta, pr.k_r: pr.k_s, pr.w_kr: pr.t_ks, pr.w_s: pr.t_s, pr.u_1: 1 - u_last}

    def cases(formula: Formula | None) -> Iterator[Case]:
        relation = given(formula).relation
        left, right = (side.xreplace(names) for side in at_r.args)
        for k in (pr.k, *range(max(row + 1, ORDERS[0]), ORDERS[-1] + 1)):
            every = k is pr.k
            last = {pr.u_m3: u_last} if every or k in SAME_INDEX else {}
            left_s, right_s = (side.xreplace(last) for side in relation.args)
            residual = sp.expand(((right_s - left_s) - (right - left)).subs(pr.k, k))
            # The last row, which is that of S, has no knot.
            meets = every or k in SAME_INDEX or row == 0
            label = "every k, as if u_{m-3} were the last inner knot, as for k = 4 alone" if every else f"k = {k}"
            yield Case(label, bool(residual == 0), own=k == CUBIC, meets=meets, residual=residual)

    return Check(
        cases,
        Strength.GENERAL,
        "the printed row at R, mirrored, and at S, for symbolic orders; for k = 2 to 8 with the printed index",
        proof=True,
    )
