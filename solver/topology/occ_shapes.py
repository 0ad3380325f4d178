"""Shapes of Open CASCADE read and put together by hand; runs in the process that read the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import interpolate_curve

# The least tolerance that the kernel works with.
CONFUSION = 1e-7
# What was measured at samples, for what lies between them.
MARGIN = 1.05
# Steps towards a foot, and what of the last one is left, relative to the parameters.
_STEPS, _DONE = 30, 1e-14
_DEGREE = 5
# Of a range: breaks nearer to each other are one.
_APART = 1e-6


def parts(shape: Any, kind: str, outside: str | None = None) -> list[Any]:
    """Return the parts of a shape, "FACE" say, as often as they are used; or only those in nothing of another kind."""
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    kinds = [getattr(TopAbs_ShapeEnum, f"TopAbs_{name}") for name in (kind, outside) if name is not None]
    explorer, found = TopExp_Explorer(shape, *kinds), []
    while explorer.More():
        found.append(cast(explorer.Current()))
        explorer.Next()
    return found


def copy_of(shape: Any) -> tuple[Any, Callable[[Any], Any]]:
    """Return a shape that shares nothing with another, its parts in the same order, and what each part became."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy

    maker = BRepBuilderAPI_Copy(shape, True, False)
    return maker.Shape(), maker.ModifiedShape


def children(shape: Any) -> list[Any]:
    """Return what a shape is directly made of, as it uses it."""
    from OCP.TopoDS import TopoDS_Iterator

    iterator, found = TopoDS_Iterator(shape), []
    while iterator.More():
        found.append(cast(iterator.Value()))
        iterator.Next()
    return found


def new_vertex(point: FloatArray) -> Any:
    """Return a vertex at a point."""
    from OCP.BRep import BRep_Builder
    from OCP.gp import gp_Pnt
    from OCP.TopoDS import TopoDS_Vertex

    vertex = TopoDS_Vertex()
    BRep_Builder().MakeVertex(vertex, gp_Pnt(*point.tolist()), CONFUSION)
    return vertex


def cast(shape: Any) -> Any:
    """Return a shape as what it is: many of the kernel's functions hand over one without its kind."""
    from OCP.TopoDS import TopoDS

    # "TopAbs_EDGE": Edge.
    kind = shape.ShapeType().name.removeprefix("TopAbs_").capitalize()
    return getattr(TopoDS, kind)(shape)


def turned(shape: Any, *, backwards: bool) -> Any:
    """Return a shape in its own direction, or against it."""
    from OCP.TopAbs import TopAbs_Orientation

    which = TopAbs_Orientation.TopAbs_REVERSED if backwards else TopAbs_Orientation.TopAbs_FORWARD
    return cast(shape.Oriented(which))


def forward(shape: Any) -> Any:
    """Return a shape in its own direction."""
    return turned(shape, backwards=False)


def is_reversed(shape: Any) -> bool:
    """Tell whether a shape is used against its own direction."""
    from OCP.TopAbs import TopAbs_Orientation

    return bool(shape.Orientation() == TopAbs_Orientation.TopAbs_REVERSED)


def ends(edge: Any) -> tuple[Any, Any]:
    """Return the vertices of an edge in the direction in which it is used."""
    from OCP.TopExp import TopExp

    return TopExp.FirstVertex_s(edge, True), TopExp.LastVertex_s(edge, True)


def point_of(vertex: Any) -> FloatArray:
    """Return where a vertex is."""
    from OCP.BRep import BRep_Tool

    return np.array(BRep_Tool.Pnt_s(vertex).Coord())


def range_of(edge: Any) -> tuple[float, float]:
    """Return the range of the parameter of an edge."""
    from OCP.BRep import BRep_Tool

    first, last = BRep_Tool.Range_s(edge)
    return float(first), float(last)


def tolerance_of(shape: Any) -> float:
    """Return the tolerance of a face, an edge or a vertex."""
    from OCP.BRep import BRep_Tool

    return float(BRep_Tool.Tolerance_s(shape))


