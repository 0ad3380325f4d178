"""Deciding what section 2 says of the representation: properties, evaluation, conversion, derivatives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

import sympy as sp

from semispline.derivations.properties import least_bernstein_coefficient, partition_residuals, supports
from semispline.derivations.splines import X, basis_pieces
from semispline.papers.checks import (
    WITHIN,
    clamped,
    coefficient,
    contact_at_knot,
    contained,
    de_boor,
    identity_cases,
    insertion_cases,
    locality_induction_cases,
    net_ring,
    rational_points,
    sharp_continuity_cases,
    spline_basis,
    triangle_cases,
    union,
)
from semispline.papers.ledger import Case, as_expression, premises
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.samples import samples
from semispline.papers.lin2014.printed import CUBIC

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


def common_domain_cases() -> Iterator[Case]:
    """Yield control curves over several domains: a surface is defined where the functions of every curve sum to 1."""
    first = clamped(CUBIC, HALF)
    for label, second, meets in (
        ("V_1 over [0, 1]", clamped(CUBIC, THIRD), True),
        ("V_1 over [-1, 2], which contains [0, 1]", clamped(CUBIC, HALF, start=-1, end=2), True),
        ("V_1 over [0, 3/4]", clamped(CUBIC, THIRD, end=Fraction(3, 4)), False),
        ("V_1 over [1/4, 1]", clamped(CUBIC, HALF, start=Fraction(1, 4)), False),
    ):
        defined = all(_sums_to_one(vector, v) for vector in (first, second) for v in rational_points(0, 1, 9))
        yield Case(label, defined, own=meets, meets=meets)


def _sums_to_one(vector: Sequence[Fraction], v: Fraction) -> bool:
    inside = vector[0] <= v <= vector[-1]
    basis = spline_basis({"V": vector})
    return inside and sum(basis(i, CUBIC, v, "V") for i in range(len(vector) - CUBIC)) == 1


def weight_cases() -> Iterator[Case]:
    """Yield surfaces: what multiplies their control points sums to 1 and is nowhere negative."""
    for order in range(2, 6):
        knots = ["0"] * order + ["h"] + ["1"] * order
        one = all(residual.is_zero for residual in partition_residuals(order - 1, knots))
        yield Case(f"order {order}, any inner knot h: sum 1", one, own=order == CUBIC)
    for order in range(2, 9):
        least = least_bernstein_coefficient(order - 1, clamped_exact(order))
        label = f"order {order}, inner knots 1/3, 1/2, 1/2: least Bernstein coefficient"
        yield Case(label, bool(least >= 0), own=order == CUBIC)
    for sample in samples():
        for u, v in ((Fraction(2, 7), Fraction(3, 7)), (Fraction(0), Fraction(1)), (Fraction(4, 5), Fraction(1, 3))):
            factors = sample.weights(u, v)
            convex = sum(factors) == 1 and min(factors) >= 0
            yield Case(f"orders {sample.k}, {sample.l} at {u}, {v}", convex, own=sample.k == sample.l == CUBIC)


def clamped_exact(order: int) -> list[Any]:
    """Return a clamped vector with a single and a double inner knot."""
    return [as_expression(t) for t in clamped(order, THIRD, *[HALF] * min(2, order - 1))]


def affine_cases() -> Iterator[Case]:
    """Yield surfaces: the affine map x -> a x + b of all control points maps each point, by de Boor's triangle."""
    for sample in samples():
        net = net_ring(*sample.sizes)
        a, b = Fraction(-3, 2), Fraction(5, 7)
        for u, v in ((Fraction(2, 7), Fraction(3, 7)), (Fraction(4, 5), Fraction(1, 3))):
            mapped = sample.value({place: a * p + b for place, p in net.items()}, u, v)
            same = mapped == a * sample.value(net, u, v) + b
            yield Case(f"orders {sample.k}, {sample.l} at {u}, {v}", bool(same), own=sample.k == sample.l == CUBIC)


