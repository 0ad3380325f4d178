"""A face of a solid taken out and another put in: the same vertices, edges anew, all else as it was.

The shape that is worked on is a copy: tolerances of vertices and curves of shared edges change in place.
Runs in the process that read the file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import occ_surface
from semispline.solver.splines import BSplineSurface, iso_curve
from semispline.solver.topology.gate_report import Change
from semispline.solver.topology.occ_edges import wires
from semispline.solver.topology.occ_faces import closed_face, evenly, has_loose_faces, new_face, seam_edge, shell_of
from semispline.solver.topology.occ_new_edges import (
    add_across_border,
    add_along_border,
    add_by_feet,
    border_edge,
    copied_edge,
    distance_to,
    end_edge,
    first_parameters,
    line_across,
    line_on,
    settle,
)
from semispline.solver.topology.occ_shapes import (
    CONFUSION,
    EdgeUsers,
    add_pcurve,
    children,
    ends,
    forward,
    is_reversed,
    parts,
    points_of,
    range_of,
    tolerance_of,
    turned,
)
from semispline.solver.topology.solid_orders import NewFace


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


@dataclass(frozen=True, eq=False)
class Made:
    """An old edge and the one that takes its place, with the faces that have a curve of it.

    Attributes
    ----------
    old, edge : TopoDS_Edge
    faces : list of TopoDS_Face
    is_kept : bool
        Its curve in space is the old one.
    """

    old: Any
    edge: Any
    faces: list[Any]
    is_kept: bool = False


def put_in(shape: Any, places: Sequence[Opening], news: Sequence[NewFace]) -> tuple[Any, Callable[[Any], Any]]:
    """Return the shape with new faces, which have the numbers of the old ones, and what each of its parts became.

    Parameters
    ----------
    shape : TopoDS_Shape
        Changed in place where vertices need more tolerance: a copy.
    places : sequence of Opening
        Of that shape.
    news : sequence of NewFace
        One for each.
    """
    from OCP.BRepTools import BRepTools_ReShape

    faces = parts(shape, "FACE")
    own = {place.number: new_face(new.surface) for place, new in zip(places, news, strict=True)}
    made: list[Made] = []
    borders = [_border(place, new, faces, own, made) for place, new in zip(places, news, strict=True)]
    for one in made:
        settle(one.edge, one.faces)
    reshape = BRepTools_ReShape()
    for one in made:
        reshape.Replace(forward(one.old), one.edge)
    for place, (walk, inwards) in zip(places, borders, strict=True):
        reshape.Replace(place.face, closed_face(own[place.number], walk, inwards=inwards))
    changed = reshape.Apply(shape)
    # Files keep the edges that faces share in shells alone.
    return shell_of(children(changed)) if has_loose_faces(changed) else changed, reshape.Value


def _border(
    place: Opening, wanted: NewFace, faces: Sequence[Any], own: Mapping[int, Any], made: list[Made]
) -> tuple[list[tuple[Any, bool]], bool]:
    """Return the border of a new face as the wire of the old one walks it, and whether its own normal points inwards.

    Edges are added to those that are made; those between two new faces are made once.
    """
    surface, new = wanted.surface, own[place.number]
    geometry = occ_surface(surface)
    if wanted.a is None or wanted.b is None:
        low, high = surface.domain[1]
        # v where the first contact starts as the wire of the old face walks it, and where it ends.
        a = b = (high, low) if runs_against(place, surface) else (low, high)
    else:
        a, b = wanted.a, wanted.b
    (u0, u1) = surface.domain[0]
    of_a = contact_edges(place.a, faces, new, geometry, surface, u0, a)
    of_b = contact_edges(place.b, faces, new, geometry, surface, u1, b[::-1])
    made += [*of_a, *of_b]
    used = [[(one.edge, is_reversed(one.old)) for one in side] for side in (of_a, of_b)]
    # Seen from outside the parameters run round the face where the first contact runs against v.
    inwards = a[1] > a[0]
    if place.after_a is None or place.after_b is None:
        seam = seam_edge(geometry, (u0, u1), a[1], a[0], (place.a.end, place.b.start), new)
        settle(turned(seam, backwards=True), [new])
        settle(seam, [new])
        return used[0] + [(seam, False)] + used[1] + [(seam, True)], inwards
    after = []
    for rim, at_a, at_b, from_a in ((place.after_a, a[1], b[1], True), (place.after_b, a[0], b[0], False)):
        (old,) = rim.edges
        ends_at = ((u0, at_a), (u1, at_b))
        found = next((x for x in made if x.old.IsSame(old)), None)
        if found is None:
            is_kept = _number_in(place.face, old) in wanted.kept
            made.append(_end_edge(rim, faces, own, geometry, surface, ends_at, from_a=from_a, is_kept=is_kept))
            found = made[-1]
        _add_across(found, new, surface, ends_at, is_backwards=is_reversed(old) == from_a)
        after.append([(found.edge, is_reversed(old))])
    return used[0] + after[0] + used[1] + after[1], inwards


def change_of(places: Sequence[Opening]) -> Change:
    """Return what is meant to happen where faces are replaced."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    volume = 0.0
    for place in places:
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(place.face, properties)
        lines = [rim_line(rim) for rim in (place.a, place.b)]
        length = float(np.mean([np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines]))
        gap = float(np.linalg.norm(evenly(lines[0]) - evenly(lines[1])[::-1], axis=1).mean())
        volume += float(properties.Mass()) * min(length, gap)
    numbers = tuple(place.number for place in places)
    return Change(
        old=numbers,
        new=numbers,
        touched=tuple(dict.fromkeys([*numbers, *(n for place in places for rim in place.rims for n in rim.faces)])),
        volume=volume,
        contacts=tuple(dict.fromkeys(n for place in places for rim in (place.a, place.b) for n in rim.faces)),
    )


