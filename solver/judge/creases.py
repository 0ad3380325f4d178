"""Creases: at a knot of full multiplicity a surface may bend sharply, and the thin-plate energy does not count it.

Of a rational surface that is a knot where (w x, w y, w z, w) is continuous and no more, as between the arcs of a
circle: the surface itself may be smooth there, or not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge.square_section import square_section
from semispline.solver.splines import (
    SemiStructuredSurface,
    bounding_box,
    breakpoints,
    merge_breakpoints,
    reverse_u,
    reverse_v,
)

# Samples in each span of the other parameter, away from its own knots.
_PLACES = (np.arange(4) + 0.5) / 4
# What rounding may leave of a turn, and of a relative jump of curvature, where there is none: small beside what counts.
SMOOTH_DEGREES, SMOOTH_JUMP = 1e-6, 1e-6
# A curvature below this, over the size of the surface, is none.
_STRAIGHT = 1e-3


@dataclass(frozen=True)
class Crease:
    """A knot of full multiplicity, and how sharply the surface bends there; knots that count as one are one.

    Attributes
    ----------
    parameter : {"u", "v"}
    at : float
    angle_degrees : float
        Largest turn of the normal across the knot; 0 up to rounding where the surface is smooth all the same.
    curvature_jump : float
        Largest jump of the normal curvature square to the line, 1/length: of meaning only where there is no turn.
    curvature_jump_relative : float
        The same over the largest such curvature of either side along the line, not below 1e-3 / size.
    """

    parameter: Literal["u", "v"]
    at: float
    angle_degrees: float
    curvature_jump: float = 0.0
    curvature_jump_relative: float = 0.0

    def __str__(self) -> str:
        place = f"{self.parameter} = {self.at:.6g}"
        if self.angle_degrees > SMOOTH_DEGREES:
            return f"crease {self.angle_degrees:.2g} degrees at {place}"
        if self.curvature_jump_relative > SMOOTH_JUMP:
            return f"G1 inside, curvature jump {100 * self.curvature_jump_relative:.2g} % at {place}"
        return f"G2 inside at {place}"


def measure_creases(surface: SemiStructuredSurface, *, c1_lines: bool = False) -> tuple[Crease, ...]:
    """Return all inner knots of full multiplicity, in u and in v, each with the turn of the normal across it.

    With `c1_lines` also those of one less, where rows are C1 and no more, if curvature jumps there.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> roof = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 1], [1, 1, 1]], [[2, 0, 0], [2, 1, 0]]]
    >>> surface = BSplineSurface(1, 1, [0, 0, 0.5, 1, 1], [0, 0, 1, 1], roof)
    >>> [crease] = measure_creases(surface.to_semistructured())
    >>> crease.parameter, crease.at, round(crease.angle_degrees, 9)
    ('u', 0.5, 90.0)
    """
    straight = _STRAIGHT / (float(np.ptp(bounding_box(surface), axis=0).max()) or 1.0)
    first_u, last_u = _full([(surface.degree_u, surface.knots_u)])
    rows = [(curve.degree, curve.knots) for curve in surface.control_curves]
    full_v, _ = _full(rows)
    first_v, last_v = _full(rows, less=int(c1_lines))
    u, v = (_between(breaks) for breaks in surface.breakpoints)
    found: list[Crease] = []
    if first_u.size:
        # Knots belong to the span after them: from below they are met on the surface run backwards.
        below = _Lines.of(reverse_u(surface), _reversed(first_u, surface.domain[0]), v, "u")
        found += _creases("u", first_u, _Lines.of(surface, last_u, v, "u"), below, straight)
    if first_v.size:
        below = _Lines.of(reverse_v(surface), _reversed(first_v, surface.domain[1]), u, "v")
        found += _creases("v", first_v, _Lines.of(surface, last_v, u, "v"), below, straight)
    return tuple(one for one in found if one.parameter == "u" or one.at in full_v or worst_inside([one]) is not None)


def worst_inside(creases: Sequence[Crease]) -> Crease | None:
    """Return what is worst inside: the sharpest crease, or where all are smooth the largest jump of curvature.

    None where there is neither.
    """
    sharp = [crease for crease in creases if crease.angle_degrees > SMOOTH_DEGREES]
    if sharp:
        return max(sharp, key=lambda crease: crease.angle_degrees)
    rough = [crease for crease in creases if crease.curvature_jump_relative > SMOOTH_JUMP]
    return max(rough, key=lambda crease: crease.curvature_jump_relative, default=None)


@dataclass(frozen=True, eq=False)
class _Lines:
    """A surface along lines, seen from the side to which their parameter grows.

    Attributes
    ----------
    normals : ndarray, shape (lines, samples, 3)
    curvatures : ndarray, shape (lines, samples)
        Square to the line, for the normal as it is; not a number where there is none.
    """

    normals: FloatArray
    curvatures: FloatArray

    @staticmethod
    def of(
        surface: SemiStructuredSurface, lines: FloatArray, along: FloatArray, parameter: Literal["u", "v"]
    ) -> _Lines:
        """Evaluate along the lines where a parameter has these values, at these of the other."""

        def derivative(across: int, on: int) -> FloatArray:
            if parameter == "u":
                return surface.evaluate_grid(lines, along, across, on)
            return surface.evaluate_grid(along, lines, on, across).transpose(1, 0, 2)

        orders = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        values = {order: derivative(*order) for order in orders}
        normals = np.cross(values[1, 0], values[0, 1])
        normals = normals if parameter == "u" else -normals
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        unit = np.divide(normals, length, out=np.full_like(normals, np.nan), where=length > 0)
        section = square_section({order: x.reshape(-1, 3) for order, x in values.items()}, unit.reshape(-1, 3))
        return _Lines(np.asarray(normals), section.curvature.reshape(normals.shape[:2]))


def _creases(
    parameter: Literal["u", "v"], knots: FloatArray, above: _Lines, below: _Lines, straight: float
) -> list[Crease]:
    """Compare both sides of each line; the surface run backwards has its normals the other way."""
    angles = _turns(above.normals, -below.normals).max(axis=1)
    jumps = np.nan_to_num(np.abs(above.curvatures + below.curvatures)).max(axis=1)
    largest = np.nan_to_num(np.abs([above.curvatures, below.curvatures])).max(axis=(0, 2))
    relative = jumps / np.maximum(largest, straight)
    return [Crease(parameter, *row) for row in np.stack([knots, angles, jumps, relative], axis=1).tolist()]


def _full(rows: list[tuple[int, FloatArray]], less: int = 0) -> tuple[FloatArray, FloatArray]:
    """Return the inner knots of full multiplicity, or so much less, in some row; and the last that counts as each."""
    breaks = merge_breakpoints(*(breakpoints(knots) for _, knots in rows))
    between = (breaks[:-1] + breaks[1:]) / 2
    full = np.zeros(len(breaks), dtype=bool)
    first, last = np.full(len(breaks), np.inf), np.full(len(breaks), -np.inf)
    for degree, knots in rows:
        inner = knots[degree + 1 : -degree - 1]
        places = np.searchsorted(between, inner)
        full |= np.bincount(places, minlength=len(breaks)) >= max(degree - less, 1)
        np.minimum.at(first, places, inner)
        np.maximum.at(last, places, inner)
    full[[0, -1]] = False
    return first[full], last[full]


def _between(breaks: FloatArray) -> FloatArray:
    return np.asarray((breaks[:-1, None] + np.diff(breaks)[:, None] * _PLACES).ravel())


def _reversed(parameters: FloatArray, domain: tuple[float, float]) -> FloatArray:
    """Return where parameters are on the surface run backwards, rounded as its knots are."""
    return np.asarray((domain[0] + domain[1]) - parameters)


def _turns(above: FloatArray, below: FloatArray) -> FloatArray:
    """Return the angles between vectors in degrees; 0 where one vanishes, which is a pinch."""
    sine = np.linalg.norm(np.cross(above, below), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (above * below).sum(axis=-1))))
