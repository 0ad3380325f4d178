"""How sharply a surface turns: the largest angle between normals that are one window apart along a section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.sections import (
    angles,
    closed_directions,
    no_tangent_plane,
    spread,
    turn_window,
    unit_normals,
)

# A surface whose normal turns by more than this within one window is folded.
FOLD_DEGREES = 90.0
# Steps along a section are at most this part of a window.
_STEPS_IN_WINDOW = 4
# Sections altogether, and at least in each span; steps in each span before long ones are divided.
_SECTIONS, _SECTIONS_IN_SPAN, _STEPS_IN_SPAN = 40, 3, 8
# A single step is divided into no more than these, and so many samples are held at once.
_MOST_PARTS, _AT_ONCE = 64, 2**17


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
    return turn_on_samples(surface, 1)


def turn_on_samples(surface: ParametricSurface, fineness: int) -> Turn:
    """Return the largest turn on `fineness` times the usual samples along sections, and as many times the sections."""
    window = turn_window(surface)
    closed_u, closed_v = closed_directions(surface)
    along_u = _largest(surface, "v", window, closed_u, fineness)
    along_v = _largest(surface, "u", window, closed_v, fineness)
    largest = max(along_u, along_v, key=lambda turn: turn.degrees)
    if largest.degrees < 0:
        raise no_tangent_plane()
    return largest


def _largest(
    surface: ParametricSurface, section: Literal["u", "v"], window: float, closed: bool, fineness: int
) -> Turn:
    u_breaks, v_breaks = surface.breakpoints
    run_breaks, section_breaks = (u_breaks, v_breaks) if section == "v" else (v_breaks, u_breaks)
    at = spread(section_breaks, _SECTIONS * fineness, _SECTIONS_IN_SPAN * fineness)

    def values(run: FloatArray, at: FloatArray, of_u: int = 0, of_v: int = 0) -> FloatArray:
        """Return points or derivatives, shape (sections, samples, 3)."""
        if section == "v":
            return surface.evaluate_grid(run, at, of_u, of_v).transpose(1, 0, 2)
        return surface.evaluate_grid(at, run, of_u, of_v)

    run = spread(run_breaks, _STEPS_IN_SPAN)
    # Some sections tell where steps are long: parameters may be uneven within a span.
    for _ in range(2):
        steps = np.linalg.norm(np.diff(values(run, at[:: 4 * fineness]), axis=1), axis=-1).max(axis=0)
        run = _divided(run, np.clip(np.ceil(steps * _STEPS_IN_WINDOW / window), 1, _MOST_PARTS).astype(int))
    run = _divided(run, np.full(len(run) - 1, fineness))
    best = Turn(-1.0, section, float(at[0]), (float(run[0]), float(run[0])), (0.0, 0.0, 0.0), window)
    some = max(1, _AT_ONCE // len(run))
    for first in range(0, len(at), some):
        these = at[first : first + some]
        points = values(run, these)
        normals = unit_normals(values(run, these, 1, 0), values(run, these, 0, 1))
        degrees, (k, i), end = _largest_of_sections(run, points, normals, window, closed)
        if degrees > best.degrees:
            x, y, z = points[k, i].tolist()
            best = Turn(degrees, section, float(these[k]), (float(run[i]), end), (x, y, z), window)
    return best


def _divided(run: FloatArray, parts: np.ndarray) -> FloatArray:
    """Return the parameters with each step divided evenly into so many parts."""
    before = np.repeat(np.cumsum(parts) - parts, parts)
    share = (np.arange(int(parts.sum())) - before) / np.repeat(parts, parts)
    return np.append(np.repeat(run[:-1], parts) + share * np.repeat(np.diff(run), parts), run[-1])


def _largest_of_sections(
    run: FloatArray, points: FloatArray, normals: FloatArray, window: float, closed: bool
) -> tuple[float, tuple[int, int], float]:
    """Return the largest turn, the indices of section and first point, and the parameter of the second point."""
    length: FloatArray = np.zeros(points.shape[:2])
    np.cumsum(np.linalg.norm(np.diff(points, axis=1), axis=-1), axis=1, out=length[:, 1:])
    starts, total = length, length[:, -1:]
    reach = np.minimum(window, total / 2 if closed else total)
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
    share = (place - low)[:, None]
    flat = normals.reshape(-1, 3)
    # At a sample the next normal has no say: it may be missing.
    ahead = np.where(share < 1, (1 - share) * flat[low], 0.0) + np.where(share > 0, share * flat[low + 1], 0.0)
    turns = angles(normals[:, : starts.shape[1]], ahead.reshape(*starts.shape, 3))
    # Rounding may put the end of a short section just beyond itself.
    inside = starts + reach <= length[:, -1:] * (1 + 1e-12)
    turns = np.where(inside, np.nan_to_num(turns, nan=-1.0), -1.0)
    k, i = divmod(int(turns.argmax()), turns.shape[1])
    at = int(low[k * turns.shape[1] + i]) - k * length.shape[1]
    start, end = float(run[at]), float(run[min(at + 1, len(run) - 1)])
    # From the seam a step leads on from its start.
    beyond = float(share[k * turns.shape[1] + i, 0]) * (end - start) if end > start else 0.0
    return float(turns[k, i]), (k, i), start + beyond
