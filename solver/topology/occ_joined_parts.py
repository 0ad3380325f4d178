"""Parts of one or two files joined into one solid, with the names, colours and layers of both.

Runs in the process that reads the files.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES
from semispline.solver.topology.gate_report import Change, GateReport
from semispline.solver.topology.occ_joining import joined
from semispline.solver.topology.occ_parts import Part, PartFile, move_labels, open_parts, placed, root_of
from semispline.solver.topology.occ_shapes import children, copy_of, parts
from semispline.solver.topology.solid_gate import gate
from semispline.solver.topology.solid_orders import Joining, Outcome
from semispline.solver.topology.xcaf_words import Words, pieces_of, set_words, words_of

# What became of the first of the faces that were taken out.
_CAP = object()


@dataclass(frozen=True, eq=False)
class _Side:
    """One of the two parts.

    Attributes
    ----------
    file : PartFile
    part : Part
    place : gp_Trsf
        From it to the first part.
    solid : TopoDS_Solid
        In the part.
    moved : TopoDS_Solid
        The same where the first part is.
    first : int
        The number in the part of the first face of the solid.
    """

    file: PartFile
    part: Part
    place: Any
    solid: Any
    moved: Any
    first: int

    @property
    def cap(self) -> int:
        """The number in the solid of the face that is taken out."""
        return self.part.face - self.first


def join_parts(path: str, wanted: Joining, suffix: str) -> Outcome:
    """Return what came of joining two solids; errors as `joined`."""
    file = open_parts(path)
    other = file if wanted.other_path is None else open_parts(wanted.other_path)
    unit = file.unit or other.unit
    factor = 1.0 if file.unit is None or other.unit is None else MILLIMETRES[other.unit] / MILLIMETRES[file.unit]
    a = _side(file, wanted.face, None, 1.0)
    b = _side(other, wanted.other, a.part.place, factor)
    is_same = _are_one_part(a, b) and a.solid.IsSame(b.solid)
    before = _compound([a.moved] if is_same else [a.moved, b.moved])
    caps = (a.cap, b.cap if is_same else len(parts(a.moved, "FACE")) + b.cap)
    copy, _ = copy_of(before)
    surfaces = [placed(surface, a.part.place.Inverted()) for surface in wanted.surfaces]
    solid, change = joined(copy, caps, surfaces)
    millimetres = None if unit is None else MILLIMETRES[unit]
    report = gate(before, solid, change, millimetres=millimetres)
    if not report.is_sound:
        return Outcome(report, None, None, (), (), 1)
    whole, notes = _whole(a, b, solid, change, unit)
    content = whole.content(suffix)
    first = _first_of(whole.root, solid)
    again = _read_back(content, suffix, first + change.new[0], before, change, millimetres)
    report, again = report.numbered_from(first), again.numbered_from(first)
    new = tuple(first + n for n in change.new)
    assert change.kept is not None
    touched = tuple(sorted(first + change.kept[n] for n in change.touched if n in change.kept))
    return Outcome(report, again, content if again.is_sound else None, touched, new, 1, notes)


def _side(file: PartFile, number: int, onto: Any, factor: float) -> _Side:
    """Return a part with the solid that a face belongs to, moved to where `onto` has its place."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Pnt, gp_Trsf

    part = file.part_of(number)
    title = f"{file.path}#{number}"
    if part.times > 1:
        raise EdgeError(f"{title}: its part stands {part.times} times in the file, expected one that stands there once")
    place = gp_Trsf()
    if onto is not None:
        scale = gp_Trsf()
        scale.SetScale(gp_Pnt(0, 0, 0), factor)
        place = onto.Inverted() * scale * part.place
    face, first = parts(part.shape, "FACE")[part.face], 0
    for solid in parts(part.shape, "SOLID"):
        own = parts(solid, "FACE")
        if any(face.IsSame(x) for x in own):
            break
        first += len(own)
    else:
        raise EdgeError(f"{title}: the face belongs to no solid, expected one of a solid")
    first = next(n for n, x in enumerate(parts(part.shape, "FACE")) if x.IsSame(own[0]))
    is_there = place.Form().name == "gp_Identity"
    moved = solid if is_there else parts(BRepBuilderAPI_Transform(solid, place, True).Shape(), "SOLID")[0]
    return _Side(file, part, place, solid, moved, first)


