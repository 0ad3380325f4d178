"""How a base goes on from the end of a finished surface, in parameters that go on from it, too."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.judge.base import Base
from semispline.solver.judge.bezier_pieces import in_pieces
from semispline.solver.judge.foot_points import FootMap, Run, foot_map
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, extent, lengths
from semispline.solver.splines import merge_breakpoints

# How far apart the edges may be, as a fraction of their extent: contact that was made is far better; and how many
# roundings of their coordinates.
_APART, _ROUNDINGS = 1e-6, 256
_SAMPLES, _NEWTON_STEPS, _TRIED = 512, 20, 17


@dataclass(frozen=True, eq=False)
class Continuation:
    """A base as Q(w, v): w >= 0 runs into it from its edge, v along the edge as on the surface that it continues.

    Attributes
    ----------
    base : Base
    v_breaks : ndarray
        Where the surface that is continued has its knots.
    flipped : bool
        The base's parameter along the edge runs against v.
    shift : float
        Where on a closed edge the start of v lies, beyond the edge's own start.
    surface : ParametricSurface
        That of the base, as it is evaluated.
    feet : FootMap or None
        Which v along the edge belongs to v on the surface that is continued, where both are one curve with two
        parametrisations; then derivatives along v are of first order.
    """

    base: Base
    v_breaks: FloatArray
    flipped: bool
    shift: float
    surface: ParametricSurface
    feet: FootMap | None = None

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of w and v."""
        start, end = self._across
        return (0.0, end - start), (float(self.v_breaks[0]), float(self.v_breaks[-1]))

    @property
    def breakpoints(self) -> tuple[FloatArray, FloatArray]:
        """The base's own in w; in v those of the surface that is continued."""
        breaks = self.base.surface.breakpoints[0 if self.base.side[0] == "u" else 1]
        return np.sort(breaks - breaks[0] if self._inwards > 0 else breaks[-1] - breaks), self.v_breaks

    def parameters(self, w: ArrayLike, v: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the base's own parameters u and v."""
        w, v = np.asarray(w, dtype=np.float64), np.asarray(v, dtype=np.float64)
        if self.feet is not None:
            v = self.feet.along_b(np.atleast_1d(v)).reshape(v.shape)
        return self._own(w, v)

    def _own(self, w: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the base's own parameters where v belongs to them affinely."""
        start, end = self._across
        across = np.clip((start if self._inwards > 0 else end) + self._inwards * w, start, end)
        first, last = self.base.range_along
        t = (v - self.v_breaks[0]) / (self.v_breaks[-1] - self.v_breaks[0])
        along = first + self.shift + (1 - t if self.flipped else t) * (last - first)
        # Only a closed edge is shifted.
        along = np.clip(np.where(along > last, along - (last - first), along) if self.shift else along, first, last)
        return (across, along) if self.base.side[0] == "u" else (along, across)

    def evaluate(self, w: ArrayLike, v: ArrayLike, dw: int = 0, dv: int = 0) -> FloatArray:
        """Return the point or a derivative at (w[k], v[k]), shape (K, 3)."""
        orders = (dw, dv) if self.base.side[0] == "u" else (dv, dw)
        return self._paced(self._rate(dw, dv) * self.surface.evaluate(*self.parameters(w, v), *orders), v, dv)

    def evaluate_grid(self, w: ArrayLike, v: ArrayLike, dw: int = 0, dv: int = 0) -> FloatArray:
        """Return the same on the grid w x v, shape (len(w), len(v), 3)."""
        own = self.parameters(w, v)
        if self.base.side[0] == "u":
            return self._paced(self._rate(dw, dv) * self.surface.evaluate_grid(*own, dw, dv), v, dv)
        return self._paced(self._rate(dw, dv) * self.surface.evaluate_grid(*own, dv, dw).transpose(1, 0, 2), v, dv)

    def edge_run(self) -> Run:
        """Return the base's edge, by v as it belongs to it affinely."""
        (start, end), (first, last) = (float(self.v_breaks[0]), float(self.v_breaks[-1])), self.base.range_along

        def at(v: FloatArray) -> tuple[FloatArray, FloatArray]:
            s = self._own(np.zeros_like(v), v)[1 if self.base.side[0] == "u" else 0]
            return self.base.derivative(s, 0, 0), self._rate(0, 1) * self.base.derivative(s, 0, 1)

        t = np.mod((self.base.breakpoints_along() - first - self.shift) / (last - first), 1.0)
        breaks = start + (1 - t if self.flipped else t) * (end - start)
        return Run(at, merge_breakpoints(np.array([start, end]), breaks))

    def _paced(self, values: FloatArray, v: ArrayLike, dv: int) -> FloatArray:
        """Return derivatives by v on the surface that is continued from those by v along the edge."""
        if self.feet is None or dv == 0:
            return values
        v = np.asarray(v, dtype=np.float64)
        return values * self.feet.pace(v, self.feet.along_b(v))[:, None]

    @property
    def _across(self) -> tuple[float, float]:
        return self.base.surface.domain[0 if self.base.side[0] == "u" else 1]

    @property
    def _inwards(self) -> int:
        return 1 if self.base.side[1] == "0" else -1

    def _rate(self, dw: int, dv: int) -> float:
        first, last = self.base.range_along
        along = (last - first) / (self.v_breaks[-1] - self.v_breaks[0]) * (-1 if self.flipped else 1)
        return float(self._inwards**dw * along**dv)


def continuation(surface: ParametricSurface, base: Base, end: int) -> Continuation:
    """Find how a base lies at the start (0) or at the end (1) of the surface's u.

    Raises
    ------
    EdgeError
        Its edge is not the surface's.
    """
    v_breaks = surface.breakpoints[1]
    v = np.linspace(v_breaks[0], v_breaks[-1], _TRIED)
    target = surface.evaluate_grid(np.array([surface.domain[0][end]]), v)[0]
    size = extent(target)
    closed = closed_directions(base.surface)[1 if base.side[0] == "u" else 0]
    closed = closed and extent(target[[0, -1]]) <= _APART * size
    shift = _nearest(base, target[0]) - base.range_along[0] if closed else 0.0
    pieces = in_pieces(base.surface)
    ways = [Continuation(base, v_breaks, flipped, shift, pieces) for flipped in (False, True)]

    distances = [float(lengths(way.evaluate_grid([0.0], v)[0] - target).max()) for way in ways]
    best = int(np.argmin(distances))
    most = _APART * size + _ROUNDINGS * np.finfo(np.float64).eps * float(np.abs(target).max())
    if distances[best] <= most:
        return ways[best]
    # By feet: the other direction may be nearer affinely all the same.
    for way in (ways[best], ways[1 - best]):
        feet = foot_map(_end_run(surface, end), way.edge_run(), most, closed)
        if feet is not None:
            return replace(way, feet=feet)
    raise EdgeError(
        f"base: its edge {base.edge} is {distances[best]:.3g} away from the surface's end u{end}, "
        "expected the edge that the surface was made for"
    )


def _end_run(surface: ParametricSurface, end: int) -> Run:
    """Return the surface's own edge at the start (0) or at the end (1) of its u."""
    u = np.array([surface.domain[0][end]])

    def at(v: FloatArray) -> tuple[FloatArray, FloatArray]:
        return surface.evaluate_grid(u, v)[0], surface.evaluate_grid(u, v, 0, 1)[0]

    return Run(at, surface.breakpoints[1])


def _nearest(base: Base, point: FloatArray) -> float:
    """Return the parameter along a closed edge that is nearest to a point."""
    first, last = base.range_along
    s = np.linspace(first, last, _SAMPLES, endpoint=False)
    at = float(s[int(np.linalg.norm(base.derivative(s, 0, 0) - point, axis=-1).argmin())])
    for _ in range(_NEWTON_STEPS):
        here = np.array([at])
        speed = base.derivative(here, 0, 1)[0]
        step = float((point - base.derivative(here, 0, 0)[0]) @ speed / (speed @ speed))
        at = first + (at + step - first) % (last - first)
        if abs(step) < 1e-15 * (last - first):
            break
    return at
