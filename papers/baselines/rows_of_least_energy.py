"""Rows of control points of least energy, where the rows at the contacts are polynomials in alpha^2 and beta^2.

Shared by the methods that fix rows at both contacts and minimise a quadratic energy over the rest. It shares no code
with `blending.reduced` and so checks it, too; but it proves nothing: the two shape parameters are searched from a grid.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import scipy.sparse as sp
from scipy.linalg import null_space
from scipy.optimize import minimize
from scipy.sparse.linalg import splu

from semispline.papers.baselines.contacts import ContactSide
from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.generated import contact_numpy
from semispline.solver.splines import Basis, derivative_matrix

# alpha^2 -> the rows that contact prescribes, from the contact inwards, shape (rows, n, 3); of degree 2 in alpha^2.
RowRule: TypeAlias = Callable[[float], FloatArray]

_GRID = 81
_STARTS = 6


@dataclass(frozen=True, eq=False)
class Minimum:
    """Rows of least energy.

    Attributes
    ----------
    rows : tuple of ndarray, each of shape (n_i, 3)
    a, b : float
        alpha^2 and beta^2.
    energy : float
    """

    rows: tuple[FloatArray, ...]
    a: float
    b: float
    energy: float


def contact_rule(side: ContactSide, order: int, u: Basis) -> RowRule:
    """Return the rule for contact of an order, by the rows that are derived, not printed.

    Source: generated from `semispline.derivations.contact`; U is symmetric, so it serves both ends.
    """
    p, q, net, across = u.degree, side.surface.degree_u, side.surface.control_points, side.surface.knots_u
    h = [float(u.knots[p + r] - u.knots[0]) for r in (1, 2)]
    H = [float(across[min(q + r, len(across) - 1)] - across[0]) for r in (1, 2)]

    def rule(a: float) -> FloatArray:
        if order == 1:
            matrix = contact_numpy.contact_rows_1(a, p, h[0], q, H[0])
        else:
            matrix = contact_numpy.contact_rows_2(a, p, h[0], h[1], q, H[0], H[1])
        return np.asarray(np.einsum("ij,jnd->ind", matrix, net[: order + 1]))

    return rule


def closed_rows(basis: Basis) -> FloatArray:
    """Return Z, shape (n, n - 3): control points Z y are those of all curves that are C2 across the seam."""
    lines = []
    for order in range(min(basis.degree, 3)):
        matrix = derivative_matrix(basis.degree, basis.knots, order).toarray()
        difference = matrix[0] - matrix[-1]
        lines.append(difference / np.abs(difference).max())
    return np.asarray(null_space(np.stack(lines)))


def least_energy(
    matrix: SparseMatrix,
    bases: Sequence[Basis],
    rules: tuple[RowRule, RowRule],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    closed: bool = False,
) -> Minimum:
    """Minimise trace(p' H p) over the free rows and, within bounds, over alpha^2 and beta^2.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        H, symmetric; p stacks the control points of all rows.
    bases : sequence of Basis
        Of each row.
    rules : pair of RowRule
        For the first rows, and for the last ones from the end inwards.
    bounds : pair of (float, float)
        low = high fixes a parameter.
    closed : bool
        Whether free rows are closed and C2 across the seam.
    """
    offsets = np.concatenate([[0], np.cumsum([basis.size for basis in bases])])
    powers = np.zeros((5, offsets[-1], 3))
    for side, rule in enumerate(rules):
        for i, row in enumerate(_powers(rule).transpose(1, 0, 2, 3)):
            place = i if side == 0 else len(bases) - 1 - i
            part = powers[:, offsets[place] : offsets[place + 1]]
            # In the order 1, a, a^2, b, b^2; the constants of both sides share the first.
            part[0] += row[0]
            part[1 + 2 * side : 3 + 2 * side] = row[1:]
    counts = [len(rule(1.0)) for rule in rules]
    free = range(counts[0], len(bases) - counts[1])
    powers = _completed(
        matrix, powers, slice(offsets[free.start], offsets[free.stop]), [bases[i] for i in free], closed
    )
    flat = powers.transpose(1, 0, 2).reshape(offsets[-1], -1)
    image = (matrix @ flat).reshape(offsets[-1], 5, 3)
    gram = np.einsum("knd,nld->kl", powers, image)
    a, b = _searched((gram + gram.T) / 2, bounds)
    points = np.einsum("k,knd->nd", _monomials(a, b), powers)
    energy = float(np.sum(points * (matrix @ points)))
    return Minimum(tuple(np.split(points, offsets[1:-1])), a, b, energy)


def _powers(rule: RowRule) -> FloatArray:
    """Return the coefficients of 1, a, a^2 of the rows, shape (3, rows, n, 3); exact for polynomials of degree 2."""
    at = [rule(value) for value in (0.0, 1.0, 2.0)]
    second = (at[2] - 2 * at[1] + at[0]) / 2
    return np.stack([at[0], at[1] - at[0] - second, second])


def _completed(
    matrix: SparseMatrix, powers: FloatArray, free: slice, bases: Sequence[Basis], closed: bool
) -> FloatArray:
    """Fill the free rows of each coefficient: they are linear in the prescribed ones."""
    if free.stop == free.start:
        return powers
    blocks = [sp.csr_array(closed_rows(basis)) if closed else sp.eye_array(basis.size) for basis in bases]
    span = sp.block_diag(blocks, format="csr")
    lines = span.T @ matrix.tocsr()[free]
    right = -(lines @ powers.transpose(1, 0, 2).reshape(powers.shape[1], -1))
    solution = span @ splu((lines[:, free] @ span).tocsc()).solve(right)
    filled = powers.copy()
    filled[:, free] = solution.reshape(-1, *powers.shape[::2]).transpose(1, 0, 2)
    return filled


def _monomials(a: Any, b: Any) -> Any:
    return np.stack([np.ones_like(a + b), a + 0 * b, a**2 + 0 * b, b + 0 * a, b**2 + 0 * a])


def _searched(gram: FloatArray, bounds: tuple[tuple[float, float], tuple[float, float]]) -> tuple[float, float]:
    """Return the least point of the quartic m' G m, m = (1, a, a^2, b, b^2), found from the best points of a grid."""
    axes = [np.geomspace(low, high, _GRID) if low < high else np.array([low]) for low, high in bounds]
    a, b = np.meshgrid(*axes, indexing="ij")
    m = _monomials(a, b)
    values = np.einsum("kij,kl,lij->ij", m, gram, m)
    scale = float(np.abs(values).min()) or 1.0

    def objective(x: FloatArray) -> tuple[float, FloatArray]:
        m = _monomials(x[0], x[1])
        slopes = np.array([[0, 1, 2 * x[0], 0, 0], [0, 0, 0, 1, 2 * x[1]]])
        return float(m @ gram @ m) / scale, 2 * slopes @ gram @ m / scale

    best = _lowest(values)
    found = [
        minimize(objective, (a.flat[i], b.flat[i]), jac=True, method="L-BFGS-B", bounds=bounds, tol=1e-15) for i in best
    ]
    x = min(found, key=lambda f: float(f.fun)).x
    return float(x[0]), float(x[1])


def _lowest(values: FloatArray) -> list[int]:
    """Return flat indices of the lowest local minima of a grid, edges included."""
    padded = np.pad(values, 1, constant_values=np.inf)
    shape = values.shape
    around = [padded[i : i + shape[0], j : j + shape[1]] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    minima = np.flatnonzero(values <= np.min(around, axis=0))
    return [int(i) for i in minima[np.argsort(values.flat[minima])][:_STARTS]]
