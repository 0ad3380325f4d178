"""The judge of rational surfaces: against exact fractions, analytic surfaces, Open CASCADE; rounding of quotients."""

from fractions import Fraction
from math import comb, factorial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.bases import IDENTITY, moved
from helpers.circles import arcs, cone, cylinder, full_circle, smooth_circle, sphere, swept, torus
from helpers.occ import analyse, edge_point, to_geom
from semispline import Base, BSplineCurve, BSplineSurface, SemiStructuredSurface, measure_contact
from semispline.solver.judge import (
    correspond,
    local_origin,
    measure_creases,
    measure_curvature_range,
    measure_fairness,
    measure_meets,
    measure_regularity,
    measure_shape,
    surface_points,
    worst_inside,
)
from semispline.solver.judge.bezier_pieces import bernstein_by_degree, in_pieces
from semispline.solver.judge.de_boor import edge_curves
from semispline.solver.judge.limits import shortfalls
from semispline.solver.judge.precise import precise_derivatives
from semispline.solver.judge.regularity import _numerator, area_bound
from semispline.solver.judge.rounding import derivative_noises
from semispline.solver.splines.operations import reverse_v, swap_directions

BEZIER = {p: np.repeat([0.0, 1.0], p + 1) for p in (1, 2, 3)}
ORDERS = [(a, b) for a in range(5) for b in range(5 - a)]


def mixed_rows(rng):
    """Bezier rows of several degrees with whole homogeneous coordinates; the second has no weights."""
    rows = []
    for i, degree in enumerate((3, 1, 2, 4)):
        points = rng.integers(-4, 5, (degree + 1, 3)).astype(float) + np.array([4.0 * i, 0, 0])
        weights = None if i == 1 else rng.choice([1.0, 2.0, 4.0], degree + 1)
        rows.append(BSplineCurve(degree, np.repeat([0.0, 1.0], degree + 1), points, weights))
    return SemiStructuredSurface(3, np.repeat([0.0, 1.0], 4), rows)


def exact_derivatives(surface, u, v):
    """All derivatives of order up to 4 at a point, by exact division of Taylor series in both parameters."""

    def powers(degree, t):
        """Taylor coefficients at t of the Bernstein polynomials of a degree, up to order 4."""
        found = []
        for i in range(degree + 1):
            c = [Fraction(0)] * (degree + 1)
            for k in range(i, degree + 1):
                c[k] = Fraction((-1) ** (k - i) * comb(degree, i) * comb(degree - i, k - i))
            found.append([sum(c[k] * comb(k, m) * t ** (k - m) for k in range(m, degree + 1)) for m in range(5)])
        return found

    of_u = powers(surface.degree_u, u)
    net = [[[Fraction(0)] * 5 for _ in range(5)] for _ in range(4)]
    for i, row in enumerate(surface.control_curves):
        of_v = powers(row.degree, v)
        weights = np.ones(len(row.control_points)) if row.weights is None else row.weights
        for j, (point, weight) in enumerate(zip(row.control_points, weights, strict=True)):
            w = Fraction(weight)
            for d, x in enumerate([*(Fraction(c) * w for c in point), w]):
                for a in range(5):
                    for b in range(5):
                        net[d][a][b] += of_u[i][a] * of_v[j][b] * x
    weight, found = net[3], {}
    for d in range(3):
        series = {}
        for a in range(5):
            for b in range(5):
                known = sum(
                    weight[i][j] * series[a - i, b - j] for i in range(a + 1) for j in range(b + 1) if (i, j) != (0, 0)
                )
                series[a, b] = (net[d][a][b] - known) / weight[0][0]
        for a, b in ORDERS:
            found.setdefault((a, b), []).append(float(series[a, b] * factorial(a) * factorial(b)))
    return {order: np.array(value) for order, value in found.items()}


@pytest.mark.parametrize("edge", ["u0", "u1", "v0", "v1"])
@pytest.mark.parametrize("seed", [0, 1])
def test_precise_derivatives_are_the_exact_ones_rounded(edge, seed):
    """Against division of series in fractions; doubles are rounded twice at most, from 60 digits."""
    surface, along = mixed_rows(np.random.default_rng(seed)), Fraction(3, 16)
    end = Fraction(int(edge[1]))
    found = precise_derivatives(Base(surface, edge), np.zeros(3), np.array([float(along)]), 4)
    exact = exact_derivatives(surface, *((end, along) if edge[0] == "u" else (along, end)))
    for across in range(5):
        for order in range(5 - across):
            key = (across, order) if edge[0] == "u" else (order, across)
            expected = np.array([float(x) for x in exact[key]])
            np.testing.assert_allclose(found[across, order][0], expected, rtol=2 * np.finfo(float).eps, atol=0)


