"""J = A * (integral of |grad H|^2 dA + jumps of H) of all blends of a problem, as a function of its shape parameters.

Control points are polynomials in the shape parameters: P = sum_k m_k Z_k. What the sections v = const take of each Z_k
is tabled once, so that a blend costs a product of its monomials with the table and one with the bases in u; its
gradient one reverse sweep. Homogeneous control points are in no way different, but for a quotient in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.facing import measure_facing
from semispline.solver.blending.fairness_grid import HIGHEST, ORDERS_U, Across, Along, derivatives_along
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.refusals import LOOP, folds, needed_turn, turned
from semispline.solver.generated.fairness_numpy import fairness, fairness_pullback
from semispline.solver.generated.quotient_numpy import quotient, quotient_pullback

# Orders of the nine derivatives by u and v, in the order of the generated program.
_ORDERS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
# A jump of H counts over this fraction of the mean length across, as a ramp of that width would; and a ramp narrower
# than the second figure, in windows, as a jump.
WINDOW = 1 / 50
_NARROW = 1 / 4
# Normals of neighbouring nodes that turn by more than 60 degrees have met a fold, or a bend too sharp to measure.
LEAST_COSINE = 0.5
# Nodes of one batch: what a sweep holds then stays in the cache.
_AT_ONCE = 2000
# What may be refused.
FOLDS, LOOPS = 1, 2


def narrow_width(problem: BlendProblem) -> float:
    """Return how wide, in v, a cluster of knots may be that counts as one line."""
    means = measure_facing(problem.a, problem.b)
    knots = problem.rows[0].knots
    return _NARROW * WINDOW * means.gap / (sum(means.lengths) / 2) * float(knots[-1] - knots[0])


@dataclass(frozen=True, eq=False)
class Measured:
    """J of some candidates, and why they are refused: 0 not at all, `FOLDS` or `LOOPS`."""

    values: FloatArray
    refused: NDArray[np.int8]


class FairnessTable:
    """Derivatives by v of each Z_k at the nodes.

    Parameters
    ----------
    problem : BlendProblem
    layers : ndarray, shape (K, N, 3 or 4)
        Z_k.
    across : Across
    along : Along
    least_cosine : float
        Between the normals of neighbouring nodes.
    refusable : tuple of int
        What is refused at all.
    """

    def __init__(
        self,
        problem: BlendProblem,
        layers: FloatArray,
        across: Across,
        along: Along,
        least_cosine: float = LEAST_COSINE,
        refusable: tuple[int, ...] = (FOLDS, LOOPS),
    ) -> None:
        self.across, self.along = across, along
        self.refusable = refusable
        self.least_cosine = least_cosine
        offsets = problem.form.offsets
        count, rows, d = len(layers), len(problem.rows), layers.shape[2]
        points = [layers[:, low:high].transpose(0, 2, 1).reshape(d * count, -1) for low, high in pairwise(offsets)]
        table = derivatives_along(points, problem.rows, along)
        self._is_rational = d == 4
        self._shape = d, rows, table.shape[-1]
        # Shape (K, 4, d, rows, columns), flat but for the first.
        table = table.reshape(HIGHEST + 1, count, d, rows, -1).swapaxes(0, 1)
        self._table = np.ascontiguousarray(table).reshape(count, -1)
        self._nodes, self._lines = along.nodes.size, along.lines.shape[1]
        # Weights of the nodes; what belongs to lines has none.
        v = np.concatenate([along.weights.T.ravel(), np.zeros(2 * self._lines)])
        self._weights = np.multiply.outer(across.weights, v)
        # These make the mean length across of speeds at the nodes.
        self._mean = self._weights / float(v.sum())
        # Where both ends leave along a given direction no candidate needs another turn.
        self._ends_given = problem.a.order > 0 and problem.b.order > 0
        self._needed: FloatArray | None = None

    @property
    def size(self) -> int:
        """Number of nodes."""
        return int(self._weights.size)

    def measure(self, monomials: FloatArray) -> Measured:
        """Return J of candidates, monomials of shape (B, K); it may be infinite where they are refused."""
        step = max(1, _AT_ONCE // self.size)
        parts = [self._measure(monomials[i : i + step]) for i in range(0, len(monomials), step)]
        return Measured(np.concatenate([p.values for p in parts]), np.concatenate([p.refused for p in parts]))

    def with_gradient(self, monomials: FloatArray, *, everywhere: bool = True) -> tuple[Measured, FloatArray]:
        """Return J of candidates and its gradients by the monomials, both of shape (B, K).

        Unless it is wanted everywhere J may be infinite, and its gradient 0, where a candidate is refused.
        """
        step = max(1, _AT_ONCE // self.size)
        parts = [self._with_gradient(monomials[i : i + step], everywhere) for i in range(0, len(monomials), step)]
        measured = [part[0] for part in parts]
        return (
            Measured(np.concatenate([p.values for p in measured]), np.concatenate([p.refused for p in measured])),
            np.concatenate([gradient for _, gradient in parts]),
        )

    def _measure(self, monomials: FloatArray) -> Measured:
        rows, planes = self._planes(monomials)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            if self._is_rational:
                planes = list(quotient(planes))
            refused = self._refused(rows, planes)
            if refused.all():
                return _unmeasured(refused)
            return Measured(self._parts(fairness(planes)).value, refused)

    def _with_gradient(self, monomials: FloatArray, everywhere: bool) -> tuple[Measured, FloatArray]:
        rows, planes = self._planes(monomials)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            if self._is_rational:
                found, through_quotient = quotient_pullback(planes)
                planes = list(found)
            refused = self._refused(rows, planes)
            if refused.all() and not everywhere:
                return _unmeasured(refused), np.zeros_like(monomials)
            outputs, pullback = fairness_pullback(planes)
            parts = self._parts(outputs)
            adjoints = pullback(self._seeds(parts))
            gradient = self._gradient(through_quotient(adjoints) if self._is_rational else adjoints)
        return Measured(parts.value, refused), gradient

    def _planes(self, monomials: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        """Return derivatives by v of the rows, and those of the surface, the homogeneous surface itself first.

        Returns
        -------
        ndarray, shape (4, d, rows, B, columns)
        list of ndarray, each of shape (nodes in u * B * columns,)
            Contiguous: this halves the time.
        """
        d = self._shape[0]
        rows = (monomials @ self._table).reshape(len(monomials), HIGHEST + 1, *self._shape)
        rows = np.ascontiguousarray(rows.transpose(1, 2, 3, 0, 4))
        grids = []
        for bases, orders, row in zip(self.across.bases, ORDERS_U, rows, strict=True):
            columns = row.reshape(d, self._shape[1], -1)
            grids.append((bases @ columns).reshape(d, len(orders), -1))
        planes = [grids[j][c, ORDERS_U[j].index(i)] for i, j in _ORDERS for c in range(d)]
        if self._is_rational:
            planes = [*(self.across.values @ rows[0].reshape(d, self._shape[1], -1)).reshape(d, -1), *planes]
        return rows, planes

    def _parts(self, outputs: FloatArray) -> _Parts:
        rough, element, mean, speed = outputs.reshape(len(outputs), len(self.across.weights), -1, self._shape[-1])
        gh, area = (np.einsum("ubv,uv->b", x, self._weights) for x in (rough, element))
        window = WINDOW * np.einsum("ubv,uv->b", speed, self._mean)
        jumps, jump, below = np.zeros(len(gh)), None, None
        if self._lines:
            last = mean[..., self._nodes :]
            jump = last[..., self._lines :] - last[..., : self._lines]
            below = speed[..., self._nodes : self._nodes + self._lines]
            jumps = np.einsum("u,ubl->b", self.across.weights, jump**2 * below)
        return _Parts(area * (gh + jumps / window), gh, area, window, jumps, jump, below)

    def _seeds(self, parts: _Parts) -> FloatArray:
        """J = A (GH + S / h): A, GH and h are sums over the nodes, S over the lines."""
        by_area = parts.gh + parts.jumps / parts.window
        seeds = np.zeros((4, len(self.across.weights), len(parts.gh), self._shape[-1]))
        seeds[0] = parts.area[:, None] * self._weights[:, None]
        seeds[1] = by_area[:, None] * self._weights[:, None]
        if parts.jump is not None and parts.below is not None:
            by_window = -parts.area * parts.jumps / parts.window**2 * WINDOW
            seeds[3] = by_window[:, None] * self._mean[:, None]
            weights = (np.multiply.outer(self.across.weights, parts.area / parts.window))[..., None]
            below, above = (
                slice(self._nodes, self._nodes + self._lines),
                slice(self._nodes + self._lines, None),
            )
            seeds[2][..., above] = 2 * parts.jump * parts.below * weights
            seeds[2][..., below] = -seeds[2][..., above]
            seeds[3][..., below] += parts.jump**2 * weights
        return seeds.reshape(4, -1)

    def _gradient(self, adjoints: FloatArray) -> FloatArray:
        d = self._shape[0]
        adjoints = adjoints.reshape(-1, d, len(self.across.weights), adjoints.shape[-1] // len(self.across.weights))
        of_values, adjoints = adjoints[: -len(_ORDERS)], adjoints[-len(_ORDERS) :]
        rows = np.empty((HIGHEST + 1, d, self._shape[1], adjoints.shape[-1]))
        for j, (bases, orders) in enumerate(zip(self.across.bases, ORDERS_U, strict=True)):
            chosen = adjoints[[_ORDERS.index((i, j)) for i in orders]].swapaxes(0, 1)
            rows[j] = bases.T @ chosen.reshape(d, -1, chosen.shape[-1])
        for values in of_values:
            rows[0] += self.across.values.T @ values
        by_candidate = rows.reshape(*rows.shape[:3], -1, self._shape[-1]).transpose(3, 0, 1, 2, 4)
        return np.asarray(by_candidate.reshape(len(by_candidate), -1) @ self._table.T)

    def _refused(self, rows: FloatArray, planes: list[FloatArray]) -> NDArray[np.int8]:
        if not self.refusable:
            return np.zeros(rows.shape[3], dtype=np.int8)
        # Without the columns of the lines, and candidates first.
        shape = 3, len(self.across.weights), -1, self._shape[-1]
        ax, ay, az, bx, by, bz = planes[:6]
        normal = np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
        normal = normal.reshape(shape)[..., : self._nodes].swapaxes(1, 2)
        along = rows[0, ..., : self._nodes].transpose(0, 2, 1, 3)
        ends, borders = self.across.ends @ along, along[..., [0, -1], :]
        if self._is_rational:
            borders, weights = borders[:3] / borders[3], borders[3]
            ends = (ends[:3] - ends[3] * borders) / weights
        inside = np.stack(planes[:3]).reshape(shape)[..., : self._nodes].swapaxes(1, 2)
        turns = turned(np.concatenate([ends[..., :1, :], inside, ends[..., 1:, :]], axis=-2))
        needed = self._needed
        if needed is None:
            needed = needed_turn(ends[..., 0, :], ends[..., 1, :], borders[..., 1, :] - borders[..., 0, :])
            if self._ends_given:
                self._needed = needed = needed[:1]
        loops = np.any(turns - needed > LOOP, axis=-1)
        found = np.where(loops, LOOPS, 0)
        if FOLDS in self.refusable:
            found = np.where(folds(normal, self.least_cosine), FOLDS, found)
        return found.astype(np.int8)


def _unmeasured(refused: NDArray[np.int8]) -> Measured:
    """Return that all are refused: to measure them all the same would take most of the time."""
    return Measured(np.full(len(refused), np.inf), refused)


@dataclass(frozen=True, eq=False)
class _Parts:
    """What J of some candidates is made of; jump of H and speed below each line, where there are lines."""

    value: FloatArray
    gh: FloatArray
    area: FloatArray
    window: FloatArray
    jumps: FloatArray
    jump: FloatArray | None
    below: FloatArray | None
