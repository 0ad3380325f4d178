"""A sharp edge of a solid rounded by a blend: one valid solid back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from semispline.solver.blending import Chain, facing_rims, split_places
from semispline.solver.io import check_outputs, write_bytes
from semispline.solver.options import BlendOptions, named_options
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_blends import blend_bases
from semispline.solver.topology.end_faces import blend_onto
from semispline.solver.topology.face_edges import check_face, row_of
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import relate
from semispline.solver.topology.round_contacts import round_contacts
from semispline.solver.topology.sharp_chains import SharpChain, chain_names, sharp_chain
from semispline.solver.topology.solid_blends import (
    SolidBlend,
    check_suffixes,
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
        One of its edges, "e3", at each end of which two others meet it; or a closed rim. Sharp edges that go on in it
        smoothly are rounded with it.
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
    path: str | Path,
    face: int,
    edge: str,
    cuts: tuple[str, str],
    suffix: str,
    options: BlendOptions,
    title: str | None = None,
) -> SolidBlend:
    """Return what `round_edge` writes, in the format of a suffix.

    Cuts are words, as `parse_cut` takes them; messages begin with the title, or else with the edge to be rounded.
    """
    measured = measured_edges(path)
    graph, title = measured.graph, title or f"--round {face}:{edge}"
    check_face(graph, face, str(path))
    relations = relate(graph)
    chain = sharp_chain(graph, relations, row_of(graph, edge, face, "--round"), title)
    a, b = round_contacts(measured, chain, cuts, options, title)
    matched = _with_joints(a, b, options)
    if chain.at:
        result, surface = blend_onto(graph, a, b, matched, chain.at)
    else:
        result = blend_bases(a, b, matched)
        surface = result.surface.to_bspline()
    uses = graph.uses
    order = Rounding(
        face,
        tuple((int(uses.face[row]), int(uses.number[row])) for row in chain.rows),
        surface,
        split_places(result),
        chain.closed,
        not chain.convex,
    )
    outcome = operated(path, order, suffix, title)
    assert outcome.content is not None
    assert outcome.read_back is not None
    return SolidBlend(
        blend=result,
        said=_said(graph, chain, edge, cuts),
        faces=outcome.new,
        gate=outcome.report,
        read_back=outcome.read_back,
        touched=outcome.touched,
        notes=notes_of(outcome),
        content=outcome.content,
    )


def _with_joints(a: EdgeBase, b: EdgeBase, options: BlendOptions) -> BlendOptions:
    """Return the options with joints of one side that answer those of the other, where nothing else was asked for."""
    if not isinstance(a.base, Chain) or not isinstance(b.base, Chain) or options.match != "affine":
        return options
    count = len(a.base.edges)
    if len(b.base.edges) != count or facing_rims(a.base, b.base, options) is not None:
        return options
    # What ends where it begins is one pair.
    return replace(options, match=tuple((float(k), float(k)) for k in range(count if a.base.closed else count + 1)))


def _said(graph: EdgeGraph, chain: SharpChain, edge: str, cuts: tuple[str, str]) -> str:
    uses, kind = graph.uses, "edge" if chain.convex else "inner edge"
    faces = [" and ".join(dict.fromkeys(str(uses.face[row]) for row in rows)) for rows in (chain.rows, chain.others)]
    if len(chain.rows) == 1:
        what = f"{kind} {edge} between faces {faces[0]} and {faces[1]}"
    else:
        what = f"{len(chain.rows)} {kind}s that go on in each other, {', '.join(chain_names(graph, chain))},"
    return f"{what} rounded, cuts {cuts[0]} and {cuts[1]}"
