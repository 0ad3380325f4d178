"""What is true of a Bezier curve, by de Casteljau's construction alone: it knows neither binomials nor powers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from math import comb, hypot
from typing import Any

import sympy as sp

from semispline.derivations.bezier import blossom, de_casteljau
from semispline.papers.ledger import UndefinedError

# The orders at which sums over the points of a curve of any order are carried out.
ORDERS = range(1, 5)


@cache
def basis(n: int, i: int, t: Any) -> Any:
    """Return the share of point i in a curve of order n at t; nothing where there is no such point.

    Examples
    --------
    >>> sp.expand(basis(2, 1, sp.Symbol("t")))
    -2*t**2 + 2*t
    >>> basis(2, 3, sp.Symbol("t"))
    0
    """
    if not 0 <= i <= n:
        return sp.Integer(0)
    return sp.expand(de_casteljau([sp.Integer(j == i) for j in range(n + 1)], t))


def curve_of(weights: Callable[[int], Any]) -> Callable[..., Any]:
    """Return (n, t) -> the curve of order n with the weights 0 .. n."""

    def curve(n: Any, t: Any) -> Any:
        if n < 0:
            raise UndefinedError(f"a curve of order {n}")
        return sp.Add(*(weights(i) * basis(int(n), i, t) for i in range(int(n) + 1)))

    return curve


def part_of_curve(points: Sequence[Any], start: Any, end: Any) -> list[Any]:
    """Return the points of the part of a curve between two parameters: values of its blossom."""
    n = len(points) - 1
    return [sp.sympify(blossom(points, [start] * (n - i) + [end] * i)) for i in range(n + 1)]


def differences(points: Sequence[Any]) -> list[Any]:
    """Return the points of the derivative: n times the steps from point to point.

    Examples
    --------
    >>> differences([0, 1, 4])
    [2, 6]
    """
    return [(len(points) - 1) * (b - a) for a, b in pairwise(points)]


def greatest_distance(one: Sequence[Sequence[Any]], other: Sequence[Sequence[Any]]) -> float:
    """Return how far two curves are apart at most at the same parameter, among 101: each by its points.

    Examples
    --------
    >>> greatest_distance([(0, 0), (1, 0)], [(0, 0), (1, 2)])
    2.0
    """
    n = len(one) - 1
    far = 0.0
    for step in range(101):
        t = step / 100
        apart = [
            sum(
                comb(n, i) * t**i * (1 - t) ** (n - i) * (float(a[c]) - float(b[c]))
                for i, (a, b) in enumerate(zip(one, other, strict=True))
            )
            for c in (0, 1)
        ]
        far = max(far, hypot(*apart))
    return far


def row(*entries: Any) -> Any:
    """Return a matrix of one row."""
    return sp.ImmutableMatrix([list(entries)])


def column(*entries: Any) -> Any:
    """Return a matrix of one column."""
    return sp.ImmutableMatrix([[entry] for entry in entries])
