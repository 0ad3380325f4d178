"""Strips that meet at a joint of a chain: what makes them one surface, order by order in u.

Each face R(w, v) of a chain, in homogeneous coordinates where it is rational, is left through

    X(u, v) = lambda(u, v) R(w(u, v), v + q(u, v)),      w = q = 0 at u = 0,

with lambda, w and q free: l_k, p_k and q_k are their derivatives by u at u = 0, functions of v. Contact with R is exact
whatever they are (`strip_residuals`). A blend reads nothing of X but J_j = d^j X / du^j at u = 0; it is C1 across the
joint if these and d J_j / dv agree for j = 0..n. Order by order the unknowns l_j, p_j and q_j, and their derivatives
along v, enter linearly, with the columns R, l0 R_w and l0 R_v.

Letters: of the face before the joint L, P, Q; of the one behind it l, p, q; `_v` is a derivative along v. The side edge
that leaves the contact at the joint is a w-line of both faces. Behind the joint R has the values

    R_before(w) = mu(w) R(phi(w))                        on the side edge, and, where the faces are smooth across it,
    R_v = s(w) R_before_v + r(w) R_before_w + c(w) R_before      (once w and mu are brought to agree).

Everything holds for symbolic jets, so for every degree and every knot vector, rational or not.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

from sympy import Expr, Matrix, Symbol, expand, factorial, sympify

from semispline.derivations.contact import base_derivative, contact_conditions
from semispline.derivations.homogeneous import jet, leibniz, reciprocal_jet

# A direction out of the tangent plane.
NORMAL = Symbol("N")


def strip_derivatives(order: int) -> tuple[Expr, ...]:
    """Return J_0..J_n, with J_j = d^j X / du^j at u = 0.

    Examples
    --------
    >>> strip_derivatives(1)
    (R*l0, R*l1 + R_v*l0*q1 + R_w*l0*p1)
    """
    return tuple(expand(x) for x in leibniz(jet("l", order)) * Matrix(contact_conditions(order)))


def slope(letter: str, k: int) -> Symbol:
    """Return the symbol of the derivative of l_k, p_k or q_k along v.

    Examples
    --------
    >>> slope("q", 2)
    q2_v
    """
    return Symbol(f"{letter}{k}_v")


def strip_slopes(order: int) -> tuple[Expr, ...]:
    """Return dJ_0/dv..dJ_n/dv, by the chain rule: all of R, l_k, p_k and q_k depend on v.

    Examples
    --------
    >>> strip_slopes(1)[0]
    R*l0_v + R_v*l0
    """
    places = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    names = [(letter, k) for letter in "lpq" for k in range(int(letter != "l"), order + 1)]
    found = []
    for value in strip_derivatives(order):
        total = sum((value.diff(base_derivative(i, j)) * base_derivative(i, j + 1) for i, j in places), sympify(0))
        total += sum((value.diff(Symbol(f"{x}{k}")) * slope(x, k) for x, k in names), sympify(0))
        found.append(expand(total))
    return tuple(found)


def strip_residuals(order: int) -> tuple[Expr, ...]:
    """Return what must vanish for X / W to have the contact conditions of R, whatever lambda, w and q are.

    The strip is that of (omega R, omega), omega the weight; `homogeneous.contact_residuals` is the case q = 0.

    Examples
    --------
    >>> strip_residuals(2)
    (0, 0, 0)
    """

    def omega(i: int, j: int) -> Symbol:
        return Symbol("omega" + "_" * bool(i + j) + "w" * i + "v" * j)

    places = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    weight = {base_derivative(i, j): omega(i, j) for i, j in places}
    point = {}
    for a, b in places:
        lower = [(i, j) for i in range(a + 1) for j in range(b + 1)]
        terms = (comb(a, i) * comb(b, j) * omega(i, j) * base_derivative(a - i, b - j) for i, j in lower)
        point[base_derivative(a, b)] = sum(terms, sympify(0))
    strip = strip_derivatives(order)
    weights = [value.xreplace(weight) for value in strip]
    product = leibniz(weights) * Matrix(contact_conditions(order))
    return tuple(expand(x.xreplace(point) - y) for x, y in zip(strip, product, strict=True))


def joint_columns(order: int) -> tuple[dict[str, Expr], ...]:
    """Return for each j what l_j, p_j and q_j are multiplied by in J_j; l_j_v, p_j_v, q_j_v are so in dJ_j/dv.

    Examples
    --------
    >>> joint_columns(1)[1]
    {'l': R, 'p': R_w*l0, 'q': R_v*l0}
    """
    strip = strip_derivatives(order)
    return tuple({x: strip[j].diff(Symbol(f"{x}{j}")) for x in "lpq" if j or x == "l"} for j in range(order + 1))


def along_the_curve(letter: str, order: int, by: str = "p") -> tuple[Expr, ...]:
    """Return derivatives by u of a function of w at w(u), from its own: `letter`0.. and `by`1, `by`2, ..

    Examples
    --------
    >>> along_the_curve("s", 2)
    (s0, p1*s1, p1**2*s2 + p2*s1)
    """
    at: dict[Symbol, Expr] = {base_derivative(k, 0): Symbol(f"{letter}{k}") for k in range(order + 1)}
    at |= {Symbol(f"q{k}"): sympify(0) for k in range(1, order + 1)}
    at |= {Symbol(f"p{k}"): Symbol(f"{by}{k}") for k in range(1, order + 1)}
    return tuple(condition.xreplace(at) for condition in contact_conditions(order))


def _along_side_edge(order: int, lam: str = "l", w: str = "p") -> list[Expr]:
    """Return J_0..J_n for a strip that follows the side edge, q = 0, with other names for l and p."""
    at: dict[Symbol, Expr] = {Symbol(f"q{k}"): sympify(0) for k in range(1, order + 1)}
    for old, new in (("l", lam), ("p", w)):
        at |= {Symbol(f"{old}{k}"): Symbol(f"{new}{k}") for k in range(order + 1)}
    return [value.xreplace(at) for value in strip_derivatives(order)]


def value_jumps(order: int) -> tuple[Expr, ...]:
    """Return [J_0]..[J_n] where both faces leave the contact along one curve, before minus behind.

    In derivatives of R behind the joint; those before it are by w of mu(w) R(phi(w)), with phi_0 = 0.

    Examples
    --------
    >>> value_jumps(1)[0]
    L0*R*mu0 - R*l0
    """
    before = {base_derivative(k, 0): value for k, value in enumerate(_along_side_edge(order, "mu", "phi"))}
    jumps = zip(_along_side_edge(order, "L", "P"), _along_side_edge(order), strict=True)
    return tuple(expand(x.xreplace(before) - y) for x, y in jumps)


def joint_values(order: int) -> dict[Symbol, Expr]:
    """Return l_j and p_j by which the values agree: lambda = Lambda mu(W), w = phi(W).

    Examples
    --------
    >>> joint_values(1)
    {l0: L0*mu0, l1: L0*P1*mu1 + L1*mu0, p1: P1*phi1}
    """
    factors = leibniz(jet("L", order)) * Matrix(along_the_curve("mu", order, "P"))
    found = {Symbol(f"l{k}"): expand(value) for k, value in enumerate(factors)}
    phi = along_the_curve("phi", order, "P")
    return found | {Symbol(f"p{k}"): expand(phi[k]) for k in range(1, order + 1)}


def slope_jumps(order: int, *, creased: bool = False) -> tuple[Expr, ...]:
    """Return [dJ_0/dv]..[dJ_n/dv] where values agree and the faces are smooth across the side edge.

    Before minus behind, times the length of the span behind the joint, that before it being 1: the contact has one
    speed where the one behind is s0. In derivatives of R before the joint. r0 = 0: the contact goes on.

    Parameters
    ----------
    order : int
    creased : bool
        Add e(w) N to R_v behind the joint, a part that lies in no tangent plane.

    Examples
    --------
    >>> slope_jumps(1)[0]
    L0_v*R*s0 - R*c0*l0 - R*l0_v
    """
    behind = {}
    for k in range(order + 1):
        total = sympify(0)
        for i in range(k + 1):
            smooth = Symbol(f"s{i}") * base_derivative(k - i, 1) + Symbol(f"c{i}") * base_derivative(k - i, 0)
            total += comb(k, i) * (smooth + (Symbol(f"r{i}") * base_derivative(k - i + 1, 0) if i else 0))
        behind[base_derivative(k, 1)] = total + (Symbol(f"e{k}") * NORMAL if creased else 0)
    values = {Symbol(f"q{k}"): sympify(0) for k in range(1, order + 1)}
    upper = {slope(x, k): slope(x.upper(), k) for x in "lpq" for k in range(order + 1)}
    slopes = [value.xreplace(values) for value in strip_slopes(order)]
    return tuple(expand(Symbol("s0") * x.xreplace(upper) - x.xreplace(behind)) for x in slopes)


def joint_slopes(order: int) -> dict[Symbol, Expr]:
    """Return l_j_v, p_j_v and q_j_v by which all slopes agree, in closed form.

    1 + q_v = s0 (1 + Q_v) / s(w),  w_v = s0 W_v - (1 + q_v) r(w),  lambda_v = s0 Lambda_v - lambda (1 + q_v) c(w).

    Examples
    --------
    >>> joint_slopes(2)[slope("q", 1)]
    Q1_v - p1*s1/s0
    """
    s, r, c = (Matrix(along_the_curve(letter, order)) for letter in "src")
    r = r.xreplace({Symbol("r0"): sympify(0)})
    before = {x: [slope(x, k) if k or x == "L" else sympify(0) for k in range(order + 1)] for x in "LPQ"}
    speed = Symbol("s0") * leibniz(reciprocal_jet(list(s))) * Matrix([1, *before["Q"][1:]])
    w = Symbol("s0") * Matrix(before["P"]) - leibniz(list(speed)) * r
    lam = Symbol("s0") * Matrix(before["L"]) - leibniz(jet("l", order)) * leibniz(list(speed)) * c
    found: dict[Symbol, Expr] = {}
    for k in range(order + 1):
        if k:
            found[slope("q", k)] = expand(speed[k])
            found[slope("p", k)] = expand(w[k])
        found[slope("l", k)] = expand(lam[k])
    return found


def solved_in_turn(
    jumps: Sequence[Expr], unknowns: Sequence[dict[Symbol, Symbol]]
) -> tuple[dict[Symbol, Expr], list[Expr]]:
    """Solve jump by jump for what is new in each, and return what is left of them.

    Parameters
    ----------
    jumps : sequence of Expr
        Linear in derivatives of R; jump j is linear in the unknowns of order j.
    unknowns : sequence of dict
        Of each order: from a derivative of R to the unknown that its coefficient is solved for, in turn.

    Returns
    -------
    solved : dict
    left : list of Expr
    """
    known: dict[Symbol, Expr] = {}
    left = []
    for value, wanted in zip(jumps, unknowns, strict=True):
        rest = expand(value.xreplace(known))
        for vector, unknown in wanted.items():
            coefficient = rest.coeff(vector)
            factor = coefficient.coeff(unknown)
            known[unknown] = expand(-(coefficient - factor * unknown) / factor)
            rest = expand(rest.xreplace({unknown: known[unknown]}))
        left.append(rest)
    return known, left


def value_unknowns(order: int) -> list[dict[Symbol, Symbol]]:
    """Return what each order of `value_jumps` is solved for."""
    point, across = base_derivative(0, 0), base_derivative(1, 0)
    return [({across: Symbol(f"p{k}")} if k else {}) | {point: Symbol(f"l{k}")} for k in range(order + 1)]


def slope_unknowns(order: int) -> list[dict[Symbol, Symbol]]:
    """Return what each order of `slope_jumps` is solved for."""
    point, across, along = base_derivative(0, 0), base_derivative(1, 0), base_derivative(0, 1)
    found: list[dict[Symbol, Symbol]] = [{point: slope("l", 0)}]
    for k in range(1, order + 1):
        found.append({along: slope("q", k), across: slope("p", k), point: slope("l", k)})
    return found


def crease_left(order: int) -> tuple[Expr, ...]:
    """Return what is left of each jump of slopes, all that can be solved for being so, where it is the first one.

    R_v behind the joint has a part e(w) N out of the tangent plane: e_0 = .. = e_(j-1) = 0 for jump j. A functional
    that is 0 on R, R_w and R_v tells it, and no l, p or q changes that: it is the crease of the faces themselves.

    Examples
    --------
    >>> crease_left(2)
    (-N*e0*l0, -N*e1*l0*p1, -N*e2*l0*p1**2)
    """
    found = []
    for j in range(order + 1):
        flat = {Symbol(f"e{k}"): sympify(0) for k in range(j)}
        jumps = [value.xreplace(flat) for value in slope_jumps(j, creased=True)]
        found.append(solved_in_turn(jumps, slope_unknowns(j))[1][-1])
    return tuple(found)


def inherited_share(order: int, degree: int) -> Expr:
    """Return the share at u of a jump of the contact's second derivative that a blend of one span has.

    Where only J_0'' jumps, as between a line and an arc of one prism, each of the rows 0..n jumps by the same, and the
    blend by (N_0 + .. + N_n)(u) of it: 1 at the contact, 0 at the other side.

    Examples
    --------
    >>> inherited_share(1, 3).factor()
    (u - 1)**2*(2*u + 1)
    """
    u = Symbol("u")
    binomials = (factorial(degree) / factorial(i) / factorial(degree - i) for i in range(order + 1))
    return sum((c * u**i * (1 - u) ** (degree - i) for i, c in enumerate(binomials)), sympify(0))
