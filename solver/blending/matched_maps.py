"""What answers what along two contacts: a monotone map of v, by which one side is run through, exactly.

A blend of rows C(v) and D(v) leads from each point of one contact to the point of the other with the same v. Run
through by phi, D(phi(v)), the same surface answers otherwise; its contact stays exact, and its degree along is three
times as high.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

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
_INNER_ORDER = 2


@dataclass(frozen=True, eq=False)
class VMap:
    """A monotone piecewise cubic map of one domain onto itself.

    Attributes
    ----------
    function : PPoly
    order : int
        How many of its derivatives are continuous.
    """

    function: PPoly
    order: int


def length_map(a: Side, b: Side) -> VMap:
    """Return the map of v by which each share of the length of a meets the same share of b's.

    Corners that both have answer each other, whatever the lengths between them are.
    """
    start, end = float(a.along.knots[0]), float(a.along.knots[-1])
    stops = np.concatenate([[start], common_corners(a.along, b.along), [end]])
    # At the knots of b: then it has no more spans than before.
    stations = breakpoints(b.along.knots)
    for halvings in range(_MOST_HALVINGS + 1):
        found = _through(*_length_stations(a, b, stops, stations), stops)
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


def point_map(pairs: Sequence[tuple[float, float]], along: Basis, *, closed: bool) -> tuple[VMap, float]:
    """Return the map through pairs of values of v, and how far the start of b has to be moved first.

    Parameters
    ----------
    pairs : sequence of (float, float)
        In the one domain that both sides have, b turned already.
    along : Basis
        Of either.
    closed : bool
        There is no end that has to answer an end: the pairs alone say where the seam goes.

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
        around_x, around_y = (np.concatenate([z - length, z, z + length]) for z in (x, y))
        _check_monotone(around_x, around_y, length)
        shift = float(PchipInterpolator(around_x, around_y)(start)) - start
        x, y = np.concatenate([[start], x, [end]]), np.concatenate([[start], y - shift, [end]])
        keep = np.append(True, np.diff(x) > _APART * length)
        keep[-2] &= x[-1] - x[-2] > _APART * length
        return _through(x[keep], y[keep], np.array([start, end])), shift
    inside = (x > start + _APART * length) & (x < end - _APART * length)
    x, y = np.concatenate([[start], x[inside], [end]]), np.concatenate([[start], y[inside], [end]])
    _check_monotone(x, y, length)
    return _through(x, y, np.array([start, end])), 0.0


def _check_monotone(x: FloatArray, y: FloatArray, length: float) -> None:
    if (np.diff(x) <= _APART * length).any() or (np.diff(y) <= _APART * length).any():
        raise OptionError(
            "match: found pairs that cross or coincide, expected points of a that answer points of b in the same order "
            "along both edges; end answers end"
        )


def _through(x: FloatArray, y: FloatArray, stops: FloatArray) -> VMap:
    """Return a map through the points, C2 where that is monotone, else C1; between stops each on its own."""
    pieces, smooth = [], True
    for low, high in pairwise(stops):
        inside = (x >= low) & (x <= high)
        piece: PPoly = (
            CubicSpline(x[inside], y[inside]) if inside.sum() > 2 else PchipInterpolator(x[inside], y[inside])
        )
        if not _rises(piece):
            piece, smooth = PchipInterpolator(x[inside], y[inside]), False
        pieces.append(piece)
    coefficients = np.concatenate([np.pad(piece.c, ((4 - len(piece.c), 0), (0, 0))) for piece in pieces], axis=1)
    places = np.concatenate([pieces[0].x[:1], *(piece.x[1:] for piece in pieces)])
    order = 0 if len(stops) > 2 else 2 if smooth else 1
    return VMap(PPoly(coefficients, places), order)


def _rises(function: PPoly) -> bool:
    slope = function.derivative()
    places = np.concatenate([function.x, [x for x in slope.derivative().roots(extrapolate=False) if np.isfinite(x)]])
    return bool(slope(places).min() > 0)


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
    own = np.unique(np.concatenate([_before(by.function, breaks), by.function.x]))
    keep = np.append(True, np.diff(own) > _APART * 1e-6 * np.ptp(own))
    places = own[keep]
    t = chebyshev_places(3 * q + 1)
    points, smooth = [], []
    for low, high in pairwise(places):
        middle = float(by.function((low + high) / 2))
        k = int(np.clip(np.searchsorted(breaks, middle) - 1, 0, len(pieces) - 1))
        width = breaks[k + 1] - breaks[k]
        at = np.clip((by.function(low + (high - low) * t) - breaks[k]) / width, 0.0, 1.0)
        points.append(bezier_points(bezier_derivatives(pieces[k], float(width), at, 0)[:, 0]))
    knots = side.along.knots
    for place in places[1:-1]:
        value = float(by.function(place))
        count = int(np.sum(np.abs(knots - value) <= _APART * 1e-6 * np.ptp(breaks)))
        of_map = by.order if np.abs(by.function.x - place).min() <= _APART * 1e-6 * np.ptp(own) else _INNER_ORDER
        smooth.append(min(q - count, of_map, _INNER_ORDER))
    rows, along = joined_spans(points, places, smooth)
    return replace(side, rows=rows, along=along)


def _before(function: PPoly, values: FloatArray) -> FloatArray:
    """Return where a rising function has the given values."""
    found = []
    for value in values[1:-1]:
        roots = function.solve(value, extrapolate=False)
        found.append(float(roots[np.isfinite(roots)][0]))
    return np.array([function.x[0], *found, function.x[-1]])
