"""Known parts: what is found of the fillets and chamfers that Open CASCADE made."""

from __future__ import annotations

import sys
from pathlib import Path

# The parts are those of the tests.
sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers.parts import graph_of
from helpers.random_parts import known_part
from semispline.solver.topology.chamfers import find_chamfers
from semispline.solver.topology.fillets import find_fillets
from semispline.solver.topology.relations import relate


def found_of_known_parts(count: int, chamfer: bool) -> tuple[int, int, int]:
    """Return how many faces were made, found, and found wrongly, over the first seeds."""
    made = found = wrong = 0
    for seed in range(count):
        part = known_part(seed, chamfer)
        if part is None:
            continue
        graph = graph_of(part.shape)
        relations = relate(graph)
        fillets = find_fillets(graph, relations).accepted
        chamfers = {x.between.face for x in find_chamfers(graph, relations, fillets)} if chamfer else set()
        faces = set(fillets) | chamfers
        made, found, wrong = made + len(part.made), found + len(part.made & faces), wrong + len(faces - part.made)
    return made, found, wrong
