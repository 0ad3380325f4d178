"""Blends of Figs. 10 and 11 over exact cylinders and an exact cone, beside those over the polynomial stand-ins."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from semispline.papers.baselines import BlendTask
from semispline.papers.ledger import Consequence
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.examples.exact import Circle, exact_example
from semispline.papers.lin2014.examples.section5 import example
from semispline.papers.reproduction import ROUNDING
from semispline.solver.blending import BlendResult, blend
from semispline.solver.judge import worst_inside

# What is asked for: the paper's choices (cubic, uniform U, (11) with its v) with the figure's own number of middle
# curves, the same with one, and the default.
CHOICES: dict[str, dict[str, Any]] = {
    "least energy, no middle curve, as the figure": {"continuity": "G2", "alpha": "energy", "middle_curves": 0},
    "least energy, one middle curve": {"continuity": "G2", "alpha": "energy", "middle_curves": 1},
    "fairest shape (the default)": {},
}
FIGURES_OWN, ONE_MIDDLE_CURVE, FAIREST = CHOICES
STAND_INS = "stand-ins"
CIRCLES: dict[str, Circle] = {"exact, in arcs": "arcs", "exact, smooth circle": "smooth"}
BASES = (STAND_INS, *CIRCLES)


@dataclass(frozen=True, eq=False)
class Blended:
    """One blend of one example over bases of one kind."""

    figure: int
    choice: str
    bases: str
    result: BlendResult

    @property
    def is_kept(self) -> bool:
        """Whether both contacts are G2 up to rounding, and nothing inside is creased or jumps."""
        contacts = (self.result.contact_a, self.result.contact_b)
        return worst_inside(self.result.creases) is None and all(
            c.gap <= ROUNDING * c.size and c.angle_degrees <= ROUNDING and c.curvature_jump_relative <= ROUNDING
            for c in contacts
        )


def task_of(figure: int, bases: str) -> BlendTask:
    """Return the example of a figure over bases of one kind."""
    return example(figure) if bases == STAND_INS else exact_example(figure, CIRCLES[bases])


@cache
def blended(figure: int, choice: str, bases: str) -> Blended:
    """Return one of the blends that are set side by side."""
    task = task_of(figure, bases)
    return Blended(figure, choice, bases, blend(task.a, task.b, **CHOICES[choice]))


def all_blended(figure: int) -> list[Blended]:
    """Return every choice over bases of every kind."""
    return [blended(figure, choice, bases) for choice in CHOICES for bases in BASES]


def exact_contact(figure: int, what: str) -> Consequence:
    """Measure contact and creases of a figure's blend over exact surfaces, with derived rows."""
    result = blended(figure, FIGURES_OWN, BASES[1]).result
    contacts = (result.contact_a, result.contact_b)
    measured = {
        "gap": max(c.gap for c in contacts),
        "angle between tangent planes [degrees]": max(c.angle_degrees for c in contacts),
        "relative curvature jump": max(c.curvature_jump_relative for c in contacts),
        "crease inside [degrees]": max((c.angle_degrees for c in result.creases), default=0.0),
    }
    return on_surface(what, measured)
