import json
import math
import sys
from pathlib import Path

import numpy as np
import pyiges
import pytest
import pyvista
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_OffsetSurface
from OCP.IGESControl import IGESControl_Reader
from OCP.STEPControl import STEPControl_Reader
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from semispline import (
    BSplineCurve,
    BSplineSurface,
    FileError,
    InputError,
    SemiStructuredSurface,
    list_surfaces,
    plane,
    revolve,
)
from semispline.solver.io.faces import MILLIMETRES, describe, picked
from semispline.solver.io.occ import read_occ
from semispline.solver.io.occ_writing import occ_bytes, occ_surface
from semispline.solver.io.rhino import open_3dm
from semispline.solver.io.surface_files import read_surface, read_surfaces, split_spec, write_surface, write_surfaces
from semispline.solver.judge.de_boor import surface_points

IMPELLER = Path(pyiges.__file__).parent / "examples" / "impeller.igs"
EXACT = (".step", ".stp", ".igs", ".brep", ".3dm")


def patch(rational=False, scale=1.0, closed=False, collapsed=False):
    rng = np.random.default_rng(11)
    net, weights = scale * rng.normal(size=(6, 6, 3)), rng.uniform(0.5, 2, (6, 6))
    if closed:
        net[-1], weights[-1] = net[0], weights[0]
    if collapsed:
        net[0] = net[0, 0]
    knots_u, knots_v = [0, 0, 0, 1 / 3, 1 / 3, 0.5, 1, 1, 1], [-2, -2, -2, -2, 0.1, 0.7, 2, 2, 2, 2]
    return BSplineSurface(2, 3, knots_u, knots_v, net, weights if rational else None)


def semistructured():
    rng = np.random.default_rng(12)
    knots = ([0, 0, 1, 1], [0, 0, 0, 0, 0.3, 1, 1, 1, 1], [0, 0, 0, 0.3, 0.6, 1, 1, 1])
    curves = (BSplineCurve(q, k, rng.normal(size=(len(k) - q - 1, 3))) for q, k in zip((1, 3, 2), knots, strict=True))
    return SemiStructuredSurface(2, [0, 0, 0, 1, 1, 1], tuple(curves))


def read_here(path):
    """In this process: what we wrote ourselves breaks nothing."""
    if path.suffix == ".3dm":
        return read_surface(path)
    (face,) = read_occ(path).faces
    return face.surface()


def assert_same(found, expected, rounding=0.0):
    assert (found.degree_u, found.degree_v) == (expected.degree_u, expected.degree_v)
    assert (found.weights is None) == (expected.weights is None)
    pairs = [(found.knots_u, expected.knots_u), (found.knots_v, expected.knots_v)]
    pairs.append((found.control_points, expected.control_points))
    if expected.weights is not None:
        pairs.append((found.weights, expected.weights))
    for a, b in pairs:
        np.testing.assert_allclose(a, b, rtol=0, atol=rounding * np.abs(b).max())


@pytest.mark.parametrize("suffix", EXACT)
@pytest.mark.parametrize(
    "options",
    [{}, {"rational": True}, {"scale": 1e6}, {"scale": 1e-5}, {"closed": True}, {"collapsed": True}],
    ids=["polynomial", "rational", "large", "small", "closed", "collapsed"],
)
def test_net_knots_and_weights_come_back(tmp_path, suffix, options):
    path, surface = tmp_path / f"s{suffix}", patch(**options)
    write_surface(path, surface)
    # 17 digits bring every double back; 3dm multiplies points by weights, which rounds twice.
    assert_same(read_here(path), surface, 4e-16 if suffix == ".3dm" and surface.weights is not None else 0.0)


@pytest.mark.parametrize("suffix", EXACT)
def test_a_semistructured_surface_is_written_as_the_same_surface(tmp_path, suffix):
    path, surface = tmp_path / f"s{suffix}", semistructured()
    write_surface(path, surface)
    found = read_here(path)
    u, v = np.linspace(0, 1, 7), np.linspace(0, 1, 9)
    np.testing.assert_allclose(found.evaluate_grid(u, v), surface.evaluate_grid(u, v), rtol=0, atol=1e-14)


@pytest.fixture(scope="module")
def impeller():
    return read_occ(IMPELLER)


