"""Means over the contact, and contacts that coincide: known lengths."""

import numpy as np
import pytest

from helpers.papers_set import state_problem
from semispline import Base, BSplineSurface
from semispline.solver.blending.facing import _largest_distance, measure_facing

LINE = [0.0, 0.0, 1.0, 1.0]


def strip(start, end, across):
    """A flat strip along a straight edge, leaving it by a vector."""
    edge = np.array([start, end], dtype=float)
    return BSplineSurface(1, 1, LINE, LINE, np.stack([edge, edge + np.array(across, dtype=float)]))


@pytest.mark.parametrize("slope", [5.0, 50.0])
def test_a_gap_that_opens_steeply_has_its_mean(slope):
    # Of sqrt(1 + (slope v)^2): no polynomial, and bent sharply at v = 0.
    a, b = strip([0, 0, 0], [0, 1, 0], [-2, 0, 0]), strip([1, 0, 0], [1, 1, slope], [3, 0, 0])
    problem = state_problem(Base(a, "u0"), Base(b, "u0"), flip="no").problem
    found = measure_facing(problem.a, problem.b)
    mean = (np.sqrt(1 + slope**2) + np.arcsinh(slope) / slope) / 2
    # Coordinates of size 1: speeds are 2 and 3.
    size = 2 / found.cross_speeds[0]
    assert found.gap * size == pytest.approx(mean, rel=1e-9)
    assert found.cross_speeds[1] * size == pytest.approx(3, rel=1e-12)
    assert np.array(found.lengths) * size == pytest.approx([1, np.sqrt(1 + slope**2)], rel=1e-12)
    assert problem.natural == pytest.approx((mean / 2, mean / 3), rel=1e-9)


def test_the_foot_of_a_point_is_found_on_a_curve_and_beyond_its_ends():
    a, b = strip([0, 0, 0], [0, 1, 0], [-2, 0, 0]), strip([1, 0, 0], [1, 1, 0], [3, 0, 0])
    side = state_problem(Base(a, "u0"), Base(b, "u0")).sides[0]
    samples = np.array([[0, y, 0] for y in np.linspace(0, 1, 9)])
    for points, distance in (
        ([[0, 0.3, 0]], 0.0),
        ([[0, 0.3, 0.01], [0, 0.77, 0]], 0.01),
        ([[0, 0.3, 0], [0, -0.1, 0]], 0.1),
        ([[0, 1.05, 0], [0, 0.5, 0]], 0.05),
        # So far that the nearest sample will do.
        ([[0, 0.3, 4]], np.hypot(4, 0.05)),
    ):
        assert _largest_distance(np.array(points, dtype=float), samples, side) == pytest.approx(distance, abs=1e-12)
