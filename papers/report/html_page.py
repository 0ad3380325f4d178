"""One HTML page that holds the whole report: pictures, views, formulas and tables, and opens without a network."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from io import BytesIO
from pathlib import Path

from PIL import Image

from semispline.papers.baselines import oriented_bases
from semispline.papers.ledger import Ledger, Verdict
from semispline.papers.report.chart import LEGEND, energy_chart
from semispline.papers.report.formulas import text_html
from semispline.papers.report.ledger_as_html import ledger_html
from semispline.papers.report.measured_tables import METHODS_NOTE, methods_table
from semispline.papers.report.results import Results
from semispline.papers.report.table_text import cell, table_html
from semispline.papers.reproduction import Comparison, Example, Finding, reached
from semispline.solver.pictures import model, viewer_html, viewer_script

# Pixels across a picture in the page; the files beside it are for print.
_PICTURE_WIDTH = 1600
# Findings whose details are shown before anybody asks.
_OPEN = 3
# A browser then refuses to fetch anything.
_NOTHING_FROM_OUTSIDE = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def page(results: Results) -> str:
    """Return the page."""
    title, _, published = results.ledger.paper.title.rstrip(".").partition(" (")
    found = results.study.findings(results.comparisons)
    used = {name for example in results.study.examples for name in example.pictures}
    rest = [drawing.name for drawing in results.study.drawings if drawing.name not in used]
    every = (
        ("found", "What was found", _summary(results.ledger, found)),
        ("tables", "The paper's table", "".join(map(table_html, results.study.tables(results.comparisons)))),
        ("examples", "Examples and rivals", _examples(results)),
        ("blends", "Pairs, edge by edge", table_html(results.blends) if results.study.examples else ""),
        ("figures", "Other figures", "".join(_picture(results, name) for name in rest)),
        ("ledger", "Every claim", ledger_html(results.ledger)),
        ("how", "How this was made", _made(results)),
    )
    # A paper without a study has claims and nothing else.
    sections = tuple(section for section in every if section[2])
    examples = ", every example run again, every rival measured" if results.study.examples else ""
    links = "".join(f"<a href='#{name}'>{escape(heading)}</a>" for name, heading, _ in sections)
    body = "".join(f"<section id='{name}'><h2>{escape(h)}</h2>{content}</section>" for name, h, content in sections)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="{_NOTHING_FROM_OUTSIDE}">
<title>{escape(title)}: claims{", examples and rivals" if examples else ""}</title>
<style>{_asset("page.css")}</style></head><body>
<header><h1>{escape(title)} <small>{escape(published.rstrip(")"))}</small></h1>
<p class="lead">Every printed claim decided{examples}.
{escape(results.study.preface)}</p><nav>{links}</nav></header>
<main>{body}</main>
<script>{viewer_script() if examples else ""}</script><script>{_asset("page.js")}</script>
</body></html>
"""


def _asset(name: str) -> str:
    return files("semispline.papers.report").joinpath(name).read_text(encoding="utf-8")


def _summary(ledger: Ledger, found: Sequence[Finding]) -> str:
    counts = ledger.counts()
    tiles = "".join(f"<div class='tile {v}'><b>{counts[v]}</b>{v.replace('-', ' ')}</div>" for v in Verdict)
    heading, failures = ("By cause", _causes(ledger)) if ledger.causes() else ("False as printed", _failures(ledger))
    items = "".join(
        f"<details{' open' if i < _OPEN else ''}><summary>{escape(f.short)}</summary>{_paragraph(f.detail)}</details>"
        for i, f in enumerate(found)
    )
    study = f"<div class='findings'><h3>The method, run beside its rivals</h3>{items}</div>" if items else ""
    return f"""<div class="tiles"><div class="tile"><b>{counts["printed"]}</b>printed claims</div>{tiles}</div>
<div class="columns">{study}
<div><h3>{heading}</h3><ul class="failures">{"".join(failures) or "<li>nothing</li>"}</ul></div></div>"""


def _failures(ledger: Ledger) -> list[str]:
    return [
        f"<li>{_link(claim.id)} {escape(claim.statement)}</li>"
        for claim, decision in zip(ledger.paper.claims, ledger.decisions, strict=True)
        if decision.verdict is Verdict.FAILS
    ]


