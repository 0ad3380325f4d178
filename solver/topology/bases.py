"""Bases for a blend along edges of faces, free curves too: one for each part of an edge, and which parts meet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import EdgeError
from semispline.solver.io import split_spec
from semispline.solver.judge import Base
from semispline.solver.options import Continuity
from semispline.solver.topology.bands import Band
from semispline.solver.topology.face_edges import ResolvedEdge, split_part
from semispline.solver.topology.trim_curves import TrimCurve, read_trim_curves

# Of the length of an edge: nearer ends are one point.
_SAME_POINT = 1e-3
# Ways to pair parts that are as good as each other but for this fraction cannot be told apart.
_TIED = 1e-6


@dataclass(frozen=True, eq=False)
class EdgeBase:
    """A base of a blend along an edge of a face, or along a part of it.

    Attributes
    ----------
    name : str
        As edges are named: "u1", "e3"; "e3[0]" where the edge was cut.
    base : Base
        What is blended: the surface of the face, or a band along a free curve.
    band : Band or None
    curve : TrimCurve or None
        The free curve, with the surface of its face.
    """

    name: str
    base: Base
    band: Band | None = None
    curve: TrimCurve | None = None


def edge_bases(
    ends: Sequence[ResolvedEdge], continuity: Continuity | Sequence[Continuity] = "G2", share: float = 1.0
) -> list[tuple[EdgeBase, ...]]:
    """Return the bases along each edge, in its own direction: one, or more where a free curve has to be cut.

    Parameters
    ----------
    ends : sequence of ResolvedEdge
    continuity : str or sequence of str
        That all, or each, is to be met with.
    share : float
        Of its limits, that a band may use.

    Raises
    ------
    BandError
        A band misses its limits: what was reached, where, and why.
    EdgeError
        A name that the surface does not have, or no such part.
    FileError, ComputationError
        As `read_trim_curves`.
    """
    curves = free_curves(ends)
    orders = [continuity] * len(ends) if isinstance(continuity, str) else continuity
    return [
        bases_along(curve, wanted, end.part, share) if curve else (EdgeBase(end.edge, Base(end.surface, end.edge)),)
        for end, curve, wanted in zip(ends, curves, orders, strict=True)
    ]


def free_curves(ends: Sequence[ResolvedEdge]) -> list[TrimCurve | None]:
    """Return the curves of those edges that are free, in the unit of their surfaces; each file is read once."""
    found: list[TrimCurve | None] = [None] * len(ends)
    paths: dict[str, list[int]] = {}
    for k, end in enumerate(ends):
        if end.curve is not None:
            found[k] = end.curve.in_unit(end.loaded.unit)
        elif end.is_free:
            paths.setdefault(split_spec(end.spec)[0], []).append(k)
    for path, which in paths.items():
        asked = [(split_spec(ends[k].spec)[1] or 0, int(split_part(ends[k].edge)[0][1:])) for k in which]
        for k, curve in zip(which, read_trim_curves(path, asked), strict=True):
            found[k] = curve.in_unit(ends[k].loaded.unit)
    return found


def bases_along(
    curve: TrimCurve, continuity: Continuity = "G2", part: int | None = None, share: float = 1.0
) -> tuple[EdgeBase, ...]:
    """Return a base for each band along a free curve, or for that of one part of it; errors as `edge_bases`."""
    # What a continuity of parameters means for the face is that of the surface.
    bands = curve.bands("G1" if continuity[1] == "0" else f"G{continuity[1]}", part, share)  # type: ignore[arg-type]
    numbers: Sequence[int] = range(len(bands)) if part is None else [part]
    names = [curve.word] if part is None and len(bands) == 1 else [f"{curve.word}[{k}]" for k in numbers]
    return tuple(EdgeBase(name, band.base, band, curve) for name, band in zip(names, bands, strict=True))


def paired_bases(a: Sequence[EdgeBase], b: Sequence[EdgeBase]) -> list[tuple[EdgeBase, EdgeBase]]:
    """Return which parts of two edges are blended with each other: those that lie nearest, in the order of a's.

    Raises
    ------
    EdgeError
        Their numbers differ, or there are several ways that are equally near.
    """
    if len(a) != len(b):
        raise EdgeError(
            f"{_counted(a)}, {_counted(b)}: one blend joins a part of A with a part of B until chains exist; "
            f"{_words(a, b)}"
        )
    if len(a) == 1:
        return [(a[0], b[0])]
    ways = sorted(_ways(a, b), key=lambda way: way[0])
    if len(ways) > 1 and ways[1][0] <= (1 + _TIED) * ways[0][0]:
        raise EdgeError(f"{_counted(a)}, {_counted(b)}: which of them meet cannot be told; {_words(a, b)}")
    return [(one, b[k]) for one, k in zip(a, ways[0][1], strict=True)]


def _ways(a: Sequence[EdgeBase], b: Sequence[EdgeBase]) -> Iterator[tuple[float, list[int]]]:
    """Yield the squared distances of parts, and which of b belongs to each of a: all ways that run along both."""
    count = len(a)
    places = [[_ends_and_middle(one.base) for one in side] for side in (a, b)]
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
