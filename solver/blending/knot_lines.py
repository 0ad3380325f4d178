"""What rows do at their inner knots and at the seam: derivatives from both sides, in homogeneous coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Basis, refinement_matrix

# Derivatives from both sides that differ by less than this, relative to the largest, count as equal.
LINE_TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class KnotLine:
    """Derivatives of all rows along v, from both sides of a knot line.

    Attributes
    ----------
    v : float
        The knot; the start of the domain for the seam of closed rows, whose end is before it.
    before, after : ndarray, shape (order + 1, K, d)
    """

    v: float
    before: FloatArray
    after: FloatArray

    @property
    def continuity(self) -> int:
        """How many derivatives agree, -1 where the rows themselves do not; at most the order that was asked for."""
        for d, (one, other) in enumerate(zip(self.before, self.after, strict=True)):
            if np.abs(one - other).max() > LINE_TOLERANCE * max(np.abs(one).max(), np.abs(other).max()):
                return d - 1
        return len(self.before) - 1


def bezier_pieces(rows: FloatArray, along: Basis) -> tuple[FloatArray, FloatArray]:
    """Return the distinct knots, shape (S + 1,), and Bezier points of each span, shape (S, K, degree + 1, d)."""
    q = along.degree
    breaks = np.unique(along.knots)
    full = np.concatenate([breaks[[0]], np.repeat(breaks, q), breaks[[-1]]])
    matrix = refinement_matrix(q, along.knots, full)
    points = np.asarray([matrix @ row for row in rows])
    return breaks, np.stack([points[:, k * q : k * q + q + 1] for k in range(len(breaks) - 1)])


def knot_lines(rows: FloatArray, along: Basis, order: int, *, closed: bool = False) -> tuple[KnotLine, ...]:
    """Return derivatives of order 0..order at each inner knot, and at the seam where the rows are closed, that last.

    Parameters
    ----------
    rows : ndarray, shape (K, n, d)
    along : Basis
    order : int
    closed : bool

    Examples
    --------
    >>> kink = np.array([[[0.0], [1.0], [3.0]]])
    >>> line = knot_lines(kink, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1)[0]
    >>> line.v, line.before.ravel().tolist(), line.after.ravel().tolist(), line.continuity
    (1.0, [1.0, 1.0], [1.0, 2.0], 0)
    """
    breaks, pieces = bezier_pieces(rows, along)
    widths = np.diff(breaks)
    starts, ends = [], []
    level, factor = pieces, 1.0
    for d in range(order + 1):
        if d > along.degree:
            level = np.zeros_like(pieces)
        scale = (factor / widths**d)[:, None, None]
        starts.append(level[:, :, 0] * scale)
        ends.append(level[:, :, -1] * scale)
        level, factor = np.diff(level, axis=2), factor * (along.degree - d)
    before, after = np.stack(ends, axis=1), np.stack(starts, axis=1)
    lines = [KnotLine(float(breaks[k]), before[k - 1], after[k]) for k in range(1, len(breaks) - 1)]
    if closed:
        lines.append(KnotLine(float(breaks[0]), before[-1], after[0]))
    return tuple(lines)


def least_continuity(rows: FloatArray, along: Basis, *, closed: bool = False) -> int:
    """Return how many derivatives of the homogeneous rows agree across every knot line, the degree where all do."""
    lines = knot_lines(rows, along, along.degree, closed=closed)
    return min((line.continuity for line in lines), default=along.degree)
