"""Sharp edges that go on smoothly in each other: they are rounded together, or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.topology.contact_walk import Passage, passage_between, smooth_run
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations

# Of the size: nearer ends are one point.
_SAME_POINT = 1e-6
# Degrees: where an edge that meets the run slants by more, contacts at a distance do not meet on it.
_SLANT = 1e-3


@dataclass(frozen=True, eq=False)
class SharpChain:
    """Sharp edges that run end to end, one or more.

    Attributes
    ----------
    rows : tuple of int
        Uses by the faces on one side, as these walk them.
    others : tuple of int
        Of the same edges by the faces on the other side.
    closed : bool
    at : tuple of (ndarray, int)
        Both ends, each with a use of an edge there by the face beyond; none where it is closed.
    convex : bool
    """

    rows: tuple[int, ...]
    others: tuple[int, ...]
    closed: bool
    at: tuple[tuple[FloatArray, int], ...]
    convex: bool


def sharp_chain(graph: EdgeGraph, relations: Relations, row: int, title: str) -> SharpChain:
    """Return all sharp edges that go on smoothly from one, both ways.

    Parameters
    ----------
    graph : EdgeGraph
    relations : Relations
    row : int
        A use of the edge.
    title : str
        How messages begin.

    Raises
    ------
    EdgeError
        It is no sharp edge between two faces; it goes on in one that is none, or in which the faces meet the other way
        round; no single face lies beyond an end; at a joint more edges meet than those beside it.
    """
    uses = graph.uses
    run = smooth_run(graph, relations, row)
    others = tuple(_other(graph, relations, use, row, title) for use in run.uses)
    convex = {bool(relations.convex[use]) for use in run.uses}
    if len(convex) > 1:
        raise EdgeError(
            f"{title}: of the edges that go on in each other, {_named(graph, run.uses)}, some are convex and some are "
            "not; no one blend rounds them"
        )
    closed = run.closed or _is_point(graph, uses.walked_points(run.uses[0])[0], uses.walked_points(run.uses[-1])[-1])
    joints = [(k, (k + 1) % len(others)) for k in range(len(others) if closed and len(others) > 1 else len(others) - 1)]
    for before, after in joints:
        # The other side walks them the other way.
        passage = passage_between(graph, relations, others[after], others[before])
        if passage is None or passage.kind not in ("same face", "smooth"):
            names = _named(graph, (run.uses[before], run.uses[after]))
            why = "more edges meet there" if passage is None else "the faces beyond them meet in a crease"
            raise EdgeError(f"{title}: edges {names} go on in each other, but {why}; they cannot be rounded together")
        for way in (passage, passage_between(graph, relations, run.uses[before], run.uses[after])):
            _check_square(graph, way, title)
    if not closed:
        # What goes on elsewhere, as where the faces beyond are creased, has to be an end with three edges.
        at = (
            _end(graph, relations, uses.walked_points(run.uses[0])[0], run.uses[0], others[0], title, starts=True),
            _end(graph, relations, uses.walked_points(run.uses[-1])[-1], run.uses[-1], others[-1], title, starts=False),
        )
    return SharpChain(run.uses, others, closed, () if closed else at, convex.pop())


def shared_sharp_edge(graph: EdgeGraph, relations: Relations, one: int, two: int) -> bool:
    """Tell whether two uses are those of one sharp edge that two faces share."""
    uses = graph.uses
    return bool(uses.other[one] == two and uses.face[one] != uses.face[two] and relations.sharp[one])


def _other(graph: EdgeGraph, relations: Relations, use: int, asked: int, title: str) -> int:
    uses, other = graph.uses, int(relations.partner[use])
    name = f"{uses.face[use]}:{uses.name(use)}"
    said = f"{title}: " if use == asked else f"{title}: it goes on in {name}, and "
    if other == NONE or uses.face[other] == uses.face[use]:
        raise EdgeError(f"{said}the edge lies between no two faces")
    if not relations.sharp[use]:
        raise EdgeError(f"{said}the faces meet at {relations.median[use]:.2g} degrees there; no sharp edge")
    return other


def _end(
    graph: EdgeGraph, relations: Relations, point: FloatArray, row: int, other: int, title: str, *, starts: bool
) -> tuple[FloatArray, int]:
    """Return an end with a use by the face beyond."""
    uses = graph.uses
    # At the end of the one walk the other begins.
    mine = int(uses.previous[row] if starts else uses.following[row])
    yours = int(uses.following[other] if starts else uses.previous[other])
    for use in (mine, yours):
        partner = int(relations.partner[use])
        if partner == NONE:
            raise EdgeError(f"{title}: {uses.name(use)} of face {uses.face[use]} at its end has no other face")
        if relations.smooth[use]:
            raise EdgeError(
                f"{title}: it ends at {uses.name(use)} of face {uses.face[use]}, over which this goes on smoothly into "
                f"face {uses.face[partner]}, and the edge does not go on: there is no face on which the blend could end"
            )
    faces = [int(uses.face[relations.partner[use]]) for use in (mine, yours)]
    if faces[0] != faces[1]:
        raise EdgeError(
            f"{title}: at its end lie faces {faces[0]} and {faces[1]}, more than three edges meet there; three can be "
            "trimmed"
        )
    return point, int(relations.partner[mine])


def _check_square(graph: EdgeGraph, passage: Passage | None, title: str) -> None:
    """Refuse a joint of which the edge between two faces leaves the rounded ones at a slant, but between planes."""
    if passage is None or passage.side is None:
        return
    uses, side = graph.uses, passage.side[0]
    faces = [int(uses.face[use]) for use in (passage.before, passage.after)]
    if all(graph.faces.kind[face] == "plane" for face in faces):
        return
    along = uses.tangent[passage.before, 0 if uses.reversed[passage.before] else -1]
    away = uses.tangent[side, -1 if uses.reversed[side] else 0]
    slant = float(np.degrees(np.arcsin(min(1.0, abs(along @ away)))))
    if slant > _SLANT:
        raise EdgeError(
            f"{title}: it goes on from {_named(graph, (passage.before, passage.after), ' to ')}, and the edge between "
            f"faces {faces[0]} and {faces[1]} slants by {slant:.2g} degrees there, expected one square to them: on a "
            "slanted one contacts at one distance from both do not meet, so that they cannot be rounded together"
        )


def _is_point(graph: EdgeGraph, one: FloatArray, other: FloatArray) -> bool:
    return bool(np.linalg.norm(one - other) <= _SAME_POINT * graph.size)


def _named(graph: EdgeGraph, rows: tuple[int, ...], between: str = ", ") -> str:
    return between.join(_names(graph, rows))


def _names(graph: EdgeGraph, rows: tuple[int, ...]) -> Iterator[str]:
    """Yield the names of edges, each as --round takes it."""
    for row in rows:
        yield f"{graph.uses.face[row]}:{graph.uses.name(row)}"


def chain_names(graph: EdgeGraph, chain: SharpChain) -> tuple[str, ...]:
    """Return the names of the edges of a chain, each as --round takes it."""
    return tuple(_names(graph, chain.rows))
