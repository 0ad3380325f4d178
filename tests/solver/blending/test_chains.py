"""Chains of edges blended as one contact: on each true face, by our referee and by Open CASCADE; no crease inside."""

import numpy as np
import pytest

from helpers.bases import cylinder as near_cylinder
from helpers.bases import patch
from helpers.chains import (
    arc,
    bernstein,
    box,
    circle,
    fillets,
    flanges,
    line,
    lines_inside,
    moved,
    normal_and_bend,
    oval,
    piece_along,
    rounded_square,
    run_through,
    seen_on_faces,
    stretched,
    strips,
    wall,
    walls,
    with_net,
)
from helpers.facing import random_facing
from helpers.rational import cylinder
from helpers.sweeps import first_ones, first_rows
from semispline import Base, BSplineSurface, ContactError, EdgeError, OptionError, blend, chain
from semispline.solver.blending import chain_joints, problem
from semispline.solver.splines.operations import split_v

TILT = np.array([[1, 0, 0], [0, np.cos(0.2), -np.sin(0.2)], [0, np.sin(0.2), np.cos(0.2)]])
# What the issue allows inside, degrees. Seen: 1e-12, some roundings of derivatives of the highest degree.
CREASE = 1e-9
# Roundings of points, of normals in degrees and of curvatures, the largest seen times ten and more: derivatives of
# Open CASCADE lose a few digits at the end of a span of high degree.
GAP, ANGLE, BEND = 1e-13, 1e-9, 1e-7
# No search: alpha as the gap has it.
PLAIN = {"alpha": "natural", "p2": "zero"}
PROFILE = rounded_square((4.0, 3.0), (1.0, 1.4, 1.2, 0.8))


def tube(radius=2.5, cuts=(0, 90, 180, 270, 360), z=4.0, tilt=TILT):
    return moved(walls(circle(radius, cuts), height=2.0), tilt, (0, 0, z))


def assert_met(result, edge, faces, order=2):
    """Contact with each face, as Open CASCADE has it."""
    gap, angle, bend = seen_on_faces(result.surface, edge, faces, count=3)
    assert gap < GAP
    assert angle < ANGLE
    assert order < 2 or bend < BEND


def assert_exact(contact, count, order=2):
    """The referee's measures on each face of a chain, in the limits of single edges: it refuses all else."""
    assert len(contact.edges) == count
    assert contact.limits == "exact"
    assert contact.worst("gap") < 1e-12
    assert contact.worst("angle_degrees") < ANGLE
    assert order < 2 or contact.worst("curvature_jump_relative") < BEND


FAMILIES = {
    "prism": (walls, {}, "natural"),
    "drafted": (walls, {"draft": 0.2}, "natural"),
    "drafted inwards": (walls, {"draft": -0.15}, "natural"),
    "plate": (flanges, {"width": 1.0}, 0.6),
    "plateau": (flanges, {"width": -0.5}, 0.6),
    "rounds": (fillets, {"radius": 0.6}, 0.3),
}


@pytest.mark.long
@pytest.mark.parametrize(
    ("family", "continuity"),
    first_rows(
        4,
        [("drafted", "G4"), ("prism", "G2"), ("plate", "G2"), ("rounds", "G2"), ("prism", "G1"), ("prism", "G3"),
         ("prism", "G4"), ("drafted", "G2"), ("drafted inwards", "G3"), ("plateau", "G2"), ("rounds", "G4")],
    ),
)  # fmt: skip
def test_rings_of_lines_and_arcs_to_a_tube(family, continuity):
    kind, named, alpha = FAMILIES[family]
    faces, far, order = kind(PROFILE, **named), tube(), int(continuity[1])
    result = blend(chain(faces), chain(far), continuity=continuity, alpha=alpha, p2="zero")
    assert lines_inside(result.surface).crease < CREASE
    assert_exact(result.chain_a, 8, order)
    assert_exact(result.chain_b, 4, order)
    assert_met(result, "u0", faces, order)
    assert_met(result, "u1", far, order)
    assert [joint.kind for joint in result.chain_a.joints] == ["smooth"] * 8
    assert result.chain_a.closed
    # Nothing is left to be cured.
    assert result.cures[0] is None
    # Line and arc: all of it goes to the straight faces, and the degree stays 4.
    assert (result.chain_a.degree, result.chain_a.control_points) == (4, 26)
    assert result.surface.control_curves[0].degree == 4
    # At each joint curvature along jumps between 0 and 1 / r, and that is said.
    assert sum("curvature along the contact jumps" in note for note in result.chain_a.notes()) == 8


