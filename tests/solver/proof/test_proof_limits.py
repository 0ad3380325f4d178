"""How much a proof leaves open, and when sums of squares are tried: from both sides."""

from dataclasses import replace

import numpy as np
import pytest
from flint import fmpq

from helpers.polynomials import polynomial
from semispline import ComputationError
from semispline.solver.proof import box_search, check_certificate
from semispline.solver.proof.box_search import best_of_grid, least_point

# (x^2 - 1)^2 + x / 4 + y^2: two wells, the left one lower.
TILTED = np.array([[1.0, 0, 1], [0.25, 0, 0], [-2, 0, 0], [0, 0, 0], [1, 0, 0]])
BOX = ((-2.0, 2.0), (-1.0, 1.0))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-10])
@pytest.mark.parametrize(("times", "valid"), [(0.5, True), (0.9, True), (1.1, False), (2.0, False)])
def test_the_value_may_be_above_the_bound_by_the_tolerance(tolerance, times, valid):
    proof = least_point(TILTED, BOX, tolerance)
    value = float(np.polynomial.polynomial.polyval2d(*proof.point, TILTED))
    # A lower bound is proved by the same parts.
    lowered = replace(proof, bound=value - times * tolerance)
    if valid:
        check_certificate(lowered)
    else:
        with pytest.raises(ComputationError, match="value at the point"):
            check_certificate(lowered)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-10])
def test_half_of_the_tolerance_is_for_the_proof(tolerance):
    proof = least_point(TILTED, BOX, tolerance)
    value = float(np.polynomial.polynomial.polyval2d(*proof.point, TILTED))
    assert value - proof.bound == pytest.approx(tolerance / 2, rel=1e-4)


@pytest.mark.parametrize(("tolerance", "expressible"), [(1e-15, True), (1e-17, False)])
def test_a_tolerance_below_the_spacing_of_floats_is_refused(tolerance, expressible):
    # x^2 + 1: floats below 1 are 1.1e-16 apart, and half of the tolerance is left for that.
    table = np.array([[1.0], [0.0], [1.0]])
    if expressible:
        check_certificate(least_point(table, ((-1.0, 1.0), (0.0, 0.0)), tolerance))
    else:
        with pytest.raises(ComputationError, match="spacing of floats"):
            least_point(table, ((-1.0, 1.0), (0.0, 0.0)), tolerance)


@pytest.mark.parametrize(("tilt", "by_squares"), [(1.0, False), (0.03, False), (0.01, True), (0.001, True)])
def test_hundreds_of_parts_come_before_sums_of_squares(tilt, by_squares):
    # (x^2 + y^2 - 1)^2 + e x: the less its circle is tilted, the more parts follow it.
    table = np.zeros((5, 5))
    for (i, j), value in {(4, 0): 1, (0, 4): 1, (2, 2): 2, (2, 0): -2, (0, 2): -2, (0, 0): 1, (1, 0): tilt}.items():
        table[i, j] = value
    proof = least_point(table, ((-2.0, 3.0), (-2.0, 2.5)), 1e-10)
    check_certificate(proof)
    assert any(leaf.squares is not None for leaf in proof.leaves) is by_squares
    # (4 x (x^2 - 1) = -e has its least root beyond -1.)
    assert -1.0 > proof.point[0] > -1.2


@pytest.mark.parametrize("a", [-3.0, -2.0, -1.998, 0.3, 1.7, 1.9, 2.0, 4.0])
@pytest.mark.parametrize("b", [-2.0, -1.0, -0.9985, -0.25, 0.97, 1.0, 5.0])
@pytest.mark.parametrize("mixed", [0.0, 0.5])
def test_the_search_ends_where_a_bowl_is_lowest_in_the_box(a, b, mixed):
    # (x - a)^2 + (y - b)^2 + 2 m (x - a) (y - b): over the box by turns, each the best for the other, to the end.
    m = mixed
    table = polynomial(
        x2y0=1, x0y2=1, x1y1=2 * m, x1y0=-2 * a - 2 * m * b, x0y1=-2 * b - 2 * m * a, x0y0=a * a + b * b + 2 * m * a * b
    )
    x, y = 0.0, 0.0
    for _ in range(100):
        x = np.clip(a - m * (y - b), *BOX[0])
        y = np.clip(b - m * (x - a), *BOX[1])
    assert best_of_grid(table, BOX) == pytest.approx((x, y), abs=1e-12)
    # A fixed parameter stays what it is.
    assert best_of_grid(table, (BOX[0], (y, y))) == pytest.approx((x, y), abs=1e-12)
    assert best_of_grid(table, ((x, x), BOX[1])) == pytest.approx((x, y), abs=1e-12)


