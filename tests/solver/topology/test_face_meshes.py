"""Trimmed faces in triangles: their area against the kernel's, their edges, and what cannot be trimmed."""

import numpy as np
import pytest
import rhino3dm
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from scipy.spatial import KDTree

from helpers.circles import cylinder, full_circle
from helpers.drilled import WHOLE, drilled_part
from helpers.parts import written
from semispline import FileError, list_edges, plane, write_surface
from semispline.solver.io.occ import _faces
from semispline.solver.topology import drawn_faces
from semispline.solver.topology.drawn_faces import natural_edges, read_drawn
from semispline.solver.topology.face_meshes import FaceMesh, grid_within
from semispline.solver.topology.rhino_meshes import _through_poles

pytestmark = pytest.mark.usefixtures("reads_here")

FLOOR = plane([0, 0, 0], [1, 0, 0], [0, 1, 0])
SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])


def area_of(surface, mesh):
    points = surface.evaluate(*mesh.within(surface))
    a, b, c = (points[corner] for corner in mesh.triangles.T)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def kernel_area(face):
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, found)
    return found.Mass()


@pytest.fixture(scope="module", params=sorted(WHOLE))
def drilled_file(request, tmp_path_factory):
    """The faces of a drilled part as the kernel made them, its file, and what is read of that."""
    shape = drilled_part(request.param)
    path = str(written(shape, tmp_path_factory.mktemp(request.param) / "part.brep"))
    return list(_faces(shape)), path, read_drawn([path])


def test_the_area_of_each_face_is_the_kernels(drilled_file):
    kernel, _, (faces, said) = drilled_file
    assert said == []
    assert [face.number for face in faces] == list(range(len(kernel)))
    for face, known in zip(faces, kernel, strict=True):
        # The triangles turn by a tenth, and leave out a sixth of its square: 2e-3; those of a hole's border as much.
        assert area_of(face.surface, face.mesh) == pytest.approx(kernel_area(known), rel=5e-3)


@pytest.mark.long
def test_finer_triangles_come_nearer(drilled_file):
    kernel, _, (faces, _) = drilled_file
    for face, known in zip(faces, kernel, strict=True):
        fine = face.mesh.finer(face.surface, 2.0, 1_000_000)
        points = face.surface.evaluate(*fine.within(face.surface))
        sides = points[fine.triangles] - points[np.roll(fine.triangles, 1, axis=1)]
        assert np.linalg.norm(sides, axis=2).max() <= 2.0
        off = [abs(area_of(face.surface, mesh) / kernel_area(known) - 1) for mesh in (face.mesh, fine)]
        # What is left is the border, of chords.
        assert off[1] <= off[0] * (1 + 1e-9) + 1e-12
        assert face.mesh.finer(face.surface, 1e-6, len(face.mesh.triangles)).triangles is face.mesh.triangles


def test_edges_have_the_names_that_list_gives_them(drilled_file):
    _, path, (faces, _) = drilled_file
    face = max(faces, key=lambda face: len(face.edges))
    listed = {edge.name: edge for edge in list_edges(path, face.number).edges if edge.kind != "point"}
    assert [line.name for line in face.edges] == list(listed)
    corners = KDTree(face.surface.evaluate(*face.mesh.within(face.surface)))
    for line in face.edges:
        entry = listed[line.name]
        chords = float(np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum())
        # Chords of arcs of a tenth are shorter by a 24th of its square: 4e-4.
        assert chords == pytest.approx(entry.length, rel=2e-3)
        ends, known = line.points[[0, -1]], np.array([entry.start, entry.end])
        assert min(np.abs(ends - known).max(), np.abs(ends[::-1] - known).max()) < 1e-6
        # Of a converted surface the parameters are others than the kernel's: the triangles reach the edges.
        assert corners.query(line.points)[0].max() < 1e-6


@pytest.fixture
def cone_file(tmp_path):
    return str(written(drilled_part("cone"), tmp_path / "part.brep"))


def test_one_face_is_read_alone(cone_file):
    (face,), _ = read_drawn([f"{cone_file}#1"])
    assert (face.spec, face.path, face.number) == (f"{cone_file}#1", cone_file, 1)
    with pytest.raises(FileError, match=r"#99: no such surface; the file holds"):
        read_drawn([f"{cone_file}#99"])


def test_without_a_mesher_faces_are_drawn_whole(cone_file, monkeypatch):
    real = drawn_faces.read_apart

    def broken(path, module, kernel, words):
        if words[0] == "trimmed":
            raise FileError("Open CASCADE needed more than 5 s")
        return real(path, module, kernel, words)

    monkeypatch.setattr(drawn_faces, "read_apart", broken)
    faces, (sentence,) = read_drawn([cone_file])
    assert "drawn without the trims of its faces, which cannot be meshed (Open CASCADE needed" in sentence
    assert {face.mesh for face in faces} == {None}
    assert all(face.edges[0].name == "e0" for face in faces)


