"""Strips of chains do not depend on where a chain begins, how its faces are run through, and how often it is cut."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.chains import (
    arc,
    box,
    circle,
    fillets,
    flanges,
    lines_inside,
    moved,
    oval,
    rounded_square,
    run_back_face,
    stretched,
    strips,
    turned_round,
    walls,
    with_net,
)
from helpers.sweeps import examples
from semispline import Base, blend, chain
from semispline.solver.blending.chain_runs import begun_at, run_back

KINDS = {
    "prism": (walls, {}),
    "drafted": (walls, {"draft": 0.2}),
    "plate": (flanges, {"width": 1.0}),
    "rounds": (fillets, {"radius": 0.3}),
}
# Points of strips, sizes up to 6: roundings of a few hundred operations on derivatives of order up to 4.
SAME = 1e-11

RADII = st.tuples(*[st.floats(0.5, 1.4)] * 4)
RINGS = st.tuples(RADII, st.sampled_from(sorted(KINDS)), st.integers(1, 3))


def ring(radii, kind):
    make, named = KINDS[kind]
    return make(rounded_square((4.0, 3.0), radii), **named)


def sampled(strip, firsts=None):
    """Points of the strip at the same places on each of its faces, shape (faces, places, rows, 3)."""
    surface, inner = strip.surface, np.array([0.0, 0.1, 0.37, 0.5, 0.81, 1.0])
    firsts = range(len(strip.cuts)) if firsts is None else firsts
    cuts = np.array(strip.cuts)[list(firsts)]
    u = np.linspace(*surface.domain[0], 4)
    found = []
    for low, high in pairwise(cuts):
        places = np.clip(low + (high - low) * inner, *surface.domain[1])
        found.append([surface.evaluate(u, np.full(4, v)) for v in places])
    return np.array(found)


@pytest.mark.long
@given(RINGS, st.integers(1, 7))
@examples(25)
def test_a_closed_chain_may_begin_at_any_face(ring_of, k):
    radii, kind, order = ring_of
    one = chain(ring(radii, kind))
    here, there = one.strip(order), begun_at(one, k).strip(order)
    assert np.abs(np.roll(sampled(here), -k, axis=0) - sampled(there)).max() < SAME
    assert [joint.kind for joint in there.joints] == ["smooth"] * 8
    spans = np.roll(np.diff(here.cuts), -k)
    np.testing.assert_allclose(np.diff(there.cuts), spans / spans[0], rtol=1e-10)


@pytest.mark.long
@given(RINGS)
@examples(25)
def test_a_chain_may_be_run_through_backwards(ring_of):
    radii, kind, order = ring_of
    one = chain(ring(radii, kind))
    here, back = one.strip(order), run_back(one).strip(order)
    u = np.linspace(*here.surface.domain[0], 4)
    (low, high), (start, end) = here.surface.domain[1], back.surface.domain[1]
    for t in np.linspace(0, 1, 23):
        points = here.surface.evaluate(u, np.full(4, low + (high - low) * t))
        others = back.surface.evaluate(u, np.full(4, end - (end - start) * t))
        assert np.abs(points - others).max() < SAME


@pytest.mark.long
@given(RINGS, st.data())
@examples(25)
def test_faces_may_be_run_through_in_any_way(ring_of, data):
    """Other lengths of w and v, weights times a factor, the other way along, and fractional linear in v."""
    radii, kind, order = ring_of
    faces = ring(radii, kind)
    scales = st.floats(0.3, 3.0)
    other = [faces[0]]
    for face in faces[1:]:
        changed = Base(stretched(face.surface, *data.draw(st.tuples(scales, scales, scales))), "u0")
        changed = turned_round(changed, data.draw(st.floats(0.6, 1.6)))
        other.append(run_back_face(changed) if data.draw(st.booleans()) else changed)
    here, there = chain(faces).strip(order), chain(other).strip(order)
    assert np.abs(sampled(here) - sampled(there)).max() < SAME


@pytest.mark.long
@given(RINGS, st.sets(st.integers(0, 3), min_size=1), st.floats(0.2, 0.8))
@examples(25)
def test_faces_along_lines_may_be_cut_further(ring_of, which, at):
    radii, kind, order = ring_of
    faces, cut, firsts = ring(radii, kind), [], [0]
    for k, face in enumerate(faces):
        parts = strips(face.surface, [at]) if k % 2 == 0 and k // 2 in which else [face.surface]
        cut += [Base(part, "u0") for part in parts]
        firsts.append(len(cut))
    here, there = chain(faces).strip(order), chain(cut).strip(order)
    assert [joint.kind for joint in there.joints] == ["smooth"] * len(cut)
    assert there.surface.degree_v == here.surface.degree_v
    # Parts of one line are one again.
    assert np.abs(sampled(here) - sampled(there, firsts)).max() < SAME


def test_nothing_is_left_of_cuts_along_lines():
    """No knots, which would cost points, and at which the search would look for more than there is."""
    faces = ring((0.5, 1.0, 0.7, 0.4), "prism")
    parts = [strips(face.surface, [0.3]) if face.surface.degree_v == 1 else [face.surface] for face in faces]
    cut = [Base(part, "u0") for pair in parts for part in pair]
    here, there = chain(faces).strip(2).surface.knots_v, chain(cut).strip(2).surface.knots_v
    assert len(cut) == 12
    assert there / there[-1] == pytest.approx(here / here[-1], abs=1e-12)


@pytest.mark.long
@given(RINGS)
@examples(25)
def test_a_closed_strip_ends_where_it_begins_to_the_last_bit(ring_of):
    """Kernels make both ends one when they read it: a blend that differs there would not be what was written."""
    radii, kind, order = ring_of
    surface = chain(ring(radii, kind)).strip(order).surface
    assert (surface.control_points[:, 0] == surface.control_points[:, -1]).all()
    assert (surface.weights[:, 0] == surface.weights[:, -1]).all()


@pytest.mark.long
@given(st.floats(1.5, 4.0), st.floats(1.5, 4.0), st.floats(-0.4, 0.4), st.integers(2, 4))
@examples(10)
def test_corners_answer_each_other_whichever_is_named_first(x, y, yaw, order):
    a = walls(box(3.0, 2.5))
    turn = [[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]]
    b = moved(walls(box(x, y), height=2.0), turn, (0.2, -0.1, 4.0))
    named = {"alpha": 0.8, "p2": "zero", "continuity": f"G{order}"}
    one, other = blend(chain(a), chain(b), **named), blend(chain(b), chain(a[2:] + a[:2]), **named)
    assert one.rows_stored == other.rows_stored == 5 * 2 * (order + 1)
    points = [np.concatenate([c.control_points for c in result.surface.control_curves]) for result in (one, other)]
    # The same net: each of its points is in both, the seam's in one of the corners.
    found = np.linalg.norm(points[0][:, None] - points[1][None], axis=2).min(axis=1)
    assert found.max() < SAME
    assert lines_inside(one.surface).crease > 10


def cut_arcs(pieces, at):
    """A profile whose arcs are cut in two, at a share of their angle."""
    found = []
    for piece in pieces:
        if len(piece) == 2:
            found.append(piece)
            continue
        ends = piece[[0, 2], :2]
        # Both tangents meet in the middle point: the centre lies beyond the chord.
        middle = piece[1, :2] / piece[1, 2]
        half = np.arccos(piece[1, 2])
        centre = ends.mean(axis=0) + (ends.mean(axis=0) - middle) / np.tan(half) ** 2
        radius = np.linalg.norm(ends[0] - centre)
        angles = np.degrees(np.unwrap([np.arctan2(*(x - centre)[::-1]) for x in ends]))
        between = angles[0] + at * (angles[1] - angles[0])
        found += [arc(centre, radius, angles[0], between), arc(centre, radius, between, angles[1])]
    return found


@pytest.mark.long
@pytest.mark.parametrize("family", [walls, flanges])
@pytest.mark.parametrize(("at", "first"), [(0.5, 0), (0.3, 2)])
def test_arcs_that_are_cut_make_the_strip_of_the_whole_ones(family, at, first):
    profile = rounded_square((4.0, 3.0), (1.0, 1.4, 1.2, 0.8))
    pieces = cut_arcs(profile, at)
    whole = chain(family(profile)).strip(2)
    # Begun in the middle of an arc, the third piece, it begins at the line that follows.
    rest = family(pieces)
    cut = chain(rest[first:] + rest[:first]).strip(2)
    begun = family(profile)
    if first:
        whole = chain(begun[first:] + begun[:first]).strip(2)
    assert len(whole.joints) == 8
    assert len(cut.joints) == 12
    assert all(joint.kind == "smooth" for joint in cut.joints)
    assert cut.surface.control_points.shape == whole.surface.control_points.shape
    assert cut.surface.knots_v == pytest.approx(whole.surface.knots_v, rel=1e-10)
    # Recognised from a singular value decomposition: some hundred roundings.
    assert cut.surface.control_points == pytest.approx(whole.surface.control_points, abs=1e-10)


@pytest.mark.long
def test_a_blend_of_cut_arcs_is_that_of_whole_ones_and_measured_on_each_face():
    """Halves of other heights, one run through backwards: other speeds across, and another way along."""
    profile = rounded_square((4.0, 3.0), (1.0, 1.4, 1.2, 0.8))
    faces = walls(cut_arcs(profile, 0.4))
    faces[1] = walls(cut_arcs(profile, 0.4), height=-3.0)[1]
    faces[4] = run_back_face(faces[4])
    tube = walls(circle(2.0, (0, 90, 180, 270, 360)), base=5.0, height=2.0)
    options = {"alpha": "natural", "p2": "zero"}
    whole, cut = blend(chain(walls(profile)), chain(tube), **options), blend(chain(faces), chain(tube), **options)
    assert cut.rows_stored == whole.rows_stored
    u, v = np.meshgrid(np.linspace(0, 1, 7), np.linspace(*whole.surface.domain[1], 41), indexing="ij")
    apart = whole.surface.evaluate(u.ravel(), v.ravel()) - cut.surface.evaluate(u.ravel(), v.ravel())
    assert np.abs(apart).max() <= 1e-9
    assert len(cut.chain_a.faces) == 12
    assert {face.edge for face in cut.chain_a.faces} == set(cut.chain_a.edges)
    assert cut.chain_a.worst("angle_degrees") <= 1e-9
    assert max(crease.curvature_jump_relative for crease in cut.creases) == pytest.approx(
        max(crease.curvature_jump_relative for crease in whole.creases), abs=1e-9
    )


def test_half_circles_of_two_arcs_are_one_piece():
    """A slot: between the lines nothing jumps."""
    strip = chain(walls(oval())).strip(2)
    assert len(strip.joints) == 6
    bends = [joint.bends for joint in strip.joints]
    assert sum(bends) == 4
    # Two lines and two half circles of degree 4.
    assert strip.surface.control_points.shape[1] == 4 * 4 - 4 + 1 + 1
    inner = strip.surface.knots_v[5:-5]
    assert len(np.unique(inner)) == 3


@pytest.mark.parametrize("noise", [2e-12, 6e-12])
def test_noise_of_a_file_does_not_raise_the_degree(noise):
    """Coordinates written with some digits less: 26 points of degree 4, as without, not 50 of degree 7."""
    rng = np.random.default_rng(0)
    profile = rounded_square((4.0, 3.0), (1.0, 1.4, 1.2, 0.8))
    found = []
    for base in walls(profile, draft=0.2):
        net = base.surface.control_points.copy()
        net[1] += noise * rng.standard_normal(net[1].shape)
        found.append(Base(with_net(base.surface, net), base.side))
    strip = chain(found).strip(2)
    assert (strip.surface.degree_v, strip.surface.control_points.shape[1]) == (4, 26)
    assert all(joint.kind == "smooth" for joint in strip.joints)
    assert max(max(joint.residuals) for joint in strip.joints) <= 2 * 4e-11
