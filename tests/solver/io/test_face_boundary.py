import json
import math
from dataclasses import replace

import numpy as np
import pytest
import rhino3dm
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_CylindricalSurface, Geom_RectangularTrimmedSurface
from OCP.Geom2d import Geom2d_Circle, Geom2d_Line
from OCP.GeomConvert import GeomConvert
from OCP.gp import gp_Ax2d, gp_Ax3, gp_Dir2d, gp_Pnt2d
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from OCP.TopoDS import TopoDS, TopoDS_Compound
from typer.testing import CliRunner

from helpers.sweeps import examples
from semispline import BlendOptions, BSplineSurface
from semispline.papers.cli import app as all_commands
from semispline.solver.c_export import write_c
from semispline.solver.cli import app
from semispline.solver.errors import TrimError
from semispline.solver.io.face_boundary import FaceBoundary, edge_offset, joined
from semispline.solver.io.json_files import StoredProblem, write_problem
from semispline.solver.io.occ import read_occ
from semispline.solver.io.occ_boundary import edges_of
from semispline.solver.io.occ_writing import occ_surface
from semispline.solver.io.rhino import open_3dm
from semispline.solver.io.surface_files import (
    LoadedSurface,
    in_one_unit,
    list_surfaces,
    read_surfaces,
    trimmed_edge_warning,
    write_surface,
)

EDGES = ("u0", "u1", "v0", "v1")


def sheet(length=40.0, width=30.0, start=0.0):
    """Flat, x = length * u, y = width * v."""
    corners = [[[start + x, y, 0.0] for y in (0.0, width)] for x in (0.0, length)]
    return BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], corners)


def rectangle(surface, u0, u1, v0, v1):
    return BRepBuilderAPI_MakeFace(occ_surface(surface), u0, u1, v0, v1, 1e-7).Face()


def polygon(surface, *corners):
    """A face bounded by straight lines in the parameters, anticlockwise."""
    geometry, wire = occ_surface(surface), BRepBuilderAPI_MakeWire()
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        step = b[0] - a[0], b[1] - a[1]
        line = Geom2d_Line(gp_Pnt2d(*a), gp_Dir2d(*step))
        wire.Add(BRepBuilderAPI_MakeEdge(line, geometry, 0.0, math.hypot(*step)).Edge())
    face = BRepBuilderAPI_MakeFace(geometry, wire.Wire()).Face()
    BRepLib.BuildCurves3d_s(face)
    return face


def with_hole(surface, centre, radius):
    """The whole surface with a circle of the parameters cut out."""
    geometry = occ_surface(surface)
    maker = BRepBuilderAPI_MakeFace(geometry, 1e-7)
    circle = Geom2d_Circle(gp_Ax2d(gp_Pnt2d(*centre), gp_Dir2d(1.0, 0.0)), radius)
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle, geometry).Edge()).Wire()
    maker.Add(TopoDS.Wire(wire.Reversed()))
    face = maker.Face()
    BRepLib.BuildCurves3d_s(face)
    return face


def cylinder(radius=10.0, height=100.0):
    """A whole turn about z as a B-spline, u around from 0 to 2 pi, v along z."""
    whole = Geom_RectangularTrimmedSurface(Geom_CylindricalSurface(gp_Ax3(), radius), 0.0, height, False)
    return GeomConvert.SurfaceToBSplineSurface_s(whole)


def write(path, *faces):
    shape = faces[0]
    if len(faces) > 1:
        shape = TopoDS_Compound()
        builder = BRep_Builder()
        builder.MakeCompound(shape)
        for face in faces:
            builder.Add(shape, face)
    if path.suffix == ".step":
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))
    elif path.suffix == ".igs":
        writer = IGESControl_Writer("MM", 0)
        writer.AddShape(shape)
        writer.ComputeModel()
        writer.Write(str(path))
    else:
        BRepTools.Write_s(shape, str(path))
    return path


