"""Deciding the construction of section 3: knots of base, blend and middle curve, and which rows belong to whom."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from itertools import accumulate, pairwise
from typing import Any

import sympy as sp

from semispline.derivations.contact import A, contact_rows
from semispline.derivations.counts import domain_ends, functions_on, last_knot
from semispline.derivations.splines import X, basis_pieces, end_derivative_step, end_derivatives, span_symbols
from semispline.papers.checks import (
    Counting,
    clamped,
    contained,
    de_boor,
    insertion_cases,
    net_ring,
    sharp_continuity_cases,
    union,
)
from semispline.papers.ledger import (
    Case,
    Check,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    difference_case,
    given,
    premises,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.contact_rows import ORDERS
from semispline.papers.lin2014.checks.energy import u_basis
from semispline.papers.lin2014.checks.printed_numbers import added_cases
from semispline.papers.lin2014.checks.printed_pairs import (
    PRINTED_PAIRS,
    WITH_MIDDLE_CURVE,
    inner_knots,
    merged,
    printed_pair,
)
from semispline.papers.lin2014.printed import CUBIC


@cache
def _clamped_ends() -> tuple[Case, ...]:
    """Decide that at a clamped end the first function is 1 and the others 0, for every order and order by order."""
    first = end_derivatives(2, pr.k - 1, span_symbols(2))[0, :] - sp.Matrix([[1, 0, 0]])
    step = end_derivative_step(2)[0, :]
    cases = [Case("every order and knots, by induction", bool(first.is_zero_matrix and step.is_zero_matrix))]
    for k in ORDERS:
        (span,) = basis_pieces(k - 1, [0] * k + [1] * k)
        ends = [[piece.eval(x) for piece in span.pieces] for x in (0, 1)]
        unit = [int(i == 0) for i in range(k)]
        cases.append(Case(f"order {k}, without inner knots, both ends", ends == [unit, unit[::-1]], own=k == CUBIC))
    return tuple(cases)


def contact_curve_cases() -> Iterator[Case]:
    """Yield bases: at the clamped end w_s the surface is the curve of its first row over V^r, or V^s."""
    yield from _clamped_ends()
    for k, length in ((2, 3), (3, 2), (4, 4)):
        across, along = clamped(k, Fraction(1, 3), start=-1, end=2), clamped(length, Fraction(1, 4), Fraction(3, 5))
        rows, columns = len(across) - k, len(along) - length
        net = net_ring(*[columns] * rows, letter="R")
        for v in (Fraction(0), Fraction(1, 5), Fraction(4, 7), Fraction(1)):
            curves = [de_boor(length, along, [net[i, j] for j in range(columns)], v) for i in range(rows)]
            same = de_boor(k, across, curves, Fraction(-1)) == curves[0]
            yield Case(f"orders {k}, {length} at v = {v}", bool(same), own=k == length == CUBIC)


def mismatch_cases() -> Iterator[Case]:
    """Yield pairs of knot vectors: true where no single one of the two carries both contact curves.

    Where a vector has a knot r-fold and the other one less often, some spline over the first is rougher there than
    all splines over the second.
    """
    yield from premises(sharp_continuity_cases())
    pairs = {name: printed_pair(name) for name in PRINTED_PAIRS}
    half = Fraction(1, 2)
    pairs["{1/2} and {1/4, 1/2, 3/4}"] = (clamped(4, half), clamped(4, half / 2, half, 3 * half / 2))
    for name, (a, b) in pairs.items():
        nested = set(a) <= set(b) or set(b) <= set(a)
        carried = contained(CUBIC, a, b) or contained(CUBIC, b, a)
        yield Case(name, not carried, own=name in PRINTED_PAIRS, meets=not nested)


def nested_space_cases() -> Iterator[Case]:
    """Yield that knot insertion changes no spline, and printed pairs: both lie in the space of the union of knots."""
    yield from premises(insertion_cases())
    for name in PRINTED_PAIRS:
        a, b = printed_pair(name)
        both = union(CUBIC, a, b)
        yield Case(name, contained(CUBIC, a, both) and contained(CUBIC, b, both))


def knot_line_cases() -> Iterator[Case]:
    """Yield that the union of two different vectors has knots that one lacks, and printed pairs: larger than either."""
    yield from premises(added_cases())
    for name, keys in PRINTED_PAIRS.items():
        vectors = [set(inner_knots(key)) for key in keys]
        union_of_knots = set.union(*vectors)
        yield Case(f"{name}: {len(union_of_knots)} inner knots", all(x < union_of_knots for x in vectors))


def layout_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the bound on m: what it admits has disjoint first and last three curves, and enough rows for order k."""
    relation = given(formula).relation
    least = sp.Symbol("m_0", integer=True)
    over, more = sp.symbols("r s", integer=True, nonnegative=True)
    # The least m that the bound admits, for k = 4 + r; then s more.
    (bound,) = sp.solve((relation.lhs - relation.rhs).subs(pr.m, least), least)
    m, k = bound.subs(pr.k, CUBIC + over) + more, CUBIC + over
    sound = (m - 5).expand().is_nonnegative and (m + 1 - k).expand().is_nonnegative
    yield Case("every k >= 4 and every m admitted", bool(sound))
    for k in range(2, 8):
        admitted = [m for m in range(1, 12) if relation.subs({pr.k: k, pr.m: m})]
        unsound = [m for m in admitted if m - 2 <= 2 or m + 1 < k]
        if k < CUBIC:
            label = f"k = {k}" + (f", m = {unsound[0]}" if unsound else "")
            yield Case(label, not unsound, own=False, meets=False)
        for m in admitted if k >= CUBIC else ():
            yield Case(f"k = {k}, m = {m}", m not in unsound, own=k == CUBIC)