@pytest.mark.parametrize("unit", MILLIMETRES)
@pytest.mark.parametrize("suffix", [".step", ".igs", ".3dm"])
def test_coordinates_stay_in_the_unit_of_the_file(tmp_path, suffix, unit):
    path, surface = tmp_path / f"s{suffix}", patch()
    if (suffix, unit) == (".step", "uin"):
        # STEP has no name for a millionth of an inch.
        with pytest.raises(FileError, match="cannot hold"):
            write_surface(path, surface, unit)
        return
    write_surface(path, surface, unit)
    if suffix == ".3dm":
        (loaded,) = read_surfaces([path])
        found, found_unit = loaded.surface, loaded.unit
    else:
        model = read_occ(path)
        found, found_unit = model.faces[0].surface(), model.unit
    assert found_unit == unit
    # The translators multiply by the unit and divide by it.
    assert_same(found, surface, 4e-16)


@pytest.mark.parametrize("unit", ["in", "mm", "m"])
@pytest.mark.parametrize("suffix", [".step", ".igs"])
def test_the_size_that_others_read_is_right(tmp_path, suffix, unit):
    """The kernel's own reader, left alone, converts to millimetres."""
    path = tmp_path / f"s{suffix}"
    write_surface(path, patch(), unit)
    reader = STEPControl_Reader() if suffix == ".step" else IGESControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    explorer = TopExp_Explorer(reader.OneShape(), TopAbs_ShapeEnum.TopAbs_FACE)
    pole = BRep_Tool.Surface_s(TopoDS.Face(explorer.Current())).Pole(2, 3)
    expected = patch().control_points[1, 2] * {"in": 25.4, "mm": 1.0, "m": 1000.0}[unit]
    np.testing.assert_allclose([pole.X(), pole.Y(), pole.Z()], expected, rtol=1e-15)


@pytest.mark.parametrize(
    ("suffix", "declared", "instead", "unit"),
    [(".igs", b",2,2HMM,", b",1,2HIN,", "in"), (".step", b"SI_UNIT(.MILLI.,.METRE.)", b"SI_UNIT($,.METRE.)", "m")],
)
def test_the_unit_is_read_off_the_header(tmp_path, suffix, declared, instead, unit):
    data = occ_bytes([patch()], suffix, "mm")
    assert data.count(declared) == 1
    path = tmp_path / f"s{suffix}"
    path.write_bytes(data.replace(declared, instead))
    model = read_occ(path)
    assert model.unit == unit
    assert_same(model.faces[0].surface(), patch())


@pytest.mark.usefixtures("read_here")
def test_surfaces_in_different_units_come_in_that_of_the_first(tmp_path):
    write_surface(tmp_path / "a.3dm", patch(), "in")
    write_surface(tmp_path / "b.3dm", patch(), "mm")
    write_surface(tmp_path / "c.json", patch())
    a, b, c = read_surfaces([tmp_path / name for name in ("a.3dm", "b.3dm", "c.json")])
    assert {x.unit for x in (a, b, c)} == {"in"}
    np.testing.assert_array_equal(a.surface.control_points, patch().control_points)
    np.testing.assert_allclose(b.surface.control_points * 25.4, patch().control_points, rtol=1e-15)
    np.testing.assert_array_equal(c.surface.control_points, patch().control_points)


@pytest.mark.long
def test_impeller_faces_of_the_first_issue(impeller):
    entries = [describe(number, face) for number, face in enumerate(impeller.faces)]
    assert len(entries) == 277
    for number in (102, 131):
        entry = entries[number]
        assert (entry.kind, entry.degree_u, entry.degree_v, entry.n_u, entry.n_v) == ("B-spline", 3, 3, 17, 13)
        assert entry.rational is False
    assert {entry.kind for entry in entries} == {"B-spline", "revolution"}
    assert all(entry.problem is None for entry in entries)


@pytest.mark.long
def test_impeller_pair_through_the_one_entry(capfd):
    a, b = read_surfaces([f"{IMPELLER}#102", f"{IMPELLER}#131"])
    assert a.unit == "mm"
    # The first control point of each, read off the parameter section of the file by eye.
    np.testing.assert_array_equal(a.surface.control_points[0, 0], [2.435888967, -33.939742009, 6.388220916])
    np.testing.assert_array_equal(b.surface.control_points[0, 0], [25.979181404, 22.219404694, 3.906500615])
    assert capfd.readouterr() == ("", "")


