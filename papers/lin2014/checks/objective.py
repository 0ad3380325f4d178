"""Deciding what sections 3 and 4 say of the objective for every order, knot vector and count.

The degree after substitution, whether there is one minimum, what each entry of the system is, and contact in terms of
tangent vectors. `energy` runs the same at exact instances.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.contact import A, contact_rows
from semispline.derivations.energy import SECOND_DERIVATIVES, stationarity_condition, thin_plate_density
from semispline.derivations.shape import total_degrees
from semispline.derivations.splines import end_derivative_step, end_derivatives, span_symbols
from semispline.papers.checks import coefficient, identity_cases
from semispline.papers.ledger import (
    Case,
    Check,
    Formula,
    Meaning,
    Strength,
    difference_case,
    given,
    premises,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import energy, geometric_continuity

# One row of (14): blocks A and B, unknown X and known N control points.
A_BLOCK, B_BLOCK, X_FREE, N_KNOWN = (sp.IndexedBase(name) for name in "ABXN")
ROW, LAST_FREE, LAST_KNOWN = (sp.Symbol(name, integer=True) for name in ("r", "p", "q"))
# Derivatives 0 .. 2 of the functions of u (N) and of v (B) of two control points.
_N, _B = ([sp.symbols(f"{letter}_0:3"), sp.symbols(f"{letter}'_0:3")] for letter in "NB")


@cache
def gram_integrand() -> Any:
    """Return what is integrated for the entry of two control points: half the mixed second derivative of (11).

    P = x N B + y N' B' for one coordinate, each factor a function of u or of v alone.
    """
    x, y = sp.symbols("x y")
    orders = ((2, 0), (1, 1), (0, 2))
    values = [sum(p * n[du] * b[dv] for p, n, b in zip((x, y), _N, _B, strict=True)) for du, dv in orders]
    density = thin_plate_density().subs(dict(zip(SECOND_DERIVATIVES, values, strict=True)), simultaneous=True)
    return sp.expand(sp.diff(density, x, y) / 2)


def gram_entry_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (14) for any two control points, then on the printed knots of Fig. 5.

    Each term of the integrand is a function of u times one of v, so that its integral is a product A_d G_e (Fubini).
    Letters of single integrals stand for themselves: no product of them is an integral of products.
    """
    relation = given(formula).relation
    n, b = _N, _B
    of_u = {pr.A_0: n[0][0] * n[1][0], pr.A_1: n[0][1] * n[1][1], pr.A_2: n[0][2] * n[1][2], pr.A_10: n[0][1] * n[1][0]}
    of_v = {pr.G_0: b[0][0] * b[1][0], pr.G_1: b[0][1] * b[1][1], pr.G_2: b[0][2] * b[1][2], pr.G_12: b[0][1] * b[1][2]}
    difference = sp.expand((relation.rhs - relation.lhs + pr.K).subs(of_u | of_v, simultaneous=True) - gram_integrand())
    names = {product: letter for letters in (of_u, of_v) for letter, product in letters.items()}
    residual = difference.subs(names)
    yield Case("any two basis functions of any orders and knots", bool(residual == 0), residual=residual)
    yield from energy.gram_entry_cases(formula)


GRAM_CHECK = Check(
    gram_entry_cases,
    Strength.GENERAL,
    "the mixed second derivative of (11) by two control points with abstract basis functions, integrated term by term "
    "(Fubini); and entries of the exact energy, bicubic, printed knots of Fig. 5",
    proof=True,
)


def integrals_vanish_cases() -> Iterator[Case]:
    """Yield that B_i' and B_i'' of a row away from both ends integrate to zero, so that a_ij = c_ij = 0.

    The integral of a derivative is the difference of end values; at a clamped end values see row 0 alone and first
    derivatives rows 0 and 1 alone, for every order.
    """
    ends = end_derivatives(2, pr.k - 1, span_symbols(2))
    inner = [ends[0, 1], ends[0, 2], ends[1, 2], *end_derivative_step(2)[:2, :]]
    yield Case("every order and knots: end values of inner rows", all(entry == 0 for entry in inner))
    yield from energy.integrals_vanish_cases()


