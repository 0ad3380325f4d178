"""Moving a seam: the same points at the same parameters, round again, and back to the same net."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.closed import circle, cylinder, sphere, torus
from semispline import (
    BSplineCurve,
    BSplineSurface,
    SemiStructuredSurface,
    move_curve_seam,
    move_seam,
    plane,
    revolve_smooth,
    swap_directions,
)
from semispline.solver.errors import InputError, KnotError, OptionError
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.refinement import clamp_knots, linear_product_matrices

# Some thousand roundings of coordinates of a few units: knots come and go by matrices whose products every kernel sums
# in an order of its own. A seam in the wrong place is off by 1e-2 and more.
ROUNDING = 1e-12


def around(t, start, end):
    """Parameters brought back into [start, end)."""
    return start + (np.asarray(t) - start) % (end - start)


def periodic(seed, degree=3, n=7):
    """A closed curve, as smooth at its seam as inside, from a periodic spline."""
    rng = np.random.default_rng(seed)
    steps = rng.uniform(0.2, 1, n)
    knots = np.concatenate([[0], np.cumsum(np.tile(steps, 3))])[n - degree : 2 * n + degree + 1]
    points = rng.uniform(-1, 1, (n, 3))
    knots, points = clamp_knots(degree, knots, np.concatenate([points, points[:degree]]))
    points[-1] = points[0]
    return BSplineCurve(degree, knots, points)


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.floats(0.01, 0.99))
def test_a_periodic_curve_keeps_its_points_and_needs_no_more_of_them(seed, degree, where):
    curve = periodic(seed, degree)
    start, end = curve.knots[[0, -1]]
    at = start + where * (end - start)
    moved = move_curve_seam(curve, at)
    assert moved.knots[[0, -1]].tolist() == [at, at + (end - start)]
    t = np.linspace(at, at + (end - start), 201)[:-1]
    assert np.abs(moved.evaluate(t) - curve.evaluate(around(t, start, end))).max() <= 1e-11
    assert np.array_equal(moved.control_points[0], moved.control_points[-1])
    # The old seam is a knot as any other, of multiplicity one.
    assert np.count_nonzero(moved.knots == end) == 1
    inner = np.unique(curve.knots)[1:-1]
    if not np.isclose(inner, at).any():
        assert len(moved.control_points) == len(curve.control_points) + 1
    back = move_curve_seam(moved, end)
    assert np.abs(back.knots - curve.knots - (end - start)).max() <= 1e-12
    # As long as the spans are no narrower than this by far.
    if np.abs(inner - at).min() > 0.01 and min(where, 1 - where) > 0.02:
        assert np.abs(back.control_points - curve.control_points).max() <= 1e-9


def test_the_seam_of_the_smooth_circle_comes_and_goes():
    """17 points with the old seam as a crease, 15 without, 11 where the new seam falls on the old knot."""
    surface = revolve_smooth(BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [2, 0, 5]]), [0, 0, 0], [0, 0, 1])
    moved = move_seam(surface, u=0.3)
    assert moved.control_points.shape == (15, 2, 3)
    t = np.linspace(0.3, 1.3, 101)[:-1]
    assert np.abs(surface_points(moved, t, 0.5) - surface_points(surface, around(t, 0, 1), 0.5)).max() <= ROUNDING
    back = move_seam(moved, u=1.0)
    assert np.abs(back.homogeneous - surface.homogeneous).max() <= ROUNDING
    half = move_seam(surface, u=0.5)
    assert half.control_points.shape == (11, 2, 3)


@pytest.mark.parametrize(("u", "v"), [(0.1, None), (None, 0.6), (0.25, 0.6)])
def test_a_torus_moves_in_either_direction(u, v):
    surface = torus(3.0, 1.0)
    moved = move_seam(surface, u, v)
    (u0, u1), (v0, v1) = moved.domain
    assert (u0, v0) == (u or 0, v or 0)
    assert max(abs(u1 - u0 - 1), abs(v1 - v0 - 1)) <= ROUNDING
    a, b = np.random.default_rng(0).uniform(0, 1, (2, 50))
    there = surface_points(moved, u0 + a, v0 + b)
    assert np.abs(there - surface_points(surface, around(u0 + a, 0, 1), around(v0 + b, 0, 1))).max() <= ROUNDING


def test_ends_that_differ_by_a_factor_are_scaled():
    """A circle times a linear weight from 1 to 3: another net, of degree 3, of the same points."""
    curve = circle(2.0)
    falling, rising, knots = linear_product_matrices(2, curve.knots)
    net = falling @ curve.homogeneous + 3 * (rising @ curve.homogeneous)
    other = BSplineCurve(3, knots, net[:, :3] / net[:, 3:], net[:, 3])
    assert other.weights[-1] / other.weights[0] == 3
    moved = move_curve_seam(other, 0.4)
    t = np.linspace(0.4, 1.4, 101)[:-1]
    assert np.abs(moved.evaluate(t) - curve.evaluate(around(t, 0, 1))).max() <= ROUNDING
    assert abs(moved.weights[-1] / moved.weights[0] - 3) <= ROUNDING
    rows = np.stack([other.control_points, other.control_points + np.array([0, 0, 1])])
    sheet = BSplineSurface(1, 3, [0, 0, 1, 1], knots, rows, np.stack([other.weights, 2 * other.weights]))
    # The factor is one for all rows, though the rows have other weights.
    assert np.abs(move_seam(sheet, v=0.4).homogeneous[0] - moved.homogeneous).max() <= ROUNDING


def test_rows_of_their_own_move_together():
    rows = [periodic(0), periodic(1, 2), circle(1.0)]
    rows = [BSplineCurve(c.degree, (c.knots - c.knots[0]) / np.ptp(c.knots), c.control_points, c.weights) for c in rows]
    surface = SemiStructuredSurface(2, [0, 0, 0, 1, 1, 1], rows)
    moved = move_seam(surface, v=0.35)
    u, v = np.random.default_rng(0).uniform(0, 1, (2, 60))
    assert np.abs(moved.evaluate(u, 0.35 + v) - surface.evaluate(u, around(0.35 + v, 0, 1))).max() <= ROUNDING
    # A row without that knot gets two ends there and loses the old ones.
    assert len(moved.control_curves[0].control_points) == len(rows[0].control_points) + 1
    assert move_seam(surface) is surface


def test_u_and_v_are_alike():
    surface = torus(3.0, 1.0)
    one, other = move_seam(surface, u=0.3), swap_directions(move_seam(swap_directions(surface), v=0.3))
    assert np.array_equal(one.control_points, other.control_points)


def test_a_gap_is_closed_only_where_that_is_allowed():
    curve = periodic(3)
    points = curve.control_points.copy()
    points[-1] += [0, 0, 1e-7]
    open_curve = BSplineCurve(3, curve.knots, points)
    middle = float(np.mean(curve.knots[[0, -1]]))
    with pytest.raises(InputError, match="curve: its ends are 1e-07 apart, expected a closed one"):
        move_curve_seam(open_curve, middle)
    moved = move_curve_seam(open_curve, middle, tolerance=1e-6)
    assert np.abs(moved.evaluate(curve.knots[[-1]]) - points[-1]).max() <= 2e-7


def _weights_that_do_not_close():
    surface = cylinder(1.0, 1.0)
    weights = surface.weights.copy()
    weights[-1, 0] = 2
    return BSplineSurface(2, 1, surface.knots_u, surface.knots_v, surface.control_points, weights)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: move_curve_seam(circle(), 0.0), KnotError, r"v: found 0.0, expected a value inside \(0.0, 1.0\)"),
        (lambda: move_curve_seam(circle(), 1.5), KnotError, "v: found 1.5"),
        (lambda: move_curve_seam(circle(), 0.5, -1), OptionError, "tolerance: found -1"),
        (lambda: move_seam(sphere(1), v=0.5), InputError, "surface in v: its ends are 2 apart"),
        (lambda: move_seam(plane([0, 0], [1, 0], [0, 1]), u=0.5), InputError, "surface in u: its ends are 1 apart"),
        (lambda: move_seam(_weights_that_do_not_close(), u=0.5), InputError, "are 1 to 2 times those at its start"),
        (lambda: move_seam(torus(3, 1).to_semistructured(), u=0.5), InputError, "u: .*convert it first"),
        (lambda: move_seam(circle(), v=0.5), InputError, "surface: found a BSplineCurve"),
    ],
)
def test_what_has_no_seam_there_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()
