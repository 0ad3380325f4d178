"""Surfaces from rows of control points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.splines import Basis, BSplineCurve, BSplineSurface, SemiStructuredSurface, uniform_knots


def u_basis(rows: int, degree: int = 3) -> Basis:
    """Return U for a number of rows: clamped on [0, 1], uniform, as the paper chooses it.

    Examples
    --------
    >>> u_basis(7).knots[4:-4]
    array([0.25, 0.5 , 0.75])
    """
    return Basis(degree, uniform_knots(degree, rows - degree))


def semistructured_surface(u: Basis, bases: Sequence[Basis], rows: Sequence[FloatArray]) -> SemiStructuredSurface:
    """Return the surface with these rows, each over its own knots."""
    curves = [BSplineCurve(basis.degree, basis.knots, row) for basis, row in zip(bases, rows, strict=True)]
    return SemiStructuredSurface(u.degree, u.knots, tuple(curves))


def tensor_product(u: Basis, v: Basis, rows: Sequence[FloatArray]) -> BSplineSurface:
    """Return the surface with these rows, all over the same knots."""
    return BSplineSurface(u.degree, v.degree, u.knots, v.knots, np.stack(rows))
