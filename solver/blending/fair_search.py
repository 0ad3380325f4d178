"""alpha^2, beta^2 and p2 of the fairest blend: least J = A * integral of |grad H|^2 dA within a window.

The least of all candidates and starts that were tried, never a proof: the measure is not convex.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.fair_objective import FairObjective, Unknowns, make_unknowns
from semispline.solver.blending.fairness_grid import (
    HIGH_ORDER_NODES_U,
    NODES_U,
    ROUGH_U,
    Across,
    Along,
    across,
    along,
    rough_along,
)
from semispline.solver.blending.fairness_table import LEAST_COSINE, FairnessTable
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.projected import Point, descend, unbound
from semispline.solver.errors import ComputationError

# Cells of the scan in each direction; more where the window is wider. It looks at half the nodes in u, where normals of
# neighbours may turn further, and where there are many spans not at each of them.
_CELLS, _WIDE_CELLS = 6, 8
_SCAN_SPANS = 8
_SCAN_COSINE = 0.0
_STARTS = 3
# Gradients of log J at the end of a start, and of the search.
_NEAR, _END = 0.02, 1e-4
# Parts of the way back to a start, where a finer grid refuses.
_BACK = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
# A grid of more nodes is not gone to without one between.
_LARGE = 2000
# Numbers in a block that is large for the C library.
_WORKSPACE = 2**21
# Longest steps of log alpha^2 and of p2 in its natural size.
_STEP, _STEP_P2 = 0.35, 2.0
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

    def grid(in_u: Across, in_v: Along, least_cosine: float = LEAST_COSINE) -> FairObjective:
        return FairObjective(unknowns, FairnessTable(problem, layers, in_u, in_v, least_cosine))

    # The tips of U-turns are sharp.
    rough = grid(across(u, NODES_U) if problem.exits.u_turn else across(u, ROUGH_U), rough_along(rows), _SCAN_COSINE)
    cells, values = _scan(rough, _WIDE_CELLS if problem.exits.u_turn else _CELLS)
    refused = dict(rough.refused)
    starts = _starts(cells, values)
    ends = [_descended(rough, rough.point(start), _NEAR) for start in starts]
    nodes = HIGH_ORDER_NODES_U if max(problem.a.order, problem.b.order) > 2 else NODES_U
    search, fine = grid(across(u, nodes), along(rows)), grid(across(u, 2 * nodes), along(rows, 2))
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


def _scan(objective: FairObjective, cells: int) -> tuple[FloatArray, FloatArray]:
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


def _refined(end: Point, start: FloatArray, levels: list[tuple[FairObjective, float]]) -> Point | None:
    """Go on from the end of a start, from grid to grid; none where a grid refuses all the way back to the start."""
    at: Point | None = end
    for objective, tolerance in levels:
        at = None if at is None else _admitted(objective, at, start)
        at = None if at is None else _descended(objective, at, tolerance)
    return at


def _settled(found: Point | None, start: FloatArray, fine: FairObjective) -> Point | None:
    """Return what was found with its value on the finer grid, on which the search goes on where the values differ."""
    if found is None:
        return None
    value = float(fine.values(found.x[None])[0])
    if abs(value - found.value) <= _SETTLED:
        return replace(found, value=value)
    at = _admitted(fine, found, start)
    return None if at is None else _descended(fine, at, _END)


def _admitted(objective: FairObjective, point: Point, start: FloatArray) -> Point | None:
    """Return a place on another grid, the model of the Hessian kept; back towards the start where it is refused."""
    for part in _BACK:
        at = objective.at(replace(point, x=point.x + part * (start - point.x)))
        if np.isfinite(at.value):
            return at
    return None


def _descended(objective: FairObjective, start: Point, tolerance: float) -> Point:
    unknowns = objective.unknowns
    longest = np.where(unknowns.logarithmic, _STEP, _STEP_P2)
    return descend(objective, start, unknowns.low, unknowns.high, longest, tolerance)


def _solution(
    problem: BlendProblem, unknowns: Unknowns, found: Point, fine: FairObjective, tried: int, refused: dict[str, int]
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
