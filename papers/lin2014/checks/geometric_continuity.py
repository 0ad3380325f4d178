"""Deciding (15) to (18): for any surfaces, against the chain rule, and by a judge that knows no parametrisation.

For any R and P with one curve in common, at a point of it: the tangent planes are one exactly if (15) has a solution
p_1, q_1 (linear algebra), and the second fundamental forms agree exactly if (16) has one too.

The judge holds an implicit equation F = 0 of the base. A surface P touches the base along u = 0 to order n if
F(P(u, v)) has no power of u up to n, and if P is regular there: a surface without a tangent plane has no contact to
speak of.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import sympy as sp

from semispline.derivations.contact import A, contact_conditions, special_conditions
from semispline.papers.ledger import (
    Case,
    Check,
    Counterexample,
    Formula,
    Strength,
    given,
    premises,
    smallest_assignment,
)
from semispline.papers.lin2014 import printed as pr

_U, _V, _W = sp.symbols("u v w")
_DERIVATIVES = {pr.R_w: (1, 0), pr.R_v: (0, 1), pr.R_ww: (2, 0), pr.R_wv: (1, 1), pr.R_vv: (0, 2)}
_FUNCTIONS = (pr.p_1, pr.q_1, pr.p_2, pr.q_2)


def general_check(order: int) -> Check:
    """Return the check of (15) for order 1, of (16) for order 2: the conditions with general functions of v."""
    return Check(
        partial(_general_cases, order),
        Strength.GENERAL,
        f"the chain rule of order {order} for P(u, v) = R(w(u, v), v~(u, v)); for any R and P with a common curve, "
        + ("tangent planes" if order == 1 else "second fundamental forms")
        + " and the solution for p_i, q_i where they agree; instances judged by the implicit equation of the base and "
        "by the regularity of P",
        proof=True,
    )


def special_check(order: int) -> Check:
    """Return the check of (17) for order 1, of (18) for order 2: a blend that leaves the base backwards."""
    return Check(
        partial(_special_cases, order),
        Strength.GENERAL,
        "the chain rule with p_1 = -alpha^2, since w falls where u grows",
        proof=True,
    )


def special_counterexample(order: int, formula: Formula) -> Counterexample | None:
    """Search for the smallest alpha and base derivative at which (17) or (18) is not the condition of the join."""
    base = pr.R_w if order == 1 else pr.R_ww
    true = special_conditions(order)[order].subs({A: pr.alpha**2, sp.Symbol(base.name): base})
    right = formula.relation.rhs
    found = smallest_assignment([pr.alpha, base], lambda at: (right - true).subs(at) != 0)
    if found is None:
        return None
    values = tuple((str(s), str(x)) for s, x in found.items())
    return Counterexample(values, str(right.subs(found)), str(true.subs(found)))


def _special_cases(order: int, formula: Formula | None) -> Iterator[Case]:
    base = pr.R_w if order == 1 else pr.R_ww
    true = special_conditions(order)[order].subs({A: pr.alpha**2, sp.Symbol(base.name): base})
    left, right = _sides(formula, pr.P_u if order == 1 else pr.P_uu)
    residual = sp.factor(right - left - true)
    yield Case(f"every alpha and R_{'w' * order}", residual == 0, residual=residual)


def _sides(formula: Formula | None, subject: Any) -> tuple[Any, Any]:
    """Return what the left side has besides the subject, and the right side."""
    relation = given(formula).relation
    return relation.lhs - subject, relation.rhs


def _general_cases(order: int, formula: Formula | None) -> Iterator[Case]:
    subject = pr.P_u if order == 1 else pr.P_uu
    left, right = _sides(formula, subject)
    residual = sp.expand(right - left - _chain_rule(order))
    yield Case("chain rule, all p_i, q_i", residual == 0, residual=residual)
    if order == 2:
        yield from first_order_cases(pr.EQ_15.relation.rhs)
    yield from (first_order_cases if order == 1 else second_order_cases)(right)
    for label, base, implicit, functions, meets in _instances():
        patch = _patch(order, base, functions, right)
        touches = _touches(patch, implicit, order)
        regular = _regular(patch)
        yield Case(label, touches and regular, own=meets, meets=meets)
    if order == 1:
        yield _singular_case()


def _chain_rule(order: int) -> Any:
    """Return the derivative of the last order along the contact, in the paper's letters."""
    names = {sp.Symbol(str(s)): s for s in _DERIVATIVES}
    names |= {sp.Symbol(str(s).replace("_", "")): s for s in _FUNCTIONS}
    return contact_conditions(order)[order].xreplace(names)


