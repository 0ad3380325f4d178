"""The derivative of a curve, which is a curve of one order less."""

from __future__ import annotations

from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.checks.curves import ORDERS, basis, curve_of
from semispline.papers.primer.checks.general import in_general
from semispline.papers.primer.printed import letter, steps
from semispline.papers.primer.writing import definition, equations, holds

_n, _k, _t = (letter("derivatives.3", name) for name in ("n", "k", "t"))
_w, _b = (sp.IndexedBase(f"{name}_i", real=True) for name in "wb")
_B = sp.Function("B_{n,k}(t)", real=True)
_CURVE = sp.Function("Bézier(n,t)", real=True)
# The index k of a whole curve says nothing: its sum runs over all of them.
_WHOLE = {"Bézier_{n,k}(t)": lambda n, _k, t: _CURVE(n, t)}
_EACH = {_n: ORDERS}


def _known(weights: Any) -> dict[Any, Any]:
    """Return what the letters stand for in a curve with these weights."""
    curve = curve_of(lambda i: weights[i])
    return {
        _B: lambda n, k, t: basis(int(n), int(k), t),
        _CURVE: curve,
        sp.Function("Bézier(n,t)_i", real=True): lambda i, n, t: basis(int(n), int(i), t),
    }


_SUMS = identity(where=_known(_w), each=_EACH)
# A function of any order, from what the text says of it in explanation.9.
_ANY = {_B: lambda n, k, t: sp.factorial(n) / (sp.factorial(k) * sp.factorial(n - k)) * t**k * (1 - t) ** (n - k)}
_GENERAL = in_general(_ANY, {_n: 2, _k: 1}, {_n: 4, _k: 1}, {_n: 5, _k: 3})
_ENDS = "Where k is 0 or n the term with the factorial of -1, or with k = n as an index of order n - 1, is none."

# derivatives.8 to .11, transcribed by hand: the dots stand for what comes between the first rows and the last.
_DERIVATIVE = sp.Derivative(_CURVE(_n, _t), _t)
_LOWER = _B(_n - 1, _k, _t)
_WEIGHTED = sp.Eq(_CURVE(_n, _t), sp.Sum(_B(_n, _k, _t) * _w[_k], (_k, 0, _n)), evaluate=False)
_ROWS = sp.Sum(_n * (_B(_n - 1, _k - 1, _t) - _LOWER) * _w[_k], (_k, 0, _n))
_BESIDE = sp.Sum(_n * _LOWER * _w[_k + 1] - _n * _LOWER * _w[_k], (_k, 0, _n - 1))
_FALLING = _n * _B(_n - 1, -1, _t) * _w[0], _n * _B(_n - 1, _n, _t) * _w[_n]
_TOGETHER = sp.Sum(_n * _LOWER * (_w[_k + 1] - _w[_k]), (_k, 0, _n - 1))

_POINTS = [letter("derivatives.15", name) for name in "ABCD"]
_LISTS = [list(step.right) for step in steps("derivatives.15") if isinstance(step.left, sp.Tuple)]
_NAMES = [list(step.left) for step in steps("derivatives.15") if isinstance(step.left, sp.Tuple)]


def _mixed(points: list[Any]) -> Any:
    return sp.Add(*(point * basis(len(points) - 1, i, _t) for i, point in enumerate(points)))


def _sum(right: Any) -> Any:
    return formula(sp.Eq(_DERIVATIVE, right, evaluate=False))


CLAIMS = (
    holds(
        "derivatives.1",
        "The derivative of a curve of order n is n times the curve of order n - 1 with the differences of its weights.",
        *parts(identity(where=_known(_b), each=_EACH), *equations("derivatives.1")),
        remark="For all orders it follows from derivatives.7, which is decided for all of them.",
    ),
    holds(
        "derivatives.2",
        "The same with n within the sum.",
        *parts(_SUMS, *equations("derivatives.2")),
    ),
    holds(
        "derivatives.3",
        "The derivative of a single function, with what the function is.",
        *parts(identity(where=_known(_w), each={_n: ORDERS[1:], _k: (0, 1)}), *equations("derivatives.3")),
    ),
    holds(
        "derivatives.4",
        "That derivative by the rules for products and powers.",
        *parts(_GENERAL, *equations("derivatives.4")),
    ),
    holds(
        "derivatives.5",
        "The binomial as factorials, in both terms.",
        *parts(_GENERAL, *equations("derivatives.5")),
    ),
    holds(
        "derivatives.6",
        "The factorials with k and n - k cancelled, n before the bracket, and all of it in n - 1 and k - 1.",
        *parts(_GENERAL, *equations("derivatives.6")),
        remark=_ENDS,
    ),
    holds(
        "derivatives.7",
        "n times the difference of two functions of order n - 1.",
        *parts(_GENERAL, *equations("derivatives.7")),
        remark=_ENDS,
    ),
    holds(
        "derivatives.8",
        "The curve as the sum of its weighted functions, and its derivative as the sum of the weighted differences.",
        part(_SUMS, formula(_WEIGHTED)),
        part(_SUMS, _sum(_ROWS)),
    ),
    holds(
        "derivatives.9",
        "The same, with both terms of each function beside each other.",
        # The functions are letters here: nothing is used of them.
        part(identity(each=_EACH), formula(sp.Eq(_ROWS, _FALLING[0] + _BESIDE - _FALLING[1], evaluate=False))),
    ),
    holds(
        "derivatives.10",
        "The first and the last term are nothing, and are left out.",
        part(_SUMS, _sum(_BESIDE)),
    ),
    holds(
        "derivatives.11",
        "Both terms of each function put together.",
        part(_SUMS, _sum(_TOGETHER)),
    ),
    holds(
        "derivatives.12",
        "The same as a sum, and with n as part of the weights.",
        *parts(_SUMS, *equations("derivatives.12", _WHOLE)),
    ),
    definition(
        "derivatives.13",
        "The sum over i from 0 to n of binomial, power of 1 - t, power of t and the weight i.",
        "the curve of order n with its weights, once more",
    ),
    holds(
        "derivatives.14",
        "Its derivative: the same of order k = n - 1 with the weights n (w_{i+1} - w_i).",
        *parts(_SUMS, *equations("derivatives.14")),
    ),
    holds(
        "derivatives.15",
        "A cubic curve with points A to D: the points of its first, second and third derivative.",
        *(
            part(identity(), formula(sp.Eq(_mixed(before).diff(_t), _mixed(after), evaluate=False)))
            for before, after in zip([_POINTS, *_NAMES[:-1]], _LISTS, strict=True)
        ),
        remark="n stands for the factor of the row, which is the order of the curve that is derived. The text "
        "behind it says that a cubic curve has no third derivative; it has the constant one that is shown here.",
    ),
)
