"""Products of splines, and the smooth rational circle that the square of a complex spline is: plain arrays.

A control point of a product is a mean of products of blossoms, over all ways to deal its knots out to the two factors.
As in `refinement`, every blossom is a convex combination of control points: nothing is extrapolated, positive factors
have positive products, and no digits are lost at high degrees.

Source: K. Mørken, Some identities for products and degree raising of splines, 1991.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import product
from math import comb, pi, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.errors import KnotError
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.quadrature import Basis
from semispline.solver.splines.refinement import blossom_matrix, restriction_matrix


def product_basis(a: Basis, b: Basis) -> Basis:
    """Return degree and knots of a product: the degrees' sum, and at each knot the smoothness of the rougher factor.

    Raises
    ------
    KnotError
        The domains differ.

    Examples
    --------
    >>> product_basis(Basis(1, np.array([0, 0, 1.0, 1])), Basis(1, np.array([0, 0, 0.5, 1, 1]))).knots
    array([0. , 0. , 0. , 0.5, 0.5, 1. , 1. , 1. ])
    """
    if a.knots[0] != b.knots[0] or a.knots[-1] != b.knots[-1]:
        raise KnotError(
            f"knots: domains [{a.knots[0]}, {a.knots[-1]}] and [{b.knots[0]}, {b.knots[-1]}], expected one for both"
        )
    counts: dict[float, int] = {}
    for one, other in ((a, b), (b, a)):
        values, times = np.unique(one.knots, return_counts=True)
        for value, count in zip(values.tolist(), times.tolist(), strict=True):
            counts[value] = max(counts.get(value, 0), count + other.degree)
    return Basis(a.degree + b.degree, np.repeat(sorted(counts), [counts[x] for x in sorted(counts)]))


def multiply(a: Basis, points_a: Any, b: Basis, points_b: Any) -> tuple[Basis, Any]:
    """Return the product of two splines over one domain.

    Parameters
    ----------
    a, b : Basis
    points_a, points_b : ndarray, shapes (n_a, ...) and (n_b, ...)
        Real or complex; values along the other axes are multiplied as arrays are.

    Returns
    -------
    basis : Basis
    points : ndarray, shape (n, ...)

    Raises
    ------
    KnotError
        The domains differ.

    Examples
    --------
    >>> line = Basis(1, np.array([0, 0, 1.0, 1]))
    >>> multiply(line, np.array([0, 1.0]), line, np.array([1, 0.0]))[1]
    array([0. , 0.5, 0. ])
    """
    basis, shares, deal_a, deal_b, first = _deals(a.degree, a.knots.tobytes(), b.degree, b.knots.tobytes())
    terms = _combined(deal_a, points_a) * _combined(deal_b, points_b)
    terms *= shares.reshape((-1,) + (1,) * (terms.ndim - 1))
    return basis, np.add.reduceat(terms, first, axis=0)


@lru_cache(maxsize=32)
def _deals(
    degree_a: int, knots_a: bytes, degree_b: int, knots_b: bytes
) -> tuple[Basis, FloatArray, SparseMatrix, SparseMatrix, NDArray[np.intp]]:
    """Return the basis of a product; of each way to deal out knots its share and the blossoms of both factors.

    Ways of one control point stand together; the last array says where they begin.
    """
    a, b = Basis(degree_a, np.frombuffer(knots_a)), Basis(degree_b, np.frombuffer(knots_b))
    basis = product_basis(a, b)
    degree, knots = basis.degree, basis.knots
    knots.setflags(write=False)
    target, shares, start, for_a, for_b = [], [], [], [], []
    for j in range(basis.size):
        values, counts = np.unique(knots[j + 1 : j + 1 + degree], return_counts=True)
        for way in product(*(range(count + 1) for count in counts.tolist())):
            if sum(way) != degree_a:
                continue
            taken = np.array(way)
            target.append(j)
            shares.append(prod(map(comb, counts.tolist(), way)) / comb(degree, degree_a))
            start.append(knots[j])
            for_a.append(np.repeat(values, taken))
            for_b.append(np.repeat(values, counts - taken))
    places = np.array(start)
    deal_a = blossom_matrix(degree_a, a.knots, places, np.array(for_a))
    deal_b = blossom_matrix(degree_b, b.knots, places, np.array(for_b))
    return basis, np.array(shares), deal_a, deal_b, np.searchsorted(target, np.arange(basis.size))


def _combined(matrix: Any, points: Any) -> Any:
    flat = np.asarray(points).reshape(len(points), -1)
    return np.asarray(matrix @ flat).reshape(-1, *np.shape(points)[1:])


@lru_cache(maxsize=32)
def smooth_arc(turn: float, order: int, segments: int) -> tuple[Basis, FloatArray]:
    """Return a rational arc of the unit circle that is C^order in homogeneous coordinates, over [0, 1].

    It is (z^2, |z|^2) for the uniform spline z of degree order + 1 with the control points exp(i k eta), where eta is
    turn / (2 segments). Turned by eta, z is itself one span later: a full circle is as smooth at its seam as inside.

    Parameters
    ----------
    turn : float
        The angle from (1, 0), where it begins; 2 pi for the full circle.
    order : int
        At least 1.
    segments : int
        Spans; one for each half turn keeps the weights even.

    Returns
    -------
    basis : Basis
        Of degree 2 (order + 1).
    points : ndarray, shape (n, 3)
        (x, y, w) with x^2 + y^2 = w^2 everywhere; w is 1 at both ends. Read-only.

    Source: `semispline.derivations.circles`.

    Examples
    --------
    >>> basis, points = smooth_arc(2 * pi, 2, 2)
    >>> basis.degree, len(points)
    (6, 11)
    >>> points[:4].round(12) + 0.0
    array([[1.   , 0.   , 1.   ],
           [1.   , 0.5  , 1.   ],
           [0.65 , 1.   , 0.95 ],
           [0.   , 1.225, 0.9  ]])
    """
    degree = order + 1
    angles = turn / (2 * segments) * np.arange(segments + degree)
    uniform = np.arange(-degree, segments + degree + 1, dtype=np.float64)
    matrix, _ = restriction_matrix(degree, uniform, 0.0, float(segments))
    spline = matrix @ np.exp(1j * angles)
    spline *= np.conj(spline[0]) / abs(spline[0]) ** 2
    along = Basis(degree, clamped(np.arange(1, segments) / segments, degree, 0.0, 1.0))
    basis, square = multiply(along, spline, along, spline)
    _, size = multiply(along, spline, along, np.conj(spline))
    points = np.column_stack([square.real, square.imag, size.real])
    points[0] = 1.0, 0.0, 1.0
    points[-1] = points[0] if turn == 2 * pi else (np.cos(turn), np.sin(turn), 1.0)
    points.setflags(write=False)
    return basis, points
