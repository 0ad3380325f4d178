"""Faces whose edges run end to end, with known geometry; and what a blend has at its lines, by a judge of its own."""

from dataclasses import dataclass
from itertools import pairwise
from math import comb

import numpy as np
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from scipy.interpolate import BSpline
from scipy.optimize import brentq

from helpers.free_curves import frame
from helpers.occ import to_geom
from semispline import Base, BSplineSurface
from semispline.solver.splines.operations import restrict_v

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


def fillets(profile, radius=0.3, *, angle=60.0, base=0.0):
    """Quarter rounds along a profile, from the walls at z = `base` inwards: cylinders at lines, tori at arcs.

    Contact at u0, where they leave upright; u runs down the round, so that a blend goes on upwards.
    """
    across = arc((-radius, 0.0), radius, -angle, 0.0)[::-1]
    found = []
    for piece in profile:
        normals, weights = _normals(piece), piece[:, 2]
        points = piece[:, :2] / piece[:, 2:]
        net = [np.column_stack([points + x / w * normals, np.full(len(points), base + z / w)]) for x, z, w in across]
        bent = np.stack([w * weights for _, _, w in across])
        q = len(piece) - 1
        found.append(Base(BSplineSurface(2, q, ARC, LINE if q == 1 else ARC, np.stack(net), bent), "u0"))
    return found


def turned_round(base, factor):
    """The same face run through by a fractional linear map of v; Bezier along v."""
    surface = base.surface
    weights = np.ones(surface.control_points.shape[:2]) if surface.weights is None else surface.weights
    weights = weights * factor ** np.arange(weights.shape[1])
    return Base(with_net(surface, surface.control_points, weights), base.edge)


def run_back_face(base):
    """The same face run through the other way along v; Bezier along v."""
    surface = base.surface
    weights = None if surface.weights is None else surface.weights[:, ::-1]
    return Base(with_net(surface, surface.control_points[:, ::-1], weights), base.edge)


def bernstein(q, t):
    return np.stack([comb(q, k) * t**k * (1 - t) ** (q - k) for k in range(q + 1)], axis=1)


def run_through(base, function, degree=3):
    """The face run through by a polynomial map of its range along onto itself, both over [0, 1]: by interpolation.

    Span by span, each knot of the result as often as its degree.
    """
    surface, (low, high) = base.surface, base.range_along
    net = surface.control_points if surface.weights is None else surface.homogeneous
    spline = BSpline(surface.knots_v, net, surface.degree_v, axis=1)
    q, breaks = degree * surface.degree_v, (np.unique(surface.knots_v) - low) / (high - low)
    # Where the map has the knots: bisection, since it rises.
    own = [0.0, *(brentq(lambda t, x=x: function(t) - x, 0.0, 1.0, xtol=1e-15) for x in breaks[1:-1]), 1.0]
    t = (1 - np.cos(np.linspace(0, np.pi, q + 1))) / 2
    points = []
    for start, end in pairwise(own):
        values = spline(np.clip(low + (high - low) * function(start + (end - start) * t), low, high))
        found = np.linalg.solve(bernstein(q, t), values.transpose(1, 0, 2).reshape(q + 1, -1))
        found = found.reshape(q + 1, len(net), -1).transpose(1, 0, 2)
        points.append(found if not points else found[:, 1:])
    knots = low + (high - low) * np.concatenate([[0.0], np.repeat(own, q), [1.0]])
    net = np.concatenate(points, axis=1)
    weights = None if surface.weights is None else net[..., 3]
    net = net if weights is None else net[..., :3] / net[..., 3:]
    return Base(BSplineSurface(surface.degree_u, q, surface.knots_u, knots, net, weights), base.edge)


def strips(surface, cuts):
    """A surface cut along v into faces that keep its parameters."""
    ends = [surface.domain[1][0], *cuts, surface.domain[1][1]]
    return [restrict_v(surface, a, b) for a, b in pairwise(ends)]


def stretched(surface, across=1.0, along=1.0, weight=1.0):
    """The same face with other lengths of its parameters, and its weights times a factor."""
    weights = None if surface.weights is None else surface.weights * weight
    return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u * across, surface.knots_v * along + 3.0,
                          surface.control_points, weights)  # fmt: skip


def moved(bases, matrix=None, offset=(0.0, 0.0, 0.0)):
    """The faces turned and moved."""
    matrix = np.eye(3) if matrix is None else matrix
    return [Base(with_net(base.surface, base.surface.control_points @ np.asarray(matrix).T + offset), base.edge)
            for base in bases]  # fmt: skip


def with_net(surface, net, weights=None):
    weights = surface.weights if weights is None else weights
    return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, net, weights)


@dataclass(frozen=True)
class Lines:
    """What happens at the lines of constant v between a surface's spans, its seam included if it is closed.

    `crease` in degrees; `bend` is the jump of the normal curvature square to the line, over the largest on any line.
    """

    crease: float
    bend: float


