"""Curves at a distance from a curve."""

from __future__ import annotations

from math import hypot
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, corrected, formula, part
from semispline.papers.primer.checks.lengths import length_between
from semispline.papers.primer.writing import definition, fails, holds, not_checkable

_t, _a, _b = sp.symbols("t a b", real=True)
_length, _speed = sp.symbols("length speed", real=True)
_f = [sp.Function(name, real=True) for name in ("f_x", "f_y")]
_B = [sp.Function(name, real=True) for name in ("B_x", "B_y")]


def _integral(functions: list[Any], order: int, start: Any, end: Any) -> Any:
    """Return the integrals of this chapter, transcribed by hand: the print leaves out their differential."""
    squares = sum(sp.Derivative(function(_t), (_t, order)) ** 2 for function in functions)
    return sp.Integral(sp.sqrt(squares), (_t, start, end))


def _quadratics() -> dict[Any, Any]:
    """Return any curve of degree 2, and the length of its derivative."""
    ways = [[sp.Symbol(f"{axis}_{i}", real=True) for i in range(3)] for axis in "xy"]
    speed = sp.sqrt(sum((way[1] + 2 * way[2] * _t) ** 2 for way in ways))
    curve = {
        function: lambda at, way=way: way[0] + way[1] * at + way[2] * at**2
        for function, way in zip(_B, ways, strict=True)
    }
    return {**curve, _speed: speed}


_QUADRATIC = identity(
    where=_quadratics(),
    method="the length of the vector that is the derivative of any curve of degree 2, against the print",
)


def _offset() -> Consequence:
    """Measure how far from a curve its offset lies whose normals are divided by the printed length."""
    xs, ys, d = (0, 60, 120), (0, 90, 0), 10
    acceleration = hypot(*(2 * (w[2] - 2 * w[1] + w[0]) for w in (xs, ys)))
    distances = []
    for n in range(101):
        t = n / 100
        speed = hypot(*(2 * ((1 - t) * (w[1] - w[0]) + t * (w[2] - w[1])) for w in (xs, ys)))
        distances.append(d * speed / acceleration)
    return Consequence(
        "a parabola 120 wide and 45 high, offset by 10, normals divided by what is printed for their length",
        {"smallest distance": min(distances), "largest distance": max(distances)},
        {"smallest distance": float(d), "largest distance": float(d)},
    )


CLAIMS = (
    not_checkable(
        "offsetting.1",
        "The offset is the curve plus a number.",
        "a point plus a number has no meaning, and the text takes this back in its next sentence",
    ),
    definition("offsetting.2", "The offset is the curve plus a distance times the normal.", "the offset of a curve"),
    definition(
        "offsetting.3",
        "The normal is at a right angle to the derivative divided by its length.",
        "the normal",
        "That it has the length 1 is said beside it; being at a right angle to a vector of length 1 does not say so.",
    ),
    holds(
        "offsetting.4",
        "The length of a curve between two parameters is the integral of the root of both squared derivatives.",
        part(
            length_between(_f[0], _f[1], _a, _b),
            formula(sp.Eq(_length, _integral(_f, 1, _a, _b), evaluate=False)),
        ),
    ),
    fails(
        "offsetting.5",
        "The length of the derivative at a parameter is the integral from 0 to 1 of the root of both squared second "
        "derivatives.",
        part(_QUADRATIC, formula(sp.Eq(_speed, _integral(_B, 2, 0, 1), evaluate=False), _t >= 0, _t <= 1)),
        correction=corrected(
            "the length of a vector is the root of its squared coordinates, without any integral: what is printed is "
            "the "
            "length of the curve that the derivative runs through",
            part(
                _QUADRATIC,
                formula(
                    sp.Eq(
                        _speed,
                        sp.sqrt(sum(sp.Derivative(function(_t), _t) ** 2 for function in _B)),
                        evaluate=False,
                    )
                ),
            ),
        ),
        consequence=_offset,
        remark="That an offset is no Bezier curve in general stays true, by the same root.",
    ),
)
