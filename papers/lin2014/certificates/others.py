"""Other methods: rolling balls, Hermite and Hartmann blends, cylinders and cones, curvature."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import sympy as sp

from semispline.derivations.splines import end_derivatives, span_symbols
from semispline.papers.checks import bernstein, union
from semispline.papers.ledger import Claim, given
from semispline.papers.lin2014.certificates.contact import INDUCTION, induction
from semispline.papers.lin2014.certificates.spline_steps import SPACES, spaces
from semispline.papers.lin2014.checks.hartmann import ROUNDING
from semispline.papers.lin2014.checks.other_methods import JUMP
from semispline.papers.lin2014.checks.printed_pairs import PRINTED_PAIRS, printed_pair
from semispline.papers.recheck import Draft, Statement, Text, different, identity, not_zero, positive, rank, text, total

# A point of the unit circle, t the tangent of half the angle.
_CIRCLE = (("C", "(1 - t^2)/(1 + t^2)"), ("S", "2*t/(1 + t^2)"))
# Hartmann's weight: A and B stand for (1-t)^(n+1) and t^(n+1).
_F = Text("mu*A/(mu*A + nu*B)", 2)
POWERS = "a derivative takes one power of t away from t^(n+1) g, g with derivatives of every order at 0"
LIMIT = "a limit of slopes that are not positive is not"
CIRCLE = "the leading coefficient of x^2 + y^2 is a^2 + b^2, positive for real a, b that are not both zero"
NO_SINE = "no quotient of polynomials solves y'' = -y, as its degree falls by two"


def rolling_ball(claim: Claim) -> Draft:
    """Return the jump of the curvature at a ball's contact, and where it is zero."""
    printed = claim.formulas[0].relation.rhs
    first, second = (Text("-r*S", 1), Text("r*C", 2)), (Text("-r*C", 1), Text("-r*S", 1))
    turn = first[0] * second[1] - first[1] * second[0]
    jump = JUMP.relation.rhs
    return Draft(
        [
            [
                identity("the circle has speed r", first[0] ** 2 + first[1] ** 2, Text("r^2", 3), where=_CIRCLE),
                identity(
                    "any ball, any base: curvature of the circle less that of the base",
                    printed,
                    turn / Text("r^3", 3) - Text("c"),
                    where=_CIRCLE,
                ),
                different("c other than 1/r", jump, 0, wanted=False),
                identity("c = 1/r", jump, 0, where=(("c", "1/r"),), wanted=False, own=False, meets=False),
            ]
        ]
    )


def quintic(_: Claim) -> Draft:
    """Return that six end conditions need degree 5, and a quartic that has points, tangents and curvatures."""
    ones = (sp.Integer(1), sp.Integer(1))
    cases: list[Statement] = [*induction()]
    for degree in range(2, 6):
        rows = sp.zeros(6, degree + 1)
        for k in range(3):
            for i in range(min(3, degree + 1)):
                entry = end_derivatives(2, degree, ones)[k, i]
                rows[k, i] += entry
                rows[3 + k, degree - i] += (-1) ** k * entry
        cases.append(
            rank(f"degree {degree}: {'six' if degree == 5 else 'fewer than six'} independent conditions", rows)
        )
    end = end_derivatives(2, sp.Symbol("d") + 6, ones)
    cases += [
        positive(f"every degree from 6 on: entry {i} of the diagonal", end[i, i], nonnegative=("d",)) for i in range(3)
    ]
    x, y = (
        [Text(number, 2) for number in line] for line in (("0", "1/2", "5/3", "2", "2"), ("0", "0", "1/3", "1/2", "1"))
    )
    quartic: list[Statement] = []
    for end_, place, tangent in ((0, (0, 0), (1, 0)), (1, (2, 1), (0, 1))):
        order = (0, 1, 2) if end_ == 0 else (4, 3, 2)
        for name, c, line in (("x", 0, x), ("y", 1, y)):
            quartic.append(identity(f"end {end_}: {name}", line[order[0]], place[c], wanted=False))
        sign = 1 if end_ == 0 else -1
        slope = [sign * 4 * (line[order[1]] - line[order[0]]) for line in (x, y)]
        bend = [12 * (line[order[2]] - 2 * line[order[1]] + line[order[0]]) for line in (x, y)]
        across = 0 if tangent[0] else 1
        quartic.append(identity(f"end {end_}: tangent", slope[1 - across], 0, wanted=False))
        quartic.append(
            identity(
                f"end {end_}: curvature 1", slope[0] * bend[1] - slope[1] * bend[0], slope[across] ** 3, wanted=False
            )
        )
    return Draft([cases, quartic], believed=(INDUCTION,))


