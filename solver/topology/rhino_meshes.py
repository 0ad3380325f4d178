"""Faces of 3dm files in triangles: the edges are projected to the surface, which is cut along them."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import SemisplineError
from semispline.solver.io import RhinoFace, curve_evaluator
from semispline.solver.topology.face_curves import unwrapped
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.face_meshes import EdgeLine, FaceMesh, grid_within
from semispline.solver.topology.half_edges import Flags
from semispline.solver.topology.rhino_edges import FAR, feet_on

# Points of each span of an edge, and of an edge at the least.
_PER_SPAN, _LEAST = 4, 40
# Derivatives below this fraction of the largest along a loop vanish: it runs through a pole.
_POLE = 1e-6
# An edge that is further from its surface than this, of its size, is not on it; files keep to much less, but not all.
_OFF = 0.02
# A loop whose ends are further apart than this, of the domain, was not found on the surface.
_OPEN = 1e-3


def edge_lines_of(face: RhinoFace) -> tuple[EdgeLine, ...]:
    """Return the edges of a face, numbered as `rhino_edges.edges_of_3dm` does; points have a number, and no line."""
    return tuple(EdgeLine(name, points) for loop in _loops(face) for name, points in loop if len(points))


def mesh_of(face: RhinoFace) -> FaceMesh | None:
    """Return the face in triangles; None where its edges are not found on its surface.

    Raises
    ------
    FileError, KnotError
        It has no surface.
    """
    surface = face.surface()
    try:
        own = Face(surface)
        loops = [_in_parameters(own, np.concatenate([points for _, points in loop])) for loop in _loops(face)]
    except SemisplineError:
        return None
    found = [loop for loop in loops if loop is not None]
    if not found or len(found) < len(loops):
        return None
    return grid_within(surface, found, own.closed.tolist())


def _loops(face: RhinoFace) -> list[list[tuple[str, FloatArray]]]:
    """Return names and points of the edges of each loop, in walking order."""
    if face.trims is None:
        return []
    against_surface, loops = face.trims
    found, k = [], 0
    for loop in loops:
        edges = []
        for edge, place, against in reversed(loop) if against_surface else loop:
            points = np.zeros((0, 3)) if edge < 0 else _points(face, place)
            edges.append((f"e{k}", points[::-1] if bool(against) != against_surface else points))
            k += 1
        found.append(edges)
    return found


def _points(face: RhinoFace, place: int) -> FloatArray:
    degree, knots, net = (face.curves or ())[place]
    breaks = np.unique(knots[degree : len(knots) - degree])
    each = max(_PER_SPAN, -(-_LEAST // (len(breaks) - 1)))
    at = np.interp(np.arange(each * (len(breaks) - 1) + 1) / each, np.arange(len(breaks)), breaks)
    return curve_evaluator(degree, knots, net)(at)[0]


def _in_parameters(face: Face, points: FloatArray) -> FloatArray | None:
    """Return a loop in the parameters, or None where it is not on the surface, or does not close there."""
    at, away = feet_on(face.surface, points, FAR * face.size)
    if away.max() > _OFF * face.size:
        return None
    at = unwrapped(at, face)
    for axis, orders in enumerate(((1, 0), (0, 1))):
        speed = np.linalg.norm(face.jet(at, 1)[orders], axis=1)
        at = _through_poles(at, speed <= _POLE * speed.max(), axis, face.widths[axis] if face.closed[axis] else None)
    return None if (np.abs(at[0] - at[-1]) / face.widths).max() > _OPEN else at


def _through_poles(at: FloatArray, in_pole: Flags, axis: int, period: float | None) -> FloatArray:
    """Return a loop with two points for each stay in a pole: there the parameter is that of the points beside it."""
    if not in_pole.any() or in_pole.all():
        return at
    # Begun beside a pole, outside of it.
    first = int(np.flatnonzero(~in_pole & np.roll(in_pole, 1))[0])
    at, in_pole = np.roll(at, -first, axis=0), np.roll(in_pole, -first)
    kept: list[FloatArray] = []
    turns = []
    for k in range(len(at)):
        beside = [j % len(at) for j in (k - 1, k + 1) if not in_pole[j % len(at)]] if in_pole[k] else [k]
        # Entered at one of its points and left at another, or both at one.
        turns += [len(kept) + 1] if in_pole[k] and (k - 1) % len(at) in beside else []
        for j in beside:
            point = at[k].copy()
            point[axis] = at[j, axis]
            kept.append(point)
    loop = np.array([*kept, at[0]])
    if period is not None:
        loop[:, axis] = np.unwrap(loop[:, axis], period=period)
        # In the last pole the loop may turn by any part of a turn, and where it ends is known.
        loop[-2:, axis] -= np.round((loop[-1, axis] - loop[0, axis]) / period) * period
        # Up and down one seam from pole to pole: all the way round lies between.
        if len(turns) == 2 and np.ptp(loop[:, axis]) <= _OPEN * period:
            loop[turns[0] : turns[1], axis] += period
    return loop
