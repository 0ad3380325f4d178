"""What only the semi-structured form has: one curve changed alone, derivatives in the same form, conversion."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.splines import parameters, scale, semistructured_surfaces
from semispline import derivative_surface, insert_row_knot, merge_knots, set_row_continuity
from semispline.solver.errors import InputError, KnotError, OptionError
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.curves import set_curve_continuity
from semispline.solver.splines.derivatives import derivative_curve
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

# Short convex combinations of the same control points on both sides.
TOLERANCE = 1e-12
SEEDS = st.integers(0, 2**32 - 1)
laws = settings(max_examples=30, deadline=None)


def curve_over(inner, degree=3, seed=0):
    rng = np.random.default_rng(seed)
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return BSplineCurve(degree, knots, rng.uniform(-1, 1, (len(knots) - degree - 1, 3)))


def surface_over(rows, degree_u=3, degrees=None):
    degrees = degrees or [3] * len(rows)
    curves = [curve_over(r, d, i) for i, (r, d) in enumerate(zip(rows, degrees, strict=True))]
    inner = np.arange(1, len(rows) - degree_u) / (len(rows) - degree_u)
    return SemiStructuredSurface(
        degree_u, np.concatenate([np.zeros(degree_u + 1), inner, np.ones(degree_u + 1)]), curves
    )


def inner(curve):
    return curve.knots[curve.degree + 1 : -curve.degree - 1].tolist()


def sample(surface, seed=0, count=15):
    rng = np.random.default_rng(seed)
    return tuple(rng.uniform(*r, count) for r in surface.domain)


# --- conversion -------------------------------------------------------------------------------------------------


@pytest.mark.long
@laws
@given(semistructured_surfaces(), SEEDS)
def test_conversion_changes_no_point_and_no_derivative(surface, seed):
    classical = surface.to_bspline()
    assert isinstance(classical, BSplineSurface)
    assert classical.degree_v == max(c.degree for c in surface.control_curves)
    u, v = sample(surface, seed)
    for order in ((0, 0), (1, 0), (0, 1), (1, 1)):
        expected = surface_points(surface, u, v, *order)
        limit = TOLERANCE * scale(surface, *order)
        assert np.abs(surface_points(classical, u, v, *order) - expected).max() <= limit


def test_conversion_has_the_knots_of_all_rows_once():
    surface = surface_over([[0.5], [0.25, 0.5], [], [0.75]])
    converted = surface.to_bspline()
    assert converted.knots_v[4:-4].tolist() == [0.25, 0.5, 0.75]
    assert (surface.n_control_points, converted.n_control_points) == (5 + 6 + 4 + 5, 4 * 7)
    merged = merge_knots(surface)
    assert (merged.knot_shift, merged.change) == (0.0, 0.0)


def test_conversion_raises_lower_degrees_and_keeps_their_smoothness():
    surface = surface_over([[0.5], [], [], [0.25]], degrees=[2, 3, 3, 3])
    knots = surface.to_bspline().knots_v
    # The quadratic row is C1 at 1/2, so the cubic form needs a double knot there and nowhere else.
    assert knots[4:-4].tolist() == [0.25, 0.5, 0.5]


def test_merging_knots_that_differ_by_rounding_is_reported_and_bounded():
    surface = surface_over([[0.3, 0.6], [0.3 + 1e-13, 0.6], [], [0.6 - 2e-13]])
    merged = merge_knots(surface)
    assert surface.to_bspline().knots_v[4:-4].tolist() == [0.3, 0.6 - 2e-13]
    assert merged.knot_shift == pytest.approx(2e-13, rel=1e-3)
    u, v = sample(surface, count=300)
    for other in (merged.surface, surface.to_bspline()):
        moved = np.linalg.norm(surface_points(other, u, v) - surface_points(surface, u, v), axis=1).max()
        # A bound, and not a wild one: slopes are below 6 * 2 / 0.3.
        assert 1e-14 < moved <= merged.change + 1e-15
    assert merged.change <= 2e-13 * 40
    exact = merge_knots(surface, tolerance=0.0)
    assert [c.knots.tolist() for c in exact.surface.control_curves] == [
        c.knots.tolist() for c in surface.control_curves
    ]
    assert (exact.knot_shift, exact.change) == (0.0, 0.0)


def test_merging_never_joins_two_knots_of_one_curve():
    surface = surface_over([[0.3, 0.3 + 1e-13], [0.3 + 1e-13], [], []])
    assert surface.to_bspline().knots_v[4:-4].tolist() == [0.3, 0.3 + 1e-13]
    assert merge_knots(surface).knot_shift == 0.0


def test_a_large_tolerance_moves_knots_by_less_than_it_and_says_how_far_points_go():
    surface = surface_over([[0.3], [0.31], [0.5], []])
    merged = merge_knots(surface, tolerance=0.02)
    assert [c.knots[4:-4].tolist() for c in merged.surface.control_curves] == [[0.3], [0.3], [0.5], []]
    assert merged.surface.to_bspline().knots_v[4:-4].tolist() == [0.3, 0.5]
    assert merged.knot_shift == pytest.approx(0.01)
    u, v = sample(surface, count=300)
    moved = np.linalg.norm(surface_points(merged.surface, u, v) - surface_points(surface, u, v), axis=1).max()
    assert 1e-4 < moved <= merged.change


@pytest.mark.parametrize("tolerance", [-1e-3, 1.0, float("nan")])
def test_a_tolerance_must_be_a_fraction(tolerance):
    with pytest.raises(OptionError, match="tolerance"):
        merge_knots(surface_over([[]] * 4), tolerance)


# --- derivatives ------------------------------------------------------------------------------------------------


@pytest.mark.long
@laws
@given(semistructured_surfaces(), SEEDS, st.integers(0, 2), st.integers(0, 2))
def test_derivatives_are_those_of_the_referee_or_truly_jump(surface, seed, du, dv):
    # Random control points: a knot that allows a jump has one.
    exists = has_derivative(surface.degree_u, surface.knots_u, du) and all(
        has_derivative(c.degree, c.knots, dv) for c in surface.control_curves
    )
    if not exists:
        with pytest.raises(InputError, match=rf"derivative \({du}, {dv}\).* jumps by"):
            derivative_surface(surface, du, dv)
        return
    derivative = derivative_surface(surface, du, dv)
    u, v = sample(surface, seed)
    limit = TOLERANCE * scale(surface, du, dv)
    assert np.abs(surface_points(derivative, u, v) - surface_points(surface, u, v, du, dv)).max() <= limit


def has_derivative(degree, knots, order):
    """No inner knot lets a derivative up to this order jump (there is none to jump in a single span)."""
    counts = np.unique(knots[degree + 1 : -degree - 1], return_counts=True)[1]
    return order == 0 or counts.max(initial=0) <= degree - order or not len(counts)


def test_a_v_derivative_leaves_each_row_its_own_knots():
    surface = surface_over([[0.5], [0.25, 0.5], [], [0.75]])
    derivative = derivative_surface(surface, 0, 1)
    assert [c.degree for c in derivative.control_curves] == [2] * 4
    assert [inner(c) for c in derivative.control_curves] == [[0.5], [0.25, 0.5], [], [0.75]]


def test_a_u_derivative_needs_only_the_knots_of_neighbouring_rows():
    surface = surface_over([[0.5], [0.25, 0.5], [], [0.75]])
    first, second = derivative_surface(surface, 1, 0), derivative_surface(surface, 2, 0)
    assert (first.degree_u, second.degree_u) == (2, 1)
    assert [inner(c) for c in first.control_curves] == [[0.25, 0.5], [0.25, 0.5], [0.75]]
    assert [inner(c) for c in second.control_curves] == [[0.25, 0.5], [0.25, 0.5, 0.75]]
    assert first.n_control_points < first.to_bspline().n_control_points


def test_the_derivative_of_a_classical_surface_is_the_classical_one():
    rng = np.random.default_rng(0)
    knots = np.array([0, 0, 0, 0, 0.4, 1, 1, 1, 1])
    surface = BSplineSurface(3, 3, knots, knots, rng.uniform(-1, 1, (5, 5, 3)))
    mixed = derivative_surface(surface, 1, 1)
    assert (mixed.degree_u, mixed.degree_v, mixed.control_points.shape) == (2, 2, (4, 4, 3))
    semi = derivative_surface(surface.to_semistructured(), 1, 1)
    assert np.abs(semi.to_bspline().control_points - mixed.control_points).max() <= 1e-13 * 9 * 6
    u, v = sample(surface)
    assert np.abs(surface_points(mixed, u, v) - surface_points(surface, u, v, 1, 1)).max() <= 1e-12


def test_a_jump_is_named_with_its_place():
    surface = surface_over([[0.5, 0.5, 0.5], [], [], []])
    with pytest.raises(InputError, match=r"derivative \(0, 1\), row 0: .* jumps by .* at v = 0.5.*split_v"):
        derivative_surface(surface, 0, 1)
    creased = SemiStructuredSurface(1, [0, 0, 0.5, 1, 1], surface.control_curves[1:])
    with pytest.raises(InputError, match=r"derivative \(1, 0\): .* jumps by .* at u = 0.5.*split_u"):
        derivative_surface(creased, 1, 0)


def test_a_knot_that_only_looks_like_a_crease_does_not_stop_a_derivative():
    smooth = surface_over([[], [0.25], [], []])
    u, v = sample(smooth)
    for order in ((0, 1), (1, 1), (0, 2)):
        expected = surface_points(smooth, u, v, *order)
        # Full multiplicity without a crease, in one row and in u.
        for surface in (insert_row_knot(smooth, 1, 0.5, 3), doubled_in_u(smooth)):
            derivative = derivative_surface(surface, *order)
            assert np.abs(surface_points(derivative, u, v) - expected).max() <= TOLERANCE * scale(smooth, *order)


def doubled_in_u(surface):
    from semispline.solver.splines.operations import insert_knots

    return insert_knots(surface, knots_u=[0.5] * surface.degree_u)


def test_a_crease_that_cancels_between_rows_does_not_stop_a_mixed_derivative():
    crease = curve_over([0.5, 0.5, 0.5])
    shifted = BSplineCurve(3, crease.knots, crease.control_points + np.array([1, 2, 3]))
    surface = SemiStructuredSurface(1, [0, 0, 1, 1], [crease, shifted])
    with pytest.raises(InputError):
        derivative_surface(surface, 0, 1)
    assert np.abs(derivative_surface(surface, 1, 1).evaluate([0.5], [0.5])).max() <= 1e-12
    assert np.abs(derivative_surface(surface, 1, 0).evaluate([0.5], [0.5]) - [[1, 2, 3]]).max() <= 1e-14


def test_a_derivative_that_vanishes_is_a_surface_of_zeros():
    surface = surface_over([[]] * 4)
    for order in ((4, 0), (0, 4), (5, 7)):
        assert not derivative_surface(surface, *order).evaluate_grid([0, 0.5, 1], [0, 0.5, 1]).any()


def test_above_the_degree_there_is_no_derivative_where_a_lower_one_jumps():
    # Both sides of the fourth derivative are zero at 1/2, but the third jumps there.
    with pytest.raises(InputError, match=r"derivative \(0, 4\), row 0: .* at v = 0.5"):
        derivative_surface(surface_over([[0.5], [], [], []]), 0, 4)


def test_a_constant_derivative_has_degree_one():
    line = derivative_curve(BSplineCurve(1, [0, 0, 0.5, 1, 1], [[0, 0, 0], [1, 0, 0], [2, 0, 0]]))
    assert (line.degree, line.knots.tolist()) == (1, [0, 0, 1, 1])
    assert line.control_points.tolist() == [[2, 0, 0], [2, 0, 0]]


@pytest.mark.parametrize("order", [(-1, 0), (0, 0.5), (0, True)])
def test_orders_of_a_derivative_are_whole_numbers(order):
    with pytest.raises(OptionError, match=r"d[uv]: found"):
        derivative_surface(surface_over([[]] * 4), *order)


def test_a_rational_surface_has_no_derivative_surface():
    square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], np.ones((2, 2, 3)), np.ones((2, 2)))
    with pytest.raises(InputError, match="rational"):
        derivative_surface(square, 1, 0)


# --- one curve alone --------------------------------------------------------------------------------------------


@pytest.mark.long
@laws
@given(semistructured_surfaces(), SEEDS, st.data())
def test_a_knot_in_one_curve_changes_no_point_and_no_other_curve(surface, seed, data):
    i = data.draw(st.integers(0, len(surface.control_curves) - 1))
    u, v = sample(surface, seed)
    times = data.draw(st.integers(1, surface.control_curves[i].degree))
    finer = insert_row_knot(surface, i, v[0], times)
    assert finer.n_control_points == surface.n_control_points + times
    assert all(finer.control_curves[j] is c for j, c in enumerate(surface.control_curves) if j != i)
    limit = TOLERANCE * scale(surface)
    assert np.abs(surface_points(finer, u, v) - surface_points(surface, u, v)).max() <= limit


@pytest.mark.long
@laws
@given(semistructured_surfaces(), SEEDS, st.data())
def test_continuity_is_lowered_exactly_and_raised_again(surface, seed, data):
    i = data.draw(st.integers(0, len(surface.control_curves) - 1))
    curve = surface.control_curves[i]
    v = float(np.random.default_rng(seed).uniform(*surface.domain[1]))
    least = data.draw(st.integers(0, curve.degree - 1))
    bent = set_row_continuity(surface, i, v, least)
    assert np.count_nonzero(bent.control_curves[i].knots == v) == curve.degree - least
    back = set_row_continuity(bent, i, v, curve.degree, tolerance=1e-9)
    assert np.array_equal(back.control_curves[i].knots, curve.knots)
    x = np.linspace(*surface.domain[1], 40)
    assert np.abs(back.control_curves[i].evaluate(x) - curve.evaluate(x)).max() <= 1e-11


def test_continuity_that_the_curve_does_not_have_is_refused():
    surface = surface_over([[0.5], [0.5, 0.5, 0.5], [], []])
    with pytest.raises(KnotError, match=r"cannot be C1 at v = 0.5: its control points would move by"):
        set_row_continuity(surface, 1, 0.5, 1)
    with pytest.raises(KnotError, match="cannot be C3"):
        set_row_continuity(surface, 0, 0.5, 3)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7])
def test_the_tolerance_decides_what_counts_as_smooth(tolerance):
    curve = set_curve_continuity(curve_over([0.2, 0.8]), 0.5, 0)
    extent = np.ptp(curve.control_points, axis=0).max()
    points = curve.control_points.copy()
    # The point at the crease itself, pushed off the smooth curve.
    at = int(np.argmin(np.linalg.norm(points - curve.evaluate([0.5]), axis=1)))
    points[at] += [0, 0, tolerance * extent]
    creased = BSplineCurve(3, curve.knots, points)
    assert inner(set_curve_continuity(creased, 0.5, 3, tolerance=tolerance)) == [0.2, 0.8]
    with pytest.raises(KnotError, match="would move by"):
        set_curve_continuity(creased, 0.5, 3, tolerance=tolerance / 20)


def test_a_bent_curve_moves_alone_and_only_around_its_knot():
    surface = set_row_continuity(surface_over([[], [0.2, 0.4, 0.6, 0.8], [], []]), 1, 0.5, 0)
    curve = surface.control_curves[1]
    at = int(np.argmin(np.linalg.norm(curve.control_points - curve.evaluate([0.5]), axis=1)))
    points = curve.control_points.copy()
    points[at] += [0, 0, 1]
    rows = list(surface.control_curves)
    rows[1] = BSplineCurve(3, curve.knots, points)
    bent = SemiStructuredSurface(3, surface.knots_u, rows)
    u, v = np.full(9, 0.5), np.linspace(0, 1, 9)
    moved = np.linalg.norm(bent.evaluate(u, v) - surface.evaluate(u, v), axis=1) > 1e-12
    # Support of the middle function of a triple knot at 1/2 between 0.4 and 0.6: only v = 1/2 of this grid.
    assert moved.tolist() == [False] * 4 + [True] + [False] * 4
    assert np.array_equal(bent.evaluate(u[:2] * 0, v[:2]), surface.evaluate(u[:2] * 0, v[:2]))


def test_removal_within_a_tolerance_moves_points_by_no_more_than_it_and_keeps_the_ends():
    curve = curve_over([0.2, 0.5, 0.8])
    loose = set_curve_continuity(curve, 0.5, 3, tolerance=1.0)
    assert inner(loose) == [0.2, 0.8]
    assert np.array_equal(loose.control_points[[0, -1]], curve.control_points[[0, -1]])
    x = np.linspace(0, 1, 200)
    off = curve_points(3, loose.knots, loose.control_points, x) - curve_points(3, curve.knots, curve.control_points, x)
    extent = np.ptp(curve.control_points, axis=0).max()
    assert 1e-3 < np.linalg.norm(off, axis=1).max() <= extent


def test_removal_in_a_long_curve_touches_only_its_neighbourhood():
    curve = curve_over(np.arange(1, 2000) / 2000)
    finer = set_curve_continuity(curve, 0.50025, 1)
    back = set_curve_continuity(finer, 0.50025, 3)
    differs = np.flatnonzero(np.any(back.control_points != curve.control_points, axis=1))
    assert len(differs) <= 6
    assert np.abs(back.control_points - curve.control_points).max() <= 1e-13


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ((4, 0.5, 1), InputError, "i: found 4, expected the index"),
        ((-1, 0.5, 1), InputError, "i: found -1"),
        ((0, 0.5, 4), OptionError, "continuity: found 4"),
        ((0, 0.5, -1), OptionError, "continuity: found -1"),
        ((0, 1.0, 1), KnotError, "v: found 1.0, expected a value inside"),
        ((0, float("nan"), 1), KnotError, "v: found nan"),
    ],
)
def test_calls_that_make_no_sense_are_refused(arguments, error, message):
    with pytest.raises(error, match=message):
        set_row_continuity(surface_over([[]] * 4), *arguments)


def test_compatible_curves_keep_the_shared_vector():
    curves = [curve_over([0.5], seed=i) for i in range(3)]
    same = compatible_curves(curves)
    assert np.array_equal(same.knots, curves[0].knots)
    assert np.array_equal(same.homogeneous, np.stack([c.control_points for c in curves]))


def test_points_outside_the_domain_are_refused_not_extrapolated():
    surface = surface_over([[]] * 4)
    assert len(parameters(np.random.default_rng(0), (0, 1))) == 14
    with pytest.raises(InputError, match=r"u\[1\]: found 1.5, expected a parameter in \[0.0, 1.0\]"):
        surface.evaluate([0.5, 1.5], [0.5, 0.5])
