"""The edges of a face as its file has them, named; and e3 and near=x,y,z turned into names that `Base` knows."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from semispline.solver.errors import EdgeError, FileError
from semispline.solver.io import LoadedSurface, read_surfaces, split_spec
from semispline.solver.splines import Surface
from semispline.solver.topology.edge_names import EdgeKind, line_tolerance, named_edge
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.near import NEAR
from semispline.solver.topology.relations import relate

if TYPE_CHECKING:
    from semispline.solver.topology.trim_curves import TrimCurve

_OF_A_FACE = re.compile(r"e([0-9]{1,9})")
# A part of a free curve, where that was cut: e3[0].
_PART = re.compile(r"(e[0-9]{1,9})\[([0-9]{1,9})\]")
Point = tuple[float, float, float]


@dataclass(frozen=True)
class FaceEdge:
    """An edge of a trimmed face.

    Attributes
    ----------
    name : str
        "e0", "e1", .. in walking order, the outer wire first.
    wire : int
        0 is the outer one.
    kind : {"whole", "part", "inner", "free", "point", "not classified"}
        A whole natural edge of the surface or a part of one, a line of constant parameter inside or a part of one, any
        other curve, or a point.
    edge : str or None
        What `Base` calls it: "u1", "u1[0.2,0.6]", "u=0.3+", ..
    seam : bool
        The face lies on both sides.
    length : float
    neighbour : int or None
        The face on the other side; itself at a seam; None where there is none, or more than one.
    neighbour_edge : str or None
    sewn : bool
        The file says that both have this edge; else the neighbour was found by its place.
    off : float
        How far the edge is from the line that is named, at most.
    start, middle, end : (float, float, float)
        In walking order: the face lies to the left, seen from outside.
    """

    name: str
    wire: int
    kind: EdgeKind
    edge: str | None
    seam: bool
    length: float
    neighbour: int | None
    neighbour_edge: str | None
    sewn: bool
    off: float
    start: Point
    middle: Point
    end: Point


@dataclass(frozen=True)
class FaceEdges:
    """The edges of a face.

    Attributes
    ----------
    path : str
    face : int
        N of `PATH#N`.
    kind : str
        What the file holds.
    reversed : bool
        The face looks against S_u x S_v.
    walked : bool
        False where a wire is broken: the edges are then in the order of the file.
    unit : str or None
    tolerance : float
        The length within which an edge is taken for a line of constant parameter.
    edges : tuple of FaceEdge
    """

    path: str
    face: int
    kind: str
    reversed: bool
    walked: bool
    unit: str | None
    tolerance: float
    edges: tuple[FaceEdge, ...]


@dataclass(frozen=True, eq=False)
class ResolvedEdge:
    """An edge of a surface in a file: by a name that `Base` knows, or a free curve, along which bands are made.

    Attributes
    ----------
    spec : str
        "PATH#N": where a point says which face is meant the number is that face's.
    loaded : LoadedSurface
        The whole surface of the face, without its trimming; without its boundary where the edge is one of the face's.
    edge : str
        What `Base` calls it; of a free curve "e3", or "e3[0]", the first part of it where it was cut.
    asked : str or None
        The word that was resolved; None where it was a name already.
    entry : FaceEdge or None
        What is known of the edge of the face.
    said : str
        What was taken, in words; "" where nothing was resolved.
    curve : TrimCurve or None
        A free curve in the face to which the contact was moved.
    """

    spec: str
    loaded: LoadedSurface
    edge: str
    asked: str | None = None
    entry: FaceEdge | None = None
    said: str = ""
    curve: TrimCurve | None = None

    @property
    def surface(self) -> Surface:
        """The whole surface."""
        return self.loaded.surface

    @property
    def is_free(self) -> bool:
        """No parameter of the surface is constant along it: `edge_bases` makes bands, which `Base` takes."""
        return self.curve is not None or (self.entry is not None and self.entry.kind == "free")

    @property
    def part(self) -> int | None:
        """Which part of a free curve is meant; None for all of it."""
        return split_part(self.edge)[1]


def is_near(word: str) -> bool:
    """Tell whether a word names an edge by a point."""
    return word.strip().startswith(NEAR)


def is_of_a_face(word: str) -> bool:
    """Tell whether a word names an edge of a face in a file: e3, e3[0], near=x,y,z."""
    return bool(_OF_A_FACE.fullmatch(split_part(word)[0])) or is_near(word)


def split_part(word: str) -> tuple[str, int | None]:
    """Split e3[0], the first part of a free curve.

    Examples
    --------
    >>> split_part("e3[0]"), split_part("e3"), split_part("u1[0,1]")
    (('e3', 0), ('e3', None), ('u1[0,1]', None))
    """
    found = _PART.fullmatch(word.strip())
    return (word.strip(), None) if found is None else (found[1], int(found[2]))


def list_edges(path: str | Path, face: int) -> FaceEdges:
    """Return the edges of a face of a STEP, IGES, BREP or 3dm file, as `semispline list PATH --edges N` numbers them.

    Raises
    ------
    FileError
        Missing, broken, of another format, no such face, or one without a B-spline form.
    ComputationError
        The process that read the file was killed.
    """
    measured = measured_edges(path, [face])
    check_face(measured.graph, face, str(path))
    (loaded,) = read_surfaces([f"{path}#{face}"])
    return _edges_of(measured, face, loaded)


def resolved_use(
    measured: MeasuredEdges, row: int, spec: str, loaded: LoadedSurface, word: str, name: str, near: str = ""
) -> ResolvedEdge:
    """Return a use of an edge as its surface knows it; `word`, and how near it is, is what it was found by.

    Raises
    ------
    EdgeError
        It has no name that a surface knows.
    """
    return _resolved(spec, loaded, word, edge_of_use(measured, row, loaded), name, near)


def edge_of_use(measured: MeasuredEdges, row: int, loaded: LoadedSurface) -> FaceEdge:
    """Return what is known of an edge of a face whose surface is read."""
    uses = measured.graph.uses
    return _edges_of(measured, int(uses.face[row]), loaded).edges[int(uses.number[row])]


def only_face(graph: EdgeGraph, number: int | None, path: str) -> int:
    """Return the number of a face; without one that of the only face of the file."""
    if number is None:
        if len(graph.faces) != 1:
            raise FileError(f"{path}: holds {len(graph.faces)} surfaces; choose one as {path}#N")
        return 0
    check_face(graph, number, path)
    return number


def check_face(graph: EdgeGraph, face: int, path: str) -> None:
    """Refuse a number that no face of the file has."""
    count = len(graph.faces)
    if not 0 <= face < count:
        raise FileError(f"{path}#{face}: no such surface; the file holds {count}, numbered 0 to {count - 1}")


def row_of(graph: EdgeGraph, word: str, face: int, name: str) -> int:
    """Return the use that is called "e3" in a face."""
    if not _OF_A_FACE.fullmatch(word):
        raise EdgeError(f"{name}: found {word!r}, expected an edge of face #{face} of {graph.path}, as e0")
    number = int(word[1:])
    rows = graph.uses.of_face(face)
    count = rows.stop - rows.start
    if number >= count:
        known = f"its edges are e0 to e{count - 1}" if count else "it has no edges"
        raise EdgeError(f"{name}: found {word!r}, but face #{face} of {graph.path} has no such edge: {known}")
    return int(rows.start) + number


def _resolved(spec: str, loaded: LoadedSurface, word: str, entry: FaceEdge, name: str, near: str) -> ResolvedEdge:
    title = f"{name} {word}: {entry.name} of {spec}"
    edge, part = entry.edge, split_part(word)[1]
    if entry.kind == "free":
        edge = entry.name if part is None else f"{entry.name}[{part}]"
    elif edge is None:
        why = "is a point" if entry.kind == "point" else "cannot be told: the edge was not found on the surface"
        path, number = split_spec(spec)
        raise EdgeError(f"{title} {why}; `semispline list {path} --edges {number or 0}` lists the edges of the face")
    elif part is not None:
        raise EdgeError(
            f"{title} is {edge}: only free curves are cut into parts; name {entry.name}, or a part as u1[0,1]"
        )
    if entry.seam and near:
        raise EdgeError(f"{title} is a seam: both its sides are of this face; name one of them, as {edge}")
    is_what = "a free curve" if entry.kind == "free" else edge
    said = f"{entry.name} of {spec} is {is_what}" + (f" ({near})" if near else "")
    # It is the face's own: what its surface does elsewhere needs no warning.
    return ResolvedEdge(spec, replace(loaded, boundary=None), edge, word, entry, said)


def _edges_of(measured: MeasuredEdges, face: int, loaded: LoadedSurface) -> FaceEdges:
    graph = measured.graph
    rows = list(range(*graph.uses.of_face(face).indices(len(graph.uses))))
    tolerance = max((line_tolerance(graph, row) for row in rows), default=0.0)
    return FaceEdges(
        path=graph.path,
        face=face,
        kind=graph.faces.kind[face],
        reversed=bool(graph.faces.reversed[face]),
        walked=bool(graph.faces.walked[face]),
        unit=graph.unit,
        tolerance=tolerance,
        edges=tuple(_entries(measured, face, rows, loaded)),
    )


def _entries(measured: MeasuredEdges, face: int, rows: Sequence[int], loaded: LoadedSurface) -> Iterator[FaceEdge]:
    graph, uses = measured.graph, measured.graph.uses
    relations = relate(graph)
    lengths = measured.lengths.get(face) or [float(x) for x in relations.length[list(rows)]]
    for row, length in zip(rows, lengths, strict=True):
        named = named_edge(graph, row, loaded.surface, loaded.deviation or 0.0)
        beyond = int(uses.twin[row] if uses.twin[row] != NONE else relations.partner[row])
        start, middle, end = (tuple(x) for x in uses.walked_points(row)[[0, uses.points.shape[1] // 2, -1]].tolist())
        yield FaceEdge(
            name=uses.name(row),
            wire=int(uses.wire[row]),
            kind=named.kind,
            edge=None if named.name is None else str(named.name),
            seam=bool(uses.seam[row] or uses.twin[row] != NONE),
            length=0.0 if named.kind == "point" else length,
            neighbour=None if beyond == NONE else int(uses.face[beyond]),
            neighbour_edge=None if beyond == NONE else uses.name(beyond),
            sewn=not bool(relations.matched[row]),
            off=named.off,
            start=start,
            middle=middle,
            end=end,
        )
