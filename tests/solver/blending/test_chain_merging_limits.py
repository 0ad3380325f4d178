"""When pieces of a chain become one, each limit from both sides: how long an arc may be, and what its rounding is."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import LINE, arc, circle, line, walls
from semispline import Base, BSplineSurface, chain
from semispline.solver.blending.chain_joints import joined_pieces
from semispline.solver.blending.chain_merging import merged_pieces

THIRD, HALF = 120.0, 180.0


def merged(profile):
    """Pieces of walls along a profile, as they are and merged."""
    one = chain(walls(profile))
    pieces = one._pieces(2)
    joined = joined_pieces(pieces, closed=one.closed, tolerance=one.tolerance)
    return pieces, merged_pieces(pieces, joined, closed=one.closed)


def with_corners(cuts):
    """Arcs of a circle between lines that leave it square."""
    first, last = (np.array([np.cos(x), np.sin(x)]) for x in np.radians([cuts[0], cuts[-1]]))
    return [line(2.5 * first, 2 * first), *circle(2.0, cuts), line(2 * last, 2.5 * last)]


def with_tangents(cuts):
    """The same, but the lines go on."""
    first, last = (np.array([-np.sin(x), np.cos(x)]) for x in np.radians([cuts[0], cuts[-1]]))
    start, end = (2 * np.array([np.cos(x), np.sin(x)]) for x in np.radians([cuts[0], cuts[-1]]))
    return [line(start - first, start), *circle(2.0, cuts), line(end, end + last)]


def turns(pieces):
    """Angles in degrees that pieces of a circle about 0 take, from the ends of each."""
    ends = [np.array([row[:2] / row[3] for row in piece.jets[0, [0, -1]]]) for piece in pieces]
    angles = [np.degrees(np.arctan2(x[:, 1], x[:, 0])) for x in ends]
    return [float((end - start) % 360) for start, end in angles]


# Angles are found to some roundings; the limit is a part in 1e9 wide.
@pytest.mark.parametrize(("ends", "most"), [(with_corners, THIRD), (with_tangents, HALF)])
@pytest.mark.parametrize(("share", "count"), [(0.99, 1), (1.0, 1), (1 + 5e-10, 1), (1 + 2e-9, 2), (1.01, 2)])
def test_arcs_up_to_a_third_of_a_circle_between_corners_and_a_half_elsewhere_are_one(ends, most, share, count):
    """Beyond that two that are as few as they would be stay as they are; of three, two equal ones are made."""
    whole = share * most
    before, after = merged(ends((0, 0.4 * whole, whole)))
    assert len(after.pieces) == 2 + count
    assert len(after.inside) == 2 - count
    if count == 2:
        assert all(x is y for x, y in zip(after.pieces, before, strict=True))
    else:
        assert turns(after.pieces[1:-1]) == pytest.approx([whole], rel=1e-12)
    _, after = merged(ends((0, 0.3 * whole, 0.5 * whole, whole)))
    assert turns(after.pieces[1:-1]) == pytest.approx([whole / count] * count, rel=1e-12)


def test_arcs_that_only_touch_a_corner_at_one_end_are_cut_as_well():
    """The joint after a run is as much an end of it as the one before."""
    tangent, corner = with_tangents((0, 60, 100, 150)), with_corners((0, 60, 100, 150))
    for profile in ([tangent[0], *corner[1:]], [corner[0], *tangent[1:]]):
        assert turns(merged(profile)[1].pieces[1:-1]) == pytest.approx([75, 75], rel=1e-12)


def test_a_merged_piece_may_be_off_by_sixteen_times_what_the_worst_of_its_parts_may():
    one = chain(walls(with_corners((0, 30, 60))))
    pieces = one._pieces(2)
    pieces[1] = replace(pieces[1], rounding=np.array([1e-15, 5e-15, 2e-15]))
    pieces[2] = replace(pieces[2], rounding=np.array([3e-15, 4e-15, 2e-15]))
    joined = joined_pieces(pieces, closed=False, tolerance=one.tolerance)
    _, arc_of_both, _ = merged_pieces(pieces, joined, closed=False).pieces
    np.testing.assert_allclose(arc_of_both.rounding, [48e-15, 80e-15, 32e-15], rtol=1e-14)


@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turned", [0.0, 23.0])
def test_a_merged_piece_is_that_arc_to_what_it_may_be_off(radius, turned):
    parts = [arc((0, 0), radius, turned + a, turned + b) for a, b in ((0, 31), (31, 80), (80, 110))]
    ends = [radius * np.array([np.cos(x), np.sin(x)]) for x in np.radians([turned, turned + 110])]
    profile = [line(2 * ends[0], ends[0]), *parts, line(ends[1], 2 * ends[1])]
    _, one, _ = merged(profile)[1].pieces
    expected = arc((0, 0), radius, turned, turned + 110)
    points = one.jets[0, :, :2] / one.jets[0, :, 3:]
    own = chain(walls(profile)).origin[:2]
    assert np.abs(points + own - expected[:, :2] / expected[:, 2:]).max() <= one.rounding[0]


def halves_of_a_cubic():
    """Walls along a closed profile that begins in the middle of a cubic, cut there; lines with corners close it."""
    level = np.array([[0.0, 0], [1, 2], [2, -1], [4, 0]])
    first, second = [level[0]], [level[-1]]
    while len(level) > 1:
        level = (level[:-1] + level[1:]) / 2
        first.append(level[0])
        second.insert(0, level[-1])
    runs = [np.array(second), np.array([[4, 0], [4, -3]]), np.array([[4, -3], [0, -3]]), np.array([[0, -3], [0, 0]])]
    runs.append(np.array(first))
    faces = []
    for run in runs:
        points = [np.column_stack([run, np.full(len(run), z)]) for z in (0.0, -1.0)]
        degree = len(run) - 1
        faces.append(Base(BSplineSurface(1, degree, LINE, [0.0] * (degree + 1) + [1.0] * (degree + 1), points), "u0"))
    return faces


def test_a_ring_that_begins_in_the_middle_of_a_smooth_run_begins_there_still():
    """Nothing is merged of a cubic: places count from its first edge, whatever goes on over its start."""
    strip = chain(halves_of_a_cubic()).strip(2)
    assert strip.begins == 0
    assert (strip.place(0), strip.place(5)) == (strip.cuts[0], strip.cuts[-1])
    # The first corner is where the first edge ends.
    assert strip.joints[1].kind == "corner"
    assert strip.place(1) == pytest.approx(strip.cuts[1], rel=1e-9)


def test_a_ring_that_begins_amid_an_arc_that_is_merged_begins_at_the_first_corner():
    first, last = (2 * np.array([np.cos(x), np.sin(x)]) for x in np.radians([0, 60]))
    before, after = circle(2.0, (0, 30, 60))
    strip = chain(walls([after, line(last, (0, 0)), line((0, 0), first), before])).strip(2)
    assert strip.begins == 1
    assert strip.place(0.5) > strip.place(0) > strip.place(3.5) > strip.place(2) > strip.place(1.5) > 0
    assert strip.surface.evaluate([0.0], [strip.place(0)])[0] == pytest.approx([3**0.5, 1, 0], abs=1e-9)
