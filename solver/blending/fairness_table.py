"""J = A * (integral of |grad H|^2 dA + jumps of H) of all blends of a problem, as a function of its shape parameters.

Control points are polynomials in the shape parameters: P = sum_k m_k Z_k. What |grad H|^2 takes of a surface is tabled
once for each Z_k, so that a blend costs a product of its monomials with the table, and its gradient one reverse sweep.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.generated.fairness_numpy import fairness, fairness_gradient
from semispline.solver.splines import (
    Basis,
    basis_matrix,
    breakpoints,
    derivative_points,
    gauss_rule,
    merge_breakpoints,
    reversed_knots,
)

# Orders of the nine derivatives, in the order of the generated program.
_ORDERS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
# Nodes in u altogether, and in v on each span and altogether, at least.
NODES_U, _NODES_V, _LEAST_V = 40, 2, 10
# A jump of H counts over this fraction of the mean length across, as a ramp of that width would.
WINDOW = 1 / 50
# Normals of neighbouring nodes that turn by more than 60 degrees have met a fold, or a bend too sharp to measure.
_LEAST_COSINE = 0.5


@dataclass(frozen=True, eq=False)
class Grid:
    """Where a surface is measured: Gauss nodes, and the lines of v across which H may jump."""

    u: FloatArray
    weights_u: FloatArray
    v: FloatArray
    weights_v: FloatArray
    lines: FloatArray


def make_grid(problem: BlendProblem, times: int = 1) -> Grid:
    """Return the nodes of a problem, `times` as many in each direction."""
    breaks_u = breakpoints(problem.form.u.knots)
    breaks_v = merge_breakpoints(*(breakpoints(row.knots) for row in problem.rows))
    each_u = -(-NODES_U // (len(breaks_u) - 1)) * times
    each_v = max(_NODES_V, -(-_LEAST_V // (len(breaks_v) - 1))) * times
    # n points are exact to degree 2 n - 1; spans are the last axis.
    (u, weights_u), (v, weights_v) = (
        (x.T.ravel(), w.T.ravel())
        for x, w in (gauss_rule(breaks_u, 2 * each_u - 1), gauss_rule(breaks_v, 2 * each_v - 1))
    )
    return Grid(u, weights_u, v, weights_v, _lines(problem.rows))


def _lines(rows: tuple[Basis, ...]) -> FloatArray:
    """Return the inner knots where some row is only C1."""
    found = []
    for row in rows:
        values, counts = np.unique(row.knots[row.degree + 1 : -row.degree - 1], return_counts=True)
        found.append(values[row.degree - counts == 1])
    return np.unique(np.concatenate(found))


class FairnessTable:
    """The derivatives of each Z_k at the nodes.

    Parameters
    ----------
    problem : BlendProblem
    layers : ndarray, shape (K, N, 3)
        Z_k.
    grid : Grid
    """

    def __init__(self, problem: BlendProblem, layers: FloatArray, grid: Grid) -> None:
        self.grid = grid
        self._problem = problem
        self._shape = len(grid.u), len(grid.v)
        self._table = _derivatives(problem, layers, grid.u, grid.v, reverse=False)
        self._weights = np.multiply.outer(grid.weights_u, grid.weights_v).ravel()
        self._sides = [_derivatives(problem, layers, grid.u, grid.lines, reverse=reverse) for reverse in (True, False)]

    @cached_property
    def _across(self) -> FloatArray:
        """Weights that make the mean length across of speeds at the nodes."""
        return self._weights / float(self.grid.weights_v.sum())

    def value(self, monomials: FloatArray) -> float:
        """Return J alone; infinite where the blend folds between neighbouring nodes."""
        planes = self._planes(self._table, monomials)
        return np.inf if self._turns(planes) else self._parts(planes, monomials)[0]

    def folds(self, monomials: FloatArray) -> bool:
        """Tell whether the normals of neighbouring nodes turn by more than 60 degrees."""
        return self._turns(self._planes(self._table, monomials))

    def _turns(self, planes: FloatArray) -> bool:
        (ax, ay, az), (bx, by, bz) = planes[:3], planes[3:6]
        normal = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
        with np.errstate(divide="ignore", invalid="ignore"):
            normal = (normal / np.sqrt(np.sum(normal**2, axis=0))).reshape(3, *self._shape)
        along_u = np.sum(normal[:, 1:] * normal[:, :-1], axis=0)
        along_v = np.sum(normal[:, :, 1:] * normal[:, :, :-1], axis=0)
        # What is no number does not compare.
        return not (np.all(along_u > _LEAST_COSINE) and np.all(along_v > _LEAST_COSINE))

    def measured(self, monomials: FloatArray) -> tuple[float, FloatArray]:
        """Return J and its gradient by the monomials."""
        planes = self._planes(self._table, monomials)
        value, gh, area, window, jumps = self._parts(planes, monomials)
        # J = A (GH + S / h): A, GH and h are sums over the nodes, S over the lines.
        by_area = gh + jumps / window
        by_window = -area * jumps / window**2
        seeds = np.stack(
            [
                area * self._weights,
                by_area * self._weights,
                np.zeros_like(self._weights),
                by_window * WINDOW * self._across,
            ]
        )
        gradient = np.tensordot(self._table, fairness_gradient(np.concatenate([planes, seeds])), 2)
        if len(self.grid.lines):
            below, above = (self._planes(side, monomials) for side in self._sides)
            (_, _, h_below, speed), (_, _, h_above, _) = fairness(below), fairness(above)
            weights = np.repeat(self.grid.weights_u, len(self.grid.lines)) * (area / window)
            jump = h_above - h_below
            zero = np.zeros_like(jump)
            seeds_below = np.stack([zero, zero, -2 * jump * speed * weights, jump**2 * weights])
            seeds_above = np.stack([zero, zero, 2 * jump * speed * weights, zero])
            for side, side_planes, side_seeds in zip(
                self._sides, (below, above), (seeds_below, seeds_above), strict=True
            ):
                adjoint = fairness_gradient(np.concatenate([side_planes, side_seeds]))
                gradient = gradient + np.tensordot(side, adjoint, 2)
        return value, gradient

    def _parts(self, planes: FloatArray, monomials: FloatArray) -> tuple[float, float, float, float, float]:
        """Return J, GH, area, window and the integral of squared jumps."""
        rough, element, _, speed = fairness(planes)
        gh, area = float(self._weights @ rough), float(self._weights @ element)
        window = WINDOW * float(self._across @ speed)
        jumps = 0.0
        if len(self.grid.lines):
            below, above = (fairness(self._planes(side, monomials)) for side in self._sides)
            weights = np.repeat(self.grid.weights_u, len(self.grid.lines))
            jumps = float(np.sum(weights * (above[2] - below[2]) ** 2 * below[3]))
        return area * (gh + jumps / window), gh, area, window, jumps

    @staticmethod
    def _planes(table: FloatArray, monomials: FloatArray) -> FloatArray:
        return np.asarray(np.tensordot(monomials, table, 1))


def _derivatives(
    problem: BlendProblem, layers: FloatArray, u: FloatArray, v: FloatArray, *, reverse: bool
) -> FloatArray:
    """Return the nine derivatives of each layer, shape (K, 27, len(u) * len(v)); `reverse` takes limits from below."""
    offsets = problem.form.offsets
    along = np.zeros((4, len(layers), len(problem.rows), len(v), 3))
    matrices: dict[tuple[int, bytes, int], SparseMatrix] = {}
    for i, row in enumerate(problem.rows):
        points = layers[:, offsets[i] : offsets[i + 1]].transpose(1, 0, 2).reshape(row.size, -1)
        at, knots = v, row.knots
        if reverse:
            points, knots = points[::-1], reversed_knots(row.knots)
            at = (row.knots[0] + row.knots[-1]) - v
        for order in range(min(3, row.degree) + 1):
            key = row.degree, row.knots.tobytes(), order
            if key not in matrices:
                matrices[key] = basis_matrix(row.degree - order, knots[order : len(knots) - order], at)
            derived = derivative_points(row.degree, knots, points, order)
            values = (matrices[key] @ derived).reshape(len(v), len(layers), 3)
            along[order, :, i] = values.transpose(1, 0, 2) * ((-1.0) ** order if reverse else 1.0)
    U = problem.form.u
    identity = np.eye(len(problem.rows))
    across = np.zeros((4, len(u), len(problem.rows)))
    for order in range(min(3, U.degree) + 1):
        knots = U.knots[order : len(U.knots) - order]
        across[order] = basis_matrix(U.degree - order, knots, u) @ derivative_points(U.degree, U.knots, identity, order)
    planes = [np.einsum("gi,kivd->kdgv", across[du], along[dv]).reshape(len(layers), 3, -1) for du, dv in _ORDERS]
    return np.concatenate(planes, axis=1)
