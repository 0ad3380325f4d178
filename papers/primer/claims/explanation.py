"""Parametric functions, and the polynomials that a curve is made of."""

from __future__ import annotations

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.checks.curves import basis, row
from semispline.papers.primer.printed import letter, terms_of
from semispline.papers.primer.writing import definition, equations, holds

_T = letter("explanation.6", "t")
_A, _B = (letter("explanation.8", name) for name in "ab")

_x, _y = (step.relation.rhs for step in equations("explanation.4"))
_CIRCLE = formula(sp.Eq(_x**2 + _y**2, 1, evaluate=False))

_POLYNOMIALS = tuple(
    formula(sp.Eq(row(*(basis(n, i, _T) for i in range(n + 1))), row(*terms), evaluate=False))
    for n, terms in enumerate(terms_of("explanation.6"), 1)
)
# In the middle of the curve all products of powers are the same, so that only the binomials are left.
_BINOMIALS = tuple(
    formula(
        sp.Eq(
            row(*(2**n * basis(n, i, sp.Rational(1, 2)) for i in range(n + 1))),
            row(*terms),
            evaluate=False,
        )
    )
    for n, terms in enumerate(terms_of("explanation.7"), 1)
)
_PRODUCTS = tuple(
    formula(sp.Eq(row(*(_A ** (n - i) * _B**i for i in range(n + 1))), row(*terms), evaluate=False))
    for n, terms in enumerate(terms_of("explanation.8"), 1)
)

CLAIMS = (
    definition("explanation.1", "f is the cosine.", "a function of one number, as an example"),
    definition(
        "explanation.2",
        "Two functions, cosine and sine, each of a letter of its own.",
        "two functions",
        remark="Both are named f; as one function it would have two values at the same number.",
    ),
    definition(
        "explanation.3", "Two functions, cosine and sine, of the same letter.", "a parametric function, as an example"
    ),
    holds(
        "explanation.4",
        "x = cos t and y = sin t give points of the circle of radius 1 round the origin.",
        part(identity(), _CIRCLE),
    ),
    definition("explanation.5", "A polynomial of degree three with its four coefficients.", "a cubic polynomial"),
    holds(
        "explanation.6",
        "The terms of the curves of order 1, 2 and 3 are the shares of their points, one by one.",
        *parts(identity(), *_POLYNOMIALS),
    ),
    holds(
        "explanation.7",
        "What is left of the terms without the powers are the binomials of the orders 1 to 4.",
        *parts(identity(), *_BINOMIALS),
    ),
    holds(
        "explanation.8",
        "Without the binomials, with a for 1 - t and b for t, the terms are the products of n factors, first a's and "
        "then b's.",
        *parts(identity(), *_PRODUCTS),
    ),
    definition(
        "explanation.9",
        "The sum over i from 0 to n of binomial, power of 1 - t and power of t.",
        "the function of order n of which the curves are made",
    ),
)
