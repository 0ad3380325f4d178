"""Bands: B-spline surfaces that have the position, normal and curvature of a face along a free trim curve.

A band is R_0 + w R_1 + w^2 R_2 / 2, with splines R_0 (the curve), R_1 (the direction into the face) and R_2 (the
curvature of the section) fitted to the face, and for G3 and G4 R_3, R_4. Contact of a blend with the band is contact
with the face, with the band's own error, since only derivatives along the edge count; and as the rows have simple
knots, the blend has no crease where the curve crosses knot lines of the face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import comb, factorial
from typing import Literal

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import BandError, EdgeError, OptionError
from semispline.solver.judge import Base, cad_limits
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.band_measures import (
    BandMeasures,
    finer_breaks,
    limit_of,
    measured,
)
from semispline.solver.topology.curve_pieces import Break, CurvePiece, pieces
from semispline.solver.topology.curve_smoothing import smoothed
from semispline.solver.topology.face_curves import EdgeInSpace, FaceCurve, Source, curve_on_face, edge_on_face
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.row_fit import BandLimits, Scales, fitted_rows, scales

# No more control points in a row, and no more rounds.
MOST_POINTS, MOST_ROUNDS = 120, 20
# Of its limits: what 11 points a span must show, or else 30 points a span.
_SURE, _NEAR = 0.75, 0.92
_FEW, _MANY = 11, 30
# Kept off degenerate ends, in parts of the range; the second where the first leaves spans narrower than a part of L.
_AWAY = (1e-6, 1e-4)
_NARROW = 1e-4
# A plane has no more curvature than this over its size.
_FLAT = 1e-12


@dataclass(frozen=True, eq=False)
class Band:
    """A surface that has the jet of a face along a free curve, and how far it is from the face.

    Attributes
    ----------
    surface : BSplineSurface
        u runs into the face, over a tenth of the curve's length; v is the arc length of the curve.
    edge : {"u0"}
        The edge of the surface that lies along the curve.
    gap, off : float
        The largest distance from the face, and across the trim curve; model units.
    angle_degrees : float
        The largest angle between the normals.
    curvature : float
        The largest error of curvature: across over the largest curvature across, that along and the mixed one over
        the largest curvature at all.
    rates : tuple of float
        For G3 and G4 the largest errors of the rate of curvature and of the second one, over the largest along.
    limits : BandLimits
        What was allowed.
    is_plane : bool
        The face is flat along the curve, so that everything but `off` is exact.
    length : float
    left_out : float
        Length of the curve that was kept away from degenerate ends.
    source : {"pcurve", "foot"}
        What the curve is: the pcurve, or the feet of the edge in space.
    edge_to_face, edge_to_pcurve : float or None
        Distances of the edge in space from the face and from the pcurve.
    smoothed_by : float
        How far the pcurve was moved to make it smooth.
    range : (float, float)
        Of the curve's own parameter.
    cut_at_start, cut_at_end : str
        Why the curve was cut there; empty at its own ends.
    """

    surface: BSplineSurface
    edge: Literal["u0"]
    gap: float
    off: float
    angle_degrees: float
    curvature: float
    rates: tuple[float, ...]
    limits: BandLimits
    is_plane: bool
    length: float
    left_out: float
    source: Source
    edge_to_face: float | None
    edge_to_pcurve: float | None
    smoothed_by: float
    range: tuple[float, float]
    cut_at_start: str = field(default="")
    cut_at_end: str = field(default="")

    @property
    def base(self) -> Base:
        """What a blend takes."""
        return Base(self.surface, self.edge)

    @property
    def points(self) -> int:
        """Control points in a row."""
        return int(self.surface.control_points.shape[1])

    @property
    def spans(self) -> int:
        """Spans along the curve."""
        return len(self.surface.breakpoints[1]) - 1
