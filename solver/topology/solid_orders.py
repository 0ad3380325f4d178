"""What one process tells another that is to be done to a solid, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass

from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.gate_report import GateReport


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
    """Sharp edges to be rounded together, one or more, and the surface that is put there.

    Attributes
    ----------
    face : int
        N of `PATH#N` of one of the faces beside them.
    edges : tuple of (int, int)
        N, and k of its edge "ek": as the faces on one side walk them, from one to the next.
    surface : BSplineSurface
        u from these faces to those beyond the edges.
    cuts : tuple of float
        Parameters v at which it is cut into faces.
    closed : bool
        The last edge ends where the first one begins.
    grows : bool
        Inner edges: the volume has to become more.
    """

    face: int
    edges: tuple[tuple[int, int], ...]
    surface: BSplineSurface
    cuts: tuple[float, ...]
    closed: bool
    grows: bool


@dataclass(frozen=True, eq=False)
class Joining:
    """Two faces to be taken out, and the surfaces that join their outlines.

    Attributes
    ----------
    face : int
        Of the first file.
    other_path : str or None
        The second file; None where it is the same.
    other : int
        The face there.
    surfaces : tuple of BSplineSurface
        As `joined` of `occ_joining` has them, in the unit of the first file that names one.
    """

    face: int
    other_path: str | None
    other: int
    surfaces: tuple[BSplineSurface, ...]


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
        Faces whose borders were changed, by their numbers in the file; none where nothing was written.
    new : tuple of int
        The new faces, likewise.
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
