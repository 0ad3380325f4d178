"""The bases of a blend along sharp edges that are rounded: contacts moved into the faces on both sides."""

from __future__ import annotations

from collections.abc import Sequence

from semispline.solver.errors import EdgeError
from semispline.solver.options import BlendOptions, Continuity
from semispline.solver.topology.cuts import parse_cut
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.edge_moving import moved_uses
from semispline.solver.topology.face_edges import ResolvedEdge
from semispline.solver.topology.flat_contacts import (
    FlatEdge,
    curves_wanted,
    flat_contact,
    is_flat,
    is_straight_flat,
    largest_distance,
)
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.joined_bases import joined
from semispline.solver.topology.measuring import MeasuredEdges
from semispline.solver.topology.sharp_chains import SharpChain
from semispline.solver.topology.solid_blends import close_bases
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves

# Of the size: so far an edge leads into a face that leads nowhere in it.
_NOTHING = 1e-9


def round_contacts(
    measured: MeasuredEdges, chain: SharpChain, cuts: tuple[str, str], options: BlendOptions, title: str
) -> tuple[EdgeBase, EdgeBase]:
    """Return the bases along both contacts: exact ones in flat faces along lines and arcs.

    Parameters
    ----------
    measured : MeasuredEdges
    chain : SharpChain
    cuts : (str, str)
        As `parse_cut` takes them.
    options : BlendOptions
    title : str
        How messages begin.

    Raises
    ------
    EdgeError
        A face does not reach so far: the largest distance is said.
    BandError, FileError
        As `edge_bases` and `read_trim_curves`.
    """
    graph = measured.graph
    rows = [*chain.rows, *chain.others]
    count = len(chain.rows)
    if count > 1 and any(parse_cut(cut).distance is None for cut in cuts):
        raise EdgeError(f"{title}: found a parameter as a cut along {count} edges, expected distances")
    words, names = [cuts[0]] * count + [cuts[1]] * count, ["A"] * count + ["B"] * count
    # It also says how far the faces reach.
    try:
        moved = moved_uses(measured, rows, words)
    except EdgeError as error:
        raise EdgeError(f"{title}: {error}") from None
    curves = _curves(graph, rows)
    bases = [
        _base(graph, chain, row, end, word, curves, options.continuities["AB".index(name)], title)
        for row, end, word, name in zip(rows, moved, words, names, strict=True)
    ]
    sides = [_joined(graph, bases[:count], chain.rows, title), _joined(graph, bases[count:], chain.others, title)]
    return sides[0], sides[1]


def _base(
    graph: EdgeGraph,
    chain: SharpChain,
    row: int,
    moved: ResolvedEdge,
    word: str,
    curves: dict[int, TrimCurve],
    continuity: Continuity,
    title: str,
) -> EdgeBase:
    """Return the base along one moved edge."""
    distance, name = parse_cut(word).distance, graph.uses.name(row)
    if distance is not None and is_flat(graph, row):
        base = flat_contact(graph, FlatEdge(row, _square(graph, chain, row)), distance, curves)
        if base is not None:
            return EdgeBase(name, base)
        if is_straight_flat(graph, row):
            largest, own = largest_distance(graph, row, curves), graph.uses.face[row]
            if largest <= _NOTHING * graph.size:
                raise EdgeError(
                    f"{title}: on face {own} the contact does not meet the next edge: the face beyond its end would "
                    "have to grow"
                )
            if largest < distance:
                raise EdgeError(
                    f"{title}: a contact {distance:g} inside face {own} misses the next edge, "
                    f"expected a distance below {largest:.4g}"
                )
    (side,) = close_bases([moved], [continuity])
    if len(side) != 1:
        raise EdgeError(f"{title}: along its contact on face {graph.uses.face[row]} no one blend runs; it has corners")
    return side[0]


def _square(graph: EdgeGraph, chain: SharpChain, row: int) -> tuple[bool, bool]:
    """Tell whether an edge goes on in another of the chain on the same face, where it begins and where it ends."""
    mine = chain.rows if row in chain.rows else chain.others
    uses = graph.uses
    return int(uses.previous[row]) in mine, int(uses.following[row]) in mine


def _joined(graph: EdgeGraph, parts: Sequence[EdgeBase], rows: Sequence[int], title: str) -> EdgeBase:
    if len(parts) == 1:
        return parts[0]
    faces = list(dict.fromkeys(int(graph.uses.face[row]) for row in rows))
    try:
        return joined(parts, "+".join(part.name for part in parts))
    except EdgeError as error:
        said = ", ".join(map(str, faces))
        raise EdgeError(
            f"{title}: its contact does not go on from one of the faces {said} to the next: where they meet, the edge "
            f"between them is not square to the rounded ones; they cannot be rounded together ({error})"
        ) from None


def _curves(graph: EdgeGraph, rows: Sequence[int]) -> dict[int, TrimCurve]:
    """Return the curves that flat contacts need, by use; the file is read once."""
    wanted = list(dict.fromkeys(use for row in rows if is_flat(graph, row) for use in curves_wanted(graph, row)))
    asked = [(int(graph.uses.face[use]), int(graph.uses.number[use])) for use in wanted]
    return dict(zip(wanted, read_trim_curves(graph.path, asked) if asked else [], strict=True))
