"""The limits of ends on faces: how flat a contact may meet one, which degrees are tried, how a move fades out."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from helpers.closed import cylinder, sphere
from semispline import BSplineSurface, EdgeError
from semispline.solver.blending import end_curves
from semispline.solver.blending.end_curves import EndOnFace, _fade, end_on_face, face_at
from semispline.solver.blending.end_faces import EndFace, steered
from semispline.solver.blending.reparametrisation import Reparametrisation, composed
from semispline.solver.splines import Basis, clamped

LINE = [0.0, 0.0, 1.0, 1.0]
# Roundings of numbers of size 1.
ROUNDED = 1e-12


def strip(degree_v=1):
    """A sheet in the plane z = 0 over 0..1 across and y from 0 to 2, of 7 control points across for two G2 contacts."""
    net = [[[x, y, 0.0] for y in np.linspace(0, 2, degree_v + 1)] for x in np.linspace(0, 1, 7)]
    return BSplineSurface(6, degree_v, [0.0] * 7 + [1.0] * 7, clamped([], degree_v, 0, 1), net)


def derivatives(rng, along):
    """Those of a surface by w and v to the third order, with a given first one along."""
    found = rng.normal(size=(4, 5, 3))
    found[0, 1] = along
    return found


def series():
    """lambda = 1, w = u, q not yet known, to the third order."""
    found = np.zeros((3, 4))
    found[0, 0] = found[1, 1] = 1.0
    return found


def curve_of(jets, by):
    """Derivatives by u of the line across, of order 0 to 3."""
    return composed(jets[:, :, None], Reparametrisation.of(by))[:, 0]


@pytest.mark.parametrize("speed", [1.0, 40.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_contact_meets_its_end_face_at_a_sine_of_a_twentieth_at_least(speed, way):
    plane = EndFace.plane(np.array([0.0, 3.0, 0.0]))
    for sine, refused in ((0.0499, True), (0.0501, False)):
        along = speed * np.array([np.sqrt(1 - sine**2), way * sine, 0])
        jets = derivatives(np.random.default_rng(3), along)
        if refused:
            with pytest.raises(EdgeError, match=r"meets it at 2\.9 degrees, expected 2\.9 at least"):
                steered(jets, series(), plane)
        else:
            curve = curve_of(jets, steered(jets, series(), plane))
            # It stays in the plane to the order that is asked for; q is twenty times, cubed, as large as the jets.
            assert np.abs(curve[1:, 1]).max() < 1e-9
            assert np.abs(curve_of(jets, series())[1:, 1]).max() > 0.1


@pytest.mark.parametrize(("size", "bend"), [(1.0, 0.0), (40.0, 0.0), (1.0, 500.0)])
@pytest.mark.parametrize(("times", "moved"), [(0.8, False), (1.25, True)])
def test_what_leaves_a_plane_by_less_than_a_part_in_1e12_stays(size, bend, times, moved):
    """Of the speed across, or of the derivative itself where that is larger."""
    jets = np.zeros((3, 4, 3))
    jets[0, 1, 1] = 1.0
    jets[1, 0, 0], jets[2, 0, 0] = size, bend
    order = 2 if bend else 1
    off = times * 1e-12 * max(size, bend)
    jets[order, 0, 1] = off
    found = steered(jets, series()[:, :3], EndFace.plane(np.array([0.0, 1.0, 0.0])))
    expected = np.zeros(3)
    expected[order] = -off if moved else 0.0
    np.testing.assert_allclose(found[2], expected, rtol=1e-9, atol=0)


def test_a_curve_steered_onto_a_curved_face_bends_with_it():
    """On a sphere of radius 2 about 0, at its pole: x . x = 4 gives x' . n = 0 and x'' . n = -x' . x' / 2."""
    sphere_there = EndFace(np.array([0.0, 0.0, 1.0]), np.diag([-0.5, -0.5, 0.0]))
    assert not sphere_there.is_flat
    assert EndFace.plane(np.array([0, 0, 2.0])).is_flat
    jets = derivatives(np.random.default_rng(5), np.array([0.3, 0.1, 1.0]))
    curve = curve_of(jets, steered(jets, series(), sphere_there))
    assert curve[1, 2] == pytest.approx(0, abs=ROUNDED)
    assert curve[2, 2] == pytest.approx(-curve[1] @ curve[1] / 2, abs=ROUNDED)


def test_a_face_near_a_point_has_the_curvature_of_a_sphere_or_a_cylinder():
    point = np.array([3.0, 1.0, 1.0]) / np.sqrt(11)
    found = face_at(sphere(2.0), 2 * point)
    assert abs(found.normal @ point) == pytest.approx(1, abs=1e-9)
    # Towards the centre by 1 / r in all tangent directions.
    flat = np.eye(3) - np.outer(point, point)
    assert found.bending * np.sign(found.normal @ point) == pytest.approx(-flat / 2, abs=1e-9)
    around = face_at(cylinder(2.0, 3.0), np.array([0.0, 2.0, 1.0]))
    assert around.bending * np.sign(around.normal[1]) == pytest.approx(np.diag([-0.5, 0, 0]), abs=1e-9)


