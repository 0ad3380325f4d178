"""A blend along several faces cut into one piece for each, where these went on into each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.splines import (
    BSplineCurve,
    BSplineSurface,
    boundary_curve,
    closest_point,
    move_seam,
    restrict_v,
)
from semispline.solver.topology.face_runs import FaceRun
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.sides import entering, leaving

# Of the range of v: places that are nearer are one, and lie on a knot that is so near.
_SAME_PLACE = 1e-6


@dataclass(frozen=True, eq=False)
class Panel:
    """A piece of a blend that takes the place of one face.

    Attributes
    ----------
    surface : BSplineSurface
        u from the first contact to the second.
    a, b : (float, float)
        v where the sides begin and end, both in the direction in which the wire of the old face walks side a.
    """

    surface: BSplineSurface
    a: tuple[float, float]
    b: tuple[float, float]


def panels_of(graph: EdgeGraph, run: FaceRun, surface: BSplineSurface) -> list[Panel]:
    """Return the pieces of a blend along a run of faces.

    Raises
    ------
    EdgeError
        Corners of the faces lie along the blend in another order than along the faces; or of a closed run none lies on
        the seam of the blend.
    """
    a, b = _corners(graph, run)
    count = len(run.members)
    first = 0
    if run.closed:
        surface, places, first = _of_ring(surface, a, b, _middle(graph, run))
    else:
        places = _placed(surface, a, b)
        low, high = surface.domain[1]
        runs_up = bool(places[:, 0].mean() < places[:, -1].mean())
        places[:, 0], places[:, -1] = (low, high) if runs_up else (high, low)
    _same(places, surface)
    steps = np.diff(places, axis=1)
    if not ((steps > 0).all() or (steps < 0).all()):
        raise EdgeError(
            "--replace: the corners of these faces lie along the blend in another order; --surfaces writes the blend "
            "alone"
        )
    found = []
    for k in range(count):
        at = (k - first) % count
        ends = places[:, at : at + 2]
        piece = restrict_v(surface, float(ends.min()), float(ends.max()))
        found.append(Panel(piece, _pair(ends[0]), _pair(ends[1])))
    return found


def _corners(graph: EdgeGraph, run: FaceRun) -> tuple[FloatArray, FloatArray]:
    """Return the points between the faces along both sides, the first and the last ones too, shape (M + 1, 3) each."""
    uses = graph.uses
    a = [entering(uses, m.a.uses[0])[0] for m in run.members] + [leaving(uses, run.members[-1].a.uses[-1])[0]]
    b = [leaving(uses, m.b.uses[-1])[0] for m in run.members] + [entering(uses, run.members[-1].b.uses[0])[0]]
    return np.array(a), np.array(b)


def _along(curve: BSplineCurve, points: Sequence[FloatArray] | FloatArray) -> FloatArray:
    return np.array([float(closest_point(curve, point).parameters[0]) for point in points])


def _of_ring(
    surface: BSplineSurface, a: FloatArray, b: FloatArray, middle: FloatArray
) -> tuple[BSplineSurface, FloatArray, int]:
    """Return a closed blend with its seam at a corner, where all corners lie from that one on, and its number.

    `middle` lies within side a of the first face.
    """
    low, high = surface.domain[1]
    period, within = high - low, _SAME_PLACE * (high - low)
    places = _placed(surface, a[:-1], b[:-1])
    apart = _apart(places[0], places[1], period)
    way, step = (
        (x - places[0, 0]) % period
        for x in (_along(boundary_curve(surface, "u0"), middle[None])[0], places[0, 1 % places.shape[1]])
    )
    runs_up = bool(way < step)
    if not (apart <= within).any():
        return _unwound(surface, places if runs_up else places[:, ::-1], runs_up=runs_up)
    # Best one that lies on the seam.
    at_seam = _apart(places[0], np.full_like(places[0], low), period)
    k = int(np.where(apart <= within, at_seam, np.inf).argmin())
    if at_seam[k] > within:
        surface = move_seam(surface, v=_on_knot(surface, float(places[0, k])))
        places = _placed(surface, a[:-1], b[:-1])
        low, high = surface.domain[1]
    begun = np.roll((places - low) % period, -k, axis=1)
    begun[:, 0] = 0.0 if runs_up else period
    closed = np.concatenate([begun, np.full((2, 1), period if runs_up else 0.0)], axis=1)
    return surface, np.asarray(low + closed), k


def _unwound(surface: BSplineSurface, places: FloatArray, *, runs_up: bool) -> tuple[BSplineSurface, FloatArray, int]:
    """Return a closed blend three times over, where the corners, in increasing order, lie on it, and the first one.

    A piece that runs across the seam is then one of it.
    """
    low, high = surface.domain[1]
    period = high - low
    steps = np.diff(np.concatenate([places, places[:, :1]], axis=1), axis=1) % period
    second = places[0, 0] + (places[1, 0] - places[0, 0] + period / 2) % period - period / 2
    starts = np.array([places[0, 0], second])
    starts += period if starts.min() < low else 0.0
    found = starts[:, None] + np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
    q, knots = surface.degree_v, surface.knots_v
    longer = np.concatenate([knots[:-1], knots[q + 1 : -1] + period, knots[q + 1 :] + 2 * period])
    points = [surface.control_points, surface.control_points[:, 1:], surface.control_points[:, 1:]]
    weights = surface.weights
    whole = BSplineSurface(
        surface.degree_u,
        q,
        surface.knots_u,
        longer,
        np.concatenate(points, axis=1),
        None if weights is None else np.concatenate([weights, weights[:, 1:], weights[:, 1:]], axis=1),
    )
    # Walked down, the first corner comes last but one.
    return (whole, found, 0) if runs_up else (whole, found[:, ::-1], places.shape[1] - 1)


def _apart(one: FloatArray, other: FloatArray, period: float) -> FloatArray:
    return np.asarray(np.abs((one - other + period / 2) % period - period / 2))


def _middle(graph: EdgeGraph, run: FaceRun) -> FloatArray:
    uses = run.members[0].a.uses
    points = graph.uses.walked_points(uses[len(uses) // 2])
    return np.asarray(points[len(points) // 2] if len(uses) % 2 else points[0])


def _placed(surface: BSplineSurface, a: FloatArray, b: FloatArray) -> FloatArray:
    return np.stack([_along(boundary_curve(surface, "u0"), a), _along(boundary_curve(surface, "u1"), b)])


def _on_knot(surface: BSplineSurface, v: float) -> float:
    knots = np.unique(surface.knots_v)
    near = float(knots[np.abs(knots - v).argmin()])
    low, high = surface.domain[1]
    return near if abs(near - v) <= _SAME_PLACE * (high - low) else v


def _same(places: FloatArray, surface: BSplineSurface) -> None:
    """Let corners that lie at one place on both sides do so to the last bit, and on a knot that is there."""
    low, high = surface.domain[1]
    for k in range(places.shape[1]):
        one, other = (_on_knot(surface, float(v)) for v in places[:, k])
        places[:, k] = (one, one) if abs(one - other) <= _SAME_PLACE * (high - low) else (one, other)


def _pair(values: FloatArray) -> tuple[float, float]:
    start, end = values.tolist()
    return start, end
