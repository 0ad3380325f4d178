"""How unfair a surface is: area times the integral of |grad H|^2, and what jumps of H add."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import closed_directions, just_inside, spread, turn_window
from semispline.solver.splines import gauss_rule

# A finer grid that changes the value by no more than this fraction settles it; and what is below the second figure is
# zero, since a visible shape has 1 and more.
SETTLED, _NOTHING = 0.01, 1e-8
# Gauss points in u and in v altogether, and the least on each span, for the first grid and for the second, which tells
# whether the first settled it: the integrand is no polynomial. Along v, where a span has few points, the second has
# twice as many: two and three points may be off alike. Then the second on spans halved again and again.
_FIRST, _SECOND = ((24, 10), (6, 3)), ((32, 20), (9, 6))
# How often every span is halved before the meter gives up, and at which change between two of these grids it does at
# once: what folds is infinite in truth. What a grid may hold in all, and what is worked on at once.
_HALVINGS, _WILD, _MOST, _AT_ONCE = 5, 10.0, 2**21, 2**13
# Spans of a cluster of knots along v are below this fraction of the mean one, and the cluster is narrower than the
# second figure, in gaps: over it H may change as much as over a jump. A gap is at least so large, in windows: the ends
# of a surface that closes across have none.
_CLUSTERED, _CLUSTER, _LEAST_GAP = 1 / 20, 1 / 200, 1.0
# Parts of the domain; knots closer than that are refused, or one.
_TIGHTEST = 1e-13
_GRIDS = ((_FIRST, 0), *((_SECOND, halvings) for halvings in range(_HALVINGS)))


@dataclass(frozen=True)
class Fairness:
    """A * (integral of |grad H|^2 dA + (1/h) * integral of [H]^2 ds); without units.

    Attributes
    ----------
    value : float
        The sum of the next two; all are infinite where curvature is without end at a sample.
    smooth : float
        What the spans contribute.
    jumps : float
        What lines where H jumps contribute: as much as if the jump were spread over one window of turn.
    settled : bool
        The last refinement of the samples changed what the spans along v add by at most 1 % of the value altogether.
    """

    value: float
    smooth: float
    jumps: float
    settled: bool


def measure_fairness(surface: ParametricSurface) -> Fairness:
    """Measure how mean curvature varies over a surface, by Gauss points on every span, refined until it settles.

    H is the mean curvature, A the area, and h is 1/50 of the mean length of the sections v = const. H may jump across
    lines of knots, and across the seam of a closed surface. Knots along v closer than 1/200 of the mean straight gap
    between the ends of these sections are one line: what is between them counts as a jump.

    Parameters
    ----------
    surface : BSplineSurface, SemiStructuredSurface or ParametricSurface
        One that evaluates derivatives up to third order.

    Raises
    ------
    InputError
        The sections v = const have no length.

    Source: the measures of the design document.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> measure_fairness(BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]))
    Fairness(value=0.0, smooth=0.0, jumps=0.0, settled=True)
    """
    scaled = _Scaled(surface, turn_window(surface))
    seams = closed_directions(surface)
    wide = _wide_spans(surface.breakpoints[1], _length_along(scaled), _CLUSTER * max(_gap(scaled), _LEAST_GAP))
    before: FloatArray | None = None
    found: Fairness | None = None
    for points, halvings in _GRIDS:
        rules = _rules(surface, wide, points, halvings)
        if found is not None and rules[0].points.size * rules[1].points.size > _MOST:
            return found
        gradients, area = _smooth_part(scaled, rules)
        parts = area * np.append(gradients.reshape(int(wide.sum()), -1).sum(axis=1), _jumps(scaled, rules, seams, wide))
        smooth, jumps = float(parts[:-1].sum()), float(parts[-1])
        value = smooth + jumps
        if not np.isfinite(value):
            return Fairness(np.inf, np.inf, np.inf, settled=False)
        # Span by span: what one gains another may lose.
        settled = before is not None and np.abs(parts - before).sum() <= max(SETTLED * value, _NOTHING)
        is_wild = found is not None and halvings > 0 and not found.value / _WILD <= value <= found.value * _WILD
        before, found = parts, Fairness(value, smooth, jumps, bool(settled))
        if settled or is_wild:
            break
    assert found is not None
    return found


@dataclass(frozen=True, eq=False)
class _Rule:
    """Gauss points of one parameter, all spans after each other, and weights whose sum is 1 with those of clusters."""

    points: FloatArray
    weights: FloatArray


_Rules: TypeAlias = tuple[_Rule, _Rule]


@dataclass(frozen=True, eq=False)
class _Scaled:
    """A surface measured by its window, over [0, 1] x [0, 1]: what is measured then has neither units nor overflow."""

    surface: ParametricSurface
    window: float

    def derivative(self, u: FloatArray, v: FloatArray, du: int, dv: int) -> FloatArray:
        """Return a derivative on the grid u x v of the surface's own parameters, shape (3, len(u), len(v))."""
        (u_start, u_end), (v_start, v_end) = self.surface.domain
        factor = (u_end - u_start) ** du * (v_end - v_start) ** dv
        # Components apart, each in one piece.
        found = self.surface.evaluate_grid(u, v, du, dv).transpose(2, 0, 1)
        return np.ascontiguousarray(found) * (factor / self.window)


