"""alpha^2, beta^2 and p2 of the fairest blend: least J = A * integral of |grad H|^2 dA within a window.

The least of all candidates and starts that were tried, never a proof: the measure is not convex.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.fairness_table import FairnessTable, make_grid
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.errors import ComputationError

# Cells of the scan in each direction; more where the window is wider.
_CELLS, _WIDE_CELLS = 6, 8
# What is flat or a cylinder has J = 0 for every alpha: then the nearest to the arc's is taken. J of a visible shape is
# 10 to 1000.
_TIE = 0.1
_STARTS = 3
# J on twice as many nodes agrees to this fraction, or the search goes on there.
_SETTLED = 0.01
# A line search steps back from it.
_NO_NUMBER = 1e3


@dataclass(frozen=True, eq=False)
class FairSolution:
    """What the search found.

    Attributes
    ----------
    a, b : float
        alpha^2 and beta^2, in the parameters of the bases.
    p2 : (float, float)
    value : float
        J, on the finer grid.
    slope : float
        Largest entry of the gradient of log J at the end, by logarithms of alpha^2, where no end of the window is met.
    tried : int
        Evaluations of J.
    refused : int
        Candidates of the scan that fold.
    """

    a: float
    b: float
    p2: tuple[float, float]
    value: float
    slope: float
    tried: int
    refused: int


class _Objective:
    """log(J + tie-break) of y = (log alpha^2 / natural .., p2 / natural ..), with its gradient."""

    def __init__(self, problem: BlendProblem, table: FairnessTable, exponents: list[FloatArray]) -> None:
        self.arc, self.table, self.exponents = problem.exits.arc, table, exponents
        self.free = np.flatnonzero(problem.free)
        self.tried = 0

    def monomials(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the monomials and their derivatives by y, shapes (K,) and (len(y), K)."""
        values, slopes = [1.0], [np.zeros(len(y))]
        for side, exponents in enumerate(self.exponents):
            x, z = np.exp(y[2 * side]), y[2 * side + 1]
            for i, j in exponents[1:].tolist():
                value = x**i * z**j
                slope = np.zeros(len(y))
                slope[2 * side] = i * value
                slope[2 * side + 1] = j * x**i * z ** (j - 1) if j else 0.0
                values.append(value)
                slopes.append(slope)
        return np.array(values), np.array(slopes).T

    def value(self, y: FloatArray) -> float:
        """Return log(J + tie-break); infinite where the blend folds."""
        self.tried += 1
        total = self.table.value(self.monomials(y)[0]) + self._tie(y)
        return float(np.log(total)) if np.isfinite(total) else np.inf

    def _tie(self, y: FloatArray) -> float:
        return _TIE * (1 + float(np.sum(self._off(y) ** 2)))

    def _off(self, y: FloatArray) -> FloatArray:
        off = np.zeros(len(y))
        off[2 * self.free] = y[2 * self.free] - np.log(self.arc)
        return off

    def __call__(self, y: FloatArray) -> tuple[float, FloatArray]:
        self.tried += 1
        monomials, slopes = self.monomials(y)
        value, gradient = self.table.measured(monomials)
        total = value + self._tie(y)
        if not np.isfinite(total):
            return _NO_NUMBER, np.zeros(len(y))
        return float(np.log(total)), np.asarray((slopes @ gradient + 2 * _TIE * self._off(y)) / total)


