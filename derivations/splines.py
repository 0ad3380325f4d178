"""B-spline pieces by Cox-de Boor over exact knots (rational or symbolic), and derivatives at a clamped end.

Everything is exact: a piece is a polynomial whose coefficients are rational functions of the knots in normal form
(numerator and denominator without common factor), so that two equal things are the same thing.

Source: C. de Boor, A Practical Guide to Splines, ch. IX (recurrence) and X (derivatives).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from keyword import iskeyword
from typing import Any

from sympy import Expr, Float, ImmutableMatrix, Matrix, Poly, Rational, Symbol, cancel, diag, factor, factorial, sympify
from sympy.polys.constructor import construct_domain

X = Symbol("x")


@dataclass(frozen=True)
class Span:
    """One polynomial span of a basis: on [start, end) basis function `first` + r is `pieces[r]`, the others vanish.

    Parameters
    ----------
    start, end : Expr
        Neighbouring distinct knots.
    first : int
        Index of the first basis function that lives here.
    pieces : tuple of Poly, length degree + 1
        Polynomials in x.
    """

    start: Expr
    end: Expr
    first: int
    pieces: tuple[Poly, ...]


def exact_knots(knots: Sequence[Any]) -> tuple[Expr, ...]:
    """Return knots as exact SymPy expressions.

    Parameters
    ----------
    knots : sequence
        Integers, fractions, expressions, or strings: "1/3", "0.25" (which is exactly 1/4), the name of a symbol.

    Raises
    ------
    ValueError
        A float (its decimals are not what it holds: write a fraction or a string), or rational knots that decrease.

    Examples
    --------
    >>> exact_knots([0, "1/3", "t", 1])
    (0, 1/3, t, 1)
    """
    exact = tuple(_exact(knot, index) for index, knot in enumerate(knots))
    numbers = [(index, knot) for index, knot in enumerate(exact) if knot.is_Rational]
    for (_, left), (index, right) in pairwise(numbers):
        if right < left:
            raise ValueError(f"knots[{index}]: found {right} after {left}, expected a non-decreasing vector")
    return exact


def _exact(knot: Any, index: int) -> Expr:
    if isinstance(knot, str):
        if knot.isidentifier() and knot != X.name and not iskeyword(knot):
            return Symbol(knot)
        try:
            return Rational(Fraction(knot))
        except (ValueError, ZeroDivisionError):
            raise ValueError(f"knots[{index}]: found {knot!r}, expected an integer, a fraction or a name") from None
    value = sympify(knot)
    if value.has(Float) or X in value.free_symbols or (value.is_number and not value.is_Rational):
        raise ValueError(f"knots[{index}]: found {knot!r}, expected an integer, a fraction or a symbol other than x")
    return value


def basis_pieces(degree: int, knots: Sequence[Any]) -> tuple[Span, ...]:
    """Return the basis of `degree` over `knots`, span by span.

    Parameters
    ----------
    degree : int
        At least 0.
    knots : sequence, length n + degree + 1
        Full knot vector of integers, fractions or symbols, in ascending order. Different symbols are different
        knots; a multiple knot is the same symbol again.

    Returns
    -------
    tuple of Span
        The non-empty spans of the domain, from left to right.

    Raises
    ------
    ValueError
        Floats, decreasing rational knots, or too few knots.

    Source: Cox-de Boor recurrence, 0/0 read as 0.

    Examples
    --------
    >>> span = basis_pieces(1, [0, 0, 2, 2])[0]
    >>> [piece.as_expr() for piece in span.pieces]
    [1 - x/2, x/2]
    """
    exact = exact_knots(knots)
    if degree < 0 or len(exact) < 2 * degree + 2:
        raise ValueError(f"knots: {len(exact)} knots for degree {degree}, expected at least {2 * degree + 2}")
    domain, elements = construct_domain(list(exact), field=True)
    spans = []
    for k in range(degree, len(exact) - degree - 1):
        if elements[k] != elements[k + 1]:
            pieces = _span_pieces(degree, elements, k, domain)
            spans.append(Span(exact[k], exact[k + 1], k - degree, pieces))
    return tuple(spans)


def _span_pieces(degree: int, knots: list[Any], k: int, domain: Any, highest: int | None = None) -> tuple[Poly, ...]:
    """Run Cox-de Boor on span k; `knots` are elements of `domain`, a field; powers above `highest` are left out."""
    zero = Poly(0, X, domain=domain)
    pieces = [Poly(1, X, domain=domain)]
    for d in range(1, degree + 1):
        # pieces[r] belongs to function k - d + 1 + r of degree d - 1; the outer neighbours vanish on this span.
        lower = [zero, *pieces, zero]
        pieces = []
        for r in range(d + 1):
            i = k - d + r
            total = zero
            if r > 0 and knots[i + d] != knots[i]:
                total += lower[r] * _line(domain.one, -knots[i], knots[i + d] - knots[i], domain)
            if r < d and knots[i + d + 1] != knots[i + 1]:
                total += lower[r + 1] * _line(-domain.one, knots[i + d + 1], knots[i + d + 1] - knots[i + 1], domain)
            pieces.append(total if highest is None else total.rem(Poly(X ** (highest + 1), X, domain=domain)))
    return tuple(pieces)


def _line(slope: Any, constant: Any, width: Any, domain: Any) -> Poly:
    """Return (slope x + constant) / width."""
    return Poly.from_list([slope / width, constant / width], X, domain=domain)


def evaluate_exact(degree: int, knots: Sequence[Any], coefficients: Sequence[Any], x: Any, derivative: int = 0) -> Expr:
    """Return a spline or one of its derivatives at x, exactly; right-continuous, left at the end of the domain.

    Parameters
    ----------
    degree : int
    knots : sequence, length n + degree + 1
        Rational.
    coefficients : sequence, length n
        Rational or symbolic.
    x : number
        Rational, inside the domain.
    derivative : int

    Raises
    ------
    ValueError
        Wrong number of coefficients, or x outside the domain.

    Examples
    --------
    >>> evaluate_exact(2, [0, 0, 0, 1, 1, 1], [1, 2, 4], "1/3")
    16/9
    """
    if len(coefficients) != len(knots) - degree - 1:
        expected = len(knots) - degree - 1
        raise ValueError(f"coefficients: {len(coefficients)} for {len(knots)} knots, expected {expected}")
    spans = basis_pieces(degree, knots)
    (point,) = exact_knots([x])
    if not spans[0].start <= point <= spans[-1].end:
        raise ValueError(f"x: found {point}, expected a parameter in [{spans[0].start}, {spans[-1].end}]")
    span = next((span for span in spans if span.start <= point < span.end), spans[-1])
    values = [_derivative(piece, derivative).eval(point) for piece in span.pieces]
    return sum((sympify(coefficients[span.first + r]) * value for r, value in enumerate(values)), sympify(0))


def _derivative(piece: Poly, order: int) -> Poly:
    return piece.diff((X, order)) if order else piece


def span_symbols(order: int, letter: str = "h") -> tuple[Symbol, ...]:
    """Return the symbols h1..h_order for h_r = U[p + r] - U[p], the distances from a clamped end.

    Examples
    --------
    >>> span_symbols(2)
    (h1, h2)
    """
    return tuple(Symbol(f"{letter}{r}", positive=True) for r in range(1, order + 1))


def end_derivatives(order: int, degree: Any, spans: Sequence[Any]) -> Matrix:
    """Return the derivatives at the clamped start as combinations of the first rows, in closed form.

    Parameters
    ----------
    order : int
        Highest derivative n.
    degree : int or Expr
        p; may be a symbol.
    spans : sequence, length n
        h_1..h_n with h_r = U[p + r] - U[p].

    Returns
    -------
    Matrix, shape (n + 1, n + 1)
        Entry [d, i] is the coefficient of row i in the d-th derivative. At the clamped end of the domain the same
        matrix holds with rows and spans counted from the end, and the sign (-1)^d.

    Notes
    -----
    A degree below d makes row d vanish, whatever the spans are: each entry of row d carries p (p - 1) .. (p - d + 1).
    So a spline with fewer than n + 1 rows, or with too few knots for h_n, is no special case: any positive number
    stands for a span that does not exist (for instance the whole length of the domain).

    Source: difference form of the derivative, proved here by `end_derivative_step` for every degree.

    Examples
    --------
    >>> end_derivatives(1, Symbol("p"), span_symbols(1))
    Matrix([
    [    1,    0],
    [-p/h1, p/h1]])
    """
    p = sympify(degree)
    h = [sympify(span) for span in spans[:order]]
    # points[i] holds the coefficients of control point i of the d-th derivative over the rows 0..n.
    points = [[sympify(int(i == j)) for j in range(order + 1)] for i in range(order + 1)]
    rows = [points[0]]
    for d in range(order):
        # Control point i of derivative d + 1 is (p - d) (Q_{i+1} - Q_i) / (U[i+p+1] - U[i+d+1]), the width h_{i+1}.
        points = [
            [(p - d) * (right - left) / h[i] for left, right in zip(points[i], points[i + 1], strict=True)]
            for i in range(len(points) - 1)
        ]
        rows.append(points[0])
    return Matrix(order + 1, order + 1, [factor(entry) for row in rows for entry in row])


def end_derivatives_from_pieces(order: int, degree: int, end: str = "start") -> Matrix:
    """Return the same matrix read off the Cox-de Boor pieces next to a clamped end, over symbolic spans.

    Parameters
    ----------
    order : int
    degree : int
        A number, at least 1.
    end : {"start", "end"}
        At "end", rows are counted from the last one and h_r = U[-1 - p] - U[-1 - p - r].

    Returns
    -------
    Matrix, shape (order + 1, order + 1)
        Columns of rows that a spline of this degree does not have next to its end are zero.

    Notes
    -----
    The clamped knot is the origin of x: a translation, which changes no difference of knots.

    Examples
    --------
    >>> end_derivatives_from_pieces(1, 3, "end")
    Matrix([
    [   1,     0],
    [3/h1, -3/h1]])
    """
    return _read_off(order, degree, _end_sign(end)).as_mutable()


@cache
def _read_off(order: int, degree: int, sign: int) -> ImmutableMatrix:
    """Return `end_derivatives_from_pieces`, once: contact of many pairs of degrees asks for the same few."""
    h = span_symbols(degree)
    clamped = [sympify(0)] * (degree + 1)
    # One span is enough: the one next to the end, whose pieces see h_1..h_p only.
    if sign > 0:
        knots, span = [*clamped, *h], degree
    else:
        knots, span = [*(-width for width in reversed(h)), *clamped], degree - 1
    domain, elements = construct_domain(knots, field=True)
    # The derivatives are those at the origin: no more powers are needed.
    pieces = _span_pieces(degree, elements, span, domain, order)
    if sign < 0:
        pieces = pieces[::-1]
    matrix = Matrix.zeros(order + 1, order + 1)
    for i, piece in enumerate(pieces[: order + 1]):
        for d in range(min(order, degree) + 1):
            matrix[d, i] = factor(piece.coeff_monomial(X**d) * factorial(d))
    return matrix.as_immutable()


def end_derivative_step(order: int, end: str = "start") -> Matrix:
    """Return what the closed form lacks to pass from degree p to p + 1 in Cox-de Boor: zero, for a symbol p.

    Parameters
    ----------
    order : int
    end : {"start", "end"}

    Returns
    -------
    Matrix, shape (order + 1, order + 1)
        Entry [d, i]: d-th derivative of function i of degree p + 1 by the recurrence, minus the closed form.

    Notes
    -----
    Put the clamped start at the origin. Over a vector whose first p + 2 knots lie there, function i of degree p + 1
    is, on the first span,

        f_i <- (x / h_i) f_(i-1) + (1 - x / h_(i+1)) f_i,

    where the f on the right have degree p over the same vector without its first knot: same end, same spans h_r.
    (For i = p + 1 and beyond the knots in the second factor are others, but there f_i is zero, as the closed form
    says.) For degree 0, f_0 = 1 and the rest are zero, which is the closed form too. With this matrix zero, the
    closed form holds for every degree. At the clamped end the two factors of the recurrence change places and x
    changes sign.

    Examples
    --------
    >>> end_derivative_step(2).is_zero_matrix
    True
    """
    p = Symbol("p", positive=True)
    h = span_symbols(order + 1)
    sign = _end_sign(end)
    signs = diag(*(sign**d for d in range(order + 1)))
    known, target = signs * end_derivatives(order, p, h), signs * end_derivatives(order, p + 1, h)

    def derivative_at_end(d: int, i: int) -> Expr:
        # Leibniz on the right-hand side at x = 0: only the first derivative of a factor is not zero.
        total = known[d, i]
        if d:
            total -= sign * d * known[d - 1, i] / h[i]
            if i:
                total += sign * d * known[d - 1, i - 1] / h[i - 1]
        return total

    return Matrix(order + 1, order + 1, lambda d, i: cancel(derivative_at_end(d, i) - target[d, i]))


def _end_sign(end: str) -> int:
    if end not in ("start", "end"):
        raise ValueError(f"end: found {end!r}, expected 'start' or 'end'")
    return 1 if end == "start" else -1
