"""Statements of each form: right ones, and wrong ones, each with one thing changed."""

from dataclasses import replace
from fractions import Fraction

import sympy as sp

from semispline.papers.recheck import (
    contained,
    different,
    identity,
    knots,
    matrices,
    minimum,
    not_zero,
    number,
    positive,
    rank,
    series,
)
from semispline.papers.recheck.statements import Term

X, R, S, C = sp.symbols("x r s c")
TURN, SHEAR = sp.Matrix([[X, 1], [1, 0]]), sp.Matrix([[1, X], [0, 1]])
MATRIX = [[2, 1, 0], [1, 2, 1], [0, 1, 2]]
COS, SIN = sp.symbols("co si")
RIGHT = {
    # Divided by a letter that PARI takes for a lesser one than the other, since it meets it later.
    "roots": identity("a", "(1 - co_)/si_", "(co_ - 1)/si_*co_ + si_", roots=[(SIN, 1 - COS**2, 2)]),
    "identity": identity("a", (X**2 - 1) / (X - 1), X + 1),
    "where": identity("a", "y^2", "x^2 + 2*x + 1", where=(("y", "x + 1"),)),
    "different": different("a", X**2, X, conditions=("x > 1",)),
    "not zero": not_zero("a", X - 1),
    "positive": positive("a", (X + 2) / (X + 1) ** 2, nonnegative=("x",)),
    "squares": positive("a", "x^2 - 2*x*y + y^2", over=[Term(coefficient="1", squares=("x - y",))], strict=False),
    "number": positive("a", "1/2 - 1/3"),
    "rank": rank("a", [[1, 2, 3], [2, 4, 6], [1, 0, 1]]),
    "rank of functions": rank("a", [[X, 1], [X**2, X]]),
    "contained": contained("a", [[1, 0], [0, 1], [1, 1]], [[2], [3], [5]]),
    "not contained": contained("a", [[1, 0], [0, 1], [1, 1]], [[2], [3], [6]]),
    "minimum": minimum("a", MATRIX),
    "knots": knots("a", [0, 0, Fraction(1, 2), 1, 1], "single", order=2),
    "a root": identity("a", (R + 1) * (R - 1), X - 1, roots=[(R, X, 2)]),
    "a root of a root": identity("a", S**4, X, roots=[(R, X, 2), (S, R, 2)]),
    "a circle": identity("a", C**2 / (1 - R) - 1, R, roots=[(C, 1 - R**2, 2)]),
    "matrices": matrices("a", "m1^-1*m2*m1", "m3", {"m1": TURN, "m2": SHEAR, "m3": TURN.inv() * SHEAR * TURN}),
    "matrices that differ": matrices("a", "m1*m2", "m2*m1", {"m1": TURN, "m2": SHEAR}, equal=False),
    "a number": number("a", sp.sqrt(2) * sp.cos(sp.pi / 8) - sp.log(3), Fraction(20795, 10**5), Fraction(20796, 10**5)),
    "a number at its end": number("a", sp.sqrt(4), 2, 3),
    "a root of a polynomial": number("a", sp.CRootOf(X**3 - X - 1, 0), "1.3247", "1.3248"),
    "a number outside": number("a", sp.pi, 3, Fraction(31, 10), inside=False),
    "a series": series("a", sp.sin(X) / (1 - X), X + X**2 + 5 * X**3 / 6, X, 3),
    "a series that differs": series("a", sp.exp(R * X), 1 + R * X, X, 2, equal=False),
}
WRONG = {
    "identity": replace(RIGHT["identity"], right="x + 2"),
    "equal, though different": replace(RIGHT["identity"], equal=False),
    "different, though equal": replace(RIGHT["different"], equal=True),
    "a witness at which both are the same": replace(RIGHT["different"], at=(("x", "1"),)),
    "a condition that the witness misses": replace(RIGHT["different"], conditions=("x < 0",)),
    "a witness where a denominator vanishes": replace(different("a", 1 / (X - 1), X), at=(("x", "1"),)),
    "a sign": replace(RIGHT["positive"], over=(Term(coefficient="-1"),)),
    "another numerator": replace(RIGHT["positive"], over=(Term(coefficient="1", powers=(("x", 1),)),)),
    "an odd power of a name without a sign": replace(RIGHT["positive"], nonnegative=()),
    "rank": replace(RIGHT["rank"], rank=1),
    "no kernel": replace(RIGHT["rank"], kernel=(("1",), ("1",), ("1",))),
    "a minor that is zero": replace(RIGHT["rank"], rows=(0, 1)),
    "a solution": replace(RIGHT["contained"], solution=(("2",), ("4",))),
    "a separator": replace(RIGHT["not contained"], separator=("1", "0", "0")),
    "a pivot": replace(RIGHT["minimum"], pivots=("2", "3/2", "-4/3")),
    "another triangle": replace(RIGHT["minimum"], lower=(("1", "0", "0"), ("0", "1", "0"), ("0", "0", "1"))),
    "knots": replace(RIGHT["knots"], numbers=("0", "0", "0", "1", "1")),
    "another power of a root": replace(RIGHT["a root"], roots=(("r", "x", 3),)),
    "another radicand": replace(RIGHT["a root of a root"], roots=(("r", "x + 1", 2), ("s", "r", 2))),
    "a root taken for a letter": replace(RIGHT["a circle"], roots=()),
    "matrices in another order": replace(RIGHT["matrices"], left="m1*m2*m1^-1"),
    "matrices said to be the same": replace(RIGHT["matrices that differ"], equal=True),
    "a number beyond its end": replace(RIGHT["a number"], high="20795/100000"),
    "a number said to be outside": replace(RIGHT["a number"], inside=False),
    "a number said to be inside": replace(RIGHT["a number outside"], inside=True),
    "another root": replace(RIGHT["a root of a polynomial"], left="real_root(x_^3 - x_ - 2, 1)"),
    "another coefficient": replace(RIGHT["a series"], right="x + x^2 + x^3"),
    "another power": replace(RIGHT["a series"], power=4),
    "a series said to be the same": replace(RIGHT["a series that differs"], equal=True),
}
