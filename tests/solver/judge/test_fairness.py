"""A * GH with jumps: a torus by its closed form, jumps of profiles, laws, and what does not settle."""

from itertools import pairwise
from math import comb

import numpy as np
import pytest
from scipy.integrate import quad

from helpers.shapes import arc, extruded, joined, line, revolved, sheets, torus
from semispline import (
    BSplineSurface,
    blend,
    insert_knots,
    local_geometry_grid,
    map_domain,
    measure_fairness,
    reverse_u,
    transform,
)
from semispline.papers.reproduction.families.suite import shape_problem
from semispline.solver.judge import fairness
from semispline.solver.judge.fairness import SETTLED, _Rule, _wide_spans


def test_torus():
    R, r, around = 3.0, 1.0, np.radians(140)

    def density(t):
        # H = (R + 2 r cos t) / (2 r (R + r cos t)), derived by hand: dH/dt = -R sin t / (2 (R + r cos t)^2).
        radius = R + r * np.cos(t)
        return (-R * np.sin(t) / (2 * radius**2) / r) ** 2 * r * radius

    for tube in ((10, 100), (0, 360)):
        start, end = np.radians(tube)
        area = around * (r * R * (end - start) + r**2 * (np.sin(end) - np.sin(start)))
        expected = area * around * quad(density, start, end)[0]
        found = measure_fairness(torus(R, r, tube=tube, around=(0, 140)))
        assert found.settled
        assert found.value == pytest.approx(expected, rel=1e-3)
        assert found.jumps < 1e-8


def test_spheres_and_cylinders_are_fair():
    for surface in (revolved(arc((0, 0), 2.0, -60, 60), 0, 90), extruded(arc((0, 0), 1.0, 0, 200), 3.0)):
        found = measure_fairness(surface)
        assert found.value < 1e-8
        assert found.settled


@pytest.mark.parametrize("along", ["u", "v"])
def test_jumps_of_a_bend_between_flaps(along):
    # A line of length 2, a quarter circle, a line of length 1; width 3. H jumps by 1 / (2 r), twice.
    r, width = 0.5, 3.0
    profile = [*line((-2, 0), (0, 0)), *arc((0, r), r, -90, 0), *line((r, r), (r, r + 1))]
    found = measure_fairness(extruded(profile, width, along=along))
    length = 3 + r * np.pi / 2
    window = (length if along == "u" else width) / 50
    assert found.jumps == pytest.approx(length * width * 2 * width / (2 * r) ** 2 / window, rel=1e-6)
    assert found.smooth < 1e-8
    assert found.value == found.smooth + found.jumps


def test_a_jump_at_the_seam_counts():
    """A racetrack: two lines and two half circles; all four joints jump, also the one where it closes."""
    straight = line((0, -1), (2, -1))
    track = [*straight, *arc((2, 0), 1.0, -90, 90), *line((2, 1), (0, 1)), *arc((0, 0), 1.0, 90, 270)]
    found = measure_fairness(extruded(track, 1.0, along="v"))
    assert found.jumps == pytest.approx((4 + 2 * np.pi) * 4 / 4 * 50, rel=1e-4)


def test_a_jump_counts_as_if_spread_over_the_window():
    """A quadratic profile against itself with its jumps of curvature spread over a width, by the law that fixes h."""
    # y'' jumps by 1 at x = 1, spread as a ramp of width d; small slopes, so H = y'' / 2 nearly.
    scale, width = 1e-3, 1.0

    def surface(d):
        knots = np.array([0, 0, 0, 0, 1 - d / 2, 1 + d / 2, 2, 2, 2, 2])
        x = np.array([knots[i + 1 : i + 4].mean() for i in range(6)])
        # Second derivatives 0, 0, 1, 1 at 0, 1 - d/2, 1 + d/2, 2 of a cubic spline: slopes, then points, summed up.
        curvature = np.array([0.0, 0.0, 1.0, 1.0])
        slope = np.concatenate([[0.0], np.cumsum(curvature * (knots[4:8] - knots[2:6]) / 2)])
        y = scale * np.concatenate([[0.0], np.cumsum(slope * (knots[4:9] - knots[1:6]) / 3)])
        points = np.stack([x, y, np.zeros(6)], axis=1)
        return BSplineSurface(3, 1, knots, [0, 0, 1, 1], np.stack([points, points + np.array([0, 0, width])], axis=1))

    spread = measure_fairness(surface(2 / 50))
    assert spread.jumps < 1e-6 * spread.smooth
    # Exactly a window wide: area 2, ramp (1/2)^2 / h, h = 2 / 50.
    assert spread.value == pytest.approx(2 * scale**2 / 4 / (2 / 50), rel=1e-3)
    sharp = [[[x, y, z] for z in (0, 1)] for x, y in ((0, 0), (0.5, 0), (1, 0), (1.5, 0), (2, scale / 2))]
    jump = measure_fairness(BSplineSurface(2, 1, [0, 0, 0, 1, 1, 2, 2, 2], [0, 0, 1, 1], sharp))
    assert jump.smooth < 1e-3 * jump.jumps
    assert jump.value == pytest.approx(spread.value, rel=1e-3)


