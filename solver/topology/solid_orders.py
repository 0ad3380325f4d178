"""What one process tells another that is to be done to a solid, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass

from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.solid_gate import GateReport


@dataclass(frozen=True, eq=False)
class Replacement:
    """A face to be taken out, and the surface that takes its place.

    Attributes
    ----------
    face : int
        N of `PATH#N`.
    contacts : pair of tuples of int
        k of the edges "ek" along each contact.
    surface : BSplineSurface
        u from the first contact to the second.
    """

    face: int
    contacts: tuple[tuple[int, ...], tuple[int, ...]]
    surface: BSplineSurface


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
        Faces whose borders were changed, by their numbers in the part.
    new : int
        The new face, by its number in the file; where nothing was written by that in the part.
    more : tuple of int
        Further new faces.
    times : int
        How often the changed part stands in the file.
    notes : tuple of str
        What else is to be said.
    """

    report: GateReport
    read_back: GateReport | None
    content: bytes | None
    touched: tuple[int, ...]
    new: int
    times: int
    notes: tuple[str, ...] = ()
    more: tuple[int, ...] = ()
