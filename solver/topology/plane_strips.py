"""Strips of planes along edges of them, exact: what stands for free curves on a plane, and for its corners, in chains.

On a plane the way into the face may be chosen: square to the edge, at a corner of the face half way between, and where
the next face of the chain begins along the edge that both share. Strips of edges that follow each other meet there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineCurve, BSplineSurface, curve_length, greville
from semispline.solver.topology.band_search import band_limits, is_plane
from semispline.solver.topology.bands import Band
from semispline.solver.topology.face_curves import Source
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.trim_curves import TrimCurve

End = Literal[0, 1]
# Width of a strip, of the length of the curve: derivatives at the edge are all that counts.
_WIDTH = 0.1
# Sine of the angle between an edge and the way into the face, at the least.
_STEEP = 0.05
# The degree of lines and arcs, as kernels write them.
_OF_ARCS = 2
# Of the size of a bilinear surface: what its corners may miss a parallelogram by.
_AFFINE = 1e-12


def plane_strip(curve: TrimCurve, ways: Mapping[End, FloatArray]) -> Band | None:
    """Return the strip of a plane along an edge of it, or None where the file's curves do not say it exactly.

    Parameters
    ----------
    curve : TrimCurve
        Of a face that is a plane.
    ways : dict
        At which end of the edge, 0 or 1, which way leads into the face; square to it elsewhere.
    """
    found = curve_in_plane(curve)
    if found is None:
        return None
    edge, off = found
    length = curve_length(edge).value
    limits = band_limits(length, curve.tolerance, curve.millimetres)
    if off > limits.off:
        return None
    inwards = _inwards(edge, normal_of(curve.surface), curve.keep)
    across = inwards.copy()
    for end, way in ways.items():
        steep = float(way @ inwards[-end])
        if steep < _STEEP:
            return None
        across[-end] = way / steep
    width = _WIDTH * length
    points = np.stack([edge.control_points, edge.control_points + width * across])
    weights = None if edge.weights is None else np.stack([edge.weights, edge.weights])
    surface = BSplineSurface(1, edge.degree, np.repeat([0.0, width], 2), edge.knots, points, weights)
    source: Source = "pcurve" if curve.edge is None else "foot"
    first, last = float(edge.knots[0]), float(edge.knots[-1])
    return Band(
        surface=surface,
        edge="u0",
        gap=0.0,
        off=off,
        angle_degrees=0.0,
        curvature=0.0,
        rates=(),
        limits=limits,
        is_plane=True,
        length=length,
        left_out=0.0,
        source=source,
        edge_to_face=off if curve.edge is not None else None,
        edge_to_pcurve=None,
        smoothed_by=0.0,
        range=(first, last),
        cut_at_start="",
        cut_at_end="",
    )


def strip_of_arc(curve: TrimCurve) -> Band | None:
    """Return the strip of a plane along a line or an arc of it, square to it all along; None of other curves."""
    if not is_plane(Face(curve.surface)) or curve.edge is None or curve.edge.degree > _OF_ARCS:
        return None
    return plane_strip(curve, {})


def ways_between(
    curves: Mapping[int, TrimCurve], joints: Sequence[tuple[int, int]]
) -> dict[int, dict[End, FloatArray]]:
    """Return the ways into a plane, half way between, where edges of one face meet in a chain.

    Parameters
    ----------
    curves : dict
        Number in the chain -> edge.
    joints : sequence of (int, int)
        Which edges meet; they lie on one face.
    """
    found: dict[int, dict[End, FloatArray]] = {k: {} for k in curves}
    ends = {k: _ends(curve) for k, curve in curves.items()}
    for one, other in joints:
        pairs: list[tuple[float, End, End]] = [
            (float(np.linalg.norm(ends[one][i][0] - ends[other][j][0])), i, j) for i in (0, 1) for j in (0, 1)
        ]
        nearest = min(pairs)[0]
        size = max(float(np.linalg.norm(ends[one][0][0] - ends[one][1][0])), nearest)
        for apart, i, j in pairs:
            # Two edges that close a ring meet at both ends.
            if apart > nearest + 1e-6 * size or i in found[one] or j in found[other]:
                continue
            n, m = ends[one][i][1], ends[other][j][1]
            if 1 + n @ m > _STEEP:
                found[one][i] = found[other][j] = (n + m) / (1 + n @ m)
    return found


def nearest_end(curve: TrimCurve, point: FloatArray) -> End:
    """Return at which end of an edge a point lies."""
    start, end = (float(np.linalg.norm(place - point)) for place, _ in _ends(curve))
    return 0 if start <= end else 1


def _ends(curve: TrimCurve) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    """Return start and end of an edge with the unit vectors into the face, square to it."""
    found = curve_in_plane(curve)
    assert found is not None
    edge, _ = found
    inwards = _inwards(edge, normal_of(curve.surface), curve.keep)
    return (edge.control_points[0], inwards[0]), (edge.control_points[-1], inwards[-1])


def curve_in_plane(curve: TrimCurve) -> tuple[BSplineCurve, float] | None:
    """Return an edge laid square into the plane of its face, and how far it was off; its pcurve where it has no edge.

    None for a pcurve on a plane whose parameters are not affine.
    """
    surface = curve.surface
    normal, origin = normal_of(surface), surface.control_points[0, 0]
    if curve.edge is not None:
        away = (curve.edge.control_points - origin) @ normal
        laid = replace(curve.edge, control_points=curve.edge.control_points - away[:, None] * normal)
        return laid, float(np.abs(away).max())
    if curve.pcurve is None or surface.degree_u != 1 or surface.degree_v != 1 or surface.weights is not None:
        return None
    net = surface.control_points
    if net.shape[:2] != (2, 2) or np.abs(net[1, 1] - net[1, 0] - net[0, 1] + net[0, 0]).max() > _AFFINE * np.ptp(net):
        return None
    (s0, s1), (t0, t1) = surface.domain
    st = curve.pcurve.control_points
    s, t = (st[:, :1] - s0) / (s1 - s0), (st[:, 1:2] - t0) / (t1 - t0)
    return replace(curve.pcurve, control_points=origin + s * (net[1, 0] - origin) + t * (net[0, 1] - origin)), 0.0


def normal_of(surface: BSplineSurface) -> FloatArray:
    """Return the unit normal of a plane, S_u x S_v."""
    u, v = ([(low + high) / 2] for low, high in surface.domain)
    normal = np.cross(surface.evaluate(u, v, 1, 0)[0], surface.evaluate(u, v, 0, 1)[0])
    return np.asarray(normal / np.linalg.norm(normal))


def _inwards(edge: BSplineCurve, normal: FloatArray, keep: str) -> FloatArray:
    """Return by what the control points move where an edge moves into the face by 1: at its ends square to it.

    Each leg of the polygon moves by 1: that is exact for lines and arcs.
    """
    legs = np.diff(edge.control_points, axis=0)
    sizes = np.linalg.norm(legs, axis=1)
    sign = 1.0 if keep == "left" else -1.0
    if sizes.min() > _AFFINE * sizes.sum():
        beside = sign * np.cross(normal, legs / sizes[:, None])
        sums = beside[1:] + beside[:-1]
        steep = 1 + np.sum(beside[1:] * beside[:-1], axis=1)
        if not len(steep) or steep.min() > _STEEP:
            return np.concatenate([beside[:1], sums / steep[:, None], beside[-1:]])
    # Where the polygon turns back on itself it says nothing.
    places = np.clip(greville(edge.knots, edge.degree), edge.knots[0], edge.knots[-1])
    inwards = sign * np.cross(normal, edge.evaluate(places, 1))
    return np.asarray(inwards / np.linalg.norm(inwards, axis=1, keepdims=True))
