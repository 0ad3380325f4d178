"""The two bases beside a face that is to be taken away: the faces beyond two opposite edges of it.

Between which two edges a face turns most it was blended, so that pair is taken unless edges are named.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from semispline.solver.errors import EdgeError
from semispline.solver.io import LoadedSurface, read_surfaces
from semispline.solver.topology.between import Between, measure, meet_in_a_corner
from semispline.solver.topology.contact_words import beyond, contact_word, linked
from semispline.solver.topology.face_edges import ResolvedEdge, check_face, resolved_use, row_of
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.topology.sides import Side, sides_of

# A wire of so many edges has pairs of opposite ones, whether it has corners or not.
_FOUR = 4
# Ends of an edge that are this near, in fractions of its length, are one point.
_SAME_POINT = 1e-3
# A face that turns by less, in degrees, does not turn.
STRAIGHT = 0.01


@dataclass(frozen=True, eq=False)
class ReplacedPair:
    """Two edges of faces beside a face, to be blended as if that face were not there.

    Attributes
    ----------
    face : int
        The face between: N of `PATH#N`.
    contacts : (str, str)
        Its edges, as `semispline list PATH --edges N` names them.
    a, b : ResolvedEdge
        The same edges as those of the faces beyond.
    length, width : float
        Of the contacts, and from one to the other; in the unit of the file.
    turn, radius : float
        By how much the face turns from one to the other, in degrees; the radius of a round that turns so.
    angles : (float, float)
        Between the face and each face beyond, in degrees.
    said : str
        What was taken, in words.
    """

    face: int
    contacts: tuple[str, str]
    a: ResolvedEdge
    b: ResolvedEdge
    length: float
    width: float
    turn: float
    radius: float
    angles: tuple[float, float]
    said: str


def replaced_pair(path: str | Path, face: int, edge_a: str | None = None, edge_b: str | None = None) -> ReplacedPair:
    """Return what is to be blended when a face of a file is replaced.

    Parameters
    ----------
    path : str or Path
        A STEP, IGES, BREP or 3dm file.
    face : int
        N of `PATH#N`.
    edge_a, edge_b : str, optional
        Edges of the face, "e1" and "e3"; without them the pair of opposite edges is taken between which the face is
        curved most.

    Raises
    ------
    EdgeError
        The face has no two opposite edges with faces beyond, or none that it was asked for.
    FileError, ComputationError
        As `list_edges`.
    """
    measured = measured_edges(path)
    check_face(measured.graph, face, str(path))
    between = pair_of(measured.graph, relate(measured.graph), face, edge_a, edge_b)
    specs = [f"{path}#{measured.graph.uses.face[row]}" for row in rows_beyond(measured.graph, between)]
    return resolved_pair(measured, between, read_surfaces(specs))


def resolved_pair(measured: MeasuredEdges, between: Between, loaded: Sequence[LoadedSurface]) -> ReplacedPair:
    """Return the pair beside a face, whose surfaces beyond are read.

    Raises
    ------
    EdgeError
        The edge of a face beyond has no name that its surface knows.
    """
    graph = measured.graph
    rows = rows_beyond(graph, between)
    a, b = (
        resolved_use(measured, row, f"{graph.path}#{graph.uses.face[row]}", surface, graph.uses.name(row), name)
        for row, surface, name in zip(rows, loaded, ("base A", "base B"), strict=True)
    )
    return _stated(graph, between, a, b)


def rows_beyond(graph: EdgeGraph, between: Between) -> tuple[int, int]:
    """Return the uses of both contacts by the faces beyond."""
    relations = relate(graph)
    return _beyond(graph, relations, between.a), _beyond(graph, relations, between.b)


def pair_of(
    graph: EdgeGraph, relations: Relations, face: int, edge_a: str | None = None, edge_b: str | None = None
) -> Between:
    """Return how a face lies between two of its edges: those that are named, else the pair that is curved most.

    Raises
    ------
    EdgeError
        There is no such pair.
    """
    if (edge_a is None) != (edge_b is None):
        raise EdgeError(f"--edge-a and --edge-b: found one of them, expected none or two edges of face #{face}")
    if edge_a is not None and edge_b is not None:
        rows = [row_of(graph, word, face, name) for word, name in ((edge_a, "--edge-a"), (edge_b, "--edge-b"))]
        if rows[0] == rows[1]:
            raise EdgeError(f"--edge-b: found {edge_b!r} as at A, expected another edge of face #{face}")
        sides = [_single(graph, relations, row) for row in rows]
        for side in sides:
            _beyond(graph, relations, side)
        return measure(graph, relations, face, *sides)
    found = list(opposite_pairs(graph, relations, face))
    if not found:
        raise EdgeError(_no_pair(graph, relations, face))
    # Where the face does not turn, as a chamfer, its long edges are the contacts.
    return max(found, key=lambda x: (x.curvature if x.turn > STRAIGHT else 0.0, -x.width))


def opposite_pairs(graph: EdgeGraph, relations: Relations, face: int) -> Iterator[Between]:
    """Yield how a face lies between each two opposite sides of it that both have another face beyond."""
    for a, b in opposite_sides(graph, relations, face):
        if all(_other_face(graph, relations, side) is not None for side in (a, b)):
            yield measure(graph, relations, face, a, b)


def opposite_sides(graph: EdgeGraph, relations: Relations, face: int) -> Iterator[tuple[Side, Side]]:
    """Yield each two opposite sides of a face."""
    uses = graph.uses
    rows = range(*uses.of_face(face).indices(len(uses)))
    outer = [row for row in rows if uses.wire[row] == 0]
    if len(outer) == _FOUR:
        for k in range(2):
            yield _single(graph, relations, outer[k]), _single(graph, relations, outer[k + 2])
        return
    for a, b in combinations(sides_of(graph, relations, face), 2):
        if a.closed == b.closed and not meet_in_a_corner(uses, a, b):
            yield a, b


def _beyond(graph: EdgeGraph, relations: Relations, side: Side) -> int:
    """Return the use of the edge along a side by the face beyond.

    Raises
    ------
    EdgeError
        There is none, or more than one.
    """
    found = _other_face(graph, relations, side)
    if found is None:
        raise EdgeError(_no_base(graph, relations, side))
    return found


def _stated(graph: EdgeGraph, between: Between, a: ResolvedEdge, b: ResolvedEdge) -> ReplacedPair:
    """Return a pair with what is said of it."""
    uses, relations, unit = graph.uses, relate(graph), graph.unit or "model units"
    rows = [side.uses[0] for side in (between.a, between.b)]
    contacts = uses.name(rows[0]), uses.name(rows[1])
    angles = float(relations.median[rows[0]]), float(relations.median[rows[1]])
    turns = between.turn > STRAIGHT
    turn = f"turns by {between.turn:.3g} degrees, radius {between.radius:.4g}" if turns else "does not turn"
    return ReplacedPair(
        face=between.face,
        contacts=contacts,
        a=a,
        b=b,
        length=between.length,
        width=between.width,
        turn=between.turn,
        radius=between.radius,
        angles=angles,
        said=f"face #{between.face} replaced from {contacts[0]} to {contacts[1]}: {between.length:.4g} x "
        f"{between.width:.4g} {unit}, {turn}, met at angles of {angles[0]:.2g} and {angles[1]:.2g} degrees",
    )


def _single(graph: EdgeGraph, relations: Relations, row: int) -> Side:
    """Return one use as a side."""
    points, length = graph.uses.points[row], float(relations.length[row])
    closed = bool(((points[0] - points[-1]) ** 2).sum() ** 0.5 <= _SAME_POINT * length)
    return Side((row,), closed, length)


def _other_face(graph: EdgeGraph, relations: Relations, side: Side) -> int | None:
    """Return the use by the one other face along a side; None where there is none, or more than one."""
    if len(side.uses) != 1:
        return None
    row = side.uses[0]
    partner = int(relations.partner[row])
    return None if partner == NONE or graph.uses.face[partner] == graph.uses.face[row] else partner


def _no_base(graph: EdgeGraph, relations: Relations, side: Side) -> str:
    """Say why there is no base beyond a side."""
    uses = graph.uses
    names = ", ".join(uses.name(row) for row in side.uses)
    title = f"{names} of {graph.path}#{uses.face[side.uses[0]]}"
    if len(side.uses) > 1:
        rows = beyond(relations, side.uses)
        runs = [] if rows is None else linked(graph, relations, rows)
        said = f"{title}: several edges, of which --edge-a or --edge-b takes one"
        if len(runs) != 1:
            return said
        return f"{said}; without --replace all of them are {contact_word(graph, relations, runs[0])}"
    row = side.uses[0]
    if uses.degenerate[row]:
        return f"{title} is a point"
    if uses.seam[row] or uses.twin[row] != NONE:
        return f"{title} is a seam: this face lies on both its sides"
    count = len({int(face) for face in uses.face[uses.edge == uses.edge[row]]} - {int(uses.face[row])})
    return f"{title}: {count} other faces have it" if count else f"{title}: no other face lies beyond it"


def _no_pair(graph: EdgeGraph, relations: Relations, face: int) -> str:
    """Say why no pair of edges of a face can be blended."""
    uses = graph.uses
    rows = range(*uses.of_face(face).indices(len(uses)))
    sides = list(opposite_sides(graph, relations, face))
    title = f"--replace: face #{face} of {graph.path}"
    listing = f"`semispline list {graph.path} --edges {face}` lists its edges, --edge-a and --edge-b take two of them"
    if not sides:
        return f"{title} has {len(rows)} edges, and no two of them are opposite without a common corner; {listing}"
    reasons = dict.fromkeys(
        _no_base(graph, relations, side)
        for pair in sides
        for side in pair
        if _other_face(graph, relations, side) is None
    )
    return f"{title} has no two opposite edges with one other face beyond each: {'; '.join(reasons)}; {listing}"
