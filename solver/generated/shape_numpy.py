"""The least energy as a polynomial in the shape parameters (NumPy).

Written by `semispline generate` from derivations/shape.py.
Do not edit: change the derivation and generate again.
Operations: 105 in 10 functions.
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


def contact_row_powers_1(a0: float, p: float, h1: float, q: float, H1: float) -> FloatArray:
    """Rows of a blend in G1 contact, C_0 + x C_1 + .. + x^1 C_1, C_k below each other.

    Parameters
    ----------
    a0 : a number
        The value of a = alpha^2 about which the rows are expanded.
    p : a number, at least 1
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    q : a number, at least 1
        Degree of the base across the contact.
    H1 : a positive number
        U[q + 1] - U[q] of the base; any positive number where there is no such knot.

    Returns
    -------
    C : matrix, shape (4, 2)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py, x = a - a0. Operations: 7.
    """
    a0 = _number("a0", a0)
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    x0 = h1 * q / (H1 * p)
    x1 = a0 * x0
    c1_0 = x1 + 1
    c1_1 = -x1
    c3_1 = -x0
    return np.array([[1.0, 0.0], [c1_0, c1_1], [0.0, 0.0], [x0, c3_1]], dtype=np.float64)


def contact_row_powers_2(a0: float, p: float, h1: float, h2: float, q: float, H1: float, H2: float) -> FloatArray:
    """Rows of a blend in G2 contact, C_0 + x C_1 + .. + x^2 C_2, C_k below each other.

    Parameters
    ----------
    a0 : a number
        The value of a = alpha^2 about which the rows are expanded.
    p : a number, at least 2
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    h2 : a positive number
        U[p + 2] - U[p] of the blend, counted from the contact.
    q : a number, at least 1
        Degree of the base across the contact.
    H1 : a positive number
        U[q + 1] - U[q] of the base; any positive number where there is no such knot.
    H2 : a positive number
        U[q + 2] - U[q] of the base; any positive number where there is no such knot.

    Returns
    -------
    C : matrix, shape (9, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py, x = a - a0. Operations: 59.
    """
    a0 = _number("a0", a0)
    p = _degree("p", p, 2)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    H2 = _span("H2", H2)
    x0 = h1 * q
    x1 = 1 / (H1 * p)
    x2 = x0 * x1
    x3 = a0 * x2
    x4 = h2 * q + x0
    x5 = x1 * x4
    x6 = a0**2
    x7 = h1 * h2 * q**2
    x8 = x7 - h2 * x0
    x9 = H1**2
    x10 = p * x9
    x11 = p**2
    x12 = x11 * x9
    x13 = x8 / (x12 - x10)
    x14 = -x1 * x4
    x15 = (H1 * h1 * h2 * q + H2 * h1 * h2 * q - H1 * x7 - H2 * x7) / (H2 * x12 - H2 * x10)
    x16 = H1 * H2
    x17 = x8 / (x11 * x16 - p * x16)
    x18 = 2 * a0
    c1_0 = x3 + 1
    c1_1 = -x3
    c2_0 = a0 * x5 + x13 * x6 + 1
    c2_1 = a0 * x14 + x15 * x6
    c2_2 = x17 * x6
    c4_1 = -x2
    c5_0 = x13 * x18 + x5
    c5_1 = x14 + x15 * x18
    c5_2 = x17 * x18
    return np.array(
        [
            [1.0, 0.0, 0.0],
            [c1_0, c1_1, 0.0],
            [c2_0, c2_1, c2_2],
            [0.0, 0.0, 0.0],
            [x2, c4_1, 0.0],
            [c5_0, c5_1, c5_2],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [x13, x15, x17],
        ],
        dtype=np.float64,
    )


def shape_polynomial_01(S00: float, S01: float, S11: float) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S11 : a number
        Energy product of Z_1 and Z_1.

    Returns
    -------
    E : matrix, shape (1, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 1.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S11 = _number("S11", S11)
    c0_1 = 2 * S01
    return np.array([[S00, c0_1, S11]], dtype=np.float64)


def shape_polynomial_02(S00: float, S01: float, S02: float, S11: float, S12: float, S22: float) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S22 : a number
        Energy product of Z_2 and Z_2.

    Returns
    -------
    E : matrix, shape (1, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 4.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S22 = _number("S22", S22)
    c0_1 = 2 * S01
    c0_2 = 2 * S02 + S11
    c0_3 = 2 * S12
    return np.array([[S00, c0_1, c0_2, c0_3, S22]], dtype=np.float64)


def shape_polynomial_10(S00: float, S01: float, S11: float) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S11 : a number
        Energy product of Z_1 and Z_1.

    Returns
    -------
    E : matrix, shape (3, 1)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 1.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S11 = _number("S11", S11)
    c1_0 = 2 * S01
    return np.array([[S00], [c1_0], [S11]], dtype=np.float64)


def shape_polynomial_11(S00: float, S01: float, S02: float, S11: float, S12: float, S22: float) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S22 : a number
        Energy product of Z_2 and Z_2.

    Returns
    -------
    E : matrix, shape (3, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 3.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S22 = _number("S22", S22)
    c0_1 = 2 * S02
    c1_0 = 2 * S01
    c1_1 = 2 * S12
    return np.array([[S00, c0_1, S22], [c1_0, c1_1, 0.0], [S11, 0.0, 0.0]], dtype=np.float64)


def shape_polynomial_12(
    S00: float,
    S01: float,
    S02: float,
    S03: float,
    S11: float,
    S12: float,
    S13: float,
    S22: float,
    S23: float,
    S33: float,
) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S03 : a number
        Energy product of Z_0 and Z_3.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S13 : a number
        Energy product of Z_1 and Z_3.
    S22 : a number
        Energy product of Z_2 and Z_2.
    S23 : a number
        Energy product of Z_2 and Z_3.
    S33 : a number
        Energy product of Z_3 and Z_3.

    Returns
    -------
    E : matrix, shape (3, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 7.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S03 = _number("S03", S03)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S13 = _number("S13", S13)
    S22 = _number("S22", S22)
    S23 = _number("S23", S23)
    S33 = _number("S33", S33)
    c0_1 = 2 * S02
    c0_2 = 2 * S03 + S22
    c0_3 = 2 * S23
    c1_0 = 2 * S01
    c1_1 = 2 * S12
    c1_2 = 2 * S13
    return np.array(
        [[S00, c0_1, c0_2, c0_3, S33], [c1_0, c1_1, c1_2, 0.0, 0.0], [S11, 0.0, 0.0, 0.0, 0.0]], dtype=np.float64
    )


def shape_polynomial_20(S00: float, S01: float, S02: float, S11: float, S12: float, S22: float) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S22 : a number
        Energy product of Z_2 and Z_2.

    Returns
    -------
    E : matrix, shape (5, 1)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 4.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S22 = _number("S22", S22)
    c1_0 = 2 * S01
    c2_0 = 2 * S02 + S11
    c3_0 = 2 * S12
    return np.array([[S00], [c1_0], [c2_0], [c3_0], [S22]], dtype=np.float64)


def shape_polynomial_21(
    S00: float,
    S01: float,
    S02: float,
    S03: float,
    S11: float,
    S12: float,
    S13: float,
    S22: float,
    S23: float,
    S33: float,
) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S03 : a number
        Energy product of Z_0 and Z_3.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S13 : a number
        Energy product of Z_1 and Z_3.
    S22 : a number
        Energy product of Z_2 and Z_2.
    S23 : a number
        Energy product of Z_2 and Z_3.
    S33 : a number
        Energy product of Z_3 and Z_3.

    Returns
    -------
    E : matrix, shape (5, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 7.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S03 = _number("S03", S03)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S13 = _number("S13", S13)
    S22 = _number("S22", S22)
    S23 = _number("S23", S23)
    S33 = _number("S33", S33)
    c0_1 = 2 * S03
    c1_0 = 2 * S01
    c1_1 = 2 * S13
    c2_0 = 2 * S02 + S11
    c2_1 = 2 * S23
    c3_0 = 2 * S12
    return np.array(
        [[S00, c0_1, S33], [c1_0, c1_1, 0.0], [c2_0, c2_1, 0.0], [c3_0, 0.0, 0.0], [S22, 0.0, 0.0]], dtype=np.float64
    )


def shape_polynomial_22(
    S00: float,
    S01: float,
    S02: float,
    S03: float,
    S04: float,
    S11: float,
    S12: float,
    S13: float,
    S14: float,
    S22: float,
    S23: float,
    S24: float,
    S33: float,
    S34: float,
    S44: float,
) -> FloatArray:
    """Coefficients of the least energy: [i, j] multiplies (a - a0)^i (b - b0)^j.

    Parameters
    ----------
    S00 : a number
        Energy product of Z_0 and Z_0.
    S01 : a number
        Energy product of Z_0 and Z_1.
    S02 : a number
        Energy product of Z_0 and Z_2.
    S03 : a number
        Energy product of Z_0 and Z_3.
    S04 : a number
        Energy product of Z_0 and Z_4.
    S11 : a number
        Energy product of Z_1 and Z_1.
    S12 : a number
        Energy product of Z_1 and Z_2.
    S13 : a number
        Energy product of Z_1 and Z_3.
    S14 : a number
        Energy product of Z_1 and Z_4.
    S22 : a number
        Energy product of Z_2 and Z_2.
    S23 : a number
        Energy product of Z_2 and Z_3.
    S24 : a number
        Energy product of Z_2 and Z_4.
    S33 : a number
        Energy product of Z_3 and Z_3.
    S34 : a number
        Energy product of Z_3 and Z_4.
    S44 : a number
        Energy product of Z_4 and Z_4.

    Returns
    -------
    E : matrix, shape (5, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: derivations/shape.py. Operations: 12.
    """
    S00 = _number("S00", S00)
    S01 = _number("S01", S01)
    S02 = _number("S02", S02)
    S03 = _number("S03", S03)
    S04 = _number("S04", S04)
    S11 = _number("S11", S11)
    S12 = _number("S12", S12)
    S13 = _number("S13", S13)
    S14 = _number("S14", S14)
    S22 = _number("S22", S22)
    S23 = _number("S23", S23)
    S24 = _number("S24", S24)
    S33 = _number("S33", S33)
    S34 = _number("S34", S34)
    S44 = _number("S44", S44)
    c0_1 = 2 * S03
    c0_2 = 2 * S04 + S33
    c0_3 = 2 * S34
    c1_0 = 2 * S01
    c1_1 = 2 * S13
    c1_2 = 2 * S14
    c2_0 = 2 * S02 + S11
    c2_1 = 2 * S23
    c2_2 = 2 * S24
    c3_0 = 2 * S12
    return np.array(
        [
            [S00, c0_1, c0_2, c0_3, S44],
            [c1_0, c1_1, c1_2, 0.0, 0.0],
            [c2_0, c2_1, c2_2, 0.0, 0.0],
            [c3_0, 0.0, 0.0, 0.0, 0.0],
            [S22, 0.0, 0.0, 0.0, 0.0],
        ],
        dtype=np.float64,
    )
