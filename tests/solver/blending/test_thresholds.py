"""What the solver calls closed, flat, folded, proved or trusted: each figure from both sides, by known geometry."""

import re

import casadi as ca
import numpy as np
import pytest

from helpers.bases import facing_pair, moved, patch, tube
from helpers.papers_set import blend, state_problem
from semispline import (
    Base,
    BSplineSurface,
    ComputationError,
    EdgeError,
    OptionError,
)
from semispline.solver.blending import nlp, reduced
from semispline.solver.blending.closing import seam_order, with_least_size
from semispline.solver.judge.correspondence import Correspondence, correspond, is_closed, snapped_seam
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.quadrature import Basis

K1 = [0, 0, 1, 1]
EPS = 2.0**-52


def flat(x, y=(0.0, 1.0), z=0.0):
    return BSplineSurface(1, 1, K1, K1, [[[at, along, z] for along in y] for at in x])


@pytest.mark.parametrize(
    ("box", "active"),
    [
        ((1 / 8, 1.0), ("alpha2 upper", "beta2 upper")),
        ((1 / 8, 1.2), ()),
        ((1.1, 8.0), ()),
        ((1.25, 8.0), ("alpha2 lower", "beta2 lower")),
    ],
)
def test_bounds_that_stop_the_search_are_named(box, active):
    # Alone it would go to 1.64, where the natural size is the root of two: 1.16 of it.
    a, b = (
        Base(flat((0, 1)), "u1"),
        Base(moved(flat((0, 1), z=0.0), np.array([[0, 0, 1], [0, 1, 0], [1, 0, 0]]), (2, 0, 1)), "u0"),
    )
    free = blend(a, b)
    assert free.active_bounds == ()
    assert 1.1 < free.alpha2 / 2**0.5 < 1.25
    result = blend(a, b, box=box)
    assert result.active_bounds == active
    for name in ("alpha2", "beta2"):
        value, (low, high) = getattr(result, name), getattr(result, f"{name}_bounds")
        if active:
            assert value == (high if "upper" in active[0] else low)
        else:
            assert low < value < high


def ring(n=8, radius=1.0):
    """Control points and basis of a closed curve that is smooth across its seam: a clamped periodic spline."""
    surface = tube(np.random.default_rng(0), n, noise=0.0, radius=radius)
    return Basis(surface.degree_v, surface.knots_v), surface.control_points[:1].copy()


@pytest.mark.parametrize(("times", "order"), [(0.5, 0), (0.9, 0), (1.1, -1), (2.0, -1)])
@pytest.mark.parametrize(
    ("largest", "allowed"),
    [
        # A billionth of the extent, 2; and sixteen spacings of the largest coordinate, where that is more.
        (1.0, 2e-9 + 16 * EPS),
        (1e9, 2e-9 + 16 * EPS * 1e9),
    ],
)
def test_seams_are_closed_up_to_a_billionth_and_rounding(times, order, largest, allowed):
    along, rows = ring()
    # Across the seam only the points agree: the second derivative hides nothing.
    extent = np.ptp(rows, axis=1).max()
    rows[0, -1, 2] += times * (allowed - 2e-9 + 1e-9 * extent)
    assert (seam_order(along, rows, largest) >= 0) is (order == 0)


@pytest.mark.parametrize(("times", "order"), [(0.5, 0), (0.9, 0), (1.1, -1), (2.0, -1)])
@pytest.mark.parametrize("length", [1e-3, 1.0])
def test_seams_are_smooth_up_to_a_billionth_of_the_largest_derivative(times, order, length):
    along, rows = ring()
    along = Basis(along.degree, length * along.knots)
    # Closed still, and turned a little where it begins: derivatives do not go with the extent.
    first = along.degree / along.knots[along.degree + 1]
    derivatives = along.degree * np.diff(rows[0], axis=0) / (along.knots[4:-1] - along.knots[1:-4])[:, None]
    rows[0, 1, 2] += times * 1e-9 * max(np.abs(derivatives).max(), np.ptp(rows, axis=1).max()) / first
    assert (seam_order(along, rows, 1.0) >= 1) is (order == 0)


@pytest.mark.parametrize(("times", "order"), [(0.9, 0), (1.1, -1)])
def test_where_a_ring_is_counts_on_both_sides_of_the_origin(times, order):
    for offset in (100.0, -100.0):
        along, rows = ring()
        rows += offset
        rows[0, -1, 2] += times * (1e-9 * np.abs(rows).max() + 16 * EPS * 100)
        assert (seam_order(along, rows, 100.0) >= 0) is (order == 0)


