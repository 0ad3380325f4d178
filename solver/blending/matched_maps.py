"""What answers what along two contacts: a monotone map of v, by which one side is run through, exactly.

A blend of rows C(v) and D(v) leads from each point of one contact to the point of the other with the same v. Run
through by phi, D(phi(v)), the same surface answers otherwise; its contact stays exact, and its degree along is three
times as high.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import factorial

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.layout import common_corners
from semispline.solver.blending.reparametrisation import bezier_derivatives, bezier_points, chebyshev_places
from semispline.solver.blending.sides import Side
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.errors import OptionError
from semispline.solver.splines import Basis, breakpoints

# Equal shares of arc length are met to this part of the whole length.
_SHARES = 1e-3
# How often spans of a map are halved until the shares are met.
_MOST_HALVINGS = 4
_LENGTH_SAMPLES = 512
# Stations nearer than this part of the domain are one.
_APART = 1e-6
_MOST_DEGREE = 25
# A smoother map that nearly stands still is left for one that does not.
_LEAST_RISE = 0.2
# Derivatives at a seam that agree to this part are the same.
_SMOOTH = 1e-9
_INNER_ORDER = 2


@dataclass(frozen=True, eq=False)
class VMap:
    """A monotone piecewise cubic map of one domain onto itself.

    Attributes
    ----------
    function : PPoly
        Onto the domain, or, of closed sides, onto as long a range that begins later: there b goes around.
    order : int
        How many of its derivatives are continuous.
    """

    function: PPoly
    order: int


def length_map(a: Side, b: Side, *, closed: bool) -> VMap:
    """Return the map of v by which each share of the length of a meets the same share of b's.

    Corners that both have answer each other, whatever the lengths between them are.
    """
    start, end = float(a.along.knots[0]), float(a.along.knots[-1])
    stops = np.concatenate([[start], common_corners(a.along, b.along), [end]])
    # At the knots of b: then it has no more spans than before.
    stations = breakpoints(b.along.knots)
    for halvings in range(_MOST_HALVINGS + 1):
        x, y = _length_stations(a, b, stops, stations)
        found = _around(x[:-1], y[:-1], start, end) if closed and len(stops) == 2 else _through(x, y, stops)
        if halvings == _MOST_HALVINGS or _worst_share(a, b, found, stops) <= _SHARES:
            break
        stations = np.sort(np.concatenate([stations, (stations[1:] + stations[:-1]) / 2]))
    return found


def _length_stations(a: Side, b: Side, stops: FloatArray, stations: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the values of v that have to be answered by the stations of b, and these."""
    x, y = [stops[:1]], [stops[:1]]
    for low, high in pairwise(stops):
        dense = np.linspace(low, high, _LENGTH_SAMPLES + 1)
        one, other = _shares(a, dense), _shares(b, dense)
        inner = stations[(stations > low + _APART * (high - low)) & (stations < high - _APART * (high - low))]
        y.append(np.append(inner, high))
        x.append(np.append(np.interp(np.interp(inner, dense, other), one, dense), high))
    return np.concatenate(x), np.concatenate(y)


def _shares(side: Side, v: FloatArray) -> FloatArray:
    """Return the share of the length of a stretch that lies before each of its places."""
    middle = (v[1:] + v[:-1]) / 2
    speeds = [np.linalg.norm(side.tangents(x), axis=1) for x in (v[:-1], middle, v[1:])]
    lengths = np.concatenate([[0.0], np.cumsum((speeds[0] + 4 * speeds[1] + speeds[2]) * np.diff(v) / 6)])
    return np.asarray(lengths / lengths[-1])


def _worst_share(a: Side, b: Side, found: VMap, stops: FloatArray) -> float:
    worst = 0.0
    for low, high in pairwise(stops):
        dense = np.linspace(low, high, _LENGTH_SAMPLES + 1)
        answered = np.interp(found.function(dense), dense, _shares(b, dense))
        worst = max(worst, float(np.abs(answered - _shares(a, dense)).max()))
    return worst


