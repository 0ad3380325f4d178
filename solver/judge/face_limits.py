"""How good a contact with a face along a free edge must be: exact, or as checkers of CAD systems have it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.continuity import measure_contact, model_size
from semispline.solver.judge.de_boor import edge_curves
from semispline.solver.judge.face_contact import FaceContact
from semispline.solver.judge.limits import CAD_ANGLE, CAD_JUMP, CAD_RATE, required_measures
from semispline.solver.judge.rounding import derivative_noises
from semispline.solver.options import Continuity
from semispline.solver.splines import BSplineSurface

# Power of a length in the scale of each relative measure: what is flat counts over the size of the face.
_POWERS = {"curvature_jump_relative": 1, "rate_jump_relative": 2, "second_rate_jump_relative": 3}
# Of the scale of curvature, over the size of the face.
_FLOOR = 1e-3
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
    allowed["curvature_jump_relative"] += _rounding_along(base, face)
    return {name: min(limit, _MOST.get(name, limit)) for name, limit in allowed.items()}


def _rounding_along(base: Base, face: BSplineSurface) -> float:
    """Bound what rounding may do to curvature along the edge and to the mixed one, over their scale.

    Of two surfaces with a common edge these are the same, and no limit of `measure_contact` counts them. On a face the
    edge's own derivatives are measured, and where a seam was moved its first span may be short.
    """
    origin = local_origin(base.surface, face)
    breaks = base.breakpoints_along()
    s = np.unique(np.concatenate([breaks, (breaks[1:] + breaks[:-1]) / 2]))
    jet = edge_curves(base.surface, base.side, 2, origin).points(s, 2)
    noises = derivative_noises(base, origin)
    across, along = (np.linalg.norm(jet[key], axis=1).min() for key in ((1, 0), (0, 1)))
    if not min(across, along) > 0:
        return 0.0
    normal = np.cross(jet[1, 0], jet[0, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    bends = np.abs(np.sum(jet[0, 2] * normal, axis=1)) / np.sum(jet[0, 1] ** 2, axis=1)
    scale = max(float(bends.max()), _FLOOR / model_size(face))
    return float(max(noises[0, 2] / along**2, noises[1, 1] / (across * along)) / scale)


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