@pytest.mark.parametrize("distance", [1e3, 1e5, 1e7])
def test_a_closed_pair_far_away_keeps_its_seam_smooth(distance):
    rng = np.random.default_rng(0)
    a, b = tube(rng, 8, noise=0.0), tube(rng, 7, noise=0.0, radius=1.5, heights=(4.0, 3.0), phase=0.7)
    # Rounding parts the ends of derivatives, by more than a billionth of them.
    offset = distance * np.array([1 / 3, -1.0, 2 / 3])
    near, far = ([Base(moved(surface, offset=x), "u1") for surface in (a, b)] for x in (np.zeros(3), offset))
    assert state_problem(*far).problem.seam_order == state_problem(*near).problem.seam_order == 2
    one, other = blend(*near, v_scale="length"), blend(*far, v_scale="length")
    assert other.seam_shift == pytest.approx(one.seam_shift, rel=1e-6)
    for first, second in zip(one.surface.control_curves, other.surface.control_curves, strict=True):
        np.testing.assert_allclose(second.knots, first.knots, atol=1e-6)
        np.testing.assert_allclose(second.control_points - offset, first.control_points, atol=1e-11 * distance)


@pytest.mark.parametrize("closed", [False, True])
def test_far_away_the_blend_is_rounded_once(closed):
    # The first base is raised by two degrees, and the second one turned until its seam faces the first one's.
    rng = np.random.default_rng(4)
    if closed:
        pair = tube(rng, 6, degree=2), tube(rng, 7, degree=4, radius=1.5, heights=(4.0, 3.0), phase=0.7)
    else:
        pair = patch(rng, degrees=(3, 2), counts=(4, 6)), patch(rng, degrees=(3, 4), counts=(4, 7))
        pair = pair[0], moved(pair[1], np.diag([-1.0, 1, 1]), (-1.0, 0.1, 0.3))
    # Coordinates in steps of 2^-20: moved by 2^30 they lose nothing, and what is worked out loses one rounding.
    near = [
        BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, np.round(s.control_points * 2**20) / 2**20)
        for s in pair
    ]
    offset = 2.0**30
    one, other = (
        state_problem(*(Base(moved(s, offset=[x] * 3), "u1" if closed else "u0") for s in near)) for x in (0.0, offset)
    )
    for first, second in zip(one.sides, other.sides, strict=True):
        # Spacing of floats at the distance, and some of those near the origin.
        most = offset * EPS / 2 + 1e-13
        assert np.abs((second.rows - offset) - first.rows).max() <= most


def test_degrees_and_knots_at_the_ends_of_their_ranges():
    pair = Base(flat((-1.0, 0.0)), "u1"), Base(flat((1.0, 2.0), z=1.0), "u0")
    # Six rows without middle curves: one span of degree 5.
    assert len(state_problem(*pair, degree_u=5, middle_curves=0).problem.rows) == 6
    with pytest.raises(OptionError, match=r"degree_u: found 6, expected 2 to 5 with 0 middle curve\(s\)"):
        state_problem(*pair, degree_u=6, middle_curves=0)
    for at in (0.0, 1.0):
        with pytest.raises(OptionError, match=r"middle_knots\[0\]: found .*, expected values inside \(0.0, 1.0\)"):
            state_problem(*pair, middle_knots=[[0.5, at]], middle_curves=1)
        with pytest.raises(OptionError, match=r"u_knots: found .*, expected values inside"):
            state_problem(*pair, u_knots=[0.5, at], middle_curves=0, degree_u=3)


def test_spans_within_a_billionth_are_equally_long():
    for apart, inner in ((0.5e-9, 3), (2e-9, 2)):
        # Two spans, the second a little longer: halved together or alone.
        basis = with_least_size(Basis(1, clamped([0.5 - apart / 4], 1, 0.0, 1.0)), 4)
        assert len(basis.knots) - 4 == inner


@pytest.mark.parametrize(("times", "closed"), [(0.5, True), (0.9, True), (1.1, False), (2.0, False)])
def test_edges_are_closed_up_to_a_billionth_of_their_extent(times, closed):
    along, rows = ring(radius=5.0)
    row = rows[0]
    extent = np.ptp(row, axis=0).max()
    row[-1, 2] += times * 1e-9 * extent
    surface = BSplineSurface(1, along.degree, K1, along.knots, np.stack([row, row + np.array([0, 0, 1])]))
    assert is_closed(Base(surface, "u0")) is closed


