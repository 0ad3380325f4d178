"""A whole small blend problem in exact arithmetic: energy, contact constraints, Lagrangian, derivatives, minimum.

Here the energy is integrated from P(u, v) itself, cell by cell, without Gram integrals, and differentiated by SymPy:
an oracle for the Gram form, for the stationarity system and for what CasADi differentiates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

from sympy import Expr, Poly, Rational
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix
from sympy.polys.rings import PolyElement, PolyRing

from semispline.derivations.contact import A, contact_rows
from semispline.derivations.energy import Basis, ExactSurface, energy_matrix, merged_breakpoints
from semispline.derivations.splines import X

# The terms of (11): factor, derivatives by u and v.
_TERMS = ((1, 2, 0), (2, 1, 1), (1, 0, 2))


@dataclass(frozen=True)
class ExactBase:
    """A base seen from its contact.

    Parameters
    ----------
    across : Basis
        Degree q and knots W, the contact at the start.
    rows : nested tuple, shape (n + 1 or more, n_j, 3)
        Rational rows R_0, R_1, .. counted from the contact.
    """

    across: Basis
    rows: tuple[tuple[tuple[Any, ...], ...], ...]

    def spans(self, order: int) -> tuple[Expr, ...]:
        """Return H_1..H_order; the whole length of the domain where there is no such knot (see `end_derivatives`)."""
        knots, q = self.across.knots, self.across.degree
        return tuple(knots[min(q + r, len(knots) - 1)] - knots[q] for r in range(1, order + 1))


@dataclass(frozen=True)
class BlendProblem:
    """The G^n problem as the solver is to pose it: polynomials over the rational numbers.

    Parameters
    ----------
    surface : ExactSurface
        Bases of the blend.
    order : int
        n.
    base_a, base_b : ExactBase
        At u = 0 and u = 1.
    unknowns : tuple of str
        P_i_j_x, P_i_j_y, P_i_j_z for all (i, j) of `surface.index`, then alpha, beta.
    energy : PolyElement
        (11) as a polynomial in the control points.
    constraints : tuple of PolyElement
        P_i - sum_j C[i, j](alpha^2) R_j for rows i = 0..n, all j and coordinates; then P_(m-i) with beta^2 likewise.
    """

    surface: ExactSurface
    order: int
    base_a: ExactBase
    base_b: ExactBase
    unknowns: tuple[str, ...]
    energy: PolyElement
    constraints: tuple[PolyElement, ...]


def blend_problem(order: int, surface: ExactSurface, base_a: ExactBase, base_b: ExactBase) -> BlendProblem:
    """Build the problem for bases a (at u = 0) and b (at u = 1).

    Parameters
    ----------
    order : int
        0..3, contact G^order on both sides.
    surface : ExactSurface
        Rational knots; the first order + 1 curves as long as the rows of a, the last as those of b.
    base_a, base_b : ExactBase

    Raises
    ------
    ValueError
        Rows of another length than the v-control curves that they determine.
    """
    names = [f"P_{i}_{j}_{x}" for i, j in surface.index for x in "xyz"]
    ring = PolyRing([*names, "alpha", "beta"], QQ)
    point = {pair: ring.gens[3 * k : 3 * k + 3] for k, pair in enumerate(surface.index)}
    energy = sum((_energy(surface, {pair: p[c] for pair, p in point.items()}, ring) for c in range(3)), ring.zero)
    constraints: list[PolyElement] = []
    for base, step, shape in ((base_a, 1, ring.gens[-2]), (base_b, -1, ring.gens[-1])):
        for (i, j), target in _targets(order, surface, base, step).items():
            for c in range(3):
                terms = (shape ** (2 * k) * value if k else ring(value) for k, value in enumerate(target[c]))
                constraints.append(point[i, j][c] - sum(terms, ring.zero))
    return BlendProblem(surface, order, base_a, base_b, tuple(str(g) for g in ring.gens), energy, tuple(constraints))


def _targets(order: int, surface: ExactSurface, base: ExactBase, step: int) -> dict[tuple[int, int], list[list[Any]]]:
    """Return for each point (i, j) set by contact and each coordinate its coefficients of a^0, a^1, ..

    `step` is 1 for the contact at u = 0, -1 for the one at u = 1.
    """
    knots, p = surface.u.knots[::step], surface.u.degree
    spans = [abs(knots[p + r] - knots[p]) for r in range(1, order + 1)]
    matrix = contact_rows(order, p, spans, base.across.degree, base.spans(order))
    # Coefficients of the powers of a in C[i, k].
    powers = [[Poly(matrix[i, k], A, domain=QQ).rep.to_list()[::-1] for k in range(i + 1)] for i in range(order + 1)]
    targets = {}
    for i in range(order + 1):
        row = i if step > 0 else len(surface.curves) - 1 - i
        for k, points in enumerate(base.rows[: i + 1]):
            if len(points) != surface.curves[row].size:
                raise ValueError(f"rows[{k}]: found {len(points)} points, expected {surface.curves[row].size}")
        for j in range(surface.curves[row].size):
            targets[row, j] = [
                [_at_power(powers[i], [points[j][x] for points in base.rows[: i + 1]], d) for d in range(order + 1)]
                for x in range(3)
            ]
    return targets


def _at_power(row: Sequence[list[Any]], values: Sequence[Any], d: int) -> Any:
    """Return the coefficient of a^d in sum_k row[k] values[k]; rows that the base does not have enter with zero."""
    pairs = zip(row, values, strict=False)
    return sum((powers[d] * _rational(value) for powers, value in pairs if d < len(powers)), QQ.zero)


def _energy(surface: ExactSurface, point: dict[tuple[int, int], PolyElement], ring: PolyRing) -> PolyElement:
    """Integrate the thin-plate density of one coordinate over all cells between knots."""
    total = ring.zero
    breakpoints = merged_breakpoints(*surface.curves)
    for u_span in surface.u.spans:
        for start, end in pairwise(breakpoints):
            for factor, du, dv in _TERMS:
                total += factor * _cell(surface, point, ring, (u_span, start, end), (du, dv))
    return total


def _cell(
    surface: ExactSurface,
    point: dict[tuple[int, int], PolyElement],
    ring: PolyRing,
    cell: tuple[Any, Expr, Expr],
    orders: tuple[int, int],
) -> PolyElement:
    """Integrate the square of one derivative of P over one cell."""
    u_span, start, end = cell
    # P's derivative as a polynomial in u and v, power pairs to linear forms in the control points.
    form: dict[tuple[int, int], PolyElement] = {}
    for r, across in enumerate(u_span.pieces):
        i = u_span.first + r
        curve = surface.curves[i]
        v_span = next(span for span in reversed(curve.spans) if span.start <= start)
        for s, along in enumerate(v_span.pieces):
            for a, left in enumerate(_powers(across, orders[0])):
                for b, right in enumerate(_powers(along, orders[1])):
                    if left and right:
                        form[a, b] = form.get((a, b), ring.zero) + point[i, v_span.first + s] * (left * right)
    top_u, top_v = (2 * max((powers[k] for powers in form), default=0) + 1 for k in (0, 1))
    u_moments, v_moments = _moments(u_span.start, u_span.end, top_u), _moments(start, end, top_v)
    total = ring.zero
    for (a, b), value in form.items():
        weighted = sum((other * (u_moments[a + c] * v_moments[b + d]) for (c, d), other in form.items()), ring.zero)
        total += value * weighted
    return total


def _powers(piece: Poly, order: int) -> list[Any]:
    """Return the rational coefficients of a derivative of a piece, lowest power first."""
    derived = piece.diff((X, order)) if order else piece
    return [QQ.convert_from(c, derived.domain) for c in reversed(derived.rep.to_list())]


def _moments(start: Expr, end: Expr, count: int) -> list[Any]:
    """Return the integrals of x^k over [start, end], k = 0..count - 1."""
    low, high = QQ.from_sympy(start), QQ.from_sympy(end)
    return [(high ** (k + 1) - low ** (k + 1)) / (k + 1) for k in range(count)]


def lagrangian(problem: BlendProblem, multipliers: Sequence[Any]) -> PolyElement:
    """Return energy + sum_k multipliers[k] constraints[k], a polynomial in the unknowns.

    Raises
    ------
    ValueError
        Another number of multipliers than constraints.
    """
    if len(multipliers) != len(problem.constraints):
        raise ValueError(f"multipliers: found {len(multipliers)}, expected {len(problem.constraints)}")
    pairs = zip(multipliers, problem.constraints, strict=True)
    return sum((constraint * _rational(value) for value, constraint in pairs), problem.energy)


def value_at(polynomial: PolyElement, point: Sequence[Any]) -> Fraction:
    """Return the value of a polynomial at a point, exactly.

    Raises
    ------
    ValueError
        Another number of values than unknowns.

    Examples
    --------
    >>> x, y = PolyRing("x, y", QQ).gens
    >>> value_at(x**2 * y, [3, 0.5])
    Fraction(9, 2)
    """
    return _evaluate(polynomial, _point(polynomial, point))


def _point(polynomial: PolyElement, point: Sequence[Any]) -> list[Any]:
    if len(point) != polynomial.ring.ngens:
        raise ValueError(f"point: found {len(point)} values, expected {polynomial.ring.ngens}")
    return [_rational(value) for value in point]


def derivatives_at(
    polynomial: PolyElement, point: Sequence[Any]
) -> tuple[Fraction, list[Fraction], list[list[Fraction]]]:
    """Return value, gradient and Hessian of a polynomial, differentiated by SymPy and evaluated exactly.

    Parameters
    ----------
    polynomial : PolyElement
        The energy, a constraint or a Lagrangian of `BlendProblem`.
    point : sequence of number
        One for each unknown; floats are taken as the binary fractions that they are.

    Returns
    -------
    value, gradient, hessian
        Exact fractions, shapes (), (N,), (N, N).

    Raises
    ------
    ValueError
        Another number of values than unknowns.

    Examples
    --------
    >>> x, y = PolyRing("x, y", QQ).gens
    >>> derivatives_at(x**2 * y, [3, 0.5])[1]
    [Fraction(3, 1), Fraction(9, 1)]
    """
    values = _point(polynomial, point)
    generators = polynomial.ring.gens
    gradient = [polynomial.diff(generator) for generator in generators]
    hessian = [[entry.diff(generator) for generator in generators] for entry in gradient]
    return (
        _evaluate(polynomial, values),
        [_evaluate(entry, values) for entry in gradient],
        [[_evaluate(entry, values) for entry in row] for row in hessian],
    )


def exact_minimum(problem: BlendProblem, alpha2: Any, beta2: Any) -> tuple[Fraction, list[list[Fraction]]]:
    """Return least energy and control points for given shape parameters, by exact linear algebra.

    Parameters
    ----------
    problem : BlendProblem
    alpha2, beta2 : number
        a and b; both 1 for C^n.

    Returns
    -------
    energy : Fraction
    control_points : list, shape (N, 3)
        In the order of `problem.surface.index`.

    Raises
    ------
    ValueError
        Contact rows of the two sides that overlap: too few v-control curves.
    """
    surface, n = problem.surface, problem.order
    m = len(surface.curves) - 1
    if 2 * (n + 1) > m + 1:
        raise ValueError(
            f"curves: found {m + 1}, expected at least {2 * (n + 1)} for contact of order {n} at both ends"
        )
    known = {}
    for base, step, shape in ((problem.base_a, 1, _rational(alpha2)), (problem.base_b, -1, _rational(beta2))):
        for place, target in _targets(n, surface, base, step).items():
            known[place] = [sum((value * _power(shape, d) for d, value in enumerate(t)), QQ.zero) for t in target]
    index = surface.index
    fixed = [k for k, pair in enumerate(index) if pair in known]
    free = [k for k, pair in enumerate(index) if pair not in known]
    matrix = DomainMatrix.from_Matrix(energy_matrix(surface)).convert_to(QQ).to_dense()
    points = {k: known[index[k]] for k in fixed}
    if free:
        right = -matrix.extract(free, fixed) * DomainMatrix([points[k] for k in fixed], (len(fixed), 3), QQ)
        solution = matrix.extract(free, free).lu_solve(right).to_list()
        points |= dict(zip(free, solution, strict=True))
    net = DomainMatrix([points[k] for k in range(len(index))], (len(index), 3), QQ)
    energy = (net.transpose() * matrix * net).to_list()
    return _fraction(sum((energy[c][c] for c in range(3)), QQ.zero)), [[_fraction(x) for x in p] for p in net.to_list()]


def _evaluate(polynomial: PolyElement, values: Sequence[Any]) -> Fraction:
    total = QQ.zero
    for powers, coefficient in polynomial.terms():
        term = coefficient
        for k, power in enumerate(powers):
            if power:
                term *= _power(values[k], power)
        total += term
    return _fraction(total)


def _power(value: Any, power: int) -> Any:
    return value**power if power else QQ.one


def _rational(value: Any) -> Any:
    # A float is the binary fraction that it holds.
    return QQ.from_sympy(Rational(Fraction(value) if isinstance(value, float) else value))


def _fraction(value: Any) -> Fraction:
    return Fraction(int(value.numerator), int(value.denominator))
