"""Splines that stand for surfaces given by formulas, for pictures and files; measures never use them."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import ParametricSurface
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface, Surface, interpolate_grid

_SAMPLES = 96


def as_spline(surface: ParametricSurface) -> tuple[Surface, float]:
    """Return a spline close to a surface, and how far apart they are between the interpolated points.

    A spline comes back as it is. Others are interpolated by a bicubic spline on a grid that holds all breakpoints.

    Returns
    -------
    BSplineSurface or SemiStructuredSurface
    float
        Largest distance at the centres of the grid's cells, model units.
    """
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return surface, 0.0
    u, v = (_grid(breaks) for breaks in surface.breakpoints)
    spline = interpolate_grid(surface.evaluate_grid(u, v), u=u, v=v)
    between = [(x[:-1] + x[1:]) / 2 for x in (u, v)]
    apart = spline.evaluate_grid(between[0], between[1]) - surface.evaluate_grid(between[0], between[1])
    return spline, float(np.linalg.norm(apart, axis=2).max())


def _grid(breaks: FloatArray) -> FloatArray:
    each = max(1, -(-_SAMPLES // (len(breaks) - 1)))
    inner = np.arange(each) / each
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])