def solve_fair(problem: BlendProblem) -> FairSolution:
    """Find the shape parameters of the fairest blend.

    Raises
    ------
    ComputationError
        Every candidate folds.
    """
    layers, exponents = problem.shape_layers()
    objective = _Objective(problem, FairnessTable(problem, layers, make_grid(problem)), exponents)
    bounds = [
        (float(np.log(low / unit)), float(np.log(high / unit)))
        for (low, high), unit in zip(problem.bounds, problem.natural, strict=True)
    ]
    starts, refused = _scan(objective, bounds, _WIDE_CELLS if problem.exits.u_turn else _CELLS)
    best = min((_descend(objective, start, bounds) for start in starts), key=lambda found: found[0])
    second_order = [second.free for second in problem.p2]
    if any(second_order):
        best = min(best, _descend(objective, best[1], bounds, second_order), key=lambda found: found[0])
    fine = _Objective(problem, FairnessTable(problem, layers, make_grid(problem, 2)), exponents)
    if abs(fine(best[1])[0] - best[0]) > _SETTLED or fine.table.folds(fine.monomials(best[1])[0]):
        best = _descend(fine, best[1], bounds, second_order)
    if fine.table.folds(fine.monomials(best[1])[0]):
        raise ComputationError(
            "the fairest blend folds: every alpha in the window does; try another edge, direction or a middle curve"
        )
    y = best[1]
    gradient = fine(y)[1]
    inside = [2 * s for s in (0, 1) if bounds[s][0] + 1e-9 < y[2 * s] < bounds[s][1] - 1e-9]
    a, b = (
        min(max(float(np.exp(x)) * unit, low), high)
        for x, unit, (low, high) in zip((y[0], y[2]), problem.natural, problem.bounds, strict=True)
    )
    p2_a, p2_b = (
        float(x) * unit if second.free else second.at(alpha)
        for x, unit, second, alpha in zip((y[1], y[3]), problem.natural, problem.p2, (a, b), strict=True)
    )
    return FairSolution(
        a,
        b,
        (p2_a, p2_b),
        fine.table.value(fine.monomials(y)[0]),
        float(np.abs(gradient[inside]).max(initial=0.0)),
        objective.tried + fine.tried,
        refused,
    )


def _scan(objective: _Objective, bounds: list[tuple[float, float]], cells: int) -> tuple[list[FloatArray], int]:
    """Return where J has local minima over the cells of the window, best first, and how many cells were refused."""
    axes = [
        low + (high - low) * (np.arange(cells) + 0.5) / cells if low < high else np.array([low]) for low, high in bounds
    ]
    values = np.full((len(axes[0]), len(axes[1])), np.inf)
    points: dict[tuple[int, int], FloatArray] = {}
    for i, x in enumerate(axes[0].tolist()):
        for j, y in enumerate(axes[1].tolist()):
            points[i, j] = np.array([x, 0.0, y, 0.0])
            values[i, j] = objective.value(points[i, j])
    refused = int(np.isinf(values).sum())
    if refused == values.size:
        raise ComputationError(
            f"each of {refused} candidates folds; try another edge, another direction (flip), or a middle curve"
        )
    minima = [at for at in points if np.isfinite(values[at]) and values[at] <= _around(values, at)]
    # Ties keep the order of the cells: the search is the same at every run.
    return [points[at] for at in sorted(minima, key=lambda at: float(values[at]))[:_STARTS]], refused


def _around(values: FloatArray, at: tuple[int, int]) -> float:
    i, j = at
    return float(values[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2].min())


def _descend(
    objective: _Objective,
    start: FloatArray,
    bounds: list[tuple[float, float]],
    with_p2: list[bool] | None = None,
) -> tuple[float, FloatArray]:
    """Return the least value found from a start, and where."""
    unknown: NDArray[np.intp] = np.array(
        [2 * s for s in (0, 1) if bounds[s][0] < bounds[s][1]]
        + ([2 * s + 1 for s in (0, 1) if with_p2[s]] if with_p2 else []),
        dtype=np.intp,
    )

    def function(z: FloatArray) -> tuple[float, FloatArray]:
        y = start.copy()
        y[unknown] = z
        value, gradient = objective(y)
        return value, gradient[unknown]

    limits = [bounds[k // 2] if k % 2 == 0 else (None, None) for k in unknown.tolist()]
    found = minimize(function, start[unknown], jac=True, method="L-BFGS-B", bounds=limits, options={"gtol": 1e-6})
    end = start.copy()
    end[unknown] = found.x
    first = objective(start)[0]
    return (float(found.fun), end) if found.fun <= first else (first, start)
