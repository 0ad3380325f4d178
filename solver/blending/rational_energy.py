"""The thin-plate energy (11) of rational surfaces, by quadrature, and their free rows.

With W = sum N_i W_i known, f = 1 / W, the surface X f is linear in the numerators X. So for given weights the energy is
a quadratic form in X, as for polynomial surfaces; its integrals are those of rational functions, taken by a Gauss rule
whose error is measured by a finer one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.blending.closing import periodic_points
from semispline.solver.blending.free_system import ROUNDING_CORRECTION, TRUSTED_CORRECTION, FreeSystem
from semispline.solver.errors import ComputationError
from semispline.solver.generated.energy_numpy import gram_block
from semispline.solver.splines import (
    Basis,
    Samples,
    basis_matrix,
    breakpoints,
    greville,
    merge_breakpoints,
    sample,
)

# Second derivatives, and by what each counts in the energy.
_SECOND = ((2, 0), (1, 1), (0, 2))
_FACTORS = [float(gram_block(*np.eye(3)[a], *np.eye(3)[b])) for a, b in _SECOND]
# Weights of free rows below this part of the least weight of the contacts, or as much above the largest, are not tame.
TAME = 1 / 2
_MOST_REFINEMENTS = 5
# Weights below this fraction of the largest are none.
_NO_WEIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class RationalForm:
    """The energy of rational semi-structured surfaces of given knots and weights, as a quadratic form.

    Attributes
    ----------
    u : Basis
    rows : tuple of Basis, length m + 1
    weights : ndarray, shape (N,)
        Of all rows in order.
    finer : int
        How many times as many nodes as usual.
    """

    u: Basis
    rows: tuple[Basis, ...]
    weights: FloatArray
    finer: int = 1

    @cached_property
    def offsets(self) -> list[int]:
        """Where each row starts in p; one more for the end."""
        return [0, *np.cumsum([row.size for row in self.rows]).tolist()]

    def products(self, points: FloatArray) -> FloatArray:
        """Return the energy products of numerators X, shape (K, N, 3): shape (K, K); energies are on the diagonal."""
        second = self._second(points.transpose(1, 0, 2).reshape(self.offsets[-1], -1))
        k = len(points)
        total = np.zeros((k, k))
        for factor, values in zip(_FACTORS, second, strict=True):
            flat = values.reshape(k, -1)
            weighted = (values * self._node_weights).reshape(k, -1)
            total += factor * flat @ weighted.T
        return total

    def system(self, rows: range) -> SparseMatrix:
        """Return the square matrix of the form that couples the control points of the given rows."""
        upper = {(i, j): self._block(i, j) for i in rows for j in rows if i <= j}
        blocks = [[upper[i, j] if i <= j else upper[j, i].T for j in rows] for i in rows]
        return sp.csr_array(sp.block_array(blocks, format="csr"))

    def gradient(self, points: FloatArray, rows: range) -> FloatArray:
        """Return half the gradient of the energy by the numerators of given rows; p of shape (N, d)."""
        second = self._second(points)
        parts = []
        for i in rows:
            pulled = [np.zeros((points.shape[1], self._node_weights.shape[1])) for _ in range(3)]
            for factor, values, fields in zip(_FACTORS, second, self._fields(i), strict=True):
                for b, field in fields.items():
                    pulled[b] += np.einsum("duv,uv->dv", values, factor * field * self._node_weights)
            parts.append(sum(self._along[i][b].T @ pulled[b].T for b in range(3)))
        return np.concatenate(parts)

    def _second(self, points: FloatArray) -> list[FloatArray]:
        """Return the second derivatives of X f, each of shape (d, nodes in u, nodes in v)."""
        x = self._derivatives(points)
        f = self._reciprocal
        return [
            x[2, 0] * f[0, 0] + 2 * x[1, 0] * f[1, 0] + x[0, 0] * f[2, 0],
            x[1, 1] * f[0, 0] + x[1, 0] * f[0, 1] + x[0, 1] * f[1, 0] + x[0, 0] * f[1, 1],
            x[0, 2] * f[0, 0] + 2 * x[0, 1] * f[0, 1] + x[0, 0] * f[0, 2],
        ]

    def _derivatives(self, points: FloatArray) -> dict[tuple[int, int], FloatArray]:
        pieces = np.split(points, self.offsets[1:-1])
        found: dict[tuple[int, int], FloatArray] = {}
        for b in range(3):
            rows = np.stack([(basis[b] @ x).T for basis, x in zip(self._along, pieces, strict=True)])
            for a in range(3 - b):
                values = self._across[a] @ rows.reshape(len(rows), -1)
                found[a, b] = values.reshape(len(values), *rows.shape[1:]).transpose(1, 0, 2)
        return found

    @cached_property
    def _reciprocal(self) -> dict[tuple[int, int], FloatArray]:
        """Derivatives of f = 1 / W, by the product rule on W f = 1."""
        w = {order: value[0] for order, value in self._derivatives(self.weights[:, None]).items()}
        f = {(0, 0): 1 / w[0, 0]}
        for a, b in ((1, 0), (0, 1)):
            f[a, b] = -w[a, b] * f[0, 0] ** 2
        f[2, 0] = -(w[2, 0] * f[0, 0] + 2 * w[1, 0] * f[1, 0]) * f[0, 0]
        f[1, 1] = -(w[1, 1] * f[0, 0] + w[1, 0] * f[0, 1] + w[0, 1] * f[1, 0]) * f[0, 0]
        f[0, 2] = -(w[0, 2] * f[0, 0] + 2 * w[0, 1] * f[0, 1]) * f[0, 0]
        return f

    def _fields(self, i: int) -> list[dict[int, FloatArray]]:
        """Second derivatives of N_i M f: for each of them the factors of M, M' and M'', over the nodes."""
        f = self._reciprocal
        n, n1, n2 = (values[:, i : i + 1] for values in self._across)
        return [
            {0: n2 * f[0, 0] + 2 * n1 * f[1, 0] + n * f[2, 0]},
            {0: n1 * f[0, 1] + n * f[1, 1], 1: n1 * f[0, 0] + n * f[1, 0]},
            {0: n * f[0, 2], 1: 2 * n * f[0, 1], 2: n * f[0, 0]},
        ]

    def _block(self, i: int, j: int) -> SparseMatrix:
        middle = np.zeros((3, 3, self._node_weights.shape[1]))
        for factor, left, right in zip(_FACTORS, self._fields(i), self._fields(j), strict=True):
            for c, other in right.items():
                weighted = factor * other * self._node_weights
                for b, one in left.items():
                    middle[b, c] += np.einsum("uv,uv->v", one, weighted)
        # All three of a row have entries in the same places.
        first = self._along[j][0]
        values = np.stack([basis.data.reshape(self._node_weights.shape[1], -1) for basis in self._along[j]])
        parts = np.einsum("bcv,cvk->bvk", middle, values)
        combined = [sp.csr_array((part.ravel(), first.indices, first.indptr), shape=first.shape) for part in parts]
        return sp.csr_array(sum(basis.T @ part for basis, part in zip(self._along[i], combined, strict=True)))

    @cached_property
    def _samples(self) -> tuple[Samples, list[Samples]]:
        """The bases at the nodes in u, and those of each row at the nodes in v."""
        along = merge_breakpoints(*(breakpoints(row.knots) for row in self.rows))
        degree = 2 * self.finer * (1 + max(self.u.degree, *(row.degree for row in self.rows))) - 1
        known: dict[tuple[int, bytes], Samples] = {}
        for row in self.rows:
            key = row.degree, row.knots.tobytes()
            if key not in known:
                known[key] = sample(row, along, degree)
        of_rows = [known[row.degree, row.knots.tobytes()] for row in self.rows]
        return sample(self.u, breakpoints(self.u.knots), degree), of_rows

    @cached_property
    def _node_weights(self) -> FloatArray:
        of_u, of_rows = self._samples
        return np.multiply.outer(of_u.weights.T.ravel(), of_rows[0].weights.T.ravel())

    @cached_property
    def _across(self) -> list[FloatArray]:
        """Basis functions in u and their derivatives at the nodes, each of shape (nodes, m + 1)."""
        return [matrix.toarray() for matrix in _matrices(self._samples[0])]

    @cached_property
    def _along(self) -> list[list[SparseMatrix]]:
        """Basis functions of each row and their derivatives at the nodes in v."""
        of_rows = self._samples[1]
        known = {id(samples): _matrices(samples) for samples in of_rows}
        return [known[id(samples)] for samples in of_rows]


