"""What rows do at their inner knots and at the seam: derivatives from both sides, in homogeneous coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.spans import bezier_pieces
from semispline.solver.splines import Basis

# Derivatives from both sides that differ by less than this, relative to the largest, count as equal.
LINE_TOLERANCE = 1e-9
# Roundings of control points, in units of the spacing of floats, that may part both sides.
_ROUNDINGS = 16


@dataclass(frozen=True, eq=False)
class KnotLine:
    """Derivatives of all rows along v, from both sides of a knot line.

    Attributes
    ----------
    v : float
        The knot; the start of the domain for the seam of closed rows, whose end is before it.
    before, after : ndarray, shape (order + 1, K, d)
    rounding : ndarray, shape (order + 1,)
        What the rounding of control points may make of each derivative.
    sure : int
        How many derivatives agree by the multiplicity of the knot alone.
    """

    v: float
    before: FloatArray
    after: FloatArray
    rounding: FloatArray
    sure: int

    @property
    def continuity(self) -> int:
        """How many derivatives agree, -1 where the rows themselves do not; at most the order that was asked for."""
        for d in range(self.sure + 1, len(self.before)):
            one, other = self.before[d], self.after[d]
            allowed = LINE_TOLERANCE * max(np.abs(one).max(), np.abs(other).max()) + self.rounding[d]
            if np.abs(one - other).max() > allowed:
                return d - 1
        return len(self.before) - 1


def knot_lines(
    rows: FloatArray, along: Basis, order: int, *, closed: bool = False, largest: float = 0.0
) -> tuple[KnotLine, ...]:
    """Return derivatives of order 0..order at each inner knot, and at the seam where the rows are closed, that last.

    Parameters
    ----------
    rows : ndarray, shape (K, n, d)
    along : Basis
    order : int
    closed : bool
    largest : float
        Largest coordinate that the rows were given in, where it is not theirs: their rounding goes with it.

    Examples
    --------
    >>> kink = np.array([[[0.0], [1.0], [3.0]]])
    >>> line = knot_lines(kink, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1)[0]
    >>> line.v, line.before.ravel().tolist(), line.after.ravel().tolist(), line.continuity
    (1.0, [1.0, 1.0], [1.0, 2.0], 0)
    """
    breaks, pieces = bezier_pieces(rows, along)
    widths, q = np.diff(breaks), along.degree
    starts, ends, growth = [], [], []
    level, factor = pieces, 1.0
    for d in range(order + 1):
        if d > q:
            level = np.zeros_like(pieces)
        scale = factor / widths**d
        starts.append(level[:, :, 0] * scale[:, None, None])
        ends.append(level[:, :, -1] * scale[:, None, None])
        growth.append(2**d * scale)
        level, factor = np.diff(level, axis=2), factor * (q - d)
    before, after = np.stack(ends, axis=1), np.stack(starts, axis=1)
    unit = _ROUNDINGS * float(np.finfo(float).eps) * max(largest, float(np.abs(rows).max()))
    rounding = unit * np.abs(growth).T
    lines = []
    for k in range(1, len(breaks) - 1):
        sure = q - int(np.sum(along.knots == breaks[k]))
        worst = np.maximum(rounding[k - 1], rounding[k])
        lines.append(KnotLine(float(breaks[k]), before[k - 1], after[k], worst, sure))
    if closed:
        worst = np.maximum(rounding[-1], rounding[0])
        lines.append(KnotLine(float(breaks[0]), before[-1], after[0], worst, -1))
    return tuple(lines)
