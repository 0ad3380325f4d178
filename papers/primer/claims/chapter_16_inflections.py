"""Where a cubic curve has no curvature."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, corrected, formula, part, parts
from semispline.papers.primer.printed import letter, steps, terms_of
from semispline.papers.primer.writing import definition, equations, fails, holds

_t = letter("inflections.3", "t")
_X, _Y = ([letter("inflections.3", f"{c}_{i}") for i in range(1, 5)] for c in "xy")
_CURVE = sp.Function("Bézier(t)", real=True)
_CROSS = sp.Function("C(t)", real=True)


def _cross(x: list[Any], y: list[Any], t: Any) -> Any:
    """Return first times second derivatives of the coordinates of a curve, crosswise."""
    dx, dy = (de_casteljau(c, t).diff(t) for c in (x, y))
    return sp.expand(dx * dy.diff(t) - dy * dx.diff(t))


_ANY = _cross(_X, _Y, _t)
# The curve begins in the origin and ends on the x-axis.
_ALIGNED = sp.expand(_ANY.xreplace({_X[0]: sp.Integer(0), _Y[0]: sp.Integer(0), _Y[3]: sp.Integer(0)}))

_DERIVATIVES = [sp.Poly(de_casteljau(_Y, _t).diff((_t, n)), _t) for n in (1, 2)]


def _bernstein(polynomial: Any, order: int) -> list[Any]:
    """Return the weights of a polynomial as a curve of some order."""
    unknown = list(sp.symbols(f"b:{order + 1}"))
    apart = sp.Poly(de_casteljau(unknown, _t) - polynomial.as_expr(), _t)
    [found] = sp.linsolve(apart.all_coeffs(), unknown)
    return list(found)


_SAME_FOR_Y = {
    letter("inflections.4", name): value
    for name, value in zip("defwz", [*_bernstein(_DERIVATIVES[0], 2), *_bernstein(_DERIVATIVES[1], 1)], strict=True)
}

_QUADRATIC = [letter("inflections.8", name) for name in "abcd"]
_a, _b, _c, _d = _QUADRATIC
_PRODUCTS = dict(zip(_QUADRATIC, (_X[2] * _Y[1], _X[3] * _Y[1], _X[1] * _Y[2], _X[3] * _Y[2]), strict=True))
# Numbers for which the three coefficients of the equation, as they are printed, are x, y and z.
_x, _y, _z = (letter("inflections.8", name) for name in "xyz")
_given_c = _a + _z / 18
_given_b = 3 * _a - 3 * _given_c - _y / 18
_given_d = -3 * _a + 2 * _given_b + 3 * _given_c - _x / 18
_GIVEN = {"b": _given_b, "c": _given_c, "d": _given_d}


def _zero(branch: int) -> Any:
    """Return that the polynomial of inflections.7 is zero at a printed parameter."""
    last = steps("inflections.8", _GIVEN, branch)[-1].right
    named = [_in_products(coefficient) for coefficient in sp.Poly(_ALIGNED, _t).all_coeffs()]
    two, one, none = (sp.expand(c.xreplace({_b: _given_b, _c: _given_c, _d: _given_d})) for c in named)
    return formula(sp.Eq(two * last**2 + one * last, -none, evaluate=False), sp.Ne(_x, 0))


def _in_products(coefficient: Any) -> Any:
    """Return a coefficient of the aligned curve in the four products that have names."""
    for name, product in _PRODUCTS.items():
        coefficient = sp.expand(coefficient).subs(product, name)
    return coefficient


_ONE_PRINTED = terms_of("inflections.6")[0][0]
_RIGHT_6 = steps("inflections.7")[-1].right
_INSIDE = (_t >= 0, _t <= 1)

# An aligned curve with one inflection: (0, 0), (1, 2), (3, -1), (4, 0).
_SAMPLE = dict(zip((*_X, *_Y), map(sp.Integer, (0, 1, 3, 4, 0, 2, -1, 0)), strict=True))


def _consequence() -> Consequence:
    found = {}
    for name, cross in (("printed", _ONE_PRINTED), ("true", _ALIGNED)):
        roots = np.roots([float(c) for c in sp.Poly(cross.xreplace(_SAMPLE), _t).all_coeffs()])
        found[name] = [float(r.real) for r in roots if abs(r.imag) < 1e-12 and 0 <= r.real <= 1]
    [true] = found["true"]
    nearest = min((abs(t - true) for t in found["printed"]), default=1.0)
    return Consequence(
        "the parameter at which the curve with the points (0, 0), (1, 2), (3, -1), (4, 0) has its inflection",
        {"inflections found": len(found["printed"]), "distance to the true one": nearest},
        {"inflections found": len(found["true"]), "distance to the true one": 0.0},
    )


CLAIMS = (
    definition("inflections.1", "C is zero at the parameters that are sought.", "an inflection"),
    definition(
        "inflections.2",
        "C is first times second derivatives of the coordinates, crosswise.",
        "the function C",
        remark="It is the curvature times the third power of the speed, and zero where the curvature is.",
    ),
    holds(
        "inflections.3",
        "A coordinate of the cubic curve, its first and its second derivative, as curves.",
        *parts(identity(where={_CURVE: lambda t: de_casteljau(_X, t)}), *equations("inflections.3")),
    ),
    holds(
        "inflections.4",
        "The same for the other coordinate, its weights d, e, f and w, z made as before.",
        *parts(identity(where={_CURVE: lambda t: de_casteljau(_Y, t), **_SAME_FOR_Y}), *equations("inflections.4")),
    ),
    holds(
        "inflections.5",
        "C of any cubic curve, as a sum of products.",
        part(identity(), formula(sp.Eq(_ANY, sp.Add(*terms_of("inflections.5")[0]), evaluate=False))),
    ),
    fails(
        "inflections.6",
        "C of a curve that begins in the origin and ends on the x-axis.",
        part(identity(), formula(sp.Eq(_ALIGNED, _ONE_PRINTED, evaluate=False), *_INSIDE)),
        correction=corrected(
            "- 3 x_3 y_2 in the place of 3 x_3 y_2 before t^2, as inflections.7 has it",
            part(identity(), formula(sp.Eq(_ALIGNED, _RIGHT_6, evaluate=False), *_INSIDE)),
        ),
        consequence=_consequence,
    ),
    holds(
        "inflections.7",
        "The same with names for the four products that are in it.",
        *parts(identity(where={_CROSS: lambda t: _ALIGNED.xreplace({_t: t})}), *equations("inflections.7")),
    ),
    holds(
        "inflections.8",
        "Where it is zero: the two solutions of a quadratic equation with named coefficients.",
        *parts(identity(), _zero(1), _zero(-1)),
        remark="That x is not 0 is said behind it.",
    ),
)
