"""Curvature of sections and its rates from derivatives that Open CASCADE evaluates, whose own analysis ends at G2.

The section is followed as a curve in space, c(u) = X(u, eta(u)) with (c - X0) . T = 0, and its curvature differentiated
by the product rule: formulas of their own, and no evaluation of ours.
"""

import numpy as np

from helpers.occ import to_geom
from semispline import BSplineSurface

FRACTIONS = (0.03, 0.35, 0.71, 0.96)


def _geometry(base):
    """Geom_BSplineSurface, whether u runs across, and the place of the edge, always at the start of its parameter.

    At the end of a span of high degree Open CASCADE's derivatives lose a few digits.
    """
    surface = base.surface if isinstance(base.surface, BSplineSurface) else base.surface.to_bspline()
    geometry, across_u = to_geom(surface), base.edge[0] == "u"
    if base.edge[1] == "1":
        geometry = geometry.UReversed() if across_u else geometry.VReversed()
    u0, _, v0, _ = geometry.Bounds()
    return geometry, across_u, u0 if across_u else v0


def _derivatives(base, order):
    """A function of s that returns X[i, j], i times into the surface and j times along its edge."""
    geometry, across_u, at = _geometry(base)

    def vector(s, i, j):
        if i == j == 0:
            point = geometry.Value(at, s) if across_u else geometry.Value(s, at)
        else:
            point = geometry.DN(at, s, i, j) if across_u else geometry.DN(s, at, j, i)
        return np.array([point.X(), point.Y(), point.Z()])

    return lambda s: {(i, j): vector(s, i, j) for i in range(order + 1) for j in range(order + 1 - i)}


def section(X, normal_like=None):
    """Normal, and (kappa, kappa_s, kappa_ss) of the section square to the edge, followed into the surface."""
    g = np.linalg.norm(X[0, 1])
    T = X[0, 1] / g
    top = max(i for i, _ in X)
    e = [0.0, 0.0, 0.0, 0.0]
    c = []
    for known in (
        lambda: X[1, 0],
        lambda: X[2, 0] + 2 * X[1, 1] * e[0] + X[0, 2] * e[0] ** 2,
        lambda: (
            X[3, 0] + 3 * X[2, 1] * e[0] + 3 * X[1, 2] * e[0] ** 2 + X[0, 3] * e[0] ** 3
            + 3 * (X[1, 1] + X[0, 2] * e[0]) * e[1]
        ),
        lambda: (
            X[4, 0] + 4 * X[3, 1] * e[0] + 6 * X[2, 2] * e[0] ** 2 + 4 * X[1, 3] * e[0] ** 3 + X[0, 4] * e[0] ** 4
            + 6 * (X[2, 1] + 2 * X[1, 2] * e[0] + X[0, 3] * e[0] ** 2) * e[1] + 3 * X[0, 2] * e[1] ** 2
            + 4 * (X[1, 1] + X[0, 2] * e[0]) * e[2]
        ),
    )[:top]:  # fmt: skip
        k = len(c)
        part = known()
        e[k] = -(part @ T) / g
        c.append(part + e[k] * X[0, 1])
    c1, c2, *higher = c
    normal = np.cross(T, c1) / np.linalg.norm(np.cross(T, c1))
    sign = 1.0
    if normal_like is not None and normal @ normal_like < 0:
        normal, sign = -normal, -1.0
    s = np.linalg.norm(c1)
    m, ds = np.cross(c1, c2) @ T, c1 @ c2 / s
    found = [m / s**3]
    if higher:
        dm = np.cross(c1, higher[0]) @ T
        slope = dm / s**3 - 3 * m * ds / s**4
        found.append(slope / s)
    if len(higher) > 1:
        dds = (c2 @ c2 + c1 @ higher[0]) / s - ds**2 / s
        ddm = (np.cross(c2, higher[0]) + np.cross(c1, higher[1])) @ T
        bend = ddm / s**3 - 6 * dm * ds / s**4 - 3 * m * dds / s**4 + 12 * m * ds**2 / s**5
        found.append(bend / s**2 - slope * ds / s**3)
    return normal, sign * np.array(found)


def relative_jumps(a, b, order, *, flipped=False):
    """Largest jumps of curvature and its rates up to those of `order`, from edge a into b, over the scales of G2..G4."""
    at_a, at_b = _derivatives(a, order), _derivatives(b, order)
    (a0, a1), (b0, b1) = a.range_along, b.range_along
    knots = [(base.breakpoints_along() - low) / (high - low) for base, (low, high) in ((a, (a0, a1)), (b, (b0, b1)))]
    breaks = np.unique(np.round(np.concatenate([knots[0], 1 - knots[1] if flipped else knots[1]]), 12))
    jumps, values = [], []
    for low, high in zip(breaks[:-1], breaks[1:], strict=True):
        for t in low + (high - low) * np.array(FRACTIONS):
            normal, of_a = section(at_a(a0 + t * (a1 - a0)))
            _, of_b = section(at_b(b0 + (1 - t if flipped else t) * (b1 - b0)), normal)
            # Both are followed away from the edge, so in opposite directions: the rate changes its sign.
            of_a[1:2] *= -1
            jumps.append(np.abs(of_a - of_b))
            values.append(np.abs([of_a, of_b]).max(axis=0))
    largest = np.max(values, axis=0)
    nets = [base.surface if isinstance(base.surface, BSplineSurface) else base.surface.to_bspline() for base in (a, b)]
    size = np.ptp(np.concatenate([net.control_points.reshape(-1, 3) for net in nets]), axis=0).max()
    scales = [max(value, largest[0] ** (k + 1), 1e-3 / size ** (k + 1)) for k, value in enumerate(largest)]
    return np.max(jumps, axis=0) / scales
