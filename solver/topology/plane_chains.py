"""Edges of a chain on planes: which of them get strips of their own, and which way these leave the contact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.band_search import is_plane
from semispline.solver.topology.bands import Band
from semispline.solver.topology.chain_edges import ResolvedChain
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.plane_strips import curve_in_plane, nearest_end, plane_strip, ways_between
from semispline.solver.topology.trim_curves import TrimCurve


def edges_on_planes(chain: ResolvedChain) -> list[bool]:
    """Tell which edges get strips: of each plane all that follow each other on it, but a single line of its parameters.

    Where two of them have a corner, no line of parameters leads into the face from there.
    """
    flat: dict[str, bool] = {}
    for edge in chain.edges:
        if edge.spec not in flat:
            surface = edge.surface
            flat[edge.spec] = isinstance(surface, BSplineSurface) and is_plane(Face(surface))
    beside = {k for pair in _joints(chain) for k in pair}
    return [flat[edge.spec] and (edge.is_free or k in beside) for k, edge in enumerate(chain.edges)]


def strips_on_planes(chain: ResolvedChain, curves: Sequence[TrimCurve | None]) -> list[Band | None]:
    """Return the strip of each edge that gets one, and None for the others."""
    wanted = edges_on_planes(chain)
    own = {
        k: curve
        for k, (curve, on_plane) in enumerate(zip(curves, wanted, strict=True))
        if on_plane and curve is not None and curve_in_plane(curve) is not None
    }
    ways = ways_between(own, [pair for pair in _joints(chain) if own.keys() >= set(pair)])
    for k, way in enumerate(chain.ways):
        for number in () if way is None else {k, (k - 1) % len(chain.edges)} & own.keys():
            point, along = (np.array(x) for x in way or ())
            ways[number][nearest_end(own[number], point)] = along
    return [plane_strip(own[k], ways[k]) if k in own else None for k in range(len(chain.edges))]


def _joints(chain: ResolvedChain) -> list[tuple[int, int]]:
    """Return which edges follow each other on one face."""
    return [
        (before, k)
        for k, way in enumerate(chain.ways)
        if way is None and (before := (k - 1) % len(chain.edges)) != k
        if chain.edges[before].spec == chain.edges[k].spec and (k or _closes(chain))
    ]


def _closes(chain: ResolvedChain) -> bool:
    """Tell whether the last edge ends where the first one begins."""
    ends = [[np.array(end) for end in (edge.entry.start, edge.entry.end)] for edge in chain.edges if edge.entry]
    if len(ends) != len(chain.edges) or len(ends) < 2:
        return False
    size = max(float(np.linalg.norm(start - end)) for start, end in ends)
    return min(float(np.linalg.norm(p - q)) for p in ends[0] for q in ends[-1]) <= 1e-6 * size
