"""How good a contact must be to count as C0 .. G2."""

from __future__ import annotations

from semispline.solver.judge.continuity import Contact
from semispline.solver.options import Continuity

# What the referee must confirm; rounding of the input is allowed on top (see `Contact.rounding`).
GAP_LIMIT = 1e-11  # of the size of the model
RESIDUAL_LIMIT = 1e-11  # of the largest derivative
ANGLE_LIMIT = 1e-9  # degrees
JUMP_LIMIT = 1e-9  # of the largest curvature across the edge
# The bound on rounding counts each control point once; a few operations follow before it is measured.
_ROUNDINGS = 8.0


def required_limits(contact: Contact, continuity: Continuity) -> list[tuple[str, float, float]]:
    """Return name, measured value and limit of each measure that `continuity` requires.

    Source: the measures of the design document; rounding of the input is allowed on top of each limit.
    """
    measures = {
        "C0": ("gap",),
        "C1": ("gap", "c1_residual"),
        "C2": ("gap", "c1_residual", "c2_residual"),
        "G0": ("gap",),
        "G1": ("gap", "angle_degrees"),
        "G2": ("gap", "angle_degrees", "curvature_jump_relative"),
    }[continuity]
    limits = {
        "gap": GAP_LIMIT * contact.size,
        "c1_residual": RESIDUAL_LIMIT,
        "c2_residual": RESIDUAL_LIMIT,
        "angle_degrees": ANGLE_LIMIT,
        "curvature_jump_relative": JUMP_LIMIT,
    }
    return [(m, getattr(contact, m), limits[m] + _ROUNDINGS * contact.rounding[m]) for m in measures]
