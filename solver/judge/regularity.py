"""How far a surface is from folding: area element and turn of the normal over samples, and what can be proved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import comb

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.splines import BSplineSurface, Surface, blossom_matrix, elevation_matrix

# Samples in each span: enough that the normal of a smooth cubic span turns by a few degrees between neighbours.
_PER_SPAN = 8
_FRACTIONS = np.arange(_PER_SPAN) / _PER_SPAN
# Polynomial pieces that are worked on at once: a long surface has more samples than memory should hold.
_PIECES_AT_ONCE = 2048


@dataclass(frozen=True)
class Regularity:
    """How far a surface is from folding.

    Attributes
    ----------
    least_area_ratio : float
        Least |P_u x P_v| over its mean.
    largest_turn_degrees : float
        Largest angle between the normals of neighbouring samples; 180 where there is no normal.
    proved_area_ratio : float or None
        A lower bound of |P_u x P_v| over its mean, proved by Bernstein coefficients up to rounding; None where they
        prove nothing (then the surface may still be regular) or the surface is rational.
    """

    least_area_ratio: float
    largest_turn_degrees: float
    proved_area_ratio: float | None


def measure_regularity(surface: Surface) -> Regularity:
    """Measure the area element and the turn of the normal on a grid of 8 samples in every span.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> measure_regularity(flat)
    Regularity(least_area_ratio=1.0, largest_turn_degrees=0.0, proved_area_ratio=1.0)
    """
    across = _Across.of(surface)
    least, largest, total, count, turn, bound = np.inf, 0.0, 0.0, 0, 0.0, np.inf
    before: FloatArray | None = None
    for part in _parts(surface):
        cross = _sampled_cross(part, across)
        area = np.sqrt(_dot(cross, cross))
        least, largest = min(least, float(area.min())), max(largest, float(area.max()))
        if least <= 1e-14 * largest:
            return Regularity(0.0, 180.0, None)
        total, count = total + float(area.sum()), count + area.size
        normal = cross / area[:, None]
        turn = max(turn, _turn(normal[:-1], normal[1:]), _turn(normal[..., :-1], normal[..., 1:]))
        if before is not None:
            turn = max(turn, _turn(before, normal[..., :1]))
        before = normal[..., -1:]
        # Where nothing is proved in one part nothing is in all.
        bound = min(bound, _least_height(part, across)) if bound > 0 else bound
    mean = total / count
    return Regularity(least / mean, turn, bound / mean if bound > 0 else None)


def area_bound(surface: Surface) -> float:
    """Return a lower bound of |P_u x P_v|; not positive where nothing is proved, as for rational surfaces.

    On each polynomial piece the bound is the least Bernstein coefficient of (P_u x P_v) . n, n its own mean normal.

    Source: range of a polynomial within its Bernstein coefficients; G. Farin, Curves and Surfaces for CAGD, ch. 6.
    """
    across = _Across.of(surface)
    return min(_least_height(part, across) for part in _parts(surface))


@dataclass(frozen=True, eq=False)
class _Across:
    """Matrices that act on the rows of a surface: to Bezier points in u, to samples in u, to their u-derivatives."""

    u_widths: FloatArray
    pieces: SparseMatrix
    samples: SparseMatrix
    slopes: SparseMatrix

    @staticmethod
    def of(surface: Surface) -> _Across:
        u_breaks = surface.breakpoints[0]
        widths, pieces = np.diff(u_breaks), _bezier_matrix(surface.degree_u, surface.knots_u, u_breaks)
        samples, slopes = (_sampling(surface.degree_u, widths, order) @ pieces for order in (0, 1))
        return _Across(widths, pieces, samples, slopes)


@dataclass(frozen=True, eq=False)
class _Part:
    """Some spans of v.

    Attributes
    ----------
    v_widths : ndarray, shape (S,)
    rows : ndarray, shape (m + 1, 3 or 4, S, q + 1)
        Bezier points of all rows; homogeneous for a rational surface.
    is_last : bool
        The spans are the last ones.
    """

    v_widths: FloatArray
    rows: FloatArray
    is_last: bool


def _sampled_cross(part: _Part, across: _Across) -> FloatArray:
    """Return P_u x P_v at the samples of a part, shape (samples in u, 3, samples in v)."""
    rows, q = part.rows, part.rows.shape[3] - 1
    along, steep = _bernstein(q, _FRACTIONS).T, _bernstein(q - 1, _FRACTIONS).T

    def at_samples(matrix: SparseMatrix, nets: FloatArray, values: FloatArray) -> FloatArray:
        at_u = _applied(matrix, nets)
        inside = (at_u @ values).reshape(*at_u.shape[:2], -1)
        # The end of the domain; other ends of spans are the next span's.
        return np.concatenate([inside, at_u[:, :, -1, -1:]], axis=2) if part.is_last else inside

    by_u = at_samples(across.slopes, rows, along)
    by_v = at_samples(across.samples, q * np.diff(rows, axis=3) / part.v_widths[:, None], steep)
    if by_u.shape[1] > 3:
        # Quotient rule.
        point = at_samples(across.samples, rows, along)
        by_u, by_v = ((x[:, :3] - x[:, 3:] / point[:, 3:] * point[:, :3]) / point[:, 3:] for x in (by_u, by_v))
    return _cross(by_u, by_v)


def _parts(surface: Surface) -> Iterator[_Part]:
    """Cut a surface along v into parts of some polynomial pieces."""
    q, n_u = surface.degree_v, len(surface.breakpoints[0]) - 1
    v_breaks = surface.breakpoints[1]
    groups, (n_rows, d) = _rows_by_knots(surface)
    step = max(1, _PIECES_AT_ONCE // n_u)
    for at in range(0, len(v_breaks) - 1, step):
        breaks = v_breaks[at : at + step + 1]
        nets = np.empty((n_rows, d, len(breaks) - 1, q + 1))
        for group in groups:
            degree = group.degree
            # Of a long row only what these spans read.
            low, high = np.searchsorted(group.knots, _middles(breaks)[[0, -1]], side="right") - 1
            matrix = _bezier_matrix(degree, group.knots[low - degree : high + degree + 2], breaks)
            points = (matrix @ group.points[low - degree : high + 1]).reshape(-1, degree + 1, len(group.rows), d)
            own = points.transpose(2, 3, 0, 1)
            ends = np.repeat([0.0, 1.0], degree + 1)
            nets[group.rows] = own @ elevation_matrix(degree, ends, q).toarray().T if degree < q else own
        yield _Part(np.diff(breaks), nets, at + step >= len(v_breaks) - 1)


@dataclass(frozen=True, eq=False)
class _Rows:
    """Rows over the same knots, as one curve: indices of the rows, points of shape (n, rows x coordinates)."""

    rows: NDArray[np.intp]
    degree: int
    knots: FloatArray
    points: FloatArray


def _rows_by_knots(surface: Surface) -> tuple[list[_Rows], tuple[int, int]]:
    """Return the rows of a surface, and how many rows of how many coordinates there are."""
    if isinstance(surface, BSplineSurface):
        n_u, n_v, d = surface.homogeneous.shape
        points = surface.homogeneous.transpose(1, 0, 2).reshape(n_v, n_u * d)
        return [_Rows(np.arange(n_u), surface.degree_v, surface.knots_v, points)], (n_u, d)
    alike: dict[tuple[int, bytes], list[int]] = {}
    for i, curve in enumerate(surface.control_curves):
        alike.setdefault((curve.degree, curve.knots.tobytes()), []).append(i)
    groups = []
    for rows in alike.values():
        curves = [surface.control_curves[i] for i in rows]
        points = np.concatenate([curve.control_points for curve in curves], axis=1)
        groups.append(_Rows(np.array(rows), curves[0].degree, curves[0].knots, points))
    return groups, (len(surface.control_curves), 3)


def _middles(breaks: FloatArray) -> FloatArray:
    return np.asarray((breaks[:-1] + breaks[1:]) / 2)


def _bezier_matrix(degree: int, knots: FloatArray, breaks: FloatArray) -> SparseMatrix:
    """Return the matrix that takes control points to Bezier points, shape (spans x (degree + 1), n).

    Bezier point j of a span is the blossom at its start, degree - j times, and its end, j times. Which polynomial that
    is the middle of the span decides: ends of spans may be merged knots, off by rounding.
    """
    ends = np.arange(degree) >= degree - np.arange(degree + 1)[:, None]
    arguments = np.where(ends, breaks[1:, None, None], breaks[:-1, None, None])
    return blossom_matrix(degree, knots, np.repeat(_middles(breaks), degree + 1), arguments.reshape(-1, degree))


def _sampling(degree: int, widths: FloatArray, order: int) -> SparseMatrix:
    """Return the matrix from Bezier points of all spans to a derivative at the samples of all, and at the end."""
    lower, factor = np.diff(np.eye(degree + 1), n=order, axis=0), (degree / widths) ** order
    inside = sp.kron(sp.diags_array(factor), _bernstein(degree - order, _FRACTIONS) @ lower)
    end = sp.kron(np.append(np.zeros(len(widths) - 1), factor[-1])[None], lower[-1:])
    return sp.vstack([inside, end], format="csr")


def _bernstein(degree: int, t: FloatArray) -> FloatArray:
    """Return the Bernstein polynomials at t, shape (len(t), degree + 1)."""
    i = np.arange(degree + 1)
    return np.asarray([comb(degree, k) for k in i] * t[:, None] ** i * (1 - t[:, None]) ** (degree - i))


def _applied(matrix: SparseMatrix, rows: FloatArray) -> FloatArray:
    """Return the combinations of rows, along axis 0."""
    return np.asarray((matrix @ rows.reshape(len(rows), -1)).reshape(-1, *rows.shape[1:]))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the dot product of vectors along axis 1."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def _cross(a: FloatArray, b: FloatArray, axis: int = 1) -> FloatArray:
    """Return the cross product of vectors along an axis that is not the last, which is long."""
    (x, y, z), (u, v, w) = (np.moveaxis(c, axis, 0) for c in (a, b))
    result = np.empty(np.broadcast_shapes(a.shape, b.shape))
    products = ((y, w, z, v), (z, u, x, w), (x, v, y, u))
    for component, (p, q, r, s) in zip(np.moveaxis(result, axis, 0), products, strict=True):
        np.multiply(p, q, out=component)
        np.subtract(component, r * s, out=component)
    return result


def _turn(n1: FloatArray, n2: FloatArray) -> float:
    """Return the largest angle between unit vectors along axis 1, in degrees: where their ends are farthest apart."""
    between = n2 - n1
    apart = _dot(between, between)
    i, j = np.unravel_index(int(apart.argmax()), apart.shape)
    sine, cosine = np.linalg.norm(np.cross(n1[i, :, j], n2[i, :, j])), n1[i, :, j] @ n2[i, :, j]
    return float(np.degrees(np.arctan2(sine, cosine)))


def _least_height(part: _Part, across: _Across) -> float:
    """Return the least Bernstein coefficient of (P_u x P_v) . n over the pieces of a part; 0 if it proves nothing."""
    if part.rows.shape[1] > 3:
        return 0.0
    nets = _applied(across.pieces, part.rows).reshape(len(across.u_widths), -1, *part.rows.shape[1:])
    # Pieces last, there are many: shape (p + 1, q + 1, 3, U, S).
    nets = np.ascontiguousarray(nets.transpose(1, 4, 2, 0, 3))
    p, q = (n - 1 for n in nets.shape[:2])
    by_u = p * np.diff(nets, axis=0) / across.u_widths[:, None]
    by_v = q * np.diff(nets, axis=1) / part.v_widths
    cross = _bernstein_cross(by_u, by_v)
    normal = cross.mean(axis=(0, 1))
    length = np.sqrt(np.sum(normal**2, axis=0))
    if not length.min() > 0:
        return 0.0
    heights = sum(cross[:, :, d] * normal[d] for d in range(3))
    return float((heights / length).min())


def _bernstein_cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the Bernstein coefficients of the cross product of two vector polynomials, shape (..., ..., 3, U, S)."""
    (m, n), (k, r) = (tuple(d - 1 for d in x.shape[:2]) for x in (a, b))
    scaled = b * _binomials(k, r)
    total = np.zeros((m + k + 1, n + r + 1, *a.shape[2:]))
    for i in range(m + 1):
        for j in range(n + 1):
            one = (comb(m, i) * comb(n, j) * a[i, j])[None, None]
            total[i : i + k + 1, j : j + r + 1] += _cross(one, scaled, axis=2)
    return np.asarray(total / _binomials(m + k, n + r))


def _binomials(m: int, n: int) -> FloatArray:
    """Return products of binomial coefficients, to multiply coefficients of shape (m + 1, n + 1, 3, U, S)."""
    return np.outer([comb(m, i) for i in range(m + 1)], [comb(n, j) for j in range(n + 1)])[:, :, None, None, None]
