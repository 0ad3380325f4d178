"""Knots and cuts that differ by rounding: nothing as narrow as rounding is left behind, and none is confused."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import surfaces
from helpers.sweeps import examples
from semispline import merge_knots
from semispline.solver.errors import KnotError
from semispline.solver.judge.curvature import mean_curvature
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines.curves import insert_curve_knots, restrict_curve, set_curve_continuity, split_curve
from semispline.solver.splines.operations import all_control_points, elevate_degree, insert_knots, split_u, split_v
from semispline.solver.splines.refinement import snapped
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

NEAR = 0.1 + 0.2
UNIT = [0, 0, 1, 1]


def curve_over(inner, degree=3, seed=0):
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return BSplineCurve(degree, knots, np.random.default_rng(seed).uniform(-1, 1, (len(knots) - degree - 1, 3)))


def between(*rows):
    return SemiStructuredSurface(1, UNIT, [curve_over(row, seed=i) for i, row in enumerate(rows)])


def inner(curve):
    return curve.knots[curve.degree + 1 : -curve.degree - 1].tolist()


@pytest.mark.parametrize("other", [NEAR, 0.3 + 9e-13, 0.3 - 9e-13])
@pytest.mark.parametrize("at", [0.3, NEAR])
def test_a_cut_meets_the_knot_of_each_row_that_it_means(at, other):
    surface = between([0.3, 0.7], [other, 0.5])
    low, high = split_v(surface, at)
    cut = low.domain[1][1]
    assert high.domain[1][0] == cut
    assert abs(cut - 0.3) <= 1e-12
    assert [inner(c) for c in low.control_curves] == [[], []]
    assert [inner(c) for c in high.control_curves] == [[0.7], [0.5]]
    u = np.array([0.2, 0.7])
    for piece, end, side in ((low, cut, 0.3 - 1e-12), (high, cut, 0.3 + 1e-12)):
        for dv in range(3):
            expected = surface_points(surface, u, np.full(2, side), 0, dv)
            # A step of 2e-12 in v and a knot moved as far, against a third derivative of some thousand.
            assert np.abs(piece.evaluate(u, [end], 0, dv) - expected).max() <= 1e-8
        assert np.allclose(mean_curvature(piece, u, [end]), mean_curvature(surface, u, [side]), rtol=1e-7)


@pytest.mark.parametrize("degree", [1, 2, 5])
def test_pieces_of_a_curve_leave_no_sliver(degree):
    near = np.nextafter(0.3, 1)
    curve = curve_over([*[0.3] * degree, *[near] * degree, 0.6], degree)
    low, high = split_curve(curve, 0.3)
    assert (inner(low), inner(high)) == ([], [0.6])
    for side in (-1, 1):
        low, high = split_curve(curve, np.nextafter(0.6, side * np.inf))
        assert (low.knots[-1], high.knots[0]) == (0.6, 0.6)
    # Farther than the tolerance, a knot stays.
    assert inner(restrict_curve(curve, 0.3 - 2e-12, 1.0)) == inner(curve)
    assert inner(restrict_curve(curve, 0.0, 0.3 - 0.9e-12)) == []


@examples(30)
@given(surfaces(), st.sampled_from([-1, 1]))
def test_a_cut_next_to_a_knot_means_the_knot(surface, side):
    for direction, split in ((0, split_u), (1, split_v)):
        start, end = surface.domain[direction]
        for knot in surface.breakpoints[direction][1:-1]:
            low, high = split(surface, np.nextafter(knot, side * np.inf))
            assert low.domain[direction][1] == high.domain[direction][0] == knot
            apart = knot + side * 1e-11 * (end - start)
            assert split(surface, apart)[0].domain[direction][1] == apart


@pytest.mark.parametrize(("off", "found"), [(0.9e-12, 0.3), (-0.9e-12, 0.3), (1.1e-12, 0.3 + 1.1e-12)])
@pytest.mark.parametrize("scale", [1.0, 1e6])
def test_a_value_means_a_knot_within_a_fixed_fraction_of_the_domain(off, found, scale):
    knots = np.array([0, 0, 0, 0, 0.3, 1, 1, 1, 1]) * scale
    assert snapped((0.3 + off) * scale, knots) == (found * scale if found != 0.3 else knots[4])


def test_inserted_knots_mean_each_other():
    plain = curve_over([])
    with pytest.raises(KnotError, match=r"knots\[0\]: knot 0.3 would have multiplicity 4, expected at most 3"):
        insert_curve_knots(plain, [0.3, 0.3, 0.3, NEAR])
    assert inner(insert_curve_knots(plain, [NEAR, 0.3, 0.7])) == [NEAR, NEAR, 0.7]
    assert inner(insert_curve_knots(plain, [0.3, 0.3 + 2e-12])) == [0.3, 0.3 + 2e-12]
    finer = insert_curve_knots(curve_over([0.3]), [NEAR])
    assert inner(finer) == [0.3, 0.3]
    surface = BSplineSurface(1, 1, UNIT, UNIT, np.zeros((2, 2, 3)))
    for name in ("knots_u", "knots_v"):
        with pytest.raises(KnotError, match=rf"{name}\[0\]: knot 0.3 would have multiplicity 2"):
            insert_knots(surface, **{name: [0.3, NEAR]})


def test_continuity_next_to_a_knot_is_that_at_the_knot():
    curve = curve_over([0.3])
    assert inner(set_curve_continuity(curve, NEAR, 0)) == [0.3] * 3
    smooth = insert_curve_knots(curve_over([]), [0.3])
    assert inner(set_curve_continuity(smooth, NEAR, 3)) == []


@pytest.mark.parametrize("near", [1e-13, 1 - 1e-13])
def test_a_knot_next_to_an_end_becomes_the_end_on_conversion(near):
    surface = between([near], [0.5])
    merged = merge_knots(surface)
    assert surface.to_bspline().knots_v[4:-4].tolist() == [0.5]
    assert merged.knot_shift == pytest.approx(1e-13, rel=1e-2)
    v = np.array([0.0, near, 0.4, 1.0])
    moved = np.abs(surface_points(surface.to_bspline(), [0.0], v) - surface_points(surface, [0.0], v)).max()
    assert 1e-15 < moved <= merged.change
    # The slope there is at most 3 * 2 / 1e-13 over 1e-13: the net moves by its own size, the curve by as much.
    assert merged.change <= 4
    for tolerance in (0.0, 1e-14):
        assert near in merge_knots(surface, tolerance).surface.control_curves[0].knots
    wide = merge_knots(between([1e-3], [0.5]), 0.01).surface
    assert wide.to_bspline().knots_v[4:-4].tolist() == [1e-3, 0.5]


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7])
def test_removal_is_decided_within_a_factor_of_three_of_the_tolerance(tolerance):
    smooth = set_curve_continuity(curve_over([0.2, 0.8]), 0.5, 0)
    extent = np.ptp(smooth.control_points, axis=0).max()
    at = int(np.argmin(np.linalg.norm(smooth.control_points - smooth.evaluate([0.5]), axis=1)))
    # How far the point at the crease is from its place on the nearest smooth curve, when raised by 1: by least squares
    # over the ones that refining the smooth curve reaches, all of them here.
    kept = curve_over([0.2, 0.8])
    rise = np.zeros(len(smooth.control_points))
    rise[at] = 1.0
    columns = []
    for i in range(len(kept.control_points)):
        unit = BSplineCurve(3, kept.knots, np.eye(len(kept.control_points))[i][:, None] * [0, 0, 1.0])
        columns.append(insert_curve_knots(unit, [0.5] * 3).control_points[:, 2])
    matrix = np.column_stack(columns)
    free = [i for i in range(matrix.shape[1]) if np.count_nonzero(matrix[:, i]) > 1]
    miss = np.abs(matrix[:, free] @ np.linalg.lstsq(matrix[:, free], rise, rcond=None)[0] - rise).max()
    for share, fits in ((0.5, True), (2.0, False)):
        height = share * tolerance * extent / miss
        creased = BSplineCurve(3, smooth.knots, smooth.control_points + np.outer(rise, [0, 0, height]))
        if fits:
            assert inner(set_curve_continuity(creased, 0.5, 3, tolerance)) == [0.2, 0.8]
        else:
            with pytest.raises(KnotError, match="would move by"):
                set_curve_continuity(creased, 0.5, 3, tolerance)


@pytest.mark.parametrize("degree", [1, 3])
def test_the_bound_of_a_merged_knot_is_met_within_a_factor_of_ten(degree):
    rows = [curve_over([0.3], degree, 0), curve_over([0.31], degree, 1)]
    surface = SemiStructuredSurface(1, UNIT, rows)
    merged = merge_knots(surface, 0.02)
    u, v = np.ones(4000), np.linspace(0, 1, 4000)
    moved = np.linalg.norm(surface_points(merged.surface, u, v) - surface_points(surface, u, v), axis=1).max()
    assert moved <= merged.change <= 10 * moved


def many_kinds():
    """Rows of different degrees and knots between -1 and 1, whose points far away are floats too."""
    rng = np.random.default_rng(0)
    rows = [curve_over(np.sort(rng.uniform(0, 1, n)), d, n) for d, n in ((1, 20), (2, 15), (3, 20), (5, 10), (3, 5))]
    rows = [replace(row, control_points=(row.control_points + 1e6) - 1e6) for row in rows]
    return SemiStructuredSurface(2, [0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1], rows)


@pytest.mark.parametrize("offset", [1e3, -1e6])
@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.to_bspline(),
        lambda s: elevate_degree(s, degree_v=7),
        lambda s: insert_knots(s, knots_v=np.linspace(0.05, 0.93, 9)),
        lambda s: insert_knots(between_of(s), np.linspace(0.05, 0.93, 9)),
        lambda s: elevate_degree(between_of(s), 5),
        lambda s: elevate_degree(between_of(s), degree_v=6),
        lambda s: split_v(s, 0.31)[1],
    ],
)
def test_far_from_the_origin_only_the_result_rounds(change, offset):
    near = many_kinds()
    far = replace(
        near, control_curves=[replace(c, control_points=c.control_points + offset) for c in near.control_curves]
    )
    here, there = (all_control_points(change(s)) for s in (near, far))
    # Half of the spacing, and what rounds near the origin.
    assert np.abs((there - offset) - here).max() <= 0.501 * np.spacing(abs(offset))


def between_of(surface):
    """A surface of one kind that has the same points as one of the rows."""
    row = surface.control_curves[2]
    return BSplineSurface(1, 3, UNIT, row.knots, np.stack([row.control_points, row.control_points]))
