"""Edges of a trimmed face as curves, each with its face: what a band is made along."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Literal, TypeVar

from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES, open_3dm, read_apart, require_file, require_kernel
from semispline.solver.judge import FreeEdge
from semispline.solver.splines import BSplineCurve, BSplineSurface
from semispline.solver.topology.band_search import Continuity, is_plane
from semispline.solver.topology.bands import Band, band_along
from semispline.solver.topology.face_curves import FaceCurve, Source, trim_curve
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.rhino_curves import curves_of_3dm


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

    @property
    def word(self) -> str:
        """How it is named among the edges of its face: "e3"."""
        return self.name.split()[1]

    @cached_property
    def is_plane(self) -> bool:
        """Whether its face is flat."""
        return is_plane(Face(self.surface))

    @cached_property
    def on_face(self) -> FaceCurve:
        """Which curve on the face is meant, and how far the edge and the pcurve are apart; errors as `band_along`."""
        return trim_curve(Face(self.surface), self.pcurve, self.edge, self.tolerance)

    def free_edge(self, source: Source | None = None) -> FreeEdge:
        """Return what a contact along it is measured against: the edge in space, or where that is far off the pcurve.

        `source` is that of a band, where it is known.
        """
        curve = self.edge if (source or self.on_face.source) == "foot" else self.pcurve
        assert curve is not None
        return FreeEdge(self.surface, curve, curve is self.edge, self.keep)

    def bands(self, continuity: Continuity = "G2", part: int | None = None, share: float = 1.0) -> tuple[Band, ...]:
        """Return the bands of the face along the edge, or along one part of it, as `band_along`."""
        return band_along(
            self.surface,
            self.pcurve,
            self.keep,
            edge=self.edge,
            tolerance=self.tolerance,
            millimetres=self.millimetres,
            continuity=continuity,
            part=part,
            name=self.name,
            share=share,
        )

    def in_unit(self, unit: str | None) -> TrimCurve:
        """Return the same in another unit, a key of `MILLIMETRES`; where its own is not known lengths stay."""
        if unit is None:
            return self
        factor = 1.0 if self.millimetres is None else self.millimetres / MILLIMETRES[unit]
        return replace(
            self,
            surface=_scaled(self.surface, factor),
            edge=None if self.edge is None else _scaled(self.edge, factor),
            tolerance=self.tolerance * factor,
            millimetres=MILLIMETRES[unit],
        )


_Spline = TypeVar("_Spline", BSplineCurve, BSplineSurface)


def _scaled(spline: _Spline, factor: float) -> _Spline:
    return spline if factor == 1 else replace(spline, control_points=spline.control_points * factor)


def read_trim_curves(path: str | Path, edges: Sequence[tuple[int, int]]) -> list[TrimCurve]:
    """Return edges of faces of a STEP, IGES, BREP or 3dm file, in the file's unit; kernels have a process of their own.

    Parameters
    ----------
    path : str
    edges : sequence of (int, int)
        N of `PATH#N`, and k of the name "ek", as `Uses` has them.

    Raises
    ------
    FileError
        Missing, broken, no such face, or a surface that cannot be read out.
    EdgeError
        No such edge, or one without a curve: a point, say.
    """
    require_file(path)
    if Path(path).suffix.lower() == ".3dm":
        unit, found = curves_of_3dm(open_3dm(path), edges)
    else:
        require_kernel(path)
        asked = [f"{face} {number}" for face, number in edges]
        unit, found = read_apart(path, "semispline.solver.topology.occ_curves", "Open CASCADE", asked)
    made = []
    for (face, number), one in zip(edges, found, strict=True):
        if isinstance(one, str):
            raise EdgeError(f"{path}#{face}: e{number}: {one}")
        if isinstance(one, Exception):
            raise one
        surface, edge, pcurve, keep, tolerance = one
        in_space, flat = (None if x is None else BSplineCurve(*x) for x in (edge, pcurve))
        millimetres = None if unit is None else MILLIMETRES[unit]
        name = f"edge e{number} of face {face}"
        made.append(TrimCurve(name, BSplineSurface(*surface), in_space, flat, keep, tolerance, millimetres))
    return made
