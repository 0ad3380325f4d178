"""Fairness: |grad H|^2 dA of a surface from its derivatives, and the gradient of what is made of it (NumPy).

Written by `semispline generate` from derivations/fairness.py.
Do not edit: change the derivation and generate again.
Operations: 1152 in 2 functions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def fairness(planes: FloatArray) -> FloatArray:
    """|grad H|^2 per du dv, area element, mean curvature, speed along u.

    In: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z.
    Out: rough, area, mean, speed.

    Source: derivations/fairness.py. Operations: 275.
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
    ll = m_x * p_uu_x + m_y * p_uu_y + m_z * p_uu_z
    k = m_x * p_uv_x + m_y * p_uv_y + m_z * p_uv_z
    n = m_x * p_vv_x + m_y * p_vv_y + m_z * p_vv_z
    q = e * n + g * ll - 2 * f * k
    cube = 2 * area * w2
    mean = q / cube
    mu_x = p_u_y * p_uv_z + p_uu_y * p_v_z - p_u_z * p_uv_y - p_uu_z * p_v_y
    mu_y = p_u_z * p_uv_x + p_uu_z * p_v_x - p_u_x * p_uv_z - p_uu_x * p_v_z
    mu_z = p_u_x * p_uv_y + p_uu_x * p_v_y - p_u_y * p_uv_x - p_uu_y * p_v_x
    eu = 2 * p_u_x * p_uu_x + 2 * p_u_y * p_uu_y + 2 * p_u_z * p_uu_z
    fu = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z + p_uu_x * p_v_x + p_uu_y * p_v_y + p_uu_z * p_v_z
    gu = 2 * p_uv_x * p_v_x + 2 * p_uv_y * p_v_y + 2 * p_uv_z * p_v_z
    lu = m_x * p_uuu_x + m_y * p_uuu_y + m_z * p_uuu_z + mu_x * p_uu_x + mu_y * p_uu_y + mu_z * p_uu_z
    ku = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mu_x * p_uv_x + mu_y * p_uv_y + mu_z * p_uv_z
    nu = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mu_x * p_vv_x + mu_y * p_vv_y + mu_z * p_vv_z
    qu = e * nu + eu * n + g * lu + gu * ll - 2 * f * ku - 2 * fu * k
    wu = m_x * mu_x + m_y * mu_y + m_z * mu_z
    hu = (qu - 3 * q * wu / w2) / cube
    mv_x = p_u_y * p_vv_z + p_uv_y * p_v_z - p_u_z * p_vv_y - p_uv_z * p_v_y
    mv_y = p_u_z * p_vv_x + p_uv_z * p_v_x - p_u_x * p_vv_z - p_uv_x * p_v_z
    mv_z = p_u_x * p_vv_y + p_uv_x * p_v_y - p_u_y * p_vv_x - p_uv_y * p_v_x
    ev = 2 * p_u_x * p_uv_x + 2 * p_u_y * p_uv_y + 2 * p_u_z * p_uv_z
    fv = p_u_x * p_vv_x + p_u_y * p_vv_y + p_u_z * p_vv_z + p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    gv = 2 * p_v_x * p_vv_x + 2 * p_v_y * p_vv_y + 2 * p_v_z * p_vv_z
    lv = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mv_x * p_uu_x + mv_y * p_uu_y + mv_z * p_uu_z
    kv = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mv_x * p_uv_x + mv_y * p_uv_y + mv_z * p_uv_z
    nv = m_x * p_vvv_x + m_y * p_vvv_y + m_z * p_vvv_z + mv_x * p_vv_x + mv_y * p_vv_y + mv_z * p_vv_z
    qv = e * nv + ev * n + g * lv + gv * ll - 2 * f * kv - 2 * fv * k
    wv = m_x * mv_x + m_y * mv_y + m_z * mv_z
    hv = (qv - 3 * q * wv / w2) / cube
    rough = (e * hv**2 + g * hu**2 - 2 * f * hu * hv) / area
    speed = np.sqrt(e)
    return np.stack([rough, area, mean, speed])


