"""The certificate by normals: what it proves, and where it must give no answer."""

import numpy as np
import pytest

from helpers.shapes import arc, extruded, line, revolved, sheets, torus
from semispline import Base, BSplineSurface, transform
from semispline.solver.judge.continuation import continuation
from semispline.solver.judge.seen_from import _Border, _close, _faces, _sides, _towards_all, seen_from


@pytest.mark.parametrize("degrees", [60, 150, 170])
def test_an_arch_is_seen_from_above(degrees):
    direction = seen_from(extruded(arc((0, 0), 1.0, 90 + degrees / 2, 90 - degrees / 2), 1.0))
    assert np.abs(direction) == pytest.approx([0, 1, 0], abs=1e-9)


@pytest.mark.parametrize("degrees", [178.5, 181, 220, 300])
def test_normals_beyond_a_half_space_give_no_answer(degrees):
    assert seen_from(extruded(arc((0, 0), 1.0, 0, degrees), 1.0)) is None


def test_closed_surfaces_give_no_answer():
    for tube in (torus(3.0, 1.0), torus(3.0, 1.0, tube=(0, 100)), extruded(arc((0, 0), 1.0, 0, 360), 1.0)):
        assert seen_from(tube) is None
    # All normals one, and it meets itself nowhere: but it is no disc.
    assert seen_from(revolved(line((1, 0), (2, 0)))) is None


def test_a_flat_ring_that_covers_itself_gives_no_answer():
    """All normals are one, and only the border tells."""
    assert seen_from(revolved(line((1, 0), (2, 0)), 0, 350)) is not None
    assert seen_from(revolved(line((1, 0), (2, 0)), 0, 361)) is None
    assert seen_from(revolved(line((1, 0), (2, 0)), 0, 450)) is None


def test_a_flat_strip_that_crosses_itself_gives_no_answer():
    """Arms of a cross along one another's way: no two edges of the border are on one line."""
    corner = [*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, 180), *line((-1, 1), (-1, -2))]
    profile = extruded(corner, 0.2)
    # Laid flat: the width goes sideways in the plane of the profile.
    t = np.linspace(0, profile.domain[0][1], 400)[1:-1]
    p, d = (profile.evaluate(t, np.zeros(len(t)), order)[:, :2] for order in (0, 1))
    side = 0.1 * np.stack([-d[:, 1], d[:, 0]], axis=1) / np.linalg.norm(d, axis=1, keepdims=True)
    knots = np.concatenate([[t[0]], t, [t[-1]]])
    net = np.stack([np.column_stack([p + k * side, np.zeros(len(p))]) for k in (-1, 1)], axis=1)
    assert seen_from(BSplineSurface(1, 1, knots, [0, 0, 1, 1], net)) is None
    half = len(p) // 2
    short = BSplineSurface(1, 1, np.concatenate([[t[0]], t[:half], [t[half - 1]]]), [0, 0, 1, 1], net[:half])
    assert np.abs(seen_from(short)) == pytest.approx([0, 0, 1])


def test_sheets_are_seen_and_so_is_what_is_turned():
    rotation = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    for surface in sheets(4, 6):
        direction = seen_from(surface)
        assert np.linalg.norm(direction) == pytest.approx(1)
        turned = seen_from(transform(surface, 1e3 * rotation, [5e5, 0, 0]))
        assert np.abs(rotation @ direction @ turned) == pytest.approx(1, abs=1e-6)


def over(height):
    """A half turn from the plane's edge, back over it at a height, and down at the end by 60 degrees."""
    r = height / 2
    profile = [*arc((0, r), r, -90, 90), *line((0, height), (-1, height))]
    return extruded(profile, 1.0)


def test_with_bases_both_must_be_seen():
    knots = [0, 0, 1, 1]
    plane = BSplineSurface(1, 1, knots, knots, [[[x, 0, z] for z in (0, 1)] for x in (-2, 0)])
    ramp = extruded(arc((0, 3), 3.0, -90, -30), 1.0)
    assert seen_from(ramp, continuation(ramp, Base(plane, "u1"), 0)) is not None
    hook = over(1.0)
    assert seen_from(hook, continuation(hook, Base(plane, "u1"), 0)) is None


def test_a_base_that_runs_under_the_blend_is_told_by_the_border_alone():
    """Flat, all normals one: a strip that turns in the plane and ends on its own base."""
    ring = revolved(line((1, 0), (2, 0)), 0, 270)
    swept = BSplineSurface(
        ring.degree_v, ring.degree_u, ring.knots_v, ring.knots_u, ring.control_points.transpose(1, 0, 2), ring.weights.T
    )

    def strip(length):
        # From the ring's start at y = 0, x in [1, 2], towards negative y.
        net = [[[1 + x / 2, -length + y, 0] for x in (0, 1, 2)] for y in (0, length)]
        return Base(BSplineSurface(1, 2, [0, 0, 1, 1], [0, 0, 0, 1, 1, 1], net), "u1")

    # The ring ends at x = 0, y in [-2, -1]: nothing of the strip is there, however long.
    assert seen_from(swept, continuation(swept, strip(5.0), 0)) is not None
    # Half a turn more, and it lies on a strip that is long enough.
    whole = revolved(line((1, 0), (2, 0)), 0, 350)
    swept = BSplineSurface(2, 2, whole.knots_v, whole.knots_u, whole.control_points.transpose(1, 0, 2), whole.weights.T)
    assert seen_from(swept, continuation(swept, strip(0.1), 0)) is not None
    assert seen_from(swept, continuation(swept, strip(0.5), 0)) is None


# The figures, each from both sides


def directions(*degrees):
    """Unit vectors at angles above the plane z = 0."""
    t = np.radians(degrees)
    return np.stack([np.cos(t), np.zeros_like(t), np.sin(t)], axis=-1)


