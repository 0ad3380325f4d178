"""A table as text: its cells, and the whole for a terminal, in Markdown, in HTML."""

from __future__ import annotations

from html import escape
from typing import Any

from semispline.papers.reproduction import Table


def cell(value: Any) -> str:
    """Return the text of a value: four significant digits, or all digits in front of the point.

    Examples
    --------
    >>> [cell(value) for value in (None, True, 123456.78, 2.5e-13, 0.0817, (1e-18, 0.25), 7)]
    ['–', 'yes', '123457', '2.5e-13', '0.0817', '0 to 0.25', '7']
    """
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        largest = max(map(abs, value))
        # Far below the other end of a range is rounding.
        return " to ".join(cell(x if abs(x) > 1e-9 * largest else 0.0) for x in value)
    if not isinstance(value, float):
        return str(value)
    if 1e4 <= abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.4g}" if value == 0 or abs(value) >= 1e-3 else f"{value:.1e}"


def text_lines(table: Table) -> list[str]:
    """Return the table for a terminal."""
    columns = list(zip(table.head, *table.rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    lines = (table.head, *table.rows)
    return ["  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in lines]


def markdown_lines(table: Table) -> list[str]:
    """Return the table in Markdown, with its title and its note."""
    lines = (table.head, ("---",) * len(table.head), *table.rows)
    body = ["| " + " | ".join(c.replace("|", "\\|").replace("\n", " ") for c in line) + " |" for line in lines]
    return [f"### {table.title}", "", *body, "", *([table.note, ""] if table.note else [])]


def table_html(table: Table) -> str:
    """Return a table with its title above and its note below."""
    head = "".join(f"<th>{escape(text)}</th>" for text in table.head)
    rows = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in row) + "</tr>" for row in table.rows)
    note = f"<p class='note'>{escape(table.note)}</p>" if table.note else ""
    return (
        f"<h3 id='{escape(table.name)}'>{escape(table.title)}</h3>"
        f"<div class='scroll'><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>{note}"
    )
