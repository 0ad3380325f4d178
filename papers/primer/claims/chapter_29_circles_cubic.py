"""Circular arcs as cubic curves."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import Digits, digits, identity
from semispline.papers.ledger import Formula, chain, corrected, formula, mutants, part, parts
from semispline.papers.primer.checks.following import of_squares, refuted_at
from semispline.papers.primer.checks.plane import along_hat, arc
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, fails, holds

_phi, _t = letter("circles_cubic.1", "\\phi"), sp.Symbol("t", real=True)
_ARC = arc(_phi)
_HALF = sp.Rational(1, 2)
# The middle of the chord, which is the foot of the middle of the curve, and the way on to the tip.
_FOOT = [(s + e) / 2 for s, e in zip(_ARC.start, _ARC.end, strict=True)]
_RATIO = along_hat(3, _t)["ratio"].subs(_t, _HALF)
_TIP = [b + (b - c) / _RATIO for b, c in zip(_ARC.middle, _FOOT, strict=True)]


def _along_tangents() -> Any:
    """Return how far control points lie along the tangents, so that the middle of the curve is that of the arc."""
    far = sp.Symbol("far")
    first, second = _ARC.start, (_ARC.end[0] + far * sp.sin(_phi),)
    middle = de_casteljau([_ARC.start[0], first[0], second[0], _ARC.end[0]], _HALF)
    found = sp.expand(middle - _ARC.middle[0])
    return -found.coeff(far, 0) / found.coeff(far, 1)


_FAR = _along_tangents()
_FIRST = (sp.Integer(1), _FAR)
_SECOND = (_ARC.end[0] + _FAR * sp.sin(_phi), _ARC.end[1] - _FAR * sp.cos(_phi))


def _meanings() -> dict[Any, Any]:
    found: dict[Any, Any] = {}
    points = {
        "S": _ARC.start, "E": _ARC.end, "C_1": _FIRST, "C_2": _SECOND, "P": _ARC.middle, "B": _ARC.middle, "C": _FOOT,
        "E'": [value.diff(_phi) for value in _ARC.end],
    }  # fmt: skip
    points["\\vec{v}"] = [a - c for a, c in zip(_TIP, _FOOT, strict=True)]
    for name, point in points.items():
        for axis, value in zip("xy", point, strict=True):
            for text in (f"{name}_{axis}", f"{name}.{axis}"):
                found[sp.Symbol(text, real=True)] = value
    found |= {sp.Symbol("C_{1x}", real=True): _FIRST[0], sp.Symbol("C_{1y}", real=True): _FIRST[1]}
    found |= {sp.Symbol("a", real=True): _FAR, sp.Symbol("b", real=True): -_FAR}
    # From the centre to the chord, and from start to guess: as far as from foot to tip.
    to_chord = (1 + sp.cos(_phi)) / (2 * sp.cos(_phi / 2))
    found[sp.Symbol("l", real=True)] = to_chord
    found[sp.Symbol("d", real=True)] = (1 - to_chord) * (1 + 1 / _RATIO)
    return found


_MEANINGS = _meanings()
_FIT = refuted_at(
    identity(
        where=_MEANINGS,
        method="control points along the tangents so far that the middle of the curve, by de Casteljau's triangle, "
        "is that "
        "of the arc; for any angle, against the print in normal form",
    ),
    {_phi: 1},
    _MEANINGS,
)
_LENGTHS = of_squares(_FIT, {_phi: 1}, _MEANINGS)


def _letter(name: str) -> Any:
    return sp.Symbol(name, real=True)


def _of(left: Any, right: Any) -> Any:
    return formula(sp.Eq(left, right, evaluate=False))


# circles_cubic.4, transcribed by hand: from foot to tip, d_2 from the foot and d_1 from the tip to the curve.
_whole, _d1, _d2 = sp.symbols("AC d_1 d_2", positive=True)
_ratio_at_half = sp.Symbol("ratio", positive=True)
_WAY = identity(
    where={_d1: _d2 / _RATIO, _whole: _d2 + _d2 / _RATIO, _ratio_at_half: _RATIO},
    method="the ratio of any cubic curve at 1/2, by de Casteljau's triangle, as abc.3 has it: from foot to curve "
    "over from "
    "curve to tip",
)
# circles_cubic.8 and circles_cubic.10, transcribed by hand.
_v, _B, _C, _E, _E1 = ([_letter(f"{name}_{axis}") for axis in "xy"] for name in ("\\vec{v}", "B", "C", "E", "E'"))
_C2 = [_letter(f"C_2_{axis}") for axis in "xy"]
_up = _letter("C_{1y}")
_tangent = sp.Rational(4, 3) * sp.tan(_phi / 4)
_squared_length = (-sp.sin(_phi)) ** 2 + sp.cos(_phi) ** 2
_speed = _letter("speed")
_AT_END = {**_MEANINGS, _speed: sp.Integer(1), **dict(zip(_C2, _SECOND, strict=True))}
_END = refuted_at(identity(where=_AT_END), {_phi: 1}, _AT_END)


def _whatever_power(step: Formula) -> Formula:
    """Say of each mutant that has but another power of the length of the tangent that it is the same."""
    same = [m.text for m in mutants(step) if m.relation.subs(_speed, 1) == step.relation.subs(_speed, 1)]
    return replace(step, equivalent=dict.fromkeys(same, "the length is 1"))


def _whatever_sign(point: Formula) -> Formula:
    """Say of each mutant that turns the sign of a coordinate that is 0 that it is the same."""
    zeros = {letter_: 0 for letter_ in point.relation.lhs.free_symbols if _QUARTER[letter_] == 0}
    same = [m.text for m in mutants(point) if m.relation.subs(zeros) == point.relation.subs(zeros)]
    return replace(point, equivalent=dict.fromkeys(same, "the coordinate is 0"))


_QUARTER = {letter_: sp.sympify(value).subs(_phi, sp.pi / 2) for letter_, value in _MEANINGS.items()}
_NO_HEIGHT = {
    f"Eq(Matrix([[C_1.x], [C_1.y]]), Matrix([[{other}]]))": "the y of S is 0"
    for other in ("     S.x], [-S.y + a", "      S.x], [2*S.y + a")
}


def _decimals() -> Any:
    """Return exact coordinates and printed ones, with the digits that are read."""
    exact, shown = [], []
    for step in steps("circles_cubic.14"):
        exact += [_QUARTER[symbol] for symbol in step.left]
        shown += [Digits(str(Decimal(int(value.p)) / Decimal(int(value.q)))) for value in step.right]
    return sp.Eq(sp.Tuple(*exact), sp.Tuple(*shown), evaluate=False)


CLAIMS = (
    definition("circles_cubic.1", "An arc of the unit circle from (1, 0) to an angle.", "both ends of the arc"),
    holds(
        "circles_cubic.2",
        "The first control point lies on the tangent at the start.",
        *parts(_FIT, *(replace(f, equivalent=_NO_HEIGHT) for f in equations("circles_cubic.2"))),
    ),
    holds(
        "circles_cubic.3",
        "The second control point lies on the tangent at the end.",
        *parts(_FIT, *equations("circles_cubic.3")),
    ),
    fails(
        "circles_cubic.4",
        "From the foot to the tip it is d_2 + d_1, and d_1 is d_2 times the ratio at 1/2, a third of d_2.",
        *parts(_WAY, *chain(_whole, _d2 + _d1, _d2 + _d2 * _ratio_at_half, sp.Rational(4, 3) * _d2)),
        correction=corrected(
            "d_1 is d_2 divided by the ratio, which is 3 there: the ratio is that of d_2 to d_1; 4/3 of d_2 is right",
            *parts(_WAY, *chain(_whole, _d2 + _d1, _d2 + _d2 / _ratio_at_half, sp.Rational(4, 3) * _d2)),
        ),
        remark="The ratio is that of abc.3 and abc.6.",
    ),
    holds(
        "circles_cubic.5",
        "The middle of the arc is at half of the angle.",
        *parts(_FIT, *equations("circles_cubic.5")),
    ),
    holds(
        "circles_cubic.6",
        "The middle of the chord, by its distance from the centre.",
        *parts(_FIT, *equations("circles_cubic.6")),
    ),
    holds(
        "circles_cubic.7",
        "From there to the middle of the arc.",
        *parts(_FIT, *equations("circles_cubic.7")),
    ),
    holds(
        "circles_cubic.8",
        "On to the tip it is 4/3 of that.",
        *parts(_FIT, *(_of(v, sp.Rational(4, 3) * (b - c)) for v, b, c in zip(_v, _B, _C, strict=True))),
    ),
    holds(
        "circles_cubic.9",
        "The first control point is (1, 4/3 of the tangent of a quarter of the angle), by the length of that vector.",
        *parts(_FIT, *equations("circles_cubic.9")[:2]),
        *parts(_LENGTHS, *equations("circles_cubic.9")[2:]),
    ),
    holds(
        "circles_cubic.10",
        "The second control point lies as far back along the tangent at the end, which has the length 1.",
        *parts(_END, _of(_E1[0], -sp.sin(_phi)), _of(_E1[1], sp.cos(_phi)), _of(sp.Integer(1), _squared_length)),
        *parts(
            _END,
            *map(
                _whatever_power,
                (
                    *chain(
                        _C2[0],
                        _E[0] - _up * _E1[0] / _speed,
                        sp.cos(_phi) + _up * sp.sin(_phi),
                        sp.cos(_phi) + _tangent * sp.sin(_phi),
                    ),
                    *chain(
                        _C2[1],
                        _E[1] - _up * _E1[1] / _speed,
                        sp.sin(_phi) - _up * sp.cos(_phi),
                        sp.sin(_phi) - _tangent * sp.cos(_phi),
                    ),
                ),
            ),
        ),
    ),
    holds(
        "circles_cubic.11",
        "The first control point.",
        *parts(_FIT, *equations("circles_cubic.11")),
    ),
    holds(
        "circles_cubic.12",
        "The second control point.",
        *parts(_FIT, *equations("circles_cubic.12")),
    ),
    holds(
        "circles_cubic.13",
        "All four points for a quarter of the circle.",
        *parts(identity(where=_QUARTER), *map(_whatever_sign, equations("circles_cubic.13"))),
    ),
    holds(
        "circles_cubic.14",
        "The same in decimals.",
        part(digits(), formula(_decimals())),
        remark="Right to the five digits shown; the text speaks of six, which would be 0.552285.",
    ),
)