def _vector(name: str) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_x:z"))


# Any derivatives of the base at a point of the contact.
_ANY = {letter: _vector(str(letter)) for letter in _DERIVATIVES}
_NORMAL = _ANY[pr.R_w].cross(_ANY[pr.R_v])


def _as_vector(expression: Any) -> sp.Matrix:
    """Return a combination of derivatives of R, coordinate by coordinate."""
    return sp.Matrix([expression.xreplace({s: vector[c] for s, vector in _ANY.items()}) for c in range(3)])


def tangent_coordinates(vector: sp.Matrix) -> tuple[Any, Any]:
    """Return p and q of the part p R_w + q R_v of any vector within the tangent plane of a regular R."""
    square = _NORMAL.dot(_NORMAL)
    return vector.cross(_ANY[pr.R_v]).dot(_NORMAL) / square, _ANY[pr.R_w].cross(vector).dot(_NORMAL) / square


def _vanishes(label: str, vector: sp.Matrix) -> Case:
    """Decide whether a vector of rational functions is zero; the residual is its product with any other one."""
    residual = sum((sp.cancel(x) * e for x, e in zip(vector, sp.symbols("e_1:4"), strict=True)), sp.Integer(0))
    return Case(label, bool(residual == 0), residual=residual)


def first_order_cases(right: Any) -> Iterator[Case]:
    """Yield that P_u = `right` for some p_1, q_1 exactly if the tangent planes are one, for any R and P.

    P_v = R_v, for the curve is common. Where N = R_w x R_v and P_u x P_v are multiples of each other P_u is tangent to
    R; so it is the sum of its parts along R_w and R_v, which are functions of v, and its normal part, which is zero.
    """
    normal = _as_vector(right).cross(_ANY[pr.R_v])
    yield _vanishes("sufficiency, any R and P: P_u x P_v = p_1 R_w x R_v", normal - pr.p_1 * _NORMAL)
    any_slope = _vector("P_u")
    solution = dict(zip((pr.p_1, pr.q_1), tangent_coordinates(any_slope), strict=True))
    rest = any_slope - _as_vector(right).subs(solution, simultaneous=True)
    part = any_slope.dot(_NORMAL) / _NORMAL.dot(_NORMAL) * _NORMAL
    yield _vanishes("necessity, any R and P: some p_1, q_1 leave the normal part of P_u alone", rest - part)


def second_order_cases(right: Any) -> Iterator[Case]:
    """Yield that P_uu = `right` for some p_2, q_2 exactly if curvatures agree, for any R and P that satisfy (15).

    The direction (du, dv) of P is the direction (p_1 du, q_1 du + dv) of R. Along the curve P_vv = R_vv, and P_uv is
    the derivative of (15) by v. So the second fundamental forms, with one normal N, differ in du^2 alone.
    """
    du, dv = sp.symbols("du dv")
    any_second = _vector("P_uu")
    slope, mixed = _slope_and_mixed()
    across, along = pr.p_1 * du, pr.q_1 * du + dv
    direction = slope * du + _ANY[pr.R_v] * dv - across * _ANY[pr.R_w] - along * _ANY[pr.R_v]
    yield _vanishes("any R and P: one direction in both parametrisations", direction)
    of_p = any_second * du**2 + 2 * mixed * du * dv + _ANY[pr.R_vv] * dv**2
    of_r = _ANY[pr.R_ww] * across**2 + 2 * _ANY[pr.R_wv] * across * along + _ANY[pr.R_vv] * along**2
    difference = sp.expand((of_p - of_r).dot(_NORMAL))
    seconds = _as_vector(_chain_rule(2).subs({pr.p_2: 0, pr.q_2: 0}))
    excess = (any_second - seconds).dot(_NORMAL)
    residual = sp.expand(difference - excess * du**2)
    label = "any R and P: the second fundamental forms differ by the normal part of P_uu"
    yield Case(label, bool(residual == 0), residual=residual)
    residual = sp.expand(difference.subs(dict(zip(any_second, _as_vector(right), strict=True)), simultaneous=True))
    yield Case("sufficiency, any R and P: the forms agree", bool(residual == 0), residual=residual)
    free = _vector("X")
    solution = dict(zip((pr.p_2, pr.q_2), tangent_coordinates(free), strict=True))
    rest = seconds + free - _as_vector(right).subs(solution, simultaneous=True)
    part = free.dot(_NORMAL) / _NORMAL.dot(_NORMAL) * _NORMAL
    yield _vanishes("necessity, any R and P: some p_2, q_2 leave the normal part of P_uu alone", rest - part)


