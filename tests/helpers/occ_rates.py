"""Curvature of sections and its rates from derivatives that Open CASCADE evaluates, whose own analysis ends at G2.

The section is followed as a curve in space, c(u) = X(u, eta(u)) with (c - X0) . T = 0, and its curvature differentiated
by the product rule: formulas of their own, and no evaluation of ours.
"""

import numpy as np

from helpers.occ import to_geom
from semispline import BSplineSurface

FRACTIONS = np.array([0.03, 0.35, 0.71, 0.96])


def _plain(base):
    return base.surface if isinstance(base.surface, BSplineSurface) else base.surface.to_bspline()


def _geometry(base):
    """Geom_BSplineSurface, whether u runs across, and the place of the edge, always at the start of its parameter.

    At the end of a span of high degree Open CASCADE's derivatives lose a few digits.
    """
    geometry, across_u = to_geom(_plain(base)), base.edge[0] == "u"
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


class Contact:
    """Two edges that meet, b's parameter running affinely with a's, against it where `flipped`."""

    def __init__(self, a, b, order, *, flipped=False):
        self.a, self.b, self.flipped = a, b, flipped
        self.at_a, self.at_b = _derivatives(a, order), _derivatives(b, order)

    def rates(self, s):
        """(kappa, kappa_s, kappa_ss) of both sides, at a parameter along edge a, with one normal, in one direction."""
        (a0, a1), (b0, b1) = self.a.range_along, self.b.range_along
        t = (s - a0) / (a1 - a0)
        normal, of_a = section(self.at_a(s))
        _, of_b = section(self.at_b(b0 + (1 - t if self.flipped else t) * (b1 - b0)), normal)
        # Both are followed away from the edge, so in opposite directions: the rate changes its sign.
        of_a[1:2] *= -1
        return of_a, of_b

    def relative_jumps(self):
        """Largest jumps at a few places in each span of both edges, over the scales of G2, G3 and G4."""
        (a0, a1), (b0, b1) = self.a.range_along, self.b.range_along
        of_b = (self.b.breakpoints_along() - b0) / (b1 - b0)
        breaks = np.concatenate([(self.a.breakpoints_along() - a0) / (a1 - a0), 1 - of_b if self.flipped else of_b])
        # At a knot of either side its derivatives along the edge have two values.
        breaks = np.unique(np.round(breaks, 12))
        places = (breaks[:-1, None] + np.diff(breaks)[:, None] * FRACTIONS).ravel()
        found = np.array([self.rates(a0 + t * (a1 - a0)) for t in places])
        largest = np.abs(found).max(axis=(0, 1))
        points = [_plain(side).control_points.reshape(-1, 3) for side in (self.a, self.b)]
        size = np.ptp(np.concatenate(points), axis=0).max()
        powers = 1 + np.arange(len(largest))
        scale = np.maximum(np.maximum(largest, largest[0] ** powers), 1e-3 / size**powers)
        return np.abs(found[:, 0] - found[:, 1]).max(axis=0) / scale
