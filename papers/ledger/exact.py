"""Running a printed formula exactly: its letters are given a meaning, and sums are carried out term by term.

Control points become generators of a polynomial ring over the rational numbers, so that one evaluation decides an
identity for all control points at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import comb, factorial
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.papers.ledger.records import Case, Formula


class UndefinedError(ValueError):
    """A formula names a control point, a knot or a function that does not exist."""


@dataclass(frozen=True)
class Meaning:
    """What the letters of a formula stand for.

    Attributes
    ----------
    numbers : mapping
        Symbol -> value.
    functions : mapping
        Name of a function or of an indexed letter -> callable of the evaluated arguments, which raises
        `UndefinedError` outside of its range.
    """

    numbers: Mapping[Any, Any]
    functions: Mapping[str, Any] = field(default_factory=dict)


def given(formula: Formula | None) -> Formula:
    """Return the formula that a check was handed.

    Raises
    ------
    ValueError
        There is none: the check decides relations only.
    """
    if formula is None:
        raise ValueError("formula: found None, expected a relation")
    return formula


def interpret(expression: Any, meaning: Meaning) -> Any:
    """Return the exact value of an expression of sums, products, powers, binomials, indexed letters and functions.

    Raises
    ------
    UndefinedError
        An index outside of its range.
    """
    return _value(sp.sympify(expression), dict(meaning.numbers), meaning.functions)


def _value(e: Any, numbers: dict[Any, Any], functions: Mapping[str, Callable[..., Any]]) -> Any:
    if e.is_Rational:
        return as_fraction(e)
    if e.is_Symbol:
        if e not in numbers:
            raise UndefinedError(f"{e} is not defined")
        value = numbers[e]
        # Integers divide as floats in Python.
        return Fraction(value) if isinstance(value, int) else value
    if isinstance(e, sp.Indexed):
        return functions[str(e.base)](*(_value(i, numbers, functions) for i in e.indices))
    if isinstance(e, sp.Sum | sp.Product):
        return _sum(e, list(e.limits), numbers, functions)
    arguments = [_value(a, numbers, functions) for a in e.args]
    if isinstance(e, AppliedUndef):
        return functions[e.func.__name__](*arguments)
    return _combined(e, arguments)


def _combined(e: Any, arguments: list[Any]) -> Any:
    if e.is_Add:
        return sum(arguments[1:], arguments[0])
    if e.is_Mul:
        product = arguments[0]
        for a in arguments[1:]:
            product = product * a
        return product
    if e.is_Pow and arguments[1] == int(arguments[1]):
        power = int(arguments[1])
        if power < 0 and arguments[0] == 0:
            raise UndefinedError(f"division by zero in {e}")
        return arguments[0] ** power
    if isinstance(e, sp.binomial):
        n, r = (int(a) for a in arguments)
        return Fraction(comb(n, r)) if 0 <= r <= n else Fraction(0)
    if isinstance(e, sp.factorial):
        if arguments[0] < 0 or arguments[0] != int(arguments[0]):
            raise UndefinedError(f"{e} is not defined")
        return Fraction(factorial(int(arguments[0])))
    if isinstance(e, sp.Abs):
        return abs(arguments[0])
    raise TypeError(f"{e.func.__name__} has no exact value")


def _sum(e: Any, limits: list[Any], numbers: dict[Any, Any], functions: Mapping[str, Callable[..., Any]]) -> Any:
    # SymPy lists the innermost limit first.
    *inner, (index, lower, upper) = limits
    low, high = (int(_value(x, numbers, functions)) for x in (lower, upper))
    is_sum = isinstance(e, sp.Sum)
    total: Any = Fraction(0 if is_sum else 1)
    for n in range(low, high + 1):
        at = {**numbers, index: Fraction(n)}
        term = _sum(e, inner, at, functions) if inner else _value(e.function, at, functions)
        total = total + term if is_sum else total * term
    return total


def difference_case(formula: Formula, label: str, meaning: Meaning, **flags: bool) -> Case:
    """Return the case of one instance: whether both sides are the same, and what the difference is."""
    try:
        left, right = (interpret(side, meaning) for side in formula.relation.args)
    except UndefinedError as error:
        return Case(label, False, residual=sp.Symbol(f"undefined: {error}"), **flags)
    residual = as_expression(right - left)
    return Case(label, bool(residual == 0), residual=residual, **flags)


def as_expression(value: Any) -> Any:
    """Return an exact value (fraction or ring element) as a SymPy expression."""
    if isinstance(value, Fraction | int):
        return sp.Rational(Fraction(value).numerator, Fraction(value).denominator)
    return value.as_expr() if hasattr(value, "as_expr") else sp.sympify(value)


def as_fraction(number: Any) -> Fraction:
    """Return a SymPy rational as a fraction.

    Examples
    --------
    >>> as_fraction(sp.Rational(2, 6))
    Fraction(1, 3)
    """
    return Fraction(int(number.p), int(number.q))


def indexed(name: str, values: Mapping[Any, Any]) -> Callable[..., Any]:
    """Return a lookup by integer indices that refuses what is not there."""

    def look_up(*indices: Any) -> Any:
        key = tuple(int(i) for i in indices)
        if key not in values:
            raise UndefinedError(f"{name}{list(key)}")
        return values[key]

    return look_up
