"""Short ways to write a record of the text: what is printed, and where, is found by its id."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from semispline.papers import ledger
from semispline.papers.ledger import Claim, Formula, LedgerError, Part, Reading
from semispline.papers.primer.causes import cause_of
from semispline.papers.primer.printed import printed, steps


def equations(
    identifier: str, given: Mapping[str, Any] | None = None, *assumptions: Any, branch: int = 1, **more: Any
) -> tuple[Formula, ...]:
    r"""Return the steps of a printed formula, each a formula of its own.

    Parameters
    ----------
    identifier : str
    given : mapping, optional
        Pattern of a name -> what stands for it.
    assumptions : sympy.Rel
        What the text presupposes of the letters.
    branch : int
        1 or -1, which sign `\pm` stands for.
    more
        Other attributes of `Formula`, the same for each.

    Raises
    ------
    LedgerError
        Some step is no equation, or its left side is not known.

    Examples
    --------
    >>> [step.relation for step in equations("explanation.1")]
    [Eq(f(x)(x), cos(x))]
    """
    found = steps(identifier, given, branch)
    for step in found:
        if step.relation != "=" or step.left is None:
            raise LedgerError(f"{identifier}: found {step.left} {step.relation} {step.right}, expected an equation")
    return tuple(
        ledger.formula(sp.Eq(_side(s.left), _side(s.right), evaluate=False), *assumptions, **more) for s in found
    )


def _side(side: Any) -> Any:
    """Return a matrix of one entry as that entry: products of rows and columns are compared with numbers."""
    return side[0, 0] if isinstance(side, sp.MatrixBase) and side.shape == (1, 1) else side


def holds(identifier: str, statement: str, *parts: Part, **more: Any) -> Claim:
    """Return a record whose parts all hold."""
    return ledger.holds(identifier, _where(identifier), statement, *parts, printed=printed(identifier), **more)


def holds_if(identifier: str, statement: str, condition: str, *parts: Part, **more: Any) -> Claim:
    """Return a record that holds under a condition."""
    where = _where(identifier)
    return ledger.holds_if(identifier, where, statement, condition, *parts, printed=printed(identifier), **more)


def fails(identifier: str, statement: str, *parts: Part, **more: Any) -> Claim:
    """Return a record that fails."""
    where, cause = _where(identifier), cause_of(identifier)
    return ledger.fails(identifier, where, statement, *parts, printed=printed(identifier), cause=cause, **more)


def ambiguous(identifier: str, statement: str, *readings: Reading, **more: Any) -> Claim:
    """Return a record that can be read in more than one way."""
    return ledger.ambiguous(identifier, _where(identifier), statement, *readings, printed=printed(identifier), **more)


def definition(identifier: str, statement: str, names: str, remark: str = "") -> Claim:
    """Return a record of a display that only gives a name, an example or a picture of a pattern."""
    found = ledger.definition(identifier, _where(identifier), statement, names, remark)
    return replace(found, printed=printed(identifier))


def not_checkable(identifier: str, statement: str, reason: str) -> Claim:
    """Return a record without machine-checkable content."""
    return replace(ledger.not_checkable(identifier, _where(identifier), statement, reason), printed=printed(identifier))


def _where(identifier: str) -> str:
    chapter, _, number = identifier.partition(".")
    return f"chapter {chapter}, display {number}"
