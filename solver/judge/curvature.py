"""Normals, fundamental forms and curvatures of any surface.

Signs: the normal is P_u x P_v made a unit vector, and a curvature is positive where the surface bends towards its
normal; a sphere of radius r whose normal points outwards has mean curvature -1/r. Curvatures are in 1/length.

Degenerate points (P_u x P_v vanishes: a pole, a collapsed edge, a cusp) have no normal. There `regular` is False, and
the normal and every curvature are NaN, without a warning; `first_form` is still given. Nothing is replaced by a
neighbouring value.

Next to such points digits are lost, and `regular` does not say so. Where P_u has the fraction r of its size elsewhere
(a pole at distance r), its direction is known to some 1e-16 / r and curvatures to some 1e-16 / r^2 of themselves, or
1e-15 / r^2 for rational surfaces: on a sphere five digits remain at r = 1e-5, none at r = 3e-8.

Source: M. do Carmo, Differential Geometry of Curves and Surfaces, ch. 2 and 3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semispline.solver.arrays import FloatArray, finite_array, real_array, require
from semispline.solver.errors import InputError, OptionError
from semispline.solver.scalars import whole_number
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface, Surface, bounding_box

# A tangent shorter than this fraction of (extent of the surface / length of the parameter range), or an angle between
# the two tangents below it, counts as zero: some thousand times the rounding of a derivative.
DEGENERATE = 1e-12
# Principal curvatures closer than this fraction of the greater are one.
UMBILIC = 1e-10


@dataclass(frozen=True, eq=False)
class LocalGeometry:
    """First and second order geometry at parameter values; leading axes are (K,) or (len(u), len(v)).

    Attributes
    ----------
    point, tangent_u, tangent_v : ndarray, shape (..., 3)
        P, P_u, P_v.
    normal : ndarray, shape (..., 3)
        Unit; NaN where not regular.
    first_form : ndarray, shape (..., 2, 2)
        [[E, F], [F, G]].
    second_form : ndarray, shape (..., 2, 2)
        [[L, M], [M, N]]; NaN where not regular.
    regular : ndarray of bool, shape (...)
        Where there is a tangent plane.
    """

    point: FloatArray
    tangent_u: FloatArray
    tangent_v: FloatArray
    normal: FloatArray
    first_form: FloatArray
    second_form: FloatArray
    regular: NDArray[np.bool_]

    @property
    def gaussian(self) -> FloatArray:
        """Gaussian curvature (L N - M^2) / (E G - F^2), shape (...)."""
        s = self._orthonormal_form
        return np.asarray(s[..., 0, 0] * s[..., 1, 1] - s[..., 0, 1] ** 2)

    @property
    def mean(self) -> FloatArray:
        """Mean curvature, shape (...): half the sum of the principal ones."""
        s = self._orthonormal_form
        return np.asarray(0.5 * (s[..., 0, 0] + s[..., 1, 1]))

    @property
    def principal(self) -> FloatArray:
        """Principal curvatures, the greater first, shape (..., 2)."""
        s = self._orthonormal_form
        middle = 0.5 * (s[..., 0, 0] + s[..., 1, 1])
        radius = np.hypot(0.5 * (s[..., 0, 0] - s[..., 1, 1]), s[..., 0, 1])
        return np.stack([middle + radius, middle - radius], axis=-1)

    @property
    def principal_directions(self) -> FloatArray:
        """Unit tangent vectors of the principal curvatures, in their order, shape (..., 2, 3).

        At an umbilic point, where every direction is one, the first is that of P_u. A point is umbilic where the two
        curvatures differ by less than 1e-10 of the greater; next to degenerate points rounding may exceed that.
        """
        s = self._orthonormal_form
        twist, spread = 2 * s[..., 0, 1], s[..., 0, 0] - s[..., 1, 1]
        # Rounding alone must not choose a direction; NaN stays.
        umbilic = np.hypot(twist, spread) <= UMBILIC * np.abs(s).max(axis=(-2, -1))
        angle = np.where(umbilic, 0.0, 0.5 * np.arctan2(twist, spread))[..., None]
        e1, e2 = self._frame
        return np.stack([np.cos(angle) * e1 + np.sin(angle) * e2, np.cos(angle) * e2 - np.sin(angle) * e1], axis=-2)

    def normal_curvature(self, direction: ArrayLike) -> FloatArray:
        """Return the normal curvature along a direction, shape (...).

        Parameters
        ----------
        direction : array_like, shape (3,) or (..., 3)
            In space; only its part in the tangent plane counts, and not its length. `a * tangent_u + b * tangent_v` is
            the direction (a, b) of the parameters.

        Raises
        ------
        InputError
            Another shape, or a direction along the normal at a regular point.
        """
        d = finite_array(direction, None, "direction", InputError)
        e1, e2 = self._frame
        if d.shape not in ((3,), e1.shape):
            raise InputError(f"direction: shape {d.shape}, expected (3,) or {e1.shape}")
        x, y = (np.asarray(np.einsum("...d,...d->...", d, e)) for e in (e1, e2))
        length = np.hypot(x, y)
        if (length <= DEGENERATE * np.linalg.norm(d, axis=-1)).any():
            raise InputError("direction: has no part in the tangent plane, expected one that is not along the normal")
        s = self._orthonormal_form
        form = s[..., 0, 0] * x**2 + 2 * s[..., 0, 1] * x * y + s[..., 1, 1] * y**2
        return np.asarray(form / length**2)

    @property
    def _frame(self) -> tuple[FloatArray, FloatArray]:
        """Orthonormal tangents: e1 along P_u, e2 = n x e1; NaN where not regular."""
        along = np.where(self.regular[..., None], self.tangent_u, np.nan)
        e1 = along / np.linalg.norm(along, axis=-1, keepdims=True)
        return e1, np.cross(self.normal, e1)

    @property
    def _orthonormal_form(self) -> FloatArray:
        """The second form in the frame e1, e2: symmetric, shape (..., 2, 2).

        P_u = r11 e1 and P_v = r12 e1 + r22 e2, so no difference E G - F^2 is ever formed.
        """
        e1, e2 = self._frame
        r11 = np.linalg.norm(np.where(self.regular[..., None], self.tangent_u, np.nan), axis=-1)
        r12 = np.einsum("...d,...d->...", self.tangent_v, e1)
        r22 = np.einsum("...d,...d->...", self.tangent_v, e2)
        second = self.second_form
        s11 = second[..., 0, 0] / r11**2
        s12 = (second[..., 0, 1] / r11 - s11 * r12) / r22
        s22 = (second[..., 1, 1] - r12 * (2 * s12 * r22 + s11 * r12)) / r22**2
        return np.stack([np.stack([s11, s12], axis=-1), np.stack([s12, s22], axis=-1)], axis=-2)


def local_geometry(surface: Surface, u: ArrayLike, v: ArrayLike) -> LocalGeometry:
    """Return the local geometry at the points (u[k], v[k]); arrays lead with (K,).

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> saddle = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])
    >>> local_geometry(saddle, [0.0], [0.0]).gaussian
    array([-1.])
    """
    return _geometry(surface, lambda du, dv: surface.evaluate(u, v, du, dv))


def local_geometry_grid(surface: Surface, u: ArrayLike, v: ArrayLike) -> LocalGeometry:
    """Return the local geometry on the grid u x v; arrays lead with (len(u), len(v))."""
    return _geometry(surface, lambda du, dv: surface.evaluate_grid(u, v, du, dv))


def normals(surface: Surface, u: ArrayLike, v: ArrayLike) -> FloatArray:
    """Return unit normals at the points (u[k], v[k]), shape (K, 3); NaN where the surface is degenerate."""
    return local_geometry(surface, u, v).normal


def mean_curvature(surface: Surface, u: ArrayLike, v: ArrayLike) -> FloatArray:
    """Return the mean curvature at the points (u[k], v[k]), shape (K,); NaN where the surface is degenerate."""
    return local_geometry(surface, u, v).mean


def gaussian_curvature(surface: Surface, u: ArrayLike, v: ArrayLike) -> FloatArray:
    """Return the Gaussian curvature at the points (u[k], v[k]), shape (K,); NaN where the surface is degenerate."""
    return local_geometry(surface, u, v).gaussian


def principal_curvatures(surface: Surface, u: ArrayLike, v: ArrayLike) -> FloatArray:
    """Return both principal curvatures, the greater first, shape (K, 2); NaN where the surface is degenerate."""
    return local_geometry(surface, u, v).principal


def normal_curvature(surface: Surface, u: ArrayLike, v: ArrayLike, direction: ArrayLike) -> FloatArray:
    """Return the normal curvature along a direction in space, shape (K,); see `LocalGeometry.normal_curvature`."""
    return local_geometry(surface, u, v).normal_curvature(direction)


def isophote_angle(normal: ArrayLike, light: ArrayLike) -> FloatArray:
    """Return the angle between normals and the direction towards a light, in degrees, shape (...).

    Lines of equal angle are isophotes: they bend where the surface is only G1, and break where it is only G0.

    Examples
    --------
    >>> isophote_angle([[0, 0, 1], [0, 1, 0]], [0, 0, 2])
    array([ 0., 90.])
    """
    n, to_light = _vectors(normal, "normal"), _vectors(light, "light")
    if to_light.shape != (3,) or not to_light.any():
        raise InputError(f"light: found {to_light.tolist()}, expected one vector that is not zero")
    across = np.linalg.norm(np.cross(n, to_light), axis=-1)
    return np.asarray(np.degrees(np.arctan2(across, n @ to_light)))


def mirror_angle(normal: ArrayLike, towards_eye: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Return the angle between an axis and the ray from the eye mirrored in the surface, in degrees, shape (...).

    Parameters
    ----------
    normal : array_like, shape (..., 3)
        As in `LocalGeometry`; NaN where the normal is. Its sign does not matter.
    towards_eye : array_like, shape (3,) or (..., 3)
        From the surface to the eye: one direction for an eye far away, else one for each point. Any length.
    axis : array_like, shape (3,)

    Examples
    --------
    >>> mirror_angle([[0, 0, 1]], [1, 0, 1], [1, 0, 0])
    array([135.])
    """
    n, seen_from = _vectors(normal, "normal"), _vectors(towards_eye, "towards_eye")
    if seen_from.shape not in ((3,), n.shape):
        raise InputError(f"towards_eye: shape {seen_from.shape}, expected (3,) or that of normal, {n.shape}")
    if _vectors(axis, "axis").shape != (3,) or not np.any(axis):
        raise InputError(f"axis: found {np.asarray(axis).tolist()}, expected one vector that is not zero")
    return isophote_angle(2.0 * np.sum(n * seen_from, axis=-1)[..., None] * n - seen_from, axis)


