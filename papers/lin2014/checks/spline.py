"""Deciding definitions and counts of sections 2 and 3: printed sums against de Boor's triangle, counts by counting.

The triangle knows no basis functions, so that it judges sums over them; basis functions come from Cox-de Boor. Each
check decides its formula for every order, knot vector and count first, and then runs it at instances.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.properties import basis_table
from semispline.papers.ledger import (
    SAME,
    WITHIN,
    Case,
    Check,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    clamped,
    coefficient,
    de_boor,
    difference_case,
    given,
    indexed,
    net_ring,
    rational_points,
    spline_basis,
)
from semispline.papers.lin2014 import printed as pr

CUBIC = 4
THIRD = Fraction(1, 3)


@dataclass(frozen=True)
class Sample:
    """A small semi-structured surface with generators for control points: orders k, l, knots U and V_i."""

    k: int
    l: int  # noqa: E741  # the paper's letter
    U: tuple[Fraction, ...]
    V: tuple[tuple[Fraction, ...], ...]

    @property
    def m(self) -> int:
        """Index of the last v-control curve."""
        return len(self.V) - 1

    @property
    def sizes(self) -> tuple[int, ...]:
        """Number of control points of each curve."""
        return tuple(len(v) - self.l for v in self.V)

    def curve(self, net: dict[tuple[int, int], Any], i: int, v: Fraction) -> Any:
        """Return P_i(v) by the triangle."""
        return de_boor(self.l, self.V[i], [net[i, j] for j in range(self.sizes[i])], v)

    def value(self, net: dict[tuple[int, int], Any], u: Fraction, v: Fraction) -> Any:
        """Return P(u, v): first along v, then along u."""
        return de_boor(self.k, self.U, [self.curve(net, i, v) for i in range(self.m + 1)], u)


def samples() -> Iterator[Sample]:
    """Yield surfaces of several orders; the last one is bicubic, laid out like (13) with one middle curve."""
    for k, order in ((2, 2), (2, 3), (3, 2), (3, 4), (4, 3)):
        U = clamped(k, Fraction(2, 5))
        vectors = (clamped(order), clamped(order, THIRD), clamped(order, Fraction(1, 4), Fraction(3, 5)))
        yield Sample(k, order, U, tuple(vectors[i % 3] for i in range(len(U) - k)))
    a, b, middle = clamped(4, Fraction(1, 2)), clamped(4, THIRD, 2 * THIRD), clamped(4, Fraction(5, 12))
    yield Sample(4, 4, clamped(4, *(Fraction(n, 4) for n in (1, 2, 3))), (a, a, a, middle, b, b, b))


@cache
def _all_samples() -> tuple[tuple[Sample, dict[tuple[int, int], Any]], ...]:
    return tuple((sample, net_ring(*sample.sizes)) for sample in samples())


# Indices of one control point.
_A, _B = sp.symbols("a b", integer=True, nonnegative=True)


def triangle_cases() -> Iterator[Case]:
    """Yield that the triangle multiplies control point j by basis function j, for every order, knots and points.

    One step of the triangle replaces points d_j by d_(j-1) (1 - w_j) + d_j w_j, w_j = (x - t_j)/(t_(j+k-1) - t_j),
    and functions of order k by those of order k - 1: the same that the recurrence makes of sum_j d_j B_j,k. At order
    1 one function is 1 and the triangle ends at its point. So both are the same sum, by induction.
    """
    t, d = sp.IndexedBase("t"), sp.IndexedBase("d")
    j, k, x = sp.Symbol("j", integer=True), sp.Symbol("k", integer=True), sp.Symbol("x")
    width = t[j + k - 1] - t[j]
    weight = (x - t[j]) / width
    by_triangle = d[j - 1] * (1 - weight) + d[j] * weight
    # B_j,k gives B_j,k-1 the rising factor, B_(j-1),k the falling one.
    by_recurrence = d[j] * (x - t[j]) / width + d[j - 1] * (t[j - 1 + k] - x) / width
    residual = sp.cancel(by_triangle - by_recurrence)
    yield Case("one step of the triangle, every order and knots", residual == 0, residual=residual)


def _coefficient_case(formula: Formula | None, unit: Any, true: Any) -> Case:
    """Decide a printed sum for every order, knots and counts: what multiplies one control point."""
    residual = sp.factor_terms(coefficient(given(formula).relation.rhs, unit) - true)
    return Case(f"every order, knots and count: factor of {unit}", bool(residual == 0), residual=residual)


def _curve_factor(i: Any) -> Any:
    """Return what the triangle multiplies P_ib by, on curve i."""
    return WITHIN(0, _B, pr.N(i)) * pr.B(_B, pr.ell, pr.v, pr.V(i))


def surface_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (1), (3) or (13): the printed sum against the triangle, for all control points at once."""
    by_curves = given(formula).relation.rhs.has(pr.C)
    across = WITHIN(0, _A, pr.m) * pr.B(_A, pr.k, pr.u, pr.U)
    true = across if by_curves else across * _curve_factor(_A)
    yield _coefficient_case(formula, pr.C(_A, pr.v) if by_curves else pr.P[_A, _B], true)
    yield from triangle_cases()
    yield from surface_instances(formula)


