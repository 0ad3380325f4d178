"""Edges of faces of 3dm files as the tables of `half_edges`.

rhino3dm shows no curves in the parameters of a face: samples of the edges are projected to it. How far they are from
it then stands as the tolerance of the use; which side of a seam is meant nothing tells.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import SemisplineError
from semispline.solver.io import Model, RhinoFace, curve_evaluator
from semispline.solver.splines import BSplineSurface, surface_jet
from semispline.solver.topology.half_edges import SAMPLES, EdgeGraph, Faces, uses_of

Curve = tuple[int, FloatArray, FloatArray]
# Where the search for a foot begins: a grid of so many places each way, the best of them, and more where these fail.
_GRID, _STARTS, _MORE_STARTS = 33, 4, 64
# Where the distance of a curve is wanted alone.
_SPREAD, _BETWEEN = 201, 1.25
_STEPS, _LEAST_STEPS, _DONE = 12, 3, 1e-12
_POLE = 1e-14
# Rows that agree to this fraction of the size close a surface.
_CLOSED = 1e-9
# Samples further from the surface than this fraction of the size of all edges have not been found on it.
FAR = 1e-3
_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (0, 2), (1, 1))
_NOTHING = ("none", False, (np.nan, np.nan), (np.nan,) * 4, [np.nan] * (4 * SAMPLES), [np.nan] * (18 * SAMPLES))


def edges_of_3dm(model: Model) -> EdgeGraph:
    """Return faces and edges of a 3dm file; a surface without a face, as curves would trim it, has none."""
    faces = [face for face in model.faces if isinstance(face, RhinoFace)]
    rows: list[tuple[Any, ...]] = []
    records: list[tuple[Any, ...]] = []
    ends = np.full((len(faces), 4), np.nan)
    far = FAR * _size([curve for face in faces for curve in face.curves or ()])
    for number, face in enumerate(faces):
        try:
            surface = face.surface()
        except SemisplineError:
            continue
        ends[number] = np.ravel(surface.domain)
        if face.trims is None:
            continue
        known = _projected(surface, face.curves or (), far)
        times = Counter(trim[0] for loop in face.trims[1] for trim in loop)
        wires = [wire for wire, loop in enumerate(face.trims[1]) for _ in loop]
        for k, (wire, (edge, place, against)) in enumerate(zip(wires, edges_in_order(face), strict=True)):
            turned = bool(against) != face.trims[0]
            rows.append((number, wire, k, edge, turned, edge >= 0 and times[edge] == 2, edge < 0))
            records.append((0.0, *_NOTHING) if edge < 0 else known[place])
    numbers = np.arange(len(faces))
    table = Faces(
        kind=tuple(face.kind for face in faces),
        ends=ends,
        parameters=(("same", "same"),) * len(faces),
        reversed=np.array([bool(face.trims and face.trims[0]) for face in faces], dtype=bool),
        repeat=numbers,
        same=numbers,
        walked=np.ones(len(faces), dtype=bool),
    )
    return EdgeGraph(model.path, model.unit, table, uses_of(table, rows, records), dict(model.others))


def edges_in_order(face: RhinoFace) -> list[tuple[int, int, bool]]:
    """Return what `RhinoFace` holds of each trim, as edges are numbered: in walking order, loop by loop."""
    if face.trims is None:
        return []
    # Loops run as the surface looks; faces that look the other way are walked backwards.
    return [trim for loop in face.trims[1] for trim in (reversed(loop) if face.trims[0] else loop)]


def distance_from(surface: BSplineSurface, curve: Curve) -> float:
    """Return how far a curve is from a surface: by samples, and a quarter more for what lies between them."""
    degree, knots, net = curve
    places = np.linspace(knots[degree], knots[len(knots) - degree - 1], _SPREAD)
    return _BETWEEN * float(_feet(surface, curve_evaluator(degree, knots, net)(places)[0], _STARTS)[1].max())


def _size(curves: Sequence[Curve]) -> float:
    nets = [net[:, :3] / net[:, 3:] for _, _, net in curves]
    return float(np.ptp(np.concatenate(nets), axis=0).max()) if nets else 0.0


def _projected(surface: BSplineSurface, curves: Sequence[Curve], far: float) -> list[tuple[Any, ...]]:
    """Return, of each curve, what `uses_of` takes of a use."""
    if not curves:
        return []
    parameters, points, slopes = [], [], []
    for degree, knots, net in curves:
        first, last = float(knots[degree]), float(knots[len(knots) - degree - 1])
        point, slope = curve_evaluator(degree, knots, net)(np.linspace(first, last, SAMPLES))
        parameters.append((first, last))
        points.append(point)
        slopes.append(slope)
    samples = np.concatenate(points)
    uv, away = feet_on(surface, samples, far)
    of_orders = surface_jet(surface, uv[:, 0], uv[:, 1], 2)
    jet = np.stack([of_orders[order] for order in _ORDERS], axis=1)
    # The part of the edge's derivative that the surface can follow.
    along = np.concatenate(slopes)
    uv_slope = _step(jet[:, 1], jet[:, 2], along)
    plane = np.concatenate([uv, uv_slope], axis=1).reshape(len(curves), -1)
    jets, off = jet.reshape(len(curves), -1), away.reshape(len(curves), -1).max(axis=1)
    boxes = uv.reshape(len(curves), SAMPLES, 2)
    low, high = boxes.min(axis=1), boxes.max(axis=1)
    return [
        (float(off[k]), "projected", False, parameters[k], (*low[k], *high[k]), plane[k], jets[k])
        if off[k] <= far
        else (float(off[k]), *_NOTHING)
        for k in range(len(curves))
    ]


def feet_on(surface: BSplineSurface, points: FloatArray, far: float) -> tuple[FloatArray, FloatArray]:
    """Return parameters of the nearest points, shape (K, 2), and distances; what is `far` from it is not on it."""
    uv, away = _feet(surface, points, _STARTS)
    # Between two walls of one surface the nearest places of the grid may all lie on the wrong one.
    lost = away > far / 10
    if lost.any():
        uv[lost], away[lost] = _feet(surface, points[lost], _MORE_STARTS)
    return uv, away


def _feet(surface: BSplineSurface, points: FloatArray, starts: int) -> tuple[FloatArray, FloatArray]:
    """Return parameters of the nearest points of a surface, shape (K, 2), and the distances, shape (K,).

    Source: Gauss-Newton steps within the domain, halved where they lead away, from the best places of a grid.
    """
    low, high = np.array(surface.domain).T
    u, v = (_places(breaks) for breaks in surface.breakpoints)
    net = surface.evaluate_grid(u, v)
    seams = np.array([np.abs(net[0] - net[-1]).max(), np.abs(net[:, 0] - net[:, -1]).max()])
    size = float(np.ptp(net, axis=(0, 1)).max())
    closed = seams <= _CLOSED * size
    grid = net.reshape(-1, 3)
    start = cKDTree(grid).query(points, k=starts)[1].ravel()
    at = np.stack([u[start // len(v)], v[start % len(v)]], axis=1)
    target = np.repeat(points, starts, axis=0)
    offset = target - grid[start]
    part = np.ones((len(at), 1))
    nearest_yet = np.full(len(points), np.inf)
    jet = surface_jet(surface, at[:, 0], at[:, 1], 1)
    slope_u, slope_v = jet[1, 0], jet[0, 1]
    for step in range(_STEPS):
        tried = at + part * _step(slope_u, slope_v, offset)
        # Over a seam the search goes on at the other side.
        over = closed & ((tried < low) | (tried > high))
        tried = np.where(over, low + (tried - low) % (high - low), np.clip(tried, low, high))
        jet = surface_jet(surface, tried[:, 0], tried[:, 1], 1)
        left = target - jet[0, 0]
        nearer = (np.sum(left**2, axis=1) < np.sum(offset**2, axis=1))[:, None]
        at, offset, part = np.where(nearer, tried, at), np.where(nearer, left, offset), np.where(nearer, 1.0, part / 2)
        slope_u, slope_v = np.where(nearer, jet[1, 0], slope_u), np.where(nearer, jet[0, 1], slope_v)
        nearest_now = np.linalg.norm(offset, axis=1).reshape(-1, starts).min(axis=1)
        if step >= _LEAST_STEPS and (nearest_yet - nearest_now).max() <= _DONE * size:
            break
        nearest_yet = nearest_now
    away = np.linalg.norm(offset, axis=1).reshape(-1, starts)
    nearest = np.argmin(away, axis=1)
    rows = np.arange(len(points))
    return at.reshape(-1, starts, 2)[rows, nearest], away[rows, nearest]


def _step(s_u: FloatArray, s_v: FloatArray, way: FloatArray) -> FloatArray:
    """Return (du, dv) with s_u du + s_v dv as near to the way as can be, shape (K, 2)."""
    e, f, g, a, b = (
        np.einsum("kd,kd->k", x, y) for x, y in ((s_u, s_u), (s_u, s_v), (s_v, s_v), (s_u, way), (s_v, way))
    )
    # In a pole one direction has no length: it is left alone.
    e, g = np.maximum(e, _POLE * g), np.maximum(g, _POLE * e)
    area = np.maximum(e * g - f**2, _POLE * e * g)
    area = np.where(area > 0, area, 1.0)
    return np.stack([(a * g - b * f) / area, (b * e - a * f) / area], axis=1)


def _places(breaks: FloatArray) -> FloatArray:
    """Return places over a range, one in each span at the least."""
    middles = (breaks[1:] + breaks[:-1]) / 2
    return np.unique(np.concatenate([np.linspace(breaks[0], breaks[-1], _GRID), breaks, middles]))