def test_precise_derivatives_count_knots_and_an_origin():
    """A wavy surface with inner knots: as the floating referee has it, to its own rounding."""
    rng = np.random.default_rng(3)
    knots = np.array([0, 0, 0, 0, 0.3, 0.3, 0.7, 1, 1, 1, 1])
    net, weights = rng.normal(size=(7, 7, 3)), rng.uniform(0.5, 2, (7, 7))
    surface, origin = BSplineSurface(3, 3, knots, knots, net, weights), np.array([1.0, -2.0, 0.5])
    s = np.array([0.0, 0.1, 0.3, 0.65, 1.0])
    for edge in ("u0", "u1", "v0", "v1"):
        precise = precise_derivatives(Base(surface, edge), origin, s, 3)
        floating = edge_curves(surface, edge, 3, origin).points(s, 3)
        noises = derivative_noises(Base(surface, edge), origin, 3)
        for key, values in precise.items():
            assert np.abs(values - floating[key]).max() <= noises[key]


@pytest.mark.parametrize("seed", range(4))
def test_the_referee_against_exact_fractions(seed):
    surface = mixed_rows(np.random.default_rng(seed))
    t = Fraction(3, 8)
    for edge in ("u0", "u1", "v0", "v1"):
        at_end = Fraction(int(edge[1]))
        exact = exact_derivatives(surface, *((at_end, t) if edge[0] == "u" else (t, at_end)))
        found = edge_curves(surface, edge, 4).points(np.array([float(t)]), 4)
        for (across, along), value in found.items():
            order = (across, along) if edge[0] == "u" else (along, across)
            np.testing.assert_allclose(
                value[0], exact[order], rtol=1e-10, atol=1e-10 * np.abs(exact[order]).max() + 1e-11
            )
    exact = exact_derivatives(surface, Fraction(1, 4), t)
    for order, value in exact.items():
        np.testing.assert_allclose(surface_points(surface, [0.25], [0.375], *order)[0], value, rtol=1e-11, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_pieces_against_exact_fractions(seed):
    surface = mixed_rows(np.random.default_rng(seed))
    pieces = in_pieces(surface)
    for u, v in ((Fraction(1, 4), Fraction(3, 8)), (Fraction(0), Fraction(1))):
        for (a, b), value in exact_derivatives(surface, u, v).items():
            for found in (
                pieces.evaluate([float(u)], [float(v)], a, b)[0],
                pieces.evaluate_grid([float(u)], [float(v)], a, b)[0, 0],
            ):
                np.testing.assert_allclose(found, value, rtol=1e-10, atol=1e-10 * np.abs(value).max() + 1e-11)


def test_pieces_lose_nothing_far_from_the_origin():
    surface = torus(full_circle(3))
    far = in_pieces(moved_rational(surface, offset=(2.0**30, 0, 0)).to_semistructured())
    near = in_pieces(surface)
    u, v = np.linspace(0, 1, 5), np.linspace(0, 1, 7)
    points = near.evaluate_grid(u, v) + np.array([2.0**30, 0, 0])
    np.testing.assert_allclose(far.evaluate_grid(u, v), points, atol=1e-6)
    for order in ((1, 0), (0, 2), (1, 1), (0, 3)):
        # What storing the points rounds, 2e-7, times what the order magnifies.
        np.testing.assert_allclose(far.evaluate_grid(u, v, *order), near.evaluate_grid(u, v, *order), atol=1e-3)
    far = in_pieces(moved_rational(swept(arcs([0, 1]), [(1, 0, 1), (2, 1, 1)]), offset=(2.0**20, 0, 0)))
    assert np.isfinite(far.evaluate_grid(u, v, 1, 1)).all()


def moved_rational(surface, matrix=IDENTITY, offset=(0, 0, 0)):
    net = surface.control_points @ np.asarray(matrix).T + np.asarray(offset)
    return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, net, surface.weights)


FORMS = [full_circle(4), full_circle(3, 1.0), smooth_circle(), arcs([0.0, 1.5, 2.0, 4.0, 2 * np.pi])]


