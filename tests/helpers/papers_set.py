"""Blends as the paper has them, unless said otherwise: cubic, one middle curve, least (11), its scale and knots."""

from __future__ import annotations

from typing import Any

import semispline
from semispline.solver.blending import BlendResult, StatedProblem
from semispline.solver.blending import state_problem as stated
from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.problem import make_problem as made
from semispline.solver.blending.sides import Side
from semispline.solver.options import BlendOptions

PAPERS_SET: dict[str, Any] = {
    "alpha": "energy",
    "degree_u": 3,
    "middle_curves": 1,
    "v_scale": "paper",
    "middle_knots": "paper",
    "p2": "zero",
}


def blend(a: Any, b: Any, **options: Any) -> BlendResult:
    """Blend with the paper's set, but for what is said."""
    return semispline.blend(a, b, **(PAPERS_SET | options))


def state_problem(a: Any, b: Any, **options: Any) -> StatedProblem:
    """State the problem with the paper's set, but for what is said."""
    return stated(a, b, **(PAPERS_SET | options))


def make_problem(a: Side, b: Side, **options: Any) -> BlendProblem:
    """Lay out a problem with the paper's set, but for what is said."""
    return made(a, b, BlendOptions(**(PAPERS_SET | options)))
