"""A free edge of a face, as a file has it: what a contact that is made along it is measured against."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.spatial import KDTree

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.de_boor import surface_points
from semispline.solver.splines import BSplineCurve, BSplineSurface

# Points of the edge, in all and in a span, from the nearest of which another one is sought by so many steps.
_NODES, _PER_SPAN, _STEPS = 2000, 8, 8

# Ends nearer than this fraction of the extent are one point.
_SAME_POINT = 1e-6


@dataclass(frozen=True, eq=False)
class FreeEdge:
    """An edge of a face along which no parameter is constant.

    Parameters
    ----------
    face : BSplineSurface
        Rational too; untrimmed.
    curve : BSplineCurve
        The edge in space, or in the plane z = 0 a curve (s, t) in the face's parameters.
    in_space : bool
        Which of the two `curve` is.
    keep : {"left", "right"}
        The side of the edge, looked at against S_u x S_v, on which the face lies.
    """

    face: BSplineSurface
    curve: BSplineCurve
    in_space: bool
    keep: Literal["left", "right"]

    def moved(self, step: FloatArray) -> FreeEdge:
        """Return the same elsewhere."""
        face = replace(self.face, control_points=self.face.control_points + step)
        if not self.in_space:
            return replace(self, face=face)
        return replace(self, face=face, curve=replace(self.curve, control_points=self.curve.control_points + step))

    @property
    def length(self) -> float:
        """Model units, as that of chords."""
        points = self.at(self._nodes())[0]
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())

    def nearest(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the points of the edge nearest to others, and its derivatives there, shapes (K, 3)."""
        nodes = self._nodes()
        start, end = float(nodes[0]), float(nodes[-1])
        places = self.at(nodes)[0]
        closed = np.linalg.norm(places[0] - places[-1]) <= _SAME_POINT * np.ptp(places, axis=0).max()
        x = nodes[KDTree(places).query(points)[1]]
        here, slope = self.at(x)
        for _ in range(_STEPS):
            step = np.sum((points - here) * slope, axis=1) / np.maximum(np.sum(slope**2, axis=1), 1e-300)
            tried = start + np.mod(x + step - start, end - start) if closed else np.clip(x + step, start, end)
            there, steeper = self.at(tried)
            closer = np.linalg.norm(points - there, axis=1) < np.linalg.norm(points - here, axis=1)
            x = np.where(closer, tried, x)
            here, slope = np.where(closer[:, None], there, here), np.where(closer[:, None], steeper, slope)
        return here, slope

    def _nodes(self) -> FloatArray:
        breaks = np.unique(self.curve.knots)
        count = max(_PER_SPAN, -(-_NODES // (len(breaks) - 1)))
        inside = breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(count) / count)
        return np.append(inside.ravel(), breaks[-1])

    def at(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return points in space and derivatives, shapes (K, 3)."""
        point, slope = self.curve.evaluate(x), self.curve.evaluate(x, 1)
        if self.in_space:
            return point, slope
        (u0, u1), (v0, v1) = self.face.domain
        # A curve may run on over the seam of a closed face, and miss its border by rounding.
        u, v = (
            np.where((t < low) | (t > high), low + np.mod(t - low, high - low), t) if _is_over(t, low, high)
            else np.clip(t, low, high)
            for t, low, high in ((point[:, 0], u0, u1), (point[:, 1], v0, v1))
        )  # fmt: skip
        s, t = surface_points(self.face, u, v, 1, 0), surface_points(self.face, u, v, 0, 1)
        return surface_points(self.face, u, v), s * slope[:, :1] + t * slope[:, 1:2]


def _is_over(t: FloatArray, low: float, high: float) -> bool:
    return bool(t.min() < low - 1e-5 * (high - low) or t.max() > high + 1e-5 * (high - low))
