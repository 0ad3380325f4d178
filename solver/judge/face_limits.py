"""How good a contact with a face along a free edge must be: exact, or as checkers of CAD systems have it."""

from __future__ import annotations

from collections.abc import Mapping

from semispline.solver.judge.base import Base
from semispline.solver.judge.continuity import measure_contact, model_size
from semispline.solver.judge.face_contact import FaceContact
from semispline.solver.judge.limits import CAD_ANGLE, CAD_JUMP, CAD_RATE, required_measures
from semispline.solver.options import Continuity
from semispline.solver.splines import BSplineSurface

# Power of a length in the scale of each relative measure: what is flat counts over the size of the face.
_POWERS = {"curvature_jump_relative": 1, "rate_jump_relative": 2, "second_rate_jump_relative": 3}
_MOST = {
    "angle_degrees": CAD_ANGLE,
    "curvature_jump_relative": CAD_JUMP,
    "rate_jump_relative": CAD_RATE,
    "second_rate_jump_relative": CAD_RATE,
}


def exact_face_limits(base: Base, face: BSplineSurface, order: int = 2) -> dict[str, float]:
    """Return the limits of `measure_contact` for an edge of a surface that meets a face.

    Rounding of the surface is allowed on top, twice: the face's own is counted as that. Where it passes what checkers
    of CAD systems allow, these limits stand.
    """
    own = measure_contact(base, base, flip="no", order=order)
    wider = max(1.0, model_size(face) / own.size)
    allowed = {"gap": own.allowed["gap"], "angle_degrees": own.allowed["angle_degrees"]}
    for name, power in list(_POWERS.items())[: order - 1]:
        # The limit itself is of the scale of the face; rounding was over that of the surface.
        allowed[name] = own.allowed[name] + own.rounding[name] * (wider**power - 1)
    return {name: min(limit, _MOST.get(name, limit)) for name, limit in allowed.items()}


def face_shortfalls(
    contact: FaceContact, allowed: Mapping[str, float], continuity: Continuity
) -> list[tuple[str, float, float]]:
    """Return name, value and limit of each measure that misses what a continuity requires; "off" is always one.

    Rates of curvature count only where nothing below misses. C1 and C2, which are of parameters, count as G1 and G2.

    Examples
    --------
    >>> contact = FaceContact(1e-4, 0.02, 0.0, None, None, 1e-6, 10.0, {})
    >>> face_shortfalls(contact, {"gap": 1e-3, "off": 1e-3, "angle_degrees": 0.01}, "G1")
    [('angle_degrees', 0.02, 0.01)]
    """
    found: list[tuple[str, float, float]] = []
    for name in required_face_measures(continuity):
        value = getattr(contact, name)
        if value is None or (found and name in ("rate_jump_relative", "second_rate_jump_relative")):
            continue
        if not value <= allowed[name]:
            found.append((name, value, allowed[name]))
    return found


def required_face_measures(continuity: Continuity) -> tuple[str, ...]:
    """Return the names of the measures that a continuity requires, as `FaceContact` has them."""
    geometric: dict[str, Continuity] = {"C0": "G0", "C1": "G1", "C2": "G2"}
    names = required_measures(geometric.get(continuity, continuity))
    return (names[0], "off", *names[1:])
