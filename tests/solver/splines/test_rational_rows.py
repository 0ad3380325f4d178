"""Rational v-control curves: evaluation against the definition, and operations that must leave the surface as it is."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from geomdl import NURBS
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from helpers.splines import curves, exact_point, exact_rational_curve, scale, semistructured_surfaces
from semispline.solver.errors import ControlPointError, InputError, KnotError
from semispline.solver.splines.bezier import BezierFunction, bezier_patch, divide_bezier, trim_bezier
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.construction import extrude, ruled, skin
from semispline.solver.splines.curves import (
    elevate_curve,
    insert_curve_knots,
    reverse_curve,
    set_curve_continuity,
    split_curve,
)
from semispline.solver.splines.derivatives import derivative_curve, derivative_surface
from semispline.solver.splines.deviation import deviation_bound
from semispline.solver.splines.operations import (
    bounding_box,
    elevate_degree,
    insert_knots,
    map_domain,
    reverse_u,
    reverse_v,
    split_u,
    split_v,
    transform,
)
from semispline.solver.splines.refinement import linear_product_matrices
from semispline.solver.splines.revolution import revolve, revolve_polynomial
from semispline.solver.splines.rows import insert_row_knot, merge_knots, set_row_continuity
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

TOLERANCE = 1e-12
SEEDS = st.integers(0, 2**32 - 1)
ORDERS = ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2))
laws = settings(max_examples=30, deadline=None)
rational_surfaces = partial(semistructured_surfaces, rational=True)
rational_curves = partial(curves, rational=True)
BEZIER_2 = [0, 0, 0, 1, 1, 1]


def homogeneous(points, weights):
    """What SciPy is given: four columns, made here and not by the classes."""
    w = np.ones(points.shape[:-1]) if weights is None else weights
    return np.concatenate([points * w[..., None], w[..., None]], axis=-1)


def by_scipy(surface, u, v, du=0, dv=0):
    """Points and derivatives to order two in all: SciPy's splines of each row, the quotient written out."""
    rows = [BSpline(c.knots, homogeneous(c.control_points, c.weights), c.degree) for c in surface.control_curves]

    def raw(a, b):
        along = np.stack([row(v, nu=b) for row in rows])
        across = (BSpline(surface.knots_u, along[:, k], surface.degree_u)(x, nu=a) for k, x in enumerate(u))
        return np.stack(list(across))

    top, low = raw(0, 0)[:, :3], raw(0, 0)[:, 3:]
    point = top / low
    if (du, dv) == (0, 0):
        return point

    def first(a, b):
        h = raw(a, b)
        return (h[:, :3] - h[:, 3:] * point) / low

    if du + dv == 1:
        return first(du, dv)
    h = raw(du, dv)
    one, other = ((1, 0), (0, 1)) if du == dv else ((du // 2, dv // 2),) * 2
    mixed = raw(*one)[:, 3:] * first(*other) + raw(*other)[:, 3:] * first(*one)
    return (h[:, :3] - mixed - h[:, 3:] * point) / low


def inside(surface, seed, count=8):
    rng = np.random.default_rng(seed)
    return tuple(rng.uniform(*r, count) for r in surface.domain)


def agree(found, expected, surface, du=0, dv=0):
    assert np.abs(found - expected).max() <= TOLERANCE * scale(surface, du, dv)


def unchanged(changed, surface, seed, orders=ORDERS):
    """Check a surface against another over the (common) domain of the first."""
    u, v = inside(changed, seed)
    for order in orders:
        agree(changed.evaluate(u, v, *order), by_scipy(surface, u, v, *order), surface, *order)


# --- evaluation -------------------------------------------------------------------------------------------------


@pytest.mark.long
@laws
@given(rational_surfaces(), SEEDS)
def test_points_and_derivatives_are_those_of_scipy(surface, seed):
    assert surface.is_rational
    unchanged(surface, surface, seed, (*ORDERS, (2, 0)))
    u, v = inside(surface, seed, 3)
    for du, dv in (*ORDERS, (2, 0)):
        expected = np.stack([by_scipy(surface, np.full(3, x), v, du, dv) for x in u])
        agree(surface.evaluate_grid(u, v, du, dv), expected, surface, du, dv)


@pytest.mark.long
@settings(max_examples=15, deadline=None)
@given(rational_surfaces(degrees=(1, 3), most=1), st.floats(0, 1), st.floats(0, 1))
def test_points_and_derivatives_are_those_of_the_definition(surface, s, t):
    (u0, u1), (v0, v1) = surface.domain
    u, v = min(u0 + s * (u1 - u0), u1), min(v0 + t * (v1 - v0), v1)
    for du, dv in ((0, 0), (1, 1), (2, 1), (0, 3), (4, 0)):
        exact = np.array([[float(x) for x in exact_point(surface, u, v, du, dv)]])
        agree(surface.evaluate([u], [v], du, dv), exact, surface, du, dv)


@settings(max_examples=15, deadline=None)
@given(rational_curves(degrees=(1, 4), most=2), st.floats(0, 1))
def test_a_curve_and_its_derivatives_are_those_of_the_definition(curve, v):
    as_surface = SemiStructuredSurface(1, [0, 0, 1, 1], [curve, curve])
    for order in range(4):
        exact = np.array([[float(x) for x in exact_rational_curve(curve, v, order)]])
        agree(curve.evaluate([v], order), exact, as_surface, 0, order)


@pytest.mark.long
@laws
@given(rational_surfaces(degrees=(1, 4)), SEEDS)
def test_conversion_gives_geomdl_the_same_surface(surface, seed):
    surface = map_domain(surface, (0, 1), (0, 1))
    classical = surface.to_bspline()
    assert classical.is_rational
    unchanged(classical, surface, seed)
    theirs = NURBS.Surface(normalize_kv=False)
    theirs.degree_u, theirs.degree_v = classical.degree_u, classical.degree_v
    theirs.ctrlpts_size_u, theirs.ctrlpts_size_v = classical.weights.shape
    theirs.ctrlptsw = homogeneous(classical.control_points, classical.weights).reshape(-1, 4).tolist()
    theirs.knotvector_u, theirs.knotvector_v = classical.knots_u.tolist(), classical.knots_v.tolist()
    u, v = inside(surface, seed, 4)
    expected = np.array([theirs.evaluate_single((x, y)) for x, y in zip(u.tolist(), v.tolist(), strict=True)])
    agree(surface.evaluate(u, v), expected, surface)


def test_no_parameters_give_no_points():
    surface = SemiStructuredSurface(1, [0, 0, 1, 1], [QUARTER, BSplineCurve(1, [0, 0, 1, 1], np.eye(3)[:2])])
    assert surface.evaluate([], [], 1, 1).shape == (0, 3)
    assert surface.evaluate_grid([], [0.5], 2, 1).shape == (0, 1, 3)
    assert QUARTER.evaluate([], 3).shape == (0, 3)


def test_rows_of_one_space_keep_their_numbers_in_both_directions():
    rng = np.random.default_rng(3)
    surface = BSplineSurface(1, 2, [0, 0, 1, 1], BEZIER_2, rng.normal(size=(2, 3, 3)), rng.uniform(0.5, 2, (2, 3)))
    back = surface.to_semistructured().to_bspline()
    assert np.array_equal(back.control_points, surface.control_points)
    assert np.array_equal(back.weights, surface.weights)


# --- what weights may not matter for ----------------------------------------------------------------------------


@pytest.mark.long
@laws
@given(semistructured_surfaces(), SEEDS, st.sampled_from([1.0, 0.3, 7e5]))
def test_equal_weights_are_none(surface, seed, weight):
    rows = [replace(c, weights=np.full(len(c.control_points), weight)) for c in surface.control_curves]
    unchanged(replace(surface, control_curves=rows), surface, seed)


@pytest.mark.long
@laws
@given(rational_surfaces(degrees=(1, 4)), SEEDS, st.floats(0.2, 5), st.floats(0.2, 5))
def test_a_common_factor_of_all_rows_is_none(surface, seed, at_start, at_end):
    """The factor is a function of v, linear and positive, so that each row has one degree more."""
    rows = []
    for c in surface.control_curves:
        falling, rising, knots = linear_product_matrices(c.degree, c.knots)
        points = (at_start * falling + at_end * rising) @ homogeneous(c.control_points, c.weights)
        rows.append(BSplineCurve(c.degree + 1, knots, points[:, :3] / points[:, 3:], points[:, 3]))
    changed = replace(surface, control_curves=rows)
    u, v = inside(surface, seed)
    for order in ORDERS:
        limit = TOLERANCE * max(scale(surface, *order), scale(changed, *order))
        assert np.abs(changed.evaluate(u, v, *order) - by_scipy(surface, u, v, *order)).max() <= limit


# --- operations -------------------------------------------------------------------------------------------------


def inner_value(surface, direction, rng):
    start, end = surface.domain[direction]
    return float(rng.uniform(start + 0.1 * (end - start), end - 0.1 * (end - start)))


SAME_SURFACE = {
    "degree": lambda s, rng: [elevate_degree(s, s.degree_u + 1, s.degree_v + 1)],
    "knots": lambda s, rng: [insert_knots(s, [inner_value(s, 0, rng)], [inner_value(s, 1, rng)])],
    "halves in u": lambda s, rng: split_u(s, inner_value(s, 0, rng)),
    "halves in v": lambda s, rng: split_v(s, inner_value(s, 1, rng)),
    "a knot of one row": lambda s, rng: [insert_row_knot(s, 0, inner_value(s, 1, rng))],
    "turned in u twice": lambda s, rng: [reverse_u(reverse_u(s))],
    "turned in v twice": lambda s, rng: [reverse_v(reverse_v(s))],
    "merged knots": lambda s, rng: [merge_knots(s).surface],
}


@pytest.mark.long
@pytest.mark.parametrize("operation", SAME_SURFACE.values(), ids=SAME_SURFACE.keys())
@settings(max_examples=20, deadline=None)
@given(surface=rational_surfaces(degrees=(1, 4)), seed=SEEDS)
def test_an_operation_changes_no_point_and_no_derivative(operation, surface, seed):
    for piece in operation(surface, np.random.default_rng(seed)):
        unchanged(piece, surface, seed)


@pytest.mark.long
@laws
@given(rational_surfaces(degrees=(1, 4)), SEEDS)
def test_reversal_mapping_and_affine_maps(surface, seed):
    u, v = inside(surface, seed)
    (u0, u1), (v0, v1) = surface.domain
    agree(reverse_u(surface).evaluate(u, v), by_scipy(surface, u0 + u1 - u, v), surface)
    agree(reverse_v(surface).evaluate(u, v), by_scipy(surface, u, v0 + v1 - v), surface)
    s, t = (u - u0) / (u1 - u0), (v - v0) / (v1 - v0)
    agree(map_domain(surface, (0, 1), (2, 5)).evaluate(s, 2 + 3 * t), by_scipy(surface, u, v), surface)
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(-2, 2, (3, 3)), rng.uniform(-5, 5, 3)
    expected = by_scipy(surface, u, v) @ a.T + b
    assert np.abs(transform(surface, a, b).evaluate(u, v) - expected).max() <= 1e-12 * 15
    low, high = bounding_box(surface)
    assert (by_scipy(surface, u, v) >= low - 1e-14).all()
    assert (by_scipy(surface, u, v) <= high + 1e-14).all()


@pytest.mark.long
@laws
@given(rational_curves(degrees=(1, 5)), st.floats(0.1, 0.9), SEEDS)
def test_operations_on_a_curve_change_no_point(curve, at, seed):
    v = np.random.default_rng(seed).uniform(0, 1, 10)
    spline = BSpline(curve.knots, homogeneous(curve.control_points, curve.weights), curve.degree)

    def expected(x):
        values = spline(x)
        return values[:, :3] / values[:, 3:]

    low, high = split_curve(curve, at)
    pairs = [
        (elevate_curve(curve, curve.degree + 2), v),
        (insert_curve_knots(curve, [at]), v),
        (set_curve_continuity(curve, at, 0), v),
        (low, v * at),
        (high, np.clip(at + v * (1 - at), at, 1)),
    ]
    for changed, x in pairs:
        assert np.abs(changed.evaluate(x) - expected(x)).max() <= TOLERANCE
    assert np.abs(reverse_curve(curve).evaluate(v) - expected(1 - v)).max() <= TOLERANCE
    same = compatible_curves([curve, BSplineCurve(1, [0, 0, at, 1, 1], np.eye(3))])
    assert same.homogeneous.shape[2] == 4
    assert np.abs(same.homogeneous[1, :, 3] - 1).max() <= 1e-15
    raised = BSpline(same.knots, same.homogeneous[0], same.degree)(v)
    assert np.abs(raised[:, :3] / raised[:, 3:] - expected(v)).max() <= TOLERANCE


# --- known answers ----------------------------------------------------------------------------------------------

# Weights 1, 1, 2: a quarter of the unit circle in whole numbers.
QUARTER = BSplineCurve(2, BEZIER_2, [[1, 0, 0], [1, 1, 0], [0, 1, 0]], [1, 1, 2])


def test_a_quarter_circle_is_one_exactly():
    for v in (0.0, 0.25, 0.375, 0.8125, 1.0):
        x, y, _ = exact_rational_curve(QUARTER, v)
        assert x * x + y * y == 1
        t = [float(value) for value in exact_rational_curve(QUARTER, v, 1)]
        assert np.abs(QUARTER.evaluate([v])[0] - [float(x), float(y), 0]).max() <= 2e-16
        assert np.abs(QUARTER.evaluate([v], 1)[0] - t).max() <= 1e-15


def test_ruled_extruded_and_turned_circles_are_cylinder_and_sphere():
    v = np.linspace(0, 1, 9)
    up = transform(skin([QUARTER, QUARTER], 1), np.eye(3), [0, 0, 3]).control_curves[0]
    # One row of another degree and a row without weights: a cone to the apex.
    apex = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[0, 0, 3]] * 3)
    for tube in (ruled(QUARTER, up), extrude(QUARTER, [0, 0, 3]), extrude(QUARTER, [0, 0, 3], 3)):
        points = tube.evaluate_grid(v, v)
        assert np.abs(np.hypot(points[..., 0], points[..., 1]) - 1).max() <= 1e-15
        assert np.abs(points[..., 2] - 3 * v[:, None]).max() <= 1e-14
    cone = skin([QUARTER, apex], 1)
    points = cone.evaluate_grid(v, v)
    assert np.abs(np.hypot(points[..., 0], points[..., 1]) - (1 - points[..., 2] / 3)).max() <= 1e-15
    for angle in (90.0, 360.0):
        sphere = revolve(QUARTER, [0, 0, 0], [0, 2, 0], angle)
        assert np.abs(np.linalg.norm(sphere.evaluate_grid(v, v), axis=2) - 1).max() <= 1e-15
    near = revolve_polynomial(QUARTER, [0, 0, 0], [0, 1, 0], 90.0, tolerance=1e-5)
    points, turned = near.surface.evaluate_grid(v, v), QUARTER.evaluate(v)
    turn = v[:, None] * np.pi / 2
    exact = np.stack([np.cos(turn) * turned[:, 0], turned[:, 1] + 0 * turn, -np.sin(turn) * turned[:, 0]], axis=2)
    apart = np.linalg.norm(points - exact, axis=2).max()
    assert near.error / 100 < apart <= near.error <= 1e-5


