"""Deciding the Bezier example of section 2: (4) to (6), the formula for Q_j^s, blossoms, counts.

Judges: de Casteljau's triangle for values, substitution and degrees in `derivations.bezier` for rows. Each check
decides its formula for all degrees first, by what multiplies one control point, and then runs it at some degrees.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.bezier import (
    blossom,
    division_curve,
    division_lemmas,
    expanded_rows,
    generic_patch,
    row_degrees,
)
from semispline.papers.ledger import (
    SAME,
    WITHIN,
    Case,
    Check,
    Formula,
    Meaning,
    Strength,
    UndefinedError,
    bernstein,
    coefficient,
    difference_case,
    given,
    indexed,
)
from semispline.papers.lin2014 import printed as pr

# Degrees m, n of the patch and k of the Bezier function; the paper's own example is bicubic.
DEGREES = ((1, 1, 1), (2, 2, 1), (1, 3, 2), (3, 3, 1), (2, 1, 3), (3, 3, 2))
BICUBIC = 3
# Any control point, and the argument of blossom number r.
_A, _B = sp.symbols("a b", integer=True, nonnegative=True)
_CHOICES = sp.symbols("b_1:4", integer=True, nonnegative=True)
# A parameter and one minus it, twice; apart, since products of their powers are compared.
_X, _X_REST, _W, _W_REST = sp.symbols("x x' w w'", positive=True)


def polynomial(index: Any, degree: Any, x: Any, rest: Any) -> Any:
    """Return a Bernstein polynomial of any degree, `rest` standing for 1 - x."""
    return sp.binomial(degree, index) * x**index * rest ** (degree - index)


def _is_one(ratio: Any) -> bool:
    return bool(sp.gammasimp(sp.powsimp(sp.expand_power_base(ratio))) == 1)


def triangle_cases(function: Any = polynomial) -> Iterator[Case]:
    """Decide that the factors of control points in de Casteljau's triangle are Bernstein polynomials, for every degree.

    By induction over the degree: a step of the triangle gives point r the factor (1 - x) c_r^(k-1) + x c_(r-1)^(k-1).
    So the polynomials, which are made of such steps, are not negative and sum to 1, as the one of degree 0 does.
    """
    k, r = sp.symbols("k r", integer=True, positive=True)

    def residual(index: Any) -> Any:
        lower = _X_REST * function(index, k - 1, _X, _X_REST) + _X * function(index - 1, k - 1, _X, _X_REST)
        common = _X**index * _X_REST ** (k - index)
        return sp.gammasimp(sp.powsimp(sp.expand((function(index, k, _X, _X_REST) - lower) / common)))

    for name, index in (("inner", r), ("first", sp.Integer(0)), ("last", k)):
        left = residual(index)
        yield Case(f"a step of the triangle, every degree, {name} index", bool(left == 0), residual=left)
    yield Case("degree 0", bool(function(sp.Integer(0), sp.Integer(0), _X, _X_REST) == 1))


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
    found = coefficient(given(formula).relation.rhs, pr.P[_A, _B])
    wanted = pr.B(_A, pr.m, pr.u) * pr.B(_B, pr.n, pr.v) * WITHIN(0, _A, pr.m) * WITHIN(0, _B, pr.n)
    yield Case("every m, n: what multiplies P_ab", bool(found == wanted), residual=sp.factor_terms(found - wanted))
    for m, n, k in DEGREES:
        net, _ = _patch(m, n, k)
        u, v = _parameters(m, n, k)
        functions = {"P": _net_lookup(net), "B": bernstein, "Y": lambda u, v, net=net: _value(net, u, v)}
        meaning = Meaning({pr.u: u, pr.v: v, pr.m: m, pr.n: n}, functions)
        yield difference_case(given(formula), f"degrees {m}, {n}", meaning, own=m == n == BICUBIC)


def _net_lookup(net: list[list[Any]]) -> Any:
    return indexed("P", {(i, j): value for i, row in enumerate(net) for j, value in enumerate(row)})


def function_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (5) or the abscissae i/k of its control points, for v_0, ..., v_k in a ring."""
    right = given(formula).relation.rhs
    if right.has(pr.v_c):
        found, wanted = coefficient(right, pr.v_c[_A]), pr.B(_A, pr.k, pr.t) * WITHIN(0, _A, pr.k)
        yield Case("every k: what multiplies v_a", bool(found == wanted), residual=sp.factor_terms(found - wanted))
    else:
        yield Case("every k: term i is t B_(i-1)^(k-1), and these sum to t", _sums_to_parameter(right))
    for k in range(1, 6):
        _, function = _patch(1, 1, k)
        lookup = indexed("v", {(r,): value for r, value in enumerate(function)})
        t, _ = _parameters(1, 1, k)
        functions = {"v": lookup, "B": bernstein, "C": lambda t, f=function: de_casteljau(f, t)}
        yield difference_case(given(formula), f"degree {k}", Meaning({pr.t: t, pr.k: k}, functions))


