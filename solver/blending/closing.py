"""Closed contact curves: re-seaming a base exactly, and keeping free rows smooth across the seam."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.errors import KnotError
from semispline.solver.splines import (
    Basis,
    BSplineCurve,
    derivative_matrix,
    derivative_points,
    restrict_curve,
    set_curve_continuity,
)

# Derivatives at both ends of a seam that differ by less than this, relative to the largest, count as equal.
SEAM_TOLERANCE = 1e-9
# Roundings of control points, in units of the spacing of floats, that may part both ends of a seam.
_ROUNDINGS = 16


def seam_order(along: Basis, rows: FloatArray, largest: float) -> int:
    """Return how many derivatives of closed rows agree across the seam: -1 where they are open, at most the degree - 1.

    Parameters
    ----------
    along : Basis
    rows : ndarray, shape (K, n, 3) or (K, n, 4)
    largest : float
        Largest coordinate that the rows were given in, whatever origin they are counted from now.
    """
    order = -1
    factor = end_factor(rows)
    rounding = _ROUNDINGS * np.finfo(float).eps * largest
    for d in range(along.degree):
        # The first and the last control point of a derivative are its values at the ends.
        points = derivative_points(along.degree, along.knots, rows.transpose(1, 0, 2), d)
        largest = max(float(np.abs(points).max()), float(np.ptp(rows, axis=1).max()))
        # A narrow span at an end amplifies the rounding of the control points.
        amplified = rounding * np.abs(derivative_matrix(along.degree, along.knots, d)[[0, -1]]).sum(axis=1).max()
        if np.abs(factor * points[0] - points[-1]).max() > SEAM_TOLERANCE * largest + amplified:
            break
        order = d
    return order


def reseamed(along: Basis, rows: FloatArray, shift: float, largest: float) -> tuple[Basis, FloatArray]:
    """Return the same closed rows with their seam `shift` later; exact up to rounding.

    The old seam becomes an inner knot, of the multiplicity that the smoothness of the rows there asks for.

    Parameters
    ----------
    along : Basis
    rows : ndarray, shape (K, n, 3) or (K, n, 4)
    shift : float
        Between 0 and the length of the domain.
    largest : float
        As in `seam_order`.

    Returns
    -------
    along : Basis
        From start + shift to end + shift.
    rows : ndarray, shape (K, n', 3)
    """
    start, end = float(along.knots[0]), float(along.knots[-1])
    factor = end_factor(rows)
    curves = [_joined(_curve(along, row), start, end, start + shift, factor) for row in rows]
    for order in range(seam_order(along, rows, largest), 0, -1):
        try:
            # Each row on its own would do, but all must keep one knot vector.
            smooth = [set_curve_continuity(curve, end, order, SEAM_TOLERANCE) for curve in curves]
        except KnotError:
            continue
        curves = smooth
        break
    return replace(along, knots=curves[0].knots), np.stack([curve.homogeneous for curve in curves])


def end_factor(rows: FloatArray) -> float:
    """Return by which factor homogeneous rows are larger at their end than at their start; 1 for three columns."""
    return 1.0 if rows.shape[2] == 3 else float(rows[0, -1, 3] / rows[0, 0, 3])


def _curve(along: Basis, row: FloatArray) -> BSplineCurve:
    if row.shape[1] == 3:
        return BSplineCurve(along.degree, along.knots, row)
    return BSplineCurve(along.degree, along.knots, row[:, :3] / row[:, 3:], row[:, 3])


def _joined(curve: BSplineCurve, start: float, end: float, at: float, factor: float) -> BSplineCurve:
    """Return the piece from `at` to the end, followed by the piece from the start, joined continuously."""
    first, second = restrict_curve(curve, at, end), restrict_curve(curve, start, at)
    p = curve.degree
    knots = np.concatenate([first.knots[:-1], second.knots[p + 1 :] + (end - start)])
    points = np.concatenate([first.homogeneous, factor * second.homogeneous[1:]])
    return _curve(Basis(p, knots), points)


def periodic_points(basis: Basis, order: int) -> SparseMatrix:
    """Return Z, shape (n, n - order - 1): control points Z y of all closed curves that are C^order across the seam.

    The last order + 1 control points follow from the first ones, so that all derivatives up to `order` agree.
    """
    n, k = basis.size, order + 1
    first, last = end_conditions(basis, order)
    block = np.linalg.solve(last, first)
    return sp.vstack([sp.eye_array(n - k, format="csr"), sp.csr_array((k, n - k))], format="csr") + sp.coo_array(
        (block.ravel(), (np.repeat(np.arange(n - k, n), k), np.tile(np.arange(k), k))), shape=(n, n - k)
    )


def end_conditions(basis: Basis, order: int) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives of order 0..order at the start by the first points, at the end by the last ones.

    Each line is scaled to size 1; both of shape (order + 1, order + 1).
    """
    k = order + 1
    first, last = np.zeros((k, k)), np.zeros((k, k))
    for d in range(k):
        matrix = derivative_matrix(basis.degree, basis.knots, d)
        first[d], last[d] = matrix[[0]].toarray()[0, :k], matrix[[-1]].toarray()[0, -k:]
        scale = np.abs(last[d]).max()
        first[d] /= scale
        last[d] /= scale
    return first, last


def with_least_size(basis: Basis, size: int) -> Basis:
    """Return the basis, its longest spans halved until it has at least `size` functions; equal ones together."""
    knots = basis.knots
    while len(knots) - basis.degree - 1 < size:
        widths = np.diff(knots)
        longest = np.flatnonzero(widths > (1 - SEAM_TOLERANCE) * widths.max())
        knots = np.insert(knots, longest + 1, knots[longest] + widths[longest] / 2)
    return replace(basis, knots=knots)
