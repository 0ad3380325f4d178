"""When joints of two rims answer each other, and what counts as square or parallel there: from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import arc, flanges, line, walls
from semispline import chain
from semispline.solver.blending.chain_coefficients import Coefficients, JoinedPieces
from semispline.solver.blending.chain_pieces import Piece
from semispline.solver.blending.chain_rims import _answers, _at_joint, _AtJoint, _run_alike, facing_rims
from semispline.solver.options import BlendOptions
from semispline.solver.splines import Basis

# A direction along, one across, and the one square to both; their coordinates are exact.
ALONG, ACROSS, UP = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
# Sines at which a limit of a billionth is met, and missed.
BOTH_SIDES = [(0.8, True), (1.25, False)]
# Both chains have one origin.
HERE = np.zeros(3)


def pair_of_rims(first=0, last=3):
    """A wall and a plane beside it, along a line, an arc and a line, or some of them."""
    below = [line((2, -3), (2, 0)), arc((0, 0), 2.0, 0, 90), line((0, 2), (-3, 2))]
    above = [line((1.5, -3), (1.5, 0)), arc((0, 0), 1.5, 0, 90), line((0, 1.5), (-3, 1.5))]
    return chain(walls(below[first:last])), chain(flanges(above[first:last], base=0.5, width=-0.4))


@pytest.mark.parametrize(
    ("continuity", "named", "found"),
    [
        ("G1", {}, False),
        ("G2", {}, True),
        ("G3", {}, True),
        (("G1", "G2"), {}, False),
        ("G2", {"middle_curves": 0}, True),
        ("G2", {"middle_curves": 1}, False),
        ("G2", {"match": "length"}, False),
    ],
)
def test_rims_are_blended_as_they_are_from_second_order_without_free_rows(continuity, named, found):
    assert (facing_rims(*pair_of_rims(), BlendOptions(continuity=continuity, **named)) is not None) is found


@pytest.mark.parametrize(("last", "found"), [(1, False), (2, True), (3, True)])
def test_rims_have_two_edges_at_least(last, found):
    """Single edges have no joints: they are bases."""
    assert (facing_rims(*pair_of_rims(0, last), BlendOptions()) is not None) is found


def test_rims_are_both_open_or_closed_and_have_as_many_edges():
    a, b = pair_of_rims()
    assert facing_rims(a, pair_of_rims(0, 2)[1], BlendOptions()) is None
    assert facing_rims(a, replace(b, closed=True), BlendOptions()) is None


def at_joint(*, place=(0.0, 0.0, 0.0), along=ALONG, rows=(), jumps=(), extent=10.0):
    """A contact that runs `along` twice as fast as it is wide and leaves sideways: a line to which a circle goes on."""
    values = np.array([place, 2 * ACROSS, np.zeros(3)], dtype=float)
    after = np.array([4 * along, np.zeros(3), np.zeros(3)])
    before = after.copy()
    before[1] += 3 * along
    for k, row in rows:
        values[k] += row
    for k, jump in jumps:
        before[k] += jump
    return _AtJoint(values, before, after, extent)


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
def test_contacts_run_alike_to_a_billionth(times, met):
    sine = times * 1e-9
    other = at_joint(along=ALONG + sine * UP)
    assert _answers(at_joint(), other, HERE) is met
    # Or beside each other, one the other way.
    assert not _answers(at_joint(), at_joint(along=-ALONG), HERE)


def test_contacts_run_alike_in_any_direction():
    """Their cosine is 1 up to rounding, above or below."""
    rng = np.random.default_rng(0)
    for along in rng.normal(size=(50, 3)):
        values = np.array([np.zeros(3), np.cross(along, UP), np.zeros(3)])
        speeds = np.array([along, np.zeros(3), np.zeros(3)])
        assert _answers(_AtJoint(values, speeds, speeds, 1.0), _AtJoint(values, 3 * speeds, 3 * speeds, 1.0), HERE)


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
@pytest.mark.parametrize(("distance", "size"), [(5.0, 10.0), (20.0, 20.0)])
def test_the_way_between_is_square_to_a_billionth(times, met, distance, size):
    """Of its length, or of the size of the rim where that is more."""
    place = distance * UP + times * 1e-9 * size * ALONG
    assert _answers(at_joint(), at_joint(place=place), HERE) is met


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
@pytest.mark.parametrize(
    ("order", "row", "size"),
    [
        # The derivative itself is 2; above the first order what a face 10 wide bends at least: 2^2 / 10.
        (1, np.zeros(3), 2.0),
        (2, np.zeros(3), 0.4),
        (2, 7 * UP, 7.0),
    ],
)
def test_rims_leave_the_contact_square_to_a_billionth(times, met, order, row, size):
    tilted = at_joint(rows=[(order, row + times * 1e-9 * size * ALONG)])
    assert tilted.is_plain is met
    assert _answers(at_joint(), tilted, HERE) is met
    assert _answers(tilted, at_joint(), HERE) is met


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
@pytest.mark.parametrize(("order", "size"), [(0, 4.0), (1, 0.8), (2, 0.16)])
def test_what_jumps_is_along_to_a_billionth(times, met, order, size):
    """Of the speed 4, and for each order 2 / 10 of the one before."""
    for beside in (UP, ACROSS):
        assert at_joint(jumps=[(order, times * 1e-9 * size * beside)]).is_plain is met
    assert at_joint(jumps=[(order, ALONG)]).is_plain


def test_the_size_of_a_rim_is_that_of_its_points():
    jets = np.array([[[3.0, 4, 0], [-7, 0, 0]], [[0, 0, 20], [0, 0, 20]]])
    one = Piece(0, (0.0, 1.0), jets, Basis(1, np.array([0.0, 0, 1, 1])), (1, 0), np.zeros(2), 1.0)
    values = np.zeros((2, 3, 2))
    values[:, 0, 0] = values[:, 1, 1] = 1.0
    plain = Coefficients(values, np.zeros_like(values), 1.0, 0.0)
    joined = JoinedPieces((one, one), np.ones(2), (plain, plain), (None, None), (0, 0))
    assert _at_joint(joined, 1).extent == 7


def weighted(weights, across=0.0):
    jets = np.zeros((2, len(weights), 4))
    jets[0, :, 3] = weights
    jets[1, 1:, 3] = across
    return jets


@pytest.mark.parametrize(("times", "met"), BOTH_SIDES)
def test_weights_run_alike_to_a_part_in_1e12(times, met):
    one = weighted([1.0, 0.7, 1.0])
    assert _run_alike(one, weighted([2.0, 1.4 + 2 * times * 1e-12, 2.0])) is met
    assert _run_alike(one, weighted([1.0, 0.7, 1.0], times * 1e-12)) is met
    assert not _run_alike(one, weighted([1.0, 1.0]))


def test_rows_without_weights_run_alike_with_equal_ones():
    plain, weights = np.zeros((2, 3, 3)), weighted([0.5, 0.5, 0.5])
    assert _run_alike(plain, plain)
    assert _run_alike(plain, weights)
    assert _run_alike(weights, plain)
    assert not _run_alike(plain, weighted([1.0, 0.7, 1.0]))
