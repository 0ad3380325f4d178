"""Knot removal and lower degrees: what was put in comes out again, and the stated deviation is never exceeded."""

import numpy as np
import pytest
from geomdl import BSpline
from geomdl.operations import remove_knot
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.occ import to_geom
from helpers.splines import bspline_surfaces, curves, semistructured_surfaces
from semispline import (
    BSplineCurve,
    BSplineSurface,
    SemiStructuredSurface,
    elevate_curve,
    elevate_degree,
    insert_curve_knots,
    insert_knots,
    reduce_curve_degree,
    reduce_degree,
    remove_curve_knots,
    remove_knots,
)
from semispline.solver.errors import ComputationError, InputError, KnotError
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.deviation import deviation_bound

seeds = st.integers(0, 2**32 - 1)


def weighted(curve, seed):
    rng = np.random.default_rng(seed)
    return BSplineCurve(curve.degree, curve.knots, curve.control_points, rng.uniform(0.5, 2, len(curve.control_points)))


def sampled(curve, n=1001):
    t = np.linspace(curve.knots[0], curve.knots[-1], n)
    if curve.weights is None:
        return curve_points(curve.degree, curve.knots, curve.control_points, t)
    w = curve.weights[:, None]
    values = curve_points(curve.degree, curve.knots, np.hstack([curve.control_points * w, w]), t)
    return values[:, :3] / values[:, 3:]


def grid(surface, n=31):
    (u0, u1), (v0, v1) = surface.domain
    u, v = np.linspace(u0, u1, n), np.linspace(v0, v1, n)
    plain = surface.to_bspline() if isinstance(surface, SemiStructuredSurface) else surface
    return surface_points(plain, np.repeat(u, n), np.tile(v, n))


def farthest(a, b):
    return np.linalg.norm(a - b, axis=1).max()


def attempt(call):
    """The result, or None where the fit has no positive weights."""
    try:
        return call()
    except ComputationError:
        return None


@pytest.mark.long
@settings(max_examples=60)
@given(curves(degrees=(2, 5)), st.booleans(), seeds)
def test_the_deviation_of_curves_is_never_exceeded(curve, rational, seed):
    if rational:
        curve = weighted(curve, seed)
    inner = np.unique(curve.knots)[1:-1]
    calls = [lambda: reduce_curve_degree(curve, curve.degree - 1), lambda: reduce_curve_degree(curve, 1)]
    if len(inner):
        calls.append(lambda: remove_curve_knots(curve, inner[:1]))
        calls.append(lambda: remove_curve_knots(curve, inner))
    for call in calls:
        found = attempt(call)
        if found is None:
            assert rational
            continue
        assert farthest(sampled(curve), sampled(found.curve)) <= found.error
        for end in (0, -1):
            assert np.array_equal(found.curve.control_points[end], curve.control_points[end]) or rational
            assert np.abs(found.curve.control_points[end] - curve.control_points[end]).max() <= 1e-15


def test_the_bound_is_near_the_deviation():
    rng = np.random.default_rng(4)
    ratios = []
    for _ in range(60):
        knots = np.concatenate([[0] * 4, np.sort(rng.uniform(0, 1, 4)), [1] * 4])
        curve = BSplineCurve(3, knots, rng.uniform(-1, 1, (8, 3)), rng.uniform(0.5, 2, 8))
        found = attempt(lambda c=curve: remove_curve_knots(c, [c.knots[5]]))
        if found:
            ratios.append(found.error / farthest(sampled(curve), sampled(found.curve)))
    assert min(ratios) >= 1
    assert np.median(ratios) <= 2


@pytest.mark.long
def test_the_bound_of_surfaces_is_near_the_deviation():
    rng = np.random.default_rng(7)
    ratios = []
    for _ in range(20):
        # What all but has degree 3 and 2, and all but lacks a knot.
        knots = [0] * 4 + [0.4] + [1] * 4
        net = np.dstack([*np.mgrid[0:4:5j, 0:2:4j], rng.uniform(-1, 1, (5, 4))])
        noise = np.exp(0.02 * rng.normal(size=(2, 5, 4)))
        near = BSplineSurface(3, 3, knots, [0] * 4 + [1] * 4, net * noise[0, ..., None], noise[1])
        for found in (remove_knots(near, knots_u=[0.4]), reduce_degree(near, degree_v=2)):
            ratios.append(found.error / farthest(grid(near, 61), grid(found.surface, 61)))
    assert min(ratios) >= 1
    assert max(ratios) <= 3


