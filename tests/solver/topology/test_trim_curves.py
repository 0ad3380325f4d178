"""Edges of faces of Open CASCADE as curves, and bands along them: made parts whose free edges are known."""

import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepClass import BRepClass_FaceClassifier
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere
from OCP.collections import HArray1_gp_Pnt2d
from OCP.Geom import Geom_Plane
from OCP.Geom2dAPI import Geom2dAPI_Interpolate
from OCP.gp import gp_Dir, gp_Pnt, gp_Pnt2d
from OCP.TopAbs import TopAbs_State

from helpers.drilled import WHOLE, drilled_part
from helpers.free_curves import seen_by_open_cascade
from helpers.parts import graph_of, written
from helpers.sweeps import first_ones
from semispline import BSplineCurve, BSplineSurface, EdgeError, FileError
from semispline.solver.io.occ import OccFace, _faces
from semispline.solver.judge import measure_face_contact
from semispline.solver.topology.occ_curves import face_curves
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves


def free_edges(shape):
    """Free edges of the faces of a shape that are no planes: face, number of the edge, and the table of all edges."""
    graph = graph_of(shape)
    uses = graph.uses
    extent = np.ptp(uses.uv, axis=1)
    free = (extent > 1e-3).all(axis=1) & ~uses.degenerate
    return graph, np.flatnonzero(free).tolist()


def curves_of(shape, face, numbers):
    item = OccFace(
        list(_faces(shape))[face].face if hasattr(list(_faces(shape))[face], "face") else list(_faces(shape))[face],
        "part",
    )
    content, found = face_curves(item, numbers)
    made = []
    for number, (edge, pcurve, keep, tolerance) in zip(numbers, found, strict=True):
        in_space, flat = (None if x is None else BSplineCurve(*x) for x in (edge, pcurve))
        made.append(TrimCurve(f"e{number}", BSplineSurface(*content), in_space, flat, keep, tolerance, 1.0))
    return item, made


@pytest.mark.long
@pytest.mark.parametrize(
    ("kind", "turned"),
    # Turned, make test takes one face that is bent both ways, .ci/run all of them.
    [
        pytest.param(kind, turned, marks=[pytest.mark.slow] if turned != (kind == "torus") else [])
        for kind in WHOLE
        for turned in (False, True)
    ],
)
def test_bands_along_holes_meet_their_limits_and_lead_into_the_face(kind, turned):
    shape = drilled_part(kind)
    shape = shape.Reversed() if turned else shape
    graph, uses = free_edges(shape)
    assert uses
    for use in uses[:6]:
        face = int(graph.uses.face[use])
        item, (curve,) = curves_of(shape, face, [int(graph.uses.number[use])])
        bands = curve.bands()
        for band in bands:
            seen = measure_face_contact(band.base, curve.surface, same_side=True)
            limit = min(1e-5 * band.length, 1e-3)
            assert seen.gap <= limit
            assert seen.angle_degrees <= 0.01
            assert seen.curvature_jump_relative <= 0.02
            kernel = seen_by_open_cascade(band.surface, item._geometry)
            assert kernel.gap <= limit
            assert kernel.angle_degrees <= 0.01
            # The direction, by the kernel's classifier of trimmed faces and by the table of edges.
            check_direction(band, item)
        walked = graph.uses.points[use]
        v = np.concatenate([b.surface.evaluate(np.zeros(400), np.linspace(*b.surface.domain[1], 400)) for b in bands])
        assert np.linalg.norm(walked[:, None] - v, axis=2).min(axis=1).max() <= 0.01 * sum(b.length for b in bands)


def check_direction(band, item):
    """Points of the band beside the edge are on the trimmed face, and those on the other side are not."""
    v = np.linspace(*band.surface.domain[1], 9)[1:-1]
    points, into = band.surface.evaluate(np.zeros(7), v), band.surface.evaluate(np.zeros(7), v, 1, 0)
    classifier = BRepClass_FaceClassifier()
    for side, expected in ((1, TopAbs_State.TopAbs_IN), (-1, TopAbs_State.TopAbs_OUT)):
        for point in points + side * 1e-3 * band.length * into:
            classifier.Perform(item.face, gp_Pnt(*map(float, point)), 1e-7)
            assert classifier.State() == expected


@pytest.mark.long
def test_planes_of_a_box_are_exact():
    shape = drilled_part("plane")
    graph, uses = free_edges(shape)
    planes = [i for i in uses if graph.faces.kind[graph.uses.face[i]] == "plane"]
    assert planes
    for use in planes:
        _, (curve,) = curves_of(shape, int(graph.uses.face[use]), [int(graph.uses.number[use])])
        for band in curve.bands():
            assert band.is_plane
            assert measure_face_contact(band.base, curve.surface, same_side=True).angle_degrees <= 1e-9


