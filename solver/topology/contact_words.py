"""Which word names edges that lie along one contact: 12:e3, 12:e3+13:e1, or 12:e3* where that means the same."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from semispline.solver.topology.contact_walk import passages_after, smooth_run
from semispline.solver.topology.edge_names import line_tolerance
from semispline.solver.topology.half_edges import NONE, EdgeGraph
from semispline.solver.topology.relations import Relations


def beyond(relations: Relations, uses: Iterable[int]) -> tuple[int, ...] | None:
    """Return the uses of edges by the faces beyond; None where there is no such face."""
    found = tuple(int(relations.partner[use]) for use in uses)
    return None if NONE in found else found


def linked(graph: EdgeGraph, relations: Relations, rows: Iterable[int]) -> list[tuple[int, ...]]:
    """Return uses as runs in which each goes on in the next one, over smooth joints before corners."""
    wanted = set(rows)
    after: dict[int, int] = {}
    for row in wanted:
        found = [x for x in passages_after(graph, relations, row) if x.after in wanted and x.after != row]
        if found:
            after[row] = min(found, key=lambda x: x.turn_degrees).after
    begins = [row for row in sorted(wanted) if row not in after.values()]
    runs: list[tuple[int, ...]] = []
    left = set(wanted)
    for first in [*begins, *sorted(wanted)]:
        if first not in left:
            continue
        run = [first]
        left.remove(first)
        while (following := after.get(run[-1], NONE)) in left:
            run.append(following)
            left.remove(following)
        runs.append(tuple(run))
    return runs


def contact_word(graph: EdgeGraph, relations: Relations, run: Sequence[int]) -> str:
    """Return the shortest word for edges that run end to end."""
    uses = graph.uses
    if len(run) > 1 and set(smooth_run(graph, relations, run[0]).uses) == set(run):
        return f"{uses.face[run[0]]}:{uses.name(run[0])}*"
    return "+".join(f"{uses.face[row]}:{uses.name(row)}" for row in run)


def has_exact_bases(graph: EdgeGraph, rows: Iterable[int]) -> bool:
    """Tell whether all are lines of constant parameter or on planes: along other curves there are bands, no strips."""
    uses = graph.uses

    def is_line(row: int) -> bool:
        extent = (uses.box[row, 1] - uses.box[row, 0]) * [uses.speed_u[row].max(), uses.speed_v[row].max()]
        return bool(np.min(extent) <= line_tolerance(graph, row))

    return all(graph.faces.kind[uses.face[row]] == "plane" or is_line(row) for row in rows)
