"""How far two splines of one space are apart: a proven bound from their control points, not a sample."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines.evaluation import euclidean, same_width


def deviation_bound(degree: int, one: FloatArray, other: FloatArray) -> float:
    """Bound the distance between two curves over the same knots, from points with the same parameter.

    The difference of polynomial curves lies in the convex hull of the differences of their control points. Of rational
    ones, with weight functions w and v, w (f - g) = (w f - v g) - (w - v) g holds span by span, and g lies in a ball
    around its control points there.

    Parameters
    ----------
    degree : int
    one, other : ndarray, shape (n, 3), or (n, 4) with (w x, w y, w z, w)

    Returns
    -------
    float
        Infinite where a weight of `one` is not positive.

    Examples
    --------
    >>> line = np.array([[0, 0, 0, 1], [2, 0, 0, 1.0]])
    >>> deviation_bound(1, line, line + [[0, 0, 0, 0], [0.25, 0, 0, 0.125]])
    0.25
    """
    f, g = same_width(one, other)
    if f.shape[1] == 3:
        return float(np.linalg.norm(f - g, axis=1).max())
    if not (f[:, 3] > 0).all() or not (g[:, 3] > 0).all():
        return float("inf")
    points, _ = euclidean(g)
    # Axes: span, coordinate, control point of the span.
    local, change, weights = (
        np.lib.stride_tricks.sliding_window_view(x, degree + 1, axis=0) for x in (points, f - g, f[:, 3])
    )
    centre = (local.max(axis=2) + local.min(axis=2)) / 2
    radius = np.linalg.norm(local - centre[..., None], axis=1).max(axis=1)
    moved, weighed = change[:, :3], change[:, 3]
    apart = np.linalg.norm(moved - weighed[:, None] * centre[..., None], axis=1) + np.abs(weighed) * radius[:, None]
    return float((apart.max(axis=1) / weights.min(axis=1)).max())