def cubic(_: Claim) -> Draft:
    """Return that the six end conditions of a cubic with two inner knots are independent."""
    ends = end_derivatives(2, 3, span_symbols(2))
    cases: list[Statement] = [*induction()]
    cases += [identity(f"entry {d}, {i} above the diagonal", ends[d, i], 0) for d in range(3) for i in range(d + 1, 3)]
    cases += [positive(f"entry {d} of the diagonal", ends[d, d], positive=span_symbols(2)) for d in range(3)]
    cases.append(
        positive(
            "two inner knots or more: different rows at both ends",
            "m - 2 - 2",
            where=(("m", "3 + 2 + r"),),
            nonnegative=("r",),
        )
    )
    return Draft([cases], believed=(INDUCTION,))


def hartmann_contact(_: Claim) -> Draft:
    """Return that X less its piece has the factor t^(n+1)."""
    f = _F
    blend = f * Text("S1") + (1 - f) * Text("S2")
    return Draft(
        [
            [
                identity("X less its piece at t = 0", blend - "S1", (1 - f) * Text("S2 - S1", 1)),
                identity("which has the factor t^(n+1)", 1 - f, Text("B*(nu/(mu*A + nu*B))", 2)),
                positive(
                    "whose other factor has a denominator that is not 0 at t = 0",
                    "mu*A + nu*B",
                    where=(("A", "1"), ("B", "0*b")),
                    positive=("mu",),
                ),
                identity("X less its piece at t = 1", blend - "S2", f * Text("S1 - S2", 1)),
                identity("which has the factor (1-t)^(n+1)", f, Text("A*(mu/(mu*A + nu*B))", 2)),
                positive(
                    "whose other factor has a denominator that is not 0 at t = 1",
                    "mu*A + nu*B",
                    where=(("A", "0*b"), ("B", "1")),
                    positive=("nu",),
                ),
            ]
        ],
        believed=(POWERS,),
    )


def c_curves() -> Iterator[Statement]:
    """Yield that y'' = -y has no polynomial solution of a degree from 1 to 8: 1 + D^2 is regular."""
    for degree in range(1, 9):
        size = degree + 1
        matrix = sp.eye(size) + sp.Matrix(size, size, lambda i, j: j * (j - 1) if j == i + 2 else 0)
        yield rank(f"degree {degree}: 1 + D^2 is regular", matrix)


def hartmann_nurbs(_: Claim) -> Draft:
    """Return that a sine in a base is no quotient of polynomials, and that between splines the blend is one."""
    sine = identity(
        "sin t is a quotient of polynomials if X is",
        Text("(X - (1 - f)*b)/f", 2),
        Text("S"),
        where=(("X", "f*S + (1 - f)*b"),),
    )
    quotient = identity(
        "pieces of splines: an exact rational form",
        _F * Text("a") + (1 - _F) * Text("b"),
        Text("(mu*A*a + nu*B*b)/(mu*A + nu*B)", 2),
        wanted=False,
    )
    weight = positive("whose weight is positive", "mu*A + nu*B", positive=("mu", "nu", "A", "B"))
    return Draft([[sine, *c_curves()], [quotient, weight]], believed=(NO_SINE,))


def ref_11(_: Claim) -> Draft:
    """Return that a quintic Hermite blend between splines is a spline, and that a C-curve is not."""
    ones = (sp.Integer(1), sp.Integer(1))
    exact: list[Statement] = [rank("the six rows are determined", end_derivatives(2, 5, ones), affirmed=False)]
    for name in PRINTED_PAIRS:
        vectors = printed_pair(name)
        for n, vector in enumerate(vectors, start=1):
            exact.append(spaces(f"{name}, vector {n}: on the union", 4, vector, union(4, *vectors), wanted=False))
    return Draft([exact, c_curves()], believed=(INDUCTION, SPACES, NO_SINE))


def canal(claim: Claim) -> Draft:
    """Return the section of the envelope of balls around a spine."""
    squared = claim.formulas[0].relation.rhs
    a = (("a", "-r*r_prime/s"), ("q", text(squared)), *_CIRCLE)
    return Draft(
        [
            [
                identity(
                    "on the envelope, any spine and radius: the derivative of |X - C|^2 = r^2",
                    Text("a*s", 2),
                    Text("-r*r_prime", 1),
                    where=a,
                ),
                identity("|X - C|^2 = r^2 at every angle", Text("a^2 + q*C^2 + q*S^2", 1), Text("r^2", 3), where=a),
            ]
        ]
    )


def cylinders(_: Claim) -> Draft:
    """Return that no polynomial runs along a circle, and that a line with four rows is one."""
    circle: list[Statement] = [
        positive("leading coefficients a and b", "a^2 + b^2", positive=("a", "b"), affirmed=False),
        positive("a alone", "a^2", positive=("a",), affirmed=False),
        positive("b alone", "b^2", positive=("b",), affirmed=False),
    ]
    line = total(bernstein(r, 3, Text("t")) * Text(f"{r}/3", 2) for r in range(4))
    return Draft([circle, [identity("a line with four rows", line, Text("t"))]], believed=(CIRCLE,))


