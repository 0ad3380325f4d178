"""Derivatives by u of X(u, v) = lambda(u, v) R(w(u, v), v + q(u, v)) at u = 0, where w = q = 0.

Every such surface is in contact with R to any order: a blend may leave it as well as R. The functions of v that lambda,
w and q begin with are free; where strips meet, they decide whether X is smooth along.

Source: `semispline.derivations.chains` has the same derivatives as formulas.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb, factorial

import numpy as np

from semispline.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Reparametrisation:
    """Derivatives by u of order 0..n of lambda, w and q at u = 0, at T values of v: each of shape (n + 1, T).

    Those of order 0 of w and q are 0.
    """

    lam: FloatArray
    w: FloatArray
    q: FloatArray

    @staticmethod
    def of(values: FloatArray) -> Reparametrisation:
        """Return it from an array of shape (3, n + 1) or (3, n + 1, T)."""
        return Reparametrisation(*(x[:, None] if x.ndim == 1 else x for x in values))


def bezier_derivatives(piece: FloatArray, width: float, t: FloatArray, most: int) -> FloatArray:
    """Return derivatives along v of order 0..most at places t in [0, 1] of a span, shape (K, most + 1, T, d).

    Parameters
    ----------
    piece : ndarray, shape (K, degree + 1, d)
        Bezier points of the derivatives by w.
    width : float
        Of the span, in v.
    """
    count, q, d = len(piece), piece.shape[1] - 1, piece.shape[2]
    found, level = np.zeros((count, most + 1, len(t), d)), piece
    for b in range(min(most, q) + 1):
        found[:, b] = np.einsum("ti,aid->atd", bernstein(q - b, t), level)
        level = np.diff(level, axis=1) * ((q - b) / width)
    return found


def composed(derivatives: FloatArray, by: Reparametrisation) -> FloatArray:
    """Return d^j X / du^j, shape (n + 1, T, d), from derivatives of R by w and v, shape (n + 1, n + 1, T, d)."""
    factors = _factorials(len(by.lam))
    lam, w, q = (x / factors[:, None] for x in (by.lam, by.w, by.q))
    return np.asarray(_product(lam[:, :, None], _composed(derivatives, w, q)) * factors[:, None, None])


def slopes_along(derivatives: FloatArray, by: Reparametrisation, slopes: Reparametrisation) -> FloatArray:
    """Return d^(j+1) X / du^j dv, shape (n + 1, T, d); `slopes` are the derivatives of `by` along v.

    X_v = lambda_v R + lambda (1 + q_v) R_v + lambda w_v R_w, R and its derivatives taken at (w, v + q).

    Parameters
    ----------
    derivatives : ndarray, shape (n + 1, n + 2, T, d)
    by, slopes : Reparametrisation
    """
    factors = _factorials(len(by.lam))
    lam, w, q = (x / factors[:, None] for x in (by.lam, by.w, by.q))
    lam_v, w_v, q_v = (x / factors[:, None] for x in (slopes.lam, slopes.w, slopes.q))
    q_v = q_v.copy()
    q_v[0] += 1.0
    # The last derivative by w is met by w_v, which begins with u: what stands there does not count.
    by_w = np.concatenate([derivatives[1:], derivatives[-1:]])
    total = _product(lam_v[:, :, None], _composed(derivatives, w, q))
    total += _product(_product(lam, q_v)[:, :, None], _composed(derivatives[:, 1:], w, q))
    total += _product(_product(lam, w_v)[:, :, None], _composed(by_w, w, q))
    return np.asarray(total * factors[:, None, None])


def _composed(derivatives: FloatArray, w: FloatArray, q: FloatArray) -> FloatArray:
    """Return the power series in u of R(w, v + q)."""
    order = len(w) - 1
    result = np.zeros((order + 1, *derivatives.shape[2:]))
    shifted = np.zeros_like(w)
    shifted[0] = 1.0
    for b in range(min(order, derivatives.shape[1] - 1) + 1):
        power = shifted
        for a in range(order + 1 - b):
            result += power[:, :, None] * derivatives[a, b] / (factorial(a) * factorial(b))
            power = _product(power, w)
        shifted = _product(shifted, q)
    return result


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the product of power series, cut off where they are."""
    total = a[0] * b
    for i in range(1, len(a)):
        total[i:] += a[i] * b[:-i]
    return np.asarray(total)


def _factorials(count: int) -> FloatArray:
    return np.array([factorial(j) for j in range(count)], dtype=np.float64)


def bernstein(degree: int, t: FloatArray) -> FloatArray:
    """Return the Bernstein polynomials at places t, shape (T, degree + 1)."""
    return np.stack([comb(degree, k) * t**k * (1 - t) ** (degree - k) for k in range(degree + 1)], axis=1)


def chebyshev_places(count: int) -> FloatArray:
    """Return places in [0, 1], both ends included, at which polynomials are told well."""
    return np.asarray((1 - np.cos(np.linspace(0, np.pi, count))) / 2)


def bezier_points(values: FloatArray) -> FloatArray:
    """Return Bezier points, shape (K, degree + 1, d), from values at `chebyshev_places`, of the same shape."""
    degree = values.shape[1] - 1
    flat = values.transpose(1, 0, 2).reshape(degree + 1, -1)
    points = np.linalg.solve(bernstein(degree, chebyshev_places(degree + 1)), flat)
    return np.asarray(points.reshape(degree + 1, len(values), -1).transpose(1, 0, 2))


def elevation(degree: int, new: int) -> FloatArray:
    """Return the matrix that raises the degree of Bezier points."""
    by = new - degree
    return np.array(
        [
            [comb(degree, i) * comb(by, j - i) / comb(new, j) if 0 <= j - i <= by else 0.0 for i in range(degree + 1)]
            for j in range(new + 1)
        ]
    )
