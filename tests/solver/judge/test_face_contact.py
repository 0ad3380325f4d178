"""The referee of an edge on a face: against known answers, and by Open CASCADE's surfaces in test_bands.py."""

import numpy as np
import pytest

from helpers.free_curves import cylinder, line, sphere
from semispline import Base, BSplineCurve, BSplineSurface, EdgeError, plane, revolve, split_v
from semispline.solver.judge import FreeEdge, cad_measures, face_contact, measure_face_contact


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


K1, K2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
FLOOR = plane([-5, -5, 0], [10, 0, 0], [0, 10, 0])


def test_each_span_is_looked_at_in_thirty_places_and_at_its_ends():
    places = face_contact._places(np.array([0.0, 1.0, 3.0]))
    assert len(places) == 62
    assert places[[0, 1, 30, 31, -1]] == pytest.approx([0, 1 / 60, 59 / 60, 1 + 1 / 30, 3], rel=1e-12)


def test_a_foot_is_sought_on_the_sheet_that_is_near():
    # (10 (t - 0.45)^2, (t - 0.45) / 5): two sheets, 0.04 apart where t is 0.35 on the first one.
    rows = [(2.025, -0.09), (-2.475, 0.01), (3.025, 0.11)]
    face = BSplineSurface(2, 1, K2, K1, [[[*row, z] for z in (-1, 2)] for row in rows])
    assert face.evaluate(0.35, 0.5)[0] == pytest.approx([0.1, -0.02, 0.5], abs=1e-12)
    edge = plane([0.1, -0.02, 0], [0, 0, 1], [0, -1, 0])
    assert measure_face_contact(Base(edge, "v0"), face).gap < 1e-12


@pytest.mark.parametrize(("height", "is_on_it"), [(0.09, True), (0.11, False)])
def test_an_edge_may_be_a_twentieth_of_its_length_away(height, is_on_it):
    wall = plane([0, 0, height], [2, 0, 0], [0, 0, 1])
    if is_on_it:
        found = measure_face_contact(Base(wall, "v0"), FLOOR)
        assert found.gap == pytest.approx(height, rel=1e-12)
        # Up to second order unless more is asked for.
        assert found.rate_jump_relative is None
    else:
        with pytest.raises(EdgeError, match=r"the edge is .* away from it at"):
            measure_face_contact(Base(wall, "v0"), FLOOR)


@pytest.mark.parametrize("along", [1.0, -1.0])
@pytest.mark.parametrize("degrees", [5.0, 60.0])
def test_normals_of_both_senses_make_one_angle(along, degrees):
    lean = np.radians(degrees)
    leaning = plane([-along, 0, 0], [2 * along, 0, 0], [0, np.cos(lean), np.sin(lean)])
    assert measure_face_contact(Base(leaning, "v0"), FLOOR).angle_degrees == pytest.approx(degrees, rel=1e-9)


@pytest.mark.parametrize(("times", "closed"), [(0.5, True), (2.0, False)])
@pytest.mark.parametrize("direction", [0, 1])
def test_a_face_is_closed_up_to_a_billionth(direction, times, closed):
    net = np.array([[[x, y, 0.0] for y in (0, 3, 0)] for x in (0, 4, 0)], dtype=float)
    last = (slice(None), -1) if direction else (-1, slice(None))
    net[last][:, 2] += times * 4e-9
    face = BSplineSurface(2, 2, K2, K2, net)
    assert face_contact._closed(face)[direction] == closed
    assert face_contact._closed(face)[1 - direction]


