"""Exact changes of a spline's knots and degree, as sparse matrices that act on control points.

Everything here is one idea: a control point of the new form is the blossom of the old spline at the knots that belong
to it (degree elevation takes a mean of blossoms). Arguments are taken in ascending order and from the segment where the
new basis function begins, so that every step is a convex combination: nothing is extrapolated.

Sources: L. Ramshaw, Blossoming: a connect-the-dots approach to splines, 1987; E. Cohen, T. Lyche, R. Riesenfeld,
Discrete B-splines and subdivision techniques, 1980 (the Oslo algorithm).

SciPy waits inside the functions that need it, as in `knots`.
"""

from __future__ import annotations

from bisect import bisect_left

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semispline.solver.arrays import FloatArray, SparseMatrix, exact_origin, finite_array
from semispline.solver.errors import ControlPointError, KnotError
from semispline.solver.scalars import is_whole, whole_number
from semispline.solver.splines.knots import MERGE_TOLERANCE, clamped


def blossom_matrix(degree: int, knots: FloatArray, start: FloatArray, arguments: FloatArray) -> SparseMatrix:
    """Return the matrix whose row j takes control points to the blossom at `arguments[j]` of the segment at `start[j]`.

    Parameters
    ----------
    degree : int
    knots : ndarray, shape (n + degree + 1,)
        Need not be clamped.
    start : ndarray, shape (N,)
        Where the segment begins: the non-empty span with t_k <= start < t_(k+1).
    arguments : ndarray, shape (N, degree)
        In ascending order along axis 1, none below `start`.

    Returns
    -------
    sparse array, shape (N, n)

    Examples
    --------
    >>> blossom_matrix(1, np.array([0, 0, 1, 1.0]), np.array([0.0]), np.array([[0.25]])).toarray()
    array([[0.75, 0.25]])
    """
    span = _spans(degree, knots, start)
    return _banded(_blossom_values(degree, knots, span, arguments), span - degree, len(knots) - degree - 1)


def _spans(degree: int, knots: FloatArray, start: FloatArray) -> NDArray[np.intp]:
    last = len(knots) - degree - 2
    return np.asarray(np.clip(np.searchsorted(knots, start, side="right") - 1, degree, last))


def _blossom_values(degree: int, knots: FloatArray, span: NDArray[np.intp], arguments: FloatArray) -> FloatArray:
    """Return the weights of the degree + 1 control points of each span, shape (N, degree + 1)."""
    values = np.zeros((len(span), degree + 1))
    values[:, 0] = 1.0
    for level in range(1, degree + 1):
        x = arguments[:, level - 1]
        carried = np.zeros(len(span))
        for s in range(level):
            right, left = knots[span + s + 1], knots[span + 1 - level + s]
            # 1 - a, not (right - x) / width: a knot that meets an argument then gives exactly 0 and 1.
            a = (x - left) / (right - left)
            passed = a * values[:, s]
            values[:, s] = carried + (1.0 - a) * values[:, s]
            carried = passed
        values[:, level] = carried
    return values


def _banded(values: FloatArray, first: NDArray[np.intp], n: int) -> SparseMatrix:
    """Return the sparse matrix with n columns whose row j has `values[j]` from column `first[j]` on."""
    from scipy.sparse import csr_array

    width = values.shape[1]
    columns = first[:, None] + np.arange(width)
    matrix = csr_array((values.ravel(), columns.ravel(), np.arange(0, values.size + 1, width)), shape=(len(values), n))
    matrix.eliminate_zeros()
    return matrix


def _windows(knots: FloatArray, width: int, count: int) -> FloatArray:
    """Return `knots[j + 1 : j + 1 + width]` for j < count, shape (count, width)."""
    return np.asarray(knots[1 + np.arange(count)[:, None] + np.arange(width)])