def uncured(monkeypatch):
    """Leave the rows as the strip has them: cures of bases with knot lines of their own would close what is broken."""
    monkeypatch.setattr(problem, "smooth_along", lambda a, b, _: ((a, None), (b, None)))


def tube_base():
    cuts = tuple(np.radians([0, 120, 240, 360]))
    return moved([Base(cylinder(2.5, 0, 2.0, cuts), "u0")], TILT, (0, 0, 4.0))[0]


def smooth_tube():
    """The same, polynomial: nothing of it creases a blend."""
    return Base(near_cylinder(12, 2.5, (4.0, 6.0)), "u0")


@pytest.mark.long
def test_controls_see_nothing_where_nothing_is_broken(monkeypatch):
    uncured(monkeypatch)
    for draft in (0.0, 0.2):
        result = blend(chain(walls(PROFILE, draft=draft)), smooth_tube(), continuity="G1", **PLAIN)
        assert lines_inside(result.surface).crease < CREASE


@pytest.mark.long
def test_what_the_slopes_are_for(monkeypatch):
    """Control: values alone, as for prisms, leave a drafted ring creased."""
    uncured(monkeypatch)
    monkeypatch.setattr(chain_joints, "_take", lambda *_: None)
    result = blend(chain(walls(PROFILE, draft=0.2)), smooth_tube(), continuity="G1", **PLAIN)
    assert lines_inside(result.surface).crease > 0.5
    # And not of the faces: so the residuals say.
    assert max(max(joint.residuals) for joint in result.chain_a.joints) > 1e-3
    prism = blend(chain(walls(PROFILE)), smooth_tube(), continuity="G1", **PLAIN)
    assert lines_inside(prism.surface).crease < CREASE


@pytest.mark.long
@pytest.mark.parametrize("wrong", ["equal", "length"])
def test_what_the_spans_are_for(monkeypatch, wrong):
    """Control: equal spans, and spans by arc length, leave a prism creased."""
    uncured(monkeypatch)
    lengths = [np.linalg.norm(p[-1, :2] - p[0, :2]) * (1 if len(p) == 2 else np.pi / 8**0.5) for p in PROFILE]
    found = np.ones(8) if wrong == "equal" else np.array(lengths)
    monkeypatch.setattr(chain_joints, "_spans", lambda _: found)
    result = blend(chain(walls(PROFILE)), smooth_tube(), continuity="G1", **PLAIN)
    assert lines_inside(result.surface).crease > (3 if wrong == "equal" else 0.3)


@pytest.mark.long
def test_what_flat_weights_are_for(monkeypatch):
    """Control: arcs with the weights that they have leave a prism creased by many degrees."""
    uncured(monkeypatch)
    monkeypatch.setattr(chain_joints, "_flatten_weights", lambda *_, **__: None)
    monkeypatch.setattr(chain_joints, "_take", lambda *_: None)
    result = blend(chain(walls(PROFILE)), smooth_tube(), continuity="G1", **PLAIN)
    assert lines_inside(result.surface).crease > 1


@pytest.mark.long
def test_what_closing_speeds_are_for(monkeypatch):
    """Faces with speeds of their own: run through evenly their chain does not come back to the speed it began with."""
    uncured(monkeypatch)
    faces = [sped_up_face(x, times) for x, times in zip(walls(PROFILE), (1, 1, 2, 0.5, 1, 3, 1, 1), strict=True)]
    result = blend(chain(faces), smooth_tube(), continuity="G1", **PLAIN)
    assert lines_inside(result.surface).crease < CREASE
    assert_met(result, "u0", faces, 1)
    monkeypatch.setattr(chain_joints, "_closing_speeds", lambda pieces: pieces)
    assert lines_inside(blend(chain(faces), smooth_tube(), continuity="G1", **PLAIN).surface).crease > 1


def sped_up_face(base, times):
    """The face run through by v -> (1 - e) v + e v^2, which ends `times` as fast as it begins."""
    e = (times - 1) / (times + 1)
    return run_through(base, lambda t: (1 - e) * t + e * t**2, 2)


