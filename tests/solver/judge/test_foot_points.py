"""Edges that are one curve with two parametrisations: circles in several forms, and curves with other speeds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.bases import facing_pair, moved
from helpers.circles import arcs, cone, cylinder, full_circle, smooth_circle, torus
from semispline import Base, BSplineSurface, measure_contact
from semispline.solver.cli.contact_table import print_contact
from semispline.solver.judge import Correspondence, corresponding_points, measure_meets
from semispline.solver.judge.continuation import continuation
from semispline.solver.judge.foot_points import Run, _merged, foot_map
from semispline.solver.judge.limits import shortfalls
from semispline.solver.judge.profile import measure_profile
from semispline.solver.reports import contact_record
from semispline.solver.splines.operations import map_domain, reverse_v, split_u, swap_directions

TURN = 2 * np.pi
CIRCLES = {
    "9 points": full_circle(4),
    "7 points": full_circle(3),
    "turned": full_circle(4, 1.0),
    "unequal arcs": arcs([0.3, 1.5, 2.0, 4.0, 0.3 + TURN]),
    "unequal spans": arcs(np.linspace(0, TURN, 5), [0, 0.1, 0.5, 0.6, 1]),
}


def paced(surface, e):
    """A surface of degree 2 along v and one span, v replaced by v + e v (1 - v): degree 4, the same points."""
    net = surface.control_points
    power = np.stack([net[:, 0], 2 * (net[:, 1] - net[:, 0]), net[:, 0] - 2 * net[:, 1] + net[:, 2]])
    at = np.array([0.0, 1 + e, -e])
    square = np.convolve(at, at)
    by_power = np.zeros((5, *power.shape[1:]))
    by_power[0] += power[0]
    by_power[:3] += at[:, None, None] * power[1]
    by_power += square[:, None, None] * power[2]
    # Bernstein points are sums of binomial ratios of the coefficients.
    ratio = np.array(
        [[1, 0, 0, 0, 0], [1, 1 / 4, 0, 0, 0], [1, 1 / 2, 1 / 6, 0, 0], [1, 3 / 4, 1 / 2, 1 / 4, 0], [1] * 5]
    )
    points = np.einsum("ij,jkd->kid", ratio, by_power)
    return BSplineSurface(surface.degree_u, 4, surface.knots_u, np.repeat([0.0, 1.0], 5), points)


def bent_strip(rng, x, slope=0.0):
    """Degree 2 both ways, from x on along u; a random curve at its edge u0."""
    edge = np.array([[x, k, 0.0] for k in range(3)]) + rng.uniform(-0.3, 0.3, (3, 3))
    across = np.array([1.0, 0.1, slope])
    return BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1], [edge + k * across for k in (0, 0.5, 1)])


@pytest.mark.parametrize("name", CIRCLES)
@pytest.mark.parametrize("turn", [lambda s: s, reverse_v])
def test_circles_in_two_forms_are_one_curve(name, turn):
    smooth, other = cylinder(smooth_circle()), turn(cylinder(CIRCLES[name], heights=(1.0, 2.0)))
    for ends in (Base(smooth, "u1"), Base(other, "u0")), (Base(other, "u0"), Base(smooth, "u1")):
        contact = measure_contact(*ends, order=4)
        assert contact.corresponds == "foot points"
        assert contact.flipped == (turn is reverse_v)
        assert contact.gap <= 1e-14
        assert contact.angle_degrees <= 1e-11
        assert not shortfalls(contact, "G4")
        # Cross derivatives are compared at the feet, too.
        assert contact.c1_residual <= 1e-12


def test_edges_along_the_other_parameter():
    smooth, other = (
        swap_directions(cylinder(smooth_circle())),
        swap_directions(cylinder(full_circle(3), heights=(1, 2))),
    )
    contact = measure_contact(Base(smooth, "v1"), Base(other, "v0"))
    assert contact.corresponds == "foot points"
    assert not shortfalls(contact, "G2")


@pytest.mark.parametrize("seam", [0.0, 2.0])
def test_angle_and_curvature_of_a_cylinder_on_a_torus(seam):
    # The torus meets the cylinder at its outer equator: square to the plane z = 0, as the cylinder is; curvature 1 / 1.
    upper = torus(full_circle(3, seam), ring=3.0, tube=1.0)
    lower = cylinder(smooth_circle(), 4.0, (-1.0, 0.0))
    contact = measure_contact(Base(lower, "u1"), Base(upper, "u0"))
    assert contact.corresponds == "foot points"
    assert contact.angle_degrees <= 1e-11
    assert contact.curvature_jump == pytest.approx(1.0, rel=1e-12)
    assert contact.curvature_jump_relative == pytest.approx(1.0, rel=1e-12)
    # A cone of half a right angle.
    contact = measure_contact(Base(lower, "u1"), Base(cone(full_circle(4, seam), (4.0, 5.0), (0.0, 1.0)), "u0"))
    assert contact.angle_degrees == pytest.approx(45, rel=1e-13)


@pytest.mark.parametrize("radius", [1.001, 1 + 1e-6])
def test_other_circles_are_not_one_curve(radius):
    smooth, other = cylinder(smooth_circle()), cylinder(full_circle(4), radius, (1.0, 2.0))
    contact = measure_contact(Base(smooth, "u1"), Base(other, "u0"))
    if radius > 1.0001:
        assert contact.corresponds == "affine"
        assert contact.gap > 0.01
    else:
        # Feet leave less than a thousandth of the gap: the curves are as good as one, and what is left is said.
        assert contact.corresponds == "foot points"
        assert contact.gap == pytest.approx(1e-6, rel=1e-9)
    assert shortfalls(contact, "G0")


def test_a_part_of_a_curve_is_not_the_curve():
    whole, part = cylinder(full_circle(4)), cylinder(arcs([0.0, 1.0, 2.0]), heights=(1, 2))
    contact = measure_contact(Base(whole, "u1"), Base(part, "u0"))
    assert contact.corresponds == "affine"
    assert contact.gap > 0.1
    straight = [
        BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[x, 0, 0], [x, y, 0]] for x in (0, 1)]) for y in (1, 2)
    ]
    for pair in (straight, straight[::-1]):
        contact = measure_contact(Base(pair[0], "u0"), Base(pair[1], "u0"))
        assert contact.corresponds == "affine"
        assert contact.gap == pytest.approx(1.0)


@pytest.mark.long
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), e=st.floats(-0.9, 0.9), flipped=st.booleans())
def test_other_speeds_change_nothing_but_residuals(seed, e, flipped):
    rng = np.random.default_rng(seed)
    base = bent_strip(rng, 0.0)
    other = moved(bent_strip(rng, 0.0, 0.3), np.eye(3))
    # One contact curve, two surfaces that leave it in two directions.
    net = other.control_points - other.control_points[:1] + base.control_points[:1]
    net = net * [-1, 1, 1] + [2, 0, 0] * base.control_points[:1]
    other = BSplineSurface(2, 2, base.knots_u, base.knots_v, net)
    plain = measure_contact(Base(base, "u0"), Base(other, "u0"), order=4)
    changed = paced(other, e)
    turned = reverse_v(changed) if flipped else changed
    found = measure_contact(Base(base, "u0"), Base(turned, "u0"), order=4)
    assert plain.corresponds == "affine"
    assert found.gap <= 1e-13
    if abs(e) > 1e-3:
        assert found.corresponds == "foot points"
    # Between samples the worst is found to some digits.
    for name in ("angle_degrees", "curvature_jump", "rate_jump", "second_rate_jump"):
        assert getattr(found, name) == pytest.approx(getattr(plain, name), rel=2e-4, abs=1e-7)
    assert found.flipped == flipped


def test_a_narrow_span_of_the_other_parametrisation_is_sampled():
    # b is bent by half a right angle at y = 0.6001, and flat outside a stretch of 2e-4, at its own parameter 0.2502.
    flat = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[x, y, 0] for y in (0, 1)] for x in (0, 1)])
    places = [0, 0.6, 0.6001, 0.6002, 1]
    rows = [[[x, y, -x * (y == places[2])] for y in places] for x in (0, -1)]
    bent = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 0.25, 0.2502, 0.2504, 1, 1], rows)
    for ends in (Base(flat, "u0"), Base(bent, "u0")), (Base(bent, "u0"), Base(flat, "u0")):
        contact = measure_contact(*ends)
        assert contact.corresponds == "foot points"
        assert contact.angle_degrees == pytest.approx(45, rel=1e-5)
        assert contact.angle_at.point[1] == pytest.approx(0.6001, abs=1e-9)


def test_affine_edges_ask_for_no_feet(monkeypatch):
    monkeypatch.setattr("semispline.solver.judge.edge_samples.foot_pairs", lambda *_: pytest.fail("searched for feet"))
    a = bent_strip(np.random.default_rng(1), 0.0)
    assert measure_contact(Base(a, "u0"), Base(a, "u0")).corresponds == "affine"


def test_a_curve_that_crosses_itself_keeps_its_order():
    # A figure of eight: at the crossing the nearest point may be on the other branch.
    def eight(t):
        angle = TURN * t
        return (
            np.stack([np.sin(angle), np.sin(angle) * np.cos(angle), 0 * angle], axis=1),
            TURN * np.stack([np.cos(angle), np.cos(2 * angle), 0 * angle], axis=1),
        )

    def late(t):
        # 0.1 sin(2 pi t) / (2 pi) behind.
        points, slopes = eight(t - 0.1 * np.sin(TURN * t))
        return points, slopes * (1 - 0.1 * TURN * np.cos(TURN * t))[:, None]

    breaks = np.linspace(0, 1, 9)
    found = foot_map(Run(late, breaks), Run(eight, breaks), 1e-9, closed=True)
    s = np.linspace(0, 1, 101)
    np.testing.assert_allclose(np.mod(found.along_b(s) - (s - 0.1 * np.sin(TURN * s)) + 0.5, 1), 0.5, atol=1e-13)


@pytest.mark.long
def test_thousands_of_spans():
    knots = np.linspace(0, 1, 4001)
    angle = TURN * knots
    circle = 1, np.concatenate([[0], knots, [1]]), np.stack([np.cos(angle), np.sin(angle), np.ones(4001)], axis=1)
    other = 1, np.concatenate([[0], knots**1.1, [1]]), circle[2]
    contact = measure_contact(Base(cylinder(circle), "u1"), Base(cylinder(other, heights=(1, 2)), "u0"))
    assert contact.corresponds == "foot points"
    assert contact.gap <= 1e-13


def test_parameters_of_feet():
    smooth, other = cylinder(smooth_circle()), cylinder(full_circle(4), heights=(1, 2))
    a, b = Base(smooth, "u1"), Base(other, "u0")
    s = np.linspace(0, 1, 33)
    t = corresponding_points(a, b, Correspondence(flipped=False), s)
    np.testing.assert_allclose(a.derivative(s, 0, 0), b.derivative(t, 0, 0), atol=1e-14)
    assert np.abs(s - t).max() > 1e-3
    pair = facing_pair(np.random.default_rng(2))
    s = np.linspace(*pair[0].range_along, 5)
    t = corresponding_points(pair[0], pair[0], Correspondence(flipped=False), s)
    np.testing.assert_allclose(t, s, atol=1e-15)


@pytest.mark.long
def test_bases_go_on_from_feet():
    # A tube between two pipes, its own circle smooth, theirs not.
    low, high = cylinder(full_circle(4), heights=(-1, 0)), cylinder(full_circle(3), heights=(1, 2))
    between = cylinder(smooth_circle())
    meets = measure_meets(between, Base(low, "u1"), Base(high, "u0"))
    assert meets.found == ()
    assert meets.searched == ("itself", "a", "b")
    # A funnel that runs back into the tube, through its wall.
    back = cone(full_circle(4), (1.0, 2.0), (0.0, 1.0))
    bulged = BSplineSurface(2, 6, np.repeat([0.0, 1.0], 3), between.knots_v, *_bulged(between))
    [place, *_] = measure_meets(bulged, Base(back, "u0")).found
    assert place.what == "a"
    # Radii 1 + z and 1 + 4 z (1 - z).
    assert place.point[2] == pytest.approx(0.75, abs=1e-9)


@pytest.mark.parametrize("seam", [0.0, 2.0])
def test_a_continuation_has_the_points_and_tangents_of_the_edge(seam):
    between, high = cylinder(smooth_circle()), cone(full_circle(3, seam), (1.0, 2.0), (1.0, 3.0))
    further = continuation(between, Base(high, "u0"), 1)
    v = np.linspace(0, 1, 50)[1:-1]
    np.testing.assert_allclose(further.evaluate_grid([0.0], v)[0], between.evaluate_grid([1.0], v)[0], atol=1e-13)
    np.testing.assert_allclose(
        further.evaluate_grid([0.0], v, 0, 1)[0], between.evaluate_grid([1.0], v, 0, 1)[0], atol=1e-11
    )
    w = np.full_like(v, 0.4)
    tangents = (further.evaluate(w, v + 1e-6) - further.evaluate(w, v - 1e-6)) / 2e-6
    np.testing.assert_allclose(further.evaluate(w, v, 0, 1), tangents, atol=1e-7)


def test_cross_derivatives_are_compared_at_the_feet():
    # One surface cut in two, the second half with other speeds along: its derivatives across are those of the first.
    rng = np.random.default_rng(7)
    net = np.stack([*np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij"), np.zeros((3, 3))], axis=2)
    whole = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1], net + rng.uniform(-0.3, 0.3, (3, 3, 3)))
    first, second = split_u(whole, 0.5)
    other_pace = paced(second, 0.6)
    found = measure_contact(Base(first, "u1"), Base(other_pace, "u0"))
    assert found.corresponds == "foot points"
    assert not shortfalls(found, "C2")
    # Run through faster across, they are not.
    faster = map_domain(other_pace, u_range=(0.5, 0.75))
    found = measure_contact(Base(first, "u1"), Base(faster, "u0"))
    assert not shortfalls(found, "G2")
    assert found.c1_residual == pytest.approx(0.5)


def _bulged(tube):
    """A tube with a belly: its rows at both ends, and one of three times the radius at half height between them."""
    first, last = tube.control_points
    middle = (first + last) / 2 * [3, 3, 1]
    return np.stack([first, middle, last]), np.stack([tube.weights[0]] * 3)


def test_what_was_compared_is_said(capsys):
    ring = cylinder(full_circle(4))
    for first, second, expected in (
        (Base(cylinder(smooth_circle()), "u1"), Base(cylinder(full_circle(4), heights=(1, 2)), "u0"), "foot points"),
        (Base(ring, "u1"), Base(ring, "u1"), "affine"),
    ):
        contact = measure_contact(first, second)
        assert contact_record(contact)["corresponds"] == expected
        print_contact(contact, measure_profile(first, second, contact), None)
        said = "each point is compared with its foot on the other" in capsys.readouterr().out
        assert said is (expected == "foot points")


def straight(x):
    """Points of the x-axis, whose parameter is x."""
    return np.stack([x, 0 * x, 0 * x], axis=-1), np.tile([1.0, 0, 0], (len(x), 1))


def test_parameters_run_on_over_the_seam_and_back_ends_stay():
    run = Run(straight, np.array([0.0, 2.0]))
    assert run.wrapped(np.array([0, 0.5, 2, 2.5, -0.5])).tolist() == [0, 0.5, 2, 0.5, 1.5]


def test_a_closed_curve_is_evaluated_in_its_range():
    def at(x):
        assert ((x >= 0) & (x <= 2)).all()
        return np.stack([np.cos(np.pi * x), np.sin(np.pi * x), 0 * x], axis=-1), np.pi * np.stack(
            [-np.sin(np.pi * x), np.cos(np.pi * x), 0 * x], axis=-1
        )

    feet, distance = Run(at, np.array([0.0, 2.0])).feet(at(np.array([0.1]))[0], np.array([1.9]), closed=True)
    assert feet == pytest.approx([2.1], abs=1e-12)
    assert distance == pytest.approx([0], abs=1e-12)


def test_where_a_curve_stands_still_the_guess_stays():
    run = Run(lambda x: (np.zeros((len(x), 3)), np.zeros((len(x), 3))), np.array([0.0, 2.0]))
    feet, distance = run.feet(np.array([[0, 3.0, 4.0]]), np.array([0.7]), closed=False)
    assert (feet.tolist(), distance.tolist()) == ([0.7], [5.0])


@pytest.mark.parametrize(("times", "breaks"), [(5e-10, [0, 0.5, 0.8, 2]), (1e-8, None)])
def test_knots_within_a_billionth_of_the_range_are_one(times, breaks):
    off = 2 * times
    feet = np.array([0.5 + off, 0.8, 0.8 + off])
    merged = _merged(Run(straight, np.array([0, 0.5, 2.0])), feet)
    assert merged.tolist() == (breaks or sorted([0, 0.5, *feet, 2]))


def test_points_of_rims_that_are_a_little_apart_belong_together_by_angle():
    a, b = Base(cylinder(full_circle(4)), "u0"), Base(cylinder(full_circle(3), 1 + 1e-5), "u0")
    s = np.linspace(0.01, 0.99, 20)
    others = corresponding_points(a, b, Correspondence(flipped=False, shift=0.0), s)
    rims = [base.surface.evaluate_grid(np.zeros(1), at)[0] for base, at in ((a, s), (b, others))]
    assert rims[1] == pytest.approx((1 + 1e-5) * rims[0] * [1, 1, 0], abs=1e-9)
