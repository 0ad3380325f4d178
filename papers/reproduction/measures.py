"""What a blend is worth: contact, energies, curvature, folds, for splines and for surfaces given by formulas alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.papers.baselines import BlendTask, Outcome, contact_sides
from semispline.papers.reproduction.contact_measures import (
    FOLD,
    ContactMeasure,
    SeamMeasure,
    contact_measure,
    samples,
    seam_measure,
)
from semispline.solver.arrays import FloatArray
from semispline.solver.blending import thin_plate_energy
from semispline.solver.judge import (
    ParametricSurface,
    geometry_grid,
    measure_fairness,
    measure_regularity,
    measure_turn,
    model_size,
)
from semispline.solver.splines import BSplineSurface, SemiStructuredSurface

# Gauss points in each direction of each smooth piece (at least 8 of them), and more, to see whether an integral has
# settled.
_POINTS, _MORE = 6, 9
_SETTLED = 1e-3
_PIECES = 8
# What counts as met: degrees, fraction of the curvature, fraction of the size of the model.
ROUNDING = 1e-9


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
    fairness : float or None
        Area times integral of |grad H|^2, with what jumps of H add; None where the surface folds inside, or where it
        does not settle.
    area : float
    control_points, iterations : int or None
    seconds : float
    least_area_ratio : float
        Least |P_u x P_v| over its mean, on samples in every span.
    turn_degrees : float
        Largest angle between the normals at two points of one section that lie 1/50 of its mean length apart.
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
    fairness: float | None
    area: float
    control_points: int | None
    iterations: int | None
    seconds: float
    least_area_ratio: float
    turn_degrees: float
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
    def c2_residual(self) -> float | None:
        """The larger residual of both contacts; None where there is none."""
        found = (self.contact_a.c2_residual, self.contact_b.c2_residual)
        return None if found[0] is None or found[1] is None else max(found[0], found[1])

    @property
    def folds(self) -> bool:
        """Whether the blend turns back, at a contact or inside."""
        turns = (self.contact_a.turn_degrees, self.contact_b.turn_degrees, self.turn_degrees)
        return max(turns) > FOLD


def measure(task: BlendTask, outcome: Outcome) -> Measures:
    """Measure a result against both bases."""
    surface = outcome.surface
    sides = contact_sides(task)
    contact_a, contact_b = (
        contact_measure(side, surface, end, aligned=outcome.aligned) for end, side in enumerate(sides)
    )
    bending, area = bending_and_area(surface)
    turn = measure_turn(surface)
    own = mean_curvature_range(surface)
    others = [mean_curvature_range(side.surface) for side in sides]
    return Measures(
        contact_a,
        contact_b,
        plate_energy(surface),
        bending,
        None if turn.is_fold else settled_fairness(surface),
        area,
        outcome.control_points,
        outcome.iterations,
        outcome.seconds,
        least_area_ratio(surface),
        turn.degrees,
        own,
        (min(own[0], *(low for low, _ in others)), max(own[1], *(high for _, high in others))),
        seam_measure(surface) if task.closed else None,
    )


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


def settled_fairness(surface: ParametricSurface) -> float | None:
    """Return area times integral of |grad H|^2, jumps of H included; None where it does not settle."""
    found = measure_fairness(surface)
    return found.value if found.settled else None


def least_area_ratio(surface: ParametricSurface) -> float:
    """Return the least area element over its mean, on samples in every span."""
    if isinstance(surface, BSplineSurface | SemiStructuredSurface):
        return measure_regularity(surface).least_area_ratio
    u, v = (samples(breaks) for breaks in surface.breakpoints)
    cross = np.cross(surface.evaluate_grid(u, v, 1, 0), surface.evaluate_grid(u, v, 0, 1))
    area = np.linalg.norm(cross, axis=2)
    return float(area.min() / area.mean())


def mean_curvature_range(surface: ParametricSurface) -> tuple[float, float]:
    """Return the least and the largest |mean curvature| over samples in every span; degenerate ones are left out."""
    u, v = (samples(breaks) for breaks in surface.breakpoints)
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


def reached(task: BlendTask, measures: Measures) -> str:
    """Return the continuity that both contacts meet up to rounding: G2, G1, G0, or "none"."""
    if measures.gap > ROUNDING * max(model_size(base.surface) for base in (task.a, task.b)):
        return "none"
    if measures.angle_degrees > ROUNDING:
        return "G0"
    return "G1" if measures.curvature_jump_relative > ROUNDING else "G2"
