"""Faces and free curves on them, for tests of bands, and Open CASCADE as their judge."""

from dataclasses import dataclass

import numpy as np
from OCP.Geom import (
    Geom_ConicalSurface,
    Geom_CylindricalSurface,
    Geom_Plane,
    Geom_SphericalSurface,
    Geom_ToroidalSurface,
)
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf
from OCP.GeomLProp import GeomLProp_SLProps
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt

from helpers.occ import to_geom
from semispline import BSplineCurve, BSplineSurface, interpolate_curve, plane, revolve

AXES = gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
R2 = 0.5**0.5


def line(*points):
    return BSplineCurve(1, [0, 0, *np.linspace(0, 1, len(points))[1:-1], 1, 1], points)


def cubic(*points):
    return BSplineCurve(3, [0, 0, 0, 0, 1, 1, 1, 1], points)


def cylinder(radius=10.0, low=-20.0, high=20.0):
    return revolve(line([radius, 0, low], [radius, 0, high]), [0, 0, 0], [0, 0, 1])


def cone():
    """Half the angle is 45 degrees, the tip at z = 5."""
    return revolve(line([0, 0, 5], [5, 0, 0]), [0, 0, 0], [0, 0, 1])


def sphere(r=10.0):
    points = [[0, 0, -r], [r, 0, -r], [r, 0, 0], [r, 0, r], [0, 0, r]]
    return revolve(BSplineCurve(2, [0, 0, 0, 0.5, 0.5, 1, 1, 1], points, [1, R2, 1, R2, 1]), [0, 0, 0], [0, 0, 1])


def torus(R=20.0, r=6.0):
    square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    points = [[R + r * x, 0, r * z] for x, z in square]
    knots = [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1]
    return revolve(BSplineCurve(2, knots, points, [1, R2] * 4 + [1]), [0, 0, 0], [0, 0, 1])


def round_curve(points):
    """A closed curve through points over a full turn, the last one the first again."""
    return interpolate_curve(points, 5, np.linspace(0, 1, len(points)))


def ellipse_on_cylinder(degrees=30.0, radius=10.0):
    t = np.linspace(0, 2 * np.pi, 401)
    x = radius * np.cos(t)
    return round_curve(np.stack([x, radius * np.sin(t), x * np.tan(np.radians(degrees))], axis=1))


def circle_on_sphere(r=10.0, radius=7.0):
    t = np.linspace(0, 2 * np.pi, 401)
    n = np.array([1.0, 0.5, 0.4]) / np.linalg.norm([1.0, 0.5, 0.4])
    a = np.cross(n, [0, 0, 1]) / np.linalg.norm(np.cross(n, [0, 0, 1]))
    points = radius * (np.cos(t)[:, None] * a + np.sin(t)[:, None] * np.cross(n, a))
    return round_curve(np.sqrt(r**2 - radius**2) * n + points)


def free_form(rng, degree=3, n=7, height=0.3):
    """A wavy face of about 10 x 10, bicubic or biquintic."""
    knots = np.concatenate([np.zeros(degree), np.linspace(0, 1, n - degree + 1), np.ones(degree)])
    g = np.linspace(0, 10, n)
    net = np.stack([*np.meshgrid(g, g, indexing="ij"), rng.uniform(-height, height, (n, n))], axis=-1)
    net[..., :2] += rng.uniform(-0.2, 0.2, (n, n, 2))
    return BSplineSurface(degree, degree, knots, knots, net)


def open_curve(rng):
    a = rng.uniform(0.15, 0.85, (4, 2))
    a[:, 0] = 0.08, 0.35, 0.65, 0.92
    return cubic(*a)


def loop(rng, points=201):
    t, phase = np.linspace(0, 2 * np.pi, points), rng.uniform(0, 2 * np.pi, 2)
    r = 0.25 * (1 + 0.15 * np.cos(3 * t + phase[0]) + 0.08 * np.cos(2 * t + phase[1]))
    return round_curve(0.5 + r[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1))


WAVE = cubic((0.2, 0.2), (0.4, 0.7), (0.6, 0.2), (0.85, 0.8))