def u_length() -> Counting:
    """Count: the last index of U for m + 1 functions of order k."""

    def instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
        for k in range(2, 7):
            for m in range(k + 1, k + 5):
                length = next(x for x in range(1, 40) if functions_on(x, k) == m + 1)
                yield f"k = {k}, m = {m}", {pr.last: length - 1, pr.m: m, pr.k: k}, k == CUBIC

    return Counting({pr.last: last_knot(pr.m, pr.k)}, instances)


def uniform_knot_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide u_i: the inner knots divide [0, 1] into equal spans."""
    relation = given(formula).relation
    printed = relation.rhs
    inner = last_knot(pr.m, pr.k) + 1 - 2 * pr.k
    # On the left Y(i) itself, or another knot: its distance in i.
    shift = relation.lhs.args[0] - pr.i

    def knot(i: Any) -> Any:
        return printed.subs(pr.i, i - shift)

    step = sp.cancel(knot(pr.i + 1) - knot(pr.i) - (knot(pr.i) - knot(pr.i - 1)))
    for label, residual in (
        ("every m, k: equal spans", step),
        ("every m, k: the one before the first is 0", sp.cancel(knot(0))),
        ("every m, k: the one after the last is 1", sp.cancel(knot(inner + 1) - 1)),
    ):
        yield Case(label, bool(residual == 0), residual=residual)
    for k in range(2, 7):
        for m in range(k + 1, k + 5):
            inner = next(x for x in range(1, 40) if functions_on(x, k) == m + 1) - 2 * k
            for i in range(1, inner + 1):
                at = {int(r): Fraction(r, inner + 1) for r in range(1, inner + 1)}
                meaning = Meaning({pr.i: i, pr.m: m, pr.k: k}, {"Y": lambda r, at=at: _looked_up(at, int(r))})
                yield difference_case(given(formula), f"k = {k}, m = {m}, u_{i}", meaning, own=k == CUBIC)


def _looked_up(values: dict[int, Any], key: int) -> Any:
    if key not in values:
        raise UndefinedError(f"{key} of {sorted(values)}")
    return values[key]


def three_row_cases() -> Iterator[Case]:
    """Yield orders: rows 0..2 of the blend are combinations of rows 0..2 of the base, and row 2 needs R_2."""
    every = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"))
    over, base_over = sp.symbols("r s", integer=True, nonnegative=True)
    top = every[2, 2].subs({pr.k: 3 + over, pr.k_r: 3 + base_over})
    yield Case("every order from 3 on, every knots: R_2 has a factor in row 2", bool(top.is_positive and top.has(A)))
    for k in range(3, 8):
        for k_r in range(3, 8):
            rows = every.subs({pr.k: k, pr.k_r: k_r})
            needed = rows[2, 2] != 0 and rows[1, 1] != 0 and rows[2, 2].has(A)
            yield Case(f"orders {k}, {k_r}", bool(rows.shape == (3, 3) and needed), own=k == k_r == CUBIC)


@cache
def set_rows(order: int) -> tuple[Any, Any]:
    """Return the last row that contact of an order sets at u = 0, and the first one at u = 1, for every m.

    Of the first few rows those are set that enter an end derivative up to the order; later ones enter later derivatives
    only, by induction (`end_derivative_step`). Each of them is determined: the matrix of these derivatives and rows is
    regular. Rows and knots are counted from the contact, so that u = 1 is the same.
    """
    more = order + 2
    matrix = end_derivatives(more, pr.k - 1, span_symbols(more))[: order + 1, :]
    touched = [i for i in range(matrix.cols) if any(matrix[:, i])]
    square = len(touched) == order + 1
    if not end_derivative_step(more).is_zero_matrix or not square or sp.factor(matrix[:, touched].det()) == 0:
        raise ValueError(f"end derivatives: found a singular matrix of rows {touched}, expected a regular one")
    return sp.Integer(touched[-1]), pr.m - touched[-1]


@cache
def contact_matrix(k: int, m: int, order: int) -> sp.Matrix:
    """Return derivatives 0 .. n at u = 0, and below them those at u = 1, of the m + 1 functions over U of (13)."""
    matrix = sp.zeros(2 * (order + 1), m + 1)
    spans = u_basis(k, m).spans
    for span, x, top in ((spans[0], 0, 0), (spans[-1], 1, order + 1)):
        for r, piece in enumerate(span.pieces):
            for d in range(order + 1):
                matrix[top + d, span.first + r] = (piece.diff((X, d)) if d else piece).eval(x)
    return matrix


def counted_rows(order: int) -> Iterator[tuple[str, int, tuple[int, int], bool]]:
    """Yield layouts, m, and which rows enter the contact at u = 0 (the last) and at u = 1 (the first), counted."""
    for k in range(order + 1, 6):
        for m in range(max(k, 2 * order + 1), k + 5):
            matrix = contact_matrix(k, m, order)
            halves = matrix[: order + 1, :], matrix[order + 1 :, :]
            at_start, at_end = ([i for i in range(m + 1) if any(half[:, i])] for half in halves)
            yield f"k = {k}, m = {m}", m, (at_start[-1], at_end[0]), k == CUBIC


_ROWS_SET = (
    "rows that enter end derivatives up to order 2, every order, knots and m; counted in the functions of orders 3 to 5"
)


def row_check_of(row: Callable[[Any, Any], Any]) -> Check:
    """Return the check of the index of a row, which follows from the last and the first row that contact sets."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        printed = given(formula).relation.rhs
        residual = sp.expand(printed - row(*set_rows(2)))
        yield Case("every m", bool(residual == 0), residual=residual)
        for label, m, ends, own in counted_rows(2):
            off = printed.subs(pr.m, m) - row(*ends)
            yield Case(label, bool(off == 0), own=own, residual=off)

    return Check(cases, Strength.GENERAL, _ROWS_SET, proof=True)


