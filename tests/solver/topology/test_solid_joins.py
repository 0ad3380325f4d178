"""Outlines of planar faces joined by a blend: one valid solid, all else as it was; or nothing is written."""

import json
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from typer.testing import CliRunner

from helpers.bars import bar, drafted, ellipse_wire, end_at, oval, oval_wire, round_wire, tube
from helpers.parts import compound, graph_of, moved, written
from helpers.solids import box, circles_at, cut, cylinder, fused, rounded, volume
from helpers.sweeps import first_ones, first_rows
from helpers.xcaf import labels_of, write_parts
from semispline import EdgeError, FileError, SolidError, join_faces
from semispline.solver import workers
from semispline.solver.cli import app
from semispline.solver.io import foreign
from semispline.solver.topology import solid_joins
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import EdgeUsers, jets_at, parameters_of, parts, range_of
from semispline.solver.topology.tube_volume import tube_volume

pytestmark = pytest.mark.usefixtures("read_here")


def two(a, b, folder, at=(0.0, 6.0)):
    """Two files, as --from and --to name their ends."""
    paths = [written(shape, folder / f"{name}.brep") for name, shape in (("a", a), ("b", b))]
    return [f"{path}#{end_at(shape, z)}" for path, shape, z in zip(paths, (a, b), at, strict=True)]


def assert_one_valid_solid(root, faces):
    """By Open CASCADE alone: one closed solid, each edge between two uses."""
    assert BRepCheck_Analyzer(root, True).IsValid()
    assert [len(parts(root, kind)) for kind in ("SOLID", "SHELL", "FACE")] == [1, 1, faces]
    users = EdgeUsers(root)
    edges = [edge for face in parts(root, "FACE") for edge in parts(face, "EDGE")]
    assert all(len(users.of(edge)) == 2 for edge in edges)


def normals_beside(root, new):
    """Angles in degrees between the normals of a face and of its neighbours, by Open CASCADE's surfaces."""
    faces, users, found = parts(root, "FACE"), EdgeUsers(root), []
    for edge in parts(faces[new], "EDGE"):
        t = np.linspace(*range_of(edge), 33)
        normals = []
        for number, used in users.of(edge):
            jet = jets_at(faces[number], parameters_of(used, faces[number], t))
            normal = np.cross(jet[:, 1], jet[:, 2])
            normals.append(normal / np.linalg.norm(normal, axis=1)[:, None])
        sine = np.linalg.norm(np.cross(*normals), axis=1)
        found.append(np.degrees(np.arcsin(np.minimum(sine, 1))).max())
    return max(found)


@pytest.mark.long
@pytest.mark.parametrize(
    ("continuity", "arcs", "split", "pieces"),
    first_rows(1, [("G2", 4, "corners", 1), ("G3", 6, "corners", 1), ("G4", 8, "corners", 1), ("G2", 5, "joints", 13)]),
)
def test_an_oval_profile_joined_to_a_round_one(continuity, arcs, split, pieces, tmp_path):
    a, b = oval(), tube(arcs)
    specs = two(a, b, tmp_path)
    found = join_faces(*specs, tmp_path / "out.step", continuity=continuity, split=split)
    root = open_parts(tmp_path / "out.step").root
    assert_one_valid_solid(root, 10 + arcs + 2 - 2 + pieces)
    assert found.gate.solids == (2, 1)
    assert found.gate.largest_tolerance == found.read_back.largest_tolerance == 1e-7
    # As docs/chains.md has them, for each true face.
    assert max(x.worst("angle_degrees") for x in (found.blend.chain_a, found.blend.chain_b)) < 1e-10
    assert max(edge.gap for edge in found.gate.border) < 1e-11
    # Curves on faces lie within 1e-7 of each other, and no curvature is above 2: 2e-7 in radians at most.
    assert all(normals_beside(root, n) < 2e-5 for n in found.faces)
    assert volume(a) + volume(b) < volume(root) == pytest.approx(found.gate.volume[1], rel=1e-9)
    # Less than the hull of both ends, more than the tube alone.
    assert np.pi * 1.5**2 * 6 < volume(root) - volume(a) - volume(b) < volume(bar(oval_wire(3, 1, 1, 0), 6))


