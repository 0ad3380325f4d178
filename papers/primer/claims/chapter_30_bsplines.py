"""Splines over knots: their functions, de Boor's triangle, and both as code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from math import dist
from typing import Any

import sympy as sp

from semispline.papers.checks import code, identity
from semispline.papers.ledger import Consequence, Formula, corrected, formula, mutants, part, parts
from semispline.papers.primer.checks.knots import function, knot, point
from semispline.papers.primer.checks.running import code_of
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import definition, equations, fails, holds

_n, _k, _i, _t = (letter("bsplines.1", name) for name in "nkit")
_degree, _span = sp.symbols("degree span", integer=True)
_P, _knot, _knots, _alpha = (sp.IndexedBase(name, real=True) for name in ("P_i", "knot_i", "knots[i]", "\\alpha_{i,k}"))
_N, _d, _POINT = (sp.Function(name, real=True) for name in ("N_{i,k}(t)", "d^k_i(t)", "Point(t)"))


def _of(left: Any, right: Any, *assumptions: Any) -> Formula:
    return formula(sp.Eq(left, right, evaluate=False), *assumptions)


def _sum_to(last: Any) -> Any:
    return sp.Sum(_P[_i] * _N(_i, _k, _t), (_i, 0, last))


def _of_points(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Return the point of a curve with n control points: each with its function, whatever that is."""
    count = int(instance[_n])
    return {_POINT(_t): sp.Add(*(_P[j] * _N(j, _k, _t) for j in range(count)))}


_POINTS = identity(
    where=_of_points, each={_n: range(1, 6)}, method="as many terms as there are control points, for n = 1 .. 5"
)