def offsets(face):
    """Distance and "in part" of each natural edge; the names of the edges are those of the file."""
    boundary = face.boundary()
    assert boundary is not None
    found = [edge_offset(face.surface(), edge, boundary) for edge in EDGES]
    return [round(o.distance, 3) for o in found], [o.in_part for o in found]


def read(path):
    (face,) = read_occ(path).faces
    return face


@pytest.mark.parametrize("suffix", [".step", ".igs", ".brep"])
def test_a_face_cut_at_seven_tenths_of_40_is_12_off(tmp_path, suffix):
    face = read(write(tmp_path / f"cut{suffix}", rectangle(sheet(), 0.0, 0.7, 0.0, 1.0)))
    assert offsets(face) == ([0.0, 12.0, 12.0, 12.0], [True, False, True, True])


@pytest.mark.parametrize("suffix", [".step", ".igs", ".brep"])
def test_a_whole_surface_has_no_boundary_of_its_own(tmp_path, suffix):
    assert read(write(tmp_path / f"whole{suffix}", rectangle(sheet(), 0.0, 1.0, 0.0, 1.0))).boundary() is None


@pytest.mark.parametrize("suffix", [".step", ".brep"])
def test_a_reversed_face_has_the_same_edges(tmp_path, suffix):
    turned = rectangle(sheet(), 0.0, 0.7, 0.0, 1.0).Reversed()
    assert offsets(read(write(tmp_path / f"cut{suffix}", turned)))[0] == [0.0, 12.0, 12.0, 12.0]


@pytest.mark.parametrize("suffix", [".step", ".brep"])
def test_a_hole_leaves_the_natural_edges(tmp_path, suffix):
    # Long edges of one straight piece, beside which the short pieces of the hole are near everywhere.
    face = read(write(tmp_path / f"hole{suffix}", with_hole(sheet(width=1.0), (0.5, 0.5), 0.2)))
    assert face.trimmed() is True
    assert offsets(face)[0] == [0.0] * 4


def test_a_corner_cut_off_takes_a_part_of_two_edges(tmp_path):
    # From (40, 21) to (28, 30): what is off most is the corner (40, 30), above the long side of its triangle.
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.7), (0.7, 1.0), (0.0, 1.0)]
    face = read(write(tmp_path / "corner.brep", polygon(sheet(), *corners)))
    height = round(12.0 * 9.0 / math.hypot(12.0, 9.0), 3)
    assert offsets(face) == ([0.0, height, 0.0, height], [True] * 4)