def runs_against(place: Opening, surface: BSplineSurface) -> bool:
    """Tell whether v runs against the first of two closed contacts as the wire of the face walks it."""
    (u0, u1), (v0, v1) = surface.domain
    # Both ends are one point: which way it goes is seen a quarter later.
    corners = surface.evaluate_grid([u0, u1], v0 + (v1 - v0) * np.array([0.25, 0.75]))
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
) -> list[Made]:
    """Return what takes the place of each old edge of a contact."""
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
        made.append(Made(old, edge, [new, face]))
    return made


def _end_edge(
    rim: Rim,
    faces: Sequence[Any],
    own: Mapping[int, Any],
    geometry: Any,
    surface: BSplineSurface,
    ends_at: tuple[tuple[float, float], tuple[float, float]],
    *,
    from_a: bool,
    is_kept: bool,
) -> Made:
    """Return what takes the place of the edge at an end: with its curve on the face beyond, unless that is new too."""
    (old,), (beyond,) = rim.edges, rim.faces
    if is_kept:
        return Made(old, copied_edge(old, faces[beyond]), [faces[beyond]], is_kept=True)
    # The wire walks from contact to contact; the edge's own direction may be the other.
    backwards = is_reversed(old) == from_a
    (_, v), (_, other) = ends_at
    curve = geometry.VIso(v) if v == other else line_across(surface, ends_at)
    edge = end_edge(curve, ends(forward(old)), backwards=backwards)
    if beyond in own:
        return Made(old, edge, [])
    add_by_feet(edge, faces[beyond], first_parameters(old, faces[beyond], ends(edge)[0]))
    return Made(old, edge, [faces[beyond]])


def _add_across(
    made: Made,
    new: Any,
    surface: BSplineSurface,
    ends_at: tuple[tuple[float, float], tuple[float, float]],
    *,
    is_backwards: bool,
) -> None:
    """Give an edge at an end its curve on a new face: straight and even, but for old edges in how fast it is."""
    start, end = ends_at[::-1] if is_backwards else ends_at
    if made.is_kept:
        add_across_border(made.edge, new, iso_curve(surface, v=start[1]), start[1], (start[0], end[0]))
    else:
        add_pcurve(made.edge, line_on(made.edge, start, end), new)
    made.faces.append(new)


def _number_in(face: Any, edge: Any) -> int:
    """Return k of the name "ek" of an edge of a face."""
    walked = [x for edges, _ in wires(face) for x in edges]
    return next(k for k, x in enumerate(walked) if x.IsSame(edge))
