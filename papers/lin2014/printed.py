"""The only place where a formula of the paper can run: what is printed, letter by letter, as SymPy relations.

Nothing here is trusted. Control points are scalar symbols, since every relation holds coordinate by coordinate.
Letters are the paper's: k, k_r, k_s are orders; u_i the inner knots of U, 1 <= i <= m - k + 1.
"""

from __future__ import annotations

from sympy import Eq, Symbol, symbols

from papers.ledger import Formula

k = Symbol("k", integer=True, positive=True)
k_r = Symbol("k_r", integer=True, positive=True)
k_s = Symbol("k_s", integer=True, positive=True)
alpha, beta = symbols("alpha beta", real=True)
u_1, u_2 = symbols("u_1 u_2", positive=True)
u_m3 = Symbol("u_{m-3}", positive=True)
w_kr, w_s = symbols("w_{k_r} w_s", real=True)
t_ks, t_s = symbols("t_{k_s} t_s", real=True)

P_0, P_1, P_2 = (Symbol(f"P_{{{i}j}}", real=True) for i in range(3))
P_m, P_m1, P_m2 = (Symbol(f"P_{{{i},j}}", real=True) for i in ("m", "m-1", "m-2"))
R_0, R_1, R_2 = (Symbol(f"R_{{{i}j}}", real=True) for i in range(3))
S_0, S_1, S_2 = (Symbol(f"S_{{{i}j}}", real=True) for i in range(3))

# Derivatives along the contact curve.
P_u, P_uu, R_w, R_ww, R_v, R_wv, R_vv = symbols("P_u P_uu R_w R_ww R_v R_wv R_vv", real=True)
p_1, q_1, p_2, q_2 = symbols("p_1 q_1 p_2 q_2", real=True)

_START_CHAINS = ((P_0, P_1, P_2), (R_0, R_1, R_2), (u_1, u_2))
_END_CHAINS = ((P_m, P_m1, P_m2), (S_0, S_1, S_2))
_START_KNOTS = (u_1 > 0, u_1 < 1, w_kr > w_s, k >= 2, k_r >= 2)
_END_KNOTS = (u_m3 > 0, u_m3 < 1, t_ks > t_s, k >= 2, k_s >= 2)

COND_1_1 = Formula(Eq(P_0, R_0, evaluate=False), (P_0, R_0), neighbours=_START_CHAINS)
COND_1_2 = Formula(Eq(P_m, S_0, evaluate=False), (P_m, S_0), neighbours=_END_CHAINS)

COND_2_1 = Formula(
    Eq(P_1, alpha**2 * u_1 * (k_r - 1) / ((w_kr - w_s) * (k - 1)) * (R_0 - R_1) + P_0),
    (P_0, P_1, R_0, R_1, alpha, u_1, w_kr, w_s, k, k_r),
    _START_KNOTS,
    _START_CHAINS,
)
COND_2_2 = Formula(
    Eq(P_m1, beta**2 * (1 - u_m3) * (k_s - 1) / ((t_ks - t_s) * (k - 1)) * (S_0 - S_1) + P_m),
    (P_m, P_m1, S_0, S_1, beta, u_m3, t_ks, t_s, k, k_s),
    _END_KNOTS,
    _END_CHAINS,
)
COND_3_1 = Formula(
    Eq(
        P_2,
        alpha**4 * u_1 * (k_r - 1) * (k_r - 2) / ((w_kr - w_s) * (k - 1) * (k - 2)) * (R_0 - 2 * R_1 + R_2)
        + 2 * P_1
        - P_0,
    ),
    (P_0, P_1, P_2, R_0, R_1, R_2, alpha, u_1, w_kr, w_s, k, k_r),
    (*_START_KNOTS, k >= 3),
    _START_CHAINS,
)
COND_3_2 = Formula(
    Eq(
        P_m2,
        beta**4 * (1 - u_m3) * (k_s - 1) * (k_s - 2) / ((t_ks - t_s) * (k - 1) * (k - 2)) * (S_0 - 2 * S_1 + S_2)
        + 2 * P_m1
        - P_m,
    ),
    (P_m, P_m1, P_m2, S_0, S_1, S_2, beta, u_m3, t_ks, t_s, k, k_s),
    (*_END_KNOTS, k >= 3),
    _END_CHAINS,
)

# The functions of v in (15) and (16) may be mistaken for each other, and so may the derivatives of R.
_CONTACT_CHAINS = ((p_1, p_2), (q_1, q_2), (p_1, q_1), (p_2, q_2), (R_w, R_v), (R_ww, R_wv, R_vv))

EQ_15 = Formula(Eq(P_u, p_1 * R_w + q_1 * R_v), (P_u, p_1, q_1, R_w, R_v), neighbours=_CONTACT_CHAINS)
EQ_16 = Formula(
    Eq(P_uu, p_2 * R_w + q_2 * R_v + p_1**2 * R_ww + 2 * p_1 * q_1 * R_wv + q_1**2 * R_vv),
    (P_uu, p_1, q_1, p_2, q_2, R_w, R_v, R_ww, R_wv, R_vv),
    neighbours=_CONTACT_CHAINS,
)
EQ_17 = Formula(Eq(P_u, alpha**2 * R_w), (P_u, R_w, alpha), neighbours=_CONTACT_CHAINS)
EQ_18 = Formula(Eq(P_uu, alpha**4 * R_ww), (P_uu, R_ww, alpha), neighbours=_CONTACT_CHAINS)

# The end derivatives of the appendix, for the coefficients of B_{j,l}(v; V^r).
APP_D1_P = Formula(Eq(P_u, (k - 1) / u_1 * (P_1 - P_0)), (P_u, P_0, P_1, u_1, k), (u_1 > 0, k >= 2), _START_CHAINS)
APP_D1_R = Formula(
    Eq(R_w, (k_r - 1) / (w_kr - w_s) * (R_1 - R_0)),
    (R_w, R_0, R_1, w_kr, w_s, k_r),
    (w_kr > w_s, k_r >= 2),
    _START_CHAINS,
)
APP_D2_P = Formula(
    Eq(P_uu, (k - 1) * (k - 2) / u_1 * (P_2 - 2 * P_1 + P_0)),
    (P_uu, P_0, P_1, P_2, u_1, k),
    (u_1 > 0, k >= 2),
    _START_CHAINS,
)
APP_D2_R = Formula(
    Eq(R_ww, (k_r - 1) * (k_r - 2) / (w_kr - w_s) * (R_2 - 2 * R_1 + R_0)),
    (R_ww, R_0, R_1, R_2, w_kr, w_s, k_r),
    (w_kr > w_s, k_r >= 2),
    _START_CHAINS,
)