def zero_system_cases() -> Iterator[Case]:
    """Yield what (14) needs of A as printed: that it is not zero, since a_ij = c_ij = 0 for every free row."""
    free = {pr.a_1: 0, pr.a_2: 0, pr.c_1: 0, pr.c_2: 0}
    entry = pr.EQ_14.relation.rhs.subs(free)
    yield Case(f"every entry of A where a_ij = c_ij = 0: {entry}", bool(entry != 0))
    matrix, _ = energy.printed_system()
    yield Case(f"{matrix.rows} unknown control points, rank {matrix.rank()}", bool(matrix.rank() == matrix.rows))


def unique_minimum_cases(order: int) -> Iterator[Case]:
    """Yield why the free rows have just one minimum, and blends in which they have."""
    yield from premises(_positive_cases())
    yield from energy.positive_definite_cases(order)


def _positive_cases() -> Iterator[Case]:
    """Yield why the free rows have just one minimum, for every k >= 3, every m and all knots of a C1 blend.

    The energy is a sum of integrals of squares. Let it vanish for some free rows, the others zero. Then P_uu = 0, so
    that on each v-line P is linear on each span of u, and, as two lines that meet with one slope are one line, linear
    in u; rows 0 and 1 are zero, so P and P_u vanish at u = 0; hence P = 0, and with it every control point, for basis
    functions are independent. So the quadratic form of the free rows is positive definite.
    """
    yield _square_case()
    ends = end_derivatives(1, pr.k - 1, span_symbols(1))
    above = sp.Symbol("r", integer=True, nonnegative=True)
    determinant = sp.factor(ends.det().subs(pr.k, 2 + above))
    step = end_derivative_step(1).is_zero_matrix
    yield Case("P and P_u at u = 0 determine rows 0 and 1", bool(determinant.is_positive and step))
    yield _line_case()


def _square_case() -> Case:
    hessian = sp.hessian(thin_plate_density(), SECOND_DERIVATIVES)
    positive = all(entry > 0 for entry in hessian.diagonal())
    return Case("(11) is a sum of squares", bool(hessian.is_diagonal() and positive))


def minimum_check(order: int) -> Check:
    """Return the check that the free rows of a blend with C1 or C2 contact have exactly one minimum."""
    return Check(
        lambda _: unique_minimum_cases(order),
        Strength.GENERAL,
        "a blend of zero energy with zero contact rows is zero, for every order, knots and number of rows; pivots of "
        "the exact energy matrix for k = 4",
        proof=True,
    )


def normal_equation_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide A X = -B N in row r: the stationarity condition, its control points sorted into free and known ones."""
    relation = given(formula).relation
    place = sp.Symbol("a", integer=True, nonnegative=True)
    condition = stationarity_condition()
    matrix, points = sp.IndexedBase("K"), sp.IndexedBase("P")
    last = condition.limits[0][2]
    factor = coefficient(condition, points[place])
    for label, printed, unit, block, count in (
        ("factor of a free control point", relation.lhs, X_FREE, A_BLOCK, LAST_FREE),
        ("factor of a known control point", -relation.rhs, N_KNOWN, B_BLOCK, LAST_KNOWN),
    ):
        true = factor.subs(last, count).subs(matrix[ROW, place], block[ROW, place])
        residual = sp.expand(coefficient(sp.expand(printed), unit[place]) - true)
        yield Case(f"{label}, every count", bool(residual == 0), residual=residual)


NORMAL_EQUATION_CHECK = Check(
    normal_equation_cases,
    Strength.GENERAL,
    "the derivative of the quadratic form by free control point r, for every count",
    proof=True,
)


def degree_check(order: int, geometric: bool) -> Check:
    """Return the check of the degree of the objective after substitution of contact of an order.

    For G2 it is the rows as printed, too; both where the base is not flat across the contact, and where it is.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        rows = {("derived rows", "R_ww = S_tt = 0"): _derived_rows(order)}
        if geometric:
            rows["printed rows", "second differences zero at both contacts"] = _printed_rows(order)
        bases = (False, True) if geometric and order == 2 else (False,)
        for (name, flatness), (column, flat_base) in rows.items():
            for flat in bases:
                value = objective_degree([x.subs(flat_base) for x in column] if flat else column, geometric)
                label = f"every order, knots and count, {name}" + f", {flatness}" * flat
                meaning = Meaning({pr.degree: value})
                yield difference_case(given(formula), label, meaning, own=not flat, meets=not flat)
        for flat in bases:
            instance = energy.substituted(order, geometric, flat=flat).total_degree()
            label = "k = 4, one middle curve, a strip" + ", R_ww = S_tt = 0" * flat
            meaning = Meaning({pr.degree: instance})
            yield difference_case(given(formula), label, meaning, own=not flat, meets=not flat)

    return Check(
        cases,
        Strength.GENERAL,
        "the degree of the rows in alpha and beta for symbolic orders and knots, put into the quadratic form; the term "
        "of highest degree is an energy, not zero; the exact energy of a strip, k = 4",
        proof=True,
    )