@pytest.mark.parametrize("form", range(len(FORMS)))
@pytest.mark.parametrize("kind", [lambda s: s, lambda s: s.to_semistructured()])
def test_shapes_of_analytic_surfaces(form, kind):
    circle = FORMS[form]
    ball = kind(sphere(circle, 2.0))
    shape = measure_shape(ball)
    assert shape.curvatures.least.value == pytest.approx(0.5, rel=1e-11)
    assert shape.curvatures.largest.value == pytest.approx(0.5, rel=1e-11)
    assert shape.fairness.value <= 1e-18
    assert shape.waist.distance == pytest.approx(shape.waist.of_rims, rel=1e-6)
    # The section v = const is a circle of radius 2 over 1.5: a window, 1/50 of it, turns by 1.5 / 50.
    assert shape.turn.degrees >= np.degrees(1.5 / 50) * (1 - 1e-9)
    pipe = kind(cylinder(circle, 3.0))
    curvatures = measure_curvature_range(pipe)
    assert (curvatures.least.value, curvatures.largest.value) == pytest.approx((0.0, 1 / 3), abs=1e-12)
    assert measure_fairness(pipe).value <= 1e-18
    ring = kind(torus(circle, 3.0, 1.0, (0.3, 1.3)))
    curvatures = measure_curvature_range(ring)
    assert curvatures.largest.value == pytest.approx(1.0, rel=1e-11)
    # Round the axis: cos t / (3 + cos t), least at t = 1.3.
    assert curvatures.least.value == pytest.approx(np.cos(1.3) / (3 + np.cos(1.3)), rel=1e-9)


@pytest.mark.parametrize("form", range(len(FORMS)))
@pytest.mark.parametrize("make", [cylinder, cone, torus, sphere])
def test_the_least_area_of_a_quotient_is_bounded_from_below(form, make):
    surface = make(FORMS[form]).to_semistructured()
    u, v = (np.linspace(0, 1, n) for n in (41, 801))
    area = np.linalg.norm(np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1)), axis=2)
    bound = area_bound(surface)
    assert 0.2 * area.min() < bound <= area.min() * (1 + 1e-12)
    measured = measure_regularity(surface)
    assert 0 < measured.proved_area_ratio <= measured.least_area_ratio * (1 + 1e-12)


def test_the_bound_of_equal_weights_is_that_of_none():
    net = np.stack([*np.meshgrid(np.arange(3.0), np.arange(4.0), indexing="ij"), np.zeros((3, 4))], axis=2)
    net[..., 2] = 0.2 * np.random.default_rng(0).uniform(-1, 1, (3, 4))
    plain, weighed = (BSplineSurface(2, 3, BEZIER[2], BEZIER[3], net, w) for w in (None, np.full((3, 4), 3.0)))
    # Pieces are smaller, so the bound may be better.
    assert area_bound(plain) * (1 - 1e-12) <= area_bound(weighed) <= 1.5 * area_bound(plain)


def test_the_numerator_of_the_area_is_exact():
    rng = np.random.default_rng(4)
    net = np.concatenate([rng.uniform(-1, 1, (3, 4, 3)), rng.uniform(0.5, 2, (3, 4, 1))], axis=2)
    surface = BSplineSurface(2, 3, BEZIER[2], BEZIER[3], net[..., :3] / net[..., 3:], net[..., 3])
    # One piece: axes 3 and 4.
    pieces = net[..., None, None]
    found = _numerator(pieces, 2 * np.diff(pieces, axis=0), 3 * np.diff(pieces, axis=1))[..., 0, 0]
    for u, v in ((0.0, 0.0), (0.3, 0.8), (1.0, 0.4)):
        (of_u,), (of_v,) = (
            bernstein_by_degree(n - 1, np.array([x]))[-1] for n, x in zip(found.shape, (u, v), strict=False)
        )
        normal = np.cross(surface_points(surface, [u], [v], 1, 0), surface_points(surface, [u], [v], 0, 1)).ravel()
        weight = sum(
            x * net[i, j, 3]
            for (i, j), x in np.ndenumerate(
                np.outer(*(bernstein_by_degree(d, np.array([x]))[-1][0] for d, x in ((2, u), (3, v))))
            )
        )
        np.testing.assert_allclose(of_u @ found.transpose(2, 0, 1) @ of_v, normal * weight**3, rtol=1e-11, atol=1e-12)


def test_weights_times_a_constant_change_no_bound():
    surface = torus(full_circle(4))
    times = BSplineSurface(2, 2, surface.knots_u, surface.knots_v, surface.control_points, 7 * surface.weights)
    assert area_bound(times) == pytest.approx(area_bound(surface), rel=1e-12)


