"""The edge nearest to a point, as one clicks on it in other systems."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.relations import to_polyline

NEAR = "near="
# A point further from the nearest edge than this fraction of its length was not meant to lie on it.
_FAR = 0.05
# Edges whose distances differ by less than this fraction of the size are equally near: they lie on each other, or the
# point is their common corner.
_TIE = 1e-6
# The second edge is named where it is nearly as near: within this fraction of the size, or so many times the distance.
_SECOND, _SECOND_TIMES = 1e-4, 1.2
# A curve leaves the chord between two samples by less than this part of the chord.
_BULGE = 0.75


def point_of(word: str, name: str = "edge") -> FloatArray:
    """Return the point of "near=x,y,z".

    Raises
    ------
    EdgeError
        No three finite numbers.

    Examples
    --------
    >>> point_of("near=1,2.5,-3")
    array([ 1. ,  2.5, -3. ])
    """
    try:
        values = [float(x) for x in word.removeprefix(NEAR).split(",")]
    except ValueError:
        values = []
    if len(values) != 3 or not np.isfinite(values).all():
        raise EdgeError(f"{name}: found {word!r}, expected near=x,y,z with three numbers, in the unit of the file")
    return np.array(values)


def candidates(graph: EdgeGraph, point: FloatArray, face: int | None = None) -> list[int]:
    """Return a row of `graph.uses` for each edge that may be the nearest to a point or second, of a face or of all."""
    uses = graph.uses
    rows = np.flatnonzero(~uses.degenerate & (uses.pcurve != "none") & ((uses.face == face) | (face is None)))
    if not len(rows):
        return []
    _, first = np.unique(uses.edge[rows], return_index=True)
    rows = rows[np.sort(first)]
    points = uses.points[rows]
    nearest = np.linalg.norm(points - point, axis=2).min(axis=1)
    chord = np.linalg.norm(np.diff(points, axis=1), axis=2).max(axis=1)
    # Whatever an edge does between two samples, it cannot be nearer than this.
    least = np.maximum(nearest - _BULGE * chord, 0.0)
    most = max(_SECOND_TIMES * float(nearest.min()), float(nearest.min()) + _SECOND * graph.size)
    kept = np.flatnonzero(least <= most)
    # Of very many the polylines tell those that are near.
    by_line = [float(to_polyline(point[None], points[k])[0]) for k in kept]
    order = np.argsort(by_line, kind="stable")
    reach = max(_SECOND_TIMES * min(by_line), min(by_line) + _SECOND * graph.size)
    return [int(rows[kept[k]]) for k in order if by_line[k] - 0.15 * chord[kept[k]] <= reach]


def nearest_edge(graph: EdgeGraph, word: str, found: list[tuple[int, float]], where: str) -> tuple[int, float, str]:
    """Return the row of the nearest edge, its distance, and what is said of it.

    Parameters
    ----------
    graph : EdgeGraph
    word : str
        "near=x,y,z", for messages.
    found : list of (int, float)
        Row and distance of each edge that may be meant, the nearest first.
    where : str
        What was searched: "part.step#5".

    Raises
    ------
    EdgeError
        None is near, or several are equally near.
    """
    uses, unit = graph.uses, graph.unit or "model units"
    if not found:
        raise EdgeError(f"{word}: {where} has no edge that can be evaluated")
    (row, distance), *others = found
    length = float(np.linalg.norm(np.diff(uses.points[row], axis=0), axis=1).sum())
    title = f"#{uses.face[row]} {uses.name(row)}"
    if distance > _FAR * length:
        raise EdgeError(
            f"{word}: the nearest edge of {where}, {title}, is {distance:.3g} {unit} away, more than a twentieth of "
            f"its length {length:.4g}; give a point on the edge"
        )
    tied = [other for other, away in others if away <= distance + _TIE * graph.size]
    if tied:
        names = ", ".join([title, *(f"#{uses.face[other]} {uses.name(other)}" for other in tied)])
        raise EdgeError(
            f"{word}: {len(tied) + 1} edges of {where} are equally near, {distance:.3g} {unit} away: {names}; give a "
            "point in the middle of one edge, or name the face as PATH#N"
        )
    said = f"{title}, {distance:.3g} {unit} away"
    if others and others[0][1] <= max(distance + _SECOND * graph.size, _SECOND_TIMES * distance):
        second, away = others[0]
        said += f"; next is #{uses.face[second]} {uses.name(second)}, {away:.3g} {unit} away"
    return row, distance, said
