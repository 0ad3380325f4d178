"""Edges made by hand along the border of a new face, with their curves on both faces and measured tolerances."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import ComputationError
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.occ_shapes import (
    CONFUSION,
    MARGIN,
    add_pcurve,
    breaks_of,
    cast,
    ends,
    feet,
    forward,
    merged,
    parameters_of,
    plane_curve,
    point_of,
    points_of,
    raise_tolerance,
    range_of,
    spline_of_pieces,
    surface_at,
    tolerance_of,
    with_range,
)

# Samples of a curve in the parameters of a face: the first number, and where doubling ends.
_FEWEST, _MOST = 33, 513
_DEGREE = 5
# A curve that is this near, of the range, to a straight one is one.
_STRAIGHT = 1e-11
# Of its size: a border whose ends are this near is closed.
_CLOSED = 1e-9
# Places at which a curve is compared with its edge, and those of the border from which a nearest point is sought.
_MEASURED, _NODES = 129, 1000
_STEPS, _SECANTS = 30, 6
# Points within each piece of a curve across a face.
_ACROSS = 33


def copied_edge(edge: Any, face: Any) -> Any:
    """Return an edge anew, in its own direction, with the same vertices and its curve on one face alone."""
    from OCP.BRep import BRep_Tool

    edge = forward(edge)
    first, last = range_of(edge)
    new = with_range(BRep_Tool.Curve_s(edge, first, last), first, last, tolerance_of(edge), ends(edge))
    add_pcurve(new, BRep_Tool.CurveOnSurface_s(edge, face, first, last), face)
    return new


def add_along_border(
    edge: Any, face: Any, border: BSplineCurve, u: float, at_ends: tuple[float | None, ...]
) -> tuple[float, float]:
    """Give an edge its curve along the border u of a new face, by feet; return v at both its ends.

    Parameters
    ----------
    edge : TopoDS_Edge
    face : TopoDS_Face
    border : BSplineCurve
        The line u of the surface of the face.
    u : float
    at_ends : (float or None, float or None)
        Which v its ends have, where that is known.
    """
    return _add_along(edge, face, border, at_ends, lambda v: np.stack([np.full_like(v, u), v], axis=1))


def add_across_border(
    edge: Any, face: Any, border: BSplineCurve, v: float, at_ends: tuple[float | None, ...]
) -> tuple[float, float]:
    """Give an edge its curve along the line v of a new face, as `add_along_border`; return u at both its ends."""
    return _add_along(edge, face, border, at_ends, lambda u: np.stack([u, np.full_like(u, v)], axis=1))


def _add_along(
    edge: Any,
    face: Any,
    border: BSplineCurve,
    at_ends: tuple[float | None, ...],
    on_face: Callable[[FloatArray], FloatArray],
) -> tuple[float, float]:
    near = _near_seam(border, edge, at_ends)

    def along(t: FloatArray) -> FloatArray:
        v = _nearest(border, points_of(edge, t), None if near is None else near(t))
        for limit, end in zip(range_of(edge), at_ends, strict=True):
            v = v if end is None else np.where(t == limit, end, v)
        return v

    def places(t: FloatArray) -> FloatArray:
        return on_face(along(t))

    def at_knots(t: FloatArray) -> FloatArray:
        v = along(t)
        inner = np.unique(border.knots)[1:-1]
        if len(inner) == 0:
            return inner
        if v[-1] < v[0]:
            v, t = v[::-1], t[::-1]
        found = np.interp(inner, v, t)
        # v(t) grows or falls: a few steps of the secant between neighbours.
        for _ in range(_SECANTS):
            step = 1e-4 * float(np.ptp(t))
            here = along(found)
            slope = (along(np.clip(found + step, t.min(), t.max())) - here) / step
            found = np.clip(found + (inner - here) / np.where(slope == 0, np.inf, slope), t.min(), t.max())
        return np.asarray(found)

    add_pcurve(edge, _fitted(places, edge, face, at_knots), face)
    start, end = along(np.array(range_of(edge))).tolist()
    return start, end


def border_edge(line: Any, start: float, end: float, vertices: Sequence[Any]) -> Any:
    """Return the edge between two vertices along a part of the border of a new face, which is a spline."""
    if start > end:
        first, last = line.FirstParameter(), line.LastParameter()
        line, start, end = line.Reversed(), first + last - start, first + last - end
    return with_range(line, start, end, CONFUSION, vertices)


def end_edge(line: Any, vertices: Sequence[Any], *, backwards: bool = False) -> Any:
    """Return the edge between two vertices along all of a spline, which runs so or backwards."""
    curve = line.Reversed() if backwards else line
    return with_range(curve, curve.FirstParameter(), curve.LastParameter(), CONFUSION, vertices)


def trimmed(edge: Any, at: Sequence[tuple[Any, Any, float]]) -> Any:
    """Return what is left of an edge, in its own direction, with all its curves.

    Parameters
    ----------
    edge : TopoDS_Edge
    at : sequence of (TopoDS_Vertex, TopoDS_Vertex, float)
        The end that is cut off, the one that takes its place, and the parameter there.
    """
    from OCP.BRep import BRep_Builder
    from OCP.ShapeBuild import ShapeBuild_Edge

    edge = forward(edge)
    vertices, limits = list(ends(edge)), list(range_of(edge))
    for old, new, t in at:
        # The nearer end, where both are one vertex.
        k = min((k for k in (0, 1) if ends(edge)[k].IsSame(old)), key=lambda k: abs(limits[k] - t))
        vertices[k], limits[k] = new, t
    copy = cast(ShapeBuild_Edge().CopyReplaceVertices(edge, *(forward(x) for x in vertices)))
    BRep_Builder().Range(copy, *limits)
    for vertex, (_, new, t) in ((x[1], x) for x in at):
        away = float(np.linalg.norm(points_of(copy, np.array([t]))[0] - point_of(new)))
        raise_tolerance(vertex, max(tolerance_of(copy), MARGIN * away))
    return copy


def foot_on(edge: Any, point: FloatArray) -> float:
    """Return the parameter of the point of an edge that is nearest to another."""
    low, high = range_of(edge)
    t = np.linspace(low, high, _NODES + 1)
    best = float(t[np.linalg.norm(points_of(edge, t) - point, axis=1).argmin()])
    step = 1e-6 * (high - low)
    for _ in range(_STEPS):
        around = points_of(edge, np.clip([best - step, best, best + step], low, high))
        slope = (around[2] - around[0]) / (min(best + step, high) - max(best - step, low))
        moved = min(max(best + float((point - around[1]) @ slope / (slope @ slope)), low), high)
        if abs(moved - best) <= 1e-14 * max(1.0, abs(best)):
            break
        best = moved
    return best


def line_on(edge: Any, start: tuple[float, float], end: tuple[float, float]) -> Any:
    """Return the straight curve in the parameters of a face from one point to another over the range of an edge."""
    return plane_curve(np.array(range_of(edge)), np.array([start, end]), 1)


def line_across(surface: BSplineSurface, ends_at: tuple[tuple[float, float], tuple[float, float]]) -> Any:
    """Return the curve on a surface that is straight in its parameters, from one point to another, as a spline of t."""
    (u0, v0), (u1, v1) = ends_at
    inner = np.unique(np.concatenate([
        (np.unique(surface.knots_u) - u0) / (u1 - u0), (np.unique(surface.knots_v) - v0) / (v1 - v0)
    ]))  # fmt: skip
    breaks = merged(inner, 0.0, 1.0)
    parameters = [np.linspace(low, high, _ACROSS) for low, high in pairwise(breaks.tolist())]
    pieces = [surface.evaluate(u0 + (u1 - u0) * t, v0 + (v1 - v0) * t) for t in parameters]
    return spline_of_pieces(parameters, pieces, in_space=True)


def add_by_feet(edge: Any, face: Any, start: FloatArray) -> None:
    """Give an edge its curve on a face that it lies on; the foot of its first point is sought from `start`."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType
    from OCP.GeomAPI import GeomAPI

    surface = BRepAdaptor_Surface(face, False)
    if surface.GetType() == GeomAbs_SurfaceType.GeomAbs_Plane:
        curve = BRep_Tool.Curve_s(edge, *range_of(edge))
        add_pcurve(edge, GeomAPI.To2d_s(curve, surface.Plane()), face)
        return
    add_pcurve(edge, _fitted(lambda t: feet(face, points_of(edge, t), start), edge, face), face)


