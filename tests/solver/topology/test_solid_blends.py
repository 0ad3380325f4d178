"""Fillets of solids replaced: from file to file, all else as it was; or refused, and nothing is written."""

import json
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from typer.testing import CliRunner

from helpers.parts import compound, graph_of, moved, rounded_box, written
from helpers.solids import MODELS, box, box_with_fillet, pipe, slanted, volume
from helpers.sweeps import first_ones
from helpers.xcaf import labels_of, write_assembly, write_coloured
from semispline import ComputationError, EdgeError, FileError, SolidError, read_surface, replace_face, round_edge
from semispline.solver import workers
from semispline.solver.cli import app
from semispline.solver.io import foreign
from semispline.solver.topology import solid_blends
from semispline.solver.topology.end_faces import blend_onto
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import parameters_of, parts, points_of, range_of, surface_at, tolerance_of
from semispline.solver.topology.relations import relate

pytestmark = pytest.mark.usefixtures("read_here")


def fillets_of(shape):
    graph = graph_of(shape)
    return list(find_fillets(graph, relate(graph)).accepted)


def fillet_of(shape):
    (number,) = fillets_of(shape)
    return number


@pytest.mark.parametrize("name", first_ones(1, MODELS))
def test_fillets_of_models_are_replaced(name, tmp_path):
    shape = MODELS[name]()
    path, out = written(shape, tmp_path / "part.brep"), tmp_path / "out.step"
    numbers = fillets_of(shape)
    assert numbers
    found = replace_face(path, numbers[0], out)
    back = open_parts(out).root
    assert BRepCheck_Analyzer(back, True).IsValid()
    assert len(parts(back, "SOLID")) == 1
    assert len(parts(back, "FACE")) == len(parts(shape, "FACE"))
    # The blend lies outside of a round that takes away, and inside of one that adds: by at most what a sharp edge has.
    grown = volume(back) - volume(shape)
    assert 0 < abs(grown) < 0.5 * found.gate.volume_limit
    assert (grown < 0) == any(word in name for word in ("inner", "rib", "boss"))
    assert found.gate.largest_tolerance <= (1e-6 * 60 if "round end" in name else 1.1e-7)


@pytest.mark.long
def test_a_second_replacement_changes_nothing(tmp_path):
    path = written(box_with_fillet(5.0), tmp_path / "part.brep")
    number = fillet_of(box_with_fillet(5.0))
    first = replace_face(path, number, tmp_path / "one.step")
    second = replace_face(tmp_path / "one.step", number, tmp_path / "two.step")
    # The search for the fairest shape begins from the same bases.
    assert second.gate.volume[1] == pytest.approx(first.gate.volume[1], rel=1e-12)


@pytest.mark.long
def test_place_turn_scale_and_format_change_nothing(tmp_path):
    shape = box_with_fillet(5.0)
    number = fillet_of(shape)
    plain = replace_face(written(shape, tmp_path / "part.brep"), number, tmp_path / "plain.brep").gate
    step = gp_Trsf()
    step.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 2)), 1.1)
    step.SetTranslationPart(gp_Vec(300, -20, 7))
    large = gp_Trsf()
    large.SetScale(gp_Pnt(0, 0, 0), 1000.0)
    for trsf, scale in ((step, 1.0), (large, 1000.0)):
        found = replace_face(written(moved(shape, trsf), tmp_path / "moved.brep"), number, tmp_path / "out.step").gate
        change = (found.volume[1] - found.volume[0]) / scale**3
        # The fairest shape is sought to some 1e-6 of its measure.
        assert change == pytest.approx(plain.volume[1] - plain.volume[0], rel=1e-5)


@pytest.mark.long
def test_edges_named_either_way_give_the_same_solid(tmp_path):
    shape = box_with_fillet(5.0)
    path, number = written(shape, tmp_path / "part.brep"), fillet_of(shape)
    first = replace_face(path, number, tmp_path / "a.step")
    names = [edge.strip() for edge in first.said.split("replaced from ")[1].split(":")[0].split(" to ")]
    other = replace_face(path, number, tmp_path / "b.step", edge_a=names[1], edge_b=names[0])
    assert other.gate.volume[1] == pytest.approx(first.gate.volume[1], rel=1e-9)


