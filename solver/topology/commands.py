"""Commands that blend what was found, ready for a shell."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import floor, log10
from pathlib import Path

from semispline.solver.errors import EdgeError
from semispline.solver.io import OCC_SUFFIXES
from semispline.solver.topology.between import Between
from semispline.solver.topology.clearance import clearance
from semispline.solver.topology.contact_words import beyond, contact_word, has_exact_bases, linked
from semispline.solver.topology.end_faces import end_edges, going_on
from semispline.solver.topology.face_runs import face_run, runs_on
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.place import Place, PlaceSide
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.replacing import pair_of
from semispline.solver.topology.sharp_chains import sharp_chain
from semispline.solver.topology.solid_blends import can_hold_a_solid

# A contact moves into its face by this share of the way to the next edge, where nobody says how far.
_OF_CLEARANCE = 1 / 3


def with_commands(
    graph: EdgeGraph,
    relations: Relations,
    place: Place,
    betweens: Mapping[int, Between],
    chains: Sequence[Sequence[int]] = (),
) -> Place:
    """Return a place with its commands; a chain that is no single blend has those of its members, one by one.

    Parameters
    ----------
    graph : EdgeGraph
    relations : Relations
    place : Place
    betweens : dict
        Face -> how it lies between the faces that are to be blended.
    chains : sequence of sequence of int
        Faces that go on into each other.
    """
    if place.faces and can_hold_a_solid(graph.path):
        command = _of_run(graph, relations, place, chains)
        if command is not None:
            return replace(place, commands=(command,))
    words = _words(graph, relations, place, betweens)
    if words is not None:
        return replace(place, commands=(_between_chains(graph.path, place, words),))
    if place.kind == "sharp edge" and Path(graph.path).suffix.lower() in OCC_SUFFIXES:
        command = _rounding(graph, relations, place)
        # What cannot be a solid may be a blend all the same.
        return replace(place, commands=(command,) if command else tuple(two_faces(graph.path, place, alone=True)))
    if not place.faces:
        return replace(place, commands=tuple(two_faces(graph.path, place)))
    commands = []
    for face in place.faces:
        between = betweens[face]
        ends = end_edges(graph, face, (between.a.uses, between.b.uses))
        word = "" if _is_sewn(graph, [face]) else "--surfaces"
        if not word and going_on(graph, relations, ends):
            word = "--keep-ends"
        commands.append(replacing(graph.path, [face], _edges_to_name(graph, relations, between), word=word))
    return replace(place, commands=tuple(commands))


def _of_run(graph: EdgeGraph, relations: Relations, place: Place, chains: Sequence[Sequence[int]]) -> str | None:
    """Return the command that replaces a chain, or the one that a fillet belongs to; None where none can."""
    (faces,) = [list(chain) for chain in chains if set(place.faces) <= set(chain)][:1] or [list(place.faces)]
    try:
        run = face_run(graph, relations, faces)
    except EdgeError:
        return None
    if run.is_plain or not _is_sewn(graph, run.faces):
        return None
    return replacing(graph.path, run.faces, word="--keep-ends" if runs_on(graph, relations, run) else "")


def _is_sewn(graph: EdgeGraph, faces: Sequence[int]) -> bool:
    """Tell whether each edge of some faces is one of another face too, or a seam: else no solid comes back."""
    uses = graph.uses
    rows = [row for face in faces for row in range(*uses.of_face(face).indices(len(uses)))]
    return all(uses.other[row] != NONE or uses.twin[row] != NONE or uses.seam[row] for row in rows)


def _words(
    graph: EdgeGraph, relations: Relations, place: Place, betweens: Mapping[int, Between]
) -> tuple[str, str] | None:
    """Return the words for both sides of a place, where one of them has several edges and both are one run each."""
    sides: list[list[int]]
    if place.kind == "gap":
        sides = [_rows(graph, side) for side in (place.a, place.b)]
        runs = [linked(graph, relations, side) for side in sides]
        if max(map(len, sides)) == 1 or [len(x) for x in runs] != [1, 1]:
            return None
        found = [run[0] for run in runs]
    elif place.faces:
        members = [betweens[face] for face in place.faces]
        uses = [use for member in members for side in (member.a, member.b) for use in side.uses]
        rows = beyond(relations, uses)
        if rows is None or len(rows) <= 2:
            return None
        found = linked(graph, relations, rows)
        if len(found) != 2:
            return None
        first = beyond(relations, members[0].a.uses) or ()
        if first and first[0] in found[1]:
            found = found[::-1]
    else:
        return None
    if not has_exact_bases(graph, [row for run in found for row in run]):
        return None
    return contact_word(graph, relations, found[0]), contact_word(graph, relations, found[1])


def _rounding(graph: EdgeGraph, relations: Relations, place: Place) -> str | None:
    """Return the command that rounds a sharp edge with all that go on in it; None where no solid can come back."""
    face, edge = place.a.face, place.a.edge
    row = graph.uses.of_face(face).start + int(edge[1:])
    try:
        chain = sharp_chain(graph, relations, row, edge)
    except EdgeError:
        return None
    if any(graph.uses.other[use] == NONE for use in chain.rows):
        return None
    least = min(clearance(graph, *pair) for pair in zip(chain.rows, chain.others, strict=True))
    words = ["semispline", "blend", _safe(graph.path), "--round", f"{face}:{edge}", "--distance"]
    return shlex.join([*words, f"{_two_digits(least * _OF_CLEARANCE):g}", "-o", f"round-{face}{edge}.step"])


def _rows(graph: EdgeGraph, side: PlaceSide) -> list[int]:
    """Return the uses along a side."""
    return [graph.uses.of_face(face).start + int(edge[1:]) for face, edge in ((side.face, side.edge), *side.more)]


def _between_chains(path: str, place: Place, words: tuple[str, str]) -> str:
    """Return the command that blends two chains of edges of a file."""
    file = _safe(path)
    name = "-".join(map(str, place.faces[:1] or (place.a.face, place.b.face)))
    out = f"{place.kind.replace(' ', '-') if not place.faces else 'blend'}-{name}.step"
    return shlex.join(["semispline", "blend", file, file, "--edge-a", words[0], "--edge-b", words[1], "-o", out])


def replacing(path: str, faces: Sequence[int], edges: tuple[str, str] | None = None, *, word: str = "") -> str:
    """Return the command that blends the faces beyond some, from one edge of the first to another where they are named.

    `word` asks for edges that are kept, or for the blend alone: nothing where no solid comes back anyway.

    Examples
    --------
    >>> replacing("my part.step", [65])
    "semispline blend 'my part.step' --replace 65 -o blend-65.step"
    >>> replacing("part.step", [12, 13], word="--keep-ends")
    'semispline blend part.step --replace 12,13 --keep-ends -o blend-12.step'
    """
    words = ["semispline", "blend", _safe(path), "--replace", ",".join(map(str, faces))]
    if edges is not None:
        words += ["--edge-a", edges[0], "--edge-b", edges[1]]
    words += [word] * bool(word and can_hold_a_solid(path))
    return shlex.join([*words, "-o", f"blend-{faces[0]}.step"])


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


def two_faces(path: str, place: Place, *, alone: bool = False) -> Iterator[str]:
    """Yield the command of two edges; of a gap with as many on both sides, of each edge and the one that faces it.

    `alone` asks for the blend as a surface, instead of the solid with it.
    """
    sides = [[(side.face, side.edge), *side.more] for side in (place.a, place.b)]
    cuts: list[str] = []
    if place.kind == "sharp edge":
        distance = f"{_two_digits(place.measures['clearance'] * _OF_CLEARANCE):g}"
        cuts = ["--cut-a", distance, "--cut-b", distance]
    for a, b in zip(*sides, strict=True) if len(sides[0]) == len(sides[1]) else [(sides[0][0], sides[1][0])]:
        words = ["semispline", "blend", *(f"{_safe(path)}#{face}" for face, _ in (a, b))]
        words += ["--edge-a", a[1], "--edge-b", b[1], *cuts, *["--surfaces"] * alone]
        # Two faces may have several edges in common.
        out = "-".join([place.kind.partition(" ")[0], *(f"{face}{edge}" for face, edge in (a, b))])
        yield shlex.join([*words, "-o", f"{out}.step"])


def _safe(path: str) -> str:
    """Return a path that is not taken for an option."""
    return f"./{path}" if path.startswith("-") else path


def _two_digits(value: float) -> float:
    """Round down to two digits."""
    if value <= 0:
        return 0.0
    unit = 10.0 ** (floor(log10(value)) - 1)
    return floor(value / unit) * unit
