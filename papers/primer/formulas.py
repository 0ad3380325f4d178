"""The formulas of the text, read from what is printed."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from semispline.papers.latex import Block, Formula, NamesTable, read_blocks, read_formula, read_names
from semispline.papers.pseudocode import Program, load

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


# What no rule translates, and what stands for it.
_REPLACED = {"bsplines.9": {"copy of control points": "copy(points)"}}


@cache
def code(identifier: str) -> Program:
    """Return a printed piece of pseudo-code, translated.

    Raises
    ------
    UnreadableCodeError
        It is no code: a list of words.

    Examples
    --------
    >>> list(code("curvature.3").functions)
    ['kappa']
    """
    return load(blocks()[identifier].text, _REPLACED.get(identifier))