@laws
@given(SEEDS, st.integers(0, 3))
def test_a_divided_rational_patch_is_the_patch(seed, degree):
    rng = np.random.default_rng(seed)
    patch = bezier_patch(rng.uniform(-1, 1, (3, 4, 3)), rng.uniform(0.5, 2, (3, 4)))
    cut = rng.uniform(0.1, 0.9, degree + 1)
    s, t = rng.uniform(0, 1, (2, 10))
    f = BezierFunction(cut).evaluate(t)
    for part, v in zip(divide_bezier(patch, cut), (s * f, f + s * (1 - f)), strict=True):
        assert np.abs(part.evaluate(s, t) - by_scipy(patch.to_semistructured(), t, v)).max() <= TOLERANCE


def test_a_hole_in_a_rational_patch_leaves_eight_pieces_of_it():
    rng = np.random.default_rng(8)
    patch = bezier_patch(rng.uniform(-1, 1, (3, 4, 3)), rng.uniform(0.5, 2, (3, 4)))
    left, right = BezierFunction([0.25, 0.2, 0.25], 0.4, 0.6), BezierFunction([0.75, 0.8, 0.75], 0.4, 0.6)
    bottom, top = BezierFunction([0.4, 0.3, 0.4], 0.25, 0.75), BezierFunction([0.6], 0.25, 0.75)
    pieces = trim_bezier(patch, left, right, bottom, top)
    whole = patch.to_semistructured()
    for name, piece in pieces.items():
        assert piece.is_rational
        u, v = inside(piece, 1)
        if " " in name:
            expected = by_scipy(whole, u, v)
        elif name == "left":
            expected = by_scipy(whole, u * left.evaluate(v), v)
        elif name == "right":
            at = right.evaluate(v)
            expected = by_scipy(whole, at + u * (1 - at), v)
        else:
            at = bottom.evaluate(v) if name == "bottom" else top.evaluate(v)
            expected = by_scipy(whole, v, u * at if name == "bottom" else at + u * (1 - at))
        assert np.abs(piece.evaluate(u, v) - expected).max() <= TOLERANCE


