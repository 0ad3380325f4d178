"""What rounding may do to derivatives, and through them to rates of curvature: by hand, and tried."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from helpers.sweeps import examples
from semispline import Base, BSplineCurve, BSplineSurface, SemiStructuredSurface
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.rounding import (
    RoundingCauses,
    derivative_noises,
    edge_noises,
    noises_of_derivatives,
    rounding_causes,
)

KEYS = [(i, j) for i in range(5) for j in range(5 - i)]
ORIGIN = np.zeros(3)
# Coordinates of at most 1, the farthest corner at (1, 1, 0).
ONE = (8 + 2**0.5 / 2) * 2.0**-52


def square(degree_u, knots_u, degree_v, knots_v, weights=None):
    u, v = (np.linspace(0, 1, len(k) - d - 1) for d, k in ((degree_u, knots_u), (degree_v, knots_v)))
    net = np.stack([*np.meshgrid(u, v, indexing="ij"), np.zeros((len(u), len(v)))], axis=2)
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, net, weights)


def test_factors_across_and_along():
    # Across the first span counts for every order; along the least distance that each order divides by: three knots
    # apart, two, and one; at the double knot 0.5 nothing is divided by zero.
    knots_v = [0, 0, 0, 0, 0.1, 0.5, 0.5, 0.8, 1, 1, 1, 1]
    surface = square(2, [0, 0, 0, 0.25, 1, 1, 1], 3, knots_v)
    across = [1, 4 / 0.25, 4 / 0.25 * 2 / 0.25, 0, 0]
    first = 6 / 0.1
    second = first * 4 / 0.1
    along = [1, first, second, second * 2 / 0.1, 0]
    found = derivative_noises(Base(surface, "u0"), ORIGIN, 4)
    np.testing.assert_allclose(found, ONE * np.outer(across, along), rtol=1e-13)
    # From the other end the first span is 0.75 long; the other way round along is across.
    found = derivative_noises(Base(surface, "u1"), ORIGIN, 4)
    np.testing.assert_allclose(found[:, 0], ONE * np.array([1, 4 / 0.75, 4 / 0.75 * 2 / 0.75, 0, 0]), rtol=1e-13)
    found = derivative_noises(Base(surface, "v0"), ORIGIN, 4)
    np.testing.assert_allclose(found[:, 0], ONE * np.array([1, 60, 60 * 40, 60 * 40 * 20, 0]), rtol=1e-13)


def test_up_to_second_order_where_none_is_asked_for():
    base = Base(square(2, [0, 0, 0, 0.25, 1, 1, 1], 3, [0, 0, 0, 0, 0.5, 1, 1, 1, 1]), "u0")
    np.testing.assert_array_equal(derivative_noises(base, ORIGIN), derivative_noises(base, ORIGIN, 2))
    noises = edge_noises(base, ORIGIN)
    np.testing.assert_array_equal(noises.derivatives, derivative_noises(base, ORIGIN, 2))
    np.testing.assert_allclose(noises.along, [1, 6 / 0.5, 6 / 0.5 * 4 / 0.5])
    # Where everything is zero nothing is rounded.
    nothing = edge_noises(Base(BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], np.zeros((2, 2, 3))), "u0"), ORIGIN)
    assert nothing.along.tolist() == [1, 1, 1]
    assert not nothing.derivatives.any()


def test_a_narrow_span_counts_only_where_one_divides_by_it():
    # Simple knots 0.3 and 0.30001: first differences reach over three spans.
    surface = square(1, [0, 0, 1, 1], 3, [0, 0, 0, 0, 0.3, 0.30001, 1, 1, 1, 1])
    found = derivative_noises(Base(surface, "u0"), ORIGIN, 4)[0] / ONE
    np.testing.assert_allclose(found[:3], [1, 6 / 0.3, 6 / 0.3 * 4 / 0.3], rtol=1e-13)
    assert found[3] == pytest.approx(6 / 0.3 * 4 / 0.3 * 2 / 1e-5, rel=1e-6)


@pytest.mark.parametrize("edge", ["u0", "u1"])
def test_quotients_have_derivatives_above_their_degree(edge):
    knots = [0, 0, 0, 1, 1, 1]
    plain = derivative_noises(Base(square(2, knots, 2, knots), edge), ORIGIN, 4) / ONE
    np.testing.assert_allclose(plain[:, 0], [1, 4, 8, 0, 0])
    equal = derivative_noises(Base(square(2, knots, 2, knots, np.full((3, 3), 2.0)), edge), ORIGIN, 4) / ONE
    np.testing.assert_array_equal(equal, plain)
    # Of weights 1 and 2: E_k = 2 F_k + sum C(k, j) F_j E_(k - j) / 2, with F = 1, 4, 8, 0, 0. And what rounding of the
    # weights does: sum C(k, j) E_j E_(k - j).
    points = np.array([1, 10, 60, 480, 5280])
    weights = np.array([1, 20, 320, 4560, 70560])
    expected = points + weights * 2.0**-52 / ONE
    uneven = square(2, knots, 2, knots, np.array([[1, 2, 1], [2, 1, 2], [1, 2, 1.0]]))
    for surface in (uneven, uneven.to_semistructured()):
        rational = derivative_noises(Base(surface, edge), ORIGIN, 4) / ONE
        np.testing.assert_allclose(rational[:, 0], expected)
        np.testing.assert_allclose(rational[0], expected)


def test_of_many_curves_those_that_are_read():
    straight = [0, 0, 1, 1]
    narrow = [0, 0, 0.1, 1, 1]
    rows = [straight, straight, straight, narrow, straight]
    net = [
        np.stack([np.full(len(k) - 2, i / 4), np.linspace(0, 1, len(k) - 2), np.zeros(len(k) - 2)], 1)
        for i, k in enumerate(rows)
    ]
    curves = [BSplineCurve(1, k, points) for k, points in zip(rows, net, strict=True)]
    surface = SemiStructuredSurface(4, [0] * 5 + [1] * 5, curves)
    for edge, order, expected in (("u0", 2, 2), ("u0", 3, 20), ("u1", 1, 20), ("u1", 0, 1), ("v0", 1, 8)):
        found = derivative_noises(Base(surface, edge), ORIGIN, order) / ONE
        assert found[0, min(order, 1)] == pytest.approx(expected)
    # Across an edge v = const each curve begins with a span of its own.
    assert derivative_noises(Base(surface, "v0"), ORIGIN, 1)[1, 0] / ONE == pytest.approx(20)


def graph(**derivatives):
    at = {key: np.zeros((1, 3)) for key in KEYS}
    at[1, 0][0, 0] = at[0, 1][0, 1] = 1.0
    for name, vector in derivatives.items():
        at[int(name[1]), int(name[2])][0] = vector
    return at


def noise_of(at, place, size=1e-9):
    noises = np.zeros((5, 5))
    noises[place] = size
    found = curvature_rates(at, np.array([[0.0, 0.0, 1.0]]), noises, 4)
    return [float(noise[0]) / size for noise in found.noises]


def test_noise_of_rates_by_hand():
    # Of X_ww on a parabola of curvature k, error d: of the step of order 2 d, of X_3 and the step of order 3 3 k d, of
    # X_4 4 k 3 k d; and of 3 k^3 it is 9 k^2 d.
    assert noise_of(graph(x20=(0, 0, 2.0)), (2, 0)) == pytest.approx([3 * 2.0, 21 * 2.0**2])
    # Of X_w, where X_www is tangential, m: the normal tilts by d, and each of three steps of order 1 is d too long.
    assert noise_of(graph(x30=(5.0, 0, 0)), (1, 0))[0] == pytest.approx(4 * 5.0)
    # Of X_v, where only X_wwv is not zero, c: the plane of the section turns by d.
    assert noise_of(graph(x21=(0, 0, 5.0)), (0, 1))[0] == pytest.approx(3 * 5.0)
    # With X_w = (1, 1/2, 0) and X_v = (0, g, 0): the normal tilts by (1/2 + 1) d / g, and of three steps of order 1, as
    # much too long each, X_www makes three times that.
    for g in (1.0, 2.0, 0.25):
        slanted = graph(x10=(1.0, 0.5, 0), x01=(0, g, 0), x30=(5.0, 0, 0))
        assert noise_of(slanted, (0, 1))[0] == pytest.approx((1 + 3) * 1.5 / g * 5.0)
    # Twice as fast across.
    assert noise_of(graph(x10=(2.0, 0, 0), x30=(40.0, 0, 0)), (1, 0))[0] == pytest.approx(4 * 5.0 / 2)
    # Of what is read directly.
    assert noise_of(graph(), (3, 0)) == pytest.approx([1, 0])
    assert noise_of(graph(), (4, 0)) == pytest.approx([0, 1])


@examples(40)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KEYS[1:]))
def test_no_small_error_of_a_derivative_does_more(seed, place):
    rng = np.random.default_rng(seed)
    at = {key: rng.uniform(-1, 1, (1, 3)) for key in KEYS}
    cross = np.cross(at[1, 0], at[0, 1])
    assume(np.linalg.norm(cross) > 0.2)

    def rates(values):
        normal = np.cross(values[1, 0], values[0, 1])
        return curvature_rates(values, normal / np.linalg.norm(normal), noises, 4)

    size = 1e-7
    noises = np.zeros((5, 5))
    noises[place] = size
    plain = rates(at)
    for _ in range(30):
        error = rng.standard_normal((1, 3))
        other = rates(at | {place: at[place] + size * error / np.linalg.norm(error)})
        for before, after, bound in zip(plain.values, other.values, plain.noises, strict=True):
            assert abs(after - before)[0] <= bound[0] * (1 + 1e-3) + 1e-9 * abs(before[0]) + 1e-12


def test_what_rounding_once_does():
    # Across 1, 2, 4; once along 6, 12; twice along 20. An error across is magnified by the worst of 6 / 1 and 12 / 2.5.
    sizes = {(0, 0): 1.0, (1, 0): 2.5, (2, 0): 4.0, (0, 1): 6.0, (1, 1): 12.0, (0, 2): 20.0}
    found = noises_of_derivatives({key: np.array([[0.0, -size, 0.5]]) for key, size in sizes.items()}, 2)
    one = 8 * 2.0**-52
    np.testing.assert_allclose(found.derivatives, one * np.array([[1, 6, 20], [2.5, 12, 0], [4, 0, 0]]), rtol=1e-13)
    np.testing.assert_allclose(found.rows, one * np.diag([1, 2.5, 4]), rtol=1e-13)
    np.testing.assert_allclose(found.along, [1, 6, 20], rtol=1e-13)
    # Where nothing is there across nothing is magnified.
    with np.errstate(all="raise"):
        flat = noises_of_derivatives({key: np.zeros((1, 3)) if key[0] else np.ones((1, 3)) for key in sizes}, 2)
    np.testing.assert_allclose(flat.along, 1, rtol=1e-13)


@pytest.mark.parametrize(("ratios", "named"), [((1e3, 1.9e3), "blend"), ((1e3, 2.1e3), "base"), ((2e3, 1e3), "blend")])
def test_the_second_surface_is_named_where_its_weights_are_twice_as_uneven(ratios, named):
    causes = RoundingCauses(1.0, 1.0, ratios, 51.0)
    ratio = ratios[named == "base"]
    assert causes.words(("blend", "base")) == (
        f"weights of {named} that act together differ by a factor of {ratio:.2g}: "
        "even them out, or ask for a lower continuity"
    )
    # What is fifty times larger at the most is not told.
    assert not RoundingCauses(1.0, 50.0, ratios, 50.0).words(("blend", "base"))


@pytest.mark.parametrize(
    ("edge", "order", "expected"),
    # Of degree 1 two neighbours along the edge act together, and across as many rows as there are orders and one more.
    [
        ("u0", 0, 3),
        ("v0", 0, 8),
        ("u1", 0, 3),
        ("v1", 0, 8),
        ("u0", 1, 6),
        ("v0", 1, 24),
        ("u1", 1, 24),
        ("v1", 1, 40 / 3),
    ],
)
def test_weights_that_act_together(edge, order, expected):
    knots = [0, 0, 0.5, 1, 1]
    base = Base(square(1, knots, 1, knots, np.multiply.outer([1.0, 2, 16], [1.0, 3, 5])), edge)
    assert rounding_causes(base, base, order).weight_ratios == pytest.approx((expected, expected))