def surface_instances(formula: Formula | None) -> Iterator[Case]:
    """Run (1), (3) or (13) against the triangle on small surfaces."""
    for sample, net in _all_samples():
        knots: dict[Any, Any] = {"U": sample.U} | dict(enumerate(sample.V))
        for u, v in zip(rational_points(0, 1, 4), reversed(list(rational_points(0, 1, 4))), strict=True):
            meaning = Meaning(
                {pr.u: u, pr.v: v, pr.U: "U", pr.k: sample.k, pr.ell: sample.l, pr.m: sample.m},
                {
                    "P": indexed("P", net),
                    "B": spline_basis(knots),
                    "V": indexed("V", {(i,): i for i in range(sample.m + 1)}),
                    "n": lambda i, s=sample: s.sizes[int(i)] - 1,
                    "C": lambda i, v, s=sample, net=net: s.curve(net, _within(i, s.m), v),
                    "Y": lambda u, v, s=sample, net=net: s.value(net, u, v),
                },
            )
            label = f"orders {sample.k}, {sample.l} at u = {u}, v = {v}"
            yield difference_case(given(formula), label, meaning, own=sample.k == sample.l == CUBIC)


def curve_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (2), a v-control curve, against the triangle."""
    i = given(formula).relation.lhs.args[0]
    yield _coefficient_case(formula, pr.P[_A, _B], SAME(i, _A) * _curve_factor(i))
    yield from triangle_cases()
    yield from curve_instances(formula)


def curve_instances(formula: Formula | None) -> Iterator[Case]:
    """Run (2) against the triangle."""
    for sample, net in _all_samples():
        for i, v in zip((0, sample.m, 1), rational_points(0, 1, 3), strict=True):
            meaning = Meaning(
                {pr.v: v, pr.i: i, pr.ell: sample.l},
                {
                    "P": indexed("P", net),
                    "B": spline_basis(dict(enumerate(sample.V))),
                    "V": indexed("V", {(i,): i for i in range(sample.m + 1)}),
                    "n": lambda i, s=sample: s.sizes[_within(i, s.m)] - 1,
                    "C": lambda i, v, s=sample, net=net: s.curve(net, int(i), v),
                },
            )
            label = f"curve {i}, order {sample.l}, {sample.sizes[i]} points, at v = {v}"
            yield difference_case(given(formula), label, meaning, own=sample.l == CUBIC)


def base_cases(letter: str) -> Callable[[Formula | None], Iterator[Case]]:
    """Return the check of (7) for letter R, of (9) for letter S: a tensor product against the triangle."""
    x, knots_x, knots_v, order, last_x, last_v = (
        (pr.w, pr.W, pr.V_r, pr.k_r, pr.m_r, pr.n_r) if letter == "R" else (pr.t, pr.T, pr.V_s, pr.k_s, pr.m_s, pr.n_s)
    )

    points = pr.R if letter == "R" else pr.S

    def cases(formula: Formula | None) -> Iterator[Case]:
        of_row = WITHIN(0, _A, last_x) * pr.B(_A, order, x, knots_x)
        of_column = WITHIN(0, _B, last_v) * pr.B(_B, pr.ell, pr.v, knots_v)
        yield _coefficient_case(formula, points[_A, _B], of_row * of_column)
        yield from triangle_cases()
        for k, length in ((2, 3), (3, 2), (4, 4)):
            across = clamped(k, THIRD, start=-1, end=2)
            along = clamped(length, Fraction(1, 4), Fraction(3, 5))
            rows, columns = len(across) - k, len(along) - length
            net = net_ring(*[columns] * rows, letter=letter)
            for at, v in zip(rational_points(-1, 2, 3), (Fraction(2, 7), Fraction(0), Fraction(4, 5)), strict=True):
                value = _tensor(net, (k, across), (length, along), at, v)
                meaning = Meaning(
                    {
                        **{x: at, pr.v: v, knots_x: "across", knots_v: "along"},
                        **{order: k, pr.ell: length, last_x: rows - 1, last_v: columns - 1},
                    },
                    {
                        letter: indexed(letter, net),
                        "B": spline_basis({"across": across, "along": along}),
                        "Y": lambda *_, value=value: value,
                    },
                )
                yield difference_case(given(formula), f"orders {k}, {length} at {at}, {v}", meaning)

    return cases


def _tensor(net: dict[tuple[int, int], Any], across: Any, along: Any, x: Fraction, v: Fraction) -> Any:
    (k, knots), (length, knots_v) = across, along
    rows = max(i for i, _ in net) + 1
    columns = max(j for _, j in net) + 1
    curves = [de_boor(length, knots_v, [net[i, j] for j in range(columns)], v) for i in range(rows)]
    return de_boor(k, knots, curves, x)


def _within(i: Any, m: int) -> int:
    if not 0 <= i <= m:
        raise UndefinedError(f"curve {i} of 0..{m}")
    return int(i)


@dataclass(frozen=True)
class Counting:
    """Counts for every order and number of functions, and the same counted at instances.

    Attributes
    ----------
    exact : mapping
        Letter -> its value in the other letters, derived.
    instances : callable
        Yields a label, the counted letters, and own.
    """

    exact: dict[Any, Any]
    instances: Callable[[], Iterable[tuple[str, dict[Any, Any], bool]]]


def count_check(counting: Counting, method: str) -> Check:
    """Return a check of a relation between counts."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        relation = given(formula).relation
        residual = sp.expand((relation.rhs - relation.lhs).subs(counting.exact))
        yield Case("every order and count", residual == 0, residual=residual)
        for label, values, own in counting.instances():
            yield difference_case(given(formula), label, Meaning(values), own=own)

    return Check(cases, Strength.SYMBOLIC_ORDER, method, proof=True)


