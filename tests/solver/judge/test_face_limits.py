"""What rounding may do along an edge, as `exact_face_limits` counts it, where the edge is slow or stands still."""

import numpy as np
import pytest

from semispline import Base, BSplineSurface, plane
from semispline.solver.judge import local_origin, model_size
from semispline.solver.judge.face_limits import _rounding_along
from semispline.solver.judge.rounding import derivative_noises

LINE = [0.0, 0.0, 1.0, 1.0]
FLOOR = plane([-8, -8, 0], [16, 0, 0], [0, 16, 0])


def sheet(y, width=1.0, knots=(0, 0, 0, 0, 1, 1, 1, 1)):
    """Flat, `width` across in u, along v at the places y."""
    net = [[[x, at, 0.0] for at in y] for x in (0.0, width)]
    return Base(BSplineSurface(1, 3, LINE, list(knots), net), "u0")


@pytest.mark.parametrize("start", [0.0, 6.0])
def test_the_least_speed_along_counts_also_between_knots(start):
    """Of 0, 0.9, 0.1, 1 the speed is 2.7 at the ends and 0.15 in the middle, the least that there is."""
    knots = start + np.array([0, 0, 0, 0, 1, 1, 1, 1.0])
    base = sheet((0, 0.9, 0.1, 1), knots=knots)
    noises = derivative_noises(base, local_origin(base.surface, FLOOR))
    scale = 1e-3 / model_size(FLOOR)
    expected = max(noises[0, 2] / 0.15**2, noises[1, 1] / 0.15) / scale
    assert _rounding_along(base, FLOOR) == pytest.approx(expected, rel=1e-9)
    # Ends are places, too: of 0, 0.05, 0.95, 1 the speed is 0.15 there.
    ends = _rounding_along(sheet((0, 0.05, 0.95, 1), knots=knots), FLOOR)
    assert ends == pytest.approx(expected, rel=1e-9)


def test_an_edge_that_stands_still_has_no_curvature_to_bound():
    """A control point twice over at an end, or a sheet without width."""
    assert _rounding_along(sheet((0, 0, 0.5, 1)), FLOOR) == 0
    assert _rounding_along(sheet((0, 0.3, 0.6, 1), width=0.0), FLOOR) == 0
    # Control: as slow as a millionth it has one, and a large one.
    assert _rounding_along(sheet((0, 1e-6, 0.5, 1)), FLOOR) > 1e3 * _rounding_along(sheet((0, 0.3, 0.6, 1)), FLOOR) > 0
