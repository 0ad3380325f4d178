"""What the linear problem is stated for, by known geometry."""

import numpy as np
import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending.pipeline import state_problem

LINE = [0.0, 0.0, 1.0, 1.0]


def strip(x):
    """Flat, one wide and 2 long."""
    return BSplineSurface(1, 1, LINE, LINE, [[[at, 2.0 * y, 0.0] for y in (0, 1)] for at in (x, x + 1)])


# The gap is 5: along v the blend is 2/5 of that long, stretched for G1 by 3.5.
@pytest.mark.parametrize(
    ("v_scale", "length"),
    [("paper", 1.0), ("unit", 1.0), ("length", 0.4), ("stretched", 1.4), ("straight", 100.0)],
)
def test_how_long_the_energy_takes_the_domain_for(v_scale, length):
    problem = state_problem(Base(strip(0), "u1"), Base(strip(6), "u0"), continuity="G1", v_scale=v_scale).problem
    for row in problem.form.rows:
        assert row.knots[-1] - row.knots[0] == pytest.approx(length, rel=1e-12)


def box(heights):
    """The walls of a square of side 2, closed along v with a corner at its seam; contact at u0."""
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0)]
    knots = [0, 0, 0.25, 0.5, 0.75, 1, 1]
    return BSplineSurface(1, 1, LINE, knots, [[[x, y, z] for x, y in square] for z in heights])


@pytest.mark.parametrize(
    ("gap", "length"), [(2.0, 3.5 * 8 / 2), (4.0, 3.5 * 8 / 4), (5.0, 2 * np.pi), (50.0, 2 * np.pi)]
)
def test_closed_contacts_are_an_angle_long_at_the_least(gap, length):
    """8 long, stretched by 3.5, over the gap; from 28 / 2 pi = 4.46 on v is the angle about a pipe."""
    a, b = Base(box((0, -1)), "u0"), Base(box((gap, gap + 1)), "u0")
    problem = state_problem(a, b, continuity="G1", v_scale="stretched").problem
    # A corner at the seam is closed, too.
    assert problem.seam_order == 0
    for row in problem.form.rows:
        assert row.knots[-1] - row.knots[0] == pytest.approx(length, rel=1e-12)


def test_a_free_row_has_half_of_its_points_at_most_for_its_seam():
    """A drop of 5 control points, C1 at its seam: two at either end, and no row of it could have three."""
    drop = np.array([[0, 0], [0, 1], [3, 0], [0, -1], [0, 0]])
    knots = [0.0] * 5 + [1.0] * 5

    def wall(heights):
        return BSplineSurface(1, 4, LINE, knots, [[[x, y, z] for x, y in drop] for z in heights])

    problem = state_problem(Base(wall((0, -1)), "u0"), Base(wall((2, 3)), "u0"), continuity="G1").problem
    assert problem.seam_order == 1
    # Rows of either side that G1 leaves free.
    assert problem.a.count == 3
    assert problem.free_rows.start == 2
    assert problem.seam_order_of(2) == 1
