"""The blend as a minimisation: energy, prescribed rows, free rows, admissible shape parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import splu

from solver.arrays import FloatArray
from solver.errors import ComputationError, EdgeError
from solver.gram import EnergyForm
from solver.knots import basis_matrix, greville
from solver.layout import ROWS_PER_SIDE, blend_u_basis, middle_basis
from solver.sides import Side

# Admissible a = alpha^2 lies within this factor of its natural size; near zero the blend folds.
BOX_FACTOR = 8.0
# Iterative refinement may change a solution by this fraction; beyond it the system is too ill-conditioned.
TRUSTED_CORRECTION = 1e-6


@dataclass(frozen=True, eq=False)
class BlendProblem:
    """A blend to be found, in coordinates of size 1 around the origin.

    Attributes
    ----------
    form : EnergyForm
        U and V_i of the m + 1 rows, and the energy over them.
    a, b : Side
        Contact at u = 0 and u = 1.
    natural : (float, float)
        Natural sizes of alpha^2 and beta^2: mean gap between the contact curves over mean cross speed of the base.
    """

    form: EnergyForm
    a: Side
    b: Side
    natural: tuple[float, float]

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
        U, p = self.form.u.knots, self.form.u.degree
        from_end = U[-1] - U[::-1]
        return (float(U[p + 1]), float(U[p + 2])), (float(from_end[p + 1]), float(from_end[p + 2]))

    def prescribed(self, a: float, b: float) -> tuple[FloatArray, FloatArray]:
        """Return the indices in p that both contacts prescribe, and their values, shapes (F,) and (F, 3)."""
        spans_a, spans_b = self.spans
        at_a = self.a.contact_rows(a, self.form.u.degree, spans_a)
        at_b = self.b.contact_rows(b, self.form.u.degree, spans_b)[::-1]
        m1 = len(self.form.rows)
        owned = [*range(len(at_a)), *range(m1 - len(at_b), m1)]
        index = np.concatenate([np.arange(self.form.offsets[i], self.form.offsets[i + 1]) for i in owned])
        return index, np.concatenate([at_a.reshape(-1, 3), at_b.reshape(-1, 3)])

    @cached_property
    def _free_system(self) -> _FreeSystem:
        owned_a, owned_b = self.a.order + 1, self.b.order + 1
        return _FreeSystem(self.form, range(owned_a, len(self.form.rows) - owned_b))

    def control_points(self, a: float, b: float) -> FloatArray:
        """Return p of least energy for given alpha^2 and beta^2, shape (N, 3): one linear solve for the free rows."""
        fixed, values = self.prescribed(a, b)
        points = np.zeros((self.form.offsets[-1], 3))
        points[fixed] = values
        return self._free_system.completed(points)


class _FreeSystem:
    """The stationarity system of the free rows, factorised once."""

    def __init__(self, form: EnergyForm, rows: range) -> None:
        self.free = slice(form.offsets[rows.start], form.offsets[rows.stop])
        self.size = self.free.stop - self.free.start
        if self.size == 0:
            return
        self.lines = form.matrix(rows)
        # Sorting by the place along v, rows side by side, makes the matrix banded.
        along = np.concatenate([greville(form.rows[i].knots, form.rows[i].degree) for i in rows])
        self.order = np.argsort(along, kind="stable")
        matrix = self.lines[:, self.free][self.order][:, self.order].tocsc()
        self.matrix = matrix
        try:
            self.factor = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:
            raise ComputationError(
                "the stationarity system is singular; try fewer middle curves or knots that are not so close"
            ) from None

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least."""
        if self.size == 0:
            return points
        filled = points.copy()
        filled[self.free] = 0.0
        right = -(self.lines @ filled)[self.order]
        x = self.factor.solve(right)
        correction = self.factor.solve(right - self.matrix @ x)
        x += correction
        # The correction shows how many digits the first solve had.
        if not np.abs(correction).max() <= TRUSTED_CORRECTION * max(float(np.abs(x).max()), 1e-300):
            raise ComputationError(
                f"the stationarity system of {self.size} unknowns is too ill-conditioned to be trusted; "
                "try fewer control points, or let the parameter v grow with their number"
            )
        free = np.empty(x.shape)
        free[self.order] = x
        filled[self.free] = free
        return filled


def make_problem(a: Side, b: Side, degree_u: int, middle_curves: int) -> BlendProblem:
    """Lay out the knots of the blend and assemble its energy.

    Raises
    ------
    OptionError
        A number of middle curves or a degree out of range.
    EdgeError
        The contact curves coincide, one of them is a point, or a cross derivative that contact needs vanishes.
    """
    u = blend_u_basis(degree_u, middle_curves)
    middle = middle_basis(a.along, b.along)
    rows = (a.along,) * ROWS_PER_SIDE + (middle,) * middle_curves + (b.along,) * ROWS_PER_SIDE
    return BlendProblem(EnergyForm(u, rows), a, b, _natural_sizes(a, b))


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
