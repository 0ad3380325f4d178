"""Statements at their instance, with Python's `fractions` alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from semispline.papers.recheck.arithmetic import instance, satisfied, value
from semispline.papers.recheck.by_intervals import enclosed
from semispline.papers.recheck.by_series import series_of
from semispline.papers.recheck.rooted import equal_with_roots
from semispline.papers.recheck.statements import (
    Coefficient,
    Contained,
    Identity,
    Knots,
    Matrices,
    Minimum,
    Number,
    Positive,
    Rank,
    Statement,
    Term,
)

# No interval of a number is wider.
_WIDTH = Fraction(1, 10**40)
_Rows = list[list[Fraction]]


def agrees(statement: Statement) -> bool:
    """Tell whether what is stated is so at the instance; numbers need none."""
    at = instance(statement.at, statement.where)
    if any(value(factor, at) == 0 for factor in statement.nonzero):
        return False
    return _BY_FORM[statement.form](statement, at)


def _identity(statement: Identity, at: dict[str, Fraction]) -> bool:
    if statement.roots:
        return equal_with_roots(statement.left, statement.right, statement.roots, at) == statement.equal
    equal = value(statement.left, at) == value(statement.right, at)
    return equal == statement.equal and all(satisfied(condition, at) for condition in statement.conditions)


def _positive(statement: Positive, at: dict[str, Fraction]) -> bool:
    if not _signs(statement):
        return False
    over, under = (sum(_term(term, at) for term in part) for part in (statement.over, statement.under))
    left = value(statement.left, at)
    return left * under == over and left >= 0 and under > 0 and (left > 0 or not statement.strict)


def _signs(statement: Positive) -> bool:
    """Tell whether the terms have the signs and names that the argument needs."""
    positive = set(statement.positive)
    known = positive | set(statement.nonnegative)
    terms = (*statement.over, *statement.under)
    allowed = all(
        Fraction(term.coefficient) > 0 and all(n in known or power % 2 == 0 for n, power in term.powers)
        for term in terms
    )

    def strict(part: tuple[Term, ...]) -> bool:
        return any(not term.squares and all(name in positive for name, _ in term.powers) for term in part)

    return allowed and strict(statement.under) and (strict(statement.over) or not statement.strict)


def _term(term: Term, at: dict[str, Fraction]) -> Fraction:
    product = Fraction(term.coefficient)
    for name, power in term.powers:
        product *= at[name] ** power
    for square in term.squares:
        product *= value(square, at) ** 2
    return product


def _rank(statement: Rank, at: dict[str, Fraction]) -> bool:
    full = [[value(entry, at) for entry in row] for row in statement.matrix]
    kernel = [[value(entry, at) for entry in row] for row in statement.kernel]
    missing = len(kernel[0]) if kernel else 0
    minor = [[full[i][j] for j in statement.columns] for i in statement.rows]
    unit = [[Fraction(int(i == j)) for j in range(missing)] for i in range(missing)]
    return (
        len(minor) == statement.rank
        and missing == len(full[0]) - statement.rank
        and (not minor or _determinant(minor) != 0)
        and (not missing or ([kernel[i] for i in statement.free] == unit and not any(map(any, _product(full, kernel)))))
    )


def _contained(statement: Contained, _: dict[str, Fraction]) -> bool:
    outer, inner = _numbers(statement.outer), _numbers(statement.inner)
    if statement.solution:
        return _product(outer, _numbers(statement.solution)) == inner
    row = [[Fraction(x) for x in statement.separator]]
    return not any(_product(row, outer)[0]) and any(_product(row, inner)[0])


def _minimum(statement: Minimum, _: dict[str, Fraction]) -> bool:
    full, lower = _numbers(statement.matrix), _numbers(statement.lower)
    pivots = [Fraction(x) for x in statement.pivots]
    size = len(pivots)
    triangular = all(lower[i][j] == (i == j) for i in range(size) for j in range(i, size))
    scaled = [[lower[i][j] * pivots[j] for j in range(size)] for i in range(size)]
    back = [list(row) for row in zip(*lower, strict=True)]
    return triangular and all(pivot > 0 for pivot in pivots) and _product(scaled, back) == full


def _knots(statement: Knots, _: dict[str, Fraction]) -> bool:
    return _fact(statement) == statement.holds


def _fact(statement: Knots) -> bool:
    knots, order = [Fraction(x) for x in statement.numbers], statement.order
    name, _, number = statement.fact.partition(" ")
    inner = knots[order : len(knots) - order]
    if name == "points":
        return len(knots) - order == int(number)
    if name == "increasing":
        return knots == sorted(knots)
    if name == "clamped":
        return knots[:order] == [0] * order and knots[len(knots) - order :] == [1] * order
    if name == "single":
        return len(set(inner)) == len(inner) and all(0 < x < 1 for x in inner)
    return knots == [Fraction(x) for x in statement.other]


def _matrices(statement: Matrices, at: dict[str, Fraction]) -> bool:
    named: dict[str, Any] = {
        name: Square([[value(entry, at) for entry in row] for row in rows]) for name, rows in statement.matrices
    }
    left, right = (value(side, {**at, **named}) for side in (statement.left, statement.right))
    return bool(left == right) == statement.equal


class Square:
    """A matrix of fractions, square where it has a negative power."""

    def __init__(self, rows: _Rows) -> None:
        self.rows = rows

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Square) and self.rows == other.rows

    __hash__ = None  # type: ignore[assignment]  # rows may change

    def __add__(self, other: Square) -> Square:
        pairs = zip(self.rows, other.rows, strict=True)
        return Square([[a + b for a, b in zip(one, two, strict=True)] for one, two in pairs])

    def __neg__(self) -> Square:
        return self * Fraction(-1)

    def __sub__(self, other: Square) -> Square:
        return self + (-other)

    def __mul__(self, other: Square | Fraction) -> Square:
        if isinstance(other, Square):
            return Square(_product(self.rows, other.rows))
        return Square([[a * other for a in row] for row in self.rows])

    def __rmul__(self, number: Fraction) -> Square:
        return self * number

    def __pow__(self, power: int) -> Square:
        size = len(self.rows)
        product = Square([[Fraction(int(i == j)) for j in range(size)] for i in range(size)])
        base = self if power >= 0 else Square(_inverse(self.rows))
        for _ in range(abs(power)):
            product = product * base
        return product


def _inverse(rows: _Rows) -> _Rows:
    """Return the inverse by elimination.

    Raises
    ------
    ZeroDivisionError
        There is none.
    """
    size = len(rows)
    work = [[*row, *(Fraction(int(i == j)) for j in range(size))] for i, row in enumerate(rows)]
    for n in range(size):
        pivot = next((r for r in range(n, size) if work[r][n] != 0), None)
        if pivot is None:
            raise ZeroDivisionError("a matrix without an inverse")
        work[n], work[pivot] = work[pivot], work[n]
        work[n] = [a / work[n][n] for a in work[n]]
        for r in range(size):
            if r != n:
                work[r] = [a - work[r][n] * b for a, b in zip(work[r], work[n], strict=True)]
    return [row[size:] for row in work]


def _number(statement: Number, _: dict[str, Fraction]) -> bool:
    found = enclosed(statement.left)
    low, high = Fraction(statement.low), Fraction(statement.high)
    if statement.inside:
        # At an end the interval reaches a little beyond it.
        return low - _WIDTH <= found.low and found.high <= high + _WIDTH
    return found.high < low or found.low > high


def _coefficient(statement: Coefficient, at: dict[str, Fraction]) -> bool:
    count = statement.power + 1
    one, other = (series_of(side, statement.variable, count, at)[-1] for side in (statement.left, statement.right))
    return (one == other) == statement.equal


def _numbers(rows: Sequence[Sequence[str]]) -> _Rows:
    return [[Fraction(entry) for entry in row] for row in rows]


def _product(one: _Rows, other: _Rows) -> _Rows:
    columns = list(zip(*other, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in one]


def _determinant(rows: _Rows) -> Fraction:
    rows = [list(row) for row in rows]
    total = Fraction(1)
    for n in range(len(rows)):
        pivot = next((r for r in range(n, len(rows)) if rows[r][n] != 0), None)
        if pivot is None:
            return Fraction(0)
        if pivot != n:
            rows[n], rows[pivot] = rows[pivot], rows[n]
            total = -total
        total *= rows[n][n]
        for r in range(n + 1, len(rows)):
            factor = rows[r][n] / rows[n][n]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[n], strict=True)]
    return total


_BY_FORM: dict[str, Callable[[Any, dict[str, Fraction]], bool]] = {
    "identity": _identity,
    "positive": _positive,
    "rank": _rank,
    "contained": _contained,
    "minimum": _minimum,
    "knots": _knots,
    "matrices": _matrices,
    "number": _number,
    "coefficient": _coefficient,
}
