"""What the gate is told of a change, and what it says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from semispline.solver.topology.gate_edges import Border

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Change:
    """What is meant to have happened to a shape.

    Attributes
    ----------
    old : tuple of int
        Faces that were taken out, by their numbers before.
    new : tuple of int
        Faces that were put in, by their numbers after.
    touched : tuple of int
        Faces whose borders were changed, by their numbers before.
    volume : float
        Area times width of what was there: a quarter of it is what the volume may change by.
    contacts : tuple of int
        Faces beyond the contacts, by their numbers before.
    grows : bool or None
        Whether the volume has to become more, or less; None where either is right.
    joined : int
        How many solids, and shells, were joined to others.
    expected : float
        By what the volume grows, as far as it is known beforehand; `volume` is about the rest.
    kept : dict or None
        The number after of each face that was not taken out, by that before; None where they follow each other.
    like : tuple of int
        Of faces that are put in beside others, by whose colours, by their numbers before.
    """

    old: tuple[int, ...]
    new: tuple[int, ...]
    touched: tuple[int, ...]
    volume: float
    contacts: tuple[int, ...]
    grows: bool | None = None
    joined: int = 0
    expected: float = 0.0
    kept: Mapping[int, int] | None = None
    like: tuple[int, ...] = ()

    def kept_of(self, before: int, after: int) -> dict[int, int]:
        """Return the number after of each face that was not taken out, by that before, of so many faces."""
        if self.kept is not None:
            return dict(self.kept)
        rest = [n for n in range(after) if n not in self.new]
        return dict(zip((n for n in range(before) if n not in self.old), rest, strict=True))


@dataclass(frozen=True)
class GateReport:
    """What the gate measured; what it did not come to is None.

    Attributes
    ----------
    reason : str or None
        Why the result is not sound; None where it is.
    place : (float, float, float) or None
        Where, as far as that can be said.
    solids, shells, faces : (int, int)
        Before and after.
    volume : (float, float)
        Before and after.
    volume_expected, volume_limit : float
        By how much it changes where that is known beforehand, and by how much more or less it may.
    border : tuple of Border
        The edges of the new faces, with their tolerances and gaps.
    tolerance : (float, float)
        The largest of all edges and vertices, before and after.
    crease_degrees : float or None
        The largest angle at which new faces meet others along old edges, over which it went on smoothly before.
    turn_degrees : float or None
        Of the new faces; above 90 they are folded.
    open_edges : tuple of str
        Edges of one face alone, before as after.
    was_invalid : bool
        Open CASCADE's own check failed elsewhere before, and does so after.
    """

    reason: str | None
    place: Point | None = None
    solids: tuple[int, int] = (0, 0)
    shells: tuple[int, int] = (0, 0)
    faces: tuple[int, int] = (0, 0)
    volume: tuple[float, float] = (0.0, 0.0)
    volume_expected: float = 0.0
    volume_limit: float = 0.0
    tolerance: tuple[float, float] = (0.0, 0.0)
    border: tuple[Border, ...] = ()
    crease_degrees: float | None = None
    turn_degrees: float | None = None
    open_edges: tuple[str, ...] = ()
    was_invalid: bool = False

    def numbered_from(self, first: int) -> GateReport:
        """Return the report with edges and faces as a file calls them where they begin at another number."""

        def edge(name: str) -> str:
            face, _, own = name.partition(":")
            return f"{first + int(face)}:{own}"

        border = tuple(replace(x, name=edge(x.name), beyond=first + x.beyond) for x in self.border)
        return replace(self, border=border, open_edges=tuple(map(edge, self.open_edges)))

    @property
    def is_sound(self) -> bool:
        """Whether the result may be written."""
        return self.reason is None

    @property
    def largest_tolerance(self) -> float:
        """Of the edges of the new faces."""
        return max((edge.tolerance for edge in self.border), default=0.0)
