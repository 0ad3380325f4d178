"""Deciding what section 2 says of the representation: properties, evaluation, conversion, derivatives."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import sympy as sp
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix

from semispline.derivations.properties import (
    contact_orders,
    least_bernstein_coefficient,
    partition_residuals,
    proofs,
    supports,
)
from semispline.derivations.splines import X, basis_pieces
from semispline.papers.ledger import (
    WITHIN,
    Case,
    Check,
    Formula,
    Strength,
    clamped,
    coefficient,
    de_boor,
    net_ring,
    rational_points,
    spline_basis,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.spline import CUBIC, Sample, samples, triangle_cases

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


def proof_check(*names: str, instances: Callable[[], Iterator[Case]]) -> Check:
    """Return the check that the identities behind some properties are zero, for every degree and knot vector.

    The instances, which take the functions themselves, are run after them.
    """

    def cases(_: Formula | None) -> Iterator[Case]:
        yield from identity_cases(*names)
        yield from instances()

    method = (
        f"identities for symbolic degree and knots ({', '.join(names)}; argument in derivations.properties), and the "
        "Cox-de Boor functions at instances"
    )
    return Check(cases, Strength.SYMBOLIC_ORDER, method, proof=True)


_proofs = cache(proofs)


def premises(cases: Iterable[Case]) -> Iterator[Case]:
    """Yield cases on which an argument stands: instances of nothing, and where one is false there is no verdict."""
    yield from (replace(case, own=False) for case in cases)


def identity_cases(*names: str) -> Iterator[Case]:
    """Yield the identities behind some properties, which are to be zero."""
    for proof in _proofs():
        if proof.name in names:
            for name, residual in proof.identities.items():
                yield Case(f"{proof.name}: {name}", residual == 0, residual=residual)


def question(cases: Callable[[], Iterator[Case]], method: str, strength: Strength = Strength.RATIONAL) -> Check:
    """Return a check of a question without a formula."""
    return Check(lambda _: cases(), strength, method)


def proved(cases: Callable[[], Iterator[Case]], method: str, strength: Strength = Strength.SYMBOLIC_ORDER) -> Check:
    """Return a check of a question whose cases prove the answer."""
    return Check(lambda _: cases(), strength, method, proof=True)


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
            factors = weights(sample, u, v)
            convex = sum(factors) == 1 and min(factors) >= 0
            yield Case(f"orders {sample.k}, {sample.l} at {u}, {v}", convex, own=sample.k == sample.l == CUBIC)


def clamped_exact(order: int) -> list[Any]:
    """Return a clamped vector with a single and a double inner knot."""
    return [sp.Rational(*t.as_integer_ratio()) for t in clamped(order, THIRD, *[HALF] * min(2, order - 1))]


def weights(sample: Sample, u: Fraction, v: Fraction) -> list[Fraction]:
    """Return what each control point of a surface is multiplied by at (u, v): Cox-de Boor, function by function."""
    basis = spline_basis({"U": sample.U} | dict(enumerate(sample.V)))
    return [
        basis(i, sample.k, u, "U") * basis(j, sample.l, v, i)
        for i, size in enumerate(sample.sizes)
        for j in range(size)
    ]


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
    """Yield that N_i,k vanishes on span c, [t_c, t_(c+1)), unless i <= c < i + k, for every order and knots.

    By induction on the order: on a span outside of that both functions of order k - 1 in the recurrence vanish by
    the claim for k - 1. N_i,1 is 1 on span i alone. Then f_ij = N_i(u) N_ij(v) vanishes where either factor does. That
    N_i,k lives on all of these spans is found at instances of every order from 2 to 8.
    """
    i = sp.Symbol("i", integer=True)
    k = 2 + sp.Symbol("r", integer=True, nonnegative=True)
    away = sp.Symbol("d", integer=True, nonnegative=True)
    rising, falling = sp.symbols("omega psi")
    functions = rising * sp.Function("N")(i) + falling * sp.Function("N")(i + 1)
    for label, span in (("before its first knot", i - 1 - away), ("after its last knot", i + k + away)):
        residual = functions.replace(sp.Function("N"), lambda j, c=span: _lower_function(j, k - 1, c))
        yield Case(f"every order and knots, {label}", bool(residual == 0), residual=residual)
    for order in range(2, 9):
        distinct = list(range(3 * order))
        found = supports(order - 1, distinct)
        inside = range(order - 1, len(distinct) - order)
        wanted = [tuple(c for c in inside if j <= c < j + order) for j in range(len(found))]
        yield Case(f"order {order}: spans on which each function lives", found == wanted, own=order == CUBIC)
    for sample in samples():
        for u, v in ((Fraction(2, 7), Fraction(3, 7)), (Fraction(1, 9), Fraction(8, 9))):
            felt = [factor != 0 for factor in weights(sample, u, v)]
            near = [
                across[i] <= u <= across[i + sample.k] and along[j] <= v <= along[j + sample.l]
                for across in (sample.U,)
                for i, along in enumerate(sample.V)
                for j in range(sample.sizes[i])
            ]
            yield Case(f"orders {sample.k}, {sample.l} at {u}, {v}", felt == near, own=sample.k == sample.l == CUBIC)


def _lower_function(j: Any, order: Any, span: Any) -> Any:
    """Return N_j of an order on a span by the claim: zero where the span is known to be outside of its knots."""
    outside = (j - span).is_positive or (span - (j + order - 1)).is_positive
    return sp.Integer(0) if outside else sp.Symbol(f"N_{j}")


def insertion_cases() -> Iterator[Case]:
    """Yield that a spline stays one where a knot z is inserted, for every order, knots and place of z.

    With s_0 .. s_(k+1) the knots of function B of order k and z among them, B' the function over s_0 .. s_k and B''
    that over s_1 .. s_(k+1), B = (z - s_0)/(s_k - s_0) B' + (s_(k+1) - z)/(s_(k+1) - s_1) B''. By induction on k: the
    recurrence on the left, the claim for k - 1 put in, all written in the three new functions of order k - 1. For
    order 1 a step function is cut in two.
    """
    s0, s1, s2, before, sk, after, z, x = sp.symbols("s_0 s_1 s_2 s_{k-1} s_k s_{k+1} z x")
    new = sp.symbols("A B C")

    def rising(start: Any, end: Any) -> Any:
        return (x - start) / (end - start)

    def falling(start: Any, end: Any) -> Any:
        return (end - x) / (end - start)

    first = rising(s0, before) * new[0] + falling(s1, sk) * new[1]
    second = rising(s1, sk) * new[1] + falling(s2, after) * new[2]
    claimed = (z - s0) / (sk - s0) * first + (after - z) / (after - s1) * second
    left = (z - s0) / (before - s0) * new[0] + (sk - z) / (sk - s1) * new[1]
    right = (z - s1) / (sk - s1) * new[1] + (after - z) / (after - s2) * new[2]
    # Old knots, z left out; where z is next to an end one of the two lower functions keeps its knots.
    for label, place, lower, start, end in (
        ("z inside", {}, (left, right), s1, sk),
        ("z right after the start", {s1: z}, (left, new[2]), s2, sk),
        ("z right before the end", {sk: z}, (new[0], right), s1, before),
    ):
        old = rising(s0, end) * lower[0] + falling(start, after) * lower[1]
        residual = sp.cancel((old - claimed).subs(place))
        yield Case(f"knot insertion, every order and knots, {label}", residual == 0, residual=residual)


def sharp_continuity_cases() -> Iterator[Case]:
    """Yield that across an r-fold knot x all splines of degree p are C^(p-r), some no smoother.

    All are: `continuity`. For p = r the function over a, x, .., x, b is ((t - a)/(x - a))^p before x and
    ((b - t)/(b - x))^p after it, by the recurrence, and its slope jumps. And every spline of degree p - 1 is the
    derivative of one of degree p (`u-derivative`, solved for the control points one after another), smoother by one.
    """
    yield from identity_cases("continuity", "derivative", "u-derivative")
    p, before, after = sp.symbols("p g h", positive=True)
    t = sp.Symbol("t")
    # The knot x is the origin, a = -g, b = h.
    left, right = ((t + before) / before) ** p, ((after - t) / after) ** p
    for name, piece in (("before", left), ("after", right)):
        step = sp.simplify(piece.subs(p, p + 1) / piece - piece.subs(p, 1))
        yield Case(f"recurrence {name} the knot", bool(step == 0), residual=step)
    yield Case("pieces that meet", bool(left.subs(t, 0) == right.subs(t, 0) == 1))
    jump = right.diff(t).subs(t, 0) - left.diff(t).subs(t, 0)
    yield Case("a slope that jumps", bool(jump.is_negative))
    first, width, target = sp.symbols("P_i d Q_i")
    second = first + width * target / p
    residual = sp.expand(p * (second - first) / width - target)
    yield Case("a spline of one degree more", residual == 0, residual=residual)


@cache
def contact_at_knot(order: int, multiplicity: int) -> int:
    """Return how smooth all splines of an order are at a knot h, 0 < h < 1, of a multiplicity, but no smoother."""
    knots = [0] * order + ["h"] * multiplicity + [1] * order
    return min(x for x in contact_orders(order - 1, knots, "h") if x is not None)


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


def contained(order: int, inner: Sequence[Fraction], outer: Sequence[Fraction]) -> bool:
    """Tell whether every spline over one knot vector is one over another, by exact linear algebra.

    Splines of one order over the same domain that agree at more points in every span than a polynomial of that order
    has coefficients are the same.
    """
    spans = sorted(set(inner) | set(outer))
    points = [a + (b - a) * Fraction(r, order + 1) for a, b in pairwise(spans) for r in range(order + 1)]
    values = [_collocation(order, vector, points) for vector in (outer, inner)]
    return bool(values[0].rank() == values[0].hstack(values[1]).rank())


def _collocation(order: int, vector: Sequence[Fraction], points: Sequence[Fraction]) -> DomainMatrix:
    basis = spline_basis({"V": vector})
    count = len(vector) - order
    rows = [[QQ(*basis(i, order, x, "V").as_integer_ratio()) for i in range(count)] for x in points]
    return DomainMatrix(rows, (len(points), count), QQ)


def union(order: int, *vectors: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """Return the smallest knot vector that holds the inner knots of all, each with its largest multiplicity."""
    inner: list[Fraction] = []
    for knot in sorted({x for vector in vectors for x in vector[order:-order]}):
        inner += [knot] * max(list(vector).count(knot) for vector in vectors)
    return clamped(order, *inner, start=vectors[0][0], end=vectors[0][-1])


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
    spans = basis_pieces(CUBIC - 1, [sp.Rational(*x.as_integer_ratio()) for x in vector])
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
