"""The edges of a file, whatever its format."""

from __future__ import annotations

from pathlib import Path

from semispline.solver.errors import FileError
from semispline.solver.io import OCC_SUFFIXES, read_apart, require_file, require_kernel, shown
from semispline.solver.topology.half_edges import EdgeGraph

_HINTS = {".3dm": "; 3dm files do not show the curves of a face in its own parameters: export it as STEP"}


def read_edges(path: str | Path) -> EdgeGraph:
    """Return faces and edges of a STEP, IGES or BREP file, read by a process of its own.

    Raises
    ------
    FileError
        Missing, broken, of another format, or the extra `cad` is not installed.
    ComputationError
        The process was killed from outside, or failed through a fault of ours.
    """
    require_file(path)
    suffix = Path(path).suffix.lower()
    if suffix not in OCC_SUFFIXES:
        raise FileError(
            f"{shown(path)}: the edges of trimmed faces cannot be read from {shown(suffix)!r}, expected one of "
            f"{' '.join(OCC_SUFFIXES)}{_HINTS.get(suffix, '')}"
        )
    require_kernel(path)
    graph = read_apart(path, "semispline.solver.topology.occ_worker", "Open CASCADE")
    assert isinstance(graph, EdgeGraph)
    return graph
