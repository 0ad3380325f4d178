"""The instances at which a check decides a formula with whole numbers in it, and letters that stand for the rest."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from hashlib import sha256
from itertools import product
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.checks.carrying_out import UnsuitableError, Where

# Letter -> the whole numbers that it takes, or the instances one by one.
Each: TypeAlias = Mapping[Any, Iterable[int]] | Iterable[Mapping[Any, int]]
# What letters stand for, the same everywhere or told of each instance.
Meanings: TypeAlias = Where | Callable[[Mapping[Any, int]], Where]


def instances(each: Each | None) -> Iterator[dict[Any, Any]]:
    """Yield the instances; a single empty one where nothing is to be tried.

    Examples
    --------
    >>> n, i = sp.symbols("n i")
    >>> list(instances({n: (1, 2)}))
    [{n: 1}, {n: 2}]
    >>> len(list(instances({n: range(3), i: range(2)}))), list(instances(None))
    (6, [{}])
    """
    if each is None:
        yield {}
    elif isinstance(each, Mapping):
        for values in product(*each.values()):
            yield {letter: sp.Integer(value) for letter, value in zip(each, values, strict=True)}
    else:
        for one in each:
            yield {letter: sp.Integer(value) for letter, value in one.items()}


def label_of(instance: Mapping[Any, Any]) -> str:
    """Return an instance in words."""
    return ", ".join(f"{letter} = {value}" for letter, value in instance.items()) or "all letters"


def meanings_at(where: Meanings | None, instance: Mapping[Any, Any]) -> Where:
    """Return what letters stand for at an instance."""
    if where is None:
        return {}
    return where(instance) if callable(where) else where


def as_letters(expression: Any) -> Any:
    """Return an expression in which values of functions and indexed letters are letters of their own."""
    parts = expression.atoms(sp.Indexed, AppliedUndef)
    return expression.xreplace({part: sp.Symbol(str(part)) for part in parts})


def letters_of(*expressions: Any) -> list[Any]:
    """Return the letters of expressions, by name."""
    return sorted({s for e in expressions for s in e.free_symbols if isinstance(s, sp.Symbol)}, key=str)


def spread_values(letters: Iterable[Any], turn: int = 0) -> dict[Any, Fraction]:
    """Return a rational number for each letter, another one at each turn: the same at each run, and no two alike."""
    values = {}
    for letter in letters:
        mark = int.from_bytes(sha256(f"{letter} {turn}".encode()).digest()[:4], "big")
        numerator, denominator = 2 + mark % 89, 2 + mark // 89 % 13
        value = Fraction(numerator) if letter.is_integer else Fraction(numerator, denominator)
        values[letter] = value
    return values


def holds_at(assumptions: Iterable[Any], at: Mapping[Any, Any]) -> bool:
    """Tell whether all assumptions whose letters have numbers are satisfied.

    Raises
    ------
    UnsuitableError
        An assumption is an equation: what equals what is said by `where`.
    """
    for assumption in assumptions:
        if isinstance(assumption, sp.Equality):
            raise UnsuitableError(f"assumption {assumption}: found an equation, expected it as a meaning (where=...)")
        if assumption.free_symbols <= set(at):
            exact = {letter: sp.Rational(value) for letter, value in at.items()}
            if assumption.xreplace(exact) != sp.true:
                return False
    return True
