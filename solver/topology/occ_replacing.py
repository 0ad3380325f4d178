"""A face of a solid taken out and another put in: the same vertices, edges anew, all else as it was.

The shape that is worked on is a copy: tolerances of vertices and curves of shared edges change in place.
Runs in the process that read the file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface, iso_curve
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_faces import closed_face, evenly, new_face, seam_edge
from semispline.solver.topology.occ_new_edges import (
    add_along_border,
    add_by_feet,
    border_edge,
    copied_edge,
    distance_to,
    end_edge,
    first_parameters,
    line_on,
    settle,
)
from semispline.solver.topology.occ_shapes import (
    CONFUSION,
    EdgeUsers,
    add_pcurve,
    ends,
    forward,
    is_reversed,
    parts,
    point_of,
    points_of,
    range_of,
    tolerance_of,
    turned,
)
from semispline.solver.topology.solid_gate import Change


@dataclass(frozen=True, eq=False)
class Rim:
    """One side of the face, as its wire walks it.

    Attributes
    ----------
    edges : tuple of TopoDS_Edge
        As the face uses them.
    faces : tuple of int
        The number of the face beyond each.
    """

    edges: tuple[Any, ...]
    faces: tuple[int, ...]

    @property
    def start(self) -> Any:
        """The vertex where it begins."""
        return ends(self.edges[0])[0]

    @property
    def end(self) -> Any:
        """The vertex where it ends."""
        return ends(self.edges[-1])[1]


@dataclass(frozen=True, eq=False)
class Opening:
    """A face to be taken out, between two contacts.

    Attributes
    ----------
    number : int
        Of the face.
    face : TopoDS_Face
    a, b : Rim
        The contacts.
    after_a, after_b : Rim or None
        The side from the end of one contact to the start of the other; None at closed rims.
    """

    number: int
    face: Any
    a: Rim
    b: Rim
    after_a: Rim | None
    after_b: Rim | None

    @property
    def is_closed(self) -> bool:
        """Two rims and perhaps a seam, instead of four sides."""
        return self.after_a is None

    @property
    def rims(self) -> tuple[Rim, ...]:
        """All sides."""
        return tuple(rim for rim in (self.a, self.after_a, self.b, self.after_b) if rim is not None)


def opening(shape: Any, number: int, contacts: tuple[Sequence[int], Sequence[int]]) -> Opening:
    """Return a face of a shape with its surroundings.

    Parameters
    ----------
    shape : TopoDS_Shape
    number : int
        Of the face.
    contacts : pair of sequences of int
        k of the edges "ek" along each contact.

    Raises
    ------
    EdgeError
        It is no face between two contacts that could be taken out.
    """
    face = parts(shape, "FACE")[number]
    title = f"--replace {number}: face {number}"
    found = list(wires(face))
    walked = [edge for edges, _ in found for edge in edges]
    users = EdgeUsers(shape)
    seams = [k for k, edge in enumerate(walked) if sum(edge.IsSame(other) for other in walked) > 1]
    sides = [[k for k in side if k not in seams] for side in contacts]
    rims = [_rim(title, number, walked, users, side) for side in sides]
    others = [k for k in range(len(walked)) if k not in sides[0] + sides[1] + seams]
    if seams or len(found) == 2:
        if others or len(seams) not in (0, 2):
            raise EdgeError(
                f"{title} has {len(found)} wires and {len(walked)} edges; a fillet with four sides, or with two rims "
                "and a seam, can be replaced"
            )
        return Opening(number, face, rims[0], rims[1], None, None)
    if len(found) != 1 or not all(whole for _, whole in found):
        raise EdgeError(
            f"{title} has {len(found)} wires; a fillet with one of four sides, or with two rims, can be replaced"
        )
    between = [_between(sides[0][-1], sides[1][0], len(walked)), _between(sides[1][-1], sides[0][0], len(walked))]
    if any(len(side) != 1 for side in between):
        counts = " and ".join(str(len(side)) for side in between)
        raise EdgeError(f"{title} has {counts} edges at the ends of its contacts, expected one at each end")
    after = [_rim(title, number, walked, users, side) for side in between]
    return Opening(number, face, rims[0], rims[1], after[0], after[1])


def put_in(shape: Any, place: Opening, surface: BSplineSurface) -> tuple[Any, Callable[[Any], Any]]:
    """Return the shape with a new face, which has the number of the old one, and what each of its parts became.

    Parameters
    ----------
    shape : TopoDS_Shape
        Changed in place where vertices need more tolerance: a copy.
    place : Opening
        Of that shape.
    surface : BSplineSurface
        u from the first contact to the second.
    """
    from OCP.BRepTools import BRepTools_ReShape

    against = runs_against(place, surface)
    faces = parts(shape, "FACE")
    new = new_face(surface)
    geometry = occ_surface(surface)
    low, high = surface.domain[1]
    # v where the first contact starts as the wire of the old face walks it, and where it ends.
    start, end = (high, low) if against else (low, high)
    (u0, u1) = surface.domain[0]
    of_a = contact_edges(place.a, faces, new, geometry, surface, u0, (start, end))
    of_b = contact_edges(place.b, faces, new, geometry, surface, u1, (end, start))
    made = of_a + of_b
    used = [[(edge, is_reversed(old)) for old, edge, _ in side] for side in (of_a, of_b)]
    if place.after_a is not None and place.after_b is not None:
        for rim, v, from_a in ((place.after_a, end, True), (place.after_b, start, False)):
            made.append(_end_edge(rim, faces, new, geometry, surface, v, from_a=from_a))
        after = [[(edge, is_reversed(old))] for old, edge, _ in made[-2:]]
    else:
        seam = seam_edge(geometry, (u0, u1), end, start, (place.a.end, place.b.start), new)
        after = [[(seam, False)], [(seam, True)]]
        settle(turned(seam, backwards=True), [new])
        settle(seam, [new])
    for _, edge, beyond in made:
        settle(edge, [new, *beyond])
    # The parameters run round the face, seen from outside, where the first contact runs against v.
    whole = closed_face(new, used[0] + after[0] + used[1] + after[1], inwards=not against)
    reshape = BRepTools_ReShape()
    for old, edge, _ in made:
        reshape.Replace(forward(old), edge)
    reshape.Replace(place.face, whole)
    return reshape.Apply(shape), reshape.Value


def change_of(place: Opening) -> Change:
    """Return what is meant to happen where a face is replaced."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(place.face, properties)
    lines = [rim_line(rim) for rim in (place.a, place.b)]
    length = float(np.mean([np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines]))
    gap = float(np.linalg.norm(evenly(lines[0]) - evenly(lines[1])[::-1], axis=1).mean())
    return Change(
        old=(place.number,),
        new=(place.number,),
        touched=(place.number, *(face for rim in place.rims for face in rim.faces)),
        volume=float(properties.Mass()) * min(length, gap),
        contacts=(*place.a.faces, *place.b.faces),
    )


