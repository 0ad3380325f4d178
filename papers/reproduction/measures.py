"""What a blend is worth: contact, energies, curvature, folds, for splines and for surfaces given by formulas alike.

Contact of splines with the bases is judged by `solver.judge.continuity`, the de Boor referee. Other surfaces are
measured here with their exact derivatives and the same definitions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.papers.baselines import BlendTask, ContactSide, Outcome, contact_sides
from semispline.solver.arrays import FloatArray
from semispline.solver.blending import thin_plate_energy
from semispline.solver.judge import (
    Base,
    ParametricSurface,
    geometry,
    geometry_grid,
    local_geometry,
    measure_contact,
    measure_regularity,
    model_size,
)
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface

# Where each span of the contact is sampled; at a knot the two sides may be seen from different spans.
_FRACTIONS = np.array([0.002, 0.1, 0.3, 0.5, 0.7, 0.9, 0.998])
# Gauss points in each direction of each smooth piece (at least 8 of them), and more, to see whether an integral has
# settled.
_POINTS, _MORE = 6, 9
_SETTLED = 1e-3
_PIECES = 8
_PER_SPAN = 8
_EDGE_SAMPLES = 2001
# A turn of the normal by more than this, across a contact or between neighbouring samples, is a fold.
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


@dataclass(frozen=True)
class Measures:
    """What was measured of one result.

    Attributes
    ----------
    contact_a, contact_b : ContactMeasure
    energy : float
        Thin-plate energy (11) over [0, 1] x the v-domain of a's edge.
    bending : float or None
        Integral of k1^2 + k2^2 over the surface; None where it does not settle, as on a folded surface.
    area : float
    control_points, iterations : int or None
    seconds : float
    least_area_ratio : float
        Least |P_u x P_v| over its mean, on samples in every span.
    largest_turn_degrees : float
        Largest angle between the normals of neighbouring samples.
    mean_curvature : (float, float)
        Least and largest |mean curvature| of the blend, 1/length.
    mean_curvature_with_bases : (float, float)
        The same over the blend and both bases.
    seam : SeamMeasure or None
        Only between closed contacts.
    """

    contact_a: ContactMeasure
    contact_b: ContactMeasure
    energy: float
    bending: float | None
    area: float
    control_points: int | None
    iterations: int | None
    seconds: float
    least_area_ratio: float
    largest_turn_degrees: float
    mean_curvature: tuple[float, float]
    mean_curvature_with_bases: tuple[float, float]
    seam: SeamMeasure | None

    @property
    def gap(self) -> float:
        """The larger gap of both contacts."""
        return max(self.contact_a.gap, self.contact_b.gap)

    @property
    def angle_degrees(self) -> float:
        """The larger angle of both contacts."""
        return max(self.contact_a.angle_degrees, self.contact_b.angle_degrees)

    @property
    def curvature_jump_relative(self) -> float:
        """The larger relative jump of both contacts."""
        return max(self.contact_a.curvature_jump_relative, self.contact_b.curvature_jump_relative)

    @property
    def folds(self) -> bool:
        """Whether the blend turns back, at a contact or inside."""
        turns = (self.contact_a.turn_degrees, self.contact_b.turn_degrees, self.largest_turn_degrees)
        return max(turns) > FOLD


def measure(task: BlendTask, outcome: Outcome) -> Measures:
    """Measure a result against both bases."""
    surface = outcome.surface
    sides = contact_sides(task)
    contact_a, contact_b = (
        contact_measure(side, surface, end, aligned=outcome.aligned) for end, side in enumerate(sides)
    )
    bending, area = bending_and_area(surface)
    least_area, largest_turn = regularity(surface)
    own = mean_curvature_range(surface)
    others = [mean_curvature_range(side.surface) for side in sides]
    return Measures(
        contact_a,
        contact_b,
        plate_energy(surface),
        bending,
        area,
        outcome.control_points,
        outcome.iterations,
        outcome.seconds,
        least_area,
        largest_turn,
        own,
        (min(own[0], *(low for low, _ in others)), max(own[1], *(high for _, high in others))),
        seam_measure(surface) if task.closed else None,
    )


def seam_measure(surface: ParametricSurface) -> SeamMeasure:
    """Measure how the two ends of v meet, at equal u."""
    u = _samples(surface.breakpoints[0])
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
    return float(_angle(np.cross(leaving, along), np.cross(blend, along)).max())


def plate_energy(surface: ParametricSurface) -> float:
    """Return (11): exact for splines, by Gauss quadrature on every smooth piece for others."""
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return thin_plate_energy(surface)
    u, v, weights = _quadrature(surface, _MORE)
    total = sum(
        factor * np.sum(surface.evaluate_grid(u, v, du, dv) ** 2, axis=2)
        for factor, du, dv in ((1.0, 2, 0), (2.0, 1, 1), (1.0, 0, 2))
    )
    return float(np.sum(weights * total))


def bending_and_area(surface: ParametricSurface) -> tuple[float | None, float]:
    """Return the integral of k1^2 + k2^2 over the surface, None where it does not settle, and the area."""
    found = []
    for points in (_POINTS, _MORE):
        u, v, weights = _quadrature(surface, points)
        local = geometry_grid(surface, u, v)
        element = weights * np.linalg.norm(np.cross(local.tangent_u, local.tangent_v), axis=2)
        found.append((float(np.sum(element * np.sum(local.principal**2, axis=2))), float(np.sum(element))))
    (rough, _), (fine, area) = found
    # NaN where the surface is degenerate, which fails the comparison.
    return (fine if abs(fine - rough) <= _SETTLED * abs(fine) else None), area


def regularity(surface: ParametricSurface) -> tuple[float, float]:
    """Return the least area element over its mean, and the largest angle between neighbouring normals in degrees.

    The samples are those of `semispline.solver.measure_regularity`, which serves splines.
    """
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        found = measure_regularity(surface)
        return found.least_area_ratio, found.largest_turn_degrees
    u, v = (_samples(breaks) for breaks in surface.breakpoints)
    cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    area = np.linalg.norm(cross, axis=2)
    turn = max(float(_angle(cross[:-1], cross[1:]).max()), float(_angle(cross[:, :-1], cross[:, 1:]).max()))
    return float(area.min() / area.mean()), turn


def mean_curvature_range(surface: ParametricSurface) -> tuple[float, float]:
    """Return the least and the largest |mean curvature| over samples in every span; degenerate ones are left out."""
    u, v = (_samples(breaks) for breaks in surface.breakpoints)
    found = np.abs(geometry_grid(surface, u, v).mean)
    return float(np.nanmin(found)), float(np.nanmax(found))


def _quadrature(surface: ParametricSurface, points: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return Gauss points in u and v for every smooth piece, and weights on their grid."""
    x, w = np.polynomial.legendre.leggauss(points)
    axes = []
    for breaks in map(_divided, surface.breakpoints):
        half = np.diff(breaks)[:, None] / 2
        axes.append((((breaks[:-1, None] + breaks[1:, None]) / 2 + half * x).ravel(), (half * w).ravel()))
    (u, wu), (v, wv) = axes
    return u, v, np.multiply.outer(wu, wv)


def _divided(breaks: FloatArray) -> FloatArray:
    """Return the breakpoints with as many between them as it takes for _PIECES pieces."""
    times = max(1, -(-_PIECES // (len(breaks) - 1)))
    inner = np.arange(times) / times
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def _samples(breaks: FloatArray) -> FloatArray:
    inner = np.linspace(0, 1, _PER_SPAN, endpoint=False)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), breaks[-1])


def _angle(a: FloatArray, b: FloatArray) -> FloatArray:
    sine, cosine = np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))
