"""Where a blend is measured, and the values of its bases there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import (
    MERGE_TOLERANCE,
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
# A span that belongs to a cluster of knots is below this fraction of the mean span. Within what is too wide for one
# cluster narrower ones are looked for.
_FRACTION = 1 / 20
_FINER_CLUSTERS = 0.1 ** np.arange(9)
# Orders of derivatives by u that go with each order by v, and the highest of either.
ORDERS_U = ((1, 2, 3), (0, 1, 2), (0, 1), (0,))
HIGHEST = 3


@dataclass(frozen=True, eq=False)
class Along:
    """Nodes of the sections v, spans last, and the lines across which H may jump.

    Attributes
    ----------
    nodes, weights : ndarray, shape (G, S)
    places : ndarray, shape (S,)
        In each span one that tells which polynomials are meant.
    lines, line_places : ndarray, shape (2, L)
        Just below and just above each line, apart where it stands for a cluster of knots; and places as above.
    """

    nodes: FloatArray
    weights: FloatArray
    places: FloatArray
    lines: FloatArray
    line_places: FloatArray


@dataclass(frozen=True, eq=False)
class Across:
    """Nodes in u, and the basis functions of U there.

    Attributes
    ----------
    weights : ndarray, shape (G,)
    bases : tuple of ndarray
        For each order by v, derivatives of the orders by u that go with it, one below the other.
    values : ndarray, shape (G, n)
        The basis functions themselves.
    ends : ndarray, shape (2, n)
        First derivatives at both ends.
    """

    weights: FloatArray
    bases: tuple[FloatArray, ...]
    values: FloatArray
    ends: FloatArray


def along(rows: tuple[Basis, ...], times: int = 1, narrow: float = 0.0, *, seam: bool = False) -> Along:
    """Return the nodes in v, `times` as many; clusters of knots below the width `narrow` count as one line.

    `seam` says that the surface closes along v, and that H may jump where it does.
    """
    breaks = merge_breakpoints(*(breakpoints(row.knots) for row in rows))
    kept = _kept(breaks, narrow)
    each = max(NODES_V, -(-LEAST_V // len(kept))) * times
    # n points are exact to degree 2 n - 1.
    nodes, weights = gauss_rule(breaks, 2 * each - 1)
    places = (breaks[kept] + breaks[kept + 1]) / 2
    # The last line is the seam.
    below, above = breaks[kept + 1], np.roll(breaks[kept], -1)
    lines = np.append(_are_lines(rows, below[:-1], above[:-1]), seam)
    return Along(
        nodes[:, kept],
        weights[:, kept],
        places,
        np.stack([below[lines], above[lines]]),
        np.stack([places[lines], np.roll(places, -1)[lines]]),
    )


def rough_along(rows: tuple[Basis, ...], narrow: float = 0.0) -> Along:
    """Return few nodes in v, for a rough look: without regard to knots where these are many, and to lines."""
    breaks = merge_breakpoints(*(breakpoints(row.knots) for row in rows))
    kept = _kept(breaks, narrow)
    places = (breaks[kept] + breaks[kept + 1]) / 2
    if len(kept) > _ROUGH_SPANS:
        starts = breaks[kept]
        breaks = breaks[0] + (breaks[-1] - breaks[0]) * np.arange(_ROUGH_SPANS + 1) / _ROUGH_SPANS
        kept = np.arange(_ROUGH_SPANS)
        # Of the span that holds the middle, or else of the one before.
        places = places[np.maximum(np.searchsorted(starts, (breaks[:-1] + breaks[1:]) / 2, "right") - 1, 0)]
    nodes, weights = gauss_rule(breaks, 2 * max(NODES_V, -(-_ROUGH_LEAST_V // len(kept))) - 1)
    return Along(nodes[:, kept], weights[:, kept], places, np.zeros((2, 0)), np.zeros((2, 0)))


def _kept(breaks: FloatArray, narrow: float) -> NDArray[np.intp]:
    """Return the indices of the spans that are no part of a cluster of knots."""
    widths = np.diff(breaks)
    dropped = np.zeros(len(widths), dtype=bool)
    # Where narrow spans follow each other too far to be one cluster, there may be clusters among them.
    for limit in min(narrow, _FRACTION * float(widths.mean())) * _FINER_CLUSTERS:
        runs = np.flatnonzero(np.diff(np.concatenate([[False], widths < limit, [False]]))).reshape(-1, 2)
        for first, last in runs:
            dropped[first:last] |= bool(breaks[last] - breaks[first] < narrow)
    return np.flatnonzero(~dropped)


def _are_lines(rows: tuple[Basis, ...], below: FloatArray, above: FloatArray) -> NDArray[np.bool_]:
    """Tell which are clusters, or knots where some row is C1 or less; these may differ by rounding."""
    off = MERGE_TOLERANCE * float(rows[0].knots[-1] - rows[0].knots[0])
    result = above > below
    for row in rows:
        count = np.searchsorted(row.knots, above + off, "right") - np.searchsorted(row.knots, below - off, "left")
        result |= (count > 0) & (row.degree - count <= 1)
    return np.asarray(result)


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
    values = np.ascontiguousarray(tables[0])
    for table in (*bases, values, at_ends):
        table.setflags(write=False)
    return Across(weights.T.ravel(), bases, values, at_ends)


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
    count, lines = v.nodes.size, v.lines.shape[1]
    result = np.zeros((HIGHEST + 1, len(points[0]), len(rows), count + 2 * lines))
    done: dict[tuple[int, bytes], list[int]] = {}
    for i, row in enumerate(rows):
        done.setdefault((row.degree, row.knots.tobytes()), []).append(i)
    for same in done.values():
        row = rows[same[0]]
        together = np.concatenate([points[i] for i in same])
        shape = len(same), len(points[0])
        values = _values(row, together, v.nodes, _first(row, v.places))
        result[:, :, same, :count] = values.reshape(HIGHEST + 1, *shape, -1).swapaxes(1, 2)
        if lines:
            values = _values(row, together, v.lines.reshape(1, -1), _first(row, v.line_places.ravel()))
            result[:, :, same, count:] = values.reshape(HIGHEST + 1, *shape, -1).swapaxes(1, 2)
    return result


def _first(basis: Basis, places: FloatArray) -> NDArray[np.intp]:
    """Return the index of the first basis function that lives at each place."""
    return np.searchsorted(basis.knots, places, "right") - 1 - basis.degree


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
