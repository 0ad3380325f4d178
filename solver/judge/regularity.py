"""How far a surface is from being pinched: the area element over samples, and what can be proved of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray, SparseMatrix
from semispline.solver.judge.bezier_pieces import Part, bezier_matrix, in_pieces, parts_of
from semispline.solver.judge.sections import cross, lengths, spread
from semispline.solver.splines import Surface

# Samples in each span, and how many are held at once.
_PER_SPAN, _SAMPLES_AT_ONCE = 8, 2**17
# Into how many pieces each span of a rational surface is cut.
_OF_ARCS = 2


@dataclass(frozen=True)
class Regularity:
    """How far a surface is from being pinched; folds are what `measure_turn` finds.

    Attributes
    ----------
    least_area_ratio : float
        Least |P_u x P_v| over its mean; 0 where there is no normal.
    proved_area_ratio : float or None
        A lower bound of |P_u x P_v| over its mean, proved by Bernstein coefficients up to rounding; None where they
        prove nothing: then the surface may still be regular.
    """

    least_area_ratio: float
    proved_area_ratio: float | None


def measure_regularity(surface: Surface) -> Regularity:
    """Measure the area element on a grid of 8 samples in every span.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> measure_regularity(flat)
    Regularity(least_area_ratio=1.0, proved_area_ratio=1.0)
    """
    pieces = in_pieces(surface)
    u, v = (spread(breaks, 1, _PER_SPAN) for breaks in surface.breakpoints)
    least, largest, total = np.inf, 0.0, 0.0
    step = max(1, _SAMPLES_AT_ONCE // len(u))
    for at in range(0, len(v), step):
        some = v[at : at + step]
        normal = cross(pieces.evaluate_grid(u, some, 1, 0), pieces.evaluate_grid(u, some, 0, 1))
        area = lengths(normal)
        least, largest = min(least, float(area.min())), max(largest, float(area.max()))
        total += float(area.sum())
    if least <= 1e-14 * largest:
        return Regularity(0.0, None)
    mean, bound = total / (len(u) * len(v)), area_bound(surface)
    return Regularity(least / mean, bound / mean if bound > 0 else None)


def area_bound(surface: Surface) -> float:
    """Return a lower bound of |P_u x P_v|; not positive where nothing is proved.

    On each polynomial piece the bound is the least Bernstein coefficient of (P_u x P_v) . n, n its own mean normal. For
    a quotient P = X / w, P_u x P_v = (w X_u x X_v - w_v X_u x X - w_u X x X_v) / w^3: there it is that of the numerator
    over the cube of the largest coefficient of w.

    Source: range of a polynomial within its Bernstein coefficients; G. Farin, Curves and Surfaces for CAGD, ch. 6.
    """
    u_breaks = surface.breakpoints[0]
    cut = bezier_matrix(surface.degree_u, surface.knots_u, u_breaks)
    least = np.inf
    # Arcs may turn by half a round in one span, and their normals with them.
    for part in parts_of(surface, _OF_ARCS if surface.is_rational else 1):
        # Where nothing is proved in one part nothing is in all.
        least = min(least, _least_height(part, np.diff(u_breaks), cut))
        if not least > 0:
            break
    return least


def _applied(matrix: SparseMatrix, rows: FloatArray) -> FloatArray:
    """Return the combinations of rows, along axis 0."""
    return np.asarray((matrix @ rows.reshape(len(rows), -1)).reshape(-1, *rows.shape[1:]))


def _cross(a: FloatArray, b: FloatArray, axis: int) -> FloatArray:
    """Return the cross product of vectors along an axis that is not the last, which is long."""
    (x, y, z), (u, v, w) = (np.moveaxis(c, axis, 0) for c in (a, b))
    result = np.empty(np.broadcast_shapes(a.shape, b.shape))
    products = ((y, w, z, v), (z, u, x, w), (x, v, y, u))
    for component, (p, q, r, s) in zip(np.moveaxis(result, axis, 0), products, strict=True):
        np.multiply(p, q, out=component)
        np.subtract(component, r * s, out=component)
    return result


def _least_height(part: Part, u_widths: FloatArray, cut: SparseMatrix) -> float:
    """Return the least Bernstein coefficient of (P_u x P_v) . n over the pieces of a part; 0 if it proves nothing."""
    nets = _applied(cut, part.rows).reshape(len(u_widths), -1, *part.rows.shape[1:])
    # Pieces last, there are many: shape (p + 1, q + 1, 3, U, S).
    nets = np.ascontiguousarray(nets.transpose(1, 4, 2, 0, 3))
    p, q = (n - 1 for n in nets.shape[:2])
    if nets.shape[2] == 4:
        # About the middle of each piece, which is of its own size then.
        weights = nets[:, :, 3:]
        middle = (nets[:, :, :3] / weights).mean(axis=(0, 1))
        nets = np.concatenate([nets[:, :, :3] - weights * middle, weights], axis=2)
    by_u = p * np.diff(nets, axis=0) / u_widths[:, None]
    by_v = q * np.diff(nets, axis=1) / part.v_widths
    if nets.shape[2] == 4:
        cross = _numerator(nets, by_u, by_v) / nets[:, :, 3].max(axis=(0, 1)) ** 3
    else:
        cross = _bernstein_cross(by_u, by_v)
    normal = cross.mean(axis=(0, 1))
    length = np.sqrt(np.sum(normal**2, axis=0))
    if not length.min() > 0:
        return 0.0
    heights = sum(cross[:, :, d] * normal[d] for d in range(3))
    return float((heights / length).min())


def _numerator(nets: FloatArray, by_u: FloatArray, by_v: FloatArray) -> FloatArray:
    """Return the Bernstein coefficients of w X_u x X_v - w_v X_u x X - w_u X x X_v, from those of (X, w)."""
    (x, x_u, x_v), (w, w_u, w_v) = ([net[:, :, part] for net in (nets, by_u, by_v)] for part in (slice(3), slice(3, 4)))
    return (
        _bernstein_product(w, _bernstein_cross(x_u, x_v), np.multiply)
        - _bernstein_product(w_v, _bernstein_cross(x_u, x), np.multiply)
        - _bernstein_product(w_u, _bernstein_cross(x, x_v), np.multiply)
    )


def _bernstein_cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the Bernstein coefficients of the cross product of two vector polynomials, shape (..., ..., 3, U, S)."""
    return _bernstein_product(a, b, lambda one, other: _cross(one, other, axis=2))


def _bernstein_product(
    a: FloatArray, b: FloatArray, product: Callable[[FloatArray, FloatArray], FloatArray]
) -> FloatArray:
    """Return the Bernstein coefficients of a bilinear product of two polynomials, with 3 components in axis 2."""
    (m, n), (k, r) = (tuple(d - 1 for d in x.shape[:2]) for x in (a, b))
    scaled = b * _binomials(k, r)
    total = np.zeros((m + k + 1, n + r + 1, *b.shape[2:]))
    for i in range(m + 1):
        for j in range(n + 1):
            one = (float(comb(m, i) * comb(n, j)) * a[i, j])[None, None]
            total[i : i + k + 1, j : j + r + 1] += product(one, scaled)
    return np.asarray(total / _binomials(m + k, n + r))


def _binomials(m: int, n: int) -> FloatArray:
    """Return products of binomial coefficients, to multiply coefficients of shape (m + 1, n + 1, 3, U, S)."""
    # As floats: whole numbers of 64 bits overflow from degrees of about 30 on.
    rows, columns = ([float(comb(k, i)) for i in range(k + 1)] for k in (m, n))
    return np.outer(rows, columns)[:, :, None, None, None]