def test_a_notch_between_two_samples_is_seen(tmp_path):
    corners = [(0.0, 0.0), (0.503, 0.0), (0.503, 0.2), (0.504, 0.2), (0.504, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    face = read(write(tmp_path / "notch.brep", polygon(sheet(), *corners)))
    # Half of its width, from the middle of what is missing.
    assert offsets(face) == ([0.0, 0.0, 0.02, 0.0], [True] * 4)


@pytest.mark.parametrize(("tolerance", "off"), [(1e-7, 0.008), (0.0079, 0.008), (0.0081, 0.0)])
def test_edges_are_where_their_tolerance_says(tmp_path, tolerance, off):
    face = rectangle(sheet(), 0.0, 1 - 2e-4, 0.0, 1.0)
    for edge in edges_of(face):
        BRep_Builder().UpdateEdge(edge, tolerance)
    assert offsets(read(write(tmp_path / "cut.brep", face)))[0] == [0.0, off, off, off]


@pytest.mark.parametrize("suffix", [".step", ".brep"])
@pytest.mark.parametrize("periodic", [False, True])
def test_of_a_seam_each_side_is_an_edge(tmp_path, suffix, periodic):
    surface = cylinder()
    if periodic:
        surface.SetUPeriodic()

    def part(name, *ends):
        return read(write(tmp_path / f"{name}{suffix}", BRepBuilderAPI_MakeFace(surface, *ends, 1e-7).Face()))

    assert part("whole", 0.0, 2 * math.pi, 0.0, 100.0).boundary() is None
    # The seam is an edge of the half that begins there, on one side; from the other, the half ends 20 across. Of a rim
    # the middle of the missing half is off most, 10 * sqrt(2) from both ends of what is there.
    assert offsets(part("first", 0.0, math.pi, 0.0, 100.0))[0] == [0.0, 20.0, 14.142, 14.142]
    assert offsets(part("second", math.pi, 2 * math.pi, 0.0, 100.0))[0] == [20.0, 0.0, 14.142, 14.142]
    assert offsets(part("low", 0.0, 2 * math.pi, 0.0, 70.0)) == ([30.0, 30.0, 0.0, 30.0], [True, True, True, False])


@examples(40)
@given(cut=st.floats(0.05, 0.95), scale=st.floats(1e-2, 1e4), bend=st.floats(-0.5, 0.5))
def test_what_is_cut_off_is_measured_at_any_size(tmp_path_factory, cut, scale, bend):
    # Bent along v alone: what is off is straight.
    v = np.linspace(0, 1, 4)
    points = [[[x, y, bend * y * (1 - y)] for y in v] for x in (0.0, 1.0)]
    surface = BSplineSurface(1, 3, [0, 0, 1, 1], [0] * 4 + [1] * 4, scale * np.array(points))
    path = write(tmp_path_factory.mktemp("cut") / "cut.brep", rectangle(surface, 0.0, cut, 0.0, 1.0))
    face = read(path)
    found = [edge_offset(surface, edge, face.boundary()).distance for edge in EDGES]
    np.testing.assert_allclose(found, [0.0, *[(1 - cut) * scale] * 3], rtol=1e-5)


def test_faces_of_a_trimmed_plane_of_rhino(tmp_path):
    circle = rhino3dm.Circle(rhino3dm.Point3d(2, 3, 0), 1.0).ToNurbsCurve()
    file = rhino3dm.File3dm()
    file.Objects.AddBrep(rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), circle))
    file.Objects.AddBrep(
        rhino3dm.Brep.CreateFromBoundingBox(rhino3dm.BoundingBox(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 2, 3)))
    )
    assert file.Write(str(tmp_path / "s.3dm"), 0)
    disc, *sides = open_3dm(tmp_path / "s.3dm").faces
    # The plane reaches as far as the circle does: from a corner, what is left of the diagonal.
    np.testing.assert_allclose(offsets(disc)[0], [math.sqrt(2) - 1] * 4, atol=1e-3)
    assert [side.boundary() for side in sides] == [None] * 6


@pytest.mark.parametrize(("part", "trimmed"), [(2.5e-4, False), (3.5e-4, True)])
def test_edges_of_rhino_count_as_natural_up_to_a_part_of_the_size(tmp_path, part, trimmed):
    # A square of side 40 with one corner pulled in along its diagonal, by that part of 40 from both sides.
    inner = 40.0 * (1 - part)
    corners = [(0, 0), (40, 0), (inner, inner), (0, 40), (0, 0)]
    curve = rhino3dm.PolylineCurve(rhino3dm.Point3dList([rhino3dm.Point3d(x, y, 0) for x, y in corners]))
    file = rhino3dm.File3dm()
    file.Objects.AddBrep(rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), curve))
    assert file.Write(str(tmp_path / "s.3dm"), 0)
    (face,) = open_3dm(tmp_path / "s.3dm").faces
    assert face.trimmed() is trimmed
    assert (face.boundary() is None) is not trimmed


