"""The families of pairs: the same at every run, within what they promise, measured here by code of its own."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from helpers.sweeps import examples, first_ones
from semispline import Base, BSplineSurface, map_domain, read_surface, reverse_v, revolve_polynomial
from semispline.papers.reproduction.families.closed_rims import KINDS, closed_rims
from semispline.papers.reproduction.families.open_pairs import open_pair
from semispline.papers.reproduction.families.problems import measure_pair
from semispline.papers.reproduction.families.real_pairs import REAL_PAIRS, real_pair
from semispline.papers.reproduction.families.suite import SIZES, shape_problem, suite

MADE = ("facing", "u-turn", "closed rims")


def values(surface, u, v, du=0, dv=0):
    """Points or derivatives on a grid, shape (len(u), len(v), 3), by SciPy's splines."""
    rows = BSpline(surface.knots_v, surface.control_points, surface.degree_v, axis=1)(v, dv)
    return BSpline(surface.knots_u, rows, surface.degree_u, axis=0)(u, du)


def edge(base, t):
    """Points, ways into the base and ways along at fractions t of the edge; all of their own length."""
    surface = base.surface
    ranges = (surface.knots_u[[0, -1]], surface.knots_v[[0, -1]])
    across = "uv".index(base.edge[0])
    at = ranges[across][int(base.edge[1])]
    along = ranges[1 - across][0] + t * np.ptp(ranges[1 - across])

    def of(k, j):
        if across == 0:
            return values(surface, np.array([at]), along, k, j)[0]
        return values(surface, along, np.array([at]), j, k)[:, 0]

    sign = 1 if base.edge[1] == "0" else -1
    return of(0, 0), sign * of(1, 0), of(0, 1) * np.ptp(ranges[1 - across])