def first_parameters(edge: Any, face: Any, vertex: Any) -> FloatArray:
    """Return where on a face the end of an edge is that lies at a vertex."""
    edge = forward(edge)
    t = range_of(edge)[0 if ends(edge)[0].IsSame(vertex) else 1]
    return np.asarray(parameters_of(edge, face, np.array([t]))[0])


def settle(edge: Any, faces: Iterable[Any]) -> float:
    """Raise the tolerance of an edge and of its vertices to what its curves on faces need; return that of the edge."""
    t = np.linspace(*range_of(edge), _MEASURED)
    points = points_of(edge, t)
    if not np.isfinite(points).all():
        raise ComputationError("a new edge has points that are not finite; nothing was written")
    at_ends = [points[[0, -1]]]
    for face in faces:
        on_face = surface_at(face, parameters_of(edge, face, t))
        raise_tolerance(edge, MARGIN * distance_to(edge, face))
        at_ends.append(on_face[[0, -1]])
    for k, vertex in enumerate(ends(forward(edge))):
        away = max(float(np.linalg.norm(x[k] - point_of(vertex))) for x in at_ends)
        raise_tolerance(vertex, max(tolerance_of(edge), MARGIN * away))
    return tolerance_of(edge)


def distance_to(edge: Any, face: Any) -> float:
    """Return how far the curve of an edge on a face is from the one in space, at the same parameters."""
    t = np.linspace(*range_of(edge), _MEASURED)
    return float(np.linalg.norm(surface_at(face, parameters_of(edge, face, t)) - points_of(edge, t), axis=1).max())


