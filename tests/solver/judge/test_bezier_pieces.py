"""Surfaces in pieces: the same points and derivatives as the referee's, also at knots and for rows of all kinds."""

import numpy as np
import pytest
from hypothesis import given

from helpers.shapes import torus
from helpers.splines import surfaces
from helpers.sweeps import examples
from semispline import BSplineCurve, SemiStructuredSurface
from semispline.solver.judge.bezier_pieces import bernstein_by_degree, in_pieces
from semispline.solver.judge.de_boor import surface_points

ORDERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]


@examples(30)
@given(surfaces())
def test_points_and_derivatives_are_the_referees(surface):
    pieces = in_pieces(surface)
    assert pieces.domain == surface.domain
    # Inside of the spans: at a knot a derivative may jump.
    u, v = (np.concatenate([(x[:-1] + np.diff(x) * t) for t in (0.1, 0.5, 0.8)]) for x in surface.breakpoints)
    uu, vv = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
    # Points where nothing is said of an order.
    assert np.array_equal(pieces.evaluate(uu, vv), pieces.evaluate(uu, vv, 0, 0))
    assert np.array_equal(pieces.evaluate_grid(u, v), pieces.evaluate_grid(u, v, 0, 0))
    for du, dv in ORDERS:
        expected = surface_points(surface, uu, vv, du, dv)
        size = np.abs(expected).max()
        found = pieces.evaluate_grid(u, v, du, dv)
        assert found.shape == (len(u), len(v), 3)
        np.testing.assert_allclose(found.reshape(-1, 3), expected, atol=1e-9 * size + 1e-9)
        np.testing.assert_allclose(pieces.evaluate(uu, vv, du, dv), expected, atol=1e-9 * size + 1e-9)


def test_rows_of_other_degrees_and_knots_that_follow_a_knot():
    rng = np.random.default_rng(0)
    rows = [
        BSplineCurve(1, [0, 0, 1, 2, 2], rng.normal(size=(3, 3))),
        BSplineCurve(3, [0, 0, 0, 0, 2, 2, 2, 2], rng.normal(size=(4, 3))),
        BSplineCurve(2, [0, 0, 0, 1.5, 2, 2, 2], rng.normal(size=(4, 3))),
    ]
    surface = SemiStructuredSurface(2, [0, 0, 0, 1, 1, 1], rows)
    pieces = in_pieces(surface)
    # At a knot what follows it counts, at the end what precedes it; and in any order of parameters.
    u, v = np.array([0.0, 1.0, 0.3]), np.array([1.0, 0.0, 2.0, 1.5, 1.2])
    for du, dv in [*ORDERS, (3, 0), (2, 2), (0, 3)]:
        np.testing.assert_allclose(
            pieces.evaluate_grid(u, v, du, dv), surface.evaluate_grid(u, v, du, dv), rtol=1e-11, atol=1e-11
        )


def test_rational_surfaces_are_quotients_of_pieces():
    surface = torus(3.0, 1.0)
    pieces = in_pieces(surface)
    u, v = (np.linspace(start, end, 9) for start, end in surface.domain)
    for du, dv in [(3, 0), (2, 1), *ORDERS[::-1], (0, 3)]:
        expected = surface.evaluate_grid(u, v, du, dv)
        size = np.abs(expected).max()
        np.testing.assert_allclose(pieces.evaluate_grid(u, v, du, dv), expected, atol=1e-12 * size)
        np.testing.assert_allclose(pieces.evaluate(u, v, du, dv), surface.evaluate(u, v, du, dv), atol=1e-12 * size)
    assert in_pieces(pieces) is pieces


@pytest.mark.parametrize("degree", [0, 1, 3, 9])
def test_bernstein_polynomials(degree):
    t = np.linspace(0, 1, 11)
    values = bernstein_by_degree(degree, t)[degree]
    assert values.shape == (11, degree + 1)
    np.testing.assert_allclose(values.sum(axis=1), 1, rtol=1e-15)
    # They reproduce t, and at the ends the first and the last is one.
    np.testing.assert_allclose(values @ (np.arange(degree + 1) / max(degree, 1)), t if degree else 0 * t, atol=1e-15)
    assert (values[0, 0], values[-1, -1]) == (1, 1)
