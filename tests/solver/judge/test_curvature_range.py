"""Least and largest principal curvature: known answers with their places."""

import numpy as np
import pytest

from helpers.shapes import arc, extruded, line, sheets, torus
from semispline import local_geometry_grid, measure_curvature_range, reverse_u, transform


def test_torus():
    R, r = 3.0, 1.0
    surface = torus(R, r)
    inwards = measure_curvature_range(surface)
    outwards = measure_curvature_range(reverse_u(surface))
    least, largest = sorted([inwards, outwards], key=lambda found: found.largest.value)
    # About the axis cos t / (R + r cos t): from -1/2 on the inner equator to 1/4; around the tube 1 everywhere.
    assert largest.largest.value == pytest.approx(1 / r, rel=1e-9)
    assert largest.least.value == pytest.approx(-1 / (R - r), rel=1e-9)
    assert np.hypot(*largest.least.point[:2]) == pytest.approx(R - r)
    assert least.largest.value == pytest.approx(1 / (R - r), rel=1e-9)
    assert least.least.value == pytest.approx(-1 / r, rel=1e-9)


@pytest.mark.parametrize("along", ["u", "v"])
def test_both_sides_of_a_knot_are_looked_at(along):
    # A narrow arc before a line and after one: the arc's curvature ends at knots, where evaluation tells what follows.
    profile = [*line((-2, 0), (0, 0)), *arc((0, 0.01), 0.01, -90, 0), *line((0.01, 0.01), (0.01, 2))]
    found = measure_curvature_range(extruded(profile, 1.0, along=along))
    values = sorted([abs(found.least.value), abs(found.largest.value)])
    assert values == pytest.approx([0, 100], rel=1e-6, abs=1e-6)


def test_a_peak_at_the_end_of_a_span():
    """y = x^2 / 2 up to x = 0, where its curvature is 1, a line, and an arc of 0.8: samples of a span miss the peak."""
    parabola = np.array([[-10, 50, 1.0], [-5, 0, 1], [0, 0, 1]])
    profile = [parabola, *line((0, 0), (5, 0)), *arc((5, 1.25), 1.25, -90, 0)]
    for along in ("u", "v"):
        found = measure_curvature_range(extruded(profile, 1.0, along=along))
        peak = max(found.least, found.largest, key=lambda at: abs(at.value))
        assert abs(peak.value) == pytest.approx(1, rel=1e-6)
        assert peak.point[:2] == pytest.approx([0, 0], abs=1e-6)


def test_nothing_on_a_fine_grid_is_beyond_it():
    for surface in sheets(3, 4):
        found = measure_curvature_range(surface)
        u, v = (np.linspace(*ends, 301) for ends in surface.domain)
        principal = local_geometry_grid(surface, u, v).principal
        size = np.abs(principal).max()
        assert found.least.value <= principal.min() + 1e-3 * size
        assert found.largest.value >= principal.max() - 1e-3 * size
        at = found.largest
        there = local_geometry_grid(surface, [at.u], [at.v])
        assert there.principal[0, 0, 0] == pytest.approx(at.value, rel=1e-12)
        assert there.point[0, 0] == pytest.approx(at.point, abs=1e-12)


def test_units():
    surface = sheets(3, 1)[0]
    found, small = (measure_curvature_range(s) for s in (surface, transform(surface, 1e-3 * np.eye(3))))
    assert small.largest.value == pytest.approx(1e3 * found.largest.value, rel=1e-6)
    assert small.least.value == pytest.approx(1e3 * found.least.value, rel=1e-6)
