"""Fairness: |grad H|^2 dA of a surface from its derivatives, and the gradient of what is made of it (NumPy).

Written by `semispline generate` from derivations/fairness.py.
Do not edit: change the derivation and generate again.
Operations: 1051 in 2 functions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def fairness(planes: Iterable[FloatArray]) -> FloatArray:
    """|grad H|^2 per du dv, area element, mean curvature, speed along u.

    In: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z.
    Out: rough, area, mean, speed.

    Source: derivations/fairness.py. Operations: 261.
    """
    (
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
    ) = planes
    m_x = p_u_y * p_v_z - p_u_z * p_v_y
    m_y = p_u_z * p_v_x - p_u_x * p_v_z
    m_z = p_u_x * p_v_y - p_u_y * p_v_x
    e = p_u_x**2 + p_u_y**2 + p_u_z**2
    f = p_u_x * p_v_x + p_u_y * p_v_y + p_u_z * p_v_z
    g = p_v_x**2 + p_v_y**2 + p_v_z**2
    w2 = m_x**2 + m_y**2 + m_z**2
    area = np.sqrt(w2)
    per_w2 = 1 / w2
    per_w = area * per_w2
    per_cube = per_w * per_w2 / 2
    ll = m_x * p_uu_x + m_y * p_uu_y + m_z * p_uu_z
    k = m_x * p_uv_x + m_y * p_uv_y + m_z * p_uv_z
    n = m_x * p_vv_x + m_y * p_vv_y + m_z * p_vv_z
    f2 = 2 * f
    q = e * n + g * ll - f2 * k
    mean = per_cube * q
    ratio = 3 * per_w2 * q
    mu_x = p_u_y * p_uv_z + p_uu_y * p_v_z - p_u_z * p_uv_y - p_uu_z * p_v_y
    mu_y = p_u_z * p_uv_x + p_uu_z * p_v_x - p_u_x * p_uv_z - p_uu_x * p_v_z
    mu_z = p_u_x * p_uv_y + p_uu_x * p_v_y - p_u_y * p_uv_x - p_uu_y * p_v_x
    half_eu = p_u_x * p_uu_x + p_u_y * p_uu_y + p_u_z * p_uu_z
    half_gu = p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    fu = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z + p_uu_x * p_v_x + p_uu_y * p_v_y + p_uu_z * p_v_z
    lu = m_x * p_uuu_x + m_y * p_uuu_y + m_z * p_uuu_z + mu_x * p_uu_x + mu_y * p_uu_y + mu_z * p_uu_z
    ku = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mu_x * p_uv_x + mu_y * p_uv_y + mu_z * p_uv_z
    nu = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mu_x * p_vv_x + mu_y * p_vv_y + mu_z * p_vv_z
    changed_u = half_eu * n + half_gu * ll - fu * k
    qu = 2 * changed_u + e * nu + g * lu - f2 * ku
    wu = m_x * mu_x + m_y * mu_y + m_z * mu_z
    top_u = qu - ratio * wu
    hu = per_cube * top_u
    mv_x = p_u_y * p_vv_z + p_uv_y * p_v_z - p_u_z * p_vv_y - p_uv_z * p_v_y
    mv_y = p_u_z * p_vv_x + p_uv_z * p_v_x - p_u_x * p_vv_z - p_uv_x * p_v_z
    mv_z = p_u_x * p_vv_y + p_uv_x * p_v_y - p_u_y * p_vv_x - p_uv_y * p_v_x
    half_ev = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z
    half_gv = p_v_x * p_vv_x + p_v_y * p_vv_y + p_v_z * p_vv_z
    fv = p_u_x * p_vv_x + p_u_y * p_vv_y + p_u_z * p_vv_z + p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    lv = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mv_x * p_uu_x + mv_y * p_uu_y + mv_z * p_uu_z
    kv = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mv_x * p_uv_x + mv_y * p_uv_y + mv_z * p_uv_z
    nv = m_x * p_vvv_x + m_y * p_vvv_y + m_z * p_vvv_z + mv_x * p_vv_x + mv_y * p_vv_y + mv_z * p_vv_z
    changed_v = half_ev * n + half_gv * ll - fv * k
    qv = 2 * changed_v + e * nv + g * lv - f2 * kv
    wv = m_x * mv_x + m_y * mv_y + m_z * mv_z
    top_v = qv - ratio * wv
    hv = per_cube * top_v
    along_u = g * hu - f * hv
    along_v = e * hv - f * hu
    form = along_u * hu + along_v * hv
    rough = form * per_w
    speed = np.sqrt(e)
    return np.stack([rough, area, mean, speed])


def fairness_pullback(
    planes: Iterable[FloatArray],
) -> tuple[FloatArray, Callable[[Iterable[FloatArray]], FloatArray]]:
    """|grad H|^2 per du dv, area element, mean curvature, speed along u; and the adjoints of the derivatives.

    In: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z.
    Out: rough, area, mean, speed.
    Seeds: seed_rough, seed_area, seed_mean, seed_speed.
    Adjoints: d_p_u_x, d_p_u_y, d_p_u_z, d_p_v_x, d_p_v_y, d_p_v_z, d_p_uu_x, d_p_uu_y, d_p_uu_z, d_p_uv_x, d_p_uv_y,
        d_p_uv_z, d_p_vv_x, d_p_vv_y, d_p_vv_z, d_p_uuu_x, d_p_uuu_y, d_p_uuu_z, d_p_uuv_x, d_p_uuv_y, d_p_uuv_z,
        d_p_uvv_x, d_p_uvv_y, d_p_uvv_z, d_p_vvv_x, d_p_vvv_y, d_p_vvv_z.

    Source: derivations/fairness.py. Operations: 790.
    """
    (
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
    ) = planes
    m_x = p_u_y * p_v_z - p_u_z * p_v_y
    m_y = p_u_z * p_v_x - p_u_x * p_v_z
    m_z = p_u_x * p_v_y - p_u_y * p_v_x
    e = p_u_x**2 + p_u_y**2 + p_u_z**2
    f = p_u_x * p_v_x + p_u_y * p_v_y + p_u_z * p_v_z
    g = p_v_x**2 + p_v_y**2 + p_v_z**2
    w2 = m_x**2 + m_y**2 + m_z**2
    area = np.sqrt(w2)
    per_w2 = 1 / w2
    per_w = area * per_w2
    per_cube = per_w * per_w2 / 2
    ll = m_x * p_uu_x + m_y * p_uu_y + m_z * p_uu_z
    k = m_x * p_uv_x + m_y * p_uv_y + m_z * p_uv_z
    n = m_x * p_vv_x + m_y * p_vv_y + m_z * p_vv_z
    f2 = 2 * f
    q = e * n + g * ll - f2 * k
    mean = per_cube * q
    ratio = 3 * per_w2 * q
    mu_x = p_u_y * p_uv_z + p_uu_y * p_v_z - p_u_z * p_uv_y - p_uu_z * p_v_y
    mu_y = p_u_z * p_uv_x + p_uu_z * p_v_x - p_u_x * p_uv_z - p_uu_x * p_v_z
    mu_z = p_u_x * p_uv_y + p_uu_x * p_v_y - p_u_y * p_uv_x - p_uu_y * p_v_x
    half_eu = p_u_x * p_uu_x + p_u_y * p_uu_y + p_u_z * p_uu_z
    half_gu = p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    fu = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z + p_uu_x * p_v_x + p_uu_y * p_v_y + p_uu_z * p_v_z
    lu = m_x * p_uuu_x + m_y * p_uuu_y + m_z * p_uuu_z + mu_x * p_uu_x + mu_y * p_uu_y + mu_z * p_uu_z
    ku = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mu_x * p_uv_x + mu_y * p_uv_y + mu_z * p_uv_z
    nu = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mu_x * p_vv_x + mu_y * p_vv_y + mu_z * p_vv_z
    changed_u = half_eu * n + half_gu * ll - fu * k
    qu = 2 * changed_u + e * nu + g * lu - f2 * ku
    wu = m_x * mu_x + m_y * mu_y + m_z * mu_z
    top_u = qu - ratio * wu
    hu = per_cube * top_u
    mv_x = p_u_y * p_vv_z + p_uv_y * p_v_z - p_u_z * p_vv_y - p_uv_z * p_v_y
    mv_y = p_u_z * p_vv_x + p_uv_z * p_v_x - p_u_x * p_vv_z - p_uv_x * p_v_z
    mv_z = p_u_x * p_vv_y + p_uv_x * p_v_y - p_u_y * p_vv_x - p_uv_y * p_v_x
    half_ev = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z
    half_gv = p_v_x * p_vv_x + p_v_y * p_vv_y + p_v_z * p_vv_z
    fv = p_u_x * p_vv_x + p_u_y * p_vv_y + p_u_z * p_vv_z + p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    lv = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mv_x * p_uu_x + mv_y * p_uu_y + mv_z * p_uu_z
    kv = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mv_x * p_uv_x + mv_y * p_uv_y + mv_z * p_uv_z
    nv = m_x * p_vvv_x + m_y * p_vvv_y + m_z * p_vvv_z + mv_x * p_vv_x + mv_y * p_vv_y + mv_z * p_vv_z
    changed_v = half_ev * n + half_gv * ll - fv * k
    qv = 2 * changed_v + e * nv + g * lv - f2 * kv
    wv = m_x * mv_x + m_y * mv_y + m_z * mv_z
    top_v = qv - ratio * wv
    hv = per_cube * top_v
    along_u = g * hu - f * hv
    along_v = e * hv - f * hu
    form = along_u * hu + along_v * hv
    rough = form * per_w
    speed = np.sqrt(e)

    def pullback(seeds: Iterable[FloatArray]) -> FloatArray:
        seed_rough, seed_area, seed_mean, seed_speed = seeds
        d_form = per_w * seed_rough
        d_along_v = d_form * hv
        d_along_u = d_form * hu
        d_hv = along_v * d_form + d_along_v * e - d_along_u * f
        d_top_v = d_hv * per_cube
        d_wv = -d_top_v * ratio
        d_changed_v = 2 * d_top_v
        d_nv = d_top_v * e
        d_kv = -d_top_v * f2
        d_lv = d_top_v * g
        d_fv = -d_changed_v * k
        d_half_gv = d_changed_v * ll
        d_half_ev = d_changed_v * n
        d_mv_z = d_kv * p_uv_z + d_lv * p_uu_z + d_nv * p_vv_z + d_wv * m_z
        d_mv_y = d_kv * p_uv_y + d_lv * p_uu_y + d_nv * p_vv_y + d_wv * m_y
        d_mv_x = d_kv * p_uv_x + d_lv * p_uu_x + d_nv * p_vv_x + d_wv * m_x
        d_hu = along_u * d_form + d_along_u * g - d_along_v * f
        d_top_u = d_hu * per_cube
        d_wu = -d_top_u * ratio
        d_changed_u = 2 * d_top_u
        d_nu = d_top_u * e
        d_ku = -d_top_u * f2
        d_lu = d_top_u * g
        d_fu = -d_changed_u * k
        d_half_gu = d_changed_u * ll
        d_half_eu = d_changed_u * n
        d_mu_z = d_ku * p_uv_z + d_lu * p_uu_z + d_nu * p_vv_z + d_wu * m_z
        d_mu_y = d_ku * p_uv_y + d_lu * p_uu_y + d_nu * p_vv_y + d_wu * m_y
        d_mu_x = d_ku * p_uv_x + d_lu * p_uu_x + d_nu * p_vv_x + d_wu * m_x
        d_ratio = -d_top_u * wu - d_top_v * wv
        d_q = 3 * d_ratio * per_w2 + per_cube * seed_mean
        d_f2 = -d_q * k - d_top_u * ku - d_top_v * kv
        d_n = d_changed_u * half_eu + d_changed_v * half_ev + d_q * e
        d_k = -d_changed_u * fu - d_changed_v * fv - d_q * f2
        d_ll = d_changed_u * half_gu + d_changed_v * half_gv + d_q * g
        d_per_cube = d_hu * top_u + d_hv * top_v + q * seed_mean
        d_per_w = d_per_cube * per_w2 / 2 + form * seed_rough
        d_per_w2 = area * d_per_w + d_per_cube * per_w / 2 + 3 * d_ratio * q
        d_area = d_per_w * per_w2 + seed_area
        d_w2 = d_area / (2 * area) - d_per_w2 * per_w2**2
        d2_w2 = 2 * d_w2
        d_g = d_along_u * hu + d_q * ll + d_top_u * lu + d_top_v * lv
        d2_g = 2 * d_g
        d_f = 2 * d_f2 - d_along_u * hv - d_along_v * hu
        d_e = d_along_v * hv + d_q * n + d_top_u * nu + d_top_v * nv + seed_speed / (2 * speed)
        d2_e = 2 * d_e
        d_m_z = (
            d2_w2 * m_z
            + d_k * p_uv_z
            + d_ku * p_uuv_z
            + d_kv * p_uvv_z
            + d_ll * p_uu_z
            + d_lu * p_uuu_z
            + d_lv * p_uuv_z
            + d_n * p_vv_z
            + d_nu * p_uvv_z
            + d_nv * p_vvv_z
            + d_wu * mu_z
            + d_wv * mv_z
        )
        d_m_y = (
            d2_w2 * m_y
            + d_k * p_uv_y
            + d_ku * p_uuv_y
            + d_kv * p_uvv_y
            + d_ll * p_uu_y
            + d_lu * p_uuu_y
            + d_lv * p_uuv_y
            + d_n * p_vv_y
            + d_nu * p_uvv_y
            + d_nv * p_vvv_y
            + d_wu * mu_y
            + d_wv * mv_y
        )
        d_m_x = (
            d2_w2 * m_x
            + d_k * p_uv_x
            + d_ku * p_uuv_x
            + d_kv * p_uvv_x
            + d_ll * p_uu_x
            + d_lu * p_uuu_x
            + d_lv * p_uuv_x
            + d_n * p_vv_x
            + d_nu * p_uvv_x
            + d_nv * p_vvv_x
            + d_wu * mu_x
            + d_wv * mv_x
        )
        d_p_u_x = (
            d2_e * p_u_x
            + d_f * p_v_x
            + d_fu * p_uv_x
            + d_fv * p_vv_x
            + d_half_eu * p_uu_x
            + d_half_ev * p_uv_x
            + d_m_z * p_v_y
            + d_mu_z * p_uv_y
            + d_mv_z * p_vv_y
            - d_m_y * p_v_z
            - d_mu_y * p_uv_z
            - d_mv_y * p_vv_z
        )
        d_p_u_y = (
            d2_e * p_u_y
            + d_f * p_v_y
            + d_fu * p_uv_y
            + d_fv * p_vv_y
            + d_half_eu * p_uu_y
            + d_half_ev * p_uv_y
            + d_m_x * p_v_z
            + d_mu_x * p_uv_z
            + d_mv_x * p_vv_z
            - d_m_z * p_v_x
            - d_mu_z * p_uv_x
            - d_mv_z * p_vv_x
        )
        d_p_u_z = (
            d2_e * p_u_z
            + d_f * p_v_z
            + d_fu * p_uv_z
            + d_fv * p_vv_z
            + d_half_eu * p_uu_z
            + d_half_ev * p_uv_z
            + d_m_y * p_v_x
            + d_mu_y * p_uv_x
            + d_mv_y * p_vv_x
            - d_m_x * p_v_y
            - d_mu_x * p_uv_y
            - d_mv_x * p_vv_y
        )
        d_p_v_x = (
            d2_g * p_v_x
            + d_f * p_u_x
            + d_fu * p_uu_x
            + d_fv * p_uv_x
            + d_half_gu * p_uv_x
            + d_half_gv * p_vv_x
            + d_m_y * p_u_z
            + d_mu_y * p_uu_z
            + d_mv_y * p_uv_z
            - d_m_z * p_u_y
            - d_mu_z * p_uu_y
            - d_mv_z * p_uv_y
        )
        d_p_v_y = (
            d2_g * p_v_y
            + d_f * p_u_y
            + d_fu * p_uu_y
            + d_fv * p_uv_y
            + d_half_gu * p_uv_y
            + d_half_gv * p_vv_y
            + d_m_z * p_u_x
            + d_mu_z * p_uu_x
            + d_mv_z * p_uv_x
            - d_m_x * p_u_z
            - d_mu_x * p_uu_z
            - d_mv_x * p_uv_z
        )
        d_p_v_z = (
            d2_g * p_v_z
            + d_f * p_u_z
            + d_fu * p_uu_z
            + d_fv * p_uv_z
            + d_half_gu * p_uv_z
            + d_half_gv * p_vv_z
            + d_m_x * p_u_y
            + d_mu_x * p_uu_y
            + d_mv_x * p_uv_y
            - d_m_y * p_u_x
            - d_mu_y * p_uu_x
            - d_mv_y * p_uv_x
        )
        d_p_uu_x = (
            d_fu * p_v_x + d_half_eu * p_u_x + d_ll * m_x + d_lu * mu_x + d_lv * mv_x + d_mu_z * p_v_y - d_mu_y * p_v_z
        )
        d_p_uu_y = (
            d_fu * p_v_y + d_half_eu * p_u_y + d_ll * m_y + d_lu * mu_y + d_lv * mv_y + d_mu_x * p_v_z - d_mu_z * p_v_x
        )
        d_p_uu_z = (
            d_fu * p_v_z + d_half_eu * p_u_z + d_ll * m_z + d_lu * mu_z + d_lv * mv_z + d_mu_y * p_v_x - d_mu_x * p_v_y
        )
        d_p_uv_x = (
            d_fu * p_u_x
            + d_fv * p_v_x
            + d_half_ev * p_u_x
            + d_half_gu * p_v_x
            + d_k * m_x
            + d_ku * mu_x
            + d_kv * mv_x
            + d_mu_y * p_u_z
            + d_mv_z * p_v_y
            - d_mu_z * p_u_y
            - d_mv_y * p_v_z
        )
        d_p_uv_y = (
            d_fu * p_u_y
            + d_fv * p_v_y
            + d_half_ev * p_u_y
            + d_half_gu * p_v_y
            + d_k * m_y
            + d_ku * mu_y
            + d_kv * mv_y
            + d_mu_z * p_u_x
            + d_mv_x * p_v_z
            - d_mu_x * p_u_z
            - d_mv_z * p_v_x
        )
        d_p_uv_z = (
            d_fu * p_u_z
            + d_fv * p_v_z
            + d_half_ev * p_u_z
            + d_half_gu * p_v_z
            + d_k * m_z
            + d_ku * mu_z
            + d_kv * mv_z
            + d_mu_x * p_u_y
            + d_mv_y * p_v_x
            - d_mu_y * p_u_x
            - d_mv_x * p_v_y
        )
        d_p_vv_x = (
            d_fv * p_u_x + d_half_gv * p_v_x + d_mv_y * p_u_z + d_n * m_x + d_nu * mu_x + d_nv * mv_x - d_mv_z * p_u_y
        )
        d_p_vv_y = (
            d_fv * p_u_y + d_half_gv * p_v_y + d_mv_z * p_u_x + d_n * m_y + d_nu * mu_y + d_nv * mv_y - d_mv_x * p_u_z
        )
        d_p_vv_z = (
            d_fv * p_u_z + d_half_gv * p_v_z + d_mv_x * p_u_y + d_n * m_z + d_nu * mu_z + d_nv * mv_z - d_mv_y * p_u_x
        )
        d_p_uuu_x = d_lu * m_x
        d_p_uuu_y = d_lu * m_y
        d_p_uuu_z = d_lu * m_z
        d_p_uuv_x = d_ku * m_x + d_lv * m_x
        d_p_uuv_y = d_ku * m_y + d_lv * m_y
        d_p_uuv_z = d_ku * m_z + d_lv * m_z
        d_p_uvv_x = d_kv * m_x + d_nu * m_x
        d_p_uvv_y = d_kv * m_y + d_nu * m_y
        d_p_uvv_z = d_kv * m_z + d_nu * m_z
        d_p_vvv_x = d_nv * m_x
        d_p_vvv_y = d_nv * m_y
        d_p_vvv_z = d_nv * m_z
        return np.stack(
            [
                d_p_u_x,
                d_p_u_y,
                d_p_u_z,
                d_p_v_x,
                d_p_v_y,
                d_p_v_z,
                d_p_uu_x,
                d_p_uu_y,
                d_p_uu_z,
                d_p_uv_x,
                d_p_uv_y,
                d_p_uv_z,
                d_p_vv_x,
                d_p_vv_y,
                d_p_vv_z,
                d_p_uuu_x,
                d_p_uuu_y,
                d_p_uuu_z,
                d_p_uuv_x,
                d_p_uuv_y,
                d_p_uuv_z,
                d_p_uvv_x,
                d_p_uvv_y,
                d_p_uvv_z,
                d_p_vvv_x,
                d_p_vvv_y,
                d_p_vvv_z,
            ]
        )

    return np.stack([rough, area, mean, speed]), pullback