@pytest.mark.long
def test_a_rounded_rim_is_extruded_and_revolved():
    faces = walls(PROFILE)
    top = flanges(rounded_square((3.7, 2.7), (0.7, 1.1, 0.9, 0.5)), base=0.3, width=-0.2)
    result = blend(chain(faces), chain(top), **PLAIN)
    assert lines_inside(result.surface).crease < CREASE
    assert_met(result, "u0", faces)
    assert_met(result, "u1", top)
    # As an ordinary B-spline it has no more: both sides have one degree and the same knots.
    assert result.rows_stored == result.rows_converted == 6 * 17
    # Along a straight stretch all sections are one, moved; around a corner they are one, turned about its axis.
    u = np.linspace(0, 1, 9)
    breaks = np.unique(result.surface.to_bspline().knots_v)
    for k in range(8):
        sections = [result.surface.evaluate(u, np.full(9, v)) for v in np.linspace(breaks[k], breaks[k + 1], 4)]
        points = np.array(sections)
        if k % 2 == 0:
            apart = points - points[:1]
            assert np.abs(apart - apart[:, :1]).max() < 1e-12
        else:
            x, y, r = PROFILE[k][0, 0], PROFILE[k][0, 1], (1.0, 1.4, 1.2, 0.8)[k // 2]
            middle = {1: (x, y + r), 3: (x - r, y), 5: (x, y - r), 7: (x + r, y)}[k]
            radii = np.linalg.norm(points[..., :2] - middle, axis=-1)
            assert np.abs(radii - radii[:1]).max() < 1e-12
            assert np.abs(points[..., 2] - points[:1, :, 2]).max() < 1e-12


@pytest.mark.long
@pytest.mark.parametrize(("continuity", "stored"), first_rows(1, [("G2", 75), ("G3", 112), ("G4", 155)]))
def test_oval_to_round(continuity, stored):
    """4 lines, 4 arcs (two of the lines 2 quarters apart) to 8 arcs of one circle, searched alpha."""
    faces = walls(oval())
    far = tube(2.0, np.arange(9) * 45, tilt=np.eye(3))
    order = int(continuity[1])
    result = blend(chain(faces), chain(far), continuity=continuity)
    assert lines_inside(result.surface).crease < CREASE
    assert_exact(result.chain_a, 6, order)
    assert_exact(result.chain_b, 8, order)
    assert_met(result, "u0", faces, order)
    assert_met(result, "u1", far, order)
    # The round one is a smooth circle of 11 points and more for higher orders; the oval two lines and two half circles.
    assert result.chain_a.control_points == 14
    assert result.rows_stored == stored


@pytest.mark.long
@pytest.mark.parametrize("continuity", ["G2", "G4"])
def test_a_cylinder_in_three_arcs_is_the_cylinder(continuity):
    whole = Base(cylinder(3.0, 0, -2.0, tuple(np.radians([0, 90, 180, 270, 360]))), "u0")
    # The other one has arcs of its own: then both are run through by a smooth circle.
    far, three = tube_base(), walls(circle(3.0, [0, 92, 212, 360]))
    one = blend(whole, far, continuity=continuity, **PLAIN)
    other = blend(chain(three), far, continuity=continuity, **PLAIN)
    assert one.rows_stored == other.rows_stored
    assert apart(one, other) < 1e-12
    assert lines_inside(other.surface).bend < 1e-12
    assert_met(other, "u0", three)


def apart(one, other):
    """The largest distance of two surfaces with one domain up to an affine map."""
    u, worst = np.linspace(0, 1, 9), 0.0
    (a, b), (c, d) = one.surface.domain[1], other.surface.domain[1]
    for t in np.linspace(0, 1, 41):
        points = [s.surface.evaluate(u, np.full(9, v)) for s, v in ((one, a + (b - a) * t), (other, c + (d - c) * t))]
        worst = max(worst, float(np.abs(points[0] - points[1]).max()))
    return worst


@pytest.mark.parametrize("continuity", first_ones(1, ["G2", "G4", "G1", "G3"]))
@pytest.mark.parametrize("rational", [False, True])
def test_a_free_form_in_three_strips_is_the_free_form(rational, continuity):
    rng = np.random.default_rng(4)
    a, b = random_facing(rng)
    if rational:
        weights = np.exp(rng.uniform(-0.3, 0.3, a.surface.control_points.shape[:2]))
        a = Base(with_net(a.surface, a.surface.control_points, weights), "u0")
    low, high = a.surface.domain[1]
    parts = strips(a.surface, [low + 0.31 * (high - low), low + 0.7 * (high - low)])
    # Other lengths of w, of v, other weights.
    ways = ((1.0, 1.0, 1.0), (3.0, 2.0, 2.0), (0.4, 0.7, 0.3))
    faces = [Base(stretched(part, *way), "u0") for part, way in zip(parts, ways, strict=True)]
    one = blend(a, b, continuity=continuity, **PLAIN)
    other = blend(chain(faces), b, continuity=continuity, **PLAIN)
    assert [joint.kind for joint in other.chain_a.joints] == ["smooth"] * 2
    assert not any("curvature along" in note for note in other.chain_a.notes())
    # Coordinates up to 2: roundings of knots that are inserted and taken out again.
    assert apart(one, other) < 1e-12
    assert other.rows_stored == one.rows_stored
    # In whole edges the faces themselves.
    assert_met(other, "u0", faces, int(continuity[1]))


@pytest.mark.parametrize(
    ("kind", "continuity"), first_rows(2, [(walls, "G3"), (flanges, "G2"), (walls, "G2"), (flanges, "G3")])
)
def test_open_chains_to_free_forms(kind, continuity):
    profile = [line((-6, 0), (-2, 0)), arc((-2, 2), 2.0, -90, 0), line((0, 2), (0, 6))]
    faces = kind(profile, **({} if kind is walls else {"width": 1.0}))
    net = patch(np.random.default_rng(2), degrees=(3, 3), counts=(5, 6))
    points = net.control_points * [3, 8, 2]
    far = Base(with_net(net, np.stack([points[..., 1] - 6, 0.8 * points[..., 1] - 0.5, 4 + points[..., 0]], -1)), "u0")
    result = blend(chain(faces), far, continuity=continuity, alpha=0.5, p2="zero")
    assert lines_inside(result.surface).crease < CREASE
    assert_exact(result.chain_a, 3)
    assert_met(result, "u0", faces)
    assert (result.chain_a.closed, result.chain_a.degree) == (False, 4)
    assert len(result.chain_a.joints) == 2


def bent_sheet(rational):
    """One smooth sheet in two faces: the second one bends in its parameters, and in its weight, from the joint on."""

    def before(w, v):
        return [w, v, 0.3 * w * v + 0.2 * v * v - 0.1 * w * w], 1 + (0.1 * w + 0.2 * v) * rational

    def after(w, v):
        x, y = w + 0.7 * w * v, 1 + v * (0.6 + 0.5 * w)
        return before(x, y)[0], 1.2 + (0.1 * w + v * (0.3 + 0.2 * w)) * rational

    return [Base(fitted(piece, 4, rational), "u0") for piece in (before, after)]


def fitted(function, degree, rational):
    """The polynomial (or its quotient) as a surface, by interpolation in Bernstein form."""
    t = (1 - np.cos(np.linspace(0, np.pi, degree + 1))) / 2
    matrix = np.linalg.inv(bernstein(degree, t))
    values = np.array([[[*np.multiply(*function(w, v)), function(w, v)[1]] for v in t] for w in t])
    net = np.einsum("iw,jv,wvd->ijd", matrix, matrix, values)
    knots = [0.0] * (degree + 1) + [1.0] * (degree + 1)
    weights = net[..., 3] if rational else None
    return BSplineSurface(degree, degree, knots, knots, net[..., :3] / net[..., 3:], weights)


@pytest.mark.parametrize(
    ("rational", "continuity"),
    first_rows(2, [(False, "G3"), (True, "G2"), (False, "G1"), (False, "G2"), (True, "G1"), (True, "G3")]),
)
def test_faces_that_bend_in_their_parameters_close(rational, continuity):
    faces = bent_sheet(rational)
    far = Base(
        BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[-2, 0, 3], [-2.2, 1.6, 3.5]], [[-4, 0, 3], [-4, 2, 3]]]),
        "u0",
    )
    result = blend(chain(faces), far, continuity=continuity, alpha=0.5, p2="zero")
    order = int(continuity[1])
    assert lines_inside(result.surface).crease < CREASE
    assert_exact(result.chain_a, 2, order)
    assert_met(result, "u0", faces, order)
    assert [joint.kind for joint in result.chain_a.joints] == ["smooth"]
    # Three more for each order, and for the factor of weights.
    assert result.chain_a.degree == 4 + 3 * (order + rational)