@pytest.mark.long
@settings(max_examples=30)
@given(bspline_surfaces(degrees=(2, 4), most=2), st.booleans())
def test_the_deviation_of_surfaces_is_never_exceeded(surface, semi):
    if semi:
        surface = surface.to_semistructured()
    plain = surface.to_bspline() if semi else surface
    inner_u, inner_v = np.unique(plain.knots_u)[1:-1], np.unique(plain.knots_v)[1:-1]
    for call in (
        lambda: remove_knots(surface, inner_u[:1], inner_v[:1]),
        lambda: remove_knots(surface, knots_v=inner_v[:1]),
        lambda: reduce_degree(surface, surface.degree_u - 1, surface.degree_v - 1),
        lambda: reduce_degree(surface, degree_u=1),
    ):
        found = attempt(call)
        if found is not None:
            assert type(found.surface) is type(surface)
            assert farthest(grid(surface), grid(found.surface)) <= found.error


@pytest.mark.long
@settings(max_examples=30)
@given(curves(degrees=(1, 5)), st.booleans(), seeds)
def test_what_was_inserted_or_raised_comes_back(curve, rational, seed):
    if rational:
        curve = weighted(curve, seed)
    t = np.random.default_rng(seed).uniform(curve.knots[0], curve.knots[-1])
    inserted = insert_curve_knots(curve, [t] * curve.degree)
    back = remove_curve_knots(inserted, [t] * curve.degree)
    assert np.array_equal(back.curve.knots, curve.knots)
    assert np.abs(back.curve.control_points - curve.control_points).max() <= 1e-11
    assert back.error <= 1e-11
    lower = reduce_curve_degree(elevate_curve(curve, curve.degree + 2), curve.degree)
    assert np.array_equal(lower.curve.knots, curve.knots)
    assert np.abs(lower.curve.control_points - curve.control_points).max() <= 1e-11
    assert lower.error <= 1e-11


@pytest.mark.long
@settings(max_examples=20)
@given(semistructured_surfaces(degrees=(1, 3)))
def test_rows_lose_their_own_knots_and_degrees(surface):
    (_, _), (v0, v1) = surface.domain
    more = insert_knots(surface, knots_v=[v0 + 0.37 * (v1 - v0)])
    back = remove_knots(more, knots_v=[v0 + 0.37 * (v1 - v0)])
    raised = elevate_degree(surface, degree_v=surface.degree_v + 1)
    lower = reduce_degree(raised, degree_v=surface.degree_v)
    assert max(back.error, lower.error) <= 1e-11
    for row, own in zip(surface.control_curves, back.surface.control_curves, strict=True):
        assert np.array_equal(row.knots, own.knots)
        assert np.abs(row.control_points - own.control_points).max() <= 1e-11


def test_a_row_without_the_knot_stays_as_it_is():
    rows = [BSplineCurve(1, [0, 0, v, 1, 1], [[i, 0], [i, 0.5], [i, 1]]) for i, v in enumerate((0.25, 0.5))]
    found = remove_knots(SemiStructuredSurface(1, [0, 0, 1, 1], rows), knots_v=[0.25])
    assert found.surface.control_curves[1] is rows[1]
    assert found.surface.control_curves[0].knots.tolist() == [0, 0, 1, 1]
    # (0, 0.25 t) is twice as fast before the knot as the line.
    assert abs(found.error - 0.25) <= 1e-14


