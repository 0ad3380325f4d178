"""How the sections v = const leave their two ends, and whether they turn further than that asks for.

t = P_u / |P_u| along a section, chord = P(1, v) - P(0, v), theta_0 and theta_1 the angles between t at the two ends and
the chord. A section leaves one end along t(0) and the other along -t(1).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import angles, lengths, spread
from semispline.solver.splines import gauss_rule

# A section that turns by so much more than the biarc between its exits is a loop: 22 was the most among good blends, 78
# the least among those that meet themselves.
LOOP_DEGREES = 60.0
# Points along a section besides its ends; sections altogether, and in each span.
_POINTS, _POINTS_IN_SPAN = 32, 8
_SECTIONS, _SECTIONS_IN_SPAN = 20, 2
# Exits that leave the chord by less, in the mean sine, leave it to no side: a degree.
_NO_SIDE = 0.0175
# Of a unit vector, or of none.
_HALF = 0.5
# A section that is slower than this part of the fastest has no tangent there.
_NO_SPEED = 1e-12


@dataclass(frozen=True)
class Loop:
    """The section that turns furthest beyond what its exits need, and by how much.

    Attributes
    ----------
    degrees : float
        Turning of the section v less that of the biarc between its exits; the largest over v. Sections that meet
        themselves have more than 60, except for U-turns, where the exits may need a loop.
    v : float
    turning_degrees : float
        The total turning of that section, integral of |curvature|.
    needed_degrees : float
        That of the biarc between its exits.
    largest_turning_degrees : float
        The largest total turning of any section: below 180 no section meets itself.
    """

    degrees: float
    v: float
    turning_degrees: float
    needed_degrees: float
    largest_turning_degrees: float

    @property
    def is_loop(self) -> bool:
        """Whether that is above 60 degrees."""
        return self.degrees > LOOP_DEGREES


@dataclass(frozen=True)
class Exits:
    """How the sections leave their two ends, in the mean over v.

    Attributes
    ----------
    theta_0, theta_1 : float
        Angle between the way out and the straight way to the other end, in degrees.
    mean_cosine : float
        Of these angles, over both ends.
    sides : {"same", "opposite"} or None
        To which sides of the chord the exits lead; None where they follow it within a degree.
    side_cosine : float
        Cosine between the parts of the two exits that are square to the chord, weighted by their sizes; 0 for None.
    """

    theta_0: float
    theta_1: float
    mean_cosine: float
    sides: Literal["same", "opposite"] | None
    side_cosine: float

    @property
    def is_u_turn(self) -> bool:
        """Whether exits and chord disagree: the mean cosine is negative."""
        return self.mean_cosine < 0

    @property
    def must_loop(self) -> bool:
        """Whether it is a U-turn whose exits leave to opposite sides of the chord."""
        return self.is_u_turn and self.sides == "opposite"


def measure_loop(surface: ParametricSurface) -> Loop:
    """Return how much further a section v = const turns than the biarc between its two exits, at most over v.

    With a = theta_0 e_0 and b = theta_1 e_1, e_0 and e_1 the unit parts of t at the ends square to the chord, the biarc
    turns by |1.5 a + .5 b| + |1.5 b + .5 a|; theta - 360 in place of theta where that is less.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> net = [[[x, y, 0] for y in (0, 1)] for x in (0, 1, 2, 3)]
    >>> measure_loop(BSplineSurface(3, 1, [0, 0, 0, 0, 1, 1, 1, 1], [0, 0, 1, 1], net)).degrees
    0.0
    """
    u_breaks, v_breaks = surface.breakpoints
    number = max(_POINTS_IN_SPAN, -(-_POINTS // (len(u_breaks) - 1)))
    # Knots too: there a tangent may turn back.
    u = np.sort(np.concatenate([u_breaks, gauss_rule(u_breaks, 2 * number - 1)[0].ravel()]))
    return loop_on_samples(surface, u, spread(v_breaks, _SECTIONS, _SECTIONS_IN_SPAN))


def loop_on_samples(surface: ParametricSurface, u: FloatArray, v: FloatArray) -> Loop:
    """Return the loop measure of the sections v, their tangents taken at u, which begins and ends with the domain."""
    tangents = _tangents(surface.evaluate_grid(u, v, 1, 0))
    # A half-angle by its sine: no digits are lost between close tangents.
    steps = lengths(np.diff(tangents, axis=0)) / 2
    turning = np.degrees(2 * np.arcsin(np.minimum(steps, 1.0)).sum(axis=0))
    theta, side = _against_chord(surface, tangents, v)
    a, b = side

    def biarc(turn_0: float, turn_1: float) -> FloatArray:
        first, last = (theta[0] + turn_0)[:, None] * a, (theta[1] + turn_1)[:, None] * b
        return np.asarray(lengths(1.5 * first + 0.5 * last) + lengths(1.5 * last + 0.5 * first))

    needed = np.min([biarc(*turns) for turns in product((0.0, -360.0), repeat=2)], axis=0)
    i = int((turning - needed).argmax())
    return Loop(float(turning[i] - needed[i]), float(v[i]), float(turning[i]), float(needed[i]), float(turning.max()))


def measure_exits(surface: ParametricSurface) -> Exits:
    """Return how the sections v = const leave their ends, against the straight way to the other end.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> net = [[[x, y, z] for y in (0, 1)] for x, z in ((0, 0), (1, 1), (2, 1), (3, 0))]
    >>> exits = measure_exits(BSplineSurface(3, 1, [0, 0, 0, 0, 1, 1, 1, 1], [0, 0, 1, 1], net))
    >>> round(exits.theta_0, 9), exits.sides, exits.is_u_turn
    (45.0, 'same', False)
    """
    v = spread(surface.breakpoints[1], _SECTIONS, _SECTIONS_IN_SPAN)
    # What lies between is needed where an end has no tangent.
    slopes = surface.evaluate_grid(np.array(surface.domain[0]), v, 1, 0)
    if not (speed := lengths(slopes)).min() > _NO_SPEED * speed.max():
        slopes = surface.evaluate_grid(spread(surface.breakpoints[0], _POINTS), v, 1, 0)
    theta, (a, b) = _against_chord(surface, _tangents(slopes), v)
    cosine, (sine_0, sine_1) = np.cos(np.radians(theta)), np.sin(np.radians(theta))
    # The way out at the other end is -t.
    together, sizes = float(-(np.sum(a * b, axis=-1) * sine_0 * sine_1).mean()), float((sine_0 * sine_1).mean())
    told = min(float(sine_0.mean()), float(sine_1.mean())) > _NO_SIDE and together != 0
    theta_0, theta_1 = theta.mean(axis=1).tolist()
    return Exits(
        theta_0,
        theta_1,
        float(cosine.mean()),
        ("same" if together > 0 else "opposite") if told else None,
        float(np.clip(together / sizes, -1, 1)) if told else 0.0,
    )


def _tangents(pu: FloatArray) -> FloatArray:
    """Return unit tangents, shape (len(u), len(v), 3); where there is none, that of the nearest one before or after."""
    speed = lengths(pu)[..., None]
    missing = ~(speed > _NO_SPEED * speed.max())
    tangents: FloatArray = np.divide(pu, speed, out=np.zeros_like(pu), where=~missing)
    rows = range(len(pu) if missing.any() else 0)
    for row, neighbour in [*zip(rows[1:], rows, strict=False), *zip(rows[-2::-1], rows[:0:-1], strict=True)]:
        gaps = missing[row, :, 0] & ~missing[neighbour, :, 0]
        tangents[row, gaps], missing[row, gaps] = tangents[neighbour, gaps], False
    return tangents


def _against_chord(
    surface: ParametricSurface, tangents: FloatArray, v: FloatArray
) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return theta at both ends in degrees, shape (2, len(v)), and the unit parts of t square to the chord.

    A section that ends where it begins has no chord: both are zero, and what it turns is all a loop.
    """
    first, last = surface.evaluate_grid(np.array(surface.domain[0]), v)
    chord = last - first
    length = np.linalg.norm(chord, axis=-1, keepdims=True)
    whole = lengths(surface.evaluate_grid(spread(surface.breakpoints[0], 8), v) - first).max(axis=0)
    has_chord = length > 1e-9 * whole[:, None]
    chord = np.divide(chord, length, out=np.zeros_like(chord), where=has_chord)
    ends = tangents[0], tangents[-1]
    theta = np.stack([angles(t, chord) for t in ends])

    def side(t: FloatArray) -> FloatArray:
        square = t - np.sum(t * chord, axis=-1, keepdims=True) * chord
        size = np.linalg.norm(square, axis=-1, keepdims=True)
        unit: FloatArray = np.divide(square, size, out=np.zeros_like(square), where=has_chord & (size > 1e-12))
        return unit

    sides = side(ends[0]), side(ends[1])
    # Straight along the chord, or straight away from it: any side will do, and the least turn is that to the other one.
    missing = [has_chord & (lengths(x)[..., None] < _HALF) for x in sides]
    square = _any_square(chord)
    first = np.where(missing[0], np.where(missing[1], square, -sides[1]), sides[0])
    return theta, (first, np.where(missing[1], -first, sides[1]))


def _any_square(chord: FloatArray) -> FloatArray:
    """Return a unit vector square to each chord."""
    axis = np.eye(3)[np.abs(chord).argmin(axis=-1)]
    square = np.cross(chord, axis)
    return np.asarray(square / np.maximum(np.linalg.norm(square, axis=-1, keepdims=True), np.finfo(float).tiny))
