"""Weights of a rational side that stay positive and tame over a whole window of alpha: a ladder of three rungs.

1. "mean": the representative of `weights`. Separable weights never need more.
2. "fitted": lambda(w, v) = 1 + sum_k lambda_k(v) w^k / k!, with splines fitted so that the weights have next to no
   derivatives across. The degree along rises by three.
3. "om^(n+1)": for contact of order n the weights of all rows are om^(n+1), om that of the edge, which is positive and
   knows nothing of alpha. The degree along is n + 1 times as high.

The blend that is built on any of them has the same contact with the base, exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Literal, TypeAlias

import numpy as np
import scipy.sparse as sp

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.closing import periodic_points
from semispline.solver.blending.weights import (
    end_derivatives,
    is_separable,
    normalised_rows,
    rows_from_derivatives,
    spline_mean,
)
from semispline.solver.generated import rows_numpy
from semispline.solver.splines import Basis, basis_matrix, breakpoints, clamped, multiply

RungName: TypeAlias = Literal["mean", "fitted", "om^(n+1)"]
# Weights of rows below this part of the least weight of the edge are not tame.
LEAST_SHARE = 0.1
# The highest degree that CAD kernels take.
MOST_DEGREE = 25
# lambda has to be smooth enough not to crease the blend, nor to make its curvature jump.
_FIT_DEGREE, _FIT_ORDER = 3, 2
_SAMPLES_PER_SPAN = 8
# Parts of each span for the fit; the later ones only where the last rung would pass `MOST_DEGREE`.
_PARTS, _MORE_PARTS = (2,), (4, 8, 16)


@dataclass(frozen=True)
class Window:
    """What alpha^2 and p2 may be: p2 = per_a alpha^2 + a number out of a range."""

    a: tuple[float, float]
    p2: tuple[float, float] = (0.0, 0.0)
    per_a: float = 0.0


@dataclass(frozen=True)
class Rung:
    """Which representative of a base a side is built on.

    Attributes
    ----------
    name : {"mean", "fitted", "om^(n+1)"}
    degree : int
        Along the edge.
    ratio : float
        Largest by least control weight of the side's rows, over the window of alpha; inf where one is not positive.
    """

    name: RungName
    degree: int
    ratio: float


@dataclass(frozen=True, eq=False)
class TameRows:
    """Rows of a side over a basis of their own.

    Attributes
    ----------
    rows : ndarray, shape (order + 1, n, 4)
    along : Basis
    degree : int
        Across; the distances to the next knots stay those of the base.
    rung : Rung
    """

    rows: FloatArray
    along: Basis
    degree: int
    rung: Rung


def tamed(
    rows: FloatArray,
    along: Basis,
    degree: int,
    spans: tuple[float, ...],
    *,
    order: int,
    blend_degree: int,
    blend_spans: tuple[float, ...],
    window: Window | None,
    closed: bool = False,
) -> TameRows:
    """Return rows of the lowest rung whose weights are positive over the whole window.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 4)
        Homogeneous control rows of the base, from the edge inwards; the weights of the edge are positive. For order 0
        there may be a second one.
    along : Basis
        Not elevated: the degree of the last rung is a multiple of it.
    degree : int
        Of the base, across.
    spans : tuple of float
        Distances from the edge to the next knots across.
    blend_degree : int
    blend_spans : tuple of float
        The same of the blend.
    window : Window or None
        None asks for weights that do not depend on alpha at all.
    closed : bool
        Whether the rows are closed along.

    Notes
    -----
    Where the last rung has a degree above 25, finer splines are fitted first; if they fail it is taken all the same,
    and its degree is in `rung`.
    """
    mean, mean_degree = normalised_rows(rows, along, degree, spans)

    def measured(name: RungName, found: FloatArray, basis: Basis, across: int) -> tuple[TameRows, bool]:
        weights = found[: order + 1, :, 3]
        if window is None:
            least, most = float(weights[0].min()), float(weights[0].max())
        else:
            least, most = weight_range(weights, across, spans, blend_degree, blend_spans, window)
        rung = Rung(name, basis.degree, most / least if least > 0 else np.inf)
        return TameRows(found, basis, across, rung), least >= LEAST_SHARE * mean[0, :, 3].min()

    result, tame = measured("mean", mean, along, mean_degree)
    constant = window is not None or is_separable(mean[: order + 1, :, 3])
    if (tame and constant) or order == 0:
        return result
    jets = np.einsum("dk,knc->dnc", end_derivatives(order, mean_degree, spans), mean)
    across = max(degree, order)
    back = rows_from_derivatives(order, across, spans)
    last_fits = (order + 1) * along.degree <= MOST_DEGREE
    tries = () if window is None else _PARTS if last_fits else _PARTS + _MORE_PARTS
    for parts in tries:
        found, basis = fitted_jets(jets, along, parts, closed=closed)
        result, tame = measured("fitted", np.einsum("kd,dnc->knc", back, found), basis, across)
        if tame:
            return result
    found, basis = power_jets(jets, along)
    found = np.einsum("kd,dnc->knc", back, found)
    # All rows have these weights: not one bit may depend on alpha.
    found[1:, :, 3] = found[0, :, 3]
    return measured("om^(n+1)", found, basis, across)[0]


def weight_range(
    weights: FloatArray,
    degree: int,
    spans: tuple[float, ...],
    blend_degree: int,
    blend_spans: tuple[float, ...],
    window: Window,
) -> tuple[float, float]:
    """Return bounds of all control weights that contact gives the blend's rows, over the whole window.

    Row k is a polynomial of degree k in alpha^2: its Bernstein coefficients over the window bound it. They are met
    where rows do not depend on alpha.

    Parameters
    ----------
    weights : ndarray, shape (order + 1, n)
        Of the base's rows, from the edge inwards.
    degree, spans, blend_degree, blend_spans, window
        As for `tamed`.
    """
    order = len(weights) - 1
    if order == 0:
        return float(weights.min()), float(weights.max())
    exponents = getattr(rows_numpy, f"chain_monomials_{order}")().astype(int)
    tables = getattr(rows_numpy, f"chain_table_{order}")().reshape(-1, order + 1, order + 1)
    from_derivatives = rows_from_derivatives(order, blend_degree, blend_spans)
    derivatives = end_derivatives(order, degree, spans)
    # Contact moves no row by what is the same in all of them.
    change = np.einsum("kd,mdj,ji,in->mkn", from_derivatives, tables, derivatives, weights - weights[0])
    powers = np.zeros((order + 1, order + 1, *change.shape[1:]))
    for (i, j), part in zip(exponents.tolist(), change, strict=True):
        # a^i (per_a a + t)^j.
        for s in range(j + 1):
            powers[i + s, j - s] += comb(j, s) * window.per_a**s * part
    to_a, to_t = (_bernstein(order, *ends) for ends in (window.a, window.p2))
    coefficients = weights[0] + np.einsum("ai,tj,ijkn->atkn", to_a, to_t, powers)
    return float(coefficients.min()), float(coefficients.max())


def _bernstein(degree: int, low: float, high: float) -> FloatArray:
    """Return the matrix from powers 1, x, .. to Bernstein coefficients over [low, high]: blossoms of the powers."""
    matrix = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        # Elementary symmetric sums of k times `high` and degree - k times `low`.
        sums = np.poly([-low] * (degree - k) + [-high] * k)
        matrix[k] = [sums[i] / comb(degree, i) for i in range(degree + 1)]
    return matrix


def fitted_jets(jets: FloatArray, along: Basis, parts: int, *, closed: bool) -> tuple[FloatArray, Basis]:
    """Return derivatives across of lambda (X, om), with lambda fitted so that the weights have next to none.

    Parameters
    ----------
    jets : ndarray, shape (order + 1, n, 4)
        Derivatives across of order 0..order at the edge, control points along.
    along : Basis
    parts : int
        Into how many each span of the base is cut for lambda.
    closed : bool
        lambda is then as smooth across the seam as elsewhere.
    """
    order = len(jets) - 1
    breaks = breakpoints(along.knots)
    shares = np.arange(1, parts) / parts
    inner = np.unique(np.concatenate([breaks[1:-1], (breaks[:-1, None] + np.diff(breaks)[:, None] * shares).ravel()]))
    fit = Basis(_FIT_DEGREE, clamped(inner, _FIT_DEGREE, breaks[0], breaks[-1]))
    finest = np.concatenate([breaks[:1], inner, breaks[-1:]])
    within = (1 - np.cos(np.pi * (np.arange(_SAMPLES_PER_SPAN) + 0.5) / _SAMPLES_PER_SPAN)) / 2
    v = (finest[:-1, None] + np.diff(finest)[:, None] * within).ravel()
    weights = np.asarray([basis_matrix(along.degree, along.knots, v) @ row for row in jets[:, :, 3]])
    free = periodic_points(fit, _FIT_ORDER) if closed else sp.eye_array(fit.size, format="csr")
    design = basis_matrix(fit.degree, fit.knots, v) @ free
    factors, values = [np.ones(fit.size)], [np.ones(len(v))]
    for k in range(1, order + 1):
        wanted = -sum(comb(k, j) * values[k - j] * weights[j] for j in range(1, k + 1)) / weights[0]
        found = np.linalg.lstsq(design.toarray(), wanted, rcond=None)[0]
        factors.append(free @ found)
        values.append(design @ found)
    result = []
    for k in range(order + 1):
        products = [multiply(fit, factors[k - j][:, None], along, jets[j]) for j in range(k + 1)]
        basis = products[0][0]
        result.append(sum((comb(k, j) * points for j, (_, points) in enumerate(products)), 0.0))
    return np.stack(result), basis


def power_jets(jets: FloatArray, along: Basis) -> tuple[FloatArray, Basis]:
    """Return derivatives across of lambda (X, om), with lambda = om^n at the edge and no weights but at the edge.

    Source: with r_k the derivatives of X / om and n the order, those of order k are om^(n - k) N_k with
    N_k = om^(k + 1) r_k, N_0 = X, N_k = om^k X_k - sum_(j=1..k) binom(k, j) om_j om^(j - 1) N_(k - j). The mean of the
    weights is 1 at the edge.
    """
    order = len(jets) - 1
    weights, points = jets[:, :, 3:], jets[:, :, :3]
    powers = [(along, weights[0])]
    for _ in range(order):
        powers.append(multiply(*powers[-1], along, weights[0]))
    numerators = [(along, points[0])]
    for k in range(1, order + 1):
        basis, total = multiply(*powers[k - 1], along, points[k])
        for j in range(1, k + 1):
            change = (along, weights[j]) if j == 1 else multiply(*powers[j - 2], along, weights[j])
            total = total - comb(k, j) * multiply(*change, *numerators[k - j])[1]
        numerators.append((basis, total))
    raised = [multiply(*powers[order - k - 1], *numerators[k])[1] for k in range(order)] + [numerators[order][1]]
    basis, weight = powers[order]
    columns = [weight] + [np.zeros_like(weight)] * order
    found = np.stack([np.concatenate([x, w], axis=1) for x, w in zip(raised, columns, strict=True)])
    return found / spline_mean(basis, weight[:, 0]), basis
