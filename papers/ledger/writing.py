"""Short ways to write a record, and printed data as a formula."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy as sp

from semispline.papers.ledger.records import Check, Claim, Formula, Part, Reading, Verdict


def part(check: Check, formula: Formula | None = None) -> Part:
    """Return a part: a check, with the formula that it decides."""
    return Part(check, formula)


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
    """Return a record that fails, with its correction, counterexample and consequence."""
    return Claim(identifier, where, statement, Verdict.FAILS, (Reading(parts),), remark=remark, **evidence)


def ambiguous(
    identifier: str, where: str, statement: str, *readings: Reading, remark: str = "", **evidence: Any
) -> Claim:
    """Return a record that can be read in more than one way."""
    return Claim(identifier, where, statement, Verdict.AMBIGUOUS, readings, remark=remark, **evidence)


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