@pytest.mark.long
def test_edges_are_read_by_a_process_of_its_own(tmp_path):
    shape = drilled_part("cylinder")
    path = written(shape, tmp_path / "part.brep")
    graph, uses = free_edges(shape)
    use = next(i for i in uses if graph.faces.kind[graph.uses.face[i]] == "cylinder")
    face, number = int(graph.uses.face[use]), int(graph.uses.number[use])
    (curve,) = read_trim_curves(path, [(face, number)])
    assert curve.name == f"edge e{number} of face {face}"
    # BREP files have no unit.
    assert curve.millimetres is None
    (band,) = curve.bands()
    assert band.source == "foot"
    assert band.edge_to_face <= curve.tolerance
    # What the process raises comes through.
    with pytest.raises(FileError, match="faces, counted from 0"):
        read_trim_curves(path, [(99, 0)])


@pytest.mark.usefixtures("read_here")
def test_edges_that_are_no_curves_are_refused(tmp_path):
    shape, _ = WHOLE["cylinder"]
    cylinder = written(shape(), tmp_path / "part.brep")
    with pytest.raises(EdgeError, match=r"e99: the face has \d+ edges"):
        read_trim_curves(cylinder, [(0, 99)])
    degenerate = graph_of(BRepPrimAPI_MakeSphere(8.0).Shape()).uses
    ball = written(BRepPrimAPI_MakeSphere(8.0).Shape(), tmp_path / "ball.brep")
    with pytest.raises(EdgeError, match="it is a point; choose another edge"):
        read_trim_curves(ball, [(0, int(degenerate.number[np.flatnonzero(degenerate.degenerate)[0]]))])


def test_the_seam_of_a_closed_face_is_met_from_both_sides():
    shape = BRepPrimAPI_MakeCylinder(2.0, 5.0).Shape()
    graph = graph_of(shape)
    seams = np.flatnonzero(graph.uses.seam)
    assert len(seams) == 2
    directions = []
    for use in seams.tolist():
        _, (curve,) = curves_of(shape, int(graph.uses.face[use]), [int(graph.uses.number[use])])
        (band,) = curve.bands()
        directions.append(band.surface.evaluate([0.0], [band.length / 2], 1, 0)[0])
        assert directions[-1] @ graph.uses.inward[use, 4] > 0.99
    assert directions[0] @ directions[1] < -0.99


@pytest.mark.long
@pytest.mark.parametrize("short", first_ones(1, [0.0, 4e-16, 1e-13, 1e-10]))
def test_a_periodic_curve_that_is_a_rounding_short_of_a_turn_is_whole(short, tmp_path):
    """The kernel cuts such a curve at the wrong knot, and its last pieces are lost."""
    turns = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    radius = 3 + 0.3 * np.sin(3 * turns)
    points = HArray1_gp_Pnt2d(1, 12)
    for k, (x, y) in enumerate(zip(radius * np.cos(turns), radius * np.sin(turns), strict=True)):
        points.SetValue(k + 1, gp_Pnt2d(float(x), float(y)))
    through = Geom2dAPI_Interpolate(points, True, 1e-9)
    through.Perform()
    face = Geom_Plane(gp_Pnt(1, 2, 3), gp_Dir(0.1, 0.2, 1))
    edge = BRepBuilderAPI_MakeEdge(through.Curve(), face).Edge()
    made = BRepBuilderAPI_MakeFace(face, BRepBuilderAPI_MakeWire(edge).Wire(), True).Face()
    BRepLib.BuildCurves3d_s(made)
    BRep_Builder().Range(edge, 0.0, through.Curve().LastParameter() * (1 - short), False)
    path = written(made, tmp_path / "loop.brep")
    (curve,) = read_trim_curves(path, [(0, 0)])
    ends = curve.pcurve.evaluate(curve.pcurve.knots[[0, -1]])
    assert ends[0] == pytest.approx(ends[1], abs=1e-8)
    assert curve.on_face.edge_to_pcurve < 1e-4
    # A closed curve in a leaning plane: the rows of its band lie in it up to rounding.
    (band,) = curve.bands()
    normal = np.array([0.1, 0.2, 1]) / np.linalg.norm([0.1, 0.2, 1])
    away = (band.surface.control_points - [1, 2, 3]) @ normal
    assert np.abs(away).max() < 64 * np.finfo(float).eps * 10
