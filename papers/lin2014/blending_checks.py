"""Deciding the construction of section 3: knots of base, blend and middle curve, and which rows belong to whom."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import sympy as sp

from derivations.contact import A, contact_rows
from derivations.splines import span_symbols
from papers.ledger import Case, Formula
from papers.lin2014 import printed as pr
from papers.lin2014.exact import Meaning, UndefinedError, clamped, de_boor, difference_case, net_ring
from papers.lin2014.property_checks import contained, union
from papers.lin2014.spline_checks import functions_on

CUBIC = 4
# The pairs of contact curves whose knots the paper prints; those of Fig. 10 with the fourth zero that is missing.
PRINTED_PAIRS = {
    "Fig. 5": ("fig-5.first", "fig-5.second"),
    "Fig. 6": ("fig-6.planar", "fig-6.curved"),
    "Figs. 8 and 9": ("fig-8.larger", "fig-8.smaller"),
    "Fig. 10": ("fig-10.first", "fig-10.second"),
}
WITH_MIDDLE_CURVE = ("Fig. 5", "Fig. 6", "Figs. 8 and 9")


def printed_pair(name: str) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
    """Return both knot vectors of a figure, clamped."""
    first, second = (clamped(CUBIC, *inner_knots(key)) for key in PRINTED_PAIRS[name])
    return first, second


def inner_knots(key: str) -> list[Fraction]:
    """Return the knots of a printed vector strictly inside [0, 1]."""
    return [Fraction(int(x.p), int(x.q)) for x in map(sp.Rational, pr.KNOTS[key]) if 0 < x < 1]


def contact_curve_cases() -> Iterator[Case]:
    """Yield bases: at the clamped end w_s the surface is the curve of its first row over V^r, or V^s."""
    for k, length in ((2, 3), (3, 2), (4, 4)):
        across, along = clamped(k, Fraction(1, 3), start=-1, end=2), clamped(length, Fraction(1, 4), Fraction(3, 5))
        rows, columns = len(across) - k, len(along) - length
        net = net_ring(*[columns] * rows, letter="R")
        for v in (Fraction(0), Fraction(1, 5), Fraction(4, 7), Fraction(1)):
            curves = [de_boor(length, along, [net[i, j] for j in range(columns)], v) for i in range(rows)]
            same = de_boor(k, across, curves, Fraction(-1)) == curves[0]
            yield Case(f"orders {k}, {length} at v = {v}", bool(same), own=k == length == CUBIC)


def mismatch_cases() -> Iterator[Case]:
    """Yield pairs of knot vectors: true where no single one of the two carries both contact curves."""
    pairs = {name: printed_pair(name) for name in PRINTED_PAIRS}
    half = Fraction(1, 2)
    pairs["{1/2} and {1/4, 1/2, 3/4}"] = (clamped(4, half), clamped(4, half / 2, half, 3 * half / 2))
    for name, (a, b) in pairs.items():
        nested = set(a) <= set(b) or set(b) <= set(a)
        carried = contained(CUBIC, a, b) or contained(CUBIC, b, a)
        yield Case(name, not carried, own=name in PRINTED_PAIRS, meets=not nested)


def nested_space_cases() -> Iterator[Case]:
    """Yield printed pairs: the spline space of either vector lies in that of the union of knots."""
    for name in PRINTED_PAIRS:
        a, b = printed_pair(name)
        both = union(CUBIC, a, b)
        yield Case(name, contained(CUBIC, a, both) and contained(CUBIC, b, both))


def layout_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the bound on m: what it admits has disjoint first and last three curves, and enough rows for order k."""
    relation = _given(formula).relation
    for k in range(2, 8):
        admitted = [m for m in range(1, 12) if relation.subs({pr.k: k, pr.m: m})]
        unsound = [m for m in admitted if m - 2 <= 2 or m + 1 < k]
        if k < CUBIC:
            label = f"k = {k}" + (f", m = {unsound[0]}" if unsound else "")
            yield Case(label, not unsound, own=False, meets=False)
        for m in admitted if k >= CUBIC else ():
            yield Case(f"k = {k}, m = {m}", m not in unsound, own=k == CUBIC)


