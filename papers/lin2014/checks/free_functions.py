"""What (11) loses where alpha, beta are numbers and p_2, q_2 zero, though (15) and (16) allow functions of v.

Rows next to the contacts are functions of v here, not splines over the base's knots: P_u = -p R_w and
P_uu = p^2 R_ww + p_2 R_w + q_2 R_v with p = alpha^2 at R, alike at S. The energy is then an integral over v of products
of their derivatives with the integrals over u of products of basis functions. q_1 stays zero: with it P_uu has a part
in R_vv, which has kinks at the inner knots of a cubic base.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from typing import Any, TypeAlias

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import least_squares

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import BlendResult
from semispline.solver.splines import gauss_rule

_DEGREE = 3
# p^2 R_ww has degree 9, and its square is integrated.
_INTEGRATED = 18
# A function of v with its first two derivatives (three, of a contact curve) at all points.
_Jet: TypeAlias = list[FloatArray]


def function_space(inner: Sequence[float]) -> FloatArray:
    """Return the knots of the cubic splines in v that stand for functions."""
    return np.concatenate([np.zeros(_DEGREE + 1), inner, np.ones(_DEGREE + 1)])


def greville(knots: FloatArray) -> FloatArray:
    """Return the control points of the function v itself, shape (n,)."""
    return np.array([knots[i + 1 : i + 1 + _DEGREE].mean() for i in range(len(knots) - _DEGREE - 1)])


@dataclass(frozen=True)
class _Side:
    """A contact: the three rows next to it, and what P, P_u and P_uu are made of there.

    `first` and `second` are the derivatives out of the base (-R_w, R_ww at R), all with their v-derivatives.
    """

    rows: tuple[int, int, int]
    least: float
    curve: _Jet
    first: _Jet
    second: _Jet


class FreeFunctions:
    """Least energies of the blends of one pair, with one middle curve, over functions of v in a space of splines.

    Parameters
    ----------
    result : BlendResult
        A bicubic G2 blend of least energy with constant alpha, beta and one middle curve, m = 6.
    knots : ndarray
        Of the functions.
    """

    def __init__(self, result: BlendResult, knots: FloatArray) -> None:
        curves = result.surface.control_curves
        alpha2, beta2 = result.alpha2, result.beta2
        if len(curves) != 7 or not (isinstance(alpha2, float) and isinstance(beta2, float)):
            raise ValueError(f"result: found {len(curves)} rows, alpha^2 {alpha2}, expected 7 and numbers")
        u = np.asarray(result.surface.knots_u, dtype=float)
        self._h = u[4], u[5]
        breaks = np.unique(np.concatenate([knots, *(c.knots for c in curves)]))
        v, weights = (x.T.ravel() for x in gauss_rule(breaks, _INTEGRATED))
        self._root_weights = np.sqrt(weights)[:, None]
        self._roots = [_root(u, order) for order in (2, 1, 0)]
        self._functions = _basis(knots, v)
        self._middle = _basis(np.asarray(curves[3].knots), v)
        rows: list[_Jet] = [
            [BSpline(c.knots, c.control_points, _DEGREE)(v, d) for d in range(_DEGREE + 1)] for c in curves
        ]
        self._sides = [self._side(rows, (0, 1, 2), alpha2), self._side(rows, (6, 5, 4), beta2)]

    def _side(self, rows: Sequence[_Jet], which: tuple[int, int, int], least: float) -> _Side:
        h_1, h_2 = self._h
        curve, one, two = (rows[i] for i in which)
        slopes = [(b - a) / h_1 for a, b in zip(curve, one, strict=True)][:3]
        bends = [((c - b) / h_2 - s) / h_1 for b, c, s in zip(one, two, slopes, strict=False)]
        return _Side(which, least, curve, [3 * s / least for s in slopes], [6 * b / least**2 for b in bends])

    def energy(self, shape: FloatArray, second: FloatArray | None = None, along: FloatArray | None = None) -> float:
        """Return the least energy (11) over alpha^2, beta^2, over p_2 and q_2 at both contacts, and the middle curve.

        Parameters
        ----------
        shape, second, along : ndarray, shape (n, s)
            Control points of s functions that span the choices of alpha^2 and beta^2, of p_2, of q_2; none for zero.

        Raises
        ------
        ValueError
            The least one has alpha^2 or beta^2 without a positive lower bound.
        """
        fixed = np.linalg.qr(np.column_stack([*self._of_middle(), *self._of_second_order(second, along)]))[0]
        constant = np.linalg.lstsq(shape, np.ones(len(shape)), rcond=None)[0]

        def rest(x: FloatArray) -> FloatArray:
            left = self._of_contacts([shape @ part for part in np.split(x, 2)])
            return left - fixed @ (fixed.T @ left)

        found = least_squares(rest, np.concatenate([side.least * constant for side in self._sides]))
        controls = np.concatenate([shape @ part for part in np.split(found.x, 2)])
        if controls.min() <= 0:
            raise ValueError(f"alpha^2, beta^2: found a control value {controls.min():.3g}, expected positive ones")
        return float(2 * found.cost)

    def _residuals(self, rows: dict[int, _Jet]) -> FloatArray:
        """Return numbers whose squares add up to the energy of some rows, the others zero."""
        parts = []
        for order, (root, factor) in enumerate(zip(self._roots, (1.0, 2.0, 1.0), strict=True)):
            value = sum(root[:, i, None, None] * jet[order] for i, jet in rows.items())
            parts.append((np.sqrt(factor) * self._root_weights * value).ravel())
        return np.concatenate(parts)

    def _of_middle(self) -> list[FloatArray]:
        return [
            self._residuals({3: [f[:, j, None] * axis for f in self._middle]})
            for j in range(self._middle[0].shape[1])
            for axis in np.eye(3)
        ]

    def _of_second_order(self, second: FloatArray | None, along: FloatArray | None) -> list[FloatArray]:
        h_1, h_2 = self._h
        found = []
        for side in self._sides:
            for controls, direction in ((second, side.first), (along, side.curve[1:])):
                for function in () if controls is None else controls.T:
                    jet = [h_1 * h_2 / 6 * x for x in _product(self._function(function), direction)]
                    found.append(self._residuals({side.rows[2]: jet}))
        return found

    def _of_contacts(self, shapes: Sequence[FloatArray]) -> FloatArray:
        h_1, h_2 = self._h
        rows: dict[int, _Jet] = {}
        for side, controls in zip(self._sides, shapes, strict=True):
            p = self._function(controls)
            first, second = _product(p, side.first), _product(_product(p, p), side.second)
            at, one, two = side.rows
            rows[at] = side.curve[:3]
            rows[one] = [c + h_1 / 3 * f for c, f in zip(rows[at], first, strict=True)]
            rows[two] = [c + h_2 * (f / 3 + h_1 / 6 * s) for c, f, s in zip(rows[one], first, second, strict=True)]
        return self._residuals(rows)

    def _function(self, controls: FloatArray) -> _Jet:
        return [f @ controls[:, None] for f in self._functions]


def _basis(knots: FloatArray, v: FloatArray) -> _Jet:
    whole: Any = BSpline(knots, np.eye(len(knots) - _DEGREE - 1), _DEGREE)
    return [whole(v, d) for d in range(3)]


def _product(f: _Jet, g: _Jet) -> _Jet:
    return [sum((comb(d, k) * f[k] * g[d - k] for k in range(d + 1)), np.zeros(())) for d in range(3)]


def _root(knots: FloatArray, order: int) -> FloatArray:
    """Return a root of the matrix of integrals over u of products of derivatives of one order."""
    u, weights = (x.T.ravel() for x in gauss_rule(np.unique(knots), 2 * _DEGREE))
    values = BSpline(knots, np.eye(len(knots) - _DEGREE - 1), _DEGREE)(u, order)
    factor: FloatArray = np.linalg.qr(np.sqrt(weights)[:, None] * values)[1]
    return factor
