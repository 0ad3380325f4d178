"""Where the coordinates of a curve are greatest and least: zeros of polynomials."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import code, identity
from semispline.papers.ledger import formula, part, parts, unconditional
from semispline.papers.primer.checks.cubic_roots import KNOWN, power_sums, real_zeros_meet
from semispline.papers.primer.checks.curves import basis
from semispline.papers.primer.checks.running import code_of
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, holds, holds_if

_a, _b, _c, _x, _t = (letter("extremities.1", name) for name in ("a", "b", "c", "x", "t"))
_POINTS = [letter("extremities.3", f"p_{i}") for i in range(1, 5)]
_v = [letter("extremities.3", f"v_{i}") for i in range(1, 4)]
_CUBIC = {"B(t)": lambda t: de_casteljau(_POINTS, t)}

_NOT_FLAT = identity(
    where={_x: -_b / _a},
    each=[{}, {_a: 0}],
    complete=True,
    own=lambda at: _a not in at,
    meets=lambda at: _a not in at,
    method="both sides carried out and compared in normal form, for all letters; where a is 0 there is no quotient",
)
_QUADRATIC = {"f(t)": lambda t: _a * t**2 + _b * t + _c}
# A line with the zero that is claimed for it.
_LINE = {"l(x)": lambda x: _a * x + _b}

# extremities.3, transcribed by hand: a dot stands where a comma is meant.
_PRINTED_V = tuple(3 * (high - low) for low, high in pairwise(_POINTS))
_DERIVATIVE = sp.Derivative(de_casteljau(_POINTS, _t), _t)
_MIXED = sp.Add(*(v * basis(2, i, _t) for i, v in enumerate(_PRINTED_V)))

_IN_POINTS = dict(zip(_v, _PRINTED_V, strict=True))
_POWERS = sp.Poly(de_casteljau(_POINTS, _t).diff(_t), _t)
_COEFFICIENTS = {**_IN_POINTS, **dict(zip((_a, _b, _c), _POWERS.all_coeffs(), strict=True))}

# Newton's step: any function with some value and slope where it starts.
_value, _slope, _end = sp.symbols("F G s")
_STEP = letter("extremities.8", "n")
_TIME = sp.IndexedBase("t_n", real=True)
_START = _TIME[_STEP]
_ZERO = {_TIME[_STEP + 1]: sp.solve(_value + _slope * (_end - _START), _end)[0]}


def _newton() -> Any:
    """Return that the step ends where the tangent is zero."""
    [step] = steps("extremities.8", {"f_y(t)": lambda t: _value + _slope * (t - _START)})
    return formula(sp.Eq(step.left, step.right.doit(), evaluate=False), sp.Ne(_slope, 0))


_m = sp.Symbol("m", integer=True, nonnegative=True)
_SUMS = sp.symbols("count s1 s2 s3", real=True)
_CALL = """\
found = getCubicRoots(pa, pb, pc, pd)
one = 0
two = 0
three = 0
for each z in found:
  one += z
  two += z^2
  three += z^3
[found.length, one, two, three]"""


def _points_given(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    points = dict(zip(("pa", "pb", "pc", "pd"), KNOWN[int(instance[_m])].points, strict=True))
    return {**points, "approximately": lambda one, other: one == other}


def _sums_found(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    sums = power_sums(KNOWN[int(instance[_m])].zeros)
    return {letter: sums[str(letter)] for letter in _SUMS}


_LINES = {
    "line 7, column 7: <= for <": "the cube root of 0 is 0 both ways",
    "line 60, column 13: <= for <": "the cube root of 0 is 0 both ways",
    "line 60, column 15: 1 for 0": "the cube root of -x is that of x with the other sign",
    **dict.fromkeys(
        (
            "line 49, column 15: <= for <",
            "line 49, column 17: 2 for 1",
            "line 49, column 21: + for -",
            "line 49, column 22: 2 for 1",
            "line 49, column 27: >= for >",
            "line 49, column 28: 2 for 1",
            "line 49, column 32: 2 for 1",
        ),
        "where there are three roots t is between -1 and 1; the conditions only guard against rounding",
    ),
}
_SAME = {
    f"Eq((count, s1, s2, s3), code([found.length, one, two, three], {place}))": why for place, why in _LINES.items()
}
_FINDS_ROOTS = real_zeros_meet(
    code(
        each={_m: range(len(KNOWN))},
        given=_points_given,
        where=_sums_found,
        method="the printed code, run exactly, for polynomials made of their zeros, some for each branch: how many it "
        "finds, and the sums of their first three powers; `approximately` is =",
    ),
    frozenset(f"m = {m}" for m, known in enumerate(KNOWN) if not known.real),
)


CLAIMS = (
    holds_if(
        "extremities.1",
        "A line a x + b is zero at x = -b / a.",
        "a is not 0",
        part(unconditional(identity()), equations("extremities.1", _LINE)[0]),
        *parts(_NOT_FLAT, *equations("extremities.1", _LINE)[1:]),
    ),
    holds_if(
        "extremities.2",
        "a t^2 + b t + c is zero at (-b + r) / 2a and (-b - r) / 2a, r the root of b^2 - 4 a c.",
        "a is not 0",
        *parts(_NOT_FLAT, *(equations("extremities.2", _QUADRATIC, branch=branch)[0] for branch in (1, -1))),
        remark="a is 0 where p_4 - p_1 = 3 (p_3 - p_2), as in every quadratic curve that is said as a cubic one.",
    ),
    holds(
        "extremities.3",
        "The derivative of a cubic curve has three times the differences of its points for points.",
        part(identity(), formula(sp.Eq(_DERIVATIVE, _MIXED, evaluate=False))),
    ),
    holds(
        "extremities.4",
        "That derivative, ordered by powers of t.",
        *parts(identity(where=_IN_POINTS), *equations("extremities.4", _CUBIC)),
    ),
    holds(
        "extremities.5",
        "Its coefficients in those differences, and in the points.",
        *parts(identity(where=_COEFFICIENTS), *equations("extremities.5")),
    ),
    definition(
        "extremities.6",
        "A cubic equation with all its coefficients, and one without second power and with 1 before the third.",
        "the general cubic equation, and the form to which it is brought",
    ),
    holds_if(
        "extremities.7",
        "Code for the real zeros between 0 and 1 of a polynomial of degree 3 at most that is given by its points.",
        "it is not quadratic without real zeros",
        part(
            _FINDS_ROOTS,
            formula(sp.Eq(sp.Tuple(*_SUMS), code_of("extremities.7", _CALL), evaluate=False), equivalent=_SAME),
        ),
        remark="The quadratic branch takes the root of a negative number; where that is a value which no comparison "
        "accepts, as in some languages, nothing is returned, and that is right. A zero of order three, and a double "
        "one of a quadratic polynomial, is returned twice.",
    ),
    holds(
        "extremities.8",
        "Newton's step: from t_n to where the tangent at t_n is zero.",
        part(identity(where=_ZERO), _newton()),
        remark="It says nothing of where the steps end.",
    ),
)
