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
from semispline.solver.io import OCC_SUFFIXES, check_outputs, read_apart, read_surfaces, write_bytes
from semispline.solver.options import BlendOptions, Continuity, named_options
from semispline.solver.splines import BSplineSurface
from semispline.solver.topology.bases import edge_bases
from semispline.solver.topology.between import Between
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.end_faces import blend_onto, check_ends, end_edges, faces_at_ends
from semispline.solver.topology.face_edges import ResolvedEdge, check_face
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.relations import relate
from semispline.solver.topology.replacing import ReplacedPair, pair_of, resolved_pair, rows_beyond
from semispline.solver.topology.solid_gate import GateReport
from semispline.solver.topology.solid_orders import Outcome, Replacement, Rounding

# Operating, measuring twice, writing and reading again take so many times as long as reading, at most.
_TIMES = 12.0
# Of their limits bands use so much: then they lie within 1e-7 of their length, and no tolerance grows.
_SHARE = 1e-2
_WRITTEN = (".step", ".stp", ".brep", ".brp")


@dataclass(frozen=True, eq=False)
class SolidBlend:
    """A solid with a blend in the place of one of its faces.

    Attributes
    ----------
    blend : BlendResult
    said : str
        What was replaced or rounded.
    face : int
        The new face, by its number in the file that is written; the first of several.
    gate : GateReport
        What was measured of the solid before it was written.
    read_back : GateReport
        The same of what was written and read again.
    touched : tuple of int
        Faces whose borders were changed.
    notes : tuple of str
        What else is to be said.
    content : bytes
        The file.
    faces : tuple of int
        All new faces.
    """

    blend: BlendResult
    said: str
    face: int
    gate: GateReport
    read_back: GateReport
    touched: tuple[int, ...]
    notes: tuple[str, ...]
    content: bytes
    faces: tuple[int, ...]

    def record(self) -> dict[str, Any]:
        """Return what a report holds of the solid."""
        return {
            "new_face": self.face,
            "new_faces": list(self.faces),
            "touched": list(self.touched),
            "notes": list(self.notes),
            **{name: _gate_record(x) for name, x in (("solid", self.gate), ("read_back", self.read_back))},
        }


def replace_face(
    path: str | Path,
    face: int,
    out: str | Path,
    options: BlendOptions | None = None,
    *,
    edge_a: str | None = None,
    edge_b: str | None = None,
    **named: Any,
) -> SolidBlend:
    """Replace a fillet of a solid in a file by a blend, and write the file with all else as it was.

    Parameters
    ----------
    path : str or Path
        A STEP, IGES or BREP file.
    face : int
        N of `PATH#N`: a face with four edges, or with two rims and a seam.
    out : str or Path
        A STEP or BREP file.
    options : BlendOptions, optional
        Or its fields by name, as `blend` has them.
    edge_a, edge_b : str, optional
        As `replaced_pair` has them.

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
    found = solid_with_blend(path, face, Path(out).suffix.lower(), named_options(options, named), edge_a, edge_b)
    write_bytes(out, found.content)
    return found


def solid_with_blend(
    path: str | Path,
    face: int,
    suffix: str,
    options: BlendOptions,
    edge_a: str | None = None,
    edge_b: str | None = None,
) -> SolidBlend:
    """Return what `replace_face` writes, in the format of a suffix; its errors."""
    measured = measured_edges(path)
    graph = measured.graph
    check_face(graph, face, str(path))
    between = pair_of(graph, relate(graph), face, edge_a, edge_b)
    specs = [f"{path}#{graph.uses.face[row]}" for row in rows_beyond(graph, between)]
    pair = resolved_pair(measured, between, read_surfaces(specs))
    result, surface = _blended(measured, between, pair, options)
    names = [tuple(int(graph.uses.number[row]) for row in side.uses) for side in (between.a, between.b)]
    outcome = operated(path, Replacement(face, (names[0], names[1]), surface), suffix)
    assert outcome.content is not None
    assert outcome.read_back is not None
    return SolidBlend(
        blend=result,
        said=pair.said,
        face=outcome.new[0],
        faces=outcome.new,
        gate=outcome.report,
        read_back=outcome.read_back,
        touched=outcome.touched,
        notes=notes_of(outcome),
        content=outcome.content,
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


def operated(path: str | Path, order: Replacement | Rounding, suffix: str) -> Outcome:
    """Return what came of an order, carried out by a process of its own.

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
    title = f"--replace {order.face}"
    if isinstance(order, Rounding):
        title = "--round {}:e{}".format(*order.edges[0])
    for report, when in ((outcome.report, ""), (outcome.read_back, "written and read again, ")):
        if report is not None and report.reason is not None:
            where = "" if report.place is None else " near ({:.6g}, {:.6g}, {:.6g})".format(*report.place)
            raise SolidError(f"{title}: {when}the result is not sound: {report.reason}{where}; nothing was written")
    return outcome


def _blended(
    measured: MeasuredEdges, between: Between, pair: ReplacedPair, options: BlendOptions
) -> tuple[BlendResult, BSplineSurface]:
    """Return the blend of both contacts, its end curves on the end faces."""
    graph, face = measured.graph, between.face
    relations = relate(graph)
    sides = close_bases([pair.a, pair.b], options.continuities)
    for side, contact in zip(sides, pair.contacts, strict=True):
        if len(side) != 1:
            raise EdgeError(
                f"--replace {face}: along {contact} no one blend runs, the contact has {len(side)} parts; --surfaces "
                "writes their blends"
            )
    a, b = sides[0][0], sides[1][0]
    if between.a.closed or between.b.closed:
        result = blend_bases(a, b, options)
        return result, result.surface.to_bspline()
    ends = end_edges(graph, face, (between.a.uses, between.b.uses))
    check_ends(graph, relations, face, ends)
    return blend_onto(graph, a, b, options, faces_at_ends(graph, relations, ends))


def close_bases(ends: Sequence[ResolvedEdge], continuities: Sequence[Continuity]) -> list[tuple[EdgeBase, ...]]:
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
    if outcome.report.open_edges:
        notes.append(f"{outcome.report.open_edges} edges belong to one face alone, as before: this is no closed solid")
    return tuple(notes)


def _gate_record(report: GateReport) -> dict[str, Any]:
    found = asdict(report)
    # It is sound: there is no reason and no place.
    return {name: value for name, value in found.items() if name not in ("reason", "place")}
