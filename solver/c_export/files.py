"""C99 for one blend problem, written by CasADi.

Always the constrained problem as `blending.nlp` states it, with exact derivatives. Where contact is linear also the
whole solve: control rows of the bases in, control points of the blend out. The matrix of that map is dense, so the code
carries the sparse Cholesky factor of the stationarity system instead, as constants, and solves with it: its size is
linear in the number of control points, and nothing is factorised, allocated or can fail when it runs.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from semispline.solver.blending import (
    ConstrainedProblem,
    StatedProblem,
    casadi_matrix,
    constrained_problem,
    contact_rows,
    make_side,
    state_problem,
)
from semispline.solver.c_export.readme import readme
from semispline.solver.errors import ComputationError, EdgeError, InputError
from semispline.solver.io import (
    StoredProblem,
    check_folder,
    check_outputs,
    face_warnings,
    read_problem,
    split_spec,
    write_texts,
)
from semispline.solver.judge import Base
from semispline.solver.options import BlendOptions
from semispline.solver.topology import ResolvedChain, ResolvedEdge, edge_bases, resolve_edges

NAME = "blend"
# Errors of the control points of exported code, as a fraction of the size: of the energy that is the square.
TRUSTED_SOLVE = 1e-6
_NOTICE = """\
/* Written by `semispline generate --c`. Do not edit: change the problem and generate again.
   How to call it: README.md. */
