"""Where a surface has no proper normal along an edge: between samples too."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.judge.base import Base
from semispline.solver.judge.contact import NoNormal

# A derivative that falls to this part of its mean along the edge, or the sine of the angle between two: no normal that
# means anything, as an area element so small is as good as a fold.
VANISHES = 1e-3
# To this part it vanishes altogether: the sections find no less.
_NOTHING = 1e-9
# At a zero of a derivative between two samples its size there is below this part of the mean.
_SUSPECT = 0.5
_PER_SPAN = 8
# A bracket is divided into so many parts, of which two are the next bracket, so many times: to 1e-9 of itself. Places
# in one call cost little more than one.
_PARTS, _SECTIONS = 16, 10
# No value falls across a bracket by more than so many times the largest one: a spline of degree p by some p^2 / 2, and
# beside a span that is narrower than its neighbour by as many times more.
_STEEPEST = 1e5
_REASONS = (
    "the derivative across the edge vanishes",
    "the derivative along the edge vanishes",
    "the derivatives across and along the edge are parallel",
)


def places_without_normal(base: Base, surface: Literal["a", "b"]) -> tuple[NoNormal, ...]:
    """Return where a derivative at the edge almost vanishes, or the two are almost parallel, in order along the edge.

    Samples in every span find where to look; ever finer ones find the place. Of a whole stretch one place is named.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> fan = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [3, 0, 0]], [[0, 0, 0], [0, 3, 0]]])
    >>> print(*places_without_normal(Base(fan, "u0"), "a"))
    no proper normal at parameter 0, (0, 0, 0): the derivative across the edge vanishes
    """
    s = _samples(base)
    values = _sizes(base, s)
    means = _means(values)
    values /= means[:, None]
    found = []
    for kind, row in enumerate(values):
        for at, value in _lows(base, s, float(means[kind]), kind, row):
            x, y, z = base.derivative(np.array([at]), 0, 0)[0].tolist()
            found.append(NoNormal(surface, at, (x, y, z), _REASONS[kind], value))
    return tuple(sorted(found, key=lambda place: place.parameter))


def beside_poles(base: Base, s: FloatArray, places: Iterable[NoNormal]) -> NDArray[np.bool_]:
    """Tell which parameters lie so near to places at which there is no normal at all that there is no proper one.

    Derivatives of order k are noise there: rounding over the distance to the power of k.
    """
    if not any(place.fraction <= _NOTHING for place in places):
        return np.zeros(len(s), dtype=np.bool_)
    return np.asarray((_sizes(base, s) <= VANISHES * _means(_sizes(base, _samples(base)))[:, None]).any(axis=0))


def check_regular_edge(base: Base) -> None:
    """Refuse an edge along which a surface has no normal.

    Raises
    ------
    EdgeError
        Naming the first place.
    """
    for place in places_without_normal(base, "a"):
        if place.fraction <= _NOTHING:
            raise EdgeError(
                f"edge {base.edge}: no normal at parameter {place.parameter:.6g} along it ({place.reason}); choose an "
                "edge where the surface is regular"
            )


def _samples(base: Base) -> FloatArray:
    breaks = base.breakpoints_along()
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(_PER_SPAN) / _PER_SPAN).ravel()
    return np.append(inside, breaks[-1])


def _means(sizes: FloatArray) -> FloatArray:
    """Return what sizes are measured by, shape (3,): where all of one kind vanishes nothing; a sine needs none."""
    return np.array([*(mean if mean > 0 else 1.0 for mean in sizes[:2].mean(axis=1)), 1.0])


def _sizes(base: Base, s: FloatArray) -> FloatArray:
    """Return the lengths of the derivatives across and along, and the sine between them, shape (3, K)."""
    at = base.referee.points(s, 1)
    x, y = at[1, 0], at[0, 1]
    across, along = (np.sqrt(np.einsum("ij,ij->i", d, d)) for d in (x, y))
    area = np.linalg.norm(np.cross(x, y), axis=1)
    # Where one vanishes there is no angle: that is said already.
    sine = np.divide(area, across * along, out=np.ones_like(area), where=across * along > 0)
    return np.stack([across, along, sine])


def _lows(base: Base, s: FloatArray, mean: float, kind: int, row: FloatArray) -> list[tuple[float, float]]:
    """Return parameter and value of the lowest place of each stretch in which one kind of value vanishes."""
    padded = np.pad(row, 1, constant_values=np.inf)
    lows = np.flatnonzero((row <= padded[:-2]) & (row <= padded[2:]) & (row <= _SUSPECT))
    if not lows.size:
        return []
    left, right = s[np.maximum(lows - 1, 0)], s[np.minimum(lows + 1, len(s) - 1)]
    best, least = s[lows], row[lows]
    most, width = float(row.max()), right - left
    for _ in range(_SECTIONS):
        # What is still high in a bracket so narrow cannot vanish there.
        if np.all((least - VANISHES) * width > _STEEPEST * most * (right - left)):
            return []
        inner = left + np.multiply.outer(np.arange(1, _PARTS) / _PARTS, right - left)
        values = _sizes(base, inner.ravel())[kind].reshape(inner.shape) / mean
        lowest = values.argmin(axis=0), np.arange(len(left))
        better = values[lowest] < least
        best, least = np.where(better, inner[lowest], best), np.where(better, values[lowest], least)
        part = (right - left) / _PARTS
        left, right = inner[lowest] - part, inner[lowest] + part
    small = least <= VANISHES
    found: list[tuple[float, float]] = []
    before = -2
    for low, at, value in zip(lows[small].tolist(), best[small].tolist(), least[small].tolist(), strict=True):
        # Neighbours are one stretch.
        if low - before > 1:
            found.append((at, value))
        elif value < found[-1][1]:
            found[-1] = at, value
        before = low
    return found
