"""A sharp edge of a solid rounded by a blend: one valid solid back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from semispline.solver.errors import EdgeError
from semispline.solver.io import check_outputs, write_bytes
from semispline.solver.options import BlendOptions, named_options
from semispline.solver.topology.cuts import parse_cut
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.edge_moving import moved_edges
from semispline.solver.topology.end_faces import blend_onto
from semispline.solver.topology.face_edges import check_face, row_of
from semispline.solver.topology.flat_contacts import flat_contact, is_flat_contact
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.topology.solid_blends import (
    SolidBlend,
    check_suffixes,
    close_bases,
    notes_of,
    operated,
)
from semispline.solver.topology.solid_orders import Rounding


def round_edge(
    path: str | Path,
    face: int,
    edge: str,
    distance: float | tuple[float, float],
    out: str | Path,
    options: BlendOptions | None = None,
    **named: Any,
) -> SolidBlend:
    """Round a sharp edge of a solid in a file by a blend, and write the file with all else as it was.

    Parameters
    ----------
    path : str or Path
        A STEP, IGES or BREP file.
    face : int
        N of `PATH#N`.
    edge : str
        One of its edges, "e3", at each end of which two others meet it; or a closed rim.
    distance : float, or pair of float
        How far the contact lies from the edge, along this face and along the one beyond; model units.
    out : str or Path
        A STEP or BREP file.
    options : BlendOptions, optional
        Or its fields by name, as `blend` has them.

    Raises
    ------
    SolidError
        The result is not sound, and nothing was written: why, and where.
    EdgeError
        The edge cannot be rounded so: the largest possible distance is said where there is one.
    BandError, ContactError, FoldError, OptionError, ComputationError, FileError
        As `blend_edges`.
    """
    check_suffixes(path, out)
    check_outputs({"out": out}, [path])
    cuts = distance if isinstance(distance, tuple) else (distance, distance)
    words = (repr(float(cuts[0])), repr(float(cuts[1])))
    found = solid_with_round(path, face, edge, words, Path(out).suffix.lower(), named_options(options, named))
    write_bytes(out, found.content)
    return found


def solid_with_round(
    path: str | Path, face: int, edge: str, cuts: tuple[str, str], suffix: str, options: BlendOptions
) -> SolidBlend:
    """Return what `round_edge` writes, in the format of a suffix; cuts are words, as `parse_cut` takes them."""
    graph = measured_edges(path).graph
    check_face(graph, face, str(path))
    relations = relate(graph)
    row = row_of(graph, edge, face, "--round")
    title = f"--round {face}:{edge}"
    other = int(relations.partner[row])
    if other == NONE or graph.uses.face[other] == face:
        raise EdgeError(f"{title}: the edge lies between no two faces")
    if not relations.sharp[row]:
        raise EdgeError(f"{title}: the faces meet at {relations.median[row]:.2g} degrees there; no sharp edge")
    beyond = int(graph.uses.face[other])
    at = _ends(graph, relations, row, other, title)
    a, b = _contacts(graph, (row, other), cuts, options, title)
    if at:
        result, surface = blend_onto(graph, a, b, options, at)
    else:
        result = blend_bases(a, b, options)
        surface = result.surface.to_bspline()
    order = Rounding(face, int(edge[1:]), surface, not bool(relations.convex[row]))
    outcome = operated(path, order, suffix)
    assert outcome.content is not None
    assert outcome.read_back is not None
    kind = "edge" if relations.convex[row] else "inner edge"
    return SolidBlend(
        blend=result,
        said=f"{kind} {edge} between faces {face} and {beyond} rounded, cuts {cuts[0]} and {cuts[1]}",
        faces=outcome.new,
        gate=outcome.report,
        read_back=outcome.read_back,
        touched=outcome.touched,
        notes=notes_of(outcome),
        content=outcome.content,
    )


def _contacts(
    graph: EdgeGraph, rows: tuple[int, int], cuts: tuple[str, str], options: BlendOptions, title: str
) -> tuple[EdgeBase, EdgeBase]:
    """Return the bases along both contacts: exact ones in flat faces along straight edges."""
    uses = graph.uses
    specs = [f"{graph.path}#{uses.face[row]}" for row in rows]
    # It also says how far the faces reach.
    moved = moved_edges((specs[0], specs[1]), (uses.name(rows[0]), uses.name(rows[1])), cuts)
    found: list[EdgeBase | None] = [None, None]
    for k, (row, word) in enumerate(zip(rows, cuts, strict=True)):
        distance = parse_cut(word).distance
        if distance is not None and is_flat_contact(graph, row):
            base = flat_contact(graph, row, distance)
            found[k] = None if base is None else EdgeBase(uses.name(row), base)
    for k in (k for k in (0, 1) if found[k] is None):
        (side,) = close_bases([moved[k]], [options.continuities[k]])
        if len(side) != 1:
            raise EdgeError(
                f"{title}: along its contact on face {uses.face[rows[k]]} no one blend runs; it has corners"
            )
        found[k] = side[0]
    a, b = found
    assert a is not None
    assert b is not None
    return a, b


def _ends(graph: EdgeGraph, relations: Relations, row: int, other: int, title: str) -> list[tuple[Any, int]]:
    """Return the ends of an edge, each with a use by the face beyond; none of a closed one.

    Raises
    ------
    EdgeError
        The edge goes on, or no single face lies beyond an end.
    """
    uses = graph.uses
    points = uses.walked_points(row)
    if ((points[0] - points[-1]) ** 2).sum() ** 0.5 <= 1e-6 * graph.size:
        return []
    found = []
    # At the end of the one walk the other begins.
    for point, mine, yours in (
        (points[0], int(uses.previous[row]), int(uses.following[other])),
        (points[-1], int(uses.following[row]), int(uses.previous[other])),
    ):
        for use in (mine, yours):
            partner = int(relations.partner[use])
            if partner == NONE:
                raise EdgeError(f"{title}: {uses.name(use)} of face {uses.face[use]} at its end has no other face")
            if relations.smooth[use]:
                raise EdgeError(
                    f"{title}: it ends at {uses.name(use)} of face {uses.face[use]}, over which this goes on smoothly "
                    f"into face {uses.face[partner]}: the edges there have to be rounded together"
                )
        faces = [int(uses.face[relations.partner[use]]) for use in (mine, yours)]
        if faces[0] != faces[1]:
            raise EdgeError(
                f"{title}: at its end lie faces {faces[0]} and {faces[1]}, more than three edges meet there; three can "
                "be trimmed"
            )
        found.append((point, int(relations.partner[mine])))
    return found
