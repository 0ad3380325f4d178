"""Deciding what section 2 says of a Bezier patch that is divided: (6), the formula for Q_j^s, counts.

De Casteljau's triangle judges values, substitution and degrees in `derivations.bezier` rows. Each check decides its
formula for all degrees first, by what multiplies one control point, and then runs it at some degrees.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.bezier import (
    blossom,
    de_casteljau,
    division_curve,
    division_lemmas,
    expanded_rows,
    row_degrees,
)
from semispline.papers.checks import (
    WITHIN,
    bernstein,
    bernstein_polynomial,
    coefficient,
    is_one,
)
from semispline.papers.ledger import (
    Case,
    Formula,
    Meaning,
    UndefinedError,
    difference_case,
    given,
)
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.bezier_patch import (
    BICUBIC,
    CHOICES,
    DEGREES,
    W_REST,
    X_REST,
    A,
    B,
    W,
    X,
    one_sum,
    patch_value,
    ring_parameters,
    ring_patch,
    with_polynomials,
)


def _division_case(part: str, formula: Formula) -> Case:
    """Decide (6) for every m, n, k by what multiplies P_ab, apart from B_a^m(u), with x = v(u) and w across.

    In Q_j^s it is B_(b-j)^s(x). The sum over s is one of the binomial theorem, C(n, b) X^b Y^(n-b) with 1 = X + Y.
    """
    scale, total = one_sum(formula.relation.rhs)
    label = "every m, n, k: what multiplies P_ab"
    if total is None or total.limits != sp.Sum(0, (pr.s, 0, pr.n)).limits:
        return Case(label, False)

    def in_row(j: Any, s: Any, _u: Any) -> Any:
        return bernstein_polynomial(B - j, s, X, X_REST)

    term = with_polynomials(scale * total.function).replace(pr.Q, in_row)
    s, n = pr.s, pr.n
    if part == "bottom":
        # s runs from b; then X = x w and Y = w (1 - x) + (1 - w).
        outer = sp.binomial(n, B) * (X * W) ** B
        wanted = outer * sp.binomial(n - B, s - B) * (W * X_REST) ** (s - B) * W_REST ** (n - s)
        sum_, place = W * X_REST + W_REST, 1 - X * W
    else:
        # s runs to b; then X = x (1 - w) + w and Y = (1 - x)(1 - w).
        outer = sp.binomial(n, B) * (X_REST * W_REST) ** (n - B)
        wanted = outer * sp.binomial(B, s) * (X * W_REST) ** (B - s) * W**s
        sum_, place = X * W_REST + W, 1 - (1 - X) * (1 - W)
    closed = sp.expand(sum_.subs({X_REST: 1 - X, W_REST: 1 - W}) - place) == 0
    return Case(label, bool(closed and is_one(term / wanted)))


# Every mutant is compared with the same rows and values.
@cache
def _rows(part: str, m: int, n: int, k: int) -> tuple[tuple[Any, ...], ...]:
    return expanded_rows(m, n, k, "bottom" if part == "bottom" else "top")


@cache
def _row_at(part: str, m: int, n: int, k: int, row: int, u: Any) -> Any:
    return de_casteljau(_rows(part, m, n, k)[row], u)


@cache
def _value_across(part: str, m: int, n: int, k: int, u: Any) -> Any:
    """Return P(u, x) where the second parameter of the sub-patch is the generator v."""
    net, function = ring_patch(m, n, k)
    u_, v = ring_parameters(m, n, k)
    cut = de_casteljau(function, u_)
    return patch_value(net, u, cut * v if part == "bottom" else cut + (1 - cut) * v)


def division_cases(part: str) -> Any:
    """Return the check of (6) for the bottom or the top sub-patch, rows by substitution, not by the formula for Q."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield _division_case(part, given(formula))
        for m, n, k in DEGREES:
            u, v = ring_parameters(m, n, k)
            meaning = Meaning(
                {pr.u: u, pr.v: v, pr.n: n},
                {
                    "B": bernstein,
                    "Q": lambda j, s, u, m=m, n=n, k=k: _row_at(part, m, n, k, _row(part, j, s, n), u),
                    "Y": lambda u, _, m=m, n=n, k=k: _value_across(part, m, n, k, u),
                },
            )
            yield difference_case(given(formula), f"degrees {m}, {n}, {k}", meaning, own=m == n == BICUBIC)

    return cases


def _row(part: str, j: Any, s: Any, n: int) -> int:
    """Return which row of the sub-patch Q_j^s is."""
    allowed = (j == 0 and 0 <= s <= n) if part == "bottom" else (0 <= j <= n and j + s == n)
    if not allowed:
        raise UndefinedError(f"Q_{j}^{s} is no row of the {part} sub-patch")
    return int(s if part == "bottom" else j)


