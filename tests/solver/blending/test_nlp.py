"""The constrained problem: its derivatives against SymPy's, a Taylor test, and its solution against a plain search."""

from dataclasses import replace
from fractions import Fraction

import casadi as ca
import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from helpers.bases import FACING, facing_pair, moved, patch, tube
from helpers.papers_set import blend, make_problem, state_problem
from helpers.sweeps import first_ones
from semispline import Base, BSplineSurface, ComputationError
from semispline.derivations.energy import Basis as ExactBasis
from semispline.derivations.energy import ExactSurface
from semispline.derivations.problem import ExactBase, blend_problem, derivatives_at, lagrangian
from semispline.solver.blending import nlp
from semispline.solver.blending.nlp import constrained_problem, solve_constrained, sparse_rank
from semispline.solver.blending.sides import make_side, matched_sides
from semispline.solver.judge.correspondence import Correspondence

K2 = (0, 0, 0, 1, 1, 1)
K2_INNER = (0, 0, 0, 0.25, 1, 1, 1)


def small_pair():
    """Two biquadratic bases with dyadic coordinates, so that floats hold them exactly."""
    rng = np.random.default_rng(0)

    def base(knots_u, knots_v, x0, step):
        n_u, n_v = len(knots_u) - 3, len(knots_v) - 3
        net = np.array([[[x0 + step * i, j, 0] for j in range(n_v)] for i in range(n_u)], dtype=float)
        net += rng.integers(-8, 8, net.shape) / 32
        return BSplineSurface(2, 2, knots_u, knots_v, net)

    return base(K2_INNER, K2, 0, 0.5), base(K2, K2_INNER, -2, -0.5)


def small_problem(middle_curves):
    a, b = small_pair()
    sides = make_side(Base(a, "u0"), "G2"), make_side(Base(b, "u0"), "G2")
    return make_problem(*sides, middle_curves=middle_curves)


def exact_basis(basis):
    # u-knots such as 1/3 are no binary fractions: the exact problem takes the floats that the solver has.
    return ExactBasis(basis.degree, tuple(map(Fraction, basis.knots)))


def both_problems():
    """The same G2 problem, ours in floats and the derivation's in exact rationals."""
    a, b = small_pair()
    problem = small_problem(0)
    surface = ExactSurface(exact_basis(problem.form.u), tuple(exact_basis(row) for row in problem.form.rows))
    bases = [
        ExactBase(
            ExactBasis(2, tuple(map(Fraction, s.knots_u))),
            tuple(tuple(map(tuple, row)) for row in s.control_points.tolist()),
        )
        for s in (a, b)
    ]
    return problem, blend_problem(2, surface, *bases)


@pytest.fixture(scope="module")
def compared():
    """Value, gradient and Hessian of the Lagrangian from CasADi and from SymPy, at one random point."""
    problem, exact = both_problems()
    nlp = constrained_problem(problem)
    rng = np.random.default_rng(1)
    n = problem.form.offsets[-1]
    points = rng.integers(-64, 64, (n, 3)) / 32
    shape = np.array([1.25, 0.75])
    multipliers = rng.integers(-64, 64, nlp.g.shape[0]) / 32

    # Ours: x of all points, then y, then z, then alpha and beta in units of their natural size.
    unit = np.sqrt(problem.natural)
    x = np.concatenate([points.T.ravel(), shape / unit])
    symbol = ca.MX.sym("l", len(multipliers))
    lagrange = nlp.f * nlp.f_scale + ca.dot(symbol, nlp.g)
    function = ca.Function("L", [nlp.x, symbol], [lagrange, ca.gradient(lagrange, nlp.x)])

    # Theirs: x, y, z of each point in turn; constraints likewise. Rows of ours are blocks of x, y, z.
    sizes = [problem.form.rows[i].size for i in (0, 1, 2, -1, -2, -3)]
    ours = np.split(multipliers, np.cumsum([3 * size for size in sizes])[:-1])
    theirs = np.concatenate([block.reshape(3, -1).T.ravel() for block in ours])
    value, exact_gradient, exact_hessian = derivatives_at(
        lagrangian(exact, [float(t) for t in theirs]), [*points.ravel().tolist(), *shape.tolist()]
    )
    to_ours = np.concatenate([np.arange(3 * n).reshape(n, 3).T.ravel(), [3 * n, 3 * n + 1]])
    scale = np.concatenate([np.ones(3 * n), unit])
    expected_gradient = np.array(exact_gradient, dtype=float)[to_ours] * scale
    expected_hessian = np.array(exact_hessian, dtype=float)[np.ix_(to_ours, to_ours)] * np.outer(scale, scale)
    found = [np.asarray(part) for part in function(x, multipliers)]
    upper = np.asarray(nlp.hessian(x, [], nlp.f_scale, multipliers))
    found.append(upper + np.triu(upper, 1).T)
    return found, (float(value), expected_gradient, expected_hessian)


