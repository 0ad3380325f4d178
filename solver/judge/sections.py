"""What measures of shape share: samples in every span, which ways a surface closes, the window of turns and jumps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import InputError
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.splines import gauss_rule

# Opposite edges closer than this fraction of the surface's extent are one: the surface is closed.
CLOSED = 1e-9
# The window of turns and jumps, as a fraction of the mean length of the sections v = const.
WINDOW = 1 / 50
# How far inside a span what jumps at its ends is looked at: a fraction of the span, and of the domain, since knots
# closer than 1e-12 of it count as one.
_INSIDE, _APART = 1e-8, 2e-12
# Finer grids around the least value so far, and what gain ends them.
_ZOOMS, _ENOUGH = 8, 1e-7
# Two tangents at a smaller angle than this have no normal.
_DEGENERATE = 1e-12


def spread(breaks: FloatArray, total: int, least: int = 2) -> FloatArray:
    """Return parameters evenly spread in each span, about `total` steps in all and at least `least` in each.

    Examples
    --------
    >>> spread(np.array([0.0, 1.0, 3.0]), 4).tolist()
    [0.0, 0.5, 1.0, 2.0, 3.0]
    """
    spans = len(breaks) - 1
    steps = max(least, -(-total // spans))
    inside = breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(steps) / steps)
    return np.append(inside.ravel(), breaks[-1])


def just_inside(breaks: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return parameters just after the start and just before the end of each span, where nothing jumps."""
    widths = np.diff(breaks)
    step = np.minimum(np.maximum(_INSIDE * widths, _APART * (breaks[-1] - breaks[0])), widths / 4)
    return np.asarray(breaks[:-1] + step), np.asarray(breaks[1:] - step)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross products of vectors along the last axis; each component of the result lies in one piece."""
    (x, y, z), (u, v, w) = (np.moveaxis(c, -1, 0) for c in (a, b))
    found = np.empty((3, *np.broadcast_shapes(a.shape, b.shape)[:-1]))
    for component, (p, q, r, s) in zip(found, ((y, w, z, v), (z, u, x, w), (x, v, y, u)), strict=True):
        np.multiply(p, q, out=component)
        np.subtract(component, r * s, out=component)
    return np.moveaxis(found, 0, -1)


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the dot products of vectors along the last axis."""
    return np.asarray(a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2])


def lengths(vectors: FloatArray) -> FloatArray:
    """Return the lengths of vectors along the last axis."""
    return np.asarray(np.sqrt(dot(vectors, vectors)))


def extent(points: FloatArray) -> float:
    """Return the largest extent of points, shape (..., 3), along an axis."""
    return float(np.ptp(points.reshape(-1, 3), axis=0).max())


def closed_directions(surface: ParametricSurface) -> tuple[bool, bool]:
    """Tell whether the surface is closed in u and in v: whether the edges where that parameter ends are one curve.

    Edges that are one point each are not closed.
    """
    u, v = (spread(breaks, 16) for breaks in surface.breakpoints)
    p = surface.evaluate_grid(u, v)
    limit = CLOSED * extent(p)

    def is_closed(rows: FloatArray) -> bool:
        away = np.abs(rows - rows[0]).max(axis=(1, 2))
        return bool(away[-1] <= limit < min(extent(rows[0]), away.max()))

    return is_closed(p), is_closed(p.transpose(1, 0, 2))


def turn_window(surface: ParametricSurface) -> float:
    """Return h, 1/50 of the mean length of the sections v = const: in model units; the mean is over the parameter v.

    Raises
    ------
    InputError
        These sections have no length.

    Source: the measures of the design document.
    """
    u_breaks, v_breaks = surface.breakpoints
    (u, of_u), (v, of_v) = (
        gauss_rule(breaks, 2 * max(4, -(-total // (len(breaks) - 1))) - 1)
        for breaks, total in ((u_breaks, 32), (v_breaks, 12))
    )
    speed = lengths(surface.evaluate_grid(u.T.ravel(), v.T.ravel(), 1, 0))
    mean = float(of_u.T.ravel() @ speed @ of_v.T.ravel()) / float(v_breaks[-1] - v_breaks[0])
    if not (mean > 0 and np.isfinite(mean)):
        raise InputError(f"surface: its sections v = const have the mean length {mean}, expected a positive one")
    return WINDOW * mean


def unit_normals(pu: FloatArray, pv: FloatArray) -> FloatArray:
    """Return P_u x P_v made unit vectors, shape (..., 3); NaN where there is no tangent plane."""
    # Unit tangents first: nothing overflows, whatever the units.
    tangents = []
    for tangent in (pu, pv):
        speed = lengths(tangent)
        tangents.append(tangent * np.divide(1.0, speed, out=np.zeros_like(speed), where=speed > 0)[..., None])
    normal = cross(*tangents)
    area = lengths(normal)
    return normal / np.where(area > _DEGENERATE, area, np.nan)[..., None]


def no_tangent_plane() -> InputError:
    """Return what is to be said of a surface that is a curve or a point."""
    return InputError("surface: has no tangent plane anywhere, expected one that is not a curve or a point")


def angles(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angles between vectors, in degrees, shape (...)."""
    return np.asarray(np.degrees(np.arctan2(lengths(cross(a, b)), dot(a, b))))


def least_on_grid(
    value: Callable[[FloatArray, FloatArray], FloatArray], u: FloatArray, v: FloatArray
) -> tuple[float, float, float]:
    """Return the least value on the grid u x v, then on ever finer ones around it, and its u and v; NaN never is least.

    `u` and `v` are sorted, and the finer grids stay between the neighbours of what was least.
    """
    best = np.inf, float(u[0]), float(v[0])
    for _ in range(_ZOOMS):
        values = np.nan_to_num(value(u, v), nan=np.inf, posinf=np.inf)
        i, j = divmod(int(values.argmin()), values.shape[1])
        least, before = float(values[i, j]), best[0]
        if least < before:
            best = least, float(u[i]), float(v[j])
        if not before - least > _ENOUGH * abs(least):
            break
        u = np.linspace(u[max(i - 1, 0)], u[min(i + 1, len(u) - 1)], 9)
        v = np.linspace(v[max(j - 1, 0)], v[min(j + 1, len(v) - 1)], 9)
    return best
