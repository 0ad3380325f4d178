"""A sharp edge of a solid rounded: both its faces trimmed back, a new face between, the end faces trimmed anew.

The shape that is worked on is a copy. Runs in the process that read the file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_faces import closed_face, evenly, new_face, rebuilt, seam_edge, with_face
from semispline.solver.topology.occ_new_edges import (
    add_by_feet,
    border_edge,
    end_edge,
    foot_on,
    line_on,
    settle,
    trimmed,
)
from semispline.solver.topology.occ_shapes import (
    EdgeUsers,
    add_pcurve,
    ends,
    forward,
    is_reversed,
    new_vertex,
    parameters_of,
    parts,
    points_of,
    range_of,
)
from semispline.solver.topology.solid_gate import Change

# Of the length of an edge: a cut nearer to its end leaves nothing of it.
_LEFT = 1e-6


@dataclass(frozen=True, eq=False)
class _Side:
    """A face beside the edge, and what is trimmed of it at one end.

    Attributes
    ----------
    vertex : TopoDS_Vertex
        Where the new border begins or ends.
    old : int or None
        The edge there that is trimmed, by its number.
    at : float
        Its parameter.
    """

    vertex: Any
    old: int | None
    at: float


@dataclass(frozen=True, eq=False)
class _Sharp:
    """The edge and the two faces beside it."""

    shape: Any
    users: EdgeUsers
    edge: Any
    a: int
    b: int
    is_reversed_in_a: bool
    title: str


def rounded(
    shape: Any, number: int, k: int, surface: BSplineSurface, *, grows: bool | None
) -> tuple[Any, Callable[[Any], Any], Change]:
    """Return the shape with an edge rounded, what each of its parts became, and what is meant to have happened.

    Parameters
    ----------
    shape : TopoDS_Shape
        A copy.
    number, k : int
        A face, and of which of its edges.
    surface : BSplineSurface
        u from that face to the other.
    grows : bool or None
        Whether the edge is an inner one.

    Raises
    ------
    EdgeError
        The edge cannot be rounded so.
    """
    sharp = _sharp(shape, number, k)
    faces, new = parts(shape, "FACE"), new_face(surface)
    along = _runs_along(sharp.edge, surface)
    (u0, u1), (v0, v1) = surface.domain
    v = (v0, v1) if along else (v1, v0)
    vertices = ends(sharp.edge)
    is_closed = vertices[0].IsSame(vertices[1])
    corners = surface.evaluate_grid([u0, u1], v)
    # [side][end]
    sides = [
        [_side(sharp, face, vertex, corners[i, j]) for j, vertex in enumerate(vertices[: 1 if is_closed else 2])]
        for i, face in enumerate((sharp.a, sharp.b))
    ]
    if is_closed:
        sides = [[side[0], side[0]] for side in sides]
    geometry = occ_surface(surface)
    contacts = []
    for i, (face, u) in enumerate(((sharp.a, u0), (sharp.b, u1))):
        edge = border_edge(geometry.UIso(u), *v, [side.vertex for side in sides[i]])
        add_pcurve(edge, line_on(edge, (u, v[0]), (u, v[1])), new)
        add_by_feet(edge, faces[face], _start_on(sharp, sides[i][0], face, faces[face]))
        contacts.append(edge)
    replaced = _trims(sharp, sides, vertices)
    walk, more = _new_border(sharp, sides, contacts, new, geometry, surface, v, faces, closed=is_closed)
    for edge, face in zip(contacts, (sharp.a, sharp.b), strict=True):
        settle(edge, [new, faces[face]])
    # Seen from outside the parameters run round the face where its first border runs against v.
    backwards = not sharp.is_reversed_in_a
    whole = closed_face(new, walk, inwards=along != backwards)
    touched = {face: faces[face] for face in (sharp.a, sharp.b, *(f for f, *_ in more))}
    for n in replaced:
        touched |= {face: faces[face] for face, _ in sharp.users.of(sharp.users.edge(n))}
    own = sharp.users.number(sharp.edge)
    made = {}
    for n, face in touched.items():
        edges = dict(replaced)
        if n in (sharp.a, sharp.b):
            edges[own] = contacts[0 if n == sharp.a else 1]
        made[n] = rebuilt(face, edges, sharp.users, [x[1:] for x in more if x[0] == n])
    after, image = with_face(shape, sharp.a, made, whole)
    place = next(n for n, face in enumerate(parts(after, "FACE")) if face.IsSame(whole))
    return after, image, _change(sharp, contacts, place, tuple(touched), grows=grows)


def _sharp(shape: Any, number: int, k: int) -> _Sharp:
    face = parts(shape, "FACE")[number]
    walked = [edge for edges, _ in wires(face) for edge in edges]
    users = EdgeUsers(shape)
    title = f"edge {number}:e{k}"
    if not 0 <= k < len(walked):
        raise EdgeError(f"{title}: face {number} has no such edge, they are e0 to e{len(walked) - 1}")
    found = users.of(walked[k])
    if len(found) != 2 or found[0][0] == found[1][0]:
        raise EdgeError(f"{title}: {len(found)} uses by faces, expected those of two faces")
    (other,) = (n for n, _ in found if n != number)
    return _Sharp(shape, users, forward(walked[k]), number, other, is_reversed(walked[k]), title)


def _runs_along(edge: Any, surface: BSplineSurface) -> bool:
    """Tell whether v runs in the direction of the edge."""
    t = np.linspace(*range_of(edge), 5)[[1, 3]]
    points = points_of(edge, t)
    low, high = surface.domain[1]
    u0, u1 = surface.domain[0]
    middle = surface.evaluate_grid([u0, u1], low + (high - low) * np.array([0.25, 0.75])).mean(axis=0)
    along, against = (float(np.linalg.norm(x - points, axis=1).sum()) for x in (middle, middle[::-1]))
    return along <= against


def _side(sharp: _Sharp, face: int, vertex: Any, corner: FloatArray) -> _Side:
    """Return where a new border ends: on the other edge that the face has at the vertex, or anywhere at a free rim."""
    around = [edge for edge in sharp.users.at(vertex) if not edge.IsSame(sharp.edge)]
    own = [edge for edge in around if any(n == face for n, _ in sharp.users.of(edge))]
    first, last = ends(sharp.edge)
    is_closed = first.IsSame(last)
    if not is_closed and (len(around) != 2 or len(own) != 1):
        raise EdgeError(f"{sharp.title}: {len(around) + 1} edges meet at its end, of which three can be trimmed")
    if is_closed and len(own) > 1:
        raise EdgeError(f"{sharp.title}: {len(own)} other edges of face {face} meet it, expected a seam at most")
    if not own:
        return _Side(new_vertex(corner), None, 0.0)
    at = foot_on(own[0], corner)
    low, high = range_of(own[0])
    near = _LEFT * (high - low)
    if not low + near < at < high - near:
        here = low if ends(forward(own[0]))[0].IsSame(vertex) else high
        if abs(at - here) <= near:
            raise EdgeError(
                f"{sharp.title}: on face {face} the contact does not meet the next edge: the face beyond its end "
                "would have to grow"
            )
        raise EdgeError(f"{sharp.title}: the cut reaches past the next edge of face {face}; take a smaller one")
    return _Side(new_vertex(corner), sharp.users.number(own[0]), at)


def _start_on(sharp: _Sharp, side: _Side, number: int, face: Any) -> FloatArray:
    """Return where on a face a new border begins, as far as it is known."""
    first, last = ends(sharp.edge)
    if side.old is None or first.IsSame(last):
        edge, t = sharp.edge, range_of(sharp.edge)[0]
    else:
        edge, t = sharp.users.edge(side.old), side.at
    used = next(x for n, x in sharp.users.of(edge) if n == number)
    return np.asarray(parameters_of(used, face, np.array([t]))[0])


def _trims(sharp: _Sharp, sides: Sequence[Sequence[_Side]], vertices: tuple[Any, Any]) -> dict[int, Any]:
    """Return for the number of each edge that is trimmed the edge that is left."""
    wanted: dict[int, list[tuple[Any, _Side]]] = {}
    for side in sides:
        for vertex, one in zip(vertices, side, strict=True):
            if one.old is not None and not any(one is other for _, other in wanted.get(one.old, [])):
                wanted.setdefault(one.old, []).append((vertex, one))
    return {
        n: trimmed(sharp.users.edge(n), [(vertex, one.vertex, one.at) for vertex, one in found])
        for n, found in wanted.items()
    }


def _new_border(
    sharp: _Sharp,
    sides: Sequence[Sequence[_Side]],
    contacts: Sequence[Any],
    new: Any,
    geometry: Any,
    surface: BSplineSurface,
    v: tuple[float, float],
    faces: Sequence[Any],
    *,
    closed: bool,
) -> tuple[list[tuple[Any, bool]], list[tuple[int, int, int, Any, bool]]]:
    """Return the border of the new face as it is walked, and end edges with their faces and between which edges.

    Contacts have the direction of the old edge. The first face uses that as before, so the new one walks it the other
    way.
    """
    u0, u1 = surface.domain[0]
    forwards = sharp.is_reversed_in_a
    if closed:
        # The walk ends the first border at one end of v and begins it at the other.
        end, start = (v[1], v[0]) if forwards else (v[0], v[1])
        seam = seam_edge(geometry, (u0, u1), end, start, (sides[0][0].vertex, sides[1][0].vertex), new)
        return [(contacts[0], not forwards), (seam, False), (contacts[1], forwards), (seam, True)], []
    lines, more = [], []
    for j in (0, 1):
        a, b = sides[0][j], sides[1][j]
        assert a.old is not None
        assert b.old is not None
        (beyond,) = (n for n, _ in sharp.users.of(sharp.users.edge(a.old)) if n != sharp.a)
        if beyond not in [n for n, _ in sharp.users.of(sharp.users.edge(b.old))]:
            raise EdgeError(f"{sharp.title}: more than one face lies beyond its end, expected one that can be trimmed")
        edge = end_edge(geometry.VIso(v[j]), (a.vertex, b.vertex))
        add_pcurve(edge, line_on(edge, (u0, v[j]), (u1, v[j])), new)
        add_by_feet(edge, faces[beyond], _start_on(sharp, a, beyond, faces[beyond]))
        settle(edge, [new, faces[beyond]])
        lines.append(edge)
        # The new face goes from a to b where its first border ends; the end face the other way.
        ends_here = (j == 1) == forwards
        more.append((beyond, a.old, b.old, edge, ends_here))
    after_a, after_b = (lines[1], lines[0]) if forwards else (lines[0], lines[1])
    return [(contacts[0], not forwards), (after_a, False), (contacts[1], forwards), (after_b, True)], more


def _change(
    sharp: _Sharp, contacts: Sequence[Any], place: int, touched: tuple[int, ...], *, grows: bool | None
) -> Change:
    lines: Mapping[str, FloatArray] = {
        name: evenly(points_of(edge, np.linspace(*range_of(edge), 65)))
        for name, edge in (("edge", sharp.edge), ("a", contacts[0]), ("b", contacts[1]))
    }
    length = float(np.linalg.norm(np.diff(lines["edge"], axis=0), axis=1).sum())
    across = [
        float(np.linalg.norm(lines[x] - lines[y], axis=1).mean()) for x, y in (("edge", "a"), ("edge", "b"), ("a", "b"))
    ]
    return Change(
        old=(),
        new=(place,),
        touched=touched,
        volume=length * (across[0] + across[1]) * min(across[2], length),
        contacts=(sharp.a, sharp.b),
        grows=grows,
    )
