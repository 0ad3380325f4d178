"""A surface and the edge along which it is met."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from solver.arrays import FloatArray
from solver.de_boor import surface_points
from solver.errors import EdgeError
from solver.surfaces import Surface

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

    def derivative(self, s: FloatArray, across: int, along: int) -> FloatArray:
        """Referee's derivative at parameters s along the edge, shape (K, 3), in the surface's own parameters."""
        constant = 0 if self.edge[0] == "u" else 1
        at = np.full_like(s, self.surface.domain[constant][int(self.edge[1])])
        if constant == 0:
            return surface_points(self.surface, at, s, across, along)
        return surface_points(self.surface, s, at, along, across)

    def breakpoints_along(self) -> FloatArray:
        """Return breakpoints of the parameter that runs along the edge."""
        return self.surface.breakpoints[1 if self.edge[0] == "u" else 0]