def points_of(edge: Any, t: FloatArray) -> FloatArray:
    """Return points of an edge in space, shape (K, 3)."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve

    curve = BRepAdaptor_Curve(edge)
    return np.array([curve.Value(x).Coord() for x in t.tolist()])


def parameters_of(edge: Any, face: Any, t: FloatArray) -> FloatArray:
    """Return points of an edge in the parameters of a face, shape (K, 2)."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d

    curve = BRepAdaptor_Curve2d(edge, face)
    return np.array([curve.Value(x).Coord() for x in t.tolist()])


def surface_at(face: Any, uv: FloatArray) -> FloatArray:
    """Return points of the surface of a face, shape (K, 3)."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface

    surface = BRepAdaptor_Surface(face, False)
    return np.array([surface.Value(*x).Coord() for x in uv.tolist()])


def jets_at(face: Any, uv: FloatArray) -> FloatArray:
    """Return S, S_u, S_v of the surface of a face, shape (K, 3, 3)."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.gp import gp_Pnt, gp_Vec

    surface, jet, found = BRepAdaptor_Surface(face, False), (gp_Pnt(), gp_Vec(), gp_Vec()), []
    for x in uv.tolist():
        surface.D1(*x, *jet)
        found.append([x.Coord() for x in jet])
    return np.array(found)


def feet(face: Any, points: FloatArray, start: FloatArray) -> FloatArray:
    """Return the feet of points along a curve on the surface of a face, shape (K, 2), each sought from the last one.

    Parameters
    ----------
    face : TopoDS_Face
    points : ndarray, shape (K, 3)
    start : ndarray, shape (2,)
        Near the first one. Parameters run on over the seam of a closed surface.
    """
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.gp import gp_Pnt, gp_Vec

    surface, jet = BRepAdaptor_Surface(face, False), (gp_Pnt(), gp_Vec(), gp_Vec())
    found, at = [], np.array(start, dtype=np.float64)
    for point in points:
        for _ in range(_STEPS):
            surface.D1(*at.tolist(), *jet)
            here, along_u, along_v = (np.array(x.Coord()) for x in jet)
            # The nearest point of the tangent plane; points lie near the surface, so that this is Newton's step.
            step = np.linalg.lstsq(np.stack([along_u, along_v], axis=1), point - here, rcond=None)[0]
            at = at + step
            if np.abs(step).max() <= _DONE * max(1.0, float(np.abs(at).max())):
                break
        found.append(at)
    return np.array(found)


def plane_curve(t: FloatArray, uv: FloatArray, degree: int) -> Any:
    """Return the spline (u, v)(t) through points in the parameters of a surface."""
    curve = interpolate_curve(uv, degree, t)
    return _geometry(degree, curve.knots, curve.control_points)


def spline_of_pieces(t: Sequence[FloatArray], points: Sequence[FloatArray], *, in_space: bool = False) -> Any:
    """Return the spline of degree 5 through points of several pieces that is only continuous from piece to piece.

    The points are parameters (u, v) of a surface, or in space.
    """
    curves = [interpolate_curve(x, _DEGREE, at) for at, x in zip(t, points, strict=True)]
    knots = np.concatenate(
        [curves[0].knots[:-1], *(x.knots[_DEGREE + 1 : -1] for x in curves[1:]), curves[-1].knots[-1:]]
    )
    poles = np.concatenate([curves[0].control_points, *(x.control_points[1:] for x in curves[1:])])
    return _geometry(_DEGREE, knots, poles, in_space=in_space)


def _geometry(degree: int, knots: FloatArray, control_points: FloatArray, *, in_space: bool = False) -> Any:
    from OCP.collections import Array1_double, Array1_gp_Pnt, Array1_gp_Pnt2d, Array1_int
    from OCP.Geom import Geom_BSplineCurve
    from OCP.Geom2d import Geom2d_BSplineCurve
    from OCP.gp import gp_Pnt, gp_Pnt2d

    values, counts = np.unique(knots, return_counts=True)
    points = (Array1_gp_Pnt if in_space else Array1_gp_Pnt2d)(1, len(control_points))
    for i, pole in enumerate(control_points.tolist()):
        points.SetValue(i + 1, gp_Pnt(*pole) if in_space else gp_Pnt2d(*pole[:2]))
    places, times = Array1_double(1, len(values)), Array1_int(1, len(values))
    for i, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True)):
        places.SetValue(i + 1, value)
        times.SetValue(i + 1, count)
    return (Geom_BSplineCurve if in_space else Geom2d_BSplineCurve)(points, places, times, degree)


