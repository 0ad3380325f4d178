"""Bezier patches divided by Bezier functions: both parts are semi-structured surfaces.

A patch of degrees (m, n), cut along v = f(u) with f of degree k, falls into two parts that have degree n across, while
row s across is a Bezier curve of degree m + s k (below the cut) or m + (n - s) k (above it). The paper writes the
curves along u and blends them in v; a `SemiStructuredSurface` blends in its first parameter. So the first parameter of
a part runs across, from 0 to 1, and the second one runs along the cut, in the parameter of the patch:

    lower.evaluate(s, t) = patch(t, lo + s (f(t) - lo)),    upper.evaluate(s, t) = patch(t, f(t) + s (hi - f(t))),

with [lo, hi] the v-domain. A cut along u = f(v) gives patch(lo + s (f(t) - lo), t), and so on.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import comb
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from semispline.solver.arrays import FloatArray, finite_array, real_array, rebuilt, require
from semispline.solver.errors import ControlPointError, InputError, OptionError
from semispline.solver.scalars import real_number
from semispline.solver.splines.evaluation import checked_weights, euclidean
from semispline.solver.splines.knots import clamped
from semispline.solver.splines.outline import crossing_sides, signed_area
from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface, Surface

# Ends of neighbouring sides of a hole may differ by this fraction of the domain: rounding of decimal input.
CORNER_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class BezierFunction:
    """A Bezier function over [start, end].

    Parameters
    ----------
    coefficients : array_like, shape (k + 1,)
        v_0, ..., v_k.
    start, end : float
        The interval, start < end.

    Raises
    ------
    InputError
        No or not finite coefficients, or an empty interval.

    Source: equation (5) of the paper, over any interval.

    Examples
    --------
    >>> BezierFunction([0.8, 0.75], 0.2, 0.5).evaluate([0.2, 0.35])
    array([0.8  , 0.775])
    """

    coefficients: FloatArray
    start: float = 0.0
    end: float = 1.0

    def __post_init__(self) -> None:
        coefficients = finite_array(self.coefficients, 1, "coefficients", InputError)
        if len(coefficients) == 0:
            raise InputError("coefficients: found none, expected at least one")
        object.__setattr__(self, "coefficients", coefficients)
        for end in ("start", "end"):
            object.__setattr__(self, end, real_number(getattr(self, end), end, InputError))
        if not (np.isfinite([self.start, self.end]).all() and self.start < self.end):
            raise InputError(f"start, end: found {self.start}, {self.end}, expected finite start < end")

    def __reduce__(self) -> tuple[Any, ...]:
        return rebuilt(self)

    def evaluate(self, t: ArrayLike) -> FloatArray:
        """Evaluate at t, any shape, by de Casteljau's triangle."""
        x = (real_array(t, "t", InputError) - self.start) / (self.end - self.start)
        level = [np.full(x.shape, c) for c in self.coefficients]
        while len(level) > 1:
            level = [(1 - x) * a + x * b for a, b in pairwise(level)]
        return level[0]


def bezier_patch(control_points: ArrayLike, weights: ArrayLike | None = None) -> BSplineSurface:
    """Return the Bezier patch with these control points over the unit square.

    Parameters
    ----------
    control_points : array_like, shape (m + 1, n + 1, 3)
        P_ij, Euclidean; the degrees m and n, at least 1, follow from the shape.
    weights : array_like, shape (m + 1, n + 1), optional
        Positive.

    Raises
    ------
    ControlPointError
        Not finite, of another shape, fewer than two rows or columns, or a weight that is not positive.

    Source: equation (4) of the paper.

    Examples
    --------
    >>> bezier_patch([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 4]]]).evaluate([0.5], [0.5])
    array([[0.5, 0.5, 1. ]])
    """
    points = finite_array(control_points, 3, "control_points", ControlPointError)
    rows, columns = points.shape[:2]
    if min(rows, columns) < 2:
        raise ControlPointError(f"control_points: {rows} x {columns} of them, expected at least 2 x 2")
    w = None if weights is None else checked_weights(weights, points, "weights")
    return BSplineSurface(rows - 1, columns - 1, _bezier_knots(rows - 1), _bezier_knots(columns - 1), points, w)


