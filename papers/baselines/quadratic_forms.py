"""Quadratic energies of surfaces made of rows, each row over its own knots: thin-plate and triharmonic.

Both are sums of squares of sums of derivatives, integrated by a Gauss rule that is exact for such polynomials. They
share no code with `semispline.solver.blending.gram` and so check it, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp

from semispline.papers.baselines.interface import NotApplicableError
from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.splines import (
    Basis,
    basis_matrix,
    breakpoints,
    derivative_matrix,
    inner_knots,
    merge_breakpoints,
)

Squares: TypeAlias = Sequence[tuple[float, Sequence[tuple[int, int]]]]

# Each energy: the squares that are added up; each square: a sum of derivatives (du, dv), and its factor.
THIN_PLATE = ((1.0, ((2, 0),)), (2.0, ((1, 1),)), (1.0, ((0, 2),)))
TRIHARMONIC = ((1.0, ((3, 0), (1, 2))), (1.0, ((2, 1), (0, 3))))


def energy_matrix(u: Basis, rows: Sequence[Basis], squares: Squares) -> SparseMatrix:
    """Return H, so that the energy is trace(p' H p); p stacks the control points of all rows.

    Parameters
    ----------
    u : Basis
    rows : sequence of Basis
        As many as `u` has functions.
    squares : sequence
        `THIN_PLATE` or `TRIHARMONIC`.

    Raises
    ------
    NotApplicableError
        A derivative that is squared is no function: an inner knot leaves too little continuity.

    Examples
    --------
    >>> hat = Basis(1, np.array([0.0, 0, 1, 1]))
    >>> energy_matrix(hat, (hat, hat), THIN_PLATE).toarray()[0]
    array([ 2., -2., -2.,  2.])
    """
    highest = max(max(order) for _, terms in squares for order in terms)
    for name, basis in (("u", u), *(("v", basis) for basis in rows)):
        _check_smooth(name, basis, highest)
    U, weights_u = _samples([u], highest)
    V, weights_v = _samples(rows, highest)
    # The derivative (du, dv) of every control point's function at all Gauss points: rows side by side.
    total = sp.csr_array((sum(basis.size for basis in rows),) * 2)
    root = sp.diags_array(np.sqrt(np.multiply.outer(weights_u, weights_v).ravel()))
    for factor, terms in squares:
        values = sum(
            sp.hstack([sp.kron(U[0][du][:, [i]], V[i][dv]) for i in range(len(rows))], format="csr") for du, dv in terms
        )
        weighted = root @ values
        total = total + factor * (weighted.T @ weighted)
    return total.tocsr()


def _samples(bases: Sequence[Basis], highest: int) -> tuple[list[list[SparseMatrix]], FloatArray]:
    """Return derivatives of order 0 .. highest of every basis at common Gauss points, and the weights."""
    breaks = merge_breakpoints(*(breakpoints(basis.knots) for basis in bases))
    points, weights = np.polynomial.legendre.leggauss(max(basis.degree for basis in bases) + 1)
    half = np.diff(breaks)[:, None] / 2
    x = ((breaks[:-1, None] + breaks[1:, None]) / 2 + half * points).ravel()
    return [[_derivatives(basis, order, x) for order in range(highest + 1)] for basis in bases], (
        half * weights
    ).ravel()


def _derivatives(basis: Basis, order: int, x: FloatArray) -> SparseMatrix:
    p, knots = basis.degree, basis.knots
    if order > p:
        return sp.csr_array((len(x), basis.size))
    lower = basis_matrix(p - order, knots[order : len(knots) - order], x)
    return (lower @ derivative_matrix(p, knots, order)).tocsr()


def _check_smooth(name: str, basis: Basis, order: int) -> None:
    counts = np.unique(inner_knots(basis.knots, basis.degree), return_counts=True)[1]
    least = basis.degree - int(counts.max(initial=0))
    if len(counts) and least < order - 1:
        raise NotApplicableError(
            f"{name}-knots: an inner knot leaves C{least}, so a derivative of order {order} is no function"
        )
