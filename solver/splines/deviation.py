"""How far two splines of one space are apart: a proven bound from their control points, not a sample."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines.evaluation import euclidean, same_width


def deviation_bound(degrees: Sequence[int], one: FloatArray, other: FloatArray) -> float:
    """Bound the distance between two curves or surfaces over the same knots, from points with the same parameters.

    The difference of polynomial splines lies in the convex hull of the differences of their control points. Of rational
    ones, f and g with weight functions w and v, w (f - g) = (w f - v g) - (w - v) g holds span by span, and g lies in a
    ball around its control points there.

    Parameters
    ----------
    degrees : sequence of int, length d
        One for a curve, two for a surface.
    one, other : ndarray, shape (n_1, .., n_d, 3), or (n_1, .., n_d, 4) with (w x, w y, w z, w)

    Returns
    -------
    float
        Infinite where a weight is not positive.

    Examples
    --------
    >>> line = np.array([[0, 0, 0, 1], [2, 0, 0, 1.0]])
    >>> deviation_bound([1], line, line + [[0, 0, 0, 0], [0.25, 0, 0, 0.125]])
    0.25
    """
    f, g = same_width(one, other)
    if f.shape[-1] == 3:
        return float(np.linalg.norm(f - g, axis=-1).max())
    if not (f[..., 3] > 0).all() or not (g[..., 3] > 0).all():
        return float("inf")
    points, _ = euclidean(g)
    d = len(degrees)
    size = tuple(p + 1 for p in degrees)
    # The control points of each span: shape (spans, coordinate, points of the span).
    local, change, weights = (
        np.lib.stride_tricks.sliding_window_view(x, size, axis=tuple(range(d))).reshape(-1, x.shape[-1], np.prod(size))
        for x in (points, f - g, f[..., 3:])
    )
    centre = (local.max(axis=2) + local.min(axis=2)) / 2
    radius = np.linalg.norm(local - centre[..., None], axis=1).max(axis=1)
    moved, weighed = change[:, :3], change[:, 3]
    apart = np.linalg.norm(moved - weighed[:, None] * centre[..., None], axis=1) + np.abs(weighed) * radius[:, None]
    return float((apart.max(axis=1) / weights.min(axis=(1, 2))).max())
