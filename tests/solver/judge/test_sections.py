"""What the measures of shape share: which ways a surface closes, the window, samples, the least on a grid."""

from itertools import pairwise

import numpy as np
import pytest

from helpers.shapes import arc, extruded, line, revolved, torus
from semispline import BSplineSurface, transform
from semispline.solver.judge.sections import (
    closed_directions,
    just_inside,
    least_on_grid,
    spread,
    turn_window,
    unit_normals,
)


def test_which_ways_a_surface_closes():
    assert closed_directions(torus(3.0, 1.0)) == (True, True)
    assert closed_directions(torus(3.0, 1.0, tube=(0, 350))) == (False, True)
    assert closed_directions(extruded(arc((0, 0), 1.0, 0, 360), 1.0)) == (True, False)
    # Both ends of the tube are the same point.
    assert closed_directions(revolved(arc((1, 0), 1.0, 180, 540))) == (False, True)
    # Lines v are points: nothing goes round.
    k = [0, 0, 1, 1]
    assert closed_directions(BSplineSurface(1, 1, k, k, [[[0, 0, 0]] * 2, [[1, 0, 0]] * 2])) == (False, False)


@pytest.mark.parametrize(("off", "closed"), [(0.5e-9, True), (2e-9, False)])
def test_the_limit_of_closed_from_both_sides(off, closed):
    pipe = revolved(line((1, 0), (1, 2)))
    net = pipe.control_points.copy()
    net[:, -1, 0] += 2 * off
    moved = BSplineSurface(2, 2, pipe.knots_u, pipe.knots_v, net, pipe.weights)
    for surface in (moved, transform(moved, 1e5 * np.eye(3))):
        assert closed_directions(surface)[1] is closed


def test_the_window_is_the_mean_over_v():
    # Sections of lengths 1 to 3: 2 in the mean.
    k = [0, 0, 1, 1]
    wedge = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [3, 1, 0]]])
    assert turn_window(wedge) == pytest.approx(2 / 50)
    assert turn_window(extruded(arc((0, 0), 2.0, 0, 90), 7.0)) == pytest.approx(np.pi / 50)


def test_samples_crowd_into_every_span():
    breaks = np.array([0.0, 0.001, 0.5, 1.0])
    for total, least, steps in ((30, 2, 10), (3, 4, 4)):
        samples = spread(breaks, total, least)
        counts = [np.sum((samples >= low) & (samples < high)) for low, high in pairwise(breaks)]
        assert counts == [steps] * 3
        assert samples[-1] == 1


def test_just_inside_passes_knots_that_count_as_one():
    after, before = just_inside(np.array([0.0, 1e-11, 1.0]))
    assert (after > [0, 1e-11]).all()
    assert (before < [1e-11, 1]).all()
    assert (after < before).all()
    assert after[1] - 1e-11 > 1e-12


def test_the_least_on_a_grid_is_found_between_its_nodes():
    least, u, v = least_on_grid(
        lambda u, v: (u[:, None] - 0.123) ** 2 + (v[None] - 0.77) ** 2, np.linspace(0, 1, 6), np.linspace(0, 1, 4)
    )
    assert least == pytest.approx(0, abs=1e-8)
    assert [u, v] == pytest.approx([0.123, 0.77], abs=1e-4)
    # What is no number is never least.
    half = np.array([0, 0.5, 1])
    least, *_ = least_on_grid(lambda u, v: np.where(u[:, None] > 0.5, np.nan, v[None] - u[:, None]), half, half)
    assert least == pytest.approx(-0.5)


def test_at_least_two_steps_in_a_span():
    assert spread(np.array([0.0, 1.0]), 1).tolist() == [0, 0.5, 1]


@pytest.mark.parametrize(
    ("width", "step"),
    # A part of the span; of the domain, more than what counts as one knot; and never half a span.
    [(0.5, 0.5e-8), (1e-6, 2e-12), (4e-12, 1e-12)],
)
def test_how_far_just_inside_is(width, step):
    after, before = just_inside(np.array([0.0, width, 1.0]))
    assert [after[0], width - before[0]] == pytest.approx([step, step], rel=1e-3)


@pytest.mark.parametrize(("sine", "has_normal"), [(0.5e-12, False), (2e-12, True)])
def test_tangents_all_but_parallel_have_no_normal(sine, has_normal):
    for pu, pv in (((1, 0, 0), (1, sine, 0)), ((0, 1e-3, 0), (-sine * 1e5, 1e5, 0))):
        assert np.isfinite(unit_normals(np.array([pu], dtype=float), np.array([pv], dtype=float))).all() == has_normal


@pytest.mark.parametrize(
    ("values", "grids"),
    [
        ((1.0, 1 - 0.9e-7, 0.0), 2),
        ((1.0, 1 - 1.1e-7, 1 - 1.1e-7, 0.0), 3),
        ((-1.0, -1 - 0.9e-7, -2.0), 2),
        ((-1.0, -1 - 1.1e-7, -1.0, -2.0), 3),
        # Eight in all, however much the last one gains.
        (tuple(np.arange(20.0, 0, -1)), 8),
    ],
)
def test_finer_grids_end_where_they_gain_no_ten_millionth(values, grids):
    seen = []

    def value(u, v):
        seen.append(values[len(seen)])
        return np.full((len(u), len(v)), seen[-1])

    ends = np.array([0.0, 1.0])
    assert least_on_grid(value, ends, ends)[0] == min(values[:grids])
    assert len(seen) == grids
