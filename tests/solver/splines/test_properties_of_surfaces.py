"""The listed properties, on random semi-structured surfaces with curves of different degrees and knots."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from helpers.sweeps import examples
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.surfaces import BSplineCurve, SemiStructuredSurface

# Weights are positive and sum to one up to rounding; control points are at most 1.
ROUNDING = 1e-13


@st.composite
def knot_vectors(draw, degree):
    inner = draw(st.lists(st.integers(1, 15), max_size=4, unique=True))
    repeats = [draw(st.integers(1, degree)) for _ in inner]
    return clamped(np.repeat(sorted(inner), repeats) / 16, degree, 0.0, 1.0)


@st.composite
def surfaces(draw):
    p = draw(st.integers(1, 4))
    knots_u = draw(knot_vectors(p))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    curves = []
    for _ in range(len(knots_u) - p - 1):
        q = draw(st.integers(1, 4))
        knots = draw(knot_vectors(q))
        curves.append(BSplineCurve(q, knots, rng.uniform(-1, 1, (len(knots) - q - 1, 3))))
    return SemiStructuredSurface(p, knots_u, tuple(curves)), rng


def with_points(surface, points):
    curves = (BSplineCurve(c.degree, c.knots, x) for c, x in zip(surface.control_curves, points, strict=True))
    return SemiStructuredSurface(surface.degree_u, surface.knots_u, tuple(curves))


@examples(30)
@given(surfaces())
def test_equal_control_points_give_that_point(case):
    surface, rng = case
    constant = with_points(surface, [np.full(c.control_points.shape, 0.75) for c in surface.control_curves])
    np.testing.assert_allclose(constant.evaluate(rng.random(20), rng.random(20)), 0.75, atol=ROUNDING)


@examples(30)
@given(surfaces())
def test_points_lie_in_the_hull_of_the_control_points_that_act_there(case):
    surface, rng = case
    p = surface.degree_u
    directions = rng.normal(size=(20, 3))
    for u, v in rng.random((10, 2)):
        i0 = np.searchsorted(surface.knots_u, u, side="right") - 1 - p
        acting = []
        for curve in surface.control_curves[i0 : i0 + p + 1]:
            j0 = np.searchsorted(curve.knots, v, side="right") - 1 - curve.degree
            acting.append(curve.control_points[j0 : j0 + curve.degree + 1])
        heights = np.concatenate(acting) @ directions.T
        height = surface.evaluate([u], [v])[0] @ directions.T
        assert (height <= heights.max(axis=0) + 10 * ROUNDING).all()
        assert (height >= heights.min(axis=0) - 10 * ROUNDING).all()


@examples(30)
@given(surfaces())
def test_affine_maps_of_control_points_map_the_surface(case):
    surface, rng = case
    matrix, shift = rng.uniform(-2, 2, (3, 3)), rng.uniform(-5, 5, 3)
    mapped = with_points(surface, [c.control_points @ matrix.T + shift for c in surface.control_curves])
    u, v = rng.random(20), rng.random(20)
    np.testing.assert_allclose(mapped.evaluate(u, v), surface.evaluate(u, v) @ matrix.T + shift, atol=20 * ROUNDING)


@examples(40)
@given(surfaces(), st.data())
def test_a_control_point_acts_on_its_rectangle_and_nowhere_else(case, data):
    surface, rng = case
    i = data.draw(st.integers(0, len(surface.control_curves) - 1))
    curve = surface.control_curves[i]
    j = data.draw(st.integers(0, len(curve.control_points) - 1))
    points = [c.control_points.copy() for c in surface.control_curves]
    points[i][j] += [0.0, 0.0, 1000.0]
    u0, u1 = surface.knots_u[[i, i + surface.degree_u + 1]]
    v0, v1 = curve.knots[[j, j + curve.degree + 1]]
    u, v = rng.random(200), rng.random(200)
    change = with_points(surface, points).evaluate(u, v)[:, 2] - surface.evaluate(u, v)[:, 2]
    inside = (u > u0) & (u < u1) & (v > v0) & (v < v1)
    # Outside, the very same numbers are added up; inside, the function is positive, if small towards the edges.
    assert (change[~inside] == 0).all()
    middle = with_points(surface, points).evaluate([(u0 + u1) / 2], [(v0 + v1) / 2])[0, 2]
    assert middle > surface.evaluate([(u0 + u1) / 2], [(v0 + v1) / 2])[0, 2] + 1e-6


@examples(30)
@given(st.integers(2, 4), st.integers(0, 2**32 - 1), st.data())
def test_the_continuity_of_one_curve_shows_over_its_support_alone(q, seed, data):
    # Eight curves, all but one without a knot at 1/2; that one is C^(q-r) there.
    r = data.draw(st.integers(1, q))
    p, knots_u = 2, clamped(np.arange(1, 6) / 6, 2, 0.0, 1.0)
    rng = np.random.default_rng(seed)
    kinked = data.draw(st.integers(0, 7))
    curves = []
    for i in range(8):
        knots = clamped([0.5] * r if i == kinked else [0.25], q, 0.0, 1.0)
        curves.append(BSplineCurve(q, knots, rng.uniform(-1, 1, (len(knots) - q - 1, 3))))
    surface = SemiStructuredSurface(p, knots_u, tuple(curves))
    u = rng.random(40)
    before = np.full(40, np.nextafter(0.5, 0))
    after = np.full(40, 0.5)

    def jump(d):
        return np.abs(surface.evaluate(u, after, 0, d) - surface.evaluate(u, before, 0, d)).max(axis=1)

    # The step to the neighbouring float moves a derivative by rounding only; a derivative is below 1e4 here.
    for d in range(q - r + 1):
        assert (jump(d) < 1e-10).all()
    first = jump(q - r + 1)
    inside = (u > knots_u[kinked]) & (u < knots_u[kinked + p + 1])
    assert (first[~inside] < 1e-10).all()
    one = curves[kinked]
    size = np.abs(one.evaluate([0.5], q - r + 1) - one.evaluate([np.nextafter(0.5, 0)], q - r + 1)).max()
    weight = BSplineCurve(p, knots_u, np.eye(8)[kinked][:, None] * np.ones(3)).evaluate(u)[:, 0]
    np.testing.assert_allclose(first, weight * size, atol=1e-9)
