"""The largest turn within one window: known answers, and that it does not depend on the samples."""

import numpy as np
import pytest
from scipy.optimize import brentq

from helpers.shapes import arc, extruded, line, sheets, torus
from semispline import (
    BSplineSurface,
    InputError,
    insert_knots,
    measure_turn,
    swap_directions,
    transform,
)
from semispline.solver.judge.sections import angles, spread, turn_window, unit_normals
from semispline.solver.judge.turning import _turns_of_sections, turn_on_samples


def test_an_even_bend_turns_by_a_fiftieth():
    for degrees in (30.0, 100.0, 250.0):
        turn = measure_turn(extruded(arc((0, 0), 3.0, 0, degrees), 2.0))
        assert turn.degrees == pytest.approx(degrees / 50, rel=1e-3)
        assert turn.section == "v"
        assert turn.window == pytest.approx(3.0 * np.radians(degrees) / 50, rel=1e-9)


def bent(radius, degrees=90.0):
    """Two flaps of length 2 with a bend of a radius between them."""
    t = np.radians(degrees)
    end = radius * np.array([np.sin(t), 1 - np.cos(t)])
    bend = arc((0, radius), radius, -90, degrees - 90)
    return [*line((-2, 0), (0, 0)), *bend, *line(end, end + 2 * np.array([np.cos(t), np.sin(t)]))]


@pytest.mark.parametrize("along", ["u", "v"])
def test_a_bend_between_flaps(along):
    # A window holds a part of a wide bend and all of a narrow one.
    wide, narrow = (extruded(bent(radius), 1.0, along=along) for radius in (0.5, 0.01))
    for surface, radius in ((wide, 0.5), (narrow, 0.01)):
        turn = measure_turn(surface)
        expected = min(90.0, np.degrees(turn.window / radius))
        # Chords are shorter than arcs, and samples may begin late.
        assert turn.degrees == pytest.approx(expected, rel=2e-2)
        assert turn.section == ("v" if along == "u" else "u")
        start, end = turn.between
        assert 1 <= end <= 2.1
        assert 0.9 <= start <= 2


def test_where_it_is():
    turn = measure_turn(extruded(bent(0.01), 1.0))
    x, y, _ = turn.point
    assert np.hypot(x, y) < 0.1
    surface = extruded(bent(0.01), 1.0)
    assert surface.evaluate([turn.between[0]], [turn.at])[0] == pytest.approx(turn.point, abs=1e-12)


def test_a_fold_is_a_turn_above_90_degrees():
    assert not measure_turn(extruded(bent(0.001, 89.9), 1.0)).is_fold
    assert measure_turn(extruded(bent(0.001, 90.1), 1.0)).is_fold


def test_a_fold_in_the_plane_turns_by_180_degrees():
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    net = [[[x, y, 0.0] for y in (0, 1, 2, 3)] for x in (0, 3, -2, 1)]
    assert measure_turn(BSplineSurface(3, 3, knots, knots, net)).degrees == pytest.approx(180)


def test_a_closed_section_runs_on_over_its_seam():
    """A drop: two lines from its tip, where it closes, to an arc that they touch."""
    high, low = (1.5, np.sqrt(0.75)), (1.5, -np.sqrt(0.75))
    drop = [*line((0, 0), low), *arc((2, 0), 1.0, -120, 120), *line(high, (0, 0))]
    turn = measure_turn(extruded(drop, 1.0, along="v"))
    assert turn.degrees == pytest.approx(120, abs=1e-6)
    assert turn.section == "u"
    start, end = turn.between
    assert end < 0.1
    assert start > 3.9
    # The same with a gap at the tip: open, and without its corner. 1 / 50 of the width of 1 turns by 1 / 50.
    almost = [*line((0.01, -0.01 / np.sqrt(3)), low), *drop[1:]]
    assert measure_turn(extruded(almost, 1.0, along="v")).degrees == pytest.approx(np.degrees(1 / 50), rel=1e-2)


def test_torus_turns_fastest_around_its_tube():
    turn = measure_turn(torus(3.0, 1.0))
    assert turn.section == "v"
    assert turn.degrees == pytest.approx(360 / 50, rel=1e-3)


def test_a_flat_surface_turns_nowhere():
    k = [0, 0, 1, 1]
    flat = BSplineSurface(1, 1, k, k, [[[5, 0, 0], [5, 1, 0]], [[7, 0, 0], [7, 1, 0]]])
    turn = measure_turn(flat)
    assert turn.degrees == 0
    assert turn.point == (5, 0, 0)


def test_sections_without_length_are_refused():
    k = [0, 0, 1, 1]
    with pytest.raises(InputError, match="mean length 0"):
        measure_turn(BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0]]]))


@pytest.mark.long
def test_hardly_changes_when_samples_double():
    for surface in [*sheets(7, 8), extruded(bent(0.05), 1.0), extruded(bent(0.3), 1.0, along="v")]:
        once, twice = (turn_on_samples(surface, fineness).degrees for fineness in (1, 2))
        assert once == pytest.approx(twice, rel=0.03, abs=0.1)


