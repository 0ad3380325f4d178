"""Bases for a blend along edges of faces, free curves too: one for each part of an edge, and which parts meet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import MILLIMETRES, split_spec
from semispline.solver.judge import Base
from semispline.solver.options import Continuity
from semispline.solver.topology.chain_edges import ResolvedChain, members
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.face_edges import ResolvedEdge, split_part
from semispline.solver.topology.joined_bases import in_order, joined, merged_edges
from semispline.solver.topology.plane_chains import edges_on_planes, strips_on_planes
from semispline.solver.topology.plane_strips import strip_of_arc
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves

# Of the length of an edge: nearer ends are one point.
_SAME_POINT = 1e-3
# Ways to pair parts that are as good as each other but for this fraction cannot be told apart.
_TIED = 1e-6


def edge_bases(
    ends: Sequence[ResolvedEdge | ResolvedChain],
    continuity: Continuity | Sequence[Continuity] = "G2",
    share: float = 1.0,
) -> list[tuple[EdgeBase, ...]]:
    """Return the bases along each edge, in its own direction: one, or more where a free curve has to be cut.

    Of edges that run end to end one base for all of them, parts of free curves too.

    Parameters
    ----------
    ends : sequence of ResolvedEdge or ResolvedChain
    continuity : str or sequence of str
        That all, or each, is to be met with.
    share : float
        Of its limits, that a band may use. Less than all asks for bases that are as close as can be: then lines and
        arcs on planes have strips of these, exact and with few points.

    Raises
    ------
    BandError
        A band misses its limits: what was reached, where, and why.
    EdgeError
        A name that the surface does not have, or no such part; edges that do not run end to end.
    FileError, ComputationError
        As `read_trim_curves`.
    """
    # Each file is read once, for all of them.
    asked = [wanted for end in ends for wanted in _wanted_curves(end)]
    curves = iter(_curves([edge for end in ends for edge in members(end)], asked))
    orders = [continuity] * len(ends) if isinstance(continuity, str) else continuity
    return [
        _bases_of(end, [next(curves) for _ in members(end)], wanted, share)
        for end, wanted in zip(ends, orders, strict=True)
    ]


def _wanted_curves(end: ResolvedEdge | ResolvedChain) -> list[bool]:
    """Tell of which edges the curves are read: of free ones, and of those beside them on a plane."""
    if isinstance(end, ResolvedEdge):
        return [end.is_free]
    return [edge.is_free or on_plane for edge, on_plane in zip(end.edges, edges_on_planes(end), strict=True)]


def _bases_of(
    end: ResolvedEdge | ResolvedChain, curves: Sequence[TrimCurve | None], wanted: Continuity, share: float
) -> tuple[EdgeBase, ...]:
    if isinstance(end, ResolvedEdge):
        return _bases_of_edge(end, curves[0], wanted, share)
    strips = strips_on_planes(end, curves)
    runs: list[Sequence[EdgeBase]] = []
    kept: list[tuple[ResolvedEdge, str, TrimCurve | None]] = []
    for strip, edge, name, curve in zip(strips, end.edges, end.names, curves, strict=True):
        if strip is None:
            kept.append((edge, name, curve if edge.is_free else None))
            continue
        runs += _runs(kept, wanted, share)
        kept = []
        runs.append([EdgeBase(name, strip.base, strip, curve)])
    runs += _runs(kept, wanted, share)
    return (joined(in_order(runs), end.edge, end.tolerance),)


def _runs(
    edges: Sequence[tuple[ResolvedEdge, str, TrimCurve | None]], wanted: Continuity, share: float
) -> list[list[EdgeBase]]:
    """Return the bases along each of some edges that follow each other; those on one line of a surface are one."""
    if not edges:
        return []
    own = {edge: curve for edge, _, curve in edges}
    return [
        [replace(part, name=_named(part, name)) for part in _bases_of_edge(edge, own.get(edge), wanted, share)]
        for edge, name in merged_edges([edge for edge, _, _ in edges], [name for _, name, _ in edges])
    ]


def _bases_of_edge(
    end: ResolvedEdge, curve: TrimCurve | None, wanted: Continuity, share: float
) -> tuple[EdgeBase, ...]:
    if curve is None:
        unit = end.loaded.unit
        millimetres = None if unit is None else MILLIMETRES[unit]
        return (EdgeBase(end.edge, Base(end.surface, end.edge), millimetres=millimetres),)
    strip = strip_of_arc(curve) if share < 1 and end.part is None else None
    if strip is not None:
        return (EdgeBase(curve.word, strip.base, strip, curve, millimetres=curve.millimetres),)
    return bases_along(curve, wanted, end.part, share)


def _named(part: EdgeBase, name: str) -> str:
    """Return what a part of an edge of a chain is called: as the edge, and which part of it where it was cut."""
    number = None if part.band is None else split_part(part.name)[1]
    return name if number is None or name.endswith("]") else f"{name}[{number}]"


def free_curves(ends: Sequence[ResolvedEdge]) -> list[TrimCurve | None]:
    """Return the curves of those edges that are free, in the unit of their surfaces; each file is read once."""
    return _curves(ends, [end.is_free for end in ends])


def _curves(ends: Sequence[ResolvedEdge], wanted: Sequence[bool]) -> list[TrimCurve | None]:
    found: list[TrimCurve | None] = [None] * len(ends)
    paths: dict[str, list[int]] = {}
    for k, end in enumerate(ends):
        if end.curve is not None:
            found[k] = end.curve.in_unit(end.loaded.unit)
        elif wanted[k]:
            paths.setdefault(split_spec(end.spec)[0], []).append(k)
    for path, which in paths.items():
        asked = [(split_spec(ends[k].spec)[1] or 0, _number(ends[k])) for k in which]
        for k, curve in zip(which, read_trim_curves(path, asked), strict=True):
            found[k] = curve.in_unit(ends[k].loaded.unit)
    return found


def _number(edge: ResolvedEdge) -> int:
    """Return k of the name "ek" in the file."""
    return int((split_part(edge.edge)[0] if edge.entry is None else edge.entry.name)[1:])


def bases_along(
    curve: TrimCurve, continuity: Continuity = "G2", part: int | None = None, share: float = 1.0
) -> tuple[EdgeBase, ...]:
    """Return a base for each band along a free curve, or for that of one part of it; errors as `edge_bases`."""
    # What a continuity of parameters means for the face is that of the surface.
    bands = curve.bands("G1" if continuity[1] == "0" else f"G{continuity[1]}", part, share)  # type: ignore[arg-type]
    numbers: Sequence[int] = range(len(bands)) if part is None else [part]
    names = [curve.word] if part is None and len(bands) == 1 else [f"{curve.word}[{k}]" for k in numbers]
    return tuple(
        EdgeBase(name, band.base, band, curve, millimetres=curve.millimetres)
        for name, band in zip(names, bands, strict=True)
    )


def paired_bases(a: Sequence[EdgeBase], b: Sequence[EdgeBase]) -> list[tuple[EdgeBase, EdgeBase]]:
    """Return which parts of two edges are blended with each other: those that lie nearest, in the order of a's.

    Where their numbers differ the parts of each are one chain.

    Raises
    ------
    EdgeError
        There are several ways that are equally near; parts that meet in a corner, and others of another number.
    """
    if len(a) != len(b):
        if any(_has_corner(side) for side in (a, b)):
            raise EdgeError(
                f"{_counted(a)}, {_counted(b)}: parts of a free curve that meet in a corner are no one base; "
                f"{_words(a, b)}"
            )
        return [(_one(a), _one(b))]
    if len(a) == 1:
        return [(a[0], b[0])]
    ways = sorted(_ways(a, b), key=lambda way: way[0])
    if len(ways) > 1 and ways[1][0] <= (1 + _TIED) * ways[0][0]:
        raise EdgeError(f"{_counted(a)}, {_counted(b)}: which of them meet cannot be told; {_words(a, b)}")
    return [(one, b[k]) for one, k in zip(a, ways[0][1], strict=True)]


def _has_corner(side: Sequence[EdgeBase]) -> bool:
    """Tell whether parts of a free curve meet in a corner of it."""
    cuts = [word for x in side if x.band is not None for word in (x.band.cut_at_start, x.band.cut_at_end)]
    return len(side) > 1 and any("corner" in word for word in cuts)


def _one(side: Sequence[EdgeBase]) -> EdgeBase:
    """Return the parts of an edge as one base."""
    title = side[0].name if len(side) == 1 else f"{side[0].name.partition('[')[0]}"
    return joined(side, title)


def _ways(a: Sequence[EdgeBase], b: Sequence[EdgeBase]) -> Iterator[tuple[float, list[int]]]:
    """Yield the squared distances of parts, and which of b belongs to each of a: all ways that run along both."""
    count = len(a)
    places = [[_ends_and_middle(one.bases[0]) for one in side] for side in (a, b)]
    closed = all(
        np.linalg.norm(side[0][0] - side[-1][2]) <= _SAME_POINT * sum(_polygon(x) for x in side) for side in places
    )
    for shift, turned in product(range(count if closed else 1), (False, True)):
        order = [(shift + (-k if turned else k)) % count if closed else (count - 1 - k if turned else k)
                 for k in range(count)]  # fmt: skip
        apart = sum(
            min(float(np.sum((one - other) ** 2)), float(np.sum((one - other[::-1]) ** 2)))
            for one, other in zip(places[0], (places[1][k] for k in order), strict=True)
        )
        yield apart, order


def _ends_and_middle(base: Base) -> FloatArray:
    start, end = base.range_along
    return base.derivative(np.array([start, (start + end) / 2, end]), 0, 0)


def _polygon(points: FloatArray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _counted(side: Sequence[EdgeBase]) -> str:
    first = side[0]
    title = first.name if first.curve is None else first.curve.name
    if len(side) == 1:
        return f"{title} is one piece"
    cuts = dict.fromkeys(x.band.cut_at_start or x.band.cut_at_end for x in side if x.band is not None)
    return f"{title} has {len(side)} parts ({'; '.join(filter(None, cuts))})"


def _words(a: Sequence[EdgeBase], b: Sequence[EdgeBase]) -> str:
    """Say how a part is named."""
    said = []
    for option, side in (("--edge-a", a), ("--edge-b", b)):
        if len(side) > 1:
            said.append(f"{option} {side[0].name} to {side[-1].name} are its parts")
        else:
            said.append(f"a part of it is named as {option} {'u1[0,0.5]' if side[0].band is None else side[0].name}")
    return "; ".join(said)
