"""What agrees where pieces of a chain meet, what is a crease, a kink, a bend, or rounding: from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import rounded_square, strips, walls, with_net
from semispline import Base, BSplineSurface, EdgeError, chain
from semispline.solver.blending.chain_coefficients import LAMBDA, Coefficients, Joint, Q, W
from semispline.solver.blending.chain_joints import (
    _beyond_rounding,
    _check_speeds,
    _closing_speeds,
    _flatten_weights,
    _goes_on,
    _of_even_weights,
    _with_values,
    joined_pieces,
    only_continuous,
)
from semispline.solver.blending.chain_pieces import Piece, read_pieces
from semispline.solver.splines import Basis

LINE, QUADRATIC = Basis(1, np.array([0.0, 0, 1, 1])), Basis(2, np.array([0.0, 0, 0, 1, 1, 1]))
DOWN = (0.0, 0.0, -1.0)
BOTH_SIDES = [(0.8, True), (1.25, False)]


def piece(points, first=DOWN, last=None, *, rounding=0.0, width=1.0):
    """A contact with derivatives across from `first` to `last`, straight where it has two points."""
    points = np.array(points, dtype=float)
    t = np.linspace(0, 1, len(points))[:, None]
    across = np.array(first) + t * (np.array(first if last is None else last) - first)
    along = LINE if len(points) == 2 else QUADRATIC
    degrees = (along.degree, int(last is not None))
    return Piece(0, (0.0, 1.0), np.stack([points, across]), along, degrees, np.array([0.0, rounding]), width)


BEFORE = piece([(-1, 0, 0), (0, 0, 0)])
AFTER = [(0, 0, 0), (1, 0, 0)]


def joined(*pieces, closed=False, tolerance=0.0):
    return joined_pieces(list(pieces), closed=closed, tolerance=tolerance)


def scaled(one, size):
    return replace(one, jets=size * one.jets)


@pytest.mark.parametrize(("times", "smooth"), BOTH_SIDES)
@pytest.mark.parametrize("size", [1.0, 100.0])
def test_faces_that_twist_apart_by_a_part_in_1e8_are_creased(times, smooth, size):
    """The second one leaves square to the contact at its start, and turns about it: no slope makes that agree."""
    twist = times * 1e-8
    after = piece(AFTER, DOWN, (0, twist, -1))
    (joint,) = joined(scaled(BEFORE, size), scaled(after, size)).joints[1:]
    assert joint.kind == ("smooth" if smooth else "creased")
    assert joint.residuals == pytest.approx((0.0, twist), rel=1e-6)


@pytest.mark.parametrize(("times", "smooth"), BOTH_SIDES)
def test_contacts_that_turn_by_a_millionth_of_a_degree_have_a_kink(times, smooth):
    """Far from the origin of coordinates, where that is less than rounding of points may be."""
    angle = times * 1e-6
    t = np.radians(angle)
    start = np.array([100.0, 0, 0])
    before, after = (
        piece([start + x, start + y])
        for x, y in ((np.array([-1, 0, 0]), np.zeros(3)), (np.zeros(3), np.array([np.cos(t), np.sin(t), 0])))
    )
    (joint,) = joined(before, after).joints[1:]
    assert joint.turn_degrees == pytest.approx(angle, rel=1e-6)
    assert joint.kind == ("smooth" if smooth else "creased")


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
def test_faces_leave_the_contact_along_one_curve_to_a_part_in_1e8(times, met):
    apart = times * 1e-8
    pieces = [BEFORE, piece(AFTER, (0, apart, -1))]
    if met:
        (joint,) = joined(*pieces).joints[1:]
        assert joint.apart == pytest.approx(apart, rel=1e-6)
        assert joint.is_exact
    else:
        with pytest.raises(EdgeError, match="leave the contact along one curve"):
            joined(*pieces)
        wide = joined(*pieces, tolerance=1e-3)
        assert not wide.joints[1].is_exact
        # Nothing is allowed unless it is said.
        with pytest.raises(EdgeError, match="leave the contact along one curve"):
            only_continuous(pieces, wide, closed=False)


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
def test_a_face_may_be_off_by_the_tolerance_along_its_width(times, met):
    """4 wide: its derivative by its own parameter is off by a quarter of the tolerance. It runs twice as fast."""
    after = piece(AFTER, (0, times * 1e-3 / 4, -2), width=4.0)
    if met:
        assert not joined(BEFORE, after, tolerance=1e-3).joints[1].is_exact
    else:
        with pytest.raises(EdgeError, match="leave the contact along one curve"):
            joined(BEFORE, after, tolerance=1e-3)


def test_faces_on_different_sides_are_refused():
    for speed in (0.5, 1, 2):
        with pytest.raises(EdgeError, match="different sides"):
            joined(BEFORE, piece(AFTER, (0, 0, speed)))


def test_a_face_that_does_not_leave_the_contact_is_refused():
    """Its derivative across shrinks to nothing at the joint, on either side of it."""
    with pytest.raises(EdgeError, match="joint 1: a derivative across the contact vanishes there"):
        joined(piece([(-1, 0, 0), (0, 0, 0)], DOWN, (0, 0, 0)), piece(AFTER))
    with pytest.raises(EdgeError, match="leave the contact along one curve"):
        joined(BEFORE, piece(AFTER, (0, 0, 0), DOWN))


@pytest.mark.parametrize(("times", "refused"), BOTH_SIDES)
@pytest.mark.parametrize("size", [1.0, 1e6])
def test_a_contact_slower_than_a_billionth_of_its_size_stands_still(times, refused, size):
    speed = times * 1e-9
    slow = scaled(piece([(0, 0, 0), (speed / 2, 0, 0), (1, 0, 0)]), size)
    back = scaled(piece([(-1, 0, 0), (-speed / 2, 0, 0), (0, 0, 0)]), size)
    for pair in ((BEFORE, slow), (back, piece(AFTER))):
        if refused:
            with pytest.raises(EdgeError, match="joint 3: the contact stands still"):
                _check_speeds(*pair, 3)
        else:
            _check_speeds(*pair, 3)


def test_a_contact_of_no_length_stands_still():
    with pytest.raises(EdgeError, match="joint 1: the contact stands still"):
        _check_speeds(BEFORE, piece([(0, 0, 0), (0, 0, 0)]), 1)


def test_a_half_circle_runs_on_though_a_control_point_is_at_infinity():
    jets = np.zeros((2, 3, 4))
    jets[0] = [[1, 0, 0, 1], [0, 1, 0, 6e-17], [-1, 0, 0, 1]]
    jets[1, :, 2] = 1.0
    half = Piece(0, (0.0, 1.0), jets, QUADRATIC, (2, 2), np.zeros(2), 1.0)
    _check_speeds(half, half, 1)


def test_a_crease_is_the_angle_between_normals():
    """The second face turned about the first one's side edge, which is upright: it leans too."""
    t = np.radians(30)
    one = piece([(-1, 0, 0), (0, 0, 0)], DOWN, (0.3, 0, -2))
    other = piece([(0, 0, 0), (np.cos(t), np.sin(t), 0)], (0.3, 0, -2), DOWN)
    # Along (1, 0, 0) and (c, s, 0), across (0.3, 0, -2): normals (0, 1, 0) and (2 s, -2 c, 0.3 s) of any length.
    n = np.array([2 * np.sin(t), -2 * np.cos(t), 0.3 * np.sin(t)])
    expected = np.degrees(np.arccos(abs(n[1]) / np.linalg.norm(n)))
    assert joined(one, other).joints[1].crease_degrees == pytest.approx(expected, rel=1e-12)


