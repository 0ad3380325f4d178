"""Contacts moved into the faces of parts: how far, as far as which edges, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeHalfSpace,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeWedge,
)
from OCP.gp import gp_Dir, gp_Pln, gp_Pnt, gp_Vec

from helpers.parts import written
from helpers.sweeps import first_rows
from semispline import EdgeError, OptionError, blend_edges, list_edges, plane, write_surface
from semispline.solver.splines import cut_to_edge, parse_edge
from semispline.solver.topology import moved_edges, parse_cut
from semispline.solver.topology.cuts import moved_contact
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.outlines import outline_of
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.trim_curves import read_trim_curves

pytestmark = pytest.mark.usefixtures("read_here")


@pytest.fixture
def pin(tmp_path):
    """A cylinder of radius 5 and height 8: #0 is round, #1 the upper plane."""
    return written(BRepPrimAPI_MakeCylinder(5.0, 8.0).Shape(), tmp_path / "pin.brep")


def slanted_pin():
    """A cylinder of radius 5, cut off by the plane z = 8 + x / 2."""
    half_space = BRepPrimAPI_MakeHalfSpace(
        BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 8), gp_Dir(-0.5, 0, 1))).Face(), gp_Pnt(0, 0, 50)
    )
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(5.0, 20.0).Shape(), half_space.Solid()).Shape()


def specs(path, a=0, b=1):
    return f"{path}#{a}", f"{path}#{b}"


def edge_points(end):
    """Points of the natural edge that a base has."""
    part, natural = cut_to_edge(end.surface, end.edge)
    axis = "uv".index(natural[0])
    along = np.linspace(*part.domain[1 - axis], 9)
    at = np.full(9, part.domain[axis][int(natural[1])])
    return part.evaluate(*((at, along) if axis == 0 else (along, at)))


def free_points(end):
    """Points of the free curve that a contact was moved to."""
    along = np.linspace(*end.curve.pcurve.knots[[0, -1]], 50)
    # It may run on over a seam.
    return Face(end.surface).jet(end.curve.pcurve.evaluate(along)[:, :2], 0)[0, 0]


@pytest.mark.long
def test_a_rim_is_moved_into_both_faces(pin):
    a, b = moved_edges(specs(pin), (None, None), ("1.5", "2"))
    assert edge_points(a)[:, 2] == pytest.approx(6.5, abs=1e-12)
    assert (a.curve, a.said) == (None, f"e0 of {pin}#0 moved to v=6.5-, 1.5 inside")
    # A circle in a plane is no line of constant parameter: it becomes a free curve, concentric.
    assert b.is_free
    assert b.said == f"e0 of {pin}#1 moved to a free curve, 2 inside"
    points = free_points(b)
    # Interpolated: a hundredth of what a free contact may be off its edge, 1e-5 of the length.
    assert np.linalg.norm(points[:, :2], axis=1) == pytest.approx(3.0, abs=1e-7 * 6 * np.pi)
    assert points[:, 2] == pytest.approx(8.0, abs=1e-12)
    (result,) = blend_edges(a, b)
    assert result.warnings == ()
    assert result.band_b.gap <= 1e-12
    # It lies on the side of the material: below the plane and inside of the cylinder.
    inner = result.surface.to_bspline().evaluate(np.full(5, 0.5), np.linspace(*result.surface.domain[1], 5))
    assert (np.linalg.norm(inner[:, :2], axis=1) < 5).all()
    assert (inner[:, 2] < 8).all()