def _fitted(
    places: Callable[[FloatArray], FloatArray],
    edge: Any,
    face: Any,
    more: Callable[[FloatArray], FloatArray] | None = None,
) -> Any:
    """Return the curve through places on a face, with as many samples as make it follow its edge.

    It is only continuous where the edge has knots, and at parameters that `more` returns.
    """
    first, last = range_of(edge)
    checked = np.linspace(first, last, _MEASURED)
    wanted = places(checked)
    line = wanted[0] + (wanted[-1] - wanted[0]) * ((checked - first) / (last - first))[:, None]
    extent = max(float(np.ptp(wanted, axis=0).max()), 1e-300)
    if np.abs(wanted - line).max() <= _STRAIGHT * extent:
        return plane_curve(np.array([first, last]), wanted[[0, -1]], 1)
    breaks = np.concatenate([breaks_of(edge), [] if more is None else more(checked)])
    breaks = merged(breaks, first, last)
    best, count = None, max(_FEWEST // (len(breaks) - 1), _DEGREE + 1)
    while count * (len(breaks) - 1) <= max(_MOST, 2 * _FEWEST) or best is None:
        parameters = [np.linspace(low, high, count) for low, high in pairwise(breaks.tolist())]
        found = places(np.concatenate([parameters[0], *(t[1:] for t in parameters[1:])]))
        curve = spline_of_pieces(
            parameters, [found[k * (count - 1) : (k + 1) * (count - 1) + 1] for k in range(len(parameters))]
        )
        away = _distance(curve, places, edge, face, parameters)
        if best is None or away[0] < best[0]:
            best = away[0], curve
        if away[0] <= max(CONFUSION / 4, 1.2 * away[1]):
            break
        count = 2 * count - 1
    return best[1]


def _distance(
    curve: Any, places: Callable[[FloatArray], FloatArray], edge: Any, face: Any, parameters: Sequence[FloatArray]
) -> tuple[float, float]:
    """Return how far a curve on a face is from its edge between its samples, and how far the places are."""
    t = np.concatenate([(x[1:] + x[:-1]) / 2 for x in parameters])
    points = points_of(edge, t)
    uv = np.array([curve.Value(x).Coord() for x in t.tolist()])
    own, best = (float(np.linalg.norm(surface_at(face, x) - points, axis=1).max()) for x in (uv, places(t)))
    return own, best


def _near_seam(
    border: BSplineCurve, edge: Any, at_ends: tuple[float | None, ...]
) -> Callable[[FloatArray], FloatArray] | None:
    """Return about where along a closed border the places of an edge are; None of a border that is open.

    At its seam a point has two feet. Which is meant is told by walking the edge from an end of which it is known, or
    from its middle.
    """
    start, end = border.evaluate(border.knots[[0, -1]])
    if np.linalg.norm(end - start) > _CLOSED * float(np.ptp(border.control_points, axis=0).max()):
        return None
    t = np.linspace(*range_of(edge), _MEASURED)
    v = _nearest(border, points_of(edge, t))
    first, last = at_ends
    k = _MEASURED // 2
    if first is not None:
        k, v[0] = 0, first
    elif last is not None:
        k, v[-1] = _MEASURED - 1, last
    period = float(np.ptp(border.knots))
    v[k:], v[: k + 1] = np.unwrap(v[k:], period=period), np.unwrap(v[k::-1], period=period)[::-1]
    return lambda x: np.interp(x, t, v)


def _nearest(border: BSplineCurve, points: FloatArray, near: FloatArray | None = None) -> FloatArray:
    """Return where on a curve the points nearest to others are, which run along it.

    Of a closed curve those that lie `near`, where that is told: its end is its start.
    """
    low, high = float(border.knots[0]), float(border.knots[-1])
    nodes = np.linspace(low, high, _NODES + 1)
    there = border.evaluate(nodes)
    v = nodes[((points[:, None] - there) ** 2).sum(axis=2).argmin(axis=1)]
    if near is not None:
        v += (high - low) * np.round((near - v) / (high - low))
    for _ in range(_STEPS):
        on = np.clip(v, low, high)
        away = points - border.evaluate(on)
        slope, bend = border.evaluate(on, 1), border.evaluate(on, 2)
        # Newton's step, or that of Gauss where the curve bends away.
        full = (slope**2).sum(axis=1) - (away * bend).sum(axis=1)
        full = np.where(full > 0.5 * (slope**2).sum(axis=1), full, (slope**2).sum(axis=1))
        step = (away * slope).sum(axis=1) / np.maximum(full, 1e-300)
        moved = np.clip(on + step, low, high)
        if np.abs(moved - v).max() <= 1e-15 * (high - low):
            break
        v = moved
    return np.asarray(v)
