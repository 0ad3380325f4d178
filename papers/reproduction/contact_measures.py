"""How a blend meets its bases, and itself along a seam: gap, angle, curvature jump, turn.

Splines are judged by `solver.judge`, the de Boor referee. Other surfaces are measured here with their exact
derivatives and the same definitions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.papers.baselines import ContactSide
from semispline.solver.arrays import FloatArray
from semispline.solver.judge import (
    Base,
    ParametricSurface,
    geometry,
    local_geometry,
    measure_contact,
    model_size,
)
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface

# Where each span of the contact is sampled; at a knot the two sides may be seen from different spans.
_FRACTIONS = np.array([0.002, 0.1, 0.3, 0.5, 0.7, 0.9, 0.998])
_EDGE_SAMPLES = 2001
_PER_SPAN = 8

# A turn of the normal by more than this, across a contact or within 1/50 of the length, is a fold.
FOLD = 90.0


@dataclass(frozen=True)
class ContactMeasure:
    """How a blend meets one base; the worst over samples in every span.

    Attributes
    ----------
    gap : float
        Model units.
    angle_degrees : float
        Between the tangent planes, 0 to 90.
    curvature_jump : float
        Of the normal curvature across the contact curve, 1/length.
    curvature_jump_relative : float
        Over the largest such curvature of either side, not below 1e-3 / size.
    turn_degrees : float
        Between the oriented normals, 0 to 180: 180 where the blend runs back over the base.
    c2_residual : float or None
        Largest difference of second cross derivatives, both in their own parameters, over the largest of either side;
        only for splines. Small where contact is C2.
    """

    gap: float
    angle_degrees: float
    curvature_jump: float
    curvature_jump_relative: float
    turn_degrees: float
    c2_residual: float | None = None


@dataclass(frozen=True)
class SeamMeasure:
    """How a closed blend meets itself where v ends and begins again; the worst over samples in u.

    Attributes
    ----------
    gap : float
        Model units.
    angle_degrees : float
    curvature_jump : float
        Of the normal curvature across the seam, 1/length.
    """

    gap: float
    angle_degrees: float
    curvature_jump: float


def seam_measure(surface: ParametricSurface) -> SeamMeasure:
    """Measure how the two ends of v meet, at equal u."""
    u = samples(surface.breakpoints[0])
    first, second = (geometry(surface, u, np.full_like(u, v)) for v in surface.domain[1])
    sine = np.linalg.norm(np.cross(first.normal, second.normal), axis=1)
    curvatures = [end.normal_curvature(np.cross(end.normal, end.tangent_u)) for end in (first, second)]
    jump = curvatures[0] - curvatures[1]
    return SeamMeasure(
        float(np.linalg.norm(first.point - second.point, axis=1).max()),
        float(np.degrees(np.arcsin(np.minimum(sine, 1.0)).max())),
        float(np.abs(jump).max()),
    )


def contact_measure(side: ContactSide, surface: ParametricSurface, end: int, *, aligned: bool = True) -> ContactMeasure:
    """Measure how the edge u = `end` of a blend meets a base.

    Parameters
    ----------
    side : ContactSide
    surface : ParametricSurface
    end : {0, 1}
    aligned : bool
        Whether equal v belong together; else the closest points of the edge do.
    """
    v, on_edge = corresponding(side, surface, end, aligned=aligned)
    turn = oriented_turn(side, surface, end, v, on_edge)
    if not aligned or turn > FOLD or not isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return measured_by_formula(side, surface, end, v, on_edge, turn)
    judged = measure_contact(Base(side.surface, "u0"), Base(surface, "u1" if end else "u0"), flip="no")
    return ContactMeasure(
        judged.gap,
        judged.angle_degrees,
        judged.curvature_jump,
        judged.curvature_jump_relative,
        turn,
        judged.c2_residual,
    )


def measured_by_formula(
    side: ContactSide, surface: ParametricSurface, end: int, v: FloatArray, on_edge: FloatArray, turn: float
) -> ContactMeasure:
    """Measure contact from exact derivatives at corresponding parameters, with the definitions of the referee."""
    base = local_geometry(side.surface, np.full_like(v, side.surface.domain[0][0]), v)
    blend = geometry(surface, np.full_like(on_edge, float(end)), on_edge)
    gap = float(np.linalg.norm(base.point - blend.point, axis=1).max())
    sine = np.linalg.norm(np.cross(base.normal, blend.normal), axis=1)
    sign = np.where(np.sum(base.normal * blend.normal, axis=1) < 0, -1.0, 1.0)
    k_base, k_blend = (side.normal_curvature(np.cross(side.normal, base.tangent_v)) for side in (base, blend))
    k_blend = sign * k_blend
    jump = float(np.abs(k_base - k_blend).max())
    size = max(model_size(side.surface), float(np.ptp(surface.evaluate_grid(*_ends(surface)), axis=(0, 1)).max()))
    largest = max(float(np.abs(k_base).max()), float(np.abs(k_blend).max()), 1e-3 / size)
    return ContactMeasure(gap, float(np.degrees(np.arcsin(np.minimum(sine, 1)).max())), jump, jump / largest, turn)


def _ends(surface: ParametricSurface) -> tuple[FloatArray, FloatArray]:
    (u0, u1), (v0, v1) = surface.domain
    return np.linspace(u0, u1, 9), np.linspace(v0, v1, 33)


def corresponding(
    side: ContactSide, surface: ParametricSurface, end: int, *, aligned: bool = True
) -> tuple[FloatArray, FloatArray]:
    """Return parameters along the contact of the base and along the edge of the blend that belong together."""
    breaks = np.unique(np.concatenate([side.surface.breakpoints[1], surface.breakpoints[1]]))
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * _FRACTIONS).ravel()
    v = np.unique(np.concatenate([breaks[:1], inside, breaks[-1:]]))
    if aligned:
        return v, v
    w = np.linspace(*surface.domain[1], _EDGE_SAMPLES)
    edge = surface.evaluate(np.full_like(w, float(end)), w)
    points = side.derivatives(v, 0)
    nearest = w[[int(np.argmin(np.sum((edge - p) ** 2, axis=1))) for p in points]]
    # On a closed edge the closest point may lie beyond the seam.
    other = np.where(nearest < w[len(w) // 2], w[-1], w[0])
    tried = [_closest(surface, end, points, start) for start in (nearest, other)]
    return v, np.where(tried[0][1] <= tried[1][1], tried[0][0], tried[1][0])


def _closest(
    surface: ParametricSurface, end: int, points: FloatArray, start: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return parameters of the closest points on an edge, searched from `start`, and squared distances."""
    low, high = surface.domain[1]
    at, x, share = np.full_like(start, float(end)), start, np.ones_like(start)
    distance = np.sum((surface.evaluate(at, x) - points) ** 2, axis=1)
    for _ in range(40):
        slope = surface.evaluate(at, x, 0, 1)
        away = points - surface.evaluate(at, x)
        trial = np.clip(x + share * np.sum(away * slope, axis=1) / np.sum(slope**2, axis=1), low, high)
        found = np.sum((surface.evaluate(at, trial) - points) ** 2, axis=1)
        # Past a knot the slope may change: a step that does not come closer is halved.
        closer = found <= distance
        x, distance = np.where(closer, trial, x), np.where(closer, found, distance)
        share = np.where(closer, 1.0, share / 2)
    return x, distance