def locality_cases() -> Iterator[Case]:
    """Yield that each control point is felt on a few spans only: f_ij = N_i(u) N_ij(v) vanishes where a factor does.

    That a function lives on all of the spans between its knots is found at instances of every order from 2 to 8.
    """
    yield from locality_induction_cases()
    for order in range(2, 9):
        distinct = list(range(3 * order))
        found = supports(order - 1, distinct)
        inside = range(order - 1, len(distinct) - order)
        wanted = [tuple(c for c in inside if j <= c < j + order) for j in range(len(found))]
        yield Case(f"order {order}: spans on which each function lives", found == wanted, own=order == CUBIC)
    for sample in samples():
        for u, v in ((Fraction(2, 7), Fraction(3, 7)), (Fraction(1, 9), Fraction(8, 9))):
            felt = [factor != 0 for factor in sample.weights(u, v)]
            near = [
                across[i] <= u <= across[i + sample.k] and along[j] <= v <= along[j + sample.l]
                for across in (sample.U,)
                for i, along in enumerate(sample.V)
                for j in range(sample.sizes[i])
            ]
            yield Case(f"orders {sample.k}, {sample.l} at {u}, {v}", felt == near, own=sample.k == sample.l == CUBIC)


def same_knots_cases() -> Iterator[Case]:
    """Yield surfaces whose curves all have one knot vector: the classical surface, evaluated in either order."""
    a, b = sp.symbols("a b", integer=True, nonnegative=True)
    along, across = pr.B(pr.j, pr.ell, pr.v, pr.V_r), pr.B(pr.i, pr.k, pr.u, pr.U)
    last_v, last_u = (pr.j, 0, pr.n), (pr.i, 0, pr.m)
    # (1) as printed, with one knot vector for all curves.
    by_rows = pr.EQ_1.relation.rhs.replace(pr.V, lambda _: pr.V_r).replace(pr.N, lambda _: pr.n)
    by_columns = sp.Sum(sp.Sum(pr.P[pr.i, pr.j] * across, last_u) * along, last_v)
    factors = [coefficient(total, pr.P[a, b]) for total in (by_rows, by_columns)]
    residual = sp.factor_terms(factors[0] - factors[1])
    yield Case("every order, knots and count: both orders of summation", bool(residual == 0), residual=residual)
    yield from triangle_cases()
    for k, length in ((2, 3), (3, 3), (4, 4)):
        across, along = clamped(k, Fraction(2, 5)), clamped(length, THIRD)
        rows, columns = len(across) - k, len(along) - length
        net = net_ring(*[columns] * rows)
        for u, v in zip(rational_points(0, 1, 4), reversed(list(rational_points(0, 1, 4))), strict=True):
            by_rows = [de_boor(length, along, [net[i, j] for j in range(columns)], v) for i in range(rows)]
            by_columns = [de_boor(k, across, [net[i, j] for i in range(rows)], u) for j in range(columns)]
            same = de_boor(k, across, by_rows, u) == de_boor(length, along, by_columns, v)
            yield Case(f"orders {k}, {length} at {u}, {v}", bool(same), own=k == length == CUBIC)


def conversion_cases() -> Iterator[Case]:
    """Yield that inserting knots changes no spline, and surfaces whose curves all fit on the union of their knots."""
    yield from insertion_cases()
    for sample in samples():
        common = union(sample.l, *sample.V)
        fits = all(contained(sample.l, vector, common) for vector in set(sample.V))
        own = sample.k == sample.l == CUBIC
        yield Case(f"orders {sample.k}, {sample.l}, {len(common) - sample.l} points a row after", fits, own=own)


def row_difference_cases() -> Iterator[Case]:
    """Yield pairs of neighbouring rows: their difference lies in the spline space of neither.

    Where one row alone has a knot, the difference is as rough there as that row, and splines without it are not.
    """
    yield from premises(sharp_continuity_cases())
    for order, a, b in (
        (3, clamped(3), clamped(3, HALF)),
        (4, clamped(4, HALF), clamped(4, THIRD)),
        (4, clamped(4, HALF), clamped(4, THIRD, 2 * THIRD)),
    ):
        lost = not (contained(order, a, b) and contained(order, b, a))
        yield Case(f"order {order}, inner knots {_inner(order, a)} and {_inner(order, b)}", lost, own=order == CUBIC)


def _inner(order: int, vector: Sequence[Fraction]) -> str:
    return "{" + ", ".join(map(str, vector[order:-order])) + "}"


