"""Figures of the search and of the pipeline that a blend hardly shows: each by itself, from both sides."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from semispline import Base, BSplineSurface, ComputationError, ContactError, EdgeError, InputError, OptionError, blend
from semispline.solver.blending import fair_search, pipeline
from semispline.solver.blending.fairness_grid import across
from semispline.solver.blending.fairness_table import FOLDS, LOOPS
from semispline.solver.blending.layout import blend_u_basis
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.projected import Point
from semispline.solver.splines import clamped

LINE = [0.0, 0.0, 1.0, 1.0]


def strip(x, width=1.0, z=0.0):
    """A flat strip from x on, one long."""
    return BSplineSurface(1, 1, LINE, LINE, [[[at, y, z] for y in (0, 1)] for at in (x, x + width)])


def strips(edge_a="u1", edge_b="u0"):
    """Two strips, 2 apart."""
    return Base(strip(0), edge_a), Base(strip(3, z=0.5), edge_b)


def test_the_three_lowest_wells_are_starts_and_the_lowest_comes_first():
    values = np.array([[9, 3, 9, 1, 9, 2, 9, 0, 9.0]])
    cells = np.arange(9.0)[:, None]
    assert fair_search._starts(cells, values)[:, 0].tolist() == [7, 3, 5]
    # Of wells that are equally deep the first ones.
    assert fair_search._starts(cells, np.minimum(values, 3.5) // 3)[:, 0].tolist() == [3, 5, 7]


@pytest.mark.parametrize(
    ("edges", "cells", "nodes"), [(("u1", "u0"), 6, 20), (("u0", "u1"), 8, 40)], ids=["facing", "U-turn"]
)
def test_u_turns_are_scanned_in_more_cells_and_places(monkeypatch, edges, cells, nodes):
    class EnoughError(Exception):
        pass

    def scan(objective, count):
        raise EnoughError(count, len(objective.table.across.weights), objective.table.least_cosine)

    monkeypatch.setattr(fair_search, "_scan", scan)
    with pytest.raises(EnoughError) as asked:
        fair_search.solve_fair(state_problem(*strips(*edges)).problem)
    # There normals of neighbours may turn by a right angle.
    assert asked.value.args == (cells, nodes, 0.0)


@pytest.mark.parametrize(("less", "chosen"), [(0.0, 0), (0.0009, 0), (0.0011, 1), (-1.0, 0), (1.0, 1), (np.inf, 0)])
def test_blends_that_turn_alike_to_a_thousandth_of_a_degree_turn_equally(monkeypatch, less, chosen):
    def turn(degrees):
        if degrees == -np.inf:
            raise InputError("no tangent plane")
        return SimpleNamespace(degrees=degrees)

    monkeypatch.setattr(pipeline, "measure_turn", turn)
    solved = [SimpleNamespace(surface=degrees) for degrees in (30, 30 - less)]
    assert pipeline._least_turning(solved) is solved[chosen]


@pytest.mark.parametrize("continuity", [("G0", "G1"), ("G1", "C0"), ("G1", "C1"), ("C1", "G1"), ("C0", "G0")])
def test_a_side_without_a_tangent_has_no_shape_parameter(continuity):
    result = blend(*strips(), continuity=continuity, alpha="natural")
    for value, wanted in zip((result.alpha2, result.beta2), continuity, strict=True):
        if wanted[1] == "0":
            assert value is None
        else:
            assert value == pytest.approx(1.0 if wanted == "C1" else np.sqrt(4.25), rel=1e-12)


def refused_beyond(limit):
    """A stand-in for a grid that refuses what is below a limit, and the places that it was asked for."""
    places = []

    def at(point):
        places.append(point.x[0])
        return replace(point, value=0.0 if point.x[0] >= limit else np.inf)

    return SimpleNamespace(at=at), places


@pytest.mark.parametrize(("limit", "tried"), [(-1.0, 1), (0.01, 2), (0.3, 6), (0.95, 8), (2.0, 8)])
def test_what_a_finer_grid_refuses_goes_back_towards_its_start(limit, tried):
    # From 0 to the start at 1.
    grid, places = refused_beyond(limit)
    end = Point(np.zeros(1), 5.0, np.zeros(1), np.eye(1))
    found = fair_search._admitted(grid, end, np.ones(1))
    assert places == pytest.approx([0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0][:tried])
    assert (found is None) is (limit > 1)


def test_steps_are_at_most_a_third_of_alpha_and_twice_the_size_of_p2(monkeypatch):
    asked = []
    monkeypatch.setattr(fair_search, "descend", lambda *words: asked.append(words))
    unknowns = SimpleNamespace(logarithmic=np.array([True, False]), low=np.zeros(2), high=np.ones(2))
    grid = SimpleNamespace(unknowns=unknowns, table=SimpleNamespace(refusable=(FOLDS, LOOPS)))
    fair_search._descended(grid, "start", 0.5)
    ((function, start, low, high, longest, tolerance, most),) = asked
    assert most == 60
    assert (function, start, tolerance) == (grid, "start", 0.5)
    assert longest.tolist() == [0.35, 2.0]
    assert low.tolist() == [0, 0]
    assert high.tolist() == [1, 1]


def test_where_folds_are_let_pass_there_are_at_most_12_steps(monkeypatch):
    asked = []
    monkeypatch.setattr(fair_search, "descend", lambda *words: asked.append(words[-1]))
    unknowns = SimpleNamespace(logarithmic=np.array([True]), low=np.zeros(1), high=np.ones(1))
    for refusable in ((LOOPS,), ()):
        grid = SimpleNamespace(unknowns=unknowns, table=SimpleNamespace(refusable=refusable))
        fair_search._descended(grid, "start", 0.5)
    assert asked == [12, 12]


@pytest.mark.parametrize(
    ("spans", "across_and_between"), [(1, [20, 40, 80]), (25, [20, 40, 80]), (26, [20, 40, 20, 80])]
)
def test_a_grid_of_more_than_2000_nodes_has_one_between(monkeypatch, spans, across_and_between):
    asked, tolerances, cosines = [], [], []

    def told(u, count):
        asked.append(count)
        return across(u, count)

    def descended(objective, start, tolerance):
        tolerances.append(tolerance)
        cosines.append(objective.table.least_cosine)
        return start

    def abreast(objective, starts, tolerance):
        return [descended(objective, start, tolerance) for start in starts]

    monkeypatch.setattr(fair_search, "across", told)
    monkeypatch.setattr(fair_search, "_descended", descended)
    monkeypatch.setattr(fair_search, "_descended_abreast", abreast)
    # Smooth rows: no line is crossed.
    knots = clamped(np.arange(1, spans) / spans, 3, 0.0, 1.0)
    y = [knots[i : i + 3].mean() for i in range(1, spans + 4)]
    a, b = (
        Base(BSplineSurface(1, 3, LINE, knots, [[[at, place, 0] for place in y] for at in (x, x + 1)]), edge)
        for x, edge in ((0, "u1"), (3, "u0"))
    )
    fair_search.solve_fair(state_problem(a, b).problem)
    assert asked == across_and_between
    # Each start roughly, on each grid but the last roughly as well, then to the end.
    assert tolerances == [0.02] * (len(tolerances) - 1) + [1e-4]
    assert len(tolerances) == len(asked) - 1
    # Normals of neighbours may turn by 60 degrees, and for a rough look by 90.
    assert cosines == [0.0] + [0.5] * (len(cosines) - 1)


@dataclass
class Large:
    """A stand-in for a grid of so many nodes, on which nothing ever settles."""

    size: int
    value: float

    @property
    def table(self):
        return SimpleNamespace(size=self.size, refusable=(FOLDS, LOOPS))

    unknowns = SimpleNamespace(logarithmic=np.array([True]), low=np.array([0.0]), high=np.array([0.0]))

    def values(self, x):
        return np.full(len(x), self.value)

    def at(self, point):
        return replace(point, value=self.value)

    def point(self, x):
        return Point(x, self.value, np.zeros(1), np.eye(1))


@pytest.mark.parametrize(("size", "grids"), [(100, 4), (29_999, 4), (30_000, 4), (30_001, 1), (40_000, 1)])
def test_a_grid_that_would_have_more_than_60000_nodes_is_not_gone_to(size, grids):
    made = []

    def finer(times):
        made.append(times)
        return Large(size, float(times))

    start = Point(np.zeros(1), 0.0, np.zeros(1), np.eye(1))
    _, settled = fair_search._settled(start, np.zeros(1), finer, np.zeros((1, 1)))
    assert not settled
    assert made == [2, 4, 8, 16][:grids]


@pytest.mark.parametrize(
    ("y", "at_end"),
    [(0.0, True), (0.9e-9, True), (1.1e-9, False), (0.5, False), (1 - 1.1e-9, False), (1 - 0.9e-9, True), (1.0, True)],
)
def test_a_billionth_from_an_end_of_its_window_is_at_the_end(y, at_end):
    unknowns = SimpleNamespace(ends=(slice(0, 1), slice(1, 2)), low=np.array([0.0, 0.5]), high=np.array([1.0, 0.5]))
    assert fair_search._is_at_end(unknowns, np.array([y, 0.5]), 0) is at_end
    # Without a window there is no end.
    assert fair_search._is_at_end(unknowns, np.array([y, 0.5]), 1) is False


class Wells:
    """A stand-in for an objective with two wells; a rough look takes the wrong one for the deeper."""

    def __init__(self, unknowns, table):
        self.unknowns, self.table, self.tried = unknowns, table, 0
        self.refused = {"folds": 0, "loops": 0}
        self.depths = (1.0, 0.5) if table.least_cosine == 0 else (0.5, 1.0)

    def values(self, y):
        left, right = ((y[:, 0] - side) ** 2 - depth for side, depth in zip((-1.1, 1.1), self.depths, strict=True))
        return np.minimum(left, right) + y[:, 2] ** 2

    def point(self, y):
        return Point(y, float(self.values(y[None])[0]), np.zeros(len(y)), np.eye(len(y)))

    def at(self, point):
        return self.point(point.x)


def test_of_the_ends_of_two_starts_the_finer_grid_says_which_is_best(monkeypatch):
    found = []
    monkeypatch.setattr(fair_search, "FairObjective", Wells)
    for name in ("_descended", "_descended_abreast"):
        monkeypatch.setattr(fair_search, name, lambda objective, start, tolerance: start)

    def solution(problem, unknowns, point, *_):
        found.append(point.x)
        return fair_search.FairSolution(1.0, 1.0, (0.0, 0.0), 0.0, 0.0, 1, {})

    monkeypatch.setattr(fair_search, "_solution", solution)
    fair_search.solve_fair(state_problem(*strips()).problem)
    assert found[0][0] > 1


@pytest.mark.parametrize(("settled_at", "is_taken"), [(0.9, True), (1.1, False)])
def test_what_is_known_is_taken_where_what_looked_better_ends_worse(monkeypatch, settled_at, is_taken):
    found = []

    def known_start(problem, unknowns, known):
        return unknowns.high.copy()

    def settled(at, start, *_):
        return replace(at, value=settled_at if start[0] > 1.3 else 1.0), True

    def solution(problem, unknowns, point, *_):
        found.append(point)
        return known

    known = fair_search.FairSolution(1.0, 1.0, (0.0, 0.0), 0.0, 0.0, 1, {})
    for name, stub in {
        "FairObjective": Wells,
        "_descended": lambda objective, start, tolerance: start,
        "_descended_abreast": lambda objective, starts, tolerance: starts,
        "_refined": lambda end, start, levels: end,
        "_known_start": known_start,
        "_settled": settled,
        "_solution": solution,
    }.items():
        monkeypatch.setattr(fair_search, name, stub)
    fair_search.solve_fair(state_problem(*strips()).problem, known)
    assert bool(found[0].x[0] > 1.3) is is_taken
    assert found[0].value == (settled_at if is_taken else 1.0)


@pytest.mark.parametrize(("orders", "least", "most"), [((2, 2), 2, 5), ((1, 0), 2, 5), ((3, 2), 4, 6), ((4, 4), 5, 9)])
def test_a_degree_that_does_not_fit_is_told_what_would(orders, least, most):
    for degree in (1, most + 1):
        with pytest.raises(OptionError, match=rf"degree_u: found {degree}, expected {least} to {most} with 0 middle"):
            blend_u_basis(degree, 0, None, orders)
    assert blend_u_basis(most, 0, None, orders).degree == most


def tied(monkeypatch, judged):
    """Let both directions be tried, and the twisted one turn less; `judged` takes the place of what is checked."""
    monkeypatch.setattr(pipeline, "_tied", lambda a, b, flip: ("no", "yes"))
    monkeypatch.setattr(pipeline, "_least_turning", lambda solved: solved[-1])
    monkeypatch.setattr(pipeline, "_judged", judged)


@pytest.mark.long
def test_where_two_directions_tie_only_the_less_turning_one_is_judged(monkeypatch):
    assert not blend(*strips()).flipped
    assert not state_problem(*strips()).matched.flipped
    judge, directions = pipeline._judged, []

    def judged(stated, solved, seconds):
        directions.append(solved.flip)
        return judge(stated, solved, seconds)

    tied(monkeypatch, judged)
    assert blend(*strips()).flipped
    assert directions == ["yes"]
    assert state_problem(*strips()).matched.flipped


def test_the_direction_that_is_refused_makes_room_for_the_other(monkeypatch):
    judge = pipeline._judged

    def judged(stated, solved, seconds, refused=("yes",)):
        if solved.flip in refused:
            raise ContactError(solved.flip)
        return judge(stated, solved, seconds)

    tied(monkeypatch, judged)
    assert not blend(*strips()).flipped
    monkeypatch.setattr(pipeline, "_judged", lambda *arguments: judged(*arguments, ("no", "yes")))
    with pytest.raises(ContactError, match=r"^no$"):
        blend(*strips())


def test_seconds_are_those_of_all_directions_that_were_tried(monkeypatch):
    """By a clock that only solving moves: by a second for each direction."""
    ticks, solve = [0.0], pipeline._solved

    def solved(*arguments):
        ticks[0] += 1.0
        if arguments[-1] == refused:
            raise ComputationError("refused")
        return solve(*arguments)

    refused = "none"
    monkeypatch.setattr(pipeline, "_solved", solved)
    monkeypatch.setattr(pipeline.time, "perf_counter", lambda: ticks[0])
    assert blend(*strips(), flip="no").seconds == 1.0
    tied(monkeypatch, pipeline._judged)
    assert blend(*strips()).seconds == 2.0
    refused = "yes"
    assert blend(*strips()).seconds == 2.0


@pytest.mark.parametrize("continuity", ["C0", "G0"])
def test_for_position_alone_a_base_need_not_leave_its_edge(continuity):
    still = BSplineSurface(1, 1, LINE, LINE, [[[0, y, 0] for y in (0, 1)]] * 2)
    pair = Base(still, "u1"), Base(strip(3), "u0")
    assert state_problem(*pair, continuity=(continuity, "G1")).problem.natural[0] == 1.0
    with pytest.raises(EdgeError, match="base a: the cross derivative vanishes"):
        state_problem(*pair, continuity="G1")
