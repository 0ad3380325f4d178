"""Exact operations on whole surfaces: reversal, swapping, affine maps, knots, degree, splitting, bounds.

Every result is the same surface (or its image) in another form; nothing is approximated beyond rounding. Where rows of
a semi-structured surface are combined (elevation in u, knots in u, split_u), those knots of different rows that are
closer than 1e-12 of the v-domain become one: points move by no more than 1e-12 of the v-domain times the largest
v-derivative, and `merge_knots` reports such a change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, SparseMatrix, finite_array, real_array, require, space_points
from semispline.solver.errors import ControlPointError, InputError, KnotError
from semispline.solver.scalars import real_number
from semispline.solver.splines.curves import combined_curves, elevate_curve, insert_named, restrict_curve, reverse_curve
from semispline.solver.splines.evaluation import checked_weights, euclidean, homogeneous_points
from semispline.solver.splines.knots import affine_knots, reversed_knots
from semispline.solver.splines.refinement import (
    clamp_knots,
    combined,
    elevated_knots,
    elevation_matrix,
    piece_matrix,
    refinement_matrix,
    snapped,
    with_knots,
)
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface, named_row

S = TypeVar("S", BSplineSurface, SemiStructuredSurface)


def reverse_u(surface: S) -> S:
    """Return the surface run backwards in u over the same domain.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> reverse_u(square).evaluate([0.25], [0.5])
    array([[0.75, 0.5 , 0.  ]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    knots = reversed_knots(surface.knots_u)
    if isinstance(surface, SemiStructuredSurface):
        return SemiStructuredSurface(surface.degree_u, knots, surface.control_curves[::-1])
    weights = None if surface.weights is None else surface.weights[::-1]
    return replace(surface, knots_u=knots, control_points=surface.control_points[::-1], weights=weights)


def reverse_v(surface: S) -> S:
    """Return the surface run backwards in v over the same domain."""
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if isinstance(surface, SemiStructuredSurface):
        return replace(surface, control_curves=tuple(reverse_curve(c) for c in surface.control_curves))
    weights = None if surface.weights is None else surface.weights[:, ::-1]
    points = surface.control_points[:, ::-1]
    return replace(surface, knots_v=reversed_knots(surface.knots_v), control_points=points, weights=weights)


def swap_directions(surface: Surface) -> BSplineSurface:
    """Return the surface with u and v exchanged.

    Raises
    ------
    InputError
        A semi-structured surface: its curves run along v by definition.
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if isinstance(surface, SemiStructuredSurface):
        raise InputError(
            "surface: a semi-structured surface cannot exchange u and v, its control curves run along v; "
            "convert it first: swap_directions(surface.to_bspline())"
        )
    return BSplineSurface(
        surface.degree_v,
        surface.degree_u,
        surface.knots_v,
        surface.knots_u,
        surface.control_points.transpose(1, 0, 2),
        None if surface.weights is None else surface.weights.T,
    )


def map_domain(surface: S, u_range: tuple[float, float] | None = None, v_range: tuple[float, float] | None = None) -> S:
    """Return the surface over other parameter ranges, mapped affinely; the ends are hit exactly, None keeps a range.

    Raises
    ------
    InputError
        A range that is not finite and increasing.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> map_domain(square, v_range=(0, 10)).evaluate([0.5], [2.5])
    array([[0.5 , 0.25, 0.  ]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    to_u, to_v = _checked_range(u_range, "u_range"), _checked_range(v_range, "v_range")
    knots_u = surface.knots_u if to_u is None else affine_knots(surface.knots_u, *to_u)
    if isinstance(surface, SemiStructuredSurface):
        curves = surface.control_curves
        if to_v is not None:
            curves = tuple(replace(c, knots=affine_knots(c.knots, *to_v)) for c in curves)
        return SemiStructuredSurface(surface.degree_u, knots_u, curves)
    knots_v = surface.knots_v if to_v is None else affine_knots(surface.knots_v, *to_v)
    return replace(surface, knots_u=knots_u, knots_v=knots_v)


def _checked_range(given: tuple[float, float] | None, name: str) -> tuple[float, float] | None:
    if given is None:
        return None
    values = real_array(given, name, InputError).tolist()
    if not (isinstance(values, list) and len(values) == 2 and np.isfinite(values).all() and values[0] < values[1]):
        raise InputError(f"{name}: found {given!r}, expected two finite numbers in ascending order")
    return values[0], values[1]


def transform(surface: S, matrix: ArrayLike, translation: ArrayLike = (0.0, 0.0, 0.0)) -> S:
    """Return the image of the surface under x -> A x + t.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface, rational too
    matrix : array_like, shape (3, 3) or (4, 4)
        A, or [[A, t], [0, 0, 0, 1]].
    translation : array_like, shape (3,)
        t; added to that of a 4 x 4 matrix.

    Raises
    ------
    InputError
        Another shape, not finite, or a 4 x 4 matrix that is not affine.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> transform(square, np.eye(3), [0, 0, 5]).evaluate([0.5], [0.5])
    array([[0.5, 0.5, 5. ]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    a = finite_array(matrix, 2, "matrix", InputError)
    t = finite_array(translation, 1, "translation", InputError)
    if t.shape != (3,):
        raise InputError(f"translation: shape {t.shape}, expected (3,)")
    if a.shape == (4, 4):
        if a[3].tolist() != [0, 0, 0, 1]:
            raise InputError(f"matrix[3]: found {a[3].tolist()}, expected [0, 0, 0, 1] (an affine map)")
        a, t = a[:3, :3], t + a[:3, 3]
    elif a.shape != (3, 3):
        raise InputError(f"matrix: shape {a.shape}, expected (3, 3) or (4, 4)")
    if isinstance(surface, SemiStructuredSurface):
        moved = tuple(replace(c, control_points=c.control_points @ a.T + t) for c in surface.control_curves)
        return replace(surface, control_curves=moved)
    return replace(surface, control_points=surface.control_points @ a.T + t)


def bounding_box(surface: Surface) -> FloatArray:
    """Return the least and greatest coordinates of the control points, shape (2, 3).

    The surface lies inside (convex hull property; weights are positive).
    """
    points = all_control_points(surface)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def all_control_points(surface: Surface) -> FloatArray:
    """Return the control points in one array, shape (n_control_points, 3), row after row."""
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if isinstance(surface, SemiStructuredSurface):
        return np.concatenate([c.control_points for c in surface.control_curves])
    return surface.control_points.reshape(-1, 3)


def elevate_degree(surface: S, degree_u: int | None = None, degree_v: int | None = None) -> S:
    """Return the same surface with higher degrees; None keeps one.

    Exact for inner knots of any multiplicity, and for rational surfaces. In a semi-structured surface each v-control
    curve is raised to `degree_v`; `degree_u` combines rows, whose knots within 1e-12 of the v-domain become one.

    Raises
    ------
    KnotError
        A degree below the present one.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> elevate_degree(square, degree_v=3).control_points[0, :, 1]
    array([0.        , 0.33333333, 0.66666667, 1.        ])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if degree_u is not None and degree_u != surface.degree_u:
        matrix = elevation_matrix(surface.degree_u, surface.knots_u, degree_u)
        surface = with_u(surface, degree_u, elevated_knots(surface.knots_u, degree_u - surface.degree_u), matrix)
    if degree_v is None:
        return surface
    if isinstance(surface, SemiStructuredSurface):
        return each_curve(surface, partial(elevate_curve, degree=degree_v))
    matrix = elevation_matrix(surface.degree_v, surface.knots_v, degree_v)
    return with_v(surface, degree_v, elevated_knots(surface.knots_v, degree_v - surface.degree_v), matrix)


def insert_knots(surface: S, knots_u: ArrayLike = (), knots_v: ArrayLike = ()) -> S:
    """Return the same surface with knots inserted; a knot is repeated to insert it several times.

    A value within 1e-12 of the domain of a knot means that knot. In a semi-structured surface `knots_v` go into every
    curve (`insert_curve_knots` and `SemiStructuredSurface.insert_knot` change one alone); `knots_u` combine rows, whose
    knots within 1e-12 of the v-domain become one.

    Raises
    ------
    KnotError
        A knot outside the domain, or a multiplicity above the degree.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> insert_knots(square, knots_v=[0.25]).control_points[0]
    array([[0.  , 0.  , 0.  ],
           [0.  , 0.25, 0.  ],
           [0.  , 1.  , 0.  ]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    more = finite_array(knots_u, 1, "knots_u", KnotError)
    if len(more):
        refined = with_knots(surface.degree_u, surface.knots_u, more, "knots_u")
        matrix = refinement_matrix(surface.degree_u, surface.knots_u, refined)
        surface = with_u(surface, surface.degree_u, refined, matrix)
    more = finite_array(knots_v, 1, "knots_v", KnotError)
    if not len(more):
        return surface
    if isinstance(surface, SemiStructuredSurface):
        return each_curve(surface, partial(insert_named, more=more, name="knots_v"))
    refined = with_knots(surface.degree_v, surface.knots_v, more, "knots_v")
    matrix = refinement_matrix(surface.degree_v, surface.knots_v, refined)
    return with_v(surface, surface.degree_v, refined, matrix)


def split_u(surface: S, u: float) -> tuple[S, S]:
    """Return the two pieces below and above u, each over its own part of the domain.

    A value within 1e-12 of the domain of a knot means that knot. Rows of a semi-structured surface are combined; their
    knots within 1e-12 of the v-domain become one.

    Raises
    ------
    KnotError
        A value that is not inside the domain.
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    at = snapped(real_number(u, "u", KnotError), surface.knots_u)
    start, end = surface.domain[0]
    return restrict_u(surface, start, at), restrict_u(surface, at, end)


def split_v(surface: S, v: float) -> tuple[S, S]:
    """Return the two pieces below and above v, as `split_u`.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> [piece.domain[1] for piece in split_v(square, 0.25)]
    [(0.0, 0.25), (0.25, 1.0)]
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    value = real_number(v, "v", KnotError)
    start, end = surface.domain[1]
    if isinstance(surface, SemiStructuredSurface):
        knots = np.unique(np.concatenate([c.knots for c in surface.control_curves]))
        at = snapped(value, knots)
        return restrict_v(surface, start, at), restrict_v(surface, at, end)
    at = snapped(value, surface.knots_v)
    return restrict_v(surface, start, at), restrict_v(surface, at, end)


def restrict_u(surface: S, start: float, end: float) -> S:
    """Return the surface over a range of u; its ends mean the knots within 1e-12 of the domain of them."""
    matrix, knots = piece_matrix(surface.degree_u, surface.knots_u, start, end)
    return with_u(surface, surface.degree_u, knots, matrix)


def restrict_v(surface: S, start: float, end: float) -> S:
    """Return the surface over a range of v; its ends mean the knots within 1e-12 of the domain of them."""
    if isinstance(surface, SemiStructuredSurface):
        return each_curve(surface, partial(restrict_curve, start=start, end=end))
    matrix, knots = piece_matrix(surface.degree_v, surface.knots_v, start, end)
    return with_v(surface, surface.degree_v, knots, matrix)


def each_curve(surface: SemiStructuredSurface, change: Callable[[BSplineCurve], BSplineCurve]) -> SemiStructuredSurface:
    """Return the surface with every v-control curve changed; an error names the curve."""
    curves = []
    for i, curve in enumerate(surface.control_curves):
        with named_row(i):
            curves.append(change(curve))
    return replace(surface, control_curves=tuple(curves))


def with_u(surface: S, degree: int, knots: FloatArray, matrix: SparseMatrix) -> S:
    """Return the surface whose rows are `matrix` times the old (homogeneous) rows."""
    if isinstance(surface, SemiStructuredSurface):
        return SemiStructuredSurface(degree, knots, combined_curves(surface.control_curves, matrix))
    net = combined(matrix, surface.homogeneous)
    return from_homogeneous(degree, surface.degree_v, knots, surface.knots_v, net)


def with_v(surface: BSplineSurface, degree: int, knots: FloatArray, matrix: SparseMatrix) -> BSplineSurface:
    """Return the surface whose columns are `matrix` times the old (homogeneous) columns."""
    net = combined(matrix, surface.homogeneous.transpose(1, 0, 2))
    return from_homogeneous(surface.degree_u, degree, surface.knots_u, knots, net.transpose(1, 0, 2))


def from_homogeneous(
    degree_u: int, degree_v: int, knots_u: FloatArray, knots_v: FloatArray, net: FloatArray
) -> BSplineSurface:
    """Return the surface with the control net (x, y, z) or (w x, w y, w z, w), shape (n_u, n_v, 3 or 4)."""
    return BSplineSurface(degree_u, degree_v, knots_u, knots_v, *euclidean(net))


def clamped_surface(
    degree_u: int,
    degree_v: int,
    knots_u: ArrayLike,
    knots_v: ArrayLike,
    control_points: ArrayLike,
    weights: ArrayLike | None = None,
) -> BSplineSurface:
    """Return the surface with unclamped or periodic knots over its domain, clamped by exact knot insertion.

    Parameters
    ----------
    degree_u, degree_v : int
    knots_u, knots_v : array_like, shapes (n_u + degree_u + 1,), (n_v + degree_v + 1,)
        Non-decreasing; the domain is [t_p, t_n]. What `clamp_knots` says of periodic splines holds here.
    control_points : array_like, shape (n_u, n_v, 3) or (n_u, n_v, 2)
        Euclidean; with two coordinates, in the plane z = 0.
    weights : array_like, shape (n_u, n_v), optional

    Examples
    --------
    >>> x, y = np.mgrid[0:2, 0:3]
    >>> surface = clamped_surface(1, 2, [0, 0, 1, 1], [0, 1, 2, 3, 4, 5], np.dstack([x, y, x]))
    >>> surface.knots_v, surface.control_points[0, :, 1]
    (array([2., 2., 2., 3., 3., 3.]), array([0.5, 1. , 1.5]))
    """
    net = space_points(control_points, 3, "control_points", ControlPointError)
    if weights is not None:
        net = homogeneous_points(net, checked_weights(weights, net, "weights"))
    new_u, net = clamp_knots(degree_u, knots_u, net)
    new_v, turned = clamp_knots(degree_v, knots_v, net.transpose(1, 0, 2))
    return from_homogeneous(degree_u, degree_v, new_u, new_v, turned.transpose(1, 0, 2))
