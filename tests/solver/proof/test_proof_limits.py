"""How much a proof leaves open, and when sums of squares are tried: from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from semispline import ComputationError
from semispline.solver.proof import check_certificate
from semispline.solver.proof.box_search import least_point

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
