"""Edges that run end to end as one base: a chain; edges on one line of a surface are one edge of it first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending import chain
from semispline.solver.errors import EdgeError
from semispline.solver.splines import EdgeName, parse_edge
from semispline.solver.topology.edge_base import EdgeBase
from semispline.solver.topology.face_edges import ResolvedEdge

# Of the range of a parameter: parts that are apart by less meet.
_MEET = 1e-9


def joined(parts: Sequence[EdgeBase], name: str, tolerance: float | None = None) -> EdgeBase:
    """Return one base for parts that run end to end, in the order in which they follow each other.

    Parameters
    ----------
    parts : sequence of EdgeBase
    name : str
    tolerance : float, optional
        How far apart, in model units, ends may lie that are to be one point.

    Raises
    ------
    EdgeError
        They do not run end to end.
    """
    if len(parts) == 1:
        return replace(parts[0], name=name)
    # A band is off its curve by what its limits allow.
    off = [2 * part.band.limits.off for part in parts if part.band is not None]
    within = max([*off, tolerance or 0.0]) or None
    bases = [base for part in parts for base in part.bases]
    try:
        made = chain(bases, tolerance=within, names=[part.name for part in parts])
    except EdgeError as error:
        raise EdgeError(f"{name}: {error}") from None
    return EdgeBase(name, made, members=tuple(parts))


def in_order(runs: Sequence[Sequence[EdgeBase]]) -> list[EdgeBase]:
    """Return the parts of edges that follow each other, those of each edge in the order in which they do, too."""
    if len(runs) == 1:
        return list(runs[0])
    ends = [_outer_ends(run) for run in runs]
    found: list[EdgeBase] = []
    for k, run in enumerate(runs):
        beside = ends[k - 1] if k else ends[1]
        start, end = (float(np.linalg.norm(beside - x, axis=1).min()) for x in ends[k])
        # The first edge ends where the second begins; each other one begins where the one before it ends.
        found += run[::-1] if (start < end) == (k == 0) else run
    return found


def _outer_ends(run: Sequence[EdgeBase]) -> FloatArray:
    """Return where the first part of a run begins and its last one ends, shape (2, 3)."""
    first, last = run[0].bases[0], run[-1].bases[-1]
    at = [(first, first.range_along[0]), (last, last.range_along[1])]
    return np.array([base.derivative(np.array([x]), 0, 0)[0] for base, x in at])


def merged_edges(edges: Sequence[ResolvedEdge], names: Sequence[str]) -> list[tuple[ResolvedEdge, str]]:
    """Return edges of a chain and their names, with those as one that lie end to end on one line of one face."""
    found = [(edges[0], names[0])]
    for edge, name in zip(edges[1:], names[1:], strict=True):
        one = _on_one_line(found[-1][0], edge)
        if one is None:
            found.append((edge, name))
        else:
            found[-1] = (one, f"{found[-1][1]}+{name}")
    return found


def _on_one_line(first: ResolvedEdge, second: ResolvedEdge) -> ResolvedEdge | None:
    """Return two edges as one; None where they are not parts of one line that follow each other."""
    if first.is_free or second.is_free or first.spec != second.spec:
        return None
    one, two = parse_edge(first.edge), parse_edge(second.edge)
    if one.part is None or two.part is None or replace(one, part=None) != replace(two, part=None):
        return None
    low, high = first.surface.domain["uv".index(one.along)]
    within = _MEET * (high - low)
    for before, after in ((one.part, two.part), (two.part, one.part)):
        for period in (0.0, high - low):
            if abs(before[1] - (after[0] + period)) <= within:
                part = (before[0], after[1] + period)
                whole = abs(part[1] - part[0] - (high - low)) <= within
                name = EdgeName(one.direction, one.end, one.at, None if whole else part)
                return replace(first, edge=str(name))
    return None
