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
from semispline.solver.judge.rounding import EdgeNoises


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
    at: Mapping[tuple[int, int], FloatArray],
    normal: FloatArray,
    section: SquareSection,
    noises: EdgeNoises,
    apart: tuple[FloatArray, FloatArray] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Bound what rounding may do to the normal (radians) and to the curvature, each of shape (K,).

    `apart` says how far first and second derivatives along the edge are from those of the other side, each of shape
    (K,): what both sides have alike, as of a contact curve in common, makes no difference between them.

    To first order, at the derivatives as they were rounded: of two sides the mean of both gradients, times their
    distance, is exact to second order, so where nothing bends or shears but by rounding no more is needed.

    Source: the gradients of n = X_w x X_s / |X_w x X_s| and of the second fundamental form along t, by each derivative.
    """
    w, s, r = 1 / section.a, section.y / section.a, 1 / section.g
    ws, ww, steep = w * s, w * w, np.abs(s)
    of, rows, along = noises.derivatives, noises.rows, noises.along
    of_s, of_ss = (of[0, 1], of[0, 2]) if apart is None else (np.minimum(of[0, k + 1], apart[k]) for k in (0, 1))
    of_w = of[1, 0] * w
    angle = np.hypot(of_w + of_s * steep, of_s * r)
    # The tangential part of the second derivative along t; k_tt and k_tT.
    c_t, c_along = _dot(section.second, section.direction) * ww * w, _dot(section.second, at[0, 1]) * ww * r
    k, twist = section.curvature, (_dot(at[1, 1], normal) + section.y * _dot(at[0, 2], normal)) * (w * r)
    # Errors along the normal: of second derivatives, and of first ones, which tilt it. One row of control points may
    # enter several, with either sign.
    height = np.abs(np.multiply.outer(rows[2], ww) - np.multiply.outer(rows[1], w * c_t)).sum(axis=0)
    slope = np.abs(np.multiply.outer(rows[1], 2 * ws) - np.multiply.outer(rows[0], s * c_t + r * c_along)).sum(axis=0)
    # Or each with what is left of it.
    separate = along[1] * np.abs(2 * ws) * np.abs(rows[1]).sum() + of_s * np.abs(s * c_t + r * c_along)
    tilted = height + np.minimum(along[1] * slope, separate) + of_ss * s * s
    # Those in the tangent plane turn and stretch the step along t.
    turned = 2 * (of_w * np.hypot(k, twist) + of_s * np.hypot(s * k + r * twist, s * twist))
    return angle, tilted + turned


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b))
