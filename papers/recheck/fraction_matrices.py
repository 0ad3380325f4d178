"""Matrices of fractions: product, inverse, determinant."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

Rows: TypeAlias = Sequence[Sequence[Fraction]]


def product(one: Rows, other: Rows) -> list[list[Fraction]]:
    """Return the product of two matrices."""
    columns = list(zip(*other, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in one]


def inverse(rows: Rows) -> list[list[Fraction]]:
    """Return the inverse of a square matrix, by elimination.

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


def determinant(matrix: Rows) -> Fraction:
    """Return the determinant of a square matrix, by elimination."""
    rows = [list(row) for row in matrix]
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
