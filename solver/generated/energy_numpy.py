"""Thin-plate energy: integrand and blocks of its quadratic form (NumPy).

Written by `semispline generate` from derivations/energy.py.
Do not edit: change the derivation and generate again.
Operations: 12 in 2 functions.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def _number(name: str, value: float) -> float:
    if np.shape(value) != ():
        raise ValueError(f"{name}: shape {np.shape(value)}, expected a single number of shape ()")
    return float(value)


def _vector(name: str, value: ArrayLike, like: FloatArray | None = None) -> FloatArray:
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape[-1:] != (3,) or (like is not None and vector.shape != like.shape):
        raise ValueError(f"{name}: shape {vector.shape}, expected {'(..., 3)' if like is None else like.shape}")
    return vector


def _same_shape(**blocks: Any) -> None:
    shapes = {name: np.shape(block) for name, block in blocks.items()}
    expected = max(shapes.values(), key=len)
    for name, shape in shapes.items():
        if shape not in ((), expected):
            raise ValueError(f"{name}: shape {shape}, expected () or {expected}")


def thin_plate_density(p_uu: ArrayLike, p_uv: ArrayLike, p_vv: ArrayLike) -> FloatArray:
    """Integrand of the thin-plate energy.

    Parameters
    ----------
    p_uu : shape (..., 3), the same for all
        P_uu.
    p_uv : shape (..., 3), the same for all
        P_uv.
    p_vv : shape (..., 3), the same for all
        P_vv.

    Returns
    -------
    density : shape (...)

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: equation (11), derivations/energy.py. Operations: 6.
    """
    p_uu = _vector("p_uu", p_uu)
    p_uv = _vector("p_uv", p_uv, p_uu)
    p_vv = _vector("p_vv", p_vv, p_uu)
    density = p_uu**2 + 2 * p_uv**2 + p_vv**2
    return np.asarray(np.sum(density, axis=-1))


def gram_block(A0: float, A1: float, A2: float, G0: Any, G1: Any, G2: Any) -> Any:
    """Block of the quadratic form of the energy that couples v-control curves i and i'.

    Parameters
    ----------
    A0 : a number
        Integral of N_i^(0) N_i'^(0) du.
    A1 : a number
        Integral of N_i^(1) N_i'^(1) du.
    A2 : a number
        Integral of N_i^(2) N_i'^(2) du.
    G0 : a number or a matrix, the same shape for all matrices
        Integrals of B_j^(0) B_j'^(0) dv over V_i and V_i'.
    G1 : a number or a matrix, the same shape for all matrices
        Integrals of B_j^(1) B_j'^(1) dv over V_i and V_i'.
    G2 : a number or a matrix, the same shape for all matrices
        Integrals of B_j^(2) B_j'^(2) dv over V_i and V_i'.

    Returns
    -------
    K : a number or a matrix, the same shape for all matrices

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: equation (11), derivations/energy.py. Operations: 6.
    """
    A0 = _number("A0", A0)
    A1 = _number("A1", A1)
    A2 = _number("A2", A2)
    _same_shape(G0=G0, G1=G1, G2=G2)
    return A0 * G2 + 2 * A1 * G1 + A2 * G0
