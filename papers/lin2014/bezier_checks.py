"""Deciding the Bezier example of section 2: (4) to (6), the formula for Q_j^s, blossoms, counts.

Judges: de Casteljau's triangle for values, substitution and degrees in `derivations.bezier` for rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from derivations.bezier import blossom, division_curve, division_lemmas, expanded_rows, generic_patch, row_degrees
from papers.ledger import Case, Check, Formula, Strength
from papers.lin2014 import printed as pr
from papers.lin2014.exact import Meaning, UndefinedError, bernstein, difference_case, indexed

# Degrees m, n of the patch and k of the Bezier function; the paper's own example is bicubic.
DEGREES = ((1, 1, 1), (2, 2, 1), (1, 3, 2), (3, 3, 1), (2, 1, 3), (3, 3, 2))
BICUBIC = 3


@cache
def _patch(m: int, n: int, k: int) -> tuple[list[list[Any]], list[Any]]:
    """Return ring generators for P_ij and v_r."""
    _, _, net, function = generic_patch(m, n, k)
    return net, function


@cache
def _parameters(m: int, n: int, k: int) -> tuple[Any, Any]:
    """Return two more generators of the same ring, for parameters: what holds for them holds for all values."""
    u, w, _, _ = generic_patch(m, n, k)
    return u, w


def de_casteljau(points: Any, x: Any) -> Any:
    """Return a Bezier polynomial at x: its blossom with equal arguments."""
    return blossom(points, [x] * (len(points) - 1))


def _value(net: list[list[Any]], u: Fraction, v: Any) -> Any:
    return de_casteljau([de_casteljau(row, v) for row in net], u)


def patch_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (4): the double sum against de Casteljau."""
    for m, n, k in DEGREES:
        net, _ = _patch(m, n, k)
        u, v = _parameters(m, n, k)
        functions = {"P": _net_lookup(net), "B": bernstein, "Y": lambda u, v, net=net: _value(net, u, v)}
        meaning = Meaning({pr.u: u, pr.v: v, pr.m: m, pr.n: n}, functions)
        yield difference_case(_given(formula), f"degrees {m}, {n}", meaning, own=m == n == BICUBIC)


def _net_lookup(net: list[list[Any]]) -> Any:
    return indexed("P", {(i, j): value for i, row in enumerate(net) for j, value in enumerate(row)})


def function_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (5) or the abscissae i/k of its control points, for v_0, ..., v_k in a ring."""
    for k in range(1, 6):
        _, function = _patch(1, 1, k)
        lookup = indexed("v", {(r,): value for r, value in enumerate(function)})
        t, _ = _parameters(1, 1, k)
        functions = {"v": lookup, "B": bernstein, "C": lambda t, f=function: de_casteljau(f, t)}
        yield difference_case(_given(formula), f"degree {k}", Meaning({pr.t: t, pr.k: k}, functions))


def range_cases(_: Formula | None) -> Iterator[Case]:
    """Decide whether v_i in [0, 1] keeps v(t) in [0, 1], for every degree: by induction over the degree.

    B_r^k = (1 - t) B_r^(k-1) + t B_(r-1)^(k-1), with weights that are not negative and sum to 1: so the polynomials of
    every degree are not negative and sum to 1, as the one of degree 0 does, and v(t) is a mean of the v_i.
    """
    k, r = sp.symbols("k r", integer=True, positive=True)
    t, rest = sp.symbols("t w", positive=True)  # w stands for 1 - t

    def function(index: Any, degree: Any) -> Any:
        return sp.binomial(degree, index) * t**index * rest ** (degree - index)

    def residual(index: Any) -> Any:
        lower = rest * function(index, k - 1) + t * function(index - 1, k - 1)
        common = t**index * rest ** (k - index)
        return sp.gammasimp(sp.powsimp(sp.expand((function(index, k) - lower) / common)))

    for name, index in (("inner", r), ("first", sp.Integer(0)), ("last", k)):
        left = residual(index)
        yield Case(f"recurrence, every degree, {name} index", left == 0, residual=left)
    yield Case("degree 0", bernstein(0, 0, t) == 1)


def division_cases(part: str) -> Any:
    """Return the check of (6) for the bottom or the top sub-patch, rows by substitution, not by the formula for Q."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        for m, n, k in DEGREES:
            net, function = _patch(m, n, k)
            rows = expanded_rows(m, n, k, "bottom" if part == "bottom" else "top")
            u, v = _parameters(m, n, k)
            cut = de_casteljau(function, u)
            at = cut * v if part == "bottom" else cut + (1 - cut) * v
            meaning = Meaning(
                {pr.u: u, pr.v: v, pr.n: n},
                {
                    "B": bernstein,
                    "Q": lambda j, s, u, rows=rows, n=n: de_casteljau(rows[_row(part, j, s, n)], u),
                    "Y": lambda u, _, net=net, at=at: _value(net, u, at),
                },
            )
            yield difference_case(_given(formula), f"degrees {m}, {n}, {k}", meaning, own=m == n == BICUBIC)

    return cases


