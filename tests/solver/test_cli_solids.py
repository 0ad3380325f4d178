"""The commands that give a solid back: a sharp edge from list to solid, cuts, pictures, reports, colours, refusals."""

import json
import shlex

import numpy as np
import pytest
import rhino3dm
from typer.testing import CliRunner

from helpers.parts import rounded_box, written
from helpers.solids import box, box_with_four
from helpers.xcaf import labels_of, write_coloured
from semispline.solver.cli import app
from semispline.solver.topology.occ_parts import open_parts
from semispline.solver.topology.occ_shapes import parts

pytestmark = pytest.mark.usefixtures("read_here")


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


def commands_of(path):
    done = run("list", path, "--pairs")
    assert done.exit_code == 0
    return [shlex.split(line)[1:] for line in done.output.splitlines() if line.startswith("    semispline")]


def test_a_newcomer_rounds_an_edge_in_two_commands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_coloured(box(20, 30, 40), "box.step")
    found = commands_of("box.step")
    assert found[0] == ["blend", "box.step", "--round", "0:e0", "--distance", "6.6", "-o", "round-0e0.step"]
    done = run(*found[0])
    assert done.exit_code == 0, done.output
    assert "one sound solid of 7 faces: 6 is the blend" in done.output
    back = open_parts("round-0e0.step").root
    assert (len(parts(back, "SOLID")), len(parts(back, "FACE"))) == (1, 7)


@pytest.mark.long
def test_cuts_of_a_shared_edge_give_the_solid(tmp_path):
    path, out = written(box(20, 30, 40), tmp_path / "box.brep"), tmp_path / "out.step"
    words = ["blend", f"{path}#0", f"{path}#2", "--cut-a", "3", "--cut-b", "6"]
    done = run(*words, "-o", out)
    assert done.exit_code == 0, done.output
    assert "rounded, cuts 3 and 6" in done.output
    # The edge may be named, too.
    named = run(*words, "--edge-a", "e0", "--edge-b", "e3", "-o", tmp_path / "named.step")
    assert named.output.splitlines()[:3] == done.output.splitlines()[:3]
    alone = run(*words, "--surfaces", "-o", tmp_path / "alone.step")
    assert alone.exit_code == 0, alone.output
    assert "solid" not in alone.output
    assert len(parts(open_parts(tmp_path / "alone.step").root, "FACE")) == 1


@pytest.mark.long
def test_where_no_solid_can_be_written_it_is_said(tmp_path):
    path = written(box(20, 30, 40), tmp_path / "box.brep")
    done = run("blend", f"{path}#0", f"{path}#2", "--cut-a", "3", "--cut-b", "6", "-o", tmp_path / "out.3dm")
    assert done.exit_code == 0, done.output
    assert "no solid can come back in .3dm" in done.output


def test_cuts_of_edges_that_are_not_the_same_give_a_surface(tmp_path):
    path, out = written(box(20, 30, 40), tmp_path / "box.brep"), tmp_path / "out.step"
    words = ["blend", f"{path}#0", f"{path}#1", "--edge-a", "e0", "--edge-b", "e0", "--cut-a", "3", "--cut-b", "3"]
    done = run(*words, "-o", out)
    assert done.exit_code == 0, done.output
    assert "solid" not in done.output


@pytest.mark.long
def test_a_report_and_a_picture(tmp_path):
    pytest.importorskip("pyvista")
    path, report = written(box(20, 30, 40), tmp_path / "box.brep"), tmp_path / "report.json"
    words = ["--report", report, "--plots", tmp_path / "plots", "-o", tmp_path / "out.step"]
    done = run("blend", path, "--round", "0:e0", "--distance", "4", *words)
    assert done.exit_code == 0, done.output
    record = json.loads(report.read_text())
    assert record["new_faces"] == [6]
    assert sorted(record["touched"]) == [0, 2, 4, 5]
    assert record["solid"]["volume"][0] == pytest.approx(24000)
    contacts = record["contacts_in_solid"]
    assert sorted(x["face"] for x in contacts) == [0, 2]
    assert all(x["gap"] <= x["allowed"]["gap"] for x in contacts)
    from PIL import Image

    picture = Image.open(tmp_path / "plots" / "solid.png").convert("RGB").resize((160, 120))
    red = sum(r > 2 * g and r > 60 for r, g, _ in np.asarray(picture, dtype=int).reshape(-1, 3).tolist())
    # The new face is to be seen, and is not all there is.
    assert 100 < red < 160 * 120 / 2