def _matrices(samples: Samples) -> list[SparseMatrix]:
    """Return the basis functions and their derivatives at the nodes, span by span, zeros among the entries."""
    count, width = samples.weights.size, samples.basis.degree + 1
    columns = np.repeat(samples.local().T, len(samples.weights), axis=0).ravel()
    ends = np.arange(0, columns.size + 1, width)
    return [
        sp.csr_array((samples.derivative(order).T.ravel(), columns, ends), shape=(count, samples.basis.size))
        for order in range(3)
    ]


def free_weights(plain: FreeSystem, u: Basis, rows: tuple[Basis, ...], weights: FloatArray) -> FloatArray:
    """Return weights of all rows, shape (N,), those of free rows added: by a scalar thin plate where that is tame.

    Else they are means of the weights of both contacts: positive, as these are.

    Parameters
    ----------
    plain : FreeSystem
    u : Basis
    rows : tuple of Basis
    weights : ndarray, shape (N,)
        Of the prescribed rows, which have those of their contact.
    """
    filled = plain.completed(weights[:, None])[:, 0]
    if plain.size == 0:
        return filled
    offsets = plain.offsets
    given = np.delete(weights, np.r_[plain.free])
    if filled[plain.free].min() >= TAME * given.min() and filled[plain.free].max() <= given.max() / TAME:
        return filled
    places = greville(u.knots, u.degree)
    ends = [(rows[i], weights[offsets[i] : offsets[i + 1]]) for i in (0, len(rows) - 1)]
    for i in plain.rows:
        at = greville(rows[i].knots, rows[i].degree)
        first, last = (basis_matrix(basis.degree, basis.knots, at) @ values for basis, values in ends)
        filled[offsets[i] : offsets[i + 1]] = (1 - places[i]) * first + places[i] * last
    return filled