@pytest.mark.parametrize(("off", "moves"), [(0.5e-4, True), (0.9e-4, True), (1.1e-4, False), (2e-4, False)])
def test_seams_move_by_up_to_a_ten_thousandth(off, moves):
    tubes = [Base(tube(np.random.default_rng(0), 8, noise=0.0), "u1") for _ in range(2)]
    found = snapped_seam(*tubes, Correspondence(flipped=False, shift=3 / 8 + off))
    assert found.shift == (3 / 8 if moves else 3 / 8 + off)


def test_no_shift_at_all_within_a_billionth():
    a = Base(tube(np.random.default_rng(0), 8, noise=0.0), "u1")
    for turn, is_none in ((0.5e-9, True), (2e-9, False)):
        angle = 2 * np.pi * turn
        matrix = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        assert (correspond(a, Base(moved(a.surface, matrix), "u1")).shift == 0) is is_none


@pytest.mark.parametrize("spans", [1, 3, 700])
def test_the_natural_size_is_a_mean_over_the_contact(spans):
    # A gap of sqrt(1 + (5 v)^2) over a speed of 2 on one side and 1 on the other: no polynomial.
    knots = np.concatenate([[0.0], np.linspace(0, 1, spans + 1), [1.0]])
    v = knots[1:-1]
    row = np.stack([np.zeros_like(v), v, np.zeros_like(v)], axis=1)
    tilted = np.stack([np.ones_like(v), v, 5 * v], axis=1)
    a = BSplineSurface(1, 1, K1, knots, np.stack([row - [2.0, 0, 0], row]))
    b = BSplineSurface(1, 1, K1, knots, np.stack([tilted, tilted + np.array([1.0, 0, 0])]))
    mean = (np.sqrt(26) + np.arcsinh(5) / 5) / 2
    problem = state_problem(Base(a, "u1"), Base(b, "u0")).problem
    assert problem.natural == pytest.approx((mean / 2, mean), rel=1e-9)


@pytest.mark.parametrize(("times", "refused"), [(0.5, True), (0.9, True), (1.1, False), (2.0, False)])
@pytest.mark.parametrize(
    ("bases", "size", "message"),
    [
        (lambda x: (flat((-1.0, 0.0), (0.0, x)), flat((1.0, 2.0))), 3, "contact curve has zero length"),
        (lambda x: (flat((-x, 0.0)), flat((1.0, 2.0))), 2, "cross derivative vanishes"),
        (lambda x: (flat((-1.0, 0.0)), flat((x, 1.0))), 2, "contact curves coincide"),
    ],
)
def test_what_is_a_ten_billionth_of_the_pair_is_nothing(bases, size, message, times, refused):
    a, b = bases(times * 1e-10 * size)
    pair = Base(a, "u1"), Base(b, "u0")
    if refused:
        with pytest.raises(EdgeError, match=message):
            state_problem(*pair, continuity="C1")
    else:
        state_problem(*pair, continuity="C1")


class Factor:
    """A factorised system that answers with a given part of what it is asked to correct."""

    def __init__(self, part, solved):
        self.part, self.solved, self.calls = part, solved, 0

    def solve(self, right):
        self.calls += 1
        return self.solved if self.calls == 1 else self.part * self.solved


@pytest.mark.parametrize(
    ("correction", "answer"),
    [
        (0.5e-12, "trusted at once"),
        (0.9e-12, "trusted at once"),
        (1.1e-12, "refined"),
        (0.5e-8, "refined"),
        (0.9e-8, "refined"),
        (1.1e-8, "refused"),
        (2e-8, "refused"),
        (1e-3, "refused"),
    ],
)
def test_corrections_of_the_free_rows(correction, answer):
    problem = state_problem(*facing_pair(np.random.default_rng(0))).problem
    system = problem.free_system
    system.factor = Factor(correction, np.ones((system.size, 3)))
    if answer == "refused":
        with pytest.raises(ComputationError, match="too ill-conditioned to be trusted"):
            problem.control_points(*problem.start)
        return
    problem.control_points(*problem.start)
    assert (system.factor.calls == 2) is (answer == "trusted at once")


class Converging(Factor):
    """One whose corrections fall by a factor each time."""

    def solve(self, right):
        self.calls += 1
        return self.solved * (1.0 if self.calls == 1 else self.part ** (self.calls - 2))


