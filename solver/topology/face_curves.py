"""A curve on a face: a curve in the face's parameters (a pcurve), or the feet of an edge in space.

An edge of a CAD file is stored twice, and the two differ: the edge in space is what the neighbour shares, so its feet
on the face are taken where it stays within its tolerance of the face, and the pcurve elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import EdgeError
from semispline.solver.splines import BSplineCurve
from semispline.solver.topology.face_jets import Face, dot, parameters_of

# Parameters (s, t) of the face and their derivatives at parameters of the curve: shapes (K, 2).
Evaluator: TypeAlias = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
Source: TypeAlias = Literal["pcurve", "foot"]

# A foot is sought from so many points of the edge on, and from the nearest of so many points of the face each way.
_NODES, _GRID = 240, 60
# Ends nearer than this fraction of the length are one point.
_SAME_POINT = 1e-6
# An edge is on the face where it stays within its tolerance, or within this fraction of its length.
ON_FACE = 1e-5
# Of the range of a parameter.
_ROUNDING = 1e-12
# A pcurve may leave the domain of the face by this fraction.
_OUTSIDE = 1e-6


@dataclass(frozen=True, eq=False)
class FaceCurve:
    """A curve on a face.

    Attributes
    ----------
    face : Face
    evaluator : callable
        Right of a break at breaks.
    breaks : ndarray
        Ends of its smooth pieces, in its own parameter.
    source : {"pcurve", "foot"}
    degree : int or None
        Of a pcurve.
    edge_to_face, edge_to_pcurve : float or None
        The largest distances of the edge in space from the face, and of the pcurve from it; None where there is none.
    """

    face: Face
    evaluator: Evaluator
    breaks: FloatArray
    source: Source
    degree: int | None = None
    edge_to_face: float | None = None
    edge_to_pcurve: float | None = None

    @property
    def ends(self) -> tuple[float, float]:
        """The range of the parameter."""
        return float(self.breaks[0]), float(self.breaks[-1])

    def wrapped(self, x: FloatArray) -> FloatArray:
        """Return parameters that run on over the end of a closed curve in its range."""
        start, end = self.ends
        # What is past an end by rounding is that end, of an open curve too.
        beyond = _ROUNDING * (end - start)
        turned = np.where(x > end + beyond, x - (end - start), np.where(x < start - beyond, x + (end - start), x))
        return np.clip(turned, start, end)

    def at(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (s, t) and their derivatives, shapes (K, 2)."""
        return self.evaluator(self.wrapped(x))

    def tangents(self, x: FloatArray, beside: FloatArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Return points and derivatives in space, shapes (K, 3); the slope is that at the parameters `beside`."""
        at, slope = self.at(x)
        if beside is not None:
            slope = self.at(beside)[1]
        jet = self.face.jet(at, 1, at if beside is None else self.at(beside)[0])
        return jet[0, 0], jet[1, 0] * slope[:, :1] + jet[0, 1] * slope[:, 1:]

    @cached_property
    def places(self) -> FloatArray:
        """Parameters in every smooth piece, its ends too: where to look for anything."""
        return spread(self.breaks, 400)

    @cached_property
    def is_closed(self) -> bool:
        """Whether both ends are one point."""
        points, _ = self.tangents(self.places)
        length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        return bool(np.linalg.norm(points[0] - points[-1]) <= _SAME_POINT * length)


def trim_curve(face: Face, pcurve: BSplineCurve | None, edge: BSplineCurve | None, tolerance: float) -> FaceCurve:
    """Return the curve on a face that a trim curve is meant to be: the feet of its edge, or its pcurve.

    Raises
    ------
    EdgeError
        There is neither, or it is not on the face.
    """
    try:
        on_face = None if pcurve is None else curve_on_face(face, pcurve)
    except EdgeError:
        # Near a pole a hair in space is much in the parameters: there the edge alone says what is meant.
        if edge is None:
            raise
        on_face = None
    if edge is not None:
        on_face = edge_on_face(face, edge, on_face, tolerance)
    if on_face is None:
        raise EdgeError("curve: found neither a curve in the face's parameters nor an edge in space, expected one")
    return on_face


def spread(breaks: FloatArray, total: int, least: int = 1) -> FloatArray:
    """Return parameters that divide each span evenly, about `total` in all."""
    share = np.diff(breaks) / (breaks[-1] - breaks[0])
    counts = np.maximum(least, np.ceil(total * share)).astype(int)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(breaks[:-1], breaks[1:], counts, strict=True)]
    return np.append(np.concatenate(parts), breaks[-1])


def curve_on_face(face: Face, pcurve: BSplineCurve) -> FaceCurve:
    """Return a curve in the face's parameters as a curve on it.

    Raises
    ------
    EdgeError
        It leaves the domain of the face where that is not closed, or it is a point.
    """
    require(pcurve, "curve", BSplineCurve)
    if np.abs(pcurve.control_points[:, 2]).max() > 0:
        raise EdgeError("curve: found points off the plane z = 0, expected a curve (s, t) in the face's parameters")
    curve = FaceCurve(face, _planar(pcurve), np.unique(pcurve.knots), "pcurve", pcurve.degree)
    at, _ = curve.at(curve.places)
    over = np.maximum(face.low - at, at - face.low - face.widths) / face.widths
    over = np.where(face.closed, over - 1, over)
    if over.max() > _OUTSIDE:
        k = np.unravel_index(int(over.argmax()), over.shape)[0]
        (s0, s1), (t0, t1) = face.surface.domain
        raise EdgeError(
            f"curve: found (s, t) = ({at[k, 0]:.6g}, {at[k, 1]:.6g}), expected a point in "
            f"[{s0:.6g}, {s1:.6g}] x [{t0:.6g}, {t1:.6g}]"
        )
    points, _ = curve.tangents(curve.places)
    if not np.ptp(points, axis=0).max() > 1e-9 * face.size:
        raise EdgeError("curve: it is one point of the face, expected a curve with a length")
    return curve


def _planar(pcurve: BSplineCurve) -> Evaluator:
    return lambda x: (pcurve.evaluate(x)[:, :2], pcurve.evaluate(x, 1)[:, :2])


def edge_on_face(face: Face, edge: BSplineCurve, pcurve: FaceCurve | None, tolerance: float) -> FaceCurve:
    """Return the feet of an edge where it stays near the face, else the pcurve; without one, the feet.

    The feet run as the edge does.

    Raises
    ------
    EdgeError
        There is no pcurve, and the edge is not on the face.
    """
    breaks = np.unique(edge.knots)
    nodes = spread(breaks, _NODES)
    points = edge.evaluate(nodes)
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    to_pcurve = None
    if pcurve is None:
        guess = _near(face, points)
    else:
        x = pcurve.places
        nearest = _nearest(pcurve.tangents(x)[0], points)
        guess = pcurve.at(x[nearest])[0]
        to_pcurve = _distance(pcurve.tangents(spread(pcurve.breaks, _NODES))[0], edge)
    at, _, away = face.feet(points, guess, None, 2)
    distance = float(np.linalg.norm(away, axis=1).max())
    allowed = max(tolerance, ON_FACE * length)
    if distance <= allowed:
        evaluator = _feet(face, edge, nodes, unwrapped(at, face))
        return FaceCurve(face, evaluator, breaks, "foot", None, distance, to_pcurve)
    if pcurve is None:
        raise EdgeError(
            f"edge: found it {distance:.3g} away from the face, expected at most {allowed:.3g}: it is not an edge of it"
        )
    return replace(pcurve, edge_to_face=distance, edge_to_pcurve=to_pcurve)


def _distance(points: FloatArray, edge: BSplineCurve) -> float:
    """Return the largest distance of points near an edge from it: feet from the nearest of many of its points."""
    start, end = float(edge.knots[0]), float(edge.knots[-1])
    nodes = spread(np.unique(edge.knots), 400)
    x = nodes[_nearest(edge.evaluate(nodes), points)]
    for _ in range(8):
        tangent = edge.evaluate(x, 1)
        step = dot(points - edge.evaluate(x), tangent) / np.maximum(dot(tangent, tangent), 1e-300)
        x = np.clip(x + step, start, end)
    return float(np.linalg.norm(points - edge.evaluate(x), axis=1).max())


def _feet(face: Face, edge: BSplineCurve, nodes: FloatArray, at: FloatArray) -> Evaluator:
    def evaluate(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        guess = np.stack([np.interp(x, nodes, at[:, d]) for d in range(2)], axis=1)
        feet, jet, away = face.feet(edge.evaluate(x), guess, None, 2)
        return feet, parameters_of(jet, edge.evaluate(x, 1), away)

    return evaluate


def unwrapped(at: FloatArray, face: Face) -> FloatArray:
    """Return parameters along a curve without the jumps of closed surfaces at their seams."""
    at = np.array(at)
    for d in range(2):
        if face.closed[d]:
            at[:, d] = np.unwrap(at[:, d], period=face.widths[d])
    return at


def parameters_on(face: Face, points: FloatArray) -> FloatArray:
    """Return the parameters of points along a curve on a face, shape (K, 2), without jumps at its seams."""
    return unwrapped(face.feet(points, _near(face, points), None, 2)[0], face)


def _nearest(some: FloatArray, points: FloatArray) -> NDArray[np.int64]:
    """Return which of some points is the nearest to each of others."""
    # SciPy waits: the process that reads a file has no use for it.
    from scipy.spatial import KDTree

    return np.asarray(KDTree(some).query(points)[1])


def _near(face: Face, points: FloatArray) -> FloatArray:
    """Return the parameters of the nearest of many points of the face, shape (K, 2)."""
    # Middles of intervals: from a pole no step leads away.
    ends = [spread(breaks, _GRID, 3) for breaks in face.surface.breakpoints]
    grids = [(x[:-1] + x[1:]) / 2 for x in ends]
    grid = face.surface.evaluate_grid(grids[0], grids[1]).reshape(-1, 3)
    nearest = _nearest(grid, points)
    i, j = np.divmod(nearest, len(grids[1]))
    return np.stack([grids[0][i], grids[1][j]], axis=1)
