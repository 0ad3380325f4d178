"""Products of splines against exact values, their smoothness and signs; the smooth arcs of a circle."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.splines import DOMAINS, knot_vectors
from semispline.derivations.circles import circle_points
from semispline.solver.errors import KnotError
from semispline.solver.splines import Basis, basis_matrix, clamped
from semispline.solver.splines.products import multiply, product_basis, smooth_arc


def exact_value(basis, points, x):
    """de Boor's algorithm in fractions, at a parameter inside a span."""
    p, knots = basis.degree, [Fraction(t) for t in basis.knots.tolist()]
    k = max(i for i in range(p, len(knots) - p - 1) if knots[i] <= x and knots[i] < knots[i + 1])
    level = [Fraction(c) for c in points[k - p : k + 1].tolist()]
    for r in range(1, p + 1):
        for i in range(p, r - 1, -1):
            left, right = knots[k - p + i], knots[k + 1 + i - r]
            a = (x - left) / (right - left)
            level[i] = (1 - a) * level[i - 1] + a * level[i]
    return level[p]


@st.composite
def pairs(draw):
    domain = draw(st.sampled_from(DOMAINS))
    degrees = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    first, second = (Basis(p, draw(knot_vectors(p, domain))) for p in degrees)
    if draw(st.booleans()):
        # Some knots in common.
        inner = draw(knot_vectors(1, domain))[2:-2]
        first, second = (Basis(p, clamped(np.unique(inner), p, *domain)) for p in degrees)
    return first, second, np.random.default_rng(draw(st.integers(0, 2**32 - 1)))


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(pairs())
def test_the_product_is_the_product(drawn):
    a, b, rng = drawn
    f, g = rng.uniform(-1, 1, a.size), rng.uniform(-1, 1, b.size)
    basis, h = multiply(a, f, b, g)
    breaks = np.unique(basis.knots)
    for left, right in zip(breaks[:-1].tolist(), breaks[1:].tolist(), strict=True):
        for part in (3, 8):
            x = Fraction(left) + (Fraction(right) - Fraction(left)) * Fraction(part, 11)
            error = exact_value(basis, h, x) - exact_value(a, f, x) * exact_value(b, g, x)
            # Every step is a convex combination: no more than a few roundings, whatever the knots are.
            assert abs(error) < 1e-14


@settings(max_examples=40, deadline=None)
@given(pairs())
def test_positive_factors_have_positive_products(drawn):
    a, b, rng = drawn
    f, g = np.exp(rng.uniform(-20, 20, a.size)), np.exp(rng.uniform(-20, 20, b.size))
    basis, h = multiply(a, f, b, g)
    assert len(h) == basis.size
    assert (h > 0).all()
    assert np.allclose(multiply(b, g, a, f)[1], h, rtol=1e-13, atol=0)


def test_knots_of_a_product_are_as_smooth_as_the_rougher_factor():
    a = Basis(3, clamped([0.25, 0.5, 0.5], 3, 0, 1))
    b = Basis(2, clamped([0.5, 0.75], 2, 0, 1))
    basis = product_basis(a, b)
    assert basis.degree == 5
    inner, counts = np.unique(basis.knots, return_counts=True)
    # C2 from a, C1 from both, C1 from b.
    assert dict(zip(inner.tolist(), (5 - counts).tolist(), strict=True)) == {0: -1, 0.25: 2, 0.5: 1, 0.75: 1, 1: -1}
    with pytest.raises(KnotError, match="domains"):
        multiply(a, np.ones(a.size), Basis(1, np.array([0, 0, 2.0, 2])), np.ones(2))


def test_values_along_other_axes_and_high_degrees():
    rng = np.random.default_rng(1)
    a = Basis(5, clamped([0.3, 0.6], 5, 0, 1))
    f, x = rng.uniform(0.5, 1.5, a.size), rng.uniform(-1, 1, (a.size, 2, 3))
    basis, points = a, x
    for _ in range(4):
        basis, points = multiply(basis, points, a, f[:, None, None])
    assert basis.degree == 25
    places = np.linspace(0, 1, 41)
    low, high = basis_matrix(5, a.knots, places), basis_matrix(25, basis.knots, places)
    expected = (low @ f)[:, None] ** 4 * (low @ x.reshape(a.size, -1))
    assert high @ points.reshape(basis.size, -1) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_arcs_of_half_turns_are_the_derived_ones(order, count):
    basis, points = smooth_arc(np.pi * count, order, count)
    exact = np.array(circle_points(order + 1, count), dtype=float)
    assert points == pytest.approx(exact, rel=0, abs=2e-15)
    assert np.array_equal(
        basis.knots[basis.degree + 1 : -basis.degree - 1], np.repeat(np.arange(1, count) / count, order + 2)
    )


# Weights and the deviation of the angle from the parameter, measured by a prototype before this code was written.
MEASURED = [
    (2 * np.pi, 1, 2, 0.75, 5.1),
    (2 * np.pi, 2, 2, 0.86, 1.2),
    (2 * np.pi, 2, 3, 0.98, 0.13),
    (2 * np.pi, 2, 4, 0.99, 0.03),
    (2 * np.pi, 3, 2, 0.97, 0.5),
    (np.pi, 2, 1, 0.90, None),
    (1.5 * np.pi, 2, 2, 0.96, None),
    (1.5 * np.pi, 2, 1, 0.18, None),
]


@pytest.mark.parametrize(("turn", "order", "segments", "ratio", "degrees"), MEASURED)
def test_evenness_of_arcs(turn, order, segments, ratio, degrees):
    basis, points = smooth_arc(turn, order, segments)
    assert points[:, 2].min() / points[:, 2].max() == pytest.approx(ratio, abs=0.006)
    s = np.linspace(0, 1, 2001)
    x, y, w = (basis_matrix(basis.degree, basis.knots, s) @ points).T
    assert np.abs(np.hypot(x, y) / w - 1).max() < 1e-14
    angle = np.unwrap(np.arctan2(y, x))
    assert angle[-1] == pytest.approx(turn, abs=1e-13)
    if degrees is not None:
        assert np.degrees(np.abs(angle - turn * s).max()) == pytest.approx(degrees, rel=0.1)
