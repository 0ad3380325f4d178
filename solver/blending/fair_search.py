"""alpha^2, beta^2 and p2 of the fairest blend: least J = A * integral of |grad H|^2 dA within a window.

The least of all candidates and starts that were tried, never a proof: the measure is not convex.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from math import log2

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
from semispline.solver.blending.fairness_table import FOLDS, LEAST_COSINE, LOOPS, FairnessTable, narrow_width
from semispline.solver.blending.linear_alpha import LinearInV
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.projected import MOST_STEPS, Point, descend, descend_abreast, unbound
from semispline.solver.errors import ComputationError

# Cells of the scan in each direction, at least, and for U-turns; one more for each factor of 2 by which the ends of the
# window are further apart than 16, up to the last. It looks at half the nodes in u, where normals of neighbours may
# turn further.
_CELLS, _WIDE_CELLS, _MOST_CELLS = 6, 8, 30
_SCAN_COSINE = 0.0
_STARTS = 3
# Gradients of log J at the end of a start, and of the search.
_NEAR, _END = 0.02, 1e-4
# What is refused, the first to be let pass first.
_REFUSABLE, _CONDONED = (FOLDS, LOOPS), ("folds", "loops")
MOST_CONDONED = len(_CONDONED)
# Steps on a grid where folds are let pass: J has no end there, and its slope none either.
_STEPS_AMONG_FOLDS = 12
# Parts of the way back to a start, where a finer grid refuses.
_BACK = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
# A grid of more nodes is not gone to without one between; where folds are let pass one of more than the second is not
# gone to at all.
_LARGE, _MOST_AMONG_FOLDS = 2000, 10_000
# Numbers in a block that is large for the C library.
_WORKSPACE = 2**22 - 2**12
# Longest steps of log alpha^2 and of p2 in its natural size.
_STEP, _STEP_P2 = 0.35, 2.0
# J on a finer grid agrees to this fraction, or the search goes on there; where it is off by more than the second,
# the coarser grid was blind, and so was what led to that place.
_SETTLED, _BLIND = 0.01, 0.2
# Finer grids have twice the nodes in u, and so many times those in v; from the second one on at most so many in all.
_FINER, _MOST = (2, 4, 8, 16), 60_000


@dataclass(frozen=True, eq=False)
class FairSolution:
    """What the search found.

    Attributes
    ----------
    a, b : float or (float, float)
        alpha^2 and beta^2, in the parameters of the bases; where linear in v the values at its start and its end.
    p2 : pair
        Numbers; where tied to a linear alpha^2 pairs of end values.
    value : float
        J, on the finest grid that was needed.
    slope : float
        Largest entry of the gradient of log J at the end, by logarithms of alpha^2 and by p2 in natural sizes, where no
        end of the window is met.
    tried : int
        Evaluations of J.
    refused : dict
        How many candidates were refused for each reason, "folds" and "loops".
    condoned : tuple of str
        What is no longer refused, because every cell that was tried was: "folds", then "loops" too.
    at_end : (bool, bool)
        Whether alpha^2 and beta^2 are at an end of their window.
    p2_ends : (str, str)
        "lower" or "upper" where a searched p2 is at that end of its range, else empty.
    stopped_by : str
        "fold" or "loop" where the last step was stopped by one, which is refused; the slope is then not small.
    settled : bool
        A finer grid changed J at the end by at most 1 %.
    """

    a: LinearInV
    b: LinearInV
    p2: tuple[LinearInV, LinearInV]
    value: float
    slope: float
    tried: int
    refused: dict[str, int]
    condoned: tuple[str, ...] = ()
    at_end: tuple[bool, bool] = (False, False)
    p2_ends: tuple[str, str] = ("", "")
    stopped_by: str = ""
    settled: bool = True


def solve_fair(
    problem: BlendProblem, known: FairSolution | None = None, most_condoned: int = MOST_CONDONED
) -> FairSolution:
    """Find the shape parameters of the fairest blend.

    Where the bases are so rough, or face each other so badly, that every cell that is tried is refused, the fairest is
    taken all the same, by what is refused as little as can be: what is wrong with it is measured on the finished
    surface, and said.

    Parameters
    ----------
    problem : BlendProblem
    known : FairSolution, optional
        That of a narrower window, or for constant alpha: the search starts from there, too.
    most_condoned : int
        How many of the reasons for a refusal, folds and loops, may be let pass: none that a better blend does without.

    Raises
    ------
    AllRefusedError
        No candidate is left, or can be measured.
    """
    refused: dict[str, int] = {}
    for count in range(most_condoned):
        try:
            found = _solved(problem, _REFUSABLE[count:], known)
            return replace(found, refused=refused or found.refused, condoned=_CONDONED[:count])
        except AllRefusedError as refusal:
            refused = refused or refusal.counts
    found = _solved(problem, _REFUSABLE[most_condoned:], known)
    return replace(found, refused=refused or found.refused, condoned=_CONDONED[:most_condoned])


class AllRefusedError(ComputationError):
    """Every candidate folds, runs loops, or cannot be measured."""

    def __init__(self, counts: dict[str, int]) -> None:
        reasons = " and ".join(f"{n} run loops" if name == "loops" else f"{n} fold" for name, n in counts.items() if n)
        self.counts = counts
        self.reasons = f"no candidate is left: {reasons or 'none can be measured'}"
        super().__init__(f"{self.reasons}; try another edge, another direction (flip), or a middle curve")


def _solved(problem: BlendProblem, refusable: tuple[int, ...], known: FairSolution | None = None) -> FairSolution:
    """Find them with what is refused; `AllRefusedError` where that leaves nothing."""
    # Where a large block was freed, the C library keeps what is freed after it: else half of the time goes into pages.
    np.empty(_WORKSPACE)
    layers, exponents = problem.shape_layers()
    unknowns = make_unknowns(problem, exponents)
    # A seam that perhaps is not C2 is a line.
    u, rows, narrow, seam = problem.form.u, problem.rows, narrow_width(problem), problem.seam_order in (0, 1)

    grids: list[FairObjective] = []

    def grid(in_u: Across, in_v: Along, least_cosine: float = LEAST_COSINE) -> FairObjective:
        grids.append(FairObjective(unknowns, FairnessTable(problem, layers, in_u, in_v, least_cosine, refusable)))
        return grids[-1]

    # The tips of U-turns are sharp.
    rough_u = across(u, NODES_U) if problem.exits.u_turn else across(u, ROUGH_U)
    rough = grid(rough_u, rough_along(rows, narrow), _SCAN_COSINE)
    cells, values = _scan(rough, _cells(problem))
    refused = dict(rough.refused)
    if known is None and not np.isfinite(values).any():
        raise AllRefusedError(refused)
    # Among folds one start will do: which of their valleys is deepest means little.
    count = _STARTS if FOLDS in refusable else 1
    starts = list(_starts(cells, values)[:count])
    # What is known of the same rows was found on finer grids: a rough one would only lead away from it, and what is no
    # better there hardly leads to another place.
    exact = None
    if known is not None:
        at = _known_start(problem, unknowns, known)
        if problem.linear == (None, None):
            starts = starts if known.condoned else _better(rough, starts, at)
            exact = len(starts)
        starts.append(at)
    points = [_with_finite_model(rough.point(start)) for start in starts]
    ends = _descended_abreast(rough, points[:exact], _NEAR) + ([] if exact is None else points[exact:])
    nodes = HIGH_ORDER_NODES_U if max(problem.a.order, problem.b.order) > 2 else NODES_U
    search = grid(across(u, nodes), along(rows, 1, narrow, seam=seam))

    @cache
    def finer(times: int) -> FairObjective:
        return grid(across(u, 2 * nodes), along(rows, times, narrow, seam=seam))

    times_v = _finer_times(search)
    between = grid(across(u, ROUGH_U), along(rows, 1, narrow, seam=seam)) if search.table.size > _LARGE else None
    levels = [(level, tolerance) for level, tolerance in ((between, _NEAR), (search, _END)) if level is not None]
    found = None
    # A rough grid may be blind to what makes a candidate worse than another: the finer one says which is best.
    order = np.argsort(search.values(np.stack([end.x for end in ends])), kind="stable") if len(ends) > 1 else [0]
    kept = cells[np.isfinite(values.ravel())]
    others = np.concatenate([kept, starts, [end.x for end in ends]])

    def gone_down(k: int) -> tuple[Point, bool] | None:
        at = _refined(ends[k], starts[k], levels[-1:] if k == exact else levels)
        return _settled(at, starts[k], finer, others, times_v)

    for k in order:
        found = gone_down(k)
        if found is not None:
            break
    if exact is not None and k != exact and found is not None:
        # What looked better than what is known may end up worse.
        again = gone_down(exact)
        found = again if again is not None and again[0].value < found[0].value else found
    if found is None and len(kept):
        # What the rough grid let pass is refused: what else does the finer one let pass?
        start = kept[np.argmin(search.values(kept))]
        found = _settled(_refined(search.point(start), start, levels[-1:]), start, finer, others, times_v)
    if found is None:
        raise AllRefusedError({name: refused[name] + finer(_FINER[0]).refused[name] for name in refused})
    solution = _solution(problem, unknowns, found[0], search, sum(objective.tried for objective in grids), refused)
    # The finest of the grids that refuse the place says why.
    shut = [] if found[0].shut is None else [objective.refusal(found[0].shut) for objective in reversed(grids)]
    return replace(solution, settled=found[1], stopped_by=next(filter(None, shut), ""))


def _finer_times(search: FairObjective) -> tuple[int, ...]:
    """Return how many times the nodes in v finer grids have; where a surface folds J has no end that would settle."""
    if FOLDS in search.table.refusable:
        return _FINER
    return _FINER[:1] if 4 * search.table.size <= _MOST_AMONG_FOLDS else ()


def _cells(problem: BlendProblem) -> int:
    """Return how many cells a scan has in each direction: they are of one size in log alpha^2, however wide a window.

    The wider windows of the ends of a linear alpha^2 have those of its constant.
    """
    ratio = max(high / low for low, high in problem.bounds)
    least = _WIDE_CELLS if problem.exits.u_turn else _CELLS
    return min(max(least, _CELLS + round(log2(ratio / 16))), _MOST_CELLS)


def _scan(objective: FairObjective, cells: int) -> tuple[FloatArray, FloatArray]:
    """Return the cells of the window, shape (B, n), and their values, with one axis for both ends of each side."""
    unknowns = objective.unknowns
    parts = [(np.arange(cells) + 0.5) / cells if unknowns.is_free(side) else np.zeros(1) for side in (0, 1)]
    points = np.zeros((len(parts[0]), len(parts[1]), len(unknowns.low)))
    for side, part in enumerate(np.meshgrid(*parts, indexing="ij")):
        ends = unknowns.ends[side]
        points[..., ends] = unknowns.low[ends] + part[..., None] * (unknowns.high - unknowns.low)[ends]
    values = objective.values(points.reshape(-1, points.shape[-1])).reshape(points.shape[:-1])
    return points.reshape(-1, points.shape[-1]), values


def _starts(cells: FloatArray, values: FloatArray) -> FloatArray:
    """Return the cells where the values have local minima, best first, shape (B, n)."""
    padded = np.pad(values, 1, constant_values=np.inf)
    around = np.lib.stride_tricks.sliding_window_view(padded, (3,) * values.ndim)
    minima = np.flatnonzero((values <= around.min(axis=tuple(range(-values.ndim, 0)))) & np.isfinite(values))
    # Ties keep the order of the cells: the search is the same at every run.
    return np.asarray(cells[minima[np.argsort(values.ravel()[minima], kind="stable")][:_STARTS]])


def _better(objective: FairObjective, starts: list[FloatArray], than: FloatArray) -> list[FloatArray]:
    """Return the starts that are better than a place."""
    limit, *values = objective.values(np.stack([than, *starts]))
    return [start for start, value in zip(starts, values, strict=True) if value < limit]


def _refined(end: Point, start: FloatArray, levels: list[tuple[FairObjective, float]]) -> Point | None:
    """Go on from the end of a start, from grid to grid; none where a grid refuses all the way back to the start."""
    at: Point | None = end
    for objective, tolerance in levels:
        at = None if at is None else _admitted(objective, at, start)
        at = None if at is None else _descended(objective, at, tolerance)
    return at


def _settled(
    found: Point | None,
    start: FloatArray,
    finer: Callable[[int], FairObjective],
    others: FloatArray,
    times_v: tuple[int, ...] = _FINER,
) -> tuple[Point, bool] | None:
    """Return what was found with its value on a finer grid, and whether that settled it.

    Where the values differ, the search goes on on the finer grid, until the next one agrees. Where they differ by much,
    it goes on from the best there of all places that were looked at, `others`.
    """
    at = found
    for times in times_v:
        if at is None:
            return None
        fine = finer(times)
        value = float(fine.values(at.x[None])[0])
        if abs(value - at.value) <= _SETTLED:
            return replace(at, value=value), True
        if np.isfinite(value) and abs(value - at.value) > _BLIND:
            ranked = fine.values(others)
            best = int(np.argmin(ranked))
            if ranked[best] < value:
                at, start = fine.point(others[best]), others[best]
        at = _admitted(fine, at, start)
        at = None if at is None else _descended(fine, at, _END)
        if 2 * fine.table.size > _MOST:
            break
    return None if at is None else (at, False)


def _admitted(objective: FairObjective, point: Point, start: FloatArray) -> Point | None:
    """Return a place on another grid, the model of the Hessian kept; back towards the start where it is refused."""
    for part in _BACK:
        at = objective.at(replace(point, x=point.x + part * (start - point.x)))
        if np.isfinite(at.value):
            return at
    return None


def _descended(objective: FairObjective, start: Point, tolerance: float) -> Point:
    return descend(objective, start, *_limits(objective, tolerance))


def _descended_abreast(objective: FairObjective, starts: list[Point], tolerance: float) -> list[Point]:
    return descend_abreast(objective.gradients, starts, *_limits(objective, tolerance))


def _limits(objective: FairObjective, tolerance: float) -> tuple[FloatArray, FloatArray, FloatArray, float, int]:
    """Return bounds, longest steps, tolerance and most steps of a way down."""
    unknowns = objective.unknowns
    longest = np.where(unknowns.logarithmic, _STEP, _STEP_P2)
    most = MOST_STEPS if FOLDS in objective.table.refusable else _STEPS_AMONG_FOLDS
    return unknowns.low, unknowns.high, longest, tolerance, most


def _with_finite_model(point: Point) -> Point:
    """Return a place with a model that can be used: what is known from elsewhere may have no value on another grid."""
    if np.isfinite(point.hessian).all() and np.isfinite(point.gradient).all():
        return point
    return replace(point, gradient=np.zeros_like(point.x), hessian=np.eye(len(point.x)))


def _solution(
    problem: BlendProblem, unknowns: Unknowns, found: Point, fine: FairObjective, tried: int, refused: dict[str, int]
) -> FairSolution:
    (a, p2_a), (b, p2_b) = (_side_values(problem, unknowns, found.x, side) for side in (0, 1))
    free = unbound(found.x, found.gradient, unknowns.low, unknowns.high)
    return FairSolution(
        a,
        b,
        (p2_a, p2_b),
        max(0.0, fine.j(found.x, found.value)),
        float(np.abs(found.gradient[free]).max(initial=0.0)),
        tried,
        refused,
        at_end=(_is_at_end(unknowns, found.x, 0), _is_at_end(unknowns, found.x, 1)),
        p2_ends=(_p2_end(unknowns, found.x, 0), _p2_end(unknowns, found.x, 1)),
    )


def _is_at_end(unknowns: Unknowns, y: FloatArray, side: int) -> bool:
    ends = unknowns.ends[side]
    low, high = unknowns.low[ends], unknowns.high[ends]
    # 1e-9: what `active_bounds` takes for rounding.
    return bool(np.any((low < high) & ((y[ends] <= low + 1e-9) | (y[ends] >= high - 1e-9))))


def _p2_end(unknowns: Unknowns, y: FloatArray, side: int) -> str:
    p2 = unknowns.ends[side].stop
    low, high = unknowns.low[p2], unknowns.high[p2]
    if low == high:
        return ""
    # 1e-9: as of alpha^2.
    return "lower" * bool(y[p2] <= low + 1e-9) or "upper" * bool(y[p2] >= high - 1e-9)


def _side_values(problem: BlendProblem, unknowns: Unknowns, y: FloatArray, side: int) -> tuple[LinearInV, LinearInV]:
    """Return alpha^2 and p2 of a side."""
    unit, second, linear = problem.natural[side], problem.p2[side], problem.linear[side]
    if not problem.free[side]:
        given = problem.given[side]
        return given, second.at(given)
    bounds = (problem.bounds[side],) if linear is None else linear.bounds
    ends = [
        min(max(float(np.exp(x)) * unit, low), high)
        for x, (low, high) in zip(y[unknowns.ends[side]], bounds, strict=True)
    ]
    value: LinearInV = ends[0] if linear is None else (ends[0], ends[1])
    return value, float(y[unknowns.ends[side].stop]) * unit if second.free else second.at(value)


def _known_start(problem: BlendProblem, unknowns: Unknowns, known: FairSolution) -> FloatArray:
    """Return the unknowns at what was found in a narrower window, or for a constant alpha."""
    y = np.zeros(len(unknowns.low))
    for side, (value, second) in enumerate(zip((known.a, known.b), known.p2, strict=True)):
        if problem.free[side]:
            y[unknowns.ends[side]] = np.log(np.array(value) / problem.natural[side])
            if problem.p2[side].free:
                y[unknowns.ends[side].stop] = np.array(second).mean() / problem.natural[side]
    return np.clip(y, unknowns.low, unknowns.high)