def row_formula_cases(depth: int) -> Any:
    """Return the check of the formula for Q_j^s, s = `depth`, against the polynomial P_ij^s at v_r = v(u).

    For every m, n, k: the blossom, affine in each argument, at v(u) = sum of v_r B_r^k(u) is a sum of blossoms at v_r,
    so that the one at v_(b_1), .., v_(b_s) of column a is multiplied by B_a^m B_(b_1)^k .. B_(b_s)^k.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield _row_case(depth, given(formula))
        for m, n, k in DEGREES:
            if n < depth:
                continue
            net, function = ring_patch(m, n, k)
            u, _ = ring_parameters(m, n, k)
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
                yield difference_case(given(formula), label, meaning, own=m == n == BICUBIC)

    return cases


def _row_case(depth: int, formula: Formula) -> Case:
    at = (A, *CHOICES[:depth])
    found = coefficient(formula.relation.rhs, pr.F(A, pr.j, *at[1:]))
    ranges = {factor for factor in sp.Mul.make_args(found) if isinstance(factor, WITHIN)}
    wanted = {WITHIN(0, A, pr.m), *(WITHIN(0, b, pr.k) for b in at[1:])}
    product = bernstein_polynomial(A, pr.m, X, X_REST) * sp.Mul(
        *(bernstein_polynomial(b, pr.k, X, X_REST) for b in at[1:])
    )
    rest = sp.Mul(*(factor for factor in sp.Mul.make_args(found) if factor not in ranges))
    same = formula.relation.lhs == pr.Q(pr.j, depth, pr.u) and is_one(with_polynomials(rest) / product)
    return Case(f"every m, n, k, j, s = {depth}: what multiplies a blossom", bool(ranges == wanted and same))


def row_step_cases(weight: Any = None) -> Iterator[Case]:
    """Decide that one argument more keeps the formula for Q_j^s right, so that it is for every s.

    Its weight times B_at^(m+sk) is a product of Bernstein polynomials; from s - 1 to s both get the factor B_b^k(u).
    """
    weight = weight or (lambda low, at, k, b: sp.binomial(low, at) * sp.binomial(k, b) / sp.binomial(low + k, at + b))
    # The degree m + (s - 1) k and the index i + j_1 + .. + j_(s-1) before.
    low, at, k, b = pr.n, A, pr.k, B
    ratio = (
        weight(low, at, k, b)
        * bernstein_polynomial(at + b, low + k, X, X_REST)
        / bernstein_polynomial(at, low, X, X_REST)
    )
    yield Case("from s - 1 to s, every s, m, k", is_one(ratio / bernstein_polynomial(b, k, X, X_REST)))


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


def count_cases(part: str) -> Any:
    """Return the check of the number of control points of each row: one more than its degree after substitution.

    For every m, n, k: row s of the bottom is a sum of B_i^m(u) times products of s values of v(u) and 1 - v(u), of
    degree m + s k at the most; for the patch u^m v^s and v(u) = u^k, it is u^m (u^k)^s, so that it has that degree. The
    top, which is the bottom of the patch turned round, has n - s for s. Some rows are found by substituting as well.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        u = sp.Symbol("u", positive=True)
        powers = pr.s if part == "bottom" else pr.n - pr.s
        highest = sp.powsimp(u**pr.m * (u**pr.k) ** powers).as_base_exp()[1]
        relation = given(formula).relation
        if all(a == b for a, b in zip(relation.lhs.args, _row_name(part), strict=True)):
            residual = sp.expand(relation.rhs - (highest + 1))
            yield Case("every m, n, k, row s", residual == 0, residual=residual)
        else:
            yield Case("every m, n, k, row s", False, residual=sp.Symbol(f"undefined: {relation.lhs}"))
        for m, n, k in DEGREES:
            rows = _rows(part, m, n, k)
            for r in range(n + 1):
                numbers = {pr.s: r, pr.m: m, pr.n: n, pr.k: k}
                counts = {"F": lambda j, s, rows=rows, n=n: len(rows[_row(part, j, s, n)])}
                own = m == n == BICUBIC
                yield difference_case(
                    given(formula), f"degrees {m}, {n}, {k}, row {r}", Meaning(numbers, counts), own=own
                )

    return cases


def _row_name(part: str) -> tuple[Any, Any]:
    """Return the indices (j, s) of the rows of a sub-patch in (6)."""
    return (sp.Integer(0), pr.s) if part == "bottom" else (pr.s, pr.n - pr.s)


def last_row_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the name of the last row of the top sub-patch, the one with m + 1 control points."""
    j, s = given(formula).relation.lhs.args
    # Row Q_j^s has one point more than its degree; see `count_cases`.
    residual = sp.expand(given(formula).relation.rhs - (pr.m + s * pr.k + 1))
    if not (pr.n - j - s).is_nonnegative:
        residual = sp.Symbol(f"undefined: Q_{j}^{s}")
    yield Case("every m, n, k", bool(residual == 0), residual=residual)
    for m, n, k in DEGREES:
        net, function = ring_patch(m, n, k)

        def length(j: Any, s: Any, net: Any = net, function: Any = function, n: int = n) -> int:
            if j < 0 or s < 0 or j + s > n:
                raise UndefinedError(f"Q_{j}^{s}")
            return len(division_curve(net, function, int(j), int(s)))

        numbers = {pr.m: m, pr.n: n}
        yield difference_case(
            given(formula), f"degrees {m}, {n}, {k}", Meaning(numbers, {"F": length}), own=m == n == BICUBIC
        )


def same_order_cases(_: Formula | None) -> Iterator[Case]:
    """Decide whether all rows of a sub-patch have one order, as the curves of Definition 1 have."""
    count = pr.COUNT_BOTTOM.relation.rhs
    spread = sp.expand(count.subs(pr.s, pr.n) - count.subs(pr.s, 0))
    yield Case("every m, n, k: degree of the last row less that of the first", bool(spread == 0), residual=spread)
    for m, n, k in DEGREES:
        orders = {degree + 1 for degree in row_degrees(m, n, k, "bottom")}
        yield Case(f"degrees {m}, {n}, {k}: orders {sorted(orders)}", len(orders) == 1, own=m == n == BICUBIC)
