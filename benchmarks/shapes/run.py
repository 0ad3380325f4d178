"""The suite of shapes: `make shapes`, or python benchmarks/shapes/run.py.

Every problem of the families is blended with the fair set and with the paper's, in two processes; what comes out is
judged, written line by line to build/shapes/rows.jsonl, and made into docs/shapes.md and pictures in build/shapes/.
With --resume what the file holds is kept; with --only FAMILY one family is run, with --tables none.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import get_args

import candidates
import pictures
import tables
from rich.console import Console
from rich.progress import track

from semispline.papers.reproduction import shape_suite
from semispline.papers.reproduction.families.problems import Family
from semispline.papers.reproduction.families.suite import suite
from semispline.papers.reproduction.shape_suite import Row, run_problem

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "shapes"
WORKERS = 2


def shared_folder() -> Path:
    """Return the folder of files that are not in the repository: SEMISPLINE_SHARED, or `shared` beside it."""
    return Path(os.environ.get("SEMISPLINE_SHARED") or ROOT.parent / "shared")


def one(key: tuple[Family, int]) -> Row | None:
    """Run one problem, in a worker."""
    return run_problem(*key, shared_folder())


def run(keys: list[tuple[Family, int]]) -> Iterator[Row]:
    """Yield the rows of problems as they come."""
    # Workers start afresh and read it when they load NumPy: processor time of a blend is that of one thread.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(WORKERS, mp_context=context) as pool:
        for done in track(as_completed([pool.submit(one, key) for key in keys]), "shapes", total=len(keys)):
            row = done.result()
            if row is not None:
                yield row


def kept_rows(path: Path) -> list[Row]:
    """Return the rows that a file holds."""
    return [Row.from_json(json.loads(line)) for line in path.read_text("utf-8").splitlines()] if path.is_file() else []


def main() -> None:
    """Run what is not yet there, then write the tables and the pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("--only", choices=get_args(Family))
    asked = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    path = BUILD / "rows.jsonl"
    rows = kept_rows(path) if asked.resume or asked.tables else []
    if not asked.tables:
        there = {(row.family, row.seed) for row in rows}
        keys = [key for key in suite() if key not in there and asked.only in (None, key[0])]
        with path.open("a" if asked.resume else "w", encoding="utf-8") as file:
            for row in run(keys):
                file.write(json.dumps(row.to_json()) + "\n")
                file.flush()
                rows.append(row)
    order = list(suite())
    rows.sort(key=lambda row: order.index((row.family, row.seed)))
    compared = candidates.compared(BUILD / "candidates.json", shared_folder(), again=not (asked.resume or asked.tables))
    (ROOT / "docs" / "shapes.md").write_text(tables.document(rows, compared), encoding="utf-8")
    # What the finding of the ledger quotes.
    figures = json.dumps(shape_suite.figures(rows), indent=1)
    (ROOT / "papers" / "lin2014" / "shapes.json").write_text(figures + "\n", encoding="utf-8")
    Console().print(*tables.worst(rows), sep="\n")
    for sheet in pictures.sheets(rows, shared_folder(), BUILD):
        Console().print(str(sheet))


if __name__ == "__main__":
    main()