def test_lagrangian_agrees_with_sympy(compared):
    found, expected = compared
    assert float(found[0][0, 0]) == pytest.approx(expected[0], rel=1e-13)


def test_gradient_agrees_with_sympy(compared):
    found, expected = compared
    np.testing.assert_allclose(found[1].ravel(), expected[1], rtol=0, atol=1e-12 * np.abs(expected[1]).max())


@pytest.mark.long
def test_hessian_agrees_with_sympy(compared):
    found, expected = compared
    np.testing.assert_allclose(found[2], expected[2], rtol=0, atol=1e-12 * np.abs(expected[2]).max())
    # The curvature in alpha and beta is there, so that this is no test of the quadratic part alone.
    assert np.abs(expected[2][-2:, -2:]).max() > 1


def test_hessian_is_that_of_the_lagrangian():
    # By CasADi's own differentiation of the whole expression, with a middle curve.
    nlp = constrained_problem(small_problem(1))
    rng = np.random.default_rng(3)
    weight, symbol = ca.MX.sym("w"), ca.MX.sym("l", nlp.g.shape[0])
    plain = ca.hessian(weight * nlp.f + ca.dot(symbol, nlp.g), nlp.x)[0]
    x, multipliers = rng.standard_normal(nlp.x.shape[0]), rng.standard_normal(nlp.g.shape[0])
    expected = np.asarray(ca.Function("H", [nlp.x, weight, symbol], [plain])(x, 0.7, multipliers))
    found = np.asarray(nlp.hessian(x, [], 0.7, multipliers))
    np.testing.assert_allclose(found, np.triu(expected), rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("which", ["f", "g"])
def test_taylor(which):
    nlp = constrained_problem(small_problem(1))
    rng = np.random.default_rng(2)
    weights = rng.standard_normal(nlp.g.shape[0])
    scalar = nlp.f if which == "f" else ca.dot(ca.DM(weights), nlp.g)
    hessian, gradient = ca.hessian(scalar, nlp.x)
    function = ca.Function("F", [nlp.x], [scalar, gradient, hessian])
    x = nlp.start + 0.1 * rng.standard_normal(len(nlp.start))
    d = rng.standard_normal(len(x))
    f0, g0, h0 = (np.asarray(part) for part in function(x))
    steps = 0.5 ** np.arange(3, 9)
    first, second = [], []
    for h in steps:
        change = float(function(x + h * d)[0]) - float(f0[0, 0]) - h * float(d @ g0.ravel())
        first.append(abs(change))
        second.append(abs(change - h * h / 2 * float(d @ h0 @ d)))
    # Remainders shrink by 4 and by 8 when the step is halved; f is quadratic, so there the second is rounding.
    assert np.log2(np.array(first[:-1]) / first[1:]) == pytest.approx(2, abs=0.15)
    if which == "g":
        assert np.log2(np.array(second[:-1]) / second[1:]) == pytest.approx(3, abs=0.2)
    else:
        assert max(second) < 1e-9 * abs(float(f0[0, 0]))


def test_constraints_have_full_rank():
    nlp = constrained_problem(small_problem(1))
    jacobian = np.asarray(ca.Function("J", [nlp.x], [ca.jacobian(nlp.g, nlp.x)])(nlp.start))
    assert np.linalg.matrix_rank(jacobian) == jacobian.shape[0]
    a, b = small_pair()
    assert blend(Base(a, "u0"), Base(b, "u0"), method="casadi").constraint_rank == (len(jacobian), len(jacobian))


def test_a_redundant_constraint_would_be_seen():
    nlp = constrained_problem(small_problem(1))
    jacobian = ca.Function("J", [nlp.x], [ca.jacobian(nlp.g, nlp.x)])(nlp.start).sparse()
    doubled = sp.vstack([jacobian, jacobian[[0]]], format="csr")
    assert sparse_rank(jacobian) == jacobian.shape[0]
    assert sparse_rank(doubled) == jacobian.shape[0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_below_rounding_of_its_row_makes_no_rank(sign):
    for noise, rank in ((1e-16, 1), (4e-16, 2)):
        assert sparse_rank(sp.csr_array([[sign, sign * noise], [sign, 0.0]])) == rank


@given(st.integers(0, 10**6), st.integers(1, 12), st.integers(1, 12), st.sampled_from([0.1, 0.3, 0.8]))
def test_sparse_rank_is_the_dense_one(seed, rows, columns, density):
    # Small whole numbers: the dense rank is beyond doubt, and dependent rows are common.
    rng = np.random.default_rng(seed)
    matrix = rng.integers(-2, 3, (rows, columns)) * (rng.random((rows, columns)) < density)
    assert sparse_rank(sp.csr_array(matrix.astype(float))) == np.linalg.matrix_rank(matrix)


def test_the_objective_is_scaled():
    # By the energy of the start; where that falls to a small part, the search goes on with the new scale.
    nlp = constrained_problem(small_problem(1))
    objective = ca.Function("f", [nlp.x], [nlp.f])
    assert float(objective(nlp.start)) == pytest.approx(1, rel=1e-12)
    again = constrained_problem(small_problem(1), 0.01 * nlp.f_scale)
    assert again.f_scale == pytest.approx(0.01 * nlp.f_scale, rel=1e-12)


def test_what_ipopt_did_not_solve_is_an_error(monkeypatch):
    monkeypatch.setattr("semispline.solver.blending.nlp.KKT_LIMIT", 1e-30)
    with pytest.raises(ComputationError, match=r"IPOPT ended with .* KKT residual .* try"):
        solve_constrained(small_problem(0))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("name", "said"), [("lam_x", r"KKT residual 1\.0e-03"), ("g", r"constraints missed by 1\.0e-03")]
)
def test_what_is_off_in_one_place_counts_with_either_sign(monkeypatch, name, said, sign):
    def slightly_off(*words, **start):
        result, stats = optimum(*words, **start)
        # A multiplier of the bounds that a control point does not have; a condition that is not met.
        wrong = np.asarray(result[name]).ravel().copy()
        wrong[0] += sign * 1e-3
        return {**result, name: ca.DM(wrong)}, stats

    optimum = nlp._optimum
    solve_constrained(small_problem(0))
    monkeypatch.setattr(nlp, "_optimum", slightly_off)
    with pytest.raises(ComputationError, match=said):
        solve_constrained(small_problem(0))


@pytest.mark.parametrize("times", [0.5, 2.0])
def test_a_multiplier_of_a_bound_that_is_not_met_counts(monkeypatch, times):
    # Least energy for shape parameters off the best: stationary but for them, where multipliers pretend a bound.
    problem = small_problem(0)
    best = solve_constrained(problem)
    stated = constrained_problem(problem)
    points = problem.control_points(times * best.a, times * best.b)
    shape = np.sqrt(times * np.array([best.a, best.b]) / problem.natural)
    x = np.concatenate([points.T.ravel(), shape])
    slope, jacobian = (
        np.asarray(ca.Function("f", [stated.x], [of])(x).full())
        for of in (ca.gradient(stated.f, stated.x), ca.jacobian(stated.g, stated.x))
    )
    lam_g = np.linalg.lstsq(jacobian[:, :-2].T, -slope[:-2], rcond=None)[0]
    lam_x = np.zeros((len(x), 1))
    lam_x[-2:] = -(slope + jacobian.T @ lam_g)[-2:]
    assert (lam_x[-2:] > 0).all() == (times < 1)
    assert (lam_x[-2:] < 0).all() == (times > 1)
    result = {
        "x": ca.DM(x),
        "f": 1.0,
        "g": ca.DM.zeros(stated.g.shape[0]),
        "lam_g": ca.DM(lam_g),
        "lam_x": ca.DM(lam_x),
    }
    monkeypatch.setattr(nlp, "_optimum", lambda *_, **__: (result, {"iter_count": 1, "return_status": "Made_Up"}))
    with pytest.raises(ComputationError, match="IPOPT ended with Made_Up after 1 steps, KKT residual") as error:
        solve_constrained(problem)
    assert "constraints missed by 0.0e+00" in str(error.value)


@pytest.mark.parametrize(("low", "high", "start"), [(0.25, 4.0, 1.0), (1.44, 4.0, 1.2), (0.25, 0.81, 0.9)])
def test_the_search_starts_at_the_natural_size_or_the_nearest_bound(low, high, start):
    problem = small_problem(0)
    bounds = tuple((n * low, n * high) for n in problem.natural)
    stated = constrained_problem(replace(problem, bounds=bounds))
    assert stated.start[-2:] == pytest.approx([start] * 2, rel=1e-12)
    assert stated.lower[-2:] == pytest.approx([np.sqrt(low)] * 2, rel=1e-12)
    assert stated.upper[-2:] == pytest.approx([np.sqrt(high)] * 2, rel=1e-12)
    assert np.isinf([*stated.lower[:-2], *stated.upper[:-2]]).all()


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_closed_rows_have_a_condition_for_each_derivative_at_the_seam(degree):
    rng = np.random.default_rng(degree)
    pair = tube(rng, 6, degree=degree), tube(rng, 7, degree=degree, heights=(4.0, 3.0), phase=0.7)
    bases = [Base(s, "u1") for s in pair]
    for continuity, prescribed in (("C0", 1), ("G1", 2)):
        problem = state_problem(*bases, continuity=continuity, middle_curves=1).problem
        orders = [problem.seam_order_of(i) for i in problem.free_rows]
        assert min(orders) == degree - 1
        stated = constrained_problem(problem)
        rows = [*range(prescribed), *range(len(problem.rows) - prescribed, len(problem.rows))]
        owned = 3 * sum(problem.rows[i].size for i in rows)
        assert stated.g.shape[0] == owned + 3 * sum(order + 1 for order in orders)
        # They hold for the blend, and not where the last point of a free row is moved.
        missed = ca.Function("g", [stated.x], [stated.g])
        assert np.abs(np.asarray(missed(stated.start))).max() < 1e-11
        moved_one = stated.start.copy()
        moved_one[problem.form.offsets[problem.free_rows[0] + 1] - 1] += 0.1
        assert np.abs(np.asarray(missed(moved_one))).max() > 0.01


@pytest.mark.parametrize("pair", [("G2", "G2"), ("G1", "C1"), ("G2", "G0")])
@pytest.mark.parametrize("seed", first_ones(3, range(8)))
def test_active_bounds_are_met_and_nothing_is_warned_of(seed, pair):
    # A box above where the energy is least: both methods must end on its lower bound, and say so.
    rng = np.random.default_rng(seed)
    a = Base(patch(rng, degrees=(3, 3), counts=(4, 6), height=0.02), "u0")
    b = Base(moved(patch(rng, degrees=(3, 2), counts=(5, 5), height=0.02), FACING, (-2.0, 0.1, 0.6)), "u0")
    proved, local = (blend(a, b, continuity=pair, method=m, box=(6.0, 7.0)) for m in ("reduced", "casadi"))
    assert proved.active_bounds
    assert local.active_bounds == proved.active_bounds
    assert local.energy == pytest.approx(proved.energy, rel=1e-10)
    assert local.warnings == proved.warnings
    assert local.alpha2 == pytest.approx(proved.alpha2, rel=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_ipopt_is_not_beaten_near_its_answer(seed):
    # Nelder-Mead on (a, b) over linear solves knows nothing of CasADi.
    a, b = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    sides = matched_sides(make_side(a, "G2"), make_side(b, "G2"), Correspondence(flipped=False))
    problem = make_problem(*sides)
    found = solve_constrained(problem)

    def energy(z):
        points = problem.control_points(*np.clip(z, *np.transpose(problem.bounds)))
        return float(problem.form.products(points[None])[0, 0])

    start = np.array([found.a, found.b])
    rival = minimize(energy, start * 1.05, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert energy(start) <= rival.fun * (1 + 1e-10)
    assert found.kkt_residual < 1e-8


@pytest.mark.long
def test_energy_of_the_result_is_that_of_the_exact_problem():
    from semispline.derivations.problem import exact_minimum

    problem, exact = both_problems()
    points = problem.control_points(1.25, 0.75)
    energy, control_points = exact_minimum(exact, 1.25, 0.75)
    np.testing.assert_allclose(points, np.array(control_points, dtype=float), rtol=0, atol=1e-13)
    assert float(problem.form.products(points[None])[0, 0]) == pytest.approx(float(energy), rel=1e-13)


def test_shape_parameters_do_not_depend_on_units():
    a, b = small_pair()
    big = [BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, 25.4 * s.control_points + 1e3) for s in (a, b)]
    plain = blend(Base(a, "u0"), Base(b, "u0"), method="casadi")
    scaled = blend(Base(big[0], "u0"), Base(big[1], "u0"), method="casadi")
    assert scaled.alpha2 == pytest.approx(plain.alpha2, rel=1e-6)
    assert scaled.energy == pytest.approx(plain.energy * 25.4**2, rel=1e-6)
