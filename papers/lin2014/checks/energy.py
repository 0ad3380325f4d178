"""Deciding what sections 3 and 4 say of the energy: (11), (12), (14), degrees, solvability. All of it exact.

Integrals come from `semispline.derivations.energy`, minima from exact linear algebra.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import sympy as sp
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix

from semispline.derivations.energy import Basis, ExactSurface, energy_matrix, gram_matrix
from semispline.derivations.problem import ExactBase, blend_problem, exact_minimum
from semispline.derivations.splines import X, end_derivatives
from semispline.papers.checks import clamped
from semispline.papers.ledger import (
    Case,
    Formula,
    Meaning,
    as_expression,
    as_fraction,
    difference_case,
    given,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.printed import CUBIC


def basis(order: int, *inner: Any) -> Basis:
    """Return a basis over clamped knots on [0, 1]."""
    return Basis(order - 1, tuple(map(as_expression, clamped(order, *inner))))


def u_basis(k: int, m: int) -> Basis:
    """Return U of (13): m - k + 1 uniform inner knots."""
    count = m - k + 1
    return basis(k, *(Fraction(i, count + 1) for i in range(1, count + 1)))


@cache
def layout() -> ExactSurface:
    """Return the bases of a bicubic blend with one middle curve over the printed knots of Fig. 5."""
    a, b = basis(4, Fraction(1, 2)), basis(4, Fraction(1, 3), Fraction(2, 3))
    return ExactSurface(u_basis(4, 6), (a, a, a, basis(4, Fraction(5, 12)), b, b, b))


def free_rows(m: int, order: int) -> list[int]:
    """Return the rows that contact of an order leaves free."""
    return list(range(order + 1, m - order))


@cache
def _integral(space: Basis, i: int, derivative: int) -> Any:
    """Return the integral of one derivative of one basis function."""
    total = sp.Integer(0)
    for span in space.spans:
        if span.first <= i < span.first + len(span.pieces):
            piece = span.pieces[i - span.first]
            primitive = (piece.diff((X, derivative)) if derivative else piece).integrate(X)
            total += primitive.eval(span.end) - primitive.eval(span.start)
    return total


@cache
def _mixed(first: Basis, second: Basis, d: int, e: int) -> sp.Matrix:
    """Return the integrals of products of a d-th and an e-th derivative, over knots that may differ."""
    points = sorted(set(first.breakpoints) | set(second.breakpoints))
    total = sp.zeros(first.size, second.size)
    for start, end in pairwise(points):
        left, right = (next(s for s in reversed(b.spans) if s.start <= start) for b in (first, second))
        for r, one in enumerate(left.pieces):
            for q, other in enumerate(right.pieces):
                one_d, other_e = (p.diff((X, n)) if n else p for p, n in ((one, d), (other, e)))
                primitive = (one_d * other_e).integrate(X)
                total[left.first + r, right.first + q] += primitive.eval(end) - primitive.eval(start)
    return total


@cache
def _gram() -> tuple[sp.Matrix, tuple[tuple[int, int], ...]]:
    return energy_matrix(layout()), layout().index


@cache
def _one_dimensional(i: int, other: int) -> tuple[tuple[Any, ...], ...]:
    """Return A_0, A_1, A_2, A_10 of two rows, and the matrices G_0, G_1, G_2, G_12 of their curves."""
    surface = layout()
    across = tuple(_mixed(surface.u, surface.u, d, e)[i, other] for d, e in ((0, 0), (1, 1), (2, 2), (1, 0)))
    one, two = surface.curves[i], surface.curves[other]
    along = tuple(_mixed(one, two, d, e) for d, e in ((0, 0), (1, 1), (2, 2), (1, 2)))
    return across, along


def gram_entry_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (14): each entry of A and B against the coefficient in the energy; the free row first, then all pairs."""
    matrix, index = _gram()
    free = [n for n, (i, _) in enumerate(index) if i == 3]
    pairs = [(r, c) for r in free for c in free] + [(r, c) for r in range(len(index)) for c in range(0, len(index), 5)]
    for r, c in pairs:
        (i, j), (other, at) = index[r], index[c]
        label = f"control points {i},{j} and {other},{at}"
        yield difference_case(given(formula), label, Meaning(_entry_values(i, j, other, at, matrix[r, c])))


