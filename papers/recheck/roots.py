"""Square roots of positive definite matrices in whole numbers, exact up to a remainder that is told apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import isqrt

from semispline.solver.errors import InputError

_ROOTS = range(16, 257, 16)
_SHIFTS = range(4, 200, 4)


class NotForCoqError(InputError):
    """Something for which no proof could be written."""


Rows = Sequence[Sequence[Fraction]]


def whole_root(entries: Sequence[Sequence[Fraction]]) -> tuple[int, list[list[int]]]:
    """Return s and F, a triangle of whole numbers, with s A = F F^T + E, E with a diagonal that outweighs the rest.

    Raises
    ------
    NotForCoqError
        The matrix is not positive definite, or nearly not.

    Examples
    --------
    >>> scale, root = whole_root([[Fraction(2), Fraction(1)], [Fraction(1), Fraction(2)]])
    >>> 2 * scale > root[0][0] ** 2
    True
    """
    for shift in _SHIFTS:
        less = 1 - Fraction(1, 2**shift)
        lowered = [[x * less if i == j else x for j, x in enumerate(row)] for i, row in enumerate(entries)]
        parts = _triangle(lowered)
        if parts is not None:
            break
    else:
        raise NotForCoqError("a matrix: found no positive definite one")
    lower, pivots = parts
    for bits in _ROOTS:
        root = [
            [_root(x * abs(x) * pivots[j] * 4**bits) for j, x in enumerate(row[: i + 1])] for i, row in enumerate(lower)
        ]
        if all(own > sum(map(abs, others)) for own, others in remainder(entries, 4**bits, root)):
            return 4**bits, root
    raise NotForCoqError("a matrix: found no square root of whole numbers that is near enough")


def _root(square: Fraction) -> int:
    """Return the square root of a number, rounded, with the sign of the number."""
    found = isqrt(abs(square.numerator) // square.denominator)
    return found if square >= 0 else -found


def _triangle(entries: Sequence[Sequence[Fraction]]) -> tuple[list[list[Fraction]], list[Fraction]] | None:
    """Return L and D of L D L^T, or None where the matrix is not positive definite."""
    work = [list(row) for row in entries]
    size = len(work)
    lower = [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]
    pivots = []
    for n in range(size):
        pivot = work[n][n]
        if pivot <= 0:
            return None
        pivots.append(pivot)
        for r in range(n + 1, size):
            factor = work[r][n] / pivot
            lower[r][n] = factor
            if factor:
                for c in range(n, size):
                    work[r][c] -= factor * work[n][c]
    return lower, pivots


def remainder(
    entries: Sequence[Sequence[Fraction]], scale: int, root: Sequence[Sequence[int]]
) -> Iterator[tuple[Fraction, list[Fraction]]]:
    """Yield the diagonal entry of each row of E, and the others."""
    for i, row in enumerate(entries):
        rest = [scale * x - sum(a * b for a, b in zip(root[i], root[j], strict=False)) for j, x in enumerate(row)]
        yield rest[i], rest[:i] + rest[i + 1 :]
