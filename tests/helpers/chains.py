"""Faces whose edges run end to end, with known geometry; and what a blend has at its lines, by a judge of its own."""

from itertools import pairwise

import numpy as np

from semispline import Base, BSplineSurface

LINE = [0.0, 0.0, 1.0, 1.0]
ARC = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]


def line(start, end):
    """Homogeneous points (w x, w y, w) of a straight piece of a profile."""
    return np.array([[*start, 1.0], [*end, 1.0]])


def arc(centre, radius, start, end):
    """The same of an arc between angles in degrees, less than 180 apart."""
    a, b = np.radians([start, end])
    half, middle = (b - a) / 2, (a + b) / 2
    w = np.cos(half)
    c = np.array(centre)
    inner = c + radius / w * np.array([np.cos(middle), np.sin(middle)])
    ends = [c + radius * np.array([np.cos(x), np.sin(x)]) for x in (a, b)]
    return np.array([[*ends[0], 1.0], [*(w * inner), w], [*ends[1], 1.0]])


def oval(length=6.0, radius=2.0, turned=0.0):
    """A profile of 2 lines and 4 arcs of 90 degrees, anticlockwise."""
    half = length / 2
    return [
        line((-half, -radius), (half, -radius)),
        arc((half, 0), radius, -90, 0),
        arc((half, 0), radius, 0, 90),
        line((half, radius), (-half, radius)),
        arc((-half, 0), radius, 90, 180),
        arc((-half, 0), radius, 180, 270),
    ]


def rounded_square(half=(3.0, 2.0), radii=(0.5, 1.0, 0.7, 0.4)):
    """4 lines and 4 arcs of radii of their own."""
    x, y = half
    r = radii
    return [
        line((-x + r[3], -y), (x - r[0], -y)),
        arc((x - r[0], -y + r[0]), r[0], -90, 0),
        line((x, -y + r[0]), (x, y - r[1])),
        arc((x - r[1], y - r[1]), r[1], 0, 90),
        line((x - r[1], y), (-x + r[2], y)),
        arc((-x + r[2], y - r[2]), r[2], 90, 180),
        line((-x, y - r[2]), (-x, -y + r[3])),
        arc((-x + r[3], -y + r[3]), r[3], 180, 270),
    ]


def circle(radius, cuts, centre=(0.0, 0.0)):
    """Arcs of one circle between angles in degrees."""
    return [arc(centre, radius, a, b) for a, b in pairwise(cuts)]


def box(x=3.0, y=2.0):
    corners = [(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)]
    return [line(a, b) for a, b in pairwise(corners)]


def wall(piece, *, base=0.0, height=-2.0, draft=0.0, centre=None):
    """A face that leaves a piece of a profile at z = `base`, its contact at u0, v along the profile.

    With a draft it goes outwards by that much per height: each point along the normal of the profile.
    """
    points = piece[:, :2] / piece[:, 2:]
    far = points + draft * abs(height) * _normals(piece)
    net = np.stack([np.column_stack([points, np.full(len(points), base)]),
                    np.column_stack([far, np.full(len(points), base + height)])])  # fmt: skip
    weights = None if len(piece) == 2 else np.stack([piece[:, 2]] * 2)
    return BSplineSurface(1, len(piece) - 1, LINE, LINE if len(piece) == 2 else ARC, net, weights)


def flange(piece, *, base=0.0, width=-1.0):
    """A plane face along a piece of a profile: as `wall`, but sideways."""
    points = piece[:, :2] / piece[:, 2:]
    far = points + width * _normals(piece)
    net = np.stack([np.column_stack([x, np.full(len(x), base)]) for x in (points, far)])
    weights = None if len(piece) == 2 else np.stack([piece[:, 2]] * 2)
    return BSplineSurface(1, len(piece) - 1, LINE, LINE if len(piece) == 2 else ARC, net, weights)


def _normals(piece):
    """By how much each control point moves where a line or an arc is set off outwards by 1."""
    points = piece[:, :2] / piece[:, 2:]
    if len(piece) == 2:
        along = points[1] - points[0]
        return np.repeat([[along[1], -along[0]] / np.linalg.norm(along)], 2, axis=0)
    one, other = points[1] - points[0], points[2] - points[1]
    ends = [np.array([t[1], -t[0]]) / np.linalg.norm(t) for t in (one, other)]
    middle = (ends[0] + ends[1]) / (1 + ends[0] @ ends[1])
    return np.array([ends[0], middle, ends[1]])


def walls(profile, **named):
    return [Base(wall(piece, **named), "u0") for piece in profile]


def flanges(profile, **named):
    return [Base(flange(piece, **named), "u0") for piece in profile]


def moved(bases, matrix=None, offset=(0.0, 0.0, 0.0)):
    """The faces turned and moved."""
    matrix = np.eye(3) if matrix is None else matrix
    return [Base(with_net(base.surface, base.surface.control_points @ np.asarray(matrix).T + offset), base.edge)
            for base in bases]  # fmt: skip


def with_net(surface, net, weights=None):
    weights = surface.weights if weights is None else weights
    return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, net, weights)


def creases_inside(surface, count=41):
    """The largest turn of the normal, in degrees, across lines of constant v between the spans, and the seam if any.

    By cross products of first derivatives from both sides of each line: the referee's own evaluation is not used.
    """
    plain = surface.to_bspline()
    breaks = np.unique(plain.knots_v)
    u = np.linspace(*plain.domain[0], count)
    lines = [(x, x) for x in breaks[1:-1]]
    ends = plain.evaluate(u[[0, -1]], np.full(2, breaks[0])), plain.evaluate(u[[0, -1]], np.full(2, breaks[-1]))
    if np.abs(ends[0] - ends[1]).max() < 1e-9 * np.ptp(plain.control_points):
        lines.append((breaks[-1], breaks[0]))
    worst = 0.0
    for before, after in lines:
        one, other = normals(plain, u, before, -1), normals(plain, u, after, 1)
        worst = max(worst, float(np.degrees(np.linalg.norm(np.cross(one, other), axis=1).max())))
    return worst


def normals(surface, u, v, side):
    """Unit normals on a line of constant v, as the limit from one side: of the span's own Bezier piece."""
    breaks = np.unique(surface.knots_v)
    k = int(np.searchsorted(breaks, v, side="left")) - 1 if side < 0 else int(np.searchsorted(breaks, v, side="right")) - 1
    piece = span(surface, breaks[k], breaks[k + 1])
    at = np.full(len(u), v)
    normal = np.cross(piece.evaluate(u, at, 1, 0), piece.evaluate(u, at, 0, 1))
    return normal / np.linalg.norm(normal, axis=1)[:, None]


def span(surface, low, high):
    from semispline.solver.splines import trim_surface

    return trim_surface(surface, v=(low, high))
