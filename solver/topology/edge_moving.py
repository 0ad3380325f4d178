"""Two edges whose contacts are moved into their faces, as along a sharp edge between them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES, LoadedSurface, in_one_unit, read_surfaces, split_spec
from semispline.solver.splines import BSplineSurface, bounding_box, parse_edge
from semispline.solver.topology.chain_names import names_several
from semispline.solver.topology.cuts import Cut, MovedContact, moved_contact, parse_cut
from semispline.solver.topology.edge_names import LINE, line_tolerance
from semispline.solver.topology.face_edges import (
    ResolvedEdge,
    check_face,
    edge_of_use,
    is_of_a_face,
    only_face,
    resolved_use,
    row_of,
)
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.measuring import MeasuredEdges, measured_edges
from semispline.solver.topology.outlines import border, curved_edges, outline_of
from semispline.solver.topology.relations import relate
from semispline.solver.topology.resolving import resolve_edge
from semispline.solver.topology.sharp_chains import shared_sharp_edge
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves

_NAMES = ("A", "B")


def moved_edges(
    specs: tuple[str, str],
    edges: tuple[str | None, str | None],
    cuts: tuple[str | None, str | None],
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

    Raises
    ------
    EdgeError
        The faces share no edge, or several; a cut reaches beyond the face: the largest possible one is said.
    FileError, ComputationError
        As `resolve_edge`.
    """
    read = cache(measured_edges)
    words = _shared_edge(read, specs) if edges == (None, None) else edges
    ends = [_wanted(read, *one) for one in zip(_NAMES, specs, words, cuts, strict=True)]
    surfaces = _surfaces([end.spec for end in ends])
    curves = _curves([end for end in ends if end.cut is not None])
    found = []
    for end, loaded in zip(ends, surfaces, strict=True):
        if end.row is None or end.measured is None:
            found.append(_moved_on_surface(end, loaded))
        elif end.cut is None:
            found.append(resolved_use(end.measured, end.row, end.spec, loaded, end.word, end.option))
        else:
            found.append(_moved_in_face(end, end.cut, end.measured, end.row, loaded, curves))
    same = in_one_unit([one.loaded for one in found])
    return [replace(one, loaded=loaded) for one, loaded in zip(found, same, strict=True)]


def moved_uses(measured: MeasuredEdges, rows: Sequence[int], cuts: Sequence[str]) -> list[ResolvedEdge]:
    """Return uses of edges by faces of one file, each moved into its face; errors as `moved_edges`.

    Parameters
    ----------
    measured : MeasuredEdges
    rows : sequence of int
    cuts : sequence of str
        As `moved_edges` has them.

    Raises
    ------
    EdgeError
        Of all faces that do not reach so far, how far they do.
    """
    uses, path = measured.graph.uses, measured.graph.path
    # Of a chain a face may have several.
    titles = [f"face {uses.face[row]}" + f", beside {uses.name(row)}" * (len(rows) > 2) for row in rows]
    ends = [
        _Wanted("A", f"{path}#{uses.face[row]}", uses.name(row), parse_cut(cut), measured, row, title)
        for row, cut, title in zip(rows, cuts, titles, strict=True)
    ]
    surfaces, curves = _surfaces([end.spec for end in ends]), _curves(ends)
    found, refused = [], []
    for end, loaded, row in zip(ends, surfaces, rows, strict=True):
        assert end.cut is not None
        try:
            found.append(_moved_in_face(end, end.cut, measured, row, loaded, curves))
        except EdgeError as error:
            refused.append(str(error))
    if refused:
        raise EdgeError("; ".join(dict.fromkeys(refused)))
    return found


def sharp_edge_between(specs: tuple[str, str], edges: tuple[str | None, str | None]) -> tuple[str, int, str] | None:
    """Return file, face and edge where two words for edges mean one sharp edge that two faces of a solid share.

    Parameters
    ----------
    specs, edges
        As `moved_edges` has them.

    Returns
    -------
    tuple or None
        The face and the name of the edge are those of the first word.

    Raises
    ------
    EdgeError
        The faces share no edge, or several.
    FileError, ComputationError
        As `read_edges`.
    """
    (path, face), (other_path, other) = (split_spec(spec) for spec in specs)
    said = [None if word is None else word.strip() for word in edges]
    if path != other_path or any(word is not None and not re.fullmatch(r"e\d+", word) for word in said):
        return None
    read = cache(measured_edges)
    one, two = _shared_edge(read, specs) if said == [None, None] else said
    if one is None or two is None or face is None or other is None:
        return None
    graph = read(path).graph
    a, b = row_of(graph, one, face, "--edge-a"), row_of(graph, two, other, "--edge-b")
    return (path, face, one) if shared_sharp_edge(graph, relate(graph), a, b) else None


@dataclass(frozen=True, eq=False)
class _Wanted:
    """One side: what was said, and the use of the edge where it is one of a face."""

    name: str
    spec: str
    word: str
    cut: Cut | None
    measured: MeasuredEdges | None = None
    row: int | None = None
    called: str | None = None

    @property
    def option(self) -> str:
        return f"--edge-{self.name.lower()}"

    @property
    def title(self) -> str:
        """How messages of its cut begin."""
        if self.called is not None:
            return self.called
        cut = self.cut
        assert cut is not None
        value = f"{cut.distance:g}" if cut.distance is not None else f"{cut.direction}={cut.parameter:g}"
        return f"--cut-{self.name.lower()} {value}"


