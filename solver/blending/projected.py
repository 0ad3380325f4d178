"""A smooth function of few unknowns between bounds: its least value by projected BFGS, from a Hessian that is given."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray

# Steps, halvings of one step, and refusals of one, at most.
MOST_STEPS, _MOST_HALVINGS, _MOST_REFUSALS = 60, 12, 5
# A step has to gain this fraction of what the slope promises.
_ENOUGH = 1e-4
# A model is at least so convex, in units of its most convex direction.
_LEAST_CONVEX = 1e-6

_T = TypeVar("_T")
# Yields places, and is sent values and gradients there.
_Way: TypeAlias = Generator[FloatArray, Any, _T]


@dataclass(frozen=True, eq=False)
class Point:
    """A place, value and gradient there, and a model of the Hessian.

    Where a way down ended because its steps led to where there is no value, `shut` is such a place.
    """

    x: FloatArray
    value: float
    gradient: FloatArray
    hessian: FloatArray
    shut: FloatArray | None = None


def descend(
    function: Callable[[FloatArray], tuple[float, FloatArray]],
    start: Point,
    low: FloatArray,
    high: FloatArray,
    longest: FloatArray,
    tolerance: float,
    most: int = MOST_STEPS,
) -> Point:
    """Go down from a start until no entry of the gradient that bounds leave free exceeds the tolerance.

    Parameters
    ----------
    function : callable
        Value and gradient; the value is infinite where there is no admissible one.
    start : Point
    low, high : ndarray, shape (n,)
        Bounds; where they are equal the unknown stays.
    longest : ndarray, shape (n,)
        Of each entry of a step.
    tolerance : float
    most : int
        Steps, at most.

    Source: J. Nocedal, S. Wright, Numerical Optimization, 2006, sections 3.1 and 6.1, with an active set of bounds.

    Examples
    --------
    >>> x = np.array([3.0, 1.0])
    >>> start = Point(x, 10.0, 2 * x, np.eye(2))
    >>> end = descend(lambda y: (y @ y, 2 * y), start, np.array([1.0, -9]), np.array([9.0, 9]), np.ones(2), 1e-9)
    >>> abs(end.x).round(6)
    array([1., 0.])
    """

    def one(places: FloatArray) -> tuple[FloatArray, FloatArray]:
        value, gradient = function(places[0])
        return np.array([value]), gradient[None]

    return descend_abreast(one, [start], low, high, longest, tolerance, most)[0]


def descend_abreast(
    function: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
    starts: list[Point],
    low: FloatArray,
    high: FloatArray,
    longest: FloatArray,
    tolerance: float,
    most: int = MOST_STEPS,
) -> list[Point]:
    """Go down from several starts, each as `descend` does, but all step by step together.

    Parameters
    ----------
    function : callable
        Values, shape (B,), and gradients of places, shape (B, n): several may cost little more than one.
    starts : list of Point
    low, high, longest, tolerance, most
        As for `descend`.
    """
    ways = [_way(start, low, high, longest, tolerance, most) for start in starts]
    ends = list(starts)
    answers: dict[int, Any] = dict.fromkeys(range(len(ways)))
    while answers:
        places = {}
        for k, answer in answers.items():
            try:
                places[k] = ways[k].send(answer)
            except StopIteration as ended:
                ends[k] = ended.value
        found = function(np.stack(list(places.values()))) if places else ()
        answers = dict(zip(places, zip(*found, strict=True), strict=False))
    return ends


def _way(
    start: Point, low: FloatArray, high: FloatArray, longest: FloatArray, tolerance: float, most: int
) -> _Way[Point]:
    """Go down from a start: places are asked for, and values and gradients there received; return the end."""
    at = replace(start, hessian=convex(start.hessian), shut=None)
    for _ in range(most):
        free = unbound(at.x, at.gradient, low, high)
        if not len(free) or np.abs(at.gradient[free]).max() <= tolerance:
            break
        step = np.zeros_like(at.x)
        step[free] = -np.linalg.solve(at.hessian[np.ix_(free, free)], at.gradient[free])
        step /= max(1.0, float((np.abs(step) / longest).max()))
        following, shut = yield from _stepped(at, step, low, high)
        if following is None:
            return replace(at, shut=shut)
        at = following
    return at


def unbound(x: FloatArray, gradient: FloatArray, low: FloatArray, high: FloatArray) -> NDArray[np.intp]:
    """Return the unknowns that no bound holds back from going down."""
    held = (low >= high) | ((x <= low) & (gradient > 0)) | ((x >= high) & (gradient < 0))
    return np.flatnonzero(~held)


def convex(hessian: FloatArray) -> FloatArray:
    """Return the symmetric matrix with its eigenvalues made positive."""
    values, vectors = np.linalg.eigh((hessian + hessian.T) / 2)
    size = np.maximum(np.abs(values), _LEAST_CONVEX * np.abs(values).max())
    return np.asarray((vectors * np.maximum(size, np.finfo(float).tiny)) @ vectors.T)


def _stepped(
    at: Point, step: FloatArray, low: FloatArray, high: FloatArray
) -> _Way[tuple[Point | None, FloatArray | None]]:
    """Return the next place, the model of its Hessian updated; none where no part of the step goes down.

    Beside it where there was no value, if that is why there is none.
    """
    refusals = 0
    for _ in range(_MOST_HALVINGS):
        x = np.clip(at.x + step, low, high)
        moved = x - at.x
        value, gradient = yield x
        # Where there is no value the way is shut: what is left of a step is not worth many trials.
        refusals += not np.isfinite(value)
        if refusals > _MOST_REFUSALS:
            return None, x
        if value <= at.value + _ENOUGH * float(at.gradient @ moved):
            return Point(x, float(value), gradient, _updated(at.hessian, moved, gradient - at.gradient)), None
        step = step / 2
    return None, None


def _updated(hessian: FloatArray, moved: FloatArray, change: FloatArray) -> FloatArray:
    """Return the BFGS update, left out where the function is not convex along the step."""
    curved = float(moved @ change)
    pushed = hessian @ moved
    known = float(moved @ pushed)
    if curved <= 1e-12 * float(np.linalg.norm(moved) * np.linalg.norm(change)) or known <= 0:
        return hessian
    return np.asarray(hessian + np.multiply.outer(change, change) / curved - np.multiply.outer(pushed, pushed) / known)