@pytest.mark.parametrize(
    ("make", "at", "pieces"),
    first_rows(
        1,
        [
            (lambda: (cylinder(3, 5), cylinder(2, 5, at=(0.5, 0, 9))), (5, 9), 1),
            (lambda: (oval(), cylinder(1.5, 3, at=(0, 0, 6))), (0, 6), 1),
            (lambda: (drafted(), tube(5)), (0, 6), 1),
            (lambda: (box(6, 4, 4), box(3, 2, 4, at=(1, 1, 9))), (4, 9), 4),
            (lambda: (box(6, 4, 4, at=(-3, -2, -4)), tube(4)), (0, 6), 4),
        ],
    ),
    ids=["rounds", "oval and one rim", "drafted", "boxes", "box and round"],
)
def test_other_profiles(make, at, pieces, tmp_path):
    a, b = make()
    found = join_faces(*two(a, b, tmp_path, at), tmp_path / "out.step")
    root = open_parts(tmp_path / "out.step").root
    assert len(found.faces) == pieces
    assert_one_valid_solid(root, len(parts(a, "FACE")) + len(parts(b, "FACE")) - 2 + pieces)
    assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.long
@pytest.mark.parametrize(("arcs", "continuity"), first_rows(1, [((4, 6), "G2"), ((8, 8), "G3"), ((4, 4), "G2")]))
def test_an_ellipse_joined_to_a_circle(arcs, continuity, tmp_path):
    """Vertices that face each other do so: the seam of the blend ends in them, and cuts off no sliver."""
    a, b = bar(ellipse_wire(12, 7, 10, arcs[0]), -10), bar(round_wire(6, 30, arcs[1], 0.0), 10)
    found = join_faces(*two(a, b, tmp_path, (10, 30)), tmp_path / "out.step", continuity=continuity)
    root = open_parts(tmp_path / "out.step").root
    pieces = len(found.faces)
    assert_one_valid_solid(root, sum(arcs) + 2 + pieces)
    assert found.gate.largest_tolerance == found.read_back.largest_tolerance == 1e-7
    assert len(found.gate.border) == sum(arcs) + pieces
    assert max(edge.gap for edge in found.gate.border) < 1e-11
    assert all(normals_beside(root, n) < 2e-5 for n in found.faces)


@pytest.mark.long
@pytest.mark.parametrize("turn", first_ones(1, [0.003, -0.003]))
def test_a_seam_beside_a_vertex_cuts_off_a_short_edge(turn, tmp_path):
    a, b = bar(ellipse_wire(12, 7, 10, 4), -10), bar(round_wire(6, 30, 6, turn), 10)
    found = join_faces(*two(a, b, tmp_path, (10, 30)), tmp_path / "out.step")
    assert_one_valid_solid(open_parts(tmp_path / "out.step").root, 13)
    assert found.gate.largest_tolerance == 1e-7
    assert min(edge.length for edge in found.gate.border) == pytest.approx(6 * abs(turn), rel=0.02)


def test_rounds_are_joined_to_the_known_volume(tmp_path):
    """Two like bars on one axis: the blend is the bar between, whatever its speed."""
    found = join_faces(*two(cylinder(3, 5), cylinder(3, 5, at=(0, 0, 9)), tmp_path, (5, 9)), tmp_path / "out.step")
    assert volume(open_parts(tmp_path / "out.step").root) == pytest.approx(np.pi * 9 * 14, rel=1e-9)
    assert found.gate.volume_expected == pytest.approx(np.pi * 9 * 4, rel=5e-3)


