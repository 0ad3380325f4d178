"""Bands: B-spline surfaces that have the position, normal and curvature of a face along a free trim curve.

A band is R_0 + w R_1 + w^2 R_2 / 2, with splines R_0 (the curve), R_1 (the direction into the face) and R_2 (the
curvature of the section) fitted to the face, and for G3 and G4 R_3, R_4. Contact of a blend with the band is contact
with the face, with the band's own error, since only derivatives along the edge count; and as the rows have simple
knots, the blend has no crease where the curve crosses knot lines of the face.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import comb, factorial
from typing import Literal, get_args

import numpy as np

from semispline.solver.arrays import FloatArray, exact_origin, require
from semispline.solver.errors import BandError, EdgeError, OptionError
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.band_refusals import refusal, wild_end
from semispline.solver.topology.band_search import BandFit, Continuity, band_limits, fit_band, is_plane, plane_of
from semispline.solver.topology.curve_pieces import Break, CurvePiece, pieces, turns_at_breaks
from semispline.solver.topology.curve_smoothing import sagitta, smoothed
from semispline.solver.topology.face_curves import Source, trim_curve
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.row_fit import BandLimits

# Width of the band, of the length of the curve: derivatives at the edge are all that counts.
_WIDTH = 0.1
# Kept off degenerate ends, in parts of the range; the second where the first leaves spans narrower than a part of L.
_AWAY = (1e-6, 1e-4)
_NARROW = 1e-4
# A polyline that turns by more than this, in degrees, costs points at each of its vertices.
_KINK = 0.05


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
    cut_at_start: str
    cut_at_end: str

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


def band_along(
    surface: BSplineSurface,
    curve: BSplineCurve | None,
    keep: Literal["left", "right"] = "left",
    *,
    edge: BSplineCurve | None = None,
    tolerance: float = 0.0,
    millimetres: float | None = None,
    continuity: Literal["G1", "G2", "G3", "G4"] = "G2",
    part: int | None = None,
    name: str = "the curve",
    share: float = 1.0,
) -> tuple[Band, ...]:
    """Return bands along a free curve of a face: one, or one for each piece where it has to be cut.

    A curve is cut at corners of more than 5 degrees, and where it crosses a line at which the curvature of the face
    jumps by more than 1 % of its largest or its normal turns. A polyline is made smooth first, within its sagitta or
    the tolerance.

    Parameters
    ----------
    surface : BSplineSurface
        The face, rational too.
    curve : BSplineCurve or None
        In the plane z = 0: (s, t) of the surface, which may run on over the seam of a closed one. None where only the
        edge in space is known.
    keep : {"left", "right"}
        The side of the curve, in the plane of (s, t), on which the face is kept; of the edge where there is no curve.
    edge : BSplineCurve, optional
        The edge in space, run through the same way. Its feet on the face are taken for the curve where it stays within
        the tolerance, or 1e-5 of its length, of the face.
    tolerance : float
        Of the edge, model units: so far may the contact be from it, across.
    millimetres : float, optional
        In one model unit, where that is known: then no gap above 0.001 mm is allowed.
    continuity : {"G1", "G2", "G3", "G4"}
        That the band is to be met with.
    part : int, optional
        Only the band of this piece, counted from 0.
    name : str
        How messages call the curve.
    share : float
        Of what it may be off by: a band for a solid lies closer, so that no tolerance has to grow.

    Raises
    ------
    BandError
        A limit cannot be met: what was reached, where, and the likely reason.
    EdgeError
        A curve that leaves the face, or that is a point; no such part.

    Source: `semispline.derivations.bands`.

    Examples
    --------
    >>> from semispline import plane
    >>> floor = plane([0, 0, 0], [4, 0, 0], [0, 4, 0])
    >>> arc = BSplineCurve(2, [0, 0, 0, 1, 1, 1], [[0.2, 0.2], [0.5, 0.8], [0.8, 0.2]])
    >>> (band,) = band_along(floor, arc)
    >>> band.gap < 1e-14, band.off < 1e-5 * band.length, band.is_plane
    (True, True, True)
    """
    require(surface, "surface", BSplineSurface)
    _check_words(keep, tolerance, millimetres, continuity)
    # Contact of order 1 is measured by rows 0 and 1, but curvature decides how good these have to be.
    order = max(2, int(continuity[1]))
    origin = exact_origin(surface.control_points.reshape(-1, 3))
    face = Face(replace(surface, control_points=surface.control_points - origin))
    in_space = None if edge is None else replace(edge, control_points=edge.control_points - origin)
    on_face = trim_curve(face, curve, in_space, tolerance)
    sign = 1.0 if keep == "left" else -1.0
    made = []
    cut, breaks = pieces(on_face, sign, _AWAY[0])
    if part is not None and not 0 <= part < len(cut):
        raise EdgeError(f"part: found {part}, but {name} has {len(cut)}, counted from 0")
    for k in range(len(cut)) if part is None else [part]:
        piece = cut[k]
        title = name if len(cut) == 1 else f"part {k} of {name}"
        fit = _fit(piece, order, tolerance, millimetres, share)
        if piece.left_out and not (fit.is_good and np.diff(np.unique(fit.knots)).min() > _NARROW * piece.length):
            again = _fit(pieces(on_face, sign, _AWAY[1])[0][k], order, tolerance, millimetres, share)
            fit = again if again.is_good or not fit.is_good else fit
        if not fit.is_good:
            raise BandError(refusal(fit, title, origin, tolerance))
        no_normal = wild_end(fit.piece) if piece.left_out else None
        if no_normal is not None:
            raise BandError(
                f"{title}: the face has no normal at the {no_normal} of it, its curvature grows without end"
            )
        made.append(_band(fit, piece, origin, breaks))
    return tuple(made)


def _check_words(keep: str, tolerance: float, millimetres: float | None, continuity: str) -> None:
    if keep not in ("left", "right"):
        raise OptionError(f"keep: found {keep!r}, expected 'left' or 'right'")
    if continuity not in get_args(Continuity):
        raise OptionError(f"continuity: found {continuity!r}, expected one of G1, G2, G3, G4")
    if not 0 <= tolerance < np.inf:
        raise OptionError(f"tolerance: found {tolerance}, expected a finite number of at least 0")
    if millimetres is not None and not 0 < millimetres < np.inf:
        raise OptionError(f"millimetres: found {millimetres}, expected a finite number above 0")


def _fit(piece: CurvePiece, order: int, tolerance: float, millimetres: float | None, share: float) -> BandFit:
    """Return the fit along a piece, made smooth where it has to be."""
    curve = piece.curve
    limits = band_limits(piece.length, tolerance, millimetres, share)
    _, turns = turns_at_breaks(curve)
    is_polyline = curve.degree == 1 and len(curve.breaks) > 3 and turns.max(initial=0.0) > _KINK
    if not is_polyline:
        fit = fit_band(piece, limits, order)
        if fit.is_good or tolerance <= limits.gap:
            return fit
    moved = smoothed(piece, max(tolerance, sagitta(curve) if is_polyline else 0.0))
    if moved is None:
        return fit_band(piece, limits, order) if is_polyline else fit
    smooth, by = moved
    again = replace(fit_band(smooth, limits, order), smoothed_by=by)
    return again if is_polyline or again.share < fit.share else fit


def _band(fit: BandFit, whole: CurvePiece, origin: FloatArray, breaks: list[Break]) -> Band:
    """Return the band of a fit along a piece; `whole` is the piece before it was made smooth or shortened."""
    piece, curve = fit.piece, fit.piece.curve
    flat = is_plane(curve.face)
    return Band(
        surface=band_surface(fit, flat, origin),
        edge="u0",
        gap=fit.largest("gap"),
        off=fit.largest("off"),
        angle_degrees=fit.largest("angle_degrees"),
        curvature=0.0 if flat else fit.largest("across", "mixed", "along"),
        rates=tuple(fit.largest(name) for name in ("rate", "second_rate")[: len(fit.rows) - 3]),
        limits=fit.limits,
        is_plane=flat,
        length=piece.length,
        left_out=piece.left_out,
        source=curve.source,
        edge_to_face=curve.edge_to_face,
        edge_to_pcurve=curve.edge_to_pcurve,
        smoothed_by=fit.smoothed_by,
        range=(whole.start, whole.end),
        cut_at_start=_reason(whole, whole.start, breaks),
        cut_at_end=_reason(whole, whole.end, breaks),
    )


def _reason(piece: CurvePiece, end: float, breaks: list[Break]) -> str:
    """Return why the curve was cut at an end of a piece; empty where it was not."""
    first, last = piece.curve.ends
    places = (end, end - (last - first)) if piece.curve.is_closed else (end,)
    return next((x.reason for x in breaks if min(abs(x.parameter - at) for at in places) < 1e-6 * (last - first)), "")


def band_surface(fit: BandFit, flat: bool, origin: FloatArray) -> BSplineSurface:
    """Return sum over k of R_k w^k / k! for w in [0, L / 10], as a Bezier surface in w."""
    width = _WIDTH * fit.piece.length
    rows = _in_plane(fit) if flat else fit.rows
    order = len(rows) - 1
    points = [
        sum((comb(j, i) / comb(order, i) * width**i / factorial(i)) * rows[i] for i in range(j + 1))
        for j in range(order + 1)
    ]
    knots = np.repeat([0.0, width], order + 1)
    return BSplineSurface(order, fit.degree, knots, fit.knots, np.stack(points) + origin)


def _in_plane(fit: BandFit) -> FloatArray:
    """Return the rows along a curve of a flat face, brought into it: rounding of the fit would bend them."""
    corner, normal = plane_of(fit.piece.face)
    foot, into = fit.rows[:2]
    return np.stack([foot - ((foot - corner) @ normal)[:, None] * normal, into - (into @ normal)[:, None] * normal])
