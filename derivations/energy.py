"""The thin-plate energy (11) of a semi-structured surface as a quadratic form.

With P(u, v) = sum_i sum_j P_ij B_j(v; V_i) N_i(u; U) the energy is the sum over all pairs

    E = sum_(i, i') sum_(j, j') K[i j, i' j'] P_ij . P_i'j',
    K[i j, i' j'] = A2 G0 + 2 A1 G1 + A0 G2,
    A_d = integral of N_i^(d) N_i'^(d) du over [u_s, u_e],      both functions over U,
    G_d = integral of B_j^(d)(v; V_i) B_j'^(d)(v; V_i') dv over [v_s, v_e], over V_i and V_i'.

Nothing else is needed: each integral is one of products of two derivatives of the *same* order, in v between two
knot vectors that may differ.

Source: equation (11) of the paper; the Gram form is derived here.
"""

from __future__ import annotations

from sympy import Expr, Function, Symbol, sympify

# P_uu, P_uv, P_vv of one coordinate of the surface.
SECOND_DERIVATIVES = (Symbol("P_uu"), Symbol("P_uv"), Symbol("P_vv"))


def thin_plate_density() -> Expr:
    """Return the integrand of (11) for one coordinate; the whole integrand is the sum over the three.

    Examples
    --------
    >>> thin_plate_density()
    P_uu**2 + 2*P_uv**2 + P_vv**2
    """
    p_uu, p_uv, p_vv = SECOND_DERIVATIVES
    return p_uu**2 + 2 * p_uv**2 + p_vv**2


def gram_block() -> Expr:
    """Return K in the one-dimensional integrals A0, A1, A2 (in u) and G0, G1, G2 (in v).

    Notes
    -----
    The symmetric bilinear form of the density is taken of two products N(u) B(v) and N'(u) B'(v); each term is a
    product of a function of u and one of v, so its double integral is A_d G_e.

    Examples
    --------
    >>> gram_block()
    A0*G2 + 2*A1*G1 + A2*G0
    """
    u, v = Symbol("u"), Symbol("v")
    one, other = (Function(f"N{k}")(u) * Function(f"B{k}")(v) for k in (1, 2))
    density = thin_plate_density()
    total = sympify(0)
    for first in SECOND_DERIVATIVES:
        for second in SECOND_DERIVATIVES:
            coefficient = density.diff(first, second) / 2
            total += coefficient * _second(one, first, u, v) * _second(other, second, u, v)
    total = total.expand()
    for d in range(3):
        for letter, name, x in (("A", "N", u), ("G", "B", v)):
            pair = [Function(f"{name}{k}")(x).diff((x, d)) if d else Function(f"{name}{k}")(x) for k in (1, 2)]
            total = total.subs(pair[0] * pair[1], Symbol(f"{letter}{d}"))
    return total


def _second(value: Expr, which: Symbol, u: Symbol, v: Symbol) -> Expr:
    """Differentiate twice by what the name of the symbol says."""
    for letter in which.name.split("_")[1]:
        value = value.diff(u if letter == "u" else v)
    return value
