"""How much a curve bends."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks import code, identity
from semispline.papers.ledger import Consequence, corrected, formula, part, parts
from semispline.papers.primer.checks.following import probed_at
from semispline.papers.primer.checks.plane import curvature, curvature_radius, quarter_circle
from semispline.papers.primer.checks.running import code_of
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import equations, fails, holds

# x', y', x'' and y'' of any curve at one point.
_JET = tuple(letter("curvature.1", name) for name in ("x'", "y'", "x''", "y''"))
_t = letter("curvature.2", "t")
_KAPPA, _RADIUS = (sp.Function(name, real=True) for name in ("\\kappa(t)", "R(t)"))
_MEANINGS: dict[Any, Any] = {
    letter("curvature.1", "\\kappa"): curvature(*_JET),
    _KAPPA(_t): curvature(*_JET),
    _RADIUS(_t): curvature_radius(*_JET),
}
for _name, _first, _second in (("B_x(t)", _JET[0], _JET[2]), ("B_y(t)", _JET[1], _JET[3])):
    _value = sp.Function(_name, real=True)(_t)
    _MEANINGS |= {sp.Derivative(_value, _t): _first, sp.Derivative(_value, (_t, 2)): _second}
# At the speeds 5^3 and 13^3 all roots are rational.
_PLACES = [dict(zip(_JET, jet, strict=True)) for jet in ((75, 100, 1, 2), (2028, -845, -1, 3))]
_BENDING = probed_at(
    identity(
        where=_MEANINGS,
        method="how fast the unit tangent turns towards its left normal, over the speed, for any first and second "
        "derivatives, against the print in normal form",
    ),
    _MEANINGS,
    *_PLACES,
)


_CALL = "kappa(t, B)"


def _coordinates(first: int, **more: Any) -> Mapping[str, Any]:
    """Return a derivative as an object of the code, from the place of its coordinates among the four."""
    x, y = _JET[first], _JET[first + 1]
    return {"getX": lambda _: x, "getY": lambda _: y, **more}


_CODE = code(
    given={"B": {"getDerivative": lambda: _coordinates(0, getDerivative=lambda: _coordinates(2))}},
    where=_MEANINGS,
    method="the printed code, run exactly for any first and second derivatives, against how fast the unit tangent "
    "turns",
)


def _right(kappa: Any, jet: tuple[Any, ...]) -> Any:
    x1, y1, x2, y2 = jet
    return sp.Eq(kappa, (x1 * y2 - x2 * y1) / (x1**2 + y1**2) ** sp.Rational(3, 2), evaluate=False)


def _of_circle() -> Consequence:
    """Measure the radius of curvature of a quarter circle of radius 100, at its start."""
    (x, y), t = quarter_circle(100)
    x1, y1, x2, y2 = (float(e.diff(t, k).subs(t, 0)) for k in (1, 2) for e in (x, y))
    turning = x1 * y2 - x2 * y1
    return Consequence(
        "the cubic curve that stands for a quarter circle of radius 100, radius of curvature at its start",
        {"radius": (x1**2 + y1**2) ** (2 / 3) / turning},
        {"radius": (x1**2 + y1**2) ** (3 / 2) / turning},
    )


def _of_code() -> Consequence:
    """Measure what the code gives for the same curve, and what it would give put right."""
    (x, y), t = quarter_circle(100)
    x1, y1, x2, y2 = (float(e.diff(t, k).subs(t, 0.5)) for k in (1, 2) for e in (x, y))
    return Consequence(
        "the cubic curve that stands for a quarter circle of radius 100, one over what the code gives in its middle",
        {"radius": (x1**2 + y1**2) ** (2 / 3) / (x1 * y2 + y1 * x1)},
        {"radius": (x1**2 + y1**2) ** (3 / 2) / (x1 * y2 - y1 * x2)},
    )


CLAIMS = (
    fails(
        "curvature.1",
        "Curvature is the cross product of first and second derivative over the squared speed to the power 2/3.",
        *parts(_BENDING, *equations("curvature.1")),
        correction=corrected(
            "the exponent is 3/2: the cube of the speed",
            part(_BENDING, formula(_right(letter("curvature.1", "\\kappa"), _JET))),
        ),
        consequence=_of_circle,
        remark="With 2/3 the value depends on how fast the curve is run through, which curvature does not.",
    ),
    fails(
        "curvature.2",
        "The same with the derivatives of the coordinate functions.",
        *parts(_BENDING, *equations("curvature.2")),
        correction=corrected(
            "the exponent is 3/2",
            part(
                _BENDING,
                formula(
                    _right(
                        _KAPPA(_t),
                        tuple(
                            sp.Derivative(sp.Function(name, real=True)(_t), (_t, k))
                            for k in (1, 2)
                            for name in ("B_x(t)", "B_y(t)")
                        ),
                    )
                ),
            ),
        ),
        consequence=_of_circle,
    ),
    fails(
        "curvature.3",
        "Code for the curvature of a curve at a parameter.",
        part(_CODE, formula(sp.Eq(_KAPPA(_t), code_of("curvature.3", _CALL), evaluate=False))),
        correction=corrected(
            "the second product is dy ddx, and it is taken off; the exponent is 3/2",
            part(
                _CODE,
                formula(
                    sp.Eq(
                        _KAPPA(_t),
                        code_of("curvature.3", _CALL, {"+ dy * dx": "- dy * ddx", "2/3": "3/2"}),
                        evaluate=False,
                    )
                ),
            ),
        ),
        consequence=_of_code,
    ),
    holds(
        "curvature.4",
        "The radius of the circle that fits the curve at a point is one over the curvature there.",
        *parts(
            identity(
                where=_MEANINGS,
                method="the circle through the point, centre on its left normal, whose squared distance to the curve "
                "has no second derivative, against the print in normal form",
            ),
            *equations("curvature.4"),
        ),
        remark="With a sign, as curvature has here: negative where the curve turns right. Where the curvature is 0 "
        "there is no circle. With curvature as in curvature.2 it is not the radius.",
    ),
)
