"""The measures of contact, where the answer is known, and against Open CASCADE."""

from dataclasses import asdict

import numpy as np
import pytest

from helpers.bases import facing_pair, moved
from helpers.occ import analyse, edge_point
from semispline import Base, BSplineSurface, EdgeError, map_domain, measure_contact
from semispline.solver.judge import continuity, correspond, edge_samples, untold
from semispline.solver.judge.edge_normals import check_regular_edge
from semispline.solver.splines.knots import uniform_knots
from semispline.solver.splines.operations import reverse_u, reverse_v, split_u, swap_directions

BEZIER_1, BEZIER_2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]


def parabola(curvature, *, bend=1.0, offset=0.0, tilt=0.0):
    """X = (bend u, v, curvature u^2 / 2 + tilt u + offset): normal curvature at u = 0 is curvature where bend is 1."""
    heights = (offset, offset + tilt / 2, offset + tilt + curvature / 2)
    net = [[[bend * u, v, z] for v in (0, 1)] for u, z in zip((0, 0.5, 1), heights, strict=True)]
    return BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net)


def test_gap_angle_and_curvature_of_parabolas():
    a, b = parabola(2.0), parabola(-1.0, bend=-1.0, offset=0.25)
    contact = measure_contact(Base(a, "u0"), Base(b, "u0"))
    assert contact.gap == pytest.approx(0.25, rel=1e-14)
    # Rates are measured where they are asked for.
    assert (contact.rate_jump, contact.second_rate_jump) == (None, None)
    assert contact.angle_degrees == pytest.approx(0, abs=1e-12)
    # Seen with one normal, the curvatures are 2 and -1.
    assert contact.curvature_jump == pytest.approx(3.0, rel=1e-13)
    assert contact.curvature_jump_relative == pytest.approx(1.5, rel=1e-13)
    assert contact.c1_residual == pytest.approx(0.0, abs=1e-15)
    assert contact.c2_residual == pytest.approx(1.5, rel=1e-14)


@pytest.mark.parametrize("degrees", [1e-7, 1e-3, 30.0, 89.0])
def test_small_and_large_angles(degrees):
    tilted = parabola(0.0, bend=-1.0, tilt=np.tan(np.radians(degrees)))
    contact = measure_contact(Base(parabola(0.0), "u0"), Base(tilted, "u0"))
    assert contact.angle_degrees == pytest.approx(degrees, rel=1e-7)


def test_speeds_differ_but_geometry_agrees():
    slow, fast = (
        parabola(2.0),
        BSplineSurface(2, 1, [0, 0, 0, 0.25, 0.25, 0.25], BEZIER_1, parabola(2.0).control_points),
    )
    back = moved(fast, np.diag([-1.0, 1, 1]))
    contact = measure_contact(Base(slow, "u0"), Base(back, "u0"))
    assert contact.curvature_jump_relative == pytest.approx(0, abs=1e-12)
    assert contact.c1_residual == pytest.approx(0.75, rel=1e-12)
    assert contact.c2_residual == pytest.approx(15 / 16, rel=1e-12)


def test_the_worst_place_is_named():
    bent = parabola(0.0, bend=-1.0).control_points.copy()
    bent[0, 1, 2] = 0.5
    contact = measure_contact(
        Base(parabola(0.0), "u0"), Base(BSplineSurface(2, 1, BEZIER_2, BEZIER_1, bent), "u0"), flip="no"
    )
    assert contact.gap == pytest.approx(0.5)
    assert contact.gap_at.parameter == 1.0
    assert contact.gap_at.point == (0.0, 1.0, 0.0)


