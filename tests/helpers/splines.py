"""Random splines for property tests, and Cox-de Boor in exact fractions: shares only the classes with `solver`."""

from fractions import Fraction
from math import comb

import numpy as np
from hypothesis import strategies as st

from semispline import BSplineCurve, BSplineSurface, SemiStructuredSurface

DOMAINS = ((0.0, 1.0), (-2.0, 3.5), (100.0, 101.0))


@st.composite
def knot_vectors(draw, degree, domain=(0.0, 1.0), most=3):
    """Clamped, gaps from 1e-3 of the domain up, as likely narrow as wide, inner multiplicities up to the degree."""
    gaps = draw(st.lists(st.one_of(st.floats(0.005, 1.0), st.just(0.004)), min_size=1, max_size=most + 1))
    inner = np.cumsum(gaps)[:-1] / sum(gaps)
    counts = [draw(st.integers(1, degree)) for _ in inner]
    start, end = domain
    ends = np.ones(degree + 1)
    return np.concatenate([start * ends, np.repeat(start + inner * (end - start), counts), end * ends])


def _numbers(draw):
    return np.random.default_rng(draw(st.integers(0, 2**32 - 1)))


@st.composite
def curves(draw, domain=(0.0, 1.0), degrees=(1, 6), most=3, rational=False):
    degree = draw(st.integers(*degrees))
    knots = draw(knot_vectors(degree, domain, most))
    rng, n = _numbers(draw), len(knots) - degree - 1
    points = rng.uniform(-1, 1, (n, 3))
    return BSplineCurve(degree, knots, points, rng.uniform(0.5, 2.0, n) if rational else None)


@st.composite
def bspline_surfaces(draw, rational=None, degrees=(1, 6), most=3):
    p, q = draw(st.integers(*degrees)), draw(st.integers(*degrees))
    knots_u = draw(knot_vectors(p, draw(st.sampled_from(DOMAINS)), most))
    knots_v = draw(knot_vectors(q, draw(st.sampled_from(DOMAINS)), most))
    shape = len(knots_u) - p - 1, len(knots_v) - q - 1
    rng = _numbers(draw)
    weighted = draw(st.booleans()) if rational is None else rational
    weights = rng.uniform(0.5, 2.0, shape) if weighted else None
    return BSplineSurface(p, q, knots_u, knots_v, rng.uniform(-1, 1, (*shape, 3)), weights)


@st.composite
def semistructured_surfaces(draw, degrees=(1, 6), most=2, rational=False):
    """With `rational` some rows carry weights, at least one of them, and some may not."""
    p = draw(st.integers(*degrees))
    knots_u = draw(knot_vectors(p, draw(st.sampled_from(DOMAINS)), most))
    domain = draw(st.sampled_from(DOMAINS))
    rng, rows = _numbers(draw), []
    for i in range(len(knots_u) - p - 1):
        q = draw(st.integers(*degrees))
        knots = draw(knot_vectors(q, domain, most))
        n = len(knots) - q - 1
        points = rng.uniform(-1, 1, (n, 3))
        weighted = rational and (i == 0 or draw(st.booleans()))
        rows.append(BSplineCurve(q, knots, points, rng.uniform(0.5, 2.0, n) if weighted else None))
    return SemiStructuredSurface(p, knots_u, rows)


def surfaces():
    return st.one_of(bspline_surfaces(), semistructured_surfaces())


def parameters(rng, domain, knots=(), count=12):
    """Random values of a range, its two ends, and every knot given."""
    return np.concatenate([rng.uniform(*domain, count), domain, np.unique(knots)])


def basis(degree, knots, i, x, order=0):
    """Basis function i or its derivative at x, by definition, in Fractions; right-continuous, left at the last knot."""
    if order:
        total = Fraction(0)
        for sign, j in ((1, i), (-1, i + 1)):
            width = knots[j + degree] - knots[j]
            if width:
                total += sign * degree * basis(degree - 1, knots, j, x, order - 1) / width
        return total
    if degree == 0:
        last = knots[i] < knots[i + 1] == knots[-1] == x
        return Fraction(int(knots[i] <= x < knots[i + 1] or last))
    total = Fraction(0)
    if knots[i + degree] > knots[i]:
        total += (x - knots[i]) / (knots[i + degree] - knots[i]) * basis(degree - 1, knots, i, x)
    if knots[i + degree + 1] > knots[i + 1]:
        width = knots[i + degree + 1] - knots[i + 1]
        total += (knots[i + degree + 1] - x) / width * basis(degree - 1, knots, i + 1, x)
    return total


def exact_curve(degree, knots, points, x, order=0):
    """Point of a curve in Fractions; floats are taken for the rational numbers that they are."""
    if order > degree:
        return [Fraction(0)] * len(points[0])
    knots, x = [Fraction(float(t)) for t in knots], Fraction(float(x))
    values = [basis(degree, knots, i, x, order) for i in range(len(points))]
    return [sum(b * _fraction(p[d]) for b, p in zip(values, points, strict=True)) for d in range(len(points[0]))]


