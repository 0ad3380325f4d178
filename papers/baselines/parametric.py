"""Our own solver with C2 contact, that is with alpha = beta = 1: one linear solve, whatever the example asks for."""

from __future__ import annotations

from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.papers.baselines.semistructured import outcome_of
from semispline.solver.blending import blend


def blend_parametric(task: BlendTask) -> Outcome:
    """Blend with C2 contact and as many middle curves as the paper has."""
    return outcome_of(blend(task.a, task.b, continuity="C2", middle_curves=task.middle_curves, alpha="energy"))


METHODS = (
    Method("semistructured-c2", "C2, linear solve", "`semispline.solver.blend`, continuity C2", 9, blend_parametric),
)
