"""Several edges of faces in a file as one contact: which uses a word means, and whether they run end to end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES, LoadedSurface, split_spec
from semispline.solver.topology.chain_names import ChainWord
from semispline.solver.topology.contact_walk import Passage, passage_between, smooth_run
from semispline.solver.topology.face_edges import Point, ResolvedEdge, only_face, row_of, split_part
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.topology.sides import entering, leaving

# Each of two edges that meet in a vertex may be off it by its own tolerance; and their faces as far apart again as
# samples of them show.
_BOTH = 2.0


@dataclass(frozen=True, eq=False)
class ResolvedChain:
    """Edges of faces in a file that run end to end.

    Attributes
    ----------
    spec : str
        "PATH#N": N is the face of the first edge.
    edges : tuple of ResolvedEdge
        In the order in which they follow each other.
    asked : str
        The word that was resolved.
    said : str
        What was taken, in words.
    tolerance : float
        How far apart ends of edges may lie that are one point, as the file says; model units.
    ways : tuple of ((float, float, float), (float, float, float)) or None
        Where each edge begins, which point that is, and in which direction the edge leaves it that its face shares
        with the face before; None on one face, and at the start of edges that are open.
    """

    spec: str
    edges: tuple[ResolvedEdge, ...]
    asked: str
    said: str
    tolerance: float
    ways: tuple[tuple[Point, Point] | None, ...] = ()

    @property
    def edge(self) -> str:
        """The edges by the names that the file has for them: "e3+e4", "e3+13:e1"."""
        return "+".join(self.names)

    @property
    def names(self) -> tuple[str, ...]:
        """The name of each edge, with its face where that is not the one of `spec`."""
        own = split_spec(self.spec)[1]
        return tuple(_name(edge, own) for edge in self.edges)

    @property
    def loaded(self) -> LoadedSurface:
        """The surface of the first edge's face."""
        return self.edges[0].loaded

    @property
    def is_free(self) -> bool:
        """Some of the edges are free curves."""
        return any(edge.is_free for edge in self.edges)

    def with_loaded(self, loaded: Sequence[LoadedSurface]) -> ResolvedChain:
        """Return the chain with its surfaces in another unit."""
        old, new = self.loaded.unit, loaded[0].unit
        factor = 1.0 if old is None or new is None else MILLIMETRES[old] / MILLIMETRES[new]
        edges = tuple(replace(edge, loaded=one) for edge, one in zip(self.edges, loaded, strict=True))
        ways = tuple(None if way is None else (_point(factor * np.array(way[0])), way[1]) for way in self.ways)
        return replace(self, edges=edges, tolerance=self.tolerance * factor, ways=ways)


def _name(edge: ResolvedEdge, own: int | None) -> str:
    face = split_spec(edge.spec)[1]
    entry = edge.entry
    word = edge.edge if edge.is_free or entry is None else entry.name
    return word if face == own else f"{face}:{word}"


def rows_of_chain(
    graph: EdgeGraph, words: Sequence[ChainWord], number: int | None, name: str
) -> tuple[tuple[int, ...], tuple[int | None, ...], str]:
    """Return the uses that words mean, which part of each where that is said, and where those of `e3*` end.

    Raises
    ------
    EdgeError
        No such edge, or none in the wire of the one that a run begins with.
    """
    relations = relate(graph)
    rows: list[int] = []
    parts: list[int | None] = []
    said = []
    for word in words:
        edge, part = split_part(word.edge)
        face = only_face(graph, word.face if word.face is not None else number, graph.path)
        first = row_of(graph, edge, face, name)
        if word.all:
            found, stops = all_from(graph, relations, first)
            said.append(stops)
        else:
            found = (first,) if word.last is None else _run(graph, first, row_of(graph, word.last, face, name), name)
        rows += found
        parts += [part] * len(found)
    return tuple(rows), tuple(parts), "; ".join(filter(None, said))


def all_from(graph: EdgeGraph, relations: Relations, row: int) -> tuple[tuple[int, ...], str]:
    """Return all uses that go on smoothly from one, and where they end."""
    run = smooth_run(graph, relations, row)
    if run.closed:
        return run.uses, ""
    names = [f"{graph.uses.face[x]}:{graph.uses.name(x)}" for x in (run.uses[0], run.uses[-1])]
    stops = zip(("before", "after"), names, run.stops, strict=True)
    return run.uses, "; ".join(f"it ends {where} {edge} at {stop}" for where, edge, stop in stops if stop)


