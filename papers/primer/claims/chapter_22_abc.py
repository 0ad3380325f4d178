"""The tip, the point and the foot: what is fixed about them at a parameter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import formula, part, parts
from semispline.papers.primer.checks.following import of_changed, of_squares
from semispline.papers.primer.checks.plane import Hat, along_hat, any_points, hat
from semispline.papers.primer.printed import letter
from semispline.papers.primer.writing import equations, holds

_t = letter("abc.2", "t")
_n = sp.Symbol("n", integer=True)
_HATS = {degree: hat(any_points(degree + 1), _t) for degree in (2, 3)}
_BOTH = {_n: (2, 3)}
_CROSSING = "the line from A through B crosses that from start to end, any control points, n the degree"


def _function(name: str) -> Any:
    return sp.Function(name, real=True)(_t)


def _distance_from(found: Hat) -> Any:
    at = {letter("abc.3", "A"): found.tip, letter("abc.3", "B"): found.point, letter("abc.3", "C"): found.foot}

    def distance(one: Any, other: Any) -> Any:
        return sp.sqrt(sum((a - b) ** 2 for a, b in zip(at[one], at[other], strict=True)))

    return distance


def _in_foot(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    found = _HATS[int(instance[_n])]
    values = {"C": found.foot[0], "P_{start}": found.start[0], "P_{end}": found.end[0]}
    return {letter("abc.1", name): value for name, value in values.items()} | {letter("abc.1", "u"): found.share}


def _distances(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    degree = int(instance[_n])
    constant = along_hat(degree, _t)["ratio"]
    return {
        sp.Function("distance(A,B)", real=True): _distance_from(_HATS[degree]),
        _function("ratio(t)"): constant,
        letter("abc.3", "Constant"): constant,
    }


def _sides(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    values = along_hat(int(instance[_n]), _t)
    return {letter("abc.4", name): values[name] for name in "ABC"} | {_function("ratio(t)"): values["ratio"]}


def _squares(relation: Any) -> Any:
    return sp.Eq(relation.lhs**2, relation.rhs**2, evaluate=False)


def _ratio(degree: int, name: str) -> Any:
    where = {_function(f"ratio(t)_{{{name}}}"): along_hat(degree, _t)["ratio"]}
    return of_squares(identity(where=where), {_t: sp.Rational(1, 2)})


_QUADRATIC, _CUBIC = equations("abc.2")

CLAIMS = (
    holds(
        "abc.1",
        "The foot C lies on the line from start to end, at a place that depends on the parameter alone.",
        *parts(identity(where=_in_foot, each=_BOTH, complete=True, method=_CROSSING), *equations("abc.1")),
        remark="Which place is decided by abc.2.",
    ),
    holds(
        "abc.2",
        "The share of the start in C is (1 - t)^2 over t^2 + (1 - t)^2, for cubic curves the same with cubes.",
        part(identity(where={_function("u(t)_{quadratic}"): _HATS[2].share}, method=_CROSSING), _QUADRATIC),
        part(identity(where={_function("u(t)_{cubic}"): _HATS[3].share}, method=_CROSSING), _CUBIC),
    ),
    holds(
        "abc.3",
        "The distance from B to C over that from A to B depends on the parameter alone.",
        *parts(
            of_changed(
                identity(where=_distances, each=_BOTH, complete=True),
                _squares,
                f"{_CROSSING}; squares of the distances against the ratio for points that are chosen",
            ),
            *(
                formula(
                    step.relation,
                    equivalent={
                        f"Eq({step.relation.lhs}, {-step.relation.rhs})": "distances are not negative, nor is a ratio"
                    },
                )
                for step in equations("abc.3")
            ),
        ),
    ),
    holds(
        "abc.4",
        "The tip A is found from B and C: the way from C to B, divided by the ratio, leads on from B to A.",
        *parts(
            identity(
                where=_sides,
                each=_BOTH,
                complete=True,
                method="A and B by de Casteljau's triangle, C and the ratio as abc.2 and abc.3 decide them, degree n",
            ),
            *equations("abc.4"),
        ),
        remark="At either end of the curve B is C, the ratio is 0, and nothing is said of A.",
    ),
    holds(
        "abc.5",
        "The ratio of a quadratic curve is |t^2 + (1 - t)^2 - 1| over t^2 + (1 - t)^2.",
        *parts(_ratio(2, "quadratic"), *equations("abc.5")),
    ),
    holds(
        "abc.6",
        "The ratio of a cubic curve is the same with cubes.",
        *parts(_ratio(3, "cubic"), *equations("abc.6")),
    ),
)
