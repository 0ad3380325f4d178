"""STEP, IGES and BREP files read through Open CASCADE (the extra `cad`).

Coordinates stay in the unit of length that the file declares: the readers' conversion to millimetres is turned off by
telling them that the system's unit is the file's. A file whose unit is none of IGES's ten is converted to
millimetres by the reader.

Source: ISO 10303-42; IGES 5.3, entity 128; reference documentation of Open CASCADE.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

from semispline.solver.errors import FileError, InputError, SemisplineError
from semispline.solver.io.disk import require_file
from semispline.solver.io.face_boundary import FaceBoundary, joined
from semispline.solver.io.faces import MILLIMETRES, Model
from semispline.solver.io.foreign import read_apart
from semispline.solver.io.occ_boundary import ON_EDGE, distance_to_ends, edges_of, occ_boundary, pcurve_points
from semispline.solver.io.occ_conversion import Conversion, Ends, converted, kind_of, resolved, snapped_ends
from semispline.solver.io.occ_kernel import first_line, require_kernel, system_unit
from semispline.solver.io.occ_parameters import ParameterKind, parameter_kinds
from semispline.solver.io.silence import silenced
from semispline.solver.splines import BSplineSurface

_STEP_UNITS = {
    "millimetre": "mm",
    "centimetre": "cm",
    "metre": "m",
    "kilometre": "km",
    "micrometre": "um",
    "inch": "in",
    "foot": "ft",
    "mile": "mi",
    "mil": "mil",
}


@dataclass(frozen=True, eq=False)
class OccFace:
    """A face of a transferred shape; `trimmed`, `surface` and `deviation` as `Face` says."""

    face: Any
    where: str

    @property
    def kind(self) -> str:
        """What the file holds."""
        try:
            return kind_of(self._geometry)
        except FileError:
            return "none"

    def trimmed(self) -> bool | None:
        """Whether curves cut the face out of the surface that `surface` returns; None if the kernel cannot tell."""
        try:
            return self._is_trimmed()
        except Exception:
            # Each failure of the kernel has a class of its own.
            return None

    def _is_trimmed(self) -> bool:
        from OCP.BRep import BRep_Tool

        if BRep_Tool.NaturalRestriction_s(self.face):
            return False
        ends = self.ends
        return any(
            distance_to_ends(pcurve_points(edge, self.face), ends).min(axis=1).max() > ON_EDGE
            for edge in edges_of(self.face)
        )

    def boundary(self) -> FaceBoundary | None:
        """Return the edges of the face, as `Face` says."""
        if self.trimmed() is False:
            return None
        try:
            return occ_boundary(self.face, self.ends)
        except Exception:
            # Each failure of the kernel has a class of its own.
            return joined([])

    def surface(self) -> BSplineSurface:
        """Return the clamped (rational) B-spline surface, without trimming.

        Raises
        ------
        FileError
            No surface, one without end, or one that the kernel cannot even approximate.
        KnotError
            Knots that the surface class refuses.
        """
        try:
            return self._conversion.surface
        except SemisplineError as error:
            raise type(error)(f"{self.where}: {error}") from None
        except Exception as error:
            # Each failure of the kernel has a class of its own.
            raise FileError(f"{self.where}: Open CASCADE cannot convert it ({first_line(error)})") from None

    def deviation(self) -> float | None:
        """Return how far the surface is from what the file holds; None where it is exact."""
        return self._conversion.deviation

    @cached_property
    def _conversion(self) -> Conversion:
        return converted(self._geometry, self.ends)

    @cached_property
    def _geometry(self) -> Any:
        from OCP.BRep import BRep_Tool

        geometry = BRep_Tool.Surface_s(self.face)
        if geometry is None:
            raise FileError("the face has no surface; choose another")
        return resolved(geometry)

    @property
    def parameter_kinds(self) -> tuple[ParameterKind, ParameterKind]:
        """Of which kind u and v of the file are: what `converted_parameters` turns into those of `surface`."""
        return parameter_kinds(self._geometry)

    @cached_property
    def ends(self) -> Ends:
        """Range of the parameters that `surface` returns: that of the face where the surface has no end."""
        from OCP.BRepTools import BRepTools

        if type(self._geometry).__name__ in ("Geom_BSplineSurface", "Geom_BezierSurface"):
            return tuple(self._geometry.Bounds())
        return snapped_ends(self._geometry, tuple(BRepTools.UVBounds_s(self.face)))


@dataclass(frozen=True, eq=False)
class _ReadFace:
    """A face as the other process converted it: arguments of `BSplineSurface`, or the error."""

    kind: str
    is_trimmed: bool | None
    edges: FaceBoundary | None
    off: float | None
    content: tuple[Any, ...] | InputError

    def trimmed(self) -> bool | None:
        return self.is_trimmed

    def boundary(self) -> FaceBoundary | None:
        return self.edges

    def deviation(self) -> float | None:
        return self.off

    def surface(self) -> BSplineSurface:
        if isinstance(self.content, InputError):
            raise self.content
        return BSplineSurface(*self.content)


def open_occ(path: str | Path, bounded: Collection[int] = ()) -> Model:
    """Open a STEP, IGES or BREP file, read by a process of its own; `bounded` are the faces whose edges are wanted.

    Raises
    ------
    FileError
        As `foreign.read_apart`, or the extra `cad` is not installed.
    ComputationError
        As `foreign.read_apart`.
    """
    require_file(path)
    require_kernel(path)
    worker = "semispline.solver.io.occ_worker"
    unit, faces, others = read_apart(path, worker, "Open CASCADE", map(str, bounded))
    return Model(str(path), unit, [_ReadFace(*face) for face in faces], others)


def read_occ(path: str | Path) -> Model:
    """Read a STEP, IGES or BREP file in this process; `open_occ` survives what is damaged.

    Raises
    ------
    FileError
        Missing, not readable by Open CASCADE, or the extra `cad` is not installed.
    """
    shape, unit = read_occ_shape(path)
    found = shape is not None and not shape.IsNull()
    faces, others = (list(_faces(shape)), _others(shape)) if found else ([], {})
    return Model(str(path), unit, [OccFace(face, f"{path}#{number}") for number, face in enumerate(faces)], others)


def read_occ_shape(path: str | Path) -> tuple[Any, str | None]:
    """Return the shape in a STEP, IGES or BREP file, read in this process, and its unit; errors as `read_occ`."""
    require_file(path)
    require_kernel(path)
    suffix = Path(path).suffix.lower()
    read = _read_step if suffix in (".step", ".stp") else _read_iges if suffix in (".iges", ".igs") else _read_brep
    try:
        with silenced(1, 2):
            return read(str(path))
    except (SemisplineError, MemoryError):
        raise
    except Exception as error:
        # The kernel raises a class of its own for each of its failures.
        raise FileError(f"{path}: Open CASCADE cannot read it ({first_line(error)})") from None


def _read_step(path: str) -> tuple[Any, str | None]:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    with system_unit("mm"):
        reader = STEPControl_Reader()
        if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise FileError(f"{path}: not a STEP file that Open CASCADE can read")
        unit = step_unit(reader)
        reader.SetSystemLengthUnit(MILLIMETRES[unit])
        reader.TransferRoots()
        return reader.OneShape(), unit


def step_unit(reader: Any) -> str:
    """Return the unit of length that a STEP file which was read is taken in."""
    from OCP.collections import Sequence_TCollection_AsciiString

    lengths, angles, solid = (Sequence_TCollection_AsciiString() for _ in range(3))
    reader.FileUnits(lengths, angles, solid)
    names = [lengths.Value(i + 1).ToCString().lower() for i in range(lengths.Length())]
    # Products in different units, or in a unit without a name here, are converted to millimetres.
    return _STEP_UNITS.get(names[0], "mm") if len(set(names)) == 1 else "mm"


def _read_iges(path: str) -> tuple[Any, str | None]:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.IGESControl import IGESControl_Reader

    reader = IGESControl_Reader()
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise FileError(f"{path}: not an IGES file that Open CASCADE can read")
    header = reader.IGESModel().GlobalSection()
    unit = next((u for u, size in MILLIMETRES.items() if abs(header.UnitValue() / size - 1) < 1e-9), "mm")
    # This translator asks the model for the system's unit, and not the static that the one for STEP asks.
    header.SetCascadeUnit(MILLIMETRES[unit])
    reader.IGESModel().SetGlobalSection(header)
    reader.TransferRoots()
    return reader.OneShape(), unit


def _read_brep(path: str) -> tuple[Any, str | None]:
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Shape

    shape = TopoDS_Shape()
    if not BRepTools.Read_s(shape, path, BRep_Builder()) or shape.IsNull():
        raise FileError(f"{path}: not a BREP file that Open CASCADE can read")
    return shape, None


def _faces(shape: Any) -> Iterator[Any]:
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    explorer = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while explorer.More():
        yield TopoDS.Face(explorer.Current())
        explorer.Next()


def _others(shape: Any) -> dict[str, int]:
    """Count wires, edges and vertices that bound nothing larger."""
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    kinds = ("FACE", "WIRE", "EDGE", "VERTEX")
    found = {}
    for larger, kind in pairwise(kinds):
        explorer = TopExp_Explorer(
            shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind}"), getattr(TopAbs_ShapeEnum, f"TopAbs_{larger}")
        )
        count = 0
        while explorer.More():
            count += 1
            explorer.Next()
        if count:
            found[kind.lower()] = count
    return found
