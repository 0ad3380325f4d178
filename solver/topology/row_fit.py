"""Rows of a band by weighted least squares: each equation is divided by its limit.

With the rows' errors e_k the limits are, to first order and with v the arc length, those of N.e_0 (gap), D.e_0 (off),
N.e_0' and N.e_1 (angle), N.e_2 (curvature across), N.e_1' (mixed), N.e_0'' (along).

Source: `semispline.derivations.bands`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np
import scipy.linalg

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import basis_matrix, clamped, derivative_matrix, restriction_matrix
from semispline.solver.topology.curve_pieces import CurvePiece
from semispline.solver.topology.face_jets import Sections, dot

# Slips along the curve do no harm: so many gaps are allowed; of the parts of R_1 in the tangent plane, and of those of
# higher rows over their largest height, so much.
_SLIP, _TANGENTIAL, _TANGENTIAL_HIGHER = 3.0, 0.02, 0.2

# One kind of equation: the derivative of the row, a direction at each point, the wanted value and the limit.
Equation = tuple[int, FloatArray, FloatArray, float]


@dataclass(frozen=True)
class BandLimits:
    """What a band may be off by.

    Attributes
    ----------
    gap, off : float
        Model units: from the face, and across the trim curve.
    angle_degrees : float
    curvature, rate : float
        Of the largest along the edge.
    """

    gap: float
    off: float
    angle_degrees: float
    curvature: float
    rate: float


@dataclass(frozen=True)
class Scales:
    """The largest values along the edge, with their floors: of |II|, of II(D, D), and of the heights h_3, h_4."""

    bend: float
    across: float
    rates: tuple[float, ...]


def scales(found: Sections, size: float) -> Scales:
    """Return the scales that relative limits refer to.

    Floors are 1e-3 / size for curvature, and for its rates 1e-3 / size^k and the same power of the largest |II|.
    """
    bend = max(float(np.nanmax(np.abs(found.bends))), 1e-3 / size)
    across = max(float(np.nanmax(np.abs(found.bends[2]))), 1e-3 / size)
    rates = tuple(
        max(float(np.nanmax(np.abs(height))), bend ** (k + 2), 1e-3 / size ** (k + 2))
        for k, height in enumerate(found.heights[1:])
    )
    return Scales(bend, across, rates)


def fitted_rows(
    piece: CurvePiece, degree: int, breaks: FloatArray, limits: BandLimits, of: Scales, order: int
) -> tuple[FloatArray, FloatArray]:
    """Return one knot vector and the control points of all rows, shape (order + 1, n, 3).

    Parameters
    ----------
    piece : CurvePiece
    degree : int
    breaks : ndarray
        Of the rows, in arc length; knots are simple.
    limits : BandLimits
    of : Scales
    order : int
        2 for G2.
    """
    knots = clamped(breaks[1:-1], degree, breaks[0], breaks[-1])
    nodes, _ = np.polynomial.legendre.leggauss(degree + 1)
    v = ((breaks[:-1] + breaks[1:]) / 2 + np.diff(breaks) / 2 * nodes[:, None]).T.ravel()
    inside = piece.sections(v, order)
    space = closed_space(degree, breaks) if piece.closed else None
    ends = None if piece.closed else piece.sections(breaks[[0, -1]], order)
    bases = [_basis(degree, knots, v, k) for k in range(3)]
    rows: list[FloatArray] = []
    for k in range(order + 1):
        fixed = None if ends is None else row_targets(ends, k)
        if k == 2:
            # N.R_2 = II(R_1, R_1): the tangential parts of R_1 are only near to those of D.
            inside = _with_direction(inside, bases[0] @ rows[1])
        rows.append(_solved(bases, _equations(inside, k, limits, of), fixed, space))
    return knots, np.stack(rows)


def row_targets(at: Sections, k: int) -> FloatArray:
    """Return R_k of the face itself: its point, D, and h_k N; shape (K, 3)."""
    if k < 2:
        return at.point if k == 0 else at.into
    return np.asarray(at.heights[k - 2][:, None] * at.normal)


def _with_direction(at: Sections, direction: FloatArray) -> Sections:
    """Return what is wanted of row 2 for a row 1 that is not quite D."""
    a, b = dot(direction, at.along), dot(direction, at.into)
    heights = np.array(at.heights)
    heights[0] = a**2 * at.bends[0] + 2 * a * b * at.bends[1] + b**2 * at.bends[2]
    return replace(at, heights=heights)


def _equations(at: Sections, k: int, limits: BandLimits, of: Scales) -> list[Equation]:
    """Return what row k must be."""
    angle, bend = radians(limits.angle_degrees), limits.curvature * of.bend
    target = row_targets(at, k)
    flat = np.zeros(len(target))
    parts = [(at.into, dot(target, at.into)), (at.along, dot(target, at.along))]
    height = dot(target, at.normal)
    if k == 0:
        return [
            (0, at.normal, height, limits.gap),
            (1, at.normal, flat, angle),
            (2, at.normal, at.bends[0], bend),
            (0, *parts[0], limits.off),
            (0, *parts[1], _SLIP * limits.gap),
        ]
    if k == 1:
        return [
            (0, at.normal, flat, angle),
            (1, at.normal, at.bends[1], bend),
            *((0, *part, _TANGENTIAL) for part in parts),
        ]
    largest, share = (of.across, limits.curvature) if k == 2 else (of.rates[k - 3], limits.rate)
    return [(0, at.normal, height, share * largest), *((0, *part, _TANGENTIAL_HIGHER * largest) for part in parts)]


def _solved(
    bases: Sequence[FloatArray], equations: Sequence[Equation], fixed: FloatArray | None, space: FloatArray | None
) -> FloatArray:
    """Return control points, shape (n, 3): x, y and z are coupled by the directions.

    Of an open row the first and last are fixed; those of a closed one lie in a space.
    """
    n = bases[0].shape[1]
    free = [basis @ space for basis in bases] if space is not None else [basis[:, 1:-1] for basis in bases]
    blocks, values = [], []
    for order, direction, value, limit in equations:
        known = np.zeros(len(value)) if fixed is None else dot(bases[order][:, [0, -1]] @ fixed, direction)
        blocks.append((free[order][:, :, None] * (direction / limit)[:, None, :]).reshape(len(value), -1))
        values.append((value - known) / limit)
    system = np.concatenate(blocks)
    solution = scipy.linalg.lstsq(system, np.concatenate(values), lapack_driver="gelsy", check_finite=False)[0]
    solution = solution.reshape(-1, 3)
    if space is not None:
        points = np.asarray(space @ solution)
        points[-1] = points[0]
        return points
    assert fixed is not None
    points = np.empty((n, 3))
    points[0], points[-1], points[1:-1] = fixed[0], fixed[1], solution
    return points


def _basis(degree: int, knots: FloatArray, v: FloatArray, order: int) -> FloatArray:
    inner = knots[order : len(knots) - order]
    return np.asarray((basis_matrix(degree - order, inner, v) @ derivative_matrix(degree, knots, order)).toarray())


def closed_space(degree: int, breaks: FloatArray) -> FloatArray:
    """Return the clamped control points, shape (n, spans), of each function that is smooth at the seam too.

    The periodic spline's control points, repeated beyond the seam, with knots inserted at both ends.
    """
    spans, period = len(breaks) - 1, breaks[-1] - breaks[0]
    around = np.concatenate([breaks[:-1] + k * period for k in range(-degree - 1, degree + 2)])
    first = (degree + 1) * spans
    extended = around[first - degree : first + spans + degree + 1]
    # The same function of each turn beyond the seam.
    wrapped = np.zeros((spans + degree, spans))
    wrapped[np.arange(spans + degree), np.arange(spans + degree) % spans] = 1.0
    matrix, _ = restriction_matrix(degree, extended, float(breaks[0]), float(breaks[-1]))
    return np.asarray(matrix @ wrapped)
