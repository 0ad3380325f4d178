"""Frames along a curve in space."""

from __future__ import annotations

from fractions import Fraction

import sympy as sp

from semispline.papers.checks import code
from semispline.papers.ledger import Formula, corrected, formula, part
from semispline.papers.primer.checks.running import code_of, decided_elsewhere
from semispline.papers.primer.writing import definition, fails

_steps, _j = sp.symbols("steps j", integer=True, positive=True)
_Vector = list[Fraction]


def _speed(s: Fraction) -> Fraction:
    return 1 + s**2 + (1 - s) ** 2 + 4 * s**2


def _derivative(s: Fraction) -> _Vector:
    """Return that of a curve whose speed is a polynomial: made of 1, s, 1 - s and 2 s as a rotation is."""
    u, v, p, q = Fraction(1), s, 1 - s, 2 * s
    return [u**2 + v**2 - p**2 - q**2, 2 * (u * q + v * p), 2 * (v * q - u * p)]


def _tangent(s: Fraction) -> _Vector:
    return [x / _speed(s) for x in _derivative(s)]


def _point(s: Fraction) -> _Vector:
    """Return the integral of the derivative from 0."""
    # 1 + s^2 - (1 - s)^2 - 4 s^2, 4 s + 2 s (1 - s), 4 s^2 - 2 (1 - s).
    return [s**2 - Fraction(4, 3) * s**3, 3 * s**2 - Fraction(2, 3) * s**3, Fraction(4, 3) * s**3 - 2 * s + s**2]


def _first(s: Fraction) -> dict[str, _Vector]:
    """Return a frame, which fits the curve at 0: the tangent is (0, 0, -1) there."""
    axis = [Fraction(3, 5), Fraction(4, 5), Fraction(0)]
    return {"o": _point(s), "t": _tangent(s), "r": axis, "n": [-axis[1], axis[0], Fraction(0)]}


_GIVEN = {"getPoint": _point, "getDerivative": _derivative, "getTangent": _tangent, "getFrenetFrame": _first}
_EACH = [{_steps: steps, _j: j} for steps in (1, 2, 3) for j in range(1, steps + 1)]
_RUN = code(
    each=_EACH,
    given=_GIVEN,
    method="the printed code, run along a cubic curve of rational speed in 1, 2 and 3 steps, frame by frame: how many "
    "frames, lengths and products of tangent, axis and normal, and whether the axis is the one before turned by the "
    "two reflections",
)
# The tangents that are known go into the last three: the code could have made others.
_CALL = """\
all = generateRMFrames(steps)
f = all[j]
g = all[j - 1]
tangent = getTangent(j / steps)
a = getPoint(j / steps) - getPoint((j - 1) / steps)
b = tangent - (g.t - (2 * (a · (g.t)) / (a · a)) * a)
once = g.r - (2 * (a · (g.r)) / (a · a)) * a
twice = once - (2 * (b · once) / (b · b)) * b
[all.length, f.t · tangent, (f.r) · (f.r), (f.n) · (f.n),
 (f.r) · tangent, (f.n) · tangent, (f.n) · (f.r), (f.r) · twice]"""


def _frames(instead: dict[str, str] | None = None) -> Formula:
    expected = sp.Tuple(_steps + 1, 1, 1, 1, 0, 0, 0, 1)
    return formula(sp.Eq(expected, code_of("pointvectors3d.2", _CALL, instead), evaluate=False))


CLAIMS = (
    definition(
        "pointvectors3d.1",
        "A frame has the point of the curve, the tangent, the axis of rotation and the normal.",
        "the fields of a frame",
    ),
    fails(
        "pointvectors3d.2",
        "Code for frames along a curve, each made of the one before by two reflections: tangent, axis and normal have "
        "length 1 and are at right angles to each other.",
        part(_RUN, decided_elsewhere(_frames(), "the same lines with that put right", "")),
        correction=corrected(
            "the tangent of the next frame is the derivative at t1, brought to length 1",
            part(_RUN, _frames({"getDerivative(t)": "getTangent(t1)"})),
        ),
        remark="t has no value. With the derivative at t1 as it is, whose length is not that of the tangent before, "
        "the second reflection does not bring one to the other. With decimals such as 0.1, which a computer rounds, "
        "the sum of the steps may stay below 1, and the code goes one frame too far.",
    ),
)