@cache
def _slope_and_mixed() -> tuple[sp.Matrix, sp.Matrix]:
    """Return P_u by (15) and its derivative along the contact, which is P_uv."""
    functions = [sp.Function(name)(_W, _V) for name in "xyz"]
    values = {f.diff(_W, i, _V, j): _ANY[s][c] for c, f in enumerate(functions) for s, (i, j) in _DERIVATIVES.items()}
    p, q = (sp.Function(name)(_V) for name in "pq")
    values |= {p.diff(_V): sp.Symbol("p_1'"), q.diff(_V): sp.Symbol("q_1'")}
    letters = {pr.p_1: p, pr.q_1: q}
    right = pr.EQ_15.relation.rhs
    slope = sp.Matrix([right.xreplace({pr.R_w: f.diff(_W), pr.R_v: f.diff(_V), **letters}) for f in functions])
    back = {p: pr.p_1, q: pr.q_1}
    return tuple(x.xreplace(values).xreplace(back) for x in (slope, slope.diff(_V)))


def special_contact_cases(order: int, sign: int = -1) -> Iterator[Case]:
    """Yield that P_u = -alpha^2 R_w, and P_uu = alpha^4 R_ww, are contact of an order, any regular R, alpha not 0.

    With `sign` 1 for P_u = alpha^2 R_w: tangent planes alone do not tell the two apart.
    """
    chosen = {pr.p_1: sign * pr.alpha**2, pr.q_1: 0, pr.p_2: 0, pr.q_2: 0}
    for n in range(1, order + 1):
        printed = (pr.EQ_15, pr.EQ_16)[n - 1].relation.rhs.subs(chosen)
        true = (
            special_conditions(n)[n].xreplace({sp.Symbol(str(s)): s for s in _DERIVATIVES}).subs(A, -sign * pr.alpha**2)
        )
        residual = sp.expand(printed - true)
        yield Case(f"the condition of order {n} with p_1 = {sign} alpha^2", bool(residual == 0), residual=residual)
    yield from first_order_cases(pr.EQ_15.relation.rhs)
    if order == 2:
        yield from second_order_cases(pr.EQ_16.relation.rhs)


def _singular_case() -> Case:
    """Decide a plane (w^2, v, 0), continued smoothly by (-u, v, 0): no p_1, q_1 give its P_u where R_w = 0."""
    span = sp.Matrix([_W**2, _V, 0]).jacobian([_W, _V]).subs(_W, 0)
    exists = span.rank() == span.row_join(sp.Matrix([-1, 0, 0])).rank()
    return Case("necessity, the plane as (w^2, v, 0)", exists, own=False, meets=False)