@pytest.mark.parametrize("name", first_ones(1, ["boss r=2.0", "pipe r=1.0", "pipe r=2.5"]))
def test_circles_on_planes_are_met_exactly_and_with_few_points(name, tmp_path):
    """Both contacts are arcs of like parameters: the blend is the surface of revolution of one section."""
    shape = (MODELS | {"pipe r=1.0": lambda: pipe(1.0), "pipe r=2.5": lambda: pipe(2.5)})[name]()
    found = replace_face(written(shape, tmp_path / "part.brep"), fillet_of(shape), tmp_path / "out.step")
    assert found.gate.tolerance == (1e-7, 1e-7)
    assert max(edge.gap for edge in found.gate.border) <= 1e-12
    assert found.blend.rows_converted == 6 * 7
    surface = read_surface(f"{tmp_path / 'out.step'}#{found.face}")
    axis = [20.0, 20.0] if name.startswith("boss") else [0.0, 0.0]
    points = surface.evaluate_grid(np.linspace(0, 1, 5), np.linspace(*surface.domain[1], 33))
    away = np.linalg.norm(points[..., :2] - axis, axis=-1)
    assert np.ptp(away, axis=1).max() <= 1e-12
    assert np.ptp(points[..., 2], axis=1).max() <= 1e-12


@pytest.mark.parametrize("unit", first_ones(1, ["mm", "in"]))
def test_units_names_colours_and_layers_stay(unit, tmp_path):
    shape = box_with_fillet(5.0)
    path = write_coloured(shape, tmp_path / "part.step", unit)
    before = labels_of(path)
    assert before[0] == unit
    assert len(before[1]) == 1 + 7
    replace_face(path, fillet_of(shape), tmp_path / "out.step")
    assert labels_of(tmp_path / "out.step") == before


@pytest.mark.long
def test_a_part_of_an_assembly_is_changed_wherever_it_stands(tmp_path):
    shape = box_with_fillet(5.0)
    there = gp_Trsf()
    there.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)), 0.7)
    there.SetTranslationPart(gp_Vec(100, 0, 0))
    path = write_assembly(shape, tmp_path / "part.step", [TopLoc_Location(), TopLoc_Location(there)])
    number = fillet_of(shape)
    # That of the second place.
    found = replace_face(path, 7 + number, tmp_path / "out.step")
    assert found.notes == ("the part stands 2 times in the file, and is changed wherever it stands",)
    back = open_parts(tmp_path / "out.step").root
    alone = replace_face(written(shape, tmp_path / "part.brep"), number, tmp_path / "alone.brep")
    assert volume(back) == pytest.approx(2 * alone.gate.volume[1], rel=1e-6)
    # All numbers and places are those of the place that was named.
    assert found.faces == (7 + number,)
    assert found.touched == tuple(7 + n for n in alone.touched)
    assert [edge.name for edge in found.gate.border] == [
        "{}:{}".format(7 + int(name.partition(":")[0]), name.partition(":")[2])
        for name in (edge.name for edge in alone.gate.border)
    ]
    for edge, own in zip(found.gate.border, alone.gate.border, strict=True):
        assert edge.beyond == 7 + own.beyond
        point = gp_Pnt(*own.at).Transformed(there)
        # Where rounding is largest is no place that could be told from others: both lie in the same edge.
        assert np.linalg.norm(np.array(edge.at) - point.Coord()) <= own.length


@pytest.mark.long
def test_a_rounded_part_before_the_one_that_was_named_grows_too(tmp_path):
    there = gp_Trsf()
    there.SetTranslation(gp_Vec(100, 0, 0))
    path = write_assembly(box(20, 30, 40), tmp_path / "part.step", [TopLoc_Location(), TopLoc_Location(there)])
    found = round_edge(path, 6, "e0", 2.0, tmp_path / "out.step")
    # Seven faces of the first, six old ones of the second.
    assert found.faces == (13,)
    assert 7 in found.touched
    graph = graph_of(open_parts(tmp_path / "out.step").root)
    assert all((graph.uses.points[graph.uses.of_face(n)][..., 0] > 99).all() for n in (*found.touched, *found.faces))