@pytest.mark.long
def test_the_order_of_like_profiles_changes_nothing(tmp_path):
    specs = two(cylinder(3, 5), cylinder(2, 5, at=(0.5, 0, 9)), tmp_path, (5, 9))
    one, other = (join_faces(*x, tmp_path / "out.brep").gate for x in (specs, specs[::-1]))
    # The fairest shape is sought to some 1e-6 of its measure.
    assert other.volume[1] == pytest.approx(one.volume[1], rel=1e-5)


@pytest.mark.long
def test_two_faces_of_one_solid(tmp_path):
    """A handle: the solid keeps its one shell."""
    shape = fused(fused(box(30, 10, 5), box(5, 10, 40)), box(30, 10, 5, at=(0, 0, 35)))
    shape = fused(shape, fused(cylinder(3, 15, at=(20, 5, 0)), cylinder(2, 15, at=(20, 5, 25))))
    path = written(shape, tmp_path / "part.brep")
    found = join_faces(f"{path}#{end_at(shape, 15)}", f"{path}#{end_at(shape, 25)}", tmp_path / "out.brep")
    assert found.gate.solids == (1, 1)
    assert_one_valid_solid(open_parts(tmp_path / "out.brep").root, len(parts(shape, "FACE")) - 1)


@pytest.mark.long
def test_other_solids_of_a_file_stay(tmp_path):
    far = box(1, 1, 1, at=(50, 0, 20))
    shape = compound([far, oval(), tube(4), box(1, 1, 1, at=(60, 0, 20))])
    path = written(shape, tmp_path / "part.brep")
    found = join_faces(f"{path}#{end_at(shape, 0)}", f"{path}#{end_at(shape, 6)}", tmp_path / "out.brep")
    root = open_parts(tmp_path / "out.brep").root
    assert [len(parts(x, "FACE")) for x in parts(root, "SOLID")] == [6, 15, 6]
    assert min(found.touched) >= 6
    assert found.face == 6 + 14


@pytest.mark.slow
def test_order_place_turn_and_scale_change_nothing(tmp_path):
    a, b = oval(), tube(4)
    plain = join_faces(*two(a, b, tmp_path), tmp_path / "out.brep").gate
    added = plain.volume[1] - plain.volume[0]
    other = join_faces(*two(a, b, tmp_path)[::-1], tmp_path / "out.brep").gate
    # Both orders are tried, and the fairer one is taken: the same two, whichever was named first.
    assert other.volume[1] - other.volume[0] == pytest.approx(added, rel=1e-9)
    assert other.largest_tolerance == plain.largest_tolerance
    step = gp_Trsf()
    step.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 2)), 1.1)
    step.SetTranslationPart(gp_Vec(300, -20, 7))
    for scale in (None, 1e-3, 1e3):
        trsf = step
        if scale is not None:
            trsf = gp_Trsf()
            trsf.SetScale(gp_Pnt(0, 0, 0), scale)
        specs = [
            f"{written(moved(shape, trsf), tmp_path / name)}#{end_at(shape, z)}"
            for shape, name, z in ((a, "one.brep", 0), (b, "two.brep", 6))
        ]
        found = join_faces(*specs, tmp_path / "out.brep").gate
        change = (found.volume[1] - found.volume[0]) / (scale or 1) ** 3
        # The fairest shape is sought to some 1e-6 of its measure.
        assert change == pytest.approx(added, rel=1e-5)


@pytest.mark.slow
def test_what_is_asked_at_an_outline_is_met_there(tmp_path):
    """Whichever order is fairer: G3 at the oval, G1 at the tube."""
    specs = two(oval(), tube(4), tmp_path)
    for one, continuity in ((specs, ("G3", "G1")), (specs[::-1], ("G1", "G3"))):
        found = join_faces(*one, tmp_path / "out.step", continuity=continuity)
        turned = any("A is the outline of --to" in note for note in found.notes)
        assert found.blend.continuity == (continuity[::-1] if turned else continuity)
        chains = (found.blend.chain_a, found.blend.chain_b)
        of_oval = chains[(one is not specs) != turned]
        assert len(of_oval.faces) == 8
        assert found.blend.continuity[chains.index(of_oval)] == "G3"


