"""Why no band meets its limits along a curve, in words: what was reached, where, and what the likely reason is."""

from __future__ import annotations

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.band_measures import limit_of
from semispline.solver.topology.band_search import BandFit
from semispline.solver.topology.curve_pieces import CurvePiece, jumps, turns_at_breaks

_UNITS = {"angle_degrees": " degree", "across": "", "mixed": "", "along": ""}
_NAMES = {
    "gap": "a gap of {} to the face",
    "off": "{} off the curve",
    "angle_degrees": "{} degree",
    "across": "{} % of the curvature across",
    "mixed": "{} % of the mixed curvature",
    "along": "{} % of the curvature along",
    "rate": "{} % of the rate of curvature",
    "second_rate": "{} % of the second rate of curvature",
}
# A derivative shorter than the first part of its largest along the curve, or curvature above the second multiple of its
# median, show that there is no proper normal.
_SHORT, _WILD = 1e-2, 100.0
# A reason lies this near to the worst place, of the length of the curve.
_NEAR = 0.05


def refusal(fit: BandFit, name: str, origin: FloatArray, tolerance: float) -> str:
    """Return the message: what a band reaches along a curve, against which limit, where, and why."""
    which = fit.binding
    value, k = fit.measures.worst(which)
    limit = limit_of(which, fit.limits)
    percent = 100.0 if "%" in _NAMES[which] else 1.0
    reached = _NAMES[which].format(f"{percent * value:.3g}" if np.isfinite(value) else "no number")
    x, y, z = (fit.measures.points[k] + origin).tolist()
    reason = _reason(fit, which, float(fit.measures.v[k]), tolerance)
    return (
        f"{name}: a band of {fit.rows.shape[1]} points reaches {reached} (limit {percent * limit:.3g}) at "
        f"({x:.6g}, {y:.6g}, {z:.6g}): {reason}"
    )


def _reason(fit: BandFit, which: str, v: float, tolerance: float) -> str:
    piece = fit.piece
    at_end = min(v, piece.length - v) <= 0.01 * piece.length and not piece.closed
    if at_end and (piece.left_out or _vanishes(piece, v)):
        return f"the face has no proper normal at the {'start' if v < piece.length / 2 else 'end'} of it"
    near = _NEAR * piece.length
    turns = [(turn, x) for x, turn in zip(*turns_at_breaks(piece.curve), strict=True) if turn > 0.05]
    turn = _nearest(piece, turns, v, near)
    if turn is not None:
        return f"the curve has a corner of {turn[0]:.2g} degrees there; split it at {turn[1]:.4g}"
    orders = (4, 3) if which == "second_rate" else (3,) if which == "rate" else (2,)
    for order in orders:
        found = [(jump, x) for x, jump, _ in jumps(piece.curve, piece.sign, order) if jump > 1e-3]
        # A rate is missed everywhere, not only beside its jump.
        jump = _nearest(piece, found, v, near if order == 2 else piece.length)
        if jump is not None:
            what = {2: "curvature", 3: "rate of curvature", 4: "second rate of curvature"}[order]
            cure = f"split the edge at {jump[1]:.4g}" if order == 2 else "ask for G2"
            return f"the face's {what} jumps by {100 * jump[0]:.2g} % at {jump[1]:.4g}; {cure}"
    radius = _least_radius(piece, v)
    if radius < 0.02 * piece.length:
        return f"the curve turns with a radius of {radius:.3g} there; smooth it, or split it there"
    if which == "off" or tolerance > fit.limits.gap:
        return f"the curve is not smooth within {fit.limits.off:.3g}; the edge's tolerance is {tolerance:.3g}"
    return "the face or the curve bends too sharply for so many points; split the curve"


def _nearest(piece: CurvePiece, found: list[tuple[float, float]], v: float, near: float) -> tuple[float, float] | None:
    """Return the largest of what was found (size, parameter) within a distance of a place."""
    places = np.linspace(0.0, piece.length, 801)
    x = piece.curve.wrapped(piece.parameters(places))
    beside = []
    for size, parameter in found:
        at = float(places[np.abs(x - parameter).argmin()])
        apart = abs(at - v)
        if min(apart, piece.length - apart if piece.closed else apart) <= near:
            beside.append((float(size), float(parameter)))
    return max(beside, default=None)


def wild_end(piece: CurvePiece) -> str | None:
    """Return "start" or "end" where curvature there is far above that of the rest, as at the tip of a cone."""
    bends = np.abs(piece.sections(np.linspace(0.0, piece.length, 101), 2).bends).max(axis=0)
    wild = bends[[0, -1]] > _WILD * np.median(bends)
    return ("start" if wild[0] else "end") if wild.any() else None


def _vanishes(piece: CurvePiece, v: float) -> bool:
    """Tell whether the face degenerates near an end: a derivative vanishes, or curvature grows without end."""
    places = np.linspace(0.0, piece.length, 101)
    at, _, beside = piece.at(np.append(places, v))
    jet = piece.face.jet(at, 1, beside)
    sizes = np.array([np.linalg.norm(jet[key], axis=1) for key in ((1, 0), (0, 1))])
    if (sizes[:, -1] < _SHORT * sizes.max(axis=1)).any():
        return True
    bends = np.abs(piece.sections(np.append(places[1:-1], v), 2).bends).max(axis=0)
    return bool(bends[-1] > _WILD * np.median(bends[:-1]))


def _least_radius(piece: CurvePiece, v: float) -> float:
    """Return the least radius of curvature of the curve near a place."""
    places = v + piece.length * np.linspace(-0.01, 0.01, 41)
    places = np.mod(places, piece.length) if piece.closed else np.unique(np.clip(places, 0.0, piece.length))
    tangents = piece.sections(places, 2).along
    if len(places) < 3:
        return float("inf")
    steps = np.abs(np.diff(places))
    turns = np.linalg.norm(np.diff(tangents, axis=0), axis=1)
    rate = float(np.nanmax(np.where(steps < piece.length / 2, turns / np.maximum(steps, 1e-300), 0.0)))
    return 1.0 / rate if rate > 0 else float("inf")
