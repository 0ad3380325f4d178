"""What a user should look at is a warning: steep turns and shape parameters at their bounds, from both sides."""

import re

import numpy as np
import pytest

from helpers.bases import facing_pair
from semispline import Base, BSplineSurface, FoldError, Regularity, blend
from semispline.solver.blending.warnings import shape_warnings
from semispline.solver.judge import Crease

LINE = [0, 0, 1, 1]
FLOOR = Base(BSplineSurface(1, 1, LINE, LINE, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]), "u1")
WALL = Base(BSplineSurface(1, 1, LINE, LINE, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]]), "u0")
# By hand, as the energy in test_close_knots: a quarter of the sum of M^-1 c, over c' M^-1 c.
BEST = 64 / 39
# Natural size: a gap of sqrt(2) over a speed of 1.
NATURAL = np.sqrt(2)


@pytest.mark.parametrize(
    ("turn", "bend", "said"),
    [
        (60.0, 0.0, None),
        (60.001, 0.0, "turns steeply"),
        (89.999, 0.0, "turns steeply"),
        (90.0, 0.0, "folds"),
        # A crease explains the rest.
        (100.0, 40.0, None),
        (100.0, 39.99, "turns steeply"),
    ],
)
def test_turns_from_both_sides(turn, bend, said):
    found = shape_warnings(Regularity(0.5, turn, None), (Crease("v", 0.5, bend),) if bend else ())
    found = [warning for warning in found if "creased" not in warning]
    assert len(found) == (said is not None)
    assert all(said in warning for warning in found)


def test_a_steep_turn_does_not_hide_a_pinch():
    found = shape_warnings(Regularity(1e-4, 75.0, None), ())
    assert ["steeply" in found[0], "pinched" in found[1]] == [True, True]


def test_a_blend_that_turns_steeply_is_warned_of_and_strict_refuses_it():
    a, b = facing_pair(np.random.default_rng(4))
    result = blend(a, b, alpha="natural")
    assert 60 < result.regularity.largest_turn_degrees < 90
    assert [w for w in result.warnings if "turns steeply" in w]
    with pytest.raises(FoldError, match="turns steeply"):
        blend(a, b, alpha="natural", strict=True)


@pytest.mark.parametrize("method", ["reduced", "casadi"])
@pytest.mark.parametrize(("low", "high", "which"), [(0.9, 0.99, "upper"), (1.01, 1.1, "lower"), (0.99, 1.01, None)])
def test_a_shape_parameter_at_its_bound_is_a_warning(method, low, high, which):
    box = (BEST / NATURAL * low, BEST / NATURAL * high)
    result = blend(FLOOR, WALL, box=box, method=method)
    if which is None:
        assert not result.active_bounds
        assert not result.warnings
        assert result.alpha2 == pytest.approx(BEST, rel=1e-6)
        return
    assert result.active_bounds == (f"alpha2 {which}", f"beta2 {which}")
    bound = BEST * (high if which == "upper" else low)
    assert [re.match(rf"(\w+) is at its {which} bound {bound:.3g}", w).group(1) for w in result.warnings] == [
        "alpha2",
        "beta2",
    ]
    with pytest.raises(FoldError, match=f"alpha2 is at its {which} bound"):
        blend(FLOOR, WALL, box=box, method=method, strict=True)


def test_shape_parameters_that_are_not_searched_have_no_bound_to_meet():
    for options in ({"alpha": "natural"}, {"alpha": 1.5}, {"continuity": "C2"}, {"continuity": "G0"}):
        result = blend(FLOOR, WALL, **options)
        assert not result.active_bounds
        assert not [w for w in result.warnings if "bound" in w]
