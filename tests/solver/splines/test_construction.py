"""Construction helpers: what they make is what was asked for, and the stated errors hold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from semispline.solver.errors import ControlPointError, InputError, OptionError
from semispline.solver.judge.curvature import gaussian_curvature, mean_curvature
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.construction import (
    extrude,
    interpolate_curve,
    interpolate_grid,
    plane,
    ruled,
    skin,
)
from semispline.solver.splines.operations import clamped_surface
from semispline.solver.splines.revolution import revolve, revolve_polynomial, revolve_smooth
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface

UNIT = [0, 0, 1, 1]
ARC = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[3, 0, 0], [4, 0, 1], [3, 0, 2]])
LINE = BSplineCurve(1, UNIT, [[2, 0, 0], [2, 0, 5]])
GRID = np.linspace(0, 1, 23)


def on_curve(curve, v):
    return curve_points(curve.degree, curve.knots, curve.control_points, v)


def test_a_plane_is_affine_in_its_parameters():
    surface = plane([1, 2, 3], [2, 0, 0], [0, 1, 1], degree_u=3, degree_v=2)
    assert (surface.degree_u, surface.degree_v, surface.control_points.shape) == (3, 2, (4, 3, 3))
    u, v = np.random.default_rng(0).uniform(0, 1, (2, 20))
    expected = np.array([1, 2, 3]) + u[:, None] * [2, 0, 0] + v[:, None] * [0, 1, 1]
    assert np.abs(surface_points(surface, u, v) - expected).max() <= 1e-15 * 8


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_interpolation_goes_through_every_point(degree_u, degree_v, seed):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(degree_u + 3.0), np.arange(degree_v + 2.0), indexing="ij")
    points = np.dstack([x, y, rng.uniform(-1, 1, x.shape)])
    u, v = (np.sort(rng.uniform(0.2, 0.8, n)) + np.arange(n) for n in x.shape)
    surface = interpolate_grid(points, degree_u, degree_v, u, v)
    assert (surface.degree_u, surface.degree_v, surface.control_points.shape) == (degree_u, degree_v, points.shape)
    found = surface_points(surface, np.repeat(u, len(v)), np.tile(v, len(u))).reshape(points.shape)
    # Collocation of up to degree 5 on uneven parameters: condition numbers of some thousands.
    assert np.abs(found - points).max() <= 1e-10


def test_interpolation_by_chord_length_follows_the_spacing():
    x = np.array([0.0, 1.0, 4.0, 5.0])
    points = np.dstack(np.broadcast_arrays(x[:, None], np.arange(4.0)[None, :], 0.0))
    surface = interpolate_grid(points)
    assert surface.domain == ((0.0, 1.0), (0.0, 1.0))
    # Straight and evenly run through: chord length makes the parameters proportional to the way.
    assert np.abs(surface_points(surface, [0.2, 0.8, 0.5], [0, 0, 0])[:, 0] - [1, 4, 2.5]).max() <= 1e-14


def test_a_curve_through_points():
    t = np.linspace(0, np.pi, 9)
    points = np.column_stack([np.cos(t), np.sin(t), t])
    curve = interpolate_curve(points, 5, parameters=t)
    assert np.abs(on_curve(curve, t) - points).max() <= 1e-13
    x = np.linspace(0, np.pi, 100)
    # Quintic over steps of 0.4: h^6 / 6! is some 5e-6.
    assert np.abs(on_curve(curve, x) - np.column_stack([np.cos(x), np.sin(x), x])).max() <= 1e-4


def test_ruled_surfaces_join_curves_of_different_knots_and_degrees_by_lines():
    other = BSplineCurve(1, [0, 0, 0.4, 1, 1], [[0, 5, 0], [1, 5, 3], [2, 5, 0]])
    surface = ruled(ARC, other)
    assert (surface.degree_u, surface.degree_v) == (1, 2)
    for u in (0.0, 0.25, 1.0):
        expected = (1 - u) * on_curve(ARC, GRID) + u * on_curve(other, GRID)
        assert np.abs(surface_points(surface, [u], GRID) - expected).max() <= 1e-14


def test_extrusion_shifts_the_curve():
    surface = extrude(ARC, [0, 2, 0], degree_u=3)
    assert surface.degree_u == 3
    expected = on_curve(ARC, GRID) + np.array([0, 1.5, 0])
    assert np.abs(surface_points(surface, [0.75], GRID) - expected).max() <= 1e-14


def test_skinning_keeps_each_curve():
    other = BSplineCurve(1, [0, 0, 0.4, 1, 1], [[0, 5, 0], [1, 5, 3], [2, 5, 0]])
    surface = skin([ARC, other, ARC, other, ARC], 2)
    assert surface.control_curves == (ARC, other, ARC, other, ARC)
    assert surface.knots_u.tolist() == pytest.approx([0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1])
    assert skin([ARC, other], 1, [2, 2, 5, 5]).domain[0] == (2, 5)


@pytest.mark.parametrize("make", [revolve, revolve_smooth])
@pytest.mark.parametrize("angle", [37.0, 90.0, 200.0, 360.0])
def test_revolution_is_exact(angle, make):
    axis_point, axis = np.array([1.0, 0, 5]), np.array([0, 0, 2.0])
    surface = make(ARC, axis_point, axis, angle)
    rng = np.random.default_rng(1)
    u, v = rng.uniform(0, 1, (2, 60))
    p, profile = surface_points(surface, u, v), on_curve(ARC, v)
    radius = np.hypot(p[:, 0] - 1, p[:, 1])
    assert np.abs(radius - (profile[:, 0] - 1)).max() <= 1e-14 * 4
    assert np.abs(p[:, 2] - profile[:, 2]).max() <= 1e-14 * 4
    turn = np.degrees(np.arctan2(p[:, 1], p[:, 0] - 1)) % 360
    assert ((turn >= -1e-9) & (turn <= angle + 1e-9)).all()
    last = np.radians(angle)
    end = np.column_stack([1 + (profile[:, 0] - 1) * np.cos(last), (profile[:, 0] - 1) * np.sin(last), profile[:, 2]])
    assert np.abs(surface_points(surface, [1.0], v) - end).max() <= 1e-14 * 8
    if angle == 360.0:
        assert np.array_equal(surface.control_points[0], surface.control_points[-1])


# The circle of 11 points as the research on it has it, in exact fractions: (x, y, w).
UPPER = [(1, 0, 1), (1, 1 / 2, 1), (13 / 20, 1, 19 / 20), (0, 49 / 40, 9 / 10), (-13 / 20, 1, 19 / 20)]
CIRCLE = np.array([*UPPER, (-27 / 20, 0, 21 / 20), *[(x, -y, w) for x, y, w in UPPER[::-1]]])


def test_the_smooth_revolution_of_a_point_of_a_line_is_the_circle_of_eleven_points():
    surface = revolve_smooth(LINE, [0, 0, 0], [0, 0, 1])
    assert surface.knots_u.tolist() == [0] * 7 + [0.5] * 4 + [1] * 7
    circle = surface.homogeneous[:, 0, [0, 1, 3]]
    assert np.abs(circle - CIRCLE * [2, 2, 1]).max() <= 1e-15 * 4
    # In angle it is affine to 1.23 degrees, over a whole turn.
    u = np.linspace(0, 1, 1001)[:-1]
    x, y, _ = surface_points(surface, u, 0.0).T
    off = (np.degrees(np.arctan2(y, x)) - 360 * u + 180) % 360 - 180
    assert 1.22 <= np.abs(off).max() <= 1.23


@pytest.mark.parametrize("angle", [270.0, 360.0])
def test_smooth_revolution_is_c2_in_homogeneous_coordinates_and_no_more(angle):
    curve = BSplineCurve(2, ARC.knots, ARC.control_points, [1, 0.5, 2])
    surface = revolve_smooth(curve, [0, 0, 0], [0, 0, 1], angle)
    net = surface.homogeneous.reshape(len(surface.control_points), -1)
    pieces = BSpline(surface.knots_u, net, 6)
    for order in range(4):
        before, after = pieces(np.nextafter(0.5, 0), order), pieces(0.5, order)
        jump = np.abs(before - after).max() / np.abs(after).max()
        assert jump <= 1e-12 if order < 3 else jump > 1e-2
        if angle == 360:
            start, end = pieces(0.0, order), pieces(1.0, order)
            jump = np.abs(start - end).max() / np.abs(start).max()
            assert jump <= 1e-12 if order < 3 else jump > 1e-2
    assert np.array_equal(surface.weights[0], curve.weights)


def test_a_revolved_line_is_a_cylinder_or_a_cone():
    cylinder = revolve(BSplineCurve(1, UNIT, [[2, 0, 0], [2, 0, 5]]), [0, 0, 0], [0, 0, 1])
    u, v = np.random.default_rng(0).uniform(0.01, 0.99, (2, 30))
    assert np.abs(np.abs(mean_curvature(cylinder, u, v)) - 0.25).max() <= 1e-12
    cone = revolve(BSplineCurve(1, UNIT, [[1, 0, 0], [2, 0, 5]]), [0, 0, 0], [0, 0, 1], 120)
    assert np.abs(gaussian_curvature(cone, u, v)).max() <= 1e-12


@pytest.mark.parametrize("tolerance", [1e-2, 1e-5, 1e-8])
@pytest.mark.parametrize("angle", [45.0, 180.0, 360.0])
def test_polynomial_revolution_keeps_its_stated_error(angle, tolerance):
    result = revolve_polynomial(ARC, [0, 0, 0], [0, 0, 1], angle, tolerance)
    surface = result.surface
    assert surface.weights is None
    assert 0 < result.error <= tolerance
    u, v = np.meshgrid(np.linspace(0, 1, 700), [0.0, 0.5, 1.0])
    u, v = u.ravel(), v.ravel()
    profile, turn = on_curve(ARC, v), np.radians(angle) * u
    exact = np.column_stack([profile[:, 0] * np.cos(turn), profile[:, 0] * np.sin(turn), profile[:, 2]])
    off = np.linalg.norm(surface_points(surface, u, v) - exact, axis=1).max()
    assert off <= result.error
    # Not an idle bound: inside it is 1/384 h^4 that is met, and the curve reaches 3.5 of the 4 of its control points.
    assert off >= 0.15 * result.error


def test_a_whole_polynomial_turn_is_smooth_across_its_seam():
    surface = revolve_polynomial(ARC, [0, 0, 0], [0, 0, 1], tolerance=1e-4).surface
    assert np.array_equal(surface.control_points[0], surface.control_points[-1])
    for order in (0, 1, 2):
        start, end = (surface_points(surface, [u], GRID, order, 0) for u in (0.0, 1.0))
        assert np.abs(start - end).max() <= 1e-12 * max(1.0, np.abs(start).max())


def test_interpolation_is_scipys():
    # The promise is SciPy's interpolant, so SciPy's own evaluation must see the same curve.
    points = np.random.default_rng(0).uniform(0, 1, (7, 3))
    curve = interpolate_curve(points, 3, np.arange(7.0))
    x = np.linspace(0, 6, 50)
    assert np.abs(BSpline(curve.knots, curve.control_points, 3)(x) - on_curve(curve, x)).max() <= 1e-14


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: plane([0, 0, 0], [1, 0, 0], [2, 0, 0]), ControlPointError, "edge_v: found .* not parallel"),
        (lambda: plane([0], [1, 0, 0], [0, 1, 0]), ControlPointError, r"origin: 1 coordinate\(s\), expected 3, or 2"),
        (lambda: extrude(LINE, [0, 0, 0]), ControlPointError, "vector: found"),
        (lambda: revolve(LINE, [0, 0, 0], [0, 0, 0]), ControlPointError, "axis_direction: found"),
        (lambda: revolve(LINE, [0, 0, 0], [0, 0, 1], 0), OptionError, "angle: found 0"),
        (lambda: revolve(LINE, [0, 0, 0], [0, 0, 1], 361), OptionError, "angle: found 361"),
        (lambda: revolve(LINE, [0, 0, 0], [0, 0, 1], float("nan")), OptionError, "angle: found nan"),
        (lambda: revolve_polynomial(LINE, [0, 0, 0], [0, 0, 1], 90, 0), OptionError, "tolerance: found 0"),
        (lambda: revolve_polynomial(LINE, [0, 0, 0], [0, 0, 1], 90, 1e-30), OptionError, "expected a larger one"),
        (lambda: skin([LINE, LINE]), ControlPointError, "curves: 2 for degree 3, expected at least 4"),
        (lambda: interpolate_grid(np.zeros((4, 4, 3))), ControlPointError, r"points\[1\]: expected .* away"),
        (lambda: interpolate_grid(np.zeros((4, 4))), ControlPointError, r"points: has 2 dimension"),
        (lambda: interpolate_curve(np.eye(3), 3), ControlPointError, "points: 3 along parameters for degree 3"),
        (lambda: interpolate_curve(np.eye(3), 0), ControlPointError, "a degree of at least 1"),
        (lambda: interpolate_curve(np.eye(3), 1, [0, 1]), InputError, "parameters: 2 parameters, expected 3"),
        (lambda: interpolate_curve(np.eye(3), 1, [0, 1, 1]), InputError, r"parameters\[2\]: 1.0 after 1.0"),
    ],
)
def test_input_that_makes_no_surface_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize("far", [1e3, 1e6])
def test_the_stated_error_holds_far_from_the_origin(far):
    curve = BSplineCurve(2, ARC.knots, ARC.control_points + far)
    result = revolve_polynomial(curve, [far, far, far], [0, 0, 1], 90.0, 1e-12)
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 300), np.linspace(0, 1, 5)))
    profile, turn = on_curve(ARC, v), np.radians(90) * u
    exact = np.column_stack([profile[:, 0] * np.cos(turn), profile[:, 0] * np.sin(turn), profile[:, 2]])
    # The profile itself is rounded where it is shifted: half an eps of its coordinates, for three of them.
    off = np.linalg.norm(surface_points(result.surface, u, v) - far - exact, axis=1).max()
    assert off <= result.error
    assert result.error <= 1e-12 + 100 * np.finfo(float).eps * far


def test_what_lies_in_the_plane_has_two_coordinates():
    corners = np.array([[[0, 0], [0, 1]], [[2, 0], [2, 1]]])
    flat = BSplineSurface(1, 1, UNIT, UNIT, corners)
    assert np.array_equal(flat.control_points, np.dstack([corners, np.zeros((2, 2))]))
    weighted = BSplineSurface(1, 1, UNIT, UNIT, corners, [[1, 2], [3, 4]])
    assert np.array_equal(weighted.homogeneous[1, 1], [8, 4, 0, 4])
    assert np.array_equal(BSplineCurve(1, UNIT, [[0, 1], [2, 3]]).control_points, [[0, 1, 0], [2, 3, 0]])
    assert np.array_equal(plane([0, 0], [2, 0], [0, 1]).control_points, flat.control_points)
    assert np.array_equal(clamped_surface(1, 1, UNIT, UNIT, corners, [[1, 2], [3, 4]]).weights, weighted.weights)
    assert interpolate_curve(corners[:, 0], 1).control_points.shape == (2, 3)
    assert interpolate_grid(corners, 1, 1).control_points.shape == (2, 2, 3)
    assert np.array_equal(extrude(LINE, [1, 0]).control_points[1, 0], [3, 0, 0])
    assert np.abs(revolve(LINE, [0, 0], [0, 1], 90).control_points[-1] - [[0, 0, -2], [5, 0, -2]]).max() <= 4e-15
