"""Commands that blend what was found, ready for a shell."""

from __future__ import annotations

import shlex
from dataclasses import replace
from math import floor, log10

from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.place import Place

# A contact moves into its face by this share of the way to the next edge, where nobody says how far.
_OF_CLEARANCE = 1 / 3


def with_commands(graph: EdgeGraph, place: Place) -> Place:
    """Return a place with its commands; a chain has those of its members, one by one."""
    if place.faces:
        return replace(place, commands=tuple(replacing(graph.path, face) for face in place.faces))
    return replace(place, commands=(_two_faces(graph.path, place),))


def replacing(path: str, face: int) -> str:
    """Return the command that blends the faces beyond a face.

    Examples
    --------
    >>> replacing("my part.step", 65)
    "semispline blend 'my part.step' --replace 65 -o blend-65.step"
    """
    return shlex.join(["semispline", "blend", _safe(path), "--replace", str(face), "-o", f"blend-{face}.step"])


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
