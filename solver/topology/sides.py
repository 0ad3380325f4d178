"""Sides of a face: runs of its edges that turn no corner. A rim in two halves is one side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.half_edges import EdgeGraph, Uses
from semispline.solver.topology.relations import Relations

# A corner turns by more than this, in degrees. With 50 mitred ends are lost, with 20 nothing changes.
CORNER = 35.0
# Ends of a run between the two sides of a seam that are this near, in fractions of its length, close it.
_CLOSED = 1e-3


@dataclass(frozen=True)
class Side:
    """A run of uses, in walking order.

    Attributes
    ----------
    uses : tuple of int
    closed : bool
        It ends where it begins, without a corner.
    length : float
    """

    uses: tuple[int, ...]
    closed: bool
    length: float


def stacked(values: FloatArray, uses: Uses, side: Sequence[int]) -> FloatArray:
    """Return samples along a side in walking order, shape (K N, ...); corners between its edges come twice."""
    return np.concatenate([values[use, ::-1] if uses.reversed[use] else values[use] for use in side])


def sides_of(graph: EdgeGraph, relations: Relations, face: int) -> list[Side]:
    """Return the sides of a face, wire by wire; seams and points are in none."""
    uses = graph.uses
    rows = range(*uses.of_face(face).indices(len(uses)))
    sides: list[Side] = []
    for wire in dict.fromkeys(uses.wire[row] for row in rows):
        ring = [row for row in rows if uses.wire[row] == wire]
        sides += _cut(ring, uses, relations.length)
    return sides


def _cut(ring: list[int], uses: Uses, length: FloatArray) -> list[Side]:
    def usable(use: int) -> bool:
        return not (uses.seam[use] or uses.degenerate[use] or uses.pcurve[use] == "none")

    def is_cut(one: int, two: int) -> bool:
        if not (usable(one) and usable(two)):
            return True
        return turn_between(leaving(uses, one)[1], entering(uses, two)[1]) > CORNER

    runs, is_ring = cut_ring(ring, is_cut)
    sides = []
    for run in runs:
        if not all(map(usable, run)):
            continue
        closed = is_ring
        total = float(length[run].sum())
        between_seams = uses.seam[uses.previous[run[0]]] and uses.seam[uses.following[run[-1]]]
        if not closed and between_seams:
            first, last = leaving(uses, run[-1])[0], entering(uses, run[0])[0]
            closed = bool(np.linalg.norm(first - last) <= _CLOSED * total)
        sides.append(Side(tuple(run), closed, total))
    return sides


def cut_ring(ring: Sequence[int], is_cut: Callable[[int, int], bool]) -> tuple[list[list[int]], bool]:
    """Return the runs between cuts of a ring, and whether there was none."""
    cuts = [i for i in range(len(ring)) if is_cut(ring[i - 1], ring[i])]
    if not cuts:
        return [list(ring)], True
    turned = [*ring[cuts[0] :], *ring[: cuts[0]]]
    starts = [cut - cuts[0] for cut in cuts]
    return [turned[a:b] for a, b in zip(starts, [*starts[1:], len(ring)], strict=True)], False


def leaving(uses: Uses, use: int) -> tuple[FloatArray, FloatArray]:
    """Return where a use ends in walking order, and in which direction."""
    at = 0 if uses.reversed[use] else -1
    return uses.points[use, at], uses.tangent[use, at]


def entering(uses: Uses, use: int) -> tuple[FloatArray, FloatArray]:
    """Return where a use begins in walking order, and in which direction."""
    at = -1 if uses.reversed[use] else 0
    return uses.points[use, at], uses.tangent[use, at]


def turn_between(one: FloatArray, two: FloatArray) -> float:
    """Return the angle between two unit vectors, in degrees."""
    return float(np.degrees(2 * np.arctan2(np.linalg.norm(one - two), np.linalg.norm(one + two))))
