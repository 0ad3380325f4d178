"""The circle that is the square of a complex spline: exactly round, exactly smooth, and no smoother."""

from itertools import pairwise

import pytest
from sympy import Rational, binomial, expand, symbols

from semispline.derivations.circles import (
    bernstein_product,
    circle_points,
    circle_residuals,
    half_turns,
    jumps,
    uniform_pieces,
)

S = symbols("s")


def polynomial(points):
    n = len(points) - 1
    return expand(sum(binomial(n, k) * S**k * (1 - S) ** (n - k) * p for k, p in enumerate(points)))


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5])
def test_it_is_round_and_smooth_at_joints_and_seam(degree, count):
    residuals = circle_residuals(degree, count)
    assert len(residuals["circle"]) == count * (4 * degree + 1)
    assert len(residuals["joints"]) == 3 * degree * (count - 1)
    assert len(residuals["seam"]) == (3 * degree if count == 2 else 0)
    assert all(value == 0 for values in residuals.values() for value in values)


@pytest.mark.parametrize("degree", [2, 3, 4, 5])
def test_it_is_no_smoother(degree):
    before, after = half_turns(degree, 2)
    assert any(jump != 0 for jump in jumps(before, after, degree, least=degree))


def test_the_eleven_points():
    half = [
        (1, 0, 1),
        (1, Rational(1, 2), 1),
        (Rational(13, 20), 1, Rational(19, 20)),
        (0, Rational(49, 40), Rational(9, 10)),
        (Rational(-13, 20), 1, Rational(19, 20)),
        (Rational(-27, 20), 0, Rational(21, 20)),
    ]
    assert circle_points(3) == tuple(half + [(x, -y, w) for x, y, w in half[-2::-1]])


@pytest.mark.parametrize(("degree", "ratio"), [(2, 0.75), (3, 0.86), (4, 0.97), (5, 0.99)])
def test_weights_are_positive_and_even(degree, ratio):
    weights = [w for _, _, w in circle_points(degree)]
    assert len(weights) == 3 * degree + 2
    assert min(weights) / max(weights) == pytest.approx(ratio, abs=0.006)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_pieces_of_a_uniform_spline(degree):
    points = symbols(f"p:{degree + 3}")
    pieces = [polynomial(piece) for piece in uniform_pieces(degree, points)]
    assert len(pieces) == 3
    # Cardinal splines: they sum to one, are C^(degree - 1), and a power x^1 has the Greville points.
    ones = [polynomial(piece) for piece in uniform_pieces(degree, [1] * (degree + 3))]
    assert ones == [1, 1, 1]
    greville = [k - Rational(degree - 1, 2) for k in range(degree + 3)]
    assert [polynomial(piece) for piece in uniform_pieces(degree, greville)] == [S + k for k in range(3)]
    for one, other in pairwise(pieces):
        for d in range(degree):
            assert expand(one.diff(S, d).subs(S, 1) - other.diff(S, d).subs(S, 0)) == 0


def test_bernstein_product():
    a, b = symbols("a:4"), symbols("b:3")
    assert expand(polynomial(bernstein_product(a, b)) - polynomial(a) * polynomial(b)) == 0
