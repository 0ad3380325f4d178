"""Which homogeneous representative of a base near its edge a blend is built on: weights with tame means.

lambda(w, v) (X, om), with any lambda > 0, is the same surface as (X, om): the rows of a blend may be built on any of
them. The one chosen here is (X, om) / m(w), m the mean of om along the edge: its mean weight is 1 at the edge, and no
derivative across changes it. Where om = f(w) g(v), as on all cylinders, cones, spheres, tori, extrusions and
revolutions, no derivative of the weight is left: the weights of the rows are then those of the edge, whatever alpha is.
"""

from __future__ import annotations

from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.generated import contact_numpy, rows_numpy
from semispline.solver.splines import Basis

# Weights are f(w) g(v) where the second singular value of their matrix is below this fraction of the first.
SEPARABLE = 1e-12
# A factor of the rows that would change the last row by less than this is rounding.
_ROUNDING = 1e-14


def is_separable(weights: FloatArray) -> bool:
    """Tell whether weights are a function across times one along: shape (rows, n), rows 0 to the order of contact.

    Examples
    --------
    >>> is_separable(np.outer([1, 2], [1, 0.5, 1])), is_separable(np.array([[1, 0.5, 1], [1, 0.6, 1]]))
    (True, False)
    """
    values = np.linalg.svd(weights, compute_uv=False)
    return len(values) < 2 or bool(values[1] < SEPARABLE * values[0])


def spline_mean(along: Basis, values: FloatArray) -> FloatArray:
    """Return the means of splines over the domain; the last axis of `values` goes along.

    Examples
    --------
    >>> spline_mean(Basis(2, np.array([0, 0, 0, 1.0, 1, 1])), np.array([0, 0, 3.0]))
    array(1.)
    """
    q, knots = along.degree, along.knots
    shares = (knots[q + 1 :] - knots[: -q - 1]) / ((q + 1) * (knots[-1] - knots[0]))
    return np.asarray(values @ shares)


def end_derivatives(order: int, degree: int, spans: tuple[float, ...]) -> FloatArray:
    """Return the derivatives of order 0..order at the edge by the rows, shape (order + 1, order + 1)."""
    if order == 0:
        return np.ones((1, 1))
    return np.asarray(getattr(contact_numpy, f"end_derivatives_{order}")(degree, *spans[:order]))


def rows_from_derivatives(order: int, degree: int, spans: tuple[float, ...]) -> FloatArray:
    """Return the inverse of `end_derivatives`; the degree must be at least the order."""
    if order == 0:
        return np.ones((1, 1))
    return np.asarray(getattr(rows_numpy, f"rows_from_derivatives_{order}")(degree, *spans[:order]))


def normalised_rows(rows: FloatArray, along: Basis, degree: int, spans: tuple[float, ...]) -> tuple[FloatArray, int]:
    """Return rows of the representative whose mean weight is 1 at the edge and has no derivatives across.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 4)
        Homogeneous control rows of the base, (om X, om), from the edge inwards. Those that a base of low degree lacks
        may have any values.
    along : Basis
    degree : int
        Of the base, across.
    spans : tuple of float
        Distances from the edge to the next knots across, as many as the order at least.

    Returns
    -------
    rows : ndarray, shape (order + 1, n, 4)
        Constant combinations of the given ones: to this order the same surface.
    degree : int
        That of the new rows, across: the order, where the base has a lower degree and its weights change across.

    Source: with m_k the mean of the k-th derivative of om across, the jet c of 1 / m is c_0 = 1 / m_0,
    c_k = -c_0 sum_(j=1..k) binom(k, j) m_j c_(k-j), and the new derivatives are sum_j binom(k, j) c_(k-j) (those of
    order j), as `semispline.derivations.homogeneous` derives; step by step, since the expanded jet loses digits.

    Examples
    --------
    >>> cone = np.array([[[1, 0, 0, 1], [0, 0, 0, 0.5]], [[4, 0, 2, 2], [0, 0, 1, 1]]])
    >>> normalised_rows(cone, Basis(1, np.array([0, 0, 1.0, 1])), 1, (1.0,))[0][:, :, 3]
    array([[1.33333333, 0.66666667],
           [1.33333333, 0.66666667]])
    """
    order = len(rows) - 1
    derivatives = end_derivatives(order, degree, spans)
    means = spline_mean(along, rows[:, :, 3])
    # Equal means have no derivatives, whatever the spans are.
    means[1:] = derivatives[1:] @ (means - means[0])
    jet = np.zeros(order + 1)
    jet[0] = 1 / means[0]
    for k in range(1, order + 1):
        jet[k] = -jet[0] * sum(comb(k, j) * means[j] * jet[k - j] for j in range(1, k + 1))
    change = np.array([[comb(k, j) * jet[k - j] if j < k else 0.0 for j in range(order + 1)] for k in range(order + 1)])
    sizes = np.cumprod([1.0, *spans[:order]])
    if (np.abs(jet[1:]) * sizes[1:] <= _ROUNDING * jet[0]).all():
        return rows * jet[0], degree
    new = max(degree, order)
    if new == degree:
        # The identity is not put together from its factors: polynomial rows stay themselves.
        matrix = jet[0] * np.eye(order + 1) + rows_from_derivatives(order, new, spans) @ change @ derivatives
    else:
        matrix = rows_from_derivatives(order, new, spans) @ (jet[0] * np.eye(order + 1) + change) @ derivatives
    return np.asarray(np.einsum("ij,jnd->ind", matrix, rows)), new
