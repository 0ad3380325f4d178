"""Closed contacts that are no more than continuous across their seam are closed all the same."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.bases import tube
from helpers.papers_set import state_problem
from semispline import Base, OptionError
from semispline.solver.blending import candidates, pipeline
from semispline.solver.blending.linear_problem import LinearTrial, gap_ratio, try_linear_alpha
from semispline.solver.blending.nlp import constrained_problem
from semispline.solver.blending.quasi_newton import substituted_objective


@pytest.fixture(scope="module")
def corners():
    """Two polygons: of 6 and of 9 corners, the seam on one of them."""
    rng = np.random.default_rng(0)
    pair = tube(rng, 6, degree=1), tube(rng, 9, degree=1, radius=1.5, heights=(4.0, 3.0))
    return [Base(surface, "u1") for surface in pair]


def stated(pair, **options):
    problem = state_problem(*pair, middle_curves=1, continuity="G1", **options).problem
    assert problem.seam_order == 0
    return problem


def test_middle_curves_have_all_knots_of_both(corners):
    problem = stated(corners)
    middle = problem.rows[3]
    inner = middle.knots[2:-2]
    for side in (problem.a, problem.b):
        for knot in side.along.knots[2:-2]:
            assert np.abs(inner - knot).min() < 1e-9
    assert problem.seam_order_of(3) == 0
    assert [problem.seam_order_of(row) for row in problem.free_rows] == [0] * 3
    rows = np.split(problem.control_points(*problem.start), problem.form.offsets[1:-1])
    for row in rows:
        np.testing.assert_allclose(row[0], row[-1], atol=1e-12)


def test_a_triangle_of_three_points_gets_a_middle_curve_that_may_bend():
    rng = np.random.default_rng(0)
    pair = [Base(tube(rng, 3, degree=2, heights=heights), "u1") for heights in ((0.0, 1.0), (4.0, 3.0))]
    problem = state_problem(*pair, middle_curves=1, continuity="G1").problem
    assert problem.seam_order >= 0
    assert problem.rows[3].size >= 4


def test_alpha_is_one_number_along_them(corners):
    with pytest.raises(OptionError, match="alpha: found two values for the ends of v on closed contacts"):
        stated(corners, alpha=((1.0, 2.0), 1.0))
    problem = stated(corners)
    # The gap varies, were they open.
    assert gap_ratio(replace(problem, seam_order=-1)) > 1.01
    assert gap_ratio(problem) == 1.0
    trial = try_linear_alpha(problem, SimpleNamespace(value=1.0, condoned=()), always=True)
    assert (trial.problem, trial.taken) == (None, False)
    assert trial.verdict == "contacts are closed: alpha has to be constant along them"


@pytest.mark.parametrize(("order", "is_refused"), [(-1, False), (0, True), (2, True)])
def test_a_linear_alpha_is_refused_where_the_seam_is_closed(monkeypatch, order, is_refused):
    monkeypatch.setattr(candidates, "try_linear_alpha", lambda *_, **__: LinearTrial(None, None, False, "not tried"))
    monkeypatch.setattr(candidates, "replace", lambda options, **_: options)
    constant = SimpleNamespace(
        found=SimpleNamespace(fair=object()),
        problem=SimpleNamespace(seam_order=order, has_constant_weights=True),
        options=SimpleNamespace(box=None),
    )
    assert candidates._with_linear_alpha(constant, "auto") == (constant, ())
    assert candidates._with_linear_alpha(constant, "constant") == (constant, ())
    if is_refused:
        with pytest.raises(OptionError, match="alpha_v: found linear on closed contacts"):
            candidates._with_linear_alpha(constant, "linear")
    else:
        assert candidates._with_linear_alpha(constant, "linear") == (constant, ())


def test_both_local_methods_know_that_they_are_closed(corners):
    problem = stated(corners)
    free = sum(problem.form.rows[i].size for i in problem.free_rows)
    owned = problem.form.offsets[-1] - free
    # Each free row has a condition, which leaves one point less.
    assert constrained_problem(problem).g.shape[0] == 3 * (owned + 3)
    _, start = substituted_objective(problem)
    assert len(start) == 3 * (free - 3) + 2


@pytest.mark.parametrize(("order", "is_measured"), [(-1, False), (0, True), (2, True)])
def test_a_seam_is_measured_where_there_is_one(order, is_measured, monkeypatch):
    monkeypatch.setattr(pipeline, "Base", lambda surface, edge: edge)
    monkeypatch.setattr(pipeline, "measure_contact", lambda a, b, flip: (a, b, flip))
    found = pipeline._seam(None, SimpleNamespace(seam_order=order))
    assert found == (("v1", "v0", "no") if is_measured else None)