@pytest.mark.slow
def test_files_in_different_units(tmp_path):
    a, b = oval(), tube(4)
    small = gp_Trsf()
    small.SetScale(gp_Pnt(0, 0, 0), 1 / 25.4)
    paths = [
        write_parts({"a": a}, tmp_path / "a.step"), write_parts({"b": moved(b, small)}, tmp_path / "b.step", "in")
    ]  # fmt: skip
    specs = [f"{paths[0]}#{end_at(a, 0)}", f"{paths[1]}#{end_at(b, 6)}"]
    found = join_faces(*specs, tmp_path / "out.step")
    plain = join_faces(*two(a, b, tmp_path), tmp_path / "plain.brep")
    assert open_parts(tmp_path / "out.step").unit == "mm"
    assert found.gate.volume[1] == pytest.approx(plain.gate.volume[1], rel=1e-6)
    other = join_faces(*specs[::-1], tmp_path / "other.step")
    assert open_parts(tmp_path / "other.step").unit == "in"
    assert other.gate.volume[1] * 25.4**3 == pytest.approx(plain.gate.volume[1], rel=1e-6)


def placed_at(*vector):
    trsf = gp_Trsf()
    trsf.SetTranslation(gp_Vec(*vector))
    return TopLoc_Location(trsf)


@pytest.mark.long
@pytest.mark.parametrize("way", first_ones(1, ["two files", "one file", "assembly"]))
def test_names_colours_and_layers_of_both_stay(way, tmp_path):
    a, b = oval(), tube(4)
    ends = end_at(a, 0), end_at(b, 6)
    if way == "two files":
        paths = [write_parts({name: shape}, tmp_path / f"{name}.step") for name, shape in (("a", a), ("b", b))]
        specs = [f"{path}#{n}" for path, n in zip(paths, ends, strict=True)]
    else:
        places = None if way == "one file" else [placed_at(0, 0, 7), placed_at(0, 0, 5)]
        path = write_parts({"a": a, "b": b}, tmp_path / "ab.step", places=places)
        specs = [f"{path}#{ends[0]}", f"{path}#{10 + ends[1]}"]
    found = join_faces(*specs, tmp_path / "out.step")
    _, said, layers = labels_of(tmp_path / "out.step")
    assert "'b'" in found.notes[0]
    assert ("a", 0.0) in said
    faces = {numbers[0]: (name, red) for numbers, name, red in (x for x in said if isinstance(x[0], list))}
    # Faces of a, without its end, then those of b; the blend has what was said of the end of a.
    kept_a = [k for k in range(10) if k != ends[0]]
    kept_b = [k for k in range(6) if k != ends[1]]
    expected = {n: (f"a {k}", round(0.05 * k, 3)) for n, k in enumerate(kept_a) if k < 9}
    expected |= {9 + n: (f"b {k}", round(0.05 * k, 3)) for n, k in enumerate(kept_b) if k < 5}
    expected[found.face] = (f"a {ends[0]}", round(0.05 * ends[0], 3))
    for n, words in expected.items():
        assert faces[n] == pytest.approx(words) if words[0] is None else faces[n][0] == words[0]
        assert faces[n][1] == pytest.approx(words[1], abs=2e-3)
    assert {"layer a", "layer b"} <= set(layers)
    assert len(parts(open_parts(tmp_path / "out.step").root, "SOLID")) == 1


def hollow():
    return cut(cylinder(3, 5), cylinder(1, 5))


def pocket():
    return cut(box(20, 20, 20), cylinder(3, 10, at=(10, 10, 10)))