def _row(part: str, j: Any, s: Any, n: int) -> int:
    """Return which row of the sub-patch Q_j^s is."""
    allowed = (j == 0 and 0 <= s <= n) if part == "bottom" else (0 <= j <= n and j + s == n)
    if not allowed:
        raise UndefinedError(f"Q_{j}^{s} is no row of the {part} sub-patch")
    return int(s if part == "bottom" else j)


def row_formula_cases(depth: int) -> Any:
    """Return the check of the formula for Q_j^s, s = `depth`, against the polynomial P_ij^s at v_r = v(u)."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        for m, n, k in DEGREES:
            if n < depth:
                continue
            net, function = _patch(m, n, k)
            u, _ = _parameters(m, n, k)
            for j in range(n - depth + 1):
                meaning = Meaning(
                    {pr.j: j, pr.u: u, pr.m: m, pr.k: k},
                    {
                        "B": bernstein,
                        "Q": lambda j, s, u, net=net, f=function: _division_value(net, f, j, s, u),
                        "F": lambda i, j, *r, net=net, f=function: _blossom_at(net, f, i, j, r),
                    },
                )
                label = f"degrees {m}, {n}, {k}, j = {j}"
                yield difference_case(_given(formula), label, meaning, own=m == n == BICUBIC)

    return cases


def _division_value(net: list[list[Any]], function: list[Any], j: Any, s: Any, u: Fraction) -> Any:
    """Return Q_j^s(u) without blossoms at v_r: a blossom is affine, so its value at v(u) can be taken directly."""
    j, s = int(j), int(s)
    if j < 0 or j + s >= len(net[0]):
        raise UndefinedError(f"Q_{j}^{s}")
    cut = de_casteljau(function, u)
    return de_casteljau([blossom(row[j : j + s + 1], [cut] * s) for row in net], u)


def _blossom_at(net: list[list[Any]], function: list[Any], i: Any, j: Any, indices: tuple[Any, ...]) -> Any:
    i, j, s = int(i), int(j), len(indices)
    if not (0 <= i < len(net) and j >= 0 and j + s < len(net[0]) and all(0 <= r < len(function) for r in indices)):
        raise UndefinedError(f"P_{i},{j}^{s}")
    return blossom(net[i][j : j + s + 1], [function[int(r)] for r in indices])


def lemma_cases(_: Formula | None) -> Iterator[Case]:
    """Decide the identities on which the closed form stands for every m, n, k."""
    for name, residual in division_lemmas().items():
        yield Case(f"lemma: {name}", residual == 0, residual=residual)


def blossom_cases(first: bool) -> Any:
    """Return the check of the recursion, its first step or the others, against the polar form by its definition.

    The polar form of a Bernstein sum is the mean of products over all choices: symmetric and affine by construction.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        for m, n, k in ((1, 2, 2), (1, 3, 2), (2, 4, 3)):
            net, function = _patch(m, n, k)
            arguments = [function[r % (k + 1)] for r in range(n)]
            for s in (1,) if first else range(2, n + 1):
                for j in range(n - s + 1):
                    numbers = {pr.i: m, pr.j: j, pr.j_1: 0} if first else {pr.i: m, pr.j: j, pr.s: s}
                    functions = {
                        "P": _net_lookup(net),
                        "v": indexed("v", {(r,): value for r, value in enumerate(function)}),
                        "x": indexed("x", {(r + 1,): value for r, value in enumerate(arguments)}),
                        "F": lambda s, i, j, net=net, a=arguments: _polar(net, int(i), int(j), a[: int(s)]),
                    }
                    yield difference_case(_given(formula), f"n = {n}, s = {s}, j = {j}", Meaning(numbers, functions))

    return cases