def _length_along(surface: _Scaled) -> float:
    """Return the mean length of the sections u = const, in windows."""
    (u, of_u), (v, of_v) = (gauss_rule(breaks, 7) for breaks in surface.surface.breakpoints)
    speed = np.sqrt(sum(c**2 for c in surface.derivative(u.T.ravel(), v.T.ravel(), 0, 1)))
    return float(of_u.T.ravel() @ speed @ of_v.T.ravel()) / float(of_u.sum() * of_v.sum())


def _gap(surface: _Scaled) -> float:
    """Return the mean distance between both ends of the sections v = const, in windows."""
    v, of_v = (part.T.ravel() for part in gauss_rule(surface.surface.breakpoints[1], 7))
    first, last = surface.derivative(np.array(surface.surface.domain[0]), v, 0, 0).transpose(1, 0, 2)
    return float(np.sqrt(((last - first) ** 2).sum(axis=0)) @ of_v) / float(of_v.sum())


def _wide_spans(breaks: FloatArray, length: float, cluster: float) -> NDArray[np.bool_]:
    """Tell which spans of v belong to no cluster of knots; `length` is that of all, in the unit of `cluster`.

    Examples
    --------
    >>> _wide_spans(np.array([0, 0.5, 0.5001, 0.5002, 1.0]), 100.0, 0.25).tolist()
    [True, False, False, True]
    """
    at = (breaks - breaks[0]) / (breaks[-1] - breaks[0])
    widths = np.diff(at)
    most = cluster / max(length, np.finfo(float).tiny)
    wide = np.ones(len(widths), dtype=bool)
    limit = min(most, _CLUSTERED / len(widths))
    # From the loosest clusters to the tightest: one that is too wide may hold others.
    while limit > _TIGHTEST:
        start = 0
        for is_narrow, group in groupby(widths < limit):
            end = start + len(list(group))
            if is_narrow and at[end] - at[start] < most:
                wide[start:end] = False
            start = end
        limit /= 10
    return wide


