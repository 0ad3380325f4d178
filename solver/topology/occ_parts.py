"""Files with solids, kept open: a part of one is taken out, changed, and the whole written with all else as it was.

A STEP file is read as a document, so that names, colours and layers stay. In an assembly the part is changed that the
face belongs to, wherever it stands. Runs in the process that read the file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import FileError
from semispline.solver.io import (
    MILLIMETRES,
    brep_bytes,
    read_occ_shape,
    silenced,
    step_text,
    step_unit,
    system_unit,
)
from semispline.solver.splines import BSplineSurface, transform
from semispline.solver.topology.occ_shapes import parts

_STEP = (".step", ".stp")
_BREP = (".brep", ".brp")
# With them faces keep their names.
_NAMES_OF_FACES = ("read.stepcaf.subshapes.name", "write.stepcaf.subshapes.name")


@dataclass(frozen=True, eq=False)
class Part:
    """A shape of a file that stands in it once or more.

    Attributes
    ----------
    shape : TopoDS_Shape
    label : TDF_Label or None
        Of a document.
    face : int
        The number in the part of the face that was asked for.
    place : gp_Trsf
        From the part to where that face is.
    times : int
        How often the part stands in the file.
    before : int
        How often it stands there before that face.
    """

    shape: Any
    label: Any
    face: int
    place: Any
    times: int
    before: int = 0


@dataclass(frozen=True, eq=False)
class PartFile:
    """An open file.

    Attributes
    ----------
    path : str
    root : TopoDS_Shape
        Whose faces are numbered as `semispline list` does.
    unit : str or None
    document : TDocStd_Document or None
        Of a STEP file.
    """

    path: str
    root: Any
    unit: str | None
    document: Any = None

    def part_of(self, number: int) -> Part:
        """Return the part that a face belongs to.

        Raises
        ------
        FileError
            There is no such face.
        """
        from OCP.gp import gp_Trsf

        faces = parts(self.root, "FACE")
        if not 0 <= number < len(faces):
            raise FileError(f"{self.path}#{number}: no such surface; the file holds {len(faces)}")
        face = faces[number]
        if self.document is not None:
            for label, shape in self.simple_shapes():
                for k, own in enumerate(parts(shape, "FACE")):
                    if own.IsPartner(face):
                        place = face.Location().Transformation() * own.Location().Transformation().Inverted()
                        same = [n for n, other in enumerate(faces) if own.IsPartner(other)]
                        return Part(shape, label, k, place, len(same), same.index(number))
        return Part(self.root, None, number, gp_Trsf(), 1)

    def with_part(
        self, part: Part, shape: Any, image: Callable[[Any], Any], like: Sequence[tuple[Any, Any]] = ()
    ) -> PartFile:
        """Return the file with a part changed; a document is changed itself.

        Parameters
        ----------
        part : Part
        shape : TopoDS_Shape
            What takes its place.
        image : callable
            What became of a face or another piece of the part; None of what is gone. A face that was put in the place
            of another keeps its name, colour and layer.
        like : sequence of (TopoDS_Face, TopoDS_Face)
            New faces, each with one of the part before that tells its colour and layer.
        """
        from OCP.XCAFDoc import XCAFDoc_DocumentTool

        if part.label is None:
            return PartFile(self.path, shape, self.unit, self.document)
        tool = XCAFDoc_DocumentTool.ShapeTool_s(self.document.Main())
        move_labels(tool, part, shape, image, [(new, labelled(part.label, old)) for new, old in like])
        tool.UpdateAssemblies()
        return PartFile(self.path, root_of(tool), self.unit, self.document)

    def content(self, suffix: str) -> bytes:
        """Return the file as bytes, in its own unit; numbers have 17 digits.

        Raises
        ------
        FileError
            A format that no solid can be written in, or Open CASCADE cannot write it.
        """
        if suffix in _BREP:
            return bytes(brep_bytes(self.root))
        if suffix not in _STEP:
            raise FileError(f"{suffix}: found another format, expected .step or .brep for a solid")
        from OCP.STEPCAFControl import STEPCAFControl_Writer
        from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

        with silenced(1, 2), system_unit(self.unit or "mm"), _names_of_faces():
            kind = STEPControl_StepModelType.STEPControl_AsIs
            if self.document is None:
                writer = STEPControl_Writer()
                writer.Transfer(self.root, kind)
                return bytes(step_text(writer.Model()))
            with_names = STEPCAFControl_Writer()
            with_names.SetNameMode(True)
            with_names.SetColorMode(True)
            with_names.SetLayerMode(True)
            with_names.Transfer(self.document, kind)
            return bytes(step_text(with_names.ChangeWriter().Model()))

    def simple_shapes(self) -> list[tuple[Any, Any]]:
        """Return the label and the shape of each part of a document that is no assembly."""
        from OCP.collections import Sequence_TDF_Label
        from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

        labels = Sequence_TDF_Label()
        XCAFDoc_DocumentTool.ShapeTool_s(self.document.Main()).GetShapes(labels)
        found = []
        for label in (labels.Value(k + 1) for k in range(labels.Length())):
            if XCAFDoc_ShapeTool.IsSimpleShape_s(label) and not XCAFDoc_ShapeTool.IsSubShape_s(label):
                found.append((label, XCAFDoc_ShapeTool.GetShape_s(label)))
        return found


def open_parts(path: str | Path) -> PartFile:
    """Read a STEP, IGES or BREP file to change a part of it.

    Raises
    ------
    FileError
        As `read_occ`.
    """
    if Path(path).suffix.lower() not in _STEP:
        return PartFile(str(path), *read_occ_shape(path))
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    with silenced(1, 2), system_unit("mm"), _names_of_faces():
        document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        XCAFApp_Application.GetApplication_s().InitDocument(document)
        reader = STEPCAFControl_Reader()
        reader.SetNameMode(True)
        reader.SetColorMode(True)
        reader.SetLayerMode(True)
        if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise FileError(f"{path}: not a STEP file that Open CASCADE can read")
        unit = step_unit(reader.ChangeReader())
        XCAFDoc_DocumentTool.SetLengthUnit_s(document, MILLIMETRES[unit] / 1000)
        reader.Transfer(document)
        root = root_of(XCAFDoc_DocumentTool.ShapeTool_s(document.Main()))
    return PartFile(str(path), root, unit, document)


def placed(surface: BSplineSurface, trsf: Any) -> BSplineSurface:
    """Return a surface moved as the kernel says."""
    if trsf.Form().name == "gp_Identity":
        return surface
    matrix: FloatArray = np.array([[trsf.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])
    return transform(surface, matrix[:, :3], matrix[:, 3])


def root_of(tool: Any) -> Any:
    """Return all that a document shows, in its order."""
    from OCP.BRep import BRep_Builder
    from OCP.collections import Sequence_TDF_Label
    from OCP.TopoDS import TopoDS_Compound
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    labels = Sequence_TDF_Label()
    tool.GetFreeShapes(labels)
    shapes = [XCAFDoc_ShapeTool.GetShape_s(labels.Value(k + 1)) for k in range(labels.Length())]
    if len(shapes) == 1:
        return shapes[0]
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def labelled(label: Any, piece: Any) -> Any | None:
    """Return the label of a piece of a part; None where it has none."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    pieces = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, pieces)
    labels = [pieces.Value(k + 1) for k in range(pieces.Length())]
    return next((x for x in labels if XCAFDoc_ShapeTool.GetShape_s(x).IsSame(piece)), None)


