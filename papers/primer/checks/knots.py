"""Splines from first principles: polar forms, and functions as divided differences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp


def knot(j: Any) -> Any:
    """Return the letter for a knot.

    Examples
    --------
    >>> knot(3)
    u3
    """
    return sp.Symbol(f"u{int(j)}", real=True)


def polar(arguments: Sequence[Any]) -> Any:
    """Return the polar form of any polynomial of as many degrees as there are arguments: symmetric, affine in each.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> polar([x, y])
    c0 + c1*(x + y)/2 + c2*x*y
    """
    degree = len(arguments)
    by_size = [sp.Integer(1)] + [sp.Integer(0)] * degree
    for argument in arguments:
        for size in range(degree, 0, -1):
            by_size[size] += argument * by_size[size - 1]
    return sum(sp.Symbol(f"c{k}", real=True) * e / sp.binomial(degree, k) for k, e in enumerate(by_size))


def point(degree: int, i: int, level: int = 0, at: Any = None) -> Any:
    """Return a point of de Boor's triangle: the polar form at the knots behind knot i, `level` of them replaced.

    Source: L. Ramshaw, Blossoms are polar forms, CAGD 6 (1989).
    """
    return polar([*(knot(i + j) for j in range(1, degree - level + 1)), *[at] * level])


def slope(degree: int, i: int) -> Any:
    """Return a control point of the derivative: the degree times the rate at which the polar form changes.

    In one argument, the others being the knots that two neighbouring control points share.
    """
    free = sp.Symbol("free")
    return degree * polar([free, *(knot(i + j) for j in range(2, degree + 1))]).diff(free)


def function(i: int, order: int, at: Any, span: int) -> Any:
    """Return a function on the span behind a knot: the width of its knots times a divided difference.

    Of (x - at)^(order - 1) where x is greater than `at`, and 0 elsewhere, over the order + 1 knots from knot i on.

    Source: C. de Boor, A Practical Guide to Splines, chapter IX.

    Examples
    --------
    >>> t = sp.Symbol("t")
    >>> function(0, 1, t, 0), function(0, 1, t, 1), sp.factor(function(0, 2, t, 0))
    (1, 0, -(t - u0)/(u0 - u1))
    """
    places = range(i, i + order + 1)
    total: Any = sp.Integer(0)
    for j in places:
        if j > span:
            apart = sp.Mul(*(knot(j) - knot(m) for m in places if m != j))
            total += (knot(j) - at) ** (order - 1) / apart
    found = (knot(i + order) - knot(i)) * total
    return sp.cancel(found) if order == 1 else found