def _sums_to_parameter(right: Any) -> bool:
    """Tell whether a sum over i = 0 .. k, or 1 .. k, has the terms t B_(i-1)^(k-1)(t)."""
    scale, total = _one_sum(right)
    if total is None or len(total.limits) != 1:
        return False
    (index, low, high), term = total.limits[0], scale * total.function
    if index != pr.i or low not in (0, 1) or high != pr.k:
        return False
    i = sp.Symbol("i", integer=True, positive=True)
    term = _with_polynomials(term).xreplace({index: i})
    return _is_one(term / (_X * polynomial(i - 1, pr.k - 1, _X, _X_REST)))


def _one_sum(expression: Any) -> tuple[Any, Any]:
    """Split an expression into factors and the one sum among them; no sum where there is not just one."""
    factors = sp.Mul.make_args(expression)
    sums = [factor for factor in factors if isinstance(factor, sp.Sum)]
    others = (factor for factor in factors if not isinstance(factor, sp.Sum))
    return sp.Mul(*others), sums[0] if len(sums) == 1 else None


def _with_polynomials(expression: Any) -> Any:
    """Write B(i, n, .) as polynomials: in w if the argument is v, else in x."""

    def written(index: Any, degree: Any, argument: Any) -> Any:
        return polynomial(index, degree, *((_W, _W_REST) if argument == pr.v else (_X, _X_REST)))

    return expression.replace(pr.B, written)


def _division_case(part: str, formula: Formula) -> Case:
    """Decide (6) for every m, n, k by what multiplies P_ab, apart from B_a^m(u), with x = v(u) and w across.

    In Q_j^s it is B_(b-j)^s(x). The sum over s is one of the binomial theorem, C(n, b) X^b Y^(n-b) with 1 = X + Y.
    """
    scale, total = _one_sum(formula.relation.rhs)
    label = "every m, n, k: what multiplies P_ab"
    if total is None or total.limits != sp.Sum(0, (pr.s, 0, pr.n)).limits:
        return Case(label, False)

    def in_row(j: Any, s: Any, _u: Any) -> Any:
        return polynomial(_B - j, s, _X, _X_REST)

    term = _with_polynomials(scale * total.function).replace(pr.Q, in_row)
    s, n = pr.s, pr.n
    if part == "bottom":
        # s runs from b; then X = x w and Y = w (1 - x) + (1 - w).
        outer = sp.binomial(n, _B) * (_X * _W) ** _B
        wanted = outer * sp.binomial(n - _B, s - _B) * (_W * _X_REST) ** (s - _B) * _W_REST ** (n - s)
        sum_, place = _W * _X_REST + _W_REST, 1 - _X * _W
    else:
        # s runs to b; then X = x (1 - w) + w and Y = (1 - x)(1 - w).
        outer = sp.binomial(n, _B) * (_X_REST * _W_REST) ** (n - _B)
        wanted = outer * sp.binomial(_B, s) * (_X * _W_REST) ** (_B - s) * _W**s
        sum_, place = _X * _W_REST + _W, 1 - (1 - _X) * (1 - _W)
    closed = sp.expand(sum_.subs({_X_REST: 1 - _X, _W_REST: 1 - _W}) - place) == 0
    return Case(label, bool(closed and _is_one(term / wanted)))


