"""Deciding what the special choice p_1 = alpha^2, q_1 = p_2 = q_2 = 0 leaves of (15) and (16), and what it costs."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from semispline.papers.ledger import Case, Consequence
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import geometric_continuity as contact
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.checks.free_functions import FreeFunctions, function_space, greville
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.papers.lin2014.examples.section5 import example
from semispline.solver.blending import blend
from semispline.solver.judge import Base


def only_special_cases() -> Iterator[Case]:
    """Yield blends with contact of order 2 by (16), judged by the implicit equation; true where the choice has them."""
    for label, base, implicit, functions, meets in contact._instances():
        if not meets:
            continue
        patch = contact._patch(2, base, functions, pr.EQ_16.relation.rhs)
        if not (contact._touches(patch, implicit, 2) and contact._regular(patch)):
            raise ValueError(f"{label}: found no contact of order 2, expected it by (16)")
        constant = not getattr(functions[pr.p_1], "free_symbols", set())
        special = constant and all(functions[letter] == 0 for letter in (pr.q_1, pr.p_2, pr.q_2))
        yield Case(label, bool(special))


@cache
def special_choice_cost() -> Consequence:
    """Minimise (11) over p_2, alpha^2, beta^2 and q_2: numbers or linear in v, then splines of v, on two pairs."""
    measured: dict[str, float] = {}
    figure_6 = example(6)
    for name, pair in (("made pair", made_pair()), ("Fig. 6", (figure_6.a, figure_6.b))):
        measured |= {f"{name}: (11) saved by {choice} [%]": share for choice, share in saved_by(*pair).items()}
    return on_surface(
        "The made pair and the bases that stand for Fig. 6, one middle curve; functions: cubic splines of v with the "
        "inner knots 1/4, 1/2, 3/4",
        measured,
    )


def saved_by(a: Base, b: Base) -> dict[str, float]:
    """Return by how many hundredths the least energy of a pair falls where a choice is freed, at both contacts."""
    least = blend(
        a, b, continuity="G2", middle_curves=1, alpha="energy", degree_u=3, v_scale="paper", middle_knots="paper"
    )
    knots = function_space((0.25, 0.5, 0.75))
    of_v, every = greville(knots)[:, None], np.eye(7)
    constant = np.ones_like(of_v)
    free = FreeFunctions(least, knots)
    energies = {
        "a constant p_2": free.energy(constant, constant),
        "alpha^2, beta^2 linear in v": free.energy(np.hstack([constant, of_v])),
        "functions p_2": free.energy(constant, every),
        "functions alpha^2, beta^2": free.energy(every),
        "functions alpha^2, beta^2, p_2": free.energy(every, every),
        "functions alpha^2, beta^2, p_2, q_2": free.energy(every, every, every),
    }
    return {choice: 100 * (1 - energy / least.energy) for choice, energy in energies.items()}