def by_differences(surface, number=48, step=1e-6):
    """A * GH from H alone, differenced at Gauss points: shares no third derivative."""
    node, weight = np.polynomial.legendre.leggauss(number)
    area = gradient = 0.0
    for start, end in pairwise(surface.breakpoints[1]):
        half = (end - start) / 2
        u, v = (node + 1) / 2, start + half * (node + 1)
        geometry = local_geometry_grid(surface, u, v)

        def mean(du, dv, u=u, v=v):
            return local_geometry_grid(surface, u + du, v + dv).mean

        h_u, h_v = ((mean(*d) - mean(*(-np.array(d)))) / (2 * step) for d in ((step, 0.0), (0.0, step)))
        E, F, G = (geometry.first_form[..., i, j] for i, j in ((0, 0), (0, 1), (1, 1)))
        element = np.sqrt(E * G - F**2)
        w = np.outer(weight / 2, weight * half)
        area += np.sum(w * element)
        gradient += np.sum(w * (G * h_u**2 - 2 * F * h_u * h_v + E * h_v**2) / element)
    return area * gradient


def test_blends_against_differences_of_the_mean_curvature():
    # Sheared, so that the lines u and v are far from square.
    shear = np.array([[1.0, 0.9, 0.3], [0, 1, 0], [0, 0, 1]])
    for straight in sheets(7, 4, sideways=0.05):
        surface = transform(straight, shear)
        found = measure_fairness(surface)
        assert found.settled
        assert found.smooth == pytest.approx(by_differences(surface), rel=SETTLED)


@pytest.mark.parametrize(("family", "seed"), [("facing", 140), ("facing", 253), ("u-turn", 98)])
def test_what_settles_is_the_integral(family, seed):
    # Two and three points on a span of v are off alike on the first two; narrow spans of the third are no cluster.
    problem = shape_problem(family, seed)
    surface = blend(problem.a, problem.b).surface
    found = measure_fairness(surface)
    assert found.settled
    assert found.value == pytest.approx(by_differences(surface, 24), rel=0.005)


def test_a_graph_over_a_parallelogram():
    """z = f(x, y) with x = u + c v, y = v: formulas in x and y, where lines u and v are far from square."""
    c = 1.7

    def f(x, y):
        """Return f, f_x, f_y, f_xx, f_xy, f_yy."""
        third = 0.4 * x**3 - 0.3 * x * y**2 + 0.2 * y**3
        return (
            third + 0.3 * x**2 * y**2 + 0.5 * x * y,
            1.2 * x**2 - 0.3 * y**2 + 0.6 * x * y**2 + 0.5 * y,
            -0.6 * x * y + 0.6 * y**2 + 0.6 * x**2 * y + 0.5 * x,
            2.4 * x + 0.6 * y**2,
            -0.6 * y + 1.2 * x * y + 0.5,
            -0.6 * x + 1.2 * y + 0.6 * x**2,
        )

    def mean(x, y):
        _, p, q, r, s, t = f(x, y)
        return ((1 + q**2) * r - 2 * p * q * s + (1 + p**2) * t) / (2 * (1 + p**2 + q**2) ** 1.5)

    node, weight = np.polynomial.legendre.leggauss(40)
    u, v = np.meshgrid((node + 1) / 2, (node + 1) / 2, indexing="ij")
    x, y, w = u + c * v, v, np.outer(weight, weight) / 4
    # Derivatives of H by complex steps.
    h_x, h_y = mean(x + 1e-30j, y).imag / 1e-30, mean(x, y + 1e-30j).imag / 1e-30
    _, p, q, *_ = f(x, y)
    element = np.sqrt(1 + p**2 + q**2)
    gradient = ((1 + q**2) * h_x**2 - 2 * p * q * h_x * h_y + (1 + p**2) * h_y**2) / element**2
    expected = np.sum(w * element) * np.sum(w * gradient * element)
    # The same as one piece of degree 4: values at nodes to Bernstein coefficients.
    t = np.linspace(0, 1, 5)
    bernstein = np.array([comb(4, k) * t**k * (1 - t) ** (4 - k) for k in range(5)]).T
    u, v = np.meshgrid(t, t, indexing="ij")
    values = np.stack([u + c * v, v, f(u + c * v, v)[0]], axis=-1)
    inverse = np.linalg.inv(bernstein)
    knots = [0.0] * 5 + [1.0] * 5
    surface = BSplineSurface(4, 4, knots, knots, np.einsum("ai,bj,ijd->abd", inverse, inverse, values))
    found = measure_fairness(surface)
    assert found.settled
    assert found.value == pytest.approx(expected, rel=1e-5)


