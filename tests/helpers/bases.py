"""Random bases for blends: smooth patches with non-uniform knots, contact on any edge, in any direction."""

import numpy as np
from scipy.interpolate import make_interp_spline

from semispline import Base, BSplineSurface, clamped_surface
from semispline.solver.judge.de_boor import curve_points
from semispline.solver.splines.refinement import clamp_knots

IDENTITY = np.eye(3)


def random_knots(rng, degree, n_control, start=0.0, end=1.0):
    """Clamped, non-uniform, with a double inner knot now and then where the degree allows it."""
    n_inner = n_control - degree - 1
    # Gaps between 1 and 4: mismatched, but not so close that conditioning is what is tested.
    inner = np.cumsum(rng.uniform(1, 4, n_inner + 1))
    inner = inner[:-1] / inner[-1] if n_inner else inner[:0]
    if n_inner >= 2 and degree >= 3 and rng.random() < 0.3:
        inner[1] = inner[0]
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    return start + knots * (end - start)


def patch(rng, *, degrees, counts, height=0.3, ranges=((0, 1), (0, 1)), planar=False):
    """A patch over the unit square, u away from its edge u0; returned with contact at u0."""
    (p, q), (n_u, n_v) = degrees, counts
    knots_u, knots_v = (random_knots(rng, d, n, *r) for d, n, r in zip(degrees, counts, ranges, strict=True))

    def places(knots, degree, n):
        greville = np.array([knots[i + 1 : i + degree + 1].mean() for i in range(n)])
        return (greville - knots[0]) / (knots[-1] - knots[0])

    x, y = np.meshgrid(places(knots_u, p, n_u), places(knots_v, q, n_v), indexing="ij")
    z = np.zeros_like(x) if planar else height * rng.uniform(-1, 1, x.shape)
    shift = 0.0 if planar else 0.15 / max(n_u, n_v) * rng.uniform(-1, 1, (2, *x.shape))
    net = np.stack([x, y, z], axis=2)
    net[..., :2] += np.moveaxis(shift, 0, -1) if not planar else 0.0
    return BSplineSurface(p, q, knots_u, knots_v, net)


def turned(surface, edge, backwards):
    """The same geometry with what was the edge u0 now at `edge`, run backwards if asked."""
    net, (p, ku), (q, kv) = (
        surface.control_points,
        (surface.degree_u, surface.knots_u),
        (surface.degree_v, surface.knots_v),
    )
    if edge[1] == "1":
        net, ku = net[::-1], ku[0] + ku[-1] - ku[::-1]
    if backwards:
        net, kv = net[:, ::-1], kv[0] + kv[-1] - kv[::-1]
    if edge[0] == "v":
        net, (p, ku), (q, kv) = net.transpose(1, 0, 2), (q, kv), (p, ku)
    return BSplineSurface(p, q, ku, kv, net)


def moved(surface, matrix=IDENTITY, offset=(0, 0, 0), scale=1.0):
    net = scale * (surface.control_points @ np.asarray(matrix).T) + np.asarray(offset)
    return BSplineSurface(surface.degree_u, surface.degree_v, surface.knots_u, surface.knots_v, net)


def ring(n, radius, heights):
    """A closed base, smooth across its seam: a periodic net, clamped exactly."""
    angle = 2 * np.pi * np.arange(n + 3) / n
    net = np.array([[[radius * np.cos(t), radius * np.sin(t), z] for t in angle] for z in heights])
    u = np.repeat([0.0, 1.0], len(heights))
    return clamped_surface(len(heights) - 1, 3, u, np.arange(-3.0, n + 4), net)


# Turns a patch so that it looks back at the first one over the gap.
FACING = np.array([[-1.0, 0, 0], [0, 1, 0], [0, 0, 1]])


def facing_pair(rng, *, edges=None, backwards=None, planar=False):
    """Two random bases that face each other over a gap of about 1, contact on random edges and directions."""
    edges = edges or tuple(rng.choice(["u0", "u1", "v0", "v1"]) for _ in range(2))
    backwards = backwards if backwards is not None else tuple(rng.random(2) < 0.5)
    bases = []
    q = tuple(int(rng.integers(2, 6)) for _ in range(2))
    for k in range(2):
        p = int(rng.integers(2, 6))
        counts = (int(rng.integers(p + 1, p + 4)), int(rng.integers(q[k] + 1, q[k] + 6)))
        ranges = [(lo := float(rng.uniform(-2, 2)), lo + float(rng.uniform(0.5, 4))) for _ in range(2)]
        surface = patch(rng, degrees=(p, q[k]), counts=counts, ranges=ranges, planar=planar)
        if k == 1:
            surface = moved(surface, FACING, (-1.0, 0.1, 0.0 if planar else 0.4))
        bases.append(Base(turned(surface, edges[k], bool(backwards[k])), str(edges[k])))
    # The first runs towards +x from its edge at x = 0, the second towards -x from x = -1.
    return bases


def circle(n_spans, degree=3, seam=0.0):
    """A closed C^(degree - 1) spline close to the unit circle, clamped, its seam at an angle."""
    t = np.linspace(0, 1, n_spans + 1)
    angle = 2 * np.pi * (t + seam)
    values = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    values[-1] = values[0]
    periodic = make_interp_spline(t, values, k=degree, bc_type="periodic")
    # Clamp by inserting both ends to full multiplicity.
    knots = np.concatenate([[0.0] * (degree + 1), t[1:-1], [1.0] * (degree + 1)])
    greville = np.array([knots[i + 1 : i + degree + 1].mean() for i in range(len(knots) - degree - 1)])
    unit = np.eye(len(greville))
    collocation = np.column_stack([curve_points(degree, knots, e[:, None], greville)[:, 0] for e in unit])
    return knots, np.linalg.solve(collocation, periodic(greville))


def cylinder(n_spans, radius, heights, *, seam=0.0, tilt=0.0, offset=(0.0, 0.0)):
    """Open along u (the axis), closed along v, with contact at u0."""
    knots_v, points = circle(n_spans, seam=seam)
    knots_u = np.array([0, 0, 0, 0, 1, 1, 1, 1.0])
    rows = []
    for i, z in enumerate(np.linspace(*heights, 4)):
        r = radius * (1 + tilt * i)
        rows.append(np.column_stack([r * points + np.array(offset), np.full(len(points), z)]))
    return BSplineSurface(3, 3, knots_u, knots_v, np.array(rows))


def tube(
    rng,
    n_spans,
    *,
    degree=3,
    radius=1.0,
    heights=(0.0, 1.0),
    phase=0.0,
    noise=0.0,
    backwards=False,
    v_range=(0.0, 1.0),
):
    """Closed along v, C^(degree - 1) everywhere, of n_spans equal spans; its control points dented at random."""
    low, high = v_range
    angle = phase + (-1 if backwards else 1) * 2 * np.pi * np.arange(n_spans) / n_spans
    dented = radius * (1 + noise * rng.standard_normal((5, n_spans)))
    z = np.repeat(np.linspace(*heights, 5)[:, None], n_spans, axis=1)
    ring = np.stack([dented * np.cos(angle), dented * np.sin(angle), z], axis=-1)
    ring = np.concatenate([ring, ring[:, :degree]], axis=1)
    knots = low + (high - low) * np.arange(-degree, n_spans + degree + 1) / n_spans
    knots_v, points = clamp_knots(degree, knots, ring.transpose(1, 0, 2).reshape(-1, 15))
    net = points.reshape(-1, 5, 3).transpose(1, 0, 2)
    return BSplineSurface(3, degree, [0, 0, 0, 0, 0.5, 1, 1, 1, 1], knots_v, net)