def runs_against(place: Opening, surface: BSplineSurface) -> bool:
    """Tell whether v runs against the first contact as the wire of the face walks it: by the corners' distances."""
    (u0, u1), (v0, v1) = surface.domain
    corners = surface.evaluate_grid([u0, u1], [v0, v1])
    a = np.array([point_of(place.a.start), point_of(place.a.end)])
    b = np.array([point_of(place.b.end), point_of(place.b.start)])
    if place.is_closed:
        # Both ends are one point: which way it goes is seen a quarter later.
        v = v0 + (v1 - v0) * np.array([0.25, 0.75])
        corners = surface.evaluate_grid([u0, u1], v)
        a, b = (evenly(rim_line(rim), 5)[[1, 3]] for rim in (place.a, place.b))
        b = b[::-1]
    along = np.linalg.norm(corners - np.array([a, b]), axis=2).sum()
    against = np.linalg.norm(corners[:, ::-1] - np.array([a, b]), axis=2).sum()
    return bool(against < along)


def rim_line(rim: Rim) -> FloatArray:
    """Return points along a rim, as the wire walks it."""
    pieces = []
    for edge in rim.edges:
        points = points_of(edge, np.linspace(*range_of(edge), 65))
        pieces.append(points[::-1] if is_reversed(edge) else points)
    return np.concatenate(pieces)


def _rim(title: str, number: int, walked: Sequence[Any], users: EdgeUsers, side: Sequence[int]) -> Rim:
    """Return a side; refuse one along which no single other face lies."""
    from OCP.BRep import BRep_Tool

    beyond = []
    for k in side:
        edge = walked[k]
        if BRep_Tool.Degenerated_s(edge):
            raise EdgeError(f"{title}: its edge e{k} is a point; a fillet with four edges can be replaced")
        others = [face for face, _ in users.of(edge) if face != number]
        if len(others) != 1:
            said = "no other face" if not others else f"{len(others)} other faces"
            raise EdgeError(f"{title}: its edge e{k} has {said}, expected one")
        beyond.append(others[0])
    return Rim(tuple(walked[k] for k in side), tuple(beyond))


def _between(last: int, first: int, count: int) -> list[int]:
    """Return the numbers after one and before another, round and round."""
    return [(last + 1 + k) % count for k in range((first - last - 1) % count)]


def contact_edges(
    rim: Rim, faces: Sequence[Any], new: Any, geometry: Any, surface: BSplineSurface, u: float, v: tuple[float, float]
) -> list[tuple[Any, Any, list[Any]]]:
    """Return each old edge of a contact, the one that takes its place, and the face beyond."""
    border = iso_curve(surface, u=u)
    made = []
    for k, (old, beyond) in enumerate(zip(rim.edges, rim.faces, strict=True)):
        face = faces[beyond]
        edge = copied_edge(old, face)
        known = [v[0] if k == 0 else None, v[1] if k == len(rim.edges) - 1 else None]
        places = add_along_border(edge, new, border, u, tuple(known[::-1] if is_reversed(old) else known))
        if distance_to(edge, new) > max(CONFUSION, tolerance_of(old)):
            # The contact was moved to where a band follows the face: that is where the faces meet now.
            edge = border_edge(geometry.UIso(u), *places, ends(forward(old)))
            add_pcurve(edge, line_on(edge, (u, places[0]), (u, places[1])), new)
            add_by_feet(edge, face, first_parameters(old, face, ends(edge)[0]))
        made.append((old, edge, [face]))
    return made


def _end_edge(
    rim: Rim, faces: Sequence[Any], new: Any, geometry: Any, surface: BSplineSurface, v: float, *, from_a: bool
) -> tuple[Any, Any, list[Any]]:
    """Return the old edge at an end, the one that takes its place, and the face beyond."""
    (old,), (beyond,) = rim.edges, rim.faces
    u0, u1 = surface.domain[0]
    # The wire walks from contact to contact; the edge's own direction may be the other.
    backwards = is_reversed(old) == from_a
    edge = end_edge(geometry.VIso(v), ends(forward(old)), backwards=backwards)
    add_pcurve(edge, line_on(edge, (u1 if backwards else u0, v), (u0 if backwards else u1, v)), new)
    add_by_feet(edge, faces[beyond], first_parameters(old, faces[beyond], ends(edge)[0]))
    return old, edge, [faces[beyond]]
