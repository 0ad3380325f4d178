"""The gate before a changed solid is written: each kind of wrong solid is made and stopped, and no right one is."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer

from helpers.gated import corner_blend, edge_rounded, placed, put, solid_of, the_fillet
from helpers.parts import compound, fillet, graph_of
from helpers.solids import box, box_with_fillet, cut, cylinder, pin, volume
from semispline import (
    Base,
    BSplineCurve,
    BSplineSurface,
    blend,
    elevate_degree,
    extrude,
    insert_knots,
    reverse_v,
    revolve,
    swap_directions,
    transform,
)
from semispline.solver.topology.occ_shapes import copy_of, parts, raise_tolerance, tolerance_of
from semispline.solver.topology.solid_gate import gate

OUT = np.array([-1.0, -1.0, 0.0]) / np.sqrt(2)


def with_hole():
    """A hole beside the fillet, through the whole height."""
    return cut(box_with_fillet(5.0), cylinder(1.5, 40.0, at=(5.0, 5.0, 0.0)))


def bent(surface, by, columns=slice(3, 6), rows=slice(2, 4)):
    """A surface whose inner control points are moved; its ends and its contacts up to second order stay."""
    finer = insert_knots(elevate_degree(surface, surface.degree_u, 3), [], [0.2, 0.35, 0.5, 0.65, 0.8])
    points = finer.control_points.copy()
    points[rows, columns] += by
    return replace(finer, control_points=points)


def report_of(shape, surface):
    after, change = placed(shape, surface)
    return gate(shape, after, change)


def test_a_right_solid_passes():
    shape = box_with_fillet(5.0)
    found = report_of(shape, corner_blend())
    assert found.is_sound, found.reason
    assert found.faces == (7, 7)
    assert found.largest_tolerance == 1e-7
    # Less is taken away than by the round, whose section is (1 - pi / 4) r^2.
    assert found.volume[0] == pytest.approx(24000 - (1 - np.pi / 4) * 25 * 40, rel=1e-9)
    assert found.volume[0] < found.volume[1] < 24000


def test_tolerances_before_and_after_are_told():
    """Of each edge of the border that in whose place it comes; of the whole the largest, wherever it is."""
    shape = copy_of(box_with_fillet(5.0))[0]
    number, _ = the_fillet(shape)
    border, rest = ([e for n, f in enumerate(parts(shape, "FACE")) for e in parts(f, "EDGE") if (n == number) == own]
                    for own in (True, False))  # fmt: skip
    for edge in border:
        raise_tolerance(edge, 3e-6)
    raise_tolerance(next(e for e in rest if not any(e.IsSame(x) for x in border)), 7e-5)
    found = report_of(shape, corner_blend())
    assert found.is_sound, found.reason
    assert [edge.was for edge in found.border] == [3e-6] * 4
    assert found.tolerance == (7e-5, 7e-5)


def test_a_right_solid_beside_a_hole_passes():
    found = report_of(with_hole(), corner_blend())
    assert found.is_sound, found.reason


@pytest.mark.long
def test_v_may_run_either_way():
    shape = box_with_fillet(5.0)
    one, other = (report_of(shape, s) for s in (corner_blend(), reverse_v(corner_blend())))
    assert one.is_sound
    assert other.is_sound
    assert one.volume[1] == pytest.approx(other.volume[1], rel=1e-13)


def is_valid(shape):
    return BRepCheck_Analyzer(shape, True).IsValid()


@pytest.mark.parametrize(
    ("make", "by", "said"),
    [
        # Outwards, by 11: all else is right.
        (lambda: box_with_fillet(5.0), 11 / 0.4 * OUT, "the volume changes"),
        # Through the body and out of the far side.
        (lambda: box_with_fillet(5.0), -80 * OUT, "the volume changes"),
        # Into the hole, by so little that the volume says nothing.
        (with_hole, -9 * OUT, "cross"),
    ],
)
def test_bumps_and_dents_are_stopped(make, by, said):
    shape = make()
    after, change = placed(shape, bent(corner_blend(), by))
    assert is_valid(after)
    found = gate(shape, after, change)
    assert said in found.reason
    assert (found.place is not None) == (said == "cross")


def test_a_fold_inside_is_stopped():
    """Rows change places inside; border and contacts are right."""
    shape = box_with_fillet(5.0)
    surface = bent(corner_blend(), 0.0)
    points = surface.control_points.copy()
    points[2:4, 3:6] = points[3:1:-1, 3:6] + 6 * (points[3:1:-1, 3:6] - points[2:4, 3:6])
    after, change = placed(shape, replace(surface, control_points=points))
    assert is_valid(after)
    assert "folds" in gate(shape, after, change).reason


def test_a_face_turned_round_is_stopped():
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    faces = parts(after, "FACE")
    wrong = solid_of([face.Reversed() if n in change.new else face for n, face in enumerate(faces)])
    found = gate(shape, wrong, change)
    assert "not twice, one against the other" in found.reason


def test_a_solid_turned_inside_out_is_stopped():
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    assert "inside out" in gate(shape, after.Reversed(), change).reason


def test_a_missing_face_and_one_too_many_are_stopped():
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    faces = parts(after, "FACE")
    assert "6 faces came out, expected 7" in gate(shape, solid_of(faces[:-1]), change).reason
    assert "8 faces came out, expected 7" in gate(shape, solid_of([*faces, faces[0]]), change).reason
    assert "0 solids came out" in gate(shape, compound(faces), change).reason


def test_a_newly_open_edge_is_stopped_and_named():
    """The new face is there, but along one edge it is not sewn."""
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    faces = parts(after, "FACE")
    (number,) = change.new
    loose, _ = copy_of(faces[number])
    found = gate(shape, solid_of([loose if n == number else face for n, face in enumerate(faces)]), change)
    assert "would stay open" in found.reason
    assert found.place is not None


def test_an_open_shell_may_stay_open():
    shape = compound(face for n, face in enumerate(parts(box_with_fillet(5.0), "FACE")) if n != far_face())
    found = report_of(shape, corner_blend())
    assert found.is_sound, found.reason
    assert len(found.open_edges) == 4


def far_face():
    """The face x = 20 touches neither the fillet nor its neighbours' contacts."""
    graph = graph_of(box_with_fillet(5.0))
    return next(n for n in range(7) if np.abs(graph.uses.points[graph.uses.of_face(n), :, 0] - 20).max() < 1e-9)


