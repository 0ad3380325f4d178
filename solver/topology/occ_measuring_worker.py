"""What the process of its own does that reads a file for the edges of some faces, or for those near some points."""

from __future__ import annotations

from typing import Any

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.io import read_occ
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.near import point_of
from semispline.solver.topology.occ_edges import edge_tables
from semispline.solver.topology.occ_measures import distances, lengths


def work(path: str, *asked: str) -> tuple[EdgeGraph, dict[str, Any]]:
    """Return faces and uses of edges, and an answer to each "lengths N", "near x,y,z" and "near x,y,z N"."""
    model = read_occ(path)
    graph = EdgeGraph(path, model.unit, *edge_tables(model.faces), dict(model.others))
    answers: dict[str, Any] = {}
    for question in asked:
        word, *rest = question.split()
        if word == "near":
            face = int(rest[1]) if len(rest) > 1 else None
            answers[question] = distances(model.faces, graph, point_of(f"near={rest[0]}"), face)
        elif int(rest[0]) < len(graph.faces):
            item: Any = model.faces[int(rest[0])]
            answers[question] = lengths(item.face)
    return graph, answers
