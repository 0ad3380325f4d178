"""Waist of surfaces between closed rims: turned profiles, twisted rulings, and open ones."""

import numpy as np
import pytest

from helpers.shapes import arc, line, revolved, sheets
from semispline import BSplineSurface, map_domain, measure_waist


def test_a_waist_of_known_radius():
    # The arc comes as close as 1 to the axis, at z = 0, and its ends are 3 - sqrt(2) away.
    waist = measure_waist(revolved(arc((3, 0), 2.0, 225, 135)))
    assert waist.distance == pytest.approx(2.0, rel=1e-9)
    assert waist.points[0][2] == pytest.approx(0, abs=1e-4)
    assert np.linalg.norm(np.subtract(*waist.points)) == pytest.approx(waist.distance, rel=1e-12)
    assert waist.of_rulings == pytest.approx(2 * (3 - np.sqrt(2)), rel=1e-9)
    assert waist.of_rims == pytest.approx(waist.of_rulings)


def test_a_cone_is_as_narrow_as_its_rim():
    waist = measure_waist(revolved(line((1, 0), (4, 2))))
    assert [waist.distance, waist.of_rulings, waist.of_rims] == pytest.approx([2, 2, 2], rel=1e-9)
    assert waist.u == 0


def test_twisted_rulings_pinch_by_themselves():
    """Straight lines between circles turned by 90 degrees against each other: half as far as cos 45 degrees."""
    cylinder = revolved(line((1, 0), (1, 2)))
    net, weights = cylinder.control_points, cylinder.weights
    # One quarter is two control points of the closed circle.
    turned = [np.concatenate([x[-1, 2:-1], x[-1, :3]]) for x in (net, weights)]
    ruled = BSplineSurface(1, 2, [0, 0, 1, 1], cylinder.knots_v, [net[0], turned[0]], [weights[0], turned[1]])
    waist = measure_waist(ruled)
    assert waist.distance == pytest.approx(2 * np.cos(np.pi / 4), rel=1e-9)
    assert waist.of_rulings == pytest.approx(waist.distance, rel=1e-9)
    assert waist.u == pytest.approx(0.5, abs=1e-3)
    assert waist.of_rims == pytest.approx(2)


def test_domains_do_not_matter():
    surface = revolved(arc((3, 0), 2.0, 225, 135))
    moved = map_domain(surface, (-3.0, 5.0), (100.0, 101.0))
    assert measure_waist(moved).distance == pytest.approx(measure_waist(surface).distance, rel=1e-9)
    assert 100 <= measure_waist(moved).v <= 100.5


def test_open_surfaces_have_none():
    assert measure_waist(sheets(1, 1)[0]) is None
    assert measure_waist(revolved(line((1, 0), (4, 2)), 0, 359)) is None
