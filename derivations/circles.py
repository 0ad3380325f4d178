"""Circles that are smooth in homogeneous coordinates: squares of complex splines, exactly.

For a complex polynomial z(s) the curve (x + i y, w) = (z^2, |z|^2) lies on the circle x^2 + y^2 = w^2. Let z be the
uniform B-spline of degree m with the control points 1, i, -1, -i, 1, ..: each span turns z by a quarter, and its square
by a half turn, so that two spans are the full circle. z is C^(m-1) at its knots, and at the seam of the circle too,
because the next spans are the first ones times i. So the square is C^(m-1) everywhere, of degree 2 m, with rational
coefficients. Standard circles of seven or nine points are only continuous there.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import comb
from typing import Any

from sympy import Expr, I, Integer, Rational, Symbol, expand, im, re

from semispline.derivations.bezier import blossom

S = Symbol("s", real=True)


def uniform_pieces(degree: int, points: Sequence[Any]) -> tuple[tuple[Expr, ...], ...]:
    """Return the Bezier control points of each span of a uniform spline, whose knots are whole numbers.

    Examples
    --------
    >>> uniform_pieces(2, [0, 2, 4])
    ((1, 2, 3),)
    """
    count = len(points) - degree
    return tuple(
        tuple(
            _uniform_blossom(degree, points[k : k + degree + 1], [Integer(0)] * (degree - j) + [Integer(1)] * j)
            for j in range(degree + 1)
        )
        for k in range(count)
    )


def _uniform_blossom(degree: int, points: Sequence[Any], arguments: Sequence[Expr]) -> Expr:
    """Return the blossom of the piece over [0, 1], by de Boor's steps with the knots 1 - degree .. degree."""
    level = list(points)
    for step, x in enumerate(arguments, 1):
        width = degree + 1 - step
        level = [(level[i] * (i + 1 - x) + level[i + 1] * (x - (i + 1 - width))) / Integer(width) for i in range(width)]
    return expand(level[0])


def bernstein_product(a: Sequence[Any], b: Sequence[Any]) -> tuple[Expr, ...]:
    """Return the Bezier control points of the product of two Bezier polynomials.

    Examples
    --------
    >>> bernstein_product([0, 1], [1, 0])
    (0, 1/2, 0)
    """
    m, n = len(a) - 1, len(b) - 1
    result = [Integer(0)] * (m + n + 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += Rational(comb(m, i) * comb(n, j), comb(m + n, i + j)) * x * y
    return tuple(expand(value) for value in result)


def half_turns(degree: int, count: int) -> tuple[tuple[tuple[Expr, Expr, Expr], ...], ...]:
    """Return the Bezier points (x, y, w) of each half turn of the circle: it begins at (1, 0), with weight 1.

    Parameters
    ----------
    degree : int
        m of the spline whose square it is.
    count : int
        Half turns; 2 are the full circle.

    Examples
    --------
    >>> half_turns(1, 1)
    (((1, 0, 1), (0, 1, 0), (-1, 0, 1)),)
    """
    pieces = uniform_pieces(degree, [I**k for k in range(count + degree)])
    first = pieces[0][0]
    size = expand(first * first.conjugate())
    result = []
    for piece in pieces:
        # z / z(0) begins at 1.
        z = [expand(value * first.conjugate()) / size for value in piece]
        square = bernstein_product(z, z)
        weight = bernstein_product(z, [value.conjugate() for value in z])
        result.append(tuple((re(p), im(p), re(w)) for p, w in zip(square, weight, strict=True)))
    return tuple(result)


def circle_points(degree: int, count: int = 2) -> tuple[tuple[Expr, Expr, Expr], ...]:
    """Return the B-spline control points (x, y, w): degree 2 m, each inner knot m + 1 times.

    Parameters
    ----------
    degree, count : int
        As for `half_turns`; the spline's knots are 0, 1, .., count.

    Examples
    --------
    >>> circle_points(3)[:6]
    ((1, 0, 1), (1, 1/2, 1), (13/20, 1, 19/20), (0, 49/40, 9/10), (-13/20, 1, 19/20), (-27/20, 0, 21/20))
    """
    pieces, m = half_turns(degree, count), degree
    knots = [0] * (2 * m + 1)
    for k in range(1, count):
        knots += [k] * (m + 1)
    knots += [count] * (2 * m + 1)
    result = []
    for j in range(len(knots) - 2 * m - 1):
        # The last span that begins with knot j; any span in the support of the basis function would do.
        k = min(knots[j], count - 1)
        arguments = [Integer(t - k) for t in knots[j + 1 : j + 2 * m + 1]]
        result.append(tuple(expand(blossom([p[d] for p in pieces[k]], arguments)) for d in range(3)))
    return tuple(result)


def circle_residuals(degree: int, count: int = 2) -> dict[str, tuple[Expr, ...]]:
    """Return what must vanish: x^2 + y^2 - w^2 on each half turn, and the jumps of each derivative up to m - 1.

    "seam" are the jumps from the end of two half turns back to their start.

    Examples
    --------
    >>> {name: set(values) for name, values in circle_residuals(3).items()}
    {'circle': {0}, 'joints': {0}, 'seam': {0}}
    """
    pieces = half_turns(degree, count)
    circle = []
    for piece in pieces:
        x, y, w = ([point[d] for point in piece] for d in range(3))
        squares = (bernstein_product(x, x), bernstein_product(y, y), bernstein_product(w, w))
        circle += [a + b - c for a, b, c in zip(*squares, strict=True)]
    joints = [jump for one, other in pairwise(pieces) for jump in jumps(one, other, degree - 1)]
    seam = jumps(pieces[1], pieces[0], degree - 1) if count == 2 else ()
    return {"circle": tuple(circle), "joints": tuple(joints), "seam": tuple(seam)}


def jumps(
    before: Sequence[Sequence[Expr]], after: Sequence[Sequence[Expr]], order: int, least: int = 0
) -> tuple[Expr, ...]:
    """Return the jumps of the derivatives of orders `least` to `order` between two Bezier pieces of one length.

    Differences stand for the derivatives: they have the same factors on both sides.

    Examples
    --------
    >>> jumps([(0,), (1,)], [(1,), (3,)], 1)
    (0, 1)
    """
    result = []
    for d in range(least, order + 1):
        for c in range(len(before[0])):
            end = sum((-1) ** (d - i) * comb(d, i) * before[len(before) - 1 - d + i][c] for i in range(d + 1))
            start = sum((-1) ** (d - i) * comb(d, i) * after[i][c] for i in range(d + 1))
            result.append(expand(start - end))
    return tuple(result)
