"""Pulling a curve at one of its points."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from math import dist
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import identity
from semispline.papers.ledger import Consequence, corrected, formula, parts
from semispline.papers.primer.checks.plane import along_hat
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import equations, fails, holds

_t, _n = letter("moulding.2", "t"), sp.Symbol("n", integer=True)
_NAMES = ("start", "C1'", "C2'", "end", "v1", "v2", "A'", "e1", "e2")
_start, _first, _second, _end, _v1, _v2, _tip, _e1, _e2 = (letter("moulding.2", name) for name in _NAMES)
# De Casteljau's triangle of the cubic curve, level by level.
_LEVEL = [_start + _t * (_first - _start), _first + _t * (_second - _first), _second + _t * (_end - _second)]
_NEXT = [_LEVEL[0] + _t * (_LEVEL[1] - _LEVEL[0]), _LEVEL[1] + _t * (_LEVEL[2] - _LEVEL[1])]
_TRIANGLE = identity(
    where={_v1: _LEVEL[0], _tip: _LEVEL[1], _v2: _LEVEL[2], _e1: _NEXT[0], _e2: _NEXT[1]},
    method="de Casteljau's triangle of any cubic curve, against the print in normal form",
)


def _in_hat(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    values = along_hat(int(instance[_n]), _t)
    names = {"A'": "A", "B'": "B", "C": "C", "ratio": "ratio"}
    return {letter("moulding.1", ours): values[theirs] for ours, theirs in names.items()}


def _of(left: Any, right: Any) -> Any:
    return formula(sp.Eq(left, right, evaluate=False))


def _pulled() -> Consequence:
    """Pull the middle of a curve and see how far from there the new curve passes."""
    curve, t, pull = [(0, 0), (20, 100), (110, 90), (150, 0)], 0.5, (10, 30)
    lines = list(zip(*curve, strict=True))
    printed, right = [], []
    goal = [
        float(de_casteljau([sp.Integer(c) for c in line], sp.Rational(1, 2))) + p
        for line, p in zip(lines, pull, strict=True)
    ]
    for line, p in zip(lines, pull, strict=True):
        level = [a + t * (b - a) for a, b in pairwise(line)]
        e1, e2 = (a + t * (b - a) + p for a, b in pairwise(level))
        # The ratio of a cubic curve in the middle is 3.
        b = e1 + t * (e2 - e1)
        tip = b + (b - (line[0] + line[-1]) / 2) / 3
        v1, v2 = e1 - (e1 - tip) / t, e2 + (e2 - tip) / (1 - t)
        printed.append((line[0], v1 + (v1 - line[0]) / t, v2 + (v2 - line[-1]) / (1 - t), line[-1]))
        v1, v2 = tip - (tip - e1) / (1 - t), tip + (e2 - tip) / t
        right.append((line[0], line[0] + (v1 - line[0]) / t, line[-1] + (v2 - line[-1]) / (1 - t), line[-1]))
    missed, met = (dist(goal, [(a + 3 * b + 3 * c + d) / 8 for a, b, c, d in ways]) for ways in (printed, right))
    return Consequence(
        "a cubic curve 150 wide, its middle pulled by (10, 30): how far the new curve passes from there",
        {"distance": missed},
        {"distance": met},
        rounding=1e-9,
    )


CLAIMS = (
    holds(
        "moulding.1",
        "The new tip lies beyond the new point by the way from the foot to it, divided by the ratio.",
        *parts(
            identity(
                where=_in_hat,
                each={_n: (2, 3)},
                complete=True,
                method="tip, point, foot and ratio of any curve of degree n, against the print in normal form",
            ),
            *equations("moulding.1"),
        ),
        remark="At either end of the curve the ratio is 0, and nothing is said of the tip.",
    ),
    fails(
        "moulding.2",
        "The points one level up are found by going from the ends of the strut away from the tip.",
        *parts(_TRIANGLE, *equations("moulding.2", None, _t > 0, _t < 1)),
        correction=corrected(
            "v1 lies on the line from A' through e1, at the way from A' to e1 divided by 1 - t; v2 on that through e2, "
            "at the way divided by t",
            *parts(
                _TRIANGLE,
                _of(_v1, _tip - (_tip - _e1) / (1 - _t)),
                _of(_v2, _tip + (_e2 - _tip) / _t),
            ),
        ),
        consequence=_pulled,
    ),
    fails(
        "moulding.3",
        "The control points are found by going on from v1 and v2.",
        *parts(_TRIANGLE, *equations("moulding.3", None, _t > 0, _t < 1)),
        correction=corrected(
            "the ways begin at the ends of the curve, not at v1 and v2",
            *parts(
                _TRIANGLE,
                _of(_first, _start + (_v1 - _start) / _t),
                _of(_second, _end + (_v2 - _end) / (1 - _t)),
            ),
        ),
        consequence=_pulled,
    ),
)
