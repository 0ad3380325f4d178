"""How many nodes a fair search takes, where, and the windows that it searches: known numbers."""

import numpy as np
import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending import fair_search
from semispline.solver.blending.fairness_grid import across, along, rough_along
from semispline.solver.blending.fairness_table import FairnessTable
from semispline.solver.blending.linear_problem import gap_ratio, with_linear_alpha
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.splines import Basis

LINE = [0.0, 0.0, 1.0, 1.0]


def spans(count, degree=3):
    return Basis(degree, np.concatenate([np.zeros(degree), np.linspace(0, 1, count + 1), np.ones(degree)]))


@pytest.mark.parametrize(
    ("count", "nodes", "rough"),
    # Two on each span, ten altogether; for a rough look two on each of at most six, six altogether.
    [(1, 10, 6), (2, 10, 6), (3, 12, 6), (4, 12, 8), (5, 10, 10), (6, 12, 12), (7, 14, 12), (40, 80, 12)],
)
def test_nodes_along(count, nodes, rough):
    row = spans(count)
    assert along((row,)).nodes.size == nodes
    assert along((row, spans(1)), 2).nodes.size == 2 * nodes
    assert rough_along((row,)).nodes.size == rough
    for grid in (along((row,)), rough_along((row,))):
        assert grid.weights.sum() == pytest.approx(1, rel=1e-12)
        assert np.sum(grid.weights * grid.nodes**3) == pytest.approx(1 / 4, rel=1e-12)


@pytest.mark.parametrize(("count", "nodes"), [(1, 40), (2, 40), (3, 42), (7, 42), (50, 50)])
def test_nodes_across(count, nodes):
    grid = across(spans(count), 40)
    assert len(grid.weights) == nodes
    assert grid.weights.sum() == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(("width", "is_line"), [(0.0165, True), (0.0168, False)])
def test_a_span_is_narrow_below_a_twentieth_of_the_mean_one(width, is_line):
    # Three spans: the mean one is a third.
    row = Basis(3, np.array([0, 0, 0, 0, 0.5, 0.5 + width, 1, 1, 1, 1]))
    assert along((row,), 1, 0.1).lines.shape[1] == is_line


def strip(x, z=0.0, widening=0.0):
    """A flat strip from x on, one long; its edges turn away along it."""
    return BSplineSurface(1, 1, LINE, LINE, [[[at + widening * y, y, z] for y in (0, 1)] for at in (x, x + 1)])


def strips(edge_a="u1", edge_b="u0", widening=0.0):
    """Two strips, 2 apart at the start of v."""
    return Base(strip(0), edge_a), Base(strip(3, 0.0, widening), edge_b)


@pytest.mark.parametrize(
    ("edges", "options", "low", "high"),
    [
        (("u1", "u0"), {"alpha": "energy"}, 1 / 8, 8),
        (("u1", "u0"), {"alpha": "energy", "box": (0.5, 3)}, 0.5, 3),
        (("u1", "u0"), {"alpha": "fair"}, 1 / 4, 4),
        (("u1", "u0"), {"alpha": "fair", "box": (0.5, 3)}, 0.5, 3),
        (("u1", "u0"), {"alpha": "fair", "continuity": "G1"}, 1 / 4, 4),
        (("u1", "u0"), {"alpha": "fair", "continuity": "G3", "degree_u": 7}, 1 / 8, 2),
        (("u1", "u0"), {"alpha": "fair", "continuity": "G4", "degree_u": 9}, 1 / 8, 2),
        # Leaving backwards, by more than 150 degrees: arcs of 150.
        (("u0", "u1"), {"alpha": "fair"}, 1 / 4, 16),
    ],
)
def test_the_windows_of_alpha(edges, options, low, high):
    problem = state_problem(*strips(*edges), **options).problem
    gap, arc = (2.0, 1.0) if edges == ("u1", "u0") else (4.0, 2 * np.radians(150))
    for natural, found in zip(problem.natural, problem.bounds, strict=True):
        assert natural == pytest.approx(gap)
        assert found == pytest.approx((low * gap * arc, high * gap * arc), rel=1e-12)


