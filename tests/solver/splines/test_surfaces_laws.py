"""Evaluation against the referee and the definition, and what every exact operation must leave as it is."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from helpers.splines import (
    bspline_surfaces,
    exact_point,
    knot_vectors,
    parameters,
    scale,
    semistructured_surfaces,
    surfaces,
)
from helpers.sweeps import examples
from semispline import insert_row_knot
from semispline.solver.judge.de_boor import curve_points, surface_points
from semispline.solver.splines.curves import insert_curve_knots, reverse_curve, split_curve
from semispline.solver.splines.operations import (
    bounding_box,
    clamped_surface,
    elevate_degree,
    insert_knots,
    map_domain,
    reverse_u,
    reverse_v,
    split_u,
    split_v,
    swap_directions,
    transform,
)
from semispline.solver.splines.refinement import clamp_knots
from semispline.solver.splines.surfaces import BSplineSurface, SemiStructuredSurface

# Both sides are short convex combinations of the same control points: 1e-12 leaves a hundred roundings for each level.
TOLERANCE = 1e-12
SEEDS = st.integers(0, 2**32 - 1)
laws = examples(30)


def knots_of(surface):
    if isinstance(surface, SemiStructuredSurface):
        return surface.knots_u, np.concatenate([c.knots for c in surface.control_curves])
    return surface.knots_u, surface.knots_v


def sample(surface, seed, count=8):
    """Points of the domain, among them knots and corners."""
    rng = np.random.default_rng(seed)
    u, v = (parameters(rng, r, k, count) for r, k in zip(surface.domain, knots_of(surface), strict=True))
    n = max(len(u), len(v))
    return np.resize(u, n), rng.permutation(np.resize(v, n))


def inside(surface, seed, count=10):
    rng = np.random.default_rng(seed)
    return tuple(rng.uniform(*r, count) for r in surface.domain)


def agree(found, expected, surface, du=0, dv=0):
    assert np.abs(found - expected).max() <= TOLERANCE * scale(surface, du, dv)


@laws
@given(surfaces(), SEEDS)
def test_points_and_derivatives_are_those_of_the_referee(surface, seed):
    u, v = sample(surface, seed)
    for du in range(4):
        for dv in range(4 - du):
            agree(surface.evaluate(u, v, du, dv), surface_points(surface, u, v, du, dv), surface, du, dv)


@laws
@given(surfaces(), SEEDS)
def test_grids_are_the_points_one_by_one(surface, seed):
    u, v = sample(surface, seed, count=3)
    for du, dv in ((0, 0), (1, 0), (1, 2), (7, 0)):
        grid = surface.evaluate_grid(u, v, du, dv)
        uu, vv = (x.ravel() for x in np.meshgrid(u, v, indexing="ij"))
        agree(grid.reshape(-1, 3), surface_points(surface, uu, vv, du, dv), surface, du, dv)


@examples(15)
@given(
    st.one_of(bspline_surfaces(degrees=(1, 3), most=1), semistructured_surfaces(degrees=(1, 3), most=1)),
    st.floats(0, 1),
    st.floats(0, 1),
)
def test_points_and_derivatives_are_those_of_the_definition(surface, s, t):
    (u0, u1), (v0, v1) = surface.domain
    u, v = min(u0 + s * (u1 - u0), u1), min(v0 + t * (v1 - v0), v1)
    for du, dv in ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2)):
        exact = np.array([[float(x) for x in exact_point(surface, u, v, du, dv)]])
        agree(surface.evaluate([u], [v], du, dv), exact, surface, du, dv)


@laws
@given(surfaces(), SEEDS, st.data())
def test_knot_insertion_changes_no_point(surface, seed, data):
    rng = np.random.default_rng(seed)
    more = [
        np.repeat(rng.uniform(*r, 2), data.draw(st.integers(1, d)))
        for r, d in zip(surface.domain, (surface.degree_u, lowest_degree(surface)), strict=True)
    ]
    finer = insert_knots(surface, *more)
    u, v = inside(surface, seed)
    agree(finer.evaluate(u, v), surface_points(surface, u, v), surface)
    assert len(finer.knots_u) == len(surface.knots_u) + len(more[0])
    # Refining never leaves the hull: the box of the finer net lies in that of the coarser one, up to rounding.
    before, after = bounding_box(surface), bounding_box(finer)
    assert (after[0] >= before[0] - 1e-14).all()
    assert (after[1] <= before[1] + 1e-14).all()


def lowest_degree(surface):
    if isinstance(surface, SemiStructuredSurface):
        return min(c.degree for c in surface.control_curves)
    return surface.degree_v


@laws
@given(surfaces(), SEEDS, st.integers(0, 2), st.integers(0, 2))
def test_degree_elevation_changes_no_point_and_no_smoothness(surface, seed, by_u, by_v):
    higher = elevate_degree(surface, surface.degree_u + by_u, surface.degree_v + by_v)
    assert (higher.degree_u, higher.degree_v) == (surface.degree_u + by_u, surface.degree_v + by_v)
    u, v = inside(surface, seed)
    for order in ((0, 0), (1, 0), (0, 1)):
        agree(higher.evaluate(u, v, *order), surface_points(surface, u, v, *order), surface, *order)
    values, before = np.unique(surface.knots_u, return_counts=True)
    assert np.array_equal(np.unique(higher.knots_u), values)
    assert (np.unique(higher.knots_u, return_counts=True)[1] == before + by_u).all()


@laws
@given(surfaces(), SEEDS)
def test_reversal_runs_backwards(surface, seed):
    u, v = inside(surface, seed)
    (u0, u1), (v0, v1) = surface.domain
    agree(reverse_u(surface).evaluate(u, v), surface_points(surface, u0 + u1 - u, v), surface)
    agree(reverse_v(surface).evaluate(u, v), surface_points(surface, u, v0 + v1 - v), surface)
    assert reverse_v(reverse_u(surface)).domain == surface.domain


@laws
@given(bspline_surfaces(), SEEDS)
def test_swapping_exchanges_the_parameters(surface, seed):
    u, v = inside(surface, seed)
    agree(swap_directions(surface).evaluate(v, u), surface_points(surface, u, v), surface)


@laws
@given(surfaces(), SEEDS)
def test_a_mapped_domain_gives_the_same_points_and_scaled_derivatives(surface, seed):
    mapped = map_domain(surface, (0, 1), (2, 2.5))
    assert mapped.domain == ((0.0, 1.0), (2.0, 2.5))
    s, t = np.random.default_rng(seed).uniform(0, 1, (2, 10))
    (u0, u1), (v0, v1) = surface.domain
    u, v = u0 + s * (u1 - u0), v0 + t * (v1 - v0)
    agree(mapped.evaluate(s, 2 + t / 2), surface_points(surface, u, v), surface)
    expected = surface_points(surface, u, v, 1, 1) * (u1 - u0) * (v1 - v0) * 2
    # The parameters themselves are rounded (a domain far from zero), which a derivative sees through its own slope.
    slope = scale(surface, 2, 1) * (u1 - u0) + scale(surface, 1, 2) * (v1 - v0)
    allowed = (TOLERANCE * scale(surface, 1, 1) + 1e-13 * slope) * (u1 - u0) * (v1 - v0) * 2
    assert np.abs(mapped.evaluate(s, 2 + t / 2, 1, 1) - expected).max() <= allowed


@laws
@given(surfaces(), SEEDS)
def test_pieces_are_the_surface_over_their_part_of_the_domain(surface, seed):
    u, v = inside(surface, seed, 2)
    for direction, split, at in ((0, split_u, u[0]), (1, split_v, v[0])):
        low, high = split(surface, at)
        for piece in (low, high):
            x, y = inside(piece, seed)
            for order in ((0, 0), (1, 0), (0, 1)):
                agree(piece.evaluate(x, y, *order), surface_points(surface, x, y, *order), surface, *order)
        assert low.domain[direction][1] == high.domain[direction][0] == at
        assert low.domain[1 - direction] == high.domain[1 - direction] == surface.domain[1 - direction]


@laws
@given(surfaces(), SEEDS)
def test_affine_maps_commute_with_evaluation(surface, seed):
    rng = np.random.default_rng(seed)
    a, t = rng.uniform(-2, 2, (3, 3)), rng.uniform(-5, 5, 3)
    u, v = inside(surface, seed)
    expected = surface_points(surface, u, v) @ a.T + t
    assert np.abs(transform(surface, a, t).evaluate(u, v) - expected).max() <= 1e-12 * 15
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = a, t
    assert np.abs(transform(surface, whole).evaluate(u, v) - expected).max() <= 1e-12 * 15


@laws
@given(surfaces(), SEEDS)
def test_the_surface_lies_in_its_box(surface, seed):
    u, v = sample(surface, seed)
    low, high = bounding_box(surface)
    points = surface_points(surface, u, v)
    assert (points >= low - 1e-14).all()
    assert (points <= high + 1e-14).all()


@laws
@given(st.integers(1, 6), st.data(), SEEDS)
def test_unclamped_knots_are_clamped_exactly(degree, data, seed):
    rng = np.random.default_rng(seed)
    n = degree + 1 + data.draw(st.integers(0, 5))
    knots = np.cumsum(rng.uniform(0.005, 1, n + degree + 1))
    points = rng.uniform(-1, 1, (n, 3))
    clamped, net = clamp_knots(degree, knots, points)
    start, end = knots[degree], knots[n]
    assert (clamped[: degree + 1] == start).all()
    assert (clamped[-degree - 1 :] == end).all()
    x = rng.uniform(start, end, 20)
    # The referee takes unclamped vectors as well: its spans are those of the domain.
    expected = curve_points(degree, knots, points, x)
    assert np.abs(curve_points(degree, clamped, net, x) - expected).max() <= 1e-13


@laws
@given(st.integers(1, 4), st.integers(1, 4), st.booleans(), SEEDS)
def test_unclamped_surfaces_are_clamped_exactly(p, q, rational, seed):
    rng = np.random.default_rng(seed)
    n_u, n_v = p + 1 + rng.integers(0, 4), q + 1 + rng.integers(0, 4)
    knots_u, knots_v = np.cumsum(rng.uniform(0.01, 1, n_u + p + 1)), np.cumsum(rng.uniform(0.01, 1, n_v + q + 1))
    points = rng.uniform(-1, 1, (n_u, n_v, 3))
    weights = rng.uniform(0.5, 2, (n_u, n_v)) if rational else None
    surface = clamped_surface(p, q, knots_u, knots_v, points, weights)
    assert surface.domain == ((knots_u[p], knots_u[n_u]), (knots_v[q], knots_v[n_v]))
    assert (surface.weights is None) != rational
    u, v = inside(surface, seed)
    w = np.ones((n_u, n_v)) if weights is None else weights
    net = np.dstack([points * w[..., None], w])
    rows = np.stack([curve_points(q, knots_v, row, v) for row in net], axis=1)
    exact = curve_points(p, knots_u, rows, u)
    assert np.abs(surface.evaluate(u, v) - exact[:, :3] / exact[:, 3:]).max() <= 1e-12


@laws
@given(st.integers(1, 5).flatmap(lambda p: st.tuples(st.just(p), knot_vectors(p))), SEEDS)
def test_a_closed_periodic_curve_stays_closed(given, seed):
    degree, _ = given
    rng = np.random.default_rng(seed)
    steps = rng.uniform(0.1, 1, degree + 3)
    period = np.concatenate([[0.0], np.cumsum(steps)])
    length = period[-1]
    knots = np.concatenate([period[-degree - 1 : -1] - length, period, period[1 : degree + 1] + length])
    points = rng.uniform(-1, 1, (len(steps), 3))
    wrapped = np.concatenate([points, points[:degree]])
    clamped, net = clamp_knots(degree, knots, wrapped)
    assert np.abs(net[0] - net[-1]).max() <= 1e-14 * degree
    ends = np.array([0.0, length])
    for order in range(1, degree):
        left, right = curve_points(degree, clamped, net, ends, order)
        assert np.abs(left - right).max() <= 1e-10 * max(1.0, np.abs(left).max())


def test_operations_on_one_curve_leave_the_others_alone():
    # A check of the plumbing: the same functions on curves.
    surface = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    semi = surface.to_semistructured()
    first, second = semi.control_curves
    changed = insert_row_knot(semi, 1, 0.25)
    assert changed.control_curves[0] is first
    assert changed.control_curves[1].knots.tolist() == insert_curve_knots(second, [0.25]).knots.tolist()
    assert reverse_curve(reverse_curve(first)).control_points.tolist() == first.control_points.tolist()
    assert split_curve(first, 0.5)[0].control_points[-1].tolist() == [0, 0.5, 0]