def _entry_values(i: int, j: int, other: int, at: int, true: Any) -> dict[Any, Any]:
    surface = layout()

    def single(row: int, point: int) -> tuple[Any, ...]:
        u = [_integral(surface.u, row, d) for d in range(3)]
        v = [_integral(surface.curves[row], point, d) for d in range(3)]
        return u[2] * v[0], u[0] * v[2], u[1] * v[1]

    a_1, b_1, c_1 = single(i, j)
    a_2, b_2, c_2 = single(other, at)
    across, along = _one_dimensional(i, other)
    values = {pr.K: true, pr.a_1: a_1, pr.a_2: a_2, pr.b_1: b_1, pr.b_2: b_2, pr.c_1: c_1, pr.c_2: c_2}
    values |= dict(zip((pr.A_0, pr.A_1, pr.A_2, pr.A_10), across, strict=True))
    values |= dict(zip((pr.G_0, pr.G_1, pr.G_2, pr.G_12), (g[j, at] for g in along), strict=True))
    return {letter: as_fraction(x) for letter, x in values.items()}


def printed_system(third_term: str = "printed") -> tuple[sp.Matrix, sp.Matrix]:
    """Return A and B of (14) as printed for the free row of the layout; `third_term` "vv" takes C_vv^T C_vv."""
    _, index = _gram()
    free = [place for place in index if place[0] == 3]
    known = [place for place in index if place[0] != 3]
    formula = pr.EQ_14 if third_term == "printed" else pr.EQ_14_THIRD_TERM

    def entry(one: tuple[int, int], other: tuple[int, int]) -> Any:
        values = _entry_values(*one, *other, sp.Integer(0))
        return formula.relation.rhs.subs({s: as_expression(x) for s, x in values.items()})

    def block(places: list[tuple[int, int]]) -> sp.Matrix:
        return sp.Matrix([[entry(x, y) for y in places] for x in free])

    return block(free), block(known)


def integrals_vanish_cases() -> Iterator[Case]:
    """Yield rows away from both ends, orders 3 to 6: B_i' and B_i'' integrate to zero, so that a_ij = c_ij = 0."""
    for k in range(3, 7):
        space = u_basis(k, k + 3)
        for i in range(2, space.size - 2):
            zero = _integral(space, i, 1) == 0 and _integral(space, i, 2) == 0
            yield Case(f"order {k}, row {i} of 0..{space.size - 1}", bool(zero), own=k == CUBIC)


