"""What shape a finished surface has, all measures in one: what to look at before it is kept."""

from __future__ import annotations

from dataclasses import dataclass

from semispline.solver.judge.base import Base
from semispline.solver.judge.bezier_pieces import in_pieces
from semispline.solver.judge.curvature_range import CurvatureRange, measure_curvature_range
from semispline.solver.judge.fairness import Fairness, measure_fairness
from semispline.solver.judge.loops import Exits, Loop, measure_exits, measure_loop
from semispline.solver.judge.meets import Meets, measure_meets
from semispline.solver.judge.parametric import ParametricSurface
from semispline.solver.judge.turning import Turn, measure_turn
from semispline.solver.judge.waist import Waist, measure_waist


@dataclass(frozen=True)
class ShapeReport:
    """What shape a surface has, u running from its start to its end.

    Attributes
    ----------
    turn : Turn
        How sharply it turns, and where; above 90 degrees it folds.
    fairness : Fairness
        How its mean curvature varies: area times integral of |grad H|^2, with what jumps of H add.
    curvatures : CurvatureRange
        Least and largest principal curvature.
    waist : Waist or None
        Closed in v: how far it is pinched, and how far straight rulings are.
    loop : Loop
        How much further a section v = const turns than its exits need; above 60 degrees it loops.
    exits : Exits
        How these sections leave their ends.
    meets : Meets
        Whether it meets itself or its bases.
    """

    turn: Turn
    fairness: Fairness
    curvatures: CurvatureRange
    waist: Waist | None
    loop: Loop
    exits: Exits
    meets: Meets


def measure_shape(
    surface: ParametricSurface, a: Base | None = None, b: Base | None = None, *, search_meets: bool = False
) -> ShapeReport:
    """Return all measures of shape of a surface.

    Parameters
    ----------
    surface : BSplineSurface, SemiStructuredSurface or ParametricSurface
        One that evaluates derivatives up to third order.
    a, b : Base, optional
        What it joins at the start and at the end of u.
    search_meets : bool
        Whether to search a mesh for places where it meets itself or a base, if no direction shows that there are none.

    Raises
    ------
    InputError
        It has no tangent plane anywhere, or its sections v = const have no length.
    EdgeError
        The edge of a base is not the surface's.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> flat = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> shape = measure_shape(flat)
    >>> shape.turn.degrees, shape.fairness.value, shape.waist, shape.meets.answer("itself")
    (0.0, 0.0, None, False)
    """
    pieces = in_pieces(surface)
    return ShapeReport(
        measure_turn(pieces),
        measure_fairness(pieces),
        measure_curvature_range(pieces),
        measure_waist(pieces),
        measure_loop(pieces),
        measure_exits(pieces),
        measure_meets(pieces, a, b, search=search_meets),
    )
