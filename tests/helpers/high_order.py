"""Blends with contact of any order, made by hand: rows from derivatives, derivatives from the chain rule."""

from math import comb, factorial

import numpy as np

from helpers.bases import FACING, moved, turned
from semispline import Base, BSplineCurve, BSplineSurface, SemiStructuredSurface

# The inner knots that carry order n at both ends without a free row.
SIZES = {3: ((4, 3), (5, 2), (6, 1), (7, 0)), 4: ((5, 4), (6, 3), (7, 2), (8, 1), (9, 0))}


def uniform(degree, inner):
    return np.concatenate([np.zeros(degree + 1), np.linspace(0, 1, inner + 2)[1:-1], np.ones(degree + 1)])


def inwards(base):
    """The same surface with contact at u0, along v as before."""
    edge, surface = base.edge, base.surface
    if edge[0] == "v":
        surface = turned(surface, "v0", False)
    if edge[1] == "1":
        surface = turned(surface, "u1", False)
    return surface


def cross_derivatives(surface, order):
    """Control points of d^k R / dw^k along the edge u0, k = 0..order: differences of rows, by definition."""
    rows, knots, found = surface.control_points, surface.knots_u, []
    degree = surface.degree_u
    for s in range(order + 1):
        found.append(rows[0] if len(rows) else 0 * found[0])
        p, t = degree - s, knots[s : len(knots) - s]
        if p < 1:
            rows = rows[:0]
            continue
        width = t[1 + p : -1] - t[1 : -1 - p]
        rows = p * np.diff(rows, axis=0) / np.where(width > 0, width, np.inf)[:, None, None]
    return np.array(found)


def bell(p):
    """B[k][j] with d^k R(phi(u)) = sum_j B[k][j] R_j, phi = p_1 u + p_2 u^2 / 2! + .., p = (p_1, ..)."""
    n = len(p)
    b = np.zeros((n + 1, n + 1))
    b[0, 0] = 1
    for k in range(1, n + 1):
        for j in range(1, k + 1):
            b[k, j] = sum(comb(k - 1, i - 1) * p[i - 1] * b[k - i, j - 1] for i in range(1, k - j + 2))
    return b


def rows(derivatives, degree, knots):
    """Rows P_0.. of a spline with these derivatives at its start: P_i = sum_k (p - k)! / p! e_k(u_1..u_i) D_k."""
    found, e = [], np.zeros(len(derivatives))
    e[0] = 1.0
    for i in range(len(derivatives)):
        if i:
            e[1:] += (knots[degree + i] - knots[0]) * e[:-1].copy()
        found.append(sum(factorial(degree - k) / factorial(degree) * e[k] * d for k, d in enumerate(derivatives)))
    return np.array(found)


def reparametrised(base, p, faults=None):
    """Derivatives D_0..D_n of a blend that leaves a base, by p = (p_1, .., p_n), p_1 < 0; `faults` scale entries."""
    matrix = bell(p)
    for place, factor in (faults or {}).items():
        matrix[place] *= factor
    return np.tensordot(matrix, cross_derivatives(inwards(base), len(p)), 1)


def hand_made(a, b, order, *, p_a, p_b, size=None, faults=None):
    """The blend of two bases that face each other, contact of this order; b's parameter along its edge taken to a's.

    `faults` multiply entries (k, j) of the chain rule at a: the factor of R_j in D_k.
    """
    degree, inner = size or SIZES[order][-1]
    knots = uniform(degree, inner)
    at_a = rows(reparametrised(a, p_a, faults), degree, knots)
    at_b = rows(reparametrised(b, p_b), degree, knots)
    along = []
    for base in (a, b):
        s = inwards(base)
        (low, high), (start, end) = base.range_along, a.range_along
        along.append((s.degree_v, np.clip(start + (s.knots_v - low) / (high - low) * (end - start), start, end)))
    curves = [BSplineCurve(*along[0], row) for row in at_a]
    curves += [BSplineCurve(*along[1], row) for row in at_b[::-1]]
    return SemiStructuredSurface(degree, knots, curves)


def sheet(rng, ranges):
    """A wavy patch of degrees 4 and 3 over a sheared unit square, u away from its edge u0."""
    net = np.zeros((7, 6, 3))
    knots = []
    for axis, (degree, n) in enumerate(((4, 7), (3, 6))):
        t = uniform(degree, n - degree - 1)
        greville = np.array([t[i + 1 : i + degree + 1].mean() for i in range(n)])
        net[..., axis] = greville[:, None] if axis == 0 else greville
        low, high = ranges[axis]
        knots.append(low + t * (high - low))
    net[..., 1] += rng.uniform(-0.4, 0.4) * net[..., 0]
    net += rng.uniform(-0.02, 0.02, net.shape)
    net[..., 2] += 0.1 * rng.uniform(-1, 1, (7, 6))
    return BSplineSurface(4, 3, *knots, net)


def facing(rng, order, edges=("u0", "u0")):
    """Two random bases over a gap of about 1, and p_1, .., p_order of a sensible size for both."""
    found = []
    for k, edge in enumerate(edges):
        ranges = [(low := float(rng.uniform(-2, 2)), low + float(rng.uniform(0.5, 4))) for _ in range(2)]
        surface = sheet(rng, ranges)
        if k:
            surface = moved(surface, FACING, (-1.0, 0.1, 0.4))
        # The blend runs over 1, and so do the bases over the width of their parameter.
        width = ranges[0][1] - ranges[0][0]
        p = width * np.concatenate([[-rng.uniform(0.7, 1.4)], rng.uniform(0.3, 1, order - 1)])
        found.append((Base(turned(surface, edge, False), edge), p))
    (a, p_a), (b, p_b) = found
    return a, b, p_a, p_b
