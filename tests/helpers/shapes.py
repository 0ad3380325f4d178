"""Exact rational shapes with known geometry, for the judge: profiles of lines and arcs, extruded or turned."""

from itertools import pairwise

import numpy as np

from semispline import BSplineSurface


def arc(centre, radius, start, end):
    """Bezier pieces (w x, w y, w) of a circle from angle start to end, in degrees, none wider than 90."""
    count = max(1, int(np.ceil(abs(end - start) / 90 - 1e-9)))
    angles = np.radians(np.linspace(start, end, count + 1))
    pieces = []
    for a, b in pairwise(angles):
        half = (b - a) / 2
        middle = (a + b) / 2
        w = np.cos(half)
        ends = [(centre[0] + radius * np.cos(t), centre[1] + radius * np.sin(t), 1.0) for t in (a, b)]
        x, y = (c + radius / w * f(middle) for c, f in zip(centre, (np.cos, np.sin), strict=True))
        pieces.append(np.array([ends[0], (w * x, w * y, w), ends[1]]))
    return pieces


def line(start, end):
    return [np.array([(*(np.array(start) * (1 - t) + np.array(end) * t), 1.0) for t in (0, 0.5, 1)])]


def joined(pieces):
    """One quadratic over unit spans, inner knots double: knots and homogeneous points, shape (n, 3)."""
    points = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
    knots = np.concatenate([[0.0], np.repeat(np.arange(len(pieces) + 1.0), 2), [len(pieces)]])
    return knots, points


def extruded(pieces, width, *, along="u"):
    """A profile in the plane z = 0, pulled along z; `along` names the parameter that runs along it."""
    knots, points = joined(pieces)
    flat = np.column_stack([points[:, :2] / points[:, 2:], np.zeros(len(points))])
    net = np.stack([flat, flat + np.array([0, 0, width])], axis=1)
    weights = np.repeat(points[:, 2:], 2, axis=1)
    if along == "u":
        return BSplineSurface(2, 1, knots, [0, 0, 1, 1], net, weights)
    return BSplineSurface(1, 2, [0, 0, 1, 1], knots, net.transpose(1, 0, 2), weights.T)


def revolved(pieces, start=0.0, end=360.0):
    """A profile (r, z) turned about z; u runs along it and v around."""
    knots_u, profile = joined(pieces)
    knots_v, circle = joined(arc((0, 0), 1.0, start, end))
    weights = np.outer(profile[:, 2], circle[:, 2])
    radius, height = (profile[:, :2] / profile[:, 2:]).T
    x, y = (circle[:, :2] / circle[:, 2:]).T
    net = np.stack([np.outer(radius, x), np.outer(radius, y), np.repeat(height[:, None], len(x), axis=1)], axis=-1)
    return BSplineSurface(2, 2, knots_u, knots_v, net, weights)


def torus(big, small, *, tube=(0.0, 360.0), around=(0.0, 360.0)):
    """u runs around the tube, v around the axis."""
    return revolved(arc((big, 0), small, *tube), *around)


def sheets(seed, count, *, arch=0.6, rough=0.08, sideways=0.016):
    """Quintic arches over cubic lines of 1 to 4 spans, dented at random: blends as one would keep them."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        inner = np.sort(rng.uniform(0.1, 0.9, int(rng.integers(0, 4))))
        knots_v = np.concatenate([np.zeros(4), inner, np.ones(4)])
        y = np.array([knots_v[i + 1 : i + 4].mean() for i in range(len(knots_v) - 4)])
        x = np.arange(6) / 5
        net = np.stack([*np.meshgrid(x, y, indexing="ij"), np.repeat((arch * 4 * x * (1 - x))[:, None], len(y), 1)], -1)
        net += rng.uniform(-1, 1, net.shape) * [sideways, sideways, rough]
        made.append(BSplineSurface(5, 3, [0.0] * 6 + [1.0] * 6, knots_v, net))
    return made
