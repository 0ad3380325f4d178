"""A curve as a row of straight lines."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from semispline.papers.checks import code
from semispline.papers.ledger import Formula, formula, part, reading
from semispline.papers.primer.checks.running import by_powers, code_of, decided_elsewhere, weights_of
from semispline.papers.primer.writing import ambiguous, holds

_m, _i = sp.symbols("m i", integer=True, positive=True)
_X, _Y = (sp.Function(name, real=True) for name in "XY")


def _coordinate(name: str) -> Callable[[Any], Any]:
    """Return a coordinate of any cubic curve."""
    return lambda s: by_powers(weights_of(4, name), sp.sympify(s))


_COORDINATES = {_X: _coordinate("x"), _Y: _coordinate("y")}
_CURVE = {"curve": {"getXValue": _COORDINATES[_X], "getYValue": _COORDINATES[_Y]}}
_FROM, _AT = "curve.getXValue(0), curve.getYValue(0)", "curve.getXValue(t), curve.getYValue(t)"
_IN_PAIRS = {f"[{_FROM}]": f"[[{_FROM}]]", f"push[{_AT}]": f"push([{_AT}])"}
# How many entries there are, then one of them, and its two numbers.
_CALL = "row = flattenCurve(curve, m)\n[row.length, row[i][0], row[i][1]]"
_FLAT_CALL = "flattenCurve(curve, m).length"
_EACH = [{_m: m, _i: i} for m in (1, 2, 3, 5) for i in range(m + 1)]
_RUN = code(
    each=_EACH,
    given=_CURVE,
    where=_COORDINATES,
    method="the printed code, run for any cubic curve and 1, 2, 3 and 5 segments: entry by entry",
)


_IN_ROW = code(
    each={_m: (1, 2, 3, 5)}, given=_CURVE, method="the printed code, run for any cubic curve: how many entries"
)


def _counted() -> Formula:
    """Return that there are as many entries as points; which numbers they are is decided where they are pairs."""
    found = formula(sp.Eq(_m + 1, code_of("flattening.1", _FLAT_CALL), evaluate=False))
    return decided_elsewhere(found, "the other reading")


def _sampled() -> Formula:
    expected = sp.Tuple(_m + 1, _X(_i / _m), _Y(_i / _m))
    return formula(sp.Eq(expected, code_of("flattening.1", _CALL, _IN_PAIRS), evaluate=False))


def _lines(count: int) -> Formula:
    """Return that each line goes from a point to the next one."""
    points = weights_of(count + 1, "p")
    expected = sp.Tuple(*(p for n in range(count) for p in points[n : n + 2]))
    call = "drawn = []\nline(a, b):\n  drawn.add([a, b])\ndrawFlattenedCurve(curve, m)\ndrawn"
    return formula(sp.Eq(expected, code_of("flattening.2", call), evaluate=False))


def _drawing(count: int) -> Any:
    return code(
        given={"curve": 0, "m": count, "flattenCurve": lambda *_: weights_of(count + 1, "p")},
        method=f"the printed code, run for any {count + 1} points",
    )


CLAIMS = (
    ambiguous(
        "flattening.1",
        "Code that gives the points at equal steps of the parameter, from the first to the last one, each an entry of "
        "its own as the code for drawing takes them.",
        reading("brackets as printed: x and y by turns in one row", part(_IN_ROW, _counted())),
        reading("each pair in brackets of its own", part(_RUN, _sampled())),
        remark="Brackets are missing; the numbers are right.",
    ),
    holds(
        "flattening.2",
        "Code that draws a line from each of those points to the next one.",
        *(part(_drawing(count), _lines(count)) for count in (1, 2, 3)),
    ),
)