"""


def write_c(folder: str | Path, problem_file: str | Path) -> tuple[list[Path], tuple[str, ...]]:
    """Write C for a stored blend problem into a folder, made if missing; all files or none.

    Returns
    -------
    paths : list of Path
        What was written.
    warnings : tuple of str
        Of edges that are not edges of the face that a CAD file holds.

    Raises
    ------
    InputError
        A file, an option or a base that cannot be used.
    TrimError
        There are such warnings, and the problem is to be solved strictly.
    ComputationError
        As `c_files`.
    """
    check_folder(folder)
    stored = read_problem(problem_file)
    (a, b), ends = _bases(stored)
    own = [asked for base, asked in ((stored.a, stored.asked_a), (stored.b, stored.asked_b)) if isinstance(base, str)]
    # An edge that was asked for as one of the face is its own.
    edges = [
        (end.spec, end.edge, end.loaded if asked is None else replace(end.loaded, boundary=None))
        for end, asked in zip(ends, own, strict=True)
    ]
    warnings = face_warnings(*edges, strict=stored.options.strict)
    _require_polynomial(a, b, stored.options)
    texts = c_files(state_problem(a, b, stored.options.decided("generated C")))
    if Path(folder).is_dir():
        check_outputs(
            {name: Path(folder) / name for name in texts}, [problem_file, *(split_spec(end.spec)[0] for end in ends)]
        )
    return write_texts(folder, texts), warnings


def _bases(stored: StoredProblem) -> tuple[list[Base], list[ResolvedEdge]]:
    """Return both bases, a band along a free curve, and what was read from files.

    Raises
    ------
    EdgeError
        A free curve that has to be cut, so that there are several problems.
    """
    sides = ((stored.a, stored.edge_a), (stored.b, stored.edge_b))
    # Both at once: surfaces of different files come in one unit.
    named = [(base, edge) for base, edge in sides if isinstance(base, str)]
    resolved = resolve_edges(
        named, [f"edge_{name}" for name, (base, _) in zip("ab", sides, strict=True) if isinstance(base, str)]
    )
    orders = [
        order for (base, _), order in zip(sides, stored.options.continuities, strict=True) if isinstance(base, str)
    ]
    ends = [_one_edge(end) for end in resolved]
    read = iter(edge_bases(ends, orders))
    found = []
    for base, edge in sides:
        if not isinstance(base, str):
            found.append(Base(base, edge))
            continue
        parts = next(read)
        if len(parts) > 1:
            raise EdgeError(
                f"{edge} of {base}: found {len(parts)} parts, {parts[0].name} to {parts[-1].name}, expected one for "
                "generated C: name one of them in the problem"
            )
        found += parts[0].bases
    return found, ends


def _one_edge(end: ResolvedEdge | ResolvedChain) -> ResolvedEdge:
    if isinstance(end, ResolvedChain):
        raise EdgeError(f"{end.edge} of {end.spec}: found a chain, expected one edge for generated C")
    return end


def _require_polynomial(a: Base, b: Base, options: BlendOptions) -> None:
    """Refuse bases that are rational where contact reads them: weights that are all equal there are none."""
    for name, base, continuity in zip("ab", (a, b), options.continuities, strict=True):
        if make_side(base, continuity, f"base {name}").is_rational:
            raise InputError(
                f"{name}: rational, and generated C minimises the energy (11), which is a polynomial's; "
                "blend it in Python, or approximate it without weights"
            )


def c_files(stated: StatedProblem) -> dict[str, str]:
    """Return name and text of each file: blend.c, blend.h and README.md, which says how to call what is in them.

    Parameters
    ----------
    stated : StatedProblem
        As `state_problem` makes it.

    Raises
    ------
    ComputationError
        The stationarity system cannot be trusted.

    Examples
    --------
    >>> from semispline import Base, BSplineSurface
    >>> from semispline.solver.blending.pipeline import state_problem
    >>> k = [0, 0, 1, 1]
    >>> floor = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> wall = BSplineSurface(1, 1, k, k, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]])
    >>> files = c_files(state_problem(Base(floor, "u1"), Base(wall, "u0"), continuity="C2"))
    >>> sorted(files), "int blend_solve(" in files["blend.c"]
    (['README.md', 'blend.c', 'blend.h'], True)
    """
    nlp = constrained_problem(stated.problem)
    functions = c_functions(stated, nlp)
    generator = ca.CodeGenerator(f"{NAME}.c", {"with_header": True})
    for function in functions:
        generator.add(function)
    with tempfile.TemporaryDirectory() as folder:
        generator.generate(folder + "/")
        source, header = (Path(folder, f"{NAME}.{suffix}").read_text(encoding="utf-8") for suffix in "ch")
    return {
        f"{NAME}.c": _NOTICE + source,
        f"{NAME}.h": f"{_NOTICE}#ifndef BLEND_H\n#define BLEND_H\n{header}#endif\n",
        "README.md": readme(stated, nlp, functions),
    }


def c_functions(stated: StatedProblem, nlp: ConstrainedProblem) -> list[ca.Function]:
    """Return the functions that become C, each with named inputs and outputs."""
    x, lam_f, lam_g = nlp.x, ca.MX.sym("lam_f"), ca.MX.sym("lam_g", nlp.g.shape[0])
    functions = [
        _function("start", [], [nlp.start, nlp.lower, nlp.upper], [], ["x", "lower", "upper"]),
        _function("objective", [x], [nlp.f], ["x"], ["f"]),
        _function("gradient", [x], [ca.gradient(nlp.f, x)], ["x"], ["df"]),
        _function("constraints", [x], [nlp.g], ["x"], ["g"]),
        _function("jacobian", [x], [ca.jacobian(nlp.g, x)], ["x"], ["dg"]),
        _function(
            "hessian", [x, lam_f, lam_g], [nlp.hessian(x, [], lam_f, lam_g)], ["x", "lam_f", "lam_g"], ["hessian"]
        ),
        _function("points", [x], [_points(stated, nlp)], ["x"], ["points"]),
    ]
    if not any(stated.problem.free):
        given = [ca.DM(side.rows[: side.order + 1].reshape(-1, 3)).T for side in stated.sides]
        rows = [ca.MX.sym("rows", points.sparsity()) for points in given]
        functions += [
            _function("contact", [], given, [], ["a", "b"]),
            _function("solve", rows, [_solve(stated, *rows)], ["a", "b"], ["points"]),
        ]
    return functions


def _function(
    name: str, inputs: list[Any], outputs: list[Any], names_in: list[str], names_out: list[str]
) -> ca.Function:
    return ca.Function(f"{NAME}_{name}", inputs, [ca.MX(output) for output in outputs], names_in, names_out)


def _points(stated: StatedProblem, nlp: ConstrainedProblem) -> Any:
    """Control points in model units, (3, N), from the unknowns of the constrained problem."""
    n = stated.problem.form.offsets[-1]
    centre, size = stated.frame
    return ca.reshape(nlp.x[: 3 * n], n, 3).T * size + ca.repmat(ca.DM(centre), 1, n)


def _solve(stated: StatedProblem, a: Any, b: Any) -> Any:
    """Control points of least energy, (3, N), from the rows of both bases, each (3, rows times n)."""
    problem = stated.problem
    form, system = problem.form, problem.plain_system
    # Asking for the points that Python finds refuses a system that cannot be trusted.
    points_found = problem.control_points(*problem.start)
    off = float(np.abs(system.solved_at_once(points_found) - points_found).max())
    if not off <= TRUSTED_SOLVE:
        raise ComputationError(
            f"C code: one linear solve, without the refinement that blend has, is off by {off:.1e} of the size, "
            f"expected at most {TRUSTED_SOLVE:.0e}; take knots further apart"
        )
    n_rows = len(form.rows)
    points: list[Any] = [None] * n_rows
    for (side, order, spans), given, value in zip(problem.contacts, (a, b), problem.start, strict=True):
        base = [row.T for row in ca.horzsplit(given, side.along.size)]
        for i, row in zip(order, contact_rows(side, value, form.u.degree, spans, base), strict=False):
            points[i] = row
    if system.size:
        # Around the first point of a, so that a model far from the origin loses no digits.
        centre = a[:, 0].T
        right = []
        for i in problem.free_rows:
            terms = [
                ca.mtimes(casadi_matrix(block.tocsc()), points[j] - ca.repmat(centre, form.rows[j].size, 1))
                for (row, j), block in system.blocks.items()
                if row == i and j not in problem.free_rows
            ]
            right.append(-sum(terms[1:], terms[0]))
        z = ca.DM.eye(system.size) if system.z is None else casadi_matrix(system.z.tocsc())
        # Sorting, and Z where closed rows stay smooth, in one constant matrix.
        z = z[:, system.order.tolist()]
        # Upper triangular R with R'R = matrix, sparse: the order makes the matrix banded.
        root = ca.MX(ca.chol(casadi_matrix(system.matrix)))
        y = ca.solve(root, ca.solve(root.T, ca.mtimes(z.T, ca.vertcat(*right))))
        free = ca.mtimes(z, y) + ca.repmat(centre, system.size, 1)
        ends = np.cumsum([0, *(form.rows[i].size for i in problem.free_rows)]).tolist()
        for i, row in zip(problem.free_rows, ca.vertsplit(free, ends), strict=True):
            points[i] = row
    return ca.vertcat(*points).T
