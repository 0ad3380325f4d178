"""blend --replace and --cut: the commands that `list --pairs` prints run as printed, and what does not go together."""

import shlex

import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from typer.testing import CliRunner

from helpers.parts import fillet, rounded_box, without, written
from semispline import list_surfaces, read_surface
from semispline.solver.cli import app
from semispline.solver.io import read_occ

pytestmark = pytest.mark.usefixtures("reads_here")


def run(*words):
    return CliRunner().invoke(app, list(words))


def rounded_pin():
    return fillet(BRepPrimAPI_MakeCylinder(5.0, 8.0).Shape(), 1.5, lambda point, _: point[2] > 7.9)


PARTS = {
    "a fillet, a gap, a chain, sharp edges": (lambda: without(rounded_box(), 2), "it's a part.brep"),
    "closed rims": (rounded_pin, "pin.brep"),
    "sharp edges": (lambda: BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape(), "-box.brep"),
}


@pytest.mark.long
@pytest.mark.parametrize("part", PARTS)
def test_printed_commands_run_as_printed(part, tmp_path, monkeypatch):
    make, name = PARTS[part]
    monkeypatch.chdir(tmp_path)
    written(make(), tmp_path / name)
    listed = run("list", f"./{name}", "--pairs")
    assert listed.exit_code == 0, listed.output
    assert "to come" not in listed.output
    heading, commands = "", {}
    for line in listed.output.splitlines():
        if not line.startswith(" ") and ": " in line:
            heading = line.partition(":")[0]
        elif line.startswith("    semispline "):
            # One of each kind.
            commands.setdefault(heading, line.strip())
    assert commands
    for kind, command in commands.items():
        words = shlex.split(command)
        done = run(*words[1:])
        assert done.exit_code == 0, (command, done.output)
        # What falls to G1 at edges that are kept is warned of.
        warnings = [line for line in done.output.splitlines() if "warning" in line]
        assert all("--keep-ends" in words and "is kept" in line for line in warnings), (command, done.output)
        if {"--replace", "--round"} & {*words} and "--surfaces" not in words and words[2].endswith(("step", "brep")):
            assert len(list_surfaces(words[-1])) > 1  # the whole solid
        else:
            # Of a chain a face for each of seven lines and arcs: what lies between is only G1.
            assert len(list_surfaces(words[-1])) == (7 if kind == "chains of fillets" else 1)


@pytest.mark.long
def test_bases_are_written_beside_the_blend(tmp_path):
    path, out = written(rounded_box(), tmp_path / "part.brep"), tmp_path / "out.step"
    faces = read_occ(path).faces
    face = next(k for k, item in enumerate(faces) if item.kind == "cylinder")
    done = run("blend", str(path), "--replace", str(face), "--with-bases", "-o", str(out))
    assert done.exit_code == 0, done.output
    assert done.output.startswith(f"face #{face} replaced from e")
    degrees = [(entry.degree_u, entry.degree_v) for entry in list_surfaces(out)]
    assert degrees[1:] == [(1, 1), (1, 1)]
    blend, first, second = (read_surface(f"{out}#{k}") for k in range(3))
    # The blend begins on the edge of the one, and ends on that of the other.
    corners = [tuple(x) for base in (first, second) for x in base.control_points.reshape(-1, 3).round(9).tolist()]
    for row in (blend.control_points[0], blend.control_points[-1]):
        assert {tuple(x) for x in row[[0, -1]].round(9).tolist()} <= set(corners)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--replace", "0", "--cut-a", "1"], "--replace: found it together with --cut-a or --cut-b"),
        (["part.brep", "--replace", "0"], "--replace: found a second file 'part.brep'"),
        (["--replace", "0", "--edge-a", "u0", "--edge-b", "e1"], "found 'u0', expected an edge of face 0, as e1"),
        (["--replace", "0", "--edge-a", "e1"], "found one of them, expected none or two edges of face 0"),
        (["--replace", "0", "--surfaces", "--with-bases"], "--surfaces: found it together with --with-bases"),
        (["--replace", "99"], "#99: no such surface; the file holds 18"),
        ([], "blend: B, --edge-a, --edge-b missing, expected A B --edge-a EDGE --edge-b EDGE, FILE --replace FACE"),
        (["part.brep#1", "--cut-a", "-1"], "--cut-a: found '-1', expected a distance above 0"),
        (["part.brep#1", "--cut-a", "1", "--edge-a", "x3"], "--edge-a: found 'x3'"),
        (["part.brep#1", "--cut-a", "1"], "only two faces of one file"),
    ],
)  # fmt: skip
def test_what_does_not_go_together(words, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written(rounded_box(), tmp_path / "part.brep")
    done = run("blend", "part.brep", *words, "-o", "out.step")
    assert done.exit_code == 2
    assert said in done.output.replace("\n", " ")
    assert not (tmp_path / "out.step").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--edge-a", "near=1,2,3", "--edge-b", "e1"], "--edge-a: found 'near=1,2,3' together with --replace"),
        (["--edge-a", "e1", "--edge-b", "near=1,2,3"], "--edge-b: found 'near=1,2,3' together with --replace"),
        (["--edge-a", "u0", "--edge-b", "e1"], "--edge-a: found 'u0', expected an edge of face 0"),
        (["--edge-b", "e1"], "--edge-a and --edge-b: found one of them"),
    ],
)
def test_edges_of_a_replaced_face_are_checked_before_a_file_is_read(words, said, tmp_path):
    done = run("blend", str(tmp_path / "none.step"), "--replace", "0", *words, "-o", str(tmp_path / "out.step"))
    assert done.exit_code == 2
    assert said in done.output.replace("\n", " ")


def test_a_numbered_file_is_refused_by_replace(tmp_path):
    path = written(rounded_box(), tmp_path / "part.brep")
    done = run("blend", f"{path}#3", "--replace", "0", "-o", str(tmp_path / "out.step"))
    assert done.exit_code == 2
    assert f"expected the file alone, '{path}'" in done.output.replace("\n", "")


def test_three_surfaces_do_not_go_into_one_json(tmp_path):
    path = written(rounded_box(), tmp_path / "part.brep")
    done = run("blend", str(path), "--replace", "2", "--with-bases", "-o", str(tmp_path / "out.json"))
    assert done.exit_code == 2
    assert ".json holds one surface" in done.output
