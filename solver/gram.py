"""Sparse Gram matrices between different knot vectors, and the thin-plate energy they add up to.

A product of two spline pieces is a polynomial on each merged span, so a Gauss rule of enough points integrates it
exactly up to rounding. Time and memory are linear in the number of knots.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from solver.arrays import FloatArray, SparseMatrix
from solver.errors import InputError
from solver.generated.energy_numpy import gram_block
from solver.knots import basis_matrix, breakpoints, derivative_points, merge_breakpoints
from solver.surfaces import BSplineSurface, Surface


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

    Attributes
    ----------
    basis : Basis
    weights : ndarray, shape (S, G)
    first : ndarray of int, shape (S,)
        Index of the first basis function that lives on the span; the same for the derivative's basis.
    lower : tuple of ndarray, each of shape (S, G, degree - order + 1)
        The basis functions of the derivative of order 0, 1, 2, to be multiplied with its control points.
    """

    basis: Basis
    weights: FloatArray
    first: FloatArray
    lower: tuple[FloatArray, ...]

    def local(self, order: int = 0) -> FloatArray:
        """Return indices of the derivative's basis functions that live on each span, shape (S, degree - order + 1)."""
        return np.asarray(self.first[:, None] + np.arange(self.basis.degree - order + 1))

    def derivative(self, order: int) -> FloatArray:
        """Return derivatives of the basis functions themselves, shape (S, G, degree + 1).

        The basis of the derivative's degree is raised step by step:
        N'_(i,p) = p (N_(i,p-1) / (t_(i+p) - t_i) - N_(i+1,p-1) / (t_(i+p+1) - t_(i+1))).
        """
        p, t = self.basis.degree, self.basis.knots
        if order > p:
            return np.zeros((*self.weights.shape, p + 1))
        values = self.lower[order]
        for degree in range(p - order + 1, p + 1):
            # The p functions of the lower degree have indices first + (p + 1 - degree) .. in the full vector.
            i = self.first[:, None] + (p - degree + 1) + np.arange(degree)
            scaled = degree * values / (t[i + degree] - t[i])[:, None, :]
            values = np.zeros((*self.weights.shape, degree + 1))
            values[..., 1:] += scaled
            values[..., :-1] -= scaled
        return values

    def curve(self, points: FloatArray, order: int) -> FloatArray:
        """Return the derivative of the curve with these control points, shape (S, G, 3), from differences of them."""
        if order > self.basis.degree:
            return np.zeros((*self.weights.shape, points.shape[-1]))
        differences = derivative_points(self.basis.degree, self.basis.knots, points, order)
        return np.asarray(np.matmul(self.lower[order], differences[self.local(order)]))


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


def sample(basis: Basis, breaks: FloatArray, degree: int) -> Samples:
    """Sample a basis at the Gauss points that integrate polynomials of `degree` on every span of `breaks`."""
    x, w = gauss_rule(breaks, degree)
    weights = w.reshape(len(breaks) - 1, -1)
    lower = []
    for order in range(min(2, basis.degree) + 1):
        matrix = basis_matrix(basis.degree - order, basis.knots[order : len(basis.knots) - order], x)
        lower.append(matrix.data.reshape(*weights.shape, -1))
        if order == 0:
            first = matrix.indices.reshape(*weights.shape, -1)[:, 0, 0].astype(np.intp)
    return Samples(basis, weights, first, tuple(lower))


