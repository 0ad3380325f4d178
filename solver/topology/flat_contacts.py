"""A straight edge of a flat face moved into it, up to the next edges of the face: exactly, and past its ends."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineCurve, plane
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.trim_curves import read_trim_curves

# Of the length: what is straight, and what is one point.
_STRAIGHT = 1e-10
# Places at which a crossing is sought, and halvings of what is between.
_PLACES, _HALVINGS = 400, 60


def is_flat_contact(graph: EdgeGraph, row: int) -> bool:
    """Tell whether a use is a straight edge of a flat face."""
    return graph.faces.kind[int(graph.uses.face[row])] == "plane" and _is_straight(graph.uses.walked_points(row))


def flat_contact(graph: EdgeGraph, row: int, distance: float) -> Base | None:
    """Return the base along a straight edge of a flat face, moved into it; None where it misses the next edges."""
    uses = graph.uses
    points = uses.walked_points(row)
    origin, along = points[0], points[-1] - points[0]
    inward = np.cross(uses.normal[row, 0], along)
    inward /= np.linalg.norm(inward)
    next_ones = int(uses.previous[row]), int(uses.following[row])
    curved = [use for use in next_ones if not _is_straight(uses.points[use])]
    asked = [(int(uses.face[use]), int(uses.number[use])) for use in curved]
    curves = dict(zip(curved, read_trim_curves(graph.path, asked) if asked else [], strict=True))
    found = []
    for use, near in zip(next_ones, (points[0], points[-1]), strict=True):
        edge = curves[use].edge if use in curves else None
        line = _sampled(edge) if edge is not None else uses.points[use][[0, -1]]
        point = _crossing(line, edge, origin, inward, distance, near)
        if point is None:
            return None
        found.append(point)
    start, end = found
    if (end - start) @ along <= 0:
        return None
    # As wide as the distance: then the shape across depends on nothing else.
    return Base(plane(start, end - start, inward * distance), "v0")


def _is_straight(points: FloatArray) -> bool:
    along = points[-1] - points[0]
    length = float(np.linalg.norm(along))
    if length == 0:
        return False
    away = np.linalg.norm(np.cross(points - points[0], along / length), axis=1)
    return bool(away.max() <= _STRAIGHT * length)


def _sampled(curve: BSplineCurve) -> FloatArray:
    return curve.evaluate(np.linspace(curve.knots[0], curve.knots[-1], _PLACES + 1))


def _crossing(
    line: FloatArray,
    curve: BSplineCurve | None,
    origin: FloatArray,
    inward: FloatArray,
    distance: float,
    near: FloatArray,
) -> FloatArray | None:
    """Return where a next edge is at a distance from the edge, first seen from their common end."""
    if np.linalg.norm(line[-1] - near) < np.linalg.norm(line[0] - near):
        flipped = True
        line = line[::-1]
    else:
        flipped = False
    off = (line - origin) @ inward - distance
    found = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    if not len(found):
        return None
    k = int(found[0])
    if curve is None:
        return np.asarray(line[k] + (line[k + 1] - line[k]) * (-off[k] / (off[k + 1] - off[k])))
    places = np.linspace(curve.knots[0], curve.knots[-1], _PLACES + 1)
    places = places[::-1] if flipped else places
    low, high = float(places[k]), float(places[k + 1])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        inside = (curve.evaluate(np.array([middle]))[0] - origin) @ inward >= distance
        low, high = (low, middle) if inside else (middle, high)
    return np.asarray(curve.evaluate(np.array([(low + high) / 2]))[0])
