"""Rates of curvature, by arc length, of the section of a surface with the plane square to an edge.

In the plane through a point of the edge, square to the edge, with a tangent t and the normal N of the surface as axes,
the section is z = f(x) with f'(0) = 0. There curvature, its rate and its second rate are f'', f''' and
f'''' - 3 f''^3.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from semispline.solver.arrays import FloatArray

# The chain rule of order k without the terms of order k in the parameters: how often which of their lower orders occur.
_TERMS = {
    2: ((1, (1, 1)),),
    3: ((1, (1, 1, 1)), (3, (1, 2))),
    4: ((1, (1, 1, 1, 1)), (6, (1, 1, 2)), (3, (2, 2)), (4, (1, 3))),
}

Pair = tuple[FloatArray, FloatArray]


@dataclass(frozen=True, eq=False)
class CurvatureRates:
    """The rate of curvature and, where asked for, the second one, at samples along an edge.

    Attributes
    ----------
    values : tuple of ndarray, shape (K,)
        1/length^2 and 1/length^3; along the section in the direction in which w grows. Backwards the first one changes
        its sign.
    noises : tuple of ndarray, shape (K,)
        What rounding may do to them, to first order.
    """

    values: tuple[FloatArray, ...]
    noises: tuple[FloatArray, ...]


def curvature_rates(
    at: Mapping[tuple[int, int], FloatArray], normal: FloatArray, noises: FloatArray, order: int
) -> CurvatureRates:
    """Return rates of curvature up to those that contact of `order`, 3 or 4, asks for.

    Parameters
    ----------
    at : mapping
        Derivatives of the surface along the edge, each of shape (K, 3); keys are (order across, order along).
    normal : ndarray, shape (K, 3)
        Unit normals, on either side; not a number where there is none.
    noises : ndarray, shape (5, 5)
        What rounding may do to each derivative.
    order : {3, 4}

    Source: the graph of a surface over its tangent plane, differentiated implicitly along x in the plane y = 0.
    """
    speed_along = np.linalg.norm(at[0, 1], axis=1)
    unit_along = at[0, 1] / np.where(speed_along > 0, speed_along, np.nan)[:, None]
    unit = np.cross(unit_along, normal)
    unit *= np.sign(_dot(at[1, 0], unit))[:, None]
    frame = _Frame(_dot(at[1, 0], unit), _dot(at[1, 0], unit_along), np.where(speed_along > 0, speed_along, np.nan))
    # Orders of the parameters (w, s) of the point above x, by x, and of its height.
    steps: dict[int, Pair] = {1: frame.solved(np.ones_like(frame.a), np.zeros_like(frame.a))}
    sizes = {key: np.linalg.norm(value, axis=1) for key, value in at.items()}
    tilt = (noises[1, 0] + np.abs(frame.b) * noises[0, 1] / frame.g) / frame.a + noises[0, 1] / frame.g
    doubts: dict[int, Pair] = {1: frame.doubted(noises[0, 1] / frame.g, steps[1], noises)}
    heights, rounding = {}, {}
    for k in range(2, order + 1):
        known = _chain(at, k, steps)
        height = _dot(known, normal)
        along_x, along_y = _dot(known, unit), _dot(known, unit_along)
        doubt = _doubt_of_chain(sizes, k, steps, doubts, noises)
        heights[k], rounding[k] = height, doubt + tilt * np.hypot(along_x, along_y)
        steps[k] = frame.solved(-along_x, -along_y)
        doubts[k] = frame.doubted(doubt + tilt * np.abs(height), steps[k], noises)
    values, spread = [heights[3]], [rounding[3]]
    if order > 3:
        values.append(heights[4] - 3 * heights[2] ** 3)
        spread.append(rounding[4] + 9 * heights[2] ** 2 * rounding[2])
    return CurvatureRates(tuple(values), tuple(spread))


@dataclass(frozen=True, eq=False)
class _Frame:
    """X_w = a t + b T and X_s = g T, with t square to the edge and T along it: each of shape (K,)."""

    a: FloatArray
    b: FloatArray
    g: FloatArray

    def solved(self, x: FloatArray, y: FloatArray) -> Pair:
        """Return (w, s) with X_w w + X_s s = x t + y T."""
        w = x / self.a
        return w, (y - self.b * w) / self.g

    def doubted(self, right: FloatArray, step: Pair, noises: FloatArray) -> Pair:
        """Bound the error of what was solved for, from that of the right-hand side and those of X_w and X_s."""
        error = right + noises[1, 0] * np.abs(step[0]) + noises[0, 1] * np.abs(step[1])
        w = error / self.a
        return w, (error + np.abs(self.b) * w) / self.g


def _chain(at: Mapping[tuple[int, int], FloatArray], k: int, steps: Mapping[int, Pair]) -> FloatArray:
    columns = {m: (w[:, None], s[:, None]) for m, (w, s) in steps.items()}
    return np.asarray(sum(count * _form(at, [columns[m] for m in orders]) for count, orders in _TERMS[k]))


def _doubt_of_chain(
    sizes: Mapping[tuple[int, int], FloatArray],
    k: int,
    steps: Mapping[int, Pair],
    doubts: Mapping[int, Pair],
    noises: FloatArray,
) -> FloatArray:
    """Bound the error of `_chain`: of each derivative, and of each step, one after the other."""
    noise = {(i, j): noises[i, j] for i, j in sizes}
    long = {m: (np.abs(w), np.abs(s)) for m, (w, s) in steps.items()}
    total = np.zeros_like(steps[1][0])
    for count, orders in _TERMS[k]:
        total = total + count * _form(noise, [long[m] for m in orders])
        for place, m in enumerate(orders):
            others = [long[other] for other in orders[:place] + orders[place + 1 :]]
            total = total + count * _form(sizes, [doubts[m], *others])
    return total


def _form(at: Mapping[tuple[int, int], FloatArray], steps: Sequence[Pair]) -> FloatArray:
    """Return the derivative of order len(steps), a symmetric form, of these steps (w, s)."""
    k = len(steps)
    values = [at[k - j, j] for j in range(k + 1)]
    for w, s in steps:
        values = [w * first + s * second for first, second in pairwise(values)]
    return values[0]


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.sum(a * b, axis=1))