@pytest.mark.parametrize(
    ("cuts", "words"),
    first_rows(
        1,
        [
            (("8.5", "1"), r"--cut-a 8.5: 8.5 reaches beyond the face, expected a distance below 8$"),
            (("1", "5.5"), r"--cut-b 5.5: 5.5 reaches beyond the face, expected a distance below 5$"),
            (("v=9", "1"), r"--cut-a v=9: v=9 lies beyond the face, expected v between 0 and 8$"),
            (("v=-1", "1"), r"--cut-a v=-1: v=-1 lies beyond the face"),
            (("u=1", "1"), r"--cut-a u=1: found u, but along the edge v1 v is constant"),
            (
                ("1", "u=1"),
                r"--cut-b u=1: the edge is a free curve, along which no parameter is constant; give a distance",
            ),
        ],
    ),
)
def test_beyond_the_face_the_largest_distance_is_said(pin, cuts, words):
    with pytest.raises(EdgeError, match=words):
        moved_edges(specs(pin), (None, None), cuts)


def test_just_within_is_taken(pin):
    a, b = moved_edges(specs(pin), (None, None), ("7.999", "4.99"))
    assert parse_edge(a.edge).at == pytest.approx(0.001, abs=1e-12)
    assert b.is_free


def test_a_parameter_and_one_contact_that_stays(pin):
    a, b = moved_edges(specs(pin), (None, None), ("v=3", None))
    assert (a.edge, b.curve, b.edge) == ("v=3-", None, "e0")


@pytest.mark.long
def test_a_slanted_face_is_cut_as_far_as_its_edges(tmp_path):
    """Across a wedge that is 10 wide below and 4 above, 6 high: one unit up it is 9 wide."""
    path = written(BRepPrimAPI_MakeWedge(10.0, 6.0, 8.0, 4.0).Shape(), tmp_path / "wedge.brep")
    widths = []
    for face in range(6):
        for entry in list_edges(path, face).edges:
            along = np.subtract(entry.end, entry.start)
            if abs(entry.length - 10) > 1e-9 or entry.neighbour is None:
                continue
            end, _ = moved_edges(specs(path, face, entry.neighbour), (None, None), ("1", "1"))
            points = edge_points(end)
            widths.append(float(np.linalg.norm(points[-1] - points[0])))
            assert np.cross(points[-1] - points[0], along) == pytest.approx(np.zeros(3), abs=1e-9)
    # Two edges of 10, each in a rectangle and in a trapezium.
    assert sorted(widths) == pytest.approx([9.0, 9.0, 10.0, 10.0])


@pytest.mark.long
def test_beside_a_corner_that_juts_into_the_face_a_contact_ends_where_its_edge_does(tmp_path):
    """On an L of arms 5 broad, the lines one inside of both edges at the inner corner run on into the other arm."""
    corner = BRepPrimAPI_MakeBox(gp_Pnt(5.0, 5.0, -1.0), 9.0, 9.0, 9.0).Shape()
    path = written(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(10.0, 10.0, 4.0).Shape(), corner).Shape(), tmp_path / "l.brep")
    edges = next(edges for face in range(8) if len((edges := list_edges(path, face)).edges) == 6)
    found = []
    for entry in edges.edges:
        end, _ = moved_edges(specs(path, edges.face, entry.neighbour), (None, None), ("1", "1"))
        points = edge_points(end)
        found.append((entry.length, float(np.linalg.norm(points[-1] - points[0]))))
    # Two long edges, two at the ends of the arms, two at the inner corner.
    assert np.array(sorted(found)) == pytest.approx(np.array([(5.0, 5.0)] * 4 + [(10.0, 10.0)] * 2))


@pytest.mark.long
def test_a_distance_on_a_cone_is_one_along_its_lines(tmp_path):
    path = written(BRepPrimAPI_MakeCone(5.0, 2.0, 4.0).Shape(), tmp_path / "cone.brep")
    # Its lines fall by 3 on 4, and are 5 long.
    end, _ = moved_edges(specs(path, 0, 1), (None, None), ("2", "1"))
    points = edge_points(end)
    assert np.linalg.norm(points[:, :2], axis=1) == pytest.approx(2.0 + 2 * 3 / 5, abs=1e-12)
    with pytest.raises(EdgeError, match=r"expected a distance below 5$"):
        moved_edges(specs(path, 0, 1), (None, None), ("5.01", "1"))


