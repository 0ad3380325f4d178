"""Files of other programs: limits of their readers, what is said of each end, and what a file holds but surfaces."""

import json
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import rhino3dm
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeVertex, BRepBuilderAPI_MakeWire
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Pnt
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from OCP.TopoDS import TopoDS_Compound
from typer.testing import CliRunner

from helpers.cases import CASES
from helpers.processes import descendants, is_gone, processor_seconds, wait_until
from semispline import ComputationError, FileError, read_surface
from semispline.solver.cli import app
from semispline.solver.io import foreign
from semispline.solver.io.rhino import open_3dm, read_3dm
from semispline.solver.io.surface_files import list_file
from semispline.solver.workers import End, WorkerError

linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps these limits")
ENTRY = "from semispline.papers.cli import main; main()"


def listed(path):
    return CliRunner().invoke(app, ["list", str(path)])


@pytest.mark.long
@linux
@pytest.mark.parametrize("name", ["mem3g.3dm", "loop28.brep"])
def test_a_damaged_file_is_refused_within_limits(name):
    code = f"import resource\ntry:\n    {ENTRY}\nfinally:\n    print(resource.getrusage(resource.RUSAGE_CHILDREN))"
    command = [sys.executable, "-c", code, "list", str(CASES / name)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {CASES / name}: ")
    assert "MB of memory" in done.stderr
    assert done.stderr.count("\n") == 1
    used = dict(part.split("=") for part in done.stdout.strip().partition("(")[2].rstrip(")").split(", "))
    assert float(used["ru_maxrss"]) / 1024 < 1200
    assert float(used["ru_utime"]) < 60


@linux
@pytest.mark.slow
def test_limits_of_time_and_memory_are_told_apart(monkeypatch):
    path = CASES / "loop28.brep"
    size = path.stat().st_size
    monkeypatch.setattr(foreign, "limits", lambda path: (1, 16000))
    with pytest.raises(FileError, match=f"more than 1 s of processor time for {size} bytes"):
        read_surface(path)
    monkeypatch.setattr(foreign, "limits", lambda path: (600, 700))
    with pytest.raises(FileError, match=f"more than 700 MB of memory for {size} bytes"):
        read_surface(path)


@pytest.mark.parametrize(
    ("end", "kind", "said", "not_said"),
    [
        (End.TIME, FileError, "processor time", "killed"),
        (End.MEMORY, FileError, "memory for 2 bytes", "killed"),
        (End.CRASH, FileError, "broke down.*SIGX.*damaged", "killed"),
        (End.KILLED, ComputationError, "killed from outside.*SIGX.*try again", "damaged"),
        (End.FAULT, ComputationError, "SIGX.*fault of semispline", "damaged"),
    ],
)
def test_the_file_is_blamed_for_what_it_did_alone(tmp_path, monkeypatch, end, kind, said, not_said):
    def fail(*_):
        raise WorkerError(end, "SIGX")

    monkeypatch.setattr(foreign, "call", fail)
    path = tmp_path / "x.step"
    path.write_text("xy")
    with pytest.raises(kind, match=rf"x\.step: .*{said}") as caught:
        read_surface(path)
    assert not_said not in str(caught.value)
    assert isinstance(caught.value, ComputationError) == (kind is ComputationError)


def test_limits_fit_the_size_of_the_file(tmp_path):
    path = tmp_path / "x.step"
    found = []
    for size in (0, 1300, 10**6, 10**8):
        with path.open("wb") as file:
            file.truncate(size)
        found.append(foreign.limits(path))
    # Some seconds for a small file, more than a minute for some megabytes.
    assert found[0] == found[1] == (5, 1024)
    assert found[2][0] >= 50
    assert found == sorted(found)
    assert [m for _, m in found] == sorted(m for _, m in found)


@linux
def test_a_reader_killed_from_outside_says_nothing_against_the_file(monkeypatch):
    monkeypatch.setattr(foreign, "limits", lambda path: (600, 8192))

    def kill():
        wait_until(lambda: any(processor_seconds(p) > 0.3 for p in descendants(os.getpid())), "the reader works")
        for process in descendants(os.getpid()):
            os.kill(process, signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    with pytest.raises(ComputationError, match=r"loop28\.brep: .*killed from outside \(SIGKILL\)"):
        read_surface(CASES / "loop28.brep")
    thread.join()


@pytest.mark.long
@linux
def test_a_command_that_is_killed_leaves_no_reader():
    code = f"from semispline.solver.io import foreign\nforeign.limits = lambda path: (600, 4096)\n{ENTRY}"
    command = subprocess.Popen([sys.executable, "-c", code, "list", str(CASES / "loop28.brep")])
    try:
        # Past its imports: inside the call that does not end.
        wait_until(lambda: any(processor_seconds(p) > 1.5 for p in descendants(command.pid)), "the reader works")
        readers = descendants(command.pid)
        command.kill()
        command.wait()
        wait_until(lambda: all(map(is_gone, readers)), "the reader ends with the command")
    finally:
        command.kill()


def save_3dm(path, *geometries):
    file = rhino3dm.File3dm()
    for geometry in geometries:
        file.Objects.Add(geometry)
    assert file.Write(str(path), 0)


def mesh():
    found = rhino3dm.Mesh()
    for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0)):
        found.Vertices.Add(*point)
    found.Faces.AddFace(0, 1, 2)
    return found


