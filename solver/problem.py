"""The blend as a minimisation: energy, prescribed rows, free rows, admissible shape parameters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from scipy.sparse.linalg import splu

from solver.arrays import FloatArray
from solver.errors import ComputationError, EdgeError
from solver.gram import EnergyForm
from solver.knots import basis_matrix, greville
from solver.layout import ROWS_PER_SIDE, blend_u_basis, middle_basis
from solver.sides import Side

# Iterative refinement may change a solution by this fraction; beyond it the system is too ill-conditioned.
TRUSTED_CORRECTION = 1e-6


@dataclass(frozen=True)
class ProblemOptions:
    """What may be chosen about a blend beside its bases and contact.

    Attributes
    ----------
    middle_curves : int
    degree_u : int
    shape : pair of float, "free" or "natural"
        alpha^2 and beta^2 where contact is geometric.
    box : (float, float)
        Admissible range of a free shape parameter, in units of its natural size; near zero the blend folds.
    """

    middle_curves: int = 1
    degree_u: int = 3
    shape: tuple[float | Literal["free", "natural"], float | Literal["free", "natural"]] = ("free", "free")
    box: tuple[float, float] = (1 / 8, 8.0)


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
    bounds : pair of (float, float)
        Boxes of alpha^2 and beta^2; low = high where the parameter is fixed.
    """

    form: EnergyForm
    a: Side
    b: Side
    natural: tuple[float, float]
    bounds: tuple[tuple[float, float], tuple[float, float]]

    @property
    def free(self) -> tuple[bool, bool]:
        """Whether alpha^2 and beta^2 are unknowns."""
        (low_a, high_a), (low_b, high_b) = self.bounds
        return low_a < high_a, low_b < high_b

    @property
    def start(self) -> tuple[float, float]:
        """Natural alpha^2 and beta^2, or the nearest admissible ones."""
        a, b = (min(max(n, low), high) for n, (low, high) in zip(self.natural, self.bounds, strict=True))
        return a, b

    @property
    def contacts(self) -> tuple[tuple[Side, range, tuple[float, float]], ...]:
        """For each contact the side, the rows counted from it, and the distances of the two nearest knots of U."""
        U, p = self.form.u.knots, self.form.u.degree
        from_end = U[-1] - U[::-1]
        m = len(self.form.rows) - 1
        return (
            (self.a, range(m + 1), (float(U[p + 1]), float(U[p + 2]))),
            (self.b, range(m, -1, -1), (float(from_end[p + 1]), float(from_end[p + 2]))),
        )

    @cached_property
    def _free_system(self) -> _FreeSystem:
        owned_a, owned_b = self.a.order + 1, self.b.order + 1
        return _FreeSystem(self.form, range(owned_a, len(self.form.rows) - owned_b))

    def control_points(self, a: float, b: float) -> FloatArray:
        """Return p of least energy for given alpha^2 and beta^2, shape (N, 3): one linear solve for the free rows."""
        points = np.zeros((self.form.offsets[-1], 3))
        for (side, rows, spans), value in zip(self.contacts, (a, b), strict=True):
            for row, prescribed in zip(rows, side.contact_rows(value, self.form.u.degree, spans), strict=False):
                points[self.form.offsets[row] : self.form.offsets[row + 1]] = prescribed
        return self.completed(points)

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, d), so that the energy is least."""
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


def make_problem(a: Side, b: Side, options: ProblemOptions) -> BlendProblem:
    """Lay out the knots of the blend and its admissible shape parameters.

    Raises
    ------
    OptionError
        A number of middle curves or a degree out of range.
    EdgeError
        The contact curves coincide, one of them is a point, or a cross derivative that contact needs vanishes.
    """
    u = blend_u_basis(options.degree_u, options.middle_curves)
    middle = middle_basis(a.along, b.along)
    rows = (a.along,) * ROWS_PER_SIDE + (middle,) * options.middle_curves + (b.along,) * ROWS_PER_SIDE
    natural = _natural_sizes(a, b)
    bounds_a, bounds_b = (
        (1.0, 1.0) if not side.has_shape_parameter else _bounds(size, shape, options.box)
        for side, size, shape in zip((a, b), natural, options.shape, strict=True)
    )
    return BlendProblem(EnergyForm(u, rows), a, b, natural, (bounds_a, bounds_b))


def _bounds(natural: float, shape: float | Literal["free", "natural"], box: tuple[float, float]) -> tuple[float, float]:
    if shape == "free":
        return natural * box[0], natural * box[1]
    fixed = natural if shape == "natural" else float(shape)
    return fixed, fixed


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
