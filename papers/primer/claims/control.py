"""Weights: the coordinates of the points that a curve is made of."""

from __future__ import annotations

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import parts
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import definition, equations, holds

# The curve that begins at (120, 160) and ends at (220, 40), in the words of the text.
_POINTS = {"x": (120, 35, 220, 220), "y": (160, 200, 260, 40)}
_t = letter("control.2", "t")

CLAIMS = (
    definition(
        "control.1",
        "The sum over i from 0 to n of binomial, power of 1 - t, power of t and the weight i.",
        "the curve of order n with its weights",
    ),
    holds(
        "control.2",
        "The cubic curve with the points (120, 160), (35, 200), (220, 260) and (220, 40), coordinate by coordinate.",
        *parts(
            identity(
                where={sp.Symbol(k, real=True): de_casteljau(list(map(sp.Integer, v)), _t) for k, v in _POINTS.items()}
            ),
            *equations("control.2"),
        ),
    ),
)
