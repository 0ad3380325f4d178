"""alpha^2 and beta^2 by the method that was asked for, and whether a bound stopped it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from semispline.solver.blending.problem import BlendProblem
from semispline.solver.options import BlendOptions
from semispline.solver.proof import Certificate


@dataclass(frozen=True)
class Found:
    """Shape parameters, and how they were found."""

    a: float
    b: float
    method: str
    iterations: int = 0
    kkt_residual: float | None = None
    certificate: Certificate | None = None
    proven_gap: float | None = None
    constraint_rank: tuple[int, int] | None = None
    status: str | None = None
    search_excess: float | None = None
    p2: tuple[float, float] = (0.0, 0.0)
    fairness: float | None = None
    known: str = ""


def find_shape_parameters(problem: BlendProblem, options: BlendOptions) -> Found:
    """Find alpha^2 and beta^2 of least energy or fairest shape; where both are fixed there is nothing to find.

    Each method waits inside the function until it is asked for: CasADi alone takes longer to load than to solve.
    """
    method = options.method
    if not any(problem.free):
        a, b = problem.start
        return Found(a, b, method="linear", p2=(problem.p2[0].at(a), problem.p2[1].at(b)))
    if "fair" in options.alphas:
        from semispline.solver.blending.fair_search import solve_fair

        fair = solve_fair(problem)
        known = (
            f"least of {fair.tried} evaluations from several starts, not proved; slope at the end {fair.slope:.1e}, "
            f"refused: {fair.refused['folds']} candidates for folds, {fair.refused['loops']} for loops"
        )
        return Found(fair.a, fair.b, method, fair.tried, p2=fair.p2, fairness=fair.value, known=known)
    if method == "reduced":
        from semispline.solver.blending.reduced import solve_reduced

        proved = solve_reduced(problem)
        objective = f"thin plate (11), v_scale {options.v_scale}, by alpha^2 and beta^2"
        certificate = replace(proved.certificate, objective=objective)
        return Found(proved.a, proved.b, method, certificate=certificate, proven_gap=proved.gap)
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


def shape_unknowns(problem: BlendProblem, found: Found) -> list[tuple[str, float, float, float]]:
    """Return name, value found and admissible ends of each shape parameter that was searched."""
    return [
        (name, value, *ends)
        for name, is_free, value, ends in zip(
            ("alpha2", "beta2"), problem.free, (found.a, found.b), problem.bounds, strict=True
        )
        if is_free
    ]


def active_bounds(problem: BlendProblem, found: Found) -> tuple[str, ...]:
    """Return which bounds stopped the search, such as "alpha2 lower"."""
    active = []
    for name, value, low, high in shape_unknowns(problem, found):
        # 1e-9: what the ways there and back between alpha and alpha^2 in natural units may round.
        active += [f"{name} lower"] * (value <= low * (1 + 1e-9)) + [f"{name} upper"] * (value >= high * (1 - 1e-9))
    return tuple(active)


def bulged(found: Found, bulges: tuple[float, float]) -> Found:
    """Return what was found with the u-lines run through faster: alpha^2 times the bulge, and p2 times its square."""
    (a, b), (p2_a, p2_b) = bulges, found.p2
    return replace(found, a=found.a * a, b=found.b * b, p2=(p2_a * a**2, p2_b * b**2))
