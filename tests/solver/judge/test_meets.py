"""Where a surface meets itself or a base: traps of mesh searches, and places that are known."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.bases import cylinder, tube
from helpers.papers_set import blend
from helpers.shapes import arc, extruded, line, revolved, sheets, torus
from semispline import Base, BSplineSurface, measure_meets, transform
from semispline.solver.judge import confirmed_meetings
from semispline.solver.judge.box_tree import box_tree, overlapping
from semispline.solver.judge.confirmed_meetings import search_itself
from semispline.solver.judge.continuation import continuation
from semispline.solver.judge.mesh_search import Hits, crossings, grid_mesh, joined_along
from semispline.solver.judge.mesh_search import _triangles as triangles_of
from semispline.solver.judge.sections import closed_directions, spread


def searched(surface, *bases):
    found = measure_meets(surface, *bases)
    assert found.searched
    return found


NOTHING = np.zeros((2, 0, 2))


# What meets nothing


@pytest.mark.parametrize(
    "surface",
    [
        extruded(arc((0, 0), 1.0, 0, 300), 1.0),
        extruded(arc((0, 0), 1.0, 0, 300), 1.0, along="v"),
        extruded(arc((0, 0), 1.0, 0, 360), 1.0, along="v"),
        torus(3.0, 1.0),
        # A cap with a pole, and a triangular patch.
        revolved(arc((0, 0), 2.0, 0, 90)),
        revolved(arc((0, 0), 2.0, -90, 90), 0, 350),
    ],
    ids=["arc", "arc along v", "tube", "torus", "cap", "patch with two poles"],
)
def test_nothing_is_found_where_nothing_meets(surface):
    found = searched(surface)
    assert (found.found, found.unconfirmed, found.searched) == ((), 0, ("itself",))
    assert found.seen_from is None


@pytest.mark.long
def test_a_seam_that_is_off_by_rounding():
    pipe = cylinder(12, 1.0, (0.0, 3.0))
    for off in (1e-15, 1e-12):
        net = pipe.control_points.copy()
        net[:, -1] += off * np.array([1, -1, 1])
        moved = BSplineSurface(3, 3, pipe.knots_u, pipe.knots_v, net)
        assert (net[:, -1] != net[:, 0]).any()
        found = searched(moved)
        assert (found.found, found.unconfirmed) == ((), 0)


def test_a_seam_that_is_not_welded_is_full_of_hits():
    """The control: what the weld by index is for."""
    pipe = cylinder(12, 1.0, (0.0, 3.0))
    u, v = np.linspace(0, 1, 20), np.linspace(0, 1, 41)
    open_mesh, closed_mesh = (grid_mesh(pipe, u, v, (False, closed)) for closed in (False, True))
    assert len(crossings(open_mesh, open_mesh).first) > 20
    assert not len(crossings(closed_mesh, closed_mesh).first)


def test_a_pole_that_is_not_welded_is_full_of_hits():
    cap = revolved(arc((0, 0), 2.0, 0, 90))
    mesh = grid_mesh(cap, np.linspace(0, 1, 20), np.linspace(0, 4, 41), (False, True))
    assert mesh.poles == (False, True, False, False)
    assert not len(crossings(mesh, mesh).first)
    raw = np.arange(20 * 41).reshape(20, 41)
    raw[:, -1] = raw[:, 0]
    triangles, corners = triangles_of(raw, mesh.u, mesh.v)
    apart = replace(mesh, vertex=raw, triangles=triangles, corners=corners)
    assert len(crossings(apart, apart).first) > 20


# What meets itself, at a known place


class Eight:
    """A tube over the figure of eight x = sin t, y = sin t cos t, which crosses itself at t = 0 and pi."""

    domain = ((0.0, 1.0), (0.0, 1.0))
    breakpoints = (np.array([0.0, 1.0]), np.array([0.0, 1.0]))

    def evaluate(self, u, v, du=0, dv=0):
        u, v = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(v, dtype=float))
        # From t = pi / 2 on: the seam is not where it crosses.
        t, k = 2 * np.pi * v + np.pi / 2, 2 * np.pi
        zero = np.zeros_like(t)
        if du:
            return np.stack([zero, zero, zero + (du == 1 and dv == 0)], axis=-1)
        x, y = ((np.sin(t), np.sin(2 * t) / 2), (k * np.cos(t), k * np.cos(2 * t)))[dv]
        return np.stack([x, y, u if dv == 0 else zero], axis=-1)

    def evaluate_grid(self, u, v, du=0, dv=0):
        return self.evaluate(np.asarray(u)[:, None], np.asarray(v)[None], du, dv)


def eight_mesh(columns):
    return grid_mesh(Eight(), np.linspace(0, 1, 11), np.linspace(0, 1, columns), (False, True))


@pytest.mark.parametrize("columns", [80, 81, 82, 101, 102])
def test_a_tube_in_the_form_of_an_eight(columns):
    """With 81 and 101 columns samples of both sheets lie on the crossing, so vertices coincide."""
    places = search_itself(Eight(), eight_mesh(columns))
    assert places.unconfirmed == 0
    assert places.found
    for meeting in places.found:
        assert meeting.point[:2] == pytest.approx([0, 0], abs=1e-10)
        assert sorted([meeting.uv[1], meeting.other[1]]) == pytest.approx([0.25, 0.75], abs=1e-9)
        assert meeting.angle_degrees == pytest.approx(90)


class Cone(Eight):
    """The same drawn together to a point at u = 0."""

    def evaluate(self, u, v, du=0, dv=0):
        u, v = np.broadcast_arrays(np.asarray(u, dtype=float), np.asarray(v, dtype=float))
        shape = super().evaluate(np.ones_like(u), v, 0, dv)
        return shape * (u if du == 0 else np.full_like(u, du == 1))[..., None]


def test_triangles_with_one_common_corner():
    """All have the tip in common, and no others are there."""
    mesh = grid_mesh(Cone(), np.linspace(0, 1, 2), np.linspace(0, 1, 80), (False, True))
    assert mesh.poles[0]
    assert len(mesh.triangles) == 79
    hits = crossings(mesh, mesh)
    assert len(hits.first)
    assert np.sort(np.concatenate([hits.first[:, 1], hits.second[:, 1]])) == pytest.approx(
        np.repeat([0.25, 0.75], len(hits.first)), abs=0.02
    )


def test_welding_by_distance_hides_the_eight():
    """The control: with what lies at one point made one vertex there is nothing left to find."""
    mesh = eight_mesh(81)
    _, same = np.unique(mesh.points.round(9), axis=0, return_inverse=True)
    points = np.empty_like(mesh.points)
    points[same] = mesh.points
    welded = replace(mesh, vertex=same[mesh.vertex], triangles=same[mesh.triangles], points=points)
    assert len(crossings(mesh, mesh).first)
    assert not len(crossings(welded, welded).first)


def loop(radius):
    """A line to the right, three quarters of a turn, and down over the line: it crosses it square, at x = -radius."""
    return [
        *line((-2, 0), (0, 0)),
        *arc((0, radius), radius, -90, 180),
        *line((-radius, radius), (-radius, -2)),
    ]


@pytest.mark.parametrize("radius", [1.0, 0.2, 0.04])
@pytest.mark.parametrize("along", ["u", "v"])
def test_loops(radius, along):
    found = searched(extruded(loop(radius), 1.0, along=along))
    assert found.seen_from is None
    assert found.found
    for meeting in found.found:
        assert meeting.what == "itself"
        assert meeting.point[:2] == pytest.approx([-radius, 0], abs=1e-9)
        assert meeting.angle_degrees == pytest.approx(90)
    assert "meets itself at (" in found.sentences[0]


@pytest.mark.parametrize("size", [1.0, 0.3])
def test_a_loop_within_one_span(size):
    """A cubic whose inner points cross over, scaled across; the place by hand: by symmetry x = 1.5, B_x(t) = 1.5."""
    knots = [0] * 4 + [1] * 4
    cubic = np.array([[0, 0], [4, 3 * size], [-1, 3 * size], [3, 0]])
    net = [[[x, y, z] for z in (0, 1)] for x, y in cubic]
    found = searched(BSplineSurface(3, 1, knots, [0, 0, 1, 1], net))
    # x(t) - 1.5 over (t - 1/2), with x = 12 t (1-t)^2 - 3 t^2 (1-t) + 3 t^3: 18 t^2 - 18 t + 3 = 0.
    t = (18 - np.sqrt(18**2 - 4 * 18 * 3)) / 36
    for meeting in found.found:
        assert sorted([meeting.uv[0], meeting.other[0]]) == pytest.approx([t, 1 - t], abs=1e-9)
        assert meeting.uv[1] == pytest.approx(meeting.other[1], abs=1e-9)
    assert found.found


def test_units_and_offsets():
    surface = extruded(loop(0.2), 1.0)
    for scale, offset in ((1e-3, 0), (1e4, 1e6)):
        moved = transform(surface, scale * np.eye(3), [offset, 0, 0])
        found = searched(moved).found
        assert found
        assert all(m.point[0] - offset == pytest.approx(-0.2 * scale, rel=1e-5) for m in found)


@pytest.mark.long
def test_a_flat_ring_that_covers_itself():
    """Sheets in one plane have no edge that pierces the other; they meet all the same."""
    found = searched(revolved(line((1, 0), (2, 0)), 0, 450))
    assert found.found
    for meeting in found.found:
        assert meeting.angle_degrees == pytest.approx(0, abs=1e-6)
        (_, v), (_, t) = meeting.uv, meeting.other
        # 450 degrees are five pieces; the last one lies on the first.
        assert abs(v - t) == pytest.approx(4, abs=1e-6)
    # The same as a stair: above itself.
    net = revolved(line((1, 0), (2, 0)), 0, 450)
    height = np.linspace(0, 1, net.control_points.shape[1])[None, :, None] * [0, 0, 1]
    stair = BSplineSurface(2, 2, net.knots_u, net.knots_v, net.control_points + height, net.weights)
    assert (searched(stair).found, searched(stair).unconfirmed) == ((), 0)


def two_arcs(centre, radius):
    """A quarter of the unit circle, and by a way around an arc that crosses or passes it."""
    start = (centre[0] + radius * np.cos(np.radians(-80)), centre[1] + radius * np.sin(np.radians(-80)))
    way = [*line((0, 1), (-3, 1)), *line((-3, 1), (-3, -3)), *line((-3, -3), start)]
    return extruded([*arc((0, 0), 1.0, 0, 90), *way, *arc(centre, radius, -80, 80)], 1.0)


@pytest.mark.parametrize("apart", [1e-4, 1e-6, 1e-9])
def test_sheets_closer_than_the_mesh_can_tell_are_not_confirmed(apart):
    found = searched(two_arcs((0, 0), 1 - apart))
    assert found.found == ()
    assert found.unconfirmed > 0
    assert found.deflection > apart
    assert any("closer than the mesh can tell" in sentence for sentence in found.sentences)


# An arc, and with a narrow turn at its end back along it, so close that triangles cross.
THERE, BACK = arc((0, 0), 1.0, 0, 60), [*arc(0.999985 * np.array([0.5, np.sqrt(0.75)]), 1.5e-5, 60, 240)]
BACK += arc((0, 0), 0.99997, 60, 10)


def test_a_narrow_turn_is_no_meeting():
    """Steps that start at false hits end at one point of the turn."""
    found = searched(extruded([*THERE, *BACK], 1.0))
    assert found.found == ()
    assert found.unconfirmed > 0


def test_steps_that_end_on_the_contact_are_no_meeting(monkeypatch):
    """From hits beside it, as a mesh may have them where the surface leaves its base narrowly."""
    surface = extruded(arc((0, 1), 1.0, -90, 150), 1.0)
    beside = Hits(np.array([[1e-6, 0.5]]), np.array([[1e-6, 0.5]]))
    monkeypatch.setattr(confirmed_meetings, "crossings", lambda a, b: beside if a is not b else Hits(*NOTHING))
    found = searched(surface, FLAT)
    assert (found.found, found.unconfirmed) == ((), 1)
    # They do end there, and what is a hit elsewhere counts.
    through = extruded(OVER, 1.0)
    t = through.domain[0][1] - 0.75
    hit = Hits(np.array([[t, 0.5]]), np.array([[1.0, 0.5]]))
    monkeypatch.setattr(confirmed_meetings, "crossings", lambda a, b: hit if a is not b else Hits(*NOTHING))
    (meeting,) = searched(through, FLAT).found
    assert meeting.point == pytest.approx([-1, 0, 0.5], abs=1e-9)


@pytest.mark.parametrize("depth", [1e-2, 1e-4, 1e-6])
def test_sheets_that_cross_by_as_little_are(depth):
    """Circles whose centres are apart at right angles to the direction (1, 1): there they cross."""
    found = searched(two_arcs(depth / np.sqrt(2) * np.array([1, -1]), 1.0))
    assert found.found
    for meeting in found.found:
        assert meeting.point[0] - meeting.point[1] == pytest.approx(depth / np.sqrt(2), abs=1e-4)
        assert meeting.angle_degrees == pytest.approx(np.degrees(depth), rel=1e-2)


# Bases


def strip(profile, *, edge="u1"):
    """A base of a profile that ends at the origin, along x."""
    return Base(extruded(profile, 1.0), edge)


FLAT = strip(line((-2, 0), (0, 0)))
CURVED = strip(arc((0, -3), 3.0, 130, 90))
OVER = [*arc((0, 1), 1.0, -90, 180), *line((-1, 1), (-1, -3))]


@pytest.mark.parametrize("base", [FLAT, CURVED], ids=["flat", "curved"])
def test_the_contact_is_no_meeting(base):
    """It bends back over the base: not seen from one side, searched, and nothing there."""
    surface = extruded(arc((0, 1), 1.0, -90, 150), 1.0)
    found = searched(surface, base)
    assert "a" in found.searched
    assert (found.found, found.unconfirmed) == ((), 0)


@pytest.mark.parametrize("base", [FLAT, CURVED], ids=["flat", "curved"])
def test_a_blend_through_its_base(base):
    surface = extruded(OVER, 1.0)
    found = [m for m in searched(surface, base).found if m.what == "a"]
    assert found
    for meeting in found:
        y = 0 if base is FLAT else np.sqrt(9 - 1) - 3
        assert meeting.point[:2] == pytest.approx([-1, y], abs=1e-9)
        # Parameters are the base's own.
        assert base.surface.evaluate(*([x] for x in meeting.other))[0] == pytest.approx(meeting.point, abs=1e-9)
        assert surface.evaluate(*([x] for x in meeting.uv))[0] == pytest.approx(meeting.point, abs=1e-9)
    assert any("passes through base a" in str(meeting) for meeting in found)


def test_other_samples_on_the_contact_are_false_hits():
    """The control: what the shared samples are for."""
    round_contact = revolved(arc((5, 0), 3.0, 180, 240), 0, 180)
    own = revolved(arc((5, 0), 3.0, 120, 180), 0, 180)
    base = continuation(round_contact, Base(own, "u1"), 0)
    u, w, v = (
        spread(x, n) for x, n in ((round_contact.breakpoints[0], 20), (base.breakpoints[0], 20), (base.v_breaks, 30))
    )
    mesh = grid_mesh(round_contact, u, v, (False, False))
    same = grid_mesh(base, w, v, (False, False))
    assert not len(crossings(mesh, joined_along(same, same.vertex[0], mesh, mesh.vertex[0])).first)
    other = grid_mesh(base, w, spread(base.v_breaks, 46), (False, False))
    apart = joined_along(other, other.vertex[0][:0], mesh, mesh.vertex[0][:0])
    assert len(crossings(mesh, apart).first) > 10


@pytest.mark.long
def test_closed_rims_with_seams_anywhere():
    rng = np.random.default_rng(2)
    a = Base(tube(rng, 8, noise=0.02), "u1")
    b = Base(tube(rng, 9, radius=1.5, heights=(5.0, 4.0), phase=2.0, backwards=True, v_range=(2, 5), noise=0.02), "u1")
    surface = blend(a, b, degree_u=5, middle_curves=0, alpha="natural").surface
    found = searched(surface, a, b)
    assert found.searched == ("itself", "a", "b")
    assert (found.found, found.unconfirmed) == ((), 0)
    assert closed_directions(surface) == (False, True)


@pytest.mark.long
def test_a_tube_through_the_wall_of_a_closed_base():
    """Around a rim and away from it, bent over and in through the wall; parameters are the base's."""
    wall = revolved(line((1, -4), (1, 0)))
    # From the rim outwards, down outside, and inwards through the wall at z = -1.
    way = [*arc((2, 0), 1.0, 180, 0), *line((3, 0), (3, -1)), *line((3, -1), (0.5, -1))]
    surface = revolved(way)
    found = [m for m in searched(surface, Base(wall, "u1")).found if m.what == "a"]
    assert found
    for meeting in found:
        assert np.hypot(*meeting.point[:2]) == pytest.approx(1, abs=1e-9)
        assert meeting.point[2] == pytest.approx(-1, abs=1e-9)
        assert meeting.angle_degrees == pytest.approx(90)
        assert wall.evaluate(*([x] for x in meeting.other))[0] == pytest.approx(meeting.point, abs=1e-9)


