"""The section of a surface with the plane square to an edge: its curvature, and what rounding may do to it.

In the tangent plane t is the unit vector square to the edge and T the one along it. In the parameters, w across and s
along, the step (1 / a, y / a) goes along t and (0, 1 / g) along T. Second derivatives of the surface in two directions
have a normal part, the curvatures k_tt, k_tT and k_TT, and a tangential one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class SquareSection:
    """The section at samples along an edge; not a number where there is no normal.

    Attributes
    ----------
    y, a, g : ndarray, shape (K,)
        X_w + y X_s = a t, and X_s = g T.
    direction : ndarray, shape (K, 3)
        a t.
    second : ndarray, shape (K, 3)
        Second derivative of the surface along a t.
    curvature : ndarray, shape (K,)
        1/length.
    """

    y: FloatArray
    a: FloatArray
    g: FloatArray
    direction: FloatArray
    second: FloatArray
    curvature: FloatArray


def square_section(at: Mapping[tuple[int, int], FloatArray], normal: FloatArray) -> SquareSection:
    """Return the section from derivatives along an edge, keys (order across, order along), and unit normals."""
    x_w, x_s = at[1, 0], at[0, 1]
    along = np.where(np.isnan(normal[:, 0]), np.nan, _dot(x_s, x_s))
    y = -_dot(x_w, x_s) / along
    direction = x_w + y[:, None] * x_s
    second = at[2, 0] + 2 * y[:, None] * at[1, 1] + (y**2)[:, None] * at[0, 2]
    squared = _dot(direction, direction)
    return SquareSection(y, np.sqrt(squared), np.sqrt(along), direction, second, _dot(second, normal) / squared)


def section_noises(
    at: Mapping[tuple[int, int], FloatArray], normal: FloatArray, section: SquareSection, noises: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Bound what errors of the derivatives may do to the normal (radians) and to the curvature, each of shape (K,).

    Parameters
    ----------
    noises : ndarray, shape (3, 3) or more
        What rounding may do to each derivative: orders across in rows, along in columns.

    Source: the gradients of n = X_w x X_s / |X_w x X_s| and of the second fundamental form along t, by each derivative.
    """
    a, g = section.a, section.g
    w, s, r = 1 / a, section.y / a, 1 / g
    steep = np.abs(s)
    of_w, of_s = noises[1, 0] * w, noises[0, 1]
    angle = np.hypot(of_w + of_s * steep, of_s * r)
    # Second derivatives along t, and along t and T: their tangential parts, and k_tT.
    turn = (at[1, 1] + section.y[:, None] * at[0, 2]) * (w * r)[:, None]
    c_t, c_along = _dot(section.second, section.direction) * w**3, _dot(section.second, at[0, 1]) * w**2 * r
    k, twist = section.curvature, _dot(turn, normal)
    # An error of X_w or X_s along the normal tilts that; one in the tangent plane turns and stretches the step along t.
    slopes = of_w * _length(c_t, 2 * k, 2 * twist)
    slopes = slopes + of_s * _length(s * c_t + r * c_along, 2 * (s * k + r * twist), 2 * s * twist)
    direct = noises[2, 0] * w**2 + 2 * noises[1, 1] * w * steep + noises[0, 2] * s**2
    # Where nothing bends or shears all of this may vanish; then errors of errors count, beside curvatures that are none.
    frame = of_w + of_s * (steep + r)
    bends = np.linalg.norm(section.second, axis=1) * w**2 + 2 * np.linalg.norm(turn, axis=1)
    bends = bends + np.linalg.norm(at[0, 2], axis=1) * r**2
    twice = frame * (2 * r * (noises[1, 1] * w + noises[0, 2] * steep) + frame * bends)
    return angle, direct + slopes + twice


def _length(*parts: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(sum(part**2 for part in parts)))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b))
