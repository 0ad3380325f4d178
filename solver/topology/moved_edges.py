"""Two edges whose contacts are moved into their faces, as along a sharp edge between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np

from semispline.solver.errors import EdgeError
from semispline.solver.io import LoadedSurface, in_one_unit, read_surfaces, split_spec
from semispline.solver.splines import BSplineSurface, bounding_box, parse_edge
from semispline.solver.topology.band_search import Continuity
from semispline.solver.topology.cuts import Cut, MovedContact, moved_contact, parse_cut
from semispline.solver.topology.edge_names import LINE, line_tolerance
from semispline.solver.topology.face_edges import (
    ResolvedEdge,
    check_face,
    edge_of_use,
    is_of_a_face,
    only_face,
    resolve_edge,
    row_of,
)
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.outlines import border, outline_of
from semispline.solver.topology.relations import relate

_NAMES = ("A", "B")


def moved_edges(
    specs: tuple[str, str],
    edges: tuple[str | None, str | None],
    cuts: tuple[str | None, str | None],
    continuity: tuple[Continuity, Continuity] = ("G2", "G2"),
) -> list[ResolvedEdge]:
    """Return the edges of a blend whose contacts are moved into the faces.

    Parameters
    ----------
    specs : (str, str)
        "PATH#N" of both surfaces.
    edges : (str or None, str or None)
        As `resolve_edge` takes them; both None for the one edge that two faces of one file share.
    cuts : (str or None, str or None)
        A distance in model units, "2.5": along the surface, square to the edge; a parameter, "u=0.3"; None where the
        contact stays.
    continuity : (str, str)
        That contacts along free curves are to be met with.

    Raises
    ------
    EdgeError
        The faces share no edge, or several; a cut reaches beyond the face: the largest possible one is said.
    FileError, ComputationError
        As `resolve_edge`.
    """
    read = lru_cache(maxsize=None)(measured_edges)
    words = _shared_edge(read, specs) if edges == (None, None) else edges
    found = []
    for name, spec, word, cut, order in zip(_NAMES, specs, words, cuts, continuity, strict=True):
        option = f"--edge-{name.lower()}"
        if word is None:
            raise EdgeError(f"{option}: found one edge of two, expected both, or none where the faces share an edge")
        if cut is None:
            found.append(resolve_edge(spec, word, option))
            continue
        title = f"--cut-{name.lower()} {cut}"
        found.append(_moved(read, spec, word, parse_cut(cut, title.split(maxsplit=1)[0]), order, option, title))
    same = in_one_unit([one.loaded for one in found])
    return [replace(one, loaded=loaded) for one, loaded in zip(found, same, strict=True)]


def _moved(
    read: Callable[[str], MeasuredEdges],
    spec: str,
    word: str,
    cut: Cut,
    continuity: Continuity,
    option: str,
    title: str,
) -> ResolvedEdge:
    """Return an edge of a surface or a face whose contact is moved into it."""
    if not is_of_a_face(word):
        (loaded,) = read_surfaces([spec])
        surface, name = _spline(loaded), parse_edge(word, option)
        tolerance = LINE * float(np.ptp(bounding_box(surface), axis=0).max())
        moved = moved_contact(surface, name, cut, border(surface, name), tolerance, title, continuity)
        return _resolved(spec, loaded, moved, word, f"{name} of {spec}")
    if not word.strip().startswith("e"):
        at = resolve_edge(spec, word, option)
        assert at.entry is not None
        spec, word = at.spec, at.entry.name
    path, face = split_spec(spec)
    measured = read(path)
    row = row_of(measured.graph, word.strip(), only_face(measured.graph, face, path), option)
    (loaded,) = read_surfaces([spec])
    surface, entry = _spline(loaded), edge_of_use(measured, row, loaded)
    if entry.edge is None and entry.kind != "free":
        raise EdgeError(f"{title}: {entry.name} of {spec} is {entry.kind}; no contact can be moved from it")
    tolerance = line_tolerance(measured.graph, row)
    outline = outline_of(measured.graph, row, surface)
    moved = moved_contact(surface, entry.edge, cut, outline, tolerance, title, continuity)
    return _resolved(spec, replace(loaded, boundary=None), moved, word, f"{entry.name} of {spec}")


def _resolved(spec: str, loaded: LoadedSurface, moved: MovedContact, word: str, edge: str) -> ResolvedEdge:
    if moved.name is not None:
        return ResolvedEdge(spec, loaded, str(moved.name), word, None, f"{moved.said}, from {edge}")
    if len(moved.bands) > 1:
        raise EdgeError(
            f"{edge}: the contact is cut into {len(moved.bands)} parts, {moved.bands[0].cut_at_end}: no single blend"
        )
    (band,) = moved.bands
    return ResolvedEdge(
        spec, replace(loaded, surface=band.surface), band.edge, word, None, f"{moved.said}, from {edge}"
    )


def _spline(loaded: LoadedSurface) -> BSplineSurface:
    if isinstance(loaded.surface, BSplineSurface):
        return loaded.surface
    return loaded.surface.to_bspline()


def _shared_edge(read: Callable[[str], MeasuredEdges], specs: tuple[str, str]) -> tuple[str, str]:
    """Return what the one edge is called that two faces of a file share."""
    (path, face), (other_path, other) = (split_spec(spec) for spec in specs)
    if path != other_path or face is None or other is None or face == other:
        raise EdgeError(
            f"--edge-a, --edge-b: missing, expected the edges of {specs[0]} and {specs[1]}: only two faces of one "
            "file, PATH#N and PATH#M, can share one"
        )
    graph = read(path).graph
    uses, partner = graph.uses, relate(graph).partner
    check_face(graph, face, path)
    check_face(graph, other, path)
    rows = [row for row in range(*uses.of_face(face).indices(len(uses))) if partner[row] != NONE]
    rows = [row for row in rows if uses.face[partner[row]] == other]
    if len(rows) != 1:
        names = ", ".join(f"{uses.name(row)} and {uses.name(int(partner[row]))}" for row in rows)
        what = f"share {len(rows)} edges ({names}); choose one by --edge-a and --edge-b" if rows else "share no edge"
        raise EdgeError(f"{specs[0]} and {specs[1]} {what}")
    return uses.name(rows[0]), uses.name(int(partner[rows[0]]))
