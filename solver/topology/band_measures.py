"""How far a band is from its face: at points between those that were fitted, by feet on the face itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Jet, basis_matrix, derivative_points
from semispline.solver.topology.curve_pieces import CurvePiece
from semispline.solver.topology.face_jets import Sections, dot, sections, unit
from semispline.solver.topology.row_fit import BandLimits, Scales, scales

# By its name, how a measure falls as spans are divided: as the span's length to this power less than degree + 1.
MEASURES = {"gap": 0, "off": 0, "angle_degrees": 1, "across": 1, "mixed": 1, "along": 2, "rate": 1, "second_rate": 1}


@dataclass(frozen=True, eq=False)
class BandMeasures:
    """Measures of a band at points along it.

    Attributes
    ----------
    v : ndarray, shape (K,)
        Arc length along the curve.
    points : ndarray, shape (K, 3)
    spans : ndarray of int, shape (K,)
    values : dict
        By name, each of shape (K,): "gap", "off" in model units, "angle_degrees", "across", "mixed", "along" of the
        largest curvature, and "rate", "second_rate" of the largest one where the order asks for them.
    """

    v: FloatArray
    points: FloatArray
    spans: NDArray[np.intp]
    values: dict[str, FloatArray]

    def worst(self, name: str) -> tuple[float, int]:
        """Return the largest value of a measure and where it is; what is not a number is the worst."""
        values = np.where(np.isfinite(self.values[name]), self.values[name], np.inf)
        k = int(values.argmax())
        return float(values[k]), k


def limit_of(name: str, limits: BandLimits) -> float:
    """Return the limit of a measure."""
    if name in ("gap", "off", "angle_degrees"):
        return float(getattr(limits, name))
    return limits.curvature if name in ("across", "mixed", "along") else limits.rate


def row_jet(degree: int, knots: FloatArray, rows: FloatArray, v: FloatArray, order: int) -> Jet:
    """Return the derivatives of the band with these rows along its edge; keys are (order across, order along)."""
    jet = {}
    for j in range(order + 1):
        basis = basis_matrix(degree - j, knots[j : len(knots) - j], v)
        for i in range(order + 1 - j):
            jet[i, j] = np.asarray(basis @ derivative_points(degree, knots, rows[i], j))
    return jet


def measured(piece: CurvePiece, degree: int, knots: FloatArray, rows: FloatArray, per_span: int) -> BandMeasures:
    """Measure a band against its face at evenly spread points of each span, its ends too.

    Relative errors are over what the face has at the feet, which a loose `off` may move away from a peak.
    """
    breaks = np.unique(knots)
    shares = np.linspace(0.0, 1.0, per_span)
    v = (breaks[:-1, None] + np.diff(breaks)[:, None] * shares).ravel()
    spans = np.repeat(np.arange(len(breaks) - 1), per_span)
    order = len(rows) - 1
    band = row_jet(degree, knots, rows, v, order)
    at, slope, beside = piece.at(v)
    face = piece.face
    start = face.jet(at, 1, beside)
    tangent = start[1, 0] * slope[:, :1] + start[0, 1] * slope[:, 1:]
    normal = unit(np.cross(start[1, 0], start[0, 1]))
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        _, jet, away = face.feet(band[0, 0], at, beside, order)
        across = piece.sign * np.cross(normal, unit(tangent))
        of_band = sections(band, band[0, 1], piece.sign, order, normal)
        of_face = sections(jet, band[0, 1], piece.sign, order)
    off = dot(band[0, 0] - away - start[0, 0], across)
    return BandMeasures(v, band[0, 0], spans, _values(of_band, of_face, away, off, scales(of_face, face.size)))


def _values(band: Sections, face: Sections, away: FloatArray, off: FloatArray, of: Scales) -> dict[str, FloatArray]:
    sine = np.linalg.norm(np.cross(band.normal, face.normal), axis=1)
    bends = np.abs(band.bends - face.bends)
    values = {
        "gap": np.linalg.norm(away, axis=1),
        "off": np.abs(off),
        "angle_degrees": np.degrees(np.arctan2(sine, dot(band.normal, face.normal))),
        "across": bends[2] / of.across,
        "mixed": bends[1] / of.bend,
        "along": bends[0] / of.bend,
    }
    for k, name in enumerate(("rate", "second_rate")[: len(band.heights) - 1]):
        values[name] = np.abs(band.heights[k + 1] - face.heights[k + 1]) / of.rates[k]
    return values


def finer_breaks(breaks: FloatArray, degree: int, found: BandMeasures, limits: BandLimits) -> FloatArray:
    """Return breaks whose spans should just meet the limits: narrow where the band is far off, wide where it is near.

    Span i wants (error / (0.8 limit))^(1 / power) parts, the most over all measures. The density of spans falls to no
    less than half from one span to the next; there are at least an eighth more than before, and three times at most.
    """
    spans = len(breaks) - 1
    need = np.full(spans, 1e-3)
    for name, values in found.values.items():
        worst = np.zeros(spans)
        np.maximum.at(worst, found.spans, np.where(np.isfinite(values), values, 1e300))
        power = degree + 1 - MEASURES[name]
        need = np.maximum(need, (worst / (0.8 * limit_of(name, limits))) ** (1 / power))
    widths = np.diff(breaks)
    density = np.minimum(need, 16.0) / widths
    for k in range(1, spans):
        density[k] = max(density[k], density[k - 1] / 2)
    for k in range(spans - 2, -1, -1):
        density[k] = max(density[k], density[k + 1] / 2)
    total = np.concatenate([[0.0], np.cumsum(density * widths)])
    more = max(1.05 * total[-1], spans + max(1.0, spans / 8))
    count = int(np.ceil(min(more, 3.0 * spans)))
    new = np.interp(np.linspace(0.0, total[-1], count + 1), total, breaks)
    new[0], new[-1] = breaks[0], breaks[-1]
    return np.asarray(new)
