"""A smooth curve in the parameters of a face for a rough one: polylines, and what intersection left of noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineCurve, basis_matrix, clamped, greville
from semispline.solver.topology.curve_pieces import CurvePiece, turns_at_breaks
from semispline.solver.topology.face_curves import FaceCurve, unwrapped
from semispline.solver.topology.face_jets import dot, metric
from semispline.solver.topology.row_fit import closed_space

_DEGREE = 5
# Points of the rough curve that are fitted, and the spans that are tried, the fewest that will do.
_POINTS = 400
_SPANS = (2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32)
# So many pieces of a polyline, at the least, stand for one span.
_PIECES = 3
# By arc length the speed is 1.
_SLOWEST = 0.1


def smoothed(piece: CurvePiece, allowed: float) -> tuple[CurvePiece, float] | None:
    """Return a smooth piece that stays within `allowed` of a rough one, and how far it is; None where there is none.

    Least squares in the metric of the face, of degree 5 with the fewest spans, the ends of an open piece fixed.
    """
    v = np.linspace(0.0, piece.length, _POINTS + 1)
    at, _, beside = piece.at(v)
    jet = piece.face.jet(at, 1, beside)
    # Cholesky factors turn distances in the face into plain ones.
    a, b, c = metric(jet)
    root = np.linalg.cholesky(np.array([[a, b], [b, c]]).transpose(2, 0, 1)).transpose(0, 2, 1)
    flat = unwrapped(at, piece.face)
    most = len(piece.curve.breaks) // _PIECES if piece.curve.degree == 1 else _SPANS[-1]
    for spans in _SPANS:
        if spans > max(most, _SPANS[0]):
            break
        pcurve = _fitted(v, flat, root, spans, piece.closed)
        if pcurve is None:
            continue
        away = np.einsum("kij,kj->ki", root, pcurve.evaluate(v)[:, :2] - flat)
        slope = np.einsum("kij,kj->ki", root, pcurve.evaluate(v, 1)[:, :2])
        speed = np.sqrt(np.maximum(dot(slope, slope), 1e-300))
        across = np.abs(away[:, 0] * slope[:, 1] - away[:, 1] * slope[:, 0]) / speed
        distance = float(across.max())
        # A curve that stops on the way is none.
        if distance <= allowed and speed.min() > _SLOWEST:
            return _on_face(piece, pcurve), distance
    return None


def _fitted(v: FloatArray, flat: FloatArray, root: FloatArray, spans: int, closed: bool) -> BSplineCurve | None:
    """Return the curve of least squared distance in the face, ends fixed or smooth at the seam."""
    breaks = np.linspace(v[0], v[-1], spans + 1)
    knots = clamped(breaks[1:-1], _DEGREE, v[0], v[-1])
    basis = basis_matrix(_DEGREE, knots, v).toarray()
    # Round a closed surface the parameters drift by its period.
    drift = (flat[-1] - flat[0]) / (v[-1] - v[0])
    wanted = flat - flat[0] - np.outer(v - v[0], drift)
    space = closed_space(_DEGREE, breaks) if closed else np.eye(basis.shape[1])[:, 1:-1]
    system = (root[:, :, None, :] * (basis @ space)[:, None, :, None]).reshape(2 * len(v), -1)
    right = np.einsum("kij,kj->ki", root, wanted).ravel()
    found = np.linalg.lstsq(system, right)[0].reshape(-1, 2)
    if not np.isfinite(found).all():
        return None
    points = space @ found + flat[0] + np.outer(greville(knots, _DEGREE) - v[0], drift)
    return BSplineCurve(_DEGREE, knots, points)


def _on_face(piece: CurvePiece, pcurve: BSplineCurve) -> CurvePiece:
    curve: FaceCurve = replace(
        piece.curve,
        evaluator=lambda x: (pcurve.evaluate(x)[:, :2], pcurve.evaluate(x, 1)[:, :2]),
        breaks=pcurve.knots[[0, -1]],
        degree=_DEGREE,
    )
    return CurvePiece(curve, 0.0, float(pcurve.knots[-1]), piece.closed, piece.sign, piece.left_out)


def sagitta(curve: FaceCurve) -> float:
    """Return how far a polyline may be from the smooth curve that it stands for: that of its vertices' circle."""
    x, turns = turns_at_breaks(curve)
    points, _ = curve.tangents(curve.breaks)
    sides = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if not len(x):
        return 0.0
    before = np.concatenate([sides[-1:], sides])[: len(x)] if curve.is_closed else sides[: len(x)]
    after = sides if curve.is_closed else sides[1:]
    small = turns < 30.0
    return float(np.max(np.radians(turns) * np.maximum(before, after) / 8, where=small, initial=0.0))
