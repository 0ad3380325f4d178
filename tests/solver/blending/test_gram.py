"""Gram matrices and energy against quadrature that knows nothing of them."""

from fractions import Fraction
from itertools import pairwise
from math import comb

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import BSpline

from helpers.bases import facing_pair, random_knots
from helpers.papers_set import blend
from semispline import BSplineCurve, BSplineSurface, SemiStructuredSurface, thin_plate_energy
from semispline.solver.blending.gram import EnergyForm, gram_matrix
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.quadrature import Basis, gauss_rule


def basis_function(basis, i):
    return BSpline(basis.knots, np.eye(basis.size)[i], basis.degree)


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("degrees", [(3, 3), (2, 4), (1, 3)])
def test_entries_agree_with_adaptive_quadrature(order, degrees):
    rng = np.random.default_rng(5)
    a, b = (Basis(d, random_knots(rng, d, d + n, 0.0, 2.0)) for d, n in zip(degrees, (3, 5), strict=True))
    found = gram_matrix(a, b, order).toarray()
    breaks = np.unique(np.concatenate([a.knots, b.knots]))

    functions = [[basis_function(basis, i) for i in range(basis.size)] for basis in (a, b)]

    def integrand(x, i, j):
        if order > min(degrees):
            return 0.0
        return float(functions[0][i](x, order) * functions[1][j](x, order))

    for i in range(a.size):
        for j in range(b.size):
            # Adaptive Gauss-Kronrod on each polynomial piece.
            expected = sum(quad(integrand, lo, hi, args=(i, j), epsabs=1e-13)[0] for lo, hi in pairwise(breaks))
            assert found[i, j] == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.abs(found).max())


def test_known_bernstein_gram():
    # int B_i^3 B_j^3 = C(3,i) C(3,j) / (C(6,i+j) 7).
    bezier = Basis(3, np.repeat([0.0, 1.0], 4))
    binomial = {3: [1, 3, 3, 1], 6: [1, 6, 15, 20, 15, 6, 1]}
    exact = [
        [float(Fraction(binomial[3][i] * binomial[3][j], binomial[6][i + j] * 7)) for j in range(4)] for i in range(4)
    ]
    np.testing.assert_allclose(gram_matrix(bezier, bezier).toarray(), exact, rtol=1e-14)


@pytest.mark.parametrize("swapped", [False, True])
def test_known_bernstein_gram_of_unlike_degrees(swapped):
    # int B_i^1 B_j^5 = C(5,j) / (C(6,i+j) 7).
    pair = Basis(1, np.repeat([0.0, 1.0], 2)), Basis(5, np.repeat([0.0, 1.0], 6))
    exact = np.array([[comb(5, j) / (comb(6, i + j) * 7) for j in range(6)] for i in range(2)])
    found = gram_matrix(*(pair[::-1] if swapped else pair)).toarray()
    np.testing.assert_allclose(found.T if swapped else found, exact, rtol=1e-13)


def test_knots_that_differ_by_rounding_count_as_one():
    inner = np.array([0.3, 0.7])
    exact = Basis(3, np.concatenate([np.zeros(4), inner, np.ones(4)]))
    blurred = Basis(3, np.concatenate([np.zeros(4), inner + np.array([3e-14, -2e-14]), np.ones(4)]))
    np.testing.assert_allclose(
        gram_matrix(exact, blurred, 2).toarray(), gram_matrix(exact, exact, 2).toarray(), rtol=0, atol=1e-9
    )
    assert len(gauss_rule(np.array([0.0, 1.0]), 3)[0]) == 2


def test_size_is_linear_in_the_number_of_knots():
    sizes = []
    for n in (1000, 2000):
        basis = Basis(3, np.concatenate([np.zeros(3), np.arange(n + 1.0), np.full(3, float(n))]))
        other = Basis(3, np.concatenate([np.zeros(3), np.linspace(0, n, n // 2 + 1), np.full(3, float(n))]))
        sizes.append(gram_matrix(basis, other, 1).nnz)
    assert sizes[1] < 2.05 * sizes[0]


def referee_energy(surface, per_span=6):
    """The integrand of (11) at Gauss points of a finer rule, by the referee."""
    x, w = np.polynomial.legendre.leggauss(per_span)
    rules = []
    for breaks in surface.breakpoints:
        half = np.diff(breaks)[:, None] / 2
        rules.append((((breaks[:-1, None] + breaks[1:, None]) / 2 + half * x).ravel(), (half * w).ravel()))
    (u, w_u), (v, w_v) = rules
    uu, vv = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    second = [surface_points(surface, uu, vv, du, 2 - du) for du in (2, 1, 0)]
    density = sum(f * np.sum(s**2, axis=1) for f, s in zip((1, 2, 1), second, strict=True))
    return float(np.outer(w_u, w_v).ravel() @ density)


@given(st.integers(0, 10**6))
def test_energy_agrees_with_the_referee_and_with_the_gram_form(seed):
    rng = np.random.default_rng(seed)
    degrees = rng.integers(1, 5, 4)
    rows = [Basis(int(q), random_knots(rng, int(q), int(q) + int(rng.integers(1, 6)))) for q in degrees]
    points = [rng.uniform(-1, 1, (row.size, 3)) for row in rows]
    u = Basis(2, random_knots(rng, 2, 4))
    curves = [BSplineCurve(row.degree, row.knots, p) for row, p in zip(rows, points, strict=True)]
    surface = SemiStructuredSurface(u.degree, u.knots, curves)
    energy = thin_plate_energy(surface)
    p = np.concatenate(points)
    # Sums of squares of random numbers: no cancellation, so only the rounding of some 1e3 operations.
    assert energy == pytest.approx(referee_energy(surface), rel=1e-11)
    assert energy == pytest.approx(float(np.sum(p * (EnergyForm(u, tuple(rows)).matrix() @ p))), rel=1e-10)


@given(st.integers(0, 10**6))
def test_gradient_agrees_with_the_matrix(seed):
    rng = np.random.default_rng(seed)
    rows = tuple(
        Basis(int(q), random_knots(rng, int(q), int(q) + int(rng.integers(1, 6)))) for q in rng.integers(1, 5, 5)
    )
    form = EnergyForm(Basis(3, random_knots(rng, 3, 5)), rows)
    points = rng.uniform(-1, 1, (form.offsets[-1], 4))
    expected = form.matrix() @ points
    np.testing.assert_allclose(form.gradient(points), expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_energy_of_a_known_surface():
    # X = (u, v, u^2 + 3 u v + v^2): the density is 2^2 + 2 3^2 + 2^2 = 26, over [0, 1] x [0, 1].
    net = [[[i / 2, j / 2, (i == 2) + 3 * i * j / 4 + (j == 2)] for j in range(3)] for i in range(3)]
    surface = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1], net)
    assert thin_plate_energy(surface) == pytest.approx(26, rel=1e-14)


def test_energy_of_a_blend_agrees_with_the_referee():
    result = blend(*facing_pair(np.random.default_rng(3)), continuity="C2")
    assert result.energy == pytest.approx(referee_energy(result.surface), rel=1e-12)
