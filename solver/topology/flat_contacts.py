"""Straight and circular edges of flat faces moved into them, up to the next edges of the face: exactly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineCurve, BSplineSurface, plane
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.trim_curves import TrimCurve

# Of the length or the radius: what is straight, what is round, and what is one point.
_STRAIGHT = 1e-10
# Places at which a crossing is sought, and halvings of what is between.
_PLACES, _HALVINGS = 400, 60
# Radians of one span of an arc, at the most.
_SPAN = np.pi / 2
# Of the radius that is left: a band that comes near its centre has no parameters there.
_TO_CENTRE = 0.5


@dataclass(frozen=True)
class FlatEdge:
    """A use of an edge of a flat face that is moved into it.

    Attributes
    ----------
    row : int
    square : (bool, bool)
        Whether it is moved squarely where it begins and where it ends, as it is walked: it goes on there in another
        edge of the face. Else the contact ends on the next edge.
    """

    row: int
    square: tuple[bool, bool] = (False, False)


def is_straight_flat(graph: EdgeGraph, row: int) -> bool:
    """Tell whether a use is a straight edge of a flat face."""
    return is_flat(graph, row) and _is_straight(graph.uses.walked_points(row))


def is_flat(graph: EdgeGraph, row: int) -> bool:
    """Tell whether the face of a use is flat."""
    return bool(graph.faces.kind[int(graph.uses.face[row])] == "plane")


def curves_wanted(graph: EdgeGraph, row: int) -> list[int]:
    """Return the uses of which curves are needed to move an edge of a flat face: of curved ones."""
    uses = graph.uses
    near = (row, int(uses.previous[row]), int(uses.following[row]))
    return [use for use in dict.fromkeys(near) if not _is_straight(uses.points[use])]


def flat_contact(graph: EdgeGraph, edge: FlatEdge, distance: float, curves: Mapping[int, TrimCurve]) -> Base | None:
    """Return the base along an edge of a flat face, moved into it: exact where the edge is a line or an arc.

    It is as wide as the distance: then the shape across depends on nothing else.

    Parameters
    ----------
    graph : EdgeGraph
    edge : FlatEdge
    distance : float
        Model units.
    curves : mapping
        Those of `curves_wanted`, by use.

    Returns
    -------
    Base or None
        None where the edge is another curve, or the contact misses the next edges.
    """
    if edge.row not in curves:
        return _line(graph, edge, distance, curves)
    circle = _circle(graph, edge.row, curves[edge.row])
    return None if circle is None else _arc(graph, edge, distance, curves, circle)


def _line(graph: EdgeGraph, edge: FlatEdge, distance: float, curves: Mapping[int, TrimCurve]) -> Base | None:
    points = graph.uses.walked_points(edge.row)
    origin, along = points[0], points[-1] - points[0]
    inward = np.cross(graph.uses.normal[edge.row, 0], along)
    inward /= np.linalg.norm(inward)

    def off(x: FloatArray) -> FloatArray:
        return np.asarray((x - origin) @ inward)

    found = []
    for near, square, next_edge in zip(
        (points[0], points[-1]), edge.square, _next(graph, edge.row, curves), strict=True
    ):
        point = near + distance * inward if square else _crossing(*next_edge, near, lambda x: off(x) - distance)
        if point is None:
            return None
        found.append(point)
    start, end = found
    if (end - start) @ along <= 0:
        return None
    return Base(plane(start, end - start, inward * distance), "v0")


@dataclass(frozen=True, eq=False)
class _Circle:
    """The circle of an edge; x and y span its plane, x to the start of the edge as it is walked, y as it goes on.

    `angle` is by how much it goes on; `outwards` is 1 where the face lies outside of it, else -1.
    """

    centre: FloatArray
    x: FloatArray
    y: FloatArray
    radius: float
    angle: float
    outwards: float
    curve: BSplineCurve

    def at(self, radius: float, angles: FloatArray) -> FloatArray:
        """Return points at a distance from the centre."""
        return np.asarray(self.centre + radius * (np.cos(angles)[:, None] * self.x + np.sin(angles)[:, None] * self.y))

    def angle_of(self, point: FloatArray, near: float) -> float:
        """Return the angle of a point, on the turn of another."""
        found = float(np.arctan2((point - self.centre) @ self.y, (point - self.centre) @ self.x))
        return found + 2 * np.pi * float(np.round((near - found) / (2 * np.pi)))


def _circle(graph: EdgeGraph, row: int, curve: TrimCurve) -> _Circle | None:
    uses = graph.uses
    points, tangent = uses.walked_points(row), uses.tangent[row, -1 if uses.reversed[row] else 0]
    if curve.edge is None:
        return None
    samples = curve.edge.evaluate(np.linspace(curve.edge.knots[0], curve.edge.knots[-1], _PLACES + 1))
    # Through a point, one some way on, and the tangent: |p - c| = |q - c|, c on the normal of the first.
    normal = uses.normal[row, 0]
    aside = np.cross(normal, tangent)
    chord = points[len(points) // 2] - points[0]
    if abs(chord @ aside) <= _STRAIGHT * float(np.linalg.norm(chord)):
        return None
    radius = float(chord @ chord / (2 * (chord @ aside)))
    centre = points[0] + radius * aside
    for _ in range(2):
        # Least squares take away what the tangent's rounding left.
        away = samples - centre
        sizes = np.linalg.norm(away, axis=1)
        step = np.linalg.lstsq(np.column_stack([away / sizes[:, None], np.ones(len(away))]), sizes, rcond=None)[0]
        centre = centre + step[:3] - (step[:3] @ normal) * normal
        radius = float(np.linalg.norm(samples - centre, axis=1).mean())
    away = samples - centre
    if max(np.abs(np.linalg.norm(away, axis=1) - radius).max(), np.abs(away @ normal).max()) > _STRAIGHT * radius:
        return None
    x = (points[0] - centre) / np.linalg.norm(points[0] - centre)
    y = tangent - (tangent @ x) * x - (tangent @ normal) * normal
    y /= np.linalg.norm(y)
    walked = (
        samples if np.linalg.norm(samples[0] - points[0]) <= np.linalg.norm(samples[-1] - points[0]) else samples[::-1]
    )
    if np.linalg.norm(samples[0] - samples[-1]) <= _STRAIGHT * radius and (samples[1] - samples[0]) @ y < 0:
        walked = samples[::-1]
    angles = np.unwrap(np.arctan2((walked - centre) @ y, (walked - centre) @ x))
    outwards = 1.0 if uses.inward[row, 0] @ (uses.points[row, 0] - centre) > 0 else -1.0
    return _Circle(centre, x, y, radius, float(angles[-1] - angles[0]), outwards, curve.edge)


def _arc(
    graph: EdgeGraph, edge: FlatEdge, distance: float, curves: Mapping[int, TrimCurve], circle: _Circle
) -> Base | None:
    radius = circle.radius + circle.outwards * distance
    if radius <= _STRAIGHT * circle.radius:
        return None
    points = graph.uses.walked_points(edge.row)
    is_closed = bool(np.linalg.norm(points[0] - points[-1]) <= _STRAIGHT * circle.radius)
    angles = [0.0, circle.angle]
    if not is_closed:
        for k, next_edge in enumerate(_next(graph, edge.row, curves)):
            if edge.square[k]:
                continue
            near = points[0] if k == 0 else points[-1]
            point = _crossing(
                *next_edge,
                near,
                lambda x: circle.outwards * (np.linalg.norm(x - circle.centre, axis=-1) - radius),
            )
            if point is None:
                return None
            angles[k] = circle.angle_of(point, angles[k])
    moved = max(abs(angles[0]), abs(angles[1] - circle.angle))
    width = distance if circle.outwards > 0 else min(distance, _TO_CENTRE * radius)
    scales = np.array([radius, radius + circle.outwards * width]) / circle.radius
    if moved <= _STRAIGHT:
        # As the file has it: its parameters are those of the face beyond, too.
        curve = circle.curve
    elif angles[1] - angles[0] <= _STRAIGHT:
        return None
    else:
        curve = _arc_of(circle, angles[0], angles[1])
    away = curve.control_points - circle.centre
    net = circle.centre + scales[:, None, None] * away
    weights = None if curve.weights is None else np.stack([curve.weights] * 2)
    return Base(BSplineSurface(1, curve.degree, np.repeat([0.0, width], 2), curve.knots, net, weights), "u0")


def _arc_of(circle: _Circle, start: float, end: float) -> BSplineCurve:
    """Return an arc of the circle as rational quadratic spans."""
    count = max(1, int(np.ceil((end - start) / _SPAN - _STRAIGHT)))
    half = (end - start) / (2 * count)
    angles: FloatArray = start + half * np.arange(2 * count + 1, dtype=np.float64)
    weights = np.where(np.arange(2 * count + 1) % 2 == 0, 1.0, np.cos(half))
    points = circle.centre + (circle.at(circle.radius, angles) - circle.centre) / weights[:, None]
    knots = np.concatenate([[0.0], np.repeat(np.linspace(0.0, 1.0, count + 1), 2), [1.0]])
    return BSplineCurve(2, knots, points, weights)


def _next(graph: EdgeGraph, row: int, curves: Mapping[int, TrimCurve]) -> list[tuple[FloatArray, BSplineCurve | None]]:
    """Return points of the edges before and after one, each with its curve where it is no line."""
    uses = graph.uses
    found: list[tuple[FloatArray, BSplineCurve | None]] = []
    for use in (int(uses.previous[row]), int(uses.following[row])):
        edge = curves[use].edge if use in curves else None
        found.append((_sampled(edge) if edge is not None else uses.points[use][[0, -1]], edge))
    return found


def _is_straight(points: FloatArray) -> bool:
    along = points[-1] - points[0]
    length = float(np.linalg.norm(along))
    if length == 0:
        return False
    away = np.linalg.norm(np.cross(points - points[0], along / length), axis=1)
    return bool(away.max() <= _STRAIGHT * length)


def _sampled(curve: BSplineCurve) -> FloatArray:
    return curve.evaluate(np.linspace(curve.knots[0], curve.knots[-1], _PLACES + 1))


def _crossing(
    line: FloatArray, curve: BSplineCurve | None, near: FloatArray, beyond: Callable[[FloatArray], FloatArray]
) -> FloatArray | None:
    """Return where a next edge is at the distance, first seen from the end near a point; `beyond` is 0 there."""
    flipped = bool(np.linalg.norm(line[-1] - near) < np.linalg.norm(line[0] - near))
    start, end = line[0], line[-1]
    places = np.linspace(0.0, 1.0, _PLACES + 1)
    if curve is not None:
        places = np.linspace(float(curve.knots[0]), float(curve.knots[-1]), _PLACES + 1)

    def at(t: FloatArray) -> FloatArray:
        return np.asarray(start + t[:, None] * (end - start)) if curve is None else curve.evaluate(t)

    places = places[::-1] if flipped else places
    off = beyond(at(places))
    found = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    if not len(found):
        return None
    low, high = float(places[found[0]]), float(places[found[0] + 1])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if beyond(at(np.array([middle])))[0] >= 0 else (middle, high)
    return np.asarray(at(np.array([(low + high) / 2]))[0])


def largest_distance(graph: EdgeGraph, row: int, curves: Mapping[int, TrimCurve]) -> float:
    """Return how far a straight edge of a flat face can move until it misses one of the next edges."""
    points = graph.uses.walked_points(row)
    inward = np.cross(graph.uses.normal[row, 0], points[-1] - points[0])
    inward /= np.linalg.norm(inward)
    return min(float(((line - points[0]) @ inward).max()) for line, _ in _next(graph, row, curves))