def _rules(
    surface: ParametricSurface, wide: NDArray[np.bool_], points: tuple[tuple[int, int], tuple[int, int]], halvings: int
) -> _Rules:
    """Return the rules in u and in v with every span halved so many times; `wide` are the spans of v that count."""

    def rule(breaks: FloatArray, counted: NDArray[np.bool_], total: int, least: int) -> _Rule:
        number = max(least, -(-total // int(counted.sum())))
        points, weights = gauss_rule(spread(breaks, 1, 2**halvings), 2 * number - 1)
        parts = np.repeat(counted, 2**halvings)
        return _Rule(points.T[parts].ravel(), weights.T[parts].ravel() / (breaks[-1] - breaks[0]))

    u_breaks, v_breaks = surface.breakpoints
    totals, least = points
    everywhere = np.ones(len(u_breaks) - 1, dtype=bool)
    return rule(u_breaks, everywhere, totals[0], least[0]), rule(v_breaks, wide, totals[1], least[1])


def _smooth_part(surface: _Scaled, rules: _Rules) -> tuple[FloatArray, float]:
    """Return what each point of v adds to the integral of |grad H|^2, and the area, lengths in windows."""
    (u, of_u), (v, of_v) = ((rule.points, rule.weights) for rule in rules)
    gradients, area = np.empty(len(v)), 0.0
    for part in _parts(len(u), len(v)):
        density, element = _gradient_density(surface, u, v[part])
        gradients[part] = (of_u @ density) * of_v[part]
        area += float(of_u @ element @ of_v[part])
    return gradients, area


def _parts(n_u: int, n_v: int) -> Iterator[slice]:
    step = max(1, _AT_ONCE // n_u)
    yield from (slice(at, at + step) for at in range(0, n_v, step))


def _gradient_density(surface: _Scaled, u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return |grad H|^2 |m| and |m|, with m = P_u x P_v, on a grid.

    H = Q / (2 |m|^3), Q = E (P_vv . m) - 2 F (P_uv . m) + G (P_uu . m); its derivatives by the product rule.
    """

    def derivative(du: int, dv: int) -> FloatArray:
        return surface.derivative(u, v, du, dv)

    a, b = derivative(1, 0), derivative(0, 1)
    aa, ab, bb = derivative(2, 0), derivative(1, 1), derivative(0, 2)
    m = _cross(a, b)
    E, F, G, square = _dot(a, a), _dot(a, b), _dot(b, b), _dot(m, m)
    L, M, N = _dot(aa, m), _dot(ab, m), _dot(bb, m)
    Q = E * N - 2 * F * M + G * L
    length = np.sqrt(square)

    def derivative_of_h(x: FloatArray, y: FloatArray, third: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
        """Return H's derivative along the parameter along which P_u has derivative x, P_v y, and P_uu ... `third`."""
        turning = _cross(x, b) + _cross(a, y)
        change = (
            2 * _dot(a, x) * N
            + E * (_dot(third[2], m) + _dot(bb, turning))
            - 2 * (_dot(x, b) + _dot(a, y)) * M
            - 2 * F * (_dot(third[1], m) + _dot(ab, turning))
            + 2 * _dot(b, y) * L
            + G * (_dot(third[0], m) + _dot(aa, turning))
        )
        return np.asarray((change - 3 * Q * _dot(m, turning) / square) / (2 * square * length))

    with np.errstate(divide="ignore", invalid="ignore"):
        aab, abb = derivative(2, 1), derivative(1, 2)
        h_u = derivative_of_h(aa, ab, (derivative(3, 0), aab, abb))
        h_v = derivative_of_h(ab, bb, (aab, abb, derivative(0, 3)))
        return np.asarray((G * h_u**2 - 2 * F * h_u * h_v + E * h_v**2) / length), length


def _jumps(surface: _Scaled, rules: _Rules, seams: tuple[bool, bool], wide: NDArray[np.bool_]) -> float:
    """Return the integral of [H]^2 ds over all lines of knots, and over seams; lengths in windows, so h is 1."""
    (u, of_u), (v, of_v) = ((rule.points, rule.weights) for rule in rules)
    total = 0.0
    for lines, nodes, weights, swapped, seam in (
        (surface.surface.breakpoints[0], v, of_v, True, seams[0]),
        (surface.surface.breakpoints[1], u, of_u, False, seams[1]),
    ):
        after, before = just_inside(lines)
        if not swapped:
            after, before = after[wide], before[wide]
        # On a closed surface the end of the last span lies before the start of the first.
        after, before = (after, np.roll(before, 1)) if seam else (after[1:], before[:-1])
        for part in _parts(len(nodes), len(after)):
            (h_after, speed), (h_before, _) = (
                _mean_curvature(surface, nodes, side[part], swapped) for side in (after, before)
            )
            total += float((weights @ ((h_after - h_before) ** 2 * speed)).sum())
    return total


def _mean_curvature(surface: _Scaled, run: FloatArray, at: FloatArray, swapped: bool) -> tuple[FloatArray, FloatArray]:
    """Return H and the speed along lines, shape (len(run), len(at)): lines of constant u if swapped, else of v."""

    def derivative(du: int, dv: int) -> FloatArray:
        values = surface.derivative(*((at, run) if swapped else (run, at)), du, dv)
        return values.transpose(0, 2, 1) if swapped else values

    a, b = derivative(1, 0), derivative(0, 1)
    m = _cross(a, b)
    E, F, G = _dot(a, a), _dot(a, b), _dot(b, b)
    L, M, N = (_dot(derivative(*order), m) for order in ((2, 0), (1, 1), (0, 2)))
    with np.errstate(divide="ignore", invalid="ignore"):
        h = (E * N - 2 * F * M + G * L) / (2 * _dot(m, m) ** 1.5)
    return np.asarray(h), np.sqrt(G if swapped else E)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
