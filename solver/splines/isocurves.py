"""Curves of constant parameter, and the boundary, of a surface: exact, rational where the surface is."""

from __future__ import annotations

from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import InputError, OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.curves import combined_curves
from semispline.solver.splines.evaluation import checked_parameters, euclidean, same_width
from semispline.solver.splines.knots import basis_matrix
from semispline.solver.splines.refinement import combined
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface


def iso_curve(surface: Surface, u: float | None = None, v: float | None = None) -> BSplineCurve:
    """Return the curve of constant u, in the parameter v, or that of constant v, in the parameter u.

    Exact: the (homogeneous) control net combined with the basis functions at that parameter. The curve has the knots
    of the surface in its own direction; one of constant u of a semi-structured surface has the knots of the rows that
    act there. At a pole all its control points are one point.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Rational too: the curve then has weights.
    u, v : float
        One of them.

    Raises
    ------
    OptionError
        Both parameters given, or none.
    InputError
        A parameter outside the domain.

    Source: L. Piegl, W. Tiller, The NURBS Book, 1997, section 4.4.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 4]]])
    >>> iso_curve(square, u=0.5).control_points
    array([[0.5, 0. , 0. ],
           [0.5, 1. , 2. ]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if (u is None) == (v is None):
        raise OptionError(f"u, v: found u = {u}, v = {v}, expected one of them: that which is constant on the curve")
    if u is not None:
        at = checked_parameters([real_number(u, "u", InputError)], surface.knots_u, "u")
        matrix = basis_matrix(surface.degree_u, surface.knots_u, at).copy()
        matrix.eliminate_zeros()
        if isinstance(surface, SemiStructuredSurface):
            return combined_curves(surface.control_curves, matrix)[0]
        points = euclidean(combined(matrix, surface.homogeneous)[0])
        return BSplineCurve(surface.degree_v, surface.knots_v, *points)
    value = real_number(v, "v", InputError)
    if isinstance(surface, SemiStructuredSurface):
        net = np.stack(same_width(*(_homogeneous_point(curve, value) for curve in surface.control_curves)))
    else:
        matrix = basis_matrix(surface.degree_v, surface.knots_v, checked_parameters([value], surface.knots_v, "v"))
        net = combined(matrix, surface.homogeneous.transpose(1, 0, 2))[0]
    return BSplineCurve(surface.degree_u, surface.knots_u, *euclidean(net))


def boundary_curve(surface: Surface, edge: Literal["u0", "u1", "v0", "v1"]) -> BSplineCurve:
    """Return the boundary at the start or end of u or v as a curve.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Rational too: the curve then has weights.
    edge : {"u0", "u1", "v0", "v1"}
        Where u starts, where it ends (the curve runs along v); where v starts, where it ends (along u).

    Raises
    ------
    OptionError
        Another edge.

    Examples
    --------
    >>> square = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 4]]])
    >>> boundary_curve(square, "v1").control_points
    array([[0., 1., 0.],
           [1., 1., 4.]])
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    if edge not in ("u0", "u1", "v0", "v1"):
        raise OptionError(f"edge: found {edge!r}, expected 'u0', 'u1', 'v0' or 'v1'")
    along_u, along_v = surface.domain
    end = int(edge[1])
    return iso_curve(surface, u=along_u[end]) if edge[0] == "u" else iso_curve(surface, v=along_v[end])


def _homogeneous_point(curve: BSplineCurve, v: float) -> FloatArray:
    at = checked_parameters([v], curve.knots, "v")
    return np.asarray(combined(basis_matrix(curve.degree, curve.knots, at), curve.homogeneous)[0])
