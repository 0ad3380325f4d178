"""The paper's method with its printed conditions, wrong ones included.

Rows come from (1.1) to (3.2) as `papers.lin2014.printed` holds them, and nothing else that is printed runs here: the
free row is where the energy is least, as (12) asks, since the printed linear system (14) has a matrix of rank 3 at the
most. For G2, alpha and beta are searched as in section 4: BFGS from the parametric solution, with finite differences.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import sympy as sp
from scipy.optimize import minimize

from semispline.papers.baselines import (
    THIN_PLATE,
    BlendTask,
    ContactSide,
    Method,
    Outcome,
    RowRule,
    energy_matrix,
    least_energy,
    polynomial_sides,
    semistructured_surface,
)
from semispline.papers.lin2014 import printed as pr
from semispline.solver.arrays import FloatArray
from semispline.solver.blending import blend
from semispline.solver.splines import Basis

_START = ((pr.P_0, pr.P_1, pr.P_2), (pr.R_0, pr.R_1, pr.R_2), (pr.COND_1_1, pr.COND_2_1, pr.COND_3_1))
_END = ((pr.P_m, pr.P_m1, pr.P_m2), (pr.S_0, pr.S_1, pr.S_2), (pr.COND_1_2, pr.COND_2_2, pr.COND_3_2))


def printed_rule(side: ContactSide, u: Basis, *, at_end: bool) -> RowRule:
    """Return alpha^2 -> the three rows at a contact, as printed, shape (3, n, 3).

    Every letter gets the number that the text gives it: u_i the inner knots of U (u_(m-3) the last one, as k = 4),
    w_(k_r) - w_s the first span of the base.
    """
    p, across, degree = u.degree, side.surface.knots_u, side.surface.degree_u
    m = u.size - 1
    values = {
        pr.k: p + 1, pr.u_1: float(u.knots[p + 1]), pr.u_m3: float(u.knots[p + m - 3]),
        pr.k_r: degree + 1, pr.w_s: float(across[0]), pr.w_kr: float(across[degree + 1]),
        pr.k_s: degree + 1, pr.t_s: float(across[0]), pr.t_ks: float(across[degree + 1]),
    }  # fmt: skip
    rows_symbols, base_symbols, formulas = _END if at_end else _START
    shape = pr.beta if at_end else pr.alpha
    base = dict(zip(base_symbols, side.surface.control_points[:3], strict=True))
    steps = []
    for formula in formulas:
        right = formula.relation.rhs
        used = sorted(right.free_symbols, key=str)
        steps.append((used, sp.lambdify(used, right, "numpy")))

    def rule(a: float) -> FloatArray:
        known: dict[Any, Any] = {**values, **base, shape: a**0.5}
        for symbol, (used, evaluate) in zip(rows_symbols, steps, strict=True):
            known[symbol] = evaluate(*(known[s] for s in used))
        return np.stack([known[symbol] for symbol in rows_symbols])

    return rule


def blend_as_printed(task: BlendTask) -> Outcome:
    """Blend with the printed rows."""
    a, b = polynomial_sides(task)
    # Only the knots are taken from it: U and those of the middle curve follow the text.
    layout = blend(task.a, task.b, continuity="C2", middle_curves=task.middle_curves, alpha="energy").surface
    u = Basis(layout.degree_u, layout.knots_u)
    bases = [Basis(c.degree, c.knots) for c in layout.control_curves]
    started = time.perf_counter()
    rules = printed_rule(a, u, at_end=False), printed_rule(b, u, at_end=True)
    matrix = energy_matrix(u, bases, THIN_PLATE)
    parametric = least_energy(matrix, bases, rules, ((1.0, 1.0), (1.0, 1.0)), task.closed)
    if task.continuity == "C2":
        surface = semistructured_surface(u, bases, parametric.rows)
        return Outcome(surface, surface.n_control_points, None, time.perf_counter() - started, 1.0, 1.0)
    assemble, start = _unknowns(parametric.rows, rules)
    first = assemble(start)
    centre, size = first.mean(axis=0), float(np.ptp(first, axis=0).max())

    def energy(x: FloatArray) -> float:
        points = (assemble(x * scale) - centre) / size
        return float(np.sum(points * (matrix @ points)))

    # Coordinates of size 1, as `solver.blending.quasi_newton` takes them: BFGS stops by the size of the gradient.
    scale = np.concatenate([np.full(len(start) - 2, size), np.ones(2)])
    found = minimize(energy, start / scale, method="BFGS")
    x = found.x * scale
    rows = np.split(assemble(x), np.cumsum([basis.size for basis in bases])[:-1])
    surface = semistructured_surface(u, bases, rows)
    seconds = time.perf_counter() - started
    a2, b2 = float(x[-2] ** 2), float(x[-1] ** 2)
    return Outcome(surface, surface.n_control_points, int(found.nit), seconds, a2, b2)


def _unknowns(
    rows: tuple[FloatArray, ...], rules: tuple[RowRule, RowRule]
) -> tuple[Callable[[FloatArray], FloatArray], FloatArray]:
    """Return the map from free rows, alpha and beta to all control points, and the parametric solution as a start."""
    middle = rows[3:-3]

    def assemble(x: FloatArray) -> FloatArray:
        free = x[:-2].reshape(-1, 3)
        return np.concatenate([*rules[0](x[-2] ** 2), free, *rules[1](x[-1] ** 2)[::-1]])

    return assemble, np.concatenate([*(row.ravel() for row in middle), [1.0, 1.0]])


METHODS = (
    Method(
        "paper-as-printed", "the paper as printed", "conditions (1.1) to (3.2) as printed", 0, blend_as_printed
    ),
)  # fmt: skip
