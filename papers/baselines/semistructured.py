"""Our own solver with G2: the fairest shape, and least energy by three ways of finding alpha and beta."""

from __future__ import annotations

from functools import partial

from semispline.papers.baselines.contacts import require_polynomial
from semispline.papers.baselines.interface import BlendTask, Method, Outcome
from semispline.solver.blending import BlendResult, blend
from semispline.solver.options import Method as Search


def blend_fair(task: BlendTask) -> Outcome:
    """Blend with G2 contact and all else as `blend` chooses it: the fairest shape, no middle curve."""
    return outcome_of(blend(task.a, task.b))


def blend_semistructured(search: Search, task: BlendTask) -> Outcome:
    """Blend with G2 contact and least energy, with as many middle curves as the paper has."""
    if search != "reduced":
        require_polynomial(task)
    return outcome_of(
        blend(task.a, task.b, continuity="G2", middle_curves=task.middle_curves, alpha="energy", method=search)
    )


def outcome_of(result: BlendResult) -> Outcome:
    """Return what the measures need of a result."""
    note = f"stopped by the bound {', '.join(result.active_bounds)}" if result.active_bounds else ""
    return Outcome(
        result.surface,
        result.surface.n_control_points,
        result.iterations or None,
        result.seconds,
        result.alpha2,
        result.beta2,
        aligned=all(contact.corresponds == "affine" for contact in (result.contact_a, result.contact_b)),
        note=note,
    )


METHODS = (
    Method(
        "semistructured-fair",
        "G2, fairest shape (the default)",
        "`semispline.solver.blend` with nothing chosen: least area times integral of |grad H|²",
        8,
        blend_fair,
    ),
    Method(
        "semistructured-reduced",
        "G2, least energy proved",
        "`semispline.solver.blend`, method reduced",
        10,
        partial(blend_semistructured, "reduced"),
    ),
    Method(
        "semistructured-casadi",
        "G2, CasADi and IPOPT",
        "`semispline.solver.blend`, method casadi",
        11,
        partial(blend_semistructured, "casadi"),
    ),
    Method(
        "semistructured-bfgs",
        "G2, the paper's search",
        "`semispline.solver.blend`, method bfgs",
        12,
        partial(blend_semistructured, "bfgs"),
    ),
)
