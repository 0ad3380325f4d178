"""Places in words, and as a record for JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from semispline.solver.io import without_surfaces
from semispline.solver.topology.place import KINDS, Place, Places

# Of each kind so many are printed.
_PRINTED = 20
_PLURALS = {
    "fillet": "fillets: faces that can be blended anew between the faces beyond",
    "chain": "chains of fillets: blended anew together, or one by one where their sides are no chains",
    "gap": "gaps: free edges that face each other",
    "chamfer": "chamfers: faces between two sharp edges",
    "round end": "round ends: faces that turn by more than 150 degrees, as half a hole does",
    "sharp edge": "sharp edges between two faces",
}
# Measures that are said of each kind, with their unit.
_SAID = {
    "fillet": ("length", "width", "radius", "turn"),
    "chain": ("members", "length", "width"),
    "gap": ("length", "width"),
    "chamfer": ("length", "width", "angle_a", "angle_b"),
    "round end": ("length", "width", "radius", "turn"),
    "sharp edge": ("length", "angle", "clearance"),
}
# Factors of a score that are nearly 1 are not worth a word.
_ONE = 0.995


def place_lines(places: Places) -> Iterator[str]:
    """Yield what `semispline list --pairs` prints."""
    if not places.faces:
        yield without_surfaces(places.others)
        return
    if not places.found:
        yield _nothing(places)
    else:
        yield f"lengths in {places.unit or 'model units'}, angles in degrees; the best of each kind first"
    for kind in KINDS:
        found = places.of_kind(kind)
        if not found:
            continue
        yield ""
        yield _PLURALS[kind]
        rows = [_heading(kind), *(_row(place) for place in found[:_PRINTED])]
        for number, line in enumerate(aligned(rows)):
            yield line
            if number:
                yield from (f"    {command}" for command in found[number - 1].commands)
                yield from (f"    # {left}" for left in _left_out(found[number - 1]))
        if len(found) > _PRINTED:
            yield f"and {len(found) - _PRINTED} more; --json has all"
    if places.found and places.counts:
        yield ""
        yield f"no fillets: {_counted(places)}; --json says of each face why"
    if places.unwalked:
        faces = ", ".join(f"#{face}" for face in places.unwalked)
        yield f"edges in the order of the file, not in walking order, since a wire is broken: {faces}"


def places_record(places: Places) -> dict[str, Any]:
    """Return all of it for JSON."""
    record = asdict(places)
    record["places"] = [
        {**found, "times": 1 + len(found["repeats"]), "command": found["commands"][0]} for found in record.pop("found")
    ]
    record["refused"] = [{"face": face, "reason": reason} for face, reason in places.refused.items()]
    return record


def _nothing(places: Places) -> str:
    found = [f"{places.slight} edges of less than 10 degrees that are not smooth"] if places.slight else []
    if places.counts:
        found.append(_counted(places))
    why = ": " + "; ".join(found) if found else ""
    return (
        f"no place found in {places.faces} faces ({places.edges} edges){why}; "
        "`semispline list FILE --edges K` lists the edges of a face"
    )


def _counted(places: Places) -> str:
    return ", ".join(f"{count} {name}" for name, count in places.counts.items())


def _heading(kind: str) -> list[str]:
    between = ["face"] if kind not in ("gap", "sharp edge") else []
    names = [name.replace("_", " ") for name in _SAID[kind]]
    return [*between, "from", "to", *names, *(["sense"] if kind == "sharp edge" else []), "times", "score", "of"]


def _row(place: Place) -> list[str]:
    between = [", ".join(f"#{face}" for face in place.faces)] if place.faces else []
    if place.faces and place.kind != "chain":
        # The edges are those of the face between.
        sides = [f"#{side.face} at {' '.join(at)}" for side, at in zip((place.a, place.b), place.contacts, strict=True)]
    elif place.kind == "chain":
        sides = [f"#{side.face}" for side in (place.a, place.b)]
    else:
        sides = [f"#{side.face} {side.edge}{' ..' if side.more else ''}" for side in (place.a, place.b)]
    figures = [f"{place.measures[name]:.4g}" for name in _SAID[place.kind]]
    sense = [("convex" if place.measures["convex"] else "concave")] if place.kind == "sharp edge" else []
    parts = ", ".join(f"{name.replace('_', ' ')} {value:.2f}" for name, value in place.parts.items() if value < _ONE)
    return [*between, *sides, *figures, *sense, f"{1 + len(place.repeats)}", f"{place.score:.2f}", parts]


def _left_out(place: Place) -> Iterator[str]:
    """Yield, of a gap whose sides have different numbers of edges, those that its command does not name.

    A chain names them all: it says the faces with its edges, not with the files.
    """
    names_faces = any("#" in command for command in place.commands)
    if place.kind == "gap" and names_faces and len(place.a.more) != len(place.b.more):
        for name, side in (("A", place.a), ("B", place.b)):
            if side.more:
                others = ", ".join(f"#{face} {edge}" for face, edge in side.more)
                yield f"one edge of several: side {name} goes on in {others}"


def aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a table."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
