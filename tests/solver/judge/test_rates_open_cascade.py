"""A second judge of G3 and G4: other formulas, on derivatives that Open CASCADE evaluates. Both say the same."""

import numpy as np
import pytest

from helpers.high_order import SIZES, facing, hand_made
from helpers.occ_rates import Contact, section
from semispline import Base, BSplineSurface, blend, measure_contact
from semispline.solver.judge import shortfalls
from semispline.solver.splines.operations import split_u

NAMES = ("curvature_jump_relative", "rate_jump_relative", "second_rate_jump_relative")
LIMITS = (1e-9, 1e-8, 1e-7)
EDGES = [("u0", "v1"), ("v0", "u1"), ("u1", "u0")]


@pytest.mark.parametrize("order", [3, 4])
@pytest.mark.parametrize(("seed", "edges"), list(enumerate(EDGES)))
def test_both_confirm_what_is_exact(order, seed, edges):
    a, b, p_a, p_b = facing(np.random.default_rng(seed), order, edges)
    for size in SIZES[order][-2:]:
        made = hand_made(a, b, order, p_a=p_a, p_b=p_b, size=size)
        for pair in ((a, Base(made, "u0")), (Base(made, "u1"), b)):
            assert not shortfalls(measure_contact(*pair, flip="no", order=order), f"G{order}")
            judged = Contact(*pair, order).relative_jumps()
            assert len(judged) == order - 1
            assert (judged < np.array(LIMITS[: order - 1]) / 10).all(), judged


@pytest.mark.parametrize("continuity", ["G3", "G4", ("G4", "G3")])
@pytest.mark.parametrize(("seed", "edges"), [(0, ("u0", "u0")), (3, ("u1", "v0"))])
def test_the_second_judge_confirms_blends(continuity, seed, edges):
    a, b, *_ = facing(np.random.default_rng(seed), 3, edges)
    result = blend(a, b, continuity=continuity)
    surface = result.surface
    for pair, asked, flipped in (
        ((a, Base(surface, "u0")), result.continuity[0], False),
        ((Base(surface, "u1"), b), result.continuity[1], result.flipped),
    ):
        judged = Contact(*pair, int(asked[1]), flipped=flipped).relative_jumps()
        assert (judged < np.array(LIMITS[: len(judged)]) / 10).all(), judged


FAULTS = [(3, (2, 2)), (3, (3, 3)), (3, (3, 2)), (4, (3, 3)), (4, (4, 4)), (4, (4, 3)), (4, (4, 2)), (4, (3, 1))]


@pytest.mark.parametrize(("order", "place"), FAULTS)
@pytest.mark.parametrize(("seed", "edges"), list(enumerate(EDGES)))
def test_both_find_the_same_fault_at_the_same_place(order, place, seed, edges):
    a, b, p_a, p_b = facing(np.random.default_rng(seed), order, edges)
    made = Base(hand_made(a, b, order, p_a=p_a, p_b=p_b, faults={place: 1.01}), "u0")
    found, other = measure_contact(a, made, flip="no", order=order), Contact(a, made, order)
    judged = other.relative_jumps()
    for name, limit, value in zip(NAMES, LIMITS, judged, strict=False):
        assert (value <= limit) == (getattr(found, name) <= limit)
    for k, name in enumerate(("curvature", "rate", "second_rate")[: order - 1]):
        at_a, at_b = other.rates(getattr(found, f"{name}_at").parameter)
        size = max(abs(at_a[k]), abs(at_a[0]) ** (k + 1), 1e-3)
        assert abs(at_a[k] - at_b[k]) == pytest.approx(getattr(found, f"{name}_jump"), rel=1e-6, abs=1e-9 * size)


