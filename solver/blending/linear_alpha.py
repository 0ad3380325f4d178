"""Rows of a blend whose alpha^2 is linear in v: of higher degree row by row, exact, and polynomials in its end values.

alpha^2(v) = a0 (1 - s) + a1 s, s from 0 to 1 along v. A row that holds a^i is a spline times a polynomial of degree i.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.generated.rows_numpy import linear_powers_4
from semispline.solver.splines import Basis, linear_product_matrices

# A number, or the values at both ends of v.
LinearInV = float | tuple[float, float]


@dataclass(frozen=True)
class LinearEnds:
    """What the end values of a linear alpha^2 may be.

    Attributes
    ----------
    bounds : pair of (float, float)
        At the start and at the end of v; low = high where they are given.
    shape : (float, float)
        Around which ratio of the two they lie: the end values of a linear function of mean 1.
    """

    bounds: tuple[tuple[float, float], tuple[float, float]]
    shape: tuple[float, float]


def raised_basis(basis: Basis, times: int) -> Basis:
    """Return the basis of products with polynomials of a degree.

    Examples
    --------
    >>> raised_basis(Basis(1, np.array([0, 0, 0.5, 1, 1])), 1).knots
    array([0. , 0. , 0. , 0.5, 0.5, 1. , 1. , 1. ])
    """
    for _ in range(times):
        basis = Basis(basis.degree + 1, _products(basis)[2])
    return basis


def monomials_of_ends(
    exponents: FloatArray, monomials: FloatArray, along: Basis
) -> tuple[FloatArray, list[list[FloatArray]]]:
    """Put a0 (1 - s) + a1 s in the place of a in monomials a^i p2^j.

    Parameters
    ----------
    exponents : ndarray, shape (M, 2)
        1 first.
    monomials : ndarray, shape (M, R, n, 3)
        Rows of control points over `along`.
    along : Basis

    Returns
    -------
    exponents : ndarray, shape (K, 3)
        Of a0, a1 and p2; 1 first.
    rows : list of K lists of R arrays
        Row r has control points over `raised_basis(along, r)`.

    Source: generated from `semispline.derivations.linear_alpha`.
    """
    found_exponents, found = [], []
    for (i, j), rows in zip(exponents.tolist(), monomials, strict=True):
        for power, i0, i1, factor in linear_powers_4().tolist():
            if power == i:
                found_exponents.append([i0, i1, j])
                steps = [(1.0, 0.0)] * int(i0) + [(0.0, 1.0)] * int(i1)
                found.append([factor * _times(row, along, steps, r) for r, row in enumerate(rows)])
    return np.array(found_exponents), found


def linear_rows(
    exponents: FloatArray, monomials: FloatArray, along: Basis, a: LinearInV, p2: LinearInV
) -> list[FloatArray]:
    """Return the rows for given alpha^2 and p2, each a number or linear in v: row r over `raised_basis(along, r)`."""
    total = [np.zeros((raised_basis(along, r).size, monomials.shape[3])) for r in range(monomials.shape[1])]
    for (i, j), rows in zip(exponents.astype(int).tolist(), monomials, strict=True):
        steps = [_ends(a)] * i + [_ends(p2)] * j
        if j == 0 or any(_ends(p2)):
            for r, row in enumerate(rows):
                total[r] += _times(row, along, steps, r)
    return total


def scaled(value: LinearInV, factor: float) -> LinearInV:
    """Return a multiple.

    Examples
    --------
    >>> scaled((1.0, 2.0), 3.0)
    (3.0, 6.0)
    """
    return (value[0] * factor, value[1] * factor) if isinstance(value, tuple) else value * factor


def _ends(value: LinearInV) -> tuple[float, float]:
    return value if isinstance(value, tuple) else (value, value)


def _times(points: FloatArray, along: Basis, linear: list[tuple[float, float]], degrees: int) -> FloatArray:
    """Return a spline times linear functions, given by their ends, and raised by so many degrees altogether."""
    if len(linear) > degrees:
        # No row holds a power that is higher than its own number.
        assert not points.any()
        return np.zeros((raised_basis(along, degrees).size, points.shape[1]))
    basis = along
    for low, high in linear + [(1.0, 1.0)] * (degrees - len(linear)):
        falling, rising, knots = _products(basis)
        points = low * (falling @ points) + high * (rising @ points)
        basis = Basis(basis.degree + 1, knots)
    return points


def _products(basis: Basis) -> tuple[SparseMatrix, SparseMatrix, FloatArray]:
    return _cached_products(basis.degree, basis.knots.tobytes())


@lru_cache(maxsize=64)
def _cached_products(degree: int, buffer: bytes) -> tuple[SparseMatrix, SparseMatrix, FloatArray]:
    falling, rising, knots = linear_product_matrices(degree, np.frombuffer(buffer))
    knots.setflags(write=False)
    return falling, rising, knots