@pytest.mark.parametrize(("at", "beside"), [(0.0, 1.0), (1.5, 2.5), (2.5, 2.5), (0.5, 1.5)])
def test_on_a_knot_line_the_face_is_read_a_billionth_beside_it(at, beside):
    # z = x^3 for x > 0, over a domain of 2: 6 x is its second derivative. As near as two billionths is on the line.
    knots = [-1, -1, -1, -1, 0, 1, 1, 1, 1]
    net = [[[x, y, z] for y in (-1.0, 1.0)] for x, z in zip((-1, -2 / 3, 0, 2 / 3, 1), (0, 0, 0, 0, 1), strict=True)]
    face = BSplineSurface(3, 1, knots, K1, net)
    jet = face_contact._face_jet(face, np.array([[2e-9 * at, 0.5]]), np.array([[1.0, 0, 0]]), 2)
    assert jet[2, 0][0, 2] == pytest.approx(6 * 2e-9 * beside, rel=1e-6)


def test_what_a_flat_face_is_measured_by():
    # z = 1e-6 x y, over a floor 10 wide: the mixed curvature is 1e-6, beside 1e-3 / 10.
    twisted = BSplineSurface(1, 1, K1, K1, [[[x, y, 1e-6 * x * y] for y in (-0.5, 0.5)] for x in (0, 1)])
    found = measure_face_contact(Base(twisted, "u0"), FLOOR)
    assert found.curvature_jump_relative == pytest.approx(1e-2, rel=1e-6)


@pytest.mark.parametrize(
    ("power", "measure", "expected"),
    [
        # z = 1e-9 x^3 and z = 1e-9 x^4: 6e-9 beside 1e-3 / 10^2, and 24e-9 beside 1e-3 / 10^3.
        (3, "rate_jump_relative", 6e-4),
        (4, "second_rate_jump_relative", 2.4e-2),
    ],
)
def test_what_rates_are_measured_by_on_a_flat_face(power, measure, expected):
    heights = [0.0] * power + [1e-9]
    net = [[[k / power, y, z] for y in (-0.5, 0.5)] for k, z in enumerate(heights)]
    rising = BSplineSurface(power, 1, [0] * (power + 1) + [1] * (power + 1), K1, net)
    found = measure_face_contact(Base(rising, "u0"), FLOOR, order=power)
    assert getattr(found, measure) == pytest.approx(expected, rel=1e-6)


def test_without_a_tangent_plane_there_is_no_normal_and_no_warning():
    jet = {(1, 0): np.array([[0.0, 0, 0], [1, 0, 0]]), (0, 1): np.array([[0.0, 1, 0], [0, 1e-3, 0]])}
    with np.errstate(all="raise"):
        normals = face_contact._normal(jet)
    assert np.isnan(normals[0]).all()
    assert normals[1].tolist() == [0, 0, 1]


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_which_way_an_edge_runs_is_seen_at_any_size(way, size):
    """A blend's sheet rises by 45 degrees from the edge of a floor, away from what is kept."""
    floor = plane([-size, -size, 0], [2 * size, 0, 0], [0, 2 * size, 0])
    edge = FreeEdge(floor, line([-size / 2, 0, 0], [size / 2, 0, 0]), True, "left")
    sheet = plane([-way * size / 2, 0, 0], [way * size, 0, 0], [0, -size, size])
    assert measure_face_contact(Base(sheet, "v0"), edge).angle_degrees == pytest.approx(45)
    folded = plane([-way * size / 2, 0, 0], [way * size, 0, 0], [0, size, size])
    assert measure_face_contact(Base(folded, "v0"), edge).angle_degrees == pytest.approx(135)


@pytest.mark.parametrize(("part", "is_closed"), [(0.5e-6, True), (2e-6, False)])
def test_ends_of_an_edge_are_one_point_within_a_millionth_of_its_length(part, is_closed):
    """A sleeve on a cylinder, from its seam all round but for a part: of a closed edge no side of the seam is read."""
    face = revolve(line([10, 0, 0], [10, 0, 5]), [0, 0, 0], [0, 0, 1])
    sleeve = revolve(line([10, 0, 1], [10, 0, 3]), [0, 0, 0], [0, 0, 1], 360 * (1 - part))
    found = measure_face_contact(Base(sleeve, "v0"), face)
    # Rounding of coordinates of size 10, or a billionth of the domain beside the seam.
    assert (found.angle_degrees < 1e-10) == is_closed
