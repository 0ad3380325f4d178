"""What the process of its own does that changes a solid in a file: reads, operates, gates, writes, reads again."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.errors import ComputationError, SemisplineError
from semispline.solver.io import MILLIMETRES
from semispline.solver.topology.gate_report import Change, GateReport, Point
from semispline.solver.topology.occ_joined_parts import join_parts
from semispline.solver.topology.occ_parts import Part, PartFile, open_parts, placed
from semispline.solver.topology.occ_replacing import change_of, opening, put_in
from semispline.solver.topology.occ_rounding import rounded
from semispline.solver.topology.occ_shapes import copy_of, parts
from semispline.solver.topology.solid_gate import gate
from semispline.solver.topology.solid_orders import Joining, Outcome, Replacement, Rounding


def work(path: str, order: str, suffix: str) -> Outcome:
    """Return what came of changing a solid; `order` is a file with a pickled `Replacement`, `Rounding` or `Joining`."""
    # Our own process wrote this.
    wanted = pickle.loads(Path(order).read_bytes())
    try:
        if isinstance(wanted, Joining):
            return join_parts(path, wanted, suffix)
        return _changed(open_parts(path), wanted, suffix)
    except (SemisplineError, MemoryError):
        raise
    except Exception as error:
        # Each failure of the kernel has a class of its own.
        said = (str(error).splitlines() or [type(error).__name__])[0]
        raise ComputationError(f"{path}#{wanted.face}: Open CASCADE cannot put the blend in ({said})") from None


def _changed(file: PartFile, wanted: Replacement | Rounding, suffix: str) -> Outcome:
    part = file.part_of(wanted.face)
    copy, image = copy_of(part.shape)
    back = part.place.Inverted()
    if isinstance(wanted, Replacement):
        news = [replace(x, face=file.part_of(x.face).face, surface=placed(x.surface, back)) for x in wanted.faces]
        places = [opening(copy, x.face, x.contacts) for x in news]
        change = change_of(places)
        after, became = put_in(copy, places, news)
    else:
        # Faces of a part follow each other in the file.
        edges = [(face - wanted.face + part.face, k) for face, k in wanted.edges]
        after, became, change = rounded(copy, edges, replace(wanted, surface=placed(wanted.surface, back)))
    millimetres = None if file.unit is None else MILLIMETRES[file.unit]
    before = part.shape
    own, olds = parts(after, "FACE"), parts(before, "FACE")
    # What the first face of the part is called: where it stands before the face that was named it changes, too.
    first = wanted.face - part.face
    firsts = first, first + part.before * (len(own) - len(olds))
    report = in_file(gate(before, after, change, millimetres=millimetres, first=firsts), part)
    if not report.is_sound:
        return Outcome(report, None, None, (), (), part.times)
    kept = change.kept_of(len(olds), len(own))
    touched = tuple(sorted(firsts[1] + kept[n] for n in change.touched if n in kept))
    new = tuple(firsts[1] + n for n in change.new)
    # A face in the place of another has its label; beside an edge that of the faces on the first side.
    like = [(own[k], olds[n]) for k, n in zip(change.new, change.like, strict=False)]
    whole = file.with_part(part, after, lambda piece: became(image(piece)), like)
    content = whole.content(suffix)
    again = _read_back(content, suffix, None if part.label is None else new[0], before, change, millimetres, firsts)
    again = in_file(again, part)
    return Outcome(report, again, content if again.is_sound else None, touched, new, part.times)


def in_file(report: GateReport, part: Part) -> GateReport:
    """Return a report with places where the part stands."""
    from OCP.gp import gp_Pnt

    def moved(place: Point) -> Point:
        x, y, z = gp_Pnt(*place).Transformed(part.place).Coord()
        return x, y, z

    place = None if report.place is None else moved(report.place)
    return replace(report, place=place, border=tuple(replace(edge, at=moved(edge.at)) for edge in report.border))


def _read_back(
    content: bytes,
    suffix: str,
    face: int | None,
    before: Any,
    change: Change,
    millimetres: float | None,
    first: tuple[int, int],
) -> GateReport:
    """Gate what was written once more: the part that a face belongs to, or all of it."""
    with TemporaryDirectory() as folder:
        path = Path(folder, f"written{suffix}")
        path.write_bytes(content)
        file = open_parts(path)
        shape = file.root if face is None else file.part_of(face).shape
        return gate(before, shape, change, millimetres=millimetres, read_back=True, first=first)
