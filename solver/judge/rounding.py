"""What rounding of control points may do to the derivatives of a surface along an edge."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.base import Base
from semispline.solver.judge.de_boor import end_differences
from semispline.solver.splines import BSplineSurface, bounding_box, breakpoints, merge_breakpoints

# The bound on rounding counts each control point once; a few operations follow before it is measured.
_ROUNDINGS = 8.0


def derivative_noises(base: Base, origin: FloatArray, order: int = 2) -> FloatArray:
    """Bound what rounding may do to the derivatives, shape (order + 1, order + 1): across in rows, along in columns.

    That of storing the control points, once, and that of some operations with them, which are counted from `origin`.
    """
    eps = float(np.finfo(float).eps)
    box = bounding_box(base.surface)
    stored = eps / 2 * float(np.linalg.norm(np.abs(box).max(axis=0)))
    worked = _ROUNDINGS * eps * float(np.abs(box - origin).max())
    across, along = _directions(base, order)
    at_end = base.side[1] == "1"
    first = np.max([_factors(degree, _end_widths(degree, knots, at_end, order)) for degree, knots in across], 0)
    second = np.max([_factors(degree, _inner_widths(degree, knots, order)) for degree, knots in along], 0)
    factors = np.multiply.outer(first, second)
    if base.surface.is_rational and (ratio := _weight_ratio(base, order)) > 1:
        factors = _quotient_factors(factors, ratio)
        # Weights are rounded, too: a part e of one moves the quotient f by e (P - f) times its share.
        weighed = eps * float(np.abs(box - origin).max())
        return np.asarray((stored + worked) * factors + weighed * _of_product(factors))
    return np.asarray((stored + worked) * factors)


@dataclass(frozen=True, eq=False)
class EdgeNoises:
    """What rounding may do to derivatives along an edge.

    Attributes
    ----------
    derivatives : ndarray, shape (order + 1, order + 1)
        To each of them: `derivative_noises`.
    rows : ndarray, shape (3, 3)
        To cross derivatives of order 0 to 2, in rows, by each row of control points next to the edge: with signs. Where
        these are not the same for all points of the edge, each derivative counts as a row of its own.
    along : ndarray, shape (3,)
        How much derivatives along the edge, of order 0 to 2, may magnify an error of such a row.
    """

    derivatives: FloatArray
    rows: FloatArray
    along: FloatArray


def edge_noises(base: Base, origin: FloatArray, order: int = 2) -> EdgeNoises:
    """Bound what rounding may do to the derivatives along an edge, counted from `origin`, up to `order`."""
    noises = derivative_noises(base, origin, order)
    one = noises[0, 0]
    along = noises[0, :3] / one if one > 0 else np.ones(3)
    surface = base.surface
    if surface.is_rational:
        return EdgeNoises(noises, np.diag(noises[:3, 0]), along)
    if base.side[0] == "u":
        degree, knots = surface.degree_u, surface.knots_u
    elif isinstance(surface, BSplineSurface):
        degree, knots = surface.degree_v, surface.knots_v
    else:
        return EdgeNoises(noises, np.diag(noises[:3, 0]), along)
    return EdgeNoises(noises, one * end_differences(degree, knots, base.side[1] == "1", 2), along)


def _directions(base: Base, order: int) -> tuple[list[tuple[int, FloatArray]], list[tuple[int, FloatArray]]]:
    """Return degree and knots across the edge, and along it: of each curve that is read."""
    surface, across_u = base.surface, base.side[0] == "u"
    in_u = [(surface.degree_u, surface.knots_u)]
    if isinstance(surface, BSplineSurface):
        in_v = [(surface.degree_v, surface.knots_v)]
    else:
        curves = surface.control_curves
        if across_u:
            curves = curves[: order + 1] if base.side[1] == "0" else curves[-order - 1 :]
        in_v = [(curve.degree, curve.knots) for curve in curves]
    return (in_u, in_v) if across_u else (in_v, in_u)


def _end_widths(degree: int, knots: FloatArray, at_end: bool, order: int) -> list[float]:
    """Return the least distance of knots that each order of difference at an end divides by: the first span."""
    steps = np.abs(knots[::-1] - knots[-1]) if at_end else knots - knots[0]
    return [float(steps[degree + 1])] * order


def _inner_widths(degree: int, knots: FloatArray, order: int) -> list[float]:
    """Return the least distance of knots that each order of difference divides by anywhere."""
    result = []
    for s in range(order):
        p = max(degree - s, 1)
        t = knots[degree - p : len(knots) - degree + p]
        widths = t[1 + p : -1] - t[1 : -1 - p]
        result.append(float(widths[widths > 0].min()))
    return result


def _factors(degree: int, widths: list[float]) -> FloatArray:
    """Return how much a derivative of each order, from 0, may magnify an error of the control points."""
    factors = [1.0]
    for s, width in enumerate(widths):
        factors.append(factors[-1] * 2 * max(degree - s, 0) / width)
    return np.array(factors)


def _quotient_factors(factors: FloatArray, ratio: float) -> FloatArray:
    """Return the same for a quotient, whose weights differ by no more than a ratio wherever they act together.

    With f = X / w the error of the points has f w = X, and f^(k) w = X^(k) - sum C(k, j) w^(j) f^(k - j). Of X^(k) at
    most the largest weight times the factor is left, of w^(j) half the spread of the weights times it.
    """
    spread = (ratio - 1) / 2
    found = np.zeros_like(factors)
    for a, b in np.ndindex(*factors.shape):
        found[a, b] = ratio * factors[a, b] if a or b else 1.0
        for i, j in np.ndindex(a + 1, b + 1):
            if i or j:
                found[a, b] += comb(a, i) * comb(b, j) * spread * factors[i, j] * found[a - i, b - j]
    return found


def _of_product(factors: FloatArray) -> FloatArray:
    """Return how large derivatives of a product may be, by Leibniz' rule, where each of two has these bounds."""
    found = np.zeros_like(factors)
    for a, b in np.ndindex(*factors.shape):
        for i, j in np.ndindex(a + 1, b + 1):
            found[a, b] += comb(a, i) * comb(b, j) * factors[i, j] * factors[a - i, b - j]
    return found


