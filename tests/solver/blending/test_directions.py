"""The direction of edge b: where closeness does not decide, the less turning blend, however the edges are run."""

import numpy as np
import pytest

import semispline
from helpers.papers_set import blend, state_problem
from helpers.sweeps import first_ones
from semispline import Base, BSplineCurve, BSplineSurface, reverse_u, revolve_polynomial, transform
from semispline.solver.judge import tied_directions

LINE = [0.0, 0.0, 1.0, 1.0]
# Far above what rounding does to shapes of size 1 to 10, far below what another direction does.
TOLERANCE = 1e-7


def turned(surface, degrees, offset=(0.0, 0.0, 0.0)):
    """Turned about the y-axis, then moved."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.eye(4)
    matrix[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    matrix[:3, 3] = offset
    return transform(surface, matrix)


def round_surface(start, end, tolerance=1e-3):
    """Surface of revolution about the z-axis of the line between two points (radius, height): rims v0 and v1."""
    line = BSplineCurve(1, LINE, [[start[0], 0, start[1]], [end[0], 0, end[1]]])
    return revolve_polynomial(line, (0, 0, 0), (0, 0, 1), 360, tolerance).surface


def elbow(degrees):
    """Two pipes of radius 1 that end 3 from the y-axis, about which the bend between them turns."""
    first, second = round_surface((1, -2), (1, 0)), round_surface((1, 0), (1, 2))
    return Base(turned(first, 0, (-3, 0, 0)), "v1"), Base(turned(turned(second, 0, (-3, 0, 0)), degrees), "v0")


def coaxial():
    return Base(round_surface((1, -2), (1, 0)), "v1"), Base(round_surface((1.5, 2), (2, 4)), "v0")


def rings():
    return Base(round_surface((1, 0), (2, 0)), "v1"), Base(round_surface((3, 0), (4, 0)), "v0")


def tilted():
    """A rim that is tilted, and whose seam is elsewhere."""
    a, b = coaxial()
    quarter = np.eye(4)
    quarter[:2, :2] = [[0, -1], [1, 0]]
    return a, Base(turned(transform(b.surface, quarter), 25, (0.5, 0, 0.3)), "v0")


def crossed():
    """Flat rings at right angles, far apart along x: the mirror y = 0 and the mirror z = 0 map each to itself."""
    quarter = np.eye(4)
    quarter[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    upright = transform(round_surface((3, 0), (2, 0)), quarter)
    return Base(round_surface((1, 0), (2, 0)), "v1"), Base(turned(upright, 0, (6, 0, 0)), "v1")


def run_backwards(base):
    return Base(reverse_u(base.surface), base.edge)


def apart(one, other, backwards=False):
    u, t = np.linspace(0, 1, 7), np.arange(41) / 40
    here, there = (
        result.surface.evaluate_grid(u, start + (end - start) * x)
        for result, x in ((one, t), (other, 1 - t if backwards else t))
        for start, end in [result.surface.domain[1]]
    )
    return np.abs(here - there).max()


PAIRS = [
    coaxial,
    rings,
    tilted,
    crossed,
    lambda: elbow(90),
    lambda: elbow(150),
    lambda: elbow(60),
    lambda: elbow(89.9),
    lambda: elbow(91),
]


@pytest.mark.parametrize("pair", first_ones(6, PAIRS))
def test_a_rim_run_backwards_gives_the_same_surface(pair):
    a, b = pair()
    plain = blend(a, b, v_scale="length")
    reversed_b = blend(a, run_backwards(b), v_scale="length")
    reversed_a = blend(run_backwards(a), b, v_scale="length")
    assert reversed_b.flipped == reversed_a.flipped == (not plain.flipped)
    assert apart(plain, reversed_b) < TOLERANCE
    assert apart(plain, reversed_a, backwards=True) < TOLERANCE


@pytest.mark.parametrize("degrees", first_ones(3, [60, 90, 150, 89.9, 90.1, 95]))
def test_an_elbow_keeps_the_inside_inside(degrees):
    a, b = elbow(degrees)
    result = semispline.blend(a, b)
    v = np.linspace(*result.surface.domain[1], 101)
    # The distance from the axis of the bend, the y-axis: from 2 inside to 4 outside, on both rims alike.
    first, second = (np.hypot(*result.surface.evaluate_grid([u], v)[0][:, [0, 2]].T) for u in (0, 1))
    assert np.ptp(first) > 1.9
    np.testing.assert_allclose(first, second, atol=0.05)
    # Not a twist, which passes through a point where there is no normal. The sharpest elbow is all but flat half-way.
    assert result.shape.turn.degrees < (30 if degrees < 150 else 120)
    twisted = blend(a, b, v_scale="length", flip="no" if result.flipped else "yes")
    assert twisted.shape.turn.degrees > 170


def test_directions_that_closeness_decides_are_not_both_tried():
    assert tied_directions(*coaxial()) == ("no",)
    a, b = coaxial()
    assert tied_directions(a, run_backwards(b)) == ("yes",)
    assert tied_directions(*rings()) == ("no",)
    assert tied_directions(*elbow(60)) == ("no",)
    # cos of the angle between the rims is up to 0.02 where closeness is within its limit, 0.01 of the sum of squares.
    assert len(tied_directions(*elbow(90 - 1.0))) == 2
    assert len(tied_directions(*elbow(90 - 1.3))) == 1
    # Beyond a right angle the twisted direction is closer; how the rims circle says that it is not to be trusted.
    assert len(tied_directions(*elbow(150))) == 2


@pytest.mark.parametrize(("sine", "tried"), [(0.0, 1), (0.095, 1), (0.105, 2), (0.9, 2)])
def test_flat_cones_do_not_tell_how_their_rims_circle(sine, tried):
    # A lip: up one cone to its rim, and from the wider rim down the other one. The closer direction is right.
    x, z = np.sqrt(1 - sine**2), sine
    a, b = Base(round_surface((3 - x, -z), (3, 0)), "v1"), Base(round_surface((4, 0), (4 + x, -z)), "v0")
    assert tied_directions(a, b) == ("no", "yes")[:tried]
    assert not blend(a, b, v_scale="length").flipped


@pytest.mark.long
def test_mirrored_directions_turn_equally_and_the_choice_is_the_same_in_any_order():
    a, b = crossed()
    assert len(tied_directions(a, b)) == 2
    turns = [blend(a, b, flip=flip, v_scale="length").shape.turn.degrees for flip in ("yes", "no")]
    assert turns[0] == pytest.approx(turns[1], abs=1e-6)
    one, other = blend(a, b, v_scale="length"), blend(b, a, v_scale="length")
    u, v = np.linspace(0, 1, 5), np.linspace(0, 1, 9)
    shift = one.seam_shift / (b.range_along[1] - b.range_along[0])
    there = np.mod((1 - v if one.flipped else v) + shift, 1.0)
    here = one.surface.evaluate_grid(u, v)
    np.testing.assert_allclose(here, other.surface.evaluate_grid(1 - u, there), atol=TOLERANCE)


def strip(edge, across):
    """A flat strip along an edge (start, end), leaving it by a vector."""
    edge, across = np.array(edge, dtype=float), np.array(across, dtype=float)
    return BSplineSurface(1, 1, LINE, LINE, [edge, edge + across])


@pytest.mark.long
def test_open_edges_at_right_angles_take_the_way_that_turns_less():
    # The second strip leaves to the side: one way bends around the corner, the other way twists.
    a = Base(strip([[0, -1, 0], [0, 1, 0]], [-2, 0, 0]), "u0")
    b = Base(strip([[2, 2, 0], [4, 2, 0]], [0, 2, 0]), "u0")
    assert len(tied_directions(a, b)) == 2
    result = blend(a, b)
    turns = {flip: blend(a, b, flip=flip).shape.turn.degrees for flip in ("yes", "no")}
    assert turns["yes"] > 90 > turns["no"] if not result.flipped else turns["no"] > 90 > turns["yes"]
    # In the plane z = 0 the inner corner (0, 1), (2, 2) and the outer one are joined, and nothing crosses.
    ends = result.surface.evaluate_grid([1.0], [0.0, 1.0])[0]
    np.testing.assert_allclose(ends, [[4, 2, 0], [2, 2, 0]], atol=1e-12)
    assert apart(result, blend(a, Base(strip([[4, 2, 0], [2, 2, 0]], [0, 2, 0]), "u0"))) < 1e-9


def test_where_one_way_is_refused_the_other_is_taken_and_strict_asks_the_one_that_is_taken():
    a, b = elbow(90)
    result = blend(a, b, v_scale="length", alpha="natural", strict=True)
    assert not result.warnings
    twisted = blend(a, b, v_scale="length", alpha="natural", flip="no" if result.flipped else "yes")
    assert any("folds" in warning for warning in twisted.warnings)


@pytest.mark.long
def test_the_stated_problem_is_the_one_that_is_solved():
    a, b = elbow(90)
    assert state_problem(a, b).matched.flipped == blend(a, b).flipped
    a, b = elbow(150)
    assert state_problem(a, run_backwards(b)).matched.flipped == blend(a, run_backwards(b)).flipped
