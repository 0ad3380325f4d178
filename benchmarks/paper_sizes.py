"""Blends of the sizes of the paper's Table 1, and the constrained problem against the paper's quasi-Newton search.

    python benchmarks/paper_sizes.py

Geometry is that of the stand-ins for the paper's figures, whose own data are not given. Contact is G2 on both sides
throughout, the harder case; times are those of `BlendResult.seconds`: all but imports and the final check.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from semispline import Base, blend
from semispline.papers.lin2014.study import pair, pair_names
from semispline.solver.io.json_files import read_problem

FIGURES = (5, 6, 8, 9, 10, 11)
EXAMPLES = Path(__file__).parents[1] / "papers" / "lin2014" / "examples"
REDUCED_LIMIT, CASADI_LIMIT = 0.020, 0.200
SPEED_UP = 20
# The whole default blend over that of least energy: in the median, and at most.
FAIR_LIMITS = (2.0, 4.0)


@dataclass(frozen=True)
class SizeTimes:
    """Best times for the sizes of one figure, in seconds."""

    figure: int
    sizes: tuple[tuple[int, int], tuple[int, int]]
    middle_curves: int
    reduced: float
    casadi: float


@dataclass(frozen=True)
class Race:
    """casadi against bfgs on one problem, 10 x 64 control points and one middle curve."""

    casadi_seconds: float
    bfgs_seconds: float
    casadi_energy: float
    bfgs_energy: float

    @property
    def ratio(self) -> float:
        """How many times faster casadi is."""
        return self.bfgs_seconds / self.casadi_seconds


def bases_of(figure: int) -> tuple[Base, Base, dict[str, Any]]:
    """Return the bases of a figure's stand-in and its options but the continuity."""
    problem = read_problem(EXAMPLES / f"figure-{figure}.json")
    a, b = Base(problem.a, problem.edge_a), Base(problem.b, problem.edge_b)
    return a, b, {"middle_curves": problem.options.middle_curves, "alpha": "energy"}


def best_seconds(a: Base, b: Base, repeats: int, **options: Any) -> float:
    """Return the least time of some runs: what else the machine does only adds."""
    return min(blend(a, b, **options).seconds for _ in range(repeats))


def size_times(figure: int) -> SizeTimes:
    """Time both methods on the sizes of one figure."""
    a, b, options = bases_of(figure)
    sizes = tuple(base.surface.control_points.shape[:2] for base in (a, b))
    times = [best_seconds(a, b, repeats, method=m, **options) for m, repeats in (("reduced", 15), ("casadi", 5))]
    return SizeTimes(figure, sizes, options["middle_curves"], *times)


def fair_ratios() -> dict[str, float]:
    """Return the time of the whole default blend over that of least energy, checks of both included, by pair."""
    pairs = {f"Fig. {figure}": bases_of(figure)[:2] for figure in FIGURES}
    pairs |= {name: (task.a, task.b) for name in pair_names() for task in [pair(name).task]}
    return {name: _least(a, b) / _least(a, b, alpha="energy") for name, (a, b) in pairs.items()}


def _least(a: Base, b: Base, **options: Any) -> float:
    """Return the least processor time of some whole calls."""
    found = []
    for _ in range(7):
        start = time.process_time()
        blend(a, b, **options)
        found.append(time.process_time() - start)
    return min(found)


def race() -> Race:
    """Let casadi and bfgs solve the problem of 10 x 64 control points with one middle curve."""
    a, b, options = bases_of(11)
    options["middle_curves"] = 1
    runs = [blend(a, b, method="casadi", **options) for _ in range(5)]
    rival = blend(a, b, method="bfgs", **options)
    return Race(min(run.seconds for run in runs), rival.seconds, runs[0].energy, rival.energy)


if __name__ == "__main__":
    for number in FIGURES:
        print(size_times(number))
    print(fair_ratios())
    print(race())
