"""Matrices that undo a refinement or an elevation as well as it can be: least squares, with the ends fixed.

SciPy waits inside the function that needs it, as in `knots`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.errors import KnotError
from semispline.solver.splines.knots import inner_knots
from semispline.solver.splines.refinement import elevated_knots, elevation_matrix, refinement_matrix, snapped


def coarsening_matrix(refining: SparseMatrix) -> SparseMatrix:
    """Return the matrix that takes fine control points to the coarse ones that fit them best, shape (n, n_fine).

    Points that `refining`, shape (n_fine, n), leaves as they are at both ends stay as they are; the few others come
    from a least squares fit.

    Examples
    --------
    >>> coarsening_matrix(refinement_matrix(1, np.array([0, 0, 1, 1.0]), np.array([0, 0, 0.5, 1, 1]))).toarray()
    array([[1., 0., 0.],
           [0., 0., 1.]])
    """
    from scipy.sparse import csr_array, eye_array, vstack

    rows, n = refining.shape
    head, tail = _fixed_ends(refining)
    inner, fine = n - head - tail, rows - head - tail
    start = eye_array(head, rows, format="csr")
    end = eye_array(tail, rows, k=rows - tail, format="csr")
    if not inner:
        return vstack([start, end], format="csr")
    part = refining[head : rows - tail].toarray()
    inverse = np.linalg.pinv(part[:, head : n - tail])
    middle = np.zeros((inner, rows))
    middle[:, head : head + fine] = inverse
    middle[:, :head] = -inverse @ part[:, :head]
    middle[:, rows - tail :] = -inverse @ part[:, n - tail :]
    return vstack([start, csr_array(middle), end], format="csr")


def coarser_points(refining: SparseMatrix, fine: FloatArray) -> FloatArray:
    """Return the coarse control points that fit fine ones, shape (n_fine, d), best: the matrix above is not needed."""
    rows, n = refining.shape
    head, tail = _fixed_ends(refining)
    points = np.concatenate([fine[:head], np.zeros((n - head - tail, fine.shape[1])), fine[rows - tail :]])
    rest = fine - refining @ points
    if n > head + tail:
        block = refining[head : rows - tail, head : n - tail].toarray()
        points[head : n - tail] = np.linalg.lstsq(block, rest[head : rows - tail], rcond=None)[0]
    return points


def _fixed_ends(refining: SparseMatrix) -> tuple[int, int]:
    """Count the points that stay as they are at both ends: there the rows are those of the identity."""
    rows, n = refining.shape
    alone = np.diff(refining.indptr) == 1
    only = refining.indices[refining.indptr[:-1]]
    head = _leading(alone & (only == np.arange(rows)))
    return head, min(n - head, _leading((alone & (only == np.arange(rows) - (rows - n)))[::-1]))


def _leading(flags: NDArray[np.bool_]) -> int:
    """Count the leading True values."""
    return len(flags) if flags.all() else int(np.argmin(flags))


def without_knots(degree: int, knots: FloatArray, less: FloatArray, name: str) -> FloatArray:
    """Return the clamped vector without some of its inner knots; one is repeated to take several copies of it away.

    A value within 1e-12 of the domain of a knot means that knot.

    Raises
    ------
    KnotError
        A value that is no inner knot, or is one fewer times.

    Examples
    --------
    >>> without_knots(2, np.array([0, 0, 0, 0.5, 0.5, 1, 1, 1.0]), np.array([0.5]), "knots")
    array([0. , 0. , 0. , 0.5, 1. , 1. , 1. ])
    """
    left = knots
    for i, value in enumerate(less.tolist()):
        at = snapped(value, knots)
        places = np.flatnonzero(left == at)
        if not len(places) or at in (knots[0], knots[-1]):
            known = np.unique(inner_knots(knots, degree))
            raise KnotError(
                f"{name}[{i}]: found {value}, expected an inner knot, no more often than it is there: {known}"
            )
        left = np.delete(left, places[0])
    return left


def removal_matrix(degree: int, knots: FloatArray, fewer: FloatArray) -> SparseMatrix:
    """Return the matrix from control points over `knots` to those over `fewer` that fit them best."""
    return coarsening_matrix(refinement_matrix(degree, fewer, knots))


def reduction_matrix(degree: int, knots: FloatArray, new_degree: int) -> tuple[SparseMatrix, FloatArray]:
    """Return the matrix from control points to those of a lower degree that fit them best, and their knots.

    Inner knots keep what continuity they have, but are simple at least: the fit is made over the knots that the
    spline of lower degree has when it is raised again.

    Raises
    ------
    KnotError
        A degree below 1 or above the present one.
    """
    by = degree - new_degree
    values, counts = np.unique(knots, return_counts=True)
    low = np.repeat(values, np.maximum(counts - by, 1))
    fine = elevated_knots(low, by)
    fit = coarsening_matrix(elevation_matrix(new_degree, low, degree))
    return (fit @ refinement_matrix(degree, knots, fine)).tocsr(), low
