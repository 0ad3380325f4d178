"""How far a surface is from folding: area element and turn of the normal over a grid of samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.arrays import FloatArray
from solver.surfaces import Surface

# Samples in each span: enough that the normal of a smooth cubic span turns by a few degrees between neighbours.
_PER_SPAN = 8


@dataclass(frozen=True)
class Regularity:
    """How far a surface is from folding.

    Attributes
    ----------
    least_area_ratio : float
        Least |P_u x P_v| over its mean.
    largest_turn_degrees : float
        Largest angle between the normals of neighbouring samples; 180 where there is no normal.
    """

    least_area_ratio: float
    largest_turn_degrees: float


def measure_regularity(surface: Surface) -> Regularity:
    """Measure the area element and the turn of the normal on a grid of 8 samples in every span.

    Examples
    --------
    >>> from solver.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> measure_regularity(flat)
    Regularity(least_area_ratio=1.0, largest_turn_degrees=0.0)
    """
    u, v = (_samples(x) for x in surface.breakpoints)
    cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    area = np.linalg.norm(cross, axis=2)
    if area.min() <= 1e-14 * area.max():
        return Regularity(0.0, 180.0)
    normal = cross / area[..., None]
    turn = max(_turn(normal[:-1], normal[1:]), _turn(normal[:, :-1], normal[:, 1:]))
    return Regularity(float(area.min() / area.mean()), turn)


def _turn(n1: FloatArray, n2: FloatArray) -> float:
    sine, cosine = np.linalg.norm(np.cross(n1, n2), axis=-1), np.sum(n1 * n2, axis=-1)
    return float(np.degrees(np.arctan2(sine, cosine).max()))


def _samples(breaks: FloatArray) -> FloatArray:
    inner = np.linspace(0, 1, _PER_SPAN, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])
