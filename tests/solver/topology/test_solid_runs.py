"""Fillets that go on into each other replaced together; or with their old end edges kept, where contact falls to G1."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone
from OCP.Geom2d import Geom2d_Line
from OCP.gp import gp_Ax1, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d, gp_Trsf, gp_Vec
from typer.testing import CliRunner

from helpers.parts import fillet, graph_of, moved, rounded_box, written
from helpers.solids import box, circles_at, cut, cylinder, half_space, rounded, volume
from helpers.sweeps import first_rows
from semispline import Base, EdgeError, SolidError, read_surface, replace_face
from semispline.solver.cli import app
from semispline.solver.judge import measure_face_contact
from semispline.solver.topology import contacts_in_solid, find_places, solid_blends
from semispline.solver.topology.face_runs import face_run, runs_on
from semispline.solver.topology.fillets import chains, find_fillets
from semispline.solver.topology.gate_edges import loose_area
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import add_pcurve, forward, parts, points_of, range_of
from semispline.solver.topology.relations import relate

pytestmark = pytest.mark.usefixtures("read_here")

# Of the section between a sharp edge and a round of radius 1.
_ROUND = 1 - np.pi / 4


def found_in(shape):
    graph = graph_of(shape)
    relations = relate(graph)
    accepted = find_fillets(graph, relations).accepted
    return graph, relations, accepted, chains(graph, relations, accepted)


def ring_of(shape):
    (ring,) = found_in(shape)[3]
    return ring


def stadium():
    """A box with two upright edges of one side rounded, and the rim that these and three walls have with its top."""
    shape = fillet(box(40, 30, 20), 6.0, lambda p, d: abs(d[2]) > 0.5 and p[0] < 1)
    return fillet(shape, 2.0, lambda p, _: p[2] > 19.99 and p[0] < 39)


def three_edges():
    """A box with the three edges of one corner rounded, which meet in a piece of a ball."""
    return fillet(box(20, 30, 40), 3.0, lambda p, _: np.sum(np.abs(p) < 1e-6) == 2)


def is_valid(path):
    shape = open_parts(path).root
    return BRepCheck_Analyzer(shape, True).IsValid() and len(parts(shape, "SOLID")) == 1


@pytest.mark.long
@pytest.mark.parametrize(("upright", "top"), first_rows(1, [(3.0, 1.5), (4.0, 1.0), (5.0, 4.0)]))
def test_a_closed_rim_of_eight_fillets_is_replaced_together(upright, top, tmp_path):
    shape = rounded_box(upright, top)
    ring = ring_of(shape)
    assert len(ring) == 8
    found = replace_face(written(shape, tmp_path / "part.brep"), ring, tmp_path / "out.step")
    assert is_valid(tmp_path / "out.step")
    assert sorted(found.faces) == sorted(ring)
    assert found.gate.faces == (18, 18)
    assert found.kept == ()
    # The tolerance that the kernel gives to edges without a gap.
    assert found.gate.largest_tolerance <= 1.1e-7
    assert max(edge.gap for edge in found.gate.border) <= 1e-12 * 40
    # All of it lies between the rounds and the sharp edges, of the length of the rim where both meet.
    most = _ROUND * top**2 * (2 * (40 + 30) - 8 * upright + 2 * np.pi * upright)
    assert 0 < found.gate.volume[1] - found.gate.volume[0] < most


@pytest.mark.slow
def test_straight_parts_of_a_ring_are_extruded(tmp_path):
    """With the same shape parameters each unit of length takes away the same, whatever the lengths are."""
    changes, shape_of_all = [], {}
    for length in (40.0, 50.0, 60.0):
        shape = fillet(box(length, 30.0, 20.0), 3.0, lambda _, along: abs(along[2]) > 0.5)
        shape = fillet(shape, 1.5, lambda point, _: point[2] > 19.99)
        path = written(shape, tmp_path / "part.brep")
        found = replace_face(path, ring_of(shape), tmp_path / "out.brep", p2="zero", **shape_of_all)
        shape_of_all = shape_of_all or {"alpha": (found.blend.alpha2**0.5, found.blend.beta2**0.5)}
        changes.append(found.gate.volume[1] - found.gate.volume[0])
    # The kernel integrates volumes to 1e-6 of what lies under each face; what is compared is 1e-4 of that.
    assert changes[2] - changes[1] == pytest.approx(changes[1] - changes[0], rel=1e-3)
    assert changes[1] - changes[0] > 0.02


@pytest.mark.long
def test_an_open_chain_ends_on_the_walls_at_its_ends(tmp_path):
    shape = stadium()
    graph, relations, _, groups = found_in(shape)
    (chain,) = groups
    assert len(chain) == 5
    run = face_run(graph, relations, chain)
    assert not run.closed
    assert not runs_on(graph, relations, run)
    found = replace_face(written(shape, tmp_path / "part.brep"), chain, tmp_path / "out.step")
    assert is_valid(tmp_path / "out.step")
    assert found.gate.largest_tolerance <= 1.1e-7
    assert found.blend.warnings == ()
    # In any order they are the same faces.
    again = replace_face(written(shape, tmp_path / "part.brep"), chain[::-1], tmp_path / "again.step")
    assert again.gate.volume[1] == pytest.approx(found.gate.volume[1], rel=1e-9)


@pytest.mark.long
def test_an_open_chain_ends_on_slanted_walls_too(tmp_path):
    """Rows of rims whose joints answer each other are taken as they are, but not where they have to be bent."""
    shape = fillet(box(40, 30, 20), 6.0, lambda p, d: abs(d[2]) > 0.5 and p[0] < 1 and p[1] < 1)
    shape = cut(shape, half_space([34, 0, 10], [1, 0.3, 0]))
    shape = fillet(shape, 2.0, lambda p, _: p[2] > 19.99 and min(p[0], p[1]) < 3)
    _, _, _, groups = found_in(shape)
    found = replace_face(written(shape, tmp_path / "part.brep"), groups[0], tmp_path / "out.step")
    assert is_valid(tmp_path / "out.step")
    assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.slow
def test_a_second_replacement_of_a_ring_changes_nothing(tmp_path):
    shape = rounded_box()
    ring = ring_of(shape)
    first = replace_face(written(shape, tmp_path / "part.brep"), ring, tmp_path / "one.step")
    again = replace_face(tmp_path / "one.step", first.faces, tmp_path / "two.step")
    # The fairest shape is sought to some 1e-6 of its measure, and that is flat there: the shape to the root of it.
    change = first.gate.volume[1] - first.gate.volume[0]
    assert again.gate.volume[1] == pytest.approx(first.gate.volume[1], abs=1e-3 * change)


@pytest.mark.slow
def test_faces_of_a_ring_whose_sides_do_not_answer_each_other_meet_across(tmp_path):
    """With a free row both sides are smooth chains of their own: corners lie at different v, on the seam too."""
    shape = rounded_box()
    path = written(shape, tmp_path / "part.brep")
    found = replace_face(path, ring_of(shape), tmp_path / "out.step", middle_curves=1)
    assert is_valid(tmp_path / "out.step")
    assert found.gate.largest_tolerance <= 1.1e-7
    assert found.gate.volume[1] > found.gate.volume[0]


@pytest.mark.slow
def test_place_turn_and_scale_change_nothing(tmp_path):
    shape = rounded_box()
    ring = ring_of(shape)
    plain = replace_face(written(shape, tmp_path / "part.brep"), ring, tmp_path / "plain.brep").gate.volume
    step, large = gp_Trsf(), gp_Trsf()
    step.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 2)), 1.1)
    step.SetTranslationPart(gp_Vec(300, -20, 7))
    large.SetScale(gp_Pnt(0, 0, 0), 1000.0)
    for trsf, scale in ((step, 1.0), (large, 1000.0)):
        found = replace_face(written(moved(shape, trsf), tmp_path / "moved.brep"), ring, tmp_path / "out.step").gate
        # The fairest shape is sought to some 1e-6 of its measure.
        assert (found.volume[1] - found.volume[0]) / scale**3 == pytest.approx(plain[1] - plain[0], rel=1e-5)


@pytest.mark.parametrize("continuity", ["G2", "G3"])
def test_an_end_edge_is_kept_and_contact_says_so(continuity, tmp_path):
    shape = three_edges()
    _, _, accepted, groups = found_in(shape)
    assert groups == []
    number = next(iter(accepted))
    path = written(shape, tmp_path / "part.brep")
    # With a ball there is no chain that could be replaced.
    said = r"goes on into face \d+ over e\d.* face \d+ cannot be replaced with it \(.*three-sided\): keep this edge"
    with pytest.raises(EdgeError, match=said):
        replace_face(path, number, tmp_path / "out.step")
    found = replace_face(path, number, tmp_path / "out.step", keep_ends=True, continuity=continuity)
    assert is_valid(tmp_path / "out.step")
    (end,) = found.kept
    # A quarter of a circle of radius 3, and a third of the contact is longer.
    assert end.length == pytest.approx(3 * np.pi / 2, rel=1e-3)
    assert end.distance <= 1e-9 * 40
    # Straight fillets go on into the ball smoothly; 1e-6 is what an angle is told to by a sine of rounding.
    assert end.crease_degrees <= 1e-4
    assert found.gate.largest_tolerance <= 1.1e-7
    assert any("contact falls" in text for text in found.notes)
    # At the edge the round's own curvature is what the flat face does not have.
    assert found.blend.contact_a.curvature_jump == pytest.approx(1 / 3, rel=1e-4)
    assert found.blend.contact_a.angle_degrees <= 1e-6


@pytest.mark.long
def test_a_kept_edge_at_the_pole_of_a_ball_is_measured(tmp_path):
    """A hair in space is much in the parameters there: the pcurve that is read leaves the face, the edge does not."""
    shape = fillet(box(40, 30, 20), 4.0, lambda p, _: np.sum(np.abs(p) < 1e-6) == 2)
    path, out = written(shape, tmp_path / "part.brep"), tmp_path / "out.step"
    _, _, accepted, _ = found_in(shape)
    for number in accepted:
        found = replace_face(path, number, out, keep_ends=True)
        contacts = contacts_in_solid(out, found.faces)
        assert len(contacts) == 3
        # The limits of CAD checkers: an edge is kept in the tolerance of its file.
        assert max(x.contact.angle_degrees for x in contacts) <= 1e-2
        assert max(x.contact.gap for x in contacts) <= 1e-6 * 40


@pytest.mark.long
def test_a_crease_at_a_kept_edge_is_stopped(tmp_path, monkeypatch):
    """The end lies on the edge, and the row beside it leaves the tangent plane of the ball by one part in a hundred."""
    shape = three_edges()
    _, _, accepted, _ = found_in(shape)
    real = solid_blends.ended_on_edges

    def creased(surface, edges):
        made, kept = real(surface, edges)
        points, end = made.control_points.copy(), kept[0].range[0] > made.domain[1][0]
        near, way = (-2, points[:, -1] - points[:, -2]) if end else (1, points[:, 0] - points[:, 1])
        # Rows of the contacts stay.
        points[2:-2, near] += 0.01 * np.cross(way, points[1:, near][:1] - points[:1, near])[2:-2]
        return replace(made, control_points=points), kept

    path, out = written(shape, tmp_path / "part.brep"), tmp_path / "out.step"
    found = replace_face(path, next(iter(accepted)), out, keep_ends=True)
    assert 0 < found.gate.crease_degrees < 1e-4
    out.unlink()
    monkeypatch.setattr(solid_blends, "ended_on_edges", creased)
    with pytest.raises(
        SolidError, match=r"at a crease of .* where the old one went on smoothly, expected at most 0.01"
    ):
        replace_face(path, next(iter(accepted)), out, keep_ends=True)
    assert not out.exists()


@pytest.mark.long
def test_contacts_beside_kept_ends_are_told_from_the_rest(tmp_path):
    shape = three_edges()
    _, _, accepted, _ = found_in(shape)
    path, out, report = (tmp_path / name for name in ("part.brep", "out.step", "report.json"))
    words = ["--replace", str(next(iter(accepted))), "--keep-ends", "-o", str(out), "--report", str(report)]
    done = CliRunner().invoke(app, ["blend", str(written(shape, path)), *words])
    assert done.exit_code == 0, done.output
    rows = json.loads(report.read_text())["contacts_in_solid"]
    kinds = [row["stretch"] for row in rows]
    assert sorted(kinds) == ["", "", "beside a kept end", "beside a kept end", "kept end"]
    for row in rows:
        # Curvature has no limit where contact is G1 alone.
        assert ("curvature_jump_relative" in row["allowed"]) == (row["stretch"] == "")
        assert all(row[name] <= limit for name, limit in row["allowed"].items() if row[name] is not None)
        if row["stretch"] == "beside a kept end":
            # The jump is at the edge, a radius from the corner.
            place = np.array(row["at"]["curvature_jump_relative"]["point"])
            assert sorted(np.abs(place)) == pytest.approx([0, 3, 3], abs=1e-6)
    assert done.output.count("beside a kept end: G1, the jump at (") == 2


@pytest.mark.long
def test_beyond_the_stated_length_contact_is_what_was_asked(tmp_path):
    shape = three_edges()
    _, _, accepted, _ = found_in(shape)
    number = next(iter(accepted))
    found = replace_face(written(shape, tmp_path / "part.brep"), number, tmp_path / "out.step", keep_ends=True)
    surface = read_surface(f"{tmp_path / 'out.step'}#{found.face}")
    (end,) = found.kept
    low, high = surface.domain[1]
    corners = surface.evaluate_grid([surface.domain[0][0]], [low, high])[0]
    length = float(np.linalg.norm(corners[1] - corners[0]))
    # The edge lies where all three coordinates of its corner are small.
    kept_low = np.abs(corners[0]).max() < np.abs(corners[1]).max()
    share = 1.001 * end.length / length
    rest = (low + share * (high - low), high) if kept_low else (low, high - share * (high - low))
    near = (low, rest[0]) if kept_low else (rest[1], high)
    beyond = [read_surface(f"{tmp_path / 'out.step'}#{n}") for n in found.touched if n != found.face]
    flat = [x for x in beyond if _is_flat(x)]
    jumps = {}
    for name, (start, stop) in (("rest", rest), ("near", near)):
        own = Base(surface, f"u0[{start!r},{stop!r}]")
        jumps[name] = min(_jump(own, face) for face in flat)
    assert jumps["rest"] <= 1e-6
    assert jumps["near"] > 1


def _is_flat(surface):
    points = surface.control_points.reshape(-1, 3)
    return np.linalg.svd(points - points.mean(axis=0))[1][2] <= 1e-9


def _jump(own, face):
    try:
        found = measure_face_contact(own, face)
    except EdgeError:
        return np.inf
    return found.curvature_jump_relative if found.gap <= 1e-6 else np.inf


@pytest.mark.long
def test_rows_along_an_arc_in_pieces_end_on_the_wall_that_cuts_it(tmp_path):
    """Read as a conic, and run through by a circle of its own, the contact would leave the end faces in silence."""
    # The lines of a cone leave a plane beside its axis.
    cone = rounded(BRepPrimAPI_MakeCone(8.0, 4.0, 10.0).Shape(), 1.0, circles_at(0, 8.0))
    shape = cut(cone, half_space([0, 0.83, 0], [0, -1, 0]))
    (number,) = found_in(shape)[2]
    found = replace_face(written(shape, tmp_path / "part.brep"), number, tmp_path / "out.step")
    assert is_valid(tmp_path / "out.step")
    assert found.gate.largest_tolerance <= 1.1e-7
    assert max(edge.gap for edge in found.gate.border if edge.is_plane) <= 1e-8


def test_borders_that_a_file_holds_apart_may_move_by_that(tmp_path):
    shape = cylinder(8.0, 20.0)
    wall = next(face for face in parts(shape, "FACE") if len(parts(face, "EDGE")) == 4)
    # What lies between the curves is rounding of lengths.
    assert loose_area(wall) <= 1e-9
    edges = parts(wall, "EDGE")
    heights = [points_of(edge, np.linspace(*range_of(edge), 9))[:, 2] for edge in edges]
    rim, height = next((edge, z[0]) for edge, z in zip(edges, heights, strict=True) if np.ptp(z) < 1)
    line = Geom2d_Line(gp_Pnt2d(0.0, 0.01 + height), gp_Dir2d(1.0, 0.0))
    add_pcurve(forward(rim), line, wall)
    # Of chords, of which there are 64 round the rim.
    assert loose_area(wall) == pytest.approx(0.01 * 2 * np.pi * 8, rel=1e-3)


@pytest.mark.long
def test_ends_of_a_chain_are_kept_and_its_joints_are_not(tmp_path):
    shape = rounded_box()
    graph, relations, _, (ring,) = found_in(shape)
    pair = face_run(graph, relations, ring).faces[:2]
    path = written(shape, tmp_path / "part.brep")
    with pytest.raises(
        EdgeError, match=r"\d+,\d+: they go on into faces \d+ and \d+ over \d+:e\d and \d+:e\d"
    ) as found:
        replace_face(path, pair, tmp_path / "out.step")
    # All eight are named, not only the next ones, and what is printed does it.
    named = re.search(r"\(--replace ([\d,]+)\)", str(found.value))
    assert set(map(int, named[1].split(","))) == set(ring)
    found = replace_face(path, pair, tmp_path / "out.step", keep_ends=True)
    assert is_valid(tmp_path / "out.step")
    assert len(found.kept) == 2
    # Extruded and revolved as the old ones were.
    assert max(end.crease_degrees for end in found.kept) <= 1e-4


@pytest.mark.long
def test_what_is_no_run_is_refused(tmp_path):
    shape = rounded_box()
    graph, relations, accepted, (ring,) = found_in(shape)
    order = face_run(graph, relations, ring).faces
    path, out = written(shape, tmp_path / "part.brep"), tmp_path / "out.step"
    with pytest.raises(EdgeError, match="belong to one chain of fillets: replace all of it") as found:
        replace_face(path, [order[0], order[4]], out)
    named = re.search(r"\(--replace ([\d,]+)\)", str(found.value))
    assert set(map(int, named[1].split(","))) == set(ring)
    with pytest.raises(EdgeError, match="is there twice"):
        replace_face(path, [order[0], order[0]], out)
    uprights = [face for face in accepted if face not in ring]
    with pytest.raises(EdgeError, match="do not go on into each other over ends of both; replace them one after"):
        replace_face(path, uprights[:2], out)
    # An upright round ends on one of the ring: that lies across.
    with pytest.raises(EdgeError, match=r"it is a fillet across\): keep this edge, .* \(--keep-ends\)"):
        replace_face(path, uprights[0], out)
    flat = next(n for n in range(len(graph.faces)) if graph.uses.of_face(n).stop - graph.uses.of_face(n).start == 8)
    with pytest.raises(EdgeError, match=rf"face {flat} has no two opposite sides at whose ends face \d+ begins"):
        replace_face(path, [order[0], flat], out)
    assert not out.exists()


@pytest.mark.long
def test_the_gate_stops_a_ring_whose_neighbours_do_not_meet(tmp_path, monkeypatch):
    shape = rounded_box()
    real = solid_blends.panels_of

    def apart(*arguments):
        panels = real(*arguments)
        surface = panels[0].surface
        points = surface.control_points.copy()
        points[2:4, -1] += 0.01
        return [replace(panels[0], surface=replace(surface, control_points=points)), *panels[1:]]

    monkeypatch.setattr(solid_blends, "panels_of", apart)
    with pytest.raises(SolidError, match="not sound"):
        replace_face(written(shape, tmp_path / "part.brep"), ring_of(shape), tmp_path / "out.step")
    assert not (tmp_path / "out.step").exists()


@pytest.mark.slow
def test_pairs_offers_the_chain_and_its_command_does_it(tmp_path):
    shape = rounded_box()
    path, report = written(shape, tmp_path / "part.brep"), tmp_path / "report.json"
    places = find_places(path)
    (chain,) = places.of_kind("chain")
    (command,) = chain.commands
    words = command.split()
    numbers = words[words.index("--replace") + 1]
    assert set(map(int, numbers.split(","))) == set(chain.faces)
    assert "--keep-ends" not in words
    # One of its members has the same command; what ends on the ring keeps that end.
    fillets = {place.faces[0]: place.commands[0] for place in places.of_kind("fillet")}
    assert any(numbers in text for text in fillets.values())
    assert any("--keep-ends" in text for text in fillets.values())
    out = tmp_path / "out.step"
    done = CliRunner().invoke(app, ["blend", str(path), "--replace", numbers, "-o", str(out), "--report", str(report)])
    assert done.exit_code == 0, done.output
    assert "are the blend" in done.output
    assert sorted(json.loads(report.read_text())["new_faces"]) == sorted(chain.faces)
    assert volume(open_parts(out).root) > volume(shape)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--replace", "1,x"], "expected a face, 12, or several"),
        (["--replace", "1", "--keep-ends", "--surfaces"], "--keep-ends: found it where no solid comes back"),
    ],
)
def test_words_are_checked_before_a_file_is_read(words, said, tmp_path):
    done = CliRunner().invoke(app, ["blend", "no.step", *words, "-o", str(tmp_path / "out.step")])
    assert done.exit_code == 2
    assert said in " ".join(done.output.split())
