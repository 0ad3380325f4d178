"""Tangent and normal of a plane curve."""

from __future__ import annotations

import numpy as np
import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, corrected, formula, part, parts
from semispline.papers.primer.checks.general import said_again
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, fails, holds

_t, _d = (letter("pointvectors.2", name) for name in "td")
_x, _y, _x_new, _y_new, _phi = (letter("pointvectors.5", name) for name in ("x", "y", "x'", "y'", "\\phi"))

# Any curve that has a derivative has at one parameter some value and some derivative, and more is not asked of it.
_value, _u, _v = sp.symbols("B u v")
_SPEED = sp.sqrt(_u**2 + _v**2)
_TANGENT = {name: sp.Function(f"tangent_{name}(t)", real=True) for name in "xy"}
_VECTOR = {"tangent(t)": lambda t: sp.ImmutableMatrix([_TANGENT["x"](t), _TANGENT["y"](t)])}
_CHECK = identity(
    where={
        sp.Function("B_x(t)", real=True): lambda t: _value + _u * t,
        sp.Function("B_y(t)", real=True): lambda t: _value + _v * t,
        _TANGENT["x"]: lambda t: _u,
        _TANGENT["y"]: lambda t: _v,
        _d: _SPEED,
        # The vector of length 1 in the direction of the tangent: u and v in the proportion that makes it so.
        sp.Function("\\hat{x}(t)", real=True): lambda t: _u / _SPEED,
        sp.Function("\\hat{y}(t)", real=True): lambda t: _v / _SPEED,
        # The length of a number, a vector with one coordinate.
        sp.Function("norm"): lambda number: sp.sqrt(number**2),
    }
)
# Bars only round vectors of the plane: what is left of pointvectors.3 without the first quotient of each line.
_STEPS = steps("pointvectors.3", _VECTOR)
_RIGHT = tuple(
    formula(sp.Eq(_STEPS[first].left, _STEPS[n].right, evaluate=False))
    for first in (0, 3)
    for n in (first + 1, first + 2)
)

_pi = sp.Symbol("π", real=True)
_hat = {name: sp.Symbol(f"{name}̂") for name in "xy"}
_nx, _ny = sp.symbols("n_x n_y")
# The only vector at a right angle to another one, of its length and on its left.
_NORMAL = sp.solve(
    [_nx * _hat["x"] + _ny * _hat["y"], _hat["x"] * _ny - _hat["y"] * _nx - _hat["x"] ** 2 - _hat["y"] ** 2], _nx, _ny
)
_TURNED = {
    "\\pi": _pi,
    "\\hat{x}(t)": lambda t: _hat["x"],
    "\\hat{y}(t)": lambda t: _hat["y"],
    "normal_x(t)": lambda t: sp.simplify(_NORMAL[_nx]),
    "normal_y(t)": lambda t: sp.simplify(_NORMAL[_ny]),
}

# A point at some distance from the origin, in some direction, and the one with the direction turned.
_r, _angle = sp.symbols("r a", real=True)
_POLAR = {
    _x: _r * sp.cos(_angle),
    _y: _r * sp.sin(_angle),
    _x_new: _r * sp.cos(_angle + _phi),
    _y_new: _r * sp.sin(_angle + _phi),
}

_CURVE = ((120, 160), (35, 200), (220, 260), (220, 40))


def _consequence() -> Consequence:
    """Return how far the vector of the amounts is from the tangent in direction, and from 1 in length."""
    t = np.linspace(0, 1, 101)[:, None]
    a, b, c = (np.array(p) for p in 3 * np.diff(_CURVE, axis=0))
    tangents = a * (1 - t) ** 2 + 2 * b * (1 - t) * t + c * t**2
    amounts = np.abs(tangents)
    lengths = np.linalg.norm(tangents, axis=1)
    cosines = np.sum(tangents * amounts, axis=1) / lengths**2
    return Consequence(
        "the vector with the lengths of the coordinates of the tangent for its coordinates, at 101 parameters of the "
        "curve with the points (120, 160), (35, 200), (220, 260), (220, 40): its angle to the tangent, and its length",
        {
            "greatest angle (degrees)": float(np.degrees(np.arccos(cosines.min()))),
            "greatest length": float(lengths.max()),
        },
        {"greatest angle (degrees)": 0.0, "greatest length": 1.0},
    )


CLAIMS = (
    definition(
        "pointvectors.1",
        "The tangent has the derivatives of the coordinates for its coordinates.",
        "the tangent of a curve",
    ),
    holds(
        "pointvectors.2",
        "The length of the tangent is the root of the sum of the squares of its coordinates.",
        *parts(_CHECK, *equations("pointvectors.2", _VECTOR)),
    ),
    fails(
        "pointvectors.3",
        "The coordinates of the tangent at length 1: each is the length of a coordinate of the tangent, which is that "
        "coordinate through the length of the tangent, which is the derivative through d.",
        *parts(_CHECK, *equations("pointvectors.3", _VECTOR)),
        correction=corrected(
            "Without the bars round single coordinates: each is that coordinate through the length of the tangent",
            *parts(_CHECK, *_RIGHT),
        ),
        consequence=_consequence,
        remark="Bars are the length in the same line and in the display before: round one coordinate they give its "
        "amount, neither divided by the length nor with its sign.",
    ),
    holds(
        "pointvectors.4",
        "The normal is the tangent at length 1 turned by a quarter to the left, by the cosine and sine of that angle.",
        *parts(
            identity(where={_pi: sp.pi}),
            *(
                said_again(e, {_pi: sp.pi}, "the cosine of a quarter of a turn is zero")
                for e in equations("pointvectors.4", _TURNED)
            ),
        ),
        remark="The text beside it says sine and cosine of a quarter, half and three quarters of a turn, but gives the "
        "cosine first.",
    ),
    holds(
        "pointvectors.5",
        "The coordinates of a point turned round the origin by an angle.",
        *parts(identity(where=_POLAR), *equations("pointvectors.5")),
    ),
    holds(
        "pointvectors.6",
        "The same by a matrix.",
        part(identity(where=_POLAR), *equations("pointvectors.6")),
    ),
)