@pytest.mark.long
def test_a_shell_stays_as_open_as_it_was(tmp_path):
    shape = box_with_fillet(5.0)
    number = fillet_of(shape)
    faces = parts(shape, "FACE")
    far = next(n for n, face in enumerate(faces) if not touches(face, faces[number]))
    path = written(compound(face for n, face in enumerate(faces) if n != far), tmp_path / "part.brep")
    found = replace_face(path, number - (far < number), tmp_path / "out.brep")
    # They are named, as the written file has them.
    graph = graph_of(open_parts(tmp_path / "out.brep").root)
    lonely = [f"{graph.uses.face[k]}:{graph.uses.name(k)}" for k in np.flatnonzero(graph.uses.naked)]
    assert sorted(found.gate.open_edges) == sorted(lonely)
    assert len(lonely) == 4
    assert f"{lonely[0]}, {lonely[1]}, {lonely[2]}, {lonely[3]} belong to one face alone" in found.notes[0]


def touches(face, other):
    return any(a.IsSame(b) for a in parts(face, "VERTEX") for b in parts(other, "VERTEX"))


def test_what_goes_on_is_refused_with_its_neighbours(tmp_path):
    shape = rounded_box()
    path = written(shape, tmp_path / "part.brep")
    with pytest.raises(EdgeError, match=r"it goes on into faces? \d+.* over e\d"):
        replace_face(path, fillets_of(shape)[0], tmp_path / "out.step")
    assert not (tmp_path / "out.step").exists()


@pytest.mark.long
def test_a_middle_row_ends_on_a_slanted_end_too(tmp_path):
    shape = slanted(4.0, [0.5, 0.0, 1.0])
    path = written(shape, tmp_path / "part.brep")
    found = replace_face(path, fillet_of(shape), tmp_path / "out.step", middle_curves=1)
    assert found.gate.largest_tolerance <= 1.1e-7


@pytest.mark.long
def test_what_the_gate_stops_is_not_written(tmp_path, monkeypatch):
    shape = box_with_fillet(5.0)
    path, out = written(shape, tmp_path / "part.brep"), tmp_path / "out.step"
    out.write_text("what was there")

    def off_its_end(*arguments):
        result, surface = blend_onto(*arguments)
        points = surface.control_points.copy()
        points[2:4, 0, 2] += 0.01
        return result, replace(surface, control_points=points)

    monkeypatch.setattr(solid_blends, "blend_onto", off_its_end)
    with pytest.raises(SolidError, match=r"not sound: .* off face \d.* near \(.*nothing was written"):
        replace_face(path, fillet_of(shape), out)
    assert out.read_text() == "what was there"


def test_the_wrong_pair_of_a_fillet_is_refused(tmp_path):
    """Blended from end to end the kernel calls the solid valid, with a tolerance of 20."""
    shape = box_with_fillet(5.0)
    path = written(shape, tmp_path / "part.brep")
    with pytest.raises(EdgeError, match="it goes on into faces"):
        replace_face(path, fillet_of(shape), tmp_path / "out.step", edge_a="e0", edge_b="e2")


def test_files_without_solids_are_refused(tmp_path):
    path = written(box_with_fillet(5.0), tmp_path / "part.brep")
    with pytest.raises(FileError, match="no solid goes into it"):
        replace_face(path, 2, tmp_path / "out.json")
    with pytest.raises(FileError, match="no solid comes from it"):
        replace_face(tmp_path / "part.3dm", 2, tmp_path / "out.step")
    with pytest.raises(FileError, match="is the input"):
        replace_face(path, 2, path)


