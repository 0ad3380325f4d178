"""Elementary surfaces as exact rational splines, by textbook formulas: nothing of the package but its classes."""

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from semispline import BSplineSurface, transform


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


def repaced(surface, knots):
    """The same surface run through unevenly: other knots in v."""
    return BSplineSurface(
        surface.degree_u, surface.degree_v, surface.knots_u, knots, surface.control_points, surface.weights
    )


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


def free_form(rng, *, rational):
    """A surface of random degrees, knots and weights, about 10 wide and 6 deep."""
    degree_v, degree_u = (int(x) for x in rng.integers(2, 5, 2))
    n_v, n_u = degree_v + 1 + int(rng.integers(0, 4)), degree_u + 1 + int(rng.integers(0, 2))
    net = np.zeros((n_u, n_v, 3))
    net[..., 0] = np.linspace(-5, 5, n_v)
    net[..., 2] = np.linspace(0, 6, n_u)[:, None]
    net += 0.6 * rng.normal(size=net.shape)
    knots_u, knots_v = (
        np.concatenate([[0] * (p + 1), np.sort(rng.uniform(0.1, 0.9, n - p - 1)), [1] * (p + 1)])
        for p, n in ((degree_u, n_u), (degree_v, n_v))
    )
    weights = np.exp(rng.uniform(-0.3, 0.3, (n_u, n_v))) if rational else None
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, net, weights)


KINDS = ("cylinder", "cone", "sphere", "torus", "rational free form", "polynomial free form")


def random_face(rng, kind, *, far_pole):
    """A face of the kind: parts and whole turns, of two to five arcs, unequal ones too; u1 looks upwards.

    `far_pole` is where a sphere may have its pole: -1 for u0, 1 for u1.
    """
    if kind.endswith("free form"):
        return free_form(rng, rational=kind.startswith("rational"))
    if rng.random() < 0.35:
        count = int(rng.integers(3, 6))
        inner = np.linspace(0, 1, count + 1)[1:-1] + rng.uniform(-0.06, 0.06, count - 1)
        cuts = 2 * np.pi * np.concatenate([[0], inner, [1]])
    else:
        turn = rng.uniform(0.8, 4.5)
        cuts = np.linspace(0, turn, int(np.ceil(turn / 2.2)) + int(rng.integers(0, 2)) + 1)
    cuts = tuple(cuts + rng.uniform(0, 6))
    radius, height = rng.uniform(3, 6), rng.uniform(2, 6)
    if kind == "cylinder":
        return cylinder(radius, 0, height, cuts)
    if kind == "cone":
        return cone(radius, rng.uniform(1, 8), 0, height, cuts)
    if kind == "sphere":
        start, width = rng.uniform(-1.2, 0.6), rng.uniform(0.5, 0.9)
        if rng.random() < 0.2:
            start = -np.pi / 2 if far_pole < 0 else np.pi / 2 - width
        return meridian(radius, (0, 0), (start, start + width), cuts)
    start = rng.uniform(0, 6)
    return meridian(rng.uniform(0.5, 2), (rng.uniform(4, 6), 0), (start, start + rng.uniform(0.5, 1.5)), cuts)


CONTINUITIES = ("C0", "C1", "C2", "G0", "G1", "G2", "G3", "G4")


def random_pair(seed):
    """Two faces, one above the other and tilted, and what is asked for at both."""
    rng = np.random.default_rng(seed)
    kinds = rng.choice(KINDS, 2)
    a, b = (random_face(rng, str(kind), far_pole=far) for kind, far in zip(kinds, (-1, 1), strict=True))
    tilt = Rotation.from_rotvec(0.25 * rng.normal(size=3)).as_matrix()
    b = transform(b, tilt, (rng.normal(), rng.normal(), rng.uniform(9, 20)))
    wanted = rng.choice(CONTINUITIES, 2, p=[0.05, 0.1, 0.1, 0.05, 0.2, 0.3, 0.1, 0.1])
    return a, b, (str(wanted[0]), str(wanted[1]))