def divide_bezier(
    patch: BSplineSurface, coefficients: ArrayLike, direction: Literal["u", "v"] = "v"
) -> tuple[SemiStructuredSurface, SemiStructuredSurface]:
    """Divide a Bezier patch by a Bezier function of any degree.

    Parameters
    ----------
    patch : BSplineSurface
        Without inner knots, over any domain, rational too; degrees (m, n).
    coefficients : array_like, shape (k + 1,)
        v_0, ..., v_k of the function, equally spaced over the whole domain along the cut; values in the units of the
        divided parameter and inside its range. One coefficient gives a straight cut. Where the function reaches an end
        of the range, a part has no width there.
    direction : {"v", "u"}
        The divided parameter: cut along v = f(u), or along u = f(v).

    Returns
    -------
    lower, upper : SemiStructuredSurface
        The parts with smaller and with larger v (or u). The first parameter runs across in [0, 1], the second one
        along the cut, in the patch's own parameter. Curve s has degree m + s k in `lower`, m + (n - s) k in `upper`
        (n + s k and so on where u is divided). Since the first parameter runs across, a part of a cut along
        v = f(u) has its two parameters exchanged: its normal P_u x P_v is opposite to that of the patch (one of a cut
        along u = f(v) keeps it).

    Raises
    ------
    InputError
        The patch has inner knots, or a coefficient is not finite or out of range.
    OptionError
        An unknown direction.

    Source: equations (4) to (6) of the paper, proved in `semispline.derivations.bezier`.

    Examples
    --------
    >>> square = bezier_patch([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> lower, upper = divide_bezier(square, [0.25, 0.75])
    >>> [curve.degree for curve in lower.control_curves]
    [1, 2]
    >>> upper.evaluate([0.0], [0.5])
    array([[0.5, 0.5, 0. ]])
    """
    if direction not in ("u", "v"):
        raise OptionError(f"direction: found {direction!r}, expected 'u' or 'v'")
    _check_bezier(patch)
    # Rows of `points` run along the cut, columns across.
    points = patch.homogeneous if direction == "v" else patch.homogeneous.transpose(1, 0, 2)
    along, across = patch.domain if direction == "v" else patch.domain[::-1]
    function = BezierFunction(finite_array(coefficients, 1, "coefficients", InputError), *along)
    return _divide(points, function, across, "coefficients")