def test_revolved_faces_of_the_impeller_are_exact(impeller):
    faces = [face for face in impeller.faces if face.kind == "revolution"]
    assert len(faces) == 30
    for face in faces:
        surface, exact = face.surface(), BRep_Tool.Surface_s(face.face)
        axis = exact.Axis()
        origin = np.array([axis.Location().X(), axis.Location().Y(), axis.Location().Z()])
        along = np.array([axis.Direction().X(), axis.Direction().Y(), axis.Direction().Z()])

        def profile(points, origin=origin, along=along):
            height = (points - origin) @ along
            return np.stack([height, np.linalg.norm(points - origin - height[..., None] * along, axis=-1)], axis=-1)

        (u0, u1), (v0, v1) = surface.domain
        v = np.linspace(v0, v1, 9)
        grid = surface.evaluate_grid(np.linspace(u0, u1, 7), v)
        meridian = [exact.Value(0.0, float(x)) for x in v]
        expected = profile(np.array([(p.X(), p.Y(), p.Z()) for p in meridian]))
        np.testing.assert_allclose(profile(grid), np.broadcast_to(expected, (7, 9, 2)), rtol=0, atol=1e-12 * 70)


def solids():
    return {
        "cylinder": (BRepPrimAPI_MakeCylinder(2.0, 3.0), lambda x, y, z: np.hypot(x, y) - 2),
        "cone": (BRepPrimAPI_MakeCone(2.0, 1.0, 4.0), lambda x, y, z: np.hypot(x, y) - (2 - z / 4)),
        "sphere": (BRepPrimAPI_MakeSphere(3.0), lambda x, y, z: np.sqrt(x**2 + y**2 + z**2) - 3),
        "torus": (BRepPrimAPI_MakeTorus(5.0, 1.0), lambda x, y, z: np.hypot(np.hypot(x, y) - 5, z) - 1),
    }


@pytest.mark.parametrize("kind", ["cylinder", "cone", "sphere", "torus"])
def test_analytic_faces_become_exact_rational_surfaces(tmp_path, kind):
    solid, distance = solids()[kind]
    path = tmp_path / "solid.brep"
    BRepTools.Write_s(solid.Shape(), str(path))
    face = next(face for face in read_occ(path).faces if face.kind == kind)
    surface = face.surface()
    assert surface.weights is not None
    (u0, u1), (v0, v1) = surface.domain
    points = surface.evaluate_grid(np.linspace(u0, u1, 23), np.linspace(v0, v1, 17))
    assert np.abs(distance(*np.moveaxis(points, -1, 0))).max() < 1e-14
    entry = describe(0, face)
    assert entry.closed_u
    assert entry.closed_v == (kind == "torus")
    assert entry.trimmed is False


def test_planes_of_a_box_are_bilinear(tmp_path):
    path = tmp_path / "box.brep"
    BRepTools.Write_s(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), str(path))
    entries = [describe(i, face) for i, face in enumerate(read_occ(path).faces)]
    assert [(e.kind, e.degree_u, e.degree_v, e.n_u, e.n_v, e.rational, e.trimmed) for e in entries] == [
        ("plane", 1, 1, 2, 2, False, False)
    ] * 6


def test_a_face_on_a_part_of_its_surface_is_trimmed_and_read_whole(tmp_path):
    path = tmp_path / "part.brep"
    BRepTools.Write_s(BRepBuilderAPI_MakeFace(occ_surface(patch()), 0.1, 0.9, -1.0, 2.0, 1e-7).Face(), str(path))
    (face,) = read_occ(path).faces
    assert face.trimmed() is True
    assert_same(face.surface(), patch())
    path.write_bytes(occ_bytes([patch()], ".brep", "mm"))
    assert read_occ(path).faces[0].trimmed() is False


def test_an_offset_surface_is_listed_with_its_error(tmp_path):
    path = tmp_path / "offset.brep"
    offset = Geom_OffsetSurface(occ_surface(BSplineSurface(2, 2, *[[0, 0, 0, 1, 1, 1]] * 2, bump())), 0.1)
    BRepTools.Write_s(BRepBuilderAPI_MakeFace(offset, 1e-7).Face(), str(path))
    (face,) = read_occ(path).faces
    entry = describe(0, face)
    assert (entry.kind, entry.problem) == ("offset", None)
    # Size 4; the kernel's own conversion is off by 2e-6.
    assert 0 < entry.deviation < 4e-7


