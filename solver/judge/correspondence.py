"""Which parameters along two edges belong together: direction, and for closed edges the shift between their seams."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import get_args

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.judge.base import Base
from semispline.solver.options import Flip
from semispline.solver.splines import gauss_rule, merge_breakpoints

# Where each merged span of the edge is sampled: inside, since at a knot the two sides may be seen from different spans.
_FRACTIONS = np.array([0.002, 0.1, 0.3, 0.5, 0.7, 0.9, 0.998])
# An edge whose ends are closer than this fraction of its extent is closed.
CLOSED = 1e-9
# Directions whose closeness differs by less than this fraction of what it can be tie: rims within a degree of a right
# angle, say. Below the second fraction the difference is rounding.
TIE = 1e-2
_ROUNDING = 1e-9
# Surfaces that leave closed edges at flatter angles to their planes do not tell how these circle: product of two sines.
LEAST_CIRCLING = 1e-2
# A seam this close to a knot of the other edge, as a fraction of the domain, is moved onto it: across a span h the
# rounding of control points bends a curve by 1e-16 / h^2, which is to stay below 1e-8.
SNAP = 1e-4
_SAMPLES = 256
# Of quotients no quadrature is exact; one of this degree is, but for rounding, where weights are tame.
_OF_QUOTIENTS = 48
_NEWTON_STEPS = 30


@dataclass(frozen=True)
class Correspondence:
    """How edge b runs along edge a; parameters correspond affinely.

    Attributes
    ----------
    flipped : bool
        Edge b runs against edge a.
    shift : float
        Where on edge b the start of edge a belongs, beyond b's own start, in b's parameter. Not zero only where both
        edges are closed.
    """

    flipped: bool
    shift: float = 0.0


def correspond(a: Base, b: Base, flip: Flip = "auto") -> Correspondence:
    """Find the direction, and for closed edges the shift, that bring the edges closest.

    Closeness is the mean squared distance of corresponding points. Both curves are centred first, which changes all
    sums alike but keeps the rounding of a large offset out of the comparison. Of two directions that are equally close
    the first of `tied_directions` is taken. The shift is exact up to rounding, and the same whichever edge comes first.

    Raises
    ------
    EdgeError
        `flip` is not one of auto, yes, no.
    """
    best = _directions(a, b, flip)[0]
    if not (is_closed(a) and is_closed(b)):
        return Correspondence(best.flipped)
    length = b.range_along[1] - b.range_along[0]
    guess = (-best.step if best.flipped else best.step) % _SAMPLES / _SAMPLES * length
    return Correspondence(best.flipped, _refined(a, b, Correspondence(best.flipped, guess)))


def tied_directions(a: Base, b: Base) -> tuple[Flip, ...]:
    """Return the directions of edge b between which closeness does not decide, the closer one first.

    Both where they are about equally close, as for edges at right angles; and where closed edges come closest in the
    direction in which b circles the other way about its surface than a does, as in a pipe that bends back.

    Where both are equally close the order follows from where the edges lie: it is the same whichever way they run and
    whichever comes first.
    """
    closest, other = _directions(a, b, "auto")
    decided = closest.closeness - other.closeness > TIE
    if decided and is_closed(a) and is_closed(b):
        # What leaves a enters b.
        circles = -_circling(a) * _circling(b)
        decided = abs(circles) < LEAST_CIRCLING or (circles < 0) == closest.flipped
    return tuple("yes" if one.flipped else "no" for one in ((closest,) if decided else (closest, other)))


def _circling(base: Base) -> float:
    """Return how a closed edge circles about the surface: its area vector times the mean direction inwards, unit both.

    1 or -1 for a pipe, 0 for a flat ring.
    """
    start, end = base.range_along
    t = np.arange(_SAMPLES) / _SAMPLES
    s = start + t * (end - start)
    area = np.cross(_centred(base, t), base.derivative(s, 0, 1)).sum(axis=0)
    inwards = base.derivative(s, 1, 0) * (1 if base.side[1] == "0" else -1)
    length = float(np.linalg.norm(area) * np.linalg.norm(inwards, axis=1).sum())
    return float(area @ inwards.sum(axis=0)) / length if length else 0.0


@dataclass(frozen=True, eq=False)
class _Direction:
    """One direction of edge b, with the shift by samples that brings it closest to edge a.

    Attributes
    ----------
    closeness : float
        Correlation of the edges, between -1/2 and 1/2.
    moments : ndarray, shape (6,)
        Mean products of coordinates of a and b, those of two axes added up: the same whichever edge comes first, and
        different for directions that are equally close.
    """

    flipped: bool
    step: int
    closeness: float
    moments: FloatArray


def _directions(a: Base, b: Base, flip: Flip) -> list[_Direction]:
    """Return the directions that `flip` allows, the closest first."""
    if flip not in get_args(Flip):
        raise EdgeError(f"flip: found {flip!r}, expected one of auto, yes, no")
    closed = is_closed(a) and is_closed(b)
    # Closed curves are sampled from the seam on, so that shifts by whole steps meet equal parameters.
    t = (np.arange(_SAMPLES) + (0.0 if closed else 0.5)) / _SAMPLES
    first, second = (_centred(base, t) for base in (a, b))
    size = float(np.sum(first**2) + np.sum(second**2)) or 1.0
    found = []
    for flipped in (False, True) if flip == "auto" else (flip == "yes",):
        turned = (np.roll(second[::-1], 1, axis=0) if closed else second[::-1]) if flipped else second
        # Distance grows as the correlation falls: its terms of one curve alone do not depend on the match.
        steps = range(_SAMPLES if closed else 1)
        shifted = np.lib.stride_tricks.sliding_window_view(np.concatenate([turned, turned]), _SAMPLES, axis=0)
        correlation = np.einsum("ix,kxi->k", first, shifted[: len(steps)])
        best = int(correlation.argmax())
        products = first.T @ shifted[best].T / size
        moments = (products + products.T)[np.triu_indices(3)]
        found.append(_Direction(flipped, best, float(correlation[best]) / size, moments))
    if len(found) > 1:
        one, other = found
        apart = np.append(one.closeness - other.closeness, one.moments - other.moments)
        telling = apart[np.abs(apart) > _ROUNDING]
        if len(telling) and telling[0] < 0:
            return [other, one]
    return found


def is_closed(base: Base) -> bool:
    """Tell whether the edge is a closed curve."""
    start, end = base.range_along
    points = base.derivative(np.linspace(start, end, 33), 0, 0)
    return bool(np.linalg.norm(points[0] - points[-1]) <= CLOSED * np.ptp(points, axis=0).max())


def corresponding(a: Base, b: Base, matched: Correspondence, s: FloatArray) -> FloatArray:
    """Return the parameters along edge b that belong to `s` along edge a."""
    (start, end), (b_start, b_end) = a.range_along, b.range_along
    t = (s - start) / (end - start)
    along = (1 - t if matched.flipped else t) * (b_end - b_start)
    if matched.shift:
        along = np.mod(along + matched.shift, b_end - b_start)
    return np.asarray(np.clip(b_start + along, b_start, b_end))


def samples_in_spans(breaks: FloatArray, *, ends: bool) -> FloatArray:
    """Return parameters inside every span, and at both ends of all if asked."""
    inside = (breaks[:-1, None] + np.diff(breaks)[:, None] * _FRACTIONS).ravel()
    return np.concatenate([breaks[:1], inside, breaks[-1:]]) if ends else np.asarray(inside)


def snapped_seam(
    a: Base, b: Base, matched: Correspondence, joints: tuple[FloatArray, FloatArray] | None = None
) -> Correspondence:
    """Move each seam of two closed edges that comes close to a knot of the other one onto it.

    The nearest pair decides, whichever edge it is on: the order of the edges does not matter. `joints` are places on
    both, as fractions of their domains, that are to answer each other too where they come so close.
    """
    if not matched.shift:
        return matched
    length = b.range_along[1] - b.range_along[0]
    on_a, on_b = ((base.breakpoints_along() - base.range_along[0]) / np.ptp(base.range_along) for base in (a, b))
    # Shifts, as fractions of b's domain, that put the seam of a on a knot of b, or the seam of b on a knot of a.
    wanted = np.concatenate([on_b, on_a if matched.flipped else 1 - on_a])
    if joints is not None:
        of_a, of_b = joints
        wanted = np.concatenate([wanted, np.subtract.outer(of_b, 1 - of_a if matched.flipped else of_a).ravel()])
    move = np.mod(wanted - matched.shift / length + 0.5, 1.0) - 0.5
    nearest = int(np.abs(move).argmin())
    if abs(move[nearest]) > SNAP:
        return matched
    return replace(matched, shift=float(wanted[nearest] % 1.0) * length)


def merged_spans(a: Base, b: Base, matched: Correspondence) -> FloatArray:
    """Return the breakpoints of both edges in the parameter along edge a."""
    return merge_breakpoints(a.breakpoints_along(), b_breaks_along_a(a, b, matched))


def b_breaks_along_a(a: Base, b: Base, matched: Correspondence) -> FloatArray:
    """Return the breakpoints of edge b, and both ends, in the parameter along edge a: the correspondence backwards."""
    start, end = a.range_along
    b_start, b_end = b.range_along
    t = np.mod((b.breakpoints_along() - b_start - matched.shift) / (b_end - b_start), 1.0)
    on_a = np.sort(start + (1 - t if matched.flipped else t) * (end - start))
    return np.concatenate([[start], on_a, [end]])


def _centred(base: Base, t: FloatArray) -> FloatArray:
    start, end = base.range_along
    points = base.derivative(start + t * (end - start), 0, 0)
    return np.asarray(points - points.mean(axis=0))


def _refined(a: Base, b: Base, matched: Correspondence) -> float:
    """Refine the shift by Newton's method on the correlation of both curves, the integral of <A(t), B(t + shift)>.

    Exact quadrature over the spans of both, of rational edges to rounding, and derivatives of first order only: the
    curves need no more smoothness, and their order does not matter.
    """
    start, end = a.range_along
    length = b.range_along[1] - b.range_along[0]
    degree = 2 * max(row.degree for base in (a, b) for row in base.referee.rows)
    if a.surface.is_rational or b.surface.is_rational:
        degree = max(degree, _OF_QUOTIENTS)
    shift = matched.shift
    for _ in range(_NEWTON_STEPS):
        # A shift of a whole turn is none, but keeps the parameters periodic.
        turned = Correspondence(matched.flipped, shift % length or length)
        nodes, weights = gauss_rule(merged_spans(a, b, turned), degree)
        s, weights = nodes.ravel(), weights.ravel() / (end - start)
        s_b = corresponding(a, b, turned, s)
        on_a, slope_a, slope_b = a.derivative(s, 0, 0), a.derivative(s, 0, 1), b.derivative(s_b, 0, 1)
        rise = float(weights @ np.sum((on_a - weights @ on_a) * slope_b, axis=1))
        # Less the second derivative, integrated by parts: closed curves have no ends.
        bend = float(weights @ np.sum(slope_a * slope_b, axis=1)) * (end - start) / length
        fall = -bend if matched.flipped else bend
        if fall <= 0:
            return matched.shift
        step = rise / fall
        shift += step
        if abs(step) < 1e-15 * length:
            break
    # A search that leaves its sample has no better answer than the sample.
    if not abs(shift - matched.shift) <= 2 * length / _SAMPLES:
        shift = matched.shift
    shift %= length
    return 0.0 if min(shift, length - shift) < CLOSED * length else shift
