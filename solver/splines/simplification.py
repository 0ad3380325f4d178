"""Curves and surfaces with fewer knots or a lower degree, and a proven bound on what that changes.

Least squares on the control points of the finer form, the ends fixed; then both forms are brought to one space, where
the bound is read from their control points.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, SparseMatrix, finite_array, require
from semispline.solver.errors import ComputationError, ControlPointError, KnotError
from semispline.solver.scalars import whole_number
from semispline.solver.splines.approximation import Approximation, CurveApproximation
from semispline.solver.splines.coarsening import reduction_matrix, removal_matrix, without_knots
from semispline.solver.splines.deviation import deviation_bound
from semispline.solver.splines.evaluation import euclidean
from semispline.solver.splines.knots import inner_knots
from semispline.solver.splines.operations import each_curve, with_u, with_v
from semispline.solver.splines.refinement import (
    combined,
    elevated_knots,
    elevation_matrix,
    refinement_matrix,
    snapped,
)
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface

# Roundings of the largest coordinate that are added to a bound.
ROUNDING = 16 * float(np.finfo(float).eps)
# Parts of a span that are bounded apart, as long as there are not more of them than the second number in all; narrower
# spans than this fraction of the domain are left whole.
_PARTS, _SPANS, _NARROW = 8, 64, 1e-6


S = TypeVar("S", BSplineSurface, SemiStructuredSurface)


def remove_curve_knots(curve: BSplineCurve, knots: ArrayLike) -> CurveApproximation:
    """Return the curve without some of its inner knots; one is repeated to take several copies of it away.

    Control points that the knots do not reach stay as they are, the ends always; the others come from a least squares
    fit (of homogeneous points, where the curve is rational).

    Parameters
    ----------
    curve : BSplineCurve
        Rational too.
    knots : array_like, shape (K,)
        One within 1e-12 of the domain of a knot means that knot.

    Raises
    ------
    KnotError
        A value that is no inner knot, or is one fewer times.
    ComputationError
        The fit has a weight that is not positive.

    Source: T. Lyche, K. Mørken, Knot removal for parametric B-spline curves and surfaces, 1987.

    Examples
    --------
    >>> corner = BSplineCurve(1, [0, 0, 0.5, 1, 1], [[0, 0, 0], [1, 2, 0], [2, 0, 0]])
    >>> found = remove_curve_knots(corner, [0.5])
    >>> found.curve.control_points, round(found.error, 12)
    (array([[0., 0., 0.],
           [2., 0., 0.]]), 2.0)
    """
    require(curve, "curve", BSplineCurve)
    less = finite_array(knots, 1, "knots", KnotError)
    with _positive_weights():
        simple = _without(curve, less)
    return CurveApproximation(simple, _deviation(_curve_net(curve), _curve_net(simple)))


def reduce_curve_degree(curve: BSplineCurve, degree: int) -> CurveApproximation:
    """Return the curve with a lower degree, its inner knots of the continuity that they had, where that can be.

    Parameters
    ----------
    curve : BSplineCurve
        Rational too.
    degree : int
        From 1 to the present one.

    Raises
    ------
    KnotError
        Another degree.
    ComputationError
        The fit has a weight that is not positive.

    Examples
    --------
    >>> parabola = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0, 0, 0], [1, 2, 0], [2, 0, 0]])
    >>> found = reduce_curve_degree(parabola, 1)
    >>> found.curve.control_points, round(found.error, 12)
    (array([[0., 0., 0.],
           [2., 0., 0.]]), 1.0)
    """
    require(curve, "curve", BSplineCurve)
    with _positive_weights():
        simple = _lower(curve, degree)
    return CurveApproximation(simple, _deviation(_curve_net(curve), _curve_net(simple)))


def remove_knots(surface: S, knots_u: ArrayLike = (), knots_v: ArrayLike = ()) -> Approximation[S]:
    """Return the surface without some of its inner knots, as `remove_curve_knots` does, row by row.

    In a semi-structured surface `knots_v` leave those curves that have them; `knots_u` combine rows, whose knots
    within 1e-12 of the v-domain become one.

    Raises
    ------
    KnotError
        A value that is no inner knot, or is one fewer times.
    ComputationError
        The fit has a weight that is not positive.

    Examples
    --------
    >>> roof = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1],
    ...     [[[0, 0, 0], [0, 1, 0]], [[1, 0, 2], [1, 1, 2]], [[2, 0, 0], [2, 1, 0]]])
    >>> found = remove_knots(roof, knots_u=[0.5])
    >>> found.surface.control_points.shape, round(found.error, 12)
    ((2, 2, 3), 2.0)
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    less_u, less_v = finite_array(knots_u, 1, "knots_u", KnotError), finite_array(knots_v, 1, "knots_v", KnotError)
    simple = surface
    with _positive_weights():
        if len(less_u):
            fewer = without_knots(surface.degree_u, surface.knots_u, less_u, "knots_u")
            simple = with_u(simple, surface.degree_u, fewer, removal_matrix(surface.degree_u, surface.knots_u, fewer))
        if len(less_v):
            if isinstance(simple, SemiStructuredSurface):
                simple = _without_from_rows(simple, less_v)
            else:
                fewer = without_knots(simple.degree_v, simple.knots_v, less_v, "knots_v")
                simple = with_v(simple, simple.degree_v, fewer, removal_matrix(simple.degree_v, simple.knots_v, fewer))
    return Approximation(simple, _deviation(_surface_net(surface), _surface_net(simple)))