def _wanted(read: Callable[[str], MeasuredEdges], name: str, spec: str, word: str | None, cut: str | None) -> _Wanted:
    option = f"--edge-{name.lower()}"
    if word is None:
        raise EdgeError(f"{option}: found one edge of two, expected both, or none where the faces share an edge")
    word, wanted = word.strip(), None if cut is None else parse_cut(cut, f"--cut-{name.lower()}")
    if names_several(word):
        raise EdgeError(f"{option}: found {word!r} together with --cut-a or --cut-b, expected one edge")
    if not is_of_a_face(word):
        return _Wanted(name, spec, word, wanted)
    if not word.startswith("e"):
        at = resolve_edge(spec, word, option)
        assert isinstance(at, ResolvedEdge)
        assert at.entry is not None
        spec, word = at.spec, at.entry.name
    path, face = split_spec(spec)
    measured = read(path)
    row = row_of(measured.graph, word, only_face(measured.graph, face, path), option)
    return _Wanted(name, spec, word, wanted, measured, row)


def _surfaces(specs: Sequence[str]) -> list[LoadedSurface]:
    """Return the surfaces, in the units of their files, each file read once."""
    found: dict[str, LoadedSurface] = {}
    for path in dict.fromkeys(split_spec(spec)[0] for spec in specs):
        here = [spec for spec in specs if split_spec(spec)[0] == path]
        found |= dict(zip(here, read_surfaces(here), strict=True))
    return [found[spec] for spec in specs]


def _curves(ends: Sequence[_Wanted]) -> dict[tuple[str, int], TrimCurve]:
    """Return the edges of the faces that are no straight lines in the parameters, each file read once."""
    found: dict[tuple[str, int], TrimCurve] = {}
    paths: dict[str, dict[int, tuple[int, int]]] = {}
    for end in ends:
        if end.measured is not None and end.row is not None:
            uses = end.measured.graph.uses
            for row in curved_edges(end.measured.graph, end.row):
                paths.setdefault(split_spec(end.spec)[0], {})[row] = int(uses.face[row]), int(uses.number[row])
    for path, wanted in paths.items():
        for row, curve in zip(wanted, read_trim_curves(path, list(wanted.values())), strict=True):
            found[path, row] = curve
    return found


def _moved_on_surface(end: _Wanted, loaded: LoadedSurface) -> ResolvedEdge:
    """Return an edge of a whole surface, moved where it is cut."""
    surface, name = _spline(loaded), parse_edge(end.word, end.option)
    if end.cut is None:
        return ResolvedEdge(end.spec, loaded, str(name))
    tolerance = LINE * float(np.ptp(bounding_box(surface), axis=0).max())
    moved = moved_contact(
        surface, name, end.cut, border(surface, name), tolerance, end.title, end.word, _millimetres(loaded)
    )
    return _resolved(end.spec, loaded, moved, end.word, f"{name} of {end.spec}")


def _moved_in_face(
    end: _Wanted,
    cut: Cut,
    measured: MeasuredEdges,
    row: int,
    loaded: LoadedSurface,
    curves: Mapping[tuple[str, int], TrimCurve],
) -> ResolvedEdge:
    """Return an edge of a face, moved into it."""
    surface, entry = _spline(loaded), edge_of_use(measured, row, loaded)
    if entry.edge is None and entry.kind != "free":
        raise EdgeError(f"{end.title}: {entry.name} of {end.spec} is {entry.kind}; no contact can be moved from it")
    path = split_spec(end.spec)[0]
    own = {row: curve for (where, row), curve in curves.items() if where == path}
    outline = outline_of(measured.graph, row, surface, own)
    tolerance = line_tolerance(measured.graph, row)
    moved = moved_contact(surface, entry.edge, cut, outline, tolerance, end.title, entry.name, _millimetres(loaded))
    # It is the face's own: what its surface does elsewhere needs no warning.
    return _resolved(end.spec, replace(loaded, boundary=None), moved, end.word, f"{entry.name} of {end.spec}")


def _resolved(spec: str, loaded: LoadedSurface, moved: MovedContact, word: str, edge: str) -> ResolvedEdge:
    name = moved.curve.word if moved.name is None and moved.curve is not None else str(moved.name)
    return ResolvedEdge(spec, loaded, name, word, None, f"{edge} moved to {moved.said}", moved.curve)


def _millimetres(loaded: LoadedSurface) -> float | None:
    return None if loaded.unit is None else MILLIMETRES[loaded.unit]


def _spline(loaded: LoadedSurface) -> BSplineSurface:
    if isinstance(loaded.surface, BSplineSurface):
        return loaded.surface
    return loaded.surface.to_bspline()


def _shared_edge(read: Callable[[str], MeasuredEdges], specs: tuple[str, str]) -> tuple[str, str]:
    """Return what the one edge is called that two faces of a file share."""
    (path, face), (other_path, other) = (split_spec(spec) for spec in specs)
    if path == other_path and face is not None and face == other:
        raise EdgeError(
            f"--edge-a, --edge-b: missing, expected two edges of {specs[0]}: a face shares no edge with itself; "
            f"`semispline list {path} --edges {face}` lists them"
        )
    if path != other_path or face is None or other is None:
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