@pytest.mark.parametrize(
    ("make", "at", "said"),
    [
        (hollow, 5, "found a face with 2 outlines, expected one"),
        (pocket, 10, "its edge e0 is an inner one, expected the end of a bar"),
        (lambda: rounded(cylinder(3, 5), 1.0, circles_at(5, 3)), 5, "it goes on smoothly into face"),
    ],
)
def test_faces_that_are_no_ends_are_refused(make, at, said, tmp_path):
    shape = make()
    specs = two(shape, tube(4, z=30), tmp_path, (at, 30))
    with pytest.raises(EdgeError, match=said):
        join_faces(*specs, tmp_path / "out.step")
    assert not (tmp_path / "out.step").exists()


@pytest.mark.long
def test_wrong_faces_are_refused(tmp_path):
    a, b = two(oval(), tube(4), tmp_path)
    with pytest.raises(EdgeError, match="expected another face"):
        join_faces(a, a, tmp_path / "out.step")
    with pytest.raises(EdgeError, match="found a cylinder, expected a planar face"):
        join_faces(a, f"{b.partition('#')[0]}#0", tmp_path / "out.step")
    with pytest.raises(FileError, match="expected a file and the number of its face"):
        join_faces(a, b.partition("#")[0], tmp_path / "out.step")
    with pytest.raises(FileError, match="no such surface"):
        join_faces(a, f"{b}9", tmp_path / "out.step")
    with pytest.raises(FileError, match="is the input"):
        join_faces(a, b, b.partition("#")[0])
    loose = written(compound(parts(tube(4), "FACE")), tmp_path / "loose.brep")
    with pytest.raises(EdgeError, match="belongs to no solid"):
        join_faces(a, f"{loose}#{end_at(tube(4), 6)}", tmp_path / "out.step")


@pytest.mark.long
def test_faces_that_look_the_same_way_are_refused(tmp_path):
    shape = fused(fused(box(30, 10, 5), box(6, 10, 20)), box(6, 10, 20, at=(24, 0, 0)))
    path = written(shape, tmp_path / "part.brep")
    points = graph_of(shape).uses
    high = [n for n in range(len(parts(shape, "FACE"))) if points.points[points.of_face(n), :, 2].min() > 19]
    with pytest.raises(EdgeError, match="do not look towards each other"):
        join_faces(f"{path}#{high[0]}", f"{path}#{high[1]}", tmp_path / "out.step")


@pytest.mark.long
def test_a_part_that_stands_twice_is_refused(tmp_path):
    from helpers.xcaf import write_assembly

    path = write_assembly(oval(), tmp_path / "twice.step", [TopLoc_Location(), placed_at(20, 0, 0)])
    specs = two(oval(), tube(4), tmp_path)
    with pytest.raises(EdgeError, match="stands 2 times in the file"):
        join_faces(f"{path}#{end_at(oval(), 0)}", specs[1], tmp_path / "out.step")


def moved_rows(rows, columns, by):
    """What a blend is made wrong with: some of its control points are moved."""

    def wrong(result, split):
        (surface,) = (x.to_bspline() for x in solid_joins_faces(result, split))
        points = surface.control_points.copy()
        points[rows, columns] += by
        return (replace(surface, control_points=points),)

    return wrong


solid_joins_faces = solid_joins.faces_of_blend


@pytest.mark.long
@pytest.mark.parametrize(
    ("rows", "columns", "by", "said"),
    first_rows(
        1,
        [
            # A contact row off the wall; the seam torn; a bulge on one side; a spike that crosses the bar.
            (slice(0, 1), slice(5, 9), [0, 0, 0.1], "tolerance|off face"),
            (slice(2, 4), slice(0, 1), [0.3, 0, 0], "tolerance|check fails"),
            (slice(2, 4), slice(4, 30), [40, 40, 0], "the volume changes|folds"),
            (slice(2, 4), slice(10, 13), [0, 0, -30], "cross|folds|check fails|volume"),
        ],
    ),
)
def test_wrong_blends_are_stopped(rows, columns, by, said, tmp_path, monkeypatch):
    out = tmp_path / "out.step"
    out.write_text("what was there")
    specs = two(oval(), tube(6), tmp_path)
    monkeypatch.setattr(solid_joins, "faces_of_blend", moved_rows(rows, columns, by))
    with pytest.raises(SolidError, match=said):
        join_faces(*specs, out)
    assert out.read_text() == "what was there"


