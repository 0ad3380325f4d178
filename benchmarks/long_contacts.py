"""C2 blends on long contact curves: how time and memory grow, and up to what size an answer can be trusted.

    python benchmarks/long_contacts.py

Both bases have the same number of control points along the contact and knots of their own. The check of a finished
blend by the referee is measured beside the solve: it samples every span of both bases and of the blend.
"""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from semispline import Base, BSplineSurface, ComputationError, blend
from semispline.solver.blending.pipeline import state_problem
from semispline.solver.splines.knots import clamped, greville, uniform_knots

SIZES = (1_000, 3_162, 10_000, 31_623, 100_000)
EXPONENT_LIMIT, SECONDS_LIMIT = 1.1, 3.0
FIXED_SIZES = tuple(1_000 * 2**k for k in range(8))


@dataclass(frozen=True)
class Run:
    """One solve and the check of its blend.

    Attributes
    ----------
    n : int
        Control points of each contact curve.
    seconds, check_seconds : float
        Of the solve, and of all that `blend` does after it.
    bytes, checked_bytes : int
        The peak of what Python and NumPy allocate in the solve, and in solve and check together.
    """

    n: int
    seconds: float
    bytes: int
    check_seconds: float
    checked_bytes: int

    @property
    def check_ratio(self) -> float:
        """How many times longer the check takes than the solve."""
        return self.check_seconds / self.seconds


def base(n: int, length: float, side: int) -> Base:
    """Return a bicubic strip of 4 x n control points, its spans along v between 0.5 and 1.5 of their mean."""
    spans = np.random.default_rng(side).uniform(0.5, 1.5, n - 3)
    inner = np.cumsum(spans)[:-1] / spans.sum() * length
    knots_u, knots_v = uniform_knots(3, 1), clamped(inner, 3, 0, length)
    x, y = np.meshgrid(greville(knots_u, 3), greville(knots_v, 3), indexing="ij")
    x = x if side == 0 else -1 - x
    z = (0.2 + 0.2 * side) * np.sin(2 * np.pi * y / max(length / 100, 1) + x)
    return Base(BSplineSurface(3, 3, knots_u, knots_v, np.stack([x, y, z], axis=2)), "u0")


def solve(a: Base, b: Base) -> float:
    """Go through the stages of a C2 blend, from the bases to control points and their energy."""
    problem = state_problem(a, b, continuity="C2", alpha="energy").problem
    points = problem.control_points(*problem.start)
    return float(problem.form.products(points[None])[0, 0])


def seconds_of(work: Callable[[], object]) -> float:
    """Return the time that some work takes."""
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


def peak_of(work: Callable[[], object]) -> int:
    """Return the peak of what some work allocates; it takes longer meanwhile."""
    tracemalloc.start()
    work()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def check_seconds(a: Base, b: Base) -> float:
    """Return the time of the check: `BlendResult.seconds` is that of everything before it."""
    started = time.perf_counter()
    result = blend(a, b, continuity="C2", alpha="energy")
    return time.perf_counter() - started - result.seconds


def run(n: int, length: float, repeats: int = 3) -> Run:
    """Solve and check one pair: the least time of some runs, then memory in runs that are not timed."""
    bases = [base(n, length, side) for side in (0, 1)]
    return Run(
        n,
        min(seconds_of(lambda: solve(*bases)) for _ in range(repeats)),
        peak_of(lambda: solve(*bases)),
        min(check_seconds(*bases) for _ in range(repeats)),
        peak_of(lambda: blend(*bases, continuity="C2", alpha="energy")),
    )


def growth() -> list[Run]:
    """Return a run for each size, mean span 1."""
    run(10, 7.0)  # what is loaded late
    return [run(n, n - 3.0) for n in SIZES]


def exponent(sizes: list[int], values: list[float]) -> float:
    """Return the slope of the straight line through the logarithms, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])


def trusted_sizes() -> tuple[int, int | None, str]:
    """Return, on a fixed domain, the largest size that was solved, the first that was refused, and the refusal."""
    largest = 0
    for n in FIXED_SIZES:
        try:
            solve(*(base(n, 1.0, side) for side in (0, 1)))
        except ComputationError as error:
            return largest, n, str(error)
        largest = n
    return largest, None, ""


if __name__ == "__main__":
    for one in growth():
        print(one)
    print(*trusted_sizes())
