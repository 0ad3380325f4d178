"""A quartic in two variables is positive on a square: proof by sums of squares.

f = z'Q0z + (1 - x^2) l'Q1l + (1 - y^2) l'Q2l with z = (1, x, y, x^2, x y, y^2), l = (1, x, y) and positive definite
Q0, Q1, Q2 is positive on [-1, 1] x [-1, 1]. A square of a quadratic has this form as soon as the least constant is
added; boxes alone would have to follow the whole curve on which it vanishes.

The matrices come from a barrier method in long floats (the barrier's Hessian goes with the square of a margin that may
be 1e-10 and less), and are made exact before anybody relies on them.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import combinations_with_replacement
from typing import TypeAlias

from flint import arb, arb_mat, ctx, fmpq, fmpq_mat

from semispline.solver.proof.certificates import Gram

Exponents: TypeAlias = tuple[int, int]

_MONOMIALS: tuple[Exponents, ...] = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
_DEGREE = 4
# Q0, Q1 and Q2 are blocks on one diagonal: where each begins, and its size.
_BLOCKS = ((0, 6), (6, 3), (9, 3))
_SIZE = 12
_BITS = 800
_NEWTON_STEPS = 400
_CENTRED = 0.25
_FASTER = 20
_PRECISION = 1e10


@dataclass(frozen=True)
class NoSquares:
    """No sums of squares were found.

    Attributes
    ----------
    lowest : (float, float)
        Where the polynomial may be least, in [-1, 1] x [-1, 1].
    """

    lowest: tuple[float, float]


def gram_matrices(table: fmpq_mat) -> tuple[Gram, Gram, Gram] | NoSquares:
    """Return Q0, Q1, Q2 for the quartic sum [i, j] x^i y^j, exact and definite, if there are any.

    Source: J. B. Lasserre, Global optimization with polynomials and the problem of moments, SIAM J. Optim. 11 (2001),
    for the form and the point; Yu. Nesterov and A. Nemirovskii, Interior-point polynomial algorithms (1994), for the
    steps.

    Examples
    --------
    >>> grams = gram_matrices(fmpq_mat(3, 2, [1, 0, -1, 0, 1, 0]))  # 1 - x + x^2
    >>> [len(gram) for gram in grams]
    [6, 3, 3]
    >>> lowest, _ = gram_matrices(fmpq_mat(3, 2, [-1, 0, -1, 0, 2, 0])).lowest  # -1 - x + 2 x^2
    >>> round(lowest, 9)
    0.25
    """
    wanted = {(i, j): table[i, j] for i in range(table.nrows()) for j in range(table.ncols()) if table[i, j] != 0}
    scale = max((abs(c) for c in wanted.values()), default=fmpq(0))
    if scale == 0 or any(i + j > _DEGREE for i, j in wanted):
        return NoSquares((0.0, 0.0))
    found = _spread({exponents: c / scale for exponents, c in wanted.items()})
    with ctx.workprec(_BITS):
        weights = _definite(found)
    if isinstance(weights, NoSquares):
        return weights
    for weight, direction in zip(weights, _directions(), strict=True):
        found = found + direction * weight
    blocks = [fmpq_mat(n, n, [found[at + i, at + j] for i in range(n) for j in range(n)]) for at, n in _BLOCKS]
    if not all(_is_definite(block) for block in blocks):
        return NoSquares((0.0, 0.0))
    q0, q1, q2 = (_as_fractions(block * scale) for block in blocks)
    return q0, q1, q2


def _definite(start: fmpq_mat) -> list[fmpq] | NoSquares:
    """Return what to add of each direction to make `start` definite.

    The least tau is sought for which the polynomial plus tau is a sum of squares; the search ends where it is negative.
    """
    directions = [arb_mat(d) for d in (*_directions(), _one())]
    count = len(directions)
    flat = arb_mat(count, _SIZE**2, [e for d in directions for e in d.entries()])
    largest = max(sum((abs(start[i, j]) for j in range(_SIZE)), fmpq(0)) for i in range(_SIZE))
    # The least eigenvalue of one is 1/16.
    point = arb_mat(count, 1, [arb(0)] * (count - 1) + [arb(16 * (1 + largest))])
    current, weight = arb_mat(start), arb(1)
    for _ in range(_NEWTON_STEPS):
        matrix = current + arb_mat(_SIZE, _SIZE, (point.transpose() * flat).entries())
        inverse = _middle(matrix.inv())
        turned = [inverse * d for d in directions]
        gradient = [-t.trace() for t in turned]
        gradient[-1] += weight
        left = arb_mat(count, _SIZE**2, [e for t in turned for e in t.entries()])
        right = arb_mat(count, _SIZE**2, [e for t in turned for e in t.transpose().entries()])
        slope = arb_mat(count, 1, gradient)
        step = _middle((left * right.transpose()).solve(slope))
        decrement = max(float((slope.transpose() * step)[0, 0]), 0.0) ** 0.5
        # Damped like this, a step never leaves the cone.
        point = _middle(point - step * arb(1 / (1 + decrement) if decrement > _CENTRED else 1))
        if point[count - 1, 0] < 0:
            return [_exactly(point[i, 0]) for i in range(count - 1)]
        if decrement <= _CENTRED:
            # Near the centre tau is about size / weight above the least one, and the inverse has the moments of the
            # points where the polynomial is least.
            if point[count - 1, 0] > _PRECISION * _SIZE / weight:
                x, y = (float(inverse[0, k] / inverse[0, 0]) for k in (1, 2))
                return NoSquares((min(max(x, -1.0), 1.0), min(max(y, -1.0), 1.0)))
            weight *= _FASTER
    return NoSquares((0.0, 0.0))


def _middle(matrix: arb_mat) -> arb_mat:
    """Forget the rounding bounds: the search needs none, and its result is checked."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [e.mid() for e in matrix.entries()])


