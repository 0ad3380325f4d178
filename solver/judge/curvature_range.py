"""The least and the largest principal curvature of a surface, and where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.parametric import ParametricSurface, geometry_grid
from semispline.solver.judge.sections import just_inside, least_on_grid, no_tangent_plane, spread

# Samples in u and v altogether, and the least in each span.
_TOTAL, _LEAST = (40, 24), (4, 3)


@dataclass(frozen=True)
class CurvatureAt:
    """A principal curvature, in 1/length, with its parameters and its point."""

    value: float
    u: float
    v: float
    point: tuple[float, float, float]


@dataclass(frozen=True)
class CurvatureRange:
    """The least and the largest principal curvature; the normal that they refer to is that of P_u x P_v."""

    least: CurvatureAt
    largest: CurvatureAt


def measure_curvature_range(surface: ParametricSurface) -> CurvatureRange:
    """Return the least and the largest principal curvature over a surface, each with its place.

    Samples in every span and before every knot, then finer ones around the extremes. Points without a normal
    are passed over; next to them digits are lost.

    Raises
    ------
    InputError
        There is no tangent plane anywhere.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> saddle = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])
    >>> found = measure_curvature_range(saddle)
    >>> found.least.value, found.largest.value, found.least.point
    (-1.0, 1.0, (0.0, 0.0, 0.0))
    """
    u, v = (
        np.unique(np.concatenate([spread(breaks, total, least), just_inside(breaks)[1][:-1]]))
        for breaks, total, least in zip(surface.breakpoints, _TOTAL, _LEAST, strict=True)
    )

    # Both extremes begin on one grid.
    first = geometry_grid(surface, u, v).principal

    def extreme(column: int, sign: float) -> CurvatureAt:
        def values(at_u: FloatArray, at_v: FloatArray) -> FloatArray:
            found = first if at_u is u else geometry_grid(surface, at_u, at_v).principal
            return np.asarray(sign * found[..., column])

        value, at_u, at_v = least_on_grid(values, u, v)
        if not np.isfinite(value):
            raise no_tangent_plane()
        x, y, z = surface.evaluate_grid(np.array([at_u]), np.array([at_v]))[0, 0].tolist()
        return CurvatureAt(sign * value, at_u, at_v, (x, y, z))

    return CurvatureRange(extreme(1, 1.0), extreme(0, -1.0))
