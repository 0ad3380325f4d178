"""The search for the knots of a band: fit, measure against the face, put knots where the band is far off, again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.judge import cad_measures
from semispline.solver.topology.band_measures import BandMeasures, finer_breaks, limit_of, measured
from semispline.solver.topology.curve_pieces import CurvePiece
from semispline.solver.topology.face_curves import FaceCurve
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.row_fit import BandLimits, fitted_rows, scales

Continuity: TypeAlias = Literal["G1", "G2", "G3", "G4"]

# No more control points in a row, and no more rounds.
MOST_POINTS, MOST_ROUNDS = 120, 20
# So much of its limits a band may take: by 11 points a span in each round, and by 30 in the last one.
_NEAR = 0.92
_FEW, _MANY = 11, 30
# Where no round came so near, the best one will do with this by so many points.
_LAST, _MOST = 0.98, 200
# Spans of the first round.
_OPEN, _CLOSED = 3, 8
# Places where the largest curvature along the edge is sought.
_PLACES = 201


@dataclass(frozen=True, eq=False)
class BandFit:
    """Rows that were fitted along a piece of a curve, and what was measured of them.

    Attributes
    ----------
    piece : CurvePiece
    degree : int
    knots : ndarray
    rows : ndarray, shape (order + 1, n, 3)
    measures : BandMeasures
    limits : BandLimits
    share : float
        The largest measure over its limit.
    is_good : bool
        With what was measured between points that were fitted, the limits are met.
    smoothed_by : float
        How far the curve was moved to make it smooth.
    """

    piece: CurvePiece
    degree: int
    knots: FloatArray
    rows: FloatArray
    measures: BandMeasures
    limits: BandLimits
    share: float
    is_good: bool
    smoothed_by: float = 0.0

    def largest(self, *names: str) -> float:
        """Return the largest of some measures, those that were taken."""
        return max((self.measures.worst(name)[0] for name in names if name in self.measures.values), default=0.0)

    @property
    def binding(self) -> str:
        """The measure that is nearest to its limit, or farthest past it."""
        names = list(self.measures.values)
        return max(names, key=lambda name: self.measures.worst(name)[0] / limit_of(name, self.limits))


def band_limits(length: float, tolerance: float, millimetres: float | None, share: float = 1.0) -> BandLimits:
    """Return the limits of checkers of CAD systems for an edge, or a share of those of lengths.

    `off` may be as loose as the edge's tolerance, where all of them are used.
    """
    cad = cad_measures(length, millimetres)
    return BandLimits(
        gap=share * cad["gap"],
        off=max(cad["gap"], tolerance) if share == 1 else share * cad["gap"],
        angle_degrees=cad["angle_degrees"],
        curvature=cad["curvature_jump_relative"],
        rate=cad["rate_jump_relative"],
    )


def row_degree(curve: FaceCurve, order: int) -> int:
    """Return the degree of rows that costs a blend the fewest points.

    On bicubic faces with inner knots quintic rows are little shorter than cubic ones, and what is blended with them is
    cubic more often than not.
    """
    surface = curve.face.surface
    cubic = surface.weights is None and max(surface.degree_u, surface.degree_v) == 3
    has_knots = max(map(len, surface.breakpoints)) > 2
    return 3 if cubic and has_knots and order < 3 else 5


def fit_band(
    piece: CurvePiece, limits: BandLimits, order: int, degree: int | None = None, rounds: int = MOST_ROUNDS
) -> BandFit:
    """Return the first fit that meets its limits, else the best one of all rounds."""
    degree = row_degree(piece.curve, order) if degree is None else degree
    length = piece.length
    places = piece.sections(np.linspace(0.0, length, _PLACES), order)
    of = scales(places, piece.face.size)
    breaks = np.linspace(0.0, length, (_CLOSED if piece.closed else _OPEN) + 1)
    best: BandFit | None = None
    for _ in range(rounds):
        knots, rows = fitted_rows(piece, degree, breaks, limits, of, order)
        found = measured(piece, degree, knots, rows, _FEW)
        share = worst_share(found, limits)
        near = share <= _NEAR
        if near:
            found = measured(piece, degree, knots, rows, _MANY)
            share = worst_share(found, limits)
        fit = BandFit(piece, degree, knots, rows, found, limits, share, near and share <= _NEAR)
        if best is None or share < best.share or fit.is_good:
            best = fit
        if fit.is_good:
            break
        finer = finer_breaks(breaks, degree, found, limits)
        if len(finer) - 1 + degree > MOST_POINTS:
            if len(breaks) - 1 + degree >= MOST_POINTS:
                break
            # What may be used is used.
            most = MOST_POINTS - degree
            finer = np.interp(np.linspace(0, len(finer) - 1, most + 1), np.arange(len(finer)), finer)
        breaks = finer
    assert best is not None
    if not best.is_good and best.share <= _LAST:
        found = measured(piece, degree, best.knots, best.rows, _MOST)
        share = worst_share(found, limits)
        best = replace(best, measures=found, share=share, is_good=share <= _LAST)
    return best


def worst_share(found: BandMeasures, limits: BandLimits) -> float:
    """Return the largest measure over its limit."""
    return max(found.worst(name)[0] / limit_of(name, limits) for name in found.values)


def is_plane(face: Face) -> bool:
    """Tell whether all control points lie in a plane, up to rounding."""
    points = face.surface.control_points.reshape(-1, 3)
    middle, normal = plane_of(face)
    return bool(np.abs((points - middle) @ normal).max() <= 1e-13 * np.abs(points - middle).max())


def plane_of(face: Face) -> tuple[FloatArray, FloatArray]:
    """Return a point and the unit normal of the plane that is nearest to all control points."""
    points = face.surface.control_points.reshape(-1, 3)
    middle = points.mean(axis=0)
    # The smallest extent; singular values are of all points together.
    _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
    return middle, axes[-1]
