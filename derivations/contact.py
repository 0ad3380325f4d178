"""G^n contact of a blend with a base, from the chain rule: conditions for general p_i, q_i; rows P_0..P_n.

Where the sign comes from. The base R(w, v) lives on w >= w_s and the blend P(u, v) on u >= 0, and they share the
curve w = w_s, u = 0. Walking into the blend (u grows) is walking out of the base, so w must *fall* along
P(u, v) = R(w(u, v), v~(u, v)): p1 = w_u < 0. The special choice is p1 = -a with a = alpha^2 > 0, the rest zero.
In general p1 = -a s_P s_R, where s is +1 for a contact at the start and -1 for one at the end of a parameter range;
derivatives *into* each surface are then related by (-a)^d at all four pairs of ends, with the same rows.

Source: equations (15) and (16) and conditions (1.1) to (3.2) of the paper, derived anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from sympy import Expr, Matrix, Poly, Symbol, factor, fraction, sympify, together

from semispline.derivations.splines import end_derivatives, end_derivatives_from_pieces, span_symbols

A = Symbol("a", positive=True)


def base_derivative(i: int, j: int) -> Symbol:
    """Return the symbol for the mixed derivative of R, i times by w and j times by v, along the contact.

    Examples
    --------
    >>> base_derivative(2, 1)
    R_wwv
    """
    return Symbol("R" + "_" * bool(i + j) + "w" * i + "v" * j)


def contact_conditions(order: int) -> tuple[Expr, ...]:
    """Return P, P_u, .., d^n P / du^n along the contact for general reparametrisation functions of v.

    Parameters
    ----------
    order : int
        n.

    Returns
    -------
    tuple of Expr, length n + 1
        In the derivatives R_w, R_v, .. of the base and p_k = d^k w / du^k, q_k = d^k v~ / du^k at u = 0.

    Notes
    -----
    The total derivative by u is a derivation: it sends each derivative of R to w_u times its w-derivative plus v~_u
    times its v-derivative, and w^(k) to w^(k+1). Applied n times to R it gives the chain rule of order n; it is
    evaluated where w = w_s and v~ = v. Mixed derivatives of P need no conditions of their own: they follow
    by differentiating these along v.

    Examples
    --------
    >>> contact_conditions(1)[1]
    R_v*q1 + R_w*p1
    """
    w = [Symbol(f"p{k}") for k in range(1, order + 1)]
    v = [Symbol(f"q{k}") for k in range(1, order + 1)]
    value: Expr = base_derivative(0, 0)
    conditions = [value]
    for _ in range(order):
        total = sympify(0)
        for i in range(order):
            for j in range(order - i):
                slope = value.diff(base_derivative(i, j))
                total += slope * (w[0] * base_derivative(i + 1, j) + v[0] * base_derivative(i, j + 1))
        for functions in (w, v):
            for known, following in pairwise(functions):
                total += value.diff(known) * following
        value = total.expand()
        conditions.append(value)
    return tuple(conditions)


def special_conditions(order: int) -> tuple[Expr, ...]:
    """Return the conditions for p1 = -a, all other p_k and q_k zero.

    Examples
    --------
    >>> special_conditions(2)
    (R, -R_w*a, R_ww*a**2)
    """
    chosen = {Symbol(f"{letter}{k}"): 0 for letter in "pq" for k in range(1, order + 1)} | {Symbol("p1"): -A}
    return tuple(condition.subs(chosen) for condition in contact_conditions(order))


def shape_conditions(order: int) -> tuple[Expr, ...]:
    """Return the conditions for p1 = -a and p2, all other p_k and q_k zero.

    Examples
    --------
    >>> shape_conditions(2)
    (R, -R_w*a, R_w*p2 + R_ww*a**2)
    """
    p2 = Symbol("p2")
    values = [sympify(0)] * (order + 1)
    for (i, j), table in chain_table(order).items():
        for k in range(order + 1):
            values[k] += A**i * p2**j * sum((table[k, d] * base_derivative(d, 0) for d in range(k + 1)), sympify(0))
    return tuple(value.expand() for value in values)


def contact_rows(
    order: int, degree: Any, spans: Sequence[Any], base_degree: Any, base_spans: Sequence[Any], a: Any = A
) -> Matrix:
    """Return the matrix C of P_i = sum_j C[i, j] R_j that gives G^n contact with p1 = -a, the rest zero.

    Parameters
    ----------
    order : int
        n.
    degree : int or Expr
        p of the blend in u, at least n; may be a symbol.
    spans : sequence, length n
        h_r = U[p + r] - U[p] of the blend.
    base_degree : int or Expr
        q of the base across the contact; may be a symbol.
    base_spans : sequence, length n
        H_r of the base. Where the base has no such knot any positive number does: the entries that it enters are
        zero (see `end_derivatives`).
    a : Expr
        alpha^2, or beta^2 at the other contact.

    Returns
    -------
    Matrix, shape (n + 1, n + 1)
        Lower triangular; each row sums to 1. Rows and spans are counted from the contact, at whichever end of either
        surface it lies: then the same matrix holds.

    Raises
    ------
    ValueError
        A degree of the blend below n: its n-th derivative is zero and cannot follow the base.

    Examples
    --------
    >>> contact_rows(1, 3, span_symbols(1), 3, span_symbols(1, "H"))
    Matrix([
    [          1,        0],
    [1 + a*h1/H1, -a*h1/H1]])
    """
    blend = end_derivatives(order, _blend_degree(degree, order), spans)
    base = end_derivatives(order, base_degree, base_spans)
    rows = _solve_rows(order, blend, base, [(-A) ** d for d in range(order + 1)])
    return rows.subs(A, sympify(a))


def contact_jets(order: int, degree: Any, spans: Sequence[Any], a: Any = A) -> Matrix:
    """Return the matrix J of P_i = sum_d J[i, d] d^d R / dw^d, for a base that need not be a spline.

    Parameters
    ----------
    order, degree, spans, a
        As for `contact_rows`, which is this matrix times the end derivatives of the base.

    Returns
    -------
    Matrix, shape (n + 1, n + 1)
        J[i, d] = (-a)^d (p - d)! / p! e_d(h_1, .., h_i), with e_d the elementary symmetric polynomial: the blossom of
        the Taylor polynomial of R(w_s - a u, v) at i arguments h_1..h_i and p - i arguments 0.

    Raises
    ------
    ValueError
        As `contact_rows`.

    Examples
    --------
    >>> contact_jets(2, Symbol("p"), span_symbols(2))[2, :]
    Matrix([[1, -a*(h1 + h2)/p, a**2*h1*h2/(p*(p - 1))]])
    """
    blend = end_derivatives(order, _blend_degree(degree, order), spans)
    rows = _solve_rows(order, blend, Matrix.eye(order + 1), [(-A) ** d for d in range(order + 1)])
    return rows.subs(A, sympify(a))


def rows_from_derivatives(order: int, degree: Any, spans: Sequence[Any]) -> Matrix:
    """Return the matrix W of P_i = sum_k W[i, k] D_k, where D_k is the k-th u-derivative of the blend at the contact.

    Parameters
    ----------
    order, degree, spans
        As for `contact_rows`.

    Returns
    -------
    Matrix, shape (n + 1, n + 1)
        W[i, k] = (p - k)! / p! e_k(h_1, .., h_i): the inverse of `end_derivatives`, all entries positive or zero.

    Raises
    ------
    ValueError
        As `contact_rows`.

    Examples
    --------
    >>> rows_from_derivatives(2, Symbol("p"), span_symbols(2))[2, :]
    Matrix([[1, (h1 + h2)/p, h1*h2/(p*(p - 1))]])
    """
    return contact_jets(order, degree, spans, sympify(-1))


def chain_monomials(order: int) -> tuple[tuple[int, int], ...]:
    """Return the exponents (i, j) of the monomials a^i p2^j that the conditions of order 0..n hold, 1 first.

    Examples
    --------
    >>> chain_monomials(2)
    ((0, 0), (0, 1), (1, 0), (2, 0))
    """
    return tuple(sorted({key for table in _chain(order) for key in table}))


def chain_table(order: int) -> dict[tuple[int, int], Matrix]:
    """Return the conditions with p1 = -a and p2 for each monomial: D_k = sum_m a^i p2^j sum_d T_m[k, d] d^d R / dw^d.

    p3, p4 and all q_k are zero. Multiplied by constants or by functions of v these matrices serve alike, since the
    conditions hold for each v.

    Returns
    -------
    dict
        Exponents (i, j) to a Matrix of whole numbers, shape (n + 1, n + 1).

    Source: the chain rule, `contact_conditions`.

    Examples
    --------
    >>> chain_table(2)[0, 1]
    Matrix([
    [0, 0, 0],
    [0, 0, 0],
    [0, 1, 0]])
    """
    rows = _chain(order)
    tables = {key: Matrix.zeros(order + 1, order + 1) for key in chain_monomials(order)}
    for k, row in enumerate(rows):
        for key, coefficients in row.items():
            for d, value in coefficients.items():
                tables[key][k, d] = value
    return tables


def _chain(order: int) -> list[dict[tuple[int, int], dict[int, Expr]]]:
    """Return of each condition its coefficients: monomial in a and p2, then order of the derivative of R."""
    p2 = Symbol("p2")
    unused = {Symbol(f"{letter}{k}"): 0 for letter, first in (("p", 3), ("q", 1)) for k in range(first, order + 1)}
    found = []
    for condition in contact_conditions(order):
        chosen = condition.subs(unused).subs(Symbol("p1"), -A)
        row: dict[tuple[int, int], dict[int, Expr]] = {}
        for d in range(order + 1):
            for (i, j), value in Poly(chosen.coeff(base_derivative(d, 0)), A, p2).terms():
                if value:
                    row.setdefault((i, j), {})[d] = value
        found.append(row)
    return found


def _blend_degree(degree: Any, order: int) -> Expr:
    p = sympify(degree)
    if p.is_number and p < order:
        raise ValueError(f"degree: found {p}, expected at least {order} for contact of order {order}")
    return p


def contact_rows_from_pieces(
    order: int, degree: int, base_degree: int, end: str = "start", base_end: str = "start"
) -> Matrix:
    """Return the same matrix from the Cox-de Boor pieces, for given degrees and ends of blend and base.

    Parameters
    ----------
    order, degree, base_degree : int
    end, base_end : {"start", "end"}
        Where the contact lies in u on the blend, in w on the base.

    Returns
    -------
    Matrix, shape (order + 1, order + 1)
        Over the symbols h_r, H_r and a; rows counted from the contact.
    """
    blend = end_derivatives_from_pieces(order, degree, end)
    base = end_derivatives_from_pieces(order, base_degree, base_end)
    base = base.xreplace(dict(zip(span_symbols(order), span_symbols(order, "H"), strict=True)))
    sign = (1 if end == "start" else -1) * (1 if base_end == "start" else -1)
    conditions = special_conditions(order)
    factors = [condition.coeff(base_derivative(d, 0)).subs(A, sign * A) for d, condition in enumerate(conditions)]
    return _solve_rows(order, blend, base, factors)


def _solve_rows(order: int, blend: Matrix, base: Matrix, factors: Sequence[Expr]) -> Matrix:
    """Solve blend C = diag(factors) base for C by forward substitution; `blend` is lower triangular."""
    rows = Matrix.zeros(order + 1, order + 1)
    for d in range(order + 1):
        for j in range(d + 1):
            right = factors[d] * base[d, j] - sum((blend[d, i] * rows[i, j] for i in range(d)), sympify(0))
            rows[d, j] = _by_powers(right / blend[d, d])
    return rows


def _by_powers(expression: Expr) -> Expr:
    """Return a polynomial in a as the sum of its powers, each coefficient a product of factors."""
    numerator, denominator = fraction(together(expression))
    terms = Poly(numerator, A).terms() if numerator.has(A) else [((0,), numerator)]
    return sum((A**power * factor(coefficient / denominator) for (power,), coefficient in terms), sympify(0))
