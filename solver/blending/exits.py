"""How a blend has to leave its bases, against the chords that join the contacts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.sides import Side

# Beyond it an arc grows without limit.
_MOST_TURN = np.radians(150.0)
_PLACES = (np.arange(64) + 0.5) / 64
_STRAIGHT = 1e-6


@dataclass(frozen=True)
class Exits:
    """Exits and chords over both contacts.

    Attributes
    ----------
    arc : float
        theta / sin(theta) of the mean angle theta between exit and chord: how much longer an arc is than its chord.
    u_turn : bool
        The mean cosine between exit and chord is negative.
    """

    arc: float
    u_turn: bool


def measure_exits(a: Side, b: Side) -> Exits:
    """Measure the exits of two sides over one range of v.

    Examples
    --------
    >>> from semispline.solver.splines import Basis
    >>> knots = np.array([0, 0, 1, 1.0])
    >>> floor = np.array([[[1, 0, 0], [1, 1, 0]], [[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0.0]]])
    >>> a = Side("G1", 1, (1.0, 1.0), Basis(1, knots), floor, 1.0)
    >>> b = Side("G1", 1, (1.0, 1.0), Basis(1, knots), floor * [-1, 1, 1] + [4, 0, 0], 4.0)
    >>> measure_exits(a, b)
    Exits(arc=1.0, u_turn=False)
    """
    start, end = a.along.knots[0], a.along.knots[-1]
    curves, exits = [], []
    for side in (a, b):
        points, inwards = side.edge(start + (end - start) * _PLACES)
        curves.append(points)
        exits.append(_unit(-inwards))
    chord = _unit(curves[1] - curves[0])
    cosines = np.concatenate([np.sum(exits[0] * chord, axis=1), -np.sum(exits[1] * chord, axis=1)])
    sines = np.concatenate([np.linalg.norm(np.cross(exit_, chord), axis=1) for exit_ in exits])
    theta = min(float(np.arctan2(sines, cosines).mean()), _MOST_TURN)
    return Exits(1.0 if theta < _STRAIGHT else float(theta / np.sin(theta)), bool(cosines.mean() < 0))


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)[:, None])
