"""All derivatives of a surface up to an order at once, each point in a span that the caller may choose."""

from __future__ import annotations

from math import comb
from typing import TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines.quadrature import Basis, IndexArray, local_bases, raised_bases
from semispline.solver.splines.surfaces import BSplineSurface

# Derivatives by (order in u, order in v), each of shape (K, 3).
Jet: TypeAlias = dict[tuple[int, int], FloatArray]


def surface_jet(
    surface: BSplineSurface,
    u: FloatArray,
    v: FloatArray,
    order: int,
    beside: tuple[FloatArray, FloatArray] | None = None,
) -> Jet:
    """Return the derivatives of total order 0 .. `order` at the points (u[k], v[k]), rational surfaces too.

    Parameters
    ----------
    surface : BSplineSurface
    u, v : ndarray, shape (K,)
        Nothing is clipped: a span is continued beyond its ends.
    order : int
    beside : pair of ndarray, shape (K,), optional
        Points in the spans whose polynomials are meant: on a knot line this chooses the side. Without it, the spans
        right of a knot.

    Examples
    --------
    >>> bent = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]],
    ...                                                               [[1, 0, 2], [1, 1, 2]]])
    >>> at = np.array([0.5]), np.array([0.5])
    >>> surface_jet(bent, *at, 1)[1, 0], surface_jet(bent, *at, 1, (at[0] - 0.1, at[1]))[1, 0]
    (array([[0., 0., 4.]]), array([[2., 0., 0.]]))
    """
    first_u, along_u = _bases(Basis(surface.degree_u, surface.knots_u), u, u if beside is None else beside[0], order)
    first_v, along_v = _bases(Basis(surface.degree_v, surface.knots_v), v, v if beside is None else beside[1], order)
    index_u = first_u[:, None] + np.arange(surface.degree_u + 1)
    index_v = first_v[:, None] + np.arange(surface.degree_v + 1)
    local = surface.homogeneous[index_u[:, :, None], index_v[:, None, :]]
    across = np.einsum("iak,kabd->ikbd", along_u, local)
    raw = {
        (i, j): np.einsum("bk,kbd->kd", along_v[j], across[i]) for i in range(order + 1) for j in range(order + 1 - i)
    }
    return raw if surface.weights is None else _quotients(raw)


def _bases(basis: Basis, x: FloatArray, beside: FloatArray, order: int) -> tuple[IndexArray, FloatArray]:
    """Return of each point its first basis function, and derivatives of all that live there, (order + 1, p + 1, K)."""
    p, knots = basis.degree, basis.knots
    # Of the last span too where the point is its end.
    last = int(np.searchsorted(knots, knots[-1])) - 1
    # For some points np.clip takes as long as all of this.
    first = np.minimum(np.maximum(np.searchsorted(knots, beside, side="right") - 1, p), last) - p
    lower = local_bases(basis, x[None, :], first, order)
    values = np.zeros((order + 1, p + 1, len(x)))
    for k in range(min(order, p) + 1):
        values[k] = raised_bases(basis, first, lower[k], k)[:, 0]
    return first, values


def _quotients(raw: Jet) -> Jet:
    """Return the derivatives of X / w from those of (X, w), by the product rule on X = w S."""
    weight = {key: value[:, 3:] for key, value in raw.items()}
    known: Jet = {}
    for i, j in raw:
        value = raw[i, j][:, :3].copy()
        for a in range(i + 1):
            for b in range(j + 1):
                if a or b:
                    value -= comb(i, a) * comb(j, b) * weight[a, b] * known[i - a, j - b]
        known[i, j] = value / weight[0, 0]
    return known
