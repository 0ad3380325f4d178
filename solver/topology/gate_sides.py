"""A shape before and after a change, as all parts of the gate look at it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.topology.gate_edges import EdgeTable
from semispline.solver.topology.gate_report import Change, Point
from semispline.solver.topology.occ_shapes import parts

# Of the size: what a tolerance may be without a reason; points that are nearer are one.
TOLERANCE = 1e-6


class NotSoundError(Exception):
    """A changed shape is not sound: why, and where."""

    def __init__(self, reason: str, place: Point | None = None) -> None:
        super().__init__(reason)
        self.reason, self.place = reason, place


@dataclass(frozen=True, eq=False)
class Both:
    """A shape before and after, with the tables of their edges, the size, and what their first faces are called."""

    before: Any
    after: Any
    change: Change
    olds: EdgeTable
    news: EdgeTable
    size: float
    first: tuple[int, int] = (0, 0)

    @cached_property
    def known(self) -> list[int | None]:
        """Which edge from before each one is."""
        return self.olds.matching(self.news, TOLERANCE * self.size)

    @cached_property
    def border_before(self) -> float:
        """The largest tolerance of the edges of what was taken out."""
        edges = [k for k, faces in enumerate(self.olds.faces) if set(faces) & set(self.change.old)]
        return max((self.olds.tolerance[k] for k in edges), default=0.0)

    @cached_property
    def was(self) -> list[float | None]:
        """The tolerance of the edge in whose place each one is: it has the same ends, and perhaps another middle."""
        own = [k for k, faces in enumerate(self.olds.faces) if set(faces) & set(self.change.old)]
        found: list[float | None] = []
        for k, known in enumerate(self.known):
            ends, number = self.news.places[k][[0, 2]], known
            if known is None:
                number = next((n for n in own if self._ends_at(self.olds.places[n][[0, 2]], ends)), None)
            found.append(None if number is None else self.olds.tolerance[number])
        return found

    def _ends_at(self, one: FloatArray, other: FloatArray) -> bool:
        away = min(float(np.linalg.norm(x - other, axis=1).max()) for x in (one, one[::-1]))
        return away <= TOLERANCE * self.size

    @cached_property
    def faces(self) -> tuple[list[Any], list[Any]]:
        """Before and after."""
        return parts(self.before, "FACE"), parts(self.after, "FACE")

    @cached_property
    def kept(self) -> dict[int, int]:
        """The number after of each face that was not taken out, by that before."""
        return self.change.kept_of(len(self.faces[0]), len(self.faces[1]))