def oriented_turn(side: ContactSide, surface: ParametricSurface, end: int, v: FloatArray, on_edge: FloatArray) -> float:
    """Return by how much the surface turns back at a contact: 0 for a smooth join, 180 for a fold.

    Cross derivatives of both are taken in the direction that leaves the base.
    """
    leaving = side.derivatives(v, 1)
    blend = surface.evaluate(np.full_like(on_edge, float(end)), on_edge, 1, 0) * (1.0 if end == 0 else -1.0)
    along = side.derivatives(v, 0, 1)
    return float(angle_degrees(np.cross(leaving, along), np.cross(blend, along)).max())


def turn_between(a: Base, b: Base, *, flipped: bool) -> float:
    """Return by how much b turns back over a at a common edge: 0 for a smooth join, 180 for a fold.

    Parameters along the edges correspond affinely. Both cross derivatives are taken in the direction from a into b; a
    fold shows as opposite normals.
    """
    s = np.linspace(0.03, 0.97, 17)
    vectors = []
    for base, leaving in ((a, True), (b, False)):
        start, end = base.range_along
        x = start + (1 - s if flipped and not leaving else s) * (end - start)
        cross, along = base.derivative(x, 1, 0), base.derivative(x, 0, 1)
        outward = 1.0 if base.side[1] == "1" else -1.0
        cross = cross * (outward if leaving else -outward)
        along = along * (-1.0 if flipped and not leaving else 1.0)
        vectors.append(np.cross(cross, along))
    return float(angle_degrees(*vectors).max())


def samples(breaks: FloatArray) -> FloatArray:
    """Return parameters in every span, and its ends."""
    inner = np.linspace(0, 1, _PER_SPAN, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def angle_degrees(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angles between vectors along the last axis, 0 to 180."""
    sine, cosine = np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))