def test_what_a_joint_says():
    joint = Joint((0.0, 0.0, 0.0), "smooth", 0.0, 0.0, (0.0,), 0.0, (0.0, 0.0))
    assert joint.apart == 0
    assert joint.is_exact
    assert not replace(joint, moved=1e-9).is_exact
    # A straight line does not bend.
    assert not joint.bends
    for size in (1e-3, 1.0, 50.0):
        for times, one in BOTH_SIDES:
            values = np.array([size, size * (1 - times * 1e-6)])
            for pair in (values, values[::-1]):
                assert replace(joint, curvatures=tuple(pair.tolist())).bends is not one


@pytest.mark.parametrize(("times", "one_point"), BOTH_SIDES)
def test_ends_apart_by_a_part_in_1e13_are_one_point(times, one_point):
    place, apart = np.array([-1000.0, 3.0, 0]), times * 1e-13 * 1000
    assert _beyond_rounding(place, place + np.array([0, 0, apart])) == (0 if one_point else pytest.approx(apart))
    assert _beyond_rounding(place, place) == 0


@pytest.mark.parametrize(("rounding", "least"), [(0.0, 1e-13), (2.5e-12, 1e-11)])
@pytest.mark.parametrize(("times", "is_rounding"), BOTH_SIDES)
def test_what_rounding_leaves_asks_for_no_slopes(rounding, least, times, is_rounding):
    """Derivatives that lean along the contact: slopes of q make them agree. Rounding counts twice on each side."""
    lean = times * least
    before = replace(BEFORE, rounding=np.array([0.0, rounding]))
    result = joined(before, piece(AFTER, DOWN, (lean, 0, -1), rounding=rounding))
    slopes = [own.slopes for own in result.coefficients]
    assert not slopes[0].any()
    if is_rounding:
        assert not slopes[1].any()
    else:
        assert slopes[1][0, Q, 1] == pytest.approx(-lean, rel=1e-3)
        assert result.joints[1].residuals[1] < lean / 100