def _weight_ratio(base: Base, order: int) -> float:
    """Return the largest ratio of weights that act together along an edge, in derivatives up to `order`."""
    surface = base.surface
    # What these read at an end.
    near = slice(-order - 1, None) if base.side[1] == "1" else slice(order + 1)
    rows: list[tuple[int, FloatArray, FloatArray]]
    if isinstance(surface, BSplineSurface):
        weights = np.ones(surface.control_points.shape[:2]) if surface.weights is None else surface.weights
        if base.side[0] == "v":
            rows = [(surface.degree_u, surface.knots_u, row) for row in weights.T[near]]
        else:
            rows = [(surface.degree_v, surface.knots_v, row) for row in weights[near]]
    else:
        every = [
            (c.degree, c.knots, np.ones(len(c.control_points)) if c.weights is None else c.weights)
            for c in surface.control_curves
        ]
        if base.side[0] == "u":
            rows = every[near]
        else:
            ends = [own[near] for _, _, own in every]
            low, high = (np.array([pick(end) for end in ends]) for pick in (min, max))
            rows = [(surface.degree_u, surface.knots_u, side) for side in (low, high)]
    breaks = merge_breakpoints(*(breakpoints(knots) for _, knots, _ in rows))
    middles = (breaks[:-1] + breaks[1:]) / 2
    acting = []
    for degree, knots, own in rows:
        windows = np.lib.stride_tricks.sliding_window_view(own, degree + 1)
        acting.append(windows[np.searchsorted(knots, middles, side="right") - 1 - degree])
    together = np.concatenate(acting, axis=1)
    return float((together.max(axis=1) / together.min(axis=1)).max())