@pytest.mark.parametrize("degrees", [0.003, 0.02])
def test_a_crease_of_the_faces_is_told_and_inherited(degrees):
    """Control: the second face turned about the contact by a small angle."""
    faces = walls([line((-4, 0), (0, 0)), line((0, 0), (4, 0))])
    t = np.radians(degrees)
    turned = moved(faces[1:], [[1, 0, 0], [0, np.cos(t), -np.sin(t)], [0, np.sin(t), np.cos(t)]])
    far = Base(wall(line((-4, -1), (4, -1)), base=3.0, height=2.0), "u0")
    with pytest.raises(EdgeError, match="leave the contact along one curve"):
        blend(chain([faces[0], *turned]), far, **PLAIN)
    # About the side edge, which both still share: the contact turns by as much.
    kinked = moved(faces[1:], [[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
    result = blend(chain([faces[0], *kinked]), far, **PLAIN)
    (joint,) = result.chain_a.joints
    assert joint.kind == "creased"
    assert joint.turn_degrees == pytest.approx(degrees, rel=1e-6)
    assert lines_inside(result.surface).crease == pytest.approx(degrees, rel=1e-3)
    assert any(f"creased by {degrees:.2g} degrees" in note for note in result.chain_a.notes())


@pytest.mark.long
def test_a_chain_of_one_edge_is_that_edge():
    one, far = walls([line((-4, 0), (4, 0))])[0], Base(wall(line((-3, 0), (3, 1)), base=3.0, height=2.0), "u0")
    assert apart(blend(one, far, **PLAIN), blend(chain([one]), far, **PLAIN)) < 1e-12
    # A closed one too, whose joints are its own arcs.
    whole = Base(cylinder(3.0, 0, -2.0, tuple(np.radians([0, 90, 180, 270, 360]))), "u0")
    single = blend(chain([whole]), tube_base(), **PLAIN)
    assert single.chain_a.closed
    assert_exact(single.chain_a, 1)
    assert apart(blend(whole, tube_base(), **PLAIN), single) < 1e-12


@pytest.mark.parametrize("size", first_ones(1, [1e-6, 1e-7, 1e-9]))
def test_faces_that_meet_within_a_tolerance(size):
    rng = np.random.default_rng(5)
    faces = [Base(with_net(x.surface, x.surface.control_points + size * rng.uniform(-1, 1, 3)), "u0")
             for x in walls(PROFILE)]  # fmt: skip
    result = blend(chain(faces, tolerance=1e-5), chain(tube()), **PLAIN)
    # Points are moved by half of the gaps; normals by that over an arc's length, in degrees.
    assert lines_inside(result.surface).crease < CREASE
    gap, angle, _ = seen_on_faces(result.surface, "u0", faces, count=3)
    assert gap * 10 < 2 * size
    assert angle < 60 * 5 * size
    contact = result.chain_a
    assert contact.limits == "cad"
    assert 0 < max(joint.moved for joint in contact.joints) < 2 * 3**0.5 * size
    assert contact.worst("angle_degrees") < 60 * 5 * size
    assert contact.closed
    assert result.seam is not None
    assert any("the edges meet within" in note for note in contact.notes())
    if size > 3e-7:
        # Unless a file says so they do not meet.
        with pytest.raises(EdgeError, match="away from where edge"):
            chain(faces)


@pytest.mark.long
def test_an_edge_shorter_than_the_tolerance_is_left_out():
    (start, end), tiny = PROFILE[0][:, :2], 1e-7
    middle = start + tiny * (end - start)
    faces = walls([line(start, middle), line(middle, end), *PROFILE[1:]])
    one = chain(faces)
    assert len(one.edges) == 8
    assert one.closed
    result = blend(one, chain(tube()), continuity="G1", **PLAIN)
    assert lines_inside(result.surface).crease < CREASE
    length = tiny * np.linalg.norm(end - start)
    assert max(joint.moved for joint in result.chain_a.joints) == pytest.approx(length, rel=1e-6)
    # A longer one is an edge.
    middle = start + 1e-4 * (end - start)
    assert len(chain(walls([line(start, middle), line(middle, end), *PROFILE[1:]])).edges) == 9


def test_what_is_no_chain():
    faces = walls(PROFILE)
    with pytest.raises(EdgeError, match="found no edges"):
        chain([])
    with pytest.raises(EdgeError, match=r"edge 2 .* begins .* away from where edge 1 ends"):
        chain([faces[0], faces[1], faces[3]])
    with pytest.raises(EdgeError, match="closed by itself"):
        chain([tube_base(), faces[0]])
    with pytest.raises(OptionError, match="expected G2"):
        blend(chain(faces), chain(tube()), continuity="C2")
    # One that leaves to the other side.
    other = walls(PROFILE[1:2], height=2.0)
    with pytest.raises(EdgeError, match="different sides"):
        blend(chain([faces[0], *other]), tube_base(), **PLAIN)


@pytest.mark.long
@pytest.mark.parametrize("far", ["box", "tube"])
def test_corners(far):
    faces = walls(box())
    other = moved(walls(box(2.0, 1.5), height=2.0), TILT, (0, 0, 4.0)) if far == "box" else tube()
    result = blend(chain(faces), chain(other), **PLAIN)
    assert [joint.kind for joint in result.chain_a.joints] == ["corner"] * 4
    assert [joint.turn_degrees for joint in result.chain_a.joints] == pytest.approx([90.0] * 4)
    assert_met(result, "u0", faces)
    assert_met(result, "u1", other)
    # 5 points on a row of lines; on the round one 11.
    assert result.rows_stored == (30 if far == "box" else 15 + 33)
    normal = corner_turns(result.surface)
    assert normal[0] == pytest.approx(90.0, abs=1e-9)
    if far == "box":
        # Each corner meets a corner, and goes all along.
        assert min(normal) > 60
        assert [joint.kind for joint in result.chain_b.joints] == ["corner"] * 4
    else:
        # It fades: less and less, to nothing.
        assert (np.diff(normal) < 1e-6).all()
        assert normal[-1] < 1e-6
    # Said where it is: none of it is the blend's own.
    assert sum("corner of 90 degrees" in note for note in result.chain_a.notes()) == 4
    assert not any("creased" in warning for warning in result.warnings)


def corner_turns(surface):
    """How far the normal turns across the first line of a corner, along it."""
    plain = surface.to_bspline()
    q, (values, counts) = plain.degree_v, np.unique(plain.knots_v, return_counts=True)
    at = int(np.flatnonzero(counts[1:-1] >= q)[0]) + 1
    u = np.linspace(*plain.domain[0], 11)
    (one, _), (other, _) = (normal_and_bend(piece_along(plain, k), u, values[at]) for k in (at - 1, at))
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), np.sum(one * other, axis=1)))


