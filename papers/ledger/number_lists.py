"""Printed data inside a formula: knot vectors and lists of numbers, which say themselves how they may be mistaken."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp


class Knots(sp.Tuple):
    """Knots or breakpoints, as printed.

    Examples
    --------
    >>> Knots(0, 0, sp.Rational(1, 2), 1, 1)
    (0, 0, 1/2, 1, 1)
    """

    def changes(self) -> Iterator[tuple[str, Knots]]:
        """Yield what the mutation check tries."""
        yield from (("knot", changed) for changed in knot_changes(self))


class Numbers(sp.Tuple):
    """Other printed numbers: sizes and counts."""

    def changes(self) -> Iterator[tuple[str, Numbers]]:
        """Yield what the mutation check tries."""
        yield from (("number", changed) for changed in number_changes(self))
        yield from (("index", changed) for changed in exchanges(self))


def knot_changes(knots: Knots) -> Iterator[Knots]:
    """Yield vectors with one knot lost, doubled, moved halfway to a neighbour, or exchanged with the next one."""
    for i, knot in enumerate(knots):
        before, after = knots[:i], knots[i + 1 :]
        yield Knots(*before, *after)
        yield Knots(*before, knot, knot, *after)
        for other in _different_neighbours(knots, i):
            yield Knots(*before, (knot + other) / 2, *after)
        if after and after[0] != knot:
            yield Knots(*before, after[0], knot, *after[1:])


def inner_moves(knots: Knots) -> Iterator[Knots]:
    """Yield those of `knot_changes` that are vectors of the same kind: one inner knot moved between its neighbours.

    Examples
    --------
    >>> list(inner_moves(Knots(0, 0, sp.Rational(1, 2), 1, 1)))
    [(0, 0, 3/4, 1, 1), (0, 0, 1/4, 1, 1)]
    """
    for i, knot in enumerate(knots):
        if knots[0] < knot < knots[-1]:
            for other in _different_neighbours(knots, i):
                yield Knots(*knots[:i], (knot + other) / 2, *knots[i + 1 :])


def number_changes(numbers: Numbers) -> Iterator[Numbers]:
    """Yield lists with one number one unit (for a fraction, a hundredth) more or less."""
    for i, number in enumerate(numbers):
        for changed in near(number):
            yield Numbers(*numbers[:i], changed, *numbers[i + 1 :])


def exchanges(numbers: Numbers) -> Iterator[Numbers]:
    """Yield lists with two different neighbours exchanged."""
    for i in range(len(numbers) - 1):
        if numbers[i] != numbers[i + 1]:
            yield Numbers(*numbers[:i], numbers[i + 1], numbers[i], *numbers[i + 2 :])


def near(number: Any) -> tuple[Any, Any]:
    """Return a number one unit (for a fraction, a hundredth) more and less."""
    step = sp.Integer(1) if number.is_Integer else sp.Rational(1, 100)
    return number + step, number - step


def _different_neighbours(knots: Knots, i: int) -> list[Any]:
    following = [t for t in knots[i + 1 :] if t != knots[i]]
    earlier = [t for t in knots[:i] if t != knots[i]]
    return following[:1] + earlier[-1:]
