"""A fillet of a solid replaced by a blend: one valid solid back."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline.solver.blending import BlendResult
from semispline.solver.errors import BandError, EdgeError, FileError, SolidError
from semispline.solver.io import OCC_SUFFIXES, check_outputs, read_apart, write_bytes
from semispline.solver.options import BlendOptions, Continuity, named_options
from semispline.solver.topology.bases import edge_bases
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.end_faces import blend_onto, faces_at_ends, going_on
from semispline.solver.topology.face_runs import FaceRun
from semispline.solver.topology.gate_report import GateReport
from semispline.solver.topology.kept_edges import KeptEdge, KeptEnd, ended_on_edges, kept_edges, measured_again
from semispline.solver.topology.panels import panels_of
from semispline.solver.topology.relations import relate
from semispline.solver.topology.replaced_runs import ReplacedRun, replaced_run
from semispline.solver.topology.resolving import Resolved
from semispline.solver.topology.run_ends import check_ends
from semispline.solver.topology.solid_orders import Joining, NewFace, Outcome, Replacement, Rounding

# Operating, measuring twice, writing and reading again take so many times as long as reading, at most.
_TIMES = 12.0
# Of their limits bands use so much: then they lie within 1e-7 of their length, and no tolerance grows.
_SHARE = 1e-2
# Open edges that are named in what is said; a report has all of them.
_NAMED = 8
_WRITTEN = (".step", ".stp", ".brep", ".brp")


@dataclass(frozen=True, eq=False)
class SolidBlend:
    """A solid with a blend in the place of one of its faces.

    Attributes
    ----------
    blend : BlendResult
    said : str
        What was replaced or rounded.
    faces : tuple of int
        The new faces, by their numbers in the file that is written.
    gate : GateReport
        What was measured of the solid before it was written.
    read_back : GateReport
        The same of what was written and read again.
    touched : tuple of int
        Faces whose borders were changed, likewise.
    notes : tuple of str
        What else is to be said.
    content : bytes
        The file.
    kept : tuple of KeptEnd
        Old end edges that were kept, where contact falls to G1.
    """

    blend: BlendResult
    said: str
    faces: tuple[int, ...]
    gate: GateReport
    read_back: GateReport
    touched: tuple[int, ...]
    notes: tuple[str, ...]
    content: bytes
    kept: tuple[KeptEnd, ...] = ()

    @property
    def face(self) -> int:
        """The new face; the first of several."""
        return self.faces[0]

    def record(self) -> dict[str, Any]:
        """Return what a report holds of the solid."""
        return {
            "new_face": self.face,
            "new_faces": list(self.faces),
            "kept_ends": [asdict(end) for end in self.kept],
            "touched": list(self.touched),
            "notes": list(self.notes),
            **{name: _gate_record(x) for name, x in (("solid", self.gate), ("read_back", self.read_back))},
        }


def replace_face(
    path: str | Path,
    face: int | Sequence[int],
    out: str | Path,
    options: BlendOptions | None = None,
    *,
    edge_a: str | None = None,
    edge_b: str | None = None,
    keep_ends: bool = False,
    **named: Any,
) -> SolidBlend:
    """Replace a fillet of a solid in a file by a blend, and write the file with all else as it was.

    Parameters
    ----------
    path : str or Path
        A STEP, IGES or BREP file.
    face : int, or sequence of int
        N of `PATH#N`: a face with four sides, or with two rims and a seam. Several that go on smoothly into each other
        over their ends are replaced together, each by a blend, and neighbours meet in one curve.
    out : str or Path
        A STEP or BREP file.
    options : BlendOptions, optional
        Or its fields by name, as `blend` has them.
    edge_a, edge_b : str, optional
        As `replaced_pair` has them; of the first face.
    keep_ends : bool
        Keep end edges over which the faces go on into others: there contact falls to G1, and what is said of the
        result says within which length.

    Raises
    ------
    SolidError
        The result is not sound, and nothing was written: why, and where.
    EdgeError
        The face cannot be replaced.
    BandError, ContactError, FoldError, OptionError, ComputationError, FileError
        As `blend_edges`.
    """
    check_suffixes(path, out)
    check_outputs({"out": out}, [path])
    faces = [face] if isinstance(face, int) else face
    said = named_options(options, named)
    found = solid_with_blend(path, faces, Path(out).suffix.lower(), said, edge_a, edge_b, keep_ends=keep_ends)
    write_bytes(out, found.content)
    return found


def solid_with_blend(
    path: str | Path,
    faces: Sequence[int],
    suffix: str,
    options: BlendOptions,
    edge_a: str | None = None,
    edge_b: str | None = None,
    *,
    keep_ends: bool = False,
) -> SolidBlend:
    """Return what `replace_face` writes, in the format of a suffix; its errors."""
    found = replaced_run(str(path), faces, edge_a, edge_b)
    made = _blended(found, options, keep_ends=keep_ends)
    outcome = operated(path, Replacement(made.news), suffix, f"--replace {','.join(map(str, faces))}")
    assert outcome.content is not None
    assert outcome.read_back is not None
    return SolidBlend(
        blend=made.result,
        said=found.said,
        faces=outcome.new,
        gate=outcome.report,
        read_back=outcome.read_back,
        touched=outcome.touched,
        notes=(*map(str, made.kept), *notes_of(outcome)),
        content=outcome.content,
        kept=made.kept,
    )


def can_hold_a_solid(path: str | Path, *, written: bool = False) -> bool:
    """Tell whether a solid can be read from a file, or written into it."""
    return Path(path).suffix.lower() in (_WRITTEN if written else OCC_SUFFIXES)


def check_suffixes(path: str | Path, out: str | Path) -> None:
    """Refuse files that hold no solid, or in which none can be written.

    Raises
    ------
    FileError
    """
    if not can_hold_a_solid(path):
        raise FileError(f"{path}: no solid comes from it, expected STEP, IGES or BREP; `blend_edges` makes the blend")
    if not can_hold_a_solid(out, written=True):
        raise FileError(f"{out}: no solid goes into it, expected .step or .brep; `write_surface` writes a blend")


def operated(path: str | Path, order: Replacement | Rounding | Joining, suffix: str, title: str) -> Outcome:
    """Return what came of an order, carried out by a process of its own; messages begin with the title.

    Raises
    ------
    SolidError
        The gate stopped it.
    EdgeError, ComputationError, FileError
    """
    with TemporaryDirectory() as folder:
        written = Path(folder, "order")
        written.write_bytes(pickle.dumps(order))
        outcome = read_apart(
            path, "semispline.solver.topology.occ_solid_worker", "Open CASCADE", [str(written), suffix], _TIMES
        )
    assert isinstance(outcome, Outcome)
    for report, when in ((outcome.report, ""), (outcome.read_back, "written and read again, ")):
        if report is not None and report.reason is not None:
            where = "" if report.place is None else " near ({:.6g}, {:.6g}, {:.6g})".format(*report.place)
            raise SolidError(f"{title}: {when}the result is not sound: {report.reason}{where}; nothing was written")
    return outcome


@dataclass(frozen=True, eq=False)
class _Blended:
    """The blend of both sides of a run, cut into what takes the place of each face; and how it meets kept ends."""

    result: BlendResult
    news: tuple[NewFace, ...]
    kept: tuple[KeptEnd, ...] = ()


def _blended(found: ReplacedRun, options: BlendOptions, *, keep_ends: bool) -> _Blended:
    """Return the blend of both sides, its end curves on the end faces or on edges that are kept."""
    graph, run = found.measured.graph, found.run
    relations = relate(graph)
    a, b = (_one_base(run, side, name) for side, name in zip(_bases(found, options), "AB", strict=True))
    numbers = [
        tuple(tuple(int(graph.uses.number[row]) for row in side.uses) for side in (m.a, m.b)) for m in run.members
    ]
    if run.closed:
        result = blend_bases(a, b, options)
        surface = result.surface.to_bspline()
        if len(run.members) == 1:
            return _Blended(result, (NewFace(run.faces[0], (numbers[0][0], numbers[0][1]), surface),))
        kept: list[KeptEdge] = []
        ends: tuple[KeptEnd, ...] = ()
    else:
        rows = run.ends(graph)
        smooth = going_on(graph, relations, rows) if keep_ends else []
        rest = [row for row in rows if row not in smooth]
        at = faces_at_ends(graph, relations, rest)
        check_ends(graph, relations, run, rest)
        kept = kept_edges(graph, relations, smooth)
        result, surface = blend_onto(graph, a, b, options, at, kept)
        surface, made = ended_on_edges(surface, kept)
        ends = tuple(made)
        if ends:
            result = measured_again(result, surface, a, b)
    panels = panels_of(graph, run, surface)
    news = tuple(
        NewFace(
            face,
            (contacts[0], contacts[1]),
            panel.surface,
            panel.a,
            panel.b,
            tuple(edge.number for edge in kept if edge.face == face),
        )
        for face, contacts, panel in zip(run.faces, numbers, panels, strict=True)
    )
    return _Blended(result, news, ends)


def _bases(found: ReplacedRun, options: BlendOptions) -> list[tuple[EdgeBase, ...]]:
    return close_bases([found.a, found.b], options.continuities)


def _one_base(run: FaceRun, side: Sequence[EdgeBase], name: str) -> EdgeBase:
    if len(side) != 1:
        raise EdgeError(
            f"--replace {','.join(map(str, run.faces))}: along contact {name} no one blend runs, it has {len(side)} "
            "parts; --surfaces writes their blends"
        )
    return side[0]


def close_bases(ends: Sequence[Resolved], continuities: Sequence[Continuity]) -> list[tuple[EdgeBase, ...]]:
    """Return the bases along both contacts, as close to their faces as bands come."""
    try:
        return edge_bases(ends, continuities, _SHARE)
    except BandError:
        return edge_bases(ends, continuities)


def notes_of(outcome: Outcome) -> tuple[str, ...]:
    """Return what else is to be said of a changed file."""
    notes = list(outcome.notes)
    if outcome.times > 1:
        notes.append(f"the part stands {outcome.times} times in the file, and is changed wherever it stands")
    names = outcome.report.open_edges
    if names:
        said = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
        verb = "belong" if len(names) > 1 else "belongs"
        notes.append(f"{said} {verb} to one face alone, as before: this is no closed solid")
    return tuple(notes)


def _gate_record(report: GateReport) -> dict[str, Any]:
    found = asdict(report)
    # It is sound: there is no reason and no place.
    return {name: value for name, value in found.items() if name not in ("reason", "place")}
