"""Circles and surfaces of revolution in exact rational form: arcs as CAD kernels have them, and one that is smooth."""

from itertools import pairwise

import numpy as np

from semispline import BSplineSurface

# (w x, w y, w) of the full circle of degree 6 that is C2, at its seam too: the square of a uniform complex spline.
SMOOTH_CIRCLE = np.array(
    [
        [1, 0, 1],
        [1, 1 / 2, 1],
        [13 / 20, 1, 19 / 20],
        [0, 49 / 40, 9 / 10],
        [-13 / 20, 1, 19 / 20],
        [-27 / 20, 0, 21 / 20],
        [-13 / 20, -1, 19 / 20],
        [0, -49 / 40, 9 / 10],
        [13 / 20, -1, 19 / 20],
        [1, -1 / 2, 1],
        [1, 0, 1],
    ]
)
SMOOTH_KNOTS = np.repeat([0, 0.5, 1], [7, 4, 7])


def arcs(angles, knots=None):
    """Degree, knots and (w x, w y, w) of a circle by arcs between angles; knots at equal steps unless given."""
    points = [(np.cos(angles[0]), np.sin(angles[0]), 1.0)]
    for first, last in pairwise(angles):
        half = (last - first) / 2
        middle = (first + last) / 2
        points += [(np.cos(middle), np.sin(middle), np.cos(half)), (np.cos(last), np.sin(last), 1.0)]
    at = np.linspace(0, 1, len(angles)) if knots is None else np.asarray(knots, dtype=float)
    return 2, np.repeat(at, [3, *[2] * (len(angles) - 2), 3]), np.array(points)


def full_circle(n_arcs=4, start=0.0):
    """Degree, knots and (w x, w y, w) of a full circle by equal arcs: 9 points of 4 arcs, 7 of 3."""
    return arcs(start + np.linspace(0, 2 * np.pi, n_arcs + 1))


def smooth_circle():
    """Degree, knots and (w x, w y, w) of the smooth full circle of 11 points."""
    return 6, SMOOTH_KNOTS, SMOOTH_CIRCLE


def swept(circle, profile, knots_u=None, degree_u=None):
    """A surface round z: rows of a homogeneous profile (r, z, m), each times the homogeneous points of a circle."""
    degree_v, knots_v, points = circle
    degree_u = len(profile) - 1 if degree_u is None else degree_u
    knots_u = np.repeat([0.0, 1.0], degree_u + 1) if knots_u is None else knots_u
    net = [[(r * x, r * y, z * w, m * w) for x, y, w in points] for r, z, m in profile]
    net = np.array(net)
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, net[..., :3] / net[..., 3:], net[..., 3])


def cylinder(circle, radius=1.0, heights=(0.0, 1.0)):
    """A cylinder round z, u along the axis."""
    return swept(circle, [(radius, z, 1.0) for z in heights])


def cone(circle, radii=(1.0, 2.0), heights=(0.0, 1.0)):
    """A cone round z."""
    return swept(circle, [(r, z, 1.0) for r, z in zip(radii, heights, strict=True)])


def torus(circle, ring=3.0, tube=1.0, angles=(0.0, np.pi / 2)):
    """A part of a torus round z, u along the meridian between two angles, below 180 degrees apart."""
    _, _, arc = arcs(angles)
    return swept(circle, [(ring * w + tube * x, tube * y, w) for x, y, w in arc])


def sphere(circle, radius=1.0, angles=(-0.5, 1.0)):
    """A zone of a sphere round z between two latitudes."""
    return torus(circle, 0.0, radius, angles)
