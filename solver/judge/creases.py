"""Creases: at a knot of full multiplicity a surface may bend sharply, and the thin-plate energy does not count it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import SemiStructuredSurface, breakpoints, merge_breakpoints, reverse_u, reverse_v

# Samples in each span of the other parameter, away from its own knots.
_PLACES = (np.arange(4) + 0.5) / 4


@dataclass(frozen=True)
class Crease:
    """A knot of full multiplicity, and how sharply the surface bends there; knots that count as one are one.

    Attributes
    ----------
    parameter : {"u", "v"}
    at : float
    angle_degrees : float
        Largest turn of the normal across the knot; 0 up to rounding where the surface is smooth all the same.
    """

    parameter: Literal["u", "v"]
    at: float
    angle_degrees: float


def measure_creases(surface: SemiStructuredSurface) -> tuple[Crease, ...]:
    """Return all inner knots of full multiplicity, in u and in v, each with the turn of the normal across it.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> roof = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]], [[2, 0, 0], [2, 1, 0]]]
    >>> surface = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], roof)
    >>> [crease] = measure_creases(surface.to_semistructured())
    >>> crease.parameter, crease.at, round(crease.angle_degrees, 9)
    ('u', 0.5, 90.0)
    """
    first_u, last_u = _full([(surface.degree_u, surface.knots_u)])
    first_v, last_v = _full([(curve.degree, curve.knots) for curve in surface.control_curves])
    u, v = (_between(breaks) for breaks in surface.breakpoints)
    found: list[Crease] = []
    if first_u.size:
        # Knots belong to the span after them: from below they are met on the surface run backwards.
        below = _normals(reverse_u(surface), _reversed(first_u, surface.domain[0]), v)
        found += _creases("u", first_u, _turns(_normals(surface, last_u, v), -below).max(axis=1))
    if first_v.size:
        below = _normals(reverse_v(surface), u, _reversed(first_v, surface.domain[1]))
        found += _creases("v", first_v, _turns(_normals(surface, u, last_v), -below).max(axis=0))
    return tuple(found)


def _creases(parameter: Literal["u", "v"], knots: FloatArray, angles: FloatArray) -> list[Crease]:
    return [Crease(parameter, at, angle) for at, angle in zip(knots.tolist(), angles.tolist(), strict=True)]


def _full(rows: list[tuple[int, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """Return the inner knots of full multiplicity in some row, and the last of those that count as one with each."""
    breaks = merge_breakpoints(*(breakpoints(knots) for _, knots in rows))
    between = (breaks[:-1] + breaks[1:]) / 2
    full = np.zeros(len(breaks), dtype=bool)
    first, last = np.full(len(breaks), np.inf), np.full(len(breaks), -np.inf)
    for degree, knots in rows:
        inner = knots[degree + 1 : -degree - 1]
        places = np.searchsorted(between, inner)
        full |= np.bincount(places, minlength=len(breaks)) >= degree
        np.minimum.at(first, places, inner)
        np.maximum.at(last, places, inner)
    full[[0, -1]] = False
    return first[full], last[full]


def _between(breaks: FloatArray) -> FloatArray:
    return np.asarray((breaks[:-1, None] + np.diff(breaks)[:, None] * _PLACES).ravel())


def _reversed(parameters: FloatArray, domain: tuple[float, float]) -> FloatArray:
    """Return where parameters are on the surface run backwards, rounded as its knots are."""
    return np.asarray((domain[0] + domain[1]) - parameters)


def _normals(surface: SemiStructuredSurface, u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray(np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1)))


def _turns(above: FloatArray, below: FloatArray) -> FloatArray:
    """Return the angles between vectors in degrees; 0 where one vanishes, which is a pinch."""
    sine = np.linalg.norm(np.cross(above, below), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (above * below).sum(axis=-1))))
