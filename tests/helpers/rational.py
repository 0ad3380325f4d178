"""Elementary surfaces as exact rational splines, by textbook formulas: nothing of the package but its classes."""

from itertools import pairwise

import numpy as np

from semispline import BSplineSurface


def arc(cuts):
    """Degree 2 arcs of the unit circle between the angles `cuts`: knots over [0, 1], points (x, y), weights."""
    points, weights, knots = [(np.cos(cuts[0]), np.sin(cuts[0]))], [1.0], [0.0] * 3
    for k, (a, b) in enumerate(pairwise(cuts), 1):
        half, middle = (b - a) / 2, (a + b) / 2
        points += [(np.cos(middle) / np.cos(half), np.sin(middle) / np.cos(half)), (np.cos(b), np.sin(b))]
        weights += [np.cos(half), 1.0]
        knots += [k / (len(cuts) - 1)] * 2
    return np.array([*knots, 1.0]), np.array(points), np.array(weights)


def turned(profile, cuts):
    """Surface of revolution about z: `profile` is (degree, knots, points (r, z), weights); u along it, v around."""
    degree, knots_u, line, line_weights = profile
    knots_v, circle, weights = arc(cuts)
    net = [[(r * x, r * y, z) for x, y in circle] for r, z in line]
    return BSplineSurface(degree, 2, knots_u, knots_v, net, np.outer(line_weights, weights))


def _line(start, end):
    return 1, [0, 0, 1, 1], [start, end], [1.0, 1.0]


def cylinder(radius, z, height, cuts):
    return turned(_line((radius, z), (radius, z + height)), cuts)


def cone(radius, end_radius, z, height, cuts):
    return turned(_line((radius, z), (end_radius, z + height)), cuts)


def meridian(radius, centre, angles, cuts):
    """A piece of a torus (of a sphere, where the centre is on the axis): its meridian is an arc about (r, z)."""
    knots, points, weights = arc(angles)
    return turned((2, knots, radius * points + centre, weights), cuts)


QUARTER = (0.2, 0.2 + np.pi / 2)
HALF = (0.0, 1.3, np.pi)
FULL = tuple(np.linspace(0, 2 * np.pi, 5))
THIRDS = tuple(np.linspace(0, 2 * np.pi, 4))
