"""A surface and the edge along which it is met."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias, get_args

import numpy as np

from semispline.solver.arrays import FloatArray, exact_origin
from semispline.solver.errors import EdgeError
from semispline.solver.judge.de_boor import EdgeCurves, edge_curves
from semispline.solver.splines import Surface, bounding_box

Edge: TypeAlias = Literal["u0", "u1", "v0", "v1"]


@dataclass(frozen=True)
class Base:
    """A surface and the edge along which it is met.

    Parameters
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    edge : {"u0", "u1", "v0", "v1"}
        The parameter that is constant along the edge, and at which end of its range.

    Raises
    ------
    EdgeError
        The edge is not one of the four.
    """

    surface: Surface
    edge: Edge

    def __post_init__(self) -> None:
        if self.edge not in get_args(Edge):
            raise EdgeError(f"edge: found {self.edge!r}, expected one of u0, u1, v0, v1")

    @property
    def range_along(self) -> tuple[float, float]:
        """The range of the parameter that runs along the edge."""
        return self.surface.domain[1 if self.edge[0] == "u" else 0]

    @cached_property
    def referee(self) -> EdgeCurves:
        """The referee's view of the edge: derivatives up to order 2."""
        return edge_curves(self.surface, self.edge)

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