def breaks_of(edge: Any) -> FloatArray:
    """Return the parameters between which an edge is smooth, ends included."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.collections import Array1_double
    from OCP.GeomAbs import GeomAbs_Shape

    curve = BRepAdaptor_Curve(edge)
    count = curve.NbIntervals(GeomAbs_Shape.GeomAbs_CN)
    found = Array1_double(1, count + 1)
    curve.Intervals(found, GeomAbs_Shape.GeomAbs_CN)
    return np.array([found.Value(k + 1) for k in range(count + 1)])


def merged(values: FloatArray, first: float, last: float) -> FloatArray:
    """Return increasing values from the first to the last, without those that nearly are others."""
    apart = _APART * (last - first)
    inner = np.sort(values[(values > first + apart) & (values < last - apart)])
    kept = inner[np.concatenate([[True], np.diff(inner) > apart])] if len(inner) else inner
    return np.concatenate([[first], kept, [last]])


def with_range(curve: Any, first: float, last: float, tolerance: float, vertices: Sequence[Any]) -> Any:
    """Return a new edge, in its own direction, along a curve in space between two vertices."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Edge

    builder, edge = BRep_Builder(), TopoDS_Edge()
    builder.MakeEdge(edge, curve, tolerance)
    for vertex, backwards in zip(vertices, (False, True), strict=True):
        builder.Add(edge, turned(vertex, backwards=backwards))
    builder.Range(edge, first, last)
    return edge


def add_pcurve(edge: Any, curve: Any, face: Any) -> None:
    """Give an edge its curve in the parameters of a face."""
    from OCP.BRep import BRep_Builder

    BRep_Builder().UpdateEdge(edge, curve, face, tolerance_of(edge))


def raise_tolerance(shape: Any, least: float) -> None:
    """Let the tolerance of an edge or a vertex be this at least."""
    from OCP.BRep import BRep_Builder
    from OCP.TopAbs import TopAbs_ShapeEnum

    if least > tolerance_of(shape):
        builder = BRep_Builder()
        update = builder.UpdateVertex if shape.ShapeType() == TopAbs_ShapeEnum.TopAbs_VERTEX else builder.UpdateEdge
        update(shape, least)


class EdgeUsers:
    """Which faces of a shape use an edge; an edge is the same however it is turned."""

    def __init__(self, shape: Any) -> None:
        from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher

        self._numbers = IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
        self._users: list[list[tuple[int, Any]]] = []
        for number, face in enumerate(parts(shape, "FACE")):
            for edge in parts(face, "EDGE"):
                if self._numbers.Add(edge) > len(self._users):
                    self._users.append([])
                self._users[self._numbers.FindIndex(edge) - 1].append((number, edge))

    def of(self, edge: Any) -> list[tuple[int, Any]]:
        """Return the number of each face that uses the edge, and the edge as it does."""
        return self._users[self._numbers.FindIndex(edge) - 1]

    def number(self, edge: Any) -> int:
        """Return a number that an edge has however it is turned."""
        return int(self._numbers.FindIndex(edge)) - 1

    def edge(self, number: int) -> Any:
        """Return the edge of a number, in its own direction."""
        return forward(cast(self._numbers.FindKey(number + 1)))

    def at(self, vertex: Any) -> list[Any]:
        """Return the edges that begin or end at a vertex, in their own directions."""
        edges = [forward(users[0][1]) for users in self._users]
        return [edge for edge in edges if any(vertex.IsSame(end) for end in ends(edge))]


def box_of(shape: Any) -> FloatArray:
    """Return the least and the greatest coordinates of a shape, tolerances included, shape (2, 3)."""
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    return np.array([box.CornerMin().Coord(), box.CornerMax().Coord()])


def boxes_meet(a: FloatArray, b: FloatArray) -> bool:
    """Tell whether two boxes have a point in common."""
    return bool((a[0] <= b[1]).all() and (b[0] <= a[1]).all())


def extent(shape: Any) -> float:
    """Return the largest extent of a shape along the axes."""
    return float(np.ptp(box_of(shape), axis=0).max())
