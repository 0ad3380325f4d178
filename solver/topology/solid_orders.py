"""What one process tells another that is to be done to a solid, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass

from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.solid_gate import GateReport


@dataclass(frozen=True, eq=False)
class NewFace:
    """A face to be taken out, and the surface that takes its place.

    Attributes
    ----------
    face : int
        N of `PATH#N`.
    contacts : pair of tuples of int
        k of the edges "ek" along each contact, as the wire of the face walks them.
    surface : BSplineSurface
        u from the first contact to the second.
    a, b : pair of float, or None
        v where the contacts begin and end, both in the direction in which the wire walks the first; None of closed
        ones.
    kept : tuple of int
        k of the end edges that stay as they are.
    """

    face: int
    contacts: tuple[tuple[int, ...], tuple[int, ...]]
    surface: BSplineSurface
    a: tuple[float, float] | None = None
    b: tuple[float, float] | None = None
    kept: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Replacement:
    """Faces to be taken out together; where they go on into each other the new ones meet in one curve."""

    faces: tuple[NewFace, ...]

    @property
    def face(self) -> int:
        """The first one."""
        return self.faces[0].face


@dataclass(frozen=True, eq=False)
class Rounding:
    """A sharp edge to be rounded, and the surface that is put there.

    Attributes
    ----------
    face, edge : int
        N of `PATH#N`, and k of its edge "ek".
    surface : BSplineSurface
        u from that face to the one beyond the edge.
    grows : bool
        An inner edge: the volume has to become more.
    """

    face: int
    edge: int
    surface: BSplineSurface
    grows: bool


@dataclass(frozen=True, eq=False)
class Outcome:
    """What came of it.

    Attributes
    ----------
    report : GateReport
    read_back : GateReport or None
        Of what was written and read again; None where nothing was written.
    content : bytes or None
        The file; None where the gate stopped it.
    touched : tuple of int
        Faces whose borders were changed, by their numbers in the part.
    new : tuple of int
        The new faces, by their numbers in the file; where nothing was written by those in the part.
    times : int
        How often the changed part stands in the file.
    notes : tuple of str
        What else is to be said.
    """

    report: GateReport
    read_back: GateReport | None
    content: bytes | None
    touched: tuple[int, ...]
    new: tuple[int, ...]
    times: int
    notes: tuple[str, ...] = ()