def lines_inside(surface, count=41):
    """Measure the lines inside by polynomial pieces from SciPy, from both sides: no evaluation of ours takes part."""
    plain = surface.to_bspline()
    breaks = np.unique(plain.knots_v)
    u = np.linspace(*plain.domain[0], count)
    pieces = [piece_along(plain, k) for k in range(len(breaks) - 1)]
    pairs = [(k - 1, k, breaks[k], breaks[k]) for k in range(1, len(pieces))]
    if np.abs(pieces[0](u, breaks[0], 0, 0) - pieces[-1](u, breaks[-1], 0, 0)).max() < 1e-9 * np.ptp(
        plain.control_points
    ):
        pairs.append((len(pieces) - 1, 0, breaks[-1], breaks[0]))
    creases, bends, sizes = [0.0], [0.0], [1e-300]
    for i, j, before, after in pairs:
        (n, k), (m, kk) = normal_and_bend(pieces[i], u, before), normal_and_bend(pieces[j], u, after)
        creases.append(np.degrees(np.linalg.norm(np.cross(n, m), axis=1)).max())
        bends.append(np.abs(k - kk).max())
        sizes.append(max(np.abs(k).max(), np.abs(kk).max()))
    return Lines(float(max(creases)), float(max(bends) / max(sizes)))


def piece_along(surface, k):
    """The polynomial piece of span k along v, by derivatives in u and v."""
    q, knots = surface.degree_v, surface.knots_v
    at = int(np.searchsorted(knots, np.unique(knots)[k], side="right")) - 1
    net = surface.control_points
    if surface.weights is not None:
        net = np.concatenate([net * surface.weights[..., None], surface.weights[..., None]], axis=-1)
    across = BSpline(surface.knots_u, net, surface.degree_u)
    local = knots[at - q : at + q + 2]

    def at_place(u, v, i, j):
        def raw(i, j):
            if i > surface.degree_u:
                return np.zeros((len(u), net.shape[2]))
            rows = (across.derivative(i) if i else across)(u)[:, at - q : at + 1].transpose(1, 0, 2)
            if j > q:
                return np.zeros_like(rows[0])
            along = BSpline(local, rows, q, extrapolate=True)
            return (along.derivative(j) if j else along)(v)

        if surface.weights is None:
            return raw(i, j)
        # By the quotient rule, up to what is asked for here.
        whole = raw(i, j)
        value = whole[:, :3].copy()
        for a in range(i + 1):
            for b in range(j + 1):
                if a or b:
                    value -= comb(i, a) * comb(j, b) * raw(a, b)[:, 3:] * at_place(u, v, i - a, j - b)
        return value / raw(0, 0)[:, 3:]

    return at_place


def normal_and_bend(piece, u, v):
    d_u, d_v, d_uu, d_uv, d_vv = (piece(u, v, *ij) for ij in ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))
    normal = np.cross(d_u, d_v)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    # The direction square to the line: d_v + x d_u, of length y.
    x = -np.sum(d_u * d_v, axis=1) / np.sum(d_u * d_u, axis=1)
    y = np.sum((d_v + x[:, None] * d_u) ** 2, axis=1)
    forms = [np.sum(normal * d, axis=1) for d in (d_vv, d_uv, d_uu)]
    return normal, (forms[0] + 2 * x * forms[1] + x**2 * forms[2]) / y


def seen_on_faces(surface, edge, bases, count=9):
    """Open CASCADE's view of an edge u0 or u1 of a blend on the faces of a chain: gap, angle, curvature difference.

    Each of `count` places in every span lies on the face that is nearest by projection. The difference is that of the
    second fundamental forms in directions across and along, over the largest found, and at least .001 of 1 / size.
    """
    geometry = to_geom(surface.to_bspline())
    u0, u1, _, _ = geometry.Bounds()
    u = u0 if edge == "u0" else u1
    faces = [to_geom(base.surface) for base in bases]
    breaks = np.unique(surface.to_bspline().knots_v)
    places = (breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(count) + 0.5) / count).ravel()
    found = []
    for v in places.tolist():
        point, step = geometry.Value(u, v), geometry.DN(u, v, 0, 1)
        feet = [(foot, face) for face in faces for foot in [GeomAPI_ProjectPointOnSurf(point, face)] if foot.NbPoints()]
        foot, face = min(feet, key=lambda x: x[0].LowerDistance())
        (n_a, form_a), (n_b, form_b) = frame(geometry, u, v), frame(face, *foot.LowerDistanceParameters())
        if n_a @ n_b < 0:
            n_b, form_b = -n_b, -form_b
        along = np.array([step.X(), step.Y(), step.Z()])
        along /= np.linalg.norm(along)
        across = np.cross(n_a, along)
        pairs = (across, across), (across, along), (along, along)
        forms = [np.array([x @ form @ y for x, y in pairs]) for form in (form_a, form_b)]
        angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(n_a, n_b)), n_a @ n_b))
        found.append((foot.LowerDistance(), angle, np.abs(forms[0] - forms[1]).max(), np.abs(forms).max()))
    gap, angle, jump, largest = np.max(found, axis=0)
    size = np.ptp(surface.to_bspline().control_points.reshape(-1, 3), axis=0).max()
    return gap / size, angle, jump / max(largest, 1e-3 / size)
