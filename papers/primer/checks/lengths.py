"""Lengths of curves: what any printed integral for them has to be, and quadrature with the fewest nodes."""

from __future__ import annotations

from functools import cache
from typing import Any

import sympy as sp

from semispline.papers.checks import identity
from semispline.papers.ledger import Check
from semispline.papers.primer.checks.following import of_changed

_SPEED, _U, _V = sp.symbols("speed u v", real=True)


def length_between(x: Any, y: Any, start: Any, end: Any) -> Check:
    """Return the check that an integral is the length of a curve with the coordinate functions x and y.

    A length adds up along the curve, and it grows as chord over step does for ever smaller steps, since it lies between
    the chord and the polygon of the tangents. From a point with the derivatives u and v a small step h leads to
    (u h, v h) and what is smaller than h.
    """
    step = sp.Symbol("h", positive=True)
    speed = sp.sqrt(sp.expand(((_U * step) ** 2 + (_V * step) ** 2) / step**2))

    def growth(relation: Any) -> Any:
        [integral] = relation.rhs.atoms(sp.Integral)
        [(variable, low, high)] = integral.limits
        at_end = integral.function.xreplace({variable: end}) if (low, high) == (start, end) else sp.Integer(0)
        return sp.Eq(_SPEED, relation.rhs.xreplace({integral: at_end}), evaluate=False)

    where = {_SPEED: speed, sp.Derivative(x(end), end): _U, sp.Derivative(y(end), end): _V}
    words = (
        "the limit of chord over step, for any curve with a continuous derivative, against the growth of the integral "
        "with its upper end; its lower end is where the length is 0"
    )
    return of_changed(identity(where=where), growth, words)


@cache
def gauss(count: int) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Return nodes and weights on [-1, 1]: roots of the polynomial that all of lower degree are orthogonal to.

    Examples
    --------
    >>> gauss(1)
    ((0,), (2,))
    """
    x = sp.Symbol("x")
    family: list[Any] = []
    for k in range(count + 1):
        power = x**k
        for lower in family:
            power -= sp.integrate(x**k * lower, (x, -1, 1)) / sp.integrate(lower**2, (x, -1, 1)) * lower
        family.append(sp.expand(power))
    nodes = tuple(sorted(sp.roots(family[-1], x), key=float))
    weights = []
    for node in nodes:
        others = [other for other in nodes if other != node]
        lagrange = sp.Mul(*((x - other) / (node - other) for other in others))
        weights.append(sp.simplify(sp.integrate(sp.expand(lagrange), (x, -1, 1))))
    return nodes, tuple(weights)
