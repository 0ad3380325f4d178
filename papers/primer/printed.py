"""The formulas of the text, read from what is printed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from semispline.papers.checks import Code
from semispline.papers.latex import (
    Block,
    Formula,
    NamesTable,
    Relation,
    UnreadableError,
    echo,
    read_blocks,
    read_formula,
    read_names,
    relations,
    symbol,
    terms,
)
from semispline.papers.ledger import Print
from semispline.papers.pseudocode import Outcome, Program, read_code, run_code

_FOLDER = Path(__file__).parent


@cache
def names() -> NamesTable:
    """Return the table of names."""
    return read_names((_FOLDER / "names.txt").read_text("utf-8"), "names.txt")


@cache
def blocks() -> dict[str, Block]:
    """Return what is printed: id -> formula or pseudo-code, in the order of printing."""
    return {block.id: block for block in read_blocks(_FOLDER / "printed")}


@cache
def formula(identifier: str) -> Formula:
    """Return a printed formula, read.

    A step whose left side is None continues the display before it in the order of printing.

    Raises
    ------
    UnreadableError
        It is not read, and transcribed by hand; the class is `trouble` of the error.

    Examples
    --------
    >>> [step.relation for step in formula("matrixsplit.9").steps]
    ['=', '=', '=']
    """
    block = blocks()[identifier]
    return read_formula(block.text, names().of(identifier), block.source, block.line)


def printed(identifier: str) -> Print:
    r"""Return what is printed, with what was read of it, for a record.

    Examples
    --------
    >>> printed("explanation.1").text, printed("canonical.4").by_hand
    ('  f(x) = \\cos(x)\n', 'numeral at 17_canonical.md:25:5')
    """
    block = blocks()[identifier]
    if block.kind == "text":
        return Code(block.text, replace=replaced(identifier)).printed
    try:
        found = formula(identifier)
    except UnreadableError as error:
        return Print(block.text, by_hand=f"{error.trouble} at {error.place}")
    return Print(block.text, echo(found.statements, found.names))


def steps(identifier: str, given: Mapping[str, Any] | None = None, branch: int = 1) -> tuple[Relation, ...]:
    r"""Return the steps of a printed formula in SymPy: what the checks are about.

    The left side of a formula that continues the display before it is the last side of that one, and None where that
    one is not read.

    Parameters
    ----------
    identifier : str
    given : mapping, optional
        Pattern of a name -> what stands for it.
    branch : int
        1 or -1, which sign `\pm` stands for.

    Examples
    --------
    >>> [step] = steps("matrixsplit.6", {"Z": 2, "M": 3})
    >>> step.right.shape
    (1, 1)
    """
    return relations(formula(identifier), _before(identifier), given, branch)


def terms_of(identifier: str, given: Mapping[str, Any] | None = None, branch: int = 1) -> tuple[tuple[Any, ...], ...]:
    """Return the terms of the last side of each line in SymPy, as `steps` does of whole sides.

    Examples
    --------
    >>> terms_of("explanation.7")[2]
    (1, 3, 3, 1)
    """
    return terms(formula(identifier), given, branch)


def letter(identifier: str, pattern: str) -> Any:
    """Return the SymPy symbol that a name of a formula converts to.

    Examples
    --------
    >>> letter("explanation.5", "a")
    a
    """
    return symbol(pattern, names().of(identifier))


def _before(identifier: str) -> Formula | None:
    order = [block.id for block in blocks().values() if block.kind == "math"]
    place = order.index(identifier)
    try:
        return formula(order[place - 1]) if place else None
    except UnreadableError:
        return None


# What no rule reads, and what stands for it.
_REPLACED = {"bsplines.9": {"copy of control points": "copy(points)"}}


@cache
def code(identifier: str) -> Program:
    """Return a printed piece of pseudo-code, read.

    Raises
    ------
    CodeError
        It is no code: a list of words.

    Examples
    --------
    >>> [function.name for function in code("curvature.3").statements]
    ['kappa']
    """
    return read_code(blocks()[identifier].text, replaced(identifier))


def replaced(identifier: str) -> dict[str, str]:
    """Return the printed words of a piece of pseudo-code that no rule reads, and what stands for them.

    Examples
    --------
    >>> replaced("bsplines.9")
    {'copy of control points': 'copy(points)'}
    """
    return _REPLACED.get(identifier, {})


def run(identifier: str, call: str = "", given: Mapping[str, Any] | None = None) -> Outcome:
    """Run a printed piece of pseudo-code, and what calls it.

    Raises
    ------
    CodeFaultError
        It does not come to its end; the message names the printed line.

    Examples
    --------
    >>> run("intersections.1", "lli8(0, 0, 2, 2, 1, 1, 2, 2)").value
    False
    """
    return run_code(blocks()[identifier].text, call, given, replace=replaced(identifier))
