"""What rounding of control points may do to the derivatives of a surface along an edge."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.de_boor import end_differences
from semispline.solver.splines import BSplineSurface, bounding_box, breakpoints, merge_breakpoints

# The bound on rounding counts each control point once; a few operations follow before it is measured.
_ROUNDINGS = 8.0


def derivative_noises(base: Base, origin: FloatArray, order: int = 2) -> FloatArray:
    """Bound what rounding may do to the derivatives, shape (order + 1, order + 1): across in rows, along in columns.

    That of storing the control points, once, and that of some operations with them, which are counted from `origin`.
    """
    return _noises(base, origin, order, _distance(base, np.zeros(3)), _weight_ratio(base, order))


def _noises(base: Base, origin: FloatArray, order: int, stored: float, ratio: float) -> FloatArray:
    """Return `derivative_noises` as if the points were stored at a distance, and weights had a ratio."""
    eps = float(np.finfo(float).eps)
    worked = float(np.abs(bounding_box(base.surface) - origin).max())
    across, along = _directions(base, order)
    at_end = base.edge[1] == "1"
    first = np.max([_factors(degree, _end_widths(degree, knots, at_end, order)) for degree, knots in across], 0)
    second = np.max([_factors(degree, _inner_widths(degree, knots, order)) for degree, knots in along], 0)
    factors = np.multiply.outer(first, second)
    of_points = eps * (stored / 2 + _ROUNDINGS * worked)
    if ratio > 1:
        factors = _quotient_factors(factors, ratio)
        # Weights are rounded, too: a part e of one moves the quotient f by e (P - f) times its share.
        return np.asarray(of_points * factors + eps * worked * _of_product(factors))
    return np.asarray(of_points * factors)


def _distance(base: Base, origin: FloatArray) -> float:
    """Return how far from a point the control points may be."""
    return float(np.linalg.norm(np.abs(bounding_box(base.surface) - origin).max(axis=0)))


# What makes rounding less than this many times larger is not what makes it too large.
_TELLING = 50.0


@dataclass(frozen=True)
class RoundingCauses:
    """By how much the bound on rounding at a contact is larger for coordinates far from the origin, and for weights.

    Attributes
    ----------
    distance : float
        Of the origin, in sizes of both surfaces.
    by_distance : float
        How many times larger the bound is than at the origin.
    weight_ratios : (float, float)
        The largest ratio of weights that act together at the edge of a, and of b.
    by_weights : float
        How many times larger the bound is than with equal weights.
    """

    distance: float
    by_distance: float
    weight_ratios: tuple[float, float]
    by_weights: float

    def words(self, names: tuple[str, str] = ("surface a", "surface b")) -> str:
        """Say which of both make the bound much larger, the worse one first, and what to try; nothing if none does."""
        # A blend has its weights from the base: that is named unless it is much the better.
        second = self.weight_ratios[1] > 2 * self.weight_ratios[0]
        causes = (
            (
                self.by_weights,
                f"weights of {names[second]} that act together differ by a factor of {self.weight_ratios[second]:.2g}: "
                "even them out, or ask for a lower continuity",
            ),
            (
                self.by_distance,
                f"the origin is {self.distance:.0e} times the size of the surfaces away: work in coordinates nearer "
                "to it",
            ),
        )
        return "; ".join(text for share, text in sorted(causes, reverse=True) if share > _TELLING)


def rounding_causes(a: Base, b: Base, order: int) -> RoundingCauses:
    """Tell what makes rounding large where two surfaces meet: by the bounds on derivatives across, up to an order.

    Parameters
    ----------
    a, b : Base
    order : int
        Of contact.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> near = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> far = BSplineSurface(1, 1, k, k, near.control_points + 1e6)
    >>> rounding_causes(Base(near, "u1"), Base(near, "u0"), 1).words()
    ''
    >>> rounding_causes(Base(far, "u1"), Base(far, "u0"), 1).words()
    'the origin is 1e+06 times the size of the surfaces away: work in coordinates nearer to it'
    """
    origin, bases = local_origin(a.surface, b.surface), (a, b)
    boxes = np.stack([bounding_box(base.surface) for base in bases])
    size = float((boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)).max())
    ratios = [_weight_ratio(base, order) for base in bases]
    away, near = ([_distance(base, at) for base in bases] for at in (np.zeros(3), origin))

    def bound(stored: list[float], weights: list[float]) -> FloatArray:
        sides = zip(bases, stored, weights, strict=True)
        return np.asarray(sum(_noises(base, origin, order, x, ratio)[:, 0] for base, x, ratio in sides))

    whole, nearer, even = bound(away, ratios), bound(near, ratios), bound(away, [1.0, 1.0])
    by_distance, by_weights = (
        # Surfaces of low degree have no higher derivatives that could round.
        float(np.divide(whole, other, out=np.ones_like(whole), where=other > 0).max())
        for other in (nearer, even)
    )
    return RoundingCauses(float(np.abs(boxes).max()) / size, by_distance, (ratios[0], ratios[1]), by_weights)


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
    if base.edge[0] == "u":
        degree, knots = surface.degree_u, surface.knots_u
    elif isinstance(surface, BSplineSurface):
        degree, knots = surface.degree_v, surface.knots_v
    else:
        return EdgeNoises(noises, np.diag(noises[:3, 0]), along)
    return EdgeNoises(noises, one * end_differences(degree, knots, base.edge[1] == "1", 2), along)


def noises_of_derivatives(at: Mapping[tuple[int, int], FloatArray], order: int) -> EdgeNoises:
    """Return the same where derivatives, each of shape (K, 3), were rounded but once, and some operations follow."""
    noises = np.zeros((order + 1, order + 1))
    for key, values in at.items():
        noises[key] = _ROUNDINGS * float(np.finfo(float).eps * np.abs(values).max())
    rows, along = noises[:3, 0], np.ones(3)
    for j in (1, 2):
        across = rows[: 3 - j]
        along[j] = np.max(np.divide(noises[: 3 - j, j], across, out=np.zeros(3 - j), where=across > 0))
    return EdgeNoises(noises, np.diag(rows), along)


def _directions(base: Base, order: int) -> tuple[list[tuple[int, FloatArray]], list[tuple[int, FloatArray]]]:
    """Return degree and knots across the edge, and along it: of each curve that is read."""
    surface, across_u = base.surface, base.edge[0] == "u"
    in_u = [(surface.degree_u, surface.knots_u)]
    if isinstance(surface, BSplineSurface):
        in_v = [(surface.degree_v, surface.knots_v)]
    else:
        curves = surface.control_curves
        if across_u:
            curves = curves[: order + 1] if base.edge[1] == "0" else curves[-order - 1 :]
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
    if not surface.is_rational:
        return 1.0
    # What these read at an end.
    near = slice(-order - 1, None) if base.edge[1] == "1" else slice(order + 1)
    rows: list[tuple[int, FloatArray, FloatArray]]
    if isinstance(surface, BSplineSurface):
        weights = np.ones(surface.control_points.shape[:2]) if surface.weights is None else surface.weights
        if base.edge[0] == "v":
            rows = [(surface.degree_u, surface.knots_u, row) for row in weights.T[near]]
        else:
            rows = [(surface.degree_v, surface.knots_v, row) for row in weights[near]]
    else:
        every = [
            (c.degree, c.knots, np.ones(len(c.control_points)) if c.weights is None else c.weights)
            for c in surface.control_curves
        ]
        if base.edge[0] == "u":
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
