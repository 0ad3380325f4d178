"""Borders of a rounding beside one side of a run of sharp edges: where the edges that meet it are trimmed.

A run is walked as the faces on its first side walk it; w goes from 0 to 1 along it, and v of the new surface with w or
against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.splines import BSplineCurve
from semispline.solver.topology.occ_new_edges import foot_on
from semispline.solver.topology.occ_shapes import (
    EdgeUsers,
    ends,
    forward,
    new_vertex,
    points_of,
    range_of,
)

# Of the length of an edge: a cut nearer to its end leaves nothing of it.
_LEFT = 1e-6
# Of the length of a border: places on it that are nearer are one; a side edge that passes at more does not meet it.
_SAME, _MEETS = 1e-6, 1e-4
_NODES, _STEPS = 400, 30


@dataclass(frozen=True, eq=False)
class Sharp:
    """One sharp edge of a run.

    Attributes
    ----------
    edge : TopoDS_Edge
        In its own direction.
    number : int
    faces : (int, int)
        On the first side, and beyond.
    against : bool
        The run walks it against its own direction.
    """

    edge: Any
    number: int
    faces: tuple[int, int]
    against: bool

    @property
    def start(self) -> Any:
        """The vertex at which the run comes to it."""
        return ends(self.edge)[1 if self.against else 0]

    @property
    def end(self) -> Any:
        """The vertex at which the run leaves it."""
        return ends(self.edge)[0 if self.against else 1]

    def points(self, count: int) -> FloatArray:
        """Return points along it, as the run walks it."""
        return points_of(self.edge, self.parameters(count))

    def parameters(self, count: int) -> FloatArray:
        """Return so many parameters of it, as the run walks it."""
        t = np.linspace(*range_of(self.edge), count)
        return t[::-1] if self.against else t


@dataclass(frozen=True, eq=False)
class Run:
    """Sharp edges that run end to end."""

    users: EdgeUsers
    edges: tuple[Sharp, ...]
    closed: bool
    title: str

    def vertex(self, station: int) -> Any:
        """Return the vertex where an edge begins; after the last one where that ends."""
        return self.edges[station].start if station < len(self.edges) else self.edges[-1].end

    def side_edge(self, station: int, side: int) -> Any | None:
        """Return the edge that meets the run in a vertex, on one side of it; None where there is none.

        Raises
        ------
        EdgeError
            More edges meet there than can be trimmed.
        """
        last = len(self.edges)
        is_end = not self.closed and station in (0, last)
        beside = [self.edges[k % last] for k in (station - 1, station) if self.closed or 0 <= k < last]
        own = {x.number for x in beside}
        vertex = self.vertex(station)
        around = [edge for edge in self.users.at(vertex) if self.users.number(edge) not in own]
        both = [self._of_faces(around, {x.faces[k] for x in beside}) for k in (0, 1)]
        if is_end and (len(around) != 2 or [len(x) for x in both] != [1, 1]):
            raise EdgeError(f"{self.title}: {len(around) + 1} edges meet at its end, of which three can be trimmed")
        if not is_end and (max(map(len, both)) > 1 or sum(map(len, both)) > len(around)):
            raise EdgeError(
                f"{self.title}: {len(around) + len(own)} edges meet at a joint of it, expected those that are rounded "
                "and one on each side at most"
            )
        return both[side][0] if both[side] else None

    def _of_faces(self, edges: Sequence[Any], faces: set[int]) -> list[Any]:
        return [edge for edge in edges if any(n in faces for n, _ in self.users.of(edge))]


@dataclass(frozen=True, eq=False)
class Break:
    """A vertex of a border.

    Attributes
    ----------
    w : float
    vertex : TopoDS_Vertex
    station : int or None
        Where an edge meets the run: k where edge k of it begins.
    side : TopoDS_Edge or None
        That edge.
    at : float
        The parameter at which it is cut off.
    """

    w: float
    vertex: Any
    station: int | None = None
    side: Any | None = None
    at: float = 0.0


def breaks_of_rim(run: Run, side: int, border: BSplineCurve, along: bool, cuts: Sequence[float]) -> list[Break]:
    """Return the vertices of a border in the order of the run; of a closed one w = 0 is the first.

    Parameters
    ----------
    run : Run
    side : {0, 1}
    border : BSplineCurve
        Of the new surface, by v.
    along : bool
        v goes with w.
    cuts : sequence of float
        Further places w.

    Raises
    ------
    EdgeError
        An edge that meets the run does not meet the border, or not within what it is long.
    """
    low, high = float(border.knots[0]), float(border.knots[-1])

    def v_of(w: float) -> float:
        return low + w * (high - low) if along else high - w * (high - low)

    def point(w: float) -> FloatArray:
        return np.asarray(border.evaluate(np.array([v_of(w)]))[0])

    samples = border.evaluate(np.linspace(low, high, _NODES + 1))
    length = float(np.linalg.norm(np.diff(samples, axis=0), axis=1).sum())
    last = len(run.edges)
    fixed = [0.0, *sorted(cuts)] if run.closed else [0.0, *sorted(cuts), 1.0]
    found = [Break(w, new_vertex(point(w))) for w in fixed]
    for station in range(last if run.closed else last + 1):
        edge = run.side_edge(station, side)
        if edge is None:
            continue
        if not run.closed and station in (0, last):
            k = 0 if station == 0 else len(fixed) - 1
            found[k] = _trimming(run, station, edge, found[k], point(found[k].w))
            continue
        v, away = _meeting(edge, border)
        if away > _MEETS * length:
            raise EdgeError(
                f"{run.title}: the contact passes {away:.3g} beside an edge of face {_faces(run, station, side)} that "
                "it should meet"
            )
        w = (v - low) / (high - low) if along else (high - v) / (high - low)
        same = [k for k, x in enumerate(found) if _apart(x.w, w, closed=run.closed) * length <= _SAME * length]
        if same:
            found[same[0]] = _trimming(run, station, edge, found[same[0]], point(found[same[0]].w))
        else:
            found.append(_trimming(run, station, edge, Break(w, new_vertex(point(w))), point(w)))
    return sorted(found, key=lambda x: x.w)


def _apart(one: float, other: float, *, closed: bool) -> float:
    away = abs(one - other)
    return min(away, 1 - away) if closed else away


def _faces(run: Run, station: int, side: int) -> str:
    beside = dict.fromkeys(run.edges[k % len(run.edges)].faces[side] for k in (station - 1, station))
    return " and ".join(map(str, beside))


def _trimming(run: Run, station: int, edge: Any, place: Break, point: FloatArray) -> Break:
    """Return a vertex of a border at which an edge is cut off."""
    at = foot_on(edge, point)
    low, high = range_of(edge)
    near = _LEFT * (high - low)
    faces = " and ".join(str(n) for n in dict.fromkeys(n for n, _ in run.users.of(edge)))
    if not low + near < at < high - near:
        here = low if ends(forward(edge))[0].IsSame(run.vertex(station)) else high
        if abs(at - here) <= near:
            raise EdgeError(
                f"{run.title}: the contact does not meet the edge between faces {faces}: the face beyond its end would "
                "have to grow"
            )
        raise EdgeError(f"{run.title}: the cut reaches past the edge between faces {faces}; take a smaller one")
    return Break(place.w, place.vertex, station, edge, at)


def _meeting(edge: Any, border: BSplineCurve) -> tuple[float, float]:
    """Return at which v a border is nearest to an edge, and how far they are apart there."""
    low, high = range_of(edge)
    start, end = float(border.knots[0]), float(border.knots[-1])
    t, v = np.linspace(low, high, _NODES + 1), np.linspace(start, end, _NODES + 1)
    away = np.linalg.norm(points_of(edge, t)[:, None] - border.evaluate(v), axis=2)
    i, j = np.unravel_index(int(away.argmin()), away.shape)
    at, on = float(t[i]), float(v[j])
    step = 1e-6 * (high - low)
    for _ in range(_STEPS):
        around = points_of(edge, np.clip([at - step, at, at + step], low, high))
        slope = (around[2] - around[0]) / (min(at + step, high) - max(at - step, low))
        there, turn = border.evaluate(np.array([on]))[0], border.evaluate(np.array([on]), 1)[0]
        move = np.linalg.lstsq(np.stack([slope, -turn], axis=1), there - around[1], rcond=None)[0]
        following = min(max(at + float(move[0]), low), high), min(max(on + float(move[1]), start), end)
        done = abs(following[0] - at) <= 1e-15 * (high - low) and abs(following[1] - on) <= 1e-15 * (end - start)
        at, on = following
        if done:
            break
    apart = points_of(edge, np.array([at]))[0] - border.evaluate(np.array([on]))[0]
    return on, float(np.linalg.norm(apart))
