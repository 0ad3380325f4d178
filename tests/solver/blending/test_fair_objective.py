"""What the fair search minimises where J is nothing: the tie-break alone; and its unknowns."""

from types import SimpleNamespace

import numpy as np
import pytest

from semispline import Base, BSplineSurface
from semispline.solver.blending.fair_objective import FairObjective, make_unknowns
from semispline.solver.blending.fairness_table import FOLDS, LOOPS, Measured
from semispline.solver.blending.pipeline import state_problem

LINE = [0.0, 0.0, 1.0, 1.0]


def strips(**options):
    """Two flat strips, 2 apart: speeds 1 and 1."""
    near, far = (
        BSplineSurface(1, 1, LINE, LINE, [[[x, y, 0] for y in (0, 1)] for x in places]) for places in ((-1, 0), (2, 3))
    )
    return state_problem(Base(near, "u1"), Base(far, "u0"), **({"alpha": "fair"} | options)).problem


def objective(values, refused=None, **options):
    """The objective of the strips, J and its gradient given."""
    problem = strips(**options)
    unknowns = make_unknowns(problem, problem.shape_layers()[1])
    values = np.array(values, dtype=float)
    measured = Measured(values, np.zeros(len(values), dtype=np.int8) if refused is None else np.array(refused))
    table = SimpleNamespace(
        measure=lambda monomials: measured,
        with_gradient=lambda monomials, everywhere: (measured, np.zeros_like(monomials)),
    )
    return FairObjective(unknowns, table)


def test_where_there_is_no_j_a_tenth_and_a_bowl_around_the_arc_stand_for_it():
    found = objective([0.0, 0.0, 0.0, 7.0])
    wanted = found.unknowns.wanted
    assert wanted == pytest.approx(0.0, abs=1e-12)
    # alpha^2 by a factor e, then both; and p2, which is drawn nowhere.
    y = wanted + np.array([[0, 9, 0, 0], [1, 0, 0, 0], [1, -9, -2, 9], [0, 0, 1, 0.0]])
    expected = np.log([0.1, 0.2, 0.6, 7.2])
    assert found.values(y) == pytest.approx(expected, rel=1e-12)
    values, gradients = found.gradients(y)
    assert values == pytest.approx(expected, rel=1e-12)
    assert gradients == pytest.approx(
        np.array([[0, 0, 0, 0], [1, 0, 0, 0], [1 / 3, 0, -2 / 3, 0], [0, 0, 0.2 / 7.2, 0]]), rel=1e-12
    )
    assert found.j(y[3], float(values[3])) == pytest.approx(7.0)
    assert found.tried == 8


def test_what_is_refused_or_no_number_is_infinite_and_counted():
    found = objective([1.0, 2.0, 3.0, np.inf, np.nan, np.inf], [0, FOLDS, LOOPS, 0, 0, LOOPS])
    values = found.values(np.zeros((6, 4)))
    assert np.isfinite(values).tolist() == [True] + [False] * 5
    assert values[0] == pytest.approx(np.log(1.1))
    assert found.refused == {"folds": 3, "loops": 2}


@pytest.mark.parametrize(
    ("options", "free"),
    [
        ({}, [0, 1, 2, 3]),
        ({"p2": "zero"}, [0, 2]),
        ({"continuity": ("G2", "G1")}, [0, 1, 2]),
        ({"alpha": ("fair", 1.5)}, [0, 1]),
        ({"continuity": ("G1", "C2")}, [0]),
    ],
)
def test_what_is_free_has_room_and_a_hessian(options, free):
    found = objective([0.0], **options)
    unknowns = found.unknowns
    assert np.flatnonzero(unknowns.low < unknowns.high).tolist() == free
    assert [unknowns.is_free(side) for side in (0, 1)] == [0 in free, 2 in free]
    assert unknowns.logarithmic.tolist() == [True, False, True, False]
    # A window of 4 around an arc of 1; p2 moves the third row by a chord at most.
    room = np.isin(np.arange(4), free)
    for side in (0, 2):
        if room[side]:
            assert (unknowns.low[side], unknowns.high[side]) == pytest.approx((-np.log(4), np.log(4)))
    asked = []

    def gradients(places):
        asked.append(places)
        return np.arange(len(places), dtype=float), places @ np.diag([2.0, 3.0, 4.0, 5.0]) + np.array([1, 2, 3, 4.0])

    found.gradients = gradients
    y = np.array([0.1, 0.2, 0.3, 0.4])
    point = found.point(y)
    (places,) = asked
    # Differences over 1e-4.
    assert places - y == pytest.approx(np.concatenate([np.zeros((1, 4)), 1e-4 * np.eye(4)[free]]), abs=1e-15)
    expected = np.diag(np.where(room, [2.0, 3.0, 4.0, 5.0], 1.0))
    np.testing.assert_allclose(point.hessian, expected, atol=1e-9)
    assert point.value == 0.0
