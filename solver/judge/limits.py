"""How good a contact must be to count as C0 .. G4, and how well it must be known for that."""

from __future__ import annotations

from dataclasses import replace
from math import radians

from semispline.solver.errors import InputError
from semispline.solver.judge.contact import Contact
from semispline.solver.options import Continuity

# What the referee must confirm; rounding of the input is allowed on top (see `Contact.rounding`).
GAP_LIMIT = 1e-11  # of the size of the model
RESIDUAL_LIMIT = 1e-11  # of the largest derivative
ANGLE_LIMIT = 1e-9  # degrees
JUMP_LIMIT = 1e-9  # of the largest curvature across the edge
RATE_LIMIT = 1e-8  # of the largest rate of curvature
SECOND_RATE_LIMIT = 1e-7  # of the largest second rate

# What rounding alone may do to a measure: above the first a user is warned, above the second nothing can be told. The
# angles and curvatures are what CAD systems take for tangent and for smooth, and a tenth and a twentieth of them. A
# residual of first derivatives turns the tangent by as many radians; one of second derivatives is one of curvature. The
# gap, of the size of the model, is what CAD systems sew, and a tenth of it.
CEILINGS = {
    "gap": (1e-6, 1e-5),
    "angle_degrees": (1e-3, 1e-2),
    "curvature_jump_relative": (1e-3, 2e-2),
    "c1_residual": (radians(1e-3), radians(1e-2)),
    "c2_residual": (1e-3, 2e-2),
    "rate_jump_relative": (1e-4, 1e-3),
    "second_rate_jump_relative": (1e-4, 1e-3),
}

# What checkers of CAD systems take for good: the gap in millimetres, or of the length of the edge; curvature and its
# rates of the largest along it.
CAD_GAP, CAD_GAP_OF_LENGTH = 1e-3, 1e-5
CAD_ANGLE = 0.01  # degrees
CAD_JUMP = 0.02
CAD_RATE = 0.1

# Of surfaces that already differ in lower order these say nothing.
_RATES = ("rate_jump_relative", "second_rate_jump_relative")

_REQUIRED = {
    "C0": ("gap",),
    "C1": ("gap", "c1_residual"),
    "C2": ("gap", "c1_residual", "c2_residual"),
    "G0": ("gap",),
    "G1": ("gap", "angle_degrees"),
    "G2": ("gap", "angle_degrees", "curvature_jump_relative"),
    "G3": ("gap", "angle_degrees", "curvature_jump_relative", "rate_jump_relative"),
    "G4": ("gap", "angle_degrees", "curvature_jump_relative", "rate_jump_relative", "second_rate_jump_relative"),
}


def allowed_measures(size: float, rounding: dict[str, float]) -> dict[str, float]:
    """Return the limit of each measure for a model of a size, with what rounding may do on top."""
    limits = {
        "gap": GAP_LIMIT * size,
        "angle_degrees": ANGLE_LIMIT,
        "curvature_jump_relative": JUMP_LIMIT,
        "c1_residual": RESIDUAL_LIMIT,
        "c2_residual": RESIDUAL_LIMIT,
        "rate_jump_relative": RATE_LIMIT,
        "second_rate_jump_relative": SECOND_RATE_LIMIT,
    }
    return {name: limits[name] + noise for name, noise in rounding.items()}


def cad_measures(length: float, millimetres: float | None = None) -> dict[str, float]:
    """Return the limits of checkers of CAD systems for an edge of a length.

    Parameters
    ----------
    length : float
        Of the edge, model units.
    millimetres : float, optional
        In one model unit, where that is known: then no gap above 0.001 mm is allowed.

    Examples
    --------
    >>> cad_measures(20.0)["gap"], cad_measures(2000.0, 25.0)["gap"]
    (0.0002, 4e-05)
    """
    gap = CAD_GAP_OF_LENGTH * length
    if millimetres is not None:
        gap = min(gap, CAD_GAP / millimetres)
    return {
        "gap": gap,
        "angle_degrees": CAD_ANGLE,
        "curvature_jump_relative": CAD_JUMP,
        "rate_jump_relative": CAD_RATE,
        "second_rate_jump_relative": CAD_RATE,
    }


def in_cad_limits(contact: Contact, length: float, millimetres: float | None = None) -> Contact:
    """Return a contact that is held to the limits of checkers of CAD systems, but for what only parameters have.

    `length` is that of the edge; `millimetres` as in `cad_measures`.
    """
    cad = cad_measures(length, millimetres)
    return replace(contact, allowed={name: max(cad.get(name, 0.0), x) for name, x in contact.allowed.items()})


def required_limits(contact: Contact, continuity: Continuity) -> list[tuple[str, float, float]]:
    """Return name, measured value and limit of each measure that `continuity` requires.

    Raises
    ------
    InputError
        The contact was not measured up to that order.

    Source: the measures of the design document; rounding of the input is allowed on top of each limit.
    """
    return [(name, getattr(contact, name), contact.allowed[name]) for name in _measures(contact, continuity)]


def shortfalls(contact: Contact, continuity: Continuity) -> list[tuple[str, float, float]]:
    """Return those of `required_limits` that the contact misses; rates of curvature only where nothing below misses."""
    found: list[tuple[str, float, float]] = []
    for name, value, limit in required_limits(contact, continuity):
        if not value <= limit and not (found and name in _RATES):
            found.append((name, value, limit))
    return found


def untold(contact: Contact, continuity: Continuity) -> list[str]:
    """Return, of each measure that rounding hides so far that `continuity` cannot be told, by how much it does."""
    return [text for text, is_untold in _hidden(contact, continuity) if is_untold]


def doubtful(contact: Contact, continuity: Continuity) -> list[str]:
    """Return, of each measure that `continuity` requires and rounding may hide to a noticeable part, by how much."""
    return [text for text, is_untold in _hidden(contact, continuity) if not is_untold]


def _hidden(contact: Contact, continuity: Continuity) -> list[tuple[str, bool]]:
    found = []
    for name in _measures(contact, continuity):
        unit = contact.size if name == "gap" else 1.0
        noticeable, most = (ceiling * unit for ceiling in CEILINGS[name])
        rounding = contact.rounding[name]
        if rounding > noticeable:
            ceiling = most if rounding > most else noticeable
            text = f"rounding alone may change {name} by {rounding:.2g}, expected at most {ceiling:.2g}"
            found.append((text, rounding > most))
    return found


def required_measures(continuity: Continuity) -> tuple[str, ...]:
    """Return the names of the measures that a continuity requires, as `Contact` has them."""
    return _REQUIRED[continuity]


def _measures(contact: Contact, continuity: Continuity) -> tuple[str, ...]:
    for name in _REQUIRED[continuity]:
        if name not in contact.allowed:
            raise InputError(f"contact: measured without {name}, expected order={continuity[1]} for {continuity}")
    return _REQUIRED[continuity]
