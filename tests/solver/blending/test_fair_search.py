"""The search for the fairest shape: what it starts from, what it refuses, and where it ends."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.bases import facing_pair
from helpers.sheets import FAIR, QUINTIC, sheets
from helpers.sweeps import first_ones
from semispline import (
    Base,
    BlendOptions,
    BSplineSurface,
    ComputationError,
    OptionError,
    blend,
)
from semispline.papers.reproduction.families.open_pairs import open_pair
from semispline.solver.blending import fair_search
from semispline.solver.blending.candidates import Layout, _fairer
from semispline.solver.blending.fair_search import FairSolution, solve_fair
from semispline.solver.blending.fairness_grid import NODES_U, across, along
from semispline.solver.blending.fairness_table import FOLDS, LOOPS, FairnessTable
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.shape_parameters import Found, found_fair


def tables(pair, times=1, nodes_u=NODES_U, **options):
    """The problem of a pair and its table; monomials are 1, p2, a, a^2 of side a; p2, b, b^2 of side b."""
    problem = state_problem(*pair, **(QUINTIC | {"alpha": "fair"} | options)).problem
    layers, exponents = problem.shape_layers()
    grid = across(problem.form.u, times * nodes_u), along(problem.rows, times)
    return problem, FairnessTable(problem, layers, *grid), exponents


def j(table, monomials):
    """J of one candidate."""
    return float(table.measure(np.array(monomials)[None]).values[0])


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


@pytest.mark.parametrize("seed", first_ones(1, [0, 4]))
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


def test_beside_what_is_known_only_better_starts_are_followed():
    grid = SimpleNamespace(values=lambda y: np.abs(y[:, 0]))
    starts = [np.array([x]) for x in (3.0, -0.5, 1.0, 0.25, np.inf)]
    assert fair_search._better(grid, starts, np.array([1.0])) == [starts[1], starts[3]]
    assert fair_search._better(grid, [], np.array([1.0])) == []
    # Where it is refused itself, all that are not.
    assert fair_search._better(grid, starts, np.array([np.inf])) == starts[:4]


@pytest.mark.parametrize("condoned", [(), ("folds",)])
def test_what_was_let_pass_is_no_reason_to_follow_fewer_starts(monkeypatch, condoned):
    problem = state_problem(*sheets(), **FAIR).problem
    known = replace(solve_fair(problem), condoned=condoned)
    asked = []
    monkeypatch.setattr(fair_search, "_better", lambda grid, starts, than: asked.append(than) or starts)
    solve_fair(problem, known)
    assert len(asked) == (not condoned)


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


def test_double_knots_of_degree_four_are_searched():
    assert blend(*sheets(), alpha="fair", degree_u=4, middle_curves=1, u_knots=(0.5, 0.5)).objective.value > 0
