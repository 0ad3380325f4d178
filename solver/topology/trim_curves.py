"""Edges of a trimmed face as curves, each with its face: what a band is made along."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES, read_apart, require_file, require_kernel
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.band_search import Continuity
from semispline.solver.topology.bands import Band, band_along


@dataclass(frozen=True, eq=False)
class TrimCurve:
    """An edge of a face.

    Attributes
    ----------
    name : str
        For messages: "edge e3 of face 12".
    surface : BSplineSurface
        Of the face, as it is read out: converted where it is a cylinder and the like.
    edge : BSplineCurve or None
        In space, as the edge runs.
    pcurve : BSplineCurve or None
        In the parameters of `surface`, as the edge runs.
    keep : {"left", "right"}
        The side of the edge, looked at against S_u x S_v, on which the face lies.
    tolerance : float
        How far the edge may be from the face, as the file says.
    millimetres : float or None
        In one unit of the file.
    """

    name: str
    surface: BSplineSurface
    edge: BSplineCurve | None
    pcurve: BSplineCurve | None
    keep: Literal["left", "right"]
    tolerance: float
    millimetres: float | None

    def bands(self, continuity: Continuity = "G2") -> tuple[Band, ...]:
        """Return the bands of the face along the edge, as `band_along`."""
        return band_along(
            self.surface,
            self.pcurve,
            self.keep,
            edge=self.edge,
            tolerance=self.tolerance,
            millimetres=self.millimetres,
            continuity=continuity,
            name=self.name,
        )


def read_trim_curves(path: str | Path, face: int, numbers: Sequence[int]) -> list[TrimCurve]:
    """Return edges of a face of a STEP, IGES or BREP file, read by a process of its own.

    Parameters
    ----------
    path : str
    face : int
        N of `PATH#N`.
    numbers : sequence of int
        k of the names "ek", as `Uses` has them.

    Raises
    ------
    FileError
        Missing, broken, no such face, or a surface that cannot be read out.
    EdgeError
        No such edge, or one without a curve: a point, say.
    """
    require_file(path)
    require_kernel(path)
    unit, surface, edges = read_apart(
        path, "semispline.solver.topology.occ_curves", "Open CASCADE", [str(face), *map(str, numbers)]
    )
    if isinstance(surface, Exception):
        raise surface
    own = BSplineSurface(*surface)
    made = []
    for number, found in zip(numbers, edges, strict=True):
        name = f"edge e{number} of face {face}"
        if isinstance(found, str):
            raise EdgeError(f"{path}#{face}: e{number}: {found}")
        edge, pcurve, keep, tolerance = found
        in_space, flat = (None if x is None else BSplineCurve(*x) for x in (edge, pcurve))
        made.append(TrimCurve(name, own, in_space, flat, keep, tolerance, None if unit is None else MILLIMETRES[unit]))
    return made
