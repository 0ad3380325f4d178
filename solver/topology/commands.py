"""Commands that blend what was found, ready for a shell."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import replace
from math import floor, log10

from semispline.solver.errors import EdgeError
from semispline.solver.topology.between import Between
from semispline.solver.topology.end_faces import end_edges, going_on
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.place import Place
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.replacing import pair_of

# A contact moves into its face by this share of the way to the next edge, where nobody says how far.
_OF_CLEARANCE = 1 / 3


def with_commands(graph: EdgeGraph, relations: Relations, place: Place, betweens: Mapping[int, Between]) -> Place:
    """Return a place with its commands; a chain has those of its members, one by one.

    Parameters
    ----------
    graph : EdgeGraph
    relations : Relations
    place : Place
    betweens : dict
        Face -> how it lies between the faces that are to be blended.
    """
    if not place.faces:
        return replace(place, commands=(_two_faces(graph.path, place),))
    commands = []
    for face in place.faces:
        between = betweens[face]
        ends = end_edges(graph, face, (between.a.uses, between.b.uses))
        alone = bool(going_on(graph, relations, ends))
        commands.append(replacing(graph.path, face, _edges_to_name(graph, relations, between), alone=alone))
    return replace(place, commands=tuple(commands))


def replacing(path: str, face: int, edges: tuple[str, str] | None = None, *, alone: bool = False) -> str:
    """Return the command that blends the faces beyond a face, from one of its edges to another where they are named.

    `alone` asks for the blend as a surface, instead of the solid with it.

    Examples
    --------
    >>> replacing("my part.step", 65)
    "semispline blend 'my part.step' --replace 65 -o blend-65.step"
    """
    words = ["semispline", "blend", _safe(path), "--replace", str(face)]
    if edges is not None:
        words += ["--edge-a", edges[0], "--edge-b", edges[1]]
    words += ["--surfaces"] * alone
    return shlex.join([*words, "-o", f"blend-{face}.step"])


def _edges_to_name(graph: EdgeGraph, relations: Relations, between: Between) -> tuple[str, str] | None:
    """Return the contacts of a face where it would not be blended from one to the other without a word."""
    rows = [max(side.uses, key=lambda row: float(relations.length[row])) for side in (between.a, between.b)]
    try:
        taken = pair_of(graph, relations, between.face)
    except EdgeError:
        taken = None
    if taken is not None and {*taken.a.uses, *taken.b.uses} == set(rows):
        return None
    return graph.uses.name(rows[0]), graph.uses.name(rows[1])


def _two_faces(path: str, place: Place) -> str:
    a, b = place.a, place.b
    words = ["semispline", "blend", f"{_safe(path)}#{a.face}", f"{_safe(path)}#{b.face}"]
    words += ["--edge-a", a.edge, "--edge-b", b.edge]
    if place.kind == "sharp edge":
        distance = f"{_two_digits(place.measures['clearance'] * _OF_CLEARANCE):g}"
        words += ["--cut-a", distance, "--cut-b", distance]
    return shlex.join([*words, "-o", f"{place.kind.partition(' ')[0]}-{a.face}-{b.face}.step"])


def _safe(path: str) -> str:
    """Return a path that is not taken for an option."""
    return f"./{path}" if path.startswith("-") else path


def _two_digits(value: float) -> float:
    """Round down to two digits."""
    if value <= 0:
        return 0.0
    unit = 10.0 ** (floor(log10(value)) - 1)
    return floor(value / unit) * unit