def test_a_picture_is_refused_without_a_solid(tmp_path):
    path = written(box(20, 30, 40), tmp_path / "box.brep")
    words = ["--cut-a", "3", "--cut-b", "3", "--surfaces", "--plots", tmp_path / "plots", "-o", tmp_path / "out.step"]
    done = run("blend", f"{path}#0", f"{path}#2", *words)
    assert done.exit_code == 2
    assert "--plots: found it without a solid" in done.output
    assert not (tmp_path / "plots").exists()


@pytest.mark.long
def test_a_new_face_has_the_colour_of_the_one_beside_it(tmp_path):
    path = write_coloured(box(20, 30, 40), tmp_path / "box.step")
    before = labels_of(path)
    done = run("blend", path, "--round", "2:e0", "--distance", "4", "-o", tmp_path / "out.step")
    assert done.exit_code == 0, done.output
    unit, found, layers = labels_of(tmp_path / "out.step")
    assert (unit, layers) == (before[0], before[2])
    old = {name: (place, red) for place, name, red in before[1][1:]}
    assert {name: (place, red) for place, name, red in found[1:] if name in old} == old
    (new,) = (x for x in found[1:] if x[0] == [6])
    assert new[2] == old["face 2"][1]


@pytest.mark.long
def test_all_edges_of_a_face_that_do_not_meet(tmp_path):
    """One after the other; the numbers of faces stay."""
    path = written(box(20, 30, 40), tmp_path / "0.brep")
    volume = 24000.0
    for k, edge in enumerate(("e0", "e2")):
        done = run("blend", path, "--round", f"0:{edge}", "--distance", "5", "-o", tmp_path / f"{k + 1}.brep")
        assert done.exit_code == 0, done.output
        path = tmp_path / f"{k + 1}.brep"
    assert len(parts(open_parts(path).root, "FACE")) == 8
    assert volume > 0


def test_pairs_name_a_chain_by_any_of_its_edges_and_what_cannot_be_a_solid_as_surfaces(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written(box_with_four(4.0), "part.brep")
    rounds = [words for words in commands_of("part.brep") if "--round" in words]
    assert rounds
    # A third of the radius of the corners: no edge of a chain may move further than all of them.
    assert all(float(words[words.index("--distance") + 1]) == 1.3 for words in rounds)
    written(rounded_box(), "rounded.brep")
    for words in commands_of("rounded.brep"):
        if "--cut-a" in words:
            assert "--surfaces" in words


def box_in_3dm(path):
    """A box on a layer of its own, behind a sphere on another."""
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Inches
    for name in ("other", "body"):
        layer = rhino3dm.Layer()
        layer.Name = name
        file.Layers.Add(layer)
    shapes = (
        rhino3dm.Sphere(rhino3dm.Point3d(50, 0, 0), 2.0).ToBrep(),
        rhino3dm.Brep.CreateFromBox(rhino3dm.Box(rhino3dm.BoundingBox(0, 0, 0, 20, 30, 40))),
    )
    for k, shape in enumerate(shapes):
        attributes = rhino3dm.ObjectAttributes()
        attributes.LayerIndex = k
        file.Objects.AddBrep(shape, attributes)
    file.Write(str(path), 0)


@pytest.mark.long
def test_a_3dm_file_comes_back_with_the_blend_and_its_bases_on_the_layer_of_a(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    box_in_3dm("part.3dm")
    words = next(words for words in commands_of("part.3dm") if "--cut-a" in words)
    done = run(*words[:-1], "out.3dm")
    assert done.exit_code == 0, done.output
    assert "no solid can come back from .3dm: the blend and its bases are added to the file" in done.output
    before, after = (rhino3dm.File3dm.Read(name) for name in ("part.3dm", "out.3dm"))
    assert after.Settings.ModelUnitSystem == before.Settings.ModelUnitSystem
    assert [x.Name for x in after.Layers] == [x.Name for x in before.Layers]
    ids = [[str(item.Attributes.Id) for item in file.Objects] for file in (before, after)]
    assert set(ids[0]) <= set(ids[1])
    assert len(ids[1]) == len(ids[0]) + 3
    new = [item for item in after.Objects if str(item.Attributes.Id) not in ids[0]]
    assert [after.Layers[item.Attributes.LayerIndex].Name for item in new] == ["body"] * 3
    # The input is as it was, and the blend alone is written as before.
    alone = run(*words[:-2], "--surfaces", "-o", "alone.3dm")
    assert alone.exit_code == 0, alone.output
    assert len(rhino3dm.File3dm.Read("alone.3dm").Objects) == 1
