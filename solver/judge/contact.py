"""What was measured of two surfaces along a shared edge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Place:
    """Where a measure is worst: the parameter along edge a, and the point."""

    parameter: float
    point: tuple[float, float, float]


@dataclass(frozen=True)
class NoNormal:
    """Where a surface has no proper normal on an edge: what is measured beside it does not hold there.

    Attributes
    ----------
    surface : {"a", "b"}
    parameter : float
        Along that surface's own edge.
    point : (float, float, float)
    reason : str
        What vanishes: the derivative across the edge, that along it, or the angle between them.
    fraction : float
        To what part of its mean along the edge; of the angle, its sine.
    """

    surface: Literal["a", "b"]
    parameter: float
    point: tuple[float, float, float]
    reason: str
    fraction: float

    def __str__(self) -> str:
        x, y, z = self.point
        return f"no proper normal at parameter {self.parameter:.6g}, ({x:.5g}, {y:.5g}, {z:.5g}): {self.reason}"


@dataclass(frozen=True)
class Contact:
    """How two surfaces meet along an edge; the worst over samples in every span of both, and between them.

    Where a side has no normal, as in a pole, nothing but the gap is told: angle and curvature are those of all other
    places, and not a number where there is none.

    Rates are those of the curvature of the section of each side with the plane square to the edge, by arc length, with
    one normal and in one direction; None where they were not asked for. They mean something only where all measures of
    lower order are within their limits.

    Attributes
    ----------
    gap : float
        Largest distance, model units.
    angle_degrees : float
        Largest angle by which the surface turns at the edge, from |n1 x n2|: 0 where the tangent planes agree, 180
        where one side folds back over the other.
    curvature_jump : float
        Largest difference of normal curvature across the edge, 1/length.
    curvature_jump_relative : float
        The same over the largest such curvature of either side, not below 1e-3 / size.
    c1_residual, c2_residual : float
        Largest difference of first and second cross derivative (one side leaving backwards), over the largest such
        derivative of either side; of second ones not below 1e-3 / size times the square of the largest first one, and
        over that square / size where both are nothing but rounding.
    size : float
        Largest extent of the control points of both surfaces.
    rounding : dict
        What rounding of the input alone may do to each measure above; infinite where the measure is nothing else. Where
        that would hide the answer, and derivatives to many digits are within the limit: what floating ones were off by.
    allowed : dict
        What each measure may be to count as none: its limit, with that rounding on top.
    no_normal : tuple of NoNormal
        Places on either edge that the measures say nothing about.
    gap_at, angle_at, curvature_at : Place
    flipped : bool
        The two edges run in opposite directions.
    shift : float
        Closed edges: how far edge b's seam is from edge a's, in b's parameter.
    corresponds : {"affine", "foot points"}
        Which points of the edges are compared: of parameters that correspond affinely, or, where the edges are one
        curve with two parametrisations, each with its foot on the other.
    rate_jump, second_rate_jump : float or None
        Largest difference of the rate of curvature, 1/length^2, and of its second rate, 1/length^3.
    rate_jump_relative, second_rate_jump_relative : float or None
        The same over the largest such rate of either side, not below the square (the cube) of the largest curvature
        across the edge or along it, nor below 1e-3 / size^2 (1e-3 / size^3).
    rate_at, second_rate_at : Place or None
    """

    gap: float
    angle_degrees: float
    curvature_jump: float
    curvature_jump_relative: float
    c1_residual: float
    c2_residual: float
    size: float
    rounding: dict[str, float]
    allowed: dict[str, float]
    no_normal: tuple[NoNormal, ...]
    gap_at: Place
    angle_at: Place
    curvature_at: Place
    flipped: bool
    shift: float
    corresponds: Literal["affine", "foot points"] = "affine"
    rate_jump: float | None = None
    rate_jump_relative: float | None = None
    second_rate_jump: float | None = None
    second_rate_jump_relative: float | None = None
    rate_at: Place | None = None
    second_rate_at: Place | None = None
