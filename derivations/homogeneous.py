"""Contact with a rational base, in homogeneous coordinates: R^h = (omega R, omega), omega the weight.

Let w(u) = p1 u + p2 u^2 / 2 + .. and lambda(u, v) > 0. Then H(u, v) = lambda(u, v) R^h(w(u), v) has the quotient
R(w(u), v), whatever lambda is: a blend whose derivatives of order 0..n at u = 0 are those of H meets the base with
contact of order n. By the product rule H_k = sum_j C(k, j) l_(k-j) A_j, with A_j the contact conditions of R^h and l_j
the derivatives of lambda. A polynomial base is the case
omega = 1, lambda = 1.

A lambda that is a function mu of w and v is another representative mu R^h of the same base: `leibniz` of its jets. Two
of them make weights tame: the reciprocal of the mean weight, whose weights have the means 1, 0, 0, ..
(`reciprocal_jet`); and the one all of whose weights beyond the contact vanish (`last_rung`).

Everything here holds for symbolic jets, so for every degree and every knot vector, rational or not.
"""

from __future__ import annotations

from collections.abc import Sequence

from sympy import Expr, Matrix, Symbol, binomial, expand, sympify

from semispline.derivations.contact import base_derivative, contact_conditions
from semispline.derivations.fairness import DERIVATIVES, Program


def jet(letter: str, order: int) -> tuple[Symbol, ...]:
    """Return symbols for the derivatives of order 0..n.

    Examples
    --------
    >>> jet("l", 2)
    (l0, l1, l2)
    """
    return tuple(Symbol(f"{letter}{k}") for k in range(order + 1))


def leibniz(factor: Sequence[Expr]) -> Matrix:
    """Return the matrix L that takes the jet of a function to that of its product with a factor of the given jet.

    Examples
    --------
    >>> leibniz(jet("l", 2))
    Matrix([
    [l0,    0,  0],
    [l1,   l0,  0],
    [l2, 2*l1, l0]])
    """
    n = len(factor)
    return Matrix(n, n, lambda k, j: binomial(k, j) * factor[k - j] if j <= k else sympify(0))


def reciprocal_jet(values: Sequence[Expr]) -> tuple[Expr, ...]:
    """Return the jet of 1 / m from that of m: the solution of m c = 1, order by order.

    Examples
    --------
    >>> reciprocal_jet(jet("m", 1))
    (1/m0, -m1/m0**2)
    """
    found: list[Expr] = []
    for k in range(len(values)):
        total = sum((binomial(k, j) * values[j] * found[k - j] for j in range(1, k + 1)), sympify(0))
        found.append(((1 if k == 0 else 0) - expand(total)) / values[0])
    return tuple(value.expand() for value in found)


def homogeneous_conditions(order: int, point: Sequence[Expr], weight: Sequence[Expr]) -> tuple[Matrix, ...]:
    """Return H_0..H_n as (X, W) for jets of X = omega R and of omega along w.

    Parameters
    ----------
    order : int
        n.
    point, weight : sequence of Expr, length n + 1
        Derivatives of X and of omega by w at the contact; those of lambda are l0, l1, ..

    Examples
    --------
    >>> homogeneous_conditions(1, jet("X", 1), jet("omega", 1))[1]
    Matrix([[X0*l1 + X1*l0*p1, l0*omega1*p1 + l1*omega0]])
    """
    unused = {Symbol(f"q{k}"): 0 for k in range(1, order + 1)}
    conditions = [condition.subs(unused) for condition in contact_conditions(order)]
    columns = []
    for values in (point, weight):
        at = {base_derivative(k, 0): value for k, value in enumerate(values)}
        own = Matrix([condition.subs(at, simultaneous=True) for condition in conditions])
        columns.append(leibniz(jet("l", order)) * own)
    return tuple(Matrix([[x.expand(), w.expand()]]) for x, w in zip(*columns, strict=True))


