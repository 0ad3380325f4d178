"""What no fair blend does: fold, or run a loop between its exits.

t = P_u / |P_u|, chord = P(1, v) - P(0, v). A section turns by T = integral of |curvature|; the biarc between its exits,
which leave the chord by theta_0 and theta_1 towards e_0 and e_1, turns by |1.5 a + .5 b| + |1.5 b + .5 a| with
a = theta_0 e_0, b = theta_1 e_1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray

# A section that turns by so much more than the biarc between its exits is a loop.
LOOP = np.radians(60.0)
# Below it a vector has no direction.
_NOTHING = 1e-12
# Of a unit vector, or of none.
_HALF = 0.5


def folds(normal: FloatArray, least_cosine: float) -> NDArray[np.bool_]:
    """Tell whether normals of neighbouring nodes turn too far, or are no numbers.

    Parameters
    ----------
    normal : ndarray, shape (3, ..., n_u, n_v)
        Of any length.
    least_cosine : float
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = normal / np.sqrt(np.sum(normal**2, axis=0))
    along_u = np.sum(unit[..., 1:, :] * unit[..., :-1, :], axis=0)
    along_v = np.sum(unit[..., 1:] * unit[..., :-1], axis=0)
    # What is no number does not compare.
    good = np.all(along_u > least_cosine, axis=(-2, -1)) & np.all(along_v > least_cosine, axis=(-2, -1))
    return np.asarray(~good)


def turned(tangents: FloatArray) -> FloatArray:
    """Return the angle by which tangents, shape (3, ..., n_u, n_v), turn along u: shape (..., n_v)."""
    unit = _unit(tangents)
    half = np.sqrt(np.sum((unit[..., 1:, :] - unit[..., :-1, :]) ** 2, axis=0)) / 2
    return np.asarray(2 * np.arcsin(np.minimum(half, 1.0)).sum(axis=-2))


def needed_turn(first: FloatArray, last: FloatArray, chord: FloatArray) -> FloatArray:
    """Return how far the biarc turns that leaves along `first` and arrives along `last`, each of shape (3, ..., n_v).

    Exits that leave the chord by theta may as well be reached the other way round, by 360 degrees - theta.

    Examples
    --------
    >>> up, along = np.array([[0.0], [1.0], [0.0]]), np.array([[1.0], [0.0], [0.0]])
    >>> needed_turn(up, -up, along) / np.pi
    array([1.])
    """
    chord = _unit(chord)
    (theta_0, side_0), (theta_1, side_1) = (_departure(_unit(end), chord) for end in (first, last))
    # |1.5 a + .5 b| needs but lengths and the cosine between a and b.
    # Straight along the chord or away from it any side will do: the least turn is that to the other one.
    told = np.minimum(np.sum(side_0**2, axis=0), np.sum(side_1**2, axis=0)) > _HALF
    cosine = np.where(told, np.sum(side_0 * side_1, axis=0), -1.0)
    least = np.full(theta_0.shape, np.inf)
    for x in (theta_0, theta_0 - 2 * np.pi):
        for y in (theta_1, theta_1 - 2 * np.pi):
            squares, product = (x**2, y**2), x * y * cosine
            turn = sum(
                np.sqrt(np.maximum(2.25 * p + 0.25 * q + 1.5 * product, 0.0)) for p, q in (squares, squares[::-1])
            )
            least = np.minimum(least, turn)
    return least


def _departure(tangent: FloatArray, chord: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the angle between unit vectors, and the unit part of the first one square to the second."""
    cosine = np.sum(tangent * chord, axis=0)
    square = tangent - cosine * chord
    sine = np.sqrt(np.sum(square**2, axis=0))
    return np.arctan2(sine, cosine), square / np.maximum(sine, _NOTHING)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.sqrt(np.sum(vectors**2, axis=0)), np.finfo(float).tiny))
