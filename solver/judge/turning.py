"""How sharply a surface turns: the largest angle between normals that are one window apart along a section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.bezier_pieces import in_pieces
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import (
    angles,
    closed_directions,
    lengths,
    no_tangent_plane,
    spread,
    turn_window,
    unit_normals,
)

# A surface whose normal turns by more than this within one window is folded.
FOLD_DEGREES = 90.0
# Steps along a section are at most this part of a window; where it turns most they are parted once more.
_STEPS_IN_WINDOW, _FINER = 2, 4
# Sections altogether, and at least in each span; steps in each span before long ones are divided.
_SECTIONS, _SECTIONS_IN_SPAN, _STEPS_IN_SPAN = 12, 3, 8
# The places that are looked at closely, how often, into how many parts the sections beside each are parted, and how
# much of the largest turn there must be.
_CLOSELY, _TIMES, _PARTS_BESIDE, _NEARLY = 3, 2, 4, 0.75
# A single step is divided into no more than these, and so many samples are held at once.
_MOST_PARTS, _AT_ONCE = 64, 2**15


@dataclass(frozen=True)
class Turn:
    """The largest turn of a surface, and where.

    Attributes
    ----------
    degrees : float
        Angle between the normals at two points of one section that lie `window` apart along it.
    section : {"u", "v"}
        Which parameter is constant on that section.
    at : float
        Its value.
    between : tuple of float
        The other parameter at the two points; of a closed section the second may be the smaller.
    point : tuple of float
        The first of them, in space.
    window : float
        1/50 of the mean length of the sections v = const.
    """

    degrees: float
    section: Literal["u", "v"]
    at: float
    between: tuple[float, float]
    point: tuple[float, float, float]
    window: float

    @property
    def is_fold(self) -> bool:
        """Whether the surface folds back: it turns by more than 90 degrees."""
        return self.degrees > FOLD_DEGREES


def measure_turn(surface: ParametricSurface) -> Turn:
    """Return the largest angle between the normals at two points of one section that lie one window h apart along it.

    Sections are u = const and v = const; h is 1/50 of the mean length of the sections v = const. So an even bend of
    100 degrees turns by 2, and one that is fifteen times as sharp somewhere by 30. Of a section shorter than h the ends
    count; closed ones run on over the seam. Points without a normal are passed over.

    Raises
    ------
    InputError
        The sections v = const have no length, or the surface has no tangent plane anywhere.

    Source: the measures of the design document.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> roof = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]], [[2, 0, 0], [2, 1, 0]]]
    >>> turn = measure_turn(BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], roof))
    >>> round(turn.degrees, 9), turn.section, turn.is_fold
    (90.0, 'v', False)
    """
    return turn_on_samples(in_pieces(surface), 1)


def turn_on_samples(surface: ParametricSurface, fineness: int) -> Turn:
    """Return the largest turn on `fineness` times the usual samples along sections, and as many times the sections."""
    window = turn_window(surface)
    closed_u, closed_v = closed_directions(surface)
    looks = [
        look
        for sections in (
            _Sections(surface, "v", window, closed_u),
            _Sections(surface, "u", window, closed_v),
        )
        for look in _first_looks(sections, fineness)
    ]
    looks.sort(key=lambda look: look.turn.degrees, reverse=True)
    if looks[0].turn.degrees < 0:
        raise no_tangent_plane()
    # It may turn more between the samples of where it turns most.
    chosen: list[_Look] = []
    for look in looks:
        much = look.turn.degrees > _NEARLY * looks[0].turn.degrees
        if much and len(chosen) < _CLOSELY and not any(look.is_beside(other) for other in chosen):
            chosen.append(look)
    for first in chosen:
        look = first
        for _ in range(_TIMES):
            look = look.sections.closely(look, fineness)
            looks.append(look)
    return max((look.turn for look in looks), key=lambda turn: turn.degrees)


@dataclass(frozen=True, eq=False)
class _Look:
    """The largest turn of one section on samples `run`, with the sections beside it and the sample where it begins."""

    turn: Turn
    sections: _Sections
    run: FloatArray
    beside: FloatArray
    at: int

    def is_beside(self, other: _Look) -> bool:
        """Tell whether it is on a section that looking closely at the other one takes in."""
        same = self.sections is other.sections
        return same and bool(other.beside[0] <= self.turn.at <= other.beside[-1])


def _first_looks(sections: _Sections, fineness: int) -> list[_Look]:
    """Return the largest turn of each section, on samples."""
    u_breaks, v_breaks = sections.surface.breakpoints
    run_breaks, section_breaks = (u_breaks, v_breaks) if sections.section == "v" else (v_breaks, u_breaks)
    at = spread(section_breaks, _SECTIONS * fineness, _SECTIONS_IN_SPAN * fineness)
    run = sections.run(spread(run_breaks, _STEPS_IN_SPAN), at[:: 2 * fineness])
    run = _divided(run, np.full(len(run) - 1, fineness))
    looks = []
    some = max(1, _AT_ONCE // len(run))
    for first in range(0, len(at), some):
        found = sections.turns(run, at[first : first + some])
        for k, i in enumerate(found.degrees.argmax(axis=1).tolist()):
            turn = sections.turn(found, (k, i))
            looks.append(_Look(turn, sections, run, at[max(first + k - 1, 0) : first + k + 2], i))
    return looks


@dataclass(frozen=True, eq=False)
class _Turns:
    """Turns from samples `run` of the sections `at`: points, degrees (-1: none) and the parameters where they end."""

    run: FloatArray
    at: FloatArray
    points: FloatArray
    degrees: FloatArray
    ends: FloatArray


@dataclass(frozen=True, eq=False)
class _Sections:
    """The sections of a surface in one direction."""

    surface: ParametricSurface
    section: Literal["u", "v"]
    window: float
    closed: bool

    def values(self, run: FloatArray, at: FloatArray, of_u: int = 0, of_v: int = 0) -> FloatArray:
        """Return points or derivatives, shape (sections, samples, 3)."""
        if self.section == "v":
            return self.surface.evaluate_grid(run, at, of_u, of_v).transpose(1, 0, 2)
        return self.surface.evaluate_grid(at, run, of_u, of_v)

    def run(self, run: FloatArray, at: FloatArray) -> FloatArray:
        """Return parameters along the sections `at`, divided until steps are short: they may be uneven in a span."""
        for _ in range(2):
            steps = lengths(np.diff(self.values(run, at), axis=1)).max(axis=0)
            parts = np.clip(np.ceil(steps * _STEPS_IN_WINDOW / self.window), 1, _MOST_PARTS)
            run = _divided(run, parts.astype(int))
        return run

    def turns(self, run: FloatArray, at: FloatArray) -> _Turns:
        """Return the turns from each sample of each section."""
        points = self.values(run, at)
        normals = unit_normals(self.values(run, at, 1, 0), self.values(run, at, 0, 1))
        return _Turns(run, at, points, *_turns_of_sections(run, points, normals, self.window, self.closed))

    def turn(self, turns: _Turns, place: tuple[int, int]) -> Turn:
        """Return one of these turns."""
        k, i = place
        x, y, z = turns.points[k, i].tolist()
        between = float(turns.run[i]), float(turns.ends[k, i])
        return Turn(float(turns.degrees[k, i]), self.section, float(turns.at[k]), between, (x, y, z), self.window)

    def closely(self, look: _Look, fineness: int) -> _Look:
        """Return the largest turn around another one: on more sections beside it, in shorter steps."""
        at = np.array([look.turn.at])
        length = np.append(0.0, np.cumsum(lengths(np.diff(self.values(look.run, at)[0], axis=0))))
        # From one window before it to where a window ends that begins one window after it.
        low, high = np.searchsorted(length, length[look.at] + self.window * np.array([-1.0, 2.5]))
        near = look.run[max(int(low) - 1, 0) : int(high) + 2]
        near = _divided(near, np.full(len(near) - 1, _FINER * fineness))
        beside = _divided(look.beside, np.full(len(look.beside) - 1, _PARTS_BESIDE * fineness))
        # Away from its ends a section is open; what turns across the seam is left to the first look.
        part = _Sections(self.surface, self.section, self.window, closed=False)
        turns = part.turns(near, beside)
        k, i = divmod(int(turns.degrees.argmax()), turns.degrees.shape[1])
        return _Look(self.turn(turns, (k, i)), part, near, beside[max(k - 1, 0) : k + 2], i)


def _divided(run: FloatArray, parts: np.ndarray) -> FloatArray:
    """Return the parameters with each step divided evenly into so many parts."""
    before = np.repeat(np.cumsum(parts) - parts, parts)
    share = (np.arange(int(parts.sum())) - before) / np.repeat(parts, parts)
    return np.append(np.repeat(run[:-1], parts) + share * np.repeat(np.diff(run), parts), run[-1])


def _turns_of_sections(
    run: FloatArray, points: FloatArray, normals: FloatArray, window: float, closed: bool
) -> tuple[FloatArray, FloatArray]:
    """Return the turn from each sample of each section over one window, -1 where there is none, and where that ends."""
    length: FloatArray = np.zeros(points.shape[:2])
    np.cumsum(lengths(np.diff(points, axis=1)), axis=1, out=length[:, 1:])
    starts, total = length, length[:, -1:]
    reach = np.minimum(window, total / 2 if closed else total)
    first = normals
    if closed:
        # Once more round, as far as a window reaches.
        more = int((length < reach).sum(axis=1).max()) + 1
        length = np.concatenate([length, total + length[:, 1:more]], axis=1)
        normals = np.concatenate([normals, normals[:, 1:more]], axis=1)
        run = np.concatenate([run, run[1:more]])
    # One after the other, far enough apart, all sections are one table.
    offset = 2 * (length[:, -1].max() + window) * np.arange(len(length))[:, None]
    place = np.interp((starts + reach + offset).ravel(), (length + offset).ravel(), np.arange(length.size))
    low = np.minimum(place.astype(np.intp), length.size - 2)
    share = place - low
    ahead = [
        # At a sample the next normal has no say: it may be missing.
        np.where(share < 1, (1 - share) * x[low], 0.0) + np.where(share > 0, share * x[low + 1], 0.0)
        for x in np.moveaxis(normals, -1, 0).reshape(3, -1)
    ]
    turns = angles(first, np.moveaxis(np.reshape(ahead, (3, *starts.shape)), 0, -1))
    # Rounding may put the end of a short section just beyond itself.
    inside = starts + reach <= length[:, -1:] * (1 + 1e-12)
    at = low.reshape(starts.shape) - length.shape[1] * np.arange(len(starts))[:, None]
    start, end = run[at], run[np.minimum(at + 1, len(run) - 1)]
    # From the seam a step leads on from its start.
    beyond = np.where(end > start, share.reshape(starts.shape) * (end - start), 0.0)
    return np.where(inside, np.nan_to_num(turns, nan=-1.0), -1.0), start + beyond
