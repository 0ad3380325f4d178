"""The blend as a minimisation: energy, prescribed rows, free rows, admissible shape parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import splu

from solver.arrays import FloatArray, SparseMatrix
from solver.errors import ComputationError, EdgeError
from solver.gram import Basis, energy_matrix
from solver.knots import basis_matrix, greville
from solver.layout import ROWS_PER_SIDE, blend_u_basis, middle_basis
from solver.sides import Side

# Admissible a = alpha^2 lies within this factor of its natural size; near zero the blend folds.
BOX_FACTOR = 8.0


@dataclass(frozen=True, eq=False)
class BlendProblem:
    """A blend to be found, in coordinates of size 1 around the origin.

    Attributes
    ----------
    u : Basis
        U, for m + 1 rows.
    rows : tuple of Basis, length m + 1
        V_i.
    a, b : Side
        Contact at u = 0 and u = 1.
    natural : (float, float)
        Natural sizes of alpha^2 and beta^2: mean gap between the contact curves over mean cross speed of the base.
    energy : sparse array, shape (N, N)
        H of E = sum over x, y, z of p'Hp, p stacking the control points of all rows.
    """

    u: Basis
    rows: tuple[Basis, ...]
    a: Side
    b: Side
    natural: tuple[float, float]
    energy: SparseMatrix

    @cached_property
    def offsets(self) -> list[int]:
        """Where each row starts in p; one more for the end."""
        return [0, *np.cumsum([row.size for row in self.rows]).tolist()]

    @property
    def bounds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Boxes of alpha^2 and beta^2; a single value where a side has no shape parameter."""
        lower, upper = (
            (n / BOX_FACTOR, n * BOX_FACTOR) if side.has_shape_parameter else (1.0, 1.0)
            for side, n in zip((self.a, self.b), self.natural, strict=True)
        )
        return lower, upper

    @property
    def start(self) -> tuple[float, float]:
        """Natural alpha^2 and beta^2 where they are free, else 1."""
        first, second = (
            n if side.has_shape_parameter else 1.0 for side, n in zip((self.a, self.b), self.natural, strict=True)
        )
        return first, second

    @property
    def spans(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Distances of the two knots of U nearest to each end, measured from that end."""
        U, p = self.u.knots, self.u.degree
        from_end = U[-1] - U[::-1]
        return (float(U[p + 1]), float(U[p + 2])), (float(from_end[p + 1]), float(from_end[p + 2]))

    def prescribed(self, a: float, b: float) -> tuple[FloatArray, FloatArray]:
        """Return the indices in p that both contacts prescribe, and their values, shapes (F,) and (F, 3)."""
        spans_a, spans_b = self.spans
        at_a = self.a.contact_rows(a, self.u.degree, spans_a)
        at_b = self.b.contact_rows(b, self.u.degree, spans_b)[::-1]
        m1 = len(self.rows)
        owned = [*range(len(at_a)), *range(m1 - len(at_b), m1)]
        index = np.concatenate([np.arange(self.offsets[i], self.offsets[i + 1]) for i in owned])
        return index, np.concatenate([at_a.reshape(-1, 3), at_b.reshape(-1, 3)])

    def control_points(self, a: float, b: float) -> FloatArray:
        """Return p of least energy for given alpha^2 and beta^2, shape (N, 3): one linear solve for the free rows."""
        fixed, values = self.prescribed(a, b)
        points = np.zeros((self.offsets[-1], 3))
        points[fixed] = values
        free = np.setdiff1d(np.arange(len(points)), fixed)
        if len(free):
            points[free] = self._solve(free, -(self.energy[free][:, fixed] @ values))
        return points

    def _solve(self, free: FloatArray, right: FloatArray) -> FloatArray:
        # Sorting by the place along v, rows side by side, makes the matrix banded.
        along = np.concatenate([greville(row.knots, row.degree) for row in self.rows])[free]
        order = np.argsort(along, kind="stable")
        matrix = self.energy[free[order]][:, free[order]].tocsc()
        options = {"SymmetricMode": True}
        try:
            factor = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options)
        except RuntimeError:
            raise ComputationError(
                "the stationarity system is singular; try fewer middle curves or knots that are not so close"
            ) from None
        x = factor.solve(right[order])
        x += factor.solve(right[order] - matrix @ x)
        solution = np.empty(x.shape)
        solution[order] = x
        return solution


def make_problem(a: Side, b: Side, degree_u: int, middle_curves: int) -> BlendProblem:
    """Lay out the knots of the blend and assemble its energy.

    Raises
    ------
    OptionError
        A number of middle curves or a degree that does not go together with the contact.
    EdgeError
        The contact curves coincide, one of them is a point, or a cross derivative that contact needs vanishes.
    """
    u = blend_u_basis(degree_u, middle_curves, max(a.order, b.order))
    middle = middle_basis(a.along, b.along)
    rows = (a.along,) * ROWS_PER_SIDE + (middle,) * middle_curves + (b.along,) * ROWS_PER_SIDE
    return BlendProblem(u, rows, a, b, _natural_sizes(a, b), energy_matrix(u, rows))


def _natural_sizes(a: Side, b: Side) -> tuple[float, float]:
    start, end = a.along.knots[0], a.along.knots[-1]
    x = start + (end - start) * (np.arange(64) + 0.5) / 64
    curves = [basis_matrix(side.along.degree, side.along.knots, x) @ side.rows[0] for side in (a, b)]
    # Coordinates are of size 1, so these limits are fractions of the model's size.
    for name, curve in zip("ab", curves, strict=True):
        if np.ptp(curve, axis=0).max() < 1e-12:
            raise EdgeError(f"base {name}: the contact curve has zero length; choose another edge")
    gap = float(np.linalg.norm(curves[0] - curves[1], axis=1).mean())
    if gap < 1e-12:
        raise EdgeError(
            "bases: the contact curves coincide, so there is nothing to blend; move a base or choose an edge"
        )
    speeds = [side.mean_cross_speed() for side in (a, b)]
    for name, side, speed in zip("ab", (a, b), speeds, strict=True):
        if side.order > 0 and speed * side.spans[0] < 1e-12:
            raise EdgeError(f"base {name}: the cross derivative vanishes along the contact curve; choose another edge")
    natural_a, natural_b = (gap / speed if speed > 0 else 1.0 for speed in speeds)
    return natural_a, natural_b
