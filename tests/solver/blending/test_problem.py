"""What the linear problem is stated for, by known geometry."""

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