@pytest.mark.long
def test_inputs_are_not_changed(tmp_path):
    specs = two(oval(), tube(6), tmp_path)
    before = [(tmp_path / name).read_bytes() for name in ("a.brep", "b.brep")]
    join_faces(*specs, tmp_path / "out.brep")
    assert before == [(tmp_path / name).read_bytes() for name in ("a.brep", "b.brep")]
    with pytest.raises(FileError):
        join_faces(*specs, tmp_path / "out.3dm")


@pytest.mark.long
def test_who_needs_too_long_is_ended_and_leaves_nothing(tmp_path, monkeypatch):
    """Thirteen faces take the gate some seconds."""
    specs, out = two(oval(), tube(5), tmp_path), tmp_path / "out.step"
    out.write_text("what was there")
    before, usual = sorted(tmp_path.iterdir()), foreign.call

    def limited(module, arguments, seconds, megabytes):
        if not module.endswith("occ_solid_worker"):
            return usual(module, arguments, seconds, megabytes)
        return workers.call(module, arguments, 1.0, megabytes)

    monkeypatch.setattr(foreign, "call", limited)
    with pytest.raises(FileError, match="of processor time"):
        join_faces(*specs, out, split="joints")
    assert out.read_text() == "what was there"
    assert sorted(tmp_path.iterdir()) == before


def test_a_tube_round_a_bend_has_a_middle_line_as_long_as_it_should():
    """A quarter of a ring, whose middle line is a quarter circle of radius 10: the cubic is 0.6 % shorter."""
    t = np.linspace(0, 2 * np.pi, 400)
    low = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    side = np.stack([10 + 0 * t, np.cos(t), 10 + np.sin(t)], axis=1)
    found, _ = tube_volume((low, np.array([0, 0, 1.0])), (side[::-1], np.array([-1.0, 0, 0])))
    assert found == pytest.approx(np.pi * 5 * np.pi, rel=0.05)


def run(*words):
    return CliRunner().invoke(app, ["blend", *map(str, words)])


@pytest.mark.long
def test_the_command_joins_two_files(tmp_path):
    a, b = two(oval(), tube(4), tmp_path)
    out, report = tmp_path / "out.step", tmp_path / "report.json"
    done = run("--from", a, "--to", b.replace("#", ":"), "-o", out, "--report", report)
    assert done.exit_code == 0, done.output
    assert "one sound solid of 15 faces: 14 is the blend" in done.output
    assert "(8 edges) joined to that of" in done.output
    record = json.loads(report.read_text())
    assert record["solid"]["solids"] == [2, 1]
    assert len(record["chain_a"]["faces"]) == 8


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--from", "a.brep#1"], "--to: missing"),
        (["--to", "a.brep#1"], "--from: missing"),
        (["--from", "a.brep", "--to", "a.brep#1"], "--from: found 'a.brep', expected a file and its face"),
        (["--from", "a.brep#1", "--to", "a.brep#2", "--replace", "3"], "--from and --to: found together with"),
        (["a.brep", "--from", "a.brep#1", "--to", "a.brep#2"], "--from and --to: found together with"),
        (["--from", "a.json#1", "--to", "a.brep#2"], "no solid can come back"),
        ([], "A missing"),
    ],
)
def test_wrong_calls(words, said, tmp_path):
    done = run(*words, "-o", tmp_path / "out.step")
    assert done.exit_code == 2
    assert said in done.output