@pytest.mark.parametrize("off", [1e-2, 1e-3, 1e-4])
def test_an_end_row_off_its_plane_is_stopped(off):
    shape = box_with_fillet(5.0)
    surface = corner_blend()
    points = surface.control_points.copy()
    points[2:4, 0, 2] += off
    found = report_of(shape, replace(surface, control_points=points))
    assert "off face" in found.reason
    # The largest weight of both rows is 0.625.
    assert max(x.gap for x in found.border or ()) <= 0.7 * off if found.border else True


def test_an_end_row_off_its_plane_by_less_than_a_tolerance_passes():
    surface = corner_blend()
    points = surface.control_points.copy()
    points[2:4, 0, 2] += 2e-5
    found = report_of(box_with_fillet(5.0), replace(surface, control_points=points))
    assert found.is_sound, found.reason
    assert found.largest_tolerance == pytest.approx(0.625 * 2e-5 * 1.05, rel=1e-3)


@pytest.mark.parametrize("off", [0.1, 1e-3])
def test_a_contact_off_its_face_is_stopped(off):
    """Also where the file's own tolerance would hide it."""
    shape, _ = copy_of(box_with_fillet(5.0))
    for edge in parts(shape, "EDGE"):
        raise_tolerance(edge, 0.0155)
    for vertex in parts(shape, "VERTEX"):
        raise_tolerance(vertex, 0.0155)
    surface = corner_blend()
    points = surface.control_points.copy()
    points[:3, :, 1] += off
    assert report_of(shape, replace(surface, control_points=points)).reason is not None


