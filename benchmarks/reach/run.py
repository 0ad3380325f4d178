"""Reach: `make reach`, or python benchmarks/reach/run.py [--resume] [--tables] [MORE...]."""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
from typing import Any

from measured import outcome, places

from semispline.solver.io import read_surfaces
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.measuring import measured_edges
from semispline.solver.topology.relations import relate

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "reach"
SUFFIXES = (".step", ".stp", ".brep")


def main() -> None:
    """Blend what is not yet there, then write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("more", nargs="*", type=Path, help="further files")
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--only")
    given = parser.parse_args()
    shared = Path(os.environ.get("SEMISPLINE_SHARED") or ROOT.parent / "shared") / "data" / "cad"
    ours = sorted(path for path in shared.iterdir() if path.suffix in SUFFIXES)
    BUILD.mkdir(parents=True, exist_ok=True)
    path = BUILD / "rows.jsonl"
    rows = [json.loads(line) for line in path.read_text().splitlines()] if given.resume and path.is_file() else []
    there = {(row["file"], row["face"], *row["edges"]) for row in rows}
    with path.open("a" if given.resume else "w", encoding="utf-8") as file:
        for source in (*ours, *given.more):
            if given.only and given.only not in source.name:
                continue
            run_file(source, there, file)


def run_file(path: Path, there: set[Any], file: Any) -> None:
    measured = measured_edges(path)
    relations = relate(measured.graph)
    fillets = find_fillets(measured.graph, relations)
    wanted = list(places(measured.graph, relations))
    wanted = [x for x in wanted if (path.name, x.face, *x.edges) not in there]
    uses = measured.graph.uses
    faces = set()
    for x in wanted:
        for row in range(*uses.of_face(x.face).indices(len(uses))):
            faces.add(int(uses.face[relations.partner[row]]))
    faces = sorted(faces)
    surfaces = {}
    for n, loaded in zip(faces, read_surfaces([f"{path}#{n}" for n in faces])):
        surfaces[n] = loaded
    for place in wanted:
        row = {"file": path.name} | outcome(measured, fillets, relations, place, surfaces)
        file.write(json.dumps(row) + "\n")
        file.flush()


if __name__ == "__main__":
    main()
