"""`semispline reproduce`: verify a paper, run its examples with every method, write pictures, numbers and a page."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, closing
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from semispline.papers.baselines import Method, methods
from semispline.papers.ledger import Ledger, MistakeError, paper_folder, paper_module, placed
from semispline.papers.report import Results, blends_table, environment, text_lines, write_report
from semispline.papers.reproduction import Comparison, Comparisons, Drawing, Example, Study, Table, run
from semispline.solver.errors import FileError
from semispline.solver.io import check_output, pyvista_module, shown
from semispline.solver.workers import in_pool

# (what is done, how many steps) -> a context that gives a function to be told of each step
Progress: TypeAlias = Callable[[str, int], AbstractContextManager[Callable[[str], None]]]

# Our own solver's blends, of which the terminal shows every edge: what a user gets first, then what the paper asks for.
_EDGE_BY_EDGE = {
    "G2, fairest": "semistructured-fair",
    "G2, least energy": "semistructured-reduced",
    "C2, least energy": "semistructured-c2",
}

# Of one worker; no picture takes a tenth of either.
_DRAWING_SECONDS, _DRAWING_MEGABYTES = 3600, 8192


def reproduce(
    paper: str,
    out: str,
    *,
    decide: Callable[[str], Ledger],
    show: Callable[[Ledger], None],
    echo: Callable[[str], Any],
    progress: Progress,
) -> Ledger:
    """Write the whole report of a paper into a folder.

    Parameters
    ----------
    paper : str
        A paper of this package, or a folder; its examples and pictures are those of its module `study`.
    out : str
        Folder, made where it is missing.
    decide : callable
        Name -> decided ledger.
    show, echo : callables
        Print the ledger, and a line.
    progress : callable
        Told of each step.

    Raises
    ------
    FileError
        The folder cannot be made or written to, or pyvista, which draws the pictures, is not installed.
    """
    folder = _folder(out)
    study = _study(paper)
    if study.drawings:
        # Found now rather than after minutes of work.
        pyvista_module("reproduce")
    ledger = decide(paper)
    show(ledger)
    results = collect(
        ledger, study, folder, methods(study.methods), progress, f"semispline reproduce {paper} --out {out}"
    )
    for line in _spoken(results):
        echo(line)
    write_report(results, folder)
    pictures = " and the pictures beside it" if study.drawings else " beside it"
    echo(f"wrote {folder / 'index.html'}, numbers.json, RECORDS.md, report.md{pictures}")
    return ledger


def _study(paper: str) -> Study:
    """Return what a paper's module `study` gives; of one that has none, nothing beside its claims."""
    module = paper_module(paper, "study")
    if module is None:
        return Study((), (), tables=lambda _: (), findings=lambda _: ())
    with placed(paper_folder(paper)):
        found = module.study()
    if not isinstance(found, Study):
        raise MistakeError(f"{module.__file__}: study returned a {type(found).__name__}, expected a Study")
    return found


def collect(
    ledger: Ledger, study: Study, folder: Path, chosen: Iterable[Method], progress: Progress, command: str
) -> Results:
    """Run the chosen methods on all examples, one after another so that times compare, and draw all pictures."""
    chosen = tuple(chosen)
    comparisons: dict[str, list[Comparison]] = {}
    with progress("blending", len(study.examples) * len(chosen)) as advance:
        for example in study.examples:
            found = comparisons.setdefault(example.task.name, [])
            for method in chosen:
                advance(f"{example.task.name}, {method.name}")
                found.append(run(example.task, method))
    pictures = draw(study.drawings, folder, progress)
    blends = blends_table(_edge_by_edge(study.examples, comparisons))
    return Results(ledger, study, comparisons, blends, pictures, environment(), command)


def draw(drawings: Iterable[Drawing], folder: Path, progress: Progress) -> dict[str, Path]:
    """Draw pictures into files of their names, some at a time; return their paths."""
    drawings = list(drawings)
    paths = {drawing.name: folder / f"{drawing.name}.png" for drawing in drawings}
    tasks = [partial(drawing.draw, paths[drawing.name]) for drawing in drawings]
    with (
        progress("drawing", len(paths)) as advance,
        closing(in_pool(tasks, min(os.cpu_count() or 1, 4), _DRAWING_SECONDS, _DRAWING_MEGABYTES)) as results,
    ):
        for number, _ in results:
            advance(drawings[number].name)
    return paths


def _edge_by_edge(examples: Iterable[Example], comparisons: Comparisons) -> list[tuple[str, Comparison]]:
    """Return the blends of our own solver on every pair that is no figure of the paper."""
    names = [e.task.name for e in examples if not e.task.name.startswith("figure-")]
    return [
        (title, c)
        for name in names
        for title, method in _EDGE_BY_EDGE.items()
        for c in comparisons[name]
        if c.method.name == method
    ]


def _spoken(results: Results) -> list[str]:
    """Return what the terminal shows after the ledger."""
    tables: list[Table] = [*results.study.tables(results.comparisons)]
    tables += [results.blends] if results.study.examples else []
    lines = []
    for table in tables:
        lines += ["", table.title, *text_lines(table)]
    found = results.study.findings(results.comparisons)
    lines += ["", "Found", *(f"- {finding.short}" for finding in found)] if found else []
    return [*lines, ""] if lines else []


def _folder(out: str) -> Path:
    folder = Path(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FileError(f"{shown(out)}: cannot be made: {reason}; give another folder") from None
    check_output(folder / "index.html")
    return folder