def cone(_: Claim) -> Draft:
    """Return a patch on the circular cone."""
    x, y, z = Text("w*(1 - v^2)", 2), Text("2*w*v", 2), Text("w*(1 + v^2)", 2)
    # The normal at w = 1, v = 0, from the derivatives (1 - v^2, 2 v, 1 + v^2) and w (-2 v, 2, 2 v).
    across, along = (
        [Text("1 - v^2", 1), Text("2*v", 2), Text("1 + v^2", 1)],
        [Text("-2*v*w", 1), Text("2*w", 2), Text("2*v*w", 2)],
    )
    return Draft(
        [
            [
                identity("on the circular cone", x**2 + y**2, z**2),
                not_zero(
                    "regular away from its tip",
                    across[0] * along[1] - across[1] * along[0],
                    where=(("w", "1"), ("v", "0")),
                ),
            ]
        ]
    )


def mean_curvature(_: Claim) -> Draft:
    """Return kappa_1^2 + kappa_2^2 against 4 H^2."""
    energy, mean = Text("k_1^2 + k_2^2", 1), Text("4*((k_1 + k_2)/2)^2", 2)
    return Draft(
        [[identity("kappa_2 = 0", energy, mean, where=(("k_2", "0"),))], [different("any kappa_2", energy, mean)]]
    )


def hull() -> Iterator[Statement]:
    """Yield that f and 1 - f are positive inside, 1 and 0 at the ends."""
    letters: Any = {"positive": ("mu", "nu", "A", "B")}
    yield positive("f is positive inside", _F, **letters)
    yield positive("so is 1 - f", 1 - _F, **letters)
    yield identity("f = 1 at t = 0", _F, 1, where=(("A", "1"), ("B", "0")))
    yield identity("f = 0 at t = 1", _F, 0, where=(("A", "0"), ("B", "1")))


def directions(formulas: Any) -> Iterator[Statement]:
    """Yield X_t at both contacts: the other piece has the weight o = x^(n+1) g, which vanishes there with its slope."""
    for end, formula in enumerate(formulas):
        own, far = ("S1_t", "S2_t") if end == 0 else ("S2_t", "S1_t")
        slope = Text(f"(1 - o)*{own} + o*{far} + o_t*(S2 - S1)", 1)
        # n = 1 + e, x = 0: o = x x^n g and o_t = x^n ((n+1) g + x g').
        where = (("x", "0"), ("o", "x*x_n*g"), ("x_n", "x*h"), ("o_t", "x_n*((n + 1)*g + x*g_prime)"))
        where = (where[0], where[2], where[1], where[3])
        yield identity(f"every n and mu, t = {end}", formula.relation.rhs, slope, where=where)


def reverse(claim: Claim) -> Draft:
    """Return X_t at both contacts."""
    return Draft([directions(claim.formulas)], believed=(POWERS,))


def inference(claim: Claim) -> Draft:
    """Return both readings of what the hull implies."""
    formulas = [given(part.formula) for part in claim.readings[0].parts[1:]]
    convex: list[Statement] = [
        positive(
            "any bases on one side of a plane: minus the slope across",
            Text("(a1*g1 + a2*g2 + a3*g3)/rise", 2),
            strict=False,
            positive=("rise",),
            nonnegative=("a1", "a2", "a3", "g1", "g2", "g3"),
        ),
    ]
    convex += [
        positive(f"bases around an edge, x <= y at {corner}", Text(f"1 - ({corner[0]} - {corner[1]})", 1))
        for corner in ROUNDING
    ]
    convex.append(positive("the tangent (1, 0) leads to the other side", Text("1 - 0", 1)))
    convex.append(
        positive(
            "coplanar strips, X = t: it runs forward",
            Text("(t + e - t)/e", 2),
            positive=("e",),
            affirmed=False,
            own=False,
            meets=False,
        )
    )
    return Draft([[*hull(), *directions(formulas)], convex], believed=(POWERS, LIMIT))


DRAFTS: dict[str, Callable[[Claim], Draft]] = {
    "sec-1.rolling-ball": rolling_ball,
    "sec-1.quintic": quintic,
    "sec-1.cubic": cubic,
    "sec-1.hartmann-contact": hartmann_contact,
    "sec-1.hartmann-nurbs": hartmann_nurbs,
    "sec-1.ref-11": ref_11,
    "sec-1.ball-circular": canal,
    "sec-5.cylinders": cylinders,
    "sec-5.cone": cone,
    "sec-5.mean-curvature": mean_curvature,
    "fig-7.hull": lambda _: Draft([hull()]),
    "fig-7.reverse": reverse,
    "fig-7.inference": inference,
}
NOT_EXPRESSIBLE = {
    "sec-4.cvv-indices": "an index read off the sum (1): nothing is computed",
    "sec-5.validation": "unit normals and mean curvature: square roots",
}
