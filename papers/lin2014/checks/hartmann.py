"""Deciding Hartmann's blend X = f(t) S1(t) + (1 - f(t)) S2(t) of pieces of two bases, [17], for every n and mu.

f = mu (1-t)^(n+1) / (mu (1-t)^(n+1) + (1-mu) t^(n+1)), well known; [17] itself is not here. S1 starts at the first
contact, at t = 0, S2 ends at the second one, at t = 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Counterexample, Formula, given

_T = sp.Symbol("t", nonnegative=True)
_N = sp.Symbol("n", integer=True, positive=True)
_MU, _NU = sp.symbols("mu nu", positive=True)
# (n, t, 1 - t) -> f; of the second and the third argument powers alone are taken.
Weight = Callable[[Any, Any, Any], Any]


def hartmann_weight(n: Any, t: Any, rest: Any) -> Any:
    """Return f, `rest` standing for 1 - t and nu for 1 - mu, both positive."""
    up, down = _MU * rest ** (n + 1), _NU * t ** (n + 1)
    return up / (up + down)


def hull_cases(weight: Weight = hartmann_weight) -> Iterator[Case]:
    """Yield that f(t) and 1 - f(t) are positive inside (0, 1), 1 and 0 at its ends, for every n and mu."""
    x, y = sp.symbols("x y", positive=True)
    f = weight(_N, y, x)
    other = sp.factor(sp.cancel(1 - f))
    yield Case("f and 1 - f are positive inside", bool(f.is_positive and other.is_positive))
    ends = [sp.simplify(weight(_N, sp.Integer(end), sp.Integer(1 - end))) for end in (0, 1)]
    yield Case("1 and 0 at the ends", ends == [1, 0])


def _share_at(weight: Weight, end: int) -> Any:
    """Return the weight of the piece that does not belong to an end, over t^(n+1), t the distance from that end."""
    f = weight(_N, *((_T, 1 - _T) if end == 0 else (1 - _T, _T)))
    other = 1 - f if end == 0 else f
    return sp.cancel(sp.together(other) / _T ** (_N + 1))


def hartmann_contact_cases(weight: Weight = hartmann_weight) -> Iterator[Case]:
    """Yield that X agrees with S1 at t = 0 and with S2 at t = 1 up to the n-th derivatives, for every n and mu.

    X - S1 = (1 - f)(S2 - S1) = t^(n+1) g (S2 - S1), where g has derivatives of every order at 0, being a quotient with
    a denominator that is not 0 there. A derivative of t^r h is t^(r-1) times something again: so n of them leave a
    factor t. At the other end X - S2 = f (S1 - S2), in the same way. Derivatives along the contact do not touch t.
    """
    one, other, f = sp.symbols("S1 S2 f")
    blend = f * one + (1 - f) * other
    for end, piece, rest in ((0, one, (1 - f) * (other - one)), (1, other, f * (one - other))):
        residual = sp.expand(blend - piece - rest)
        yield Case(f"X less its piece at t = {end}", bool(residual == 0), residual=residual)
        denominator = sp.fraction(_share_at(weight, end))[1].subs(_T, 0)
        yield Case(f"weight of the other piece at t = {end}: t^(n+1) g", bool(denominator.is_zero is False))
    yield from _power_cases()


def _power_cases() -> Iterator[Case]:
    h, power = sp.Function("h"), sp.Symbol("r", integer=True, positive=True)
    t = sp.Symbol("t", positive=True)
    residual = sp.expand(sp.powsimp(sp.diff(t**power * h(t), t) / t ** (power - 1)) - power * h(t) - t * h(t).diff(t))
    yield Case("a derivative takes one power of t away", bool(sp.simplify(residual) == 0))


# Derivatives of X and of the pieces at the contact of the first one, and at that of the second.
X_T, S1_T, S2_T = sp.symbols("X_t S1_t S2_t", real=True)
DIRECTION = (
    Formula(sp.Eq(X_T, S1_T), (X_T, S1_T), neighbours=((S1_T, S2_T),)),
    Formula(sp.Eq(X_T, S2_T), (X_T, S2_T), neighbours=((S1_T, S2_T),)),
)


def direction_cases(end: int, weight: Weight = hartmann_weight) -> Callable[[Formula | None], Iterator[Case]]:
    """Return the check of X_t at an end, by the product rule: the other piece has the weight x^(n+1) g, x = 0 there."""

    def cases(formula: Formula | None) -> Iterator[Case]:
        x, g = sp.Symbol("x", nonnegative=True), sp.Function("g")
        other = x ** (_N + 1) * g(x)
        own, far = (S1_T, S2_T) if end == 0 else (S2_T, S1_T)
        distance = sp.Symbol("S2 - S1")
        # x runs against t at t = 1.
        slope = other.diff(x) * (1 if end == 0 else -1)
        total = sp.powsimp(sp.expand((1 - other) * own + other * far + slope * distance))
        at_end = total.subs(x, 0).doit()
        finite = sp.fraction(_share_at(weight, end))[1].subs(_T, 0).is_zero is False
        residual = sp.expand(given(formula).relation.rhs - at_end) if finite else sp.Symbol("undefined: g")
        yield Case(f"every n and mu, t = {end}", bool(residual == 0), residual=residual)

    return cases


# Two bases by the corners of their hull in the plane z = 0; the contact is (0, 0), where the first one goes on along x.
FACING = ((-1, 0), (0, 0), (1, 0), (2, 0))
ROUNDING = ((-1, 0), (0, 0), (1, 1), (1, 2))


def turning_cases(facing: Any = FACING, rounding: Any = ROUNDING) -> Iterator[Case]:
    """Yield whether surfaces in the hull of both bases, whatever their kind, must not go on beyond the contact.

    Where a plane through the contact has both bases on one side and the continued tangent d on the other one, a convex
    combination of points of the bases lies on their side. So (X(t) - X(0)) . N <= 0 for t > 0, hence X_t . N <= 0;
    with X_t = c d and d . N > 0 that is c <= 0. Derivatives along the contact are in the plane and change nothing.
    """
    weights, depths = sp.symbols("a_1:4", nonnegative=True), sp.symbols("g_1:4", nonnegative=True)
    rise = sp.Symbol("d . N", positive=True)
    height = sum(-a * g for a, g in zip(weights, depths, strict=True))
    yield Case("any bases on one side of a plane, the tangent on the other", bool((height / rise).is_nonpositive))
    yield Case("bases around an edge, x <= y", _plane_parts(rounding, (1, -1), (1, 0)))
    # X = t from (0, 0) to (1, 0), G1 with both bases.
    places = [sp.Integer(x) for x, _ in facing]
    inside = not any(y for _, y in facing) and min(places) <= 0 and max(places) >= 1
    forward = sp.diff(_T, _T) > 0
    yield Case("coplanar strips -1 <= x <= 0 and 1 <= x <= 2, X = t", not (inside and forward), own=False, meets=False)


def _plane_parts(corners: Any, normal: tuple[int, int], tangent: tuple[int, int]) -> bool:
    """Return whether corners lie on one side of a plane through the contact, and a tangent leads to the other."""

    def height(point: tuple[int, int]) -> int:
        return sum(x * n for x, n in zip(point, normal, strict=True))

    return all(height(point) <= 0 for point in corners) and height(tangent) > 0


def hartmann_rational_cases(weight: Weight = hartmann_weight) -> Iterator[Case]:
    """Yield, for every n and mu, that the blend of two spline pieces a(t), b(t) has *no* exact rational form.

    f a + (1 - f) b is up a + down b over up + down, with x = 1 - t and y = t: polynomials, the weight positive.
    """
    x, y = sp.symbols("x y", positive=True)
    a, b = sp.symbols("a b", real=True)
    f = weight(_N, y, x)
    up, denominator = sp.fraction(sp.together(f))
    down = sp.expand(denominator - up)
    same = sp.cancel(f * a + (1 - f) * b - (up * a + down * b) / (up + down)) == 0
    # Powers with the exponent n, an integer, are polynomials.
    powers = {x**_N: sp.Symbol("X"), y**_N: sp.Symbol("Y")}
    polynomials = all(sp.expand(part).subs(powers).is_polynomial(x, y) for part in (up, down))
    yield Case("pieces of splines", not (same and polynomials and (up + down).is_positive is True))


def inference_counterexample() -> Counterexample | None:
    """Return the surface inside the hull that does not run back."""
    case = next((case for case in turning_cases() if not case.true), None)
    if case is None:
        return None
    values = (("bases and surface", case.label),)
    return Counterexample(
        values, "X_t runs back, from the hull alone", "X_t = 1, out of the first base into the second"
    )
