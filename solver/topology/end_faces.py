"""The faces at both ends of a face that is replaced, on which the end curves of the blend have to lie."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import BlendResult, Chain, EndFace, end_on_face, face_at
from semispline.solver.errors import EdgeError
from semispline.solver.io import read_surfaces
from semispline.solver.options import BlendOptions
from semispline.solver.splines import BSplineSurface, Surface, bounding_box
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.kept_edges import KeptEdge
from semispline.solver.topology.relations import Relations

# Degrees: where an end edge is met at less the fillet goes on beyond it.
_GOES_ON = 2.0
# Of the size of the blend: nearer to a curved face an end curve is not sought.
_WITHIN = 1e-6
# A line that leaves a plane by less, of its speed, lies in it.
_AS_IT_IS = 1e-7


def end_edges(graph: EdgeGraph, face: int, contacts: tuple[Sequence[int], Sequence[int]]) -> list[int]:
    """Return the uses of a face at the ends of its contacts; none where these are closed."""
    uses = graph.uses
    rows = range(*uses.of_face(face).indices(len(uses)))
    beside = {*contacts[0], *contacts[1]}
    return [row for row in rows if row not in beside and uses.twin[row] == NONE and not uses.seam[row]]


def going_on(graph: EdgeGraph, relations: Relations, ends: Sequence[int]) -> list[int]:
    """Return those ends of a face beyond which it goes on smoothly."""
    partner, median = relations.partner, relations.median
    return [row for row in ends if partner[row] != NONE and median[row] < _GOES_ON]


def faces_at_ends(graph: EdgeGraph, relations: Relations, ends: Sequence[int]) -> list[tuple[FloatArray, int]]:
    """Return the points at which end edges begin and end, each with a use of the edge by the face beyond.

    Raises
    ------
    EdgeError
        No other face has the edge.
    """
    found = []
    for row in ends:
        partner = int(relations.partner[row])
        if partner == NONE:
            title = f"--replace: {graph.uses.name(row)} of face {graph.uses.face[row]}"
            if graph.uses.degenerate[row]:
                raise EdgeError(
                    f"{title} is a point: a face with three sides is none that a blend takes the place of, expected "
                    "one with four, or with two rims; what ends on it is replaced with --keep-ends"
                )
            raise EdgeError(f"{title}: no other face lies beyond this end, on which the blend could end")
        found += [(graph.uses.points[row, sample], partner) for sample in (0, -1)]
    return found


@dataclass(frozen=True, eq=False)
class FaceAtEnd:
    """The face on which an end curve has to lie.

    Attributes
    ----------
    near : EndFace or None
        To second order; None where the lines across the base lie on it as they are.
    surface : BSplineSurface or None
        Where it is curved.
    """

    near: EndFace | None
    surface: BSplineSurface | None


def ends_of_base(
    graph: EdgeGraph,
    side: EdgeBase,
    at: Sequence[tuple[FloatArray, int]],
    surfaces: Mapping[int, BSplineSurface],
    kept: Sequence[KeptEdge] = (),
) -> tuple[FaceAtEnd, FaceAtEnd]:
    """Return the end faces where a base starts and where it ends.

    Parameters
    ----------
    graph : EdgeGraph
    side : EdgeBase
    at : sequence of (ndarray, int)
        Points near which bases end, and a use of an edge there by the face on which the end curve has to lie.
    surfaces : mapping
        As `curved_surfaces` returns them.
    kept : sequence of KeptEdge
        Near whose ends bases leave along them instead.
    """
    corners = [(x, near) for edge in kept for x, near in zip(edge.ends, edge.corners, strict=True)]
    places = np.array([point for point, _ in [*at, *corners]])
    found: list[FaceAtEnd] = []
    for point in side.end_points:
        nearest = int(np.linalg.norm(places - point, axis=1).argmin())
        if nearest >= len(at):
            found.append(FaceAtEnd(_needed(side, len(found), corners[nearest - len(at)][1]), None))
            continue
        row = at[nearest][1]
        surface = surfaces.get(int(graph.uses.face[row]))
        near = EndFace.plane(graph.uses.normal[row, 0]) if surface is None else face_at(surface, point)
        found.append(FaceAtEnd(near, surface))
    return found[0], found[1]


def _needed(side: EdgeBase, end: int, near: EndFace) -> EndFace | None:
    """Return a plane at an end of a base; None where the line across lies in it as it is."""
    base = side.bases[-end]
    turned = side.base.turned[-end] if isinstance(side.base, Chain) else False
    at = np.array([base.range_along[end != turned]])
    first, second = (base.derivative(at, across, 0)[0] for across in (1, 2))
    size = float(np.linalg.norm(first))
    off = max(abs(float(near.normal @ x)) for x in (first, second))
    return None if off <= _AS_IT_IS * size else near


def curved_surfaces(graph: EdgeGraph, at: Sequence[tuple[FloatArray, int]]) -> dict[int, BSplineSurface]:
    """Return the surfaces of those end faces that are no planes, by their numbers."""
    faces = dict.fromkeys(int(graph.uses.face[row]) for _, row in at)
    curved = [n for n in faces if graph.faces.kind[n] != "plane"]
    loaded = read_surfaces([f"{graph.path}#{n}" for n in curved]) if curved else []
    return {n: as_spline(one.surface) for n, one in zip(curved, loaded, strict=True)}


def as_spline(surface: Surface) -> BSplineSurface:
    """Return a surface as an ordinary B-spline."""
    return surface if isinstance(surface, BSplineSurface) else surface.to_bspline()


def blend_onto(
    graph: EdgeGraph,
    a: EdgeBase,
    b: EdgeBase,
    options: BlendOptions,
    at: Sequence[tuple[FloatArray, int]],
    kept: Sequence[KeptEdge] = (),
) -> tuple[BlendResult, BSplineSurface]:
    """Return a blend, and its surface with both end curves on the end faces; `kept` are where it leaves along edges.

    Raises
    ------
    EdgeError
        An end curve stays off its face.
    BandError, ContactError, FoldError, OptionError, ComputationError
        As `blend_edges`.
    """
    surfaces = curved_surfaces(graph, at)
    of_a, of_b = (ends_of_base(graph, side, at, surfaces, kept) for side in (a, b))
    result = blend_bases(a, b, options, ends_on=((of_a[0].near, of_a[1].near), (of_b[0].near, of_b[1].near)))
    surface = result.surface.to_bspline()
    orders = int(result.options.continuities[0][1]), int(result.options.continuities[1][1])
    for end, beyond in enumerate(of_a):
        if beyond.surface is not None:
            within = _WITHIN * float(np.ptp(bounding_box(surface), axis=0).max())
            surface = end_on_face(surface, end, beyond.surface, orders, within).surface
    return result, surface
