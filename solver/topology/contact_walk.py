"""Where a contact goes on: from an edge of a face to the next one, on the same face or on its neighbour.

Two faces of a contact share an edge that leaves it, the side edge, at the vertex where they meet. Faces walk with their
inside to the left, so that this edge follows the one before in its wire and is followed, in the neighbour's wire, by
the next one of the contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations
from semispline.solver.topology.sides import entering, leaving, turn_between

# In degrees: a contact that turns by more has a corner; faces that turn by more along their side edge are creased, and
# with a sharp edge where a CAD system would see one.
CORNER, CREASED = 0.1, 0.1

PassageKind = Literal["same face", "smooth", "creased", "corner"]


@dataclass(frozen=True)
class Passage:
    """A vertex at which a contact goes on.

    Attributes
    ----------
    before, after : int
        Uses, both by the faces that are met, in the direction in which the contact is walked.
    side : (int, int) or None
        The uses of the side edge by both faces; None on one face.
    turn_degrees : float
        Of the contact.
    crease_degrees : float
        The largest angle between the faces along their side edge; 0 on one face.
    """

    before: int
    after: int
    side: tuple[int, int] | None
    turn_degrees: float
    crease_degrees: float

    @property
    def kind(self) -> PassageKind:
        """What the vertex is for a chain."""
        if self.turn_degrees > CORNER:
            return "corner"
        if self.side is None:
            return "same face"
        return "creased" if self.crease_degrees > CREASED else "smooth"


@dataclass(frozen=True)
class SmoothRun:
    """Edges that go on smoothly in each other.

    Attributes
    ----------
    uses : tuple of int
        In walking order; a closed run begins at the edge that it was found from.
    closed : bool
    stops : (str, str)
        Why it ends where it begins, and where it ends; empty where it is closed.
    """

    uses: tuple[int, ...]
    closed: bool
    stops: tuple[str, str]


def passages_after(graph: EdgeGraph, relations: Relations, use: int) -> list[Passage]:
    """Return how a contact may go on where a use ends: on its face, and on the one beyond the edge that follows."""
    uses = graph.uses
    following = int(uses.following[use])
    found = [Passage(use, following, None, _turn(graph, use, following), 0.0)]
    across = _across(graph, relations, following)
    if across is not None:
        crease, after = _crease(relations, following), int(uses.following[across])
        found.append(Passage(use, after, (following, across), _turn(graph, use, after), crease))
    return [x for x in found if not uses.degenerate[x.after] and uses.pcurve[x.after] != "none"]


def passage_between(graph: EdgeGraph, relations: Relations, before: int, after: int) -> Passage | None:
    """Return how a contact goes on from a use to another; None where the two share no vertex with a side edge."""
    return next((x for x in passages_after(graph, relations, before) if x.after == after), None)


def smooth_run(graph: EdgeGraph, relations: Relations, use: int) -> SmoothRun:
    """Return all edges that go on smoothly from one, both ways: up to corners and creases."""
    run = [use]
    while isinstance(found := _going_on(graph, relations, run[-1]), int):
        if found in run:
            # Where it comes back to itself elsewhere it does not close.
            return SmoothRun(tuple(run), found == use, ("", ""))
        run.append(found)
    end = found
    first = [use]
    while isinstance(found := _coming_from(graph, relations, first[-1]), int) and found not in run:
        first.append(found)
    start = found if isinstance(found, str) else ""
    return SmoothRun((*first[:0:-1], *run), False, (start, end))


def _going_on(graph: EdgeGraph, relations: Relations, use: int) -> int | str:
    """Return the use in which one goes on smoothly, or why there is none."""
    passages = passages_after(graph, relations, use)
    for passage in passages:
        if passage.kind in ("same face", "smooth"):
            return passage.after
    return _stop(graph, use, passages)


def _coming_from(graph: EdgeGraph, relations: Relations, use: int) -> int | str:
    """Return the use that goes on smoothly in this one, or why there is none."""
    uses = graph.uses
    previous = int(uses.previous[use])
    candidates = [previous]
    across = _across(graph, relations, previous)
    if across is not None:
        candidates.append(int(uses.previous[across]))
    passages = [
        x
        for row in candidates
        if not uses.degenerate[row] and uses.pcurve[row] != "none"
        if (x := passage_between(graph, relations, row, use)) is not None
    ]
    for passage in passages:
        if passage.kind in ("same face", "smooth"):
            return passage.before
    return _stop(graph, use, passages)


def _stop(graph: EdgeGraph, use: int, passages: Sequence[Passage]) -> str:
    uses = graph.uses
    for passage in passages:
        if passage.kind == "creased":
            other = passage.after if passage.before == use else passage.before
            return f"a crease of {passage.crease_degrees:.2g} degrees to face {uses.face[other]}"
    if not passages:
        return "a point, or a free border"
    return f"a corner of {min(x.turn_degrees for x in passages):.3g} degrees"


def _across(graph: EdgeGraph, relations: Relations, use: int) -> int | None:
    """Return the use of an edge by the face on its other side."""
    uses = graph.uses
    if uses.degenerate[use]:
        return None
    beyond = int(uses.twin[use] if uses.twin[use] != NONE else relations.partner[use])
    return None if beyond == NONE else beyond


def _crease(relations: Relations, use: int) -> float:
    angles = relations.angle[use]
    # Both sides of a seam are one face.
    return float(np.nanmax(angles)) if np.isfinite(angles).any() else 0.0


def _turn(graph: EdgeGraph, before: int, after: int) -> float:
    return turn_between(leaving(graph.uses, before)[1], entering(graph.uses, after)[1])
