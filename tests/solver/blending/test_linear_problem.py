"""When a linear alpha^2 is taken: what the two searches came to, made up."""

import re

import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending import linear_problem
from semispline.solver.blending.fair_search import AllRefusedError, FairSolution
from semispline.solver.blending.linear_problem import try_linear_alpha
from semispline.solver.blending.pipeline import state_problem

LINE = [0.0, 0.0, 1.0, 1.0]


def strips(ratio=2.0):
    """Two flat strips whose gap grows along v by a factor."""
    near, far = (
        BSplineSurface(1, 1, LINE, LINE, [[[x + turned * y, y, 0] for y in (0, 1)] for x in places])
        for places, turned in (((-1, 0), 0.0), ((1, 2), ratio - 1))
    )
    return state_problem(Base(near, "u1"), Base(far, "u0")).problem


def solution(value, *condoned, stopped_by=""):
    return FairSolution(1.0, 1.0, (0.0, 0.0), value, 0.0, 1, {}, condoned, stopped_by=stopped_by)


def stopped(value):
    return solution(value, stopped_by="loop")


@pytest.mark.parametrize(
    ("constant", "linear", "taken", "said"),
    [
        (solution(1.0), solution(0.69), True, "fairness is 0.69 of"),
        (solution(1.0), solution(0.71), False, "fairness is 0.71 of .* 0.7 would pay"),
        (solution(0.01), solution(0.0069), True, "fairness is 0.69 of"),
        # Nothing of nothing is all of it.
        (solution(0.0), solution(0.0), False, "fairness is 1 of"),
        # What is refused less often comes first, however fair.
        (solution(1.0, "folds"), solution(9.0), True, "fairness is 9 of"),
        (solution(1.0, "folds"), solution(0.71, "folds"), False, "fairness is 0.71 of"),
        (solution(1.0, "folds"), solution(0.69, "folds"), True, "fairness is 0.69 of"),
        # One that goes on where a constant one is stopped only has to be fairer.
        (stopped(1.0), solution(0.99), True, "fairness is 0.99 of"),
        (stopped(1.0), solution(1.01), False, "fairness is 1.01 of"),
        (stopped(1.0), stopped(0.71), False, "fairness is 0.71 of"),
        (solution(1.0), stopped(0.71), False, "fairness is 0.71 of"),
    ],
)
def test_what_is_taken(monkeypatch, constant, linear, taken, said):
    asked = []
    monkeypatch.setattr(linear_problem, "solve_fair", lambda *words: asked.append(words) or linear)
    trial = try_linear_alpha(strips(), constant)
    assert trial.taken is taken
    assert trial.solution is linear
    # It may let pass no more than a constant one had to.
    assert asked == [(trial.problem, constant, len(constant.condoned))]
    assert re.search(said, trial.verdict)
    assert try_linear_alpha(strips(), constant, always=True).taken


def test_what_is_refused_is_not_taken_even_where_it_is_asked_for(monkeypatch):
    def refused(*_):
        raise AllRefusedError({"folds": 7, "loops": 0})

    monkeypatch.setattr(linear_problem, "solve_fair", refused)
    for always in (False, True):
        trial = try_linear_alpha(strips(), solution(1.0), always=always)
        assert (trial.taken, trial.solution, trial.verdict) == (False, None, "no candidate is left: 7 fold")
        assert trial.problem is not None


def test_what_is_even_is_not_tried_unless_asked(monkeypatch):
    monkeypatch.setattr(linear_problem, "solve_fair", lambda *_: solution(0.1))
    assert try_linear_alpha(strips(1.4), solution(1.0)).problem is None
    assert try_linear_alpha(strips(1.4), solution(1.0), always=True).taken
    assert try_linear_alpha(strips(1.6), solution(1.0)).taken
    # Or unless a refusal stopped the search for a constant one.
    assert try_linear_alpha(strips(1.4), stopped(1.0)).taken


def test_contacts_that_touch_have_a_ratio_without_a_word_of_the_machine():
    """Bases that meet in a point: the gap there is nothing, and a division overflows."""
    a = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[-1, 0, 0], [-1, 1, 0]]])
    b = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [9, 1, 0]], [[0, -1, 0], [9, -1, 0]]])
    problem = state_problem(Base(a, "u0"), Base(b, "u0"), flip="no", middle_curves=0)
    assert linear_problem.gap_ratio(problem.problem) > 1e300
