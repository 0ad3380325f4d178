"""Open CASCADE judges a hundred random blends."""

import numpy as np
import pytest

from helpers.bases import facing_pair
from helpers.occ import analyse, edge_point
from helpers.papers_set import blend
from helpers.sweeps import first_ones


@pytest.mark.parametrize("seed", first_ones(20, range(100)))
def test_a_hundred_random_blends(seed):
    a, b = facing_pair(np.random.default_rng(1000 + seed), planar=seed % 10 == 0)
    result = blend(a, b, middle_curves=seed % 3)
    surface = result.surface.to_bspline()
    for s in (0.031, 0.52, 0.97):
        for base, edge, t in ((a, "u0", s), (b, "u1", 1 - s if result.flipped else s)):
            judged = analyse(
                base.surface, edge_point(base.surface, base.edge, t), surface, edge_point(surface, edge, s)
            )
            assert judged.IsG2()
            assert np.degrees(judged.G1Angle()) < 1e-9
            # Absolute, 1/length, on bases of size 1.
            assert judged.G2CurvatureGap() < 1e-9