def bump():
    x, y = np.meshgrid([0, 1, 2.0], [0, 1, 2.0], indexing="ij")
    return np.stack([x, y, (x - 1) ** 2 - y], axis=-1)


def test_periodic_surfaces_are_clamped_exactly(tmp_path):
    surface = occ_surface(patch(rational=True, closed=True))
    surface.SetUPeriodic()
    assert surface.IsUPeriodic()
    path = tmp_path / "periodic.brep"
    BRepTools.Write_s(BRepBuilderAPI_MakeFace(surface, 1e-7).Face(), str(path))
    (face,) = read_occ(path).faces
    found = face.surface()
    (u0, u1), (v0, v1) = found.domain
    u, v = np.meshgrid(np.linspace(u0, u1, 9), np.linspace(v0, v1, 7), indexing="ij")
    values = [surface.Value(float(a), float(b)) for a, b in zip(u.ravel(), v.ravel(), strict=True)]
    expected = np.array([(p.X(), p.Y(), p.Z()) for p in values])
    np.testing.assert_allclose(surface_points(found, u.ravel(), v.ravel()), expected, rtol=0, atol=1e-14 * 4)


def test_what_a_format_cannot_hold_is_refused_and_the_old_file_stays(tmp_path):
    for suffix in (".step", ".igs"):
        path = tmp_path / f"tiny{suffix}"
        path.write_text("old")
        with pytest.raises(FileError, match="cannot hold this surface exactly"):
            write_surface(path, patch(scale=1e-9))
        assert path.read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["tiny.igs", "tiny.step"]


def test_headers_do_not_tell_who_ran_it(tmp_path):
    text = occ_bytes([patch()], ".igs", "mm").decode()
    assert "10Hsemispline" in text
    assert max(map(len, text.splitlines())) == 80


@pytest.mark.parametrize("suffix", [".step", ".igs", ".brep", ".3dm"])
@pytest.mark.parametrize(
    "content", [b"", b"hello world\n" * 50, bytes(range(256)) * 20], ids=["empty", "text", "bytes"]
)
def test_what_is_no_cad_file_is_refused(tmp_path, capfd, suffix, content):
    path = tmp_path / f"broken{suffix}"
    path.write_bytes(content)
    with pytest.raises(FileError) as caught:
        picked(open_3dm(path) if suffix == ".3dm" else read_occ(path), None)
    assert str(path) in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_half_a_file_does_not_take_us_down(tmp_path):
    path = tmp_path / "half.igs"
    write_surface(
        path, BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0.3]]])
    )
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(FileError, match=r"half\.igs: Open CASCADE broke down .*export it anew"):
        read_surface(path)


@pytest.mark.parametrize(
    ("suffix", "module"), [(".step", "OCP"), (".igs", "OCP"), (".3dm", "rhino3dm"), (".stl", "pyvista")]
)
def test_without_the_extra_the_message_says_what_to_install(tmp_path, monkeypatch, suffix, module):
    monkeypatch.setitem(sys.modules, module, None)
    path = tmp_path / f"s{suffix}"
    with pytest.raises(FileError, match=r"pip install 'semispline\[(cad|view)\]'"):
        write_surface(path, patch())
    assert not path.exists()
    if suffix != ".stl":
        path.write_text("x")
        with pytest.raises(FileError, match=r"pip install 'semispline\[cad\]'"):
            read_surface(path)


def test_numbers_and_names(tmp_path):
    path = tmp_path / "s.json"
    write_surface(path, patch())
    odd = tmp_path / "s.json#7"
    odd.write_bytes(path.read_bytes())
    assert split_spec(odd) == (str(odd), None)
    assert_same(read_surface(f"{path}#0"), patch())
    cases = {
        f"{path}#1": "no such surface; the file holds 1, numbered 0 to 0",
        f"{path}#-1": "found '-1' after #",
        f"{path}#": "found '' after #",
        f"{path}#x": "found 'x' after #",
        f"{path}#1.0": "found '1.0' after #",
        f"{tmp_path}/none.json": "no such file",
        f"{tmp_path}/none.step#3": "no such file",
        f"{tmp_path}": "not a regular file",
        f"{odd}": "suffix '.json#7' cannot be read",
    }
    for spec, words in cases.items():
        with pytest.raises(FileError) as caught:
            read_surface(spec)
        assert words in str(caught.value)