@pytest.mark.long
def test_neighbours_at_a_corner_share_their_boundary_curve():
    result = blend(chain(walls(box())), chain(moved(walls(box(2.0, 1.5), height=2.0), TILT, (0, 0, 4.0))), **PLAIN)
    plain = result.surface.to_bspline()
    for v in np.unique(plain.knots_v)[1:-1].tolist():
        one, other = split_v(plain, v)
        assert (one.control_points[:, -1] == other.control_points[:, 0]).all()


@pytest.mark.long
@pytest.mark.parametrize("width", [0.5, 0.1, 0.02])
def test_flat_bands_that_are_small_beside_the_chain(width):
    """A hundredth of it: its rows would lie too close together, and its spans too, to tell the whole by one bound."""
    bands = flanges(PROFILE, width=width)
    far = walls(circle(2.0, (0, 90, 180, 270, 360)), base=5.0, height=2.0)
    result = blend(chain(bands), chain(far), continuity="G4", **PLAIN)
    assert max(face.contact.rounding["second_rate_jump_relative"] for face in result.chain_a.faces) <= 1e-3
    assert_exact(result.chain_a, 8, 4)
    assert_met(result, "u0", bands)
    # What is shown of it is no wider than the faces.
    strip = chain(bands).strip(4)
    reach = [strip.surface.control_points, strip.shown.control_points]
    outer = np.array([4.0, 3.0, 0.0])
    assert (np.abs(reach[1]) <= outer + 1.5 * width + 1e-12).all()
    assert (np.abs(reach[0]).max(axis=(0, 1)) > outer + 2 * width)[:2].all() == (width < 0.5)


@pytest.mark.long
def test_faces_whose_own_points_round_too_much_are_refused_each_by_its_own_number():
    """Far from the origin: there the faces themselves have no rates of curvature left."""
    away = (1e5, 0.0, 0.0)
    bands = moved(flanges(PROFILE, width=0.5), offset=away)
    far = moved(walls(circle(2.0, (0, 90, 180, 270, 360)), base=5.0, height=2.0), offset=away)
    with pytest.raises(ContactError, match=r"edge \d \(u0\) of the chain: rounding alone may change second_rate_jump"):
        blend(chain(bands), chain(far), continuity="G4", **PLAIN)
