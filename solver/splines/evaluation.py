"""What the evaluation of every spline shares: parameters, local bases, homogeneous points, the quotient rule."""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, finite_array, real_array
from semispline.solver.errors import ControlPointError, InputError, OptionError
from semispline.solver.scalars import is_whole
from semispline.solver.splines.knots import MERGE_TOLERANCE, basis_matrix


def domain_of(knots: FloatArray) -> tuple[float, float]:
    """Return the range of a clamped vector."""
    return float(knots[0]), float(knots[-1])


def checked_parameters(x: ArrayLike, knots: FloatArray, name: str) -> FloatArray:
    """Return parameters as an array, shape (K,), refused outside the domain.

    One that is outside by no more than 1e-12 of the domain means the end.
    """
    array = np.atleast_1d(real_array(x, name, InputError))
    if array.ndim != 1:
        raise InputError(f"{name}: {array.ndim} dimensions, expected a one-dimensional array of parameters")
    start, end = domain_of(knots)
    tolerance = MERGE_TOLERANCE * (end - start)
    outside = ~((array >= start - tolerance) & (array <= end + tolerance))
    if outside.any():
        i = int(np.argmax(outside))
        raise InputError(f"{name}[{i}]: found {array[i]}, expected a parameter in [{start}, {end}]")
    return np.asarray(np.clip(array, start, end))


def checked_weights(values: ArrayLike, points: FloatArray, name: str) -> FloatArray:
    """Return weights as a read-only array, refused unless there is a positive one for each point, shape (..., 3)."""
    shape = points.shape[:-1]
    weights = finite_array(values, len(shape), name, ControlPointError)
    if weights.shape != shape:
        raise ControlPointError(f"{name}: shape {weights.shape}, expected {shape}")
    if (weights <= 0).any():
        at = tuple(np.argwhere(weights <= 0)[0].tolist())
        where = ", ".join(map(str, at))
        raise ControlPointError(f"{name}[{where}]: found {weights[at]}, expected a positive number")
    heaviest, farthest = float(weights.max()), float(np.abs(points).max())
    if heaviest * farthest == np.inf:
        raise ControlPointError(f"{name}: found {heaviest}, too large to be multiplied by the coordinate {farthest}")
    return weights


def point_parameters(
    u: ArrayLike, v: ArrayLike, knots_u: FloatArray, knots_v: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the parameters of points, shapes (K,) and (K,); a single value goes with each of the other."""
    uu, vv = checked_parameters(u, knots_u, "u"), checked_parameters(v, knots_v, "v")
    if len(uu) != len(vv) and 1 not in (len(uu), len(vv)):
        raise InputError(f"v: {len(vv)} parameters, expected as many as u has, {len(uu)}, or one")
    uu, vv = np.broadcast_arrays(uu, vv)
    return uu, vv


def check_orders(**orders: int) -> None:
    """Refuse orders of a derivative that are not whole numbers of at least 0."""
    for name, order in orders.items():
        if not is_whole(order) or order < 0:
            raise OptionError(f"{name}: found {order!r}, expected an order of at least 0")


def local_basis(degree: int, knots: FloatArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values of the degree + 1 basis functions that live at each x, and their indices, shapes (K, degree + 1)."""
    matrix = basis_matrix(degree, knots, x)
    shape = (len(x), degree + 1)
    return matrix.data.reshape(shape), matrix.indices.reshape(shape)


def homogeneous_points(points: FloatArray, weights: FloatArray | None) -> FloatArray:
    """Return the points themselves, shape (..., 3), or with weights (w x, w y, w z, w), shape (..., 4); read-only."""
    if weights is None:
        return points
    w = weights[..., None]
    result = np.concatenate([points * w, w], axis=-1)
    result.setflags(write=False)
    return result


def euclidean(points: FloatArray) -> tuple[FloatArray, FloatArray | None]:
    """Return Euclidean points and weights (None where there are three columns): the inverse of `homogeneous_points`."""
    if points.shape[-1] == 3:
        return points, None
    weights = points[..., 3]
    return points[..., :3] / weights[..., None], weights


def same_width(*points: FloatArray) -> list[FloatArray]:
    """Return arrays of three or four columns with as many as the widest has: what has no weight gets weight 1."""
    width = max(x.shape[-1] for x in points)
    return [x if x.shape[-1] == width else np.concatenate([x, np.ones((*x.shape[:-1], 1))], axis=-1) for x in points]


def quotient(homogeneous: Callable[[int, int], FloatArray], du: int, dv: int) -> FloatArray:
    """Return derivative (du, dv) of X / w from the derivatives of (X, w), by the product rule on X = w S."""
    raw = {(a, b): homogeneous(a, b) for a in range(du + 1) for b in range(dv + 1)}
    weight = {order: np.ascontiguousarray(value[..., 3]) for order, value in raw.items()}
    result = np.empty((*weight[0, 0].shape, 3))
    # One coordinate after the other: an inner loop of length 3 would cost more than the arithmetic.
    for d in range(3):
        known: dict[tuple[int, int], FloatArray] = {}
        for a, b in raw:
            value = raw[a, b][..., d]
            for i in range(a + 1):
                for j in range(b + 1):
                    if i or j:
                        value = value - comb(a, i) * comb(b, j) * weight[i, j] * known[a - i, b - j]
            last = result[..., d] if (a, b) == (du, dv) else None
            known[a, b] = np.divide(value, weight[0, 0], out=last)
    return result
