"""Circular arcs as quadratic curves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import Digits, digits, identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.checks.following import of_changed, of_squares, positive_at, refuted_at
from semispline.papers.primer.checks.plane import arc
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, holds

_phi, _epsilon = letter("circles.1", "\\phi"), letter("circles.11", "\\epsilon")
_ARC = arc(_phi)
# Where the tangents at both ends meet: (1, a), and at the same time end + b (-sin, cos).
_CORNER = _ARC.corner
_MIDDLE = [de_casteljau(list(way), sp.Rational(1, 2)) for way in zip(_ARC.start, _CORNER, _ARC.end, strict=True)]
_APART = [of_curve - on_arc for of_curve, on_arc in zip(_MIDDLE, _ARC.middle, strict=True)]


def _meanings() -> dict[Any, Any]:
    found = {letter("circles.2", "a"): _ARC.along_start, letter("circles.2", "b"): _ARC.along_end}
    for name, point in (("C", _CORNER), ("T", _MIDDLE), ("P", _ARC.middle)):
        for axis, value in zip("xy", point, strict=True):
            found[sp.Symbol(f"{name}_{axis}", real=True)] = value
    for name, point in (("S", _ARC.start), ("E", _ARC.end), ("C", _CORNER), ("T", _MIDDLE)):
        for axis, value in zip("xy", point, strict=True):
            found[sp.Symbol(f"{name}.{axis}", real=True)] = value
    for axis, value in zip("xy", _APART, strict=True):
        found[sp.Function(f"d_{axis}(\\phi)", real=True)(_phi)] = value
    return found


_FIT = refuted_at(
    identity(
        where=_meanings(),
        method="the tangents at both ends of the arc, their crossing, the middle of the curve by de Casteljau's "
        "triangle, "
        "the middle of the arc on the bisector, for any angle, against the print in normal form",
    ),
    {_phi: 1},
    _meanings(),
)
_MIDDLES = identity(
    where={
        sp.Symbol(f"T.{axis}", real=True): de_casteljau(
            [sp.Symbol(f"{name}.{axis}", real=True) for name in "SCE"], sp.Rational(1, 2)
        )
        for axis in "xy"
    }
)
_DISTANCE = sp.Function("d(\\phi)", real=True)(_phi)
_WITH_DISTANCE = {**_meanings(), _DISTANCE: sp.sqrt(_APART[0] ** 2 + _APART[1] ** 2)}
_FAR = refuted_at(identity(where=_WITH_DISTANCE), {_phi: 1}, _WITH_DISTANCE)


def _at_error(relation: Any) -> Any:
    """Return that the error at the printed angle is the given one.

    With c the cosine of half of the angle the middle of the curve is (1 + c^2)/(2 c) from the centre: 1/c is the way to
    the crossing of the tangents, c that to the chord.
    """
    quarter = sp.cos(relation.rhs / 4)
    c = 2 * quarter**2 - 1
    return sp.Eq(_epsilon, (1 + c**2) / (2 * c) - 1, evaluate=False)


_ANGLE = steps("circles.11")[0].right
# As the words below the display give them.
_ANGLES = {"0.1": "1.748", "0.01": "1.038", "0.001": "0.594", "0.0001": "0.3356"}
_AT_ERRORS = sp.Tuple(*(_ANGLE.subs(_epsilon, sp.Rational(error)) for error in _ANGLES))
_PRINTED_ANGLES = sp.Tuple(*map(Digits, _ANGLES.values()))
# S has the y 0.
_NO_HEIGHT: tuple[dict[str, str], ...] = (
    {
        f"Eq(Matrix([[C.x], [C.y]]), Matrix([[{other}]]))": "the y of S is 0"
        for other in ("     S.x], [-S.y + a", "      S.x], [2*S.y + a")
    },
    {},
)
_PRINTED_DISTANCES = equations("circles.10")

CLAIMS = (
    definition("circles.1", "An arc of the unit circle from (1, 0) to an angle.", "both ends of the arc"),
    holds(
        "circles.2",
        "The control point lies on the tangents at both ends: a along the one, b along the other.",
        *parts(
            _FIT, *(replace(f, equivalent=same) for f, same in zip(equations("circles.2"), _NO_HEIGHT, strict=True))
        ),
    ),
    holds(
        "circles.3",
        "The same by coordinates.",
        *parts(_FIT, *equations("circles.3")),
    ),
    holds(
        "circles.4",
        "The first of them, solved for b step by step.",
        *parts(_FIT, *equations("circles.4")),
    ),
    holds(
        "circles.5",
        "b is (cos - 1) over sin.",
        *parts(_FIT, *equations("circles.5")),
        remark="For angles between 0 and a half turn: at either end the tangents do not meet.",
    ),
    holds(
        "circles.6",
        "a, with b put in, is (1 - cos) over sin.",
        *parts(_FIT, *equations("circles.6")),
    ),
    holds(
        "circles.7",
        "The middle of the arc is at half of the angle.",
        *parts(_FIT, *equations("circles.7")),
    ),
    holds(
        "circles.8",
        "The middle of the curve is a quarter of the start, half of the control point and a quarter of the end.",
        *parts(_MIDDLES, *equations("circles.8")),
    ),
    holds(
        "circles.9",
        "Its coordinates.",
        *parts(_FIT, *equations("circles.9")),
    ),
    holds(
        "circles.10",
        "How far the middles of curve and arc are apart, by coordinates and as a distance.",
        *parts(_FIT, *_PRINTED_DISTANCES[:-2]),
        *parts(of_squares(_FAR, {_phi: 1}, _meanings()), *_PRINTED_DISTANCES[-2:]),
    ),
    holds(
        "circles.11",
        "The angle at which the error has a given size.",
        *parts(
            positive_at(
                of_changed(
                    identity(), _at_error, "how far the middle of the curve is from the circle at the printed angle"
                ),
                {_epsilon: sp.Rational(1, 10)},
            ),
            *equations("circles.11"),
        ),
        part(digits(), formula(sp.Eq(_AT_ERRORS, _PRINTED_ANGLES, evaluate=False))),
        remark="With the angles that the text goes on to give for the errors 0.1, 0.01, 0.001 and 0.0001.",
    ),
)
