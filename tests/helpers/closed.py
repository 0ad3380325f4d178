"""Closed shapes with known sizes, written down by hand: shares only the classes with `solver`."""

import numpy as np

from semispline import BSplineCurve, BSplineSurface

HALF = np.sqrt(0.5)
FULL_KNOTS = [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1]
FULL = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0.0]])
FULL_WEIGHTS = np.array([1, HALF, 1, HALF, 1, HALF, 1, HALF, 1])
# Half a circle, from the lower pole to the upper one.
HALF_KNOTS = [0, 0, 0, 0.5, 0.5, 1, 1, 1]
HALF_CIRCLE = np.array([[0, -1], [1, -1], [1, 0], [1, 1], [0, 1.0]])
HALF_WEIGHTS = FULL_WEIGHTS[:5]


def circle(radius=1.0):
    """Nine points in the plane z = 0."""
    return BSplineCurve(2, FULL_KNOTS, radius * FULL, FULL_WEIGHTS)


def turned(degree, knots, profile, weights):
    """A profile of (distance from the axis, z), turned about the z-axis: u runs around, v along the profile."""
    net = np.empty((9, len(profile), 3))
    net[..., :2] = FULL[:, None] * profile[:, None, 0][None]
    net[..., 2] = profile[:, 1]
    return BSplineSurface(2, degree, FULL_KNOTS, knots, net, FULL_WEIGHTS[:, None] * weights)


def cylinder(radius, height):
    return turned(1, [0, 0, 1, 1], np.array([[radius, 0], [radius, height]]), np.ones(2))


def sphere(radius):
    return turned(2, HALF_KNOTS, radius * HALF_CIRCLE, HALF_WEIGHTS)


def torus(large, small):
    return turned(2, FULL_KNOTS, small * FULL + [large, 0], FULL_WEIGHTS)