@pytest.mark.parametrize(
    ("ratio", "shape"),
    # A gap that runs from 2 to 2 r: over its mean from 2 / (1 + r) to 2 r / (1 + r), a quarter at the least.
    [(1.0, (1.0, 1.0)), (3.0, (0.5, 1.5)), (6.9, (2 / 7.9, 13.8 / 7.9)), (9.0, (0.25, 1.8)), (1 / 9, (1.8, 0.25))],
)
def test_windows_of_a_linear_alpha_follow_the_gap_and_are_twice_as_wide(ratio, shape):
    problem = state_problem(*strips(widening=2 * ratio - 2)).problem
    # The other end of the strips leaves the bases as fast: speeds are 1.
    assert gap_ratio(problem) == pytest.approx(max(ratio, 1 / ratio), rel=1e-9)
    mean = 1 + ratio
    for ends in with_linear_alpha(problem).linear:
        assert ends.shape == pytest.approx(shape, rel=1e-9)
        for bounds, part in zip(ends.bounds, shape, strict=True):
            arc = problem.exits.arc
            assert bounds == pytest.approx((part * mean * arc / 8, part * mean * arc * 8), rel=1e-9)


@pytest.mark.parametrize(
    ("continuity", "degree", "nodes"), [("G1", 5, 40), ("G2", 5, 40), (("G2", "G3"), 6, 48), ("G4", 9, 48)]
)
def test_contact_of_high_order_takes_more_nodes_across(monkeypatch, continuity, degree, nodes):
    asked = []

    def told(u, count):
        asked.append(count)
        return across(u, count)

    monkeypatch.setattr(fair_search, "across", told)
    monkeypatch.setattr(fair_search, "_descended", lambda objective, start, tolerance: start)
    problem = state_problem(*strips(), continuity=continuity, degree_u=degree, middle_curves=0, alpha="fair").problem
    assert fair_search.solve_fair(problem).value == pytest.approx(0, abs=1e-9)
    # A rough look, the search, and half as fine again.
    assert asked == [20, nodes, 2 * nodes]


def test_a_cluster_among_narrow_spans_is_found_at_every_tenth():
    # Twenty spans of 0.002, together too wide for one cluster, and a narrower one among them.
    inner = np.sort([*(0.5 + 0.002 * np.arange(21)), 0.51005])
    row = Basis(3, np.concatenate([np.zeros(4), inner, np.ones(4)]))
    assert along((row,), 1, 0.02).lines.T.tolist() == [pytest.approx([0.51, 0.51005])]


def test_unless_it_is_asked_for_no_span_is_narrow():
    row = Basis(3, np.array([0, 0, 0, 0, 0.5, 0.5001, 1, 1, 1, 1]))
    assert along((row,)).lines.size == 0
    for grid in (along((row,)), rough_along((row,))):
        assert grid.weights.sum() == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(
    ("degrees", "inner", "is_line"),
    [
        # Where some row is C1 or less: degree less multiplicity is 1.
        ((3, 3), (0.5,), False),
        ((2, 3), (0.5,), True),
        ((1, 3), (0.5,), True),
        ((3, 3), (0.5, 0.5), True),
        ((4, 3), (0.5, 0.5), False),
        ((4, 3), (0.5, 0.5, 0.5), True),
    ],
)
def test_lines_across_which_curvature_may_jump(degrees, inner, is_line):
    rows = tuple(
        Basis(degree, np.array([0.0] * (degree + 1) + list(knots) + [1.0] * (degree + 1)))
        for degree, knots in zip(degrees, (inner, ()), strict=True)
    )
    assert along(rows).lines.shape[1] == is_line


def test_a_row_without_the_knot_makes_no_line():
    rows = (spans(1, degree=1), spans(2, degree=3))
    assert along(rows).lines.size == 0
    assert along((spans(2, degree=1), spans(1, degree=3))).lines.T.tolist() == [[0.5, 0.5]]


@pytest.mark.parametrize(
    ("continuity", "is_kept"), [("G1", True), (("G2", "C1"), True), (("G0", "G1"), False), (("G1", "C0"), False)]
)
def test_the_turn_that_exits_need_is_kept_where_no_candidate_changes_them(continuity, is_kept):
    problem = state_problem(*strips(), continuity=continuity, alpha="fair").problem
    layers, _ = problem.shape_layers()
    table = FairnessTable(problem, layers, across(problem.form.u, 40), along(problem.rows))
    assert table.least_cosine == 0.5
    table.measure(np.ones((3, len(layers))))
    assert (table._needed is not None) is is_kept