def test_a_pinched_quotient_is_not_proved():
    # The tip of a cone has no area; so has a place where rows turn back.
    assert measure_regularity(cone(full_circle(4), (0.0, 1.0))).proved_area_ratio is None
    folded = swept(full_circle(4), [(1, 0, 1), (1, 2, 1), (1, 0, 1)])
    assert measure_regularity(folded).proved_area_ratio is None


@pytest.mark.parametrize("edge", ["u0", "v0"])
def test_contacts_of_analytic_surfaces(edge):
    turn = (lambda s: s) if edge == "u0" else swap_directions
    # A sphere of radius 2 on a cylinder of radius 2: tangent, and its curvature across is 1/2; the pipe has none.
    pipe, ball = turn(cylinder(full_circle(3), 2.0, (-1, 0))), turn(sphere(full_circle(3), 2.0, (0.0, 1.0)))
    for a, b in ((pipe, ball), (pipe.to_semistructured(), ball.to_semistructured())):
        contact = measure_contact(Base(a, edge.replace("0", "1")), Base(b, edge), order=4)
        assert contact.corresponds == "affine"
        assert not shortfalls(contact, "G1")
        assert contact.curvature_jump == pytest.approx(0.5, rel=1e-12)
        # Circles have no rate of curvature.
        assert contact.rate_jump <= 1e-11


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), steep=st.floats(0.0, 2.0), edge=st.sampled_from(["u0", "u1", "v0", "v1"]))
def test_rounding_of_quotients_stays_below_its_bound(seed, steep, edge):
    rng = np.random.default_rng(seed)
    p, q = rng.integers(1, 4, 2)
    n_u, n_v = p + rng.integers(1, 4), q + rng.integers(1, 4)
    knots = [
        np.concatenate([[0.0] * (d + 1), np.linspace(0, 1, n - d + 1)[1:-1], [1.0] * (d + 1)])
        for d, n in ((p, n_u), (q, n_v))
    ]
    net, weights = rng.uniform(-1, 1, (n_u, n_v, 3)), np.exp(steep * rng.uniform(-1, 1, (n_u, n_v)))
    surface = BSplineSurface(p, q, *knots, net, weights)
    semi = surface.to_semistructured()
    s = np.linspace(0, 1, 41)
    eps = 2.0**-30
    for one in (surface, semi):
        base = Base(one, edge)
        bound = derivative_noises(base, local_origin(one), 4) / np.finfo(float).eps * eps
        exact = edge_curves(one, edge, 4).points(s, 4)
        # Points moved by less than a rounding so large, of the extent; weights by a part of themselves.
        for _ in range(3):
            change = eps * rng.choice([-1.0, 1.0], net.shape)
            weighed = eps * rng.choice([-1.0, 1.0], weights.shape) if np.ptp(weights) > 0 else 0.0
            other = BSplineSurface(p, q, *knots, net + change, weights * (1 + weighed))
            off = edge_curves(other, edge, 4).points(s, 4)
            for order, value in off.items():
                error = np.linalg.norm(value - exact[order], axis=1).max()
                assert error <= bound[order] + 1e-13 * np.abs(value).max()


def test_the_bound_on_rounding_is_not_idle():
    # Pinned from the other side: a circle of nine points against the same points without weights.
    pipe = cylinder(full_circle(4))
    bound = derivative_noises(Base(pipe, "u0"), np.zeros(3), 4)
    plain = derivative_noises(
        Base(BSplineSurface(1, 2, pipe.knots_u, pipe.knots_v, pipe.control_points), "u0"), np.zeros(3), 4
    )
    for order in (1, 2):
        assert 1 < bound[0, order] / plain[0, order] < 8
    # Above the degree a quotient still has derivatives.
    assert bound[0, 3] > 0
    assert plain[0, 3] == 0


def test_equal_weights_round_as_no_weights():
    net = np.random.default_rng(0).uniform(-1, 1, (4, 5, 3))
    knots = np.repeat([0.0, 1.0], 4), np.array([0, 0, 0, 0, 0.5, 1, 1, 1, 1])
    plain, weighed = (BSplineSurface(3, 3, *knots, net, w) for w in (None, np.full((4, 5), 2.5)))
    for edge in ("u0", "v1"):
        np.testing.assert_array_equal(*(derivative_noises(Base(s, edge), np.zeros(3), 4) for s in (plain, weighed)))