@pytest.mark.long
def test_the_boundary_comes_out_of_the_process_that_reads(tmp_path):
    whole, cut = rectangle(sheet(start=100.0), 0.0, 1.0, 0.0, 1.0), rectangle(sheet(), 0.0, 0.7, 0.0, 1.0)
    path = write(tmp_path / "two.step", whole, cut)
    first, second = read_surfaces([f"{path}#0", f"{path}#1"])
    assert trimmed_edge_warning("x", "u1", first) is None
    assert trimmed_edge_warning("x", "u0", second) is None
    assert trimmed_edge_warning("two.step#1", "u1", second) == (
        "the edge u1 of two.step#1 lies outside of the face, up to 12 mm from the face's own boundary: "
        "the face is trimmed, its surface goes on; `semispline list two.step --edges 1` names its own edges"
    )
    assert "outside of the face, in part, by up to 12 mm" in trimmed_edge_warning("x", "v0", second)
    # A line inside of the surface may run through the face: it is not called outside.
    assert trimmed_edge_warning("x", "u=0.7-", second) is None
    for line, away in (("u=0.3+", "up to 12"), ("u=0.9-", "up to 8")):
        assert trimmed_edge_warning("two.step#1", line, second).startswith(
            f"the edge {line} of two.step#1 is no edge of the face, {away} mm from the face's own boundary: "
            "it runs through the face, or beyond it; "
        )
    assert [entry.trimmed for entry in list_surfaces(path)] == [False, True]


def test_distances_are_in_the_unit_of_the_surface(tmp_path):
    boundary = read(write(tmp_path / "cut.brep", rectangle(sheet(), 0.0, 0.7, 0.0, 1.0))).boundary()
    _, loaded = in_one_unit([LoadedSurface(sheet(), "mm"), LoadedSurface(sheet(), "in", boundary)])
    assert "up to 305 mm" in trimmed_edge_warning("x", "u1", loaded)
    assert trimmed_edge_warning("x", "u0", loaded) is None
    # BREP names no unit.
    assert "up to 12 model units" in trimmed_edge_warning("x", "u1", LoadedSurface(sheet(), None, boundary))


def test_a_boundary_that_cannot_be_read_is_said():
    warning = trimmed_edge_warning("x.brep", "u1", LoadedSurface(sheet(), None, joined([])))
    assert "whether the edge u1 of x.brep is an edge of the face cannot be told" in warning


def test_the_nearest_edge_counts_however_loose_others_are():
    """A boundary 2 from the edge u0 and loose ones 4 from it; when they are looser still, one of them may be it."""
    lines = np.stack([np.linspace([x, 0.0, 0.0], [x, 30.0, 0.0], 4) for x in (2.0, 4.0, 4.0)])
    for loose, off in ((3.9, 2.0), (4.1, 0.0)):
        boundary = FaceBoundary(lines, np.array([1e-7, loose, loose]), np.array(["", "", ""]))
        assert edge_offset(sheet(), "u0", boundary).distance == pytest.approx(off)


def closed_sheet():
    """A sheet rolled into a roof that closes: u0 and u1 are one line."""
    row = np.array([[0.0, 0.0, 0.0], [0.0, 30.0, 0.0]])
    net = np.stack([row, row + np.array([10.0, 0, 0]), row + np.array([10.0, 0, 10.0]), row])
    return BSplineSurface(1, 1, [0, 0, 1, 2, 3, 3], [0, 0, 1, 1], net)


@pytest.mark.parametrize(("surface", "side", "off"), [(sheet(), "u1", 0.0), (closed_sheet(), "u1", 5.0)])
def test_only_a_seam_has_another_side(surface, side, off):
    """The line at u = 0, and one 5 apart from it that is nearest to the seam where the first does not count."""
    lines = np.stack([np.linspace([x, 0.0, 0.0], [x, 30.0, 0.0], 4) for x in (0.0, 5.0)])
    boundary = FaceBoundary(lines, np.full(2, 1e-7), np.array([side, ""]))
    assert edge_offset(surface, "u0", boundary).distance == pytest.approx(off)
    # What is left of a boundary that lies on the other side alone is the boundary.
    alone = FaceBoundary(lines[:1], np.full(1, 1e-7), np.array([side]))
    assert edge_offset(surface, "u0", alone).distance == 0.0


