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
# A seam this close to a knot of the other edge, as a fraction of the domain, is moved onto it: across a span h the
# rounding of control points bends a curve by 1e-16 / h^2, which is to stay below 1e-8.
SNAP = 1e-4
_SAMPLES = 256
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
    sums alike but keeps the rounding of a large offset out of the comparison. A tie keeps the direction. The shift is
    exact up to rounding, and the same whichever edge comes first.

    Raises
    ------
    EdgeError
        `flip` is not one of auto, yes, no.
    """
    if flip not in get_args(Flip):
        raise EdgeError(f"flip: found {flip!r}, expected one of auto, yes, no")
    closed = is_closed(a) and is_closed(b)
    # Closed curves are sampled from the seam on, so that shifts by whole steps meet equal parameters.
    t = (np.arange(_SAMPLES) + (0.0 if closed else 0.5)) / _SAMPLES
    first, second = (_centred(base, t) for base in (a, b))
    candidates = []
    for flipped in (False, True) if flip == "auto" else (flip == "yes",):
        turned = (np.roll(second[::-1], 1, axis=0) if closed else second[::-1]) if flipped else second
        # Distance grows as the correlation falls: its terms of one curve alone do not depend on the match.
        steps = range(_SAMPLES if closed else 1)
        shifted = np.lib.stride_tricks.sliding_window_view(np.concatenate([turned, turned]), _SAMPLES, axis=0)
        correlation = np.einsum("ix,kxi->k", first, shifted[: len(steps)])
        best = int(correlation.argmax())
        candidates.append((float(correlation[best]), flipped, best))
    slack = 1e-9 * float(np.sum(first**2) + np.sum(second**2))
    value, flipped, step = candidates[0]
    if len(candidates) > 1 and candidates[1][0] > value + slack:
        value, flipped, step = candidates[1]
    if not closed:
        return Correspondence(flipped)
    length = b.range_along[1] - b.range_along[0]
    guess = (-step if flipped else step) % _SAMPLES / _SAMPLES * length
    return Correspondence(flipped, _refined(a, b, Correspondence(flipped, guess)))


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


def corresponding_samples(a: Base, b: Base, matched: Correspondence) -> tuple[FloatArray, FloatArray]:
    """Return parameters along edge a and along edge b that correspond, in every span of both and at the ends.

    Where one edge is closed and starts inside the other the ends are left out: the other may have a crease there.
    """
    start, end = a.range_along
    merged = _merged_spans(a, b, matched)
    inside = (merged[:-1, None] + np.diff(merged)[:, None] * _FRACTIONS).ravel()
    s_a = inside if matched.shift else np.concatenate([[start], inside, [end]])
    return s_a, corresponding(a, b, matched, s_a)


def snapped_seam(a: Base, b: Base, matched: Correspondence) -> Correspondence:
    """Move each seam of two closed edges that comes close to a knot of the other one onto it.

    The nearest pair decides, whichever edge it is on: the order of the edges does not matter.
    """
    if not matched.shift:
        return matched
    length = b.range_along[1] - b.range_along[0]
    on_a, on_b = ((base.breakpoints_along() - base.range_along[0]) / np.ptp(base.range_along) for base in (a, b))
    # Shifts, as fractions of b's domain, that put the seam of a on a knot of b, or the seam of b on a knot of a.
    wanted = np.concatenate([on_b, on_a if matched.flipped else 1 - on_a])
    move = np.mod(wanted - matched.shift / length + 0.5, 1.0) - 0.5
    nearest = int(np.abs(move).argmin())
    if abs(move[nearest]) > SNAP:
        return matched
    return replace(matched, shift=float(wanted[nearest] % 1.0) * length)


def _merged_spans(a: Base, b: Base, matched: Correspondence) -> FloatArray:
    """Return the breakpoints of both edges in the parameter along edge a; b's by the correspondence backwards."""
    start, end = a.range_along
    b_start, b_end = b.range_along
    t = np.mod((b.breakpoints_along() - b_start - matched.shift) / (b_end - b_start), 1.0)
    on_a = np.sort(start + (1 - t if matched.flipped else t) * (end - start))
    return merge_breakpoints(a.breakpoints_along(), np.concatenate([[start], on_a, [end]]))


def _centred(base: Base, t: FloatArray) -> FloatArray:
    start, end = base.range_along
    points = base.derivative(start + t * (end - start), 0, 0)
    return np.asarray(points - points.mean(axis=0))


def _refined(a: Base, b: Base, matched: Correspondence) -> float:
    """Refine the shift by Newton's method on the correlation of both curves, the integral of <A(t), B(t + shift)>.

    Exact quadrature over the spans of both, and derivatives of first order only: the curves need no more smoothness,
    and their order does not matter.
    """
    start, end = a.range_along
    length = b.range_along[1] - b.range_along[0]
    degree = 2 * max(row.degree for base in (a, b) for row in base.referee.rows)
    shift = matched.shift
    for _ in range(_NEWTON_STEPS):
        # A shift of a whole turn is none, but keeps the parameters periodic.
        turned = Correspondence(matched.flipped, shift % length or length)
        nodes, weights = gauss_rule(_merged_spans(a, b, turned), degree)
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