def degrees(x, y):
    cosine = np.sum(x * y, axis=-1) / np.linalg.norm(x, axis=-1) / np.linalg.norm(y, axis=-1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def lies(a, b):
    """Gap over contact length and mean exit angles of an open pair; edge b run so that the ends come closest."""
    t = (np.arange(400) + 0.5) / 400
    (p, in_a, along_a), (q, in_b, along_b) = edge(a, t), edge(b, t)
    if np.linalg.norm(p - q[::-1], axis=1).sum() < np.linalg.norm(p - q, axis=1).sum():
        q, in_b = q[::-1], in_b[::-1]
    length = (np.linalg.norm(along_a, axis=1).mean() + np.linalg.norm(along_b, axis=1).mean()) / 2
    exits = degrees(-in_a, q - p).mean(), degrees(-in_b, p - q).mean()
    return np.linalg.norm(p - q, axis=1).mean() / length, exits


@pytest.mark.parametrize("family", MADE)
def test_the_same_seed_makes_the_same_pair_and_another_one_another(family):
    one, again, other = shape_problem(family, 5), shape_problem(family, 5), shape_problem(family, 6)
    for x, y in zip((one.a, one.b), (again.a, again.b), strict=True):
        assert x.edge == y.edge
        for array in ("control_points", "knots_u", "knots_v"):
            assert getattr(x.surface, array).tobytes() == getattr(y.surface, array).tobytes()
    assert one.name == again.name != other.name
    assert one.measures == again.measures != other.measures


@pytest.mark.parametrize(("family", "exits"), [("facing", (0, 80)), ("u-turn", (90, 150))])
def test_open_pairs_lie_as_they_promise(family, exits):
    for seed in range(20):
        problem = open_pair(family, seed)
        gap, angles = lies(problem.a, problem.b)
        assert problem.measures.gap == pytest.approx(gap, rel=1e-3)
        assert problem.measures.exit_degrees == pytest.approx(angles, abs=0.02)
        # Half a percent for the places at which each side measures.
        assert 0.199 <= gap <= 2.01
        assert all(exits[0] - 0.1 <= angle <= exits[1] + 0.1 for angle in angles)
        least = []
        for base in (problem.a, problem.b):
            n_across, n_along = base.surface.control_points.shape[:2]
            if base.edge[0] == "v":
                n_across, n_along = n_along, n_across
            assert 4 <= n_along <= 9
            assert 4 <= n_across <= 6
            assert (base.surface.degree_u, base.surface.degree_v, base.surface.weights) == (3, 3, None)
            _, inwards, along = edge(base, np.linspace(0, 1, 200))
            to_edge = degrees(inwards, along)
            least.append(np.minimum(to_edge, 180 - to_edge).min())
        assert problem.measures.least_exit_to_edge_degrees == pytest.approx(min(least), abs=0.5)
        assert min(least) > 24.9


@given(st.sampled_from(["facing", "u-turn"]), st.integers(0, 10**9))
@examples(20)
def test_any_seed_makes_a_pair(family, seed):
    gap, angles = lies(*(getattr(open_pair(family, seed), side) for side in "ab"))
    low, high = {"facing": (0, 80), "u-turn": (90, 150)}[family]
    assert 0.199 <= gap <= 2.01
    assert all(low - 0.1 <= angle <= high + 0.1 for angle in angles)


@pytest.mark.parametrize("family", ["facing", "u-turn"])
def test_exits_lead_to_the_sides_that_the_kind_names(family):
    t = np.linspace(0, 1, 50)
    kinds = set()
    for seed in range(12):
        problem = open_pair(family, seed)
        (p, in_a, _), (q, in_b, _) = edge(problem.a, t), edge(problem.b, t)
        chord = q.mean(axis=0) - p.mean(axis=0)
        chord /= np.linalg.norm(chord)
        sides = [(-x / np.linalg.norm(x, axis=1)[:, None]).mean(axis=0) for x in (in_a, in_b)]
        first, second = (side - (side @ chord) * chord for side in sides)
        # Exits near the chord lead to no side.
        if min(np.linalg.norm(first), np.linalg.norm(second)) > 0.3:
            assert problem.kind.endswith("same side" if first @ second > 0 else "opposite sides")
            kinds.add(problem.kind)
    assert len(kinds) == 2


@pytest.mark.parametrize("family", first_ones(1, MADE))
def test_a_family_is_spread_over_edges_speeds_and_domains(family):
    problems = [shape_problem(family, seed) for seed in range(40)]
    assert {(p.a.edge, p.b.edge) for p in problems} >= set()
    assert {base.edge for p in problems for base in (p.a, p.b)} == {"u0", "u1", "v0", "v1"}
    for values in ([p.measures.speeds for p in problems], [p.measures.domains for p in problems]):
        assert np.ptp(np.log10(values)) > 1.5
    domains = np.log10([p.measures.domains for p in problems])
    assert np.abs(domains).max() <= 1
    assert len({p.measures.gap for p in problems}) == 40


@pytest.mark.long
def test_facing_pairs_fill_their_ranges():
    problems = [open_pair("facing", seed) for seed in range(60)]
    gaps = [p.measures.gap for p in problems]
    exits = [x for p in problems for x in p.measures.exit_degrees]
    for measured, low, high in ((gaps, 0.2, 2.0), (exits, 0.0, 80.0)):
        share = (np.array(measured) - low) / (high - low)
        assert (np.histogram(share, 4, (0, 1))[0] >= len(share) / 10).all()


def rim(base):
    """Centre, mean radius and unit normal of a rim, the normal towards its base."""
    points, inwards, _ = edge(base, np.arange(600) / 600)
    centre = points.mean(axis=0)
    normal = np.linalg.svd(points - centre)[2][2]
    return centre, np.linalg.norm(points - centre, axis=1).mean(), normal * np.sign(inwards.mean(axis=0) @ normal or 1)


def rims(kind, number=4):
    return [closed_rims(KINDS.index(kind) + len(KINDS) * k) for k in range(number)]


@pytest.mark.parametrize("kind", KINDS)
def test_rims_are_closed_and_smooth_and_round(kind):
    for problem in rims(kind):
        assert problem.kind == kind
        for base in (problem.a, problem.b):
            surface = base.surface
            closed = surface.control_points if base.edge[0] == "u" else surface.control_points.transpose(1, 0, 2)
            knots = surface.knots_v if base.edge[0] == "u" else surface.knots_u
            spline = BSpline(knots, closed, 3, axis=1)
            assert 6 <= len(np.unique(knots)) - 1 <= 13
            size = np.ptp(closed, axis=(0, 1)).max()
            for order in range(3):
                ends = spline(knots[[0, -1]], order) * np.ptp(knots) ** order
                # Factors of at most 13^2 on the second derivative.
                np.testing.assert_allclose(ends[:, 0], ends[:, 1], atol=1e-10 * size)
            points, _, _ = edge(base, np.arange(600) / 600)
            radii = np.linalg.norm(points - points.mean(axis=0), axis=1)
            assert radii.max() / radii.min() < 1.1 / 0.9 * 1.02


@pytest.mark.long
def test_known_geometry_of_rims():
    for problem in rims("coaxial") + rims("cap") + rims("bells"):
        (c0, r0, n0), (c1, r1, n1) = rim(problem.a), rim(problem.b)
        assert (r0, r1) == pytest.approx((1, 1), rel=0.02)
        assert n0 @ n1 == pytest.approx(-1, abs=1e-9)
        axial = (c1 - c0) @ n1
        assert 0.49 < axial < 3.01
        assert np.linalg.norm(c1 - c0 - axial * n1) < 0.05
    for problem in rims("tilted", 16):
        angle = 180 - degrees(rim(problem.a)[2], rim(problem.b)[2])
        assert 4.9 < angle < 50.1
    for problem in rims("elbow"):
        (c0, _, n0), (c1, _, n1) = rim(problem.a), rim(problem.b)
        angle = 180 - degrees(n0, n1)
        assert 59 < angle < 111
        # The chord of an arc of that angle about a bend of 1.5 to 3 radii.
        assert 1.4 < np.linalg.norm(c1 - c0) / 2 / np.sin(np.radians(angle) / 2) < 3.1
    for problem in rims("other radius") + rims("rings"):
        assert 0.28 < rim(problem.b)[1] / rim(problem.a)[1] < 0.82
    for problem in rims("bells"):
        for base in (problem.a, problem.b):
            points, inwards, _ = edge(base, np.arange(200) / 200)
            outwards = points - points.mean(axis=0)
            assert (np.sum(-inwards * outwards, axis=1) > 0).all()


def strip(start, way, *, length=2.0):
    """A flat strip that runs from a straight edge u0 at `start` along y, into `way`."""
    net = [[np.array(start) + s * np.array(way) + [0, y, 0] for y in (0, length)] for s in (0, 1)]
    return BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], net)


