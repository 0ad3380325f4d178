"""Clamped knot vectors: checks, breakpoints, merging, insertion, Greville abscissae, sparse bases.

A knot vector is full: length n + degree + 1 for n control points, both ends with multiplicity degree + 1.

SciPy waits inside the functions that need it: a process that reads a file has no use for it, and a third of its time
went into loading it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, SparseMatrix, finite_array
from semispline.solver.errors import KnotError
from semispline.solver.scalars import is_whole, whole_number

# Knots closer than this fraction of the domain count as one wherever knot vectors are merged.
MERGE_TOLERANCE = 1e-12
# Narrower spans and domains, and wider domains, would overflow in derivatives.
NARROWEST = 1e-30


def checked_knots(knots: ArrayLike, degree: int, n_control: int, name: str = "knots") -> FloatArray:
    """Return `knots` as a read-only array if they are clamped for `degree` and `n_control` control points.

    Parameters
    ----------
    knots : array_like, shape (n_control + degree + 1,)
    degree : int
        At least 1.
    n_control : int
        Number of control points.
    name : str
        How the caller calls this vector, for messages.

    Raises
    ------
    KnotError
        Wrong length, decreasing, not clamped, or an inner multiplicity above the degree.

    Examples
    --------
    >>> checked_knots([0, 0, 1, 2, 2], 1, 3)
    array([0., 0., 1., 2., 2.])
    """
    if not is_whole(degree) or degree < 1:
        raise KnotError(f"{name}: degree is {degree!r}, expected a whole number of at least 1")
    # NumPy's unsigned integers have no negative.
    degree = int(degree)
    if n_control < degree + 1:
        raise KnotError(f"{name}: {n_control} control point(s) for degree {degree}, expected at least {degree + 1}")
    array = finite_array(knots, 1, name, KnotError)
    expected = n_control + degree + 1
    if len(array) != expected:
        raise KnotError(
            f"{name}: {len(array)} knots for {n_control} control points of degree {degree}, expected {expected}"
        )
    steps = np.diff(array)
    if (steps < 0).any():
        i = int(np.argmax(steps < 0))
        raise KnotError(f"{name}[{i + 1}]: {array[i + 1]} after {array[i]}, expected a non-decreasing vector")
    if not array[degree] < array[-degree - 1]:
        raise KnotError(f"{name}: the domain [{array[degree]}, {array[-degree - 1]}] is empty")
    width = float(array[-1]) - float(array[0])
    if not NARROWEST <= width <= 1 / NARROWEST:
        raise KnotError(f"{name}: the domain has length {width}, expected {NARROWEST:g} to {1 / NARROWEST:g}")
    narrow = (steps > 0) & (steps < NARROWEST * width)
    if narrow.any():
        i = int(np.argmax(narrow))
        raise KnotError(
            f"{name}[{i + 1}]: {array[i + 1]} is {steps[i]:g} after {array[i]}, expected the same knot or a step of at "
            f"least {NARROWEST:g} of the domain"
        )
    for index, end, side in ((0, array[degree], "first"), (len(array) - 1, array[-degree - 1], "last")):
        if array[index] != end:
            raise KnotError(
                f"{name}[{index}]: found {array[index]}, expected {end}: the {side} {degree + 1} knots must be equal "
                "(clamped_surface and clamp_knots take other vectors)"
            )
    inner = array[degree + 1 : -degree - 1]
    first = np.flatnonzero(np.diff(inner, prepend=np.nan) != 0)
    counts = np.diff(first, append=len(inner))
    at_end = (inner[first] == array[0]) | (inner[first] == array[-1])
    wrong = at_end | (counts > degree)
    if wrong.any():
        k = int(np.argmax(wrong))
        found, limit = (counts[k] + degree + 1, degree + 1) if at_end[k] else (counts[k], degree)
        where = f"{name}[{degree + 1 + first[k]}]"
        hint = "clamped_surface and clamp_knots take other vectors" if at_end[k] else "split the spline there"
        raise KnotError(f"{where}: knot {inner[first[k]]} has multiplicity {found}, expected at most {limit} ({hint})")
    return array


def uniform_knots(degree: int, n_spans: int) -> FloatArray:
    """Return the clamped uniform vector on [0, 1] with `n_spans` spans.

    Raises
    ------
    KnotError
        No span at all.

    Examples
    --------
    >>> uniform_knots(2, 2)
    array([0. , 0. , 0. , 0.5, 1. , 1. , 1. ])
    """
    whole_number(n_spans, "n_spans", 1, KnotError)
    whole_number(degree, "degree", 1, KnotError)
    return clamped(np.arange(1, n_spans) / n_spans, degree, 0.0, 1.0)


def clamped(inner: ArrayLike, degree: int, start: float, end: float) -> FloatArray:
    """Return inner knots with `degree` + 1 copies of each end put around them.

    Examples
    --------
    >>> clamped([0.5], 1, 0, 1)
    array([0. , 0. , 0.5, 1. , 1. ])
    """
    ends = np.ones(degree + 1)
    return np.concatenate([start * ends, np.asarray(inner, dtype=np.float64), end * ends])


def inner_knots(knots: FloatArray, degree: int) -> FloatArray:
    """Return the knots strictly inside the domain, with their multiplicity."""
    return knots[degree + 1 : -degree - 1]


def breakpoints(knots: FloatArray) -> FloatArray:
    """Return the distinct knots of a clamped vector: the ends of its spans."""
    return np.asarray(np.unique(knots))


def merge_breakpoints(*vectors: FloatArray) -> FloatArray:
    """Return the union of breakpoints over one domain; those closer than 1e-12 of the domain count as one.

    The two ends are those of the first vector.

    Examples
    --------
    >>> merge_breakpoints(np.array([0, 0.5, 1]), np.array([0, 0.5 + 1e-15, 0.75, 1]))
    array([0.  , 0.5 , 0.75, 1.  ])
    """
    start, end = float(vectors[0][0]), float(vectors[0][-1])
    tolerance = MERGE_TOLERANCE * (end - start)
    values = np.unique(np.concatenate(vectors))
    values = values[(values > start + tolerance) & (values < end - tolerance)]
    if len(values):
        # A chain of close knots collapses on its first member.
        values = values[np.concatenate([[True], np.diff(values) > tolerance])]
    return np.concatenate([[start], values, [end]])


def crowded_knots(knots: FloatArray, degree: int) -> FloatArray:
    """Return the first knots that count as one, of a multiplicity that no knot may have; empty where there are none.

    An inner knot may have multiplicity `degree`, an end `degree` + 1: so `checked_knots` has it for equal knots, and
    this for those within 1e-12 of the domain, as `merge_breakpoints` merges them.

    Examples
    --------
    >>> crowded_knots(np.array([0, 0, 0.5, 0.5 + 1e-13, 1, 1]), 1).tolist()
    [0.5, 0.5000000000001]
    >>> crowded_knots(np.array([0, 0, 0.5, 0.5 + 1e-11, 1, 1]), 1).tolist()
    []
    """
    breaks = merge_breakpoints(breakpoints(knots))
    groups = np.searchsorted((breaks[:-1] + breaks[1:]) / 2, knots)
    allowed = np.full(len(breaks), degree)
    allowed[[0, -1]] += 1
    crowded = np.flatnonzero(np.bincount(groups, minlength=len(breaks)) > allowed)
    return np.asarray(knots[groups == crowded[0]] if len(crowded) else knots[:0])


def greville(knots: FloatArray, degree: int) -> FloatArray:
    """Return the Greville abscissae, shape (n,): the mean of `degree` consecutive knots each.

    Examples
    --------
    >>> greville(np.array([0, 0, 0, 1.0, 1, 1]), 2)
    array([0. , 0.5, 1. ])
    """
    sums = np.convolve(knots[1:-1], np.ones(degree), mode="valid")
    return np.asarray(np.clip(sums / degree, knots[0], knots[-1]))


def affine_knots(knots: FloatArray, start: float, end: float) -> FloatArray:
    """Return the knots mapped affinely onto [start, end]; the ends are hit exactly."""
    old_start, old_end = knots[0], knots[-1]
    if old_start == start and old_end == end:
        return knots
    mapped = start + (knots - old_start) * ((end - start) / (old_end - old_start))
    mapped[knots == old_start] = start
    mapped[knots == old_end] = end
    return np.asarray(np.clip(mapped, start, end))


def reversed_knots(knots: FloatArray) -> FloatArray:
    """Return the knots of the same spline run backwards over the same domain."""
    mirrored = (knots[0] + knots[-1]) - knots[::-1]
    mirrored[knots[::-1] == knots[-1]] = knots[0]
    mirrored[knots[::-1] == knots[0]] = knots[-1]
    return np.asarray(np.clip(mirrored, knots[0], knots[-1]))


def basis_matrix(degree: int, knots: FloatArray, x: FloatArray) -> SparseMatrix:
    """Return the sparse matrix of basis values, shape (len(x), n); right-continuous, left at the end of the domain.

    It is read-only: each derivative on one grid asks for the same few, which are kept.
    """
    if not len(x):
        from scipy.sparse import csr_array

        return csr_array((0, len(knots) - degree - 1))
    at = np.ascontiguousarray(x, dtype=np.float64)
    if len(at) > _MOST_KEPT:
        return _basis_matrix(degree, knots, at)
    return _kept_basis_matrix(degree, np.asarray(knots, dtype=np.float64).tobytes(), at.tobytes())


# Making a matrix for a few places takes longer than using it; for more, memory counts.
_MOST_KEPT = 500


@lru_cache(maxsize=64)
def _kept_basis_matrix(degree: int, knots: bytes, x: bytes) -> SparseMatrix:
    return _basis_matrix(degree, np.frombuffer(knots), np.frombuffer(x))


def _basis_matrix(degree: int, knots: FloatArray, x: FloatArray) -> SparseMatrix:
    from scipy.interpolate import BSpline

    matrix = BSpline.design_matrix(x, knots, degree)
    for part in (matrix.data, matrix.indices, matrix.indptr):
        part.setflags(write=False)
    return matrix


def derivative_points(degree: int, knots: FloatArray, points: FloatArray, order: int = 1) -> FloatArray:
    """Return control points of the `order`-th derivative, shape (n - order, ...); differences run along axis 0.

    The derivative is a spline of degree `degree` - `order` over `knots[order:-order]`; `order` must not exceed
    `degree`. Where a knot has multiplicity above the remaining degree, the row of a basis function without
    support is zero.
    """
    for s in range(1, order + 1):
        p = degree - s + 1
        n = len(points)
        width = knots[s + p : s + p + n - 1] - knots[s : s + n - 1]
        factor = np.divide(p, width, out=np.zeros_like(width), where=width > 0)
        points = np.diff(points, axis=0) * factor.reshape((-1,) + (1,) * (points.ndim - 1))
    return points


def derivative_matrix(degree: int, knots: FloatArray, order: int) -> SparseMatrix:
    """Return the sparse matrix, shape (n - order, n), that maps control points to those of the derivative."""
    from scipy.sparse import csr_array, eye_array

    n = len(knots) - degree - 1
    matrix = eye_array(n, format="csr") if order == 0 else None
    for s in range(1, order + 1):
        p = degree - s + 1
        rows = n - s
        width = knots[s + p : s + p + rows] - knots[s : s + rows]
        kept = width > 0
        factor = p / width[kept]
        # Entry by entry: for the few rows of a surface the constructors of diagonal matrices take twice as long.
        values = np.column_stack([-factor, factor]).ravel()
        columns = (np.flatnonzero(kept)[:, None] + [0, 1]).ravel()
        starts = np.concatenate([[0], 2 * np.cumsum(kept)])
        step = csr_array((values, columns, starts), shape=(rows, rows + 1))
        matrix = step if s == 1 else step @ matrix
    return matrix
