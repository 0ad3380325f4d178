"""Iso-parametric and boundary curves: those of Open CASCADE pole by pole, and points of the surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.closed import sphere
from helpers.occ import to_geom
from helpers.splines import bspline_surfaces, semistructured_surfaces
from semispline import BSplineCurve, SemiStructuredSurface, boundary_curve, iso_curve
from semispline.solver.errors import InputError, OptionError
from semispline.solver.judge.de_boor import surface_points


def poles(curve):
    """Control points and weights of a curve of Open CASCADE."""
    points = [curve.Pole(i) for i in range(1, curve.NbPoles() + 1)]
    weights = [curve.Weight(i) for i in range(1, curve.NbPoles() + 1)]
    return np.array([[p.X(), p.Y(), p.Z()] for p in points]), np.array(weights)


@settings(max_examples=25)
@given(bspline_surfaces(), st.floats(0, 1), st.sampled_from("uv"))
def test_the_control_points_are_those_of_open_cascade(surface, where, name):
    geom = to_geom(surface)
    low, high = surface.domain["uv".index(name)]
    at = low + where * (high - low)
    curve = iso_curve(surface, **{name: at})
    points, weights = poles((geom.UIso if name == "u" else geom.VIso)(at))
    assert np.abs(curve.control_points - points).max() <= 1e-12
    if surface.weights is None:
        assert curve.weights is None
    else:
        # Open CASCADE scales the weights of an iso-parametric curve as it likes.
        assert np.ptp(curve.weights / weights) <= 1e-12 * (curve.weights / weights).max()


@pytest.mark.long
@settings(max_examples=25)
@given(semistructured_surfaces(), st.floats(0, 1), st.booleans())
def test_curves_of_a_semistructured_surface_lie_on_it(surface, where, rational):
    if rational:
        rng = np.random.default_rng(3)
        rows = [
            BSplineCurve(c.degree, c.knots, c.control_points, rng.uniform(0.5, 2, len(c.control_points)))
            for c in surface.control_curves
        ]
        # One row without weights among the others.
        surface = SemiStructuredSurface(surface.degree_u, surface.knots_u, (surface.control_curves[0], *rows[1:]))
    plain = surface.to_bspline()
    (u0, u1), (v0, v1) = surface.domain
    u, v = u0 + where * (u1 - u0), v0 + where * (v1 - v0)
    along_v, along_u = np.linspace(v0, v1, 17), np.linspace(u0, u1, 17)
    assert np.abs(iso_curve(surface, u=u).evaluate(along_v) - surface_points(plain, [u], along_v)).max() <= 1e-12
    assert np.abs(iso_curve(surface, v=v).evaluate(along_u) - surface_points(plain, along_u, [v])).max() <= 1e-12


def test_a_curve_has_only_the_knots_of_the_rows_that_act():
    rows = [
        BSplineCurve(1, [0, 0, *inner, 1, 1], np.column_stack([[i] * n, np.linspace(0, 1, n)]))
        for i, (inner, n) in enumerate([([0.25], 3), ([0.5], 3), ([0.75], 3)])
    ]
    surface = SemiStructuredSurface(1, [0, 0, 0.5, 1, 1], rows)
    assert iso_curve(surface, u=0.25).knots.tolist() == [0, 0, 0.25, 0.5, 1, 1]
    assert boundary_curve(surface, "u1").knots.tolist() == [0, 0, 0.75, 1, 1]


@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
def test_a_boundary_is_the_outer_row_or_column_to_the_last_digit(edge):
    rng = np.random.default_rng(1)
    ball = sphere(2.0)
    surface = type(ball)(2, 2, ball.knots_u, ball.knots_v, rng.uniform(0, 1, (9, 5, 3)), None)
    row = surface.control_points[-int(edge[1])] if edge[0] == "u" else surface.control_points[:, -int(edge[1])]
    assert np.array_equal(boundary_curve(surface, edge).control_points, row)


def test_a_pole_is_a_curve_of_one_point():
    assert np.array_equal(boundary_curve(sphere(2.0), "v1").control_points, np.tile([0, 0, 2.0], (9, 1)))


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (iso_curve, OptionError, "found u = None, v = None, expected one"),
        (lambda s: iso_curve(s, 0.5, 0.5), OptionError, "found u = 0.5, v = 0.5, expected one"),
        (lambda s: iso_curve(s, u=1.5), InputError, r"u\[0\]: found 1.5, expected a parameter in \[0.0, 1.0\]"),
        (lambda s: iso_curve(s, v="x"), InputError, "v: found 'x', expected a real number"),
        (lambda s: boundary_curve(s, "u2"), OptionError, "edge: found 'u2'"),
        (lambda s: boundary_curve([1], "u0"), InputError, "surface: found a list"),
    ],
)
def test_what_is_not_on_the_surface_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call(sphere(1.0))
