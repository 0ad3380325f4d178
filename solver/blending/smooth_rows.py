"""The part of the free rows that knots close together hide from the linear solve.

A span of length h in v is as stiff as 1 / h^3: in the stationarity system, rounded to 1e-16 of that, what bends the
rows over longer spans is lost, the rows stay as stiff as the rounding, and a small last correction says nothing.
Rows over the same knots without those that are close are free of that, and a subspace: how far a step among them would
lower the energy shows what the solve has left, and such steps in turn with those of the whole system find it.

Source: two-level correction by a subspace; J. Xu, Iterative methods by space decomposition and subspace correction,
SIAM Review 34, 1992.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import periodic_points
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.splines import Basis, refinement_matrix

# Knots nearer than this fraction of the longest span are close: stiffer by 1e9, where a solve keeps half its digits.
CLOSE_KNOTS = 1e-3


def without_close_knots(basis: Basis) -> Basis:
    """Return a basis of a subspace that has no narrow spans to bend; the same one where there are none.

    Of knots that are close as many stay as leave the slope continuous there, those of the highest multiplicity first;
    close to an end none stays.

    Examples
    --------
    >>> without_close_knots(Basis(3, np.array([0, 0, 0, 0, 1e-6, 0.5, 1, 1, 1, 1]))).knots
    array([0. , 0. , 0. , 0. , 0.5, 1. , 1. , 1. , 1. ])
    """
    p, knots = basis.degree, basis.knots
    values, counts = np.unique(knots, return_counts=True)
    close = CLOSE_KNOTS * np.diff(values).max()
    if np.diff(values).min() >= close:
        return basis
    kept = np.zeros_like(counts)
    kept[[0, -1]] = counts[[0, -1]]
    inner = np.arange(1, len(values) - 1)
    for i in inner[np.argsort(-counts[1:-1], kind="stable")]:
        low, high = np.searchsorted(values, [values[i] - close, values[i] + close])
        others = kept[low:high].sum()
        kept[i] = max(0, min(counts[i], p - 1 - others)) if others else counts[i]
    return replace(basis, knots=np.repeat(values, kept))


class SmoothRows:
    """Free rows over their knots without those that are close.

    Attributes
    ----------
    lift : sparse matrix
        From the unknowns to the free control points.
    """

    def __init__(self, form: EnergyForm, bases: tuple[Basis, ...], rows: range, seam_orders: list[int]) -> None:
        smooth = EnergyForm(form.u, bases)
        matrix = smooth.assembled(smooth.blocks(rows), rows)
        lifts = []
        for i, order in zip(rows, seam_orders, strict=True):
            lift = refinement_matrix(bases[i].degree, bases[i].knots, form.rows[i].knots)
            lifts.append((lift, periodic_points(bases[i], order) if order >= 0 else sp.eye_array(bases[i].size)))
        z = sp.block_diag([one for _, one in lifts], format="csr")
        self.lift = sp.block_diag([lift for lift, _ in lifts], format="csr") @ z
        self.factor = splu((z.T @ matrix @ z).tocsc())

    def correction(self, gradient: FloatArray) -> tuple[FloatArray, float]:
        """Return the step that lowers the energy most, and by how much.

        Parameters
        ----------
        gradient : ndarray, shape (number of free points, d)
            H p of the free rows.
        """
        right = self.lift.T @ gradient
        x = self.factor.solve(right)
        return -(self.lift @ x), float(np.sum(x * right))


def smooth_rows(form: EnergyForm, rows: range, seam_orders: list[int]) -> SmoothRows | None:
    """Return the smooth rows, or None where no knots are close."""
    orders = dict(zip(rows, seam_orders, strict=True))
    bases = []
    for i, row in enumerate(form.rows):
        basis = without_close_knots(row) if i in orders else row
        # As smooth across the seam as the row itself, or no subspace of it.
        bases.append(basis if basis.size // 2 > orders.get(i, -1) else row)
    if all(basis is row for basis, row in zip(bases, form.rows, strict=True)):
        return None
    try:
        return SmoothRows(form, tuple(bases), rows, seam_orders)
    except RuntimeError:
        return None
