"""Files with the printed formulas of a paper: Markdown, a heading with the id over each fenced block.

    ## eq-2.3

    ```math
    B(t) = (1-t) P_0 + t P_1
    ```

A block of `math` is LaTeX, one of `text` is pseudo-code; nothing else stands in such a file but headings of chapters
(`#`).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from semispline.papers.latex.errors import DocumentError

_FENCE = re.compile(r"^```(\w*)\s*$")


@dataclass(frozen=True)
class Block:
    """One printed formula, or a piece of pseudo-code.

    Attributes
    ----------
    id : str
    kind : str
        math or text.
    text : str
        As printed.
    source : str
        Name of the file.
    line : int
        Line of the file in which the text begins.
    """

    id: str
    kind: str
    text: str
    source: str
    line: int


def read_blocks(path: Path) -> tuple[Block, ...]:
    """Return the blocks of a file, or of all `*.md` files of a folder in the order of their names.

    Raises
    ------
    DocumentError
        Nothing is there, a line that belongs to no block, a block without an id or with that of another one.
    """
    files = sorted(path.glob("*.md")) if path.is_dir() else [path]
    try:
        texts = [(file.name, file.read_text("utf-8")) for file in files]
    except (OSError, UnicodeDecodeError) as error:
        raise DocumentError(f"{path}: {error}, expected a text file of formulas") from error
    blocks = tuple(block for name, text in texts for block in _blocks(name, text))
    if not blocks:
        raise DocumentError(f"{path}: found no formula, expected headings `## ID` with blocks below them")
    seen: dict[str, Block] = {}
    for block in blocks:
        other = seen.setdefault(block.id, block)
        if other is not block:
            raise DocumentError(f"{block.source}:{block.line}: {block.id} stands in {other.source}:{other.line} too")
    return blocks


def _blocks(source: str, text: str) -> list[Block]:
    blocks: list[Block] = []
    identifier = ""
    lines = text.splitlines()
    n = 0
    while n < len(lines):
        line = lines[n]
        n += 1
        if heading := re.fullmatch(r"##+ (\S+)\s*", line):
            identifier = heading[1]
        elif fence := _FENCE.match(line):
            end = next((k for k in range(n, len(lines)) if lines[k].strip() == "```"), None)
            if end is None:
                raise DocumentError(f"{source}:{n}: found a block that does not end")
            if not identifier or fence[1] not in ("math", "text"):
                raise DocumentError(
                    f"{source}:{n}: found {line!r}, expected ```math or ```text below a heading `## ID`"
                )
            blocks.append(Block(identifier, fence[1], "\n".join(lines[n:end]) + "\n", source, n + 1))
            identifier, n = "", end + 1
        elif line.strip() and not line.startswith("# "):
            raise DocumentError(f"{source}:{n}: found {line!r}, expected headings and blocks of formulas only")
    return blocks