def _causes(ledger: Ledger) -> list[str]:
    """Return each fault once, with the records under it."""
    return [
        f"<li><b>{escape(cause.title)}.</b> {text_html(cause.text)} {', '.join(_link(d.id) for d in decisions)}</li>"
        for cause, decisions in ledger.causes()
    ]


def _link(identifier: str) -> str:
    return f"<a href='#claim-{escape(identifier)}'>{escape(identifier)}</a>"


def _paragraph(text: str) -> str:
    return f"<p>{escape(text)}</p>"


def _examples(results: Results) -> str:
    parts = [_example(results, example, results.comparisons[example.task.name]) for example in results.study.examples]
    if not parts:
        return ""
    return f"<p class='note'>{escape(METHODS_NOTE)}</p>{''.join(parts)}"


def _example(results: Results, example: Example, comparisons: Sequence[Comparison]) -> str:
    task = example.task
    asked = f"Asked for: {task.continuity}, middle curves: {task.middle_curves}."
    notes = "".join(f"<li>{escape(note)}</li>" for note in (asked, *example.notes))
    shown = [c for c in _leaders_first(comparisons) if c.outcome and c.measures]
    blends = [(c.method.title, _caption(c), c.outcome.surface) for c in shown if c.outcome]
    view = viewer_html(model(task.name, task.title, oriented_bases(task), blends)) if blends else ""
    pictures = "".join(_picture(results, name) for name in example.pictures)
    chart = energy_chart(comparisons)
    legend = f"<p class='legend'>Numbers are those of the table; {LEGEND}</p>" if chart else ""
    table = methods_table(comparisons)
    return (
        f"<article id='{escape(task.name)}'><h3>{escape(task.title)}</h3>"
        f"<div class='pair'>{view}<div><ul class='notes'>{notes}</ul>{chart}{legend}</div></div>"
        f"<div class='pictures'>{pictures}</div>{table_html(table)}</article>"
    )


def _leaders_first(comparisons: Iterable[Comparison]) -> list[Comparison]:
    """Put the fairest blend first: what the reader sees when the page opens."""
    return sorted(comparisons, key=lambda c: c.method.name != "semistructured-fair")


def _caption(comparison: Comparison) -> str:
    outcome, m = comparison.outcome, comparison.measures
    if outcome is None or m is None:
        return comparison.reason
    count = f", {outcome.control_points} control points" if outcome.control_points else ""
    folds = ", folds" if m.folds else ""
    jump = cell(m.curvature_jump_relative)
    return f"contact {reached(comparison.task, m)}, curvature jump {jump}, energy {cell(m.energy)}{count}{folds}"


def _picture(results: Results, name: str) -> str:
    text = escape(next(d.caption for d in results.study.drawings if d.name == name))
    source, width, height = _inlined(results.pictures[name])
    kind = "wide" if width > 1.6 * height else "normal"
    return (
        f"<figure class='{kind}'><img src='{source}' alt='{text}' width='{width}' height='{height}'>"
        f"<figcaption>{text}</figcaption></figure>"
    )


def _inlined(path: Path) -> tuple[str, int, int]:
    """Return a picture as a data URI, and its size: a WebP of at most 1600 pixels across."""
    with Image.open(path) as picture:
        small = picture.convert("RGB")
        if small.width > _PICTURE_WIDTH:
            height = round(small.height * _PICTURE_WIDTH / small.width)
            small = small.resize((_PICTURE_WIDTH, height), Image.Resampling.LANCZOS)
        buffer = BytesIO()
        small.save(buffer, "WEBP", quality=88, method=4)
        return f"data:image/webp;base64,{b64encode(buffer.getvalue()).decode('ascii')}", *small.size


def _made(results: Results) -> str:
    versions = "".join(f"<li>{escape(name)} <b>{escape(text)}</b></li>" for name, text in results.environment.items())
    return f"""<p>To repeat it: <code>{escape(results.command)}</code>, with the versions below. No random number is
drawn
anywhere in this run, so there is no seed to set; numbers are the same at every run on one machine, times aside.
<code>numbers.json</code> and <code>report.md</code> beside this page hold all of them, and the pictures for print.</p>
<ul class="versions">{versions}</ul>"""