def bent_face(jump):
    """A cylinder of curvature 1/10 about, whose curvature across x = 0 jumps by a fraction."""
    knots = np.array([-1, -1, -1, -1, 0, 0, 1, 1, 1, 1])
    x = np.array([-3, -2, -1, 1, 2, 3.0])
    # z = x^2 / 20 for x < 0 and (1 + jump) x^2 / 20 for x > 0, with x = 3 s: Bezier points of a parabola.
    left = np.array([9, 3, 0]) / 20
    right = (1 + jump) * np.array([0, 3, 9]) / 20
    z = np.concatenate([left, right])
    y = np.linspace(-3, 3, 4)
    net = np.stack(
        [np.repeat(x[:, None], 4, 1), np.repeat(y[None], 6, 0), np.repeat(z[:, None], 4, 1) + y**2 / 40], axis=-1
    )
    return BSplineSurface(3, 3, knots, [0, 0, 0, 0, 1, 1, 1, 1], net)


# By name: a face, Open CASCADE's own surface of that kind, and a curve on it, of its parameters or in space.
ELEMENTARY = {
    "plane": (plane([0, 0, 0], [10, 0, 0], [0, 10, 0]), Geom_Plane(AXES), loop(np.random.default_rng(0))),
    "cylinder": (cylinder(), Geom_CylindricalSurface(AXES, 10.0), ellipse_on_cylinder(30.0)),
    "cylinder, open": (cylinder(), Geom_CylindricalSurface(AXES, 10.0),
                       cubic((0.1, 0.3), (0.3, 0.5), (0.4, 0.3), (0.6, 0.7))),
    "cone": (cone(), Geom_ConicalSurface(gp_Ax3(gp_Pnt(0, 0, 5), gp_Dir(0, 0, -1)), np.pi / 4, 0.0),
             cubic((0.1, 0.5), (0.15, 0.6), (0.2, 0.8), (0.4, 0.7))),
    "sphere": (sphere(), Geom_SphericalSurface(AXES, 10.0), circle_on_sphere()),
    "torus": (torus(), Geom_ToroidalSurface(AXES, 20.0, 6.0), cubic((0.1, 0.1), (0.15, 0.3), (0.3, 0.2), (0.4, 0.8))),
}  # fmt: skip


def in_space(curve):
    """Whether a curve of the table above is one in space."""
    return bool(np.abs(curve.control_points[:, 2]).max() > 0)


@dataclass(frozen=True)
class Seen:
    """What Open CASCADE sees of an edge on a face; curvature as a band has it."""

    gap: float
    angle_degrees: float
    curvature: float


def frame(geometry, u, v):
    """Normal, and the second form as a symmetric 3 x 3 matrix."""
    props = GeomLProp_SLProps(geometry, float(u), float(v), 2, 1e-12)
    n = props.Normal()
    normal = np.array([n.X(), n.Y(), n.Z()])
    if props.IsUmbilic():
        return normal, props.MeanCurvature() * (np.eye(3) - np.outer(normal, normal))
    most, least = gp_Dir(), gp_Dir()
    props.CurvatureDirections(most, least)
    a, b = (np.array([d.X(), d.Y(), d.Z()]) for d in (most, least))
    return normal, props.MaxCurvature() * np.outer(a, a) + props.MinCurvature() * np.outer(b, b)


def seen_by_open_cascade(surface, face, count=97):
    """Open CASCADE's view of edge u0 of a surface on a face, its own or ours; no evaluation of ours takes part."""
    geometry = to_geom(surface)
    own = to_geom(face) if isinstance(face, BSplineSurface) else face
    _, _, v0, v1 = geometry.Bounds()
    found = []
    for v in np.linspace(v0, v1, count).tolist():
        point, step = geometry.Value(0.0, v), geometry.DN(0.0, v, 0, 1)
        foot = GeomAPI_ProjectPointOnSurf(point, own)
        u_face, v_face = foot.LowerDistanceParameters()
        (n_a, form_a), (n_b, form_b) = frame(geometry, 0.0, v), frame(own, u_face, v_face)
        if n_a @ n_b < 0:
            n_b, form_b = -n_b, -form_b
        along = np.array([step.X(), step.Y(), step.Z()])
        along -= (along @ n_a) * n_a
        along /= np.linalg.norm(along)
        across = np.cross(n_a, along)
        forms = [
            [x @ form @ y for x, y in ((across, across), (across, along), (along, along))] for form in (form_a, form_b)
        ]
        angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(n_a, n_b)), n_a @ n_b))
        found.append((foot.LowerDistance(), angle, *np.abs(np.subtract(*forms)), *np.abs(forms[1])))
    found = np.array(found)
    size = 40.0
    scale = max(found[:, 5].max(), 1e-3 / size), max(found[:, 5:].max(), 1e-3 / size)
    jumps = found[:, 2].max() / scale[0], found[:, 3:5].max() / scale[1]
    return Seen(found[:, 0].max(), found[:, 1].max(), max(jumps))