@pytest.mark.parametrize("flipped", [False, True])
def test_the_seam_of_a_rational_edge_is_found_exactly(flipped):
    # One circle of four unequal arcs, begun at its first and at its third knot: parameters correspond affinely.
    at = np.array([0.0, 1.5, 2.0, 4.0])
    spans = np.array([0.0, 0.3, 0.45, 0.6])
    first = cylinder(arcs([*at, 2 * np.pi], [*spans, 1]))
    turned = [*at[2:], *(at[:3] + 2 * np.pi)]
    again = cylinder(arcs(turned, [*(spans[2:] - 0.45), *(spans[:3] + 0.55)]), heights=(1, 2))
    other = reverse_v(again) if flipped else again
    found = correspond(Base(first, "u1"), Base(other, "u0"))
    assert found.flipped == flipped
    assert found.shift == pytest.approx(0.45 if flipped else 0.55, abs=1e-12)
    contact = measure_contact(Base(first, "u1"), Base(other, "u0"))
    assert contact.corresponds == "affine"
    assert not shortfalls(contact, "G2")


def between(circle, other, tilt):
    """A surface of degree 2 in u from a circle to another one, tilted and moved, by way of the mean of both rows."""
    turn = np.array([[np.cos(tilt), 0, np.sin(tilt)], [0, 1, 0], [-np.sin(tilt), 0, np.cos(tilt)]])
    q, knots, points = circle
    first = BSplineCurve(
        q, knots, np.stack([*(points[:, :2] / points[:, 2:]).T, 0 * points[:, 2]], axis=1), points[:, 2]
    )
    q, knots, points = other
    flat = np.stack([*(points[:, :2] / points[:, 2:]).T, 0 * points[:, 2]], axis=1)
    middle = BSplineCurve(q, knots, 0.7 * flat @ turn.T + [0.3, 0, 1], points[:, 2])
    last = BSplineCurve(q, knots, flat @ turn.T + [0, 0, 2], points[:, 2])
    return SemiStructuredSurface(2, np.repeat([0.0, 1.0], 3), (first, middle, last))


def test_a_circle_of_seven_points_joined_to_a_tilted_smooth_one_creases():
    surface = between(full_circle(3), smooth_circle(), 0.5)
    creases = measure_creases(surface)
    assert [round(crease.at, 12) for crease in creases] == [round(1 / 3, 12), round(2 / 3, 12)]
    # By one-sided evaluation close to the knot, by the referee; never at the rounded knot itself.
    u = np.linspace(0, 1, 401)[1:-1]
    for crease in creases:
        normals = [
            np.cross(*(surface_points(surface, u, np.full_like(u, crease.at + step), *o) for o in ((1, 0), (0, 1))))
            for step in (-1e-9, 1e-9)
        ]
        a, b = (n / np.linalg.norm(n, axis=1, keepdims=True) for n in normals)
        seen = np.degrees(np.linalg.norm(np.cross(a, b), axis=1)).max()
        assert seen > 0.5
        assert crease.angle_degrees == pytest.approx(seen, rel=0.1)
    assert str(worst_inside(creases)).startswith("crease ")


@pytest.mark.parametrize("circle", [full_circle(3), full_circle(4), arcs([0.0, 1.5, 2.0, 4.0, 2 * np.pi])])
def test_rows_that_share_the_jump_do_not_crease(circle):
    creases = measure_creases(between(circle, circle, 0.5))
    assert len(creases) >= 2
    assert max(crease.angle_degrees for crease in creases) <= 1e-10
    assert max(crease.curvature_jump_relative for crease in creases) <= 1e-11
    assert worst_inside(creases) is None
    assert measure_creases(between(smooth_circle(), smooth_circle(), 0.5)) == ()