def test_laws():
    surface = sheets(7, 1)[0]
    value = measure_fairness(surface).value
    rotation = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    others = [
        transform(surface, 1e3 * rotation, [5e3, -2, 7]),
        transform(surface, 1e-3 * np.eye(3)),
        map_domain(surface, (2.0, 9.0), (-1.0, -0.5)),
        reverse_u(surface),
    ]
    for same in others:
        assert measure_fairness(same).value == pytest.approx(value, rel=1e-6)
    # Other spans are other samples: within what it promises.
    finer = insert_knots(surface, [0.2, 0.5], [float(np.mean(surface.domain[1]))])
    assert measure_fairness(finer).value == pytest.approx(value, rel=2 * SETTLED)


def test_what_has_no_end_does_not_settle():
    # A cone's tip: |grad H|^2 dA grows without end towards it.
    cone = revolved(line((0.0, 0.0), (1.0, 1.0)), 0, 90)
    found = measure_fairness(cone)
    assert not found.settled
    assert found.value > 100


def ridged(*inner, length=1.0, along="v"):
    """A cubic sheet of width 1 across with knots as given along `along`, bent by slopes that are small."""
    knots = np.array([0.0] * 4 + list(inner) + [1.0] * 4)
    at = np.array([knots[i + 1 : i + 4].mean() for i in range(len(knots) - 4)])
    x, height = length * at, 0.01 * np.sin(9 * at)
    net = np.stack([np.stack([np.full_like(x, side), x, height], axis=1) for side in (0.0, 1.0)])
    if along == "u":
        return BSplineSurface(3, 1, knots, [0, 0, 1, 1], net.swapaxes(0, 1))
    return BSplineSurface(1, 3, [0, 0, 1, 1], knots, net)


def pulled(profile, *inner):
    """A profile of lines and arcs pulled along a cubic that is all but straight, of length 1, with knots as given."""
    knots_u, profile = joined(profile)
    net = ridged(*inner)
    rail, weights = net.control_points[0], np.repeat(profile[:, 2:], len(net.control_points[0]), axis=1)
    across = np.column_stack([profile[:, :2] / profile[:, 2:], np.zeros(len(profile))])
    # Along z, and to one side.
    points = across[:, None] + rail[:, [2, 0, 1]]
    return BSplineSurface(2, 3, knots_u, net.knots_v, points, weights)


@pytest.mark.parametrize("apart", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14])
def test_knots_all_but_double_count_as_double(apart):
    double = measure_fairness(ridged(0.3, 0.6, 0.6))
    near = measure_fairness(ridged(0.3, 0.6, 0.6 + apart))
    assert double.jumps > 0.1 * double.value
    assert near.settled
    assert near.jumps == pytest.approx(double.jumps, rel=0.02)
    assert near.value == pytest.approx(double.value, rel=0.02)


def test_three_knots_all_but_one_are_one_line():
    triple = measure_fairness(ridged(0.6, 0.6, 0.6))
    near = measure_fairness(ridged(0.6, 0.6 + 1e-8, 0.6 + 2e-8))
    assert (near.value, near.jumps) == pytest.approx((triple.value, triple.jumps), rel=1e-4)


def test_the_limit_of_a_cluster_is_a_quarter_of_the_window():
    # h is 1/50 of the width across, and the length is 1.
    assert measure_fairness(ridged(0.6, 0.6 + 0.99 / 200)).jumps > 1e-3
    assert measure_fairness(ridged(0.6, 0.6 + 1.01 / 200)).jumps < 1e-6
    # What is ten times as long has to be narrower by as much.
    assert measure_fairness(ridged(0.6, 0.6 + 0.99 / 2000, length=10.0)).jumps > 1e-8
    assert measure_fairness(ridged(0.6, 0.6 + 1.01 / 2000, length=10.0)).jumps < 1e-12


