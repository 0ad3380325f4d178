"""Knot vectors: made, merged, mapped, differenced."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import knot_vectors
from helpers.sweeps import examples
from semispline.solver.errors import KnotError
from semispline.solver.splines.knots import (
    affine_knots,
    basis_matrix,
    breakpoints,
    checked_knots,
    clamped,
    derivative_matrix,
    derivative_points,
    greville,
    inner_knots,
    merge_breakpoints,
    uniform_knots,
)

VECTORS = st.integers(1, 6).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p)))


@examples(50)
@given(VECTORS, st.floats(-1e3, 1e3), st.floats(1e-3, 1e3))
def test_mapped_knots_hit_their_ends_and_keep_their_multiplicities(given, start, width):
    degree, knots = given
    end = start + width
    mapped = affine_knots(knots, start, end)
    assert (mapped[: degree + 1] == start).all()
    assert (mapped[-degree - 1 :] == end).all()
    assert np.array_equal(np.diff(mapped) > 0, np.diff(knots) > 0)
    assert np.array_equal(affine_knots(knots, 0.0, 1.0), knots)


@examples(50)
@given(VECTORS, st.integers(0, 6), st.integers(0, 2**32 - 1))
def test_derivative_points_and_matrices_are_the_same_map(given, order, seed):
    degree, knots = given
    order = min(order, degree)
    points = np.random.default_rng(seed).uniform(-1, 1, (len(knots) - degree - 1, 2))
    matrix = derivative_matrix(degree, knots, order)
    expected = matrix @ points
    assert np.abs(derivative_points(degree, knots, points, order) - expected).max() <= 1e-13 * max(
        1.0, float(abs(matrix).sum(axis=1).max())
    )


@examples(50)
@given(VECTORS)
def test_greville_abscissae_reproduce_the_identity(given):
    # x = sum of g_i B_i: the derivative of the spline with control points g_i is 1 wherever a function has support.
    degree, knots = given
    slopes = derivative_points(degree, knots, greville(knots, degree))
    supported = knots[1 + degree : -1] > knots[1 : -1 - degree]
    assert np.abs(slopes[supported] - 1).max() <= 1e-11


def test_merging_counts_close_knots_once_and_keeps_the_ends():
    a = np.array([0, 0, 0.3, 0.6, 1, 1])
    b = np.array([0, 0, 0.3 + 1e-14, 0.6 + 1e-9, 1 - 1e-14, 1, 1])
    assert merge_breakpoints(a, b).tolist() == [0, 0.3, 0.6, 0.6 + 1e-9, 1]
    assert merge_breakpoints(a).tolist() == breakpoints(a).tolist() == [0, 0.3, 0.6, 1]


def test_small_vectors():
    assert uniform_knots(3, 1).tolist() == [0] * 4 + [1] * 4
    assert inner_knots(clamped([0.2, 0.2], 2, 0, 1), 2).tolist() == [0.2, 0.2]
    with pytest.raises(KnotError, match="n_spans: found 0"):
        uniform_knots(3, 0)


@pytest.mark.parametrize(
    ("knots", "message"),
    [
        ([0, 0, 1e-40, 1, 1], r"knots\[2\]: 1e-40 is 1e-40 after 0.0, expected the same knot or a step"),
        ([-1e308, -1e308, 0, 1e308, 1e308], r"knots: the domain has length inf, expected 1e-30 to 1e\+30"),
        ([0, 0, 1e-310, 2e-310, 2e-310], r"knots: the domain has length 2e-310"),
    ],
)
def test_vectors_that_would_overflow_are_refused(knots, message):
    with pytest.raises(KnotError, match=message):
        checked_knots(knots, 1, 3)


@pytest.mark.parametrize("count", [3, 501])
def test_basis_values_that_are_shared_cannot_be_changed(count):
    """Of few places they are kept, by the content of knots and places."""
    knots, x = uniform_knots(3, 4).copy(), np.linspace(0, 1, count)
    matrix = basis_matrix(3, knots, x)
    for part in (matrix.data, matrix.indices, matrix.indptr):
        with pytest.raises(ValueError, match="read-only"):
            part[0] = 0
    # Arrays that are changed in place ask for other values.
    before, knots[4] = matrix.toarray(), 0.125
    changed = basis_matrix(3, knots, x).toarray()
    x[1] += 1e-3
    moved = basis_matrix(3, knots, x).toarray()
    for found in (before, changed, moved):
        assert found.sum(axis=1) == pytest.approx(np.ones(count))
    assert np.abs(before - changed).max() > 1e-3
    assert np.abs(changed - moved).max() > 1e-5
