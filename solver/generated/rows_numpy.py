"""Rows of a blend from its derivatives at a contact, and these from the chain rule (NumPy).

Written by `semispline generate` from derivations/splines.py and derivations/contact.py and derivations/linear_alpha.py.
Do not edit: change the derivation and generate again.
Operations: 78 in 13 functions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def _number(name: str, value: float) -> float:
    if np.shape(value) != ():
        raise ValueError(f"{name}: shape {np.shape(value)}, expected a single number of shape ()")
    return float(value)


def _degree(name: str, value: float, least: int) -> float:
    degree = _number(name, value)
    if not degree >= least:
        raise ValueError(f"{name}: found {value}, expected a degree of at least {least}")
    return degree


def _span(name: str, value: float) -> float:
    span = _number(name, value)
    if not span > 0:
        raise ValueError(f"{name}: found {value}, expected a positive distance of knots")
    return span


def rows_from_derivatives_1(p: float, h1: float) -> FloatArray:
    """Rows P_i = sum_k W[i, k] D_k of a blend with u-derivatives D_0..D_1 at the contact.

    Parameters
    ----------
    p : a number, at least 1
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.

    Returns
    -------
    W : matrix, shape (2, 2)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py; derivations/contact.py. Operations: 1.
    """
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    c1_1 = h1 / p
    return np.array([[1.0, 0.0], [1.0, c1_1]], dtype=np.float64)


def chain_monomials_1() -> FloatArray:
    """Exponents of a and p2 in the monomials of the conditions of order 0..1.

    Returns
    -------
    exponents : matrix, shape (2, 2)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 0.
    """
    return np.array([[0.0, 0.0], [1.0, 0.0]], dtype=np.float64)


def chain_table_1() -> FloatArray:
    """D_k = sum over monomials m of m sum_d T_m[k, d] R^(d), k = 0..1; the T_m below each other.

    Returns
    -------
    T : matrix, shape (4, 2)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 1.
    """
    return np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, -1.0]], dtype=np.float64)


def rows_from_derivatives_2(p: float, h1: float, h2: float) -> FloatArray:
    """Rows P_i = sum_k W[i, k] D_k of a blend with u-derivatives D_0..D_2 at the contact.

    Parameters
    ----------
    p : a number, at least 2
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    h2 : a positive number
        U[p + 2] - U[p] of the blend, counted from the contact.

    Returns
    -------
    W : matrix, shape (3, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py; derivations/contact.py. Operations: 7.
    """
    p = _degree("p", p, 2)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    x0 = 1 / p
    x1 = h1 * x0
    c2_1 = x0 * (h1 + h2)
    c2_2 = h2 * x1 / (p - 1)
    return np.array([[1.0, 0.0, 0.0], [1.0, x1, 0.0], [1.0, c2_1, c2_2]], dtype=np.float64)


def chain_monomials_2() -> FloatArray:
    """Exponents of a and p2 in the monomials of the conditions of order 0..2.

    Returns
    -------
    exponents : matrix, shape (4, 2)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 0.
    """
    return np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [2.0, 0.0]], dtype=np.float64)


def chain_table_2() -> FloatArray:
    """D_k = sum over monomials m of m sum_d T_m[k, d] R^(d), k = 0..2; the T_m below each other.

    Returns
    -------
    T : matrix, shape (12, 3)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 1.
    """
    return np.array(
        [
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
        ],
        dtype=np.float64,
    )


def rows_from_derivatives_3(p: float, h1: float, h2: float, h3: float) -> FloatArray:
    """Rows P_i = sum_k W[i, k] D_k of a blend with u-derivatives D_0..D_3 at the contact.

    Parameters
    ----------
    p : a number, at least 3
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    h2 : a positive number
        U[p + 2] - U[p] of the blend, counted from the contact.
    h3 : a positive number
        U[p + 3] - U[p] of the blend, counted from the contact.

    Returns
    -------
    W : matrix, shape (4, 4)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py; derivations/contact.py. Operations: 20.
    """
    p = _degree("p", p, 3)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    x0 = 1 / p
    x1 = h1 * x0
    x2 = h1 + h2
    x3 = 1 / (p - 1)
    x4 = x1 * x3
    x5 = h2 * h3
    c2_1 = x0 * x2
    c2_2 = h2 * x4
    c3_1 = x0 * (h3 + x2)
    c3_2 = x0 * x3 * (h1 * h2 + h1 * h3 + x5)
    c3_3 = x4 * x5 / (p - 2)
    return np.array(
        [[1.0, 0.0, 0.0, 0.0], [1.0, x1, 0.0, 0.0], [1.0, c2_1, c2_2, 0.0], [1.0, c3_1, c3_2, c3_3]], dtype=np.float64
    )


def chain_monomials_3() -> FloatArray:
    """Exponents of a and p2 in the monomials of the conditions of order 0..3.

    Returns
    -------
    exponents : matrix, shape (6, 2)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 0.
    """
    return np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 0.0]], dtype=np.float64)


def chain_table_3() -> FloatArray:
    """D_k = sum over monomials m of m sum_d T_m[k, d] R^(d), k = 0..3; the T_m below each other.

    Returns
    -------
    T : matrix, shape (24, 4)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 3.
    """
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -3.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
        ],
        dtype=np.float64,
    )


def rows_from_derivatives_4(p: float, h1: float, h2: float, h3: float, h4: float) -> FloatArray:
    """Rows P_i = sum_k W[i, k] D_k of a blend with u-derivatives D_0..D_4 at the contact.

    Parameters
    ----------
    p : a number, at least 4
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    h2 : a positive number
        U[p + 2] - U[p] of the blend, counted from the contact.
    h3 : a positive number
        U[p + 3] - U[p] of the blend, counted from the contact.
    h4 : a positive number
        U[p + 4] - U[p] of the blend, counted from the contact.

    Returns
    -------
    W : matrix, shape (5, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py; derivations/contact.py. Operations: 42.
    """
    p = _degree("p", p, 4)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    h4 = _span("h4", h4)
    x0 = 1 / p
    x1 = h1 * x0
    x2 = h1 + h2
    x3 = 1 / (p - 1)
    x4 = x1 * x3
    x5 = h3 + x2
    x6 = h1 * h2
    x7 = h1 * h3
    x8 = h2 * h3
    x9 = x6 + x7 + x8
    x10 = x0 * x3
    x11 = 1 / (p - 2)
    x12 = x11 * x4
    x13 = h4 * x8
    c2_1 = x0 * x2
    c2_2 = h2 * x4
    c3_1 = x0 * x5
    c3_2 = x10 * x9
    c3_3 = x12 * x8
    c4_1 = x0 * (h4 + x5)
    c4_2 = x10 * (h1 * h4 + h2 * h4 + h3 * h4 + x9)
    c4_3 = x10 * x11 * (h3 * x6 + h4 * x6 + h4 * x7 + x13)
    c4_4 = x12 * x13 / (p - 3)
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, x1, 0.0, 0.0, 0.0],
            [1.0, c2_1, c2_2, 0.0, 0.0],
            [1.0, c3_1, c3_2, c3_3, 0.0],
            [1.0, c4_1, c4_2, c4_3, c4_4],
        ],
        dtype=np.float64,
    )


def chain_monomials_4() -> FloatArray:
    """Exponents of a and p2 in the monomials of the conditions of order 0..4.

    Returns
    -------
    exponents : matrix, shape (9, 2)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 0.
    """
    return np.array(
        [[0.0, 0.0], [0.0, 1.0], [0.0, 2.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0], [2.0, 1.0], [3.0, 0.0], [4.0, 0.0]],
        dtype=np.float64,
    )


def chain_table_4() -> FloatArray:
    """D_k = sum over monomials m of m sum_d T_m[k, d] R^(d), k = 0..4; the T_m below each other.

    Returns
    -------
    T : matrix, shape (45, 5)

    Source: chain rule with p1 = -a, p2, the rest zero; derivations/contact.py. Operations: 3.
    """
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 3.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -3.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 6.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0],
        ],
        dtype=np.float64,
    )


def linear_powers_4() -> FloatArray:
    """Rows (i, i0, i1, c): (a0 (1 - s) + a1 s)^i sums c a0^i0 a1^i1 (1 - s)^i0 s^i1; i <= 4.

    Returns
    -------
    powers : matrix, shape (15, 4)

    Source: derivations/linear_alpha.py. Operations: 0.
    """
    return np.array(
        [
            [0.0, 0.0, 0.0, 1.0],
            [1.0, 1.0, 0.0, 1.0],
            [1.0, 0.0, 1.0, 1.0],
            [2.0, 2.0, 0.0, 1.0],
            [2.0, 1.0, 1.0, 2.0],
            [2.0, 0.0, 2.0, 1.0],
            [3.0, 3.0, 0.0, 1.0],
            [3.0, 2.0, 1.0, 3.0],
            [3.0, 1.0, 2.0, 3.0],
            [3.0, 0.0, 3.0, 1.0],
            [4.0, 4.0, 0.0, 1.0],
            [4.0, 3.0, 1.0, 4.0],
            [4.0, 2.0, 2.0, 6.0],
            [4.0, 1.0, 3.0, 4.0],
            [4.0, 0.0, 4.0, 1.0],
        ],
        dtype=np.float64,
    )
