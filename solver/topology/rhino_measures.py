"""Lengths of edges of a 3dm file and their distances from a point."""

from __future__ import annotations

from semispline.solver.arrays import FloatArray
from semispline.solver.io import Model, RhinoFace
from semispline.solver.splines import BSplineCurve, clamp_knots, closest_point, curve_length, euclidean
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.near import candidates


def lengths_of(face: RhinoFace) -> list[float]:
    """Return the length of each edge of a face, in the order of the names e0, e1, .."""
    return [0.0 if curve is None else curve_length(curve).value for curve in _curves(face)]


def distances(model: Model, graph: EdgeGraph, point: FloatArray, face: int | None) -> list[tuple[int, float]]:
    """Return rows of `graph.uses` near a point with their distances, one for each edge, the nearest first."""
    found = []
    for row in candidates(graph, point, face):
        item = model.faces[int(graph.uses.face[row])]
        assert isinstance(item, RhinoFace)
        curve = _curves(item)[int(graph.uses.number[row])]
        assert curve is not None
        found.append((row, closest_point(curve, point).distance))
    return sorted(found, key=lambda item: item[1])


def _curves(face: RhinoFace) -> list[BSplineCurve | None]:
    """Return the curve of each edge in the order of their names, None for a point."""
    turned, loops = face.trims or (False, ())
    places = [trim for loop in loops for trim in (reversed(loop) if turned else loop)]
    return [None if edge < 0 else _curve(*(face.curves or ())[place]) for edge, place, _ in places]


def _curve(degree: int, knots: FloatArray, net: FloatArray) -> BSplineCurve:
    clamped, points = clamp_knots(degree, knots, net)
    return BSplineCurve(degree, clamped, *euclidean(points))
