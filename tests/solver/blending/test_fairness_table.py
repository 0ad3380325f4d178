"""The table of a fair search: J, its gradient, what is refused, and how many nodes it takes."""

import numpy as np
import pytest

from helpers.facing import random_facing
from helpers.sheets import sheets
from semispline import Base, BSplineSurface, blend
from semispline.solver.blending import fairness_table
from semispline.solver.blending.fair_search import solve_fair
from semispline.solver.blending.fairness_grid import NODES_U, across, along, rough_along
from semispline.solver.blending.fairness_table import FOLDS, LOOPS, FairnessTable, narrow_width
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.blending.refusals import needed_turn, turned
from semispline.solver.splines import Basis

QUINTIC = {"degree_u": 5, "middle_curves": 0, "alpha": "fair"}


def table_of(pair, *, nodes_u=NODES_U, times=1, least_cosine=0.5, **options):
    problem = state_problem(*pair, **(QUINTIC | options)).problem
    layers, exponents = problem.shape_layers()
    grid = across(problem.form.u, times * nodes_u), along(problem.rows, times)
    return FairnessTable(problem, layers, *grid, least_cosine), exponents


def monomials(x, y, p2_a=0.0, p2_b=0.0):
    """1, p2, a, a^2 of side a; p2, b, b^2 of side b."""
    return [1.0, p2_a, x, x**2, p2_b, y, y**2]


@pytest.mark.parametrize("inner", [(), (0.5, 0.5)], ids=["smooth", "only C1 at v = 1/2"])
@pytest.mark.parametrize("options", [{}, {"degree_u": 3, "middle_curves": 1}])
def test_the_gradient_is_that_of_the_value(inner, options):
    table, _ = table_of(sheets(inner=inner), **options)
    assert table.along.lines[0].tolist() == ([0.5] if inner else [])
    at = np.array([monomials(0.9, 1.1, 0.3, -0.2)])
    measured, gradient = table.with_gradient(at)
    assert measured.values == pytest.approx(table.measure(at).values, rel=1e-14)

    def slope(k, h):
        step = np.eye(at.shape[1])[k] * h
        return float((table.measure(at + step).values - table.measure(at - step).values)[0] / (2 * h))

    for k in range(at.shape[1]):
        # Richardson: the error of the difference is of fourth order.
        known = (4 * slope(k, 5e-5) - slope(k, 1e-4)) / 3
        assert gradient[0, k] == pytest.approx(known, rel=1e-6, abs=1e-6 * abs(measured.values[0]))


@pytest.mark.parametrize("inner", [(), (0.5, 0.5)])
def test_a_batch_measures_what_each_alone_does(inner):
    table, _ = table_of(sheets(inner=inner))
    batch = np.array([monomials(x, y, z, -z) for x, y, z in ((0.5, 0.7, 0.0), (1, 2, 0.5), (8, 8, 0), (1.1, 0.9, 3))])
    measured, gradients = table.with_gradient(batch)
    for k, candidate in enumerate(batch):
        alone, gradient = table.with_gradient(candidate[None])
        assert measured.values[k] == pytest.approx(alone.values[0], rel=1e-12)
        assert measured.refused[k] == alone.refused[0]
        np.testing.assert_allclose(gradients[k], gradient[0], rtol=1e-9)
    assert measured.refused[2] != 0
    assert not measured.refused[[0, 1]].any()


@pytest.mark.parametrize(("degrees", "refused"), [(59.9, 0), (60.1, FOLDS), (180.0, FOLDS)])
def test_normals_that_turn_by_60_degrees_between_two_nodes_have_met_a_fold(degrees, refused):
    problem = state_problem(*sheets(), **QUINTIC).problem
    layers, _ = problem.shape_layers()
    table = FairnessTable(problem, layers, across(problem.form.u, 6), along(problem.rows, 1))
    rows, planes = table._planes(np.array([monomials(1.0, 1.0)]))
    columns = planes[0].size // len(table.across.weights)
    # P_u goes straight on, and from the fourth node on it is turned about P_v.
    turn = np.repeat(np.where(np.arange(len(table.across.weights)) < 3, 0.0, np.radians(degrees)), columns)
    planes[:3] = [np.cos(turn), 0 * turn, np.sin(turn)]
    planes[3:6] = [0 * turn, np.ones_like(turn), 0 * turn]
    assert (table._refused(rows, planes)[0] == FOLDS) == (refused == FOLDS)


