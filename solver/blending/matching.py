"""How the edges of two bases correspond for a blend: closed rims that are conics by angle, whatever their parameter.

A rim that is a conic is run through by a smooth circle in the blend, so that its own parameter says nothing of where
the blend's rulings meet it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.conics import recognised_conic
from semispline.solver.judge import Base, Correspondence, correspond, is_closed, snapped_seam, tied_directions
from semispline.solver.options import Flip
from semispline.solver.splines import (
    Basis,
    BSplineSurface,
    boundary_curve,
    closest_point,
    euclidean,
)

# A shift below this part of the rim is none.
_NO_SHIFT = 1e-9
# Spans for each that a blend has: what faces what is then a matter of angle, to .001 degree.
_FINER = 4
_LINE = np.array([0.0, 0.0, 1.0, 1.0])


def matched_edges(
    a: Base, b: Base, flip: Flip, joints: tuple[Sequence[float], Sequence[float]] = ((), ())
) -> Correspondence:
    """Return how edge b runs along edge a, and where it starts, in b's own parameter.

    `joints` are where faces meet along chains: at a place where one of each side nearly answers the other, they do.
    """
    by_angle = run_by_angle(a), run_by_angle(b)
    shares = _shares(a, by_angle[0], joints[0]), _shares(b, by_angle[1], joints[1])
    matched = snapped_seam(*by_angle, correspond(*by_angle, flip), shares)
    if by_angle[1] is b or not matched.shift:
        return matched
    start, end = by_angle[1].range_along
    at = by_angle[1].derivative(np.array([start + matched.shift % (end - start)]), 0, 0)[0]
    first, last = b.range_along
    found = closest_point(boundary_curve(b.surface, b.side), at).parameters
    shift = (float(np.ravel(found)[0]) - first) % (last - first)
    return replace(matched, shift=0.0 if min(shift, last - first - shift) < _NO_SHIFT * (last - first) else shift)


def _shares(base: Base, by_angle: Base, places: Sequence[float]) -> FloatArray:
    """Return places along an edge, as shares of the range in which it is run through; its seam too."""
    start, end = by_angle.range_along
    if base is not by_angle and len(places):
        curve = boundary_curve(by_angle.surface, by_angle.side)
        points = base.derivative(np.array(places), 0, 0)
        places = [float(np.ravel(closest_point(curve, point).parameters)[0]) for point in points]
    return np.append((np.array(places, dtype=np.float64) - start) / (end - start), 0.0)


def directions_to_try(a: Base, b: Base) -> tuple[Flip, ...]:
    """Return the directions of b that closeness leaves open."""
    return tied_directions(run_by_angle(a), run_by_angle(b))


def run_by_angle(base: Base) -> Base:
    """Return a strip of the same surface beside a closed rim that is a conic, smooth along; any other base as it is."""
    surface = base.surface
    if not isinstance(surface, BSplineSurface) or surface.weights is None or not is_closed(base):
        return base
    is_v = base.side[0] == "v"
    net = surface.homogeneous.transpose(1, 0, 2) if is_v else surface.homogeneous
    along = Basis(surface.degree_u, surface.knots_u) if is_v else Basis(surface.degree_v, surface.knots_v)
    rows = net[:2] if base.side[1] == "0" else net[-2:][::-1]
    conic = recognised_conic(rows, along)
    if conic is None:
        return base
    smooth, basis = conic.smooth_rows(2, _FINER)
    if not (smooth[..., 3] > 0).all():
        return base
    points, weights = euclidean(smooth if base.side[1] == "0" else smooth[::-1])
    if weights is None:
        return base
    if is_v:
        points, weights = points.transpose(1, 0, 2), weights.T
        return Base(BSplineSurface(basis.degree, 1, basis.knots, _LINE, points, weights), base.side)
    return Base(BSplineSurface(1, basis.degree, _LINE, basis.knots, points, weights), base.side)