def division_cases(part: str) -> Any:
    """Return the check of (6) for the bottom or the top sub-patch, rows by substitution, not by the formula for Q."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield _division_case(part, given(formula))
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
                yield difference_case(given(formula), label, meaning, own=m == n == BICUBIC)

    return cases


def _row_case(depth: int, formula: Formula) -> Case:
    at = (_A, *_CHOICES[:depth])
    found = coefficient(formula.relation.rhs, pr.F(_A, pr.j, *at[1:]))
    ranges = {factor for factor in sp.Mul.make_args(found) if isinstance(factor, WITHIN)}
    wanted = {WITHIN(0, _A, pr.m), *(WITHIN(0, b, pr.k) for b in at[1:])}
    product = polynomial(_A, pr.m, _X, _X_REST) * sp.Mul(*(polynomial(b, pr.k, _X, _X_REST) for b in at[1:]))
    rest = sp.Mul(*(factor for factor in sp.Mul.make_args(found) if factor not in ranges))
    same = formula.relation.lhs == pr.Q(pr.j, depth, pr.u) and _is_one(_with_polynomials(rest) / product)
    return Case(f"every m, n, k, j, s = {depth}: what multiplies a blossom", bool(ranges == wanted and same))


def row_step_cases(weight: Any = None) -> Iterator[Case]:
    """Decide that one argument more keeps the formula for Q_j^s right, so that it is for every s.

    Its weight times B_at^(m+sk) is a product of Bernstein polynomials; from s - 1 to s both get the factor B_b^k(u).
    """
    weight = weight or (lambda low, at, k, b: sp.binomial(low, at) * sp.binomial(k, b) / sp.binomial(low + k, at + b))
    # The degree m + (s - 1) k and the index i + j_1 + .. + j_(s-1) before.
    low, at, k, b = pr.n, _A, pr.k, _B
    ratio = weight(low, at, k, b) * polynomial(at + b, low + k, _X, _X_REST) / polynomial(at, low, _X, _X_REST)
    yield Case("from s - 1 to s, every s, m, k", _is_one(ratio / polynomial(b, k, _X, _X_REST)))


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

    The polar form of a Bernstein sum is the sum of products over all choices: symmetric and affine by construction.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        residual = (_first_step if first else _further_step)(given(formula).relation)
        yield Case("every m, n, i, j, s", bool(residual == 0), residual=residual)
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
                    yield difference_case(given(formula), f"n = {n}, s = {s}, j = {j}", Meaning(numbers, functions))

    return cases


def _first_step(relation: Any) -> Any:
    """Return right minus left: one argument chooses between two points."""
    if relation.lhs != pr.F(1, pr.i, pr.j):
        return sp.Symbol(f"undefined: {relation.lhs}")
    x = pr.v_c[pr.j_1]
    return sp.expand(relation.rhs - sum((x if up else 1 - x) * pr.P[pr.i, pr.j + up] for up in (0, 1)))


def _further_step(relation: Any) -> Any:
    """Return right minus left in what multiplies P_ab, E(s, c) the sum over all choices of c among s arguments.

    Those with argument s among the c and those without it: E(s, c) = (1 - x_s) E(s-1, c) + x_s E(s-1, c-1).
    """
    choices = sp.Function("E")
    s, i, j = relation.lhs.args
    x, c = pr.x[s], _B - j
    left = SAME(i, _A) * ((1 - x) * choices(s - 1, c) + x * choices(s - 1, c - 1))
    right = relation.rhs.replace(pr.F, lambda s, i, j: SAME(i, _A) * choices(s, _B - j))
    return sp.expand(right - left)


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
            rows = expanded_rows(m, n, k, "bottom" if part == "bottom" else "top")
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
        net, function = _patch(m, n, k)

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


def elevation_cases(share: Any = None) -> Iterator[Case]:
    """Decide that a Bezier curve of any degree d is one of degree d + 1: so all rows can be given the highest degree.

    B_r^d = (1 - (r+1)/(d+1) + 1/(d+1)) B_r^(d+1) + (r+1)/(d+1) B_(r+1)^(d+1).
    """
    share = share or (lambda r, d: (r + 1) / (d + 1))
    d, r = sp.symbols("d r", integer=True, nonnegative=True)
    kept, raised = 1 - share(r - 1, d), share(r, d)
    own = polynomial(r, d, _X, _X_REST)
    shares = (kept * polynomial(r, d + 1, _X, _X_REST) / own, raised * polynomial(r + 1, d + 1, _X, _X_REST) / own)
    total = sum(sp.gammasimp(sp.powsimp(x)) for x in shares)
    residual = sp.expand(sp.cancel(total).subs(_X_REST, 1 - _X) - 1)
    yield Case("every degree: one degree more", bool(residual == 0), residual=residual)


def check(cases: Any, method: str, *, proof: bool = False, strength: Strength = Strength.RATIONAL) -> Check:
    """Return a check with its method."""
    return Check(cases, strength, method, proof)
