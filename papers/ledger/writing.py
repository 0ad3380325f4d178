"""Short ways to write a record, a formula, and printed data as a formula."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import sympy as sp

from semispline.papers.ledger.records import (
    Check,
    Claim,
    Correction,
    Formula,
    LedgerError,
    Part,
    Reading,
    Verdict,
)


def part(check: Check, formula: Formula | None = None) -> Part:
    """Return a part: a check, with the formula that it decides."""
    return Part(check, formula)


def parts(check: Check, *formulas: Formula) -> tuple[Part, ...]:
    """Return a part for each formula, all with the same check."""
    return tuple(Part(check, formula) for formula in formulas)


def formula(relation: Any, *assumptions: Any, **more: Any) -> Formula:
    """Return a formula whose variables are the symbols that are in it.

    Letters that differ in one number alone, such as P_1 and P_2, are neighbours: one may be mistaken for the next one.

    Parameters
    ----------
    relation : sympy.Rel
        Such as Eq(left, right, evaluate=False); without `evaluate=False` SymPy may carry out what is printed.
    assumptions : sympy.Rel
        What is presupposed of the variables.
    more
        Other attributes of `Formula`.

    Examples
    --------
    >>> n, T = sp.symbols("n T")
    >>> formula(sp.Eq(T, n**2), n >= 1).variables
    (T, n)
    """
    used = {s for expression in (relation, *assumptions) for s in expression.free_symbols if isinstance(s, sp.Symbol)}
    variables = tuple(sorted(used, key=str))
    more.setdefault("neighbours", _numbered(variables))
    return Formula(relation, variables, assumptions, **more)


def _numbered(letters: Iterable[Any]) -> tuple[tuple[Any, ...], ...]:
    """Return letters whose names are the same but for their last number, in its order."""
    chains: dict[tuple[str, str], dict[int, Any]] = {}
    for letter in letters:
        found = re.fullmatch(r"(.*?)(\d+)(\D*)", str(letter))
        if found:
            chains.setdefault((found[1], found[3]), {})[int(found[2])] = letter
    ordered = (tuple(chain[number] for number in sorted(chain)) for chain in chains.values())
    return tuple(chain for chain in ordered if len(chain) > 1)


def chain(*sides: Any, **more: Any) -> tuple[Formula, ...]:
    """Return the steps of a chain a = b = c as formulas: each step is a claim of its own.

    Raises
    ------
    LedgerError
        There is one side.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> [step.relation for step in chain((x + 1) ** 2, x**2 + 2 * x + 1, x * (x + 2) + 1)]
    [Eq((x + 1)**2, x**2 + 2*x + 1), Eq(x**2 + 2*x + 1, x*(x + 2) + 1)]
    """
    if len(sides) < 2:
        raise LedgerError(f"chain: found {len(sides)} side, expected two or more")
    return tuple(formula(sp.Eq(a, b, evaluate=False), **more) for a, b in pairwise(sides))


def draft(identifier: str, where: str, statement: str, *parts: Part, remark: str = "", **evidence: Any) -> Claim:
    """Return a record without a verdict: `semispline verify --draft` shows what its checks find."""
    readings = (Reading(parts),) if parts else ()
    return Claim(identifier, where, statement, None, readings, remark=remark, **evidence)


def holds(identifier: str, where: str, statement: str, *parts: Part, remark: str = "", **evidence: Any) -> Claim:
    """Return a record whose parts all hold."""
    return Claim(identifier, where, statement, Verdict.HOLDS, (Reading(parts),), remark=remark, **evidence)


def holds_if(
    identifier: str, where: str, statement: str, condition: str, *parts: Part, remark: str = "", **evidence: Any
) -> Claim:
    """Return a record that holds under a condition."""
    reading = Reading(parts, condition=condition)
    return Claim(identifier, where, statement, Verdict.HOLDS_IF, (reading,), remark=remark, **evidence)


def fails(identifier: str, where: str, statement: str, *parts: Part, remark: str = "", **evidence: Any) -> Claim:
    """Return a record that fails, with its correction, and its counterexample where its checks search for none."""
    return Claim(identifier, where, statement, Verdict.FAILS, (Reading(parts),), remark=remark, **evidence)


def ambiguous(
    identifier: str, where: str, statement: str, *readings: Reading, remark: str = "", **evidence: Any
) -> Claim:
    """Return a record that can be read in more than one way."""
    return Claim(identifier, where, statement, Verdict.AMBIGUOUS, readings, remark=remark, **evidence)


def corrected(statement: str, *parts: Part) -> Correction:
    """Return what is true instead, with the formulas and the checks that show it."""
    return Correction(statement, parts)


def reading(label: str, *parts: Part, condition: str = "") -> Reading:
    """Return one of several ways to read a claim."""
    return Reading(parts, label, condition)


def not_checkable(identifier: str, where: str, statement: str, reason: str) -> Claim:
    """Return a record without machine-checkable content."""
    return Claim(identifier, where, statement, Verdict.NOT_CHECKABLE, reason=reason)


def definition(identifier: str, where: str, statement: str, names: str, remark: str = "") -> Claim:
    """Return a record of a sentence that only gives a name, and `names` what it is given to."""
    return Claim(identifier, where, statement, Verdict.DEFINITION, reason=names, remark=remark)


def data_formula(name: str, data: Any, reason: str = "", changes: Iterable[Any] = ()) -> Formula:
    """Return printed data as a formula `name` = data; `reason` is why nothing printed tells some changes from it."""
    symbol = sp.Symbol(name)
    undecidable = {str(sp.Eq(symbol, changed, evaluate=False)): reason for changed in changes}
    return Formula(sp.Eq(symbol, data, evaluate=False), (symbol,), undecidable=undecidable)