class RationalSystem:
    """The free rows of a rational blend, in homogeneous points: weights are known, numerators have least energy.

    Attributes
    ----------
    form : RationalForm
    size : int
        Number of free control points.
    """

    def __init__(self, form: RationalForm, plain: FreeSystem, seam_orders: list[int]) -> None:
        self.form, self.plain, self.size = form, plain, plain.size
        rows = plain.rows
        matrix = form.system(rows)
        self.z: SparseMatrix | None = None
        if max(seam_orders) >= 0:
            self.z = sp.block_diag(
                [periodic_points(form.rows[i], order) for i, order in zip(rows, seam_orders, strict=True)], format="csr"
            )
            matrix = self.z.T @ matrix @ self.z
        try:
            self.factor = splu(sp.csc_array(matrix))
        except RuntimeError:
            raise ComputationError(
                "the stationarity system is singular; try fewer middle curves or knots that are not so close"
            ) from None

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, 4 K), so that the energy is least for the weights of the form."""
        is_weight = np.arange(points.shape[1]) % 4 == 3
        filled = points.copy()
        # Weights know nothing of alpha: of the parts that go with its powers there are none, but for rounding.
        whole = np.abs(points[:, is_weight]).max(axis=0) > _NO_WEIGHT * self.form.weights.max()
        filled[self.plain.free, is_weight] = np.multiply.outer(self.form.weights[self.plain.free], whole)
        numerators = filled[:, ~is_weight]
        left = np.inf
        for _ in range(_MOST_REFINEMENTS):
            step = self._step(numerators)
            numerators[self.plain.free] -= step
            left = float(np.abs(step).max()) / max(float(np.abs(numerators[self.plain.free]).max()), 1e-300)
            if left <= ROUNDING_CORRECTION:
                break
        if not left <= TRUSTED_CORRECTION:
            raise ComputationError(
                f"the stationarity system of {self.size} unknowns is too ill-conditioned to be trusted; try v_scale "
                "unit or length, knots that are not so close, or fewer control points"
            )
        filled[:, ~is_weight] = numerators
        return filled

    def excess(self, points: FloatArray) -> float | None:
        """Bound how much more energy p, shape (N, 4), has than the least for its weights and rows, as a fraction."""
        gradient, energy = self.gradient_of(points)
        step = self.response(gradient)
        return abs(float(np.sum(step * gradient))) / max(energy, np.finfo(float).tiny)

    def gradient_of(self, points: FloatArray) -> tuple[FloatArray, float]:
        """Return the gradient by the free numerators and the energy of p, shape (N, 4), but for factors of 2."""
        numerators = points[:, :3]
        return self.form.gradient(numerators, self.plain.rows), float(self.form.products(numerators[None])[0, 0])

    def response(self, forces: FloatArray) -> FloatArray:
        """Return how the free numerators, shape (size, K), answer forces of that shape."""
        if self.z is None:
            return np.asarray(self.factor.solve(forces))
        return np.asarray(self.z @ self.factor.solve(np.asarray(self.z.T @ forces)))

    def _step(self, numerators: FloatArray) -> FloatArray:
        return self.response(self.form.gradient(numerators, self.plain.rows))
