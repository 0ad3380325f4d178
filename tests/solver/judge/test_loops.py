"""Loops, exits and U-turns: profiles of arcs, whose turning is known, extruded."""

import numpy as np
import pytest

from helpers.shapes import arc, extruded, line, sheets, torus
from semispline import BSplineSurface, measure_exits, measure_loop, reverse_u, reverse_v, transform
from semispline.solver.blending.refusals import needed_turn
from semispline.solver.judge.loops import loop_on_samples


def arch(degrees):
    return extruded(arc((0, 0), 1.0, 0, degrees), 1.0)


def ess(degrees):
    """Two arcs, one after the other, bent to opposite sides."""
    t = np.radians(degrees)
    return extruded([*arc((0, 0), 1.0, 0, degrees), *arc((2 * np.cos(t), 2 * np.sin(t)), 1.0, degrees + 180, 180)], 1.0)


@pytest.mark.parametrize("degrees", [20, 100, 170, 200, 300])
def test_an_arch_turns_as_its_exits_ask(degrees):
    loop = measure_loop(arch(degrees))
    assert loop.turning_degrees == pytest.approx(degrees, rel=1e-9)
    assert loop.needed_degrees == pytest.approx(degrees, rel=1e-9)
    assert loop.degrees == pytest.approx(0, abs=1e-6)
    exits = measure_exits(arch(degrees))
    assert [exits.theta_0, exits.theta_1] == pytest.approx([degrees / 2] * 2)
    assert exits.mean_cosine == pytest.approx(np.cos(np.radians(degrees / 2)))
    assert (exits.sides, exits.side_cosine) == ("same", pytest.approx(1))
    assert exits.is_u_turn == (degrees > 180)
    assert not exits.must_loop


@pytest.mark.parametrize("degrees", [20, 90, 140])
def test_an_ess_turns_as_its_exits_ask(degrees):
    """Four times theta: T - theta_0 - theta_1, as tempting, would make a loop of it from 60 degrees on."""
    loop = measure_loop(ess(degrees))
    assert loop.turning_degrees == pytest.approx(2 * degrees, rel=1e-9)
    assert loop.degrees == pytest.approx(0, abs=1e-6)
    exits = measure_exits(ess(degrees))
    assert [exits.theta_0, exits.theta_1] == pytest.approx([degrees / 2] * 2)
    assert (exits.sides, exits.side_cosine) == ("opposite", pytest.approx(-1))
    assert loop.turning_degrees - exits.theta_0 - exits.theta_1 == pytest.approx(degrees)


def test_an_exit_may_be_reached_the_other_way_round():
    # theta = 135 at both ends, to opposite sides: 540 by the formula, 360 with one of them taken as -225.
    loop = measure_loop(ess(270))
    assert loop.turning_degrees == pytest.approx(540, rel=1e-9)
    assert loop.needed_degrees == pytest.approx(360, rel=1e-9)
    assert measure_exits(ess(270)).must_loop
    assert not measure_exits(ess(100)).must_loop


def wave(degrees):
    """A line, a wave that turns by four times an angle in all, and the line again."""
    s, c = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    rise = [*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, degrees - 90)]
    top = arc((2 * s, 1 - 2 * c), 1.0, 90 + degrees, 90 - degrees)
    fall = [*arc((4 * s, 1), 1.0, -90 - degrees, -90), *line((4 * s, 0), (4 * s + 2, 0))]
    return extruded([*rise, *top, *fall], 1.0)


def test_the_limit_from_both_sides():
    for degrees, is_loop in ((14.99, False), (15.01, True)):
        loop = measure_loop(wave(degrees))
        assert loop.degrees == pytest.approx(4 * degrees, abs=1e-6)
        assert loop.needed_degrees == pytest.approx(0, abs=1e-6)
        assert loop.is_loop is is_loop
        assert measure_exits(wave(degrees)).sides is None


def test_a_loop():
    loop = measure_loop(extruded([*line((-2, 0), (0, 0)), *arc((0, 1), 1.0, -90, 270), *line((0, 0), (2, 0))], 1.0))
    assert loop.degrees == pytest.approx(360, abs=1e-6)
    assert loop.is_loop


def test_a_section_that_ends_where_it_begins_is_a_loop():
    loop = measure_loop(torus(3.0, 1.0, around=(0, 90)))
    assert loop.degrees == pytest.approx(360, abs=1e-6)
    assert loop.largest_turning_degrees == loop.turning_degrees


def test_the_worst_section_is_named():
    """From a line at v = 0 to a full wave at v = 1."""
    knots = [0] * 4 + [1] * 4
    flat = [[x, 0, 0] for x in (0, 1, 2, 3)]
    bent = [[x, 1, z] for x, z in ((0, 0), (4, 3), (-1, 3), (3, 0))]
    surface = BSplineSurface(3, 1, knots, [0, 0, 1, 1], np.stack([flat, bent], axis=1))
    loop = measure_loop(surface)
    # The bent one crosses itself; on the way there one has nearly a cusp, and turns further.
    assert loop.is_loop
    assert 0.5 < loop.v < 1
    assert measure_loop(reverse_v(surface)).v == pytest.approx(1 - loop.v)
    assert loop.largest_turning_degrees > 180


