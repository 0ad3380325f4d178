"""A spline space in one direction, and Gauss rules that integrate its products exactly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray

IndexArray: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Basis:
    """A spline space in one direction: degree and clamped knots."""

    degree: int
    knots: FloatArray

    @property
    def size(self) -> int:
        """Number of basis functions."""
        return len(self.knots) - self.degree - 1

    def same_as(self, other: Basis) -> bool:
        """Tell whether both have the same degree and knots."""
        return self.degree == other.degree and np.array_equal(self.knots, other.knots)


@dataclass(frozen=True, eq=False)
class Samples:
    """A basis and its derivatives at Gauss points, the points of one merged span together.

    Spans are the last axis: there are many of them, and few points and functions on each.

    Attributes
    ----------
    basis : Basis
    weights : ndarray, shape (G, S)
    first : ndarray of int, shape (S,)
        Index of the first basis function that lives on the span; the same for the derivative's basis.
    lower : tuple of ndarray, each of shape (degree - order + 1, G, S)
        The basis functions of the derivative of order 0, 1, 2, to be multiplied with its control points.
    """

    basis: Basis
    weights: FloatArray
    first: IndexArray
    lower: tuple[FloatArray, ...]

    def local(self, order: int = 0) -> IndexArray:
        """Return indices of the derivative's basis functions that live on each span, shape (degree - order + 1, S)."""
        return np.asarray(self.first + np.arange(self.basis.degree - order + 1)[:, None])

    def derivative(self, order: int) -> FloatArray:
        """Return derivatives of the basis functions themselves, shape (degree + 1, G, S)."""
        if order > self.basis.degree:
            return np.zeros((self.basis.degree + 1, *self.weights.shape))
        return raised_bases(self.basis, self.first, self.lower[order], order)

    def curves(self, points: FloatArray, order: int) -> FloatArray:
        """Return values from control points of the derivative, shape (C, degree - order + n): shape (C, G, S)."""
        return np.asarray(np.einsum("kgs,cks->cgs", self.lower[order], points[:, self.local(order)]))

    def add_transposed(self, values: FloatArray, order: int, total: FloatArray) -> None:
        """Add to `total` the transpose of `curves` applied to values, shape (C, G, S)."""
        place = self.local(order)
        low, high = int(place.min()), int(place.max()) + 1
        entries = np.einsum("kgs,cgs->cks", self.lower[order], values)
        for line, part in zip(total, entries, strict=True):
            line[low:high] += np.bincount((place - low).ravel(), part.ravel(), minlength=high - low)


@cache
def _legendre(points: int) -> tuple[FloatArray, FloatArray]:
    return np.polynomial.legendre.leggauss(points)


def gauss_rule(breaks: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Return points and weights that integrate piecewise polynomials of `degree` over `breaks` exactly.

    Returns
    -------
    points, weights : ndarray, shape (G, S)
        One column for each span.

    Examples
    --------
    >>> x, w = gauss_rule(np.array([0.0, 1.0, 3.0]), 3)
    >>> round(float(np.sum(w * x**3)), 12)
    20.25
    """
    points, weights = _legendre(degree // 2 + 1)
    half = np.diff(breaks) / 2
    return (breaks[:-1] + breaks[1:]) / 2 + half * points[:, None], half * weights[:, None]


def sample(basis: Basis, breaks: FloatArray, degree: int) -> Samples:
    """Sample a basis at the Gauss points that integrate polynomials of `degree` on every span of `breaks`."""
    x, weights = gauss_rule(breaks, degree)
    first = first_on_spans(basis, breaks)
    return Samples(basis, weights, first, local_bases(basis, x, first, 2))


def local_bases(basis: Basis, x: FloatArray, first: IndexArray, orders: int) -> tuple[FloatArray, ...]:
    """Return the basis functions of derivatives of order 0 .. `orders`, as far as the degree goes, on given spans.

    Parameters
    ----------
    basis : Basis
    x : ndarray, shape (G, S)
        Points of each span; on its ends the values are limits from inside.
    first : ndarray of int, shape (S,)
        Index of the first basis function that lives on the span.

    Returns
    -------
    tuple of ndarray, each of shape (degree - order + 1, G, S)
        To be multiplied with the control points of the derivative.

    Source: Cox-de Boor.
    """
    p, t = basis.degree, basis.knots
    span = first + p
    values = np.ones((1, *x.shape))
    lower = [values]
    for d in range(1, p + 1):
        # Each function of degree d - 1 rises into the next of degree d and falls out of its own.
        i = span - d + 1 + np.arange(d)[:, None]
        left, right = t[i], t[i + d]
        scaled = values / (right - left)[:, None]
        values = np.zeros((d + 1, *x.shape))
        values[1:] = (x - left[:, None]) * scaled
        values[:-1] += (right[:, None] - x) * scaled
        lower = [values, *lower[:orders]]
    return tuple(lower)


def raised_bases(basis: Basis, first: IndexArray, values: FloatArray, order: int) -> FloatArray:
    """Return derivatives of the basis functions themselves from the basis of the derivative, shape (degree + 1, G, S).

    The basis of the derivative's degree is raised step by step:
    N'_(i,p) = p (N_(i,p-1) / (t_(i+p) - t_i) - N_(i+1,p-1) / (t_(i+p+1) - t_(i+1))).
    """
    p, t = basis.degree, basis.knots
    for degree in range(p - order + 1, p + 1):
        # The p functions of the lower degree have indices first + (p + 1 - degree) .. in the full vector.
        i = first + (p - degree + 1) + np.arange(degree)[:, None]
        scaled = values * (degree / (t[i + degree] - t[i]))[:, None]
        values = np.zeros((degree + 1, *values.shape[1:]))
        values[1:] += scaled
        values[:-1] -= scaled
    return values


def first_on_spans(basis: Basis, breaks: FloatArray) -> IndexArray:
    """Return the index of the first basis function that lives on each span of `breaks`."""
    return np.searchsorted(basis.knots, (breaks[:-1] + breaks[1:]) / 2, side="right") - 1 - basis.degree
