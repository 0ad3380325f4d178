"""Projected BFGS: known minima, inside and at bounds, and ways that are shut."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from semispline.solver.blending.projected import Point, _updated, convex, descend, descend_abreast, unbound

WIDE = np.full(2, -np.inf), np.full(2, np.inf)


def rosenbrock(x):
    return (1 - x[0]) ** 2 + 100 * (x[1] - x[0] ** 2) ** 2, np.array(
        [-2 * (1 - x[0]) - 400 * x[0] * (x[1] - x[0] ** 2), 200 * (x[1] - x[0] ** 2)]
    )


def started(function, x, hessian=None):
    value, gradient = function(np.array(x, dtype=float))
    return Point(np.array(x, dtype=float), value, gradient, np.eye(len(x)) if hessian is None else hessian)


def test_a_bent_valley_is_followed_to_its_end():
    end = descend(rosenbrock, started(rosenbrock, [-1.2, 1.0]), *WIDE, np.ones(2), 1e-8)
    np.testing.assert_allclose(end.x, 1.0, atol=1e-6)
    assert np.abs(end.gradient).max() <= 1e-8


def test_a_hessian_that_is_not_convex_is_no_obstacle():
    end = descend(rosenbrock, started(rosenbrock, [-1.2, 1.0], np.diag([-5.0, 1e-9])), *WIDE, np.ones(2), 1e-8)
    np.testing.assert_allclose(end.x, 1.0, atol=1e-6)


@given(st.lists(st.floats(-2, 2), min_size=6, max_size=6))
def test_a_convex_quadratic_ends_where_no_free_slope_is_left(numbers):
    a, b, c, d, low_x, low_y = numbers
    matrix = np.array([[a, b], [c, d]])
    matrix = matrix.T @ matrix + np.eye(2)
    low, high = np.array([low_x, low_y]), np.array([low_x, low_y]) + 1

    def quadratic(x):
        off = x - np.array([0.3, -0.4])
        return float(off @ matrix @ off) / 2, matrix @ off

    end = descend(quadratic, started(quadratic, (low + high) / 2), low, high, np.ones(2), 1e-7)
    assert np.all((low <= end.x) & (end.x <= high))
    free = unbound(end.x, end.gradient, low, high)
    assert np.abs(end.gradient[free]).max(initial=0.0) <= 1e-7
    # No point of the box is lower.
    corners = np.array([[x, y] for x in np.linspace(0, 1, 9) for y in np.linspace(0, 1, 9)]) + low
    assert end.value <= min(quadratic(x)[0] for x in corners) + 1e-9


def test_an_unknown_without_room_stays():
    start = started(rosenbrock, [-1.0, 0.5])
    end = descend(rosenbrock, start, np.array([-1.0, -5]), np.array([-1.0, 5]), np.ones(2), 1e-9)
    np.testing.assert_allclose(end.x, [-1.0, 1.0], atol=1e-8)


def test_where_the_way_is_shut_it_ends_before_the_wall():
    calls = 0

    def walled(x):
        nonlocal calls
        calls += 1
        return (np.inf if x[0] > 0.5 else float((x[0] - 1) ** 2), np.array([2 * (x[0] - 1), 0.0]))

    end = descend(walled, started(walled, [0.0, 0.0]), *WIDE, np.ones(2), 1e-9)
    assert 0.3 < end.x[0] <= 0.5
    assert np.isfinite(end.value)
    assert calls < 60
    # The place beyond the wall is named.
    assert end.shut[0] > 0.5


def test_a_way_that_ends_by_itself_is_not_shut():
    def walled(x):
        return (np.inf if x[0] > 1.5 else float((x[0] - 1) ** 2), np.array([2 * (x[0] - 1), 0.0]))

    beyond = replace(started(walled, [0.0, 0.0], np.diag([0.1, 1.0])), shut=np.ones(2))
    end = descend(walled, beyond, *WIDE, np.full(2, 9.0), 1e-9)
    assert end.x[0] == pytest.approx(1.0, abs=1e-9)
    assert end.shut is None

    def noise(x):
        return 1.0, np.array([1.0, 0.0])

    assert descend(noise, started(noise, [0.0, 0.0]), *WIDE, np.ones(2), 1e-9).shut is None


def test_ways_side_by_side_end_where_each_would_alone():
    batches = []

    def together(places):
        batches.append(len(places))
        found = [rosenbrock(x) for x in places]
        return np.array([value for value, _ in found]), np.array([gradient for _, gradient in found])

    # The second one has nothing to do; the others need not take the same number of steps.
    starts = [started(rosenbrock, x) for x in ([-1.2, 1.0], [1.0, 1.0], [0.5, 0.7])]
    ends = descend_abreast(together, starts, *WIDE, np.ones(2), 1e-8)
    calls = []
    for start, end in zip(starts, ends, strict=True):
        function, places = counted(rosenbrock)
        alone = descend(function, start, *WIDE, np.ones(2), 1e-8)
        np.testing.assert_array_equal(end.x, alone.x)
        assert end.value == alone.value
        calls.append(len(places))
    assert calls[1] == 0
    assert batches == [2] * min(calls[0], calls[2]) + [1] * abs(calls[0] - calls[2])
    assert descend_abreast(together, [], *WIDE, np.ones(2), 1e-8) == []


def test_convex_keeps_what_is_convex():
    matrix = np.array([[2.0, 1], [1, 3]])
    np.testing.assert_allclose(convex(matrix), matrix)
    assert np.linalg.eigvalsh(convex(np.diag([-1.0, 2.0]))) == pytest.approx([1.0, 2.0])


FREE = np.array([-np.inf]), np.array([np.inf])


def counted(function):
    """The function, and where it was called."""
    places = []

    def called(x):
        places.append(x[0])
        return function(x)

    return called, places


def test_sixty_steps_are_taken_at_most():
    # Down a slope without end, by the longest step each time.
    function, places = counted(lambda x: (-x[0], np.array([-1.0])))
    end = descend(function, Point(np.zeros(1), 0.0, np.array([-1.0]), np.eye(1)), *FREE, np.array([0.5]), 1e-9)
    assert end.x == pytest.approx([30.0])
    assert len(places) == 60


@pytest.mark.parametrize(("value", "calls"), [(1.0, 12), (np.inf, 6), (np.nan, 6)])
def test_a_step_is_halved_twelve_times_or_refused_five_times(value, calls):
    function, places = counted(lambda x: (value, np.array([-1.0])))
    start = Point(np.zeros(1), 0.0, np.array([-1.0]), np.eye(1))
    assert descend(function, start, *FREE, np.ones(1), 1e-9) is not start
    assert places == [0.5**k for k in range(calls)]


@pytest.mark.parametrize(("gain", "taken"), [(0.9e-4, False), (1.1e-4, True), (-1.0, False)])
def test_a_step_gains_a_ten_thousandth_of_what_the_slope_promises(gain, taken):
    function, places = counted(lambda x: (-gain * x[0], np.array([0.0])))
    end = descend(function, Point(np.zeros(1), 0.0, np.array([-1.0]), np.eye(1)), *FREE, np.ones(1), 1e-9)
    assert end.x[0] == (1.0 if taken else 0.0)
    assert len(places) == (1 if taken else 12)


def test_a_model_is_a_millionth_as_convex_as_in_its_most_convex_direction_at_least():
    for least, expected in ((0.0, 1e-6), (0.9e-6, 1e-6), (1.1e-6, 1.1e-6), (-0.5, 0.5)):
        assert np.linalg.eigvalsh(convex(np.diag([1.0, least]))) == pytest.approx([expected, 1.0], rel=1e-9)
    assert np.linalg.eigvalsh(convex(np.diag([-1.0, 0.0]))) == pytest.approx([1e-6, 1.0], rel=1e-9)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        # Along the step the model has the curvature that was met; where the slope falls nothing is learnt.
        ([3.0, 0.0], [[3, 0], [0, 1]]),
        ([2.0, 2.0], [[2, 2], [2, 3]]),
        ([-3.0, 0.0], [[1, 0], [0, 1]]),
        ([0.0, 1.0], [[1, 0], [0, 1]]),
        ([0.9e-12, 1.0], [[1, 0], [0, 1]]),
    ],
)
def test_the_model_learns_from_a_step(change, expected):
    found = _updated(np.eye(2), np.array([1.0, 0.0]), np.array(change))
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_what_is_hardly_convex_along_a_step_is_learnt_all_the_same():
    found = _updated(np.eye(2), np.array([1.0, 0.0]), np.array([1.1e-12, 1.0]))
    assert found[1, 1] == pytest.approx(1 + 1 / 1.1e-12)
    # Unless the model itself has no curvature there.
    assert _updated(np.zeros((2, 2)), np.array([1.0, 0.0]), np.array([1.0, 0.0])).tolist() == [[0, 0], [0, 0]]
    assert _updated(-np.eye(2), np.array([1.0, 0.0]), np.array([1.0, 0.0])).tolist() == [[-1, 0], [0, -1]]


@pytest.mark.parametrize(
    ("x", "gradient", "is_free"),
    [
        (0.0, 1.0, False),
        (0.0, -1.0, True),
        (1.0, -1.0, False),
        (1.0, 1.0, True),
        (0.5, 1.0, True),
        (0.5, -1.0, True),
        (-0.1, 1.0, False),
        (1.1, -1.0, False),
        (0.0, 0.0, True),
        (1.0, 0.0, True),
    ],
)
def test_a_bound_holds_back_what_would_pass_it(x, gradient, is_free):
    assert len(unbound(np.array([x]), np.array([gradient]), np.zeros(1), np.ones(1))) == is_free


def test_what_has_no_room_is_held_whatever_the_slope():
    for gradient in (-1.0, 0.0, 1.0):
        assert len(unbound(np.ones(1), np.array([gradient]), np.ones(1), np.ones(1))) == 0
