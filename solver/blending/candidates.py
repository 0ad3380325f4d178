"""Which layout of rows a fair blend takes: those that are tried, in order, and why each was taken or not.

The fairer of the quintics without and with one middle curve was best or within 5 % of the best of six layouts in nine
of ten facing pairs. On U-turns and on closed rims, where free rows pull circles together, the one without was
(docs/shapes.md).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import cast

from semispline.solver.blending.fair_search import MOST_CONDONED, AllRefusedError, FairSolution
from semispline.solver.blending.linear_problem import TRIED_RATIO, WIDER, gap_ratio, try_linear_alpha
from semispline.solver.blending.problem import BlendProblem, make_problem
from semispline.solver.blending.shape_parameters import Found, alpha_bounds, find_shape_parameters, found_fair
from semispline.solver.blending.sides import Side
from semispline.solver.blending.windows import LOWER, SecondParameter
from semispline.solver.errors import ComputationError, OptionError
from semispline.solver.options import AlphaV, BlendOptions

# A p2 that leads to an end of the window is left out where that leads away from it, and fairness grows to at most this
# multiple.
WITHOUT_P2 = 1.1
# A middle curve is taken where fairness falls to this share: it has a sixth as many control points again.
MIDDLE_SHARE = 0.95
# At an end of its window the best one falls by a third at most in a lower window: a middle curve with this share of it
# needs no such search beside it.
MUCH_FAIRER = 0.5
QUINTIC = 5
# Where it wins seldom it is tried where gap / |R_w| varies by this factor along a contact, alpha constant all the same.
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


@dataclass(frozen=True, eq=False)
class _Tried:
    """An attempt: its options, what came of it, and how it differs from what the options say."""

    options: BlendOptions
    result: Layout | ComputationError
    remark: str = ""


# Options, problem, what is known, a remark.
_Search = Callable[..., Layout | None]
_TwoP2 = tuple[SecondParameter, SecondParameter]


def find_layout(a: Side, b: Side, said: BlendOptions) -> tuple[Layout, tuple[Candidate, ...]]:
    """Find the layout of a blend and its shape parameters.

    Raises
    ------
    ComputationError
        That of the first candidate, where all are refused.
    """
    first = said.decided()
    tried: list[_Tried] = []

    def search(
        options: BlendOptions, problem: BlendProblem, known: FairSolution | None, remark: str = ""
    ) -> Layout | None:
        most_condoned = min((len(layout.found.condoned) for layout in _found(tried)), default=MOST_CONDONED)
        try:
            found = find_shape_parameters(problem, options, known, most_condoned)
            result: Layout | ComputationError = Layout(options, problem, found)
        except ComputationError as refusal:
            if not _is_searched(problem, options):
                raise
            result = refusal
        tried.append(_Tried(options, result, remark))
        return result if isinstance(result, Layout) else None

    def attempt(options: BlendOptions) -> Layout | None:
        return search(options, make_problem(a, b, options), _known_within(a, b, options))

    best = attempt(replace(first, alpha_v="constant") if "fair" in first.alphas else first)
    if best is not None and not _is_searched(best.problem, first):
        return best, ()
    with_middle = replace(first, middle_curves=1, alpha_v="constant")
    middle: Layout | None = None
    is_early = False
    if said.middle_curves == "auto" and best is not None and _wants_a_middle_curve_first(best, first.alpha_v):
        is_early, middle = True, attempt(with_middle)
        if middle is not None and _pays_with_a_middle_curve(middle, best, MUCH_FAIRER):
            best = _away_from_ends(middle, search)
            return best, tuple(_candidate(one, best) for one in tried)
    # The quartic suits U-turns that want little alpha, whatever becomes of the quintic in a lower window.
    doubtful = best is None or (best.problem.exits.u_turn and _is_doubtful(best))
    best = None if best is None else _away_from_ends(best, search)
    doubtful = doubtful or _is_doubtful(cast("Layout", best), of_refusals=False)
    if doubtful and said.degree_u == "auto" and first.degree_u == QUINTIC:
        quartic = attempt(replace(first, degree_u=4, alpha_v="constant"))
        best = _fairer(best, quartic)
        best = _away_from_ends(best, search) if best is not None and best is quartic else best
    if best is None:
        raise cast("ComputationError", tried[0].result)
    best, linear = _with_linear_alpha(best, first.alpha_v)
    # What a linear alpha would follow, a middle curve follows less well.
    if said.middle_curves == "auto" and _may_want_a_middle_curve(best):
        middle = middle if is_early else attempt(with_middle)
        if middle is not None and _fairness(middle) < _fairness(best):
            middle = _away_from_ends(middle, search)
        best = middle if middle is not None and _pays_with_a_middle_curve(middle, best) else best
    return best, (*(_candidate(one, best) for one in tried), *linear)


def _found(tried: list[_Tried]) -> list[Layout]:
    return [one.result for one in tried if isinstance(one.result, Layout)]


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
    options = replace(constant.options, alpha_v="linear")
    if trial.problem is None:
        return constant, ()
    if trial.solution is None:
        return constant, (_candidate(_Tried(options, ComputationError(trial.verdict)), constant),)
    tried = Layout(options, trial.problem, found_fair(trial.solution, constant.found.method))
    best = tried if trial.taken else constant
    verdict = "chosen" if trial.taken else trial.verdict
    return best, (replace(_candidate(_Tried(options, tried), tried), verdict=verdict),)


def _wants_less(layout: Layout) -> bool:
    """Tell whether the lower end of a window stopped the search."""
    return any("lower" in name for name in alpha_bounds(layout.problem, layout.found))


def _is_doubtful(layout: Layout, *, of_refusals: bool = True) -> bool:
    """Tell whether another degree is worth a search: for what was let pass, an end that was met, or a refusal.

    Beside a refusal the quartic is the fairer one on U-turns alone: elsewhere it meets the same.
    """
    found = layout.found
    return bool(found.condoned or (found.stopped_by and of_refusals) or alpha_bounds(layout.problem, found))


def _may_want_a_middle_curve(layout: Layout) -> bool:
    """Tell whether a middle curve may follow what a constant alpha does not.

    Closed rims it would pull together. With other degrees, those of G3 and G4 too, and on U-turns it wins seldom: there
    it is tried where something is wrong, or the gap varies.
    """
    options, problem = layout.options, layout.problem
    if options.alpha_v != "constant" or problem.seam_order >= 0 or not problem.has_constant_weights:
        return False
    is_usual = options.degree_u == QUINTIC and not problem.exits.u_turn
    return is_usual or bool(layout.found.stopped_by) or gap_ratio(problem) >= MIDDLE_RATIO


def _wants_a_middle_curve_first(layout: Layout, alpha_v: AlphaV) -> bool:
    """Tell whether a middle curve is tried before a lower window: at an end, and where no linear alpha is tried."""
    follows = alpha_v == "linear" or (alpha_v == "auto" and gap_ratio(layout.problem) >= TRIED_RATIO)
    is_free = not (follows or layout.found.stopped_by or layout.found.condoned or layout.problem.exits.u_turn)
    return is_free and any(_at_end(layout)) and _may_want_a_middle_curve(layout)


def _pays_with_a_middle_curve(middle: Layout, best: Layout, least_share: float = MIDDLE_SHARE) -> bool:
    """Tell whether a middle curve is worth its points: there is less to let pass, or it is fairer by enough."""
    let_pass = len(middle.found.condoned) - len(best.found.condoned)
    if let_pass:
        return let_pass < 0
    share = 1.0 if best.found.stopped_by and not middle.found.stopped_by else least_share
    is_sound = sum(_at_end(middle)) <= sum(_at_end(best)) and _is_settled(middle) >= _is_settled(best)
    return is_sound and _fairness(middle) < share * _fairness(best)


def _away_from_ends(layout: Layout, search: _Search) -> Layout:
    """Return what is better than a blend at an end of its window: in a lower window, or else without p2.

    A box that was asked for stays.
    """
    best, problem = layout, layout.problem
    # The weights of rational bases are made for one step.
    for low in (LOWER,) if problem.is_rational else (LOWER, LOWER**2):
        if layout.options.box is None and _wants_less(best):
            lower = search(layout.options, _with_low_window(problem, low), best.found.fair)
            best = cast("Layout", _fairer(best, lower))
    if problem.exits.u_turn:
        # Here p2 is worth more than a window that is not met.
        return best
    tried = best.problem.p2
    for every in (False, True):
        # Alpha and p2 can be traded one for the other until the window ends: such a side, or both, goes without p2.
        at_end = _at_end(best)
        p2 = tuple(
            SecondParameter() if (every or ended) and second.free else second
            for ended, second in zip(at_end, best.problem.p2, strict=True)
        )
        # Where both are at an end the first try was without both.
        if any(at_end) and p2 not in (tried, best.problem.p2):
            tried = cast("_TwoP2", p2)
            without = search(layout.options, replace(best.problem, p2=tried), None, _without_words(problem.p2, tried))
            best = without if without is not None and _pays_without_p2(without, best) else best
    return best


def _without_words(free: _TwoP2, tried: _TwoP2) -> str:
    """Say which sides go without the p2 that they have had."""
    sides = [name for name, was, now in zip("ab", free, tried, strict=True) if was.free and not now.free]
    return f"without p2 of {' and '.join(sides)}"


def _pays_without_p2(without: Layout, best: Layout) -> bool:
    """Tell whether a side is better without p2: it leaves an end for little fairness, or there is less to let pass."""
    if len(without.found.condoned) != len(best.found.condoned):
        return len(without.found.condoned) < len(best.found.condoned)
    return sum(_at_end(without)) < sum(_at_end(best)) and _fairness(without) <= WITHOUT_P2 * _fairness(best)


def _at_end(layout: Layout) -> tuple[bool, bool]:
    return cast("FairSolution", layout.found.fair).at_end


def _is_settled(layout: Layout) -> bool:
    return cast("FairSolution", layout.found.fair).settled


def _known_within(a: Side, b: Side, options: BlendOptions) -> FairSolution | None:
    """Return what is found in the window that a box replaces, where it is wider: that cannot be worse."""
    if options.box is None:
        return None
    wide, narrow = make_problem(a, b, options), make_problem(a, b, replace(options, box=None))
    pairs = zip(wide.bounds, narrow.bounds, strict=True)
    is_wider = wide.bounds != narrow.bounds and all(w[0] <= n[0] and n[1] <= w[1] for w, n in pairs)
    if not (is_wider and _is_searched(wide, options)):
        return None
    try:
        return find_shape_parameters(narrow, options).fair
    except ComputationError:
        return None


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
        return f"every cell that was tried {' or '.join(sorted(let_pass))}"
    if _fairness(layout) < _fairness(best) and any(_at_end(layout)):
        return f"fairness {_fairness(layout):.4g} is less, at an end of its window"
    if _fairness(layout) < _fairness(best):
        but = f"by less than the {1 - MIDDLE_SHARE:.0%} that a middle curve has to gain"
        return f"fairness {_fairness(layout):.4g} is less, {but if _is_settled(layout) else 'but does not settle'}"
    more = "is no less" if _fairness(layout) == _fairness(best) else "is more"
    window = "" if layout.problem.bounds == best.problem.bounds else ", in another window"
    return f"fairness {_fairness(layout):.4g} {more}{window}"


def _refusal(error: ComputationError) -> str:
    return error.reasons if isinstance(error, AllRefusedError) else str(error)


def _candidate(one: _Tried, best: Layout) -> Candidate:
    options, result = one.options, one.result
    fairness = _fairness(result) if isinstance(result, Layout) else None
    said = _loser(result, best) if isinstance(result, Layout) else _refusal(result)
    verdict = "chosen" if result is best else f"{one.remark}: {said}" if one.remark else said
    return Candidate(
        cast("int", options.degree_u), cast("int", options.middle_curves), options.alpha_v, fairness, verdict
    )
