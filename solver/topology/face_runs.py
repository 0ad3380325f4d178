"""Faces that go on into each other over their end edges, as one run with two long sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from semispline.solver.errors import EdgeError
from semispline.solver.topology.between import Between, measure
from semispline.solver.topology.contact_words import beyond
from semispline.solver.topology.end_faces import end_edges, going_on
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.topology.replacing import STRAIGHT, opposite_sides, pair_of


@dataclass(frozen=True, eq=False)
class FaceRun:
    """Faces in the order in which they go on into each other.

    Attributes
    ----------
    members : tuple of Between
        The wire of each walks its side a, its end edge to the next one, its side b, and the end edge to the one before.
    closed : bool
        The last one goes on into the first.
    """

    members: tuple[Between, ...]
    closed: bool

    @property
    def faces(self) -> tuple[int, ...]:
        """The faces by their numbers."""
        return tuple(member.face for member in self.members)

    @property
    def is_plain(self) -> bool:
        """Whether it is one face with one edge along each side."""
        return len(self.members) == 1 and all(len(x.uses) == 1 for m in self.members for x in (m.a, m.b))

    def ends(self, graph: EdgeGraph) -> list[int]:
        """Return the uses across both ends of the run; none of a closed one."""
        if self.closed:
            return []
        rows = [row for m in self.members for row in end_edges(graph, m.face, (m.a.uses, m.b.uses))]
        partners = relate(graph).partner
        own = set(self.faces)
        return [row for row in rows if partners[row] == NONE or int(graph.uses.face[partners[row]]) not in own]


def face_run(
    graph: EdgeGraph, relations: Relations, faces: Sequence[int], edge_a: str | None = None, edge_b: str | None = None
) -> FaceRun:
    """Return faces in the order in which they go on into each other.

    Raises
    ------
    EdgeError
        They do not, or one of them lies between no two sides.
    """
    doubled = [face for k, face in enumerate(faces) if face in faces[:k]]
    if doubled:
        raise EdgeError(f"--replace: face {doubled[0]} is there twice")
    own = set(faces)
    first = _member(graph, relations, faces[0], own, edge_a, edge_b)
    betweens = {face: _member(graph, relations, face, own) for face in faces[1:]} | {faces[0]: first}
    ends = {n: set(end_edges(graph, n, (x.a.uses, x.b.uses))) for n, x in betweens.items()}
    if len(faces) == 1:
        return FaceRun((first,), first.a.closed)
    # Which face lies beyond which end edge.
    links = {
        row: int(graph.uses.face[relations.partner[row]])
        for n in faces
        for row in ends[n]
        if relations.partner[row] != NONE and relations.partner[row] in ends.get(_face(graph, relations, row), ())
    }
    start = next((n for n in faces if sum(row in links for row in ends[n]) < 2), faces[0])
    members, face, entry = [], start, None
    while True:
        member, leave = _turned(graph, betweens[face], links, entry)
        members.append(member)
        if leave not in links or links[leave] == start:
            break
        face, entry = links[leave], int(relations.partner[leave])
        if face in {x.face for x in members}:
            raise EdgeError(f"--replace: the faces {listed(faces)} branch at face {face}, expected a run")
    if len(members) < len(faces):
        raise EdgeError(f"{not_one_run(faces)}; replace them one after the other")
    creased = [row for row in links if row not in going_on(graph, relations, [row])]
    if creased:
        row = creased[0]
        raise EdgeError(
            f"--replace: faces {graph.uses.face[row]} and {links[row]} meet at {relations.median[row]:.3g} degrees, "
            "expected faces that go on into each other smoothly; replace them one after the other"
        )
    return FaceRun(tuple(members), leave in links)


def runs_on(graph: EdgeGraph, relations: Relations, run: FaceRun) -> bool:
    """Tell whether a run goes on smoothly into faces that are none of its own."""
    return bool(going_on(graph, relations, run.ends(graph)))


def _face(graph: EdgeGraph, relations: Relations, row: int) -> int:
    return int(graph.uses.face[relations.partner[row]])


def _member(
    graph: EdgeGraph,
    relations: Relations,
    face: int,
    own: set[int],
    edge_a: str | None = None,
    edge_b: str | None = None,
) -> Between:
    """Return how a face lies between two sides, across the ends of which lie the others of its own run."""
    if edge_a is not None or edge_b is not None:
        return pair_of(graph, relations, face, edge_a, edge_b)
    uses = graph.uses
    found = list(_pairs(graph, relations, face))
    rows = range(*uses.of_face(face).indices(len(uses)))
    shared = {row for row in rows if relations.partner[row] != NONE and _face(graph, relations, row) in own - {face}}
    fitting = [x for x in found if shared <= set(end_edges(graph, face, (x.a.uses, x.b.uses)))]
    if len(own) == 1:
        single = [x for x in found if len(x.a.uses) == len(x.b.uses) == 1]
        if single or not found:
            # It says what is wrong.
            return pair_of(graph, relations, face)
    if not fitting:
        others = sorted(own - {face})
        raise EdgeError(
            f"--replace: face {face} has no two opposite sides at whose ends {counted(others)} "
            f"{'begins' if len(others) == 1 else 'begin'}"
        )
    return max(fitting, key=lambda x: (x.curvature if x.turn > STRAIGHT else 0.0, -x.width))


def _pairs(graph: EdgeGraph, relations: Relations, face: int) -> Iterator[Between]:
    """Yield how a face lies between opposite sides, each of one or more edges with another face beyond."""
    for a, b in opposite_sides(graph, relations, face):
        over = beyond(relations, [*a.uses, *b.uses])
        if over is not None and all(graph.uses.face[row] != face for row in over):
            yield measure(graph, relations, face, a, b)


def _turned(graph: EdgeGraph, member: Between, links: dict[int, int], entry: int | None) -> tuple[Between, int]:
    """Return a face with its sides so that the run leaves it where a ends, and the end edge there.

    The wire comes from the edge over which the run enters to the side that goes on from that of the face before.
    """
    swapped = replace(member, a=member.b, b=member.a)
    both = [(x, int(graph.uses.following[x.a.uses[-1]])) for x in (member, swapped)]
    if entry is None:
        return next((x for x in both if x[1] in links), both[0])
    return next(x for x in both if x[1] != entry)


def listed(words: Sequence[object]) -> str:
    """Return words as one says them.

    Examples
    --------
    >>> listed([3]), listed([3, 4]), listed([3, 4, 5])
    ('3', '3 and 4', '3, 4 and 5')
    """
    first, last = words[:-1], str(words[-1])
    return f"{', '.join(map(str, first))} and {last}" if first else last


def not_one_run(faces: Sequence[int]) -> str:
    """Say that faces do not go on into each other."""
    return f"--replace: {counted(faces)} do not go on into each other over ends of both"


def counted(faces: Sequence[int]) -> str:
    """Return what some faces are called."""
    return f"{'face' if len(faces) == 1 else 'faces'} {listed(faces)}"
