"""The free rows of a blend: one linear system, factorised once, with its digits counted."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import periodic_points
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.smooth_rows import SmoothRows, smooth_rows
from semispline.solver.errors import ComputationError
from semispline.solver.splines import greville

# A correction by this fraction is rounding; a larger one asks for refinement, and at the end must be below the second.
ROUNDING_CORRECTION = 1e-12
TRUSTED_CORRECTION = 1e-8
_MOST_REFINEMENTS = 20


class FreeSystem:
    """The stationarity system of the free rows, factorised once.

    Free control points are Z y: Z is the identity, but for closed rows that are to be smooth across their seam.

    Attributes
    ----------
    size : int
        Number of free control points; where it is 0 there is nothing else.
    free : slice
        Their place in p.
    blocks : dict of sparse matrices
        Those of H that couple free rows i with any row j.
    z : sparse matrix or None
        None is the identity.
    order : ndarray of int
        Sorts y along v.
    matrix : sparse matrix
        The system for the sorted y: symmetric, positive definite, banded.
    smooth : SmoothRows or None
        What knots close together hide from the system; None where there are none.
    """

    def __init__(self, form: EnergyForm, rows: range, seam_orders: list[int]) -> None:
        self.form = form
        self.rows = rows
        self.offsets = form.offsets
        self.free = slice(form.offsets[rows.start], form.offsets[rows.stop])
        self.size = self.free.stop - self.free.start
        if self.size == 0:
            return
        self.blocks = form.blocks(rows)
        matrix = form.assembled(self.blocks, rows)
        self.z = None
        along = [greville(form.rows[i].knots, form.rows[i].degree) for i in rows]
        if max(seam_orders) >= 0:
            self.z = sp.block_diag(
                [periodic_points(form.rows[i], order) for i, order in zip(rows, seam_orders, strict=True)], format="csr"
            )
            along = [x[: len(x) - order - 1] for x, order in zip(along, seam_orders, strict=True)]
            matrix = self.z.T @ matrix @ self.z
        self.smooth: SmoothRows | None = smooth_rows(form, rows, seam_orders)
        # Sorting by the place along v, rows side by side, makes the matrix banded; row by row where rows are many.
        places = np.concatenate(along)
        self.order = np.argsort(places, kind="stable") if len(rows) ** 2 <= len(places) else np.arange(len(places))
        self.matrix = matrix[self.order][:, self.order].tocsc()
        try:
            self.factor = splu(
                self.matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError:
            raise ComputationError(
                "the stationarity system is singular; try fewer middle curves or knots that are not so close"
            ) from None

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least."""
        if self.size == 0:
            return points
        right = self._right(points)
        x = self.factor.solve(right)
        correction = self.factor.solve(right - self.matrix @ x)
        x += correction
        left = _fraction(correction, x)
        if left > ROUNDING_CORRECTION:
            x, left = self._refined(x, points)
        if self.smooth is not None:
            filled, left = self._smoothed(self._with_free(points, x), left, self.smooth)
        else:
            filled = self._with_free(points, x)
        # The last correction shows how many digits there are.
        if not left <= TRUSTED_CORRECTION:
            raise ComputationError(
                f"the stationarity system of {self.size} unknowns is too ill-conditioned to be trusted; try v_scale "
                "unit or length, knots that are not so close, fewer control points, or a parameter v that grows with "
                "their number"
            )
        return filled

    def excess(self, points: FloatArray) -> float | None:
        """Bound how much more energy p, shape (N, d), has than the least for its prescribed rows, as a fraction.

        The matrix is positive definite (its factorisation showed that), so that the excess is half of gradient times
        step. None where no row is free.
        """
        if self.size == 0:
            return None
        gradient = self.form.gradient(points)
        step = self._with_free(np.zeros_like(points), self._correction(gradient))
        least = max(float(np.sum(points * gradient)), np.finfo(float).tiny)
        return abs(float(np.sum(step[self.free] * gradient[self.free]))) / least

    def response(self, forces: FloatArray) -> FloatArray:
        """Return how the free points, shape (size, K), answer forces of that shape."""
        return self._with_free(np.zeros((self.offsets[-1], forces.shape[1])), self._answer(forces))[self.free]

    def gradient_of(self, points: FloatArray) -> tuple[FloatArray, float]:
        """Return the gradient by the free points and the energy of p, shape (N, 3), but for factors of 2."""
        gradient = self.form.gradient(points)
        return gradient[self.free], float(np.sum(points * gradient))

    def solved_at_once(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), by one solve without refinement, as exported code does."""
        return points if self.size == 0 else self._with_free(points, self.factor.solve(self._right(points)))

    def _right(self, points: FloatArray) -> FloatArray:
        """Return the right side for the sorted y, shape (size of y, d)."""
        # What the prescribed rows do to the gradient of the energy.
        right = np.zeros((self.offsets[-1], points.shape[1]))
        for (i, j), block in self.blocks.items():
            if j not in self.rows:
                right[self._part(i)] -= block @ points[self._part(j)]
        right = right[self.free]
        return np.asarray((right if self.z is None else self.z.T @ right)[self.order])

    def _refined(self, x: FloatArray, points: FloatArray) -> tuple[FloatArray, float]:
        """Refine with the gradient taken from second derivatives, which H x loses by cancellation.

        Source: corrected seminormal equations; A. Bjorck, Numerical Methods for Least Squares Problems, 1996, ch. 6.
        """
        before = np.inf
        for _ in range(_MOST_REFINEMENTS):
            correction = self._correction(self.form.gradient(self._with_free(points, x)))
            x = x - correction
            change = _fraction(correction, x)
            if change <= ROUNDING_CORRECTION or change >= before / 2:
                break
            before = change
        return x, change

    def _smoothed(self, points: FloatArray, left: float, smooth: SmoothRows) -> tuple[FloatArray, float]:
        """Refine p by steps of the whole system and of the smooth rows in turn, where the latter show the need.

        Returns
        -------
        points : ndarray, shape (N, d)
        left : float
            The last correction of either kind as a fraction; or of the energy, where rounding moves points but not it.
        """
        step, _ = smooth.correction(self.form.gradient(points)[self.free])
        if left <= TRUSTED_CORRECTION and _fraction(step, points) <= TRUSTED_CORRECTION:
            return points, left
        before, points = np.inf, points.copy()
        # What is there may be nothing but rounding.
        points[self.free] = 0.0
        for _ in range(_MOST_REFINEMENTS):
            gradient = self.form.gradient(points)
            correction = self._correction(gradient)
            move = self._with_free(np.zeros_like(points), -correction)[self.free]
            saved = -float(np.sum(move * gradient[self.free]))
            points[self.free] += move
            gradient = self.form.gradient(points)
            step, lower = smooth.correction(gradient[self.free])
            points[self.free] += step
            change = max(_fraction(move, points), _fraction(step, points))
            if change <= ROUNDING_CORRECTION or change >= before / 2:
                break
            before = change
        layers = np.stack(np.split(points, points.shape[1] // 3, axis=1))
        energy = float(np.trace(self.form.products(layers)))
        return points, min(change, max(abs(saved), abs(lower)) / max(energy, 1e-300))

    def _correction(self, gradient: FloatArray) -> FloatArray:
        """Return the change of the sorted y that a gradient, shape (N, d), asks for."""
        return self._answer(gradient[self.free])

    def _answer(self, forces: FloatArray) -> FloatArray:
        return np.asarray(self.factor.solve((forces if self.z is None else self.z.T @ forces)[self.order]))

    def _with_free(self, points: FloatArray, x: FloatArray) -> FloatArray:
        free = np.empty(x.shape)
        free[self.order] = x
        filled = points.copy()
        filled[self.free] = free if self.z is None else self.z @ free
        return filled

    def _part(self, row: int) -> slice:
        return slice(self.offsets[row], self.offsets[row + 1])


def _fraction(change: FloatArray, x: FloatArray) -> float:
    return float(np.abs(change).max()) / max(float(np.abs(x).max()), 1e-300)
