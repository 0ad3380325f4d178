"""Gaps: naked edges that face each other across a hole, or from one sheet to another.

A hole is walked round from face to face, so that a rim in two halves is one side; only sides of one hole that do not
touch are pairs, and sides of different holes that are near.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod

import numpy as np
from scipy.spatial import cKDTree

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import NONE, EdgeGraph, Flags, Integers, Uses
from semispline.solver.topology.relations import Relations, by_arc_length
from semispline.solver.topology.sides import CORNER, Side, cut_ring, entering, leaving, turn_between

# Places on a side, by arc length.
_PLACES = 17
# A gap, in lengths of its sides: at most so wide within a hole and from hole to hole, and at least so wide.
_WIDE, _WIDE_ACROSS, _NARROW = 8.0, 3.0, 1e-4
_LENGTH_RATIO = 3.0
# Cosine between the way out of a face and the way over the gap, at the least.
_FACING = -0.1
_OF_EACH_SIDE = 3
# Pairs looked at together.
_BLOCK = 20_000


@dataclass(frozen=True, eq=False)
class Gap:
    """Two sides that face each other.

    Attributes
    ----------
    a, b : Side
        Runs of naked uses, perhaps of several faces, in the order in which the hole is walked round.
    width : float
        Median distance over the gap.
    even : float
        Quantile 0.1 of the distance divided by its quantile 0.9.
    facing_a, facing_b : float
        Mean cosine between the way out of the face and the way over.
    same_hole : bool
    on_ends : int
        How many of the sides are ends of fillets.
    """

    a: Side
    b: Side
    width: float
    even: float
    facing_a: float
    facing_b: float
    same_hole: bool
    on_ends: int

    @property
    def length(self) -> float:
        """Mean of both sides."""
        return (self.a.length + self.b.length) / 2

    @property
    def ratio(self) -> float:
        """The shorter side divided by the longer one."""
        return min(self.a.length, self.b.length) / max(self.a.length, self.b.length)


def holes(graph: EdgeGraph, relations: Relations) -> list[list[int]]:
    """Return the naked uses round each hole or free border, in order; a border that does not close is left out."""
    uses = graph.uses
    left = np.flatnonzero(relations.naked & ~uses.degenerate).tolist()
    seen: set[int] = set()
    loops = []
    for start in left:
        if start in seen:
            continue
        loop, use = [start], start
        while True:
            found = _next_naked(uses, relations, use)
            if found is None or found in seen or (found in loop and found != start):
                loop = []
                break
            if found == start:
                break
            loop.append(found)
            use = found
        seen.update(loop or [start])
        if loop:
            loops.append(loop)
    return loops


def find_gaps(graph: EdgeGraph, relations: Relations, fillet_ends: Flags) -> list[Gap]:
    """Return pairs of sides that face each other; `fillet_ends` tells which uses lie across ends of fillets."""
    uses = graph.uses
    sides, owner = [], []
    for number, loop in enumerate(holes(graph, relations)):
        of_hole = _sides(uses, relations.length, loop)
        sides += of_hole
        owner += [number] * len(of_hole)
    if len(sides) < 2:
        return []
    lines = [_line(uses, side) for side in sides]
    places = _Sides(
        hole=np.array(owner),
        closed=np.array([side.closed for side in sides]),
        length=np.array([side.length for side in sides]),
        points=np.array([line[0] for line in lines]),
        out=np.array([line[1] for line in lines]),
    )
    on_end = [bool(fillet_ends[list(side.uses)].all()) for side in sides]
    found = []
    for i, j in _blocks(*_pairs(places)):
        kept, figures = _measured(places, i, j)
        for a, b, figure in zip(i[kept].tolist(), j[kept].tolist(), figures.tolist(), strict=True):
            width, even, facing_a, facing_b = figure
            same, ends = owner[a] == owner[b], on_end[a] + on_end[b]
            found.append(Gap(sides[a], sides[b], width, even, facing_a, facing_b, same, ends))
    return _best_of_each_side(found)


def gap_parts(gap: Gap) -> dict[str, float]:
    """Return the factors of the score of a gap."""
    return {
        "facing": (0.3 + gap.facing_a) * (0.3 + gap.facing_b) / 1.69,
        "even": 0.4 + 0.6 * gap.even,
        "lengths": float(np.sqrt(gap.ratio)),
        "near": 1 / (1 + gap.width / gap.length),
        "on_end": 0.25**gap.on_ends,
        "hole": 1.0 if gap.same_hole else 0.8,
    }


def _best_of_each_side(gaps: list[Gap]) -> list[Gap]:
    """Keep of each side the gaps with the best scores: along unsewn sheets everything faces everything."""
    taken: Counter[int] = Counter()
    kept = []
    for gap in sorted(gaps, key=lambda gap: -round(prod(gap_parts(gap).values()), 6)):
        ends = gap.a.uses[0], gap.b.uses[0]
        if max(taken[end] for end in ends) < _OF_EACH_SIDE:
            taken.update(ends)
            kept.append(gap)
    return kept


def _next_naked(uses: Uses, relations: Relations, use: int) -> int | None:
    """Return the naked use that ends where this one begins, found round the vertex."""
    p = int(uses.previous[use])
    # A face has a finite number of edges in a vertex; a broken file may lead round for ever.
    for _ in range(len(uses)):
        if relations.naked[p]:
            return p
        if not uses.degenerate[p]:
            p = int(relations.partner[p] if relations.partner[p] != NONE else uses.twin[p])
            if p == NONE:
                return None
        p = int(uses.previous[p])
    return None


def _sides(uses: Uses, length: FloatArray, loop: list[int]) -> list[Side]:
    """Cut a loop into sides at corners; the loop runs against the faces."""

    def is_cut(one: int, two: int) -> bool:
        return turn_between(entering(uses, one)[1], leaving(uses, two)[1]) > CORNER

    runs, closed = cut_ring(loop, is_cut)
    return [Side(tuple(run), closed, float(length[run].sum())) for run in runs]


@dataclass(frozen=True, eq=False)
class _Sides:
    """Sides of all holes, hole by hole, with places on them by arc length and the ways out of their faces."""

    hole: Integers
    closed: Flags
    length: FloatArray
    points: FloatArray
    out: FloatArray


def _line(uses: Uses, side: Side) -> tuple[FloatArray, FloatArray]:
    """Sample a side by arc length against the direction in which its faces walk."""
    points, inward = (
        np.concatenate([x[use] if uses.reversed[use] else x[use, ::-1] for use in side.uses])
        for x in (uses.points, uses.inward)
    )
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.r_[0.0, np.cumsum(step)]
    at = np.linspace(0.0, along[-1], _PLACES)
    out = np.stack([np.interp(at, along, x) for x in -inward.T], axis=1)
    size = np.linalg.norm(out, axis=1, keepdims=True)
    return by_arc_length(points, _PLACES), out / np.where(size > 0, size, 1.0)


def _pairs(sides: _Sides) -> tuple[Integers, Integers]:
    """Return numbers of sides that may belong together."""
    found = [np.zeros((2, 0), dtype=np.int64)]
    starts = np.flatnonzero(np.r_[True, np.diff(sides.hole) != 0])
    for first, count in zip(starts.tolist(), np.diff(np.r_[starts, len(sides.hole)]).tolist(), strict=True):
        if count == 3:
            found.append(first + np.sort(np.argsort(-sides.length[first : first + 3], kind="stable")[:2])[:, None])
        elif count > 3:
            # Those that do not touch: the last touches the first.
            ring = np.array(np.triu_indices(count, 2))
            found.append(first + ring[:, ring[1] - ring[0] != count - 1])
    middle = np.where(sides.closed[:, None], sides.points[:, :-1].mean(axis=1), sides.points[:, _PLACES // 2])
    near = cKDTree(middle).query_ball_point(middle, _WIDE_ACROSS * sides.length)
    across = {(min(i, j), max(i, j)) for i, others in enumerate(near) for j in others}
    found.append(np.array(sorted(across), dtype=np.int64).reshape(-1, 2).T)
    i, j = np.concatenate(found, axis=1)
    same = sides.hole[i] == sides.hole[j]
    # What the tree found within one hole has been asked for before, or touches.
    asked = np.arange(len(i)) < len(i) - len(across)
    length, other = sides.length[i], sides.length[j]
    alike = np.maximum(length, other) < _LENGTH_RATIO * np.minimum(length, other)
    kept = (asked | ~same) & alike & (sides.closed[i] == sides.closed[j])
    return i[kept], j[kept]


def _blocks(i: Integers, j: Integers) -> Iterator[tuple[Integers, Integers]]:
    for first in range(0, len(i), _BLOCK):
        yield i[first : first + _BLOCK], j[first : first + _BLOCK]


def _measured(sides: _Sides, i: Integers, j: Integers) -> tuple[Flags, FloatArray]:
    """Return which pairs face each other, and of these width, evenness and both cosines, shape (K, 4)."""
    same, closed = sides.hole[i] == sides.hole[j], sides.closed[i]
    p, q, out = sides.points[i], sides.points[j], sides.out[j]
    # Open sides of one hole run against each other; sheets need not agree on what is outside.
    way = np.tile(np.arange(_PLACES)[::-1], (len(i), 1))
    along = (np.linalg.norm(p - q, axis=2) < np.linalg.norm(p - q[:, ::-1], axis=2)).mean(axis=1) > 0.5
    way[~same & ~closed & along] = np.arange(_PLACES)
    for row in np.flatnonzero(closed):
        way[row] = np.argmin(np.linalg.norm(p[row][:, None] - q[row], axis=2), axis=1)
    q, out = (np.take_along_axis(x, way[..., None], axis=1) for x in (q, out))
    chord = q - p
    away = np.linalg.norm(chord, axis=2)
    unit = chord / np.where(away > 0, away, 1.0)[..., None]
    facing = [np.sum(side * unit, axis=2).mean(axis=1) for side in (sides.out[i], -out)]
    low, width, high = np.quantile(away, (0.1, 0.5, 0.9), axis=1)
    mean = (sides.length[i] + sides.length[j]) / 2
    kept = (width > _NARROW * mean) & (width <= np.where(same, _WIDE, _WIDE_ACROSS) * mean)
    kept &= np.minimum(*facing) > _FACING
    even = low / np.where(high > 0, high, 1.0)
    return kept, np.stack([width, even, *facing], axis=1)[kept]