@pytest.mark.parametrize(("apart", "least"), [(5e-13, 5e-12), (2e-12, 2e-11), (5e-9, 4e-11)])
@pytest.mark.parametrize(("times", "is_noise"), BOTH_SIDES)
def test_noise_is_ten_times_what_cannot_be_made_to_agree(apart, least, times, is_noise):
    """But for 4 parts in 1e11, what the faces leave the contact apart by is no reason for a jump."""
    result = joined(BEFORE, piece(AFTER, (0, apart, -1), (times * least, apart, -1)))
    assert (not result.coefficients[1].slopes.any()) is is_noise


def test_slopes_close_a_joint():
    """The face after it takes them where both are straight; half and half where none is; else the straight one."""
    bent = [(-2, 0.5, 0), (-1, 0, 0), (0, 0, 0)]
    leaning = DOWN, (0.3, 0, -0.8)
    cases = [
        (BEFORE, piece(AFTER, *leaning), (0.0, 1.0)),
        (piece(bent), piece([(0, 0, 0), (1, 0, 0), (2, 0.5, 0)], *leaning), (0.5, 0.5)),
        (piece(bent), piece([(0, 0, 0), (2, 0, 0)], *leaning), (0.0, 1.0)),
        (BEFORE, piece([(0, 0, 0), (0.5, 0, 0), (1, 0.5, 0)], *leaning), (1.0, 0.0)),
    ]
    for before, after, shares in cases:
        result = joined(before, after)
        (joint,) = result.joints[1:]
        assert joint.kind == "smooth"
        assert max(joint.residuals) < 1e-14
        # Over spans of length 1: the jump is (0.3, 0, 0.2) / span, R_v is along x and R_w down.
        one, other = (own.slopes[end, [Q, W], 1] for own, end in zip(result.coefficients, (1, 0), strict=True))
        speed, span = before.end_speeds()[1], result.spans[1]
        jump = np.array([0.3 / span / speed, -0.2 / span])
        np.testing.assert_allclose(one, jump * shares[0], rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(other / span, -jump * shares[1], rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(("apart", "least"), [(0.0, 1e-13), (2e-12, 2e-11)])
@pytest.mark.parametrize(("times", "is_noise"), BOTH_SIDES)
def test_a_slope_of_noise_is_none(apart, least, times, is_noise):
    """A jump of length 1 along the contact, and of noise across: the latter alone is not worth a degree."""
    after = piece(AFTER, (0, apart, -1), (1.0, apart, -1 - times * least))
    slopes = joined(BEFORE, after).coefficients[1].slopes[0]
    assert slopes[Q, 1] == pytest.approx(-1.0, rel=1e-9)
    assert (slopes[W, 1] == 0) == is_noise


@pytest.mark.parametrize(("times", "same"), BOTH_SIDES)
@pytest.mark.parametrize("sign", [1, -1])
def test_speeds_come_back_to_a_billionth(times, same, sign):
    excess = sign * times * 1e-9
    pieces = [BEFORE, piece([(0, 0, 0), (0.5, 0, 0), (1 + excess / 2, 0, 0)])]
    found = _closing_speeds(pieces)
    assert (found is pieces) is same
    if not same:
        ratios = [end / start for start, end in (one.end_speeds() for one in found)]
        assert np.prod(ratios) == pytest.approx(1.0, abs=1e-14)
        # Straight ones take it.
        assert found[1] is pieces[1]


@pytest.mark.parametrize(("times", "same"), BOTH_SIDES)
def test_a_ring_comes_back_to_its_first_values_to_a_billionth(times, same):
    last = piece([(0, 0, 0), (-1, 0, 0)], DOWN, (0, 0, -1 - times * 1e-9))
    pieces = [BEFORE, last]
    found, _ = _with_values(pieces, [one.at_ends() for one in pieces], closed=True, tolerance=0.0)
    first, other = found[1].values
    assert (first == other).all() == same
    assert other[W, 1] == pytest.approx(1 if same else 1 - times * 1e-9, abs=1e-12)
    # What comes back exactly is constant.
    pieces = [BEFORE, piece([(0, 0, 0), (-1, 0, 0)])]
    found, _ = _with_values(pieces, [one.at_ends() for one in pieces], closed=True, tolerance=0.0)
    assert (found[1].values[0] == found[1].values[1]).all()


def plain(first=1.0, last=0.0):
    values = np.zeros((2, 3, 2))
    values[:, LAMBDA, 0] = values[:, W, 1] = 1.0
    return Coefficients(values, np.zeros_like(values), first, last)


@pytest.mark.parametrize(("times", "flat"), BOTH_SIDES)
def test_weights_are_made_flat_where_slopes_jump_by_a_billionth(times, flat):
    slope = times * 1e-9
    ends = []
    for weights in ((1.0, 1.0), (1.0, 1.0 + slope)):
        jets = np.zeros((2, 2, 4))
        jets[0, :, 3], jets[0, :, 0] = weights, (0, 1)
        ends.append(Piece(0, (0.0, 1.0), jets, LINE, (1, -1), np.zeros(2), 1.0).at_ends())
    found = [plain(), plain()]
    _flatten_weights(ends, np.ones(2), found, [False, True], closed=False)
    assert not found[0].slopes.any()
    assert (not found[1].slopes.any()) is flat
    if not flat:
        # Weight times lambda has the slope 0 at both ends of it.
        assert found[1].slopes[:, LAMBDA, 0] == pytest.approx(-slope, rel=1e-6)


@pytest.mark.parametrize(("times", "smooth"), BOTH_SIDES)
def test_pieces_go_on_to_a_billionth(times, smooth):
    pieces = [BEFORE, piece(AFTER, DOWN, (times * 1e-9, 0, -1))]
    ends = [one.at_ends() for one in pieces]
    found = [plain(), plain()]
    assert _goes_on(ends, np.ones(2), found, 1, 1) is smooth
    assert _goes_on([ends[0], ends[0]], np.ones(2), found, 1, 0)


def test_pieces_that_go_on_smoothly_at_both_ends_keep_their_weights():
    """One rational face in three parts, and another one behind them: what meets that gets even weights."""
    points = np.array([[0, 0], [1, 1.0], [3, 0]])
    net = [np.column_stack([points, np.full(3, z)]) for z in (0.0, -1.0)]
    face = BSplineSurface(1, 2, LINE.knots, QUADRATIC.knots, net, [[1, 0.8, 2.0]] * 2)
    other = with_net(face, face.control_points[:, ::-1] * [-1, 1, 1] + np.array([6, 0, 0]), face.weights)
    faces = tuple(Base(one, "u0") for one in [*strips(face, [0.4, 0.7]), other])
    for count, kept in ((1, [True]), (3, [True] * 3), (4, [True, True, False, False])):
        pieces = read_pieces(faces[:count], (False,) * count, 2, np.zeros(3))
        found = _of_even_weights(pieces, closed=False, tolerance=0.0)
        assert [a is b for a, b in zip(found, pieces, strict=True)] == kept
    assert found[2].jets[0, 0, 3] == pytest.approx(found[2].jets[0, -1, 3], rel=1e-14)


def test_smooth_walls_of_lines_and_arcs_have_no_crease():
    joints = chain(walls(rounded_square())).strip(1).joints
    assert [joint.kind for joint in joints] == ["smooth"] * 8
    # Roundings of normals of size 1, in degrees.
    assert max(joint.crease_degrees for joint in joints) < 1e-11
    (single,) = chain(walls(rounded_square()[:1])).strip(1).joints
    assert single is None


def test_what_runs_through_a_piece_is_cubic():
    rng = np.random.default_rng(1)
    own = Coefficients(rng.normal(size=(2, 3, 2)), rng.normal(size=(2, 3, 2)), 1.0, 0.0)
    h = 1e-6
    start, end = (own.at(low, low + h, np.array([0.0, 1.0])) for low in (0.0, 1 - h))
    np.testing.assert_allclose(start[..., 0], own.values[0], rtol=1e-14)
    np.testing.assert_allclose(end[..., 1], own.values[1], rtol=1e-14)
    for found, slopes in ((start, own.slopes[0]), (end, own.slopes[1])):
        np.testing.assert_allclose(np.diff(found, axis=-1)[..., 0] / h, slopes, atol=1e-4)
    # No more than cubic, in one polynomial.
    assert np.abs(np.diff(own.at(0.2, 0.9, np.linspace(0, 1, 6)), n=4, axis=-1)).max() < 1e-13


@pytest.mark.parametrize(("first", "last"), [(0.25, 0.75), (0.5, 0.5)])
def test_q_fades_out_to_third_order_within_the_first_and_the_last_span(first, last):
    rng = np.random.default_rng(1)
    own = Coefficients(rng.normal(size=(2, 3, 2)), rng.normal(size=(2, 3, 2)), first, last)
    whole = replace(own, first=1.0, last=0.0)
    t = np.linspace(0, 1, 5)
    for low, high, end in ((0.0, first, 0), (last, 1.0, 1)):
        found = own.at(low, high, t)
        np.testing.assert_array_equal(found[:Q], whole.at(low, high, t)[:Q])
        for order in (0, 1):
            # The polynomial of fourth degree through five places; its derivatives by the place in [low, high].
            q = np.polynomial.Polynomial.fit(t, found[Q, order], 4, domain=[0, 1], window=[0, 1])
            near, far = (0.0, 1.0) if end == 0 else (1.0, 0.0)
            assert q(near) == pytest.approx(own.values[end, Q, order], rel=1e-12)
            assert q.deriv()(near) / (high - low) == pytest.approx(own.slopes[end, Q, order], rel=1e-10)
            assert [q.deriv(k)(far) if k else q(far) for k in range(3)] == pytest.approx([0.0] * 3, abs=1e-11)
    if first < last:
        middle = own.at(first, last, t)
        assert not middle[Q].any()
        np.testing.assert_array_equal(middle[:Q], whole.at(first, last, t)[:Q])


def degrees_of(one, other, rise, fall, first=1.0):
    """The degrees that three functions with these ends and slopes are taken for."""
    values, slopes = np.array([[one] * 3, [other] * 3], dtype=float), np.array([[rise] * 3, [fall] * 3], dtype=float)
    found = Coefficients(values[..., None], slopes[..., None], first, 1 - first).degrees[:, 0]
    assert found[LAMBDA] == found[W]
    return found[LAMBDA], found[Q]


@pytest.mark.parametrize(
    ("ends", "degree"),
    [
        ((0, 0, 0, 0), -np.inf),
        ((0.5, 0.5, 0, 0), 0),
        ((0, 0.5, 0.5, 0.5), 1),
        # One end is zero, and both slopes.
        ((0, 0.5, 0, 0), 3),
        ((0, 0, 0.5, -0.5), 2),
        ((0.5, 1.5, 0.5, 1.5), 2),
        ((0.5, 0.5, 0.5, 0.5), 3),
    ],
)
def test_degrees_of_what_runs_through(ends, degree):
    assert degrees_of(*ends) == (degree, degree)
    # What fades out is of fourth degree, unless it is nothing.
    assert degrees_of(*ends, first=0.5) == (degree, 4 if any(ends) else -np.inf)


@pytest.mark.parametrize(("times", "is_rounding"), BOTH_SIDES)
@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_degrees_are_told_to_a_part_in_1e12(times, is_rounding, size):
    d = times * 1e-12 * size
    assert degrees_of(0, d, d, d + size)[0] == 3
    # A line of slope 1 from 0, off by that.
    for ends, lower, higher in (
        ((-size / 2, size / 2, size + d, size - d), 1, 2),
        ((-size / 2, size / 2, size + d / 2, size + d / 2), 1, 3),
    ):
        assert degrees_of(*ends)[0] == (lower if is_rounding else higher)
    if size == 1:
        # The next floats after 1 are 2e-16 apart.
        assert degrees_of(1.0, 1.0 + d, d, d)[0] == (0 if is_rounding else 1)