def move_labels(
    tool: Any, part: Part, shape: Any, image: Callable[[Any], Any], like: Sequence[tuple[Any, Any | None]] = ()
) -> None:
    """Give a part's label its new shape, those of its pieces what these became, and new pieces labels like others."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    pieces = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(part.label, pieces)
    labels = [pieces.Value(k + 1) for k in range(pieces.Length())]
    images = [image(XCAFDoc_ShapeTool.GetShape_s(label)) for label in labels]
    tool.SetShape(part.label, shape)
    for label, became in zip(labels, images, strict=True):
        if became is not None:
            tool.SetShape(label, became)
    for new, model in like:
        if model is not None:
            _copy_looks(model, tool.AddSubShape(part.label, new))


def _copy_looks(model: Any, label: Any) -> None:
    """Give a label the colours and the layers of another, but not its name."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.Quantity import Quantity_ColorRGBA
    from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool

    colors, color = XCAFDoc_DocumentTool.ColorTool_s(label), Quantity_ColorRGBA()
    for kind in ("Gen", "Surf", "Curv"):
        which = getattr(XCAFDoc_ColorType, f"XCAFDoc_Color{kind}")
        if XCAFDoc_ColorTool.GetColor_s(model, which, color):
            colors.SetColor(label, color, which)
    layers, found = XCAFDoc_DocumentTool.LayerTool_s(label), Sequence_TDF_Label()
    layers.GetLayers(model, found)
    for k in range(found.Length()):
        layers.SetLayer(label, found.Value(k + 1))


@contextmanager
def _names_of_faces() -> Iterator[None]:
    """Let the translator keep the names of faces for a while."""
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Controller

    STEPCAFControl_Controller.Init_s()
    before = {key: Interface_Static.IVal_s(key) for key in _NAMES_OF_FACES}
    try:
        for key in before:
            Interface_Static.SetIVal_s(key, 1)
        yield
    finally:
        for key, value in before.items():
            Interface_Static.SetIVal_s(key, value)