def test_units_become_one(tmp_path):
    write_surface(tmp_path / "a.step", FLOOR, "mm")
    write_surface(tmp_path / "b.step", FLOOR, "in")
    for order in ("ab", "ba"):
        faces, _ = read_drawn([str(tmp_path / f"{name}.step") for name in order])
        lengths = [float(np.ptp(face.edges[0].points, axis=0).max()) for face in faces]
        assert lengths == pytest.approx([1, 25.4] if order == "ab" else [1, 1 / 25.4])
        assert {face.loaded.unit for face in faces} == {"mm" if order == "ab" else "in"}
        assert {face.number for face in faces} == {None}


def test_a_surface_without_a_face_has_its_own_edges(tmp_path):
    write_surface(tmp_path / "a.json", FLOOR)
    (face,), said = read_drawn([str(tmp_path / "a.json")])
    assert (face.mesh, said, [line.name for line in face.edges]) == (None, [], ["u0", "u1", "v0", "v1"])
    # That of a cone's tip is a point.
    tip = plane([0, 0, 0], [1, 0, 0], [0, 1, 0])
    net = tip.control_points.copy()
    net[0] = net[0, 0]
    pointed = type(tip)(1, 1, tip.knots_u, tip.knots_v, net)
    assert [line.name for line in natural_edges(pointed)] == ["u1", "v0", "v1"]


def shoelace(loop):
    x, y = loop.T
    return abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))) / 2


@given(st.lists(st.floats(0.1, 0.45), min_size=3, max_size=9))
def test_a_star_is_cut_out_of_a_plane(radii):
    turns = np.arange(len(radii)) * 2 * np.pi / len(radii)
    star = 0.5 + np.array(radii)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    inside, around = grid_within(FLOOR, [star], [False, False]), grid_within(FLOOR, [SQUARE, star], [False, False])
    # A corner is cut off within a cell, whose side is a 63rd of the box: a few of its area each.
    allowed = 4 * len(radii) / 63**2
    assert area_of(FLOOR, inside) == pytest.approx(shoelace(star), abs=allowed)
    assert area_of(FLOOR, around) == pytest.approx(1 - shoelace(star), abs=allowed)


def test_straight_borders_of_the_domain_are_exact():
    mesh = grid_within(FLOOR, [SQUARE * [0.5, 1] + [0.25, 0]], [False, False])
    # Rounding of the products of thousands of triangles.
    assert area_of(FLOOR, mesh) == pytest.approx(0.5, rel=1e-12)
    assert mesh.parameters[mesh.triangles].reshape(-1, 2).min(axis=0).tolist() == [0.25, 0.0]


def test_a_hole_across_a_seam_goes_on_behind_it():
    tube = cylinder(full_circle(4))
    # v is the angle, 0 to 1; the outer loop goes round from seam to seam.
    (u0, u1), (v0, v1) = tube.domain
    whole = np.array([[u0, v0], [u0, v1], [u1, v1], [u1, v0], [u0, v0]])
    hole = np.array([[0.4, -0.1], [0.6, -0.1], [0.6, 0.15], [0.4, 0.15]])
    for shift in (0.0, 1.0):
        mesh = grid_within(tube, [whole, hole + np.array([0, shift])], [False, True])
        full = 2 * np.pi
        middle = tube.evaluate(np.array([0.5]), np.array([0.02]))
        # The parameter is no angle: of the quarter from 0 on 0.15 of 0.25, and 0.1 of that before.
        part = float(
            np.linalg.norm(np.diff(tube.evaluate(np.full(99, 0.5), np.linspace(0, 0.15, 99)), axis=0), axis=1).sum()
        )
        part += float(
            np.linalg.norm(np.diff(tube.evaluate(np.full(99, 0.5), np.linspace(0.9, 1, 99)), axis=0), axis=1).sum()
        )
        assert area_of(tube, mesh) == pytest.approx(full - 0.2 * part, rel=2e-3)
        points = tube.evaluate(*mesh.within(tube))
        used = points[np.unique(mesh.triangles)]
        assert np.linalg.norm(used - middle, axis=1).min() > 0.08


def test_parameters_beyond_a_seam_are_those_within():
    tube = cylinder(full_circle(4))
    low, high = tube.domain[1]
    mesh = FaceMesh(
        np.array([[0.5, low - 0.25], [0.5, high + 0.25], [0.5, high], [1 + 1e-12, low]]), np.zeros((0, 3), int)
    )
    u, v = mesh.within(tube)
    assert v.tolist() == [high - 0.25, low + 0.25, high, low]
    assert u[-1] == 1.0