def test_few_samples_turn_nearly_as_many():
    for surface in sheets(11, 8, rough=0.15):
        v = np.linspace(0, 1, 21)
        fine = loop_on_samples(surface, np.linspace(0, 1, 2001), v)
        assert measure_loop(surface).largest_turning_degrees == pytest.approx(fine.largest_turning_degrees, abs=1.5)


@pytest.mark.parametrize("seed", range(3))
def test_a_section_of_one_span_is_sampled_as_finely(seed):
    rng = np.random.default_rng(seed)
    points = np.column_stack([np.arange(8), 3 * rng.normal(size=(8, 2))])
    net = np.stack([points, points + np.array([0, 0, 0.1])], axis=1)
    surface = BSplineSurface(7, 1, [0] * 8 + [1] * 8, [0, 0, 1, 1], net)
    fine = loop_on_samples(surface, np.linspace(0, 1, 2001), np.linspace(0, 1, 21))
    assert measure_loop(surface).largest_turning_degrees == pytest.approx(fine.largest_turning_degrees, abs=1.5)


def test_ends_without_speed_have_the_next_tangent():
    knots = [0] * 4 + [1] * 4
    net = [[[x, y, z] for y in (0, 1)] for x, z in ((0, 0), (0, 0), (1, 1), (2, 1))]
    exits = measure_exits(BSplineSurface(3, 1, knots, [0, 0, 1, 1], net))
    # It leaves towards (1, 1), its chord is along (2, 1).
    assert exits.theta_0 == pytest.approx(45 - np.degrees(np.arctan2(1, 2)), abs=3)


def test_laws():
    surface = sheets(2, 1, arch=1.5)[0]
    loop, exits = measure_loop(surface), measure_exits(surface)
    rotation = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    for same in (transform(surface, 1e3 * rotation, [5e3, -2, 7]), transform(surface, 1e-3 * np.eye(3))):
        assert measure_loop(same).degrees == pytest.approx(loop.degrees, abs=1e-6)
        assert measure_exits(same).side_cosine == pytest.approx(exits.side_cosine, abs=1e-6)
    back = measure_exits(reverse_u(surface))
    assert [back.theta_0, back.theta_1] == pytest.approx([exits.theta_1, exits.theta_0])
    assert measure_loop(reverse_u(surface)).degrees == pytest.approx(loop.degrees, abs=1e-6)


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-6])
def test_exits_straight_away_from_the_chord_need_a_full_turn(tilt):
    points = [(0, 0), (-1, tilt), (-1, 1.5), (2, 1.5), (2, tilt), (1, 0)]
    net = [[(x, y, z) for y in (0, 1)] for x, z in points]
    loop = measure_loop(BSplineSurface(5, 1, [0] * 6 + [1] * 6, [0, 0, 1, 1], net))
    assert loop.needed_degrees == pytest.approx(360.0, abs=1e-3)
    assert loop.degrees == pytest.approx(0.0, abs=1e-3)
    # The search has a formula of its own.
    away = np.array([[-1.0], [0.0], [tilt]]) / np.hypot(1, tilt)
    back = away * [[1], [1], [-1]]
    assert needed_turn(away, back, np.array([[1.0], [0], [0]])) == pytest.approx(2 * np.pi, abs=1e-5)


@pytest.mark.parametrize(("degrees", "sides"), [(1.9, None), (2.1, "same")])
def test_exits_within_a_degree_of_the_chord_lead_to_no_side(degrees, sides):
    exits = measure_exits(arch(degrees))
    assert (exits.sides, exits.side_cosine) == (sides, pytest.approx(1 if sides else 0))


@pytest.mark.parametrize(("part", "theta"), [(0.8e-12, 0), (1.2e-12, 90)])
def test_an_end_slower_than_a_million_millionth_has_the_next_tangent(part, theta):
    # It is fastest at its end, with a speed of 6; it begins sideways.
    net = [[[x, y, z] for z in (0, 1)] for x, y in ((0, 0), (0, 2 * part), (1, 0), (3, 0))]
    exits = measure_exits(BSplineSurface(3, 1, [0] * 4 + [1] * 4, [0, 0, 1, 1], net))
    assert exits.theta_0 == pytest.approx(theta, abs=0.1)


@pytest.mark.parametrize(("part", "has_chord"), [(0.5e-9, False), (2e-9, True)])
def test_ends_a_billionth_apart_have_no_chord(part, has_chord):
    # What is farthest from the start of a circle is two radii away.
    loop = measure_loop(arch(360 - np.degrees(2 * part)))
    assert loop.turning_degrees == pytest.approx(360, abs=1e-5)
    assert loop.needed_degrees == pytest.approx(360 if has_chord else 0, abs=1e-3)


def test_exits_square_to_each_other_lead_to_no_side():
    net = [[[x, y + v, z] for v in (0, 1)] for x, y, z in ((0, 0, 0), (1, 1, 0), (2, 0, 1), (3, 0, 0))]
    exits = measure_exits(BSplineSurface(3, 1, [0] * 4 + [1] * 4, [0, 0, 1, 1], net))
    assert (exits.sides, exits.side_cosine) == (None, 0)
