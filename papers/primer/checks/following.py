"""Checks of what follows from a printed formula, where that is what can be decided."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Check, Formula, given
from semispline.papers.recheck import Statement, number


def of_changed(check: Check, change: Callable[[Any], Any], words: str) -> Check:
    """Return the check of a relation that is made of the printed one.

    Parameters
    ----------
    check : Check
        Of the relation that is made.
    change : callable
        Relation -> relation.
    words : str
        What is made of it.
    """

    def changed(formula: Formula | None) -> Formula:
        relation = change(given(formula).relation)
        used = tuple(sorted((s for s in relation.free_symbols if isinstance(s, sp.Symbol)), key=str))
        return Formula(relation, used, given(formula).assumptions)

    def after(ask: Callable[[Formula], Any] | None) -> Callable[[Any], Any] | None:
        return None if ask is None else lambda formula: ask(changed(formula))

    return replace(
        check,
        cases=lambda formula: check.cases(changed(formula)),
        method=f"{words}: {check.method}",
        probe=after(check.probe),
        search=after(check.search),
        export=after(check.export),
    )


def of_squares(check: Check, at: Mapping[Any, Any]) -> Check:
    """Return the check that two numbers are the same that cannot be negative: their squares are, and their signs.

    Parameters
    ----------
    check : Check
        Of squares.
    at : mapping
        Letter -> number at which the sign of the right side is looked at.
    """
    squares = of_changed(check, _squared, "squares of both sides, neither of them negative")

    def value(formula: Formula | None) -> Any:
        return given(formula).relation.rhs.subs(at)

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield from squares.cases(formula)
        yield Case(_sign_label(at), bool(value(formula).evalf(30) > 0))

    def export(formula: Formula | None) -> Iterator[Statement]:
        yield from squares.export(formula) if squares.export else ()
        size = sp.Integer(10) ** 9
        yield number(_sign_label(at), value(formula), sp.Integer(0), size, inside=bool(value(formula).evalf(30) > 0))

    return replace(squares, cases=cases, export=export, probe=None)


def _sign_label(at: Mapping[Any, Any]) -> str:
    return "positive at " + ", ".join(f"{letter} = {value}" for letter, value in at.items())


def _squared(relation: Any) -> Any:
    return sp.Eq(relation.lhs**2, relation.rhs**2, evaluate=False)


def probed_at(check: Check, where: Mapping[Any, Any], *points: Mapping[Any, Any]) -> Check:
    """Return a check with a quicker way to tell mutants apart: exact values where roots are rational.

    Parameters
    ----------
    check : Check
    where : mapping
        What the printed letters stand for.
    points : mappings
        Letter -> rational number.
    """

    def probe(formula: Formula) -> Any:
        one, other = (side.xreplace(dict(where)) for side in formula.relation.args)
        return [(other - one).subs(at) for at in points]

    return replace(check, probe=probe)
