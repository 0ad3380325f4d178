from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import bspline_surfaces, parameters, scale
from helpers.sweeps import examples
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.jets import surface_jet


@examples(40)
@given(bspline_surfaces(), st.integers(0, 4), st.integers(0, 2**32 - 1))
def test_derivatives_are_those_of_the_referee(surface, order, seed):
    rng = np.random.default_rng(seed)
    u, v = (
        parameters(rng, domain, breaks, 4) for domain, breaks in zip(surface.domain, surface.breakpoints, strict=True)
    )
    u, v = (x.ravel() for x in np.meshgrid(u, v))
    found = surface_jet(surface, u, v, order)
    assert sorted(found) == [(i, j) for i, j in product(range(order + 1), repeat=2) if i + j <= order]
    for (i, j), value in found.items():
        # Some hundred roundings of the largest control point of the derivative.
        assert np.abs(value - surface_points(surface, u, v, i, j)).max() <= 1e-13 * scale(surface, i, j)


@examples(20)
@given(bspline_surfaces(degrees=(1, 4)), st.integers(0, 2**32 - 1))
def test_on_a_knot_line_the_span_beside_it_is_meant(surface, seed):
    rng = np.random.default_rng(seed)
    v0, v1 = surface.domain[1]
    u, v = np.array(surface.breakpoints[0][1:-1]), rng.uniform(v0, v1)
    narrow = np.diff(surface.breakpoints[0]).min()
    for side in (-1, 1):
        step = side * 1e-7 * narrow
        found = surface_jet(surface, u, np.full_like(u, v), 1, (u + step, np.full_like(u, v)))[1, 0]
        inside = surface_points(surface, u + step, np.full_like(u, v), 1, 0)
        # The derivative changes by that of second order within the step.
        slack = 1e-12 * scale(surface, 1, 0) + 2 * abs(step) * scale(surface, 2, 0)
        assert np.abs(found - inside).max(initial=0.0) <= slack


def test_spans_go_on_beyond_the_domain():
    from semispline import BSplineSurface

    knots = [0, 0, 0, 1, 1, 1]
    net = [[[a, b, a * b] for b in (0, 0.5, 1)] for a in (0, 0.5, 1)]
    assert surface_jet(BSplineSurface(2, 2, knots, knots, net), np.array([1.5]), np.array([-2.0]), 0)[
        0, 0
    ] == pytest.approx(np.array([[1.5, -2.0, -3.0]]), abs=1e-14)