@pytest.mark.long
def test_what_is_certified_is_not_searched():
    for surface in sheets(7, 4):
        found = measure_meets(surface)
        assert found.seen_from is not None
        assert (found.searched, found.found, found.deflection) == ((), (), None)
        # And the search agrees.
        u, v = (spread(breaks, n) for breaks, n in zip(surface.breakpoints, (80, 30), strict=True))
        places = search_itself(surface, grid_mesh(surface, u, v, (False, False)))
        assert (places.found, places.unconfirmed) == ((), 0)


def test_a_search_may_be_left_out():
    found = measure_meets(extruded(loop(0.2), 1.0), search=False)
    assert (found.searched, found.found, found.seen_from) == ((), (), None)
    assert found.answer("itself") is None
    assert found.sentences == ("not known whether it meets itself: no direction shows it, and no mesh was searched",)


def test_boxes_against_all_pairs():
    rng = np.random.default_rng(0)
    for n, m, d in ((1, 1, 3), (50, 50, 3), (37, 200, 2), (128, 3, 3)):
        (low, size), (other, its) = ((rng.uniform(0, 1, (k, d)), rng.uniform(0, 0.3, (k, d))) for k in (n, m))
        first, second = box_tree(low, low + size), box_tree(other, other + its)

        def brute(a, b, c, e):
            return {
                (i, j)
                for i in range(len(a))
                for j in range(len(c))
                if (a[i] <= c[j] + e[j]).all() and (c[j] <= a[i] + b[i]).all()
            }

        def pairs(a, b):
            return [(int(x), int(y)) for i, j in overlapping(a, b) for x, y in zip(i, j, strict=True)]

        found = pairs(first, second)
        assert len(found) == len(set(found))
        assert set(found) == brute(low, size, other, its)
        own = pairs(first, first)
        assert len(own) == len(set(own))
        assert set(own) == {(i, j) for i, j in brute(low, size, low, size) if i < j}