def test_surfaces_without_faces_are_cut_up_to_their_ends(tmp_path):
    floor, wall = tmp_path / "floor.json", tmp_path / "wall.json"
    write_surface(floor, plane([0, 0, 0], [4, 0, 0], [0, 5, 0]))
    write_surface(wall, plane([4, 0, 0], [0, 0, 3], [0, 5, 0]))
    a, b = moved_edges((str(floor), str(wall)), ("u1", "u0"), ("1", "0.5"))
    assert edge_points(a)[:, 0] == pytest.approx(3.0)
    assert edge_points(b)[:, 2] == pytest.approx(0.5)
    with pytest.raises(EdgeError, match=r"--cut-b 3.5: .* below 3$"):
        moved_edges((str(floor), str(wall)), ("u1", "u0"), ("1", "3.5"))
    with pytest.raises(EdgeError, match="only two faces of one file, PATH#N and PATH#M, can share one"):
        moved_edges((str(floor), str(wall)), (None, None), ("1", "1"))


def test_faces_that_share_no_edge_or_several(tmp_path):
    path = written(BRepPrimAPI_MakeBox(2.0, 3.0, 5.0).Shape(), tmp_path / "box.brep")
    with pytest.raises(EdgeError, match=r"#0 and .*#1 share no edge"):
        moved_edges(specs(path, 0, 1), (None, None), ("0.5", "0.5"))
    with pytest.raises(EdgeError, match="--edge-b: found one edge of two"):
        moved_edges(specs(path, 0, 2), ("e0", None), ("0.5", "0.5"))


@pytest.mark.parametrize("word", ["", "0", "-1", "nan", "inf", "u=", "w=1", "u=nan", "1,2", "u=0.3+"])
def test_words_of_cuts_that_mean_nothing(word):
    with pytest.raises(OptionError, match=r"--cut-a: found .*, expected a distance above 0 in model units, as 2.5"):
        parse_cut(word, "--cut-a")


@pytest.mark.long
@pytest.mark.parametrize("turns", [-1, 0, 1])
def test_a_curve_that_is_taken_over_another_turn_is_moved_all_the_same(tmp_path, turns):
    path = written(slanted_pin(), tmp_path / "slanted.brep")
    graph = read_edges(path)
    row = next(x for x in range(len(graph.uses)) if graph.faces.kind[graph.uses.face[x]] == "cylinder"
               and graph.uses.pcurve[x] not in ("line", "none"))  # fmt: skip
    face, number = int(graph.uses.face[row]), int(graph.uses.number[row])
    (trim,) = read_trim_curves(path, [(face, number)])
    (period,) = np.ptp(trim.surface.domain[0], keepdims=True)
    away = np.array([turns * period, 0.0, 0.0])
    turned = replace(trim, pcurve=replace(trim.pcurve, control_points=trim.pcurve.control_points + away))
    outline = outline_of(graph, row, trim.surface, {row: turned})
    moved = moved_contact(trim.surface, None, parse_cut("1"), outline, 1e-6, "cut", "e0")
    points = Face(trim.surface).jet(
        moved.curve.pcurve.evaluate(np.linspace(*moved.curve.pcurve.knots[[0, -1]], 60))[:, :2], 0
    )
    slope, x = 0.5, points[0, 0][:, 0]
    # In the rolled-out cylinder the edge is z = 8 + x / 2; no point of it is nearer than 1, some are that near.
    across = np.linspace(-np.pi, np.pi, 4001)
    edge = np.column_stack([5 * across, 8 + slope * 5 * np.cos(across)])
    at = np.column_stack([5 * np.arctan2(points[0, 0][:, 1], x), points[0, 0][:, 2]])
    inner = np.abs(at[:, 0]) < 12
    away = np.linalg.norm(at[inner, None] - edge, axis=2).min(axis=1)
    # Of an edge that is a polyline of steps of 0.008.
    assert away == pytest.approx(1.0, abs=1e-4)
    assert (at[:, 1] < 8 + slope * x).all()