def trim_bezier(
    patch: BSplineSurface, left: BezierFunction, right: BezierFunction, bottom: BezierFunction, top: BezierFunction
) -> dict[str, Surface]:
    """Cut a hole with four sides out of a Bezier patch; return the eight pieces that remain, exactly.

    Parameters
    ----------
    patch : BSplineSurface
        Without inner knots, rational too.
    left, right : BezierFunction
        u = left(v) and u = right(v), over intervals of v.
    bottom, top : BezierFunction
        v = bottom(u) and v = top(u), over intervals of u. The four meet in the corners of the hole.

    Returns
    -------
    dict
        ``left``, ``right``, ``bottom``, ``top``: `SemiStructuredSurface`, parameters as in `divide_bezier`, the second
        one over the interval of that side. ``lower left``, ``lower right``, ``upper right``, ``upper left``:
        `BSplineSurface`, in the parameters of the patch. Neighbours share their edges. The normals of
        ``bottom`` and ``top`` are opposite to those of the patch, the other six keep them.

    Raises
    ------
    InputError
        The patch has inner knots; a side leaves the domain or touches its boundary; two sides do not
        meet in their corner; two sides cross, touch, or leave their
        corner in one direction (decided by subdivision, not by samples); the outline is inside out.

    Source: Fig. 3 of the paper; the tiling is proved in `semispline.derivations.trimming`.

    Examples
    --------
    >>> square = bezier_patch([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> low, high = BezierFunction([0.25, 0.25], 0.25, 0.75), BezierFunction([0.75, 0.75], 0.25, 0.75)
    >>> pieces = trim_bezier(square, low, high, low, high)
    >>> pieces["upper left"].domain
    ((0.0, 0.25), (0.75, 1.0))
    """
    _check_bezier(patch)
    u_range, v_range = patch.domain
    for name, side, along, across in (
        ("left", left, v_range, u_range),
        ("right", right, v_range, u_range),
        ("bottom", bottom, u_range, v_range),
        ("top", top, u_range, v_range),
    ):
        require(side, name, BezierFunction)
        _check_side(name, side, along, across)
    _check_outline(patch, left, right, bottom, top)

    by_u = patch.homogeneous
    by_v = by_u.transpose(1, 0, 2)

    def strip(name: str, side: BezierFunction, part: int) -> SemiStructuredSurface:
        points, along, across = (by_v, v_range, u_range) if name in ("left", "right") else (by_u, u_range, v_range)
        return _divide(_segment(points, along, (side.start, side.end)), side, across, name)[part]

    def rectangle(us: tuple[float, float], vs: tuple[float, float]) -> BSplineSurface:
        points = _segment(_segment(by_u, u_range, us).transpose(1, 0, 2), v_range, vs).transpose(1, 0, 2)
        p, q = patch.degree_u, patch.degree_v
        return BSplineSurface(p, q, _bezier_knots(p, *us), _bezier_knots(q, *vs), *euclidean(points))

    return {
        "left": strip("left", left, 0),
        "right": strip("right", right, 1),
        "bottom": strip("bottom", bottom, 0),
        "top": strip("top", top, 1),
        "lower left": rectangle((u_range[0], bottom.start), (v_range[0], left.start)),
        "lower right": rectangle((bottom.end, u_range[1]), (v_range[0], right.start)),
        "upper right": rectangle((top.end, u_range[1]), (right.end, v_range[1])),
        "upper left": rectangle((u_range[0], top.start), (left.end, v_range[1])),
    }


def _divide(
    points: FloatArray, function: BezierFunction, across: tuple[float, float], name: str
) -> tuple[SemiStructuredSurface, SemiStructuredSurface]:
    """Divide a homogeneous net, rows along and columns across the cut, given over the interval of the function."""
    lo, hi = across
    outside = (function.coefficients < lo) | (function.coefficients > hi)
    if outside.any():
        i = int(np.argmax(outside))
        raise InputError(f"{name}[{i}]: found {function.coefficients[i]}, expected a value in [{lo}, {hi}]")
    cut = (function.coefficients - lo) / (hi - lo)
    # de Casteljau's triangle across, whose entries are Bezier curves along: level s holds Q_j^s, j = 0..n - s.
    level = points.transpose(1, 0, 2)
    lower, upper = [level[0]], [level[-1]]
    while len(level) > 1:
        level = _product(1.0 - cut, level[:-1]) + _product(cut, level[1:])
        lower.append(level[0])
        upper.insert(0, level[-1])
    return _skin(lower, function), _skin(upper, function)


def _skin(rows: list[FloatArray], function: BezierFunction) -> SemiStructuredSurface:
    curves = []
    for s, row in enumerate(rows):
        knots = _bezier_knots(len(row) - 1, function.start, function.end)
        curves.append(BSplineCurve(len(row) - 1, knots, *euclidean(row), name=f"control_curves[{s}]"))
    return SemiStructuredSurface(len(rows) - 1, _bezier_knots(len(rows) - 1), tuple(curves))


def _product(function: FloatArray, curves: FloatArray) -> FloatArray:
    """Return the Bezier control points of function x curve for curves of shape (K, r + 1, 3 or 4)."""
    k, r = len(function) - 1, curves.shape[1] - 1
    weights = _product_weights(k, r)
    result = np.zeros((curves.shape[0], k + r + 1, curves.shape[2]))
    for a in range(k + 1):
        result[:, a : a + r + 1] += (function[a] * weights[a])[:, None] * curves
    return result


