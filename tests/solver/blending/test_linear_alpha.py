"""alpha linear in v: exact rows, contact by the referee, gradients, and a search that finds what the gap asks for."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sympy import Matrix

from helpers.facing import random_facing
from helpers.impeller import impeller_pair
from helpers.sweeps import examples
from semispline import (
    Base,
    BSplineCurve,
    OptionError,
    SemiStructuredSurface,
    blend,
    map_domain,
    measure_contact,
    measure_fairness,
    measure_turn,
    plane,
    revolve_polynomial,
    transform,
)
from semispline.derivations.linear_alpha import linear_product
from semispline.solver.blending import linear_alpha
from semispline.solver.blending.fair_objective import FairObjective, make_unknowns
from semispline.solver.blending.fair_search import solve_fair
from semispline.solver.blending.fairness_grid import NODES_U, across, along
from semispline.solver.blending.fairness_table import FairnessTable
from semispline.solver.blending.linear_alpha import linear_rows, monomials_of_ends, raised_basis
from semispline.solver.blending.linear_problem import (
    gap_ratio,
    try_linear_alpha,
    with_linear_alpha,
)
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.judge.de_boor import curve_points
from semispline.solver.judge.limits import shortfalls
from semispline.solver.splines import Basis, basis_matrix, clamped, linear_product_matrices

QUINTIC = {"degree_u": 5, "middle_curves": 0, "alpha": "fair"}


def finished(stated, problem, a, b, p2=None):
    """The surface of a problem for given shape parameters."""
    centre, size = stated.frame
    pieces = np.split(problem.control_points(a, b, p2) * size + centre, problem.form.offsets[1:-1])
    pieces[0], pieces[-1] = stated.sides[0].rows[0], stated.sides[1].rows[0]
    rows = tuple(BSplineCurve(row.degree, row.knots, x) for row, x in zip(problem.rows, pieces, strict=True))
    return SemiStructuredSurface(problem.form.u.degree, problem.form.u.knots, rows)


def contacts(surface, pair, order=2):
    edges = (Base(surface, "u0"), pair[0]), (Base(surface, "u1"), pair[1])
    return [measure_contact(*both, flip="no", order=order) for both in edges]


@st.composite
def splines(draw):
    degree = draw(st.integers(1, 4))
    inner = draw(st.lists(st.sampled_from([Fraction(k, 7) for k in range(1, 7)]), max_size=2, unique=True))
    knots = [x for x in sorted(inner) for _ in range(draw(st.integers(1, degree)))]
    knots = [Fraction(0)] * (degree + 1) + knots + [Fraction(1)] * (degree + 1)
    points = [Fraction(draw(st.integers(-9, 9)), 4) for _ in range(len(knots) - degree - 1)]
    return degree, knots, points


@examples(12)
@given(splines(), st.integers(-3, 3), st.integers(-3, 3))
def test_products_are_the_derived_ones(spline, low, high):
    degree, knots, points = spline
    falling, rising, raised = linear_product_matrices(degree, np.array(knots, dtype=float))
    found = low * (falling @ np.array(points, dtype=float)) + high * (rising @ np.array(points, dtype=float))
    known = linear_product(degree, knots, low, high) * Matrix(points)
    np.testing.assert_allclose(found, np.array(known, dtype=float).ravel(), atol=1e-13)
    # And the product at points, by the referee.
    x = np.linspace(0, 1, 23)
    value = curve_points(degree, np.array(knots, dtype=float), np.array(points, dtype=float)[:, None], x)
    product = curve_points(degree + 1, raised, found[:, None], x)
    np.testing.assert_allclose(product, value * (low + (high - low) * x)[:, None], atol=1e-12)


def test_rows_of_ends_are_rows_of_their_product():
    rng = np.random.default_rng(0)
    basis = Basis(3, clamped([0.3, 0.6, 0.6], 3, 0.0, 2.0))
    exponents = np.array([[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [3, 0.0]])
    monomials = rng.normal(size=(6, 4, basis.size, 3))
    # As the chain rule has it, row r holds nothing of a higher weight.
    for m, (i, j) in enumerate(exponents):
        monomials[m, : int(i + 2 * j)] = 0
    a, p2 = (0.7, 1.9), -0.4
    powers, rows = monomials_of_ends(exponents, monomials, basis)
    assert powers[0].tolist() == [0, 0, 0]
    factors = [a[0] ** i0 * a[1] ** i1 * p2**j for i0, i1, j in powers]
    given_rows = linear_rows(exponents, monomials, basis, a, p2)
    v = np.linspace(0, 2, 31)
    s = v / 2
    value = a[0] * (1 - s) + a[1] * s
    for r in range(4):
        raised = raised_basis(basis, r)
        assert raised.degree == 3 + r
        values = basis_matrix(raised.degree, raised.knots, v)
        found = sum(factor * (values @ row[r]) for factor, row in zip(factors, rows, strict=True))
        np.testing.assert_allclose(values @ given_rows[r], found, atol=1e-12)
        known = sum(
            (value**i * p2**j)[:, None] * (basis_matrix(3, basis.knots, v) @ monomials[m, r])
            for m, (i, j) in enumerate(exponents)
        )
        np.testing.assert_allclose(found, known, atol=1e-12)


@pytest.mark.parametrize("sides", ["both", "a alone"])
@pytest.mark.parametrize(("order", "degree"), [(1, 3), (2, 5), (3, 7), (4, 9)])
@pytest.mark.parametrize("seed", range(3))
def test_contact_is_exact_with_any_ends(seed, order, degree, sides):
    options = QUINTIC | {"continuity": f"G{order}", "degree_u": degree}
    pair = random_facing(np.random.default_rng([21, seed]), most_angle=50)
    stated = state_problem(*pair, **options, flip="no")
    (unit_a, unit_b), p2 = stated.problem.natural, (0.3, -0.2) if order == 2 else (0.0, 0.0)
    a, b = (0.6 * unit_a, 1.4 * unit_a), (1.2 * unit_b, 0.5 * unit_b)
    given = tuple(tuple(np.sqrt(ends)) for ends in (a, b)) if sides == "both" else (tuple(np.sqrt(a)), "fair")
    problem = state_problem(*pair, **(options | {"alpha": given}), flip="no").problem
    assert problem.free == ((False, False) if sides == "both" else (False, True))
    second = (p2[0] * unit_a, p2[1] * unit_b)
    surface = finished(stated, problem, a, b if sides == "both" else unit_b, second)
    for contact in contacts(surface, pair, max(2, order)):
        assert not shortfalls(contact, f"G{order}")
        assert contact.gap < 1e-13 * contact.size
        assert contact.angle_degrees < 1e-9
        assert order < 2 or contact.curvature_jump_relative < 1e-9


def test_a_row_that_stays_too_low_is_seen(monkeypatch):
    pair = random_facing(np.random.default_rng([21, 0]), most_angle=50)
    stated = state_problem(*pair, **QUINTIC, flip="no")
    unit_a, unit_b = stated.problem.natural
    ends = (0.6 * unit_a, 1.4 * unit_a), (1.2 * unit_b, 0.5 * unit_b)
    linear = with_linear_alpha(stated.problem)
    times = linear_alpha._times

    def too_low(points, basis, linear, degrees):
        # The square as if it were linear between its ends.
        if len(linear) == 2:
            (low, high), (low_2, high_2) = linear
            linear = [(low * low_2, high * high_2)]
        return times(points, basis, linear, degrees)

    right = finished(stated, linear, *ends, (0.0, 0.0))
    monkeypatch.setattr(linear_alpha, "_times", too_low)
    wrong = finished(stated, linear, *ends, (0.0, 0.0))
    assert contacts(right, pair)[0].curvature_jump_relative < 1e-10
    assert contacts(wrong, pair)[0].curvature_jump_relative > 1e-3
    assert contacts(wrong, pair)[0].angle_degrees < 1e-9


def test_equal_ends_are_the_constant():
    pair = random_facing(np.random.default_rng([21, 1]), most_angle=50)
    stated = state_problem(*pair, **QUINTIC)
    unit_a, unit_b = stated.problem.natural
    linear = with_linear_alpha(stated.problem)
    u, v = np.linspace(0, 1, 9), np.linspace(*pair[0].surface.domain[1], 9)
    one = finished(stated, stated.problem, unit_a, unit_b, (0.0, 0.0))
    other = finished(stated, linear, (unit_a, unit_a), (unit_b, unit_b), (0.0, 0.0))
    np.testing.assert_allclose(one.evaluate_grid(u, v), other.evaluate_grid(u, v), atol=1e-12)


@pytest.mark.parametrize("options", [{}, {"continuity": "G3", "degree_u": 7}, {"continuity": ("G2", "G1")}])
def test_the_gradient_is_that_of_the_value(options):
    pair = random_facing(np.random.default_rng([21, 2]), most_angle=50, most_yaw=40)
    problem = with_linear_alpha(state_problem(*pair, **(QUINTIC | options)).problem)
    layers, exponents = problem.shape_layers()
    unknowns = make_unknowns(problem, exponents)
    table = FairnessTable(problem, layers, across(problem.form.u, NODES_U), along(problem.rows), least_cosine=-2.0)
    objective = FairObjective(unknowns, table)
    y = unknowns.wanted + np.where(unknowns.logarithmic, [0.1, -0.2, 0.0, 0.2, -0.1, 0.0], 0.3)
    y = np.clip(y, unknowns.low, unknowns.high)
    _, gradient = objective(y)
    for k in np.flatnonzero(unknowns.low < unknowns.high):
        steps = [(h, np.eye(len(y))[k] * h) for h in (1e-3, 5e-4)]
        coarse, fine = ((objective(y + s)[0] - objective(y - s)[0]) / (2 * h) for h, s in steps)
        assert gradient[k] == pytest.approx((4 * fine - coarse) / 3, rel=1e-5, abs=1e-6)


@pytest.mark.long
def test_the_impeller_turns_a_third_as_much():
    pair = impeller_pair()
    stated = state_problem(*pair, **QUINTIC)
    constant = solve_fair(stated.problem)
    assert gap_ratio(stated.problem) == pytest.approx(6.5, abs=0.1)
    trial = try_linear_alpha(stated.problem, constant)
    assert trial.taken
    assert trial.solution.value < 0.11 * constant.value
    assert trial.solution.value < 90
    assert trial.solution.slope < 1e-4
    # No end at its bound.
    for ends, values in zip(trial.problem.linear, (trial.solution.a, trial.solution.b), strict=True):
        for value, (low, high) in zip(values, ends.bounds, strict=True):
            assert 1.01 * low < value < high / 1.01
    one = finished(stated, stated.problem, constant.a, constant.b, constant.p2)
    other = finished(stated, trial.problem, trial.solution.a, trial.solution.b, trial.solution.p2)
    assert measure_turn(other).degrees < 6
    assert measure_turn(one).degrees > 10
    assert measure_fairness(other).value == pytest.approx(trial.solution.value, rel=0.01)
    for contact in contacts(other, pair):
        assert contact.curvature_jump_relative < 1e-10
    # Half as many control points again; 2.3 times as many in an ordinary B-spline of quintic rows.
    assert (one.n_control_points, other.n_control_points) == (78, 138)


def test_an_even_gap_needs_no_linear_alpha():
    pair = random_facing(np.random.default_rng([21, 4]), most_angle=20)
    problem = state_problem(*pair, **QUINTIC).problem
    constant = solve_fair(problem)
    assert gap_ratio(problem) < 1.5
    trial = try_linear_alpha(problem, constant)
    assert not trial.taken
    assert trial.problem is None
    assert "not tried" in trial.verdict
    asked = try_linear_alpha(problem, constant, always=True)
    assert asked.taken
    assert asked.solution.value <= constant.value * (1 + 1e-9)


def test_the_gap_is_measured_up_to_the_end_of_any_range():
    # 0.12 + (1.602 - 0.12) is rounded to above 1.602.
    start, end = 0.12, 1.602
    assert start + (end - start) > end
    pair = tuple(
        Base(map_domain(plane([x, 0, 0], [2, 0, 0], [0, 3, 0]), v_range=(start, end)), edge)
        for x, edge in ((0, "u1"), (4, "u0"))
    )
    # The edges are parallel, and so are the ways across.
    assert gap_ratio(state_problem(*pair, **QUINTIC).problem) == pytest.approx(1, abs=1e-12)


@pytest.mark.long
def test_it_is_taken_where_it_pays():
    taken, shares = [], []
    for k in range(12):
        pair = random_facing(np.random.default_rng([23, k]), most_angle=50, most_yaw=50)
        problem = state_problem(*pair, **QUINTIC).problem
        constant = solve_fair(problem)
        trial = try_linear_alpha(problem, constant)
        if trial.solution is not None:
            assert trial.solution.value <= constant.value * 1.0001
            assert gap_ratio(problem) >= 1.5
            shares.append(trial.solution.value / constant.value)
            taken.append(trial.taken)
    # By 30 %, no less.
    assert taken == [share <= 0.7 for share in shares]
    assert any(taken)
    assert not all(taken)


def pipes():
    """Two coaxial pipes of one radius."""
    line = BSplineCurve(3, [0] * 4 + [1] * 4, [[5, 0, z] for z in (0, 1, 2, 3)])
    pipe = revolve_polynomial(line, [0, 0, 0], [0, 0, 1], 360, 1e-6).surface
    far = transform(pipe, np.eye(3), [0, 0, 13])
    edges = [(Base(pipe, edge), Base(far, other)) for edge, other in (("u1", "u0"), ("v1", "v0"))]
    return next(pair for pair in edges if np.ptp(pair[0].derivative(np.array([0.1, 0.6]), 0, 0)[:, 2]) < 1e-9)


def test_closed_contacts_keep_a_constant():
    problem = state_problem(*pipes(), **QUINTIC).problem
    assert gap_ratio(problem) == 1.0
    trial = try_linear_alpha(problem, solve_fair(problem), always=True)
    assert not trial.taken
    assert "closed" in trial.verdict


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"alpha_v": "linear"}, "alpha_v: found linear on closed contacts, expected auto or constant"),
        ({"alpha": ((1.0, 2.0), 1.0)}, "alpha: found two values for the ends of v on closed contacts"),
    ],
)
def test_what_closed_contacts_cannot_have_is_refused(options, message):
    with pytest.raises(OptionError, match=message):
        blend(*pipes(), **options)


def widening(seed=2):
    """Two bases whose gap grows along the contact."""
    return random_facing(np.random.default_rng([23, seed]), most_angle=50, most_yaw=50)


def test_a_blend_states_what_it_took_and_why():
    linear = blend(*widening(), alpha_v="linear")
    assert linear.options.alpha_v == "linear"
    assert [candidate.alpha_v for candidate in linear.candidates] == ["constant", "linear"]
    assert linear.candidates[1].verdict == "chosen"
    assert "is more" in linear.candidates[0].verdict
    for values, (low, high) in (
        (linear.alpha2, linear.alpha2_bounds),
        (linear.beta2, linear.beta2_bounds),
    ):
        assert all(a < x < b for a, x, b in zip(low, values, high, strict=True))
    constant = blend(*widening(), alpha_v="constant")
    assert all(candidate.alpha_v == "constant" for candidate in constant.candidates)
    assert constant.objective.value > linear.objective.value
    assert constant.rows_stored < linear.rows_stored
    assert constant.rows_converted < linear.rows_converted
    assert [row.degree for row in linear.surface.control_curves] == [3, 4, 5, 5, 4, 3]
    u, v = np.linspace(0, 1, 9), np.linspace(*linear.surface.domain[1], 9)
    ordinary = linear.surface.to_bspline()
    np.testing.assert_allclose(ordinary.evaluate_grid(u, v), linear.surface.evaluate_grid(u, v), atol=1e-12)


def test_given_ends_are_taken_as_they_are():
    found = blend(*widening(), alpha=((0.8, 1.2), 0.9))
    assert found.alpha2 == pytest.approx((0.64, 1.44))
    assert found.beta2 == pytest.approx(0.81)
    assert found.alpha2_bounds is None
    assert found.method == "linear"
    assert found.p2 == (0.0, 0.0)
    # A bulge multiplies both ends.
    assert blend(*widening(), alpha=((0.8, 1.2), 0.9), bulge=(1.5, 1)).alpha2 == pytest.approx((0.96, 2.16))


def test_an_end_at_its_bound_is_named():
    found = blend(*widening(), alpha_v="linear", box=(2.0, 2.2))
    assert set(found.active_bounds) <= {
        f"{name}[{k}] {end}" for name in ("alpha2", "beta2") for k in (0, 1) for end in ("lower", "upper")
    }
    assert found.active_bounds
    # Each end in the box as it is, around a shape of its own.
    assert all(high / low == pytest.approx(1.1) for low, high in zip(*found.alpha2_bounds, strict=True))
    assert any("at its" in text for text in found.warnings)


def test_units_and_order_do_not_matter():
    pair = widening()

    def found(bases):
        problem = state_problem(*bases, **QUINTIC).problem
        return try_linear_alpha(problem, solve_fair(problem), always=True).solution

    first = found(pair)
    scaled = found([Base(transform(base.surface, 1e3 * np.eye(3)), base.edge) for base in pair])
    assert scaled.a == pytest.approx(first.a, rel=1e-5)
    swapped = found(pair[::-1])
    assert swapped.a == pytest.approx(first.b, rel=1e-5)
    assert swapped.b == pytest.approx(first.a, rel=1e-5)
    assert swapped.value == pytest.approx(first.value, rel=1e-7)


@pytest.mark.parametrize("ends", [(0.0, 1.0), (1.0, 0.0)])
def test_p2_that_is_zero_at_one_end_counts(ends):
    along = Basis(2, clamped([0.5], 2, 0, 1))
    monomials = np.random.default_rng(4).normal(size=(2, 3, along.size, 3))
    # The first row never has it.
    monomials[1, 0] = 0
    exponents = np.array([[0, 0], [0, 1]])
    found, near = (
        linear_rows(exponents, monomials, along, 1.0, tuple(max(end, least) for end in ends)) for least in (0, 1e-12)
    )
    assert all(one == pytest.approx(other, abs=1e-9) for one, other in zip(found, near, strict=True))
