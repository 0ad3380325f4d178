"""Degrees in u and numbers of middle curves, alpha by fairness: which rows make the fairest blend."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, TypeAlias

from semispline import SemisplineError, blend, measure_fairness, measure_turn
from semispline.papers.reproduction.families.problems import Family, ShapeProblem
from semispline.papers.reproduction.families.suite import SIZES, shape_problem

CANDIDATES: dict[str, dict[str, Any]] = {
    f"degree {degree}, {'one middle curve' if middle else 'none'}": {
        "alpha": "fair",
        "degree_u": degree,
        "middle_curves": middle,
        "alpha_v": "constant",
    }
    for degree in (3, 4, 5)
    for middle in (0, 1)
} | {"degree 5, none, linear alpha": {"degree_u": 5, "middle_curves": 0, "alpha_v": "linear"}, "the default": {}}
# Two that may be tried both.
PAIR = ("degree 5, none", "degree 5, one middle curve")
# So many of each family, evenly spread over its seeds.
SAMPLE: dict[Family, int] = {"facing": 60, "u-turn": 20, "closed rims": 28, "rough": 15, "real": 16}

# Of each problem: family, name, and what each candidate comes to; None where it is refused.
Compared: TypeAlias = list[dict[str, Any]]


def compared(path: Path, shared: Path, *, again: bool) -> Compared:
    """Return the comparison; what the file holds already is kept unless it is to be made again."""
    found: Compared = list(json.loads(path.read_text("utf-8"))) if path.is_file() and not again else []
    there = {(one["family"], one["seed"]) for one in found}
    for family, number in SAMPLE.items():
        for seed in (k * SIZES[family] // number for k in range(number)):
            problem = None if (family, seed) in there else shape_problem(family, seed, shared)
            if problem is None:
                continue
            shapes = {name: shape_with(problem, options) for name, options in CANDIDATES.items()}
            found.append({"family": family, "seed": seed, "shapes": shapes})
            path.write_text(json.dumps(found), encoding="utf-8")
    return found


def shape_with(problem: ShapeProblem, options: dict[str, Any]) -> dict[str, Any] | None:
    """Return what one candidate comes to; None where it is refused."""
    try:
        result = blend(problem.a, problem.b, **options)
    except SemisplineError:
        return None
    n_u, n_v = result.surface.to_bspline().control_points.shape[:2]
    return {
        "fairness": measure_fairness(result.surface).value,
        "points": n_u * n_v,
        "at_bound": any(name.startswith(("alpha2", "beta2")) for name in result.active_bounds),
        "turn": measure_turn(result.surface).degrees,
    }
