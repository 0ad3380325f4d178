"""The edges of a file, whatever its format."""

from __future__ import annotations

from pathlib import Path

from semispline.solver.errors import FileError
from semispline.solver.io import OCC_SUFFIXES, open_3dm, read_apart, require_file, require_kernel, shown
from semispline.solver.topology.half_edges import EdgeGraph
from semispline.solver.topology.rhino_edges import edges_of_3dm


def read_edges(path: str | Path) -> EdgeGraph:
    """Return faces and edges of a STEP, IGES, BREP or 3dm file, read by a process of its own.

    Raises
    ------
    FileError
        Missing, broken, of another format, or the extra `cad` is not installed.
    ComputationError
        The process was killed from outside, or failed through a fault of ours.
    """
    require_file(path)
    suffix = Path(path).suffix.lower()
    if suffix == ".3dm":
        return edges_of_3dm(open_3dm(path))
    if suffix not in OCC_SUFFIXES:
        raise FileError(
            f"{shown(path)}: the edges of trimmed faces cannot be read from {shown(suffix)!r}, expected one of "
            f"{' '.join(OCC_SUFFIXES)} .3dm"
        )
    require_kernel(path)
    graph = read_apart(path, "semispline.solver.topology.occ_worker", "Open CASCADE")
    assert isinstance(graph, EdgeGraph)
    return graph
