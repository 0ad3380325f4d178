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
def curves(draw, domain=(0.0, 1.0), degrees=(1, 6), most=3):
    degree = draw(st.integers(*degrees))
    knots = draw(knot_vectors(degree, domain, most))
    return BSplineCurve(degree, knots, _numbers(draw).uniform(-1, 1, (len(knots) - degree - 1, 3)))


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
def semistructured_surfaces(draw, degrees=(1, 6), most=2):
    p = draw(st.integers(*degrees))
    knots_u = draw(knot_vectors(p, draw(st.sampled_from(DOMAINS)), most))
    domain = draw(st.sampled_from(DOMAINS))
    rng, rows = _numbers(draw), []
    for _ in range(len(knots_u) - p - 1):
        q = draw(st.integers(*degrees))
        knots = draw(knot_vectors(q, domain, most))
        rows.append(BSplineCurve(q, knots, rng.uniform(-1, 1, (len(knots) - q - 1, 3))))
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
        rows = [exact_curve(c.degree, c.knots, c.control_points, v, dv) for c in surface.control_curves]
        return exact_curve(surface.degree_u, surface.knots_u, rows, u, du)
    net = [[[_fraction(x) for x in point] for point in row] for row in surface.control_points]
    if surface.weights is None:
        return _tensor(surface, net, u, v, du, dv)
    for row, weights in zip(net, surface.weights, strict=True):
        for j, w in enumerate(weights):
            row[j] = [x * _fraction(w) for x in row[j]] + [_fraction(w)]
    raw = {(a, b): _tensor(surface, net, u, v, a, b) for a in range(du + 1) for b in range(dv + 1)}
    known = {}
    for a, b in raw:
        value = raw[a, b][:3]
        for i in range(a + 1):
            for j in range(b + 1):
                if i or j:
                    factor = comb(a, i) * comb(b, j) * raw[i, j][3]
                    value = [x - factor * y for x, y in zip(value, known[a - i, b - j], strict=True)]
        known[a, b] = [x / raw[0, 0][3] for x in value]
    return known[du, dv]


def _tensor(surface, net, u, v, du, dv):
    rows = [exact_curve(surface.degree_v, surface.knots_v, row, v, dv) for row in net]
    return exact_curve(surface.degree_u, surface.knots_u, rows, u, du)


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
    if isinstance(surface, SemiStructuredSurface):
        # v-derivatives of each row; a u-difference at most doubles them for each order.
        rows = [_differences(c.degree, c.knots, c.control_points, dv) for c in surface.control_curves if c.degree >= dv]
        largest = max((np.abs(row).max() for row in rows), default=1e-30)
        return float(largest) * _gain(surface.degree_u, surface.knots_u, du)
    net = surface.control_points
    if surface.weights is not None:
        net = np.concatenate([net * surface.weights[..., None], surface.weights[..., None]], axis=2)

    def largest(a, b):
        if a > surface.degree_u or b > surface.degree_v:
            return np.zeros(net.shape[2])
        rows = _differences(surface.degree_u, surface.knots_u, net, a).transpose(1, 0, 2)
        points = _differences(surface.degree_v, surface.knots_v, rows, b)
        return np.abs(points).reshape(-1, net.shape[2]).max(axis=0)

    if surface.weights is None:
        return max(float(largest(du, dv).max()), 1e-30)
    known = {}
    for a in range(du + 1):
        for b in range(dv + 1):
            total = largest(a, b)[:3].max()
            for i in range(a + 1):
                for j in range(b + 1):
                    if i or j:
                        total += comb(a, i) * comb(b, j) * largest(i, j)[3] * known[a - i, b - j]
            known[a, b] = total / surface.weights.min()
    return float(known[du, dv])
