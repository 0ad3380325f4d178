"""Named points where the sides are placed: which parameters are theirs, and where edge b begins then."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from helpers.bases import cylinder
from semispline import Base, BSplineSurface, OptionError
from semispline.solver.blending.placing import place_sides
from semispline.solver.options import BlendOptions

# Roundings of points of size 1, of feet and of maps.
MET = 1e-11


def strip(x, start, end):
    """One wide and 2 long, v from `start` to `end`."""
    net = [[[at, 2.0 * y, 0.0] for y in (0, 1)] for at in (x, x + 1)]
    return BSplineSurface(1, 1, [0, 0, 1, 1], [start, start, end, end], net)


def ring(heights, start=0.0):
    """Of radius 1 about the z-axis, closed in v, which runs from `start` to `start` + 1."""
    found = cylinder(8, 1.0, heights)
    return BSplineSurface(3, 3, found.knots_u, found.knots_v + start, found.control_points)


def first_point(side):
    return BSpline(side.along.knots, side.rows[0], side.along.degree)(side.along.knots[0])


def test_both_ends_of_an_edge_can_be_named_and_no_more():
    a, b = Base(strip(0, 2.0, 3.0), "u1"), Base(strip(6, 5.0, 9.0), "u0")
    for pair in ((2.0, 5.0), (3.0, 9.0)):
        (_, other) = place_sides(a, b, BlendOptions(match=[pair]), "no").sides
        assert first_point(other) == pytest.approx([6, 0, 0], abs=MET)
    for pair, name in (
        ((np.nextafter(2, 0), 5.0), "a"),
        ((np.nextafter(3, 4), 9.0), "a"),
        ((2.0, np.nextafter(5, 0)), "b"),
        ((3.0, np.nextafter(9, 10)), "b"),
    ):
        with pytest.raises(OptionError, match=f"along edge {name}"):
            place_sides(a, b, BlendOptions(match=[pair]), "no")


@pytest.mark.parametrize("start", [0.0, 2.3])
def test_where_a_closed_edge_b_begins_follows_from_the_named_points(start):
    """One pair turns a ring as a whole: the start of a meets what is a quarter turn further on b."""
    a, b = Base(ring((0, -1)), "u0"), Base(ring((1, 2), start), "u0")
    for x, y, shift in ((0.0, 0.25, 0.25), (0.5, 0.75, 0.25), (0.5, 0.25, 0.75), (0.5, 0.5, 0.0)):
        placed = place_sides(a, b, BlendOptions(match=[(x, start + y)]), "no")
        assert min(abs(placed.matched.shift - shift), abs(placed.matched.shift - shift - 1)) < MET
        angle = 2 * np.pi * shift
        # The ring is a spline close to a circle, and through it at eighths.
        assert first_point(placed.sides[1]) == pytest.approx([np.cos(angle), np.sin(angle), 1], abs=MET)


def test_of_a_ring_and_an_open_edge_end_answers_end():
    """Only where both are closed do the named points say where b begins."""
    closed, opened = Base(ring((0, -1)), "u0"), Base(strip(3, 0.0, 1.0), "u0")
    for a, b, first in ((closed, opened, [3, 0, 0]), (opened, closed, [1, 0, 0])):
        (_, other) = place_sides(a, b, BlendOptions(match=[(0.4, 0.6)]), "no").sides
        assert first_point(other) == pytest.approx(first, abs=MET)