def _fraction(value):
    return value if isinstance(value, Fraction) else Fraction(float(value))


def exact_point(surface, u, v, du=0, dv=0):
    """Point of a surface, or a mixed derivative, in Fractions."""
    if isinstance(surface, SemiStructuredSurface):
        rows = [(c.degree, c.knots, c.control_points, c.weights) for c in surface.control_curves]
    else:
        weights = [None] * len(surface.control_points) if surface.weights is None else surface.weights
        pairs = zip(surface.control_points, weights, strict=True)
        rows = [(surface.degree_v, surface.knots_v, points, w) for points, w in pairs]
    rational = any(w is not None for _, _, _, w in rows)
    rows = [(q, knots, _exact_homogeneous(points, w, rational)) for q, knots, points, w in rows]

    def tensor(a, b):
        along = [exact_curve(q, knots, points, v, b) for q, knots, points in rows]
        return exact_curve(surface.degree_u, surface.knots_u, along, u, a)

    if not rational:
        return tensor(du, dv)
    return _exact_quotient({(a, b): tensor(a, b) for a in range(du + 1) for b in range(dv + 1)})[du, dv]


def exact_rational_curve(curve, x, order=0):
    """Point of a rational curve, or a derivative, in Fractions."""
    points = _exact_homogeneous(curve.control_points, curve.weights, True)
    raw = {(0, k): exact_curve(curve.degree, curve.knots, points, x, k) for k in range(order + 1)}
    return _exact_quotient(raw)[0, order]


def _exact_homogeneous(points, weights, rational):
    rows = [[_fraction(x) for x in point] for point in points]
    if not rational:
        return rows
    own = [Fraction(1)] * len(rows) if weights is None else [_fraction(w) for w in weights]
    return [[x * w for x in point] + [w] for point, w in zip(rows, own, strict=True)]


def _exact_quotient(raw):
    """Derivatives of X / w from those of (X, w), by the product rule on X = w S."""
    known = {}
    for a, b in raw:
        value = raw[a, b][:3]
        for i in range(a + 1):
            for j in range(b + 1):
                if i or j:
                    factor = comb(a, i) * comb(b, j) * raw[i, j][3]
                    value = [x - factor * y for x, y in zip(value, known[a - i, b - j], strict=True)]
        known[a, b] = [x / raw[0, 0][3] for x in value]
    return known


def _differences(degree, knots, points, order):
    """Derivative control points along axis 0, from the definition, one by one."""
    for s in range(order):
        p, t = degree - s, knots[s : len(knots) - s]
        new = []
        for i in range(len(points) - 1):
            width = t[i + p + 1] - t[i + 1]
            new.append(p * (points[i + 1] - points[i]) / width if width > 0 else 0 * points[i])
        points = np.array(new) if new else 0 * points[:1]
    return points


def _gain(degree, knots, order):
    """How much a derivative can exceed the spline: the product of 2 p / (narrowest support)."""
    gain = 1.0
    for s in range(min(order, degree)):
        p, t = degree - s, knots[s : len(knots) - s]
        widths = t[1 + p : -1] - t[1 : -1 - p]
        gain *= 2 * p / widths[widths > 0].min()
    return gain


def scale(surface, du=0, dv=0):
    """Largest control point of a derivative; for a rational surface what the quotient rule makes of such numbers."""
    semi = isinstance(surface, SemiStructuredSurface)
    if semi:
        rows = [(c, _weighted(c.control_points, c.weights, surface.is_rational)) for c in surface.control_curves]
        net = np.concatenate([points for _, points in rows])
    else:
        net = _weighted(surface.control_points, surface.weights, surface.weights is not None)

    def largest(a, b):
        if semi:
            # v-derivatives of each row; a u-difference at most doubles them for each order.
            along = [np.abs(_differences(c.degree, c.knots, x, b)).max(axis=0) for c, x in rows if c.degree >= b]
            return np.max(along or [np.zeros(net.shape[1])], axis=0) * _gain(surface.degree_u, surface.knots_u, a)
        if a > surface.degree_u or b > surface.degree_v:
            return np.zeros(net.shape[2])
        across = _differences(surface.degree_u, surface.knots_u, net, a).transpose(1, 0, 2)
        points = _differences(surface.degree_v, surface.knots_v, across, b)
        return np.abs(points).reshape(-1, net.shape[2]).max(axis=0)

    if net.shape[-1] == 3:
        return max(float(largest(du, dv).max()), 1e-30)
    known = {}
    for a in range(du + 1):
        for b in range(dv + 1):
            total = largest(a, b)[:3].max()
            for i in range(a + 1):
                for j in range(b + 1):
                    if i or j:
                        total += comb(a, i) * comb(b, j) * largest(i, j)[3] * known[a - i, b - j]
            known[a, b] = total / net[..., 3].min()
    return max(float(known[du, dv]), 1e-30)


def _weighted(points, weights, rational):
    if not rational:
        return points
    w = np.ones(points.shape[:-1]) if weights is None else weights
    return np.concatenate([points * w[..., None], w[..., None]], axis=-1)
