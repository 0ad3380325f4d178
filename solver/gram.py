"""Sparse Gram matrices between different knot vectors, and the thin-plate energy they add up to.

A product of two spline pieces is a polynomial on each merged span, so a Gauss rule of enough points integrates it
exactly up to rounding. Time and memory are linear in the number of knots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from solver.arrays import FloatArray, SparseMatrix
from solver.errors import InputError
from solver.generated.energy_numpy import gram_block, thin_plate_density
from solver.knots import basis_matrix, breakpoints, derivative_matrix, merge_breakpoints
from solver.surfaces import BSplineSurface, Surface

# Keeps the memory of an energy evaluation bounded on long surfaces.
_SPANS_AT_ONCE = 4096


@dataclass(frozen=True, eq=False)
class Basis:
    """A spline space in one direction: degree and clamped knots."""

    degree: int
    knots: FloatArray

    @property
    def size(self) -> int:
        """Number of basis functions."""
        return len(self.knots) - self.degree - 1


def gauss_rule(breaks: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Return points and weights that integrate piecewise polynomials of `degree` over `breaks` exactly.

    Examples
    --------
    >>> x, w = gauss_rule(np.array([0.0, 1.0, 3.0]), 3)
    >>> round(float(w @ x**3), 12)
    20.25
    """
    points, weights = np.polynomial.legendre.leggauss(degree // 2 + 1)
    half = np.diff(breaks)[:, None] / 2
    middle = (breaks[:-1, None] + breaks[1:, None]) / 2
    return (middle + half * points).ravel(), (half * weights).ravel()


def gram_matrix(a: Basis, b: Basis, order: int = 0) -> SparseMatrix:
    """Return the integrals of products of `order`-th derivatives, taken span by span.

    Parameters
    ----------
    a, b : Basis
        Over one domain; degrees and knots may differ.
    order : int

    Returns
    -------
    sparse array, shape (a.size, b.size)

    Examples
    --------
    >>> hat = Basis(1, np.array([0.0, 0, 1, 1]))
    >>> gram_matrix(hat, hat, 1).toarray()
    array([[ 1., -1.],
           [-1.,  1.]])
    """
    breaks = merge_breakpoints(breakpoints(a.knots), breakpoints(b.knots))
    x, w = gauss_rule(breaks, max(a.degree + b.degree - 2 * order, 0))
    left, right = (_sampled_derivative(basis, x, order) for basis in (a, b))
    return (left.T @ (sp.diags_array(w) @ right)).tocsr()


def _sampled_derivative(basis: Basis, x: FloatArray, order: int) -> SparseMatrix:
    if order > basis.degree:
        return sp.csr_array((len(x), basis.size))
    knots = basis.knots[order : len(basis.knots) - order]
    values = basis_matrix(basis.degree - order, knots, x)
    return values @ derivative_matrix(basis.degree, basis.knots, order) if order else values


def energy_matrix(u: Basis, rows: Sequence[Basis]) -> SparseMatrix:
    """Return the matrix H of the thin-plate energy (11) of a semi-structured surface: E = sum over x, y, z of p'Hp.

    Parameters
    ----------
    u : Basis
        Of size m + 1.
    rows : sequence of Basis, length m + 1
        The spaces of the v-control curves; p stacks the control points of all curves in order.

    Returns
    -------
    sparse array, shape (N, N), N the number of control points; symmetric
    """
    across = [gram_matrix(u, u, d).toarray() for d in range(3)]
    distinct: list[Basis] = []
    kind: list[int] = []
    for row in rows:
        found = [k for k, other in enumerate(distinct) if _same(row, other)]
        if not found:
            distinct.append(row)
        kind.append(found[0] if found else len(distinct) - 1)
    along: dict[tuple[int, int], list[SparseMatrix]] = {}
    for k in set(kind):
        for j in set(kind):
            if k <= j:
                along[k, j] = [gram_matrix(distinct[k], distinct[j], d) for d in range(3)]
                along[j, k] = [g.T.tocsr() for g in along[k, j]] if j != k else along[k, j]
    blocks: list[list[SparseMatrix | None]] = [
        [
            gram_block(*(a[i, j] for a in across), *along[kind[i], kind[j]]) if abs(i - j) <= u.degree else None
            for j in range(len(rows))
        ]
        for i in range(len(rows))
    ]
    return sp.block_array(blocks, format="csr")


def _same(a: Basis, b: Basis) -> bool:
    return a.degree == b.degree and np.array_equal(a.knots, b.knots)


def thin_plate_energy(surface: Surface) -> float:
    """Return the thin-plate energy (11), span by span, as a sum of squares of second derivatives at Gauss points.

    The rule is exact up to rounding for polynomial surfaces. A sum of squares keeps its accuracy where p'Hp cancels.

    Raises
    ------
    InputError
        The surface is rational: its energy is no polynomial integral.

    Source: equation (11).

    Examples
    --------
    >>> saddle = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])
    >>> round(thin_plate_energy(saddle), 12)
    2.0
    """
    if isinstance(surface, BSplineSurface) and surface.weights is not None:
        raise InputError("surface: rational, but the thin-plate energy is computed for polynomial surfaces only")
    breaks_u, breaks = surface.breakpoints
    u, w_u = gauss_rule(breaks_u, 2 * surface.degree_u)
    total = 0.0
    for first in range(0, len(breaks) - 1, _SPANS_AT_ONCE):
        v, w_v = gauss_rule(breaks[first : first + _SPANS_AT_ONCE + 1], 2 * surface.degree_v)
        second = [surface.evaluate_grid(u, v, du, 2 - du) for du in (2, 1, 0)]
        total += float(w_u @ thin_plate_density(*second) @ w_v)
    return total
