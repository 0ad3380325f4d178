"""The numeric referee: the textbook triangular algorithm, slow and plain, over arrays of points.

It shares no code with the evaluation in `surfaces`: it finds spans, differences control points and runs the
triangle itself.

Source: C. de Boor, A Practical Guide to Splines, ch. X; Piegl and Tiller, The NURBS Book, ch. 3 and 4.
"""

from __future__ import annotations

from math import comb

import numpy as np
from numpy.typing import ArrayLike

from solver.arrays import FloatArray
from solver.surfaces import BSplineSurface, SemiStructuredSurface


def curve_points(
    degree: int, knots: FloatArray, control_points: FloatArray, x: FloatArray, derivative: int = 0
) -> FloatArray:
    """Evaluate a B-spline curve or one of its derivatives.

    Parameters
    ----------
    degree : int
    knots : ndarray, shape (n + degree + 1,)
    control_points : ndarray, shape (n, d) for one curve, or (K, n, d) for a curve of its own at each parameter
    x : ndarray, shape (K,)
        Parameters in the domain.
    derivative : int
        Order of the derivative; zero above the degree.

    Returns
    -------
    ndarray, shape (K, d)

    Examples
    --------
    >>> curve_points(1, np.array([0, 0, 2.0, 2]), np.array([[0.0], [6]]), np.array([0.5]), 1)
    array([[3.]])
    """
    n, d = control_points.shape[-2:]
    if derivative > degree:
        return np.zeros((len(x), d))
    # The span k has t_k <= x < t_(k+1); the end of the domain belongs to the last span, which ends at t_n.
    k = np.clip(np.searchsorted(knots, x, side="right") - 1, degree, n - 1)
    local = k[:, None] - degree + np.arange(degree + 1)
    if control_points.ndim == 2:
        points = [control_points[local[:, j]] for j in range(degree + 1)]
    else:
        points = [control_points[np.arange(len(x)), local[:, j]] for j in range(degree + 1)]
    for s in range(1, derivative + 1):
        for j in range(degree - s + 1):
            i = local[:, j]
            width = knots[i + degree + 1] - knots[i + s]
            points[j] = (degree - s + 1) * (points[j + 1] - points[j]) / width[:, None]
        points.pop()
    p = degree - derivative
    for level in range(1, p + 1):
        for j in range(p, level - 1, -1):
            left = knots[k - p + j]
            right = knots[k + 1 + j - level]
            a = ((x - left) / (right - left))[:, None]
            points[j] = (1 - a) * points[j - 1] + a * points[j]
    return np.asarray(points[p])


def _homogeneous(surface: BSplineSurface, u: FloatArray, v: FloatArray, du: int, dv: int) -> FloatArray:
    net = surface.control_points
    if surface.weights is not None:
        net = np.concatenate([net * surface.weights[..., None], surface.weights[..., None]], axis=2)
    n_u, n_v, d = net.shape
    # All rows are curves over the same knots: one curve in n_u d dimensions.
    rows = curve_points(surface.degree_v, surface.knots_v, net.transpose(1, 0, 2).reshape(n_v, n_u * d), v, dv)
    return curve_points(surface.degree_u, surface.knots_u, rows.reshape(len(v), n_u, d), u, du)


def surface_points(
    surface: BSplineSurface | SemiStructuredSurface, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0
) -> FloatArray:
    """Evaluate a surface or one of its mixed derivatives at the points (u[k], v[k]).

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    u, v : array_like, shape (K,)
    du, dv : int
        Orders of the derivative.

    Returns
    -------
    ndarray, shape (K, 3)
    """
    u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
    if isinstance(surface, SemiStructuredSurface):
        rows = np.stack(
            [curve_points(c.degree, c.knots, c.control_points, v, dv) for c in surface.control_curves], axis=1
        )
        return curve_points(surface.degree_u, surface.knots_u, rows, u, du)
    value = _homogeneous(surface, u, v, du, dv)
    if surface.weights is None:
        return value
    # Quotient rule, order by order: (w S)^(a,b) = sum of binomials w^(i,j) S^(a-i,b-j).
    weight = {(i, j): _homogeneous(surface, u, v, i, j)[:, 3:] for i in range(du + 1) for j in range(dv + 1)}
    known: dict[tuple[int, int], FloatArray] = {}
    for a in range(du + 1):
        for b in range(dv + 1):
            total = _homogeneous(surface, u, v, a, b)[:, :3]
            for i in range(a + 1):
                for j in range(b + 1):
                    if (i, j) != (0, 0):
                        total = total - comb(a, i) * comb(b, j) * weight[i, j] * known[a - i, b - j]
            known[a, b] = total / weight[0, 0]
    return known[du, dv]
