"""Corners that both contacts have: knots of full multiplicity, no others."""

import numpy as np

from semispline.solver.blending.layout import common_corners, with_corners
from semispline.solver.splines import Basis, clamped


def basis(degree, inner):
    return Basis(degree, clamped(inner, degree, 0, 1))


def test_common_corners_are_knots_of_full_multiplicity_on_both():
    a = basis(3, [0.2, 0.2, 0.2, 0.4, 0.4, 0.6, 0.6, 0.6, 0.8, 0.8, 0.8])
    b = basis(2, [0.1, 0.1, 0.2, 0.2, 0.4, 0.4, 0.6, 0.8, 0.8])
    # At 0.4 a is smooth, at 0.6 b; at 0.1 there is no knot of a.
    for one, other in ((a, b), (b, a)):
        assert common_corners(one, other).tolist() == [0.2, 0.8]
    assert common_corners(a, basis(2, [0.5])).tolist() == []


def test_corners_within_a_billionth_of_a_thousandth_of_the_domain_are_one():
    for apart, count in ((7e-13, 1), (1.5e-12, 0)):
        for scale in (1.0, 16.0):
            one, other = (Basis(2, scale * basis(2, [place, place]).knots) for place in (0.25, 0.25 + apart))
            assert len(common_corners(one, other)) == count
            corner = scale * np.array([0.25 + apart])
            # Where a single knot is as near to a corner it becomes that; else both stay.
            kept = with_corners(Basis(2, scale * basis(2, [0.25]).knots), corner)
            assert kept.size == 3 + 2 + (1 - count)
