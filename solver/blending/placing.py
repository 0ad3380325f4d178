"""The bases of a blend brought together: contact at w = 0, one parameter v, coordinates of size 1."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.matched_maps import VMap, length_map, point_map, run_by
from semispline.solver.blending.matching import matched_edges
from semispline.solver.blending.representative import smooth_along
from semispline.solver.blending.sides import Side, make_side, matched_sides, of_one_degree
from semispline.solver.errors import OptionError
from semispline.solver.judge import Base, Correspondence, is_closed, local_origin
from semispline.solver.options import BlendOptions, Flip
from semispline.solver.splines import BSplineCurve, boundary_curve, closest_point, euclidean

# What is left of a seam's way to where pairs of closed edges say it is, over all of v; and how often it is moved.
_STARTED = 1e-12
_MOST_STARTS = 16


@dataclass(frozen=True, eq=False)
class PlacedSides:
    """The bases as the blend sees them: contact at w = 0, one parameter v.

    Attributes
    ----------
    sides : (Side, Side)
        In model units.
    scaled : (Side, Side)
        In coordinates of size 1.
    frame : (ndarray of shape (3,), float)
        Centre and size: scaled coordinates are (x - centre) / size.
    matched : Correspondence
    """

    sides: tuple[Side, Side]
    scaled: tuple[Side, Side]
    frame: tuple[FloatArray, float]
    matched: Correspondence


def place_sides(
    a: Base,
    b: Base,
    options: BlendOptions,
    flip: Flip,
    matched: Correspondence | None = None,
    *,
    lines_answer: bool = False,
) -> PlacedSides:
    """Bring both contacts to one parameter v and to coordinates of size 1; as `matched`, where that is known."""
    at_a, at_b = options.continuities
    sides = make_side(a, at_a, "base a"), make_side(b, at_b, "base b")
    if lines_answer:
        sides = replace(sides[0], keeps_lines=True), replace(sides[1], keeps_lines=True)
    matched = matched or matched_edges(a, b, flip)
    # Far from the origin each operation would round by the distance: there is but one rounding, of the result.
    origin = local_origin(a.surface, b.surface)
    own = sides[0].moved(origin, 1.0), sides[1].moved(origin, 1.0)
    local = matched_sides(*own, matched)
    if options.match != "affine":
        smooth, by, matched = _matched(a, b, own, matched, options, origin)
        local = smooth[0], run_by(smooth[1], by)
    if not local[0].is_rational:
        local = of_one_degree(*local)
    sides = local[0].moved(-origin, 1.0), local[1].moved(-origin, 1.0)
    centre, size = _frame(*sides)
    scaled = local[0].moved(centre - origin, size), local[1].moved(centre - origin, size)
    return PlacedSides(sides, scaled, (centre, size), matched)


def _pairs_in_v(
    a: Base, b: Base, pairs: tuple[tuple[float, float], ...], matched: Correspondence
) -> list[tuple[float, float]]:
    """Return pairs of parameters along the edges in the blend's own parameter, that of a.

    Raises
    ------
    OptionError
        A parameter outside of its edge.
    """
    (start, end), (b_start, b_end) = a.range_along, b.range_along
    for i, pair in enumerate(pairs):
        for name, x, (low, high) in zip("ab", pair, (a.range_along, b.range_along), strict=True):
            if not low <= x <= high:
                raise OptionError(f"match[{i}]: found {x:g} along edge {name}, expected {low:g} to {high:g}")
    found = []
    for x_a, x_b in pairs:
        t = np.mod(x_b - b_start - matched.shift, b_end - b_start) / (b_end - b_start) if matched.shift else None
        t = (x_b - b_start) / (b_end - b_start) if t is None else t
        found.append((x_a, float(start + (1 - t if matched.flipped else t) * (end - start))))
    return found


def _matched(
    a: Base,
    b: Base,
    own: tuple[Side, Side],
    matched: Correspondence,
    options: BlendOptions,
    origin: FloatArray,
) -> tuple[tuple[Side, Side], VMap, Correspondence]:
    """Return both sides smooth along, the map by which the second one is run through, and where that one starts."""
    closed = is_closed(a) and is_closed(b)
    local = matched_sides(*own, matched)
    smooth = _smooth(local, options)
    if not isinstance(options.match, tuple):
        return smooth, length_map(*smooth, closed=closed), matched
    for _ in range(_MOST_STARTS):
        pairs = _on_smooth(_pairs_in_v(a, b, options.match, matched), local, smooth)
        by, shift = point_map(pairs, smooth[0].along, closed=closed)
        if abs(shift) <= _STARTED * float(np.ptp(smooth[0].along.knots)):
            break
        # A smooth circle that starts elsewhere is run through a little otherwise: what is left is less each time.
        matched = _started_later(b, matched, smooth[1], shift, origin)
        local = matched_sides(*own, matched)
        smooth = _smooth(local, options)
    return smooth, by, matched


def _smooth(sides: tuple[Side, Side], options: BlendOptions) -> tuple[Side, Side]:
    """Return both sides smooth along, as the blend has them: a cure that came later would undo what is matched."""
    (a, _), (b, _) = smooth_along(*sides, options)
    return a, b


def _on_smooth(
    pairs: list[tuple[float, float]], sides: tuple[Side, Side], smooth: tuple[Side, Side]
) -> list[tuple[float, float]]:
    """Return pairs of values of v of two sides as those by which they are run through where they are smooth."""
    values = zip(zip(*pairs, strict=True), sides, smooth, strict=True)
    return list(zip(*(_same_place(v, side, other) for v, side, other in values), strict=True))


def _same_place(values: Sequence[float], side: Side, smooth: Side) -> list[float]:
    if smooth is side:
        return list(values)
    ends = float(side.along.knots[0]), float(side.along.knots[-1])
    points = side.edge(np.array(values))[0]
    # A seam is both of its ends.
    return [v if v in ends else _foot(smooth, point) for v, point in zip(values, points, strict=True)]


def _foot(side: Side, point: FloatArray) -> float:
    curve = BSplineCurve(side.along.degree, side.along.knots, *euclidean(side.rows[0]))
    return float(np.ravel(closest_point(curve, point).parameters)[0])


def _started_later(b: Base, matched: Correspondence, side: Side, shift: float, origin: FloatArray) -> Correspondence:
    """Return the correspondence by which edge a starts at what is `shift` later in v on b, whose side is given."""
    start, end = float(side.along.knots[0]), float(side.along.knots[-1])
    at = side.edge(np.array([start + np.mod(shift, end - start)]))[0][0] + origin
    first, last = b.range_along
    place = float(np.ravel(closest_point(boundary_curve(b.surface, b.side), at).parameters)[0])
    return replace(matched, shift=float(np.mod(place - first, last - first)))


def _frame(a: Side, b: Side) -> tuple[FloatArray, float]:
    """Centre and size of the control points that contact reads: the solve works in coordinates of size 1."""
    points = np.concatenate([side.points() for side in (a, b)])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0