def test_a_file_of_many_surfaces_says_how_to_choose(impeller):
    with pytest.raises(FileError) as caught:
        picked(impeller, None)
    assert "277 surfaces" in str(caught.value)
    assert "semispline list" in str(caught.value)


def test_unknown_suffixes_are_refused_before_anything_is_done(tmp_path):
    for name in ("s", "s.txt", "s.json.gz"):
        with pytest.raises(FileError, match="suffix"):
            write_surface(tmp_path / name, patch())
    with pytest.raises(InputError, match="does not exist"):
        write_surface(tmp_path / "none" / "s.step", patch())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".glb", ".gltf"])
def test_meshes_lie_on_the_surface(tmp_path, suffix):
    import pyvista

    # A quarter of a cylinder of radius 1 about z, with a double point at one corner of its net.
    net = np.array([[[1, 0, 0], [1, 0, 2]], [[1, 1, 0], [1, 1, 2]], [[0, 1, 0], [0, 1, 2.0]]])
    half = math.sqrt(0.5)
    quarter = BSplineSurface(2, 1, [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], net, [[1, 1], [half, half], [1, 1]])
    path = tmp_path / f"mesh{suffix}"
    write_surface(path, quarter)
    mesh = pyvista.read(str(path))
    while isinstance(mesh, pyvista.MultiBlock):
        mesh = mesh[0]
    assert mesh.n_cells > 1000
    # Single precision in most of these formats.
    np.testing.assert_allclose(np.linalg.norm(mesh.points[:, :2], axis=1), 1.0, rtol=0, atol=1e-6)
    np.testing.assert_allclose(mesh.bounds, [0, 1, 0, 1, 0, 2], atol=1e-6)
    assert mesh.area == pytest.approx(math.pi, rel=1e-4)
    if suffix != ".stl":
        normal = mesh.point_data.active_normals
        np.testing.assert_allclose(np.abs(np.sum(normal[:, :2] * mesh.points[:, :2], axis=1)), 1.0, atol=1e-5)
    if suffix == ".gltf":
        assert all(buffer["uri"].startswith("data:") for buffer in json.loads(path.read_text())["buffers"])


def test_meshes_of_collapsed_surfaces_have_no_empty_triangles(tmp_path):
    import pyvista

    write_surface(tmp_path / "mesh.ply", patch(collapsed=True))
    mesh = pyvista.read(str(tmp_path / "mesh.ply"))
    assert np.isfinite(mesh.point_data.active_normals).all()
    assert mesh.compute_cell_sizes()["Area"].min() > 0


@pytest.mark.parametrize("suffix", [".step", ".igs", ".brep", ".3dm"])
def test_several_surfaces_stay_in_their_order(tmp_path, suffix, read_here):
    path = tmp_path / f"three{suffix}"
    rational = revolve(BSplineCurve(1, [0, 0, 1, 1], [[2, 0, 0], [3, 0, 1]]), (0, 0, 0), (0, 0, 1))
    three = [patch(), rational, plane([0, 0, 5], [1, 0, 0], [0, 2, 0])]
    write_surfaces(path, three, "cm")
    assert len(list_surfaces(path)) == 3
    for number, surface in enumerate(three):
        found = read_surface(f"{path}#{number}")
        assert found.control_points == pytest.approx(surface.control_points, rel=1e-14, abs=1e-14)
        assert found.is_rational == surface.is_rational


def test_a_mesh_holds_all_surfaces_and_json_one(tmp_path):
    floor, shelf = (plane([0, 0, z], [1, 0, 0], [0, 2, 0]) for z in (0, 5))
    write_surfaces(tmp_path / "two.ply", [floor, shelf])
    assert pyvista.read(tmp_path / "two.ply").bounds[4:] == pytest.approx((0, 5))
    with pytest.raises(FileError, match=r"\.json holds one surface, expected \.step .* for 2"):
        write_surfaces(tmp_path / "two.json", [floor, shelf])
    assert not (tmp_path / "two.json").exists()