def run(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture
def pair(tmp_path):
    """A floor cut at u = 0.7 and a whole one that goes on where its surface ends."""
    write(tmp_path / "cut.step", rectangle(sheet(), 0.0, 0.7, 0.0, 1.0))
    write_surface(tmp_path / "next.json", sheet(start=40.0))
    write_surface(tmp_path / "far.json", sheet(start=60.0))
    return tmp_path


WORDS = "lies outside of the face, up to 12 mm from the face's own boundary"


@pytest.mark.usefixtures("read_here")
def test_check_warns_and_answers_for_the_natural_edge(pair):
    files = pair / "cut.step", pair / "next.json"
    done = run("check", *files, "--edge-a", "u1", "--edge-b", "u0", "--require", "G2", "--json", pair / "c.json")
    assert done.exit_code == 0, done.output
    assert "G2: yes" in done.stdout
    own = f"`semispline list {files[0]} --edges 0` names its own edges"
    assert (
        done.stderr == f"warning: the edge u1 of {files[0]} {WORDS}: the face is trimmed, its surface goes on; {own}\n"
    )
    assert [WORDS in text for text in json.loads((pair / "c.json").read_text())["warnings"]] == [True]
    done = run("check", *reversed(files), "--edge-a", "u0", "--edge-b", "u0", "--json", "-")
    assert done.exit_code == 0
    assert done.stderr == ""
    assert json.loads(done.stdout)["warnings"] == []


@pytest.mark.usefixtures("read_here")
def test_blend_warns_and_strict_refuses(pair):
    call = ("blend", pair / "far.json", pair / "cut.step", "--edge-a", "u0", "--edge-b", "u1", "-o", pair / "out.json")
    call = (*call, "--report", pair / "report.json")
    done = run(*call)
    assert done.exit_code == 0, done.output
    assert f"warning: the edge u1 of {pair / 'cut.step'} {WORDS}" in done.stderr
    assert any(WORDS in text for text in json.loads((pair / "report.json").read_text())["warnings"])
    (pair / "out.json").unlink()
    (pair / "report.json").unlink()
    done = run(*call, "--strict")
    assert done.exit_code == 3
    assert done.stderr.startswith("error: ")
    assert WORDS in done.stderr
    assert done.stderr.count("\n") == 1
    assert sorted(p.name for p in pair.iterdir()) == ["cut.step", "far.json", "next.json"]


@pytest.mark.usefixtures("read_here")
def test_c_of_a_stored_problem_warns_and_strict_refuses(pair):
    problem = StoredProblem("far.json", "u0", "cut.step#0", "u1", BlendOptions(continuity="C1"))
    write_problem(pair / "problem.json", problem)
    done = CliRunner().invoke(
        all_commands, ["generate", "--c", str(pair / "out"), "--problem", str(pair / "problem.json")]
    )
    assert done.exit_code == 0, done.output
    assert done.stderr.startswith(f"warning: the edge u1 of {pair / 'cut.step#0'} {WORDS}: the face is trimmed")
    assert len(list((pair / "out").iterdir())) == 3
    # The edges of one surface: none is there where it ends, and the other one stands in the file itself.
    write_problem(pair / "problem.json", replace(problem, edge_b="u0"))
    assert write_c(pair / "out", pair / "problem.json")[1] == ()
    write_problem(pair / "problem.json", replace(problem, a=sheet(start=60.0)))
    assert [WORDS in text for text in write_c(pair / "out", pair / "problem.json")[1]] == [True]
    write_problem(pair / "problem.json", replace(problem, options=BlendOptions(continuity="C1", strict=True)))
    with pytest.raises(TrimError, match=WORDS):
        write_c(pair / "strict", pair / "problem.json")
    assert not (pair / "strict").exists()
