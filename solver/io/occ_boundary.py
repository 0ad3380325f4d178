"""The edges of a face of Open CASCADE, as `face_boundary` measures them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.io.face_boundary import FaceBoundary, cubic_pieces, joined, vertex_piece

# A trimming curve follows the edge of its surface if it stays within this fraction of the parameter range.
ON_EDGE = 1e-6
# What is no line is cut into so many pieces before the first look.
_FIRST_PIECES = 8


def occ_boundary(face: Any, ends: tuple[float, float, float, float]) -> FaceBoundary:
    """Return the boundary of a face; `ends` are the ranges of u and v of its surface."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    parts = []
    for edge in edges_of(face):
        side = _side(pcurve_points(edge, face), ends)
        curve = BRepAdaptor_Curve(edge)
        parts.append((*cubic_pieces(_evaluator(curve), _breaks(curve), BRep_Tool.Tolerance_s(edge)), side))
        vertices = TopExp_Explorer(edge, TopAbs_ShapeEnum.TopAbs_VERTEX)
        while vertices.More():
            vertex = TopoDS.Vertex(vertices.Current())
            point = BRep_Tool.Pnt_s(vertex)
            at = vertex_piece(np.array([point.X(), point.Y(), point.Z()]))
            parts.append((at, np.array([BRep_Tool.Tolerance_s(vertex)]), side))
            vertices.Next()
    return joined(parts)


def edges_of(face: Any) -> Iterator[Any]:
    """Yield the edges of a face, each with its direction in it; a seam comes twice."""
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    edges = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while edges.More():
        yield TopoDS.Edge(edges.Current())
        edges.Next()


def pcurve_points(edge: Any, face: Any) -> FloatArray:
    """Return points of an edge in the parameters of its face, shape (7, 2)."""
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d

    curve = BRepAdaptor_Curve2d(edge, face)
    points = [curve.Value(float(t)) for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), 7)]
    return np.array([(p.X(), p.Y()) for p in points])


def distance_to_ends(uv: FloatArray, ends: tuple[float, float, float, float]) -> FloatArray:
    """Return how far parameters are from u0, u1, v0 and v1, in fractions of the range; shape (K, 4)."""
    low_u, high_u, low_v, high_v = ends
    off = np.abs(uv[:, [0, 0, 1, 1]] - np.array(ends))
    return np.asarray(off / np.array([high_u - low_u, high_u - low_u, high_v - low_v, high_v - low_v]))


def _side(uv: FloatArray, ends: tuple[float, float, float, float]) -> str:
    """Return the natural edge along which a curve in the parameters runs, or "" for none."""
    along = distance_to_ends(uv, ends).max(axis=0) <= ON_EDGE
    return next((name for name, runs in zip(("u0", "u1", "v0", "v1"), along, strict=True) if runs), "")


def _breaks(curve: Any) -> FloatArray:
    from OCP.collections import Array1_double
    from OCP.GeomAbs import GeomAbs_CurveType, GeomAbs_Shape

    if curve.GetType() == GeomAbs_CurveType.GeomAbs_Line:
        return np.array([curve.FirstParameter(), curve.LastParameter()])
    count = curve.NbIntervals(GeomAbs_Shape.GeomAbs_C2)
    values = Array1_double(1, count + 1)
    curve.Intervals(values, GeomAbs_Shape.GeomAbs_C2)
    breaks = np.array([values.Value(i + 1) for i in range(count + 1)])
    each = -(-_FIRST_PIECES // count)
    return np.asarray(np.interp(np.arange(count * each + 1) / each, np.arange(count + 1), breaks))


def _evaluator(curve: Any) -> Any:
    from OCP.gp import gp_Pnt, gp_Vec

    point, derivative = gp_Pnt(), gp_Vec()

    def evaluate(parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        values = np.empty((len(parameters), 6))
        for k, t in enumerate(parameters.tolist()):
            curve.D1(t, point, derivative)
            values[k] = point.X(), point.Y(), point.Z(), derivative.X(), derivative.Y(), derivative.Z()
        return values[:, :3], values[:, 3:]

    return evaluate
