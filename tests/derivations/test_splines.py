"""B-spline pieces and end derivatives: against the definition, against SciPy, and for a symbol p."""

from fractions import Fraction
from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from sympy import Matrix, Rational, Symbol, cancel, diag

from semispline.derivations.splines import (
    X,
    basis_pieces,
    end_derivative_step,
    end_derivatives,
    end_derivatives_from_pieces,
    evaluate_exact,
    exact_knots,
    span_symbols,
)


def is_zero(matrix):
    return matrix.applyfunc(cancel).is_zero_matrix is True


@st.composite
def rational_splines(draw):
    degree = draw(st.integers(1, 7))
    inner = sorted(draw(st.lists(st.fractions(0, 1, max_denominator=9), max_size=3, unique=True)))
    counts = [draw(st.integers(1, degree)) for _ in inner]
    middle = [x for x, count in zip(inner, counts, strict=True) if 0 < x < 1 for _ in range(count)]
    knots = [Fraction(0)] * (degree + 1) + middle + [Fraction(1)] * (degree + 1)
    n = len(knots) - degree - 1
    coefficients = draw(st.lists(st.fractions(-9, 9, max_denominator=4), min_size=n, max_size=n))
    return degree, knots, coefficients


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("order", range(5))
def test_closed_form_passes_from_degree_to_degree(order, end):
    # Induction step for a symbol p; with the base case below, the closed form holds for every degree.
    assert end_derivative_step(order, end).is_zero_matrix is True


def test_closed_form_holds_for_degree_zero():
    expected = Matrix(4, 4, lambda d, i: int(d == i == 0))
    assert end_derivatives(3, 0, span_symbols(3)) == expected


def test_induction_step_sees_a_wrong_closed_form(monkeypatch):
    right = end_derivatives

    def wrong(order, degree, spans):
        # What the appendix of the paper prints: the width h_2 left out.
        return right(order, degree, [spans[0]] * len(spans))

    monkeypatch.setattr("semispline.derivations.splines.end_derivatives", wrong)
    assert not is_zero(end_derivative_step(2))


@pytest.mark.parametrize("degree", range(1, 8))
def test_pieces_give_the_closed_form_at_both_ends(degree):
    closed = end_derivatives(3, degree, span_symbols(3))
    assert is_zero(end_derivatives_from_pieces(3, degree, "start") - closed)
    mirrored = diag(*((-1) ** d for d in range(4))) * closed
    assert is_zero(end_derivatives_from_pieces(3, degree, "end") - mirrored)


@pytest.mark.parametrize("degree", [1, 2])
def test_a_low_degree_has_zero_higher_derivatives_whatever_the_missing_spans(degree):
    h = span_symbols(3)
    rows = end_derivatives(3, degree, h)
    assert rows[degree + 1 :, :].is_zero_matrix
    assert rows[: degree + 1, degree + 1 :].is_zero_matrix
    # h_r beyond the degree has no influence: a spline of this degree need not have such a knot.
    assert not rows.free_symbols & set(h[degree:])


def test_one_span_is_the_bernstein_basis():
    for degree in range(1, 6):
        (span,) = basis_pieces(degree, [0] * (degree + 1) + [1] * (degree + 1))
        for i, piece in enumerate(span.pieces):
            assert (piece.as_expr() - comb(degree, i) * X**i * (1 - X) ** (degree - i)).expand() == 0


def test_symbolic_knots_with_numbers_put_in_are_the_rational_ones():
    symbolic = basis_pieces(3, [0, 0, 0, 0, "s", "t", "t", 1, 1, 1, 1])
    numbers = {Symbol("s"): Rational(1, 3), Symbol("t"): Rational(3, 4)}
    rational = basis_pieces(3, [0, 0, 0, 0, "1/3", "3/4", "3/4", 1, 1, 1, 1])
    assert len(symbolic) == len(rational) == 3
    for one, other in zip(symbolic, rational, strict=True):
        assert one.first == other.first
        for left, right in zip(one.pieces, other.pieces, strict=True):
            assert cancel(left.as_expr().subs(numbers) - right.as_expr()) == 0


@pytest.mark.long
@given(rational_splines())
def test_pieces_sum_to_one(spline):
    degree, knots, _ = spline
    for span in basis_pieces(degree, knots):
        assert sum(span.pieces[1:], span.pieces[0]).as_expr() == 1


@given(rational_splines(), st.fractions(0, 1, max_denominator=30), st.integers(0, 4))
def test_exact_evaluation_agrees_with_scipy(spline, x, derivative):
    degree, knots, coefficients = spline
    value = evaluate_exact(degree, knots, coefficients, x, derivative)
    reference = BSpline(np.array(knots, float), np.array(coefficients, float), degree)
    # SciPy is right-continuous inside; at the end it takes the last piece, as we do.
    found = reference(float(x), nu=derivative)
    # SciPy rounds: eps times the growth of each difference, 2 p / gap, with gaps of at least 1/72.
    size = max(1.0, max(map(abs, coefficients), default=0)) * (2 * degree * 72) ** min(derivative, degree)
    # A knot such as 1/3 is not the double beside it: off knots only.
    if x in (0, 1) or x not in knots:
        assert float(value) == pytest.approx(float(found), abs=1e-13 * float(size))


@pytest.mark.long
@given(rational_splines())
@settings(max_examples=40)
def test_end_derivatives_agree_with_exact_evaluation(spline):
    degree, knots, coefficients = spline
    order = min(3, len(coefficients) - 1)
    for end, x, ordered in (("start", 0, coefficients), ("end", 1, coefficients[::-1])):
        counted = knots if end == "start" else [1 - knot for knot in reversed(knots)]
        spans = [counted[min(degree + r, len(knots) - 1)] for r in range(1, order + 1)]
        closed = end_derivatives(order, degree, [Rational(h) for h in spans])
        for d in range(order + 1):
            row = sum(closed[d, i] * Rational(ordered[i]) for i in range(order + 1))
            assert row * (-1 if end == "end" else 1) ** d == evaluate_exact(degree, knots, coefficients, x, d)


@pytest.mark.parametrize(
    ("knots", "words"),
    [
        ([0.5], "found 0.5, expected an integer"),
        ([float("nan")], "expected an integer"),
        (["1/0"], "found '1/0'"),
        (["x"], "found 'x'"),
        (["lambda"], "found 'lambda'"),
        (["__import__('os')"], "expected an integer, a fraction or a name"),
        ([0, 1, "1/2"], "found 1/2 after 1"),
        (["2**(1/2)"], "expected an integer"),
    ],
)
def test_bad_knots_are_named(knots, words):
    with pytest.raises(ValueError, match="knots") as caught:
        exact_knots(knots)
    assert words in str(caught.value)


def test_bad_calls_are_refused():
    with pytest.raises(ValueError, match="3 knots for degree 1, expected at least 4"):
        basis_pieces(1, [0, 0, 1])
    with pytest.raises(ValueError, match="expected 2"):
        evaluate_exact(1, [0, 0, 1, 1], [1], 0)
    with pytest.raises(ValueError, match=r"expected a parameter in \[0, 1\]"):
        evaluate_exact(1, [0, 0, 1, 1], [1, 2], 2)
    with pytest.raises(ValueError, match="'middle'"):
        end_derivatives_from_pieces(1, 2, "middle")