def point_map(pairs: Sequence[tuple[float, float]], along: Basis, *, closed: bool) -> VMap:
    """Return the map through pairs of values of v.

    Parameters
    ----------
    pairs : sequence of (float, float)
        In the one domain that both sides have, b turned already.
    along : Basis
        Of either.
    closed : bool
        There is no end that has to answer an end: the pairs alone say what the start of a meets.

    Raises
    ------
    OptionError
        Pairs that no monotone map goes through.
    """
    start, end = float(along.knots[0]), float(along.knots[-1])
    length = end - start
    x, y = (np.array(values) for values in zip(*sorted(pairs), strict=True))
    if closed:
        # Unwound: each one after the one before it.
        y = y[0] + np.cumsum(np.concatenate([[0.0], np.mod(np.diff(y), length)]))
        _check_monotone(np.append(x, x[0] + length), np.append(y, y[0] + length), length)
        return _around(x, y, start, end)
    inside = (x > start + _APART * length) & (x < end - _APART * length)
    x, y = np.concatenate([[start], x[inside], [end]]), np.concatenate([[start], y[inside], [end]])
    _check_monotone(x, y, length)
    return _through(x, y, np.array([start, end]))


def _check_monotone(x: FloatArray, y: FloatArray, length: float) -> None:
    if (np.diff(x) <= _APART * length).any() or (np.diff(y) <= _APART * length).any():
        raise OptionError(
            "match: found pairs that cross or coincide, expected points of a that answer points of b in the same order "
            "along both edges; end answers end"
        )


def _through(x: FloatArray, y: FloatArray, stops: FloatArray) -> VMap:
    """Return a map through the points, C2 where that rises enough, else C1; between stops each on its own."""
    pieces, smooth = [], True
    for low, high in pairwise(stops):
        inside = (x >= low) & (x <= high)
        own = x[inside], y[inside]
        piece: PPoly = CubicSpline(*own)
        if not _rises(piece, *own):
            piece, smooth = _monotone(*own), False
        pieces.append(piece)
    coefficients = np.concatenate([np.pad(piece.c, ((4 - len(piece.c), 0), (0, 0))) for piece in pieces], axis=1)
    places = np.concatenate([pieces[0].x[:1], *(piece.x[1:] for piece in pieces)])
    order = 0 if len(stops) > 2 else 2 if smooth else 1
    return VMap(PPoly(coefficients, places), order)


def _monotone(x: FloatArray, y: FloatArray) -> PPoly:
    """Return a C1 map that rises everywhere: at both ends as fast as between the points next to them."""
    ghosts = [np.concatenate([[2 * z[0] - z[1]], z, [2 * z[-1] - z[-2]]]) for z in (x, y)]
    return _cut(PchipInterpolator(*ghosts), x[0], x[-1])


def _rises(function: PPoly, x: FloatArray, y: FloatArray) -> bool:
    """Tell whether a function rises everywhere, by a part at least of the least slope between its points."""
    slope = function.derivative()
    places = np.concatenate([function.x, [x for x in slope.derivative().roots(extrapolate=False) if np.isfinite(x)]])
    return bool(slope(places).min() > _LEAST_RISE * (np.diff(y) / np.diff(x)).min())


def _around(x: FloatArray, y: FloatArray, start: float, end: float) -> VMap:
    """Return a map of closed sides through the points of one period, as smooth at its ends as inside."""
    length = end - start
    over, order = np.append(x, x[0] + length), 2
    change = CubicSpline(over, np.append(y - x, y[0] - x[0]), bc_type="periodic")
    coefficients = np.pad(change.c, ((4 - len(change.c), 0), (0, 0)))
    coefficients[-2:] += np.stack([np.ones(len(x)), x])
    if not _rises(PPoly(coefficients, over), over, np.append(y, y[0] + length)):
        pchip, order = PchipInterpolator(*(np.concatenate([z - length, z, z + length]) for z in (x, y))), 1
        coefficients = _cut(pchip, over[0], over[-1]).c
    before = coefficients.copy()
    before[-1] -= length
    both = PPoly(np.concatenate([before, coefficients], axis=1), np.concatenate([over[:-1] - length, over]))
    function = _cut(both, start, end)
    # It begins within the domain, however the pairs are counted.
    function.c[-1] -= length * np.floor((float(function(start)) - start) / length + _APART)
    return VMap(function, order)


