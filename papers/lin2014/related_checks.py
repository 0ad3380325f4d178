"""Deciding what the paper says of other methods and of measures: Hartmann, rolling balls, Hermite, curvature."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from derivations.splines import end_derivatives, span_symbols
from papers.ledger import Case, Formula
from papers.lin2014 import printed as pr
from papers.lin2014.blending_checks import PRINTED_PAIRS, printed_pair
from papers.lin2014.property_checks import contained, union

# A ball of radius r on a base of curvature c across the contact, and the jump of the curvature there.
BALL_RADIUS = sp.Symbol("r", positive=True)
BASE_CURVATURE, _JUMP = sp.symbols("c j", real=True)
JUMP = Formula(sp.Eq(_JUMP, 1 / BALL_RADIUS - BASE_CURVATURE), (_JUMP, BALL_RADIUS, BASE_CURVATURE))
# A ball of radius r(t) on a spine with speed s: r' is its rate of change, rho the radius of the section.
RADIUS, SPEED, SECTION = sp.symbols("r s rho", positive=True)
RADIUS_SLOPE = sp.Symbol("r'", real=True)
SECTION_SQUARED = Formula(
    sp.Eq(SECTION**2, RADIUS**2 * (1 - RADIUS_SLOPE**2 / SPEED**2)),
    (SECTION, RADIUS, RADIUS_SLOPE, SPEED),
    (sp.Abs(RADIUS_SLOPE) < SPEED,),
)


def hull_cases() -> Iterator[Case]:
    """Yield that f(t) of Hartmann's blend and 1 - f(t) are not negative on [0, 1] and sum to 1, for every n and mu.

    With x = 1 - t and y = t, both positive inside (0, 1), and mu, nu = 1 - mu positive.
    """
    x, y, mu, nu = sp.symbols("x y mu nu", positive=True)
    n = sp.Symbol("n", integer=True, positive=True)
    up, down = mu * x ** (n + 1), nu * y ** (n + 1)
    shares = (up / (up + down), down / (up + down))
    yield Case("f and 1 - f are positive inside", all(bool(share.is_positive) for share in shares))
    residual = sp.cancel(sum(shares) - 1)
    yield Case("they sum to 1", residual == 0, residual=residual)
    t = sp.Symbol("t")
    f = _hartmann(n, sp.Rational(1, 3), t)
    yield Case("1 and 0 at the ends", [sp.simplify(f.subs(t, end)) for end in (0, 1)] == [1, 0])


def reverse_cases() -> Iterator[Case]:
    """Yield degrees n: at t = 0 the blend X = f S1 + (1 - f) S2 leaves along S1 itself, X_t = S1_t."""
    t = sp.Symbol("t")
    for n in (1, 2, 3):
        f = _hartmann(n, sp.Rational(1, 2), t)
        slope = sp.diff(f, t).subs(t, 0)
        yield Case(f"n = {n}", f.subs(t, 0) == 1 and slope == 0)


def hartmann_contact_cases() -> Iterator[Case]:
    """Yield degrees n: f is 1 at 0 and 0 at 1, and its derivatives up to order n vanish at both."""
    t = sp.Symbol("t")
    for n in (1, 2, 3):
        f = _hartmann(n, sp.Rational(1, 3), t)
        flat = all(sp.diff(f, t, d).subs(t, end) == 0 for d in range(1, n + 1) for end in (0, 1))
        yield Case(f"n = {n}", flat and f.subs(t, 0) == 1 and f.subs(t, 1) == 0)


def hartmann_rational_cases() -> Iterator[Case]:
    """Yield, for every n and mu, that the blend of two spline pieces a(t), b(t) has *no* exact rational form.

    f a + (1 - f) b is up a + down b over up + down, with x = 1 - t and y = t: polynomials, the weight positive.
    """
    x, y, mu, nu = sp.symbols("x y mu nu", positive=True)
    n = sp.Symbol("n", integer=True, positive=True)
    a, b = sp.symbols("a b", real=True)
    up, down = mu * x ** (n + 1), nu * y ** (n + 1)
    blend = up / (up + down) * a + down / (up + down) * b
    same = sp.cancel(blend - (up * a + down * b) / (up + down)) == 0
    polynomial = bool((n + 1).is_integer and (n + 1).is_positive)
    yield Case("pieces of splines", not (same and polynomial and (up + down).is_positive is True))


def sine_base_cases() -> Iterator[Case]:
    """Yield that a blend X = f sin t + (1 - f) b, b polynomial, is not rational: else sin t would be a quotient."""
    X, b, f, wave = sp.symbols("X b f S", positive=True)
    (solved,) = sp.solve(f * wave + (1 - f) * b - X, wave)
    yield Case("sin t is a quotient of polynomials if X is", solved.is_rational_function(X, b, f))
    yield from c_curve_cases()


def _hartmann(n: int, mu: Any, t: Any) -> Any:
    up, down = mu * (1 - t) ** (n + 1), (1 - mu) * t ** (n + 1)
    return up / (up + down)


def mean_curvature_cases() -> Iterator[Case]:
    """Yield that for a tangent-continuous join equal mean curvature along the contact means equal curvatures.

    L = N . P_uu is the only second-order quantity that can differ, and H depends on it with the factor G / 2(EG - F^2).
    """
    E, F, G, L, M, N = sp.symbols("E F G L M N", real=True)
    mean = (E * N - 2 * F * M + G * L) / (2 * (E * G - F**2))
    factor = sp.diff(mean, L)
    yield Case("H is linear in L", sp.diff(factor, L) == 0)
    yield Case("with a factor that is not zero", sp.simplify(factor - G / (2 * (E * G - F**2))) == 0)


def invisible_cases() -> Iterator[Case]:
    """Yield joins of one plane that are not C2: true where a normal or the mean curvature shows it."""
    u, v = sp.symbols("u v", real=True)
    for label, surface in (
        ("(-u - u^2, v, 0) after (w, v, 0)", sp.Matrix([-u - u**2, v, 0])),
        ("(-u, v + u^2 v, 0) after (w, v, 0)", sp.Matrix([-u, v + u**2 * v, 0])),
    ):
        # The other side, (w, v, 0), has second derivatives zero, normal (0, 0, 1) and no curvature.
        parametric = surface.diff(u, 2).subs(u, 0).is_zero_matrix
        normal = surface.diff(u).cross(surface.diff(v))
        bends = any(x.diff(y) != 0 for x in normal[:2] for y in (u, v))
        yield Case(label, bool(parametric or bends))


def bending_cases(*, saddle: bool) -> Any:
    """Return the check that kappa_1^2 + kappa_2^2 is 4 H^2: for kappa_2 = 0, or for any principal curvatures."""

    def cases() -> Iterator[Case]:
        first, second = sp.symbols("kappa_1 kappa_2", real=True)
        other = second if saddle else sp.Integer(0)
        residual = sp.expand(first**2 + other**2 - (first + other) ** 2)
        yield Case("any kappa_2" if saddle else "kappa_2 = 0", bool(residual == 0), residual=residual)

    return cases


def hermite_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield degrees d of a Bezier curve across: six conditions (value, two derivatives at both ends) can be met.

    From degree 5 on the conditions of the two ends concern different control points, three each, by triangles with the
    diagonal 1, d, d (d - 1): for every such degree. A lower one has fewer than six control points.
    """
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    ones = (sp.Integer(1), sp.Integer(1))
    d = sp.Symbol("d", integer=True, positive=True)
    end = end_derivatives(2, d + 5, ones)
    diagonal = sp.prod(end[i, i] for i in range(3))
    lower = all(end[i, j] == 0 for i in range(3) for j in range(i + 1, 3))
    yield Case("every degree from 6 on", bool(lower and diagonal.expand().is_positive and _asks(formula, d + 5)))
    for degree in range(2, 6):
        rows = sp.zeros(6, degree + 1)
        for k in range(3):
            for i in range(min(3, degree + 1)):
                entry = end_derivatives(2, degree, ones)[k, i]
                rows[k, i] += entry
                rows[3 + k, degree - i] += (-1) ** k * entry
        yield Case(f"degree {degree}", bool(rows.rank() == 6) == _asks(formula, degree))