def test_loops_and_ends_across_far_edges_are_stopped():
    shape = box_with_fillet(5.0)
    surface = corner_blend()
    for by in (np.array([60.0, 0.0, 0.0]), np.array([-60.0, -60.0, 0.0])):
        points = surface.control_points.copy()
        points[2:4, :] += by
        assert report_of(shape, replace(surface, control_points=points)).reason is not None


def rim(shape):
    graph = graph_of(shape)
    number = graph.faces.kind.index("torus")
    rows = graph.uses.of_face(number)
    around = [k for k in range(rows.stop - rows.start) if not graph.uses.seam[rows.start + k]]
    high = [k for k in around if abs(graph.uses.points[rows.start + k, 0, 2] - 20) < 1e-6]
    return number, (tuple(high), tuple(k for k in around if k not in high))


@cache
def rim_blend():
    """From the top of a pin of radius 8, 20 high, 4 inside its rim, to its side; exact surfaces of revolution."""
    top = revolve(line([4.0, 0, 20], [0.5, 0, 20]), [0, 0, 0], [0, 0, 1])
    side = revolve(line([8.0, 0, 16], [8.0, 0, 0]), [0, 0, 0], [0, 0, 1])
    edges = [
        next(e for e in ("u0", "u1", "v0", "v1") if starts_at(s, e, z, r)) for s, z, r in ((top, 20, 4), (side, 16, 8))
    ]
    return blend(Base(top, edges[0]), Base(side, edges[1]), middle_curves=0).surface.to_bspline()


def starts_at(surface, edge, z, radius):
    base = Base(surface, edge)
    points = base.derivative(np.linspace(*base.range_along, 5), 0, 0)
    return np.abs(points[:, 2] - z).max() < 1e-9 and np.abs(np.hypot(*points[:, :2].T) - radius).max() < 1e-9


def line(a, b):
    return BSplineCurve(1, [0, 0, 1, 1], [a, b])


def turned_by(surface, angle):
    c, s = np.cos(angle), np.sin(angle)
    return transform(surface, np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]))


@pytest.mark.long
def test_a_right_rim_passes():
    shape = pin(4.0)
    number, contacts = rim(shape)
    after, change = put(shape, rim_blend(), number, contacts)
    found = gate(shape, after, change)
    assert found.is_sound, found.reason


@pytest.mark.long
@pytest.mark.parametrize("turns", [1e-2, 1e-3, 1e-5])
def test_a_rim_whose_seam_is_off_is_stopped(turns):
    """Open CASCADE calls it valid, with a tolerance of half a unit."""
    shape = pin(4.0)
    number, contacts = rim(shape)
    after, change = put(shape, turned_by(rim_blend(), 2 * np.pi * turns), number, contacts)
    assert is_valid(after)
    assert "tolerance" in gate(shape, after, change).reason


@pytest.mark.long
def test_a_face_that_was_not_to_be_changed_is_looked_at():
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    moved, _ = placed(box_with_fillet(5.0, (20.0, 30.0, 41.0)), corner_blend(height=41.0))
    assert gate(shape, moved, replace(change, volume=1e9)).reason is not None
    assert gate(shape, after, change).is_sound


def test_tolerances_elsewhere_may_not_grow():
    shape = box_with_fillet(5.0)
    after, change = placed(shape, corner_blend())
    edge = parts(parts(after, "FACE")[far_face()], "EDGE")[0]
    raise_tolerance(edge, 10 * tolerance_of(edge))
    assert "became 1e-06" in gate(shape, after, change).reason