@pytest.mark.parametrize(("degree", "inner"), [(3, []), (4, [0.3]), (5, [0.2, 0.2, 0.7])])
def test_a_move_fades_out_with_the_cube(degree, inner):
    """From 1 at the end that is moved: (1 - v)^3 from the one, v^3 from the other, whatever the domain."""
    along = Basis(degree, 2 + 3 * clamped(inner, degree, 0, 1))
    t = np.linspace(0, 1, 21)
    for end, expected in ((0, (1 - t) ** 3), (1, t**3)):
        found = BSpline(along.knots, _fade(along, end), degree)(2 + 3 * t)
        assert found == pytest.approx(expected, abs=ROUNDED)


def test_four_degrees_are_added_at_most_and_no_more_than_needed(monkeypatch):
    """Each halves the distance: what is sought is met exactly, and at a sixteenth it ends."""
    tried = []

    def halved(surface, end, face, orders, raised):
        tried.append(raised)
        return EndOnFace(surface, 0.5**raised, raised)

    monkeypatch.setattr(end_curves, "_moved_end", halved)
    for within, most in ((1.0, 0), (0.99, 1), (0.25, 2), (0.0625, 4)):
        tried.clear()
        assert end_on_face(strip(), 0, strip(), (2, 2), within).raised == most
        assert tried == list(range(most + 1))
    tried.clear()
    with pytest.raises(EdgeError, match=r"stays 0\.062 off its end face, expected at most 0\.06"):
        end_on_face(strip(), 0, strip(), (2, 2), 0.06)
    assert tried == [0, 1, 2, 3, 4]


def test_where_more_degrees_lead_away_the_nearest_is_named(monkeypatch):
    monkeypatch.setattr(
        end_curves,
        "_moved_end",
        lambda surface, _, __, ___, raised: EndOnFace(surface, 1.0 + (raised - 1) ** 2, raised),
    )
    with pytest.raises(EdgeError, match="stays 1 off"):
        end_on_face(strip(), 0, strip(), (2, 2), 0.5)


@pytest.mark.parametrize("degree_v", [1, 2, 3, 5])
@pytest.mark.parametrize("end", [0, 1])
def test_an_end_is_brought_onto_a_plane_whatever_the_degree_along(degree_v, end):
    """The middle of the end line lies 0.01 off a plane; what the contacts read of it stays, the other end as well."""
    sheet = strip(degree_v)
    points = sheet.control_points.copy()
    points[3, 0 if end == 0 else -1, 1] += 0.01
    bent = BSplineSurface(6, degree_v, sheet.knots_u, sheet.knots_v, points)
    y = 0.0 if end == 0 else 2.0
    wall = BSplineSurface(1, 1, LINE, LINE, [[[x, y, z] for z in (-1, 1)] for x in (-1, 2)])
    found = end_on_face(bent, end, wall, (2, 2), 1e-9)
    assert found.raised == 0
    u = np.linspace(0, 1, 21)
    for v, expected in ((end, y), (1 - end, 2.0 - y)):
        assert found.surface.evaluate(u, np.full(21, float(v)))[:, 1] == pytest.approx(np.full(21, expected), abs=1e-9)
    for row in (0, 1, 2, -3, -2, -1):
        x = found.surface.control_points[row]
        assert x[:, [0, 2]] == pytest.approx(np.tile([sheet.control_points[row, 0, 0], 0], (len(x), 1)), abs=ROUNDED)
        assert x[:, 1] == pytest.approx(np.linspace(0, 2, len(x)), abs=ROUNDED)


@pytest.mark.parametrize("end", [0, 1])
def test_many_rows_are_brought_onto_a_plane_as_well(end):
    """30 middle curves, each off by itself: distances are taken at more places than there are rows."""
    knots = np.array(clamped(np.linspace(0, 1, 32)[1:-1], 5, 0, 1))
    places = np.array([knots[i + 1 : i + 6].mean() for i in range(36)])
    points = np.array([[[x, y, 0.0] for y in (0.0, 1.0, 1.5, 2.0)] for x in places])
    points[3:-3, 0 if end == 0 else -1, 1] += 0.02 * np.random.default_rng(2).normal(size=30)
    sheet = BSplineSurface(5, 3, knots, clamped([], 3, 0, 1), points)
    y = 0.0 if end == 0 else 2.0
    wall = BSplineSurface(1, 1, LINE, LINE, [[[x, y, z] for z in (-1, 1)] for x in (-1, 2)])
    found = end_on_face(sheet, end, wall, (2, 2), 1e-9)
    assert found.raised == 0
    u = np.linspace(0, 1, 301)
    assert np.abs(found.surface.evaluate(u, np.full(301, float(end)))[:, 1] - y).max() < 1e-9