def test_six_nodes_on_the_span_of_a_quintic_are_too_few():
    # The trap that the number of nodes avoids: the usual rule of a node more than the degree.
    at = np.array([monomials(0.35, 2.0)])
    right, coarse, fine = (
        float(table_of(sheets(), nodes_u=nodes, times=times)[0].measure(at).values[0])
        for nodes, times in ((NODES_U, 1), (6, 1), (NODES_U, 3))
    )
    assert right == pytest.approx(fine, rel=0.01)
    assert coarse != pytest.approx(fine, rel=0.01)


def test_a_rough_look_has_few_nodes_however_many_spans():
    short, long = (state_problem(*sheets(inner=inner), **QUINTIC).problem for inner in ((), np.arange(1, 40) / 40))
    assert rough_along(short.rows).nodes.size <= 12
    assert rough_along(long.rows).nodes.size == 12
    assert along(long.rows).nodes.size == 80


def strips():
    """Flat strips at a distance of 2."""
    knots = [0, 0, 1, 1]
    left = BSplineSurface(1, 1, knots, knots, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    right = BSplineSurface(1, 1, knots, knots, [[[3, 0, 0], [3, 1, 0]], [[4, 0, 0], [4, 1, 0]]])
    return Base(left, "u1"), Base(right, "u0")


def test_what_is_reversed_folds():
    table, _ = table_of(strips())
    refused = table.measure(np.array([monomials(1, 1), monomials(4, 4), monomials(0.3, 0.3)])).refused
    assert refused.tolist() == [0, FOLDS, 0]


def test_what_is_refused_is_measured_where_that_is_wanted_alone(monkeypatch):
    table, _ = table_of(sheets())
    good, bad = monomials(0.5, 0.7), monomials(8, 8)
    expected, slope = table.with_gradient(np.array([bad]))
    assert np.isfinite(expected.values).all()
    assert slope.any()
    taken = []

    def watched(name):
        function = getattr(fairness_table, name)
        return lambda planes: taken.append(name) or function(planes)

    for name in ("fairness", "fairness_pullback"):
        monkeypatch.setattr(fairness_table, name, watched(name))
    # Beside one that is not refused it is measured as well.
    for batch, measures in (([bad], False), ([bad, bad], False), ([good, bad], True)):
        measured, gradient = table.with_gradient(np.array(batch), everywhere=False)
        again = table.measure(np.array(batch))
        assert taken == (["fairness_pullback", "fairness"] if measures else [])
        for one in (measured, again):
            assert (one.refused != 0).tolist() == [row is bad for row in batch]
            assert np.isfinite(one.values).all() == measures
        assert gradient.shape == (len(batch), 7)
        assert gradient.any() == measures


@pytest.mark.parametrize("seed", range(6))
def test_eight_times_what_is_fair_is_a_loop_for_g4(seed):
    options = {"continuity": "G4", "degree_u": 9}
    pair = random_facing(np.random.default_rng([11, seed]), most_angle=60)
    problem = state_problem(*pair, **(QUINTIC | options)).problem
    found = solve_fair(problem)
    # Whatever folds.
    table, (powers_a, powers_b) = table_of(pair, least_cosine=-2.0, **options)
    for factor, expected in ((1, 0), (8, LOOPS)):
        x, y = (factor * value / unit for value, unit in zip((found.a, found.b), problem.natural, strict=True))
        candidate = np.concatenate([[1.0], x ** powers_a[1:, 0], y ** powers_b[1:, 0]])
        assert table.measure(candidate[None]).refused[0] == expected


def tangents(degrees, up=(0, 1, 0)):
    """Unit tangents in the plane of x and `up`, at angles from x: shape (3, n, 1)."""
    angle = np.radians(np.asarray(degrees, dtype=float))
    return (np.multiply.outer([1, 0, 0], np.cos(angle)) + np.multiply.outer(up, np.sin(angle)))[..., None]


@pytest.mark.parametrize(
    ("first", "last", "needed"),
    # An arch by twice, an S by four times its angle; beyond 90 degrees the other way round may be less.
    [
        (50, -50, 100),
        (50, 50, 200),
        (0, 0, 0),
        (0, 60, 120),
        (170, -170, 340),
        (135, 135, 360),
        (90, 150, 300),
        (150, 90, 300),
    ],
)
def test_the_biarc_between_two_exits(first, last, needed):
    ends = tangents([first, last])
    chord = np.array([[2.0], [0], [0]])
    assert np.degrees(needed_turn(ends[:, 0], ends[:, 1], chord)) == pytest.approx(needed)


def test_turning_is_the_length_on_the_sphere():
    back_and_forth = [0, 20, 40, 20, 0, -10]
    assert np.degrees(turned(tangents(back_and_forth))) == pytest.approx(90)
    assert np.degrees(turned(tangents(back_and_forth, (0, 0.6, 0.8)) * 7)) == pytest.approx(90)


def test_a_crease_along_v_counts_as_the_judge_counts_it():
    # Only C0 at v = 1/2.
    pair = sheets(inner=(0.5, 0.5, 0.5))
    table, _ = table_of(pair, times=4)
    assert table.along.lines[0].tolist() == [0.5]
    result = blend(*pair, **QUINTIC)
    assert result.shape.fairness.jumps > 1
    assert result.objective.value == pytest.approx(result.shape.fairness.value, rel=0.01)


def basis(*inner, degree=3):
    return Basis(degree, np.array([0.0] * (degree + 1) + list(inner) + [1.0] * (degree + 1)))


@pytest.mark.parametrize(
    ("inner", "lines"),
    [
        # A cluster of three knots; one that is as wide as the limit allows, and not.
        ((0.5, 0.5 + 1e-9, 0.5 + 2e-9), [(0.5, 0.5 + 2e-9)]),
        ((0.5, 0.5099), [(0.5, 0.5099)]),
        ((0.5, 0.5101), []),
        # Below the limit, but not among spans that are as narrow; clusters among such.
        (tuple(np.arange(1, 200) / 200), []),
        (
            (0.5, 0.5 + 1e-9, 0.506, 0.506 + 1e-9, 0.512, 0.512 + 1e-9),
            [(x, x + 1e-9) for x in (0.5, 0.506, 0.512)],
        ),
        # No line at an end, and what rounding leaves of a double knot.
        ((1e-9, 0.5), []),
        ((0.5, 0.5 + 1e-13), [(0.5, 0.5)]),
    ],
)
def test_clusters_of_knots_are_one_line(inner, lines):
    rows = basis(*inner), basis()
    found = along(rows, 1, 0.01)
    assert [tuple(line) for line in found.lines.T] == lines
    clusters = [*lines, *([(0, 1e-9)] if inner[0] == 1e-9 else [])]
    for low, high in clusters:
        assert not ((found.nodes > low) & (found.nodes < high)).any()
    assert found.weights.sum() == pytest.approx(1 - sum(high - low for low, high in clusters), rel=1e-12)
    assert rough_along(rows, 0.01).lines.size == 0


def test_what_is_short_altogether_is_no_cluster():
    # Contacts far apart: all of v is below the limit.
    found = along((basis(0.25, 0.5, 0.75), basis()), 1, 5.0)
    assert found.lines.size == 0
    assert found.weights.sum() == pytest.approx(1, rel=1e-12)


def test_a_rough_look_reads_no_polynomial_of_a_cluster():
    # Middles of a sixth of the domain, 1/4 and 3/4, are knots that are all but double.
    inner = [x + y for x in np.arange(1, 8) / 8 for y in (0, 1e-9)]
    row = basis(*inner)
    places = rough_along((row,), 0.01).places
    spans = np.searchsorted(row.knots, places, "right")
    assert np.all(row.knots[spans] - row.knots[spans - 1] > 0.1)


def test_the_width_of_clusters_is_a_quarter_of_the_window():
    # Edges of length 2, and a gap of 3: in v, h / 4 is 3 / 50 / 4 / 2.
    knots = [0, 0, 1, 1]
    left, right = (
        BSplineSurface(1, 1, knots, knots, [[[x, 0, 0], [x, 2, 0]], [[x + 1, 0, 0], [x + 1, 2, 0]]]) for x in (0, 4)
    )
    problem = state_problem(Base(left, "u1"), Base(right, "u0"), **QUINTIC).problem
    assert narrow_width(problem) == pytest.approx(3 / 400, rel=1e-9)
