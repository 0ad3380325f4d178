"""Arcs of several spans as the contact of a blend: their ends lie on end faces, or they stay circles."""

from dataclasses import replace

import numpy as np
import pytest

from semispline.solver.blending import EndFace, chain
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface


def arc_in_plane(start, end, count):
    """A band of the plane z = 0 along an arc of radius 9, inwards, of so many rational quadratic spans."""
    half = (end - start) / (2 * count)
    angles, even = start + half * np.arange(2 * count + 1), np.arange(2 * count + 1) % 2 == 0
    weights = np.where(even, 1.0, np.cos(half))
    points = np.stack([np.cos(angles) / weights, np.sin(angles) / weights, 0 * angles], axis=1)
    knots = np.concatenate([[0.0], np.repeat(np.linspace(0, 1, count + 1), 2), [1.0]])
    net = np.stack([9 * points, 8 * points])
    return Base(BSplineSurface(1, 2, [0, 0, 1, 1], knots, net, np.stack([weights, weights])), "u0")


@pytest.mark.parametrize(("count", "order"), [(1, 2), (2, 2), (3, 2), (3, 3)])
def test_lines_across_the_ends_of_an_arc_lie_in_the_planes_there(count, order):
    half = np.arccos(4 / 9) if count > 1 else 2.2
    base = arc_in_plane(half, 2 * np.pi - half, count)
    x = 9 * np.cos(half)
    ends = (EndFace.plane(np.array([1.0, 0.0, 0.0])), EndFace.plane(np.array([1.0, 0.0, 0.0])))
    rows = replace(chain([base]), ends_on=ends).strip(order).surface.control_points
    # Rounding of points of size 9, in some hundred operations.
    assert np.abs(rows[:, [0, -1], 0] - x).max() <= 1e-11


def test_an_arc_that_ends_squarely_stays_a_circle():
    base = arc_in_plane(0.0, np.pi, 3)
    square = EndFace.plane(np.array([0.0, 1.0, 0.0]))
    plain, held = chain([base]).strip(2), replace(chain([base]), ends_on=(square, square)).strip(2)
    assert held.surface.degree_v == plain.surface.degree_v
    assert np.abs(held.surface.control_points - plain.surface.control_points).max() <= 1e-12
