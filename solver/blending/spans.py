"""Rows of splines span by span: Bezier points of each, and back to as few knots as their smoothness asks for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Basis, clamped, refinement_matrix


def bezier_pieces(rows: FloatArray, along: Basis) -> tuple[FloatArray, FloatArray]:
    """Return the distinct knots, shape (S + 1,), and Bezier points of each span, shape (S, K, degree + 1, d)."""
    q = along.degree
    breaks = np.unique(along.knots)
    full = np.concatenate([breaks[[0]], np.repeat(breaks, q), breaks[[-1]]])
    matrix = refinement_matrix(q, along.knots, full)
    points = np.asarray([matrix @ row for row in rows])
    return breaks, np.stack([points[:, k * q : k * q + q + 1] for k in range(len(breaks) - 1)])


def joined_spans(pieces: Sequence[FloatArray], places: FloatArray, smooth: Sequence[int]) -> tuple[FloatArray, Basis]:
    """Return rows, shape (K, n, d), from Bezier points of spans, each of shape (K, degree + 1, d).

    Parameters
    ----------
    pieces : sequence of ndarray
        Of one degree; where spans meet their common point is the mean of both.
    places : ndarray, shape (S + 1,)
        Where the spans begin, and where the last one ends.
    smooth : sequence of int, length S - 1
        How many derivatives agree at each inner place: what is not so is fitted.

    Examples
    --------
    >>> line = [np.array([[[0.0], [1]]]), np.array([[[1.0], [3]]])]
    >>> joined_spans(line, np.array([0, 1, 3.0]), [0])[0].ravel()
    array([0., 1., 3.])
    """
    degree = pieces[0].shape[1] - 1
    common = [(one[:, -1:] + other[:, :1]) / 2 for one, other in pairwise(pieces)]
    own = [piece[:, 1:-1] for piece in pieces[1:]]
    inner = [np.concatenate(pair, axis=1) for pair in zip(common, own, strict=True)]
    points = np.concatenate([pieces[0][:, :-1], *inner, pieces[-1][:, -1:]], axis=1)
    finest = clamped(np.repeat(places[1:-1], degree), degree, places[0], places[-1])
    counts = degree - np.array(smooth, dtype=int)
    knots = clamped(np.repeat(places[1:-1], counts), degree, places[0], places[-1])
    matrix = refinement_matrix(degree, knots, finest).toarray()
    flat = points.transpose(1, 0, 2).reshape(len(matrix), -1)
    coarse = np.linalg.lstsq(matrix, flat, rcond=None)[0].reshape(matrix.shape[1], len(points), -1)
    return np.ascontiguousarray(coarse.transpose(1, 0, 2)), Basis(degree, knots)