def middle_count_check(count: int) -> Check:
    """Return the check of the number m for which contact of order 2 leaves just `count` rows free."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        at_start, at_end = set_rows(2)
        (m,) = sp.solve((at_end - 1) - (at_start + 1) + 1 - count, pr.m)
        printed = given(formula).relation.rhs
        residual = printed - m
        yield Case(f"rows between {at_start} and {at_end}: {count}", bool(residual == 0), residual=residual)
        for label, last, (start, end), own in counted_rows(2):
            if end - start - 1 == count:
                yield Case(label, bool(printed == last), own=own, residual=printed - last)

    return Check(cases, Strength.GENERAL, _ROWS_SET, proof=True)


def paired_cases(last_pair: Callable[[Any], Any]) -> Callable[[Formula | None], Iterator[Case]]:
    """Return the check of the averaging rule for i = 1 .. last_pair(n): for every n, and on the printed vectors."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        half = sp.Symbol("q", integer=True, positive=True)
        for n in (2 * half, 2 * half + 1):
            yield _pair_case(given(formula), n, last_pair(n))
        for name in PRINTED_PAIRS:
            v = merged(name)
            knots = {r + 1: value for r, value in enumerate(v)}
            pairs = {r // 2 + 1: sum(v[r : r + 2]) / 2 for r in range(0, len(v), 2)}
            for i in range(1, last_pair(len(v)) + 1):
                functions = {
                    "x": lambda r, knots=knots: _looked_up(knots, int(r)),
                    "Y": lambda r, pairs=pairs: _looked_up(pairs, int(r)),
                }
                label = f"{name}, n = {len(v)}, i = {i}"
                yield difference_case(given(formula), label, Meaning({pr.i: i}, functions))

    return cases


def _pair_case(formula: Formula, n: Any, last: Any) -> Case:
    """Decide the rule for every i = 1 .. last: the mean of pair i, whose knots exist up to v_n."""
    relation = formula.relation
    i = relation.lhs.args[0]
    # i - 1 pairs stand before pair i.
    before = 2 * (i - 1)
    residual = sp.expand(relation.rhs - (pr.x[sp.expand(before + 1)] + pr.x[sp.expand(before + 2)]) / 2)
    used = [entry.indices[0] for entry in relation.rhs.atoms(sp.Indexed)]
    missing = [index for index in (x.subs(pr.i, last) for x in used) if not (n - index).is_nonnegative]
    if residual == 0 and missing:
        residual = sp.Symbol(f"undefined: v_({missing[0]}) of v_1 .. v_({n})")
    return Case(f"every pair of v_1 .. v_n, n = {n}", bool(residual == 0), residual=residual)


def sliding_cases(_: Formula | None) -> Iterator[Case]:
    """Decide the other reading of "adjacent": (v_i + v_{i+1}) / 2, i = 1 .. n - 1, gives inner knots that increase."""
    first, gaps = sp.Symbol("v", positive=True), sp.symbols("g_1:3", positive=True)
    knots = list(accumulate((first, *gaps)))
    one, other = ((a + b) / 2 for a, b in pairwise(knots))
    inside = (one - knots[0]).is_positive and (knots[-1] - other).is_positive
    yield Case("any three neighbours", bool(inside and sp.expand(other - one).is_positive))
    for name in PRINTED_PAIRS:
        v = merged(name)
        means = [(a + b) / 2 for a, b in pairwise(v)]
        yield Case(name, len(means) == len(v) - 1 and means == sorted(set(means)) and means[0] > 0 and means[-1] < 1)


def bezier_end_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide how often v_s and v_e stand: so that the curve starts and ends in a control point, all knots in use."""
    start, end = domain_ends(pr.n, pr.ell)
    relation = given(formula).relation
    # Knots 0 .. start, and those from the end of the domain to the last one.
    for label, run in (("v_s", start + 1), ("v_e", last_knot(pr.n, pr.ell) - end + 1)):
        residual = sp.expand(relation.rhs - run)
        yield Case(f"every order: {label}", bool(residual == 0), residual=residual)
    yield from _clamped_ends()
    for name in WITH_MIDDLE_CURVE:
        v = merged(name)
        inner = [sum(v[r : r + 2]) / 2 for r in range(0, len(v) - 1, 2)]
        knots = clamped(CUBIC, *inner)
        points = [net_ring(len(knots) - CUBIC)[0, j] for j in range(len(knots) - CUBIC)]
        ends = (
            de_boor(CUBIC, knots, points, Fraction(0)) == points[0],
            de_boor(CUBIC, knots, points, Fraction(1)) == points[-1],
        )
        yield Case(f"{name}: {len(points)} points", all(ends) and len(points) == len(inner) + CUBIC)
