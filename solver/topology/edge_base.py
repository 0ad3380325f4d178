"""What a blend takes along an edge of a face: the surface of the face, a band along it, or a chain of these."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import Chain
from semispline.solver.judge import Base
from semispline.solver.topology.bands import Band
from semispline.solver.topology.trim_curves import TrimCurve


@dataclass(frozen=True, eq=False)
class EdgeBase:
    """A base of a blend along an edge of a face, along a part of it, or along several that run end to end.

    Attributes
    ----------
    name : str
        As edges are named: "u1", "e3"; "e3[0]" where the edge was cut; "e3+13:e1".
    base : Base or Chain
        What is blended: the surface of the face, a band along a free curve, or a chain of these.
    band : Band or None
    curve : TrimCurve or None
        The free curve, with the surface of its face.
    members : tuple of EdgeBase
        Of a chain its edges.
    millimetres : float or None
        In one model unit, where that is known.
    """

    name: str
    base: Base | Chain
    band: Band | None = None
    curve: TrimCurve | None = None
    members: tuple[EdgeBase, ...] = ()
    millimetres: float | None = None

    @property
    def bases(self) -> tuple[Base, ...]:
        """The base, or those of the chain."""
        return self.base.edges if isinstance(self.base, Chain) else (self.base,)

    @property
    def end_points(self) -> tuple[FloatArray, FloatArray]:
        """The points where the base starts and where it ends."""
        bases = self.bases
        turned = self.base.turned if isinstance(self.base, Chain) else (False,)
        first, last = bases[0].range_along[turned[0]], bases[-1].range_along[not turned[-1]]
        return bases[0].derivative(np.array([first]), 0, 0)[0], bases[-1].derivative(np.array([last]), 0, 0)[0]

    @property
    def parts(self) -> tuple[EdgeBase, ...]:
        """The edges of the chain, or the one edge."""
        return self.members or (self,)
