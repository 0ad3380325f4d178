"""The two surface classes: the classical B-spline surface, and the semi-structured one of the paper.

Values are frozen dataclasses over read-only arrays, checked when they are made. Evaluation is sparse basis matrices
times (derivative) control points; it is right-continuous at inner knots and left-continuous at the end of the domain.
The classes evaluate themselves and turn into each other; whatever makes another curve or surface is a function of a
module above.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, SparseMatrix, finite_array, rebuilt
from semispline.solver.errors import ControlPointError, InputError
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.evaluation import (
    check_orders,
    checked_parameters,
    domain_of,
    local_basis,
    point_parameters,
    quotient,
)
from semispline.solver.splines.knots import (
    basis_matrix,
    breakpoints,
    checked_knots,
    derivative_points,
    merge_breakpoints,
)


@final
@dataclass(frozen=True, eq=False)
class BSplineCurve:
    """A clamped B-spline curve P_i(v): one v-control curve of a semi-structured surface.

    Parameters
    ----------
    degree : int
    knots : array_like, shape (n_i + degree + 2,)
        V_i, clamped.
    control_points : array_like, shape (n_i + 1, 3)
    name : str
        How messages call this curve.

    Raises
    ------
    KnotError, ControlPointError
        Naming the index at fault.

    Examples
    --------
    >>> BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [2, 0, 0]]).evaluate([0.25])
    array([[0.5, 0. , 0. ]])
    """

    degree: int
    knots: FloatArray
    control_points: FloatArray
    name: str = field(default="curve", repr=False)

    def __post_init__(self) -> None:
        points = finite_array(self.control_points, 2, f"{self.name}.control_points", ControlPointError)
        _check_points(points, f"{self.name}.control_points")
        object.__setattr__(self, "control_points", points)
        knots = checked_knots(self.knots, self.degree, len(points), f"{self.name}.knots")
        object.__setattr__(self, "knots", knots)
        object.__setattr__(self, "degree", int(self.degree))

    def __reduce__(self) -> tuple[Any, ...]:
        return rebuilt(self)

    def evaluate(self, v: ArrayLike, derivative: int = 0) -> FloatArray:
        """Evaluate the curve or a derivative at v, shape (K,); returns shape (K, 3)."""
        check_orders(derivative=derivative)
        x = checked_parameters(v, self.knots, "v")
        if derivative > self.degree:
            return np.zeros((len(x), 3))
        points = derivative_points(self.degree, self.knots, self.control_points, derivative)
        knots = self.knots[derivative : len(self.knots) - derivative]
        return np.asarray(basis_matrix(self.degree - derivative, knots, x) @ points)


@final
@dataclass(frozen=True, eq=False)
class BSplineSurface:
    """A clamped tensor-product B-spline surface, rational where `weights` are given.

    Parameters
    ----------
    degree_u, degree_v : int
        p and q, at least 1.
    knots_u, knots_v : array_like, shapes (n_u + degree_u + 1,), (n_v + degree_v + 1,)
        Clamped; inner multiplicity at most the degree.
    control_points : array_like, shape (n_u, n_v, 3)
        Euclidean (not multiplied by the weights).
    weights : array_like, shape (n_u, n_v), optional
        Positive.

    Raises
    ------
    KnotError, ControlPointError
        Naming the index at fault.

    Source: equation (7) of the paper.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> square.evaluate([0.25], [0.5])
    array([[0.25, 0.5 , 0.  ]])
    """

    degree_u: int
    degree_v: int
    knots_u: FloatArray
    knots_v: FloatArray
    control_points: FloatArray
    weights: FloatArray | None = None

    def __post_init__(self) -> None:
        points = finite_array(self.control_points, 3, "control_points", ControlPointError)
        _check_points(points, "control_points")
        object.__setattr__(self, "control_points", points)
        object.__setattr__(self, "knots_u", checked_knots(self.knots_u, self.degree_u, points.shape[0], "knots_u"))
        object.__setattr__(self, "knots_v", checked_knots(self.knots_v, self.degree_v, points.shape[1], "knots_v"))
        for name in ("degree_u", "degree_v"):
            object.__setattr__(self, name, int(getattr(self, name)))
        if self.weights is not None:
            weights = finite_array(self.weights, 2, "weights", ControlPointError)
            if weights.shape != points.shape[:2]:
                raise ControlPointError(f"weights: shape {weights.shape}, expected {points.shape[:2]}")
            if (weights <= 0).any():
                i, j = np.argwhere(weights <= 0)[0].tolist()
                raise ControlPointError(f"weights[{i}, {j}]: found {weights[i, j]}, expected a positive number")
            object.__setattr__(self, "weights", weights)

    def __reduce__(self) -> tuple[Any, ...]:
        return rebuilt(self)

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""
        return domain_of(self.knots_u), domain_of(self.knots_v)

    @property
    def breakpoints(self) -> tuple[FloatArray, FloatArray]:
        """The ends of the spans in u and in v."""
        return breakpoints(self.knots_u), breakpoints(self.knots_v)

    @property
    def n_control_points(self) -> int:
        """Number of control points."""
        return int(np.prod(self.control_points.shape[:2]))

    @cached_property
    def homogeneous(self) -> FloatArray:
        """Control net, shape (n_u, n_v, 3), or (n_u, n_v, 4) with (w x, w y, w z, w) where rational."""
        if self.weights is None:
            return self.control_points
        w = self.weights[..., None]
        net = np.concatenate([self.control_points * w, w], axis=2)
        net.setflags(write=False)
        return net

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate the surface or a mixed derivative at the points (u[k], v[k]); returns shape (K, 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = point_parameters(u, v, self.knots_u, self.knots_v)

        def net(a: int, b: int) -> FloatArray:
            if a > self.degree_u or b > self.degree_v:
                return np.zeros((len(uu), self.homogeneous.shape[2]))
            points, ku, kv = self._derivative_net(a, b)
            bu, iu = local_basis(self.degree_u - a, ku, uu)
            bv, iv = local_basis(self.degree_v - b, kv, vv)
            local = points[iu[:, :, None], iv[:, None, :]]
            return np.asarray(np.einsum("kij,kijd->kd", bu[:, :, None] * bv[:, None, :], local))

        return quotient(net, du, dv) if self.weights is not None else net(du, dv)

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate on the grid u x v; returns shape (len(u), len(v), 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = checked_parameters(u, self.knots_u, "u"), checked_parameters(v, self.knots_v, "v")

        def net(a: int, b: int) -> FloatArray:
            d = self.homogeneous.shape[2]
            if a > self.degree_u or b > self.degree_v:
                return np.zeros((len(uu), len(vv), d))
            points, ku, kv = self._derivative_net(a, b)
            # v first: what is turned is then small, and the last product already has the order of the result.
            n_u, n_v = points.shape[:2]
            along = basis_matrix(self.degree_v - b, kv, vv) @ points.transpose(1, 0, 2).reshape(n_v, n_u * d)
            turned = along.reshape(len(vv), n_u, d).transpose(1, 0, 2).reshape(n_u, len(vv) * d)
            return np.asarray((basis_matrix(self.degree_u - a, ku, uu) @ turned).reshape(len(uu), len(vv), d))

        return quotient(net, du, dv) if self.weights is not None else net(du, dv)

    def to_semistructured(self) -> SemiStructuredSurface:
        """Return the same surface with its rows as v-control curves; refused for rational surfaces."""
        if self.weights is not None:
            raise InputError("surface: rational, expected one without weights: v-control curves have none")
        curves = tuple(BSplineCurve(self.degree_v, self.knots_v, row) for row in self.control_points)
        return SemiStructuredSurface(self.degree_u, self.knots_u, curves)

    def _derivative_net(self, a: int, b: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        points = derivative_points(self.degree_u, self.knots_u, self.homogeneous, a)
        points = derivative_points(self.degree_v, self.knots_v, points.transpose(1, 0, 2), b).transpose(1, 0, 2)
        return points, self.knots_u[a : len(self.knots_u) - a], self.knots_v[b : len(self.knots_v) - b]


@final
@dataclass(frozen=True, eq=False)
class SemiStructuredSurface:
    """A semi-structured B-spline surface: v-control curves with knots (and degrees) of their own, skinned in u.

    Parameters
    ----------
    degree_u : int
    knots_u : array_like, shape (m + degree_u + 2,)
        U, clamped.
    control_curves : sequence of BSplineCurve, length m + 1
        P_i(v), all over one v-domain.

    Raises
    ------
    KnotError, ControlPointError
        Naming the curve at fault.

    Source: Definition 1 of the paper, widened: each curve may have its own degree.

    Examples
    --------
    >>> low = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
    >>> high = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 1], [1, 1, 0]])
    >>> SemiStructuredSurface(1, [0, 0, 1, 1], (low, high)).evaluate([0.5], [0.5])
    array([[0.5, 0.5, 0.5]])
    """

    degree_u: int
    knots_u: FloatArray
    control_curves: tuple[BSplineCurve, ...]

    def __post_init__(self) -> None:
        curves: object = self.control_curves
        if not isinstance(curves, Iterable):
            kind = type(curves).__name__
            raise ControlPointError(f"control_curves: found a {kind}, expected a sequence of BSplineCurve")
        object.__setattr__(self, "control_curves", tuple(self.control_curves))
        object.__setattr__(
            self, "knots_u", checked_knots(self.knots_u, self.degree_u, len(self.control_curves), "knots_u")
        )
        object.__setattr__(self, "degree_u", int(self.degree_u))
        for i, curve in enumerate(self.control_curves):
            if not isinstance(curve, BSplineCurve):
                raise ControlPointError(f"control_curves[{i}]: found a {type(curve).__name__}, expected a BSplineCurve")
            found, expected = domain_of(curve.knots), domain_of(self.control_curves[0].knots)
            if found != expected:
                raise ControlPointError(f"control_curves[{i}]: v-domain {found}, expected that of curve 0, {expected}")

    def __reduce__(self) -> tuple[Any, ...]:
        return rebuilt(self)

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""
        return domain_of(self.knots_u), domain_of(self.control_curves[0].knots)

    @property
    def breakpoints(self) -> tuple[FloatArray, FloatArray]:
        """The ends of the spans in u, and in v of all curves together."""
        along = (breakpoints(curve.knots) for curve in self.control_curves)
        return breakpoints(self.knots_u), merge_breakpoints(*along)

    @property
    def degree_v(self) -> int:
        """The highest degree among the v-control curves."""
        return max(curve.degree for curve in self.control_curves)

    @property
    def n_control_points(self) -> int:
        """Number of control points, over all curves."""
        return sum(len(curve.control_points) for curve in self.control_curves)

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate the surface or a mixed derivative at the points (u[k], v[k]); returns shape (K, 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = point_parameters(u, v, self.knots_u, self.control_curves[0].knots)
        if du > self.degree_u:
            return np.zeros((len(uu), 3))
        rows = self._rows(vv, dv, du)
        basis, index = local_basis(self.degree_u - du, self.knots_u[du : len(self.knots_u) - du], uu)
        local = rows[index, np.arange(len(uu))[:, None]]
        return np.asarray(np.einsum("ki,kid->kd", basis, local))

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate on the grid u x v; returns shape (len(u), len(v), 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = checked_parameters(u, self.knots_u, "u"), checked_parameters(v, self.control_curves[0].knots, "v")
        if du > self.degree_u:
            return np.zeros((len(uu), len(vv), 3))
        rows = self._rows(vv, dv, du)
        basis = basis_matrix(self.degree_u - du, self.knots_u[du : len(self.knots_u) - du], uu)
        return np.asarray((basis @ rows.reshape(len(rows), -1)).reshape(len(uu), len(vv), 3))

    def to_bspline(self) -> BSplineSurface:
        """Return the same surface with one v-knot vector, by exact degree elevation and knot insertion.

        Knots of different curves within 1e-12 of the v-domain are one; `merge_knots` makes more of them equal first,
        and says what that changes.

        Examples
        --------
        >>> low = BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [0, 1, 0]])
        >>> high = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[1, 0, 0], [1, 0.5, 1], [1, 1, 0]])
        >>> SemiStructuredSurface(1, [0, 0, 1, 1], (low, high)).to_bspline().knots_v
        array([0. , 0. , 0.5, 1. , 1. ])
        """
        same = compatible_curves(self.control_curves)
        return BSplineSurface(self.degree_u, same.degree, self.knots_u, same.knots, same.control_points)

    def _rows(self, v: FloatArray, dv: int, du: int) -> FloatArray:
        """Rows of the du-th u-derivative at each v, shape (m + 1 - du, len(v), 3)."""
        values = np.zeros((len(self.control_curves), len(v), 3))
        known: dict[tuple[int, bytes], SparseMatrix] = {}
        for row, curve in zip(values, self.control_curves, strict=True):
            if dv > curve.degree:
                continue
            form = curve.degree, curve.knots.tobytes()
            if form not in known:
                known[form] = basis_matrix(curve.degree - dv, curve.knots[dv : len(curve.knots) - dv], v)
            row[:] = known[form] @ derivative_points(curve.degree, curve.knots, curve.control_points, dv)
        return derivative_points(self.degree_u, self.knots_u, values, du)


@contextmanager
def named_row(i: int) -> Iterator[None]:
    """Put the name of a v-control curve before what is said against it."""
    try:
        yield
    except InputError as error:
        raise type(error)(f"control_curves[{i}]: {error}") from None


Surface: TypeAlias = BSplineSurface | SemiStructuredSurface


def _check_points(points: FloatArray, name: str) -> None:
    if points.shape[-1] != 3:
        raise ControlPointError(f"{name}: points have {points.shape[-1]} coordinate(s), expected 3")
