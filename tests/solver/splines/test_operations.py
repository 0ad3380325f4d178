"""Operations: exact matrices, what is refused, and known small cases; the laws are in test_surfaces_laws."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import basis, knot_vectors
from helpers.sweeps import examples
from semispline import insert_row_knot
from semispline.solver.errors import InputError, KnotError
from semispline.solver.splines.curves import elevate_curve, insert_curve_knots, reverse_curve, split_curve
from semispline.solver.splines.knots import basis_matrix, derivative_matrix, greville, reversed_knots
from semispline.solver.splines.operations import (
    all_control_points,
    bounding_box,
    elevate_degree,
    insert_knots,
    map_domain,
    reverse_u,
    reverse_v,
    split_u,
    split_v,
    swap_directions,
    transform,
)
from semispline.solver.splines.refinement import (
    clamp_knots,
    elevated_knots,
    elevation_matrix,
    refinement_matrix,
    restriction_matrix,
)
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface

UNIT = [0, 0, 1, 1]
SQUARE = BSplineSurface(1, 1, UNIT, UNIT, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
PARABOLA = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [1, 2, 0], [2, 0, 0]])
laws = examples(25)


def exact_basis(degree, knots, x):
    t = [Fraction(float(k)) for k in knots]
    return [basis(degree, t, i, Fraction(float(x))) for i in range(len(knots) - degree - 1)]


@laws
@given(st.integers(1, 4).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p, most=2))), st.floats(0, 1), st.data())
def test_old_basis_functions_are_sums_of_new_ones(given, x, data):
    # The defining identity, B_i = sum_j A_ji N_j, with both bases from exact fractions.
    degree, knots = given
    more = data.draw(st.lists(st.floats(0.01, 0.99), max_size=3, unique=True))
    refined = np.sort(np.concatenate([knots, [t for t in more if t not in knots]]))
    for matrix, new_degree, new_knots in (
        (refinement_matrix(degree, knots, refined), degree, refined),
        (elevation_matrix(degree, knots, degree + 2), degree + 2, elevated_knots(knots, 2)),
    ):
        dense = matrix.toarray()
        assert (dense >= 0).all()
        assert np.abs(dense.sum(axis=1) - 1).max() <= 1e-14
        new = np.array([float(b) for b in exact_basis(new_degree, new_knots, x)])
        old = np.array([float(b) for b in exact_basis(degree, knots, x)])
        assert np.abs(new @ dense - old).max() <= 1e-13


@laws
@given(st.integers(1, 4).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p, most=2))), st.floats(0.1, 0.9))
def test_a_piece_has_the_basis_of_the_whole(given, end):
    degree, knots = given
    matrix, piece = restriction_matrix(degree, knots, 0.05, end)
    for x in (0.05, (0.05 + end) / 2, np.nextafter(end, 0)):
        new = np.array([float(b) for b in exact_basis(degree, piece, x)])
        old = np.array([float(b) for b in exact_basis(degree, knots, x)])
        assert np.abs(new @ matrix.toarray() - old).max() <= 1e-13


@laws
@given(st.integers(1, 5).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p))), st.floats(0, 1))
def test_basis_and_derivative_matrices_are_those_of_the_definition(given, x):
    degree, knots = given
    t = [Fraction(float(k)) for k in knots]
    row = basis_matrix(degree, knots, np.array([x])).toarray()[0]
    assert np.abs(row - [float(b) for b in exact_basis(degree, knots, x)]).max() <= 1e-14
    if degree > 1:
        down = basis_matrix(degree - 1, knots[1:-1], np.array([x])) @ derivative_matrix(degree, knots, 1)
        exact = np.array([float(basis(degree, t, i, Fraction(x), 1)) for i in range(len(row))])
        assert np.abs(down.toarray()[0] - exact).max() <= 1e-13 * max(1.0, np.abs(exact).max())


def test_rows_that_keep_a_control_point_are_exactly_those_of_the_identity():
    rng = np.random.default_rng(0)
    knots = np.concatenate([np.zeros(4), np.sort(rng.uniform(0, 1, 20)), np.ones(4)])
    curve = BSplineCurve(3, knots, rng.uniform(-1, 1, (24, 3)))
    finer = insert_curve_knots(curve, [0.5])
    same = [np.array_equal(p, q) for p, q in zip(finer.control_points, curve.control_points, strict=False)]
    assert sum(same) >= 9
    assert np.array_equal(finer.control_points[-10:], curve.control_points[-10:])
    assert np.array_equal(split_curve(curve, 0.5)[0].control_points[0], curve.control_points[0])


def test_known_small_cases():
    assert elevate_curve(PARABOLA, 3).control_points[:, 1].tolist() == pytest.approx([0, 4 / 3, 4 / 3, 0])
    assert [c.control_points[:, 1].tolist() for c in split_curve(PARABOLA, 0.5)] == [[0, 1, 1], [1, 1, 0]]
    assert reverse_curve(PARABOLA).control_points[:, 0].tolist() == [2, 1, 0]
    assert greville(np.array([0, 0, 0, 0, 0.5, 1, 1, 1, 1]), 3).tolist() == pytest.approx([0, 1 / 6, 0.5, 5 / 6, 1])
    assert reversed_knots(np.array([0, 0, 0.25, 1, 1])).tolist() == [0, 0, 0.75, 1, 1]


@laws
@given(st.floats(-100, 100), st.floats(1e-3, 100))
def test_reversed_knots_keep_their_ends_and_stay_clamped(start, width):
    end = start + width
    knots = np.array([start, start, start, start + 0.3 * width, end, end, end])
    mirrored = reversed_knots(knots)
    assert mirrored[[0, 1, 2]].tolist() == [start] * 3
    assert mirrored[[-3, -2, -1]].tolist() == [end] * 3
    assert start < mirrored[3] < end


def test_uniform_unclamped_quadratic():
    knots, points = clamp_knots(2, [0, 1, 2, 3, 4, 5, 6], [[0.0], [2], [4], [6]])
    assert knots.tolist() == [2, 2, 2, 3, 4, 4, 4]
    assert points[:, 0].tolist() == [1, 2, 4, 5]


def test_rational_surfaces_stay_rational_and_reverse_with_their_weights():
    surface = BSplineSurface(1, 1, UNIT, UNIT, SQUARE.control_points, [[1, 2], [3, 4]])
    assert reverse_u(surface).weights.tolist() == [[3, 4], [1, 2]]
    assert reverse_v(surface).weights.tolist() == [[2, 1], [4, 3]]
    assert swap_directions(surface).weights.tolist() == [[1, 3], [2, 4]]
    assert elevate_degree(surface, 2, 1).weights.tolist() == [[1, 2], [2, 3], [3, 4]]
    assert insert_knots(surface, [0.5]).weights.tolist() == [[1, 2], [2, 3], [3, 4]]


def test_bounds_and_control_points():
    semi = insert_row_knot(SQUARE.to_semistructured(), 0, 0.5)
    assert all_control_points(semi).shape == (5, 3)
    assert bounding_box(semi).tolist() == bounding_box(SQUARE).tolist() == [[0, 0, 0], [1, 1, 0]]


def test_pieces_of_a_semistructured_surface_keep_the_knots_of_each_curve():
    semi = insert_row_knot(insert_row_knot(elevate_degree(SQUARE, 1, 2).to_semistructured(), 0, 0.3), 1, 0.7, 2)
    low, high = split_v(semi, 0.5)
    assert [c.knots.tolist() for c in low.control_curves] == [[0, 0, 0, 0.3, 0.5, 0.5, 0.5], [0, 0, 0, 0.5, 0.5, 0.5]]
    assert [len(c.control_points) for c in high.control_curves] == [3, 5]


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: swap_directions(SQUARE.to_semistructured()), InputError, r"cannot exchange u and v.*to_bspline\(\)"),
        (lambda: map_domain(SQUARE, (1, 1)), InputError, r"u_range: found \(1, 1\), expected two finite numbers"),
        (lambda: map_domain(SQUARE, None, (0, np.inf)), InputError, r"v_range: found \(0, inf\)"),
        (lambda: elevate_degree(SQUARE, 0), KnotError, "degree: found 0, expected at least the present degree 1"),
        (lambda: insert_knots(SQUARE, [0.2, 1.5]), KnotError, r"knots_u\[1\]: found 1.5, expected a value inside"),
        (lambda: insert_knots(SQUARE, [], [0.0]), KnotError, r"knots_v\[0\]: found 0.0"),
        (lambda: insert_knots(SQUARE, [0.1, 0.5, 0.5]), KnotError, r"knots_u\[1\]: knot 0.5 would have multiplicity 2"),
        (lambda: insert_knots(SQUARE, [np.nan]), KnotError, r"knots_u\[0\]: found nan"),
        (lambda: split_u(SQUARE, 0.0), KnotError, r"range \[0.0, 0.0\]: expected a range of positive length"),
        (lambda: split_v(SQUARE, 2.0), KnotError, r"range \[0.0, 2.0\]"),
        (lambda: split_v(SQUARE, np.nan), KnotError, "range"),
        (lambda: transform(SQUARE, np.eye(2)), InputError, r"matrix: shape \(2, 2\), expected \(3, 3\) or \(4, 4\)"),
        (lambda: transform(SQUARE, np.ones((4, 4))), InputError, r"matrix\[3\]: found \[1.0, 1.0, 1.0, 1.0\]"),
        (lambda: transform(SQUARE, np.eye(3), [1, 2]), InputError, r"translation: shape \(2,\), expected \(3,\)"),
        (lambda: transform(SQUARE, [[1, 0, 0], [0, 1, 0], [0, 0, np.nan]]), InputError, r"matrix\[2, 2\]: found nan"),
        (lambda: clamp_knots(2, [0, 1, 2, 3], [[0.0]]), KnotError, "knots: 4 for 1 control points of degree 2"),
        (lambda: clamp_knots(1, [0, 2, 1, 3], [[0.0], [1]]), KnotError, r"knots\[2\]: 1.0 after 2.0"),
        (lambda: clamp_knots(1, [0, 2, 2, 3], [[0.0], [1]]), KnotError, r"range \[2.0, 2.0\]"),
        (
            lambda: refinement_matrix(1, np.array([0, 0, 0.5, 1, 1]), np.array([0, 0, 1, 1])),
            KnotError,
            r"refined knots: 0.5 occurs 0 time\(s\), expected at least 1",
        ),
    ],
)
def test_what_cannot_be_done_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()
