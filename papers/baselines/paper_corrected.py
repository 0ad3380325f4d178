"""The paper's method with the rows that really give contact: C2 by one linear solve, G2 by its own search."""

from __future__ import annotations

from semispline.papers.baselines.contacts import require_polynomial
from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.papers.baselines.semistructured import outcome_of
from semispline.solver.blending import blend


def blend_corrected(task: BlendTask) -> Outcome:
    """Blend with the contact that the paper asks for in this example."""
    require_polynomial(task)
    return outcome_of(
        blend(task.a, task.b, continuity=task.continuity, middle_curves=task.middle_curves, method="bfgs")
    )


METHODS = (
    Method(
        "paper-corrected",
        "the paper corrected",
        "section 4 of the paper with derived rows; C2 or G2 as in the example",
        1,
        blend_corrected,
    ),
)