def gram_matrix(a: Basis, b: Basis, order: int = 0) -> SparseMatrix:
    """Return the integrals of products of `order`-th derivatives, taken span by span.

    Parameters
    ----------
    a, b : Basis
        Over one domain; degrees and knots may differ.
    order : int
        0, 1 or 2.

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
    left, right = (sample(basis, breaks, a.degree + b.degree) for basis in (a, b))
    return _products(left, right)[order]


def _products(a: Samples, b: Samples) -> list[SparseMatrix]:
    """Gram matrices of orders 0, 1, 2, all of one sparsity pattern."""
    rows = np.repeat(a.local(), b.basis.degree + 1, axis=1).ravel()
    columns = np.tile(b.local(), a.basis.degree + 1).ravel()
    shape = (a.basis.size, b.basis.size)
    grams = []
    for order in range(3):
        left = (a.derivative(order) * a.weights[..., None]).transpose(0, 2, 1)
        entries = np.matmul(left, b.derivative(order))
        grams.append(sp.coo_array((entries.ravel(), (rows, columns)), shape=shape).tocsr())
    return grams


@dataclass(frozen=True, eq=False)
class EnergyForm:
    """The thin-plate energy (11) of semi-structured surfaces over given knots: E = sum over x, y, z of p'Hp.

    Attributes
    ----------
    u : Basis
        Of size m + 1.
    rows : tuple of Basis, length m + 1
        The spaces of the v-control curves; p stacks the control points of all curves in order.
    """

    u: Basis
    rows: tuple[Basis, ...]

    @cached_property
    def offsets(self) -> list[int]:
        """Where each row starts in p; one more for the end."""
        return [0, *np.cumsum([row.size for row in self.rows]).tolist()]

    @cached_property
    def _kinds(self) -> tuple[list[Basis], list[int]]:
        """The distinct spaces among the rows, and which of them each row has."""
        distinct: list[Basis] = []
        kind: list[int] = []
        for row in self.rows:
            k = next((k for k, other in enumerate(distinct) if row is other or row.same_as(other)), len(distinct))
            distinct += [row] * (k == len(distinct))
            kind.append(k)
        return distinct, kind

    @cached_property
    def across(self) -> Samples:
        """Samples of the u-basis."""
        return sample(self.u, breakpoints(self.u.knots), 2 * self.u.degree)

    @cached_property
    def along(self) -> list[Samples]:
        """Samples of each row's space, all at the same points."""
        distinct, kind = self._kinds
        breaks = merge_breakpoints(*(breakpoints(basis.knots) for basis in distinct))
        degree = 2 * max(basis.degree for basis in distinct)
        samples = [sample(basis, breaks, degree) for basis in distinct]
        return [samples[k] for k in kind]

    @cached_property
    def _grams(self) -> dict[tuple[int, int], list[SparseMatrix]]:
        return {}

    def matrix(self, rows: Iterable[int]) -> SparseMatrix:
        """Return the lines of H that belong to the given rows, shape (their control points, N)."""
        across = [gram.toarray() for gram in _products(self.across, self.across)]
        kind = self._kinds[1]
        data, line, column = [], [], []
        start = 0
        for i in rows:
            for j in range(max(0, i - self.u.degree), min(len(self.rows), i + self.u.degree + 1)):
                pair = kind[i], kind[j]
                if pair not in self._grams:
                    self._grams[pair] = [gram.tocoo() for gram in _products(self.along[i], self.along[j])]
                grams = self._grams[pair]
                data.append(gram_block(*(a[i, j] for a in across), *(gram.data for gram in grams)))
                line.append(grams[0].coords[0] + start)
                column.append(grams[0].coords[1] + self.offsets[j])
            start += self.rows[i].size
        coordinates = (np.concatenate(line), np.concatenate(column))
        return sp.coo_array((np.concatenate(data), coordinates), shape=(start, self.offsets[-1])).tocsr()

    def products(self, points: FloatArray) -> FloatArray:
        """Return the energy products of surfaces over these knots, shape (K, K); energies are on the diagonal.

        They are sums over Gauss points of products of second derivatives, those from differences of control points:
        so they keep the accuracy that p'Hp loses by cancellation, and the matrix is positive semidefinite.

        Parameters
        ----------
        points : ndarray, shape (K, N, 3)
        """
        k = len(points)
        rows = [part.transpose(1, 0, 2).reshape(-1, 3 * k) for part in np.split(points, self.offsets[1:-1], axis=1)]
        p, knots = self.u.degree, self.u.knots
        total = np.zeros((k, k))
        for du in range(min(2, p) + 1):
            # The factor of |d^2 P / du^du dv^(2 - du)|^2 in the energy: 1, 2, 1.
            factor = float(gram_block(*np.eye(3)[du], *np.eye(3)[2 - du]))
            curves = np.stack([s.curve(row, 2 - du) for s, row in zip(self.along, rows, strict=True)])
            across = derivative_points(p, knots, curves, du)
            # The u-derivative at Gauss points in u: one matrix product for each span of u.
            for span, first in enumerate(self.across.first):
                local = across[first : first + p - du + 1].reshape(p - du + 1, -1)
                values = (self.across.lower[du][span] @ local).reshape(-1, *curves.shape[1:3], k, 3)
                weight = factor * np.multiply.outer(self.across.weights[span], self.along[0].weights)
                scaled = values * np.sqrt(weight)[..., None, None]
                flat = np.moveaxis(scaled, 3, 0).reshape(k, -1)
                total += flat @ flat.T
        return total


def thin_plate_energy(surface: Surface) -> float:
    """Return the thin-plate energy (11), span by span; exact up to rounding.

    It is a sum of squares of second derivatives, which keeps its accuracy where the quadratic form p'Hp cancels.

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
    u = Basis(surface.degree_u, surface.knots_u)
    if isinstance(surface, BSplineSurface):
        if surface.weights is not None:
            raise InputError("surface: rational, but the thin-plate energy is computed for polynomial surfaces only")
        form = EnergyForm(u, (Basis(surface.degree_v, surface.knots_v),) * len(surface.control_points))
        points = surface.control_points.reshape(1, -1, 3)
    else:
        form = EnergyForm(u, tuple(Basis(c.degree, c.knots) for c in surface.control_curves))
        points = np.concatenate([c.control_points for c in surface.control_curves])[None]
    return float(form.products(points)[0, 0])
