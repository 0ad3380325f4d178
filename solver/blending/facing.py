"""How two contacts face each other: gap, lengths and speeds across, and whether there is anything to blend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.sides import Side
from semispline.solver.errors import EdgeError
from semispline.solver.splines import breakpoints, gauss_rule, merge_breakpoints

# Lengths below this fraction of the model count as zero.
VANISHING = 1e-10
# Means over v: points of the whole contact, and degree of the rule on each span where spans are many.
_MOST_POINTS = 512
_LEAST_RULE = 3


@dataclass(frozen=True)
class Facing:
    """Means over v of two contacts, in coordinates of size 1: gap, and on each side length and speed across."""

    gap: float
    lengths: tuple[float, float]
    cross_speeds: tuple[float, float]


def measure_facing(a: Side, b: Side) -> Facing:
    """Measure by quadrature over the spans of both sides: neither where the seam is nor their order matters.

    Raises
    ------
    EdgeError
        A contact curve has zero length, or both coincide.
    """
    breaks = merge_breakpoints(breakpoints(a.along.knots), breakpoints(b.along.knots))
    nodes, weights = gauss_rule(breaks, max(_LEAST_RULE, _MOST_POINTS // len(breaks)))
    x, weights = nodes.ravel(), weights.ravel()
    domain = float(breaks[-1] - breaks[0])
    curves, lengths, speeds = [], [], []
    for name, side in (("a", a), ("b", b)):
        points, inwards = side.edge(x)
        across = inwards * (side.degree / side.spans[0])
        curves.append(points)
        lengths.append(float(weights @ np.linalg.norm(side.tangents(x), axis=1)))
        speeds.append(float(weights @ np.linalg.norm(across, axis=1)) / domain)
        if lengths[-1] < VANISHING:
            raise EdgeError(f"base {name}: the contact curve has zero length; choose another edge")
    if _coincide(a, b):
        raise EdgeError("bases: the contact curves coincide, there is nothing to blend; choose another edge")
    gap = float(weights @ np.linalg.norm(curves[0] - curves[1], axis=1)) / domain
    return Facing(gap, (lengths[0], lengths[1]), (speeds[0], speeds[1]))


def _coincide(a: Side, b: Side) -> bool:
    # Ends are hit exactly: rounded beyond them there is no curve.
    x = np.linspace(a.along.knots[0], a.along.knots[-1], 129)
    curves = [side.edge(x)[0] for side in (a, b)]
    return _largest_distance(curves[0], curves[1], b) < VANISHING


def _largest_distance(points: FloatArray, samples: FloatArray, side: Side) -> float:
    """Return how far a point is at most from the contact curve of a side, whatever the curve's parametrisation.

    From the nearest sample on, Gauss-Newton on the parameter finds the foot; far curves need no more than samples.
    """
    knots = side.along.knots
    distances = np.linalg.norm(points[:, None] - samples, axis=2)
    if distances.min(axis=1).max() > np.linalg.norm(np.diff(samples, axis=0), axis=1).max():
        return float(distances.min(axis=1).max())
    x = np.linspace(knots[0], knots[-1], len(samples))[distances.argmin(axis=1)]
    for _ in range(8):
        off, slope = side.edge(x)[0] - points, side.tangents(x)
        squared = np.maximum(np.sum(slope**2, axis=1), np.finfo(float).tiny)
        x = np.clip(x - np.sum(off * slope, axis=1) / squared, knots[0], knots[-1])
    return float(np.linalg.norm(side.edge(x)[0] - points, axis=1).max())