def test_open_cascade_removes_the_same_knot_and_geomdl_another():
    rng = np.random.default_rng(7)
    surface = BSplineSurface(1, 3, [0, 0, 1, 1], [0, 0, 0, 0, 0.3, 0.6, 1, 1, 1, 1], rng.uniform(-1, 1, (2, 6, 3)))
    inserted = insert_knots(surface, knots_v=[0.45])
    theirs = to_geom(inserted)
    assert theirs.RemoveVKnot(3, 0, 1e-9)
    ours = remove_knots(inserted, knots_v=[0.45]).surface
    poles = [[theirs.Pole(i, j) for j in range(1, 7)] for i in (1, 2)]
    found = np.array([[[p.X(), p.Y(), p.Z()] for p in row] for row in poles])
    assert np.abs(ours.control_points - found).max() <= 1e-14
    # What was inserted can be removed without a change; geomdl 5.4 moves the curve by .06.
    row = BSpline.Curve()
    row.degree, row.ctrlpts = 3, inserted.control_points[0].tolist()
    row.knotvector = inserted.knots_v.tolist()
    remove_knot(row, [0.45], [1])
    assert np.abs(ours.control_points[0] - row.ctrlpts).max() > 0.01


def test_the_fit_is_the_best_one():
    """No other place of the one point that the knot reaches gives the refined points a smaller sum of squares."""
    corner = BSplineCurve(2, [0, 0, 0, 0.25, 0.6, 1, 1, 1], [[0, 0], [1, 3], [2, -1], [3, 1], [4, 0]])
    found = remove_curve_knots(corner, [0.25]).curve

    def squares(points):
        refined = insert_curve_knots(BSplineCurve(2, found.knots, points), [0.25])
        return np.sum((refined.control_points - corner.control_points) ** 2)

    least = squares(found.control_points)
    assert np.array_equal(found.control_points[[0, 2, 3]], corner.control_points[[0, 3, 4]])
    for step in (-1e-3, 1e-3):
        for axis in (0, 1):
            other = found.control_points.copy()
            other[1, axis] += step
            assert squares(other) > least


def test_the_bound_of_polynomial_splines_is_that_of_their_control_points():
    rng = np.random.default_rng(0)
    one, other = rng.uniform(size=(2, 4, 5, 3))
    assert deviation_bound([2, 3], one, other) == np.linalg.norm(one - other, axis=2).max()
    # With weights that are all 2 it is the same curve and the same bound.
    weighty = [np.concatenate([2 * x, np.full((4, 5, 1), 2.0)], axis=2) for x in (one, other)]
    assert abs(deviation_bound([2, 3], *weighty) - np.linalg.norm(one - other, axis=2).max()) <= 1e-15


CUBIC = BSplineCurve(3, [0, 0, 0, 0, 0.5, 1, 1, 1, 1], np.random.default_rng(1).uniform(size=(5, 3)))
SHEET = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], np.zeros((3, 2, 3)))


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: remove_curve_knots(CUBIC, [0.4]), KnotError, r"knots\[0\]: found 0.4, expected an inner knot"),
        (lambda: remove_curve_knots(CUBIC, [0.5, 0.5]), KnotError, r"knots\[1\]: found 0.5, expected an inner knot"),
        (lambda: remove_curve_knots(CUBIC, [0.0]), KnotError, r"knots\[0\]: found 0.0"),
        (lambda: reduce_curve_degree(CUBIC, 4), KnotError, "degree: found 4, expected at most the present degree 3"),
        (lambda: reduce_curve_degree(CUBIC, 0), KnotError, "degree: found 0"),
        (lambda: remove_knots(SHEET, [0.4]), KnotError, r"knots_u\[0\]: found 0.4"),
        (lambda: remove_knots(SHEET, [], [0.5]), KnotError, r"knots_v\[0\]: found 0.5"),
        (lambda: remove_knots(SHEET.to_semistructured(), [], [0.5]), KnotError, r"knots_v\[0\]: .* v-control curve"),
        (lambda: reduce_degree(SHEET, 2), KnotError, "degree_u: found 2"),
        (lambda: reduce_degree(SHEET, None, 0), KnotError, "degree_v: found 0"),
        (lambda: remove_knots(CUBIC), InputError, "surface: found a BSplineCurve"),
    ],
)
def test_what_cannot_be_removed_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_a_fit_without_positive_weights_says_so():
    weights = np.array([1, 1, 40, 1, 1, 1.0])
    curve = BSplineCurve(2, [0, 0, 0, 0.3, 0.31, 0.9, 1, 1, 1], np.random.default_rng(1).uniform(size=(6, 3)), weights)
    with pytest.raises(ComputationError, match=r"weights\[\d\]: found -.*, expected a positive number.*remove less"):
        reduce_curve_degree(curve, 1)
