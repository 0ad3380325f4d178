"""A point of a curve by mixing its points again and again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks import code
from semispline.papers.ledger import Formula, formula, part
from semispline.papers.primer.checks.curves import ORDERS
from semispline.papers.primer.checks.running import by_powers, code_of, weights_of
from semispline.papers.primer.writing import holds

_n = sp.Symbol("n", integer=True, nonnegative=True)
_t, _x, _y = sp.symbols("t x y", real=True)
# What is drawn, and nothing else.
_CALL = "drawn = []\ndraw(p):\n  drawn.add(p)\ndrawCurve(points, t)\ndrawn"


def _given_numbers(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    return {"points": weights_of(int(instance[_n]) + 1, "x")}


def _given_pairs(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    ways = (weights_of(int(instance[_n]) + 1, name) for name in "xy")
    return {"points": [{"x": x, "y": y} for x, y in zip(*ways, strict=True)]}


def _found(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    return {letter: by_powers(weights_of(int(instance[_n]) + 1, str(letter)), _t) for letter in (_x, _y)}


def _drawn(identifier: str, *values: Any) -> Formula:
    """Return that code draws these coordinates; `t` is a letter of the formula although it is in their meaning only."""
    relation = sp.Eq(sp.Tuple(*values), code_of(identifier, _CALL), evaluate=False)
    return formula(relation, sp.Ge(_t, 0))


_METHOD = "the printed code, run for any points and parameter, orders 0 to 4, against the sum of the terms"

CLAIMS = (
    holds(
        "decasteljau.1",
        "Code that draws the point of a curve at a parameter, for points that can be added.",
        part(
            code(each={_n: (0, *ORDERS)}, given=_given_numbers, where=_found, method=_METHOD),
            _drawn("decasteljau.1", _x),
        ),
    ),
    holds(
        "decasteljau.2",
        "The same for points with two coordinates.",
        part(
            code(each={_n: (0, *ORDERS)}, given=_given_pairs, where=_found, method=_METHOD),
            _drawn("decasteljau.2", _x, _y),
        ),
    ),
)
