"""Matrices, columns with named entries, and cases: what stands in rows within a formula."""

from __future__ import annotations

from collections.abc import Callable

from semispline.papers.latex.ellipsis import elided
from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Names
from semispline.papers.latex.tokens import Item, Items, split
from semispline.papers.latex.trees import Cases, Components, Matrix, Named, Statement, Transpose, Tree

Read = Callable[[Items, int], Tree]


def matrix(item: Item, names: Names, read: Read) -> Tree:
    """Read rows as a matrix, or as a column whose every entry is `name = ..`.

    Raises
    ------
    UnreadableError
    """
    cells = [cell for row in item.rows for cell in row]
    if any(x.kind == "relation" for cell in cells for x in cell):
        return _components(item, read)
    if any(_is_dots(cell) for cell in cells):
        return _elided(item, names, read)
    rows = tuple(tuple(read(cell, cell[0].at if cell else item.at) for cell in row) for row in item.rows)
    if not rows:
        raise UnreadableError(Trouble.LAYOUT, "a matrix without rows", item.at)
    if len({len(row) for row in rows}) > 1:
        raise UnreadableError(Trouble.LAYOUT, "a matrix whose rows are not equally long", item.at)
    return Matrix(rows)


def _is_dots(cell: Items) -> bool:
    return len(cell) == 1 and cell[0].kind == "dots"


def _elided(item: Item, names: Names, read: Read) -> Tree:
    """Read one row, or one column, with dots before its last entry."""
    is_row = len(item.rows) == 1
    cells = [cell for row in item.rows for cell in row]
    if not is_row and len(cells) != len(item.rows):
        raise UnreadableError(Trouble.ELLIPSIS, "dots in a matrix of rows and columns", item.at)
    if [k for k, cell in enumerate(cells) if _is_dots(cell)] != [len(cells) - 2]:
        raise UnreadableError(Trouble.ELLIPSIS, "dots that are not the last but one of the entries", item.at)
    *before, _, last = cells
    row = Matrix(((elided(tuple(read(c, item.at) for c in before), read(last, item.at), names, item.at),),))
    return row if is_row else Transpose(row)


def _components(item: Item, read: Read) -> Tree:
    entries: list[tuple[Tree, Tree]] = []
    for row in item.rows:
        signs = [x.text for cell in row for x in cell if x.kind == "relation"]
        # A column mark may stand beside the sign, and nowhere else.
        sides = [side for cell in row for side in split(cell, "relation") if side]
        name = read(sides[0], item.at) if signs == ["="] and len(sides) == 2 else None
        if not isinstance(name, Named):
            raise UnreadableError(Trouble.LAYOUT, "relations in a matrix, where not every row is name = ..", item.at)
        entries.append((name, read(sides[1], item.at)))
    return Components(tuple(entries))


def cases(item: Item, read: Read, chain: Callable[[Items, int], Statement]) -> Tree:
    """Read a brace with rows: value & if condition, or value & otherwise.

    Raises
    ------
    UnreadableError
    """
    content = item.parts[0]
    if len(content) != 1 or content[0].kind != "rows":
        raise UnreadableError(Trouble.LAYOUT, "a brace with no rows behind it", item.at)
    found: list[tuple[Tree, Statement | None]] = []
    for row in content[0].rows:
        has_word = len(row) == 2 and bool(row[1]) and row[1][0].kind == "word"
        word, condition = (row[1][0].text, row[1][1:]) if has_word else ("", ())
        if word == "otherwise" and not condition:
            found.append((read(row[0], item.at), None))
        elif word == "when" and condition:
            found.append((read(row[0], item.at), chain(condition, item.at)))
        else:
            raise UnreadableError(Trouble.LAYOUT, "cases are: value & if condition, or value & otherwise", item.at)
    return Cases(tuple(found))
