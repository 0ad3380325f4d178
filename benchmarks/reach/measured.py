"""One place of a file, blended as `semispline blend FILE --replace FACE` does."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from semispline import Base, BlendResult, SemisplineError
from semispline.solver.io import LoadedSurface
from semispline.solver.judge import FOLD_DEGREES, measure_face_contact
from semispline.solver.topology import blend_edges
from semispline.solver.topology.between import Between
from semispline.solver.topology.fillets import MOST_TURN, Fillets
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.replacing import pair_of, resolved_pair, rows_beyond

# Below this jump of curvature at a contact both sides of it are one smooth surface.
_ONE_SURFACE = 0.4


@dataclass(frozen=True)
class Place:
    """A non-planar face with one wire of four edges, and two opposite ones beyond which lie two other faces."""

    face: int
    edges: tuple[str, str]


def places(graph: EdgeGraph, relations: Relations) -> Iterator[Place]:
    """Yield the places of a file, by the rule of the measure alone."""
    uses = graph.uses
    for face, kind in enumerate(graph.faces.kind):
        rows = list(range(*uses.of_face(face).indices(len(uses))))
        if kind == "plane" or len(rows) != 4 or len({int(uses.wire[row]) for row in rows}) != 1:
            continue
        for a, b in ((rows[0], rows[2]), (rows[1], rows[3])):
            beyond = [int(uses.face[partner]) for partner in relations.partner[[a, b]] if partner != NONE]
            if len({face, *beyond}) == 3:
                yield Place(face, (uses.name(a), uses.name(b)))


def outcome(
    measured: MeasuredEdges, fillets: Fillets, relations: Relations, place: Place, surfaces: dict[int, LoadedSurface]
) -> dict[str, Any]:
    """Return what comes of a place, for JSON."""
    graph = measured.graph
    between = pair_of(graph, relations, place.face, *place.edges)
    taken = pair_of(graph, relations, place.face)
    accepted = fillets.accepted.get(place.face)
    row: dict[str, Any] = {
        "face": place.face,
        "edges": place.edges,
        "kind": graph.faces.kind[place.face],
        "default": {between.a.uses, between.b.uses} == {taken.a.uses, taken.b.uses},
        "fillet": accepted is not None and {accepted.a.uses, accepted.b.uses} == {between.a.uses, between.b.uses},
        "half_hole": place.face in fillets.round_ends or between.turn > MOST_TURN,
        "hull": _is_of_a_hull(between),
        "turn": between.turn,
        "width": between.width,
        "length": between.length,
    }
    started = time.process_time()
    try:
        beyond = [int(graph.uses.face[use]) for use in rows_beyond(graph, between)]
        row["faces"] = beyond
        pair = resolved_pair(measured, between, [surfaces[face] for face in beyond])
        row["names"] = [pair.a.edge, pair.b.edge]
        row["bases"] = [one.entry.kind for one in (pair.a, pair.b) if one.entry is not None]
        results = blend_edges(pair.a, pair.b)
    except SemisplineError as error:
        return row | {"error": f"{type(error).__name__}: {error}", "seconds": time.process_time() - started}
    except Exception as error:
        return row | {"error": f"FAULT {type(error).__name__}: {error}", "seconds": time.process_time() - started}
    contacts = [
        _contact(result, which, surfaces[face]) for result in results for which, face in zip("ab", beyond, strict=True)
    ]
    turn = max(result.shape.turn.degrees for result in results)
    return row | {
        "parts": len(results),
        "warnings": [warning for result in results for warning in result.warnings],
        "turn_of_blend": turn,
        "folds": turn > FOLD_DEGREES,
        "contacts": contacts,
        "points": sum(result.rows_stored for result in results),
        "seconds": time.process_time() - started,
    }


def _contact(result: BlendResult, which: str, face: LoadedSurface) -> dict[str, float]:
    """Return how a blend meets the true face: gap in parts of the length, angle and jump of curvature."""
    own = Base(result.surface, "u0" if which == "a" else "u1")
    band = result.band_a if which == "a" else result.band_b
    if band is not None:
        gap, angle, curvature = band.gap / band.length, band.angle_degrees, band.curvature
    else:
        found = measure_face_contact(own, face.surface)
        gap, angle, curvature = found.gap / found.length, found.angle_degrees, found.curvature_jump_relative
    return {"gap": gap, "angle_degrees": angle, "curvature": curvature}


def _is_of_a_hull(between: Between) -> bool:
    """Tell whether the face goes on in both neighbours as one smooth surface."""
    return between.smooth > 0.99 and (between.jump < _ONE_SURFACE or between.curvature < 1.5 * between.neighbour)
