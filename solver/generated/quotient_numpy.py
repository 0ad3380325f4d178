"""Derivatives of a rational surface from its homogeneous ones, and their adjoints (NumPy).

Written by `semispline generate` from derivations/homogeneous.py.
Do not edit: change the derivation and generate again.
Operations: 895 in 2 functions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def quotient(planes: Iterable[FloatArray]) -> FloatArray:
    """Derivatives of order 1 to 3 of a surface X / W.

    In: h_x, h_y, h_z, h_w, h_u_x, h_u_y, h_u_z, h_u_w, h_v_x, h_v_y, h_v_z, h_v_w, h_uu_x, h_uu_y, h_uu_z, h_uu_w,
        h_uv_x, h_uv_y, h_uv_z, h_uv_w, h_vv_x, h_vv_y, h_vv_z, h_vv_w, h_uuu_x, h_uuu_y, h_uuu_z, h_uuu_w, h_uuv_x,
        h_uuv_y, h_uuv_z, h_uuv_w, h_uvv_x, h_uvv_y, h_uvv_z, h_uvv_w, h_vvv_x, h_vvv_y, h_vvv_z, h_vvv_w.
    Out: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z.

    Source: derivations/homogeneous.py. Operations: 220.
    """
    (
        h_x,
        h_y,
        h_z,
        h_w,
        h_u_x,
        h_u_y,
        h_u_z,
        h_u_w,
        h_v_x,
        h_v_y,
        h_v_z,
        h_v_w,
        h_uu_x,
        h_uu_y,
        h_uu_z,
        h_uu_w,
        h_uv_x,
        h_uv_y,
        h_uv_z,
        h_uv_w,
        h_vv_x,
        h_vv_y,
        h_vv_z,
        h_vv_w,
        h_uuu_x,
        h_uuu_y,
        h_uuu_z,
        h_uuu_w,
        h_uuv_x,
        h_uuv_y,
        h_uuv_z,
        h_uuv_w,
        h_uvv_x,
        h_uvv_y,
        h_uvv_z,
        h_uvv_w,
        h_vvv_x,
        h_vvv_y,
        h_vvv_z,
        h_vvv_w,
    ) = planes
    per_w = 1 / h_w
    share_u = h_u_w * per_w
    share_v = h_v_w * per_w
    share_uu = h_uu_w * per_w
    share_uv = h_uv_w * per_w
    share_vv = h_vv_w * per_w
    share_uuu = h_uuu_w * per_w
    share_uuv = h_uuv_w * per_w
    share_uvv = h_uvv_w * per_w
    share_vvv = h_vvv_w * per_w
    p_x = h_x * per_w
    p_u_x = h_u_x * per_w - p_x * share_u
    p_v_x = h_v_x * per_w - p_x * share_v
    p_uu_x = h_uu_x * per_w - 2 * p_u_x * share_u - p_x * share_uu
    p_uv_x = h_uv_x * per_w - p_u_x * share_v - p_v_x * share_u - p_x * share_uv
    p_vv_x = h_vv_x * per_w - 2 * p_v_x * share_v - p_x * share_vv
    p_uuu_x = h_uuu_x * per_w - 3 * p_u_x * share_uu - 3 * p_uu_x * share_u - p_x * share_uuu
    p_uuv_x = (
        h_uuv_x * per_w
        - 2 * p_u_x * share_uv
        - p_uu_x * share_v
        - 2 * p_uv_x * share_u
        - p_v_x * share_uu
        - p_x * share_uuv
    )
    p_uvv_x = (
        h_uvv_x * per_w
        - p_u_x * share_vv
        - 2 * p_uv_x * share_v
        - 2 * p_v_x * share_uv
        - p_vv_x * share_u
        - p_x * share_uvv
    )
    p_vvv_x = h_vvv_x * per_w - 3 * p_v_x * share_vv - 3 * p_vv_x * share_v - p_x * share_vvv
    p_y = h_y * per_w
    p_u_y = h_u_y * per_w - p_y * share_u
    p_v_y = h_v_y * per_w - p_y * share_v
    p_uu_y = h_uu_y * per_w - 2 * p_u_y * share_u - p_y * share_uu
    p_uv_y = h_uv_y * per_w - p_u_y * share_v - p_v_y * share_u - p_y * share_uv
    p_vv_y = h_vv_y * per_w - 2 * p_v_y * share_v - p_y * share_vv
    p_uuu_y = h_uuu_y * per_w - 3 * p_u_y * share_uu - 3 * p_uu_y * share_u - p_y * share_uuu
    p_uuv_y = (
        h_uuv_y * per_w
        - 2 * p_u_y * share_uv
        - p_uu_y * share_v
        - 2 * p_uv_y * share_u
        - p_v_y * share_uu
        - p_y * share_uuv
    )
    p_uvv_y = (
        h_uvv_y * per_w
        - p_u_y * share_vv
        - 2 * p_uv_y * share_v
        - 2 * p_v_y * share_uv
        - p_vv_y * share_u
        - p_y * share_uvv
    )
    p_vvv_y = h_vvv_y * per_w - 3 * p_v_y * share_vv - 3 * p_vv_y * share_v - p_y * share_vvv
    p_z = h_z * per_w
    p_u_z = h_u_z * per_w - p_z * share_u
    p_v_z = h_v_z * per_w - p_z * share_v
    p_uu_z = h_uu_z * per_w - 2 * p_u_z * share_u - p_z * share_uu
    p_uv_z = h_uv_z * per_w - p_u_z * share_v - p_v_z * share_u - p_z * share_uv
    p_vv_z = h_vv_z * per_w - 2 * p_v_z * share_v - p_z * share_vv
    p_uuu_z = h_uuu_z * per_w - 3 * p_u_z * share_uu - 3 * p_uu_z * share_u - p_z * share_uuu
    p_uuv_z = (
        h_uuv_z * per_w
        - 2 * p_u_z * share_uv
        - p_uu_z * share_v
        - 2 * p_uv_z * share_u
        - p_v_z * share_uu
        - p_z * share_uuv
    )
    p_uvv_z = (
        h_uvv_z * per_w
        - p_u_z * share_vv
        - 2 * p_uv_z * share_v
        - 2 * p_v_z * share_uv
        - p_vv_z * share_u
        - p_z * share_uvv
    )
    p_vvv_z = h_vvv_z * per_w - 3 * p_v_z * share_vv - 3 * p_vv_z * share_v - p_z * share_vvv
    return np.stack(
        [
            p_u_x,
            p_u_y,
            p_u_z,
            p_v_x,
            p_v_y,
            p_v_z,
            p_uu_x,
            p_uu_y,
            p_uu_z,
            p_uv_x,
            p_uv_y,
            p_uv_z,
            p_vv_x,
            p_vv_y,
            p_vv_z,
            p_uuu_x,
            p_uuu_y,
            p_uuu_z,
            p_uuv_x,
            p_uuv_y,
            p_uuv_z,
            p_uvv_x,
            p_uvv_y,
            p_uvv_z,
            p_vvv_x,
            p_vvv_y,
            p_vvv_z,
        ]
    )


def quotient_pullback(
    planes: Iterable[FloatArray],
) -> tuple[FloatArray, Callable[[Iterable[FloatArray]], FloatArray]]:
    """Derivatives of order 1 to 3 of a surface X / W; and the adjoints of those of (X, W).

    In: h_x, h_y, h_z, h_w, h_u_x, h_u_y, h_u_z, h_u_w, h_v_x, h_v_y, h_v_z, h_v_w, h_uu_x, h_uu_y, h_uu_z, h_uu_w,
        h_uv_x, h_uv_y, h_uv_z, h_uv_w, h_vv_x, h_vv_y, h_vv_z, h_vv_w, h_uuu_x, h_uuu_y, h_uuu_z, h_uuu_w, h_uuv_x,
        h_uuv_y, h_uuv_z, h_uuv_w, h_uvv_x, h_uvv_y, h_uvv_z, h_uvv_w, h_vvv_x, h_vvv_y, h_vvv_z, h_vvv_w.
    Out: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z.
    Seeds: seed_p_u_x, seed_p_u_y, seed_p_u_z, seed_p_v_x, seed_p_v_y, seed_p_v_z, seed_p_uu_x, seed_p_uu_y,
        seed_p_uu_z, seed_p_uv_x, seed_p_uv_y, seed_p_uv_z, seed_p_vv_x, seed_p_vv_y, seed_p_vv_z, seed_p_uuu_x,
        seed_p_uuu_y, seed_p_uuu_z, seed_p_uuv_x, seed_p_uuv_y, seed_p_uuv_z, seed_p_uvv_x, seed_p_uvv_y, seed_p_uvv_z,
        seed_p_vvv_x, seed_p_vvv_y, seed_p_vvv_z.
    Adjoints: d_h_x, d_h_y, d_h_z, d_h_w, d_h_u_x, d_h_u_y, d_h_u_z, d_h_u_w, d_h_v_x, d_h_v_y, d_h_v_z, d_h_v_w,
        d_h_uu_x, d_h_uu_y, d_h_uu_z, d_h_uu_w, d_h_uv_x, d_h_uv_y, d_h_uv_z, d_h_uv_w, d_h_vv_x, d_h_vv_y, d_h_vv_z,
        d_h_vv_w, d_h_uuu_x, d_h_uuu_y, d_h_uuu_z, d_h_uuu_w, d_h_uuv_x, d_h_uuv_y, d_h_uuv_z, d_h_uuv_w, d_h_uvv_x,
        d_h_uvv_y, d_h_uvv_z, d_h_uvv_w, d_h_vvv_x, d_h_vvv_y, d_h_vvv_z, d_h_vvv_w.

    Source: derivations/homogeneous.py. Operations: 675.
    """
    (
        h_x,
        h_y,
        h_z,
        h_w,
        h_u_x,
        h_u_y,
        h_u_z,
        h_u_w,
        h_v_x,
        h_v_y,
        h_v_z,
        h_v_w,
        h_uu_x,
        h_uu_y,
        h_uu_z,
        h_uu_w,
        h_uv_x,
        h_uv_y,
        h_uv_z,
        h_uv_w,
        h_vv_x,
        h_vv_y,
        h_vv_z,
        h_vv_w,
        h_uuu_x,
        h_uuu_y,
        h_uuu_z,
        h_uuu_w,
        h_uuv_x,
        h_uuv_y,
        h_uuv_z,
        h_uuv_w,
        h_uvv_x,
        h_uvv_y,
        h_uvv_z,
        h_uvv_w,
        h_vvv_x,
        h_vvv_y,
        h_vvv_z,
        h_vvv_w,
    ) = planes
    per_w = 1 / h_w
    share_u = h_u_w * per_w
    share_v = h_v_w * per_w
    share_uu = h_uu_w * per_w
    share_uv = h_uv_w * per_w
    share_vv = h_vv_w * per_w
    share_uuu = h_uuu_w * per_w
    share_uuv = h_uuv_w * per_w
    share_uvv = h_uvv_w * per_w
    share_vvv = h_vvv_w * per_w
    p_x = h_x * per_w
    p_u_x = h_u_x * per_w - p_x * share_u
    p_v_x = h_v_x * per_w - p_x * share_v
    p_uu_x = h_uu_x * per_w - 2 * p_u_x * share_u - p_x * share_uu
    p_uv_x = h_uv_x * per_w - p_u_x * share_v - p_v_x * share_u - p_x * share_uv
    p_vv_x = h_vv_x * per_w - 2 * p_v_x * share_v - p_x * share_vv
    p_uuu_x = h_uuu_x * per_w - 3 * p_u_x * share_uu - 3 * p_uu_x * share_u - p_x * share_uuu
    p_uuv_x = (
        h_uuv_x * per_w
        - 2 * p_u_x * share_uv
        - p_uu_x * share_v
        - 2 * p_uv_x * share_u
        - p_v_x * share_uu
        - p_x * share_uuv
    )
    p_uvv_x = (
        h_uvv_x * per_w
        - p_u_x * share_vv
        - 2 * p_uv_x * share_v
        - 2 * p_v_x * share_uv
        - p_vv_x * share_u
        - p_x * share_uvv
    )
    p_vvv_x = h_vvv_x * per_w - 3 * p_v_x * share_vv - 3 * p_vv_x * share_v - p_x * share_vvv
    p_y = h_y * per_w
    p_u_y = h_u_y * per_w - p_y * share_u
    p_v_y = h_v_y * per_w - p_y * share_v
    p_uu_y = h_uu_y * per_w - 2 * p_u_y * share_u - p_y * share_uu
    p_uv_y = h_uv_y * per_w - p_u_y * share_v - p_v_y * share_u - p_y * share_uv
    p_vv_y = h_vv_y * per_w - 2 * p_v_y * share_v - p_y * share_vv
    p_uuu_y = h_uuu_y * per_w - 3 * p_u_y * share_uu - 3 * p_uu_y * share_u - p_y * share_uuu
    p_uuv_y = (
        h_uuv_y * per_w
        - 2 * p_u_y * share_uv
        - p_uu_y * share_v
        - 2 * p_uv_y * share_u
        - p_v_y * share_uu
        - p_y * share_uuv
    )
    p_uvv_y = (
        h_uvv_y * per_w
        - p_u_y * share_vv
        - 2 * p_uv_y * share_v
        - 2 * p_v_y * share_uv
        - p_vv_y * share_u
        - p_y * share_uvv
    )
    p_vvv_y = h_vvv_y * per_w - 3 * p_v_y * share_vv - 3 * p_vv_y * share_v - p_y * share_vvv
    p_z = h_z * per_w
    p_u_z = h_u_z * per_w - p_z * share_u
    p_v_z = h_v_z * per_w - p_z * share_v
    p_uu_z = h_uu_z * per_w - 2 * p_u_z * share_u - p_z * share_uu
    p_uv_z = h_uv_z * per_w - p_u_z * share_v - p_v_z * share_u - p_z * share_uv
    p_vv_z = h_vv_z * per_w - 2 * p_v_z * share_v - p_z * share_vv
    p_uuu_z = h_uuu_z * per_w - 3 * p_u_z * share_uu - 3 * p_uu_z * share_u - p_z * share_uuu
    p_uuv_z = (
        h_uuv_z * per_w
        - 2 * p_u_z * share_uv
        - p_uu_z * share_v
        - 2 * p_uv_z * share_u
        - p_v_z * share_uu
        - p_z * share_uuv
    )
    p_uvv_z = (
        h_uvv_z * per_w
        - p_u_z * share_vv
        - 2 * p_uv_z * share_v
        - 2 * p_v_z * share_uv
        - p_vv_z * share_u
        - p_z * share_uvv
    )
    p_vvv_z = h_vvv_z * per_w - 3 * p_v_z * share_vv - 3 * p_vv_z * share_v - p_z * share_vvv

    def pullback(seeds: Iterable[FloatArray]) -> FloatArray:
        (
            seed_p_u_x,
            seed_p_u_y,
            seed_p_u_z,
            seed_p_v_x,
            seed_p_v_y,
            seed_p_v_z,
            seed_p_uu_x,
            seed_p_uu_y,
            seed_p_uu_z,
            seed_p_uv_x,
            seed_p_uv_y,
            seed_p_uv_z,
            seed_p_vv_x,
            seed_p_vv_y,
            seed_p_vv_z,
            seed_p_uuu_x,
            seed_p_uuu_y,
            seed_p_uuu_z,
            seed_p_uuv_x,
            seed_p_uuv_y,
            seed_p_uuv_z,
            seed_p_uvv_x,
            seed_p_uvv_y,
            seed_p_uvv_z,
            seed_p_vvv_x,
            seed_p_vvv_y,
            seed_p_vvv_z,
        ) = seeds
        d2_p_uvv_z = 2 * seed_p_uvv_z
        d2_p_uuv_z = 2 * seed_p_uuv_z
        d_p_vv_z = seed_p_vv_z - seed_p_uvv_z * share_u - 3 * seed_p_vvv_z * share_v
        d2_p_vv_z = 2 * d_p_vv_z
        d_p_uv_z = seed_p_uv_z - d2_p_uuv_z * share_u - d2_p_uvv_z * share_v
        d_p_uu_z = seed_p_uu_z - 3 * seed_p_uuu_z * share_u - seed_p_uuv_z * share_v
        d2_p_uu_z = 2 * d_p_uu_z
        d_p_v_z = (
            seed_p_v_z
            - d2_p_uvv_z * share_uv
            - d2_p_vv_z * share_v
            - d_p_uv_z * share_u
            - seed_p_uuv_z * share_uu
            - 3 * seed_p_vvv_z * share_vv
        )
        d_p_u_z = (
            seed_p_u_z
            - d2_p_uu_z * share_u
            - d2_p_uuv_z * share_uv
            - d_p_uv_z * share_v
            - 3 * seed_p_uuu_z * share_uu
            - seed_p_uvv_z * share_vv
        )
        d_p_z = (
            -d_p_u_z * share_u
            - d_p_uu_z * share_uu
            - d_p_uv_z * share_uv
            - d_p_v_z * share_v
            - d_p_vv_z * share_vv
            - seed_p_uuu_z * share_uuu
            - seed_p_uuv_z * share_uuv
            - seed_p_uvv_z * share_uvv
            - seed_p_vvv_z * share_vvv
        )
        d2_p_uvv_y = 2 * seed_p_uvv_y
        d2_p_uuv_y = 2 * seed_p_uuv_y
        d_p_vv_y = seed_p_vv_y - seed_p_uvv_y * share_u - 3 * seed_p_vvv_y * share_v
        d2_p_vv_y = 2 * d_p_vv_y
        d_p_uv_y = seed_p_uv_y - d2_p_uuv_y * share_u - d2_p_uvv_y * share_v
        d_p_uu_y = seed_p_uu_y - 3 * seed_p_uuu_y * share_u - seed_p_uuv_y * share_v
        d2_p_uu_y = 2 * d_p_uu_y
        d_p_v_y = (
            seed_p_v_y
            - d2_p_uvv_y * share_uv
            - d2_p_vv_y * share_v
            - d_p_uv_y * share_u
            - seed_p_uuv_y * share_uu
            - 3 * seed_p_vvv_y * share_vv
        )
        d_p_u_y = (
            seed_p_u_y
            - d2_p_uu_y * share_u
            - d2_p_uuv_y * share_uv
            - d_p_uv_y * share_v
            - 3 * seed_p_uuu_y * share_uu
            - seed_p_uvv_y * share_vv
        )
        d_p_y = (
            -d_p_u_y * share_u
            - d_p_uu_y * share_uu
            - d_p_uv_y * share_uv
            - d_p_v_y * share_v
            - d_p_vv_y * share_vv
            - seed_p_uuu_y * share_uuu
            - seed_p_uuv_y * share_uuv
            - seed_p_uvv_y * share_uvv
            - seed_p_vvv_y * share_vvv
        )
        d2_p_uvv_x = 2 * seed_p_uvv_x
        d2_p_uuv_x = 2 * seed_p_uuv_x
        d_p_vv_x = seed_p_vv_x - seed_p_uvv_x * share_u - 3 * seed_p_vvv_x * share_v
        d2_p_vv_x = 2 * d_p_vv_x
        d_p_uv_x = seed_p_uv_x - d2_p_uuv_x * share_u - d2_p_uvv_x * share_v
        d_p_uu_x = seed_p_uu_x - 3 * seed_p_uuu_x * share_u - seed_p_uuv_x * share_v
        d2_p_uu_x = 2 * d_p_uu_x
        d_p_v_x = (
            seed_p_v_x
            - d2_p_uvv_x * share_uv
            - d2_p_vv_x * share_v
            - d_p_uv_x * share_u
            - seed_p_uuv_x * share_uu
            - 3 * seed_p_vvv_x * share_vv
        )
        d_p_u_x = (
            seed_p_u_x
            - d2_p_uu_x * share_u
            - d2_p_uuv_x * share_uv
            - d_p_uv_x * share_v
            - 3 * seed_p_uuu_x * share_uu
            - seed_p_uvv_x * share_vv
        )
        d_p_x = (
            -d_p_u_x * share_u
            - d_p_uu_x * share_uu
            - d_p_uv_x * share_uv
            - d_p_v_x * share_v
            - d_p_vv_x * share_vv
            - seed_p_uuu_x * share_uuu
            - seed_p_uuv_x * share_uuv
            - seed_p_uvv_x * share_uvv
            - seed_p_vvv_x * share_vvv
        )
        d_share_vvv = -p_x * seed_p_vvv_x - p_y * seed_p_vvv_y - p_z * seed_p_vvv_z
        d_share_uvv = -p_x * seed_p_uvv_x - p_y * seed_p_uvv_y - p_z * seed_p_uvv_z
        d_share_uuv = -p_x * seed_p_uuv_x - p_y * seed_p_uuv_y - p_z * seed_p_uuv_z
        d_share_uuu = -p_x * seed_p_uuu_x - p_y * seed_p_uuu_y - p_z * seed_p_uuu_z
        d_share_vv = (
            -d_p_vv_x * p_x
            - d_p_vv_y * p_y
            - d_p_vv_z * p_z
            - p_u_x * seed_p_uvv_x
            - p_u_y * seed_p_uvv_y
            - p_u_z * seed_p_uvv_z
            - 3 * p_v_x * seed_p_vvv_x
            - 3 * p_v_y * seed_p_vvv_y
            - 3 * p_v_z * seed_p_vvv_z
        )
        d_share_uv = (
            -d2_p_uuv_x * p_u_x
            - d2_p_uuv_y * p_u_y
            - d2_p_uuv_z * p_u_z
            - d2_p_uvv_x * p_v_x
            - d2_p_uvv_y * p_v_y
            - d2_p_uvv_z * p_v_z
            - d_p_uv_x * p_x
            - d_p_uv_y * p_y
            - d_p_uv_z * p_z
        )
        d_share_uu = (
            -d_p_uu_x * p_x
            - d_p_uu_y * p_y
            - d_p_uu_z * p_z
            - 3 * p_u_x * seed_p_uuu_x
            - 3 * p_u_y * seed_p_uuu_y
            - 3 * p_u_z * seed_p_uuu_z
            - p_v_x * seed_p_uuv_x
            - p_v_y * seed_p_uuv_y
            - p_v_z * seed_p_uuv_z
        )
        d_share_v = (
            -d2_p_uvv_x * p_uv_x
            - d2_p_uvv_y * p_uv_y
            - d2_p_uvv_z * p_uv_z
            - d2_p_vv_x * p_v_x
            - d2_p_vv_y * p_v_y
            - d2_p_vv_z * p_v_z
            - d_p_uv_x * p_u_x
            - d_p_uv_y * p_u_y
            - d_p_uv_z * p_u_z
            - d_p_v_x * p_x
            - d_p_v_y * p_y
            - d_p_v_z * p_z
            - p_uu_x * seed_p_uuv_x
            - p_uu_y * seed_p_uuv_y
            - p_uu_z * seed_p_uuv_z
            - 3 * p_vv_x * seed_p_vvv_x
            - 3 * p_vv_y * seed_p_vvv_y
            - 3 * p_vv_z * seed_p_vvv_z
        )
        d_share_u = (
            -d2_p_uu_x * p_u_x
            - d2_p_uu_y * p_u_y
            - d2_p_uu_z * p_u_z
            - d2_p_uuv_x * p_uv_x
            - d2_p_uuv_y * p_uv_y
            - d2_p_uuv_z * p_uv_z
            - d_p_u_x * p_x
            - d_p_u_y * p_y
            - d_p_u_z * p_z
            - d_p_uv_x * p_v_x
            - d_p_uv_y * p_v_y
            - d_p_uv_z * p_v_z
            - 3 * p_uu_x * seed_p_uuu_x
            - 3 * p_uu_y * seed_p_uuu_y
            - 3 * p_uu_z * seed_p_uuu_z
            - p_vv_x * seed_p_uvv_x
            - p_vv_y * seed_p_uvv_y
            - p_vv_z * seed_p_uvv_z
        )
        d_per_w = (
            d_p_u_x * h_u_x
            + d_p_u_y * h_u_y
            + d_p_u_z * h_u_z
            + d_p_uu_x * h_uu_x
            + d_p_uu_y * h_uu_y
            + d_p_uu_z * h_uu_z
            + d_p_uv_x * h_uv_x
            + d_p_uv_y * h_uv_y
            + d_p_uv_z * h_uv_z
            + d_p_v_x * h_v_x
            + d_p_v_y * h_v_y
            + d_p_v_z * h_v_z
            + d_p_vv_x * h_vv_x
            + d_p_vv_y * h_vv_y
            + d_p_vv_z * h_vv_z
            + d_p_x * h_x
            + d_p_y * h_y
            + d_p_z * h_z
            + d_share_u * h_u_w
            + d_share_uu * h_uu_w
            + d_share_uuu * h_uuu_w
            + d_share_uuv * h_uuv_w
            + d_share_uv * h_uv_w
            + d_share_uvv * h_uvv_w
            + d_share_v * h_v_w
            + d_share_vv * h_vv_w
            + d_share_vvv * h_vvv_w
            + h_uuu_x * seed_p_uuu_x
            + h_uuu_y * seed_p_uuu_y
            + h_uuu_z * seed_p_uuu_z
            + h_uuv_x * seed_p_uuv_x
            + h_uuv_y * seed_p_uuv_y
            + h_uuv_z * seed_p_uuv_z
            + h_uvv_x * seed_p_uvv_x
            + h_uvv_y * seed_p_uvv_y
            + h_uvv_z * seed_p_uvv_z
            + h_vvv_x * seed_p_vvv_x
            + h_vvv_y * seed_p_vvv_y
            + h_vvv_z * seed_p_vvv_z
        )
        d_h_x = d_p_x * per_w
        d_h_y = d_p_y * per_w
        d_h_z = d_p_z * per_w
        d_h_w = -d_per_w * per_w**2
        d_h_u_x = d_p_u_x * per_w
        d_h_u_y = d_p_u_y * per_w
        d_h_u_z = d_p_u_z * per_w
        d_h_u_w = d_share_u * per_w
        d_h_v_x = d_p_v_x * per_w
        d_h_v_y = d_p_v_y * per_w
        d_h_v_z = d_p_v_z * per_w
        d_h_v_w = d_share_v * per_w
        d_h_uu_x = d_p_uu_x * per_w
        d_h_uu_y = d_p_uu_y * per_w
        d_h_uu_z = d_p_uu_z * per_w
        d_h_uu_w = d_share_uu * per_w
        d_h_uv_x = d_p_uv_x * per_w
        d_h_uv_y = d_p_uv_y * per_w
        d_h_uv_z = d_p_uv_z * per_w
        d_h_uv_w = d_share_uv * per_w
        d_h_vv_x = d_p_vv_x * per_w
        d_h_vv_y = d_p_vv_y * per_w
        d_h_vv_z = d_p_vv_z * per_w
        d_h_vv_w = d_share_vv * per_w
        d_h_uuu_x = per_w * seed_p_uuu_x
        d_h_uuu_y = per_w * seed_p_uuu_y
        d_h_uuu_z = per_w * seed_p_uuu_z
        d_h_uuu_w = d_share_uuu * per_w
        d_h_uuv_x = per_w * seed_p_uuv_x
        d_h_uuv_y = per_w * seed_p_uuv_y
        d_h_uuv_z = per_w * seed_p_uuv_z
        d_h_uuv_w = d_share_uuv * per_w
        d_h_uvv_x = per_w * seed_p_uvv_x
        d_h_uvv_y = per_w * seed_p_uvv_y
        d_h_uvv_z = per_w * seed_p_uvv_z
        d_h_uvv_w = d_share_uvv * per_w
        d_h_vvv_x = per_w * seed_p_vvv_x
        d_h_vvv_y = per_w * seed_p_vvv_y
        d_h_vvv_z = per_w * seed_p_vvv_z
        d_h_vvv_w = d_share_vvv * per_w
        return np.stack(
            [
                d_h_x,
                d_h_y,
                d_h_z,
                d_h_w,
                d_h_u_x,
                d_h_u_y,
                d_h_u_z,
                d_h_u_w,
                d_h_v_x,
                d_h_v_y,
                d_h_v_z,
                d_h_v_w,
                d_h_uu_x,
                d_h_uu_y,
                d_h_uu_z,
                d_h_uu_w,
                d_h_uv_x,
                d_h_uv_y,
                d_h_uv_z,
                d_h_uv_w,
                d_h_vv_x,
                d_h_vv_y,
                d_h_vv_z,
                d_h_vv_w,
                d_h_uuu_x,
                d_h_uuu_y,
                d_h_uuu_z,
                d_h_uuu_w,
                d_h_uuv_x,
                d_h_uuv_y,
                d_h_uuv_z,
                d_h_uuv_w,
                d_h_uvv_x,
                d_h_uvv_y,
                d_h_uvv_z,
                d_h_uvv_w,
                d_h_vvv_x,
                d_h_vvv_y,
                d_h_vvv_z,
                d_h_vvv_w,
            ]
        )

    return np.stack(
        [
            p_u_x,
            p_u_y,
            p_u_z,
            p_v_x,
            p_v_y,
            p_v_z,
            p_uu_x,
            p_uu_y,
            p_uu_z,
            p_uv_x,
            p_uv_y,
            p_uv_z,
            p_vv_x,
            p_vv_y,
            p_vv_z,
            p_uuu_x,
            p_uuu_y,
            p_uuu_z,
            p_uuv_x,
            p_uuv_y,
            p_uuv_z,
            p_uvv_x,
            p_uvv_y,
            p_uvv_z,
            p_vvv_x,
            p_vvv_y,
            p_vvv_z,
        ]
    ), pullback
