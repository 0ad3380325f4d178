"""Two closed contact curves: where their seams face each other, and that neither seam nor order shows in the blend."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from helpers.bases import tube
from helpers.papers_set import blend
from helpers.sweeps import examples, first_ones
from semispline import Base
from semispline.solver.blending.closing import with_least_size
from semispline.solver.judge.correspondence import SNAP, correspond
from semispline.solver.judge.de_boor import curve_points
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.quadrature import Basis

# Of the size of the pairs here, about 4.
TOLERANCE = 4e-9


@dataclass(frozen=True)
class Tubes:
    """Spans, degrees, angle between the seams, dents and direction of a pair."""

    spans: tuple[int, int]
    phase: float
    noise: float = 0.02
    degrees: tuple[int, int] = (3, 3)
    backwards: bool = False

    def bases(self, seed=0):
        rng = np.random.default_rng(seed)
        a = tube(rng, self.spans[0], degree=self.degrees[0], noise=self.noise)
        b = tube(
            rng,
            self.spans[1],
            degree=self.degrees[1],
            radius=1.5,
            heights=(4.0, 3.0),
            phase=self.phase,
            noise=self.noise,
            backwards=self.backwards,
            v_range=(2.0, 5.0),
        )
        return Base(a, "u1"), Base(b, "u1")


CASES = [
    Tubes((8, 8), 0.7, noise=0.0),
    Tubes((10, 7), 2.1, backwards=True),
    Tubes((12, 9), 3.0, noise=0.03, degrees=(3, 4)),
    Tubes((8, 8), 2 * np.pi * 3 / 8, noise=0.0),
    Tubes((6, 11), -1.0, degrees=(2, 3), backwards=True),
]


def farthest_apart(one, other):
    """How far the blends of (a, b) and of (b, a) are apart, from b's seam on, u run backwards."""
    (v0, v1), (w0, w1) = one.surface.domain[1], other.surface.domain[1]
    u, t = np.linspace(0, 1, 9), np.arange(60) / 60
    there = (1 - t if one.flipped else t) + one.seam_shift / (w1 - w0)
    here = one.surface.evaluate_grid(u, v0 + t * (v1 - v0))
    return np.abs(here - other.surface.evaluate_grid(1 - u, w0 + there % 1.0 * (w1 - w0))).max()


@pytest.mark.parametrize("v_scale", first_ones(1, ["length", "unit"]))
@pytest.mark.parametrize("options", [{}, {"middle_curves": 0}, {"middle_curves": 3}, {"alpha": "natural"}])
@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_blend_does_not_depend_on_the_order_of_the_bases(case, options, v_scale):
    a, b = case.bases()
    one, other = blend(a, b, v_scale=v_scale, **options), blend(b, a, v_scale=v_scale, **options)
    assert one.seam_shift != 0
    assert one.flipped == other.flipped == case.backwards
    assert farthest_apart(one, other) < TOLERANCE


@pytest.mark.long
@given(st.tuples(st.integers(5, 11), st.integers(5, 11)), st.floats(-3.0, 3.0), st.booleans(), st.integers(0, 10**6))
@examples(10)
def test_the_order_does_not_matter_for_random_tubes(spans, phase, backwards, seed):
    a, b = Tubes(spans, phase, backwards=backwards).bases(seed)
    one, other = blend(a, b, v_scale="length"), blend(b, a, v_scale="length")
    assert farthest_apart(one, other) < TOLERANCE


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_seams_face_where_the_curves_match_best(case):
    a, b = case.bases()
    (v0, v1), (w0, w1) = a.range_along, b.range_along
    t = np.arange(20000) / 20000
    on_a = curve_points(case.degrees[0], a.surface.knots_v, a.surface.control_points[-1], v0 + t * (v1 - v0))

    def slope(shift):
        """Of the correlation, by the trapezoidal rule: its error falls as the curves are smooth."""
        w = w0 + np.mod((-t if case.backwards else t) * (w1 - w0) + shift, w1 - w0)
        along = curve_points(case.degrees[1], b.surface.knots_v, b.surface.control_points[-1], w, 1)
        return float(np.sum((on_a - on_a.mean(axis=0)) * along))

    matched = correspond(a, b)
    assert matched.flipped == case.backwards
    best = brentq(slope, matched.shift - 0.1, matched.shift + 0.1, xtol=1e-12)
    assert slope(best - 0.1) > 0 > slope(best + 0.1)
    assert matched.shift == pytest.approx(best, abs=1e-8)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("off", [0.5 * SNAP, -0.5 * SNAP, 1e-7, 1e-11])
def test_a_seam_close_to_a_knot_is_moved_onto_it(off, swapped):
    # Without dents the tubes turn into themselves: seams match where the angles do. There are 8 knots on each.
    a, b = Tubes((8, 8), 2 * np.pi * (3 / 8 - off), noise=0.0).bases()
    if swapped:
        # The range of v is 1, and the shift the other way.
        assert blend(b, a).seam_shift == pytest.approx(3 / 8, abs=1e-14)
    else:
        assert blend(a, b).seam_shift == pytest.approx(3 * 5 / 8, abs=1e-14)


@pytest.mark.parametrize("continuity", ["C0", "G2"])
@pytest.mark.parametrize("off", [0.01, 3e-4, 1.01 * SNAP])
def test_a_seam_beyond_stays_where_it_is_and_is_smooth(off, continuity):
    a, b = Tubes((8, 8), 2 * np.pi * (3 / 8 - off), noise=0.0).bases()
    result = blend(a, b, continuity=continuity)
    assert result.seam_shift / 3 - 5 / 8 == pytest.approx(off, rel=1e-4)
    # A span of 1e-4 amplifies the rounding of control points by 1e8.
    assert result.seam.c2_residual < 1e-7
    assert result.seam.curvature_jump_relative < 1e-7


def test_longest_spans_are_halved_together():
    basis = with_least_size(Basis(3, clamped([0.2, 0.6], 3, 0.0, 1.0)), 7)
    np.testing.assert_allclose(basis.knots[4:-4], [0.2, 0.4, 0.6, 0.8])
