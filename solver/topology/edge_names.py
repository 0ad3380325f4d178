"""What an edge of a trimmed face is on its surface: a whole edge, a part, a line inside or a free curve; and its name.

Decided from the curve in the parameters of the face, by lengths: its poles hold all of it, so that what is called a
line of constant parameter is one within the tolerance everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.io import converted_parameters
from semispline.solver.splines import EdgeName, Surface
from semispline.solver.topology.half_edges import EdgeGraph

EdgeKind = Literal["whole", "part", "inner", "free", "point", "not classified"]

# An edge is a line of constant parameter, or the border, within this fraction of the size of the model. From 1e-6 to
# 1e-5 nothing changes; from 1e-4 on lines near a border are taken for it.
LINE = 1e-6
# Where the file shows no curves in the parameters: feet of samples are no better.
PROJECTED_LINE = 1e-4
# Of the largest derivative along an edge: below that a parameter says nothing of the place.
_POLE = 1e-6


@dataclass(frozen=True)
class NamedEdge:
    """What a use of an edge is on the surface of its face.

    Attributes
    ----------
    kind : {"whole", "part", "inner", "free", "point", "not classified"}
    name : EdgeName or None
        In the parameters of the converted surface; None but for the first three.
    off : float
        How far the edge is from the line that is named, at most, as far as is known; 0 where nothing is named.
    """

    kind: EdgeKind
    name: EdgeName | None = None
    off: float = 0.0


def line_tolerance(graph: EdgeGraph, row: int) -> float:
    """Return the length within which a use is a line of constant parameter."""
    return (PROJECTED_LINE if graph.uses.pcurve[row] == "projected" else LINE) * graph.size


def named_edge(graph: EdgeGraph, row: int, surface: Surface, deviation: float = 0.0) -> NamedEdge:
    """Return what a use is on the surface that is read out for its face, which may be off by `deviation`."""
    uses = graph.uses
    if uses.degenerate[row]:
        return NamedEdge("point")
    if uses.pcurve[row] == "none":
        return NamedEdge("not classified")
    tolerance = line_tolerance(graph, row)
    curve = _Curve(graph, row, surface, tolerance)
    straight = curve.high - curve.low <= curve.within
    if straight.all():
        return NamedEdge("point")
    # The samples of a circle in the parameters prove nothing of what lies between them.
    if not straight.any() or not (uses.proven[row] or uses.pcurve[row] == "projected"):
        return NamedEdge("free")
    across = 0 if straight[0] else 1
    name, off = curve.named(across)
    if off > tolerance + 2 * deviation:
        return NamedEdge("not classified")
    kind: EdgeKind = "inner" if name.at is not None else "whole" if name.part is None else "part"
    return NamedEdge(kind, name, off)


class _Curve:
    """A use as a curve in the parameters of its face.

    Attributes
    ----------
    low, high : ndarray, shape (2,)
        The least box that is known to hold it, in the parameters of the file.
    within : ndarray, shape (2,)
        What the tolerance is of u and of v.
    """

    def __init__(self, graph: EdgeGraph, row: int, surface: Surface, tolerance: float) -> None:
        uses, face = graph.uses, int(graph.uses.face[row])
        self.surface, self.points = surface, uses.points[row]
        self.kinds = graph.faces.parameters[face]
        self.start, self.end = graph.faces.ends[face].reshape(2, 2).T
        speeds = np.array([uses.speed_u[row].max(), uses.speed_v[row].max()])
        self.speeds = np.maximum(speeds, np.finfo(np.float64).tiny)
        self.within = tolerance / self.speeds
        self.closed = [_is_closed(surface, axis, tolerance) for axis in (0, 1)]
        self.uv = uses.uv[row].copy()
        self.low, self.high = uses.box[row]
        if uses.pcurve[row] == "projected":
            # A foot on a seam may be found at either side of it.
            for axis in np.flatnonzero(self.closed).tolist():
                self.uv[:, axis] = np.unwrap(self.uv[:, axis], period=self.end[axis] - self.start[axis])
            # In a pole the foot is anywhere on what is a point there.
            speeds = np.stack([uses.speed_u[row], uses.speed_v[row]], axis=1)
            told = np.where(speeds > _POLE * self.speeds, self.uv, np.nan)
            self.low, self.high = np.nanmin(told, axis=0), np.nanmax(told, axis=0)
        # The way into the face lies to the left of the way of the edge; both are turned over by a reversal.
        turned = bool(uses.reversed[row]) != bool(graph.faces.reversed[face])
        u, v = uses.uv_slope[row].sum(axis=0) * (-1 if turned else 1)
        self.inwards = np.array([-v, u])

    def named(self, across: int) -> tuple[EdgeName, float]:
        """Return the name of a line on which parameter number `across` is constant, and how far the edge is off it."""
        along = 1 - across
        value = self._within_range((self.low[across] + self.high[across]) / 2, across)
        end = 0 if self.inwards[across] > 0 else 1
        border = np.abs(value - np.array([self.start[across], self.end[across]])) <= self.within[across]
        at = None
        if border.any():
            # Beside a seam the face tells which of its two sides is meant.
            end = end if border[end] or self.closed[across] else 1 - end
            value = (self.start, self.end)[end][across]
        else:
            at = self._own(value, across)
        part = self._part(along)
        name = EdgeName(cast(Literal["u", "v"], "uv"[across]), cast(Literal[0, 1], end), at, part)
        line = np.full(len(self.uv), at if at is not None else self.surface.domain[across][end])
        samples = np.array([self._own(self._within_range(x, along), along) for x in self.uv[:, along]])
        off = float(np.linalg.norm(self._evaluated(across, line, samples) - self.points, axis=1).max())
        hull = float(max(self.high[across] - value, value - self.low[across]) * self.speeds[across])
        return name, max(off, hull if not self.closed[across] else 0.0)

    def _part(self, along: int) -> tuple[float, float] | None:
        """Return the range along the line in the surface's own parameter; None where it is the whole one."""
        start, end, within = self.start[along], self.end[along], self.within[along]
        low, high = self.low[along], self.high[along]
        if high - low >= end - start - within:
            return None
        turn = self._within_range(low, along) - low
        low, high = low + turn, high + turn
        if self.closed[along] and low >= end - within:
            low, high = low - (end - start), high - (end - start)
        first, last = self.surface.domain[along]
        own_low = first if low <= start + within else self._own(low, along)
        if high <= end + within:
            return own_low, last if high >= end - within else self._own(high, along)
        # Across the seam parameters go on.
        return own_low, self._own(high - (end - start), along) + (last - first)

    def _within_range(self, value: float, axis: int) -> float:
        """Return a parameter of a closed direction brought back into its range."""
        start, end, within = self.start[axis], self.end[axis], self.within[axis]
        if self.closed[axis] and not start - within <= value <= end + within:
            return float(start + (value - start) % (end - start))
        return float(value)

    def _own(self, value: float, axis: int) -> float:
        """Return the surface's own parameter."""
        first, last = self.surface.domain[axis]
        breaks = self.surface.breakpoints[axis]
        shifted = np.array([value - self.start[axis] + first if self.start[axis] != first else value])
        return float(np.clip(converted_parameters(self.kinds[axis], breaks, shifted), first, last)[0])

    def _evaluated(self, across: int, line: FloatArray, along: FloatArray) -> FloatArray:
        return self.surface.evaluate(*((line, along) if across == 0 else (along, line)))


def _is_closed(surface: Surface, axis: int, tolerance: float) -> bool:
    """Tell whether both ends of a direction are one curve."""
    breaks = surface.breakpoints[1 - axis]
    places = np.unique(np.concatenate([breaks, (breaks[1:] + breaks[:-1]) / 2]))
    ends = np.array(surface.domain[axis])
    grid = surface.evaluate_grid(*((ends, places) if axis == 0 else (places, ends)))
    first, last = (grid[0], grid[1]) if axis == 0 else (grid[:, 0], grid[:, 1])
    return bool(np.linalg.norm(first - last, axis=1).max() <= tolerance)
