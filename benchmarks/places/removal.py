"""A face taken out of the tables of a file, and whether the gap that it leaves is found again."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

from semispline.solver.topology.between import Between
from semispline.solver.topology.fillets import Fillets, fillet_ends, find_fillets
from semispline.solver.topology.gaps import find_gaps
from semispline.solver.topology.half_edges import EdgeGraph, neighbours
from semispline.solver.topology.relations import relate


def without_face(graph: EdgeGraph, face: int) -> EdgeGraph:
    """Return the tables without the edges of a face; numbers of faces and of edges stay."""
    uses = graph.uses
    kept = uses.face != face
    columns: dict[str, Any] = {field.name: getattr(uses, field.name)[kept] for field in fields(uses)}
    columns |= neighbours(columns["face"], columns["wire"], columns["edge"], columns["degenerate"], graph.faces.same)
    return replace(graph, uses=replace(uses, **columns))


def rank_of_the_right_gap(graph: EdgeGraph, between: Between) -> int | None:
    """Return at which place, from 1 on, the gap that a fillet leaves stands in the list; None where it does not."""
    left = without_face(graph, between.face)
    relations = relate(left)
    fillets: Fillets = find_fillets(left, relations)
    gaps = find_gaps(left, relations, fillet_ends(left, relations, fillets.accepted.values()))
    # Where faces are not sewn, the edge of the face beyond is another.
    partner = relate(graph).partner
    wanted = [set(graph.uses.edge[partner[list(side.uses)]].tolist()) for side in (between.a, between.b)]
    for rank, gap in enumerate(gaps, start=1):
        found = [set(left.uses.edge[list(side.uses)].tolist()) for side in (gap.a, gap.b)]
        if any(wanted[0] & one and wanted[1] & two for one, two in (found, found[::-1])):
            return rank
    return None