def _whole(a: _Side, b: _Side, solid: Any, change: Change, unit: str | None) -> tuple[PartFile, tuple[str, ...]]:
    """Return the first file with the joined solid in the place of its own, and without the other if that was there."""
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    file, is_one = replace(a.file, unit=unit), _are_one_part(a, b)
    gone = [b.solid] if is_one and not b.solid.IsSame(a.solid) else []
    shape = _with_solid(a.part.shape, a.solid, solid, gone)
    if a.part.label is None:
        return replace(file, root=shape, document=None), ()
    document = a.file.document
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    image = _image(a, b, solid, change)
    of_cap = next((words_of(document, x) for x, piece in pieces_of(a.part.label) if image(piece) is _CAP), None)
    new = [parts(solid, "FACE")[n] for n in change.new]
    of_b = [] if is_one or b.part.label is None else _said_of(b, image)
    name = None if is_one or b.part.label is None else words_of(b.file.document, b.part.label).name
    if b.file is a.file and not is_one:
        _take_out(tool, b)
    move_labels(tool, a.part, shape, lambda piece: new[0] if (found := image(piece)) is _CAP else found)
    for face, words in [*of_b, *((face, of_cap) for face in new[1:] if of_cap is not None)]:
        label = tool.AddSubShape(a.part.label, face)
        if not label.IsNull():
            set_words(document, label, words)
    tool.UpdateAssemblies()
    notes = () if name is None else (f"the part {name!r} of {b.file.path} is a piece of the first one now",)
    return replace(file, root=root_of(tool)), notes


def _image(a: _Side, b: _Side, solid: Any, change: Change) -> Callable[[Any], Any]:
    """Return what tells what became of a piece of a part: `_CAP` of the first face taken out, None of the other."""
    assert change.kept is not None
    after, kept, caps = parts(solid, "FACE"), change.kept, change.old
    known: list[tuple[Any, Any]] = []
    first = 0
    for side in (a,) if _are_one_part(a, b) and a.solid.IsSame(b.solid) else (a, b):
        for n, face in enumerate(parts(side.solid, "FACE"), first):
            is_cap = _CAP if side is a and n == a.cap else None
            known.append((face, is_cap if n in caps else after[kept[n]]))
        first += len(parts(side.solid, "FACE"))
    known += [(a.solid, solid), (b.solid, None)]

    def image(piece: Any) -> Any:
        return next((new for old, new in known if old.IsSame(piece)), piece)

    return image


def _said_of(side: _Side, image: Callable[[Any], Any]) -> list[tuple[Any, Words]]:
    """Return the faces that those of the second part became, with what is said of each, or else of the part."""
    document = side.file.document
    whole = replace(words_of(document, side.part.label), name=None)
    own = [(piece, words_of(document, label)) for label, piece in pieces_of(side.part.label)]
    found = []
    for face in parts(side.solid, "FACE"):
        became = image(face)
        if became is None or became is _CAP:
            continue
        words = next((x for piece, x in own if piece.IsSame(face)), whole)
        words = replace(words, colors=words.colors or whole.colors, layers=words.layers or whole.layers)
        if words != Words(None, (), ()):
            found.append((became, words))
    return found


def _take_out(tool: Any, side: _Side) -> None:
    """Take a solid out of a document, and its part with it where nothing else is in that."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.XCAFDoc import XCAFDoc_ShapeTool

    left = _with_solid(side.part.shape, None, None, [side.solid])
    if left is not None and parts(left, "FACE"):
        tool.SetShape(side.part.label, left)
        return
    users = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetUsers_s(side.part.label, users)
    for k in range(users.Length()):
        tool.RemoveComponent(users.Value(k + 1))
    tool.RemoveShape(side.part.label)


def _are_one_part(a: _Side, b: _Side) -> bool:
    if a.part.label is None or b.part.label is None:
        return a.file is b.file
    return bool(a.part.label.IsEqual(b.part.label))


def _with_solid(shape: Any, old: Any, new: Any, gone: Sequence[Any]) -> Any:
    """Return a shape with a solid in the place of another, and without some; None where nothing is left of it."""
    if old is not None and shape.IsSame(old):
        return new
    if any(shape.IsSame(x) for x in gone):
        return None
    if shape.ShapeType().name != "TopAbs_COMPOUND":
        return shape
    left = [x for child in children(shape) if (x := _with_solid(child, old, new, gone)) is not None]
    return _compound(left)


def _compound(shapes: Sequence[Any]) -> Any:
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    found, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(found)
    for shape in shapes:
        builder.Add(found, shape)
    return found


def _first_of(root: Any, solid: Any) -> int:
    """Return the number in a file of the first face of a solid."""
    first = parts(solid, "FACE")[0]
    return next(n for n, face in enumerate(parts(root, "FACE")) if face.IsPartner(first))


def _read_back(
    content: bytes, suffix: str, face: int, before: Any, change: Change, millimetres: float | None
) -> GateReport:
    with TemporaryDirectory() as folder:
        path = Path(folder, f"written{suffix}")
        path.write_bytes(content)
        part = open_parts(path).part_of(face)
        new = parts(part.shape, "FACE")[part.face]
        solid = next((x for x in parts(part.shape, "SOLID") if any(new.IsSame(y) for y in parts(x, "FACE"))), None)
        # The gate says that there is none.
        return gate(before, part.shape if solid is None else solid, change, millimetres=millimetres, read_back=True)
