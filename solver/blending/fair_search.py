"""alpha^2, beta^2 and p2 of the fairest blend: least J = A * integral of |grad H|^2 dA within a window.

The least of all candidates and starts that were tried, never a proof: the measure is not convex.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.fairness_grid import NODES_U, ROUGH_U, Across, Along, across, along, rough_along
from semispline.solver.blending.fairness_table import LEAST_COSINE, LOOPS, FairnessTable
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.projected import Point, descend, unbound
from semispline.solver.errors import ComputationError

# Cells of the scan in each direction; more where the window is wider. It looks at half the nodes in u, where normals of
# neighbours may turn further, and where there are many spans not at each of them.
_CELLS, _WIDE_CELLS = 6, 8
_SCAN_SPANS = 8
_SCAN_COSINE = 0.0
# What is flat or a cylinder has J = 0 for every alpha: then the nearest to the arc's is taken. J of a visible shape is
# 10 to 1000.
_TIE = 0.1
_STARTS = 3
# Gradients of log J at the end of a start, and of the search.
_NEAR, _END = 0.02, 1e-4
# Parts of the way back to a start, where a finer grid refuses.
_BACK = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
# A grid of more nodes is not gone to without one between.
_LARGE = 2000
# Numbers in a block that is large for the C library.
_WORKSPACE = 2**21
# Longest steps of log alpha^2 and of p2 in its natural size; the distance of gradients whose difference is a Hessian.
_STEP, _STEP_P2, _DIFFERENCE = 0.35, 2.0, 1e-4
# J on twice as many nodes agrees to this fraction, or the search goes on there.
_SETTLED = 0.01


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
        Largest entry of the gradient of log J at the end, by logarithms of alpha^2 and by p2 in natural sizes, where no
        end of the window is met.
    tried : int
        Evaluations of J.
    refused : dict
        How many candidates were refused for each reason, "folds" and "loops".
    """

    a: float
    b: float
    p2: tuple[float, float]
    value: float
    slope: float
    tried: int
    refused: dict[str, int]


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns of a search: for each side logarithms of the end values of alpha^2, then p2, in natural sizes.

    Attributes
    ----------
    exponents : ndarray, shape (K, n)
        Of each monomial, 1 first, in alpha^2 and p2 of both sides.
    logarithmic : ndarray of bool, shape (n,)
    low, high : ndarray, shape (n,)
        Bounds, equal where there is nothing to choose.
    wanted : ndarray, shape (n,)
        Where the tie-break draws.
    """

    exponents: FloatArray
    logarithmic: NDArray[np.bool_]
    low: FloatArray
    high: FloatArray
    wanted: FloatArray

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


class _Objective:
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

    def gradients(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return values and gradients of candidates, shape (B, n)."""
        monomials, slopes = self.unknowns.monomials(y)
        measured, by_monomials = self.table.with_gradient(monomials)
        total = measured.values + self._tie(y)
        by_y = np.einsum("bnk,bk->bn", slopes, by_monomials) + 2 * _TIE * self._drawn * self._off(y)
        with np.errstate(invalid="ignore"):
            return self._counted(total, measured.refused), by_y / total[:, None]

    def __call__(self, y: FloatArray) -> tuple[float, FloatArray]:
        values, gradients = self.gradients(y[None])
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


def solve_fair(problem: BlendProblem) -> FairSolution:
    """Find the shape parameters of the fairest blend.

    Raises
    ------
    ComputationError
        Every candidate is refused, or what is left cannot be measured.
    """
    # Where a large block was freed, the C library keeps what is freed after it: else half of the time goes into pages.
    np.empty(_WORKSPACE)
    layers, exponents = problem.shape_layers()
    unknowns = make_unknowns(problem, exponents)
    u, rows = problem.form.u, problem.rows

    def grid(in_u: Across, in_v: Along, least_cosine: float = LEAST_COSINE) -> _Objective:
        return _Objective(unknowns, FairnessTable(problem, layers, in_u, in_v, least_cosine))

    # The tips of U-turns are sharp.
    rough = grid(across(u) if problem.exits.u_turn else across(u, ROUGH_U), rough_along(rows), _SCAN_COSINE)
    cells, values = _scan(rough, _WIDE_CELLS if problem.exits.u_turn else _CELLS)
    refused = dict(rough.refused)
    starts = _starts(cells, values)
    ends = [_descended(rough, rough.point(start), _NEAR) for start in starts]
    search, fine = grid(across(u), along(rows)), grid(across(u, 2 * NODES_U), along(rows, 2))
    between = grid(across(u, ROUGH_U), along(rows)) if search.table.size > _LARGE else None
    levels = [(level, tolerance) for level, tolerance in ((between, _NEAR), (search, _END)) if level is not None]
    found = None
    # A rough grid may be blind to what makes a candidate worse than another: the finer one says which is best.
    order = np.argsort(search.values(np.stack([end.x for end in ends])), kind="stable") if len(ends) > 1 else [0]
    for k in order:
        found = _settled(_refined(ends[k], starts[k], levels), starts[k], fine)
        if found is not None:
            break
    else:
        # What the rough grid let pass is refused: what else does the finer one let pass?
        kept = cells[np.isfinite(values.ravel())]
        start = kept[np.argmin(search.values(kept))]
        found = _settled(_refined(search.point(start), start, levels[-1:]), start, fine)
    if found is None:
        name = "folds" if fine.refused["folds"] + search.refused["folds"] else "runs a loop"
        raise ComputationError(
            f"the fairest blend found {name}; try another edge, another direction (flip), or a middle curve"
        )
    tried = sum(objective.tried for objective in (rough, between, search, fine) if objective is not None)
    return _solution(problem, unknowns, found, fine, tried, refused)


