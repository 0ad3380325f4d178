"""Length of curves and area of surfaces: Gauss rules on the spans, which are halved until the rules settle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from semispline.solver.arrays import FloatArray, require
from semispline.solver.errors import OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.knots import breakpoints
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface

# Gauss points in each direction of a part; the finer rule has twice as many.
POINTS = 8
# Parts that one pass may look at: reached by surfaces that are folded along a line, whose error is then stated.
MOST_PARTS = 2000
# Parts that are evaluated at once.
TOGETHER = 200


@dataclass(frozen=True, eq=False)
class Measure:
    """A length or an area.

    Attributes
    ----------
    value : float
        In model units, or their square.
    error : float
        The difference of two Gauss rules, of 8 and of 16 points, summed over the parts, and rounding: measured, not
        proved.
    """

    value: float
    error: float


def curve_length(curve: BSplineCurve, tolerance: float = 1e-12) -> Measure:
    """Return the length of a curve.

    Spans on which Gauss rules of 8 and of 16 points differ are halved, until the sum of the differences is below
    `tolerance` times the length, or rounding. A curve of so many cusps that this takes more than 2000 parts has the
    error that is reached.

    Parameters
    ----------
    curve : BSplineCurve
        Rational too.
    tolerance : float
        Relative, positive.

    Raises
    ------
    OptionError
        A tolerance that is not positive.

    Source: B. Guenter, R. Parent, Computing the arc length of parametric curves, 1990.

    Examples
    --------
    >>> curve_length(BSplineCurve(1, [0, 0, 1, 1], [[0, 0, 0], [3, 4, 0]])).value
    5.0
    """
    require(curve, "curve", BSplineCurve)

    def speed(at: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.norm(curve.evaluate(at[:, 0], 1), axis=1))

    return _integral(speed, (breakpoints(curve.knots),), tolerance)


def surface_area(surface: Surface, tolerance: float = 1e-12) -> Measure:
    """Return the area of a surface; what lies twofold counts twice.

    As `curve_length`, in both directions. A surface that is folded along a line inside a span may reach the limit of
    parts first, and has the error that is reached.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Rational too.
    tolerance : float
        Relative, positive.

    Raises
    ------
    OptionError
        A tolerance that is not positive.

    Examples
    --------
    >>> roof = BSplineSurface(1, 1, [0, 0, 1, 1], [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[3, 0, 4], [3, 1, 4]]])
    >>> surface_area(roof).value
    5.0
    """
    require(surface, "surface", BSplineSurface, SemiStructuredSurface)

    def stretch(at: FloatArray) -> FloatArray:
        along_u, along_v = (surface.evaluate(at[:, 0], at[:, 1], du, dv) for du, dv in ((1, 0), (0, 1)))
        return np.asarray(np.linalg.norm(np.cross(along_u, along_v), axis=1))

    return _integral(stretch, surface.breakpoints, tolerance)


def _integral(
    integrand: Callable[[FloatArray], FloatArray], breaks: tuple[FloatArray, ...], tolerance: float
) -> Measure:
    if not 0 < real_number(tolerance, "tolerance", OptionError) < np.inf:
        raise OptionError(f"tolerance: found {tolerance}, expected a positive number")
    rounding = 64 * float(np.finfo(float).eps)
    # Parts as their lower and upper ends, shape (K, 2, d).
    parts = np.array([[low, high] for low, high in _boxes(breaks)])
    settled, settled_error = 0.0, 0.0
    while True:
        fine, coarse = _on_parts(integrand, parts, 2 * POINTS), _on_parts(integrand, parts, POINTS)
        change = np.abs(fine - coarse)
        total = settled + float(fine.sum())
        error = settled_error + float(change.sum())
        allowed = max(tolerance, rounding) * total
        # Each part may use its share of what is allowed.
        rough = change > allowed / (2 * len(parts))
        if error <= allowed or not rough.any() or int(rough.sum()) * 2 ** len(breaks) > MOST_PARTS:
            return Measure(total, error + rounding * total)
        settled += float(fine[~rough].sum())
        settled_error += float(change[~rough].sum())
        parts = _halved(parts[rough])


def _boxes(breaks: tuple[FloatArray, ...]) -> list[tuple[FloatArray, FloatArray]]:
    spans = [list(pairwise(b)) for b in breaks]
    return [(np.array([s[0] for s in box]), np.array([s[1] for s in box])) for box in product(*spans)]


def _halved(parts: FloatArray) -> FloatArray:
    for axis in range(parts.shape[2]):
        lower, upper = parts.copy(), parts.copy()
        lower[:, 1, axis] = upper[:, 0, axis] = parts[:, :, axis].mean(axis=1)
        parts = np.concatenate([lower, upper])
    return parts


def _on_parts(integrand: Callable[[FloatArray], FloatArray], parts: FloatArray, points: int) -> FloatArray:
    """Return the integral over each part by a Gauss rule of so many points in each direction."""
    d = parts.shape[2]
    line, weight = np.polynomial.legendre.leggauss(points)
    grid = np.stack(np.meshgrid(*[(1 + line) / 2] * d, indexing="ij"), axis=-1).reshape(-1, d)
    weights = np.prod(np.stack(np.meshgrid(*[weight / 2] * d, indexing="ij"), axis=-1).reshape(-1, d), axis=1)
    results = []
    for start in range(0, len(parts), TOGETHER):
        low, high = parts[start : start + TOGETHER].transpose(1, 0, 2)
        at = low[:, None] + (high - low)[:, None] * grid
        values = integrand(at.reshape(-1, d)).reshape(at.shape[:2])
        results.append(values @ weights * np.prod(high - low, axis=1))
    return np.concatenate(results)