def refinement_matrix(degree: int, knots: FloatArray, refined: FloatArray) -> SparseMatrix:
    """Return the matrix of knot insertion, shape (n_refined, n).

    Parameters
    ----------
    degree : int
    knots, refined : ndarray
        Clamped over one domain; `refined` has every knot of `knots` at least as often.

    Raises
    ------
    KnotError
        A knot of the old vector is missing from the new one.

    Examples
    --------
    >>> refinement_matrix(1, np.array([0, 0, 1, 1.0]), np.array([0, 0, 0.5, 1, 1])).toarray()
    array([[1. , 0. ],
           [0.5, 0.5],
           [0. , 1. ]])
    """
    values, counts = np.unique(knots, return_counts=True)
    found = np.searchsorted(refined, values, side="right") - np.searchsorted(refined, values, side="left")
    if (found < counts).any():
        i = int(np.argmax(found < counts))
        raise KnotError(f"refined knots: {values[i]} occurs {found[i]} time(s), expected at least {counts[i]}")
    if refined[0] != knots[0] or refined[-1] != knots[-1]:
        raise KnotError(
            f"refined knots: domain [{refined[0]}, {refined[-1]}], expected that of the old, [{knots[0]}, {knots[-1]}]"
        )
    n = len(refined) - degree - 1
    return blossom_matrix(degree, knots, refined[:n], _windows(refined, degree, n))


