"""Faces that go on into each other over their end edges, as one run with two long sides: what is replaced together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from semispline.solver.errors import EdgeError
from semispline.solver.io import LoadedSurface, read_surfaces
from semispline.solver.topology.between import Between, measure
from semispline.solver.topology.chain_edges import chain_of_uses
from semispline.solver.topology.contact_words import beyond
from semispline.solver.topology.end_faces import end_edges, going_on
from semispline.solver.topology.face_edges import check_face, resolved_use
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.topology.replacing import STRAIGHT, opposite_sides, pair_of, resolved_pair, rows_beyond
from semispline.solver.topology.resolving import Resolved

# How the sides of a face are walked along the run.
_WALKS: tuple[Callable[[Between], Sequence[int]], ...] = (lambda m: m.a.uses, lambda m: m.b.uses[::-1])


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


@dataclass(frozen=True, eq=False)
class ReplacedRun:
    """Both sides of a run, to be blended as if its faces were not there.

    Attributes
    ----------
    measured : MeasuredEdges
    run : FaceRun
    a, b : ResolvedEdge or ResolvedChain
        The sides as those of the faces beyond.
    said : str
        What was taken, in words.
    """

    measured: MeasuredEdges
    run: FaceRun
    a: Resolved
    b: Resolved
    said: str


def replaced_run(path: str, faces: Sequence[int], edge_a: str | None = None, edge_b: str | None = None) -> ReplacedRun:
    """Return what is to be blended when faces of a file are replaced together.

    Parameters and errors are those of `replaced_pair`; `edge_a` and `edge_b` are edges of the first face.
    """
    measured = measured_edges(path)
    graph = measured.graph
    for face in faces:
        check_face(graph, face, str(path))
    run = face_run(graph, relate(graph), faces, edge_a, edge_b)
    if run.is_plain:
        (between,) = run.members
        pair = resolved_pair(measured, between, _loaded(graph, rows_beyond(graph, between)))
        return ReplacedRun(measured, run, pair.a, pair.b, pair.said)
    a, b = _sides(measured, run)
    length = sum(member.length for member in run.members)
    width = sum(member.width * member.length for member in run.members) / length
    kind = "a closed run, " if run.closed and len(run.members) > 1 else ""
    said = (
        f"{_counted(run.faces)} replaced from {a.edge} to {b.edge}: {kind}{length:.4g} x {width:.4g} "
        f"{graph.unit or 'model units'}"
    )
    return ReplacedRun(measured, run, a, b, said)


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
            raise EdgeError(f"--replace: {_counted(faces)} branch at face {face}, expected a run")
    if len(members) < len(faces):
        rest = [n for n in faces if n not in {x.face for x in members}]
        raise EdgeError(
            f"--replace: {_counted(rest)} and {_counted([x.face for x in members])} do not go on into each other over "
            "ends of both; replace them one after the other"
        )
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
        raise EdgeError(
            f"--replace: face {face} lies between no two sides at whose ends {_counted(sorted(own - {face}))} begin"
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


def _sides(measured: MeasuredEdges, run: FaceRun) -> list[Resolved]:
    """Return both sides of a run as the faces beyond have them."""
    graph = measured.graph
    # The faces beyond walk side a against the run, and side b along it.
    both = [beyond(relate(graph), [row for m in run.members for row in uses(m)]) or () for uses in _WALKS]
    # Each file is read once.
    loaded = iter(_loaded(graph, [row for rows in both for row in rows]))
    return [_side(measured, rows, [next(loaded) for _ in rows], name) for rows, name in zip(both, "AB", strict=True)]


def _side(measured: MeasuredEdges, rows: Sequence[int], loaded: Sequence[LoadedSurface], name: str) -> Resolved:
    graph = measured.graph
    specs = [f"{graph.path}#{graph.uses.face[row]}" for row in rows]
    edges = [
        resolved_use(measured, row, spec, surface, graph.uses.name(row), f"base {name}")
        for row, spec, surface in zip(rows, specs, loaded, strict=True)
    ]
    if len(edges) == 1:
        return edges[0]
    word = "+".join(f"{graph.uses.face[row]}:{graph.uses.name(row)}" for row in rows)
    return chain_of_uses(graph, rows, edges, word, f"base {name}")


def _loaded(graph: EdgeGraph, rows: Sequence[int]) -> list[LoadedSurface]:
    return list(read_surfaces([f"{graph.path}#{graph.uses.face[row]}" for row in rows]))


def _counted(faces: Sequence[int]) -> str:
    return f"face {faces[0]}" if len(faces) == 1 else f"faces {', '.join(map(str, faces))}"