@pytest.mark.parametrize("turn", [lambda s: s, reverse_u, reverse_v, swap_directions])
def test_measures_do_not_depend_on_how_the_surfaces_are_parametrised(turn):
    a, b = parabola(2.0, tilt=0.2), parabola(-1.0, bend=-1.0, offset=0.25, tilt=0.1)
    edge = {reverse_u: "u1", swap_directions: "v0"}.get(turn, "u0")
    plain = measure_contact(Base(a, "u0"), Base(b, "u0"))
    turned = measure_contact(Base(a, "u0"), Base(turn(b), edge))
    assert turned.flipped == (turn is reverse_v)
    for name in ("gap", "angle_degrees", "curvature_jump", "curvature_jump_relative", "c1_residual", "c2_residual"):
        assert getattr(turned, name) == pytest.approx(getattr(plain, name), rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_angle_agrees_with_open_cascade(seed):
    # A base met with itself moved and turned a little: everything is off by a known, measurable amount.
    a, _ = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    turn = np.array([[np.cos(0.01), 0, np.sin(0.01)], [0, 1, 0], [-np.sin(0.01), 0, np.cos(0.01)]])
    b = moved(a.surface, turn @ np.diag([-1.0, 1, 1]))
    contact = measure_contact(a, Base(b, "u0"), flip="no")
    (v0, v1) = a.range_along
    s = (contact.angle_at.parameter - v0) / (v1 - v0)
    judged = analyse(a.surface, edge_point(a.surface, "u0", s), b, edge_point(b, "u0", s))
    # Open CASCADE compares planes, which have no side; the patches here may turn by more than a right angle.
    angle = np.radians(contact.angle_degrees)
    assert min(angle, np.pi - angle) == pytest.approx(judged.G1Angle(), rel=1e-9)


@pytest.mark.parametrize("edge", ["u2", "", "w0", 0])
def test_unknown_edge(edge):
    with pytest.raises(EdgeError, match="expected one of u0, u1, v0, v1"):
        Base(parabola(1.0), edge)


def test_an_edge_without_a_normal_has_no_angle():
    cone = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[0, 0, 1], [0, 0, 1]], [[1, 0, 0], [0, 1, 0]]])
    contact = measure_contact(Base(cone, "u0"), Base(parabola(1.0), "u0"))
    assert np.isnan(contact.angle_degrees)
    assert np.isnan(contact.curvature_jump_relative)
    assert contact.gap > 0
    with pytest.raises(EdgeError, match="no normal at parameter"):
        check_regular_edge(Base(cone, "u0"))


@pytest.mark.parametrize("turn", [lambda s: s, reverse_v])
def test_a_fold_back_is_no_contact(turn):
    # The same parabola twice: the second lies on the first instead of continuing it.
    contact = measure_contact(Base(parabola(2.0), "u0"), Base(turn(parabola(2.0)), "u0"))
    assert contact.angle_degrees == pytest.approx(180)
    assert contact.gap < 1e-15


def halves(spans, moved_point=(0, 0), by=0.0):
    """A long strip cut in two, v over [0, 1]; of the second half a control point is moved along the normal."""
    rng = np.random.default_rng(3)
    x, y = np.meshgrid(np.arange(4.0), np.arange(spans + 3.0), indexing="ij")
    net = np.stack([x, y, 0.1 * rng.uniform(-1, 1, x.shape)], axis=2)
    a, b = split_u(BSplineSurface(3, 3, uniform_knots(3, 1), uniform_knots(3, spans), net), 0.5)
    points = b.control_points.copy()
    points[moved_point] += [0, 0, by]
    return Base(a, "u1"), Base(BSplineSurface(3, 3, b.knots_u, b.knots_v, points), "u0")


@pytest.mark.parametrize(("row", "name"), [(0, "gap"), (1, "angle"), (2, "curvature")])
@pytest.mark.parametrize("place", ["first", "last"])
def test_a_fault_in_one_span_of_thousands_is_found_and_placed(row, name, place):
    # Five parts of samples and a little more: the last part is a small one, and the fault is at its very end.
    spans = 5 * edge_samples._AT_ONCE // 7 + 3
    sound = measure_contact(*halves(spans))
    faulty = measure_contact(*halves(spans, (row, 0 if place == "first" else -1), 1e-3))
    measure = {"gap": "gap", "angle": "angle_degrees", "curvature": "curvature_jump"}[name]
    assert getattr(sound, measure) <= 1e-9
    assert getattr(faulty, measure) >= 1e-4
    parameter = getattr(faulty, f"{name}_at").parameter
    assert parameter <= 1 / spans if place == "first" else parameter >= 1 - 1 / spans
    # Rows are met by derivatives of their order and above, not by those below.
    assert row == 0 or faulty.gap <= 1e-12
    assert row < 2 or faulty.angle_degrees <= 1e-9


