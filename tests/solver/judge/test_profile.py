"""How measures run along an edge: against lengths, gaps, angles and curvatures that are known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.circles import cylinder, full_circle
from semispline import Base, BSplineSurface, InputError, measure_contact
from semispline.solver.judge.face_contact import measure_face_contact, measure_face_profile
from semispline.solver.judge.profile import Profile, _places, measure_profile, with_worse
from semispline.solver.splines.construction import plane

K = [0.0, 0, 1, 1]
K2 = [0.0, 0, 0, 1, 1, 1]


def strips(heights, length=4.0):
    """A strip left of the y-axis, and one right of it whose edge is a Bezier curve of these heights above the axis."""
    n = len(heights)
    knots = [0.0] * n + [1.0] * n
    y = np.linspace(0, length, n)
    left = [[[x, t, 0.0] for t in y] for x in (-1.0, 0.0)]
    right = [[[x, t, h] for t, h in zip(y, heights, strict=True)] for x in (0.0, 1.0)]
    return tuple(Base(BSplineSurface(1, n - 1, K, knots, net), edge) for net, edge in ((left, "u1"), (right, "u0")))


def profile_of(a, b, order=4):
    return measure_profile(a, b, measure_contact(a, b, order=order))


@pytest.mark.long
@given(st.lists(st.floats(0, 3), min_size=2, max_size=5).filter(lambda h: max(h) > 1e-3))
def test_the_mean_of_a_gap_is_its_integral(heights):
    # The mean of a Bezier function is that of its coefficients.
    profile = profile_of(*strips(heights))
    assert profile.length[-1] == pytest.approx(4.0, rel=1e-6)
    # The trapezoidal rule with 400 places: the second derivative, below 60, over 12 * 400^2; the ends left out.
    assert profile.means["gap"] == pytest.approx(np.mean(heights), abs=1e-4)
    np.testing.assert_allclose(profile.points[:, 1], profile.length, atol=1e-6)


@pytest.mark.long
@given(st.lists(st.floats(0, 3), min_size=3, max_size=5).filter(lambda h: max(h) > 1e-3))
def test_the_profile_holds_the_worst_of_the_contact(heights):
    a, b = strips(heights)
    contact = measure_contact(a, b, order=4)
    profile = measure_profile(a, b, contact)
    for name, at in (("gap", "gap_at"), ("angle_degrees", "angle_at")):
        value = getattr(contact, name)
        # What is sought between samples, to a thousandth; and rounding of a gap of 3, an angle of 180.
        assert profile.values[name].max() == pytest.approx(value, rel=1e-3, abs=1e-12)
        k = int(np.abs(profile.parameter - getattr(contact, at).parameter).argmin())
        assert profile.values[name][k] == pytest.approx(value, rel=1e-9, abs=1e-12)
    worse = with_worse(contact, profile)
    assert worse.gap == max(contact.gap, profile.values["gap"].max())
    assert worse.gap >= profile.means["gap"]


@pytest.mark.parametrize(("times", "is_worse"), [(0.5, False), (2.0, True)])
def test_nothing_but_what_is_worse_in_a_profile_takes_the_place_of_what_was_found(times, is_worse):
    a, b = strips([1.0, 2.0])
    contact = measure_contact(a, b, order=2)
    profile = measure_profile(a, b, contact)
    found = with_worse(contact, replace(profile, values={"gap": times * profile.values["gap"]}))
    if is_worse:
        # The gap grows to 2 at the end of the edge.
        assert found.gap == pytest.approx(4.0, rel=1e-6)
        assert replace(found, gap=contact.gap, gap_at=contact.gap_at) == contact
    else:
        assert found == contact


def roof_and_pipe(radius, angle):
    """A pipe about y, and beyond its rim at the height 0 a plane that leaves it at an angle; they meet in y."""
    r, half = radius, np.sqrt(0.5)
    net = [[[x, y, z] for y in (0.0, 3.0)] for x, z in ((r, -r), (r, 0.0), (0.0, 0.0))]
    net[0], net[1] = [[[-r, y, -r] for y in (0.0, 3.0)], [[-r, y, 0.0] for y in (0.0, 3.0)]]
    pipe = BSplineSurface(2, 1, K2, K, net, [[1, 1], [half, half], [1, 1]])
    turn = np.radians(angle)
    return Base(pipe, "u1"), Base(plane([0, 0, 0], [np.cos(turn), 0, np.sin(turn)], [0, 3, 0]), "u0")


def test_angle_and_curvature_of_a_pipe_and_a_plane():
    profile = profile_of(*roof_and_pipe(2.0, 12.0), order=2)
    assert set(profile.values) == {"gap", "angle_degrees", "curvature_jump", "curvature_jump_relative"}
    np.testing.assert_allclose(profile.values["angle_degrees"], 12.0, rtol=1e-12)
    np.testing.assert_allclose(profile.values["curvature_jump"], 0.5, rtol=1e-12)
    np.testing.assert_allclose(profile.values["curvature_jump_relative"], 1.0, rtol=1e-12)
    assert profile.means["curvature_jump"] == pytest.approx(0.5)


def test_one_curve_with_two_parametrisations_has_no_gap_along_it():
    a, b = Base(cylinder(full_circle(3)), "u1"), Base(cylinder(full_circle(4), heights=(1, 2)), "u0")
    contact = measure_contact(a, b)
    assert contact.corresponds == "foot points"
    profile = measure_profile(a, b, contact)
    # Some roundings of a radius; without feet it is 4 % of it.
    assert profile.values["gap"].max() < 1e-13
    assert profile.length[-1] == pytest.approx(2 * np.pi, rel=1e-4)


def test_a_contact_of_other_edges_is_refused():
    a, b = strips((0.0, 1.0))
    contact = replace(measure_contact(a, b), corresponds="foot points", gap=0.0)
    with pytest.raises(InputError, match="give its own edges"):
        measure_profile(a, b, contact)


def test_a_profile_on_a_face_has_what_its_contact_has():
    floor = plane([-1, -1, 0], [4, 0, 0], [0, 4, 0])
    wall = Base(plane([0, 0, 0.02], [2, 0, 0.04], [0, 1, 1]), "v0")
    contact, profile = measure_face_contact(wall, floor), measure_face_profile(wall, floor)
    for name, value in profile.values.items():
        assert value.max() == getattr(contact, name)
    # The edge climbs from 0.02 to 0.06 above the floor.
    assert profile.means["gap"] == pytest.approx(0.04)
    assert profile.length[-1] == pytest.approx(np.hypot(2, 0.04))


def test_a_mean_is_over_the_length_and_not_over_the_parameter():
    # y is 4 t^2, and the gap t: its integral over y is 2/3 of the length.
    nets = [
        [[x, y, h] for y, h in zip((0.0, 0.0, 4.0), heights, strict=True)]
        for x, heights in ((0.0, (0, 0, 0)), (0.0, (0, 0.5, 1)))
    ]
    left, right = (
        BSplineSurface(1, 2, K, K2, [[[x + p[0], *p[1:]] for p in net] for x in ends])
        for net, ends in zip(nets, ((-1.0, 0.0), (0.0, 1.0)), strict=True)
    )
    assert profile_of(Base(left, "u1"), Base(right, "u0")).means["gap"] == pytest.approx(2 / 3, rel=1e-4)


@pytest.mark.parametrize("size", [1e-3, 0.0])
def test_the_mean_over_a_short_edge_and_over_a_point(size):
    # Of values 0, 1, 1 at 0, 1/4 and 1 of the length: 7/8 over the length. A pole has none.
    places = np.array([0.0, 0.25, 1.0])
    values = np.array([0.0, 1.0, 1.0])
    with np.errstate(all="raise"):
        means = Profile(places, np.zeros((3, 3)), size * places, {"gap": values}).means
    assert means["gap"] == pytest.approx(7 / 8 if size else 2 / 3)


@pytest.mark.parametrize(
    ("breaks", "counts"), [([0, 1], [400]), ([0, 1, 4], [100, 300]), ([0, 1, 99, 100], [8, 392, 8])]
)
def test_places_are_shared_out_by_spans(breaks, counts):
    places = _places(np.array(breaks, dtype=float))
    assert np.histogram(places, breaks)[0].tolist() == counts


def test_feet_may_be_twice_as_far_as_the_largest_gap():
    """Two arcs, 0.001 apart: what a contact says of them decides whether these are its edges."""
    a, b = Base(cylinder(full_circle(3)), "u1"), Base(cylinder(full_circle(4), 1.001, heights=(1, 2)), "u0")
    contact = replace(measure_contact(a, b), corresponds="foot points")
    for gap in (0.45e-3, 0.34e-3):
        with pytest.raises(InputError, match="give its own edges"):
            measure_profile(a, b, replace(contact, gap=gap))
    profile = measure_profile(a, b, replace(contact, gap=0.55e-3))
    np.testing.assert_allclose(profile.values["gap"], 1e-3, rtol=1e-6)
