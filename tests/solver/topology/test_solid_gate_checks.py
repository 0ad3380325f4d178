"""Each check of the gate by itself: what nothing else would stop is stopped, and its limit holds from both sides."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.gp import gp_Trsf, gp_Vec
from OCP.TopoDS import TopoDS_Shell

from helpers.gated import corner_blend, edge_rounded, placed, solid_of
from helpers.parts import compound, graph_of, moved, written
from helpers.solids import MODELS, box, box_with_fillet, cylinder, volume
from helpers.sweeps import first_ones
from semispline import (
    Base,
    BSplineCurve,
    ComputationError,
    SolidError,
    blend,
    elevate_degree,
    insert_knots,
    replace_face,
    revolve,
    swap_directions,
)
from semispline.solver.topology import solid_blends, solid_gate
from semispline.solver.topology.end_faces import blend_onto
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.gate_report import Change, GateReport
from semispline.solver.topology.gate_sides import NotSoundError
from semispline.solver.topology.occ_faces import rebuilt
from semispline.solver.topology.occ_joining import joined
from semispline.solver.topology.occ_new_edges import copied_edge
from semispline.solver.topology.occ_shapes import (
    EdgeUsers,
    add_pcurve,
    copy_of,
    ends,
    forward,
    new_vertex,
    parameters_of,
    parts,
    plane_curve,
    points_of,
    raise_tolerance,
    range_of,
    tolerance_of,
    with_range,
)
from semispline.solver.topology.relations import relate
from semispline.solver.topology.solid_gate import gate

OUT = np.array([-1.0, -1.0, 0.0]) / np.sqrt(2)


@cache
def right():
    shape = box_with_fillet(5.0)
    return shape, *placed(shape, corner_blend())


def anew():
    """The same, of which the result may be changed."""
    shape, after, change = right()
    return shape, copy_of(after)[0], change


def far_edge(shape):
    """An edge from (20, 30, 0) to (20, 30, 40): its faces do not touch the new one."""
    edges = (edge for edge in parts(shape, "EDGE") if np.abs(middle(edge) - [20, 30, 20]).max() < 1e-9)
    return forward(next(edges))


def middle(edge):
    return points_of(edge, np.array([np.mean(range_of(edge))]))[0]


def test_an_open_edge_that_is_new_is_stopped():
    shape, after, change = anew()
    users, faces = EdgeUsers(after), parts(after, "FACE")
    (new,) = change.new
    edge = next(e for e in parts(faces[new], "EDGE") if np.ptp(points_of(e, np.linspace(*range_of(e), 3))[:, 2]) < 1)
    (beyond,) = (n for n, _ in users.of(edge) if n != new)
    # The same line once more: the end face has one, the new face the other.
    own = rebuilt(faces[beyond], {users.number(edge): [(copied_edge(edge, faces[beyond]), False)]}, users, [])
    found = gate(shape, solid_of([own if n == beyond else face for n, face in enumerate(faces)]), change)
    assert "would stay open" in found.reason
    assert min(abs(found.place[2] - z) for z in (0.0, 40.0)) < 1e-9


def test_a_shell_that_is_no_longer_marked_as_closed_is_stopped():
    shape, after, change = anew()
    parts(after, "SHELL")[0].Closed(False)
    assert "no longer marked as closed" in gate(shape, after, change).reason


def loosened(shape):
    """A shape one of whose edges has a wrong curve on the face x = 20."""
    copy, _ = copy_of(shape)
    edge, faces = far_edge(copy), parts(copy, "FACE")
    number = next(n for n, _ in EdgeUsers(copy).of(edge) if np.abs(box_of_face(faces[n])[:, 0] - 20).max() < 1e-6)
    uv = parameters_of(edge, faces[number], np.array(range_of(edge)))
    add_pcurve(edge, plane_curve(np.array(range_of(edge)), uv + 0.5, 1), faces[number])
    return copy, number


def box_of_face(face):
    return np.concatenate([points_of(edge, np.array(range_of(edge))) for edge in parts(face, "EDGE")])


def test_what_the_kernels_check_finds_is_stopped():
    shape, after, change = anew()
    wrong, number = loosened(after)
    found = gate(shape, wrong, change)
    assert found.reason == f"Open CASCADE's check fails on face {number}"
    assert found.place is not None


def test_what_was_not_valid_before_may_stay_so_elsewhere():
    shape, _ = loosened(box_with_fillet(5.0))
    after, change = placed(shape, corner_blend())
    found = gate(shape, after, change)
    assert found.is_sound, found.reason
    assert found.was_invalid
    assert not gate(*right()).was_invalid


def with_void(at):
    """The right solid with a hole inside, and the same with that elsewhere."""
    shape, after, change = right()
    trsf = gp_Trsf()
    trsf.SetTranslation(gp_Vec(*at))
    voids = [[face.Reversed() for face in parts(x, "FACE")] for x in (void(), moved(void(), trsf))]
    return solid_of(parts(shape, "FACE"), voids[0]), solid_of(parts(after, "FACE"), voids[1]), change


@cache
def void():
    return box(2, 2, 2, at=(10, 15, 20))


def test_what_is_wrong_with_the_whole_alone_is_stopped():
    """A hole that lies outside of its solid: each face is right."""
    assert gate(*with_void((0, 0, 0))).is_sound
    assert "on the whole" in gate(*with_void((40, 0, 0))).reason


def without_far(shape):
    """A shell without the face x = 20."""
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    for face in parts(shape, "FACE"):
        if np.abs(box_of_face(face)[:, 0] - 20).max() > 1e-6:
            builder.Add(shell, face)
    return shell


def test_open_shells_have_no_inside():
    """What differences of volume are told by may change its sign: they are told about the middle of the box."""
    shape, after, change = right()
    far = next(n for n, face in enumerate(parts(shape, "FACE")) if np.abs(box_of_face(face)[:, 0] - 20).max() < 1e-6)
    # About the middle of the box round all, far from the missing face, a third of what is between counts less.
    low = 20 - (volume(shape) + 1 + 30) / 200
    wide = compound(parts(box(1, 1, 1, at=(low, 0, 0)), "FACE"))
    number = change.new[0] - (far < change.new[0])
    touched, contacts = (tuple(n - (far < n) for n in x) for x in (change.touched, change.contacts))
    shifted = replace(change, old=(number,), new=(number,), touched=touched, contacts=contacts)
    found = gate(compound([without_far(shape), wide]), compound([without_far(after), wide]), shifted)
    assert found.is_sound, found.reason
    assert found.volume[0] < 0 < found.volume[1]


def test_an_edge_of_an_open_shell_is_rounded_as_that_of_a_solid():
    shape = box(20, 30, 40)
    wanted = upright_edge(without_far(shape))
    found = [
        gate(x, *edge_rounded(x, *upright_edge(x), corner_blend(4.0), grows=False)) for x in (shape, without_far(shape))
    ]
    assert wanted
    assert all(x.is_sound for x in found), [x.reason for x in found]
    changes = [x.volume[1] - x.volume[0] for x in found]
    assert changes[1] == pytest.approx(changes[0], rel=1e-6)


def upright_edge(shape):
    """A face and its edge at x = y = 0, of the face y = 0."""
    graph = graph_of(shape)
    row = next(
        row
        for row in range(len(graph.uses))
        if np.abs(graph.uses.points[row, :, :2]).max() < 1e-9 and abs(graph.uses.normal[row, 0, 1]) > 0.5
    )
    return int(graph.uses.face[row]), int(graph.uses.number[row])


@pytest.mark.parametrize(("share", "is_sound"), [(0.22, True), (0.28, False)])
def test_the_volume_may_change_by_a_quarter(share, is_sound):
    shape, after, change = right()

    def bumped(by):
        finer = insert_knots(
            elevate_degree(corner_blend(), corner_blend().degree_u, 3), [], [0.2, 0.35, 0.5, 0.65, 0.8]
        )
        points = finer.control_points.copy()
        points[2:-2, 3:6] += by * OUT
        return placed(shape, replace(finer, control_points=points))[0]

    # It grows as the bump does.
    had = volume(shape)
    one, two = (volume(x) - had for x in (after, bumped(1.0)))
    found = gate(shape, bumped((share * change.volume - one) / (two - one)), change)
    if is_sound:
        assert found.volume[1] - had == pytest.approx(share * change.volume, rel=1e-4), found.reason
    assert found.is_sound if is_sound else "the volume changes" in found.reason, found.reason


def test_an_input_that_is_inside_out_stays_so():
    """Then an edge that takes away makes the volume, which is below 0, more."""
    shape = box(20, 30, 40)
    wanted = upright_edge(shape)
    after, change = edge_rounded(shape, *wanted, corner_blend(4.0), grows=False)
    assert gate(shape, after, change).is_sound
    found = gate(shape.Reversed(), after.Reversed(), change)
    assert found.is_sound, found.reason
    assert found.volume[0] < found.volume[1] < 0


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_tolerance_of_the_new_face_has_a_limit(share):
    shape, after, change = anew()
    (edge,) = parts(parts(after, "FACE")[change.new[0]], "EDGE")[:1]
    limit = 1e-6 * 40
    for x in (edge, *ends(edge)):
        raise_tolerance(x, share * limit)
    found = gate(shape, after, change)
    assert found.is_sound if share < 1 else "of the new face needs a tolerance" in found.reason


def test_the_largest_tolerance_of_a_file_is_no_limit():
    """What an edge elsewhere has allows the new face nothing."""
    shape, _ = copy_of(box_with_fillet(5.0))
    raise_tolerance(far_edge(shape), 0.0155)
    for vertex in ends(far_edge(shape)):
        raise_tolerance(vertex, 0.0155)
    after, change = placed(shape, corner_blend())
    assert gate(shape, after, change).is_sound
    (edge,) = parts(parts(after, "FACE")[change.new[0]], "EDGE")[:1]
    for x in (edge, *ends(edge)):
        raise_tolerance(x, 1e-3)
    assert "of the new face needs a tolerance of 0.001" in gate(shape, after, change).reason


def test_what_the_old_face_had_may_stay():
    shape, _ = copy_of(box_with_fillet(5.0))
    number = right()[2].old[0]
    for edge in parts(parts(shape, "FACE")[number], "EDGE"):
        for x in (edge, *ends(edge)):
            raise_tolerance(x, 1e-3)
    after, change = placed(shape, corner_blend())
    (edge,) = parts(parts(after, "FACE")[change.new[0]], "EDGE")[:1]
    raise_tolerance(edge, 0.9e-3)
    found = gate(shape, after, change)
    assert found.is_sound, found.reason


def off_its_contact(by):
    surface = corner_blend()
    points = surface.control_points.copy()
    points[:3, :, 1] += by
    shape = box_with_fillet(5.0)
    return shape, *placed(shape, replace(surface, control_points=points))


def test_a_measured_gap_allows_three_times_as_much():
    gap = 1e-4
    shape, after, change = off_its_contact(gap)
    found = gate(shape, after, change)
    assert found.is_sound, found.reason
    assert found.largest_tolerance == pytest.approx(1.05 * gap, rel=1e-3)
    edge = max(parts(parts(after, "FACE")[change.new[0]], "EDGE"), key=tolerance_of)
    for share in (2.7, 3.3):
        for x in (edge, *ends(edge)):
            raise_tolerance(x, share * gap)
        found = gate(shape, after, change)
        assert found.is_sound if share < 3 else "of the new face needs a tolerance" in found.reason


@pytest.mark.long
def test_a_contact_is_held_to_a_thousandth_of_a_millimetre():
    """1e-5 of the edge is 4e-4 here: less than 0.001 in millimetres, more than 0.001 mm in inches."""
    shape, after, change = off_its_contact(1e-4)
    assert gate(shape, after, change, millimetres=1.0).is_sound
    assert "off face" in gate(shape, after, change, millimetres=25.4).reason
    assert "off face" in gate(*off_its_contact(4.4e-4)).reason
    assert gate(*off_its_contact(3.6e-4)).is_sound


def test_an_edge_that_is_new_elsewhere_is_stopped():
    """An edge that does not touch the new face is cut in two."""
    shape, after, change = anew()
    users, faces = EdgeUsers(after), parts(after, "FACE")
    edge = far_edge(after)
    low, high = range_of(edge)
    first, last = ends(edge)
    vertex = new_vertex(middle(edge))
    mine = [n for n, _ in users.of(edge)]
    curve = BRep_Tool.Curve_s(edge, low, high)
    pieces = [
        with_range(curve, *limits, 1e-7, corners)
        for limits, corners in (
            ((low, (low + high) / 2), (first, vertex)), (((low + high) / 2, high), (vertex, last))
        )
    ]  # fmt: skip
    for n in mine:
        for piece in pieces:
            add_pcurve(piece, BRep_Tool.CurveOnSurface_s(edge, faces[n], low, high), faces[n])
    own = {n: rebuilt(faces[n], {users.number(edge): [(x, False) for x in pieces]}, users, []) for n in mine}
    found = gate(shape, solid_of([own.get(n, face) for n, face in enumerate(faces)]), change)
    assert "is new, and not of the new face" in found.reason


@pytest.mark.parametrize(
    ("was", "share", "read_back", "is_sound"),
    [
        (1e-7, 1.2, False, False),
        (1e-3, 1.9, True, True),
        (1e-3, 2.1, True, False),
        # Less than 1e-6 of the size is nothing to a reader.
        (1e-7, 350.0, True, True),
        (1e-7, 450.0, True, False),
    ],
)
@pytest.mark.parametrize("which", ["edge", "vertex"])
def test_tolerances_elsewhere(which, was, share, read_back, is_sound):
    """They stay; who reads a file measures them anew."""
    shape, _ = copy_of(box_with_fillet(5.0))
    for x in (far_edge(shape), *ends(far_edge(shape))):
        raise_tolerance(x, was)
    after, change = placed(shape, corner_blend())
    for x in [far_edge(after)] if which == "edge" else ends(far_edge(after)):
        raise_tolerance(x, share * was)
    found = gate(shape, after, change, read_back=read_back)
    said = "the tolerance of the edge" if which == "edge" else "a vertex needs a tolerance"
    assert found.is_sound if is_sound else said in found.reason, found.reason


@pytest.mark.long
def test_faces_that_were_not_named_are_compared():
    """By their areas: the lid of a pin whose rim was rounded has the same middle."""
    shape, after, change = right()
    assert "was not to be changed" in gate(shape, after, replace(change, touched=())).reason
    lid = cylinder(8, 20)
    graph = graph_of(lid)
    row = next(k for k in range(len(graph.uses)) if graph.uses.normal[k, 0, 2] > 0.9)
    wanted = int(graph.uses.face[row]), int(graph.uses.number[row])
    found = rim_rounded(lid, wanted)
    assert gate(lid, *found).is_sound
    beside = tuple(n for n in found[1].touched if n != wanted[0])
    assert "was not to be changed" in gate(lid, found[0], replace(found[1], touched=beside)).reason


def rim_rounded(shape, wanted):
    top = revolve(BSplineCurve(1, [0, 0, 1, 1], [[5.0, 0, 20], [0.5, 0, 20]]), [0, 0, 0], [0, 0, 1])
    side = revolve(BSplineCurve(1, [0, 0, 1, 1], [[8.0, 0, 17], [8.0, 0, 0]]), [0, 0, 0], [0, 0, 1])
    sides = ((top, 20, 5), (side, 17, 8))
    edges = [next(e for e in ("u0", "u1", "v0", "v1") if meets_at(Base(s, e), z, r)) for s, z, r in sides]
    surface = blend(Base(top, edges[0]), Base(side, edges[1]), middle_curves=0).surface.to_bspline()
    after, change = edge_rounded(shape, *wanted, surface, grows=False)
    return after, change


def meets_at(base, z, radius):
    points = base.derivative(np.linspace(*base.range_along, 5), 0, 0)
    return np.abs(points[:, 2] - z).max() < 1e-9 and np.abs(np.hypot(*points[:, :2].T) - radius).max() < 1e-9


def test_places_of_faces_that_were_not_named_are_compared():
    """Two sides of a hole have the same area, and are not at the same place."""
    before, after, change = with_void((0, 0, 0))
    kept = {n: n for n in range(13) if n not in change.old}
    assert gate(before, after, replace(change, kept=kept)).is_sound
    other = kept | {7: 8, 8: 7}
    assert "face 7 was not to be changed" in gate(before, after, replace(change, kept=other)).reason


@pytest.mark.parametrize(("share", "is_same"), [(0.5, True), (2.0, False)])
def test_an_area_that_stays_has_a_limit(share, is_same):
    faces = [
        next(x for x in parts(box(1, y, 1), "FACE") if np.ptp(box_of_face(x)[:, 2]) < 1e-9)
        for y in (1.0, 1 + share * 1e-9)
    ]
    both = SimpleNamespace(
        kept={0: 0}, change=Change((), (), (), 0.0, ()), faces=([faces[0]], [faces[1]]), first=(0, 0), size=1.0
    )
    if is_same:
        solid_gate._unchanged(both, GateReport(None), read_back=False)
    else:
        with pytest.raises(NotSoundError, match="was not to be changed"):
            solid_gate._unchanged(both, GateReport(None), read_back=False)


@pytest.mark.parametrize(("least", "is_sound"), [(2e-9, True), (0.5e-9, False)])
def test_a_pinch_is_stopped(least, is_sound, monkeypatch):
    monkeypatch.setattr(solid_gate, "measure_regularity", lambda _: SimpleNamespace(least_area_ratio=least))
    found = gate(*right())
    assert found.is_sound if is_sound else "is pinched" in found.reason


def test_what_cannot_be_measured_is_stopped(monkeypatch):
    def fails(_):
        raise ComputationError("no")

    monkeypatch.setattr(solid_gate, "measure_turn", fails)
    assert "the new face cannot be measured: no" in gate(*right()).reason


def test_what_crossed_before_may_go_on_doing_so():
    """A small box through the upper end, which another solid of the file always crossed."""
    shape, after, change = right()
    small = box(1.3, 1.3, 2, at=(4.2, 4.2, 39))
    found = gate(compound([shape, small]), compound([after, small]), change)
    assert found.is_sound, found.reason


@pytest.mark.long
@pytest.mark.parametrize("share", first_ones(1, [0.8, 1.25]))
def test_an_end_on_a_curved_face_may_be_off_by_so_much(share, tmp_path, monkeypatch, read_here):
    shape = MODELS["round end r=3.0"]()
    path = written(shape, tmp_path / "part.brep")
    graph = graph_of(shape)
    (number,) = find_fillets(graph, relate(graph)).accepted

    def off_its_end(*arguments):
        result, surface = blend_onto(*arguments)
        points = surface.control_points.copy()
        end = 0 if points[0, 0, 2] > points[0, -1, 2] else -1
        points[2:-2, end, 2] += 1
        wrong = replace(surface, control_points=points)
        u, v = np.linspace(*surface.domain[0], 200), [surface.domain[1][end]]
        most = np.abs(wrong.evaluate_grid(u, v) - surface.evaluate_grid(u, v)).max()
        # The face looks along z but for 15 degrees at most.
        points[2:-2, end, 2] += share * 1e-5 * 60 / most - 1
        return result, replace(surface, control_points=points)

    monkeypatch.setattr(solid_blends, "blend_onto", off_its_end)
    if share < 1:
        assert replace_face(path, number, tmp_path / "out.step").gate.is_sound
    else:
        with pytest.raises(SolidError, match=r"off face \d"):
            replace_face(path, number, tmp_path / "out.step")


def two_bars():
    """Two bars on one axis, 4 apart, and the tube between: it is exact."""
    shape = compound([cylinder(3, 5), cylinder(3, 5, at=(0, 0, 9))])
    graph = graph_of(shape)
    caps = [
        next(n for n in range(6) if np.abs(graph.uses.points[graph.uses.of_face(n), :, 2] - z).max() < 1e-9)
        for z in (5, 9)
    ]
    around = revolve(BSplineCurve(1, [0, 0, 1, 1], [[3.0, 0, 5], [3.0, 0, 9]]), [0, 0, 0], [0, 0, 1])
    corner = around.evaluate_grid([around.domain[0][0]], around.domain[1])[0]
    surface = around if np.ptp(corner[:, 2]) < 1e-9 else swap_directions(around)
    return shape, tuple(caps), surface


@pytest.mark.long
def test_joined_bars():
    shape, caps, surface = two_bars()
    after, change = joined(copy_of(shape)[0], caps, [surface])
    found = gate(shape, after, change)
    assert found.is_sound, found.reason
    assert found.volume[1] == pytest.approx(np.pi * 9 * 14, rel=1e-9)
    assert "1 solids came out, expected 2" in gate(shape, after, replace(change, joined=0)).reason
    # Less than nothing is expected of bars that are inside out.
    reverse = gate(shape.Reversed(), after.Reversed(), change)
    assert reverse.is_sound, reverse.reason
    assert "the volume changes by" in gate(shape, after, replace(change, expected=-change.expected)).reason
    assert "the volume changes by" in gate(shape, after, replace(change, expected=0.0, volume=1e-3)).reason
