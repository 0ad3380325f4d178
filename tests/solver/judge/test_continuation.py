"""How bases go on from a blend: any edge, any direction, any seam."""

import numpy as np
import pytest

from helpers.bases import facing_pair, tube
from helpers.papers_set import blend
from helpers.shapes import sheets
from helpers.sweeps import first_ones
from semispline import Base, BSplineSurface, EdgeError, transform
from semispline.solver.judge.continuation import _nearest, continuation
from semispline.solver.judge.sections import unit_normals

OPTIONS = {"degree_u": 5, "middle_curves": 0, "alpha": "natural"}


def check(surface, bases):
    v = np.linspace(*surface.domain[1], 23)
    for end, (base, sign) in enumerate(zip(bases, (-1, 1), strict=True)):
        found = continuation(surface, base, end)
        u = np.array([surface.domain[0][end]])
        size = np.ptp(surface.evaluate_grid(u, v)[0], axis=0).max()
        assert found.evaluate(np.zeros(1), v) == pytest.approx(surface.evaluate(u, v), abs=1e-7 * size)
        assert found.domain[0][0] == 0
        # Normals go on, w running against u at the start.
        own = unit_normals(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
        its = unit_normals(found.evaluate_grid(np.zeros(1), v, 1, 0), found.evaluate_grid(np.zeros(1), v, 0, 1))
        assert sign * its == pytest.approx(own, abs=1e-4)
        # Along v they run as fast, and w runs on from u.
        assert found.evaluate(np.zeros(1), v, 0, 1) == pytest.approx(surface.evaluate(u, v, 0, 1), abs=1e-4 * size)
        out = -surface.evaluate(u, v, 1, 0) if end == 0 else surface.evaluate(u, v, 1, 0)
        assert (np.sum(found.evaluate(np.zeros(1), v, 1, 0) * out, axis=1) > 0).all()


@pytest.mark.parametrize("seed", first_ones(3, range(12)))
def test_open_edges(seed):
    bases = facing_pair(np.random.default_rng(seed))
    check(blend(*bases, **OPTIONS).surface, bases)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("phase", [0.0, 2.1])
@pytest.mark.parametrize("edge", ["u0", "u1"])
def test_closed_edges(backwards, phase, edge):
    rng = np.random.default_rng(0)
    heights = (5.0, 4.0) if edge == "u1" else (4.0, 5.0)
    bases = (
        Base(tube(rng, 8, noise=0.02), "u1"),
        Base(tube(rng, 9, radius=1.5, heights=heights, phase=phase, backwards=backwards, v_range=(2, 5)), edge),
    )
    check(blend(*bases, **OPTIONS).surface, bases)


def test_orders_of_derivatives():
    bases = facing_pair(np.random.default_rng(4), edges=("v1", "v0"), backwards=(True, False))
    found = continuation(blend(*bases, **OPTIONS).surface, bases[0], 0)
    w, v, step = np.array([0.3 * found.domain[0][1]]), np.array([np.mean(found.domain[1])]), 1e-5
    for order, (dw, dv) in (((1, 0), (step, 0)), ((0, 1), (0, step))):
        ahead, behind = found.evaluate(w + dw, v + dv), found.evaluate(w - dw, v - dv)
        assert found.evaluate(w, v, *order) == pytest.approx((ahead - behind) / (2 * step), rel=1e-6, abs=1e-8)
        assert found.evaluate_grid(w, v, *order)[0] == pytest.approx(found.evaluate(w, v, *order), rel=1e-12)


def test_another_edge_is_refused():
    surface, other = sheets(1, 2)
    with pytest.raises(EdgeError, match=r"its edge u1 is .* away from the surface's end u0"):
        continuation(surface, Base(other, "u1"), 0)


K1 = [0, 0, 1, 1]


def strip(start, end, offset=0.0, knots=K1):
    """The unit wide strip between two places along x."""
    places = np.linspace(start, end, len(knots) - 2) + offset
    return BSplineSurface(1, 1, knots, K1, [[[x, 0, 0], [x, 1, 0]] for x in places])


@pytest.mark.parametrize(
    ("gap", "offset", "is_edge"),
    # A millionth of the extent; and 256 roundings of what is 1e9 away, 5.7e-5.
    [(0.5e-6, 0, True), (2e-6, 0, False), (3e-5, 1e9, True), (1e-4, 1e9, False)],
)
def test_how_far_apart_edges_may_be(gap, offset, is_edge):
    surface, base = strip(0, 1, offset), Base(strip(1 + gap, 2, offset), "u0")
    if is_edge:
        continuation(surface, base, 1)
    else:
        with pytest.raises(EdgeError, match="away from the surface's end u1"):
            continuation(surface, base, 1)


def test_knots_of_the_base_are_counted_from_its_edge():
    surface, knots = strip(0, 1), [2, 2, 2.25, 3, 3]
    for end, base, expected in (
        (1, Base(strip(1, 2, knots=knots), "u0"), [0, 0.25, 1]),
        (0, Base(strip(-1, 0, knots=knots), "u1"), [0, 0.75, 1]),
    ):
        across, along = continuation(surface, base, end).breakpoints
        assert across.tolist() == expected
        assert along.tolist() == [0, 1]


def test_the_nearest_place_on_a_closed_edge():
    """Of a flat ring, whose sides are close to each other, and of one that is a circle."""
    rng = np.random.default_rng(3)
    ring = tube(rng, 11, noise=0.02)
    for surface in (ring, transform(ring, np.diag([10.0, 0.3, 1.0]))):
        base = Base(surface, "u1")
        first, last = base.range_along
        for part in np.arange(16) / 16 + 0.01:
            at = first + part * (last - first)
            assert _nearest(base, base.derivative(np.array([at]), 0, 0)[0]) == pytest.approx(at, abs=1e-9)