def no_spline_form_cases() -> Iterator[Case]:
    """Yield surfaces, true where the u-derivative is *no* spline surface of order k - 1 over the rows' merged knots.

    With D_i(v) = (k-1)(P_i+1(v) - P_i(v))/(u_i+k - u_i+1) on the union of V_i and V_i+1, the sum of D_i B_i,k-1 is
    compared with the derivative of the printed sum, differentiated function by function.
    """
    exists = all(case.true for case in (*identity_cases("u-derivative"), *insertion_cases()))
    yield Case("every order and knots: a spline form exists", not exists)
    for sample in samples():
        net = net_ring(*sample.sizes)
        basis = spline_basis({"U": sample.U, "lower": sample.U[1:-1]})
        u, v = Fraction(2, 7), Fraction(3, 7)
        rows = [sample.curve(net, i, v) for i in range(sample.m + 1)]
        k, U = sample.k, sample.U
        derivative = sum(rows[i] * basis(i, k, u, "U", 1) for i in range(sample.m + 1))
        spline = sum(
            (rows[i + 1] - rows[i]) * Fraction(k - 1) / (U[i + k] - U[i + 1]) * basis(i, k - 1, u, "lower")
            for i in range(sample.m)
        )
        merged = all(
            contained(sample.l, vector, union(sample.l, *sample.V[i : i + 2]))
            for i in range(sample.m)
            for vector in sample.V[i : i + 2]
        )
        exists = bool(derivative - spline == 0) and merged
        yield Case(f"orders {k}, {sample.l}: a spline form exists", not exists, own=k == sample.l == CUBIC)


def classical_derivative_cases() -> Iterator[Case]:
    """Yield classical surfaces: both partial derivatives are spline surfaces with one order less."""
    for k in range(2, 6):
        knots = clamped(k, Fraction(2, 5), Fraction(3, 5))
        basis = spline_basis({"U": knots, "lower": knots[1:-1]})
        row = [net_ring(len(knots) - k)[0, i] for i in range(len(knots) - k)]
        for u in (Fraction(2, 7), Fraction(4, 7)):
            derivative = sum(p * basis(i, k, u, "U", 1) for i, p in enumerate(row))
            spline = sum(
                (row[i + 1] - row[i]) * Fraction(k - 1) / (knots[i + k] - knots[i + 1]) * basis(i, k - 1, u, "lower")
                for i in range(len(row) - 1)
            )
            yield Case(f"order {k} at {u}", bool(derivative - spline == 0), own=k == CUBIC)


def continuity_control_cases() -> Iterator[Case]:
    """Yield orders and multiplicities: a knot of multiplicity r in one curve leaves it C^(order-1-r) there.

    The other curves, which lack the knot, stay polynomial across it.
    """
    yield from premises(sharp_continuity_cases())
    for order in range(2, 6):
        for r in range(1, order):
            least = contact_at_knot(order, r)
            yield Case(f"order {order}, multiplicity {r}: C^{least}", least == order - 1 - r, own=order == CUBIC)


def independent_control_cases() -> Iterator[Case]:
    """Yield surfaces: the jump of a v-derivative across a knot of curve i is N_i(u) times that of the curve."""
    a = sp.Symbol("a", integer=True, nonnegative=True)
    # By (3) as printed. What curve a is multiplied by does not depend on v, so that it multiplies derivatives by v and
    # their jumps too; any other curve enters with a function of its own.
    factor = coefficient(pr.EQ_3.relation.rhs, pr.C(a, pr.v))
    residual = sp.expand(factor - WITHIN(0, a, pr.m) * pr.B(a, pr.k, pr.u, pr.U))
    yield Case("every order, knots and count: factor of the jump of curve a", bool(residual == 0), residual=residual)
    for position in (0, 3, 6):
        vectors = [clamped(CUBIC)] * 7
        vectors[position] = clamped(CUBIC, HALF, HALF, HALF)
        basis = spline_basis({"U": clamped(CUBIC, Fraction(1, 4), HALF, Fraction(3, 4))})
        felt = [basis(position, CUBIC, u, "U") != 0 for u in rational_points(0, 1, 9)]
        # The jump of the first derivative of each curve across 1/2, by its pieces on both sides.
        jumps = [_jump(vector) for vector in vectors]
        only = all((jump != 0) == (i == position) for i, jump in enumerate(jumps))
        yield Case(f"a triple knot in curve {position}", only and any(felt) and not all(felt))


def _jump(vector: Sequence[Fraction]) -> sp.Expr:
    """Return the jump of the first derivative of the middle basis function across 1/2."""
    spans = basis_pieces(CUBIC - 1, [as_expression(x) for x in vector])
    half = sp.Rational(1, 2)
    left = [s for s in spans if s.start < half]
    right = [s for s in spans if s.end > half]
    if left[-1] is right[0]:
        return sp.Integer(0)
    i = left[-1].first + CUBIC - 1
    slopes = []
    for span in (left[-1], right[0]):
        inside = span.first <= i < span.first + CUBIC
        slopes.append(span.pieces[i - span.first].diff(X).eval(half) if inside else sp.Integer(0))
    return slopes[1] - slopes[0]