def reduce_degree(surface: S, degree_u: int | None = None, degree_v: int | None = None) -> Approximation[S]:
    """Return the surface with lower degrees, as `reduce_curve_degree` does, row by row; None keeps one.

    In a semi-structured surface `degree_v` lowers the curves that are above it; `degree_u` combines rows, whose knots
    within 1e-12 of the v-domain become one.

    Raises
    ------
    KnotError
        A degree below 1, or above the present one.
    ComputationError
        The fit has a weight that is not positive.

    Examples
    --------
    >>> square = BSplineSurface(1, 2, [0, 0, 1, 1], [0, 0, 0, 1, 1, 1],
    ...     [[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 0], [1, 2, 0]]])
    >>> found = reduce_degree(square, degree_v=1)
    >>> found.surface.degree_v, found.error < 1e-14
    (1, True)
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    simple = surface
    with _positive_weights():
        if degree_u is not None:
            _check_degree(degree_u, "degree_u", surface.degree_u)
            matrix, knots = reduction_matrix(surface.degree_u, surface.knots_u, degree_u)
            simple = with_u(simple, degree_u, knots, matrix)
        if degree_v is not None:
            _check_degree(degree_v, "degree_v", surface.degree_v)
            if isinstance(simple, SemiStructuredSurface):
                simple = each_curve(simple, lambda c: c if c.degree <= degree_v else _lower(c, degree_v))
            else:
                matrix, knots = reduction_matrix(simple.degree_v, simple.knots_v, degree_v)
                simple = with_v(simple, degree_v, knots, matrix)
    return Approximation(simple, _deviation(_surface_net(surface), _surface_net(simple)))


def _without(curve: BSplineCurve, less: FloatArray) -> BSplineCurve:
    fewer = without_knots(curve.degree, curve.knots, less, "knots")
    return _changed(curve, curve.degree, fewer, removal_matrix(curve.degree, curve.knots, fewer))


def _without_from_rows(surface: SemiStructuredSurface, less: FloatArray) -> SemiStructuredSurface:
    own = [_own_knots(curve, less) for curve in surface.control_curves]
    for i, value in enumerate(less.tolist()):
        if not any(i in indices for indices in own):
            raise KnotError(f"knots_v[{i}]: found {value}, expected an inner knot of a v-control curve")
    rows = zip(surface.control_curves, own, strict=True)
    return replace(surface, control_curves=tuple(_without(curve, less[i]) if i else curve for curve, i in rows))


def _own_knots(curve: BSplineCurve, less: FloatArray) -> list[int]:
    """Return the indices of those of the knots that the curve has, as often as it has them."""
    left, indices = inner_knots(curve.knots, curve.degree).tolist(), []
    for i, value in enumerate(less.tolist()):
        at = snapped(value, curve.knots)
        if at in left:
            left.remove(at)
            indices.append(i)
    return indices


def _lower(curve: BSplineCurve, degree: int) -> BSplineCurve:
    _check_degree(degree, "degree", curve.degree)
    matrix, knots = reduction_matrix(curve.degree, curve.knots, degree)
    return _changed(curve, degree, knots, matrix)


def _check_degree(degree: int, name: str, present: int) -> None:
    if whole_number(degree, name, 1, KnotError) > present:
        raise KnotError(f"{name}: found {degree}, expected at most the present degree {present}")


def _changed(curve: BSplineCurve, degree: int, knots: FloatArray, matrix: SparseMatrix) -> BSplineCurve:
    points, weights = euclidean(combined(matrix, curve.homogeneous))
    return replace(curve, degree=degree, knots=knots, control_points=points, weights=weights)


@contextmanager
def _positive_weights() -> Iterator[None]:
    """Say of a fit whose weights are not positive that it is the fit that failed."""
    try:
        yield
    except ControlPointError as error:
        raise ComputationError(f"{error}: the spline cannot do without what is to be removed; remove less") from None


@dataclass(frozen=True, eq=False)
class _Net:
    """A spline in one or two parameters: degrees, knots, and homogeneous net, shape (n_1, .., 3 or 4)."""

    degrees: tuple[int, ...]
    knots: tuple[FloatArray, ...]
    points: FloatArray


def _curve_net(curve: BSplineCurve) -> _Net:
    return _Net((curve.degree,), (curve.knots,), curve.homogeneous)


def _surface_net(surface: Surface) -> _Net:
    plain = surface.to_bspline() if isinstance(surface, SemiStructuredSurface) else surface
    return _Net((plain.degree_u, plain.degree_v), (plain.knots_u, plain.knots_v), plain.homogeneous)


def _deviation(one: _Net, other: _Net) -> float:
    """Bound the distance between two splines over one domain, rounding and all."""
    spaces = [_common_space(*form) for form in zip(one.degrees, one.knots, other.degrees, other.knots, strict=True)]
    nets = []
    for net in (one, other):
        points = net.points
        for axis, (degree, knots) in enumerate(spaces):
            p, own = net.degrees[axis], net.knots[axis]
            raised = elevated_knots(own, degree - p)
            matrix = refinement_matrix(degree, raised, knots) @ elevation_matrix(p, own, degree)
            points = np.moveaxis(combined(matrix, np.moveaxis(points, axis, 0)), 0, axis)
        nets.append(points)
    largest = max(float(np.abs(euclidean(net.points)[0]).max()) for net in (one, other))
    return deviation_bound([degree for degree, _ in spaces], *nets) + ROUNDING * largest


def _common_space(p: int, knots: FloatArray, q: int, others: FloatArray) -> tuple[int, FloatArray]:
    """Return the degree and knots of a space that has both; knots are the same where they are equal.

    Its spans are parts of those of the least one: the finer a net, the closer to the truth what bounds it.
    """
    degree = max(p, q)
    counts: dict[float, int] = {}
    for vector in (elevated_knots(knots, degree - p), elevated_knots(others, degree - q)):
        for value, times in zip(*(x.tolist() for x in np.unique(vector, return_counts=True)), strict=True):
            counts[value] = max(times, counts.get(value, 0))
    breaks = np.array(sorted(counts))
    parts = int(np.clip(_SPANS // (len(breaks) - 1), 1, _PARTS))
    widths = np.diff(breaks)
    starts, widths = (x[widths > _NARROW * np.ptp(breaks)] for x in (breaks[:-1], widths))
    inside = starts[:, None] + widths[:, None] * np.arange(1, parts) / parts
    return degree, np.sort(np.append(np.repeat(breaks, [counts[value] for value in sorted(counts)]), inside))
