"""Words for edges of faces in files turned into surfaces and names that `Base` knows: e3, near=x,y,z, e3+e4, e3*."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

from semispline.solver.errors import EdgeError
from semispline.solver.io import LoadedSurface, in_one_unit, read_surfaces, split_spec
from semispline.solver.splines import parse_edge
from semispline.solver.topology.chain_edges import ResolvedChain, all_from, chain_of_uses, members, rows_of_chain
from semispline.solver.topology.chain_names import names_several, parse_chain
from semispline.solver.topology.face_edges import ResolvedEdge, is_of_a_face, resolved_use
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.near import NEAR, nearest_edge, point_of
from semispline.solver.topology.relations import relate

Resolved: TypeAlias = ResolvedEdge | ResolvedChain


def names_edges_of_faces(word: str) -> bool:
    """Tell whether a word names edges of faces in a file: e3, e3[0], near=x,y,z, e3+e4, e3..e9, e3*, 12:e3."""
    return names_several(word) or is_of_a_face(word)


def check_edge_word(word: str, name: str = "edge") -> None:
    """Refuse a word that names no edge, before a file is read.

    Raises
    ------
    EdgeError
    """
    if names_several(word):
        parse_chain(word, name)
    elif word.strip().startswith(NEAR):
        point_of(word.strip(), name)
    elif not is_of_a_face(word):
        parse_edge(word, name)


def resolve_edge(spec: str | Path, word: str, name: str = "edge") -> Resolved:
    """Return the surface and the name of an edge that is named as in a file, or of several that run end to end.

    Parameters
    ----------
    spec : str
        PATH, or PATH#N.
    word : str
        "e3", "near=x,y,z", "e3[0]" (of a free curve the part up to the first place where bands are cut), or a name that
        `Base` knows, which is returned as it is. "12:e3" is an edge of face 12 of the file. Several edges: "e3+e4" in
        the order in which they follow each other, "12:e3+13:e1" on several faces, "e3..e9" in walking order of their
        wire, "e3*" for all that go on smoothly from one, on its face and on its neighbours.
    name : str
        What messages call the word.

    Raises
    ------
    EdgeError
        No such edge, a point, none near the point or several; a part of what is no free curve; edges that do not run
        end to end, or whose faces have no common side edge.
    FileError, ComputationError
        As `read_surface` and `list_edges`.
    """
    (found,) = resolve_edges([(str(spec), word)], [name])
    return found


@dataclass(frozen=True, eq=False)
class _Asked:
    """One side: what was said, and the uses that it means; none where it is a name that a surface knows."""

    spec: str
    word: str
    name: str
    rows: tuple[int, ...] = ()
    parts: tuple[int | None, ...] = ()
    said: str = ""

    @property
    def path(self) -> str:
        return split_spec(self.spec)[0]

    @property
    def number(self) -> int | None:
        return split_spec(self.spec)[1]

    @property
    def point(self) -> str | None:
        """The word without what else is asked for, where it is a point."""
        return self.word.removesuffix("*") if self.word.startswith(NEAR) else None


def resolve_edges(
    edges: Sequence[tuple[str, str]],
    names: Sequence[str] = ("--edge-a", "--edge-b"),
    known: Mapping[str, MeasuredEdges] | None = None,
) -> list[Resolved]:
    """Return what `resolve_edge` does for the edges of a blend, each file read once; all in one unit.

    Edges of files that are `known` are not read again; words of points need them measured for these.

    Two points in one file without numbers of faces are two clicks: they say which face lies between, and the bases are
    the faces beyond; the same edge twice is a sharp edge with its two faces.
    """
    asked = [_Asked(spec, word.strip(), name) for (spec, word), name in zip(edges, names, strict=True)]
    for one in asked:
        check_edge_word(one.word, one.name)
    measured = _measured(asked) if known is None else dict(known)
    found = _take_faces([_with_rows(one, measured) for one in asked], measured)
    found = [_with_all(one, measured) for one in found]
    specs = [_specs(one, measured) for one in found]
    loaded = iter(_in_own_units([spec for each in specs for spec in each]))
    surfaces = [[next(loaded) for _ in each] for each in specs]
    ends = [_resolved(*one, measured) for one in zip(found, specs, surfaces, strict=True)]
    same = iter(in_one_unit([edge.loaded for end in ends for edge in members(end)]))
    return [_with_loaded(end, [next(same) for _ in members(end)]) for end in ends]


def _measured(asked: Sequence[_Asked]) -> dict[str, MeasuredEdges]:
    """Return the edges of each file of which a word speaks."""
    wanted: dict[str, list[tuple[str, int | None]]] = {}
    for one in asked:
        if names_edges_of_faces(one.word):
            wanted.setdefault(one.path, []).extend([] if one.point is None else [(one.point, one.number)])
    return {path: measured_edges(path, near=points) for path, points in wanted.items()}


def _with_rows(asked: _Asked, measured: dict[str, MeasuredEdges]) -> _Asked:
    """Return what was said with the uses that it means; of a point its nearest edge."""
    if not names_edges_of_faces(asked.word):
        return asked
    graph = measured[asked.path].graph
    if asked.point is not None:
        near = measured[asked.path].nearest[asked.point, asked.number]
        row, _, said = nearest_edge(graph, f"{asked.name} {asked.point}", near, asked.spec)
        return replace(asked, rows=(row,), parts=(None,), said=said)
    rows, parts, said = rows_of_chain(graph, parse_chain(asked.word, asked.name), asked.number, asked.name)
    return replace(asked, rows=rows, parts=parts, said=said)


def _with_all(asked: _Asked, measured: dict[str, MeasuredEdges]) -> _Asked:
    """Return a point that stands for all edges from its nearest on with these."""
    if asked.point is None or asked.point == asked.word:
        return asked
    graph = measured[asked.path].graph
    rows, stops = all_from(graph, relate(graph), asked.rows[0])
    said = "; ".join(filter(None, (f"from {asked.said}", stops)))
    return replace(asked, rows=rows, parts=(None,) * len(rows), said=said)


def _specs(asked: _Asked, measured: dict[str, MeasuredEdges]) -> list[str]:
    """Return "PATH#N" of the face of each use, or of the surface that is named."""
    if not asked.rows:
        return [asked.spec]
    face = measured[asked.path].graph.uses.face
    return [f"{asked.path}#{face[row]}" for row in asked.rows]


def _resolved(
    asked: _Asked, specs: Sequence[str], loaded: Sequence[LoadedSurface], measured: dict[str, MeasuredEdges]
) -> Resolved:
    if not asked.rows:
        return ResolvedEdge(specs[0], loaded[0], str(parse_edge(asked.word, asked.name)))
    edges = measured[asked.path]
    if len(asked.rows) == 1:
        word = _own_word(edges.graph, asked.rows[0], asked.parts[0]) if names_several(asked.word) else asked.word
        one = resolved_use(edges, asked.rows[0], specs[0], loaded[0], word, asked.name, asked.said)
        return replace(one, asked=asked.word)
    ends = [
        resolved_use(edges, row, spec, surface, _own_word(edges.graph, row, part), asked.name)
        for row, part, spec, surface in zip(asked.rows, asked.parts, specs, loaded, strict=True)
    ]
    return chain_of_uses(edges.graph, asked.rows, ends, asked.word, asked.name, asked.said)


def _own_word(graph: EdgeGraph, row: int, part: int | None) -> str:
    return graph.uses.name(row) + ("" if part is None else f"[{part}]")


def _with_loaded(end: Resolved, loaded: Sequence[LoadedSurface]) -> Resolved:
    return replace(end, loaded=loaded[0]) if isinstance(end, ResolvedEdge) else end.with_loaded(loaded)


def _in_own_units(specs: Sequence[str]) -> list[LoadedSurface]:
    """Return the surfaces, each in the unit of its own file, as its edges are."""
    paths = [split_spec(spec)[0] for spec in specs]
    found: dict[int, LoadedSurface] = {}
    for path in dict.fromkeys(paths):
        here = [k for k, other in enumerate(paths) if other == path]
        found |= dict(zip(here, read_surfaces([specs[k] for k in here]), strict=True))
    return [found[k] for k in range(len(specs))]


def _take_faces(asked: Sequence[_Asked], measured: dict[str, MeasuredEdges]) -> list[_Asked]:
    """Choose, for points in a file without a number, which face of their edge is meant."""
    open_ones = [one for one in asked if one.number is None and one.point is not None]
    if len(open_ones) == 2 and open_ones[0].path == open_ones[1].path:
        graph = measured[open_ones[0].path].graph
        first, second = (_uses_of_edge(graph, one.rows[0]) for one in open_ones)
        pair = _beyond(graph, first, second)
        if pair is not None:
            return [replace(one, rows=(row,)) for one, row in zip(open_ones, pair, strict=True)]
    for one in open_ones:
        graph = measured[one.path].graph
        both = _uses_of_edge(graph, one.rows[0])
        if len(both) > 1:
            shown = " or ".join(f"{one.path}#{graph.uses.face[row]}" for row in both)
            raise EdgeError(
                f"{one.name} {one.word}: the edge lies between faces; say which is meant: {shown}, or give two points "
                "whose edges bound one face: those beyond it are blended"
            )
    return list(asked)


def _beyond(graph: EdgeGraph, first: Sequence[int], second: Sequence[int]) -> list[int] | None:
    """Return the uses by the faces beyond the one that two edges have in common; None where there is no such face."""
    face = graph.uses.face
    if set(first) == set(second):
        return list(first) if len({int(face[row]) for row in first}) == 2 else None
    shared = {int(face[row]) for row in first} & {int(face[row]) for row in second}
    if len(shared) != 1:
        return None
    (between,) = shared
    pair = [[row for row in uses if face[row] != between] for uses in (first, second)]
    return [pair[0][0], pair[1][0]] if all(len(beyond) == 1 for beyond in pair) else None


def _uses_of_edge(graph: EdgeGraph, row: int) -> list[int]:
    """Return the use and that of the neighbour."""
    partner = int(relate(graph).partner[row])
    twin = int(graph.uses.twin[row])
    return [row, *(x for x in (partner, twin) if x != NONE)]
