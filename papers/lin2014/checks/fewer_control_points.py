"""Deciding whether fewer control points are better, by the paper's own measure (11): strips with C2 contact.

A strip does not vary along v. Its least energy is a quadratic form in the contact data: value, first and second
derivative at both ends.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp
from sympy import Eq

from semispline.papers.ledger import Case, Counterexample, Formula, given, smallest_assignment
from semispline.papers.lin2014 import printed as pr
from semispline.papers.lin2014.checks import energy
from semispline.papers.lin2014.printed import CUBIC

# Value and derivatives of the strip at u = 0 and u = 1.
DATA = sp.symbols("f_0 f'_0 f''_0 f_1 f'_1 f''_1", real=True)
_F0, _D0, _DD0, _F1, _D1, _DD1 = DATA
# No middle curve (6 rows) against one (7 rows), uniform u_i as in the paper: a sum of two squares.
FEWER_COSTS_MORE = Formula(
    Eq(
        pr.energy_6 - pr.energy_7,
        sp.Rational(17, 3) * (_F1 - _F0 - (_D0 + _D1) / 2 + (_DD1 - _DD0) / 12) ** 2
        + sp.Rational(1, 12) * (_D1 - _D0 - (_DD0 + _DD1) / 2) ** 2,
        evaluate=False,
    ),
    (pr.energy_6, pr.energy_7, *DATA),
)
# Spaces that contain each other: one more control point x turns the energy c into c + 2 g x + h x^2.
_SMALL, _LARGE, _G = sp.symbols("E_small E_large g", real=True)
_H = sp.Symbol("h", positive=True)
NESTED = Formula(Eq(_SMALL - _LARGE, _G**2 / _H, evaluate=False), (_SMALL, _LARGE, _G, _H))


def least_energies(*data: Any) -> dict[Any, Any]:
    """Return the exact least energies without and with a middle curve."""
    return {pr.energy_6: energy.end_energy(CUBIC, 5, data), pr.energy_7: energy.end_energy(CUBIC, 6, data)}


def fewer_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide end data: whether the energy with fewer rows is the smaller one, or the same."""
    for label, data in (
        ("a step at rest", (0, 0, 0, 1, 0, 0)),
        ("a slope that stops", (0, 1, 0, 0, 0, 0)),
        ("curvature at both ends", (0, 0, 1, 0, 0, 1)),
    ):
        few, more = (side.subs(least_energies(*map(sp.Integer, data))) for side in given(formula).relation.args)
        yield Case(f"{label}: 6 against 7 rows", bool(few <= more), residual=sp.Max(few - more, 0))


def difference_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide the difference of the least energies for all contact data, and that it is never negative."""
    left, right = given(formula).relation.args
    residual = sp.expand(right - left.subs(least_energies(*DATA)))
    yield Case("any contact data", residual == 0, residual=residual)
    form = sp.hessian(right, DATA)
    yield Case("positive semidefinite", bool(form.is_positive_semidefinite))


def nested_cases(formula: Formula | None) -> Iterator[Case]:
    """Decide what one more control point gains: the minimum of c + 2 g x + h x^2 against its value at x = 0.

    More control points are added one after another; where h is zero so is g, and nothing is gained.
    """
    left, right = given(formula).relation.args
    x, c = sp.symbols("x c", real=True)
    value = c + 2 * _G * x + _H * x**2
    (best,) = sp.solve(value.diff(x), x)
    residual = sp.factor(right - left.subs({_SMALL: value.subs(x, 0), _LARGE: value.subs(x, best)}))
    yield Case("any energy", residual == 0, residual=residual)


def fewer_counterexample() -> Counterexample | None:
    """Search for the smallest contact data for which no middle curve costs more energy than one."""
    energies = least_energies(*DATA)
    none, one = energies[pr.energy_6], energies[pr.energy_7]
    found = smallest_assignment(DATA, lambda at: (none - one).subs(at) > 0)
    if found is None:
        return None
    names = ("position at 0", "P_u at 0", "P_uu at 0", "position at 1", "P_u at 1", "P_uu at 1")
    values = tuple((name, str(found[s])) for name, s in zip(names, DATA, strict=True))
    return Counterexample(
        values, f"energy {none.subs(found)} with 6 rows is the least", f"{one.subs(found)} with 7 rows is less"
    )