def test_the_search_finds_the_lower_of_two_wells():
    for tilt in (0.25, -0.25):
        table = TILTED.copy()
        table[1, 0] = tilt
        x, y = best_of_grid(table, BOX)
        assert np.sign(x) == -np.sign(tilt)
        assert 4 * x * (x**2 - 1) == pytest.approx(-tilt, abs=1e-12)
        assert abs(y) < 1e-12


def test_the_search_leaves_a_saddle():
    # x y over a square: two corners are lowest.
    assert sorted(best_of_grid(polynomial(x1y1=1), ((-1.0, 1.0), (-1.0, 1.0)))) == [-1.0, 1.0]


@pytest.mark.parametrize("at", [(0.0, 0.0), (0.3, -0.7), (5.0, 0.25), (0.5, -3.0)])
def test_a_bowl_is_proved_by_its_tangent_in_one_part(at):
    a, b = at
    table = polynomial(x2y0=1, x1y0=-2 * a, x0y2=1, x0y1=-2 * b, x0y0=a * a + b * b)
    proof = least_point(table, BOX, 1e-10)
    check_certificate(proof)
    (leaf,) = proof.leaves
    assert leaf.tangent_at == pytest.approx([(np.clip(a, -2, 2) + 2) / 4, (np.clip(b, -1, 1) + 1) / 2])


@pytest.mark.parametrize("start", [(0.96, 0.0), (2.0, 1.0), (0.03, 0.0)])
def test_the_proof_finds_the_well_that_the_search_has_missed(monkeypatch, start):
    monkeypatch.setattr(box_search, "best_of_grid", lambda table, box: start)
    proof = least_point(TILTED, BOX, 1e-10)
    check_certificate(proof)
    assert -1.1 < proof.point[0] < -1


@pytest.mark.parametrize(
    ("xx", "xy", "yy", "is_convex"),
    [
        # A square of a sum is convex, if only just; so is what is flat.
        (1, 2, 1, True),
        (1, -2, 1, True),
        (4, 4, 1, True),
        (1, 3, 1, False),
        (1, -3, 1, False),
        (0, 0, 1, True),
        (1, 0, 0, True),
        (0, 0, 0, True),
        (0, 1, 1, False),
        (-1, 0, 1, False),
        (1, 0, -1, False),
        (-1, 0, -1, False),
    ],
)
def test_a_net_that_is_just_convex(xx, xy, yy, is_convex):
    # Four times the Bernstein coefficients over the unit square of xx x^2 + xy x y + yy y^2.
    line, square = (0, 1, 2), (0, 0, 4)
    net = [[xx * square[i] + xy * line[i] * line[j] + yy * square[j] for j in range(3)] for i in range(3)]
    assert box_search._is_convex(net) is is_convex


@pytest.mark.parametrize(
    ("at", "least"),
    # x^2 + 2 y^2 over a square from -1 to 1: value, and slopes down to the corner across.
    [((0.25, 0.75), 0.75 - 1.5 - 3.0), ((0.75, 0.25), 0.75 - 1.5 - 3.0), ((0.5, 0.5), 0.0), ((0.5, 1.0), 2.0 - 8.0)],
)
def test_the_least_of_a_tangent_plane(at, least):
    part = (fmpq(-1), fmpq(2))
    assert box_search._tangent_bound(polynomial(x2y0=1, x0y2=2), (part, part), at) == fmpq(*least.as_integer_ratio())