def u_length_instances() -> Iterator[tuple[str, dict[Any, Any], bool]]:
    """Count: the last index of U for m + 1 functions of order k."""
    for k in range(2, 7):
        for m in range(k + 1, k + 5):
            length = next(x for x in range(1, 40) if functions_on(x, k) == m + 1)
            yield f"k = {k}, m = {m}", {pr.last: length - 1, pr.m: m, pr.k: k}, k == CUBIC


def uniform_knot_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide u_i: the inner knots divide [0, 1] into equal spans."""
    for k in range(2, 7):
        for m in range(k + 1, k + 5):
            inner = next(x for x in range(1, 40) if functions_on(x, k) == m + 1) - 2 * k
            for i in range(1, inner + 1):
                at = {int(r): Fraction(r, inner + 1) for r in range(1, inner + 1)}
                meaning = Meaning({pr.i: i, pr.m: m, pr.k: k}, {"Y": lambda r, at=at: _looked_up(at, int(r))})
                yield difference_case(_given(formula), f"k = {k}, m = {m}, u_{i}", meaning, own=k == CUBIC)


def _looked_up(values: dict[int, Any], key: int) -> Any:
    if key not in values:
        raise UndefinedError(f"{key} of {sorted(values)}")
    return values[key]


def three_row_cases() -> Iterator[Case]:
    """Yield orders: rows 0..2 of the blend are combinations of rows 0..2 of the base, and row 2 needs R_2."""
    every = contact_rows(2, pr.k - 1, span_symbols(2), pr.k_r - 1, span_symbols(2, "H"))
    for k in range(3, 8):
        for k_r in range(3, 8):
            rows = every.subs({pr.k: k, pr.k_r: k_r})
            needed = rows[2, 2] != 0 and rows[1, 1] != 0 and rows[2, 2].has(A)
            yield Case(f"orders {k}, {k_r}", bool(rows.shape == (3, 3) and needed), own=k == k_r == CUBIC)


def middle_curve_cases() -> Iterator[Case]:
    """Yield k = 4: with m = k + 1 there is no row between the first and last three, with m = 6 there is just P_3."""
    for m, middle in ((5, []), (6, [3])):
        rows = [i for i in range(m + 1) if 2 < i < m - 2]
        yield Case(f"m = {m}", rows == middle)


@cache
def merged(name: str) -> tuple[Fraction, ...]:
    """Return v_1, .., v_n of a figure: inner knots of both vectors, each once."""
    first, second = PRINTED_PAIRS[name]
    return tuple(sorted({*inner_knots(first), *inner_knots(second)}))


def paired_cases(last_pair: Callable[[int], int]) -> Callable[[Formula | None], Iterator[Case]]:
    """Return the check of the averaging rule for i = 1 .. last_pair(n), on the printed vectors."""

    def cases(formula: Formula | None) -> Iterator[Case]:
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
                yield difference_case(_given(formula), label, Meaning({pr.i: i}, functions))

    return cases


def sliding_cases(_: Formula | None) -> Iterator[Case]:
    """Decide the other reading of "adjacent": (v_i + v_{i+1}) / 2, i = 1 .. n - 1, gives inner knots that increase."""
    for name in PRINTED_PAIRS:
        v = merged(name)
        means = [(a + b) / 2 for a, b in pairwise(v)]
        yield Case(name, len(means) == len(v) - 1 and means == sorted(set(means)) and means[0] > 0 and means[-1] < 1)


def bezier_end_cases() -> Iterator[Case]:
    """Yield figures: the averaged knots with l-fold v_s and v_e clamp a curve with l more points than inner knots."""
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


def side_cases() -> Iterator[Case]:
    """Yield the six conditions: those with R concern P_0 .. P_2, those with S concern P_{m-2} .. P_m."""
    start, end = {pr.P_0, pr.P_1, pr.P_2}, {pr.P_m, pr.P_m1, pr.P_m2}
    of_r, of_s = {pr.R_0, pr.R_1, pr.R_2}, {pr.S_0, pr.S_1, pr.S_2}
    for name, rows, base, others in (
        *((f"({i}.1)", start, of_r, end | of_s) for i in (1, 2, 3)),
        *((f"({i}.2)", end, of_s, start | of_r) for i in (1, 2, 3)),
    ):
        letters = getattr(pr, f"COND_{name[1]}_{name[3]}").relation.free_symbols
        yield Case(name, bool(letters & rows) and bool(letters & base) and not letters & others)


def _given(formula: Formula | None) -> Formula:
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    return formula
