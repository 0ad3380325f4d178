"""The thin-plate energy (11) of a semi-structured surface as a quadratic form, and where it is stationary.

With P(u, v) = sum_i sum_j P_ij B_j(v; V_i) N_i(u; U) the energy is the sum over all pairs

    E = sum_(i, i') sum_(j, j') K[i j, i' j'] P_ij . P_i'j',
    K[i j, i' j'] = A2 G0 + 2 A1 G1 + A0 G2,
    A_d = integral of N_i^(d) N_i'^(d) du over [u_s, u_e],      both functions over U,
    G_d = integral of B_j^(d)(v; V_i) B_j'^(d)(v; V_i') dv over [v_s, v_e], over V_i and V_i'.

Nothing else is needed: each integral is one of products of two derivatives of the *same* order, in v between two
knot vectors that may differ. (The cross integrals of (11) pair P_uu with itself and so on; P_uu . P_vv does not occur.)
On each span between neighbouring knots of either vector the integrand is a polynomial, so each integral is a rational
function of the knots. Second derivatives are taken span by span: at a knot of full multiplicity a crease costs nothing.

Source: equation (11) of the paper; the Gram form is derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

from sympy import Expr, Function, IndexedBase, Matrix, Poly, Sum, Symbol, factor, sympify
from sympy.polys.constructor import construct_domain

from semispline.derivations.splines import Span, X, basis_pieces, exact_knots

# P_uu, P_uv, P_vv of one coordinate of the surface.
SECOND_DERIVATIVES = (Symbol("P_uu"), Symbol("P_uv"), Symbol("P_vv"))


@dataclass(frozen=True)
class Basis:
    """A B-spline basis over exact knots.

    Parameters
    ----------
    degree : int
    knots : sequence, length n + degree + 1
        Integers, fractions or symbols, ascending.

    Examples
    --------
    >>> Basis(1, (0, 0, 1, 1)).size
    2
    """

    degree: int
    knots: tuple[Any, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "knots", exact_knots(self.knots))

    @property
    def size(self) -> int:
        """Number of basis functions n."""
        return len(self.knots) - self.degree - 1

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """The polynomial spans."""
        return basis_pieces(self.degree, self.knots)

    @property
    def breakpoints(self) -> tuple[Expr, ...]:
        """Ends of the spans of the domain, ascending."""
        return (*(span.start for span in self.spans), self.spans[-1].end)


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
    product of a function of u and one of v, so its double integral is a product A_d G_e.

    Raises
    ------
    ArithmeticError
        Should a term not separate, which would mean that other integrals are needed.

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
            first, second = (Function(f"{name}{k}")(x).diff((x, d)) for k in (1, 2))
            total = total.subs(first * second, Symbol(f"{letter}{d}"))
    if total.has(u, v):
        raise ArithmeticError(f"the bilinear form {total} does not separate into A_d and G_d")
    return total


def _second(value: Expr, which: Symbol, u: Symbol, v: Symbol) -> Expr:
    """Differentiate twice by what the name of the symbol says."""
    for letter in which.name.split("_")[1]:
        value = value.diff(u if letter == "u" else v)
    return value


def merged_breakpoints(*bases: Basis) -> tuple[Expr, ...]:
    """Return the breakpoints of all bases together, ascending.

    Raises
    ------
    ValueError
        Symbolic knots of two different vectors, whose order nobody has said; domains that differ.

    Examples
    --------
    >>> merged_breakpoints(Basis(1, (0, 0, "1/2", 1, 1)), Basis(1, (0, 0, "1/3", 1, 1)))
    (0, 1/3, 1/2, 1)
    """
    vectors = list(dict.fromkeys(basis.breakpoints for basis in bases))
    if len(vectors) == 1:
        return vectors[0]
    if not all(knot.is_Rational for vector in vectors for knot in vector):
        raise ValueError("knots: the order of symbolic knots of different vectors is not known; give all breakpoints")
    for vector in vectors[1:]:
        if (vector[0], vector[-1]) != (vectors[0][0], vectors[0][-1]):
            found = f"[{vector[0]}, {vector[-1]}] and [{vectors[0][0]}, {vectors[0][-1]}]"
            raise ValueError(f"knots: found domains {found}, expected the same domain")
    return tuple(sorted({knot for vector in vectors for knot in vector}))


def gram_matrix(derivative: int, first: Basis, second: Basis, breakpoints: Sequence[Any] | None = None) -> Matrix:
    """Return the exact integrals of products of `derivative`-th derivatives of two bases.

    Parameters
    ----------
    derivative : int
        d.
    first, second : Basis
        Over knot vectors that may differ, of degrees that may differ; the same domain.
    breakpoints : sequence, optional
        All distinct knots in ascending order; needed where two different vectors hold symbols.

    Returns
    -------
    Matrix, shape (first.size, second.size)
        Entry [j, j'] is the integral of B_j^(d) B_j'^(d) over the domain.

    Raises
    ------
    ValueError
        Domains that differ, an order of symbols that is not known, breakpoints that miss a knot.

    Examples
    --------
    >>> gram_matrix(1, Basis(1, (0, 0, "t", "t")), Basis(1, (0, 0, "t", "t")))
    Matrix([
    [ 1/t, -1/t],
    [-1/t,  1/t]])
    """
    points = exact_knots(breakpoints) if breakpoints is not None else merged_breakpoints(first, second)
    missing = [knot for basis in (first, second) for knot in basis.breakpoints if knot not in points]
    if missing:
        raise ValueError(f"breakpoints: {missing[0]} is missing, expected all distinct knots")
    domain, ends = construct_domain(list(points), field=True)
    total = [[domain.zero] * second.size for _ in range(first.size)]
    for (start, left_end), (_, right_end) in pairwise(zip(points, ends, strict=True)):
        one, other = (_span_at(basis, start, points) for basis in (first, second))
        lefts, rights = ([_coefficients(p, derivative, domain) for p in span.pieces] for span in (one, other))
        # Powers of the ends are shared by all pairs of pieces.
        weights = [
            (right_end ** (k + 1) - left_end ** (k + 1)) / (k + 1)
            for k in range(max(map(len, lefts)) + max(map(len, rights)) - 1)
        ]
        for r, left in enumerate(lefts):
            for s, right in enumerate(rights):
                value = sum(
                    (a * b * weights[i + j] for i, a in enumerate(left) for j, b in enumerate(right)), domain.zero
                )
                total[one.first + r][other.first + s] += value
    return Matrix([[factor(domain.to_sympy(entry)) for entry in row] for row in total])


def _span_at(basis: Basis, start: Expr, points: Sequence[Expr]) -> Span:
    """Return the span of `basis` that begins at or before `start` in the order of `points`."""
    index = points.index(start)
    return next(span for span in reversed(basis.spans) if points.index(span.start) <= index)


def _coefficients(piece: Poly, derivative: int, domain: Any) -> list[Any]:
    """Return the coefficients of a derivative of a piece in `domain`, lowest power first."""
    derived = piece.diff((X, derivative)) if derivative else piece
    return [domain.convert_from(c, derived.domain) for c in reversed(derived.rep.to_list())]


@dataclass(frozen=True)
class ExactSurface:
    """The bases of a semi-structured surface: N_i over U, and for each i the basis of v-control curve i.

    Parameters
    ----------
    u : Basis
        Of size m + 1.
    curves : tuple of Basis, length m + 1
        Over V_i, all on one v-domain.

    Raises
    ------
    ValueError
        Another number of curves than basis functions in u.
    """

    u: Basis
    curves: tuple[Basis, ...]

    def __post_init__(self) -> None:
        if len(self.curves) != self.u.size:
            raise ValueError(f"curves: found {len(self.curves)}, expected {self.u.size}, one for each N_i")

    @property
    def index(self) -> tuple[tuple[int, int], ...]:
        """The pairs (i, j) in the order of rows and columns of `energy_matrix`."""
        return tuple((i, j) for i, curve in enumerate(self.curves) for j in range(curve.size))


def energy_matrix(surface: ExactSurface) -> Matrix:
    """Return K, so that (11) is x' K x summed over the coordinates x of the control points.

    Returns
    -------
    Matrix, shape (N, N)
        N control points in the order of `surface.index`; symmetric.

    Examples
    --------
    >>> flat = Basis(1, (0, 0, 1, 1))
    >>> energy_matrix(ExactSurface(flat, (flat, flat)))[0, :]
    Matrix([[2, -2, -2, 2]])
    """
    block = gram_block()
    across = [gram_matrix(d, surface.u, surface.u) for d in range(3)]
    rows = []
    along: dict[tuple[Basis, Basis], list[Matrix]] = {}
    for i, one in enumerate(surface.curves):
        row = []
        for k, other in enumerate(surface.curves):
            if (one, other) not in along:
                along[one, other] = [gram_matrix(d, one, other) for d in range(3)]
            values = {Symbol(f"A{d}"): across[d][i, k] for d in range(3)}
            coefficients = [block.coeff(Symbol(f"G{d}")).subs(values) for d in range(3)]
            total = Matrix.zeros(one.size, other.size)
            for coefficient, matrix in zip(coefficients, along[one, other], strict=True):
                total += coefficient * matrix
            row.append(total)
        rows.append(Matrix.hstack(*row))
    return Matrix.vstack(*rows)


def quadratic_form() -> Expr:
    """Return the energy of one coordinate over all control points, numbered by s and t through the pairs (i, j).

    Examples
    --------
    >>> quadratic_form()
    Sum(K[s, t]*P[s]*P[t], (s, 0, N), (t, 0, N))
    """
    s, t, last = (Symbol(name, integer=True) for name in ("s", "t", "N"))
    matrix, points = IndexedBase("K"), IndexedBase("P")
    return Sum(matrix[s, t] * points[s] * points[t], (s, 0, last), (t, 0, last))


def stationarity_condition() -> Expr:
    """Return what vanishes for each free control point r: half the derivative of `quadratic_form` by P_r.

    Notes
    -----
    K is symmetric: exchanging (i, j) and (i', j') transposes each integral.

    Examples
    --------
    >>> stationarity_condition()
    Sum(K[r, t]*P[t], (t, 0, N))
    """
    r, s, t, last = (Symbol(name, integer=True) for name in ("r", "s", "t", "N"))
    matrix, points = IndexedBase("K"), IndexedBase("P")
    gradient = quadratic_form().diff(points[r]).doit()
    # The derivative is a Piecewise whose first case is 0 <= r <= N.
    inside = gradient.args[0][0] / 2
    symmetric = inside.replace(
        lambda e: e == Sum(matrix[s, r] * points[s], (s, 0, last)),
        lambda e: Sum(matrix[r, t] * points[t], (t, 0, last)),
    )
    return symmetric.expand()


def stationarity_system(energy: Expr, free: Sequence[Symbol], fixed: Sequence[Symbol]) -> tuple[Matrix, Matrix]:
    """Return A and B of A x + B n = 0, where a quadratic energy is stationary in the free unknowns.

    Parameters
    ----------
    energy : Expr
        Quadratic form in the symbols of one coordinate.
    free : sequence of Symbol
        The unknown x.
    fixed : sequence of Symbol
        The known n, set by the contact conditions.

    Returns
    -------
    tuple of Matrix
        A, shape (free, free), symmetric, and B, shape (free, fixed): half the second derivatives of the energy.
        With E = z' K z they are the rows of the free unknowns of K.

    Examples
    --------
    >>> x, n = Symbol("x"), Symbol("n")
    >>> stationarity_system((x - n) ** 2 + x**2, [x], [n])
    (Matrix([[2]]), Matrix([[-1]]))
    """
    gradient = [energy.diff(symbol) / 2 for symbol in free]
    return tuple(
        Matrix([[entry.diff(symbol) for symbol in symbols] for entry in gradient]) for symbols in (free, fixed)
    )