def _exactly(x: arb) -> fmpq:
    mantissa, exponent = x.mid().man_exp()
    return fmpq(mantissa) * fmpq(2) ** int(exponent)


def _as_fractions(matrix: fmpq_mat) -> Gram:
    return tuple(tuple(Fraction(int(e.p), int(e.q)) for e in row) for row in matrix.tolist())


def _is_definite(matrix: fmpq_mat) -> bool:
    """Sylvester's criterion."""
    return all(
        fmpq_mat(n, n, [matrix[i, j] for i in range(n) for j in range(n)]).det() > 0
        for n in range(1, matrix.nrows() + 1)
    )


@cache
def _directions() -> tuple[fmpq_mat, ...]:
    """Return all directions that leave the polynomial as it is."""
    inner = []
    for first, *others in _pairs().values():
        for other in others:
            direction = fmpq_mat(_SIZE, _SIZE)
            for (i, j), sign in ((first, 1), (other, -1)):
                direction[i, j] = direction[j, i] = fmpq(sign) if i == j else fmpq(sign, 2)
            inner.append(direction)
    return (*inner, *(_growth(block, i, j) for block in (1, 2) for i, j in combinations_with_replacement(range(3), 2)))


def _growth(block: int, i: int, j: int) -> fmpq_mat:
    """Return the direction in which entries (i, j) and (j, i) of Q1 or Q2 grow and Q0 pays for it."""
    product = _sum(_MONOMIALS[i], _MONOMIALS[j])
    entries = 1 if i == j else 2
    square = (2, 0) if block == 1 else (0, 2)
    found = _spread({product: fmpq(-entries), _sum(product, square): fmpq(entries)})
    at = _BLOCKS[block][0]
    found[at + i, at + j] = found[at + j, at + i] = fmpq(1)
    return found


@cache
def _one() -> fmpq_mat:
    """Return definite matrices of the polynomial 1, with (1 - x^2) (4 + x^2 + y^2) / 16 and its mirror image."""
    found = fmpq_mat(_SIZE, _SIZE)
    for i, sixteenths in enumerate((8, 2, 2, 1, 2, 1, 4, 1, 1, 4, 1, 1)):
        found[i, i] = fmpq(sixteenths, 16)
    return found


@cache
def _pairs() -> dict[Exponents, list[tuple[int, int]]]:
    """Return the entries of Q0 that make up each monomial."""
    found: dict[Exponents, list[tuple[int, int]]] = {}
    for i, j in combinations_with_replacement(range(6), 2):
        found.setdefault(_sum(_MONOMIALS[i], _MONOMIALS[j]), []).append((i, j))
    return found


def _spread(coefficients: dict[Exponents, fmpq]) -> fmpq_mat:
    """Return a Q0 of the polynomial, each coefficient divided among the entries that make it up."""
    found = fmpq_mat(_SIZE, _SIZE)
    for exponents, c in coefficients.items():
        pairs = _pairs()[exponents]
        entries = sum(1 if i == j else 2 for i, j in pairs)
        for i, j in pairs:
            found[i, j] = found[j, i] = found[i, j] + c / entries
    return found


def _sum(one: Exponents, other: Exponents) -> Exponents:
    return one[0] + other[0], one[1] + other[1]