@pytest.mark.long
def test_a_straight_edge_that_slants_in_a_plane_is_moved(tmp_path):
    """Below a prism over the triangle (0, 0), (10, 0), (3, 7), each side is moved into the triangle by one."""
    corners = np.array([[0.0, 0.0], [10.0, 0.0], [3.0, 7.0]])
    outline = BRepBuilderAPI_MakePolygon()
    for x, y in corners:
        outline.Add(gp_Pnt(x, y, 0.0))
    outline.Close()
    floor = BRepBuilderAPI_MakeFace(outline.Wire()).Face()
    path = written(BRepPrimAPI_MakePrism(floor, gp_Vec(0.0, 0.0, 4.0)).Shape(), tmp_path / "prism.brep")
    face = next(n for n in range(5) if len(edges := list_edges(path, n).edges) == 3)
    for entry in edges:
        end, _ = moved_edges(specs(path, face, entry.neighbour), (None, None), ("1", "1"))
        points = edge_points(end) if end.curve is None else free_points(end)
        along = np.subtract(entry.end, entry.start)
        away = np.linalg.norm(np.cross(points - np.array(entry.start), along / np.linalg.norm(along)), axis=1)
        # Interpolated, where it is a free contact.
        assert away == pytest.approx(1.0, abs=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("far", ["31", "1000"])
def test_the_largest_distance_does_not_hang_on_the_one_that_was_asked(far, tmp_path):
    # The shortest ruling of the slanted pin is 8 - 5 / 2 long.
    path = written(slanted_pin(), tmp_path / "part.brep")
    round_one = next(k for k in range(3) if len(list_edges(path, k).edges) > 1)
    slanted = next(e for e in list_edges(path, round_one).edges if e.kind == "free")
    words = specs(path, round_one, slanted.neighbour)
    with pytest.raises(EdgeError, match=rf"--cut-a {far} .*: {far} reaches beyond the face, .* below 5.5$|below 5.5$"):
        moved_edges(words, (None, None), (far, None))
    a, _ = moved_edges(words, (None, None), ("5.4", None))
    assert 0.1 - 1e-6 <= free_points(a)[:, 2].min() < 0.11


@pytest.mark.slow
@pytest.mark.parametrize("far", ["7", "15", "1000"])
def test_contacts_that_would_run_over_a_pole_are_refused_before_it(far, tmp_path):
    # A cap that holds the upper pole is cut off, and lies away from the seam.
    axis = np.array([-0.8, 0.2, 0.3]) / np.linalg.norm([0.8, 0.2, 0.3])
    cutter = BRepPrimAPI_MakeHalfSpace(
        BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(*(3.0 * axis)), gp_Dir(*axis))).Face(), gp_Pnt(*(50.0 * axis))
    )
    shape = BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(10.0).Shape(), cutter.Solid()).Shape()
    path = written(shape, tmp_path / "part.brep")
    kinds = [list_edges(path, k).kind for k in range(2)]
    words = specs(path, kinds.index("sphere"), kinds.index("plane"))
    # From the rim to the lower pole along a great circle.
    pole = 10 * (np.arccos(-axis[2]) - np.arccos(0.3))
    with pytest.raises(EdgeError, match=r"reaches .* the face, expected a distance below") as said:
        moved_edges(words, (None, None), (far, None))
    largest = float(str(said.value).rpartition(" ")[2])
    # By 41 paths the pole is seen a little late or early.
    assert largest == pytest.approx(pole, rel=0.02)
    a, _ = moved_edges(words, (None, None), (f"{0.95 * largest:.6g}", None))
    assert free_points(a) @ axis == pytest.approx(10 * np.cos(np.arccos(0.3) + 0.095 * largest), abs=1e-4)


def test_one_face_shares_no_edge_with_itself(pin):
    with pytest.raises(EdgeError, match=r"expected two edges of .*#0: a face shares no edge with itself"):
        moved_edges(specs(pin, 0, 0), (None, None), ("1", None))