@cache
def functions_of_order(last: Any, order: Any) -> Any:
    """Return how many functions of an order the knots 0 .. `last` have.

    Of order 1 there are `last`. Each step of the recurrence makes one function of two neighbours.
    """
    functions, r = sp.Function("c"), sp.Symbol("r", integer=True)
    number = sp.rsolve(functions(r + 1) - functions(r) + 1, functions(r), {functions(1): last})
    return sp.expand(number.subs(r, order))


@cache
def last_knot(count: Any, order: Any) -> Any:
    """Return the index of the last knot that `count` + 1 functions of an order need."""
    last = sp.Symbol("L")
    (solution,) = sp.solve(functions_of_order(last, order) - (count + 1), last)
    return sp.expand(solution)


@cache
def support_end(first: Any, order: Any) -> Any:
    """Return the index of the knot at which function `first` of an order ends; it starts at knot `first`.

    Order 1 ends one knot on; each step of the recurrence takes in the next function (`locality`).
    """
    end, r = sp.Function("e"), sp.Symbol("r", integer=True)
    return sp.expand(sp.rsolve(end(r + 1) - end(r) - 1, end(r), {end(1): first + 1}).subs(r, order))


def domain_ends(count: Any, order: Any) -> tuple[Any, Any]:
    """Return the indices of the first and the last knot of the domain.

    One step of the recurrence turns the sum of all functions of an order into that of the next lower one, but for its
    first and last function, which enter with a factor: so the sum is 1 where these two vanish, from the end of the
    first one on, up to the start of the last one, which is the knot of its own index.
    """
    last_below = functions_of_order(last_knot(count, order), order - 1) - 1
    return support_end(sp.Integer(0), order - 1), sp.expand(last_below)