# --- continuity and distances -----------------------------------------------------------------------------------


@laws
@given(rational_curves(degrees=(2, 5)), st.floats(0.1, 0.9))
def test_inserted_knots_of_a_rational_curve_go_away_again(curve, at):
    at = float(at)
    if np.abs(curve.knots - at).min() < 1e-3:
        return
    creased = set_curve_continuity(curve, at, 0)
    assert np.count_nonzero(creased.knots == at) == curve.degree
    smooth = set_curve_continuity(creased, at, curve.degree)
    assert np.array_equal(smooth.knots, curve.knots)
    assert np.abs(smooth.control_points - curve.control_points).max() <= 1e-11
    assert np.abs(smooth.weights - curve.weights).max() <= 1e-11


@laws
@given(rational_curves(degrees=(2, 5), most=2), SEEDS, st.floats(-8, -2))
def test_a_knot_is_taken_away_only_within_the_tolerance(curve, seed, power):
    rng = np.random.default_rng(seed)
    creased = insert_curve_knots(curve, [float(rng.uniform(0.3, 0.7))])
    noise = homogeneous(creased.control_points, creased.weights) + 10**power * rng.uniform(-1, 1, (1, 4))
    noise[rng.integers(1, len(noise) - 1)] += 10**power * rng.uniform(-1, 1, 4)
    rough = replace(creased, control_points=noise[:, :3] / noise[:, 3:], weights=noise[:, 3])
    at = float(np.setdiff1d(creased.knots, curve.knots)[0])
    tolerance = 3 * 10**power
    try:
        smooth = set_curve_continuity(rough, at, rough.degree, tolerance)
    except KnotError:
        return
    v = np.linspace(0, 1, 200)
    moved = np.linalg.norm(smooth.evaluate(v) - rough.evaluate(v), axis=1).max()
    assert moved <= tolerance * np.ptp(rough.control_points, axis=0).max() + 1e-13


