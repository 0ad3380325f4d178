"""Faces of Open CASCADE put together by hand: from a surface and a border, or from an old one with other edges."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.occ_new_edges import line_on
from semispline.solver.topology.occ_shapes import (
    CONFUSION,
    EdgeUsers,
    children,
    ends,
    forward,
    is_reversed,
    parts,
    turned,
    with_range,
)


def new_face(surface: BSplineSurface) -> Any:
    """Return a face of a surface, without a border."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Face

    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, occ_surface(surface), CONFUSION)
    return face


def closed_face(face: Any, uses: Sequence[tuple[Any, bool]], *, inwards: bool) -> Any:
    """Return a face with one wire of edges, as they are used from outside; `inwards` if its own normal points there."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Wire

    builder, wire = BRep_Builder(), TopoDS_Wire()
    builder.MakeWire(wire)
    # Edges stand in the order in which the face's own normal has them walked.
    for edge, backwards in reversed(uses) if inwards else uses:
        builder.Add(wire, turned(edge, backwards=backwards != inwards))
    wire.Closed(True)
    builder.Add(face, wire)
    return turned(face, backwards=inwards)


def seam_edge(
    geometry: Any, u: tuple[float, float], end: float, start: float, vertices: tuple[Any, Any], face: Any
) -> Any:
    """Return the seam of a face between two rims, from the first to the second.

    The wire, seen from outside, walks it so where the first rim ends, at v = `end`, and back where it starts, at
    v = `start`.
    """
    from OCP.BRep import BRep_Builder

    edge = with_range(geometry.VIso(end), *u, CONFUSION, vertices)
    lines = [line_on(edge, (u[0], v), (u[1], v)) for v in (end, start)]
    # First comes the curve of the use that has the edge's own direction in the face's own.
    BRep_Builder().UpdateEdge(edge, *(lines if start > end else lines[::-1]), face, CONFUSION)
    return edge


def rebuilt(
    face: Any,
    edges: Mapping[int, Sequence[tuple[Any, bool]]],
    users: EdgeUsers,
    more: Sequence[tuple[Any, Any, bool]],
) -> Any:
    """Return a face with other edges in the places of some, and with edges between.

    Parameters
    ----------
    face : TopoDS_Face
        As it is used.
    edges : mapping
        Number of an edge -> the edges that take its place, in its direction, and whether each runs against that.
    users : EdgeUsers
        It knows the numbers.
    more : sequence of (TopoDS_Vertex, TopoDS_Edge, bool)
        A vertex in which two edges follow each other, the edge that comes between them, and whether the face, seen from
        outside, walks that backwards.
    """
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Wire

    builder, own = BRep_Builder(), forward(face)
    found = forward(own.EmptyCopied())
    for wire in children(own):
        old = edges_of_wire(forward(wire), own)
        numbers = [users.number(edge) for edge in old]
        made = TopoDS_Wire()
        builder.MakeWire(made)
        for edge, number in zip(old, numbers, strict=True):
            walked_back = is_reversed(edge)
            new = edges.get(number, [(forward(edge), False)])
            for one, against in reversed(new) if walked_back else new:
                builder.Add(made, turned(one, backwards=walked_back != against))
            for vertex, between, backwards in more:
                if ends(edge)[1].IsSame(vertex):
                    walked = backwards != is_reversed(face)
                    builder.Add(made, turned(between, backwards=walked != is_reversed(wire)))
        made.Closed(wire.Closed())
        builder.Add(found, turned(made, backwards=is_reversed(wire)))
    builder.NaturalRestriction(found, False)
    return turned(found, backwards=is_reversed(face))


def edges_of_wire(wire: Any, face: Any) -> list[Any]:
    """Return the edges of a wire as one walks it, where that can be done, else in their order in the file."""
    from OCP.BRepTools import BRepTools_WireExplorer

    in_file = children(wire)
    found: list[Any] = []
    walk = BRepTools_WireExplorer(wire, face)
    while walk.More() and len(found) <= len(in_file):
        found.append(walk.Current())
        walk.Next()
    return found if len(found) == len(in_file) else in_file


def with_faces(
    shape: Any, beside: int, made: Mapping[int, Any], new: Sequence[Any]
) -> tuple[Any, Callable[[Any], Any]]:
    """Return a shape with some faces rebuilt and new ones in the shell of one of them, and what its parts became."""
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools_ReShape
    from OCP.TopoDS import TopoDS_Shell

    faces = parts(shape, "FACE")
    shell = next(
        (x for x in parts(shape, "SHELL") if any(face.IsSame(faces[beside]) for face in parts(x, "FACE"))), None
    )
    if has_loose_faces(shape):
        return _with_loose_faces(shape, faces, made, new)
    if shell is None or not shell.Location().IsIdentity():
        raise EdgeError(
            "the face is in no shell of its own place; write the part as a solid, not placed, and try again"
        )
    builder, found, reshape = BRep_Builder(), TopoDS_Shell(), BRepTools_ReShape()
    builder.MakeShell(found)
    for face in children(forward(shell)):
        mine = next((x for n, x in made.items() if faces[n].IsSame(face)), None)
        builder.Add(found, face if mine is None else turned(mine, backwards=is_reversed(face)))
        if mine is not None:
            reshape.Replace(forward(face), forward(mine))
    for one in new:
        builder.Add(found, turned(one, backwards=is_reversed(one) != is_reversed(shell)))
    found.Closed(shell.Closed())
    reshape.Replace(forward(shell), found)
    return reshape.Apply(shape), reshape.Value


def _with_loose_faces(
    shape: Any, faces: Sequence[Any], made: Mapping[int, Any], new: Sequence[Any]
) -> tuple[Any, Callable[[Any], Any]]:
    """Return faces that are in no shell as one, some rebuilt, new ones behind them: files keep shared edges so."""
    from OCP.BRepTools import BRepTools_ReShape

    reshape = BRepTools_ReShape()
    for n, face in made.items():
        reshape.Replace(forward(faces[n]), forward(face))
    return shell_of([*children(reshape.Apply(shape)), *new]), reshape.Value


def has_loose_faces(shape: Any) -> bool:
    """Tell whether a shape is nothing but faces."""
    return not parts(shape, "SHELL") and len(children(shape)) == len(parts(shape, "FACE"))


def shell_of(faces: Iterable[Any]) -> Any:
    """Return the shell of some faces, open or not."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell

    found, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(found)
    for one in faces:
        builder.Add(found, one)
    return found


def evenly(line: FloatArray, count: int = 65) -> FloatArray:
    """Return so many points of a polygon, equally far apart along it."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(at, along, x) for x in line.T], axis=1)
