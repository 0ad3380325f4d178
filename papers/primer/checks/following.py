"""Checks of what follows from a printed formula, where that is what can be decided."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import product
from typing import Any

import sympy as sp

from semispline.papers.ledger import Case, Check, Counterexample, Formula, given
from semispline.papers.recheck import NotExpressibleError, Statement, number


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


def entry_by_entry(check: Check, rows: int, columns: int) -> Check:
    """Return the check that finds each entry of a matrix right or wrong, and not only the first wrong one."""
    first, alone = "entry (1, 1)", ", entry (1, 1)"

    def entries(formula: Formula | None) -> Iterator[tuple[str, Formula]]:
        relation = given(formula).relation
        for i, j in product(range(rows), range(columns)):
            before = sp.ImmutableMatrix(1, rows, lambda _, k, i=i: int(k == i))
            behind = sp.ImmutableMatrix(columns, 1, lambda k, _, j=j: int(k == j))
            picked = sp.Eq(*(before * side * behind for side in relation.args), evaluate=False)
            used = tuple(sorted((s for s in picked.free_symbols if isinstance(s, sp.Symbol)), key=str))
            yield f"entry ({i + 1}, {j + 1})", Formula(picked, used, given(formula).assumptions)

    def cases(formula: Formula | None) -> Iterator[Case]:
        for place, one in entries(formula):
            for case in check.cases(one):
                yield replace(case, label=f"{case.label.removesuffix(alone)}, {place}")

    def search(formula: Formula) -> Counterexample | None:
        for place, one in entries(formula):
            found = check.search(one) if check.search else None
            if found is not None:
                return replace(found, printed=found.printed.replace(first, place))
        return None

    def export(formula: Formula | None) -> Iterator[Statement]:
        for place, one in entries(formula):
            for statement in check.export(one) if check.export else ():
                yield replace(statement, label=f"{statement.label.removesuffix(alone)}, {place}")

    return replace(check, cases=cases, probe=None, search=search, export=export)


def positive_at(check: Check, at: Mapping[Any, Any], where: Mapping[Any, Any] | None = None) -> Check:
    """Return a check that also wants the right side to be a positive number at a place.

    Parameters
    ----------
    check : Check
    at : mapping
        Letter -> number.
    where : mapping, optional
        What the printed letters stand for.
    """

    def value(formula: Formula | None) -> Any:
        return given(formula).relation.rhs.xreplace(dict(where or {})).subs(at)

    def is_positive(formula: Formula | None) -> bool:
        return value(formula).evalf(30).is_positive is True

    def cases(formula: Formula | None) -> Iterator[Case]:
        yield from check.cases(formula)
        yield Case(_sign_label(at), is_positive(formula))

    def export(formula: Formula | None) -> Iterator[Statement]:
        yield from check.export(formula) if check.export else ()
        found = value(formula)
        if found.evalf(30).is_real is not True:
            raise NotExpressibleError(f"{_sign_label(at)}: {found} is not real")
        yield number(_sign_label(at), found, sp.Integer(0), sp.Integer(10) ** 9, inside=is_positive(formula))

    method = f"{check.method}; the right side is {_sign_label(at)}"
    return replace(check, cases=cases, export=export, probe=None, method=method)


def of_squares(check: Check, at: Mapping[Any, Any], where: Mapping[Any, Any] | None = None) -> Check:
    """Return the check that two numbers are the same that cannot be negative: their squares are, and their signs."""
    words = "squares of both sides, neither of which changes its sign"
    return positive_at(of_changed(check, _squared, words), at, where)


def _sign_label(at: Mapping[Any, Any]) -> str:
    return f"positive {_place(at)}"


def _squared(relation: Any) -> Any:
    return sp.Eq(relation.lhs**2, relation.rhs**2, evaluate=False)


def refuted_at(check: Check, at: Mapping[Any, Any], where: Mapping[Any, Any]) -> Check:
    """Return a check that looks at one place first: where both sides differ there by far, they are not the same.

    Angles that are no simple multiples of each other make a normal form very large.

    Parameters
    ----------
    check : Check
        With one case.
    at : mapping
        Letter -> number.
    where : mapping
        What the printed letters stand for.
    """

    def apart(formula: Formula | None) -> Any:
        """Return a difference of two entries that is far from zero, with its first digits; None where there is none."""
        one, other = (side.xreplace(dict(where)).subs(at) for side in given(formula).relation.args)
        difference = other - one
        for entry in difference if isinstance(difference, sp.MatrixBase) else [difference]:
            found = entry.evalf(30)
            if found.is_real and abs(found) > _FAR_APART:
                return entry, found
        return None

    def cases(formula: Formula | None) -> Iterator[Case]:
        found = apart(formula)
        if found is None:
            yield from check.cases(formula)
        else:
            yield Case(_place(at), False, residual=found[1])

    def export(formula: Formula | None) -> Iterator[Statement]:
        found = apart(formula)
        if found is None:
            yield from check.export(formula) if check.export else ()
        else:
            yield number(_place(at), found[0], -_FAR_APART, _FAR_APART, inside=False)

    return replace(check, cases=cases, export=export, probe=None)


_FAR_APART = sp.Rational(1, 10**9)


def _place(at: Mapping[Any, Any]) -> str:
    return "at " + ", ".join(f"{letter} = {value}" for letter, value in at.items())


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
