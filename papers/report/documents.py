"""The files of a report: every number, what a reader of the paper wants to know, all records and tables, the page."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from semispline.papers.report.erratum import has_erratum, write_erratum
from semispline.papers.report.html_page import page
from semispline.papers.report.ledger_as_json import ledger_record
from semispline.papers.report.ledger_as_markdown import STUDY_HEADING, ledger_markdown
from semispline.papers.report.measured_tables import METHODS_NOTE, methods_table
from semispline.papers.report.results import Results
from semispline.papers.report.table_text import markdown_lines
from semispline.solver.io import to_text, write_text


def write_report(results: Results, folder: Path) -> None:
    """Write `numbers.json`, `RECORDS.md`, `report.md` with every table, `index.html`, and the paper's own `REPORT.md`.

    The last one for papers that have it: two pages for a reader of the paper.
    """
    write_text(folder / "numbers.json", to_text(numbers(results)))
    if has_erratum(results.ledger.paper.name):
        write_erratum(results.ledger, folder / "REPORT.md")
    write_text(folder / "RECORDS.md", records_document(results))
    write_text(folder / "report.md", "\n".join(markdown(results)))
    write_text(folder / "index.html", page(results))


def numbers(results: Results) -> dict[str, Any]:
    """Return every number as the file has it."""
    return {
        "format": "semispline/1",
        "kind": "reproduction",
        "paper": results.ledger.paper.name,
        "findings": [asdict(finding) for finding in results.study.findings(results.comparisons)],
        "comparisons": [c.record() for found in results.comparisons.values() for c in found],
        "tables": [asdict(table) for table in results.study.tables(results.comparisons)],
        "ledger": ledger_record(results.ledger),
        "environment": dict(results.environment),
        "command": results.command,
    }


def markdown(results: Results) -> list[str]:
    """Return the report in Markdown: findings, tables, ledger, machine."""
    lines = [f"# {results.ledger.paper.title.rstrip('.')}", ""]
    if not results.study.examples:
        return [*lines, f"`{results.command}`", "", ledger_markdown(results.ledger)]
    lines += [results.study.preface, "", "## What was found", ""]
    lines += [f"- **{f.short}.** {f.detail}" for f in results.study.findings(results.comparisons)]
    for table in results.study.tables(results.comparisons):
        lines += ["", *markdown_lines(table)]
    lines += ["## Examples and rivals", "", METHODS_NOTE, ""]
    for example in results.study.examples:
        lines += [*markdown_lines(methods_table(results.comparisons[example.task.name]))]
        lines += [*(f"- {note}" for note in example.notes), ""]
    lines += [*markdown_lines(results.blends), "## How this was made", "", f"`{results.command}`", ""]
    lines += [f"- {name}: {text}" for name, text in results.environment.items()]
    return [*lines, "", ledger_markdown(results.ledger)]


def records_document(results: Results) -> str:
    """Return every claim as it is decided, then what the study finds, and prior art.

    Its copy in the paper's folder is what the last study said; numbers that depend on the machine are left out.
    """
    if not results.study.examples:
        return ledger_markdown(results.ledger)
    lines = [f"{STUDY_HEADING}: {results.ledger.paper.title.rstrip('.')}", "", results.study.preface, ""]
    lines += [f"Every statement here was computed by `{results.command}`.", ""]
    lines += [f"- **{f.short}.** {f.detail}" for f in results.study.findings(results.comparisons)]
    lines += ["", "Prior art:", "", *(f"- {work}" for work in results.study.prior_art), ""]
    return "\n".join([ledger_markdown(results.ledger), *lines])
