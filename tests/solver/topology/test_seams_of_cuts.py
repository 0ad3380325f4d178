"""Contacts moved over the seam of a closed surface: what is found does not depend on where the seam lies.

The answers are those of the surfaces rolled out, or of angles.
"""

from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from scipy.interpolate import make_interp_spline
from scipy.optimize import brentq

from helpers.parts import written
from helpers.solids import cut
from helpers.sweeps import first_ones
from semispline import BSplineCurve, EdgeError, list_edges, plane, revolve
from semispline.solver.splines import EdgeName
from semispline.solver.topology import moved_edges
from semispline.solver.topology.cuts import Cut, moved_contact
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.outlines import border
from semispline.solver.topology.trim_curves import TrimCurve

ROUND, ALONG = EdgeName("v", 0), EdgeName("u", 0)


def turned(profile, degrees, weights=None):
    """A surface of revolution about the z-axis whose seam lies at an angle."""
    t = np.radians(degrees)
    points = np.array([[x * np.cos(t), x * np.sin(t), z] for x, z in profile])
    degree = len(points) - 1
    knots = [0.0] * (degree + 1) + [1.0] * (degree + 1)
    return revolve(BSplineCurve(degree, knots, points, weights), (0, 0, 0), (0, 0, 1))


def tube(seam, radius=5.0, low=-40.0, high=40.0):
    return turned([(radius, low), (radius, high)], seam)


def cone(seam, half_angle, low=1.0, high=80.0):
    """Points at slant distances `low` to `high` from the apex."""
    sin, cos = np.sin(half_angle), np.cos(half_angle)
    return turned([(low * sin, low * cos), (high * sin, high * cos)], seam)


def parameter_of(surface, angle, seam):
    """Along u, of an angle in radians about the z-axis."""
    first, last = surface.domain[0]
    rest = (angle - np.radians(seam)) % (2 * np.pi)

    def off(u):
        x, y, _ = surface.evaluate(np.array([u]), np.array([surface.domain[1][0]]))[0]
        away = (np.arctan2(y, x) - np.radians(seam)) % (2 * np.pi)
        return away - rest

    return brentq(off, first + 1e-9, last - 1e-9, xtol=1e-14)


def hole(surface, seam, angles, along):
    """A closed curve in the parameters through points (angle, v), the face outside; it keeps its turn at the seam."""
    first, last = surface.domain[0]
    u = np.array([parameter_of(surface, x, seam) for x in angles[:-1]])
    u = np.unwrap(np.append(u, u[0]), period=last - first)
    t = np.linspace(0, 1, len(u))
    values = np.column_stack([u, along, np.zeros(len(u))])
    values[-1] = values[0]
    pcurve = BSplineCurve(3, *clamped(make_interp_spline(t, values, 3, bc_type="periodic")))
    return TrimCurve("edge e1 of face 0", surface, None, pcurve, "right", 0.0, None)


def clamped(spline):
    """Knots and points of the same cubic, clamped."""
    inner = spline.t[(spline.t > 1e-12) & (spline.t < 1 - 1e-12)]
    knots = np.concatenate([[0.0] * 4, inner, [1.0] * 4])
    places = np.array([knots[i + 1 : i + 4].mean() for i in range(len(knots) - 4)])
    again = make_interp_spline(places, spline(places), t=knots, k=3)
    return knots, again.c


def largest(surface, trim, distance=1000.0):
    """What is said to be the largest distance of a hole's edge, in words and as a number."""
    outline = border(surface, ROUND)
    rims = [np.array([[u, v] for u in surface.domain[0]]) for v in surface.domain[1]]
    outline = replace(outline, trim=trim, others=rims, own=[])
    with pytest.raises(EdgeError) as said:
        moved_contact(surface, None, Cut(distance=distance), outline, 1e-9, "cut", "e1")
    words = str(said.value)
    return words, float(words.rpartition(" ")[2])