def density_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the integrand of (11): a rotation of (u, v) does not change it, by whatever angle."""
    relation = given(formula).relation
    half = sp.Symbol("t", real=True)
    c, s = (1 - half**2) / (1 + half**2), 2 * half / (1 + half**2)
    hessian = sp.Matrix([[pr.P_uu, pr.P_uv], [pr.P_uv, pr.P_vv]])
    turned = sp.Matrix([[c, -s], [s, c]]) * hessian * sp.Matrix([[c, s], [-s, c]])
    values = {pr.P_uu: turned[0, 0], pr.P_uv: turned[0, 1], pr.P_vv: turned[1, 1]}
    change = sp.cancel(relation.rhs.subs(values, simultaneous=True) - relation.rhs)
    yield Case("rotation by every angle, t the tangent of its half", change == 0, residual=change)


def crease_cases() -> Iterator[Case]:
    """Yield strips z = f(u): (11), taken between the knots, must see every bend, so that zero energy means no bend."""
    half = Fraction(1, 2)
    for label, space, meets in (
        ("cubic, single knot 1/2", basis(4, half), True),
        ("cubic, double knot 1/2", basis(4, half, half), True),
        ("cubic, triple knot 1/2 (a crease is possible)", basis(4, half, half, half), False),
        ("linear, knot 1/2 (a roof)", basis(2, half), False),
    ):
        gram = gram_matrix(2, space, space)
        flat = gram.shape[0] - gram.rank()
        # Only straight lines, a space of dimension 2, may cost nothing.
        yield Case(label, flat == 2, own=meets, meets=meets)


def _strip(k: int, m: int, data: tuple[Any, ...]) -> tuple[sp.Matrix, list[int], list[int], sp.Matrix]:
    """Return the energy matrix of a strip, its set and its free rows, and what the contact data make of the former."""
    space = u_basis(k, m)
    spans = [space.knots[k + r - 1] for r in (1, 2)]
    solve = end_derivatives(2, k - 1, spans).inv()
    at_start = solve * sp.Matrix(data[:3])
    at_end = solve * sp.Matrix([data[3], -data[4], data[5]])
    known = [0, 1, 2, m - 2, m - 1, m]
    return gram_matrix(2, space, space), known, free_rows(m, 2), sp.Matrix([*at_start, *at_end[::-1]])


def end_energy(k: int, m: int, data: tuple[Any, ...]) -> Any:
    """Return the least bending energy of a strip of m + 1 rows: section 3 in one dimension, C2 on both sides.

    `data` are position, first and second derivative at the start, then the same at the end.
    """
    gram, known, free, values = _strip(k, m, data)
    energy = (values.T * gram.extract(known, known) * values)[0]
    if free:
        right = gram.extract(free, known) * values
        energy -= (right.T * gram.extract(free, free).inv() * right)[0]
    return sp.expand(energy)


def middle_row(data: tuple[Any, ...]) -> Any:
    """Return the one free row of the cubic strip of least energy with a middle curve; `data` as for `end_energy`."""
    gram, known, free, values = _strip(CUBIC, 6, data)
    return -(gram.extract(free, known) * values)[0] / gram.extract(free, free)[0]


def positive_definite_cases(order: int) -> Iterator[Case]:
    """Yield blends whose free rows have exactly one minimum: the block of the energy matrix is positive definite."""
    for m in (6, 7, 8):
        rows = layout().curves
        middle = [rows[3]] * (m - 5)
        surface = ExactSurface(u_basis(4, m), (*rows[:3], *middle, *rows[-3:]))
        matrix = DomainMatrix.from_Matrix(energy_matrix(surface)).convert_to(QQ)
        free = [n for n, (i, _) in enumerate(surface.index) if i in free_rows(m, order)]
        block = matrix.extract(free, free)
        definite = all(pivot > 0 for pivot in _pivots(block))
        yield Case(f"C{order}, {m + 1} rows, {len(free)} unknown control points", definite)


def _pivots(block: DomainMatrix) -> list[Any]:
    """Return the pivots of symmetric elimination without exchanges; all positive exactly if positive definite."""
    rows = [list(row) for row in block.to_dense().to_list()]
    pivots = []
    for n in range(len(rows)):
        pivots.append(rows[n][n])
        if rows[n][n] <= 0:
            return pivots
        for r in range(n + 1, len(rows)):
            factor = rows[r][n] / rows[n][n]
            if factor:
                for c in range(n, len(rows)):
                    rows[r][c] -= factor * rows[n][c]
    return pivots


@cache
def substituted(order: int, geometric: bool, *, flat: bool = False) -> sp.Poly:
    """Return the energy of a strip with one free row after the contact rows of an order are put in.

    The base data are symbols, with `flat` but for the second derivatives, which are zero; alpha and beta too where
    contact is geometric.
    """
    space = u_basis(4, 6)
    gram = gram_matrix(2, space, space)
    first, last = ([*sp.symbols(f"{letter}0:2"), 0 if flat else sp.Symbol(f"{letter}2")] for letter in "de")
    spans = [space.knots[3 + r] for r in (1, 2)]
    solve = end_derivatives(order, 3, spans[:order]).inv()
    a, b = (pr.alpha**2, pr.beta**2) if geometric else (1, 1)
    at_start = solve * sp.Matrix([first[d] * (-a) ** d for d in range(order + 1)])
    at_end = solve * sp.Matrix([last[d] * (-b) ** d for d in range(order + 1)])
    free = sp.symbols(f"x0:{7 - 2 * (order + 1)}")
    rows = sp.Matrix([*at_start, *free, *at_end[::-1]])
    generators = (*free, *((pr.alpha, pr.beta) if geometric else ()))
    return sp.Poly(sp.expand((rows.T * gram * rows)[0]), *generators)


def shape_cases() -> Iterator[Case]:
    """Yield pairs of planar plates, true where the least energy over all alpha and beta belongs to a G1 blend.

    Along the axis of the plates the energy is a quadratic polynomial in a = alpha^2 and b = beta^2. Where its minimum
    over a, b >= 0 lies at a = b = 0 the blend does not move along the axis at all: it leaves both plates at right
    angles.
    """
    a, b = sp.symbols("a b", real=True)
    gap = sp.Symbol("d", positive=True)
    for label, distance, into_b, meets in (
        ("plates that face each other, over every gap", gap, 1, True),
        ("parallel plates, the blend turns round by 180 degrees", sp.Integer(0), -1, False),
    ):
        # The first plate is left towards +x with x_u = a, the second one entered with x_u = into_b * b.
        energy = end_energy(CUBIC, 6, (0, a, 0, distance, into_b * b, 0))
        best = sp.solve([sp.diff(energy, a), sp.diff(energy, b)], [a, b], dict=True)[0]
        yield Case(label, bool(best[a].is_positive and best[b].is_positive), own=meets, meets=meets)


@cache
def middle_knot_blends() -> tuple[tuple[ExactSurface, Any, Any], ...]:
    """Return C2 blends of least energy with the rule's middle knot 5/12, and with the union {1/3, 1/2} there.

    Bases, control points and energy of each. Cubic across, linear along, so that they stay small; a base with a ridge
    and a flat one.
    """
    a, b = basis(2, Fraction(1, 2)), basis(2, Fraction(1, 3))
    found = []
    for middle in (basis(2, Fraction(5, 12)), basis(2, Fraction(1, 3), Fraction(1, 2))):
        surface = ExactSurface(u_basis(4, 6), (a, a, a, middle, b, b, b))
        across = Basis(3, (0, 0, 0, 0, 1, 1, 1, 1))
        sides = [
            ExactBase(across, tuple(tuple((x + dx * i, j, z) for j, z in enumerate(heights)) for i in range(3)))
            for x, dx, heights in ((0, -1, (0, 1, 0)), (2, 1, (0, 0, 0)))
        ]
        least, points = exact_minimum(blend_problem(2, surface, *sides), 1, 1)
        found.append((surface, points, as_expression(least)))
    return tuple(found)


def middle_knot_energies() -> tuple[Any, Any]:
    """Return the least energies with the rule's middle knot, and with the union there."""
    (*_, rule), (*_, union) = middle_knot_blends()
    return rule, union


