"""Places of a file where two faces can be blended: the whole way from its edges to the list.

read_edges -> relate -> find_fillets, find_gaps, find_chamfers, sharp_edges -> repeats once -> the best first
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from semispline.solver.topology.chamfers import find_chamfers, sharp_edges
from semispline.solver.topology.commands import with_commands
from semispline.solver.topology.entries import (
    chain_entry,
    chamfer_entry,
    fillet_entry,
    gap_entry,
    round_end_entry,
    sharp_entry,
)
from semispline.solver.topology.fillets import SHORT_NAMES, chains, fillet_ends, find_fillets
from semispline.solver.topology.gaps import find_gaps
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.place import KINDS, Place, Places
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.relations import SHARP, relate
from semispline.solver.topology.repeats import without_repeats


def find_places(path: str | Path) -> Places:
    """Find where faces of a STEP, IGES, BREP or 3dm file can be blended.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Places
        Fillets (faces that can be blended anew between their neighbours), chains of them, gaps, chamfers, round ends
        and sharp edges; repeats of a part once.

    Raises
    ------
    FileError
        Missing, broken, of another format, or the extra `cad` is not installed.
    ComputationError
        The process that read the file was killed from outside.
    """
    return places_of(read_edges(path))


def places_of(graph: EdgeGraph) -> Places:
    """Find the places in a file that is read."""
    relations = relate(graph)
    fillets = find_fillets(graph, relations)
    accepted = fillets.accepted
    ends = fillet_ends(graph, relations, accepted.values())
    chamfers = find_chamfers(graph, relations, accepted)
    runs = chains(graph, relations, accepted)
    entries = [
        *(fillet_entry(graph, relations, between, fillets.on_ends[face]) for face, between in accepted.items()),
        *(chain_entry(graph, relations, [accepted[x] for x in group]) for group in runs),
        *(gap_entry(graph, gap) for gap in find_gaps(graph, relations, ends)),
        *(chamfer_entry(graph, relations, chamfer) for chamfer in chamfers),
        *(round_end_entry(graph, relations, between) for between in fillets.round_ends.values()),
        *(sharp_entry(graph, relations, use) for use in sharp_edges(graph, relations)),
    ]
    betweens = {**accepted, **fillets.round_ends, **{chamfer.between.face: chamfer.between for chamfer in chamfers}}
    found = [
        with_commands(graph, relations, place, betweens, runs) for place in sorted(without_repeats(entries), key=_rank)
    ]
    slight = (relations.median < SHARP) & ~relations.smooth & ~graph.uses.seam
    rules = Counter(refusal.rule for refusal in fillets.refused.values())
    return Places(
        path=graph.path,
        unit=graph.unit,
        faces=len(graph.faces),
        edges=len(np.unique(graph.uses.edge)),
        found=tuple(found),
        refused={face: str(refusal) for face, refusal in sorted(fillets.refused.items())},
        counts={name: rules[rule] for rule, name in SHORT_NAMES.items() if rules[rule]},
        slight=len(np.unique(graph.uses.edge[slight])),
        unwalked=tuple(np.flatnonzero(~graph.faces.walked).tolist()),
        others=graph.others,
    )


def _rank(place: Place) -> tuple[float, ...]:
    """Order by kind, score, length, number; rounding of the score decides nothing."""
    return (KINDS.index(place.kind), -round(place.score, 6), -round(place.measures["length"], 9), *place.where)
