"""A page of echoes: what was read of each formula, for a reader with the print beside it.

Mutation of tokens cannot see a condition that is attached to the wrong line, and an echo that is read again cannot
either: a reader can. So each entry says whether it was compared with the print, and one that changes is not compared
any more.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from semispline.papers.latex.documents import Block
from semispline.papers.latex.echoing import echo, echo_statement
from semispline.papers.latex.errors import UnreadableError
from semispline.papers.latex.names import NamesTable
from semispline.papers.latex.reading import Formula, free_names, read_formula

COMPARED = "Compared with the print."
NOT_COMPARED = "**To be compared with the print.**"


def echo_page(head: str, blocks: Iterable[Block], table: NamesTable, previous: str, notes: Mapping[str, str]) -> str:
    """Return the page; an entry that stands in the previous one as it is keeps what that says of it.

    Parameters
    ----------
    head : str
        What stands above the entries.
    blocks : iterable of Block
    table : NamesTable
    previous : str
        The page as it was; empty where there is none.
    notes : mapping
        Id of a piece of pseudo-code -> what is said of it.
    """
    known = {_without_mark(entry) for entry in re.split(r"(?m)^(?=## )", previous) if f"\n{COMPARED}\n" in entry}
    page = head.rstrip() + "\n"
    for block in blocks:
        body = _entry(block, table) if block.kind == "math" else notes.get(block.id, "")
        entry = f"## {block.id}\n\n{NOT_COMPARED}\n\n{body}\n"
        page += "\n" + (entry.replace(NOT_COMPARED, COMPARED) if _without_mark(entry) in known else entry)
    return page


def _without_mark(entry: str) -> str:
    return entry.replace(NOT_COMPARED, "").replace(COMPARED, "").strip()


def _entry(block: Block, table: NamesTable) -> str:
    try:
        formula = read_formula(block.text, table.of(block.id), block.source, block.line)
    except UnreadableError as error:
        return f"Not read, and transcribed by hand. {error}"
    lines = ["```math", echo(formula.statements, formula.names), "```", "", *_holding(formula)]
    kinds: dict[str, list[str]] = {}
    for name in free_names(formula.statements):
        declaration = formula.names.by_pattern[name]
        what = declaration.kind if declaration.kind == declaration.value else f"{declaration.kind} {declaration.value}"
        kinds.setdefault(f"{what} {declaration.range}".strip(), []).append(name)
    lines += [f"- {kind}: {', '.join(f'`{name}`' for name in names)}" for kind, names in kinds.items()]
    return "\n".join(lines).rstrip()


def _holding(formula: Formula) -> list[str]:
    """Return which steps hold under which conditions."""
    found: dict[str, list[str]] = {}
    for k, step in enumerate(formula.steps, 1):
        for condition in step.conditions:
            limits = "".join(
                f" when {echo_statement(c.statement, formula.names)}" for c in condition.conditions if c.word == "when"
            )
            found.setdefault(echo_statement(condition, formula.names) + limits, []).append(str(k))
    count = len(formula.steps)
    return [f"- `{text}`: in step {', '.join(steps)} of {count}" for text, steps in found.items()]