def strain_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the integrand of the strain energy: the measure of a surface must not depend on its parametrisation."""
    relation = given(formula).relation
    scale = sp.Symbol("c", positive=True)
    density = relation.rhs
    # Under u -> u/c the area element becomes c times as large and the range 1/c as long.
    change = sp.factor(density.subs(pr.area, scale * pr.area) / scale - density)
    yield Case("u replaced by u / c", change == 0, residual=change)
    usual = sp.expand(density.subs(pr.area, 1) - pr.kappa_1**2 - pr.kappa_2**2)
    yield Case("unit area element", usual == 0, residual=usual)


def isometric_cases() -> Iterator[Case]:
    """Yield surfaces that keep lengths and angles: the integrand of (11) is the sum of squared curvatures."""
    u, v = sp.symbols("u v", real=True)
    for label, surface in (
        ("plane", sp.Matrix([u, v, 0])),
        ("cylinder of radius 2", sp.Matrix([2 * sp.cos(u / 2), 2 * sp.sin(u / 2), v])),
    ):
        second = [surface.diff(u, 2), surface.diff(u, v), surface.diff(v, 2)]
        plate = sp.simplify(sum(c * x.dot(x) for c, x in zip((1, 2, 1), second, strict=True)))
        curvature = {"plane": sp.Integer(0), "cylinder of radius 2": sp.Rational(1, 4)}[label]
        yield Case(label, sp.simplify(plate - curvature) == 0)
