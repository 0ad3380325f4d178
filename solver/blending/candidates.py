"""Which layout of rows a fair blend takes: those that are tried, in order, and why each was taken or not.

The quintic without middle curve was best or within 5 % of the best of six layouts in nine of ten facing pairs, and best
on closed rims, where free rows pull circles together (docs/shapes.md).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

from semispline.solver.blending.linear_problem import WIDER, gap_ratio, try_linear_alpha
from semispline.solver.blending.problem import LOWER, BlendProblem, make_problem
from semispline.solver.blending.shape_parameters import Found, alpha_bounds, find_shape_parameters, found_fair
from semispline.solver.blending.sides import Side
from semispline.solver.errors import ComputationError, OptionError
from semispline.solver.options import AlphaV, BlendOptions

# A middle curve is tried where gap / |R_w| varies by this factor along a contact and alpha is constant all the same.
MIDDLE_RATIO = 2.0


@dataclass(frozen=True)
class Candidate:
    """A layout that was tried.

    Attributes
    ----------
    degree_u, middle_curves : int
    alpha_v : str
    fairness : float or None
        Area times integral of |grad H|^2; None where it was refused.
    verdict : str
        "chosen", or why not.
    """

    degree_u: int
    middle_curves: int
    alpha_v: str
    fairness: float | None
    verdict: str


@dataclass(frozen=True, eq=False)
class Layout:
    """A layout with what was found for it.

    Attributes
    ----------
    options : BlendOptions
        With nothing unsaid.
    problem : BlendProblem
    found : Found
    """

    options: BlendOptions
    problem: BlendProblem
    found: Found


def find_layout(a: Side, b: Side, said: BlendOptions) -> tuple[Layout, tuple[Candidate, ...]]:
    """Find the layout of a blend and its shape parameters.

    Raises
    ------
    ComputationError
        That of the first candidate, where all are refused.
    """
    first = said.decided()
    tried: list[tuple[BlendOptions, Layout | ComputationError]] = []

    def attempt(options: BlendOptions, low: float = 1.0) -> Layout | None:
        problem = _with_low_window(make_problem(a, b, options), low)
        try:
            result: Layout | ComputationError = Layout(options, problem, find_shape_parameters(problem, options))
        except ComputationError as refusal:
            if not _is_searched(problem, options):
                raise
            result = refusal
        tried.append((options, result))
        return result if isinstance(result, Layout) else None

    best = attempt(replace(first, alpha_v="constant") if "fair" in first.alphas else first)
    if best is not None and not _is_searched(best.problem, first):
        return best, ()
    if best is not None and first.box is None and _wants_less(best):
        best = _fairer(best, attempt(best.options, LOWER))
    doubtful = best is None or best.found.condoned or alpha_bounds(best.problem, best.found)
    if doubtful and said.degree_u == "auto" and first.degree_u == 5:
        best = _fairer(best, attempt(replace(first, degree_u=4, alpha_v="constant")))
    if best is None:
        raise cast("ComputationError", tried[0][1])
    best, linear = _with_linear_alpha(best, first.alpha_v)
    # What a linear alpha would follow, a middle curve follows less well; closed rims it would pull together.
    varies = best.options.alpha_v == "constant" and gap_ratio(best.problem) >= MIDDLE_RATIO
    varies = varies and best.problem.has_constant_weights
    if said.middle_curves == "auto" and varies:
        best = cast("Layout", _fairer(best, attempt(replace(first, middle_curves=1, alpha_v="constant"))))
    return best, (*(_candidate(options, result, best) for options, result in tried), *linear)


def _with_linear_alpha(constant: Layout, alpha_v: AlphaV) -> tuple[Layout, tuple[Candidate, ...]]:
    """Try alpha linear in v in the place of a constant one, and return what is taken, and the candidate if tried."""
    fair = constant.found.fair
    if fair is None or alpha_v == "constant" or not constant.problem.has_constant_weights:
        return constant, ()
    if alpha_v == "linear" and constant.problem.seam_order >= 0:
        raise OptionError("alpha_v: found linear on closed contacts, expected auto or constant")
    # A box that was asked for is not widened.
    wider = WIDER if constant.options.box is None else 1.0
    trial = try_linear_alpha(constant.problem, fair, always=alpha_v == "linear", wider=wider)
    if trial.problem is None or trial.solution is None:
        return constant, ()
    options = replace(constant.options, alpha_v="linear")
    tried = Layout(options, trial.problem, found_fair(trial.solution, constant.found.method))
    best = tried if trial.taken else constant
    verdict = "chosen" if trial.taken else trial.verdict
    return best, (replace(_candidate(options, tried, tried), verdict=verdict),)


def _wants_less(layout: Layout) -> bool:
    """Tell whether the lower end of a window stopped the search; U-turns end there for want of a better shape."""
    active = alpha_bounds(layout.problem, layout.found)
    return not layout.problem.exits.u_turn and any("lower" in name for name in active)


def _with_low_window(problem: BlendProblem, factor: float) -> BlendProblem:
    """Return the problem with windows that begin lower; what is given stays."""
    (low_a, high_a), (low_b, high_b) = problem.bounds
    a, b = (factor if free else 1.0 for free in problem.free)
    return problem if factor == 1 else replace(problem, bounds=((a * low_a, high_a), (b * low_b, high_b)))


def _is_searched(problem: BlendProblem, options: BlendOptions) -> bool:
    return any(problem.free) and "fair" in options.alphas


def _fairer(one: Layout | None, other: Layout | None) -> Layout | None:
    """Return the fairer layout; the first one where they are equal."""
    found = [layout for layout in (one, other) if layout is not None]
    return min(found, key=lambda layout: (len(layout.found.condoned), _fairness(layout)), default=None)


def _fairness(layout: Layout) -> float:
    return cast("float", layout.found.fairness)


def _loser(layout: Layout, best: Layout) -> str:
    """Say why a layout was not taken."""
    let_pass = set(layout.found.condoned) - set(best.found.condoned)
    if let_pass:
        return f"every candidate {' or '.join(sorted(let_pass))}"
    more = "is no less" if _fairness(layout) <= _fairness(best) else "is more"
    window = "" if layout.problem.bounds == best.problem.bounds else ", in another window"
    return f"fairness {_fairness(layout):.4g} {more}{window}"


def _candidate(options: BlendOptions, result: Layout | ComputationError, best: Layout) -> Candidate:
    fairness = _fairness(result) if isinstance(result, Layout) else None
    said = _loser(result, best) if isinstance(result, Layout) else str(result)
    verdict = "chosen" if result is best else said
    return Candidate(
        cast("int", options.degree_u), cast("int", options.middle_curves), options.alpha_v, fairness, verdict
    )
