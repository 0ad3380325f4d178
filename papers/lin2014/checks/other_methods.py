"""Deciding what the paper says of other methods: rolling balls, Hermite blends with Bezier and C-curves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.checks import contained, union
from semispline.papers.ledger import Case, Formula, given
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, printed_pair

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


def sine_base_cases(blend: Any = lambda f, one, other: f * one + (1 - f) * other) -> Iterator[Case]:
    """Yield that a blend X = f sin t + (1 - f) b, b polynomial, is not rational: else sin t would be a quotient."""
    X, b, f, wave = sp.symbols("X b f S", positive=True)
    (solved,) = sp.solve(blend(f, wave, b) - X, wave)
    yield Case("sin t is a quotient of polynomials if X is", bool(solved.is_rational_function(X, b, f)))
    yield from c_curve_cases()


def hermite_cases(formula: Formula | None) -> Iterator[Case]:
    """Yield degrees d of a Bezier curve across: six conditions (value, two derivatives at both ends) can be met.

    From degree 5 on the conditions of the two ends concern different control points, three each, by triangles with the
    diagonal 1, d, d (d - 1): for every such degree. A lower one has fewer than six control points.
    """
    ones = (sp.Integer(1), sp.Integer(1))
    d = sp.Symbol("d", integer=True, positive=True)
    end = end_derivatives(2, d + 5, ones)
    diagonal = sp.prod(end[i, i] for i in range(3))
    lower = all(end[i, j] == 0 for i in range(3) for j in range(i + 1, 3))
    yield Case("every degree from 6 on", bool(lower and diagonal.expand().is_positive and _asks(given(formula), d + 5)))
    for degree in range(2, 6):
        rows = sp.zeros(6, degree + 1)
        for k in range(3):
            for i in range(min(3, degree + 1)):
                entry = end_derivatives(2, degree, ones)[k, i]
                rows[k, i] += entry
                rows[3 + k, degree - i] += (-1) ** k * entry
        yield Case(f"degree {degree}", bool(rows.rank() == 6) == _asks(given(formula), degree))


def _asks(formula: Formula, degree: Any) -> bool:
    """Tell whether the relation admits a degree, which may be a symbol."""
    return formula.relation.subs(pr.degree, degree) == True  # noqa: E712  # a relation may stay undecided


_QUARTIC = ((0, 0), (sp.Rational(1, 2), 0), (sp.Rational(5, 3), sp.Rational(1, 3)), (2, sp.Rational(1, 2)), (2, 1))


def quartic_cases(given_points: Any = _QUARTIC) -> Iterator[Case]:
    """Yield a Bezier curve of degree four: true where it misses points, tangents or curvatures that are prescribed.

    Prescribed: from (0, 0) along (1, 0) to (2, 1) along (0, 1), of curvature 1 at both ends.
    """
    points = [sp.Matrix(p) for p in given_points]
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


def cubic_cases(degree: int = 3, inner: int = 2) -> Iterator[Case]:
    """Yield a cubic with two inner knots or more, anywhere: six conditions at its ends are independent.

    Those of each end concern three rows, and the two ends different ones where there are six rows or more.
    """
    ends = end_derivatives(2, degree, span_symbols(2))
    determinant = sp.factor(ends.det())
    yield Case("any knots: those of one end", bool(ends.is_lower and determinant.is_positive))
    more = sp.Symbol("r", integer=True, nonnegative=True)
    # Rows 0 .. 2, and m-2 .. m, with m + 1 rows in all.
    m = degree + inner + more
    yield Case("two inner knots or more: different rows at both ends", bool((m - 2 - 2).is_positive))


def jump_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the curvature jump across the contact for every radius and every curvature of the base, from a circle."""
    t = sp.Symbol("t", real=True)
    circle = sp.Matrix([BALL_RADIUS * sp.cos(t), BALL_RADIUS * sp.sin(t)])
    first, second = circle.diff(t), circle.diff(t, 2)
    curvature = sp.simplify(first.row_join(second).det() / sp.sqrt(first.dot(first)) ** 3)
    residual = sp.factor(given(formula).relation.rhs - (curvature - BASE_CURVATURE))
    yield Case("any ball, any base", residual == 0, residual=residual)


def g2_cases(jump: Any = JUMP.relation.rhs) -> Iterator[Case]:
    """Yield rolling balls of radius r on bases of curvature c: G1 at the most unless the jump is zero, c = 1/r."""
    zeros = sp.solve(jump, BASE_CURVATURE)
    yield Case("c other than 1/r", zeros == [1 / BALL_RADIUS])
    yield Case("c = 1/r", bool(jump.subs(BASE_CURVATURE, 1 / BALL_RADIUS) != 0), own=False, meets=False)


def canal_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the section of the envelope of balls of radius r(t) around C(t): a circle, and its radius.

    In the frame of the spine X - C = a T + rho (cos N + sin B). On the envelope |X - C|^2 = r^2, and the derivative
    of this by t: (X - C) . C' = -r r'. Both fix a and rho, not the angle, so that it runs through a whole circle.
    """
    axial, angle = sp.symbols("a theta", real=True)
    point = sp.Matrix([axial, SECTION * sp.cos(angle), SECTION * sp.sin(angle)])
    velocity = sp.Matrix([SPEED, 0, 0])
    (on_envelope,) = sp.solve(point.dot(velocity) + RADIUS * RADIUS_SLOPE, axial)
    squared = sp.Symbol("q", positive=True)
    distance = sp.trigsimp(sp.expand(point.dot(point))).subs(SECTION, sp.sqrt(squared)).subs(axial, on_envelope)
    (true,) = sp.solve(distance - RADIUS**2, squared)
    left, right = (side.subs(SECTION, sp.sqrt(true)) for side in given(formula).relation.args)
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