def test_the_input_is_not_changed():
    shape = box_with_fillet(5.0)
    before = [tolerance_of(x) for kind in ("FACE", "EDGE", "VERTEX") for x in parts(shape, kind)], volume(shape)
    points = corner_blend().control_points.copy()
    points[2:4, 0, 2] += 0.1
    placed(shape, replace(corner_blend(), control_points=points))
    assert before == (
        [tolerance_of(x) for kind in ("FACE", "EDGE", "VERTEX") for x in parts(shape, kind)], volume(shape)
    )  # fmt: skip


@cache
def box_with_twelve(radius):
    return fillet(box(20, 30, 40), radius, lambda *_: True)


def along_a_fillet(radius, dip):
    """From ball to ball along the upright round of a box with twelve, the old end edges kept, bent in by so much."""
    r, h = radius, 40.0 - 2 * radius
    arc = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[r, 0, r], [0, 0, r], [0, r, r]], [1, np.sqrt(0.5), 1])
    upright = extrude(arc, [0, 0, h])
    surface = upright if upright.degree_u == 1 else swap_directions(upright)
    surface = elevate_degree(surface, 5, 3)
    points = surface.control_points.copy()
    points[2:4, 1:-1] -= dip * OUT
    return replace(surface, control_points=points)


@pytest.mark.parametrize("dip", [0.0, 20.0])
def test_the_wrong_pair_with_its_ends_kept_is_stopped_among_twelve_fillets(dip):
    """Valid, and no tolerance grows: the volume alone tells; the round put back in its own place is right."""
    shape = box_with_twelve(2.0)
    number, upright = the_fillet(shape)
    graph = graph_of(shape)
    rows = graph.uses.of_face(number)
    low, high = sorted((k for k in range(4) if (k,) not in upright), key=lambda k: graph.uses.points[rows][k, 0, 2])
    after, change = put(shape, along_a_fillet(2.0, dip), number, ((low,), (high,)))
    assert is_valid(after)
    assert max(tolerance_of(edge) for edge in parts(after, "EDGE")) <= 1.1e-7
    found = gate(shape, after, change)
    assert found.is_sound if dip == 0 else "the volume changes" in found.reason


def round_of(cuts, reach, inwards=1.0):
    """From the plane y = 0 to the plane x = 0 about the upright edge, quintic, with rows of one length."""
    a, b = np.array([cuts[0], 0, 0.0]), np.array([0, cuts[1], 0.0])
    to_a, to_b = np.array([-1.0, 0, 0]), np.array([0, -1.0, 0])
    rows = [a, a + 0.2 * reach * to_a, a + 0.4 * reach * to_a, b + 0.4 * reach * to_b, b + 0.2 * reach * to_b, b]
    points = np.array([[row, row + np.array([0, 0, 40.0])] for row in rows])
    return BSplineSurface(5, 1, [0] * 6 + [1] * 6, [0, 0, 1, 1], points)


@pytest.mark.parametrize(
    ("cuts", "reach", "said"),
    [((1.0, 8.0), 8.0, "rounding this edge takes away some"), ((3.0, 6.0), 4.0, None), ((1.0, 8.0), 2.5, None)],
)
def test_a_sharp_edge_that_bulges_out_is_stopped(cuts, reach, said):
    """Rows that are too long leave the box where the cut is short; the kernel calls it valid."""
    shape = box(20, 30, 40)
    graph = graph_of(shape)
    edges = [
        (int(graph.uses.face[row]), int(graph.uses.number[row]))
        for row in range(len(graph.uses))
        if np.abs(graph.uses.points[row, :, :2]).max() < 1e-9 and abs(graph.uses.normal[row, 0, 1]) > 0.5
    ]
    ((face, k),) = edges
    after, change = edge_rounded(shape, face, k, round_of(cuts, reach), grows=False)
    assert is_valid(after)
    found = gate(shape, after, change)
    assert found.reason is None if said is None else said in found.reason
    # What an inner edge is to do is the other way round.
    other = gate(shape, after, replace(change, grows=True))
    assert other.is_sound if said else "inner corner adds some" in other.reason
