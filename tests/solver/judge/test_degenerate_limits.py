"""What the judge calls degenerate, umbilic, folded or tied: each figure from both sides."""

import numpy as np
import pytest

from semispline import Base, BSplineSurface, local_geometry, measure_contact, measure_regularity
from semispline.solver.judge import Regularity, correspond

K1, K2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
BOTH_SIDES = [(0.5, True), (0.9, True), (1.1, False), (2.0, False)]


def plane(across, along):
    """P = u across + v along."""
    across, along = np.array(across, dtype=float), np.array(along, dtype=float)
    return BSplineSurface(1, 1, K1, K1, [[u * across + v * along for v in (0, 1)] for u in (0, 1)])


@pytest.mark.parametrize(("times", "degenerate"), BOTH_SIDES)
def test_tangents_of_a_million_millionth_are_none(times, degenerate):
    small = times * 1e-12
    # One tangent, of the extent 1 over the range 1; and the angle between both.
    for surface in (plane((1, 0, 0), (0, small, 0)), plane((0, small, 0), (1, 0, 0)), plane((1, 0, 0), (1, small, 0))):
        assert local_geometry(surface, [0.5], [0.5]).regular.tolist() == [not degenerate]


@pytest.mark.parametrize(("times", "parallel"), BOTH_SIDES)
def test_an_edge_has_no_normal_where_derivatives_are_parallel(times, parallel):
    contact = measure_contact(
        Base(plane((1, 0, 0), (0, 1, 0)), "u0"), Base(plane((times * 1e-12, 1, 0), (0, 1, 0)), "u0")
    )
    assert np.isnan(contact.angle_degrees) == parallel


@pytest.mark.parametrize(("times", "umbilic"), BOTH_SIDES)
def test_curvatures_within_a_ten_thousand_millionth_are_one(times, umbilic):
    # z = (x^2 + (1 + d) y^2) / 2 over [-1, 1] x [-1, 1]: y has the greater curvature, and P_u goes along x.
    bent = 1 + times * 1e-10
    # x^2 over [-1, 1] has the Bezier coefficients 1, -1, 1.
    squares, places = (1, -1, 1), (-1, 0, 1)
    net = [
        [[x, y, (xx + bent * yy) / 2] for y, yy in zip(places, squares, strict=True)]
        for x, xx in zip(places, squares, strict=True)
    ]
    geometry = local_geometry(BSplineSurface(2, 2, K2, K2, net), [0.5], [0.5])
    first = np.abs(geometry.principal_directions[0, 0])
    np.testing.assert_allclose(first, [1, 0, 0] if umbilic else [0, 1, 0], atol=1e-5)


@pytest.mark.parametrize(("times", "vanishes"), BOTH_SIDES)
def test_an_area_element_beside_rounding_is_none(times, vanishes):
    # A trapezoid, 2 wide and, at the other end, next to nothing.
    width = times * 1e-14 * 2
    surface = BSplineSurface(1, 1, K1, K1, [[[0, 0, 0], [0, 2, 0]], [[1, 0, 0], [1, width, 0]]])
    assert (measure_regularity(surface) == Regularity(0.0, None)) is vanishes


@pytest.mark.parametrize(("times", "tied"), BOTH_SIDES)
def test_directions_within_a_billionth_tie(times, tied):
    # Edges at a right angle but for a little that speaks for the other direction.
    a = plane((1, 0, 0), (0, 1, 0))
    b = plane((0, 0, 1), (1, -times * 1e-9, 0))
    assert correspond(Base(a, "u0"), Base(b, "u0")).flipped is not tied
