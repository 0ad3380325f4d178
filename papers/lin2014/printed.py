"""The only place where a formula of the paper can run: what is printed, letter by letter, as SymPy relations.

Nothing here is trusted. Control points are scalar symbols, since every relation holds coordinate by coordinate.
Letters are the paper's: k, k_r, k_s are orders; u_i the inner knots of U, 1 <= i <= m - k + 1.
"""

from __future__ import annotations

from typing import Any

from sympy import Eq, Function, Ge, IndexedBase, Integral, Le, Rational, Sum, Symbol, binomial, symbols

from semispline.papers.ledger import Formula

# The order in all of its own examples.
CUBIC = 4
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

# The same with squared denominators, in case the scan lost the squares.
COND_3_1_SQUARES = Formula(
    Eq(
        P_2,
        alpha**4 * u_1**2 * (k_r - 1) * (k_r - 2) / ((w_kr - w_s) ** 2 * (k - 1) * (k - 2)) * (R_0 - 2 * R_1 + R_2)
        + 2 * P_1
        - P_0,
    ),
    COND_3_1.variables,
    COND_3_1.assumptions,
    _START_CHAINS,
)
# The same with any powers: g is whatever they make of u_1, w_{k_r} - w_s and the orders.
powers = Symbol("g", positive=True)
COND_3_1_ANY_POWERS = Formula(
    Eq(P_2, alpha**4 * powers * (R_0 - 2 * R_1 + R_2) + 2 * P_1 - P_0),
    (P_0, P_1, P_2, R_0, R_1, R_2, alpha, powers),
    (),
    (),
)
COND_3_2_SQUARES = Formula(
    Eq(
        P_m2,
        beta**4
        * ((1 - u_m3) ** 2 * (k_s - 1) * (k_s - 2))
        / ((t_ks - t_s) ** 2 * (k - 1) * (k - 2))
        * (S_0 - 2 * S_1 + S_2)
        + 2 * P_m1
        - P_m,
    ),
    COND_3_2.variables,
    COND_3_2.assumptions,
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
APP_D2_P_SQUARES = Formula(
    Eq(P_uu, (k - 1) * (k - 2) / u_1**2 * (P_2 - 2 * P_1 + P_0)),
    APP_D2_P.variables,
    APP_D2_P.assumptions,
    _START_CHAINS,
)
APP_D2_R_SQUARES = Formula(
    Eq(R_ww, (k_r - 1) * (k_r - 2) / (w_kr - w_s) ** 2 * (R_2 - 2 * R_1 + R_0)),
    APP_D2_R.variables,
    APP_D2_R.assumptions,
    _START_CHAINS,
)

# Sections 2 to 4. B with three arguments is a Bernstein polynomial B_i^n(x), with four B_{i,k}(x; knots). S, S_1, S_2,
# C, R and T stand for the value of a surface or curve, which the check computes in another way.
m, n, ell = (Symbol(name, integer=True, positive=True) for name in "mnl")
m_r, n_r, m_s, n_s, n_i = (Symbol(name, integer=True, positive=True) for name in ("m_r", "n_r", "m_s", "n_s", "n_i"))
i, j, s, j_1, j_2, j_3 = (Symbol(name, integer=True, nonnegative=True) for name in ("i", "j", "s", "j_1", "j_2", "j_3"))
u, v, w, t = symbols("u v w t", real=True)
U, W, T, V_r, V_s = symbols("U W T V^r V^s")
P, R, S, v_c, x = (IndexedBase(name) for name in ("P", "R", "S", "v", "x"))
B, V, N, C, Q, Y, F = (Function(name) for name in ("B", "V", "n", "C", "Q", "Y", "F"))
last = Symbol("L", integer=True, positive=True)
first = Symbol("F_0", integer=True, nonnegative=True)


def _sum(term: Any, *limits: Any) -> Any:
    """Return nested sums, the first limit innermost."""
    for limit in limits:
        term = Sum(term, limit)
    return term


_CURVE = _sum(P[i, j] * B(j, ell, v, V(i)), (j, 0, N(i)))
EQ_1 = Formula(Eq(Y(u, v), _sum(_CURVE * B(i, k, u, U), (i, 0, m))), (P.label, U, u, v, k, ell, m))
EQ_2 = Formula(Eq(C(i, v), _CURVE), (P.label, i, v, ell))
EQ_3 = Formula(Eq(Y(u, v), _sum(C(i, v) * B(i, k, u, U), (i, 0, m))), (U, u, v, k, m))
# {B_{i,l}(v; V_i), j = 0, .., n_i} as the basis of curve i.
BASIS_OF_CURVE = Formula(Eq(C(i, v), _sum(P[i, j] * B(i, ell, v, V(i)), (j, 0, N(i)))), (P.label, i, v, ell))
# The last index of U and of V_i.
U_LAST = Formula(Eq(last, m + k), (last, m, k), (m >= k - 1,))
V_LAST = Formula(Eq(last, n_i + ell), (last, n_i, ell), (n_i >= ell - 1,))

EQ_4 = Formula(Eq(Y(u, v), _sum(P[i, j] * B(i, m, u) * B(j, n, v), (j, 0, n), (i, 0, m))), (P.label, u, v, m, n))
EQ_5 = Formula(Eq(C(t), _sum(v_c[i] * B(i, k, t), (i, 0, k))), (v_c.label, t, k))
EQ_5_ABSCISSA = Formula(
    Eq(t, _sum(i / k * B(i, k, t), (i, 0, k))),
    (t, k),
    equivalent={"Eq(t, Sum(i*B(i, k, t)/k, (i, 1, k)))": "the term of i = 0 is zero"},
)
EQ_6_BOTTOM = Formula(Eq(Y(u, v), _sum(Q(0, s, u) * B(s, n, v), (s, 0, n))), (u, v, n))
EQ_6_TOP = Formula(Eq(Y(u, v), _sum(Q(s, n - s, u) * B(s, n, v), (s, 0, n))), (u, v, n))


def _row_of_division(depth: int) -> Formula:
    """Return the formula below (6) for Q_j^s, s = `depth`; F(i, j, j_1, .., j_s) is the blossom at v_{j_1}, ..."""
    indices = (j_1, j_2, j_3)[:depth]
    at = i + sum(indices)
    weight = binomial(m, i) / binomial(m + depth * k, at)
    for r in indices:
        weight *= binomial(k, r)
    term = weight * F(i, j, *indices) * B(at, m + depth * k, u)
    return Formula(Eq(Q(j, depth, u), _sum(term, *((r, 0, k) for r in indices), (i, 0, m))), (j, u, m, k))


Q_ROWS = tuple(_row_of_division(depth) for depth in (1, 2, 3))
BLOSSOM_1 = Formula(Eq(F(1, i, j), (1 - v_c[j_1]) * P[i, j] + v_c[j_1] * P[i, j + 1]), (v_c.label, P.label, i, j, j_1))
BLOSSOM_2 = Formula(
    Eq(F(s, i, j), (1 - x[s]) * F(s - 1, i, j) + x[s] * F(s - 1, i, j + 1)), (x.label, i, j, s), (s >= 2,)
)
Q_RANGE = Formula(Ge(s, 1), (s,))  # and s <= n
COUNT_BOTTOM = Formula(Eq(F(0, s), m + s * k + 1), (s, m, k))
COUNT_TOP = Formula(Eq(F(s, n - s), m + (n - s) * k + 1), (s, m, n, k))
COUNT_TOP_LAST = Formula(Eq(F(0, n), m + 1), (m, n))

EQ_7 = Formula(
    Eq(Y(w, v), _sum(R[i, j] * B(j, ell, v, V_r) * B(i, k_r, w, W), (j, 0, n_r), (i, 0, m_r))),
    (R.label, w, v, V_r, W, ell, k_r, m_r, n_r),
)
EQ_8 = (
    Formula(Eq(last, m_r + k_r), (last, m_r, k_r), (m_r >= k_r - 1,)),
    Formula(Eq(last, n_r + ell), (last, n_r, ell), (n_r >= ell - 1,)),
)
EQ_9 = Formula(
    Eq(Y(t, v), _sum(S[i, j] * B(j, ell, v, V_s) * B(i, k_s, t, T), (j, 0, n_s), (i, 0, m_s))),
    (S.label, t, v, V_s, T, ell, k_s, m_s, n_s),
)
EQ_10 = (
    Formula(Eq(last, m_s + k_s), (last, m_s, k_s), (m_s >= k_s - 1,)),
    Formula(Eq(last, n_s + ell), (last, n_s, ell), (n_s >= ell - 1,)),
)
# Bezier end conditions: where the first run of equal knots ends and where the last one starts, for W, V^r, T, V^s.
RUN_ENDS = tuple(Formula(Eq(last, order - 1), (last, order)) for order in (k_r, ell, k_s, ell))
RUN_STARTS = tuple(Formula(Eq(first, count + 1), (first, count)) for count in (m_r, n_r, m_s, n_s))
INNER_FIRST = Formula(Eq(first, ell), (first, ell))
INNER_LAST = Formula(Eq(last, n_r), (last, n_r))
EQ_13 = Formula(EQ_1.relation, EQ_1.variables)
# U of (13): k zeros, m - k + 1 inner knots, k ones.
U_LENGTH = Formula(Eq(last + 1, k + (m - k + 1) + k), (last, m, k), (m >= k + 1,))
M_BOUND = Formula(Ge(m, k + 1), (m, k))
UNIFORM_KNOT = Formula(Eq(Y(i), i / (m - k + 2)), (i, m, k), (m >= k + 1,))
AVERAGED_KNOT = Formula(Eq(Y(i), (x[2 * i - 1] + x[2 * i]) / 2), (x.label, i))

P_uv, P_vv, energy_density = symbols("P_uv P_vv e", real=True)
EQ_11 = Formula(Eq(energy_density, P_uu**2 + 2 * P_uv**2 + P_vv**2), (energy_density, P_uu, P_uv, P_vv))

# (14): an entry of A or B couples two control points, (i, j) and a second one, marked by a prime. As printed a, b, c
# are integrals of one product of basis functions each (A_IJ and so on), A and B sums of products of such integrals.
K, a_1, a_2, b_1, b_2, c_1, c_2 = symbols("K a_{ij} a_{ij}' b_{ij} b_{ij}' c_{ij} c_{ij}'", real=True)
EQ_14 = Formula(Eq(K, a_1 * a_2 + 2 * c_1 * c_2 + c_1 * b_2), (K, a_1, a_2, c_1, c_2, b_2))
# The same with the third term C_vv^T C_vv, if C_uv^T there is a misprint.
EQ_14_THIRD_TERM = Formula(Eq(K, a_1 * a_2 + 2 * c_1 * c_2 + b_1 * b_2), (K, a_1, a_2, c_1, c_2, b_1, b_2))
# The printed sum if products are integrated last: A_d, G_d integrals of products of d-th derivatives in u and v, A_{de}
# and G_{de} of a d-th and an e-th one.
A_0, A_1, A_2, A_10, G_0, G_1, G_2, G_12 = symbols("A_0 A_1 A_2 A_{10} G_0 G_1 G_2 G_{12}", real=True)
EQ_14_PRODUCTS = Formula(Eq(K, A_2 * G_0 + 2 * A_1 * G_1 + A_10 * G_12), (K, A_1, A_2, A_10, G_0, G_1, G_12))
_U_RANGE, _V_RANGE = (u, *symbols("u_s u_e", real=True)), (v, *symbols("v_s v_e", real=True))
A_IJ, B_IJ, C_IJ = (
    Formula(
        Eq(symbol, Integral(B(i, k, u, U, du) * B(j, ell, v, V(i), dv), _U_RANGE, _V_RANGE)),
        (symbol, U, i, j, k, ell, *_U_RANGE[1:], *_V_RANGE[1:]),
    )
    for symbol, du, dv in ((a_1, 2, 0), (b_1, 0, 2), (c_1, 1, 1))
)
# Last entries of rows 3 and m-3 in the list C_vv: b_{3,n_2} and b_{m-3,n_{m-2}}.
CVV_LAST = (Formula(Eq(last, N(2)), (last,)), Formula(Eq(last, N(m - 2)), (last, m)))
# Degree of the objective after substitution of the conditions.
degree = Symbol("d", integer=True, positive=True)
DEGREE_C, DEGREE_G1, DEGREE_G2 = (Formula(Eq(degree, value), (degree,)) for value in (2, 4, 8))

# Strain energy "over the parameter space": its integrand over du dv, from the principal curvatures.
kappa_1, kappa_2, strain, area = symbols("kappa_1 kappa_2 e_s J", real=True)
STRAIN = Formula(Eq(strain, kappa_1**2 + kappa_2**2), (strain, kappa_1, kappa_2))

# Numbers that the paper prints, as decimals and fractions.
_HALF, _THIRD = Rational(1, 2), Rational(1, 3)


def _clamped_cubic(*inner: Any) -> tuple[Any, ...]:
    return (0, 0, 0, 0, *inner, 1, 1, 1, 1)


KNOTS = {
    "fig-5.first": _clamped_cubic(_HALF),
    "fig-5.second": _clamped_cubic(_THIRD, 2 * _THIRD),
    "fig-6.planar": _clamped_cubic(*map(Rational, ("0.15", "0.28", "0.48", "0.55", "0.70", "0.86"))),
    "fig-6.curved": _clamped_cubic(*map(Rational, ("0.22", "0.39", "0.61", "0.76"))),
    "fig-8.larger": _clamped_cubic(Rational("0.3"), Rational("0.7")),
    "fig-8.smaller": _clamped_cubic(Rational("0.5")),
    "fig-10.first": (
        *(0, 0, 0),
        *map(Rational, ("0.142857", "0.285714", "0.428571", "0.571429", "0.714286", "0.857143")),
        *(1, 1, 1, 1),
    ),
    "fig-10.second": _clamped_cubic(*map(Rational, ("0.2", "0.4", "0.6", "0.8"))),
}
# Table 1: sizes of the control nets of both base surfaces.
SIZES = {
    "fig-5": ((6, 5), (6, 6)),
    "fig-6": ((5, 10), (5, 8)),
    "fig-8": ((6, 6), (6, 5)),
    "fig-9": ((6, 6), (6, 5)),
    "fig-10": ((10, 10), (8, 8)),
    "fig-11": ((4, 10), (5, 64)),
}
FIGURE_1_COUNTS = (5, 5, 5, 7, 6, 6, 6)

# Claims of sections 1 and 3 on degrees and energies: E_6 and E_7 are least energies with 6 and 7 rows.
QUINTIC = Formula(Ge(degree, 5), (degree,))
energy_6, energy_7 = symbols("E_6 E_7", nonnegative=True)
FEWER_IS_BETTER = Formula(Le(energy_6, energy_7), (energy_6, energy_7))
