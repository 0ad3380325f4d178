"""The bases of a blend brought together: contact at w = 0, one parameter v, coordinates of size 1."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.end_faces import HeldEnd
from semispline.solver.blending.matched_maps import length_map, point_map, run_by
from semispline.solver.blending.matching import matched_edges
from semispline.solver.blending.representative import smooth_sides
from semispline.solver.blending.sides import Side, make_side, matched_sides, of_one_degree
from semispline.solver.errors import OptionError
from semispline.solver.judge import Base, Correspondence, is_closed, local_origin
from semispline.solver.options import BlendOptions, Flip
from semispline.solver.splines import BSplineCurve, boundary_curve, closest_point, euclidean


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
    joints: tuple[Sequence[float], Sequence[float]] = ((), ()),
) -> PlacedSides:
    """Bring both contacts to one parameter v and to coordinates of size 1; as `matched`, where that is known.

    Else joints, places along both, answer each other where they nearly do.
    """
    at_a, at_b = options.continuities
    sides = make_side(a, at_a, "base a"), make_side(b, at_b, "base b")
    if lines_answer:
        sides = replace(sides[0], keeps_lines=True), replace(sides[1], keeps_lines=True)
    sides = replace(sides[0], held=held), sides[1]
    matched = matched or matched_edges(a, b, flip, joints)
    # Far from the origin each operation would round by the distance: there is but one rounding, of the result.
    origin = local_origin(a.surface, b.surface)
    local = matched_sides(sides[0].moved(origin, 1.0), sides[1].moved(origin, 1.0), matched)
    if options.match != "affine":
        local, matched = _answering(a, b, local, options.match, matched, origin)
    if not local[0].is_rational:
        local = of_one_degree(*local)
    sides = local[0].moved(-origin, 1.0), local[1].moved(-origin, 1.0)
    centre, size = _frame(*sides)
    scaled = local[0].moved(centre - origin, size), local[1].moved(centre - origin, size)
    return PlacedSides(sides, scaled, (centre, size), matched)


def _answering(
    a: Base,
    b: Base,
    sides: tuple[Side, Side],
    match: str | Sequence[tuple[float, float]],
    matched: Correspondence,
    origin: FloatArray,
) -> tuple[tuple[Side, Side], Correspondence]:
    """Return sides of which b is run through so that what is to answer each other has one v.

    Errors as `point_map`, and for parameters that lie outside of their edge.
    """
    # Lines at which rows are only continuous are cured first: that runs through the sides anew.
    one, other = (replace(side, cure=cure, keeps_lines=True) for side, cure in smooth_sides(*sides, shared=False))
    closed = is_closed(a) and is_closed(b)
    if isinstance(match, str):
        return (one, run_by(other, length_map(one, other, closed=closed))), matched
    found = []
    for i, pair in enumerate(match):
        places = []
        for name, x, base, side in zip("ab", pair, (a, b), (one, other), strict=True):
            low, high = base.range_along
            if not low <= x <= high:
                raise OptionError(f"match[{i}]: found {x:g} along edge {name}, expected {low:g} to {high:g}")
            places.append(_foot(_contact(side), base.derivative(np.array([x]), 0, 0)[0] - origin))
        found.append((places[0], places[1]))
    by = point_map(found, one.along, closed=closed)
    first = float(by.function(by.function.x[0]))
    if first > one.along.knots[0]:
        start, end = b.range_along
        point = _contact(other).evaluate(np.array([first]))[0] + origin
        at = _foot(boundary_curve(b.surface, b.side), point)
        matched = replace(matched, shift=float(np.mod(at - start, end - start)))
    return (one, run_by(other, by)), matched


def _contact(side: Side) -> BSplineCurve:
    row = side.rows[0]
    points, weights = euclidean(row) if side.is_rational else (row, None)
    return BSplineCurve(side.along.degree, side.along.knots, points, weights)


def _foot(curve: BSplineCurve, point: FloatArray) -> float:
    return float(np.ravel(closest_point(curve, point).parameters)[0])


def _frame(a: Side, b: Side) -> tuple[FloatArray, float]:
    """Centre and size of the control points that contact reads: the solve works in coordinates of size 1."""
    points = np.concatenate([side.points() for side in (a, b)])
    low, high = points.min(axis=0), points.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0
