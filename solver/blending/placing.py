"""The bases of a blend brought together: contact at w = 0, one parameter v, coordinates of size 1."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.end_faces import HeldEnd
from semispline.solver.blending.matched_maps import length_map, point_map, run_by
from semispline.solver.blending.matching import matched_edges
from semispline.solver.blending.sides import Side, make_side, matched_sides, of_one_degree
from semispline.solver.errors import OptionError
from semispline.solver.judge import Base, Correspondence, corresponding, is_closed, local_origin
from semispline.solver.options import BlendOptions, Flip


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
    held: tuple[HeldEnd, ...] = (),
) -> PlacedSides:
    """Bring both contacts to one parameter v and to coordinates of size 1; as `matched`, where that is known."""
    at_a, at_b = options.continuities
    sides = make_side(a, at_a, "base a"), make_side(b, at_b, "base b")
    if lines_answer:
        sides = replace(sides[0], keeps_lines=True), replace(sides[1], keeps_lines=True)
    sides = replace(sides[0], held=held), sides[1]
    matched = matched or matched_edges(a, b, flip)
    pairs = _pairs_in_v(a, b, options.match, matched) if isinstance(options.match, tuple) else None
    by = None
    if pairs is not None:
        by, shift = point_map(pairs, sides[0].along, closed=is_closed(a) and is_closed(b))
        if shift:
            matched = _started_later(a, b, matched, shift)
    # Far from the origin each operation would round by the distance: there is but one rounding, of the result.
    origin = local_origin(a.surface, b.surface)
    local = matched_sides(sides[0].moved(origin, 1.0), sides[1].moved(origin, 1.0), matched)
    if options.match == "length":
        by = length_map(*local)
    if by is not None:
        local = local[0], run_by(local[1], by)
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


def _started_later(a: Base, b: Base, matched: Correspondence, shift: float) -> Correspondence:
    """Return the correspondence by which the start of edge a meets what was `shift` later in v."""
    start, end = a.range_along
    at = start + np.mod(shift, end - start)
    first, last = b.range_along
    place = float(corresponding(a, b, matched, np.array([at]))[0])
    return replace(matched, shift=float(np.mod(place - first, last - first)))


def _frame(a: Side, b: Side) -> tuple[FloatArray, float]:
    """Centre and size of the control points that contact reads: the solve works in coordinates of size 1."""
    points = np.concatenate([side.points() for side in (a, b)])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0
