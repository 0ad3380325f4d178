"""A surface and the edge along which it is met."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from semispline.solver.arrays import FloatArray, exact_origin
from semispline.solver.judge.de_boor import EdgeCurves, edge_curves
from semispline.solver.splines import NaturalEdge, Surface, bounding_box, cut_to_edge, parse_edge


@dataclass(frozen=True)
class Base:
    """A surface and the edge along which it is met.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
        Of which the part that the edge bounds is kept, exactly, in the surface's own parameters.
    edge : str
        u0, u1, v0 or v1: the parameter that is constant along the edge, and at which end of its range; a part of such
        an edge, u1[0.2,0.6]; a line inside, u=0.3+ or u=0.3-, with the side that is kept; or a part of that,
        u=0.3+[0.2,0.6].

    Raises
    ------
    EdgeError
        No name of an edge, or one that this surface does not have: see `cut_to_edge`.

    Examples
    --------
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> square = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]])
    >>> base = Base(square, "u=0.25+[0.5,1]")
    >>> base.edge, base.side, base.surface.domain
    ('u=0.25+[0.5,1]', 'u0', ((0.25, 1.0), (0.5, 1.0)))
    """

    surface: Surface
    edge: str

    def __post_init__(self) -> None:
        name = parse_edge(self.edge)
        object.__setattr__(self, "surface", cut_to_edge(self.surface, name)[0])
        object.__setattr__(self, "edge", str(name))

    @cached_property
    def side(self) -> NaturalEdge:
        """What the edge is called on the part of the surface that is kept."""
        return parse_edge(self.edge).natural

    @property
    def range_along(self) -> tuple[float, float]:
        """The range of the parameter that runs along the edge."""
        return self.surface.domain[1 if self.edge[0] == "u" else 0]

    @cached_property
    def referee(self) -> EdgeCurves:
        """The referee's view of the edge: derivatives up to order 2."""
        return edge_curves(self.surface, self.side)

    def derivative(self, s: FloatArray, across: int, along: int) -> FloatArray:
        """Referee's derivative at parameters s along the edge, shape (K, 3), in the surface's own parameters.

        Orders add up to at most 2.
        """
        return self.referee.points(s, across + along)[across, along]

    def breakpoints_along(self) -> FloatArray:
        """Return breakpoints of the parameter that runs along the edge."""
        return self.surface.breakpoints[1 if self.edge[0] == "u" else 0]


def local_origin(*surfaces: Surface) -> FloatArray:
    """Return a point near the surfaces that each control point less it is exact, shape (3,), by `exact_origin`."""
    return exact_origin(np.concatenate([bounding_box(surface) for surface in surfaces]))
