"""alpha^2 and beta^2 by the method that was asked for, and whether a bound stopped it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

from semispline.solver.blending.fair_search import MOST_CONDONED, FairSolution, solve_fair
from semispline.solver.blending.linear_alpha import LinearInV, scaled
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.options import BlendOptions
from semispline.solver.proof import Certificate


@dataclass(frozen=True)
class Found:
    """Shape parameters, and how they were found."""

    a: LinearInV
    b: LinearInV
    method: str
    iterations: int = 0
    kkt_residual: float | None = None
    certificate: Certificate | None = None
    proven_gap: float | None = None
    constraint_rank: tuple[int, int] | None = None
    status: str | None = None
    search_excess: float | None = None
    p2: tuple[LinearInV, LinearInV] = (0.0, 0.0)
    known: str = ""
    fair: FairSolution | None = None

    @property
    def fairness(self) -> float | None:
        """Area times integral of |grad H|^2, where that was minimised."""
        return None if self.fair is None else self.fair.value

    @property
    def stopped_by(self) -> str:
        """The refusal that stopped the search, "fold" or "loop", if one did."""
        return "" if self.fair is None else self.fair.stopped_by

    @property
    def condoned(self) -> tuple[str, ...]:
        """What was let pass because every cell that was tried has it."""
        return () if self.fair is None else self.fair.condoned


def find_shape_parameters(
    problem: BlendProblem,
    options: BlendOptions,
    known: FairSolution | None = None,
    most_condoned: int = MOST_CONDONED,
) -> Found:
    """Find alpha^2 and beta^2 of least energy or fairest shape; where both are fixed there is nothing to find.

    A search for the fairest shape starts from what is known of a narrower window, too, and lets no more pass than it
    may.
    Each method waits inside the function until it is asked for: CasADi alone takes longer to load than to solve.
    """
    method = options.method
    if not any(problem.free):
        a, b = problem.given
        return Found(a, b, method="linear", p2=(problem.p2[0].at(a), problem.p2[1].at(b)))
    if "fair" in options.alphas:
        return found_fair(solve_fair(problem, known, most_condoned), method)
    if method == "reduced":
        from semispline.solver.blending.reduced import solve_reduced

        proved = solve_reduced(problem)
        objective = f"thin plate (11), v_scale {options.v_scale}, by alpha^2 and beta^2"
        certificate = replace(proved.certificate, objective=objective)
        return Found(proved.a, proved.b, method, certificate=certificate, proven_gap=proved.gap)
    problem.check_polynomial(f"method: found {method}")
    if method == "casadi":
        from semispline.solver.blending.nlp import solve_constrained

        local = solve_constrained(problem)
        return Found(
            local.a,
            local.b,
            method,
            local.iterations,
            local.kkt_residual,
            constraint_rank=local.constraint_rank,
            status=local.status,
        )
    from semispline.solver.blending.quasi_newton import solve_quasi_newton

    rough = solve_quasi_newton(problem)
    return Found(rough.a, rough.b, method, rough.iterations, status=rough.status, search_excess=rough.excess)


def found_fair(fair: FairSolution, method: str) -> Found:
    """Return what a fair search found, and say what is known of it."""
    known = (
        f"least of {fair.tried} evaluations from several starts, not proved; slope at the end {fair.slope:.1e}, "
        f"refused: {fair.refused['folds']} candidates for folds, {fair.refused['loops']} for loops"
        + (f"; these were all, so that {' and '.join(fair.condoned)} were let pass" if fair.condoned else "")
        + (f"; it ended beside a {fair.stopped_by}, which is refused" if fair.stopped_by else "")
        + ("" if fair.settled else "; not settled: a finer grid still changes it by more than 1 %")
    )
    return Found(fair.a, fair.b, method, fair.tried, p2=fair.p2, known=known, fair=fair)


def shape_unknowns(problem: BlendProblem, found: Found) -> list[tuple[str, float, float, float]]:
    """Return name, value found and admissible ends of each shape parameter that was searched."""
    unknowns = []
    for index, (name, value) in enumerate((("alpha2", found.a), ("beta2", found.b))):
        linear = problem.linear[index]
        if not problem.free[index]:
            continue
        if linear is None or not isinstance(value, tuple):
            unknowns.append((name, cast("float", value), *problem.bounds[index]))
        else:
            unknowns += [(f"{name}[{k}]", value[k], *linear.bounds[k]) for k in (0, 1)]
    return unknowns


def admissible(problem: BlendProblem, index: int) -> tuple[LinearInV, LinearInV] | None:
    """Return least and largest alpha^2 or beta^2, pairs of end values where it is linear in v; none where given."""
    if not problem.free[index]:
        return None
    linear = problem.linear[index]
    if linear is None:
        return problem.bounds[index]
    (low_0, high_0), (low_1, high_1) = linear.bounds
    return (low_0, low_1), (high_0, high_1)


def active_bounds(problem: BlendProblem, found: Found) -> tuple[str, ...]:
    """Return which bounds stopped the search, such as "alpha2 lower" or "p2 of a upper"."""
    return (*alpha_bounds(problem, found), *(f"p2 of {side} {which}" for side, which in p2_ends(found)))


def p2_ends(found: Found) -> list[tuple[str, str]]:
    """Return side and end, "lower" or "upper", of each p2 that ended at an end of its own range."""
    ends = () if found.fair is None else found.fair.p2_ends
    return [(side, which) for side, which in zip("ab", ends, strict=False) if which]


def alpha_bounds(problem: BlendProblem, found: Found) -> tuple[str, ...]:
    """Return which bounds of alpha^2 and beta^2 stopped the search: these, not p2's, decide what else is tried."""
    active = []
    for name, value, low, high in shape_unknowns(problem, found):
        # 1e-9: what the ways there and back between alpha and alpha^2 in natural units may round.
        active += [f"{name} lower"] * (value <= low * (1 + 1e-9)) + [f"{name} upper"] * (value >= high * (1 - 1e-9))
    return tuple(active)


def bulged(found: Found, bulges: tuple[float, float]) -> Found:
    """Return what was found with the u-lines run through faster: alpha^2 times the bulge, and p2 times its square."""
    (a, b), (p2_a, p2_b) = bulges, found.p2
    return replace(found, a=scaled(found.a, a), b=scaled(found.b, b), p2=(scaled(p2_a, a**2), scaled(p2_b, b**2)))
