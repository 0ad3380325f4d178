"""Rate and second rate of curvature: shapes that know theirs, changes of parameters, and laws."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from helpers.bases import moved, patch
from helpers.high_order import facing, hand_made
from helpers.sweeps import examples
from semispline import Base, BSplineSurface, OptionError, measure_contact
from semispline.solver.judge.curvature_rates import curvature_rates
from semispline.solver.judge.de_boor import edge_curves
from semispline.solver.splines.operations import reverse_u, reverse_v, split_u, swap_directions

K1, K2, K4 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1], [0, 0, 0, 0, 0, 1, 1, 1, 1, 1]
RATES = ("rate_jump", "second_rate_jump")
FIGURES = [name + end for name in RATES for end in ("", "_relative")]


def measured(at, order=4):
    """Curvature, rate and second rate; the normal that of growing parameters."""
    cross = np.cross(at[1, 0], at[0, 1])
    normal = cross / np.linalg.norm(cross, axis=1)[:, None]
    found = curvature_rates(at, normal, np.zeros((5, 5)), order)
    return np.array(found.values)


def rates(surface, edge, s):
    return measured(edge_curves(surface, edge, 4).points(np.atleast_1d(np.asarray(s, dtype=float)), 4))


def profile(*heights, bend=1.0, width=1.0, shear=0.0):
    """X = (bend u, width v + shear u, sum of heights[k] (bend u)^(k+1) / (k+1)!), u and v in [0, 1]."""
    monomials = np.zeros((5, 2, 3))
    monomials[1, :, 0] = bend
    monomials[1, :, 1] = shear
    monomials[0, :, 1] = 0, width
    factorial = 1.0
    for k, height in enumerate(heights, start=1):
        factorial *= k
        monomials[k, :, 2] = height * bend**k / factorial
    # Bernstein coefficients of u^k at i: C(i, k) / C(4, k).
    binomial = np.array([[1, 0, 0, 0, 0], [1, 1, 0, 0, 0], [1, 2, 1, 0, 0], [1, 3, 3, 1, 0], [1, 4, 6, 4, 1]])
    net = np.tensordot(binomial / np.array([1, 4, 6, 4, 1]), monomials, 1)
    return BSplineSurface(4, 1, K4, K1, net)


@pytest.mark.parametrize("shear", [0.0, 0.7])
def test_a_graph_has_the_rates_of_its_derivatives(shear):
    # f'' = k, f''' = r, f'''' = q where f' = 0: k, r, q - 3 k^3; the normal points down.
    surface = profile(0.0, 2.0, 3.0, -5.0, shear=shear)
    np.testing.assert_allclose(rates(surface, "u0", [0.1, 0.6]).T, [[3.0, -5.0 - 24.0]] * 2, rtol=1e-13)


@pytest.mark.parametrize("x", [0.3, 0.8, 1.1])
def test_the_curve_whose_curvature_begins_linear(x):
    # y = x^3 / 6: with w = 1 + x^4 / 4 the rate is (1 - 5/4 x^4) / w^3, the second rate (5/2 x^4 - 8) x^3 / w^(9/2).
    surface = profile(0.0, 0.0, 1.0, bend=1.5)
    before, after = split_u(surface, x / 1.5)
    w = 1 + x**4 / 4
    expected = (1 - 1.25 * x**4) / w**3, x**3 * (2.5 * x**4 - 8) / w**4.5
    np.testing.assert_allclose(rates(after, "u0", 0.4)[:, 0], expected, rtol=1e-11)
    np.testing.assert_allclose(rates(before, "u1", 0.4)[:, 0], expected, rtol=1e-11)


@pytest.mark.parametrize("angle", [0.3, 1.2, -0.8])
def test_a_section_oblique_to_the_rulings(angle):
    # z = k x^2 / 2 + r x^3 / 6 + q x^4 / 24 where x = s cos - w sin; across the line w = 0 at s = 0 it is f(-w sin).
    k, r, q = 0.7, -2.0, 4.0
    at = {(i, j): np.zeros((1, 3)) for i in range(5) for j in range(5 - i)}
    across, along = -np.sin(angle), np.cos(angle)
    at[1, 0][0, :2], at[0, 1][0, :2] = (across, along), (along, -across)
    for (i, j), vector in at.items():
        if i + j > 1:
            vector[0, 2] = (k, r, q)[i + j - 2] * across**i * along**j
    # The normal (0, 0, -1): the height counts downwards.
    expected = r * across**3, q * across**4 - 3 * k**3 * across**6
    np.testing.assert_allclose(measured(at)[:, 0], -np.array(expected), rtol=1e-13)


def quarter(radius):
    """A quarter circle from (radius, 0) to (0, radius), with weights."""
    return np.array([[radius, 0.0], [radius, radius], [0.0, radius]]), np.array([1.0, 2**-0.5, 1.0])


def torus(large, small):
    """Quarter of a tube by a quarter of the way round; u round the tube. A sphere where `large` is zero."""
    tube, w = quarter(small)
    ring, _ = quarter(1.0)
    net = [[[(large + x) * cx, (large + x) * cy, z] for cx, cy in ring] for x, z in tube]
    return BSplineSurface(2, 2, K2, K2, net, np.multiply.outer(w, w))


@pytest.mark.parametrize(("large", "edges"), [(5.0, ["u0", "u1"]), (0.0, ["u0", "v0", "v1"])])
def test_circles_have_none(large, edges):
    # Square to a parallel of a torus, and to any circle of a sphere about its centre or axis.
    for edge in edges:
        found = rates(torus(large, 2.0), edge, [0.05, 0.4, 0.7])
        np.testing.assert_allclose(found, 0, atol=1e-13)


@pytest.mark.parametrize("latitude", [0.2, 0.7])
def test_parallels_of_a_sphere(latitude):
    before, after = split_u(torus(0.0, 2.0), latitude)
    for surface, edge in ((before, "u1"), (after, "u0")):
        np.testing.assert_allclose(rates(surface, edge, [0.05, 0.9]), 0, atol=1e-12)


def test_an_ellipse():
    """Semi-axes p across and q up, at the top: curvature q / p^2, rate 0, second rate 3 q (p^2 - q^2) / p^6."""
    p, q = 3.0, 2.0
    points, w = quarter(1.0)
    # From the top (0, q) sideways to (p, 0).
    net = [[[p * y, z, q * x] for z in (0.0, 1.0)] for x, y in points]
    surface = BSplineSurface(2, 1, K2, K1, net, np.stack([w, w], axis=1))
    rate, second = rates(surface, "u0", 0.5)[:, 0]
    assert rate == pytest.approx(0, abs=1e-14)
    # The section bends down from the normal (0, 0, 1).
    assert second == pytest.approx(-3 * q * (p**2 - q**2) / p**6, rel=1e-12)


def times(f, g):
    product = {}
    for (i, j), x in f.items():
        for (k, m), y in g.items():
            if i + j + k + m <= 4:
                product[i + k, j + m] = product.get((i + k, j + m), 0.0) + x * y
    return product


FACTORIALS = (1.0, 1.0, 2.0, 6.0, 24.0)


@examples(60)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, -1.0]), st.sampled_from([1.0, -1.0]))
def test_a_change_of_parameters_that_keeps_the_edge_changes_nothing(seed, across, along):
    rng = np.random.default_rng(seed)
    keys = [(i, j) for i in range(5) for j in range(5 - i)]
    surface = {key: rng.uniform(-1, 1, 3) for key in keys}
    lengths = [np.linalg.norm(surface[key]) for key in ((1, 0), (0, 1))]
    assume(np.linalg.norm(np.cross(surface[1, 0], surface[0, 1])) > 0.3 * lengths[0] * lengths[1])
    assume(min(lengths) > 0.3)
    # x = w (..): the edge stays; y = s (..) + w (..): what runs across is skewed and bent, differently along the edge.
    x = {(i, j): float(rng.uniform(-1, 1)) for i, j in keys if i > 0}
    y = {(i, j): float(rng.uniform(-1, 1)) for i, j in keys if i + j > 0}
    x[1, 0], y[0, 1] = across * rng.uniform(0.5, 2), along * rng.uniform(0.5, 2)
    powers_x, powers_y = [{(0, 0): 1.0}], [{(0, 0): 1.0}]
    for _ in range(4):
        powers_x.append(times(powers_x[-1], x))
        powers_y.append(times(powers_y[-1], y))
    changed = {}
    for (i, j), vector in surface.items():
        for key, value in times(powers_x[i], powers_y[j]).items():
            changed[key] = changed.get(key, 0.0) + value * vector

    def derivatives(taylor):
        return {(i, j): (FACTORIALS[i] * FACTORIALS[j] * taylor.get((i, j), np.zeros(3)))[None] for i, j in keys}

    rate, second = measured(derivatives(surface))[:, 0]
    other_rate, other_second = measured(derivatives(changed))[:, 0]
    # The normal turns over with either parameter, the direction with the one across.
    scale = max(1.0, abs(rate), abs(second), abs(measured_curvature(derivatives(surface))) ** 3)
    assert other_rate == pytest.approx(along * rate, rel=1e-8, abs=1e-9 * scale)
    assert other_second == pytest.approx(across * along * second, rel=1e-8, abs=1e-9 * scale)


def measured_curvature(at):
    t = at[0, 1][0] / np.linalg.norm(at[0, 1][0])
    d = at[1, 0][0] - (at[1, 0][0] @ t) * t
    return np.linalg.norm(at[2, 0][0]) / (d @ d)


def faulty_pair(seed=4, order=4, edges=("u0", "v1")):
    """A hand-made blend whose third and fourth derivatives are off, and its base."""
    a, b, p_a, p_b = facing(np.random.default_rng(seed), order, edges)
    made = hand_made(a, b, order, p_a=p_a, p_b=p_b, faults={(3, 3): 1.2, (4, 2): 0.7})
    return a, Base(made, "u0")


def figures(contact):
    return {name: getattr(contact, name) for name in FIGURES}


TURNS = [(lambda s: s, "u0"), (reverse_u, "u1"), (reverse_v, "u0"), (swap_directions, "v0")]


@pytest.mark.parametrize(("turn", "edge"), TURNS)
@pytest.mark.parametrize("side", ["a", "b"])
def test_measures_do_not_depend_on_how_the_surfaces_run(turn, edge, side):
    a, blended = faulty_pair(edges=("u0", "u0"))
    plain = measure_contact(a, blended, flip="no", order=4)
    b = blended.surface.to_bspline() if side == "b" else a.surface
    one = Base(turn(b), edge)
    pair = (a, one) if side == "b" else (one, blended)
    found = measure_contact(*pair, flip="yes" if turn is reverse_v else "no", order=4)
    assert plain.rate_jump_relative > 1e-3
    assert figures(found) == pytest.approx(figures(plain), rel=1e-6)


def test_the_order_of_the_sides_does_not_matter():
    a, b = faulty_pair()
    plain, swapped = (measure_contact(*pair, flip="no", order=4) for pair in ((a, b), (b, a)))
    assert figures(swapped) == pytest.approx(figures(plain), rel=1e-9)
    assert swapped.rounding == pytest.approx(plain.rounding, rel=1e-9)


@pytest.mark.parametrize("factor", [2.0**-20, 2.0**20])
def test_rates_have_units_and_relative_jumps_have_none(factor):
    a, b = faulty_pair(edges=("u0", "u0"))
    b = Base(b.surface.to_bspline(), "u0")
    plain = figures(measure_contact(a, b, flip="no", order=4))
    scaled = measure_contact(*(Base(moved(x.surface, scale=factor), x.edge) for x in (a, b)), flip="no", order=4)
    units = {"rate_jump": factor**-2, "second_rate_jump": factor**-3}
    expected = {name: value * units.get(name, 1.0) for name, value in plain.items()}
    assert figures(scaled) == pytest.approx(expected, rel=1e-9)
    # Of the parameters: across and along the edge.
    slower = []
    for s, k in ((a.surface, factor), (b.surface, 1.0)):
        slower.append(BSplineSurface(s.degree_u, s.degree_v, s.knots_u * k, s.knots_v * factor, s.control_points))
    found = measure_contact(*(Base(surface, "u0") for surface in slower), flip="no", order=4)
    assert figures(found) == pytest.approx(plain, rel=1e-9)


def test_moved_far_away_the_measures_are_those_of_the_surfaces():
    # Coordinates of whole 2^-20, moved by 2^30: still exact.
    def rounded(surface):
        net = np.round(surface.control_points * 2.0**20) / 2.0**20
        return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, net)

    a, b = (rounded(part) for part in split_u(patch(np.random.default_rng(2), degrees=(5, 4), counts=(7, 6)), 0.4))
    offset = np.array([2.0**30, -(2.0**30), 2.0**29])
    near, far = (
        measure_contact(*(Base(moved(s, offset=by), e) for s, e in ((a, "u1"), (b, "u0"))), flip="no", order=4)
        for by in (np.zeros(3), offset)
    )
    assert near.rate_jump > 1e-6
    assert figures(far) == pytest.approx(figures(near), rel=1e-6)
    np.testing.assert_allclose(far.rate_at.point, np.array(near.rate_at.point) + offset, rtol=1e-15)


def test_jumps_of_profiles_and_where_they_are():
    # Opposite bends of the same sign of u: continued, b has k, -r', q'.
    a, b = profile(0.0, 2.0, 3.0, -5.0, bend=-1.0), profile(0.0, 2.0, 3.5, -4.0)
    contact = measure_contact(Base(a, "u0"), Base(b, "u0"), order=4)
    assert contact.curvature_jump == pytest.approx(0, abs=1e-13)
    assert contact.rate_jump == pytest.approx(0.5, rel=1e-12)
    # The largest rate is 3.5, the square of the curvature 4; of the second rates 29 and 28, the cube 8.
    assert contact.rate_jump_relative == pytest.approx(0.5 / 4, rel=1e-12)
    assert contact.second_rate_jump == pytest.approx(1.0, rel=1e-11)
    assert contact.second_rate_jump_relative == pytest.approx(1 / 29, rel=1e-11)
    assert contact.rate_at.point[0] == contact.second_rate_at.point[0] == 0


def test_only_as_far_as_asked():
    a, b = profile(0.0, 2.0, 3.0, bend=-1.0), profile(0.0, 2.0, 3.0)
    pair = Base(a, "u0"), Base(b, "u0")
    plain, third, fourth = (measure_contact(*pair, order=order) for order in (2, 3, 4))
    assert plain.rate_jump is plain.rate_jump_relative is plain.rate_at is plain.second_rate_jump is None
    assert third.rate_jump == pytest.approx(fourth.rate_jump, abs=1e-12)
    assert third.second_rate_jump is third.second_rate_at is None
    assert set(third.allowed) - set(plain.allowed) == {"rate_jump_relative"}
    assert set(fourth.allowed) - set(third.allowed) == {"second_rate_jump_relative"}
    assert measure_contact(*pair) == plain


@pytest.mark.parametrize("order", [1, 5, "3", 3.0, None, True])
def test_orders_that_are_not_measured(order):
    a = Base(profile(0.0, 1.0), "u0")
    with pytest.raises(OptionError, match="order: found"):
        measure_contact(a, a, order=order)


def test_where_there_is_no_normal_there_is_no_rate():
    cone = BSplineSurface(1, 1, K1, K1, [[[0, 0, 1], [0, 0, 1]], [[1, 0, 0], [0, 1, 0]]])
    contact = measure_contact(Base(cone, "u0"), Base(profile(0.0, 1.0), "u0"), order=4)
    assert np.isnan([contact.rate_jump, contact.rate_jump_relative, contact.second_rate_jump_relative]).all()
