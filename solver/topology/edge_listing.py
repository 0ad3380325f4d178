"""The edges of a face in words, and as a record for JSON."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from semispline.solver.topology.face_edges import FaceEdge, FaceEdges
from semispline.solver.topology.listing import aligned

_WORDS = {
    "whole": "whole edge",
    "part": "part of an edge",
    "inner": "line inside",
    "free": "free curve",
    "point": "point",
    "not classified": "not classified",
}


def edge_lines(face: FaceEdges) -> Iterator[str]:
    """Yield what `semispline list --edges` prints."""
    if not face.edges:
        yield f"#{face.face} ({face.kind}) has no edges: it is the whole surface"
        return
    unit = face.unit or "model units"
    looks = ", looks against its surface's normal" if face.reversed else ""
    yield f"#{face.face} ({face.kind}{looks}); lengths in {unit}, parameters those of the converted surface"
    yield f"lines of constant parameter are told within {face.tolerance:.2g} {unit}"
    if not face.walked:
        yield "edges in the order of the file, not in walking order, since a wire is broken"
    several = len({edge.wire for edge in face.edges}) > 1
    rows = [["edge", *(["wire"] if several else []), "is", "name", "length", "neighbour", "middle"]]
    rows += [_row(face, edge, several) for edge in face.edges]
    yield from aligned(rows)


def edges_record(face: FaceEdges) -> dict[str, Any]:
    """Return all of it for JSON."""
    return asdict(face)


def _row(face: FaceEdges, edge: FaceEdge, several: bool) -> list[str]:
    wire = [str(edge.wire) if edge.wire else "outer"] if several else []
    seam = ", a seam" if edge.seam else ""
    middle = "({:.6g}, {:.6g}, {:.6g})".format(*edge.middle)
    return [
        edge.name,
        *wire,
        f"{_WORDS[edge.kind]}{seam}",
        edge.edge or "-",
        f"{edge.length:.6g}",
        _neighbour(face, edge),
        middle,
    ]


def _neighbour(face: FaceEdges, edge: FaceEdge) -> str:
    if edge.neighbour is None:
        return "-"
    who = "itself" if edge.neighbour == face.face else f"#{edge.neighbour}"
    return f"{who} {edge.neighbour_edge}" + ("" if edge.sewn else ", not sewn")
