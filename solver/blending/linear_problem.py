"""Problems whose alpha^2 is linear in v: when they are worth it, and how they are made of those with a constant."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.fair_search import AllRefusedError, FairSolution, solve_fair
from semispline.solver.blending.gram import EnergyForm
from semispline.solver.blending.linear_alpha import LinearEnds, raised_basis
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.splines import Basis

# It is tried where gap / |R_w| varies by this factor along a contact, and taken where the measure falls to this share:
# it has half as many control points again, and 2.3 times as many in an ordinary B-spline.
TRIED_RATIO, TAKEN_SHARE = 1.5, 0.7
# Ends of the linear function that follows gap / |R_w|, over its mean, are at least this.
_LEAST_SHAPE = 0.25
# The window of an end is so much wider than that of a constant, at its top and at its foot: one end gives way to the
# other.
WIDER = 2.0
# Where gap / |R_w| is compared.
_PLACES = np.arange(65) / 64


def gap_ratio(problem: BlendProblem) -> float:
    """Return the largest over the smallest gap / |R_w| along the contact, of the side where it varies more.

    1 where neither side has a shape parameter, or the contacts are closed: there alpha is constant.
    """
    if problem.seam_order >= 0:
        return 1.0
    ratios = [1.0]
    for index in (0, 1):
        if problem.free[index]:
            sizes = _natural_along(problem, index)
            # Contacts that touch somewhere have no ratio: any that is too large says so.
            with np.errstate(over="ignore"):
                ratios.append(float(sizes.max() / max(sizes.min(), np.finfo(float).tiny)))
    return max(ratios)


def with_linear_alpha(problem: BlendProblem, wider: float = WIDER) -> BlendProblem:
    """Return the problem with alpha^2 linear in v wherever it is searched.

    Each end has a window of its own, around the linear function that fits gap / |R_w| best, and by a factor wider.
    """
    linear = list(problem.linear)
    rows, scaled = list(problem.rows), list(problem.form.rows)
    for index, (side, indices, _) in enumerate(problem.contacts):
        if problem.free[index]:
            linear[index] = _fitted(problem, index, wider)
            for r in range(side.order + 1):
                i = indices[r]
                rows[i], scaled[i] = raised_basis(rows[i], r), raised_basis(scaled[i], r)
    form = EnergyForm(problem.form.u, tuple(scaled))
    return replace(problem, form=form, rows=tuple(rows), linear=(linear[0], linear[1]))


def _fitted(problem: BlendProblem, index: int, wider: float) -> LinearEnds:
    sizes = _natural_along(problem, index)
    slope, start = np.polyfit(_PLACES, sizes / sizes.mean(), 1)
    shape = max(float(start), _LEAST_SHAPE), max(float(start + slope), _LEAST_SHAPE)
    low, high = problem.bounds[index][0] / wider, problem.bounds[index][1] * wider
    return LinearEnds(((low * shape[0], high * shape[0]), (low * shape[1], high * shape[1])), shape)


def _natural_along(problem: BlendProblem, index: int) -> FloatArray:
    """Return gap / |R_w| along the contact."""
    sides = problem.a, problem.b
    basis: Basis = sides[0].along
    v = np.linspace(basis.knots[0], basis.knots[-1], len(_PLACES))
    edges = [side.edge(v) for side in sides]
    gap = np.linalg.norm(edges[0][0] - edges[1][0], axis=1)
    across = edges[index][1] * (sides[index].degree / sides[index].spans[0])
    return np.asarray(gap / np.maximum(np.linalg.norm(across, axis=1), np.finfo(float).tiny))


@dataclass(frozen=True, eq=False)
class LinearTrial:
    """What a linear alpha^2 came to beside a constant one.

    Attributes
    ----------
    problem : BlendProblem or None
        That with a linear alpha^2; none where it was not tried.
    solution : FairSolution or None
    taken : bool
    verdict : str
        Why, or why not.
    """

    problem: BlendProblem | None
    solution: FairSolution | None
    taken: bool
    verdict: str


def try_linear_alpha(
    problem: BlendProblem, constant: FairSolution, *, always: bool = False, wider: float = WIDER
) -> LinearTrial:
    """Try a linear alpha^2 where the gap varies along the contact, and take it where it is worth its control points.

    Where a refusal stopped the search for a constant one, it is tried too, and taken where none stops it and it is
    fairer.

    Parameters
    ----------
    problem : BlendProblem
    constant : FairSolution
    always : bool
        Try and take it wherever the contacts are open.
    wider : float
        How much wider the windows of its ends are than that of a constant.
    """
    if problem.seam_order >= 0:
        return LinearTrial(None, None, False, "contacts are closed: alpha has to be constant along them")
    ratio = gap_ratio(problem)
    if ratio < TRIED_RATIO and not always and not constant.stopped_by:
        return LinearTrial(None, None, False, f"gap over speed varies by {ratio:.3g} along the contact, not tried")
    linear = with_linear_alpha(problem, wider)
    try:
        solution = solve_fair(linear, constant, len(constant.condoned))
    except AllRefusedError as refusal:
        return LinearTrial(linear, None, False, refusal.reasons)
    share = solution.value / constant.value if constant.value > 0 else 1.0
    pays = share <= TAKEN_SHARE or always or len(solution.condoned) < len(constant.condoned)
    if pays or (constant.stopped_by and not solution.stopped_by and share < 1):
        return LinearTrial(linear, solution, True, f"fairness is {share:.3g} of that with a constant alpha")
    return LinearTrial(
        linear, solution, False, f"fairness is {share:.3g} of that with a constant alpha, {TAKEN_SHARE} would pay"
    )
