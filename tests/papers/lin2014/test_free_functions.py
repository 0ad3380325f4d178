"""Blends whose alpha, beta, p_2 and q_2 are functions of v, against those that the solver makes."""

import numpy as np
import pytest

from semispline.papers.lin2014.checks.free_functions import FreeFunctions, function_space, greville
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.solver.blending import blend

PAPER = {"continuity": "G2", "degree_u": 3, "v_scale": "paper", "middle_knots": "paper", "middle_curves": 1}


@pytest.fixture(scope="module")
def least():
    return blend(*made_pair(), alpha="energy", **PAPER)


@pytest.fixture(scope="module")
def free(least):
    return FreeFunctions(least, function_space(()))


ONE, EVERY = np.ones((4, 1)), np.eye(4)
LINEAR = np.column_stack([np.ones(4), greville(function_space(()))])


def test_numbers_give_the_least_energy_of_the_solver(free, least):
    assert free.energy(ONE) == pytest.approx(least.energy, rel=1e-10)


def test_each_larger_space_has_less_energy(free):
    found = [
        free.energy(ONE),
        free.energy(LINEAR),
        free.energy(EVERY),
        free.energy(EVERY, EVERY),
        free.energy(EVERY, EVERY, EVERY),
    ]
    assert np.all(np.diff(found) < 0)


def test_blends_of_the_solver_have_no_less(free, least):
    a, b = least.alpha2, least.beta2
    # Near the least ones, which a wrong row or a wrong factor would miss by more than these do.
    for x in (-0.05, 0.05):
        shifted = blend(*made_pair(), alpha=(a**0.5, b**0.5), p2=(x * a**2, x * b**2), **PAPER).energy
        assert free.energy(ONE, ONE) <= shifted <= 1.001 * least.energy
    linear = blend(*made_pair(), alpha=((0.99 * a**0.5, 1.01 * a**0.5), (b**0.5, b**0.5)), **PAPER).energy
    assert free.energy(LINEAR) <= linear <= 1.02 * least.energy


def test_a_blend_without_a_middle_curve_is_refused():
    none = blend(*made_pair(), alpha="energy", **{**PAPER, "middle_curves": 0})
    with pytest.raises(ValueError, match="found 6 rows"):
        FreeFunctions(none, function_space(()))
