"""Identities decided at points: a whole grid, which proves them, or some random points, which nearly do.

Both sides are quotients of polynomials with whole coefficients; numerators and denominators are computed apart, so
that nothing is divided, and how high a degree they can have is read off what is printed. A polynomial of degree d_i in
letter i that vanishes on a grid of d_i + 1 numbers for each is zero. One of total degree D that is not zero vanishes at
a point drawn from S numbers for each letter with a probability of at most D/S (Schwartz 1980, Zippel 1979).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from math import prod
from random import Random
from typing import Any

import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError, Where, carried_out
from semispline.papers.checks.counterexamples import smallest_difference
from semispline.papers.checks.exports import equation_statement
from semispline.papers.checks.instances import as_letters, letters_of
from semispline.papers.ledger import Case, Check, Counterexample, Formula, Strength, UndefinedError, given
from semispline.papers.recheck import Statement

# Numbers from which random points are drawn, for each letter.
_BITS = 64
# Points that a grid may have.
_MOST_POINTS = 20_000


def at_random_points(*, where: Where | None = None, certainty: int = 100, seed: int = 0, method: str = "") -> Check:
    """Return the check that both sides of an equation are the same at random points: nearly a proof.

    Parameters
    ----------
    where : mapping, optional
        What letters stand for, as for `identity`.
    certainty : int
        A false equation passes with a probability below 2^-certainty, over the draw of the points. They come from a
        generator with a known seed: who makes a formula for these very points can fool it, a printer does not.
    seed : int
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> x, y = sp.symbols("x y")
    >>> square = formula(sp.Eq((x + y) ** 2, x**2 + 2 * x * y + y**2, evaluate=False))
    >>> [case.true for case in at_random_points().cases(square)]
    [True, True]
    """
    rules = _Rules(where or {}, certainty, seed)
    return Check(
        rules.random_cases,
        Strength.RANDOM,
        method
        or f"both sides at points drawn from 0 .. 2^{_BITS} for each letter, enough that a false equation of the "
        f"printed degree passes with a probability below 2^-{certainty}",
        search=rules.search,
        export=rules.random_export,
        believed="that a polynomial which vanishes at these random points is zero",
    )


def on_a_grid(*, where: Where | None = None, method: str = "") -> Check:
    """Return the check that both sides of an equation are the same on a grid that is large enough to prove it.

    Parameters
    ----------
    where : mapping, optional
        What letters stand for, as for `identity`.
    method : str
        What is compared with what, where the standard sentence does not say it.

    Examples
    --------
    >>> from semispline.papers.ledger import formula
    >>> x = sp.Symbol("x")
    >>> fraction = formula(sp.Eq((x**2 - 1) / (x - 1), x + 1, evaluate=False))
    >>> [case.label for case in on_a_grid().cases(fraction)]
    ['all 3 points of x = 0 .. 2']
    """
    rules = _Rules(where or {}, 0, 0)
    return Check(
        rules.grid_cases,
        Strength.GENERAL,
        method or "both sides on a grid with one number more for each letter than the degree of what is printed",
        proof=True,
        search=rules.search,
        export=rules.grid_export,
        believed="that a polynomial which vanishes on a grid larger than its degrees is zero",
    )


@dataclass(frozen=True)
class _Degrees:
    """How high the degrees of a numerator and a denominator can be: in each letter, and in all."""

    over: Mapping[Any, int]
    under: Mapping[Any, int]
    over_all: int
    under_all: int


class _Rules:
    """What an equation is decided by at points."""

    def __init__(self, where: Where, certainty: int, seed: int) -> None:
        self.where, self.certainty, self.seed = where, certainty, seed

    def _sides(self, formula: Formula) -> list[Any]:
        if not isinstance(formula.relation, sp.Equality):
            raise UnsuitableError(f"{formula.relation}: found no equation, expected one")
        return [as_letters(carried_out(side, self.where)) for side in formula.relation.args]

    def random_cases(self, formula: Formula | None) -> Iterator[Case]:
        """Compare at as many random points as the degree asks for."""
        sides = self._sides(given(formula))
        for at in self._random_points(sides):
            yield _case(sides, at, _shown(at))

    def _random_points(self, sides: list[Any]) -> Iterator[dict[Any, int]]:
        degree = max(1, _difference_degrees(*map(_degrees, sides)).over_all)
        if degree >= 2**_BITS:
            raise UnsuitableError(f"found the degree {degree}, expected one far below 2^{_BITS}")
        # Each point passes with probability degree/2^64 at most.
        each = _BITS - (degree - 1).bit_length()
        count = max(1, -(-self.certainty // each))
        letters = letters_of(*sides)
        draw = Random(self.seed)
        for _ in range(count):
            yield {letter: draw.getrandbits(_BITS) for letter in letters}

    def grid_cases(self, formula: Formula | None) -> Iterator[Case]:
        """Compare on the whole grid; one case where all points agree, else the first that does not."""
        sides = self._sides(given(formula))
        letters, points, label = self._grid(sides)
        for values in points:
            at = dict(zip(letters, values, strict=True))
            case = _case(sides, at, _shown(at))
            if not case.true:
                yield case
                return
        if all(_pair(sides[1], dict(zip(letters, v, strict=True)))[1] == 0 for v in self._grid(sides)[1]):
            raise UndefinedError("the right side divides by zero everywhere")
        yield Case(label, True, residual=sp.Integer(0))

    def _grid(self, sides: list[Any]) -> tuple[list[Any], Iterator[tuple[int, ...]], str]:
        degrees = _difference_degrees(*map(_degrees, sides))
        letters = letters_of(*sides)
        sizes = [degrees.over.get(letter, 0) + 1 for letter in letters]
        if prod(sizes) > _MOST_POINTS:
            raise UnsuitableError(f"found a grid of {prod(sizes)} points, expected at most {_MOST_POINTS}")
        ranges = ", ".join(f"{letter} = 0 .. {size - 1}" for letter, size in zip(letters, sizes, strict=True))
        return letters, product(*map(range, sizes)), f"all {prod(sizes)} points of {ranges or 'no letter'}"

    def search(self, formula: Formula) -> Counterexample | None:
        """Return the smallest numbers at which both sides differ."""
        one, other = self._sides(formula)
        return smallest_difference(one, other, formula.assumptions)

    def random_export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return both sides at the random points."""
        formula = given(formula)
        sides = self._sides(formula)
        for case, at in zip(self.random_cases(formula), self._random_points(sides), strict=True):
            yield from self._at(formula, sides, at, case.label)

    def grid_export(self, formula: Formula | None) -> Iterator[Statement]:
        """Return both sides at each point of the grid where they are defined, up to the first that differs."""
        formula = given(formula)
        sides = self._sides(formula)
        letters, points, _ = self._grid(sides)
        for values in points:
            at = dict(zip(letters, values, strict=True))
            if all(_pair(side, at)[1] != 0 for side in sides):
                statements = list(self._at(formula, sides, at, _shown(at)))
                yield from statements
                if not all(statement.true for statement in statements):
                    return

    def _at(self, formula: Formula, sides: list[Any], at: Mapping[Any, int], label: str) -> Iterator[Statement]:
        numbers = {letter: sp.Integer(number) for letter, number in at.items()}
        carried = tuple(side.xreplace(numbers) for side in sides)
        printed = formula.relation.args
        yield equation_statement(label, tuple(printed), carried, self.where, (), numbers)


