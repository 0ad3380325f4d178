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

from semispline.solver.arrays import FloatArray, SparseMatrix, rebuilt, space_points
from semispline.solver.errors import ControlPointError, InputError
from semispline.solver.splines.compatible import compatible_curves
from semispline.solver.splines.evaluation import (
    check_orders,
    checked_parameters,
    checked_weights,
    domain_of,
    euclidean,
    homogeneous_points,
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
    """A clamped B-spline curve P_i(v), rational where `weights` are given: a v-control curve, say.

    Parameters
    ----------
    degree : int
    knots : array_like, shape (n_i + degree + 2,)
        V_i, clamped.
    control_points : array_like, shape (n_i + 1, 3) or (n_i + 1, 2)
        Euclidean (not multiplied by the weights); with two coordinates, in the plane z = 0.
    weights : array_like, shape (n_i + 1,), optional
        Positive.
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
    >>> quarter = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[1, 0, 0], [1, 1, 0], [0, 1, 0]], [1, 1, 2])
    >>> quarter.evaluate([0.5])
    array([[0.6, 0.8, 0. ]])
    """

    degree: int
    knots: FloatArray
    control_points: FloatArray
    weights: FloatArray | None = None
    name: str = field(default="curve", repr=False)

    def __post_init__(self) -> None:
        points = space_points(self.control_points, 2, f"{self.name}.control_points", ControlPointError)
        object.__setattr__(self, "control_points", points)
        knots = checked_knots(self.knots, self.degree, len(points), f"{self.name}.knots")
        object.__setattr__(self, "knots", knots)
        object.__setattr__(self, "degree", int(self.degree))
        if self.weights is not None:
            object.__setattr__(self, "weights", checked_weights(self.weights, points, f"{self.name}.weights"))

    def __reduce__(self) -> tuple[Any, ...]:
        return rebuilt(self)

    @cached_property
    def homogeneous(self) -> FloatArray:
        """Control points, shape (n_i + 1, 3), or (n_i + 1, 4) with (w x, w y, w z, w) where rational."""
        return homogeneous_points(self.control_points, self.weights)

    def evaluate(self, v: ArrayLike, derivative: int = 0) -> FloatArray:
        """Evaluate the curve or a derivative at v, shape (K,); returns shape (K, 3)."""
        check_orders(derivative=derivative)
        x = checked_parameters(v, self.knots, "v")

        def values(_: int, order: int) -> FloatArray:
            if order > self.degree:
                return np.zeros((len(x), self.homogeneous.shape[1]))
            points = derivative_points(self.degree, self.knots, self.homogeneous, order)
            knots = self.knots[order : len(self.knots) - order]
            return np.asarray(basis_matrix(self.degree - order, knots, x) @ points)

        return quotient(values, 0, derivative) if self.weights is not None else values(0, derivative)


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
    control_points : array_like, shape (n_u, n_v, 3) or (n_u, n_v, 2)
        Euclidean (not multiplied by the weights); with two coordinates, in the plane z = 0.
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
        points = space_points(self.control_points, 3, "control_points", ControlPointError)
        object.__setattr__(self, "control_points", points)
        object.__setattr__(self, "knots_u", checked_knots(self.knots_u, self.degree_u, points.shape[0], "knots_u"))
        object.__setattr__(self, "knots_v", checked_knots(self.knots_v, self.degree_v, points.shape[1], "knots_v"))
        for name in ("degree_u", "degree_v"):
            object.__setattr__(self, name, int(getattr(self, name)))
        if self.weights is not None:
            object.__setattr__(self, "weights", checked_weights(self.weights, points, "weights"))

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

    @property
    def is_rational(self) -> bool:
        """Whether there are weights, equal ones too."""
        return self.weights is not None

    @cached_property
    def homogeneous(self) -> FloatArray:
        """Control net, shape (n_u, n_v, 3), or (n_u, n_v, 4) with (w x, w y, w z, w) where rational."""
        return homogeneous_points(self.control_points, self.weights)

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
        """Return the same surface with its rows as v-control curves, weights and all."""
        weights = [None] * len(self.control_points) if self.weights is None else self.weights
        rows = zip(self.control_points, weights, strict=True)
        curves = tuple(BSplineCurve(self.degree_v, self.knots_v, row, own) for row, own in rows)
        return SemiStructuredSurface(self.degree_u, self.knots_u, curves)

    def _derivative_net(self, a: int, b: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        points = derivative_points(self.degree_u, self.knots_u, self.homogeneous, a)
        points = derivative_points(self.degree_v, self.knots_v, points.transpose(1, 0, 2), b).transpose(1, 0, 2)
        return points, self.knots_u[a : len(self.knots_u) - a], self.knots_v[b : len(self.knots_v) - b]


@final
@dataclass(frozen=True, eq=False)
class SemiStructuredSurface:
    """A semi-structured B-spline surface: v-control curves with knots (and degrees) of their own, skinned in u.

    Where a curve is rational the surface is the quotient of sum_i N_i(u) (w_i P_i, w_i)(v), with w_i the weight
    function of curve i, which is 1 for a curve without weights.

    Parameters
    ----------
    degree_u : int
    knots_u : array_like, shape (m + degree_u + 2,)
        U, clamped.
    control_curves : sequence of BSplineCurve, length m + 1
        P_i(v), all over one v-domain, each with weights of its own or none.

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

    @cached_property
    def is_rational(self) -> bool:
        """Whether any curve has weights, equal ones too."""
        return any(curve.weights is not None for curve in self.control_curves)

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate the surface or a mixed derivative at the points (u[k], v[k]); returns shape (K, 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = point_parameters(u, v, self.knots_u, self.control_curves[0].knots)
        rows = self._rows(vv, dv)

        def values(a: int, b: int) -> FloatArray:
            if a > self.degree_u:
                return np.zeros((len(uu), rows[b].shape[2]))
            basis, index = local_basis(self.degree_u - a, self.knots_u[a : len(self.knots_u) - a], uu)
            local = derivative_points(self.degree_u, self.knots_u, rows[b], a)[index, np.arange(len(uu))[:, None]]
            return np.asarray(np.einsum("ki,kid->kd", basis, local))

        return quotient(values, du, dv) if self.is_rational else values(du, dv)

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Evaluate on the grid u x v; returns shape (len(u), len(v), 3)."""
        check_orders(du=du, dv=dv)
        uu, vv = checked_parameters(u, self.knots_u, "u"), checked_parameters(v, self.control_curves[0].knots, "v")
        rows = self._rows(vv, dv)

        def values(a: int, b: int) -> FloatArray:
            if a > self.degree_u:
                return np.zeros((len(uu), len(vv), rows[b].shape[2]))
            across = derivative_points(self.degree_u, self.knots_u, rows[b], a)
            basis = basis_matrix(self.degree_u - a, self.knots_u[a : len(self.knots_u) - a], uu)
            return np.asarray((basis @ across.reshape(len(across), -1)).reshape(len(uu), len(vv), rows[b].shape[2]))

        return quotient(values, du, dv) if self.is_rational else values(du, dv)

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
        first = self.control_curves[0]
        if all(c.weights is not None and _same_space(c, first) for c in self.control_curves):
            # Multiplied by weights and divided again, points would round.
            points, weights = (
                np.stack([getattr(c, x) for c in self.control_curves]) for x in ("control_points", "weights")
            )
            return BSplineSurface(self.degree_u, first.degree, self.knots_u, first.knots, points, weights)
        same = compatible_curves(self.control_curves)
        return BSplineSurface(self.degree_u, same.degree, self.knots_u, same.knots, *euclidean(same.homogeneous))

    def _rows(self, v: FloatArray, dv: int) -> dict[int, FloatArray]:
        """Return the dv-th derivative of each (homogeneous) row at each v, shape (m + 1, len(v), 3 or 4).

        Of rational rows those of lower order too, for the quotient rule.
        """
        orders = range(dv + 1) if self.is_rational else (dv,)
        result = {b: np.zeros((len(self.control_curves), len(v), 4 if self.is_rational else 3)) for b in orders}
        for b, values in result.items():
            known: dict[tuple[int, bytes], SparseMatrix] = {}
            for row, curve in zip(values, self.control_curves, strict=True):
                if b > curve.degree:
                    continue
                form = curve.degree, curve.knots.tobytes()
                if form not in known:
                    known[form] = basis_matrix(curve.degree - b, curve.knots[b : len(curve.knots) - b], v)
                points = derivative_points(curve.degree, curve.knots, curve.homogeneous, b)
                if row.shape[1] > points.shape[1]:
                    row[:, :3] = known[form] @ points
                    row[:, 3] = b == 0
                else:
                    row[:] = known[form] @ points
        return result


@contextmanager
def named_row(i: int) -> Iterator[None]:
    """Put the name of a v-control curve before what is said against it."""
    try:
        yield
    except InputError as error:
        raise type(error)(f"control_curves[{i}]: {error}") from None


Surface: TypeAlias = BSplineSurface | SemiStructuredSurface


def _same_space(a: BSplineCurve, b: BSplineCurve) -> bool:
    return a.degree == b.degree and np.array_equal(a.knots, b.knots)
