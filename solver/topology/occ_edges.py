"""Edges of faces of Open CASCADE as the tables of `half_edges`; runs in the process that read the file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from semispline.solver.topology.half_edges import SAMPLES, Faces, Uses, uses_of

_PCURVES = {
    "GeomAbs_Line": "line",
    "GeomAbs_Circle": "circle",
    "GeomAbs_Ellipse": "ellipse",
    "GeomAbs_Hyperbola": "hyperbola",
    "GeomAbs_Parabola": "parabola",
    "GeomAbs_BezierCurve": "Bezier",
    "GeomAbs_BSplineCurve": "B-spline",
    "GeomAbs_OffsetCurve": "offset",
    "GeomAbs_OtherCurve": "other",
}
# A range that lacks less than this fraction of the spline is all of it.
_WHOLE = 1e-9
_FRACTIONS = tuple(k / (SAMPLES - 1) for k in range(SAMPLES))


def wires(face: Any) -> Iterator[tuple[list[Any], bool]]:
    """Yield the edges of each wire in walking order, the outer wire first, and whether they could be walked.

    Each edge has its direction in the face; only so the two sides of a seam can be told apart.
    """
    from OCP.BRepTools import BRepTools, BRepTools_WireExplorer
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopoDS import TopoDS

    found = [TopoDS.Wire(wire) for wire in _explored(face, TopAbs_ShapeEnum.TopAbs_WIRE)]
    if len(found) > 1:
        outer = BRepTools.OuterWire_s(face)
        found.sort(key=lambda wire: not wire.IsSame(outer))
    for wire in found:
        in_file = [TopoDS.Edge(edge) for edge in _explored(wire, TopAbs_ShapeEnum.TopAbs_EDGE)]
        walk = BRepTools_WireExplorer(wire, face)
        walked: list[Any] = []
        # Wires that are knots in themselves have led the kernel round for ever.
        while walk.More() and len(walked) <= len(in_file):
            walked.append(walk.Current())
            walk.Next()
        whole = len(walked) == len(in_file)
        yield (walked if whole else in_file), whole


def edge_tables(faces: Sequence[Any]) -> tuple[Faces, Uses]:
    """Return the tables of all faces of a file, each an `OccFace`, in the order of their numbers."""
    from OCP.BRep import BRep_Tool
    from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher
    from OCP.TopAbs import TopAbs_Orientation
    from OCP.TopLoc import TopLoc_Location

    edge_ids, shape_ids, face_ids = (IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher() for _ in range(3))
    turned = TopAbs_Orientation.TopAbs_REVERSED
    here = TopLoc_Location()
    of_faces, whole, rows, records = [], [], [], []
    for number, item in enumerate(faces):
        face = item.face
        of_faces.append(
            (
                item.kind,
                _ends(item),
                face.Orientation() == turned,
                shape_ids.Add(face.Located(here)),
                face_ids.Add(face),
            )
        )
        sampler = _Sampler(face)
        k, walked_all = 0, True
        for wire, (edges, walked) in enumerate(wires(face)):
            walked_all &= walked
            for edge in edges:
                flags = BRep_Tool.IsClosed_s(edge, face), BRep_Tool.Degenerated_s(edge)
                rows.append((number, wire, k, edge_ids.Add(edge), edge.Orientation() == turned, *flags))
                records.append((BRep_Tool.Tolerance_s(edge), *sampler.record(edge)))
                k += 1
        whole.append(walked_all)
    table = Faces(
        kind=tuple(row[0] for row in of_faces),
        ends=np.array([row[1] for row in of_faces], dtype=np.float64).reshape(-1, 4),
        reversed=np.array([row[2] for row in of_faces], dtype=bool),
        repeat=_first([row[3] for row in of_faces]),
        same=_first([row[4] for row in of_faces]),
        walked=np.array(whole, dtype=bool),
    )
    return table, uses_of(table, rows, records)


class _Sampler:
    """Samples the edges of one face; the kernel's points and vectors are made once."""

    def __init__(self, face: Any) -> None:
        from OCP.BRepAdaptor import BRepAdaptor_Surface
        from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec, gp_Vec2d

        self.face = face
        try:
            # Unbounded: a plane has no end, and a curve may run past the range of its face by a tolerance.
            self.surface: Any = BRepAdaptor_Surface(face, False)
        except Exception:
            # Each failure of the kernel has a class of its own: the face has no surface.
            self.surface = None
        self.at, self.slope = gp_Pnt2d(), gp_Vec2d()
        self.jet = gp_Pnt(), *(gp_Vec() for _ in range(5))
        self.read_jet = [x.Coord for x in self.jet]

    def record(self, edge: Any) -> tuple[str, bool, tuple[float, float], Any, Any, Any]:
        """Return kind of the pcurve, whether its box is proven, parameters, box, uv with slopes, jet of the surface."""
        try:
            return self._record(edge)
        except Exception:
            # Each failure of the kernel has a class of its own: no curve, or one that it cannot evaluate.
            return "none", False, (np.nan, np.nan), [np.nan] * 4, [np.nan] * (4 * SAMPLES), [np.nan] * (18 * SAMPLES)

    def _record(self, edge: Any) -> tuple[str, bool, tuple[float, float], Any, Any, Any]:
        from OCP.BRepAdaptor import BRepAdaptor_Curve2d

        curve = BRepAdaptor_Curve2d(edge, self.face)
        first, last = curve.FirstParameter(), curve.LastParameter()
        at, slope, jet = self.at, self.slope, self.jet
        curve_at, surface_at = curve.D1, self.surface.D2
        plane: list[float] = []
        values: list[float] = []
        for fraction in _FRACTIONS:
            curve_at(first + (last - first) * fraction, at, slope)
            uv = at.Coord()
            surface_at(*uv, *jet)
            plane += uv
            plane += slope.Coord()
            for read in self.read_jet:
                values += read()
        kind = _PCURVES[curve.GetType().name]
        poles = _poles(curve, kind, first, last)
        u, v = (plane[::4], plane[1::4]) if poles is None else zip(*poles, strict=True)
        box = min(u), min(v), max(u), max(v)
        return kind, poles is not None, (first, last), box, plane, values


def _poles(curve: Any, kind: str, first: float, last: float) -> list[tuple[float, float]] | None:
    """Return points whose hull holds the curve; None where it has no such points."""
    if kind == "line":
        held = [curve.Value(first), curve.Value(last)]
    elif kind in ("B-spline", "Bezier"):
        spline = curve.BSpline() if kind == "B-spline" else curve.Bezier()
        low, high = spline.FirstParameter(), spline.LastParameter()
        if max(first - low, high - last) > _WHOLE * (high - low):
            spline = spline.Copy()
            spline.Segment(first, last)
        held = [spline.Pole(i + 1) for i in range(spline.NbPoles())]
    else:
        return None
    return [p.Coord() for p in held]


def _ends(face: Any) -> tuple[float, ...]:
    try:
        return tuple(face.ends)
    except Exception:
        # No surface, or a failure of the kernel, each of which has a class of its own.
        return (np.nan, np.nan, np.nan, np.nan)


def _first(groups: list[int]) -> Any:
    """Return, for each, the first that is in the same group."""
    seen: dict[int, int] = {}
    return np.array([seen.setdefault(group, number) for number, group in enumerate(groups)], dtype=np.int64)


def _explored(shape: Any, kind: Any) -> Iterator[Any]:
    from OCP.TopExp import TopExp_Explorer

    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()