@pytest.mark.parametrize(
    ("way", "gap"), [(90, 2 * np.sqrt(2) / np.pi), (270, 2 * np.sqrt(2) / 3 / np.pi), (360, 1 / 50)]
)
def test_a_cluster_is_narrow_by_the_gap_and_not_by_the_way_round(way, gap):
    """An arc of length 1 across, which closes at last, pulled along a length of 1 with two knots that are close."""
    for share, is_line in ((0.99, True), (1.01, False)):
        found = measure_fairness(pulled(arc((0, 0), 1 / np.radians(way), 0, way), 0.6, 0.6 + share * gap / 200))
        assert (found.jumps > 1e-3) is is_line


def test_many_narrow_spans_are_no_cluster():
    # All are below a quarter of the window, and what they hold counts as it is; even where they are no wider together.
    found = measure_fairness(ridged(*(np.arange(1, 8) / 8), length=0.02))
    assert found.jumps < 1e-9 * found.smooth
    assert _wide_spans(np.arange(9) / 8, 0.1, 0.25).all()
    # Pairs that are all but one among them are.
    pairs = np.sort(np.concatenate([np.arange(1, 8) / 8, np.arange(1, 8) / 8]))
    near = pairs + 1e-9 * (np.arange(14) % 2)
    double, near = measure_fairness(ridged(*pairs, length=0.02)), measure_fairness(ridged(*near, length=0.02))
    assert (near.value, near.jumps) == pytest.approx((double.value, double.jumps), rel=1e-4)


def test_clusters_are_found_among_spans_that_are_narrow():
    # Each span is narrow by the limit of 0.005 and by the mean span, and all together are too wide for one cluster.
    pairs = [x + y for x in (0.5, 0.503, 0.506, 0.509) for y in (0.0, 1e-9)]
    breaks = np.array([0.0, 0.2, *pairs, 0.8, 1.0])
    assert _wide_spans(breaks, 50.0, 0.25).tolist() == [True, True, *[False, True] * 4, True]
    # Without the pairs they are what they are.
    assert _wide_spans(np.delete(breaks, [3, 5, 7, 9]), 50.0, 0.25).all()


def test_a_cluster_at_an_end_is_left_out():
    near, without = (measure_fairness(ridged(*inner)) for inner in ((1e-9, 0.6, 0.6), (1e-5, 0.6, 0.6)))
    assert near.settled
    assert near.value == pytest.approx(without.value, rel=1e-3)
    assert np.isfinite(near.value)


def measured_as(monkeypatch, *values):
    """A flat surface whose finer and finer grids give these values, and how many of them were taken.

    A value may be a pair: of the two halves of the surface.
    """
    taken = []
    halves = isinstance(values[0], tuple)

    def smooth_part(_, rules):
        value = values[len(taken)]
        taken.append(value)
        gradients = np.zeros(len(rules[1].points))
        # At the first point, or at the first and the last.
        gradients[[0, -1] if halves else [0]] = value
        return gradients, 1.0

    monkeypatch.setattr(fairness, "_smooth_part", smooth_part)
    monkeypatch.setattr(fairness, "_jumps", lambda *_: 0.0)
    k, y = [0, 0, 1, 1], [0, 0.5, 1] if halves else [0, 1]
    flat = BSplineSurface(1, 1, k, [0, *y, 1], [[[x, at, 0] for at in y] for x in (0, 1)])
    return measure_fairness(flat), len(taken)


@pytest.mark.parametrize(
    ("values", "count"),
    [
        # A hundredth of the last one, and what is below a visible shape by eight digits.
        ((1.0, 1.0, 9.0), 2),
        ((0.9901, 1.0, 1.0), 2),
        ((0.9899, 1.0, 1.0), 3),
        ((1.0099, 1.0, 1.0), 2),
        ((1.0101, 1.0, 1.0), 3),
        ((0.0, 0.99e-8, 9.0), 2),
        ((0.0, 1.01e-8, 1.01e-8), 3),
    ],
)
def test_a_change_of_a_hundredth_settles(monkeypatch, values, count):
    found, taken = measured_as(monkeypatch, *values)
    assert (found.settled, found.value, taken) == (True, values[count - 1], count)


