"""Calls that make no sense are refused by name, whatever type the mistake has; and what is forgiven."""

import copy
import pickle

import numpy as np
import pytest

import semispline as ss
from semispline.solver.errors import ControlPointError, InputError, KnotError, OptionError

UNIT = [0, 0, 1, 1]
CUBIC = [0, 0, 0, 0, 1, 1, 1, 1]
NET = np.random.default_rng(0).uniform(-1, 1, (4, 4, 3))
FLAT = ss.BSplineSurface(3, 3, CUBIC, CUBIC, NET)
CURVE = ss.BSplineCurve(3, [0, 0, 0, 0, 0.5, 1, 1, 1, 1], np.arange(15).reshape(5, 3) ** 2)
SEMI = ss.SemiStructuredSurface(3, CUBIC, (CURVE,) * 4)
AXIS = [0, 0, 0], [0, 0, 1]
GEOMETRY = ss.local_geometry(FLAT, [0.5, 0.6], [0.5, 0.6])
HUGE = 10**400


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: ss.insert_row_knot(SEMI, 1.0, 0.3), InputError, "i: found 1.0, expected the index"),
        (lambda: ss.insert_row_knot(SEMI, "a", 0.3), InputError, "i: found 'a'"),
        (lambda: ss.insert_row_knot(SEMI, True, 0.3), InputError, "i: found True"),
        (lambda: ss.insert_row_knot(SEMI, 1, 0.3, -1), OptionError, "times: found -1, expected a whole number"),
        (lambda: ss.insert_row_knot(SEMI, 1, 0.3, 1.5), OptionError, "times: found 1.5"),
        (lambda: ss.insert_row_knot(SEMI, 1, "a"), KnotError, "v: found 'a', expected a real number"),
        (lambda: ss.insert_row_knot(SEMI, 1, [0.3]), KnotError, r"v: found \[0.3\]"),
        (lambda: ss.insert_row_knot(SEMI, 1, HUGE), KnotError, "v: found 1000"),
        (lambda: ss.insert_row_knot(SEMI, 2, 0.3, 4), KnotError, r"control_curves\[2\]: knots\[0\]: knot 0.3"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, 1.5), OptionError, r"control_curves\[1\]: continuity: found 1.5"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, True), OptionError, "continuity: found True"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, "C1"), OptionError, "continuity: found 'C1'"),
        (lambda: ss.set_row_continuity(SEMI, 1, None, 1), KnotError, "v: found None"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, 3, float("nan")), OptionError, "tolerance: found nan"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, 3, float("inf")), OptionError, "tolerance: found inf"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, 3, -1e-9), OptionError, "tolerance: found -1e-09"),
        (lambda: ss.set_row_continuity(SEMI, 1, 0.5, 3, "a"), OptionError, "tolerance: found 'a'"),
        (lambda: ss.merge_knots(SEMI, None), OptionError, "tolerance: found None"),
        (lambda: ss.merge_knots(SEMI, float("inf")), OptionError, "tolerance: found inf"),
        (lambda: ss.merge_knots(FLAT), InputError, "surface: found a BSplineSurface, expected a SemiStr"),
        (lambda: ss.SemiStructuredSurface(3, CUBIC, 5), ControlPointError, "control_curves: found a int"),
        (lambda: FLAT.evaluate([HUGE], [0.5]), InputError, r"u: found \[1000"),
        (lambda: FLAT.evaluate([0.5], np.array([0.5 + 1j])), InputError, "v: found complex numbers"),
        (lambda: FLAT.evaluate([0.5, 0.6], []), InputError, "v: 0 parameters, expected as many as u has, 2"),
        (lambda: ss.BSplineSurface(3, 3, CUBIC, CUBIC, NET + 1j), ControlPointError, "control_points: found complex"),
        (lambda: ss.split_u(FLAT, "a"), KnotError, "u: found 'a'"),
        (lambda: ss.split_v(SEMI, [0.2, 0.4]), KnotError, r"v: found \[0.2, 0.4\]"),
        (lambda: ss.split_v(SEMI, 2.0), KnotError, r"control_curves\[0\]: range \[0.0, 2.0\]"),
        (lambda: ss.split_curve(CURVE, None), KnotError, "v: found None"),
        (lambda: ss.elevate_degree(FLAT, 4.5), KnotError, "degree: found 4.5"),
        (lambda: ss.elevate_degree(SEMI, None, "4"), KnotError, r"control_curves\[0\]: degree: found '4'"),
        (lambda: ss.elevate_curve(CURVE, 4.5), KnotError, "degree: found 4.5"),
        (lambda: ss.insert_knots(SEMI, [], [0.2, 1.0]), KnotError, r"control_curves\[0\]: knots_v\[1\]: found 1.0"),
        (lambda: ss.map_domain(FLAT, (0,)), InputError, r"u_range: found \(0,\), expected two finite"),
        (lambda: ss.map_domain(FLAT, None, 5), InputError, "v_range: found 5"),
        (lambda: ss.map_domain(FLAT, ("a", "b")), InputError, "u_range: found"),
        (lambda: ss.map_domain(FLAT, (0, 1, 2)), InputError, r"u_range: found \(0, 1, 2\)"),
        (lambda: ss.reverse_u("a"), InputError, "surface: found a str, expected a BSplineSurface or a Semi"),
        (lambda: ss.bounding_box(None), InputError, "surface: found a NoneType"),
        (lambda: ss.local_geometry(None, [0.5], [0.5]), InputError, "surface: found a NoneType"),
        (lambda: ss.plane([0, 0, 0], [1, 0, 0], [0, 1, 0], 2.5), KnotError, "degree: found 2.5"),
        (lambda: ss.interpolate_curve(NET[0], 2.5), ControlPointError, "degree 2.5, expected a degree of at least 1"),
        (lambda: ss.skin(5), InputError, "curves: found a int"),
        (lambda: ss.skin([CURVE] * 4, 2.5), OptionError, "degree_u: found 2.5"),
        (lambda: ss.skin([CURVE] * 4, 3, "abc"), KnotError, "knots_u"),
        (lambda: ss.extrude(FLAT, [1, 0, 0]), InputError, "curve: found a BSplineSurface, expected a BSplineCurve"),
        (lambda: ss.revolve(CURVE, *AXIS, "a"), OptionError, "angle: found 'a'"),
        (lambda: ss.revolve(CURVE, [0, 0, 0], [0, 0, 1e-320]), ControlPointError, "axis_direction"),
        (lambda: ss.revolve_polynomial(CURVE, *AXIS, 90, 5e-324), OptionError, "tolerance: .* a larger one"),
        (lambda: ss.revolve_polynomial(CURVE, *AXIS, 90, "a"), OptionError, "tolerance: found 'a'"),
        (lambda: ss.revolve_polynomial(CURVE, *AXIS, 90, float("inf")), OptionError, "tolerance: found inf"),
        (lambda: ss.trim_bezier(FLAT, None, None, None, None), InputError, "left: found a NoneType"),
        (lambda: ss.BezierFunction([0.5], "a", 1), InputError, "start: found 'a'"),
        (lambda: ss.BezierFunction([0.5]).evaluate("a"), InputError, "t: found 'a'"),
        (lambda: GEOMETRY.normal_curvature("abc"), InputError, "direction: found 'abc'"),
        (lambda: GEOMETRY.normal_curvature(np.ones((3, 3))), InputError, r"shape \(3, 3\), expected .* \(2, 3\)"),
        (lambda: GEOMETRY.normal_curvature([np.nan, 0, 0]), InputError, r"direction\[0\]: found nan"),
        (lambda: ss.isophote_angle([[0, 0, 1]], [0, 0]), InputError, r"light: shape \(2,\)"),
        (lambda: ss.isophote_angle([[0, 0, 1]], [0, 0, 0]), InputError, "light: found .* not zero"),
        (lambda: ss.zebra([[0, 0, 1]], [[0, 0, 1]], [0, 0, 3], 0), OptionError, "stripes: found 0"),
        (lambda: ss.clamp_knots("a", [0, 1], [1]), KnotError, "degree: found 'a'"),
        (lambda: ss.clamp_knots(1, [0, 1, 2, 3], [[np.nan], [1]]), ControlPointError, r"control_points\[0, 0\]"),
        (lambda: ss.clamp_knots(1, [0, 1, 2, 3], ["a", "b"]), ControlPointError, "control_points: found"),
        (lambda: ss.clamp_knots(1, [0, 1, 2, 3], 5), ControlPointError, "has 0 dimension.*at least 1"),
    ],
)  # fmt: skip
def test_a_mistake_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize("surface", [FLAT, SEMI, ss.revolve(CURVE, *AXIS, 90)], ids=["plain", "semi", "rational"])
def test_no_parameters_give_no_points(surface):
    for order in ((0, 0), (1, 2), (5, 0)):
        assert surface.evaluate([], [], *order).shape == (0, 3)
        assert surface.evaluate([0.5], [], *order).shape == (0, 3)
        assert surface.evaluate_grid([], [0.1, 0.2], *order).shape == (0, 2, 3)
        assert surface.evaluate_grid([0.1, 0.2], [], *order).shape == (2, 0, 3)
    assert CURVE.evaluate([]).shape == (0, 3)
    assert ss.local_geometry(surface, [], []).mean.shape == (0,)