def _asks(formula: Formula, degree: Any) -> bool:
    """Tell whether the relation admits a degree, which may be a symbol."""
    return formula.relation.subs(pr.degree, degree) == True  # noqa: E712  # a relation may stay undecided


def quartic_cases() -> Iterator[Case]:
    """Yield a Bezier curve of degree four: true where it misses points, tangents or curvatures that are prescribed.

    Prescribed: from (0, 0) along (1, 0) to (2, 1) along (0, 1), of curvature 1 at both ends.
    """
    points = [sp.Matrix(p) for p in ((0, 0), (sp.Rational(1, 2), 0), (sp.Rational(5, 3), sp.Rational(1, 3)),
                                     (2, sp.Rational(1, 2)), (2, 1))]  # fmt: skip
    t = sp.Symbol("t")
    curve = sum((sp.binomial(4, i) * t**i * (1 - t) ** (4 - i) * p for i, p in enumerate(points)), sp.zeros(2, 1))
    misses = []
    for end, place, tangent in ((0, (0, 0), (1, 0)), (1, (2, 1), (0, 1))):
        at, first, second = (curve.diff(t, d).subs(t, end) if d else curve.subs(t, end) for d in range(3))
        speed = sp.sqrt(first.dot(first))
        curvature = first.row_join(second).det() / speed**3
        misses += [*(at - sp.Matrix(place)), *(first / speed - sp.Matrix(tangent)), curvature - 1]
    label = "the quartic with points (0, 0), (1/2, 0), (5/3, 1/3), (2, 1/2), (2, 1) has all that G2 asks for"
    yield Case(label, any(sp.simplify(x) != 0 for x in misses))


