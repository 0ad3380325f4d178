"""Where two lines cross."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks import code
from semispline.papers.ledger import Formula, formula, part
from semispline.papers.primer.checks.running import code_of, decided_elsewhere, open_is_false
from semispline.papers.primer.writing import holds

_NAMES = ("x1", "y1", "x2", "y2", "x3", "y3", "x4", "y4")
_x1, _y1, _x2, _y2, _x3, _y3, _x4, _y4 = _LETTERS = sp.symbols(_NAMES, real=True)
_m, _answer = sp.symbols("m answer", real=True)


def _crossing() -> Any:
    """Return the point of the first line whose cross product with the second one is that of the second one's start."""
    along, other = (_x2 - _x1, _y2 - _y1), (_x4 - _x3, _y4 - _y3)
    far = ((_x3 - _x1) * other[1] - (_y3 - _y1) * other[0]) / (along[0] * other[1] - along[1] * other[0])
    return sp.Tuple(_x1 + far * along[0], _y1 + far * along[1])


# Lines in general position, others with a coordinate in common, and ends in either order.
_PLACES = [
    (0, 0, 2, 2, 0, 2, 2, 0), (1, 2, 4, 3, 5, -1, 2, 7), (3, 1, -2, 5, 0, 0, 7, 2), (0, 0, 1, 0, 3, -1, 3, 4),
    (2, -3, 5, 8, 4, 4, -1, 1), (7, 1, 1, 2, -2, -5, 3, 9), (1, 1, 1, 6, -4, 2, 8, 5), (5, 3, 2, 3, 0, 1, 9, 7),
]  # fmt: skip
_PARALLEL = [(0, 0, 2, 2, 1, 1, 2, 2), (1, 2, 4, 3, 0, 0, 6, 2), (0, 1, 0, 5, 3, 2, 3, 7)]


def _each(places: Any) -> list[Mapping[Any, int]]:
    return [dict(zip(_LETTERS, place, strict=True)) for place in places]


_CALL = f"lli8({', '.join(_NAMES)})"
# From the first point the second line is at this step of 1 along and m up: (step + x1 - x3)(m + 1) = m step + y1 - y3.
_far = (_x3 - _x1) * (_m + 1) - (_y3 - _y1)
_WHETHER = f"found = 1\nif ({_CALL} == false):\n  found = 1\nelse:\n  found = 0\nfound"

# Whether lines are parallel shows where they are.
_CROSSED = "line 5, column 8: 1 for 0"


def _compared(expected: Any, call: str) -> Formula:
    """Return that the code gives something; which of its changes do not show there is left to the other lines."""
    found = formula(sp.Eq(expected, code_of("intersections.1", call), evaluate=False))
    return decided_elsewhere(found, "the other lines that the code is run for", *([_CROSSED] if call == _CALL else []))


CLAIMS = (
    holds(
        "intersections.1",
        "The point where two lines cross that are given by two points each, and nothing where they are parallel.",
        part(
            code(
                each=_each(_PLACES),
                method="the printed code, run exactly, for eight pairs of lines, against the crossing",
            ),
            _compared(_crossing(), _CALL),
        ),
        part(
            open_is_false(
                code(
                    method="the printed code, run exactly, for lines through any two points, one of any slope, the "
                    "other "
                    "steeper by 1"
                )
            ),
            _compared(
                sp.Tuple(_x1 + _far, _y1 + _m * _far),
                "lli8(x1, y1, x1 + 1, y1 + m, x3, y3, x3 + 1, y3 + m + 1)",
            ),
        ),
        part(
            code(
                each=_each(_PARALLEL),
                where={_answer: sp.Integer(1)},
                method="the printed code, run exactly, for three pairs of parallel lines: 1 where it finds no crossing",
            ),
            _compared(_answer, _WHETHER),
        ),
        remark="= in the condition compares.",
    ),
)
