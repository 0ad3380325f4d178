"""The constrained problem in CasADi: all control points, alpha, beta; generated contact rows; exact Hessian."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
import scipy.sparse as sp

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.blending.closing import end_conditions
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.sides import Side
from semispline.solver.errors import ComputationError
from semispline.solver.generated import contact_casadi

# A solution is judged by its residuals, not by the status, which differs between platforms for the same point.
KKT_LIMIT = 1e-8
FEASIBILITY_LIMIT = 1e-9
# The scale of the objective is at least this part of the magnitudes of its terms.
LEAST_SCALE = 1e-5
# Where the energy falls to less than this part of the start's, the solver goes on from there with the new scale.
RESCALED = 0.1


@dataclass(frozen=True, eq=False)
class ConstrainedProblem:
    """min f(x) subject to g(x) = 0 and bounds, as CasADi expressions.

    Attributes
    ----------
    x : MX, shape (3 N + number of shape parameters, 1)
        x, y and z of all control points, then alpha and beta over their natural sizes where they are free.
    f : MX, scalar
        Thin-plate energy over `f_scale`.
    g : MX
        Rows of the blend minus rows that the contact prescribes.
    hessian : Function
        Upper triangle of the Hessian of lam_f f + lam_g'g, of (x, (), lam_f, lam_g).
    start, lower, upper : ndarray
    f_scale : float
    parameters : tuple of str
        Which of "alpha", "beta" are unknown.
    """

    x: Any
    f: Any
    g: Any
    hessian: Any
    start: FloatArray
    lower: FloatArray
    upper: FloatArray
    f_scale: float
    parameters: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class ConstrainedSolution:
    """What IPOPT found.

    Attributes
    ----------
    a, b : float
        alpha^2 and beta^2, in the parameters of the bases.
    iterations : int
    status : str
    kkt_residual : float
        Largest entry of the gradient of the Lagrangian and of multiplier times slack, scaled problem.
    constraint_rank : (int, int)
        Of the constraint Jacobian at the solution, and its number of rows; full rank makes multipliers unique.
    """

    a: float
    b: float
    iterations: int
    status: str
    kkt_residual: float
    constraint_rank: tuple[int, int]


def sparse_rank(matrix: SparseMatrix) -> int:
    """Return the rank of a sparse matrix most of whose rows have a column to themselves.

    Such a row is independent of the others. Of what is left when none has one any more, the rank is a dense one.

    Examples
    --------
    >>> sparse_rank(sp.csr_array([[1.0, 0, 2], [0, 1, 1], [0, 1, 1]]))
    2
    """
    left = sp.csr_array(matrix)
    # What is below eps of its row cannot be told from zero.
    largest = abs(left).max(axis=1).toarray().ravel()
    left.data[np.abs(left.data) <= np.finfo(float).eps * np.repeat(largest, np.diff(left.indptr))] = 0
    left.eliminate_zeros()
    rank = 0
    while left.shape[0]:
        columns = left.tocsc()
        alone = np.unique(columns.indices[columns.indptr[:-1][np.diff(columns.indptr) == 1]])
        if not alone.size:
            return rank + int(np.linalg.matrix_rank(left.toarray()))
        rank += len(alone)
        left = left[np.setdiff1d(np.arange(left.shape[0]), alone)]
    return rank


def constrained_problem(problem: BlendProblem, energy_scale: float = np.inf) -> ConstrainedProblem:
    """State the blend problem with every control point and shape parameter as an unknown.

    The objective is the energy over that of the start, or over `energy_scale` where that is less.
    """
    problem.check_polynomial("constrained problem")
    n = problem.form.offsets[-1]
    free = [name for name, is_free in zip(("alpha", "beta"), problem.free, strict=True) if is_free]
    x = ca.MX.sym("x", 3 * n + len(free))
    p = ca.reshape(x[: 3 * n], n, 3)

    first = problem.control_points(*problem.start)
    matrix = problem.form.matrix().tocsc()
    energy = casadi_matrix(matrix)
    magnitude = float(np.sum(np.abs(first) * (abs(matrix) @ np.abs(first))))
    # Two bases that continue each other have energy 0: then the scale must stay clear of rounding.
    f_scale = max(min(float(np.sum(first * (matrix @ first))), energy_scale), LEAST_SCALE * magnitude)

    owned, prescribed = _prescribed(problem, p)
    seams = [ca.vec(seam) for seam in _seam_conditions(problem, p)]
    g = ca.vertcat(owned - prescribed(x[3 * n :]), *seams)

    # alpha is measured in units of its natural size, so that the solver does not care about parameter speeds.
    box = [
        np.sqrt(np.array(bounds) / natural)
        for bounds, natural, is_free in zip(problem.bounds, problem.natural, problem.free, strict=True)
        if is_free
    ]
    infinite = np.full(3 * n, np.inf)
    return ConstrainedProblem(
        x=x,
        f=ca.dot(p, ca.mtimes(energy, p)) / f_scale,
        g=g,
        hessian=_hessian(energy / f_scale, prescribed, g.shape[0]),
        start=np.concatenate([first.T.ravel(), *([min(max(1.0, low), high)] for low, high in box)]),
        lower=np.concatenate([-infinite, *([low] for low, _ in box)]),
        upper=np.concatenate([infinite, *([high] for _, high in box)]),
        f_scale=f_scale,
        parameters=tuple(free),
    )


def _prescribed(problem: BlendProblem, p: Any) -> tuple[Any, ca.Function]:
    """Return the rows of p that contact prescribes, and what it prescribes as a function of the shape parameters."""
    shape = ca.MX.sym("shape", sum(problem.free))
    parameters = iter(ca.vertsplit(shape))
    offsets = problem.form.offsets
    owned, rows = [], []
    for (side, order, spans), natural, is_free, fixed in zip(
        problem.contacts, problem.natural, problem.free, problem.start, strict=True
    ):
        a = next(parameters) ** 2 * natural if is_free else fixed
        for i, row in zip(order, contact_rows(side, a, problem.form.u.degree, spans), strict=False):
            owned.append(ca.vec(p[offsets[i] : offsets[i + 1], :]))
            rows.append(ca.vec(row))
    return ca.vertcat(*owned), ca.Function("prescribed", [shape], [ca.vertcat(*rows)])


def _hessian(energy: ca.DM, prescribed: ca.Function, n_conditions: int) -> ca.Function:
    """Return the Hessian of the Lagrangian: constant in the control points, which differentiation would not notice."""
    size, n_shape = 3 * energy.shape[0], prescribed.size1_in(0)
    x, lam_f, lam_g = ca.MX.sym("x", size + n_shape), ca.MX.sym("lam_f"), ca.MX.sym("lam_g", n_conditions)
    blocks = [lam_f * ca.triu(energy + energy.T)] * 3
    if n_shape:
        shape, weights = ca.MX.sym("shape", n_shape), ca.MX.sym("weights", prescribed.size1_out(0))
        bend = ca.triu(ca.hessian(-ca.dot(weights, prescribed(shape)), shape)[0])
        blocks.append(ca.Function("bend", [shape, weights], [bend])(x[size:], lam_g[: weights.shape[0]]))
    names = ["x", "p", "lam_f", "lam_g"], ["triu_hess_gamma_x_x"]
    return ca.Function("hessian", [x, ca.MX.sym("p", 0, 0), lam_f, lam_g], [ca.diagcat(*blocks)], *names)


def casadi_matrix(matrix: SparseMatrix) -> ca.DM:
    """Return a CSC matrix for CasADi."""
    return ca.DM(
        ca.Sparsity(matrix.shape[0], matrix.shape[1], matrix.indptr.tolist(), matrix.indices.tolist()), matrix.data
    )


def _seam_conditions(problem: BlendProblem, p: Any) -> list[Any]:
    """Return what vanishes where closed free rows are smooth across their seam: derivatives at both ends agree."""
    conditions = []
    for i in problem.free_rows:
        order = problem.seam_order_of(i)
        if order >= 0:
            first, last = end_conditions(problem.form.rows[i], order)
            start, end = problem.form.offsets[i], problem.form.offsets[i + 1]
            at_start = ca.mtimes(ca.DM(first), p[start : start + order + 1, :])
            conditions.append(at_start - ca.mtimes(ca.DM(last), p[end - order - 1 : end, :]))
    return conditions


def contact_rows(
    side: Side, a: Any, degree: int, spans: tuple[float, ...], rows: Sequence[Any] | None = None
) -> list[Any]:
    """Rows that the contact prescribes, each an (n, 3) expression in a and in the rows of the base."""
    q = side.degree
    if side.order == 0:
        matrix = ca.DM.ones(1, 1)
    elif side.order == 1:
        matrix = contact_casadi.contact_rows_1(a, degree, spans[0], q, side.spans[0])
    else:
        matrix = contact_casadi.contact_rows_2(a, degree, spans[0], spans[1], q, side.spans[0], side.spans[1])
    base = [ca.DM(row) for row in side.rows] if rows is None else rows
    order = side.order + 1
    return [sum((matrix[i, j] * base[j] for j in range(1, order)), matrix[i, 0] * base[0]) for i in range(order)]


def solve_constrained(problem: BlendProblem) -> ConstrainedSolution:
    """Solve the constrained problem with IPOPT and the exact Hessian of the Lagrangian.

    Raises
    ------
    ComputationError
        IPOPT did not converge; the message names its status and what to try.
    """
    nlp = constrained_problem(problem)
    result, stats = _optimum(nlp, x0=nlp.start)
    iterations = int(stats["iter_count"])
    reached = float(result["f"])
    if reached < RESCALED:
        larger = nlp.f_scale
        nlp = constrained_problem(problem, reached * larger)
        reached_multipliers = {f"lam_{name}0": result[f"lam_{name}"] * (larger / nlp.f_scale) for name in ("x", "g")}
        result, stats = _optimum(nlp, x0=result["x"], **reached_multipliers)
        iterations += int(stats["iter_count"])
    n_points = 3 * problem.form.offsets[-1]
    shape, pressure = (np.asarray(result[name]).ravel()[n_points:] for name in ("x", "lam_x"))
    low, high = nlp.lower[n_points:], nlp.upper[n_points:]
    multipliers = ca.MX.sym("multipliers", nlp.g.shape[0])
    gradient = ca.Function("gradient", [nlp.x, multipliers], [ca.gradient(nlp.f + ca.dot(multipliers, nlp.g), nlp.x)])
    slope = np.abs(np.asarray(gradient(result["x"], result["lam_g"]) + result["lam_x"])).max()
    unused = np.maximum(-pressure, 0) * (shape - low), np.maximum(pressure, 0) * (high - shape)
    kkt = float(max(slope, np.abs(unused).max()))
    infeasible = float(np.abs(np.asarray(result["g"])).max())
    if not (kkt <= KKT_LIMIT and infeasible <= FEASIBILITY_LIMIT):
        raise ComputationError(
            f"IPOPT ended with {stats['return_status']} after {iterations} steps, KKT residual {kkt:.1e} and "
            f"constraints missed by {infeasible:.1e}; try other middle curves, or bases of similar size"
        )
    # An interior-point method ends a little off an active bound: where the multiplier is the larger one, on it.
    shape = np.where(-pressure > shape - low, low, np.where(pressure > high - shape, high, shape))
    found = dict(zip(nlp.parameters, shape.tolist(), strict=True))
    a, b = (
        min(max(found[name] ** 2 * natural, bounds[0]), bounds[1]) if name in found else fixed
        for name, natural, bounds, fixed in zip(
            ("alpha", "beta"), problem.natural, problem.bounds, problem.start, strict=True
        )
    )
    jacobian = ca.Function("jacobian", [nlp.x], [ca.jacobian(nlp.g, nlp.x)])(result["x"]).sparse()
    rank = sparse_rank(jacobian), jacobian.shape[0]
    return ConstrainedSolution(a, b, iterations, str(stats["return_status"]), kkt, rank)


def _optimum(nlp: ConstrainedProblem, **start: Any) -> tuple[Any, Any]:
    """Return what IPOPT finds from a start, and its statistics; with multipliers it stays near the start."""
    ipopt: dict[str, Any] = {
        "print_level": 0,
        "sb": "yes",
        "tol": 1e-11,
        "constr_viol_tol": 1e-11,
        "max_iter": 200,
        # Approximate minimum degree: systems are small, and finding a better order costs more than it saves.
        "mumps_pivot_order": 0,
    }
    if "lam_g0" in start:
        pushes = ("bound_push", "bound_frac", "slack_bound_frac", "slack_bound_push", "mult_bound_push")
        ipopt |= {"warm_start_init_point": "yes", "mu_init": 1e-9, **{f"warm_start_{push}": 1e-9 for push in pushes}}
    options: Any = {"print_time": False, "hess_lag": nlp.hessian, "ipopt": ipopt}
    solver = ca.nlpsol("blend", "ipopt", {"x": nlp.x, "f": nlp.f, "g": nlp.g}, options)
    return solver(**start, lbx=nlp.lower, ubx=nlp.upper, lbg=0, ubg=0), solver.stats()
