"""Bases that have one tangent plane at a knot line of their own, but no rows that share a jump: closed exactly.

Near the line R_v after it is s(w) R_v + r(w) R_w + c(w) R before it (homogeneous; c is 0 without weights). Contact is
exact for any reparametrisation X(u, v) = lambda(u, v) R(w(u, v), v + q(u, v)). At the line w = u, q = 0 and lambda = 1
stay; slopes of w, q and lambda along v after it, chosen by these series, make X and its derivatives by u C1 there. They
fade out within the span after the line.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.knot_lines import knot_lines
from semispline.solver.blending.reparametrisation import (
    Reparametrisation,
    bezier_derivatives,
    bezier_points,
    chebyshev_places,
    composed,
    elevation,
)
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.blending.weights import end_derivatives, rows_from_derivatives
from semispline.solver.splines import Basis, affine_knots

# What is left of the jump of the derivatives along v, relative to them, where tangent planes are one.
_TOLERANCE = 1e-8
# The smoothness along v that blends have inside.
_INNER_ORDER = 2


@dataclass(frozen=True, eq=False)
class Series:
    """R_v after a line by what there is before it: s, r and c as derivatives by w, each of shape (order + 1,)."""

    v: float
    speed: FloatArray
    across: FloatArray
    slope: FloatArray


def line_series(jets: FloatArray, along: Basis, *, closed: bool = False) -> tuple[Series, ...] | None:
    """Return the series of each line that is not C1, the seam last; None where the base is creased at one.

    Parameters
    ----------
    jets : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
        Derivatives across at the edge, control points along.
    along : Basis
    closed : bool
    """
    per_width = float(np.abs(jets[1]).max() / np.ptp(jets[0], axis=0).max())
    found = []
    for line in knot_lines(jets, along, 1, closed=closed):
        if line.continuity >= 1:
            continue
        series = _series(line.v, line.before, line.after[1], per_width) if line.continuity == 0 else None
        if series is None:
            return None
        found.append(series)
    return tuple(found)


def _series(v: float, before: FloatArray, after: FloatArray, per_width: float) -> Series | None:
    """Solve for s, r and c order by order.

    `before` are R and R_v, `after` R_v, each of shape (order + 1, d); `per_width` is |R_w| by the size of the edge.
    """
    place, speed = before
    order, d = len(place) - 1, place.shape[1]
    s, r, c = np.zeros((3, order + 1))
    for j in range(order + 1):
        rest = after[j].copy()
        for i in range(j):
            rest -= comb(j, i) * (s[i] * speed[j - i] + r[i] * place[min(j - i + 1, order)] + c[i] * place[j - i])
        # The edge itself has one tangent: it does not turn towards the base.
        columns = {"s": speed[0]} | ({"r": place[1]} if j else {}) | ({"c": place[0]} if d == 4 else {})
        sizes = [float(np.linalg.norm(column)) or 1.0 for column in columns.values()]
        matrix = np.column_stack([column / size for column, size in zip(columns.values(), sizes, strict=True)])
        solved = np.linalg.lstsq(matrix, rest, rcond=None)[0]
        for (name, _), value, size in zip(columns.items(), solved, sizes, strict=True):
            {"s": s, "r": r, "c": c}[name][j] = value / size
        # Derivatives across may vanish: then those of an edge as long as the base is wide are what they add to.
        scale = max(np.abs(after[j]).max(), np.abs(speed[j]).max(), np.abs(speed[0]).max() * per_width**j)
        if np.abs(rest - matrix @ solved).max() > _TOLERANCE * scale:
            return None
    return Series(v, s, r, c) if s[0] > 0 else None


def closed_lines(
    rows: FloatArray, along: Basis, degree: int, spans: tuple[float, ...], *, closed: bool = False
) -> tuple[FloatArray, Basis, int] | None:
    """Return rows that are C1 at all lines and in exact contact with the base; None where the base is creased.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
        From the edge inwards; homogeneous where they have four columns. Order 1 at least.
    along : Basis
    degree : int
        Of the base, across.
    spans : tuple of float
        Distances from the edge to the next knots across.
    closed : bool

    Returns
    -------
    rows : ndarray, shape (order + 1, n', d)
    along : Basis
        Over the same domain, of a degree that is higher by 2 to 4 for each order.
    degree : int
        Of the new rows, across.
    """
    order = len(rows) - 1
    if order == 0:
        return None
    centre = _middle(rows)
    jets = np.einsum("dk,knc->dnc", end_derivatives(order, degree, spans), _moved(rows, -centre))
    found = line_series(jets, along, closed=closed)
    # None where it is creased; empty where rounding alone made a line.
    if not found:
        return None
    seam = float(along.knots[0])
    inner = [series for series in found if series.v > seam]
    if closed and abs(np.prod([series.speed[0] for series in found]) - 1) > _TOLERANCE:
        return None
    factors = np.cumprod([1.0, *(series.speed[0] for series in inner)])
    cuts = np.array([seam, *(series.v for series in inner), float(along.knots[-1])])
    fades = {series.v: _fade(series, factors[k + 1]) for k, series in enumerate(inner)}
    fades |= {series.v: _fade(series, 1.0) for series in found if series.v == seam}
    bent = _bent(jets, along, cuts, factors, fades, closed=closed)
    if bent is None:
        return None
    new, basis = bent
    across = max(degree, order)
    new = np.einsum("kd,dnc->knc", rows_from_derivatives(order, across, spans), new)
    return _moved(new, centre), Basis(basis.degree, affine_knots(basis.knots, cuts[0], cuts[-1])), across


def _middle(rows: FloatArray) -> FloatArray:
    points = rows[..., :3] / rows[..., 3:] if rows.shape[-1] == 4 else rows
    return np.asarray((points.min(axis=(0, 1)) + points.max(axis=(0, 1))) / 2)


def _moved(rows: FloatArray, by: FloatArray) -> FloatArray:
    if rows.shape[-1] == 3:
        return np.asarray(rows + by)
    return np.concatenate([rows[..., :3] + rows[..., 3:] * by, rows[..., 3:]], axis=-1)


def _fade(series: Series, factor: float) -> FloatArray:
    """Return the slopes after the line of lambda, w and q by u, shape (3, order + 1), in a parameter with one speed.

    There R_v after the line is (s R_v + r R_w + c R) / s_0 before it; with (1 + q_v) s / s_0 = 1 the rest follows.
    """
    order = len(series.speed) - 1
    ratio, inverse = series.speed / series.speed[0], np.zeros(order + 1)
    inverse[0] = 1.0
    for j in range(1, order + 1):
        inverse[j] = -sum(comb(j, i) * ratio[i] * inverse[j - i] for i in range(1, j + 1))
    slopes = np.zeros((3, order + 1))
    for j in range(order + 1):
        for row, values in ((0, series.slope), (1, series.across)):
            slopes[row, j] = -sum(comb(j, i) * values[i] * inverse[j - i] for i in range(j + 1)) / factor
    slopes[2, 1:] = inverse[1:]
    return slopes


def _bent(
    jets: FloatArray,
    along: Basis,
    cuts: FloatArray,
    factors: FloatArray,
    fades: dict[float, FloatArray],
    *,
    closed: bool,
) -> tuple[FloatArray, Basis] | None:
    """Return the derivatives of X by u, with spans scaled by `factors` between the cuts; None where X would fold."""
    order, q = len(jets) - 1, along.degree
    breaks, pieces = bezier_pieces(jets, along)
    widths = np.diff(breaks) * factors[np.searchsorted(cuts, breaks[:-1], side="right") - 1]
    new = breaks[0] + np.concatenate([[0.0], np.cumsum(widths)])
    zeros = {v: _zeros(v, breaks, cuts, closed=closed) for v in fades}
    raised = max(zeros.values()) + 1
    has_weights = any(fade[0, 0] for fade in fades.values())
    degree = q + (order + has_weights) * raised
    points, raise_degree = [], elevation(q, degree)
    for v, width, piece in zip(breaks[:-1].tolist(), widths.tolist(), pieces, strict=True):
        if v not in fades:
            points.append(np.asarray(raise_degree @ piece))
            continue
        t = chebyshev_places(degree + 1)
        bump = width * t * (1 - t) ** zeros[v]
        if min((1 + fades[v][0, 0] * bump).min(), (1 + fades[v][1, 1] * bump).min()) <= 0:
            return None
        by = fades[v][:, :, None] * bump
        by[0, 0] += 1.0
        by[1, 1] += 1.0
        points.append(bezier_points(composed(bezier_derivatives(piece, width, t, order), Reparametrisation.of(by))))
    smooth = [1 if v in fades else min(q - int(np.sum(along.knots == v)), _INNER_ORDER) for v in breaks[1:-1].tolist()]
    return joined_spans(points, new, smooth)


def _zeros(v: float, breaks: FloatArray, cuts: FloatArray, *, closed: bool) -> int:
    """Return how often what begins at the line has to vanish at the end of its span: 1 at a free end.

    The next line wants no slope before it, a knot of a smooth base no second derivative.
    """
    after = float(breaks[np.searchsorted(breaks, v) + 1])
    if after == breaks[-1]:
        return 2 if closed else 1
    return 2 if after in cuts else 3
