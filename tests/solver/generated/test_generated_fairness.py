"""The generated fairness program: its gradient against the function that it claims to differentiate."""

import numpy as np
import pytest

from semispline.solver.generated.fairness_numpy import fairness, fairness_pullback

STEP = 1e-30


@pytest.fixture(scope="module")
def planes():
    return np.random.default_rng(0).normal(size=(27, 50))


@pytest.mark.parametrize("output", range(4))
@pytest.mark.parametrize("i", range(27))
def test_each_adjoint_is_the_complex_step(planes, output, i):
    # The complex step has no difference to cancel: both are exact up to rounding.
    seeds = np.zeros((4, 50))
    seeds[output] = 1.0
    values, pullback = fairness_pullback(planes)
    np.testing.assert_array_equal(values, fairness(planes))
    gradient = pullback(seeds)
    moved = planes.astype(complex)
    moved[i] += 1j * STEP
    slope = fairness(moved)[output].imag / STEP
    assert np.all(np.abs(gradient[i] - slope) <= 1e-10 * (1 + np.abs(slope)))


def test_a_torus_has_the_mean_curvature_known():
    big, small, u, v = 3.0, 1.0, np.array([0.3]), np.array([1.1])

    def point(du, dv):
        """Derivative of ((R + r cos v) cos u, (R + r cos v) sin u, r sin v)."""
        ring = (big if dv == 0 else 0.0) + small * np.cos(v + dv * np.pi / 2)
        turned = np.array([np.cos(u + du * np.pi / 2), np.sin(u + du * np.pi / 2)])
        height = small * np.sin(v + dv * np.pi / 2) if du == 0 else 0 * v
        return np.concatenate([ring * turned, height[None]])

    orders = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
    rough, area, mean, speed = fairness(np.concatenate([point(*order) for order in orders]))
    ring = big + small * np.cos(v)
    known = (big + 2 * small * np.cos(v)) / (2 * small * ring)
    # H depends on v alone, and |P_v| is r.
    slope = (-2 * small * np.sin(v) * ring + (big + 2 * small * np.cos(v)) * small * np.sin(v)) / (2 * small * ring**2)
    np.testing.assert_allclose(np.abs(mean), known, rtol=1e-13)
    np.testing.assert_allclose(area, small * ring, rtol=1e-13)
    np.testing.assert_allclose(speed, ring, rtol=1e-13)
    np.testing.assert_allclose(rough, (slope / small) ** 2 * small * ring, rtol=1e-12)
