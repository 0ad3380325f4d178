"""Any surface that can be evaluated with its derivatives, spline or not, and its local geometry."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.curvature import DEGENERATE, LocalGeometry, local_geometry, local_geometry_grid, symmetric
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface


class ParametricSurface(Protocol):
    """A surface over [0, 1] x the v-domain of a's edge: u = 0 on a, u = 1 on b. The spline classes are of this kind."""

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""

    @property
    def breakpoints(self) -> tuple[FloatArray, FloatArray]:
        """Between neighbouring ones the surface is smooth."""

    def evaluate(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the point or a derivative up to second order at (u[k], v[k]), shape (K, 3)."""

    def evaluate_grid(self, u: ArrayLike, v: ArrayLike, du: int = 0, dv: int = 0) -> FloatArray:
        """Return the same on the grid u x v, shape (len(u), len(v), 3)."""


def geometry(surface: ParametricSurface, u: FloatArray, v: FloatArray) -> LocalGeometry:
    """Return the local geometry at (u[k], v[k]) of a spline or another surface."""
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return local_geometry(surface, u, v)
    return _from_derivatives(*(surface.evaluate(u, v, *order) for order in _ORDERS))


def geometry_grid(surface: ParametricSurface, u: FloatArray, v: FloatArray) -> LocalGeometry:
    """Return the local geometry on the grid u x v of a spline or another surface."""
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return local_geometry_grid(surface, u, v)
    return _from_derivatives(*(surface.evaluate_grid(u, v, *order) for order in _ORDERS))


_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


def _from_derivatives(
    p: FloatArray, pu: FloatArray, pv: FloatArray, puu: FloatArray, puv: FloatArray, pvv: FloatArray
) -> LocalGeometry:
    cross = np.cross(pu, pv)
    area, product = (
        np.linalg.norm(cross, axis=-1),
        np.linalg.norm(pu, axis=-1) * np.linalg.norm(pv, axis=-1),
    )
    regular = area > DEGENERATE * np.maximum(product, np.finfo(np.float64).tiny)
    normal = np.where(regular[..., None], cross, np.nan) / np.where(regular, area, 1.0)[..., None]

    def dot(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.asarray(np.sum(a * b, axis=-1))

    first = symmetric(dot(pu, pu), dot(pu, pv), dot(pv, pv))
    second = symmetric(dot(puu, normal), dot(puv, normal), dot(pvv, normal))
    return LocalGeometry(p, pu, pv, normal, first, second, regular)
