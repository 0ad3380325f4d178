"""Length and area: known shapes, Open CASCADE, and an error that is not smaller than the true one."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from scipy.integrate import quad

from helpers.closed import circle, cylinder, sphere, torus
from helpers.occ import to_geom
from helpers.splines import curves
from semispline import BSplineCurve, BSplineSurface, SemiStructuredSurface, curve_length, extrude, surface_area
from semispline.solver.errors import InputError, OptionError
from semispline.solver.judge.de_boor import surface_points


@pytest.mark.parametrize(
    ("surface", "area"),
    [
        (cylinder(2.0, 5.0), 20 * np.pi),
        (sphere(3.0), 36 * np.pi),
        (torus(5.0, 1.0), 20 * np.pi**2),
    ],
)
def test_areas_of_elementary_surfaces(surface, area):
    found = surface_area(surface)
    assert abs(found.value - area) <= found.error <= 1e-12 * area + 2e-14 * area


def test_the_circumference_of_a_circle():
    found = curve_length(circle(3.0))
    assert abs(found.value - 6 * np.pi) <= found.error <= 2e-12


def test_a_coarse_tolerance_is_stated_as_such_and_costs_less():
    rough, fine = (surface_area(torus(5.0, 1.0), tolerance) for tolerance in (1e-3, 1e-12))
    assert 1e-13 * fine.value < rough.error <= 1e-3 * fine.value
    assert abs(rough.value - fine.value) <= rough.error


@pytest.mark.long
@settings(max_examples=15)
@given(curves(degrees=(1, 4)))
def test_lengths_agree_with_adaptive_quadrature(curve):
    found = curve_length(curve, 1e-10)
    breaks = np.unique(curve.knots)
    expected = sum(
        quad(lambda t: np.linalg.norm(curve.evaluate([t], 1)), low, high, epsabs=1e-11, limit=200)[0]
        for low, high in pairwise(breaks)
    )
    assert abs(found.value - expected) <= found.error + 1e-9 * expected


def _by_gauss(surface, n):
    """One fine rule on every span, by the referee's evaluation."""
    x, w = np.polynomial.legendre.leggauss(n)
    total = 0.0
    for (a, b), (c, d) in product(*(pairwise(np.unique(t)) for t in (surface.knots_u, surface.knots_v))):
        u, v = np.repeat((a + b) / 2 + (b - a) / 2 * x, n), np.tile((c + d) / 2 + (d - c) / 2 * x, n)
        normals = np.cross(surface_points(surface, u, v, 1, 0), surface_points(surface, u, v, 0, 1))
        total += np.linalg.norm(normals, axis=1) @ np.outer(w, w).ravel() * (b - a) * (d - c) / 4
    return total


@pytest.mark.parametrize("rational", [False, True])
def test_areas_agree_with_open_cascade(rational):
    rng = np.random.default_rng(2)
    x, y = np.meshgrid(np.linspace(0, 3, 6), np.linspace(0, 2, 5), indexing="ij")
    net = np.dstack([x, y, rng.uniform(0, 1, x.shape)])
    knots = [0, 0, 0, 0, 0.3, 0.6, 1, 1, 1, 1], [0, 0, 0, 0.4, 0.4, 1, 1, 1]
    surface = BSplineSurface(3, 2, *knots, net, rng.uniform(0.5, 2, x.shape) if rational else None)
    properties = GProp_GProps()
    face = BRepBuilderAPI_MakeFace(to_geom(surface), 1e-9).Face()
    # Without this last argument it is off by a thousandth.
    BRepGProp.SurfaceProperties_s(face, properties, 1e-12, False)
    found = surface_area(surface)
    # It reaches 9e-10 on the rational one, whatever is asked for; the Gauss rule below says who is right.
    assert abs(found.value - properties.Mass()) <= 2e-9 * found.value
    assert abs(found.value - _by_gauss(surface, 48)) <= found.error + 1e-13
    assert found.error <= 2e-12 * found.value
    same = surface_area(surface.to_semistructured())
    assert abs(same.value - found.value) <= same.error + found.error


# x' = 3 (2 t - 1)^2 and y' = 3 - 6 t: a cusp at t = 1/2.
CUSP = BSplineCurve(3, [0] * 4 + [1] * 4, [[0, 0], [1, 1], [0, 1], [1, 0]])


def test_a_cusp_and_a_fold_are_measured_too():
    # |(x', y')| = 3 |s| sqrt(s^2 + 1) with s = 2 t - 1, whose integral over t is (sqrt(8) - 1).
    length = np.sqrt(8) - 1
    found = curve_length(CUSP)
    assert abs(found.value - length) <= found.error <= 2e-12
    folded = surface_area(extrude(CUSP, [0, 0, 2]))
    assert abs(folded.value - 2 * length) <= folded.error <= 4e-12


@pytest.mark.long
def test_a_fold_at_an_odd_place_ends_with_the_error_that_was_reached():
    # z(u) = u (u - 1/3 - v / 7) lies in a plane, folded along a slanted line.
    v = np.array([0, 1.0])
    z = [[0, 0], [-0.5 * (1 / 3 + b / 7) for b in v], [1 - 1 / 3 - b / 7 for b in v]]
    net = np.dstack([np.zeros((3, 2)), np.tile(v, (3, 1)), z])
    found = surface_area(BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], net))
    # Twice the depth of the fold c^2 / 4, and what rises on the other side: for c = 1/3 + v/7, 1 - c + c^2 / 2.
    c = np.polynomial.Polynomial([1 / 3, 1 / 7])
    whole = (1 - c + c**2 / 2).integ()
    exact = whole(1) - whole(0)
    assert 1e-12 < found.error < 1e-4
    assert abs(found.value - exact) <= found.error


@pytest.mark.long
@settings(max_examples=15)
@given(st.floats(-6, 6), st.floats(-3, 3))
def test_units_and_parameters_do_not_matter(size, length):
    surface = torus(5.0, 1.0)
    other = BSplineSurface(
        2, 2, surface.knots_u * 10**length, surface.knots_v, surface.control_points * 10**size, surface.weights
    )
    assert abs(surface_area(other, 1e-9).value / 100**size / (20 * np.pi**2) - 1) <= 1e-9


def test_a_point_has_no_length():
    assert curve_length(BSplineCurve(1, [0, 0, 1, 1], np.ones((2, 3)))).value == 0.0


def test_rational_rows_count():
    rows = [BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[1, 0, z], [1, 1, z], [0, 1, z]], [1, 1, 2]) for z in (0, 1)]
    assert abs(surface_area(SemiStructuredSurface(1, [0, 0, 1, 1], rows)).value - np.pi / 2) <= 1e-14


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: curve_length(circle(), 0), OptionError, "tolerance: found 0, expected a positive number"),
        (lambda: surface_area(sphere(1), float("nan")), OptionError, "tolerance: found nan"),
        (lambda: curve_length(sphere(1)), InputError, "curve: found a BSplineSurface"),
        (lambda: surface_area(circle()), InputError, "surface: found a BSplineCurve"),
    ],
)
def test_what_cannot_be_measured_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()
