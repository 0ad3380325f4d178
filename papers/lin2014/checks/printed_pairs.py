"""The pairs of contact curves whose knots the paper prints, as exact knot vectors."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import sympy as sp

from semispline.papers.checks import clamped
from semispline.papers.ledger import as_fraction
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.printed import CUBIC

# The pairs of contact curves whose knots the paper prints; those of Fig. 10 with the fourth zero that is missing.
PRINTED_PAIRS = {
    "Fig. 5": ("fig-5.first", "fig-5.second"),
    "Fig. 6": ("fig-6.planar", "fig-6.curved"),
    "Figs. 8 and 9": ("fig-8.larger", "fig-8.smaller"),
    "Fig. 10": ("fig-10.first", "fig-10.second"),
}

WITH_MIDDLE_CURVE = ("Fig. 5", "Fig. 6", "Figs. 8 and 9")


def printed_pair(name: str) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
    """Return both knot vectors of a figure, clamped."""
    first, second = (clamped(CUBIC, *inner_knots(key)) for key in PRINTED_PAIRS[name])
    return first, second


def inner_knots(key: str) -> list[Fraction]:
    """Return the knots of a printed vector strictly inside [0, 1]."""
    return [as_fraction(x) for x in map(sp.Rational, pr.KNOTS[key]) if 0 < x < 1]


@cache
def merged(name: str) -> tuple[Fraction, ...]:
    """Return v_1, .., v_n of a figure: inner knots of both vectors, each once."""
    first, second = PRINTED_PAIRS[name]
    return tuple(sorted({*inner_knots(first), *inner_knots(second)}))
