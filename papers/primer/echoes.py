"""What was read of each formula of the text: writes `echoes.md` anew.

    python -m semispline.papers.primer.echoes

Entries that change are marked as not compared with the print; who has compared them sets the mark by hand.
"""

from __future__ import annotations

from pathlib import Path

from semispline.papers.latex import echo_page
from semispline.papers.primer.printed import blocks, code, names
from semispline.papers.pseudocode import CodeError

PAGE = Path(__file__).parent / "echoes.md"
_HEAD = """\
# What was read

Each formula of `printed/`, read against `names.txt`, as it was understood: every product has its dot, every bracket
that groups is there, a line for each side. Below it stand the conditions with the steps (relations) that they hold in,
and the names that no sum binds. Of pseudo-code stand the rules by which it was translated, with their lines.

Written by `python -m semispline.papers.primer.echoes`. Each entry was compared with the print by a reader, once, line
by line; an entry that changes loses that mark, and the tests say so.
"""


def page(previous: str) -> str:
    """Return the page, with the marks of the previous one where nothing changed."""
    notes = {block.id: _rules(block.id) for block in blocks().values() if block.kind == "text"}
    return echo_page(_HEAD, blocks().values(), names(), previous, notes)


def _rules(identifier: str) -> str:
    try:
        rules = code(identifier).rules
    except CodeError as error:
        return f"No code: {error}"
    return "\n".join(f"- line {line}: {rule}" for line, rule in rules) or "Translated without any rule but the grammar."


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text("utf-8") if PAGE.exists() else ""), "utf-8")
