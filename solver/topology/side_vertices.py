"""Vertices inside sides of faces with four sides or two rims, as fillets are, and whether a contact goes on there."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from semispline.solver.topology.contact_walk import passage_between
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.sides import cut_ring, entering, leaving, turn_between

# A side ends where it turns by more, in degrees.
_CORNER = 20.0
_SIDES = 4

VertexKind = Literal["open", "same face", "smooth", "creased", "corner", "no common side edge"]


@dataclass(frozen=True)
class SideVertex:
    """A vertex inside a side of a face.

    Attributes
    ----------
    face : int
        The face: N of `PATH#N`.
    sides : tuple of tuple of int
        The sides of its wire, as uses in walking order, that with the vertex first; one where it has no corners.
    before, after : int
        The uses of the face between which it lies.
    kind : {"open", "same face", "smooth", "creased", "corner", "no common side edge"}
        "open": no other face lies beyond one of them, or it is a seam. Else of the faces beyond: both are one, or what
        the vertex is for a contact along them, as `Passage.kind`.
    """

    face: int
    sides: tuple[tuple[int, ...], ...]
    before: int
    after: int
    kind: VertexKind


def side_vertices(graph: EdgeGraph, relations: Relations) -> list[SideVertex]:
    """Return the vertices inside sides of all faces that are no planes, of wires with four sides or without corners."""
    uses = graph.uses
    found = []
    for face, kind in enumerate(graph.faces.kind):
        if kind == "plane" or graph.faces.same[face] != face:
            continue
        rows = range(*uses.of_face(face).indices(len(uses)))
        for wire in dict.fromkeys(uses.wire[row] for row in rows):
            ring = [row for row in rows if uses.wire[row] == wire and not uses.degenerate[row]]
            found += _of_wire(graph, relations, face, ring)
    return found


def _of_wire(graph: EdgeGraph, relations: Relations, face: int, ring: list[int]) -> list[SideVertex]:
    uses = graph.uses

    def is_corner(one: int, two: int) -> bool:
        return turn_between(leaving(uses, one)[1], entering(uses, two)[1]) > _CORNER

    sides, is_ring = cut_ring(ring, is_corner)
    if not ring or len(sides) != (1 if is_ring else _SIDES):
        return []
    found = []
    for k, side in enumerate(sides):
        turned = (*map(tuple, sides[k:]), *map(tuple, sides[:k]))
        pairs = [*pairwise(side), *([(side[-1], side[0])] if is_ring else [])]
        found += [
            SideVertex(face, turned, before, after, _kind(graph, relations, before, after)) for before, after in pairs
        ]
    return found


def _kind(graph: EdgeGraph, relations: Relations, before: int, after: int) -> VertexKind:
    uses = graph.uses
    one, two = int(relations.partner[before]), int(relations.partner[after])
    if NONE in (one, two) or uses.seam[before] or uses.seam[after]:
        return "open"
    if uses.face[one] == uses.face[two]:
        return "same face"
    # The faces beyond walk the other way.
    passage = passage_between(graph, relations, two, one)
    return "no common side edge" if passage is None else passage.kind
