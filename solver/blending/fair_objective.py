"""What the fair search minimises, with its gradient: log(J + tie-break), by log alpha^2, log beta^2 and p2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.fairness_table import LOOPS, FairnessTable
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.projected import Point
from semispline.solver.blending.windows import second_weight

# What is flat or a cylinder has J = 0 for every alpha: then the nearest to the arc's is taken. J of a visible shape is
# 10 to 1000.
_TIE = 0.1
# The distance of gradients whose difference is a Hessian.
_DIFFERENCE = 1e-4


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns of a search: for each side logarithms of the end values of alpha^2, then p2, in natural sizes.

    Attributes
    ----------
    exponents : ndarray, shape (K, n)
        Of each monomial, 1 first, in alpha^2 and p2 of both sides.
    logarithmic : ndarray of bool, shape (n,)
    ends : pair of slices
        Where the end values of each side are; its p2 comes next.
    low, high : ndarray, shape (n,)
        Bounds, equal where there is nothing to choose.
    wanted : ndarray, shape (n,)
        Where the tie-break draws.
    """

    exponents: FloatArray
    logarithmic: NDArray[np.bool_]
    ends: tuple[slice, slice]
    low: FloatArray
    high: FloatArray
    wanted: FloatArray

    def is_free(self, side: int) -> bool:
        """Whether there is an alpha^2 to choose."""
        return bool((self.low < self.high)[self.ends[side]].any())

    def monomials(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the monomials of candidates y, shape (B, n), and their derivatives: shapes (B, K) and (B, n, K)."""
        x = np.where(self.logarithmic, np.exp(np.where(self.logarithmic, y, 0.0)), y)[:, None]
        powers = x**self.exponents
        values = powers.prod(axis=2)
        slopes = np.empty((len(y), y.shape[1], values.shape[1]))
        for k, logarithmic in enumerate(self.logarithmic.tolist()):
            of = self.exponents[:, k]
            if logarithmic:
                slopes[:, k] = of * values
            else:
                rest = np.delete(powers, k, axis=2).prod(axis=2)
                slopes[:, k] = of * x[:, :, k] ** np.maximum(of - 1, 0) * rest
        return values, slopes


def make_unknowns(problem: BlendProblem, exponents: list[FloatArray]) -> Unknowns:
    """Return the unknowns of a problem; `exponents` are those of its layers, for each side a column per unknown."""
    widths = [powers.shape[1] for powers in exponents]
    table = np.zeros((1 + sum(len(powers) - 1 for powers in exponents), sum(widths)))
    logarithmic = np.ones(sum(widths), dtype=bool)
    low, high, wanted = (np.zeros(sum(widths)) for _ in range(3))
    row, ends_of = 1, []
    for side, (powers, unit) in enumerate(zip(exponents, problem.natural, strict=True)):
        linear = problem.linear[side]
        ends, shape = ((problem.bounds[side],), (1.0,)) if linear is None else (linear.bounds, linear.shape)
        first = sum(widths[:side])
        part, p2 = slice(first, first + widths[side] - 1), first + widths[side] - 1
        table[row : row + len(powers) - 1, first : p2 + 1] = powers[1:]
        row += len(powers) - 1
        ends_of.append(part)
        if len(powers) > 1:
            low[part], high[part] = np.log(np.array(ends) / unit).T
            wanted[part] = np.log(problem.exits.arc * np.array(shape))
        logarithmic[p2] = False
        # Where it is tied to alpha^2, and where contact needs none, no monomial has it.
        if powers[:, -1].any():
            # A change by an arc's length.
            most = problem.exits.arc / second_weight(problem.form.u.degree, problem.contacts[side][2])
            low[p2], high[p2] = -most, most
    return Unknowns(table, logarithmic, (ends_of[0], ends_of[1]), low, high, wanted)


class FairObjective:
    """log(J + tie-break) on one grid, with its gradient; infinite where a candidate is refused."""

    def __init__(self, unknowns: Unknowns, table: FairnessTable) -> None:
        self.unknowns, self.table = unknowns, table
        self.tried = 0
        self.refused = {"folds": 0, "loops": 0}
        # p2 is drawn nowhere, and neither is what is not free.
        self._drawn = np.where(unknowns.logarithmic & (unknowns.low < unknowns.high), 1.0, 0.0)

    def values(self, y: FloatArray) -> FloatArray:
        """Return the values of candidates, shape (B, n)."""
        measured = self.table.measure(self.unknowns.monomials(y)[0])
        return self._counted(measured.values + self._tie(y), measured.refused)

    def gradients(self, y: FloatArray, *, everywhere: bool = True) -> tuple[FloatArray, FloatArray]:
        """Return values and gradients of candidates, shape (B, n); gradients where they are refused, too, if wanted."""
        monomials, slopes = self.unknowns.monomials(y)
        measured, by_monomials = self.table.with_gradient(monomials, everywhere=everywhere)
        total = measured.values + self._tie(y)
        by_y = np.einsum("bnk,bk->bn", slopes, by_monomials) + 2 * _TIE * self._drawn * self._off(y)
        with np.errstate(invalid="ignore"):
            return self._counted(total, measured.refused), by_y / total[:, None]

    def __call__(self, y: FloatArray) -> tuple[float, FloatArray]:
        """Return value and gradient of one candidate; where it is refused the value is infinite, whatever the slope."""
        values, gradients = self.gradients(y[None], everywhere=False)
        return float(values[0]), gradients[0]

    def point(self, y: FloatArray) -> Point:
        """Return value, gradient and Hessian, the latter from differences of gradients."""
        free = np.flatnonzero(self.unknowns.low < self.unknowns.high)
        values, gradients = self.gradients(np.concatenate([y[None], y + _DIFFERENCE * np.eye(len(y))[free]]))
        hessian = np.eye(len(y))
        between = (gradients[1:] - gradients[0]) / _DIFFERENCE
        hessian[np.ix_(free, free)] = (between[:, free] + between[:, free].T) / 2
        return Point(y, float(values[0]), gradients[0], hessian)

    def at(self, point: Point) -> Point:
        """Return a place on another grid, with the model of the Hessian that is known."""
        value, gradient = self(point.x)
        return Point(point.x, value, gradient, point.hessian)

    def refusal(self, y: FloatArray) -> str:
        """Return why a place has no value: "fold" or "loop"; nothing where it has one."""
        measured = self.table.measure(self.unknowns.monomials(y[None])[0])
        if int(measured.refused[0]) == LOOPS:
            return "loop"
        return "" if measured.refused[0] == 0 and np.isfinite(measured.values[0]) else "fold"

    def j(self, y: FloatArray, value: float) -> float:
        """Return J of a candidate whose value is known."""
        return float(np.exp(value) - self._tie(y[None])[0])

    def _off(self, y: FloatArray) -> FloatArray:
        return y - self.unknowns.wanted

    def _tie(self, y: FloatArray) -> FloatArray:
        return np.asarray(_TIE * (1 + self._off(y) ** 2 @ self._drawn))

    def _counted(self, total: FloatArray, refused: NDArray[np.int8]) -> FloatArray:
        self.tried += len(total)
        broken = (refused != 0) | ~np.isfinite(total)
        loops = int(np.sum(refused == LOOPS))
        self.refused["loops"] += loops
        self.refused["folds"] += int(broken.sum()) - loops
        with np.errstate(invalid="ignore"):
            return np.where(broken, np.inf, np.log(np.where(broken, 1.0, total)))