def zebra(
    point: ArrayLike, normal: ArrayLike, eye: ArrayLike, stripes: int = 20, axis: ArrayLike = (0.0, 0.0, 1.0)
) -> FloatArray:
    """Return the zebra pattern that an eye sees mirrored in the surface: 1 on a light stripe, 0 on a dark one.

    The stripes are rings on a large sphere around an axis, `stripes` light ones and as many dark ones of equal width
    from pole to pole, a dark one at the pole where the axis points: the pattern of `mirror_angle`, and of the pictures.

    Parameters
    ----------
    point, normal : array_like, shape (..., 3)
        As in `LocalGeometry`; NaN where the normal is.
    eye : array_like, shape (3,)
        Position of the eye, in model units.
    stripes : int
    axis : array_like, shape (3,)
    """
    whole_number(stripes, "stripes", 1, OptionError)
    p, n, at = _vectors(point, "point"), _vectors(normal, "normal"), _vectors(eye, "eye")
    if at.shape != (3,) or p.shape != n.shape:
        raise InputError(f"point, normal, eye: shapes {p.shape}, {n.shape}, {at.shape}, expected (..., 3) twice, (3,)")
    turn = mirror_angle(n, at - p, axis) / 180.0
    light = (turn * stripes) % 1.0 >= 0.5
    return np.where(np.isnan(turn), np.nan, light.astype(np.float64))


