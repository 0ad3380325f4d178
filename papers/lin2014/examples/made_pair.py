"""The made pair: two bicubic bases of our own with mismatched, non-uniform knots and a curved contact each."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from semispline.solver.io import read_problem
from semispline.solver.judge import Base
from semispline.solver.splines import BSplineSurface

FOLDER = Path(__file__).parent


@cache
def made_pair() -> tuple[Base, Base]:
    """Return the two bases of the made pair."""
    problem = read_problem(FOLDER / "made-pair.json")
    if not (isinstance(problem.a, BSplineSurface) and isinstance(problem.b, BSplineSurface)):
        raise TypeError("made-pair.json: expected two B-spline surfaces")
    return Base(problem.a, problem.edge_a), Base(problem.b, problem.edge_b)
