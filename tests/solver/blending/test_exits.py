"""Exits against chords: angles that are known by construction."""

import numpy as np
import pytest

from semispline.solver.blending.exits import measure_exits
from semispline.solver.blending.sides import Side
from semispline.solver.splines import Basis

LINE = Basis(1, np.array([0.0, 0.0, 1.0, 1.0]))


def sides(*angles):
    """Two strips whose exits are turned from the chords, upwards, by angles in degrees at both ends of v."""
    found = []
    for x, outwards in ((0.0, 1.0), (1.0, -1.0)):
        edge = np.array([[x, 0.0, 0.0], [x, 1.0, 0.0]])
        exits = np.array([[outwards * np.cos(t), 0.0, np.sin(t)] for t in np.radians(angles)])
        found.append(Side("G1", 1, (1.0, 1.0), LINE, np.stack([edge, edge - exits, edge - exits]), 1.0))
    return found


@pytest.mark.parametrize("angle", [1.0, 60.0, 90.0, 120.0, 149.0])
def test_an_arc_over_its_chord(angle):
    theta = np.radians(angle)
    assert measure_exits(*sides(angle, angle)).arc == pytest.approx(theta / np.sin(theta), rel=1e-12)


@pytest.mark.parametrize("angle", [151.0, 179.0, 180.0])
def test_beyond_150_degrees_arcs_grow_no_more(angle):
    assert measure_exits(*sides(angle, angle)).arc == pytest.approx(np.radians(150) / 0.5, rel=1e-12)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5])
def test_straight_ahead_the_arc_is_the_chord(angle):
    assert measure_exits(*sides(angle, angle)).arc == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(("angle", "u_turn"), [(0.0, False), (89.9, False), (90.1, True), (180.0, True)])
def test_beyond_a_right_angle_it_is_a_u_turn(angle, u_turn):
    assert measure_exits(*sides(angle, angle)).u_turn is u_turn


def test_both_ends_of_v_count_alike():
    # The exit turns evenly round 45 degrees: the mean is in the middle.
    theta = np.pi / 4
    assert measure_exits(*sides(0.0, 90.0)).arc == pytest.approx(theta / np.sin(theta), rel=1e-12)
    assert not measure_exits(*sides(60.0, 119.0)).u_turn
    assert measure_exits(*sides(60.0, 121.0)).u_turn
