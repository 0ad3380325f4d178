"""Circular arcs in standard rational form, apart from the code that recognises them; nets from Open CASCADE."""

from itertools import pairwise

import numpy as np


def standard_arcs(cuts, weights=None):
    """Degree 2 arcs between the angles `cuts`, one span each: knots at 0, 1, .., points (x, y, w).

    `weights` are factors of each joint's weight, which reparametrise the arcs.
    """
    points, knots = [(np.cos(cuts[0]), np.sin(cuts[0]), 1.0)], [0.0] * 3
    for k, (a, b) in enumerate(pairwise(cuts), 1):
        half, middle = (b - a) / 2, (a + b) / 2
        w = np.cos(half)
        points += [(np.cos(middle), np.sin(middle), w), (np.cos(b), np.sin(b), 1.0)]
        knots += [float(k)] * 2
    points = np.array(points)
    if weights is not None:
        # A factor that is quadratic over each span, given by control points whose middle is the geometric mean.
        points[::2] *= np.square(weights)[:, None]
        points[1::2] *= (np.array(weights)[:-1] * np.array(weights)[1:])[:, None]
    return np.array([*knots, knots[-1]]), points


def occ_net(surface, u_range, v_range):
    """Degrees, knots and homogeneous net (nu, nv, 4) of a Geom surface over ranges, by the kernel's own conversion."""
    from OCP.Geom import Geom_RectangularTrimmedSurface
    from OCP.GeomConvert import GeomConvert

    trimmed = Geom_RectangularTrimmedSurface(surface, *map(float, u_range), *map(float, v_range))
    spline = GeomConvert.SurfaceToBSplineSurface_s(trimmed)
    if spline.IsUPeriodic():
        spline.SetUNotPeriodic()
    if spline.IsVPeriodic():
        spline.SetVNotPeriodic()
    net = np.array(
        [
            [
                [*(spline.Weight(i, j) * np.array([p.X(), p.Y(), p.Z()])), spline.Weight(i, j)]
                for j in range(1, spline.NbVPoles() + 1)
                for p in [spline.Pole(i, j)]
            ]
            for i in range(1, spline.NbUPoles() + 1)
        ]
    )
    knots = []
    for degree, count, knot, times in (
        (spline.UDegree(), spline.NbUKnots(), spline.UKnot, spline.UMultiplicity),
        (spline.VDegree(), spline.NbVKnots(), spline.VKnot, spline.VMultiplicity),
    ):
        vector = np.repeat([knot(i) for i in range(1, count + 1)], [times(i) for i in range(1, count + 1)])
        # The kernel's first and last knot do not act where the ends of the domain have full multiplicity.
        vector[0], vector[-1] = vector[degree], vector[-degree - 1]
        knots.append((degree, vector))
    return knots[0], knots[1], net