def _polar(net: list[list[Any]], i: int, j: int, arguments: list[Any]) -> Any:
    """Return the symmetric multi-affine form of the points P_i,j .. P_i,j+s: a sum over subsets of the arguments."""
    s = len(arguments)
    if not 0 <= i < len(net) or j < 0 or j + s >= len(net[i]):
        raise UndefinedError(f"P_{i},{j}^{s}")
    row = net[i]
    total = 0 * row[0]
    for choice in range(2**s):
        weight, ups = 1, 0
        for r, x in enumerate(arguments):
            up = choice >> r & 1
            weight, ups = weight * (x if up else 1 - x), ups + up
        total += weight * row[j + ups]
    return total


def count_cases(part: str) -> Any:
    """Return the check of the number of control points of each row: one more than its degree after substitution.

    For every m, n, k: the coefficient of B_s^n in (6) has the terms P_i v(u)^s, and no higher power of v. Degree by
    degree the rows are found by substituting, so that no power cancels for control points in general.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        u = sp.Symbol("u", positive=True)
        powers = pr.s if part == "bottom" else pr.n - pr.s
        highest = sp.powsimp(u**pr.m * (u**pr.k) ** powers).as_base_exp()[1]
        relation = _given(formula).relation
        if all(a == b for a, b in zip(relation.lhs.args, _row_name(part), strict=True)):
            residual = sp.expand(relation.rhs - (highest + 1))
            yield Case("every m, n, k, row s", residual == 0, residual=residual)
        else:
            yield Case("every m, n, k, row s", False, residual=sp.Symbol(f"undefined: {relation.lhs}"))
        for m, n, k in DEGREES:
            rows = expanded_rows(m, n, k, "bottom" if part == "bottom" else "top")
            for r in range(n + 1):
                numbers = {pr.s: r, pr.m: m, pr.n: n, pr.k: k}
                counts = {"F": lambda j, s, rows=rows, n=n: len(rows[_row(part, j, s, n)])}
                own = m == n == BICUBIC
                yield difference_case(
                    _given(formula), f"degrees {m}, {n}, {k}, row {r}", Meaning(numbers, counts), own=own
                )

    return cases


def _row_name(part: str) -> tuple[Any, Any]:
    """Return the indices (j, s) of the rows of a sub-patch in (6)."""
    return (sp.Integer(0), pr.s) if part == "bottom" else (pr.s, pr.n - pr.s)


def last_row_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the name of the last row of the top sub-patch, the one with m + 1 control points."""
    for m, n, k in DEGREES:
        net, function = _patch(m, n, k)

        def length(j: Any, s: Any, net: Any = net, function: Any = function, n: int = n) -> int:
            if j < 0 or s < 0 or j + s > n:
                raise UndefinedError(f"Q_{j}^{s}")
            return len(division_curve(net, function, int(j), int(s)))

        numbers = {pr.m: m, pr.n: n}
        yield difference_case(
            _given(formula), f"degrees {m}, {n}, {k}", Meaning(numbers, {"F": length}), own=m == n == BICUBIC
        )


def same_order_cases(_: Formula | None) -> Iterator[Case]:
    """Decide whether all rows of a sub-patch have one order, as the curves of Definition 1 have."""
    for m, n, k in DEGREES:
        orders = {degree + 1 for degree in row_degrees(m, n, k, "bottom")}
        yield Case(f"degrees {m}, {n}, {k}: orders {sorted(orders)}", len(orders) == 1, own=m == n == BICUBIC)


def curve_based_cases(_: Formula | None) -> Iterator[Case]:
    """Decide whether a sub-patch is a skin of n + 1 Bezier curves, each of its own degree: (6) again, row by row."""
    for m, n, k in DEGREES:
        for part in ("bottom", "top"):
            rows = expanded_rows(m, n, k, "bottom" if part == "bottom" else "top")
            degrees = tuple(len(row) - 1 for row in rows)
            yield Case(f"degrees {m}, {n}, {k}, {part}", degrees == row_degrees(m, n, k, part))


def check(cases: Any, method: str, *, proof: bool = False, strength: Strength = Strength.RATIONAL) -> Check:
    """Return a check with its method."""
    return Check(cases, strength, method, proof)


def _given(formula: Formula | None) -> Formula:
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    return formula
