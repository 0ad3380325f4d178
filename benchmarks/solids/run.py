"""Solids: `make solids`, or python benchmarks/solids/run.py [MORE...].

Every fillet that `semispline list FILE --pairs` proposes in the STEP and BREP files of `data/cad` in the shared folder,
and of those named, is replaced as its command does: alone, with its chain, or with old end edges kept. Rows go line by
line to build/solids/rows.jsonl, the table to docs/solids.md. With --resume what the file holds is kept; with --tables
nothing is replaced.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tables
from rich.progress import track

from semispline.solver.errors import SemisplineError
from semispline.solver.topology.face_runs import face_run, runs_on
from semispline.solver.topology.fillets import chains, find_fillets
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import Relations, relate
from semispline.solver.workers import WorkerError, call

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "solids"
SUFFIXES = (".step", ".stp", ".brep")
# Processor time and memory of one replacement.
SECONDS, MEGABYTES = 240.0, 4000.0

Row = dict[str, Any]


def main() -> None:
    """Replace what is not yet there, then write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("more", nargs="*", type=Path, help="further files")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--tables", action="store_true")
    given = parser.parse_args()
    shared = Path(os.environ.get("SEMISPLINE_SHARED") or ROOT.parent / "shared") / "data" / "cad"
    ours = sorted(path for path in shared.iterdir() if path.suffix in SUFFIXES)
    BUILD.mkdir(parents=True, exist_ok=True)
    path = BUILD / "rows.jsonl"
    keeps = (given.resume or given.tables) and path.is_file()
    rows: list[Row] = [json.loads(line) for line in path.read_text("utf-8").splitlines()] if keeps else []
    if not given.tables:
        with path.open("a" if given.resume else "w", encoding="utf-8") as file:
            for source in (*ours, *given.more):
                there = {tuple(row["faces"]) for row in rows if row["file"] == source.name}
                for row in new_rows(source, there):
                    file.write(json.dumps(row) + "\n")
                    file.flush()
                    rows.append(row)
    (ROOT / "docs" / "solids.md").write_text(tables.document(rows, [source.name for source in ours]), encoding="utf-8")


def new_rows(path: Path, there: set[tuple[int, ...]]) -> Iterator[Row]:
    """Yield the rows of the fillets of a file that are not there."""
    graph = measured_edges(path).graph
    relations = relate(graph)
    accepted = find_fillets(graph, relations).accepted
    groups = chains(graph, relations, accepted)
    chained = {face for group in groups for face in group}
    wanted = [tuple(group) for group in (*groups, *([face] for face in accepted if face not in chained))]
    for faces in track([x for x in wanted if x not in there], path.name):
        row = {"file": path.name, "faces": faces, "goes_on": goes_on(graph, relations, faces)}
        words = [str(path), ",".join(map(str, faces)), "keep" if row["goes_on"] else "move"]
        try:
            found = call("replaced", words, SECONDS, MEGABYTES)
        except WorkerError as error:
            found = {"error": f"{type(error).__name__}: {error}"}
        yield row | found


def goes_on(graph: EdgeGraph, relations: Relations, faces: tuple[int, ...]) -> bool:
    """Tell whether old end edges have to be kept."""
    try:
        return runs_on(graph, relations, face_run(graph, relations, faces))
    except SemisplineError:
        return False


if __name__ == "__main__":
    main()