def make_unknowns(problem: BlendProblem, exponents: list[FloatArray]) -> Unknowns:
    """Return the unknowns of a problem; `exponents` are those of its layers, for each side a column per unknown."""
    widths = [powers.shape[1] for powers in exponents]
    table = np.zeros((1 + sum(len(powers) - 1 for powers in exponents), sum(widths)))
    logarithmic = np.ones(sum(widths), dtype=bool)
    low, high, wanted = (np.zeros(sum(widths)) for _ in range(3))
    row = 1
    for side, (powers, ends, unit) in enumerate(zip(exponents, problem.bounds, problem.natural, strict=True)):
        first = sum(widths[:side])
        part, p2 = slice(first, first + widths[side] - 1), first + widths[side] - 1
        table[row : row + len(powers) - 1, first : p2 + 1] = powers[1:]
        row += len(powers) - 1
        low[part], high[part] = np.log(np.array(ends) / unit)
        wanted[part] = np.log(problem.exits.arc)
        logarithmic[p2] = False
        # Where it is tied to alpha^2, and where contact needs none, no monomial has it.
        if powers[:, -1].any():
            most = problem.exits.arc / _second_weight(problem, side)
            low[p2], high[p2] = -most, most
    return Unknowns(table, logarithmic, low, high, wanted)


def _second_weight(problem: BlendProblem, side: int) -> float:
    """Return by how much p2 moves the third row of a contact, in |R_w|; that may be an arc's length."""
    degree, (first, second) = problem.form.u.degree, problem.contacts[side][2][:2]
    return first * second / (degree * (degree - 1))


def _scan(objective: _Objective, cells: int) -> tuple[FloatArray, FloatArray]:
    """Return the cells of the window, shape (B, n), and their values, one axis for each unknown that is scanned."""
    unknowns = objective.unknowns
    is_scanned = unknowns.logarithmic
    axes = [
        low + (high - low) * (np.arange(cells) + 0.5) / cells if low < high else np.array([low])
        for low, high in zip(unknowns.low[is_scanned], unknowns.high[is_scanned], strict=True)
    ]
    grids = np.meshgrid(*axes, indexing="ij")
    points = np.zeros((*grids[0].shape, len(unknowns.low)))
    points[..., is_scanned] = np.stack(grids, axis=-1)
    values = objective.values(points.reshape(-1, points.shape[-1])).reshape(points.shape[:-1])
    if not np.isfinite(values).any():
        reasons = " and ".join(
            f"{count} run loops" if name == "loops" else f"{count} fold"
            for name, count in objective.refused.items()
            if count
        )
        raise ComputationError(
            f"each of {values.size} candidates is refused: {reasons}; try another edge, another direction (flip), or a "
            "middle curve"
        )
    return points.reshape(-1, points.shape[-1]), values


def _starts(cells: FloatArray, values: FloatArray) -> FloatArray:
    """Return the cells where the values have local minima, best first, shape (B, n)."""
    padded = np.pad(values, 1, constant_values=np.inf)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3,) * values.ndim)
    minima = np.flatnonzero((values <= around.min(axis=tuple(range(-values.ndim, 0)))) & np.isfinite(values))
    # Ties keep the order of the cells: the search is the same at every run.
    return np.asarray(cells[minima[np.argsort(values.ravel()[minima], kind="stable")][:_STARTS]])


def _refined(end: Point, start: FloatArray, levels: list[tuple[_Objective, float]]) -> Point | None:
    """Go on from the end of a start, from grid to grid; none where a grid refuses all the way back to the start."""
    at: Point | None = end
    for objective, tolerance in levels:
        at = None if at is None else _admitted(objective, at, start)
        at = None if at is None else _descended(objective, at, tolerance)
    return at


def _settled(found: Point | None, start: FloatArray, fine: _Objective) -> Point | None:
    """Return what was found with its value on the finer grid, on which the search goes on where the values differ."""
    if found is None:
        return None
    value = float(fine.values(found.x[None])[0])
    if abs(value - found.value) <= _SETTLED:
        return replace(found, value=value)
    at = _admitted(fine, found, start)
    return None if at is None else _descended(fine, at, _END)


def _admitted(objective: _Objective, point: Point, start: FloatArray) -> Point | None:
    """Return a place on another grid, the model of the Hessian kept; back towards the start where it is refused."""
    for part in _BACK:
        at = objective.at(replace(point, x=point.x + part * (start - point.x)))
        if np.isfinite(at.value):
            return at
    return None


def _descended(objective: _Objective, start: Point, tolerance: float) -> Point:
    unknowns = objective.unknowns
    longest = np.where(unknowns.logarithmic, _STEP, _STEP_P2)
    return descend(objective, start, unknowns.low, unknowns.high, longest, tolerance)


def _solution(
    problem: BlendProblem, unknowns: Unknowns, found: Point, fine: _Objective, tried: int, refused: dict[str, int]
) -> FairSolution:
    a, b = (
        min(max(float(np.exp(found.x[k])) * unit, low), high)
        for k, unit, (low, high) in zip((0, 2), problem.natural, problem.bounds, strict=True)
    )
    p2_a, p2_b = (
        float(found.x[k]) * unit if second.free else second.at(alpha)
        for k, unit, second, alpha in zip((1, 3), problem.natural, problem.p2, (a, b), strict=True)
    )
    free = unbound(found.x, found.gradient, unknowns.low, unknowns.high)
    return FairSolution(
        a,
        b,
        (p2_a, p2_b),
        max(0.0, fine.j(found.x, found.value)),
        float(np.abs(found.gradient[free]).max(initial=0.0)),
        tried,
        refused,
    )
