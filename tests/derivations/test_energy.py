"""Gram entries, the quadratic form and its stationary point, against integration of P(u, v) itself."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from sympy import Indexed, Matrix, Rational, Symbol, cancel, integrate, symbols

from helpers.sweeps import first_ones
from semispline.derivations.energy import (
    SECOND_DERIVATIVES,
    Basis,
    ExactSurface,
    energy_matrix,
    gram_block,
    gram_matrix,
    merged_breakpoints,
    quadratic_form,
    stationarity_condition,
    stationarity_system,
    thin_plate_density,
)
from semispline.derivations.problem import ExactBase, blend_problem, derivatives_at, exact_minimum, lagrangian, value_at

CUBIC_U = Basis(3, (0, 0, 0, 0, "1/4", "1/2", "3/4", 1, 1, 1, 1))
LEFT = Basis(2, (0, 0, 0, "1/3", 1, 1, 1))
MIDDLE = Basis(2, (0, 0, 0, "2/5", 1, 1, 1))
RIGHT = Basis(2, (0, 0, 0, "1/2", "1/2", 1, 1, 1))
SURFACE = ExactSurface(CUBIC_U, (LEFT, LEFT, LEFT, MIDDLE, RIGHT, RIGHT, RIGHT))


def made_base(across, n, x0, step, bend):
    rows = [
        [[x0 + step * i, j, Rational(bend * (i + 1) * (j - 1) ** 2, 7)] for j in range(n)] for i in range(across.size)
    ]
    return ExactBase(across, tuple(tuple(map(tuple, row)) for row in rows))


@pytest.fixture(scope="module")
def problem():
    base_a = made_base(Basis(2, (0, 0, 0, "1/2", 1, 1, 1)), LEFT.size, 0, 1, 1)
    # Two rows only: degree 1 across.
    base_b = made_base(Basis(1, (0, 0, 2, 2)), RIGHT.size, -3, -1, 2)
    return blend_problem(2, SURFACE, base_a, base_b)


@st.composite
def bases(draw):
    degree = draw(st.integers(1, 4))
    inner = sorted(draw(st.lists(st.fractions(Fraction(1, 7), Fraction(6, 7), max_denominator=7), max_size=2)))
    while any(inner.count(knot) > degree for knot in inner):
        inner = sorted(set(inner))
    return Basis(degree, (0,) * (degree + 1) + tuple(inner) + (1,) * (degree + 1))


@pytest.mark.long
@given(bases(), bases(), st.integers(0, 2))
@settings(max_examples=25)
def test_gram_entries_agree_with_quadrature_of_scipy_splines(first, second, derivative):
    exact = gram_matrix(derivative, first, second)
    numeric = np.zeros(exact.shape)
    # Five Gauss nodes are exact for products of degree 8; they lie inside a span, where SciPy sees one polynomial.
    nodes, weights = np.polynomial.legendre.leggauss(5)
    for start, end in pairwise(np.array(merged_breakpoints(first, second), float)):
        x = start + (end - start) * (nodes + 1) / 2
        left, right = (
            BSpline(np.array(b.knots, float), np.eye(b.size), b.degree)(x, derivative) for b in (first, second)
        )
        numeric += (end - start) / 2 * (left.T * weights) @ right
    # A few roundings of the largest entry: the sums have at most eight spans.
    np.testing.assert_allclose(np.array(exact, float), numeric, rtol=0, atol=1e-12 * max(1.0, np.abs(numeric).max()))


@pytest.mark.parametrize("derivative", first_ones(1, range(3)))
def test_symbolic_gram_with_numbers_put_in_is_the_rational_one(derivative):
    def gram(s, t, breakpoints=None):
        first, second = Basis(2, (0, 0, 0, s, 1, 1, 1)), Basis(3, (0, 0, 0, 0, t, 1, 1, 1, 1))
        return gram_matrix(derivative, first, second, breakpoints)

    rational = gram("1/3", "3/5")
    numbers = {Symbol("s"): Rational(1, 3), Symbol("t"): Rational(3, 5)}
    right_order, wrong_order = gram("s", "t", (0, "s", "t", 1)), gram("s", "t", (0, "t", "s", 1))
    assert (right_order.subs(numbers) - rational).applyfunc(cancel).is_zero_matrix
    assert not (wrong_order.subs(numbers) - rational).applyfunc(cancel).is_zero_matrix


def test_gram_of_one_linear_span_is_known():
    h = Symbol("h")
    assert gram_matrix(0, Basis(1, (0, 0, h, h)), Basis(1, (0, 0, h, h))) == Matrix([[h / 3, h / 6], [h / 6, h / 3]])


def test_bad_gram_calls_are_refused():
    with pytest.raises(ValueError, match="order of symbolic knots"):
        gram_matrix(0, Basis(1, (0, 0, "s", 1, 1)), Basis(1, (0, 0, "t", 1, 1)))
    with pytest.raises(ValueError, match="found domains"):
        gram_matrix(0, Basis(1, (0, 0, 1, 1)), Basis(1, (0, 0, 2, 2)))
    with pytest.raises(ValueError, match="breakpoints: 1/2 is missing"):
        gram_matrix(0, Basis(1, (0, 0, "1/2", 1, 1)), Basis(1, (0, 0, 1, 1)), (0, 1))
    with pytest.raises(ValueError, match="curves: found 1, expected 7"):
        ExactSurface(CUBIC_U, (LEFT,))


@pytest.mark.long
def test_gram_block_is_the_double_integral_of_the_bilinear_density():
    u, v = symbols("u v")
    n1, n2, b1, b2 = u**3 - u, 2 * u**2 + 1, v**3, 1 - v**2 + v

    def box(f):
        return integrate(integrate(f, (u, 0, 1)), (v, 0, 2))

    # Polarisation: the bilinear form is the difference of two energies.
    def energy(f):
        values = dict(zip(SECOND_DERIVATIVES, (f.diff(u, u), f.diff(u, v), f.diff(v, v)), strict=True))
        return box(thin_plate_density().subs(values).expand())

    expected = (energy(n1 * b1 + n2 * b2) - energy(n1 * b1 - n2 * b2)) / 4
    values = {}
    for d in range(3):
        values[Symbol(f"A{d}")] = integrate((n1.diff((u, d)) * n2.diff((u, d))).expand(), (u, 0, 1))
        values[Symbol(f"G{d}")] = integrate((b1.diff((v, d)) * b2.diff((v, d))).expand(), (v, 0, 2))
    assert gram_block().subs(values) == expected


def test_gram_block_refuses_a_density_that_does_not_separate(monkeypatch):
    uu, uv, vv = SECOND_DERIVATIVES
    monkeypatch.setattr("semispline.derivations.energy.thin_plate_density", lambda: uu**2 + 2 * uv**2 + vv**2 + uu * vv)
    with pytest.raises(ArithmeticError, match="does not separate"):
        gram_block()


def test_quadratic_form_is_the_integral_over_the_surface(problem):
    # The left side integrates P(u, v) cell by cell and never forms a Gram integral.
    matrix = energy_matrix(SURFACE)
    assert matrix.is_symmetric()
    n = len(SURFACE.index)
    ring = problem.energy.ring
    place = {str(g): k for k, g in enumerate(ring.gens)}
    for a, (i, j) in enumerate(SURFACE.index):
        for b, (k, m) in enumerate(SURFACE.index):
            monomial = [0] * ring.ngens
            monomial[place[f"P_{i}_{j}_y"]] += 1
            monomial[place[f"P_{k}_{m}_y"]] += 1
            found = problem.energy.get(tuple(monomial), 0)
            assert found == matrix[a, b] * (1 if a == b else 2)
    # Nothing but squares and products within one coordinate.
    assert len(problem.energy.terms()) == 3 * sum(matrix[a, b] != 0 for a in range(n) for b in range(a + 1))


@pytest.mark.parametrize(("heights", "energy"), [("v", 0), ("uv", 2), ("uu", 4)])
def test_energy_of_known_surfaces(heights, energy):
    # z = v, u v, u^2 over the unit square have densities 0, 2 and 4. Blossoms give exact control points.
    def blossom(basis, i):
        return [Rational(knot) for knot in basis.knots[i + 1 : i + basis.degree + 1]]

    def coordinate(i, j):
        us, vs = blossom(CUBIC_U, i), blossom(SURFACE.curves[i], j)
        u, v = sum(us) / len(us), sum(vs) / len(vs)
        square = (us[0] * us[1] + us[0] * us[2] + us[1] * us[2]) / 3
        return {"v": v, "uv": u * v, "uu": square}[heights]

    x = Matrix([coordinate(i, j) for i, j in SURFACE.index])
    assert (x.T * energy_matrix(SURFACE) * x)[0] == energy


def test_stationarity_system_is_the_free_rows_of_the_form():
    flat = Basis(1, (0, 0, 1, 1))
    surface = ExactSurface(Basis(2, (0, 0, 0, 1, 1, 1)), (flat, Basis(1, (0, 0, "1/2", 1, 1)), flat))
    matrix = energy_matrix(surface)
    z = symbols(f"z0:{matrix.rows}")
    energy = (Matrix([z]) * matrix * Matrix(z))[0].expand()
    free, fixed = [2, 3, 4], [0, 1, 5, 6]
    left, right = stationarity_system(energy, [z[k] for k in free], [z[k] for k in fixed])
    assert left == matrix.extract(free, free)
    assert right == matrix.extract(free, fixed)


def test_stationarity_condition_is_the_derivative_of_the_form():
    # Both sums written out for three unknowns and a symmetric K.
    n = 3
    K = Matrix(n, n, lambda s, t: Symbol(f"k{min(s, t)}{max(s, t)}"))
    x = symbols(f"x0:{n}")

    def written_out(expression, **numbers):
        for name, number in numbers.items():
            expression = expression.subs(Symbol(name, integer=True), number)
        expression = expression.subs(Symbol("N", integer=True), n - 1).doit()
        values = {}
        for entry in expression.atoms(Indexed):
            indices = [int(index) for index in entry.indices]
            values[entry] = K[tuple(indices)] if len(indices) == 2 else x[indices[0]]
        return expression.subs(values, simultaneous=True)

    energy = written_out(quadratic_form())
    assert energy.expand() == (Matrix([x]) * K * Matrix(x))[0].expand()
    for r in range(n):
        assert (2 * written_out(stationarity_condition(), r=r) - energy.diff(x[r])).expand() == 0


@pytest.mark.long
def test_exact_minimum_is_stationary_and_least(problem):
    energy, points = exact_minimum(problem, 1, Rational(3, 2))
    flat = [x for point in points for x in point]
    value, gradient, hessian = derivatives_at(problem.energy, [*flat, 1, 1])
    assert value == energy
    middle = [3 * k + c for k, (i, _) in enumerate(SURFACE.index) if i == 3 for c in range(3)]
    assert [gradient[k] for k in middle] == [0] * len(middle)
    # Other points of the middle curve cost more: the free block is positive definite.
    block = np.array([[hessian[a][b] for b in middle] for a in middle], dtype=float)
    assert np.linalg.eigvalsh(block).min() > 0
    # The prescribed rows meet the constraints of side a, where alpha = 1 was asked for, and miss those of side b.
    side_a = problem.constraints[: 9 * LEFT.size]
    assert [value_at(constraint, [*flat, 1, 1]) for constraint in side_a] == [0] * len(side_a)
    assert any(value_at(constraint, [*flat, 1, 1]) for constraint in problem.constraints)


@pytest.mark.long
def test_derivatives_of_the_lagrangian_agree_with_exact_differences(problem):
    # Central differences without rounding: exact for the control points, which enter quadratically.
    multipliers = [Rational(k % 5 - 2, 3) for k in range(len(problem.constraints))]
    point = [Rational(k % 7 - 3, 2) for k in range(len(problem.unknowns) - 2)] + [Rational(5, 4), Rational(2, 3)]
    function = lagrangian(problem, multipliers)
    _, gradient, hessian = derivatives_at(function, point)

    def along(place, step):
        moved = list(point)
        moved[place] += step
        return value_at(function, moved)

    for place in (0, 7, len(point) - 3):
        assert along(place, 1) - along(place, -1) == 2 * gradient[place]
        assert along(place, 1) + along(place, -1) - 2 * along(place, 0) == hessian[place][place]
    # alpha enters to the fourth power, for which the five-point formula is exact.
    place = len(point) - 2
    five = -along(place, 2) + 8 * along(place, 1) - 8 * along(place, -1) + along(place, -2)
    assert five == 12 * gradient[place]


@pytest.mark.long
def test_bad_problems_are_refused(problem):
    with pytest.raises(ValueError, match="rows"):
        blend_problem(1, SURFACE, made_base(LEFT, 2, 0, 1, 1), made_base(LEFT, RIGHT.size, 0, 1, 1))
    with pytest.raises(ValueError, match=f"expected {len(problem.constraints)}"):
        lagrangian(problem, [1])
    with pytest.raises(ValueError, match=f"expected {len(problem.unknowns)}"):
        derivatives_at(problem.energy, [0])
    short = ExactSurface(Basis(3, (0, 0, 0, 0, 1, 1, 1, 1)), (LEFT,) * 4)
    with pytest.raises(ValueError, match="expected at least 6"):
        exact_minimum(blend_problem(2, short, *[made_base(LEFT, LEFT.size, x, 1, 1) for x in (0, -2)]), 1, 1)
