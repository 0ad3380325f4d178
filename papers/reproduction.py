"""`semispline reproduce`: verify a paper, run its examples, and write pictures, numbers and one HTML page."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from html import escape
from pathlib import Path
from typing import Any

from papers.report import counts_text, ledger_html, ledger_markdown, ledger_record
from papers.verification import Ledger
from solver import Base, BlendResult, blend, measure_regularity
from solver.errors import FileError
from solver.io.disk import write_text
from solver.io.json_text import to_text
from solver.plotting import BASE_COLOR, BLEND_COLOR, render
from solver.sides import Continuity

CONTINUITIES: tuple[Continuity, ...] = ("C2", "G2")


@dataclass(frozen=True)
class Example:
    """Two bases to be blended: name for files, title and note for readers."""

    name: str
    title: str
    a: Base
    b: Base
    note: str


@dataclass(frozen=True)
class Drawing:
    """A figure: name for the file, caption, and what draws it into a PNG."""

    name: str
    caption: str
    draw: Callable[[Path], None]


@dataclass(frozen=True)
class Row:
    """One blend, measured: gap in model units, angles in degrees, the curvature jump relative, time in seconds."""

    example: str
    continuity: str
    energy: float
    alpha2: float | None
    beta2: float | None
    active_bounds: str
    gap_a: float
    angle_a: float
    jump_a: float
    gap_b: float
    angle_b: float
    jump_b: float
    largest_turn: float
    least_area_ratio: float
    control_points: int
    seconds: float


_HEADINGS = {
    "example": "pair",
    "continuity": "contact",
    "energy": "energy",
    "alpha2": "α²",
    "beta2": "β²",
    "active_bounds": "bounds hit",
    "gap_a": "gap a",
    "angle_a": "angle a [°]",
    "jump_a": "curvature jump a",
    "gap_b": "gap b",
    "angle_b": "angle b [°]",
    "jump_b": "curvature jump b",
    "largest_turn": "largest turn inside [°]",
    "least_area_ratio": "least area / mean",
    "control_points": "control points",
    "seconds": "seconds",
}


def reproduce(
    paper: str,
    out: str,
    *,
    decide: Callable[[str], Ledger],
    show: Callable[[Ledger], None],
    echo: Callable[[str], Any],
) -> Ledger:
    """Write the whole report of a paper into a folder.

    Parameters
    ----------
    paper : str
        A paper of this package, with a module `study`.
    out : str
        Folder, made where it is missing.
    decide : callable
        Name -> decided ledger.
    show, echo : callables
        Print the ledger, and a line.

    Raises
    ------
    FileError
        The folder cannot be made or written to.
    """
    folder = _folder(out)
    study = importlib.import_module(f"papers.{paper}.study")
    ledger = decide(paper)
    show(ledger)
    rows, sections = [], []
    for example in study.examples():
        pictures = []
        for continuity in CONTINUITIES:
            # The first call loads libraries; the second one is timed.
            blend(example.a, example.b, continuity=continuity)
            result = blend(example.a, example.b, continuity=continuity)
            rows.append(_row(example, result))
            pictures += _pictures(folder, example, continuity, result)
        sections.append(_example_html(example, pictures))
    for line in _text_table(rows):
        echo(line)
    for drawing in study.drawings():
        drawing.draw(folder / f"{drawing.name}.png")
        sections.append(_figure_html(f"{drawing.name}.png", drawing.caption))
    write_text(folder / "numbers.json", to_text({"blends": [asdict(row) for row in rows], **ledger_record(ledger)}))
    write_text(folder / "report.md", "\n".join([*_markdown_table(rows), "", ledger_markdown(ledger)]))
    write_text(folder / "index.html", _page(ledger, rows, sections))
    echo(f"wrote {folder / 'index.html'}, numbers.json, report.md and the pictures beside it")
    return ledger


def _folder(out: str) -> Path:
    folder = Path(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{out}: cannot be made: {error.strerror or error}; give another folder") from error
    return folder


def _row(example: Example, result: BlendResult) -> Row:
    regularity = measure_regularity(result.surface)
    a, b = result.contact_a, result.contact_b
    return Row(
        example=example.name,
        continuity=result.continuity[0],
        energy=result.energy,
        alpha2=result.alpha2,
        beta2=result.beta2,
        active_bounds=", ".join(result.active_bounds) or "none",
        gap_a=a.gap,
        angle_a=a.angle_degrees,
        jump_a=a.curvature_jump_relative,
        gap_b=b.gap,
        angle_b=b.angle_degrees,
        jump_b=b.curvature_jump_relative,
        largest_turn=regularity.largest_turn_degrees,
        least_area_ratio=regularity.least_area_ratio,
        control_points=result.surface.n_control_points,
        seconds=result.seconds,
    )


def _pictures(folder: Path, example: Example, continuity: str, result: BlendResult) -> list[tuple[str, str]]:
    """Draw one blend between its bases, shaded with its control points, and with zebra stripes."""
    surfaces = [example.a.surface, example.b.surface, result.surface]
    shaded, zebra = (f"{example.name}-{continuity}-{kind}.png" for kind in ("shaded", "zebra"))
    colors = [BASE_COLOR, BASE_COLOR, BLEND_COLOR]
    render(surfaces, folder / shaded, colors=colors, control_points=[False, False, True])
    render(surfaces, folder / zebra, field="zebra")
    caption = f"{continuity}: bases green, blend red, control points of each v-control curve joined"
    return [(shaded, caption), (zebra, f"{continuity}: zebra stripes")]


def _cell(value: Any) -> str:
    if value is None:
        return "none"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _cells(rows: list[Row]) -> list[list[str]]:
    return [list(_HEADINGS.values()), *([_cell(v) for v in asdict(row).values()] for row in rows)]


def _text_table(rows: list[Row]) -> list[str]:
    """Return one block a blend: sixteen columns do not fit a terminal side by side."""
    columns = list(zip(*_cells(rows), strict=True))
    widths = [max(len(column[k]) for column in columns) for k in range(len(columns[0]))]
    return ["  ".join(cell.ljust(w) for cell, w in zip(column, widths, strict=True)).rstrip() for column in columns]


def _markdown_table(rows: list[Row]) -> list[str]:
    head, *body = _cells(rows)
    return [f"| {' | '.join(line)} |" for line in (head, ["---"] * len(head), *body)]


def _html_table(rows: list[Row]) -> str:
    head, *body = _cells(rows)
    lines = ["<tr>" + "".join(f"<th>{escape(cell)}</th>" for cell in head) + "</tr>"]
    lines += ["<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in line) + "</tr>" for line in body]
    return f"<table>{''.join(lines)}</table>"


def _figure_html(file: str, caption: str) -> str:
    text = escape(caption)
    return f"<figure><img src='{file}' alt='{text}'><figcaption>{text}</figcaption></figure>"


def _example_html(example: Example, pictures: list[tuple[str, str]]) -> str:
    figures = "".join(_figure_html(file, caption) for file, caption in pictures)
    return f"<h3>{escape(example.title)}</h3><p>{escape(example.note)}</p><div class='row'>{figures}</div>"


_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 72rem; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: .5rem 0; font-size: .9rem; }
th, td { border: 1px solid #ccc; padding: .25rem .5rem; text-align: left; vertical-align: top; }
figure { margin: .5rem 0; } img { max-width: 100%; } .row { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; }
.scroll { overflow-x: auto; } details { border-bottom: 1px solid #ddd; padding: .25rem 0; }
.verdict { border-radius: .3rem; padding: 0 .4rem; background: #ddd; }
.holds .verdict { background: #cfe8cf; } .fails .verdict { background: #f3c9c4; }
.holds-if .verdict { background: #f6e7b4; } .ambiguous .verdict { background: #e5cdf0; }
"""


def _page(ledger: Ledger, rows: list[Row], sections: list[str]) -> str:
    title = escape(ledger.paper.title)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{_STYLE}</style></head><body>
<h1>{title}</h1>
<p>{escape(counts_text(ledger))}</p>
<h2>Blends, measured</h2>
<p>Contact is judged by the de Boor referee. Energy is the thin-plate energy over the parameter range; gap in model
units, the curvature jump relative to the largest normal curvature across the edge.</p>
<div class="scroll">{_html_table(rows)}</div>
{"".join(sections)}
{ledger_html(ledger)}
</body></html>
"""
