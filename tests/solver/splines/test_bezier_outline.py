"""Holes whose sides cross, touch, or come close: told apart without samples."""

import numpy as np
import pytest

from semispline.solver.errors import InputError
from semispline.solver.judge.curvature import local_geometry
from semispline.solver.splines.bezier import BezierFunction, bezier_patch, divide_bezier, trim_bezier
from semispline.solver.splines.operations import map_domain

SQUARE = bezier_patch([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])


def hill(height, coefficients=(0.3, 0.7, 0.3)):
    """A hole whose bottom is a parabola with its top at (0.5, 0.5), under a straight upper side."""
    return {
        "left": BezierFunction([0.2], coefficients[0], height),
        "right": BezierFunction([0.8], coefficients[-1], height),
        "bottom": BezierFunction(list(coefficients), 0.2, 0.8),
        "top": BezierFunction([height], 0.2, 0.8),
    }


def quadrilateral(lower_left, lower_right, upper_right, upper_left):
    (a, b), (c, d), (e, f), (g, h) = lower_left, lower_right, upper_right, upper_left
    return {
        "left": BezierFunction([a, g], b, h),
        "right": BezierFunction([c, e], d, f),
        "bottom": BezierFunction([b, d], a, c),
        "top": BezierFunction([h, f], g, e),
    }


@pytest.mark.parametrize("gap", [1e-2, 1e-5, 1e-8])
def test_a_gap_is_a_gap_however_narrow(gap):
    assert len(trim_bezier(SQUARE, **hill(0.5 + gap))) == 8
    with pytest.raises(InputError, match="bottom, top: they cross or touch"):
        trim_bezier(SQUARE, **hill(0.5 - gap))


@pytest.mark.parametrize("away", [0, 1e-16, -1e-10])
def test_touching_sides_are_refused(away):
    with pytest.raises(InputError, match="bottom, top: they cross or touch"):
        trim_bezier(SQUARE, **hill(0.5 + away))


def test_neighbours_that_cross_are_refused():
    # The bottom bulges over the left side, far from their corner.
    sides = quadrilateral((0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7))
    crossing = sides | {"left": BezierFunction([0.3, 0.9, 0.9, 0.3], 0.3, 0.7)}
    with pytest.raises(InputError, match=r"right, left|left, right"):
        trim_bezier(SQUARE, **crossing)
    with pytest.raises(InputError, match="bottom, left"):
        # Left starts up and to the right, below the bottom, and crosses it on its way back.
        trim_bezier(
            SQUARE, **(sides | {"left": BezierFunction([0.3, 0.65, 0.3], 0.3, 0.7),
                                "bottom": BezierFunction([0.3, 0.7, 0.3], 0.3, 0.7)})
        )  # fmt: skip


def test_sides_that_leave_a_corner_in_one_direction_are_refused():
    # Left is the tangent of the bottom in (0.3, 0.3), which then bends away below it.
    sides = {
        "left": BezierFunction([0.3, 0.5], 0.3, 0.7),
        "bottom": BezierFunction([0.3, 0.7, 0.3], 0.3, 0.7),
        "right": BezierFunction([0.7], 0.3, 0.9),
        "top": BezierFunction([0.7, 0.9], 0.5, 0.7),
    }
    with pytest.raises(InputError, match="bottom, left: they cross or touch"):
        trim_bezier(SQUARE, **sides)
    assert len(trim_bezier(SQUARE, **(sides | {"bottom": BezierFunction([0.3, 0.69, 0.3], 0.3, 0.7)}))) == 8


def test_slanted_sides_that_nearly_coincide_are_decided_fast():
    for gap in (1e-3, 1e-6):
        sides = quadrilateral((0.2, 0.2), (0.2 + gap, 0.2 - gap), (0.7 + gap, 0.7 - gap), (0.7, 0.7))
        assert len(trim_bezier(SQUARE, **sides)) == 8


def test_a_loop_inside_out_is_refused():
    # A simple loop that runs clockwise: each side goes the right way, but slightly.
    sides = quadrilateral((0.7, 0.7), (0.71, 0.3), (0.3, 0.31), (0.29, 0.71))
    with pytest.raises(InputError, match="inside out"):
        trim_bezier(SQUARE, **sides)


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6, 1e8])
def test_holes_far_from_the_origin_are_holes(offset):
    patch = map_domain(SQUARE, (offset, offset + 1), (offset, offset + 1))

    def shifted(sides):
        return {n: BezierFunction(f.coefficients + offset, f.start + offset, f.end + offset) for n, f in sides.items()}

    thin = quadrilateral((0.25, 0.25), (0.75, 0.25), (0.75, 0.2578125), (0.25, 0.2578125))
    assert len(trim_bezier(patch, **shifted(thin))) == 8
    inverted = quadrilateral((0.75, 0.75), (0.8125, 0.25), (0.25, 0.3125), (0.1875, 0.8125))
    with pytest.raises(InputError, match="inside out"):
        trim_bezier(patch, **shifted(inverted))


@pytest.mark.parametrize(("off", "fits"), [(5e-13, True), (2e-12, False)])
def test_ends_meet_within_rounding_of_decimal_input(off, fits):
    sides = hill(0.6) | {"top": BezierFunction([0.6], 0.2 + off, 0.8)}
    if fits:
        assert len(trim_bezier(SQUARE, **sides)) == 8
    else:
        with pytest.raises(InputError, match="top, left: found ends at"):
            trim_bezier(SQUARE, **sides)


def test_random_quadrilaterals_are_judged_as_by_their_segments():
    # The known answer: a quadrilateral is simple exactly if its opposite sides do not cross.
    rng = np.random.default_rng(0)

    def turn(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    def cross(p, q, r, s):
        return turn(p, q, r) * turn(p, q, s) < 0 and turn(r, s, p) * turn(r, s, q) < 0

    judged = []
    for _ in range(300):
        a, b, c, d = rng.uniform(0.05, 0.95, (4, 2)).tolist()
        if not (a[0] < b[0] and b[1] < c[1] and d[0] < c[0] and a[1] < d[1]):
            continue
        area = turn(a, b, c) + turn(a, c, d)
        simple = not cross(a, b, c, d) and not cross(b, c, d, a) and area > 0
        try:
            accepted = len(trim_bezier(SQUARE, **quadrilateral(a, b, c, d))) == 8
        except InputError:
            accepted = False
        assert accepted == simple
        judged.append(simple)
    assert 5 < sum(judged) < len(judged)


def test_which_pieces_turn_the_normal_over():
    up = {n: local_geometry(p, *([[sum(r) / 2] for r in p.domain])).normal[0, 2] for n, p in pieces().items()}
    assert {n for n, z in up.items() if z < 0} == {"bottom", "top"}
    for direction, sign in (("v", -1), ("u", 1)):
        for part in divide_bezier(SQUARE, [0.4, 0.7], direction):
            assert local_geometry(part, [0.5], [0.5]).normal[0, 2] == pytest.approx(sign)


def pieces():
    return trim_bezier(SQUARE, **hill(0.6))