def _geometry(surface: Surface, evaluate: Callable[[int, int], FloatArray]) -> LocalGeometry:
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)
    p, pu, pv = evaluate(0, 0), evaluate(1, 0), evaluate(0, 1)
    extent = float(np.ptp(bounding_box(surface), axis=0).max())
    least = [DEGENERATE * extent / (end - start) for start, end in surface.domain]
    cross = np.cross(pu, pv)
    area, long_u, long_v = (np.linalg.norm(x, axis=-1) for x in (cross, pu, pv))
    regular = (long_u > least[0]) & (long_v > least[1]) & (area > DEGENERATE * long_u * long_v)
    normal = np.where(regular[..., None], cross, np.nan) / np.where(regular, area, 1.0)[..., None]
    return LocalGeometry(
        point=p,
        tangent_u=pu,
        tangent_v=pv,
        normal=normal,
        first_form=symmetric(_dot(pu, pu), _dot(pu, pv), _dot(pv, pv)),
        second_form=symmetric(*(_dot(evaluate(*order), normal) for order in ((2, 0), (1, 1), (0, 2)))),
        regular=regular,
    )


def _vectors(values: ArrayLike, name: str) -> FloatArray:
    array = real_array(values, name, InputError)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError(f"{name}: shape {array.shape}, expected (3,) or (..., 3)")
    return array


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("...d,...d->...", a, b))


def symmetric(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return the matrices ((a, b), (b, c)), shape (..., 2, 2)."""
    return np.stack([np.stack([a, b], axis=-1), np.stack([b, c], axis=-1)], axis=-2)