def fairness_gradient(planes: FloatArray) -> FloatArray:
    """Adjoints of the derivatives.

    In: p_u_x, p_u_y, p_u_z, p_v_x, p_v_y, p_v_z, p_uu_x, p_uu_y, p_uu_z, p_uv_x, p_uv_y, p_uv_z, p_vv_x, p_vv_y,
        p_vv_z, p_uuu_x, p_uuu_y, p_uuu_z, p_uuv_x, p_uuv_y, p_uuv_z, p_uvv_x, p_uvv_y, p_uvv_z, p_vvv_x, p_vvv_y,
        p_vvv_z, seed_rough, seed_area, seed_mean, seed_speed.
    Out: d_p_u_x, d_p_u_y, d_p_u_z, d_p_v_x, d_p_v_y, d_p_v_z, d_p_uu_x, d_p_uu_y, d_p_uu_z, d_p_uv_x, d_p_uv_y,
        d_p_uv_z, d_p_vv_x, d_p_vv_y, d_p_vv_z, d_p_uuu_x, d_p_uuu_y, d_p_uuu_z, d_p_uuv_x, d_p_uuv_y, d_p_uuv_z,
        d_p_uvv_x, d_p_uvv_y, d_p_uvv_z, d_p_vvv_x, d_p_vvv_y, d_p_vvv_z.

    Source: derivations/fairness.py. Operations: 877.
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
        seed_rough,
        seed_area,
        seed_mean,
        seed_speed,
    ) = planes
    m_x = p_u_y * p_v_z - p_u_z * p_v_y
    m_y = p_u_z * p_v_x - p_u_x * p_v_z
    m_z = p_u_x * p_v_y - p_u_y * p_v_x
    e = p_u_x**2 + p_u_y**2 + p_u_z**2
    f = p_u_x * p_v_x + p_u_y * p_v_y + p_u_z * p_v_z
    g = p_v_x**2 + p_v_y**2 + p_v_z**2
    w2 = m_x**2 + m_y**2 + m_z**2
    area = np.sqrt(w2)
    ll = m_x * p_uu_x + m_y * p_uu_y + m_z * p_uu_z
    k = m_x * p_uv_x + m_y * p_uv_y + m_z * p_uv_z
    n = m_x * p_vv_x + m_y * p_vv_y + m_z * p_vv_z
    q = e * n + g * ll - 2 * f * k
    cube = 2 * area * w2
    mu_x = p_u_y * p_uv_z + p_uu_y * p_v_z - p_u_z * p_uv_y - p_uu_z * p_v_y
    mu_y = p_u_z * p_uv_x + p_uu_z * p_v_x - p_u_x * p_uv_z - p_uu_x * p_v_z
    mu_z = p_u_x * p_uv_y + p_uu_x * p_v_y - p_u_y * p_uv_x - p_uu_y * p_v_x
    eu = 2 * p_u_x * p_uu_x + 2 * p_u_y * p_uu_y + 2 * p_u_z * p_uu_z
    fu = p_u_x * p_uv_x + p_u_y * p_uv_y + p_u_z * p_uv_z + p_uu_x * p_v_x + p_uu_y * p_v_y + p_uu_z * p_v_z
    gu = 2 * p_uv_x * p_v_x + 2 * p_uv_y * p_v_y + 2 * p_uv_z * p_v_z
    lu = m_x * p_uuu_x + m_y * p_uuu_y + m_z * p_uuu_z + mu_x * p_uu_x + mu_y * p_uu_y + mu_z * p_uu_z
    ku = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mu_x * p_uv_x + mu_y * p_uv_y + mu_z * p_uv_z
    nu = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mu_x * p_vv_x + mu_y * p_vv_y + mu_z * p_vv_z
    qu = e * nu + eu * n + g * lu + gu * ll - 2 * f * ku - 2 * fu * k
    wu = m_x * mu_x + m_y * mu_y + m_z * mu_z
    hu = (qu - 3 * q * wu / w2) / cube
    mv_x = p_u_y * p_vv_z + p_uv_y * p_v_z - p_u_z * p_vv_y - p_uv_z * p_v_y
    mv_y = p_u_z * p_vv_x + p_uv_z * p_v_x - p_u_x * p_vv_z - p_uv_x * p_v_z
    mv_z = p_u_x * p_vv_y + p_uv_x * p_v_y - p_u_y * p_vv_x - p_uv_y * p_v_x
    ev = 2 * p_u_x * p_uv_x + 2 * p_u_y * p_uv_y + 2 * p_u_z * p_uv_z
    fv = p_u_x * p_vv_x + p_u_y * p_vv_y + p_u_z * p_vv_z + p_uv_x * p_v_x + p_uv_y * p_v_y + p_uv_z * p_v_z
    gv = 2 * p_v_x * p_vv_x + 2 * p_v_y * p_vv_y + 2 * p_v_z * p_vv_z
    lv = m_x * p_uuv_x + m_y * p_uuv_y + m_z * p_uuv_z + mv_x * p_uu_x + mv_y * p_uu_y + mv_z * p_uu_z
    kv = m_x * p_uvv_x + m_y * p_uvv_y + m_z * p_uvv_z + mv_x * p_uv_x + mv_y * p_uv_y + mv_z * p_uv_z
    nv = m_x * p_vvv_x + m_y * p_vvv_y + m_z * p_vvv_z + mv_x * p_vv_x + mv_y * p_vv_y + mv_z * p_vv_z
    qv = e * nv + ev * n + g * lv + gv * ll - 2 * f * kv - 2 * fv * k
    wv = m_x * mv_x + m_y * mv_y + m_z * mv_z
    hv = (qv - 3 * q * wv / w2) / cube
    speed = np.sqrt(e)
    d_hv = seed_rough * (2 * e * hv - 2 * f * hu) / area
    d_wv = -3 * d_hv * q / (cube * w2)
    d_qv = d_hv / cube
    d_nv = d_qv * e
    d_kv = -2 * d_qv * f
    d_lv = d_qv * g
    d_gv = d_qv * ll
    d_fv = -2 * d_qv * k
    d_ev = d_qv * n
    d_mv_z = d_kv * p_uv_z + d_lv * p_uu_z + d_nv * p_vv_z + d_wv * m_z
    d_mv_y = d_kv * p_uv_y + d_lv * p_uu_y + d_nv * p_vv_y + d_wv * m_y
    d_mv_x = d_kv * p_uv_x + d_lv * p_uu_x + d_nv * p_vv_x + d_wv * m_x
    d_hu = seed_rough * (2 * g * hu - 2 * f * hv) / area
    d_wu = -3 * d_hu * q / (cube * w2)
    d_qu = d_hu / cube
    d_nu = d_qu * e
    d_ku = -2 * d_qu * f
    d_lu = d_qu * g
    d_gu = d_qu * ll
    d_fu = -2 * d_qu * k
    d_eu = d_qu * n
    d_mu_z = d_ku * p_uv_z + d_lu * p_uu_z + d_nu * p_vv_z + d_wu * m_z
    d_mu_y = d_ku * p_uv_y + d_lu * p_uu_y + d_nu * p_vv_y + d_wu * m_y
    d_mu_x = d_ku * p_uv_x + d_lu * p_uu_x + d_nu * p_vv_x + d_wu * m_x
    d_cube = (
        -d_hu * (qu - 3 * q * wu / w2) / cube**2 - d_hv * (qv - 3 * q * wv / w2) / cube**2 - q * seed_mean / cube**2
    )
    d_q = seed_mean / cube - 3 * d_hu * wu / (cube * w2) - 3 * d_hv * wv / (cube * w2)
    d_n = d_q * e + d_qu * eu + d_qv * ev
    d_k = -2 * d_q * f - 2 * d_qu * fu - 2 * d_qv * fv
    d_ll = d_q * g + d_qu * gu + d_qv * gv
    d_area = 2 * d_cube * w2 + seed_area - seed_rough * (e * hv**2 + g * hu**2 - 2 * f * hu * hv) / area**2
    d_w2 = (
        2 * area * d_cube
        + 3 * d_hu * q * wu / (cube * w2**2)
        + 3 * d_hv * q * wv / (cube * w2**2)
        + d_area / (2 * area)
    )
    d_g = d_q * ll + d_qu * lu + d_qv * lv + hu**2 * seed_rough / area
    d_f = -2 * d_q * k - 2 * d_qu * ku - 2 * d_qv * kv - 2 * hu * hv * seed_rough / area
    d_e = d_q * n + d_qu * nu + d_qv * nv + seed_speed / (2 * speed) + hv**2 * seed_rough / area
    d_m_z = (
        d_k * p_uv_z
        + d_ku * p_uuv_z
        + d_kv * p_uvv_z
        + d_ll * p_uu_z
        + d_lu * p_uuu_z
        + d_lv * p_uuv_z
        + d_n * p_vv_z
        + d_nu * p_uvv_z
        + d_nv * p_vvv_z
        + 2 * d_w2 * m_z
        + d_wu * mu_z
        + d_wv * mv_z
    )
    d_m_y = (
        d_k * p_uv_y
        + d_ku * p_uuv_y
        + d_kv * p_uvv_y
        + d_ll * p_uu_y
        + d_lu * p_uuu_y
        + d_lv * p_uuv_y
        + d_n * p_vv_y
        + d_nu * p_uvv_y
        + d_nv * p_vvv_y
        + 2 * d_w2 * m_y
        + d_wu * mu_y
        + d_wv * mv_y
    )
    d_m_x = (
        d_k * p_uv_x
        + d_ku * p_uuv_x
        + d_kv * p_uvv_x
        + d_ll * p_uu_x
        + d_lu * p_uuu_x
        + d_lv * p_uuv_x
        + d_n * p_vv_x
        + d_nu * p_uvv_x
        + d_nv * p_vvv_x
        + 2 * d_w2 * m_x
        + d_wu * mu_x
        + d_wv * mv_x
    )
    d_p_u_x = (
        2 * d_e * p_u_x
        + 2 * d_eu * p_uu_x
        + 2 * d_ev * p_uv_x
        + d_f * p_v_x
        + d_fu * p_uv_x
        + d_fv * p_vv_x
        + d_m_z * p_v_y
        + d_mu_z * p_uv_y
        + d_mv_z * p_vv_y
        - d_m_y * p_v_z
        - d_mu_y * p_uv_z
        - d_mv_y * p_vv_z
    )
    d_p_u_y = (
        2 * d_e * p_u_y
        + 2 * d_eu * p_uu_y
        + 2 * d_ev * p_uv_y
        + d_f * p_v_y
        + d_fu * p_uv_y
        + d_fv * p_vv_y
        + d_m_x * p_v_z
        + d_mu_x * p_uv_z
        + d_mv_x * p_vv_z
        - d_m_z * p_v_x
        - d_mu_z * p_uv_x
        - d_mv_z * p_vv_x
    )
    d_p_u_z = (
        2 * d_e * p_u_z
        + 2 * d_eu * p_uu_z
        + 2 * d_ev * p_uv_z
        + d_f * p_v_z
        + d_fu * p_uv_z
        + d_fv * p_vv_z
        + d_m_y * p_v_x
        + d_mu_y * p_uv_x
        + d_mv_y * p_vv_x
        - d_m_x * p_v_y
        - d_mu_x * p_uv_y
        - d_mv_x * p_vv_y
    )
    d_p_v_x = (
        d_f * p_u_x
        + d_fu * p_uu_x
        + d_fv * p_uv_x
        + 2 * d_g * p_v_x
        + 2 * d_gu * p_uv_x
        + 2 * d_gv * p_vv_x
        + d_m_y * p_u_z
        + d_mu_y * p_uu_z
        + d_mv_y * p_uv_z
        - d_m_z * p_u_y
        - d_mu_z * p_uu_y
        - d_mv_z * p_uv_y
    )
    d_p_v_y = (
        d_f * p_u_y
        + d_fu * p_uu_y
        + d_fv * p_uv_y
        + 2 * d_g * p_v_y
        + 2 * d_gu * p_uv_y
        + 2 * d_gv * p_vv_y
        + d_m_z * p_u_x
        + d_mu_z * p_uu_x
        + d_mv_z * p_uv_x
        - d_m_x * p_u_z
        - d_mu_x * p_uu_z
        - d_mv_x * p_uv_z
    )
    d_p_v_z = (
        d_f * p_u_z
        + d_fu * p_uu_z
        + d_fv * p_uv_z
        + 2 * d_g * p_v_z
        + 2 * d_gu * p_uv_z
        + 2 * d_gv * p_vv_z
        + d_m_x * p_u_y
        + d_mu_x * p_uu_y
        + d_mv_x * p_uv_y
        - d_m_y * p_u_x
        - d_mu_y * p_uu_x
        - d_mv_y * p_uv_x
    )
    d_p_uu_x = (
        2 * d_eu * p_u_x + d_fu * p_v_x + d_ll * m_x + d_lu * mu_x + d_lv * mv_x + d_mu_z * p_v_y - d_mu_y * p_v_z
    )
    d_p_uu_y = (
        2 * d_eu * p_u_y + d_fu * p_v_y + d_ll * m_y + d_lu * mu_y + d_lv * mv_y + d_mu_x * p_v_z - d_mu_z * p_v_x
    )
    d_p_uu_z = (
        2 * d_eu * p_u_z + d_fu * p_v_z + d_ll * m_z + d_lu * mu_z + d_lv * mv_z + d_mu_y * p_v_x - d_mu_x * p_v_y
    )
    d_p_uv_x = (
        2 * d_ev * p_u_x
        + d_fu * p_u_x
        + d_fv * p_v_x
        + 2 * d_gu * p_v_x
        + d_k * m_x
        + d_ku * mu_x
        + d_kv * mv_x
        + d_mu_y * p_u_z
        + d_mv_z * p_v_y
        - d_mu_z * p_u_y
        - d_mv_y * p_v_z
    )
    d_p_uv_y = (
        2 * d_ev * p_u_y
        + d_fu * p_u_y
        + d_fv * p_v_y
        + 2 * d_gu * p_v_y
        + d_k * m_y
        + d_ku * mu_y
        + d_kv * mv_y
        + d_mu_z * p_u_x
        + d_mv_x * p_v_z
        - d_mu_x * p_u_z
        - d_mv_z * p_v_x
    )
    d_p_uv_z = (
        2 * d_ev * p_u_z
        + d_fu * p_u_z
        + d_fv * p_v_z
        + 2 * d_gu * p_v_z
        + d_k * m_z
        + d_ku * mu_z
        + d_kv * mv_z
        + d_mu_x * p_u_y
        + d_mv_y * p_v_x
        - d_mu_y * p_u_x
        - d_mv_x * p_v_y
    )
    d_p_vv_x = d_fv * p_u_x + 2 * d_gv * p_v_x + d_mv_y * p_u_z + d_n * m_x + d_nu * mu_x + d_nv * mv_x - d_mv_z * p_u_y
    d_p_vv_y = d_fv * p_u_y + 2 * d_gv * p_v_y + d_mv_z * p_u_x + d_n * m_y + d_nu * mu_y + d_nv * mv_y - d_mv_x * p_u_z
    d_p_vv_z = d_fv * p_u_z + 2 * d_gv * p_v_z + d_mv_x * p_u_y + d_n * m_z + d_nu * mu_z + d_nv * mv_z - d_mv_y * p_u_x
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
