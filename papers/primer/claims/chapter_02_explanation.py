"""Parametric functions, and the polynomials that a curve is made of."""

from __future__ import annotations

from math import comb
from typing import Any

import sympy as sp

from semispline.papers.checks import code, identity
from semispline.papers.ledger import Formula, corrected, formula, part, parts
from semispline.papers.primer.checks.curves import ORDERS, basis, row
from semispline.papers.primer.checks.running import code_of
from semispline.papers.primer.printed import letter, terms_of
from semispline.papers.primer.writing import definition, equations, fails, holds

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

_n, _t = letter("explanation.9", "n"), letter("explanation.9", "t")
_k = sp.Symbol("k", integer=True, nonnegative=True)
_SUM = equations("explanation.9")[0].relation.rhs
_CALL = "Bezier(n, t)"


def _is_sum(identifier: str, **more: Any) -> Formula:
    return formula(sp.Eq(_SUM, code_of(identifier, _CALL, **more), evaluate=False))


def _chosen(n: Any, k: Any) -> int:
    """Return how many ways there are to choose k of n, for code that uses a table of them."""
    return comb(int(n), int(k))


_RUN = code(each={_n: (0, *ORDERS)}, given={"binomial": _chosen})
_LONGER_ROW = {
    "Eq(binomial(n, k), code(binomial(n, k), line 11, column 32: 2 for 1))": "a place more at the end of a row, which "
    "is never read"
}
# Three rows more than the table has.
_ALL_CHOICES = [{_n: n, _k: k} for n in range(10) for k in range(n + 1)]

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
    fails(
        "explanation.10",
        "Code for that sum.",
        part(_RUN, _is_sum("explanation.10")),
        correction=corrected(
            "the loop goes on while k <= n", part(_RUN, _is_sum("explanation.10", instead={"k<n": "k<=n"}))
        ),
    ),
    holds(
        "explanation.11",
        "Code for binomials: a table with the rows 0 to 6 that grows by the rows that are asked for.",
        part(
            code(each=_ALL_CHOICES, method="the printed code, run for all binomials of the rows 0 to 9"),
            formula(
                sp.Eq(sp.binomial(_n, _k), code_of("explanation.11", "binomial(n, k)"), evaluate=False),
                equivalent=_LONGER_ROW,
            ),
        ),
    ),
    holds("explanation.12", "Code for that sum, with the table of binomials.", part(_RUN, _is_sum("explanation.12"))),
    holds(
        "explanation.13",
        "Code for the orders 2 and 3 alone, without a loop.",
        part(code(each={_n: (2, 3)}, complete=True), _is_sum("explanation.13")),
    ),
)
