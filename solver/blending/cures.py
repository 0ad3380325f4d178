"""One answer to knot lines where the rows of a side are only continuous: which cure acts, and what it leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.conics import Conic, recognised_conic
from semispline.solver.blending.jumps import Jump, jumps, smoothed
from semispline.solver.blending.own_lines import closed_lines
from semispline.solver.blending.weights import SEPARABLE
from semispline.solver.splines import Basis

CureName: TypeAlias = Literal["none", "conic", "spans", "slopes"]
# Degrees along above this are worth less than a crease that is said.
_MOST_DEGREE = 25


@dataclass(frozen=True, eq=False)
class CuredRows:
    """Rows of a side, C1 along wherever the base allows it.

    Attributes
    ----------
    rows : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
    along : Basis
    degree : int
        Across; the distances to the next knots stay those of the base.
    cure : {"none", "conic", "spans", "slopes"}
        "conic": the rim is run through by a smooth circle, C2 at least. "spans": spans were scaled (with weights, a
        factor along came to it), C1. "slopes": slopes of the reparametrisation beside lines where the base is G1, C1.
    found : tuple of Jump
        The lines of the base that asked for it.
    left : tuple of Jump
        Lines that are still not C1: creased in the base itself, or G1 where no cure is exact.
    conic : Conic or None
        What the rim is where "conic" acts.
    """

    rows: FloatArray
    along: Basis
    degree: int
    cure: CureName
    found: tuple[Jump, ...]
    left: tuple[Jump, ...]
    conic: Conic | None = None


@dataclass(frozen=True)
class Cure:
    """What was done to knot lines where the rows of a side are only continuous.

    Attributes
    ----------
    name : {"none", "conic", "spans", "slopes"}
    words : str
    left : tuple of Jump
        Lines at which the blend is not smooth all the same.
    """

    name: CureName
    words: str
    left: tuple[Jump, ...]


def cured_rows(
    rows: FloatArray,
    along: Basis,
    degree: int,
    spans: tuple[float, ...],
    *,
    smoothness: int = 2,
    closed: bool = False,
    largest: float = 0.0,
) -> CuredRows:
    """Return rows of the same base that are as smooth along as can be had exactly.

    Parameters
    ----------
    rows : ndarray, shape (order + 1, n, 3) or (order + 1, n, 4)
        Rows 0 to the order of contact from the edge inwards; homogeneous where they have four columns.
    along : Basis
    degree : int
        Of the base, across.
    spans : tuple of float
        Distances from the edge to the next knots across.
    smoothness : int
        Of a cured conic: the higher order of contact of both sides, so that both are cured alike.
    closed : bool
    largest : float
        Largest coordinate that the rows were given in, whatever origin they are counted from now.

    Examples
    --------
    >>> rows = np.array([[[0, 0, 0], [1, 0, 0], [3.0, 0, 0]], [[0, 1, 0], [1, 1, 0], [3.0, 1, 0]]])
    >>> found = cured_rows(rows, Basis(1, np.array([0, 0, 1, 2, 2.0])), 1, (1.0,))
    >>> found.cure, found.along.knots.tolist(), found.left
    ('spans', [0.0, 0.0, 2.0, 2.0], ())
    """
    found = jumps(rows, along, degree, spans, closed=closed, largest=largest)
    if not found:
        return CuredRows(rows, along, degree, "none", (), ())
    # A parabola without weights along keeps its degree, and stays without them.
    has_weights = rows.shape[-1] == 4 and np.ptp(rows[0, :, 3]) > SEPARABLE * np.abs(rows[0, :, 3]).max()
    conic = recognised_conic(rows, along) if has_weights else None
    if conic is not None and (smooth := conic.cured_rows(smoothness)) is not None:
        return CuredRows(*smooth, degree, "conic", found, (), conic)
    kinds = {jump.kind for jump in found}
    if kinds in ({"G1"}, {"G1", "shared"}):
        bent = closed_lines(rows, along, degree, spans, closed=closed)
        if bent is not None and bent[1].degree <= _MOST_DEGREE:
            left = jumps(bent[0], bent[1], bent[2], spans, closed=closed, largest=largest)
            return CuredRows(*bent, "slopes", found, left)
    new, basis = smoothed(rows, along, found, closed=closed)
    if basis is along or basis.degree > _MOST_DEGREE:
        return CuredRows(rows, along, degree, "none", found, found)
    left = jumps(new, basis, degree, spans, closed=closed, largest=largest)
    return CuredRows(new, basis, degree, "spans", found, left)
