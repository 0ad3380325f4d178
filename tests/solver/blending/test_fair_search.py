"""The fairest shape: J and its gradient against other ways to them, and blends whose right shape is known."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.bases import facing_pair
from helpers.facing import random_facing
from helpers.impeller import impeller_pair
from semispline import (
    Base,
    BlendOptions,
    BSplineCurve,
    BSplineSurface,
    ComputationError,
    OptionError,
    blend,
    measure_fairness,
    measure_turn,
    read_surface,
    revolve_polynomial,
    transform,
)
from semispline.papers.reproduction.families.open_pairs import open_pair
from semispline.solver.blending import fair_search
from semispline.solver.blending.candidates import Layout, _fairer
from semispline.solver.blending.fair_objective import FairObjective, make_unknowns
from semispline.solver.blending.fair_search import FairSolution, solve_fair
from semispline.solver.blending.fairness_grid import NODES_U, across, along
from semispline.solver.blending.fairness_table import FOLDS, LOOPS, FairnessTable
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.projected import Point, descend
from semispline.solver.blending.shape_parameters import Found, found_fair
from semispline.solver.blending.warnings import fairness_warning

CASES = Path(__file__).parents[2] / "cases"
QUINTIC = {"degree_u": 5, "middle_curves": 0}
FAIR = QUINTIC | {"alpha": "fair"}


def case(name, edge):
    return Base(read_surface(CASES / f"{name}.json"), edge)


def sheet(x, height, slope, *, bend=0.3, inner=(), degree=3):
    """A curved sheet from x on whose edge u0 rises by `slope`; knots along v as given."""
    n = degree + 1 + len(inner)
    v = np.linspace(0, 2, n)
    rows = [[[x + i * 0.5, y, height + slope * i * 0.5 + bend * np.sin(2 * y + i)] for y in v] for i in range(4)]
    knots = [0.0] * (degree + 1) + list(inner) + [1.0] * (degree + 1)
    return BSplineSurface(3, degree, [0, 0, 0, 0, 1, 1, 1, 1], knots, rows)


def sheets(**more):
    """Two sheets that face each other: the first one turned round."""
    first = transform(sheet(0.0, 0.0, 0.2, **more), np.diag([-1.0, 1.0, 1.0]))
    return Base(first, "u0"), Base(sheet(1.2, 0.6, 0.4, bend=0.2, inner=(0.4,)), "u0")


def tables(pair, times=1, nodes_u=NODES_U, **options):
    """The problem of a pair and its table; monomials are 1, p2, a, a^2 of side a; p2, b, b^2 of side b."""
    problem = state_problem(*pair, **(QUINTIC | {"alpha": "fair"} | options)).problem
    layers, exponents = problem.shape_layers()
    grid = across(problem.form.u, times * nodes_u), along(problem.rows, times)
    return problem, FairnessTable(problem, layers, *grid), exponents


def j(table, monomials):
    """J of one candidate."""
    return float(table.measure(np.array(monomials)[None]).values[0])


@pytest.mark.parametrize("inner", [(), (0.5, 0.5)])
def test_what_is_minimised_is_what_the_judge_measures(inner):
    result = blend(*sheets(inner=inner), **FAIR)
    measured = measure_fairness(result.surface)
    assert measured.settled
    assert result.objective.value == pytest.approx(measured.value, rel=0.01)
    assert (measured.jumps > 1e-3) is bool(inner)


def test_the_end_is_a_minimum_of_the_search_and_p2_makes_it_lower():
    problem = state_problem(*sheets(), **FAIR).problem
    with_p2, without = solve_fair(problem), solve_fair(state_problem(*sheets(), **FAIR, p2="zero").problem)
    assert with_p2.slope < 1e-4
    assert without.slope < 1e-4
    assert without.p2 == (0.0, 0.0)
    assert with_p2.value < without.value
    _, table, _ = tables(sheets(), times=2)
    unit_a, unit_b = problem.natural
    for factor in (0.9, 1.1):
        x, y = without.a * factor / unit_a, without.b / unit_b
        assert j(table, [1.0, 0.0, x, x**2, 0.0, y, y**2]) > without.value


def refined(problem, found, times):
    """The search gone on from its end on a grid that is finer; and J at its end there."""
    layers, exponents = problem.shape_layers()
    unknowns = make_unknowns(problem, exponents)
    (unit_a, unit_b), (p2_a, p2_b) = problem.natural, found.p2
    end = np.array([np.log(found.a / unit_a), p2_a / unit_a, np.log(found.b / unit_b), p2_b / unit_b])
    end = np.clip(end, unknowns.low, unknowns.high)
    grid = across(problem.form.u, times * NODES_U), along(problem.rows, times)
    objective = FairObjective(unknowns, FairnessTable(problem, layers, *grid))
    at = objective.point(end)
    further = descend(objective, at, unknowns.low, unknowns.high, np.full(4, 0.3), 1e-4)
    return objective.j(end, at.value), np.exp(further.x - end)[[0, 2]]


def test_a_finer_grid_chooses_the_same(whole):
    # At least 97 of 100 choices within 1 %, and every measure.
    moved = []
    for k in range(33 if whole else 11):
        problem = state_problem(*random_facing(np.random.default_rng([7, k])), **FAIR).problem
        found = solve_fair(problem)
        measure, choice = refined(problem, found, 4)
        assert measure == pytest.approx(found.value, rel=0.01)
        moved.append(np.abs(choice - 1).max())
    assert sum(x > 0.01 for x in moved) <= 1


def test_refused_candidates_are_counted_by_reason():
    solution = solve_fair(state_problem(*sheets(), **FAIR).problem)
    assert set(solution.refused) == {"folds", "loops"}
    # Flat strips that overlap: far alphas reverse.
    knots = [0, 0, 1, 1]
    left = BSplineSurface(1, 1, knots, knots, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    right = BSplineSurface(1, 1, knots, knots, [[[3, 0, 0], [3, 1, 0]], [[4, 0, 0], [4, 1, 0]]])
    flat = solve_fair(state_problem(Base(left, "u1"), Base(right, "u0"), **FAIR).problem)
    # Of 36 those with both large; loops turn by 360 degrees in the plane, and these are reversed first.
    assert flat.refused["folds"] >= 4
    assert flat.tried > 36


@pytest.mark.parametrize(
    ("continuity", "searched"),
    [
        ("G1", (True, True)),
        (("G1", "G2"), (True, True)),
        (("C1", "G2"), (False, True)),
        (("G2", "G0"), (True, False)),
        (("C2", "G1"), (False, True)),
    ],
)
def test_each_side_chooses_what_its_contact_leaves(continuity, searched):
    options = FAIR | {"continuity": continuity}
    problem = state_problem(*sheets(), **options).problem
    assert problem.free == searched
    found = solve_fair(problem)
    assert found.slope < 1e-4
    for side, second, p2, value, (low, high) in zip(
        (problem.a, problem.b), problem.p2, found.p2, (found.a, found.b), problem.bounds, strict=True
    ):
        assert (p2 != 0.0) is second.free is (side.continuity == "G2")
        assert low <= value <= high


@pytest.mark.parametrize(("order", "degree"), [(3, 7), (4, 9)])
def test_higher_orders_tie_p2_to_alpha(order, degree):
    problem = state_problem(*sheets(), **(FAIR | {"continuity": f"G{order}", "degree_u": degree})).problem
    found = solve_fair(problem)
    assert found.slope < 1e-4
    assert found.p2 == pytest.approx((-order * found.a, -order * found.b), rel=1e-12)
    zero = solve_fair(
        state_problem(*sheets(), **(FAIR | {"continuity": f"G{order}", "degree_u": degree, "p2": "zero"})).problem
    )
    assert found.value < zero.value


def test_a_pipe_and_its_cap_are_not_pinched():
    result = blend(case("pipe_poly", "v1"), case("dome_poly", "v0"), **FAIR)
    points = result.surface.evaluate_grid(np.linspace(0, 1, 41), np.linspace(*result.surface.domain[1], 61))
    radius = np.linalg.norm(points[..., :2], axis=-1)
    assert radius.min() > 4.6
    assert radius.max() < 5.001
    assert not result.warnings


def test_bells_bulge_and_are_symmetric():
    low, high = case("bell_low", "u1"), case("bell_high", "u0")
    result = blend(low, high, **FAIR)
    u, v = np.linspace(0, 1, 41), np.linspace(*result.surface.domain[1], 61)
    points = result.surface.evaluate_grid(u, v)
    radius = np.linalg.norm(points[..., :2], axis=-1)
    rims = np.linalg.norm(points[[0, -1], :, :2], axis=-1)
    assert radius.min() >= rims.min() - 1e-9
    assert radius.max() > 2.3
    np.testing.assert_allclose(radius, radius[::-1], atol=1e-4)
    assert result.alpha2 == pytest.approx(result.beta2, rel=1e-3)
    assert not result.active_bounds


def test_two_pipes_of_one_radius_are_joined_by_that_pipe():
    line = BSplineCurve(3, [0] * 4 + [1] * 4, [[5, 0, z] for z in (0, 1, 2, 3)])
    pipe = revolve_polynomial(line, [0, 0, 0], [0, 0, 1], 360, 1e-6).surface
    far = transform(pipe, np.eye(3), [0, 0, 13])
    edges = [(Base(pipe, edge), Base(far, other)) for edge, other in (("u1", "u0"), ("v1", "v0"))]
    a, b = next((a, b) for a, b in edges if np.ptp(a.derivative(np.array([0.1, 0.6]), 0, 0)[:, 2]) < 1e-9)
    surface = blend(a, b, **FAIR).surface
    points = surface.evaluate_grid(np.linspace(0, 1, 31), np.linspace(*surface.domain[1], 41))
    np.testing.assert_allclose(np.linalg.norm(points[..., :2], axis=-1), 5.0, rtol=0.01)


def test_what_is_flat_takes_the_arc():
    knots = [0, 0, 1, 1]
    left = BSplineSurface(1, 1, knots, knots, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    right = BSplineSurface(1, 1, knots, knots, [[[3, 0, 0], [3, 1, 0]], [[5, 0, 0], [5, 1, 0]]])
    result = blend(Base(left, "u1"), Base(right, "u0"), **FAIR)
    # Gap 2 over speeds 1 and 2, and the arc of a straight way is its chord.
    assert (result.alpha2, result.beta2) == pytest.approx((2.0, 1.0), rel=1e-4)
    assert result.objective.value == pytest.approx(0.0, abs=1e-9)


def test_the_real_pair_turns_evenly():
    result = blend(*impeller_pair(), **FAIR)
    assert measure_turn(result.surface).degrees < 15
    assert not result.warnings


def same_points(one, two, u, v, **tolerance):
    np.testing.assert_allclose(one.evaluate_grid(u, v), two, **tolerance)


def test_units_place_order_and_parameters_do_not_matter():
    a, b = sheets()
    first = blend(a, b, **FAIR)
    u, v = np.linspace(0, 1, 9), np.linspace(0, 1, 7)
    points = first.surface.evaluate_grid(u, v)
    again = blend(a, b, **FAIR)
    np.testing.assert_array_equal(again.surface.evaluate_grid(u, v), points)
    scaled = [Base(transform(base.surface, 1e3 * np.eye(3)), base.edge) for base in (a, b)]
    same_points(blend(*scaled, **FAIR).surface, 1e3 * points, u, v, rtol=0, atol=1e-5 * 1e3)
    moved = [Base(transform(base.surface, np.eye(3), [1e3, 0, 0]), base.edge) for base in (a, b)]
    same_points(blend(*moved, **FAIR).surface, points + np.array([1e3, 0, 0]), u, v, rtol=0, atol=1e-5)
    swapped = blend(b, a, **FAIR)
    assert not swapped.flipped
    same_points(swapped.surface, points[::-1], u, v, rtol=0, atol=1e-5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "casadi"}, "alpha: found fair with method casadi, which minimises"),
        ({"method": "bfgs"}, "alpha: found fair with method bfgs"),
        ({"alpha": ("fair", "energy")}, "alpha: found fair with alpha energy, which minimises"),
    ],
)
def test_fair_is_for_the_reduced_method(options, message):
    with pytest.raises(OptionError, match=message):
        blend(*sheets(), **(FAIR | options))


@pytest.mark.parametrize("seed", [0, 4])
def test_where_every_candidate_folds_the_fairest_is_taken_and_says_so(seed):
    # Random control points: waves that no blend can follow without sharp turns of its own.
    pair = facing_pair(np.random.default_rng(seed), edges=("u0", "u0"), backwards=(False, False))
    with pytest.raises(ComputationError, match=r"no candidate is left: .* fold; try another edge"):
        fair_search._solved(state_problem(*pair).problem, (FOLDS, LOOPS), None)
    result, energy = blend(*pair), blend(*pair, alpha="energy")
    assert "these were all, so that folds were let pass" in result.objective.known
    assert result.shape.fairness.value < 0.7 * energy.shape.fairness.value
    # What the finished surface does is measured and said, whatever the search let pass.
    assert any("folds" in text or "steeply" in text for text in result.warnings) == (result.shape.turn.degrees > 60)
    assert not any("alpha fair" in text for text in result.warnings)
    # The quartic was tried as well.
    assert [c.degree_u for c in result.candidates][:2] == [5, 4]


def test_a_search_that_is_stopped_by_a_refusal_says_by_which():
    problem = state_problem(*(getattr(open_pair("rough", 13), side) for side in "ab")).problem
    stopped, free = solve_fair(problem), solve_fair(state_problem(*sheets()).problem)
    assert (stopped.stopped_by, free.stopped_by) == ("loop", "")
    # There its slope is still steep; where nothing is refused the search goes on.
    assert stopped.slope > 0.1
    further = fair_search._solved(problem, (), None)
    assert further.value < stopped.value
    known = found_fair(stopped, "reduced").known
    assert "; it ended beside a loop, which is refused" in known
    assert "it ended beside a fold" in found_fair(replace(stopped, stopped_by="fold"), "reduced").known
    assert "it ended" not in found_fair(free, "reduced").known


@pytest.mark.parametrize(
    ("ratio", "is_u_turn", "cells"),
    [
        (2.0, False, 6),
        (16.0, False, 6),
        (16.000000000000004, False, 6),
        (32.0, False, 7),
        (64.0, False, 8),
        (400.0, False, 11),
        (1e30, False, 30),
        (16.0, True, 8),
        (64.0, True, 8),
        (256.0, True, 10),
    ],
)
def test_cells_of_the_scan_keep_their_size(ratio, is_u_turn, cells):
    bounds = ((1.0, 1.0), (0.3, 0.3 * ratio))
    assert fair_search._cells(SimpleNamespace(bounds=bounds, exits=SimpleNamespace(u_turn=is_u_turn))) == cells


def test_what_is_known_is_kept_where_every_cell_folds(monkeypatch):
    problem = state_problem(*sheets(), **FAIR).problem
    known = solve_fair(problem)
    scan = fair_search._scan

    def folded(*words):
        cells, values = scan(*words)
        return cells, np.full_like(values, np.inf)

    monkeypatch.setattr(fair_search, "_scan", folded)
    again = solve_fair(problem, known)
    assert again.condoned == ()
    assert again.value == pytest.approx(known.value, rel=1e-6)
    with pytest.raises(ComputationError, match="no candidate is left"):
        solve_fair(problem)


def test_what_is_known_goes_to_the_fine_grid_alone(monkeypatch):
    problem = state_problem(*sheets(), **FAIR).problem
    known = solve_fair(problem)
    gone, refined = [], fair_search._refined

    def watched(end, start, levels):
        gone.append((end, start, len(levels)))
        return refined(end, start, levels)

    monkeypatch.setattr(fair_search, "_refined", watched)
    monkeypatch.setattr(fair_search, "_LARGE", 0)
    solve_fair(problem, known)
    # As it is, where others come down from a rough grid over one between.
    assert [levels for end, start, levels in gone if end.x is start] == [1]
    solve_fair(problem)
    assert gone[-1][2] == 2


def test_a_candidate_that_passes_comes_before_a_fairer_one_that_was_let_pass():
    solutions = [
        FairSolution(1.0, 1.0, (0.0, 0.0), value, 0.0, 1, {}, condoned)
        for value, condoned in ((1.0, ("folds",)), (9.0, ()))
    ]
    layouts = [Layout(BlendOptions(), None, Found(1.0, 1.0, "reduced", fair=one)) for one in solutions]
    assert _fairer(*layouts) is layouts[1]


def test_a_given_alpha_stays_and_a_box_replaces_the_window():
    a, b = sheets()
    one = blend(a, b, **(FAIR | {"alpha": (0.9, "fair")}))
    assert one.alpha2 == pytest.approx(0.81, rel=1e-12)
    assert one.p2[0] == 0.0
    narrow = blend(a, b, **FAIR, box=(1.3, 1.4))
    assert narrow.active_bounds == ("alpha2 lower", "beta2 lower")
    assert any("at its lower bound" in text for text in narrow.warnings)


@pytest.fixture(scope="module")
def narrow_pair():
    """Quartic bases with knots far from uniform: two nodes on each span see a twentieth of J."""
    return case("narrow-spans-a", "u1"), case("narrow-spans-b", "u0")


def test_where_spans_are_narrow_the_grid_is_refined_until_it_settles(narrow_pair):
    found = solve_fair(state_problem(*narrow_pair, **FAIR, continuity="G1").problem)
    assert found.settled
    result = blend(*narrow_pair, continuity="G1", middle_curves=0)
    # Measured by the judge. The blind search stopped at 25 000.
    assert result.shape.fairness.value < 20_000
    assert result.objective.value == pytest.approx(result.shape.fairness.value, rel=0.02)
    assert "not settled" not in result.objective.known
    assert not [w for w in result.warnings if "was minimised" in w]


def test_what_does_not_settle_is_said(narrow_pair, monkeypatch):
    # With the first of the finer grids alone.
    monkeypatch.setattr(fair_search, "_MOST", 1)
    result = blend(*narrow_pair, continuity="G1")
    assert "not settled" in result.objective.known
    (said,) = [w for w in result.warnings if "was minimised" in w]
    assert f"{result.objective.value:.3g}" in said
    assert f"{result.shape.fairness.value:.3g}" in said


@dataclass
class Wells:
    """A stand-in for a grid: two wells, at -1 and 1, of given depths."""

    left: float
    right: float
    table = SimpleNamespace(size=100, refusable=(FOLDS, LOOPS))
    unknowns = SimpleNamespace(logarithmic=np.array([True]), low=np.array([-3.0]), high=np.array([3.0]))

    def __call__(self, x):
        side = np.sign(x[0])
        return float((self.right if side > 0 else self.left) + (x[0] - side) ** 2), 2 * (x - side)

    def values(self, x):
        return np.array([self(y)[0] for y in x])

    def point(self, x):
        return Point(x, *self(x), 2 * np.eye(1))

    def at(self, point):
        return self.point(point.x)


@pytest.mark.parametrize(
    ("right", "end"),
    # Within a fifth the search goes on where it is; past that the other well is looked at, which is lower.
    [(0.005, 1.0), (0.19, 1.0), (0.21, -1.0)],
)
def test_a_coarse_grid_that_was_blind_is_ranked_anew(right, end):
    found = Wells(0.1, 0.0).point(np.array([1.0]))
    made = []

    def finer(times):
        made.append(times)
        return Wells(0.1, right)

    at, settled = fair_search._settled(found, np.array([1.1]), finer, np.array([[-1.1], [1.1]]))
    assert at.x == pytest.approx([end], abs=1e-3)
    assert at.value == pytest.approx(min(right, 0.1 if end < 0 else right), abs=1e-6)
    assert settled
    assert made == ([2] if right == 0.005 else [2, 4])


def test_grids_that_never_agree_do_not_settle():
    made = []

    def finer(times):
        made.append(times)
        return Wells(9.0, float(times))

    at, settled = fair_search._settled(
        Wells(9.0, 0.0).point(np.array([1.0])), np.array([1.1]), finer, np.array([[1.1]])
    )
    assert not settled
    assert made == [2, 4, 8, 16]
    assert at.value == pytest.approx(16.0)


@pytest.mark.parametrize(
    ("minimised", "measured", "warned"),
    [(100, 109, False), (100, 111, True), (111, 100, True), (0.09, 5, False), (5, 0.09, False), (None, 5, False)],
)
def test_the_limits_of_the_warning(minimised, measured, warned):
    assert bool(fairness_warning(minimised, measured)) is warned


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"degree_u": 2, "middle_curves": 0}, "degree_u"),
        ({"degree_u": 3, "middle_curves": 0, "u_knots": (0.5, 0.5)}, "u_knots"),
    ],
)
def test_curvature_that_jumps_across_is_not_searched(options, name):
    with pytest.raises(OptionError, match=f"^{name}: the fairest shape .* or alpha energy"):
        blend(*sheets(), alpha="fair", **options)
    # Only where it is searched.
    for alpha in ("natural", 1.0, "energy"):
        assert blend(*sheets(), alpha=alpha, **options).surface is not None


def near_double(apart):
    """A sheet with two knots so far apart in the middle of its edge, and a smooth one."""
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    x, y = np.mgrid[0:1:4j, 0:1:6j]
    first = BSplineSurface(
        3, 3, knots, [0, 0, 0, 0, 0.5, 0.5 + apart, 1, 1, 1, 1], np.dstack([x, y, 0.1 * np.sin(5 * y) * x])
    )
    x, y = np.mgrid[0:1:4j, 0:1:4j]
    return Base(first, "u1"), Base(BSplineSurface(3, 3, knots, knots, np.dstack([x + 1.5, y, 0.3 + 0.1 * x**2])), "u0")


@pytest.mark.parametrize("exponent", [3, 4, 5, 6, 7, 8, 9, 10, 11, 12])
def test_nearly_double_knots_choose_what_double_ones_do(exponent):
    double, near = blend(*near_double(0.0), **FAIR), blend(*near_double(10.0**-exponent), **FAIR)
    assert double.shape.fairness.jumps > 0.01 * double.shape.fairness.value
    assert (near.alpha2, near.beta2) == pytest.approx((double.alpha2, double.beta2), rel=0.02)
    for value in (near.shape.fairness.value, near.objective.value):
        assert value == pytest.approx(double.shape.fairness.value, rel=0.05)


def test_double_knots_of_degree_four_are_searched():
    assert blend(*sheets(), alpha="fair", degree_u=4, middle_curves=1, u_knots=(0.5, 0.5)).objective.value > 0
