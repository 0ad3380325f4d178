"""Contact of a blend with a base: end derivatives, rows P_0..P_n, general conditions (NumPy).

Written by `semispline generate` from derivations/splines.py and derivations/contact.py.
Do not edit: change the derivation and generate again.
Operations: 408 in 10 functions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

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


def _vector(name: str, value: ArrayLike, like: FloatArray | None = None) -> FloatArray:
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape[-1:] != (3,) or (like is not None and vector.shape != like.shape):
        raise ValueError(f"{name}: shape {vector.shape}, expected {'(..., 3)' if like is None else like.shape}")
    return vector


def _function(name: str, value: ArrayLike, like: FloatArray) -> FloatArray:
    function = np.asarray(value, dtype=np.float64)
    if function.shape not in ((), like.shape[:-1]):
        raise ValueError(f"{name}: shape {function.shape}, expected () or {like.shape[:-1]}")
    return function[..., None]


def end_derivatives_1(p: float, h1: float) -> FloatArray:
    """Derivatives of order 0..1 at the clamped start; [d, i] multiplies row i in the d-th.

    Parameters
    ----------
    p : a number, at least 1
        Degree.
    h1 : a positive number
        U[p + 1] - U[p] of the knots.

    Returns
    -------
    D : matrix, shape (2, 2)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py. Operations: 2.
    """
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    x0 = p / h1
    c1_0 = -x0
    return np.array([[1.0, 0.0], [c1_0, x0]], dtype=np.float64)


def end_derivatives_2(p: float, h1: float, h2: float) -> FloatArray:
    """Derivatives of order 0..2 at the clamped start; [d, i] multiplies row i in the d-th.

    Parameters
    ----------
    p : a number, at least 1
        Degree.
    h1 : a positive number
        U[p + 1] - U[p] of the knots.
    h2 : a positive number
        U[p + 2] - U[p] of the knots.

    Returns
    -------
    D : matrix, shape (3, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py. Operations: 13.
    """
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    x0 = p / h1
    x1 = p - 1
    x2 = p * x1 / h1**2
    x3 = 1 / h2
    c1_0 = -x0
    c2_1 = -x2 * x3 * (h1 + h2)
    c2_2 = x0 * x1 * x3
    return np.array([[1.0, 0.0, 0.0], [c1_0, x0, 0.0], [x2, c2_1, c2_2]], dtype=np.float64)


def end_derivatives_3(p: float, h1: float, h2: float, h3: float) -> FloatArray:
    """Derivatives of order 0..3 at the clamped start; [d, i] multiplies row i in the d-th.

    Parameters
    ----------
    p : a number, at least 1
        Degree.
    h1 : a positive number
        U[p + 1] - U[p] of the knots.
    h2 : a positive number
        U[p + 2] - U[p] of the knots.
    h3 : a positive number
        U[p + 3] - U[p] of the knots.

    Returns
    -------
    D : matrix, shape (4, 4)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py. Operations: 35.
    """
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    x0 = p / h1
    x1 = h1**2
    x2 = p - 1
    x3 = p * x2
    x4 = x3 / x1
    x5 = 1 / h2
    x6 = x0 * x2 * x5
    x7 = p - 2
    x8 = x3 * x7 / h1**3
    x9 = h2**2
    x10 = 1 / x9
    x11 = h1 * h2
    x12 = x7 / h3
    c1_0 = -x0
    c2_1 = -x4 * x5 * (h1 + h2)
    c3_0 = -x8
    c3_1 = x10 * x8 * (x1 + x11 + x9)
    c3_2 = -x10 * x12 * x4 * (h1 * h3 + h2 * h3 + x11)
    c3_3 = x12 * x6
    return np.array(
        [[1.0, 0.0, 0.0, 0.0], [c1_0, x0, 0.0, 0.0], [x4, c2_1, x6, 0.0], [c3_0, c3_1, c3_2, c3_3]], dtype=np.float64
    )


def end_derivatives_4(p: float, h1: float, h2: float, h3: float, h4: float) -> FloatArray:
    """Derivatives of order 0..4 at the clamped start; [d, i] multiplies row i in the d-th.

    Parameters
    ----------
    p : a number, at least 1
        Degree.
    h1 : a positive number
        U[p + 1] - U[p] of the knots.
    h2 : a positive number
        U[p + 2] - U[p] of the knots.
    h3 : a positive number
        U[p + 3] - U[p] of the knots.
    h4 : a positive number
        U[p + 4] - U[p] of the knots.

    Returns
    -------
    D : matrix, shape (5, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: Cox-de Boor, derivations/splines.py. Operations: 76.
    """
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    h4 = _span("h4", h4)
    x0 = p / h1
    x1 = h1**2
    x2 = p - 1
    x3 = p * x2
    x4 = x3 / x1
    x5 = 1 / h2
    x6 = h1 + h2
    x7 = x0 * x2 * x5
    x8 = p - 2
    x9 = x3 * x8
    x10 = x9 / h1**3
    x11 = h2**2
    x12 = 1 / x11
    x13 = h1 * h2
    x14 = x1 + x11
    x15 = h1 * h3
    x16 = h2 * h3
    x17 = x8 / h3
    x18 = x12 * x4
    x19 = x17 * x7
    x20 = p - 3
    x21 = x20 * x9 / h1**4
    x22 = 1 / h2**3
    x23 = h3**2
    x24 = x20 / x23
    x25 = 1 / h4
    c1_0 = -x0
    c2_1 = -x4 * x5 * x6
    c3_0 = -x10
    c3_1 = x10 * x12 * (x13 + x14)
    c3_2 = -x17 * x18 * (x13 + x15 + x16)
    c4_1 = -x14 * x21 * x22 * x6
    c4_2 = x10 * x22 * x24 * (x1 * x11 + x1 * x16 + x1 * x23 + x11 * x15 + x11 * x23 + x13 * x23)
    c4_3 = -x18 * x24 * x25 * x8 * (h3 * x13 + h4 * x13 + h4 * x15 + h4 * x16)
    c4_4 = x19 * x20 * x25
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [c1_0, x0, 0.0, 0.0, 0.0],
            [x4, c2_1, x7, 0.0, 0.0],
            [c3_0, c3_1, c3_2, x19, 0.0],
            [x21, c4_1, c4_2, c4_3, c4_4],
        ],
        dtype=np.float64,
    )


def contact_rows_0() -> FloatArray:
    """Rows of a blend in G0 contact: P_i = sum_j C[i, j] R_j, counted from the contact.

    Returns
    -------
    C : matrix, shape (1, 1)

    Source: chain rule of order 0 with p1 = -a, the rest zero; derivations/contact.py. Operations: 0.
    """
    return np.array([[1.0]], dtype=np.float64)


def contact_rows_1(a: float, p: float, h1: float, q: float, H1: float) -> FloatArray:
    """Rows of a blend in G1 contact: P_i = sum_j C[i, j] R_j, counted from the contact.

    Parameters
    ----------
    a : a number
        alpha^2: the blend leaves the base backwards, P_u = -a R_w.
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
    C : matrix, shape (2, 2)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: chain rule of order 1 with p1 = -a, the rest zero; derivations/contact.py. Operations: 6.
    """
    a = _number("a", a)
    p = _degree("p", p, 1)
    h1 = _span("h1", h1)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    x0 = a * h1 * q / (H1 * p)
    c1_0 = x0 + 1
    c1_1 = -x0
    return np.array([[1.0, 0.0], [c1_0, c1_1]], dtype=np.float64)


def contact_rows_2(a: float, p: float, h1: float, h2: float, q: float, H1: float, H2: float) -> FloatArray:
    """Rows of a blend in G2 contact: P_i = sum_j C[i, j] R_j, counted from the contact.

    Parameters
    ----------
    a : a number
        alpha^2: the blend leaves the base backwards, P_u = -a R_w.
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
    C : matrix, shape (3, 3)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: chain rule of order 2 with p1 = -a, the rest zero; derivations/contact.py. Operations: 31.
    """
    a = _number("a", a)
    p = _degree("p", p, 2)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    H2 = _span("H2", H2)
    x0 = 1 / p
    x1 = h1 * q * x0
    x2 = 1 / H1
    x3 = a * x2
    x4 = x1 * x3
    x5 = q * x0 * x3 * (h1 + h2)
    x6 = a**2 * h2 * x1 * (q - 1) / (p - 1)
    x7 = x6 / H1**2
    x8 = 1 / H2
    c1_0 = x4 + 1
    c1_1 = -x4
    c2_0 = x5 + x7 + 1
    c2_1 = -x5 - x7 * x8 * (H1 + H2)
    c2_2 = x2 * x6 * x8
    return np.array([[1.0, 0.0, 0.0], [c1_0, c1_1, 0.0], [c2_0, c2_1, c2_2]], dtype=np.float64)


def contact_rows_3(
    a: float, p: float, h1: float, h2: float, h3: float, q: float, H1: float, H2: float, H3: float
) -> FloatArray:
    """Rows of a blend in G3 contact: P_i = sum_j C[i, j] R_j, counted from the contact.

    Parameters
    ----------
    a : a number
        alpha^2: the blend leaves the base backwards, P_u = -a R_w.
    p : a number, at least 3
        Degree of the blend in u.
    h1 : a positive number
        U[p + 1] - U[p] of the blend, counted from the contact.
    h2 : a positive number
        U[p + 2] - U[p] of the blend, counted from the contact.
    h3 : a positive number
        U[p + 3] - U[p] of the blend, counted from the contact.
    q : a number, at least 1
        Degree of the base across the contact.
    H1 : a positive number
        U[q + 1] - U[q] of the base; any positive number where there is no such knot.
    H2 : a positive number
        U[q + 2] - U[q] of the base; any positive number where there is no such knot.
    H3 : a positive number
        U[q + 3] - U[q] of the base; any positive number where there is no such knot.

    Returns
    -------
    C : matrix, shape (4, 4)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: chain rule of order 3 with p1 = -a, the rest zero; derivations/contact.py. Operations: 73.
    """
    a = _number("a", a)
    p = _degree("p", p, 3)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    H2 = _span("H2", H2)
    H3 = _span("H3", H3)
    x0 = q / p
    x1 = x0 / H1
    x2 = a * x1
    x3 = h1 * x2
    x4 = h1 + h2
    x5 = x2 * x4
    x6 = H1**2
    x7 = x0 / x6
    x8 = h1 * h2
    x9 = (q - 1) / (p - 1)
    x10 = a**2 * x9
    x11 = x10 * x8
    x12 = x11 * x7
    x13 = 1 / H2
    x14 = x13 * (H1 + H2)
    x15 = x1 * x13
    x16 = x2 * (h3 + x4)
    x17 = x10 * (h1 * h3 + h2 * h3 + x8)
    x18 = x17 * x7
    x19 = a**3 * h3 * x8 * x9 * (q - 2) / (p - 2)
    x20 = x0 * x19 / H1**3
    x21 = H2**2
    x22 = 1 / x21
    x23 = H1 * H2
    x24 = x19 / H3
    c1_0 = x3 + 1
    c1_1 = -x3
    c2_0 = x12 + x5 + 1
    c2_1 = -x12 * x14 - x5
    c2_2 = x11 * x15
    c3_0 = x16 + x18 + x20 + 1
    c3_1 = -x14 * x18 - x16 - x20 * x22 * (x21 + x23 + x6)
    c3_2 = x15 * x17 + x22 * x24 * x7 * (H1 * H3 + H2 * H3 + x23)
    c3_3 = -x15 * x24
    return np.array(
        [[1.0, 0.0, 0.0, 0.0], [c1_0, c1_1, 0.0, 0.0], [c2_0, c2_1, c2_2, 0.0], [c3_0, c3_1, c3_2, c3_3]],
        dtype=np.float64,
    )


def contact_rows_4(
    a: float, p: float, h1: float, h2: float, h3: float, h4: float, q: float, H1: float, H2: float, H3: float, H4: float
) -> FloatArray:
    """Rows of a blend in G4 contact: P_i = sum_j C[i, j] R_j, counted from the contact.

    Parameters
    ----------
    a : a number
        alpha^2: the blend leaves the base backwards, P_u = -a R_w.
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
    q : a number, at least 1
        Degree of the base across the contact.
    H1 : a positive number
        U[q + 1] - U[q] of the base; any positive number where there is no such knot.
    H2 : a positive number
        U[q + 2] - U[q] of the base; any positive number where there is no such knot.
    H3 : a positive number
        U[q + 3] - U[q] of the base; any positive number where there is no such knot.
    H4 : a positive number
        U[q + 4] - U[q] of the base; any positive number where there is no such knot.

    Returns
    -------
    C : matrix, shape (5, 5)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: chain rule of order 4 with p1 = -a, the rest zero; derivations/contact.py. Operations: 156.
    """
    a = _number("a", a)
    p = _degree("p", p, 4)
    h1 = _span("h1", h1)
    h2 = _span("h2", h2)
    h3 = _span("h3", h3)
    h4 = _span("h4", h4)
    q = _degree("q", q, 1)
    H1 = _span("H1", H1)
    H2 = _span("H2", H2)
    H3 = _span("H3", H3)
    H4 = _span("H4", H4)
    x0 = q / p
    x1 = x0 / H1
    x2 = a * x1
    x3 = h1 * x2
    x4 = h1 + h2
    x5 = x2 * x4
    x6 = h1 * h2
    x7 = (q - 1) / (p - 1)
    x8 = a**2 * x7
    x9 = H1**2
    x10 = x0 / x9
    x11 = x10 * x8
    x12 = x11 * x6
    x13 = 1 / H2
    x14 = H1 + H2
    x15 = x13 * x14
    x16 = x1 * x13
    x17 = x16 * x8
    x18 = h3 + x4
    x19 = x18 * x2
    x20 = h1 * h3
    x21 = h2 * h3
    x22 = x20 + x21 + x6
    x23 = x22 * x8
    x24 = x10 * x23
    x25 = x0 / H1**3
    x26 = h3 * x6
    x27 = x7 * (q - 2) / (p - 2)
    x28 = a**3 * x27
    x29 = x26 * x28
    x30 = x25 * x29
    x31 = H2**2
    x32 = 1 / x31
    x33 = H1 * H2
    x34 = x31 + x9
    x35 = x32 * (x33 + x34)
    x36 = H1 * H3
    x37 = H2 * H3
    x38 = x10 * x32
    x39 = x38 * (x33 + x36 + x37)
    x40 = 1 / H3
    x41 = x29 * x40
    x42 = x2 * (h4 + x18)
    x43 = h3 * h4
    x44 = h1 * h4 + h2 * h4 + x22 + x43
    x45 = x11 * x44
    x46 = a**4 * x27 * x43 * x6 * (q - 3) / (p - 3)
    x47 = x0 * x46 / H1**4
    x48 = x28 * (h4 * x20 + h4 * x21 + h4 * x6 + x26)
    x49 = x25 * x48
    x50 = 1 / H2**3
    x51 = x40 * x48
    x52 = H3**2
    x53 = x46 / x52
    x54 = 1 / H4
    c1_0 = x3 + 1
    c1_1 = -x3
    c2_0 = x12 + x5 + 1
    c2_1 = -x12 * x15 - x5
    c2_2 = x17 * x6
    c3_0 = x19 + x24 + x30 + 1
    c3_1 = -x15 * x24 - x19 - x30 * x35
    c3_2 = x16 * x23 + x39 * x41
    c3_3 = -x16 * x41
    c4_0 = x42 + x45 + x47 + x49 + 1
    c4_1 = -x14 * x34 * x47 * x50 - x15 * x45 - x35 * x49 - x42
    c4_2 = (
        x17 * x44 + x25 * x50 * x53 * (x31 * x36 + x31 * x52 + x31 * x9 + x33 * x52 + x37 * x9 + x52 * x9) + x39 * x51
    )
    c4_3 = -x16 * x51 - x38 * x53 * x54 * (H3 * x33 + H4 * x33 + H4 * x36 + H4 * x37)
    c4_4 = x16 * x40 * x46 * x54
    return np.array(
        [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [c1_0, c1_1, 0.0, 0.0, 0.0],
            [c2_0, c2_1, c2_2, 0.0, 0.0],
            [c3_0, c3_1, c3_2, c3_3, 0.0],
            [c4_0, c4_1, c4_2, c4_3, c4_4],
        ],
        dtype=np.float64,
    )


def contact_derivatives_2(
    r_w: ArrayLike,
    r_v: ArrayLike,
    r_ww: ArrayLike,
    r_wv: ArrayLike,
    r_vv: ArrayLike,
    p1: ArrayLike,
    q1: ArrayLike,
    p2: ArrayLike,
    q2: ArrayLike,
) -> tuple[FloatArray, FloatArray]:
    """p_u, p_uu along the contact for general p_i, q_i, where P(u, v) = R(w(u, v), v~(u, v)).

    Parameters
    ----------
    r_w : shape (..., 3), the same for all
        R_w along the contact.
    r_v : shape (..., 3), the same for all
        R_v along the contact.
    r_ww : shape (..., 3), the same for all
        R_ww along the contact.
    r_wv : shape (..., 3), the same for all
        R_wv along the contact.
    r_vv : shape (..., 3), the same for all
        R_vv along the contact.
    p1 : a number, or shape (...)
        w_u along the contact.
    q1 : a number, or shape (...)
        v~_u along the contact.
    p2 : a number, or shape (...)
        w_uu along the contact.
    q2 : a number, or shape (...)
        v~_uu along the contact.

    Returns
    -------
    p_u : shape (..., 3), the same for all
    p_uu : shape (..., 3), the same for all

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: chain rule, derivations/contact.py; equations (15) and (16). Operations: 16.
    """
    r_w = _vector("r_w", r_w)
    r_v = _vector("r_v", r_v, r_w)
    r_ww = _vector("r_ww", r_ww, r_w)
    r_wv = _vector("r_wv", r_wv, r_w)
    r_vv = _vector("r_vv", r_vv, r_w)
    p1 = _function("p1", p1, r_w)
    q1 = _function("q1", q1, r_w)
    p2 = _function("p2", p2, r_w)
    q2 = _function("q2", q2, r_w)
    p_u = p1 * r_w + q1 * r_v
    p_uu = p1**2 * r_ww + 2 * p1 * q1 * r_wv + p2 * r_w + q1**2 * r_vv + q2 * r_v
    return p_u, p_uu