def test_a_weight_alone_can_be_what_is_not_smooth():
    points = [[x, 0, 0] for x in (0, 1, 2, 3)]
    curve = BSplineCurve(2, [0, 0, 0, 0.5, 1, 1, 1], points, [1, 1, 1.5, 1])
    with pytest.raises(KnotError, match=r"cannot be C2 at v = 0.5: its points would move by"):
        set_curve_continuity(curve, 0.5, 2)
    assert len(set_curve_continuity(curve, 0.5, 2, 0.5).weights) == 3


def test_a_weight_that_would_not_be_positive_is_no_answer():
    points = [[x, 0, 0] for x in (0, 1, 2, 3)]
    curve = BSplineCurve(2, [0, 0, 0, 0.5, 1, 1, 1], points, [1, 1e-3, 1e-3, 1])
    with pytest.raises(KnotError, match="would move by inf"):
        set_curve_continuity(curve, 0.5, 2, 1e6)


@laws
@given(rational_curves(degrees=(1, 5)), SEEDS, st.floats(-9, -0.6))
def test_the_stated_distance_is_never_too_small_and_not_far_too_large(curve, seed, power):
    rng = np.random.default_rng(seed)
    n = len(curve.control_points)
    other = replace(
        curve,
        control_points=curve.control_points + 10**power * rng.uniform(-1, 1, (n, 3)),
        weights=curve.weights * (1 + 10**power * rng.uniform(-1, 1, n)),
    )
    v = np.concatenate([np.linspace(0, 1, 301), np.unique(curve.knots)])
    true = np.linalg.norm(curve.evaluate(v) - other.evaluate(v), axis=1).max()
    bounds = [
        deviation_bound([curve.degree], a.homogeneous, b.homogeneous) for a, b in ((curve, other), (other, curve))
    ]
    assert true <= min(bounds) + 1e-15
    assert max(bounds) <= 60 * 10**power
    assert deviation_bound([curve.degree], curve.homogeneous, curve.homogeneous) == 0


