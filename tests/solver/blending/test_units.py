"""The same model in other units, or far from the origin, gives the same blend."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.bases import facing_pair, moved, ring
from helpers.papers_set import blend
from helpers.sweeps import examples, first_ones
from semispline import Base, BSplineSurface

# Moving rounds the input itself: eps times 10^4 sizes is 2e-12 of the size, and the blend, whose rows are differences
# of such points, repeats that a few times over. What is asked for leaves a factor of a hundred.
LIMITS = {"reduced": 1e-9, "casadi": 1e-6}
CONTINUITIES = ("C1", "C2", "G0", "G1", "G2")


def size_of(bases):
    points = np.concatenate([base.surface.control_points.reshape(-1, 3) for base in bases])
    return float(np.ptp(points, axis=0).max())


def stacked(result):
    return np.concatenate([curve.control_points for curve in result.surface.control_curves])


def assert_same(bases, method, scale, offset, **options):
    """Blend the bases and their copies scale * x + offset; compare what comes out, in units of the size."""
    size = size_of(bases)
    copies = [Base(moved(base.surface, offset=offset, scale=scale), base.edge) for base in bases]
    plain, other = (blend(*pair, method=method, **options) for pair in (bases, copies))
    assert other.flipped == plain.flipped
    assert other.active_bounds == plain.active_bounds
    limit = LIMITS[method]
    back = (stacked(other) - offset) / scale
    assert np.abs(back - stacked(plain)).max() <= limit * size
    for name in ("alpha2", "beta2"):
        found, expected = getattr(other, name), getattr(plain, name)
        assert (found is None) == (expected is None)
        assert found is None or found == pytest.approx(expected, rel=limit)
    # Energies are squares of lengths; below 1e-12 of size^2 they are rounding of the input.
    assert other.energy / scale**2 == pytest.approx(plain.energy, rel=limit, abs=1e-12 * size**2)


@pytest.mark.long
@examples(30)
@given(
    st.integers(0, 10**6),
    st.floats(-6, 6),
    st.floats(0, 4),
    st.tuples(st.sampled_from(CONTINUITIES), st.sampled_from(CONTINUITIES)),
    st.integers(0, 3),
    st.booleans(),
)
@pytest.mark.parametrize("method", ["reduced", "casadi"])
def test_random_bases(method, seed, scale, distance, continuity, middle_curves, planar):
    rng = np.random.default_rng(seed)
    bases = facing_pair(rng, planar=planar)
    scale = 10.0**scale
    direction = rng.standard_normal(3)
    offset = 10**distance * size_of(bases) * scale * direction / np.abs(direction).max()
    assert_same(bases, method, scale, offset, continuity=continuity, middle_curves=middle_curves)


@pytest.mark.parametrize("method", ["reduced", "casadi"])
@pytest.mark.parametrize("unit", [25.4, 1e-3, 1e3 / 25.4])
def test_a_change_of_units_alone_costs_no_digits(method, unit):
    bases = facing_pair(np.random.default_rng(1))
    copies = [Base(moved(base.surface, scale=unit), base.edge) for base in bases]
    plain, other = (blend(*pair, method=method) for pair in (bases, copies))
    # Only roundings of single operations, some hundred in a row.
    assert np.abs(stacked(other) / unit - stacked(plain)).max() <= 1e-13 * size_of(bases)


@pytest.mark.long
@pytest.mark.parametrize("method", ["reduced", "casadi"])
@pytest.mark.parametrize("middle_curves", [0, 1])
def test_closed_bases(method, middle_curves):
    bases = Base(ring(7, 1.0, (0.0, -0.5, -1.2)), "u0"), Base(ring(5, 0.7, (1.0, 1.4, 2.0)), "u0")
    for scale, offset in ((25.4, (0, 0, 0)), (1.0, (2e4, -1e4, 3e3)), (1e-3, (20.0, 0, -20.0))):
        assert_same(bases, method, scale, np.array(offset), middle_curves=middle_curves)


@pytest.mark.parametrize("method", first_ones(1, ["reduced", "casadi"]))
def test_bases_that_continue_each_other(method):
    # Least energy zero: there is no energy of its own to measure rounding by.
    k = [0, 0, 0, 1, 1, 1]
    net = np.array([[[x, y, 0.3 * x + 0.1 * y] for y in (0, 0.5, 1)] for x in (0, 0.5, 1)])
    first = BSplineSurface(2, 2, k, k, net)
    bases = Base(first, "u1"), Base(moved(first, offset=(3, 0, 0.9)), "u0")
    for scale, offset in ((1.0, (4e4, -1e4, 3e3)), (1e-3, (40.0, 0, -40.0)), (1e5, (0, 0, 0))):
        assert_same(bases, method, scale, np.array(offset))


@pytest.mark.parametrize("v_scale", ["unit", "length"])
@pytest.mark.parametrize("method", ["reduced", "casadi"])
def test_with_a_scale_of_v(method, v_scale):
    bases = facing_pair(np.random.default_rng(3))
    assert_same(bases, method, 25.4, np.array([2e5, -1e5, 3e4]), v_scale=v_scale)