@pytest.mark.parametrize("surface", [FLAT, SEMI], ids=["plain", "semi"])
def test_a_parameter_outside_by_rounding_means_the_end(surface):
    assert np.array_equal(surface.evaluate([-9e-13], [1 + 9e-13]), surface.evaluate([0.0], [1.0]))
    for u, v in ((-1.1e-12, 0.5), (0.5, 1 + 1.1e-12)):
        with pytest.raises(InputError, match="expected a parameter in"):
            surface.evaluate([u], [v])


@pytest.mark.parametrize("length", [1e-200, 1e-30, 1e300])
def test_the_length_of_the_axis_does_not_matter(length):
    expected = ss.revolve(CURVE, [0, 0, 0], [0.6, 0, 0.8], 90).control_points
    found = ss.revolve(CURVE, [0, 0, 0], [0.6 * length, 0, 0.8 * length], 90).control_points
    assert np.abs(found - expected).max() <= 1e-15 * np.abs(expected).max() * 4
    assert ss.plane([0, 0, 0], [length, 0, 0], [0, 1, 0]).n_control_points == 4


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))])
def test_copies_are_read_only_as_well(copied):
    rational = ss.revolve(CURVE, *AXIS, 90)
    function = ss.BezierFunction([0.2, 0.3], 0.1, 0.9)
    for value, name in (
        (FLAT, "control_points"), (rational, "weights"), (rational, "homogeneous"), (SEMI, "knots_u"),
        (CURVE, "control_points"), (function, "coefficients"),
    ):  # fmt: skip
        for holder in (value, copied(value)):
            array = getattr(holder, name)
            assert np.array_equal(array, getattr(value, name))
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 7
    assert copied(SEMI).control_curves[0].control_points.flags.writeable is False
    assert copied(CURVE).name == CURVE.name