def test_a_loop_through_poles_turns_there():
    # A wedge of 250 degrees from pole to pole: at the poles the angle is that of the points beside, not what was found.
    wide = 250 / 360
    up, down = np.linspace(0, 1, 9), np.linspace(1, 0, 9)
    loop = np.concatenate([np.stack([up, 0 * up], axis=1), np.stack([down, wide + 0 * down], axis=1)])
    loop[[8, 9, 17, 0], 1] = 0.5, 0.9, 0.3, 0.7
    in_pole = (loop[:, 0] == 0) | (loop[:, 0] == 1)
    found = _through_poles(loop, in_pole, 1, 1.0)
    np.testing.assert_allclose(found[0], found[-1], atol=1e-15)
    # Of the two wedges that these edges bound it is one or the other, a whole turn apart.
    assert shoelace(found) in (pytest.approx(wide), pytest.approx(1 - wide))
    # Up and down one seam: all of the sphere.
    loop[:, 1] = np.where(in_pole, loop[:, 1], 0.0)
    assert shoelace(_through_poles(loop, in_pole, 1, 1.0)) == pytest.approx(1.0)


@pytest.mark.long
def test_a_face_of_a_3dm_file_is_cut_along_its_edges(tmp_path):
    file = rhino3dm.File3dm()
    circle = rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 2.0).ToNurbsCurve()
    file.Objects.AddBrep(rhino3dm.Brep.CreateTrimmedPlane(rhino3dm.Plane.WorldXY(), circle))
    file.Objects.AddBrep(rhino3dm.Sphere(rhino3dm.Point3d(9, 0, 0), 1.0).ToBrep())
    path = str(tmp_path / "disc.3dm")
    assert file.Write(path, 7)
    (disc, ball), said = read_drawn([path])
    assert said == []
    assert ball.mesh is None
    # Chords of a fortieth of the circle leave out 4e-3 of the disc.
    assert area_of(disc.surface, disc.mesh) == pytest.approx(4 * np.pi, rel=6e-3)
    listed = list_edges(path, 0).edges
    assert [line.name for line in disc.edges] == [edge.name for edge in listed]
    for line, edge in zip(disc.edges, listed, strict=True):
        np.testing.assert_allclose(line.points[[0, -1]], [edge.start, edge.end], atol=1e-9)


def test_a_part_without_a_face_that_can_be_used(tmp_path):
    file = rhino3dm.File3dm()
    file.Objects.AddPoint(rhino3dm.Point3d(0, 0, 0))
    assert file.Write(str(tmp_path / "p.3dm"), 7)
    with pytest.raises(FileError, match="no surfaces: 1 point"):
        read_drawn([str(tmp_path / "p.3dm")])


@pytest.mark.long
def test_faces_of_real_files_have_the_kernels_area(shared):
    from semispline.solver.io.occ import read_occ

    for name in ("occt_bottle.brep", "demos_as1_pe_203.stp", "occt_screw.step"):
        path = str(shared / "data" / "cad" / name)
        faces, said = read_drawn([path])
        assert said == []
        for face, known in zip(faces, read_occ(path).faces, strict=True):
            # Small faces of large parts are coarse, as they are drawn.
            assert area_of(face.surface, face.mesh) == pytest.approx(kernel_area(known.face), rel=0.05)


@pytest.mark.long
def test_the_mug_has_its_holes(shared):
    """Its wall has two sides on one surface, and the loop of its seam runs through two poles."""
    path = str(shared / "data" / "cad" / "v4_DinerMug.3dm")
    stored = rhino3dm.File3dm.Read(path)
    brep = next(item.Geometry for item in stored.Objects if isinstance(item.Geometry, rhino3dm.Brep))
    known = []
    for k in range(len(brep.Faces)):
        mesh = brep.Faces[k].GetMesh(rhino3dm.MeshType.Render)
        points = np.array([(p.X, p.Y, p.Z) for p in mesh.Vertices])
        quads = np.array([tuple(mesh.Faces[i]) for i in range(len(mesh.Faces))])
        triangles = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
        a, b, c = (points[corner] for corner in triangles.T)
        known.append(float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2))
    found = [area_of(face.surface, face.mesh) for face in read_drawn([path])[0] if face.mesh is not None]
    assert len(found) == 2
    for area in found:
        # Its own mesh is coarse; without its holes the wall would be 3 % larger.
        assert min(abs(area / other - 1) for other in known) < 0.01
