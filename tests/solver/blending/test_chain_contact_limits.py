"""What lies at a joint, at a knot, or at an end of an edge where a blend meets a chain: limits from both sides."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from helpers.chains import LINE, box, circle, line, moved, walls
from helpers.rational import cylinder
from semispline import Base, BSplineSurface, blend, chain
from semispline.solver.blending.chain_coefficients import Joint
from semispline.solver.blending.chain_contact import (
    ChainContact,
    _at_a_knot,
    _notes,
    _part,
    _snapped,
    stretches_along,
    told_apart,
)
from semispline.solver.blending.chain_faces import split_places
from semispline.solver.blending.chain_runs import _corners, _stations
from semispline.solver.judge import Crease
from semispline.solver.splines import BSplineCurve, boundary_curve

BOTH_SIDES = [(0.8, True), (1.25, False)]
SMOOTH = Joint((0.0, 0.0, 0.0), "smooth", 0.0, 0.0, (0.0, 0.0), 0.0, (0.0, 0.0))
CREASED, BENT = replace(SMOOTH, kind="creased"), replace(SMOOTH, curvatures=(0.0, 1.0))


def roof():
    """20 wide along x, 0 to 4 along v and y, creased at v = 1 and 3."""
    points = [[[x, y, z] for y, z in ((0, 0), (1, 1), (3, 1), (4, 0))] for x in (0, 20)]
    return BSplineSurface(1, 1, LINE, [0, 0, 1, 3, 4, 4], points).to_semistructured()


@pytest.mark.parametrize(("times", "there"), BOTH_SIDES)
@pytest.mark.parametrize("x", [0.0, 20.0])
def test_a_crease_is_inherited_at_a_joint_within_a_millionth_of_the_size(times, there, x):
    joint = replace(CREASED, point=(x, 1.0, 1.0 + times * 1e-6 * 20))
    creases = [Crease("v", 1.0, 45.0), Crease("v", 3.0, 45.0), Crease("u", 0.5, 45.0)]
    own, inherited = told_apart(creases, roof(), [joint])
    assert inherited == creases[:1] * there
    assert own == creases[there:]


@pytest.mark.parametrize(("angle", "explained"), [(0.0, True), (0.8e-6, True), (1.25e-6, False), (1.0, False)])
def test_a_contact_that_bends_explains_a_jump_of_curvature_and_no_crease(angle, explained):
    at = (0.0, 1.0, 1.0)
    creases = [Crease("v", 1.0, angle, 1.0, 1.0)]
    assert told_apart(creases, roof(), [replace(BENT, point=at)]) == (([], creases) if explained else (creases, []))
    assert told_apart(creases, roof(), [replace(CREASED, point=at)]) == ([], creases)
    assert told_apart(creases, roof(), [replace(SMOOTH, point=at)]) == (creases, [])


@pytest.mark.parametrize(("apart", "said"), [(0.0, False), (0.8e-8, False), (1.25e-8, True)])
def test_faces_that_leave_apart_are_said(apart, said):
    notes = list(_notes(0, replace(SMOOTH, apart=apart), fades=False))
    assert any("leave the contact" in note for note in notes) is said
    assert len(notes) == said


def polyline(*points):
    knots = [0.0, *range(len(points)), len(points) - 1.0]
    return BSplineCurve(1, knots, [[x, y, 0.0] for x, y in points])


@pytest.mark.parametrize(("times", "short"), BOTH_SIDES)
def test_stretches_shorter_than_a_part_in_1e7_are_none(times, short):
    one = chain(walls([line((0, 0), (1, 0)), line((1, 0), (4, 0))]))
    curve = polyline((0, 0), (1, 0), (2, 0), (3, 0), (4, 0))
    beside = 1.0 + times * 1e-7 * 4
    found = list(stretches_along(one, curve, [1.0, beside]))
    assert [edge for edge, _, _ in found] == ([0, 1] if short else [0, 1, 1])
    spans = [span for _, span, _ in found]
    assert spans == ([(0, 1), (1, 4)] if short else [(0, 1), (1, beside), (beside, 4)])
    # At its end too, which stays where it is.
    found = list(stretches_along(one, curve, [1.0, 4 - times * 1e-7 * 4]))
    assert len(found) == (2 if short else 3)
    assert found[-1][1][1] == 4


@pytest.mark.parametrize(("times", "snaps"), BOTH_SIDES)
def test_parameters_snap_to_ends_and_knots(times, snaps):
    beside = times * 1e-7 * 4
    for x, place in ((2 + beside, 2.0), (6 - beside, 6.0)):
        assert _snapped(x, 2.0, 6.0) == (place if snaps else x)
    curve = polyline((0, 0), (1, 0), (2, 0), (3, 0), (4, 0))
    beside = times * 1e-6 * 4
    for x, place in ((1 + beside, 1.0), (3 - beside, 3.0), (beside, 0.0)):
        assert _at_a_knot(x, curve) == (place if snaps else x)


@pytest.mark.parametrize(
    ("degrees", "through", "part"),
    [
        ((0, 90), 45, (0, 1)),
        ((90, 180), 135, (1, 2)),
        ((270, 360), 315, (3, 4)),
        # Across the seam there is no part: it is cut there before.
        ((90, 360), 180, (1, 4)),
        ((0, 360), 180, (0, 4)),
    ],
)
def test_the_part_of_a_closed_edge_goes_through_a_point(degrees, through, part):
    base = Base(cylinder(3.0, 0, -2.0, tuple(np.radians([0, 90, 180, 270, 360]))), "u0")
    edge, (start, end) = boundary_curve(base.surface, base.side), base.range_along
    points = [3 * np.array([np.cos(t), np.sin(t), 0]) for t in np.radians([*degrees, through])]
    found = (np.array(_part(base, edge, np.array(points[:2]), points[2])) - start) / (end - start)
    # By feet of points: roundings.
    np.testing.assert_allclose(found * 4, part, atol=1e-7)


def with_joints(*joints):
    """A blend over `roof` of which the joints lie at v."""
    places = tuple(at for at, _ in joints)
    return ChainContact((), (), tuple(joint for _, joint in joints), places, False, "exact", 1, 4)


def cut(*joints, other=()):
    contacts = with_joints(*joints), with_joints(*other) if other else None
    return split_places(SimpleNamespace(surface=roof(), chain_a=contacts[0], chain_b=contacts[1]))


@pytest.mark.parametrize(("times", "same"), BOTH_SIDES)
def test_a_blend_is_cut_at_joints_as_places_are_told_apart(times, same):
    beside = times * 1e-6 * 4
    # A joint near a knot lies on it.
    assert cut((1 + beside, CREASED)) == ((1.0,) if same else (1 + beside,))
    assert cut((3 - beside, CREASED)) == ((3.0,) if same else (3 - beside,))
    # A smooth one is cut where rows are only continuous: at the knot alone.
    assert cut((1 + beside, SMOOTH)) == ((1.0,) if same else ())
    # Of two joints of both chains one is left; none at the ends.
    assert cut((2.0, CREASED), other=[(2 + beside, CREASED)]) == ((2.0,) if same else (2.0, 2 + beside))
    assert cut((beside, CREASED), (4 - beside, CREASED)) == (() if same else (beside, 4 - beside))


def test_a_blend_of_chains_is_named_by_their_edges():
    one = chain(walls([line((-4, 0), (0, 0)), line((0, 0), (4, 0))]), names=["1:e0", "2:e0"])
    far = moved(walls([line((-4, 0), (4, 0))], height=2.0), None, (0, -1.0, 4.0))
    plain = {"continuity": "G1", "alpha": "natural", "p2": "zero"}
    assert blend(one, far[0], **plain).edges == ("1:e0+2:e0", "u0")
    assert blend(far[0], one, **plain).edges == ("u0", "1:e0+2:e0")


@pytest.mark.parametrize(("degrees", "corner"), [(0.8, False), (1.25, True), (-0.8, False), (-1.25, True)])
def test_a_corner_turns_by_more_than_a_degree(degrees, corner):
    t = np.radians(degrees)
    one = chain(walls([line((-3, 0), (0, 0)), line((0, 0), (2 * np.cos(t), 2 * np.sin(t)))]))
    assert _corners(one) == [1] * corner


def test_stations_are_the_start_the_corners_and_the_end():
    (a, b, c, d, _) = [(x, y, 0.0) for x, y in ((-3, -2), (3, -2), (3, 2), (-3, 2), (-3, -2))]
    faces = walls(box())
    np.testing.assert_array_equal(_stations(chain(faces[:3])), [a, b, c, d])
    np.testing.assert_array_equal(_stations(chain(faces)), [a, b, c, d, a])
    # None where edges go on smoothly.
    arcs = _stations(chain(walls(circle(2.0, (0, 45, 90)))))
    np.testing.assert_allclose(arcs, [[2, 0, 0], [0, 2, 0]], atol=1e-15)
