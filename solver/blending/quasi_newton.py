"""The paper's own route to G1 and G2, for comparison: substitution, then BFGS with finite differences.

Unknown are the free control points, alpha and beta; the contact conditions are substituted into the energy; the search
starts from the parametric solution, alpha = beta = 1, and stops at some local minimum. Which one, rounding may decide:
on another processor the same search may end elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np
from scipy.optimize import minimize

from semispline.solver.blending.closing import periodic_points
from semispline.solver.blending.nlp import contact_rows
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.reduced import ZERO_ENERGY
from semispline.solver.errors import ComputationError, ContactError

# Below this part of natural, alpha^4, which curvature at the contact is made of, is less than what points are rounded.
DEGENERATE = 1e-8


@dataclass(frozen=True)
class QuasiNewtonSolution:
    """Where the search stopped.

    Attributes
    ----------
    a, b : float
        alpha^2 and beta^2.
    iterations : int
    status : str
        SciPy's word on how it ended.
    excess : float
        Energy that the search left, less what its alpha and beta allow, as a fraction of the latter.
    """

    a: float
    b: float
    iterations: int
    status: str
    excess: float


def solve_quasi_newton(problem: BlendProblem) -> QuasiNewtonSolution:
    """Run BFGS with finite differences from the parametric solution.

    Raises
    ------
    ComputationError
        The search left the finite numbers.
    ContactError
        The search, which knows no bounds, ran to alpha or beta of almost 0: the blend would not leave that side.

    Source: section 4 of the paper (its fminunc).
    """
    objective, start = substituted_objective(problem)
    found = minimize(lambda x: float(objective(x)), start, method="BFGS")
    if not np.isfinite(found.fun):
        raise ComputationError("BFGS ran out of the finite numbers; try method reduced")
    # The parameters come after the free control points; alpha enters as its square.
    shape = iter(found.x[len(start) - sum(problem.free) :])
    a, b = (
        float(next(shape)) ** 2 if is_free else fixed
        for is_free, fixed in zip(problem.free, problem.start, strict=True)
    )
    _require_leaving(problem, (a, b))
    points = problem.control_points(a, b)
    allowed = float(problem.form.products(points[None])[0, 0])
    terms = float(np.sum(np.abs(points) * (abs(problem.form.matrix()) @ np.abs(points))))
    excess = (float(found.fun) - allowed) / max(allowed, ZERO_ENERGY * terms)
    return QuasiNewtonSolution(a, b, int(found.nit), str(found.message), excess)


def _require_leaving(problem: BlendProblem, found: tuple[float, float]) -> None:
    """Refuse shape parameters of almost 0: the energy is even in alpha, so alpha = 0 draws the search."""
    sides = zip("ab", ("alpha2", "beta2"), problem.free, found, problem.natural, strict=True)
    missed = [
        f"contact {side}: the search ran to a degenerate shape parameter, {name} = {value:.1e}, {value / natural:.1e} "
        f"of its natural size, expected at least {DEGENERATE:g}"
        for side, name, is_free, value, natural in sides
        if is_free and not value >= DEGENERATE * natural
    ]
    if missed:
        raise ContactError(f"{'; '.join(missed)}; method bfgs knows no bounds: try method reduced, which keeps them")


def substituted_objective(problem: BlendProblem) -> tuple[ca.Function, np.ndarray]:
    """Return the energy as a compiled function of the free control points, alpha and beta, and where to start."""
    form = problem.form
    # Free rows are Z y, Z the identity where they are open.
    bases = [
        periodic_points(form.rows[i], problem.seam_order_of(i)) if problem.seam_order >= 0 else None
        for i in problem.free_rows
    ]
    sizes = [form.rows[i].size if z is None else z.shape[1] for i, z in zip(problem.free_rows, bases, strict=True)]
    x = ca.MX.sym("x", 3 * sum(sizes) + sum(problem.free))
    values: dict[int, ca.MX] = {}
    at = 0
    for i, z, size in zip(problem.free_rows, bases, sizes, strict=True):
        y = ca.reshape(x[at : at + 3 * size], size, 3)
        values[i] = y if z is None else ca.mtimes(ca.DM(z.tocsc()), y)
        at += 3 * size
    for (side, rows, spans), is_free, fixed in zip(problem.contacts, problem.free, problem.start, strict=True):
        a = x[at] ** 2 if is_free else fixed
        at += is_free
        for row, prescribed in zip(rows, contact_rows(side, a, form.u.degree, spans), strict=False):
            values[row] = prescribed
    p = ca.vertcat(*(values[i] for i in range(len(form.rows))))
    energy = ca.dot(p, ca.mtimes(ca.DM(form.matrix().tocsc()), p))
    unit = tuple(1.0 if is_free else fixed for is_free, fixed in zip(problem.free, problem.start, strict=True))
    points = problem.control_points(unit[0], unit[1])
    # y is the first part of each row.
    first = [
        points[form.offsets[i] : form.offsets[i] + size].T.ravel()
        for i, size in zip(problem.free_rows, sizes, strict=True)
    ]
    return ca.Function("energy", [x], [energy]), np.concatenate([*first, np.ones(sum(problem.free))])
