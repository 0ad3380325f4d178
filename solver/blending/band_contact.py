"""What is said of a blend that meets a face through a band along a free edge of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from semispline.solver.judge import Place


@dataclass(frozen=True)
class BandContact:
    """How a blend meets, through a band, the face that the band stands for: measured on the face itself.

    The blend meets the band as exactly as any base, so these are the errors of the band.

    Attributes
    ----------
    edge : str
        Of which face, and which part of it.
    gap, off : float
        Largest distance to the face, and from the trim curve, across it; model units.
    angle_degrees : float
        Above 90 where the blend folds back over the face.
    curvature : float
        Largest jump of curvature, as `FaceContact` has it.
    rate, second_rate : float or None
        Of its rates, where G3 or G4 was asked for.
    at : dict
        For each measure the `Place` where it is largest.
    allowed : dict
        For each measure its limit.
    limits : {"exact", "cad"}
        Of which kind these are.
    source : {"foot", "pcurve"}
        What the curve is: the feet of the edge in space on the face, or the curve in the face's parameters.
    edge_to_face, edge_to_pcurve : float or None
        Distances of the edge in space from both; None where there is no such curve.
    length, left_out : float
        Of the edge, or its part, that is met, and that was kept away from degenerate ends.
    smoothed_by : float
        How far the curve was moved to make it smooth.
    control_points : int
        Of the band, along the edge.
    """

    edge: str
    gap: float
    off: float
    angle_degrees: float
    curvature: float
    rate: float | None
    second_rate: float | None
    at: dict[str, Place]
    allowed: dict[str, float]
    limits: Literal["exact", "cad"]
    source: Literal["foot", "pcurve"]
    edge_to_face: float | None
    edge_to_pcurve: float | None
    length: float
    left_out: float
    smoothed_by: float
    control_points: int