def _run(graph: EdgeGraph, first: int, last: int, name: str) -> tuple[int, ...]:
    """Return the uses of a wire from one to another, in walking order."""
    uses = graph.uses
    if uses.wire[first] != uses.wire[last]:
        raise EdgeError(
            f"{name}: {uses.name(first)} and {uses.name(last)} of face #{uses.face[first]} are in different wires, "
            "expected edges of one"
        )
    found = [first]
    while found[-1] != last:
        found.append(int(uses.following[found[-1]]))
    return tuple(found)


def passages_of(graph: EdgeGraph, relations: Relations, rows: Sequence[int], name: str) -> list[Passage | None]:
    """Return how each use goes on in the next, of uses that follow each other one way or the other.

    The first says how the last one goes on in the first; None where it does not, and within one use.

    Raises
    ------
    EdgeError
        Two of them do not, or their faces have no common side edge.
    """
    uses = graph.uses
    doubled = [row for k, row in enumerate(rows) if row in rows[:k] and row != rows[k - 1]]
    if doubled:
        raise EdgeError(f"{name}: {uses.name(doubled[0])} of face #{uses.face[doubled[0]]} is there twice")
    found: list[Passage | None] = []
    for k, after in enumerate(rows):
        before = rows[k - 1]
        passage = passage_between(graph, relations, before, after) or passage_between(graph, relations, after, before)
        if passage is None and k and before != after:
            raise EdgeError(f"{name}: {_apart(graph, before, after)}")
        found.append(None if before == after else passage)
    return found


def _way(graph: EdgeGraph, passage: Passage | None) -> tuple[Point, Point] | None:
    """Return where a passage is, and in which direction its side edge leaves."""
    if passage is None or passage.side is None:
        return None
    # It leaves where the use that the walk came from ends.
    point, along = entering(graph.uses, passage.side[0])
    return _point(point), _point(along)


def _point(values: FloatArray) -> Point:
    x, y, z = (float(x) for x in values)
    return x, y, z


def _apart(graph: EdgeGraph, before: int, after: int) -> str:
    """Say why two uses are not one contact."""
    uses = graph.uses
    titles = [f"{uses.name(row)} of face #{uses.face[row]}" for row in (before, after)]
    ends = [uses.points[row][[0, -1]] for row in (before, after)]
    apart = min(float(abs(p - q).max()) for p in ends[0] for q in ends[1])
    if apart > 1e-3 * graph.size:
        return (
            f"{titles[1]} does not begin where {titles[0]} ends; name the edges in the order in which they follow each "
            "other"
        )
    if uses.face[before] == uses.face[after]:
        return f"{titles[0]} and {titles[1]} touch, but do not follow each other in one wire"
    x, y, z = leaving(uses, before)[0].tolist()
    return (
        f"{titles[0]} and {titles[1]} have no common side edge at ({x:.6g}, {y:.6g}, {z:.6g}): they are not one side; "
        "blend them one by one"
    )


def chain_of_uses(
    graph: EdgeGraph, rows: Sequence[int], edges: Sequence[ResolvedEdge], word: str, name: str, stops: str = ""
) -> ResolvedChain:
    """Return uses as a chain, whose edges are resolved.

    Raises
    ------
    EdgeError
        They do not follow each other, or their faces have no common side edge.
    """
    passages = passages_of(graph, relate(graph), rows, f"{name} {word}")
    sides = [row for passage in passages if passage is not None for row in passage.side or ()]
    # Edges go on in each other in a vertex of the file, or one that was found: that holds its ends, however far apart.
    apart = [_ends_apart(graph, passage) for passage in passages if passage is not None]
    tolerance = _BOTH * max(float(graph.uses.tolerance[[*rows, *sides]].max()), *apart, 0.0)
    ways = tuple(_way(graph, passage) for passage in passages)
    found = ResolvedChain(edges[0].spec, tuple(edges), word, "", tolerance, ways)
    count = f"{len(edges)} edges of {_counted_faces(edges)}"
    said = f"{found.edge} of {found.spec}, {count}" + (f"; {stops}" if stops else "")
    return replace(found, said=said)


def _ends_apart(graph: EdgeGraph, passage: Passage) -> float:
    end, start = leaving(graph.uses, passage.before)[0], entering(graph.uses, passage.after)[0]
    return float(np.linalg.norm(end - start))


def _counted_faces(edges: Sequence[ResolvedEdge]) -> str:
    faces = len({edge.spec for edge in edges})
    return f"{faces} faces" if faces > 1 else "one face"


def members(end: ResolvedEdge | ResolvedChain) -> Iterator[ResolvedEdge]:
    """Yield the edges of a chain, or the one edge."""
    yield from (end,) if isinstance(end, ResolvedEdge) else end.edges
