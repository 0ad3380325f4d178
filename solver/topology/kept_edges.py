"""Old end edges of faces that are replaced, where these go on into others: what a blend needs to end in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import BandContact, BlendResult, EndFace, end_on_curve
from semispline.solver.errors import EdgeError
from semispline.solver.judge import Base, Contact, measure_contact, measure_face_contact
from semispline.solver.splines import BSplineCurve, BSplineSurface, bounding_box, closest_point, iso_curve, surface_jet
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.relations import INNER, Relations
from semispline.solver.topology.trim_curves import read_trim_curves

# Places along the edge, and steps of Newton's method towards each.
_PLACES, _STEPS = 129, 4
_GAUSS, _PIECES = 8, 64
# Of the size of the blend: nearer to the edge the end is not sought.
_WITHIN = 1e-9
# Of the length of the contact: what is further from the end is met as everywhere.
_REACH = 1 / 3
# Places along a contact by which its length is told.
_ALONG = 1025


@dataclass(frozen=True, eq=False)
class KeptEdge:
    """An end edge that is kept, from the first contact to the second.

    Attributes
    ----------
    face : int
        The face that is replaced.
    name : str
        Of the edge there.
    beyond : int
        The face that it goes on into.
    number : int
        k of the name.
    curve : ndarray, shape (K, 3)
        At equal steps of its length.
    tangents : ndarray, shape (2, 3)
        At both ends, as long as the edge is.
    corners : pair of EndFace
        At both ends the plane that holds the edge's direction and the normal: there the blend has to leave.
    normals : ndarray, shape (S, 3)
        Of the face beyond, at `places`.
    places : ndarray, shape (S, 3)
    """

    face: int
    name: str
    beyond: int
    number: int
    curve: FloatArray
    tangents: FloatArray
    corners: tuple[EndFace, EndFace]
    normals: FloatArray
    places: FloatArray

    @property
    def ends(self) -> FloatArray:
        """Where it meets the contacts, shape (2, 3)."""
        return self.curve[[0, -1]]


@dataclass(frozen=True)
class KeptEnd:
    """How a blend meets an end edge that was kept.

    Attributes
    ----------
    face : int
    edge : str
    beyond : int
    length : float
        Contact is G1 alone within this of the edge, along both contacts at most; model units.
    distance : float
        Between the end of the blend and the edge.
    crease_degrees : float
        Between the blend and the face beyond, along the edge.
    range : (float, float)
        The parameters v of the blend within which contact is G1 alone.
    """

    face: int
    edge: str
    beyond: int
    length: float
    distance: float
    crease_degrees: float
    range: tuple[float, float]

    def __str__(self) -> str:
        return (
            f"{self.edge} of face {self.face} is kept: within {self.length:.4g} of it contact falls from what was "
            f"asked to G1, and face {self.beyond} is met at {self.crease_degrees:.2g} degrees"
        )


def kept_edges(graph: EdgeGraph, relations: Relations, rows: Sequence[int]) -> list[KeptEdge]:
    """Return end edges that are kept, by their uses; errors as `read_trim_curves`."""
    uses = graph.uses
    if not rows:
        return []
    curves = read_trim_curves(graph.path, [(int(uses.face[row]), int(uses.number[row])) for row in rows])
    found = []
    for row, trim in zip(rows, curves, strict=True):
        if trim.edge is None:
            raise EdgeError(f"{trim.name}: it has no curve in space, and cannot be kept")
        points, tangents = _by_length(trim.edge)
        # Seen from the face the edge runs from its first sample to its last one.
        if np.linalg.norm(points[0] - uses.points[row, 0]) > np.linalg.norm(points[-1] - uses.points[row, 0]):
            points, tangents = points[::-1], -tangents[::-1]
        normals = uses.normal[row, [0, -1]]
        start, end = (EndFace.plane(np.cross(n, t)) for n, t in zip(normals, tangents, strict=True))
        partner = int(relations.partner[row])
        found.append(
            KeptEdge(
                face=int(uses.face[row]),
                name=uses.name(row),
                beyond=int(uses.face[partner]),
                number=int(uses.number[row]),
                curve=points,
                tangents=tangents,
                corners=(start, end),
                normals=uses.normal[partner],
                places=uses.points[partner],
            )
        )
    return found


def ended_on_edges(surface: BSplineSurface, edges: Sequence[KeptEdge]) -> tuple[BSplineSurface, list[KeptEnd]]:
    """Return a blend with its ends on edges that are kept, and how it meets these.

    Raises
    ------
    EdgeError
        As `end_on_curve`.
    """
    found = []
    for edge in edges:
        (u0, u1), v = surface.domain[0], np.array(surface.domain[1])
        corners = surface.evaluate_grid([u0, u1], v)
        # [end][way]
        apart = [
            [float(np.linalg.norm(corners[:, k] - ends, axis=1).max()) for ends in (edge.ends, edge.ends[::-1])]
            for k in (0, 1)
        ]
        end, way = divmod(int(np.argmin(apart)), 2)
        points, tangents = (edge.curve[::-1], -edge.tangents[::-1]) if way else (edge.curve, edge.tangents)
        share, length = _reach(surface, end, float(np.linalg.norm(tangents[0])))
        within = _WITHIN * float(np.ptp(bounding_box(surface), axis=0).max())
        made = end_on_curve(surface, end, points, tangents, share, within)
        surface = made.surface
        low, high = surface.domain[1]
        reach = share * (high - low)
        found.append(
            KeptEnd(
                face=edge.face,
                edge=edge.name,
                beyond=edge.beyond,
                length=length,
                distance=made.distance,
                crease_degrees=_crease(surface, end, edge),
                range=(high - reach, high) if end else (low, low + reach),
            )
        )
    return surface, found


def measured_again(result: BlendResult, surface: BSplineSurface, a: EdgeBase, b: EdgeBase) -> BlendResult:
    """Return a blend with its contacts as the surface with ends on kept edges has them."""
    met = [_met_again(result, side, surface, which) for side, which in ((a, "a"), (b, "b"))]
    return replace(result, **met[0], **met[1])


def _met_again(result: BlendResult, side: EdgeBase, surface: BSplineSurface, which: str) -> dict[str, Any]:
    edge = "u0" if which == "a" else "u1"
    order = max(2, int(result.continuity["ab".index(which)][1]))

    def contact(base: Base, old: Contact, part: str = "") -> Contact:
        found = measure_contact(base, Base(surface, edge + part), flip="auto", order=order)
        return replace(found, allowed=old.allowed)

    def band(part: EdgeBase, old: BandContact | None, stretch: str = "") -> BandContact | None:
        if part.band is None or part.curve is None or old is None:
            return old
        found = measure_face_contact(Base(surface, edge + stretch), part.curve.free_edge(part.band.source), order=order)
        return replace(
            old, gap=found.gap, off=found.off or 0.0, angle_degrees=found.angle_degrees,
            curvature=found.curvature_jump_relative, rate=found.rate_jump_relative,
            second_rate=found.second_rate_jump_relative,
        )  # fmt: skip

    chain = result.chain_a if which == "a" else result.chain_b
    if chain is None or not side.members:
        (base,) = side.bases
        old = result.contact_a if which == "a" else result.contact_b
        own = result.band_a if which == "a" else result.band_b
        return {f"contact_{which}": contact(base, old), f"band_{which}": band(side, own)}
    bases = dict(zip((part.name for part in side.members), side.members, strict=True))
    faces = []
    for face in chain.faces:
        part, (low, high) = bases[face.edge], face.range
        stretch = f"[{low!r},{high!r}]"
        (base,) = part.bases
        faces.append(replace(face, contact=contact(base, face.contact, stretch), band=band(part, face.band, stretch)))
    worst = max(faces, key=lambda face: face.contact.curvature_jump_relative).contact
    return {f"chain_{which}": replace(chain, faces=tuple(faces)), f"contact_{which}": worst}


def _reach(surface: BSplineSurface, end: int, width: float) -> tuple[float, float]:
    """Return which share of the range of v from an end on may change, and the length of the longer contact there.

    That is as long as the edge is, but no more than a third of the contact.
    """
    (low, high), shares = surface.domain[1], np.linspace(0.0, 1.0, _ALONG)
    v = low + (high - low) * (shares if end == 0 else 1 - shares)
    lines = surface.evaluate_grid(list(surface.domain[0]), np.clip(v, low, high))
    steps = np.linalg.norm(np.diff(lines, axis=1), axis=2)
    lengths = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
    found = [float(np.interp(min(width, _REACH * x[-1]), x, shares)) for x in lengths]
    share = min(found)
    return share, max(float(np.interp(share, shares, x)) for x in lengths)


def _crease(surface: BSplineSurface, end: int, edge: KeptEdge) -> float:
    """Return the angle between a blend and the face beyond its end, the largest at inner samples, degrees.

    At an end the face beyond may have a pole.
    """
    v = surface.domain[1][end]
    line = iso_curve(surface, v=v)
    at = np.array([float(closest_point(line, place).parameters[0]) for place in edge.places[INNER]])
    jets = surface_jet(surface, at, np.full_like(at, v), 1)
    normals = np.cross(jets[1, 0], jets[0, 1])
    sine = np.linalg.norm(np.cross(normals, edge.normals[INNER]), axis=-1)
    return float(np.degrees(np.arctan2(sine, np.abs((normals * edge.normals[INNER]).sum(axis=-1)))).max())


def _by_length(curve: BSplineCurve) -> tuple[FloatArray, FloatArray]:
    """Return points of a curve at equal steps of its length, and its tangents at both ends, as long as it is."""
    nodes = np.unique(
        np.concatenate([np.linspace(float(curve.knots[0]), float(curve.knots[-1]), _PIECES + 1), curve.knots])
    )
    x, weights = np.polynomial.legendre.leggauss(_GAUSS)

    def lengths(low: FloatArray, high: FloatArray) -> FloatArray:
        t = (low + high)[:, None] / 2 + (high - low)[:, None] / 2 * x
        speed = np.linalg.norm(curve.evaluate(t.ravel(), 1), axis=1).reshape(t.shape)
        return np.asarray(speed @ weights * (high - low) / 2)

    total = np.concatenate([[0.0], np.cumsum(lengths(nodes[:-1], nodes[1:]))])
    wanted = np.linspace(0.0, total[-1], _PLACES)
    first = np.clip(np.searchsorted(total, wanted, side="right") - 1, 0, len(nodes) - 2)
    t = np.interp(wanted, total, nodes)
    for _ in range(_STEPS):
        off = wanted - total[first] - lengths(nodes[first], t)
        t = np.clip(t + off / np.linalg.norm(curve.evaluate(t, 1), axis=1), nodes[0], nodes[-1])
    ends = curve.evaluate(nodes[[0, -1]], 1)
    return curve.evaluate(t), np.asarray(ends / np.linalg.norm(ends, axis=1)[:, None] * total[-1])
