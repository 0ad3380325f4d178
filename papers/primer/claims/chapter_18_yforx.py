"""The y of a curve at a given x: the parameter is a root of a cubic polynomial."""

from __future__ import annotations

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import equations, holds

_t, _x = letter("yforx.3", "t"), letter("yforx.3", "x")
_WEIGHTS = [letter("yforx.1", name) for name in "abcd"]
_CURVE = identity(where={sp.Function("x(t)", real=True): lambda t: de_casteljau(_WEIGHTS, t)})
[_EQUATION] = steps("yforx.3")

CLAIMS = (
    holds(
        "yforx.1",
        "One coordinate of the cubic curve with the weights a, b, c and d.",
        *parts(_CURVE, *equations("yforx.1")),
    ),
    holds(
        "yforx.2",
        "The same, collected by powers of t.",
        *parts(_CURVE, *equations("yforx.2")),
    ),
    holds(
        "yforx.3",
        "The parameters at which the coordinate is x are the roots of the collected polynomial with x taken from its "
        "constant term.",
        part(
            identity(),
            formula(sp.Eq(de_casteljau(_WEIGHTS, _t) - _x, _EQUATION.left - _EQUATION.right, evaluate=False)),
        ),
    ),
)
