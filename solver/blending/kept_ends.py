"""An end of a blend brought onto a given curve: contact stays G1 there, and is what it was from a stated length on.

A blend that bends less than a round at its contacts cannot end in the edge of a round. Its end curve is therefore moved
onto that edge, with a quintic step along v: the row beside each contact along its own direction only, so that tangent
planes stay; the rows further in as the curve asks for.

Source: D(u, v) = phi(v) (c(u) - X(u, end)), phi = 1 at the end with two vanishing derivatives there and where it is 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.end_curves import elevated
from semispline.solver.blending.reparametrisation import bernstein, bezier_points, chebyshev_places
from semispline.solver.blending.spans import bezier_pieces, joined_spans
from semispline.solver.errors import EdgeError
from semispline.solver.splines import (
    Basis,
    BSplineSurface,
    basis_matrix,
    euclidean,
    homogeneous_points,
)

# Degrees that are added across at the most; each takes about a digit off the distance.
_MOST_RAISED = 8
# Bezier points of the step that falls from 1 to 0.
_STEP = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
_STEP_DEGREE = 5
# Angle, in radians, at which a blend may leave the end of its contact beside the curve.
_BESIDE = 1e-3
_MOST_DEGREE = 25
# The rows beside the contacts, and those of the contacts.
_ROWS = ((1, 0), (-2, -1))
# Weights that are so near, relative to themselves, are the same.
_SAME_WEIGHTS = 1e-12
# How many derivatives are kept at knots, at most.
_INNER_ORDER = 2
# Of the range of v: a knot that is so near to where the step ends is there.
_SAME_PLACE = 1e-9


@dataclass(frozen=True, eq=False)
class EndOnCurve:
    """A blend one end of which lies on a curve.

    Attributes
    ----------
    surface : BSplineSurface
    distance : float
        Between the end and the curve, the largest.
    """

    surface: BSplineSurface
    distance: float


def end_on_curve(
    surface: BSplineSurface, end: int, points: FloatArray, tangents: FloatArray, share: float, within: float
) -> EndOnCurve:
    """Return a blend with its end v = 0 or v = 1 of the domain on a curve that is tangent to both bases there.

    Parameters
    ----------
    surface : BSplineSurface
        Whose two contacts are at u = 0 and u = 1 of the domain.
    end : {0, 1}
    points : ndarray, shape (K, 3)
        Of the curve, from the first contact to the second, at equal steps of its length.
    tangents : ndarray, shape (2, 3)
        By u at both ends of the curve: as long as it is.
    share : float
        Of the range of v: what is further from the end stays as it is.
    within : float
        Distance that is sought, model units.

    Raises
    ------
    EdgeError
        The blend leaves its contacts beside the curve, or the end stays further off.
    """
    best: EndOnCurve | None = None
    for raised in range(_MOST_RAISED + 1):
        found = _moved(elevated(surface, raised), end, points, tangents, share)
        if best is None or found.distance < best.distance:
            best = found
        if best.distance <= within:
            return best
    assert best is not None
    raise EdgeError(
        f"end curve: it stays {best.distance:.2g} off the old end edge, expected at most {within:.2g}; the edge cannot "
        "be kept"
    )


def _weighted(surface: BSplineSurface) -> FloatArray:
    """Return the homogeneous net, shape (n, m, 4), of whatever surface."""
    weights = np.ones(surface.control_points.shape[:2]) if surface.weights is None else surface.weights
    return homogeneous_points(surface.control_points, weights)


def _moved(surface: BSplineSurface, end: int, points: FloatArray, tangents: FloatArray, share: float) -> EndOnCurve:
    low, high = surface.domain[0]
    u = np.linspace(low, high, len(points))
    across = basis_matrix(surface.degree_u, surface.knots_u, u).toarray()
    net = _weighted(surface)
    last = net[:, 0 if end == 0 else -1]
    scales = [_scale(surface, last, k, tangents[k] / (high - low)) for k in (0, 1)]
    wanted = last.copy()
    for (beside, contact), scale in zip(_ROWS, scales, strict=True):
        wanted[beside, :3] += scale * (last[beside, :3] - last[beside, 3] / last[contact, 3] * last[contact, :3])
    inner = slice(2, len(net) - 2)
    known = np.ones(len(net), dtype=bool)
    known[inner] = False
    rest = points * (across @ last[:, 3])[:, None] - across[:, known] @ wanted[known, :3]
    if not known.all():
        wanted[inner, :3] = np.linalg.lstsq(across[:, inner], rest, rcond=None)[0]
    distance = float(np.linalg.norm((across @ wanted)[:, :3] / (across @ last[:, 3:]) - points, axis=1).max())
    return EndOnCurve(_faded(surface, end, wanted - last, scales, share), distance)


def _scale(surface: BSplineSurface, last: FloatArray, which: int, tangent: FloatArray) -> float:
    """Return by how much the row beside a contact is to be stretched, less 1, for the end to begin as a curve does."""
    p, knots = surface.degree_u, surface.knots_u
    contact, beside, width = (0, 1, knots[p + 1] - knots[1]) if which == 0 else (-1, -2, knots[-2] - knots[-p - 2])
    step = last[beside, :3] / last[beside, 3] - last[contact, :3] / last[contact, 3]
    own = p / width * last[beside, 3] / last[contact, 3] * step * (1 if which == 0 else -1)
    angle = float(np.arctan2(np.linalg.norm(np.cross(own, tangent)), own @ tangent))
    if angle > _BESIDE:
        raise EdgeError(
            f"end curve: the blend leaves its contact {np.degrees(angle):.2g} degrees beside the old end edge; that "
            "cannot be kept"
        )
    return float(np.linalg.norm(tangent) / np.linalg.norm(own)) - 1


def _faded(
    surface: BSplineSurface, end: int, change: FloatArray, scales: Sequence[float], share: float
) -> BSplineSurface:
    """Return the surface with its end moved by a change of its homogeneous points, which fades out along v."""
    start, stop = (float(x) for x in surface.domain[1])
    own_end, fades = (start, stop) if end == 0 else (stop, start)
    at = own_end + share * (fades - own_end)
    along = Basis(surface.degree_v, surface.knots_v)
    breaks, spans = bezier_pieces(_weighted(surface), along)
    # A knot beside it is where it ends, and stays as smooth as it is.
    nearest = float(breaks[np.abs(breaks - at).argmin()])
    at = nearest if abs(nearest - at) <= _SAME_PLACE * (stop - start) else at
    places = np.unique(np.append(breaks, at))
    q = along.degree
    is_rational, last = surface.weights is not None, _weighted(surface)[:, 0 if end == 0 else -1, 3]
    is_even = all(_is_even(spans, beside, contact) for beside, contact in _ROWS)
    degree = q * (1 if is_even else 2) + _STEP_DEGREE
    if degree > _MOST_DEGREE:
        raise EdgeError(f"end curve: degree {degree} along, expected at most {_MOST_DEGREE}; the edge cannot be kept")
    t = chebyshev_places(degree + 1)
    pieces = []
    for low, high in pairwise(places.tolist()):
        k = min(max(int(np.searchsorted(breaks, (low + high) / 2)) - 1, 0), len(spans) - 1)
        v = low + (high - low) * t
        local = (v - breaks[k]) / (breaks[k + 1] - breaks[k])
        rows = np.einsum("na,kad->knd", bernstein(q, local), spans[k])
        from_end = (v - own_end) / (at - own_end)
        step = bernstein(_STEP_DEGREE, np.clip(from_end, 0.0, 1.0)) @ _STEP
        pieces.append(bezier_points(_with_change(rows, change, scales, step, last, is_even=is_even)))
    smooth = [_smoothness(along, place) for place in places[1:-1]]
    net, basis = joined_spans(pieces, places, smooth)
    points, weights = euclidean(net)
    return BSplineSurface(
        surface.degree_u, basis.degree, surface.knots_u, basis.knots, points, weights if is_rational else None
    )


def _is_even(spans: FloatArray, beside: int, contact: int) -> bool:
    """Tell whether two rows have the same weights along, but for a factor."""
    ratios = spans[:, beside, :, 3] / spans[:, contact, :, 3]
    return bool(np.ptp(ratios) <= _SAME_WEIGHTS * ratios.max())


def _with_change(
    rows: FloatArray,
    change: FloatArray,
    scales: Sequence[float],
    step: FloatArray,
    weights: FloatArray,
    *,
    is_even: bool,
) -> FloatArray:
    """Return rows at places along v, shape (K, N, 4), with what the step takes of the change.

    Parameters
    ----------
    rows, change : ndarray
    scales : sequence of float
        By which the rows beside the contacts are stretched, less 1.
    step : ndarray, shape (N,)
    weights : ndarray, shape (K,)
        Of the rows at the end.
    is_even : bool
        Those of rows beside each other differ by a factor alone.
    """
    moved = rows.copy()
    # Points in space move by what the step alone says.
    shares = rows[2:-2, :, 3:] / weights[2:-2, None, None]
    moved[2:-2, :, :3] += shares * change[2:-2, None, :3] * step[:, None]
    for (beside, contact), scale in zip(_ROWS, scales, strict=True):
        if is_even:
            # Of a whole polynomial of v the mean tells the factor as well as any place.
            ratio = rows[beside, :, 3:].mean() / rows[contact, :, 3:].mean()
            stretch = rows[beside, :, :3] - ratio * rows[contact, :, :3]
        else:
            stretch = rows[contact, :, 3:] * rows[beside, :, :3] - rows[beside, :, 3:] * rows[contact, :, :3]
            stretch = stretch / weights[contact]
        moved[beside, :, :3] += scale * stretch * step[:, None]
    return moved


def _smoothness(along: Basis, place: float) -> int:
    count = int(np.sum(along.knots == place))
    return min(along.degree - count, _INNER_ORDER) if count else _INNER_ORDER
