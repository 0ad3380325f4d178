"""How far a surface is from folding: area element and turn of the normal over samples, and what can be proved."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from solver.arrays import FloatArray
from solver.knots import inner_knots
from solver.operations import insert_knots
from solver.surfaces import BSplineSurface, Surface

# Samples in each span: enough that the normal of a smooth cubic span turns by a few degrees between neighbours.
_PER_SPAN = 8
# Spans that are worked on at once.
_SPANS_AT_ONCE = 1024


@dataclass(frozen=True)
class Regularity:
    """How far a surface is from folding.

    Attributes
    ----------
    least_area_ratio : float
        Least |P_u x P_v| over its mean.
    largest_turn_degrees : float
        Largest angle between the normals of neighbouring samples; 180 where there is no normal.
    proved_area_ratio : float or None
        A lower bound of |P_u x P_v| over its mean, proved by Bernstein coefficients up to rounding; None where they
        prove nothing (then the surface may still be regular) or the surface is rational.
    """

    least_area_ratio: float
    largest_turn_degrees: float
    proved_area_ratio: float | None


def measure_regularity(surface: Surface) -> Regularity:
    """Measure the area element and the turn of the normal on a grid of 8 samples in every span.

    Examples
    --------
    >>> from solver.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> measure_regularity(flat)
    Regularity(least_area_ratio=1.0, largest_turn_degrees=0.0, proved_area_ratio=1.0)
    """
    u_breaks, v_breaks = surface.breakpoints
    u = _samples(u_breaks)
    least, largest, total, count, turn = np.inf, 0.0, 0.0, 0, 0.0
    # Part by part along v: a long surface has more samples than memory should hold at once.
    for at in range(0, len(v_breaks) - 1, _SPANS_AT_ONCE):
        v = _samples(v_breaks[at : at + _SPANS_AT_ONCE + 1])
        cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
        area = np.linalg.norm(cross, axis=2)
        least, largest = min(least, float(area.min())), max(largest, float(area.max()))
        if least <= 1e-14 * largest:
            return Regularity(0.0, 180.0, None)
        total, count = total + float(area.sum()), count + area.size
        normal = cross / area[..., None]
        turn = max(turn, _turn(normal[:-1], normal[1:]), _turn(normal[:, :-1], normal[:, 1:]))
    mean = total / count
    proved = area_bound(surface) / mean
    return Regularity(least / mean, turn, proved if proved > 0 else None)


def _turn(n1: FloatArray, n2: FloatArray) -> float:
    sine, cosine = np.linalg.norm(np.cross(n1, n2), axis=-1), np.sum(n1 * n2, axis=-1)
    return float(np.degrees(np.arctan2(sine, cosine).max()))


def _samples(breaks: FloatArray) -> FloatArray:
    inner = np.linspace(0, 1, _PER_SPAN, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def area_bound(surface: Surface) -> float:
    """Return a lower bound of |P_u x P_v|; not positive, or -inf for a rational surface, where nothing is proved.

    On each polynomial piece the bound is the least Bernstein coefficient of (P_u x P_v) . n, n its own mean normal.

    Source: range of a polynomial within its Bernstein coefficients; G. Farin, Curves and Surfaces for CAGD, ch. 6.
    """
    spline = surface if isinstance(surface, BSplineSurface) else surface.to_bspline()
    if spline.weights is not None:
        return -np.inf
    pieces = _bezier_pieces(spline)
    u_widths, v_widths = (np.diff(breaks) for breaks in spline.breakpoints)
    parts = (slice(at, at + _SPANS_AT_ONCE) for at in range(0, len(v_widths), _SPANS_AT_ONCE))
    return min(_least_height(pieces[:, part], u_widths, v_widths[part]) for part in parts)


def _least_height(pieces: FloatArray, u_widths: FloatArray, v_widths: FloatArray) -> float:
    """Return the least Bernstein coefficient of (P_u x P_v) . n over pieces of these widths."""
    p, q = pieces.shape[2] - 1, pieces.shape[3] - 1
    by_u = p * np.diff(pieces, axis=2) / u_widths[:, None, None, None, None]
    by_v = q * np.diff(pieces, axis=3) / v_widths[:, None, None, None]
    cross = _bernstein_cross(by_u, by_v)
    normal = cross.mean(axis=(2, 3))
    length = np.linalg.norm(normal, axis=2)
    if not length.min() > 0:
        return 0.0
    heights = np.einsum("abijx,abx->abij", cross, normal / length[..., None])
    return float(heights.min())


def _bezier_pieces(spline: BSplineSurface) -> FloatArray:
    """Return the Bezier nets of all polynomial pieces, shape (pieces in u, pieces in v, p + 1, q + 1, 3)."""
    p, q = spline.degree_u, spline.degree_v
    full = insert_knots(spline, _missing(spline.knots_u, p), _missing(spline.knots_v, q)).control_points
    # Neighbouring pieces share their end rows.
    rows, columns = (
        np.arange((n - 1) // degree)[:, None] * degree + np.arange(degree + 1)
        for n, degree in zip(full.shape[:2], (p, q), strict=True)
    )
    return np.asarray(full[rows[:, None, :, None], columns[None, :, None, :]])


def _missing(knots: FloatArray, degree: int) -> FloatArray:
    """Return the knots to insert so that all inner ones have multiplicity `degree`."""
    values, counts = np.unique(inner_knots(knots, degree), return_counts=True)
    return np.repeat(values, degree - counts)


def _bernstein_cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the Bernstein coefficients of the cross product of two vector polynomials on each piece."""
    (m, n), (k, r) = (tuple(d - 1 for d in x.shape[2:4]) for x in (a, b))
    total = np.zeros((*a.shape[:2], m + k + 1, n + r + 1, 3))
    for i in range(m + 1):
        for j in range(n + 1):
            weight = comb(m, i) * comb(n, j) * _binomials(k, r)[..., None]
            total[:, :, i : i + k + 1, j : j + r + 1] += np.cross(a[:, :, i : i + 1, j : j + 1], b * weight)
    return np.asarray(total / _binomials(m + k, n + r)[..., None])


def _binomials(m: int, n: int) -> FloatArray:
    return np.outer([comb(m, i) for i in range(m + 1)], [comb(n, j) for j in range(n + 1)])
