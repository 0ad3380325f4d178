"""A curve cut in two."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks import code
from semispline.papers.ledger import formula, part
from semispline.papers.primer.checks.curves import ORDERS
from semispline.papers.primer.checks.running import by_powers, code_of, weights_of
from semispline.papers.primer.writing import holds

_n = sp.Symbol("n", integer=True, nonnegative=True)
_s, _t = sp.symbols("s t", real=True)
_curve = sp.Function("curve", real=True)
# How many points each part has, and its point at s.
_CALL = """\
draw(p):
  p = 0
at(weights):
  a = 0
  for(i=0; i<weights.length; i++):
    a += share(i) * weights[i]
  return a
drawCurve(points, t)
[left.length, right.length, at(left), at(right)]"""


def _given(instance: Mapping[Any, Any]) -> Mapping[str, Any]:
    n = int(instance[_n])

    def share(i: Any) -> Any:
        return sp.binomial(n, int(i)) * (1 - _s) ** (n - int(i)) * _s ** int(i)

    return {"points": weights_of(n + 1), "share": share}


def _found(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    return {_curve: lambda at: by_powers(weights_of(int(instance[_n]) + 1), at)}


CLAIMS = (
    holds(
        "splitting.1",
        "Code that collects the points of both parts: each part has as many as the curve, and runs along it.",
        part(
            code(
                each={_n: (0, *ORDERS)},
                given=_given,
                where=_found,
                method="the printed code, run for any points and parameter, orders 0 to 4: the point of each part at "
                "s, as the sum of its terms, against that of the curve",
            ),
            formula(
                sp.Eq(
                    sp.Tuple(_n + 1, _n + 1, _curve(_s * _t), _curve(1 - _s * (1 - _t))),
                    code_of("splitting.1", _CALL),
                    evaluate=False,
                )
            ),
        ),
        remark="The second part is collected from the end of the curve backwards.",
    ),
)
