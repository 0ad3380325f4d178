"""Strips of chains do not depend on where a chain begins, how its faces are run through, and how often it is cut."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from helpers.chains import (
    box,
    fillets,
    flanges,
    lines_inside,
    moved,
    rounded_square,
    run_back_face,
    stretched,
    strips,
    turned_round,
    walls,
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
    # What runs along a straight face is a cubic on each of its parts: the contact stays, not where it is met.
    assert there.surface.degree_v == here.surface.degree_v
    same = sampled(there, firsts)[..., 0, :]
    assert np.abs(sampled(here)[..., 0, :] - same).max() < SAME
    if kind == "prism":
        assert np.abs(sampled(here) - sampled(there, firsts)).max() < SAME


def test_nothing_is_left_of_cuts_along_lines():
    """No knots, which would cost points, and at which the search would look for more than there is."""
    faces = ring((0.5, 1.0, 0.7, 0.4), "prism")
    parts = [strips(face.surface, [0.3]) if face.surface.degree_v == 1 else [face.surface] for face in faces]
    cut = [Base(part, "u0") for pair in parts for part in pair]
    here, there = chain(faces).strip(2).surface.knots_v, chain(cut).strip(2).surface.knots_v
    assert len(cut) == 12
    assert there / there[-1] == pytest.approx(here / here[-1], abs=1e-12)


@given(RINGS)
@examples(25)
def test_a_closed_strip_ends_where_it_begins_to_the_last_bit(ring_of):
    """Kernels make both ends one when they read it: a blend that differs there would not be what was written."""
    radii, kind, order = ring_of
    surface = chain(ring(radii, kind)).strip(order).surface
    assert (surface.control_points[:, 0] == surface.control_points[:, -1]).all()
    assert (surface.weights[:, 0] == surface.weights[:, -1]).all()


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
