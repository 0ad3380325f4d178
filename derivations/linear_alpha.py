"""alpha^2 that is linear along the contact: what it makes of the conditions, and how splines are multiplied by it.

Let s go from 0 to 1 along v, and p1(v) = -(a0 (1 - s) + a1 s), so that a0 and a1 are alpha^2 at both ends. The
conditions of contact hold for functions of v (`contact_conditions`), and q1 = 0 keeps them without derivatives by v:
at each v the rows are those of the constant a = a0 (1 - s) + a1 s. So a monomial a^i p2^j of the rows becomes

    sum_k binom(i, k) a0^(i - k) a1^k  *  (1 - s)^(i - k) s^k  *  (the curve of the constant monomial),

and what is left to derive is the product of a B-spline curve with 1 - s and with s. It has one degree more, and each
inner knot once more: the curve is as smooth there as before. Row r holds p1^r: its degree rises by r.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from typing import Any

from sympy import Expr, Matrix, Symbol, cancel, expand, sympify

from semispline.derivations.contact import A, chain_table
from semispline.derivations.splines import X, basis_pieces, exact_knots

A0, A1, S = Symbol("a0", positive=True), Symbol("a1", positive=True), Symbol("s")


def linear_powers(order: int) -> tuple[tuple[int, int, int, int], ...]:
    """Return (i, i0, i1, c) of a^i = sum c a0^i0 a1^i1 (1 - s)^i0 s^i1, for i = 0..order.

    Examples
    --------
    >>> linear_powers(2)
    ((0, 0, 0, 1), (1, 1, 0, 1), (1, 0, 1, 1), (2, 2, 0, 1), (2, 1, 1, 2), (2, 0, 2, 1))
    """
    return tuple((i, i - k, k, comb(i, k)) for i in range(order + 1) for k in range(i + 1))


def power_residual(order: int) -> Expr:
    """Return a^order with a = a0 (1 - s) + a1 s, less the sum that `linear_powers` states: zero.

    Examples
    --------
    >>> power_residual(3)
    0
    """
    terms = [row for row in linear_powers(order) if row[0] == order]
    stated = sum((c * A0**i0 * A1**i1 * (1 - S) ** i0 * S**i1 for _, i0, i1, c in terms), sympify(0))
    return expand((A0 * (1 - S) + A1 * S) ** order - stated)


def row_degrees(order: int) -> tuple[int, ...]:
    """Return by how much the degree along v of each row 0..n rises: the highest power of a that it holds.

    Row r is a sum of the derivatives D_0..D_r. A p2 that is a multiple of a counts as a.

    Examples
    --------
    >>> row_degrees(4)
    (0, 1, 2, 3, 4)
    """
    tables = chain_table(order)
    return tuple(
        max(
            i + j
            for (i, j), table in tables.items()
            if any(table[k, d] != 0 for k in range(r + 1) for d in range(order + 1))
        )
        for r in range(order + 1)
    )


def raised_knots(knots: Sequence[Any]) -> tuple[Expr, ...]:
    """Return the knots of a product with a linear function: each distinct knot once more.

    Examples
    --------
    >>> raised_knots([0, 0, "t", 1, 1])
    (0, 0, 0, t, t, 1, 1, 1)
    """
    raised: list[Expr] = []
    for knot in exact_knots(knots):
        if not raised or raised[-1] != knot:
            raised.append(knot)
        raised.append(knot)
    return tuple(raised)


def linear_product(degree: int, knots: Sequence[Any], at_start: Any, at_end: Any) -> Matrix:
    """Return the matrix from the control points of a spline to those of its product with a linear function.

    Parameters
    ----------
    degree : int
        q of the spline.
    knots : sequence, length n + q + 1
        Clamped; numbers, fractions or symbols in ascending order.
    at_start, at_end : number or Expr
        Values of the linear function g at both ends of the domain: 1 and 0 give 1 - s, 0 and 1 give s, 1 and 1 raise
        the degree.

    Returns
    -------
    Matrix, shape (n', n)
        Over `raised_knots`, W: row j is 1/(q + 1) sum_r g(W[j + r]) F(W[j + 1] .. W[j + q + 1] without W[j + r]), with
        F the blossom of the spline where function j begins.

    Notes
    -----
    The blossom of a product of degree q + 1 is symmetric in its arguments and affine in each, equal to g F where all
    are equal: the mean over which argument g takes has these properties.

    Examples
    --------
    >>> linear_product(1, [0, 0, 1, 1], 0, 1)
    Matrix([
    [  0, 0],
    [1/2, 0],
    [  0, 1]])
    """
    old, new = exact_knots(knots), raised_knots(knots)
    start, end = old[0], old[-1]
    first, last = sympify(at_start), sympify(at_end)
    n, count = len(old) - degree - 1, len(new) - degree - 2
    matrix = Matrix.zeros(count, n)
    for j in range(count):
        span = _span_at(degree, old, new[j])
        window = new[j + 1 : j + degree + 2]
        for r in range(degree + 1):
            value = first + (last - first) * (window[r] - start) / (end - start)
            rest = [*window[:r], *window[r + 1 :]]
            for i, weight in enumerate(_blossom_weights(degree, old, span, rest)):
                matrix[j, span - degree + i] += value * weight / (degree + 1)
    return matrix.applyfunc(cancel)


def product_residuals(degree: int, knots: Sequence[Any], at_start: Any, at_end: Any) -> tuple[Expr, ...]:
    """Return what the product over its own basis lacks, for each span and control point: zeros.

    Source: both bases by Cox-de Boor, `basis_pieces`.
    """
    matrix = linear_product(degree, knots, at_start, at_end)
    old = exact_knots(knots)
    g = sympify(at_start) + (sympify(at_end) - at_start) * (X - old[0]) / (old[-1] - old[0])
    residuals = []
    for before, after in zip(basis_pieces(degree, old), basis_pieces(degree + 1, raised_knots(knots)), strict=True):
        for i in range(len(old) - degree - 1):
            r = i - before.first
            known = g * before.pieces[r].as_expr() if 0 <= r <= degree else sympify(0)
            made = (matrix[after.first + k, i] * piece.as_expr() for k, piece in enumerate(after.pieces))
            residuals.append(cancel(sum(made, -known)))
    return tuple(residuals)


def conditions_residual(order: int) -> Matrix:
    """Return D_0..D_n for a = a0 (1 - s) + a1 s less their sum over the monomials of `linear_powers`: zeros.

    Column d belongs to the d-th derivative of the base across the contact.
    """
    p2 = Symbol("p2")
    powers = linear_powers(order)
    residual = Matrix.zeros(order + 1, order + 1)
    for (i, j), table in chain_table(order).items():
        terms = [c * A0**i0 * A1**i1 * (1 - S) ** i0 * S**i1 for power, i0, i1, c in powers if power == i]
        residual += table * (A**i * p2**j).subs(A, A0 * (1 - S) + A1 * S) - table * sum(terms, sympify(0)) * p2**j
    return residual.applyfunc(expand)


def _span_at(degree: int, knots: Sequence[Expr], start: Expr) -> int:
    """Return the index k of the non-empty span [t_k, t_(k+1)) that begins at a knot, the last one at the end."""
    last = len(knots) - degree - 2
    return min(max(k for k, knot in enumerate(knots) if knot == start), last)


def _blossom_weights(degree: int, knots: Sequence[Expr], span: int, arguments: Sequence[Expr]) -> list[Expr]:
    """Return the weights of the control points span - degree .. span in the blossom of that span."""
    points = [[sympify(int(i == k)) for k in range(degree + 1)] for i in range(degree + 1)]
    for level, x in enumerate(arguments, 1):
        following = []
        for i in range(degree + 1 - level):
            left, right = knots[span - degree + level + i], knots[span + 1 + i]
            share = (x - left) / (right - left)
            following.append([(1 - share) * p + share * q for p, q in zip(points[i], points[i + 1], strict=True)])
        points = following
    return points[0]