@pytest.mark.long
@laws
@given(rational_curves(degrees=(1, 4), most=0), rational_curves(degrees=(1, 4), most=0), SEEDS)
def test_merged_knots_of_rational_rows_say_how_far_points_moved(one, other, seed):
    at = float(np.random.default_rng(seed).uniform(0.2, 0.8))
    rows = [insert_curve_knots(one, [at] * one.degree), insert_curve_knots(other, [at + 1e-3])]
    merged = merge_knots(SemiStructuredSurface(1, [0, 0, 1, 1], rows), 1e-2)
    assert np.array_equal(merged.surface.breakpoints[1], [0, at, 1])
    v = np.linspace(0, 1, 301)
    pairs = zip(rows, merged.surface.control_curves, strict=True)
    moved = max(np.linalg.norm(a.evaluate(v) - b.evaluate(v), axis=1).max() for a, b in pairs)
    assert moved <= merged.change + 1e-15
    assert merged.change < 1


def test_a_row_of_a_surface_takes_a_continuity_of_its_own():
    surface = SemiStructuredSurface(1, [0, 0, 1, 1], [QUARTER, QUARTER])
    bent = set_row_continuity(surface, 1, 0.5, 0)
    assert [len(c.weights) for c in bent.control_curves] == [3, 5]
    assert np.abs(set_row_continuity(bent, 1, 0.5, 2).control_curves[1].weights - [1, 1, 2]).max() <= 1e-15


