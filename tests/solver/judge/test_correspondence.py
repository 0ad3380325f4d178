"""Which way edges run along each other: where closeness decides, and where both directions are left."""

import numpy as np
import pytest

from helpers.shapes import line, revolved
from semispline import Base, BSplineSurface, insert_knots, map_domain, reverse_v, transform
from semispline.solver.judge.correspondence import (
    Correspondence,
    correspond,
    corresponding,
    corresponding_samples,
    is_closed,
    snapped_seam,
    tied_directions,
)

K1 = [0, 0, 1, 1]


def strip(along, across=(0.0, 0.0, 1.0), middle=(0.0, 0.0, 0.0)):
    """The edge u0 is a unit segment about its middle."""
    along, across, middle = (np.array(x, dtype=float) for x in (along, across, middle))
    return BSplineSurface(1, 1, K1, K1, [[middle + u * across + v * along for v in (-0.5, 0.5)] for u in (0, 1)])


@pytest.mark.parametrize(("cosine", "tied"), [(0.0099, True), (-0.0099, True), (0.0101, False), (-0.0101, False)])
def test_directions_within_a_hundredth_tie(cosine, tied):
    """Segments at an angle: the closeness of one direction is half its cosine, of the other the opposite."""
    a, b = Base(strip((1, 0, 0)), "u0"), Base(strip((cosine, np.sqrt(1 - cosine**2), 0)), "u0")
    closer = "no" if cosine > 0 else "yes"
    assert tied_directions(a, b) == ((closer, "yes" if closer == "no" else "no") if tied else (closer,))


def cone(square, height=0.0):
    """From a rim of radius 1 outwards and down, the square of the sine of its slope as given."""
    drop = np.sqrt(square / (1 - square))
    return Base(transform(revolved(line((1, 0), (2, -drop))), np.eye(3), [0, 0, height]), "u0")


@pytest.mark.parametrize(("square", "told"), [(0.0099, False), (0.0101, True), (0.5, True)])
def test_surfaces_tell_how_they_circle_from_a_product_of_sines_of_a_hundredth_on(square, told):
    """Both lie below their rims, as in a pipe that bends back: closeness says one direction, circling the other."""
    assert tied_directions(cone(square), cone(square, 0.5)) == (("no", "yes") if told else ("no",))


@pytest.mark.parametrize("outwards", [0.0, 1.0])
def test_a_straight_pipe_runs_one_way(outwards):
    above, below = (Base(revolved(line((1, side), (1 + outwards, side * 2))), "u0") for side in (1, -1))
    assert tied_directions(below, above) == ("no",)


def turned_rims(degrees, on_a=(0.0, 4.0), on_b=(0.0, 4.0), *, backwards=False):
    """Circles one above the other, four even pieces each, b turned about the axis, with ranges of their parameters."""
    rim, t = revolved(line((1, 0), (1, -1))), np.radians(degrees)
    rotation = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
    other = transform(rim, rotation, [0, 0, 1.0])
    other = reverse_v(other) if backwards else other
    ranges = ((rim, on_a), (other, on_b))
    return [Base(map_domain(surface, surface.domain[0], of_v), "u0") for surface, of_v in ranges]


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize(("on_a", "on_b"), [((0, 4), (0, 4)), ((100, 101), (-3, 5)), ((-7, -6), (2, 2.5))])
def test_rims_turned_by_one_piece(on_a, on_b, backwards):
    a, b = turned_rims(90, on_a, on_b, backwards=backwards)
    assert is_closed(a)
    assert is_closed(b)
    matched = correspond(a, b)
    length = on_b[1] - on_b[0]
    assert matched.flipped is backwards
    assert matched.shift == pytest.approx((0.25 if backwards else 0.75) * length, abs=1e-9 * length)
    # All spans are in common: seven samples in each, all inside, and what corresponds is one above the other.
    s_a, s_b = corresponding_samples(a, b, snapped_seam(a, b, matched))
    assert len(s_a) == len(s_b) == 28
    assert on_a[0] < s_a.min() < s_a.max() < on_a[1]
    assert b.derivative(s_b, 0, 0) == pytest.approx(a.derivative(s_a, 0, 0) + np.array([0, 0, 1]), abs=1e-9)
    pieces = np.floor((s_a - on_a[0]) / (on_a[1] - on_a[0]) * 4).astype(int)
    assert np.bincount(pieces).tolist() == [7] * 4
    # A knot of b alone parts a span of a, on either side of the seam.
    for part in (0.05, 0.8):
        knot = on_b[0] + part * length
        parted = Base(insert_knots(b.surface, [], [knot]), "u0")
        s_a, s_b = corresponding_samples(a, parted, snapped_seam(a, parted, matched))
        assert len(s_a) == 35
        assert (np.sort(np.abs(s_b - knot))[:2] < 0.001 * length).all()


@pytest.mark.parametrize("degrees", [37.0, 200.0])
def test_a_shift_between_samples_is_refined(degrees):
    """The parameters of a circle are uneven: of all shifts beside the one that is found none is closer."""
    a, b = turned_rims(degrees)
    matched, fine = correspond(a, b), np.linspace(0, 4, 4001)[:-1]

    def apart(shift):
        there = corresponding(a, b, Correspondence(False, shift), fine)
        return np.sum((b.derivative(there, 0, 0) - a.derivative(fine, 0, 0)) ** 2)

    assert apart(matched.shift) < min(apart(matched.shift - 1e-3), apart(matched.shift + 1e-3))


@pytest.mark.parametrize(("gap", "closed"), [(1.8e-9, True), (2.2e-9, False)])
def test_an_edge_is_closed_by_its_own_extent_wherever_it_is(gap, closed):
    rim = revolved(line((1, 0), (1, -1)))
    net = rim.control_points + np.array([100.0, 50.0, -20.0])
    net[:, -1, 0] += gap
    assert is_closed(Base(BSplineSurface(2, 2, rim.knots_u, rim.knots_v, net, rim.weights), "u0")) is closed


def test_one_closed_edge_has_no_shift():
    rim, half, almost = (
        Base(revolved(line((1, 0), (1, -1)), start, end), "u0") for start, end in ((30, 390), (30, 210), (31, 390))
    )
    for a, b in ((rim, half), (half, rim), (half, half), (rim, almost), (almost, rim)):
        assert correspond(a, b).shift == 0


def test_a_shift_has_no_units():
    a, b = turned_rims(37.0)
    shift = correspond(a, b).shift
    assert shift % (4 / 256) > 1e-3
    for unit in (1e-4, 1e4):
        small = [Base(transform(base.surface, unit * np.eye(3)), "u0") for base in (a, b)]
        assert correspond(*small).shift == pytest.approx(shift, abs=1e-9)
