"""Lengths of edges and their distances from a point, by Open CASCADE; runs in the process that read the file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.near import candidates
from semispline.solver.topology.occ_edges import wires

# Of a length, as a fraction.
_ACCURACY = 1e-10


def lengths(face: Any) -> list[float]:
    """Return the length of each edge of a face, in the order of the names e0, e1, .."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Curve
    from OCP.GCPnts import GCPnts_AbscissaPoint

    found = []
    for edge in _edges(face):
        if BRep_Tool.Degenerated_s(edge):
            found.append(0.0)
            continue
        curve = BRepAdaptor_Curve(edge)
        rough = GCPnts_AbscissaPoint.Length_s(curve)
        found.append(GCPnts_AbscissaPoint.Length_s(curve, _ACCURACY * rough) if rough > 0 else 0.0)
    return found


def distances(faces: Sequence[Any], graph: EdgeGraph, point: FloatArray, face: int | None) -> list[tuple[int, float]]:
    """Return rows of `graph.uses` near a point with their distances, one for each edge, the nearest first."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.gp import gp_Pnt

    vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*point.tolist())).Vertex()
    found = []
    for row in candidates(graph, point, face):
        edge = _edges(faces[int(graph.uses.face[row])].face)[int(graph.uses.number[row])]
        found.append((row, float(BRepExtrema_DistShapeShape(vertex, edge).Value())))
    return sorted(found, key=lambda item: item[1])


def _edges(face: Any) -> list[Any]:
    return [edge for edges, _ in wires(face) for edge in edges]
