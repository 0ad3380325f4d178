"""When the solve of the free rows is refined, how long, and when it is believed: from both sides."""

import contextlib
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.bases import facing_pair
from helpers.papers_set import state_problem
from semispline import ComputationError
from semispline.solver.blending.free_system import FreeSystem, _fraction


class Falling:
    """A factorised system whose corrections fall by a factor each time, the first one from a start on."""

    def __init__(self, factor, solved, start=1.0):
        self.factor, self.solved, self.start, self.calls = factor, solved, start, 0

    def solve(self, right):
        self.calls += 1
        # The solution, then the first correction, then refinements.
        return self.solved * (1.0 if self.calls == 1 else self.start * self.factor ** (self.calls - 2))


@pytest.mark.parametrize(
    ("factor", "start", "refinements"),
    [
        # Down to 1e-12, or while they halve, or twenty times.
        (0.1, 0.95e-3, 9),
        (0.1, 1.05e-3, 10),
        (1e-4, 1e-5, 2),
        (0.49, 1e-5, 20),
        (0.51, 1e-5, 2),
        (2.0, 1e-5, 2),
    ],
)
def test_refinement_goes_on_while_corrections_halve(factor, start, refinements):
    system = state_problem(*facing_pair(np.random.default_rng(0))).problem.free_system
    system.factor = Falling(factor, np.ones((system.size, 3)), start)
    points = np.zeros((system.offsets[-1], 3))
    with contextlib.suppress(ComputationError):
        system.completed(points)
    assert system.factor.calls == 2 + refinements


def system_of(moves, gradient=0.0, energy=1.0):
    """A system of one free point beside one that is 1, whose corrections are given."""
    left = iter(moves)

    def with_free(points, x):
        filled = points.copy()
        filled[:1] = x
        return filled

    form = SimpleNamespace(
        gradient=lambda points: np.full_like(points, gradient), products=lambda layers: np.array([[energy]])
    )
    return SimpleNamespace(
        form=form, free=slice(0, 1), _with_free=with_free, _correction=lambda _: np.full((1, 3), -next(left))
    )


POINTS = np.array([[0.5] * 3, [1.0] * 3])


def smooth_rows(step=0.0, lower=0.0):
    return SimpleNamespace(correction=lambda gradient: (np.full((1, 3), step), lower))


@pytest.mark.parametrize(
    ("left", "step", "is_refined"),
    [(0.9e-8, 0.0, False), (0.9e-8, 0.9e-8, False), (1.1e-8, 0.0, True), (0.0, 1.1e-8, True), (0.0, -1.1e-8, True)],
)
def test_smooth_rows_are_asked_for_more_where_they_show_the_need(left, step, is_refined):
    moves = iter([1e-3] * 9)
    filled, found = FreeSystem._smoothed(system_of(moves), POINTS, left, smooth_rows(step))
    if is_refined:
        # Begun anew, from 0.
        assert len(list(moves)) == 7
        assert filled[0, 0] != 0.5
    else:
        assert len(list(moves)) == 9
        assert (filled is POINTS, found) == (True, left)


@pytest.mark.parametrize(
    ("start", "factor", "steps"),
    [(0.95e-3, 0.1, 10), (1.05e-3, 0.1, 11), (1e-3, 0.49, 20), (1e-3, 0.51, 2), (1e-3, 1.0, 2), (0.9e-12, 0.1, 1)],
)
def test_steps_in_turn_go_on_while_they_halve(start, factor, steps):
    moves = iter([start * factor**k for k in range(30)])
    FreeSystem._smoothed(system_of(moves), POINTS, 1.0, smooth_rows())
    assert 30 - len(list(moves)) == steps


@pytest.mark.parametrize(
    ("moves", "gradient", "lower", "energy", "left"),
    [
        # The last move; or what it and the smooth rows save of the energy, the larger one, where that is less.
        ([1e-3, 1e-3], 0.0, 1e3, 1.0, 1e-3),
        ([1e-3, 1e-3], 0.0, 1e-5, 1.0, 1e-5),
        ([1e-3, 1e-3], 0.0, -1e-5, 1.0, 1e-5),
        ([1e-3, 1e-3], 0.0, -1e-5, 4.0, 0.25e-5),
        ([1e-3, 1e-3], 0.01, 1e-7, 1.0, 3e-5),
        ([1e-3, 1e-3], -0.01, 1e-7, 1.0, 3e-5),
        ([1e-3, 1e-3], 0.01, 1e-4, 2.0, 0.5e-4),
        ([1e-3, 1e-3], 0.0, 0.0, 0.0, 0.0),
        ([-1e-3, 1e-3], 0.0, 1.0, 1.0, 1e-3),
    ],
)
def test_what_is_left_is_the_move_or_the_energy(moves, gradient, lower, energy, left):
    _, found = FreeSystem._smoothed(system_of(moves, gradient, energy), POINTS, 1.0, smooth_rows(0.0, lower))
    assert found == pytest.approx(left, rel=1e-12)


def test_a_fraction_is_of_the_largest_entries_and_of_nothing_it_is_nothing():
    assert _fraction(np.array([0.1, -0.3]), np.array([1.0, -2.0])) == pytest.approx(0.15)
    assert _fraction(np.zeros(2), np.zeros(2)) == 0.0
