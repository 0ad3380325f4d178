"""The edges of a face as polylines in the parameters of the surface that is read out for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.io import converted_parameters
from semispline.solver.splines import BSplineSurface, EdgeName
from semispline.solver.topology.face_curves import spread
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.trim_curves import TrimCurve

# Points of an edge that is not straight in the parameters.
_POINTS = 120
# Of the range of a parameter: an edge that is as near to an end of it all along lies on the seam.
_ON_SEAM = 1e-6


@dataclass(frozen=True, eq=False)
class Outline:
    """The edges of a face, as seen from one of them.

    Of a surface that goes on over its seam they are there once a turn, and the seam is none of them.

    Attributes
    ----------
    trim : TrimCurve or None
        The edge itself as a curve; None where the file knows none.
    ends : list of ndarray, shape (S, 2)
        Edges that touch it: they end what runs beside it.
    others : list of ndarray, shape (S, 2)
        The other edges of the same wire: beyond them the face is left.
    own : list of ndarray, shape (S, 2)
        The edge itself, where nothing but itself is met a turn later.
    periods : ndarray, shape (2,)
        After how much of each parameter all of it comes again; 0 where it does not.
    holes : list of ndarray, shape (S, 2)
        The edges of other wires; as of `others`, but none of them touches what ends the face beside the edge.
    """

    trim: TrimCurve | None
    ends: list[FloatArray]
    others: list[FloatArray]
    own: list[FloatArray]
    periods: FloatArray
    holes: list[FloatArray] = field(default_factory=list)

    @property
    def beyond(self) -> list[FloatArray]:
        """All edges beyond which the face is left."""
        return [*self.others, *self.holes]


def curved_edges(graph: EdgeGraph, row: int) -> list[int]:
    """Return the edges of the face of a use of which samples do not tell all, and itself: it may slant."""
    uses = graph.uses
    return [x for x in _drawn(graph, row) if uses.pcurve[x] != "line" or x == row]


def outline_of(graph: EdgeGraph, row: int, surface: BSplineSurface, curves: Mapping[int, TrimCurve]) -> Outline:
    """Return the outline of the face of a use; `curves` are those of `curved_edges`, as far as they are known."""
    near = {int(graph.uses.previous[row]), int(graph.uses.following[row])}
    face = Face(surface)
    ends: list[FloatArray] = []
    others: list[FloatArray] = []
    holes: list[FloatArray] = []
    for x in _drawn(graph, row):
        if x != row and not (graph.uses.seam[x] and _on_seam(own_parameters(graph, x, surface), face)):
            line = _polyline(graph, x, surface, curves.get(x))
            apart = others if graph.uses.wire[x] == graph.uses.wire[row] else holes
            (ends if x in near or _touches(graph, x, row) else apart).append(line)
    trim = curves.get(row)
    moved = None if trim is None else _beside(trim, own_parameters(graph, row, surface))
    return Outline(moved, ends, others, [], face.periods, holes)


def _on_seam(samples: FloatArray, face: Face) -> bool:
    """Tell whether all samples lie where a surface goes on smoothly in itself."""
    turns = (samples - face.low) / face.widths
    near = np.asarray((np.abs(turns - np.round(turns)) <= _ON_SEAM).all(axis=0))
    return bool((near & (face.periods > 0)).any())


def _drawn(graph: EdgeGraph, row: int) -> list[int]:
    uses = graph.uses
    rows = range(*uses.of_face(int(uses.face[row])).indices(len(uses)))
    return [x for x in rows if uses.pcurve[x] != "none" and not uses.degenerate[x]]


def _touches(graph: EdgeGraph, one: int, two: int) -> bool:
    points = graph.uses.points
    apart = points[one][[0, -1], None] - points[two][[0, -1]]
    return bool((np.linalg.norm(apart, axis=2) <= 1e-6 * graph.size).any())


def _polyline(graph: EdgeGraph, row: int, surface: BSplineSurface, trim: TrimCurve | None) -> FloatArray:
    samples = own_parameters(graph, row, surface)
    if trim is None or trim.pcurve is None:
        return samples
    pcurve = _beside(trim, samples).pcurve
    assert pcurve is not None
    return pcurve.evaluate(spread(np.unique(pcurve.knots), _POINTS))[:, :2]


def _beside(trim: TrimCurve, samples: FloatArray) -> TrimCurve:
    """Return a curve on the turn of its samples: of a closed surface it may run a turn beside the other edges."""
    if trim.pcurve is None:
        return trim
    face = Face(trim.surface)
    line = trim.pcurve.evaluate(spread(np.unique(trim.pcurve.knots), _POINTS))[:, :2]
    turns = np.where(face.closed, np.round((samples.mean(axis=0) - line.mean(axis=0)) / face.widths), 0.0)
    shift = np.append(turns * face.widths, 0.0)
    return replace(trim, pcurve=replace(trim.pcurve, control_points=trim.pcurve.control_points + shift))


def own_parameters(graph: EdgeGraph, row: int, surface: BSplineSurface) -> FloatArray:
    """Return the samples of a use in the parameters of the surface, shape (N, 2)."""
    uses, face = graph.uses, int(graph.uses.face[row])
    found: FloatArray = np.empty_like(uses.uv[row])
    for axis, kind in enumerate(graph.faces.parameters[face]):
        start, first = graph.faces.ends[face][2 * axis], surface.domain[axis][0]
        own = uses.uv[row][:, axis] - start + first if start != first else uses.uv[row][:, axis]
        found[:, axis] = converted_parameters(kind, surface.breakpoints[axis], own)
    return found


def border(surface: BSplineSurface, name: EdgeName) -> Outline:
    """Return the outline of a whole surface, as seen from an edge or a line of it."""
    axis, periods = 0 if name.direction == "u" else 1, Face(surface).periods

    def line(d: int, value: float) -> FloatArray:
        found = np.empty((2, 2))
        found[:, d], found[:, 1 - d] = value, surface.domain[1 - d]
        return found

    ends, others = [], []
    for d, domain in enumerate(surface.domain):
        for end, value in enumerate(domain):
            if periods[d]:
                continue
            if d != axis:
                ends.append(line(d, value))
            elif end != name.end or name.at is not None:
                others.append(line(d, value))
    own = line(axis, surface.domain[axis][name.end] if name.at is None else name.at)
    return Outline(None, ends, others, [own], periods)