@pytest.mark.parametrize("at_once", [5, 64, 4096])
@pytest.mark.parametrize("edges", [("u1", "u0"), ("v0", "v1"), ("u0", "v0")])
def test_measured_in_parts_as_measured_at_once(monkeypatch, at_once, edges):
    a, b = (Base(side.surface, edge) for side, edge in zip(halves(40, (1, 17), 0.2), edges, strict=True))
    found = []
    for size in (10**9, at_once):
        monkeypatch.setattr(edge_samples, "_AT_ONCE", size)
        contact = asdict(measure_contact(a, b, flip="no", order=4))
        places = [contact.pop(f"{name}_at") for name in ("gap", "angle", "curvature", "rate", "second_rate")]
        rounding = contact.pop("rounding") | {f"{name} allowed": x for name, x in contact.pop("allowed").items()}
        assert contact.pop("no_normal") == ()
        assert contact.pop("corresponds") == "affine"
        found.append((rounding, contact, [(p["parameter"], *p["point"]) for p in places]))
    (rounding, measures, places), (other_rounding, others, other_places) = found
    # The same arithmetic: what differs is at most how the processor takes the last few numbers of an array.
    assert others == pytest.approx(measures, rel=1e-13)
    assert other_rounding == pytest.approx(rounding, rel=1e-13)
    np.testing.assert_allclose(other_places, places, rtol=1e-13)


