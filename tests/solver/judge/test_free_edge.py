"""Contacts measured along a free edge of a face: off it, folded back over it, and of two faces at their edge."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from helpers.free_curves import bent_face, cubic, cylinder, ellipse_on_cylinder, free_form, line
from semispline import Base, BSplineCurve, BSplineSurface, band_along, blend, extrude, plane
from semispline.solver.judge import (
    FreeEdge,
    exact_face_limits,
    face_shortfalls,
    measure_face_contact,
    model_size,
    required_face_measures,
)
from semispline.solver.judge.face_contact import FaceContact

FLOOR = plane([0, 0, 0], [10, 0, 0], [0, 10, 0])
# Along x = y; the floor is kept above it, where y > x.
DIAGONAL = FreeEdge(FLOOR, line([1, 1, 0], [9, 9, 0]), True, "left")


def ramp(step, rise=1.0, way=(1.0, -1.0)):
    """A sheet off the diagonal by `step` across, that runs on in a direction of the floor and rises."""
    across = np.array([1, -1, 0]) / np.sqrt(2)
    away = np.array([*way, 0.0]) / np.linalg.norm(way) + [0, 0, rise]
    return Base(plane(np.array([1, 1, 0]) + step * across, away, [8, 8, 0]), "u0")


@given(st.floats(-0.3, 0.3), st.floats(0, 5))
def test_off_and_angle_are_what_they_are(step, rise):
    found = measure_face_contact(ramp(step, rise), DIAGONAL)
    assert found.gap <= 1e-14
    # Rounding of coordinates of size 10.
    assert found.off == pytest.approx(abs(step), abs=1e-13)
    assert found.angle_degrees == pytest.approx(np.degrees(np.arctan(rise)), abs=1e-5)


@pytest.mark.long
@given(st.floats(0, 5))
def test_what_folds_back_over_the_kept_part_turns_by_more_than_a_right_angle(rise):
    back = measure_face_contact(ramp(0.0, rise, (-1.0, 1.0)), DIAGONAL)
    assert back.angle_degrees == pytest.approx(180 - np.degrees(np.arctan(rise)), abs=1e-5)
    # Of a band that is right.
    assert measure_face_contact(ramp(0.0, rise, (-1.0, 1.0)), DIAGONAL, same_side=True).angle_degrees <= 90
    other_side = FreeEdge(DIAGONAL.face, DIAGONAL.curve, True, "right")
    assert measure_face_contact(ramp(0.0, rise, (-1.0, 1.0)), other_side).angle_degrees <= 90


def test_a_curve_in_the_parameters_is_the_same_edge():
    flat = FreeEdge(FLOOR, line((0.1, 0.1), (0.9, 0.9)), False, "left")
    a, b = (measure_face_contact(ramp(0.2, 0.5), edge) for edge in (flat, DIAGONAL))
    assert (a.off, a.angle_degrees) == pytest.approx((b.off, b.angle_degrees), abs=1e-12)
    assert flat.length == pytest.approx(np.sqrt(128))
    up = FreeEdge(FLOOR, line([1, 1, 0.25], [9, 9, 0.25]), True, "left")
    # The edge in space may be off its face: what is square to the face does not count as off the edge.
    assert measure_face_contact(ramp(0.2), up).off == pytest.approx(0.2, abs=1e-12)


def test_beyond_the_end_of_an_edge_is_off_it():
    short = FreeEdge(FLOOR, line([1, 1, 0], [5, 5, 0]), True, "left")
    assert measure_face_contact(ramp(0.0), short).off == pytest.approx(np.sqrt(32))


@given(st.floats(0, 1), st.integers(1, 2000))
@example(0.0, 21)
def test_the_ends_of_a_closed_edge_are_no_ends(turn, count):
    edge = FreeEdge(cylinder(), ellipse_on_cylinder(), True, "left")
    x = np.mod(turn + np.linspace(-1e-3, 1e-3, count), 1.0)
    points = edge.curve.evaluate(x)
    # Newton ends within rounding of coordinates of size 10.
    assert np.linalg.norm(edge.nearest(points)[0] - points, axis=1).max() <= 1e-12


def test_a_curve_that_runs_on_over_the_seam_of_a_face():
    edge = FreeEdge(cylinder(), line((0.8, 0.5), (1.2, 0.6)), False, "left")
    points, slope = edge.at(np.array([0.25, 0.75]))
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx([10, 10])
    assert points[0, 1] < 0 < points[1, 1]
    assert (slope[:, 2] > 0).all()


@pytest.mark.parametrize("ends", [(0.8, 1.2), (0.2, -0.2)])
def test_over_the_seam_an_edge_goes_on_at_the_other_end(ends):
    face = cylinder()
    edge = FreeEdge(face, line((ends[0], 0.5), (ends[1], 0.5)), False, "left")
    x = np.linspace(0, 1, 9)[[1, 3, 5, 7]]
    u = np.mod(ends[0] + (ends[1] - ends[0]) * x, 1.0)
    # Rounding of coordinates of size 10.
    np.testing.assert_allclose(edge.at(x)[0], face.evaluate(u, np.full(4, 0.5)), atol=1e-12)


@pytest.mark.parametrize(("times", "height"), [(0.5, 0.0), (2.0, 1 - 2e-5)])
@pytest.mark.parametrize("upper", [False, True])
def test_a_curve_may_miss_the_border_of_its_face_by_a_hundred_thousandth(times, height, upper):
    """Beyond that it is taken for one that runs on over a seam: from the other side."""
    v = 3 + times * 1e-5 if upper else 2 - times * 1e-5
    face = BSplineSurface(1, 1, [0, 0, 1, 1], [2, 2, 3, 3], [[[x, 0, z] for z in (0, 1)] for x in (0, 1)])
    point, _ = FreeEdge(face, line((0.2, v), (0.8, v)), False, "left").at(np.array([0.5]))
    assert point[0] == pytest.approx([0.5, 0, 1 - height if upper else height], abs=1e-9)


def test_an_edge_is_as_long_as_two_thousand_chords_of_it():
    # Of a circle: the n-th part of it is longer than its chord by (pi / n)^2 / 6, and that is 4e-7.
    circle = FreeEdge(cylinder(), line((0.0, 0.5), (1.0, 0.5)), False, "left")
    assert circle.length == pytest.approx(20 * np.pi, rel=1e-6)


@pytest.mark.parametrize(("spans", "chords"), [(1, 2000), (3, 3 * 667), (1000, 8 * 1000)])
def test_of_many_spans_each_has_eight_chords(spans, chords):
    knots = np.concatenate([[0.0], np.arange(spans + 1.0), [spans]])
    points = [[x, 0.0, 0.0] for x in range(spans + 1)]
    edge = FreeEdge(FLOOR, BSplineCurve(1, knots, points), True, "left")
    nodes = edge._nodes()
    assert len(nodes) == chords + 1
    np.testing.assert_allclose(np.diff(nodes), spans / chords, rtol=1e-9)


@pytest.mark.parametrize(("gap", "closed"), [(0.5, True), (2.0, False)])
def test_ends_are_one_point_within_a_millionth_of_the_extent(gap, closed):
    # Round a square of size 10 from a corner, and back to beside it.
    ends = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [0, 1e-5 * gap, 0]]
    edge = FreeEdge(FLOOR, BSplineCurve(1, [0, 0, 1, 2, 3, 4, 4], ends), True, "left")
    # Beside the start, and a little nearer to the end: a step from there leads on to the start, if that is one point.
    beside = np.array([[3e-3, 6e-6 * gap, 0.0]])
    foot = edge.nearest(beside)[0][0]
    assert foot == pytest.approx([3e-3 if closed else 0.0, 0.0 if closed else 1e-5 * gap, 0.0], abs=1e-12)


def test_two_faces_at_the_edge_that_they_share():
    # Up along x = y, seen from the floor; both run away from the edge.
    wall = plane([1, 1, 0], [8, 8, 0], [0, 0, 3])
    at_wall = FreeEdge(wall, line([1, 1, 0], [9, 9, 0]), True, "left")
    found = measure_face_contact(DIAGONAL, at_wall)
    assert (found.gap, found.off) == pytest.approx((0, 0), abs=1e-12)
    assert found.angle_degrees == pytest.approx(90)
    face = free_form(np.random.default_rng(3))
    curve = line((0.2, 0.3), (0.8, 0.6))
    kept, rest = (FreeEdge(face, curve, False, side) for side in ("left", "right"))
    found = measure_face_contact(kept, rest, order=3)
    assert max(found.gap, found.off) <= 1e-12
    # One face on both sides, looked at 1e-9 of its size of 10 to either side of a knot line: it bends by 1 at the most.
    assert found.angle_degrees <= 1e-6
    assert found.curvature_jump_relative <= 1e-6
    # The same part twice folds back.
    assert measure_face_contact(kept, kept).angle_degrees == pytest.approx(180)


@pytest.mark.parametrize("start", [-1.0, 0.0])
def test_an_end_on_a_knot_line_across_the_edge_is_compared_with_the_side_of_the_edge(start):
    """A face whose curvature along x jumps at x = 0 by 7 %, and an edge that ends or begins there."""
    face = bent_face(0.07)
    edge = FreeEdge(face, line((start, 0.3), (start + 1.0, 0.6)), False, "left")
    (band,) = band_along(face, edge.curve)
    # A band is within 2 %; that of the other side would be 7 % off.
    assert measure_face_contact(band.base, edge, same_side=True).curvature_jump_relative <= 0.02
    assert measure_face_contact(band.base, face, same_side=True).curvature_jump_relative <= 0.02


def test_exact_limits_are_those_of_contacts_with_rounding_by_the_size_of_the_face():
    small = Base(extrude(cubic([0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 1]), [0, 8, 0]), "v0")
    limits = exact_face_limits(small, FLOOR, 3)
    assert set(limits) == {"gap", "angle_degrees", "curvature_jump_relative", "rate_jump_relative"}
    # 1e-11 of the size and 1e-9; little more, since the sheet is at the origin.
    assert 1e-11 * model_size(small.surface) <= limits["gap"] <= 2e-11 * model_size(small.surface)
    assert 1e-9 <= limits["angle_degrees"] <= 2e-9
    # Up to second order unless more is asked for.
    assert set(exact_face_limits(small, FLOOR)) == {"gap", "angle_degrees", "curvature_jump_relative"}
    wide = plane([-5e3, -5e3, 0], [1e4, 0, 0], [0, 1e4, 0])
    wider = exact_face_limits(small, wide, 3)
    assert wider["gap"] == limits["gap"]
    grown = (wider["curvature_jump_relative"] - 1e-9) / (limits["curvature_jump_relative"] - 1e-9)
    # The floor is of size 10, more than the sheet's.
    assert grown == pytest.approx(1e4 / 10, rel=1e-6)
    # Rates are over the square and the cube of the size.
    near, far = (exact_face_limits(small, plane([-5, -5, 0], [x, 0, 0], [0, 10, 0]), 4) for x in (10, 20))
    for name, limit, power in (("rate_jump_relative", 1e-8, 2), ("second_rate_jump_relative", 1e-7, 3)):
        assert far[name] - limit == pytest.approx(2**power * (near[name] - limit), rel=1e-6)
    # Where rounding is more than a checker allows that stands.
    far = Base(plane([1e9, 1e9, 0], [1e-3, -1e-3, 0], [8e-3, 8e-3, 0]), "u0")
    assert exact_face_limits(far, wide)["angle_degrees"] == 0.01


def test_a_blend_to_a_plane_is_exact_in_a_face_of_any_size():
    """A natural edge of the blend on planes from its own size to 1e4 times that: curvature counts over their sizes."""
    other = plane([3, 0, 4], [0, 0, 2], [0, 8, 0])
    result = blend(Base(plane([-2, 0, 0], [2, 0, 0], [0, 8, 0]), "u1"), Base(other, "u0"))
    own = Base(result.surface, "u0")
    for size in (16.0, 160.0, 1.6e5):
        face = plane([-size / 2, -size / 2, 0], [size, 0, 0], [0, size, 0])
        found = measure_face_contact(own, face)
        limits = exact_face_limits(own, face) | {"off": 0.0}
        misses = [name for name, _, _ in face_shortfalls(found, limits, "G2") if name != "off"]
        assert misses == []


@pytest.mark.parametrize(
    ("continuity", "names"),
    [
        ("G0", ("gap", "off")),
        ("C1", ("gap", "off", "angle_degrees")),
        ("G2", ("gap", "off", "angle_degrees", "curvature_jump_relative")),
        ("G3", ("gap", "off", "angle_degrees", "curvature_jump_relative", "rate_jump_relative")),
    ],
)
def test_each_measure_counts_from_both_sides_of_its_limit(continuity, names):
    assert required_face_measures(continuity) == names
    measures = [*names, *{"angle_degrees", "curvature_jump_relative", "rate_jump_relative"} - set(names)]
    allowed = dict.fromkeys(measures, 1.0)

    def missed(**values):
        contact = FaceContact(
            **{"gap": 1.0, "off": 1.0, "angle_degrees": 1.0, "curvature_jump_relative": 1.0, "rate_jump_relative": 1.0,
               "second_rate_jump_relative": None, "length": 1.0, "at": {}} | values
        )  # fmt: skip
        return [name for name, _, _ in face_shortfalls(contact, allowed, continuity)]

    assert missed() == []
    for name in measures:
        assert missed(**{name: 1.0 + 1e-12}) == ([name] if name in names else [])
        assert missed(**{name: float("nan")}) == ([name] if name in names else [])


def test_a_wrong_call_is_refused():
    with pytest.raises(Exception, match="base: found a BSplineSurface, expected a Base or a FreeEdge"):
        measure_face_contact(FLOOR, DIAGONAL)
    with pytest.raises(Exception, match=r"face: the edge is .* away from it at"):
        measure_face_contact(Base(plane([0, 0, 9], [1, 0, 0], [0, 1, 0]), "u0"), DIAGONAL)
