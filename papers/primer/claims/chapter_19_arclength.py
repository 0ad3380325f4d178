"""The length of a curve, and how it is computed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import Formula, Part, UndefinedError, formula, part, parts
from semispline.papers.primer.checks.lengths import gauss, length_between
from semispline.papers.primer.printed import letter, steps, terms_of
from semispline.papers.primer.writing import equations, holds

_z, _n = letter("arclength.1", "z"), letter("arclength.3", "n")
_LENGTH = sp.Symbol("length", real=True)
_f, _C, _nodes = sp.Function("f(t)", real=True), *(sp.IndexedBase(name, real=True) for name in ("C_i", "t_i"))


def _function(name: str) -> Any:
    return sp.Function(name, real=True)


def _polynomial(degree: int) -> Any:
    """Return any polynomial of a degree, as a function."""
    return lambda at: sum(sp.Symbol(f"a_{k}", real=True) * at**k for k in range(degree + 1))


def _nth(values: tuple[Any, ...], name: str) -> Any:
    def at(i: Any) -> Any:
        if not 1 <= i <= len(values):
            raise UndefinedError(f"{name}[{i}] of {len(values)}")
        return values[int(i) - 1]

    return at


def _rule(instance: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Return nodes, weights and what the rule is exact for."""
    count = int(instance[_n])
    nodes, weights = gauss(count)
    return {_f: _polynomial(2 * count - 1), _C: _nth(weights, "C"), _nodes: _nth(nodes, "t")}


_RULES = identity(
    where=_rule,
    each={_n: range(1, 4)},
    method="nodes and weights from the orthogonal polynomial, and any f of the degree 2 n - 1, for n = 1 .. 3",
)


# The two sums of a display are the same whatever f, nodes and weights are.
_SAME_SUMS = identity(each={_n: range(1, 4)})
_MIRRORED = "nodes on [-1, 1] lie as they do in a mirror, and so do their weights"


def _quadrature(identifier: str) -> tuple[Formula, ...]:
    """Return the steps from the integral of f on; f stands for the square root in it."""
    found = []
    for step in steps(identifier):
        left = step.left
        if left.has(sp.Derivative):
            left = sp.Integral(_f(letter(identifier, "t")), *left.limits)
        if left != step.right:
            found.append(formula(sp.Eq(left, step.right, evaluate=False)))
    return tuple(found)


def _rule_and_sum(identifier: str, mirrored: str = "") -> tuple[Part, ...]:
    *_, rule, same = _quadrature(identifier)
    equivalent = {f"Eq({rule.relation.lhs}, {mirrored})": _MIRRORED} if mirrored else {}
    return part(_RULES, replace(rule, equivalent=equivalent)), part(_SAME_SUMS, same)


_ONE, *_OTHERS = equations("arclength.5")

CLAIMS = (
    holds(
        "arclength.1",
        "The length of a curve from its start to the parameter z is the integral of the root of the sum of squared "
        "derivatives.",
        part(
            length_between(_function("f_x(t)"), _function("f_y(t)"), 0, _z),
            formula(sp.Eq(_LENGTH, terms_of("arclength.1")[0][0], evaluate=False)),
        ),
    ),
    holds(
        "arclength.2",
        "The same, written with dx/dt and dy/dt.",
        *parts(
            length_between(_function("x(t)"), _function("y(t)"), 0, _z),
            *equations("arclength.2"),
        ),
    ),
    holds(
        "arclength.3",
        "With f for the integrand, an integral from -1 to 1 is about the sum of n values of f, each with its weight.",
        *_rule_and_sum("arclength.3"),
        remark="What is decided is for which f the rule of Gauss and Legendre is exact: polynomials of degree 2 n - 1. "
        "How near it comes for a root depends on the curve.",
    ),
    holds(
        "arclength.4",
        "The same from 0 to z: nodes and weights scaled by z/2, nodes moved by z/2.",
        *_rule_and_sum("arclength.4", "z*Sum(f(t)(-z*t_i[_k]/2 + z/2)*C_i[_k], (_k, 1, n))/2"),
    ),
    holds(
        "arclength.5",
        "With two nodes both weights are 1 and the nodes lie at a third of root three, on either side.",
        *parts(
            identity(where={_C: _nth(gauss(2)[1], "C"), _nodes: _nth(gauss(2)[0], "t")}),
            replace(_ONE, equivalent={"Eq(C_i[2], 1)": "both weights are 1"}),
            *_OTHERS,
        ),
    ),
    holds(
        "arclength.6",
        "The rule with two nodes from 0 to z.",
        *parts(
            identity(
                where={_f: _polynomial(3)},
                method="any f of degree 3, which two nodes suffice for, both sides in normal form",
            ),
            *_quadrature("arclength.6"),
        ),
    ),
)