def knot_count_instances(count: Any, order: Any) -> Counting:
    """Count: how many knots carry `count` + 1 basis functions of an order; the last index is one less."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for k in range(1, 7):
            for m in range(k - 1, k + 4):
                if m >= 1:
                    length = next(x for x in range(1, 40) if functions_on(x, k) == m + 1)
                    yield f"order {k}, {m + 1} functions", {pr.last: length - 1, count: m, order: k}, k == CUBIC

    return Counting({pr.last: last_knot(count, order)}, instances)


@cache
def functions_on(n_knots: int, order: int) -> int:
    """Return how many basis functions of an order live on n distinct knots, by running Cox-de Boor.

    On fewer knots than twice the order, too few for a span where the functions sum to 1, it is 0.
    """
    table = basis_table(order - 1, list(range(n_knots))) if n_knots >= 2 * order else {}
    return len(next(iter(table.values()))) if table else 0


def _cox_de_boor(i: int, order: int, knots: Sequence[int], x: Fraction) -> Fraction:
    """Return B_i,order(x) by the recurrence alone, on distinct knots."""
    if order == 1:
        return Fraction(knots[i] <= x < knots[i + 1])
    rising = (x - knots[i]) / (knots[i + order - 1] - knots[i])
    falling = (knots[i + order] - x) / (knots[i + order] - knots[i + 1])
    return rising * _cox_de_boor(i, order - 1, knots, x) + falling * _cox_de_boor(i + 1, order - 1, knots, x)


def domain_instances(count: Any, order: Any) -> Counting:
    """Count: the indices of the first and the last knot of the domain, where the basis functions sum to 1."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for k in range(2, 6):
            for m in range(k - 1, k + 3):
                knots = range(m + k + 1)
                # One point in each span: there all functions sum to 1, or to less.
                points = [Fraction(2 * c + 1, 2) for c in knots[:-1]]
                sums = [sum(_cox_de_boor(i, k, knots, x) for i in range(m + 1)) for x in points]
                spans = [c for c, total in enumerate(sums) if total == 1]
                values = {pr.last: spans[0], pr.first: spans[-1] + 1, count: m, order: k}
                yield f"order {k}, {m + 1} functions", values, k == CUBIC

    return Counting(dict(zip((pr.last, pr.first), domain_ends(count, order), strict=True)), instances)


def inner_knots_count() -> Counting:
    """Count: the indices of the first and the last knot strictly inside the domain of a clamped vector."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for order in range(2, 6):
            for n in range(order, order + 4):
                knots = clamped(order, *(Fraction(r, 10) for r in range(1, n - order + 2)))
                inside = [index for index, knot in enumerate(knots) if 0 < knot < 1]
                values = {pr.first: inside[0], pr.last: inside[-1], pr.ell: order, pr.n_r: n}
                yield f"order {order}, {n + 1} points", values, order == CUBIC

    # The runs of equal knots of a clamped vector reach up to the ends of its domain.
    start, end = domain_ends(pr.n_r, pr.ell)
    return Counting({pr.first: start + 1, pr.last: end - 1}, instances)


SUM_METHOD = (
    "what multiplies one control point, with symbolic indices, orders, counts and knots, against de Boor's triangle, "
    "whose coefficients are the basis functions by induction on the order; run at rational parameters and knots of "
    "orders 2 to 4 as well"
)
SURFACE_CHECK = Check(surface_cases, Strength.SYMBOLIC_ORDER, SUM_METHOD, proof=True)
CURVE_CHECK = Check(curve_cases, Strength.SYMBOLIC_ORDER, SUM_METHOD, proof=True)


def base_check(letter: str) -> Check:
    """Return the check of (7) or (9)."""
    return Check(base_cases(letter), Strength.SYMBOLIC_ORDER, SUM_METHOD, proof=True)
