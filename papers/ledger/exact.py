"""Running a printed formula exactly: its letters are given a meaning, and sums are carried out term by term.

Control points become generators of a polynomial ring over the rational numbers, so that one evaluation decides an
identity for all control points at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from math import comb
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from semispline.derivations.splines import Span, X, basis_pieces
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
    if isinstance(e, sp.Sum):
        return _sum(e.function, list(e.limits), numbers, functions)
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
    raise TypeError(f"{e.func.__name__} has no exact value")


def _sum(term: Any, limits: list[Any], numbers: dict[Any, Any], functions: Mapping[str, Callable[..., Any]]) -> Any:
    # SymPy lists the innermost limit first.
    *inner, (index, lower, upper) = limits
    low, high = (int(_value(x, numbers, functions)) for x in (lower, upper))
    total: Any = Fraction(0)
    for n in range(low, high + 1):
        at = {**numbers, index: Fraction(n)}
        total = total + (_sum(term, inner, at, functions) if inner else _value(term, at, functions))
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


def spline_basis(knots: Mapping[Any, Sequence[Any]]) -> Callable[..., Any]:
    """Return B(i, order, x, name) over knot vectors known by name; Cox-de Boor, exact; a fifth argument differentiates.

    Raises
    ------
    UndefinedError
        When called with an index that the knot vector of that order does not have.
    """
    # A vector is hashed once here, and not again at each value: its fractions make that slow.
    values = {name: (len(vector), _basis_values(tuple(vector))) for name, vector in knots.items()}

    def basis(i: Any, order: Any, x: Any, name: Any, derivative: Any = 0) -> Fraction:
        length, value = values[name]
        count = length - int(order)
        if not 0 <= i < count or count < order:
            raise UndefinedError(f"B[{i}] of {count} functions of order {order}")
        return value(int(i), int(order), Fraction(x), int(derivative))

    return basis


@cache
def _basis_values(vector: tuple[Any, ...]) -> Callable[[int, int, Fraction, int], Fraction]:
    """Return the basis functions over one knot vector, which remember their values."""

    @cache
    def spans(order: int) -> tuple[Span, ...]:
        return basis_pieces(order - 1, [as_expression(t) for t in vector])

    @cache
    def value(i: int, order: int, x: Fraction, derivative: int) -> Fraction:
        point = sp.Rational(x.numerator, x.denominator)
        span = next((s for s in spans(order) if s.start <= point < s.end), spans(order)[-1])
        if not span.first <= i < span.first + len(span.pieces):
            return Fraction(0)
        piece = span.pieces[i - span.first]
        return as_fraction((piece.diff((X, derivative)) if derivative else piece).eval(point))

    return value


def bernstein(i: Any, degree: Any, x: Any) -> Any:
    """Return B_i^n(x) for a fraction or a ring element x."""
    n, r = int(degree), int(i)
    if not 0 <= r <= n:
        raise UndefinedError(f"B[{r}] of degree {n}")
    return comb(n, r) * x**r * (1 - x) ** (n - r)


def de_boor(order: int, knots: Sequence[Any], points: Sequence[Any], x: Fraction) -> Any:
    """Return a spline at x by de Boor's triangle, which knows no basis functions; points may be ring elements."""
    degree = order - 1
    last = len(points) - 1
    k = max(i for i in range(degree, last + 1) if knots[i] <= x and knots[i] < knots[i + 1])
    level = list(points[k - degree : k + 1])
    for step in range(1, degree + 1):
        for j in range(degree, step - 1, -1):
            left = k - degree + j
            weight = Fraction(x - knots[left]) / Fraction(knots[left + degree - step + 1] - knots[left])
            level[j] = level[j - 1] * (1 - weight) + level[j] * weight
    return level[degree]


def clamped(order: int, *inner: Any, start: Any = 0, end: Any = 1) -> tuple[Fraction, ...]:
    """Return a knot vector with `order`-fold ends.

    Examples
    --------
    >>> [str(t) for t in clamped(2, Fraction(1, 3))]
    ['0', '0', '1/3', '1', '1']
    """
    return tuple(Fraction(t) for t in (*[start] * order, *inner, *[end] * order))


def net_ring(*sizes: int, letter: str = "P") -> dict[tuple[int, int], Any]:
    """Return ring generators P_i_j for rows of the given lengths."""
    names = [(i, j) for i, size in enumerate(sizes) for j in range(size)]
    _, *generators = sp.ring([f"{letter}_{i}_{j}" for i, j in names], sp.QQ)
    return dict(zip(names, generators, strict=True))


def rational_points(start: Any, end: Any, count: int) -> Iterator[Fraction]:
    """Yield rational parameters from start to end, none of them regular fractions of the range but the ends."""
    for n in range(count):
        share = Fraction(n, count - 1)
        yield Fraction(start) + (Fraction(end) - Fraction(start)) * share * (1 + share) / 2
