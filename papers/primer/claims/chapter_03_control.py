"""Weights: the coordinates of the points that a curve is made of."""

from __future__ import annotations

from collections.abc import Mapping
from math import comb
from typing import Any

import sympy as sp

from semispline.derivations.bezier import de_casteljau
from semispline.papers.checks import code, identity
from semispline.papers.ledger import Consequence, Formula, corrected, formula, part, parts
from semispline.papers.primer.checks.curves import ORDERS, greatest_distance
from semispline.papers.primer.checks.running import code_of, weights_of
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import definition, equations, fails, holds

# The curve that begins at (120, 160) and ends at (220, 40), in the words of the text.
_POINTS = {"x": (120, 35, 220, 220), "y": (160, 200, 260, 40)}
_t = letter("control.2", "t")

_n = letter("control.1", "n")
_SUM = equations("control.1")[0].relation.rhs
_WEIGHT = {sp.IndexedBase("w_i", real=True): lambda i: sp.Symbol(f"w{i}", real=True)}


def _given(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    return {"w": weights_of(int(instance[_n]) + 1), "binomial": lambda n, k: comb(int(n), int(k))}


def _is_sum(identifier: str, **more: Any) -> Formula:
    return formula(sp.Eq(_SUM, code_of(identifier, "Bezier(n, t, w)", **more), evaluate=False))


_RUN = code(each={_n: (0, *ORDERS)}, given=_given, where=_WEIGHT)


def _pulled_to_zero() -> Consequence:
    """Measure the curve of control.2 without its last term."""
    whole = list(zip(_POINTS["x"], _POINTS["y"], strict=True))
    return Consequence(
        "the cubic curve of control.2, from (120, 160) to (220, 40), at 101 parameters",
        {"greatest distance": greatest_distance([*whole[:-1], (0, 0)], whole)},
    )


CLAIMS = (
    definition(
        "control.1",
        "The sum over i from 0 to n of binomial, power of 1 - t, power of t and the weight i.",
        "the curve of order n with its weights",
    ),
    holds(
        "control.2",
        "The cubic curve with the points (120, 160), (35, 200), (220, 260) and (220, 40), coordinate by coordinate.",
        *parts(
            identity(
                where={sp.Symbol(k, real=True): de_casteljau(list(map(sp.Integer, v)), _t) for k, v in _POINTS.items()}
            ),
            *equations("control.2"),
        ),
    ),
    fails(
        "control.3",
        "Code for the sum with weights.",
        part(_RUN, _is_sum("control.3")),
        correction=corrected(
            "the loop goes on while k <= n", part(_RUN, _is_sum("control.3", instead={"k<n": "k<=n"}))
        ),
        consequence=_pulled_to_zero,
    ),
    holds(
        "control.4",
        "Code for the orders 2 and 3 with weights, without a loop.",
        part(code(each={_n: (2, 3)}, given=_given, where=_WEIGHT, complete=True), _is_sum("control.4")),
    ),
)