def _cut(function: PPoly, low: float, high: float) -> PPoly:
    """Return a piecewise cubic function over a part of where it is known."""
    within = _APART * (high - low)
    x = np.concatenate([[low], function.x[(function.x > low + within) & (function.x < high - within)], [high]])
    return PPoly(np.stack([function.derivative(k)(x[:-1]) / factorial(k) for k in (3, 2, 1, 0)]), x)


def run_by(side: Side, by: VMap) -> Side:
    """Return a side with its rows run through by a map of v.

    Raises
    ------
    OptionError
        Its degree would be too high.
    """
    q = side.along.degree
    if 3 * q > _MOST_DEGREE:
        raise OptionError(
            f"match: degree {3 * q} along, three times that of base b, expected at most {_MOST_DEGREE}; leave out "
            "match, or name the bases the other way round"
        )
    breaks, pieces = bezier_pieces(side.rows, side.along)
    tiny, end, length = _APART * 1e-6 * np.ptp(breaks), float(breaks[-1]), float(np.ptp(breaks))
    first, last = (float(x) for x in by.function(by.function.x[[0, -1]]))
    at_seam = _seam_order(breaks, pieces)
    knots = side.along.knots
    if last > end + tiny:
        breaks, pieces = np.concatenate([breaks, breaks[1:] + length]), np.concatenate([pieces, pieces])
        knots = np.concatenate([knots[knots < end], np.repeat(end, q - at_seam), knots[knots > breaks[0]] + length])
    inner = breaks[(breaks > first + tiny) & (breaks < last - tiny)]
    own = np.unique(np.concatenate([_before(by.function, inner), by.function.x]))
    places = own[np.append(True, np.diff(own) > _APART * 1e-6 * np.ptp(own))]
    t = chebyshev_places(3 * q + 1)
    points, smooth = [], []
    for low, high in pairwise(places):
        middle = float(by.function((low + high) / 2))
        k = int(np.clip(np.searchsorted(breaks, middle) - 1, 0, len(pieces) - 1))
        width = breaks[k + 1] - breaks[k]
        at = np.clip((by.function(low + (high - low) * t) - breaks[k]) / width, 0.0, 1.0)
        points.append(bezier_points(bezier_derivatives(pieces[k], float(width), at, 0)[:, 0]))
    for place in places[1:-1]:
        count = int(np.sum(np.abs(knots - float(by.function(place))) <= tiny))
        of_map = by.order if np.abs(by.function.x - place).min() <= _APART * 1e-6 * np.ptp(own) else _INNER_ORDER
        smooth.append(min(q - count, of_map, _INNER_ORDER))
    rows, along = joined_spans(points, places, smooth)
    return replace(side, rows=rows, along=along)


def _seam_order(breaks: FloatArray, pieces: FloatArray) -> int:
    """Return how many derivatives of a closed side agree at its seam: 0 or 1."""
    before = (pieces[-1][:, -1] - pieces[-1][:, -2]) / (breaks[-1] - breaks[-2])
    after = (pieces[0][:, 1] - pieces[0][:, 0]) / (breaks[1] - breaks[0])
    return int(np.abs(before - after).max() <= _SMOOTH * np.abs(after).max())


def _before(function: PPoly, values: FloatArray) -> FloatArray:
    """Return where a rising function has the given values."""
    found = []
    for value in values:
        roots = function.solve(value, extrapolate=False)
        found.append(float(roots[np.isfinite(roots)][0]))
    return np.array(found)
