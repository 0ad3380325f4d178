"""Sparse Gram matrices between different knot vectors, and the thin-plate energy they add up to.

A product of two spline pieces is a polynomial on each merged span, so a Gauss rule of enough points integrates it
exactly up to rounding. Time and memory are linear in the number of knots.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.generated.energy_numpy import gram_block
from semispline.solver.splines import (
    Basis,
    Samples,
    breakpoints,
    derivative_matrix,
    derivative_points,
    first_on_spans,
    merge_breakpoints,
    sample,
)


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
    gram = _grams([(0, 1)], (a, b), breaks, _parts((a, b), breaks))[0, 1]
    return gram.matrix(gram.values[order])


# Spans that are worked on at once: enough for speed, few enough to stay in fast memory.
_SPANS_AT_ONCE = 1024


def _parts(bases: Sequence[Basis], breaks: FloatArray) -> Iterator[list[Samples]]:
    """Sample bases at the same points, some spans at a time: for each part of the domain, the samples of each basis."""
    degree = 2 * max(basis.degree for basis in bases)
    for at in range(0, len(breaks) - 1, _SPANS_AT_ONCE):
        yield [sample(basis, breaks[at : at + _SPANS_AT_ONCE + 1], degree) for basis in bases]


class _Gram:
    """Gram matrices of two bases, of orders 0, 1, 2 and one sparsity pattern, filled part by part.

    Supports are intervals, so each function of a meets neighbouring functions of b, from `start` on.

    Attributes
    ----------
    values : ndarray, shape (3, number of entries)
    """

    def __init__(self, a: Basis, b: Basis, breaks: FloatArray) -> None:
        first_a, first_b = (first_on_spans(basis, breaks) for basis in (a, b))
        every = np.arange(a.size)
        spans = np.searchsorted(first_a + a.degree, every), np.searchsorted(first_a, every, side="right") - 1
        # A function of an elevated row may live on merged knots alone, and then meets none.
        lives = spans[1] >= spans[0]
        start, last = (first_b[np.where(lives, span, 0)] for span in spans)
        count = np.where(lives, last + b.degree + 1 - start, 0)
        self._shape = a.size, b.size
        self._row_starts = np.concatenate([[0], np.cumsum(count)])
        # Entry (i, j) has the place j + shift[i].
        self._shift = self._row_starts[:-1] - start
        self._columns = np.arange(self._row_starts[-1]) - np.repeat(self._shift, count)
        self.values = np.zeros((3, self._row_starts[-1]))

    def matrix(self, values: FloatArray) -> SparseMatrix:
        """Return the matrix with these entries, shape (a.size, b.size)."""
        return sp.csr_array((values, self._columns, self._row_starts), shape=self._shape)

    def add(self, a: Samples, b: Samples, derivatives_a: list[FloatArray], derivatives_b: list[FloatArray]) -> None:
        """Add the integrals over one part of the domain."""
        place = self._shift[a.local()][:, None] + b.local()
        low, high = place.min(), place.max() + 1
        for total, left, right in zip(self.values, derivatives_a, derivatives_b, strict=True):
            entries = np.einsum("kgs,lgs->kls", left * a.weights, right)
            total[low:high] += np.bincount((place - low).ravel(), entries.ravel(), minlength=high - low)


def _grams(
    pairs: Iterable[tuple[int, int]], bases: Sequence[Basis], breaks: FloatArray, parts: Iterable[list[Samples]]
) -> dict[tuple[int, int], _Gram]:
    """Return the Gram matrices of pairs of bases, in one run over the parts of the domain."""
    grams = {pair: _Gram(bases[pair[0]], bases[pair[1]], breaks) for pair in pairs}
    for samples in parts:
        derivatives = [[one.derivative(order) for order in range(3)] for one in samples]
        for (i, j), gram in grams.items():
            gram.add(samples[i], samples[j], derivatives[i], derivatives[j])
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
    def _across(self) -> Samples:
        """Samples of the u-basis."""
        return sample(self.u, breakpoints(self.u.knots), 2 * self.u.degree)

    @cached_property
    def _breaks(self) -> FloatArray:
        """Ends of the merged spans of all rows."""
        return merge_breakpoints(*(breakpoints(basis.knots) for basis in self._kinds[0]))

    @cached_property
    def _only_part(self) -> list[Samples]:
        return next(_parts(self._kinds[0], self._breaks))

    def _along(self) -> Iterable[list[Samples]]:
        """Return samples of each distinct space, part by part; where there is but one part, it is kept."""
        if len(self._breaks) <= _SPANS_AT_ONCE + 1:
            return [self._only_part]
        return _parts(self._kinds[0], self._breaks)

    @cached_property
    def _across_grams(self) -> list[FloatArray]:
        """Gram matrices of the u-basis."""
        gram = _grams([(0, 0)], [self.u], breakpoints(self.u.knots), [[self._across]])[0, 0]
        return [gram.matrix(values).toarray() for values in gram.values]

    def blocks(self, rows: Iterable[int]) -> dict[tuple[int, int], SparseMatrix]:
        """Return the blocks of H that couple the given rows i with any row j, each (size of i, size of j)."""
        distinct, kind = self._kinds
        p, m = self.u.degree, len(self.rows) - 1
        pairs = [(i, j) for i in rows for j in range(max(0, i - p), min(m, i + p) + 1)]
        grams = _grams({(kind[i], kind[j]) for i, j in pairs}, distinct, self._breaks, self._along())
        return {
            (i, j): (gram := grams[kind[i], kind[j]]).matrix(
                gram_block(*(a[i, j] for a in self._across_grams), *gram.values)
            )
            for i, j in pairs
        }

    def matrix(self) -> SparseMatrix:
        """Return H, shape (N, N)."""
        every = range(len(self.rows))
        return self.assembled(self.blocks(every), every)

    def assembled(self, blocks: dict[tuple[int, int], SparseMatrix], rows: range) -> SparseMatrix:
        """Return the square matrix that couples the given neighbouring rows, from blocks that hold it."""
        start, size = self.offsets[rows.start], self.offsets[rows.stop] - self.offsets[rows.start]
        parts = [(i, j, block.tocoo()) for (i, j), block in blocks.items() if i in rows and j in rows]
        lines = np.concatenate([block.coords[0] + (self.offsets[i] - start) for i, _, block in parts])
        columns = np.concatenate([block.coords[1] + (self.offsets[j] - start) for _, j, block in parts])
        values = np.concatenate([block.data for *_, block in parts])
        return sp.csr_array((values, (lines, columns)), shape=(size, size))

    def products(self, points: FloatArray) -> FloatArray:
        """Return the energy products of surfaces over these knots, shape (K, K); energies are on the diagonal.

        They are sums over Gauss points of products of second derivatives, those from differences of control points:
        so they keep the accuracy that p'Hp loses by cancellation, and the matrix is positive semidefinite.

        Parameters
        ----------
        points : ndarray, shape (K, N, 3)
        """
        k, m = len(points), len(self.rows) - 1
        p, U = self.u.degree, self.u.knots
        rows = np.split(points.transpose(1, 0, 2).reshape(-1, 3 * k), self.offsets[1:-1])
        nets = [[self._nets(members, rows, dv) for members in self._members] for dv in range(3)]
        total = np.zeros((k, k))
        for along in self._along():
            weights = along[0].weights
            for du in range(min(2, p) + 1):
                curves = np.zeros((m + 1, 3 * k, *weights.shape))
                for samples, members, net in zip(along, self._members, nets[2 - du], strict=True):
                    if net is not None:
                        curves[members] = samples.curves(net, 2 - du).reshape(len(members), 3 * k, *weights.shape)
                across = derivative_points(p, U, curves, du)
                values = (self._roots[du] @ across.reshape(m + 1 - du, -1)).reshape(-1, k, 3, *weights.shape)
                flat = np.moveaxis(values * np.sqrt(weights), 1, 0).reshape(k, -1)
                # The factor of |d^2 P / du^du dv^(2 - du)|^2 in the energy: 1, 2, 1.
                total += float(gram_block(*np.eye(3)[du], *np.eye(3)[2 - du])) * np.einsum("ka,la->kl", flat, flat)
        return total

    def gradient(self, points: FloatArray) -> FloatArray:
        """Return H p, shape (N, d), from second derivatives at Gauss points: it keeps digits that the matrix H loses.

        Parameters
        ----------
        points : ndarray, shape (N, d)
        """
        m, d = len(self.rows) - 1, points.shape[1]
        rows = np.split(points, self.offsets[1:-1])
        nets = [[self._nets(members, rows, dv) for members in self._members] for dv in range(3)]
        back = [[None if net is None else np.zeros(net.shape) for net in level] for level in nets]
        for along in self._along():
            weights = along[0].weights
            for du, root in enumerate(self._roots_of_points):
                dv = 2 - du
                curves = np.zeros((m + 1, d, *weights.shape))
                for samples, members, net in zip(along, self._members, nets[dv], strict=True):
                    if net is not None:
                        curves[members] = samples.curves(net, dv).reshape(len(members), d, *weights.shape)
                values = (root @ curves.reshape(m + 1, -1)).reshape(-1, d, *weights.shape)
                values *= weights * float(gram_block(*np.eye(3)[du], *np.eye(3)[dv]))
                pulled = (root.T @ values.reshape(len(values), -1)).reshape(curves.shape)
                for samples, members, total in zip(along, self._members, back[dv], strict=True):
                    if total is not None:
                        samples.add_transposed(pulled[members].reshape(-1, *weights.shape), dv, total)
        result = np.zeros_like(points)
        for level, transposed in zip(back, self._transposed, strict=True):
            for members, total, matrix in zip(self._members, level, transposed, strict=True):
                if total is not None and matrix is not None:
                    lines = matrix @ total.T
                    for i, part in zip(members, np.split(lines, len(members), axis=1), strict=True):
                        result[self.offsets[i] : self.offsets[i + 1]] += part
        return result

    def error_energies(self, largest: FloatArray) -> FloatArray:
        """Bound the energy of second derivatives by vv, uv and uu where no point of row i is above `largest[i]`.

        Parameters
        ----------
        largest : ndarray, shape (m + 1,)
        """
        total = np.zeros(3)
        for parts in self._errors(largest):
            total += [np.sum(weights * e**2) for weights, e in parts]
        return total

    def change_by_errors(self, points: FloatArray, errors: FloatArray, largest: FloatArray) -> float:
        """Bound by how much the energy changes where each coordinate of each control point may be off.

        With second derivatives x and their errors e the change is the integral of 2 x e + e^2. Along v it is bounded
        place by place, as narrow spans have large errors but little energy.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
        errors : ndarray, shape (3,)
            Of the coordinates x, y, z.
        largest : ndarray, shape (m + 1,)
            By how much these are larger in the points of row i.
        """
        m, p, U = len(self.rows) - 1, self.u.degree, self.u.knots
        rows = np.split(points, self.offsets[1:-1])
        nets = [[self._nets(members, rows, dv) for members in self._members] for dv in range(3)]
        total = 0.0
        for along, parts in zip(self._along(), self._errors(largest), strict=True):
            for du, (weights, e) in enumerate(parts):
                curves = np.zeros((m + 1, 3, *weights.shape))
                for samples, members, net in zip(along, self._members, nets[2 - du], strict=True):
                    if net is not None:
                        curves[members] = samples.curves(net, 2 - du).reshape(len(members), 3, *weights.shape)
                x = self._roots[du] @ derivative_points(p, U, curves, du).reshape(m + 1 - du, -1)
                size = np.sqrt(np.sum(x.reshape(len(x), -1, *weights.shape) ** 2, axis=(0, 1)))
                error = np.linalg.norm(errors) * e
                total += float(np.sum(weights * (2 * size * error + error**2)))
        return total

    def _errors(self, largest: FloatArray) -> Iterator[list[tuple[FloatArray, FloatArray]]]:
        """Bound second derivatives of control points whose largest, row by row, are given, part by part along v.

        For the orders 0, 1, 2 in u: weights, with the factor of that derivative, and root mean squares over u.
        Differences of control points become sums: no sign is taken for granted.
        """
        m, p, U = len(self.rows) - 1, self.u.degree, self.u.knots
        kinds = self._kinds[0]
        nets = [[_sums(k.degree, k.knots, np.ones(k.size), min(dv, k.degree))[None] for k in kinds] for dv in range(3)]
        for along in self._along():
            weights = along[0].weights
            parts = []
            for du, root in enumerate(self._roots):
                dv = 2 - du
                curves = np.zeros((m + 1, *weights.shape))
                for samples, members, net in zip(along, self._members, nets[dv], strict=True):
                    if dv <= samples.basis.degree:
                        curves[members] = samples.curves(net, dv) * largest[members][:, None, None]
                e = (root @ _sums(p, U, curves, du).reshape(m + 1 - du, -1)).reshape(-1, *weights.shape)
                factor = float(gram_block(*np.eye(3)[du], *np.eye(3)[dv]))
                parts.append((factor * weights, np.sqrt(np.sum(e**2, axis=0))))
            yield parts

    @cached_property
    def _members(self) -> list[list[int]]:
        """The rows of each distinct space."""
        distinct, kind = self._kinds
        return [[i for i, other in enumerate(kind) if other == k] for k in range(len(distinct))]

    def _nets(self, members: list[int], rows: list[FloatArray], dv: int) -> FloatArray | None:
        """Return control points of the derivatives of rows of one space, one line for each coordinate of each row."""
        basis = self.rows[members[0]]
        if dv > basis.degree:
            return None
        together = np.concatenate([rows[i] for i in members], axis=1)
        return np.ascontiguousarray(derivative_points(basis.degree, basis.knots, together, dv).T)

    @cached_property
    def _roots(self) -> list[FloatArray]:
        """Triangular L' of the Gram matrices L L' of the derivatives' bases in u, without forming these."""
        s = self._across
        roots = []
        for order, values in enumerate(s.lower):
            dense = np.zeros((*s.weights.shape, self.u.size - order))
            dense[:, np.arange(len(s.first)), s.local(order)] = (values * np.sqrt(s.weights)).swapaxes(0, 1)
            roots.append(np.asarray(np.linalg.qr(dense.reshape(-1, self.u.size - order), mode="r")))
        return roots

    @cached_property
    def _roots_of_points(self) -> list[FloatArray]:
        """The roots times the matrices of the derivatives, so that they take control points in u."""
        return [
            root @ derivative_matrix(self.u.degree, self.u.knots, du).toarray() for du, root in enumerate(self._roots)
        ]

    @cached_property
    def _transposed(self) -> list[list[SparseMatrix | None]]:
        """Transposed matrices of the derivatives of each order along v, for each distinct space that has them."""
        return [
            [derivative_matrix(b.degree, b.knots, dv).T if dv <= b.degree else None for b in self._kinds[0]]
            for dv in range(3)
        ]


def _sums(degree: int, knots: FloatArray, points: FloatArray, order: int) -> FloatArray:
    """Return control points of the derivative with sums in place of differences, for points that are not negative."""
    # Differences of alternating signs are sums, and alternate again.
    signs = (-1.0) ** np.arange(len(points)).reshape((-1,) + (1,) * (points.ndim - 1))
    return np.abs(derivative_points(degree, knots, signs * points, order))
