"""Thin-plate energy: integrand and blocks of its quadratic form (CasADi).

Written by `semispline generate` from derivations/energy.py.
Do not edit: change the derivation and generate again.
Operations: 12 in 2 functions.
"""

from __future__ import annotations

from typing import Any

import casadi


def _number(name: str, value: Any) -> Any:
    shape = tuple(getattr(value, "shape", ()))
    if shape not in ((), (1, 1)):
        raise ValueError(f"{name}: shape {shape}, expected a single number of shape () or (1, 1)")
    return value


def _vector(name: str, value: Any) -> Any:
    vector = value if isinstance(value, (casadi.SX, casadi.MX, casadi.DM)) else casadi.DM(value)
    if tuple(vector.shape) != (3, 1):
        raise ValueError(f"{name}: shape {tuple(vector.shape)}, expected (3, 1)")
    return vector


def _same_shape(**blocks: Any) -> None:
    shapes = {name: tuple(getattr(block, "shape", ())) for name, block in blocks.items()}
    expected = max(shapes.values(), key=lambda shape: (len(shape), shape))
    for name, shape in shapes.items():
        if shape not in ((), (1, 1), expected):
            raise ValueError(f"{name}: shape {shape}, expected () or {expected}")


def thin_plate_density(p_uu: Any, p_uv: Any, p_vv: Any) -> Any:
    """Integrand of the thin-plate energy.

    Parameters
    ----------
    p_uu : shape (3, 1)
        P_uu.
    p_uv : shape (3, 1)
        P_uv.
    p_vv : shape (3, 1)
        P_vv.

    Returns
    -------
    density : a number

    Raises
    ------
    ValueError
        Naming the argument and what it should be.

    Source: equation (11), derivations/energy.py. Operations: 6.
    """
    p_uu = _vector("p_uu", p_uu)
    p_uv = _vector("p_uv", p_uv)
    p_vv = _vector("p_vv", p_vv)
    density = p_uu**2 + 2 * p_uv**2 + p_vv**2
    return casadi.sum1(density)


def gram_block(A0: Any, A1: Any, A2: Any, G0: Any, G1: Any, G2: Any) -> Any:
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
