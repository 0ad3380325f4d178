"""The least energy of a blend as a polynomial in its shape parameters a = alpha^2 and b = beta^2.

For given a and b the prescribed rows are polynomials in a and in b (contact rows), and the free rows solve a linear
system whose right side is linear in the prescribed ones (stationarity). So all control points of the best blend are

    P(a, b) = sum_k m_k Z_k,    m = (1, x, .., x^n_a, y, .., y^n_b),    x = a - a0, y = b - b0,

with control points Z_k that do not depend on a and b, and the energy is the quadratic form E = sum_kl S_kl m_k m_l of
the energy products S_kl of the Z_k. n is the order of contact where it is geometric, 0 where a or b is fixed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sympy import Expr, Matrix, Poly, Symbol, binomial, sympify

from semispline.derivations.contact import A, contact_rows

# The powers that a shape parameter may have in the rows: 0 where it is fixed, 1 for G1, 2 for G2.
MAX_POWER = 2


def contact_row_powers(
    order: int, degree: Any, spans: Sequence[Any], base_degree: Any, base_spans: Sequence[Any], centre: Any
) -> tuple[Matrix, ...]:
    """Return the matrices C_0..C_n of contact_rows(a0 + x) = C_0 + x C_1 + .. + x^n C_n.

    Parameters
    ----------
    order, degree, spans, base_degree, base_spans
        As for `contact_rows`.
    centre : Expr
        a0.

    Returns
    -------
    tuple of Matrix, n + 1 of shape (n + 1, n + 1)

    Notes
    -----
    The binomial theorem on each power of a: nothing is cancelled, so the text keeps its accuracy near a0.

    Examples
    --------
    >>> h, H, a0 = Symbol("h1"), Symbol("H1"), Symbol("a0")
    >>> contact_row_powers(1, 3, [h], 3, [H], a0)[1]
    Matrix([
    [    0,      0],
    [h1/H1, -h1/H1]])
    """
    rows = contact_rows(order, degree, spans, base_degree, base_spans)
    a0 = sympify(centre)
    powers = [Matrix.zeros(order + 1, order + 1) for _ in range(order + 1)]
    for i in range(order + 1):
        for j in range(order + 1):
            coefficients = Poly(rows[i, j], A).all_coeffs()[::-1]
            for k in range(order + 1):
                powers[k][i, j] = sum(
                    (c * binomial(n, k) * a0 ** (n - k) for n, c in enumerate(coefficients) if n >= k), sympify(0)
                )
    return tuple(powers)


def shape_monomials(power_a: int, power_b: int) -> tuple[tuple[int, int], ...]:
    """Return the exponents (i, j) of the monomials x^i y^j in m.

    Examples
    --------
    >>> shape_monomials(2, 1)
    ((0, 0), (1, 0), (2, 0), (0, 1))
    """
    return ((0, 0), *((i, 0) for i in range(1, power_a + 1)), *((0, j) for j in range(1, power_b + 1)))


def product_symbol(k: int, j: int) -> Symbol:
    """Return the symbol of the energy product of Z_k and Z_j.

    Examples
    --------
    >>> product_symbol(3, 1)
    S13
    """
    return Symbol(f"S{min(k, j)}{max(k, j)}")


def energy_polynomial(power_a: int, power_b: int) -> Matrix:
    """Return the coefficients of E in x and y: entry [i, j] multiplies x^i y^j.

    Parameters
    ----------
    power_a, power_b : int
        0 where the parameter is fixed (C0, C1, C2, G0), 1 for G1, 2 for G2.

    Returns
    -------
    Matrix, shape (2 power_a + 1, 2 power_b + 1)
        In the symbols S_kl, k <= l.

    Examples
    --------
    >>> energy_polynomial(1, 0)
    Matrix([
    [  S00],
    [2*S01],
    [  S11]])
    """
    monomials = shape_monomials(power_a, power_b)
    table = Matrix.zeros(2 * power_a + 1, 2 * power_b + 1)
    for k, (i, j) in enumerate(monomials):
        for n, (r, s) in enumerate(monomials):
            table[i + r, j + s] += product_symbol(k, n)
    return table


def total_degrees(power_a: int, power_b: int) -> tuple[Expr, Expr]:
    """Return the degree of E in (a, b) together and in (alpha, beta) together.

    Examples
    --------
    >>> total_degrees(2, 2), total_degrees(1, 1)
    ((4, 8), (2, 4))
    """
    table = energy_polynomial(power_a, power_b)
    degree = max(i + j for i in range(table.rows) for j in range(table.cols) if table[i, j] != 0)
    return sympify(degree), sympify(2 * degree)