def test_a_jump_of_curvature_is_known():
    # Two arcs in one tangent, of radius 1 and 2, along v; straight along u.
    half = np.sqrt(0.5)
    points = np.array([[-1, 0, 0], [-1, 1, 0], [0, 1, 0], [2, 1, 0], [2, -1, 0.0]])
    weights = np.array([1, half, 1, half, 1])
    rows = [BSplineCurve(2, [0, 0, 0, 0.4, 0.4, 1, 1, 1], points + np.array([0, 0, z]), weights) for z in (0, 1)]
    [crease] = measure_creases(SemiStructuredSurface(1, [0, 0, 1, 1], rows))
    assert crease.angle_degrees <= 1e-12
    assert crease.curvature_jump == pytest.approx(0.5, rel=1e-12)
    assert crease.curvature_jump_relative == pytest.approx(0.5, rel=1e-12)
    assert str(crease) == "G1 inside, curvature jump 50 % at v = 0.4"
    # The same along u.
    net = np.stack([row.control_points for row in rows], axis=1)
    surface = BSplineSurface(2, 1, [0, 0, 0, 0.4, 0.4, 1, 1, 1], [0, 0, 1, 1], net, np.stack([weights] * 2, axis=1))
    [turned] = measure_creases(surface.to_semistructured())
    assert (turned.parameter, turned.at) == ("u", 0.4)
    assert turned.curvature_jump == pytest.approx(0.5, rel=1e-12)


@pytest.mark.long
def test_rational_patches_meet_nothing_or_are_found_to():
    quarter = cylinder(arcs([0.0, 1.2]))
    assert measure_meets(quarter).answer("itself") is False
    assert measure_meets(quarter.to_semistructured()).answer("itself") is False
    # A torus whose tube reaches over its axis meets itself there.
    spindle = torus(full_circle(3), 0.5, 1.0, (1.8, 4.4))
    [place, *_] = measure_meets(spindle.to_semistructured()).found
    assert np.hypot(*place.point[:2]) <= 1e-6 or place.angle_degrees > 0


@pytest.mark.parametrize("seed", range(4))
def test_open_cascade_sees_the_same_in_rational_contacts(seed):
    rng = np.random.default_rng(seed)
    tilt = 0.2
    a = torus(arcs([0.1, 1.4]), 3.0, 1.0, (-0.6, 0.5))
    turn = np.array([[np.cos(tilt), -np.sin(tilt), 0], [np.sin(tilt), np.cos(tilt), 0], [0, 0, 1]])
    b = moved_rational(a, turn if seed % 2 else np.eye(3), rng.uniform(-0.05, 0.05, 3))
    contact = measure_contact(Base(a, "u0"), Base(b.to_semistructured(), "u0"), flip="no")
    s = contact.angle_at.parameter
    judged = analyse(a, edge_point(a, "u0", s), b, edge_point(b, "u0", s))
    angle = np.radians(contact.angle_degrees)
    # One lies on the other: Open CASCADE compares planes.
    assert min(angle, np.pi - angle) == pytest.approx(judged.G1Angle(), abs=1e-9)


def test_open_cascade_calls_a_rational_g2_contact_g2_and_another_not():
    whole = torus(full_circle(4), 3.0, 1.0, (-0.5, 0.5))
    next_one = torus(full_circle(4), 3.0, 1.0, (0.5, 1.5))
    pipe = cylinder(full_circle(4), 3.0 + np.cos(0.5), (np.sin(0.5), 2.0))
    assert not shortfalls(measure_contact(Base(whole, "u1"), Base(next_one.to_semistructured(), "u0")), "G2")
    assert shortfalls(measure_contact(Base(whole, "u1"), Base(pipe, "u0")), "G1")
    assert analyse(whole, edge_point(whole, "u1", 0.3), next_one, edge_point(next_one, "u0", 0.3)).IsG2()
    assert not analyse(whole, edge_point(whole, "u1", 0.3), pipe, edge_point(pipe, "u0", 0.3)).IsG1()


def test_curvatures_as_open_cascade_has_them():
    from OCP.GeomLProp import GeomLProp_SLProps

    surface = between(full_circle(4), full_circle(4), 0.5)
    pieces, geometry = in_pieces(surface), to_geom(surface.to_bspline())
    from semispline.solver.judge import geometry_grid

    for u, v in ((0.2, 0.1), (0.7, 0.6), (0.45, 0.9)):
        props = GeomLProp_SLProps(geometry, u, v, 2, 1e-12)
        assert props.IsCurvatureDefined()
        for one in (surface, pieces):
            found = geometry_grid(one, np.array([u]), np.array([v]))
            assert abs(found.mean[0, 0]) == pytest.approx(abs(props.MeanCurvature()), rel=1e-9)
            assert found.gaussian[0, 0] == pytest.approx(props.GaussianCurvature(), rel=1e-9)


def test_polynomial_surfaces_know_nothing_of_weights():
    # Helpers of polynomial bases still make no columns of weights.
    surface = moved(BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]))
    assert edge_curves(surface.to_semistructured(), "u0").dimension == 3
    assert in_pieces(surface).columns == 3
