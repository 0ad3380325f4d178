"""B-splines by their definition, as text and in numbers: known answers, and SciPy's."""

from fractions import Fraction

import pytest
from scipy.interpolate import BSpline

from semispline.papers.recheck.arithmetic import instance, value
from semispline.papers.recheck.definition import (
    Lets,
    basis_number,
    basis_polynomial,
    curve_jet,
    derivative,
    end_jets,
    integral,
    span_of,
    span_value,
    triangle,
)
from semispline.papers.recheck.texts import Text

KNOTS = tuple(map(Fraction, (0, 0, 0, 0, "1/3", "1/2", "1/2", 1, 1, 1, 1)))


def numbers(texts, lets, **at):
    values = instance([(name, str(x)) for name, x in at.items()], lets.pairs)
    return [value(str(found), values) for found in texts]


def test_end_derivatives_of_a_cubic():
    lets = Lets("c")
    jet = curve_jet(end_jets(lets, 3, [Text("h1"), Text("h2")], 2), [Text(f"P{i}") for i in range(4)])
    at = {"h1": 2, "h2": 5, "c_far3": 7, "P0": 1, "P1": 4, "P2": 6, "P3": 100}
    first, second = 3 * Fraction(3, 2), Fraction(6, 2) * (Fraction(2, 5) - Fraction(3, 2))
    assert numbers([derivative(jet, d) for d in range(3)], lets, **at) == [1, first, second]


def test_the_end_is_the_start_mirrored():
    lets = Lets("c")
    jet = curve_jet(end_jets(lets, 3, [Text("h1"), Text("h2")], 2, "end"), [Text(f"P{i}") for i in range(4)])
    at = {"h1": 2, "h2": 5, "c_far3": 7, "P0": 1, "P1": 4, "P2": 6, "P3": 100}
    first, second = -3 * Fraction(3, 2), Fraction(6, 2) * (Fraction(2, 5) - Fraction(3, 2))
    assert numbers([derivative(jet, d) for d in range(3)], lets, **at) == [1, first, second]


@pytest.mark.parametrize(
    "x", [Fraction(0), Fraction(1, 5), Fraction(1, 3), Fraction(1, 2), Fraction(4, 5), Fraction(1)]
)
def test_functions_are_those_of_scipy(x):
    for i in range(len(KNOTS) - 4):
        unit = [float(j == i) for j in range(len(KNOTS) - 4)]
        # Rounding of a few products of numbers up to 1.
        assert float(basis_number(4, KNOTS, i, x)) == pytest.approx(
            float(BSpline(list(map(float, KNOTS)), unit, 3)(float(x))), abs=1e-14
        )


@pytest.mark.parametrize("x", [Fraction(1, 5), Fraction(2, 5), Fraction(4, 5)])
def test_sum_triangle_and_numbers_agree(x):
    span, points = span_of(KNOTS, x), [Fraction(n * n, 3) for n in range(len(KNOTS) - 4)]
    by_sum, by_triangle = Lets("c"), Lets("d")
    texts = [span_value(by_sum, 4, KNOTS, i, "x", span) for i in range(len(points))]
    found = sum(a * b for a, b in zip(numbers(texts, by_sum, x=x), points, strict=True))
    assert [found] == numbers([triangle(by_triangle, 4, KNOTS, points, "x", span)], by_triangle, x=x)
    assert found == sum(basis_number(4, KNOTS, i, x) * p for i, p in enumerate(points))
    polynomials = [basis_polynomial(4, KNOTS, i, span) for i in range(len(points))]
    assert found == sum(
        c * x**n * p for polynomial, p in zip(polynomials, points, strict=True) for n, c in enumerate(polynomial)
    )


def test_integrals_of_hats():
    hat = tuple(map(Fraction, (0, 0, 1, 3, 3)))
    assert integral(2, (hat, 1, 0)) == Fraction(3, 2)
    assert integral(2, (hat, 1, 0), (hat, 1, 0)) == 1
    assert integral(2, (hat, 1, 1), (hat, 2, 1)) == -Fraction(1, 2)
