"""The referee of an edge on a face: against known answers, and by Open CASCADE's surfaces in test_bands.py."""

import numpy as np
import pytest

from helpers.free_curves import cylinder, line, sphere
from semispline import Base, BSplineCurve, BSplineSurface, EdgeError, plane, revolve, split_v
from semispline.solver.judge import cad_measures, measure_face_contact


def cap(radius=10.0):
    """The part of a sphere above 30 degrees, its edge u0 a parallel of it, by its own parameters."""
    _, upper = split_v(sphere(radius), 0.66)
    return upper


def test_a_part_of_a_face_lies_on_it():
    for same_side in (True, False):
        found = measure_face_contact(Base(cap(), "v0"), sphere(), order=4, same_side=same_side)
        # Rounding of coordinates of size 10: second derivatives by parameters are some 1e3, fourth ones 1e6.
        assert found.gap < 1e-13
        assert found.angle_degrees < 1e-11
        assert found.curvature_jump_relative < 1e-11
        assert found.rate_jump_relative < 1e-8
        assert found.second_rate_jump_relative < 1e-6


def test_a_gap_an_angle_and_a_jump_are_what_they_are():
    low = revolve(line([10, 0, 0], [10, 0, 5]), [0, 0, 0], [0, 0, 1])
    wider = revolve(line([10.001, 0, 0], [10.001, 0, 5]), [0, 0, 0], [0, 0, 1])
    assert measure_face_contact(Base(wider, "v0"), low).gap == pytest.approx(1e-3, rel=1e-9)
    leaning = revolve(line([10, 0, 2], [10 + np.sin(0.1), 0, 2 + np.cos(0.1)]), [0, 0, 0], [0, 0, 1])
    found = measure_face_contact(Base(leaning, "v0"), low)
    assert found.angle_degrees == pytest.approx(np.degrees(0.1), rel=1e-9)
    # Tangent to the cylinder, but bent across by 1/5: over the floor, a cylinder being straight there.
    bell = revolve(BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[10, 0, 2], [10, 0, 3], [11, 0, 4]]), [0, 0, 0], [0, 0, 1])
    curvature = 1 / 2 / 1  # of a parabola (t^2, 2 t): x'' / z'^2 = 2 / 4
    size = 20.0
    found = measure_face_contact(Base(bell, "v0"), low)
    assert found.curvature_jump_relative == pytest.approx(curvature / (1e-3 / size), rel=1e-9)
    assert found.angle_degrees < 1e-10


def test_rates_are_measured():
    floor = plane([-5, -5, 0], [10, 0, 0], [0, 10, 0])
    # z = 0.1 x^3 leaves the plane with curvature 0 and rate 0.6.
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    points = [[[0, y, 0], [1 / 3, y, 0], [2 / 3, y, 0], [1, y, 0.1]] for y in (-1.0, 1.0)]
    rising = BSplineSurface(1, 3, [0, 0, 1, 1], knots, points)
    found = measure_face_contact(Base(rising, "v0"), floor, order=3)
    assert found.curvature_jump_relative < 1e-12
    assert found.rate_jump_relative == pytest.approx(1.0)


def test_an_edge_along_a_crease_of_curvature_is_compared_with_the_side_that_is_meant():
    # Flat for x < 0, bent for x > 0, C1 at x = 0: a double knot.
    knots = [-1, -1, -1, -1, 0, 0, 1, 1, 1, 1]
    height = [0, 0, 0, 0, 1 / 3, 1]
    net = [[[x, y, z] for y in (-1.0, 1.0)] for x, z in zip((-1, -2 / 3, -1 / 3, 1 / 3, 2 / 3, 1), height, strict=True)]
    face = BSplineSurface(3, 1, knots, [0, 0, 1, 1], net)
    to_the_right = plane([0, -0.9, 0], [0.5, 0, 0], [0, 1.8, 0])
    # A plane that leaves to x > 0 goes on flat what is flat at x < 0.
    assert measure_face_contact(Base(to_the_right, "u0"), face).curvature_jump_relative < 1e-6
    assert measure_face_contact(Base(to_the_right, "u0"), face, same_side=True).curvature_jump_relative > 0.9


def test_feet_beside_a_pole_are_found():
    # A circle of radius 0.01 about the pole, far closer to it than to anything else.
    _, tip = split_v(sphere(), 1 - 0.01 / (10 * np.pi))
    found = measure_face_contact(Base(tip, "v0"), sphere())
    assert found.gap < 1e-12
    assert found.angle_degrees < 1e-6


def test_an_edge_far_from_the_face_is_refused():
    with pytest.raises(EdgeError, match=r"the edge is .* away from it at"):
        measure_face_contact(Base(cylinder(5.0), "v0"), sphere())


def test_limits_of_cad_checkers():
    assert cad_measures(10.0) == {
        "gap": 1e-4,
        "angle_degrees": 0.01,
        "curvature_jump_relative": 0.02,
        "rate_jump_relative": 0.1,
        "second_rate_jump_relative": 0.1,
    }
    # 0.001 mm is what binds from 100 mm on.
    assert cad_measures(99.0, 1.0)["gap"] == pytest.approx(0.99e-3, rel=1e-12)
    assert cad_measures(101.0, 1.0)["gap"] == 1e-3
    assert cad_measures(101.0, 1000.0)["gap"] == 1e-6
