"""Runs of faces that are replaced together, with both long sides as the faces beyond have them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from semispline.solver.io import LoadedSurface, read_surfaces
from semispline.solver.topology.between import Between
from semispline.solver.topology.chain_edges import chain_of_uses
from semispline.solver.topology.contact_words import beyond
from semispline.solver.topology.face_edges import check_face, resolved_use
from semispline.solver.topology.face_runs import FaceRun, counted
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.relations import relate
from semispline.solver.topology.replacing import resolved_pair, rows_beyond
from semispline.solver.topology.resolving import Resolved
from semispline.solver.topology.run_ends import run_of

# How the sides of a face are walked along the run.
_WALKS: tuple[Callable[[Between], Sequence[int]], ...] = (lambda m: m.a.uses, lambda m: m.b.uses[::-1])


@dataclass(frozen=True, eq=False)
class ReplacedRun:
    """Both sides of a run, to be blended as if its faces were not there.

    Attributes
    ----------
    measured : MeasuredEdges
    run : FaceRun
    a, b : ResolvedEdge or ResolvedChain
        The sides as those of the faces beyond.
    said : str
        What was taken, in words.
    """

    measured: MeasuredEdges
    run: FaceRun
    a: Resolved
    b: Resolved
    said: str


def replaced_run(path: str, faces: Sequence[int], edge_a: str | None = None, edge_b: str | None = None) -> ReplacedRun:
    """Return what is to be blended when faces of a file are replaced together.

    Parameters and errors are those of `replaced_pair`; `edge_a` and `edge_b` are edges of the first face.
    """
    measured = measured_edges(path)
    graph = measured.graph
    for face in faces:
        check_face(graph, face, str(path))
    run = run_of(graph, relate(graph), faces, edge_a, edge_b)
    if run.is_plain:
        (between,) = run.members
        pair = resolved_pair(measured, between, _loaded(graph, rows_beyond(graph, between)))
        return ReplacedRun(measured, run, pair.a, pair.b, pair.said)
    a, b = _sides(measured, run)
    length = sum(member.length for member in run.members)
    width = sum(member.width * member.length for member in run.members) / length
    kind = "a closed run, " if run.closed and len(run.members) > 1 else ""
    said = (
        f"{counted(run.faces)} replaced from {a.edge} to {b.edge}: {kind}{length:.4g} x {width:.4g} "
        f"{graph.unit or 'model units'}"
    )
    return ReplacedRun(measured, run, a, b, said)


def _sides(measured: MeasuredEdges, run: FaceRun) -> list[Resolved]:
    """Return both sides of a run as the faces beyond have them."""
    graph = measured.graph
    # The faces beyond walk side a against the run, and side b along it.
    both = [beyond(relate(graph), [row for m in run.members for row in uses(m)]) or () for uses in _WALKS]
    # Each file is read once.
    loaded = iter(_loaded(graph, [row for rows in both for row in rows]))
    return [_side(measured, rows, [next(loaded) for _ in rows], name) for rows, name in zip(both, "AB", strict=True)]


def _side(measured: MeasuredEdges, rows: Sequence[int], loaded: Sequence[LoadedSurface], name: str) -> Resolved:
    graph = measured.graph
    specs = [f"{graph.path}#{graph.uses.face[row]}" for row in rows]
    edges = [
        resolved_use(measured, row, spec, surface, graph.uses.name(row), f"base {name}")
        for row, spec, surface in zip(rows, specs, loaded, strict=True)
    ]
    if len(edges) == 1:
        return edges[0]
    word = "+".join(f"{graph.uses.face[row]}:{graph.uses.name(row)}" for row in rows)
    return chain_of_uses(graph, rows, edges, word, f"base {name}")


def _loaded(graph: EdgeGraph, rows: Sequence[int]) -> list[LoadedSurface]:
    return list(read_surfaces([f"{graph.path}#{graph.uses.face[row]}" for row in rows]))
