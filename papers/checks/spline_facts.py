"""What is true of B-splines of every order over any knots, as cases on which a check of any paper can stand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.properties import proofs
from semispline.papers.ledger import Case, Check, Formula, Strength


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
    return Check(cases, Strength.GENERAL, method, proof=True)


_proofs = cache(proofs)


def identity_cases(*names: str) -> Iterator[Case]:
    """Yield the identities behind some properties, which are to be zero."""
    for proof in _proofs():
        if proof.name in names:
            for name, residual in proof.identities.items():
                yield Case(f"{proof.name}: {name}", residual == 0, residual=residual)


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


def locality_induction_cases() -> Iterator[Case]:
    """Yield that N_i,k vanishes on span c, [t_c, t_(c+1)), unless i <= c < i + k, for every order and knots.

    By induction on the order: on a span outside of that both functions of order k - 1 in the recurrence vanish by
    the claim for k - 1. N_i,1 is 1 on span i alone.
    """
    i = sp.Symbol("i", integer=True)
    k = 2 + sp.Symbol("r", integer=True, nonnegative=True)
    away = sp.Symbol("d", integer=True, nonnegative=True)
    rising, falling = sp.symbols("omega psi")
    functions = rising * sp.Function("N")(i) + falling * sp.Function("N")(i + 1)
    for label, span in (("before its first knot", i - 1 - away), ("after its last knot", i + k + away)):
        residual = functions.replace(sp.Function("N"), lambda j, c=span: _lower_function(j, k - 1, c))
        yield Case(f"every order and knots, {label}", bool(residual == 0), residual=residual)


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
