"""The referee against the definition: Cox-de Boor in exact fractions, at knots, ends, and for any order."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import (
    bspline_surfaces,
    curves,
    exact_curve,
    exact_point,
    parameters,
    scale,
    semistructured_surfaces,
)
from helpers.sweeps import examples
from semispline import BSplineSurface
from semispline.solver.judge.de_boor import curve_points, edge_curves, surface_points

# A value is a convex combination of control points: a few roundings for each of at most 12 levels, of both directions.
# Derivatives are measured against their own largest control point, so that narrow spans do not count against them.
TOLERANCE = 1e-13


@examples(60)
@given(curves(domain=(-2.0, 3.5)), st.integers(0, 2**32 - 1))
def test_curves_and_all_their_derivatives_are_those_of_the_definition(curve, seed):
    x = parameters(np.random.default_rng(seed), (-2.0, 3.5), curve.knots, count=2)
    for order in range(curve.degree + 2):
        found = curve_points(curve.degree, curve.knots, curve.control_points, x, order)
        exact = np.array(
            [[float(c) for c in exact_curve(curve.degree, curve.knots, curve.control_points, t, order)] for t in x]
        )
        widest = np.abs(exact).max() + np.abs(curve.control_points).max() * _factor(curve, order)
        assert np.abs(found - exact).max() <= TOLERANCE * widest


def _factor(curve, order):
    """What differencing `order` times over the narrowest support does to a rounding of the control points."""
    factor = 1.0
    for s in range(min(order, curve.degree)):
        p, t = curve.degree - s, curve.knots[s : len(curve.knots) - s]
        widths = t[1 + p : -1] - t[1 : -1 - p]
        factor *= 2 * p / widths[widths > 0].min()
    return factor


@examples(25)
@given(st.one_of(bspline_surfaces(degrees=(1, 3), most=1), semistructured_surfaces(degrees=(1, 3), most=1)), st.data())
def test_surfaces_are_those_of_the_definition(surface, data):
    (u0, u1), (v0, v1) = surface.domain
    u, v = data.draw(st.floats(u0, u1)), data.draw(st.floats(v0, v1))
    for du, dv in ((0, 0), (1, 0), (0, 1), (1, 1), (2, 1), (0, 4)):
        found = surface_points(surface, [u], [v], du, dv)[0]
        exact = np.array([float(c) for c in exact_point(surface, u, v, du, dv)])
        assert np.abs(found - exact).max() <= 10 * TOLERANCE * scale(surface, du, dv)


@examples(25)
@given(
    st.one_of(bspline_surfaces(degrees=(1, 3), most=1), semistructured_surfaces(degrees=(1, 3), most=1)),
    st.sampled_from(["u0", "u1", "v0", "v1"]),
    st.floats(0, 1),
)
def test_along_an_edge_all_derivatives_are_those_of_the_definition(surface, edge, t):
    (u0, u1), (v0, v1) = surface.domain
    across_u, at_end = edge[0] == "u", edge[1] == "1"
    u = (u1 if at_end else u0) if across_u else min(u0 + t * (u1 - u0), u1)
    v = (v1 if at_end else v0) if not across_u else min(v0 + t * (v1 - v0), v1)
    found = edge_curves(surface, edge).points(np.array([v if across_u else u]))
    assert len(found) == 6
    for (across, along), value in found.items():
        du, dv = (across, along) if across_u else (along, across)
        exact = np.array([float(c) for c in exact_point(surface, u, v, du, dv)])
        assert np.abs(value[0] - exact).max() <= 10 * TOLERANCE * scale(surface, du, dv)


@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
def test_along_an_edge_rational_surfaces_are_those_of_the_full_triangle(edge):
    # The whole net and both directions on one side, the rows next to the edge on the other.
    rng = np.random.default_rng(5)
    knots_u, knots_v = [0, 0, 0, 0.4, 1, 1, 1], [0, 0, 0, 0, 0.3, 0.3, 1, 1, 1, 1]
    surface = BSplineSurface(2, 3, knots_u, knots_v, rng.uniform(-1, 1, (4, 6, 3)), rng.uniform(0.5, 2, (4, 6)))
    s, at = np.linspace(0, 1, 11), np.full(11, float(edge[1]))
    for (across, along), value in edge_curves(surface, edge).points(s).items():
        full = (at, s, across, along) if edge[0] == "u" else (s, at, along, across)
        assert np.abs(value - surface_points(surface, *full)).max() <= 1e-11


def test_right_continuous_at_inner_knots_and_left_continuous_at_the_end():
    # Two straight pieces with a corner: slope 1, then -2.
    knots, points = np.array([0.0, 0, 1, 2, 2]), np.array([[0.0], [1.0], [-1.0]])
    slopes = curve_points(1, knots, points, np.array([0.0, 0.5, 1.0, 1.5, 2.0]), 1)
    assert slopes[:, 0].tolist() == [1, 1, -2, -2, -2]


def test_one_curve_for_each_parameter():
    points = np.array([[[0.0], [1.0]], [[0.0], [3.0]]])
    assert curve_points(1, np.array([0.0, 0, 1, 1]), points, np.array([0.5, 0.5])).ravel().tolist() == [0.5, 1.5]


@pytest.mark.parametrize("order", [3, 7])
def test_derivatives_above_the_degree_vanish(order):
    found = curve_points(2, np.array([0.0, 0, 0, 1, 1, 1]), np.ones((3, 3)), np.array([0.5]), order)
    assert found.tolist() == [[0, 0, 0]]


def test_points_where_no_order_is_asked_for_and_second_derivatives_along_an_edge():
    # X = (u^2, v, u v) from X(0) = (0, 0, 0).
    net = [[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0.5]], [[1, 0, 0], [1, 1, 1]]]
    surface = BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], net)
    assert surface_points(surface, [0.5], [0.25]).tolist() == [[0.25, 0.25, 0.125]]
    assert surface_points(surface, [0.5], [0.25], 1).tolist() == [[1, 0, 0.25]]
    curves = edge_curves(surface, "u0")
    keys = {(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)}
    for edge_points in (curves.points(np.array([0.25])), edge_curves(surface, "u0", 3).points(np.array([0.25]))):
        assert set(edge_points) == keys
    assert curves.points(np.array([0.25]))[2, 0].tolist() == [[2, 0, 0]]
    # Rows of the net: as many as second differences read.
    assert sum(row.control_points.shape[1] for row in curves.rows) == 3 * 3
    cubic = BSplineSurface(3, 1, [0] * 4 + [1] * 4, [0, 0, 1, 1], [[[x, y, 0] for y in (0, 1)] for x in range(4)])
    assert sum(row.control_points.shape[1] for row in edge_curves(cubic, "u0").rows) == 3 * 3
    assert sum(row.control_points.shape[1] for row in edge_curves(cubic, "u0", 3).rows) == 4 * 3
