"""The proved global minimum: certificates, rivals, and where local methods go wrong."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import OptimizeResult, brute, minimize
from scipy.stats import special_ortho_group

from helpers.bases import cylinder, facing_pair, moved, patch
from helpers.papers_set import blend, make_problem, state_problem
from helpers.sweeps import first_ones
from semispline import Base, BSplineSurface, ComputationError, ContactError, EdgeError, FoldError
from semispline.solver.blending.quasi_newton import solve_quasi_newton
from semispline.solver.blending.reduced import shape_polynomial, solve_reduced
from semispline.solver.blending.sides import make_side, matched_sides
from semispline.solver.judge.correspondence import Correspondence
from semispline.solver.proof.box_search import least_point
from semispline.solver.proof.checker import CertificateError, check_certificate

# (x^2 - 1)^2 + y^2, two equal minima; and a tilted one with a local minimum at x about 0.96.
DOUBLE_WELL = np.array([[1.0, 0, 1], [0, 0, 0], [-2, 0, 0], [0, 0, 0], [1, 0, 0]])
TILTED = DOUBLE_WELL + np.array([[0.0, 0, 0], [0.3, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]])


def random_table(rng):
    """A sum of squares of random quadratics: like an energy, with coefficients of very different size."""
    root = rng.standard_normal((5, 5)) * 10.0 ** rng.uniform(-2, 2, 5)
    s = root.T @ root
    table = np.zeros((5, 5))
    powers = [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2)]
    for k, (i, j) in enumerate(powers):
        for n, (p, q) in enumerate(powers):
            table[i + p, j + q] += s[k, n]
    return table


@pytest.mark.long
@given(st.integers(0, 10**6))
def test_the_proof_holds_and_no_sample_is_below(seed):
    table = random_table(np.random.default_rng(seed))
    box = ((-0.9, 7.0), (-0.5, 3.0))
    tolerance = 1e-9 * table[0, 0]
    certificate = least_point(table, box, tolerance)
    point = certificate.point
    check_certificate(certificate)
    x, y = (np.linspace(*ends, 300) for ends in box)
    samples = np.polynomial.polynomial.polygrid2d(x, y, table)
    assert certificate.bound <= samples.min()
    value = np.polynomial.polynomial.polyval2d(*point, table)
    # Rounding of the plain evaluation here, not of the proof.
    rounding = 1e-14 * np.polynomial.polynomial.polyval2d(*np.abs(point), np.abs(table))
    assert certificate.bound <= value + rounding
    assert value <= certificate.bound + tolerance + rounding
    assert value <= samples.min() + rounding


def test_the_global_minimum_of_a_tilted_double_well():
    certificate = least_point(TILTED, ((-2.0, 2.0), (-1.0, 1.0)), 1e-10)
    point = certificate.point
    assert point[0] == pytest.approx(-1.0355, abs=1e-4)
    assert point[1] == pytest.approx(0, abs=1e-9)
    check_certificate(certificate)


@pytest.mark.parametrize(
    ("table", "box"),
    [
        (np.array([[2.0]]), ((0.0, 0.0), (0.0, 0.0))),
        (np.array([[2.0, 0, 0]]), ((0.0, 0.0), (-1.0, 4.0))),  # flat in y
        (np.array([[1.0, 0, 1], [0, -2, 0], [1, 0, 0]]), ((-1.0, 5.0), (-1.0, 5.0))),  # 1 + (x - y)^2: a valley
        (np.zeros((5, 5)), ((-1.0, 1.0), (-1.0, 1.0))),
        (DOUBLE_WELL, ((-2.0, 2.0), (-1.0, 1.0))),  # two equal minima
        (np.array([[1.0, 1.0, 0]]), ((0.0, 0.0), (0.0, 5.0))),  # at a bound
    ],
)
def test_flat_directions_valleys_ties_and_bounds(table, box):
    certificate = least_point(table, box, 1e-10)
    point = certificate.point
    check_certificate(certificate)
    x, y = (np.linspace(*ends, 101) for ends in box)
    assert np.polynomial.polynomial.polyval2d(*point, table) <= (
        np.polynomial.polynomial.polygrid2d(x, y, table).min() + 1e-14
    )


@pytest.fixture(scope="module")
def certificate():
    return least_point(TILTED, ((-2.0, 2.0), (-1.0, 1.0)), 1e-10)


def test_a_bound_that_is_too_high_is_refused(certificate):
    # The local minimum near x = 0.96 planted as if it were the global one.
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, bound=0.29))
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, bound=certificate.bound + 1e-9))


def test_a_planted_wrong_minimum_is_refused(certificate):
    # The local minimum, with the bound and the proof of the global one.
    with pytest.raises(CertificateError, match="value at the point"):
        check_certificate(replace(certificate, point=(0.9615, 0.0)))
    with pytest.raises(CertificateError, match="outside of the box"):
        check_certificate(replace(certificate, point=(5.0, 0.0)))
    with pytest.raises(CertificateError, match="value at the point"):
        check_certificate(replace(certificate, bound=-1e9))
    shrunk = replace(certificate, box=((0.0, 1e-9), (0.0, 1e-9)))
    with pytest.raises(CertificateError):
        check_certificate(shrunk)


@pytest.mark.parametrize(
    "change",
    [
        {"bound": float("nan")},
        {"box": ((0.0, float("inf")), (0.0, 1.0))},
        {"point": (0.0,)},
        {"coefficients": TILTED * np.nan},
    ],
)
def test_a_malformed_certificate_is_refused(certificate, change):
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, **change))
    leaf = replace(certificate.leaves[0], tangent_at=())
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, leaves=(leaf, *certificate.leaves[1:])))


def test_a_bound_above_the_energy_is_no_proof():
    # Bases that nearly continue each other over a gap that rounding reaches: refused or proved, never a false proof.
    t = np.linspace(0, 1, 4)
    u, v = np.meshgrid(t, t, indexing="ij")
    k = [0, 0, 0, 0, 1, 1, 1, 1]
    a = BSplineSurface(3, 3, k, k, np.dstack([u, v, 0.2 * u**2]))
    for gap in (1e-6, 1e-9, 1e-10, 1e-11):
        b = BSplineSurface(3, 3, k, k, np.dstack([1 + gap + u, v, np.full_like(u, 0.2)]))
        try:
            result = blend(Base(a, "u1"), Base(b, "u0"))
        except (ComputationError, EdgeError):
            continue
        assert abs(result.proven_gap) <= 1e-10


def test_a_missing_part_is_refused(certificate):
    with pytest.raises(CertificateError, match="area"):
        check_certificate(replace(certificate, leaves=certificate.leaves[1:]))


def test_overlapping_parts_are_refused(certificate):
    leaves = [leaf for leaf in certificate.leaves if leaf.x[1] == certificate.leaves[0].x[1]]
    same_size = [leaf for leaf in leaves if leaf.y[1] == leaves[0].y[1]]
    assert len(same_size) > 1
    doubled = [same_size[1] if leaf is same_size[0] else leaf for leaf in certificate.leaves]
    with pytest.raises(CertificateError, match="overlap"):
        check_certificate(replace(certificate, leaves=tuple(doubled)))


def test_a_false_claim_of_convexity_is_refused(certificate):
    claimed = tuple(
        replace(leaf, tangent_at=(0.5, 0.5)) if leaf.tangent_at is None else leaf for leaf in certificate.leaves
    )
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, leaves=claimed))


def test_another_polynomial_is_refused(certificate):
    with pytest.raises(CertificateError):
        check_certificate(replace(certificate, coefficients=TILTED - np.eye(5, 3)))


def problem_of(seed, **options):
    a, b = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    sides = matched_sides(make_side(a, "G2"), make_side(b, "G2"), Correspondence(flipped=False))
    return make_problem(*sides, **options)


def energy_at(problem, shape):
    points = problem.control_points(*shape)
    return float(problem.form.products(points[None])[0, 0])


@pytest.mark.parametrize("seed", range(6))
def test_the_polynomial_is_the_energy_of_the_best_blend(seed):
    problem = problem_of(seed)
    centre = tuple(1.3 * n for n in problem.natural)
    table = shape_polynomial(problem, centre)
    rng = np.random.default_rng(seed)
    for x, y in rng.uniform(-1.2, 4, (5, 2)):
        shape = centre[0] + x * problem.natural[0], centre[1] + y * problem.natural[1]
        expected = energy_at(problem, shape)
        assert np.polynomial.polynomial.polyval2d(x, y, table) == pytest.approx(expected, rel=1e-9)


def dense_multistart(problem, points):
    """The least energy of a grid, and of a local search from its best point, over the parameters that are free."""

    def energy(logs):
        values = iter(np.exp(logs))
        shape = [next(values) if is_free else at for is_free, at in zip(problem.free, problem.start, strict=True)]
        return energy_at(problem, shape)

    bounds = [(np.log(low), np.log(high)) for (low, high), f in zip(problem.bounds, problem.free, strict=True) if f]
    ranges = [slice(low, high, (high - low) / points) for low, high in bounds]
    start = np.atleast_1d(brute(energy, ranges, finish=None))
    return float(minimize(energy, start, bounds=bounds, method="L-BFGS-B").fun)


CONTACTS = ("G2", "G1", "C2", "C1", "G0", "C0")


def varied_problem(seed):
    """Any edges and directions, every scale of v, any continuity with an unknown; each fourth pair is closed."""
    rng = np.random.default_rng(seed)
    if seed % 4 == 3:
        tilt = rng.uniform(-0.2, 0.2, 2)
        a = cylinder(6, 1.0, (1, 2), seam=rng.uniform(), tilt=tilt[0])
        b = cylinder(8, rng.uniform(0.7, 1.4), (-1, -2), seam=rng.uniform(), tilt=tilt[1], offset=(0.2, 0.1))
        bases = Base(a, "u0"), Base(b, "u0")
    else:
        bases = facing_pair(rng)
    first = str(rng.choice(["G2", "G1"]))
    pair = rng.permutation([first, str(rng.choice(CONTACTS))]).tolist()
    options = {"v_scale": str(rng.choice(["paper", "unit", "length"])), "middle_curves": int(rng.integers(0, 3))}
    low = float(rng.choice([1 / 8, 1 / 2, 1 / 50]))
    return state_problem(*bases, continuity=tuple(pair), box=(low, 1 / low), **options).problem


def verify_never_beaten(problem, points):
    found = solve_reduced(problem)
    assert found.gap <= 1e-10
    check_certificate(found.certificate)
    assert energy_at(problem, (found.a, found.b)) <= dense_multistart(problem, points) * (1 + 1e-10)


@pytest.mark.parametrize("seed", first_ones(3, range(12)))
def test_a_dense_multistart_never_beats_it(seed):
    verify_never_beaten(problem_of(seed, middle_curves=seed % 3), 12)


@pytest.mark.parametrize("seed", range(8))
def test_a_dense_multistart_never_beats_it_whatever_the_contact(seed):
    verify_never_beaten(varied_problem(seed), 10)


@pytest.mark.slow
def test_a_dense_multistart_never_beats_it_300_times():
    for seed in range(300):
        verify_never_beaten(problem_of(seed, middle_curves=seed % 3), 20)


@pytest.mark.slow
def test_a_dense_multistart_never_beats_it_300_times_whatever_the_contact():
    for seed in range(300):
        verify_never_beaten(varied_problem(seed), 10)


@pytest.mark.parametrize("seed", first_ones(2, range(10)))
def test_casadi_agrees_and_is_never_below(seed):
    a, b = facing_pair(np.random.default_rng(seed))
    proved, local = (blend(a, b, method=method) for method in ("reduced", "casadi"))
    assert proved.energy <= local.energy * (1 + 1e-10)
    assert proved.proven_gap <= 1e-10
    if local.energy < proved.energy * (1 + 1e-4):
        assert local.energy == pytest.approx(proved.energy, rel=1e-8)


def test_bases_that_continue_each_other_have_no_energy():
    k = [0, 0, 0, 1, 1, 1]
    net = np.array([[[x, y, 0.3 * x + 0.1 * y] for y in (0, 0.5, 1)] for x in (0, 0.5, 1)])
    a = BSplineSurface(2, 2, k, k, net)
    b = moved(a, offset=(3, 0, 0.9))
    proved, local = (blend(Base(a, "u1"), Base(b, "u0"), method=m) for m in ("reduced", "casadi"))
    assert proved.energy == pytest.approx(0, abs=1e-20)
    assert local.energy == pytest.approx(0, abs=1e-16)
    assert proved.alpha2 == pytest.approx(2, rel=1e-6)


@pytest.mark.long
def test_alpha_can_be_set():
    a, b = facing_pair(np.random.default_rng(3))
    natural = blend(a, b, alpha="natural")
    assert natural.method == "linear"
    assert natural.alpha2_bounds is None
    set_one = blend(a, b, alpha=(0.9, "energy"))
    assert set_one.alpha2 == pytest.approx(0.81, rel=1e-15)
    assert set_one.alpha2_bounds is None
    assert set_one.beta2_bounds is not None
    for result in (natural, set_one):
        assert result.contact_a.curvature_jump_relative < 1e-9
        assert blend(a, b).energy <= result.energy
    local = blend(a, b, alpha=(0.9, "energy"), method="casadi")
    assert local.energy == pytest.approx(set_one.energy, rel=1e-8)


@pytest.mark.long
def test_the_box_can_be_set():
    a, b = facing_pair(np.random.default_rng(9))
    narrow = blend(a, b, box=(0.9, 1.1))
    wide = blend(a, b, box=(0.01, 100))
    assert narrow.alpha2_bounds[1] / narrow.alpha2_bounds[0] == pytest.approx(1.1 / 0.9)
    assert wide.energy <= narrow.energy
    assert narrow.active_bounds


@pytest.mark.parametrize("pair", [("C2", "G1"), ("G1", "C0"), ("G0", "G2"), ("G1", "G2"), ("C1", "C0"), ("G1", "G1")])
def test_every_combination_of_sides(pair):
    a, b = facing_pair(np.random.default_rng(5))
    result = blend(a, b, continuity=pair)
    assert result.continuity == pair
    assert (result.alpha2_bounds is not None) == (pair[0] in ("G1", "G2"))
    assert (result.alpha2 is None) == (pair[0] in ("C0", "G0"))
    if "G" in pair[0] + pair[1] and "2" in pair[0] + pair[1]:
        local = blend(a, b, continuity=pair, method="casadi")
        assert local.energy == pytest.approx(result.energy, rel=1e-8)


DEGENERATE = re.compile(
    "contact [ab]: the search ran to a degenerate shape parameter, (alpha|beta)2 = .*try method reduced"
)


def searched(a, b, **options):
    """The paper's search: its answer, or None where it says that it ran to a degenerate shape parameter.

    Which of the two, and at which of its minima it stops, may depend on how the processor rounds.
    """
    try:
        return blend(a, b, method="bfgs", **options)
    except ContactError as error:
        if not DEGENERATE.match(str(error)):
            raise
        return None


@pytest.mark.parametrize("seed", first_ones(3, range(12)))
def test_bfgs_is_never_better_or_says_where_it_degenerates(seed):
    a, b = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    rough = searched(a, b)
    if rough is None:
        return
    assert rough.method == "bfgs"
    assert rough.iterations > 0
    # Over a box that has its answer inside, however small: the default one begins at 1/8 of natural.
    sizes = [8 * low for low, _ in (rough.alpha2_bounds, rough.beta2_bounds)]
    low, *_, high = sorted([1 / 8, rough.alpha2 / sizes[0], rough.beta2 / sizes[1], 8])
    around = blend(a, b, box=(0.9 * low, 1.1 * high))
    assert around.energy <= rough.energy * (1 + 1e-10)
    # What the search itself left: a little more than its alpha and beta allow, never less.
    assert -1e-10 <= rough.search_excess < 1e-3
    assert around.search_excess is None


def test_bfgs_names_each_side_that_degenerates(monkeypatch):
    # On every processor: the search is told where to end.
    a, b = facing_pair(np.random.default_rng(0), edges=("u0", "u0"), backwards=(False, False))
    natural = state_problem(a, b).problem.natural

    def ends_at(*shape):
        def search(objective, start, method):
            x = start.copy()
            x[-2:] = np.sqrt(np.multiply(shape, natural))
            return OptimizeResult(x=x, fun=objective(x), nit=3, message="ended")

        monkeypatch.setattr("semispline.solver.blending.quasi_newton.minimize", search)
        return solve_quasi_newton(state_problem(a, b).problem)

    found = ends_at(1.01e-8, 1.01e-8)
    np.testing.assert_allclose((found.a, found.b), np.multiply(1.01e-8, natural), rtol=1e-12)
    for shape, sides in (((0.9e-8, 1), "a"), ((1, 0.0), "b"), ((1e-12, 1e-15), "ab")):
        with pytest.raises(ContactError) as refusal:
            ends_at(*shape)
        named = re.findall("contact ([ab]): the search ran to a degenerate shape parameter", str(refusal.value))
        assert "".join(named) == sides


def floor_and_wall():
    """Two planes at a right angle: one minimum, at alpha^2 = beta^2 = 27/16, and the search begins beside it."""
    knots = [0, 0, 1, 1]
    floor = BSplineSurface(1, 1, knots, knots, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    wall = BSplineSurface(1, 1, knots, knots, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]])
    return Base(floor, "u1"), Base(wall, "u0")


@pytest.mark.long
def test_bfgs_outside_of_the_box_says_so():
    # In a box that its answer misses the paper's search has less energy than any admissible blend, and says why.
    a, b = floor_and_wall()
    free = blend(a, b, method="bfgs", middle_curves=0)
    assert free.alpha2 == pytest.approx(27 / 16, rel=1e-4)
    assert not [w for w in free.warnings if w.startswith("alpha2 is")]
    assert not free.active_bounds
    factor = free.alpha2 / (free.alpha2_bounds[0] * 8)
    missed = (1.1 * factor, 10 * factor)
    rough, proved = (blend(a, b, method=method, middle_curves=0, box=missed) for method in ("bfgs", "reduced"))
    assert rough.alpha2 < rough.alpha2_bounds[0]
    assert rough.active_bounds[0] == "alpha2 lower"
    assert [w for w in rough.warnings if w.startswith("alpha2 is") and "knows no bounds" in w]
    assert rough.energy < proved.energy
    assert [w for w in proved.warnings if w.startswith("alpha2 is at its lower bound")]
    with pytest.raises(FoldError, match="outside of the admissible"):
        blend(a, b, method="bfgs", middle_curves=0, box=missed, strict=True)


def crooked_pair(seed):
    """Two strongly curved patches in random position: what makes the energy have several minima."""
    rng = np.random.default_rng(seed)
    surfaces = [patch(rng, degrees=(3, 3), counts=(4, 6), height=rng.uniform(0.1, 2)) for _ in range(2)]
    turn = special_ortho_group.rvs(3, random_state=rng)
    return Base(surfaces[0], "u0"), Base(moved(surfaces[1], turn, rng.uniform(-1.5, 1.5, 3)), "u0")


# Found among 3000 random pairs: a minimum in this box, on none of its ends but those of the usual box, may hold a local
# method; whether such a method, from the natural shape parameters, gets there is not a law.
@pytest.mark.parametrize(
    ("seed", "trap", "ends", "excess"),
    [(770, (0.6, 0.7), (), 1.0025), (1328, (1 / 8, 0.15), ("alpha2 lower", "beta2 lower"), 1.015)],
)
def test_a_local_method_may_stop_at_a_worse_minimum(seed, trap, ends, excess):
    a, b = crooked_pair(seed)
    proved, trapped = blend(a, b, flip="no"), blend(a, b, flip="no", box=trap)
    assert trapped.active_bounds == ends
    assert trapped.energy > excess * proved.energy
    for certificate in (proved.certificate, trapped.certificate):
        check_certificate(certificate)
    assert blend(a, b, flip="no", method="casadi").energy >= proved.energy * (1 - 1e-10)


# Least energy is at alpha = 0, where the blend no longer leaves its contact curve, and unbounded BFGS runs there.
@pytest.mark.parametrize("seed", [0, 2, 4, 13])
def test_bfgs_runs_to_zero(seed):
    a, b = crooked_pair(seed)
    rough = searched(a, b, flip="no", middle_curves=0)
    proved = blend(a, b, flip="no", middle_curves=0)
    assert proved.active_bounds
    assert proved.proven_gap <= 1e-10
    # Should the search stop on its way, it stops outside of the box, with less energy than is admissible, and says so.
    assert rough is None or (rough.warnings and rough.energy < proved.energy)