def test_a_ridge_between_two_sections_is_looked_at_closely():
    # z = 3 u (1 - u) 9 B(v), B the third Bernstein polynomial of degree 6: sharpest across the top, at v = 1/3. There
    # the normal stays in a plane, and turns with the slope of a parabola; without a closer look 2 % are missed.
    u, v, top = np.arange(4) / 3, 20 * np.arange(7) / 6, np.zeros(7)
    top[2] = 9.0
    net = np.stack(np.broadcast_arrays(u[:, None], v[None], np.outer([0, 1, 1, 0], top)), axis=2)
    turn = measure_turn(BSplineSurface(3, 6, [0] * 4 + [1] * 4, [0] * 7 + [1] * 7, net))
    steep = 3 * 9 * 15 * (1 / 3) ** 2 * (2 / 3) ** 4

    def length(slope):
        return (slope * np.hypot(1, slope) + np.arcsinh(slope)) / (4 * steep)

    slope = brentq(lambda t: length(t) - turn.window / 2, 0, 100)
    assert turn.degrees == pytest.approx(2 * np.degrees(np.arctan(slope)), rel=1e-3)
    assert (turn.section, turn.at) == ("v", pytest.approx(1 / 3, abs=0.01))


@pytest.mark.slow
def test_rough_sheets_are_looked_at_closely():
    """Looked at once, two of these would be off by 1.6 % and more; the narrowest bend stays 1 % short."""
    for surface in sheets(5, 10, rough=0.5):
        assert measure_turn(surface).degrees == pytest.approx(turn_on_samples(surface, 6).degrees, rel=0.01)


def between_samples(surface):
    """The largest angle between normals of neighbours among 8 samples in every span."""
    u, v = (spread(breaks, 1, 8) for breaks in surface.breakpoints)
    n = unit_normals(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    return max(angles(n[1:], n[:-1]).max(), angles(n[:, 1:], n[:, :-1]).max())


def test_an_angle_between_samples_halves_and_this_one_does_not():
    """Knots at the middle of each span double the samples; the surface stays."""
    for surface in sheets(7, 4):
        spline = surface
        middles = [(b[:-1] + b[1:]) / 2 for b in spline.breakpoints]
        finer = insert_knots(spline, *middles)
        old = [between_samples(s) for s in (spline, finer)]
        assert 1.6 < old[0] / old[1] < 2.4
        assert measure_turn(finer).degrees == pytest.approx(measure_turn(spline).degrees, rel=0.03, abs=0.1)


def test_laws():
    surface = sheets(7, 1)[0]
    turn = measure_turn(surface)
    rotation = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    for same in (transform(surface, 1e3 * rotation, [5e3, -2, 7]), transform(surface, 1e-3 * np.eye(3))):
        assert measure_turn(same).degrees == pytest.approx(turn.degrees, rel=1e-9)
    # The window belongs to the sections v = const: it is another one in the other direction.
    swapped = swap_directions(surface)
    assert turn_window(swapped) != pytest.approx(turn_window(surface))


def along_a_line(degrees, window, *, closed=False):
    """Turns from samples that are 1 apart on a line, whose normals are at these angles; none where it is nan."""
    t = np.radians(degrees)
    points = np.arange(len(t))[:, None] * np.array([1.0, 0.0, 0.0])
    normals = np.stack([np.zeros(len(t)), np.sin(t), np.cos(t)], axis=-1)
    turns, ends = _turns_of_sections(np.arange(len(t)) * 1.0, points[None], normals[None], window, closed)
    return turns[0], ends[0]


def test_a_missing_normal_beside_the_end_of_a_window_has_no_say():
    # Windows that end at samples: at the one before the gap, at the one after it, and at the last one.
    turns, ends = along_a_line([0, 20, np.nan, 50, 60], 1.0)
    assert turns == pytest.approx([20, -1, -1, 10, -1], abs=1e-9)
    assert ends[[0, 3]].tolist() == [1, 4]
    # All of a short section.
    assert along_a_line([0, np.nan, 30], 10.0)[0] == pytest.approx([30, -1, -1], abs=1e-9)


def test_a_window_that_leaves_the_section_does_not_count():
    turns, _ = along_a_line([0, 0, 0, 0, 50], 3.5)
    # Half-way between 0 and 50 degrees; from the other samples 3.5 is too far.
    assert turns == pytest.approx([25, -1, -1, -1, -1], abs=1e-9)
    assert along_a_line([0, 0, 0, 0, 50], 4.0)[0][0] == pytest.approx(50)


def test_over_a_seam_a_window_reaches_all_samples_that_crowd_behind_it():
    lengths, t = np.array([0, 0.1, 0.2, 0.3, 0.4, 0.5, 2]), np.radians([0, 10, 20, 30, 40, 50, 0])
    normals = np.stack([np.zeros(7), np.sin(t), np.cos(t)], axis=-1)
    points = lengths[:, None] * np.array([1.0, 0.0, 0.0])
    (turns,), _ = _turns_of_sections(np.arange(7.0), points[None], normals[None], 0.45, True)
    # The last sample is the first.
    assert turns[-1] == pytest.approx(turns[0])
    assert turns[0] == pytest.approx(45)


def test_a_curve_has_no_turn():
    k = [0, 0, 1, 1]
    with pytest.raises(InputError, match="no tangent plane"):
        measure_turn(BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 0, 0]], [[1, 0, 0], [1, 0, 0]]]))
