"""The derivative of a spline."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from math import dist
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import (
    Consequence,
    Counterexample,
    Formula,
    Part,
    UndefinedError,
    corrected,
    formula,
    indexed,
    part,
    parts,
)
from semispline.papers.primer.checks.knots import knot, point, slope
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, fails, holds

_n, _k, _i, _t, _d = (letter("bsplined.3", name) for name in "nkitd")
_P, _Q, _knot = (sp.IndexedBase(name, real=True) for name in ("P_i", "P_i'", "knot_i"))
_N, _C = (sp.Function(name, real=True) for name in ("N_{i,k}(t)", "C(t)"))
_VELOCITY = sp.Derivative(_C(_t), _t)


def _of(left: Any, right: Any) -> Formula:
    return formula(sp.Eq(left, right, evaluate=False))


def _of_points(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Return curve and derivative with n control points: the derivative has one less."""
    count = int(instance[_n])
    return {
        _VELOCITY: sp.Add(*(_Q[j] * _N(j + 1, _k - 1, _t) for j in range(count - 1))),
        _C(_t): sp.Add(*(_P[j] * _N(j, _k, _t) for j in range(count))),
    }


_POINTS = identity(
    where=_of_points, each={_n: range(2, 6)}, method="as many terms as there are control points, for n = 2 .. 5"
)


def _of_polar_form(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    degree = int(instance[_d])
    return {_knot: knot, _P: lambda i: point(degree, int(i)), _Q: lambda i: slope(degree, int(i))}


_SLOPES = identity(
    where=_of_polar_form,
    each=[{_d: degree, _i: i} for degree in range(1, 5) for i in (0, 1)],
    method="control points as values of the polar form of any polynomial, those of the derivative as its rates, any "
    "knots, "
    "degrees 1 to 4",
)
# The example, as it is read from bsplined.4.
_DEGREE, _EXAMPLE, _KNOTS = (step.right for step in steps("bsplined.4"))


def _example(axis: int, index: int) -> Any:
    """Return the check of one line of bsplined.5, in one coordinate."""

    def difference(j: Any) -> Any:
        j = int(j)
        if not 0 <= j < len(_EXAMPLE) - 1:
            raise UndefinedError(f"P'[{j}]")
        width = _KNOTS[j + _DEGREE + 1] - _KNOTS[j + 1]
        return _DEGREE * (_EXAMPLE[j + 1][axis] - _EXAMPLE[j][axis]) / width

    where = {
        _i: sp.Integer(index),
        _d: _DEGREE,
        _P: indexed("P", {(j,): value[axis] for j, value in enumerate(_EXAMPLE)}),
        _Q: difference,
        _knot: indexed("knot", {(j,): value for j, value in enumerate(_KNOTS)}),
    }
    return identity(where=where, method="the numbers of bsplined.4 put into the difference quotients of bsplined.3")


def _lines() -> Iterator[Part]:
    """Yield each step of bsplined.5 in each coordinate."""
    for place, step in enumerate(steps("bsplined.5")):
        for axis in (0, 1):
            right = step.right[axis] if isinstance(step.right, sp.MatrixBase) else step.right
            other = sp.Eq(_Q[place // 4 + 1], right, evaluate=False)
            # The first three points of the derivative have the same x.
            same = {str(other): "both have the x 135"} if place in (0, 4) and axis == 0 else {}
            yield part(_example(axis, place // 4), replace(_of(step.left, right), equivalent=same))


# The derivative of the example: control points by differences of the numbers, and the knots without first and last.
_DERIVED = [
    [_DEGREE * (b[k] - a[k]) / (_KNOTS[j + _DEGREE + 1] - _KNOTS[j + 1]) for k in (0, 1)]
    for j, (a, b) in enumerate(pairwise(_EXAMPLE))
]
_NAMES = ("degree", "points", "x_0", "y_0", "knots", "first", "last")


def _summary(degree: Any, points: Any, knots: Any) -> Any:
    """Return what the print says of a spline, number by number."""
    return sp.ImmutableMatrix([[degree, len(points), points[0][0], points[0][1], len(knots), knots[0], knots[-1]]])


_TRUE = _summary(_DEGREE - 1, _DERIVED, _KNOTS[1:-1])
_PARAMETERS = identity(
    where={sp.Symbol(name): value for name, value in zip(_NAMES, _TRUE, strict=True)},
    method="degree, number of points and of knots, first point, first and last knot of the derivative, from the "
    "numbers of "
    "bsplined.4",
)


def _parameters(summary: Any) -> Any:
    return (_of(sp.Symbol(name), value) for name, value in zip(_NAMES, summary, strict=True))


def _drawn() -> Consequence:
    """Measure how far the curve of the parameters that are printed is from the derivative."""

    def at(points: Any, knots: Any, degree: int, t: float) -> list[float]:
        s = max(j for j in range(degree, len(points)) if knots[j] <= t)
        level = [[float(c) for c in points[j]] for j in range(s - degree, s + 1)]
        for k in range(1, degree + 1):
            for j in range(degree, k - 1, -1):
                i = s - degree + j
                share = float((t - knots[i]) / (knots[i + 1 + degree - k] - knots[i]))
                level[j] = [share * b + (1 - share) * a for a, b in zip(level[j - 1], level[j], strict=True)]
        return level[degree]

    apart = []
    for n in range(100):
        t = 3 + n / 50
        apart.append(dist(at(_EXAMPLE, list(_KNOTS), 3, t), at(_DERIVED, list(_KNOTS[1:-1]), 2, t)))
    return Consequence(
        "the example of the text: largest distance between the curve that is printed for the derivative, which is "
        "the curve "
        "itself, and the derivative",
        {"distance": max(apart)},
    )


def _sum(letter_: Any, first: int, order: Any, last: Any) -> Any:
    return sp.Sum(letter_[_i] * _N(_i + first, order, _t), (_i, 0, last))


CLAIMS = (
    fails(
        "bsplined.1",
        "With n control points, numbered from 0, the curve is the sum from 0 to n of each times its function.",
        *parts(_POINTS, *equations("bsplined.1")),
        correction=corrected("the sum ends with n - 1", part(_POINTS, _of(_C(_t), _sum(_P, 0, _k, _n - 1)))),
    ),
    fails(
        "bsplined.2",
        "The derivative is the sum from 0 to n - 1 of its control points times functions of one order less.",
        *parts(_POINTS, *equations("bsplined.2")),
        correction=corrected(
            "the sum ends with n - 2: the derivative has one control point less",
            part(_POINTS, _of(_VELOCITY, _sum(_Q, 1, _k - 1, _n - 2))),
        ),
    ),
    holds(
        "bsplined.3",
        "Its control points are steps from one control point to the next, times the degree, over the width of the "
        "knots "
        "that both share.",
        *parts(_SLOPES, *equations("bsplined.3")),
    ),
    definition("bsplined.4", "Degree, five points and nine knots of an example.", "an example"),
    holds("bsplined.5", "The four control points of its derivative.", *_lines()),
    fails(
        "bsplined.6",
        "The derivative has the degree 3, five points and nine knots.",
        *parts(_PARAMETERS, *_parameters(_summary(*(step.right for step in steps("bsplined.6"))))),
        correction=corrected(
            "degree 2, the four points of bsplined.5, and the knots without the first and the last: what is printed "
            "are "
            "the parameters of the curve itself",
            *parts(_PARAMETERS, *_parameters(_TRUE)),
        ),
        counterexample=lambda: Counterexample((("degree of the curve", "3"),), "3 for its derivative", "2"),
        consequence=_drawn,
    ),
)
