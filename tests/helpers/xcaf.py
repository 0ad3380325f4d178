"""STEP files with names, colours and layers, and what is read of them."""

from OCP.collections import Sequence_TDF_Label
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_AttributeIterator
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from semispline.solver.io import MILLIMETRES, silenced, system_unit
from semispline.solver.topology.occ_parts import _names_of_faces, open_parts
from semispline.solver.topology.occ_shapes import parts

SURFACE = XCAFDoc_ColorType.XCAFDoc_ColorSurf


def _color(red, green, blue):
    return Quantity_Color(red, green, blue, Quantity_TypeOfColor.Quantity_TOC_RGB)


def _document():
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document, XCAFDoc_DocumentTool.ShapeTool_s(document.Main())


def write_coloured(shape, path, unit="mm"):
    """A solid named "my part", blue, on "layer 7"; its faces are "face 0", .. with colours of their own."""
    STEPCAFControl_Controller.Init_s()
    document, tool = _document()
    colors, layers = (f(document.Main()) for f in (XCAFDoc_DocumentTool.ColorTool_s, XCAFDoc_DocumentTool.LayerTool_s))
    label = tool.AddShape(shape, False)
    TDataStd_Name.Set_s(label, TCollection_ExtendedString("my part"))
    colors.SetColor(label, _color(0.2, 0.2, 0.9), SURFACE)
    layers.SetLayer(label, TCollection_ExtendedString("layer 7"))
    for k, face in enumerate(parts(shape, "FACE")):
        piece = tool.AddSubShape(label, face)
        TDataStd_Name.Set_s(piece, TCollection_ExtendedString(f"face {k}"))
        colors.SetColor(piece, _color(0.1 * k + 0.1, 0.5, 0.1), SURFACE)
    write_document(document, path, unit)
    return path


def write_parts(pieces, path, unit="mm", places=None):
    """Parts by their names, each on a layer of its own, "layer NAME", and green; face k of it is red by 0.05 k.

    They stand beside each other, or at places in an assembly.
    """
    STEPCAFControl_Controller.Init_s()
    document, tool = _document()
    colors, layers = (f(document.Main()) for f in (XCAFDoc_DocumentTool.ColorTool_s, XCAFDoc_DocumentTool.LayerTool_s))
    parents = []
    for name, shape in pieces.items():
        label = tool.AddShape(shape, False)
        parents.append(label)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        colors.SetColor(label, _color(0.0, 0.9, 0.1), SURFACE)
        layers.SetLayer(label, TCollection_ExtendedString(f"layer {name}"))
        # The last face is as the part is.
        for k, face in enumerate(parts(shape, "FACE")[:-1]):
            piece = tool.AddSubShape(label, face)
            TDataStd_Name.Set_s(piece, TCollection_ExtendedString(f"{name} {k}"))
            colors.SetColor(piece, _color(0.05 * k, 0.5, 0.1), SURFACE)
    if places is not None:
        whole = tool.NewShape()
        for label, place in zip(parents, places, strict=True):
            tool.AddComponent(whole, label, place)
        tool.UpdateAssemblies()
    write_document(document, path, unit)
    return path


def write_document(document, path, unit="mm"):
    XCAFDoc_DocumentTool.SetLengthUnit_s(document, MILLIMETRES[unit] / 1000)
    with silenced(1), system_unit(unit), _names_of_faces():
        writer = STEPCAFControl_Writer()
        writer.SetNameMode(True)
        writer.SetColorMode(True)
        writer.SetLayerMode(True)
        writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
        writer.Write(str(path))


def write_assembly(shape, path, places):
    """One part that stands at several places."""
    STEPCAFControl_Controller.Init_s()
    document, tool = _document()
    part, whole = tool.AddShape(shape, False), tool.NewShape()
    TDataStd_Name.Set_s(part, TCollection_ExtendedString("my part"))
    TDataStd_Name.Set_s(whole, TCollection_ExtendedString("whole"))
    for place in places:
        tool.AddComponent(whole, part, place)
    tool.UpdateAssemblies()
    write_document(document, path)
    return path


def labels_of(path):
    """Unit, name and colour of each part, number and name and colour of each of its faces, names of layers."""
    file = open_parts(path)
    found = []
    for label, shape in file.simple_shapes():
        found.append((name_of(label), red_of(label)))
        pieces = Sequence_TDF_Label()
        XCAFDoc_ShapeTool.GetSubShapes_s(label, pieces)
        faces = parts(shape, "FACE")
        for k in range(pieces.Length()):
            piece = pieces.Value(k + 1)
            own = XCAFDoc_ShapeTool.GetShape_s(piece)
            found.append(([n for n, face in enumerate(faces) if face.IsSame(own)], name_of(piece), red_of(piece)))
    layers = Sequence_TDF_Label()
    XCAFDoc_DocumentTool.LayerTool_s(file.document.Main()).GetLayerLabels(layers)
    return file.unit, found, [name_of(layers.Value(k + 1)) for k in range(layers.Length())]


def red_of(label):
    color = Quantity_Color()
    return round(color.Red(), 3) if XCAFDoc_ColorTool.GetColor_s(label, SURFACE, color) else None


def name_of(label):
    # FindAttribute breaks the process down where there is none.
    iterator = TDF_AttributeIterator(label)
    while iterator.More():
        if isinstance(iterator.Value(), TDataStd_Name):
            return iterator.Value().Get().ToExtString()
        iterator.Next()
    return None