def cubic_cases() -> Iterator[Case]:
    """Yield a cubic with two inner knots or more, anywhere: six conditions at its ends are independent.

    Those of the two ends concern different rows where there are six rows or more.
    """
    h = span_symbols(2)
    determinant = sp.factor(end_derivatives(2, 3, h).det())
    yield Case("any knots", bool(determinant.is_positive))
    for m in (5, 6, 7):
        yield Case(f"{m + 1} rows: two ends with three rows each", not {0, 1, 2} & {m - 2, m - 1, m})


def jump_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the curvature jump across the contact for every radius and every curvature of the base, from a circle."""
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    t = sp.Symbol("t", real=True)
    circle = sp.Matrix([BALL_RADIUS * sp.cos(t), BALL_RADIUS * sp.sin(t)])
    first, second = circle.diff(t), circle.diff(t, 2)
    curvature = sp.simplify(first.row_join(second).det() / sp.sqrt(first.dot(first)) ** 3)
    residual = sp.factor(formula.relation.rhs - (curvature - BASE_CURVATURE))
    yield Case("any ball, any base", residual == 0, residual=residual)


def g2_cases() -> Iterator[Case]:
    """Yield rolling balls of radius r on bases of curvature c: G1 at the most unless the jump is zero, c = 1/r."""
    jump = JUMP.relation.rhs
    zeros = sp.solve(jump, BASE_CURVATURE)
    yield Case("c other than 1/r", zeros == [1 / BALL_RADIUS])
    yield Case("c = 1/r", bool(jump.subs(BASE_CURVATURE, 1 / BALL_RADIUS) != 0), own=False, meets=False)


def canal_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the section of the envelope of balls of radius r(t) around C(t): a circle, and its radius.

    In the frame of the spine X - C = a T + rho (cos N + sin B). On the envelope |X - C|^2 = r^2, and the derivative
    of this by t: (X - C) . C' = -r r'. Both fix a and rho, not the angle, so that it runs through a whole circle.
    """
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    axial, angle = sp.symbols("a theta", real=True)
    point = sp.Matrix([axial, SECTION * sp.cos(angle), SECTION * sp.sin(angle)])
    velocity = sp.Matrix([SPEED, 0, 0])
    (on_envelope,) = sp.solve(point.dot(velocity) + RADIUS * RADIUS_SLOPE, axial)
    squared = sp.Symbol("q", positive=True)
    distance = sp.trigsimp(sp.expand(point.dot(point))).subs(SECTION, sp.sqrt(squared)).subs(axial, on_envelope)
    (true,) = sp.solve(distance - RADIUS**2, squared)
    left, right = (side.subs(SECTION, sp.sqrt(true)) for side in formula.relation.args)
    residual = sp.factor(right - left)
    yield Case("any spine, any radius", residual == 0, residual=residual)
    yield Case("no dependence on the angle", angle not in distance.free_symbols)


def bezier_conversion_cases() -> Iterator[Case]:
    """Yield printed pairs, true where a Hermite blend with a quintic Bezier curve across has *no* exact B-spline form.

    It has one if its six rows are determined by the contact data, as fixed combinations of splines over V^r and of
    splines over V^s, and both spaces are part of the splines over the union of the knots.
    """
    ones = (sp.Integer(1), sp.Integer(1))
    end = end_derivatives(2, 5, ones)
    rows_exist = end.det() != 0
    for name in PRINTED_PAIRS:
        vectors = printed_pair(name)
        common = union(4, *vectors)
        fits = rows_exist and all(contained(4, vector, common) for vector in vectors)
        yield Case(f"{name}: a form of degrees 5, 3 over {len(common) - 8} inner knots exists", not fits)


def c_curve_cases() -> Iterator[Case]:
    """Yield degrees of a polynomial piece: none but 0 solves y'' = -y, as sine and cosine of a C-curve do.

    On polynomials of any degree 1 + D^2 is triangular with ones on the diagonal. Nor does a quotient: its degree, that
    of the numerator less that of the denominator, falls by two or more when it is differentiated twice.
    """
    for degree in range(1, 9):
        size = degree + 1
        twice = sp.Matrix(size, size, lambda i, j: j * (j - 1) if j == i + 2 else 0)
        yield Case(f"degree {degree}", (sp.eye(size) + twice).det() == 1)
    t, d = sp.symbols("t d", positive=True)
    leading = sp.powsimp(sp.diff(t**d, t, 2) / t ** (d - 2))
    yield Case("a quotient of degree d", sp.expand(leading - d * (d - 1)) == 0)