_FIRST_ROWS = (pr.R_0, pr.R_1, pr.R_2)


@cache
def _derived_rows(order: int) -> tuple[list[Any], dict[Any, Any]]:
    """Return rows 0 .. n that contact with R sets, and the R_2 for which R_ww = 0."""
    base_spans = span_symbols(2, "H")
    rows = contact_rows(order, pr.k - 1, span_symbols(order), pr.k_r - 1, base_spans[:order]).subs(A, pr.alpha**2)
    second = end_derivatives(2, pr.k_r - 1, base_spans)[2, :] * sp.Matrix(_FIRST_ROWS)
    (flat,) = sp.solve(second[0], pr.R_2)
    return list(rows * sp.Matrix(_FIRST_ROWS[: order + 1])), {pr.R_2: flat}


@cache
def _printed_rows(order: int) -> tuple[list[Any], dict[Any, Any]]:
    """Return the rows by (1.1), (2.1), (3.1) as printed, and the R_2 for which their second difference is zero."""
    values: dict[Any, Any] = {}
    for condition in (pr.COND_1_1, pr.COND_2_1, pr.COND_3_1)[: order + 1]:
        values[condition.relation.lhs] = condition.relation.rhs.subs(values)
    return list(values.values()), {pr.R_2: 2 * pr.R_1 - pr.R_0}


def objective_degree(rows: list[Any], geometric: bool) -> int:
    """Return the degree of (11) in free control points, alpha and beta, for every order, knots and count.

    (11) is quadratic in second derivatives, which are linear in control points, as (1) is. Let alpha^d be the highest
    power in the rows next to u = 0, as a factor of a sum of N_0 .. N_2 times curves. The coefficient of alpha^(2d) is
    the energy of that sum. It is not zero: a sum of zero energy is linear in u on each v-line, and at u = 1 it vanishes
    with its slope, so that it is zero itself. With beta it is the same.
    """
    in_points = int(thin_plate_density().as_poly(*SECOND_DERIVATIVES).total_degree())
    point = pr.P[sp.symbols("a b", integer=True)]
    if coefficient(pr.EQ_1.relation.rhs, point).has(pr.P):
        raise ValueError(f"surface: found a factor of {point} with control points in it, expected a linear surface")
    if not geometric:
        return in_points
    # alpha and beta stand in the rows by their squares alone.
    power = max(sp.Poly(sp.numer(sp.together(row)), pr.alpha).degree() for row in rows) // 2
    return int(max(in_points, total_degrees(power, power)[1]))


