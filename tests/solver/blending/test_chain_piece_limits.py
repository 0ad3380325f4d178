"""Limits of the pieces of a chain, each from both sides: what is straight, what is cut, what rounding may make."""

import numpy as np
import pytest

from helpers.chains import LINE, walls
from helpers.chains import line as profile_line
from semispline import Base, BSplineSurface
from semispline.solver.blending.chain_pieces import (
    Piece,
    read_pieces,
    standard,
    with_equal_ends,
    with_faster_end,
)
from semispline.solver.splines import Basis, basis_matrix

EPS = 2.0**-52
BEZIER = Basis(2, np.array([0, 0, 0, 1.0, 1, 1]))
ONE_KNOT = Basis(2, np.array([0, 0, 0, 0.5, 1, 1, 1]))


def piece(jets, along=BEZIER, degrees=()):
    jets = np.asarray(jets, dtype=float)
    return Piece(0, (0.0, 1.0), jets, along, degrees, np.zeros(len(jets)), 1.0)


def straight_jets(across=1.0, bend=(0.0, 0.0)):
    """Along x from 0 to 1, as a quadratic, with a derivative across of that size; middle points off by `bend`."""
    points = [[0, 0, 0], [0.5, bend[0], 0], [1, 0, 0]]
    derivatives = [[0, 0, across], [0, bend[1], across], [0, 0, across]]
    return np.array([points, derivatives])


@pytest.mark.parametrize(
    ("across", "bend"),
    [
        # Points of size 1.
        (1.0, (1e-12, 0.0)),
        # A derivative is measured by its own size, and by that of the points where it is smaller.
        (1000.0, (0.0, 1e-9)),
        (1e-3, (0.0, 1e-12)),
    ],
)
def test_straight_is_linear_to_a_part_in_1e12(across, bend):
    within = standard(piece(straight_jets(across, np.multiply(bend, 0.8))))
    assert within.is_straight
    assert within.jets.shape == (2, 2, 3)
    beyond = standard(piece(straight_jets(across, np.multiply(bend, 1.25))))
    assert not beyond.is_straight
    assert beyond.degrees == (2, 2)


def test_degrees_of_what_is_linear_constant_and_nothing():
    jets = np.concatenate([straight_jets(), np.zeros((1, 3, 3))])
    assert standard(piece(jets)).degrees == (1, 0, -1)


@pytest.mark.parametrize(("times", "straight"), [(0.0, True), (0.5, True), (2.0, False), (1e6, False)])
def test_weights_are_even_to_a_part_in_1e12(times, straight):
    weights = np.array([1, 1, 1 + times * 1e-12])
    jets = np.concatenate([straight_jets(), np.zeros((2, 3, 1))], axis=2)
    jets[0, :, 3] = weights
    # The points stay on a line, and their homogeneous coordinates too, to what straight ones may be off.
    assert standard(piece(jets)).is_straight is straight


def test_a_face_is_cut_at_knots_of_full_multiplicity_alone():
    """Degree 2: at a double knot the rows are only continuous, at a single one C1."""
    knots = np.array([0, 0, 0, 1, 2, 2, 4, 4, 4.0])
    along = np.array([[0, 0], [0.5, 0.1], [1.5, -0.1], [2, 0], [3, 0.2], [4, 0]])
    net = [np.column_stack([along, np.full(6, z)]) for z in (0.0, -1.0)]
    base = Base(BSplineSurface(1, 2, LINE, knots, np.stack(net)), "u0")
    pieces = read_pieces((base,), (False,), 1, np.zeros(3))
    assert [x.range for x in pieces] == [(0.0, 2.0), (2.0, 4.0)]
    assert [x.along.knots.tolist() for x in pieces] == [[0, 0, 0, 0.5, 1, 1, 1], [0, 0, 0, 1, 1, 1]]
    np.testing.assert_array_equal(pieces[1].jets[0, :, :2], along[3:])


def curve(one, t):
    points = basis_matrix(one.along.degree, one.along.knots, t) @ one.jets[0]
    return points[:, :3] / points[:, 3:]


def rational(weights, along=BEZIER):
    x = np.linspace(0, 2, len(weights))
    points = np.column_stack([x, x * (2 - x), np.zeros_like(x), np.ones_like(x)])
    return piece([points * np.array(weights)[:, None], np.tile([0.0, 0, 1, 0], (len(x), 1))], along)


def test_one_span_gets_equal_weights_at_its_ends():
    before = rational([1.0, 0.8, 4.0])
    after = with_equal_ends(before)
    assert after.jets[0, 0, 3] == pytest.approx(after.jets[0, -1, 3], rel=1e-14)
    # The same curve by another parameter: at each x it has the same y. Some roundings, and those of a bisection.
    t = np.linspace(0, 1, 9)
    x, y, _ = curve(after, t).T
    assert abs(x[4] - curve(before, t)[4, 0]) > 0.1
    np.testing.assert_allclose(y, curve(before, implicit_places(before, x))[:, 1], atol=1e-13)


def implicit_places(one, x):
    """The parameters at which a curve has these x, by bisection."""
    low, high = np.zeros_like(x), np.ones_like(x)
    for _ in range(60):
        middle = (low + high) / 2
        is_below = curve(one, middle)[:, 0] < x
        low, high = np.where(is_below, middle, low), np.where(is_below, high, middle)
    return (low + high) / 2


@pytest.mark.parametrize("weights", [[1.0, 0.9, 0.8, 4.0], [1.0, 0.9, 0.8, 2.0, 4.0]])
def test_splines_with_inner_knots_keep_their_weights(weights):
    """One linear fractional map of v for all spans would move their knots."""
    knots = np.linspace(0, 1, len(weights) - 1)[1:-1]
    before = rational(weights, Basis(2, np.array([0, 0, 0, *knots, 1, 1, 1])))
    assert with_equal_ends(before) is before


def test_a_faster_end_doubles_the_degree_of_what_is_not_constant():
    jets = np.concatenate([straight_jets(), straight_jets()[:1] + np.array([1, 2, 3]), np.zeros((1, 3, 3))])
    before = piece(jets, degrees=(1, 0, 2, -1))
    after = with_faster_end(before, 3.0)
    assert after.degrees == (2, 0, 4, -1)
    start, end = after.end_speeds()
    assert end / start == pytest.approx(3.0, rel=1e-13)


def test_rounding_is_what_control_points_off_by_four_spacings_make():
    """The bound is met: signs that alternate across the edge, and along it."""
    size, height = 3.0, 0.5
    (base,) = walls([profile_line((-size, 0), (size, 0))], height=-height)
    off = 4 * EPS * size
    for turned in (False, True):
        (one,) = read_pieces((base,), (turned,), 1, np.zeros(3))
        # Rows 0 and 1 off by that in opposite directions: of a derivative over the face's own parameter, 1 wide.
        np.testing.assert_allclose(one.rounding, [off, 2 * off], rtol=1e-14)
    spline = Piece(0, (0.0, 1.0), np.zeros((2, 4, 3)), ONE_KNOT, (2, 2), np.array([off, 2 * off]), 1.0)
    for j in (0, 1):
        spline.jets[j, :, 1] = spline.rounding[j] * np.array([1, -1, 1, -1])
    slopes = np.abs(spline.at_ends()[:, 1, :, 1]).T
    np.testing.assert_allclose(spline.rounding_of_slopes(), slopes, rtol=1e-12)
