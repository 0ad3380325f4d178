"""Places in real files and known parts: python benchmarks/places/run.py [MORE...].

Writes docs/places.md, and pictures with the proposals marked into build/places. The files are those of
`data/cad` in the shared folder, and those named: files of installed packages are read, and not kept here.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from known import found_of_known_parts
from measured import OF_READING, SECONDS_PER_THOUSAND, Row, lines_and_faces, measured
from pictures import draw

from semispline.solver.topology.places import places_of
from semispline.solver.topology.reading import read_edges

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "places"
SUFFIXES = (".step", ".stp", ".brep", ".igs", ".iges", ".3dm")
KNOWN = 40
_FEW = 10
_KINDS = ("fillet", "chain", "chamfer", "round end", "gap", "sharp edge")


def main() -> None:
    """Measure, draw and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("more", nargs="*", type=Path, help="further files")
    parser.add_argument("--pictures", action="store_true", help="draw each file with places into build/places")
    given = parser.parse_args()
    shared = Path(os.environ.get("SEMISPLINE_SHARED") or ROOT.parent / "shared") / "data" / "cad"
    ours = sorted(path for path in shared.iterdir() if path.suffix in SUFFIXES)
    rows = [measured(path) for path in ours]
    others = [measured(path) for path in given.more]
    text = document(rows, others)
    (ROOT / "docs" / "places.md").write_text(text, encoding="utf-8")
    print(text)
    if given.pictures:
        BUILD.mkdir(parents=True, exist_ok=True)
        for path in (*ours, *given.more):
            graph = read_edges(path)
            places = places_of(graph)
            if places.found and path.suffix != ".3dm":
                draw(path, graph, places, BUILD / f"{path.stem}.png")


def document(rows: Sequence[Row], others: Sequence[Row]) -> str:
    """Return docs/places.md."""
    parts = [
        _HEAD,
        *(f"| {' | '.join(_cells(row))} |" for row in rows),
        f"| {' | '.join(_sum(rows))} |",
        "",
        "Files of packages (gmsh, netgen-mesher, pyiges):",
        "",
        _COLUMNS,
        *(f"| {' | '.join(_cells(row))} |" for row in others),
        f"| {' | '.join(_sum(others))} |" if others else "",
        "",
        _KNOWN_HEAD,
        _known("fillets", chamfer=False),
        _known("chamfers", chamfer=True),
        "",
        "## Why other faces are no fillets",
        "",
        *(f"- {row.name}: {_reasons(row)}" for row in (*rows, *others) if row.places.counts),
        "",
    ]
    return "\n".join(parts)


def _cells(row: Row) -> list[str]:
    counts = []
    for kind in _KINDS:
        lines, places = lines_and_faces(row.places, kind)
        counts.append(f"{lines} ({places})" if places else "0")
    seconds = f"{row.reading:.2f}", f"{row.finding:.2f}", f"{row.finding / row.limit:.2f}"
    # What takes no time at all says nothing about the limit.
    if row.places.faces < _FEW:
        seconds = ("", "", "")
    return [row.name, str(row.places.faces), str(row.uses), *counts, _again(row.ranks), *seconds]


def _sum(rows: Sequence[Row]) -> list[str]:
    counts = []
    for kind in _KINDS:
        found = [lines_and_faces(row.places, kind) for row in rows]
        counts.append(f"{sum(x for x, _ in found)} ({sum(x for _, x in found)})")
    reading, finding = sum(row.reading for row in rows), sum(row.finding for row in rows)
    ranks = [rank for row in rows for rank in row.ranks]
    faces, uses = sum(row.places.faces for row in rows), sum(row.uses for row in rows)
    return ["sum", str(faces), str(uses), *counts, _again(ranks), f"{reading:.2f}", f"{finding:.2f}", ""]


def _again(ranks: Sequence[int | None]) -> str:
    if not ranks:
        return ""
    first, two = sum(rank == 1 for rank in ranks), sum(rank in (1, 2) for rank in ranks)
    return f"{first}, {two} of {len(ranks)}"


def _known(name: str, *, chamfer: bool) -> str:
    return f"| {name} | " + " | ".join(map(str, found_of_known_parts(KNOWN, chamfer))) + " |"


def _reasons(row: Row) -> str:
    return ", ".join(f"{count} {name}" for name, count in row.places.counts.items())


_NAMES = ("file", "faces", "uses", "fillets", "chains", "chamfers", "round ends", "gaps", "sharp edges", "taken out")
_NAMES += ("reading", "finding", "of limit")
_COLUMNS = f"| {' | '.join(_NAMES)} |\n| --- |{' ---: |' * (len(_NAMES) - 1)}"

_HEAD = f"""\
# Places

Made by `python benchmarks/places/run.py`; do not edit. What `semispline list FILE --pairs` proposes in real files, and
in parts of which it is known what was rounded.

- *uses*: of edges by faces
- of each kind the lines that are listed and, in brackets, the places that they stand for: a repeated part is listed
  once
- *taken out*: each fillet is taken out alone; in how many cases the gap that it leaves is the first, and is among the
  first two, of the gaps that are then found
- *reading*, *finding*: seconds of processor time, sampling of edges included in the latter; *of limit*: finding over
  {SECONDS_PER_THOUSAND:g} s for a thousand faces, or {OF_READING:g} times the reading where that is
  longer; above 1 it is missed

{_COLUMNS}"""

_KNOWN_HEAD = f"""\
## Known parts

{KNOWN} random boxes with bosses, holes, pockets and cones, some edges rounded or chamfered by Open CASCADE, which names
the faces that it made.

| what | made | found | found wrongly |
| --- | ---: | ---: | ---: |"""


if __name__ == "__main__":
    main()