@pytest.mark.parametrize("backwards", [False, True])
def test_what_is_measured_of_known_pairs(backwards):
    angle = np.radians(35)
    a = strip((0, 0, 0), (-3, 0, 0))
    b = strip((0.8, 0, 0), (np.cos(angle), 0, np.sin(angle)))
    b = map_domain(reverse_v(b) if backwards else b, (0, 4), (0, 5))
    pair = measure_pair(Base(a, "u0"), Base(b, "u0"))
    assert pair.gap == pytest.approx(0.4)
    assert pair.exit_degrees == pytest.approx((0, 35))
    assert pair.least_exit_to_edge_degrees == pytest.approx(90)
    assert pair.speeds == pytest.approx((1.5, 0.125))
    assert pair.domains == pytest.approx((1, 5))
    assert pair.bends == pytest.approx((0, 0), abs=1e-9)
    assert pair.edge_turn_degrees == pytest.approx((0, 0), abs=1e-9)


def test_a_cylinder_met_along_a_straight_line_bends_by_its_radius():
    straight = strip((0, 0, 0), (-3, 0, 0))
    quarter = revolve_polynomial(_line((3, 0, 0), (3, 2, 0)), (3.5, 0, 0), (0, 1, 0), angle=90, tolerance=1e-9).surface
    bases = [Base(quarter, e) for e in ("u0", "u1", "v0", "v1")]
    # The line x = 3, z = 0 is one of its edges; its radius is 1/2.
    met = next(base for base in bases if np.abs(edge(base, np.linspace(0, 1, 5))[0][:, 0] - 3).max() < 1e-9)
    pair = measure_pair(Base(straight, "u0"), met)
    assert pair.bends == pytest.approx((0, 3 / 0.5), rel=1e-4)
    assert pair.edge_turn_degrees == pytest.approx((0, 0), abs=1e-5)
    assert pair.exit_degrees == pytest.approx((0, 90), abs=1e-5)