@pytest.mark.parametrize(
    ("values", "count"),
    [
        # What one half gains the other loses: the sum alone would settle at once.
        (((1.0, 3.0), (3.0, 1.0), (3.0, 1.0)), 3),
        (((0.98, 1.02), (1.0, 1.0), (1.0, 1.0)), 3),
        (((0.991, 1.009), (1.0, 1.0), (1.0, 1.0)), 2),
    ],
)
def test_each_span_settles(monkeypatch, values, count):
    found, taken = measured_as(monkeypatch, *values)
    assert (found.settled, found.value, taken) == (True, sum(values[count - 1]), count)


def test_the_meter_gives_up_after_five_finer_grids(monkeypatch):
    found, taken = measured_as(monkeypatch, *(2.0**n for n in range(20)))
    assert (found.settled, found.value, taken) == (False, 32.0, 6)


@pytest.mark.parametrize(
    ("values", "count"),
    [
        # Tenfold where spans are halved, up or down; not where the first rule has fewer points than the second.
        ((1.0, 99.0, 989.0, 989.0), 4),
        ((1.0, 99.0, 991.0, 991.0), 3),
        ((1.0, 0.05, 0.0051, 0.0051), 4),
        ((1.0, 0.05, 0.0049, 0.0049), 3),
        ((1.0, 2.0, 4.0, 41.0, 41.0), 4),
    ],
)
def test_what_changes_tenfold_is_given_up_at_once(monkeypatch, values, count):
    found, taken = measured_as(monkeypatch, *values)
    assert (found.settled, found.value, taken) == (count == 4 and len(values) == 4, values[count - 1], count)


@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_a_cuspidal_edge_is_given_up_and_a_sharp_bend_is_not(monkeypatch, slope):
    """(t^2, t^3 + slope t) along x: |grad H|^2 dA is about dt / t^5, so infinite, where the slope is 0."""
    taken = []
    smooth_part = fairness._smooth_part
    monkeypatch.setattr(fairness, "_smooth_part", lambda *of: taken.append(smooth_part(*of)) or taken[-1])
    t = np.polynomial.Polynomial([-0.37, 1.0])
    y, z = ((t**k).coef for k in (2, 3))
    y, z = np.append(y, 0.0), z + slope * np.append(t.coef, [0.0, 0.0])
    # Monomials to Bernstein coefficients, by blossoms.
    points = [
        [0.0, *(c[0] + k * c[1] / 3 + comb(k, 2) * c[2] / 3 + comb(k, 3) * c[3] for c in (y, z))] for k in range(4)
    ]
    net = np.array([points, np.add(points, [1.0, 0.0, 0.0])])
    found = measure_fairness(BSplineSurface(1, 3, [0, 0, 1, 1], [0] * 4 + [1] * 4, net))
    assert found.settled == (slope > 0)
    assert found.settled or len(taken) == 3


@pytest.mark.parametrize(("points", "count"), [(2**11, 3), (2**11 + 1, 2)])
def test_no_grid_holds_more_than_two_million_points(monkeypatch, points, count):
    sizes = iter([(10, 10), (100, 100), (2**10, points), (4, 4), (4, 4), (4, 4)])
    monkeypatch.setattr(fairness, "_rules", lambda *_: tuple(_Rule(np.zeros(n), np.zeros(n)) for n in next(sizes)))
    found, taken = measured_as(monkeypatch, 1.0, 2.0, *([4.0] if count == 2 else [4.0, 4.0]))
    assert (found.settled, taken) == (count == 3, 2 if count == 2 else 4)


def test_pairs_are_found_in_clusters_as_tight_as_knots_may_be():
    # Twenty knots 2e-10 apart are wider together than a cluster may be of a surface this long; pairs of them are not.
    knots = 0.5 + 2e-10 * np.arange(20)
    breaks = np.array([0.0, *np.sort(np.concatenate([knots, knots + 3e-12])), 1.0])
    assert _wide_spans(breaks, 1e8, 0.25).tolist() == [True, *[False, True] * 19, False, True]


@pytest.mark.parametrize(("part", "narrow"), [(0.045, True), (0.055, False)])
def test_spans_of_a_cluster_are_below_a_twentieth_of_the_mean_one(part, narrow):
    # Three spans of a surface one window long: a cluster may be a quarter of it.
    assert _wide_spans(np.array([0.0, 0.4, 0.4 + part / 3, 1.0]), 1.0, 0.25).tolist() == [True, not narrow, True]
