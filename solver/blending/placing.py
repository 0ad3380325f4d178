"""The bases of a blend brought together: contact at w = 0, one parameter v, coordinates of size 1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.matching import matched_edges
from semispline.solver.blending.sides import Side, make_side, matched_sides, of_one_degree
from semispline.solver.judge import Base, Correspondence, local_origin
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


def place_sides(a: Base, b: Base, options: BlendOptions, flip: Flip, matched: Correspondence | None) -> PlacedSides:
    """Bring both contacts to one parameter v and to coordinates of size 1; as `matched`, where that is known."""
    at_a, at_b = options.continuities
    sides = make_side(a, at_a, "base a"), make_side(b, at_b, "base b")
    matched = matched or matched_edges(a, b, flip)
    # Far from the origin each operation would round by the distance: there is but one rounding, of the result.
    origin = local_origin(a.surface, b.surface)
    local = matched_sides(sides[0].moved(origin, 1.0), sides[1].moved(origin, 1.0), matched)
    if not local[0].is_rational:
        local = of_one_degree(*local)
    sides = local[0].moved(-origin, 1.0), local[1].moved(-origin, 1.0)
    centre, size = _frame(*sides)
    scaled = local[0].moved(centre - origin, size), local[1].moved(centre - origin, size)
    return PlacedSides(sides, scaled, (centre, size), matched)


def _frame(a: Side, b: Side) -> tuple[FloatArray, float]:
    """Centre and size of the control points that contact reads: the solve works in coordinates of size 1."""
    points = np.concatenate([side.points() for side in (a, b)])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0
