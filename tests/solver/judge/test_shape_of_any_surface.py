"""Whatever the surface, the measures of its shape answer or refuse, and do not change with what is no shape."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.shapes import sheets
from helpers.splines import surfaces
from helpers.sweeps import examples
from semispline import (
    BSplineSurface,
    InputError,
    map_domain,
    measure_curvature_range,
    measure_exits,
    measure_fairness,
    measure_loop,
    measure_meets,
    measure_turn,
    measure_waist,
    transform,
)

# A sweep over random surfaces: .ci/run has the time.
pytestmark = pytest.mark.slow

MEASURES = (
    measure_curvature_range,
    measure_exits,
    measure_fairness,
    measure_loop,
    measure_meets,
    measure_turn,
    measure_waist,
)


@examples(25)
@given(surfaces())
def test_crumpled_ones(surface):
    turn, loop, exits = measure_turn(surface), measure_loop(surface), measure_exits(surface)
    assert 0 <= turn.degrees <= 180
    assert loop.degrees <= loop.turning_degrees <= loop.largest_turning_degrees + 1e-9
    assert 0 <= exits.theta_0 <= 180
    assert -1 <= exits.side_cosine <= 1
    assert measure_fairness(surface).value >= 0
    curvature = measure_curvature_range(surface)
    assert curvature.least.value <= curvature.largest.value
    measure_waist(surface)
    for meeting in measure_meets(surface).found:
        # Confirmed on the surface itself.
        one, other = (surface.evaluate([u], [v])[0] for u, v in (meeting.uv, meeting.other))
        assert one == pytest.approx(other, abs=1e-10)
        assert meeting.uv != meeting.other


@pytest.mark.parametrize("measure", MEASURES)
def test_points_and_curves(measure):
    k = [0, 0, 0, 0, 1, 1, 1, 1]
    for net in (np.zeros((4, 4, 3)), np.arange(4)[:, None, None] * np.ones((4, 4, 3))):
        surface = BSplineSurface(3, 3, k, k, net)
        try:
            found = measure(surface)
        except InputError as error:
            assert str(error).startswith("surface: ")  # noqa: PT017 (refusing is one of two right answers)
        else:
            # A curve has sections all the same; fairness is beyond all bounds.
            assert measure in (measure_exits, measure_loop, measure_waist) or found.value == np.inf


@examples(6)
@given(st.integers(0, 10**6), st.sampled_from([1e-60, 1e-3, 1e60]))
def test_units_and_parameters(seed, unit):
    (surface,) = sheets(seed, 1)
    same = map_domain(transform(surface, unit * np.eye(3)), (-1e-12, 1e-12), (5.0, 1e12))
    before, after = ([measure(s) for measure in MEASURES] for s in (surface, same))
    curvature, exits, fairness, loop, meets, turn, _ = before
    assert after[0].largest.value * unit == pytest.approx(curvature.largest.value, rel=1e-4)
    assert after[1].theta_0 == pytest.approx(exits.theta_0, abs=1e-5)
    assert after[2].value == pytest.approx(fairness.value, rel=1e-4)
    assert after[3].degrees == pytest.approx(loop.degrees, abs=1e-4)
    assert after[4].seen_from == pytest.approx(meets.seen_from, abs=1e-5)
    assert after[5].degrees == pytest.approx(turn.degrees, rel=1e-4)