def curve():
    return rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 2.0).ToNurbsCurve()


def line():
    return rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 0, 0))


@pytest.mark.long
def test_a_3dm_file_without_surfaces_says_what_it_holds(tmp_path):
    path = tmp_path / "x.3dm"
    save_3dm(path, mesh(), rhino3dm.SubD(), mesh(), curve(), line())
    done = listed(path)
    assert done.exit_code == 0
    assert done.stdout.startswith("no surfaces: 2 meshes, 1 SubD, 2 curves; ")
    assert done.stdout.count("\n") == 1
    entries, others = list_file(path)
    assert (entries, dict(others)) == ([], {"mesh": 2, "SubD": 1, "curve": 2})
    with pytest.raises(FileError, match=r"x\.3dm: holds no surfaces: 2 meshes, 1 SubD, 2 curves;"):
        read_surface(path)


@pytest.mark.long
def test_what_is_listed_beside_surfaces(tmp_path):
    path = tmp_path / "x.3dm"
    plane = rhino3dm.PlaneSurface(rhino3dm.Plane.WorldXY(), rhino3dm.Interval(0, 4), rhino3dm.Interval(0, 4))
    save_3dm(path, mesh(), plane)
    done = listed(path)
    assert done.stdout.splitlines()[-1] == "cannot be used: 1 mesh"
    assert len(done.stdout.splitlines()) == 3
    CliRunner().invoke(app, ["list", str(path), "--json", str(tmp_path / "x.json")])
    record = json.loads((tmp_path / "x.json").read_text())
    assert record["others"] == {"mesh": 1}
    assert len(record["surfaces"]) == 1


def test_an_empty_3dm_file(tmp_path):
    save_3dm(tmp_path / "x.3dm")
    done = listed(tmp_path / "x.3dm")
    assert (done.exit_code, done.stdout) == (0, "no surfaces, and nothing else that is known here\n")


def bounds():
    """Two edges of which one is in a wire, and a vertex: each counts as what it belongs to."""
    edges = [BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, y, 0)).Edge() for y in (0, 1)]
    builder, whole = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(whole)
    builder.Add(whole, BRepBuilderAPI_MakeWire(edges[0]).Wire())
    builder.Add(whole, edges[1])
    builder.Add(whole, BRepBuilderAPI_MakeVertex(gp_Pnt(5, 5, 5)).Vertex())
    return whole


@pytest.mark.usefixtures("read_here")
def test_a_brep_file_without_faces_says_what_it_holds(tmp_path):
    path = tmp_path / "x.brep"
    BRepTools.Write_s(bounds(), str(path))
    done = listed(path)
    assert done.exit_code == 0
    assert done.stdout.startswith("no surfaces: 1 wire, 1 edge, 1 vertex; ")


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize("suffix", [".step", ".igs"])
def test_edges_of_other_formats(tmp_path, suffix):
    path, edge = tmp_path / f"x{suffix}", BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Edge()
    if suffix == ".step":
        writer = STEPControl_Writer()
        writer.Transfer(edge, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
    else:
        writer = IGESControl_Writer()
        writer.AddShape(edge)
        writer.Write(str(path))
    entries, others = list_file(path)
    assert entries == []
    assert sum(others.values()) == 1
    assert set(others) <= {"edge", "wire"}


def test_both_ways_to_read_a_3dm_file_agree(tmp_path):
    path = tmp_path / "x.3dm"
    circle = rhino3dm.Circle(rhino3dm.Point3d(2, 2, 0), 1.0).ToNurbsCurve()
    cut = rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), circle)
    cylinder = rhino3dm.NurbsSurface.CreateFromCylinder(rhino3dm.Cylinder(rhino3dm.Circle(2.0), 3.0))
    save_3dm(path, cut, cylinder, mesh())
    apart, here = open_3dm(path), read_3dm(path)
    assert (apart.unit, apart.others) == (here.unit, here.others)
    assert len(apart.faces) == len(here.faces) == 2
    for a, b in zip(apart.faces, here.faces, strict=True):
        assert (a.kind, a.trimmed()) == (b.kind, b.trimmed())
        np.testing.assert_array_equal(a.surface().control_points, b.surface().control_points)
