"""Chamfers, faces between two sharp contacts that do not turn; and sharp edges."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.between import Between, measure, meet_in_a_corner, share
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.sides import Side, sides_of

_ROUND = ("cylinder", "sphere", "torus")
_SHARP_SHARE = 0.9
_LEAST_ANGLE, _MOST_ANGLE = 12.0, 78.0
# The crest of a thread has 120.
_MOST_SUM = 110.0
_MOST_TURN = 5.0
# Width, in fractions of the length and of the lesser face beyond; a chamfer of 45 degrees may be as wide as that face.
_WIDE, _OF_EXTENT, _OF_EXTENT_AT_45 = 0.7, 0.5, 1.0
_EVEN = 0.5


@dataclass(frozen=True, eq=False)
class Chamfer:
    """A face between two sharp sides; `angle_a` and `angle_b` are medians along them, in degrees."""

    between: Between
    angle_a: float
    angle_b: float


def find_chamfers(graph: EdgeGraph, relations: Relations, taken: Collection[int]) -> list[Chamfer]:
    """Return the chamfers among faces that are not `taken`."""
    found = []
    for face, kind in enumerate(graph.faces.kind):
        if kind in _ROUND or face in taken or graph.faces.same[face] != face:
            continue
        best: Chamfer | None = None
        for a, b, angles in _sharp_pairs(graph, relations, sides_of(graph, relations, face)):
            chamfer = Chamfer(measure(graph, relations, face, a, b), *angles)
            if _is_chamfer(graph, relations, chamfer) and (best is None or chamfer.between.width < best.between.width):
                best = chamfer
        if best is not None:
            found.append(best)
    return found


def sharp_edges(graph: EdgeGraph, relations: Relations) -> list[int]:
    """Return one use of each sharp edge between two faces."""
    rows = np.flatnonzero(relations.sharp & ~graph.uses.seam & ~graph.uses.degenerate)
    seen: set[tuple[int, ...]] = set()
    found = []
    for row in rows.tolist():
        pair = tuple(sorted((int(graph.uses.edge[row]), int(graph.uses.edge[relations.partner[row]]))))
        if pair not in seen:
            seen.add(pair)
            found.append(row)
    return found


def chamfer_parts(chamfer: Chamfer) -> dict[str, float]:
    """Return the factors of the score of a chamfer."""
    between = chamfer.between
    return {
        "even": 0.5 + 0.5 * between.even,
        "length": min(1.0, float(np.sqrt(between.length / (4 * between.width)))),
        "alike": float(np.exp(-(((chamfer.angle_a - chamfer.angle_b) / 45) ** 2))),
    }


def _sharp_pairs(
    graph: EdgeGraph, relations: Relations, sides: list[Side]
) -> Iterator[tuple[Side, Side, tuple[float, float]]]:
    """Yield opposite sides that are sharp, in the same sense, by angles of a chamfer; and these."""
    known = []
    for side in sides:
        rows = list(side.uses)
        if share(relations.sharp, relations.length, side) < _SHARP_SHARE:
            continue
        angle = float(np.nanmedian(relations.median[rows]))
        senses = {bool(relations.convex[row]) for row in rows if relations.sharp[row]}
        if len(senses) == 1 and _LEAST_ANGLE <= angle <= _MOST_ANGLE:
            known.append((side, angle, senses.pop()))
    for (a, one, first), (b, two, second) in combinations(known, 2):
        alike = first == second and a.closed == b.closed and one + two <= _MOST_SUM
        if alike and not meet_in_a_corner(graph.uses, a, b):
            yield a, b, (one, two)


def _is_chamfer(graph: EdgeGraph, relations: Relations, chamfer: Chamfer) -> bool:
    between = chamfer.between
    if between.turn >= _MOST_TURN or between.width > _WIDE * between.length or between.even < _EVEN:
        return False
    at_45 = max(abs(chamfer.angle_a - 45), abs(chamfer.angle_b - 45)) <= 1
    extent = min(_extent_across(graph, relations, side) for side in (between.a, between.b))
    return between.width <= (_OF_EXTENT_AT_45 if at_45 else _OF_EXTENT) * extent


def _extent_across(graph: EdgeGraph, relations: Relations, side: Side) -> float:
    """Return how far the face beyond the longest edge of a side goes, away from it."""
    uses = graph.uses
    use = max(side.uses, key=lambda row: float(relations.length[row]))
    partner = int(relations.partner[use])
    if partner == NONE:
        return 0.0
    rows = uses.of_face(int(uses.face[partner]))
    middle = uses.points.shape[1] // 2
    offset: FloatArray = uses.points[rows].reshape(-1, 3) - uses.points[partner, middle]
    return float(np.nanmax(offset @ uses.inward[partner, middle]))
