"""Each limit of contact and each ceiling of rounding, from both sides, where the figure is known by hand."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.bases import moved, patch
from helpers.sweeps import examples
from semispline import Base, BSplineSurface, EdgeError, measure_contact
from semispline.solver.judge import doubtful, local_origin, required_limits, untold
from semispline.solver.splines.operations import split_u

K1, K2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
EPS = 2.0**-52
MEASURES = {
    "gap": "G0",
    "angle_degrees": "G1",
    "curvature_jump_relative": "G2",
    "c1_residual": "C1",
    "c2_residual": "C2",
}


def strip(start, end, *, tilt=0.0, offset=0.0, bend=0.0, width=1.0, degree=1):
    """X = (x, y, offset + tilt t + bend t^2 / 2), t = x - start from 0 to end - start; u runs from 0 to 1 with it."""
    length = end - start
    heights = {1: (0.0, tilt * length), 2: (0.0, tilt * length / 2, tilt * length + bend * length**2 / 2)}[degree]
    places = np.linspace(start, end, degree + 1)
    net = [[[x, y, offset + z] for y in (0.0, width)] for x, z in zip(places, heights, strict=True)]
    return BSplineSurface(degree, 1, {1: K1, 2: K2}[degree], K1, net)


def meets(a, b, continuity):
    contact = measure_contact(Base(a, "u1"), Base(b, "u0"))
    return all(value <= limit for _, value, limit in required_limits(contact, continuity))


# The model is 2 long. What rounding may add is a thousandth of each limit or less, but for the curvature, a tenth.
@pytest.mark.parametrize(
    ("continuity", "fault", "limit"),
    [
        ("G0", lambda x: {"offset": x}, 2e-11),
        ("G1", lambda x: {"tilt": np.tan(np.radians(x))}, 1e-9),
    ],
)
@pytest.mark.parametrize(("times", "expected"), [(0.5, True), (0.8, True), (1.3, False), (2.0, False)])
def test_planes_that_meet_with_a_gap_or_an_angle(continuity, fault, limit, times, expected):
    a, b = strip(0, 1), strip(1, 2, **fault(times * limit))
    assert meets(a, b, continuity) is expected


@pytest.mark.parametrize(("times", "expected"), [(0.5, True), (0.8, True), (1.3, False), (2.0, False)])
def test_parabolas_whose_curvatures_differ(times, expected):
    # Both have curvature 1 at x = 0, where the vertex is, but for the fault.
    a = moved(strip(0, 1, bend=1.0, degree=2), np.diag([-1.0, 1, 1]))
    b = strip(0, 1, bend=1.0 + times * 1e-9, degree=2)
    contact = measure_contact(Base(a, "u0"), Base(b, "u0"))
    assert contact.curvature_jump_relative == pytest.approx(times * 1e-9, rel=1e-5, abs=0)
    assert all(value <= limit for _, value, limit in required_limits(contact, "G2")) is expected


@pytest.mark.parametrize(("times", "expected"), [(0.5, True), (0.8, True), (1.3, False), (2.0, False)])
def test_residuals_of_derivatives(times, expected):
    a = moved(strip(0, 1, bend=1.0, degree=2), np.diag([-1.0, 1, 1]))
    faster = BSplineSurface(1, 1, K1, K1, strip(1, 2 + times * 1e-11).control_points)
    assert meets(strip(0, 1), faster, "C1") is expected
    bent = strip(0, 1, bend=1.0 + times * 1e-11, degree=2)
    contact = measure_contact(Base(a, "u0"), Base(bent, "u0"))
    assert all(value <= limit for _, value, limit in required_limits(contact, "C2")) is expected


# A strip of width h, a thousand times thinner than the model is long: what rounding does to the angle counts.
THIN = 1e-6
# Control points 1 from the origin, which eight operations round by eps each, and storing by half an eps; the difference
# of two over h; on both sides.
BY_HAND = 2 * (8 + 0.5) * EPS * 2 / THIN


@pytest.mark.parametrize(("times", "expected"), [(0.5, True), (0.8, True), (1.3, False), (2.0, False)])
def test_rounding_is_allowed_on_top_and_no_more(times, expected):
    a, b = strip(-THIN, 0), strip(0, THIN, tilt=times * (BY_HAND + np.radians(1e-9)))
    contact = measure_contact(Base(a, "u1"), Base(b, "u0"))
    assert np.radians(contact.rounding["angle_degrees"]) == pytest.approx(BY_HAND, rel=1e-5, abs=0)
    assert meets(a, b, "G1") is expected


@pytest.mark.parametrize(("degree", "h"), [(1, 1.0), (2, 0.25), (3, 0.1), (5, 0.5)])
def test_rounding_of_derivatives_by_hand(degree, h):
    """A plane from x = 0 to 1, straight and even in u, whose first span is h long; it comes no farther than 1."""
    knots = np.array([0.0] * (degree + 1) + ([h] if h < 1 else []) + [1.0] * (degree + 1))
    x = np.array([knots[i + 1 : i + degree + 1].mean() for i in range(len(knots) - degree - 1)])
    net = np.array([[[at, y, 0.0] for y in (0.0, 1.0)] for at in x])
    b = Base(BSplineSurface(degree, 1, knots, K1, net), "u0")
    a = Base(moved(b.surface, np.diag([-1.0, 1, 1])), "u0")
    found = measure_contact(a, b, flip="no").rounding
    # The farthest corner is (1, 1, 0).
    one = 2 * (8 + 2**0.5 / 2) * EPS
    first, second = 2 * degree / h, 2 * degree / h * 2 * (degree - 1) / h
    assert found["gap"] == pytest.approx(one, rel=1e-12, abs=0)
    assert found["c1_residual"] == pytest.approx(one * first, rel=1e-12, abs=0)
    # The normal turns with the tangent across; that along the edge is the same on both sides, to the last bit.
    assert np.radians(found["angle_degrees"]) == pytest.approx(one * first, rel=1e-12, abs=0)
    # Flat: a curvature below 1e-3 over the size, 2, is none; the speed is 1.
    assert found["c2_residual"] == pytest.approx(one * second / 0.5, rel=1e-12, abs=0)
    # The first of two differences is over h, the second over both spans. Where nothing bends a turn does nothing.
    second = degree * (degree - 1) / h * 2 * (1 / h + 1)
    assert found["curvature_jump_relative"] == pytest.approx(one * second / 5e-4, rel=1e-12, abs=1e-20)


@pytest.mark.long
def test_what_rounding_does_is_allowed_and_hardly_more():
    # A smooth surface cut in two, far from the origin: the parts meet but for the rounding of their control points.
    worst = dict.fromkeys(MEASURES, 0.0)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        whole = patch(rng, degrees=(int(rng.integers(2, 6)), 3), counts=(6, 6))
        offset = 10 ** rng.uniform(2, 6) * rng.uniform(0.3, 1, 3)
        parts = [moved(part, offset=offset) for part in split_u(whole, 0.5)]
        contact = measure_contact(Base(parts[0], "u1"), Base(parts[1], "u0"), flip="no")
        for name in MEASURES:
            part = getattr(contact, name) / contact.rounding[name]
            assert part <= 1
            worst[name] = max(worst[name], part)
    # The edge is of one set of points: no gap.
    assert worst.pop("gap") == 0
    assert min(worst.values()) > 0.05, worst


def exactly(points):
    return [Fraction(float(x)) for x in np.ravel(points)]


@examples(60)
@given(st.integers(0, 10**6), st.floats(0, 9), st.booleans())
def test_points_less_the_local_origin_are_exact(seed, distance, is_far):
    rng = np.random.default_rng(seed)
    net = rng.uniform(-1, 1, (3, 3, 3)) + rng.uniform(-1, 1, 3) * 10**distance * is_far
    surface = BSplineSurface(2, 2, K2, K2, net)
    origin = local_origin(surface)
    less = [x - y for x, y in zip(exactly(net), exactly(np.broadcast_to(origin, net.shape)), strict=True)]
    assert exactly(net - origin) == less
    # Where it is not zero nothing is farther from it than the extent; where it is, the surface is near.
    far = np.abs(net).max(axis=(0, 1)) > 2 * np.ptp(net, axis=(0, 1))
    assert (origin[far] != 0).all()
    assert (np.abs(net - origin).max(axis=(0, 1)) <= 2 * np.ptp(net, axis=(0, 1)) + 1e-300).all() or not is_far


@given(st.integers(0, 10**6), st.floats(1, 8), st.sampled_from([-1, 1]))
def test_points_less_the_local_origin_are_exact_whatever_their_ratio(seed, ratio, sign):
    rng = np.random.default_rng(seed)
    net = sign * rng.uniform(1, ratio, (3, 3, 3)) * rng.uniform(1, 4)
    origin = local_origin(BSplineSurface(2, 2, K2, K2, net))
    less = [x - y for x, y in zip(exactly(net), exactly(np.broadcast_to(origin, net.shape)), strict=True)]
    assert exactly(net - origin) == less
    # Within a factor of three they have a middle that is exact.
    assert (origin[np.abs(net).max(axis=(0, 1)) <= 2.99 * np.abs(net).min(axis=(0, 1))] != 0).all()


def test_what_is_measured_far_away_is_what_the_surfaces_do():
    # All coordinates are whole numbers of 2^-10: moved by 2^40 they are still exact, and so must the measures be.
    a, b = strip(0, 1), strip(1, 2, tilt=2.0**-10)
    near = measure_contact(Base(a, "u1"), Base(b, "u0"))
    offset = np.array([2.0**40, -(2.0**41), 2.0**40])
    far = measure_contact(*(Base(moved(s, offset=offset), e) for s, e in ((a, "u1"), (b, "u0"))))
    assert near.angle_degrees == pytest.approx(np.degrees(2.0**-10), rel=1e-6)
    for name in MEASURES:
        assert getattr(far, name) == pytest.approx(getattr(near, name), rel=1e-12, abs=1e-15)
    np.testing.assert_allclose(far.angle_at.point, np.array(near.angle_at.point) + offset, rtol=1e-15)


CEILINGS = {
    # A tenth of what CAD sews, of the model's size; of what it takes for tangent and smooth.
    "gap": (1e-6, 1e-5),
    "angle_degrees": (1e-3, 1e-2),
    "curvature_jump_relative": (1e-3, 2e-2),
    "c1_residual": (np.pi / 180e3, np.pi / 180e2),
    "c2_residual": (1e-3, 2e-2),
}


@pytest.mark.parametrize("size", [1.0, 250.0])
@pytest.mark.parametrize("name", MEASURES)
def test_ceilings_of_rounding(name, size):
    sound = measure_contact(Base(strip(0, 1), "u1"), Base(strip(1, 2), "u0"))
    for rounding, warned, refused in zip(
        [x * (size if name == "gap" else 1.0) for c in CEILINGS[name] for x in (0.95 * c, 1.05 * c)],
        (False, True, True, False),
        (False, False, False, True),
        strict=True,
    ):
        contact = replace(sound, size=size, rounding=dict.fromkeys(MEASURES, 0.0) | {name: rounding})
        for continuity in ("C0", "C1", "C2", "G0", "G1", "G2"):
            needed = name in [measure for measure, _, _ in required_limits(contact, continuity)]
            assert bool(doubtful(contact, continuity)) is (warned and needed)
            assert bool(untold(contact, continuity)) is (refused and needed)
        assert (name in " ".join(doubtful(contact, MEASURES[name]))) is warned
        # What is said is the ceiling that was passed.
        low, high = (ceiling * (size if name == "gap" else 1.0) for ceiling in CEILINGS[name])
        for text in (*doubtful(contact, MEASURES[name]), *untold(contact, MEASURES[name])):
            assert f"by {rounding:.2g}, expected at most {high if refused else low:.2g}" in text


@pytest.mark.parametrize("factor", [2.0**-20, 2.0**20])
def test_residuals_have_no_unit(factor):
    # Of the model, of the parameter across the edge, and of one along it.
    a, b = strip(0, 1, bend=1.0, degree=2), strip(1, 2, tilt=0.9, bend=0.7, degree=2)
    flat = strip(0, 1), strip(1, 2, tilt=1e-3)
    for one, other in ((a, b), flat):
        plain = measure_contact(Base(one, "u1"), Base(other, "u0"))
        larger = measure_contact(Base(moved(one, scale=factor), "u1"), Base(moved(other, scale=factor), "u0"))
        stretched = [BSplineSurface(s.degree_u, 1, s.knots_u * factor, K1, s.control_points) for s in (one, other)]
        slower = measure_contact(Base(stretched[0], "u1"), Base(stretched[1], "u0"))
        for found in (larger, slower):
            for name in ("c1_residual", "c2_residual", "angle_degrees", "curvature_jump_relative"):
                assert getattr(found, name) == pytest.approx(getattr(plain, name), rel=1e-9, abs=1e-14)
                assert found.rounding[name] == pytest.approx(plain.rounding[name], rel=1e-9, abs=0)


@pytest.mark.parametrize("times", [1e-3, 0.5, 2.0])
def test_a_derivative_beside_rounding_is_not_told(times):
    # Cross derivatives of b twice those of a, both about as large as the rounding of their coordinates.
    at, step = 1e9, times * 2.0**-22
    a, b = strip(at - step, at), strip(at, at + 2 * step)
    contact = measure_contact(Base(a, "u1"), Base(b, "u0"), flip="no")
    assert untold(contact, "C1")
    assert untold(contact, "C2")


def test_no_derivative_at_all_is_not_told():
    stuck = BSplineSurface(1, 1, K1, K1, [[[0, 0, 0], [0, 1, 0]]] * 2)
    contact = measure_contact(Base(stuck, "u1"), Base(stuck, "u0"), flip="no")
    assert contact.rounding["c1_residual"] == np.inf
    assert untold(contact, "C1")
    assert not untold(contact, "C0")


def test_what_second_derivatives_are_measured_by():
    # Flat up to rounding: the square of the speed over the size.
    flat = strip(1, 2, bend=2e-14, degree=2)
    contact = measure_contact(Base(strip(0, 1, degree=2), "u1"), Base(flat, "u0"))
    assert contact.c2_residual == pytest.approx(4e-14, rel=0.05, abs=0)
    # Curvature, and second derivative over the square of the speed, below 1e-3 / size count as none: here 5e-4.
    contact = measure_contact(Base(strip(0, 1, degree=2), "u1"), Base(strip(1, 2, bend=1e-6, degree=2), "u0"))
    assert contact.c2_residual == pytest.approx(2e-3, rel=1e-6)
    assert contact.curvature_jump_relative == pytest.approx(2e-3, rel=1e-6)
    # Above it the figure itself.
    contact = measure_contact(Base(strip(0, 1, degree=2), "u1"), Base(strip(1, 2, bend=1e-2, degree=2), "u0"))
    assert contact.c2_residual == pytest.approx(1, rel=1e-6)


def test_surfaces_that_are_one_point_have_no_contact():
    point = BSplineSurface(1, 1, K1, K1, np.ones((2, 2, 3)))
    with pytest.raises(EdgeError, match="one point"):
        measure_contact(Base(point, "u0"), Base(point, "u1"))
