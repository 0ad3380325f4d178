"""Reach: `make reach`, or python benchmarks/reach/run.py [MORE...].

Every place of the STEP and BREP files of `data/cad` in the shared folder, and of those named, is blended as
`semispline blend FILE --replace FACE` does; rows go line by line to build/reach/rows.jsonl, the table to docs/reach.md.
With --resume what the file holds is kept; with --tables nothing is blended. Files of installed packages are read, and
not kept here.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tables
from measured import outcome, places
from rich.progress import track

from semispline.solver.io import read_surfaces
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.half_edges import NONE
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import relate

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "reach"
SUFFIXES = (".step", ".stp", ".brep")

Row = dict[str, Any]


def main() -> None:
    """Blend what is not yet there, then write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("more", nargs="*", type=Path, help="further files")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--tables", action="store_true")
    given = parser.parse_args()
    shared = Path(os.environ.get("SEMISPLINE_SHARED") or ROOT.parent / "shared") / "data" / "cad"
    ours = sorted(path for path in shared.iterdir() if path.suffix in SUFFIXES)
    BUILD.mkdir(parents=True, exist_ok=True)
    path = BUILD / "rows.jsonl"
    rows = kept_rows(path) if given.resume or given.tables else []
    if not given.tables:
        with path.open("a" if given.resume else "w", encoding="utf-8") as file:
            for source in (*ours, *given.more):
                there = {(row["face"], *row["edges"]) for row in rows if row["file"] == source.name}
                for row in new_rows(source, there):
                    file.write(json.dumps(row) + "\n")
                    file.flush()
                    rows.append(row)
    names = [source.name for source in ours]
    (ROOT / "docs" / "reach.md").write_text(tables.document(rows, names), encoding="utf-8")


def kept_rows(path: Path) -> list[Row]:
    """Return the rows that a file holds."""
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()] if path.is_file() else []


def new_rows(path: Path, there: set[tuple[Any, ...]]) -> Iterator[Row]:
    """Yield the rows of the places of a file that are not there."""
    measured = measured_edges(path)
    graph, relations = measured.graph, relate(measured.graph)
    fillets = find_fillets(graph, relations)
    wanted = [place for place in places(graph, relations) if (place.face, *place.edges) not in there]
    partners = (int(x) for place in wanted for x in relations.partner[graph.uses.of_face(place.face)] if x != NONE)
    faces = sorted({int(graph.uses.face[partner]) for partner in partners})
    surfaces = dict(zip(faces, read_surfaces([f"{path}#{face}" for face in faces]), strict=True))
    for place in track(wanted, path.name):
        yield {"file": path.name} | outcome(measured, fillets, relations, place, surfaces)


if __name__ == "__main__":
    main()
