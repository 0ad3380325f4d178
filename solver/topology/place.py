"""What is said of a place where two faces can be blended, and of all places of a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

KINDS = ("fillet", "chain", "gap", "chamfer", "round end", "sharp edge")


@dataclass(frozen=True)
class PlaceSide:
    """One of the two edges of a place.

    Attributes
    ----------
    face : int
        The face to blend: N of `PATH#N`.
    edge : str
        Its longest edge along the place, as `semispline list PATH --edges N` names it; of a gap with more edges on the
        other side that which faces the longest there.
    more : tuple of (int, str)
        Other faces and edges along the same side. Of a gap with as many edges on both sides those of A and B face
        each other one by one.
    """

    face: int
    edge: str
    more: tuple[tuple[int, str], ...] = ()


@dataclass(frozen=True)
class Place:
    """A place where two faces can be blended.

    Attributes
    ----------
    kind : {"chain", "fillet", "gap", "chamfer", "round end", "sharp edge"}
    faces : tuple of int
        The faces between, to be replaced: one of a fillet, chamfer and round end, the members of a chain, none else.
    a, b : PlaceSide
        The faces beyond, or on both sides; of a chain those of its longest member.
    contacts : (tuple of str, tuple of str)
        The edges of the face between along both sides; empty where there is no such face, and for chains.
    score : float
        Product of `parts`, from 0 to 1.
    parts : dict
    measures : dict
        "length" of the contacts, "width" between them, "radius" and "turn" (degrees) of a fillet, "angle" (degrees) of
        edges, and others; lengths in the unit of the file.
    closed : bool
        The contacts are closed.
    repeats : tuple of tuple of int
        The same place elsewhere in the file: `faces` (of gaps and sharp edges the two faces) of each.
    commands : tuple of str
        Ready to be typed.
    """

    kind: str
    faces: tuple[int, ...]
    a: PlaceSide
    b: PlaceSide
    contacts: tuple[tuple[str, ...], tuple[str, ...]]
    score: float
    parts: Mapping[str, float]
    measures: Mapping[str, float]
    closed: bool = False
    repeats: tuple[tuple[int, ...], ...] = ()
    commands: tuple[str, ...] = ()

    @property
    def where(self) -> tuple[int, ...]:
        """The faces by which a place is told from its repeats."""
        return self.faces or (self.a.face, self.b.face)


@dataclass(frozen=True)
class Places:
    """What was found in a file.

    Attributes
    ----------
    path : str
    unit : str or None
    faces, edges : int
        How many there are.
    found : tuple of Place
        Kind by kind, in each the best first.
    refused : dict
        Face -> why it is no fillet.
    counts : dict
        Reason, in short -> how many faces.
    slight : int
        Edges with an angle that is not smooth and too small to be sharp.
    unwalked : tuple of int
        Faces whose edges could not be walked round: their numbers are those of the file's order.
    others : dict
        What else the file holds: kind -> how many.
    """

    path: str
    unit: str | None
    faces: int
    edges: int
    found: tuple[Place, ...]
    refused: Mapping[int, str]
    counts: Mapping[str, int]
    slight: int
    unwalked: tuple[int, ...]
    others: Mapping[str, int]

    def of_kind(self, kind: str) -> tuple[Place, ...]:
        """Return the places of a kind, the best first."""
        return tuple(place for place in self.found if place.kind == kind)
