"""Fair blends whose right shape is known."""

import numpy as np
import pytest
from scipy.special import ellipe

from helpers.impeller import impeller_pair
from helpers.sheets import FAIR, case, sheets
from semispline import (
    Base,
    BSplineCurve,
    BSplineSurface,
    blend,
    measure_turn,
    revolve_polynomial,
    transform,
)


def test_a_pipe_and_its_cap_are_not_pinched():
    result = blend(case("pipe_poly", "v1"), case("dome_poly", "v0"), **FAIR)
    points = result.surface.evaluate_grid(np.linspace(0, 1, 41), np.linspace(*result.surface.domain[1], 61))
    radius = np.linalg.norm(points[..., :2], axis=-1)
    assert radius.min() > 4.6
    assert radius.max() < 5.001
    assert not result.warnings


def test_bells_bulge_and_are_symmetric():
    low, high = case("bell_low", "u1"), case("bell_high", "u0")
    result = blend(low, high, **FAIR)
    u, v = np.linspace(0, 1, 41), np.linspace(*result.surface.domain[1], 61)
    points = result.surface.evaluate_grid(u, v)
    radius = np.linalg.norm(points[..., :2], axis=-1)
    rims = np.linalg.norm(points[[0, -1], :, :2], axis=-1)
    assert radius.min() >= rims.min() - 1e-9
    assert radius.max() > 2.3
    # As near as a slope of 1e-4 tells, where the search ends.
    np.testing.assert_allclose(radius, radius[::-1], atol=1e-5)
    assert result.alpha2 == pytest.approx(result.beta2, rel=1e-4)
    assert not result.active_bounds


def pipe():
    """A pipe of radius 5 and length 3 along z, and its ends at z = 0 and z = 3."""
    line = BSplineCurve(3, [0] * 4 + [1] * 4, [[5, 0, z] for z in (0, 1, 2, 3)])
    surface = revolve_polynomial(line, [0, 0, 0], [0, 0, 1], 360, 1e-6).surface
    ends = [Base(surface, edge).derivative(np.array([0.1, 0.6]), 0, 0)[:, 2] for edge in ("u0", "u1", "v0", "v1")]
    first, last = (
        edge for z in (0, 3) for edge, end in zip(("u0", "u1", "v0", "v1"), ends, strict=True) if np.allclose(end, z)
    )
    return surface, first, last


def test_two_pipes_of_one_radius_are_joined_by_that_pipe():
    surface, first, last = pipe()
    far = transform(surface, np.eye(3), [0, 0, 13])
    surface = blend(Base(surface, last), Base(far, first), **FAIR).surface
    points = surface.evaluate_grid(np.linspace(0, 1, 31), np.linspace(*surface.domain[1], 41))
    np.testing.assert_allclose(np.linalg.norm(points[..., :2], axis=-1), 5.0, rtol=0.01)


@pytest.mark.long
@pytest.mark.parametrize("continuity", ["G2", "G4"])
def test_an_elbow_of_two_pipes_keeps_four_fifths_of_its_radius(continuity):
    surface, first, last = pipe()
    # A quarter about an axis along y, 15 beside the first one's.
    turn, centre = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]), np.array([15, 0, 0])
    far = transform(transform(surface, turn), np.eye(3), centre - turn @ centre)
    far = Base(far, first)
    result = blend(Base(transform(surface, np.eye(3), [0, 0, -3]), last), far, continuity=continuity)
    points = result.surface.evaluate_grid(np.linspace(0, 1, 41), np.linspace(*result.surface.domain[1], 121)[:-1])
    radius = np.linalg.norm(points - points.mean(axis=1, keepdims=True), axis=-1)
    assert radius.mean(axis=1).min() > 4.0
    assert radius.max() < 5.001
    # Under one alpha all around, the section half way is the mean of both rims: an ellipse, 5 by 5 cos 45 degrees.
    assert radius.mean(axis=1).min() == pytest.approx(5 * 2 / np.pi * ellipe(1 / 2), rel=1e-3)
    assert not result.warnings


def test_what_is_flat_takes_the_arc():
    knots = [0, 0, 1, 1]
    left = BSplineSurface(1, 1, knots, knots, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    right = BSplineSurface(1, 1, knots, knots, [[[3, 0, 0], [3, 1, 0]], [[5, 0, 0], [5, 1, 0]]])
    result = blend(Base(left, "u1"), Base(right, "u0"), **FAIR)
    # Gap 2 over speeds 1 and 2, and the arc of a straight way is its chord.
    assert (result.alpha2, result.beta2) == pytest.approx((2.0, 1.0), rel=1e-4)
    assert result.objective.value == pytest.approx(0.0, abs=1e-9)


def test_the_real_pair_turns_evenly():
    result = blend(*impeller_pair(), **FAIR)
    assert measure_turn(result.surface).degrees < 15
    assert not result.warnings


def same_points(one, two, u, v, **tolerance):
    np.testing.assert_allclose(one.evaluate_grid(u, v), two, **tolerance)


@pytest.mark.long
def test_units_place_order_and_parameters_do_not_matter():
    a, b = sheets()
    first = blend(a, b, **FAIR)
    u, v = np.linspace(0, 1, 9), np.linspace(0, 1, 7)
    points = first.surface.evaluate_grid(u, v)
    again = blend(a, b, **FAIR)
    np.testing.assert_array_equal(again.surface.evaluate_grid(u, v), points)
    scaled = [Base(transform(base.surface, 1e3 * np.eye(3)), base.edge) for base in (a, b)]
    same_points(blend(*scaled, **FAIR).surface, 1e3 * points, u, v, rtol=0, atol=1e-5 * 1e3)
    moved = [Base(transform(base.surface, np.eye(3), [1e3, 0, 0]), base.edge) for base in (a, b)]
    same_points(blend(*moved, **FAIR).surface, points + np.array([1e3, 0, 0]), u, v, rtol=0, atol=1e-5)
    swapped = blend(b, a, **FAIR)
    assert not swapped.flipped
    same_points(swapped.surface, points[::-1], u, v, rtol=0, atol=1e-5)