def _of_functions(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    span = int(instance[_span])
    return {
        _knot: knot,
        _N: lambda i, k, at: function(int(i), int(k), at, span) if int(k) > 0 else sp.Integer(0),
    }


_FUNCTIONS = identity(
    where=_of_functions,
    each=[{_i: 1, _k: order, _span: span} for order in (2, 3, 4) for span in range(1, order + 1)],
    method="the functions as divided differences of truncated powers, any distinct knots, on each span, orders 2 to 4",
)


def _alpha_of(degree: int) -> Any:
    """Return the weight with which the triangle goes from level k - 1 to level k."""
    return lambda i, k: (_t - knot(i)) / (knot(i + 1 + degree - k) - knot(i))


def _of_triangle(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Return the points of the triangle as values of the polar form of any polynomial."""
    degree = int(instance[_degree])
    return {
        _knots: knot,
        _alpha: _alpha_of(degree),
        _d: lambda i, k, at: point(degree, int(i), int(k), at),
        _N: lambda i, order, _: sp.Integer(int(i) == degree) if order == 1 else sp.Symbol(f"N_{i},{order}"),
        _P: lambda i: point(degree, int(i)),
    }


# The last span of a triangle lies behind the knot of the number of its degree.
_STEPS = [
    {_degree: degree, _k: k, _i: i} for degree in (1, 2, 3) for k in range(1, degree + 1) for i in range(k, degree + 1)
]
_TRIANGLE = identity(
    where=_of_triangle,
    each=_STEPS,
    method="points of the triangle as values of the polar form of any polynomial, any knots, degrees 1 to 3, each step",
)


def _weight(count: Any) -> Any:
    return (_t - _knots[_i]) / (_knots[_i + 1 + count - _k] - _knots[_i])


def _over_numbers(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Return the same with knot j at j."""
    numbers = {knot(j): sp.Integer(j) for j in range(12)}

    def put_in(meaning: Any) -> Any:
        return lambda *values: meaning(*values).subs(numbers)

    return {letter_: put_in(meaning) for letter_, meaning in _of_triangle(instance).items()}


# Seven points of degree 3, in the words of the text.
_WEIGHTS = identity(
    where=_over_numbers,
    each=[{_degree: 3, _k: k, _i: 3, _n: 7} for k in (1, 2, 3)],
    method="the weight with which a polar form goes on to one more t, seven control points, degree 3, levels 1 to 3, "
    "knots "
    "0, 1, 2 ..",
)
_BOTTOM = {_k: [{_degree: 2, _k: 0}], _i: [{_degree: 2, _i: i} for i in range(3)]}
_ENDS = {
    letter_: identity(
        where=_over_numbers,
        each=instances,
        method="the bottom of the triangle: polar form at knots, which is a control point; any points, degree 2, "
        "knots 0, "
        "1, 2 ..",
    )
    for letter_, instances in _BOTTOM.items()
}


def _picture(bottom: Any) -> Any:
    """Return the triangle of bsplines.7, transcribed by hand, for four values at its bottom."""
    level = list(bottom)
    for k in (1, 2, 3):
        level = [_alpha[i, k] * level[i - k + 1] + (1 - _alpha[i, k]) * level[i - k] for i in range(k, 4)]
    return level[0]


_PICTURE = identity(
    where=_of_triangle({_degree: 3}),
    method="the polar form of any polynomial of degree 3 at t, any knots, t behind knot 3",
)
_PICTURE_AT = identity(
    where=_over_numbers({_degree: 3}),
    method="the polar form of any polynomial of degree 3 at t between 3 and 4, knots 0, 1, 2 ..",
)


def _whichever(found: Formula) -> Formula:
    """Say of mutants with another index on the left that they are the same."""
    same = [m.text for m in mutants(found) if m.relation.rhs == found.relation.rhs and m.relation.lhs == _d(4, 3, _t)]
    return replace(found, equivalent=dict.fromkeys(same, "at the last level all arguments are t, and no knot is left"))


# In that span the last one of the values at the bottom is 1.
_ZERO_OR_ONE = [sp.Integer(0), sp.Integer(0), sp.Integer(0), sp.Integer(1)]


def _shrunk() -> Consequence:
    """Measure a curve that is made with 0 and 1, times the point, at the bottom of the triangle."""
    points = [(0, 0), (50, 100), (100, 100), (150, 0)]
    apart = []
    for n in range(101):
        t = 3 + n / 100
        ways = []
        for bottom in (points, [(0, 0)] * 3 + points[3:]):
            level = [list(map(float, p)) for p in bottom]
            for k in (1, 2, 3):
                shares = [(t - i) / (4 - k) for i in range(k, 4)]
                level = [
                    [a * high + (1 - a) * low for low, high in zip(level[j], level[j + 1], strict=True)]
                    for j, a in enumerate(shares)
                ]
            ways.append(level[0])
        apart.append(dist(*ways))
    return Consequence(
        "points (0, 0), (50, 100), (100, 100) and (150, 0), degree 3, knots 0 to 7: largest distance at the same "
        "parameter",
        {"distance": max(apart)},
    )


_place, _section, _value, _s = sp.symbols("place section value s", integer=True)
_KNOT_VECTORS = (
    (3, (0, 1, 2, 3, 4, 5, 6, 7, 8)),
    (2, (0, 0, 0, 1, 3, 4, 4, 4)),
    (3, (0, 0, 0, 0, 2, 2, 5, 5, 5, 5)),
)


def _sections() -> list[tuple[int, tuple[int, ...], Fraction, int]]:
    """Return degree, knots, a parameter and the number of its section: at both ends, and in the middle of each."""
    found: list[tuple[int, tuple[int, ...], Fraction, int]] = []
    for degree, knots in _KNOT_VECTORS:
        first, last = degree, len(knots) - 1 - degree
        inner = [s for s in range(first, last) if knots[s] < knots[s + 1]]
        found += [(degree, knots, Fraction(knots[first]), first), (degree, knots, Fraction(knots[last]), last - 1)]
        found += [(degree, knots, Fraction(knots[s] + knots[s + 1], 2), s) for s in inner]
    return found


_SECTIONS = _sections()


def _section_given(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    degree, knots, t, _ = _SECTIONS[int(instance[_place])]
    return {"domain": [degree, len(knots) - 1 - degree], "knots": list(knots), "t": t}


def _section_found(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    return {_section: sp.Integer(_SECTIONS[int(instance[_place])][3])}


_NEVER_REACHED = {
    "Eq(section, code(s, line 1, column 20: <= for <))": "a parameter of the domain has its section before the loop "
    "ends"
}


_LAST_LEVEL = {
    "Eq(value, code(v[s], line 2, column 18: < for <=))": "at the level L = order the inner loop has nothing to do"
}


def _triangle_given(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    degree, s = int(instance[_degree]), int(instance[_s])
    knots = [knot(j) for j in range(s + degree + 2)]
    # Points that the section does not need are other letters.
    points = [point(degree, i) if i >= s - degree else sp.Symbol(f"far{i}") for i in range(s + 1)]
    return {"s": s, "order": degree + 1, "knots": knots, "points": points, "t": _t}


def _triangle_found(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    degree = int(instance[_degree])
    return {_value: point(degree, 0, degree, _t)}


CLAIMS = (
    fails(
        "bsplines.1",
        "With n control points, numbered from 0, a point of the curve is the sum from 0 to n of each times its "
        "function.",
        *parts(_POINTS, *equations("bsplines.1")),
        correction=corrected(
            "the sum ends with n - 1: there is no control point n", part(_POINTS, _of(_POINT(_t), _sum_to(_n - 1)))
        ),
    ),
    holds(
        "bsplines.2",
        "A function of order k is made of two of order k - 1.",
        *parts(_FUNCTIONS, *equations("bsplines.2")),
        remark="Where knots coincide, as they do further on in the text, a quotient 0/0 counts as 0; the text does "
        "not say "
        "so.",
    ),
    definition(
        "bsplines.3",
        "A function of order 1 is 1 from its knot up to the next one and 0 elsewhere.",
        "the functions of order 1",
        "At the last knot of all they are all 0; with the end knots that the text calls open-uniform the curve has "
        "no end "
        "point by this definition.",
    ),
    holds(
        "bsplines.4",
        "A point of de Boor's triangle is a mixture of two of the level before, with the weights alpha and 1 - alpha.",
        *parts(_TRIANGLE, *equations("bsplines.4")),
        remark="With alpha as corrected in bsplines.5.",
    ),
    fails(
        "bsplines.5",
        "The weight, with n control points.",
        *parts(_WEIGHTS, *equations("bsplines.5")),
        correction=corrected(
            "in the place of n stands the degree", part(_WEIGHTS, _of(_alpha[_i, _k], _weight(_degree)))
        ),
    ),
    fails(
        "bsplines.6",
        "The triangle ends with 0 at index 0, and at level 0 with 1 or 0, as the functions of order 1.",
        part(_ENDS[_k], equations("bsplines.6")[0]),
        part(_ENDS[_i], equations("bsplines.6")[1]),
        correction=corrected("at level 0 stand the control points", part(_ENDS[_i], _of(_d(_i, 0, _t), _P[_i]))),
        consequence=_shrunk,
        remark="The text takes half of it back below the triangle (0 or 1, times the control point); what comes of "
        "it then "
        "is one point times its function, and not the sum of four. The code of bsplines.9 has it right.",
    ),
    fails(
        "bsplines.7",
        "The triangle of degree 3, with 0 or 1 at the bottom, and 0 at index 0.",
        part(_PICTURE_AT, _whichever(_of(_d(3, 3, _t), _picture(_ZERO_OR_ONE), _t >= 3, _t < 4))),
        correction=corrected(
            "the same triangle with the control points at the bottom",
            part(_PICTURE, _whichever(_of(_d(3, 3, _t), _picture([_P[j] for j in range(4)])))),
        ),
        consequence=_shrunk,
    ),
    holds(
        "bsplines.8",
        "The number of the section that a parameter lies in.",
        part(
            code(
                each={_place: range(len(_SECTIONS))},
                given=_section_given,
                where=_section_found,
                method="the printed code, run at both ends of the domain and within each section, for three knot "
                "vectors",
            ),
            formula(sp.Eq(_section, code_of("bsplines.8", "s"), evaluate=False), equivalent=_NEVER_REACHED),
        ),
        remark="At a knot inside of the domain it is the section before it, on which the curve has the same point "
        "there.",
    ),
    holds(
        "bsplines.9",
        "The point of a curve: the triangle, level by level, in a copy of the control points.",
        part(
            code(
                each=[{_degree: degree, _s: s} for degree in (1, 2, 3) for s in (degree, degree + 1)],
                given=_triangle_given,
                where=_triangle_found,
                method="the printed code, run for any polynomial, knots and parameter, degrees 1 to 3, against the "
                "polar form",
            ),
            formula(sp.Eq(_value, code_of("bsplines.9", "v[s]"), evaluate=False), equivalent=_LAST_LEVEL),
        ),
        remark="The level after the last one, L = order, does nothing.",
    ),
)