def shape_minimum_cases() -> Iterator[Case]:
    """Yield why (11) has a least value over alpha and beta, and which of them make a G1 blend; then plates.

    Rows 1 and 2 are polynomials in a = alpha^2, the last two such in b = beta^2, and a moves row 1 by a multiple of
    R_w. So the control points move in a space of rows 1 .. m-1, rows 0 and m staying where they are. There the energy
    is positive definite: a surface of zero energy is linear in u on each v-line, and is zero where it vanishes at u = 0
    and u = 1. As a, b or a free control point grow beyond every bound, so do the control points, and with them the
    energy, of any two regular bases. So it takes its least value on the closed set a, b >= 0; where that has a, b > 0
    the blend is G1.
    """
    yield from premises([*geometric_continuity.special_contact_cases(2), _square_case(), _line_case(), _chord_case()])
    yield _row_1_case()
    yield from energy.shape_cases()


def _chord_case() -> Case:
    """Decide that a line which is 0 at u = 0 and u = 1 is zero, and that rows 0 and m alone enter these values."""
    a, b, u = sp.symbols("a b u")
    line = a + b * u
    zero = sp.solve([line.subs(u, 0), line.subs(u, 1)], [a, b], dict=True) == [{a: 0, b: 0}]
    values = end_derivatives(1, pr.k - 1, span_symbols(1))[0, :]
    alone = values == sp.Matrix([[1, 0]]) and end_derivative_step(1)[0, :].is_zero_matrix
    return Case("a line that is zero at both ends is zero; rows 0 and m are the ends", bool(zero and alone))


def _row_1_case() -> Case:
    """Decide that row 1 is R_0 - c alpha^2 R_w, c positive for every order and knots."""
    h, base_h = span_symbols(1), span_symbols(1, "H")
    row = (contact_rows(1, pr.k - 1, h, pr.k_r - 1, base_h) * sp.Matrix([pr.R_0, pr.R_1]))[1]
    slope = (end_derivatives(1, pr.k_r - 1, base_h)[1, :] * sp.Matrix([pr.R_0, pr.R_1]))[0]
    factor = sp.cancel((pr.R_0 - row) / (A * slope))
    over = sp.Symbol("r", integer=True, nonnegative=True)
    label = "any regular bases, every order and knots: row 1 is R_0 - c alpha^2 R_w, c > 0"
    return Case(label, bool(factor.subs(pr.k, 2 + over).is_positive))


SHAPE_CHECK = Check(
    lambda _: shape_minimum_cases(),
    Strength.GENERAL,
    "why there is a least energy, and that it is that of a G1 blend where alpha, beta are not zero, for any regular "
    "bases, every order and knots; plates, the energy an exact polynomial in alpha^2, beta^2",
    proof=True,
)


def crease_cases() -> Iterator[Case]:
    """Yield why zero energy means no bend for C1 splines of every order, and strips with and without a crease.

    The integral of a square vanishes only where the function does, so that a strip of zero energy is a line on each
    span; across a knot of multiplicity r < p it is C^(p-r), so at least C1.
    """
    yield from premises([*identity_cases("continuity"), _line_case()])
    yield from energy.crease_cases()


def _line_case() -> Case:
    """Decide that lines a + b x and c + d x which meet at a knot with one slope are one."""
    x, knot = sp.symbols("x h")
    a, b, c, d = sp.symbols("a b c d")
    difference = a + b * x - c - d * x
    same = sp.solve([difference.subs(x, knot), difference.diff(x)], [a, b], dict=True)
    return Case("lines that meet with one slope are one", same == [{a: c, b: d}])