@pytest.mark.parametrize(("factor", "is_trusted"), [(0.3, True), (0.38, True), (0.42, False), (0.49, False)])
def test_twenty_corrections_are_enough_or_all(factor, is_trusted):
    # 0.398^20 is 1e-8.
    problem = state_problem(*facing_pair(np.random.default_rng(0))).problem
    problem.free_system.factor = Converging(factor, np.ones((problem.free_system.size, 3)))
    if is_trusted:
        problem.control_points(*problem.start)
    else:
        with pytest.raises(ComputationError, match="too ill-conditioned to be trusted"):
            problem.control_points(*problem.start)


@pytest.mark.parametrize(("largest", "is_fine"), [(0.9e200, True), (-0.9e200, True), (1.1e200, False), (np.nan, False)])
def test_energies_beyond_fourth_powers_are_refused(monkeypatch, largest, is_fine):
    problem = state_problem(*facing_pair(np.random.default_rng(0))).problem
    table = np.ones((5, 5))
    table[4, 0] = largest
    monkeypatch.setattr(reduced.shape_numpy, "shape_polynomial_22", lambda *products: table)
    if is_fine:
        np.testing.assert_array_equal(reduced.shape_polynomial(problem, (0.0, 0.0)), table)
    else:
        with pytest.raises(ComputationError, match=r"expected at most 1e\+200"):
            reduced.shape_polynomial(problem, (0.0, 0.0))


@pytest.mark.parametrize(
    ("name", "off", "is_solved"),
    [
        ("lam_x", 0.9e-8, True),
        ("lam_x", 1.1e-8, False),
        ("lam_x", 1e-6, False),
        ("g", 0.9e-9, True),
        ("g", 1.1e-9, False),
        ("g", 1e-6, False),
    ],
)
def test_what_ipopt_may_leave(monkeypatch, name, off, is_solved):
    # The gradient of the Lagrangian, and how far constraints are missed, each spoilt by a known amount.
    right = nlp._optimum

    def spoilt(*args, **start):
        result, stats = right(*args, **start)
        values = np.asarray(result[name]).copy()
        values[0] += off
        return {**result, name: ca.DM(values)}, stats

    monkeypatch.setattr(nlp, "_optimum", spoilt)
    problem = state_problem(*facing_pair(np.random.default_rng(0))).problem
    if is_solved:
        nlp.solve_constrained(problem)
    else:
        with pytest.raises(ComputationError, match="IPOPT ended with"):
            nlp.solve_constrained(problem)


@pytest.mark.parametrize(("reached", "solves"), [(0.05, 2), (0.09, 2), (0.11, 1), (0.5, 1)])
def test_the_search_goes_on_where_the_energy_falls_to_a_tenth(monkeypatch, reached, solves):
    right, starts = nlp._optimum, []

    def told(*args, **start):
        result, stats = right(*args, **start)
        starts.append(start)
        return (result if "lam_g0" in start else {**result, "f": ca.DM(reached)}), stats

    monkeypatch.setattr(nlp, "_optimum", told)
    nlp.solve_constrained(state_problem(*facing_pair(np.random.default_rng(0))).problem)
    assert len(starts) == solves


def test_the_objective_is_never_scaled_by_less_than_its_rounding():
    # One plane: no energy, only terms that cancel.
    problem = state_problem(Base(flat((0, 1)), "u1"), Base(flat((2, 3)), "u0")).problem
    points, matrix = problem.control_points(*problem.start), problem.form.matrix().toarray()
    terms = np.einsum("ix,ij,jx->", np.abs(points), np.abs(matrix), np.abs(points))
    assert nlp.constrained_problem(problem).f_scale == pytest.approx(1e-5 * terms, rel=1e-12)


# A tolerance of 1e-10, of which the search itself may leave a quarter.
@pytest.mark.parametrize(
    ("error", "proved"),
    [(-2e-10, False), (-0.5e-10, True), (0.0, True), (0.5e-10, True), (1.3e-10, False), (1e-6, False)],
)
def test_a_polynomial_that_is_not_the_energy_proves_nothing(monkeypatch, error, proved):
    # Above the energy its bound is no bound of it; below, it leaves a gap.
    problem = state_problem(*facing_pair(np.random.default_rng(0))).problem
    right = reduced.shape_polynomial
    monkeypatch.setattr(reduced, "shape_polynomial", lambda *args: right(*args) * (1 + error))
    if proved:
        assert abs(reduced.solve_reduced(problem).gap) <= 1e-10
    else:
        with pytest.raises(ComputationError, match="is proved only to"):
            reduced.solve_reduced(problem)


