"""What a document says of a shape: its name, colours and layers, read and written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Words:
    """Name, colours by their kinds, and layers of a shape."""

    name: str | None
    colors: tuple[tuple[Any, Any], ...]
    layers: tuple[str, ...]


def words_of(document: Any, label: Any) -> Words:
    """Return what a document says of the shape of a label."""
    from OCP.Quantity import Quantity_Color
    from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool

    colors = []
    for kind in XCAFDoc_ColorType.__members__.values():
        color = Quantity_Color()
        if XCAFDoc_ColorTool.GetColor_s(label, kind, color):
            colors.append((kind, color))
    found = XCAFDoc_DocumentTool.LayerTool_s(document.Main()).GetLayers(label)
    layers = [] if found is None else [found.Value(k + 1).ToExtString() for k in range(found.Length())]
    return Words(_name(label), tuple(colors), tuple(layers))


def set_words(document: Any, label: Any, words: Words) -> None:
    """Let a document say of the shape of a label what was said of another."""
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    if words.name is not None:
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(words.name))
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    for kind, color in words.colors:
        colors.SetColor(label, color, kind)
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
    for layer in words.layers:
        layers.SetLayer(label, TCollection_ExtendedString(layer))


def pieces_of(label: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the label and the shape of each piece of a shape of which something is said."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    labels = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, labels)
    for k in range(labels.Length()):
        yield labels.Value(k + 1), XCAFDoc_ShapeTool.GetShape_s(labels.Value(k + 1))


def _name(label: Any) -> str | None:
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_AttributeIterator

    # FindAttribute breaks the process down where there is none.
    iterator = TDF_AttributeIterator(label)
    while iterator.More():
        if isinstance(iterator.Value(), TDataStd_Name):
            return str(iterator.Value().Get().ToExtString())
        iterator.Next()
    return None
