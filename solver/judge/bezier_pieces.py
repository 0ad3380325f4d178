"""A surface cut into its Bezier pieces: to be measured piece by piece, or evaluated fast on many grids."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise
from math import factorial, perm
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semispline.solver.arrays import FloatArray, SparseMatrix, exact_origin
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.splines import (
    BSplineSurface,
    SemiStructuredSurface,
    Surface,
    blossom_matrix,
    bounding_box,
    elevation_matrix,
)

_Values: TypeAlias = Callable[[FloatArray, FloatArray, int, int], FloatArray]
# Polynomial pieces that are worked on at once: a long surface has more of them than memory should hold.
_PIECES_AT_ONCE = 2048


@dataclass(frozen=True, eq=False)
class Part:
    """Some spans of v.

    Attributes
    ----------
    v_widths : ndarray, shape (S,)
    rows : ndarray, shape (m + 1, 3 or 4, S, q + 1)
        Bezier points of all rows; homogeneous for a rational surface.
    """

    v_widths: FloatArray
    rows: FloatArray


def parts_of(surface: Surface, cuts: int = 1) -> Iterator[Part]:
    """Cut a surface along v into parts of some polynomial pieces, each span into so many."""
    q, n_u = surface.degree_v, len(surface.breakpoints[0]) - 1
    v_breaks = surface.breakpoints[1]
    if cuts > 1:
        v_breaks = np.append((v_breaks[:-1, None] + np.diff(v_breaks)[:, None] * np.arange(cuts) / cuts), v_breaks[-1])
    groups, (n_rows, d) = _rows_by_knots(surface)
    step = max(1, _PIECES_AT_ONCE // n_u)
    for at in range(0, len(v_breaks) - 1, step):
        breaks = v_breaks[at : at + step + 1]
        nets = np.empty((n_rows, d, len(breaks) - 1, q + 1))
        for group in groups:
            degree = group.degree
            # Of a long row only what these spans read.
            low, high = np.searchsorted(group.knots, _middles(breaks)[[0, -1]], side="right") - 1
            matrix = bezier_matrix(degree, group.knots[low - degree : high + degree + 2], breaks)
            points = (matrix @ group.points[low - degree : high + 1]).reshape(-1, degree + 1, len(group.rows), d)
            own = points.transpose(2, 3, 0, 1)
            nets[group.rows] = own @ _elevation(degree, q).T if degree < q else own
        yield Part(np.diff(breaks), nets)


def bezier_matrix(degree: int, knots: FloatArray, breaks: FloatArray) -> SparseMatrix:
    """Return the matrix that takes control points to Bezier points, shape (spans x (degree + 1), n).

    Bezier point j of a span is the blossom at its start, degree - j times, and its end, j times. Which polynomial that
    is the middle of the span decides: ends of spans may be merged knots, off by rounding.
    """
    ends = np.arange(degree) >= degree - np.arange(degree + 1)[:, None]
    arguments = np.where(ends, breaks[1:, None, None], breaks[:-1, None, None])
    return blossom_matrix(degree, knots, np.repeat(_middles(breaks), degree + 1), arguments.reshape(-1, degree))


def bernstein_by_degree(degree: int, t: FloatArray) -> list[FloatArray]:
    """Return the Bernstein polynomials at t of the degrees 0 to `degree`, each of shape (len(t), its degree + 1)."""
    found = [np.ones((len(t), 1))]
    t = t[:, None]
    for k in range(degree):
        values = np.empty((len(t), k + 2))
        raised = t * found[k]
        values[:, :-1] = found[k] - raised
        values[:, -1] = 0.0
        values[:, 1:] += raised
        found.append(values)
    return found


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
    d = 4 if surface.is_rational else 3
    for rows in alike.values():
        curves = [surface.control_curves[i] for i in rows]
        points = np.concatenate([_with_columns(curve.homogeneous, d) for curve in curves], axis=1)
        groups.append(_Rows(np.array(rows), curves[0].degree, curves[0].knots, points))
    return groups, (len(surface.control_curves), d)


def _with_columns(points: FloatArray, d: int) -> FloatArray:
    """Return points with d columns: what has no weight has weight 1."""
    return points if points.shape[1] == d else np.concatenate([points, np.ones((len(points), 1))], axis=1)


def _middles(breaks: FloatArray) -> FloatArray:
    return np.asarray((breaks[:-1] + breaks[1:]) / 2)


def in_pieces(surface: ParametricSurface) -> ParametricSurface:
    """Return the same surface, evaluated many times as fast on small grids where it is a spline."""
    return _Pieces.of(surface) if isinstance(surface, SemiStructuredSurface | BSplineSurface) else surface


@dataclass(frozen=True, eq=False)
class _Pieces:
    """A surface by its Bezier points, shape (S, q + 1, U (p + 1) d): those of all spans of u for each of v.

    Of a rational surface they are homogeneous, d = 4, and counted from an origin.
    """

    breakpoints: tuple[FloatArray, FloatArray]
    degree_u: int
    points: FloatArray
    columns: int
    origin: FloatArray
    # Grids share their parameters.
    known: dict[tuple[int, bytes], _Places] = field(default_factory=dict)
    # Of the last parameters v of a grid: what `_along` returns, by order.
    sections: dict[tuple[bytes, int], FloatArray] = field(default_factory=dict)
    # Of the last parameters of a rational surface: points and weights of each order.
    quotients: dict[tuple[str, bytes, bytes], _Quotients] = field(default_factory=dict)

    @staticmethod
    def of(surface: Surface) -> _Pieces:
        breaks, origin = surface.breakpoints, np.zeros(3)
        if surface.is_rational:
            # Far from it differences of products would round by the distance.
            origin = exact_origin(bounding_box(surface))
            surface = _counted_from(surface, origin)
        cut = bezier_matrix(surface.degree_u, surface.knots_u, breaks[0])
        rows = np.concatenate([part.rows for part in parts_of(surface)], axis=2)
        points = (cut @ rows.reshape(len(rows), -1)).reshape(-1, *rows.shape[1:]).transpose(2, 3, 0, 1)
        points = np.ascontiguousarray(points).reshape(*points.shape[:2], -1)
        return _Pieces(breaks, surface.degree_u, points, rows.shape[1], origin)

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""
        u, v = self.breakpoints
        return (float(u[0]), float(u[-1])), (float(v[0]), float(v[-1]))

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the point or a derivative at (u[k], v[k]), shape (K, 3)."""
        return self._euclidean("points", self._at_points, u, v, (du, dv))

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the same on the grid u x v, shape (len(u), len(v), 3)."""
        return self._euclidean("grid", self._on_grid, u, v, (du, dv))

    def _at_points(self, u: FloatArray, v: FloatArray, du: int, dv: int) -> FloatArray:
        at_u, at_v = self._places(0, u), self._places(1, v)
        points = self.points.reshape(*self.points.shape[:2], -1, self.degree_u + 1, self.columns)
        return np.asarray(
            np.einsum("ki,kj,kjid->kd", at_u.basis(du), at_v.basis(dv), points[at_v.pieces, :, at_u.pieces])
        )

    def _on_grid(self, u: FloatArray, v: FloatArray, du: int, dv: int) -> FloatArray:
        at_u, d = self._places(0, u), self.columns
        of_u, pieces = at_u.basis(du), self._along(v, dv)
        found = np.empty((len(of_u), pieces.shape[2]))
        for start, end in pairwise(at_u.ends):
            found[start:end] = of_u[start:end] @ pieces[at_u.pieces[start]]
        return found.reshape(len(of_u), d, -1).transpose(0, 2, 1)

    def _along(self, v: FloatArray, dv: int) -> FloatArray:
        """Return Bezier points along u at each v, of a derivative by v: shape (U, p + 1, d x len(v))."""
        key = v.tobytes(), dv
        if key not in self.sections:
            if any(known != key[0] for known, _ in self.sections):
                self.sections.clear()
            at_v = self._places(1, v)
            along = np.einsum("vj,vjx->vx", at_v.basis(dv), self.points[at_v.pieces])
            # Components apart, and each in one piece: what is done with them is then done fast.
            apart = along.reshape(len(v), -1, self.columns).transpose(1, 2, 0)
            self.sections[key] = apart.reshape(-1, self.degree_u + 1, self.columns * len(v))
        return self.sections[key]

    def _euclidean(self, kind: str, values: _Values, u: ArrayLike, v: ArrayLike, order: tuple[int, int]) -> FloatArray:
        u, v = np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64)
        if self.columns == 3:
            return values(u, v, *order)
        key = kind, u.tobytes(), v.tobytes()
        if key not in self.quotients:
            self.quotients.clear()
            self.quotients[key] = _Quotients(lambda du, dv: values(u, v, du, dv))
        found = self.quotients[key].derivative(*order)
        return found + self.origin if order == (0, 0) else found

    def _places(self, axis: int, x: ArrayLike) -> _Places:
        x = np.asarray(x, dtype=np.float64)
        key = axis, x.tobytes()
        if key not in self.known:
            degree = self.degree_u if axis == 0 else self.points.shape[1] - 1
            self.known[key] = _Places.of(x, self.breakpoints[axis], degree)
        return self.known[key]


@dataclass(frozen=True, eq=False)
class _Quotients:
    """Taylor coefficients of S = X / w on one set of parameters: of each order once, from X / w(0) and w / w(0).

    Of a product these are sums of products, without binomials.
    """

    homogeneous: Callable[[int, int], FloatArray]
    weights: dict[tuple[int, int], FloatArray] = field(default_factory=dict)
    known: dict[tuple[int, int], FloatArray] = field(default_factory=dict)

    def derivative(self, du: int, dv: int) -> FloatArray:
        """Return the derivative of an order, shape (..., 3); each component lies in one piece."""
        value, factor = self._coefficient(du, dv), float(factorial(du) * factorial(dv))
        value = value if factor == 1 else factor * value
        return value.transpose(*range(1, value.ndim), 0)

    def _coefficient(self, du: int, dv: int) -> FloatArray:
        """Return the coefficient of an order, shape (3, ...)."""
        if (du, dv) not in self.known:
            # Those below first: their weights are needed.
            below = [(i, j, self._coefficient(du - i, dv - j)) for i in range(du + 1) for j in range(dv + 1) if i or j]
            raw = self.homogeneous(du, dv)
            raw = np.ascontiguousarray(raw.transpose(-1, *range(raw.ndim - 1)))
            if not below:
                self.weights[0, 0] = raw[3].copy()
            raw /= self.weights[0, 0] * float(factorial(du) * factorial(dv))
            if below:
                self.weights[du, dv] = raw[3]
            value, product = raw[:3], np.empty_like(raw[:3])
            for i, j, other in below:
                value -= np.multiply(self.weights[i, j], other, out=product)
            self.known[du, dv] = value
        return self.known[du, dv]


@dataclass(frozen=True, eq=False)
class _Places:
    """Parameters: their pieces, where another piece begins, how wide each is, and Bernstein polynomials by degree."""

    pieces: NDArray[np.intp]
    ends: list[int]
    widths: FloatArray
    values: list[FloatArray]
    known: dict[int, FloatArray] = field(default_factory=dict)

    @staticmethod
    def of(x: FloatArray, breaks: FloatArray, degree: int) -> _Places:
        at = np.searchsorted(breaks[1:-1], x, side="right")
        ends = [0, *(np.flatnonzero(at[1:] != at[:-1]) + 1).tolist(), len(x)]
        start = breaks[at]
        widths = (breaks[at + 1] - start)[:, None]
        return _Places(at, ends, widths, bernstein_by_degree(degree, (x - start) / widths[:, 0]))

    def basis(self, order: int) -> FloatArray:
        """Return what each Bezier point of the own piece has to do with a derivative, shape (len(x), degree + 1)."""
        if order not in self.known:
            degree = len(self.values) - 1
            if order > degree:
                self.known[order] = np.zeros_like(self.values[degree])
            else:
                self.known[order] = self.values[degree - order] @ _differences(degree, order) / self.widths**order
        return self.known[order]


def _counted_from(surface: Surface, origin: FloatArray) -> Surface:
    """Return a surface moved to an origin, which is exact."""
    if isinstance(surface, BSplineSurface):
        return replace(surface, control_points=surface.control_points - origin)
    curves = (replace(curve, control_points=curve.control_points - origin) for curve in surface.control_curves)
    return replace(surface, control_curves=tuple(curves))


@cache
def _elevation(degree: int, raised: int) -> FloatArray:
    """Return the matrix from Bezier points to those of a higher degree."""
    return np.asarray(elevation_matrix(degree, np.repeat([0.0, 1.0], degree + 1), raised).toarray())


@cache
def _differences(degree: int, order: int) -> FloatArray:
    """Return the matrix from Bezier points to those of a derivative, on a span of length 1."""
    return np.asarray(perm(degree, order) * np.diff(np.eye(degree + 1), n=order, axis=0))