def test_against_each_other_on_surfaces_that_just_meet():
    # Neighbours with nothing but a common edge and tangent: every rate jumps, and both say by how much.
    a, b, p_a, p_b = facing(np.random.default_rng(5), 4)
    made = hand_made(a, b, 4, p_a=p_a, p_b=p_b, faults={(2, 2): 3.0, (3, 1): -2.0, (4, 4): 5.0})
    found, other = measure_contact(a, Base(made, "u0"), flip="no", order=4), Contact(a, Base(made, "u0"), 4)
    for k, name in enumerate(("curvature", "rate", "second_rate")):
        at_a, at_b = other.rates(getattr(found, f"{name}_at").parameter)
        assert abs(at_a[k] - at_b[k]) == pytest.approx(getattr(found, f"{name}_jump"), rel=1e-9)


def test_edges_that_run_against_each_other():
    a, b, p_a, p_b = facing(np.random.default_rng(3), 4)
    made = hand_made(a, b, 4, p_a=p_a, p_b=p_b, faults={(3, 3): 1.1}).to_bspline()
    v0, v1 = made.domain[1]
    knots = v0 + v1 - made.knots_v[::-1]
    back = Base(BSplineSurface(made.degree_u, made.degree_v, made.knots_u, knots, made.control_points[:, ::-1]), "u0")
    found, other = measure_contact(a, back, flip="yes", order=4), Contact(a, back, 4, flipped=True)
    at_a, at_b = other.rates(found.rate_at.parameter)
    assert abs(at_a[1] - at_b[1]) == pytest.approx(found.rate_jump, rel=1e-7)
    assert found.rate_jump_relative > 1e-3


def test_rational_surfaces():
    rng = np.random.default_rng(1)
    a, *_ = facing(rng, 4)
    s = a.surface
    weights = rng.uniform(0.5, 2.0, s.control_points.shape[:2])
    whole = BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, s.control_points, weights)
    low, high = whole.domain[0]
    before, after = split_u(whole, low + 0.1 * (high - low))
    # Of the second part one weight is changed: rows 0 to 2 keep curvature, row 3 does not keep its rate.
    other = after.weights.copy()
    other[3, 2] *= 1.01
    after = BSplineSurface(4, 3, after.knots_u, after.knots_v, after.control_points, other)
    pair = Base(before, "u1"), Base(after, "u0")
    found, judge = measure_contact(*pair, flip="no", order=4), Contact(*pair, 4)
    assert [name for name, _, _ in shortfalls(found, "G4")] == ["rate_jump_relative"]
    for k, name in ((1, "rate"), (2, "second_rate")):
        at_a, at_b = judge.rates(getattr(found, f"{name}_at").parameter)
        assert abs(at_a[k] - at_b[k]) == pytest.approx(getattr(found, f"{name}_jump"), rel=1e-7)


def test_the_second_judge_knows_a_circle_and_a_graph():
    # A circle of radius 2 in the plane y = 0, by w^2 instead of its angle; the edge along y.
    at = {(i, j): np.zeros(3) for i in range(5) for j in range(5 - i)}
    at[0, 1] = np.array([0.0, 3.0, 0.0])
    # x = 2 sin t, z = 2 - 2 cos t with t = w + w^2: derivatives of t 1, 2 and then none.
    at[1, 0] = np.array([2.0, 0, 0])
    at[2, 0] = np.array([4.0, 0, 2.0])
    at[3, 0] = np.array([-2.0, 0, 12.0])
    at[4, 0] = np.array([-24.0, 0, 22.0])
    _, found = section(at)
    np.testing.assert_allclose(np.abs(found[0]), 0.5, rtol=1e-15)
    np.testing.assert_allclose(found[1:], 0, atol=1e-14)
    graph = {key: np.zeros(3) for key in at}
    graph[1, 0], graph[0, 1] = np.array([1.0, 0.2, 0]), np.array([0, 2.0, 0])
    graph[2, 0][2], graph[3, 0][2], graph[4, 0][2] = 0.5, -3.0, 7.0
    _, found = section(graph, np.array([0, 0, 1.0]))
    np.testing.assert_allclose(found, [0.5, -3.0, 7.0 - 3 * 0.125], rtol=1e-14)