def test_a_pipe_and_a_flat_ring_around_it():
    pipe, ring = (
        revolve_polynomial(profile, (0, 0, 0), (0, 0, 1), tolerance=1e-6).surface
        for profile in (_line((1, 0, -2), (1, 0, 0)), _line((2, 0, 0), (3, 0, 0)))
    )
    edges = [
        [
            Base(surface, e)
            for e in ("u0", "u1", "v0", "v1")
            if abs(np.ptp(edge(Base(surface, e), np.linspace(0, 1, 9))[0][:, 0]) - 2 * r) < 0.1
        ]
        for surface, r in ((pipe, 1), (ring, 2))
    ]
    upper = max(edges[0], key=lambda base: edge(base, np.array([0.3]))[0][0, 2])
    pair = measure_pair(upper, edges[1][0])
    # Circumferences 2 pi and 4 pi, one apart.
    assert pair.gap == pytest.approx(1 / (3 * np.pi), rel=1e-4)
    assert pair.exit_degrees == pytest.approx((90, 0), abs=0.05)
    # The normal goes round with the pipe, and stays upright on the ring; 256 places leave out a little.
    assert pair.edge_turn_degrees == pytest.approx((360, 0), abs=0.5)


def _line(start, end):
    from semispline import BSplineCurve

    return BSplineCurve(1, [0, 0, 1, 1], [start, end])


def test_the_suite_holds_what_was_asked_for():
    keys = list(suite())
    assert len(set(keys)) == len(keys) == sum(SIZES.values())
    assert SIZES["facing"] >= 400
    assert SIZES["u-turn"] >= 100
    assert SIZES["closed rims"] >= 100
    assert sum(pair.between is not None for pair in REAL_PAIRS) >= 10


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(REAL_PAIRS)))
def test_real_pairs_are_neighbours_of_the_face_between_them(number, shared):
    pair = REAL_PAIRS[number]
    problem = real_pair(number, shared)
    assert problem is not None
    assert problem.name == pair.name
    assert problem.a.surface.weights is problem.b.surface.weights is None
    if pair.between is None:
        return
    between = read_surface(f"{shared / pair.file}#{pair.between}")
    ends = [f"{across}{end}" for across, end in product("uv", "01")]
    t = np.linspace(0, 1, 21)
    size = np.ptp(between.control_points.reshape(-1, 3), axis=0).max()
    touching = {
        name: [
            side
            for side in ends
            if min(np.abs(_ends(Base(between, side), t) - way).max() for way in (_ends(base, t), _ends(base, t)[::-1]))
            < 1e-3 * size
        ]
        for name, base in (("a", problem.a), ("b", problem.b))
    }
    assert any(x[0] == y[0] and x[1] != y[1] for x, y in product(touching["a"], touching["b"])), touching


def _ends(base, t):
    """The ends of an edge: what lies between may be run through at another speed."""
    start, end = base.range_along
    return base.derivative(np.array([start, end]), 0, 0)
