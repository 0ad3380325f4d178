"""What `semispline list --pairs` finds in one file: counts, times, and whether fillets taken out are found again."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from removal import rank_of_the_right_gap

from semispline.solver.io import read_occ
from semispline.solver.io.rhino import read_3dm
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.occ_edges import edge_tables
from semispline.solver.topology.place import Place, Places
from semispline.solver.topology.places import places_of
from semispline.solver.topology.relations import relate
from semispline.solver.topology.rhino_edges import edges_of_3dm

# Seconds of processor time for a thousand faces, or so many times the reading time where that is longer.
SECONDS_PER_THOUSAND, OF_READING = 3.0, 1.2


@dataclass(frozen=True)
class Row:
    """One file.

    `ranks` are the places in the list, from 1 on, of the gaps that its fillets leave, None where there is none.
    """

    name: str
    places: Places
    uses: int
    fillets: int
    ranks: tuple[int | None, ...]
    reading: float
    finding: float

    @property
    def limit(self) -> float:
        """Seconds of processor time that finding may take."""
        return max(SECONDS_PER_THOUSAND * self.places.faces / 1000, OF_READING * self.reading)


def measured(path: Path) -> Row:
    """Read a file, find its places, and take each of its fillets out."""
    start = time.process_time()
    is_3dm = path.suffix == ".3dm"
    model = read_3dm(path) if is_3dm else read_occ(path)
    read = time.process_time()
    if is_3dm:
        graph = edges_of_3dm(model)
    else:
        graph = EdgeGraph(path.name, model.unit, *edge_tables(model.faces), dict(model.others))
    places = places_of(graph)
    found = time.process_time()
    accepted = find_fillets(graph, relate(graph)).accepted
    ranks = tuple(rank_of_the_right_gap(graph, between) for between in accepted.values())
    return Row(path.name, places, len(graph.uses), len(accepted), ranks, read - start, found - read)


def lines_and_faces(places: Places, kind: str) -> tuple[int, int]:
    """Return how many lines of a kind are listed, and how many places they stand for."""
    found: tuple[Place, ...] = places.of_kind(kind)
    return len(found), sum(1 + len(place.repeats) for place in found)
