"""Deciding the Bezier patch and function of section 2: (4), (5), blossoms.

De Casteljau's triangle judges. Each check decides its formula for all degrees first, by what multiplies one control
point, and then runs it at some degrees.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau, generic_patch
from semispline.papers.checks import (
    SAME,
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
    indexed,
)
from semispline.papers.lin2014 import printed as pr

# Degrees m, n of the patch and k of the Bezier function; the paper's own example is bicubic.
DEGREES = ((1, 1, 1), (2, 2, 1), (1, 3, 2), (3, 3, 1), (2, 1, 3), (3, 3, 2))
BICUBIC = 3
# Any control point, and the argument of blossom number r.
A, B = sp.symbols("a b", integer=True, nonnegative=True)
CHOICES = sp.symbols("b_1:4", integer=True, nonnegative=True)
# A parameter and one minus it, twice; apart, since products of their powers are compared.
X, X_REST, W, W_REST = sp.symbols("x x' w w'", positive=True)


@cache
def ring_patch(m: int, n: int, k: int) -> tuple[list[list[Any]], list[Any]]:
    """Return ring generators for P_ij and v_r."""
    _, _, net, function = generic_patch(m, n, k)
    return net, function


@cache
def ring_parameters(m: int, n: int, k: int) -> tuple[Any, Any]:
    """Return two more generators of the same ring, for parameters: what holds for them holds for all values."""
    u, w, _, _ = generic_patch(m, n, k)
    return u, w


def patch_value(net: list[list[Any]], u: Fraction, v: Any) -> Any:
    """Return P(u, v), by de Casteljau's triangle in both directions."""
    return de_casteljau([de_casteljau(row, v) for row in net], u)


def patch_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (4): the double sum against de Casteljau."""
    found = coefficient(given(formula).relation.rhs, pr.P[A, B])
    wanted = pr.B(A, pr.m, pr.u) * pr.B(B, pr.n, pr.v) * WITHIN(0, A, pr.m) * WITHIN(0, B, pr.n)
    yield Case("every m, n: what multiplies P_ab", bool(found == wanted), residual=sp.factor_terms(found - wanted))
    for m, n, k in DEGREES:
        net, _ = ring_patch(m, n, k)
        u, v = ring_parameters(m, n, k)
        functions = {"P": _net_lookup(net), "B": bernstein, "Y": lambda u, v, net=net: patch_value(net, u, v)}
        meaning = Meaning({pr.u: u, pr.v: v, pr.m: m, pr.n: n}, functions)
        yield difference_case(given(formula), f"degrees {m}, {n}", meaning, own=m == n == BICUBIC)


def _net_lookup(net: list[list[Any]]) -> Any:
    return indexed("P", {(i, j): value for i, row in enumerate(net) for j, value in enumerate(row)})


def function_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide (5) or the abscissae i/k of its control points, for v_0, ..., v_k in a ring."""
    right = given(formula).relation.rhs
    if right.has(pr.v_c):
        found, wanted = coefficient(right, pr.v_c[A]), pr.B(A, pr.k, pr.t) * WITHIN(0, A, pr.k)
        yield Case("every k: what multiplies v_a", bool(found == wanted), residual=sp.factor_terms(found - wanted))
    else:
        yield Case("every k: term i is t B_(i-1)^(k-1), and these sum to t", _sums_to_parameter(right))
    for k in range(1, 6):
        _, function = ring_patch(1, 1, k)
        lookup = indexed("v", {(r,): value for r, value in enumerate(function)})
        t, _ = ring_parameters(1, 1, k)
        functions = {"v": lookup, "B": bernstein, "C": lambda t, f=function: de_casteljau(f, t)}
        yield difference_case(given(formula), f"degree {k}", Meaning({pr.t: t, pr.k: k}, functions))


def _sums_to_parameter(right: Any) -> bool:
    """Tell whether a sum over i = 0 .. k, or 1 .. k, has the terms t B_(i-1)^(k-1)(t)."""
    scale, total = one_sum(right)
    if total is None or len(total.limits) != 1:
        return False
    (index, low, high), term = total.limits[0], scale * total.function
    if index != pr.i or low not in (0, 1) or high != pr.k:
        return False
    i = sp.Symbol("i", integer=True, positive=True)
    term = with_polynomials(term).xreplace({index: i})
    return is_one(term / (X * bernstein_polynomial(i - 1, pr.k - 1, X, X_REST)))


def one_sum(expression: Any) -> tuple[Any, Any]:
    """Split an expression into factors and the one sum among them; no sum where there is not just one."""
    factors = sp.Mul.make_args(expression)
    sums = [factor for factor in factors if isinstance(factor, sp.Sum)]
    others = (factor for factor in factors if not isinstance(factor, sp.Sum))
    return sp.Mul(*others), sums[0] if len(sums) == 1 else None


def with_polynomials(expression: Any) -> Any:
    """Write B(i, n, .) as polynomials: in w if the argument is v, else in x."""

    def written(index: Any, degree: Any, argument: Any) -> Any:
        return bernstein_polynomial(index, degree, *((W, W_REST) if argument == pr.v else (X, X_REST)))

    return expression.replace(pr.B, written)


def blossom_cases(first: bool) -> Any:
    """Return the check of the recursion, its first step or the others, against the polar form by its definition.

    The polar form of a Bernstein sum is the sum of products over all choices: symmetric and affine by construction.
    """

    def cases(formula: Formula | None) -> Iterator[Case]:
        residual = (_first_step if first else _further_step)(given(formula).relation)
        yield Case("every m, n, i, j, s", bool(residual == 0), residual=residual)
        for m, n, k in ((1, 2, 2), (1, 3, 2), (2, 4, 3)):
            net, function = ring_patch(m, n, k)
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
    x, c = pr.x[s], B - j
    left = SAME(i, A) * ((1 - x) * choices(s - 1, c) + x * choices(s - 1, c - 1))
    right = relation.rhs.replace(pr.F, lambda s, i, j: SAME(i, A) * choices(s, B - j))
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