@pytest.mark.parametrize(
    ("times", "proved"), [(-2.0, False), (-0.6, True), (0.0, True), (0.8, True), (1.5, False), (10.0, False)]
)
def test_an_energy_below_a_million_millionth_of_its_terms_is_none(monkeypatch, times, proved):
    # Two pieces of one plane: the least energy, at alpha^2 = 1, is 0, and what its terms cancel to stands for it.
    problem = state_problem(Base(flat((0, 1)), "u1"), Base(flat((2, 3)), "u0")).problem
    assert problem.natural == pytest.approx((1.0, 1.0))
    right = reduced.shape_polynomial
    terms = float(np.abs(right(problem, (0.0, 0.0))).sum())

    def off(*args):
        table = right(*args).copy()
        table[0, 0] += times * 1e-10 * 1e-12 * terms
        return table

    monkeypatch.setattr(reduced, "shape_polynomial", off)
    if proved:
        assert abs(reduced.solve_reduced(problem).gap) <= 1e-10
    else:
        with pytest.raises(ComputationError, match="is proved only to"):
            reduced.solve_reduced(problem)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"alpha": 0.9e-15}, "alpha: found 9e-16"),
        ({"alpha": 1.1e15}, "alpha: found 1.1e+15"),
        ({"box": (0.9e-20, 1)}, "box: found (9e-21, 1)"),
        ({"box": (1, 1.1e20)}, "box: found (1, 1.1e+20)"),
        ({"middle_curves": 1001}, "middle_curves: found 1001"),
        ({"degree_u": 1}, "degree_u: found 1"),
    ],
)
def test_options_just_outside_of_their_range(options, message):
    with pytest.raises(OptionError, match=re.escape(message)):
        state_problem(Base(flat((0, 1)), "u1"), Base(flat((2, 3), z=1.0), "u0"), **options)


@pytest.mark.parametrize(
    "options",
    [
        {"alpha": 1.1e-15},
        {"alpha": 0.9e15},
        {"box": (1.1e-20, 1)},
        {"box": (1, 0.9e20)},
        {"degree_u": 2},
        {"middle_curves": 1000},
    ],
)
def test_options_just_inside_of_their_range(options):
    problem = state_problem(Base(flat((0, 1)), "u1"), Base(flat((2, 3), z=1.0), "u0"), **options).problem
    bounds = np.array(problem.bounds)
    assert np.all((bounds > 0) & (bounds < np.inf))
    assert np.all(bounds[:, 0] <= bounds[:, 1])


@pytest.mark.parametrize("closed", [True, False])
def test_middle_curves_of_rings_have_all_knots_and_points_for_their_seam(closed):
    # Polygons, the second one with other knots; open, neighbours are averaged in pairs.
    own, other = np.linspace(0, 1, 5), np.array([0, 0.2, 0.5, 0.8, 1])
    angles = np.linspace(0, 2 * np.pi if closed else 4, 5)
    a, b = (
        Base(
            BSplineSurface(1, 1, K1, [0, *knots, 1], [[[np.cos(t), np.sin(t), z + k] for t in angles] for k in (0, 1)]),
            edge,
        )
        for z, knots, edge in ((0.0, own, "u1"), (3.0, other, "u0"))
    )
    problem = state_problem(a, b, middle_curves=1, middle_knots="paper", continuity="G1").problem
    middle = problem.rows[problem.a.count]
    assert problem.seam_order == (0 if closed else -1)
    inner = [0.2, 0.25, 0.5, 0.75, 0.8] if closed else [0.225, 0.5, 0.775]
    assert middle.knots[2:-2] == pytest.approx(inner, abs=1e-12)


@pytest.mark.parametrize(("turn", "order"), [(2 * np.pi, 0), (4.0, -1)])
def test_middle_curves_of_rings_with_a_corner_have_points_for_both_ends(turn, order):
    angles = np.linspace(0, turn, 4)
    rims = [[[np.cos(t), np.sin(t), z] for t in angles] for z in (0.0, 1.0, 3.0, 4.0)]
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    a, b = Base(BSplineSurface(1, 3, K1, knots, rims[:2]), "u1"), Base(BSplineSurface(1, 3, K1, knots, rims[2:]), "u0")
    problem = state_problem(a, b, middle_curves=1, middle_knots="paper", continuity="G1").problem
    assert problem.seam_order == order
    assert (problem.rows[problem.a.count].size >= 6) is (order == 0)
