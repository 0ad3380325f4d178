"""Curves at a true distance inside of an edge: against plane geometry, and on surfaces that unroll."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.sweeps import examples
from semispline import BSplineCurve, elevate_degree, plane, revolve, transform
from semispline.solver.splines import EdgeName
from semispline.solver.topology.cuts import Cut, moved_contact
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.outlines import border
from semispline.solver.topology.parallels import crossings, focal_distance, paths_from

# Steps of the integration are good to some 1e-9 of the distance; ten times that is allowed.
WITHIN = 1e-8


def tube(radius=2.0, height=10.0):
    """A cylinder about the z-axis, u round it and v along it, from one line."""
    line = BSplineCurve(1, [0, 0, 1, 1], [[radius, 0, 0], [radius, 0, height]])
    return revolve(line, (0, 0, 0), (0, 0, 1))


def ball(radius=3.0):
    """The northern zone of a sphere from 0 to 60 degrees, exactly: a rational arc turned about the z-axis."""
    t = np.radians(60.0)
    points = radius * np.array([[1, 0, 0], [1, 0, np.tan(t / 2)], [np.cos(t), 0, np.sin(t)]])
    arc = BSplineCurve(2, [0, 0, 0, 1, 1, 1], points, weights=[1, np.cos(t / 2), 1])
    return revolve(arc, (0, 0, 0), (0, 0, 1))


def contact_points(surface, name):
    """Points of a line of constant parameter."""
    axis = "uv".index(name.direction)
    low, high = name.part or surface.domain[1 - axis]
    along = np.linspace(low, high, 7)
    at = np.full(7, name.at)
    return surface.evaluate(*((at, along) if axis == 0 else (along, at)))


def moved(surface, edge, distance):
    name = EdgeName(*edge)
    return moved_contact(surface, name, Cut(distance=distance), border(surface, name), 1e-9, "--cut-a", "e0")


@pytest.mark.parametrize(("edge", "axis", "coordinate"), [(("u", 0), 0, 1.5), (("v", 1), 1, 5.0 - 1.5)])
def test_a_distance_in_a_plane(edge, axis, coordinate):
    found = moved(plane([0, 0, 0], [4, 0, 0], [0, 5, 0]), edge, 1.5)
    assert found.curve is None
    points = contact_points(plane([0, 0, 0], [4, 0, 0], [0, 5, 0]), found.name)
    assert points[:, axis] == pytest.approx(coordinate, abs=1e-13)


@pytest.mark.long
@examples(25)
@given(st.floats(0.1, 9.0), st.floats(0.2, 6.0))
def test_a_distance_along_and_round_a_cylinder(distance, radius):
    surface = tube(radius)
    rim = moved(surface, ("v", 0), distance)
    assert contact_points(surface, rim.name)[:, 2] == pytest.approx(distance, abs=1e-12)
    quarter, last = Cut(distance=radius * min(distance / 9.0, 1.0)), surface.domain[0][1]
    name = EdgeName("u", 0, at=last / 7)
    line = moved_contact(surface, name, quarter, border(surface, name), 1e-9, "--cut-a", "e0").name
    first, there = (contact_points(surface, x) for x in (name, line))
    turned = np.arctan2(first[0, 0] * there[0, 1] - first[0, 1] * there[0, 0], first[0, :2] @ there[0, :2])
    # An arc of a cylinder is as long as its angle, in radians, times the radius.
    assert radius * turned == pytest.approx(quarter.distance, rel=1e-11)


@pytest.mark.long
def test_a_distance_on_a_sphere_is_an_arc():
    surface = ball(3.0)
    found = moved(surface, ("v", 0), 1.2)
    points = contact_points(surface, found.name)
    assert np.arcsin(points[:, 2] / 3.0) * 3.0 == pytest.approx(1.2, abs=1e-12)


def test_a_free_curve_in_a_plane_is_parallel():
    """A parabola and the points of its normals, known in closed form."""
    floor = Face(plane([0, 0, 0], [10, 0, 0], [0, 10, 0]))
    x = np.linspace(0, 1, 9)
    at, slope = np.stack([1 + 6 * x, 2 + 3 * x**2], axis=1), np.stack([np.full(9, 6.0), 6 * x], axis=1)
    scale = floor.surface.domain[0][1] / 10
    paths = paths_from(floor, at * scale, slope * scale, 1.0, 0.8)
    normal = np.stack([-slope[:, 1], slope[:, 0]], axis=1) / np.linalg.norm(slope, axis=1)[:, None]
    assert paths.point[-1][:, :2] == pytest.approx(at + 0.8 * normal, abs=1e-12)


@pytest.mark.long
@examples(25)
@given(st.floats(-1.2, 1.2), st.floats(0.2, 3.0), st.sampled_from([1.0, -1.0]))
def test_on_a_cylinder_paths_are_straight_lines_of_the_unrolled_sheet(slant, distance, sign):
    radius = 2.0
    surface = tube(radius)
    face = Face(surface)
    u = np.linspace(0.3, 0.6, 5) * surface.domain[0][1]
    v = np.full(5, 0.5) * surface.domain[1][1]
    # A direction in the sheet, taken to the parameters by the first derivatives there.
    jet = face.jet(np.stack([u, v], axis=1), 1)
    speeds = [np.linalg.norm(jet[key], axis=1) for key in ((1, 0), (0, 1))]
    slope = np.stack([np.cos(slant) / speeds[0], np.sin(slant) / speeds[1]], axis=1)
    paths = paths_from(face, np.stack([u, v], axis=1), slope, sign, distance)
    start, end = paths.point[0], paths.point[-1]
    round_it = sign * distance * -np.sin(slant) / radius
    turned = np.arctan2(start[:, 1], start[:, 0]) + round_it
    assert end[:, 0] == pytest.approx(radius * np.cos(turned), abs=1e-6)
    assert end[:, 1] == pytest.approx(radius * np.sin(turned), abs=1e-6)
    assert end[:, 2] - start[:, 2] == pytest.approx(np.full(5, sign * distance * np.cos(slant)), abs=1e-6)


@pytest.mark.long
def test_lengths_of_paths_are_true_on_a_wavy_surface():
    """Whatever the surface: each step is as long as it should be, and neighbours stay at one distance (Gauss)."""
    rng = np.random.default_rng(3)
    wavy = plane([0, 0, 0], [10, 0, 0], [0, 10, 0])
    from semispline import elevate_degree, insert_knots

    raised = insert_knots(elevate_degree(wavy, 2, 2), [0.3, 0.6], [0.4, 0.7])
    net = raised.control_points + rng.uniform(-0.3, 0.3, raised.control_points.shape) * [0, 0, 1]
    face = Face(type(raised)(raised.degree_u, raised.degree_v, raised.knots_u, raised.knots_v, net))
    x = np.linspace(0.2, 0.8, 7)
    at, slope = np.stack([x, 0.2 + 0.1 * x], axis=1), np.tile([1.0, 0.1], (7, 1))
    paths = paths_from(face, at, slope, 1.0, 4.0)
    steps = np.linalg.norm(np.diff(paths.point, axis=0), axis=2).sum(axis=0)
    assert steps == pytest.approx(np.full(7, 4.0), rel=1e-4)
    # The curve of all ends is square to the paths.
    beyond = paths_from(face, at + 1e-4 * slope, slope, 1.0, 4.0)
    along = beyond.point[-1] - paths.point[-1]
    assert np.abs(np.sum(along * paths.ahead[-1], axis=1)).max() <= 1e-3 * np.linalg.norm(along, axis=1).max()


def test_crossings_are_where_lines_are():
    floor = Face(plane([0, 0, 0], [1, 0, 0], [0, 1, 0]))
    at, slope = np.stack([np.linspace(0.1, 0.9, 5), np.zeros(5)], axis=1), np.tile([1.0, 0.0], (5, 1))
    paths = paths_from(floor, at, slope, 1.0, 0.8)
    found = crossings(paths, [np.array([[0.0, 0.5], [0.6, 0.5]]), np.array([[0.0, 0.0], [1.0, 1.0]])])
    assert found[0] == pytest.approx([0.5, 0.5, 0.5, np.inf, np.inf])
    assert found[1] == pytest.approx([0.1, 0.3, 0.5, 0.7, np.inf])


@examples(25)
@given(st.floats(0.5, 4.0))
def test_paths_into_a_circle_cross_in_its_middle(radius):
    floor = Face(plane([-5, -5, 0], [10, 0, 0], [0, 10, 0]))
    scale = floor.surface.domain[0][1] / 10
    t = np.linspace(0.1, 2.0, 9)
    at, slope = radius * np.stack([np.cos(t), np.sin(t)], axis=1), np.stack([-np.sin(t), np.cos(t)], axis=1)
    paths = paths_from(floor, (at + 5) * scale, slope, 1.0, 1.3 * radius)
    assert focal_distance(paths) == pytest.approx(radius, rel=1e-6)
    outwards = paths_from(floor, (at + 5) * scale, slope, -1.0, 0.5)
    assert focal_distance(outwards) == np.inf


@pytest.mark.long
def test_cuts_do_not_depend_on_where_the_surface_lies():
    surface = ball()
    turned = transform(surface, np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]) * 7, [100, -30, 5])
    one, other = moved(surface, ("v", 0), 1.2).name, moved(turned, ("v", 0), 8.4).name
    assert one.at == pytest.approx(other.at, rel=1e-12)


def test_on_a_plane_that_is_even_paths_are_those_of_one_that_is_not():
    even = plane([1, 2, 3], [4, 1, 0], [0.5, 3, 1])
    assert Face(even).is_affine
    # The same plane and parameters, as a surface that the paths are followed on.
    followed = elevate_degree(even, 2, 2)
    assert not Face(followed).is_affine
    at = np.array([[0.1, 0.0], [0.5, 0.0], [0.8, 0.0]])
    slope = np.tile([1.0, 0.0], (3, 1))
    one, other = (paths_from(Face(surface), at, slope, 1.0, 0.7) for surface in (even, followed))
    for name in ("at", "point", "ahead", "beside"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=0, atol=1e-13, err_msg=name)


@pytest.mark.parametrize(("away", "affine"), [(0.0, True), (2e-15, True), (1e-13, False), (1e-3, False)])
def test_what_counts_as_a_parallelogram(away, affine):
    even = plane([0, 0, 0], [1, 0, 0], [0, 1, 0])
    net = even.control_points.copy()
    net[1, 1] += [away, away, 0]
    assert Face(replace(even, control_points=net)).is_affine == affine
    weighted = replace(even, weights=np.array([[1.0, 2.0], [1.0, 1.0]]))
    assert not Face(weighted).is_affine