def tangential_cases() -> Iterator[Case]:
    """Yield that tangential parts of second derivatives are made of derivatives of E, F, G, for any surface."""
    u, v = sp.symbols("u v", real=True)
    surface = sp.Matrix([sp.Function(name)(u, v) for name in "xyz"])
    s_u, s_v = surface.diff(u), surface.diff(v)
    E, F, G = s_u.dot(s_u), s_u.dot(s_v), s_v.dot(s_v)
    parts = {
        "P_uu . P_u": s_u.diff(u).dot(s_u) - E.diff(u) / 2,
        "P_uu . P_v": s_u.diff(u).dot(s_v) - F.diff(u) + E.diff(v) / 2,
        "P_uv . P_u": s_u.diff(v).dot(s_u) - E.diff(v) / 2,
        "P_uv . P_v": s_u.diff(v).dot(s_v) - G.diff(u) / 2,
        "P_vv . P_u": s_v.diff(v).dot(s_u) - F.diff(v) + G.diff(u) / 2,
        "P_vv . P_v": s_v.diff(v).dot(s_v) - G.diff(v) / 2,
    }
    for name, residual in parts.items():
        yield Case(name, bool(sp.expand(residual) == 0))


def density_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the integrand of (11): the squared curvatures where lengths and angles are kept; rotation of (u, v)."""
    right = given(formula).relation.rhs
    yield from isometric_cases(Formula(sp.Eq(pr.kappa_1**2 + pr.kappa_2**2, right, evaluate=False), ()))
    yield from energy.density_cases(formula)


def isometric_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide that the integrand of (11) is k1^2 + k2^2 for every parametrisation that keeps lengths and angles.

    With E = G = 1, F = 0 second derivatives are normal and are the entries of the shape operator, whose eigenvalues the
    principal curvatures are.
    """
    relation = given(formula).relation
    operator = sp.Matrix([[pr.P_uu, pr.P_uv], [pr.P_uv, pr.P_vv]])
    curvatures = [value for value, times in operator.eigenvals().items() for _ in range(times)]
    values = dict(zip((pr.kappa_1, pr.kappa_2), curvatures, strict=True))
    residual = sp.expand((relation.rhs - relation.lhs).subs(values))
    yield Case("sum of squares", bool(residual == 0), residual=residual)
    yield from premises(tangential_cases())
    yield from energy.isometric_cases()


def planar_cases() -> Iterator[Case]:
    """Yield flat surfaces, strain energy zero, in other parametrisations; true where (11) vanishes too."""
    u, v = sp.symbols("u v", real=True)
    c = sp.Symbol("c", positive=True)
    factors = [thin_plate_density().coeff(second, 2) for second in SECOND_DERIVATIVES]
    for label, surface in (
        ("the square as (u + c u^2, v, 0), every c", sp.Matrix([u + c * u**2, v, 0])),
        ("the square as (u, v + c u v, 0), every c", sp.Matrix([u, v + c * u * v, 0])),
    ):
        second = [surface.diff(u, 2), surface.diff(u, v), surface.diff(v, 2)]
        density = sum(f * x.dot(x) for f, x in zip(factors, second, strict=True))
        total = sp.integrate(density, (u, 0, 1), (v, 0, 1))
        yield Case(label, bool(total == 0), residual=total)


def direction_check(sign: int) -> Check:
    """Return the check of row 1 with alpha = 1 against P_u = `sign` R_w, for every order and knots."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        relation = given(formula).relation
        h, base_h = span_symbols(1)[0], span_symbols(1, "H")[0]
        printed = (relation.rhs - relation.lhs + pr.P_1).subs({pr.u_1: h, pr.w_kr: pr.w_s + base_h})
        residual = sp.factor(printed - _row_by_direction(sign))
        yield Case("every order and knots", bool(residual == 0), residual=residual)

    text = "R_w" if sign > 0 else "-R_w"
    method = f"row 1 solved from P_u = {text} with the end derivatives, every order and knots"
    return Check(cases, Strength.GENERAL, method, proof=True)


@cache
def _row_by_direction(sign: int) -> Any:
    slope_p = end_derivatives(1, pr.k - 1, span_symbols(1))[1, :] * sp.Matrix([pr.P_0, pr.P_1])
    slope_r = end_derivatives(1, pr.k_r - 1, span_symbols(1, "H"))[1, :] * sp.Matrix([pr.R_0, pr.R_1])
    (row,) = sp.solve(slope_p[0] - sign * slope_r[0], pr.P_1)
    return row
