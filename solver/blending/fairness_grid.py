"""Where a blend is measured, and the values of its bases there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import (
    Basis,
    breakpoints,
    derivative_points,
    first_on_spans,
    gauss_rule,
    local_bases,
    merge_breakpoints,
)

# Nodes in u altogether, and in v on each span and altogether, at least.
NODES_U, NODES_V, LEAST_V = 40, 2, 10
# For a rough look: in u altogether, and in v spans at most, whatever the knots, and nodes at least.
ROUGH_U, _ROUGH_SPANS, _ROUGH_LEAST_V = NODES_U // 2, 6, 6
# Contact of third and fourth order leaves less room between, where the surface then bends.
HIGH_ORDER_NODES_U = 48
# Orders of derivatives by u that go with each order by v, and the highest of either.
ORDERS_U = ((1, 2, 3), (0, 1, 2), (0, 1), (0,))
HIGHEST = 3


@dataclass(frozen=True, eq=False)
class Along:
    """Nodes of the sections v, spans last, and the lines across which H may jump.

    Attributes
    ----------
    nodes, weights : ndarray, shape (G, S)
    breaks : ndarray, shape (S + 1,)
    lines : ndarray, shape (L,)
    """

    nodes: FloatArray
    weights: FloatArray
    breaks: FloatArray
    lines: FloatArray


@dataclass(frozen=True, eq=False)
class Across:
    """Nodes in u, and the basis functions of U there.

    Attributes
    ----------
    weights : ndarray, shape (G,)
    bases : tuple of ndarray
        For each order by v, derivatives of the orders by u that go with it, one below the other.
    ends : ndarray, shape (2, n)
        First derivatives at both ends.
    """

    weights: FloatArray
    bases: tuple[FloatArray, ...]
    ends: FloatArray


def along(rows: tuple[Basis, ...], times: int = 1) -> Along:
    """Return the nodes in v, `times` as many."""
    breaks = merge_breakpoints(*(breakpoints(row.knots) for row in rows))
    each = max(NODES_V, -(-LEAST_V // (len(breaks) - 1))) * times
    # n points are exact to degree 2 n - 1.
    return Along(*gauss_rule(breaks, 2 * each - 1), breaks, _lines(rows))


def rough_along(rows: tuple[Basis, ...]) -> Along:
    """Return few nodes in v, for a rough look: without regard to knots where these are many, and to lines."""
    breaks = merge_breakpoints(*(breakpoints(row.knots) for row in rows))
    if len(breaks) - 1 > _ROUGH_SPANS:
        breaks = breaks[0] + (breaks[-1] - breaks[0]) * np.arange(_ROUGH_SPANS + 1) / _ROUGH_SPANS
    each = max(NODES_V, -(-_ROUGH_LEAST_V // (len(breaks) - 1)))
    return Along(*gauss_rule(breaks, 2 * each - 1), breaks, np.zeros(0))


def _lines(rows: tuple[Basis, ...]) -> FloatArray:
    """Return the inner knots where some row is C1 or less."""
    found = []
    for row in rows:
        values, counts = np.unique(row.knots[row.degree + 1 : -row.degree - 1], return_counts=True)
        found.append(values[row.degree - counts <= 1])
    return np.unique(np.concatenate(found))


def across(u: Basis, nodes: int) -> Across:
    """Return Gauss nodes in u, at least so many altogether; problems of one size share them."""
    return _across(u.degree, u.knots.tobytes(), nodes)


@lru_cache(maxsize=64)
def _across(degree: int, buffer: bytes, nodes: int) -> Across:
    basis = Basis(degree, np.frombuffer(buffer))
    breaks = breakpoints(basis.knots)
    each = -(-nodes // (len(breaks) - 1))
    u, weights = gauss_rule(breaks, 2 * each - 1)
    identity = np.eye(basis.size)
    tables = [table.T for table in _values(basis, identity, u, first_on_spans(basis, breaks))]
    ends = basis.knots[[0, -1]][None]
    at_ends = _values(basis, identity, ends, first_on_spans(basis, breaks)[[0, -1]])[1].T
    bases = tuple(np.ascontiguousarray(np.concatenate([tables[i] for i in orders])) for orders in ORDERS_U)
    for table in (*bases, at_ends):
        table.setflags(write=False)
    return Across(weights.T.ravel(), bases, at_ends)


def derivatives_along(points: list[FloatArray], rows: tuple[Basis, ...], v: Along) -> FloatArray:
    """Return derivatives of order 0..3 by v of rows of control points, at the nodes and then on both sides of lines.

    Parameters
    ----------
    points : list of ndarray, each of shape (C, n_i)
        For each row.

    Returns
    -------
    ndarray, shape (4, C, rows, nodes + 2 lines)
        The limits from below stand before those from above.
    """
    count = v.nodes.size
    result = np.zeros((HIGHEST + 1, len(points[0]), len(rows), count + 2 * len(v.lines)))
    done: dict[tuple[int, bytes], list[int]] = {}
    for i, row in enumerate(rows):
        done.setdefault((row.degree, row.knots.tobytes()), []).append(i)
    for same in done.values():
        row = rows[same[0]]
        together = np.concatenate([points[i] for i in same])
        shape = len(same), len(points[0])
        values = _values(row, together, v.nodes, first_on_spans(row, v.breaks))
        result[:, :, same, :count] = values.reshape(HIGHEST + 1, *shape, -1).swapaxes(1, 2)
        if len(v.lines):
            spans = np.searchsorted(row.knots, v.lines, "left"), np.searchsorted(row.knots, v.lines, "right")
            for k, span in enumerate(spans):
                values = _values(row, together, v.lines[None], span - 1 - row.degree)
                part = slice(count + k * len(v.lines), count + (k + 1) * len(v.lines))
                result[:, :, same, part] = values.reshape(HIGHEST + 1, *shape, -1).swapaxes(1, 2)
    return result


def _values(basis: Basis, points: FloatArray, x: FloatArray, first: NDArray[np.intp]) -> FloatArray:
    """Return derivatives of order 0..3 of curves, control points of shape (C, n): shape (4, C, nodes), span by span."""
    lower = local_bases(basis, x, first, HIGHEST)
    result = np.zeros((HIGHEST + 1, len(points), x.size))
    for order, values in enumerate(lower):
        if order:
            points = derivative_points(
                basis.degree - order + 1, basis.knots[order - 1 : len(basis.knots) - order + 1], points.T
            ).T
        local = points[:, first + np.arange(len(values))[:, None]]
        result[order] = np.einsum("kgs,cks->csg", values, local).reshape(len(points), -1)
    return result
