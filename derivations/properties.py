"""Properties of the semi-structured surface that the paper lists without proof: proved here.

With basis functions N_i(u) over U and N_ij(v) over V_i (each curve with knots and degree of its own) the surface is
sum_ij P_ij f_ij(u, v), f_ij = N_i(u) N_ij(v). Two kinds of evidence stand side by side:

- `proofs()`: arguments for every degree and every knot vector, reduced to identities in symbols that SymPy decides;
- the functions below it, which decide a property for one degree and one (symbolic or rational) knot vector, straight
  from the Cox-de Boor definition.

A zero denominator in the recurrence multiplies a basis function without support; such a term is zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb, factorial
from typing import Any

import sympy as sp
from sympy.polys.constructor import construct_domain

from semispline.derivations.splines import X, exact_knots


@dataclass(frozen=True)
class Proof:
    """A property, the argument for it, and the identities on which the argument stands.

    Parameters
    ----------
    name, statement, argument : str
    identities : dict
        What must be zero, by name.
    """

    name: str
    statement: str
    argument: str
    identities: dict[str, sp.Expr]

    @property
    def proved(self) -> bool:
        """Tell whether every identity is exactly zero."""
        return bool(self.identities) and all(residual == 0 for residual in self.identities.values())


def proofs() -> tuple[Proof, ...]:
    """Return the general proofs.

    Examples
    --------
    >>> [proof.name for proof in proofs() if not proof.proved]
    []
    """
    return (
        _partition_of_unity(),
        _non_negative(),
        _convex_hull(),
        _affine_invariance(),
        _locality(),
        _derivative(),
        _continuity(),
        _u_derivative(),
    )


def _partition_of_unity() -> Proof:
    t_i, t_ip, x = sp.symbols("t_i t_ip x")
    n = sp.symbols("N_0:4")
    inner = sp.symbols("S_0:4")
    surface = sum(a * s for a, s in zip(n, inner, strict=True))
    return Proof(
        "partition of unity",
        "The functions N_i(u) N_ij(v) sum to one, whichever knots and degree each curve has.",
        "In the sum of all N_i,p the recurrence gives N_i,p-1 the factor `recurrence` + 1, so the sum is that of the "
        "next lower degree, down to degree 0, where one function is 1. On the surface the inner sums S_i are 1, each "
        "over its own V_i, and then the outer one is.",
        {
            "recurrence": sp.cancel((x - t_i) / (t_ip - t_i) + (t_ip - x) / (t_ip - t_i) - 1),
            "surface": sp.expand(surface.subs(dict.fromkeys(inner, sp.Integer(1))).subs(n[-1], 1 - sum(n[:-1])) - 1),
        },
    )


def _non_negative() -> Proof:
    a, b, t_i, t_ip, x = sp.symbols("a b t_i t_ip x")
    where = {t_ip: t_i + a + b, x: t_i + a}
    return Proof(
        "non-negative",
        "No function N_i(u) N_ij(v) is ever negative.",
        "Both factors of N_i,p-1 in the recurrence are a / (a + b) and b / (a + b), where a and b are the distances of "
        "x from the ends of its support, not negative there; degree 0 is 0 or 1; a product of such functions is one.",
        {
            "rising": sp.cancel(((x - t_i) / (t_ip - t_i)).subs(where) - a / (a + b)),
            "falling": sp.cancel(((t_ip - x) / (t_ip - t_i)).subs(where) - b / (a + b)),
        },
    )


def _convex_hull() -> Proof:
    parts = (_partition_of_unity(), _non_negative())
    return Proof(
        "convex hull",
        "Each point of the surface lies in the convex hull of the control points whose functions do not vanish there.",
        "The point is a mean of these control points with weights that are not negative and sum to one.",
        {f"{part.name}: {name}": residual for part in parts for name, residual in part.identities.items()},
    )


def _affine_invariance() -> Proof:
    a, b = sp.symbols("a b")
    f, c = sp.symbols("f_0:4"), sp.symbols("c_0:4")
    mapped = sum(w * (a * p + b) for w, p in zip(f, c, strict=True))
    image = a * sum(w * p for w, p in zip(f, c, strict=True)) + b
    return Proof(
        "affine invariance",
        "Mapping the control points by an affine map maps the surface by it.",
        "Coordinate by coordinate the difference is b (sum of weights - 1), zero by the partition of unity.",
        {
            "difference": sp.expand(mapped - image - b * (sum(f) - 1)),
            "with weights that sum to one": sp.expand((mapped - image).subs(f[-1], 1 - sum(f[:-1]))),
        },
    )


def _locality() -> Proof:
    # Supports of the two functions of degree p - 1 that make N_i,p: [t_i, t_(i+p)] and [t_(i+1), t_(i+1+p)].
    i, p = sp.symbols("i p", integer=True, positive=True)
    return Proof(
        "locality",
        "P_ij moves the surface over [u_i, u_(i+p+1)] x [v^i_j, v^i_(j+q_i+1)] alone, v^i the knots of curve i.",
        "N_i,0 lives on [t_i, t_(i+1)]; by the recurrence N_i,p lives where N_i,p-1 or N_i+1,p-1 does, and the first "
        "of these supports starts at t_i, the second one ends at t_(i+p+1).",
        {
            "start": sp.Min(i, i + 1) - i,
            "end": sp.expand(sp.Max(i + p, i + 1 + p) - (i + p + 1)),
        },
    )


def _derivative() -> Proof:
    return Proof(
        "derivative",
        "N_i,p' = p N_i,p-1 / (t_(i+p) - t_i) - p N_i+1,p-1 / (t_(i+p+1) - t_(i+1)).",
        "By induction on p: `step` differentiates the recurrence, puts in the claim for p - 1 and writes everything in "
        "the three functions of degree p - 2; `base` is the hat function.",
        {"base, rising": _hat_residual(0), "base, falling": _hat_residual(1), "step": derivative_step()},
    )


def _continuity() -> Proof:
    # Multiplicity r = degree: x is the knot, `near` the neighbour beyond it, all knots between are equal to x.
    x, t_i, near = sp.symbols("x t_i near")
    kept_right = ((near - x) / (near - t_i)).subs(t_i, x)
    kept_left = ((x - near) / (t_i - near)).subs(t_i, x)
    return Proof(
        "continuity",
        "At a knot of multiplicity r <= p a curve of degree p is C^(p-r). Each curve is controlled alone: across v = "
        "knot the d-th v-derivative of the surface jumps by sum_i N_i(u) J_i, J_i the jump of curve i, so the knot of "
        "one curve is felt over the support of its N_i and nowhere else.",
        "Where p = r, the recurrence at the knot keeps one function at 1 from either side, the same one, and the "
        "others at 0 (`base`), so all are continuous. For larger p the derivatives are combinations of functions of "
        "degree p - 1, C^(p-1-r) by induction. The jump of a sum is the sum of the jumps.",
        {
            "base, kept from the right": sp.cancel(kept_right - 1),
            "base, lost from the right": sp.cancel(((x - t_i) / (near - t_i)).subs(t_i, x)),
            "base, kept from the left": sp.cancel(kept_left - 1),
            "base, lost from the left": sp.cancel(((t_i - x) / (t_i - near)).subs(t_i, x)),
            "derivative step": derivative_step(),
        },
    )


def _u_derivative() -> Proof:
    p = sp.Symbol("p")
    n = sp.symbols("N_0:4")
    curves = sp.symbols("P_0:3")
    widths = sp.symbols("d_0:4", positive=True)
    # N_i' = p (N_i,p-1 / d_i - N_i+1,p-1 / d_(i+1)); the first and the last function of degree p - 1 vanish.
    derivative = sum(curves[i] * p * (n[i] / widths[i] - n[i + 1] / widths[i + 1]) for i in range(3))
    claimed = sum(p * (curves[i] - curves[i - 1]) / widths[i] * n[i] for i in range(1, 3))
    ends = p * (curves[0] / widths[0] * n[0] - curves[2] / widths[3] * n[3])
    return Proof(
        "u-derivative",
        "The u-derivative is a semi-structured surface of degree p - 1 in u with one curve less, "
        "p (P_i+1(v) - P_i(v)) / (u_(i+p+1) - u_(i+1)), each over the merged knots of two neighbours.",
        "Abel summation of the derivative formula; N_0,p-1 and N_m+1,p-1 vanish over clamped knots. A difference of "
        "splines of degrees q and q' is a spline of degree max(q, q') over their merged knots.",
        {"summation": sp.expand(derivative - claimed - ends), "derivative step": derivative_step()},
    )


def derivative_step() -> sp.Expr:
    """Return the induction step of the derivative formula as left minus right side, for symbolic degree and knots."""
    p, x = sp.symbols("p x")
    t0, t1, t2, t_pm, t_p, t_pp = sp.symbols("t_0 t_1 t_2 t_pm1 t_p t_pp1")
    a, b, c = sp.symbols("A B C")
    low = (x - t0) / (t_pm - t0) * a + (t_p - x) / (t_p - t1) * b
    high = (x - t1) / (t_p - t1) * b + (t_pp - x) / (t_pp - t2) * c
    low_slope = (p - 1) * (a / (t_pm - t0) - b / (t_p - t1))
    high_slope = (p - 1) * (b / (t_p - t1) - c / (t_pp - t2))
    left = low / (t_p - t0) + (x - t0) / (t_p - t0) * low_slope
    left += -high / (t_pp - t1) + (t_pp - x) / (t_pp - t1) * high_slope
    # Linear in the three functions: one by one they are brought to a common denominator much faster.
    residual = sp.expand(left - p * (low / (t_p - t0) - high / (t_pp - t1)))
    parts = {letter: residual.coeff(letter) for letter in (a, b, c)}
    rest = residual - sum(letter * part for letter, part in parts.items())
    return sum((letter * sp.cancel(part) for letter, part in parts.items()), sp.cancel(sp.expand(rest)))


def _hat_residual(side: int) -> sp.Expr:
    x, t0, t1, t2 = sp.symbols("x t_0 t_1 t_2")
    piece = (x - t0) / (t1 - t0) if side == 0 else (t2 - x) / (t2 - t1)
    claimed = 1 / (t1 - t0) if side == 0 else -1 / (t2 - t1)
    return sp.cancel(sp.diff(piece, x) - claimed)


# One degree, one knot vector: decided from the definition.


def basis_table(degree: int, knots: Sequence[Any]) -> dict[int, tuple[sp.Poly, ...]]:
    """Return every basis function on every non-empty span, by the Cox-de Boor recurrence alone.

    Nothing is assumed about supports: the functions that vanish on a span are computed as well.

    Parameters
    ----------
    degree : int
    knots : sequence, length n + degree + 1
        Exact, ascending; symbols are different knots.

    Returns
    -------
    dict
        Span index k (knots k and k + 1 differ) -> the n polynomials in x.

    Examples
    --------
    >>> [piece.as_expr() for piece in basis_table(1, [0, 0, 1, 2, 2])[2]]
    [0, 2 - x, x - 1]
    """
    exact = exact_knots(knots)
    domain, elements = construct_domain(list(exact), field=True)
    x = sp.Poly(X, X, domain=domain)
    zero, one = sp.Poly(0, X, domain=domain), sp.Poly(1, X, domain=domain)

    def ramp(start: Any, end: Any) -> sp.Poly:
        return (x - sp.Poly([start], X, domain=domain)).mul_ground(domain.one / (end - start))

    table = {}
    for k in range(degree, len(exact) - degree - 1):
        if elements[k] == elements[k + 1]:
            continue
        level = [one if i == k else zero for i in range(len(exact) - 1)]
        for p in range(1, degree + 1):
            above = []
            for i in range(len(level) - 1):
                piece = zero
                if not level[i].is_zero:
                    piece += ramp(elements[i], elements[i + p]) * level[i]
                if not level[i + 1].is_zero:
                    piece += ramp(elements[i + p + 1], elements[i + 1]) * level[i + 1]
                above.append(piece)
            level = above
        table[k] = tuple(level)
    return table


def partition_residuals(degree: int, knots: Sequence[Any]) -> list[sp.Poly]:
    """Return, for each span, the sum of all basis functions less one: zero.

    Examples
    --------
    >>> [residual.is_zero for residual in partition_residuals(2, [0, 0, 0, "h", 1, 1, 1])]
    [True, True]
    """
    return [sum(pieces[1:], pieces[0]) - 1 for pieces in basis_table(degree, knots).values()]


def least_bernstein_coefficient(degree: int, knots: Sequence[Any]) -> sp.Rational:
    """Return the least Bernstein coefficient of any basis function on any span, for rational knots.

    Where it is not negative, no basis function is.

    Examples
    --------
    >>> least_bernstein_coefficient(3, [0, 0, 0, 0, 1, 1, 1, 1])
    0
    """
    exact = exact_knots(knots)
    return min(
        coefficient
        for k, pieces in basis_table(degree, knots).items()
        for piece in pieces
        for coefficient in _bernstein_coefficients(piece, exact[k], exact[k + 1], degree)
    )


def supports(degree: int, knots: Sequence[Any]) -> list[tuple[int, ...]]:
    """Return, for each basis function, the non-empty spans on which it is not identically zero.

    Examples
    --------
    >>> supports(1, [0, 0, 1, 2, 2])
    [(1,), (1, 2), (2,)]
    """
    table = basis_table(degree, knots)
    count = len(knots) - degree - 1
    return [tuple(k for k, pieces in table.items() if not pieces[i].is_zero) for i in range(count)]


def contact_orders(degree: int, knots: Sequence[Any], knot: Any) -> list[int | None]:
    """Return the order of contact of each basis function across an inner knot.

    Returns
    -------
    list
        For function i the largest d such that it is C^d there, -1 for a jump, None where it is one polynomial across.

    Raises
    ------
    ValueError
        The knot is not an inner one.

    Examples
    --------
    >>> contact_orders(2, [0, 0, 0, "h", 1, 1, 1], "h")
    [1, 1, 1, 1]
    """
    exact, (at,) = exact_knots(knots), exact_knots([knot])
    table = basis_table(degree, knots)
    right = next((k for k in table if exact[k] == at), None)
    left = next((k for k in table if exact[k + 1] == at), None)
    if left is None or right is None:
        raise ValueError(f"knot: found {at}, expected an inner knot of {exact}")
    return [_contact(after - before, at) for before, after in zip(table[left], table[right], strict=True)]


def _contact(difference: sp.Poly, at: sp.Expr) -> int | None:
    """Return one less than the order of the zero of a difference of pieces at a knot."""
    if difference.is_zero:
        return None
    order = -1
    while sp.cancel(difference.eval(at)) == 0:
        difference = difference.diff()
        order += 1
    return order


def _bernstein_coefficients(piece: sp.Poly, start: sp.Expr, end: sp.Expr, degree: int) -> list[sp.Expr]:
    """Return Bernstein coefficients over [start, end], from the derivatives at the start."""
    scaled, current = [], piece
    for r in range(degree + 1):
        scaled.append(current.eval(start) * (end - start) ** r / factorial(r))
        current = current.diff()
    return [sum(sp.Rational(comb(s, r), comb(degree, r)) * scaled[r] for r in range(s + 1)) for s in range(degree + 1)]