@pytest.mark.slow
@pytest.mark.parametrize("seam", [180.0, 71.0, 20.0, 3.0])
def test_round_a_tube_a_contact_meets_itself(seam):
    """A round hole of radius 1 in the rolled-out tube, and in its next turn."""
    surface, t = tube(seam), np.linspace(0, 2 * np.pi, 65)
    trim = hole(surface, seam, np.cos(t) / 5.0, (40 + np.sin(t)) / 80.0)
    words, found = largest(surface, trim)
    assert "round the face to itself" in words
    # Said with four digits; the hole is a cubic through 64 points.
    assert found == pytest.approx(5 * np.pi - 1, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("seam", [180.0, 40.0, 5.0])
def test_round_a_cone_a_contact_meets_itself(seam):
    """Rolled out the cone is a sector: the hole and its next turn are two circles in it."""
    half_angle, far, radius = np.radians(20.0), 20.0, 1.0
    sector = 2 * np.pi * np.sin(half_angle)
    t = np.linspace(0, 2 * np.pi, 65)
    x, y = far + radius * np.cos(t), radius * np.sin(t)
    angles, slant = np.arctan2(y, x) / np.sin(half_angle), np.hypot(x, y)
    surface = cone(seam, half_angle)
    trim = hole(surface, seam, angles, (slant - 1.0) / 79.0)
    words, found = largest(surface, replace(trim, keep="right" if _is_anticlockwise(trim) else "left"))
    assert "round the face to itself" in words
    assert found == pytest.approx(far * np.sin(sector / 2) - radius, abs=0.02)


def _is_anticlockwise(trim):
    points = trim.pcurve.evaluate(np.linspace(0, 1, 200))
    return np.sum(points[:-1, 0] * np.diff(points[:, 1]) - points[:-1, 1] * np.diff(points[:, 0])) > 0


@pytest.mark.slow
@pytest.mark.parametrize("seam", [180.0, 30.0, 10.0])
def test_an_edge_beyond_the_seam_ends_the_face(seam):
    """A second hole lies 90 degrees on, of radius 2: between both there may be a seam."""
    surface, t = tube(seam), np.linspace(0, 2 * np.pi, 65)
    trim = hole(surface, seam, np.cos(t) / 5.0, (40 + np.sin(t)) / 80.0)
    other = hole(surface, seam, np.pi / 2 + 2 * np.cos(t) / 5.0, (40 + 2 * np.sin(t)) / 80.0)
    line = other.pcurve.evaluate(np.linspace(0, 1, 400))[:, :2]
    outline = replace(border(surface, ROUND), trim=trim, others=[line], own=[])
    with pytest.raises(EdgeError, match=r"beyond the face, expected a distance below 4\.") as said:
        moved_contact(surface, None, Cut(distance=9.0), outline, 1e-9, "cut", "e1")
    # Said with four digits; the holes are cubics through 64 points.
    assert float(str(said.value).rpartition(" ")[2]) == pytest.approx(2.5 * np.pi - 3, abs=1e-3)
    assert moved_contact(surface, None, Cut(distance=4.8), outline, 1e-9, "cut", "e1").curve is not None


@pytest.mark.slow
@pytest.mark.parametrize("seam", [0.0, 100.0, 300.0])
@pytest.mark.parametrize("end", [0, 1])
def test_a_line_of_a_tube_is_moved_over_the_seam(seam, end):
    """Once round but for a tenth; the edge itself is met after a whole turn."""
    surface = tube(seam, low=0.0, high=3.0)
    start = np.radians(200.0)
    name = EdgeName("u", end, parameter_of(surface, start, seam))
    way = 1 if end == 0 else -1
    for share in (0.05, 0.45, 0.9):
        found = moved_contact(surface, name, Cut(distance=10 * np.pi * share), border(surface, name), 1e-9, "c", "e0")
        at = surface.domain[0][found.name.end] if found.name.at is None else found.name.at
        x, y, _ = surface.evaluate(np.array([at]), np.array([0.5]))[0]
        away = (np.arctan2(y, x) - start - way * 2 * np.pi * share) % (2 * np.pi)
        assert min(away, 2 * np.pi - away) <= 1e-9
        assert found.name.part is None
    with pytest.raises(EdgeError, match=r"round the face to itself, expected a distance below 31\.4[12]$"):
        moved_contact(surface, name, Cut(distance=32.0), border(surface, name), 1e-9, "c", "e0")


@pytest.mark.parametrize("seam", [0.0, 100.0])
def test_a_line_that_ends_on_the_seam_is_the_natural_edge(seam):
    surface = tube(seam, low=0.0, high=3.0)
    name = EdgeName("u", 0, parameter_of(surface, np.radians(seam + 270.0), seam))
    found = moved_contact(surface, name, Cut(distance=2.5 * np.pi), border(surface, name), 1e-9, "c", "e0")
    assert str(found.name) == "u0"


def test_by_a_parameter_over_the_seam():
    surface = tube(0.0, low=0.0, high=3.0)
    (first, last), edge = surface.domain[0], EdgeName("u", 0, 0.8 * surface.domain[0][1])
    outline = border(surface, edge)
    for at in (0.9 * last, 0.1 * last, first + 1.1 * (last - first)):
        found = moved_contact(surface, edge, Cut(direction="u", parameter=at), outline, 1e-9, "c", "e0")
        assert found.name.at == pytest.approx(at if at < last else at - (last - first), abs=1e-12)
    with pytest.raises(EdgeError, match="lies beyond the face"):
        moved_contact(surface, edge, Cut(direction="u", parameter=1.9 * last), outline, 1e-9, "c", "e0")


@pytest.mark.long
@pytest.mark.parametrize("turns", first_ones(1, [0.1, 0.6, 0.95]))
@pytest.mark.parametrize("at", [0.2, 0.9])
def test_round_the_tube_of_a_torus(turns, at):
    """Circles of latitude of a torus 20 / 6, wherever the seam of its tube lies."""
    around = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    corners = [(20 + 6 * x, 6 * y) for x, y in around]
    w = np.array([1, 0.5**0.5] * 4 + [1])
    circle = BSplineCurve(2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [[x, 0, z] for x, z in corners], w)
    surface = revolve(circle, (0, 0, 0), (0, 0, 1))
    last = surface.domain[1][1]
    name = EdgeName("v", 0, at * last)

    def tube_angle(v):
        x, y, z = surface.evaluate(np.array([0.3]), np.array([v]))[0]
        return np.arctan2(z, np.hypot(x, y) - 20)

    found = moved_contact(surface, name, Cut(distance=12 * np.pi * turns), border(surface, name), 1e-9, "c", "e0")
    away = (tube_angle(found.name.at) - tube_angle(at * last) - 2 * np.pi * turns) % (2 * np.pi)
    assert min(away, 2 * np.pi - away) <= 1e-9
    with pytest.raises(EdgeError, match=r"below 37\.7$"):
        moved_contact(surface, name, Cut(distance=38.0), border(surface, name), 1e-9, "c", "e0")


@pytest.mark.slow
def test_where_a_face_has_a_neck_its_edge_meets_itself():
    """Within a Cassinian oval, whose waist is 2 sqrt(b^2 - a^2) wide."""
    a, b = 1.0, 1.05
    floor = plane([-3, -3, 0], [6, 0, 0], [0, 6, 0])
    t = np.linspace(0, 2 * np.pi, 129)
    r = np.sqrt(a**2 * np.cos(2 * t) + np.sqrt(b**4 - a**4 * np.sin(2 * t) ** 2))
    scale = floor.domain[0][1] / 6
    values = np.column_stack([(3 + r * np.cos(t)) * scale, (3 + r * np.sin(t)) * scale, np.zeros(129)])
    values[-1] = values[0]
    pcurve = BSplineCurve(3, *clamped(make_interp_spline(np.linspace(0, 1, 129), values, 3, bc_type="periodic")))
    trim = TrimCurve("edge e0 of face 0", floor, None, pcurve, "left", 0.0, None)
    outline = replace(border(floor, ROUND), trim=trim, ends=[], others=[], own=[])
    neck = np.sqrt(b**2 - a**2)
    with pytest.raises(EdgeError, match="round the face to itself") as said:
        moved_contact(floor, None, Cut(distance=0.4), outline, 1e-9, "cut", "e0")
    assert float(str(said.value).rpartition(" ")[2]) == pytest.approx(neck, rel=1e-3)
    with pytest.raises(EdgeError, match="round the face to itself"):
        moved_contact(floor, None, Cut(distance=1.002 * neck), outline, 1e-9, "cut", "e0")
    assert moved_contact(floor, None, Cut(distance=0.99 * neck), outline, 1e-9, "cut", "e0").curve is not None


@pytest.mark.slow
def test_a_seam_with_a_crease_ends_the_face():
    """A drop-shaped tube goes on in itself, but not smoothly: a contact stays on its side."""
    ends = [[0, 0, 0], [4, 3, 0], [4, -3, 0], [0, 0, 0]]
    drop = BSplineCurve(3, [0, 0, 0, 0, 1, 1, 1, 1], ends)
    net = np.array(ends)[:, None] + np.array([[0, 0, 0], [0, 0, 5.0]])
    surface = replace(
        plane([0, 0, 0], [1, 0, 0], [0, 1, 0]), degree_u=3, degree_v=1, knots_u=drop.knots,
        knots_v=np.array([0, 0, 1, 1.0]), control_points=net,
    )  # fmt: skip
    assert Face(surface).closed.tolist() == [True, False]
    assert Face(surface).periods.tolist() == [0.0, 0.0]
    name = EdgeName("u", 0, at=0.6)
    with pytest.raises(EdgeError, match="beyond the face"):
        moved_contact(surface, name, Cut(distance=20.0), border(surface, name), 1e-9, "c", "e0")


@pytest.mark.slow
@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize("seam", [180.0, 25.0])
def test_a_hole_beside_the_seam_of_a_file(tmp_path, seam):
    """Drilled squarely, radius 1, into a tube of radius 5: rolled out it is 10 arcsin(1/5) broad."""
    t = np.radians(seam)
    axes = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(np.cos(t), np.sin(t), 0))
    drill = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 30), gp_Dir(1, 0, 0)), 1.0, 50.0).Shape()
    path = written(cut(BRepPrimAPI_MakeCylinder(axes, 5.0, 60.0).Shape(), drill), tmp_path / "drilled.brep")
    faces = [list_edges(path, k) for k in range(5)]
    tube_face, rim = next((f, e) for f in faces for e in f.edges if e.kind == "free" and len(f.edges) == 5)
    (other,) = (e for e in faces[rim.neighbour].edges if e.neighbour == tube_face.face)
    words = (f"{path}#{tube_face.face}", f"{path}#{rim.neighbour}"), (rim.name, other.name)
    with pytest.raises(EdgeError, match="round the face to itself") as said:
        moved_edges(*words, ("100", None))
    assert float(str(said.value).rpartition(" ")[2]) == pytest.approx(5 * np.pi - 5 * np.arcsin(0.2), abs=6e-3)