def shape_parameter_cases(order: int, sign: int = -1) -> Iterator[Case]:
    """Yield why P_u = -alpha^2 R_w (and P_uu = alpha^4 R_ww) is contact of that order, and values of alpha."""
    yield from premises(special_contact_cases(order, sign))
    _, base, implicit, _, _ = next(_instances())
    condition = {1: pr.p_1 * pr.R_w, 2: pr.p_1**2 * pr.R_ww}[order]
    for alpha in (sp.Integer(1), sp.Rational(1, 2), sp.Integer(-2), sp.Integer(0)):
        functions = {pr.p_1: sign * alpha**2, pr.q_1: sp.Integer(0)}
        patch = _patch(order, base, functions, condition)
        true = _touches(patch, implicit, order) and _regular(patch)
        yield Case(f"alpha = {alpha}", true, own=alpha != 0, meets=alpha != 0)
    singular, flat = sp.Matrix([_W**2, _V, 0]), sp.Symbol("z")
    patch = _patch(order, singular, {pr.p_1: sp.Integer(-1), pr.q_1: sp.Integer(0)}, condition)
    true = _touches(patch, flat, order) and _regular(patch)
    yield Case("alpha = 1, a base with R_w = 0 on the contact", true, own=False, meets=False)


def tangent_plane_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (17) as tangent planes see it: (15) with p_1 = alpha^2, and for which alpha and bases the planes agree."""
    yield from premises(substitution_cases(1, formula))
    yield from shape_parameter_cases(1, 1)


def join_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (17) as a join: the blend goes on from the base, on the other side of the contact.

    R lies where w >= w_s and P where u >= 0. In the tangent plane, n = R_w less its part along the contact points into
    R, and P_u into P; so they lie on two sides exactly if P_u . n < 0, which is p_1 n . n, whatever q_1 is.
    """
    r_w, r_v = _ANY[pr.R_w], _ANY[pr.R_v]
    inwards = r_w - r_w.dot(r_v) / r_v.dot(r_v) * r_v
    side = sp.cancel((pr.p_1 * r_w + pr.q_1 * r_v).dot(inwards) - pr.p_1 * inwards.dot(inwards))
    yield from premises([Case("P_u . n = p_1 n . n, any R, p_1 and q_1", bool(side == 0), residual=side)])
    left, right = _sides(formula, pr.P_u)
    residual = sp.factor(right - left + pr.alpha**2 * pr.R_w)
    yield Case("p_1 = -alpha^2, the one of both signs with p_1 < 0", bool(residual == 0), residual=residual)
    _, base, _, _, _ = next(_instances())
    patch = _patch(1, base, {}, (right - left).subs(pr.alpha, sp.Rational(2, 3)))
    # This base lies over x >= 0 near the contact, which lies over x = 0.
    beyond = [patch[0].subs({_U: sp.Rational(1, 50), _V: v}) for v in (0, sp.Rational(1, 2), 1)]
    yield Case("a bent base over x >= 0, alpha = 2/3: the blend lies over x < 0", all(x < 0 for x in beyond))


def substitution_cases(order: int, formula: Formula | None) -> Iterator[Case]:
    """Decide whether p_1 = alpha^2, q_1 = p_2 = q_2 = 0 turns (15) and (16) into (17) and (18), as algebra."""
    _, right = _sides(formula, pr.P_u if order == 1 else pr.P_uu)
    general = (pr.EQ_15 if order == 1 else pr.EQ_16).relation.rhs
    chosen = general.subs({pr.p_1: pr.alpha**2, pr.q_1: 0, pr.p_2: 0, pr.q_2: 0})
    residual = sp.expand(right - chosen)
    yield Case("all alpha", residual == 0, residual=residual)


@cache
def _derived_row(order: int) -> tuple[Any, Any]:
    """Return the row, and what (17) or (18) and the end derivatives make of it, all as printed."""
    condition, of_p, of_r, base, row = (
        (pr.EQ_17, pr.APP_D1_P, pr.APP_D1_R, pr.R_w, pr.P_1)
        if order == 1
        else (pr.EQ_18, pr.APP_D2_P, pr.APP_D2_R, pr.R_ww, pr.P_2)
    )
    target = condition.relation.rhs.subs(base, of_r.relation.rhs)
    (solution,) = sp.solve(of_p.relation.rhs - target, row)
    return row, solution


