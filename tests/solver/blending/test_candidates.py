"""Which layouts a fair blend tries, and which it takes."""

import numpy as np
import pytest

from helpers.facing import random_facing
from semispline import Base, BSplineSurface, OptionError, blend
from semispline.solver.blending import candidates
from semispline.solver.blending.linear_problem import gap_ratio
from semispline.solver.blending.pipeline import state_problem

CUBIC = [0, 0, 0, 0, 1, 1, 1, 1]


def wedge(ratio, *, gap=1.0):
    """Two bent sheets whose gap grows by a factor along v."""
    v, w = np.linspace(0, 1, 4), np.linspace(0, 1, 4)
    lower = [[[-0.8 * x, y, 0.1 * x * x - 0.3 * x] for y in v] for x in w]
    upper = [[[gap * (1 + (ratio - 1) * y) + 0.8 * x, y, 0.1 * x * x - 0.4 * x] for y in v] for x in w]
    return tuple(Base(BSplineSurface(3, 3, CUBIC, CUBIC, net), "u0") for net in (lower, upper))


def tried(result):
    return [(c.degree_u, c.middle_curves, c.alpha_v) for c in result.candidates]


def test_the_quintic_without_middle_curve_is_the_only_candidate_of_an_even_gap():
    result = blend(*wedge(1.1))
    assert tried(result) == [(5, 0, "constant")]
    assert result.candidates[0].verdict == "chosen"
    assert result.candidates[0].fairness == result.objective.value


@pytest.mark.parametrize(("ratio", "is_tried"), [(1.5 - 1e-6, False), (1.5 + 1e-6, True)])
def test_a_linear_alpha_is_tried_from_a_ratio_on(ratio, is_tried):
    assert ((5, 0, "linear") in tried(blend(*wedge(ratio)))) == is_tried


def test_a_wide_wedge_takes_a_linear_alpha_and_says_what_it_costs():
    result, constant = blend(*wedge(5.0)), blend(*wedge(5.0), alpha_v="constant")
    assert tried(result) == [(5, 0, "constant"), (5, 0, "linear")]
    assert [c.verdict == "chosen" for c in result.candidates] == [False, True]
    assert result.objective.value < 0.7 * constant.objective.value
    assert result.rows_converted > constant.rows_converted
    low, high = result.alpha2
    assert high > 1.5 * low > 0


@pytest.mark.parametrize("ratio", [2 - 1e-6, 2 + 1e-6])
def test_a_middle_curve_is_tried_where_linear_alpha_is_not_allowed_and_the_gap_varies(ratio):
    pair = wedge(ratio)
    assert (gap_ratio(state_problem(*pair).problem) >= candidates.MIDDLE_RATIO) == (ratio > 2)
    result = blend(*pair, alpha_v="constant")
    assert tried(result) == [(5, 0, "constant")] + [(5, 1, "constant")] * (ratio > 2)
    best = min(result.candidates, key=lambda c: c.fairness)
    assert best.verdict == "chosen"
    assert result.options.middle_curves == best.middle_curves
    # Said to be without, it is without.
    assert tried(blend(*pair, alpha_v="constant", middle_curves=0)) == [(5, 0, "constant")]


def test_where_nothing_is_searched_there_are_no_candidates():
    a, b = random_facing(np.random.default_rng(0))
    for options in ({"alpha": "energy"}, {"alpha": 0.7}, {"continuity": "C2"}, {"method": "casadi"}):
        assert blend(a, b, **options).candidates == ()


def test_closed_rims_refuse_a_linear_alpha():
    ring = np.array([[1.0, 0], [1, 1], [-1, 1], [-1, 0], [-1, -1], [1, -1], [1, 0]])
    knots = [0, 0, 0, 0.2, 0.4, 0.6, 0.8, 1, 1, 1]
    rows = [[[*(r * p), z] for p in ring] for r, z in ((1.0, 0.0), (1.2, -0.5), (1.3, -1.0))]
    tube = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], knots, rows)
    above = BSplineSurface(2, 2, [0, 0, 0, 1, 1, 1], knots, np.array(rows) * [1.5, 1.5, -1] + [0, 0, 1.5])
    with pytest.raises(OptionError, match="alpha_v: found linear on closed contacts, expected auto or constant"):
        blend(Base(tube, "u0"), Base(above, "u0"), alpha_v="linear")
