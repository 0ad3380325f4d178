"""Two planar faces taken out and their outlines joined by new faces: two solids become one.

The shape that is worked on is a copy. Runs in the process that read the files.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.gate_report import Change
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_faces import closed_face, new_face, rebuilt, seam_edge
from semispline.solver.topology.occ_new_edges import end_edge, foot_on, line_on, settle
from semispline.solver.topology.occ_replacing import Rim, contact_edges, rim_line
from semispline.solver.topology.occ_shapes import (
    CONFUSION,
    EdgeUsers,
    add_pcurve,
    ends,
    forward,
    is_reversed,
    new_vertex,
    parts,
    point_of,
    points_of,
    range_of,
    tolerance_of,
    turned,
    with_range,
)
from semispline.solver.topology.tube_volume import tube_volume

# Tolerances: a cut of the blend that is nearer to a vertex of an outline, or to either end of the edge, ends there.
_SAME_POINT = 10.0


@dataclass(frozen=True, eq=False)
class Cap:
    """A face with one wire that is taken out.

    Attributes
    ----------
    number : int
    face : TopoDS_Face
    rim : Rim
        Its whole border.
    """

    number: int
    face: Any
    rim: Rim


@dataclass(frozen=True, eq=False)
class _Divided:
    """An outline with a vertex wherever the blend is cut.

    Attributes
    ----------
    rims : list of Rim
        What each surface meets, as the face that is taken out walks it.
    vertices : list of TopoDS_Vertex
        Where each surface begins in v.
    pieces : dict
        Number of an old edge -> what it was cut into, in its own direction; only of those that were cut.
    """

    rims: list[Rim]
    vertices: list[Any]
    pieces: dict[int, list[Any]]


def joined(shape: Any, numbers: tuple[int, int], surfaces: Sequence[BSplineSurface]) -> tuple[Any, Change]:
    """Return the solid, and what is meant to have happened.

    Parameters
    ----------
    shape : TopoDS_Shape
        A copy that holds nothing but the solids of both faces.
    numbers : (int, int)
        Those of the two faces.
    surfaces : sequence of BSplineSurface
        u from the outline of the first face to that of the second; each begins in v where the one before ends, and the
        first where the last one ends.

    Raises
    ------
    EdgeError
        A face is no end that could be taken off.
    """
    faces, users = parts(shape, "FACE"), EdgeUsers(shape)
    caps = [_cap(faces, users, number) for number in numbers]
    against = [_runs_against(cap, surfaces, end) for cap, end in zip(caps, (0, -1), strict=True)]
    if against[0] == against[1]:
        raise EdgeError(
            "seen from outside the blend runs round both outlines the same way, so that it would turn its inside out: "
            "the faces do not look towards each other; turn one of the parts"
        )
    divided = [
        _divided(cap, users, surfaces, end, faces, backwards=way)
        for cap, end, way in zip(caps, (0, -1), against, strict=True)
    ]
    made, replaced = _new_faces(divided, surfaces, faces, against=against[0])
    edges = {
        users.number(edge): [
            (next(new for old, new in replaced if old.IsSame(piece)), False)
            for piece in one.pieces.get(users.number(edge), [edge])
        ]
        for cap, one in zip(caps, divided, strict=True)
        for edge in cap.rim.edges
    }
    rims = {face for cap in caps for face in cap.rim.faces}
    became = {
        number: rebuilt(face, edges, users, []) if number in rims else face
        for number, face in enumerate(faces)
        if number not in numbers
    }
    solid = _solid(shape, numbers, became, made)
    after = parts(solid, "FACE")
    place = {number: next(n for n, x in enumerate(after) if x.IsSame(face)) for number, face in became.items()}
    expected, volume = tube_volume(*(_outline(cap) for cap in caps))
    change = Change(
        old=tuple(sorted(numbers)),
        new=tuple(n for n, face in enumerate(after) if any(face.IsSame(x) for x in made)),
        touched=tuple(sorted({*numbers, *rims})),
        volume=volume,
        contacts=tuple(sorted(rims)),
        joined=len(parts(shape, "SOLID")) - 1,
        expected=expected,
        kept=place,
    )
    return solid, change


def _cap(faces: Sequence[Any], users: EdgeUsers, number: int) -> Cap:
    face, title = faces[number], f"face {number}"
    found = list(wires(face))
    if len(found) != 1 or not found[0][1]:
        raise EdgeError(f"{title} has {len(found)} wires, expected one that can be walked round: no holes")
    edges, beyond = found[0][0], []
    for k, edge in enumerate(edges):
        others = [n for n, _ in users.of(edge) if n != number]
        if len(others) != 1 or len(users.of(edge)) != 2:
            raise EdgeError(f"{title}: its edge e{k} lies between {1 + len(others)} faces, expected two")
        beyond.append(others[0])
    return Cap(number, face, Rim(tuple(edges), tuple(beyond)))


def _outline(cap: Cap) -> tuple[FloatArray, FloatArray]:
    """Return points along the border of a face, closed, and its outward normal."""
    line = rim_line(cap.rim)
    # The wire has the inside of the face to its left, seen from outside.
    area = 0.5 * np.cross(line[:-1] - line[0], line[1:] - line[0]).sum(axis=0)
    return line, area / np.linalg.norm(area)


def _borders(surfaces: Sequence[BSplineSurface], end: int, count: int) -> FloatArray:
    """Return points along the border of all surfaces, as v runs."""
    found = [
        surface.evaluate_grid([surface.domain[0][end]], np.linspace(*surface.domain[1], count))[0]
        for surface in surfaces
    ]
    return np.concatenate(found)


def _runs_against(cap: Cap, surfaces: Sequence[BSplineSurface], end: int) -> bool:
    """Tell whether v runs against the wire of a face: by the area that each goes round."""
    line, normal = _outline(cap)
    border = _borders(surfaces, end, 129)
    return bool(np.cross(border[:-1] - line[0], border[1:] - line[0]).sum(axis=0) @ normal < 0)


def _divided(
    cap: Cap, users: EdgeUsers, surfaces: Sequence[BSplineSurface], end: int, faces: Sequence[Any], *, backwards: bool
) -> _Divided:
    """Return the outline of a face, cut where surfaces begin."""
    points = [x.evaluate_grid([x.domain[0][end]], [x.domain[1][0]])[0, 0] for x in surfaces]
    cuts: dict[int, list[tuple[float, Any]]] = {}
    vertices = []
    for point in points:
        vertex, at = _place(cap, point)
        vertices.append(vertex)
        if at is not None:
            k, t = at
            cuts.setdefault(k, []).append((t, vertex))
    edges: list[Any] = []
    beyond: list[int] = []
    pieces: dict[int, list[Any]] = {}
    for k, (edge, face) in enumerate(zip(cap.rim.edges, cap.rim.faces, strict=True)):
        if k in cuts:
            made = _cut(edge, sorted(cuts[k], key=lambda x: x[0]), faces[face])
            pieces[users.number(edge)] = made
            found = [turned(x, backwards=is_reversed(edge)) for x in (made[::-1] if is_reversed(edge) else made)]
        else:
            found = [edge]
        edges += found
        beyond += [face] * len(found)
    starts = [next(j for j, edge in enumerate(edges) if ends(edge)[0].IsSame(vertex)) for vertex in vertices]
    count = len(surfaces)
    rims = []
    for k in range(count):
        first, last = starts[k], starts[(k + 1) % count]
        if backwards:
            first, last = last, first
        length = (last - first) % len(edges) or len(edges)
        which = [(first + j) % len(edges) for j in range(length)]
        rims.append(Rim(tuple(edges[j] for j in which), tuple(beyond[j] for j in which)))
    if sum(len(rim.edges) for rim in rims) != len(edges):
        raise EdgeError(f"face {cap.number}: the blend does not go round its outline once")
    return _Divided(rims, vertices, pieces)


def _place(cap: Cap, point: FloatArray) -> tuple[Any, tuple[int, float] | None]:
    """Return the vertex of an outline at a point, or a new one, and in which edge, and where, that lies."""
    edges = cap.rim.edges
    near = [float(np.linalg.norm(point_of(ends(edge)[0]) - point)) for edge in edges]
    k = int(np.argmin(near))
    vertex = ends(edges[k])[0]
    if near[k] <= _SAME_POINT * max(CONFUSION, tolerance_of(vertex)):
        return vertex, None
    places = [foot_on(edge, point) for edge in edges]
    away = [
        float(np.linalg.norm(points_of(edge, np.array([t]))[0] - point)) for edge, t in zip(edges, places, strict=True)
    ]
    k = int(np.argmin(away))
    return new_vertex(points_of(edges[k], np.array([places[k]]))[0]), (k, places[k])


def _cut(edge: Any, at: Sequence[tuple[float, Any]], face: Any) -> list[Any]:
    """Return the parts of an edge between its ends and some vertices, in its own direction."""
    from OCP.BRep import BRep_Tool

    edge = forward(edge)
    (low, high), (first, last) = range_of(edge), ends(edge)
    curve, on_face = BRep_Tool.Curve_s(edge, low, high), BRep_Tool.CurveOnSurface_s(edge, face, low, high)
    limits = [(low, first), *at, (high, last)]
    made = []
    for (start, a), (end, b) in pairwise(limits):
        piece = with_range(curve, start, end, tolerance_of(edge), (a, b))
        add_pcurve(piece, on_face, face)
        made.append(piece)
    return made


def _new_faces(
    divided: Sequence[_Divided], surfaces: Sequence[BSplineSurface], faces: Sequence[Any], *, against: bool
) -> tuple[list[Any], list[tuple[Any, Any]]]:
    """Return the new faces, and each old edge with the one that takes its place."""
    blank = [new_face(surface) for surface in surfaces]
    shapes = [occ_surface(surface) for surface in surfaces]
    sides = _sides(divided, surfaces, shapes, blank) if len(surfaces) > 1 else []
    made, replaced = [], []
    for k, (surface, new, geometry) in enumerate(zip(surfaces, blank, shapes, strict=True)):
        (u0, u1), (low, high) = surface.domain
        start, end = (high, low) if against else (low, high)
        a, b = (one.rims[k] for one in divided)
        of_a = contact_edges(a, faces, new, geometry, surface, u0, (start, end))
        of_b = contact_edges(b, faces, new, geometry, surface, u1, (end, start))
        used = [[(one.edge, is_reversed(one.old)) for one in side] for side in (of_a, of_b)]
        if sides:
            next_one = sides[(k + 1) % len(sides)]
            after = [[(sides[k] if against else next_one, False)], [(next_one if against else sides[k], True)]]
        else:
            seam = seam_edge(geometry, (u0, u1), end, start, (a.end, b.start), new)
            after = [[(seam, False)], [(seam, True)]]
            settle(turned(seam, backwards=True), [new])
            settle(seam, [new])
        for one in (*of_a, *of_b):
            settle(one.edge, one.faces)
            replaced.append((one.old, one.edge))
        made.append(closed_face(new, used[0] + after[0] + used[1] + after[1], inwards=not against))
    return made, replaced


def _sides(
    divided: Sequence[_Divided], surfaces: Sequence[BSplineSurface], shapes: Sequence[Any], blank: Sequence[Any]
) -> list[Any]:
    """Return the edge along which each surface begins and the one before ends, from the first outline on."""
    found = []
    for k, (surface, before) in enumerate(zip(surfaces, [surfaces[-1], *surfaces[:-1]], strict=True)):
        u0, u1 = surface.domain[0]
        edge = end_edge(shapes[k].VIso(surface.domain[1][0]), [one.vertices[k] for one in divided])
        for face, v in ((blank[k], surface.domain[1][0]), (blank[k - 1], before.domain[1][1])):
            add_pcurve(edge, line_on(edge, (u0, v), (u1, v)), face)
        settle(edge, [blank[k], blank[k - 1]])
        found.append(edge)
    return found


def _solid(shape: Any, numbers: tuple[int, int], became: Mapping[int, Any], made: Any) -> Any:
    """Return one solid: the shells of both faces as one, with the new faces in it, and other shells as they were."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

    builder, shell, solid = BRep_Builder(), TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    builder.MakeSolid(solid)
    others, first, closed = [], 0, True
    for one in parts(shape, "SHELL"):
        count = len(parts(one, "FACE"))
        mine = range(first, first + count)
        first += count
        if not any(number in mine for number in numbers):
            others.append(one)
            continue
        closed = closed and one.Closed()
        for n in mine:
            if n in became:
                builder.Add(shell, became[n])
    for face in made:
        builder.Add(shell, face)
    shell.Closed(closed)
    for one in (shell, *others):
        builder.Add(solid, one)
    return solid
