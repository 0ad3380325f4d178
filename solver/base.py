"""A surface and the edge along which it is met."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias, get_args

import numpy as np

from solver.arrays import FloatArray
from solver.de_boor import surface_points
from solver.errors import EdgeError
from solver.operations import swap_directions
from solver.surfaces import BSplineSurface, Surface

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
    def _rows_along(self) -> tuple[Surface, bool]:
        """The surface with v along the edge if it is a B-spline surface, and whether v is.

        The referee evaluates every row in v first: there must be few rows, not many that are short.
        """
        if self.edge[0] == "v" and isinstance(self.surface, BSplineSurface):
            return swap_directions(self.surface), True
        return self.surface, self.edge[0] == "u"

    def derivative(self, s: FloatArray, across: int, along: int) -> FloatArray:
        """Referee's derivative at parameters s along the edge, shape (K, 3), in the surface's own parameters."""
        at = np.full_like(s, self.surface.domain[0 if self.edge[0] == "u" else 1][int(self.edge[1])])
        surface, v_is_along = self._rows_along
        if v_is_along:
            return surface_points(surface, at, s, across, along)
        return surface_points(surface, s, at, along, across)

    def breakpoints_along(self) -> FloatArray:
        """Return breakpoints of the parameter that runs along the edge."""
        return self.surface.breakpoints[1 if self.edge[0] == "u" else 0]
