"""Contacts that are moved from an edge into its face: by a true distance, or to a parameter.

By a distance along the surface, square to the edge; where that is a line of constant parameter the contact is one, else
a free curve and a band along it. At the ends it goes as far as the edges of the face there.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import fixed_quad
from scipy.interpolate import make_interp_spline
from scipy.optimize import brentq

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError, OptionError
from semispline.solver.judge import cad_measures
from semispline.solver.splines import BSplineCurve, BSplineSurface, EdgeName, parse_edge
from semispline.solver.topology.face_jets import Face, dot
from semispline.solver.topology.outlines import Outline
from semispline.solver.topology.parallels import (
    Paths,
    crossings,
    focal_distance,
    lost_distances,
    paths_from,
    turns_over,
)
from semispline.solver.topology.self_meeting import meeting_distance
from semispline.solver.topology.swept import distance_to, finer
from semispline.solver.topology.trim_curves import TrimCurve

_PARAMETER = re.compile(r"([uv])=(.+)")
# Paths of which the face's limits are told; places of a free contact between which it is interpolated.
_PATHS, _AGAIN, _PLACES, _DEGREE = 41, 5, 161, 5
# Divisions to the end of a free contact, and parts of each: 40 bisections' worth, a step far below any tolerance.
_DIVISIONS, _PARTS = 8, 32
# More places where these are too few: the curve between them may be off by this share of what a gap may be.
_MOST_PLACES, _SHARE, _NEWTON = 2600, 0.1, 4
# Of the range of a parameter: what is nearer to an end means the end.
_SNAP = 1e-9
# Of the size of a face: what is farther is hardly in it; where one begins to look how far it goes, and how closely.
_FAR, _NEAREST = 2.0, 1e-3
# Times a distance: so far one looks, as what is met between paths may be a little nearer than it seems.
_FURTHER = 1.02
_BEYOND, _OVER_A_POLE, _TO_ITSELF = "beyond the face", "over a pole of the face", "round the face to itself"
_INTERVALS = 16
_GAUSS = np.polynomial.legendre.leggauss(6)
# Times that lengths of chords are made lengths of the curve through their ends.
_REFINED = 8
# Ends of an edge that are this near, of the size, are one point.
_CLOSED = 1e-6


@dataclass(frozen=True)
class Cut:
    """How far a contact moves into its face.

    Attributes
    ----------
    distance : float or None
        Model units.
    direction : {"u", "v"} or None
    parameter : float or None
        Of the line that it moves to, in place of a distance.
    """

    distance: float | None = None
    direction: str | None = None
    parameter: float | None = None


def parse_cut(word: str, name: str = "cut") -> Cut:
    """Return what "2.5" or "u=0.3" means.

    Raises
    ------
    OptionError

    Examples
    --------
    >>> parse_cut("2.5"), parse_cut("u=0.3")
    (Cut(distance=2.5, direction=None, parameter=None), Cut(distance=None, direction='u', parameter=0.3))
    """
    found = _PARAMETER.fullmatch(word.strip())
    try:
        value = float(found[2] if found else word)
    except ValueError:
        value = float("nan")
    if not isfinite(value) or (found is None and value <= 0):
        raise OptionError(
            f"{name}: found {word!r}, expected a distance above 0 in model units, as 2.5, or a parameter, as u=0.3"
        )
    return Cut(direction=found[1], parameter=value) if found else Cut(distance=value)


@dataclass(frozen=True, eq=False)
class MovedContact:
    """Where a contact moved to.

    Attributes
    ----------
    name : EdgeName or None
        A line of constant parameter.
    curve : TrimCurve or None
        Where it is none: a free curve in the face.
    said : str
    """

    name: EdgeName | None
    curve: TrimCurve | None
    said: str


def moved_contact(
    surface: BSplineSurface,
    edge: str | EdgeName | None,
    cut: Cut,
    outline: Outline,
    tolerance: float,
    title: str,
    word: str,
    millimetres: float | None = None,
) -> MovedContact:
    """Return a contact moved into its face.

    Parameters
    ----------
    surface : BSplineSurface
    edge : str, EdgeName or None
        None for a free curve: `outline.trim`.
    cut : Cut
    outline : Outline
        Of the face, in the parameters of the surface.
    tolerance : float
        The length within which a contact is a line of constant parameter.
    title : str
        How messages begin.
    word : str
        What the edge is called.
    millimetres : float, optional
        In a model unit, where that is known.

    Raises
    ------
    EdgeError
        The face does not reach so far: the largest possible distance or parameter is said.
    """
    name = None if edge is None else parse_edge(edge)
    face = Face(surface)
    curve = _named_curve(surface, name) if name is not None else _trim_curve(outline, title)
    if cut.parameter is not None:
        if name is None:
            raise EdgeError(f"{title}: the edge is a free curve, along which no parameter is constant; give a distance")
        found, inside = _to_parameter(face, name, cut, outline, title), ""
    else:
        assert cut.distance is not None
        found, inside = _to_distance(face, curve, name, cut.distance, outline, tolerance, millimetres, title)
    if isinstance(found, EdgeName):
        return MovedContact(found, None, f"{found}{inside}")
    moved_by = "" if cut.distance is None else f" {cut.distance:g} into its face"
    free = TrimCurve(
        name=f"edge {word} moved{moved_by}",
        surface=surface,
        edge=None,
        pcurve=found,
        keep="left" if curve.sign > 0 else "right",
        tolerance=0.0,
        millimetres=millimetres,
    )
    return MovedContact(None, free, f"a free curve{inside}")


def _to_distance(
    face: Face,
    curve: _Curve,
    name: EdgeName | None,
    distance: float,
    outline: Outline,
    tolerance: float,
    millimetres: float | None,
    title: str,
) -> tuple[EdgeName | BSplineCurve, str]:
    """Return the line, or the curve in the parameters, that a contact is moved to, and what is said of it."""
    # Of a closed curve the first places come again a turn later.
    inside = curve.ends[0] + (np.arange(_PATHS + _AGAIN * curve.closed) + 0.5) / _PATHS * np.ptp(curve.ends)
    paths = _checked_paths(face, curve, inside, distance, outline, title)
    said = f", {distance:g} inside"
    if name is not None:
        axis = 0 if name.direction == "u" else 1
        last = paths.at[-1]
        speed = np.linalg.norm(face.jet(last, 1)[(1, 0) if axis == 0 else (0, 1)], axis=1)
        if (np.abs(last[:, axis] - last[_PATHS // 2, axis]) * speed).max() <= tolerance:
            value = _exactly(face, paths, axis, distance)
            return _line(face, name, value, float(last[_PATHS // 2, 1 - axis]), outline, title), said
    through = _fine_enough(face, curve, distance, outline, millimetres, title)
    points = np.column_stack([through.c, np.zeros(len(through.c))])
    return BSplineCurve(_DEGREE, through.t, points), said


@dataclass(frozen=True, eq=False)
class _Curve:
    """An edge in the parameters of its face."""

    ends: tuple[float, float]
    sign: float
    spline: BSplineCurve
    closed: bool

    def paths(self, face: Face, x: FloatArray, distance: float) -> Paths:
        """Return the paths from places of the edge into the face; of a closed one they may be a turn later."""
        (first, last), turns = self.ends, np.zeros(len(x))
        if self.closed:
            turns = np.floor((x - first) / (last - first))
            # Its end is not the start of the next turn.
            turns[x == last] = 0.0
            x = x - turns * (last - first)
        at, slope = (self.spline.evaluate(x, order)[:, :2] for order in (0, 1))
        ends = self.spline.evaluate(np.array([first, last]))[:, :2]
        return paths_from(face, at + turns[:, None] * (ends[1] - ends[0]), slope, self.sign, distance)

    def run_out(self, face: Face, x: FloatArray, distance: float, outline: Outline) -> NDArray[np.bool_]:
        """Tell which paths come to an edge of the face at an end of this one first."""
        met = crossings(self.paths(face, x, distance), outline.ends, outline.periods)
        return np.asarray(met.min(axis=0, initial=np.inf) <= distance)

    def end_inside(self, face: Face, inside: float, outside: float, distance: float, outline: Outline) -> float:
        """Return the last place, towards an end, whose path stays inside."""
        if not self.run_out(face, np.array([outside + _SNAP * (inside - outside)]), distance, outline)[0]:
            return outside
        # Many paths at once take little longer than one.
        for _ in range(_DIVISIONS):
            x = np.linspace(inside, outside, _PARTS + 1)
            first = int(np.argmax(np.append(self.run_out(face, x[1:-1], distance, outline), True)))
            inside, outside = float(x[first]), float(x[first + 1])
        return inside


def _named_curve(surface: BSplineSurface, name: EdgeName) -> _Curve:
    axis = 0 if name.direction == "u" else 1
    value = surface.domain[axis][name.end] if name.at is None else name.at
    low, high = name.part or surface.domain[1 - axis]
    points = np.zeros((2, 3))
    points[:, axis], points[:, 1 - axis] = value, (low, high)
    # Larger u lies right of a line that runs with v, larger v left of one that runs with u.
    sign = (1.0 if name.end == 0 else -1.0) * (-1.0 if axis == 0 else 1.0)
    spline = BSplineCurve(1, np.array([low, low, high, high]), points)
    return _Curve((low, high), sign, spline, closed=False)


def _trim_curve(outline: Outline, title: str) -> _Curve:
    trim = outline.trim
    if trim is None or trim.pcurve is None:
        raise EdgeError(f"{title}: the file shows no curve in the parameters of the face, from which to measure")
    first, last = float(trim.pcurve.knots[0]), float(trim.pcurve.knots[-1])
    face = Face(trim.surface)
    ends = face.jet(trim.pcurve.evaluate(np.array([first, last]))[:, :2], 0)[0, 0]
    closed = bool(np.linalg.norm(ends[0] - ends[1]) <= _CLOSED * face.size)
    return _Curve((first, last), 1.0 if trim.keep == "left" else -1.0, trim.pcurve, closed)


def _checked_paths(face: Face, curve: _Curve, x: FloatArray, distance: float, outline: Outline, title: str) -> Paths:
    """Return the paths from places of an edge; refuse a distance that leaves the face, or at which they have crossed.

    Steps of a distance that is far too large tell nothing: how far one can go is found by doubling a small one.
    """
    good, tried = 0.0, distance if distance <= _FAR * face.size else _NEAREST * face.size
    reach, why = _reach(face, curve, x, tried, outline)
    if tried == distance:
        if distance < reach:
            return curve.paths(face, x, distance)
        tried = min(_NEAREST * face.size, distance / 2)
        reach, why = _reach(face, curve, x, tried, outline)
    while tried < reach:
        if tried == distance:
            return curve.paths(face, x, distance)
        good, tried = tried, min(2 * tried, distance)
        reach, why = _reach(face, curve, x, tried, outline)
    # Where paths are lost is known by steps alone, and what was passed before is no end.
    while not (reach > good and why != _OVER_A_POLE) and tried - good > _NEAREST * tried:
        middle = (good + tried) / 2
        further, then = _reach(face, curve, x, middle, outline)
        good, tried, why = (middle, tried, why) if middle < further else (good, middle, then)
        reach = good
    raise EdgeError(f"{title}: {distance:g} reaches {why}, expected a distance below {reach:.4g}")


def _reach(face: Face, curve: _Curve, x: FloatArray, distance: float, outline: Outline) -> tuple[float, str]:
    """Return the distance at which paths leave the face or cross, or all have run out, and what is there.

    It is infinite, or larger than the distance that one looks at, where they do not.
    """

    def paths_at(x: FloatArray, far: float) -> Paths:
        return curve.paths(face, x, far)

    far, periods = _FURTHER * distance, outline.periods
    # Beside its ends only holes can lie between paths: other edges run there along those that end the face.
    more = bool(outline.holes) and not curve.closed
    wide = np.concatenate([curve.ends[:1], x, curve.ends[1:]]) if more else x
    swept = paths_at(wide, far)
    paths = swept.between(1, -1) if more else swept
    first = crossings(paths, outline.ends, periods).min(axis=0, initial=np.inf)
    # An edge that touches this one and is met between paths that go on ends nothing: the face ends there.
    inner = first < np.minimum(np.maximum.accumulate(first), np.maximum.accumulate(first[::-1])[::-1])
    beyond = float(np.where(inner, first, np.inf).min())
    own = crossings(paths, outline.own, periods, again=True).min(axis=0, initial=np.inf)
    again, pole = (float(np.where(x < first, x, np.inf).min()) for x in (own, lost_distances(face, paths)))
    round_ = _PATHS if curve.closed else None
    itself = meeting_distance(paths, x, paths_at, periods, round_, first)
    # Where all run out at the ends the contact has shrunk to nothing.
    nothing = float(first.max())
    largest = min(
        beyond, nothing, focal_distance(paths), distance_to(paths, x, paths_at, outline.others, outline.ends, periods)
    )
    largest = min(largest, distance_to(swept, wide, paths_at, outline.holes, outline.ends, periods))
    return min((largest, _BEYOND), (min(again, itself), _TO_ITSELF), (pole, _OVER_A_POLE))


def _to_parameter(face: Face, name: EdgeName, cut: Cut, outline: Outline, title: str) -> EdgeName | BSplineCurve:
    """Return a contact moved to a line of constant parameter."""
    assert cut.parameter is not None
    if cut.direction != name.direction:
        raise EdgeError(f"{title}: found {cut.direction}, but along the edge {name} {name.direction} is constant")
    axis, at = (0 if name.direction == "u" else 1), cut.parameter
    domain = face.surface.domain
    edge = domain[axis][name.end] if name.at is None else name.at
    low, high = name.part or domain[1 - axis]
    into = 1.0 if name.end == 0 else -1.0
    # Round a closed surface the edge itself is met.
    period = float(outline.periods[axis])
    reach = period or np.inf
    for value in low + (np.arange(_PATHS) + 0.5) / _PATHS * (high - low):
        ends, others = (_met(outline, lines, 1 - axis, value, edge, into) for lines in (outline.ends, outline.beyond))
        reach = min(reach, others if others < ends else np.inf)
    middle = (low + high) / 2
    reach = min(reach, _met(outline, outline.ends, 1 - axis, middle, edge, into))
    # Between those lines.
    half = (high - low) / (2 * _PATHS)
    reach = min(
        reach,
        _least_along(outline, outline.others, axis, edge, into, (low + half, high - half)),
        _least_along(outline, outline.holes, axis, edge, into, (low, high)),
    )
    if period and not 0 < (at - edge) * into < reach and domain[axis][0] <= at <= domain[axis][1]:
        at += into * period
    if not 0 < (at - edge) * into < reach:
        first, last = sorted((edge, edge + into * reach))
        raise EdgeError(
            f"{title}: {cut.direction}={cut.parameter:g} lies beyond the face, expected {cut.direction} between "
            f"{first:.6g} and {last:.6g}"
        )
    return _line(face, name, at, middle, outline, title)


def _least_along(
    outline: Outline, lines: Sequence[FloatArray], axis: int, edge: float, into: float, part: tuple[float, float]
) -> float:
    """Return how far into a face, from a part of a line of constant parameter, the nearest points of polylines lie."""
    nearest, low, high = np.inf, np.empty(2), np.empty(2)
    low[1 - axis], high[1 - axis] = part
    low[axis], high[axis] = sorted((edge, edge + into * (float(outline.periods[axis]) or np.inf)))
    for line in lines:
        for turn in turns_over(line, outline.periods, low, high):
            points = line + turn
            away = into * (points[:, axis] - edge)
            inside = (away > 0) & (points[:, 1 - axis] > part[0]) & (points[:, 1 - axis] < part[1])
            for row in np.flatnonzero(inside)[np.argsort(away[inside])]:
                if away[row] >= nearest:
                    break
                value = float(points[row, 1 - axis])
                if away[row] < _met(outline, outline.ends, 1 - axis, value, edge, into):
                    nearest = float((into * (finer(points, points[row], outline.periods)[:, axis] - edge)).min())
                    break
    return nearest


def _exactly(face: Face, paths: Paths, axis: int, distance: float) -> float:
    """Return the parameter at a distance from the middle of an edge, by quadrature where the path is a cross line."""
    path = paths.at[:, _PATHS // 2]
    start, end, beside = float(path[0, axis]), float(path[-1, axis]), float(path[0, 1 - axis])
    if np.abs(path[:, 1 - axis] - beside).max() > _SNAP * face.widths[1 - axis]:
        return end

    def speed(value: FloatArray) -> FloatArray:
        at = np.full((len(value), 2), beside)
        at[:, axis] = value
        return np.asarray(np.linalg.norm(face.jet(at, 1)[(1, 0) if axis == 0 else (0, 1)], axis=1))

    turns = np.arange(-1.0, 2.0)[:, None] * face.periods[axis]
    breaks = np.unique(face.surface.breakpoints[axis] + turns)

    def missing(value: float) -> float:
        low, high = sorted((start, value))
        nodes = np.unique([low, *breaks[(breaks > low) & (breaks < high)], *np.linspace(low, high, _INTERVALS), high])
        return float(sum(fixed_quad(speed, a, b, n=8)[0] for a, b in pairwise(nodes))) - distance

    margin = 1e-3 * (end - start)
    if missing(end - margin) * missing(end + margin) >= 0:
        return end
    return float(brentq(missing, end - margin, end + margin, xtol=1e-15 * abs(end - start)))


def _line(
    face: Face, name: EdgeName, at: float, middle: float, outline: Outline, title: str
) -> EdgeName | BSplineCurve:
    """Return the name of a line, as far as the edges of the face at both sides of its middle.

    Where it runs past the end of its edge without meeting the next one, at a corner that juts into the face, it ends
    beside that end. A line that runs over the seam of the surface has no name: it is returned as a curve.
    """
    axis = 0 if name.direction == "u" else 1
    first, last = face.surface.domain[1 - axis]
    own, period = name.part or (first, last), float(outline.periods[1 - axis])

    def reach(sign: float) -> float:
        ends, others = (_met(outline, lines, axis, at, middle, sign) for lines in (outline.ends, outline.beyond))
        beside = sign * (own[1 if sign > 0 else 0] - middle)
        return ends if np.isfinite(ends) and ends <= others else min(others, beside)

    low, high = middle - reach(-1.0), middle + reach(1.0)
    near = _SNAP * (last - first)
    if not high - low > near:
        raise EdgeError(f"{title}: the face has no width there")
    if period and high - low >= period - near:
        low, high = first, last
    turns = np.floor((low + near - first) / period) * period if period else 0.0
    low, high = low - turns, high - turns
    if period and high > last + near:
        points = np.zeros((2, 3))
        points[:, axis], points[:, 1 - axis] = at, (low, high)
        return BSplineCurve(1, np.array([low, low, high, high]), points)
    low, high = (first if low <= first + near else low), (last if high >= last - near else high)
    return EdgeName(
        name.direction,
        name.end,
        _within(face, axis, at, name.end, outline),
        None if (low, high) == (first, last) else (low, high),
    )


def _within(face: Face, axis: int, at: float, end: int, outline: Outline) -> float | None:
    """Return a parameter in the turn that the surface has; None for its own end, at which the edge is a natural one."""
    (first, last), period = face.surface.domain[axis], float(outline.periods[axis])
    if not period:
        return at
    at = first + (at - first) % period
    return None if min(at - first, last - at) <= _SNAP * period else at


def _met(outline: Outline, lines: Sequence[FloatArray], axis: int, at: float, start: float, sign: float) -> float:
    """Return how far from `start`, in a direction along a line of constant parameter, polylines are met first."""
    nearest = np.inf
    low, high = np.empty(2), np.empty(2)
    low[axis] = high[axis] = at
    low[1 - axis], high[1 - axis] = sorted((start, start + sign * outline.periods[1 - axis]))
    for line in lines:
        for turn in turns_over(line, outline.periods, low, high):
            off, along = line[:, axis] + turn[axis] - at, line[:, 1 - axis] + turn[1 - axis]
            rows = np.flatnonzero((off[:-1] <= 0) != (off[1:] <= 0))
            share = off[rows] / (off[rows] - off[rows + 1])
            away = sign * (along[rows] + share * (along[rows + 1] - along[rows]) - start)
            nearest = min(nearest, float(away[away > 0].min(initial=np.inf)))
    return nearest


def _through(face: Face, at: FloatArray) -> tuple[Any, FloatArray]:
    """Return a spline through parameters and where it meets them.

    By lengths in space: the edge's own parameter may be no smoother than C1.
    """
    points = face.jet(at, 0)[0, 0]
    s = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    for _ in range(_REFINED):
        slope = make_interp_spline(s, points, _DEGREE).derivative()
        half, middle = np.diff(s) / 2, (s[1:] + s[:-1]) / 2
        speeds = np.linalg.norm(slope(middle[:, None] + half[:, None] * _GAUSS[0]), axis=2)
        s = np.append(0.0, np.cumsum(half * (speeds @ _GAUSS[1])))
    return make_interp_spline(s, at, _DEGREE), s


def _fine_enough(
    face: Face, curve: _Curve, distance: float, outline: Outline, millimetres: float | None, title: str
) -> Any:
    """Return a spline through parameters at a distance from an edge that is as far from it between its places.

    Beside a pole the parameters turn much faster than the curve.
    """
    start, end = _inside(face, curve, distance, outline)
    x = np.linspace(start, end, _PLACES)
    at = curve.paths(face, x, distance).at[-1]
    if curve.closed:
        # The curve ends where it began, perhaps a turn later.
        ends = curve.spline.evaluate(x[[0, -1]])[:, :2]
        at[-1] = at[0] + ends[1] - ends[0]
    while len(x) < _MOST_PLACES:
        spline, s = _through(face, at)
        middles = (x[1:] + x[:-1]) / 2
        between = curve.paths(face, middles, distance)
        if _off_spline(face, spline, between.point[-1], s) <= _SHARE * cad_measures(float(s[-1]), millimetres)["gap"]:
            return spline
        rows = np.arange(1, len(x))
        x, at = np.insert(x, rows, middles), np.insert(at, rows, between.at[-1], axis=0)
    raise EdgeError(
        f"{title}: at {distance:g} the contact bends too sharply in the parameters of the face, as beside a pole, "
        "expected a smaller distance"
    )


def _off_spline(face: Face, spline: Any, points: FloatArray, at: FloatArray) -> float:
    """Return the largest distance of points from a spline in the parameters; each lies between two of its places."""
    slope, s = spline.derivative(), (at[1:] + at[:-1]) / 2
    for _ in range(_NEWTON):
        jet, turn = face.jet(spline(s), 1), slope(s)
        tangent = jet[1, 0] * turn[:, :1] + jet[0, 1] * turn[:, 1:]
        s = np.clip(s + dot(points - jet[0, 0], tangent) / dot(tangent, tangent), at[:-1], at[1:])
    return float(np.linalg.norm(points - face.jet(spline(s), 0)[0, 0], axis=1).max())


def _inside(face: Face, curve: _Curve, distance: float, outline: Outline) -> tuple[float, float]:
    """Return the places of an edge between which paths of a distance do not meet the edges at its ends."""
    start, end = curve.ends
    if curve.closed:
        return start, end
    inside = start + (np.arange(_PATHS) + 0.5) / _PATHS * (end - start)
    kept = inside[~curve.run_out(face, inside, distance, outline)]
    return (
        curve.end_inside(face, float(kept[0]), start, distance, outline),
        curve.end_inside(face, float(kept[-1]), end, distance, outline),
    )