def contact_residuals(order: int) -> tuple[Expr, ...]:
    """Return what must vanish for H to have the contact conditions of R as its quotient's derivatives.

    With R_k and omega_k free, X_k the jet of omega R, and P_k the contact conditions of order 0..n of R itself: the
    derivatives of X = W P, that is X_k - sum_j C(k, j) W_(k-j) P_j. Since W_0 = l0 omega0 is not zero, P_k follow from
    H by forward substitution, and they are these.

    Examples
    --------
    >>> contact_residuals(2)
    (0, 0, 0)
    """
    weight, own = jet("omega", order), Matrix([base_derivative(k, 0) for k in range(order + 1)])
    point = tuple(leibniz(weight) * own)
    unused = {Symbol(f"q{k}"): 0 for k in range(1, order + 1)}
    wanted = Matrix([condition.subs(unused) for condition in contact_conditions(order)])
    found = homogeneous_conditions(order, point, weight)
    product = leibniz([row[1] for row in found]) * wanted
    return tuple(expand(row[0] - value) for row, value in zip(found, product, strict=True))


def last_rung(order: int) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
    """Return the jets of a representative of the base whose weight is omega^(n+1) at the contact and 0 beyond.

    mu = omega0^(n+1) / omega along w, with omega0 its value at the contact: then mu R^h = omega0^(n+1) (R, 1), which
    has the jets omega0^(n+1) R_k. All of them are polynomials in the jets of X and omega, by omega0^k times

        omega0^(k+1) R_k = omega0^k X_k - sum_(j = 1..k) C(k, j) omega_j omega0^(j-1) omega0^(k-j+1) R_(k-j).

    Returns
    -------
    jets : tuple of Expr, length n + 1
        omega0^(n+1) R_k in X_j and om_j.
    weights : tuple of Expr, length n + 1
        omega0^(n+1), 0, 0, ..

    Examples
    --------
    >>> last_rung(1)[0]
    (X0*omega0, -X0*omega1 + X1*omega0)
    """
    x, om = jet("X", order), jet("omega", order)
    numerators: list[Expr] = []
    for k in range(order + 1):
        total = om[0] ** k * x[k]
        for j in range(1, k + 1):
            total -= binomial(k, j) * om[j] * om[0] ** (j - 1) * numerators[k - j]
        numerators.append(expand(total))
    jets = tuple(expand(om[0] ** (order - k) * numerators[k]) for k in range(order + 1))
    return jets, (om[0] ** (order + 1), *([sympify(0)] * order))


# The derivatives of a homogeneous surface that those of its quotient need, itself included.
HOMOGENEOUS = ("", *DERIVATIVES)


def homogeneous_symbol(name: str, coordinate: str) -> Symbol:
    """Return the symbol of a coordinate x, y, z or w of a derivative of (X, W).

    Examples
    --------
    >>> homogeneous_symbol("", "w"), homogeneous_symbol("uv", "x")
    (h_w, h_uv_x)
    """
    return Symbol("_".join(part for part in ("h", name, coordinate) if part))


def quotient_program() -> Program:
    """Return the steps from ten derivatives of (X, W) to nine of the surface X / W.

    X = W S, by the product rule for each order: W S^(a,b) = X^(a,b) - sum C(a,i) C(b,j) W^(i,j) S^(a-i,b-j).

    Examples
    --------
    >>> program = quotient_program()
    >>> len(program.inputs), len(program.outputs)
    (40, 27)
    """
    steps: list[tuple[Symbol, Expr]] = []

    def named(name: str, value: Expr) -> Symbol:
        steps.append((Symbol(name), value))
        return steps[-1][0]

    per_w = named("per_w", 1 / homogeneous_symbol("", "w"))
    # Fractions of the weight: one product each in the three coordinates.
    share = {name: named(f"share_{name}", homogeneous_symbol(name, "w") * per_w) for name in DERIVATIVES}
    known: dict[tuple[str, str], Symbol] = {}
    for c in "xyz":
        known["", c] = named(f"p_{c}", homogeneous_symbol("", c) * per_w)
        for name in DERIVATIVES:
            a, b = name.count("u"), name.count("v")
            value = homogeneous_symbol(name, c) * per_w
            for i in range(a + 1):
                for j in range(b + 1):
                    if i or j:
                        lower = "u" * (a - i) + "v" * (b - j)
                        value -= binomial(a, i) * binomial(b, j) * share["u" * i + "v" * j] * known[lower, c]
            known[name, c] = named(f"p_{name}_{c}", value)
    outputs = tuple(known[name, c] for name in DERIVATIVES for c in "xyz")
    inputs = tuple(homogeneous_symbol(name, c) for name in HOMOGENEOUS for c in "xyzw")
    return Program(inputs, tuple(steps), outputs)