def test_of_a_part_with_a_place_without_a_normal_the_rest_counts():
    # A control point of the second row moved onto the edge: the cross derivative vanishes at that end only.
    a, b = halves(3 * edge_samples._AT_ONCE // 7)
    points = b.surface.control_points.copy()
    points[1, -1] = points[0, -1]
    cusp = BSplineSurface(3, 3, b.surface.knots_u, b.surface.knots_v, points)
    contact = measure_contact(a, Base(cusp, "u0"))
    assert np.isfinite([contact.angle_degrees, contact.curvature_jump, contact.curvature_jump_relative]).all()
    assert np.isfinite([*contact.rounding.values()]).all()
    assert contact.angle_at.parameter < 1
    assert [place.parameter for place in contact.no_normal] == [1.0]


@pytest.mark.parametrize("width", [1e-9, 1e-6, 0.1])
def test_close_knots_along_a_contact_in_common_make_no_angle(width):
    # Rounding turns the tangent along the edge within a narrow span by 1e-16 / width, on both sides alike.
    knots = [0, 0, 0, 0.5, 0.5 + width, 1, 1, 1]
    rng = np.random.default_rng(0)
    rows = [
        [[x, y, 0.1 * z] for y, z in zip(np.linspace(0, 1, 5), rng.uniform(size=5), strict=True)] for x in (0, 1, 2)
    ]
    left = BSplineSurface(1, 2, [0, 0, 1, 1], knots, rows[:2])
    right = BSplineSurface(1, 2, [0, 0, 1, 1], knots, rows[1:])
    contact = measure_contact(Base(left, "u1"), Base(right, "u0"))
    assert contact.rounding["angle_degrees"] < 1e-12
    # Moved by a hair the edges differ, and what rounding does to their tangents counts.
    apart = np.array(rows[1:]) + 1e-13 * rng.uniform(-1, 1, (2, 5, 3))
    other = measure_contact(Base(left, "u1"), Base(BSplineSurface(1, 2, [0, 0, 1, 1], knots, apart), "u0"))
    assert other.rounding["angle_degrees"] > contact.rounding["angle_degrees"]


@pytest.mark.parametrize("backwards", [False, True])
def test_how_far_derivatives_along_both_sides_are_apart(monkeypatch, backwards):
    """Edge a is y = t and b is y = t + t (1 - t) / 10, run through three times as slowly: in the parameter of each."""
    seen = []
    noises = edge_samples.section_noises

    def watched(*words):
        seen.append(words[-1])
        return noises(*words)

    monkeypatch.setattr(edge_samples, "section_noises", watched)
    a = BSplineSurface(1, 1, BEZIER_1, BEZIER_1, [[[x, 0, 0], [x, 1, 0]] for x in (0, 1)])
    b = BSplineSurface(1, 2, BEZIER_1, BEZIER_2, [[[x, y, 0] for y in (0, 0.55, 1)] for x in (1, 2)])
    b = map_domain(b, (0, 1), (5, 8))
    measure_contact(Base(a, "u1"), Base(reverse_v(b) if backwards else b, "u0"))
    # Affinely first; as one line with two parametrisations by feet, then.
    (first_a, second_a), (first_b, second_b) = seen[:2]
    assert first_a.max() == pytest.approx(0.1)
    assert second_a == pytest.approx(np.full(len(second_a), 0.2))
    assert first_b == pytest.approx(first_a / 3)
    assert second_b == pytest.approx(second_a / 9)


def uneven(start, degrees, weight=1e5):
    """A plane strip in general position whose weights fall by a factor from its edge at `start`; the first edge is u0.

    It is tilted about that edge.
    """
    slope = np.tan(np.radians(degrees))
    net = [[[start + t, 3 * y, slope * t] for y in (0, 1)] for t in (0, 0.5, 1)]
    turn = np.array([[2, -2, 1], [1, 2, 2], [2, 1, -2]]) / 3
    weights = np.multiply.outer([weight, 1, 1], [1.0, 3.0])
    return BSplineSurface(2, 1, BEZIER_2, BEZIER_1, np.array(net) @ turn.T, weights=weights)


def mirrored(degrees=0.0, weight=1e5):
    """Two such strips on both sides of x = 1."""
    left = uneven(1.0, 0.0, weight)
    net = left.control_points.copy()
    net[1:] = 2 * net[:1] - net[1:]
    return (
        BSplineSurface(2, 1, BEZIER_2, BEZIER_1, net, weights=left.weights),
        uneven(1.0, degrees, weight),
    )


@pytest.mark.parametrize(("degrees", "is_told"), [(0.0, True), (0.8e-9, True), (1.2e-9, False), (1e-3, False)])
def test_what_the_bound_on_rounding_hides_is_told_where_it_is_within_the_limit(degrees, is_told):
    # Weights that differ by 10^5 bound the rounding of the angle by 0.1 degree; many digits show the angle as it is.
    a, b = mirrored(degrees)
    contact = measure_contact(Base(a, "u0"), Base(b, "u0"))
    assert bool(untold(contact, "G1")) is not is_told
    if is_told:
        # Of rounding ten times as much is allowed as it does where it is looked at.
        error = contact.angle_degrees - degrees
        assert 1e-11 < error < 1e-7
        assert 5 * error < contact.rounding["angle_degrees"] < 20 * error
        assert contact.allowed["angle_degrees"] == pytest.approx(1e-9 + contact.rounding["angle_degrees"], rel=1e-12)
    else:
        assert contact.rounding["angle_degrees"] > 0.01


@pytest.mark.parametrize("order", [3, 4])
@pytest.mark.parametrize(("times", "is_told"), [(0.5, True), (1.5, False)])
def test_a_rate_that_rounding_may_hide_is_told_beside_a_second_rate_that_jumps(order, times, is_told):
    # z is (t / 100)^3 or so on both sides, its second rate the opposite one: its weights differ by a hundred.
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    weights = np.multiply.outer([100.0, 1, 1, 1], [1.0, 3.0])
    net = np.array([[[t, y, z] for y in (0.0, 3.0)] for t, z in zip((0, 0.25, 0.5, 1), (0, 0, 0, 1), strict=True)])
    other = np.concatenate([net[:1], 2 * net[:1] - net[1:]])
    other[3, :, 2] *= 1 + times * 1e-8
    a, b = (Base(BSplineSurface(3, 1, knots, BEZIER_1, points, weights), "u0") for points in (net, other))
    contact = measure_contact(a, b, order=order)
    assert contact.rate_jump_relative == pytest.approx(times * 1e-8, rel=1e-3)
    # The bound is 5e-3, above what can be told; many digits leave less than the limit, 1e-8.
    assert (contact.rounding["rate_jump_relative"] < 1e-9) == is_told
    assert bool(contact.rounding["rate_jump_relative"] > 1e-3) != is_told


@pytest.mark.parametrize(
    ("degrees", "weight", "expected"),
    [
        # The bound is 1e-8 degree on the angle, and 0.009 on the curvature.
        (0.0, 30.0, []),
        (0.0, 1e5, ["angle_degrees", "curvature_jump_relative"]),
        # An angle above what is allowed is one.
        (5.0, 1e5, ["curvature_jump_relative"]),
    ],
)
def test_only_what_is_bounded_too_widely_is_looked_at_again(monkeypatch, degrees, weight, expected):
    asked = []

    def told(edges, pairs, found, result, hidden):
        asked.extend(hidden)
        return result

    monkeypatch.setattr(continuity, "_told", told)
    measure_contact(*(Base(surface, "u0") for surface in mirrored(degrees, weight)))
    assert asked == expected


def test_rounding_of_rates_is_that_of_the_worst_sample():
    bent = [[[u, v, (u - 0.3) ** 3 * (1 + 9 * v)] for v in (0, 1)] for u in (0, 1 / 3, 2 / 3, 1)]
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    base = Base(BSplineSurface(3, 1, knots, BEZIER_1, bent), "u0")
    edges = edge_samples.Edges(base, base, correspond(base, base, "no"), np.zeros(3), 3)
    s = np.array([0.0, 1.0])
    first, second, both = (edges.measured(at, at).noises[2] for at in (s[:1], s[1:], s))
    assert 0 < min(first, second) < 0.9 * max(first, second)
    assert both == max(first, second)