def _shown(at: Mapping[Any, int]) -> str:
    return ", ".join(f"{letter} = {number}" for letter, number in at.items()) or "no letter"


def _case(sides: list[Any], at: Mapping[Any, int], label: str) -> Case:
    (n1, d1), (n2, d2) = (_pair(side, at) for side in sides)
    left = n2 * d1 - n1 * d2
    if left == 0:
        return Case(label, True, residual=sp.Integer(0))
    residual = sp.Rational(left, d1 * d2) if d1 * d2 else sp.Symbol("undefined: division by zero")
    return Case(label, False, residual=residual)


def _pair(e: Any, at: Mapping[Any, int]) -> tuple[int, int]:
    """Return numerator and denominator at whole numbers, with nothing divided out."""
    if e.is_Rational:
        return int(e.p), int(e.q)
    if e.is_Symbol:
        return at[e], 1
    if e.is_Pow and e.exp.is_Integer:
        n, d = _pair(e.base, at)
        power = int(e.exp)
        return (n**power, d**power) if power >= 0 else (d**-power, n**-power)
    if not (e.is_Add or e.is_Mul):
        raise _not_rational(e)
    numerator, denominator = _pair(e.args[0], at)
    for argument in e.args[1:]:
        n, d = _pair(argument, at)
        if e.is_Mul:
            numerator, denominator = numerator * n, denominator * d
        else:
            numerator, denominator = numerator * d + n * denominator, denominator * d
    return numerator, denominator


def _degrees(e: Any) -> _Degrees:
    """Return how high degrees `_pair` can have, by the same steps."""
    if e.is_Rational:
        return _Degrees({}, {}, 0, 0)
    if e.is_Symbol:
        return _Degrees({e: 1}, {}, 1, 0)
    if e.is_Pow and e.exp.is_Integer:
        base, power = _degrees(e.base), abs(int(e.exp))
        over, under = (
            {letter: power * degree for letter, degree in degrees.items()} for degrees in (base.over, base.under)
        )
        whole = _Degrees(over, under, power * base.over_all, power * base.under_all)
        return whole if e.exp > 0 else _Degrees(whole.under, whole.over, whole.under_all, whole.over_all)
    if not (e.is_Add or e.is_Mul):
        raise _not_rational(e)
    total = _degrees(e.args[0])
    for argument in e.args[1:]:
        more = _degrees(argument)
        if e.is_Mul:
            total = _Degrees(
                _added(total.over, more.over),
                _added(total.under, more.under),
                total.over_all + more.over_all,
                total.under_all + more.under_all,
            )
        else:
            total = _difference_degrees(total, more)
    return total


def _difference_degrees(one: _Degrees, other: _Degrees) -> _Degrees:
    """Return the degrees of a sum or a difference."""
    first, second = _added(one.over, other.under), _added(other.over, one.under)
    over = {letter: max(first.get(letter, 0), second.get(letter, 0)) for letter in {*first, *second}}
    over_all = max(one.over_all + other.under_all, other.over_all + one.under_all)
    return _Degrees(over, _added(one.under, other.under), over_all, one.under_all + other.under_all)


def _added(one: Mapping[Any, int], other: Mapping[Any, int]) -> dict[Any, int]:
    return {letter: one.get(letter, 0) + other.get(letter, 0) for letter in {*one, *other}}


def _not_rational(e: Any) -> UnsuitableError:
    return UnsuitableError(f"found {e} ({type(e).__name__}), expected sums, products and whole powers of letters")
