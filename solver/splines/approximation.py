"""Curves and surfaces that stand for others, and how far they are from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from semispline.solver.splines.surfaces import BSplineCurve, BSplineSurface, SemiStructuredSurface

S = TypeVar("S", BSplineSurface, SemiStructuredSurface)


@dataclass(frozen=True, eq=False)
class Approximation(Generic[S]):
    """A surface that stands for another.

    Attributes
    ----------
    surface : BSplineSurface or SemiStructuredSurface
    error : float
        No point is farther than this from the point of the other surface with the same parameters; in model units.
    """

    surface: S
    error: float


@dataclass(frozen=True, eq=False)
class CurveApproximation:
    """A curve that stands for another.

    Attributes
    ----------
    curve : BSplineCurve
    error : float
        No point is farther than this from the point of the other curve with the same parameter; in model units.
    """

    curve: BSplineCurve
    error: float
