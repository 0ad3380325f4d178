"""What a user should look at before a blend is used: bounds, contact that rounding hides, bases without a normal."""

from __future__ import annotations

from typing import cast

import numpy as np

from semispline.solver.blending.problem import BlendProblem
from semispline.solver.blending.shape_parameters import Found, alpha_bounds, p2_ends, shape_unknowns
from semispline.solver.judge import Base, Contact, NoNormal, RoundingCauses, doubtful, is_closed, rounding_causes
from semispline.solver.options import BlendOptions
from semispline.solver.splines import SemiStructuredSurface

_NAMED = 5
# A span beside the edge below this fraction of the base makes its second derivatives round by 1e6 times as much.
_NARROW = 1e-3
# A p2 so many times alpha^2 is beyond all that a search finds, and derivatives round by it.
_STRAINED = 100.0
# Fairness that was minimised and fairness that is measured may differ by this fraction; what is below the second figure
# is not what the search goes by.
_UNTOLD, _FLAT = 0.1, 0.1


def bound_warnings(problem: BlendProblem, found: Found) -> tuple[str, ...]:
    """Return a warning for each shape parameter that a bound stopped, or that is beyond: method bfgs knows none."""
    warnings = []
    active = alpha_bounds(problem, found)
    for name, value, low, high in shape_unknowns(problem, found):
        if not low <= value <= high:
            warnings.append(
                f"{name} is {value:.3g}, outside of the admissible {low:.3g} to {high:.3g}: "
                f"method {found.method} knows no bounds"
            )
        elif f"{name} lower" in active or f"{name} upper" in active:
            which, bound = ("lower", low) if f"{name} lower" in active else ("upper", high)
            warnings.append(
                f"{name} is at its {which} bound {bound:.3g}: beyond it there may be a better blend; widen the box, or "
                "set alpha"
            )
    for side, which in p2_ends(found):
        value = cast("float", found.p2["ab".index(side)])
        warnings.append(
            f"p2 of side {side} at its {which} end {value:.3g}, where it moves the third row of the blend along base "
            f"{side} by the length of an arc: beyond it there may be a better blend; set p2, or alpha"
        )
    return tuple(warnings)


def stopped_warning(found: Found, options: BlendOptions) -> tuple[str, ...]:
    """Return a warning where a refusal stopped the search before the fairest shape was reached."""
    if not found.stopped_by:
        return ()
    tries = ["alpha_v linear"] * (options.alpha_v != "linear") + ["a middle curve"] * (not options.middle_curves)
    return (
        f"the fairest shape was not reached: beside this blend lie fairer ones that {found.stopped_by}, which are "
        f"refused; try {', '.join([*tries, 'or edges that face each other more evenly'])}",
    )


def fairness_warning(minimised: float | None, measured: float) -> tuple[str, ...]:
    """Return a warning where the fairness that was minimised is not that of the finished surface.

    Examples
    --------
    >>> fairness_warning(100.0, 109.0)
    ()
    """
    if minimised is None or min(minimised, measured) <= _FLAT:
        return ()
    if abs(minimised - measured) <= _UNTOLD * min(minimised, measured):
        return ()
    return (
        f"the fairness that was minimised, {minimised:.3g}, is not that of the finished surface, {measured:.3g}: it "
        "bends too sharply to be told; try alpha energy, another edge, or bases whose knots are further apart",
    )


def seam_warning(a: Base, b: Base) -> tuple[str, ...]:
    """Return a warning where one contact curve is closed and the other is open."""
    if is_closed(a) == is_closed(b):
        return ()
    which = "a" if is_closed(a) else "b"
    return (f"contact curve {which} is closed, the other is open: the blend is open along the seam of {which}",)


def strained_by(options: BlendOptions, found: Found, index: int) -> str:
    """Return what was asked for that makes p2 of a side too large to be told, and what to try; or nothing."""
    second, shape = float(np.abs(found.p2[index]).max()), float(np.min((found.a, found.b)[index]))
    if second <= _STRAINED * shape:
        return ""
    side, bulge = "ab"[index], options.bulges[index]
    if not isinstance(options.p2, str):
        return (
            f"p2 of side {side} is {options.p2[index]:.3g}, which is far beyond its alpha^2, {shape:.3g}: try one "
            "nearer to zero, or leave it out"
        )
    return f"bulge of side {side} is {bulge:g}: try one nearer to 1" if bulge > 1 else ""


def remedy(
    base: Base,
    causes: RoundingCauses,
    bare: list[NoNormal],
    shape: float | None,
    order: int = 2,
    strained: str = "",
) -> str:
    """Say what makes rounding too large to tell how a blend meets its base, and what to try.

    Parameters
    ----------
    base : Base
    causes : RoundingCauses
        Of the base and the blend.
    bare : list of NoNormal
        Where the base has no proper normal.
    shape : float or None
        The shape parameter; None where contact has none.
    order : int
        Of contact.
    strained : str
        What was asked for that may be the cause, and what to try.
    """
    across, end = base.side
    breaks = base.surface.breakpoints["uv".index(across)]
    widths = np.diff(breaks)[:: 1 if end == "0" else -1]
    width = float(widths[0])
    is_narrow = width < _NARROW * float(breaks[-1] - breaks[0])
    # Of several causes that which makes the bound larger.
    by_knots = float(widths.mean() / width) ** order if is_narrow else 1.0
    said = causes.words(("the base", "the blend"))
    if said and by_knots < max(causes.by_distance, causes.by_weights):
        return said + (f"; {strained}" if strained else "")
    if bare:
        return f"the base has {bare[0]}: choose another edge, or a base that is regular there"
    if is_narrow:
        return (
            f"knots_{across} of the base leave a span of {width:.1e} beside the edge, across which derivatives round: "
            "remove these knots or take them further apart, or ask for a lower continuity"
        )
    if strained or order > 2:
        return strained or f"derivatives of order {order} round: ask for G{order - 1}"
    if shape is None:
        return "derivatives across the edge round: try bases of similar size, or a lower continuity"
    return (
        f"the blend is all but degenerate where it meets the base, its shape parameter is {shape:.1e}: try method "
        "reduced with the default box, or a larger alpha"
    )


def bare_places(contact: Contact, name: str) -> list[NoNormal]:
    """Return where the base itself, "a" or "b", has no proper normal on a contact."""
    return [place for place in contact.no_normal if place.surface == name]


def contact_warnings(
    bases: tuple[Base, Base],
    surface: SemiStructuredSurface,
    contacts: tuple[Contact, Contact],
    options: BlendOptions,
    found: Found,
) -> tuple[str, ...]:
    """Return where contact is confirmed less than it seems: rounding hides a part, or a base has no normal there."""
    warnings = []
    for index, (name, base, contact, wanted, shape) in enumerate(
        zip(("a", "b"), bases, contacts, options.continuities, (found.a, found.b), strict=True)
    ):
        bare = bare_places(contact, name)
        least = float(np.min(shape))
        geometric = wanted[0] == "G" and wanted != "G0"
        for text in doubtful(contact, wanted):
            shown, strained = least if geometric else None, strained_by(options, found, index)
            causes = rounding_causes(base, Base(surface, "u1" if index else "u0"), int(wanted[1]))
            warnings.append(f"contact {name}: {text}; {remedy(base, causes, bare, shown, int(wanted[1]), strained)}")
        if geometric:
            warnings += [f"base {name}: {place}; {wanted} says nothing there" for place in bare[:_NAMED]]
    return tuple(warnings)