# --- refusals ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        ([1, 0, 1], r"^control_curves\[2\].weights\[1\]: found 0.0, expected a positive number$"),
        ([1, 1, -3], r"weights\[2\]: found -3.0"),
        ([1, float("nan"), 1], r"weights\[1\]: found nan, expected a finite number"),
        ([1, 1], r"weights: shape \(2,\), expected \(3,\)"),
        ([1, 1e300, 1], r"weights: found 1e\+300, too large to be multiplied by the coordinate 10000000000.0"),
        ([[1, 1, 1]], r"weights: has 2 dimension\(s\), expected 1"),
        ("abc", r"weights\[0\]: found 'a'"),
    ],
)
def test_wrong_weights_are_refused_with_their_place(weights, message):
    with pytest.raises(ControlPointError, match=message):
        BSplineCurve(2, BEZIER_2, 1e10 * np.eye(3), weights, name="control_curves[2]")


def test_a_rational_spline_has_no_derivative_of_lower_degree():
    with pytest.raises(InputError, match=r"curve: rational.*use evaluate\(v, order\)"):
        derivative_curve(QUARTER)
    surface = SemiStructuredSurface(1, [0, 0, 1, 1], [QUARTER, BSplineCurve(1, [0, 0, 1, 1], np.eye(3)[:2])])
    for order in ((1, 0), (0, 1)):
        with pytest.raises(InputError, match=r"surface: rational.*use evaluate\(u, v, du, dv\)"):
            derivative_surface(surface, *order)