def derived_row_cases(order: int, formula: Formula | None) -> Iterator[Case]:
    """Decide whether (17) or (18) and the end derivatives as printed give the row condition as printed, as algebra."""
    row, solution = _derived_row(order)
    left, right = _sides(formula, row)
    residual = sp.factor(right - left - solution)
    yield Case(f"solved for {row}", residual == 0, residual=residual)


def derived_row_probe(order: int, formula: Formula) -> Any:
    """Return the same difference at one rational point."""
    row, solution = _derived_row(order)
    difference = formula.relation.rhs - formula.relation.lhs + row - solution
    # Distinct primes over another prime: no relation between them.
    symbols = sorted(difference.free_symbols | set(formula.variables), key=str)
    return difference.xreplace({s: sp.Rational(sp.prime(n + 3), 101) for n, s in enumerate(symbols)})


def _instances() -> Iterator[tuple[str, sp.Matrix, Any, dict[Any, Any], bool]]:
    """Yield label, base, its implicit equation, functions of v, and whether p_1 has no zero and R is regular."""
    third, half = sp.Rational(1, 3), sp.Rational(1, 2)
    x, y, z = sp.symbols("x y z")
    height = x**2 - x * y / 2 + y**3 / 3 + y / 7
    across, along = _W + third * _W**2 + half * _W * _V, _V + _W**2 / 5 + third * _V**2
    base = sp.Matrix([across, along, height.subs({x: across, y: along})])
    implicit = z - height
    choices = [
        ("p_1 = -1", (-1, 0, 0, 0), True),
        ("p_1 = -2/3, q_1 = 1/2, p_2 = 1, q_2 = -1/3", (-2 * third, half, 1, -third), True),
        ("p_1 = 1: a fold, but of one tangent plane", (1, 0, 0, 0), True),
        ("p_1 = -1-v, q_1 = v, p_2 = v^2, q_2 = 1-v", (-1 - _V, _V, _V**2, 1 - _V), True),
        ("p_1 = 0, the rest zero", (0, 0, 0, 0), False),
        ("p_1 = 0, q_1 = 1", (0, 1, 0, 0), False),
        ("p_1 = v - 1/2, zero at one point", (_V - half, 0, 0, 0), False),
    ]
    for label, values, meets in choices:
        yield label, base, implicit, dict(zip(_FUNCTIONS, values, strict=True)), meets
    flat = sp.Matrix([_W**2, _V, 0])
    yield "R_w = 0 on the contact", flat, z, dict(zip(_FUNCTIONS, (-1, 0, 0, 0), strict=True)), False


def _patch(order: int, base: sp.Matrix, functions: dict[Any, Any], condition: Any) -> sp.Matrix:
    """Return C(v) + u P_u + u^2/2 P_uu with the last derivative by the condition, those below by the chain rule."""
    derivatives = {s: sp.diff(base, _W, i, _V, j).subs(_W, 0) for s, (i, j) in _DERIVATIVES.items()}
    patch = base.subs(_W, 0)
    if order == 2:
        first = functions[pr.p_1] * derivatives[pr.R_w] + functions[pr.q_1] * derivatives[pr.R_v]
        patch = patch + _U * first
    last = sp.zeros(3, 1)
    for s, vector in derivatives.items():
        last += sp.sympify(condition).coeff(s).subs(functions) * vector
    return patch + _U**order / sp.factorial(order) * last


def _touches(patch: sp.Matrix, implicit: Any, order: int) -> bool:
    x, y, z = sp.symbols("x y z")
    along = sp.Poly(implicit.subs(dict(zip((x, y, z), patch, strict=True)), simultaneous=True), _U, _V)
    return all(powers[0] > order for powers, _ in along.terms() if along != 0)


def _regular(patch: sp.Matrix) -> bool:
    """Whether P_u and P_v are independent at u = 0 for eleven rational v over [0, 1], 1/2 among them."""
    normal = patch.diff(_U).subs(_U, 0).cross(patch.diff(_V).subs(_U, 0))
    return all(any(normal.subs(_V, sp.Rational(i, 10))) for i in range(11))
