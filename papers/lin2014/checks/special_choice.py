"""Deciding what the special choice p_1 = alpha^2, q_1 = p_2 = q_2 = 0 leaves of (15) and (16), and what it costs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import minimize

from semispline.papers.ledger import Case, Consequence
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import geometric_continuity as contact
from semispline.papers.lin2014.checks.consequences import on_surface
from semispline.papers.lin2014.examples.made_pair import made_pair
from semispline.papers.lin2014.examples.section5 import example
from semispline.solver.blending import blend


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


_PAPER: dict[str, Any] = {"continuity": "G2", "degree_u": 3, "v_scale": "paper", "middle_knots": "paper"}


@cache
def special_choice_cost() -> Consequence:
    """Minimise (11) over a constant p_2 per side as well, and over alpha^2, beta^2 linear in v, on two pairs."""
    measured = {}
    figure_6 = example(6)
    for name, pair in (("made pair", made_pair()), ("Fig. 6", (figure_6.a, figure_6.b))):
        least = blend(*pair, continuity="G2", middle_curves=1, alpha="energy")
        a, b = least.alpha2, least.beta2
        if not isinstance(a, float) or not isinstance(b, float):
            raise ValueError("result: no constant alpha, expected one on each side")

        def with_p2(x: Any, pair: Any = pair, a: float = a, b: float = b) -> float:
            alpha = (abs(x[0]) ** 0.5, abs(x[1]) ** 0.5)
            return blend(*pair, alpha=alpha, p2=(x[2] * a**2, x[3] * b**2), middle_curves=1, **_PAPER).energy

        def linear(x: Any, pair: Any = pair) -> float:
            ends = np.sqrt(np.abs(x)).tolist()
            return blend(*pair, alpha=((ends[0], ends[1]), (ends[2], ends[3])), middle_curves=1, **_PAPER).energy

        measured[f"{name}: (11) saved by a constant p_2 [%]"] = _saved(with_p2, [a, b, 0.0, 0.0], least.energy)
        measured[f"{name}: (11) saved by alpha^2 linear in v [%]"] = _saved(linear, [a, a, b, b], least.energy)
    return on_surface("The made pair and the bases that stand for Fig. 6, one middle curve", measured)


def _saved(objective: Callable[[Any], float], start: list[float], least: float) -> float:
    found = minimize(lambda x: objective(x) / least, start, method="BFGS", options={"maxiter": 25, "gtol": 1e-4})
    return float(100 * (1 - found.fun))
