"""Degrees in u and numbers of middle curves, alpha by fairness: which rows make the fairest blend."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, TypeAlias

from semispline import SemisplineError, blend, measure_fairness
from semispline.papers.reproduction.families.problems import Family
from semispline.papers.reproduction.families.suite import SIZES, shape_problem

CANDIDATES = {
    f"degree {degree}, {'one middle curve' if middle else 'none'}": {
        "alpha": "fair",
        "degree_u": degree,
        "middle_curves": middle,
        "v_scale": "length",
    }
    for degree in (3, 4, 5)
    for middle in (0, 1)
}
# So many of each family, evenly spread over its seeds.
SAMPLE: dict[Family, int] = {"facing": 60, "u-turn": 20, "closed rims": 28, "real": 16}

# Of each problem: family, name, and of each candidate A * GH and converted points, None where it is refused.
Compared: TypeAlias = list[dict[str, Any]]


def compared(path: Path, shared: Path, *, again: bool) -> Compared:
    """Return the comparison, from the file if it is there and not to be made again."""
    if path.is_file() and not again:
        return list(json.loads(path.read_text("utf-8")))
    found: Compared = []
    for family, number in SAMPLE.items():
        for k in range(number):
            problem = shape_problem(family, k * SIZES[family] // number, shared)
            if problem is None:
                continue
            shapes: dict[str, tuple[float, int] | None] = {}
            for name, options in CANDIDATES.items():
                try:
                    surface = blend(problem.a, problem.b, **options).surface
                    n_u, n_v = surface.to_bspline().control_points.shape[:2]
                    shapes[name] = (measure_fairness(surface).value, n_u * n_v)
                except SemisplineError:
                    shapes[name] = None
            found.append({"family": family, "name": problem.name, "shapes": shapes})
    path.write_text(json.dumps(found), encoding="utf-8")
    return found
