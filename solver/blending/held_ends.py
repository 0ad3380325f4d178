"""Free rows whose ends are held in planes: where the end curves of a blend have to lie on planar faces.

The rows that contacts prescribe end there by themselves; each free row has one linear condition at each such end,
normal . P = normal . corner. Of least energy are the rows found without it, moved by what the conditions cost least.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.end_faces import HeldEnd
from semispline.solver.blending.free_system import FreeSystem
from semispline.solver.blending.rational_energy import RationalSystem

# What is left of a condition is rounding after so many corrections.
_CORRECTIONS = 2


class HeldSystem:
    """The free rows of a blend with some of their ends held.

    Attributes
    ----------
    size : int
        Number of free control points.
    """

    def __init__(self, system: FreeSystem | RationalSystem, offsets: list[int], rows: range, ends: Sequence[HeldEnd]):
        self.system, self.size = system, system.size
        self.free = slice(offsets[rows.start], offsets[rows.stop])
        self.places = [offsets[row] if end.end == 0 else offsets[row + 1] - 1 for row in rows for end in ends]
        self.corners = [0 if end.end == 0 else offsets[1] - 1 for _ in rows for end in ends]
        self.normals = np.array([end.normal for _ in rows for end in ends])
        unit = np.zeros((self.size, len(self.places)))
        unit[np.array(self.places) - self.free.start, np.arange(len(self.places))] = 1.0
        self.answers = system.response(unit)
        own = self.answers[np.array(self.places) - self.free.start]
        self.stiffness = own * (self.normals @ self.normals.T)

    def completed(self, points: FloatArray) -> FloatArray:
        """Fill the free rows of p, shape (N, 3 K or 4 K), so that the energy is least."""
        filled = self.system.completed(points).copy()
        width = 4 if isinstance(self.system, RationalSystem) else 3
        for _ in range(_CORRECTIONS):
            for first in range(0, filled.shape[1], width):
                layer = filled[:, first : first + width]
                forces = np.linalg.solve(self.stiffness, self._off(layer, filled[:, :width]))
                layer[self.free, :3] -= self.answers @ (forces[:, None] * self.normals)
        return filled

    def _off(self, layer: FloatArray, whole: FloatArray) -> FloatArray:
        """Return by how much each condition is missed; `whole` is the layer that has the weights, and the corners."""
        found = np.einsum("kd,kd->k", layer[self.places, :3], self.normals)
        if layer.shape[1] == 3:
            return np.asarray(found - np.einsum("kd,kd->k", layer[self.corners], self.normals))
        corners = whole[self.corners, :3] / whole[self.corners, 3:]
        return np.asarray(found - layer[self.places, 3] * np.einsum("kd,kd->k", corners, self.normals))

    def excess(self, points: FloatArray) -> float | None:
        """Bound how much more energy p has than the least for its prescribed rows and held ends, as a fraction."""
        if self.size == 0:
            return None
        gradient, energy = self.system.gradient_of(points)
        step = self.system.response(gradient)
        own = np.einsum("kd,kd->k", step[np.array(self.places) - self.free.start], self.normals)
        step = step - self.answers @ (np.linalg.solve(self.stiffness, own)[:, None] * self.normals)
        return abs(float(np.sum(step * gradient))) / max(energy, float(np.finfo(float).tiny))
