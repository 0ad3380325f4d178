"""What the process of its own does that reads a STEP, IGES or BREP file for its edges: it hands over plain arrays."""

from __future__ import annotations

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.io import read_occ
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.occ_edges import edge_tables


def work(path: str) -> EdgeGraph:
    """Return faces and uses of edges."""
    model = read_occ(path)
    return EdgeGraph(path, model.unit, *edge_tables(model.faces), dict(model.others))