def combined(matrix: SparseMatrix, points: FloatArray) -> FloatArray:
    """Return affine combinations of points, shape (n, ...), formed around an origin near them.

    So they round as their distance from each other asks for, wherever the points lie; but for the last addition.
    """
    flat = points.reshape(len(points), -1)
    width = points.shape[-1]
    origin = np.tile(exact_origin(points.reshape(-1, width)), flat.shape[1] // width)
    return np.asarray(matrix @ (flat - origin) + origin).reshape(-1, *points.shape[1:])


def elevated_knots(knots: FloatArray, by: int = 1) -> FloatArray:
    """Return the knots of the same spline with its degree raised: every knot `by` times more.

    Examples
    --------
    >>> elevated_knots(np.array([0, 0, 0.5, 1, 1]))
    array([0. , 0. , 0. , 0.5, 0.5, 1. , 1. , 1. ])
    """
    values, counts = np.unique(knots, return_counts=True)
    return np.asarray(np.repeat(values, counts + by))


def elevation_matrix(degree: int, knots: FloatArray, new_degree: int) -> SparseMatrix:
    """Return the matrix of degree elevation, shape (n_new, n); the new knots are `elevated_knots`.

    Each step from p to p + 1 takes the mean of the p + 1 blossoms that leave one argument out; it is exact for inner
    knots of any multiplicity.

    Examples
    --------
    >>> elevation_matrix(1, np.array([0, 0, 1, 1.0]), 2).toarray()
    array([[1. , 0. ],
           [0.5, 0.5],
           [0. , 1. ]])
    """
    if not is_whole(new_degree) or new_degree < degree:
        raise KnotError(
            f"degree: found {new_degree!r}, expected at least the present degree {degree}, as a whole number"
        )
    from scipy.sparse import eye_array

    matrix = eye_array(len(knots) - degree - 1, format="csr")
    for p in range(degree, new_degree):
        raised = elevated_knots(knots)
        n = len(raised) - p - 2
        window = _windows(raised, p + 1, n)
        span = _spans(p, knots, raised[:n])
        blossoms = (_blossom_values(p, knots, span, np.delete(window, i, axis=1)) for i in range(p + 1))
        matrix = _banded(sum(blossoms, np.zeros((n, p + 1))) / (p + 1), span - p, len(knots) - p - 1) @ matrix
        knots = raised
    return matrix


def linear_product_matrices(degree: int, knots: FloatArray) -> tuple[SparseMatrix, SparseMatrix, FloatArray]:
    """Return the matrices of the products with 1 - s and with s, and their knots; s goes from 0 to 1 over the domain.

    A product has one degree more, and `elevated_knots`. Control point j is the mean over r of s(W[j + r]) times the
    blossom at the other knots of W[j + 1] .. W[j + degree + 1]; all steps are convex combinations.

    Source: `semispline.derivations.linear_alpha`.

    Examples
    --------
    >>> falling, rising, raised = linear_product_matrices(1, np.array([0, 0, 1, 1.0]))
    >>> rising.toarray(), raised
    (array([[0. , 0. ],
           [0.5, 0. ],
           [0. , 1. ]]), array([0., 0., 0., 1., 1., 1.]))
    """
    raised = elevated_knots(knots)
    n = len(raised) - degree - 2
    window = _windows(raised, degree + 1, n)
    span = _spans(degree, knots, raised[:n])
    s = (window - knots[0]) / (knots[-1] - knots[0])
    falling, rising = np.zeros((n, degree + 1)), np.zeros((n, degree + 1))
    for i in range(degree + 1):
        blossom = _blossom_values(degree, knots, span, np.delete(window, i, axis=1)) / (degree + 1)
        falling += (1.0 - s[:, i : i + 1]) * blossom
        rising += s[:, i : i + 1] * blossom
    count = len(knots) - degree - 1
    return _banded(falling, span - degree, count), _banded(rising, span - degree, count), raised


def restriction_matrix(degree: int, knots: FloatArray, start: float, end: float) -> tuple[SparseMatrix, FloatArray]:
    """Return the matrix that restricts a spline to [start, end], and the clamped knots of the piece.

    `knots` need not be clamped; the range must lie in their domain [t_p, t_n].

    Examples
    --------
    >>> matrix, piece = restriction_matrix(1, np.array([0, 0, 1, 1.0]), 0.0, 0.5)
    >>> matrix.toarray(), piece
    (array([[1. , 0. ],
           [0.5, 0.5]]), array([0. , 0. , 0.5, 0.5]))
    """
    first, last = float(knots[degree]), float(knots[-degree - 1])
    if not first <= start < end <= last:
        raise KnotError(f"range [{start}, {end}]: expected a range of positive length within [{first}, {last}]")
    piece = clamped(knots[(knots > start) & (knots < end)], degree, start, end)
    n = len(piece) - degree - 1
    return blossom_matrix(degree, knots, piece[:n], _windows(piece, degree, n)), piece


def piece_matrix(degree: int, knots: FloatArray, start: float, end: float) -> tuple[SparseMatrix, FloatArray]:
    """Return what `restriction_matrix` does, with ends that mean the knots within 1e-12 of the domain of them.

    The piece then begins and ends at such a knot, called `start` or `end`: a span of the width of rounding, which has
    no reliable derivatives, is not left behind.

    Examples
    --------
    >>> piece_matrix(1, np.array([0, 0, 0.1 + 0.2, 1, 1]), 0.3, 1.0)[1]
    array([0.3, 0.3, 1. , 1. ])
    """
    first, last = float(knots[degree]), float(knots[-degree - 1])
    if not first <= start < end <= last:
        raise KnotError(f"range [{start}, {end}]: expected a range of positive length within [{first}, {last}]")
    tolerance = MERGE_TOLERANCE * (last - first)
    inner = knots[(knots > first) & (knots < last)]
    own_start = float(max(inner[np.abs(inner - start) <= tolerance], default=start))
    own_end = float(min(inner[np.abs(inner - end) <= tolerance], default=end))
    if not own_start < own_end:
        own_start, own_end = start, end
    matrix, piece = restriction_matrix(degree, knots, own_start, own_end)
    piece[: degree + 1], piece[-degree - 1 :] = start, end
    return matrix, piece


def clamp_knots(degree: int, knots: ArrayLike, control_points: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return clamped knots and control points of the same spline over its domain [t_p, t_n].

    For the unclamped and periodic vectors that CAD files hold. A periodic spline must come with its repeated control
    points; where a format leaves out the first and the last knot (openNURBS), repeat the ends before the call, the
    values do not matter.

    Parameters
    ----------
    degree : int
    knots : array_like, shape (n + degree + 1,)
        Non-decreasing.
    control_points : array_like, shape (n, ...)
        Multiplied by the weights, and followed by them, where the spline is rational.

    Returns
    -------
    ndarray, shape (n_clamped + degree + 1,)
    ndarray, shape (n_clamped, ...)

    Raises
    ------
    KnotError
        Wrong length, decreasing knots, or an empty domain.
    ControlPointError
        Control points that are not finite.

    Examples
    --------
    >>> clamp_knots(2, [0, 1, 2, 3, 4, 5], [[0.0], [2.0], [4.0]])
    (array([2., 2., 2., 3., 3., 3.]), array([[1.],
           [2.],
           [3.]]))
    """
    vector = finite_array(knots, 1, "knots", KnotError)
    points = finite_array(control_points, None, "control_points", ControlPointError)
    whole_number(degree, "degree", 1, KnotError)
    n = len(points)
    if n < degree + 1 or len(vector) != n + degree + 1:
        raise KnotError(
            f"knots: {len(vector)} for {n} control points of degree {degree}, expected {n + degree + 1}, "
            f"and at least {degree + 1} control points"
        )
    steps = np.diff(vector)
    if (steps < 0).any():
        i = int(np.argmax(steps < 0))
        raise KnotError(f"knots[{i + 1}]: {vector[i + 1]} after {vector[i]}, expected a non-decreasing vector")
    matrix, piece = restriction_matrix(degree, vector, float(vector[degree]), float(vector[n]))
    return piece, np.asarray((matrix @ points.reshape(n, -1)).reshape((-1, *points.shape[1:])))


def snapped(value: float, knots: FloatArray) -> float:
    """Return the knot that `value` means: the nearest within 1e-12 of the domain, else `value` itself.

    Examples
    --------
    >>> snapped(0.3 + 1e-16, np.array([0, 0.3, 1]))
    0.3
    """
    nearest = float(knots[np.argmin(np.abs(knots - value))])
    return nearest if abs(nearest - value) <= MERGE_TOLERANCE * float(knots[-1] - knots[0]) else float(value)


def with_knots(degree: int, knots: FloatArray, more: FloatArray, name: str) -> FloatArray:
    """Return the clamped vector with further knots in it.

    One within 1e-12 of the domain of a knot, or of another inserted before it, means that one.

    Raises
    ------
    KnotError
        Outside the domain, or a multiplicity above the degree.

    Examples
    --------
    >>> with_knots(2, np.array([0, 0, 0, 1, 1, 1.0]), np.array([0.5, 0.5]), "knots")
    array([0. , 0. , 0. , 0.5, 0.5, 1. , 1. , 1. ])
    """
    # A value may also mean one inserted before it, to the same tolerance.
    tolerance = MERGE_TOLERANCE * float(knots[-1] - knots[0])
    known, inserted = np.unique(knots).tolist(), np.array(more, dtype=np.float64)
    for i, value in enumerate(more.tolist()):
        at = bisect_left(known, value)
        nearest = min(known[max(at - 1, 0) : at + 1], key=lambda knot: abs(knot - value))
        if abs(nearest - value) <= tolerance:
            inserted[i] = nearest
        else:
            known.insert(at, value)
    outside = ~((inserted > knots[0]) & (inserted < knots[-1]))
    if outside.any():
        i = int(np.argmax(outside))
        raise KnotError(f"{name}[{i}]: found {more[i]}, expected a value inside ({knots[0]}, {knots[-1]})")
    refined = np.sort(np.concatenate([knots, inserted]))
    values, counts = np.unique(refined, return_counts=True)
    total = counts[np.searchsorted(values, inserted)]
    if (total > degree).any():
        value = float(inserted[total > degree].min())
        i = int(np.argmax(inserted == value))
        raise KnotError(f"{name}[{i}]: knot {value} would have multiplicity {total[i]}, expected at most {degree}")
    return refined