@pytest.mark.parametrize(("height", "faces"), [(0.019, False), (0.021, True), (0.5, True)])
def test_normals_are_a_fiftieth_from_square_to_the_direction(height, faces):
    grid = np.broadcast_to([np.sqrt(1 - height**2), 0.0, height], (3, 4, 3))
    assert _faces(grid, np.array([0.0, 0, 1])) is faces


@pytest.mark.parametrize("corner", range(4))
@pytest.mark.parametrize(("turn", "faces"), [(9, True), (11, False)])
def test_a_normal_that_turns_further_in_a_cell_than_it_is_from_square_gives_no_answer(corner, turn, faces):
    degrees = np.full(4, 10.0 + turn)
    degrees[corner] = 10.0
    assert _faces(directions(*degrees).reshape(2, 2, 3), np.array([0.0, 0, 1])) is faces


@pytest.mark.parametrize(("height", "found"), [(1e-7, True), (1e-10, False), (0.0, False)])
def test_normals_that_are_all_but_opposite(height, found):
    direction = _towards_all(np.array([[1.0, 0, height], [-1.0, 0, height], [0.0, 1, height], [0.0, -1, height]]))
    assert (direction is not None) is found
    if found:
        assert direction == pytest.approx([0, 0, 1], abs=1e-6)


def is_simple(corners, bulges=None, size=1.0):
    """Tell it of a polygon, edge k of which is `bulges[k]` off its chord half-way."""
    corners = size * np.column_stack([corners, np.zeros(len(corners))])
    ahead = np.roll(corners, -1, axis=0)
    square = np.cross([0, 0, 1], ahead - corners)
    off = size * np.array([0.0] * len(corners) if bulges is None else bulges)[:, None]
    halfway = (corners + ahead) / 2 + off * square / np.linalg.norm(square, axis=1, keepdims=True)
    return _Border(corners, halfway).is_simple_along(np.array([0.0, 0, 1]))


@pytest.mark.parametrize("size", [0.1, 1.0, 100.0])
def test_polygons(size):
    assert is_simple([(0, 0), (1, 0), (1, 1), (0, 1)], size=size)
    assert not is_simple([(0, 0), (1, 1), (1, 0), (0, 1)], size=size)
    # A pentagon and a star of five: each edge crosses those after the next.
    t = 2 * np.pi * np.arange(5) / 5
    assert is_simple(np.column_stack([np.cos(t), np.sin(t)]), size=size)
    assert not is_simple(np.column_stack([np.cos(2 * t), np.sin(2 * t)]), size=size)
    # A corner on another side.
    assert not is_simple([(0, 0), (2, 0), (2, 1), (1, 0), (0, 1)], size=size)


@pytest.mark.parametrize("size", [0.1, 1.0])
@pytest.mark.parametrize(("width", "simple"), [(1e-8, True), (1e-10, False), (0.0, False)])
def test_a_border_that_turns_straight_back(size, width, simple):
    assert is_simple([(0, 0), (1, 0), (0, width), (-1, 1)], size=size) is simple


@pytest.mark.parametrize(("apart", "simple"), [(0.39, False), (0.41, True)])
def test_between_samples_the_border_is_twice_as_far_off_as_half_way(apart, simple):
    # Two long edges whose ways to each other are long, each 0.1 off.
    corners = [(0, 0), (10, 0), (20, -5), (20, 5), (10, apart), (0, apart), (-10, 5), (-10, -5)]
    assert is_simple(corners, [0.1, 0, 0, 0, 0.1, 0, 0, 0]) is simple


@pytest.mark.parametrize(("way", "simple"), [(0.78, True), (0.84, False)])
def test_edges_are_neighbours_up_to_four_times_what_they_are_off(way, simple):
    # Both are 0.05 off half-way, so 0.1; the way from one to the other out to a tip and back is `way`.
    corners = [(0, -1), (10, 0), (10 + way / 2, 0.05), (10, 0.1), (0, 1.1), (-10, 5), (-10, -5)]
    assert is_simple(corners, [0.05, 0, 0, 0.05, 0, 0, 0]) is simple


@pytest.mark.parametrize("pair", [(0, 3), (1, 2), (0, 1), (0, 2)])
def test_normals_turn_no_farther_between_any_two_corners_than_they_face(pair):
    # Two corners 80 degrees apart, 40 from the others: cos 40 is less than sin 80, and more than sin 40.
    for degrees, faces in ((40, False), (25, True)):
        corners = np.tile([0.0, 0.0, 1.0], (4, 1))
        for corner, turn in zip(pair, np.radians([degrees, -degrees]), strict=True):
            corners[corner] = np.sin(turn), 0, np.cos(turn)
        grid = corners[[0, 2, 1, 3]].reshape(2, 2, 3)
        assert _faces(grid, np.array([0.0, 0, 1])) is faces


@pytest.mark.parametrize(("allowed", "close"), [(0.4, False), (0.6, True)])
def test_edges_are_as_far_apart_as_their_nearest_points(allowed, close):
    # The second one begins half above the middle of the first.
    ends = [np.array([at]) for at in ([0.0, 0], [4.0, 0], [1.0, 0.5], [1.0, 2])]
    assert _close(*ends, np.array([allowed])).tolist() == [close]


def test_the_border_runs_round_a_base_at_its_far_end():
    flat = [
        BSplineSurface(1, 1, [0, 0, length, length], [0, 0, 1, 1], [[[x, y, 0] for y in (0, 1)] for x in xs])
        for length, xs in ((1, (0, 1)), (3, (1, 4)))
    ]
    surface, base = flat
    sides = _sides(surface, None, base)
    assert [float(np.max(side[0][:, 0])) for side in sides] == [1, 4, 4, 4, 1, 0]