@lru_cache(maxsize=256)
def _product_weights(k: int, r: int) -> FloatArray:
    """Return C(k, a) C(r, b) / C(k + r, a + b), shape (k + 1, r + 1); the division of integers rounds once."""
    return np.array([[comb(k, a) * comb(r, b) / comb(k + r, a + b) for b in range(r + 1)] for a in range(k + 1)])


def _segment(points: FloatArray, domain: tuple[float, float], part: tuple[float, float]) -> FloatArray:
    """Return the Bezier control points of a part of the domain of axis 0: blossoms at its two ends."""
    a, b = ((x - domain[0]) / (domain[1] - domain[0]) for x in part)
    degree = len(points) - 1
    rows = []
    for i in range(degree + 1):
        level = points
        for x in [a] * (degree - i) + [b] * i:
            level = (1 - x) * level[:-1] + x * level[1:]
        rows.append(level[0])
    return np.stack(rows)


def _bezier_knots(degree: int, start: float = 0.0, end: float = 1.0) -> FloatArray:
    return clamped([], degree, start, end)


def _check_bezier(patch: BSplineSurface) -> None:
    if not isinstance(patch, BSplineSurface):
        raise InputError(f"patch: found {type(patch).__name__}, expected a BSplineSurface without inner knots")
    expected = (patch.degree_u + 1, patch.degree_v + 1)
    if patch.control_points.shape[:2] != expected:
        raise InputError(
            f"patch: found inner knots ({patch.control_points.shape[0]} x {patch.control_points.shape[1]} control "
            f"points), expected a Bezier patch of {expected[0]} x {expected[1]}: split it at its knots first"
        )


def _check_side(name: str, side: BezierFunction, along: tuple[float, float], across: tuple[float, float]) -> None:
    if not along[0] < side.start < side.end < along[1]:
        raise InputError(f"{name}: found the interval [{side.start}, {side.end}], expected one inside {along}")
    for i, c in enumerate(side.coefficients):
        if not across[0] < c < across[1]:
            raise InputError(f"{name}[{i}]: found {c}, expected a value inside {across}")


def _check_outline(
    patch: BSplineSurface, left: BezierFunction, right: BezierFunction, bottom: BezierFunction, top: BezierFunction
) -> None:
    """Refuse a hole whose sides do not meet in the corners or cross each other."""
    low, high = np.array(patch.domain).T
    size = high - low

    def outline(side: BezierFunction, axis: int) -> FloatArray:
        """Control points in the unit square; a graph over `axis`."""
        values = side.coefficients if len(side.coefficients) > 1 else np.repeat(side.coefficients, 2)
        along = np.linspace(side.start, side.end, len(values))
        points = (along, values) if axis == 0 else (values, along)
        return np.asarray((np.stack(points, axis=1) - low) / size)

    # Counterclockwise; each side ends where the next one starts.
    sides = {
        "bottom": outline(bottom, 0),
        "right": outline(right, 1),
        "top": outline(top, 0)[::-1],
        "left": outline(left, 1)[::-1],
    }
    names = list(sides)
    for one, other in zip(names, names[1:] + names[:1], strict=True):
        end, start = sides[one][-1], sides[other][0]
        if (np.abs(end - start) > CORNER_TOLERANCE).any():
            found = [tuple((low + x * size).round(12).tolist()) for x in (end, start)]
            raise InputError(f"{one}, {other}: found ends at {found[0]} and {found[1]} in (u, v), expected one corner")
    crossing = crossing_sides(sides)
    if crossing:
        raise InputError(
            f"{crossing[0]}, {crossing[1]}: they cross or touch outside a common corner, expected a hole whose outline "
            "is a simple loop with no angle of 0"
        )
    if signed_area(sides) <= 0:
        raise InputError(
            "left, right, bottom, top: found the outline inside out, expected left and bottom below the others"
        )