@pytest.mark.long
def test_the_command_gives_the_solid_back(tmp_path):
    shape = box_with_fillet(5.0)
    path, out, report = written(shape, tmp_path / "part.brep"), tmp_path / "out.step", tmp_path / "report.json"
    number = fillet_of(shape)
    done = CliRunner().invoke(
        app, ["blend", str(path), "--replace", str(number), "-o", str(out), "--report", str(report)]
    )
    assert done.exit_code == 0, done.output
    assert f"one sound solid of 7 faces: {number} is the blend" in done.output
    record = json.loads(report.read_text())
    assert record["new_face"] == number
    assert record["solid"]["faces"] == [7, 7]
    assert record["read_back"]["volume"][1] == pytest.approx(record["solid"]["volume"][1], rel=1e-12)
    blend = read_surface(f"{out}#{number}")
    points = blend.control_points.reshape(-1, 3)
    assert np.ptp(points[:, 2]) == pytest.approx(40)


def test_other_formats_get_the_surface_and_are_told_so(tmp_path):
    shape = box_with_fillet(5.0)
    path = written(shape, tmp_path / "part.brep")
    words = ["blend", str(path), "--replace", str(fillet_of(shape)), "-o", str(tmp_path / "out.3dm")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    assert "no solid can come back in .3dm" in done.output


@pytest.mark.long
def test_who_is_killed_by_the_limits_leaves_nothing(tmp_path, monkeypatch):
    """The process that operates gets too little memory."""
    shape = box_with_fillet(5.0)
    path, number, out = written(shape, tmp_path / "part.brep"), fillet_of(shape), tmp_path / "out.step"
    before, usual = (path.read_bytes(), sorted(tmp_path.iterdir())), foreign.call

    def limited(module, arguments, *limits):
        if not module.endswith("occ_solid_worker"):
            return usual(module, arguments, *limits)
        return workers.call(module, arguments, 100.0, 60.0)

    monkeypatch.setattr(foreign, "call", limited)
    # Where so little is left that a library cannot be loaded, the process ends without a word.
    with pytest.raises((FileError, ComputationError), match=r"of memory|broke down|ended without a result"):
        replace_face(path, number, out)
    assert (path.read_bytes(), sorted(tmp_path.iterdir())) == before


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_scale_changes_nothing(scale, tmp_path):
    shape, small = box_with_fillet(5.0), gp_Trsf()
    small.SetScale(gp_Pnt(0, 0, 0), scale)
    number = fillet_of(shape)
    plain = replace_face(written(shape, tmp_path / "part.brep"), number, tmp_path / "plain.brep").gate
    found = replace_face(written(moved(shape, small), tmp_path / "moved.brep"), number, tmp_path / "out.brep").gate
    # The fairest shape is sought to some 1e-6 of its measure.
    change = (found.volume[1] - found.volume[0]) / scale**3
    assert change == pytest.approx(plain.volume[1] - plain.volume[0], rel=1e-5)


def test_faces_that_are_not_touched_are_the_same(tmp_path):
    """Their surfaces and their edges, to the last bit, as a BREP file has them."""
    shape = box_with_fillet(5.0)
    path, number = written(shape, tmp_path / "part.brep"), fillet_of(shape)
    found = replace_face(path, number, tmp_path / "out.brep")
    old, new = (parts(open_parts(x).root, "FACE") for x in (path, tmp_path / "out.brep"))
    rest = set(range(7)) - {number, *found.touched}
    assert rest
    for n in rest:
        assert all(np.array_equal(a, b) for a, b in zip(all_of(old[n]), all_of(new[n]), strict=True))
    # Those with new borders keep their surfaces.
    for n in found.touched:
        u = np.array([[0.1, 0.2], [3.0, 4.0]])
        assert np.array_equal(surface_at(old[n], u), surface_at(new[n], u))


def all_of(face):
    """Of each edge of a face its range and tolerance, points in space, in the parameters and on the surface."""
    for edge in parts(face, "EDGE"):
        t = np.linspace(*range_of(edge), 9)
        uv = parameters_of(edge, face, t)
        yield from (t, tolerance_of(edge), points_of(edge, t), uv, surface_at(face, uv))
