"""Least triharmonic energy: the integral of |grad Laplace p|^2, with position and two cross derivatives fixed.

Unlike thin-plate energy it is one order above what curvature contact prescribes, so that refinement in u does not lose
the curvature. Both energies are minimised over the same refined space here: the union of knots in v, and more rows.

Source: P. Kiciak, Bicubic B-spline blending patches with optimized shape, CAD 43 (2011).
"""

from __future__ import annotations

import time
from functools import partial

import numpy as np
import scipy.sparse as sp

from papers.baselines.contacts import contact_sides, on_common_knots
from papers.baselines.interface import BlendTask, Method, NotApplicableError, Outcome
from papers.baselines.layout import tensor_product, u_basis
from papers.baselines.least_energy import contact_rule, least_energy
from solver.arrays import FloatArray, SparseMatrix
from solver.gram import Basis, EnergyForm
from solver.knots import basis_matrix, breakpoints, derivative_matrix, inner_knots

ROWS = 11


def derivative_grams(basis: Basis) -> FloatArray:
    """Return the integrals of products of derivatives, shape (4, 4, n, n): entry [d, e] of N^(d) and N^(e)."""
    p, knots = basis.degree, basis.knots
    points, weights = np.polynomial.legendre.leggauss(p + 1)
    breaks = breakpoints(knots)
    half = np.diff(breaks)[:, None] / 2
    x = ((breaks[:-1, None] + breaks[1:, None]) / 2 + half * points).ravel()
    w = (half * weights).ravel()
    values = np.zeros((4, len(x), basis.size))
    for d in range(min(p, 3) + 1):
        lower = basis_matrix(p - d, knots[d : len(knots) - d], x)
        values[d] = (lower @ derivative_matrix(p, knots, d)).toarray()
    return np.asarray(np.einsum("x,dxi,exj->deij", w, values, values, optimize=True))


def triharmonic_matrix(u: Basis, v: Basis) -> SparseMatrix:
    """Return H of the integral of |p_uuu + p_uvv|^2 + |p_uuv + p_vvv|^2; control points row by row.

    Raises
    ------
    NotApplicableError
        A third derivative is no function: an inner knot leaves less than C2.
    """
    for name, basis in (("u", u), ("v", v)):
        counts = np.unique(inner_knots(basis.knots, basis.degree), return_counts=True)[1]
        if len(counts) and basis.degree - counts.max() < 2:
            raise NotApplicableError(f"{name}-knots: an inner knot leaves less than C2, so third derivatives are none")
    U, V = derivative_grams(u), derivative_grams(v)
    total = sp.csr_array((u.size * v.size, u.size * v.size))
    # Each sum of two derivatives (du, dv) squared.
    for terms in (((3, 0), (1, 2)), ((2, 1), (0, 3))):
        for d in terms:
            for e in terms:
                total = total + sp.kron(sp.csr_array(U[d[0], e[0]]), sp.csr_array(V[d[1], e[1]]), format="csr")
    return total


def blend_refined(energy: str, task: BlendTask) -> Outcome:
    """Blend with G2 rows of natural size and the least triharmonic or thin-plate energy over the same space."""
    sides = contact_sides(task)
    started = time.perf_counter()
    a, b = on_common_knots(*sides)
    u, v = u_basis(ROWS), a.along
    plate = EnergyForm(u, (v,) * ROWS)
    matrix = triharmonic_matrix(u, v) if energy == "triharmonic" else plate.matrix(range(ROWS))
    rules = contact_rule(a, 2, u), contact_rule(b, 2, u)
    natural = ((a.natural, a.natural), (b.natural, b.natural))
    found = least_energy(matrix, (v,) * ROWS, rules, natural, task.closed)
    surface = tensor_product(u, v, found.rows)
    return Outcome(surface, surface.n_control_points, None, time.perf_counter() - started, found.a, found.b)


METHODS = (
    Method(
        "triharmonic",
        f"triharmonic energy, {ROWS} rows",
        "P. Kiciak, CAD 43 (2011): rows over the union of knots, G2, natural size",
        60,
        partial(blend_refined, "triharmonic"),
    ),
    Method(
        "thin-plate-refined",
        f"thin-plate energy, {ROWS} rows",
        "the same space and rows with energy (11), to compare with",
        61,
        partial(blend_refined, "thin-plate"),
    ),
)
